# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by tools/pipe_forecast.sh and long/pipe_forecasts.sh: commands of all effects, and their forecasts.
#
# forecast_rows: a line for each command: its name, two numbers of nodes a side, the command, in which @ is this
# number. The maps of forecast_maps: h and o (rough), s (a ball), p and q (h under a load, free and periodic), b (a
# ball of steel), c (a ball on a rigid body), d (cycles of b), t (a ball travels).

forecast_maps() { # NODES
    local steel='--E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3' n=$1
    rough() { rc-synth selfaffine --nx "$n" --dx 1um --hurst .8 --rms-slope .05 --rolloff 16um --short-cut 8um --seed "$1"; }
    rough 5 >"h$n.rcg"
    rough 6 >"o$n.rcg"
    rc-synth sphere --nx "$n" --dx "$(awk -v n="$n" 'BEGIN { print 256 / n }')um" --radius 10mm >"s$n.rcg"
    rc-solve --quiet --E1 2GPa --nu1 .3 --E2 2GPa --nu2 .3 --mean-pressure 2MPa "h$n.rcg" -o "p$n.rcg"
    rc-solve --quiet --periodic --E1 2GPa --nu1 .3 --E2 2GPa --nu2 .3 --mean-pressure 5MPa "h$n.rcg" -o "q$n.rcg"
    rc-solve --quiet --load 5N $steel "s$n.rcg" -o "b$n.rcg"
    rc-solve --quiet --load 5N --E1 210GPa --nu1 0.3 --E2 rigid "s$n.rcg" -o "c$n.rcg"
    rc-slip --quiet --mu 0.3 --path '5N,0,0;5N,0.8N,0;5N,-0.8N,0;5N,0.8N,0' --output pressure,dissipation,slip,height "b$n.rcg" |
        rc-pick --case 3,4 -o "d$n.rcg"
    rc-synth selfaffine --nx $((2 * n)) --ny "$n" --dx "$(awk -v n="$n" 'BEGIN { print 256 / n }')um" --hurst .8 \
        --rms-slope .002 --rolloff 60um --short-cut 30um --seed 6 |
        rc-solve --quiet --radius 10mm --load 1N $steel --travel=-20um:20um:5 -o "t$n.rcg"
}

