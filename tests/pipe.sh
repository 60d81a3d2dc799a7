# Sourced by every pipe_*.sh and law_*.sh. It puts the built tools on PATH, makes a temporary folder, and
# defines claims and the tolerances of tests/exact.h by their names ($rounding, ...). A pipeline fails if any
# of its commands fails, here and in every bash that a claim starts. grep -q and head may stop reading early,
# so they must not end a pipeline in a claim. `says` and `warns` check the output after the command has ended.
set -u -o pipefail
export SHELLOPTS
PATH="$RC_BIN:$PATH"
export LC_ALL=C
eval "$(sed -n 's/^static const double \([a-z_]*\) = \([0-9][0-9.e-]*\);.*/\1=\2/p' "$RC_SOURCE/tests/exact.h")"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
claims=0
failures=0

# before_release: true if all cases run (RC_LONG, tests/CMakeLists.txt), not only those of every commit.
before_release() {
    [ -n "${RC_LONG-}" ]
}

# claim "sentence" command...: the command succeeds.
claim() {
    local sentence=$1
    shift
    claims=$((claims + 1))
    if "$@" >claim.out 2>claim.err; then
        echo "ok: $sentence"
    else
        echo "NOT OK ($?): $sentence"
        sed 's/^/    /' claim.err
        failures=$((failures + 1))
    fi
}

# refuses STATUS "pattern" "sentence" 'shell command': it exits with STATUS, and its standard error matches
# the pattern (grep -E).
refuses() {
    local status=$1 pattern=$2 sentence=$3 command=$4 got
    claims=$((claims + 1))
    bash -c "$command" >refuses.out 2>refuses.err </dev/null
    got=$?
    if [ "$got" = "$status" ] && grep -qE -- "$pattern" refuses.err; then
        echo "ok: $sentence"
    else
        echo "NOT OK: $sentence: exit status $got (expected $status), standard error:"
        sed 's/^/    /' refuses.err
        failures=$((failures + 1))
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
    claims=$((claims + 1))
    if awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN {
        number = "^ *[-+]?[0-9.]+([eE][-+]?[0-9]+)?$"
        d = a - b; if (d < 0) d = -d; m = b < 0 ? -b : b
        exit !(a ~ number && b ~ number && t ~ number && d <= t * m) }'; then
        echo "ok: $4 ($1)"
    else
        echo "NOT OK: $4: $1, expected $2 within a relative $3"
        failures=$((failures + 1))
    fi
}

# between LOW VALUE HIGH "sentence": LOW <= VALUE <= HIGH, all numbers.
between() {
    claims=$((claims + 1))
    if awk -v a="$1" -v x="$2" -v b="$3" 'BEGIN {
        number = "^ *[-+]?[0-9.]+([eE][-+]?[0-9]+)?$"
        exit !(a ~ number && x ~ number && b ~ number && a + 0 <= x + 0 && x + 0 <= b + 0) }'; then
        echo "ok: $4 ($2)"
    else
        echo "NOT OK: $4: $2, expected from $1 to $3"
        failures=$((failures + 1))
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
        echo "skipped with the address sanitizer: $1"
        exit 77
    fi
}

# tool_sources: prints the main source files of the built tools, one per line.
tool_sources() {
    printf '%s\n' "$RC_SOURCE"/tools/rc-*.c
}

finish() {
    echo "$claims claims, $failures failed"
    [ "$claims" -gt 0 ] && [ "$failures" = 0 ]
}

# energy_of STREAM CELL OPTIONS: half the sum of the first pressure times its displacement by rc-deflect,
# times the area CELL of a cell in m2.
energy_of() {
    rc-pick --channel pressure --case 1 "$1" >energy-p.rcg
    rc-deflect --quiet "${@:3}" -o energy-u.rcg energy-p.rcg
    paste <(rc-export --format xyz energy-p.rcg | grep -v '^#') <(rc-export --format xyz energy-u.rcg | grep -v '^#') |
        awk -v cell="$2" '{ sum += $3 * $6 } END { printf "%.17g\n", cell * sum / 2 }'
}
