# SPDX-License-Identifier: GPL-3.0-or-later
# In a --history the load against the approach from the first touch of the initial shape is one curve. No loop
# gains work, elastic reloading follows the unloading curve, unloading ends at the residual indentation, and
# the first load agrees with Hertz. Curves of rc-render use this approach.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --radius 1mm --nx 112 --ny 104 --dx 0.5um --dy 0.55um -o ball.rcg
loads=20mN,0.2N,0.6N,1N,0.8N,0.6N,0.4N,0.2N,0.1N,20mN,1mN,0,1mN,20mN,0.1N,0.2N,0.4N,0.6N,0.8N,1N,1.4N,0.7N,0.1N,1mN,0
rc-solve --quiet --history --estar 114GPa --hardness 1GPa --tol 1e-6 --load $loads --output pressure,gap,displacement,height,plastic \
    --report ball.tsv ball.rcg -o result.rcg

rc-solve --verbose --history --estar 114GPa --hardness 1GPa --load 1N,0.8N ball.rcg -o two.rcg --report two.json 2>notes.txt
dent=$(grep -o '"indentation": [^,]*' two.json | tail -1)
near "$(sed -n 's/.*load 800 mN: indentation \([0-9.]*\) nm from the first touch of the initial shape.*/\1e-9/p' notes.txt)" "${dent#*: }" 1e-4 "--verbose notes an indentation that is not the approach"
claim "  but none where both are equal" lacks 'load 1 N: indentation' notes.txt
claim "each of 25 cases has its five frames" test "$(channels result.rcg)" = "$(for _ in {1..25}; do echo pressure gap displacement height plastic; done | xargs)"

# cell COLUMN ROW
cell() {
    awk -F'\t' -v name="$1" -v row="$2" 'NR == 1 { for (c = 1; c <= NF; c++) if ($c == name) k = c } NR == row + 1 { print $k }' ball.tsv
}
# work FROM TO: prints the work done on the contact from the first of these rows to the last.
work() {
    awk -F'\t' -v from="$1" -v to="$2" 'NR == 1 { for (c = 1; c <= NF; c++) { if ($c == "load/N") f = c; if ($c == "indentation/m") d = c } }
        NR > from + 1 && NR <= to + 1 { w += (F + $f) / 2 * ($d - D) } { F = $f; D = $d } END { printf "%.9g", w }' ball.tsv
}

hertz=$(awk 'BEGIN { printf "%.9g", (9 * 0.02 ^ 2 / (16 * 114e9 ^ 2 * 1e-3)) ^ (1 / 3) }')
near "$(cell indentation/m 1)" "$hertz" 0.01 "the first load is elastic: Hertz's approach"
near "$(cell residual_indentation/m 1)" 0 0 "  and leaves nothing"
for case in 1:0.02 4:1 23:0.1; do near "$(total pressure result.rcg "${case%:*}")" "${case#*:}" "$summed" "  load ${case%:*} is carried"; done
claim "1 N leaves an indentation" awk -v r="$(cell residual_indentation/m 4)" 'BEGIN { exit !(r > 1e-8) }'
near "$(cell residual_indentation/m 12)" "$(cell residual_indentation/m 4)" 1e-9 "  which unloading and loading to less leave as it is"
for pair in 5:19 6:18 7:17 8:16 9:15 10:14 11:13 4:20; do
    near "$(cell indentation/m ${pair#*:})" "$(cell indentation/m ${pair%:*})" 1e-5 "reloaded: the way back, load $(cell load/N ${pair%:*})"
done
near "$(cell indentation/m 12)" "$(cell residual_indentation/m 12)" 0 "apart: where they touch again"
between 0 "$(awk -v a="$(cell indentation/m 11)" -v b="$(cell residual_indentation/m 11)" -v h="$hertz" 'BEGIN { print (a - b) / (h * 0.05 ^ (2 / 3)) }')" 1 \
    "1 mN is further by less than on the round ball: the flattened one is stiffer"
scale=$(awk -v f="$(cell load/N 4)" -v d="$(cell indentation/m 4)" 'BEGIN { print f * d }')
between 0.01 "$(awk -v w="$(work 1 12)" -v s="$scale" 'BEGIN { print w / s }')" 0.5 "loading beyond yield and unloading take work"
between 0.01 "$(awk -v w="$(work 12 25)" -v s="$scale" 'BEGIN { print w / s }')" 0.5 "  and so does the next loop"
between -1e-4 "$(awk -v w="$(work 4 20)" -v s="$scale" 'BEGIN { print w / s }')" 1e-4 "an elastic loop takes none and gains none"

# Displacement, height and gap give the same in each case: c is the mean of displacement - height - gap.
rc-info --json result.rcg >maps.json 2>/dev/null
mean() { grep "\"channel\": \"$1\"" maps.json | sed -n "$2p" | grep -o "\"$3\": [^,}]*" | head -n 1 | sed 's/.*: //'; }
for k in 2 4 8 15 21 23; do
    near "$(cell indentation/m $k)" "$(awk -v u="$(mean displacement $k mean)" -v h="$(mean height $k mean)" -v g="$(mean gap $k mean)" -v t="$(mean height 1 maximum)" \
        'BEGIN { printf "%.12g", u - h - g + t }')" 1e-6 "case $k: displacement - height - gap, over the first shape's top"
    near "$(cell residual_indentation/m $k)" "$(awk -v p="$(mean plastic $k maximum)" -v t="$(mean height 1 maximum)" 'BEGIN { printf "%.12g", t - p }')" \
        1e-6 "  by how much the top of what is left is lower"
done

rc-solve --quiet --estar 114GPa --hardness 1GPa --load 1N --report one.json --output pressure ball.rcg -o one.rcg
near "$(field indentation one.json)" "$(cell indentation/m 4)" 1e-5 "without --history too: the first load of 1 N has the same indentation"
claim "  the shape after unloading is not computed" test "$(field residual_indentation one.json)" = null
bodies="--E1 210GPa --nu1 0.3 --E2 rigid"
rc-solve --quiet $bodies --load 0.05N,1N --report elastic.tsv --output pressure -o one.rcg ball.rcg
rc-solve --quiet $bodies --yield 100GPa --load 0.05N,1N --report never.tsv --output pressure -o one.rcg ball.rcg
of() { awk -F'\t' -v row="$3" -v name="$2" 'NR == 1 { for (c = 1; c <= NF; c++) if ($c == name) at = c } NR == row + 1 { print $at }' "$1"; }
for k in 1 2; do
    near "$(of elastic.tsv indentation/m $k)" "$(of never.tsv indentation/m $k)" 1e-6 "elastic, load $k: the indentation is that of a body that does not yield"
done
rc-render --curve approach:load --title T -o elastic.svg elastic.tsv
claim "a curve of elastic loads has the approach" grep -q '>Approach (' elastic.svg

# ---- curves ----

rc-render --curve approach:load --title T -o approach.svg ball.tsv
rc-render --curve indentation:load --title T -o indentation.svg ball.tsv
strip() { sed 's/approach:load//; s/indentation:load//' "$1"; }
claim "curves of a history over the approach use the indentation" cmp <(strip approach.svg) <(strip indentation.svg)
claim "  the axis says so" grep -q '>Indentation (' approach.svg
rc-solve --quiet --estar 114GPa --load 20mN,0.2N --report first.tsv --output pressure ball.rcg -o one.rcg
rc-render --curve approach:load --title T -o first.svg first.tsv
claim "curves of first loadings use the approach" lacks 'Indentation' first.svg
