# SPDX-License-Identifier: GPL-3.0-or-later
# rc-add adds two facing surfaces. The sum of a surface and its replica is flat, two balls are equivalent to
# one with the composite radius. Maps that do not match are refused with the command that helps.
. "$(dirname "$0")/../pipe.sh"

info() {
    "$@" | rc-info --json >info.json
}
# values FILE: prints all values of a stream of f64 frames in their order.
values() {
    perl -0777 -ne 'while (/\GRCG1\n(.*?)\n\n/gcs) { my %k = map { split /=/, $_, 2 } split /\n/, $1;
        my $n = $k{nx} * $k{ny} * ($k{type} eq "f64" ? 8 : 4); /\G(.{$n})crc32 \w{8}\n/gcs or die; print $1 }' "$1"
}
export -f values

rough='rc-synth selfaffine --hurst 0.8 --rms-height 0.3um --dx 1.1um --dy 1um'
$rough --nx 66 --ny 47 --seed 3 -o a.rcg
$rough --nx 66 --ny 47 --seed 4 -o b.rcg

# ---- the sum ----

# A surface minus itself is flat; a surface added to a flat one is mirrored; a flat minus this is the replica.
rc-add --subtract a.rcg a.rcg -o flat.rcg
rc-add flat.rcg a.rcg -o mirrored.rcg
rc-add --subtract flat.rcg mirrored.rcg -o replica.rcg
rc-info --json flat.rcg >info.json
near "$(field rms info.json)" 0 "$same" "a surface less itself is a flat"
claim "a surface and its replica close everywhere" info rc-add a.rcg replica.rcg
near "$(field minimum info.json)" 0 "$same" "its lowest point is 0"
near "$(field maximum info.json)" 0 "$same" "and its highest"
claim "the reverse order too" info rc-add replica.rcg a.rcg
near "$(field maximum info.json)" 0 "$same" "its highest point is 0"
claim "--mirror gives the mirrored map" bash -c '
    perl -e '\''my @v = map { open my $f, "-|", "bash", "-c", "values $_" or die; local $/; [unpack "d<*", <$f>] } @ARGV;
        for my $k (0 .. 66 * 47 - 1) {
            exit 1 if $v[0][$k] != $v[1][66 * int($k / 66) + 65 - $k % 66];
        }
        exit 1 if @{$v[0]} != 66 * 47'\'' a.rcg mirrored.rcg'

claim "standard input can be A" bash -c 'rc-add - b.rcg <a.rcg >one.rcg && rc-add a.rcg b.rcg -o two.rcg && cmp <(values one.rcg) <(values two.rcg)'
claim "  standard input can be B" bash -c 'rc-add a.rcg - <b.rcg >one.rcg && cmp <(values one.rcg) <(values two.rcg)'

# ---- two balls ----

# 1/R = 1/2.385 + 1/7.1; at 2 N on 114 GPa the radius of the contact is 20 nodes
radius=$(awk 'BEGIN { printf "%.17g", 1 / (1 / 2.385e-3 + 1 / 7.1e-3) }')
ball() { rc-synth sphere --nx 71 --dx 1.4um --radius "$@"; }
ball 2.385mm -o small.rcg
claim "the sum of two balls is computed" bash -c "rc-synth sphere --nx 71 --dx 1.4um --radius 7.1mm | rc-add small.rcg - -o balls.rcg"
ball "$radius" -o one.rcg
info rc-add --subtract balls.rcg one.rcg
# the corner is 1.5 um deep
between -1.5e-19 "$(field minimum info.json)" 0 "are one of the composite radius"
between 0 "$(field maximum info.json)" 1.5e-19 "  from below too"
claim "rc-solve presses it" rc-solve --quiet --load 2N --estar 114GPa --tol 1e-6 --report report.json \
    -o pressed.rcg balls.rcg
near "$(field approach report.json)" \
    "$(awk -v R="$radius" 'BEGIN { a = (3 * 2 * R / (4 * 114e9)) ^ (1 / 3); print a * a / R }')" \
    "$(awk -v c="$grid_approach" 'BEGIN { print c / 20 ^ 2 }')" "Hertz's approach with the composite radius"
