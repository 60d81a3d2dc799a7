# SPDX-License-Identifier: GPL-3.0-or-later
# rc-cost: what the measurement costs in accuracy. Noise adds in squares to heights and slopes; the noise of two scans
# is that which was added; bars hold Hertz's solution and the figures of a noiseless map; forces add up over quarters; a
# spectrum without an end is flagged.
. "$(dirname "$0")/../pipe.sh"

export RC_THREADS=1

# of NAME KEY FILE: prints a member of the row of a figure.
of() {
    perl -MJSON::PP -e '
        my ($name, $key, $file) = @ARGV;
        open my $f, "<", $file or die;
        while (<$f>) {
            my $r = decode_json($_);
            next if $r->{name} ne $name;
            my $v = $r->{$key};
            printf "%s\n", ref $v ? ($v ? "true" : "false") : $v // "null";
            exit;
        }
        die "$file: no row $name\n"' "$@"
}
study() { # NAME INPUT 'OPTIONS' COMMAND...
    local name=$1 input=$2 options=$3
    shift 3
    # shellcheck disable=SC2086
    claim "$name: a study" rc-cost --quiet $options --report "$name.json" -o "$name.txt" "$input" -- "$@"
}
# holds NAME FIGURE TRUTH: the value as measured is within its bar of the truth.
holds() {
    between "$(awk -v t="$3" -v b="$(of "$2" bar "$1.json")" 'BEGIN { printf "%.17g", t - b }')" "$(of "$2" value "$1.json")" \
        "$(awk -v t="$3" -v b="$(of "$2" bar "$1.json")" 'BEGIN { printf "%.17g", t + b }')" "$1: the bar of $2 holds the true value"
}
# A surface whose shortest waves have 6 nodes, and two doses of noise from waves of all lengths.
rc-synth selfaffine --nx 128 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 24um --short-cut 6um --seed 5 -o true.rcg
white() { # NODES STEP RMS SEED
    perl -e 'my ($n, $rms, $seed) = @ARGV; srand $seed; my $pi = atan2(0, -1);
        for (1 .. $n) { print join(" ", map { $rms * sqrt(-2 * log(1 - rand)) * cos(2 * $pi * rand) } 1 .. $n), "\n" }' "$1" "${3%nm}e-9" "$4" |
        rc-import --quiet --format ascii --dx "$2" --z-unit m -
}
noisy() { # MAP NODES STEP RMS SEED
    white "${@:2}" | rc-add "$1" -
}
noisy true.rcg 128 1um 10nm 1 >a.rcg
noisy true.rcg 128 1um 10nm 2 >b.rcg

# ---- noise ----

rms=$(rc-info --json a.rcg | grep -o '"rms": [^,]*' | cut -d ' ' -f 2)
study squares a.rcg "--noise 0.2um --repeats 8" rc-info
near "$(of rms noise_bias squares.json)" "$(awk -v r="$rms" 'BEGIN { print sqrt(r * r + 4e-14) - r }')" 0.02 "the rms height of the noise adds in squares"
near "$(of rms noise squares.json)" "$(awk -v b="$(of rms noise_bias squares.json)" -v s="$(of rms noise_scatter squares.json)" 'BEGIN { print (b < 0 ? -b : b) + 1.895 * s }')" \
    1e-3 "  the bar of the noise is the bias and 1.895 standard deviations of eight repeats"
near "$(of rms bar squares.json)" "$(of rms noise squares.json)" "$rounding" "  which is the bar"
claim "without --resolution the last line says that the error of the grid is not in the bars" test "$(tail -n 1 squares.txt)" = \
    '# the error of the grid is not in these bars: add --resolution'
slope_of() { sed -n 's/^# noise:.*; its slope is \(.*\)/\1/p' "$1"; }
near "$(slope_of squares.txt)" 0.4 0.02 "the slope of white noise is 2 sigma/dx"
study wide a.rcg "--noise 0.2um,3um" rc-info
near "$(slope_of wide.txt)" "$(awk 'BEGIN { print 0.2 * 2 * sqrt(1 - exp(-1 / 9)) }')" 0.05 \
    "the slope of correlated noise is 2 sigma sqrt(1 - exp(-(dx/L)^2))/dx"
