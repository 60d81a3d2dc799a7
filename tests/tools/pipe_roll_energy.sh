# SPDX-License-Identifier: GPL-3.0-or-later
# Heat and wear of a contact that rolls, through pipes: rc-heat and rc-wear take the friction energy of rc-slip, whose sum is force times
# creepage and moment times spin, and refuse to take mu p for it.
. "$(dirname "$0")/../pipe.sh"

report() { perl -ne 'print $1 if /"'"$1"'": ([-0-9.e+]+)/' "$2"; }
number() { awk "BEGIN { printf \"%.17g\", ($1) }"; }
values() { rc-pick --channel "$2" --case "${3:-1}" "$1" | rc-export --format csv | grep -v '^#' | tr ',' '\n'; }
sum() { values "$@" | awk '{ s += $1 } END { printf "%.17g", s }'; }

rc-synth sphere --nx 48 --dx 10um --radius 7.5mm |
    rc-solve --quiet --load 100N --E1 210GPa --nu1 .3 --E2 210GPa --nu2 .3 -o ball.rcg
frames=height,pressure,state,slip,dissipation
steel="--conductivity 50W/mK,50W/mK --diffusivity 14mm2/s,14mm2/s --quiet"
rc-slip --mu 0.3 --creep 5e-4,0 --steady --report slip.json --output $frames -o rolled.rcg ball.rcg
rc-slip --mu 0.3 --creep 1e-3,-5e-4,20 --steady --report spin.json --output $frames -o spin.rcg ball.rcg

# ---- the energy ----

near "$(number "1e-10 * $(sum rolled.rcg dissipation)")" "$(number "5e-4 * $(report tangential_x slip.json)")" 1e-9 "the dissipation adds up to force times creepage"
near "$(number "1e-10 * $(sum spin.rcg dissipation)")" \
    "$(number "1e-3 * $(report tangential_x spin.json) - 5e-4 * $(report tangential_y spin.json) + 20 * $(report moment spin.json)")" 1e-9 "  and moment times spin"
paste -d ' ' <(values rolled.rcg state) <(values rolled.rcg dissipation) <(values rolled.rcg slip) <(values rolled.rcg pressure) >four.txt
claim "  is 0 where nodes stick, and above 0 where they slip" awk '$1 == 2 ? $2 <= 0 : $2 != 0 { exit bad = 1 } END { exit bad || NR != 2304 }' four.txt
claim "  and is mu times pressure times slip" awk '{ d = 0.3 * $4 * $3 - $2; if (d * d > 1e-18 * $2 * $2) exit bad = 1 } END { exit bad }' four.txt
rc-pick --channel dissipation -o energy.rcg rolled.rcg
claim "  per length rolled" says '^unit=J/m3$' bash -c "head -c 200 energy.rcg | tr -d '\0'"

# ---- creepages in per cent ----

claim "a plain creepage of 0.1 has a warning" warns 'creep 0.1:1:10: a creepage of 0.1 is 10 %: write 0.1% for 0.1 percent' \
    rc-slip --mu 0.3 --creep 0.1:1:10,0 --steady --dry-run ball.rcg -o plan.txt
claim "  not one in per cent, nor a spin" bash -c "rc-slip --mu 0.3 --creep 10%,-0.04,20 --steady --dry-run ball.rcg -o plan.txt 2>said.txt; ! grep -q creepage said.txt"

# ---- heat ----

