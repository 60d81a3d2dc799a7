# SPDX-License-Identifier: GPL-3.0-or-later
# rc-deflect gives the displacement of the solver, with every engine, and refuses impossible requests.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 97 --ny 64 --dx 5um --dy 6um --radius 7.5mm |
    rc-solve --quiet --load 60N --estar 114GPa --output pressure,displacement -o solved.rcg
statistic() { rc-info --json "$2" | grep displacement | head -n 1 | grep -o "\"$1\": [^,]*" | cut -d' ' -f2; }
for name in maximum minimum mean; do
    eval "$name=$(statistic $name solved.rcg)"
done

# mlms: the requested error is relative to the sum of |K| |p|, which is u itself because all terms are
# positive
while read -r within kernel; do
    claim "--kernel $kernel works" bash -c "rc-deflect --kernel $kernel solved.rcg -o u.rcg"
    near "$(statistic maximum u.rcg)" "$maximum" "$within" "  with the solver's largest displacement"
    near "$(statistic minimum u.rcg)" "$minimum" "$within" "  and its smallest"
    near "$(statistic mean u.rcg)" "$mean" "$within" "  and its mean"
done <<END
$rounding auto
$rounding fft
$rounding direct
1e-9 mlms --tol 1e-9
1e-9 mlms --order 8 --correction 24
END
claim "the stream has the boundary" says 'boundary=free' rc-info u.rcg
claim "--estar has priority over the stream" rc-deflect --estar 57GPa solved.rcg -o soft.rcg
near "$(statistic maximum soft.rcg)" "$(awk -v m="$maximum" 'BEGIN { printf "%.17g", 2 * m }')" "$rounding" \
    "  and half the modulus gives twice the displacement"
claim "--verbose names the engine and the reason" \
    warns 'summed by fft, because the fastest engine that is exact' rc-deflect --verbose solved.rcg -o u.rcg

# a pressure that rc-solve has not written: no boundary, no modulus
rc-synth sphere --nx 40 --dx 1um --radius 1mm | sed 's/^channel=height/channel=pressure/; s/^unit=m/unit=Pa/' | reseal >bare.rcg
claim "a pressure without keys has the free boundary, and needs --estar" says 'boundary=free' bash -c '
    rc-deflect --estar 1GPa bare.rcg | rc-info'
refuses 2 'E\* is not in the stream: give it with --estar' "  which is asked for" "rc-deflect bare.rcg"
refuses 1 'its boundary is free, which contradicts --periodic' "--periodic against the stream" "rc-deflect --periodic solved.rcg"
refuses 2 '--order has no effect without --correction' "--order without --correction" "rc-deflect --order 3 solved.rcg"
refuses 2 '--kernel guess: it must be one of auto\|fft' "an engine that is none" "rc-deflect --kernel guess solved.rcg"
refuses 2 '--estar 0 Pa: it must be above 0' "a modulus of 0" "rc-deflect --estar 0 solved.rcg"
refuses 1 'no frame with the channel pressure, only height' "a stream without pressure" \
    "rc-synth sphere --nx 9 --dx 1um --radius 1mm | rc-deflect --estar 1GPa"
refuses 1 '97 x 64 nodes need about [0-9.]+ [KM]iB, --memory allows 20 KiB: ' "more memory than is allowed" "rc-deflect --memory 20k solved.rcg"
