# SPDX-License-Identifier: GPL-3.0-or-later
# Under mpirun rc-solve, rc-deflect and rc-stress write the same bytes as one process; their report counts the
# communication. If one process fails all end, with one message and without an incomplete file. RC_RANKS: the
# numbers of processes to compare with one, by default "2".
. "$(dirname "$0")/../pipe.sh"
export RC_THREADS=1
ranks=${RC_RANKS:-2}

rc-synth selfaffine --nx 200 --ny 187 --dx 1um --hurst 0.8 --rms-slope 0.1 --short-cut 8um --seed 3 -o rough.rcg
rc-pick --set source=rough.x3p rough.rcg | rc-pick --resample 0.7um -o fine.rcg
cat rough.rcg fine.rcg >two.rcg
# A sphere in single precision, on a map with more columns than rows.
rc-synth sphere --nx 300 --ny 33 --dx 5um --radius 7.5mm --type f32 -o sphere.rcg

# same NAME "shell command without -o": 1 process and each other number of processes write the same.
same() {
    local name=$1 command=$2 n
    bash -c "$command -o alone.rcg" || return
    for n in $ranks; do
        $MPIRUN -n "$n" bash -c "$command -o shared.rcg" || return
        cmp alone.rcg shared.rcg || return
    done
}
claim "a periodic list of loads with hardness gives the bits of one process" same loads \
    "rc-solve --periodic --estar 1GPa --hardness 60MPa --load 0.1N,0.5N --quiet rough.rcg"
claim "two cases of a free map with an approach and a sphere do" same approach \
    "rc-solve --estar 1GPa --approach 1um --radius 1mm --tol 1e-5 --quiet two.rcg"
claim "a loading history with separation and the plastic shape does" same history \
    "rc-solve --periodic --estar 1GPa --hardness 40MPa --tol 1e-3 --load 0.3N,0.1N,0,0.4N --history --output pressure,plastic,gap --quiet rough.rcg"
claim "layers, single precision and the method of the paper do" same layers \
    "rc-solve --E1 2GPa --nu1 0.3 --layer 20um,8GPa,0.2 --E2 rigid --load 0.2N --method pk99 --tol 1e-4 --type f32 --quiet sphere.rcg"
rc-solve --estar 114GPa --load 20N --quiet sphere.rcg -o pressed.rcg
# Lines longer than the block that is fetched from other ranks at a time: the figures are also the same.
rc-synth selfaffine --nx 2100 --ny 48 --dx 1um --hurst 0.8 --rms-slope 0.1 --short-cut 8um --seed 3 -o lines.rcg
figures() {
    local n solve
    solve="rc-solve --periodic --estar 1GPa --load 0.05N --tol 1e-4 --discretization"
    $solve --report 1.json -o 1.rcg lines.rcg 2>1.err && $MPIRUN -n 2 $solve --report 2.json -o 2.rcg lines.rcg 2>2.err || return
    cmp 1.rcg 2.rcg && cmp 1.err 2.err || return
    for n in contact_area max_pressure contact_area_corrected mean_gap approach pressure_error_estimate; do
        [ "$(grep -o "\"$n\": [^,}]*" 1.json)" = "$(grep -o "\"$n\": [^,}]*" 2.json)" ] || return
    done
}
claim "long lines give the figures of one process" figures
claim "displacements are those of one process" same deflect "rc-deflect --kernel fft pressed.rcg"
claim "stresses at given depths, with friction, are those of one process" same stress \
    "rc-stress --nu 0.3 --mu 0.2 --depths 0,10um,50um --components mises,s1 pressed.rcg"
for axis in x y; do
    rc-pick --set boundary=periodic-$axis -o line.rcg pressed.rcg
    claim "  on a map that repeats along $axis" same lines "rc-stress --nu 0.3 --mu 0.2 --depths 0,10um,50um,400um --tol 1e-3 --components mises,s1 line.rcg"
done
pressure() { # prints a frame of this channel without the end line
    rc-pick --channel pressure pressed.rcg | sed "s/^channel=pressure\$/channel=$1/" | reseal | perl -0777 -pe 's/RCGEND 1\n//'
}
{ pressure pressure && pressure traction-x && pressure traction-y && echo RCGEND 3; } >dragged.rcg
claim "stresses under tractions are those of one process" same tractions "rc-stress --nu 0.3 --depths 0,10um,50um --components mises,syz dragged.rcg"
claim "stresses at automatic depths are those of one process" same depths "rc-stress --nu 0.3 --depths auto --components szz --quiet pressed.rcg"

