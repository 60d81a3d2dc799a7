# SPDX-License-Identifier: GPL-3.0-or-later
# rc-solve --yield: the elastic solution, to the byte, if nothing yields; loads in sequence; frames, tables of
# hardening; warnings and refusals.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-height 0.15um --rolloff 32um --short-cut 10um --seed 4 -o rough.rcg
elastic="rc-solve --quiet --periodic --E1 210GPa --nu1 0.3 --E2 rigid"
column() { # NAME ROW
    awk -F '\t' -v n="$1" -v r="$2" 'NR == 1 { for (i = 1; i <= NF; i++) { split($i, h, "/"); if (h[1] == n) c = i } } NR == r + 1 { print $c }' "$3"
}

# ---- nothing yields ----

$elastic --mean-pressure 20MPa --report elastic.json rough.rcg -o elastic.rcg
$elastic --mean-pressure 20MPa --yield 100GPa --output pressure,gap,displacement,height --report none.json rough.rcg -o none.rcg
values() { rc-pick --channel "$2" --case 1 "$1" | rc-export --format csv; }
claim "far below yield the pressure is that of elastic bodies, byte for byte" cmp <(values elastic.rcg pressure) <(values none.rcg pressure)
claim "  the gap too" cmp <(values elastic.rcg gap) <(values none.rcg gap)
claim "  the report has the reason" grep -q '"yield": "left out: the largest Mises stress is [0-9.]* of the yield stress' none.json
near "$(field convolutions none.json)" "$(field convolutions elastic.json)" "$same" "  and it costs no convolution of the contact"
claim "without --yield its figures are null" bash -c '
    grep -q "\"yield\": \"left out: no --yield\"" elastic.json && grep -q "\"yield\": null, \"hardening\": null, \"increments\": null" elastic.json'
# rc-stress gives the same stress
near "$(awk -v m="$(field max_mises_over_yield none.json)" 'BEGIN { print m * 1e11 }')" "$(rc-pick --channel pressure elastic.rcg |
    rc-stress --quiet --nu 0.3 --depths "$(field max_mises_depth none.json)" --components mises | rc-info |
    awk '/maximum/ { u["Pa"] = 1; u["kPa"] = 1e3; u["MPa"] = 1e6; u["GPa"] = 1e9; print $2 * u[$3] }')" 2e-3 "  its largest Mises stress is that of rc-stress"

# ---- a load, no load, and the same load again ----

$elastic --mean-pressure 150MPa,0,150MPa --yield 2GPa,10GPa --output pressure,gap,displacement,height,plastic,residual,strain --report r.tsv rough.rcg -o y.rcg
claim "there are three cases" test "$(wc -l <r.tsv)" = 4
between 1e-6 "$(column max_plastic_strain 1 r.tsv)" 0.1 "it yields"
near "$(column mean_pressure 1 r.tsv)" 150e6 1e-6 "  and carries the load"
between 0 "$(column pressure_error_estimate 1 r.tsv)" 0.01 "  to 1 %"
near "$(column max_plastic_strain 3 r.tsv)" "$(column max_plastic_strain 1 r.tsv)" 1e-2 "pressed again it yields no further"
near "$(column contact_area 3 r.tsv)" "$(column contact_area 1 r.tsv)" 1e-2 "  and touches where it did"
between 0 "$(column residual_indentation 2 r.tsv)" "$(column indentation 1 r.tsv)" "what remains is less than what was pressed in"
near "$(column indentation 2 r.tsv)" "$(column residual_indentation 2 r.tsv)" "$same" "  and all there is when the bodies are apart"
near "$(column residual_indentation 3 r.tsv)" "$(column residual_indentation 1 r.tsv)" 2e-2 "  the same after the second time"
# yielding pressures are lower, contacts wider
claim "the largest pressure is lower and the contact larger than for elastic bodies" bash -c "
    $elastic --mean-pressure 150MPa --report e.json rough.rcg -o e.rcg
    awk -v p=\"\$(grep -o '\"max_pressure\": [^,]*' e.json | sed 's/.* //')\" -v q=$(column max_pressure 1 r.tsv) 'BEGIN { exit !(q < p) }' &&
    awk -v a=\"\$(grep -o '\"contact_area\": [^,]*' e.json | head -n 1 | sed 's/.* //')\" -v b=$(column contact_area 1 r.tsv) 'BEGIN { exit !(b > a) }'"
