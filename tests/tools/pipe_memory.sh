# What the allocator counts is the tool's peak within a tenth and the code; a run that needs more than --memory allows, or than the
# machine grants, is refused before the work; and the peak in a report is the tool's own.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/symbols.sh"

skip_with_address_sanitizer "it takes memory of its own"

# estimated "sentence" 'shell command': its last tool, with --verbose, here --debug, takes the memory that is counted,
# but for code, plans and stacks of threads, 7 MiB.
estimated() {
    local counted taken
    bash -c "${2//--verbose/--debug}" 2>&1 >/dev/null | grep 'memory: ' | tail -n 1 >memory.txt
    read -r _ _ counted _ _ taken _ <memory.txt
    claim "$1: ${counted:-none} MiB counted, ${taken:-none} taken" awk -v c="$counted" -v t="$taken" \
        'BEGIN { exit !(c > 0 && c <= 1.1 * t && c >= 0.9 * t - 7) }'
}

rough="selfaffine --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 100um --short-cut 6um"
rc-synth $rough --nx 256 -o small.rcg
rc-synth $rough --nx 517 --ny 389 -o odd.rcg
load="--estar 3GPa --mean-pressure 100MPa"
coat="--layer 5um,200GPa,0.3 --E1 70GPa --nu1 0.3 --E2 rigid --mean-pressure 100MPa"
rc-solve --quiet $load odd.rcg -o free.rcg --report free.json
rc-solve --quiet --periodic $load odd.rcg -o round.rcg

rc-synth sphere --radius 1mm --dx 1um --nx 512 -o sphere.rcg
rc-solve --quiet --estar 3GPa --load 1mN --output pressure sphere.rcg -o sparse.rcg

# ---- counted ----

estimated "rc-synth" "rc-synth --verbose $rough --nx 517 --ny 389"
estimated "rc-synth, skewed" "rc-synth --verbose $rough --skewness 0.7 --nx 517 --ny 389"
estimated "rc-solve" "rc-solve --verbose $load odd.rcg"
estimated "rc-solve, periodic" "rc-solve --verbose --periodic $load odd.rcg"
estimated "rc-solve, small" "rc-solve --verbose $load small.rcg"
estimated "rc-solve --kernel fft64" "rc-solve --kernel fft64 --verbose $load small.rcg"
estimated "rc-solve --kernel mlms" "rc-solve --kernel mlms --verbose $load small.rcg"
estimated "rc-solve, a coating" "rc-solve --verbose $coat small.rcg"
estimated "rc-solve --stiffness --hardness" "rc-solve --verbose --stiffness --hardness 300MPa $load odd.rcg"
estimated "rc-solve --conductivity" "rc-solve --verbose --conductivity 45,16 $load odd.rcg"
estimated "rc-solve --conductivity, periodic" "rc-solve --verbose --periodic --conductivity 45,16 --output pressure $load odd.rcg"
estimated "rc-solve --history" "rc-solve --verbose --estar 3GPa --hardness 300MPa --history --mean-pressure 50MPa,100MPa small.rcg"
estimated "rc-solve, a second map" "rc-solve --verbose $load small.rcg small.rcg"
estimated "rc-solve --method pk99" "rc-solve --verbose --method pk99 --tol 1e-2 $load odd.rcg"
rc-solve --quiet --estar 3GPa --mean-pressure 50MPa --checkpoint kept.rcg odd.rcg -o first.rcg
estimated "rc-solve --resume, a load there and one to come" "rc-solve --verbose --estar 3GPa --mean-pressure 50MPa,100MPa --checkpoint kept.rcg --resume odd.rcg"
estimated "rc-deflect" "rc-deflect --verbose --estar 3GPa free.rcg"
estimated "rc-deflect --kernel mlms" "rc-deflect --verbose --kernel mlms --estar 3GPa free.rcg"
estimated "rc-stress" "rc-stress --verbose --nu 0.3 --depths 1um,5um,50um free.rcg"
estimated "rc-stress, periodic, with friction" "rc-stress --verbose --nu 0.3 --mu 0.2 --depths 1um,5um round.rcg"
estimated "rc-stress --section" "rc-stress --verbose --nu 0.3 --section y=0 --depths 0:50um:20 free.rcg"
estimated "rc-info" "rc-info --verbose odd.rcg"
estimated "rc-info --psd-map" "rc-info --psd-map psd.rcg --verbose odd.rcg"
estimated "rc-info --patches" "rc-info --patches --verbose free.rcg"
estimated "rc-detrend" "rc-detrend --plane --outliers 4 --fill --lowpass 20um --verbose odd.rcg"
estimated "rc-detrend --mirror" "rc-detrend --plane --mirror --verbose odd.rcg"
estimated "rc-pick" "rc-pick --rotate 90 --resample 0.7um --verbose odd.rcg"
estimated "rc-add" "rc-add --verbose odd.rcg odd.rcg"
for format in x3p npy csv; do
    rc-export --format $format -o odd.$format odd.rcg
    estimated "rc-export --format $format" "rc-export --format $format --verbose odd.rcg"
    estimated "rc-import of that" "rc-import --verbose --dx 1um --z-unit m odd.$format"
