# SPDX-License-Identifier: GPL-3.0-or-later
# rc-solve --checkpoint and --resume: an interrupted run continues, with the result of an uninterrupted one.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 200 --ny 150 --dx 1um --hurst 0.8 --rms-slope 0.1 --short-cut 8um --rolloff 40um \
    --seed 3 -o rough.rcg
solve="rc-solve --periodic --estar 1GPa --output pressure"

claim "a list of loads is solved without interruption" bash -c "$solve --load 0.1N:0.5N:3 --checkpoint kept.rcg --report whole.json -o whole.rcg rough.rcg"
claim "the resumed run gives the same bits, in one step per case" bash -c "
    $solve --load 0.1N:0.5N:3 --checkpoint kept.rcg --resume --report again.json -o again.rcg rough.rcg &&
    cmp whole.rcg again.rcg && [ \$(grep -c '\"iterations\": 1,' again.json) = 3 ]"
for case in 1 2 3; do near "$(total pressure again.rcg $case)" 0.$((2 * case - 1)) "$summed" "  which carry load $case"; done
claim "the report omits what needs the iteration, with the reason" bash -c "
    $solve --load 0.1N:0.5N:3 --checkpoint kept.rcg --resume --discretization --report left.json -o left.rcg rough.rcg &&
    grep -q '\"discretization\": \"left out: resumed' left.json &&
    grep -q '\"max_pressure_error_estimate\": null' left.json"
claim "the checkpoint is a grid stream with a frame for each case" says '^3$' bash -c "rc-info kept.rcg | grep -c 'frame . (state)'"

# 300,000 bytes contain the first frame and a part of the second
claim "the complete frames of a truncated checkpoint can be resumed" bash -c "
    head -c 300000 kept.rcg >torn.rcg &&
    $solve --load 0.1N:0.5N:3 --checkpoint torn.rcg --resume --report torn.json -o torn-out.rcg rough.rcg &&
    [ \$(grep -c '\"iterations\": 1,' torn.json) = 1 ] &&
    says '^3$' bash -c \"rc-info torn.rcg | grep -c 'frame . (state)'\""
claim "--resume without a file starts a first run" bash -c "
    $solve --load 0.3N --checkpoint fresh.rcg --resume -o fresh-out.rcg rough.rcg && [ -s fresh.rcg ]"
# K p in double precision, a correction, and another correction with the whole working set: 1 + 0.5 + 0.5
claim "the resumed run does no work on coarser grids" bash -c "
    $solve --load 0.3N --checkpoint fresh.rcg --resume --report fresh.json -o fresh-out.rcg rough.rcg"
near "$(field convolutions fresh.json)" 2 1e-15 "but what tells that it is done"

# pk99 takes hundreds of steps; the signal is sent when the first frames exist.
interrupted() {
    local status
    $solve --load 0.3N --method pk99 --tol 1e-12 --checkpoint cut.rcg --interval 0.02 --report cut.json -o cut-out.rcg rough.rcg &
    until [ -s cut.rcg ] || ! kill -0 $!; do sleep 0.02; done
    kill -TERM $!
    wait $!
    status=$?
    [ $status = 143 ] && [ "$(field converged cut.json)" = false ] && rc-info cut.rcg >/dev/null
}
claim "after a signal the checkpoint has the current pressure" interrupted
claim "--resume continues from this pressure" bash -c "
    $solve --load 0.3N --method pk99 --tol 1e-12 --checkpoint cut.rcg --resume --report on.json -o on.rcg rough.rcg &&
    $solve --load 0.3N --method pk99 --tol 1e-12 --report straight.json -o straight.rcg rough.rcg"
# Both to 1e-12 in the mean over the map; a single pressure may have a larger error.
near "$(field max_pressure on.json)" "$(field max_pressure straight.json)" 1e-10 "to the same largest pressure"
claim "it takes fewer steps than a run from the start" test "$(field iterations on.json)" -lt "$(field iterations straight.json)"
claim "a search for an approach continues from the load that it had found" bash -c "
    $solve --approach 0.5um --checkpoint near.rcg --report near.json -o near-out.rcg rough.rcg &&
    $solve --approach 0.5um --checkpoint near.rcg --resume --report near2.json -o near2-out.rcg rough.rcg &&
    [ \$(grep -o '\"iterations\": [0-9]*' near2.json | cut -d' ' -f2) -le 2 ]"
near "$(field approach near2.json)" "$(field approach near.json)" "$(awk 'BEGIN { print (200 * 150) ^ -0.75 }')" \
    "and to the same approach, within the tolerance"

