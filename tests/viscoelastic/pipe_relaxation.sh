# SPDX-License-Identifier: GPL-3.0-or-later
# rc-solve --relaxation: creep of a ball follows Hertz with J(t), materials from files, checkpoints, the cost
# before the run, and refusals.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 48 --dx 1um --radius 100um -o ball.rcg
solve="rc-solve --quiet --threads 1 --nu1 0.5 --E2 rigid --tol 1e-3 --output pressure,gap"
solid="--relaxation 1MPa,9MPa:1ms"
# ball TIME: the approach of the ball; J = (1 - (1 - E/Einf) exp(-t/th))/Einf, th = tau E(0)/Einf
ball() {
    awk -v t="$1" 'BEGIN { j = 0.75e-6 * (1 - 0.9 * exp(-t / 1e-2)); a = (0.75 * 2e-4 * 1e-4 * j) ^ (1 / 3); print a * a / 1e-4 }'
}

# ---- creep ----

$solve $solid --load 0.2mN --time 0,3ms,50ms --report creep.json -o creep.rcg ball.rcg
for case in 1:0 2:3e-3 3:5e-2; do
    sed -n "${case%:*}p" creep.json >case.json
    near "$(field time case.json)" "${case#*:}" "$rounding" "case ${case%:*} has its time"
    near "$(field approach case.json)" "$(ball "${case#*:}")" "$coarse_grid" "  and Hertz's approach at E(t)"
done
claim "the cases have the asked frames" test "$(channels creep.rcg)" = "pressure gap pressure gap pressure gap"
for case in 1 2 3; do near "$(total pressure creep.rcg $case)" 2e-4 "$summed" "  which carry the load"; done
claim "frames have the key time" bash -c "[ \$(rc-info --json creep.rcg | grep -c '\"time\": *\"\?0.05') -ge 1 ]"
near "$(field equivalent_load case.json)" "$(awk 'BEGIN { print 2e-4 * (10 - 9 * exp(-5)) }')" 1e-6 "the equivalent load is P J(t)/J(0)"
$solve $solid --load 0.2mN --time 3ms,50ms --report later.json -o later.rcg ball.rcg
near "$(sed -n 2p later.json >l.json && field approach l.json)" "$(field approach case.json)" "$coarse_grid" \
    "a load acts from 0 on, also if the first time is later"
claim "  and the cases count from 1" bash -c '[ $(wc -l <later.json) = 2 ] && grep -q "\"case\": 1" later.json'

# Hertz: the largest pressure is 2 a/(pi R) of E*, 0.066 at once and 0.142 at 50 ms
claim "a pressure that is high for the modulus of its time has a warning" warns 'case 2, load 200 uN, time 0.05 s: the largest pressure, .*, is 0.14 of E. at this time: beyond 0.1' \
    ${solve/--quiet/} $solid --load 0.2mN --time 0,50ms -o t.rcg ball.rcg
claim "  at once none" bash -c "${solve/--quiet/} $solid --load 0.2mN --time 0 -o t.rcg ball.rcg 2>&1 | tee said >/dev/null; ! grep -q 'not linear' said"
claim "  and a load that has fallen has none" bash -c "${solve/--quiet/} $solid --load 0.2mN,1nN --time 0,50ms -o t.rcg ball.rcg 2>&1 | tee said >/dev/null; ! grep -q 'not linear' said"

soon="rc-solve --threads 1 --nu1 0.5 --E2 rigid --output pressure $solid -o soon.rcg ball.rcg --load"
claim "a result before the shortest relaxation time has passed causes a warning" warns 'time: 0.0005 s passes before the first result, and the shortest relaxation time is 0.001 s' $soon 0.2mN --time 0,0.5ms,50ms
claim "  later results may be closer together under one load" bash -c "$soon 0.2mN --time 0,1ms,1.5ms 2>said && ! grep -q 'shortest relaxation' said"
claim "  but not where the load changes" warns 'time: 0.0005 s passes between two times, and the shortest' $soon 0.2mN,0.3mN,0.2mN --time 0,1ms,1.5ms

# ---- materials ----

printf 'tau E\ninf 1MPa\n1ms 9MPa\n' >terms.txt
$solve --relaxation terms.txt --load 0.2mN --time 50ms --report terms.json -o t.rcg ball.rcg
$solve $solid --load 0.2mN --time 50ms --report typed.json -o t.rcg ball.rcg
near "$(field approach terms.json)" "$(field approach typed.json)" "$same" "a file of terms is the same material"
$solve --relaxation 1MPa,9MPa:1s --shift 1e-3 --load 0.2mN --time 50ms --report moved.json -o t.rcg ball.rcg
near "$(field approach moved.json)" "$(field approach typed.json)" 1e-9 "--shift multiplies the times"
awk 'BEGIN { print "Frequency,Storage,Loss"; print "Hz,MPa,MPa"
    for (i = -16; i <= 16; i++) { w = 1e3 * 10 ^ (i / 8); print w / 6.283185307 "," 1 + 9 * w * w / (1e6 + w * w) "," 9e3 * w / (1e6 + w * w) } }' >curve.csv
