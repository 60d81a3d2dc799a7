# SPDX-License-Identifier: GPL-3.0-or-later
# rc-stress as a command. Tested are frames, report and refusals.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 65 --ny 49 --dx 10um --dy 11um --radius 7.5mm |
    rc-solve --quiet --load 240N --E1 208GPa --nu1 0.3 --E2 208GPa --nu2 0.3 \
        --output pressure -o ball.rcg
rc-synth wave --nx 40 --ny 30 --dx 1um --amplitude 50nm --wavelength 20um |
    rc-solve --quiet --periodic --mean-pressure 100MPa --estar 100GPa --output pressure -o wave.rcg
p0=2205240000 # Hertz

frames() { rc-info "$1" | grep -c 'frame [0-9]* ('; }
number() { grep -o "\"$1\": {[^[]*" "$3" | grep -o "\"$2\": [^,]*" | head -n 1 | cut -d' ' -f2; }
least() { grep -o '"min": {.*' "$3" >least.json && number "$1" "$2" least.json; }
count() { grep -o '"counts": {[^}]*' "$2" | grep -o "\"$1\": [0-9]*" | cut -d' ' -f2; }

# ---- slices ----

claim "slices are computed" bash -c 'rc-stress --depths 0,100um --report r.json ball.rcg -o s.rcg'
claim "each depth has seven frames" test "$(frames s.rcg)" = 14
claim "a frame has its depth and the number of depths" \
    bash -c 'says depth=0.0001$ rc-info s.rcg && says frames=14$ rc-info s.rcg'
# 5e-3: 23 nodes in the radius, solved to 65 x 49 nodes^-0.75 = 2.4e-3
near "$(least szz value r.json)" "-$p0" 5e-3 "szz at the surface is the pressure"
near "$(least szz depth r.json)" 0 "$same" "  at depth 0"
near "$(number mises value r.json)" "$(awk "BEGIN { print 0.6187 * $p0 }")" "$coarse_grid" \
    "Mises at 100 um is what Hertz has there"

claim "--depths auto is accepted" bash -c \
    'rc-stress --depths auto --components mises,tresca,s1,s2,s3 --report a.json ball.rcg -o a.rcg'
near "$(number mises value a.json)" "$(awk "BEGIN { print 0.620041 * $p0 }")" "$coarse_grid" \
    "  finds the largest Mises stress"
near "$(number tresca value a.json)" "$(awk "BEGIN { print 0.620041 * $p0 }")" "$coarse_grid" \
    "  and Tresca's, the same on the axis"
# the depths have steps of about a tenth of this, and the maximum is flat
near "$(number mises depth a.json)" "$(awk 'BEGIN { print 0.480864 * 228e-6 }')" 0.15 "  at its depth"
claim "  the history has auto" says '--depths auto' rc-info a.rcg
claim "  its depths increase from 0" bash -c '
    grep -o "\"depths\": \[0, [^]]*" a.json | tr "," "\n" | sed "1d" >depths.txt &&
    [ "$(wc -l <depths.txt)" -ge 10 ] && sort -g -c -u depths.txt'

rc-stress --depths 100um --mu 0.25 --components mises --report f.json ball.rcg -o f.rcg
near "$(number mises value f.json)" "$(awk "BEGIN { print 0.64759 * $p0 }")" "$coarse_grid" \
    "friction raises the largest Mises stress as in Hamilton's solution"
# a node spacing is 0.16 of the shift
near "$(number mises x f.json)" "$(awk 'BEGIN { print 0.270 * 228e-6 }')" 0.2 \
    "  and moves it ahead"
claim "  the frame has the coefficient of friction" says 'mu=0.25$' rc-info f.rcg

# ---- counts ----

