# SPDX-License-Identifier: GPL-3.0-or-later
# The errors of rc-cost are those of the pressures of rc-solve with the same settings, computed here
# independently. Its reference agrees with Hertz and Westergaard; and the proposed command has the stated
# error.
. "$(dirname "$0")/../pipe.sh"

# Prints the values of a stream of one f64 frame, one per line, without the checksum and the end line after
# them.
values() {
    head -c -24 "$1" | tail -c "$((8 * $2))" | od -An -v -w8 -t f8
}

# off A B N [KEY]: prints the relative L1 distance of the N values of two streams.
off() {
    values "$1" "$3" >a.txt
    values "$2" "$3" >b.txt
    paste a.txt b.txt | awk '{ d = $1 - $2; s += d < 0 ? -d : d; t += $2 } END { printf "%.12g\n", s / t }'
}

# rows FILE: prints the lines of the table of pressures.
rows() {
    awk '/^$/ { exit } !/^#/ && $1 != "method"' "$1"
}

# ---- a rough periodic surface ----

rc-synth selfaffine --nx 66 --ny 62 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 30um --short-cut 6um --seed 11 \
    -o rough.rcg
nodes=$((66 * 62))
contact="--periodic --mean-pressure 2GPa --estar 114GPa"
rc-cost $contact --limit 1h -o cost.txt --report cost.json --plot cost.png rough.rcg
rc-solve $contact --tol 1e-12 --kernel fft64 --output pressure --quiet -o truth.rcg rough.rcg

# Tolerance of figures with three digits, with the rounding of the last one.
three_and=$(awk -v t="$three_digits" 'BEGIN { print 1.2 * t }')

# With every commit a third of them.
every_error() {
    rows cost.txt | awk '$5 == "66x62"' >full.txt
    [ "$(wc -l <full.txt)" = 18 ] || return 1
    before_release && cp full.txt some.txt || awk 'NR % 3 == 1' full.txt >some.txt
    while read -r method kernel _ tol _ _ _ _ _ _ error _; do
        rc-solve $contact --method "$method" --kernel "$kernel" --tol "$tol" --output pressure --quiet -o one.rcg \
            rough.rcg || return 1
        echo "$method $kernel $tol $error $(off one.rcg truth.rcg $nodes)"
    done <some.txt >both.txt
    cat both.txt >&2
    awk -v digits="$three_and" -v floor="$of_sum" '
        { d = $4 - $5; if (d < 0) d = -d; if (NF != 5 || d > digits * $5 + floor) bad = 1 }
        END { exit bad || NR < 6 }' both.txt && [ "$(wc -l <both.txt)" = "$(wc -l <some.txt)" ]
}
claim "true errors on the original grid equal those of rc-solve with these settings" every_error
claim "true errors of pcg are at most the requested tolerances" bash -c "
    awk '!/^#/ && \$1 == \"pcg\" && \$5 == \"66x62\" { n++; if (\$11 > \$4) bad = 1 } END { exit bad || n != 14 }' cost.txt"
# Figures have three digits, and below 1e-11 the error of the reference matters.
claim "estimates of pcg are 1 to 1.5 times the true errors" bash -c "
    awk '!/^#/ && \$1 == \"pcg\" && \$5 == \"66x62\" && \$11 > 1e-11 {
        n++; if (\$10 < (1 - $three_digits) * \$11 || \$10 > 1.5 * \$11) { bad = 1; print >\"/dev/stderr\" }
    } END { exit bad || n < 10 }' cost.txt"

claim "the coarser grids have 1/8, 1/4 and 1/2 of the nodes a side, rounded" bash -c '
    awk "\$1 == \"pcg\" && \$5 != \"66x62\" { print \$5 }" cost.txt | uniq | tr "\n" " " | grep -qx "8x8 17x16 33x31 "'

