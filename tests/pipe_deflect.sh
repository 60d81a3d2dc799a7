# rc-deflect gives the displacement that the solver found, by every engine, and refuses what it cannot
# do.
. "$(dirname "$0")/pipe.sh"

rc-synth sphere --nx 97 --ny 64 --dx 5um --dy 6um --radius 7.5mm |
    rc-solve --quiet --load 60N --estar 114GPa --output pressure,displacement -o solved.rcg
statistic() { rc-info --json "$2" | grep displacement | head -n 1 | grep -o "\"$1\": [^,]*" | cut -d' ' -f2; }
for name in maximum minimum mean; do
    eval "$name=$(statistic $name solved.rcg)"
done

for kernel in auto fft direct 'mlms --tol 1e-9' 'mlms --order 8 --correction 24'; do
    claim "--kernel $kernel works" bash -c "rc-deflect --kernel $kernel solved.rcg -o u.rcg"
    near "$(statistic maximum u.rcg)" "$maximum" 1e-8 "  with the solver's largest displacement"
    near "$(statistic minimum u.rcg)" "$minimum" 1e-8 "  and its smallest"
    near "$(statistic mean u.rcg)" "$mean" 1e-8 "  and its mean"
done
claim "the boundary stands in the stream" bash -c 'rc-info u.rcg | grep -q boundary=free'
claim "--estar wins over the stream" rc-deflect --estar 57GPa solved.rcg -o soft.rcg
near "$(statistic maximum soft.rcg)" "$(awk -v m="$maximum" 'BEGIN { printf "%.17g", 2 * m }')" 1e-12 \
    "  and half the modulus gives twice the displacement"
claim "--verbose says which engine and why" bash -c \
    'rc-deflect --verbose solved.rcg -o u.rcg 2>why.txt && grep -q "summed by fft, because" why.txt'

# a pressure of a stranger: no boundary, no modulus
rc-info --json solved.rcg >/dev/null
refuses 1 'contradicts' "--periodic against the stream" "rc-deflect --periodic solved.rcg"
refuses 2 'together' "--order without --correction" "rc-deflect --order 3 solved.rcg"
refuses 2 'one of auto' "an engine that is none" "rc-deflect --kernel guess solved.rcg"
refuses 2 'above 0' "a modulus of 0" "rc-deflect --estar 0 solved.rcg"
refuses 1 'no frame with the channel pressure' "a stream without pressure" \
    "rc-synth sphere --nx 9 --dx 1um --radius 1mm | rc-deflect --estar 1GPa"
refuses 1 'memory' "more memory than is allowed" "rc-deflect --memory 20k solved.rcg"

finish