near "$(field max_pressure report.json)" \
    "$(awk -v R="$radius" 'BEGIN { a = (3 * 2 * R / (4 * 114e9)) ^ (1 / 3); print 3 * 2 / (2 * atan2(0, -1) * a * a) }')" \
    "$(awk -v c="$grid_peak" 'BEGIN { print c / 20 ^ 2 }')" "Hertz's pressure"

# ---- lays: the example of a honed surface in rc-synth(1) ----

lay='rc-synth selfaffine --hurst 0.8 --rms-height 0.2um --rolloff 20um --anisotropy 10 --nx 256 --dx 1um'
$lay --direction 30 --seed 1 -o first-lay.rcg
$lay --direction 30 --seed 2 | tee second.rcg | rc-add first-lay.rcg - -o honed.rcg
rc-add --subtract honed.rcg first-lay.rcg -o facing.rcg
texture() { rc-info --areal --json "$1" >info.json && field "$2" info.json; }
# Std is the direction of the strongest waves, across the lay
between 110 "$(texture first-lay.rcg std)" 130 "a lay along 30 degrees"
between 50 "$(texture facing.rcg std)" 70 "  is along 150 degrees in the second surface, which is mirrored"
rc-pick --mirror x second.rcg | rc-add first-lay.rcg - -o parallel.rcg
between 110 "$(texture parallel.rcg std)" 130 "  and along 30 degrees where it was mirrored before"
between 80 "$(texture honed.rcg std)" 100 "  grooves that cross have no single direction"

# ---- alignment ----

# two parts of one surface; 7 columns and 4 rows apart
rc-synth selfaffine --nx 128 --dx 1um --hurst 0.7 --rms-height 0.3um --seed 5 | rc-pick --set periodic=no -o whole.rcg
rc-pick --quiet --crop 0,0,100,90 whole.rcg -o new.rcg
rc-pick --quiet --crop 7,4,96,96 whole.rcg -o later.rcg
claim "two scans are aligned" bash -c 'rc-add --subtract --align --report align.json later.rcg new.rcg -o change.rcg 2>err && [ ! -s err ]'
# the middle of B lies at column 49.5 - 7 of A, whose middle is at column 47.5; at row 44.5 - 4 and at 47.5
near "$(field shift_x align.json)" -5e-6 1e-6 "the shift along x"
near "$(field shift_y align.json)" -7e-6 1e-6 "  along y"
between -1e-6 "$(field rotation align.json)" 1e-6 "  without a rotation"
between 0 "$(field residual align.json)" 1e-11 "nothing is left"
between -1e-20 "$(field volume align.json)" 1e-20 "  and no volume"
info cat change.rcg
near "$(field nx info.json)" 96 "$same" "the map has the nodes of A"
near "$(field missing info.json)" "$((96 * 96 - 93 * 86))" "$same" "  and is missing where B does not reach"
# the page: rc-pick undoes a half turn, and turns by no other angles
rc-pick --rotate 180 later.rcg -o half.rcg
refuses 2 '--rotate' "a turn by other angles" "rc-pick --rotate 0.7 later.rcg -o x.rcg"
claim "a scan that is turned back is aligned" bash -c 'rc-pick --rotate 180 half.rcg | rc-add --subtract --align --report back.json - new.rcg -o x.rcg'
near "$(field shift_x back.json)" "$(field shift_x align.json)" 1e-9 "  by the same shift"
claim "frames have the alignment as keys" bash -c 'rc-info change.rcg >keys.txt && says "align.shift_x=-5" cat keys.txt && says "align.volume_error=" cat keys.txt'
claim "one line tells it" warns 'B is shifted by -5.000 and -7.000 nodes and turned by -?0.0000 degrees; .*volume .* mm3 .- .* mm3 .95 %.$' \
    rc-add --subtract --align --verbose later.rcg new.rcg -o c.rcg
