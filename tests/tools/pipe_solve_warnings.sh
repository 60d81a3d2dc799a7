# SPDX-License-Identifier: GPL-3.0-or-later
# rc-solve warns of doubtful solutions, and names the case and the load.
. "$(dirname "$0")/../pipe.sh"

# ---- a pressure beyond linear elasticity; one above E* names the unit that was probably forgotten ----

rc-synth selfaffine --nx 96 --ny 80 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 40um --short-cut 6um --seed 5 -o s.rcg

solve() { # ESTAR LOAD [OPTION...]
    local estar=$1 load=$2
    shift 2
    rc-solve --periodic --estar "$estar" --load "$load" --output pressure "$@" s.rcg -o p.rcg
}
export -f solve
# The peak of a case, and the load at which the warning must begin, by bisection with the report only.
solve 3GPa 1mN --quiet --report soft.json
between 0 "$(field max_pressure soft.json)" 3e8 "a light load stays below a tenth of E*"
claim "there is no warning" bash -c 'solve 3GPa 1mN 2>err; ! grep -q "E\*" err'
solve 3GPa 1 --quiet --report hard.json
between 3e8 "$(field max_pressure hard.json)" 3e9 "a heavy one is above"
near "$(total pressure p.rcg 1)" 1 "$summed" "  its pressures carry it"
claim "a warning gives the fraction of E*" \
    warns 'case 1, load 1 N: the largest pressure, [0-9.]+ [MG]Pa, is 0\.[0-9]+ of E\*' solve 3GPa 1
claim "  and what helps a hard solid" warns 'is not linear elastic: give its --hardness, or a smaller load' solve 3GPa 1
claim "  a rubber, which has no hardness, gets other advice" warns 'is 0\.[0-9]+ of E\*: beyond 0.1 .* a hardness does not help\. .*rc-detrend --lowpass' solve 13.3MPa 5mN
claim "    not the first one" bash -c '! solve 13.3MPa 5mN 2>&1 | grep -q "give its --hardness"'
claim "    with a hardness above the pressure the message is about its unit" warns 'hardness, 1 GPa, is above that: is its unit right' solve 13.3MPa 5mN --hardness 1GPa
claim "E* without its unit causes a warning that names it" warns 'above E\*, which is 3 Pa: was its unit forgotten' solve 3 1mN
claim "a load without its unit causes a warning with its mean over the map" \
    warns 'above E\* = 3 GPa; on a map of 96 um by 80 um the mean is 65[0-9.]+ GPa: are the load, 500 N, and E\* in their right units' solve 3GPa 500
claim "  a wrong unit of E* causes a warning with both values" \
    warns 'above E\* = 3 MPa; .*are the load, 500 mN, and E\* in their right units' solve 3MPa 500mN
rc-synth sphere --nx 64 --dx 10um --radius 10mm -o ball.rcg
claim "a layer of metres on a map of micrometres causes a warning" warns 'thickness of 2 m on a map 640 um wide: .* write 2um' \
    rc-solve --load 1mN --E1 210GPa --nu1 0.3 --E2 rigid --layer 2,400GPa,0.2 ball.rcg -o p.rcg
claim "  with its unit it causes none" bash -c 'rc-solve --load 1mN --E1 210GPa --nu1 0.3 --E2 rigid --layer 2um,400GPa,0.2 ball.rcg -o p.rcg 2>err; ! grep -q "without a unit" err'
rc-synth wave --nx 64 --dx 10um --amplitude 1nm --wavelength 640um -o flat.rcg
claim "a tip that is smaller than the spacing causes a warning" warns 'a radius of 2 nm is smaller than the spacing of the nodes, [0-9.]* [nu]m: the grid does not resolve this tip' \
    rc-solve --load 1uN --estar 114GPa --radius 2nm flat.rcg -o p.rcg
