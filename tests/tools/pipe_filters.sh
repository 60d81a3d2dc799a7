# SPDX-License-Identifier: GPL-3.0-or-later
# rc-detrend removes spheres and cylinders and gives their radius, filters, removes outliers and spikes, tapers, in
# the given order, and records the steps.
. "$(dirname "$0")/../pipe.sh"

# figure NAME FILE: prints this figure of the first frame.
figure() {
    rc-info --json "$2" | sed -n "1s/.*\"$1\": \"\{0,1\}\([^\",]*\).*/\1/p"
}

# map NX NY 'expression in x, y (um) and k' FILE: writes heights in um on a grid of 1.1 um by 1 um.
map() {
    awk -v nx="$1" -v ny="$2" "BEGIN { for (j = 0; j < ny; j++) { s = \"\"
        for (i = 0; i < nx; i++) { x = (i - (nx - 1) / 2) * 1.1; y = j - (ny - 1) / 2; k = j * nx + i
            s = s sprintf(\" %.17g\", $3) }
        print s } }" | rc-import --quiet --dx 1.1um --dy 1um --z-unit um - -o "$4"
}

# ---- forms ----

# a ball of 2.385 mm with its apex outside of the map, a hollow of 150 um, a tilted rod of 80 um
map 33 47 'sqrt(2385^2 - (x - 900)^2 - (y + 400)^2) - 2100' ball.rcg
map 33 47 '-sqrt(150^2 - (x - 9)^2 - (y + 4)^2)' hollow.rcg
map 33 47 '0.1 * (0.8 * y - 0.6 * x) + sqrt(80^2 - (0.8 * x + 0.6 * y)^2 * 1.01) ' rod.rcg
for form in ball hollow; do
    claim "--sphere removes the $form" rc-detrend --sphere $form.rcg -o left.rcg
    between 0 "$(figure rms left.rcg)" "$(awk -v h="$(figure rms $form.rcg)" 'BEGIN { print 1e-7 * h }')" "  nothing is left"
    radius=$(figure form.radius left.rcg)
    if [ $form = ball ]; then
        near "$radius" 2.385e-3 1e-7 "  its radius, positive"
    else
        near "$radius" -150e-6 1e-7 "  its radius, negative"
    fi
done
# the horizontal section of a rod with the slope s is an ellipse. Across the rod the profile is a circle of
# radius 80 um / sqrt(1.01), with r^2 (1 + s^2) in place of r^2
claim "--cylinder removes a tilted rod" rc-detrend --cylinder rod.rcg -o left.rcg
between 0 "$(figure rms left.rcg)" 1e-12 "  nothing is left"
near "$(figure form.radius left.rcg)" "$(awk 'BEGIN { print 80e-6 / sqrt(1.01) }')" 1e-6 "  its radius"
claim "--verbose prints the radius" warns 'frame 1 \(height\): a hollow of radius 150 um' \
    rc-detrend --sphere --verbose hollow.rcg -o left.rcg
claim "the radius of a profile is printed too" bash -c "
    awk 'BEGIN { for (i = 0; i < 50; i++) printf \" %.17g\", sqrt(200^2 - (i - 20)^2) }' |
        rc-import --dx 1um --z-unit um - | rc-detrend --sphere -o line.rcg"
near "$(figure form.radius line.rcg)" 200e-6 1e-7 "  that of the circle"

# every seventh point is 5 um too high
map 33 47 'sqrt(2385^2 - (x - 900)^2 - (y + 400)^2) - 2100 + (k % 7 == 3 ? 5 : 0)' spikes.rcg
claim "spikes change a fitted sphere" rc-detrend --sphere spikes.rcg -o bent.rcg
between 1e-6 "$(awk -v r="$(figure form.radius bent.rcg)" 'BEGIN { d = r - 2.385e-3; print d < 0 ? -d : d }')" 1 "  its radius is wrong"
claim "  with --robust they do not, at any place of the option" bash -c '
    rc-detrend --robust --sphere spikes.rcg -o a.rcg && rc-detrend --sphere --robust spikes.rcg -o b.rcg &&
    cmp a.rcg b.rcg'
near "$(figure form.radius a.rcg)" 2.385e-3 1e-6 "  its radius is right"
near "$(figure maximum a.rcg)" 5e-6 1e-6 "  and a spike is what it was"

