# SPDX-License-Identifier: GPL-3.0-or-later
# rc-wear: a ball that wears over four decades, in SI, and its running-in curve. Tested are the three ways to
# say how much wears, early ends, both bodies, coats and a hardness. An interrupted run continues, and unknown
# settings are refused.
. "$(dirname "$0")/../pipe.sh"

# map CHANNEL UNIT EXPRESSION: a frame of 32 x 32 nodes, its value at column i of row j
map() {
    perl -MCompress::Zlib -e '
        my ($name, $unit, $expr) = @ARGV; my $v = "";
        for my $j (0 .. 31) { for my $i (0 .. 31) { $v .= pack("d<", eval $expr) } }
        my $b = "RCG1\nchannel=$name\nnx=32\nny=32\ndx=1e-06\ndy=1e-06\nunit=$unit\ntype=f64\n\n$v";
        binmode STDOUT; print $b . sprintf("crc32 %08x\n", crc32($b)) . "RCGEND 1\n"' "$@"
}
# beside A B: the frames of both as one case
beside() { perl -0777 -ne 's/RCGEND (\d+)\n\z//; $n += $1; print; END { print "RCGEND $n\n" }' "$1" "$2"; }
coefficient() { beside pressed.rcg <(map wear-coefficient 1/Pa "$1" 2>/dev/null); }
export -f map beside coefficient
column() { # NAME ROW FILE: a number of a table
    awk -F'\t' -v name="$1" -v row="$2" 'NR == 1 { for (k = 1; k <= NF; k++) { sub("/.*", "", $k); if ($k == name) c = k } }
        NR == row + 1 { print $c }' "$3"
}
wear='rc-wear --quiet --coefficient 1e-6mm3/Nm'

# ---- a steel ball of 3 mm under 10 N: scar radii of an independent prototype, um; V = k P s ----

rc-synth sphere --nx 192 --ny 192 --dx 5um --radius 3mm | rc-solve --quiet --load 10N --estar 114GPa -o ball.rcg
$wear --distance 1m,10m,100m,1000m --report worn.tsv --steps steps.tsv -o worn.rcg ball.rcg
row=0
for radius in 85.2 141.4 249.1 442.1; do
    row=$((row + 1))
    near "$(awk "BEGIN { print 1e6 * sqrt($(column contact_area $row worn.tsv) / 3.141592653589793) }")" $radius 0.01 \
        "the scar after $(column distance $row worn.tsv) m"
    near "$(column wear_volume $row worn.tsv)" "$(awk "BEGIN { print 1e-14 * $(column distance $row worn.tsv) }")" 1e-12 \
        "  its volume is k P s"
    claim "  the result has converged" test "$(column converged $row worn.tsv)" = true
done
claim "--steps names the surface in each row, as the report does" test "$(column source 1 steps.tsv),$(column source 9 steps.tsv)" = "$(column source 1 worn.tsv),$(column source 1 worn.tsv)"
claim "--steps writes a row for each step, with increasing distance" test \
    "$(awk -F'\t' 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == "distance/m") c = k } NR > 1 { bad += $c <= last; last = $c; n++ }
        END { print n, bad + 0 }' steps.tsv)" = "$(column steps 4 worn.tsv) 0"
claim "solved again, the worn heights give the same pressure" bash -c "
    rc-pick --case 4 --channel height worn.rcg | rc-solve --quiet --load 10N --estar 114GPa --report again.tsv -o again.rcg"
near "$(column max_pressure 1 again.tsv)" "$(column max_pressure 4 worn.tsv)" 0.03 "  the largest one"
near "$(column contact_area 1 again.tsv)" "$(column contact_area 4 worn.tsv)" 0.01 "  and the same area"

claim "a picture of each distance, and the running-in curve with its units" bash -c '
    rc-render --channel pressure --case 1,2 -o maps.svg worn.rcg && rc-render --case 2 -o map.svg worn.rcg &&
        grep -q "distance 10 m" map.svg && grep -q ">b) distance 10 m<" maps.svg && ! grep -q "case 2" maps.svg &&
        rc-render --curve distance:max_wear_depth --log x -o curve.svg steps.tsv &&
        grep -q "Sliding distance (m)" curve.svg && grep -q "Largest worn depth (..m)" curve.svg &&
        rc-render --curve distance:contact_fraction --log x -o report.svg worn.tsv && grep -q ">Contact fraction<" report.svg'

