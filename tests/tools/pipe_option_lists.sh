# SPDX-License-Identifier: GPL-3.0-or-later
# Every list of numbers may have equal ratios, a:b:log:n, and --help says so. A word in place of a number is
# written to the history as this word. Two whole numbers with a comma between them may be one number with a
# decimal comma. They are read as a list, with a warning that explains how to write the number.
. "$(dirname "$0")/../pipe.sh"

# ---- by ratio ----

rc-synth sphere --nx 17 --dx 5um --radius 7.5mm -o ball.rcg
rc-synth wave --nx 16 --dx 1um --wavelength 16um --amplitude 10nm -o wave.rcg

# column NAME TABLE: prints the cells of a column, one per line.
column() {
    awk -F '\t' -v name="$1" 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == name) c = k; next } { print $c }' "$2"
}

claim "a range by ratio gives a case for each load" \
    rc-solve --load 10mN:10N:log:4 --estar 114GPa --quiet --report loads.tsv -o loads.rcg ball.rcg
k=-2
for load in $(column load/N loads.tsv); do
    near "$load" "1e$k" "$summed" "each ten times the last"
    k=$((k + 1))
done
claim "  there are four" test "$k" = 2
claim "  the history has the numbers" says 'rc-solve [^|]*--load 0\.01,0\.1,1,10 ' head -c 2000 loads.rcg
claim "mean pressures can be a range by ratio" \
    rc-solve --periodic --mean-pressure 1MPa:100MPa:log:3 --estar 114GPa --quiet --report means.tsv -o means.rcg wave.rcg
near "$(column mean_pressure/Pa means.tsv | sed -n 2p)" 1e7 "$summed" "the middle one"
claim "approaches can be a range by ratio" \
    rc-solve --approach 1nm:100nm:log:3 --tol 1e-6 --estar 114GPa --quiet --report near.tsv -o near.rcg ball.rcg
near "$(column approach/m near.tsv | sed -n 2p)" 1e-8 "$six_digits" "the middle one"
claim "depths can be a range by ratio" \
    rc-stress --nu 0.3 --depths 1um:100um:log:3 --components szz -o depths.rcg loads.rcg
claim "  the middle one is at 10 um" says '^depth=1e-05$' cat depths.rcg

refuses 2 'from 0 to 1: a range by ratio needs both ends above 0' "an end at 0" \
    "rc-solve --load 0:1:log:3 --estar 1GPa ball.rcg"
refuses 2 "a:b:log:n must be a whole number" "half a value" "rc-solve --load 1:2:log:2.5 --estar 1GPa ball.rcg"
refuses 2 "a range is a:b:n, n values from a to b, or a:b:log:n" "no number of values" \
    "rc-solve --load 1:2:log --estar 1GPa ball.rcg"
refuses 2 "'2.5' in a:b:n must be a whole number" "half a value before another number" "rc-solve --load 1:2:2.5,3 --estar 1GPa ball.rcg"
refuses 2 'numbers with and without a unit in one list' "ranges with and without units" "rc-solve --load 1N:2N:2,3:4:2 --estar 1GPa ball.rcg"
refuses 2 'a list has at most 1000000 numbers' "ranges without limit" "rc-solve --load 1:2:1000000,1:2:1000000 --estar 1GPa ball.rcg"
refuses 2 "'0,5:2:3': the decimal mark is a point; .* write the range first, or '0.0'" "a decimal comma in a range" \
    "rc-solve --load 0,5:2:3 --estar 1GPa ball.rcg"
refuses 2 "'' is not a number" "a comma at the end" "rc-solve --load 1:2:2, --estar 1GPa ball.rcg"
for option in 'rc-solve --load' 'rc-stress --depths'; do
    claim "$option: --help explains the range" \
        bash -c "${option% *} --help | grep -A 1 '^  $(sed 's/.* //' <<<"$option") ' | says a:b:log:n cat"
done

# ---- forces over a length ----

refuses 2 'N and N/m in one list' "forces of two kinds" "rc-solve --load 1N/m,2N --estar 1GPa ball.rcg"
refuses 2 "--coefficient 1e-7: the number has no unit: m2/N is expected, .*, or mm3/Nm or 1/GPa" "a wear coefficient without its unit" \
    "rc-scene --load 1N --estar 1GPa --coefficient 1e-7 --distance 1m </dev/null"
refuses 2 "unknown unit 'N/s': N or N/m is expected" "a force over a time" \
    "rc-solve --load 1N/s --estar 1GPa ball.rcg"
refuses 2 'load -1 N/m: it must be at least 0' "a negative one, in its own unit" \
    "rc-solve --load=-1N/m --estar 1GPa ball.rcg"

# ---- words for numbers ----

