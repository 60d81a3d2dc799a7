# SPDX-License-Identifier: GPL-3.0-or-later
# A section with uneven depths is not written as an even map: it is refused, written with its depths, or
# resampled on request.
. "$(dirname "$0")/../pipe.sh"

# rows at 0, 1, 3, 10 um with the value 2 + z/um + 100 i, except in the last column. That one is a straight
# line down to 10 um
printf '2 102 202\n3 103 203\n5 105 205\n12 112 NaN\n' | rc-import --dx 1um --z-unit m - |
    sed 's/^channel=height/channel=height\nsection=y\nat=0\ndepths=0,1e-06,3e-06,1e-05/; s/^dy=.*/dy=3.3333333333333333e-06/' |
    reseal >uneven.rcg

for name in x3p sdf bsdf gsf gwy npy csv sur vti; do
    refuses 1 'uneven steps, which [a-z0-9-]* cannot say: write vtr, or resample them with --even' ".$name refuses it" \
        "rc-export uneven.rcg -o no.$name"
    claim "  the resampled section is accepted" rc-export --even uneven.rcg -o "even.$name"
done
claim "refused commands leave no file" test -z "$(ls no.* 2>/dev/null)"
for name in vtr xyz h5; do
    claim ".$name has the depths of its rows" rc-export uneven.rcg -o "as-it-is.$name"
done
claim "  xyz has the depth beside each value" grep -qx -- '-1e-06 3e-06 5' as-it-is.xyz

# the smallest step is 1 um: eleven rows, on the straight line
claim "values between rows are interpolated linearly, with rows at the smallest step" bash -c "
    rc-export --even --format csv uneven.rcg | grep -v '^#' | awk -F , -v tolerance=$rounding '
        function off(x, want) { return (x - want) / want > tolerance || (want - x) / want > tolerance }
        { j = NR - 1; bad += off(\$1, 2 + j) + off(\$2, 102 + j) + (j <= 3 ? off(\$3, 202 + j) : \$3 != \"NaN\") }
        END { exit !(NR == 11 && bad == 0) }'"
claim "a message names the even rows" says '^# Height: 1.1e-05 m' rc-export --even --format csv uneven.rcg
claim "the history says so" says '<Comment>.* rc-export [0-9.]* --even</Comment>' unzip -p even.x3p main.xml
sed 's/^depths=.*/depths=0,1e-06,2e-06,3e-06/; s/^dy=.*/dy=1e-06/' uneven.rcg | reseal >even.rcg
claim "even rows do not change" bash -c '
    rc-export --even --format csv even.rcg >a && rc-export --format csv even.rcg | cmp - a'
printf '1 2\n3 4\n' | rc-import --dx 1um --z-unit m - -o map.rcg
claim "a map does not change either" bash -c 'rc-export --even --format csv map.rcg >a && rc-export --format csv map.rcg | cmp - a'
sed 's/^depths=.*/depths=0,1e-09,3e-06,1e-05/' uneven.rcg | reseal >fine.rcg
claim "the number of rows has a limit, with a message" warns 'the smallest step .* would make 10001 rows: 4096 are made' \
    rc-export --even fine.rcg -o fine.csv
claim "  the file has at most so many rows" test "$(grep -vc '^#' fine.csv)" = 4096
sed 's/^depths=.*/depths=0,1e-06,3e-06/' uneven.rcg | reseal >few.rcg
refuses 1 'a section of 4 rows without as many depths' "fewer depths than rows" 'rc-export --even few.rcg -o no.csv'
sed 's/^depths=.*/depths=0,1e-06,3e-06,2e-06/' uneven.rcg | reseal >back.rcg
refuses 1 'must rise from row to row' "depths that go back" 'rc-export back.rcg -o no.vtr'
refuses 1 'need about .*, --memory allows' "more memory than is allowed" 'rc-export --even --memory 90K fine.rcg --format csv'