# ---- how much wears ----

rc-synth selfaffine --nx 32 --ny 32 --dx 1um --hurst 0.8 --rms-slope 0.1 --short-cut 8um --seed 3 -o rough.rcg
rc-solve --quiet --periodic --load 1mN --estar 1GPa -o pressed.rcg rough.rcg
for tol in 0.1 1e-3; do
    rc-wear --quiet --coefficient 2e-6mm3/Nm --distance 0.5m,5m,50m --tol $tol --report peak-$tol.tsv --steps every-$tol.tsv \
        -o peak.rcg pressed.rcg
done
for row in 1 2 3; do
    between "$(awk "BEGIN { x = $(column max_pressure $row peak-0.1.tsv) / $(column max_pressure $row peak-1e-3.tsv) - 1; print x < 0 ? -x : x }")" \
        "$(column max_pressure_error_estimate $row peak-0.1.tsv)" 2 "distance $row: the estimated error of the largest pressure is not below its error"
done
claim "  it is unknown between two distances" test "$(column max_pressure_error_estimate 1 every-0.1.tsv)" = NaN
volume() { "$@" --quiet --report volume.tsv -o volume.rcg pressed.rcg && column wear_volume 1 volume.tsv; }
near "$(volume rc-wear --coefficient 2e-6mm3/Nm --distance 1m)" 2e-18 1e-12 "in mm3/Nm"
near "$(volume rc-wear --coefficient 2e-15m2/N,0 --distance 1m)" 2e-18 1e-12 "in m2/N"
near "$(volume rc-wear --coefficient "2e-6 1/GPa" --distance 1m)" 2e-18 1e-12 "in 1/GPa"
near "$(volume rc-wear --archard 4e-6 --hardness 2GPa --distance 1m)" 2e-18 1e-12 "by Archard's number"
near "$(volume rc-wear --archard 4e-6 --hardness 600HV --distance 1m)" "$(awk 'BEGIN { print 4e-9 / (600 * 9.80665e6) }')" 1e-6 \
    "  with H of a Vickers number, K P s/(HV 9.80665 MPa)"
claim "  which a warning says" warns '600HV is 5.88399 GPa: H of Archard' \
    rc-wear --archard 4e-6 --hardness 600HV --distance 1m --dry-run pressed.rcg
near "$(volume rc-wear --archard 4e-6 --hardness 600HV --hardness 6GPa --distance 1m)" "$(volume rc-wear --archard 4e-6 --hardness 6GPa --distance 1m)" 0 \
    "  a later --hardness in Pa is taken as it is"
near "$(volume rc-wear --energy 1e-5mm3/J --mu 0.2 --distance 1m)" 2e-18 1e-12 "by energy"
claim "a worn surface wears on" bash -c "
    $wear --distance 1m -o part.rcg pressed.rcg && $wear --distance 9m --report rest.tsv -o rest.rcg part.rcg &&
    $wear --distance 10m --report through.tsv -o through.rcg pressed.rcg"
near "$(column contact_area 1 rest.tsv)" "$(column contact_area 1 through.tsv)" 0.01 "  to the area of one run"
near "$(column wear_volume 1 rest.tsv)" 9e-18 1e-12 "  and counts from its heights"
claim "both bodies wear, each its part" bash -c "
    rc-wear --quiet --coefficient 1e-6mm3/Nm,3e-6mm3/Nm --distance 1m -o both.rcg pressed.rcg &&
    rc-info both.rcg | grep -c 'wear-[12]' | grep -q 2"
claim "the contact before any wear is that of rc-solve" bash -c "
    $wear --distance 0 --tol 1e-2 --report none.tsv -o none.rcg pressed.rcg &&
    rc-solve --quiet --periodic --load 1mN --estar 1GPa --report elastic.tsv -o elastic.rcg rough.rcg"
near "$(column max_pressure 1 none.tsv)" "$(column max_pressure 1 elastic.tsv)" 1e-3 "  its largest pressure"
near "$(column approach 1 none.tsv)" "$(column approach 1 elastic.tsv)" 1e-3 "  its approach"
claim "the contact after wear is that of rc-solve on the worn heights" bash -c "
    $wear --distance 10m --tol 1e-2 --report worn.tsv -o worn.rcg pressed.rcg && rc-pick --channel height worn.rcg |
        rc-solve --quiet --periodic --load 1mN --estar 1GPa --report again.tsv -o again.rcg"
