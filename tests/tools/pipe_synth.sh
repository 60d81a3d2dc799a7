# SPDX-License-Identifier: GPL-3.0-or-later
# rc-synth makes the requested surface on the requested grid, and refuses options that are missing, contradict
# each other or have no meaning.
. "$(dirname "$0")/../pipe.sh"
# With the address sanitizer, too, an impossible allocation returns NULL.
export ASAN_OPTIONS=allocator_may_return_null=1

info() {
    "$@" | rc-info --json >info.json
}

# ---- the grid ----

claim "a sphere is made" info rc-synth sphere --radius 2.385mm --nx 33 --ny 47 --dx 1.1um --dy 1um
near "$(field nx info.json)" 33 "$same" "its columns"
near "$(field ny info.json)" 47 "$same" "its rows"
near "$(field dx info.json)" 1.1e-6 "$same" "its dx, to the last digit"
near "$(field dy info.json)" 1e-6 "$same" "its dy"
near "$(field maximum info.json)" 0 "$same" "its highest point"
# corner: x = 16 dx = 17.6 um, y = 23 dy = 23 um, -(x^2 + y^2) / 2R
near "$(field minimum info.json)" -1.7584067085953878e-07 "$converted" "its lowest point"
claim "it has channel, unit and history, and is not periodic" bash -c '
    grep -q "\"channel\": \"height\".*\"unit\": \"m\".*\"type\": \"f64\"" info.json &&
    grep -q "\"history\": \"rc-synth [0-9.]* --nx 33 --ny 47 --dx 1.1e-06 --dy 1e-06 --radius 0.002385 sphere\"" info.json &&
    lacks periodic info.json'

claim "rows and dy default to columns and dx" info rc-synth sphere --radius 1mm --nx 9 --dx 2um
near "$(field ny info.json)" 9 "$same" "rows"
near "$(field dy info.json)" 2e-6 "$same" "dy"

claim "--like takes the grid of another map" bash -c '
    rc-synth sphere --radius 1mm --nx 7 --ny 5 --dx 1.3um --dy 1.7um --type f32 -o other.rcg &&
    rc-synth wave --amplitude 1um --wavelength 4um --like other.rcg | rc-info --json >info.json &&
    rc-synth wave --amplitude 1um --wavelength 4um --like - <other.rcg | rc-info --json >info2.json'
near "$(field nx info.json)" 7 "$same" "its columns"
near "$(field ny info.json)" 5 "$same" "its rows"
near "$(field dx info.json)" 1.3e-6 "$same" "its dx"
near "$(field dy info.json)" 1.7e-6 "$same" "its dy"
claim "the other map may be standard input, and its name is not stored" bash -c '
    cmp info.json info2.json && lacks other info.json'

claim "--type f32 gives single precision" says '"type": "f32"' rc-info --json other.rcg

# ---- indenters ----

claim "a cylinder lies along y" bash -c 'rc-synth cylinder --radius 1mm --nx 21 --dx 1um -o a.rcg &&
    rc-synth cylinder --radius 1mm --nx 21 --dx 1um --direction 90 -o b.rcg &&
    rc-info --json a.rcg >info.json && cmp <(rc-export --format csv a.rcg) <(rc-export --format csv b.rcg)'
# (10 um)^2 / 2 mm
near "$(field minimum info.json)" -5e-08 "$converted" "its lowest line"
claim "a cylinder along the diagonal is made" info rc-synth cylinder --radius 1mm --nx 21 --dx 1um --direction -45
# the other corners are sqrt(2) 10 um away: 2 (10 um)^2 / 2 mm
near "$(field minimum info.json)" -1e-07 "$rounding" "its lowest corner"
# the example of the page: a ball on a ring; by Hertz with elliptic integrals 1.258951 GPa on 1.191468e-7 m2
rc-synth paraboloid --radius 2.857mm,104mm --nx 96 --ny 192 --dx 2.5um --dy 15um |
    rc-solve --quiet --load 100N --body1 100Cr6 --body2 100Cr6 --report bearing.json -o /dev/null
