# SPDX-License-Identifier: GPL-3.0-or-later
# rc-scene: verdicts about contacts whose answer is known, from Hertz, Mindlin, the limit of slow sliding and the tools
# themselves; refusals. pipe_scene_commands runs the commands that it names.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/scenes.sh"

# ---- Hertz: a steel ball of 7.5 mm under 240 N: p0 2.22 GPa, first yield at 0.62 p0 ----

rc-synth sphere --radius 7.5mm --nx 128 --dx 5um -o ball.rcg
steel="--E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3"
scene --load 240N $steel --yield 1.40GPa --hardness 2.3GPa --mu 0.3 --tangential 36N \
    --speed 1um/s --conductivity 50W/mK,50W/mK --diffusivity 14mm2/s,14mm2/s ball.rcg >ball.json
claim "a ball below first yield is elastic" test "$(of yield ball.json verdict)/$(of yield ball.json basis)" = negligible/exact
near "$(of yield ball.json numbers mises_over_yield)" 0.983 0.01 "  Mises stress over yield stress, 0.62 p0/1.4 GPa"
claim "a hardness above p0 changes nothing" test "$(of hardness ball.json verdict)/$(of hardness ball.json basis)" = negligible/exact
near "$(of slip ball.json numbers stick_fraction)" 0.6300 0.02 "half of the limiting force: 0.5^(2/3) of the contact sticks (Mindlin)"
near "$(of slip ball.json figures displacement high)" 0.1422 0.005 "  the displacement is 11.02 % above the linear one: 1.2 times this and 1 %"
near "$(of slip ball.json figures displacement low)" 0.0782 0.005 "  and 0.8 times this less 1 %"
# a ball that --radius adds to a flat map: the commands add it again to the heights of the file
rc-synth wave --amplitude 1e-15 --wavelength 640um --nx 128 --dx 5um -o flat-ball.rcg
scene --load 240N --radius 7.5mm $steel --yield 0.7GPa flat-ball.rcg >flat-ball.json
claim "with --radius the commands are named" eval 'effect yield flat-ball.json | grep -q "\"--radius\",\"7.5mm\"" && [ "$(of yield flat-ball.json refused)" = null ]'
claim "like bodies do not feel friction" test "$(of dissimilar ball.json verdict)/$(of dissimilar ball.json basis)" = negligible/exact
# slow sliding: T = 3 pi/8 q a/(2 K), q = mu V P/(pi a^2), a = 227.6 um
near "$(of heat ball.json numbers temperature_at_rest)" "$(awk 'BEGIN { pi = atan2(0, -1); a = (3 * 240 * 7.5e-3 / (4 * 210e9 / 1.82)) ^ (1 / 3); print 3 * pi / 8 * 0.3 * 1e-6 * 240 / (pi * a * a) * a / 100 }')" 2e-3 \
    "the temperature of slow sliding is 3 pi/8 of the mean flux times a/(2 K)"
scene --load 240N $steel --yield 1.33GPa --hardness 2.0GPa ball.rcg >lower.json
claim "a ball above first yield is not negligible" test "$(of yield lower.json verdict)" != negligible
claim "a hardness below p0 is called for" test "$(of hardness lower.json verdict)" = "calls for it"
near "$(of hardness lower.json figures max_pressure high)" "$(awk 'BEGIN { print 1 - 2.0 / 2.2238 }')" 0.01 "  it lowers the largest pressure to the hardness"
scene --load 240N $steel --mu 0.3 --tangential 36N --hardness 2.2GPa ball.rcg >dented.json
near "$(of slip dented.json numbers stick_fraction)" 0.6300 0.02 "  and with a hardness just below the largest pressure"
scene --load 240N $steel --mu 0.3 --tangential 80N ball.rcg >slides.json
claim "a force above mu times the load: the bodies slide" test "$(of slip slides.json verdict)" = "calls for it"
scene --load 1uN $steel --adhesion 1mJ/m2,exponential,20nm ball.rcg >few.json
claim "few nodes in contact decide nothing" test "$(of adhesion few.json verdict)" = "not decided"
claim "  and the table says so" says "nodes in contact; refine the grid first" rc-scene --quiet --load 1uN $steel --adhesion 1mJ/m2,exponential,20nm ball.rcg

