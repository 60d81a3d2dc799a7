# SPDX-License-Identifier: GPL-3.0-or-later
# Contact has one meaning in all tools: the frame `contact` if a case has one, else a pressure above 0. For
# bodies that attract each other it agrees with the gap, which is exactly 0 in contact. If a stream does not
# determine the contact, the tools say so.
. "$(dirname "$0")/../pipe.sh"

frames="perl $RC_SOURCE/tests/tools/frames.pl"
count() { # CHANNEL CONDITION FILE: nodes whose value v meets it, counted by awk
    rc-export --format csv --channel "$1" "$3" | tr ',;' '  ' | awk '!/^#/ { for (i = 1; i <= NF; i++) { v = $i + 0; n += ('"$2"') } } END { print n + 0 }'
}

rc-synth selfaffine --nx 64 --dx 50nm --hurst 0.8 --rms-height 20nm --rolloff 3.2um --short-cut 400nm --seed 3 -o s.rcg
solve="rc-solve --quiet --periodic --mean-pressure 50kPa --estar 50MPa s.rcg"
$solve --adhesion 10mJ/m2,exponential,20nm --report a.json -o a.rcg
$solve --report e.json -o e.rcg
nodes=$(field contact_nodes a.json)

# ---- the frame ----

between 400 "$nodes" 2000 "a part of the map touches"
near "$(count contact 'v == 1' a.rcg)" "$nodes" 0 "contact is 1 at as many nodes as the report has"
near "$(count gap 'v == 0' a.rcg)" "$nodes" 0 "  which are those whose gap is 0"
near "$(count contact 'v == 0' a.rcg)" "$((4096 - nodes))" 0 "  and 0 elsewhere"
claim "  the net pressure does not determine the contact" test "$(count pressure 'v > 0' a.rcg)" != "$nodes"
claim "  gap and contact agree at every node" cmp <(rc-export --format csv --channel gap a.rcg | tr ',;' '\n\n' | awk '!/^#/ { print $1 == 0 }') \
    <(rc-export --format csv --channel contact a.rcg | tr ',;' '\n\n' | awk '!/^#/ { print $1 == 1 }')
claim "elastic bodies have no frame contact, unless --output asks for it" bash -c "! rc-info e.rcg | grep -q contact\\)"
$solve --output contact,pressure,gap,displacement,height -o c.rcg
near "$(count contact 'v == 1' c.rcg)" "$(field contact_nodes e.json)" 0 "  then it is 1 where they carry pressure"
claim "  the other frames do not change" cmp <(rc-pick --channel pressure,gap,displacement,height c.rcg) <(rc-pick --channel pressure,gap,displacement,height e.rcg)
rc-solve --quiet --estar 50MPa --adhesion 10mJ/m2,exponential,20nm --radius 1mm --approach=-2um,10nm --output gap s.rcg -o apart.rcg
near "$(rc-pick --case 1 apart.rcg | count contact 'v == 1' -)" 0 0 "bodies 2 um apart do not touch"
claim "  a stream with the gap alone has the frame contact too" test "$(rc-pick --case 2 apart.rcg | count contact 'v == 1' -)" = "$(rc-pick --case 2 apart.rcg | count gap 'v == 0' -)"
rc-pick --resample 100x50 a.rcg -o again.rcg
near "$(($(count contact 'v == 0' again.rcg) + $(count contact 'v == 1' again.rcg)))" 5000 0 "on another grid it is 1 or 0 too"

# ---- tools that use it ----

near "$(field contact_nodes <(rc-info --json a.rcg | grep '"channel": "pressure"'))" "$nodes" 0 "rc-info counts it"
near "$(rc-info --json --patches a.rcg | grep -o '"patches": {"count": [0-9]*, "contact_nodes": [0-9]*' | sed 's/.* //')" "$nodes" 0 "  and its patches"
near "$(rc-info --json --patches a.rcg | grep -o '"counts": \[[^]]*' | sed 's/.*\[//; s/, /\n/g' | awk '{ n += $1 } END { print n }')" "$nodes" 0 "  and the histogram of pressures"
near "$(rc-info --json --patches a.rcg | grep -o '"patches": {"count": [0-9]*' | sed 's/.* //')" "$(grep -o '"patches": {"count": [0-9]*' a.json | sed 's/.* //')" 0 "  as many as rc-solve has found"
out=$(awk -v n="$nodes" 'BEGIN { printf "%.4g", 100 * (1 - n / 4096) }')
claim "rc-render --histogram omits nodes outside contact" warns "out of contact: $out %" rc-render --verbose --histogram -o h.svg a.rcg
claim "--clip counts the contact" bash -c 'rc-render --clip -o k.svg a.rcg && grep -q "99.5 % of the contact" k.svg'
# The drawn border is that of the frame: a stream whose pressure is the frame itself gives the same picture.
$frames a.rcg:gap a.rcg:contact=pressure >border.rcg
rc-render --channel gap --border --title t --subtitle t -o b1.svg a.rcg
rc-render --channel gap --border --title t --subtitle t -o b2.svg border.rcg
paths() { grep -o '<path[^>]*>' "$1"; }
claim "--border draws the border of the contact" cmp <(paths b1.svg) <(paths b2.svg)
rc-synth sphere --nx 64 --dx 3um --radius 1mm -o ball.rcg
rc-solve --quiet --estar 2MPa --adhesion 50mJ/m2,jkr --approach 2um ball.rcg -o ball-on.rcg
$frames ball-on.rcg:height ball-on.rcg:contact=pressure >ball-frame.rcg
rc-render --channel height --window contact --title t --subtitle t -o w1.svg ball-on.rcg
rc-render --channel height --window contact --title t --subtitle t -o w2.svg ball-frame.rcg
claim "--window contact shows the contact" cmp <(grep '<text' w1.svg) <(grep '<text' w2.svg)
$frames a.rcg:gap a.rcg:contact=pressure >flow.rcg
rc-leak --quiet --report one.json a.rcg -o one.rcg
rc-leak --quiet --report two.json flow.rcg -o two.rcg
rc-pick --channel gap a.rcg | rc-leak --quiet --report open.json -o open.rcg
near "$(field contact_fraction one.json)" "$(awk -v n="$nodes" 'BEGIN { printf "%.12g", n / 4096 }')" "$same" "rc-leak has as much contact"
near "$(field flow_conductance one.json)" "$(field flow_conductance two.json)" "$same" "  and the flow around a pressure in its place"
near "$(field flow_conductance one.json)" "$(field flow_conductance open.json)" "$same" "  and that through all of the gap, which is 0 where they touch"
claim "  such nodes exist" test "$(field percolates one.json)" = true

