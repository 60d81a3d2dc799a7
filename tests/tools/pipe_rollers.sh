# SPDX-License-Identifier: GPL-3.0-or-later
# Line contact in a pipe, on maps that repeat along one axis: rc-solve --cylinder, rc-slip, rolling with rc-solve --travel,
# and rc-wear, against closed forms of the roller. Paths, histories and checkpoints; turned maps; datum; forecasts; refusals.
. "$(dirname "$0")/../pipe.sh"

column() { # NAME FILE [ROW]
    awk -F '\t' -v n="$1" -v r="${3:-1}" 'NR == 1 { for (i = 1; i <= NF; i++) { split($i, h, "/"); if (h[1] == n) c = i } } NR == r + 1 { print $c }' "$2"
}
number() { awk "BEGIN { printf \"%.12g\", ($1) }"; }
values() { rc-pick --quiet --channel "$2" --case "${3:-1}" "$1" | rc-export --format csv | grep -v '^#' | tr ',' '\n'; }
apart() { # FILE FILE CHANNEL [CASE [CASE]]: prints the relative L1 distance
    paste -d ' ' <(values "$1" "$3" "${4:-1}") <(values "$2" "$3" "${5:-${4:-1}}") | awk '{ d = $1 - $2; s += d < 0 ? -d : d; t += $2 < 0 ? -$2 : $2 } END { print s / t }'
}

# A roller of 10 mm, 50 kN/m, steel on steel: E* = 115.385 GPa, a = 74.3 um, mu = 0.3. The map is 8 um long along y.
steel="--E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3"
rc-synth cylinder --radius 1000km --nx 128 --ny 4 --dx 1.5um --dy 2um --direction 90 | rc-pick --set periodic=y --set form= -o flat.rcg
rc-pick --rotate 90 flat.rcg | rc-pick --set periodic=x -o turned.rcg
press="rc-solve --quiet --cylinder 10mm --load 50kN/m --tol 1e-8 $steel"
$press --periodic=y -o line.rcg flat.rcg
$press --periodic=x -o turned-line.rcg turned.rcg
# approach(P) = P/(pi E*) (2 ln(2 datum/a) + 1), a^2 = 4 P R/(pi E*); the bodies move by mu (approach(P) - approach(P - Q/mu))
moved() { # Q/(mu P) DATUM
    awk -v part="$1" -v datum="$2" 'function approach(p) { return p / (pi * e) * (2 * log(2 * datum / sqrt(4 * p * 0.01 / (pi * e))) + 1) }
        BEGIN { pi = atan2(0, -1); e = 210e9 / 0.91 / 2; print 0.3 * (approach(5e4) - approach(5e4 * (1 - part))) }'
}

# ---- stick and slip ----

rc-slip --mu 0.3 --tangential 0.06N --tol 1e-6 --report x.tsv -o x.rcg line.rcg
near "$(column datum x.tsv)" 1.92e-4 "$converted" "the datum of the displacement is the length of the map"
near "$(column displacement_x x.tsv)" "$(moved 0.5 1.92e-4)" 1e-3 "half of the limit across a roller moves it as Cattaneo and Mindlin say"
near "$(column stick_fraction x.tsv)" "$(number 'sqrt(0.5)')" 0.02 "  and sticks over c/a = sqrt(1 - Q/(mu P))"
rc-slip --mu 0.3 --tangential 0,0.06N --tol 1e-6 --report y.tsv -o y.rcg line.rcg
near "$(column displacement_y y.tsv)" "$(number "$(moved 0.5 1.92e-4) / 0.7")" 1e-3 "along it, in antiplane shear, 1/(1 - nu) times as far"
between 0 "$(paste -d ' ' <(values x.rcg traction-x) <(values y.rcg traction-y) | awk '{ d = $1 - $2; s += d < 0 ? -d : d; t += $2 } END { print s / t }')" 1e-4 \
    "  under the same tractions"
