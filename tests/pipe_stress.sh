# rc-stress as a command: what it writes, what its report says, what it refuses.
. "$(dirname "$0")/pipe.sh"

rc-synth sphere --nx 65 --ny 49 --dx 10um --dy 11um --radius 7.5mm |
    rc-solve --quiet --load 240N --E1 208GPa --nu1 0.3 --E2 208GPa --nu2 0.3 \
        --output pressure -o ball.rcg
rc-synth wave --nx 40 --ny 30 --dx 1um --amplitude 50nm --wavelength 20um |
    rc-solve --quiet --periodic --mean-pressure 100MPa --estar 100GPa --output pressure -o wave.rcg
p0=2205240000 # Hertz

frames() { rc-info "$1" | grep -c 'frame [0-9]* ('; }
number() { grep -o "\"$1\": {[^[]*" "$3" | grep -o "\"$2\": [^,]*" | head -n 1 | cut -d' ' -f2; }
count() { grep -o '"counts": {[^}]*' "$2" | grep -o "\"$1\": [0-9]*" | cut -d' ' -f2; }

# ---- slices ----

claim "slices work" bash -c 'rc-stress --depths 0,100um --report r.json ball.rcg -o s.rcg'
claim "seven frames a depth" test "$(frames s.rcg)" = 14
claim "a frame knows its depth and how many there are" \
    bash -c 'rc-info s.rcg | grep -q depth=0.0001 && rc-info s.rcg | grep -q frames=14'
near "$(number szz value r.json)" "-$p0" 5e-3 "szz at the surface is the pressure"
near "$(number szz depth r.json)" 0 0 "  at depth 0"
near "$(number mises value r.json)" "$(awk "BEGIN { print 0.6187 * $p0 }")" 1e-2 \
    "Mises at 100 um is what Hertz has there"

claim "--depths auto" bash -c \
    'rc-stress --depths auto --components mises,tresca,s1,s2,s3 --report a.json ball.rcg -o a.rcg'
near "$(number mises value a.json)" "$(awk "BEGIN { print 0.620041 * $p0 }")" 1e-2 \
    "  finds the largest Mises stress"
near "$(number tresca value a.json)" "$(awk "BEGIN { print 0.620041 * $p0 }")" 1e-2 \
    "  and Tresca's, the same on the axis"
near "$(number mises depth a.json)" "$(awk 'BEGIN { print 0.480864 * 228e-6 }')" 0.15 "  at its depth"
claim "  and history says auto" bash -c 'rc-info a.rcg | grep -q -- "--depths auto"'
claim "  with depths that rise, first 0" bash -c \
    'grep -o "\"depths\": \[0, [^]]*" a.json | tr "," "\n" | sed "1d" | sort -g -c'

rc-stress --depths 100um --mu 0.25 --components mises --report f.json ball.rcg -o f.rcg
near "$(number mises value f.json)" "$(awk "BEGIN { print 0.64759 * $p0 }")" 1e-2 \
    "friction raises the largest Mises stress as in Hamilton's solution"
near "$(number mises x f.json)" "$(awk 'BEGIN { print 0.270 * 228e-6 }')" 0.2 \
    "  and moves it ahead"
claim "  the frame says so" bash -c 'rc-info f.rcg | grep -q mu=0.25'

# ---- counts ----

claim "without friction no tangential kernel is evaluated" test "$(count shear_kernels r.json)" = 0
claim "with it five a depth are" test "$(count shear_kernels f.json)" = 5
rc-stress --depths 0:50um:9 --components szz --report c.json ball.rcg -o c.rcg
claim "--components szz evaluates one kernel a depth" test "$(count normal_kernels c.json)" = 9
claim "and says what it left out" grep -q '"sxx": "left out: not in --components"' c.json
claim "the pressure is transformed once" test "$(count source_transforms c.json)" = 1

# ---- memory ----

rc-synth sphere --nx 200 --ny 200 --dx 4um --radius 7.5mm |
    rc-solve --quiet --load 240N --E1 208GPa --nu1 0.3 --E2 208GPa --nu2 0.3 \
        --output pressure -o large.rcg
# with sanitizers, what is freed stays for a while: not for long
export ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}quarantine_size_mb=1"
rc-stress --depths 0:20um:2 --report few.json large.rcg >/dev/null
rc-stress --depths 0:20um:40 --report many.json large.rcg >/dev/null
near "$(field peak_memory many.json)" "$(field peak_memory few.json)" 0.05 \
    "memory does not grow with the number of depths"

# ---- sections ----

claim "a section" bash -c \
    'rc-stress --section y=0 --depths 0:200um:21 --components szz,mises --report y.json \
        ball.rcg -o y.rcg'
claim "  is one frame a component" test "$(frames y.rcg)" = 2
claim "  of as many rows as depths" bash -c 'rc-info y.rcg | grep -q "65 x 21 nodes"'
claim "  that says where it is" bash -c \
    'rc-info y.rcg >y.txt; grep -q section=y y.txt && grep -q at=0 y.txt && grep -q depths=0,1e-05 y.txt'
claim "  and can be drawn" bash -c 'rc-render -o y.png y.rcg && test -s y.png'
claim "  without a map's transforms" test "$(count field_transforms y.json)" = 0
near "$(number mises value y.json)" "$(awk "BEGIN { print 0.620041 * $p0 }")" 1e-2 \
    "  and the largest Mises stress of the contact is in it"