# No trial is better in both time and error than a marked one, and each other trial is worse in both than some
# marked one. Below the error of the reference all errors count as equal.
front_again() {
    perl -MJSON::PP -e '
        my ($floor, @trial);
        while (<>) {
            my $r = decode_json($_);
            $floor = $r->{pressure_error_estimate} if $r->{what} eq "reference";
            push @trial, $r if $r->{what} eq "pressure" && $r->{state} eq "done";
        }
        my $marked = 0;
        for my $r (@trial) {
            $r->{seen} = $r->{error} > $floor ? $r->{error} : $floor;
            $marked += $r->{front};
        }
        for my $r (@trial) {
            my $beaten = grep {
                $_->{seconds} <= $r->{seconds} && $_->{seen} <= $r->{seen} &&
                ($_->{seconds} < $r->{seconds} || $_->{seen} < $r->{seen}) } @trial;
            die "$r->{method} $r->{kernel} $r->{tol}: marked or not, it is wrong\n" if !$beaten != !!$r->{front};
        }
        die "only $marked of ", scalar @trial, " are marked\n" if $marked < 2 || $marked == @trial;' cost.json
}
claim "the front has the trials that no other beats in both time and error" front_again
table_again() {
    rows cost.txt >trials.txt
    perl -MJSON::PP -e '
        open my $table, "<", "trials.txt" or die;
        my $n = 0;
        while (<>) {
            my $r = decode_json($_);
            next if $r->{what} ne "pressure" || $r->{state} ne "done";
            my @cell = split " ", <$table>;
            my @want = (@$r{"method", "kernel", "arithmetic"}, sprintf("%.0e", $r->{tol}), "$r->{nx}x$r->{ny}",
                map { sprintf "%.2e", $r->{$_} } "pressure_error_estimate", "error", "contact_area_error",
                                                 "max_pressure_error", "approach_error");
            die "row $n: @cell, not @want\n" if "@cell[0 .. 4, 9 .. 13]" ne "@want";
            for my $note ("front", "optimistic") {
                die "row $n: $cell[14]\n" if ($cell[14] =~ /\b$note\b/) != $r->{$note};
            }
            $n++;
        }
        die "$n rows in JSON, more in the table\n" if $n < 20 || defined <$table>;' cost.json
}
claim "each trial has a JSON line with the figures of the table" table_again
claim "the reference has one too" test "$(grep -c '"what": "reference"' cost.json)" = 1
claim "the picture is a PNG of 1200 pixels" bash -c '
    [ "$(head -c 4 cost.png | tail -c 3)" = PNG ] && [ "$(od -An -j 16 -N 4 -t x1 cost.png | tr -d " ")" = 000004b0 ]'

# ---- the command ----

rc-cost $contact --limit 1h --error 1e-3 -o command rough.rcg
rc-pick --crop 0,0,16,14 -o tiny.rcg rough.rcg # where only words matter
proposed() {
    [ "$(wc -l <command)" = 1 ] && cat command >&2 &&
        sh -c "$(cat command) --output pressure --report ran.json" >ran.rcg &&
        rc-solve $contact --tol 1e-10 --output pressure --quiet -o near.rcg rough.rcg &&
        off ran.rcg near.rcg $nodes >distance && awk '{ exit !($1 <= 1e-3) }' distance
}
claim "the command for 1e-3 gives a result within 1e-3 of a solution to 1e-10" proposed
claim "the command has the options of the contact in SI units" grep -q \
    '^rc-solve --mean-pressure 2000000000 --estar 114000000000 --periodic --method pcg --kernel fft' command
claim "a file name with special characters is quoted" bash -c '
    cp tiny.rcg "a b.rcg" && says " .a b.rcg.$" rc-cost '"$contact"' --method pcg --kernel fft --error 1e-3 "a b.rcg"'
claim "with --budget the command is the most accurate in time, right to 1e-6 at least" bash -c "
    rc-cost $contact --method pcg --kernel fft --budget 20s rough.rcg >budget.txt 2>budget.err && grep -Eq 'tol 1e-(0[6-9]|10)' budget.txt"
