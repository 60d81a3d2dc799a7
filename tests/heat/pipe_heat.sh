# SPDX-License-Identifier: GPL-3.0-or-later
# rc-heat: shares and temperatures with known values, units, time, depths, frames, warnings, refusals.
. "$(dirname "$0")/../pipe.sh"

column() { # NAME FILE: a number of a table
    awk -F'\t' -v name="$1" 'NR == 1 { for (k = 1; k <= NF; k++) { sub("/.*", "", $k); if ($k == name) c = k } }
        NR == 2 { print $c }' "$2"
}
export RC_THREADS=1
steel="--conductivity 45W/mK,45W/mK --diffusivity 1.2e-5,1.2e-5"
rc-synth selfaffine --nx 256 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 64um --short-cut 8um --seed 3 |
    rc-solve --quiet --radius 5mm --load 5N --estar 114GPa --hardness 6GPa --output pressure -o rough.rcg
for pair in 0.1:20.2 1:176.7 10:1109; do
    rc-heat --quiet --mu 0.3 --speed "${pair%:*}" $steel --report t.tsv -o hot.rcg rough.rcg
    near "$(column max_temperature t.tsv)" "${pair#*:}" 1e-2 "rough steel at ${pair%:*} m/s"
    near "$(column heat_power t.tsv)" "$(awk "BEGIN { print 0.3 * 5 * ${pair%:*} }")" 1e-3 "  heat: mu P V"
done
rc-heat --verbose --mu 0.3 --speed 10 $steel --report t.json -o hot.rcg rough.rcg 2>told.txt
told=$(sed -n 's/.*: hottest \([0-9.e+]*\) K above the bulk of body 1, at x = \([-0-9.]*\) um, y = \([-0-9.]*\) um; body 1 takes \([0-9.]*\) % of the heat; converged to [0-9.e-]* in [0-9]* iterations, [0-9.e-]* s$/\1 \2e-6 \3e-6 \4e-2/p' told.txt)
read -r hottest at_x at_y share <<<"$told"
near "$hottest" "$(field max_temperature t.json)" 5e-3 "--verbose prints the largest temperature"
near "$at_x" "$(field max_x t.json)" 5e-3 "  and where it is"
near "$at_y" "$(field max_y t.json)" 5e-3 "  along both axes"
near "$share" "$(field share_1 t.json)" 5e-3 "  and the heat into body 1"
claim "frames" test "$(grep -a '^channel=' hot.rcg | tr '\n' ' ')" = \
    "channel=temperature-1 channel=temperature-2 channel=heat-1 channel=heat-2 channel=contact "

rc-synth sphere --nx 48 --dx 1um --radius 1mm | rc-solve --quiet --tol 1e-8 --output pressure --estar 114GPa --load 100mN --conductivity 45W/mK,16W/mK --report c.tsv -o ball.rcg
two="--conductivity 45W/mK,16W/mK --heat-capacity 3.7e6,4e6"
rc-heat --quiet --mu 0.3 --speed 1e-9 $two --report t.tsv -o slow.rcg ball.rcg
near "$(column share_1 t.tsv)" "$(awk 'BEGIN { print 45 / 61 }')" 1e-5 "share of body 1 at rest"
sed 's/^channel=pressure$/channel=heat/; s/^unit=Pa$/unit=W\/m2/' ball.rcg | reseal >given.rcg
rc-heat --quiet --speed 1e-9 $two --bulk 0,1e9 --tol 1e-9 --report t.tsv -o bulk.rcg given.rcg
rc-heat --quiet --speed 1e-9 $two --tol 1e-9 --report u.tsv -o bulk.rcg given.rcg
near "$(awk "BEGIN { printf \"%.9g\", ($(column heat_power_1 t.tsv) - $(column heat_power_1 u.tsv)) / 1e9 }")" \
    "$(column conductance c.tsv)" 1e-6 "bulk temperatures: the conductance of rc-solve"