claim "each case has six frames of results and six frames of each slab" bash -c "
    test \"\$(rc-info --json y.rcg | grep -o '\"channel\": \"peeq\"' | wc -l)\" = $((3 * $(column slabs 1 r.tsv)))"
paste -d , <(values y.rcg height | grep -v '^#' | head -n 64 | tr ',' '\n') <(values y.rcg residual | grep -v '^#' | head -n 64 | tr ',' '\n') \
    <(values y.rcg plastic | grep -v '^#' | head -n 64 | tr ',' '\n') >three.txt
claim "the shape after yield is the height minus the residual displacement" awk -F , \
    '{ d = $1 - $2 - $3; if (d < 0) d = -d; if (d > m) m = d; if ($2 > u) u = $2 } END { exit !(NR == 4096 && u > 0 && m < 1e-12 * u + 1e-20) }' three.txt

# ---- a roller: the map repeats along its axis ----

stack() { awk -v h="$1" -v n="$2" 'BEGIN { for (k = 0; k < n; k++) printf "%s%.6gum", k ? "," : "", h * 1.25 ^ k }'; } # FIRST COUNT: the same slabs for all maps
roller="rc-solve --quiet --slabs $(stack 5 15) --cylinder 10mm --E1 210GPa --nu1 0.3 --E2 rigid --yield 1GPa,2GPa --load 850kN/m"
for side in "96 1 y" "96 4 y" "4 96 x" "192 1 y"; do
    set -- $side
    rc-synth wave --amplitude 1fm --nx "$1" --ny "$2" --dx 10um --wavelength 1.92mm -o flat.rcg
    $roller --periodic="$3" --datum 10mm --increments 8 --output pressure,strain --report "roller$1.$2.tsv" -o "roller$1.$2.rcg" flat.rcg
done
between 1e-3 "$(column max_plastic_strain 1 roller96.1.tsv)" 0.01 "a roller yields at p0 = 2.5 Y"
near "$(column max_plastic_strain 1 roller96.4.tsv)" "$(column max_plastic_strain 1 roller96.1.tsv)" 1e-3 "  on rows as on one row"
near "$(column max_pressure 1 roller4.96.tsv)" "$(column max_pressure 1 roller96.4.tsv)" 1e-5 "  along the other axis too"
near "$(column approach 1 roller192.1.tsv)" "$(column approach 1 roller96.1.tsv)" 1e-3 "  and on a map of twice the width, to the same datum"
near "$(column plastic_work 1 roller192.1.tsv)" "$(column plastic_work 1 roller96.1.tsv)" 1e-2 "  with the same plastic work"
between 1e-5 "$(column image_error_estimate 1 roller96.4.tsv)" 1e-3 "the error of the images is below a thousandth"
largest() { rc-info | awk '/maximum/ { u["Pa"] = 1; u["kPa"] = 1e3; u["MPa"] = 1e6; u["GPa"] = 1e9; print $2 * u[$3] }'; }
between 0.9e9 "$(rc-stress --quiet --depths 154um --components mises roller96.4.rcg | largest)" \
    "$(awk -v e="$(column max_plastic_strain 1 roller96.4.tsv)" 'BEGIN { print 1.02 * (1e9 + 2e9 * e) }')" "rc-stress: with the plastic strain no stress is above the yield stress"

# ---- residual states between the loads of a history ----

# the error of the third load of this list is 6e-3; the reference has many increments and tight contacts
rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-height 0.2um --rolloff 64um --short-cut 16um --seed 4 -o again.rcg
again="$elastic --mean-pressure 100MPa,0,100MPa --yield 1.5GPa,5GPa --output pressure again.rcg"
$again --increments 256 --tol 1e-5 -o truth.rcg
refuses 3 '1.* come from its increments: give --increments' "errors above the goal: what lowers them" \
    "${again/--quiet/} --increments 8 --tol 5e-3 --report eight.json -o eight.rcg"
claim "--increments auto meets the goal at each load" $again --report auto.json -o auto.rcg
claim "--increments 16,half makes a second run" $again --increments 16,half --report half.json -o half.rcg
$again --increments 16 --report sixteen.json -o sixteen.rcg
refuses 2 'N,half needs an even number from 16' "a companion of few increments" "$again --increments 14,half -o x.rcg"
refuses 2 'travels has no second run' "one of a contact that travels" \
    "${again/100MPa,0,100MPa/100MPa} --increments 16,half --travel 0,1um --radius 1mm -o x.rcg"