rc-heat --rolling 2m/s $steel --report heat.json -o hot.rcg rolled.rcg
near "$(report heat_power heat.json)" "$(number "2 * 5e-4 * $(report tangential_x slip.json)")" 1e-9 "the heat is force times creepage times speed"
near "$(number "1e-10 * ($(sum hot.rcg heat-1) + $(sum hot.rcg heat-2))")" "$(report heat_power heat.json)" 1e-9 "  into both bodies together"
near "$(report speed heat.json)" 1e-3 1e-9 "  at the sliding speed of the creepage"
near "$(report share_1 heat.json)" 0.5 1e-2 "  half into each of two equal bodies"
rc-slip --mu 0.3 --creep 5e-4:1e-3:2,-1e-4,20 --steady --output $frames ball.rcg | rc-heat --rolling 2m/s $steel --report creeps.tsv -o x.rcg
claim "  rows have the speed of rolling, the creepages and the spin" bash -c "
    head -n 1 creeps.tsv | grep -q 'rolling_speed/m/s.creep_x.creep_y.spin/rad/m' &&
    awk -F'\t' 'NR == 1 { for (i = 1; i <= NF; i++) at[\$i] = i; next }
        { print \$at[\"rolling_speed/m/s\"], \$at[\"creep_x\"], \$at[\"creep_y\"], \$at[\"spin/rad/m\"] }' creeps.tsv >creeps.txt &&
    diff creeps.txt <(printf '2 0.0005 -0.0001 20\n2 0.001 -0.0001 20\n')"
claim "  and the largest temperature is drawn over the creepage" bash -c "
    rc-render --curve creep_x:max_temperature -o curve.svg creeps.tsv && grep -q 'reepage along x' curve.svg"
rc-render --curve max_temperature:speed -o speed.svg creeps.tsv
claim "  the column speed is that of sliding" grep -q '>Sliding speed' speed.svg
claim "  and warms their trailing edge most" test "$(number "$(report max_x heat.json) < -50e-6")" = 1
refuses 1 'friction of rc-slip, a frame (slip|state|dissipation).*--rolling' "mu p beside frames of partial slip" \
    "rc-heat --mu 0.3 --speed 1m/s $steel -o x.rcg rolled.rcg"
rc-slip --mu 0.3 --tangential 10N -o pushed.rcg ball.rcg
refuses 1 'friction of rc-slip, a frame traction-x' "mu p beside tractions" "rc-heat --mu 0.3 --speed 1m/s $steel -o x.rcg pushed.rcg"
claim "  but the pressure alone is taken" bash -c "rc-pick --channel pressure pushed.rcg | rc-heat --mu 0.3 --speed 1m/s $steel -o x.rcg"
refuses 1 'no frame with the channel dissipation.*: rc-slip writes it with --output pressure,dissipation$' "rolling without its energy" \
    "rc-slip --mu 0.3 --creep 5e-4,0 --steady ball.rcg | rc-heat --rolling 2m/s $steel -o x.rcg"
refuses 1 'J/m3: give the speed of rolling with --rolling' "a frequency of a contact that rolls" "rc-heat --frequency 5Hz $steel -o x.rcg rolled.rcg"
rc-slip --mu 0.3 --path '100N,0,0; 100N,10N,0; 100N,-10N,0; 100N,10N,0' --output $frames -o cycle.rcg ball.rcg
refuses 1 'J/m2: give the cycles per second with --frequency' "a speed of rolling of a cycle" "rc-heat --rolling 5m/s $steel -o x.rcg cycle.rcg"
refuses 2 '--rolling .*--moving' "--rolling and --moving" "rc-heat --rolling 5m/s --moving 1m/s,1m/s $steel -o x.rcg rolled.rcg"
refuses 2 '--mu .*--rolling' "two sources of heat" "rc-heat --rolling 5m/s --mu 0.3 $steel -o x.rcg rolled.rcg"

# ---- wear ----

rc-wear --energy 3e-5mm3/J,1e-5mm3/J --cycles 200 --report wear.json -o worn.rcg rolled.rcg
length=480e-6
near "$(report wear_volume wear.json)" "$(number "4e-14 * 200 * $length * 5e-4 * $(report tangential_x slip.json)")" 1e-9 "passes wear the coefficient times their energy"
near "$(number "1e-10 * $(sum worn.rcg wear-1)")" "$(number "0.75 * $(report wear_volume wear.json)")" 1e-9 "  of body 1 three quarters"
claim "  evenly along the rows, which pass through the contact" bash -c "
    rc-pick --channel wear worn.rcg | rc-export --format csv | grep -v '^#' |
        awk -F, '{ for (i = 2; i <= NF; i++) if (\$i != \$1) exit bad = 1; most = \$1 > most ? \$1 : most } END { exit bad || !(most > 0) }'"
rc-wear --coefficient 1.2e-5mm3/Nm --cycles 200 --report slid.json -o x.rcg rolled.rcg
near "$(report wear_volume slid.json)" "$(report wear_volume wear.json)" 1e-9 "a coefficient of sliding wears as mu times that of the energy"
rc-pick --case 3,4 cycle.rcg >two.rcg
energy=$(number "1e-10 * ($(sum two.rcg dissipation 3) + $(sum two.rcg dissipation 4))")
rc-wear --energy 3e-5mm3/J --cycles 50 --report fretted.json -o fretted.rcg two.rcg
near "$(report wear_volume fretted.json)" "$(number "3e-14 * 50 * $energy")" 1e-9 "cycles of fretting wear the coefficient times their energy"
paste -d ' ' <(values fretted.rcg wear 4) <(values two.rcg dissipation 3) <(values two.rcg dissipation 4) >three.txt
claim "  at each node" awk '{ d = $1 - 3e-14 * 50 * ($2 + $3); if (d * d > 1e-18 * $1 * $1) exit bad = 1 } END { exit bad }' three.txt
counts() { # FILE: the keys cycles and distance of its heights, a line each
    rc-pick --channel height "$1" | rc-info --json | grep -oE '"(cycles|distance)": *"?[0-9.e+-]+'
}
claim "a number of cycles is no distance" warns 'case 2, load 100 N, cycles 100000: contact fraction' \
    rc-wear --verbose --energy 3e-5mm3/J --cycles 50,100000 --report count.tsv -o count.rcg two.rcg
claim "  nor in the keys" test "$(counts count.rcg | tr -d ' "')" = "$(printf 'cycles:50\ncycles:100000')"
claim "  also beside the distance of an earlier run" bash -c "
    rc-wear --quiet --coefficient 1e-9mm3/Nm --distance 1um ball.rcg | rc-slip --quiet --mu 0.3 --tangential 10N --output height,dissipation |
        rc-wear --quiet --energy 1e-5mm3/J --cycles 7 -o later.rcg"
claim "    the key distance is gone" test "$(counts later.rcg | tr -d ' "')" = cycles:7
claim "  nor in pictures" bash -c 'rc-render --channel wear --case 2 -o count.svg count.rcg && grep -q "cycles 100000" count.svg && ! grep -q distance count.svg &&
    rc-render --channel wear --case 1,2 -o counts.svg count.rcg && grep -q ">a) cycles 50<" counts.svg'
claim "  and its curve is drawn" rc-render --curve cycles:max_wear_depth -o curve.svg count.tsv
refuses 1 'friction of rc-slip, a frame traction-x.*--cycles instead of --distance' "full sliding beside tractions" \
    'rc-slip --mu 0.3 --tangential 10N --output height,traction-x ball.rcg | rc-wear --coefficient 1e-6mm3/Nm --distance 1m -o x.rcg'
refuses 1 'friction of rc-slip, a frame state' "full sliding of a contact that rolls" \
    'rc-pick --channel height,state rolled.rcg | rc-wear --coefficient 1e-6mm3/Nm --distance 1m -o x.rcg'
refuses 2 '--energy .*--mu or --cycles' "an energy of a distance" 'rc-wear --energy 1e-5mm3/J --distance 1m -o x.rcg rolled.rcg'
refuses 2 'no frame dissipation' "an energy that the stream does not have" 'rc-wear --energy 1e-5mm3/J --cycles 1 -o x.rcg ball.rcg'
refuses 1 'needs the frame pressure too' "slip of rolling without a pressure" \
    'rc-pick --channel height,slip rolled.rcg | rc-wear --coefficient 1e-6mm3/Nm --cycles 1 -o x.rcg'
refuses 1 '--until with the energy' "a condition" 'rc-wear --energy 1e-5mm3/J --cycles 1 --until area=0.5 -o x.rcg rolled.rcg'
for x in 0 1e-5; do rc-pick --set position=$x ball.rcg; done | rc-slip --mu 0.3 --creep 5e-4,0 --output $frames -o path.rcg
refuses 1 'a second case: .*rc-slip --steady' "the positions of a path as one cycle" 'rc-wear --energy 1e-5mm3/J --cycles 1 -o x.rcg path.rcg'
refuses 1 'own traction, and --mu 0.3 contradicts' "fatigue by mu p beside tractions" \
    'rc-fatigue --mu 0.3 --pass x --bending-limit 5e8 --torsion-limit 3e8 --depths 30um -o x.rcg pushed.rcg'
