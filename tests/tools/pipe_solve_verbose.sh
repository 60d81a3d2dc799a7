# rc-solve --verbose tells the main figures of each case in words; they are those of the report.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 96 --ny 80 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 40um --short-cut 6um --seed 5 -o s.rcg
rc-solve --verbose --periodic --estar 3GPa --hardness 200MPa --load 20mN,40mN --output pressure --report r.json s.rcg -o p.rcg 2>err
claim "a line a case" test "$(grep -c '^rc-solve: s.rcg, case [12], load' err)" = 2
for case in 1 2; do
    grep "case $case, load" err >line.txt
    sed -n ${case}p r.json >case.json
    word() { sed -n "s/.*$1 \([0-9.]*\) $2.*/\1/p" line.txt; }
    near "$(word force mN)e-3" "$(field load case.json)" "$six_digits" "case $case: force"
    near "$(word 'contact area' um2)e-12" "$(field contact_area case.json)" "$six_digits" "  contact area"
    near "$(word 'mean gap' nm)e-9" "$(field mean_gap case.json)" "$six_digits" "  mean gap"
    near "$(word approach nm)e-9" "$(field approach case.json)" "$six_digits" "  approach"
    near "$(word 'largest pressure' MPa)e6" "$(field max_pressure case.json)" "$six_digits" "  largest pressure"
    near "$(sed -n 's/.* nodes in \([0-9]*\) patches).*/\1/p' line.txt)" "$(field count case.json)" "$same" "  patches"
    near "$(sed -n 's/.*), \([0-9.]*\) um2 of it yields.*/\1/p' line.txt)e-12" "$(field yielded_area case.json)" "$six_digits" "  what yields"
done
rc-info --patches --json p.rcg >info.json
sed -n 2p info.json | sed "s/.*\"patches\"/\"patches\"/" >second.json
near "$(field count case.json)" "$(field count second.json)" "$same" "rc-info --patches counts the same patches"
near "$(field contact_area_corrected case.json)" "$(field contact_area_corrected second.json)" "$rounding" "  and has the same corrected area"
near "$(grep -o '"largest_areas": \[[^],]*' case.json | sed 's/.*\[//')" "$(field largest_area second.json)" "$rounding" "  and the same largest patch"
claim "without it, not a word" bash -c '
    rc-solve --periodic --estar 3GPa --hardness 200MPa --load 40mN --output pressure s.rcg -o p.rcg 2>err && ! grep -q force err'

finish