rc-slip --mu 0.3 --tangential 0,0.06N --tol 1e-6 --report tx.tsv -o tx.rcg turned-line.rcg
near "$(column displacement_y tx.tsv)" "$(column displacement_x x.tsv)" 1e-6 "a turned roller moves as far"
between 0 "$(paste -d ' ' <(values tx.rcg traction-y | sort -g) <(values x.rcg traction-x | sort -g) | awk '{ d = $1 - $2; s += d < 0 ? -d : d; t += $2 } END { print s / t }')" 1e-6 \
    "  under the same tractions"
$press --periodic=y --datum 10mm -o far.rcg flat.rcg
rc-slip --mu 0.3 --tangential 0.06N --tol 1e-6 --report far.tsv -o far-x.rcg far.rcg
near "$(column displacement_x far.tsv)" "$(moved 0.5 1e-2)" 1e-3 "a datum of 10 mm moves it farther"
between 0 "$(apart far-x.rcg x.rcg traction-x)" 1e-6 "  under the same tractions"
claim "  its frames have the datum" says 'boundary=periodic-y.*datum=0.01' bash -c "rc-info far-x.rcg | tr '\\n' ' '"
rc-slip --mu 0.3 --displacement "$(column displacement_x far.tsv)" --tol 1e-6 --report back.tsv -o back.rcg far.rcg
near "$(column tangential_x back.tsv)" 0.06 1e-4 "  and its displacement gives the force"
$press --periodic=y --datum 20um -o near.rcg flat.rcg
refuses 1 'datum 2e-05 m, in a contact 0.00015 m wide: where the displacement is given' "a displacement with a datum in the contact" \
    'rc-slip --mu 0.3 --displacement 1nm -o q.rcg near.rcg'
refuses 1 'its boundary is periodic-y, which contradicts --periodic=x' "another axis" 'rc-slip --mu 0.3 --periodic=x --tangential 0.06N -o q.rcg line.rcg'

# ---- paths ----

path='0.4N,0,0; 0.4N,0.07N,0; 0.25N,-0.02N,0; 0.4N,0.03N,0.06N'
rc-slip --mu 0.3 --path "$path" --report path.tsv --checkpoint path.ck -o path.rcg line.rcg
rc-slip --mu 0.3 --path "$path" --increments 96 --quiet --report many.tsv -o many.rcg line.rcg
for row in 2 3 4; do
    off=$(paste -d ' ' <(values path.rcg traction-x $row) <(values many.rcg traction-x $row) <(values path.rcg traction-y $row) <(values many.rcg traction-y $row) |
        awk '{ s += sqrt(($1 - $2) ^ 2 + ($3 - $4) ^ 2); t += sqrt($2 ^ 2 + $4 ^ 2) } END { print s / t }')
    between 0 "$off" "$(column traction_error_estimate path.tsv $row)" "corner $row of a path is within its estimate"
done
printf 'load fx fy\n0.4 0 0\n0.4 0.07 0\n0.25 -0.02 0\n0.4 0.03 0.06\n' >path.txt
rc-slip --mu 0.3 --history path.txt --report history.tsv -o history.rcg line.rcg
claim "--history is the same path" cmp <(cut -f 1-38 path.tsv) <(cut -f 1-38 history.tsv)
claim "a complete run is resumed to its bits" bash -c "rc-slip --mu 0.3 --path '$path' --checkpoint path.ck --resume -o again.rcg line.rcg && cmp path.rcg again.rcg"
head -c $(($(stat -c %s path.ck) / 2)) path.ck >torn.ck
claim "  and half of it" bash -c "rc-slip --mu 0.3 --path '$path' --checkpoint torn.ck --resume -o again.rcg line.rcg && cmp path.rcg again.rcg"
refuses 1 'belongs to another problem: key datum was 0.000192, is 0.01' "a checkpoint of another datum" \
    "rc-slip --mu 0.3 --path '$path' --checkpoint path.ck --resume -o q.rcg far.rcg"