near "$(column approach 1 worn.tsv)" "$(column approach 1 again.tsv)" 1e-3 "  its approach"

# ---- a ball on a track: the half width of the groove is (3 R k2 P s / (2 L))^(1/3), here 13.6 um ----

rc-synth sphere --nx 48 --ny 48 --dx 1um --radius 100um | rc-solve --quiet --load 0.853333mN --estar 1GPa -o pin.rcg
track='rc-wear --quiet --coefficient 0,1e-6mm3/Nm --motion track:1mm'
claim "a ball wears a track" bash -c "$track --distance 19653m --output pressure,height,wear,wear-2 --report groove.tsv -o groove.rcg pin.rcg"
near "$(column wear_volume_2 1 groove.tsv)" 1.67706e-14 1e-5 "  which loses k P s"
claim "  and the ball nothing" test "$(column wear_volume_1 1 groove.tsv)" = 0
claim "  the groove is as wide as that of a rigid ball" test "$(rc-export --channel pressure --format csv groove.rcg |
    grep -v '^#' | awk -F, '{ for (i = 1; i <= NF; i++) if ($i > 0) { n++; next } } END { print n }')" = 28
claim "  and as deep along each row" test "$(rc-export --channel wear-2 --format csv groove.rcg |
    grep -v '^#' | awk -F, '{ for (i = 2; i <= NF; i++) bad += $i != $1 } END { print bad + 0 }')" = 0
$wear --distance 1km -o same.rcg pin.rcg
$wear --motion track:1mm --distance 1km -o alone.rcg pin.rcg
claim "a track that does not wear changes nothing" cmp <(rc-export --channel pressure --format csv same.rcg | grep -v '^#') \
    <(rc-export --channel pressure --format csv alone.rcg | grep -v '^#')
claim "a periodic map is its own track" warns 'passed every 32 um and not every 1 mm: give the period as the length of the track' \
    rc-wear --coefficient 0,1e-6mm3/Nm --motion track:1mm --distance 1m -o x.rcg pressed.rcg
claim "  whose length is then no warning" bash -c "
    rc-wear --coefficient 0,1e-6mm3/Nm --motion track:32um --distance 1m -o x.rcg pressed.rcg 2>own.err && ! [ -s own.err ]"
refuses 1 'cut the contact out with rc-pick --crop' "a track shorter than the map" "$wear --motion track:40um --distance 1m -o x.rcg pin.rcg"
refuses 1 'check the units of the wear coefficient' "a coefficient that is far too large" "rc-wear --coefficient '1e300 1/Pa' --distance 1m -o x.rcg pin.rcg"
refuses 2 'with a length above 0' "a track without a length" "$wear --motion track:0 --distance 1m -o x.rcg pin.rcg"
refuses 2 '--motion track does not work with --cycles' "a track in fretting" "$wear --motion track:1mm --cycles 10 -o x.rcg pin.rcg"

# ---- two rough bodies that slide over each other ----

rc-synth selfaffine --nx 32 --ny 32 --dx 1um --hurst 0.8 --rms-slope 0.1 --short-cut 8um --seed 4 -o other.rcg
slide='rc-wear --quiet --coefficient 1e-6mm3/Nm,3e-6mm3/Nm --motion sliding --counter other.rcg'
claim "two rough bodies slide over each other" bash -c "
    $slide --distance 10m,100m --report slid.tsv --steps slid-steps.tsv -o slid.rcg pressed.rcg"
near "$(column wear_volume_1 2 slid.tsv)" 1e-16 1e-9 "  body 1 loses k1 P s"
near "$(column wear_volume_2 2 slid.tsv)" 3e-16 1e-9 "  and body 2 k2 P s"
between 1e-3 "$(column wear_error_estimate 1 slid.tsv)" 0.1 "  within the tolerance"
claim "  both worn bodies and the contact where they began are written" test \
    "$(rc-info slid.rcg | grep -c 'frame [0-9]* (\(pressure\|gap\|height\|wear\|wear-1\|wear-2\))')" = 12
claim "  a mirrored pair wears as its mirror image" bash -c "
    rc-solve --quiet --periodic --load 1mN --estar 1GPa <(rc-pick --mirror y rough.rcg) |
        ${slide/other.rcg/<(rc-pick --mirror y other.rcg)} --distance 10m --report mirrored.tsv -o x.rcg"
