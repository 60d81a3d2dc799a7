# SPDX-License-Identifier: GPL-3.0-or-later
# rc-scene: its verdicts are those of the tools that compute the effects, each command that it names runs, and verdicts
# do not depend on the scale of lengths and moduli.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/scenes.sh"

rc-synth sphere --radius 7.5mm --nx 128 --dx 5um -o ball.rcg
rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-height 0.3um --rolloff 20um --short-cut 6um --seed 5 -o rough.rcg
steel="--E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3"

# ---- verdicts are those of the tool that computes the effect ----

all="--E1 210GPa --nu1 0.3 --E2 70GPa --nu2 0.33 --mu 0.3 --adhesion 0.1,exponential,8nm --coefficient 1e-9mm3/Nm --distance 10m"
scene --periodic --mean-pressure 0.2GPa $all --decide 100 rough.rcg >decided.json
scene --periodic --mean-pressure 0.2GPa $all rough.rcg >plain.json
rc-solve --quiet --periodic --mean-pressure 0.2GPa --E1 210GPa --nu1 0.3 --E2 70GPa --nu2 0.33 --report e.json -o e.rcg rough.rcg
rc-wear --quiet --coefficient 1e-9mm3/Nm --distance 10m --report w.json -o x.rcg e.rcg
worn=$(awk -v a="$(field contact_area w.json)" -v b="$(field contact_area e.json)" 'BEGIN { d = a / b - 1; print d < 0 ? -d : d }')
between "$(of wear plain.json figures contact_area low)" "$worn" "$(of wear plain.json figures contact_area high)" "the area of a worn contact is in its interval"
claim "with --decide undecided effects are computed" test "$(of adhesion plain.json verdict)" = "not decided" -a "$(of adhesion decided.json decided)" = 1
command=$(effect adhesion plain.json | perl -MJSON::PP -e 'local $/; print join " ", @{JSON::PP->new->decode(<STDIN>)->{command}}')
eval "$command --quiet --report own.json -o x.rcg rough.rcg"
near "$(of adhesion decided.json figures contact_area high)" "$(awk -v a="$(field contact_area own.json)" -v b="$(field contact_area e.json)" 'BEGIN { d = a / b - 1; print d < 0 ? -d : d }')" 1e-6 \
    "  and its command gives the same change"

# ---- commands: each one that is printed runs ----

# COMMANDS OPTION...: commands of a scene, each run on rough.rcg; those that fail are printed
commands() {
    rc-scene --quiet --periodic "$@" -o table.txt rough.rcg || return 1
    grep '^      rc-' table.txt | sed 's/   (about.*//' >commands.txt
    test -s commands.txt || return 1
    while read -r line; do
        eval "$line --quiet" >/dev/null 2>said.txt || { test $? = 3 || { echo "# $line: $(cat said.txt)"; return 1; }; }
    done <commands.txt
}
everything="--mean-pressure 0.2GPa $all --tangential 0.5N --speed 1m/s --conductivity 45W/mK,45W/mK --diffusivity 12mm2/s,12mm2/s --time 1ms
    --bending-limit 700MPa --torsion-limit 450MPa --pressure-drop 1MPa --hardness 3GPa --yield 1GPa --thickness 10um"
claim "each command of a scene with all effects runs" commands $everything
claim "  and writes a file with the name of the effect" bash -c 'for effect in wear heat fatigue; do rc-info scene-$effect.rcg >/dev/null || exit 1; done'
rc-scene --quiet --load 240N --body1 100Cr6 --body2 6061-T6 --mu 0.1 --speed 1m/s ball.rcg >typed.txt
claim "a hardness has the number of its table" grep -q -- '--hardness 107HV ball.rcg -o scene-hardness.rcg' typed.txt
named="--load 240N --body1 100Cr6 --body2 6061-T6"
scene $named ball.rcg >named.json
rc-solve --quiet $named --report plain.json -o x.rcg ball.rcg
claim "rc-solve leaves the hardness of a material out" grep -q '"hardness": "left out: no --hardness' plain.json
near "$(perl -MJSON::PP -e 'local $/; print JSON::PP->new->decode(<STDIN>)->{max_pressure}' <named.json)" "$(field max_pressure plain.json)" 1e-4 "  and so does the contact of rc-scene"
claim "  whose row of the hardness takes it" test "$(of hardness named.json verdict)" = "calls for it"
claim "  and other values their units" grep -q 'rc-heat --mu 0.1 --speed 1m/s --conductivity 46.6W/mK,167W/mK --diffusivity 12.6mm2/s,69mm2/s -o scene-heat.rcg' typed.txt
rc-scene --quiet --load 240N --E1 2.1e5MPa --nu1 0.30 --E2 rigid --hardness 129HV ball.rcg >typed.txt
claim "  values stand as they were typed" grep -q -- '^      rc-solve --load 240N --E1 2.1e5MPa --nu1 0.30 --E2 rigid --hardness 129HV ball.rcg -o scene-hardness.rcg' typed.txt
rc-scene --quiet --mean-pressure 0.2GPa --periodic $all --layer 1.0um,100GPa,0.30 --layer 500nm,150GPa,0.25 rough.rcg >typed.txt
claim "  also layers" grep -q -- '--layer 1.0um,100GPa,0.30 --layer 500nm,150GPa,0.25' typed.txt
# the errors of a coarse grid are told by the command itself
rc-synth sphere --nx 32 --dx 20um --radius 7.5mm -o coarse.rcg
rc-scene --quiet --load 240N $steel coarse.rcg >grid.txt
sed -n 's/^      \(rc-solve .* -o scene-grid.rcg\).*/\1/p' grid.txt >grid.sh
claim "the command for a finer grid tells the errors by the grid" bash -c 'grep -q -- "--discretization --verbose" grid.sh &&
    eval "$(cat grid.sh) --report grid.json" 2>told.txt && grep -q "estimated error by the grid: contact area [0-9.]* %, largest pressure [0-9.]* %, approach [0-9.]* %" told.txt'