# ---- reports ----

run() { $MPIRUN -n 2 "$@"; }
rc-synth wave --nx 254 --ny 256 --dx 1um --wavelength 127um --amplitude 1um | rc-pick --set channel=height -o wave.rcg
rc-solve --periodic --estar 1GPa --mean-pressure 20MPa --quiet wave.rcg -o wave-pressed.rcg
claim "the report counts the communication between processes" run rc-stress --nu 0.3 --depths 0,1um --components szz \
    --report sent.json -o sent.rcg wave-pressed.rcg
# contact-mpi(7): 16 bytes a wave, 128 waves a row, 256 rows, half of them for the other process. One exchange
# for the pressure and one for each of two depths make three exchanges of 2 messages each
near "$(field exchanges sent.json)" 3 1e-15 "exchanges"
near "$(field messages sent.json)" 6 1e-15 "messages"
near "$(field bytes_exchanged sent.json)" $((3 * 16 * 128 * 256 / 2)) 1e-15 "bytes"
near "$(field ranks sent.json)" 2 1e-15 "ranks"
claim "a report on standard output is written once" says '^1$' bash -c \
    "$MPIRUN -n 2 rc-solve --estar 1GPa --load 0.1N --tol 1e-2 --quiet --report - rough.rcg | grep -c contact_nodes"
claim "the memory of --debug is printed once" says '^1$' bash -c \
    "$MPIRUN -n 2 rc-solve --estar 1GPa --load 0.1N --tol 1e-2 --debug -o told.rcg rough.rcg 2>&1 | grep -c 'memory: .* counted'"

# Communication and memory of a contact as in contact-mpi(7): 32 bytes a wave for each equivalent convolution.
# Up to 5 % for spectra; 83 bytes a node, and at most 40 MiB more.
if [ "$ranks" != 2 ]; then
    rc-synth selfaffine --nx 1024 --ny 1024 --dx 1um --hurst 0.8 --rms-slope 0.1 --short-cut 8um --seed 3 -o large.rcg
    for n in $ranks; do
        claim "1024 x 1024 nodes on $n processes give the figures of one" $MPIRUN -n "$n" rc-solve --periodic --estar 1GPa --mean-pressure 20MPa --tol 1e-4 \
            --quiet --report large.json -o large-out.rcg large.rcg
        waves=$(awk -v n="$n" -v c="$(field convolutions large.json)" 'BEGIN { print 32 * c * 1024 * 513 * (1 - 1 / n) }')
        between "$waves" "$(field bytes_exchanged large.json)" "$(awk -v w="$waves" 'BEGIN { print 1.07 * w }')" "  bytes"
        each=$(awk -v n="$n" 'BEGIN { print 83 * 1024 * 1024 / n }')
        between "$each" "$(field peak_memory large.json)" "$(awk -v e="$each" 'BEGIN { print e + 40 * 1048576 }')" "  memory of a rank"
    done
fi

# estimated "sentence" command...: the expected memory of the fullest rank is within a tenth of its peak.
estimated() {
    local sentence=$1
    shift
    run "$@" --quiet --report estimate.json -o estimate.rcg
    near "$(field memory_estimate estimate.json)" "$(field peak_memory estimate.json)" 0.1 "$sentence"
}
rough="selfaffine --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 100um --short-cut 6um"
if ! nm -D "$(command -v rc-solve)" 2>/dev/null | grep -q __asan; then # which needs additional memory
    rc-synth $rough --nx 1200 --ny 1100 -o even.rcg
    rc-synth $rough --nx 30000 --ny 48 -o wide.rcg # 16 rows of the first rank, 32 of the second
    press="rc-solve --estar 3GPa --mean-pressure 20MPa --tol 1e-2 --output pressure"
    estimated "memory of two: rc-solve --stiffness" $press --stiffness even.rcg
    if before_release; then
        estimated "  periodic, gaps and heights" $press --periodic --output pressure,gap,height --stiffness even.rcg
        mv estimate.rcg even-pressed.rcg
        estimated "  rc-stress" rc-stress --nu 0.3 --depths 1um,5um --components mises even-pressed.rcg
    fi
    estimated "  rc-solve, where one has twice the rows of the other" $press --periodic wide.rcg
    mv estimate.rcg wide-pressed.rcg
    estimated "  rc-stress, the same" rc-stress --nu 0.3 --depths 1um,5um --components mises wide-pressed.rcg
    run rc-deflect --debug --estar 3GPa -o estimate.rcg wide-pressed.rcg 2>&1 | grep memory: >memory.txt
    read -r _ _ expected _ _ taken _ <memory.txt
    near "${expected:-none}" "${taken:-none}" 0.1 "  rc-deflect"
