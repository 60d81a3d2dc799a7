# SPDX-License-Identifier: GPL-3.0-or-later
# rc-pick writes the selected frames completely, with the keys that were set, and lists the existing names if
# a requested one is missing.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 32 --dx 1um --hurst 0.8 --rms-height 10nm --seed 2 -o surface.rcg
rc-solve --quiet --tol 1e-9 --load 10mN,20mN --estar 100GPa --hardness 2GPa --output pressure,gap,height,plastic \
    surface.rcg -o result.rcg
rc-stress --nu 0.3 --depths 0,5um,10um --components mises,szz result.rcg -o stress.rcg

# frames FILE: prints a line "case channel depth" for each frame.
frames() {
    rc-info --json "$@" | perl -ne '
        my ($case) = /"case": (\d+)/; my ($channel) = /"channel": "(\w+)"/; my ($depth) = /"depth": "([^"]*)"/;
        print join(" ", $case, $channel, defined $depth ? $depth : ()), "\n"'
}
export -f frames
# values FILE: prints all values of a stream in their order, without headers and checksums.
values() {
    perl -0777 -ne 'while (/\GRCG1\n(.*?)\n\n/gcs) { my %k = map { split /=/, $_, 2 } split /\n/, $1;
        my $n = $k{nx} * $k{ny} * ($k{type} eq "f64" ? 8 : 4); /\G(.{$n})crc32 \w{8}\n/gcs or die; print $1 }' "$1"
}
export -f values

# ---- choosing ----

claim "--channel takes a channel of every case" bash -c '
    rc-pick --channel gap result.rcg -o gap.rcg && [ "$(frames gap.rcg | tr "\n" ,)" = "1 gap,2 gap," ]'
claim "the values are those of the solution" bash -c '
    rc-solve --quiet --tol 1e-9 --load 10mN,20mN --estar 100GPa --hardness 2GPa --output gap surface.rcg -o want.rcg
    values gap.rcg >a && values want.rcg >b && [ -s a ] && cmp a b'
claim "several channels come in the order of the stream" bash -c '
    [ "$(rc-pick --channel height,pressure result.rcg | frames | tr "\n" ,)" = "1 pressure,1 height,2 pressure,2 height," ]'
claim "a selected case keeps its number" bash -c '[ "$(rc-pick --case 2 --channel gap <result.rcg | frames)" = "2 gap" ]'
claim "cases of several files have consecutive numbers" bash -c '
    [ "$(rc-pick --case 1,3 surface.rcg result.rcg | frames | cut -d " " -f 1 | uniq | tr "\n" ,)" = "1,3," ]'
claim "--depth selects depths to a thousandth" bash -c '
    [ "$(rc-pick --depth 0,10.009um --case 1 --channel szz stress.rcg | frames | tr "\n" ,)" = "1 szz 0,1 szz 1e-05," ]'