$solve --relaxation curve.csv --load 0.2mN --time 50ms --report curve.json -o t.rcg ball.rcg
near "$(field approach curve.json)" "$(field approach typed.json)" 5e-3 "a master curve of this material is fitted"
between 0 "$(field relaxation_misfit curve.json)" 0.05 "  with a small misfit"

# the same curve as instruments and programs write it: other names, units in brackets, decimal commas, tan delta
awk -F, 'NR > 2 { print $1 "\t" $2 "\t" $3 "\t" $3 / $2 }' curve.csv >body.tsv
{ printf 'Frequency (Hz)\tStorage modulus (MPa)\tLoss modulus (MPa)\ttan delta\n'; cat body.tsv; } >dma.tsv
{ echo 'Frequency (Hz);Storage modulus (MPa);Loss modulus (MPa)'; cut -f 1-3 body.tsv | tr '\t.' ';,'; } >comma.csv
{ printf 'f, E_stor, E_loss\nHz, MPa, MPa\n'; cut -f 1-3 body.tsv | tr '\t' ','; } >names.csv
{ echo '# omega/(rad/s) storage/kPa loss/kPa'; awk '{ print $1 * 6.283185307, 1e3 * $2, 1e3 * $3 }' body.tsv; } >omega.txt
for file in dma.tsv comma.csv names.csv omega.txt; do
    $solve --relaxation $file --load 0.2mN --time 50ms --report same.json -o t.rcg ball.rcg
    near "$(field approach same.json)" "$(field approach curve.json)" 1e-7 "  as $(head -n 1 $file | tr '\t' ' ')"
done
# storage, loss, tan delta, |E*| and the phase angle: any two that suffice give the same material
awk -F, -v OFS=';' 'NR > 2 { e = sqrt($2 * $2 + $3 * $3); t = $3 / $2; d = atan2($3, $2)
    printf "%.9g;%.9g;%.9g;%.9g;%.9g;%.9g\n", $1, $2, $3, t, e, d * 57.29577951308232 }' curve.csv >all.txt
cut_of() { { echo "$2"; cut -d';' -f "$3" all.txt; } >"$1"; } # cut_of FILE HEADING COLUMNS: of f E' E'' tan |E*| phase
cut_of tan.csv "Frequency (Hz);E' (N/mm2);tan delta" 1,2,4
cut_of damping.csv "Frequency (Hz);Storage Modulus E' (N/mm²);Damping (-)" 1,2,4
cut_of german.csv 'Frequenz (Hz);Speichermodul (MPa);Verlustfaktor' 1,2,4
cut_of star.csv 'frequency (Hz);tan delta;|E*| (N/mm2)' 1,4,5
cut_of phase.csv 'frequency (Hz);complex modulus (N/mm2);phase (deg)' 1,5,6
cut_of angle.csv "f/Hz;E'/MPa;δ (°)" 1,2,6
cut_of every.csv "f/Hz;E'/MPa;E''/MPa;tan δ;|E*|/MPa;phase/deg" 1-6
{ printf 'f/Hz;E_stor/MPa;phase (\260)\n'; tail -n +2 angle.csv; } >latin.csv # Latin-1
sed '1b; s/^\([^;]*;[^;]*;[^;]*\);.*/\1;undefined;-;-/' every.csv >spare.csv
for file in tan damping german star phase angle every latin spare; do
    $solve --relaxation $file.csv --load 0.2mN --time 50ms --report same.json -o t.rcg ball.rcg
    near "$(field approach same.json)" "$(field approach curve.json)" 1e-6 "  as $file.csv"
    near "$(field modulus_instant same.json)" "$(field modulus_instant curve.json)" 1e-5 "    with its instantaneous modulus"