claim "  the seed sets the noise" bash -c 'rc-cost --quiet --noise 10nm --report one.json -o /dev/null a.rcg -- rc-info && rc-cost --quiet --noise 10nm --report two.json -o /dev/null a.rcg -- rc-info &&
    rc-cost --quiet --noise 10nm --seed 2 --report three.json -o /dev/null a.rcg -- rc-info && cmp <(grep figure one.json) <(grep figure two.json) && ! cmp -s <(grep figure one.json) <(grep figure three.json)'
study two a.rcg "--repeat b.rcg" rc-info
near "$(of rms noise_height two.json)" 1e-8 0.05 "two scans: the standard deviation of the noise of each"
near "$(of rms noise_length two.json)" 0 "$same" "  and that it is white"
noise_of_length() { # SEED: Gaussian correlation of 4 nodes
    white 128 1um 100nm "$1" | rc-detrend --quiet --lowpass 10.67um >smooth.rcg
    scale=$(rc-info --json smooth.rcg | grep -o '"rms": [^,]*' | cut -d ' ' -f 2)
    rc-add true.rcg smooth.rcg
}
noise_of_length 3 >c.rcg
first=$scale
noise_of_length 4 >d.rcg
study long c.rcg "--repeat d.rcg" rc-info
near "$(of rms noise_height long.json)" "$(awk -v a="$first" -v b="$scale" 'BEGIN { print sqrt((a * a + b * b) / 2) }')" 0.05 "correlated noise of two scans: its standard deviation"
near "$(of rms noise_length long.json)" 4e-6 0.15 "  and its length"

# ---- the truth is within the bars ----

contact="--periodic --mean-pressure 20MPa --estar 1GPa"
rc-synth selfaffine --nx 512 --dx 0.25um --hurst 0.8 --rms-slope 0.1 --rolloff 24um --short-cut 6um --seed 5 -o fine.rcg
rc-solve $contact --quiet --report fine.json fine.rcg | rc-leak --quiet --report leak.json >/dev/null
study rough a.rcg "--noise 10nm --resolution" rc-solve $contact '|' rc-leak
for figure in contact_area mean_gap max_pressure elastic_energy; do holds rough $figure "$(field $figure fine.json)"; done
for figure in flow_conductance critical_gap shear_flow_factor; do holds rough $figure "$(field $figure leak.json)"; done
claim "  with --resolution the grid is in the bars" bash -c '! grep -q "not in these bars" rough.txt'
claim "  the bar joins noise and grid in squares, the grid with 0.85 of the larger of the change and half the one before, above and below a quotient" perl -MJSON::PP -e '
    open my $f, "<", "rough.json" or die;
    $of{$_->{name}} = $_ for grep { $_->{what} eq "figure" } map { decode_json($_) } <$f>;
    sub part { # of the values on the map and on the two coarser grids
        my ($a, $b) = (abs $_[0] - $_[1], abs($_[1] - $_[2]) / 2);
        0.85 * ($a > $b ? $a : $b);
    }
    sub values_of { map { $of{$_[0]}{$_} } qw(value half_grid quarter_grid) }
    sub quotient { # (name, the figure below)
        my ($q, $below) = ([values_of($_[0])], [values_of($_[1])]);
        sqrt(part(map { $q->[$_] * $below->[$_] } 0 .. 2) ** 2 + ($q->[0] * part(@$below)) ** 2) / $below->[0];
    }
    for my $r (grep { $_->{bar} } values %of) {
        my $grid = $r->{name} eq "shear_flow_factor" ? quotient($r->{name}, "gap_rms") : part(values_of($r->{name}));
        die "$r->{name}\n" if abs($grid - $r->{grid}) > 1e-9 * $grid || abs(sqrt($r->{noise} ** 2 + $grid ** 2) - $r->{bar}) > 1e-9 * $r->{bar};
        $n++;
    }
    die "no shear flow factor\n" if !$of{shear_flow_factor}{bar};
    exit($n < 8)'
