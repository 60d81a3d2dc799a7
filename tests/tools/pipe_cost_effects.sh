# SPDX-License-Identifier: GPL-3.0-or-later
# rc-cost for each effect: its errors are those of the frames and figures of the programs with the same words,
# computed here independently, also over several cases, programs and grids. A trial is repeated to the bit by its
# command. Estimates below the true error are named, and the reference is judged by a tighter one.
. "$(dirname "$0")/../pipe.sh"

export RC_THREADS=1
steel="--E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3"
rc-synth sphere --nx 24 --dx 13um --radius 7.5mm -o ball.rcg
rc-solve --load 10N $steel --quiet -o contact.rcg ball.rcg
rc-synth selfaffine --nx 24 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 20um --short-cut 6um --seed 5 -o rough.rcg

# value FILE KEY=VALUE NAME: prints a figure of the trial with this value from the report of rc-cost.
value() {
    perl -MJSON::PP -e '
        my ($file, $pick, $name) = @ARGV;
        my ($key, $value) = split /=/, $pick, 2;
        open my $f, "<", $file or die;
        while (<$f>) {
            my $r = decode_json($_);
            if ($r->{$key} eq $value) { my $v = $r->{$name}; printf "%s\n", ref $v ? ($v ? 1 : 0) : $v // "null"; exit }
        }
        die "$file: no trial $pick\n"' "$@"
}
# error CHANNEL TRIAL.rcg REFERENCE.rcg: prints sum |a - reference| / sum |reference| over all its frames.
error() {
    perl -e '
        my ($channel, @file) = @ARGV;
        my @v;
        for my $n (0, 1) {
            open my $f, "<:raw", $file[$n] or die;
            while (defined(my $first = <$f>)) {
                my %key;
                last if $first =~ /^RCGEND/;
                while (<$f> =~ /^([^=]*)=(.*)$/) { $key{$1} = $2 }
                my ($size, $code) = $key{type} eq "f64" ? (8, "d<*") : (4, "f<*");
                read $f, my $bytes, $size * $key{nx} * $key{ny} or die;
                <$f> =~ /^crc32/ or die;
                push @{$v[$n]}, unpack $code, $bytes if $key{channel} eq $channel;
            }
        }
        my ($off, $all) = (0, 0);
        die "no frames\n" if !@{$v[0]} || @{$v[0]} != @{$v[1]};
        for (0 .. $#{$v[0]}) { $off += abs $v[0][$_] - $v[1][$_]; $all += abs $v[1][$_] }
        printf "%.12g\n", $off / $all' "$@"
}
study() { # NAME INPUT 'OPTIONS' COMMAND...
    local name=$1 input=$2 options=$3
    shift 3
    # shellcheck disable=SC2086
    claim "$name: a study" rc-cost --quiet $options --report "$name.json" -o "$name.txt" "$input" -- "$@"
}
# again NAME KEY=VALUE CHANNEL: the command of the trial and that of the reference give the frames of its error.
again() {
    sh -c "$(value "$1.json" "$2" command) --quiet" >one.rcg
    sh -c "$(value "$1.json" what=reference command) --quiet" >two.rcg
    near "$(value "$1.json" "$2" error)" "$(error "$3" one.rcg two.rcg)" 1e-8 "$1: the error of $2 is that of the frames '$3' of its command"
}

# ---- each effect: the frame that ranks, and its error ----

study yield rough.rcg "--vary increments=8,16 --vary slabs=3,5" rc-solve --periodic --mean-pressure 0.5GPa --E1 210GPa --nu1 0.3 --E2 rigid --yield 2GPa,5GPa
again yield increments=8 pressure
claim "  the reference has twice the increments and slabs beyond the list" grep -q '^# reference: increments 32, slabs 8,' yield.txt
claim "  the parts of an estimate do not replace it: few slabs that were given have none" \
    bash -c "grep -E '^ *16 +3 ' yield.txt | grep -q 'unjudged'"
claim "  the change along each list is known" bash -c 'grep -Eq "^ +16 +8 " yield.txt && grep -Eq "^ +32 +5 " yield.txt'
study adhesion rough.rcg "--tol 1e-1,1e-3" rc-solve --periodic --mean-pressure 1MPa --estar 100MPa --adhesion 1J/m2,exponential,200nm
again adhesion tol=0.1 pressure
study creep ball.rcg "--vary increments=8,16" rc-solve --load 20mN --relaxation 1MPa,9MPa:1ms --nu1 0.5 --E2 rigid --time 1ms
again creep increments=8 pressure
study rubber rough.rcg "--tol 1e-1,1e-2" rc-solve --periodic --mean-pressure 0.1MPa --relaxation 1MPa,9MPa:1ms --nu1 0.5 --E2 rigid --speed 1mm/s
again rubber tol=0.1 pressure
study slip contact.rcg "--tol 1e-1,1e-2" rc-slip --mu 0.3 --tangential 1.5N
again slip tol=0.1 traction-x
claim "  the slip is that of all increments" bash -c 'grep -q "\"largest_slip_total_error\"" slip.json && ! grep -q "\"largest_slip_error\"" slip.json'
study rolling contact.rcg "--tol 1e-1,1e-2" rc-slip --mu 0.3 --steady --creep 2e-3,0
again rolling tol=0.1 traction-x
study wear contact.rcg "--tol 1e-1,1e-2" rc-wear --coefficient 1e-5mm3/Nm --distance 10mm
again wear tol=0.1 wear
study heat contact.rcg "--tol 1e-1,1e-3" rc-heat --mu 0.3 --speed 1 --conductivity 45,45 --diffusivity 1e-5,1e-5
again heat tol=0.1 temperature-1
rc-synth sphere --nx 64 --dx 5um --radius 7.5mm | rc-solve --load 10N $steel --quiet -o larger.rcg
study stress larger.rcg "--tol 1e-1,1e-3" rc-stress --depths 10um:100um:4 --components sxx,szz
again stress tol=0.1 sxx
fatigue="rc-fatigue --bending-limit 600MPa --torsion-limit 400MPa --pass x --depths 20um:100um:3"
# shellcheck disable=SC2086
study fatigue contact.rcg "--tol 1e-1,1e-3" $fatigue
again fatigue tol=0.1 crossland
rc-synth sphere --nx 48 --dx 13um --radius 20mm -o wide.rcg
study travel ball.rcg "--tol 1e-1,1e-3" rc-solve --load 5N $steel --travel=-26um,0,26um --counter wide.rcg --window 20x20
again travel tol=0.1 pressure
study loads ball.rcg "--tol 1e-1,1e-3" rc-solve --load 2N,5N,10N $steel
again loads tol=0.1 pressure
claim "  loads and positions are cases" bash -c 'grep -q "^# .* 3 cases" loads.txt && grep -q "^# .* 3 cases" travel.txt'
study two "ball.rcg" "--tol 1e-1,1e-3" rc-solve --load 10N $steel '|' rc-slip --mu 0.3 --steady --creep 2e-3,0 '|' rc-fatigue \
    --bending-limit 600MPa --torsion-limit 400MPa --pass x --depths 20um:100um:3
again two tol=0.1 crossland
claim "  each program has the tolerance" bash -c '[ "$(grep -o -- "--tol 1e-05" two.txt | wc -l)" = 3 ]'

# Both programs report a largest pressure: before wear and after it.
study pair ball.rcg "--tol 1e-1,1e-3" rc-solve --load 10N $steel '|' rc-wear --coefficient 1e-5mm3/Nm --distance 10mm
largest() { # KEY=VALUE PROGRAM: the largest pressure that this program of the pipe reports
    bash -c "$(value pair.json "$1" command | sed "s/rc-solve/& --report one.json/; s/rc-wear/& --report two.json/") --quiet" >/dev/null &&
        field max_pressure "$([ "$2" = 1 ] && echo one.json || echo two.json)"
}
for program in 1 2; do
    near "$(value pair.json tol=0.1 "$([ $program = 1 ] && echo 1.)max_pressure_error")" \
        "$(awk -v a="$(largest tol=0.1 $program)" -v b="$(largest what=reference $program)" 'BEGIN { printf "%.12g", a / b - 1 }')" 1e-6 \
        "a figure of two programs: the error of that of program $program"
done
claim "  the table has the number of the program" bash -c 'grep -q "^ *tol .* 2[.]max_pressure " pair.txt && grep -q "^# reference: .*: 2[.]max_pressure " pair.txt'
for name in 1.max_pressure 2.max_pressure max_pressure; do
    claim "  --of $name" says "^# error: of ${name/#max/2.max}, relative" rc-cost --quiet --tol 1e-1 --of $name ball.rcg -- rc-solve --load 10N $steel '|' \
        rc-wear --coefficient 1e-5mm3/Nm --distance 10mm
done

# ---- figures and grids ----

study leak rough.rcg "--grid 2,1 --tol 1e-2 --of flow_conductance" rc-solve --periodic --mean-pressure 5MPa --estar 1GPa '|' rc-leak
flow() {
    bash -c "$(value leak.json "$1" command) --quiet --report flow.json" >/dev/null && field flow_conductance flow.json
}
near "$(value leak.json grid=2 flow_conductance_error)" "$(awk -v a="$(flow grid=2)" -v b="$(flow what=reference)" 'BEGIN { print a / b - 1 }')" 1e-4 \
    "leak: the error of the conductance of a coarser grid is that of its pipe"
claim "  that pipe begins with rc-pick" bash -c "value() { $(declare -f value | tail -n +3 | sed '$d'); }; value leak.json grid=2 command | grep -q '^rc-pick --resample 12x12 rough.rcg | rc-solve'"
# A gap of one height everywhere: parallel plates conduct h^3 / 12 on any grid.
plates() {
    for _ in {1..32}; do echo 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1; done |
        rc-import --quiet --dx 1um --z-unit um - | rc-pick --set channel=gap -o gap.rcg
    rc-cost --quiet --grid 4,2,1 --of flow_conductance --report plates.json -o plates.txt gap.rcg -- rc-leak
}
claim "parallel plates: a study" plates
between 0 "$(value plates.json grid=4 error)" "$rounding" "  the conductance is that of all grids"
claim "  the figures of the reference are stated" grep -Eq 'flow_conductance 1(\.0*|0*)?e-18 m3' plates.txt
claim "a frame of whole numbers has the share of the nodes that differ" bash -c '
    rc-cost --quiet --grid 2,1 --of contact rough.rcg -- rc-solve --periodic --mean-pressure 0.5GPa --estar 114GPa --output pressure,contact |
        grep -q "^# error: of contact, the share of the nodes that differ"'

# ---- a trial is repeated by its command to the bit ----

bits() {
    rc-solve --load 10N $steel --quiet --tol 1e-3 -o p.rcg ball.rcg && rc-stress --depths 10um:100um:4 --tol 1e-3 -o s.rcg p.rcg &&
        rc-cost --quiet --tol 1e-3 --report bits.json -o /dev/null ball.rcg -- rc-solve --load 10N $steel '|' rc-stress --depths 10um:100um:4 &&
        sh -c "$(value bits.json tol=0.001 command)" >pipe.rcg && cmp pipe.rcg s.rcg
}
claim "the command of a trial gives the bytes of its programs through files" bits

# ---- the reference against tighter ones: its bound holds, and so do those of the trials ----

# holds NAME KEY REFERENCE: the same trials, and the value of the reference, against REFERENCE.
holds() {
    local name=$1 key=$2 tight=$3 list=$4
    shift 4
    rc-cost --quiet --vary "$key=$list" --reference "$key=$tight" --report tight.json -o /dev/null "$@" || return
    perl -MJSON::PP -e '
        my ($name, $key) = @ARGV;
        my @own = map { open my $f, "<", $_ or die; [map { decode_json($_) } <$f>] } "$name.json", "tight.json";
        my %true = map { sprintf("%.6g", $_->{$key}) => $_->{error} } @{$own[1]};
        for my $r (@{$own[0]}) {
            my $e = $true{sprintf "%.6g", $r->{$key}} // die "no $key $r->{$key}\n";
            print STDERR "$key $r->{$key}: bound $r->{bound}, true error $e\n";
            exit 1 if $r->{bound} < $e;
        }' "$name" "$key"
}
claim "slip: bounds hold" holds rolling tol 1e-6 1e-1,1e-2,1e-3 contact.rcg -- rc-slip --mu 0.3 --steady --creep 2e-3,0
claim "heat: bounds hold" holds heat tol 1e-9 1e-1,1e-3,1e-5 contact.rcg -- rc-heat --mu 0.3 --speed 1 --conductivity 45,45 --diffusivity 1e-5,1e-5
claim "adhesion: bounds hold" holds adhesion tol 1e-8 1e-1,1e-3,1e-5 rough.rcg -- rc-solve --periodic --mean-pressure 1MPa --estar 100MPa --adhesion 1J/m2,exponential,200nm
claim "creep: bounds hold" holds creep increments 256 8,16,32 ball.rcg -- rc-solve --load 20mN --relaxation 1MPa,9MPa:1ms --nu1 0.5 --E2 rigid --time 1ms
claim "stress: bounds hold" holds stress tol 1e-8 1e-1,1e-3,1e-5 larger.rcg -- rc-stress --depths 10um:100um:4 --components sxx,szz

# ---- estimates that do not hold, and solutions that stop short ----

# rc-solve with estimates that are a thousand times too small.
mkdir flattering && ln "$RC_BIN/rc-cost" flattering/ 2>/dev/null || cp "$RC_BIN/rc-cost" flattering/
cat >flattering/rc-solve <<'SCRIPT'
#!/bin/bash
{ "$RC_BIN/rc-solve" "$@" 2>&1 >&3 | perl -pe 's/("pressure_error_estimate": )([0-9.e-]+)/$1 . $2 \/ 1000/e' >&2; } 3>&1
exit "${PIPESTATUS[0]}"
SCRIPT
chmod +x flattering/rc-solve
export RC_BIN
claim "an estimate below 0.9 of the error is optimistic" bash -c "
    flattering/rc-cost --tol 1e-2,1e-4 ball.rcg -- rc-solve --load 10N $steel >flat.txt 2>flat.err && [ \$(grep -c optimistic flat.txt) = 2 ]"
claim "  a warning says so" grep -q 'the estimate for pressure, .* is below the true error .*; so are others' flat.err
claim "  such a trial is not proposed" bash -c "
    flattering/rc-cost --tol 1e-2,1e-4 --error 0.1 --quiet ball.rcg -- rc-solve --load 10N $steel | grep -q -- '--tol 1e-06'"
claim "true estimates are not" lacks optimistic loads.txt
claim "stress: each trial has an estimate, and none is optimistic" lacks 'optimistic|unjudged' stress.txt
claim "a command without an estimate is unjudged" grep -q unjudged fatigue.txt
# shellcheck disable=SC2086
claim "  and proposed with these words" warns 'without an estimate of its own' rc-cost --tol 1e-1 --error 0.5 larger.rcg -- $fatigue
# One step of a slip path has an error of its increments that no tolerance removes.
claim "a program that stops short is marked" bash -c '
    rc-cost --quiet --tol 1e-1,1e-4 contact.rcg -- rc-slip --mu 0.3 --tangential 1.5N >short.txt && grep -Eq "^ *1e-4 .*short" short.txt'
claim "  and never proposed" bash -c '
    rc-cost --quiet --tol 1e-1,1e-4 --budget 100s contact.rcg -- rc-slip --mu 0.3 --tangential 1.5N | grep -q -- "--tol 1e-1 "'
refuses 1 'no reference: .*hardness' "a reference that cannot be solved" \
    "rc-cost --tol 1e-2 rough.rcg -- rc-solve --periodic --mean-pressure 5GPa --estar 100GPa --hardness 1GPa"
claim "without an estimate the tolerance of the reference bounds it, if the last step changes nothing" bash -c "
    rc-cost --quiet --tol 1e-1,1e-3 contact.rcg -- $fatigue | grep -q '^# reference: tol 1e-05, .*its error is at most about 1.0e-05'"
claim "a step beyond the list that fails leaves its tightest value as the reference" bash -c "
    rc-cost --quiet --vary increments=256,512 --limit 100s ball.rcg -- rc-solve --load 20mN --relaxation 1MPa,9MPa:1ms --nu1 0.5 --E2 rigid --time 1ms >most.txt &&
    grep -q '^# reference: increments 512,' most.txt"
