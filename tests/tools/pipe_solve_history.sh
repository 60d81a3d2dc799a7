# SPDX-License-Identifier: GPL-3.0-or-later
# --history: each load acts on the shape after the earlier loads. Unloading, and loading again up to the
# largest load so far, is elastic; and the result equals that of the same sequence in separate runs.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 128 --ny 120 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 40um --short-cut 4um --seed 7 -o s.rcg
physics="--quiet --periodic --estar 3GPa --hardness 150MPa --tol 1e-7"
loads=(50mN 100mN 30mN 0 100mN 70mN 130mN)
# shellcheck disable=SC2086
rc-solve $physics --history --load "$(IFS=, && echo "${loads[*]}")" --output pressure,height,plastic \
    --report history.json s.rcg -o history.rcg
claim "each load is a case" test "$(wc -l <history.json)" = 7

of_case() { sed -n "$2p" history.json >case.json && field "$1" case.json; }
yields() { awk -v a="$(of_case yielded_area "$1")" 'BEGIN { exit !(a > 1e-12) }'; }
for k in 1 2 7; do
    claim "case $k has the largest load so far, and nodes yield" yields $k
done
for k in 3 4 5 6; do
    near "$(of_case yielded_area $k)" 0 0 "case $k, no larger than one before: nothing yields"
done
near "$(of_case contact_area 5)" "$(of_case contact_area 2)" 1e-3 "reloaded: the contact of the first time"
near "$(of_case max_pressure 5)" "$(of_case max_pressure 2)" 1e-4 "  its largest pressure"
near "$(of_case mean_gap 5)" "$(of_case mean_gap 2)" 1e-5 "  its mean gap"
near "$(of_case load 4)" 0 0 "no load: no force"
near "$(of_case contact_nodes 4)" 0 0 "  no contact"
claim "  the approach is null" test "$(of_case approach 4)" = null
# for separated bodies the mean gap is the difference between the highest and the mean height of the current
# shape
shape=$(rc-info --json history.rcg 2>/dev/null | grep '"channel": "plastic"' | grep '"case": "*4' | head -n 1)
echo "$shape" >shape.json
near "$(of_case mean_gap 4)" "$(awk -v a="$(field maximum shape.json)" -v b="$(field mean shape.json)" 'BEGIN { printf "%.17g", a - b }')" \
    1e-6 "  and a mean gap from first touch"

# Separate runs: press, take the plastic shape, press it again.
cp s.rcg now.rcg
for k in 0 1 2 4 5 6; do
    # shellcheck disable=SC2086
    rc-solve $physics --load "${loads[k]}" --output pressure,plastic --report hand.json now.rcg -o hand.rcg
    rc-pick --channel plastic --set channel=height hand.rcg -o now.rcg
    near "$(of_case contact_area $((k + 1)))" "$(field contact_area hand.json)" 1e-3 "load $k (${loads[k]}) by hand: contact area"
    near "$(of_case approach $((k + 1)))" "$(field approach hand.json)" 1e-4 "  approach"
    near "$(of_case yielded_area $((k + 1)))" "$(field yielded_area hand.json)" 0.01 "  area that yields"
done

# An approach that flattens so much that every node of the shape it leaves would be at its hardness there.
soft=${physics/150MPa/5MPa}
# shellcheck disable=SC2086
claim "an approach is not judged by the shape that it leaves" rc-solve $soft --history --approach 1.2um,0.1um --output pressure --report deep.json s.rcg -o deep.rcg
cp s.rcg now.rcg
for k in 1 2; do
    # shellcheck disable=SC2086
    rc-solve $soft --approach "$(cut -d ' ' -f $k <<<'1.2um 0.1um')" --output pressure,plastic --report hand.json now.rcg -o hand.rcg
    rc-pick --channel plastic --set channel=height hand.rcg -o now.rcg
    sed -n ${k}p deep.json >case.json
    near "$(field load case.json)" "$(field load hand.json)" 1e-4 "  load $k by hand"
done

claim "without a hardness a warning says that --history has no effect" warns '--history has no effect, because nothing yields' \
    rc-solve --periodic --estar 3GPa --history --load 2mN,1mN --output pressure s.rcg -o p.rcg
claim "--dry-run lists it among the effects" says 'history +on: each load acts on the shape' \
    rc-solve --periodic --estar 3GPa --hardness 1GPa --history --load 2mN,0 --dry-run s.rcg
claim "an interrupted and resumed run gives the same result" bash -c '
    rc-solve --quiet --periodic --estar 3GPa --hardness 150MPa --tol 1e-7 --history --load 50mN,100mN --checkpoint c.rcg \
        --output pressure --report cut.json s.rcg -o p.rcg &&
    rc-solve --quiet --periodic --estar 3GPa --hardness 150MPa --tol 1e-7 --history --load 50mN,100mN,30mN --checkpoint c.rcg --resume \
        --output pressure --report resumed.json s.rcg -o p.rcg'
sed -n 3p resumed.json >third.json
near "$(field contact_area third.json)" "$(of_case contact_area 3)" 1e-3 "  with the third load"

# The dents of earlier loads have the errors that the tolerance allowed.
dents='rc-solve --quiet --periodic --estar 3GPa --hardness 150MPa --history --load 50mN,100mN --checkpoint c.rcg --resume'
refuses 1 'another problem: --tol was 1e-07, is 1e-09$' "a smaller tolerance is refused" "$dents --tol 1e-9 -o x.rcg s.rcg"
claim "a larger one is not" bash -c "$dents --tol 1e-5 -o larger.rcg s.rcg"