# a stream with the cases 1 to 6
for k in 1 2 3 4 5 6; do cat surface.rcg; done >six.rcg
cases_of() { rc-pick --case "$1" six.rcg | frames | cut -d ' ' -f 1 | tr '\n' ,; }
claim "--case takes a range of cases" test "$(cases_of 2-4)" = 2,3,4,
claim "  in a list too" test "$(cases_of 1,4-6)" = 1,4,5,6,
claim "  of one case too" test "$(cases_of 5-5)" = 5,
claim "  the history has the cases" says 'rc-pick [0-9.]* --case 1,4,5,6"' bash -c 'rc-pick --case 1,4-6 six.rcg | rc-info --json'
refuses 2 "--case 3-1: '3-1': a range goes up" "a range that goes down" 'rc-pick --case 3-1 six.rcg'
refuses 2 "--case 1-: '-' after 1: a number without a unit is expected, or several with commas" "a range without an end" 'rc-pick --case 1- six.rcg'
refuses 2 "--case 1-3-5: '-3-5' after 1: a number without a unit is expected" "a range of three numbers" 'rc-pick --case 1-3-5 six.rcg'
refuses 2 "a range goes up, and has at most 1000000 numbers" "a range without limit" 'rc-pick --case 1-99999999999999999999999 six.rcg'
# nearest ASKED EXPECTED: compares the selected depth for mises in case 1 of stress.rcg, which has 0, 5 and 10
# um
nearest() { [ "$(rc-pick --depth "$1" --case 1 --channel mises stress.rcg 2>told.txt | frames | tr "\n" ,)" = "$2" ]; }
export -f nearest
claim "  without an exact match it takes the nearest depth" bash -c 'nearest 7um "1 mises 5e-06," && nearest 8um "1 mises 1e-05,"'
claim "  a message says so" grep -qx 'rc-pick: --depth: no frame is at 8e-06 m: the nearest depth, 1e-05 m, is taken' told.txt
claim "  it may be half a step beyond the last depth" nearest 12.49um "1 mises 1e-05,"
claim "  of two requests for one depth the frame is written once" nearest 4um,5um,6um "1 mises 5e-06,"
claim "  an exact match causes no message" bash -c 'nearest 0,10um "1 mises 0,1 mises 1e-05," && [ ! -s told.txt ]'
claim "  all channels of a depth come in the order of the stream, for any order of depths" bash -c '
    rc-stress --nu 0.3 --depths 10um,0,5um --components mises,szz result.rcg |
        rc-pick --depth 9um,1um - 2>/dev/null | frames | tr "\n" , |
        grep -qx "1 szz 1e-05,1 mises 1e-05,1 szz 0,1 mises 0,2 szz 1e-05,2 mises 1e-05,2 szz 0,2 mises 0,"'
claim "  with their own values" bash -c '
    rc-pick --depth 7um --channel mises stress.rcg 2>/dev/null | values - >a &&
    rc-stress --nu 0.3 --depths 5um --components mises result.rcg | values - >b && [ -s a ] && cmp a b'
claim "a range of depths is accepted" bash -c '[ "$(rc-pick --depth 0:10um:3 stress.rcg | frames | wc -l)" = 12 ]'
claim "without a selection every frame is written" bash -c '
    rc-pick --set load= result.rcg -o all.rcg && values all.rcg >a && values result.rcg >b && cmp a b'
claim "the key with the number of frames is removed, because it may be wrong" bash -c '
    rc-pick --channel szz stress.rcg -o s.rcg && lacks "frames=" s.rcg && says frames=6 cat stress.rcg'
claim "--type changes the type of the values" says '"type": "f32"' bash -c \
    'rc-pick --type f32 --channel gap result.rcg | rc-info --json'

# ---- setting ----

claim "a plastic shape becomes a height that rc-solve presses" bash -c '
    rc-pick --case 2 --channel plastic --set channel=height result.rcg -o plastic.rcg &&
    [ "$(frames plastic.rcg)" = "2 height" ] &&
    rc-solve --quiet --tol 1e-9 --load 20mN --estar 100GPa --hardness 2GPa --output pressure plastic.rcg -o again.rcg'
rc-info --json again.rcg >again.json
rc-pick --case 2 --channel pressure result.rcg | rc-info --json >first.json
# the error of a pressure map is 1e-9 of its sum, which is 1024 times the mean of 19.5 MPa. If all of it is at
# one node, the error of the rms is 2e-9 1024 19.5 MPa / 32
near "$(field rms again.json)" "$(field rms first.json)" 2e-8 "  and it carries what it carried"
claim "keys are set, replaced and removed" bash -c '
    rc-pick --channel gap --set load=7 --set colour="blue = sky" --set estar= --set dx=2um --set dy=0.003mm \
        --set unit=nm result.rcg | rc-info --json >set.json'
for line in '"load": "7"' '"colour": "blue = sky"' '"unit": "nm"' '"dx": 2e-06' '"dy": 3e-06' \
    '"hardness": "2000000000"'; do
    claim "  $line" grep -q "$line" set.json
done
claim "  the key estar is removed" lacks '"estar"' set.json
near "$(field minimum set.json)" "$(rc-pick --channel gap result.rcg | rc-info --json >g && field minimum g)" "$same" \
    "  with the values as they were"
