# SPDX-License-Identifier: GPL-3.0-or-later
# rc-slip --checkpoint and --resume: an interrupted path continues, with the result of an uninterrupted one.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 64 --dx 10um --radius 7.5mm -o sphere.rcg
rc-solve --quiet --load 240N --E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3 -o alike.rcg sphere.rcg
rc-solve --quiet --load 240N --E1 210GPa --nu1 0.3 --E2 rigid -o rigid.rcg sphere.rcg
column() { # NAME ROW FILE
    awk -F '\t' -v n="$1" -v r="$2" 'NR == 1 { for (i = 1; i <= NF; i++) { split($i, h, "/"); if (h[1] == n) c = i } } NR == r + 1 { print $c }' "$3"
}
work() { awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "convolutions") c = i } NR > 1 { s += $c } END { print s }' "$1"; }
values() { rc-pick --channel "$2" --case "$3" "$1" | rc-export --format csv | grep -v '^#' | tr ',' '\n'; }
# apart FILE FILE CHANNEL CASE: prints the relative L1 distance of this frame in both files
apart() { paste -d ' ' <(values "$1" "$3" "$4") <(values "$2" "$3" "$4") | awk '{ d = $1 - $2; s += d < 0 ? -d : d; t += $2 < 0 ? -$2 : $2 } END { print s / t }'; }

# ---- changing loads and forces, equal bodies ----

printf '100N 0 0\n240N 43.2N 0\n240N -20N 30N\n120N 20N 0\n' >way.txt
slip="rc-slip --quiet --mu 0.3 --history way.txt"
claim "a path is solved without interruption" bash -c "$slip --checkpoint kept.rcg --report whole.tsv -o whole.rcg alike.rcg"
near "$(total pressure alike.rcg 1)" 240 "$summed" "  its contact carries the load"
near "$(total traction-x whole.rcg 2)" 43.2 1e-3 "  its tractions carry the force"
near "$(column tangential_x 3 whole.tsv)" -20 1e-3 "  and its report has it"
near "$(column stick_fraction 2 whole.tsv)" "$(awk 'BEGIN { print 0.4 ^ (2 / 3) }')" "$coarse_grid" \
    "  and the part that sticks is that of Cattaneo and Mindlin, (1 - Q/mu P)^(2/3)"
claim "  a checkpoint does not change the result" bash -c "$slip -o without.rcg alike.rcg && cmp whole.rcg without.rcg"
states() { grep -ac '^checkpoint.numbers=' "$1"; } # the last frame of each has its numbers
claim "the checkpoint has a state for each corner" test "$(states kept.rcg)" = 4
cp kept.rcg all.rcg
claim "a resumed complete run does no work" bash -c "$slip --checkpoint kept.rcg --resume --report again.tsv -o again.rcg alike.rcg"
for case in 2 3 4; do between 0 "$(apart again.rcg whole.rcg traction-x $case)" 1e-4 "  to the same tractions, case $case"; done
near "$(column largest_slip_total 4 again.tsv)" "$(column largest_slip_total 4 whole.tsv)" 1e-3 "  and the same slip"
near "$(column dissipated_total 4 again.tsv)" "$(column dissipated_total 4 whole.tsv)" 1e-3 "  and the same work"
between 0 "$(work again.tsv)" "$(awk -v w="$(work whole.tsv)" 'BEGIN { print w / 2 }')" "  in less than half of the convolutions"

head -c $(($(stat -c %s all.rcg) * 5 / 8)) all.rcg >torn.rcg # two of them, and a part of the next
claim "the complete states of a truncated checkpoint can be resumed" bash -c "$slip --checkpoint torn.rcg --resume --report torn.tsv -o torn-out.rcg alike.rcg"
for case in 2 4; do between 0 "$(apart torn-out.rcg whole.rcg traction-x $case)" 1e-4 "  to the same tractions, case $case"; done
between "$(work again.tsv)" "$(work torn.tsv)" "$(work whole.tsv)" "  in fewer convolutions"
claim "  the checkpoint is complete again" test "$(states torn.rcg)" -ge 4
claim "--resume without a file starts a first run" bash -c "$slip --checkpoint fresh.rcg --resume -o fresh-out.rcg alike.rcg && cmp fresh-out.rcg whole.rcg"

# ---- dissimilar bodies, ended by a signal ----

press="rc-slip --mu 0.3 --tangential 20N --increments 16"
stopped() {
    $press --progress --checkpoint cut.rcg --report cut.tsv -o cut-out.rcg rigid.rcg 2>progress.txt &
    until grep -q 'increment [4-9] of 16' progress.txt || ! kill -0 $!; do sleep 0.02; done
    kill -TERM $!
    wait $!
    local status=$?
    [ $status = 143 ] && [ "$(column converged 1 cut.tsv)" = false ]
}
claim "after a signal the checkpoint has the current tractions" stopped
press="$press --quiet"
$press --report straight.tsv -o straight.rcg rigid.rcg
claim "--resume continues from them" bash -c "$press --checkpoint cut.rcg --resume --report on.tsv -o on.rcg rigid.rcg"
for channel in pressure traction-x; do between 0 "$(apart on.rcg straight.rcg $channel 2)" 1e-4 "  to the same $channel"; done
near "$(column displacement_x 2 on.tsv)" "$(column displacement_x 2 straight.tsv)" 1e-4 "  and displacement"
near "$(column largest_slip_total 2 on.tsv)" "$(column largest_slip_total 2 straight.tsv)" 1e-3 "  and slip"
near "$(column increment_error_estimate 2 on.tsv)" "$(column increment_error_estimate 2 straight.tsv)" 1e-2 "  and error of the increments"
between 1 "$(work on.tsv)" "$(awk -v w="$(work straight.tsv)" 'BEGIN { print 0.97 * w }')" "  in fewer convolutions"

# ---- refusals ----

refuses 1 'the file exists.*--resume' "a checkpoint is not written over" "$slip --checkpoint kept.rcg -o x.rcg alike.rcg"
refuses 1 'belongs to another problem: --mu was 0.3, is 0.2' "that of another coefficient" "${slip/0.3/0.2} --checkpoint kept.rcg --resume -o x.rcg alike.rcg"
refuses 1 'belongs to another problem: key estar was' "  of other bodies" "$slip --checkpoint kept.rcg --resume -o x.rcg rigid.rcg"
cp alike.rcg stream.rcg
refuses 1 'a grid stream, but no checkpoint' "a stream that is none" "$slip --checkpoint stream.rcg --resume -o x.rcg alike.rcg"
echo "notes of a user" >notes.txt
refuses 1 'no pressure can be read' "a file that is none" "$slip --checkpoint notes.txt --resume -o x.rcg alike.rcg"
claim "  which stays as it is" grep -qx "notes of a user" notes.txt
refuses 2 '--resume has no effect without --checkpoint' "--resume alone" "$slip --resume -o x.rcg alike.rcg"
refuses 2 '--interval has no effect without --checkpoint' "--interval alone" "$slip --interval 1s -o x.rcg alike.rcg"
refuses 2 'give a file name' "a pipe" "$slip --checkpoint - -o x.rcg alike.rcg"
