# SPDX-License-Identifier: GPL-3.0-or-later
# rc-info makes one table of many scans: one row per frame, the same columns in all. Profiles along rows,
# columns and oblique lines, and the material ratio at given heights, equal closed forms for waves.
. "$(dirname "$0")/../pipe.sh"

# there are 10 ridges along y with 24 nodes per wave; the other map has crests and troughs of 24 x 20 nodes
rc-synth wave --nx 240 --ny 200 --dx 1um --amplitude 1um --wavelength 24um -o ridges.rcg
perl -e 'print "# Width: 240 um\n# Height: 200 um\n# Value units: um\n"; for $j (0 .. 199) {
    print join(" ", map { cos(2 * 3.14159265358979 * $_ / 24) * cos(2 * 3.14159265358979 * $j / 20) } 0 .. 239), "\n" }' >egg.txt
rc-import --quiet egg.txt | rc-pick --set periodic=yes -o egg.rcg
rc-solve --quiet --periodic --load 5N --estar 100GPa --output pressure -o p.rcg egg.rcg

# cell FILE ROW COLUMN: prints a cell of a table; columns are named without units
cell() {
    awk -F '\t' -v row="$2" -v name="$3" '
        NR == 1 { for (c = 1; c <= NF; c++) { n = $c; sub(/\/.*/, "", n); if (n == name) at = c } }
        NR == row + 1 { print $at }' "$1"
}

# ---- one table ----

claim "40 scans become a table" eval 'for k in $(seq 40); do cat egg.rcg; done | rc-info --areal --report all.tsv >said.txt && test "$(wc -l <all.tsv)" = 41'
claim "  there is no other output" test ! -s said.txt
claim "  each row has a cell for each column" eval "awk -F '\t' 'NR == 1 { n = NF } NF != n { bad = 1 } END { exit bad || n < 40 }' all.tsv"
claim "  the first line has the units" eval 'head -n 1 all.tsv >head.txt && says "	sq/m	.*	spd/1/m2	.*	s10z/m	sha/m2	sda/m2	file$" cat head.txt'
claim "  the cases have consecutive numbers" test "$(cell all.tsv 40 case)" = 40
near "$(cell all.tsv 7 sq)" 0.5e-6 "$summed" "Sq"
near "$(cell all.tsv 7 spd)" "$(perl -e 'printf "%.15g", 2 / (24e-6 * 20e-6)')" "$rounding" "two peaks a cell"
near "$(cell all.tsv 7 svd)" "$(perl -e 'printf "%.15g", 2 / (24e-6 * 20e-6)')" "$rounding" "two pits"
near "$(cell all.tsv 7 s10z)" 2e-6 "$summed" "S10z"
near "$(cell all.tsv 7 sha)" 240e-12 "$rounding" "the area of a hill"
near "$(cell all.tsv 7 spc)" "$(perl -e '$q = 2 * atan2(0, -1); printf "%.15g", 1e6 * (2 - cos($q / 24) - cos($q / 20))')" "$summed" "the curvature of a peak"
claim "heights and pressures are in one table" rc-info --areal --patches --report both.tsv egg.rcg p.rcg
claim "  each frame has a row" test "$(wc -l <both.tsv)" = 3
claim "  a figure that a frame lacks is unknown" test "$(cell both.tsv 1 patches) $(cell both.tsv 2 sq)" = "NaN NaN"
claim "  the other figures have values" test "$(cell both.tsv 2 patches)" = 200
claim "other frames have no row" eval 'rc-info --patches --report one.tsv egg.rcg p.rcg && test "$(wc -l <one.tsv)" = 2'
claim "without a selection all frames have rows" eval 'rc-info --report one.tsv egg.rcg p.rcg && test "$(wc -l <one.tsv)" = 3 && test "$(cell one.tsv 2 channel)" = pressure'
claim "the report can be lines of JSON" eval 'rc-info --areal --psd --report r.json egg.rcg && says "\"sq\": 4.99|\"sq\": 5e-07|\"sq\": 5.0" cat r.json && says "\"hurst\"" cat r.json'
claim "a table on standard output can be drawn" eval 'rc-info --areal --report - ridges.rcg egg.rcg | rc-render --curve sq:spc -o c.svg'
claim "with --json too" eval 'rc-info --json --report one.tsv egg.rcg >j.txt && test "$(wc -l <j.txt)" = 1'

# ---- Smr(c) ----

claim "a third of a wave is above half its height" rc-info --smr 0.49um,-2um,2um --report smr.tsv ridges.rcg
near "$(cell smr.tsv 1 smr_4.9e-07)" 0.33333333333333333 "$rounding" "  8 of 24 nodes, which stand half a step beside the crests"
claim "  all of it is above its lowest point, nothing above its highest" test "$(cell smr.tsv 1 smr_-2e-06) $(cell smr.tsv 1 smr_2e-06)" = "1 0"
claim "  the text has it too" says '^  Smr +33.3333 % at 490 nm$' rc-info --smr 490nm ridges.rcg