near "$(column max_wear_depth 1 mirrored.tsv)" "$(column max_wear_depth 1 slid.tsv)" 1e-6 "  its largest worn depth"
claim "  the pressure at the end is that of one alignment, with its error" warns 'pressure of one alignment.*--tol' \
    ${slide/--quiet/} --distance 100m -o x.rcg pressed.rcg
phase_of() { beside pressed.rcg <(map wear-coefficient 1/Pa '$i < 16 ? 1e-15 : 5e-16' 2>/dev/null); }
export -f phase_of
refuses 1 'needs a map that is periodic along x' "a free map" "$slide --distance 1m -o x.rcg pin.rcg"
refuses 1 'sliding with a hardness' "a hardness" "$slide --distance 1m -o x.rcg <(rc-solve --quiet --periodic --hardness 50MPa --load 1mN --estar 1GPa rough.rcg)"
refuses 1 'sliding with a map of the wear coefficient' "a coefficient of each node" \
    "rc-wear --motion sliding --counter other.rcg --distance 1m -o x.rcg <(phase_of)"
refuses 2 '--motion sliding has no effect without --counter' "no body 2" "$wear --motion sliding --distance 1m -o x.rcg pressed.rcg"
refuses 2 '--counter has no effect without --motion sliding' "a body 2 that does not slide" "$wear --counter other.rcg --distance 1m -o x.rcg pressed.rcg"
refuses 2 '--motion sliding does not work with --until' "an early end" "$slide --until depth=1nm --distance 1m -o x.rcg pressed.rcg"
refuses 2 '--motion sliding does not work with --cycles' "cycles" "rc-wear --coefficient 1e-6mm3/Nm --motion sliding --counter other.rcg --cycles 10 -o x.rcg pressed.rcg"
refuses 2 'it must be same, sliding or track:LENGTH' "another motion" "$wear --motion rolling --distance 1m -o x.rcg pressed.rcg"

# ---- early ends ----

$wear --distance 1km,10km,100km --until area=0.5 --report half.tsv -o half.rcg pressed.rcg
between 0.5 "$(column contact_fraction 1 half.tsv)" 0.52 "--until area"
$wear --distance 1km,10km,100km --until area=50% -o percent.rcg pressed.rcg
claim "  a percentage is the same" cmp <(rc-pick --channel wear half.rcg | rc-export --format csv) <(rc-pick --channel wear percent.rcg | rc-export --format csv)
# the frame pressure of pressed.rcg has the first contact; twice its area is one fraction of the map
twice=$(rc-pick --channel pressure pressed.rcg | rc-export --format csv | grep -v '^#' | tr ',' '\n' |
    awk '{ n++; touch += $1 > 0 } END { printf "%.17g", 2 * touch / n }')
$wear --distance 100km --until area=2x --report twice.tsv -o twice.rcg pressed.rcg
between "$twice" "$(column contact_fraction 1 twice.tsv)" "$(awk "BEGIN { print $twice * 1.04 }")" "--until area=2x: twice the first contact area"
$wear --distance 100km --until "area=$twice" -o fraction.rcg pressed.rcg
claim "  the same as this part of the map" cmp <(rc-pick --channel wear twice.rcg | rc-export --format csv) <(rc-pick --channel wear fraction.rcg | rc-export --format csv)
claim "  the warning names the part of the map" warns "not reached at the last distance, 1 mm: [0-9.]+ of the map is in contact, and not $(awk "BEGIN { printf \"%.3g\", $twice }")\$" \
    rc-wear --coefficient 1e-6mm3/Nm --distance 1mm --until area=2x -o x.rcg pressed.rcg
refuses 1 'area=1000x: the first contact area is .* of the map, and 1000 times as much is more than the map' "more than the map" "$wear --distance 1m --until area=1000x -o x.rcg pressed.rcg"
refuses 1 'needs the first contact area, from a frame pressure' "no first contact" "rc-pick --channel height pressed.rcg | $wear --distance 1m --until area=2x -o x.rcg"
refuses 2 'or area=2x for twice' "less than the first contact" "$wear --distance 1m --until area=0.5x -o x.rcg pressed.rcg"
claim "  later distances are omitted" test "$(wc -l <half.tsv)" = 2
$wear --distance 100km --until depth=30nm,uniform=1e-9 --report deep.tsv -o deep.rcg pressed.rcg
between 30e-9 "$(column max_wear_depth 1 deep.tsv)" 30.6e-9 "--until depth"
near "$(column wear_volume 1 deep.tsv)" "$(awk "BEGIN { printf \"%.17g\", 1e-18 * $(column distance 1 deep.tsv) }")" 1e-12 "  with its distance"
$wear --distance 100km --until uniform=0.3 --report even.tsv -o even.rcg pressed.rcg
between 0 "$(column pressure_spread 1 even.tsv)" 0.3 "--until uniform"
rc-wear --coefficient 1e-6mm3/Nm --verbose --distance 100km --until depth=30nm --report said.tsv -o x.rcg pressed.rcg 2>err
near "$(perl -ne 'print $1 * {mm => 1e-3, m => 1, km => 1e3}->{$2} if /, distance ([\d.]+) (mm|m|km)[,:]/ && !$n++' err)" \
    "$(column distance 1 said.tsv)" 1e-4 "a line names the distance where it ended"