fi

# ---- checkpoints ----

solve="rc-solve --periodic --estar 1GPa --tol 1e-2 --output pressure --quiet"
claim "two processes write a checkpoint" run $solve --load 0.1N:0.5N:3 --checkpoint kept.rcg -o whole.rcg rough.rcg
claim "  it is that of one process" bash -c "$solve --load 0.1N:0.5N:3 --checkpoint alone-kept.rcg -o alone.rcg rough.rcg && cmp kept.rcg alone-kept.rcg"
for n in 1 3; do
    claim "  resumed by $n processes the result is the same, in one step per case" bash -c "
        cp kept.rcg again-kept.rcg &&
        $MPIRUN -n $n $solve --load 0.1N:0.5N:3 --checkpoint again-kept.rcg --resume --report again.json -o again.rcg rough.rcg &&
        cmp whole.rcg again.rcg && [ \$(grep -c '\"iterations\": 1,' again.json) = 3 ]"
done
claim "two processes repair an incomplete checkpoint like one" bash -c "
    head -c 500000 kept.rcg >torn.rcg && cp torn.rcg alone-torn.rcg &&
    $MPIRUN -n 2 $solve --load 0.1N:0.5N:3 --checkpoint torn.rcg --resume -o torn-out.rcg rough.rcg &&
    $solve --load 0.1N:0.5N:3 --checkpoint alone-torn.rcg --resume -o alone-out.rcg rough.rcg &&
    cmp alone-out.rcg torn-out.rcg && cmp torn.rcg alone-torn.rcg"

rc-pick --crop 0,0,40,37 rough.rcg -o small.rcg 2>/dev/null
anew() {
    local n
    for n in $(seq $(before_release && echo 8 || echo 1)); do
        rm -f new-kept.rcg
        # The second process is slower, so that it checks after the first has made the file. On a busy machine it must
        # still have some time.
        $MPIRUN -n 1 $solve --load 1mN --checkpoint new-kept.rcg --resume -o new.rcg small.rcg : \
            -n 1 nice -n $(before_release && echo 19 || echo 5) $solve --load 1mN --checkpoint new-kept.rcg --resume -o new.rcg small.rcg || return
    done
}
claim "--resume without a file creates one, whichever process is first" anew

# ---- refusals ----

refuses 2 'give -o FILE' "a pipe for output" "$MPIRUN -n 2 rc-solve --estar 1GPa --load 0.1N rough.rcg | cat"
refuses 2 'name one instead of a pipe' "a pipe for input" "$MPIRUN -n 2 rc-solve --estar 1GPa --load 0.1N -o no.rcg"
refuses 1 "needs the map in one process" "an engine that is not shared" \
    "$MPIRUN -n 2 rc-solve --estar 1GPa --load 0.1N --kernel mlms -o no.rcg rough.rcg"
# Every other tool refuses, once, and writes nothing; one process works. Launching takes most of the time, so one launch
# has a process of each tool: the message is printed once only if all refuse. Before a release each tool is launched alone.
others=$(for tool in "$RC_BIN"/rc-*[a-z]; do echo "${tool##*/}"; done | grep -vxE 'rc-(synth|solve|slip|wear|deflect|stress|fatigue|heat)')
# refused "launched tools" ARGUMENTS
refused() {
    local tools=$1 tool launch=
    shift
    for tool in $tools; do launch="${launch:+$launch : }-n 1 $tool $*"; done
    $MPIRUN $launch >alone.out 2>alone.err
    [ $? = 2 ] && [ "$(grep -c 'rc-[a-z]*: rc-[a-z]* cannot share its maps among processes: start one process' alone.err)" = 1 ] &&
        [ ! -s alone.out ] && [ ! -e no.rcg ] || { echo "$tools" && cat alone.err alone.out && return 1; } >&2
}
claim "the other tools refuse several processes, once" refused "$others"
claim "  with a command that one process runs" refused "$others" -o no.rcg rough.rcg
for tool in $(before_release && echo $others); do
    claim "  $tool" refused "$tool $tool" -o no.rcg rough.rcg