claim "without friction no tangential kernel is evaluated" test "$(count shear_kernels r.json)" = 0
claim "with friction five are evaluated per depth" test "$(count shear_kernels f.json)" = 5
rc-stress --depths 0:50um:9 --components szz --report c.json ball.rcg -o c.rcg
claim "--components szz evaluates one kernel per depth" test "$(count normal_kernels c.json)" = 9
claim "the report lists the omitted ones" grep -q '"sxx": "left out: not in --components"' c.json
claim "the pressure is transformed once" test "$(count source_transforms c.json)" = 1

# ---- memory ----

rc-synth sphere --nx 200 --ny 200 --dx 4um --radius 7.5mm |
    rc-solve --quiet --load 240N --E1 208GPa --nu1 0.3 --E2 208GPa --nu2 0.3 \
        --output pressure -o large.rcg
# sanitizers keep freed memory for a while; this option keeps less
export ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}quarantine_size_mb=1"
rc-stress --depths 0:20um:2 --report few.json large.rcg >/dev/null
rc-stress --depths 0:20um:40 --report many.json large.rcg >/dev/null
# a slice of one component is 2.4 % of the memory: twenty times as many depths must not add two slices
near "$(field peak_memory many.json)" "$(field peak_memory few.json)" 0.05 \
    "memory does not grow with the number of depths"

# ---- sections ----

claim "a section is computed" bash -c \
    'rc-stress --section y=0 --depths 0:200um:21 --components szz,mises --report y.json \
        ball.rcg -o y.rcg'
claim "  each component is a frame" test "$(frames y.rcg)" = 2
claim "  it has a row for each depth" says '65 x 21 nodes' rc-info y.rcg
claim "  its keys give its place" bash -c \
    'rc-info y.rcg >y.txt && grep -q " section=y$" y.txt && grep -q " at=0$" y.txt && grep -q " depths=0,1e-05" y.txt'
claim "  rc-render draws it" bash -c 'rc-render -o y.png y.rcg && test -s y.png'
claim "  no map is transformed" test "$(count field_transforms y.json)" = 0
near "$(number mises value y.json)" "$(awk "BEGIN { print 0.620041 * $p0 }")" "$coarse_grid" \
    "  and the largest Mises stress of the contact is in it"
rc-stress --section x=20um --depths 100um --components szz --report x.json ball.rcg -o x.rcg
rc-stress --depths 100um --components szz --report xx.json ball.rcg -o xx.rcg
claim "the columns of a section across x are the rows of the map" says '49 x 1 nodes' rc-info x.rcg
claim "the history has its place in SI" says '--section x=2e-05' rc-info x.rcg
# x = 2 nodes from the middle column: the map has the same value at this position
column() { # FILE: prints column 34 of one f64 frame of 65 x 49
    perl -0777 -ne 's/^.*?\n\n//s; my @v = unpack "d<*"; print "$_\n" for map { sprintf "%.9g", $v[65 * $_ + 34] } 0 .. 48' "$1"
}
row() { # FILE: prints the values of one f64 frame of 49 x 1
    perl -0777 -ne 's/^.*?\n\n//s; my @v = unpack "d<*"; print "$_\n" for map { sprintf "%.9g", $_ } @v[0 .. 48]' "$1"
}
column xx.rcg >column.txt
row x.rcg >row.txt
claim "it has the values of the map there" diff column.txt row.txt
claim "  49 values are compared" test "$(wc -l <row.txt)" = 49

# ---- a rough ball: the paper's Fig. 6 ----

# the map has 121 x 103 nodes as in section 4.2 of the paper. The real contact is about 0.55 of Hertz's, whose
# largest Mises stress is 1.37 GPa
ball="--radius 1.88mm --load 15.06N --E1 210GPa --nu1 0.28 --E2 210GPa --nu2 0.28 --hardness 6GPa"
rc-synth selfaffine --nx 121 --ny 103 --dx 1.1um --dy 1.29um --hurst 0.8 --rms-height 130nm \
    --rolloff 30um --short-cut 5um --seed 7 -o roughness.rcg
