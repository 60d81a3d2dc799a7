# Sourced by every pipe_*.sh: the built tools on PATH, a scratch folder, and three ways to claim.
set -u
PATH="$RC_BIN:$PATH"
export LC_ALL=C
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
claims=0
failures=0

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

# refuses STATUS "pattern" "sentence" 'shell command': it exits with STATUS, and its standard error
# holds the pattern (grep -E).
refuses() {
    local status=$1 pattern=$2 sentence=$3 command=$4 got
    claims=$((claims + 1))
    bash -c "set -o pipefail; $command" >refuses.out 2>refuses.err </dev/null
    got=$?
    if [ "$got" = "$status" ] && grep -qE -- "$pattern" refuses.err; then
        echo "ok: $sentence"
    else
        echo "NOT OK: $sentence: exit status $got (expected $status), standard error:"
        sed 's/^/    /' refuses.err
        failures=$((failures + 1))
    fi
}

# near VALUE EXPECTED TOLERANCE "sentence": |VALUE - EXPECTED| <= TOLERANCE |EXPECTED|.
near() {
    claims=$((claims + 1))
    if awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN {
        d = a - b; if (d < 0) d = -d; m = b < 0 ? -b : b
        exit !(a != "" && a != "null" && d <= t * m) }'; then
        echo "ok: $4 ($1)"
    else
        echo "NOT OK: $4: $1, expected $2 within a relative $3"
        failures=$((failures + 1))
    fi
}

# field NAME FILE: a number or word of a one-line JSON report.
field() {
    grep -o "\"$1\": [^,}]*" "$2" | head -n 1 | sed 's/^[^:]*: //; s/"//g'
}

finish() {
    echo "$claims claims, $failures failed"
    [ "$claims" -gt 0 ] && [ "$failures" = 0 ]
}