cp kept.rcg other.rcg
refuses 1 'the file exists.*--resume' "a checkpoint is not written over" \
    "$solve --load 0.1N --checkpoint other.rcg -o x.rcg rough.rcg"
refuses 1 'another problem: load was 0.1, is 0.2' "that of another load" \
    "$solve --load 0.2N --checkpoint other.rcg --resume -o x.rcg rough.rcg"
refuses 1 'another problem: --estar was 1000000000, is 2000000000' "of another modulus" \
    "rc-solve --periodic --estar 2GPa --load 0.1N --checkpoint other.rcg --resume -o x.rcg rough.rcg"
refuses 1 'another problem: --radius was not given, is 1$' "of another form" \
    "$solve --radius 1m --load 0.1N --checkpoint other.rcg --resume -o x.rcg rough.rcg"
refuses 1 'another problem: frame height: the values differ$' "of other heights" \
    "rc-pick --mirror x rough.rcg | $solve --load 0.1N --checkpoint other.rcg --resume -o x.rcg"
refuses 1 'another grid, 200 x 150' "of another grid" \
    "rc-synth sphere --nx 20 --dx 1um --radius 1mm | $solve --load 0.1N --checkpoint other.rcg --resume -o x.rcg"
refuses 1 'rough.rcg: a grid stream, but no checkpoint: name another' "a stream that is none" \
    "$solve --load 0.1N --checkpoint rough.rcg --resume -o x.rcg rough.rcg"
echo "notes of a user" >notes.txt
refuses 1 'no pressure can be read from it \(.notes of a user. is in place of a frame' "a file that is none" \
    "$solve --load 0.1N --checkpoint notes.txt --resume -o x.rcg rough.rcg"
claim "the file stays unchanged" grep -qx "notes of a user" notes.txt
# ---- frames with right checksums whose numbers are false ----

# changed KEY VALUE: fresh.rcg, of one frame, with another value of this key.
changed() { perl -0777 -pe "s/^\Q$1\E=.*\$/$1=$2/m" fresh.rcg | reseal; }
resumed="$solve --load 0.3N --resume -o x.rcg rough.rcg --checkpoint"
{ cat fresh.rcg fresh.rcg && changed checkpoint.map 18014398509481984; } >far.rcg
refuses 1 'frame 3 has checkpoint.map=18014398509481984, which is not a whole number from 0' \
    "the number of a map that no file holds" "$resumed far.rcg"
for map in -1 0.5 nan 1e300 none ''; do
    changed checkpoint.map "$map" >false.rcg
    refuses 1 "frame 1 has checkpoint.map=$map, which is not a whole number" "a map $map" "$resumed false.rcg"
done
for case in 0 -1 0.5 inf; do
    changed checkpoint.case "$case" >false.rcg
    refuses 1 "frame 1 has checkpoint.case=$case, which is not a whole number from 1" "a case $case" "$resumed false.rcg"
done
changed checkpoint.map 1 >second.rcg
refuses 1 'case 1 cannot be continued \(frames are missing\)' "a second map without a first" "$resumed second.rcg"
cat fresh.rcg second.rcg >twice.rcg
refuses 1 'frames are missing' "  or after the last map of another state" "$resumed twice.rcg"
{
    perl -0777 -ne 's/^checkpoint\.numbers=.*\n//m; s/^n[xy]=\K.*$/1/mg; /^(.*?\n\n.{8})/s; print "$1crc32 00000000\nRCGEND 1\n"' \
        fresh.rcg | reseal
    cat second.rcg
} >narrow.rcg
refuses 1 'it belongs to another grid, 1 x 1 nodes' "a first map of one node" "$resumed narrow.rcg"
changed checkpoint.numbers "$(sed -n 's/^checkpoint.numbers=//p' fresh.rcg | head -n 1) x" >words.rcg
refuses 1 'its header holds something else than numbers' "a word among the numbers" "$resumed words.rcg"
for numbers in '' 1 '1 2' '1e300 1' '-1 1' 'nan 1' values; do
    changed checkpoint.numbers "$numbers" >few.rcg
    refuses 1 'cannot be continued|another grid' "the numbers '$numbers'" "$resumed few.rcg"
done