claim "  the source with the largest part is named" bash -c 'grep -Eq "^max_pressure .* noise *$" rough.txt && grep -Eq "^contact_area .* grid *$" rough.txt'
claim "  figures that the command gives are none of the map" grep -q '^# no change:.* load, mean_pressure' rough.txt
# a^3 = 3 P R/4 E*; p0 = 3 P/2 pi a^2; approach a^2/R
rc-synth sphere --nx 64 --dx 10um --radius 7.5mm -o ball.rcg
noisy ball.rcg 64 10um 5nm 3 >ball-a.rcg
study ball ball-a.rcg "--noise 5nm --resolution" rc-solve --load 20N --estar 114GPa
holds ball max_pressure 9.633992e+08
holds ball approach 1.321612e-06
claim "  the bar is no larger than a third" bash -c "awk '\$1 == \"max_pressure\" { exit !(\$4 + 0 < 33) }' ball.txt"

# ---- the grid ----

claim "waves of 6 nodes end on the map" grep -q '^# grid: the waves end on this map (' rough.txt
rc-synth selfaffine --nx 512 --dx 0.25um --hurst 0.7 --rms-slope 0.1 --rolloff 24um --seed 7 | rc-pick --quiet --resample 128x128 >fractal.rcg
study fractal fractal.rcg "--noise 1nm --resolution" rc-solve $contact
claim "a spectrum that goes on does not" grep -q '^# grid: the map has waves as short as its nodes: a finer scan would show more (' fractal.txt
# RMS slopes of the map and of its means, 2 sigma/dx of the noise of 1 nm taken out
slope_on() { rc-pick --quiet --resample "$1x$1" fractal.rcg | rc-info --json | grep -o '"rms_slope": [^,]*' | cut -d ' ' -f 2; }
read -r first second <<<"$(sed -n 's/^# grid:.*grows by \([0-9.]*\) % from a quarter .* by \([0-9.]*\) % from half.*/\1 \2/p' fractal.txt)"
near "$second" "$(awk -v a="$(slope_on 128)" -v b="$(slope_on 64)" 'BEGIN { print 100 * (a / b - 1) }')" 0.03 "  by how much the slope grows with the last doubling of the nodes"
near "$first" "$(awk -v a="$(slope_on 64)" -v b="$(slope_on 32)" 'BEGIN { print 100 * (a / b - 1) }')" 0.03 "  and with the one before"
claim "  its figures have no bar and say why" bash -c "grep -Eq '^contact_area .* m2 +- .*a finer grid may change it further' fractal.txt"
claim "  with the spacing to quote" grep -q '^contact_area .*a finer grid may change it further, so give the spacing, 1 um, with the value$' fractal.txt
claim "  and the part of the noise" test "$(of contact_area noise_relative fractal.json | grep -c '^[0-9]')" = 1
claim "  in the report too" test "$(of contact_area bar fractal.json)/$(of contact_area limit fractal.json)/$(of contact_area waves_end fractal.json)" = null/false/false

claim "a SIGMA that is too large for the map is named" bash -c "
    rc-cost --quiet --noise 60nm --resolution true.rcg -- rc-solve $contact | grep -q '^# grid: the noise is as steep as the map'"

# ---- quarters ----

