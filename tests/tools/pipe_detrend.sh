# SPDX-License-Identifier: GPL-3.0-or-later
# rc-detrend does its steps in the given order on the height of every case; it passes on all other frames and
# records the steps.
. "$(dirname "$0")/../pipe.sh"

# figure NAME FILE: prints this figure of the first frame.
figure() {
    rc-info --json "$2" | sed -n "1s/.*\"$1\": \([^,]*\),.*/\1/p"
}

# nothing VALUE SIZE "sentence": the value is 0 up to the rounding of numbers of this size.
nothing() {
    between "$(awk -v s="$2" -v r="$rounding" 'BEGIN { print -r * s }')" "$1" \
        "$(awk -v s="$2" -v r="$rounding" 'BEGIN { print r * s }')" "$3"
}

# ---- effect of the steps ----

# heights 7 + 5 i - 3 j nm, and 40 nm more at the middle node, which then becomes missing
awk 'BEGIN { for (j = 0; j < 11; j++) { s = ""
    for (i = 0; i < 13; i++) s = s " " (i > 4 && i < 8 && j > 3 && j < 7 ? "NaN" : 7 + 5 * i - 3 * j)
    print s } }' >plane.txt
rc-import --dx 1.1um --dy 1um --z-unit nm plane.txt -o plane.rcg

claim "a plane is removed" rc-detrend --plane plane.rcg -o flat.rcg
rc-info --json flat.rcg >flat.json
nothing "$(field rms flat.json)" 1e-8 "and nothing of it is left"
near "$(field missing flat.json)" 9 "$same" "what was missing is missing still"
# the last 1000 bytes of the values, before the checksum
claim "--poly 1 is the same plane" bash -c '
    rc-detrend --poly 1 plane.rcg | tail -c 1024 | head -c 1000 >one &&
    tail -c 1024 flat.rcg | head -c 1000 | cmp - one'
claim "holes are filled" rc-detrend --fill plane.rcg -o filled.rcg
rc-info --json filled.rcg >filled.json
near "$(field missing filled.json)" 0 "$same" "none is left"
near "$(field filled filled.json)" 9 "$same" "their number is in the stream"
near "$(field mean filled.json)" 22e-9 "$summed" "with a plane in a plane"
claim "a second --fill keeps the number of filled points" \
    says '"filled": "9"' bash -c 'rc-detrend --fill filled.rcg | rc-info --json'
claim "--form of degree 2 removes a sphere" bash -c \
    'rc-synth sphere --radius 2.385mm --nx 33 --ny 47 --dx 1.1um --dy 1um | rc-detrend --poly 2 -o ball.rcg'
nothing "$(figure rms ball.rcg)" 1e-7 "  which leaves nothing"
claim "the mean alone is removed" bash -c 'rc-detrend --poly 0 plane.rcg | rc-info --json >mean.json'
nothing "$(field mean mean.json)" 1e-9 "  is then 0"
claim "a profile is levelled" bash -c "printf '1 2 4 8 NaN 32\n' | rc-import --dx 1um --z-unit um - |
    rc-detrend --poly 4 --fill -o profile.rcg"
nothing "$(figure rms profile.rcg)" 1e-5 "  with as many points as coefficients leaves nothing"

# ---- rows ----

# rows 0 1 -1 2 -2 (nm), row j higher by 100 j, one with a missing point and one with a spike
awk 'BEGIN { for (j = 0; j < 6; j++) print 0 + 100 * j, 1 + 100 * j, (j == 2 ? "NaN" : -1 + 100 * j), (j == 2 ? "NaN" : 2 + 100 * j), -2 + 100 * j }' >lines.txt
rc-import --dx 1um --z-unit nm lines.txt -o lines.rcg
rows() { rc-export --format csv "$1" | grep -v '^#' | awk -F '[,;	 ]+' '/^[-0-9n]/ { s = ""; for (i = 1; i <= NF; i++) s = s sprintf("%.3g ", 1e9 * $i); print s }' | head -n "${2:-3}" | tail -n 1; }
claim "--rows offset subtracts the median of each row" rc-detrend --rows offset lines.rcg -o offset.rcg
claim "  the shape of each row does not change" test "$(rows offset.rcg 6)" = "0 1 -1 2 -2 "
rc-info --json offset.rcg >offset.json
near "$(field missing offset.json)" 2 "$same" "  and what is missing, missing"
claim "  the history has the option" says 'rc-detrend [0-9.]* --rows offset"' rc-info --json offset.rcg
claim "--rows slope subtracts the slope of each row" bash -c 'rc-detrend --rows tilt plane.rcg -o tilted.rcg && rc-detrend --robust --rows tilt plane.rcg -o robust.rcg'
nothing "$(figure rms tilted.rcg)" 1e-7 "  leaves nothing of a plane"
nothing "$(figure rms robust.rcg)" 1e-7 "  --robust neither"
claim "--rows bow subtracts the bow of each row" bash -c 'rc-synth sphere --radius 2.385mm --nx 33 --ny 47 --dx 1.1um --dy 1um | rc-detrend --rows bow -o bow.rcg'
nothing "$(figure rms bow.rcg)" 1e-7 "  leaves nothing of a paraboloid"
claim "offsets of rows keep a period" bash -c 'rc-synth wave --nx 16 --dx 1um --wavelength 8um --amplitude 1nm | rc-detrend --rows offset | rc-info | grep -q "periodic.*yes"'
claim "  slopes of rows end that along x" warns 'a periodic surface is not periodic along x without its form: it gets periodic=y' bash -c 'rc-synth wave --nx 16 --dx 1um --wavelength 8um --amplitude 1nm | rc-detrend --rows tilt -o w.rcg'
refuses 2 '--rows offst: it must be one of offset|tilt|bow' "no such level" "rc-detrend --rows offst lines.rcg -o x.rcg"

