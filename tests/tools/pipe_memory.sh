# SPDX-License-Identifier: GPL-3.0-or-later
# The memory that the allocator counts, with the code, is the peak of the tool within a tenth. A run that
# needs more than --memory allows, or than the machine has, is refused before the work. It is refused at 5 %
# less than the need that the refusal tells, and not at 5 % more. The peak in a report is that of the tool
# itself.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/symbols.sh"

skip_with_address_sanitizer "it takes memory of its own"

# estimated "sentence" 'shell command': the memory of its last tool agrees with the counted one, within a
# tenth or the third argument. --verbose is replaced by --debug.
estimated() {
    local counted taken
    bash -c "${2//--verbose/--debug}" 2>&1 >/dev/null | grep 'memory: ' | tail -n 1 >memory.txt
    read -r _ _ counted _ _ taken _ <memory.txt
    near "${counted:-none}" "${taken:-none}" "${3-0.1}" "$1"
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
estimated "rc-solve --method pk99" "rc-solve --verbose --method pk99 --tol 0.1 $load small.rcg"
rc-solve --quiet --estar 3GPa --mean-pressure 50MPa --checkpoint kept.rcg odd.rcg -o first.rcg
estimated "rc-solve --resume, a load there and one to come" "rc-solve --verbose --estar 3GPa --mean-pressure 50MPa,100MPa --checkpoint kept.rcg --resume odd.rcg"
estimated "rc-deflect" "rc-deflect --verbose --estar 3GPa free.rcg"
estimated "rc-deflect --kernel mlms" "rc-deflect --verbose --kernel mlms --estar 3GPa free.rcg"
estimated "rc-stress" "rc-stress --verbose --nu 0.3 --depths 1um,5um,50um free.rcg"
estimated "rc-stress, periodic, with friction" "rc-stress --verbose --nu 0.3 --mu 0.2 --depths 1um,5um round.rcg"
for axis in x y; do
    rc-pick --set boundary=periodic-$axis --channel pressure -o line-$axis.rcg free.rcg
    estimated "rc-stress, periodic-$axis" "rc-stress --verbose --nu 0.3 --depths 1um,5um,50um line-$axis.rcg"
done
estimated "rc-stress --section" "rc-stress --verbose --nu 0.3 --section y=0 --depths 0:50um:20 free.rcg"
estimated "rc-stress --section, a small contact" "rc-stress --verbose --nu 0.3 --section y=0 --depths 0:50um:20 sparse.rcg"
estimated "rc-info" "rc-info --verbose odd.rcg"
estimated "rc-info --areal" "rc-info --areal --verbose odd.rcg"
estimated "rc-info --psd-map" "rc-info --psd-map psd.rcg --verbose odd.rcg"
estimated "rc-info --patches" "rc-info --patches --verbose free.rcg"
estimated "rc-detrend" "rc-detrend --plane --spikes 4 --outliers 4 --fill --lowpass 20um --verbose odd.rcg"
estimated "rc-detrend --mirror" "rc-detrend --plane --mirror --verbose odd.rcg"
estimated "rc-pick" "rc-pick --rotate 90 --resample 0.7um --verbose odd.rcg"
estimated "rc-add" "rc-add --verbose odd.rcg odd.rcg"
for format in x3p npy csv hdf5; do
    rc-export --format $format -o odd.$format odd.rcg
    estimated "rc-export --format $format" "rc-export --format $format --verbose odd.rcg"
    estimated "rc-import of that" "rc-import --verbose --dx 1um --z-unit m odd.$format"
done
perl "$RC_SOURCE/tests/tools/made_maps.pl" netcdf 1024 700 >made.netcdf
perl "$RC_SOURCE/tests/tools/made_maps.pl" park 1024 700 >made.park
estimated "rc-import of park, by another process" "rc-import --verbose made.park"
estimated "rc-import of netcdf" "rc-import --verbose made.netcdf"
estimated "rc-render" "rc-render --verbose odd.rcg -o map.png"
estimated "rc-render --raw" "rc-render --raw --verbose odd.rcg -o raw.png"
estimated "rc-render --contour" "rc-render --channel pressure --contour --verbose free.rcg -o contact.png"
estimated "rc-render --view" "rc-render --view 30,40 --verbose odd.rcg -o relief.png"
estimated "rc-render --histogram" "rc-render --histogram --verbose odd.rcg -o histogram.svg"
estimated "rc-render --material-ratio" "rc-render --material-ratio --verbose odd.rcg -o ratio.png"
rc-synth cone --slope 0.01 --dx 1um --nx 3000 -o large.rcg
for format in svg pdf; do
    rc-render --debug large.rcg -o large.$format 2>memory.txt
    claim "rc-render draws a large map, $format, within 1.5 maps of memory" awk '/memory: / { exit !($6 < 1.5 * 3000 * 3000 * 8 / 1048576) }' memory.txt
done
rm large.*
rc-stress --quiet --nu 0.3 --components mises --depths 1um,5um,10um,20um free.rcg -o depths.rcg
for format in png pdf; do
    estimated "rc-render --sheet, $format" "rc-render --sheet auto --verbose depths.rcg -o sheet.$format"
done
awk 'BEGIN { print "x/m\ty/m"; for (k = 0; k < 100000; k++) printf "%de-6\t%.6f\n", k, sin(k / 3000) }' >long.tsv

before_release && estimated "rc-cost, with the processes that it starts" "rc-cost --verbose --limit 10s small.rcg -- rc-solve $load"

# ---- numbers of the report and of the plan ----

near "$(field memory_estimate free.json)" "$(field peak_memory free.json)" 0.1 "the report has both"
rc-solve --dry-run $load odd.rcg >plan.txt 2>/dev/null
near "$(awk -v mib="$(sed -n 's/.*, \([0-9]*\) MiB, .*/\1/p' plan.txt)" 'BEGIN { print mib * 1048576 }')" "$(field peak_memory free.json)" 0.08 "and in the plan, in MiB"

# ---- the promise ----

# promised "what" 'command' LIMIT: at the limit, which holds what is read, the refusal tells the memory. 5 %
# less is refused before any iteration too, and 5 % more is enough.
promised() {
    local needs
    needs=$(bash -c "$2 --memory $3 -o never.rcg" 2>&1 >/dev/null | sed -n 's/.* need about \([0-9.]*\) MiB.*/\1/p')
    part() { awk -v a="${needs:-1}" -v f="$1" 'BEGIN { printf "%dk", a * f * 1024 }'; }
    refuses 1 "need about .* MiB, --memory allows" "$1, with 5 % less than ${needs:-none} MiB" "$2 --verbose --memory $(part 0.95) -o never.rcg"
    claim "  before any iteration" bash -c '! grep -E "converged|iterations|convolutions" refuses.err'
    claim "$1, with 5 % more" bash -c "$2 --quiet --memory $(part 1.05) -o done.rcg"
}

rc-solve --quiet --estar 3GPa --mean-pressure 10MPa small.rcg -o light.rcg
metal="--E1 70GPa --nu1 0.3 --E2 rigid"
# The elastic contact is freed before the volume is made. Whether a voxel yields is known only after the
# elastic contact, so the plan counts the volume in any case.
planned() { # options: the plan of a body that yields, in bytes, and the peak of the run
    rc-solve --dry-run $metal --periodic --increments 1 $1 small.rcg >plan.txt 2>/dev/null
    rc-solve --quiet $metal --periodic --increments 1 $1 small.rcg -o yields.rcg --report yields.json
    plan=$(awk -v mib="$(sed -n 's/.*, \([0-9]*\) MiB, .*/\1/p' plan.txt)" 'BEGIN { print mib * 1048576 }')
    peak=$(field peak_memory yields.json)
}
planned "--mean-pressure 100MPa --yield 5.94GPa --slabs 12"
near "$plan" "$peak" 0.1 "the plan of a body that yields has the peak"
planned "--mean-pressure 300MPa --yield 8GPa --slabs 4"
claim "the plan of a body that stays elastic is a bound" test "$plan" -ge "$peak"
promised "rc-solve" "rc-solve $load odd.rcg" 6M
promised "rc-solve --periodic, a list" "rc-solve --periodic --estar 3GPa --mean-pressure 50MPa,100MPa odd.rcg" 6M
promised "rc-solve --history" "rc-solve --hardness 300MPa --history --estar 3GPa --mean-pressure 50MPa,100MPa small.rcg" 3M
promised "rc-solve --yield" "rc-solve $metal --periodic --mean-pressure 300MPa --yield 8GPa --slabs 4 --increments 1 small.rcg" 3M
promised "rc-stress" "rc-stress --nu 0.3 --depths 1um,5um free.rcg" 9M
promised "rc-stress, periodic-x, with friction" "rc-stress --nu 0.3 --mu 0.2 --components mises --depths 1um line-x.rcg" 9M
promised "rc-stress, periodic-y, on a coarser grid" "rc-stress --nu 0.3 --tol 1e-3 --components mises --depths 60um line-y.rcg" 9M
promised "rc-stress, periodic, with friction" "rc-stress --nu 0.3 --mu 0.2 --components mises --depths 1um round.rcg" 9M
promised "rc-fatigue" "rc-fatigue --nu 0.3 --bending-limit 6MPa --torsion-limit 4MPa --pass x --depths 1um,5um free.rcg" 12M
promised "rc-wear" "rc-wear --coefficient 1e-6mm3/Nm --distance 1um free.rcg" 20M
promised "rc-slip" "rc-slip --nu 0.3 --mu 0.3 --tangential 10mN light.rcg" 7M
promised "rc-slip, three solutions" "rc-slip --nu 0.3 --mu 0.3 --tangential 100mN,100mN --increments 4 light.rcg" 7M
rc-synth $rough --nx 160 | rc-solve --quiet --mean-pressure 10MPa --E1 3GPa --nu1 0.3 --E2 rigid -o dissimilar.rcg -
slides="rc-slip --quiet --mu 0.05 --tangential 1mN --increments 8 --tol 0.1 dissimilar.rcg"
plan=$($slides --dry-run | awk 'match($0, /, [0-9]+ MiB,/) { print substr($0, RSTART + 2) * 1048576; exit }')
$slides -o slides.rcg --report slides.json 2>slides.err || true # too few increments for its tolerance
near "${plan:-none}" "$(field peak_memory slides.json)" 0.1 "the plan of three solutions of dissimilar bodies has the peak"

# A process of 256 MiB starts the tool: getrusage passes its peak on to the tool.
cat >large.pl <<'P'
my $held = "x" x (1 << 28);
my $pid = fork;
exec @ARGV if $pid == 0;
waitpid $pid, 0;
exit($? >> 8 | (length $held) - (1 << 28));
P
claim "a large process starts the tool" perl large.pl rc-solve --quiet $load odd.rcg -o again.rcg --report again.json
near "$(field peak_memory again.json)" "$(field peak_memory free.json)" 0.1 "its peak is its own"

# ---- refused ----

more="needs? (about|at least) [0-9.]+ MiB, --memory allows"
# The code of a tool does not count: a limit below its size is enough for a small map.
claim "10M is enough for a small map" bash -c "rc-import --quiet --memory 10M --dx 1um --z-unit m odd.npy | rc-detrend --memory 10M --plane | rc-info --memory 10M"
refuses 1 "517 x 389 nodes $more 18 MiB: .*rc-pick" "rc-solve: more than --memory" "rc-solve --quiet --memory 18M $load --kernel fft64 odd.rcg -o never.rcg"
refuses 1 "$more 4 MiB: .*rc-pick" "  --periodic" "rc-solve --memory 4M --periodic $load odd.rcg -o never.rcg"
refuses 1 "$more 8 MiB: .*rc-pick" "  --yield" "rc-solve --memory 8M --periodic --E1 70GPa --nu1 0.3 --E2 rigid --mean-pressure 100MPa --yield 300MPa --slabs 8 odd.rcg -o never.rcg"
refuses 1 "$more 20 MiB: .*rc-pick" "  --adhesion" "rc-solve --memory 20M --estar 3GPa --approach 10nm --adhesion 0.1J/m2 odd.rcg -o never.rcg"
refuses 1 "$more 18 MiB" "  --stiffness" "rc-solve --memory 18M --stiffness $load odd.rcg -o never.rcg"
refuses 1 "$more 20 MiB" "rc-slip" "rc-slip --memory 20M --nu 0.3 --mu 0.3 --tangential 1N free.rcg -o never.rcg"
refuses 1 "$more 20 MiB" "rc-stress" "rc-stress --memory 20M --nu 0.3 --depths 5um free.rcg -o never.rcg"
refuses 1 "$more 2 MiB" "  --section" "rc-stress --memory 2M --nu 0.3 --section x=0 --depths 5um free.rcg -o never.rcg"
refuses 1 "--kernel mlms needs less" "another engine is named where it fits" "rc-deflect --estar 3GPa --memory 10M --kernel fft64 sparse.rcg -o never.rcg"
refuses 1 "$more 4 MiB" "rc-deflect --periodic" "rc-deflect --memory 4M --periodic --estar 3GPa round.rcg -o never.rcg"
refuses 1 "$more [0-9]+ MiB" "rc-leak" "rc-leak --memory 8M round.rcg -o never.rcg"
refuses 1 "$more 3 MiB" "rc-pick" "rc-pick --memory 3M --rotate 90 odd.rcg -o never.rcg"
refuses 1 "$more 2 MiB" "rc-add" "rc-add --subtract --align --memory 2M odd.rcg odd.rcg -o never.rcg"
refuses 1 "$more 2 MiB" "rc-info --areal" "rc-info --memory 2M --areal odd.rcg"
refuses 1 "$more 4 MiB" "rc-detrend" "rc-detrend --memory 4M --lowpass 20um odd.rcg -o never.rcg"
refuses 1 "$more 4 MiB" "rc-export" "rc-export --memory 4M --format x3p odd.rcg -o never.x3p"
refuses 1 "$more 8 MiB: .*rc-pick" "rc-render --sheet" "rc-render --memory 8M --sheet auto depths.rcg -o never.png"
refuses 1 "$more [0-9.]+ MiB: give fewer rows" "rc-render --curve" "rc-render --memory 3M --curve x:y long.tsv -o never.png"
refuses 1 "$more 8 MiB: the file itself takes memory too" "rc-import, for the process that reads the file" "rc-import --memory 8M made.park -o never.rcg"
refuses 1 "$more 4 MiB" "rc-synth" "rc-synth --memory 4M $rough --nx 1024 -o never.rcg"
refuses 1 "$more [0-9.]+ MiB" "rc-cost" "rc-cost --memory 3M --limit 60s odd.rcg -- rc-solve $load"
refuses 1 "$more 1 MiB" "a frame that is read" "cat odd.rcg | rc-info --memory 1M"
claim "no file is left" bash -c '! ls never* 2>/dev/null'
claim "a run within the limit finishes" rc-solve --quiet --memory 60M $load odd.rcg -o done.rcg

machine=$(awk '/^MemAvailable:|^SwapFree:/ { sum += $2 } END { printf "%.0f", sum / 8 * 1024 }' /proc/meminfo)
side=$(awk -v n="$machine" 'BEGIN { printf "%d", sqrt(n) * 1.2 }')
refuses 1 "needs? (about|at least) [0-9.]+ [MG]iB, (the machine has|the group of processes \(cgroup\) leaves) [0-9.]+ [MG]iB: take fewer|is more than this machine can address" "more than the machine has" \
    "rc-synth sphere --radius 1m --dx 1um --nx $side -o never.rcg"
refuses 1 "needs? (about|at least) [0-9.]+ [MG]iB, the limit of address space \(ulimit -v\) leaves [0-9]+ MiB" "more than ulimit -v" \
    "ulimit -v 200000; rc-synth sphere --radius 1m --dx 1um --nx 8000 -o never.rcg"

# A new control group, if the test may make one.
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
    refuses 1 "needs? (about|at least) [0-9.]+ [MG]iB, the group of processes \(cgroup\) leaves [0-9]+ MiB" "more than a group may take" \
        "(echo \$BASHPID >$group/cgroup.procs; exec rc-synth sphere --radius 1m --dx 1um --nx 4000 -o never.rcg)"
    claim "a run within the limit finishes" bash -c "(echo \$BASHPID >$group/cgroup.procs; exec rc-synth sphere --radius 1m --dx 1um --nx 1000 -o done.rcg)"
    rmdir "$group"
else
    echo "no group of processes can be made here: tests/tools/truth_memory_room.c reads made ones"
fi
