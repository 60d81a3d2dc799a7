#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Tests of the tests: each test of whole command lines (pipe_*.sh) runs with tools that are broken in one way,
# and should fail.
#
#     tests/long/broken_tools.sh BUILD OUT [NAME...]
#
# prints a table, a line for each test: `yes` where the test noticed the tools of this kind, NO where tools
# returned something wrong and the test passed, `-` where nothing that the test ran was broken in this way. OUT
# keeps the output of each run. NAME is a test, as pipe_wear; without names all of the default set run, except
# those below. BREAKS in the environment are the ways, JOBS the tests that run at the same time.
#
#     none     whole tools behind the same wrapper: a test that fails here is left out of the table
#     digit    the last digit of each number of a report, and of the texts of rc-info
#     percent  1 % more in each number of a report; whole numbers at least 1 more
#     info     the same in what rc-info writes
#     drop     the last frame of several is missing, and the end line counts the others
#     value    the values of the first frame of a stream are 1e-3 larger, with the right checksum
#     three    status 0 instead of 3
#     one      status 0 instead of 1
#
# A test in which a way breaks nothing does not run for it. In the ways drop and value rc-synth and rc-import are
# whole, except in their own tests: most tests make their maps by them. A result in OUT is not computed again.
set -u
build=$(cd "$1" && pwd) && mkdir -p "$2" && out=$(cd "$2" && pwd) || exit 2
shift 2
export RC_SOURCE RC_CORPUS RC_REAL="$build/tools" OMP_WAIT_POLICY=passive build out
RC_SOURCE=$(cd "$(dirname "$0")/../.." && pwd)
RC_CORPUS="$RC_SOURCE/../shared"
ways=${BREAKS:-none percent value drop three one info digit}
# They take minutes, measure the tools themselves, or need the installed files.
left_out='calls|allocations|kills|cost|cost_yield|cost_adhesion|app|ranks|memory|forecast|installed|toy|notebooks|library'
left_out="pipe_($left_out|library_page|completions|help|headings|option_names|option_lists|messages|words)"

script() { find "$RC_SOURCE/tests" -name "$1.sh" -not -path '*/long/*'; }
names=$*
[ -n "$names" ] || names=$(find "$RC_SOURCE/tests" -name 'pipe_*.sh' -not -path '*/long/*' -printf '%f\n' |
    sed 's/\.sh$//' | grep -vxE "$left_out" | sort)

for way in $ways; do
    mkdir -p "$out/$way/tools"
    for part in "$build"/*; do [ "${part##*/}" = tools ] || ln -sfn "$part" "$out/$way/"; done
    for part in "$build"/tools/*; do
        case ${part##*/} in
        rc-app | *.*) ln -sfn "$part" "$out/$way/tools/" ;;
        rc-*) ln -sfn "$RC_SOURCE/tests/long/broken_tool.pl" "$out/$way/tools/${part##*/}" ;;
        *) ln -sfn "$part" "$out/$way/tools/" ;;
        esac
    done
done

# try WAY NAME: runs the test, unless its result is there already.
try() {
    local way=$1 name=$2 log="$out/$1/$2"
    [ ! -e "$log.status" ] || return 0
    rm -f "$log.broken"
    [ "$way" = none ] || [ ! -e "$out/none/$name.status" ] || grep -qsx "$way" "$out/none/$name.broken" || return 0
    export RC_BIN="$out/$way/tools" RC_BREAK=$way RC_BREAK_LOG="$log.broken" RC_BREAK_NOT=
    case $name in *synth* | *import* | pipe_no_stream) ;; *) RC_BREAK_NOT='rc-synth rc-import' ;; esac
    timeout -s KILL 300 bash "$(script "$name")" >"$log.out" 2>&1 </dev/null
    echo $? >"$log.status"
}
export -f try script

for way in $ways; do
    printf '%s\n' $names | xargs -P "${JOBS:-2}" -I{} nice bash -c 'try "$1" "$2"' - "$way" {}
done

# ---- the table ----

echo "test $ways" | tr ' ' '\t'
for name in $names; do
    row=$name
    whole=$(cat "$out/none/$name.status" 2>/dev/null || echo 0)
    for way in $ways; do
        log="$out/$way/$name"
        status=$(cat "$log.status" 2>/dev/null || echo 0)
        if [ "$way" = none ]; then
            row+=$'\t'$([ "$status" = 0 ] && echo whole || { [ "$status" = 77 ] && echo skipped || echo disturbed; })
        elif [ "$whole" != 0 ]; then
            row+=$'\t'.
        elif [ "$status" != 0 ]; then
            row+=$'\t'yes
        elif [ -s "$log.broken" ]; then
            row+=$'\t'NO
        else
            row+=$'\t'-
        fi
    done
    echo "$row"
done
