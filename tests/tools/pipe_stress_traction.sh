# SPDX-License-Identifier: GPL-3.0-or-later
# rc-stress with frames of traction beside the pressure. A traction of mu p is equivalent to --mu, at any
# place in the case. The report and refusals are tested too.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 48 --ny 48 --dx 10um --radius 7.5mm |
    rc-solve --quiet --load 120N --E1 208GPa --nu1 0.3 --E2 rigid --output pressure -o ball.rcg
rc-synth selfaffine --nx 30 --ny 25 --dx 1um --hurst 0.8 --rms-height 0.1um --rolloff 20um --short-cut 5um --seed 7 |
    rc-solve --quiet --periodic --mean-pressure 100MPa --E1 208GPa --nu1 0.3 --E2 rigid --output pressure -o rough.rcg
rc-synth sphere --nx 48 --ny 48 --dx 10um --radius 7.5mm |
    rc-solve --quiet --load 120N --layer 30um,400GPa,0.2 --E1 208GPa --nu1 0.3 --E2 rigid --output pressure -o coated.rcg

near "$(total pressure ball.rcg 1)" 120 "$summed" "the ball carries its load"
rc-stress --depths 0 --components szz -o surface.rcg ball.rcg
near "$(total szz surface.rcg 1)" -120 "$of_sum" "  and so does the stress at its surface"

# traction FILE CHANNEL FACTOR: prints the frame of FILE under another name, its values times a factor,
# without an end line
traction() {
    perl -MCompress::Zlib -0777 -e '
        my ($channel, $factor) = @ARGV;
        my ($head, $rest) = split /\n\n/, <STDIN>, 2;
        my ($n) = $head =~ /nx=(\d+)/;
        $n *= $1 if $head =~ /ny=(\d+)/;
        $head =~ s/channel=pressure/channel=$channel/;
        my $frame = "$head\n\n" . pack("d<*", map { $_ * $factor } unpack("d<$n", $rest));
        printf "%scrc32 %08x\n", $frame, crc32($frame);' "$2" "$3" <"$1"
}
# frames FILE...: prints a stream of these frames
frames() {
    cat "$@" | perl -0777 -pe 's/RCGEND \d+\n//g'
    echo "RCGEND $#"
}
# largest FILE FILE: prints the largest difference of the values of two streams over the largest value
largest() {
    perl -0777 -e '
        sub values_of {
            open(my $f, "<", $_[0]) or die;
            my ($stream, @v) = <$f>;
            while ($stream =~ /\GRCG1\n(.*?)\n\n/gcs) {
                my ($head, $at) = ($1, pos($stream));
                my ($nx) = $head =~ /nx=(\d+)/;
                my ($ny) = $head =~ /ny=(\d+)/;
                push @v, unpack("d<*", substr($stream, $at, 8 * $nx * $ny));
                pos($stream) = $at + 8 * $nx * $ny;
                $stream =~ /\Gcrc32 .{8}\n/gc or die;
            }
            return @v;
        }
        my @a = values_of($ARGV[0]);
        my @b = values_of($ARGV[1]);
        my ($m, $s) = (0, 0);
        die unless @a == @b && @a > 100;
        for my $k (0 .. $#a) {
            my $d = abs($a[$k] - $b[$k]);
            $m = $d if $d > $m;
            $s = abs($a[$k]) if abs($a[$k]) > $s;
        }
        printf "%.3e", $m / $s;' "$1" "$2"
}
count() { grep -o '"counts": {[^}]*' "$2" | grep -o "\"$1\": [0-9]*" | cut -d' ' -f2; }

# ---- friction in a map ----