near "$(field max_pressure bearing.json)" 1.258951e9 1e-3 "an elliptic contact has Hertz's pressure"
near "$(field contact_area bearing.json)" 1.191468e-7 0.01 "  and area"
claim "a paraboloid is made" info rc-synth paraboloid --radius 1mm,0.5mm --nx 21 --dx 1um
# (10 um)^2 / 2 mm + (10 um)^2 / 1 mm
near "$(field minimum info.json)" -1.5e-07 "$rounding" "its lowest corner"
claim "a cone is made" info rc-synth cone --slope 0.04 --nx 21 --dx 1um
near "$(field minimum info.json)" -5.65685424949238e-07 "$rounding" "its lowest corner" # 0.04 sqrt(2) 10 um
claim "a punch is made" info rc-synth punch --radius 5um --height 2um --nx 21 --dx 1um
near "$(field minimum info.json)" -2e-06 "$same" "what is around its end"
# 81 lattice points within 5 of 441: the mean is -2 um (1 - 81/441)
near "$(field mean info.json)" -1.6326530612244898e-06 "$rounding" "and how much"
claim "a punch with a rounded edge is made" info rc-synth punch --radius 5um --height 20um --edge 50um --nx 21 --dx 1um
# corner: (sqrt(200) um - 5 um)^2 / 100 um
near "$(field minimum info.json)" -8.357864376269047e-07 "$rounding" "its corner"

claim "an indenter at a given place is made" bash -c 'rc-synth cone --slope 0.04 --nx 21 --dx 1um --place 10um,-10um | rc-info --json >info.json'
# the far corner is 20 um away on each side
near "$(field minimum info.json)" -1.1313708498984762e-06 "$rounding" "its far corner"
rc-synth selfaffine --hurst 0.8 --rms-height 1um --nx 40 --ny 31 --dx 1um -o rough.rcg
rc-solve --quiet --load 1N --estar 100GPa -o solved.rcg rough.rcg
highest() {
    rc-export --format xyz "$1" | grep -v '^#' | sort -g -k 3,3 | tail -n 1 | cut -d ' ' -f 1,2
}
claim "an indenter on the highest node is made" bash -c 'rc-synth sphere --radius 1mm --place highest --like rough.rcg -o ball.rcg &&
    rc-synth sphere --radius 1mm --place highest --like - <solved.rcg >ball2.rcg && cmp ball.rcg ball2.rcg'
claim "  it equals an indenter at that place" test "$(highest ball.rcg)" = "$(highest rough.rcg)"
claim "  the history has the place" says 'rc-synth [0-9.]* --radius 0.001 --place -?[0-9.e-]+,-?[0-9.e-]+ sphere' rc-info ball.rcg

# ---- waves ----

# 40 nodes are 4 wavelengths of 11 um: the mean square of a cosine is 1/2, that of a product of two is 1/4
claim "a wave is made" info rc-synth wave --amplitude 0.3um --wavelength 11um --nx 40 --ny 3 --dx 1.1um
near "$(field rms info.json)" 2.1213203435596426e-07 "$rounding" "RMS of a cosine"
claim "it is periodic" grep -q '"periodic": "yes"' info.json
claim "two waves are made" info rc-synth wave --amplitude 0.3um --wavelength 11um,9um --nx 40 --ny 27 \
    --dx 1.1um --dy 1um
near "$(field rms info.json)" 1.5e-07 "$rounding" "RMS of the product of two"
claim "they are periodic" grep -q '"periodic": "yes"' info.json
claim "a wave along y alone is made" info rc-synth wave --amplitude 0.3um --wavelength 0,9um --nx 5 \
    --ny 27 --dx 1um
near "$(field rms info.json)" 2.1213203435596426e-07 "$rounding" "RMS of a cosine"
claim "a wave that does not fit the map is made" info rc-synth wave --amplitude 0.3um --wavelength 11um --nx 41 \
    --dx 1.1um
claim "it is not periodic" lacks periodic info.json

# ---- roughness ----

