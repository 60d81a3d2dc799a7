# Files of the kinds that laboratories send, by the table wild.tsv: size, spacing, two heights, the words of standard error, the exit status.
. "$(dirname "$0")/../pipe.sh"

wild=$(cd "$(dirname "$0")" && pwd)

# A value of the header of out.rcg.
header() {
    head -c 4000 out.rcg | sed -n "s/^$1=//p" | head -n 1
}

# alike GOT WANTED: both are missing, or equal but for rounding to decimals; "@" is not compared.
alike() {
    [ "$2" = @ ] || awk -v a="$1" -v b="$2" -v tol="$converted" 'BEGIN {
        if (tolower(a) ~ /nan/ || b == "nan") exit !(tolower(a) ~ /nan/ && b == "nan")
        d = a - b; if (d < 0) d = -d; c = b < 0 ? -b : b
        exit !(d <= (tol > 1e-9 ? tol : 1e-9) * c) }'
}

# as_wanted EXIT NX NY DX DY FIRST LAST PATTERN: what out.rcg, err and $status are.
as_wanted() {
    [ "$status" = "$1" ] || { echo "exit status $status"; cat err; return 1; } >&2
    if [ "$8" = none ]; then
        [ ! -s err ] || { cat err; return 1; } >&2
    else
        grep -qE -- "$8" err || [ -z "$8" ] || { cat err; return 1; } >&2
    fi
    [ "$1" = 0 ] || { [ ! -e out.rcg ]; return; }
    rc-export --format csv out.rcg | grep -v '^#' >values
    set -- "$@" "$(head -n 1 values | cut -d , -f 1)" "$(tail -n 1 values | sed 's/.*,//')"
    echo "is $(header nx) x $(header ny), $(header dx), $(header dy), from $9 to ${10}" >&2
    [ "$(header nx) $(header ny)" = "$2 $3" ] && alike "$(header dx)" "$4" && alike "$(header dy)" "$5" &&
        alike "$9" "$6" && alike "${10}" "$7"
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
finish