done
# a measured relaxation of the same material, in three forms of its heading
awk 'BEGIN { for (i = -32; i <= 16; i++) { t = 1e-3 * 10 ^ (i / 8); print t "\t" 1 + 9 * exp(-t / 1e-3) } }' >body.tsv
{ printf 'time/s\tE/MPa\n'; cat body.tsv; } >relax.tsv
{ echo 'Time (s);E(t) (MPa)'; tr '\t.' ';,' <body.tsv; } >relax.csv
{ printf 't, E_relax\ns, MPa\n'; tr '\t' ',' <body.tsv; echo inf,1; } >relax-inf.csv
for file in relax.tsv relax.csv relax-inf.csv; do
    $solve --relaxation $file --load 0.2mN --time 50ms --report measured.json -o t.rcg ball.rcg
    near "$(field approach measured.json)" "$(field approach typed.json)" 5e-3 "a measured E(t) is fitted: $(head -n 1 $file | tr '\t' ' ')"
    between 0 "$(field relaxation_misfit measured.json)" 0.02 "  with a small misfit"
done
near "$(field modulus_relaxed measured.json)" 1e6 "$same" "the line inf has the relaxed modulus"
sed 's/inf,1/inf,0/' relax-inf.csv >fluid.csv
claim "  0 there has a warning" warns 'relaxed modulus is 0, so that body 1 flows' \
    ${solve/--quiet/} --relaxation fluid.csv --load 0.2mN --time 1ms -o t.rcg ball.rcg
