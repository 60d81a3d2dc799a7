# SPDX-License-Identifier: GPL-3.0-or-later
# rc-cost --adhesion: its errors are those of the net pressures of rc-solve with these tolerances and grids,
# computed here independently. The proposed command has the stated error; the cohesive length in nodes is that
# of each grid.
. "$(dirname "$0")/../pipe.sh"

# Prints the values of a stream of one f64 frame, one per line, without the checksum and the end line after
# them.
values() {
    head -c -24 "$1" | tail -c "$((8 * $2))" | od -An -v -w8 -t f8
}

# off A B N: prints the relative L1 distance of the N values of two streams.
off() {
    values "$1" "$3" >a.txt
    values "$2" "$3" >b.txt
    paste a.txt b.txt | awk '{ d = $1 - $2; s += d < 0 ? -d : d; t += $2 < 0 ? -$2 : $2 } END { printf "%.12g\n", s / t }'
}

export RC_THREADS=1
side=48
nodes=$((side * side))
rc-synth selfaffine --nx $side --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 24um --short-cut 8um --seed 2 -o rough.rcg
contact="--periodic --mean-pressure 1MPa --estar 100MPa --adhesion 1J/m2,exponential,200nm"
rc-cost $contact --quiet -o cost.txt --report cost.json --plot cost.png rough.rcg
awk '/^$/ { exit } !/^#/ && $1 != "method"' cost.txt >rows.txt
claim "there are eight trials, three of them on coarser grids" test "$(wc -l <rows.txt)" = 8
claim "  all use the only method for adhesion" bash -c '[ "$(cut -d " " -f 1 rows.txt | sort -u)" = gap ]'
claim "the cohesive length is given in nodes of each grid" bash -c "
    awk '{ split(\$5, n, \"x\"); want = 100e6 * 200e-9 ^ 2 / 1 / 1e-6 * n[1] / $side; d = \$15 / want - 1; if (d < -0.01 || d > 0.01) exit 1 }' rows.txt"

rc-solve $contact --tol 1e-10 --quiet --output pressure -o truth.rcg rough.rcg
every_error() {
    while read -r _ _ _ tol grid _ _ _ _ estimate error _; do
        [ "$grid" = "${side}x$side" ] || continue
        rc-solve $contact --tol "$tol" --quiet --output pressure --report one.json -o one.rcg rough.rcg || return 1
        echo "$error $(off one.rcg truth.rcg $nodes) $estimate $(field pressure_error_estimate one.json)"
    done <rows.txt >both.txt
    cat both.txt >&2
    awk '{ d = $1 - $2; if (d < 0) d = -d; e = $3 / $4 - 1
           if (d > 0.01 * $2 + 1e-9 || e < -0.01 || e > 0.01 || $1 > $3) bad = 1 } END { exit bad || NR != 5 }' both.txt
}
claim "every error on the original grid equals that of rc-solve, and is at most its estimate" every_error
claim "errors on a coarser grid are larger" bash -c "awk '{ e[\$5, \$4] = \$11 } END { exit !(e[\"12x12\", \"1e-03\"] > e[\"24x24\", \"1e-03\"] && e[\"24x24\", \"1e-03\"] > e[\"48x48\", \"1e-03\"]) }' rows.txt"
near "$(sed -n 's/.*"cohesive_nodes": \([0-9.e+-]*\).*/\1/p' cost.json | head -1)" 4 1e-9 "a report has it too"

rc-cost $contact --error 1e-4 --quiet -o command.txt rough.rcg
claim "the command for 1e-4 gives a result within 1e-4" grep -q -- '--adhesion 1J/m2,exponential,200nm --tol' command.txt
bash -c "$(cat command.txt) --quiet --output pressure -o said.rcg"
between 0 "$(off said.rcg truth.rcg $nodes)" 1e-4 "  is within 1e-4"

claim "separated bodies are refused" bash -c '
    rc-cost --periodic --mean-pressure=-20MPa --estar 100MPa --adhesion 1J/m2,exponential,200nm rough.rcg 2>said; [ $? = 1 ] && grep -q "no reference: under this load the bodies part" said'
claim "an approach works like the load that it gives" bash -c '
    rc-cost --periodic --approach=-50nm --estar 100MPa --adhesion 1J/m2,exponential,200nm --quiet rough.rcg | head -1 | grep -q "approach -5e-08 m"'
refused() {
    refuses 2 "$1" "refused: $2" "rc-cost --periodic --mean-pressure 1MPa --estar 100MPa --adhesion 1J/m2 $2 rough.rcg"
}
refused "only one method" "--method pcg"
claim "stresses and flow work with net pressures" bash -c "
    rc-cost $contact --depths 1um --nu 0.3 --leak x --quiet rough.rcg >more.txt && says '^# stresses under the reference' cat more.txt &&
    says ' flow_error ' cat more.txt"
refuses 2 "must be above 0" "no work" "rc-cost --periodic --mean-pressure 1MPa --estar 100MPa --adhesion 0 rough.rcg"