rc-stress --section x=20um --depths 100um --components szz --report x.json ball.rcg -o x.rcg
rc-stress --depths 100um --components szz --report xx.json ball.rcg -o xx.rcg
claim "a section across x has the rows of the map as columns" bash -c 'rc-info x.rcg | grep -q "49 x 1 nodes"'
claim "history has its place in SI" bash -c 'rc-info x.rcg | grep -q -- "--section x=2e-05"'

# ---- a rough ball: the paper's Fig. 6 ----

# 121 x 103 nodes of its section 4.2, real contact about 0.55 of Hertz's, where Mises is 1.37 GPa at most
ball="--radius 1.88mm --load 15.06N --E1 210GPa --nu1 0.28 --E2 210GPa --nu2 0.28 --hardness 6GPa"
rc-synth selfaffine --nx 121 --ny 103 --dx 1.1um --dy 1.29um --hurst 0.8 --rms-height 130nm \
    --rolloff 30um --short-cut 5um --seed 7 -o roughness.rcg
rc-solve --quiet $ball --output pressure --report rough.json roughness.rcg -o rough.rcg
rc-synth sphere --nx 121 --ny 103 --dx 1.1um --dy 1.29um --radius 1000000 -o flat.rcg
rc-solve --quiet $ball --output pressure flat.rcg -o smooth.rcg
near "$(field contact_area rough.json)" "$(awk 'BEGIN { print 0.55 * 3.14159 * 57.1e-6 ^ 2 }')" 0.05 \
    "the rough contact is that of the paper's Fig. 5"
for surface in rough smooth; do
    rc-stress --depths 0:80um:41 --components mises --report $surface.json $surface.rcg -o m.rcg
done
claim "Mises is largest at or near the surface, above Hertz's" awk \
    -v z="$(number mises depth rough.json)" -v m="$(number mises value rough.json)" \
    'BEGIN { exit !(z <= 4e-6 && m > 1.5 * 1.37e9) }'
by_depth() { grep -o '"by_depth": \[[^]]*' "$2" | sed 's/.*\[//' | tr ',' '\n' | sed -n "$1p"; }
near "$(by_depth 41 rough.json)" "$(by_depth 41 smooth.json)" 0.06 \
    "deep below the field is that of the smooth ball"
for axis in x y; do
    claim "its plane $axis = 0 is drawn" bash -c \
        "rc-stress --depths 0:80um:81 --section $axis=0 --components mises rough.rcg |
         rc-render -o fig6$axis.png && test -s fig6$axis.png"
done

# ---- boundaries ----

claim "a periodic pressure has periodic stresses" bash -c \
    'rc-stress --nu 0.3 --depths 0,5um,40um --report p.json wave.rcg -o p.rcg &&
     rc-info p.rcg | grep -q boundary=periodic'
near "$(rc-info --json p.rcg | grep '"szz"' | tail -n 1 | grep -o '"mean": [^,]*' | cut -d' ' -f2)" \
    -1e8 1e-12 "  that carry the load at every depth"
claim "  at depths of its own" bash -c 'rc-stress --nu 0.3 --depths auto wave.rcg -o p.rcg'
refuses 1 'contradicts' "--periodic against the stream" \
    "rc-stress --periodic --depths 0 ball.rcg"
refuses 1 'leave out --kernel mlms' "mlms on a periodic map" \
    "rc-stress --kernel mlms --nu 0.3 --depths 0 wave.rcg"

# ---- engines ----

rc-stress --kernel mlms --tol 1e-4 --depths 100um --mu 0.25 --report m.json ball.rcg -o m.rcg
near "$(number mises value m.json)" "$(number mises value f.json)" 1e-3 "--kernel mlms agrees"
claim "  with eleven sums" test "$(count engine_sums m.json)" = 11

# ---- dry run ----

claim "--dry-run says what would be done" bash -c \
    'rc-stress --dry-run --depths auto --components szz ball.rcg >dry.txt &&
     grep -q "friction *left out: mu = 0" dry.txt && grep -q "mises *left out" dry.txt &&
     grep -q "memory" dry.txt && grep -q "time *about" dry.txt'

# ---- refusals ----

refuses 2 'must be x=PLACE or y=PLACE' "a section of nothing" \
    "rc-stress --section z=0 --depths 0 ball.rcg"
refuses 2 "section y=5N" "a section in newtons" "rc-stress --section y=5N --depths 0 ball.rcg"
refuses 1 'the map ends at' "a section beyond the map" \
    "rc-stress --section y=1mm --depths 0 ball.rcg"
refuses 2 'must rise' "depths of a section that go up and down" \
    "rc-stress --section y=0 --depths 0,5um,2um ball.rcg"
refuses 2 'leave out --kernel' "a section by mlms" \
    "rc-stress --section y=0 --kernel mlms --depths 0 ball.rcg"
refuses 2 'none of' "a component that is none" "rc-stress --depths 0 --components sxx,foo ball.rcg"
refuses 2 '--depths' "no depths" "rc-stress ball.rcg"
refuses 2 'at least 0' "a depth above the surface" "rc-stress --depths -1um ball.rcg"
refuses 2 'at most 0.5' "a Poisson's ratio of 0.6" "rc-stress --nu 0.6 --depths 0 ball.rcg"
refuses 2 'at most 10' "a friction of 11" "rc-stress --mu 11 --depths 0 ball.rcg"
refuses 1 'memory' "more memory than is allowed" "rc-stress --memory 100k --depths 0 ball.rcg"
refuses 1 '--report' "a report that cannot be written, before the work" \
    "rc-stress --report nowhere/r.json --depths 0 ball.rcg"

finish
