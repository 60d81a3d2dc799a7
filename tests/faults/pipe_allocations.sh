# SPDX-License-Identifier: GPL-3.0-or-later
# Every allocation of every tool fails in turn, n = 1, 2, ... to the last, alone and with all later ones. The
# tool must still do its work, or exit with status 1 and a message. It must leave the old file unchanged and
# leave no other file. failing_malloc.c defines which allocations are counted. RC_STRIDE in the environment is
# the step from one failing allocation to the next; above 1 only every second command is tested.
. "$RC_SOURCE/tests/pipe.sh"
. "$RC_SOURCE/tests/faults/commands.sh"

stride=${RC_STRIDE:-1}
make_inputs
export ASAN_OPTIONS="${ASAN_OPTIONS-}:verify_asan_link_order=0"

# run N STAY COMMAND: prints its exit status when that allocation fails (0: none).
run() {
    [ -z "$out" ] || echo old >"$out"
    # shellcheck disable=SC2086
    env LD_PRELOAD="$RC_FAILING_MALLOC" RC_FAULT_AT="$1" ${2:+RC_FAULT_STAY=1} RC_FAULT_COUNT="$PWD/count" $3 >run.out 2>run.err
}

tried=0
sweep() { # COARSER COMMAND
    local step=$(($1 * stride)) command=$2 out n stay last wrong=0 before after
    out=$(written "$command")
    run 0 "" "$command" || {
        failed "$command: fails without a fault: $(head -c 300 run.err)"
        return
    }
    last=$(cat count)
    rm -f clean
    [ -z "$out" ] || cp "$out" clean
    cp run.out clean.out
    before=$(others)
    for stay in "" 1; do
        for ((n = 1; n <= last; n += step)); do
            run "$n" "$stay" "$command"
            judge $? "$out" "    allocation $n of $last${stay:+ and all after it}" "$command" || wrong=$((wrong + 1))
            tried=$((tried + 1))
            after=$(others)
            [ "$before" = "$after" ] || {
                echo "    allocation $n of $last: left: $after"
                wrong=$((wrong + 1))
                before=$after
            }
        done
    done
    if [ $wrong = 0 ] && [ "$last" -gt 5 ]; then
        passed "$last allocations: $command"
    else
        failed "$wrong of $last allocations: $command"
    fi
}

turn=0
while read -r coarser command; do
    [ "$stride" = 1 ] || [ $((++turn % 2)) = 1 ] || continue
    sweep "$coarser" "$command" </dev/null
done <<<"$commands"
claim "$tried allocations failed, one in $stride" test $tried -gt 0