forecast_rows() {
    local metal='--E1 1GPa --nu1 0.3 --E2 rigid' sticky='--estar 10MPa --adhesion 50mJ/m2,exponential,50nm'
    local rubber='--relaxation 2MPa,4MPa:10ms,8MPa:1ms --nu1 0.49 --E2 rigid' limits='--nu 0.3 --bending-limit 60MPa --torsion-limit 37MPa'
    local warm='--conductivity 45W/mK,16W/mK --diffusivity 12mm2/s,4mm2/s'
    cat <<ROWS
elastic, free|64 256|rc-solve --estar 1GPa --mean-pressure 2MPa h@.rcg
elastic, a ball|64 256|rc-solve --estar 114GPa --load 5N s@.rcg
elastic, periodic, 1e-8|64 256|rc-solve --periodic --estar 1GPa --mean-pressure 5MPa --tol 1e-8 h@.rcg
elastic, along y|64 256|rc-solve --periodic=y --estar 1GPa --mean-pressure 2MPa h@.rcg
elastic, by approach|64 256|rc-solve --periodic --estar 1GPa --approach 0.3um h@.rcg
elastic, loads and their stiffness|64 256|rc-solve --periodic --estar 1GPa --mean-pressure 1MPa:9MPa:5 h@.rcg
hardness|64 256|rc-solve --periodic --estar 1GPa --mean-pressure 5MPa --hardness 60MPa h@.rcg
hardness, a history|64 256|rc-solve --periodic --estar 1GPa --mean-pressure 2MPa,5MPa,1MPa,0 --hardness 40MPa --history h@.rcg
conductance|64 256|rc-solve --periodic --estar 1GPa --mean-pressure 5MPa --conductivity 45W/mK,16W/mK h@.rcg
layer|64 256|rc-solve --layer 3um,3GPa,0.3 $metal --mean-pressure 2MPa h@.rcg
layer, along x|64 128|rc-solve --periodic=x --layer 3um,3GPa,0.3 $metal --mean-pressure 2MPa h@.rcg
tilt|64 256|rc-solve --estar 1GPa --mean-pressure 2MPa --tilt free h@.rcg
adhesion|64 128|rc-solve --periodic $sticky --mean-pressure 30kPa h@.rcg
adhesion, a soft law|64 128|rc-solve --estar 10MPa --adhesion 5mJ/m2,exponential,100nm --mean-pressure 5kPa,0 h@.rcg
pull-off of a ball|64 128|rc-solve --estar 1GPa --adhesion 50mJ/m2,exponential,20nm --load 1mN --pull-off s@.rcg
yield, auto|64 128|rc-solve --periodic $metal --mean-pressure 5MPa --yield 15MPa h@.rcg
yield, slabs|64 128|rc-solve --periodic $metal --mean-pressure 5MPa --yield 15MPa --slabs 5 --increments 8 h@.rcg
yield, free, loads|64 128|rc-solve $metal --mean-pressure 2MPa,0,2MPa --yield 20MPa --increments 8 h@.rcg
yield, none|64 256|rc-solve $metal --mean-pressure 2MPa --yield 1GPa h@.rcg
creep by load|64 128|rc-solve $rubber --load 1mN --time 1ms:1s:log:4 h@.rcg
creep by load, to 1e-4|64 128|rc-solve $rubber --load 1mN --time 1ms:1s:log:4 --tol 1e-4 h@.rcg
creep by approach|64 128|rc-solve $rubber --approach 0.3um --time 1ms:1s:log:4 h@.rcg
sliding on rubber|64 256|rc-solve --periodic $rubber --mean-pressure 20kPa --speed 10mm/s h@.rcg
sliding on rubber, free, speeds|64 128|rc-solve $rubber --mean-pressure 10kPa --speed 1mm/s,10mm/s h@.rcg
travel|64 256|rc-solve --radius 2mm --load 0.02N --estar 1GPa --travel=-20um:20um:21 h@.rcg
partial slip|64 256|rc-slip --mu 0.3 --tangential 2mN p@.rcg
partial slip, a path|64 128|rc-slip --mu 0.3 --path 5N,0,0;5N,1N,0;5N,-1N,0 b@.rcg
dissimilar slip|64 96|rc-slip --mu 0.3 --tangential 0.8N --increments 4 c@.rcg
dissimilar slip, Goodman|64 128|rc-slip --mu 0.3 --tangential 0.8N --coupling goodman c@.rcg
rolling, steady|64 256|rc-slip --mu 0.3 --creep 1e-3,0 --steady b@.rcg
rolling, steady, by force|64 128|rc-slip --mu 0.3 --creep-force 0.5N --steady b@.rcg
rolling, a path|64 96|rc-slip --mu 0.3 --creep 1e-3,0 t@.rcg
wear|64 128|rc-wear --coefficient 1e-6mm3/Nm --distance 1m:1km:log:4 p@.rcg
wear to 1e-2|64 128|rc-wear --coefficient 1e-6mm3/Nm --distance 10m --tol 0.01 p@.rcg
wear to 1e-3|64 128|rc-wear --coefficient 1e-6mm3/Nm --distance 10m --tol 0.001 p@.rcg
wear of a track|64 256|rc-wear --coefficient 0,1e-6mm3/Nm --motion track:5mm --distance 100m p@.rcg
wear by friction energy|64 256|rc-wear --energy 1e-6mm3/J --mu 0.3 --distance 10m q@.rcg
wear of cycles|64 128|rc-wear --coefficient 1e-6mm3/Nm --cycles 1e4 d@.rcg
wear of two rough bodies|64 96|rc-wear --coefficient 1e-6mm3/Nm --motion sliding --counter o@.rcg --distance 1m q@.rcg
heat, steady|64 256|rc-heat --mu 0.3 $warm --speed 1m/s p@.rcg
heat, --time|64 128|rc-heat --mu 0.3 $warm --speed 1m/s --time 1ms p@.rcg
heat, time steps|64 128|rc-heat --mu 0.3 $warm --speed 1m/s --time 1ms --time-steps 8 p@.rcg
heat of cycles|64 128|rc-heat --frequency 50Hz $warm d@.rcg
fatigue|64 128|rc-fatigue $limits --pass x --depths 1um:30um:log:6 p@.rcg
fatigue, Findley|64 128|rc-fatigue $limits --criteria findley --pass x --depths 1um:30um:log:3 p@.rcg
stresses|64 256|rc-stress --nu 0.3 --depths 0:40um:20 p@.rcg
stresses, a section|128 256|rc-stress --nu 0.3 --section y=0 --depths auto p@.rcg
leak|64 256|rc-leak q@.rcg
leak, its flux|64 256|rc-leak --output flux p@.rcg
ROWS
}

# forecast_run NODES COMMAND: writes plan.json, run.json and, with the processor seconds of one thread, time.txt.
forecast_run() {
    local words
    IFS=' ' read -ra words <<<"${2//@/$1}"
    "${words[@]}" --quiet --threads 1 --dry-run --report plan.json >plan.txt 2>why.txt || return 1
    TIMEFORMAT='%U %S'
    { time "${words[@]}" --quiet --threads 1 --report run.json -o out.rcg 2>why.txt; } 2>time.txt
}

# Prints the ratio of the expected to the counted convolutions, "none" if the command has none. The count of rc-wear
# goes on from row to row. An application of the volume operator is 3.3 convolutions a slab.
forecast_work() {
    awk '
        function number(key) { return match($0, "\"" key "\": [0-9.e+-]+") ? substr($0, RSTART + length(key) + 4) + 0 : -1 }
        FILENAME == "plan.json" { if ((x = number("expected_convolutions")) >= 0) plan += x; next }
        (x = number("convolutions")) >= 0 { run = /"wear_error_estimate"/ ? x : run + x }
        (x = number("applications")) > 0 { run += 3.3 * x * number("slabs") }
        END { print(plan > 0 && run > 0 ? plan / run : "none") }' plan.json run.json
}
