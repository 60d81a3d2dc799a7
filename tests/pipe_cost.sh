# rc-cost's errors are those of the pressures that rc-solve gives with the same settings, found here by other
# arithmetic; its reference is Hertz's and Westergaard's; and the command that it proposes does what it says.
. "$(dirname "$0")/pipe.sh"

# Values of a stream of one f64 frame, one a line: before its end stand its checksum and its end line.
values() {
    head -c -24 "$1" | tail -c "$((8 * $2))" | od -An -v -w8 -t f8
}

# off A B N [KEY]: relative L1 distance of the N values of two streams.
off() {
    values "$1" "$3" >a.txt
    values "$2" "$3" >b.txt
    paste a.txt b.txt | awk '{ d = $1 - $2; s += d < 0 ? -d : d; t += $2 } END { printf "%.12g\n", s / t }'
}

# rows FILE: lines of the pressures' table.
rows() {
    awk '/^$/ { exit } !/^#/ && $1 != "method"' "$1"
}

# ---- a rough periodic surface ----

rc-synth selfaffine --nx 66 --ny 62 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 30um --short-cut 6um --seed 11 \
    -o rough.rcg
nodes=$((66 * 62))
contact="--periodic --mean-pressure 2GPa --estar 114GPa"
rc-cost $contact -o cost.txt --report cost.json --plot cost.png rough.rcg
rc-solve $contact --tol 1e-12 --kernel fft64 --output pressure --quiet -o truth.rcg rough.rcg

# The text of a number has three digits: half a unit of the last is 5e-3.
every_error() {
    rows cost.txt | awk '$5 == "66x62"' >full.txt
    [ "$(wc -l <full.txt)" = 18 ] || return 1
    while read -r method kernel _ tol _ _ _ _ _ _ error _; do
        rc-solve $contact --method "$method" --kernel "$kernel" --tol "$tol" --output pressure --quiet -o one.rcg \
            rough.rcg || return 1
        echo "$method $kernel $tol $error $(off one.rcg truth.rcg $nodes)"
    done <full.txt >both.txt
    cat both.txt >&2
    awk '{ d = $4 - $5; if (d < 0) d = -d; if (d > 6e-3 * $5 + 1e-14) bad = 1 } END { exit bad || NR != 18 }' both.txt
}
claim "every true error on the map's own grid is that of rc-solve with these settings" every_error
claim "pcg's true errors are at most the tolerances asked for" bash -c "
    awk '!/^#/ && \$1 == \"pcg\" && \$5 == \"66x62\" { n++; if (\$11 > \$4) bad = 1 } END { exit bad || n != 14 }' cost.txt"
# Figures have three digits, and below 1e-11 the reference's own error is felt.
claim "its estimates are not below them, nor above 1.5 times them" bash -c "
    awk '!/^#/ && \$1 == \"pcg\" && \$5 == \"66x62\" && \$11 > 1e-11 {
        n++; if (\$10 < 0.995 * \$11 || \$10 > 1.5 * \$11) { bad = 1; print >\"/dev/stderr\" }
    } END { exit bad || n < 10 }' cost.txt"

front_again() {
    local floor
    floor=$(sed -n 's/.*estimated error \([^ ]*\) .*/\1/p' cost.txt)
    rows cost.txt | awk -v floor="$floor" '
        { t[NR] = $6; e[NR] = $11 < floor ? floor : $11; marked[NR] = $NF ~ /front/; n = NR }
        END {
            for (i = 1; i <= n; i++) {
                front = 1
                for (k = 1; k <= n; k++)
                    if (t[k] < t[i] && e[k] < e[i]) front = 0
                if (marked[i] && !front) { print i " is no front" >"/dev/stderr"; bad = 1 }
                if (marked[i]) count++
                best = i == 1 || e[i] < e[best] ? i : best
            }
            exit bad || count < 2
        }'
}
claim "no trial of the front is beaten in time and error by another" front_again
claim "a JSON line for the reference and each trial, with the table's figures" bash -c '
    [ "$(grep -c "\"what\": \"pressure\"" cost.json)" -ge 24 ] && [ "$(grep -c "\"what\": \"reference\"" cost.json)" = 1 ] &&
    [ "$(grep -c "\"state\": \"done\"" cost.json)" = "$(($(grep -cE "^(pcg|pk99)" cost.txt) + 1))" ]'
