# rc-synth makes the surface that its options say on the grid that they say, and refuses options that
# are missing, contradict each other or mean nothing.
. "$(dirname "$0")/pipe.sh"
# With the address sanitizer, memory that cannot be had is still NULL.
export ASAN_OPTIONS=allocator_may_return_null=1

info() {
    "$@" | rc-info --json >info.json
}

# ---- the grid ----

claim "a sphere" info rc-synth sphere --radius 2.385mm --nx 33 --ny 47 --dx 1.1um --dy 1um
near "$(field nx info.json)" 33 "$same" "its columns"
near "$(field ny info.json)" 47 "$same" "its rows"
near "$(field dx info.json)" 1.1e-6 "$same" "its dx, to the last digit"
near "$(field dy info.json)" 1e-6 "$same" "its dy"
near "$(field maximum info.json)" 0 "$same" "its highest point"
# corner: x = 16 dx = 17.6 um, y = 23 dy = 23 um, -(x^2 + y^2) / 2R
near "$(field minimum info.json)" -1.7584067085953878e-07 "$converted" "its lowest point"
claim "it carries channel, unit and history, and is not periodic" bash -c '
    grep -q "\"channel\": \"height\".*\"unit\": \"m\".*\"type\": \"f64\"" info.json &&
    grep -q "\"history\": \"rc-synth [0-9.]* --nx 33 --ny 47 --dx 1.1e-06 --dy 1e-06 --radius 0.002385 sphere\"" info.json &&
    lacks periodic info.json'

claim "rows and dy follow columns and dx" info rc-synth sphere --radius 1mm --nx 9 --dx 2um
near "$(field ny info.json)" 9 "$same" "rows"
near "$(field dy info.json)" 2e-6 "$same" "dy"

claim "a grid like another one" bash -c '
    rc-synth sphere --radius 1mm --nx 7 --ny 5 --dx 1.3um --dy 1.7um --type f32 -o other.rcg &&
    rc-synth wave --amplitude 1um --wavelength 4um --like other.rcg | rc-info --json >info.json &&
    rc-synth wave --amplitude 1um --wavelength 4um --like - <other.rcg | rc-info --json >info2.json'
near "$(field nx info.json)" 7 "$same" "its columns"
near "$(field ny info.json)" 5 "$same" "its rows"
near "$(field dx info.json)" 1.3e-6 "$same" "its dx"
near "$(field dy info.json)" 1.7e-6 "$same" "its dy"
claim "also from standard input, and no file name is in it" bash -c '
    cmp info.json info2.json && lacks other info.json'

claim "single precision when asked" says '"type": "f32"' rc-info --json other.rcg

# ---- waves ----

# 40 nodes are 4 wavelengths of 11 um: the mean square of a cosine is 1/2, of two 1/4
claim "a wave" info rc-synth wave --amplitude 0.3um --wavelength 11um --nx 40 --ny 3 --dx 1.1um
near "$(field rms info.json)" 2.1213203435596426e-07 "$rounding" "RMS of a cosine"
claim "it fits the map" grep -q '"periodic": "yes"' info.json
claim "two waves" info rc-synth wave --amplitude 0.3um --wavelength 11um,9um --nx 40 --ny 27 \
    --dx 1.1um --dy 1um
near "$(field rms info.json)" 1.5e-07 "$rounding" "RMS of the product of two"
claim "they fit the map" grep -q '"periodic": "yes"' info.json
claim "a wave along y alone" info rc-synth wave --amplitude 0.3um --wavelength 0,9um --nx 5 \
    --ny 27 --dx 1um
near "$(field rms info.json)" 2.1213203435596426e-07 "$rounding" "RMS of a cosine"
claim "a wave that does not fit" info rc-synth wave --amplitude 0.3um --wavelength 11um --nx 41 \
    --dx 1.1um
claim "is not periodic" lacks periodic info.json

# ---- roughness ----

