# SPDX-License-Identifier: GPL-3.0-or-later
# Files like those that laboratories send, listed in wild.tsv with size, spacing, two heights, the text on
# standard error, and the exit status.
. "$(dirname "$0")/../pipe.sh"

wild=$RC_SOURCE/tests/formats

# Reads out.rcg: puts nx ny dx dy, the first and the last value into $is.
look() {
    local at
    at=$(grep -abm 1 '^$' out.rcg)
    # shellcheck disable=SC2207 # words without patterns
    is=($(head -c "${at%%:*}" out.rcg | sed -n 's/^\(nx\|ny\|dx\|dy\)=//p')
        $(tail -c "+$((${at%%:*} + 2))" out.rcg | od -An -tf8 -v -w8 -N8)
        $(tail -c 32 out.rcg | head -c 8 | od -An -tf8))
}

# alike GOT WANTED: both are missing, or equal up to rounding to decimals; "@" is not compared.
alike() {
    [ "$2" = @ ] || awk -v a="$1" -v b="$2" -v tol="$converted" 'BEGIN {
        if (tolower(a) ~ /nan/ || b == "nan") exit !(tolower(a) ~ /nan/ && b == "nan")
        d = a - b; if (d < 0) d = -d; c = b < 0 ? -b : b
        exit !(d <= (tol > 1e-9 ? tol : 1e-9) * c) }'
}

# as_wanted EXIT NX NY DX DY FIRST LAST PATTERN: compares $status, out.rcg and err with these.
as_wanted() {
    [ "$status" = "$1" ] || { echo "exit status $status"; cat err; return 1; } >&2
    if [ "$8" = none ]; then
        [ ! -s err ] || { cat err; return 1; } >&2
    elif [ -n "$8" ]; then
        grep -qE -- "$8" err || { cat err; return 1; } >&2
    fi
    [ "$1" = 0 ] || { [ ! -e out.rcg ]; return; }
    look
    echo "is ${is[*]}" >&2
    [ "${is[0]} ${is[1]}" = "$2 $3" ] && alike "${is[2]}" "$4" && alike "${is[3]}" "$5" &&
        alike "${is[4]}" "$6" && alike "${is[5]}" "$7"
}

rows=0
while IFS='|' read -r file args exit nx ny dx dy first last pattern; do
    rm -f out.rcg
    # shellcheck disable=SC2086 # several words
    rc-import $args "$wild/wild/$file" -o out.rcg 2>err
    status=$?
    claim "$file $args" as_wanted "$exit" "$nx" "$ny" "$dx" "$dy" "$first" "$last" "$pattern"
    rows=$((rows + 1))
done < <(grep -v '^#' "$wild/wild.tsv" | tr '\t' '|')
claim "the table has rows" test "$rows" -gt 80
for file in "$wild"/wild/*; do
    claim "${file##*/} has a row" grep -q "^${file##*/}	" "$wild/wild.tsv"
done