done
refuses 2 'start one process, with --threads; rc-pick --crop cuts a smaller map out' "  rc-leak names rc-pick" "$MPIRUN -n 2 rc-leak rough.rcg"
claim "  one process works" says 'height' $MPIRUN -n 1 rc-info rough.rcg
# Two processes on a machine have half of its memory each. The map has 1.2 times this memory, and its file is
# sparse.
rows=$(awk '/^(MemAvailable|SwapFree):/ { free += $2 } END { printf "%d", 1.2 * 1024 * free / 65536 }' /proc/meminfo)
printf 'RCG1\nchannel=pressure\nnx=8192\nny=%d\ndx=1e-06\ndy=1e-06\nunit=Pa\ntype=f64\n\n' "$rows" >sparse.rcg
truncate -s "+$((rows * 65536 + 24))" sparse.rcg
refuses 1 'for each of 2 processes the ' "a part for which a process has too little of the machine's memory" \
    "$MPIRUN -n 2 rc-deflect --kernel fft64 --estar 1GPa -o no.rcg sparse.rcg"
rm sparse.rcg
rc-synth selfaffine --nx 700 --ny 700 --dx 1um --hurst 0.8 --rms-slope 0.1 --seed 3 |
    rc-pick --set channel=pressure --set unit=Pa -o rough-pressed.rcg
refuses 1 "cut a part out" "nor is it advised where memory is short" \
    "$MPIRUN -n 2 rc-deflect --kernel fft64 --estar 1GPa --memory 12M -o no.rcg rough-pressed.rcg"
refuses 1 "a section is computed by one process" "a section" \
    "$MPIRUN -n 2 rc-stress --nu 0.3 --depths 0,1um --section y=0 -o no.rcg wave-pressed.rcg"
if before_release; then
    refuses 1 "a section is computed by one process" "  of a large map: not for its memory" \
        "$MPIRUN -n 2 rc-stress --nu 0.3 --depths 0,1um --section y=0 -o no.rcg rough-pressed.rcg"
    refuses 1 "a section is computed by one process" "  in a plan" \
        "$MPIRUN -n 2 rc-stress --nu 0.3 --depths 0,1um --section y=0 --dry-run wave-pressed.rcg"
    refuses 1 "needs the map in one process" "  an engine that is not shared, in a plan" \
        "$MPIRUN -n 2 rc-stress --nu 0.3 --depths 0,1um --kernel mlms --dry-run pressed.rcg"
fi
claim "a plan for two processes has the expected time" says 'about [0-9]+ MiB, [0-9.e-]+ s with' \
    $MPIRUN -n 2 rc-stress --nu 0.3 --depths 0,1um --tol 1e-3 --dry-run pressed.rcg
claim "  the refusal of unsupported options" grep -q 'coarse_grids *left out: several processes share the map' says.out
refuses 2 'give one of --load' "a wrong command line" "$MPIRUN -n 2 rc-solve --estar 1GPa -o no.rcg rough.rcg"
claim "  is printed once" test "$(grep -c 'give one of' refuses.err)" = 1
refuses 1 'checksum' "a damaged stream" "
    { head -c 200000 rough.rcg; printf X; tail -c +200002 rough.rcg; } >damaged.rcg
    $MPIRUN -n 2 rc-solve --estar 1GPa --load 0.1N -o no.rcg damaged.rcg"
refuses 1 'the stream stops|reading stops short' "one that is cut off" "
    head -c 200000 rough.rcg >short.rcg; $MPIRUN -n 2 rc-solve --estar 1GPa --load 0.1N -o no.rcg short.rcg"
# A NaN in the rows of the second process: column 7 of row 150.
perl -0777 -ne '/^(.*?\n\n)(.*)crc32/s; $v = $2; substr($v, 8 * (200 * 150 + 7), 8) = "\0\0\0\0\0\0\xf8\x7f";
    print "$1${v}crc32 00000000\nRCGEND 1\n"' rough.rcg | reseal >nan.rcg
refuses 1 '1 of 37400 values are NaN or infinite, the first in column 7 of row 150' "NaN in another's rows" \
    "$MPIRUN -n 2 rc-solve --estar 1GPa --load 0.1N -o no.rcg nan.rcg"
claim "  the message is printed once" test "$(grep -c 'are NaN' refuses.err)" = 1
rc-solve --periodic --estar 1e60Pa --mean-pressure 1e58Pa --tol 1e-3 --output pressure --quiet wave.rcg -o huge.rcg
refuses 1 '65024 of 65024 values of mises are too large for single precision' "values too large, in the rows of both" \
    "$MPIRUN -n 2 rc-stress --nu 0.3 --depths 0 --components mises --type f32 -o no.rcg huge.rcg"