# ---- rolling: Kalker's linear theory, C11 = 4.12 for a round contact and nu = 0.25; and Coulomb's law ----

quarter="--E1 210GPa --nu1 0.25 --E2 210GPa --nu2 0.25"
scene --load 240N $quarter --mu 0.3 --creep 1e-5,0 ball.rcg >rolls.json
claim "with little creepage rolling is negligible" test "$(of rolling rolls.json verdict)/$(of rolling rolls.json basis)" = negligible/computed
near "$(of rolling rolls.json figures friction high)" "$(awk 'BEGIN { a2 = (3 * 240 * 7.5e-3 / (4 * 210e9 / (2 * (1 - 0.25 ^ 2)))) ^ (2 / 3); print 4.12 * 210e9 / 2.5 * a2 * 1e-5 / 240 }')" 0.05 \
    "  its force is that of Kalker's linear theory"
scene --load 240N $quarter --mu 0.3 --creep 0.1,0 ball.rcg >rolls.json
claim "with much creepage it is called for" test "$(of rolling rolls.json verdict)" = "calls for it"
near "$(of rolling rolls.json figures friction high)" 0.3 1e-6 "  the force is the coefficient of friction times the load"
claim "  and the table says so" says "the tangential force is 0.3 times the load" rc-scene --quiet --load 240N $quarter --mu 0.3 --creep 0.1,0 ball.rcg
claim "wear of a rolling contact is not that of one that stays and slides" bash -c "
    rc-scene --quiet --load 240N $quarter --mu 0.3 --creep 0.1,0 --coefficient 1e-8mm3/Nm --distance 1km ball.rcg >wears.txt
    grep -q 'wear .*not decided: a rolling contact slides by its creepage alone: .* --cycles' wears.txt && ! grep -q 'rc-wear --coefficient' wears.txt"
rc-solve --quiet --load 240N $quarter ball.rcg | rc-slip --quiet --mu 0.3 --steady --creep 0.1,0 --output height,pressure,slip -o wears.rcg
claim "  the programs that it names compute it" rc-wear --quiet --coefficient 1e-8mm3/Nm --cycles 10 wears.rcg -o worn.rcg
claim "rolling of a contact at the edge of the map has no estimate" bash -c "rc-scene --quiet --load 100kN $quarter --mu 0.3 --creep 1e-3,0 ball.rcg | grep -q 'reaches the right edge of the map'"
claim "  nor on a periodic map" bash -c "rc-scene --quiet --periodic --load 240N $quarter --mu 0.3 --creep 1e-3,0 ball.rcg | grep -q 'needs a map that is free along x'"

# ---- pull-off: 2 pi w R of a stiff ball (Bradley), 3/2 pi w R of a soft one (Johnson, Kendall and Roberts) ----