apart() { # A B CASE: prints the relative L1 distance of two pressures
    paste <(rc-pick --case "$3" "$1" | rc-export --format csv | grep -v '^#' | tr ',' '\n') \
        <(rc-pick --case "$3" "$2" | rc-export --format csv | grep -v '^#' | tr ',' '\n') |
        awk 'NF == 2 { d = $1 - $2; s += d < 0 ? -d : d; t += $2 } END { printf "%.6g\n", s / t }'
}
told() { sed -n "$3p" "$1" | field "$2" -; }
between 0 "$(apart half.rcg sixteen.rcg 3)" 2e-4 "the second run changes the pressure by less than the tolerances of two contacts"
claim "  and never gives a smaller estimate" test "$(told half.json pressure_error_estimate 1 | awk -v b="$(told sixteen.json pressure_error_estimate 1)" '{ print ($1 > 0.999 * b) }')" = 1
for run in eight auto half; do
    for case in 1 3; do
        between "$(apart $run.rcg truth.rcg $case)" "$(told $run.json pressure_error_estimate $case)" 2e-2 "$run, load $case: the estimate is above the error"
    done
done
near "$(told eight.json applications 2)" 1 0 "what unloads without flow takes one application"
claim "  reloading to the same peak takes less than ten" test "$(told eight.json applications 3)" -lt 10
claim "  its error is inherited" grep -q '"error_limited_by": "history"' <(sed -n 3p eight.json)
near "$(told eight.json pressure_error_estimate 3)" "$(for part in increment inherited slab iteration contact image; do told eight.json ${part}_error_estimate 3; done |
    awk '{ v[NR] = $1 } END { print sqrt((v[1] + v[2]) ^ 2 + v[3] ^ 2) + v[4] + v[5] + v[6] }')" 1e-5 "the estimate is the sum of its parts, of increments and slabs of their squares"
$again --tol 1e-4 --increments 8 --report tight.json -o tight.rcg && status=0 || status=$?
claim "converged compares the error with --tol" bash -c "test $status = 3 && sed -n 1p tight.json | grep -q '\"converged\": false'"

# ---- stresses ----

# at no node more than a tenth above the hardened yield stress, because the mean over a slab yields
rc-pick --case 1 y.rcg | rc-stress --quiet --depths auto --components mises --report total.json -o total.rcg
between 1.9e9 "$(grep -o '"mises": {"value": [^,]*' total.json | head -n 1 | sed 's/.* //')" \
    "$(awk -v s="$(column max_plastic_strain 1 r.tsv)" 'BEGIN { print 1.1 * (2e9 + 1e10 * s) }')" "rc-stress: the stress stays at the yield stress"
rc-pick --channel pressure --case 1 y.rcg >alone.rcg
claim "  rc-stress without the strain causes a warning" warns "yielded inside, and nothing of its strain" rc-stress --depths auto --components mises -o m.rcg alone.rcg
between 2.3e9 "$(rc-stress --quiet --depths 0:5um:21 --components mises --report - alone.rcg -o m.rcg | grep -o '"mises": {"value": [^,]*' | head -n 1 | sed 's/.* //')" 1e10 \
    "  and would be far above it"
# the stress after unloading is that of --residual before
rc-pick --case 2 y.rcg | rc-stress --quiet --depths 1um --components sxx -o left.rcg
rc-pick --case 1 y.rcg | rc-stress --quiet --depths 1um --components sxx --residual -o residual.rcg
between 1e8 "$(rc-info --json left.rcg | grep -o '"maximum": [^,}]*' | sed 's/.* //')" 2e9 "what is left of the stress"
near "$(rc-info --json left.rcg | grep -o '"maximum": [^,}]*' | sed 's/.* //')" "$(rc-info --json residual.rcg | grep -o '"maximum": [^,}]*' | sed 's/.* //')" 3e-2 \
    "  is that of the strain alone under the load"
refuses 1 'the case has no plastic strain' "--residual of an elastic case" "rc-stress --residual --depths 1um --components sxx elastic.rcg"
rc-pick --case 1 --channel pressure,exx,eyy y.rcg >part.rcg
refuses 1 'exx eyy exy exz eyz in that order' "a part of the strain" "rc-stress --depths 1um --components sxx part.rcg"

# ---- a table of hardening ----