claim "  the messages are printed once" test "$(grep -c 'are too large for' refuses.err)" = 1
# The output of the launcher shows which process printed the message. It is the first one if all have agreed,
# else the one that waited for the others.
refuses 1 '^\[[^]]*,0\]<stderr>: ?rc-solve: small.rcg, frame 1: .* --memory allows 100 KiB' \
    "a part for which the second process has no memory ends both at once" \
    "$MPIRUN --tag-output -n 1 rc-solve --estar 1GPa --load 1mN -o no.rcg small.rcg : \
        -n 1 rc-solve --memory 100K --estar 1GPa --load 1mN -o no.rcg small.rcg"
claim "  the message is printed once" test "$(grep -c 'memory allows' refuses.err)" = 1
refuses 3 'not converged' "short of the accuracy: written, with its exit status" \
    "$MPIRUN -n 2 rc-solve --estar 1GPa --load 1mN --tol 1e-30 -o stopped.rcg small.rcg"
claim "  the stream is complete" bash -c 'rc-info stopped.rcg >/dev/null; test $? = 3'
claim "  no process complains that it was ended" bash -c "! grep 'ended by a signal' refuses.err"
# The launcher signals the other process when the first one ends.
shorts() {
    local n
    for n in $(seq 12); do
        $MPIRUN -n 2 rc-solve --estar 1GPa --load 1mN --tol 1e-30 -o stopped.rcg small.rcg 2>shorts.err
        [ $? = 3 ] && ! grep -q 'ended by a signal' shorts.err || { cat shorts.err >&2 && return 1; }
    done
}
! before_release || claim "  nor in twelve more runs" shorts
claim "failed runs leave no file" bash -c '! ls no.rcg* 2>/dev/null'

# If processes are ended from outside, the existing file remains and no part of a new one is left.
rc-synth selfaffine --nx 800 --ny 800 --dx 1um --hurst 0.8 --rms-slope 0.1 --short-cut 8um --seed 3 -o long.rcg
lasting="rc-solve --periodic --estar 1GPa --method pk99 --tol 1e-30 --progress line -o killed.rcg long.rcg"
# begin RANK COMMAND...: starts two processes in the background: $launcher, and $victim the one with this rank.
begin() {
    local rank=$1 child
    shift
    victim=
    echo old >killed.rcg
    $MPIRUN -n 2 "$@" >/dev/null 2>killed.err &
    launcher=$!
    while [ -z "$victim" ] && kill -0 "$launcher"; do
        for child in $(pgrep -P "$launcher" -x rc-solve); do
            ! grep -zqx "\(OMPI_COMM_WORLD\|PMI\)_RANK=$rank" "/proc/$child/environ" || victim=$child
        done
        sleep 0.02
    done
    [ -n "$victim" ]
}
# iterates N: waits until the run has told its progress N times.
iterates() {
    until [ "$(grep -ac iteration killed.err)" -ge "$1" ] || ! kill -0 "$launcher"; do sleep 0.05; done
}
# True if no file is incomplete: after a signal the file may also be the new, marked solution.
nothing_half() {
    [ -z "$(ls killed.rcg.* 2>/dev/null)" ] || return
    [ "$(head -c 100 killed.rcg | tr -d '\0')" = old ] && return
    rc-info --quiet killed.rcg >/dev/null
    [ $? = 3 ] && [ "$1" != killed ]
}
killed() {
    begin 1 $lasting --load 3N || return
    iterates 1
    kill -KILL "$victim"
    wait "$launcher" && return 1
    nothing_half killed
}
claim "a killed process leaves no file" killed
killed_writing() {
    begin "$1" ${lasting/long.rcg/rough.rcg} --tol 1e-2 --load 10mN:0.5N:400 || return
    until ls killed.rcg.?????? >/dev/null 2>&1 || ! kill -0 "$launcher"; do sleep 0.01; done
    kill -KILL "$victim"
    wait "$launcher" && return 1
    nothing_half killed
}
claim "the first process, killed as it writes, leaves none either" killed_writing 0
claim "nor does the second" killed_writing 1
# Another run tries to write to the checkpoint of a running one, which already has a frame.
adding() {
    local status
    begin 1 $lasting --load 3N --checkpoint adding.rcg --interval 0.01 || return
    until [ "$(stat -c %s adding.rcg 2>/dev/null || echo 0)" -gt 6000000 ] || ! kill -0 "$launcher"; do sleep 0.01; done
    $solve --load 3N --checkpoint adding.rcg --resume -o no.rcg long.rcg 2>adding.err
    status=$?
    kill -KILL "$victim"
    wait "$launcher"
    [ $status = 1 ] && grep -q 'adding.rcg: another run is writing to it' adding.err && [ ! -e no.rcg ]
}
claim "two runs cannot write to one checkpoint" adding
# signalled SIGNAL N: sends the signal to mpirun, after N lines of progress. mpirun waits for the time below, ends its processes, and kills
# them some time later.
signalled() {
    begin 1 $lasting --load 3N:12N:10 || return
    iterates "$2"
    kill -"$1" "$launcher"
    wait "$launcher" && return 1
    cat killed.err >&2
    nothing_half signalled && grep -aq '^rc-solve: .*\(interrupted\|ended by a signal\)' killed.err
}
export OMPI_MCA_odls_base_sigkill_timeout=5 # by default 1 s, which may be too short for the message on a busy machine
for signal in TERM INT; do
    for n in $(before_release && echo 1 5 || { [ $signal = TERM ] && echo 5 || echo 1; }); do
        claim "mpirun is ended after $n lines of progress by $signal: there is a message, and no half-written file" signalled $signal $n
    done
