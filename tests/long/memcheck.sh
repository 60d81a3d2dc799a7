#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs valgrind's memcheck over the short tests, by the times of ctest, and over the tools:
#
#     tests/long/memcheck.sh BUILD [SECONDS]
#
# BUILD is a built tree whose tests have been run; tests that took at most SECONDS there (default 0.3) run
# again. Findings are invalid accesses, jumps that depend on uninitialised values, and lost blocks. The
# sanitizers run all tests (tests/run.sh); valgrind also sees accesses by FFTW, GSL, libpng and other
# libraries.
set -uo pipefail
[ $# -ge 1 ] && [ -r "$1/Testing/Temporary/CTestCostData.txt" ] || {
    echo "memcheck.sh: which build, with its tests run before? memcheck.sh BUILD [SECONDS]" >&2
    exit 2
}
command -v valgrind >/dev/null || {
    echo "memcheck.sh: valgrind is not here: apt-get install valgrind" >&2
    exit 1
}
build=$(cd "$1" && pwd) most=${2-0.3}
here=$(cd "$(dirname "$0")" && pwd)
source=$(cd "$here/../.." && pwd)
surfaces=$source/sample_surfaces
. "$here/pipelines.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
export RC_SOURCE=$source RC_CORPUS=$source/../shared RC_BIN=$build/tools RC_THREADS=2
memcheck="valgrind --quiet --error-exitcode=99 --leak-check=full --errors-for-leak-kinds=definite --suppressions=$here/memcheck.txt"
ran=0 failed=0

while read -r test _ seconds; do
    case $test in format_export*|format_hdf5|format_datx) continue ;; esac # the sandbox limits memory, and valgrind needs more
    [ -x "$build/tests/$test" ] && awk "BEGIN { exit !($seconds <= $most) }" || continue
    ran=$((ran + 1))
    (cd "$work" && $memcheck "$build/tests/$test" >"$work/out" 2>"$work/err") || {
        failed=$((failed + 1))
        echo "NOT OK: $test"
        grep -m 12 '^==' "$work/err"
        grep -F 'FAILED' "$work/out"
    }
done < <(awk "/^---/ { exit } 1" "$build/Testing/Temporary/CTestCostData.txt")
echo "$ran tests under memcheck, $failed failed"

# The tools: each pipeline on a map of a few thousand nodes.
table() {
    command sed -n '/^[a-z0-9]*\.\(rcg\|json\) /p' "$here/pipelines.sh" | sed 's/--nx 256 --ny 224/--nx 64 --ny 48/; s/--crop 10,20,60,50/--crop 5,8,40,30/; s/--approach 1um/--approach 0.5um/'
}
mkdir -p "$work/tools"
for tool in "$build"/tools/rc-*; do
    [ -f "$tool" ] && [ -x "$tool" ] || continue
    printf '#!/bin/sh\nexec %s %s "$@"\n' "$memcheck" "$tool" >"$work/tools/${tool##*/}"
    chmod +x "$work/tools/${tool##*/}"
done
if PATH="$work/tools:$PATH" run_pipelines "$work/out.d" "$work/out.d" 2>"$work/err"; then
    echo "$(table | wc -l) pipelines under memcheck, no finding"
else
    failed=$((failed + 1))
    tail -n 20 "$work/err"
fi
if [ "$ran" -lt 10 ]; then
    echo "memcheck.sh: too few tests: run ctest in $build while nothing else runs, or give more seconds" >&2
    exit 1
fi
[ "$failed" = 0 ]