claim "  its error is printed without a request" \
    grep -Eq 's, off by [0-9.e-]+ % of the pressure' budget.err
refuses 1 'no trial was fast enough: the best was pcg, .* s, error .*; raise --budget' "a budget that nothing meets, saying what was the quickest" \
    "rc-cost $contact --method pcg --kernel fft --budget 1us tiny.rcg"
refuses 1 'no trial was accurate enough: the best was .*; raise --error' "an error below what was measured" "rc-cost $contact --method pcg --kernel fft --error 1e-15 tiny.rcg"
refuses 2 '--error does not work with --budget' "a budget and an error" "rc-cost $contact --budget 1s --error 1e-3 rough.rcg"
refuses 2 'one load at a time: 2 were given' "a list of loads" "rc-cost --load 1N,2N --estar 1GPa rough.rcg"
refuses 2 '--depths has no effect without --nu or --nu1' "stresses without Poisson's ratio" "rc-cost $contact --depths 0 rough.rcg"
refuses 1 'case 2.*a picture is for one case' "a picture of two cases" "rc-cost $contact --limit 1s --method pcg --kernel fft --plot two.png tiny.rcg tiny.rcg"

# ---- limits and signals ----

rc-synth sphere --nx 96 --dx 5um --radius 7.5mm -o ball.rcg
claim "trials above --limit are omitted and named" bash -c '
    rc-synth sphere --nx 800 --dx 1um --radius 7.5mm |
        rc-cost --load 500N --estar 114GPa --kernel direct --threads 1 --limit 4s >short.txt &&
    [ "$(grep -c "^# pcg, direct, .*: left out: it would take about .* left of --limit" short.txt)" = 3 ]'
claim "--dry-run prints the expected time and runs no trial" bash -c '
    rc-cost --load 20N --estar 114GPa --method pcg --kernel fft --dry-run --plot dry.png ball.rcg >dry.txt &&
    grep -q "ways to solve 96 x 96 nodes, about .* s after .* s for the reference" dry.txt && [ ! -e dry.png ]'
# large enough for plain sums to take long on any machine
rc-synth sphere --nx 200 --dx 5um --radius 7.5mm -o large.rcg
interrupted() {
    local tool status children=
    rc-cost --progress line --load 20N --estar 114GPa --limit 5min --kernel fft,direct large.rcg >cut.txt 2>told.txt &
    tool=$!
    # it measures in a separate process
    until [ -n "$children" ] && grep -q 'tol 1e-04, 200 x 200' told.txt || ! kill -0 "$tool"; do
        sleep 0.01
        children=$(pgrep -P "$tool" | tr '\n' ' ')
    done
    kill -TERM "$tool"
    wait "$tool"
    status=$?
    rows cut.txt >cut-rows.txt
    # shellcheck disable=SC2086
    [ "$status" = 143 ] && grep -q '^pcg' cut-rows.txt && [ -n "${children// /}" ] && ! kill -0 $children
}
claim "a signal ends rc-cost and its trial, and the table has the finished trials" interrupted
killed() {
    local tool child="" n
    mkdir -p scratch
    TMPDIR=$PWD/scratch rc-cost --load 20N --estar 114GPa --quiet --limit 5min --kernel direct large.rcg >/dev/null 2>&1 &
    tool=$!
    until child=$(pgrep -P "$tool") || ! kill -0 "$tool"; do sleep 0.05; done
    kill -KILL "$tool"
    wait "$tool" 2>/dev/null
    for n in {1..40}; do kill -0 "$child" 2>/dev/null || break; sleep 0.05; done
    [ -n "$child" ] && ! kill -0 "$child" 2>/dev/null && [ -z "$(ls scratch)" ]
}
claim "a kill of rc-cost ends its trial too, and leaves no file" killed

# ---- rc-solve ----

of_path() {
    mkdir -p alone && ln -f "$RC_BIN/rc-cost" alone/ 2>/dev/null || cp "$RC_BIN/rc-cost" alone/
    alone/rc-cost $contact --method pcg --kernel fft --dry-run tiny.rcg >path.txt && grep -q '^  pcg, fft' path.txt || return 1
    ! PATH=/nowhere alone/rc-cost $contact --dry-run tiny.rcg 2>none.txt && grep -q 'rc-solve: it cannot be run' none.txt
    printf '#!/bin/sh\necho "rc-solve: no contact today" >&2\nexit 1\n' >alone/rc-solve && chmod +x alone/rc-solve
    ! alone/rc-cost $contact --dry-run tiny.rcg 2>own.txt && grep -q 'no contact today' own.txt
}
claim "rc-cost runs the rc-solve of its folder, otherwise that of PATH, and says if there is none" of_path
coated="--load 40N --E1 200GPa --nu1 0.3 --E2 rigid --layer 5um,400GPa,0.2,-1GPa --tilt free --at 20um,0"
tilted() {
    rc-cost $coated --method pcg --kernel fft --error 1e-3 --quiet -o tilted ball.rcg && cat tilted >&2 &&
        grep -q -- ' --layer 5e-06,400000000000,0.2,-1000000000 --tilt free --at 2e-05,0 ' tilted &&
        sh -c "$(cat tilted) --output pressure --quiet --report tilted.json" >tilted.rcg &&
        rc-solve $coated --tol 1e-10 --output pressure --quiet -o near.rcg ball.rcg &&
        off tilted.rcg near.rcg 9216 >distance && awk '{ exit !($1 <= 1e-3) }' distance
}
claim "options of rc-solve are passed on: a residual stress, a free tilt" tilted

# ---- Hertz: radius 7.5 mm, E* 114 GPa, 20 N; a^3 = 3 P R / 4 E*, p0 = 3 P / 2 pi a^2, approach a^2 / R ----

rc-cost --load 20N --estar 114GPa --method pcg --kernel fft,mlms -o hertz.txt ball.rcg
figure() {
    sed -n "s/^# reference:.*$1 \([0-9.e+-]*\) $2.*/\1/p" hertz.txt
}
# 20 nodes in the radius: an error of a third of a node at the edge is 3 % of the area
near "$(figure 'contact area' m2)" 3.113974e-08 0.03 "the reference's contact area is Hertz's, to the order of the grid"
near "$(figure 'largest pressure' Pa)" 9.633992e+08 "$coarse_grid" "its largest pressure is Hertz's"
near "$(figure approach m)" 1.321612e-06 "$coarse_grid" "its approach is Hertz's"

# Block means of a paraboloid are the same paraboloid at the coarse nodes, plus a constant.
coarse_sphere() {
    rc-synth sphere --nx 48 --dx 10um --radius 7.5mm |
        rc-solve --load 20N --estar 114GPa --tol 1e-3 --output pressure --quiet -o half.rcg &&
        rc-solve --load 20N --estar 114GPa --tol 1e-12 --kernel fft64 --output pressure --quiet -o fine.rcg ball.rcg &&
        values half.rcg 2304 >half.txt && values fine.rcg 9216 >fine.txt &&
        awk 'NR == FNR { c[NR - 1] = $1; next }
             { k = FNR - 1; d = c[int(int(k / 96) / 2) * 48 + int(k % 96 / 2)] - $1
               s += d < 0 ? -d : d; t += $1 } END { printf "%.6g\n", s / t }' half.txt fine.txt >coarse.txt
}
claim "the sphere of a coarser grid can be solved separately" coarse_sphere
near "$(awk '$5 == "48x48" && $4 == "1e-03" { print $11 }' hertz.txt)" "$(cat coarse.txt)" "$three_and" \
    "the error of a coarser grid is that of the same sphere on fewer nodes, spread over its cells"
# The same ball, 480 um, on 512 x 512 nodes. An eighth of the nodes a side gives an error of 20 % in a
# fiftieth of the time.
rc-synth sphere --nx 512 --dx 0.9375um --radius 7.5mm -o large.rcg
rc-cost --load 20N --estar 114GPa --method pcg --kernel fft --error 0.2 -o coarser large.rcg
claim "a coarser grid is proposed if the error allows it" \
    grep -Eq '^rc-pick --resample 64x64 large.rcg \| rc-solve --load 20 --estar 114000000000 --method pcg --kernel fft --tol [0-9.]+$' coarser
claim "  the command runs" bash -c 'sh -c "$(cat coarser) --output pressure --quiet --report coarser.json" >coarser.rcg'
near "$(field nx coarser.json)" 64 "$same" "  on that grid"
near "$(field max_pressure coarser.json)" 9.633992e+08 "$coarse_grid" "  with Hertz's largest pressure"
claim "the error of pcg with mlms is at most the requested one" bash -c "
    awk '\$1 == \"pcg\" && \$2 == \"mlms\" { n++; if (\$11 > \$4) bad = 1 } END { exit bad || n != 5 }' hertz.txt"

# ---- Westergaard 1939: a wave in plane strain, p* = pi E* amplitude / wavelength, mean p* sin^2(pi a / wavelength) ----

rc-synth wave --nx 512 --ny 1 --dx 1um --amplitude 1um --wavelength 512um -o wave.rcg
wave_mean=$(awk 'BEGIN { pi = atan2(0, -1); s = sin(pi * 0.3 / 2); printf "%.9g", pi * 100e9 * 1e-6 / 512e-6 * s * s }')
rc-cost --periodic --mean-pressure "$wave_mean" --estar 100GPa --method pcg --kernel fft -o wave.txt wave.rcg
near "$(sed -n 's/.*(\([0-9.]*\) % of the map.*/\1/p' wave.txt)" 30 "$(awk 'BEGIN { print 1 / (0.3 * 512) }')" \
    "a wave is in contact where Westergaard says, to a node"

# ---- stresses ----

rc-synth sphere --nx 50 --ny 46 --dx 8um --radius 7.5mm -o small.rcg
rc-cost --load 40N --estar 114GPa --nu 0.3 --depths 30um --method pcg --kernel fft64 --limit 10min --quiet -o stress.txt small.rcg
stress_again() {
    rc-solve --load 40N --estar 114GPa --tol 1e-12 --kernel fft64 --output pressure --quiet -o p.rcg small.rcg
    for component in sxx syy szz sxy sxz syz mises; do
        for kernel in direct mlms; do
            rc-stress --nu 0.3 --depths 30um --components $component --kernel $kernel --tol 1e-4 -o s.rcg p.rcg || return
            values s.rcg 2300 >$kernel.txt || return
        done
        paste direct.txt mlms.txt
    done >stresses.txt
    values p.rcg 2300 | awk 'NR == FNR { m = $1 > m ? $1 : m; next }
        { d = $1 - $2; d = d < 0 ? -d : d; w = d > w ? d : w } END { printf "%.6g\n", w / m }' - stresses.txt
}
near "$(awk '$1 == "mlms" && $2 == "1e-04" { print $7 }' stress.txt)" "$(stress_again)" "$three_and" \
    "the error of mlms' stresses is their distance from direct sums"
claim "fft and direct give the same stresses to rounding" bash -c "
    awk '\$1 == \"direct\" { n++; if (\$7 > $rounding) bad = 1 } END { exit bad || n != 1 }' stress.txt"
claim "no error of a stress exceeds the requested one" bash -c "
    awk 'on && NF == 10 && \$2 > 0 && \$7 != \"nan\" { n++; if (\$7 > \$2) bad = 1 } /^kernel/ { on = 1 }
         END { exit bad || n != 7 }' stress.txt"