pulls() { # LOAD OPTION...: the interval of the pull-off force over the load
    scene --load "$@" >pulls.json
    echo "$(of pull-off pulls.json figures pull_off low) $(of pull-off pulls.json figures pull_off high)"
}
rc-synth sphere --radius 100nm --nx 128 --dx 0.7nm -o stiff.rcg
read -r low high < <(pulls 40nN --E1 160GPa --nu1 0.22 --E2 rigid --adhesion 0.01,exponential,1nm stiff.rcg)
force=$(awk 'BEGIN { print 2 * 3.14159265 * 0.01 * 100e-9 / 40e-9 }')
between "$low" "$force" "$high" "the pull-off force of a stiff ball is in its interval"
near "$(of pull-off pulls.json numbers rigid_pull_off_over_load)" "$force" 0.03 "  and that of rigid bodies is 2 pi w R"
claim "  it is called for" test "$(of pull-off pulls.json verdict)" = "calls for it"
rc-synth sphere --radius 2mm --nx 64 --dx 6um -o soft.rcg
soft="--E1 1.5MPa --nu1 0.49 --E2 rigid --adhesion 0.05,exponential,0.6um"
read -r low high < <(pulls 100uN $soft soft.rcg)
between "$low" "$(awk 'BEGIN { print 1.5 * 3.14159265 * 0.05 * 2e-3 / 100e-6 }')" "$high" "so is that of a soft ball"
scene --load 30mN $soft --figures pull-off --within 0.016 --decide 1000 soft.rcg >pulls.json
claim "--decide computes the pull-off" test "$(of pull-off pulls.json decided)" = 1
$(effect pull-off pulls.json | perl -MJSON::PP -e 'local $/; print join " ", @{JSON::PP->new->decode(<STDIN>)->{command}}') --quiet --report own.json -o x.rcg soft.rcg
between "$(of pull-off pulls.json figures pull_off low)" "$(tail -n 1 own.json | sed 's/.*"pull_off_load": -\([0-9.e-]*\).*/\1/' | awk '{ print $1 / 30e-3 }')" "$(of pull-off pulls.json figures pull_off high)" \
    "  as its command does"
claim "hard balls of millimetres do not stick" test "$(scene --load 5N $steel --adhesion 0.05,exponential,100nm ball.rcg >pulls.json; of pull-off pulls.json verdict)" = negligible

# ---- a grid that does not resolve the attraction decides nothing ----

rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-height 0.3um --rolloff 20um --short-cut 6um --seed 5 -o rough.rcg
# 3.3 nm: 1.28 nodes in the cohesive length, E* range^2/work; there are estimates from 1.1, but rc-solve wants 1.5
for range in 2nm 3.3nm; do
    stick="--periodic --mean-pressure 0.2GPa --E1 210GPa --nu1 0.3 --E2 70GPa --nu2 0.33 --adhesion 0.5,exponential,$range"
    scene $stick --within 0.05 --decide 1000 rough.rcg >coarse.json
    claim "a range of $range, below the spacing: --decide computes nothing" test "$(of adhesion coarse.json verdict)/$(of adhesion coarse.json decided)/$(of pull-off coarse.json decided)" = "not decided/0/0"
    claim "  and the row says which grid decides it" grep -q 'the grid does not resolve the range of adhesion: take a spacing of [0-9]* nm, or, if only the work matters, a range of 4.13 nm' coarse.json
    claim "  as rc-solve does" warns "take a spacing of $(of adhesion coarse.json unfit | sed 's/.*spacing of \([^,]*\),.*/\1/')" rc-solve ${stick%,*},$range rough.rcg -o x.rcg
    rc-scene --quiet $stick --within 0.05 --decide 1000 rough.rcg | sed -n 's/^      \(rc-pick --resample .* -o scene-adhesion.rcg\)$/\1/p' >fine.sh
    claim "  its command takes this grid, which resolves the range" eval '[ -s fine.sh ] && bash fine.sh 2>said.txt && ! grep -q "too coarse" said.txt && [ -s scene-adhesion.rcg ]'
done

scene --load 240N $steel --thickness 0.5mm ball.rcg >thin.json
claim "the command of a thin body has its layer" grep -q '"--E1", "rigid", "--layer", "0.5mm,210GPa,0.3"' thin.json
$(effect thin thin.json | perl -MJSON::PP -e 'local $/; print join " ", @{JSON::PP->new->decode(<STDIN>)->{command}}') --quiet --report own.json -o x.rcg ball.rcg
rc-solve --quiet --load 240N $steel --report e.json -o x.rcg ball.rcg
near "$(of thin thin.json figures max_pressure high)" "$(awk -v a="$(field max_pressure own.json)" -v b="$(field max_pressure e.json)" 'BEGIN { d = a / b - 1; print d < 0 ? -d : d }')" 1e-3 \
    "  and it computes the change"

