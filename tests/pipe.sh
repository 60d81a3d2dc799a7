# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by every pipe_*.sh and law_*.sh. It puts the built tools on PATH, makes a temporary folder, and
# defines claims and the tolerances of tests/exact.h by their names ($rounding, ...). A pipeline fails if any
# of its commands fails, here and in every bash that a claim starts. grep -q and head may stop reading early,
# so they must not end a pipeline in a claim. `says` and `warns` check the output after the command has ended.
#
# A script passes if it ends with status 0, has made a claim, and no claim has failed; the trap EXIT sees to
# that. `skip` is the only way to the status 77, which ctest shows as skipped.
set -u -o pipefail
export SHELLOPTS
PATH="$RC_BIN:$PATH"
export LC_ALL=C
eval "$(sed -n 's/^static const double \([a-z_]*\) = \([0-9][0-9.e-]*\);.*/\1=\2/p' "$RC_SOURCE/tests/exact.h")"
scratch=$(mktemp -d) || exit 1
claims=0
failures=0
skipped=
trap 'verdict $?' EXIT
cd "$scratch" || exit 1

# verdict STATUS: the exit status of the script, which ends with STATUS.
verdict() {
    local uncounted=0
    [ ! -e "$scratch/.uncounted" ] || uncounted=$(wc -l <"$scratch/.uncounted")
    rm -rf "$scratch"
    if [ "$1" = 77 ] && [ "$skipped" ] && [ "$claims" = 0 ]; then exit 77; fi
    echo "$claims claims, $failures failed"
    [ "$1" = 0 ] || echo "NOT OK: the script ended early, with status $1"
    [ "$claims" -gt 0 ] || echo "NOT OK: the script makes no claim"
    [ "$uncounted" = 0 ] || echo "NOT OK: $uncounted claims in a subshell, where they are not counted"
    [ "$1" = 0 ] && [ "$claims" -gt 0 ] && [ "$failures" = 0 ] && [ "$uncounted" = 0 ] && exit 0
    exit 1
}

# skip "why": ends a test that cannot run here, before its first claim. tests/run.sh lists the reasons.
skip() {
    echo "SKIPPED: $1"
    skipped=yes
    exit 77
}

# untried "what and why": a part of a test that cannot run here. tests/run.sh lists it too.
untried() {
    echo "NOT TRIED: $1"
}

# passed "sentence", failed "sentence": count a claim that the caller has decided.
tally() {
    claims=$((claims + 1))
    [ "$BASH_SUBSHELL" = 0 ] || echo "$1" >>"$scratch/.uncounted"
}
passed() {
    tally "$1"
    echo "ok: $1"
}
failed() {
    tally "$1"
    failures=$((failures + 1))
    echo "NOT OK: $1"
}

# before_release: true if all cases run (RC_LONG, tests/CMakeLists.txt), not only those of every commit.
before_release() {
    [ -n "${RC_LONG-}" ]
}

# claim "sentence" command...: the command succeeds.
claim() {
    local sentence=$1 got
    shift
    "$@" >claim.out 2>claim.err
    got=$?
    if [ "$got" = 0 ]; then
        passed "$sentence"
    else
        failed "$sentence: exit status $got"
        sed 's/^/    /' claim.err
    fi
}

# refuses STATUS "pattern" "sentence" 'shell command': it exits with STATUS, and its standard error matches
# the pattern (grep -E).
refuses() {
    local status=$1 pattern=$2 sentence=$3 command=$4 got
    bash -c "$command" >refuses.out 2>refuses.err </dev/null
    got=$?
    if [ "$got" = "$status" ] && grep -qE -- "$pattern" refuses.err; then
        passed "$sentence"
    else
        failed "$sentence: exit status $got (expected $status), standard error:"
        sed 's/^/    /' refuses.err
    fi
}

# says "pattern" command...: it succeeds, and its standard output matches the pattern (grep -E).
says() {
    local pattern=$1
    shift
    "$@" >says.out || return
    grep -aqE -- "$pattern" says.out || {
        head -c 2000 says.out >&2
        return 1
    }
}