printf 'strain\tstress\n0\t2GPa\n# as the line\n0.5\t7GPa\n' >line.tsv
$elastic --mean-pressure 150MPa --yield line.tsv --increments 8 --report table.json --output pressure rough.rcg -o t.rcg
$elastic --mean-pressure 150MPa --yield 2GPa,10GPa --increments 8 --report line.json --output pressure rough.rcg -o l.rcg
near "$(field max_pressure table.json)" "$(field max_pressure line.json)" 1e-9 "a table of a straight line is that line"
near "$(field increments table.json)" 8 0 "  in as many increments as were asked for"
printf 'stress/MPa;strain (%%)\n2000;0,0\n7000;50,0\n' >line.csv
$elastic --mean-pressure 150MPa --yield line.csv --increments 8 --report units.json --output pressure rough.rcg -o u.rcg
near "$(field max_pressure units.json)" "$(field max_pressure line.json)" 1e-9 "  with units in the heading"
$elastic --mean-pressure 150MPa --yield 2GPa,10GPa --increments 8 --slabs 6 --report six.json --output pressure rough.rcg -o s.rcg
near "$(field slabs six.json)" 6 0 "so many slabs"
$elastic --mean-pressure 150MPa --yield 2GPa,10GPa --increments 2 --verbose --report two.json --output pressure rough.rcg -o s.rcg 2>two.err
claim "two increments give no error estimate" bash -c "grep -q '\"pressure_error_estimate\": null' two.json && grep -q 'converged in 2 increments' two.err"
# slabs divided evenly: with twice and four times as many the pressure converges, each difference less than
# half of the one before
for n in $(($(field slabs line.json) / 2)) $((2 * $(field slabs line.json))) $((4 * $(field slabs line.json))); do
    $elastic --mean-pressure 150MPa --yield 2GPa,10GPa --increments 8 --slabs $n --output pressure rough.rcg -o slabs-$n.rcg
done
cp l.rcg slabs-$(field slabs line.json).rcg
n=$(field slabs line.json)
between 1e-4 "$(apart slabs-$((2 * n)).rcg slabs-$((4 * n)).rcg 1)" "$(awk -v d="$(apart slabs-$n.rcg slabs-$((2 * n)).rcg 1)" 'BEGIN { print 0.6 * d }')" \
    "more slabs converge"
between 0 "$(apart slabs-$n.rcg slabs-$((2 * n)).rcg 1)" "$(apart slabs-$((n / 2)).rcg slabs-$n.rcg 1)" "  from the coarsest on"
near "$(field contact_area six.json)" "$(field contact_area line.json)" 3e-2 "  make little difference"
$elastic --mean-pressure 150MPa --yield 2GPa,10GPa --increments 8 --slabs 0.5um,0.5um,1um,2um,4um --report five.json --output pressure rough.rcg -o s.rcg
near "$(field slabs five.json)" 5 0 "or these"

# ---- a map that is not periodic ----

rc-synth sphere --nx 64 --dx 1um --radius 100um -o ball.rcg
ball="rc-solve --quiet --E1 210GPa --nu1 0.3 --E2 rigid --load 0.3N --yield 2GPa,2GPa --increments 8 --slabs $(stack 0.5 9) --output pressure,strain"
$ball --report free.json ball.rcg -o free.rcg
$ball --periodic --report periodic.json ball.rcg -o periodic.rcg
near "$(field max_pressure free.json)" "$(field max_pressure periodic.json)" 2e-2 "a ball on a free map is pressed as one on a map that repeats far away"
near "$(field elastic_energy free.json)" "$(energy_of free.rcg 1e-12)" 1e-5 "  its elastic energy is that of the pressure alone, without the residual displacement"
near "$(field elastic_energy periodic.json)" "$(energy_of periodic.rcg 1e-12 --periodic)" 1e-5 "  on both"
near "$(field plastic_depth free.json)" "$(field plastic_depth periodic.json)" "$same" "  and yields as deep"
near "$(rc-stress --quiet --residual --depths 5um --components sxx free.rcg | rc-info --json | grep -o '"minimum": [^,}]*' | sed 's/.* //')" \
    "$(rc-stress --quiet --residual --depths 5um --components sxx periodic.rcg | rc-info --json | grep -o '"minimum": [^,}]*' | sed 's/.* //')" 3e-2 \
    "  and keeps the stress"

# ---- warnings ----

claim "too few slabs and large strains cause warnings" bash -c '
    warns "the lowest slab yields" rc-solve --periodic --E1 210GPa --nu1 0.3 --E2 rigid --mean-pressure 300MPa --yield 0.2GPa --tol 1 --increments 4 --slabs 0.5um,0.5um rough.rcg -o w.rcg &&
    grep -q "largest plastic strain is" warns.err && grep -q "slabs lie in the depth that yields, which is too coarse" warns.err'
