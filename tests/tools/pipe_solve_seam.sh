# A map whose edges do not meet is not solved as a period without a word.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 128 --ny 96 --dx 1um --hurst 0.8 --rms-height 100nm --rolloff 40um --short-cut 8um --seed 5 -o period.rcg
press() { rc-solve --periodic --load 1N --estar 100GPa --output pressure "$@" -o p.rcg; }
export -f press
claim "a period: not a word" bash -c 'press period.rcg 2>err && [ ! -s err ]'

# A ramp of 1 um over the map, along x or y: the seam is 127/128 um beside a step of 1/128 um.
ramp() { # AXIS
    rc-export --format xyz period.rcg | LC_ALL=C awk -v axis="$1" '
        $1 ~ /^[-+0-9]/ { print $1, $2, $3 + (axis == "x" ? $1 / 128e-6 : $2 / 96e-6) * 1e-6 }' >ramp.xyz
    rc-import --format xyz --z-unit m --dx 1um ramp.xyz -o "ramp-$1.rcg"
}
ramp x
ramp y
claim "a tilt along x: the last column and the first" \
    warns 'the edges do not meet: from the last column to the first the heights jump by .*rc-detrend --plane' press ramp-x.rcg
claim "  and not the rows" bash -c 'lacks "last row" warns.err'
claim "a tilt along y: the last row" warns 'from the last row to the first' press ramp-y.rcg
claim "  a plane mends it" bash -c 'rc-detrend --plane ramp-x.rcg | press 2>err; ! grep -q "do not meet" err'
claim "a free solve has no seam" bash -c 'rc-solve --load 10mN --estar 100GPa --output pressure ramp-x.rcg -o p.rcg 2>err; ! grep -q "do not meet" err'

claim "so does a taper" bash -c 'rc-detrend --quiet --taper 12um ramp-x.rcg | press 2>err; ! grep -q "do not meet" err'

finish
