# SPDX-License-Identifier: GPL-3.0-or-later
# Every system call on a file fails in turn, n = 1, 2, ... to the last, in every tool. The faults are a full
# disk, a broken disk, an interruption, and no descriptors left. The tool must still do its work, or exit with
# status 1 and a message, leave the old file unchanged and leave no other file. If reads and writes do half of
# the requested bytes, the work must be done. failing_calls.c defines the calls. The file of -o is on the disk
# (fsync) before it replaces the old one. If the disk refuses, the old file remains; if the file system does
# not support fsync, the work is done. Signals also arrive at each of these calls. After SIGTERM and SIGINT
# there is the unchanged old file or the complete new one and nothing else. After SIGKILL the same holds for
# every file with a final name. RC_STRIDE in the environment is the step from one failing call to the next;
# above 1 only every fourth command is tested.
. "$RC_SOURCE/tests/pipe.sh"
. "$RC_SOURCE/tests/faults/commands.sh"

stride=${RC_STRIDE:-1}
make_inputs
"$RC_FAILING_CALLS" -f none true
[ $? != 77 ] || skip "the calls of a command cannot be watched here"

# The leak check of a sanitizer starts a process at the end, which is not a call of the tool.
export ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0"

# run FAULT N COMMAND: prints its exit status.
run() {
    [ -z "$out" ] || echo old >"$out"
    # shellcheck disable=SC2086
    timeout -s KILL 60 "$RC_FAILING_CALLS" -f "$1" -n "$2" -c count $3 >run.out 2>run.err </dev/null
}

# whole FILE: the file is the complete new one. After a signal it may also be the marked intermediate
# solution, or hold the finished loads of a list.
whole() {
    same_work "$1" clean && return
    case $command in
    rc-solve*) ;;
    rc-cost*) # or the first rows of its table
        [ "$(tail -c 1 "$1" | od -An -c | tr -d ' ')" = '\n' ] && [ -z "$(comm -23 <(costs_of "$1" | sort) <(costs_of clean | sort))" ]
        return
        ;;
    *) return 1 ;;
    esac
    rc-info --quiet "$1" >/dev/null 2>&1
    case $? in
    0) [ "$(grep -ac '^RCG1$' "$1")" -lt "$(grep -ac '^RCG1$' clean)" ] ;;
    3) grep -aq '^converged=no$' "$1" ;;
    *) false ;;
    esac
}

# judge_signal FAULT STATUS WHERE
judge_signal() {
    local signal
    signal=$(kill -l "${1^^}")
    [ "$2" = $((128 + signal)) ] || [ "$2" = 0 ] || {
        echo "$3: exit status $2: $(head -c 300 run.err)"
        return 1
    }
    [ "$1" = kill ] && rm -f map.??????
    whole_beside || {
        echo "$3: map or checkpoint is not whole"
        return 1
    }
    [ -z "$out" ] || [ "$(tr -d '\0' <"$out")" = old ] || whole "$out" || {
        echo "$3: the file is neither the old nor the new one"
        return 1
    }
}

judge_fault() { # FAULT STATUS WHERE
    case $1 in
    term | int) judge_signal "$@" ;;
    kill)
        judge_signal "$@" && rm -f out.?????? plot.png.?????? out.png.?????? out.pdf.?????? # the file under its temporary name stays
        ;;
    short | nosync)
        [ "$2" = 0 ] || {
            echo "$3: exit status $2: $(head -c 300 run.err)"
            return 1
        }
        judge "$2" "$out" "$3" "$command"
        ;;
    *) judge "$2" "$out" "$3" "$command" ;;
    esac
}

tried=0
sweep() { # FAULT COMMAND
    local fault=$1 command=$2 out n last wrong=0 before after step=$stride
    case $command in rc-cost*) step=$((40 * stride)) ;; esac # most calls are made by the tools that it runs
    out=$(written "$command")
    rm -f clean
    run "$fault" 0 "$command" || {
        failed "$command: fails without a fault: $(head -c 300 run.err)"
        return
    }
    last=$(cat count)
    [ "$fault$last" != fsync0 ] || [ -z "$out" ] ||
        failed "it is put in its place before the disk has it: $command"
    [ -z "$out" ] || cp "$out" clean
    cp run.out clean.out
    before=$(others)
    for ((n = 1; n <= last; n += step)); do
        run "$fault" "$n" "$command"
        judge_fault "$fault" $? "    $fault at call $n of $last" || wrong=$((wrong + 1))
        tried=$((tried + 1))
        after=$(others)
        [ "$before" = "$after" ] || {
            echo "    $fault at call $n of $last: left: $(comm -13 <(echo "$before") <(echo "$after"))"
            wrong=$((wrong + 1))
            before=$after
        }
    done
    if [ $wrong = 0 ]; then
        passed "$fault, $last calls: $command"
    else
        failed "$fault, $wrong of $last calls: $command"
    fi
}

turn=0
for fault in enospc eio fsync nosync eintr short emfile term int kill; do
    turn=$((turn + 1))
    while read -r _ command; do
        # with a stride: every fourth command, and the others for each fault
        [ "$stride" = 1 ] || [ $((++turn % 4)) = 0 ] || continue
        sweep "$fault" "$command"
    done <<<"$commands"
    echo "$fault: $tried so far"
done
claim "$tried calls failed, one in $stride" test $tried -gt 0