claim "  a larger one does not" bash -c 'rc-solve --load 1mN --estar 114GPa --radius 3.75mm flat.rcg -o p.rcg 2>err; ! grep -q "this tip" err'
claim "a radius of metres causes a warning" warns 'radius of 3.75 m on a map 640 um wide: .* write 3.75mm' rc-solve --load 1mN --estar 114GPa --radius 3.75 flat.rcg -o p.rcg
claim "  with its unit it causes none" bash -c 'rc-solve --load 1mN --estar 114GPa --radius 3.75mm flat.rcg -o p.rcg 2>err; ! grep -q "without a unit" err'
claim "--nu2 with a rigid body is refused" warns 'nu2 has no effect beside --E2 rigid' rc-solve --load 1mN --E1 210GPa --nu1 0.3 --E2 rigid --nu2 0.3 ball.rcg -o p.rcg
claim "an option that is given twice causes a warning" warns 'load is given twice: only the last one counts' rc-solve --load 1N --load 1mN --estar 114GPa ball.rcg -o p.rcg
claim "  several layers cause none" bash -c 'rc-solve --load 1mN --E1 210GPa --nu1 0.3 --E2 rigid --layer 2um,400GPa,0.2 --layer 1um,300GPa,0.2 ball.rcg -o p.rcg 2>err; ! grep -q twice err'
claim "  several steps cause none" bash -c 'rc-pick --mirror x --mirror y ball.rcg -o p.rcg 2>err && [ ! -s err ]'
for tool in "rc-solve --load 1mN --estar 114GPa" "rc-pick --mirror x" "rc-detrend --plane"; do
    refuses 2 "writes a grid stream, not a picture: pipe it into rc-render -o x.png" "a picture of ${tool%% *}" "$tool ball.rcg -o x.png"
done
claim "  no file is left" [ ! -e x.png ]
rc-synth selfaffine --nx 96 --ny 80 --dx 1um --hurst 0.8 --rms-slope 40 --rolloff 40um --short-cut 6um --seed 5 -o s.rcg
claim "heights in a wrong unit cause a warning about their slope" \
    warns 'above E\* = 3 GPa, and the RMS slope in contact is [0-9.]+: are heights and spacings' solve 3GPa 20mN
claim "--quiet suppresses it" bash -c 'solve 3GPa 1 --quiet 2>err && [ ! -s err ]'

# ---- a contact of a few nodes, or of patches of a few nodes ----

rc-synth sphere --nx 65 --dx 5um --radius 10mm -o ball.rcg
press() { rc-solve --estar 100GPa --output pressure --report r.json "$@" -o p.rcg; }
export -f press

# a^3 = 3 F R / (4 E*): 1 N: a = 42.2 um, about 223 nodes; 0.01 N: 9.1 um, about 10
claim "a resolved contact causes no warning" bash -c 'press --load 1N ball.rcg 2>err && [ ! -s err ]'
between 200 "$(field contact_nodes r.json)" 250 "  of its some 223 nodes"
near "$(field nodes_per_patch r.json)" "$(field contact_nodes r.json)" "$same" "  in one patch"
claim "a contact of ten nodes causes a warning" warns 'case 1, load 10 mN: [0-9]+ nodes in contact, in 1 patch: the grid does not resolve it: .*--discretization' \
    press --load 10mN ball.rcg

# one node in 64 stands out by 1 um
awk 'BEGIN { for (j = 0; j < 128; j++) for (i = 0; i < 128; i++)
    printf "%d%s", i % 8 == 0 && j % 8 == 0, i < 127 ? " " : "\n" }' >comb.txt
rc-import --dx 1um --z-unit um comb.txt -o comb.rcg
claim "many patches of one node cause a warning" \
    warns '256 nodes in contact, in 256 patches: the grid does not resolve it' press --periodic --load 1mN comb.rcg
near "$(field nodes_per_patch r.json)" 1 "$same" "  1 node each"

# ---- a map with a step at the edges, solved as periodic ----

rc-synth selfaffine --nx 128 --ny 96 --dx 1um --hurst 0.8 --rms-height 100nm --rolloff 40um --short-cut 8um --seed 5 -o period.rcg
press() { rc-solve --periodic --load 1N --estar 100GPa --output pressure "$@" -o p.rcg; }
export -f press
claim "a periodic map causes no warning" bash -c 'press period.rcg 2>err && [ ! -s err ]'