# 4 x 4 equal bumps: each quarter has 2 x 2 of them.
rc-synth wave --nx 64 --dx 1um --amplitude 0.2um --wavelength 16um -o bumps.rcg
study free bumps.rcg --patch rc-solve --mean-pressure 1MPa --estar 1GPa
claim "forces add up over quarters" bash -c 'grep -Eq "^# no change:.* load" free.txt'
between 0 "$(of load bar free.json)" 0 "  the load has no bar"
study again bumps.rcg --patch rc-solve --periodic --mean-pressure 1MPa --estar 1GPa
between 0 "$(of contact_area bar_relative again.json)" 0.02 "equal quarters, reflected: no bar"
rc-pick --crop 0,0,64,64 true.rcg | rc-detrend --quiet --plane --mirror xy -o mirrored.rcg
study mirror mirrored.rcg --patch rc-solve $contact
between 0.01 "$(of contact_area bar_relative mirror.json)" 1 "quarters of a mirrored map are those of the part that is not an image"
claim "extremes have no bar of the patch" bash -c "grep -Eq '^max_pressure .* Pa +- +- +- +on this area' mirror.txt"
# crops MIRROR TIMES STUDY OPTIONS: the bar of the elastic energy from quarters that are made here, mirrored, and
# fit this many times on the map
crops() {
    local k=0 at mirror=$1 times=$2 file=$3
    shift 3
    for at in 0,0 64,0 0,64 64,64; do
        k=$((k + 1))
        rc-pick --quiet --crop "$at,64,64" true.rcg | rc-detrend --quiet --plane --mirror "$mirror" | rc-solve "$@" --quiet --report "crop$k.json" >/dev/null || return
    done
    for k in 1 2 3 4; do field elastic_energy crop$k.json; done | awk -v times="$times" -v f="$(of elastic_energy value "$file")" '{ v[NR] = times * $1; m += v[NR] / 4 } END {
        for (k in v) s += (v[k] - m) ^ 2 / 3; d = f - m; printf "%.9g\n", 2.353 * sqrt(s) / 2 + (d < 0 ? -d : d) }'
}
study mean true.rcg --patch rc-solve $contact
near "$(of elastic_energy patch mean.json)" "$(crops xy 1 mean.json $contact)" 1e-4 "the bar of the patch is that of the quarters, cut, levelled, mirrored and solved here"
strip="--periodic=y --mean-pressure 20MPa --estar 1GPa"
study strip true.rcg --patch rc-solve $strip
near "$(of elastic_energy patch strip.json)" "$(crops y 2 strip.json $strip)" 1e-4 "  mirrored only along the axis that the contact repeats"
refuses 2 'load of rc-solve is a force on the whole map: give --mean-pressure' "forces are not shared by quarters" "rc-cost --patch true.rcg -- rc-solve --load 1N --estar 1GPa"

# ---- filters and holes ----

study filter true.rcg "--noise 10nm --filter --lowpass=8um;--lowpass=16um" rc-solve $contact
rc-detrend --quiet --lowpass 16um true.rcg | rc-solve $contact --quiet --report low.json >/dev/null
near "$(of elastic_energy filter filter.json)" "$(awk -v a="$(field elastic_energy low.json)" -v b="$(of elastic_energy value filter.json)" 'BEGIN { d = a - b; print d < 0 ? -d : d }')" \
    1e-5 "the filter's part is the largest change"
near "$(of elastic_energy bar filter.json)" "$(of elastic_energy noise filter.json)" "$rounding" "  which is not in the bar"
study choice true.rcg "--noise 10nm --filter --lowpass=16um --filter-bar" rc-solve $contact
near "$(of elastic_energy bar choice.json)" "$(awk -v a="$(of elastic_energy noise choice.json)" -v b="$(of elastic_energy filter choice.json)" 'BEGIN { print sqrt(a * a + b * b) }')" \
    1e-5 "  except with --filter-bar"
perforated() { # MAP: without a disc of 5 nodes in each 25 x 25
    rc-export --format csv "$1" | grep -v '^#' | awk -F, -v OFS=, '{ for (k = 1; k <= NF; k++) if ((k % 25 - 12) ^ 2 + (NR % 25 - 12) ^ 2 <= 6) $k = "nan" } 1' |
        rc-import --quiet --format ascii --dx 1um --z-unit m -
}
perforated true.rcg >holes.rcg
study holes holes.rcg --holes rc-detrend --fill '|' rc-solve $contact
rc-solve $contact --quiet --report whole.json true.rcg >/dev/null
for figure in contact_area elastic_energy mean_gap; do holds holes $figure "$(field $figure whole.json)"; done
between 1e-5 "$(of contact_area bar_relative holes.json)" 0.2 "  the bar is not idle"
refuses 2 'no node of the map is missing: give the map before it was filled' "a map without holes" "rc-cost --holes true.rcg -- rc-solve $contact"

