# SPDX-License-Identifier: GPL-3.0-or-later
# The figures of rc-solve for a case: --verbose prints the main figures of the report. Nodes that yield under
# this load differ from nodes at the hardness. The mean gap is that between the bodies; the requested value is
# in the report beside the result.
. "$(dirname "$0")/../pipe.sh"

# ---- --verbose ----

rc-synth selfaffine --nx 96 --ny 80 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 40um --short-cut 6um --seed 5 -o s.rcg
rc-solve --verbose --periodic --estar 3GPa --hardness 200MPa --load 20mN,40mN --output pressure --report r.json s.rcg -o p.rcg 2>err
claim "each case has a line" test "$(grep -c '^rc-solve: selfaffine-seed-5, case [12], load' err)" = 2
for case in 1 2; do
    grep "case $case, load" err >line.txt
    sed -n ${case}p r.json >case.json
    word() { sed -n "s/.*$1 \([0-9.]*\) $2.*/\1/p" line.txt; }
    near "$(word force mN)e-3" "$(field load case.json)" "$six_digits" "case $case: force"
    near "$(word 'contact area' um2)e-12" "$(field contact_area case.json)" "$six_digits" "  contact area"
    near "$(word 'mean gap' nm)e-9" "$(field mean_gap case.json)" "$six_digits" "  mean gap"
    near "$(word approach nm)e-9" "$(field approach case.json)" "$six_digits" "  approach"
    near "$(word 'largest pressure' MPa)e6" "$(field max_pressure case.json)" "$six_digits" "  largest pressure"
    near "$(sed -n 's/.* nodes in \([0-9]*\) patches).*/\1/p' line.txt)" "$(field count case.json)" "$same" "  patches"
    near "$(sed -n 's/.*), \([0-9.]*\) um2 of it yields.*/\1/p' line.txt)e-12" "$(field yielded_area case.json)" "$six_digits" "  what yields"
done
rc-info --patches --json p.rcg >info.json
sed -n 2p info.json | sed "s/.*\"patches\"/\"patches\"/" >second.json
near "$(field count case.json)" "$(field count second.json)" "$same" "rc-info --patches counts the same patches"
near "$(field contact_area_corrected case.json)" "$(field contact_area_corrected second.json)" "$rounding" "  and has the same corrected area"
near "$(grep -o '"largest_areas": \[[^],]*' case.json | sed 's/.*\[//')" "$(field largest_area second.json)" "$rounding" "  and the same largest patch"
claim "without --verbose there is no output" bash -c '
    rc-solve --periodic --estar 3GPa --hardness 200MPa --load 40mN --output pressure s.rcg -o p.rcg 2>err && ! grep -q force err'

# ---- nodes that yield or reach the hardness; the mean gap ----

rc-synth selfaffine --nx 120 --ny 110 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 40um --short-cut 4um --seed 7 -o s.rcg
press() { rc-solve --quiet --periodic --load 50mN --estar 3GPa --hardness 100MPa --output gap,pressure,plastic --report "$1" "${@:2}"; }
export -f press
press first.json s.rcg -o first.rcg
between 1e-12 "$(field yielded_area first.json)" "$(field plastic_area first.json)" "some of what is at the hardness yields"
# half the sum of the pressure times its displacement by rc-deflect
near "$(field elastic_energy first.json)" "$(energy_of first.rcg 1e-12 --periodic)" 1e-5 "the elastic energy, with nodes at the hardness"
# the mean of max(gap, 0), from the gaps themselves
mean=$(rc-export --channel gap --format csv first.rcg | tr ',;\t' '\n\n\n' |
    awk '/^ *-?[0-9]/ { n++; if ($1 > 0) sum += $1 } END { printf "%.17g\n", sum / n }')
near "$(field mean_gap first.json)" "$mean" "$summed" "mean_gap is the mean of max(gap, 0)"

# pressed again: the plastic shape, under the name of a height
rc-export --channel plastic --format npy first.rcg -o shape.npy
rc-import shape.npy --dx 1um --z-unit m -o bare.rcg
claim "the plastic shape has a key with its error" says 'height\.error=[0-9.e-]+$' rc-info first.rcg
error=$(rc-info first.rcg | sed -n 's/.*height\.error=//p' | tail -n 1)
sed "s/^unit=m\$/unit=m\nheight.error=$error/" bare.rcg | reseal >again.rcg
press second.json again.rcg -o second.rcg
near "$(field max_pressure second.json)" 1e8 "$same" "pressed again it is at the hardness"
between 1e-12 "$(field plastic_area second.json)" 1e-8 "  in places"
near "$(field yielded_area second.json)" 0 0 "  and yields nowhere"
near "$(field contact_area second.json)" "$(field contact_area first.json)" 0.01 "  on the same contact"

