# SPDX-License-Identifier: GPL-3.0-or-later
# --dry-run: the number of convolutions that it predicts is within a factor of 2 of that of the run, for each model.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 96 --dx 1um --hurst .8 --rms-slope .05 --rolloff 24um --short-cut 8um --seed 3 -o rough.rcg
body='--E1 1GPa --nu1 0.3 --E2 rigid'

# forecast TEXT FACTOR COMMAND: the plan's convolutions beside those of all rows of the report, times FACTOR
forecast() {
    $3 --quiet --dry-run >plan.txt
    $3 --quiet --report run.json -o out.rcg
    claim "$1: $(grep -o 'about [0-9]* convolutions.*' plan.txt)" awk -v factor="$2" '
        FILENAME == "plan.txt" && match($0, /about [0-9]+ conv/) { plan = substr($0, RSTART + 6) + 0 }
        FILENAME == "run.json" { rows++
            if (match($0, /"convolutions": [0-9.e+]+/)) run += substr($0, RSTART + 16) + 0
            if (match($0, /"applications": [0-9]+/)) a = substr($0, RSTART + 16) + 0
            if (match($0, /"slabs": [0-9]+/)) run += 3.3 * a * (substr($0, RSTART + 9) + 0) }
        END { print plan, run, rows; exit !(plan <= 2 * factor * run / rows && run * factor / rows <= 2 * plan) }' plan.txt run.json
    claim "  and a time" says '[0-9] s( with|$)' cat plan.txt
}
forecast "a load" 1 "rc-solve --periodic --estar 1GPa --mean-pressure 5MPa rough.rcg"
forecast "loads, each with its stiffness" 1 "rc-solve --periodic --estar 1GPa --mean-pressure 2MPa,5MPa rough.rcg"
forecast "an approach" 1 "rc-solve --periodic --estar 1GPa --approach 0.3um rough.rcg"
forecast "a map that repeats along y, its stiffness and conductance" 1 \
    "rc-solve --periodic=y --estar 1GPa --mean-pressure 5MPa --conductivity 45W/mK,16W/mK rough.rcg"
forecast "an approach on a map that repeats along x" 1 "rc-solve --periodic=x --estar 1GPa --approach 0.3um rough.rcg"
forecast "a coated body on it" 1 "rc-solve --periodic=x $body --layer 3um,3GPa,0.3 --mean-pressure 2MPa rough.rcg"
forecast "a free tilt" 1 "rc-solve --estar 1GPa --mean-pressure 5MPa --tilt free rough.rcg"
forecast "a coated body" 1 "rc-solve $body --layer 3um,3GPa,0.3 --mean-pressure 2MPa rough.rcg"
forecast "relaxation, a point" 1 "rc-solve --relaxation 1MPa,4MPa:1ms,2MPa:30ms --nu1 0.4 --E2 rigid --load 1mN --time 1ms:1s:log:4 rough.rcg"
forecast "attraction" 1 "rc-solve --periodic --estar 10MPa --adhesion 50mJ/m2,exponential,50nm --mean-pressure 30kPa rough.rcg"
forecast "yield, 4 increments" 1 "rc-solve --periodic $body --mean-pressure 5MPa --yield 15MPa --increments 4 rough.rcg"
forecast "yield, auto" 1 "rc-solve $body --mean-pressure 2MPa --yield 30MPa rough.rcg"
claim "a body that does not yield costs an elastic contact" says 'about [567] convolutions' \
    rc-solve --periodic $body --mean-pressure 5MPa --yield 0.9GPa --dry-run rough.rcg
rc-solve --quiet $body --mean-pressure 2MPa rough.rcg -o pressed.rcg
forecast "friction, with a run with half of the increments" 1.5 "rc-slip --mu 0.3 --coupling none --tangential 3mN pressed.rcg"
forecast "wear" 1 "rc-wear --coefficient 0,1e-6mm3/Nm --motion track:5mm --distance 100m pressed.rcg"
rc-synth sphere --nx 64 --dx 1um --radius 2mm -o sphere.rcg
rc-solve --quiet --load 0.2N --E1 150GPa --nu1 0.2 --E2 150GPa --nu2 0.2 sphere.rcg -o ball.rcg
forecast "steady rolling" 1 "rc-slip --mu 0.3 --creep 1e-3,0 --steady ball.rcg"

# ---- stresses ----

fatigue="rc-fatigue --bending-limit 60MPa --torsion-limit 37MPa --pass x --depths 1um:9um:3"
claim "stresses have a time" says 'about [0-9]+ MiB, [0-9.e-]+ s with' rc-stress --depths 0:9um:4 --dry-run pressed.rcg
claim "  it is unknown where the memory is too small" says 'MiB, unknown time' rc-stress --memory 1M --depths 0:9um:4 --dry-run pressed.rcg
claim "fatigue has a time" says 'about [0-9]+ MiB, [0-9.e-]+ s with' $fatigue --dry-run pressed.rcg
claim "  it is unknown where the memory is too small" says 'MiB, unknown time' $fatigue --memory 1M --dry-run pressed.rcg

# ---- flow and heat ----

claim "a leak has memory and a time" says 'about [0-9]+ MiB, [0-9.e-]+ s with' rc-leak --dry-run pressed.rcg
claim "  as heat does" says 'about 12 convolutions, [0-9]+ MiB, [0-9.e-]+ s with' \
    rc-heat --mu 0.3 --speed 1 --conductivity 45,45 --diffusivity 1.2e-5,1.2e-5 --dry-run pressed.rcg
rc-heat --quiet --mu 0.3 --speed 1 --conductivity 45,45 --diffusivity 1.2e-5,1.2e-5 --report heat.json -o hot.rcg pressed.rcg
between 6 "$(field convolutions heat.json)" 24 "  within a factor of 2 of the run"
