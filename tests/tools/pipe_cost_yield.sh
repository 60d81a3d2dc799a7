# SPDX-License-Identifier: GPL-3.0-or-later
# rc-cost --yield: its errors are those of the pressures of rc-solve with these increments and slabs, computed
# here independently. The proposed command has the stated error.
. "$(dirname "$0")/../pipe.sh"

# Prints the values of a stream of one f64 frame, one per line, without the checksum and the end line after
# them.
values() {
    head -c -24 "$1" | tail -c "$((8 * $2))" | od -An -v -w8 -t f8
}

# off A B N: prints the relative L1 distance of the N values of two streams.
off() {
    values "$1" "$3" >a.txt
    values "$2" "$3" >b.txt
    paste a.txt b.txt | awk '{ d = $1 - $2; s += d < 0 ? -d : d; t += $2 } END { printf "%.12g\n", s / t }'
}

export RC_THREADS=1
rc-synth selfaffine --nx 16 --ny 14 --dx 1um --hurst 0.8 --rms-slope 0.12 --rolloff 20um --short-cut 6um --seed 5 -o rough.rcg
nodes=$((16 * 14))
contact="--periodic --mean-pressure 0.6GPa --E1 210GPa --nu1 0.3 --E2 rigid --yield 1.5GPa,5GPa"
rc-cost $contact --limit 600s --quiet -o cost.txt --report cost.json --plot cost.png rough.rcg
awk '/^$/ { exit } !/^#/ && $1 != "method"' cost.txt >rows.txt