done
perl "$RC_SOURCE/tests/tools/made_maps.pl" park 1024 700 >made.park
rc-synth cone --slope 0.01 --dx 1um --nx 3000 -o large.rcg
for format in svg pdf; do
    rc-render --debug large.rcg -o large.$format 2>memory.txt
    claim "rc-render of a large map, $format, within 1.5 maps of memory" awk '/memory: / { exit !($6 < 1.5 * 3000 * 3000 * 8 / 1048576) }' memory.txt
done
rm large.*
rc-stress --quiet --nu 0.3 --components mises --depths 1um,5um,10um,20um free.rcg -o depths.rcg
awk 'BEGIN { print "x/m\ty/m"; for (k = 0; k < 100000; k++) printf "%de-6\t%.6f\n", k, sin(k / 3000) }' >long.tsv

# ---- what the report and the plan say ----

near "$(field memory_estimate free.json)" "$(field peak_memory free.json)" 0.25 "the report has both"
rc-solve --dry-run $load odd.rcg >plan.txt 2>/dev/null
near "$(awk -v mib="$(sed -n 's/.*, \([0-9]*\) MiB, .*/\1/p' plan.txt)" 'BEGIN { print mib * 1048576 }')" "$(field peak_memory free.json)" 0.15 "and in the plan, in MiB"

# A process of a gibibyte that starts the tool: of what getrusage says the tool inherits that.
cat >large.pl <<'P'
my $held = "x" x (1 << 30);
my $pid = fork;
exec @ARGV if $pid == 0;
waitpid $pid, 0;
exit($? >> 8 | (length $held) - (1 << 30));
P
claim "a large process starts the tool" perl large.pl rc-solve --quiet $load odd.rcg -o again.rcg --report again.json
near "$(field peak_memory again.json)" "$(field peak_memory free.json)" 0.1 "its peak is its own"

# ---- refused ----

