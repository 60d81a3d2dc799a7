# Estimated memory agrees with the measured memory to a tenth: every tool and engine from 256 x 256 to 4096 x
# 4096 nodes, odd sides, both boundaries, coated, yielding, with lists and error estimates. Arguments select
# sizes: pipe_memory_table.sh 517x389 2048x2048.
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

# told "what" 'command': the memory that a refusal tells, before any iteration, against the kernel's peak.
told() {
    local needs taken
    needs=$(bash -c "$2 --memory 40M" 2>&1 >/dev/null | sed -n 's/.* nodes need about \([0-9.]*\) MiB.*/\1/p')
    taken=$(bash -c "$2 --debug" 2>&1 >/dev/null | sed -n 's/.*, \([0-9.]*\) MiB taken.*/\1/p' | tail -n 1)
    printf '%-28s %-12s %9s MiB told     %9s MiB taken\n' "$1" "$size" "${needs:-none}" "${taken:-none}" >>table.txt
    near "${needs:-none}" "${taken:-none}" 0.05 "$1, refused"
}

rough="selfaffine --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 100um --short-cut 6um"
load="--estar 3GPa --mean-pressure 100MPa"
coat="--layer 5um,200GPa,0.3 --E1 70GPa --nu1 0.3 --E2 rigid --mean-pressure 100MPa"
size=1600x1400
rc-synth $rough --nx 1600 --ny 1400 -o s.rcg
rc-solve --quiet $load --output pressure s.rcg -o p.rcg
told "rc-solve" "rc-solve $load s.rcg"
told "rc-solve --kernel fft64" "rc-solve --kernel fft64 $load s.rcg"
told "rc-solve --kernel mlms" "rc-solve --kernel mlms $load s.rcg"
told "rc-solve --periodic" "rc-solve --periodic $load s.rcg"
told "rc-solve --periodic, fft64" "rc-solve --periodic --kernel fft64 $load s.rcg"
told "rc-solve, coated" "rc-solve $coat s.rcg"
told "rc-solve --stiffness" "rc-solve --stiffness $load s.rcg"
told "rc-solve --conductivity" "rc-solve --conductivity 45,16 $load s.rcg"
told "rc-solve --history" "rc-solve --hardness 300MPa --history --estar 3GPa --mean-pressure 50MPa,100MPa s.rcg"
told "rc-solve --method pk99" "rc-solve --method pk99 --tol 1e-2 $load s.rcg"
[ $# -gt 0 ] || set -- 256x256 517x389 1024x1024 2047x1021 2048x2048 4096x4096
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
row "rc-cost" "rc-cost --verbose --limit 60s $load s.rcg"
row "rc-cost --plot" "rc-cost --verbose --limit 60s --plot cost.png $load s.rcg"
cat table.txt

finish