# warns "pattern" command...: the same for its standard error.
warns() {
    local pattern=$1
    shift
    "$@" 2>warns.err >/dev/null
    local status=$?
    cat warns.err >&2
    [ "$status" = 0 ] && grep -aqE -- "$pattern" warns.err
}

# lacks "pattern" FILE: the file exists, is not empty, and does not match the pattern.
lacks() {
    [ -s "$2" ] && ! grep -aqE -- "$1" "$2"
}

# reseal: corrects the checksum of a changed stream of one frame.
reseal() {
    perl -MCompress::Zlib -0777 -pe \
        's/(RCG1.*)crc32 [0-9a-f]{8}\n/$1 . sprintf("crc32 %08x\n", crc32($1))/se'
}
export -f says warns lacks reseal

# near VALUE EXPECTED TOLERANCE "sentence": |VALUE - EXPECTED| <= TOLERANCE |EXPECTED|, both numbers.
near() {
    if awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN {
        number = "^ *[-+]?[0-9.]+([eE][-+]?[0-9]+)?$"
        d = a - b; if (d < 0) d = -d; m = b < 0 ? -b : b
        exit !(a ~ number && b ~ number && t ~ number && d <= t * m) }'; then
        passed "$4 ($1)"
    else
        failed "$4: $1, expected $2 within a relative $3"
    fi
}

# between LOW VALUE HIGH "sentence": LOW <= VALUE <= HIGH, all numbers.
between() {
    if awk -v a="$1" -v x="$2" -v b="$3" 'BEGIN {
        number = "^ *[-+]?[0-9.]+([eE][-+]?[0-9]+)?$"
        exit !(a ~ number && x ~ number && b ~ number && a + 0 <= x + 0 && x + 0 <= b + 0) }'; then
        passed "$4 ($2)"
    else
        failed "$4: $2, expected from $1 to $3"
    fi
}

# field NAME FILE: prints a number or word of a one-line JSON report.
field() {
    grep -o "\"$1\": [^,}]*" "$2" | head -n 1 | sed 's/^[^:]*: //; s/"//g'
}

# with_address_sanitizer: true if the tools have it; it takes memory of its own and keeps what is freed.
with_address_sanitizer() {
    nm -D "$(command -v rc-solve)" >symbols.txt 2>/dev/null
    grep -q __asan symbols.txt
}

# skip_with_address_sanitizer "why": ends a test that the memory of the sanitizer would disturb.
skip_with_address_sanitizer() {
    if with_address_sanitizer; then
        skip "with the address sanitizer: $1"
    fi
}

# tool_sources: prints the main source files of the built tools, one per line.
tool_sources() {
    printf '%s\n' "$RC_SOURCE"/tools/rc-*.c
}

# total CHANNEL STREAM CASE: the sum of a frame times the area of a node: the load of a pressure, in N.
total() {
    rc-pick --quiet --channel "$1" --case "$3" "$2" >total.rcg
    rc-export --format csv total.rcg | grep -v '^#' | tr , '\n' |
        awk -v cell="$(grep -am 2 -E '^d[xy]=' total.rcg | cut -d = -f 2 | paste -s -d '*' | sed 's/\*/ /')" \
            'BEGIN { split(cell, d, " ") } { sum += $1 } END { printf "%.17g\n", sum * d[1] * d[2] }'
}

# channels STREAM: prints the channels of its frames.
channels() {
    rc-info --quiet --json "$1" | sed 's/.*"channel": "\([^"]*\)".*/\1/' | xargs
}

# energy_of STREAM CELL OPTIONS: half the sum of the first pressure times its displacement by rc-deflect,
# times the area CELL of a cell in m2.
energy_of() {
    rc-pick --channel pressure --case 1 "$1" >energy-p.rcg
    rc-deflect --quiet "${@:3}" -o energy-u.rcg energy-p.rcg
    paste <(rc-export --format xyz energy-p.rcg | grep -v '^#') <(rc-export --format xyz energy-u.rcg | grep -v '^#') |
        awk -v cell="$2" '{ sum += $3 * $6 } END { printf "%.17g\n", cell * sum / 2 }'
}