# ---- a rough block: the edges ----

claim "a rough block: the largest pressure is at its edge" warns "no property of the surface" rc-scene --mean-pressure 1GPa --estar 100GPa rough.rcg -o table.txt
claim "data that are missing are named" grep -q "wear (--coefficient --distance)" table.txt

rc-synth sphere --radius 7.5mm --nx 31 --dx 50um -o lone.rcg

# ---- fatigue, leak, warnings ----

# a pass of a ball: the largest Mises stress is 0.62 p0, its amplitude at least half of it over sqrt 3
scene --load 240N $steel --bending-limit 700MPa --torsion-limit 450MPa ball.rcg >fatigue.json
between "$(awk 'BEGIN { print 0.98 * 0.62 * 2.2238e9 / (2 * sqrt(3)) / 450e6 }')" "$(of fatigue fatigue.json figures fatigue_index high)" \
    "$(awk 'BEGIN { print 1.06 * 0.62 * 2.2238e9 / sqrt(3) / 450e6 }')" "the index of fatigue is between the bounds by the Mises stress"
claim "  of a smooth body 1, and the row says so" bash -c "rc-scene --quiet --load 240N $steel --bending-limit 700MPa --torsion-limit 450MPa ball.rcg |
    grep -q 'as if this surface passed over a smooth body 1; a rough body 1 needs .rc-solve --travel'"
rc-solve --quiet --load 240N $steel -o pressed.rcg ball.rcg
rc-fatigue --quiet --bending-limit 700MPa --torsion-limit 450MPa --pass x --depths auto --report f.json -o x.rcg pressed.rcg
index=$(awk -v a="$(field crossland f.json)" -v b="$(field dangvan f.json)" 'BEGIN { print (a > b ? a : b) }')
between "$(of fatigue fatigue.json figures fatigue_index low)" "$index" "$(of fatigue fatigue.json figures fatigue_index high)" "  and holds that of rc-fatigue"
claim "around a ball the gap is open" test "$(scene --load 240N $steel --pressure-drop 1kPa ball.rcg >leak.json; of leak leak.json verdict)" = "calls for it"
rc-synth wave --wavelength 64um --amplitude 1um --nx 64 --dx 1um -o wave.rcg
claim "a ridge across the flow closes it" test "$(scene --periodic --mean-pressure 1GPa $steel --pressure-drop 1kPa wave.rcg >leak.json; of leak leak.json verdict)" = negligible
oil="--viscosity 0.1Pas --pressure-viscosity 2e-8"
rc-synth selfaffine --nx 64 --dx 5um --hurst 0.8 --rms-height 20nm --rolloff 100um --short-cut 30um --seed 5 -o fine.rcg
# h = 3.63 R U^0.68 G^0.49 W^-0.073 (1 - exp(-0.68)), R 10 mm, 20 N, 2 m/s: 0.28 um
claim "a thick film: a warning" warns "a film of the fluid may carry load: it is 278[0-9.]* nm thick, 14 times the RMS roughness" \
    rc-scene --load 20N --radius 10mm $steel --mu 0.05 --speed 2m/s $oil fine.rcg -o x.txt
claim "  not at 1 mm/s" bash -c "rc-scene --load 20N --radius 10mm $steel --mu 0.05 --speed 1mm/s $oil fine.rcg -o x.txt 2>&1 | tee said.txt >/dev/null; ! grep -q 'film of the fluid' said.txt"
claim "thermal expansion: a warning" warns "thermal expansion may change the contact" rc-scene --load 240N $steel --mu 0.3 --speed 1m/s --conductivity 45W/mK,45W/mK \
    --diffusivity 12mm2/s,12mm2/s --expansion 12e-6 ball.rcg -o x.txt
