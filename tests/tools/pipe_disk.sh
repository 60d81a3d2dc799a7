# SPDX-License-Identifier: GPL-3.0-or-later
# What is left when the disk is full, a file may not grow (ulimit -f), a standard file is closed or a tool is
# killed: files are whole or absent, reports have whole lines, and the exit status is 1 with the true reason.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 64 --dx 1um --radius 100um -o ball.rcg
solve="rc-solve --quiet --threads 1 --estar 1GPa ball.rcg"
export TMPDIR=$scratch/temporary
mkdir temporary

# ---- a limit of the size of files: the signal of the limit does not end the tool ----

refuses 1 'writing failed \(File too large\)' "a stream beyond ulimit -f" "ulimit -f 8; $solve --load 1mN -o out.rcg"
claim "  leaves no file" bash -c '! ls out.rcg* 2>/dev/null'
claim "a checkpoint beyond it is given up, and the run goes on" bash -c \
    "(ulimit -f 8; rc-solve --threads 1 --estar 1GPa ball.rcg --load 1mN --checkpoint kept --output pressure -o /dev/null) 2>err.txt &&
     grep -q 'no more are added' err.txt"
refuses 1 'rc-detrend: .*writing failed \(File too large\)' "a page beyond it" "ulimit -f 8; rc-report --quiet -o page.html ball.rcg"
claim "  leaves no file, and no temporary folder" bash -c '! ls page.html* temporary/* 2>/dev/null'

# ---- reports ----

loads="--load 0.1mN:1mN:30 -o /dev/null"
$solve $loads --report whole.tsv
$solve $loads --report whole.json
for kind in tsv json; do
    refuses 1 "--report part.$kind: writing failed \(File too large\)" "a report .$kind beyond it" "ulimit -f 12; $solve $loads --report part.$kind"
    claim "  has whole lines, the first ones of the whole report" bash -c "[ -s part.$kind ] && [ -z \"\$(tail -c 1 part.$kind | tr -d '\n')\" ] &&
        lines=\$(wc -l <part.$kind) && [ \$lines -lt \$(wc -l <whole.$kind) ] &&
        cmp <(sed 's/[\"\t]*seconds.*//' part.$kind | cut -f 1-8) <(head -n \$lines whole.$kind | sed 's/[\"\t]*seconds.*//' | cut -f 1-8)"
done

# ---- a full disk ----

if [ -w /dev/full ]; then
    for run in "rc-report --quiet" "rc-export --format csv" "rc-info"; do
        refuses 1 'No space left on device' "$run to a full disk" "$run ball.rcg >/dev/full"
    done
    refuses 1 '--report /dev/full: writing failed \(No space left on device\)' "a report" "$solve $loads --report /dev/full"
fi

# ---- closed standard files ----

for run in "rc-report --quiet" "rc-info" "$solve --load 1mN" "rc-export --format csv"; do
    refuses 1 'writing failed \(Bad file descriptor\)' "${run%% *} with a closed output" "$run ball.rcg >&-"
done
refuses 1 'writing failed' "a closed output beside a checkpoint" "$solve --load 1mN --checkpoint beside >&-"
claim "  does not become part of the checkpoint" bash -c "rc-info --json beside >info.json && [ \$(wc -l <info.json) = 1 ]"
refuses 1 'rc-info: .+' "a closed input" "rc-info <&-"
claim "closed messages do not go to a file" bash -c "$solve --load 1mN --checkpoint quiet -o out.rcg 2>&- && rc-info quiet >/dev/null"

# ---- kill -9 of a page ----

killed() {
    rc-report --quiet -o page.html ball.rcg &
    local k
    until ls temporary/rc-report-*/contact.rcg* >/dev/null 2>&1 || ! kill -0 $!; do sleep 0.02; done
    kill -KILL $!
    wait $!
    [ $? = 137 ] || return
    for k in {1..100}; do
        ls temporary/* >/dev/null 2>&1 || return 0
        sleep 0.1
    done
    ls -R temporary >&2
    return 1
}
claim "rc-report that is killed leaves no temporary files" killed
claim "  and one that ends leaves none" bash -c "rc-report --quiet -o page.html ball.rcg && ! ls temporary/* 2>/dev/null"