# A ramp of 1 um over the map, along x or y: the step across the edges is 127/128 um, inside 1/128 um.
ramp() { # AXIS
    rc-export --format xyz period.rcg | LC_ALL=C awk -v axis="$1" '
        $1 ~ /^[-+0-9]/ { print $1, $2, $3 + (axis == "x" ? $1 / 128e-6 : $2 / 96e-6) * 1e-6 }' >ramp.xyz
    rc-import --format xyz --z-unit m --dx 1um ramp.xyz -o "ramp-$1.rcg"
}
ramp x
ramp y
claim "a tilt along x causes a warning about the last column and the first" \
    warns 'the edges do not meet: from the last column to the first the heights jump by .*rc-detrend --plane .*--mirror makes a periodic map .*of 4 times the area' press ramp-x.rcg
claim "  it does not name the rows" bash -c 'lacks "last row" warns.err'
claim "a tilt along y causes a warning about the last row" warns 'from the last row to the first' press ramp-y.rcg
claim "  rc-detrend --plane removes the cause" bash -c 'rc-detrend --plane ramp-x.rcg | press 2>err; ! grep -q "do not meet" err'
claim "a free map causes no such warning" bash -c 'rc-solve --load 10mN --estar 100GPa --output pressure ramp-x.rcg -o p.rcg 2>err; ! grep -q "do not meet" err'

claim "rc-detrend --mirror removes the cause" bash -c 'rc-detrend --mirror ramp-x.rcg | press 2>err; ! grep -q "do not meet" err'
claim "rc-detrend --taper removes the cause" bash -c 'rc-detrend --quiet --taper 12um ramp-x.rcg | press 2>err; ! grep -q "do not meet" err'

# ---- the case and the load in a warning ----

rc-synth sphere --nx 33 --dx 10um --radius 10mm -o ball.rcg
press() { rc-solve --estar 100GPa --output pressure "$@" ball.rcg -o p.rcg; }
export -f press
claim "the third of four loads reaches the edge, and the warning names case 3" \
    warns 'sphere, case 3, load 100 N: [0-9.]+ % of the load is on the outer 2 %' press --load 1N,5N,100N
claim "  it names no other case" bash -c '! grep -E "case [12], .*outer" warns.err'
claim "it names a mean pressure or an approach" bash -c '
    warns "case 1, mean pressure 1 GPa: .*outer" press --mean-pressure 1GPa &&
    warns "case 1, approach 10 um: .*outer" press --approach 10um'
claim "a list that does not rise causes a warning" warns 'load: the list does not rise, but each value starts from unloaded bodies' press --load 5N,3N,4N
claim "  a rising list causes none" bash -c 'press --load 3N,4N,5N 2>err; ! grep -q rise err'
refuses 2 '--load 0: it must be above 0 .0 separates the bodies only in a --history.' "no load is not a first loading" \
    'rc-solve --estar 1GPa --load 0,3N ball.rcg'

# ---- a sphere that is added twice; slopes, judged where the bodies touch ----

rc-synth selfaffine --nx 65 --dx 2um --hurst 0.8 --rms-height 5nm --rolloff 40um --short-cut 10um --seed 5 -o s.rcg
claim "the stream names the sphere" bash -c '
    rc-solve --quiet --radius 2mm --load 1N --estar 100GPa s.rcg -o once.rcg && says "form=sphere 0.002$" rc-info once.rcg'
refuses 1 'a sphere was already added to these heights \(form=sphere 0.002\): remove --radius' "and refuses a second" \
    'rc-solve --quiet --radius 2mm --load 1N --estar 100GPa once.rcg >/dev/null'
claim "solved again without --radius, the result is the same" bash -c '
    rc-solve --quiet --load 1N --estar 100GPa --report again.json --output pressure once.rcg -o again.rcg &&
    rc-solve --quiet --radius 2mm --load 1N --estar 100GPa --report first.json --output pressure s.rcg -o first.rcg'
near "$(field max_pressure again.json)" "$(field max_pressure first.json)" "$summed" "  to rounding"