claim "a periodic map has no edge" bash -c "! rc-scene --periodic --mean-pressure 0.5GPa $steel rough.rcg -o x.txt 2>&1 | grep -q edge"
scene --periodic --mean-pressure 0.5GPa $steel rough.rcg >edge.json
claim "  nor the row of a finer grid: its pressure has an interval" test "$(of grid edge.json figures max_pressure high)" != null
claim "noise: a warning" warns "the noise of the scan is 1[.0-9]* % of the approach" rc-scene --load 240N $steel --noise 0.1um ball.rcg -o x.txt

for limit in hardness yield; do
    claim "--$limit without its unit: a warning" warns "--$limit, 300 Pa, is below a ten-thousandth of the largest pressure, 2.2[0-9]* GPa: give its unit, as in 300MPa" \
        rc-scene --load 240N $steel --$limit 300 ball.rcg -o x.txt
done
claim "  not of 300 MPa" bash -c "! rc-scene --load 240N $steel --yield 300MPa ball.rcg -o x.txt 2>&1 | grep -q 'give its unit'"
claim "one node is not several" says ': 1 node in contact; refine the grid first' rc-scene --quiet --load 1mN $steel --tangential 0.1mN --mu 0.3 lone.rcg

# ---- an interval has one unit ----

rc-synth sphere --nx 64 --dx 10um --radius 10mm -o worn.rcg
wears() { rc-scene --quiet --load 1N --E1 210GPa --nu1 0.3 --E2 rigid --coefficient 1e-6mm3/Nm --distance "$1" worn.rcg; }
claim "an interval that ends below 10 is in per cent" says 'changes the contact area by 2[0-9]* % to 4[0-9]* %' wears 30mm
claim "  one that begins below 10 and ends above it is in times" says 'changes the contact area by 7\.6[0-9]* times to 16\.[0-9]* times' wears 10m

# ---- adhesion of a viscoelastic body: at once, and the row says so ----

rc-synth sphere --radius 1mm --nx 64 --ny 64 --dx 10um -o soft.rcg
sticky="--load 100uN --nu1 0.5 --E2 rigid --adhesion 0.05,exponential,1um"
adheres() { rc-scene --quiet $sticky "$@" --figures area,pull-off soft.rcg | grep '^  adhesion\|^  pull-off'; }
adheres --relaxation 1MPa,1MPa:1ms --time 1s >rubber.txt
claim "adhesion of a viscoelastic body names its modulus, and the one of the relaxed body" test \
    "$(grep -c '; at once, with the modulus 2 MPa: --E1 1MPa instead of --relaxation gives the row of the relaxed body$' rubber.txt)" = 2
claim "  its row is that of the modulus named" diff <(sed 's/; at once, with.*//' rubber.txt) <(adheres --E1 2MPa)
claim "  a fluid has no relaxed modulus" test "$(adheres --relaxation 0,2MPa:1ms --time 1ms | grep -c '; at once, with the modulus 2 MPa$')" = 2

# ---- relaxation: the contact grows under a constant load as an elastic one with J(t) ----

