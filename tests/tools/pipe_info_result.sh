# SPDX-License-Identifier: GPL-3.0-or-later
# rc-info prints the main figures of a solution: load, contact, largest pressure, approach, yielding area, and
# convergence; it omits unknown figures.
. "$(dirname "$0")/../pipe.sh"

# pressure "KEY=VALUE..." <text: makes a frame of pressures in Pa on cells of 1 um by 2 um.
pressure() {
    local keys
    keys=$(printf '%s' "$1" | sed 's/ /\\n/g')
    rc-import --dx 1um --dy 2um --z-unit m - | sed "s/^channel=height/channel=pressure${keys:+\\n$keys}/; s/^unit=m/unit=Pa/" | reseal
}
values='0 1e9 2e9\n3e9 3e9 0\n'

# ---- figures computed by hand ----

printf "$values" | pressure "hardness=3e9 approach=1.25e-07 converged=yes load=77" >hand.rcg
rc-info hand.rcg >hand.txt
# the load is 9 GPa times 2 um2; four nodes of six touch, two of them at 3 GPa
for line in '  load       18 mN' '  contact    8 um2, 66.7 % of the map (4 of 6 nodes)' '  pressure   at most 3 GPa' \
    '  approach   125 nm' '  hardness   3 GPa, reached on 4 um2 (2 nodes)' '  converged  yes'; do
    claim "$line" grep -qxF -- "$line" hand.txt
done
claim "the figures of a result are at the top" bash -c 'sed -n 2p hand.txt | grep -q "^  load" && sed -n 8p hand.txt | grep -q "^  grid"'
rc-info --json hand.rcg >hand.json
claim "the JSON is read by a parser" perl -MJSON::PP -e 'decode_json($_) for <>' hand.json
claim "  the figures form an object" grep -q '"result": {"load": .*}, "keys": {' hand.json
near "$(field load hand.json)" 0.018 "$rounding" "  load of the values, not of the key"
near "$(field contact_nodes hand.json)" 4 "$same" "  nodes in contact"
near "$(field contact_area hand.json)" 8e-12 "$rounding" "  their area"
near "$(field contact_fraction hand.json)" 0.6666666666666666 "$rounding" "  their part of the map"
near "$(field max_pressure hand.json)" 3e9 "$same" "  the largest pressure"
near "$(field approach hand.json)" 1.25e-7 "$same" "  approach"
near "$(field hardness hand.json)" 3e9 "$same" "  hardness"
near "$(field plastic_area hand.json)" 4e-12 "$rounding" "  the area that yields"
claim "  the key converged is true" grep -q '"converged": true}' hand.json

# ---- unknown figures ----

printf "$values" | pressure "" >bare.rcg
rc-info bare.rcg >bare.txt
claim "without keys the load and the contact are printed" bash -c 'grep -q "^  load       18 mN" bare.txt && grep -q "^  contact    8 um2" bare.txt'
claim "  nothing else is printed" lacks '^  (approach|hardness|converged)' bare.txt
claim "  JSON has null" says '"approach": null, "hardness": null, "plastic_area": null, "converged": null}' rc-info --json bare.rcg
printf '0 NaN 2e9\n3e9 3e9 0\n' | pressure "approach=1e-7 hardness=3e9" >holes.rcg
rc-info holes.rcg >holes.txt
claim "with missing values neither sum nor area is printed" bash -c 'lacks "^  (load|contact)" holes.txt && ! grep -q "at most" holes.txt'
claim "  the figures of the keys are printed" bash -c 'grep -qx "  approach   100 nm" holes.txt && grep -qx "  hardness   3 GPa" holes.txt'
printf "$values" | pressure "hardness=4e9" >elastic.rcg
claim "a hardness that the pressure does not reach is printed as such" says '^  hardness   4 GPa, not reached$' rc-info elastic.rcg
for key in hardness=soft approach=null converged=perhaps; do
    printf "$values" | pressure "$key" >odd.rcg
    refuses 1 "$key: it must be " "a key with a value that it cannot have: $key" "rc-info odd.rcg"
done
claim "a height has no figures of a result" bash -c 'rc-pick --channel pressure --set channel=height hand.rcg | rc-info >h.txt; lacks "^  (load|contact)" h.txt'
claim "  its JSON has none either" bash -c 'rc-pick --set channel=height hand.rcg | rc-info --json >h.json; lacks "\"result\"" h.json'

# ---- figures of a solution ----

rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-height 10nm --seed 2 -o rough.rcg
rc-solve --quiet --load 100mN --hardness 300MPa --estar 100GPa --report report.json rough.rcg -o result.rcg
claim "a solution has four frames" says '^4$' bash -c 'rc-info --json result.rcg | wc -l'
rc-info --json result.rcg | head -n 1 >info.json
for name in load contact_nodes contact_area contact_fraction max_pressure approach plastic_area; do
    near "$(field $name info.json)" "$(field $name report.json)" "$summed" "$name is that of the solver's report"
done
# a float cannot hold 300,000,007: the nearest one is 300,000,000
rc-solve --quiet --load 100mN --hardness 300000007 --estar 100GPa --type f32 --report report.json rough.rcg -o single.rcg
rc-info --json single.rcg | head -n 1 >info.json
near "$(field plastic_area info.json)" "$(field plastic_area report.json)" "$summed" "single precision reaches the hardness too"
claim "  this concerns some nodes" says 'reached on [1-9]' rc-info single.rcg
rc-solve --quiet --load 100mN --estar 100GPa --tol 1e-18 rough.rcg -o short.rcg
claim "a tolerance that cannot be reached ends with 3" test $? = 3
rc-info short.rcg >short.txt 2>short.err
claim "  and rc-info ends with 3 too" test $? = 3
claim "a result that stopped short says so" grep -qx '  converged  no: it stopped short of its accuracy' short.txt
