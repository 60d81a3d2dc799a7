# SPDX-License-Identifier: GPL-3.0-or-later
# A profile with uneven positions is refused with a message that names --even, which resamples it.
. "$(dirname "$0")/../pipe.sh"

header() {
    sed '/^$/q' "$2" | grep -a "^$1=" | sed "s/^$1=//"
}

# heights FILE: prints the values of a stream of one frame, one per line.
heights() {
    local start n
    start=$(sed -n '/^$/q; p' "$1" | wc -c)
    n=$(header nx "$1")
    tail -c +$((start + 2)) "$1" | head -c $((8 * n)) | od -An -v -w8 -t fD | tr -d ' '
}

# resampled STEP GAP FILE: prints the expected values, by a search through all pairs of neighbours. STEP and
# GAP are in the unit of the file, heights in nm
resampled() {
    awk -v step="$1" -v gap="$2" 'BEGIN { n = 0 } NR > 1 { x[n] = $1; z[n++] = $2 }
        END {
            for (k = 0; k * step <= x[n - 1] - x[0] + 1e-9 * step; k++) {
                at = x[0] + k * step; v = "nan"
                for (i = 0; i + 1 < n; i++)
                    if (at >= x[i] - 1e-9 && at <= x[i + 1] + 1e-9 && x[i + 1] - x[i] <= gap &&
                        z[i] != "nan" && z[i + 1] != "nan")
                        v = (z[i] + (z[i + 1] - z[i]) * (at - x[i]) / (x[i + 1] - x[i])) * 1e-9
                for (i = 0; i < n; i++)
                    if ((d = at - x[i]) <= 1e-9 && d >= -1e-9) v = z[i] == "nan" ? "nan" : z[i] * 1e-9
                if (v == "nan") print v; else printf "%.17g\n", v
            }
        }' "$3"
}

# same_heights A B: equal to the rounding of the heights, and missing at the same points
same_heights() {
    paste "$1" "$2" | awk '{
        if (NF != 2) { print NR, $0; bad = 1 }
        if (($1 ~ /nan/) != ($2 ~ /nan/)) { print NR, $0; bad = 1 }
        d = $1 - $2; if (d < 0) d = -d
        if ($1 !~ /nan/ && d > 1e-13 * 1e-6) { print NR, $0; bad = 1 }
        n++
    } END { exit bad || n < 3 }' >&2
}

# ---- a profile ----

# random spacings of 0.7 to 1.3 um, gaps of 4.9 and 6 um, a missing height
awk 'BEGIN { print "x [um] z [nm]"
    for (k = 0; k < 60; k++) {
        printf "%.4f %s\n", x, k == 40 ? "nan" : sprintf("%.3f", 1000 * sin(k / 5) + k)
        x += k == 20 ? 4.9 : k == 30 ? 6 : k == 59 ? 0 : k % 3 == 1 ? 1 : 0.7 + 0.6 * ((k * 29) % 60) / 59
    } }' >uneven.txt
refuses 1 "uneven.txt: the positions are not evenly spaced: .* --even resamples the profile to even steps" \
    "an uneven profile is refused by the name of the option" 'rc-import uneven.txt'

length=$(awk 'NR == 2 { a = $1 } END { printf "%.17g", $1 - a }' uneven.txt)
median=$(awk 'NR > 2 { printf "%.17g\n", $1 - p } { p = $1 }' uneven.txt | sort -g |
    awk '{ a[NR] = $1 } END { printf "%.17g", (a[int((NR + 1) / 2)] + a[int(NR / 2) + 1]) / 2 }')
step=$(awk -v l="$length" -v m="$median" 'BEGIN { printf "%.17g", l / int(l / m + 0.5) }')
claim "--even resamples it, and a message counts the missing points" \
    warns "uneven.txt: [0-9]+ of [0-9]+ nodes are missing: the points next to them are, or are more than 5 steps apart" \
    rc-import --even uneven.txt -o even.rcg
near "$(header dx even.rcg)" "$(awk -v s="$step" 'BEGIN { printf "%.17g", s * 1e-6 }')" "$rounding" \
    "the step is the median spacing, fitted to the length"
near "$(header dy even.rcg)" "$(header dx even.rcg)" "$same" "dy is dx"
heights even.rcg >even.heights
resampled "$step" "$(awk -v s="$step" -v m="$median" 'BEGIN { print 5 * (s > m ? s : m) }')" uneven.txt >even.truth
claim "heights are interpolated linearly between neighbours, or missing" same_heights even.heights even.truth
claim "they are missing in a gap and beside a missing height" test "$(grep -c nan even.truth)" -ge 6
near "$(head -n 1 even.heights)" 0 1 "the first point is a node"
near "$(tail -n 1 even.heights)" "$(awk 'END { printf "%.17g", $2 * 1e-9 }' uneven.txt)" "$rounding" "so is the last"
claim "the history has the step in SI" \
    test "$(header history even.rcg)" = "rc-import $(rc-import --version | sed 's/.* //') --even $(header dx even.rcg)"

