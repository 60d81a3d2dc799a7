# SPDX-License-Identifier: GPL-3.0-or-later
# Eight pipelines of rc-solve and rc-stress that run at the same time, on any number of cores, all finish with
# the same results as alone.
. "$RC_SOURCE/tests/pipe.sh"

rounds=25
for k in $(seq 8); do
    rc-synth selfaffine --nx $((100 + 13 * k)) --ny $((150 - 7 * k)) --dx 1um --hurst 0.8 --rms-slope 0.1 \
        --short-cut 8um --seed "$k" -o "rough$k.rcg"
done

# pipeline K NAME: writes the stresses of surface K to NAME, with two threads.
pipeline() {
    rc-solve --threads 2 --load 0.$1N --estar 1GPa --output pressure "rough$1.rcg" |
        rc-stress --threads 2 --nu 0.3 --depths 1um,4um --components mises,szz -o "$2"
}
export -f pipeline

for k in $(seq 8); do
    claim "pipeline $k alone" pipeline "$k" "alone$k.rcg"
done

# eight: runs all at once; fails if one of them fails.
eight() {
    local k pids="" status=0
    for k in $(seq 8); do
        pipeline "$k" "$1-$k.rcg" &
        pids="$pids $!"
    done
    for k in $pids; do wait "$k" || status=1; done
    for k in $(seq 8); do cmp "alone$k.rcg" "$1-$k.rcg" || status=1; done
    return $status
}
export -f eight

for round in $(seq $rounds); do
    claim "eight pipelines at a time, round $round of $rounds: each gives the bits of a single run" eight "round$round"
done
claim "no other file is left" bash -c '[ $(ls | grep -c "rcg$") = $((8 + 8 + 8 * '$rounds')) ] && ! ls *.rcg.* 2>/dev/null'
