# SPDX-License-Identifier: GPL-3.0-or-later
# An effect of rc-solve is one file and one row of a list (settling.c). Tested are its options, its points, its
# model around the elastic one, frames, report, plan, checkpoint and refusals.
. "$(dirname "$0")/../pipe.sh"
solve="$RC_TOY --quiet --estar 1GPa"
toy="$solve --settle-compliance 2e-15 --settle-tau 2s"

# Flat bodies in full contact: p = F/A, and the bed settles by s = c p (1 - exp(-t/tau)).
rc-synth wave --nx 8 --dx 1um --amplitude 1pm --wavelength 8um -o flat.rcg
claim "loads at times are solved" bash -c "
    $toy --periodic --load 6.4mN --settle-time 1s,3s,8s --tol 1e-3 --output pressure,settlement --report flat.json -o flat-out.rcg flat.rcg"
for t in 1 3 8; do
    s=$(awk "BEGIN { printf \"%.15g\", 2e-15 * 6.4e-3 / 64e-12 * (1 - exp(-$t / 2)) }")
    near "$(grep "\"settle_time\": $t," flat.json | sed 's/.*"mean_settlement": \([^,]*\),.*/\1/')" "$s" 1e-12 "at $t s the settlement on paper"
done
claim "its frames have their key" says 'time=8' bash -c "strings flat-out.rcg"
claim "  one is the settlement of the last time" bash -c "
    rc-info --json flat-out.rcg | grep '\"settlement\"' | grep -q '\"case\": 3'"
claim "the report has its state" grep -q '"settling": "on"' flat.json
claim "without it the state says why" says 'settling +left out: no --settle-time' bash -c "$solve --load 1mN --dry-run flat.rcg"
claim "--dry-run counts its points" says '2 times, engine' bash -c "$toy --periodic --load 1mN --settle-time 1s,3s --dry-run flat.rcg"
claim "--help has its options in a group" says '^Settling:' bash -c "$RC_TOY --help settling"

rc-synth selfaffine --nx 32 --dx 1um --hurst 0.8 --rms-slope 0.1 --seed 3 -o rough.rcg
rough="$toy --load 1mN,2mN --settle-time 1s,4s"
claim "a rough surface is solved, with a checkpoint" bash -c "$rough --checkpoint kept.rcg --report whole.json -o whole.rcg rough.rcg"
longer=${rough/1mN,2mN --settle-time 1s,4s/1mN,2mN,2mN --settle-time 1s,4s,9s}
claim "  and a longer list continues from it" bash -c "
    $longer --checkpoint kept.rcg --resume --report on.json -o on.rcg rough.rcg &&
    $longer --report straight.json -o straight.rcg rough.rcg"
near "$(tail -1 on.json | sed 's/.*"mean_settlement": \([^,]*\),.*/\1/')" \
    "$(tail -1 straight.json | sed 's/.*"mean_settlement": \([^,]*\),.*/\1/')" 1e-9 "  to the same settlement"
refuses 1 'another problem: --settle-tau was 2, is 3' "the state of another problem" \
    "${rough/tau 2s/tau 3s} --checkpoint kept.rcg --resume -o x.rcg rough.rcg"
refuses 1 'another problem: time was 4, is 5' "the state of another time" \
    "${rough/1s,4s/1s,5s} --checkpoint kept.rcg --resume -o x.rcg rough.rcg"
refuses 2 '--load has 2 values and --settle-time 3: give lists of equal length' "lists of two lengths" \
    "${rough/1s,4s/1s,4s,5s} -o x.rcg rough.rcg"
refuses 2 '--settle-time does not work with --adhesion, because it is not implemented' "another effect" \
    "$rough --adhesion 50mJ/m2 -o x.rcg rough.rcg"
refuses 2 '--settle-tau has no effect without --settle-time' "an option without the effect" "$solve --load 1mN --settle-tau 1 -o x.rcg rough.rcg"
refuses 2 '--output settlement needs --settle-time' "its frame without it" "$solve --load 1mN --output settlement -o x.rcg rough.rcg"
