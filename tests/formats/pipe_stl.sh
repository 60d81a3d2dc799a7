# SPDX-License-Identifier: GPL-3.0-or-later
# rc-import reads the upper side of STL blocks that rc-export writes, and sheets as text, above an even raster.
. "$(dirname "$0")/../pipe.sh"

# 24 x 17 nodes: the longer side, 23 steps of 2 um, becomes 100 mm, which is 2173.9 times as long.
rc-synth selfaffine --nx 24 --ny 17 --dx 2um --dy 3um --hurst 0.8 --rms-height 0.5um --rolloff 20um --seed 4 -o map.rcg
rc-export --format csv map.rcg | grep -v '^#' >map.csv
scale=$(awk 'BEGIN { print 0.1 / (23 * 2e-6 > 16 * 3e-6 ? 23 * 2e-6 : 16 * 3e-6) }')

# equal A.csv B.csv SCALE: B is SCALE times A but for a constant, to the 7 digits of single precision of 100 mm.
equal() {
    paste -d , "$1" "$2" | awk -F , -v s="$3" '
        { for (i = 1; i <= NF / 2; i++) { d = $(i + NF / 2) - s * $i; if (!n++) first = d
            if (d - first > 2e-8 || first - d > 2e-8) bad++ } }
        END { exit bad || n != 24 * 17 }'
}

rc-export map.rcg -o block.stl
rc-import --quiet block.stl | rc-info --json >info.json
near "$(field dx info.json)" "$(awk "BEGIN { print 2e-6 * $scale }")" "$six_digits" "the spacing of a block is the scaled one"
near "$(field dy info.json)" "$(awk "BEGIN { print 3e-6 * $scale }")" "$six_digits" "and that of its rows"
rc-import --quiet block.stl | rc-export --format csv | grep -v '^#' >block.csv
claim "the upper side of a block of rc-export is its map, to scale" equal map.csv block.csv "$scale"
claim "a message says that the unit is assumed" \
    warns "STL has no unit: its lengths are taken as millimetres" rc-import block.stl

# sheet SIGN [SKIP]: the map as text, in um, each cell two triangles; SIGN -1 turns them over, SKIP leaves out a column.
sheet() {
    awk -F , -v sign="$1" -v skip="${2:--1}" '
        { for (i = 1; i <= NF; i++) z[NR, i] = 1e6 * $i; nx = NF }
        function corner(j, i) { printf "vertex %.9g %.9g %.9g\n", 2 * (i - 1), 3 * (NR - j), z[j, i] }
        function facet(a, b, c, d, e, f) {
            print "facet normal 0 0 " sign "\nouter loop"
            corner(a, b); if (sign > 0) { corner(c, d); corner(e, f) } else { corner(e, f); corner(c, d) }
            print "endloop\nendfacet"
        }
        END {
            print "solid sheet"
            for (j = 1; j < NR; j++) for (i = 1; i < nx; i++) if (i != skip && i + 1 != skip) {
                facet(j, i, j + 1, i, j + 1, i + 1); facet(j, i, j + 1, i + 1, j, i + 1)
            }
            print "endsolid sheet"
        }' map.csv
}
for sign in 1 -1; do
    sheet "$sign" >sheet.stl
    rc-import --quiet --xy-unit um --z-unit um sheet.stl | rc-export --format csv | grep -v '^#' >sheet.csv
    claim "a sheet of text that faces $sign is its map" equal map.csv sheet.csv 1
done
sheet 1 5 >hole.stl
rc-import --quiet hole.stl | rc-info --json >info.json
near "$(field missing info.json)" 17 "$rounding" "nodes without a triangle are missing"
head -c 3000 block.stl >cut.stl
refuses 1 "" "a block that is cut is refused" 'rc-import cut.stl'
sed 's/vertex 8 /vertex 8.7 /' sheet.stl >uneven.stl
refuses 1 "uneven|no raster" "a mesh off a raster is refused" 'rc-import uneven.stl'
sed '4s/vertex .*/vertex 1 two 3/' sheet.stl >word.stl
refuses 1 "corner 1 of the triangles has no three numbers" "a corner needs three numbers" 'rc-import word.stl'
sed '4d' sheet.stl >odd.stl
refuses 1 "2207 corners are no triangles" "corners that make no triangles are refused" 'rc-import odd.stl'
