# SPDX-License-Identifier: GPL-3.0-or-later
# rc-solve is killed at random moments and restarted with --checkpoint and --resume. The final pressure is the
# same, and every file with a final name is complete. The test also checks files beside that of -o (maps,
# pictures, checkpoints) under signals and on a full disk. RC_KILLS in the environment is the number of kills
# (3), RC_CHAINS that of the chains of each other model (1), RC_SEED the seed of their moments.
. "$RC_SOURCE/tests/pipe.sh"

kills=${RC_KILLS:-3}
RANDOM=${RC_SEED:-7}
export RC_THREADS=1
rc-synth selfaffine --nx 320 --ny 250 --dx 1um --hurst 0.8 --rms-slope 0.1 --short-cut 8um --rolloff 40um --seed 3 -o rough.rcg
tolerance=1e-9
solve="rc-solve --periodic --estar 1GPa --load 0.2N:0.4N:2 --method pk99 --tol $tolerance --output pressure"
began=$(date +%s%N)
claim "the undisturbed solution is computed" $solve -o right.rcg rough.rcg
milliseconds=$((($(date +%s%N) - began) / 1000000))

# distance A B: the relative L1 distance of the frames of two streams, the largest of all cases.
distance() {
    perl -e '
        sub frames {
            local $/; open my $f, "<:raw", $_[0] or die; my $s = <$f>; my @frames;
            while ($s =~ /\G(RCG1\n.*?\n\n)/gcs) {
                my ($head, $at) = ($1, pos $s);
                my ($nx) = $head =~ /^nx=(\d+)/m; my ($ny) = $head =~ /^ny=(\d+)/m;
                push @frames, [unpack "d<*", substr $s, $at, 8 * $nx * $ny];
                pos($s) = $at + 8 * $nx * $ny; $s =~ /\Gcrc32 \w+\n/gc;
            }
            return @frames;
        }
        my @a = frames($ARGV[0]); my @b = frames($ARGV[1]); die if @a != @b || !@a; my $worst = 0;
        for my $f (0 .. $#a) {
            my ($off, $all) = (0, 0);
            for (0 .. $#{$a[$f]}) { $off += abs $a[$f][$_] - $b[$f][$_]; $all += abs $b[$f][$_] }
            $worst = $off / $all if $off / $all > $worst;
        }
        print $worst' "$1" "$2"
}

# Every file except the checkpoint and temporary files is complete: a stream that can be read to its end.
whole_files() {
    local f
    for f in out.rcg; do [ ! -e $f ] || rc-info --quiet $f >/dev/null || return 1; done
    rm -f out.rcg.??????
}

killed=0
finished=0
starts=0
wrong=0
rm -f out.rcg kept.rcg
while [ $killed -lt "$kills" ] && [ $starts -lt $((20 * kills)) ]; do
    starts=$((starts + 1))
    $solve --quiet --checkpoint kept.rcg --resume --interval 0.01 -o out.rcg rough.rcg 2>kill.err &
    pid=$!
    sleep "$(awk -v ms="$milliseconds" -v r=$RANDOM 'BEGIN { print ms / 1000 * r / 32768 * 0.7 }')"
    if kill -KILL $pid 2>/dev/null; then
        wait $pid 2>/dev/null
        if [ $? = 137 ]; then killed=$((killed + 1)); fi
    else
        wait $pid || wrong=$((wrong + 1))
    fi
    whole_files || wrong=$((wrong + 1))
    if [ -e out.rcg ]; then # the run was complete: another one starts from the beginning
        finished=$((finished + 1))
        awk -v d="$(distance out.rcg right.rcg)" -v t=$tolerance 'BEGIN { exit !(d != "" && d <= 2 * t) }' ||
            wrong=$((wrong + 1))
        rm -f out.rcg kept.rcg
    fi
done
claim "$killed kills in $starts runs, $finished runs finished: no error" \
    bash -c "[ $killed = $kills ] && [ $wrong = 0 ]"
claim "a last run continues to the end" $solve --quiet --checkpoint kept.rcg --resume -o out.rcg rough.rcg
between 0 "$(distance out.rcg right.rcg)" "$(awk -v t=$tolerance 'BEGIN { print 2 * t }')" "to the same pressure"

# two: starts a run that would write to the checkpoint of a running one.
two() {
    local pid status
    rm -f two.rcg
    $solve --quiet --tol 1e-30 --checkpoint two.rcg --interval 0.01 -o one.rcg rough.rcg &
    pid=$!
    until [ -s two.rcg ] || ! kill -0 $pid; do sleep 0.005; done
    kill -STOP $pid # the kill may have come inside the first frame
    $solve --quiet --checkpoint two.rcg --resume -o other.rcg rough.rcg 2>two.err
    status=$?
    kill -KILL $pid
    wait $pid 2>/dev/null
    [ $status = 1 ] && grep -q 'two.rcg: another run is writing to it' two.err && [ ! -e other.rcg ] &&
        $solve --quiet --checkpoint two.rcg --resume -o other.rcg rough.rcg
}
claim "two runs cannot write to one checkpoint; after the first is killed the other can" two

# ---- chains: other models end with the same bits ----

# chain NAME COMMAND...: kills the command at random moments until it has finished; its frames are those of a run
# without kills, to the bit. RC_CHAINS in the environment is the number of chains of each command (1).
chain() {
    local name=$1 k began ms status runs wrong=0
    shift
    began=$(date +%s%N)
    "$@" --quiet -o chain_right.rcg 2>chain.err || [ $? = 3 ] || { cat chain.err; return 1; }
    ms=$((($(date +%s%N) - began) / 1000000))
    for ((k = 0; k < ${RC_CHAINS:-1}; k++)); do
        rm -f chain.rcg chain_kept.rcg
        status=1
        for ((runs = 0; runs < 60 && status != 0 && status != 3; runs++)); do
            "$@" --quiet --checkpoint chain_kept.rcg --resume --interval 0.003 -o chain.rcg 2>chain.err &
            pid=$!
            sleep "$(awk -v ms=$ms -v r=$RANDOM -v n=$runs 'BEGIN { print ms / 1000 * r / 32768 * (0.6 + n * n / 40) }')"
            kill -KILL $pid 2>/dev/null
            wait $pid 2>/dev/null
            status=$?
            case $status in 0 | 3 | 137) ;; *) break ;; esac
        done
        if [ ! -e chain.rcg ] || [ "$(distance chain.rcg chain_right.rcg)" != 0 ]; then
            wrong=$((wrong + 1))
            [ $wrong -gt 3 ] || echo "    chain $k of $name: status $status, $(cat chain.err)" >&2
        fi
    done
    echo "    $name: $wrong of ${RC_CHAINS:-1} chains differ"
    [ $wrong = 0 ]
}
rc-synth sphere --nx 64 --dx 1um --radius 0.5mm -o ball.rcg
rc-synth selfaffine --nx 48 --dx 1um --hurst 0.8 --rms-slope 0.05 --seed 5 -o small.rcg
rc-solve --quiet --estar 1GPa --load 2mN -o pressed.rcg ball.rcg
rc-solve --quiet --periodic --estar 1GPa --load 2mN -o worn.rcg small.rcg
claim "rc-slip --steady" \
    chain "rc-slip --steady" rc-slip --nu 0.3 --mu 0.3 --creep 1e-3,5e-4 --steady --tol 1e-6 pressed.rcg
