# SPDX-License-Identifier: GPL-3.0-or-later
# Many scans: one table with the name of each file, statistics over them, a warning of several files counted once,
# cores that are shared by processes of one tool,
# and the ways of contact(7) through fifty scans, two of them damaged.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/manual.sh"
. "$RC_SOURCE/tests/python.sh"

mkdir scans
for seed in 1 2 3 4 5; do
    rc-synth selfaffine --nx 32 --dx 1um --hurst 0.8 --rms-slope "0.0$seed" --rolloff 16um --seed "$seed" -o "scans/$seed.rcg"
done
column() { awk -F '\t' -v name="$1" 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == name) at = k } NR > 1 { print $at }' "$2"; }

# ---- the column `file` ----

rc-solve --quiet --periodic --mean-pressure 20MPa,40MPa --estar 100GPa --report solve.tsv -o solved.rcg scans/*.rcg
claim "a row has the name of its file" \
    test "$(column file solve.tsv | tr '\n' ' ')" = "$(printf 'scans/%s.rcg scans/%s.rcg ' 1 1 2 2 3 3 4 4 5 5)"
rc-pick --set source=other.x3p scans/2.rcg | rc-solve --quiet --periodic --mean-pressure 20MPa --estar 100GPa --report piped.tsv -o piped.rcg
claim "of a pipe, the source of the map" test "$(column file piped.tsv)" = other.x3p
for command in "rc-leak --viscosity 1mPas --pressure-drop 1kPa" "rc-stress --nu 0.3 --depths 1um" \
    "rc-heat --mu 0.3 --speed 1 --conductivity 45,45 --diffusivity 1e-5,1e-5 --time 1ms" "rc-deflect --estar 100GPa"; do
    rm -f one.tsv
    $command --quiet --report one.tsv -o one.rcg piped.rcg
    claim "${command%% *} has the column too" test "$(column file one.tsv)" = piped.rcg
done

# ---- statistics over the scans ----

rc-info --areal --report areal.tsv scans/*.rcg
rc-info --areal --spread --json scans/*.rcg >spread.json
claim "rc-info has a row for each file" test "$(column file areal.tsv | tail -n 1)" = scans/5.rcg
for figure in sdq/- sa/m sal/m ssk/-; do
    name=${figure%/*}
    column "$name$(grep -v '/-' <<<"/${figure#*/}")" areal.tsv >values.txt
    grep "\"figure\": \"$name\"" spread.json >line.json
    # two passes over the table
    read -r mean error deviation < <(awk '{ v[NR] = $1; sum += $1 } END { m = sum / NR; for (k in v) s += (v[k] - m) ^ 2
        d = sqrt(s / (NR - 1)); printf "%.17g %.17g %.17g\n", m, d / sqrt(NR), d }' values.txt)
    near "$(field mean line.json)" "$mean" "$summed" "the mean of $name over five scans"
    near "$(field standard_error line.json)" "$error" "$summed" "  its standard error"
    near "$(field deviation line.json)" "$deviation" "$summed" "  the standard deviation"
    near "$(field n line.json)" 5 "$same" "  their number"
done
claim "a direction has no mean" bash -c '! grep "\"figure\": \"std\"" spread.json'
claim "for people it is a table" says '^height +sdq +0\.0[0-9]* .* 5$' rc-info --areal --spread scans/*.rcg
rc-info --spread --json scans/1.rcg >single.json
claim "one scan has no standard error" says '"standard_error": null' head -n 1 single.json
claim "--report has a row for each frame as well" bash -c \
    'rc-info --areal --spread --report rows.tsv scans/*.rcg >text && cmp rows.tsv areal.tsv && says "standard error" head -n 1 text'
refuses 2 "--spread prints on standard output, and so does --report -" "not on standard output" 'rc-info --spread --report - scans/1.rcg'

# ---- warnings are counted over files ----

for k in 1 2 3 4 5; do
    printf '# Width: 3 m\n# Height: 3 m\n# Value units: nm\n%s 2 3\n4 5 6\n7 8 9\n' "$k" >"large$k.txt"
done
rc-import large?.txt -o large.rcg 2>err
claim "the warning of several files is printed once" test "$(grep -c '^rc-import: large1.txt: the map is 3 m by 3 m, which is implausible' err)" = 1
claim "  the others are counted" grep -qx 'rc-import: 4 other inputs cause the same warning as large1.txt: the map is 3 m by 3 m, .*' err
claim "  and that is all" test "$(wc -l <err)" = 2
rc-import --verbose large?.txt -o large.rcg 2>err
claim "--verbose prints each" test "$(grep -c implausible err)" = 5
rc-import large?.txt missing.txt -o large.rcg 2>err
claim "the count is printed when a file ends the tool, before its message" test "$(sed -n '2s/:.*//;2p;3s/.*: \(missing.txt\): .*/\1/p' err | tr '\n' ' ')" = "rc-import missing.txt "
claim "another warning is another kind" bash -c 'sed "s/3 m/9 nm/g; s/nm$/pm/" large1.txt >small.txt
    printf "# Width: 3 um\n# Height: 3 um\n# Value units: um\n1 2 3\n4 5 6\n7 8 9\n" >tall.txt
    rc-import large1.txt tall.txt -o two.rcg 2>err && [ "$(grep -c implausible err)" = 2 ] && ! grep -q "other input" err'

