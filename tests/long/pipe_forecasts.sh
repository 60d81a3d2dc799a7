# SPDX-License-Identifier: GPL-3.0-or-later
# --dry-run: the expected seconds are within a factor of 2 of the processor seconds of one thread, for all effects at
# two sizes, and so are the expected convolutions. Processes beside do not change the expected seconds.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/forecasts.sh"
export RC_THREADS=1

# The run of least processor seconds of up to four, because processes beside take parts of the caches.
least() { # NODES COMMAND
    local s=inf
    for _ in 1 2 3 4; do
        forecast_run "$1" "$2"
        s=$(awk -v least="$s" '{ t = $1 + $2; print least == "inf" || t < least ? t : least }' time.txt)
        awk -v s="$s" 'BEGIN { exit !(s > 0.5) }' && break
    done
    printf %s "$s"
}
told() { sed -n 's/.*"expected_seconds": \([0-9.e+-]*\).*/\1/p' plan.json | awk '{ s += $1 } END { print s }'; }

for n in 64 96 128 256; do forecast_maps $n; done
while IFS='|' read -r name sizes command; do
    for n in $sizes; do
        seconds=$(least "$n" "$command")
        between 0.5 "$(awk -v t="$(told)" -v s="$seconds" 'BEGIN { print t / s }')" 2 "$name, $n x $n: expected over processor seconds, $seconds"
        ratio=$(forecast_work)
        [ "$ratio" = none ] || between 0.5 "$ratio" 2 "  and convolutions"
    done
done < <(forecast_rows)

# ---- a busy machine ----

alone=() busy=() rows=(adhesion 'creep by load' 'sliding on rubber, free, speeds' wear 'heat, --time' 'yield, auto' stresses)
forecast() { # NAME
    IFS=' ' read -ra words <<<"$(forecast_rows | sed -n "s/^$1|[^|]*|//p" | sed 's/@/128/g')"
    "${words[@]}" --quiet --dry-run --report plan.json >plan.txt
    told
}
for name in "${rows[@]}"; do alone+=("$(forecast "$name")"); done
beside=()
for _ in $(seq $((4 * $(nproc)))); do
    while :; do :; done &
    beside+=($!)
done
for name in "${rows[@]}"; do busy+=("$(forecast "$name")"); done
kill "${beside[@]}"
wait "${beside[@]}" 2>ended.txt
for k in "${!rows[@]}"; do
    between 0.5 "$(awk -v b="${busy[k]}" -v a="${alone[k]}" 'BEGIN { print b / a }')" 2 "${rows[k]}: expected seconds beside other processes over those without"
done