# ---- where pressure and contact differ ----

$frames a.rcg:contact e.rcg:pressure e.rcg:gap >both.rcg
claim "nodes may touch without pressure" test "$(count pressure 'v > 0' both.rcg)" -lt "$nodes"
near "$(field contact_nodes <(rc-info --json both.rcg | grep '"channel": "pressure"'))" "$nodes" 0 "  the frame counts"
$frames e.rcg:pressure a.rcg:contact >late.rcg
refuses 1 "the frame contact must precede its pressure" "behind its pressure it comes too late" "rc-info late.rcg"
$frames c.rcg:pressure c.rcg:contact >late.rcg
claim "  a contact equal to the pressure is accepted" rc-info late.rcg
$frames a.rcg:gap=contact a.rcg:pressure >values.rcg
refuses 1 "neither 0 nor 1" "other values are refused" "rc-info values.rcg"

# ---- streams without a map of the contact ----

rc-pick --channel pressure,gap a.rcg -o without.rcg
claim "without the frame rc-info says that the contact is unknown" says "contact  *unknown" rc-info without.rcg
claim "  it says why" warns "does not determine it.*keep both frames" rc-info without.rcg
claim "  JSON has null" says '"contact_nodes": null, "contact_area": null' rc-info --quiet --json without.rcg
refuses 1 "does not determine the contact" "--patches is refused" "rc-info --patches without.rcg"
refuses 1 "does not determine the contact" "rc-leak is refused" "rc-leak without.rcg -o x.rcg"
refuses 1 "does not determine the contact" "--window contact is refused" "rc-render --window contact -o x.png without.rcg"
refuses 1 "does not determine the contact" "--histogram is refused" "rc-render --histogram -o x.png without.rcg"
claim "rc-render draws the map" rc-render --quiet -o x.png without.rcg
$frames e.rcg:gap=pressure >negative.rcg
claim "other negative pressures cause a warning" bash -c 'rc-info negative.rcg >x.txt 2>said.txt; test "$(grep -c "nodes with a pressure above 0 count as contact" said.txt)" = 1'

# ---- friction ----

rc-synth wave --nx 16 --dx 1um --amplitude 1fm --wavelength 16um | rc-solve --quiet --periodic --estar 50MPa --mean-pressure 1MPa --adhesion 10mJ/m2,exponential,20nm -o full.rcg
near "$(count pressure 'v < 0' full.rcg)" 0 0 "complete contact with no net tension"
refuses 1 "friction needs the pressure of the touching nodes alone" "  has no friction of the net pressure" "rc-slip --mu 0.3 --nu 0.3 --tangential 1nN full.rcg -o x.rcg"
refuses 1 "mu 0.3 would turn friction round" "rc-stress --mu of a net pressure" "rc-stress --nu 0.3 --mu 0.3 --depths 1um a.rcg -o x.rcg"
claim "  rc-stress computes stresses without it" rc-stress --quiet --nu 0.3 --depths 100nm a.rcg -o x.rcg
$frames e.rcg:pressure a.rcg:contact >more.rcg
claim "rc-slip accepts nodes that touch without pressure" rc-slip --quiet --nu 0.3 --mu 0.3 --tangential 10nN more.rcg -o x.rcg
rc-solve --quiet --periodic --mean-pressure 10kPa --estar 50MPa --output contact s.rcg -o less.rcg
$frames e.rcg:pressure less.rcg:contact >less2.rcg
refuses 1 "have a pressure, but are not in contact according to this frame" "  and none that carry pressure apart" "rc-slip --quiet --nu 0.3 --mu 0.3 --tangential 10nN less2.rcg -o x.rcg"