claim "  and nothing is missed" bash -c "! grep -q 'until was not reached' err"
claim "a depth in metres is not reached" warns \
    'until was not reached at the last distance, 10 m: the largest worn depth is [0-9.]+ [nu]m, and not 30 m: the spread of the pressure is [0-9.]+, and not 1e-09$' \
    rc-wear --coefficient 1e-6mm3/Nm --distance 1m,10m --until depth=30,uniform=1e-9 -o x.rcg pressed.rcg
# a list of distances around the end: the condition is met there, and not 4 % earlier
for end in half:contact_fraction:0.5 deep:max_wear_depth:30e-9 even:pressure_spread:0.3; do
    IFS=: read -r run figure value <<<"$end"
    s=$(column distance 1 $run.tsv)
    $wear --tol 0.01 --distance "$(awk "BEGIN { printf \"%.9g,%.9g\", $s * 0.96, $s * 1.02 }")" --report around.tsv -o x.rcg pressed.rcg
    claim "  $figure at the end of --until, in a list of distances: $(column $figure 1 around.tsv), $(column $figure 2 around.tsv)" \
        awk -v a="$(column $figure 1 around.tsv)" -v b="$(column $figure 2 around.tsv)" -v u=$value -v run=$run \
        'BEGIN { exit !(run == "even" ? a > u && b < u : a < u && b > u) }'
done

# ---- hardness and coats ----

rc-solve --quiet --load 10N --estar 114GPa --hardness 1GPa \
    <(rc-synth sphere --nx 96 --ny 96 --dx 5um --radius 3mm) -o hard.rcg
$wear --distance 0,1m --report hard.tsv -o hard-worn.rcg hard.rcg
near "$(column max_pressure 1 hard.tsv)" 1e9 1e-12 "the hardness of the stream bounds the pressure"
claim "  the pressure then falls" awk "BEGIN { exit !($(column max_pressure 2 hard.tsv) < 7e8) }"
near "$(column wear_volume 2 hard.tsv)" 1e-14 1e-12 "  and dents are not worn volume"
rc-solve --quiet --E1 1GPa --nu1 0.3 --E2 rigid --layer 2um,3GPa,0.3 --load 1mN rough.rcg -o coated.rcg
claim "a coated body wears" bash -c "$wear --distance 1km -o coat.rcg coated.rcg"
refuses 1 'lost .* of its coat, and 2 um was left' "  not through" "$wear --distance 1000Mm -o x.rcg coated.rcg"
refuses 3 'and 2 um was left: .*: the output ends with the distance before' "  in a list of distances" \
    "rc-wear --coefficient 1e-6mm3/Nm --distance 1km,1000Mm,2000Mm --report through.tsv -o through.rcg coated.rcg"
claim "    whose first distance is kept" bash -c "[ \$(wc -l <through.tsv) = 2 ] && rc-info --json through.rcg | grep -c '\"distance\": *\"\?1000' &&
    cmp <(rc-export --channel wear --case 1 --format csv through.rcg) <(rc-export --channel wear --format csv coat.rcg)"
claim "the wear of body 2 does not count against the coat of body 1" \
    rc-wear --quiet --coefficient 0,1e-6mm3/Nm --distance 1000Mm -o x.rcg coated.rcg