rc-heat --quiet --mu 0.3 --speed 3 $steel --moving 1 --report t.tsv -o one.rcg ball.rcg
rc-heat --quiet --mu 0.3 --speed 3 $steel --moving 2 --report u.tsv -o two.rcg ball.rcg
near "$(column share_1 t.tsv)" "$(awk "BEGIN { printf \"%.9g\", 1 - $(column share_1 u.tsv) }")" 2e-3 "the other body moves"
rc-heat --quiet --mu 0.3 --speed 3 $steel --time 1s --report t.tsv -o late.rcg ball.rcg
near "$(column max_temperature t.tsv)" "$(column max_temperature u.tsv)" 2e-3 "late is steady"
rc-heat --quiet --mu 0.3 --speed 3 $steel --depths 0,2um --output temperature-2 ball.rcg >deep.rcg
claim "depths" test "$(grep -ac '^depth=' deep.rcg)" = 2

si="$(rc-heat --quiet --mu 0.3 --speed 2 --conductivity 45,45 --diffusivity 1.2e-5,1.2e-5 --report - ball.rcg | sed 's/"seconds.*//')"
unit="$(rc-heat --quiet --mu 0.3 --speed 7.2km/h --conductivity '45W/(m K),0.45W/cmK' --heat-capacity '3.75MJ/m3K,3.75J/(cm3 K)' --report - ball.rcg | sed 's/"seconds.*//')"
claim "units" test "$unit" = "$si"
gears="$(rc-heat --quiet --mu 0.3 --moving 0,2m/s $steel --report - ball.rcg | sed 's/"seconds.*//')"
claim "--moving 0,V is --speed V of body 2" test "$gears" = "$si"
rc-heat --quiet --mu 0.3 --moving -1,2 $steel --report t.tsv -o gears.rcg ball.rcg
near "$(column heat_power t.tsv)" 0.09 1e-6 "heat of two speeds: mu P (V2 - V1)"
rc-heat --quiet --mu 0.3 --speed 2 $steel --partition 0.3 --report t.tsv -o share.rcg ball.rcg
near "$(column share_1 t.tsv)" 0.3 1e-12 "--partition SHARE"
for n in 1 16; do
    rc-heat --quiet --mu 0.3 --speed 20 $steel --time 1us --time-steps $n --report "t$n.tsv" -o then.rcg ball.rcg
done
between 1.004 "$(awk "BEGIN { print $(column max_temperature t16.tsv) / $(column max_temperature t1.tsv) }")" 1.04 "--time-steps: the shares change in time"
claim "degrees Celsius" test "$(rc-heat --quiet --speed 1 $steel --bulk 20degC,25degC --report - given.rcg | sed 's/.*max_temp/max_temp/; s/"seconds.*//')" = \
    "$(rc-heat --quiet --speed 1 $steel --bulk 293.15,298.15 --report - given.rcg | sed 's/.*max_temp/max_temp/; s/"seconds.*//')"

# like bodies that move alike past the contact: by symmetry both surfaces are half-way between the bulks
for mu in 0.3 0; do
    rc-heat --quiet --mu $mu --moving 30m/s,30m/s --bulk 0,150 $steel --tol 1e-6 --report t.json -o rolling.rcg ball.rcg
    near "$(field max_temperature t.json)" 75 1e-6 "bodies of two bulk temperatures roll without sliding, mu $mu: the largest temperature"
    near "$(field mean_temperature t.json)" 75 1e-6 "  the mean"
    claim "  no heat, and no share of it" test "$(field heat_power t.json) $(field share_1 t.json)" = "0 null"
done
crossing=$(field heat_power_1 t.json)
rc-heat --quiet --mu 0.3 --moving 30m/s,30.0001m/s --bulk 0,150 $steel --tol 1e-6 --report t.json -o rolling.rcg ball.rcg
near "$(field heat_power_1 t.json)" "$crossing" 1e-4 "  at a small slip the same heat crosses"
claim "    and is no share of the heat of friction" test "$(field share_1 t.json)" = null
between 0 "$(rc-heat --quiet --mu 0.3 --moving 1m/s,40m/s --bulk 0,1 $steel --report - ball.rcg >t.json && field share_1 t.json)" 1 \
    "    at a large one it is"