steel="--load 1 --E1 210GPa --nu1 0.3 --nu2 0.3"
claim "--E2 rigid is accepted" rc-solve $steel --E2 rigid --quiet -o rigid.rcg ball.rcg
claim "  the history has the word" says 'rc-solve [^|]*--E2 rigid ' head -c 2000 rigid.rcg
near "$(sed -n '/^estar=/{s///p;q}' rigid.rcg)" 230769230769.23077 "$rounding" "  E* is E1 / (1 - nu1^2)"
refuses 2 "E2 hard: 'hard' is not a number" "another word" "rc-solve $steel --E2 hard ball.rcg"
refuses 2 "E1 rigid: body 1 must have a --layer" "a rigid body 1 without layers" \
    "rc-solve --load 1 --E1 rigid --nu1 0.3 --E2 1GPa --nu2 0.3 ball.rcg"

# ---- a decimal comma ----

rc-synth sphere --nx 17 --dx 5um --radius 7.5mm -o ball.rcg
press="rc-solve --estar 114GPa --output pressure -o out.rcg"

claim "1,5 gets a warning, because it may mean 1.5" \
    warns 'load 1,5: two values, 1 N and 5 N: for one number write 1\.5, for two 1N,5N$' $press --load 1,5 ball.rcg
claim "  it is two cases" says '^case=2$' cat out.rcg
claim "a zero after the comma is kept in the message" warns 'two values, 1 N and 5 N: for one number write 1\.05, for two 1N,5N$' $press --load 1,05 ball.rcg
claim "other lists get the warning too" warns 'depths 2,3: two values, 2 m and 3 m: .* 2\.3, for two 2m,3m$' rc-stress --nu 0.3 --depths 2,3 out.rcg
claim "plain numbers in metres get it too" warns 'wavelength 2,5: two values' \
    rc-synth wave --nx 8 --dx 1 --wavelength 2,5 --amplitude 1 -o wave.rcg

claim "a 0 before the comma gets it" warns 'depths 0,5um: two values, 0 um and 5 um: for one number write 0\.5um, for two 0um,5um$' \
    rc-stress --nu 0.3 --depths 0,5um -o x.rcg out.rcg
claim "  without a unit too" warns 'depths 0,05: two values, 0 m and 5 m: for one number write 0\.05, for two 0m,5m$' \
    rc-stress --nu 0.3 --depths 0,05 -o x.rcg out.rcg
claim "  where one number is as usual as two" warns 'wavelength 0,5um: two values, .* for one number write 0\.5um' \
    rc-synth wave --nx 8 --ny 8 --dx 1um --amplitude 1nm --wavelength 0,5um -o x.rcg
rc-solve --estar 114GPa --load 1mN --quiet -o worn.rcg ball.rcg
claim "  where the option reads its text itself" warns \
    'coefficient 0,5mm3/Nm: two values, 0 mm3/Nm and 5 mm3/Nm: for one number write 0\.5mm3/Nm' \
    rc-wear --coefficient 0,5mm3/Nm --distance 1m --dry-run worn.rcg
refuses 2 'cycles 0,5: two values, 0 and 5: for one number write 0\.5, for two 0\.0,5$' "  where no unit can be added a point tells two numbers" \
    "rc-wear --coefficient 1e-9mm3/Nm --cycles 0,5 -o x.rcg worn.rcg"
refuses 2 'for one number write 0\.5mN, for two' "  beside the refusal of the 0" "$press --load 0,5mN ball.rcg"

# silent COMMAND...: it succeeds without this warning.
silent() {
    "$@" 2>silent.err >/dev/null && ! grep 'two values' silent.err >&2
}
claim "--quiet before it suppresses the warning" silent $press --quiet --load 1,5 ball.rcg
claim "--quiet after it suppresses the warning" silent $press --load 1,5 ball.rcg --quiet
claim "three numbers cause no warning" silent $press --load 1,2,5 ball.rcg
claim "numbers with units cause none" silent $press --load 1N,5N ball.rcg
claim "numbers with points cause none" silent $press --load 1.0,5 ball.rcg
claim "very different numbers cause none" silent $press --load 1,10 ball.rcg
claim "a 0 with a unit causes none" silent rc-stress --nu 0.3 --depths 0um,5um -o x.rcg out.rcg
claim "a 0 before a number that ends with 0 causes none" silent rc-stress --nu 0.3 --depths 0,10um -o x.rcg out.rcg
claim "a 0 before two numbers causes none" silent rc-stress --nu 0.3 --depths 0,5um,15um -o x.rcg out.rcg
claim "a range causes none" silent $press --load 1:5:2 ball.rcg
claim "a list replaced by a later one causes none" silent $press --load 1,5 --load 2 ball.rcg
claim "a place of two coordinates causes none" silent rc-synth sphere --nx 17 --dx 5um --radius 7.5mm --place 0,5um -o x.rcg
refuses 2 'with and without a unit .*; the decimal mark is a point' "with one unit it is not a list" \
    "$press --load 1,5N ball.rcg"
