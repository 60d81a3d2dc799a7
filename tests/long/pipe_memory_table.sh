# SPDX-License-Identifier: GPL-3.0-or-later
# --memory and the kernel. The memory that --dry-run plans, or that the allocator counts, is within 5 % of the
# kernel's peak. A limit 5 % below the needed memory is refused before any iteration, and one 5 % above it is
# enough. Then it compares the counted memory of all tools, to a tenth. Arguments select the sizes of these
# maps: pipe_memory_table.sh 256x256 517x389 2047x1021 4096x4096.
. "$(dirname "$0")/../pipe.sh"

skip_with_address_sanitizer "it takes memory of its own"

# row "what" 'shell command': a line of the table; the last tool gets --verbose.
row() {
    local expected taken
    bash -c "${2//--verbose/--debug}" 2>&1 >/dev/null | grep 'memory: ' | tail -n 1 >memory.txt
    read -r _ _ expected _ _ taken _ <memory.txt
    printf '%-28s %-12s %9s MiB expected %9s MiB taken\n' "$1" "$size" "${expected:-none}" "${taken:-none}" >>table.txt
    near "${expected:-none}" "${taken:-none}" 0.1 "$1, $size"
}

# Prints in mebibytes the counted memory and the kernel's peak of a command, both with the code.
peaks() {
    bash -c "$1 --debug" 2>&1 >/dev/null | sed -n 's/.*memory: \([0-9.]*\) MiB counted, \([0-9.]*\) MiB taken.*/\1 \2/p' | tail -n 1
}

ending= # of the names of output files

# kept "what" 'command' KIB: a limit of 0.95 times these kibibytes is refused without any work, one of 1.05
# times is enough.
kept() {
    local start=${EPOCHREALTIME/./} passed refused
    claim "$1, with 5 % more than it needs" bash -c "$2 --quiet --memory $(($3 * 105 / 100))k -o passed$ending"
    passed=$((${EPOCHREALTIME/./} - start))
    start=${EPOCHREALTIME/./}
    refuses 1 "need.* MiB, --memory allows" "$1, with 5 % less" "$2 --verbose --memory $(($3 * 95 / 100))k -o refused$ending"
    refused=$((${EPOCHREALTIME/./} - start))
    claim "  before any iteration: $refused of $passed us" test $refused -lt $passed
    claim "  of which it says nothing" bash -c '! grep -E "converged|iterations|convolutions" refuses.err && [ ! -e refused'$ending' ]'
}

# needed 'command' LIMIT: the MiB of a refusal at LIMIT, which holds what is read.
needed() {
    bash -c "$1 --memory $2" 2>&1 >/dev/null | sed -n 's/.* need about \([0-9.]*\) MiB.*/\1/p'
}

# planned "what" 'command' LIMIT: --dry-run and the refusal at LIMIT, which holds what is read, tell the memory.
planned() {
    local dry needs counted taken
    dry=$(bash -c "$2 --dry-run" 2>/dev/null | sed -n 's/.* \([0-9]*\) MiB.*/\1/p' | head -n 1)
    needs=$(needed "$2" "$3")
    read -r counted taken < <(peaks "$2")
    printf '%-30s %8s MiB in the plan %8s refused %8s counted %8s of the kernel\n' "$1" "${dry:-none}" "${needs:-none}" "${counted:-none}" "${taken:-none}" >>table.txt
    near "${dry:-none}" "${taken:-none}" 0.05 "$1, planned"
    near "${counted:-none}" "${taken:-none}" 0.05 "$1, counted"
    kept "$1" "$2" $((${needs:-1} * 1024))
}

# counted "what" 'command' [MIB]: of a tool without --dry-run the count is near the kernel's figure. The same
# command on a small map, in the folder small, has almost only the code; MIB: what a refusal tells, because the
# picture of a small map is not small.
counted() {
    local code counted taken
    read -r code _ < <(peaks "cd small; $2")
    read -r counted taken < <(peaks "$2")
    printf '%-30s %44s counted %8s of the kernel\n' "$1" "${counted:-none}" "${taken:-none}" >>table.txt
    near "${counted:-none}" "${taken:-none}" 0.05 "$1, counted"
    kept "$1" "$2" "$(awk -v a="${counted:-0}" -v b="${code:-0}" -v m="${3:-0}" 'BEGIN { printf "%d", (m > 0 ? m : a - b) * 1024 }')"
}