claim "the picture is a PNG of 1200 pixels" bash -c '
    [ "$(head -c 4 cost.png | tail -c 3)" = PNG ] && [ "$(od -An -j 16 -N 4 -t x1 cost.png | tr -d " ")" = 000004b0 ]'

# ---- the command ----

rc-cost $contact --error 1e-3 -o command rough.rcg
proposed() {
    [ "$(wc -l <command)" = 1 ] && cat command >&2 &&
        sh -c "$(cat command) --output pressure --report ran.json" >ran.rcg &&
        rc-solve $contact --tol 1e-10 --output pressure --quiet -o near.rcg rough.rcg &&
        off ran.rcg near.rcg $nodes >distance && awk '{ exit !($1 <= 1e-3) }' distance
}
claim "the command for 1e-3, run, is within 1e-3 of a solution to 1e-10" proposed
claim "it spells the contact in SI units" grep -q \
    '^rc-solve --mean-pressure 2000000000 --estar 114000000000 --periodic --method pcg --kernel fft' command
claim "a name that a shell would take apart is quoted" bash -c '
    cp rough.rcg "a b.rcg" && rc-cost '"$contact"' --method pcg --error 0.1 "a b.rcg" | grep -q " '"'a b.rcg'"'$"'
claim "within a time it proposes the nearest, which is right to 1e-6 at least" bash -c "
    rc-cost $contact --method pcg --kernel fft --budget 20s rough.rcg >budget.txt && grep -Eq 'tol 1e-(0[6-9]|10)' budget.txt"
refuses 1 'so quick: the best was pcg' "a budget that nothing meets, saying what was the quickest" \
    "rc-cost $contact --method pcg --budget 1us rough.rcg"
refuses 1 'so near: the best was' "an error below what was measured" "rc-cost $contact --method pcg --error 1e-15 rough.rcg"
refuses 2 'give one' "a budget and an error" "rc-cost $contact --budget 1s --error 1e-3 rough.rcg"
refuses 2 'one load at a time' "a list of loads" "rc-cost --load 1N,2N --estar 1GPa rough.rcg"
refuses 2 'Poisson' "stresses without Poisson's ratio" "rc-cost $contact --depths 0 rough.rcg"
refuses 1 'one case' "a picture of two cases" "rc-cost $contact --limit 1s --method pcg --kernel fft --plot two.png rough.rcg rough.rcg"

# ---- limits and signals ----