refuses 2 '--resume has no effect without --checkpoint' "--resume alone" "$solve --load 0.1N --resume -o x.rcg rough.rcg"
# killed inside the first frame: starting again loses nothing
head -c 5000 kept.rcg >first.rcg
claim "a file with an incomplete first frame is started again" \
    warns 'first.rcg: its first frame is incomplete: this run starts from the beginning' \
    $solve --load 0.1N --checkpoint first.rcg --resume -o begun.rcg rough.rcg
claim "it becomes a normal checkpoint" bash -c "rc-info --quiet first.rcg >/dev/null &&
    $solve --load 0.1N --checkpoint first.rcg --resume --report first.json -o again.rcg rough.rcg"
claim "the next run continues from it" test "$(field iterations first.json)" -le 1
# a line as long as one block of the reader, so that its line feed is not taken for the end of the header
rc-pick --set "note=$(printf '%0250d' 0)" rough.rcg -o noted.rcg
$solve --load 0.1N --checkpoint noted-kept.rcg --quiet -o x.rcg noted.rcg && rm x.rcg
head -c 5000 noted-kept.rcg >noted-first.rcg
claim "a file with a long line in its header is started again too" \
    warns 'noted-first.rcg: its first frame is incomplete: this run starts from the beginning' \
    $solve --load 0.1N --checkpoint noted-first.rcg --resume -o noted-begun.rcg noted.rcg
(head -c 5000 kept.rcg && printf X && tail -c +5002 kept.rcg) >spoilt.rcg
cp spoilt.rcg as-it-was.rcg
refuses 1 'frame 1 cannot be read .*checksum' "one that is spoilt, not cut off, is refused" \
    "$solve --load 0.1N --checkpoint spoilt.rcg --resume -o x.rcg rough.rcg"
claim "the file stays unchanged" cmp spoilt.rcg as-it-was.rcg
# The index reads headers only, and of each case the last state is loaded.
cat spoilt.rcg kept.rcg >later.rcg
claim "damage in a state that a later one replaces does not matter" \
    $solve --load 0.1N --checkpoint later.rcg --resume --report later.json -o again.rcg rough.rcg
claim "  the later one is read" test "$(field iterations later.json)" -le 1
cat kept.rcg spoilt.rcg >earlier.rcg
refuses 1 'frame 4 cannot be read .*checksum' "  but in the last one" "$solve --load 0.1N --checkpoint earlier.rcg --resume -o x.rcg rough.rcg"
# An earlier state of 64 GiB, which is a hole in the file.
perl -0777 -ne '/^(.*?)\n\n/s; my $h = $1; $h =~ s/^ny=.*/ny=65536/m; $h =~ s/^nx=.*/nx=131072/m; print "$h\n\n"' kept.rcg >large.rcg
truncate -s +68719476736 large.rcg
echo 'crc32 00000000
RCGEND 1' >>large.rcg
cat kept.rcg >>large.rcg
claim "  nor are the values of 64 GiB read" timeout 60 \
    $solve --load 0.1N --checkpoint large.rcg --resume --report later.json -o again.rcg rough.rcg
claim "  the later one is read" test "$(field iterations later.json)" -le 1
rm large.rcg
head -c 500000 kept.rcg >tail.rcg # two frames and a part of the third; a power failure may append zeros
head -c 100000 /dev/zero >>tail.rcg
claim "an incomplete last frame is removed" bash -c "
    $solve --load 0.1N:0.5N:3 --checkpoint tail.rcg --resume --report tail.json -o tail-out.rcg rough.rcg &&
    [ \$(grep -c '\"iterations\": 1,' tail.json) = 2 ] && says '^3$' bash -c \"rc-info tail.rcg | grep -c 'frame . (state)'\""
if [ -w /dev/full ]; then
    refuses 1 '--checkpoint /dev/full: the file exists' "nor over a device" \
        "$solve --load 0.1N --checkpoint /dev/full -o x.rcg rough.rcg"
fi
refuses 1 'values are NaN or infinite' "a run is refused before its first state" \
    "rc-synth sphere --nx 8 --dx 1um --radius 1mm | rc-pick --resample 0.4um | perl -0777 -pe 's/\n\n.{8}/\n\n\0\0\0\0\0\0\xf8\x7f/s' >nan.rcg
    $solve --load 0.1N --checkpoint empty.rcg -o x.rcg <(reseal <nan.rcg)"
claim "its empty checkpoint is in no one's way" bash -c "
    $solve --load 0.1N --checkpoint empty.rcg -o empty-out.rcg rough.rcg && [ -s empty.rcg ]"
claim "refused runs leave no file" bash -c '! ls x.rcg* 2>/dev/null'