rough="selfaffine --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 100um --short-cut 6um"
load="--estar 3GPa --mean-pressure 100MPa"
coat="--layer 5um,200GPa,0.3 --E1 70GPa --nu1 0.3 --E2 rigid --mean-pressure 100MPa"
metal="--E1 70GPa --nu1 0.3 --E2 rigid"
sticky="--estar 3GPa --mean-pressure 10MPa --adhesion 50mJ/m2,exponential,20nm"

# maps NX NY: s, without bodies; p and q, of dissimilar bodies, free and periodic; a and b, of similar ones.
maps() {
    rc-synth $rough --nx $1 --ny $2 -o s.rcg
    rc-solve --quiet --E1 3GPa --nu1 0.3 --E2 rigid --mean-pressure 15MPa s.rcg -o p.rcg
    rc-solve --quiet --periodic --E1 3GPa --nu1 0.3 --E2 rigid --mean-pressure 15MPa s.rcg -o q.rcg
    rc-solve --quiet --E1 3GPa --nu1 0.3 --E2 3GPa --nu2 0.3 --mean-pressure 15MPa s.rcg -o a.rcg
    rc-solve --quiet --periodic --E1 3GPa --nu1 0.3 --E2 3GPa --nu2 0.3 --mean-pressure 15MPa s.rcg -o b.rcg
}

maps 1024 900
planned "rc-solve" "rc-solve $load s.rcg" 25M
planned "rc-solve --approach" "rc-solve --estar 3GPa --approach 2um s.rcg" 25M
planned "rc-solve, a list" "rc-solve --estar 3GPa --mean-pressure 50MPa,100MPa s.rcg" 25M
planned "rc-solve --kernel fft64" "rc-solve --kernel fft64 $load s.rcg" 25M
planned "rc-solve --kernel mlms" "rc-solve --kernel mlms $load s.rcg" 25M
planned "rc-solve --periodic" "rc-solve --periodic $load s.rcg" 25M
planned "rc-solve --periodic, fft64" "rc-solve --periodic --kernel fft64 $load s.rcg" 25M
planned "rc-solve, coated" "rc-solve $coat s.rcg" 25M
planned "rc-solve --stiffness" "rc-solve --stiffness $load s.rcg" 25M
planned "rc-solve --conductivity" "rc-solve --conductivity 45,16 $load s.rcg" 25M
planned "rc-solve --history" "rc-solve --hardness 300MPa --history --estar 3GPa --mean-pressure 50MPa,100MPa s.rcg" 25M
planned "rc-stress" "rc-stress --nu 0.3 --depths 5um p.rcg" 35M
planned "rc-stress, of the surface" "rc-stress --nu 0.3 --components sxx --depths 0 p.rcg" 35M
planned "rc-stress --mu" "rc-stress --nu 0.3 --mu 0.2 --depths 1um,5um p.rcg" 35M
planned "rc-stress, with coarser grids" "rc-stress --nu 0.3 --tol 1e-3 --components mises --depths 1um,10um,80um p.rcg" 35M
planned "rc-stress, periodic, mu" "rc-stress --nu 0.3 --mu 0.2 --depths 1um,5um q.rcg" 35M
planned "rc-wear" "rc-wear --coefficient 1e-6mm3/Nm --distance 1m p.rcg" 60M
planned "rc-wear --periodic" "rc-wear --coefficient 1e-6mm3/Nm,1e-6mm3/Nm --distance 1m q.rcg" 60M
maps 512 450
rc-synth sphere --radius 1mm --dx 1um --nx 256 -o ball.rcg
planned "rc-solve --adhesion" "rc-solve $sticky s.rcg" 25M
planned "rc-solve --adhesion --periodic" "rc-solve --periodic $sticky s.rcg" 10M
planned "rc-solve --yield" "rc-solve $metal --load 3N --yield 800MPa --slabs 6 --increments 4 ball.rcg" 10M
planned "rc-slip" "rc-slip --mu 0.3 --tangential 0.5N a.rcg" 25M
planned "rc-slip --periodic" "rc-slip --mu 0.3 --tangential 0.5N b.rcg" 25M
planned "rc-slip, dissimilar" "rc-slip --mu 0.3 --tol 0.3 --increments 1 --tangential 0.3N p.rcg" 25M
planned "rc-slip, dissimilar, periodic" "rc-slip --mu 0.3 --tol 0.3 --increments 1 --tangential 0.3N q.rcg" 25M
mkdir small
(cd small && maps 48 40)
maps 1400 1200
counted "rc-info --psd" "rc-info --psd s.rcg"
counted "rc-info --areal" "rc-info --areal s.rcg"
ending=.png
counted "rc-render --contour" "rc-render --contour --channel pressure q.rcg" "$(needed "rc-render --contour --channel pressure q.rcg -o none.png" 18M)"
ending=
for format in x3p hdf5; do
    for folder in . small; do
        (cd $folder && rc-export --format $format -o s.$format s.rcg)
    done
    counted "rc-export --format $format" "rc-export --format $format s.rcg"
    counted "rc-import of that" "rc-import s.$format"