for option in '--even=0.35um' '--even 0.35um' '--even 3.5e-7' '--ev 350nm'; do
    # shellcheck disable=SC2086
    rm -f fine.rcg
    rc-import --quiet $option uneven.txt -o fine.rcg
    claim "$option: the history is right" test "$(header history fine.rcg)" = \
        "rc-import $(rc-import --version | sed 's/.* //') --even 3.5e-07"
    heights fine.rcg >fine.heights
    resampled 0.35 "$(awk -v m="$median" 'BEGIN { print 5 * m }')" uneven.txt >fine.truth
    claim "$option: the heights are right" same_heights fine.heights fine.truth
done
rc-import --quiet --even 3um uneven.txt -o coarse.rcg
heights coarse.rcg >coarse.heights
resampled 3 15 uneven.txt >coarse.truth
claim "a coarse step bridges wider gaps, and the remainder at the end is cut" same_heights coarse.heights coarse.truth
claim "the option may be the last word" bash -c 'rc-import uneven.txt --quiet --even | cmp - even.rcg'
claim "a file may follow it" bash -c 'rc-import --quiet --even uneven.txt | cmp - even.rcg'
cp uneven.txt 2
claim "./2 is a file" bash -c 'rc-import --quiet --even ./2 | grep -a ^source=2'

# a line is the same line on any step
awk 'BEGIN { print "x [um] z [nm]"; for (k = 0; k < 50; k++) printf "%.17g %.17g\n", k + (k % 7) / 10, 3 * (k + (k % 7) / 10) - 20 }' >line.txt
rc-import --even=0.31um line.txt -o line.rcg
heights line.rcg | awk '{ d = $1 - (3 * (NR - 1) * 0.31 - 20) * 1e-9; if (d < 0) d = -d; if (d > 1e-20) bad = 1 }
    END { exit bad || NR != 159 }' >&2
claim "a straight profile stays the same line" test $? = 0

# a peak and a pit between the nodes: 10 at 1.5 and -4 at 4.5, among heights from 0 to 2; the span is 14
printf 'x [um] z [nm]\n0 0\n1 0\n1.5 10\n1.9 2\n2 2\n3 1\n4 1\n4.5 -4\n4.8 0\n5 0\n6 0\n' >peak.txt
claim "a message counts the extremes lost between nodes" \
    warns 'peak.txt: between the nodes the file has a point 57 % of its span of heights above the highest node and one 29 % below the lowest: a finer --even STEP' \
    rc-import --even=1um peak.txt
printf 'x [um] z [nm]\n0 1\n1 1\n1.5 10\n1.8 1\n2 1\n3 1\n4 1\n' >spike.txt
claim "also if all nodes are equal" warns 'above the highest' rc-import --even=1um spike.txt
claim "there is none if every extreme is a node" bash -c '! rc-import --even=0.1um peak.txt 2>&1 >out.rcg | grep between'
claim "the same holds for a list of points" warns 'row.xyz: between the nodes the file has a point 57 % ' \
    bash -c "awk '{ print NR == 1 ? \"x[um] y[um] z[nm]\" : \$1 \" 2 \" \$2 }' peak.txt >row.xyz; rc-import --even=1um row.xyz"
printf 'aISO-1.0\nNumPoints = 7\nNumProfiles = 1\nXscale = 1e-6\nYscale = 1e-6\nZscale = 1e-9\nDataType = 7\n*\n0 1 0 9 1 0 -1\n*\n' >p.sdf
claim "the same holds for other formats" warns 'p.sdf: between the nodes the file has a point 80 % of .* one 0 % below' rc-import --even=2um p.sdf

# falling positions
(head -n 1 uneven.txt; tail -n +2 uneven.txt | tac) >falling.txt
claim "falling positions are reversed" bash -c '
    cmp <(rc-import --quiet --even falling.txt | sed "s/^source=.*//; s/crc32 [0-9a-f]*$//") <(sed "s/^source=.*//; s/crc32 [0-9a-f]*$//" even.rcg)'

# ---- profiles with equal spacings ----

printf 'x [um] z [nm]\n0 1\n1 2\n2 4\n3 3\n' >plain.txt
claim "an even profile does not change" bash -c '
    cmp <(rc-import --even plain.txt | sed "s/^history=.*//; s/crc32 [0-9a-f]*$//") <(rc-import plain.txt | sed "s/^history=.*//; s/crc32 [0-9a-f]*$//")'
