# SPDX-License-Identifier: GPL-3.0-or-later
# A tool of options and a maker, over tools/model. Tested are history, report, frames, warnings, checkpoint
# and plan.
. "$(dirname "$0")/../pipe.sh"
toy="$RC_TOY --quiet --estar 1GPa --compliance 2e-15 --tau 2s"

# Flat bodies in full contact: p = F/A, and the bed settles by s = c p (1 - exp(-t/tau)).
rc-synth wave --nx 8 --dx 1um --amplitude 1pm --wavelength 8um -o flat.rcg
claim "a history of two lists is solved" bash -c "
    $toy --periodic --load 6.4mN --time 1s,3s,8s --tol 1e-3 --report flat.json -o flat-out.rcg flat.rcg"
for t in 1 3 8; do
    near "$(grep "\"time\": $t," flat.json | sed 's/.*"mean_settlement": \([^,]*\),.*/\1/')" \
        "$(awk "BEGIN { printf \"%.15g\", 2e-15 * 6.4e-3 / 64e-12 * (1 - exp(-$t / 2)) }")" 1e-12 "at $t s the settlement on paper"
done
claim "each point has its frames with their keys" says 'time=3' bash -c "strings flat-out.rcg"
claim "a row has the axes, the figures of both models, and converged" bash -c "
    grep -q '\"max_pressure\": .*\"time\": 8, .*\"rejected\": .*\"converged\": true' flat.json"

rc-synth selfaffine --nx 32 --dx 1um --hurst 0.8 --rms-slope 0.1 --seed 3 -o rough.rcg
rough="$toy --load 1mN,2mN --time 1s,4s"
claim "a rough surface is solved" bash -c "$rough --checkpoint kept.rcg --report whole.json -o whole.rcg rough.rcg"
interrupted() {
    local status
    $rough --tol 1e-4 --checkpoint cut.rcg --interval 0 --report cut.json -o cut-out.rcg rough.rcg &
    until [ -s cut.rcg ] || ! kill -0 $!; do sleep 0.02; done
    kill -TERM $!
    wait $!
    status=$?
    [ $status = 143 ] && rc-info cut.rcg >/dev/null
}
claim "after a signal the checkpoint has a state" interrupted
claim "another run continues from it" bash -c "
    $rough --tol 1e-4 --checkpoint cut.rcg --resume --report on.json -o on.rcg rough.rcg &&
    $rough --tol 1e-4 --report straight.json -o straight.rcg rough.rcg"
near "$(tail -1 on.json | sed 's/.*"mean_settlement": \([^,]*\),.*/\1/')" \
    "$(tail -1 straight.json | sed 's/.*"mean_settlement": \([^,]*\),.*/\1/')" 1e-6 "to the same settlement"
refuses 1 'another problem: --tau was 2, is 3' "the state of another problem" \
    "${rough/tau 2s/tau 3s} --checkpoint kept.rcg --resume -o x.rcg rough.rcg"
refuses 1 'another problem: load was 0.002, is 0.003' "the state of another history" \
    "${rough/1mN,2mN/1mN,3mN} --checkpoint kept.rcg --resume -o x.rcg rough.rcg"
refuses 2 '--load has 2 values and --time 3: give lists of equal length' "lists of two lengths" \
    "${rough/1s,4s/1s,4s,5s} -o x.rcg rough.rcg"
refuses 2 '--resume has no effect without --checkpoint' "--resume by itself" "$rough --resume -o x.rcg rough.rcg"
claim "--dry-run prints the points and writes no frame" says '32 x 32 nodes, 2 points of the relaxing model' \
    bash -c "$rough --dry-run rough.rcg"
claim "a figure beyond its limit causes one full warning, with advice, and a list of the other cases" bash -c "
    ${rough/--quiet/} -o warn.rcg rough.rcg 2>warn.txt
    grep -q 'case 1, load 1 mN, time 1 s: share of the load at the edge is .*, above 0.01: the contact reaches the edge of the map: take a larger map' warn.txt &&
    grep -q 'case 2 too: the contact reaches the edge of the map' warn.txt"