done
patient() {
    begin 1 $lasting --load 3N || return
    iterates 3
    kill -TERM $(pgrep -P "$launcher" -x rc-solve) # like a launcher that gives them more time
    wait "$launcher" && return 1
    rc-info --quiet killed.rcg >/dev/null
    [ $? = 3 ] && [ -z "$(ls killed.rcg.* 2>/dev/null)" ]
}
export OMPI_MCA_odls_base_sigkill_timeout=10
claim "with enough time the current result is written" patient
unset OMPI_MCA_odls_base_sigkill_timeout

# One allocation after another fails in the second process. The work is done nevertheless, or all end with
# exit status 1 and a message. No other file is left. short_of N: prints the exit status.
short_of() {
    echo old >short.rcg
    timeout -s KILL 60 $MPIRUN --tag-output -n 1 $short_command : -n 1 env LD_PRELOAD="$RC_FAILING_MALLOC" RC_FAULT_AT="$1" RC_FAULT_COUNT="$PWD/count" \
        $short_command >short.out 2>short.err
}
export ASAN_OPTIONS="${ASAN_OPTIONS-}:verify_asan_link_order=0"
short_command="rc-solve --periodic --estar 1GPa --hardness 60MPa --load 1mN:2mN:2 --discretization --quiet --checkpoint short-kept --resume -o short.rcg small.rcg"
memory() {
    local n last status wrong=0
    rm -f short-kept count
    short_of 0 || {
        echo "without a fault: exit status $?: $(head -c 600 short.err)" >&2
        return 1
    }
    last=$(cat count)
    [ "${last:-0}" -gt 0 ] || {
        echo "no allocation was counted: is $RC_FAILING_MALLOC there?" >&2
        return 1
    }
    for ((n = 1; n <= last; n += ${RC_STRIDE:-$((last / 3 + 1))})); do
        rm -f short-kept
        short_of "$n"
        status=$?
        case $status in
        0) rc-info --quiet short.rcg >/dev/null || { echo "allocation $n: not whole" >&2; wrong=1; } ;; # nor converged=no
        1)
            [ "$(cat short.rcg)" = old ] || { echo "allocation $n: the old file is not as it was" >&2; wrong=1; }
            grep -aq '<stderr>: \?rc-solve: ' short.err || { echo "allocation $n: no message: $(head -c 300 short.err)" >&2; wrong=1; }
            ! grep -aq ',1\]<stderr>: \?rc-solve: .*, frame 1: out of memory' short.err ||
                { echo "allocation $n: the first process waited: $(head -c 300 short.err)" >&2; wrong=1; }
            ;;
        *) echo "allocation $n of $last: exit status $status: $(head -c 300 short.err)" >&2; wrong=1 ;;
        esac
        [ -z "$(ls short.rcg.* 2>/dev/null)" ] || { echo "allocation $n: half of a file is left" >&2; wrong=1; rm -f short.rcg.*; }
    done
    echo "$last allocations" >&2
    return $wrong
}
[ -z "${RC_FAILING_MALLOC-}" ] || claim "allocations of one process fail" memory
