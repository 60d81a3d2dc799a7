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
claim "frames" test "$(grep -a '^channel=' hot.rcg | tr '\n' ' ')" = \
    "channel=temperature-1 channel=temperature-2 channel=heat-1 channel=heat-2 "

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

heat="rc-heat --mu 0.3 --speed 1 $steel -o never.rcg"
refuses 2 "one of --diffusivity and --heat-capacity" "no diffusivity" "rc-heat --mu 0.3 --speed 1 --conductivity 45,45 ball.rcg"
refuses 2 "two numbers, for body 1 and body 2" "one diffusivity" "rc-heat --mu 0.3 --speed 1 --conductivity 45,45 --diffusivity 1e-5 ball.rcg"
refuses 2 "must be thermal" "electrical conductivity" "rc-heat --mu 0.3 --speed 1 --conductivity 58MS/m,7MS/m --diffusivity 1e-5,1e-5 ball.rcg"
refuses 2 "--speed is 0" "no speed" "rc-heat --mu 0.3 --speed 0 $steel ball.rcg"
refuses 1 "only bodies of one material: .*rc-pick --set layers=" "a body with layers" "rc-pick --set 'layers=1e-6,2e11,0.3;inf,7e10,0.3' ball.rcg | $heat"
refuses 1 "heat" "no frame heat" "rc-heat --speed 1 $steel rough.rcg"
rc-synth wave --nx 32 --dx 1um --amplitude 10nm --wavelength 32um | rc-solve --quiet --periodic --estar 114GPa --mean-pressure 100MPa -o wave.rcg
refuses 1 "no steady temperature: give a time" "periodic without a time" "$heat wave.rcg"
claim "periodic with a time" rc-heat --quiet --mu 0.3 --speed 1 $steel --time 1us -o wavy.rcg wave.rcg
rc-synth sphere --nx 16 --dx 20um --radius 1mm | rc-solve --quiet --estar 114GPa --load 10N -o coarse.rcg
claim "few nodes" warns "trailing edge is up to" rc-heat --mu 0.3 --speed 30 $steel -o few.rcg coarse.rcg
claim "hot" warns "K above the bulk of body 1" rc-heat --mu 0.3 --speed 1000 $steel -o hot.rcg rough.rcg

finish