rc-synth sphere --nx 96 --dx 5um --radius 7.5mm -o ball.rcg
claim "what would not fit into --limit is left out, and named" bash -c '
    rc-synth sphere --nx 200 --dx 5um --radius 7.5mm |
        rc-cost --load 20N --estar 114GPa --kernel direct --limit 3s >short.txt &&
    [ "$(grep -c "^# pcg, direct, .*: left out: it would take about .* left of --limit" short.txt)" = 3 ]'
claim "--dry-run says how long it would take, and does nothing" bash -c '
    rc-cost --load 20N --estar 114GPa --dry-run --plot dry.png ball.rcg >dry.txt &&
    grep -q "ways to solve 96 x 96 nodes, about .* s after .* s for the reference" dry.txt && [ ! -e dry.png ]'
interrupted() {
    local tool status
    rc-cost --load 20N --estar 114GPa --quiet --limit 5min --kernel fft,direct ball.rcg >cut.txt &
    tool=$!
    sleep 1.5
    kill -TERM "$tool"
    wait "$tool"
    status=$?
    [ "$status" = 143 ] && rows cut.txt | grep -q '^pcg' && ! pgrep -P "$tool"
}
claim "a signal ends it with the table of what was measured" interrupted

# ---- Hertz: radius 7.5 mm, E* 114 GPa, 20 N; a^3 = 3 P R / 4 E*, p0 = 3 P / 2 pi a^2, approach a^2 / R ----

rc-cost --load 20N --estar 114GPa --method pcg --kernel fft,mlms -o hertz.txt ball.rcg
figure() {
    sed -n "s/^# reference:.*$1 \([0-9.e+-]*\) $2.*/\1/p" hertz.txt
}
near "$(figure 'contact area' m2)" 3.113974e-08 0.03 "the reference's contact area is Hertz's, to the order of the grid"
near "$(figure 'largest pressure' Pa)" 9.633992e+08 0.01 "its largest pressure is Hertz's"
near "$(figure approach m)" 1.321612e-06 0.01 "its approach is Hertz's"

# Block means of a paraboloid are that paraboloid on the coarse nodes, but for a constant.
coarse_sphere() {
    rc-synth sphere --nx 48 --dx 10um --radius 7.5mm |
        rc-solve --load 20N --estar 114GPa --tol 1e-3 --output pressure --quiet -o half.rcg &&
        rc-solve --load 20N --estar 114GPa --tol 1e-12 --kernel fft64 --output pressure --quiet -o fine.rcg ball.rcg &&
        values half.rcg 2304 >half.txt && values fine.rcg 9216 >fine.txt &&
        awk 'NR == FNR { c[NR - 1] = $1; next }
             { k = FNR - 1; d = c[int(int(k / 96) / 2) * 48 + int(k % 96 / 2)] - $1
               s += d < 0 ? -d : d; t += $1 } END { printf "%.6g\n", s / t }' half.txt fine.txt >coarse.txt
}
claim "a sphere on half the nodes can be solved apart" coarse_sphere
near "$(awk '$5 == "48x48" && $4 == "1e-03" { print $11 }' hertz.txt)" "$(cat coarse.txt)" 0.006 \
    "the error of a coarser grid is that of the same sphere on fewer nodes, spread over its cells"
claim "pcg with mlms is as near as asked for" bash -c "
    awk '\$1 == \"pcg\" && \$2 == \"mlms\" { n++; if (\$11 > \$4) bad = 1 } END { exit bad || n != 5 }' hertz.txt"

# ---- Westergaard 1939: a wave in plane strain, p* = pi E* amplitude / wavelength, mean p* sin^2(pi a / wavelength) ----

rc-synth wave --nx 512 --ny 1 --dx 1um --amplitude 1um --wavelength 512um -o wave.rcg
wave_mean=$(awk 'BEGIN { pi = atan2(0, -1); s = sin(pi * 0.3 / 2); printf "%.9g", pi * 100e9 * 1e-6 / 512e-6 * s * s }')
rc-cost --periodic --mean-pressure "$wave_mean" --estar 100GPa --method pcg --kernel fft -o wave.txt wave.rcg
near "$(sed -n 's/.*(\([0-9.]*\) % of the map.*/\1/p' wave.txt)" 30 0.01 "a wave is in contact where Westergaard says, to a node"

# ---- stresses ----

rc-synth sphere --nx 50 --ny 46 --dx 8um --radius 7.5mm -o small.rcg
rc-cost --load 40N --estar 114GPa --nu 0.3 --depths 30um --method pcg --kernel fft64 --quiet -o stress.txt small.rcg
stress_again() {
    rc-solve --load 40N --estar 114GPa --tol 1e-12 --kernel fft64 --output pressure --quiet -o p.rcg small.rcg
    for component in sxx syy szz sxy sxz syz mises; do
        for kernel in direct mlms; do
            rc-stress --nu 0.3 --depths 30um --components $component --kernel $kernel --tol 1e-4 -o s.rcg p.rcg
            values s.rcg 2300 >$kernel.txt
        done
        paste direct.txt mlms.txt
    done >stresses.txt
    values p.rcg 2300 | awk 'NR == FNR { m = $1 > m ? $1 : m; next }
        { d = $1 - $2; d = d < 0 ? -d : d; w = d > w ? d : w } END { printf "%.6g\n", w / m }' - stresses.txt
}
near "$(awk '$1 == "mlms" && $2 == "1e-04" { print $7 }' stress.txt)" "$(stress_again)" 0.006 \
    "the error of mlms' stresses is their distance from direct sums"
claim "fft and direct give the same stresses to rounding" bash -c "
    awk '\$1 == \"direct\" { n++; if (\$7 > 1e-13) bad = 1 } END { exit bad || n != 1 }' stress.txt"
claim "no stress is farther off than asked for" bash -c "
    awk 'on && NF == 10 && \$2 > 0 && \$7 != \"nan\" { n++; if (\$7 > \$2) bad = 1 } /^kernel/ { on = 1 }
         END { exit bad || n != 7 }' stress.txt"

finish