mpi=0 # KiB: MPI's library takes some of what is allowed
with_mpi && mpi=1000
more="[0-9]+ MiB, --memory allows 20 MiB: "
refuses 1 "$more" "rc-solve: more than --memory" "rc-solve --memory 20M $load odd.rcg -o never.rcg"
refuses 1 "$more" "rc-stress" "rc-stress --memory 20M --nu 0.3 --depths 5um free.rcg -o never.rcg"
refuses 1 "--kernel mlms needs less" "another engine is named where it fits" "rc-deflect --estar 3GPa --memory $((14500 + mpi))K --kernel fft64 free.rcg -o never.rcg"
refuses 1 "[0-9.]+ MiB, --memory allows [0-9]+ MiB: " "rc-pick" "rc-pick --memory $((6500 + mpi))K --rotate 90 odd.rcg -o never.rcg"
refuses 1 "[0-9.]+ MiB, --memory allows 6 MiB" "rc-info --areal" "rc-info --memory 6M --areal odd.rcg"
refuses 1 "[0-9.]+ MiB, --memory allows 6 MiB" "rc-detrend" "rc-detrend --memory 6M --lowpass 20um odd.rcg -o never.rcg"
refuses 1 "[0-9.]+ MiB, --memory allows 11 MiB" "rc-export" "rc-export --memory 11M --format x3p odd.rcg -o never.x3p"
refuses 1 "[0-9.]+ MiB, --memory allows 17 MiB: .*rc-pick" "rc-render --sheet" "rc-render --memory 17M --sheet auto depths.rcg -o never.png"
refuses 1 "[0-9]+ MiB, --memory allows 12 MiB: give fewer rows" "rc-render --curve" "rc-render --memory 12M --curve x:y long.tsv -o never.png"
refuses 1 "[0-9.]+ MiB, --memory allows 24 MiB: the file itself takes memory too" "rc-import, for the process that reads the file" "rc-import --memory 24M made.park -o never.rcg"
refuses 1 "[0-9.]+ MiB, --memory allows 8 MiB" "rc-synth" "rc-synth --memory 8M $rough --nx 1024 -o never.rcg"
refuses 1 "[0-9.]+ MiB, --memory allows 5 MiB" "a frame that is read" "rc-info --memory 5M odd.rcg"
claim "nothing is left behind" bash -c '! ls never* 2>/dev/null'
claim "what is allowed is done" rc-solve --quiet --memory 60M $load odd.rcg -o done.rcg

machine=$(awk '/^MemAvailable:|^SwapFree:/ { sum += $2 } END { printf "%.0f", sum / 8 * 1024 }' /proc/meminfo)
side=$(awk -v n="$machine" 'BEGIN { printf "%d", sqrt(n) * 1.2 }')
refuses 1 "need about [0-9.]+ [MG]iB( more)?, (the machine has|the group of processes \(cgroup\) leaves) [0-9.]+ [MG]iB: take fewer|is more than this machine can address" "more than the machine has" \
    "rc-synth sphere --radius 1m --dx 1um --nx $side -o never.rcg"
refuses 1 "need about [0-9.]+ [MG]iB( more)?, the limit of address space \(ulimit -v\) leaves [0-9]+ MiB" "more than ulimit -v" \
    "ulimit -v 200000; rc-synth sphere --radius 1m --dx 1um --nx 8000 -o never.rcg"

# A group of our own, where we may make one.
group_under() {
    local mount=$1 path=$2 bound=$3
    group=$mount$path/rc-memory-$$
    mkdir "$group" 2>/dev/null || return 1
    echo $((40 << 20)) >"$group/$bound" 2>/dev/null || {
        rmdir "$group"
        return 1
    }
}
group=
path1=$(sed -n 's/^[0-9]*:memory://p' /proc/self/cgroup)
path2=$(sed -n 's/^0:://p' /proc/self/cgroup)
if group_under /sys/fs/cgroup/memory "$path1" memory.limit_in_bytes || group_under /sys/fs/cgroup "$path2" memory.max; then
    refuses 1 "need about [0-9.]+ [MG]iB( more)?, the group of processes \(cgroup\) leaves [0-9]+ MiB" "more than a group may take" \
        "(echo \$BASHPID >$group/cgroup.procs; exec rc-synth sphere --radius 1m --dx 1um --nx 4000 -o never.rcg)"
    claim "what it may is done" bash -c "(echo \$BASHPID >$group/cgroup.procs; exec rc-synth sphere --radius 1m --dx 1um --nx 1000 -o done.rcg)"
    rmdir "$group"
else
    echo "no group of processes can be made here: tests/tools/truth_memory_room.c reads made ones"
fi

finish