claim "a table has a row" bash -c 'rc-add --subtract --align --report align.tsv later.rcg new.rcg -o c.rcg && [ $(wc -l <align.tsv) = 2 ] && says "volume_error/m3" cat align.tsv'
# holed RADIUS: later.rcg with a round hole in its middle
holed() { rc-export --format xyz later.rcg | awk -v r="$1" '!/^#/ { if ($1 ^ 2 + $2 ^ 2 < r ^ 2) $3 = "NaN" } { print }' | rc-import --format xyz --xy-unit m --z-unit m - -o holed.rcg; }
holed 3e-6
claim "a small hole is counted" warns 'the overlap is 86.8 % of A, and 0.4 % of it is missing; .*volume' rc-add --subtract --align --verbose holed.rcg new.rcg -o c.rcg
claim "  without a warning" bash -c 'rc-add --subtract --align --report align.json holed.rcg new.rcg -o c.rcg 2>err && [ ! -s err ]'
near "$(field missing align.json)" "$(awk 'BEGIN { print 32 / (93 * 86) }')" 1e-5 "  with its share of the overlap"
holed 20e-6
claim "  a large one has a warning" warns '16 % of the overlap is missing in A or B: the volume there is estimated' rc-add --subtract --align holed.rcg new.rcg -o c.rcg
refuses 2 '--align has no effect without --subtract' "no alignment of a sum" "rc-add --align later.rcg new.rcg"
refuses 1 'an alignment needs 16 a side' "too small a map" "rc-pick --crop 0,0,12,12 new.rcg | rc-add --subtract --align later.rcg -"
# spikes: 12 single points of 2 um; their volume without the warning is wear
rc-export --format xyz later.rcg | awk '!/^#/ { if (NR % 700 == 9) $3 += 2e-6 } { print }' | rc-import --format xyz --xy-unit m --z-unit m - -o spiky.rcg
claim "  points that stand alone have a warning" warns '[0-9]+ isolated points above the change around them are .* of the volume: if they are spikes of the instrument, run rc-detrend --spikes 5' rc-add --subtract --align spiky.rcg new.rcg -o c.rcg
refuses 2 '--align-below has no effect without --align' "no choice of nodes without an alignment" "rc-add --subtract --align-below 20 later.rcg new.rcg"
claim "the lowest nodes can be enough" bash -c 'rc-add --subtract --align --align-below 30 --report low.json later.rcg new.rcg -o c.rcg'
near "$(field shift_x low.json)" -5e-6 1e-9 "  with the same shift"
unrelated() { for seed in 6 7 8; do rc-synth selfaffine --nx 96 --dx 1um --hurst 0.7 --rms-height 0.3um --seed $seed -o other.rcg
    rc-add --subtract --align later.rcg other.rcg -o c.rcg 2>err; [ $? = 1 ] && grep -q 'the two maps do not fit on each other' err || return 1; done; }
claim "scans of two surfaces do not fit on each other" unrelated
refuses 1 'bring them together by rc-pick --resample' "other spacings" "rc-pick --resample 2um new.rcg | rc-add --subtract --align later.rcg -"

# ---- cut, missing, periodic ----

claim "maps of two sizes are added where they overlap" bash -c '
    rc-synth cone --slope 0.1 --nx 61 --ny 51 --dx 1.1um --dy 1um | rc-add --quiet a.rcg - | rc-info --json >info.json'
near "$(field nx info.json)" 61 "$same" "its columns"
near "$(field ny info.json)" 47 "$same" "its rows"
claim "  a warning says so" warns 'case 1, frame 1 \(height\): 66 x 47 nodes and 61 x 51 of B: cut to the 61 x 47 that they share' bash -c '
    rc-synth cone --slope 0.1 --nx 61 --ny 51 --dx 1.1um --dy 1um | rc-add --verbose a.rcg -'
