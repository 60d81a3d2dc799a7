# SPDX-License-Identifier: GPL-3.0-or-later
# rc-solve --conductivity prints the conductance of Hertz's contact in both units, and with yielding. It
# prints none for coated bodies, and none without the option. Refusals are tested too.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 129 --dx 5um --radius 7.5mm -o ball.rcg
press="rc-solve --quiet --estar 113.93GPa --tol 1e-6 --output pressure -o p.rcg"
a=$(awk 'BEGIN { print (0.75 * 240 * 7.5e-3 / 113.93e9) ^ (1 / 3) }')
# circle K1 K2: prints the conductance of Hertz's circle
circle() { awk -v a="$a" -v k="$1" -v l="$2" 'BEGIN { print 4 * a / (1 / k + 1 / l) }'; }
within=3e-3 # 46 nodes in the radius: an error of about a tenth of a node

# ---- Hertz ----

$press --load 240N --conductivity 45W/mK,16.3W/mK --report heat.json ball.rcg
near "$(field conductance heat.json)" "$(circle 45 16.3)" "$within" "heat through Hertz's circle, W/K"
near "$(total pressure p.rcg 1)" 240 "$summed" "  whose pressures carry the load"
near "$(field conductance_lower heat.json)" "$(field conductance heat.json)" 1e-6 "  and the bound of it"
between 0 "$(field conductance_lower heat.json)" "$(field conductance heat.json)" "  is below it"
$press --load 240N --conductivity '58 MS/m,7.1MS/m' --report current.json ball.rcg
near "$(field conductance current.json)" "$(circle 58e6 7.1e6)" "$within" "current, S"
$press --load 240N --conductivity 45,16.3 --report plain.json ball.rcg
near "$(field conductance plain.json)" "$(field conductance heat.json)" "$same" "without units the same as in SI"
$press --load 240N --conductivity 45,16.3 --stiffness --report both.json ball.rcg
$press --load 240N --stiffness --report stiff.json ball.rcg
near "$(field stiffness both.json)" "$(field stiffness stiff.json)" "$same" "the stiffness beside it is what it is alone"
near "$(field convolutions both.json)" "$(field convolutions plain.json)" "$same" "  and costs nothing more"

# ---- yield ----

# a yielding ball touches on a wide, flat spot: nodes at the hardness conduct, but carry no more load
$press --load 240N --hardness 1.2GPa --conductivity 45,16.3 --stiffness --report soft.json ball.rcg
between 0.5 "$(awk -v p="$(field plastic_area soft.json)" -v c="$(field contact_area soft.json)" 'BEGIN { print p / c }')" 1 \
    "with a hardness of 1.2 GPa most of the contact yields"
# the circle with its area, reduced by about a tenth of a node at the edge
near "$(field conductance soft.json)" \
    "$(awk -v c="$(field contact_area soft.json)" 'BEGIN { print 4 * sqrt(c / 3.14159265) / (1 / 45 + 1 / 16.3) }')" "$coarse_grid" \
    "  it conducts as the circle of its area"
claim "  the conductance is larger than its stiffness implies" awk -v c="$(field conductance soft.json)" -v s="$(field stiffness soft.json)" \
    'BEGIN { exit !(c > 1.05 * 2 * s / (113.93e9 * (1 / 45 + 1 / 16.3))) }'

# ---- a table, histories ----

$press --load 60N:240N:2 --conductivity 45W/mK,16.3W/mK --report heat.tsv ball.rcg
near "$(total pressure p.rcg 1)" 60 "$summed" "a list of loads has the first one"
near "$(total pressure p.rcg 2)" 240 "$summed" "  and the last one"
claim "a table has its unit" bash -c "head -n 1 heat.tsv | tr '\t' '\n' | grep -qx conductance/W/K"
near "$(awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "conductance/W/K") c = i } NR == 2 { print $c }' heat.tsv)" \
    "$(awk -v c="$(circle 45 16.3)" 'BEGIN { print c * 0.25 ^ (1 / 3) }')" "$within" "  and its rows grow with the load to the third"
claim "  rc-render draws it" bash -c 'rc-render --curve load:conductance -o c.svg heat.tsv && says "Conductance \(W/K\)|Conductance.*W" cat c.svg'
$press --history --load 240N,0,240N --hardness 1.2GPa --conductivity 45,16.3 --report history.json ball.rcg
claim "separated bodies have conductance 0" bash -c \
    'sed -n 2p history.json >apart.json && grep -q "\"conductance\": 0, \"conductance_lower\": 0" apart.json'

# ---- not asked for, not there ----

$press --load 240N --report none.json ball.rcg
claim "without the option it is null, with the reason" bash -c '
    grep -q "\"conductance\": null, \"conductance_lower\": null" none.json &&
    grep -q "\"conductivity\": \"left out: no --conductivity\"" none.json'
claim "  it costs no convolution" awk -v a="$(field convolutions none.json)" -v b="$(field convolutions plain.json)" \
    'BEGIN { exit !(b > a + 2) }'
coated="--load 240N --E1 208GPa --nu1 0.3 --E2 rigid --layer 5um,400GPa,0.2 --conductivity 45,16.3"
claim "for coated bodies it is null, with a warning" bash -c "
    warns 'does not work with --layer, .* the conductance is left out' rc-solve $coated --output pressure --report coat.json ball.rcg -o c.rcg &&
    grep -q '\"conductance\": null, \"conductance_lower\": null' coat.json && grep -q '\"conductivity\": \"left out: layers' coat.json"
claim "--dry-run includes its cost" bash -c '
    rc-solve --dry-run --load 1N --estar 1GPa ball.rcg | grep -o "about [0-9]* conv" >without.txt
    rc-solve --dry-run --load 1N --estar 1GPa --conductivity 45,16.3 ball.rcg >plan.txt
    grep -Eq "conductivity +on" plan.txt && ! grep -qf without.txt plan.txt'

# ---- refusals ----

refuses 2 '--conductivity 45: it must be K1,K2' "one conductivity" "rc-solve --load 1N --estar 1GPa --conductivity 45 ball.rcg"
refuses 2 "--conductivity 45,0: 0: it must be above 0" "none" "rc-solve --load 1N --estar 1GPa --conductivity 45,0 ball.rcg"
refuses 2 "unknown unit 'W': W/mK or S/m is expected" "a power" "rc-solve --load 1N --estar 1GPa --conductivity 45W,1W ball.rcg"
refuses 2 'both in W/mK or both in S/m' "heat into current" "rc-solve --load 1N --estar 1GPa --conductivity 45W/mK,7MS/m ball.rcg"