material="--relaxation 1MPa,9MPa:1ms,2MPa:0.1s --nu1 0.5 --E2 rigid"
scene --periodic --mean-pressure 20kPa $material --time 10ms rough.rcg >relax.json
rc-solve --quiet --periodic --mean-pressure 20kPa $material --time 0,10ms --report times.tsv -o x.rcg rough.rcg
change() { awk -F '\t' -v c="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == c) at = i } NR == 2 { a = $at } NR == 3 { print $at / a - 1 }' times.tsv; }
near "$(of relaxation relax.json figures approach high)" "$(change approach/m)" 2e-3 "relaxation changes the approach as rc-solve --time computes it"
near "$(of relaxation relax.json figures contact_area high)" "$(change contact_area/m2)" 0.01 "  and the area to a node"

# linear elasticity: the pressure of the time over the modulus of the time
rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-height 0.2um --rolloff 20um --short-cut 6um --seed 5 -o gentle.rcg
gentle="--periodic --mean-pressure 20kPa"
scene $gentle $material --time 10ms gentle.rcg >relax.json
rc-solve --quiet $gentle $material --time 10ms --report times.json -o x.rcg gentle.rcg
estar=$(awk -v load="$(field load times.json)" -v more="$(field equivalent_load times.json)" 'BEGIN { print 16e6 * load / more }')
rc-solve --quiet $gentle --estar "$estar" --report times.json -o x.rcg gentle.rcg
near "$(of relaxation relax.json numbers max_pressure_over_modulus)" "$(awk -v p="$(field max_pressure times.json)" -v e="$estar" 'BEGIN { print p / e }')" 2e-3 \
    "the largest pressure over the modulus of the time"
claim "  above 0.1 it has a warning" warns '0.01 s after the load acts the largest pressure, about 47[0-9.]* kPa, is 0.11 of E. at this time' rc-scene $gentle $material --time 10ms gentle.rcg -o x.txt
claim "  though the contact at once has none" bash -c "rc-scene $gentle $material gentle.rcg -o x.txt 2>&1 | tee said.txt >/dev/null; ! grep -q 'not linear' said.txt"
claim "  a warning of that one names its modulus" warns 'is 0.12 of the instantaneous E.: beyond 0.1' rc-scene ${gentle/20kPa/100kPa} $material gentle.rcg -o x.txt

# a seal of rubber closes as it creeps
seal="--periodic --mean-pressure 200kPa $material --pressure-drop 1kPa"
leaks() { rc-solve --quiet --periodic --mean-pressure 200kPa $material --time "$1" rough.rcg | rc-leak --quiet --report leaks.json -o x.rcg; }
scene $seal --time 10ms rough.rcg >seal.json
leaks 10ms
claim "a leak is that of the relaxed contact" test "$(of leak seal.json verdict)/$(field percolates leaks.json)" = negligible/false
near "$(of leak seal.json numbers contact_fraction)" "$(field contact_fraction leaks.json)" 0.002 "  whose contact rc-solve --time computes"
claim "  and the row says its time" says 'closed between the edges, 0.01 s after the load acts' rc-scene --quiet $seal --time 10ms rough.rcg
scene $seal rough.rcg >seal.json
leaks 0
claim "without a time it is the leak at once" test "$(of leak seal.json verdict)/$(field percolates leaks.json)/$(of leak seal.json numbers time)" = "calls for it/true/0"
claim "  and the row says so" says 'open from edge to edge, at once; --time gives a later contact' rc-scene --quiet $seal rough.rcg
claim "  also beside a hardness" says 'open from edge to edge, at once: relaxation is not computed beside' rc-scene --quiet $seal --time 10ms --hardness 1MPa rough.rcg
scene ${seal/200kPa/100kPa} --time 10ms rough.rcg >seal.json
claim "the command of a leak has the time" grep -q '"rc-solve", .*"--time", "10ms", "|", "rc-leak"' <(effect leak seal.json | sed 's/,/, /g')

# ---- lists and figures ----

claim "--figures counts only what matters" test "$(scene --load 240N $steel --hardness 2.0GPa --figures approach ball.rcg | tee f.json >/dev/null; of hardness f.json verdict)" = negligible
rc-scene --quiet --load 100N,240N $steel --hardness 2.0GPa --report list.tsv ball.rcg >two.txt
claim "each load of a list has its table" test "$(grep -c 'case 1:' two.txt)" = 2
claim "  and each effect its row" test "$(awk 'END { print NR }' list.tsv)" = 35
claim "every verdict ends with status 0" scene --load 240N $steel ball.rcg

# ---- heat of rolling: --speed is that of rolling, and the bodies slide by the creepage ----

warm="--conductivity 50W/mK,50W/mK --diffusivity 14mm2/s,14mm2/s"
rolling="--load 240N $steel --mu 0.3 --creep 0.5%,0,0.1 --speed 30m/s $warm"
scene $rolling ball.rcg >rolling.json
near "$(of heat rolling.json numbers sliding_speed)" "$(awk 'BEGIN { print 30 * (0.005 + 0.1 * 227.6e-6) }')" 1e-4 "the sliding speed is that of creepage and spin"
near "$(of heat rolling.json numbers temperature_at_rest)" "$(awk 'BEGIN { pi = atan2(0, -1); a = (3 * 240 * 7.5e-3 / (4 * 210e9 / 1.82)) ^ (1 / 3); print 3 * pi / 8 * 0.3 * 30 * (0.005 + 0.1 * a) * 240 / (pi * a * a) * a / 100 }')" 2e-3 \
    "  and so is the heat"
near "$(of heat rolling.json numbers peclet)" "$(awk 'BEGIN { print 30 * 227.6e-6 / 28e-6 }')" 0.02 "  but the bodies move with the speed of rolling"
claim "nodes that stick make no heat" test "$(of heat rolling.json figures temperature low)" = 0
rc-scene --quiet $rolling ball.rcg >rolling.txt
claim "the command rolls" grep -q '| rc-slip --mu 0.3 --creep 0.5%,0,0.1 --steady --output pressure,dissipation | rc-heat --rolling 30m/s --conductivity 50W/mK,50W/mK --diffusivity' rolling.txt
scene $rolling --decide 1000 ball.rcg >decided.json
rc-solve --quiet --load 240N $steel ball.rcg |
    rc-slip --quiet --mu 0.3 --creep 0.5%,0,0.1 --steady --output pressure,dissipation |
    rc-heat --quiet --rolling 30m/s $warm --report - >heat.json
near "$(of heat decided.json figures temperature high)" "$(field max_temperature heat.json)" 5e-3 "--decide computes its temperature"
claim "  which is below the bound" awk -v t="$(field max_temperature heat.json)" -v b="$(of heat rolling.json figures temperature high)" 'BEGIN { exit !(t > 0.02 * b && t < b) }'
claim "no heat of rolling along an axis that repeats" bash -c "rc-scene --quiet --periodic --time 1ms $rolling ball.rcg | grep -q 'frictional heat .*steady rolling needs a map that is free along x'"
claim "a film of bodies that roll has their speed" warns 'it is 278[0-9.]* nm thick' \
    rc-scene --load 20N --radius 10mm $steel --mu 0.05 --creep 1e-5,0 --speed 1m/s $oil fine.rcg -o x.txt
claim "a plain creepage of 0.1 has a warning" warns 'creep 0.1: a creepage of 0.1 is 10 %: write 0.1% for 0.1 percent' rc-scene --load 240N $steel --mu 0.3 --creep 0.1,0 --dry-run ball.rcg
refuses 2 'rolling on rubber is not implemented' "rubber that rolls" \
    "rc-scene --load 1N --relaxation 1MPa,2MPa:1s --nu1 0.49 --E2 rigid --mu 0.3 --creep 1e-3,0 --speed 1m/s ball.rcg"
refuses 2 'moving does not work with --creep' "one body that moves while both roll" "rc-scene $rolling --moving 1 ball.rcg"

# ---- refused ----

refuses 2 "difference: give it in K" "a temperature in degC as a bound" "rc-scene --load 1N --estar 1GPa --within-temperature 10degC ball.rcg"
refuses 2 "two numbers, for body 1 and body 2|it must be" "one conductivity" "rc-scene --load 1N --estar 1GPa --conductivity 45W/mK ball.rcg"
refuses 2 "two .x and y., or these and a spin" "four creepages" "rc-scene --load 1N --estar 1GPa --creep 1e-3,0,1,2 ball.rcg"
refuses 2 "compares with a uniform body 1" "a rigid body 1" "rc-scene --load 1N --E1 rigid --layer 1um,1GPa,0.3 --E2 rigid ball.rcg"
refuses 2 "moduli of body 1 are those of --relaxation" "two moduli of body 1" "rc-scene --load 1N --E1 1GPa --nu1 0.3 --E2 rigid --relaxation 1MPa,2MPa:1s ball.rcg"