rough='rc-synth selfaffine --hurst 0.73 --nx 128 --ny 97 --dx 1.1um --dy 1um'
claim "roughness of a given height is made" bash -c "$rough --rms-height 0.42um | rc-info --json >info.json"
near "$(field rms info.json)" 0.42e-6 "$rounding" "its RMS height"
claim "it is periodic" grep -q '"periodic": "yes"' info.json
# waves of 20 nodes and more: differences between nodes give the slope except for a few per cent
claim "roughness of a given slope is made" bash -c \
    "$rough --rms-slope 0.23 --short-cut 20um | rc-info --json >info.json"
near "$(field rms_slope info.json)" 0.23 0.02 "its RMS slope"
claim "the same seed gives the same bytes for any number of threads" bash -c "
    $rough --rms-slope 0.1 --seed 7 --threads 1 -o a.rcg &&
    $rough --rms-slope 0.1 --seed 7 --threads 2 -o b.rcg && cmp a.rcg b.rcg"
claim "heights of another distribution, with a lay, are made" bash -c "
    $rough --rms-height 0.42um --skewness -1.2 --anisotropy 3 --direction 30 | rc-info --json >info.json"
near "$(field rms info.json)" 0.42e-6 "$rounding" "its RMS height"
claim "  the history has them" grep -q -- '--direction 30 .*--anisotropy 3 --skewness -1.2 selfaffine' info.json
claim "heights of Weibull's distribution are made" bash -c "$rough --rms-height 0.42um --weibull 1.5 | rc-info --json >info.json"
near "$(field rms info.json)" 0.42e-6 "$rounding" "its RMS height"
# the lowest value of a Weibull distribution is below the mean by Gamma(1 + 1/k)/sqrt(Gamma(1 + 2/k) - Gamma(1
# + 1/k)^2) standard deviations: 1.4723 for k = 1.5
near "$(field minimum info.json)" -6.18e-07 "$three_digits" "its lowest height"
claim "the lay lies along y" bash -c "
    $rough --rms-height 0.42um --anisotropy 3 -o a.rcg &&
    $rough --rms-height 0.42um --anisotropy 3 --direction 90 -o b.rcg"
claim "  this is the default" cmp <(rc-export --format csv a.rcg) <(rc-export --format csv b.rcg)

# the values only: without the last two lines of 24 bytes
values() {
    tail -c $((8 * 128 * 97 + 24)) "$1" | head -c $((8 * 128 * 97))
}
claim "a seed of more than 32 bits is used completely, or refused" bash -c "
    $rough --rms-slope 0.1 --seed 9000000000000000 -o large.rcg 2>large.err || grep -q 'counts to 4294967295' large.err"
for seed in 0 4294967295; do
    claim "  it differs from seed $seed" bash -c "
        $rough --rms-slope 0.1 --seed $seed -o small.rcg && rc-export --format csv small.rcg >small.csv &&
        ! cmp -s <(rc-export --format csv large.rcg) small.csv"
done
claim "the default seed is 1" bash -c "
    $rough --rms-slope 0.1 -o b.rcg && $rough --rms-slope 0.1 --seed 1 -o one.rcg"
claim "  the bytes are equal" cmp <(values b.rcg) <(values one.rcg)
values a.rcg >a.bin
values b.rcg >b.bin
claim "another seed gives other heights" perl -e '
    my @v = map { open my $f, "<:raw", $_ or die; local $/; [unpack "d<*", <$f>] } @ARGV;
    my $n = 0;
    $n += $v[0][$_] == $v[1][$_] for 0 .. 128 * 97 - 1;
    exit $n > 10' a.bin b.bin

# ---- refusals ----