rc-solve --quiet $ball --output pressure --report rough.json roughness.rcg -o rough.rcg
rc-synth sphere --nx 121 --ny 103 --dx 1.1um --dy 1.29um --radius 1000000 -o flat.rcg
rc-solve --quiet $ball --output pressure flat.rcg -o smooth.rcg
# the area depends on the seed of the surface
near "$(field contact_area rough.json)" "$(awk 'BEGIN { print 0.55 * 3.14159 * 57.1e-6 ^ 2 }')" 0.05 \
    "the rough contact is that of the paper's Fig. 5"
for surface in rough smooth; do
    rc-stress --depths 0:80um:41 --components mises --report $surface.json $surface.rcg -o m.rcg
done
between 0 "$(number mises depth rough.json)" 4e-6 "Mises is largest at or near the surface"
between 2.06e9 "$(number mises value rough.json)" 6e9 "  half as large again as Hertz's, and below the hardness"
by_depth() { grep -o '"by_depth": \[[^]]*' "$2" | sed 's/.*\[//' | tr ',' '\n' | sed -n "$1p"; }
# the roughness changes the distribution of the load over the contact, which still has a small effect at 1.4
# radii
near "$(by_depth 41 rough.json)" "$(by_depth 41 smooth.json)" 0.06 \
    "deep below the field is that of the smooth ball"
for axis in x y; do
    claim "the plane $axis = 0 is drawn" bash -c \
        "rc-stress --depths 0:80um:81 --section $axis=0 --components mises rough.rcg |
         rc-render -o fig6$axis.png && says PNG head -c 4 fig6$axis.png"
done

# ---- boundaries ----

claim "the stresses of a periodic pressure are periodic" bash -c \
    'rc-stress --nu 0.3 --depths 0,5um,40um --report p.json wave.rcg -o p.rcg &&
     says boundary=periodic rc-info p.rcg'
near "$(rc-info --json p.rcg | grep '"szz"' | tail -n 1 | grep -o '"mean": [^,]*' | cut -d' ' -f2)" \
    -1e8 "$summed" "  that carry the load at every depth"
claim "  its automatic depths differ" bash -c 'rc-stress --nu 0.3 --depths auto wave.rcg -o p.rcg'
refuses 1 'its boundary is free, which contradicts --periodic' "--periodic against the stream" \
    "rc-stress --periodic --depths 0 ball.rcg"
refuses 1 'its boundary is periodic, where only fft sums: leave out --kernel mlms' "mlms on a periodic map" \
    "rc-stress --kernel mlms --nu 0.3 --depths 0 wave.rcg"

# A roller of 10 mm under 1e5 N/m: Hertz's line contact, p0 = sqrt(P' E*/(pi R)), a = 2 P'/(pi p0).
line0=602389633 a=105.682e-6
for axis in x y; do
    rc-synth cylinder --radius 10mm --nx 128 --ny 128 --dx 2um --direction $([ $axis = x ] && echo 0 || echo 90) |
        rc-pick --crop $([ $axis = x ] && echo 0,0,6,128 || echo 0,0,128,6) |
        rc-solve --quiet --periodic=$axis --load 1e5N/m --estar 114GPa --output pressure -o roller.rcg
    rc-stress --nu 0.3 --depths 40um:100um:61 --report $axis.json roller.rcg -o plane.rcg
    # 53 nodes in the half-width, depths 1 um apart
    near "$(number mises value $axis.json)" "$(awk "BEGIN { print $line0 / 1.7937 }")" 1e-3 "periodic-$axis: a roller first yields at p0 = 1.79 Y"
    near "$(number mises depth $axis.json)" "$(awk "BEGIN { print 0.704 * $a }")" 0.02 "  at its depth"
    shear=$([ $axis = x ] && echo syz || echo sxz)
    near "$(number $shear value $axis.json)" "$(awk "BEGIN { print 0.25 * $line0 }")" 1e-3 "  the largest orthogonal shear stress is p0/4"
    near "$(number $shear depth $axis.json)" "$(awk "BEGIN { print 0.5 * $a }")" 0.02 "  at half of the half-width"
    claim "  the frames have the boundary" says "boundary=periodic-$axis" rc-info plane.rcg
    rc-stress --nu 0.3 --depths 40um:100um:61 --section $axis=0 --components mises --report section.json roller.rcg -o section.rcg
    near "$(number mises value section.json)" "$(number mises value $axis.json)" "$summed" "  a section across the roller has the same"