done
counted "rc-deflect" "rc-deflect --estar 3GPa p.rcg"
counted "rc-deflect --periodic" "rc-deflect --periodic --estar 3GPa q.rcg"
counted "rc-leak" "rc-leak --direction y q.rcg"
counted "rc-heat" "rc-heat --mu 0.3 --speed 1 --conductivity 45,45 --diffusivity 1.2e-5,1.2e-5 p.rcg"
counted "rc-heat --periodic" "rc-heat --mu 0.3 --speed 1 --conductivity 45,45 --diffusivity 1.2e-5,1.2e-5 --time 1ms q.rcg"
counted "rc-detrend --lowpass" "rc-detrend --lowpass 20um s.rcg"
counted "rc-detrend --outliers --fill" "rc-detrend --outliers 4 --fill s.rcg"
counted "rc-pick --resample" "rc-pick --resample 0.7um s.rcg"
counted "rc-add" "rc-add s.rcg s.rcg"
rm -r small ball.rcg a.rcg b.rcg
[ $# -gt 0 ] || set -- 1024x1024
for size in "$@"; do
    rc-synth $rough --nx ${size%x*} --ny ${size#*x} -o s.rcg
    rc-solve --quiet $load --output pressure s.rcg -o p.rcg
    rc-solve --quiet --periodic $load --output pressure s.rcg -o q.rcg
    row "rc-synth" "rc-synth --verbose $rough --nx ${size%x*} --ny ${size#*x}"
    row "rc-solve" "rc-solve --verbose $load s.rcg"
    row "rc-solve --periodic" "rc-solve --verbose --periodic $load s.rcg"
    row "rc-solve, coated" "rc-solve --verbose $coat s.rcg"
    row "rc-solve --output pressure" "rc-solve --output pressure --verbose $load s.rcg"
    row "rc-deflect" "rc-deflect --verbose --estar 3GPa p.rcg"
    row "rc-deflect, single" "rc-deflect --tol 1e-3 --kernel fft --verbose --estar 3GPa p.rcg"
    row "rc-deflect --periodic" "rc-deflect --verbose --periodic --estar 3GPa q.rcg"
    row "rc-stress" "rc-stress --verbose --nu 0.3 --depths 1um,5um,50um p.rcg"
    row "rc-stress, periodic, mu" "rc-stress --verbose --nu 0.3 --mu 0.2 --depths 1um,5um q.rcg"
    row "rc-stress --section" "rc-stress --verbose --nu 0.3 --section x=0 --depths 0:50um:20 p.rcg"
    row "rc-info" "rc-info --verbose s.rcg"
    row "rc-info --areal" "rc-info --areal --verbose s.rcg"
    row "rc-info --psd" "rc-info --psd --verbose s.rcg"
    row "rc-info --patches" "rc-info --patches --verbose p.rcg"
    row "rc-detrend --plane" "rc-detrend --plane --verbose s.rcg"
    row "rc-detrend --lowpass" "rc-detrend --lowpass 20um --verbose s.rcg"
    row "rc-detrend --outliers --fill" "rc-detrend --outliers 4 --fill --verbose s.rcg"
    row "rc-pick --rotate" "rc-pick --rotate 90 --verbose s.rcg"
    row "rc-add" "rc-add --verbose s.rcg s.rcg"
    for format in x3p gsf hdf5; do
        rc-export --format $format -o s.$format s.rcg
        row "rc-export --format $format" "rc-export --format $format --verbose s.rcg"
        row "rc-import of that" "rc-import --verbose s.$format"
    done
    for format in park netcdf; do
        perl "$RC_SOURCE/tests/tools/made_maps.pl" $format ${size%x*} ${size#*x} >s.$format
        row "rc-import of $format" "rc-import --verbose s.$format"
    done
    row "rc-render" "rc-render --verbose s.rcg -o map.png"
    row "rc-render --view" "rc-render --view 30,40 --verbose s.rcg -o relief.png"
    row "rc-render --histogram" "rc-render --histogram --verbose s.rcg -o histogram.png"
    row "rc-render --material-ratio" "rc-render --material-ratio --verbose s.rcg -o ratio.png"
    for format in png pdf svg; do
        row "rc-render --sheet, $format" "rc-render --sheet auto --verbose s.rcg s.rcg s.rcg s.rcg -o sheet.$format"
    done
    row "rc-render, PDF" "rc-render --width 1600 --verbose s.rcg -o map.pdf"
    for format in png pdf svg; do
        row "rc-render --contour, $format" "rc-render --contour --verbose p.rcg -o contact.$format"
    done
    case $size in 256x256 | 517x389 | 1024x1024) ;; *) continue ;; esac
    for kernel in fft64 mlms; do
        row "rc-solve --kernel $kernel" "rc-solve --kernel $kernel --verbose $load s.rcg"
        row "rc-deflect --kernel $kernel" "rc-deflect --kernel $kernel --verbose --estar 3GPa p.rcg"
    done
    row "rc-solve, coated, mlms" "rc-solve --kernel mlms --verbose $coat s.rcg"
    row "rc-solve --method pk99" "rc-solve --method pk99 --tol 1e-2 --verbose $load s.rcg"
    row "rc-solve --hardness" "rc-solve --hardness 300MPa --verbose $load s.rcg"
    row "rc-solve --history" "rc-solve --hardness 300MPa --history --verbose --estar 3GPa --mean-pressure 50MPa,100MPa s.rcg"
    row "rc-solve, a second map" "rc-solve --verbose $load s.rcg s.rcg"
    row "rc-solve, a list" "rc-solve --verbose --estar 3GPa --mean-pressure 50MPa,100MPa s.rcg"
    row "rc-solve --discretization" "rc-solve --discretization --verbose $load s.rcg"
    row "rc-solve --stiffness" "rc-solve --stiffness --verbose $load s.rcg"
    row "rc-solve --conductivity" "rc-solve --conductivity 45,16 --verbose $load s.rcg"
    row "rc-stress, single" "rc-stress --tol 1e-3 --verbose --nu 0.3 --depths 1um,5um,50um p.rcg"
done
size=256x256
rc-synth $rough --nx 256 -o s.rcg
rc-solve --quiet $load --output pressure s.rcg -o p.rcg
row "rc-solve --kernel direct" "rc-solve --kernel direct --tol 1e-2 --verbose $load s.rcg"
row "rc-cost" "rc-cost --verbose --limit 60s s.rcg -- rc-solve $load"
row "rc-cost --plot" "rc-cost --verbose --limit 60s --plot cost.png s.rcg -- rc-solve $load"
cat table.txt
