# SPDX-License-Identifier: GPL-3.0-or-later
# rc-solve on a case with a map of hardness beside the heights. The maps have two phases, or spots without a
# hardness.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 96 --ny 80 --dx 1um --hurst 0.8 --rms-height 0.2um --seed 4 -o h.rcg
# map FILE EXPRESSION: writes a frame `hardness` on the grid of h.rcg, in GPa at column i of row j
map() {
    perl -e '
        my ($expr) = @ARGV; my $v = "";
        for my $j (0 .. 79) { for my $i (0 .. 95) { $v .= pack("d<", 1e9 * eval $expr) } }
        my $head = "RCG1\nchannel=hardness\nnx=96\nny=80\ndx=1e-06\ndy=1e-06\nunit=Pa\ntype=f64\n\n";
        binmode STDOUT; print $head . $v; ' "$2" >frame.bin
    perl -MCompress::Zlib -e 'undef $/; my $b = <>; binmode STDOUT;
        print $b . sprintf("crc32 %08x\n", crc32($b)) . "RCGEND 1\n"' frame.bin >"$1"
}
# beside A B: writes the frames of both as one case
beside() { perl -0777 -ne 's/RCGEND 1\n\z//; print; END { print "RCGEND 2\n" }' "$1" "$2"; }
solve() { rc-solve --quiet --periodic --mean-pressure 1GPa --estar 100GPa "$@"; }
export -f solve

map even.rcg 3
map phases.rcg '$i % 32 < 16 ? 2 : 5'
map spots.rcg '($i - 48) ** 2 + ($j - 40) ** 2 < 300 ? 2 : "nan"'
claim "the map of hardness is a separate stream" says 'hardness' rc-info phases.rcg
for order in 'h.rcg even.rcg' 'even.rcg h.rcg'; do
    # shellcheck disable=SC2086
    beside $order >case.rcg
    solve --report map.json --output pressure case.rcg -o map.rcg
    solve --report one.json --hardness 3GPa --output pressure h.rcg -o one.rcg
    for key in max_pressure contact_area plastic_area yielded_area approach; do
        claim "one hardness everywhere ($order) equals --hardness: $key" \
            test "$(field $key map.json)" = "$(field $key one.json)"
    done
done
claim "a number is in the keys of the result" says 'hardness=3000000000$' rc-info one.rcg
claim "  a map is not" bash -c 'rc-info map.rcg >map.txt && lacks "hardness=" map.txt'

beside h.rcg phases.rcg >case.rcg
solve --report two.json --output pressure,gap,plastic case.rcg -o two.rcg
claim "the report has the range of two phases" bash -c 'grep -q "\"hardness_min\": 2000000000, \"hardness_max\": 5000000000" two.json'
claim "  the effect is on" says '"hardness": "on"' cat two.json
claim "  its frames are written" test "$(channels two.rcg)" = "pressure gap plastic"
near "$(field max_pressure two.json)" 5e9 1e-12 "  the largest pressure is the larger hardness"
soft() { rc-pick --channel pressure --crop 0,0,16,80 two.rcg | rc-info --json | grep -o '"maximum": [^,]*' | cut -d' ' -f2; }
near "$(soft)" 2e9 1e-12 "  and in the soft phase the smaller one"
solve --hardness 2GPa --report soft.json h.rcg -o /dev/null
solve --hardness 5GPa --report hard.json h.rcg -o /dev/null
claim "  the contact is between those of the single phases" awk -v a="$(field contact_area soft.json)" \
    -v b="$(field contact_area two.json)" -v c="$(field contact_area hard.json)" 'BEGIN { exit !(a > b && b > c) }'
beside h.rcg spots.rcg >spots-case.rcg
claim "nodes without a hardness do not yield" bash -c 'solve --report spots.json spots-case.rcg -o /dev/null && grep -q "\"converged\": true" spots.json'
claim "  the largest pressure is above the hardness of the others" awk -v p="$(field max_pressure spots.json)" 'BEGIN { exit !(p > 2e9) }'

map none.rcg '"nan"'
beside h.rcg none.rcg >none-case.rcg
solve --report none.json --output pressure none-case.rcg -o none.rcg
solve --report elastic.json --output pressure h.rcg -o elastic.rcg
claim "a map without a number has no effect" test "$(field max_pressure none.json)" = "$(field max_pressure elastic.json)"
claim "  the report says so" says '"hardness": "left out: the map of hardness holds no number"' cat none.json
claim "  the report says so without a map" says '"hardness": "left out: no --hardness, and no map' cat elastic.json

# ---- histories, checkpoints ----