# ---- processes of one tool share the cores ----

unset RC_THREADS
# A copy with a name of its own, so that no other test runs it at the same time. Two wait for their input.
cp "$RC_BIN/rc-solve" rc-shares
if [ -r /proc/self/comm ]; then
    mkfifo one two
    threads() { ./rc-shares --quiet --load 1mN --estar 1GPa --report threads.json -o "$1" scans/1.rcg && field threads threads.json; }
    alone=$(threads alone.rcg)
    near "$alone" "$(nproc)" "$same" "alone a process has all cores"
    ./rc-shares --quiet --load 1N --estar 1GPa -o /dev/null <one 2>/dev/null &
    ./rc-shares --quiet --load 1N --estar 1GPa -o /dev/null <two 2>/dev/null &
    exec 8>one 9>two
    for try in 1 2 3 4 5 6 7 8 9 10; do
        [ "$(cat /proc/[0-9]*/comm 2>/dev/null | grep -cx rc-shares)" = 2 ] && break
        sleep 0.2
    done
    near "$(threads beside.rcg)" "$((alone > 3 ? alone / 3 : 1))" "$same" "beside two others it has a third of them, one at least"
    claim "  and writes the same bytes" cmp alone.rcg beside.rcg
    RC_THREADS=2 ./rc-shares --quiet --load 1mN --estar 1GPa --report threads.json -o /dev/null scans/1.rcg
    near "$(field threads threads.json)" 2 "$same" "RC_THREADS has priority"
    exec 8>&- 9>&-
    wait 2>/dev/null
else
    untried "processes of one tool, without /proc"
fi

# ---- the ways of the tutorial ----

# shown BLOCK: the output of a display is that on the page.
shown() { diff <(tr -s ' ' <"../blocks/$1.prints") <(bash -e -u -o pipefail "../blocks/$1" 2>&1 | tr -s ' ') >&2; }
blocks "$pages/contact.7" "MANY SCANS" blocks
mkdir lot
cd lot || exit 1
for k in $(cd ../blocks && ls | grep -v prints | sort -n); do
    way=$(grep -oE 'xargs|parallel|make|python3|awk' "../blocks/$k" | head -n 1)
    case $way in
    "") bash -e -u -o pipefail "../blocks/$k" || failed "display $k" ;;
    parallel) if parallel --version 2>/dev/null | grep -q '^GNU'; then claim "fifty scans with GNU parallel" shown "$k"; else
        untried "fifty scans with GNU parallel, which is not here"; fi ;;
    python3) if python=$(python_with numpy 2>/dev/null); then
        mkdir -p ../bin && ln -sf "$(command -v "$python")" ../bin/python3
        PATH="$scratch/bin:$PATH" PYTHONPATH="$RC_SOURCE/python" PYTHONDONTWRITEBYTECODE=1 claim "fifty scans with Python" shown "$k"
        else untried "fifty scans with Python, for there is none with numpy"; fi ;;
    awk) claim "one table of fifty scans, and statistics" shown "$k" ;;
    *) claim "fifty scans with $way" shown "$k" ;;
    esac
    case $way in xargs | parallel | make) claim "  a damaged scan leaves no result" test ! -e out/140.rcg -a ! -e out/140.tsv ;; esac
done
cd ..
claim "the displays were run" test "$(ls blocks | grep -vc prints)" -ge 7
