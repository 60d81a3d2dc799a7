# SPDX-License-Identifier: GPL-3.0-or-later
# rc-stress on coated bodies as a command. Tested are its input from the stream, its output and report, and
# refusals.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 65 --ny 49 --dx 10um --dy 11um --radius 7.5mm |
    rc-solve --quiet --load 240N --E1 208GPa --nu1 0.3 --E2 208GPa --nu2 0.3 \
        --output pressure -o ball.rcg
rc-synth wave --nx 40 --ny 30 --dx 1um --amplitude 50nm --wavelength 20um |
    rc-solve --quiet --periodic --mean-pressure 100MPa --estar 100GPa --output pressure -o wave.rcg
p0=2205240000 # Hertz

# coat STREAM LAYERS: writes the pressure of the stream with another body
coat() { rc-pick --set "layers=$2" "$1"; }
number() { grep -o "\"$1\": {[^{]*" "$3" | grep -o "\"$2\": [^,]*" | head -n 1 | cut -d' ' -f2; }
least() { grep -o '"min": {.*' "$3" >least.json && number "$1" "$2" least.json; }
list() { grep -o "\"$1\": \[[^]]*" "$2" | head -n 1 | sed 's/.*\[//'; }
mean() { rc-info --json "$1" | grep -o '"mean": [^,]*' | cut -d' ' -f2; }

# ---- one material in layers ----

coat ball.rcg '3e-05,208e9,0.3;1e-05,208e9,0.3;inf,208e9,0.3' >one.rcg
rc-stress --depths auto --components mises --report one.json one.rcg -o mises.rcg
near "$(number mises value one.json)" "$(awk "BEGIN { print 0.620041 * $p0 }")" "$coarse_grid" \
    "layers of one material have the largest Mises stress of Hertz's contact"
near "$(number mises depth one.json)" "$(awk 'BEGIN { print 0.480864 * 228e-6 }')" 0.15 "  at its depth"
rc-stress --depths 20um,35um,100um --mu 0.2 --report a.json one.rcg -o /dev/null
rc-stress --depths 20um,35um,100um --mu 0.2 --report b.json ball.rcg -o /dev/null
for c in sxx syy szz sxy sxz syz mises; do
    near "$(number $c value a.json)" "$(number $c value b.json)" "$summed" "  and its largest $c, with friction"
    near "$(least $c value a.json)" "$(least $c value b.json)" "$summed" "  and its least"
done

# ---- output ----

layers='2e-05,4e11,0.2;5e-06,1e10,0.45;inf,2e11,0.3'
coat ball.rcg "$layers" >coated.rcg
rc-stress --depths 0,20um,22um,25um,30um --components szz --report r.json coated.rcg -o s.rcg
claim "a slice has the number of its material, at an interface the upper one" \
    test "$(rc-info --json s.rcg | grep -o '"material": "[0-9]*"' | tr -dc '0-9\n' | xargs)" = '1 1 2 2 3'
claim "  the report has it too" test "$(list materials r.json)" = '1, 1, 2, 2, 3'
claim "  the report has the layers" grep -qF "\"layers\": \"$layers\"" r.json
claim "slices have the layers, and no Poisson's ratio of a single material" bash -c '
    says "layers=2e-05,4e11" rc-info s.rcg && lacks "nu=" says.out'
claim "the report has none either" grep -q '"nu": null' r.json
near "$(least szz value r.json)" "-$p0" 5e-3 "szz at the surface is the pressure"
claim "without layers the report says so" bash -c '
    grep -q "\"layers\": null" b.json && grep -q "\"coating\": \"left out: [^\"]*layers" b.json &&
    grep -q "\"materials\": \[1, 1, 1\]" b.json'

# by_material: the largest or smallest value of by_depth in each material
claim "the largest and smallest values of each material are among those by depth" bash -c '
    rc-stress --depths 20um,20.1um,30um --components mises --report m.json coated.rcg -o /dev/null
    grep -o "\"by_depth\": \[[^]]*" m.json | sed "s/.*\[//" >depth.txt
    grep -o "\"by_material\": \[[^]]*" m.json | sed "s/.*\[//" | cmp - depth.txt'
rc-stress --depths 1um --components mises --report n.json coated.rcg -o /dev/null
claim "a material without a depth has no largest value" \
    grep -q '"by_material": \[[0-9.e]*, null, null\]' n.json

# ---- depths ----

rc-stress --depths auto --components szz --report auto.json coated.rcg -o auto.rcg
claim "--depths auto takes both sides of each interface" bash -c '
    grep -q " 2e-05, 2.0000005e-05, .* 2.5e-05, 2.5000025e-05, " auto.json'