grid='--nx 16 --dx 1um'
refuses 2 'no shape named: one of sphere\|cylinder\|paraboloid\|cone\|punch\|wave\|selfaffine' "no shape" "rc-synth $grid"
refuses 2 "unknown shape 'cube'" "an unknown shape" "rc-synth cube $grid"
refuses 2 "'wave' after sphere: one shape at a time" "two shapes" "rc-synth sphere wave $grid --radius 1mm"
refuses 2 'sphere needs --radius' "a sphere without radius" "rc-synth sphere $grid"
refuses 2 'cone needs --slope' "a cone without slope" "rc-synth cone $grid"
refuses 2 'punch needs --height' "a punch without height" "rc-synth punch --radius 1um $grid"
refuses 2 '--radius takes the two radii of a paraboloid, R1,R2' "a paraboloid of one radius" "rc-synth paraboloid --radius 1mm $grid"
refuses 2 '--radius takes one radius of a sphere, not 2' "a sphere of two radii" "rc-synth sphere --radius 1mm,2mm $grid"
refuses 2 '--radius takes one radius of a punch, not 3' "a punch of three" "rc-synth punch --height 1um --radius 1mm,2mm,3mm $grid"
refuses 2 '--edge has no meaning for cone' "a cone with an edge" "rc-synth cone --slope 0.1 --edge 1um $grid"
refuses 2 '--place has no meaning for wave' "a wave at a place" "rc-synth wave --amplitude 1um --wavelength 4um --place 0,0 $grid"
refuses 1 'no node lies within the radius 6e-07 m of the punch: take a finer grid' "a punch between the nodes" \
    "rc-synth punch --radius 0.6um --height 1um $grid"
refuses 2 '--place takes X,Y from the middle of the map, or, with --like, highest' "a place on a line" \
    "rc-synth cone --slope 0.1 --place 1um $grid"
refuses 2 '--place highest has no effect without --like' "the highest of nothing" "rc-synth cone --slope 0.1 --place highest $grid"
refuses 2 '--place 9e-06,0 m: beyond the map, which reaches to 8e-06 m and 8e-06 m' "a place beyond the map" \
    "rc-synth cone --slope 0.1 --place 9um,0 $grid"
rc-solve --quiet --output pressure --load 1N --estar 100GPa -o pressure.rcg rough.rcg
refuses 1 '--like pressure.rcg: no height frame is in it' "the highest of a pressure" \
    "rc-synth cone --slope 0.1 --place highest --like pressure.rcg"
printf 'NaN NaN\nNaN NaN\n' | rc-import --dx 1um --z-unit um -o missing.rcg - 2>/dev/null
refuses 1 '--like missing.rcg: no height was measured: --place highest is nowhere' "the highest of nothing measured" \
    "rc-synth cone --slope 0.1 --place highest --like missing.rcg"
refuses 2 '--direction 30: give --anisotropy too' "a lay without anisotropy" \
    "rc-synth selfaffine --hurst 0.8 --rms-height 1um --direction 30 $grid"
refuses 2 '--skewness does not work with --weibull' "two distributions" \
    "rc-synth selfaffine --hurst 0.8 --rms-height 1um --skewness 1 --weibull 2 $grid"
refuses 2 '--skewness 3.5: it must be at least -3 and at most 3' "more skewness than can be" \
    "rc-synth selfaffine --hurst 0.8 --rms-height 1um --skewness 3.5 $grid"
refuses 1 'anisotropy 2: a profile has one direction only' "a profile with a lay" \
    "rc-synth selfaffine --hurst 0.8 --rms-height 1um --anisotropy 2 --ny 1 $grid"
large="rc-synth selfaffine --hurst 0.8 --rms-height 1um --nx 1000 --dx 1um"
enough=18 # 7.6 MiB of heights, and the same for the waves
refuses 1 "needs at least [0-9]* MiB, --memory allows $enough MiB" "a distribution takes more memory" \
    "$large --skewness 1 --memory ${enough}M"
claim "a little more memory is enough" bash -c "$large --memory ${enough}M >/dev/null"
refuses 2 'wave needs --wavelength' "a wave without length" "rc-synth wave --amplitude 1um $grid"
refuses 2 'selfaffine needs --hurst' "roughness without exponent" "rc-synth selfaffine $grid"
refuses 2 'selfaffine needs one of --rms-slope and --rms-height' "roughness without size" \
    "rc-synth selfaffine --hurst 0.8 $grid"
refuses 2 '--rms-height does not work with --rms-slope' "roughness of two sizes" \
    "rc-synth selfaffine --hurst 0.8 --rms-slope 0.1 --rms-height 1um $grid"