# ---- filters ----

# root PART: prints the root mean square of this fraction of a wave of 1 um.
root() {
    awk "BEGIN { printf \"%.12g\", 1e-6 / sqrt(2) * ($1) }"
}

wave='rc-synth wave --amplitude 1um --nx 256 --ny 9 --dx 1um'
claim "half of a wave of the cut-off length passes the filter" bash -c "
    $wave --wavelength 32um -o wave.rcg && rc-detrend --lowpass 32um wave.rcg -o low.rcg &&
    rc-detrend --highpass 32um wave.rcg -o high.rcg"
near "$(figure rms low.rcg)" "$(root 0.5)" 1e-6 "  low"
near "$(figure rms high.rcg)" "$(root 0.5)" 1e-6 "  high"
# exp(-ln 2 (50/32)^2)
claim "less of a shorter wave passes" rc-detrend --lowpass 50um wave.rcg -o low.rcg
near "$(figure rms low.rcg)" "$(root "exp(-log(2) * (50 / 32) ^ 2)")" 2e-6 "  by the formula"
claim "a filter does not change the period of a surface" says '"periodic": "yes"' rc-info --json low.rcg
claim "a band pass equals two steps" bash -c 'rc-detrend --lowpass 8um --highpass 100um wave.rcg -o band.rcg'
near "$(figure rms band.rcg)" \
    "$(root "exp(-log(2) / 16) * (1 - exp(-log(2) * (100 / 32) ^ 2))")" 2e-6 "  one after the other"
map 40 30 'k % 11 == 5 ? "NaN" : sin(k) + x' holes.rcg
claim "missing points stay missing" rc-detrend --lowpass 9um holes.rcg -o low.rcg
near "$(figure missing low.rcg)" "$(figure missing holes.rcg)" "$same" "  as many points"
claim "threads change no bit" bash -c '
    rc-synth selfaffine --hurst 0.8 --rms-height 1um --nx 200 --dx 1um -o rough.rcg
    for step in "--lowpass 9um" "--highpass 70um --robust" "--outliers 3" "--spikes 2" "--poly 5 --robust"; do
        rc-detrend --quiet --threads 1 $step rough.rcg -o one.rcg &&
        rc-detrend --quiet --threads 3 $step rough.rcg | cmp - one.rcg || exit 1
    done'

# ---- outliers, taper ----

map 40 30 'sin(x / 9) + 0.01 * sin(k * k) + (k % 100 == 50 ? 3 : 0)' spikes.rcg
claim "outliers become missing" rc-detrend --outliers 10 spikes.rcg -o clean.rcg
near "$(figure missing clean.rcg)" 12 "$same" "  the twelve that there are"
near "$(figure outliers clean.rcg)" 12 "$same" "  the key counts them"
claim "  their number is added to the earlier one" bash -c 'rc-detrend --outliers 2.5 clean.rcg -o more.rcg'
near "$(figure outliers more.rcg)" "$(figure missing more.rcg)" "$same" "  all that were taken out"
claim "the steps act in the given order" bash -c '
    rc-detrend --outliers 10 --fill spikes.rcg -o a.rcg && rc-detrend --fill --outliers 10 spikes.rcg -o b.rcg &&
    says "\"missing\": 0," rc-info --json a.rcg && says "\"missing\": 12," rc-info --json b.rcg'
claim "many outliers cause a warning" warns '--outliers 0.5 removed [0-9.]+ % of the points \([0-9]+ of 1200\)' \
    rc-detrend --outliers 0.5 spikes.rcg -o c.rcg
# a scratch of two columns, 3 um deep, and twelve single points of 3 um: 60 and 12 of 1200 points
map 40 30 'sin(x / 9) + 0.01 * sin(k * k) - (k % 40 == 20 || k % 40 == 21 ? 3 : 0) + (k % 100 == 50 ? 3 : 0)' scratch.rcg
claim "spikes become missing, and a scratch as deep stays" rc-detrend --spikes 10 scratch.rcg -o clean.rcg
near "$(figure missing clean.rcg)" 12 "$same" "  the twelve points"
near "$(figure spikes clean.rcg)" 12 "$same" "  the key counts them"
near "$(figure minimum clean.rcg)" "$(figure minimum scratch.rcg)" "$same" "  the bottom of the scratch is what it was"
claim "  one line has their share" warns '--spikes 10 removed 1 % of the points \(12 of 1200\)$' \
    rc-detrend --verbose --spikes 10 scratch.rcg -o c.rcg
