# --report - is standard output: the lines of the report and nothing else; the stream is written where -o
# leads it, and never is a file called `-`.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 33 --dx 5um --radius 7.5mm -o ball.rcg
press="rc-solve --load 1N,2N --estar 114GPa --quiet ball.rcg"

# only_lines N: N lines on standard input, JSON objects all.
only_lines() {
    tee lines.txt | awk -v n="$1" '!/^\{"case": .*\}$/ { bad = 1 } END { exit bad || NR != n }'
}
export -f only_lines

claim "rc-solve: two lines and no stream" bash -c "$press --report - | only_lines 2"
claim "  -o - is standard output too" bash -c "$press --report - -o - | only_lines 2"
claim "rc-solve: with -o the stream goes there" bash -c "$press --report - -o pressed.rcg | only_lines 2"
$press -o plain.rcg
claim "  and is what it would be" cmp pressed.rcg plain.rcg
claim "rc-stress: lines and no stream" bash -c "rc-stress --nu 0.3 --depths 5um --report - plain.rcg | only_lines 2"
claim "rc-stress: with -o the stream goes there" \
    bash -c "rc-stress --nu 0.3 --depths 5um --report - -o stress.rcg plain.rcg | only_lines 2"
rc-stress --nu 0.3 --depths 5um -o plain-stress.rcg plain.rcg
claim "  and is what it would be" cmp stress.rcg plain-stress.rcg
try="rc-cost --load 1 --estar 114GPa --kernel fft --method pcg --quiet ball.rcg"
claim "rc-cost: lines and no table" bash -c "$try --report - | only_lines \$($try | grep -c 'pcg')"
claim "rc-cost: with -o the table goes there" bash -c "$try --report - -o table.txt >cost.json && grep -q pcg table.txt"
claim "  the lines do not" bash -c "[ -s cost.json ] && lacks '^\{' table.txt"
claim "--dry-run writes its words and no report" bash -c "$press --report - --dry-run | says 'convolutions' cat"
refuses 1 'report -: writing failed' "a full disk is told" "$press --report - >/dev/full"
claim "no file is called -" test ! -e ./-

finish