refuses 2 '--hurst has no meaning for sphere' "an option of another shape" \
    "rc-synth sphere --radius 1mm --hurst 0.8 $grid"
refuses 2 'the grid is not known: give --nx and --dx, or --like' "no grid" "rc-synth sphere --radius 1mm"
refuses 2 'the grid is not known: give --nx and --dx' "half a grid" "rc-synth sphere --radius 1mm --nx 16"
refuses 2 '--like does not work with --ny' "two grids" "rc-synth sphere --radius 1mm --like other.rcg --ny 3"
refuses 2 '--radius 0 m: it must be above 0' "a radius of 0" "rc-synth sphere --radius 0 $grid"
refuses 2 '--nx 0: it must be at least 1' "no columns" "rc-synth sphere --radius 1mm --nx 0 --dx 1um"
refuses 2 '--nx 1.5: it must be a whole number' "half a column" "rc-synth sphere --radius 1mm --nx 1.5 --dx 1um"
refuses 2 '--hurst 1.1: it must be above 0 and at most 1' "an exponent above 1" "rc-synth selfaffine --hurst 1.1 --rms-slope 0.1 $grid"
refuses 2 '--wavelength 1.9e-06 m: shorter than two nodes 1e-06 m apart' "a wave between the nodes" \
    "rc-synth wave --amplitude 1um --wavelength 1.9um $grid"
refuses 2 'LX, or LX,LY' "no wave at all" "rc-synth wave --amplitude 1um --wavelength 0,0 $grid"
refuses 2 'LX, or LX,LY' "three waves" "rc-synth wave --amplitude 1um --wavelength 5,5,5 $grid"
refuses 1 'short cut-off 1e-06 m: the nodes hold wavelengths from 2e-06 m on' "a cut-off between the nodes" \
    "rc-synth selfaffine --hurst 0.8 --rms-slope 0.1 --short-cut 1um $grid"
refuses 1 'no wave of a map of .* lies between the wavelengths 1.5e-05 m and 1.55e-05 m' "cut-offs with nothing between" \
    "rc-synth selfaffine --hurst 0.8 --rms-slope 0.1 --short-cut 15um --long-cut 15.5um $grid"
refuses 1 '--like nowhere.rcg: No such file' "a grid like nothing" "rc-synth sphere --radius 1mm --like nowhere.rcg"
refuses 1 '--like /dev/null: the stream stops before it begins' "a grid like an empty file" \
    "rc-synth sphere --radius 1mm --like /dev/null"
printf 'RCGEND 0\n' >none.rcg
refuses 1 '--like none.rcg: no frame is in it' "a grid like an empty stream" "rc-synth sphere --radius 1mm --like none.rcg"
refuses 1 '16 x 16 nodes need about [0-9.]+ [KM]iB, --memory allows 1 KiB: ' "more memory than is allowed" "rc-synth sphere --radius 1mm --memory 1k $grid"
refuses 1 'No space left' "a full disk" "rc-synth sphere --radius 1mm $grid >/dev/full"
refuses 1 '1000000000 x 1000000000 (nodes need about [0-9]+ MiB, .* [0-9]+ MiB: take fewer|is more than this machine can address)' \
    "more nodes than any machine holds" \
    "rc-synth sphere --radius 1mm --nx 1000000000 --dx 1um"
refuses 1 'nodes need about 1 MiB, --memory allows 1 MiB: ' "a byte less than 1 MiB is no 1024 KiB" \
    "rc-synth sphere --radius 1mm --memory 1048575 --nx 362 --dx 1um"
# heights whose bytes almost fill the unit of the message; with half maps and code they exceed it
refuses 1 '999999489 x 658812625 nodes need about [0-9]+ MiB, .* [0-9]+ MiB: take fewer|is more than this machine can address' \
    "bytes that are nearly more than can be counted" \
    "rc-synth selfaffine --skewness 1 --hurst 0.8 --rms-height 1nm --nx 999999489 --ny 658812625 --dx 1nm"
refuses 2 '--radius -1 m: it must be above 0' "a bad option leaves no file" "rc-synth sphere $grid --radius -1 -o out.rcg"
claim "the values agree" test ! -e out.rcg