# ---- rows, refusals, signals ----

study failed true.rcg "--resolution --filter --lowpass=1m" rc-solve $contact
claim "a map that fails is a row with its reason" grep -q '^# filter --lowpass=1m: left out: rc-detrend: a cut-off of 1 m is longer than the map' failed.txt
claim "  also in the report" test "$(of 'filter --lowpass=1m' state failed.json)" = "left out"
rc-pick --quiet --crop 0,0,24,24 -o small.rcg true.rcg
study small small.rcg "--noise 10nm --resolution" rc-solve $contact
claim "without a coarser grid there is no bar" grep -Eq '^contact_area .* m2 +- .*unknown on some of the maps' small.txt
refused() { refuses 2 "$1" "refused: $2" "rc-cost $2 -- rc-solve $contact"; }
refused 'does not work with --tol, because one varies the map, the other the command' "--noise 10nm --tol 1e-3 true.rcg"
refused 'must be above 0' "--noise 0nm true.rcg"
refuses 1 '--noise 5 m: the rms height of the map is [0-9.]+ nm: .* a number without a unit is in metres, write 5nm$' "noise without a unit" "rc-cost --noise 5 true.rcg -- rc-solve $contact"
refused 'needs --filter|has no effect without --filter' "--filter-bar --noise 1nm true.rcg"
refused 'unknown option --nosuch: see rc-detrend --help' "--filter --nosuch true.rcg"
refuses 1 'equals the input: give a second scan' "the same scan twice" "rc-cost --repeat true.rcg true.rcg -- rc-solve $contact"
refuses 1 'give a second scan of the same place' "a scan of another size" "rc-cost --repeat small.rcg true.rcg -- rc-solve $contact"
rc-solve $contact --quiet -o solved.rcg true.rcg
refuses 1 'contains a height and results computed from it' "results beside the heights" "rc-cost --noise 1nm solved.rcg -- rc-leak"
claim "--dry-run lists the maps and runs none" bash -c "rc-cost --dry-run --noise 1nm --resolution true.rcg -- rc-solve $contact >dry.txt && grep -q '^7 runs on 128 x 128 nodes, about' dry.txt && grep -q '^  grid 1/4' dry.txt"
claim "loads are rows of their own" bash -c "rc-cost --quiet --noise 10nm true.rcg -- rc-solve --periodic --mean-pressure 10MPa,20MPa --estar 1GPa >loads.txt && grep -Eq '^contact_area +2 ' loads.txt"
rc-synth selfaffine --nx 400 --dx 1um --hurst 0.8 --rms-slope 0.1 --seed 1 -o large.rcg
rc-synth sphere --nx 32 --dx 10um --radius 7.5mm -o few.rcg
rc-cost --quiet --noise 10nm --repeats 2 few.rcg -- rc-solve --load 1N --E1 210GPa --nu1 0.3 --E2 rigid '|' rc-stress --depths 20um >stress.txt
claim "a program without single figures is named" grep -q '^# rc-stress: no bars: its report has values by component or depth' stress.txt
claim "  and no other one" bash -c '! grep -q "# rc-solve: no bars" stress.txt'
refuses 2 'of max_mises: the command gives no such frame or figure$' "no figure that the reports lack is proposed" \
    "rc-cost --quiet --tol 1e-1 --of max_mises few.rcg -- rc-solve --load 1N --E1 210GPa --nu1 0.3 --E2 rigid '|' rc-stress --depths 20um"
