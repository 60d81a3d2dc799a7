# rc-wear: a ball that wears over four decades, in SI, and its running-in curve; the three ways to say how much wears;
# early ends; both bodies, coats and a hardness; an interrupted run continues; what is not known is refused.
. "$(dirname "$0")/../pipe.sh"

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
        grep -q "Sliding distance (km)" curve.svg && grep -q "Largest worn depth (..m)" curve.svg &&
        rc-render --curve distance:contact_fraction --log x -o report.svg worn.tsv && grep -q ">Contact fraction<" report.svg'

# ---- how much wears ----

rc-synth selfaffine --nx 32 --ny 32 --dx 1um --hurst 0.8 --rms-slope 0.1 --short-cut 8um --seed 3 -o rough.rcg
rc-solve --quiet --periodic --load 1mN --estar 1GPa -o pressed.rcg rough.rcg
volume() { "$@" --quiet --report volume.tsv -o volume.rcg pressed.rcg && column wear_volume 1 volume.tsv; }
near "$(volume rc-wear --coefficient 2e-6mm3/Nm --distance 1m)" 2e-18 1e-12 "in mm3/Nm"
near "$(volume rc-wear --coefficient 2e-15m2/N,0 --distance 1m)" 2e-18 1e-12 "in m2/N"
near "$(volume rc-wear --archard 4e-6 --hardness 2GPa --distance 1m)" 2e-18 1e-12 "by Archard's number"
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

# ---- early ends ----

$wear --distance 1km,10km,100km --until area=0.5 --report half.tsv -o half.rcg pressed.rcg
between 0.5 "$(column contact_fraction 1 half.tsv)" 0.6 "--until area"
claim "  later distances are omitted" test "$(wc -l <half.tsv)" = 2
$wear --distance 100km --until depth=30nm,uniform=1e-9 --report deep.tsv -o deep.rcg pressed.rcg
between 30e-9 "$(column max_wear_depth 1 deep.tsv)" 36e-9 "--until depth"
near "$(column wear_volume 1 deep.tsv)" "$(awk "BEGIN { printf \"%.17g\", 1e-18 * $(column distance 1 deep.tsv) }")" 1e-12 "  with its distance"

# ---- hardness and coats ----

rc-solve --quiet --load 10N --estar 114GPa --hardness 1GPa \
    <(rc-synth sphere --nx 96 --ny 96 --dx 5um --radius 3mm) -o hard.rcg
$wear --distance 0,1m --report hard.tsv -o hard-worn.rcg hard.rcg
near "$(column max_pressure 1 hard.tsv)" 1e9 1e-12 "the hardness of the stream bounds the pressure"
claim "  the pressure then falls" awk "BEGIN { exit !($(column max_pressure 2 hard.tsv) < 7e8) }"
near "$(column wear_volume 2 hard.tsv)" 1e-14 1e-12 "  and dents are not worn volume"
rc-solve --quiet --E1 1GPa --nu1 0.3 --E2 rigid --layer 2um,3GPa,0.3 --load 1mN rough.rcg -o coated.rcg
claim "a coated body wears" bash -c "$wear --distance 1km -o coat.rcg coated.rcg"
refuses 1 'more than the thickness of the coat, 2 um' "  not through" "$wear --distance 1000Mm -o x.rcg coated.rcg"

# ---- stopped, and on ----

whole="$wear --tol 0.01 --distance 1m,1000m"
interrupted() {
    $whole --checkpoint kept.rcg --interval 0.01 -o cut.rcg ball.rcg &
    until [ -s kept.rcg ] || ! kill -0 $!; do sleep 0.02; done
    sleep 0.2
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

claim "the plan compares with explicit steps" says 'explicit steps: about 2.53e.04, each at most 0.9 dx/.k E.. = 39.4737 mm' \
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
refuses 2 'each at least 0' "one that is no number" "rc-wear --coefficient nanmm3/Nm --distance 1m ball.rcg -o x.rcg"
refuses 2 'no body wears' "two of 0" "rc-wear --coefficient 0,0 --distance 1m ball.rcg -o x.rcg"
refuses 2 'give one of --coefficient' "none" "rc-wear --distance 1m ball.rcg -o x.rcg"
refuses 2 'belong together' "Archard's number without a hardness" "rc-wear --archard 1e-4 --distance 1m ball.rcg -o x.rcg"
refuses 2 'belong together' "an energy without a friction" "rc-wear --energy 1e-5mm3/J --distance 1m ball.rcg -o x.rcg"
refuses 2 'larger than the one before' "a distance that falls" "$wear --distance 2m,1m ball.rcg -o x.rcg"
refuses 2 'give the sliding distances' "no distance" "$wear ball.rcg -o x.rcg"
refuses 2 'it must be area=FRACTION' "an end that is none" "$wear --distance 1m --until area=2 ball.rcg -o x.rcg"
refuses 2 'no key load.*run rc-solve first' "a surface that carries nothing" "$wear --distance 1m rough.rcg -o x.rcg"
refuses 1 'attract each other' "bodies that attract each other" \
    "rc-solve --quiet --estar 1GPa --adhesion 50mJ/m2 --load 1uN rough.rcg | $wear --distance 1m -o x.rcg"
refuses 1 'tilt' "a body that tilts" "rc-solve --quiet --estar 1GPa --tilt free --load 1mN rough.rcg | $wear --distance 1m -o x.rcg"

finish