claim "--dry-run lists the effect" bash -c 'says "yield +on: computed where" rc-solve --dry-run --periodic --E1 1GPa --nu1 0.3 --E2 rigid --load 1N --yield 1MPa rough.rcg'
claim "  the list may begin with the load 0" bash -c 'says "2 loads" rc-solve --dry-run --periodic --E1 1GPa --nu1 0.3 --E2 rigid --load 0,1N --yield 1MPa rough.rcg'

# ---- refusals ----

base="rc-solve --E1 210GPa --nu1 0.3 --E2 rigid --mean-pressure 100MPa"
refuses 2 'does not work with --hardness' "a hardness" "$base --periodic --yield 1GPa --hardness 3GPa rough.rcg"
refuses 2 'does not work with --layer' "a coat" "$base --periodic --yield 1GPa --layer 1um,1GPa,0.3 rough.rcg"
refuses 2 'does not work with --nu1 0.5' "an incompressible body" "rc-solve --E1 1GPa --nu1 0.5 --E2 rigid --load 1N --periodic --yield 1MPa rough.rcg"
refuses 2 'needs its own modulus' "a composite modulus" "rc-solve --estar 1GPa --load 1N --periodic --yield 1MPa rough.rcg"
refuses 2 'does not work with --approach' "an approach" "rc-solve --E1 1GPa --nu1 0.3 --E2 rigid --approach 1um --periodic --yield 1MPa rough.rcg"
refuses 2 '--increments has no effect without --yield or --time' "increments of nothing" "$base --periodic --increments 8 rough.rcg"
refuses 2 'must be auto or a number' "increments of another kind" "$base --periodic --yield 1GPa --increments many rough.rcg"
refuses 2 'the yield stress must be above 0' "no yield stress" "$base --periodic --yield 0 rough.rcg"
refuses 2 'No such file' "no table" "$base --periodic --yield absent.tsv rough.rcg"
table() { # WORDS CLAIM POINTS: the table is refused as a wrong command line, before anything is solved
    printf "$3" >bad.tsv
    refuses 2 "$1" "$2" "$base --periodic --yield bad.tsv absent.rcg"
}
table 'line 2: stress 1e.09 Pa: it must not be below 2e.09' "a table that falls" '0 2GPa\n0.1 1GPa\n'
table 'line 1: plastic strain 0.01: the table must begin at 0' "a table that does not begin at 0" '0.01 2GPa\n'
table 'line 3: plastic strain 0.1: it must be above 0.1' "a table whose strain stands still" '0 2GPa\n0.1 3GPa\n0.1 4GPa\n'
table 'line 1: stress 0 Pa: it must be above 0' "a table without a yield stress" '0 0\n'
table "no column 'sress': the columns are strain, stress: did you mean stress" "a column of another name" 'strain sress\n0 2GPa\n'
table 'line 1: stress: unknown unit .mm' "a unit of another kind" 'strain stress/mm\n0 2000\n'
table "line 1: stress: 'nan'" "a number that is none, which is not a heading" '0 nan\n0.1 1GPa\n'
refuses 2 'the yield stress, 1 Pa, is below a millionth of E' "a yield stress without its unit" "$base --periodic --yield 1 absent.rcg"
refuses 2 'the yield stress, 1 TPa, is above E' "a yield stress above the modulus" "$base --periodic --yield 1e12 absent.rcg"
refuses 2 'output residual has no effect without --yield' "a residual displacement of nothing" "$base --periodic --output residual absent.rcg"
refuses 2 'output strain has no effect without --yield' "a plastic strain of nothing" "$base --periodic --output pressure,strain absent.rcg"
printf '0 2GPa 3\n' >three.tsv
refuses 2 'line 1: it must hold' "a table of three columns" "$base --periodic --yield three.tsv rough.rcg"
refuses 1 'all depths of a periodic body yield' "a mean pressure beyond all" \
    "rc-solve --E1 210GPa --nu1 0.3 --E2 rigid --mean-pressure 5GPa --periodic --yield 1GPa rough.rcg"

# ---- the example of the page ----

sed -n '/^A rough surface of hard steel/,/^\.Ed/p' "$RC_SOURCE/man/contact-yield.7" |
    sed '1,/^\.Bd/d; /^\.Ed/d; s/\\e/\\/; s/\\-/-/g' >example.sh
claim "the example of contact-yield(7) runs" bash -c 'test "$(wc -l <example.sh)" = 5 && bash -e example.sh && says PNG head -c 4 dent.png'