rough='rc-synth selfaffine --hurst 0.73 --nx 128 --ny 97 --dx 1.1um --dy 1um'
claim "roughness of a given height" bash -c "$rough --rms-height 0.42um | rc-info --json >info.json"
near "$(field rms info.json)" 0.42e-6 "$rounding" "its RMS height"
claim "it is periodic" grep -q '"periodic": "yes"' info.json
# waves of 20 nodes and more: differences between nodes see all but some per cent of the slope
claim "roughness of a given slope" bash -c \
    "$rough --rms-slope 0.23 --short-cut 20um | rc-info --json >info.json"
near "$(field rms_slope info.json)" 0.23 0.02 "its RMS slope"
claim "the same seed gives the same bytes, whatever the threads" bash -c "
    $rough --rms-slope 0.1 --seed 7 --threads 1 -o a.rcg &&
    $rough --rms-slope 0.1 --seed 7 --threads 2 -o b.rcg && cmp a.rcg b.rcg"
# the values alone: before the last two lines, 24 bytes
values() {
    tail -c $((8 * 128 * 97 + 24)) "$1" | head -c $((8 * 128 * 97))
}
claim "the default seed is 1" bash -c "
    $rough --rms-slope 0.1 -o b.rcg && $rough --rms-slope 0.1 --seed 1 -o one.rcg"
claim "  indeed" cmp <(values b.rcg) <(values one.rcg)
values a.rcg >a.bin
values b.rcg >b.bin
claim "another seed gives other heights" perl -e '
    my @v = map { open my $f, "<:raw", $_ or die; local $/; [unpack "d<*", <$f>] } @ARGV;
    my $n = 0;
    $n += $v[0][$_] == $v[1][$_] for 0 .. 128 * 97 - 1;
    exit $n > 10' a.bin b.bin

# ---- refusals ----

grid='--nx 16 --dx 1um'
refuses 2 'no shape named: one of sphere\|wave\|selfaffine' "no shape" "rc-synth $grid"
refuses 2 "unknown shape 'cube'" "an unknown shape" "rc-synth cube $grid"
refuses 2 "'wave' after sphere: one shape at a time" "two shapes" "rc-synth sphere wave $grid --radius 1mm"
refuses 2 'sphere needs --radius' "a sphere without radius" "rc-synth sphere $grid"
refuses 2 'wave needs --wavelength' "a wave without length" "rc-synth wave --amplitude 1um $grid"
refuses 2 'selfaffine needs --hurst' "roughness without exponent" "rc-synth selfaffine $grid"
refuses 2 'selfaffine needs one of --rms-slope and --rms-height' "roughness without size" \
    "rc-synth selfaffine --hurst 0.8 $grid"
refuses 2 'selfaffine needs one of --rms-slope and --rms-height: the other one follows' "roughness of two sizes" \
    "rc-synth selfaffine --hurst 0.8 --rms-slope 0.1 --rms-height 1um $grid"
refuses 2 '--hurst has no meaning for sphere' "an option of another shape" \
    "rc-synth sphere --radius 1mm --hurst 0.8 $grid"
refuses 2 'the grid is not known: give --nx and --dx, or --like' "no grid" "rc-synth sphere --radius 1mm"
refuses 2 'the grid is not known: give --nx and --dx' "half a grid" "rc-synth sphere --radius 1mm --nx 16"
refuses 2 '--like gives the whole grid: leave out --ny' "two grids" "rc-synth sphere --radius 1mm --like other.rcg --ny 3"
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
refuses 1 '16 x 16 nodes of sphere need 2048 bytes, more than --memory allows' "more memory than is allowed" "rc-synth sphere --radius 1mm --memory 1k $grid"
refuses 1 'No space left' "a full disk" "rc-synth sphere --radius 1mm $grid >/dev/full"
refuses 1 'out of memory for a map of 1000000000 x 1000000000 nodes' "more nodes than any machine holds" \
    "rc-synth sphere --radius 1mm --nx 1000000000 --dx 1um"
refuses 2 '--radius -1 m: it must be above 0' "a bad option leaves no file" "rc-synth sphere $grid --radius -1 -o out.rcg"
claim "indeed" test ! -e out.rcg

finish