told() { sed -n "s/.*estimated error by the grid: .*$1 \([0-9.]*\) %.*/\1e-2/p" told.txt; }
for figure in contact_area max_pressure approach; do
    near "$(told "$(sed 's/max_/largest /; s/_/ /' <<<$figure)")" "$(field ${figure}_error_estimate grid.json)" 0.06 "  those of the report: $figure"
done
scene --load 240N $steel coarse.rcg >coarse.json
claim "the interval of the area ends at 0.6 times that bound" awk -v high="$(of grid coarse.json figures contact_area high)" -v bound="$(field contact_area_error_estimate grid.json)" \
    'BEGIN { exit !(high > 0 && high <= 0.6001 * bound) }'
scene --load 240N $steel --figures area --decide 1000 coarse.rcg >coarse.json
claim "--decide says why it does not compute the grid" test "$(of grid coarse.json verdict)/$(of grid coarse.json not_computed)" = \
    "not decided/rc-solve --discretization has the estimates on which this interval rests: only a finer map decides"
claim "  in the table too" says '^      not computed: rc-solve --discretization has' rc-scene --quiet --load 240N $steel --figures area --decide 1000 coarse.rcg
claim "  but not without --decide" bash -c "! rc-scene --quiet --load 240N $steel --figures area coarse.rcg | grep 'not computed'"
claim "  with a coat" commands $everything --layer 1um,100GPa,0.3
claim "  which rc-heat refuses: no command, and the reason" grep -q '^      no tool computes it: rc-heat: its body 1 has layers' table.txt
claim "  with a viscosity the leak has a flow" bash -c "rc-scene --quiet --periodic $(echo $everything) --viscosity 1mPas rough.rcg | grep -q 'rc-leak --pressure-drop 1MPa --viscosity'"
claim "  with a relaxation modulus" commands --mean-pressure 20kPa --relaxation 1MPa,9MPa:1ms,2MPa:0.1s --nu1 0.49 --E2 rigid --time 10ms --pressure-drop 1kPa --thickness 100um
claim "  the elastic ones with the modulus at once" grep -q 'rc-solve --mean-pressure 20kPa --E1 12MPa' table.txt
limits="--bending-limit 3000MPa --torsion-limit 1930MPa --figures fatigue"
scene --periodic --mean-pressure 0.2GPa $all $limits --decide 100 rough.rcg >fatigue.json
rc-fatigue --quiet --bending-limit 3000MPa --torsion-limit 1930MPa --pass x --depths auto --report f.json -o x.rcg e.rcg
larger() { awk -v a="$(field crossland f.json)" -v b="$(field dangvan f.json)" -v e="$(field crossland_error_estimate f.json)" -v f="$(field dangvan_error_estimate f.json)" \
    -v sign="$1" 'BEGIN { print (a > b ? a * (1 + sign * e) : b * (1 + sign * f)) }'; }
claim "--decide computes the fatigue" test "$(of fatigue fatigue.json decided)" = 1
near "$(of fatigue fatigue.json figures fatigue_index high)" "$(larger 1)" 1e-5 "  the index of rc-fatigue and its error"
near "$(of fatigue fatigue.json figures fatigue_index low)" "$(larger -1)" 1e-5 "  on both sides"

# ---- laws ----

verdicts() { perl -MJSON::PP -e 'local $/; my $r = JSON::PP->new->decode(<STDIN>); print join ",", map { $_->{verdict} } sort { $a->{effect} cmp $b->{effect} } @{$r->{scene}}' <"$1"; }
rc-synth selfaffine --nx 64 --dx 10um --hurst 0.8 --rms-height 3um --rolloff 200um --short-cut 60um --seed 5 -o large.rcg
large="--E1 210GPa --nu1 0.3 --E2 70GPa --nu2 0.33 --mu 0.3 --adhesion 1,exponential,80nm --coefficient 1e-9mm3/Nm --distance 100m --hardness 3GPa --yield 1GPa"
scene --periodic --mean-pressure 0.2GPa $all --hardness 3GPa --yield 1GPa rough.rcg >small.json
scene --periodic --mean-pressure 0.2GPa $large large.rcg >large.json
claim "ten times larger bodies get the same verdicts" test "$(verdicts small.json)" = "$(verdicts large.json)"
scene --periodic --mean-pressure 0.2MPa --E1 210MPa --nu1 0.3 --E2 70MPa --nu2 0.33 --mu 0.3 --adhesion 0.1mJ/m2,exponential,8nm \
    --coefficient 1e-6mm3/Nm --distance 10m --hardness 3MPa --yield 1MPa rough.rcg >soft.json
claim "bodies that are a thousand times softer too" test "$(verdicts small.json)" = "$(verdicts soft.json)"
wider() { # a larger bound keeps what is negligible
    local last= now
    for bound in 0.001 0.005 0.02 0.1 0.5; do
        now=$(scene --periodic --mean-pressure 0.2GPa $all --hardness 3GPa --yield 1GPa --within $bound rough.rcg |
            perl -MJSON::PP -e 'local $/; print join " ", sort map { $_->{verdict} eq "negligible" ? $_->{effect} : () } @{JSON::PP->new->decode(<STDIN>)->{scene}}')
        for e in $last; do [[ " $now " = *" $e "* ]] || return 1; done
        last=$now
    done
}
claim "a larger bound leaves what is negligible" wider
