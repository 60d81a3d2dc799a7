# SPDX-License-Identifier: GPL-3.0-or-later
# A surface may repeat along one axis (key periodic=x or y). A tool that cuts, fits or filters it asks each axis:
# a turned map gives the turned result, three copies of a map give in their middle the map that repeats, and a
# step that ends the period along one axis keeps that along the other. rc-pick --extrude makes such a map of a
# profile.
. "$(dirname "$0")/../pipe.sh"

says_key() { # PATTERN FILE: a header line matches it
    head -c 4000 "$2" | grep -aqE "^$1\$" || { head -c 1000 "$2" | grep -aE '^(periodic|boundary|datum|ny|nx)=' >&2; false; }
}
# differ A B: the RMS of the difference of two maps over that of the first
differ() {
    rc-add --quiet --subtract "$1" "$2" | rc-info --json >differ.json
    rc-info --json "$1" >first.json
    awk -v d="$(field rms differ.json)" -v r="$(field rms first.json)" 'BEGIN { print d / r }'
}
export -f says_key
# Heights that repeat along y only: those of a periodic surface, and a wave of three halves along x.
rc-synth selfaffine --nx 48 --ny 40 --dx 1um --dy 1.1um --hurst 0.8 --rms-height 0.1um --rolloff 20um --seed 3 -o rough.rcg
rc-synth wave --like rough.rcg --amplitude 0.2um --wavelength 32um -o wave.rcg
rc-add --quiet rough.rcg wave.rcg | rc-pick --set periodic=y -o y.rcg
rc-pick --rotate 90 y.rcg -o x.rcg
claim "a turned map that repeats along y repeats along x" says_key periodic=x x.rcg
claim "  and turned back along y" bash -c 'rc-pick --rotate 270 x.rcg -o back.rcg && says_key periodic=y back.rcg && rc-pick --rotate 180 y.rcg -o half.rcg && says_key periodic=y half.rcg'
rc-export --format csv y.rcg | grep -v '^[#"]' | tr ',' ' ' >rows.txt
cat rows.txt rows.txt rows.txt | rc-import --quiet --format ascii --dx 1um --dy 1.1um --z-unit m - -o three.rcg
middle() { rc-pick --quiet --crop 0,40,48,40 "$@"; }

# ---- steps of rc-detrend ----