for surface in ball rough coated; do
    traction $surface.rcg traction-x 0.3 >tx.part
    frames $surface.rcg tx.part >after.rcg
    frames tx.part $surface.rcg >before.rcg
    for how in "" "--section y=0" "--section x=12um"; do
        rc-stress --quiet --depths 0,3um,20um $how --mu 0.3 -o mu.rcg $surface.rcg
        rc-stress --quiet --depths 0,3um,20um $how --report map.json -o map.rcg after.rcg
        between 0 "$(largest mu.rcg map.rcg)" 1e-12 "$surface, ${how:-slices}: mu p beside the pressure is --mu"
    done
    rc-stress --quiet --depths 0,3um,20um -o map.rcg after.rcg
    claim "  all components are there at each depth" test "$(channels map.rcg)" = \
        "$(for _ in 1 2 3; do echo sxx syy szz sxy sxz syz mises; done | xargs)"
    claim "  the tractions may precede the pressure" cmp <(rc-stress --quiet --depths 3um after.rcg) <(rc-stress --quiet --depths 3um before.rcg)
done

# ---- along y ----

traction ball.rcg traction-y 0.3 >ty.part
frames ball.rcg ty.part >y.rcg
frames ball.rcg <(traction ball.rcg traction-x 0.3) >x.rcg
rc-stress --quiet --depths 30um --components syz --report y.json y.rcg -o syz.rcg
rc-stress --quiet --depths 30um --components sxz --report x.json -o sxz.rcg x.rcg
least() { grep -o '"min": {.*' "$1" | grep -o '"value": [^,]*' | head -n 1 | cut -d' ' -f2; }
# the pressure is symmetric to the accuracy of its solution
near "$(least y.json)" "$(least x.json)" 1e-6 "on a ball a traction along y makes the syz that one along x makes of sxz"
frames x.rcg ty.part | sed 's/^RCGEND 2$/RCGEND 3/' >both.rcg
claim "both tractions are accepted" rc-stress --quiet --depths 30um --report both.json -o both_stress.rcg both.rcg

# ---- messages ----

rc-stress --quiet --depths 30um --report none.json -o none.rcg ball.rcg
claim "without a map of traction the pressure alone is transformed" test "$(count source_transforms none.json)" = 1
claim "  no kernel of the shear is evaluated" test "$(count shear_kernels none.json)" = 0
claim "with one map two are transformed" test "$(count source_transforms y.json)" = 2
claim "with both maps three are transformed, with nine more kernels" test "$(count source_transforms both.json) $(count shear_kernels both.json)" = "3 9"
claim "the report has no mu, and friction is on" grep -q '"mu": null, .*"friction": "on"' y.json
claim "the frames have no mu either" bash -c 'rc-info syz.rcg >info.txt && lacks "mu=" info.txt'
claim "--dry-run says so" says 'friction *on$' rc-stress --depths 30um --dry-run y.rcg

# ---- refusals ----

refuses 1 'its own traction, and --mu 0.1 contradicts it' "--mu beside it" "rc-stress --quiet --mu 0.1 --depths 1um y.rcg"
frames ball.rcg ty.part ty.part >two.rcg
refuses 1 'two .traction-y. frames in case 1; give unrelated maps different numbers' "two of a kind" \
    "rc-stress --quiet --depths 1um two.rcg"
rc-pick --crop 1,0,47,48 -o small.rcg ball.rcg
traction small.rcg traction-x 0.3 >small.part
frames ball.rcg small.part >grid.rcg
refuses 1 'traction-x.*47 x 48 nodes .* but pressure has 48 x 48' "another grid" "rc-stress --quiet --depths 1um grid.rcg"
frames ball.rcg <(traction ball.rcg traction-x inf) >inf.rcg
refuses 1 'traction-x.*NaN or infinite' "values that are none" "rc-stress --quiet --depths 1um inf.rcg"
frames ty.part >alone.rcg
refuses 1 'no frame with the channel pressure, only traction-y' "traction without pressure" "rc-stress --quiet --depths 1um alone.rcg"
refuses 1 'the case has no plastic strain' "--residual of an elastic case" "rc-stress --quiet --residual --depths 1um y.rcg"
rc-synth sphere --nx 48 --ny 48 --dx 10um --radius 7.5mm -o height.rcg
frames height.rcg ty.part >beside.rcg
refuses 1 'results computed from it \(traction-y\)' "a height is not changed beside it" "rc-detrend --plane beside.rcg"