left() { rc-info --json "$1" | grep -o '"coat_left": *"\?[^",]*' | head -n 1 | sed 's/.*[ "]//'; }
deep=$(column max_wear_depth 1 through.tsv)
near "$(left coat.rcg)" "$(awk "BEGIN { printf \"%.17g\", 2e-6 - $deep }")" 1e-9 "what is left of the coat is a key"
refuses 1 "was left" "  so that the coat is worn through when it is worn again" "$wear --distance 1km -o x.rcg coat.rcg"
$wear --distance 50m --report little.tsv -o little.rcg coat.rcg
near "$(left little.rcg)" "$(awk "BEGIN { printf \"%.17g\", 2e-6 - $deep - $(column max_wear_depth 1 little.tsv) }")" 1e-9 \
    "  and both runs count"
refuses 1 'coat is worn through' "  nothing may be left" "rc-pick --set coat_left=0 coated.rcg | $wear --distance 1km -o x.rcg"

rc-solve --quiet --periodic --load 1mN --estar 1GPa \
    <(beside rough.rcg <(map hardness Pa '$i % 32 < 16 ? 1e7 : "inf"')) -o spots.rcg
refuses 1 'bounded by a map, and it has no frame hardness' "a map of hardness that is lost" "$wear --distance 1m -o x.rcg spots.rcg"
beside <(rc-pick --channel height spots.rcg) <(map hardness Pa '$i % 32 < 16 ? 1e7 : "inf"') >spots-hard.rcg
claim "a map of hardness" $wear --distance 0 --report spots.tsv -o x.rcg spots-hard.rcg
claim "  bounds the pressure where it is low" test "$(rc-export --channel pressure --format csv x.rcg | grep -v '^#' |
    awk -F, '{ for (i = 1; i <= 16; i++) if ($i > most) most = $i } END { print most / 1e7 }')" = 1

# ---- a coefficient of each node ----

coefficient 1e-15 >even.rcg
rc-wear --quiet --distance 10m,1000m --report even.tsv -o even-worn.rcg even.rcg
$wear --distance 10m,1000m --report same.tsv -o same.rcg pressed.rcg
near "$(column max_wear_depth 2 even.tsv)" "$(column max_wear_depth 2 same.tsv)" 1e-9 "a map with one value is the coefficient"
coefficient '($i / 8 % 2 < 1) ? 1e-15 : 2.5e-16' >phases.rcg
claim "two phases" rc-wear --quiet --distance 1000m --report phases.tsv -o phases-worn.rcg phases.rcg
claim "  where k p is even in the end" bash -c '
    rc-wear --quiet --distance 1000km --output pressure phases.rcg | rc-export --format csv | grep -v "^#" |
        awk -F, "{ for (i = 1; i <= 32; i++) s[int((i - 1) / 8) % 2] += \$i } END { q = s[1] / s[0]; exit !(q > 3.98 && q < 4.02) }"'
claim "  the plan says what it costs" says 'coefficients +by node: a contact takes about' rc-wear --dry-run --distance 1m phases.rcg
forecast() { "$@" --dry-run | sed -n 's/.*about \([0-9.e+]*\) convolutions.*/\1/p'; }
near "$(forecast rc-wear --distance 1000m phases.rcg)" "$(awk "BEGIN { print 1.5 * $(forecast $wear --distance 1000m pressed.rcg) }")" 0.01 \
    "  and one and a half times the convolutions of a uniform coefficient"
between 0.5 "$(awk "BEGIN { print $(forecast rc-wear --distance 1000m phases.rcg) / $(column convolutions 1 phases.tsv) }")" 2 \
    "  within a factor of 2 of the run"
refuses 2 'leave out --coefficient' "a map and a number" "$wear --distance 1m -o x.rcg phases.rcg"
refuses 1 "value -?nan at column 0, row 0" "a map without a number" "rc-wear --distance 1m -o x.rcg <(coefficient '\"nan\"')"
refuses 1 'value -1' "a coefficient below 0" "rc-wear --distance 1m -o x.rcg <(coefficient '\$i ? 1e-15 : -1')"
refuses 1 'all its values are 0' "a map of 0" "rc-wear --distance 1m -o x.rcg <(coefficient 0)"
refuses 1 "its unit is 'Pa'" "a map in pascals" "rc-wear --distance 1m -o x.rcg <(beside pressed.rcg <(map wear-coefficient Pa 1))"
refuses 1 'grid' "a map of another size" "rc-wear --distance 1m -o x.rcg <(beside hard.rcg <(map wear-coefficient 1/Pa 1))"

# ---- fretting: a Hertz contact of 20 nodes, F = 0.6 mu P; Cattaneo's stick zone has 14.74 nodes, that of the grid 14.80 by its area ----