claim "the trials are five numbers of increments with each of three stacks of slabs" bash -c '
    [ "$(awk "{ print \$15 }" rows.txt | sort -n | uniq -c | awk "{ print \$2 \"x\" \$1 }" | tr "\n" " ")" = "4x3 8x3 16x3 32x3 64x3 " ] &&
    [ "$(awk "{ print \$16 }" rows.txt | sort -n | uniq -c | awk "{ print \$1 }" | tr "\n" " ")" = "5 5 5 " ]'
rc-solve $contact --quiet --output pressure --report auto.json -o auto.rcg rough.rcg
claim "one stack is that of rc-solve, the others have half and twice as many slabs" bash -c "
    [ \"\$(awk '{ print \$16 }' rows.txt | sort -n | uniq | tr '\n' ' ')\" = \"$(awk -v n="$(field slabs auto.json)" 'BEGIN { print int((n + 1) / 2), n, 2 * n }') \" ]"
read -r increments slabs < <(sed -n 's/^# it yields: the reference has \([0-9]*\) increments and \([0-9]*\) slabs$/\1 \2/p' cost.txt)
near "$slabs" "$((2 * $(field slabs auto.json)))" 0 "the reference has the finest stack"
claim "  the reference has twice the increments" test "$increments" = 128

# The reference by rc-solve, with contacts solved to 1e-6.
rc-solve $contact --increments "$increments" --slabs "$slabs" --tol 1e-6 --quiet --output pressure --report truth.json -o truth.rcg rough.rcg
# With every commit two numbers of increments with each stack.
every_error() {
    before_release && cp rows.txt some.txt || awk '$15 == 4 || $15 == 16' rows.txt >some.txt
    while read -r method kernel _ _ _ _ _ _ _ _ error area _ _ k n applications _; do
        rc-solve $contact --method "$method" --kernel "$kernel" --increments "$k" --slabs "$n" --quiet --output pressure \
            --report one.json -o one.rcg rough.rcg
        [ -s one.rcg ] || return 1 # status 3: its estimate is above 1 %
        echo "$k $n $error $(off one.rcg truth.rcg $nodes) $area $(awk -v a="$(field contact_area one.json)" \
            -v b="$(field contact_area truth.json)" 'BEGIN { print a / b - 1 }') $applications $(field applications one.json)"
    done <some.txt >both.txt
    cat both.txt >&2
    awk '{ d = $3 - $4; if (d < 0) d = -d; e = $5 - $6; if (e < 0) e = -e
           if (NF != 8 || d > 0.006 * $4 + 1e-5 || e > 0.006 * ($6 < 0 ? -$6 : $6) + 1e-9 || $7 != $8) bad = 1 }
         END { exit bad || NR < 6 }' both.txt && [ "$(wc -l <both.txt)" = "$(wc -l <some.txt)" ]
}
claim "the errors and the counts of applications equal those of rc-solve with these settings" every_error
claim "with the finest slabs more increments lower the error" bash -c "
    awk -v n=$slabs '\$16 == n { if (last != \"\" && \$11 >= last) bad = 1; last = \$11; k++ } END { exit bad || k != 5 }' rows.txt"
claim "with the most increments more slabs lower the error" bash -c "
    awk '\$15 == 64' rows.txt | sort -n -k 16 | awk '{ if (last != \"\" && \$11 >= last) bad = 1; last = \$11; k++ } END { exit bad || k != 3 }'"
claim "four increments give no estimate" bash -c 'awk "\$15 == 4 { if (\$10 != \"nan\") bad = 1; n++ } END { exit bad || n != 3 }" rows.txt'
claim "each trial has a JSON line with increments, slabs and applications" bash -c '
    perl -MJSON::PP -e '\''
        open my $table, "<", "rows.txt" or die;
        my $n = 0;
        while (<>) {
            my $r = decode_json($_);
            next if $r->{what} ne "pressure";
            my @cell = split " ", <$table>;
            my @want = ($r->{increments}, $r->{slabs}, $r->{applications}, sprintf("%.2e", $r->{error}));
            die "row $n: @cell, not @want\n" if "@cell[14 .. 16, 10]" ne "@want";
            $n++;
        }
        die "$n rows\n" if $n != 15;'\'' cost.json'
claim "a picture is drawn" says PNG head -c 4 cost.png

# ---- the command ----

rc-cost $contact --error 0.02 -o command rough.rcg 2>told
proposed() {
    [ "$(wc -l <command)" = 1 ] && cat command >&2 &&
        sh -c "$(cat command) --output pressure --quiet --report ran.json" >ran.rcg && off ran.rcg truth.rcg $nodes >distance && awk '{ exit !($1 <= 0.02) }' distance
}
claim "the command for 2 % ends with status 0 and gives a result within 2 %" proposed
between 0 "$(field pressure_error_estimate ran.json)" 0.02 "  by rc-solve's own estimate too"
claim "  the estimate is printed beside the true error" grep -q "(estimate on its own grid $(printf %.1e "$(field pressure_error_estimate ran.json)"))" told
claim "  the command has --increments and --slabs" grep -Eq ' --yield 1.5GPa,5GPa .*--increments [0-9]+ --slabs [0-9]+ --tol 0.02( --threads 1)? rough.rcg$' command
claim "--dry-run prints the expected time" says '15 ways to solve 16 x 14 nodes' rc-cost $contact --dry-run rough.rcg

# ---- refusals ----

base="rc-cost --periodic --E1 210GPa --nu1 0.3 --E2 rigid"
refuses 1 'nothing yields: the largest Mises stress is 0\.[0-9]* of the yield stress: leave out --yield' "a load under which nothing yields" \
    "$base --mean-pressure 1MPa --yield 200GPa rough.rcg"
refuses 1 'all depths of a periodic body yield' "a mean pressure beyond all" "$base --mean-pressure 5GPa --yield 1GPa rough.rcg"
refuses 2 'does not work with --estar' "a composite modulus" "rc-cost --periodic --load 1N --estar 1GPa --yield 1GPa rough.rcg"
refuses 2 'does not work with --hardness' "a hardness" "$base --load 1N --yield 1GPa --hardness 3GPa rough.rcg"
refuses 2 '--kernel does not work with --yield' "a choice of kernels" "$base --load 1N --yield 1GPa --kernel fft rough.rcg"
refuses 2 '--depths does not work with --yield' "stresses" "$base --load 1N --yield 1GPa --depths 0 rough.rcg"
refuses 2 '--yield many' "no stress" "$base --load 1N --yield many rough.rcg"