# WLF with the universal constants 10 K above T0: log10 aT = -174.4/61.6; Arrhenius with 50 kJ/mol
$solve $solid --shift "$(awk 'BEGIN { printf "%.12g", 10 ^ (-174.4 / 61.6) }')" --load 0.2mN --time 1us --report factor.json -o t.rcg ball.rcg
$solve $solid --shift wlf,17.44,51.6,20degC --temperature 303.15K --load 0.2mN --time 1us --report wlf.json -o t.rcg ball.rcg
near "$(field approach wlf.json)" "$(field approach factor.json)" 1e-7 "--shift wlf shifts the times to --temperature"
$solve $solid --shift "$(awk 'BEGIN { printf "%.12g", exp(50e3 / 8.314462618 * (1 / 353.15 - 1 / 293.15)) }')" --load 0.2mN --time 1ms --report factor.json -o t.rcg ball.rcg
$solve $solid --shift arrhenius,50e3,293.15K --temperature 80degC --load 0.2mN --time 1ms --report arrhenius.json -o t.rcg ball.rcg
near "$(field approach arrhenius.json)" "$(field approach factor.json)" 1e-7 "  and --shift arrhenius"
claim "    with kJ/mol too" bash -c "$solve $solid --shift arrhenius,50kJ/mol,293.15K --temperature 80degC --load 0.2mN --time 1ms --report molar.json -o t.rcg ball.rcg"
near "$(field approach molar.json)" "$(field approach arrhenius.json)" 1e-12 "    which is the same"
# a case for each factor or temperature: body 1 is where it would be at the time t/a
$solve $solid --shift 10,1,0.1 --load 0.2mN --time 5ms --report list.json -o list.rcg ball.rcg
for case in 1:5e-4 2:5e-3 3:5e-2; do
    sed -n "${case%:*}p" list.json >case.json
    near "$(field approach case.json)" "$(ball "${case#*:}")" "$coarse_grid" "--shift 10,1,0.1: case ${case%:*} has Hertz's approach at t/a"
    near "$(field time case.json)" 5e-3 "$rounding" "  and its own time"
done
claim "  frames have this time" bash -c "[ \$(rc-info --json list.rcg | grep -c '\"time\": *\"0.005\"') = 6 ]"
$solve $solid --shift wlf,17.44,51.6,20degC --temperature 10degC:30degC:3 --load 0.2mN --time 2ms,3ms,20us --report list.json -o t.rcg ball.rcg
for case in 1:10:2e-3 2:20:3e-3 3:30:2e-5; do
    IFS=: read -r k degrees time <<<"$case"
    sed -n "${k}p" list.json >case.json
    a=$(awk -v d="$degrees" 'BEGIN { printf "%.12g", 10 ^ (-17.44 * (d - 20) / (51.6 + d - 20)) }')
    near "$(field shift case.json)" "$a" 1e-9 "--temperature, a list: the factor at $degrees degC"
    near "$(field temperature case.json)" "$(awk "BEGIN { print $degrees + 273.15 }")" 1e-9 "  its temperature"
    near "$(field time case.json)" "$time" "$rounding" "  its time"
    near "$(field approach case.json)" "$(ball "$(awk "BEGIN { print $time / $a }")")" "$coarse_grid" "  and Hertz's approach"
done
rc-synth wave --nx 32 --dx 1um --amplitude 0.1um --wavelength 32um -o wave.rcg
slide="rc-solve --quiet --threads 1 --nu1 0.5 --E2 rigid --periodic --mean-pressure 0.1MPa"
$slide $solid --shift 0.1,1,10 --speed 1mm/s,2mm/s,3mm/s --report slide.json -o slide.rcg wave.rcg
k=0
for case in 0.1:1e-3 1:2e-3 10:3e-3; do
    k=$((k + 1))
    sed -n "${k}p" slide.json >case.json
    $slide $solid --shift "${case%:*}" --speed "${case#*:}" --report alone.json -o t.rcg wave.rcg
    near "$(field friction case.json)" "$(field friction alone.json)" 1e-3 "--speed and --shift ${case%:*}: the friction of a run of its own"
    near "$(field speed case.json)" "${case#*:}" "$rounding" "  its speed"
    near "$(field dissipated_power case.json)" "$(awk "BEGIN { print $(field friction_force case.json) * ${case#*:} }")" 1e-5 "  power is force times speed"
done
# raw data of two decades at each of three temperatures make the master curve above
awk 'BEGIN { print "T/degC,frequency/Hz,storage/MPa,loss/MPa"; split("10 20 35", T, " ")
    for (k = 1; k <= 3; k++) for (i = 0; i <= 16; i++) { f = 10 * 10 ^ (i / 8); if (k == 1) f /= 10
        w = 6.283185307 * f * 10 ^ (-17.44 * (T[k] - 20) / (51.6 + T[k] - 20)); print T[k] "," f "," 1 + 9 * w * w / (1e6 + w * w) "," 9e3 * w / (1e6 + w * w) } }' |
    sed '1s/^T/temperature/' >raw.csv
$solve --relaxation raw.csv --shift wlf,17.44,51.6,20degC --temperature 20degC --load 0.2mN --time 50ms --report raw.json -o t.rcg ball.rcg
near "$(field approach raw.json)" "$(field approach typed.json)" 5e-3 "raw moduli at three temperatures make a master curve"
awk -F, 'NR == 1 { print "omega/(rad/s),storage/MPa,loss/MPa" } NR > 1 {
    printf "%.12g,%s,%s\n", 6.283185307179586 * $2 * 10 ^ (-17.44 * ($1 - 20) / (51.6 + $1 - 20)), $3, $4 }' raw.csv >reduced.csv
$solve --relaxation reduced.csv --load 0.2mN --time 50ms --report reduced.json -o t.rcg ball.rcg
near "$(field approach raw.json)" "$(field approach reduced.json)" 1e-6 "  that of reduced frequencies"
near "$(field relaxation_misfit raw.json)" "$(field relaxation_misfit reduced.json)" 1e-3 "  with its misfit"
$solve --relaxation raw.csv --shift wlf,17.44,51.6,20degC --temperature 26degC --load 0.2mN --time 1us --report warm.json -o t.rcg ball.rcg
$solve --relaxation reduced.csv --shift "$(awk 'BEGIN { printf "%.12g", 10 ^ (-17.44 * 6 / 57.6) }')" --load 0.2mN --time 1us --report reduced.json -o t.rcg ball.rcg
near "$(field approach warm.json)" "$(field approach reduced.json)" 1e-6 "  also for another temperature"
printf 'E;tau\nMPa;ms\n1;inf\n9;1,0\n' >terms.csv
$solve --relaxation terms.csv --load 0.2mN --time 50ms --report same.json -o t.rcg ball.rcg
near "$(field approach same.json)" "$(field approach typed.json)" "$same" "a table of terms in other units"
claim "a relaxed modulus of 0 has a warning" warns 'relaxed modulus is 0, so that body 1 flows' \
    ${solve/--quiet/} --relaxation 0,9MPa:1ms --load 0.2mN --time 1ms -o t.rcg ball.rcg
claim "  and one above 0 has none" bash -c "${solve/--quiet/} $solid --load 0.2mN --time 1ms -o t.rcg ball.rcg 2>none.err; ! grep flows none.err"

# ---- the range of a table ----

# curve.csv has 10 to 1e5 rad/s, and relax.tsv 0.1 us to 0.1 s
range="rc-solve --threads 1 --nu1 0.5 --E2 rigid --load 0.2mN --output pressure -o ranged.rcg ball.rcg"
inside() {
    claim "  no warning of $*" bash -c '"$@" 2>ranged.err && ! grep -E "excites" ranged.err' - $range "$@"
}
claim "a time longer than a table has a warning" warns \
    'time: 0.2 s excites the material at 1/.2 pi t., 0.795775 Hz, below the first frequency of the table, 1.59155 Hz' \
    $range --relaxation curve.csv --time 1ms,0.2s
claim "  and a shorter one" warns 'time: 5e-06 s .*31831 Hz, above the last frequency of the table, 15915.5 Hz' \
    $range --relaxation curve.csv --time 0,5us,90ms
claim "  with the table after its shift" warns 'time: 0.09 s .*, below the first frequency of the table, 3.1831 Hz' \
    $range --relaxation curve.csv --shift 0.5 --time 1ms,90ms
claim "  of a list, with the time of the case" warns 'time: 0.09 s .*, below the first frequency of the table, 3.1831 Hz' \
    $range --relaxation curve.csv --shift 1,0.5 --time 90ms
claim "  of times" warns 'time: 0.2 s .*, below 1.59155 Hz, 1/.2 pi t. of the last time of the table, 0.1 s' \
    $range --relaxation relax.tsv --time 1ms,0.2s
# the table ends at 1 + 9e2/(1e6 + 1e2) MPa; the fitted relaxed modulus is that of the report
$range --quiet --relaxation curve.csv --time 1ms,0.2s,1h,1d --report ranged.json
relaxed=$(sed -n 1p ranged.json | field modulus_relaxed /dev/stdin | awk '{ printf "%.6g", $1 / 1e6 }')
claim "  which has both moduli, and the number of other cases" warns \
    "time: 0.2 s .*, 1.59155 Hz: its relaxed modulus, ${relaxed//./\\.}[0-9]* MPa, is an extrapolation; the lowest modulus of the table is 1.0009 MPa at 1.59155 Hz; so it is in 2 later cases" \
    $range --relaxation curve.csv --time 1ms,0.2s,1h,1d
claim "  the rows of these cases are extrapolated" test "$(for k in 1 2 3 4; do sed -n ${k}p ranged.json | field extrapolated /dev/stdin; done | tr '\n' ' ')" = "false true true true "
near "$(sed -n 4p ranged.json | field time /dev/stdin)" 86400 "$same" "  a day has 86400 s"
$range --quiet --relaxation curve.csv --time 0,90ms --report ranged.json
claim "  so is the load at 0 s, whose frequency no table has" test "$(for k in 1 2; do sed -n ${k}p ranged.json | field extrapolated /dev/stdin; done | tr '\n' ' ')" = "true false "
$range --quiet --relaxation 1MPa,9MPa:1ms --time 1h --report ranged.json
claim "  given terms have no table" test "$(field extrapolated ranged.json)" = null
$range --quiet --relaxation curve.csv --shift wlf,17.44,51.6,20degC --temperature 20degC,60degC --time 90ms --report ranged.json
claim "  a higher temperature moves the table past its end" test "$(for k in 1 2; do sed -n ${k}p ranged.json | field extrapolated /dev/stdin; done | tr '\n' ' ')" = "false true "
claim "    and its warning has the frequency at this temperature" warns "the lowest modulus of the table is 1.0009 MPa at $(awk 'BEGIN { printf "%.6g", 10 / (2 * atan2(0, -1)) * 10 ^ (17.44 * 40 / 91.6) }' | sed 's/[+]/[+]/') Hz\$" \
    $range --relaxation curve.csv --shift wlf,17.44,51.6,20degC --temperature 20degC,60degC --time 90ms
claim "  a measured E(t) has a time" warns "below 1.59155 Hz.*: its relaxed modulus, .*; the lowest modulus of the table is $(awk 'NR > 1 && (low == "" || $2 < low) { low = $2 } END { printf "%.6g", low }' relax.tsv) MPa at 0.1 s\$" \
    $range --relaxation relax.tsv --time 1ms,0.2s
claim "  too short times have the instantaneous modulus" warns 'time: 5e-06 s .*: its instantaneous modulus, .*; the highest modulus of the table is 9.9[0-9]* MPa at 15915.5 Hz' \
    $range --relaxation curve.csv --time 0,5us,90ms
inside --relaxation curve.csv --time 0,20us,99ms
inside --relaxation relax-inf.csv --time 0,20us,0.2s
inside --relaxation 1MPa,9MPa:1ms --time 0,20us,0.2s

# ---- a layer on a rigid base ----

layer="rc-solve --quiet --threads 1 --E1 rigid --E2 rigid --tol 1e-3"
# a paraboloid on a layer of a tenth of the radius of contact, by a dense solution of the axisymmetric problem;
# the infinitely thin layer has P = pi M a^4/4Rt and an approach of a^2/2R; E = 1/J(50 ms)
thin=$(awk 'BEGIN { m = 0.7 / 1.3 / 0.4 / 1e-6 / (1 - 0.9 * exp(-5))
    printf "%.12g", 1.050126 * 3.14159265 * m * 1e-20 / (4 * 1e-4 * 1e-6) }')
$layer $solid --layer 1um,relaxation,0.3 --load $thin --time 0,50ms --report thin.json -o thin.rcg ball.rcg
sed -n 2p thin.json >case.json
near "$(field approach case.json)" "$(awk 'BEGIN { print 1.025873 * 1e-10 / 2e-4 }')" "$coarse_grid" \
    "a thin layer of rubber has the approach of theory"
soft=$(awk 'BEGIN { printf "%.12g", 1e6 / (1 - 0.9 * exp(-5)) }')
$layer --layer 1um,$soft,0.3 --load $thin --report soft.json -o soft.rcg ball.rcg
near "$(field approach case.json)" "$(field approach soft.json)" 1e-3 "  and that of an elastic one with the modulus 1/J"
$layer $solid --layer 1um,relaxation,0.3 --approach 0.5um --time 0,1ms --report held.json -o held.rcg ball.rcg
for case in 1 2; do sed -n ${case}p held.json >held$case.json; done
near "$(field load held2.json)" "$(awk -v p="$(field load held1.json)" 'BEGIN { print p * (1 + 9 * exp(-1)) / 10 }')" \
    2e-3 "the load of a held layer falls as E(t)"
claim "  and the history has its words" says 'layer 1e-06,relaxation,0.3' rc-info held.rcg

# ---- nothing asked, nothing paid ----

$solve --E1 10MPa --load 0.2mN --tol 1e-4 --report plain.json -o plain.rcg ball.rcg
claim "a plain run has no figures of relaxation" bash -c "grep -q '\"relaxation\": \"left out' plain.json &&
    ! grep -qE 'relaxation_|modulus_|equivalent_load|\"time\"' plain.json"
claim "  and no key time" bash -c "rc-info --json plain.rcg >info.json && ! grep -q '\"time\"' info.json"
$solve --relaxation 10MPa,0MPa:1ms --load 0.2mN --time 0 --report still.json -o still.rcg ball.rcg
near "$(field convolutions still.json)" "$(field convolutions plain.json)" 0 \
    "a body whose term is 0 takes the convolutions of an elastic one"
for run in plain still; do rc-export --quiet --channel pressure -o $run.npy $run.rcg; done
claim "  and has its pressures, to the byte" cmp plain.npy still.npy

# ---- checkpoint, cost ----

$solve $solid --load 0.2mN --time 3ms,50ms --checkpoint k.rcg -o once.rcg ball.rcg
$solve $solid --load 0.2mN --time 3ms,50ms --checkpoint k.rcg --resume -o again.rcg ball.rcg
claim "a resumed run has the same frames" cmp once.rcg again.rcg
claim "panels have their times, and not the load that they share" bash -c "
    rc-render --channel pressure -o times.svg once.rcg && says 'time 3 ms' cat times.svg &&
    ! grep -q ') load' times.svg"
refuses 1 'another problem: shortest time was 0.003, is 0.004$' "other times" \
    "$solve $solid --load 0.2mN --time 4ms,50ms --checkpoint k.rcg --resume -o x.rcg ball.rcg"
refuses 1 'another problem: last time was 0.05, is 0.06$' "a longer list, whose last time plans the steps" \
    "$solve $solid --load 0.2mN --time 3ms,50ms,60ms --checkpoint k.rcg --resume -o x.rcg ball.rcg"
refuses 1 'another problem: --tol was 0.001, is 1e-06$' "a smaller tolerance than that of earlier steps" \
    "$solve $solid --load 0.2mN --time 3ms,50ms --tol 1e-6 --checkpoint k.rcg --resume -o x.rcg ball.rcg"
claim "a larger one is accepted" bash -c "
    $solve $solid --load 0.2mN --time 3ms,50ms --tol 1e-2 --checkpoint k.rcg --resume -o larger.rcg ball.rcg"
claim "--dry-run tells the times and the work" bash -c "
    $solve $solid --load 0.2mN --time 3ms,50ms --dry-run ball.rcg >plan.txt && says 'relaxation +on: 1 terms' cat plan.txt &&
    says '2 times' cat plan.txt && says 'about [0-9]+ convolutions' cat plan.txt"
refuses 1 '--memory allows' "too little memory, before the first frame" \
    "$solve $solid --load 0.2mN --time 0,1 --memory 1M -o few.rcg ball.rcg"

# ---- refusals ----

more="--load 0.2mN -o x.rcg ball.rcg"
refuses 2 'modulus 1: give its unit, as in 1MPa' "a modulus without a unit" "$solve --relaxation 1,9MPa:1ms --time 0 $more"
refuses 2 'modulus 2e6: give its unit, as in 2e6Pa' "  one of millions" "$solve --relaxation 2e6,9MPa:1ms --time 0 $more"
refuses 2 'a term must be' "a term without a time" "$solve --relaxation 1MPa,9MPa --time 0 $more"
refuses 2 'only once' "two equal times" "$solve --relaxation 1MPa,9MPa:1s,2MPa:1s --time 0 $more"
refuses 2 'at least 0' "a negative modulus" "$solve --relaxation 1MPa,-9MPa:1s --time 0 $more"
refuses 2 'No such file' "no file" "$solve --relaxation none.tsv --time 0 $more"
refuses 2 'binary' "a stream" "$solve --relaxation ball.rcg --time 0 $more"
long=$(printf 'x%.0s' {1..60}) # a unit that once filled the place of one and more
for tan in tandelta/1 "tan/$long" "tan/${long}${long}${long}"; do
    printf 'frequency/Hz storage/MPa loss/MPa %s\n1 1 1 1\n' "$tan" >four.txt
    refuses 2 'at least 4|no column .tan.|too long' "a fourth column ${tan:0:9}" \
        "$solve --relaxation four.txt --time 0 $more"
done
for table in 'time/s E/MPa\n0.001 10\n0.01 8\n' 't,E_relax\ns,MPa\n0.001,10\n0.01,8\n' \
    'Time (s);E(t) (MPa)\n0,001;10\n0,01;8\n'; do
    printf "$table" >measured.txt
    refuses 2 'a relaxation of 2 times: it must have at least 4' "a measured E(t) of two times, $table" "$solve --relaxation measured.txt --time 0 $more"
done
printf 'time/s E/MPa\n1 9\n2 8\n3 0\n4 7\n' >zero.txt
refuses 2 'line 4: E: it must be above 0' "a measured modulus of 0" "$solve --relaxation zero.txt --time 0 $more"
printf 'time/s E/MPa\n1 9\n2 8\n3 7\n4 7\ninf 1\ninf 2\n' >twice.txt
refuses 2 'line 7: the relaxed modulus .inf. is given twice' "two relaxed moduli" "$solve --relaxation twice.txt --time 0 $more"
refuses 2 'give its unit, K or degC' "a temperature without a unit" "$solve $solid --shift wlf,17.44,51.6,20degC --temperature 40 --time 0 $more"
refuses 2 '--shift wlf .*needs --temperature' "a law without a temperature" "$solve $solid --shift wlf,17.44,51.6,20degC --time 0 $more"
refuses 2 '--temperature .*without --shift' "a temperature without a law" "$solve $solid --shift 2 --temperature 20degC --time 0 $more"
refuses 2 'it must be factors, wlf,C1,C2,T0 or arrhenius,EA,T0' "half a law" "$solve $solid --shift wlf,17.44 --temperature 20degC --time 0 $more"
refuses 2 "unknown unit 'eV': J/mol is expected" "an energy in another unit" "$solve $solid --shift arrhenius,1eV,20degC --temperature 20degC --time 0 $more"
refuses 2 'relaxes less than the one before' "falling temperatures" "$solve $solid --shift wlf,17.44,51.6,20degC --temperature 40degC,20degC --time 1ms $more"
refuses 2 '--time has 2 values, and --shift or --temperature 3' "lists of other lengths" "$solve $solid --shift 3,2,1 --time 1ms,2ms $more"
refuses 2 'give their unit, K or degC' "temperatures without units" "$solve $solid --shift wlf,17.44,51.6,20degC --temperature 20,40 --time 1ms $more"
refuses 2 'a history has one temperature' "several loads with several factors" "$solve $solid --shift 2,1 --time 0,1ms --load 0.1mN,0.2mN -o t.rcg ball.rcg"
refuses 2 'needs a law that shifts its rows' "raw data without a law" "$solve --relaxation raw.csv --time 1ms $more"
refuses 2 'at .* it has no value: C2' "a temperature below the range of WLF" "$solve $solid --shift wlf,17.44,51.6,20degC --temperature -40degC --time 0 $more"
printf 'tau E\n1 9\n' >bare.txt
refuses 2 'bare.txt: line 2: E: give its unit' "a table of moduli without a unit" "$solve --relaxation bare.txt --time 0 $more"
printf "f/Hz,G'/MPa,G''/MPa\n1,1,1\n2,2,1\n" >shear.txt
refuses 2 "shear.txt: line 1: column 'G'': it is a shear modulus: multiply it by 2 .1 \+ nu." "shear moduli" "$solve --relaxation shear.txt --time 0 $more"
printf 'frequency storage\n1 9MPa\n' >two.txt
refuses 2 'heading must be .*tandelta or phase that of loss' "a table without losses" "$solve --relaxation two.txt --time 0 $more"
printf 'f,|E*|/MPa,phase/deg\n1,1,1\n2,1,90\n' >right.txt
refuses 2 'line 3: phase: it must be above 0 and below 90 degrees' "a phase of 90 degrees" "$solve --relaxation right.txt --time 0 $more"
sed 's/deg/1/' right.txt >bare.txt
refuses 2 'line 2: phase: give its unit, in the heading as in phase/deg' "a phase without a unit" "$solve --relaxation bare.txt --time 0 $more"
printf 'f,storage/MPa,tan delta\n1,1,1\n2,1,0\n' >zero.txt
refuses 2 'line 3: tan delta: it must be above 0' "a tan delta of 0" "$solve --relaxation zero.txt --time 0 $more"
printf 'f,storage/MPa,loss/MPa\n1,1,1\n2,0,1\n' >zero.txt
refuses 2 'line 3: storage: it must be above 0' "a storage modulus of 0" "$solve --relaxation zero.txt --time 0 $more"
refuses 2 '--relaxation has no effect without --time or --speed' "no times" "$solve $solid $more"
refuses 2 'must rise' "times that fall" "$solve $solid --time 0,2,1 $more"
refuses 2 'equal length' "other times than loads" "$solve $solid --time 0,2 --load 1uN,2uN,3uN -o x.rcg ball.rcg"
history='is a history, which begins at 0 s and has a time for each, .*independent, run rc-solve once for each: for p in'
refuses 2 "--time: 1 s: .*$history" "loads from a later time on" "$solve $solid --time 1,2 --load 1uN,2uN -o x.rcg ball.rcg"
refuses 2 "--time: 1000 s: .*$history" "loads with one time" "$solve $solid --time 1000 --load 1uN:2uN:3 -o x.rcg ball.rcg"
refuses 2 "--time: 0 s: .*$history" "  which is 0" "$solve $solid --time 0 --load 1uN,2uN -o x.rcg ball.rcg"
for other in '--E1 1MPa' '--hardness 1GPa' '--layer 1um,1GPa,0.3' '--adhesion 50mJ/m2' '--tilt free' --discretization; do
    refuses 2 "--relaxation does not work with ${other%% *}" "$other" "$solve $solid --time 0 $other $more"
done
rigid="$layer $solid --time 0 --load 0.2mN -o x.rcg"
refuses 2 'must have a --layer' "a rigid body 1" "$rigid ball.rcg"
refuses 2 'must relax alike' "an elastic layer" "$rigid --layer 1um,1MPa,0.3 ball.rcg"
refuses 2 'must relax alone' "a layer and an elastic body 2" "$rigid --E2 1MPa --nu2 0.3 --layer 1um,relaxation,0.3 ball.rcg"
refuses 2 'unknown unit|number' "a layer that relaxes alone" "$layer --load 1uN --layer 1um,relaxation,0.3 -o x.rcg ball.rcg"
refuses 2 'no effect without --relaxation' "--time alone" "rc-solve --estar 1MPa --time 0 $more"