claim "a history with a map without a number causes a warning" says 'nothing yields' bash -c '
    rc-solve --periodic --mean-pressure 0.5GPa --history --estar 100GPa --output pressure none-case.rcg -o /dev/null 2>&1'
claim "  a map with numbers causes none" bash -c '
    rc-solve --verbose --periodic --mean-pressure 0.5GPa --history --estar 100GPa --output pressure spots-case.rcg -o /dev/null 2>warn.txt &&
    lacks "nothing yields" warn.txt'

claim "a history with a map keeps the shape" bash -c '
    rc-solve --quiet --periodic --mean-pressure 0.5GPa,1GPa,0,1GPa --history --estar 100GPa --report history.tsv --output pressure case.rcg -o /dev/null &&
    awk -F"\t" "NR == 1 { for (k = 1; k <= NF; k++) c[\$k] = k; next } { y[NR] = \$c[\"yielded_area/m2\"] } END { exit !(y[2] > 0 && y[3] > 0 && y[5] == 0) }" history.tsv'
solve --checkpoint state --output pressure case.rcg -o first.rcg
claim "a run continues from its checkpoint" bash -c 'solve --checkpoint state --resume --output pressure case.rcg -o again.rcg && cmp first.rcg again.rcg'
beside h.rcg even.rcg >other.rcg
refuses 1 'frame hardness: the values differ' "  but not under another map" "solve --checkpoint state --resume other.rcg -o /dev/null"
refuses 1 'frame hardness was given, is not given' "  nor without one" "solve --checkpoint state --resume h.rcg -o /dev/null"

# ---- refusals ----

refuses 1 'holds a map of hardness, and --hardness gives a number: leave one out' "both are refused" "solve --hardness 1GPa case.rcg"
map weak.rcg '$i < 48 ? 0.5 : 1'
beside h.rcg weak.rcg >weak-case.rcg
refuses 1 'load .* N is above' "a load that the map cannot carry" "solve weak-case.rcg"
map zero.rcg '$i == 7 && $j == 3 ? 0 : 1'
beside h.rcg zero.rcg >zero-case.rcg
refuses 1 'hardness' "a hardness of 0" "solve zero-case.rcg"
rc-pick --crop 0,0,48,80 phases.rcg >half.rcg
beside h.rcg half.rcg >half-case.rcg
refuses 1 'bring them to one grid' "another grid" "solve half-case.rcg"
refuses 1 'no frame with the channel height, only hardness' "no heights" "solve phases.rcg"
claim "--dry-run reports the map" says 'hardness +on: computed where' bash -c 'solve --dry-run case.rcg'

claim "rc-cost accepts it, also on coarser grids" says '^ *1/2 .*front' rc-cost --grid 2,1 --tol 1e-2 case.rcg -- \
    rc-solve --periodic --mean-pressure 1GPa --estar 100GPa
refuses 1 'leave one out' "  and refuses both" "rc-cost --tol 1e-2 case.rcg -- rc-solve --periodic --mean-pressure 1GPa --estar 100GPa --hardness 1GPa"

# ---- Vickers' number, and an impossible hardness ----

press() { rc-solve --periodic --estar 100GPa --output pressure --report v.json "$@" h.rcg -o v.rcg; }
export -f press
claim "600HV is printed as a pressure" \
    warns '[-]-hardness 600HV is 6.34609 GPa: the mean pressure on the plane of the dent, HV times 9.80665 MPa over sin 68 deg' press --mean-pressure 1GPa --hardness 600HV
near "$(field hardness_max v.json)" 6.3460876e9 1e-7 "  in the report"
near "$(field max_pressure v.json)" 6.3460876e9 1e-7 "  and is the bound"
refuses 2 "Brinell's number is .*: give a pressure, as in 6GPa, or Vickers' number, as in 600HV" "Brinell's is refused" "press --mean-pressure 1GPa --hardness 200HB"
refuses 2 "Rockwell's number is a depth" "Rockwell's too" "press --mean-pressure 1GPa --hardness 60HRC"
claim "300 GPa instead of 3 GPa causes a warning" warns 'and --hardness, 300 GPa, is above that: is its unit right' press --mean-pressure 5GPa --hardness 300GPa

# ---- the output in other tools ----

claim "rc-pick accepts the map" says 'channel=hardness|hardness' bash -c 'rc-pick --channel hardness case.rcg | rc-info'
claim "rc-render draws it" bash -c 'rc-render --channel hardness -o hardness.png case.rcg && [ -s hardness.png ]'
claim "  its title is right" bash -c 'rc-render --channel hardness -o hardness.svg case.rcg && grep -q "Hardness" hardness.svg'
claim "rc-export writes it" bash -c 'rc-export --format npy --channel hardness -o hardness.npy case.rcg && [ -s hardness.npy ]'
