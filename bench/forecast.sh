#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The seconds that --dry-run tells, beside those of the run, on a machine that does nothing else.
#
#     bench/forecast.sh BUILD FOLDER [REGEX]      FOLDER keeps the maps (400 MB), REGEX selects rows
set -euo pipefail
[ $# -ge 2 ] || { sed -n '3,5s/^# \{0,1\}//p' "$0"; exit 2; }
PATH="$(cd "$1" && pwd)/tools:$PATH"
mkdir -p "$2"
cd "$2"

rough() { # NODES SEED: the map hNODES, and pNODES, bNODES, qNODES: it under a load, on a rigid body, periodic
    [ ! -s "q$1.rcg" ] || return 0
    rc-synth selfaffine --nx "$1" --dx 1um --hurst .8 --rms-slope .05 --rolloff 100um --short-cut 8um --seed "$2" -o "h$1.rcg"
    rc-solve --quiet --E1 2GPa --nu1 0.3 --E2 2GPa --nu2 0.3 --mean-pressure 2MPa "h$1.rcg" -o "p$1.rcg"
    rc-solve --quiet --E1 1GPa --nu1 0.3 --E2 rigid --mean-pressure 2MPa "h$1.rcg" -o "b$1.rcg"
    rc-solve --quiet --periodic --E1 1GPa --nu1 0.3 --E2 rigid --mean-pressure 2MPa "h$1.rcg" -o "q$1.rcg"
}
for n in 128 256 512 1024 2048; do rough $n 3; done
[ -s profile.rcg ] || rc-synth selfaffine --nx 65536 --ny 1 --dx 1um --hurst .8 --rms-slope .05 --rolloff 100um --short-cut 8um --seed 3 -o profile.rcg
[ -s ball.rcg ] || rc-synth sphere --nx 512 --dx 1um --radius 20mm | rc-solve --quiet --load 2N --E1 150GPa --nu1 0.2 --E2 rigid -o ball.rcg
[ -s other.rcg ] || rc-synth selfaffine --nx 128 --dx 1um --hurst .8 --rms-slope .05 --rolloff 100um --short-cut 8um --seed 4 -o other.rcg

metal="--E1 1GPa --nu1 0.3 --E2 rigid"
rubber="--relaxation 2MPa,4MPa:10ms,8MPa:1ms,16MPa:0.1ms,32MPa:10us --nu1 0.49 --E2 rigid"
sticky="--estar 10MPa --adhesion 50mJ/m2,exponential,50nm"
steels="--mu 0.3 --conductivity 45W/mK,16W/mK --diffusivity 12mm2/s,4mm2/s"
limits="--nu 0.3 --bending-limit 60MPa --torsion-limit 37MPa"
rows="free|rc-solve --estar 1GPa --mean-pressure 2MPa h2048.rcg
periodic, 1e-8|rc-solve --periodic --estar 1GPa --mean-pressure 5MPa --tol 1e-8 h2048.rcg
along y|rc-solve --periodic=y --estar 1GPa --mean-pressure 2MPa h2048.rcg
along x|rc-solve --periodic=x --estar 1GPa --mean-pressure 2MPa h1024.rcg
approach|rc-solve --estar 1GPa --approach 1um h1024.rcg
loads|rc-solve --periodic --estar 1GPa --mean-pressure 1MPa:9MPa:5 h1024.rcg
tilt|rc-solve --estar 1GPa --mean-pressure 2MPa --tilt free h1024.rcg
direct|rc-solve --kernel direct --estar 1GPa --mean-pressure 2MPa h512.rcg
mlms|rc-solve --kernel mlms --estar 1GPa --mean-pressure 2MPa h1024.rcg
layer|rc-solve --layer 3um,3GPa,0.3 $metal --mean-pressure 2MPa h1024.rcg
layer, along y|rc-solve --periodic=y --layer 3um,3GPa,0.3 $metal --mean-pressure 2MPa h1024.rcg
hardness, history|rc-solve --periodic --estar 1GPa --mean-pressure 2MPa,5MPa,1MPa,0 --hardness 40MPa --history h1024.rcg
conductance|rc-solve --periodic --estar 1GPa --mean-pressure 5MPa --conductivity 45W/mK,16W/mK h1024.rcg
profile|rc-solve --periodic --estar 1GPa --mean-pressure 2MPa --tol 1e-8 profile.rcg
adhesion|rc-solve --periodic $sticky --mean-pressure 30kPa h512.rcg
adhesion, free|rc-solve $sticky --mean-pressure 30kPa,60kPa,30kPa h256.rcg
pull-off|rc-solve --periodic $sticky --mean-pressure 30kPa --pull-off h128.rcg
yield|rc-solve --periodic $metal --mean-pressure 5MPa --yield 15MPa h256.rcg
yield, loads|rc-solve $metal --mean-pressure 2MPa,0,2MPa --yield 20MPa --increments 8 h256.rcg
creep|rc-solve $rubber --load 1mN --time 1ms:1s:log:4 h256.rcg
sliding|rc-solve --periodic $rubber --mean-pressure 20kPa --speed 1mm/s,10mm/s,0.1m/s h512.rcg
sliding, free|rc-solve $rubber --mean-pressure 5kPa --track fresh --speed 10mm/s h256.rcg
travel|rc-solve --radius 2mm --load 0.2N --estar 114GPa --travel=-60um:60um:61 --window 256x256 h512.rcg
slip|rc-slip --mu 0.3 --path 200mN,0,0;200mN,40mN,0;200mN,-40mN,0 p512.rcg
slip, dissimilar|rc-slip --mu 0.3 --tangential 20mN b256.rcg
rolling|rc-slip --mu 0.3 --coupling goodman --creep 1e-3,0 --steady ball.rcg
rolling, force|rc-slip --mu 0.3 --coupling none --creep-force 60mN --steady ball.rcg
stress|rc-stress --nu 0.3 --depths 0:40um:20 p1024.rcg
stress, friction|rc-stress --nu 0.3 --mu 0.3 --depths 0:40um:20 p1024.rcg
fatigue|rc-fatigue $limits --criteria crossland,dangvan,papadopoulos,findley,amplitude --pass x --depths 1um:30um:log:6 p512.rcg
wear|rc-wear --coefficient 1e-6mm3/Nm --distance 1m:1km:log:4 p256.rcg
wear of a track|rc-wear --coefficient 0,1e-6mm3/Nm --motion track:5mm --distance 100m p256.rcg
wear of two|rc-wear --coefficient 1e-6mm3/Nm --motion sliding --counter other.rcg --distance 10m q128.rcg
leak|rc-leak --output flux q1024.rcg
leak, 2048|rc-leak q2048.rcg
heat|rc-heat $steels --speed 1m/s p1024.rcg
heat, steps|rc-heat $steels --speed 1m/s --time 1ms --time-steps 8 p512.rcg"

printf '%-18s %8s %8s %6s\n' command told/s run/s ratio
grep -E "^(${3:-.*})\|" <<<"$rows" | while IFS='|' read -r name command; do
    IFS=' ' read -ra words <<<"$command"
    told=$("${words[@]}" --quiet --dry-run --report - 2>/dev/null | sed -n "s/.*\"expected_seconds\": \([0-9.e+-]*\).*/\1/p" | tail -n 1)
    start=${EPOCHREALTIME/./}
    "${words[@]}" --quiet -o /dev/null || echo "exit $?: $command"
    awk -v n="$name" -v t="${told:-nan}" -v us=$((${EPOCHREALTIME/./} - start)) 'BEGIN {
        printf "%-18s %8.3g %8.3g %6.2f\n", n, t, us / 1e6, t / (us / 1e6) }'
done