# A ball of 100 um on a map of 130 um: slopes of 0.65 at its flank, of a/R in contact: 1 N: a = 9.1 um
rc-synth sphere --nx 131 --dx 1um --radius 100um -o ball.rcg
press() { rc-solve --estar 100GPa --output pressure --load "$1" ball.rcg -o p.rcg; }
export -f press
claim "a steep flank outside contact causes no warning" bash -c 'press 1N 2>err; ! grep -q slope err'
# 1000 N: a = 90.9 um; the RMS over the disc of r/R is a/(R sqrt 2)
rc-synth sphere --nx 131 --dx 2um --radius 100um -o ball.rcg
claim "a steep flank in contact causes one" warns 'RMS slope 0\.[56][0-9]* where the bodies touch' press 1000N

# ---- a solution that did not converge, or was interrupted; last, because of job control ----

rc-synth selfaffine --nx 256 --dx 1um --hurst 0.8 --rms-height 100nm --rolloff 60um --short-cut 4um --seed 5 -o s.rcg
claim "an unreachable tolerance causes a warning and exit status 3" bash -c '
    rc-solve --periodic --load 1N --estar 100GPa --tol 1e-17 s.rcg -o short.rcg 2>err; [ $? = 3 ] &&
    grep -q "case 1, load 1 N: not converged after [0-9]* iterations: its estimated error is [0-9.e-]*: accept it with a larger --tol" err'

rc-synth selfaffine --nx 2048 --dx 1um --hurst 0.8 --rms-height 1um --short-cut 2um --seed 5 -o large.rcg
interrupted() {
    local status
    rc-solve --progress line --periodic --load 40N --estar 100GPa --tol 1e-12 --method pk99 --output pressure large.rcg \
        -o cut.rcg 2>err &
    local tool=$!
    until grep -q 'iteration 1$' err || ! kill -0 "$tool"; do sleep 0.05; done
    kill -INT "$tool"
    wait "$tool"
    status=$?
    cat err >&2
    [ "$status" = 130 ] && grep -q 'interrupted after [0-9]* iterations: the frames hold the best state so far, not a solution' err
}
# a background command of bash without job control ignores SIGINT
set -m
claim "an interrupted run causes a warning" interrupted
claim "  its stream is marked" bash -c 'rc-info cut.rcg 2>/dev/null >cut.txt; grep converged=no cut.txt'
# During planning there is no result yet; at any time the signal leaves a complete file or none.
early() {
    local none=0 k
    for k in 0.01 0.02 0.05 0.1 0.3 0.5; do
        rm -f early.rcg*
        rc-solve --quiet --load 1N --estar 100GPa --tol 1e-12 --method pk99 --output pressure large.rcg -o early.rcg 2>err &
        sleep $k
        kill -INT $! && wait $!
        [ $? = 130 ] || return 1
        if [ -e early.rcg ]; then
            rc-info --quiet early.rcg >/dev/null 2>&1
            [ $? = 3 ] || return 1 # it says converged=no
        else
            none=$((none + 1))
        fi
        [ "$(find . -name 'early.rcg?*')" = "" ] || return 1
    done
    [ $none -gt 0 ]
}
claim "a signal during the plan ends the tool at once, without a file" early

# ---- a roller on a map that does not continue ----

rc-pick --set periodic=no s.rcg -o scan.rcg
roller() { rc-solve --estar 115GPa --output pressure --load 10N "$@" -o p.rcg scan.rcg; }
export -f roller
claim "a roller that reaches the edges of the map: the axis of the period, and the pressure at the edge, in one message" \
    warns '% of the load is on the outer 2 % of the map and the largest pressure, [0-9.]+ GPa, at the edge itself, .*--periodic=y if the roller continues along its axis' roller --cylinder 5mm
claim "  no other message is about the edge" bash -c '[ "$(roller --cylinder 5mm 2>&1 | grep -c edge)" = 1 ]'
claim "  with --periodic=y there is none" bash -c '! roller --cylinder 5mm --periodic=y 2>&1 | grep -q edge'
claim "  without a roller the surface is to repeat" warns '% of the load is on the outer 2 % of the map.*or --periodic if the surface repeats' roller