rc-synth sphere --nx 32 --dx 10um --radius 7.5mm | rc-solve --quiet --load 50N --E1 210GPa --nu1 0.3 --E2 70GPa --nu2 0.3 -o pressed.rcg
rc-slip --quiet --mu 0.3 --coupling goodman --path '50N,0,0; 50N,8N,0; 50N,-8N,0; 50N,8N,0' --output pressure,dissipation --report loop.tsv -o loop.rcg pressed.rcg
claim "a loop that stops short of its accuracy ends with 3" test $? = 3
rc-pick --quiet --case 3,4 loop.rcg | rc-heat --quiet --frequency 50Hz $steel --report t.tsv -o fretting.rcg
claim "  and so do the tools that take it" test "${PIPESTATUS[*]}" = "3 3"
near "$(column heat_power t.tsv)" "$(awk -F'\t' 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == "dissipated_energy/J") c = k }
    NR > 3 { sum += $c } END { printf "%.12g", 50 * sum }' loop.tsv)" 1e-9 "fretting: frequency times the energy of a cycle"

# a roller: 1.11 mu P' (sqrt V1 - sqrt V2)/sqrt(k rho c)/sqrt(2 a) (Blok 1937), a^2 = 4 P' R/(pi E*)
rc-synth cylinder --radius 10mm --nx 256 --ny 8 --dx 2um --direction 90 -o roller.rcg
rc-solve --quiet --periodic=y --load 1e5N/m --estar 114GPa --output pressure -o line.rcg roller.rcg
moves="--mu 0.05 --moving 10m/s,9m/s --tol 1e-8 $steel"
rc-heat --quiet $moves --report roller.json -o roller-hot.rcg line.rcg
near "$(field max_temperature roller.json)" "$(awk 'BEGIN { a = sqrt(4 * 1e5 * 0.01 / (3.14159265 * 114e9))
    print 1.11 * 0.05 * 1e5 * (sqrt(10) - 3) / (45 / sqrt(1.2e-5)) / sqrt(2 * a) }')" "$coarse_grid" "a roller: Blok's flash temperature"
near "$(field heat_power_per_metre roller.json)" 5000 1e-9 "  its heat per length: mu P' V"
near "$(field peclet_1 roller.json)" "$(awk 'BEGIN { print 10 * sqrt(4e3 / (3.14159265 * 114e9)) / 2.4e-5 }')" "$coarse_grid" "  the Peclet number has half the width"
rc-synth cylinder --radius 10mm --nx 8 --ny 256 --dx 2um --direction 0 | rc-solve --quiet --periodic=x --load 1e5N/m --estar 114GPa --output pressure |
    rc-heat --quiet --mu 0.05 --moving 2 --speed 0,2m/s $steel --time 1ms --report turned.json -o turned.rcg
rc-heat --quiet --mu 0.05 --moving 2 --speed 2m/s $steel --time 1ms --report straight.json -o straight.rcg line.rcg
near "$(field max_temperature turned.json)" "$(field max_temperature straight.json)" 1e-6 "  turned, with a body at rest and a time"
rc-pick --quiet --crop 0,3,256,1 --set boundary=periodic-y line.rcg -o row.rcg
rc-heat --quiet $moves --report row.json -o row-hot.rcg row.rcg
for name in max_temperature share_1 peclet_2 steady_time heat_power_per_metre hot_nodes; do
    near "$(field $name row.json)" "$(field $name roller.json)" 1e-6 "  one row of it: $name"
done
rc-pick --quiet --set boundary=free row.rcg -o alone.rcg
claim "  on a free boundary a row is a strip" warns 'heated as a strip 2 um wide: .* rc-pick --set boundary=periodic-y' rc-heat $moves -o alone-hot.rcg alone.rcg
claim "    at rest too" rc-heat --quiet --mu 0.05 --speed 1m/s $steel -o alone-hot.rcg alone.rcg
refuses 1 "body 1 does not move along x, and the map repeats along y: it becomes warmer without end: give the time since heating began" "a roller on a body at rest" \
    "rc-heat --mu 0.05 --speed 1m/s $steel -o never.rcg line.rcg"
refuses 1 "body 1 does not move along x" "  both move along the roller" "rc-heat --mu 0.05 --speed 0,1m/s $steel -o never.rcg line.rcg"
claim "  the body that takes all heat moves" rc-heat --quiet --mu 0.05 --speed 1m/s --partition 0 $steel -o one.rcg line.rcg