done
near "$(number mises value x.json)" "$(number mises value y.json)" "$six_digits" "a roller that is turned has the same stresses"
claim "the plan says which axis is padded" says 'padding *on: along x only, the map repeats along y' \
    rc-stress --dry-run --nu 0.3 --depths 0 roller.rcg
refuses 1 'its boundary is periodic-y, where only fft sums: leave out --kernel direct' "direct sums of lines" \
    "rc-stress --kernel direct --nu 0.3 --depths 0 roller.rcg"
refuses 1 'its boundary is periodic-y, which contradicts --periodic' "another axis than the stream's" \
    "rc-stress --periodic=x --nu 0.3 --depths 0 roller.rcg"

# ---- engines ----

rc-stress --kernel mlms --tol 1e-4 --depths 100um --mu 0.25 --report m.json ball.rcg -o m.rcg
# requested: 1e-4 of the largest pressure in each component, which is at most seven times as much in Mises'
# stress
near "$(number mises value m.json)" "$(number mises value f.json)" 1e-3 "--kernel mlms agrees"
claim "  it takes eleven sums" test "$(count engine_sums m.json)" = 11

# ---- errors of the loads ----

rc-synth selfaffine --nx 48 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 20um --short-cut 6um --seed 7 -o rough.rcg
components=sxx,syy,szz,sxy,sxz,syz,mises,tresca,s1,s2,s3
stressed() { rc-stress --quiet --depths "$2" --components $components --report "$1.json" "$1.rcg" -o "$1-s.rcg"; }
for tol in 1e-8 1e-1; do
    rc-solve --quiet --mean-pressure 20MPa --E1 2GPa --nu1 0.3 --E2 rigid --tol $tol rough.rcg -o p$tol.rcg
    rc-slip --quiet --mu 0.3 --tangential 1mN $([ $tol = 1e-1 ] || echo --increments 32) --tol ${tol/8/5} p1e-8.rcg | rc-pick --quiet --case 2 -o q$tol.rcg
    stressed p$tol 2um
    stressed q$tol 0 # where szz is the pressure, which the tractions of dissimilar bodies change