claim "the history has the steps, in SI and in their order" says \
    'rc-pick [0-9.]* --channel gap --depth 0 --case 1 --set dx=2e-06 --set load= --set load=7"' bash -c '
    rc-pick --channel gap --set depth=0 result.rcg | rc-pick --channel gap --depth 0um --case 1 --set dx=2um \
        --set load= --set load=7 | rc-info --json'
claim "the spacing of a height without results can be set" says 'dx 3 um, dy 1 um' bash -c 'rc-pick --set dx=3um surface.rcg | rc-info'

# ---- refusals ----

refuses 2 'nothing to do: give --channel, --depth or --case, or --set KEY=VALUE' "nothing to do" 'rc-pick surface.rcg'
while read -r key why; do
    refuses 2 "--set $key=1: $key cannot be set: $why" "$key is not set" "rc-pick --set $key=1 surface.rcg"
done <<'END'
nx it counts
ny it counts
type --type says
crc32 it is computed from
case frames of a case belong together
history it records
END
for key in channel unit dx dy; do
    refuses 2 "--set $key=: every frame has a $key" "$key is not removed" "rc-pick --set $key= surface.rcg"
done
refuses 2 '--set Load=1: KEY=VALUE is expected' "a key with a capital letter" 'rc-pick --set Load=1 surface.rcg'
refuses 2 '--set load: KEY=VALUE is expected' "a key without a value" 'rc-pick --set load surface.rcg'
refuses 2 "--set dx=1Pa: unknown unit 'Pa'" "a spacing that is not a length" 'rc-pick --set dx=1Pa surface.rcg'
refuses 2 '--set dx=0: it must be above 0' "no spacing" 'rc-pick --set dx=0 surface.rcg'
refuses 2 '--case 1.5: it must be a whole number' "half a case" 'rc-pick --case 1.5 surface.rcg'
refuses 2 "--channel 'a,,b': a name is empty" "a list with a hole" 'rc-pick --channel a,,b surface.rcg'
refuses 1 'no frame with the channel mises, only pressure, gap, height, plastic' "a channel that is not there, naming those that are" \
    'rc-pick --channel pressure,mises -o out.rcg result.rcg'
claim "  no file is left" test ! -e out.rcg
refuses 1 'no case 3: there are cases 1, 2' "nor is a case" 'rc-pick --case 1,3 result.rcg | cat'
refuses 1 'no frame at depth 1.251e-05 m: there are 0, 5e-06, 1e-05 m' "nor a depth more than half a step beyond the last" \
    'rc-pick --channel mises --depth 12.51um stress.rcg | cat'
refuses 1 'no frame at depth 5.1e-06 m: there are 5e-06 m' "nor one beside the only one" \
    'rc-pick --channel mises --depth 5um stress.rcg | rc-pick --depth 5.1um | cat'
refuses 1 'no frame has a depth' "nor any" 'rc-pick --depth 6um result.rcg | cat'
rc-pick --case 1 --channel mises stress.rcg >one.rcg
rc-pick --case 2 --channel szz stress.rcg >two.rcg
{ head -c -9 one.rcg; head -c -9 two.rcg; printf 'RCGEND 6\n'; } >mixed.rcg
refuses 1 'no frame with the channel szz among the requested cases and depths' "a channel of another case" \
    'rc-pick --channel mises,szz --case 1 mixed.rcg | cat'
refuses 1 'give pressure and gap of one case the same name: choose one by --channel' "two channels of one name" \
    'rc-pick --set channel=height result.rcg | cat'
claim "  frames of one name at several depths are accepted" says '^6$' bash -c '
    rc-pick --channel szz --set channel=below stress.rcg | frames | grep -c below'
refuses 1 'case 1, frame 3 .*: take the height alone' "a spacing of a height beside its pressure" \
    'rc-pick --set dx=2um result.rcg | cat'
refuses 1 'this stream failed' "a failed choice fails its reader too" 'rc-pick --channel gap --case 1,9 result.rcg 2>/dev/null >cut; rc-info cut'
refuses 1 'the stream has no frame' "an empty stream" 'printf "RCGEND 0\n" | rc-pick --channel height | cat'
refuses 1 'No space left' "a full device" 'rc-pick --channel gap result.rcg >/dev/full'
