# SPDX-License-Identifier: GPL-3.0-or-later
# rc-solve --layer: the stream holds the body, rc-deflect and rc-stress read it there, and invalid layers are
# refused.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 97 --ny 95 --dx 24um --radius 100mm -o ball.rcg
solve() { rc-solve --E1 100GPa --nu1 0.3 --E2 rigid --load 350N "$@"; }
export -f solve
claim "a hard layer is solved" bash -c 'solve --layer 1mm,1000GPa,0.3 --report hard.json ball.rcg -o hard.rcg 2>err && [ ! -s err ]'
claim "  the stream has the layer" says 'layers=0.001,1000000000000,0.3;inf,100000000000,0.3$' rc-info hard.rcg
claim "  the history has it in SI" says 'rc-solve .*--layer 0.001,1000000000000,0.3' rc-info hard.rcg
claim "  the report has it" says '"layers": "on: 1 on a substrate"' cat hard.json
solve --report bare.json ball.rcg -o bare.rcg
claim "without a layer the report says so" says '"layers": "left out: one material"' cat bare.json
claim "  the stream has no key of layers" bash -c 'rc-info bare.rcg >bare.txt && lacks layers= bare.txt'
near "$(field load bare.json)" 350 "$summed" "  the load is carried"
near "$(field max_pressure bare.json)" "$(awk 'BEGIN { e = 100e9 / 0.91
    printf "%.17g", (6 * 350 * e * e / 3.14159265358979 ^ 3 / 0.1 ^ 2) ^ (1 / 3) }')" "$coarse_grid" "  with the pressure of Hertz"
claim "a hard layer reduces the contact area" awk -v a="$(field contact_area hard.json)" -v b="$(field contact_area bare.json)" \
    'BEGIN { exit !(a < 0.5 * b) }'

# layers of the substrate's material have no effect
solve --tol 1e-9 --layer 30um,100GPa,0.3 --layer 0.2mm,100GPa,0.3 --report same.json --output pressure ball.rcg -o same.rcg
solve --tol 1e-9 --report bare.json --output pressure ball.rcg -o bare.rcg
near "$(field max_pressure same.json)" "$(field max_pressure bare.json)" 1e-8 "two layers of the substrate's material are none: pressure"
near "$(field approach same.json)" "$(field approach bare.json)" 1e-9 "  approach"

# ---- residual stress ----

solve --layer 1mm,1000GPa,0.3,-3GPa --layer 0.5mm,300GPa,0.25 --report pressed.json --output pressure ball.rcg -o pressed.rcg
solve --layer 1mm,1000GPa,0.3 --layer 0.5mm,300GPa,0.25 --output pressure ball.rcg -o free.rcg
pressures() { rc-export --format csv "$1" | grep -v '^#' | sha256sum; }
claim "a residual stress without a unit causes a warning" warns 'residual stress, 4 Pa, is below a millionth of the modulus of the layer: is its unit right' solve --layer 1mm,1000GPa,0.3,4 --output pressure ball.rcg -o x.rcg
claim "  one above the modulus too" warns 'residual stress, -3 TPa, is above the modulus of the layer' solve --layer 1mm,1000GPa,0.3,-3e12 --output pressure ball.rcg -o x.rcg
claim "  others cause none" eval 'solve --layer 1mm,1000GPa,0.3,-3GPa --output pressure ball.rcg -o x.rcg 2>none.err && [ ! -s none.err ]'
claim "the stream has the residual stress" says 'layers.residual=-3000000000;0$' rc-info pressed.rcg
claim "  the key of the layers does not change" says 'layers=0.001,1000000000000,0.3;0.0005,300000000000,0.25;inf,100000000000,0.3$' rc-info pressed.rcg
claim "  history and report have the residual stress" eval 'says "rc-solve .*--layer 0.001,1000000000000,0.3,-3000000000" rc-info pressed.rcg && says "0.001,1000000000000,0.3,-3000000000; 0.0005" cat pressed.json'
claim "  it changes no pressure" test "$(pressures pressed.rcg)" = "$(pressures free.rcg)"
extreme() { rc-info --json "$2" | grep "\"channel\": \"$3\"" | sed "s/.*\"$1\": \([^,]*\),.*/\1/"; }
# positions are in the top layer, in the one below, in the substrate
for depth in 0.5mm 1.2mm 2mm; do
    for file in pressed free; do rc-stress --depths $depth --components sxx,syy,szz,sxz $file.rcg -o $file-stress.rcg; done
    for c in sxx syy szz sxz; do
        case $depth$c in 0.5mmsxx | 0.5mmsyy) more=-3e9 ;; *) more=0 ;; esac
        near "$(extreme maximum pressed-stress.rcg $c)" "$(awk -v v="$(extreme maximum free-stress.rcg $c)" -v m=$more 'BEGIN { printf "%.17g", v + m }')" "$summed" "  $c $depth below: $more Pa more"
    done