printf '1 2 3\n4 NaN 6\n' | rc-import --dx 1um --z-unit um -o left.rcg -
printf '0 0 NaN\n0 0 0\n' | rc-import --dx 1um --z-unit um -o right.rcg -
claim "a point that is missing in one map is missing in the sum, with B mirrored" bash -c '
    [ "$(rc-add left.rcg right.rcg | rc-export --format xyz | grep -v "^#" | cut -d " " -f 3 | tr "\n" " ")" = \
      "$(printf "NaN 2 3\n4 NaN 6\n" | rc-import --dx 1um --z-unit um - | rc-export --format xyz | grep -v "^#" | cut -d " " -f 3 | tr "\n" " ")" ]'
claim "the sum of two periodic maps is periodic" bash -c 'rc-add a.rcg b.rcg >sum.rcg 2>err.txt && [ ! -s err.txt ]'
claim "  its key says so" says periodic=yes cat sum.rcg
claim "the sum with a map that is not periodic is not periodic" warns 'this surface is periodic, but the result is not, because the other one is not: it gets periodic=no' bash -c '
    rc-synth cone --slope 0.1 --like a.rcg | rc-add a.rcg - -o sum.rcg'
claim "  its key says so" says periodic=no cat sum.rcg
claim "a cropped periodic map gives a sum that is not periodic" warns 'but the result is not, because the maps are cut to their overlap: it gets periodic=no' bash -c '
    rc-synth selfaffine --hurst 0.8 --rms-height 1um --nx 60 --ny 45 --dx 1.1um --dy 1um | rc-add a.rcg - -o sum.rcg'
claim "  its key says so" says periodic=no cat sum.rcg
claim "maps without the key cause no message about periods" bash -c '
    rc-add small.rcg one.rcg >sum.rcg 2>err.txt && [ ! -s err.txt ] && lacks periodic= sum.rcg'
claim "spacings that differ by less than a millionth count as equal" bash -c '
    rc-pick --set dx=1.1000009um b.rcg | rc-add a.rcg - | rc-info --json >info.json'
near "$(field dx info.json)" 1.1e-6 "$same" "and those of A"

# ---- keys, cases ----

claim "the sum has the keys of A, and name and history of both" bash -c '
    rc-pick --set colour=red --set source=first.x3p a.rcg -o red.rcg &&
    rc-pick --set colour=blue --set taste=salt b.rcg | rc-add red.rcg - -o sum.rcg && grep -aq colour=red sum.rcg && lacks ^taste= sum.rcg'
claim "  the history has this form" says '^history=rc-synth .* \| rc-pick .* \| rc-add [0-9.]* first.x3p selfaffine-seed-4 \(selfaffine-seed-4: rc-synth [^|]*--seed 4 selfaffine; rc-pick [^|]*\)$' cat sum.rcg
claim "--subtract is in the history" says 'rc-add [0-9.]* --subtract selfaffine-seed-3 selfaffine-seed-3' cat flat.rcg
claim "a long history is shortened" bash -c '
    rc-pick --set history.x=1 b.rcg -o long.rcg &&
    for k in 1 2 3; do rc-pick --set "long=$(printf "%02000d" "$k")" long.rcg -o next.rcg && mv next.rcg long.rcg; done &&
    rc-add a.rcg long.rcg -o sum.rcg && [ "$(grep -a ^history= sum.rcg | wc -c)" -lt 4600 ]'
claim "  it ends in three points" says '^history=.*0\.\.\.\)$' cat sum.rcg
claim "a sphere that was added to one map is named in the sum" bash -c '
    rc-solve --quiet --output height --radius 2mm --load 1N --estar 100GPa b.rcg -o formed.rcg && rc-add --quiet a.rcg formed.rcg -o sum.rcg'
claim "  its key has the value" says 'form=sphere 0.002$' cat sum.rcg
refuses 1 'form=sphere 0.002' "  and not added again" "rc-solve --radius 2mm --load 1N --estar 100GPa sum.rcg"
claim "  spheres of both maps are named in the sum" bash -c 'rc-add --quiet formed.rcg formed.rcg -o sum.rcg'
claim "  its key has both values" says 'form=sphere 0.002 \+ sphere 0.002$' cat sum.rcg
claim "  equal spheres cancel in the difference" bash -c 'rc-add --quiet --subtract formed.rcg formed.rcg -o sum.rcg && lacks form= sum.rcg'

cat a.rcg b.rcg >two.rcg
claim "one B is added to every case of A" bash -c 'rc-add two.rcg b.rcg -o sum.rcg && [ "$(rc-info sum.rcg | grep -c "case [12]")" = 2 ]'
claim "  each sum contains it" bash -c 'rc-pick --case 1 sum.rcg -o x.rcg && rc-add a.rcg b.rcg -o y.rcg && cmp <(values x.rcg) <(values y.rcg) &&
    rc-pick --case 2 sum.rcg -o x.rcg && rc-add b.rcg b.rcg -o y.rcg && cmp <(values x.rcg) <(values y.rcg)'
claim "two cases of B are added to two cases of A in their order" bash -c 'rc-add --subtract two.rcg two.rcg | rc-info --json >info.json &&
    [ "$(grep -c "\"rms\": 0," info.json)" = 2 ]'
claim "other frames of A are passed on, other frames of B are not" bash -c '
    rc-pick --set channel=quality a.rcg -o quality.rcg &&
    perl -0777 -pe "s/RCGEND 1\n//" a.rcg >pair.rcg &&
    perl -0777 -pe "s/RCGEND 1\n/RCGEND 2\n/" quality.rcg >>pair.rcg &&
    rc-add pair.rcg pair.rcg | rc-info --json | grep -o "\"channel\": \"[a-z]*\"" | tr "\n" " " >channels.txt &&
    [ "$(cat channels.txt)" = "\"channel\": \"height\" \"channel\": \"quality\" " ]'
claim "the height of a solution may be B" bash -c 'rc-solve --quiet --load 1N --estar 100GPa a.rcg -o solved.rcg && rc-add b.rcg solved.rcg -o sum.rcg'
claim "the sum is f64 if one map is f64" bash -c 'rc-pick --type f32 --channel height a.rcg -o single.rcg && rc-add single.rcg b.rcg | rc-info --json >info.json'
claim "  its type says so" grep -q '"type": "f64"' info.json
claim "the sum is f32 if both maps are f32" bash -c 'rc-add single.rcg single.rcg | rc-info --json >info.json && grep -q "\"type\": \"f32\"" info.json'

# ---- refusals ----

$rough --nx 30 --dx 2um --dy 2um -o coarse.rcg
refuses 1 'selfaffine-seed-3, case 1, frame 1 \(height\): spacings of 1.1e-06 x 1e-06 m, and in coarse.rcg of 2e-06 x 2e-06 m: bring them together by rc-pick --resample 2e-06,2e-06 a.rcg' \
    "other spacings, naming the finer one" "rc-add a.rcg coarse.rcg"
refuses 1 'rc-pick --resample 2e-06,2e-06 a.rcg' "  which may be B" "rc-add coarse.rcg a.rcg"
refuses 1 'and in standard input of .* --resample 2e-06,2e-06 -' "  or standard input" "rc-add coarse.rcg - <a.rcg"
refuses 1 'aa.rcg has more surfaces than the 1 of a.rcg: put the stream with several surfaces first' "more in B than in A" \
    "cat a.rcg b.rcg >aa.rcg; rc-add a.rcg aa.rcg >out.rcg"
refuses 1 'the program that wrote it|stopped|fail' "  so that no reader takes it for whole" "rc-info out.rcg"
refuses 1 'case 3, .*: two.rcg has only 2 surfaces: B must have one surface, or as many as A' "two for three" \
    "cat a.rcg b.rcg a.rcg | rc-add - two.rcg >/dev/null"
refuses 1 'computed from it \(pressure, gap, displacement\)' "a case with results" "rc-add solved.rcg b.rcg"
refuses 1 'no frame with the channel height, only pressure' "no height in B" "rc-pick --channel pressure solved.rcg | rc-add a.rcg -"
refuses 1 "frame 1 \(height\): its unit is 'V'" "a height that is none" "rc-pick --set unit=V b.rcg | rc-add a.rcg -"
perl -0777 -pe 's/(RCG1\n.*?\n\n).{8}/$1 . pack("d<", 9**9**9)/se' a.rcg | reseal >infinite.rcg
refuses 1 'selfaffine-seed-3, case 1, frame 1 \(height\): 1 heights are infinite, the first in column 0 of row 0' "an infinite height" \
    "rc-add a.rcg infinite.rcg"
refuses 2 '- and -: standard input is one surface' "standard input twice" "rc-add - -"
refuses 2 '1 files named: give two, A and B' "one surface" "rc-add a.rcg"
refuses 2 '3 files named: give two' "three" "rc-add a.rcg a.rcg a.rcg"
refuses 1 'nowhere.rcg: No such file' "a file that is not there" "rc-add a.rcg nowhere.rcg -o out2.rcg"
claim "no file is left" test ! -e out2.rcg
refuses 1 '66 x 47 nodes need about' "more memory than is allowed" "rc-add --memory 30k a.rcg b.rcg"
refuses 1 'No space left' "a full disk" "rc-add a.rcg b.rcg >/dev/full"
rc-pick --set converged=no b.rcg -o short.rcg
refuses 3 'selfaffine-seed-4.* stopped short of its accuracy' "what stopped short in B is told" "rc-add a.rcg short.rcg -o sum.rcg"
claim "  the sum is written" says RCGEND cat sum.rcg