# ---- dissimilar bodies: K(c/a)/K'(c/a) = mu/beta under a load alone (Spence 1975) ----

other="--E1 210GPa --nu1 0.3 --E2 rigid"
for c in y:flat x:turned; do
    rc-solve --quiet --cylinder 10mm --load 50kN/m --tol 1e-6 $other --periodic=${c%:*} -o other-${c%:*}.rcg ${c#*:}.rcg
    rc-slip --mu 0.2 --tangential 0 --coupling goodman --increments 64 --quiet --report spence-${c%:*}.tsv -o q.rcg other-${c%:*}.rcg
    rc-slip --mu 0.2 --tangential 0 --quiet --report full-${c%:*}.tsv -o full-${c%:*}.rcg other-${c%:*}.rcg
done
near "$(column stick_fraction spence-y.tsv)" 0.406 0.04 "rollers that differ stick in Spence's zone under a load alone"
near "$(column stick_fraction spence-x.tsv)" "$(column stick_fraction spence-y.tsv)" "$same" "  the turned ones, too"
claim "  with full coupling both ways agree" test "$(column stick_nodes full-x.tsv) $(column converged full-x.tsv)" = "$(column stick_nodes full-y.tsv) $(column converged full-y.tsv)"

# ---- rolling: Carter's roller, with a creepage of 1e-3 F/(mu P) = 1 - c^2/a^2, c = a - 1e-3 R/mu ----

carter=$(awk 'BEGIN { a = sqrt(4 * 5e4 * 0.01 / (atan2(0, -1) * 210e9 / 0.91 / 2)); c = a - 1e-3 * 0.01 / 0.3; print 1 - (c / a) ^ 2 }')
rc-slip --mu 0.3 --creep 1e-3,0 --steady --report carter.tsv -o carter.rcg line.rcg
near "$(number "$(column extrapolated_tangential_x carter.tsv) / $(column limit carter.tsv)")" "$carter" 5e-3 "a roller rolls with Carter's force"
claim "  it has no moment and no ellipse" test "$(column moment carter.tsv) $(column kalker_tangential_x carter.tsv)" = "NaN NaN"
refuses 1 'where the spin of a map that repeats jumps' "its spin" 'rc-slip --mu 0.3 --creep 1e-3,0,5 --steady -o q.rcg line.rcg'
refuses 1 'periodic along x has no leading edge' "steady rolling along a roller" 'rc-slip --mu 0.3 --creep 1e-3,0 --steady -o q.rcg turned-line.rcg'
rc-synth cylinder --radius 1000km --nx 400 --ny 4 --dx 3um --dy 2um --direction 90 | rc-pick --set periodic=y --set form= -o track.rcg
way="rc-solve --quiet --cylinder 10mm --load 50kN/m $steel --periodic=y --datum 1mm --tol 1e-6 --travel=-240um:240um:161"
$way --window 80x4 track.rcg | rc-slip --mu 0.3 --creep 1e-3,0 --quiet --report window.tsv -o q.rcg
$way track.rcg | rc-slip --mu 0.3 --creep 1e-3,0 --quiet --report whole.tsv -o q.rcg
near "$(number "$(column tangential_x window.tsv 161) / $(column limit window.tsv 161)")" "$carter" 0.05 "a path in a window leads to the same force"
near "$(column tangential_x whole.tsv 161)" "$(column tangential_x window.tsv 161)" 1e-3 "  as on the whole map"

# ---- wear: the section of a rigid roller, 2 a = (12 R k P s)^(1/3) ----

rc-synth cylinder --radius 10mm --nx 200 --ny 2 --dx 5um --direction 90 -o roller.rcg
rc-solve --quiet --periodic=y --load 50kN/m --estar 114GPa -o pressed.rcg roller.rcg
wear="rc-wear --coefficient 1e-6mm3/Nm --quiet"
$wear --distance 10m,100m --report worn.tsv -o worn.rcg pressed.rcg
near "$(column wear_volume worn.tsv 2)" "$(number '1e-15 * 5e4 * 1e-5 * 1e2')" 1e-9 "a worn roller loses k P s"
near "$(number "$(column contact_area worn.tsv 2) / 1e-5")" "$(number '(12 * 0.01 * 1e-15 * 5e4 * 1e2) ^ (1 / 3)')" 0.02 "  its scar has the width of a rigid section"
near "$(column max_pressure worn.tsv 2)" "$(number "0.5 / $(column contact_area worn.tsv 2)")" 0.05 "  under an even pressure"
near "$(column datum worn.tsv)" 1e-3 "$converted" "  its approach has a datum"
claim "  which its frames have, too" says 'boundary=periodic-y.*datum=0.001' bash -c "rc-info worn.rcg | tr '\\n' ' '"
claim "a worn roller wears on" bash -c "rc-pick --case 1 worn.rcg | $wear --distance 90m --report rest.tsv -o rest.rcg"
near "$(column contact_area rest.tsv)" "$(column contact_area worn.tsv 2)" 0.01 "  to the scar of one run"
claim "a checkpoint of it is kept" bash -c "$wear --distance 10m,100m --checkpoint worn.ck -o again.rcg pressed.rcg && cmp worn.rcg again.rcg"
head -c $(($(stat -c %s worn.ck) / 2)) worn.ck >torn.ck
claim "  half of it leads to the same bits" bash -c "$wear --distance 10m,100m --checkpoint torn.ck --resume -o again.rcg pressed.rcg && cmp worn.rcg again.rcg"
$wear --distance 10km --until area=0.5 --report until.tsv -o q.rcg pressed.rcg
between 0.5 "$(column contact_fraction until.tsv)" 0.6 "it ends early at a part of the map in contact"
rc-synth selfaffine --nx 32 --ny 24 --dx 1um --hurst 0.8 --rms-slope 0.05 --short-cut 8um --seed 4 -o rough.rcg
rc-synth selfaffine --nx 32 --ny 20 --dx 1um --hurst 0.8 --rms-slope 0.05 --short-cut 8um --seed 5 -o fewer.rcg
rc-solve --quiet --periodic=x --load 1N/m --estar 1GPa -o sliding.rcg rough.rcg
slide='rc-wear --quiet --coefficient 1e-6mm3/Nm,1e-6mm3/Nm --motion sliding --distance 1m --tol 0.3'
claim "rough bodies slide along the axis that repeats" $slide --counter rough.rcg -o q.rcg sliding.rcg
refuses 1 'both surfaces must have the same period: this one has 32 x 24 nodes' "  not on a smaller map" "$slide --counter fewer.rcg -o q.rcg sliding.rcg"
rc-solve --quiet --periodic=y --load 1N/m --estar 1GPa -o across.rcg rough.rcg
refuses 1 'needs a map that is periodic along x' "  nor across it" "$slide --counter rough.rcg -o q.rcg across.rcg"

# ---- forecasts: within a factor of 2 ----

figures=convolutions:convolutions
with_address_sanitizer || figures="$figures memory:peak_memory"
for c in "rc-slip --mu 0.3 --tangential 0.06N line.rcg" "rc-slip --mu 0.3 --creep 1e-3,0 --steady line.rcg" "$wear --distance 100m pressed.rcg"; do
    $c --quiet --dry-run --report plan.json >plan.txt
    $c --quiet --report run.json -o q.rcg
    for f in $figures; do
        between "$(number "$(field "${f#*:}" run.json) / 2")" "$(field "expected_${f%:*}" plan.json)" "$(number "2 * $(field "${f#*:}" run.json)")" "${f%:*} of ${c%% *} ${c##*--}"
    done
done
