# SPDX-License-Identifier: GPL-3.0-or-later
# rc-info shows every frame of every stream with the right figures, for people and as JSON.
. "$(dirname "$0")/../pipe.sh"

printf '1 2 NaN\n3 4 8\n' >map.txt
rc-import --dx 1.1um --dy 1um --z-unit nm map.txt -o map.rcg

# ---- JSON ----

claim "the JSON of a map is written" bash -c 'rc-info --json map.rcg >map.json'
claim "each frame has a line that a parser reads" bash -c \
    '[ "$(wc -l <map.json)" = 1 ] && perl -MJSON::PP -e "decode_json(\$_) for <>" map.json'
near "$(field nx map.json)" 3 "$same" "nx"
near "$(field ny map.json)" 2 "$same" "ny"
near "$(field dx map.json)" 1.1e-6 "$same" "dx"
near "$(field dy map.json)" 1e-6 "$same" "dy"
near "$(field minimum map.json)" 1e-9 "$converted" "minimum"
near "$(field maximum map.json)" 8e-9 "$converted" "maximum"
near "$(field mean map.json)" 3.6e-9 "$of_sum" "mean"
near "$(field sum map.json)" 18e-9 "$of_sum" "sum"
near "$(field rms map.json)" 2.4166091947189146e-9 "$rounding" "rms: sqrt(29.2 / 5) nm"
# only one node has both neighbours: sqrt((1/1.1)^2 + (2/1)^2) nm/um
near "$(field rms_slope map.json)" 2.196917449744468e-3 "$rounding" "rms slope"
near "$(field missing map.json)" 1 "$same" "missing"
near "$(field infinite map.json)" 0 "$same" "infinite"
claim "source and history are among the keys" grep -q \
    '"keys": {.*"source": "map.txt".*"history": "rc-import' map.json
rc-synth sphere --radius 1mm --nx 16 --dx 1um |
    rc-solve --load 1mN --estar 100GPa --output pressure --quiet | rc-info --json >p.json
claim "only heights have a slope" grep -q '"unit": "Pa".*"rms_slope": null' p.json
near "$(awk -v s="$(field sum p.json)" 'BEGIN { printf "%.17g", s * 1e-12 }')" 1e-3 "$summed" \
    "a pressure's sum times dx dy is its load"
claim "unknown values are null" \
    says '"minimum": null.*"mean": null, "rms": null, "rms_slope": null' bash -c '
    printf "NaN NaN\nNaN NaN\n" | rc-import --dx 1um --z-unit nm - | rc-info --json'

# ---- text ----

claim "the text of a map is printed" bash -c 'rc-info map.rcg >map.out'
for line in '^map.txt, case 1, frame 1 \(height\)$' '^  grid +3 x 2 nodes, dx 1.1 um, dy 1 um$' \
    '^  size +3.3 um x 2 um$' '^  minimum +1 nm$' '^  maximum +8 nm$' '^  mean +3.6 nm$' \
    '^  rms +2.41661 nm$' '^  rms slope +0.00219692$' '^  missing +1 \(16.7 %\)$' \
    '^  history +rc-import [0-9.]+ --dx 1.1e-06'; do
    claim "  has the line $line" grep -qE "$line" map.out
done
claim "the history is printed step by step" bash -c '
    rc-detrend --plane map.rcg | rc-info | grep -A 1 "^  history  *rc-import" >steps &&
    grep -q "^             rc-detrend [0-9.]* --plane" steps'
claim "control characters do not reach a terminal" bash -c '
    sed "s/^source=.*/source=\x1b[31mred/" map.rcg | reseal |
    rc-info >red.out && grep -q "[?]\[31mred" red.out && lacks "$(printf "\033")" red.out'

# ---- several frames and streams ----

claim "several files become several cases" test "$(rc-info --json map.rcg - map.rcg <map.rcg |
    grep -o '"case": [0-9]*, "frame": 1,' | tr -d '\n')" = '"case": 1, "frame": 1,"case": 2, "frame": 1,"case": 3, "frame": 1,'
claim "-o FILE writes to the file" bash -c 'rc-info --json -o file.json map.rcg && cmp file.json map.json'

# ---- refusals ----

size=$(wc -c <map.rcg)
refuses 1 'the stream stops before the checksum of a frame' "a stream cut off" "head -c $((size - 20)) map.rcg | rc-info"
refuses 1 "the checksum is [0-9a-f]{8}, but that of the data is [0-9a-f]{8}" "a damaged one" "sed 's/^unit=m/unit=n/' map.rcg | rc-info"
refuses 1 '^rc-info: map.txt is not a grid stream, it looks like text: rc-import map.txt [|] rc-info ...$' "something else" "rc-info map.txt"
refuses 1 'nowhere.rcg: No such file' "nothing" "rc-info nowhere.rcg"
refuses 2 'unknown option --yaml: see rc-info --help' "an unknown option" "rc-info --yaml map.rcg"
refuses 1 'writing failed \(No space left on device\)' "a full disk" "rc-info map.rcg >/dev/full"
refuses 3 'converged=no' "an unfinished solution" \
    "rc-synth selfaffine --nx 32 --dx 1um --hurst 0.8 --rms-height 10nm |
        rc-solve --load 100mN --estar 100GPa --tol 1e-18 --quiet -o short.rcg
    [ \$? = 3 ] && rc-info short.rcg"