claim "  its depths increase" bash -c '
    grep -o "\"depths\": \[0, [^]]*" auto.json | tr "," "\n" | sed "1d" | sort -g -c -u'
claim "  each material has at least three" bash -c '
    for m in 1 2 3; do
        [ "$(grep -o "\"materials\": \[[^]]*" auto.json | grep -o "[ \[]$m\b" | wc -l)" -ge 3 ] || exit 1
    done'
claim "a section passes through all materials" bash -c '
    rc-stress --depths auto --section y=0 --components sxx coated.rcg | rc-render -o section.png &&
    test -s section.png'

# ---- the mean on a periodic map ----

# -p (nu/(1 - nu) + E (1 + nu_s)(1 - 2 nu_s)/(2 E_s (1 - nu))): 0.9 in the layer, 0.8 below
coat wave.rcg '2e-06,4e11,0.2;inf,2e11,0.3' >periodic.rcg
p=$(mean wave.rcg)
rc-stress --depths 1um --components sxx periodic.rcg -o top.rcg
rc-stress --depths 3um --components sxx periodic.rcg -o below.rcg
near "$(mean top.rcg)" "$(awk "BEGIN { printf \"%.17g\", -0.9 * $p }")" "$summed" \
    "sxx of a periodic layer has the mean that its substrate's strains give"
near "$(mean below.rcg)" "$(awk "BEGIN { printf \"%.17g\", -0.8 * $p }")" "$summed" "  and the substrate"

# ---- dry run ----

rc-stress --depths 0,22um,30um,40um --dry-run coated.rcg >dry.txt
claim "--dry-run names the materials and the depths in each" bash -c '
    grep -q "material 1 .*E 4e+11 Pa, nu 0.2: 1 of" dry.txt &&
    grep -q "material 3 .*from 2.5e-05 m, E 2e+11 Pa, nu 0.3: 2 of" dry.txt &&
    grep -q "coating *on" dry.txt'
claim "  it says if there are no layers" \
    says 'coating *left out: .*one material' rc-stress --depths 0 --dry-run ball.rcg
claim "--tol takes no coarser grid for a coated body, and says so" bash -c '
    rc-stress --depths 400um --tol 0.05 --components szz --report t.json coated.rcg -o /dev/null &&
    grep -q "\"coarse_grids\": \"left out: the body is coated\"" t.json &&
    grep -q "\"coarse_depths\": 0" t.json'

# ---- refusals ----

refuses 1 'each material has its own Poisson' "--nu beside layers" "rc-stress --nu 0.3 --depths 0 coated.rcg"
coat ball.rcg '2e-05,4e11,0.2;inf,inf,0.3' >rigid.rcg
refuses 1 'depth 3e-05 m is inside its rigid substrate' "a depth in a rigid substrate" \
    "rc-stress --depths 20um,30um rigid.rcg"
claim "a rigid substrate is not a material for stresses, and auto ends at it" bash -c '
    rc-stress --depths 20um --components szz rigid.rcg -o face.rcg &&
    rc-stress --depths auto --components szz rigid.rcg | rc-info | grep "depth=" | tail -n 1 >last.txt &&
    grep -q "depth=2e-05$" last.txt'
while read -r bad; do
    coat ball.rcg "$bad" >bad.rcg
    refuses 1 'they must be t,E,nu of each material' "layers '$bad'" "rc-stress --depths 0 bad.rcg"
done <<'END'
thick
2e-05,4e11,0.2
2e-05,4e11;inf,2e11,0.3
2e-05,4e11,0.2;inf,2e11,0.3;
2e-05,4e11,0.2;inf,2e11,0.3,1
2e-05;4e11;0.2,inf,2e11,0.3
END
while read -r bad; do
    coat ball.rcg "$bad" >bad.rcg
    refuses 1 'of its layers .* is impossible' "layers '$bad'" "rc-stress --depths 0 bad.rcg"
done <<'END'
-2e-05,4e11,0.2;inf,2e11,0.3
0,4e11,0.2;inf,2e11,0.3
2e-05,0,0.2;inf,2e11,0.3
2e-05,inf,0.2;inf,2e11,0.3
2e-05,4e11,0.6;inf,2e11,0.3
2e-05,4e11,-1;inf,2e11,0.3
inf,4e11,0.2;inf,2e11,0.3
2e-05,4e11,0.2;3e-05,2e11,0.3
2e-05,nan,0.2;inf,2e11,0.3
END
coat ball.rcg "$(awk 'BEGIN { for (k = 0; k < 1000; k++) printf "1e-9,1e11,0.3;"; print "inf,2e11,0.3" }')" >many.rcg
refuses 1 'of 1001 materials: at most 1000' "a thousand layers" "rc-stress --depths 0 many.rcg"