claim "  and is not printed in a script" bash -c 'rc-detrend --spikes 10 scratch.rcg -o c.rcg 2>err && [ ! -s err ]'
rc-detrend --quiet --outliers 10 scratch.rcg -o c.rcg
between 60 "$(figure outliers c.rcg)" 1200 "  --outliers takes the scratch too"
claim "many spikes cause a warning" warns '--spikes 0.1 removed [0-9.]+ % of the points .*: raise the threshold$' \
    rc-detrend --spikes 0.1 scratch.rcg -o c.rcg
claim "a mirror counts spikes four times, and a part of a map has none" bash -c '
    rc-detrend --spikes 10 --mirror --quiet scratch.rcg -o c.rcg && says "spikes=48" rc-info c.rcg &&
    rc-pick --quiet --crop 0,0,9,9 c.rcg | rc-info >c.out && ! grep -q "spikes=" c.out'
claim "a taper makes a surface periodic" bash -c '
    rc-detrend --plane --taper 5um spikes.rcg -o a.rcg && says "\"periodic\": \"yes\"" rc-info --json a.rcg'
# the taper covers, of 40 x 30 nodes 1.1 um x 1 um, 5 columns (4.5 * 1.1 um is below 5 um) and 5 rows on each
# side: 600 of 1200
rc-detrend --plane spikes.rcg -o level.rcg
claim "  a message has the share of the map, and a warning follows if it is 0" \
    warns 'the taper covers 50 % of the map, and Sq goes from .*--mirror makes a periodic map' rc-detrend --taper 5um level.rcg -o a.rcg
