# A sphere is not added twice, and slopes are judged where the bodies touch.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 65 --dx 2um --hurst 0.8 --rms-height 5nm --rolloff 40um --short-cut 10um --seed 5 -o s.rcg
claim "the stream names the sphere" bash -c '
    rc-solve --quiet --radius 2mm --load 1N --estar 100GPa s.rcg -o once.rcg && says "form=sphere 0.002$" rc-info once.rcg'
refuses 1 'hold a shape that was added to them already \(form=sphere 0.002\): leave out --radius' "and refuses a second" \
    'rc-solve --quiet --radius 2mm --load 1N --estar 100GPa once.rcg >/dev/null'
claim "pressed again without --radius it is the same" bash -c '
    rc-solve --quiet --load 1N --estar 100GPa --report again.json --output pressure once.rcg -o again.rcg &&
    rc-solve --quiet --radius 2mm --load 1N --estar 100GPa --report first.json --output pressure s.rcg -o first.rcg'
near "$(field max_pressure again.json)" "$(field max_pressure first.json)" "$summed" "  to rounding"

# A ball of 100 um on a map of 130 um: slopes of 0.65 at its flank, of a/R in contact: 1 N: a = 9.1 um
rc-synth sphere --nx 131 --dx 1um --radius 100um -o ball.rcg
press() { rc-solve --estar 100GPa --output pressure --load "$1" ball.rcg -o p.rcg; }
export -f press
claim "a steep flank that nothing touches is no fault" bash -c 'press 1N 2>err; ! grep -q slope err'
# 1000 N: a = 90.9 um; the RMS over the disc of r/R is a/(R sqrt 2)
rc-synth sphere --nx 131 --dx 2um --radius 100um -o ball.rcg
claim "one that is touched is" warns 'RMS slope 0\.[56][0-9]* where the bodies touch' press 1000N

finish
