# SPDX-License-Identifier: GPL-3.0-or-later
# rc-detrend does not change a height if its case contains results computed from it, before or after the
# height.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 32 --dx 1um --hurst 0.8 --rms-height 10nm --seed 2 -o surface.rcg
solve="rc-solve --quiet --load 10mN --estar 100GPa"
$solve surface.rcg -o result.rcg
rc-info --json result.rcg | sed 's/.*"channel": "\([a-z]*\)".*/\1/' | tr '\n' ' ' >order
claim "rc-solve writes a solution with its height" grep -q '^pressure gap displacement height $' order

refuses 1 'case 1, frame 4 \(height\): .* \(pressure, gap, displacement\).*: take the height alone with rc-pick --channel height' \
    "results before the height, named" "rc-detrend --plane result.rcg -o out.rcg"
claim "  no file is left" test ! -e out.rcg
refuses 1 "case contains a height" "  and a reader fails too" "rc-detrend --plane result.rcg 2>/dev/null | rc-info --verbose - >none"

# one case of three frames, the height first, without the inner end lines
$solve --output pressure,gap surface.rcg -o two.rcg
{ head -c -9 surface.rcg; head -c -9 two.rcg; printf 'RCGEND 3\n'; } >first.rcg
refuses 1 'case 1, frame 2 \(pressure\): .* \(pressure, gap\)' "results behind it, all named" "rc-detrend --fill first.rcg"
rc-stress --nu 0.3 --depths 0,1um --components mises,szz two.rcg -o stress.rcg
{ head -c -9 stress.rcg; head -c -9 surface.rcg; printf 'RCGEND 5\n'; } >third.rcg
refuses 1 '\((mises, szz|szz, mises)\)' "stresses are results, each named once" "rc-detrend --plane third.rcg"
refuses 1 'case 2, frame 4' "in the second case too" "rc-detrend --plane surface.rcg result.rcg"

$solve --output gap surface.rcg | sed 's/^channel=gap/channel=colour/' | reseal >colour.rcg
{ head -c -9 surface.rcg; head -c -9 colour.rcg; printf 'RCGEND 2\n'; } >both.rcg
claim "frames that are not results are passed on" says '^  *2$' bash -c \
    'rc-detrend --plane both.rcg | rc-info | grep -c "^  grid" | sed "s/^/ /"'
$solve --output height surface.rcg -o alone.rcg
claim "the height of a solution alone can be changed" rc-detrend --plane alone.rcg -o out.rcg