for step in '--lowpass 6um' '--highpass 25um' '--robust --lowpass 9um' '--outliers 2.5 --fill' '--spikes 1 --fill'; do
    # shellcheck disable=SC2086
    rc-detrend --quiet $step y.rcg -o after-y.rcg
    # shellcheck disable=SC2086
    rc-detrend --quiet $step x.rcg | rc-pick --rotate 270 -o after-x.rcg
    between 0 "$(differ after-y.rcg after-x.rcg)" 1e-9 "$step: the turned map gives the turned result"
    claim "  the map still repeats along y" says_key periodic=y after-y.rcg
    rc-pick --set periodic=yes y.rcg | rc-detrend --quiet ${step#--robust } -o both.rcg
    rc-pick --set periodic=no y.rcg | rc-detrend --quiet ${step#--robust } -o none.rcg
    rc-detrend --quiet ${step#--robust } y.rcg -o plain.rcg
    between 1e-6 "$(differ plain.rcg both.rcg)" 1 "  another than of a map that repeats along both axes"
    between 1e-6 "$(differ plain.rcg none.rcg)" 1 "  or along none"
done
for step in '--lowpass 6um' '--highpass 25um'; do
    # shellcheck disable=SC2086
    rc-detrend $step y.rcg -o after-y.rcg
    # shellcheck disable=SC2086
    rc-detrend $step three.rcg | middle >after-three.rcg
    between 0 "$(differ after-y.rcg after-three.rcg)" 1e-10 "$step: the middle of three copies is the map that repeats along y"
done
claim "a plane ends the period of a rough map" warns 'a periodic surface is not periodic without its form: it gets periodic=no' rc-detrend --plane y.rcg -o flat.rcg
claim "slopes of rows end that along x only" warns 'is not periodic along x without its form: it gets periodic=y' rc-detrend --rows tilt rough.rcg -o tilted.rcg
claim "  one along y is kept in silence" bash -c 'rc-detrend --rows tilt y.rcg -o tilted.rcg 2>err && [ ! -s err ] && says_key periodic=y tilted.rcg'
refuses 1 '--taper: the map repeats along one axis already .periodic=y.: solve it with --periodic=y, or take --mirror' "no taper along one axis" "rc-detrend --taper 5um y.rcg"

# ---- mirror images ----

rc-detrend --mirror y.rcg -o mirrored.rcg
rc-pick --rotate 180 x.rcg | rc-detrend --mirror | rc-pick --rotate 90 -o turned.rcg
rc-info --json mirrored.rcg >m.json
claim "--mirror of a map that repeats along y adds the images along x" test "$(field nx m.json) $(field ny m.json)" = "96 40"
claim "  then it repeats along both" says_key periodic=yes mirrored.rcg
between 0 "$(differ mirrored.rcg turned.rcg)" 1e-15 "  a turned map gives the turned one"
rc-pick --set periodic= y.rcg -o none.rcg
for axis in x y; do
    rc-detrend --mirror="$axis" none.rcg -o "m$axis.rcg"
    claim "--mirror=$axis makes a map that repeats along $axis" says_key "periodic=$axis" "m$axis.rcg"
done
claim "  of twice the area" test "$(rc-info --json mx.rcg | grep -o '"nx": 96, "ny": 40') $(rc-info --json my.rcg | grep -o '"nx": 48, "ny": 80')" = '"nx": 96, "ny": 40 "nx": 48, "ny": 80'
claim "  the history has the axis" says 'rc-detrend [0-9.]* --mirror y$' cat my.rcg
claim "  both in turn are --mirror" bash -c 'rc-detrend --mirror x --mirror=y none.rcg | rc-pick --set history.x=1 -o a.rcg && rc-detrend --mirror none.rcg | rc-pick --set history.x=1 -o b.rcg && cmp <(rc-export --format csv a.rcg | grep -v ^#) <(rc-export --format csv b.rcg | grep -v ^#) && says_key periodic=yes a.rcg'
refuses 1 '--mirror has no effect, because the map is already periodic along y: leave it out' "images along y of a map that repeats along y" "rc-detrend --mirror=y y.rcg"
rc-pick --set channel=hardness --set unit=Pa y.rcg -o hardness.rcg
both() { { head -c -9 "$1"; head -c -9 "$2"; printf 'RCGEND 2\n'; }; }
both y.rcg hardness.rcg >both.rcg
claim "a map of hardness is mirrored with its height" bash -c 'rc-detrend --mirror both.rcg | rc-info --json >two.json && [ "$(grep -c "\"nx\": 96, \"ny\": 40" two.json)" = 2 ]'
rc-pick --set periodic= hardness.rcg -o keyless.rcg
both y.rcg keyless.rcg >both.rcg
refuses 1 '.hardness.: --mirror: this frame has periodic=no, and the one before it in the case periodic=y: set the key of both with rc-pick --set periodic=y' \
    "one that repeats along another axis is refused" "rc-detrend --mirror both.rcg"
both keyless.rcg y.rcg >both.rcg
refuses 1 '.height.: --mirror: this frame has periodic=y, and the one before it in the case periodic=no: set the key of both with rc-pick --set periodic=y' \
    "  also before the height" "rc-detrend --mirror both.rcg"
claim "  other steps do not ask" rc-detrend --lowpass 9um both.rcg -o after.rcg
refuses 2 '--mirror=z|--mirror z: it must be one of x|y|xy' "a third axis" "rc-detrend --mirror=z y.rcg"
solve='rc-solve --mean-pressure 1MPa --estar 100GPa --periodic=y --output pressure -o p.rcg'
slope='rc-synth sphere --radius 1mm --place 0,20um --like rough.rcg'
claim "a step across the edges along y: the warning proposes --mirror=y" warns 'from the last row to the first .*--mirror=y makes a periodic map of twice the area' bash -c "$slope | $solve"
claim "  which removes it" bash -c "$slope | rc-detrend --mirror=y | $solve 2>err; ! grep -q 'do not meet' err"

rc-synth sphere --like rough.rcg --radius 0.1mm | rc-add --quiet - rough.rcg -o tip.rcg
for axis in x y; do
    claim "rc-report --mirror with --periodic=$axis adds the images along $axis" bash -c "
        rc-report --quiet --mirror --periodic=$axis --load 1e3N/m --estar 100GPa tip.rcg -o page.html && grep -q 'the map repeats along $axis' page.html && grep -qE 'rc-detrend .*--mirror $axis' page.html"
done

# ---- steps of rc-pick ----

claim "a cut along x keeps the period along y" bash -c 'rc-pick --crop 0,0,20,40 y.rcg -o part.rcg 2>err && [ ! -s err ] && says_key periodic=y part.rcg'
claim "  one along y ends it" warns 'a part of a periodic map is not periodic: it gets periodic=no' rc-pick --crop 0,0,48,20 y.rcg -o part.rcg
claim "  of a map that repeats along both the other one stays" warns 'is not periodic along x: it gets periodic=y' rc-pick --crop 0,0,20,40 rough.rcg -o part.rcg
claim "a remainder of --resample ends that along its axis" warns 'is not periodic along x: it gets periodic=y' rc-pick --resample 5um,1.1um rough.rcg -o part.rcg
claim "--mirror keeps it" bash -c 'rc-pick --mirror x --mirror y y.rcg -o part.rcg && says_key periodic=y part.rcg'
rc-pick --resample 96x100 y.rcg -o fine-y.rcg
rc-pick --resample 100x96 x.rcg | rc-pick --rotate 270 -o fine-x.rcg
between 0 "$(differ fine-y.rcg fine-x.rcg)" 1e-12 "a finer grid: the turned map gives the turned result"
rc-pick --resample 96x300 three.rcg | rc-pick --crop 0,100,96,100 -o fine-three.rcg
between 0 "$(differ fine-y.rcg fine-three.rcg)" 1e-12 "  the middle of three copies is the map that repeats along y"
rc-solve --quiet --mean-pressure 10MPa --estar 100GPa --periodic=y --output pressure,height y.rcg -o p.rcg
claim "the result has the boundary and the datum" bash -c 'says_key boundary=periodic-y p.rcg && says_key datum=4.8e-05 p.rcg'
claim "  they turn with it" bash -c 'rc-pick --rotate 90 p.rcg -o part.rcg && says_key boundary=periodic-x part.rcg && says_key periodic=x part.rcg && says_key datum=4.8e-05 part.rcg'
claim "  a cut along x keeps them" bash -c 'rc-pick --crop 0,0,20,40 p.rcg -o part.rcg && says_key boundary=periodic-y part.rcg'
claim "  one along y removes them" bash -c 'rc-pick --quiet --crop 0,0,48,20 p.rcg -o part.rcg && says_key periodic=no part.rcg && lacks "^(boundary|datum)=" part.rcg'

# ---- sums ----

claim "a sum repeats along the axes of both" warns 'this surface is periodic, but the result is not along x, because the other one is not: it gets periodic=y' rc-add rough.rcg y.rcg -o sum.rcg
claim "  in silence if the first repeats along no other" bash -c 'rc-add y.rcg rough.rcg -o sum.rcg 2>err && [ ! -s err ] && says_key periodic=y sum.rcg'
rc-pick --quiet --crop 0,0,40,40 y.rcg -o narrow.rcg
claim "  a cut along x keeps that along y" bash -c 'rc-add y.rcg narrow.rcg -o sum.rcg 2>err && [ ! -s err ] && says_key periodic=y sum.rcg'
claim "  two axes without a common one give none" warns 'the result is not, because the other one is not: it gets periodic=no' bash -c 'rc-pick --set periodic=x y.rcg | rc-add y.rcg - -o sum.rcg'

# ---- figures ----

rc-info --json --areal --psd y.rcg >y.json
rc-info --json --areal --psd x.rcg >x.json
for name in sq sal sdq sdr sku std spd sha hurst; do
    from=$(field "$name" y.json)
    [ "$name" = std ] && from=$(awk -v s="$from" 'BEGIN { s += 90; printf "%.15g\n", (s >= 180 ? s - 180 : s) }')
    near "$(field "$name" x.json)" "$from" 1e-9 "$name of the turned map"
done
near "$(rc-info --json --patches p.rcg | head -n 1 | grep -o '"patches": {"count": [0-9]*' | grep -o '[0-9]*$')" \
    "$(rc-pick --rotate 90 p.rcg | rc-info --json --patches | head -n 1 | grep -o '"patches": {"count": [0-9]*' | grep -o '[0-9]*$')" 0 "a turned pressure has as many patches"
# a wave of whole periods along y: without a window along y its power is in the rows of its wave number
rc-synth wave --nx 40 --ny 30 --dx 1um --amplitude 10nm --wavelength 0,10um | rc-pick --set periodic=y -o whole.rcg
rc-info --psd-map psd.rcg whole.rcg >out.txt
claim "a spectrum has no window along the axis that repeats" test "$(rc-export --format xyz psd.rcg | awk '!/^#/ && NF && $3 > 1e-30 { print $2 }' | sort -u | wc -l)" = 2

# ---- a profile becomes a map ----

rc-synth selfaffine --nx 128 --ny 1 --dx 1um --hurst 0.8 --rms-height 20nm --rolloff 40um --short-cut 8um --seed 7 | rc-pick --set periodic=no -o profile.rcg
rc-pick --extrude 6 profile.rcg -o ridges.rcg
rc-pick --rotate 90 profile.rcg | rc-pick --extrude 6 -o turned.rcg
claim "--extrude makes equal rows" test "$(rc-export --format csv ridges.rcg | grep -v '^[#"]' | sort -u | wc -l) $(rc-export --format csv ridges.rcg | grep -vc '^[#"]')" = "1 6"
claim "  those of the profile" cmp <(rc-export --format csv profile.rcg | grep -v '^[#"]') <(rc-export --format csv ridges.rcg | grep -v '^[#"]' | head -n 1)
claim "  as far apart as its nodes" says_key dy=1e-06 ridges.rcg
claim "  which repeat along y" says_key periodic=y ridges.rcg
claim "  or along x, of a column" bash -c 'says_key periodic=x turned.rcg && says_key nx=6 turned.rcg'
claim "  a periodic profile along both" bash -c 'rc-pick --set periodic=yes --extrude 6 profile.rcg -o p6.rcg && says_key periodic=yes p6.rcg'
claim "  rows at another distance" bash -c 'rc-pick --extrude 6 --set dy=3um profile.rcg -o p6.rcg && says_key dy=3e-06 p6.rcg'
claim "a free solve of it proposes --periodic=y" warns 'the surface is periodic along y, .*add --periodic=y' rc-solve --load 1mN --estar 100GPa ridges.rcg -o p6.rcg
for n in 1 6; do
    rc-pick --extrude "$n" profile.rcg | rc-solve --quiet --tol 1e-9 --periodic=y --load 1000N/m --estar 100GPa --report "r$n.json" -o p6.rcg
done
rc-solve --quiet --tol 1e-9 --periodic=x --load 1000N/m --estar 100GPa --report rx.json -o p6.rcg turned.rcg
for name in max_pressure approach load_per_metre; do
    near "$(field "$name" r6.json)" "$(field "$name" r1.json)" 1e-7 "$name of six rows is that of one"
    near "$(field "$name" rx.json)" "$(field "$name" r1.json)" 1e-7 "  and of a turned map"
done
claim "a form of an extruded profile varies along x only, and the rows still repeat" bash -c '
    rc-detrend --quiet --poly 3 ridges.rcg -o flat.rcg 2>err && [ ! -s err ] && says_key periodic=y flat.rcg'
claim "  it is that of the profile" bash -c '
    rc-detrend --poly 3 profile.rcg | rc-pick --extrude 6 - -o want.rcg && rc-add --quiet --subtract want.rcg flat.rcg | rc-info --json >d.json'
between 0 "$(field rms d.json)" 1e-15 "    to rounding"
refuses 1 'extrude 6: the map has 40 rows and 48 columns: choose one of them by --crop' "a map is no profile" "rc-pick --extrude 6 y.rcg"
refuses 1 'extrude 6: only heights become a map: choose them by --channel height' "nor a pressure" "rc-pick --extrude 6 p6.rcg"
refuses 1 'extrude 6: a single node is no profile' "nor a node" "rc-pick --crop 3,0,1,1 --extrude 6 profile.rcg"
for bad in 0 -1 1.5 3um ''; do
    refuses 2 "rc-pick: --extrude $bad: a number of rows is expected, at least 1" "--extrude '$bad'" "rc-pick --extrude '$bad' profile.rcg"
done
refuses 1 'more than this machine can address|need at least|out of memory' "more rows than memory has" "rc-pick --extrude 999999999999999 profile.rcg"