claim "rc-slip --path" \
    chain "rc-slip --path" rc-slip --nu 0.3 --mu 0.3 --path '2mN,0.1mN,0; 2mN,0.3mN,0; 2mN,-0.2mN,0' pressed.rcg
claim "rc-wear" chain rc-wear rc-wear --coefficient 1e-12m2/N --distance 1mm,10mm worn.rcg
claim "rc-solve --time" chain "rc-solve --time" rc-solve --relaxation 100MPa,900MPa:1s --nu1 0.3 --E2 rigid \
    --periodic --load 2mN,2mN --time 0s,3s small.rcg

# ---- beside -o ----

rc-synth selfaffine --nx 700 --ny 700 --dx 1um --hurst 0.8 --rms-slope 0.1 --seed 3 -o large.rcg
# maps SIGNAL: stops rc-info --psd-map while it writes the map.
maps() {
    rm -f map.rcg*
    rc-info --psd --psd-map map.rcg $(yes large.rcg | head -n 30) >/dev/null &
    until ls map.rcg.?????? >/dev/null 2>&1 || ! kill -0 $!; do sleep 0.005; done
    kill -"$1" $!
    wait $! 2>/dev/null
    [ $? -gt 128 ] && [ -z "$(ls map.rcg* 2>/dev/null)" ]
}
for signal in TERM HUP; do # in a background job of a shell SIGINT is ignored
    claim "rc-info --psd-map: $signal leaves no part of the map" maps $signal
done
# costs: stops rc-cost, whose trials are other processes, at random moments.
costs() {
    local k wrong=0
    rc-synth wave --nx 16 --dx 1um --amplitude 10nm --wavelength 8um -o wave.rcg
    for ((k = 0; k < 3 + kills / 2; k++)); do
        rm -f plot.png cost.txt
        rc-cost --quiet --plot plot.png -o cost.txt wave.rcg -- rc-solve --periodic --load 1mN --estar 1GPa &
        sleep "$(awk -v r=$RANDOM 'BEGIN { print 0.6 * r / 32768 }')"
        kill -TERM $! 2>/dev/null
        wait $!
        case $? in 0 | 143) ;; *) wrong=$((wrong + 1)) ;; esac
        [ -z "$(ls plot.png.* cost.txt.* 2>/dev/null)" ] || wrong=$((wrong + 1))
        [ ! -e plot.png ] || [ "$(tail -c 8 plot.png | cut -c1-4 | head -n 1)" = IEND ] || wrong=$((wrong + 1))
    done
    return $wrong
}
claim "rc-cost, stopped at random moments, leaves no half-written file" costs
claim "a new map replaces the old one" bash -c '
    echo old >map.rcg && rc-info --psd --psd-map map.rcg rough.rcg && rc-info map.rcg'
refuses 2 'rc-solve: --checkpoint -: .*give a file name' "a checkpoint is not a pipe" \
    "rc-solve --estar 1GPa --load 0.1N --checkpoint - -o x.rcg rough.rcg"
refuses 2 'rc-cost: --plot -: a picture is' "a plot has to say what it is" \
    "rc-cost --plot - rough.rcg -- rc-solve --estar 1GPa --load 0.1N"
refuses 2 'rc-info: --psd-map -: ' "a map of waves is not a pipe" "rc-info --psd --psd-map - rough.rcg"
claim "no file has the name -" test ! -e -