claim "trials beyond --limit are left out and named" bash -c "rc-cost --quiet --limit 3s --noise 10nm --repeats 64 large.rcg -- rc-solve $contact >limit.txt && grep -q '^# noise 64: left out: .* left of --limit' limit.txt"
interrupted() {
    local tool status late
    mkdir -p scratch
    TMPDIR=$PWD/scratch perl -e '$SIG{INT} = "DEFAULT"; exec @ARGV' rc-cost --progress line --noise 1nm --repeats 64 large.rcg -- rc-solve $contact --tol 1e-6 >cut.txt 2>told.txt &
    tool=$!
    until grep -q 'noise 3' told.txt || ! kill -0 "$tool"; do sleep 0.02; done
    late=$(perl -MTime::HiRes=time -e 'my ($tool) = @ARGV; my $at = time; kill INT => $tool;
        while (open(my $s, "<", "/proc/$tool/stat") && <$s> !~ /\) Z/) { select undef, undef, undef, 0.01 } printf "%.3f", time - $at' "$tool")
    wait "$tool"
    status=$?
    echo "status $status after $late s" >&2
    [ "$status" = 130 ] && [ -z "$(ls scratch)" ] && [ -z "$(pgrep -P "$tool")" ] && grep -q '^# noise 6.*: left out: interrupted' cut.txt && awk "BEGIN { exit !($late < 0.5) }"
}
claim "SIGINT ends the study within half a second and leaves no file" interrupted

# ---- an option whose value is optional ----

rc-pick --crop 0,0,32,32 true.rcg -o small.rcg
rolls() { rc-cost --quiet --noise 1nm --repeats 2 small.rcg -- rc-solve --load 5kN/m --cylinder 1mm --estar 100GPa "$@" | grep -v '^# command'; }
rolls --periodic=y >joined.txt
claim "--periodic y is --periodic=y" bash -c "grep -q '^max_pressure .* Pa ' joined.txt && cmp joined.txt - <<<'$(rolls --periodic y)'"
claim "  --periodic before another option has no value" says '^max_pressure' \
    rc-cost --quiet --noise 1nm --repeats 2 small.rcg -- rc-solve --periodic --mean-pressure 20MPa --estar 100GPa
refuses 2 'leave out z' "  and z is no value of it" "rc-cost --noise 1nm small.rcg -- rc-solve --load 1N --estar 100GPa --periodic z"

# ---- the picture of the bars ----

claim "--plot draws the bars" rc-cost --quiet --noise 2nm --resolution --plot bars.svg --report drawn.json -o drawn.txt true.rcg -- rc-solve --periodic --mean-pressure 20MPa,50MPa --estar 100GPa
# The circles are the bars: place and decades of the axis of per cent, between two of its marks, give their values.
perl -0777 -ne '
    my ($left, $top, $w, $h) = /<clipPath id="\w+"><rect x="([\d.]+)" y="([\d.]+)" width="([\d.]+)" height="([\d.]+)"/ or die;
    my @dots; push @dots, $2 while /<path d="M([\d.]+) ([\d.]+)L\1 \2"/g;
    my %mark; while (/<text x="[\d.]+" y="([\d.]+)" font-size="([\d.]+)" text-anchor="end"[^>]*>(0?\.?[0-9.]+)</g) { $mark{$3} = $1 - 0.36 * $2 }
    my ($a, $b) = sort { $a <=> $b } keys %mark; die "two marks\n" unless defined $b;
    printf "%.6g\n", $a * ($b / $a) ** (($mark{$a} - $_) / ($mark{$a} - $mark{$b})) for grep { $_ < $top + $h } @dots' bars.svg | sort -g >dots.txt
perl -MJSON::PP -ne 'my $r = decode_json($_); printf "%.6g\n", 100 * $r->{bar_relative} if $r->{what} eq "figure" && $r->{case} == 2 && ($r->{bar_relative} // 0) > 0' drawn.json | sort -g >bars.txt
claim "  each bar of the last case has a circle at its value" bash -c '[ "$(wc -l <bars.txt)" -gt 4 ] && paste bars.txt dots.txt | awk "{ r = \$1 / \$2 } !(r > 0.98 && r < 1.02) { exit 1 }"'
claim "  the legend names the sources that were studied" bash -c 'grep -q ">bar, 90 %<" bars.svg && grep -q ">noise<" bars.svg && grep -q ">grid<" bars.svg && ! grep -q ">patch<" bars.svg'
claim "  the axis names the figures" grep -q '>contact fraction<' bars.svg