# ---- the figures requested ----

for seed in 1 2 3; do rc-synth selfaffine --nx 40 --ny 32 --dx 1um --hurst 0.8 --rms-slope 0.1 --seed $seed; done |
    rc-solve --quiet --mean-pressure 1.1MPa,0.3GPa --E1 71.7GPa --nu1 0.33 --E2 210GPa --nu2 0.28 --hardness 1.9GPa --tol 3e-4 --report t.tsv -o /dev/null
column() { awk -F '\t' -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) { split($i, word, "/"); if (word[1] == name) c = i } next } { print $c }' t.tsv; }
claim "a requested mean pressure is the same number in every case" test "$(column asked_mean_pressure | sort -u | tr '\n' ' ')" = "1100000 300000000 "
claim "  that of the result may differ by rounding" test "$(column mean_pressure | sort -u | wc -l)" -ge 2
claim "  no load was requested" test "$(column asked_load | sort -u)" = NaN
near "$(column estar | head -n 1)" "$(awk 'BEGIN { printf "%.17g", 1 / ((1 - 0.33 ^ 2) / 71.7e9 + (1 - 0.28 ^ 2) / 210e9) }')" "$rounding" "E* follows from the bodies"
claim "bodies, hardness and tolerance are as given" test "$(for c in e1 nu1 e2 nu2 hardness tol; do column $c | sort -u; done | tr '\n' ' ')" = \
    "71700000000 0.33 210000000000 0.28 1900000000 0.0003 "
claim "the source is the shape and its seed" test "$(column source | sort -u | tr '\n' ' ')" = "selfaffine-seed-1 selfaffine-seed-2 selfaffine-seed-3 "
rc-synth sphere --nx 24 --dx 10um --radius 5mm | rc-solve --quiet --load 1N --E1 200GPa --nu1 0.3 --E2 rigid --layer 2um,400GPa,0.2 --layer 1um,100GPa,0.3 --report layered.json -o /dev/null
claim "layers are reported, and their bodies have no E*" says '"estar": null, "e1": 200000000000, "nu1": 0.3, "e2": null, "nu2": null, "hardness": null, "radius": null, "layers": "2e-06,400000000000,0.2; 1e-06,100000000000,0.3"' cat layered.json
# ---- contact inside of a taper ----

rc-synth selfaffine --nx 96 --ny 80 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 40um --short-cut 6um --seed 5 |
    rc-pick --set periodic=no | rc-detrend --quiet --taper 9.2um -o tapered.rcg
# nodes whose centres are less than 9.2 um from an edge: 9 columns and 9 rows on each side; 78 x 62 nodes
# remain
for load in 20mN 600mN; do
    rc-solve --quiet --periodic --estar 3GPa --load $load --output pressure --report r.json tapered.rcg -o p.rcg
    inside=$(rc-pick --quiet --crop 9,9,78,62 p.rcg | rc-info --json | sed -n 's/.*"contact_nodes": \([0-9]*\).*/\1/p')
    near "$(field contact_area_inside r.json)" "${inside}e-12" "$rounding" "contact inside a taper, $load: the nodes there"
    near "$(field contact_fraction_inside r.json)" "$(awk -v n="$inside" 'BEGIN { printf "%.17g", n / (78 * 62) }')" "$rounding" "  their share"
done
claim "  the tapered frame has a larger contact fraction at a large load" test "$(awk -v a="$(field contact_fraction r.json)" \
    -v b="$(field contact_fraction_inside r.json)" 'BEGIN { print (a > b) }')" = 1
claim "  without a taper it is null" grep -q '"contact_area_inside": null, "contact_fraction_inside": null' case.json
rc-solve --quiet --periodic --estar 3GPa --load 1kN --output pressure --report r.json tapered.rcg -o p.rcg
near "$(field contact_fraction_inside r.json)" 1 "$rounding" "  all of it when pressed flat"
claim "  the table has these columns at its end" bash -c '
    rc-solve --quiet --periodic --estar 3GPa --load 20mN,0 --history --output pressure --report r.tsv tapered.rcg -o p.rcg &&
    head -1 r.tsv | grep -qP "\tcontact_area_inside/m2\tcontact_fraction_inside\t" && [ "$(tail -1 r.tsv | cut -f "$(head -1 r.tsv | tr "\t" "\n" | grep -n contact_area_inside | cut -d: -f1)")" = 0 ]'