done
rc-stress --depths 0.5mm,1.2mm,2mm --residual --components mises,tresca,s1,s3 --report residual.json pressed.rcg -o residual.rcg
claim "without a pressure rc-stress gives the residual stress alone" test "$(for c in mises tresca s1 s3; do extreme maximum residual.rcg $c | paste -s -d ' '; done | paste -s -d ';')" = "3000000000 0 0;3000000000 0 0;0 0 0;-3000000000 0 0"
claim "  the report says so" says '"coating": "on, with residual stress in the layers"' cat residual.json
claim "a section has it too, with its legend" eval 'rc-stress --section y=0 --depths auto --components sxx pressed.rcg | rc-render -o section.svg && says "ν 0.3, residual −3 GPa<" cat section.svg'
claim "a solution for other bodies removes the key" eval 'solve --output pressure pressed.rcg -o bare.rcg 2>err || rc-solve --estar 1GPa --load 1N ball.rcg | rc-info >bare.txt && lacks layers.residual bare.txt'
for bad in 'x' '1' '1;2;3' '1;' '1;inf'; do
    rc-pick --set "layers.residual=$bad" pressed.rcg -o bad.rcg
    refuses 1 "its layers.residual is '$bad': it must be a stress in Pa for each layer" "layers.residual=$bad" "rc-stress --depths 0 bad.rcg"
done
refuses 2 'a layer is THICKNESS,E,NU or THICKNESS,E,NU,RESIDUAL' "a fifth number" "rc-solve --E1 1GPa --nu1 0.3 --E2 rigid --load 1N --layer 1mm,1GPa,0.3,1GPa,2 ball.rcg"

largest() { rc-info --json "$@" 2>/dev/null | grep "\"channel\": \"displacement\"" | sed 's/.*"maximum": \([^,]*\),.*/\1/'; }
near "$(rc-deflect hard.rcg | largest)" "$(largest hard.rcg)" "$rounding" "rc-deflect finds the displacement again"
for kernel in direct mlms; do
    near "$(rc-deflect --kernel $kernel --tol 1e-6 hard.rcg | largest)" "$(largest hard.rcg)" 1e-5 "  by $kernel"
done
refuses 1 'the stream already defines the layers; remove --estar' "  and no modulus beside" "rc-deflect --estar 1GPa hard.rcg"

# body 2 is in the stream and need not be derived from E*
rc-solve --E1 100GPa --nu1 0.3 --E2 70GPa --nu2 0.33 --load 350N --layer 1mm,1000GPa,0.3 ball.rcg -o both.rcg
claim "the stream has an elastic body 2" bash -c 'rc-info both.rcg >both.txt &&
    says "e1=100000000000$" cat both.txt && says "nu=0.3$" cat both.txt &&
    says "e2=70000000000$" cat both.txt && says "nu2=0.33$" cat both.txt'
near "$(rc-deflect both.rcg | largest)" "$(largest both.rcg)" "$rounding" "  and rc-deflect presses it too"
claim "a rigid body 2 has no key" bash -c 'rc-info hard.rcg >hard.txt && says "e1=100000000000$" cat hard.txt && lacks "e2=" hard.txt'
claim "bodies with E* alone have no keys" bash -c 'rc-solve --estar 1GPa --load 1N ball.rcg | rc-info >estar.txt &&
    says "estar=1000000000$" cat estar.txt && lacks "e1=" estar.txt && lacks "nu=" estar.txt'
rc-pick --set estar=80e9 hard.rcg -o old.rcg
refuses 1 'the stream does not define body 2; solve the contact again' "an E* that bodies 1 and 2 do not have is refused" "rc-deflect old.rcg"
claim "rc-stress reads the layers" says 'material' bash -c 'rc-stress --depths 0.5mm,2mm --components mises hard.rcg | rc-info'

refuses 2 '--layer needs a substrate and a body 2: give --E1' "with --estar" "rc-solve --load 1N --estar 1GPa --layer 1um,1GPa,0.3 ball.rcg"
for layer in 1um 1um,1GPa 1um,1GPa,0.3,4,5 0,1GPa,0.3 1um,-1GPa,0.3 1um,1GPa,0.6 1um,1GPa,-1 inf,1GPa,0.3 1N,1GPa,0.3 ,, ''; do
    refuses 2 "^rc-solve: --layer $layer" "--layer '$layer'" "solve --layer '$layer' ball.rcg"
done
claim "--dry-run names them" says 'layers +on: 2 on a substrate' solve --layer 1um,1GPa,0.3 --layer 2um,1GPa,0.3 --dry-run ball.rcg
coated="rc-solve --E1 100GPa --nu1 0.3 --E2 rigid --load 350N --layer 1mm,1000GPa,0.3"
claim "rc-cost too solves coated bodies" says '^# reference: tol 0.001' rc-cost --tol 1e-2 ball.rcg -- $coated
claim "  their stresses too" says '^# error: of sxx' rc-cost --tol 1e-1,1e-2 ball.rcg -- $coated '|' rc-stress --depths 0,0.5mm,2mm