done
# told LOAD MOST: each component's sum of |difference| over sum of |stress| is at most the estimate, and this is at most MOST times as large
told() {
    local c
    for c in ${components//,/ }; do
        paste <(rc-pick --channel $c "$1"1e-1-s.rcg | rc-export --format csv | grep -v '^[#"]' | tr ',' '\n') \
            <(rc-pick --channel $c "$1"1e-8-s.rcg | rc-export --format csv | grep -v '^[#"]' | tr ',' '\n') |
            awk -v told="$(field ${c}_error_estimate "$1"1e-1.json)" -v c=$c -v most="$2" '{ d += sqrt(($1 - $2) ^ 2); s += sqrt($2 ^ 2) }
                END { print c, told, d / s; exit !(NR == 2304 && d / s > 1e-5 && told >= d / s && told < most * d / s) }' || return
    done
}
claim "the estimates of all components contain the error of the pressure" told p 50
claim "  and of the tractions, whose increments have an estimate that is safe" told q 300
tells() { [ "$(rc-stress --quiet --depths 2um --report - -o x.rcg "$3" | grep -o "\"$1\": [^,]*" | head -n 1 | cut -d ' ' -f 2)" = "$2" ]; }
rc-pick --channel pressure p1e-1.rcg | rc-pick --set pressure.error= --set converged= -o imported.rcg
claim "a pressure without a solver is taken as exact" tells pressure_error_estimate 0 imported.rcg
claim "  one whose solver tells no error is not" bash -c "rc-pick --set pressure.error= p1e-1.rcg -o silent.rcg"
for name in pressure mises; do
    claim "  its ${name/mises/Mises stress} has an unknown error" tells ${name}_error_estimate null silent.rcg
done
rc-pick --quiet --crop 0,0,24,48 p1e-1.rcg -o part.rcg
rc-pick --quiet --resample 24x24 p1e-1.rcg -o means.rcg
rc-pick --mirror x p1e-1.rcg | rc-pick --rotate 90 -o turned.rcg
claim "  as has a part of a map" tells mises_error_estimate null part.rcg
claim "  and one on another grid" tells mises_error_estimate null means.rcg
claim "a turned map keeps the error" tells pressure_error_estimate "$(field pressure_error_estimate p1e-1.json)" turned.rcg

# ---- dry run ----

claim "--dry-run prints the plan" bash -c \
    'rc-stress --dry-run --depths auto --components szz ball.rcg >dry.txt &&
     grep -q "friction *left out: mu = 0" dry.txt && grep -q "mises *left out" dry.txt &&
     grep -Eq "about [0-9]+ MiB, [0-9.e-]+ s with" dry.txt'

# ---- refusals ----

refuses 2 '--section z=0: it must be x=PLACE or y=PLACE' "a section of nothing" \
    "rc-stress --section z=0 --depths 0 ball.rcg"
refuses 2 "--section y=5N: unknown unit 'N': m is expected" "a section in newtons" "rc-stress --section y=5N --depths 0 ball.rcg"
refuses 1 'section y = 0.001 m: the map ends at 0.0002695 m' "a section beyond the map" \
    "rc-stress --section y=1mm --depths 0 ball.rcg"
refuses 1 'section y = 0.001 m: the map ends at 0.0002695 m' "  which a plan refuses too" \
    "rc-stress --dry-run --section y=1mm --depths 0 ball.rcg"
refuses 2 '--depths: the depths of a section must increase' "depths of a section that go up and down" \
    "rc-stress --section y=0 --depths 0,5um,2um ball.rcg"
refuses 2 '--section is summed by fft: leave out --kernel mlms' "a section by mlms" \
    "rc-stress --section y=0 --kernel mlms --depths 0 ball.rcg"
refuses 2 "'foo' is none of sxx" "a component that is none" "rc-stress --depths 0 --components sxx,foo ball.rcg"
refuses 2 'give --depths' "no depths" "rc-stress ball.rcg"
refuses 2 '--depths -1e-06 m: it must be at least 0' "a depth above the surface" "rc-stress --depths -1um ball.rcg"
refuses 2 '--nu 0.6: it must be above -1 and at most 0.5' "a Poisson's ratio of 0.6" "rc-stress --nu 0.6 --depths 0 ball.rcg"
refuses 2 '--mu 11: it must be at least -10 and at most 10' "a friction of 11" "rc-stress --mu 11 --depths 0 ball.rcg"
refuses 1 '65 x 49 nodes need about .*, --memory allows' "more memory than is allowed" "rc-stress --memory 100k --depths 0 ball.rcg"
refuses 1 '--report nowhere/r.json: No such file' "a report that cannot be written, before the work" \
    "rc-stress --report nowhere/r.json --depths 0 ball.rcg"

# ---- friction on a body that yielded before without friction ----

rc-synth sphere --nx 16 --dx 20um --radius 10mm | rc-solve --quiet --load 20N --E1 210GPa --nu1 0.3 --E2 rigid --yield 500MPa,5GPa --increments 2 --slabs 6 --output pressure,strain -o dent.rcg
claim "friction on a yielded body causes a warning" warns "friction was not part of that solution.* yield stress, 500 MPa" rc-stress --mu 0.3 --depths 10um dent.rcg -o x.rcg
claim "  without friction there is none" bash -c 'rc-stress --depths 10um dent.rcg -o x.rcg 2>err; ! grep -q friction err'