heat="rc-heat --mu 0.3 --speed 1 $steel -o never.rcg"
refuses 2 "one of --diffusivity and --heat-capacity" "no diffusivity" "rc-heat --mu 0.3 --speed 1 --conductivity 45,45 ball.rcg"
refuses 2 "two numbers, for body 1 and body 2" "one diffusivity" "rc-heat --mu 0.3 --speed 1 --conductivity 45,45 --diffusivity 1e-5 ball.rcg"
refuses 2 "must be thermal" "electrical conductivity" "rc-heat --mu 0.3 --speed 1 --conductivity 58MS/m,7MS/m --diffusivity 1e-5,1e-5 ball.rcg"
refuses 2 "do not slide" "no speed" "rc-heat --mu 0.3 --speed 0 $steel ball.rcg"
refuses 1 "only bodies of one material: .*rc-pick --set layers=" "a body with layers" "rc-pick --set 'layers=1e-6,2e11,0.3;inf,7e10,0.3' ball.rcg | $heat"
refuses 1 "heat" "no frame heat" "rc-heat --speed 1 $steel rough.rcg"
refuses 1 'Peclet number of a cell is above' "a speed that is far too high" "rc-heat --mu 0.1 --speed 1e30 $steel ball.rcg"
rc-synth wave --nx 32 --dx 1um --amplitude 10nm --wavelength 32um | rc-solve --quiet --periodic --estar 114GPa --mean-pressure 100MPa -o wave.rcg
refuses 1 "no steady temperature: give the time since heating began" "periodic without a time" "$heat wave.rcg"
claim "periodic with a time" rc-heat --quiet --mu 0.3 --speed 1 $steel --time 1us -o wavy.rcg wave.rcg
rc-synth sphere --nx 16 --dx 20um --radius 1mm | rc-solve --quiet --estar 114GPa --load 10N -o coarse.rcg
refuses 2 "must be above 0" "negative conductivity" "rc-heat --mu 0.3 --speed 1 --conductivity -45,45 --diffusivity 1e-5,1e-5 ball.rcg"
refuses 2 "must be above 0" "no diffusivity" "rc-heat --mu 0.3 --speed 1 --conductivity 45,45 --diffusivity 0,1e-5 ball.rcg"
refuses 2 "do not slide" "equal speeds" "rc-heat --mu 0.3 --moving 2,2 $steel ball.rcg"
refuses 2 "mu is 0" "no friction" "rc-heat --mu 0 --moving 2,1 --bulk 7,7 $steel ball.rcg"
refuses 2 "there is none: leave it out" "a share of no heat" "rc-heat --mu 0 --moving 2,2 --bulk 7,8 --partition blok $steel ball.rcg"
refuses 2 '--mu does not work with --frequency' "friction and cycles" "rc-heat --mu 0.3 --speed 1 --frequency 5 $steel ball.rcg"
refuses 2 "from 0 to 1" "a share above 1" "$heat --partition 1.5 ball.rcg"
refuses 2 "needs --time" "time steps of a steady state" "$heat --time-steps 4 ball.rcg"
refuses 2 "with and without a unit" "0 that may be degrees" "$heat --bulk 20degC,0 ball.rcg"
refuses 1 "no frame with the channel dissipation" "no dissipation" "rc-heat --frequency 5 $steel ball.rcg"
refuses 1 "no frame with the channel heat, .*follows from the pressure and --mu, that of rolling from --rolling" "no heat of a contact" "rc-heat --speed 1m/s $steel ball.rcg"
rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-slope 0.1 --seed 1 -o a.rcg
rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-slope 0.1 --seed 2 | rc-add a.rcg - |
    rc-solve --quiet --estar 114GPa --load 100mN --output pressure -o both.rcg
claim "two rough bodies" warns "sum of two rough surfaces" rc-heat --mu 0.3 --speed 1 $steel -o passing.rcg both.rcg
claim "few nodes" warns "trailing edge is up to" rc-heat --mu 0.3 --speed 30 $steel -o few.rcg coarse.rcg
claim "hot" warns "K above the bulk of body 1" rc-heat --mu 0.3 --speed 1000 $steel -o hot.rcg rough.rcg