claim "  the printed Sq before and after are those of the maps" bash -c '
    [ "$(sed -n "s/.*Sq goes from \(.*\) to \(.*\): near.*/\1, \2/p" warns.err)" = \
        "$(for f in level a; do rc-info --areal $f.rcg | sed -n "s/^  Sq  *//p"; done | paste -sd, | sed "s/,/, /")" ]'
near "$(figure taper a.rcg)" 5e-6 "$rounding" "  the key taper has its width"
claim "  the widest of several tapers is the key" bash -c 'rc-detrend --quiet --taper 3um a.rcg | rc-info | grep -q "taper=5e-06"'
claim "  a part of a tapered map is not tapered" bash -c 'rc-pick --quiet --crop 0,0,20,20 a.rcg | rc-info >b.out && ! grep -q "taper=" b.out'

# beside A B: writes the frames of both as one case
beside() { perl -0777 -ne 's/RCGEND 1\n\z//; print; END { print "RCGEND 2\n" }' "$1" "$2"; }
export -f beside
claim "a mirror makes a surface periodic" bash -c '
    rc-detrend --plane --mirror spikes.rcg -o m.rcg && says "\"periodic\": \"yes\"" rc-info --json m.rcg'
claim "  the map has twice the columns and rows" says '"nx": 80, "ny": 60, "dx": 1.1e-06, "dy": 1e-06,' rc-info --json m.rcg
claim "  Sq does not change" test "$(rc-info --areal m.rcg | grep "^  Sq ")" = "$(rc-info --areal level.rcg | grep "^  Sq ")"
claim "  there is no message" bash -c 'rc-detrend --mirror level.rcg -o m.rcg 2>err && [ ! -s err ]'
claim "  the original map is the upper left quarter" bash -c '
    for f in m level; do rc-pick --quiet --crop 0,0,40,30 $f.rcg | rc-export --format csv | grep -v "^#" >$f.csv; done; cmp m.csv level.csv'
claim "  filled points count four times" test \
    "$(rc-detrend --outliers 10 --fill --mirror spikes.rcg -o b.rcg; figure filled b.rcg) $(figure outliers b.rcg)" = "48 48"
claim "  a profile is mirrored at two ends" says '"nx": 80, "ny": 1,' bash -c 'rc-pick --crop 0,0,40,1 level.rcg | rc-detrend --mirror | rc-info --json'
claim "  a map of hardness is mirrored too, without a message" bash -c '
    rc-pick --set channel=hardness --set unit=Pa level.rcg -o hard.rcg
    beside level.rcg hard.rcg >both.rcg
    rc-detrend --plane --mirror both.rcg -o b.rcg && rc-info --json b.rcg >b.json && grep -c "\"nx\": 80, \"ny\": 60" b.json | grep -qx 2 &&
    grep "\"hardness\"" b.json | grep -q "rc-detrend [0-9.]* --mirror\"" && rc-pick --channel hardness b.rcg | rc-export --format csv | grep -v "^#" >b.csv &&
    rc-export --format csv m.rcg | grep -v "^#" >m.csv && cmp b.csv m.csv'
refuses 1 'case 1.*--mirror has no effect, because the map is already periodic: leave it out' "a mirror of what repeats" "rc-detrend --mirror m.rcg"
refuses 1 '--mirror has no effect, because the map is already periodic' "two mirrors" "rc-detrend --mirror --mirror level.rcg"
rc-pick --crop 0,0,1,1 level.rcg -o node.rcg
refuses 1 '--mirror: a single node is not a map' "a mirror of one node" "rc-detrend --mirror node.rcg"
rc-pick --set channel=psd level.rcg | rc-pick --set dunit=rad/m - -o wave.rcg
beside level.rcg wave.rcg >waved.rcg
refuses 1 '--mirror: the frame is not a map of places: leave it out' "a mirror of a spectrum" "rc-detrend --mirror waved.rcg"
claim "the history has all steps in SI" \
    says 'rc-detrend [0-9.]* --outliers 3.5 --sphere --lowpass 9e-06 --fill --taper 5e-06 --robust"' bash -c '
    rc-detrend --robust --outliers 3.5 --sphere --lowpass 9um --fill --taper 5um spikes.rcg | rc-info --json'
claim "without its sphere a periodic surface is not periodic" warns 'it gets periodic=no' \
    rc-detrend --sphere rough.rcg -o a.rcg
claim "  with a taper it is periodic again" says '"periodic": "yes"' bash -c 'rc-detrend --taper 9um a.rcg | rc-info --json'

# ---- refusals ----

refuses 1 'a cut-off of 1e-06 m is below two nodes, 2.2e-06 m' "a cut-off below two nodes" "rc-detrend --lowpass 1um ball.rcg"
refuses 1 'a cut-off of 0.001 m is longer than the map, 4.7e-05 m: take a shorter one, or subtract a form$' "one longer than the map" \
    "rc-detrend --highpass 1mm ball.rcg"
refuses 1 'longer than the map, 4.7e-05 m: .*: a number without a unit is in metres, write 20um for micrometres$' \
    "  without its unit, before its filter takes memory" "rc-detrend --memory 32M --lowpass 20 ball.rcg"
refuses 2 '--lowpass 0 m: it must be above 0' "none at all" "rc-detrend --lowpass 0 ball.rcg"
refuses 1 'a taper of 3e-05 m is wider than half the map, 1.815e-05 m' "a taper over half the map" "rc-detrend --taper 30um ball.rcg"
refuses 2 '--spikes 0: it must be above 0' "no deviations of spikes" "rc-detrend --spikes 0 ball.rcg"
refuses 2 '--outliers -1: it must be above 0' "no deviations" "rc-detrend --outliers -1 ball.rcg"
printf '1 NaN\n2 3\n' | rc-import --quiet --dx 1um --z-unit nm - -o few.rcg
refuses 1 'a sphere has 4 unknowns, and only 3 points are there: subtract a plane' "a sphere through three points" "rc-detrend --sphere few.rcg"
map 9 9 '2 * x - y' plane.rcg
refuses 1 'do not determine a cylinder: .* no curvature' "a cylinder in a plane" "rc-detrend --cylinder plane.rcg"
refuses 2 '--robust .*--plane.*--lowpass' "--robust with nothing to fit" "rc-detrend --robust --fill few.rcg"
refuses 1 '33 x 47 nodes need about .*, --memory allows' "more memory than is allowed" "rc-detrend --memory 20k --lowpass 9um ball.rcg"