# ---- a period made by mirror images ----

# Half a wave from crest to trough, mirrored, is the whole wave. Its contact under a mean pressure is
# Westergaard's (Johnson 1985, 13.7): 2/pi asin(sqrt(p/p*)) of the period, p* = pi E* A/lambda = 3.14 MPa.
rc-synth wave --nx 512 --ny 4 --dx 1um --wavelength 512um --amplitude 0.512um -o whole.rcg
rc-export --format csv whole.rcg | grep -v '^#' | cut -d, -f1-256 | tr ',' ' ' | rc-import --quiet --dx 1um --z-unit m - -o first.rcg
rc-export --format csv whole.rcg | grep -v '^#' | cut -d, -f257-512 | tr ',' ' ' | rc-import --quiet --dx 1um --z-unit m - -o second.rcg
for half in first second; do
    rc-detrend --mirror $half.rcg | rc-solve --quiet --periodic --estar 1GPa --mean-pressure 785398.16339744830 --tol 1e-6 --output pressure --report r.json -o p.rcg
    near "$(field contact_fraction r.json)" 0.33333333 0.012 "the $half half of a wave mirrored: a third is in contact at a quarter of p*"
    # p_max = 2 sqrt(p p*)
    near "$(field max_pressure r.json)" 3.1415926535897932e6 1e-3 "  the largest pressure is Westergaard's"
done

# ---- the radius of a round contact ----

# a node map from awk: f is an expression of x and y in nodes
nodes() { # SIZE EXPRESSION
    awk -v n="$1" "BEGIN { t = 8 * atan2(1, 1) / n; for (y = 0; y < n; y++) { for (x = 0; x < n; x++) printf \"%.12g \", $2; print \"\" } }" |
        rc-import --quiet --format ascii --dx 1um --z-unit um -
}
radius_of() { rc-solve --quiet --estar 100GPa --report radius.json "$@" -o radius.rcg && field contact_radius radius.json; }
for n in 64 65 128 200; do
    for load in 0.03 0.1 0.5; do
        found=$(rc-synth sphere --nx $n --dx "$(awk "BEGIN { print 200 / $n }")um" --radius 10mm | radius_of --load $load)
        hertz=$(awk "BEGIN { printf \"%.9g\", (0.75 * $load * 10e-3 / 100e9) ^ (1 / 3) }")
        near "$found" "$hertz" "$(awk "BEGIN { print 0.15 * 200e-6 / $n / $hertz }")" "$n nodes, $load N: the contact radius is Hertz's to 0.15 spacings"
    done
done
unround() { radius_of "${@:2}" >/dev/null; claim "$1" grep -q '"contact_radius": null' radius.json; }
near "$(rc-synth paraboloid --nx 128 --dx 1.5um --radius 10mm,12mm | radius_of --load 0.1)" \
    "$(awk 'BEGIN { printf "%.9g", (0.75 * 0.1 * sqrt(120e-6) / 100e9) ^ (1 / 3) }')" 0.01 "a slightly long contact has the radius of its area"
unround "an ellipse has no radius" --load 0.1 <(rc-synth paraboloid --nx 128 --dx 1.5um --radius 10mm,20mm)
unround "  turned by 45 degrees too" --load 0.1 <(rc-synth paraboloid --nx 128 --dx 1.5um --radius 10mm,20mm --direction 45)
unround "a line has none" --periodic=y --load 0.1 <(rc-synth cylinder --nx 128 --dx 1.5um --radius 10mm)
unround "a profile has none" --load 0.001 <(rc-synth sphere --nx 128 --ny 1 --dx 1.5um --radius 10mm)
unround "a ring has none" --load 0.1 <(nodes 64 '-0.001 * (sqrt((x - 32) ^ 2 + (y - 32) ^ 2) - 15) ^ 2')
unround "two patches have none" --periodic --mean-pressure 200MPa <(nodes 64 '-cos(2 * t * x) + cos(t * y)')
middle=$(radius_of --periodic --mean-pressure 200MPa <(nodes 64 'cos(t * (x - 32)) + cos(t * (y - 32))'))
claim "one crest of a periodic map has one" test "${middle:-null}" != null
near "$(radius_of --periodic --mean-pressure 200MPa <(nodes 64 'cos(t * x) + cos(t * (y - 3))'))" "$middle" 1e-9 "  across the seams it has the same"