rc-import --even=0.5um plain.txt -o half.rcg
claim "another step changes it" same_heights <(heights half.rcg) <(printf '%s\n' 1e-9 1.5e-9 2e-9 3e-9 4e-9 3.5e-9 3e-9)
printf 'aISO-1.0\nNumPoints = 4\nNumProfiles = 1\nXscale = 1e-6\nYscale = 1e-6\nZscale = 1e-9\nDataType = 7\n*\n1 2 4 3\n*\n' >p.sdf
rc-import --even=0.5um p.sdf -o sdf.rcg
claim "the same holds for any format" same_heights <(heights sdf.rcg) <(heights half.rcg)
printf '# Width: 2 um\n# Height: 2 um\n# Value units: nm\n1 2 3\n4 5 6\n' >map.txt
claim "a map is refused, because it is not a profile" bash -c 'rc-import --even map.txt | grep -a ^ny=2'
refuses 1 "map.txt: --even STEP resamples profiles, and this is a map of 2 rows" "and takes no step" 'rc-import --even=1um map.txt'

# ---- without a unit ----

sed 1d uneven.txt >bare.txt
refuses 1 "bare.txt: the file does not give the spacing in x: --dx LENGTH says it .its steps are $(awk -v s="$step" 'BEGIN { print substr(s, 1, 6) }')" \
    "without a unit the step is named" 'rc-import --even --z-unit nm bare.txt'
refuses 1 "the positions have no unit, so that --even takes no step here" "a step in metres is refused" \
    'rc-import --even=1um --z-unit nm bare.txt'
rc-import --quiet --even --dx "${step}um" --z-unit nm bare.txt -o bare.rcg
claim "--dx gives the width" same_heights <(heights bare.rcg) even.truth
claim "the history has it" grep -aq "^history=rc-import [0-9.]* --dx $(header dx bare.rcg) --even --z-unit 1e-09$" bare.rcg
refuses 2 '--even STEP does not work with --dx' "both are a wrong command line" \
    'rc-import --even=1um --dx 1um uneven.txt'

# ---- points in a line ----

awk 'NR > 1 { printf "%.6f 2 %s\n", $1, $2 }' uneven.txt >row.xyz
awk 'NR > 1 { printf "7 %.6f %s\n", $1, $2 }' uneven.txt >column.xyz
awk 'NR > 1 { printf "%.17g %.17g %s\n", 0.6 * $1, 5 - 0.8 * $1, $2 }' uneven.txt >slant.xyz
tac slant.xyz | awk 'NR == 1 { first = $0; next } { print } END { print first }' >any.xyz
for file in row.xyz column.xyz slant.xyz; do
    refuses 1 "$file: the positions are not evenly spaced: .*--even" "$file: refused" \
        "rc-import --dx 1um --z-unit nm $file"
    rc-import --quiet --even --dx "${step}um" --z-unit nm "$file" -o line.rcg
    claim "$file: it is read along the line" same_heights <(heights line.rcg) even.truth
done
cp row.xyz row.txt
claim "a row of points is recognised by its content" bash -c 'rc-import --list --even --dx 1um row.txt | grep ": xyz$"'
rc-import --quiet --even --dx "${step}um" --z-unit nm any.xyz -o any.rcg
claim "points in any order start at the end nearer to the first" same_heights <(heights any.rcg | tac) even.truth

# ---- refusals ----

refuses 2 "--even 0 m: it must be above 0" "a step of nothing" 'rc-import --even=0 uneven.txt'
refuses 2 "--even -1um: |--even -1e-06 m: it must be above 0" "a negative step" 'rc-import --even -1um uneven.txt'
refuses 2 "--even abc" "a step that is none" 'rc-import --even=abc uneven.txt'
refuses 1 "--even 0.001 m is longer than the profile, " "a step that is longer than the profile" 'rc-import --even=1mm uneven.txt'
# 6.8e9 nodes are more than 32 bits count
refuses 1 "values need [0-9]+ MiB, more than the|6.75695e.09 nodes are too many" "a step that would need all memory" 'rc-import --even=1e-14 uneven.txt'
refuses 1 "nodes are too many" "or more" 'rc-import --even=1e-30 uneven.txt'
printf 'x [um] z [nm]\n0 1\n1 2\n1 3\n2 4\n' >stuck.txt
refuses 1 "change direction at row 3" "positions that stand still" 'rc-import --even stuck.txt'

# ---- real files ----

corpus="${RC_CORPUS:-}/corpus/profile-text"
if [ -d "$corpus" ]; then
    for file in SurfaceTopography__xy-1.txt SurfaceTopography__xy-3.txt; do
        refuses 1 "$file: the positions are not evenly spaced: .*--even" "$file" "rc-import --z-unit nm $corpus/$file"
        own=$(rc-import --even --z-unit nm "$corpus/$file" 2>&1 >/dev/null | sed 's/.*its steps are \([^ ]*\) .*/\1/')
        rc-import --quiet --even --z-unit nm --dx "${own}um" "$corpus/$file" -o real.rcg
        (echo; awk 'NF >= 2' "$corpus/$file") >real.txt
        resampled "$own" "$(awk -v s="$own" 'BEGIN { print 5 * s }')" real.txt >real.truth
        claim "$file is resampled" same_heights <(heights real.rcg) real.truth
    done
else
    untried "RC_CORPUS names no folder of real files"
fi