# ---- profiles ----

rc-info --profile rows --report rows.tsv ridges.rcg
near "$(cell rows.tsv 1 rq)" "$(perl -e 'printf "%.15g", 1e-6 / sqrt 2')" "$summed" "Rq along rows"
near "$(cell rows.tsv 1 rsm)" 24e-6 "$summed" "Rsm"
near "$(cell rows.tsv 1 rz)" "$(cell rows.tsv 1 rt)" "$summed" "Rz is Rt of a wave"
claim "  the parameters of 200 equal rows are those of one" test "$(cell rows.tsv 1 profiles)" = 200
claim "  their deviation is 0" eval "awk 'BEGIN { exit !($(cell rows.tsv 1 rq_deviation) < 1e-18) }'"
claim "along the ridges they are 0" eval 'rc-info --profile columns --report columns.tsv ridges.rcg && awk "BEGIN { exit !($(cell columns.tsv 1 rq) < 1e-18) }" && test "$(cell columns.tsv 1 rsm)" = NaN'
rc-info --profile 45 --report 45.tsv ridges.rcg
near "$(cell 45.tsv 1 rsm)" "$(perl -e 'printf "%.15g", 24e-6 * sqrt 2')" "$coarse_grid" "at 45 degrees waves are longer by sqrt 2"
claim "ridges at 30 and -30 degrees are mirror images" eval '
    rc-info --profile 30 --report a.tsv ridges.rcg && rc-info --profile=-30 --report b.tsv ridges.rcg'
near "$(cell a.tsv 1 rq)" "$(cell b.tsv 1 rq)" "$rounding" "  Rq of both"
# a plane that rises to the right and up: at 45 degrees its line rises, at -45 it does not
perl -e 'print "# Width: 41 um\n# Height: 41 um\n# Value units: um\n"; for $j (0 .. 40) { print join(" ", map { 0.1 * ($_ - $j) } 0 .. 40), "\n" }' >plane.txt
rc-import --quiet plane.txt -o plane.rcg
claim "angles are counterclockwise in the picture" eval '
    rc-info --profile 45 --report a.tsv plane.rcg && rc-info --profile=-45 --report b.tsv plane.rcg &&
    awk "BEGIN { exit !($(cell a.tsv 1 rt) > 7.9e-6 && $(cell b.tsv 1 rt) < 1e-15) }"'
rc-info --profile=-10um,0:10um,0 --sections 1 --report line.tsv plane.rcg
near "$(cell line.tsv 1 rt)" 2e-6 "$summed" "from place to place"
near "$(cell line.tsv 1 rdq)" 0.1 "$summed" "  its slope"
claim "the text has them, with their number" eval 'rc-info --profile rows ridges.rcg >text.txt && says "^  profile    rows: 200 of them, means \\+- standard deviations; 240 points, 240 um, 5 sections$" cat text.txt && says "^  Rsm +24 um \\+- " cat text.txt'
claim "JSON has them too" says '"profile": \{"along": "rows", "profiles": 200, "points": 240, .*"deviation": \{"ra": ' rc-info --json --profile rows ridges.rcg

# ---- refusals ----

printf '1 2 3\n4 nan 6\n7 8 9\n' >holed.txt
rc-import --quiet --dx 1um --z-unit um holed.txt -o holed.rcg
claim "rows with holes are omitted" says 'left out   1 with missing points' rc-info --profile rows --sections 1 holed.rcg
refuses 1 '--profile 0: point 1 of the profile was not measured: fill the map first, with rc-detrend --fill' "a line through a hole" "rc-info --profile 0 --sections 1 holed.rcg"
refuses 1 'a profile of 3 points has no 5 sections: give fewer --sections' "three points in five sections" "rc-info --profile rows holed.rcg"
refuses 1 'the line leaves the map, whose nodes reach 2e-05 m by 2e-05 m' "a line beyond the map" "rc-info --profile 0,0:30um,0 plane.rcg"
refuses 2 '--profile slant: it must be rows, columns, an angle' "no line" "rc-info --profile slant plane.rcg"
refuses 2 '--profile 0,0:1: it must be' "half a place" "rc-info --profile 0,0:1 plane.rcg"
refuses 2 'the line has no length' "a point" "rc-info --profile 0,0:0,0 plane.rcg"
refuses 2 '--sections has no effect without --profile' "sections of nothing" "rc-info --sections 3 plane.rcg"
refuses 2 '--smr: it takes 8 heights at most' "nine heights" "rc-info --smr 0:1um:9 plane.rcg"
refuses 1 '--profile is of heights, and no frame is a height; there is: pressure' "profiles of a pressure" "rc-info --profile rows p.rcg"
refuses 1 'writing failed|No space' "a full disk" "rc-info --report /dev/full egg.rcg"