rc-synth sphere --nx 64 --ny 64 --dx 1um --radius 1mm | rc-solve --quiet --load 1.0666667N --estar 100GPa -o fretted.rcg
stuck=
for cycles in 4000 8000 16000 32000 64000; do
    rc-slip --quiet --mu 0.3 --nu 0 --tangential 0.192N --output height,slip --report stick.json -o slip.rcg fretted.rcg
    rc-wear --quiet --coefficient 5e-4mm3/Nm --cycles $cycles --report fretted.tsv -o fretted.rcg slip.rcg
    stuck="$stuck $(field stick_nodes stick.json)"
done
claim "the stick zone does not move" test "$stuck" = " 688 688 688 688 688"
plain() { rc-export --channel "$1" --format csv "$2" | grep -v '^#'; }
shares=$(plain slip slip.rcg | paste -d, - <(plain pressure fretted.rcg) | awk -F, '
    { for (i = 1; i <= 64; i++) { all += $(i + 64); stuck += $i == 0 ? $(i + 64) : 0; r = sqrt((i - 32.5)^2 + (NR - 32.5)^2)
          if (r < 0.8 * 14.8) { w = sqrt(14.8^2 - r^2); n++
              q += $(i + 64) / (2e11 / 1000 / 3.14159265 * w + (1.0666667e12 - 4e11 * 14.8^3 / 3000) / (2 * 3.14159265 * 14.8 * w)) } } }
    END { print stuck / all, q / n }')
between 0.997 "${shares% *}" 1 "  and takes the load"
near "${shares#* }" 1 0.01 "  as the ball cut off there: its mean pressure"
rc-slip --quiet --mu 0.3 --nu 0 --path '1N,0,0; 1N,0.2N,0; 1N,-0.2N,0; 1N,0.2N,0' --output height,slip,slip-x -o loop.rcg \
    <(rc-pick --case 1 fretted.rcg)
way() { rc-pick --case "$1" --channel slip loop.rcg | rc-export --format csv | grep -v '^#' | tr , '\n' | awk '{ s += $1 } END { print s }'; }
near "$(way 3)" "$(way 4)" 0.02 "both ways of a loop slip equally far"
claim "cycles name the point" warns 'case 2, load 1.06667 N, cycles 3000: contact fraction' \
    rc-wear --verbose --coefficient 5e-4mm3/Nm --cycles 1000,3000 --report cycles.tsv --steps cycle-steps.tsv -o cycles.rcg slip.rcg
claim "  in its key, without a distance" bash -c 'rc-pick --case 2 --channel height cycles.rcg | rc-info --json | tee keys.json | grep -qE "\"cycles\": *\"?3000\"?," && ! grep -q "\"distance\"" keys.json'
near "$(awk "BEGIN { printf \"%.17g\", $(column distance 2 cycles.tsv) / 3000 }")" "$(plain slip slip.rcg | tr , '\n' | sort -g | tail -1)" 1e-9 \
    "  the column distance has the way of the node that slips most"
near "$(column cycles 2 cycles.tsv)" 3000 0 "  and the column cycles their number"
claim "  whose curve is drawn" rc-render --curve cycles:max_wear_depth -o curve.svg cycle-steps.tsv
refuses 2 'cycles needs a frame slip' "cycles without a slip" "$wear --cycles 10 -o x.rcg pressed.rcg"
refuses 2 'give --cycles' "a slip without cycles" "$wear --distance 1m -o x.rcg slip.rcg"
refuses 2 'larger than the one before' "cycles that fall" "$wear --cycles 10,1 -o x.rcg slip.rcg"

# ---- stopped, and on ----

whole="$wear --tol 0.01 --distance 1m,1000m"
interrupted() {
    $whole --checkpoint kept.rcg --interval 0.01 -o cut.rcg ball.rcg &
    until [ "$(grep -ac ^RCGEND kept.rcg 2>/dev/null)" -ge 6 ] || ! kill -0 $!; do sleep 0.01; done
    kill -TERM $!
    wait $!
    [ $? = 143 ]
}
claim "a signal stops the run" interrupted
claim "  --resume continues it" bash -c "
    $whole --checkpoint kept.rcg --resume --report on.tsv -o on.rcg ball.rcg && $whole --report straight.tsv -o straight.rcg ball.rcg"
near "$(column max_wear_depth 2 on.tsv)" "$(column max_wear_depth 2 straight.tsv)" 1e-3 "  to the same depth"
near "$(column max_pressure 2 on.tsv)" "$(column max_pressure 2 straight.tsv)" 1e-2 "  and the same pressure"

# ---- words ----

claim "the plan compares with explicit steps" says 'explicit steps +about 2.53e.04, each at most 0.9 dx/.k E.. = 39.4737 mm' \
    $wear --dry-run --distance 1km ball.rcg
loud='rc-wear --coefficient 1e-6mm3/Nm'
claim "a distance without noticeable wear causes a warning" warns 'the last distance, 1 um, hardly changes the contact, which takes about 4.38596 mm' \
    $loud --distance 1um -o x.rcg ball.rcg
claim "a distance after which nothing changes causes a warning" warns 'the first distance, 1e.09 m, the pressure is even already, which takes about 320 m' \
    $loud --distance 1000Mm -o x.rcg pressed.rcg
claim "  a surface that is worn away completely causes a warning" grep -q 'largest worn depth, .*, is more than the peak-to-valley height of the surface before wear, .*--until area' warns.err
claim "  a periodic map causes no warning about the edge" bash -c '! grep -q "edge of the map" warns.err'
claim "  a usual distance causes no warning" bash -c "$loud --distance 1m,100m -o x.rcg pressed.rcg 2>usual.err && ! [ -s usual.err ]"
claim "a scar at the edge of a free map causes a warning" warns 'share of the load at the edge is .*, above 0.01: .*: take a larger map' \
    $loud --distance 20km -o x.rcg ball.rcg
rc-synth selfaffine --nx 32 --ny 32 --dx 1um --hurst 0.8 --rms-slope 1.2 --short-cut 8um --seed 3 |
    rc-solve --quiet --periodic --load 1mN --estar 1GPa -o steep.rcg
claim "slopes beyond the theory cause a warning" warns 'case 1, load 1 mN, distance 1 m: RMS slope 0.[3-9][0-9]* where the bodies touch is beyond the theory of small slopes .0.3.' \
    $loud --distance 1m -o x.rcg steep.rcg
claim "--verbose prints the figures of a case" warns 'case 2, load 10 N, distance 1 m: contact fraction 0.024.*, largest worn depth .* nm, worn volume 1e-14 m3, steps ' \
    rc-wear --verbose --coefficient 1e-6mm3/Nm --distance 0,1m -o x.rcg ball.rcg
refuses 2 'with its unit, as in 1e-6mm3/Nm.*--archard' "a coefficient without a unit" "rc-wear --coefficient 1e-4 --distance 1m ball.rcg -o x.rcg"
refuses 2 'each at least 0' "one below 0" "rc-wear --coefficient -1e-6mm3/Nm --distance 1m ball.rcg -o x.rcg"
refuses 2 'each at least 0' "one that is not a number" "rc-wear --coefficient nanmm3/Nm --distance 1m ball.rcg -o x.rcg"
refuses 2 'no body wears' "two of 0" "rc-wear --coefficient 0,0 --distance 1m ball.rcg -o x.rcg"
refuses 2 'give one of --coefficient' "none" "rc-wear --distance 1m ball.rcg -o x.rcg"
refuses 2 '--archard has no effect without --hardness' "Archard's number without a hardness" "rc-wear --archard 1e-4 --distance 1m ball.rcg -o x.rcg"
refuses 2 '--energy has no effect without --mu or --cycles' "an energy without a friction" "rc-wear --energy 1e-5mm3/J --distance 1m ball.rcg -o x.rcg"
refuses 2 'larger than the one before' "a distance that falls" "$wear --distance 2m,1m ball.rcg -o x.rcg"
refuses 2 'give one of --distance and --cycles' "no distance" "$wear ball.rcg -o x.rcg"
refuses 2 'it must be area=FRACTION' "an end that is none" "$wear --distance 1m --until area=2 ball.rcg -o x.rcg"
refuses 2 'no key load.*run rc-solve first' "a surface that carries nothing" "$wear --distance 1m rough.rcg -o x.rcg"
refuses 1 'attract each other' "bodies that attract each other" \
    "rc-solve --quiet --estar 1GPa --adhesion 50mJ/m2 --load 1uN rough.rcg | $wear --distance 1m -o x.rcg"
refuses 1 'tilt' "a body that tilts" "rc-solve --quiet --estar 1GPa --tilt free --load 1mN rough.rcg | $wear --distance 1m -o x.rcg"
