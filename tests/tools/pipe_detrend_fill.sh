# SPDX-License-Identifier: GPL-3.0-or-later
# rc-detrend warns when it fills more than a twentieth of a surface, and gives the width of the widest hole.
. "$(dirname "$0")/../pipe.sh"

# map NX NY 'awk condition of i and j': makes a map whose points are missing where the condition holds.
map() {
    awk "BEGIN { for (j = 0; j < $2; j++) { s = \"\"
        for (i = 0; i < $1; i++) s = s \" \" (($3) ? \"NaN\" : i + j)
        print s } }" </dev/null | rc-import --dx 1um --dy 2um --z-unit nm -
}

map 20 20 'i >= 5 && i < 9 && j >= 5 && j < 10' >twentieth.rcg
claim "filling a twentieth of the points causes no warning" bash -c 'rc-detrend --fill twentieth.rcg -o out.rcg 2>said; [ ! -s said ]'
map 20 20 'i >= 5 && i < 12 && j >= 5 && j < 8' >more.rcg
# 7 columns of 1 um, 3 rows of 2 um: the middle is 4 um from the rim on all sides
claim "filling more causes a warning with the share and the largest width" \
    warns 'rc-detrend: .*, case 1, frame 1 \(height\): 5\.25 % of the points were missing \(21 of 400\).* widest hole is 8 um wide' \
    rc-detrend --fill more.rcg -o out.rcg
claim "a hole in a plane is filled with the plane" bash -c "
    rc-export --format csv out.rcg | grep -v '^#' | awk -F, '{ for (i = 1; i <= NF; i++) { d = \$i * 1e9 - (i - 1 + NR - 1); if (d * d > 1e-16) bad = 1; n++ } }
        END { exit bad || n != 400 }'"
map 20 20 'i < 5' >edge.rcg
# the outermost column is 5 um from the only rim
claim "a hole at the edge counts as twice as wide" warns '25 % .* widest hole is 10 um wide' rc-detrend --fill edge.rcg -o out.rcg
claim "--quiet suppresses the warning" bash -c 'rc-detrend --quiet --fill edge.rcg -o out.rcg 2>said; [ ! -s said ]'
claim "a second --fill causes no warning" bash -c 'rc-detrend --fill out.rcg -o again.rcg 2>said; [ ! -s said ]'
claim "the warning is printed once" test "$(rc-detrend --fill --plane --fill edge.rcg 2>&1 >/dev/null | wc -l)" = 1
claim "levelling alone causes no warning" bash -c 'rc-detrend --plane edge.rcg -o out.rcg 2>said; [ ! -s said ]'