# ---- their order ----

# one column far away: levelled by the measured points, or by the filled ones too
printf '0 0 9 NaN NaN\n0 0 9 NaN NaN\n0 0 9 NaN NaN\n' | rc-import --dx 1um --z-unit nm - -o step.rcg
claim "the order of the steps matters" bash -c '
    rc-detrend --plane --fill step.rcg -o a.rcg && rc-detrend --fill --plane step.rcg -o b.rcg &&
    says "rc-detrend [0-9.]* --plane --fill" rc-info a.rcg &&
    says "rc-detrend [0-9.]* --fill --plane" rc-info b.rcg'
# first: 0 0 9 minus 4.5 i - 1.5 is 1.5 -3 1.5, and twice 1.5: the mean is 0.6 nm
near "$(figure mean a.rcg)" 0.6e-9 "$summed" "plane first"
nothing "$(figure mean b.rcg)" 1e-9 "fill first: the mean is 0"
claim "the history has the steps with their values, in their order" \
    says 'rc-import [^|]* \| rc-detrend [0-9.]* --poly 2 --fill --poly 0 --plane"' bash -c '
    rc-detrend --poly 2 --fill --poly 0 --plane plane.rcg | rc-info --json'

# ---- other frames and cases ----

sed 's/^channel=height/channel=weight/' step.rcg | reseal >weight.rcg
# one case of two frames, without the end line of the first
{ head -c -9 weight.rcg; head -c -9 plane.rcg; printf 'RCGEND 2\n'; } >both.rcg
claim "another channel of the case is passed on unchanged" bash -c '
    rc-detrend --plane both.rcg -o out.rcg && [ "$(rc-info --json out.rcg | wc -l)" = 2 ] &&
    head -c $(($(wc -c <weight.rcg) - 9)) weight.rcg >want &&
    head -c $(wc -c <want) out.rcg | cmp - want'
refuses 1 'case 1: no frame with the channel height, only weight' "a case without heights" "rc-detrend --plane weight.rcg -o no.rcg"
claim "  no file is left" test ! -e no.rcg
refuses 1 'case 2: no frame with the channel height, only weight' "the second case without heights" \
    "rc-detrend --plane plane.rcg weight.rcg | cat >cut.rcg"
refuses 1 'this stream failed: rc-detrend: weight.rcg, case 2: no frame' "  and its reader fails too" "rc-info cut.rcg"
claim "every case is levelled" bash -c '
    cat plane.rcg plane.rcg | rc-detrend --plane | rc-info --json >two.json &&
    [ "$(wc -l <two.json)" = 2 ] && grep -q "\"case\": 2" two.json'
claim "a periodic surface stays periodic without its mean, but not without its form" bash -c '
    rough="rc-synth selfaffine --hurst 0.8 --rms-slope 0.1 --nx 32 --dx 1um"
    $rough | rc-detrend --quiet --plane -o without.rcg && says periodic=no rc-info without.rcg &&
    $rough | rc-detrend --poly 0 --fill -o with.rcg && says periodic=yes rc-info with.rcg'
claim "single precision stays single precision" says '"type": "f32"' bash -c '
    rc-synth sphere --radius 1mm --nx 9 --dx 1um --type f32 | rc-detrend --plane | rc-info --json'

# ---- refusals ----

refuses 2 'nothing to do: give --plane, --poly N or --fill' "nothing to do" "rc-detrend plane.rcg"
refuses 2 '--poly 21: it must be at least 0 and at most 20' "a degree of 21" "rc-detrend --poly 21 plane.rcg"
refuses 2 '--poly 1.5: it must be a whole number' "a degree of 1.5" "rc-detrend --poly 1.5 plane.rcg"
refuses 2 '--poly -1: it must be at least 0' "a degree of -1" "rc-detrend --poly -1 plane.rcg"
refuses 2 'option --poly needs an argument' "no degree" "rc-detrend --poly"
refuses 1 'frame 1 \(height\): .* 10 coefficients, and only 9 points are there: take a lower degree' "more coefficients than places" \
    "rc-detrend --poly 3 step.rcg"
printf 'NaN NaN\nNaN NaN\n' | rc-import --dx 1um --z-unit nm - -o nothing.rcg
refuses 1 'all 4 values are missing: nothing to fill them from' "nothing measured, to fill from" "rc-detrend --fill nothing.rcg"
refuses 1 '3 coefficients, and only 0 points are there' "nothing measured, to level" "rc-detrend --plane nothing.rcg"
# makes the first value infinite: its last two bytes are sign and exponent
perl -0777 -pe 's/(\n\n).{8}/$1\0\0\0\0\0\0\xf0\x7f/s' plane.rcg | reseal >infinite.rcg
refuses 1 '1 heights are infinite, the first in column 0 of row 0' "an infinite height" \
    "rc-detrend --plane infinite.rcg"
refuses 1 '13 x 11 nodes need about .*, --memory allows' "more memory than is allowed" "rc-detrend --fill --memory 1500 plane.rcg"
refuses 1 'No space left' "a full disk" "rc-detrend --plane plane.rcg >/dev/full"
