# SPDX-License-Identifier: GPL-3.0-or-later
# rc-info --areal, --psd and --patches: the figures of waves, random surfaces and contacts, as JSON and as
# text, and refusals.
. "$(dirname "$0")/../pipe.sh"

# ask FILE 'perl expression of $_': prints a value from the first line of JSON.
ask() {
    perl -MJSON::PP -MList::Util=sum,max -e '
        open my $f, "<", $ARGV[0] or die; $_ = decode_json(scalar <$f>);
        my $v = eval $ARGV[1]; die $@ if $@; print ref $v ? JSON::PP->new->canonical->encode($v) : $v // "null", "\n"' "$@"
}
near_to() { # FILE EXPRESSION EXPECTED TOLERANCE SENTENCE
    near "$(ask "$1" "$2")" "$3" "$4" "$5"
}

# ---- areal ----

rc-synth wave --amplitude 0.6um --wavelength 32um,40um --nx 160 --dx 1um -o wave.rcg
claim "areal parameters are written as JSON" bash -c 'rc-info --json --areal wave.rcg >wave.json'
claim "the object has these keys and no others" test "$(ask wave.json 'join " ", sort keys %{$_->{areal}}')" = \
    "rms_curvature sa sal sdq sdr sk sku smr1 smr2 sp spk sq ssk std str sv svk sxp sz vmc vmp vvc vvv"
near_to wave.json '$_->{areal}{sq}' 3e-7 "$summed" "Sq of a wave in both directions, half the amplitude"
near_to wave.json '$_->{areal}{sku}' 2.25 "$summed" "its Sku"
near_to wave.json '$_->{areal}{sa}' 2.4317084e-7 "$coarse_grid" "its Sa, 4/pi^2 of the amplitude"
near_to wave.json '$_->{areal}{sdq}' 0.0754306 "$coarse_grid" "its Sdq, pi A hypot(1/32, 1/40)"
near_to wave.json '$_->{areal}{sal}' 6.974359e-6 "$coarse_grid" "its Sal, where cos falls to 0.2 along the shorter wave"
near_to wave.json '$_->{areal}{sz} - $_->{areal}{sp} - $_->{areal}{sv} + 1' 1 "$summed" "Sz is Sp and Sv"
claim "the statistics are written too" says '"rms_slope": 0.07' cat wave.json
rc-synth wave --amplitude 1um --wavelength 20um --nx 80 --dx 1um -o ridges.rcg
rc-info --json --areal ridges.rcg >ridges.json
claim "the correlation of ridges never falls along the ridges" test "$(ask ridges.json '$_->{areal}{str}')" = null
near_to ridges.json '$_->{areal}{std} + 1' 1 "$summed" "waves along x: 0 degrees"
printf '5 5\n5 5\n' | rc-import --dx 1um --z-unit nm - | rc-info --json --areal >flat.json
claim "a flat surface has no skewness, kurtosis, correlation or direction" test \
    "$(ask flat.json 'join " ", grep { !defined $main::j->{areal}{$_} } sort keys %{($main::j = $_)->{areal}}')" = "rms_curvature sal sku ssk std str"

claim "the text of a map is printed" bash -c 'rc-info --areal wave.rcg >wave.out'
for line in '^  Sq +300 nm$' '^  Sku +2\.25$' '^  Sdq +0\.075[0-9]+$' '^  Sdr +0\.2[0-9]+ %$' '^  Std +[0-9.]+ deg$' \
    '^  Smr2 +[89][0-9.]+ %$' '^  Sxp +[0-9.]+ nm$'; do
    claim "  has the line $line" grep -qE "$line" wave.out
done
claim "  it names undefined parameters" says '^  Str +not defined: ridges run across the map' rc-info --areal ridges.rcg
rc-synth wave --amplitude 1um --wavelength 20um --nx 200 --ny 1 --dx 1um -o profile.rcg
claim "the text of a profile has the names of ISO 21920-2" bash -c 'rc-info --areal profile.rcg >profile.out'
for line in '^  Rq +707\.107 nm$' '^  Ra +6[0-9.]+ nm$' '^  Rku +1\.5$' '^  Rt +1\.97538 um$' '^  Rdq +0\.2[0-9]+$'; do
    claim "  has the line $line" grep -qE "$line" profile.out
done
claim "  it has no name of an areal parameter, and no direction" lacks '^  S|deg$' profile.out

# ---- holes ----

printf '1 2 NaN\n3 4 8\n' | rc-import --dx 1.1um --dy 1um --z-unit nm - -o holes.rcg
rc-info --json --areal holes.rcg >holes.json
near_to holes.json '$_->{areal}{sq}' 2.4166091947189146e-9 "$rounding" "Sq over what was measured: sqrt(29.2 / 5) nm"
# steps along x: 1, 1, 4 nm over 1.1 um; along y: 2, 2 nm over 1 um
near_to holes.json '$_->{areal}{sdq}' 2.9931050e-3 "$six_digits" "Sdq: the mean square of each direction by itself"
refuses 1 'holes|txt|standard input.*missing.*rc-detrend --fill' "a spectrum of holes, naming what fills them" "rc-info --psd holes.rcg"

claim "without a measured point none of the 23 parameters and 8 feature parameters is defined" test "$(printf 'NaN NaN\nNaN NaN\n' |
    rc-import --dx 1um --z-unit nm - | rc-info --areal | grep -c 'not defined')" = 31

# ---- spectra ----

rc-synth selfaffine --nx 256 --dx 0.5um --hurst 0.7 --rms-height 30nm --rolloff 40um --seed 2 -o rough.rcg
rc-pick --set periodic=no rough.rcg -o free.rcg
for map in rough free; do
    claim "the spectrum of a map is written ($map)" bash -c "rc-info --json --psd $map.rcg >$map.json"
    near_to $map.json 'my $p = $_->{psd}; sum(map { $p->{modes}[$_] * $p->{c}[$_] } 0 .. $#{$p->{q}}) / (128e-6) ** 2' \
        "$(ask $map.json '$_->{psd}{sum}')" 1e-9 "  waves times c over the area are the sum that is told"
    near_to $map.json '$_->{psd}{mean_square}' "$(ask $map.json '$_->{rms} ** 2')" 1e-9 "  beside Sq^2"
    near_to $map.json '$_->{psd}{hurst}' 0.7 0.0714 "  the Hurst exponent, to 0.05"
done
claim "  the default window is none for a periodic map, otherwise hann" test "$(ask rough.json '$_->{psd}{window}') $(ask free.json '$_->{psd}{window}')" = "none hann"
near_to rough.json '$_->{psd}{sum}' 9e-16 1e-9 "  without a window the sum is Sq^2"
rc-info --json --window none free.rcg >bare.json
claim "  --window none treats the map as periodic, and selects the spectrum" test "$(ask bare.json '$_->{psd}{c}')" = "$(ask rough.json '$_->{psd}{c}')"
near_to rough.json 'sum(@{$_->{psd}{modes}})' 65535 "$same" "  all waves but the mean are in a ring"
near_to rough.json '$_->{psd}{fit}[1]' 40e-6 0.3 "  the range that is found ends at the roll-off"
near_to rough.json '$_->{psd}{fit}[0]' 1e-6 0.05 "  and begins at two nodes"
rc-info --json --psd --fit 2um,30um rough.rcg >told.json
claim "  the fit uses the given range" test "$(ask told.json '$_->{psd}{fit}')" = '[2e-06,3e-05]'
near_to told.json '$_->{psd}{hurst}' 0.7 0.0714 "  and its exponent"
claim "  --fit alone selects the spectrum" says '^  Hurst +0\.[67][0-9]+ \+- 0\.0[0-9]+ \(wavelengths from 2 um to 30 um\)$' rc-info --fit 2um,30um rough.rcg
# Under a window a bow as high as the roughness has little effect: the slope from the spectrum is still the
# requested 0.14. All waves are counted except the lowest rings, which contain the bow.
rc-synth selfaffine --nx 256 --dx 0.5um --hurst 0.8 --rms-slope 0.14 --rolloff 20um --short-cut 2um --seed 3 -o steep.rcg
rc-synth sphere --nx 256 --dx 0.5um --radius 2mm -o bow.rcg
rc-add --quiet steep.rcg bow.rcg | rc-pick --set periodic=no -o bowed.rcg
rc-info --json --psd bowed.rcg >bowed.json
near_to bowed.json 'my $p = $_->{psd}; sqrt(sum(map { $p->{modes}[$_] * $p->{c}[$_] * $p->{q}[$_] ** 2 } 3 .. $#{$p->{q}}) / (128e-6) ** 2)' \
    0.14 0.03 "RMS slope by the spectrum of a free map with form"
claim "the text of a sum of surfaces is printed" says '^  sum +[0-9.e-]+ m2 \(Sq\^2 is [0-9.e-]+ m2\)$' rc-info --psd bowed.rcg
claim "the text of a spectrum is printed" says '^  psd +wavelength +q, rad/m +c, m4 +waves$' rc-info --psd rough.rcg
claim "  the text of the spectrum of a profile is printed" says 'c, m3' rc-info --psd profile.rcg
claim "  a spectrum without a power law says so" says '^  Hurst +not defined' rc-info --psd profile.rcg

claim "--psd-map writes the spectrum as a map" bash -c 'rc-info --psd --psd-map map.rcg rough.rcg >/dev/null && rc-info --json map.rcg >map.json'
claim "  it is a frame psd in m4 with the name of its window" test "$(ask map.json 'join " ", @$_{qw(channel unit nx)}, $_->{keys}{window}')" = "psd m4 256 none"
near_to map.json '$_->{dx}' 49087.385212340519 "$rounding" "  dx is 2 pi / 128 um"
near_to map.json '$_->{sum} / (128e-6) ** 2' 9e-16 1e-9 "  its sum over the area is Sq^2"
claim "  its history has the step, without the name of the file" says '\| rc-info [0-9.]+ --psd-map"' cat map.json
rc-synth wave --amplitude 1nm --wavelength 16um --nx 64 --ny 48 --dx 1um | rc-info --psd-map ridge.rcg - >/dev/null
# A^2 Lx Ly / 4 at 4 waves to the left and to the right of node (32, 24)
rc-export --format csv --channel psd ridge.rcg | grep -v '^#' | sed -n 25p | tr ',' '\n' >row.txt
near "$(sed -n 29p row.txt)" 7.68e-28 "$summed" "  the wave stands right of node (nx/2, ny/2)"
near "$(sed -n 37p row.txt)" 7.68e-28 "$summed" "  and left of it"

# ---- the unit of its spacings ----

# Of 64 x 48 nodes at 1 um the steps are 2 pi/64 um = 98174.77 and 2 pi/48 um = 130899.69 rad/m. The wave is 4
# steps to either side of wave number 0: at q = 2 pi/16 um = 392699.08 rad/m
claim "the spacings of a spectrum are in rad/m" test "$(rc-info --json ridge.rcg | perl -MJSON::PP -ne '$_ = decode_json($_); print "$_->{dunit} $_->{keys}{dunit}"')" = "rad/m rad/m"
claim "  rc-info prints this unit" says '^  grid +64 x 48 nodes, dx 98174.8 rad/m, dy 130900 rad/m$' rc-info ridge.rcg
claim "  rc-info prints the size" says '^  size +6\.28319e\+06 rad/m x 6\.28319e\+06 rad/m$' rc-info ridge.rcg
claim "  the spacings of heights stay in m" test "$(ask rough.json '$_->{dunit}')" = m
rc-export --format xyz ridge.rcg | LC_ALL=C sort -g -k3 | tail -2 | LC_ALL=C sort -g >two.txt
near "$(sed -n 1p two.txt | cut -d' ' -f1)" -392699.08169872413 "$rounding" "points: the wave stands at -q"
near "$(sed -n 2p two.txt | cut -d' ' -f1)" 392699.08169872413 "$rounding" "  and at q"
claim "  csv and xyz have the row qy = 0" test "$(cut -d' ' -f2 two.txt | tr '\n' ' ')" = "0 0 "
claim "csv has it in its rows" says '^# Width: 6283185\.30717958[0-9]* rad/m$' rc-export --format csv ridge.rcg
rc-export -o ridge.gsf ridge.rcg
claim "gsf has the unit" says '^XYUnits = rad/m$' head -c 300 ridge.gsf
# the left edge is half a cell left of column 0, which is 32 columns left of wave number 0
near "$(sed -n 's/^XOffset = //p' ridge.gsf)" -3190680.03880 1e-9 "  and where wave number 0 is"
near "$(sed -n 's/^YOffset = //p' ridge.gsf)" -3207042.50050 1e-9 "  along y too"
claim "  gsf of heights is in m, without an offset" bash -c 'rc-export --format gsf rough.rcg -o rough.gsf; head -c 200 rough.gsf | grep -a "^XYUnits = m$" && ! head -c 300 rough.gsf | grep -aq XOffset'
claim "gwy has the unit" bash -c 'rc-export -o ridge.gwy ridge.rcg && grep -aq rad/m ridge.gwy && grep -aq xoff ridge.gwy'
refuses 1 'sur says of its spacings that they are lengths, these are in rad/m' "a format of lengths only" "rc-export -o ridge.sur ridge.rcg"
claim "vti: column 0 is at -32 steps" bash -c 'rc-export -o ridge.vti ridge.rcg && head -c 400 ridge.vti | grep -a "Origin=\"-3141592\.65[0-9]* -3141592\.65"'
rc-pick --set channel=height ridge.rcg -o false.rcg
for tool in "rc-detrend --plane" "rc-solve --load 1N --estar 1GPa" "rc-info --areal" "rc-synth sphere --radius 1mm --like"; do
    refuses 1 'its dx and dy are in rad/m .key dunit.' "wave numbers are not lengths: $tool" "$tool false.rcg"
done
claim "a picture of the spectrum has its title and units" bash -c 'rc-render --log -o ridge.svg ridge.rcg && says ">Power spectral density<" cat ridge.svg &&
    says ">qx \\(10" cat ridge.svg && says ">qy \\(10" cat ridge.svg && says "rad/m" cat ridge.svg && lacks "Mm" ridge.svg'
claim "  a cut has them too" bash -c 'rc-render --cut y=0 -o cut.svg ridge.rcg && says "along qy = 0" cat cut.svg && lacks "km|Mm" cut.svg'
claim "  the cut passes through the nearest node, one step up" bash -c 'rc-render --cut x=1e5 -o cut.svg ridge.rcg && says "along qx = 98\\.17" cat cut.svg'
refuses 2 'cut y=3um: .*a number without a unit is expected' "a cut at a length" "rc-render --cut y=3um -o cut.svg ridge.rcg"
# from -4.5 to 4.5 steps there are nine columns, with the waves in the outermost ones
rc-render --raw --window=-441786:441786,-65000:65000 -o part.png ridge.rcg
claim "  a window selects nine nodes of a row" bash -c 'perl -e "undef \$/; open F, q(part.png); print join q( ), unpack(q(x16 N N), <F>)" | grep -qx "9 1"'
claim "with an odd number of nodes wave number 0 is in the middle" bash -c '
    rc-synth wave --amplitude 1nm --wavelength 3um --nx 9 --ny 7 --dx 1um | rc-info --psd-map odd.rcg - >/dev/null
    rc-export --format xyz odd.rcg | sed -n 32p | grep -q "^0 0 0$"'

# ---- patches ----

rc-synth sphere --radius 7.5mm --nx 128 --dx 8um | rc-solve --load 240N --estar 113.93GPa --quiet -o ball.rcg
claim "--patches finds the patches of a contact" bash -c 'rc-info --json --patches ball.rcg >ball.json'
claim "  one disc is one patch" test "$(ask ball.json '$_->{patches}{count}')" = 1
claim "  the object has these keys" test "$(ask ball.json 'join " ", sort keys %{$_->{patches}}')" = \
    "areas contact_area contact_area_corrected contact_nodes count largest_area perimeter perimeters pressure_histogram"
# pi a^2, a = (3 F R / 4 E*)^(1/3); the perimeter of a disc along cell edges is 8 a
near_to ball.json '$_->{patches}{contact_area}' 1.6305158e-7 0.02 "  its area is Hertz's but for nodes at the edge"
near_to ball.json '$_->{patches}{contact_area_corrected}' 1.6305158e-7 5e-3 "  corrected it is nearer"
near_to ball.json '$_->{patches}{perimeter}' 1.8225547e-3 0.05 "  the perimeter in steps is 8 radii"
near_to ball.json '$_->{patches}{contact_nodes} * 64e-12' "$(ask ball.json '$_->{patches}{contact_area}')" "$rounding" "  nodes and area are the same"
near_to ball.json 'sum @{$_->{patches}{pressure_histogram}{counts}}' "$(ask ball.json '$_->{patches}{contact_nodes}')" "$same" "  the histogram counts the nodes in contact"
near_to ball.json '$_->{patches}{pressure_histogram}{edges}[-1]' "$(ask ball.json '$_->{maximum}')" "$rounding" "  up to the largest pressure"
# in Hertz's contact half of the area carries more than sqrt(1/2) of the peak
near_to ball.json 'sum(@{$_->{patches}{pressure_histogram}{counts}}[0..34]) / $_->{patches}{contact_nodes}' 0.51 0.05 \
    "  49 % of it carry more than 0.7 of the largest"
claim "  other channels have no patches" test "$(rc-info --json --patches ball.rcg | grep -c patches)" = 1
claim "the text of patches is printed" bash -c 'rc-info --patches ball.rcg >ball.out'
for line in '^  patches +1$' '^  contact area +0\.16[0-9]+ mm2 \([0-9]+ nodes\)$' '^  corrected area +0\.16[0-9]+ mm2$' \
    '^  perimeter +1\.[0-9]+ mm$' '^  largest patch +0\.16[0-9]+ mm2 \([0-9]+ nodes\)$'; do
    claim "  has the line $line" grep -qE "$line" ball.out
done
printf '0 1 0\n1 0 1\n0 1 0\n' | rc-import --dx 1um --z-unit m - | rc-pick --set boundary=periodic |
    sed 's/^channel=height/channel=pressure/; s/^unit=m/unit=Pa/' | reseal >diamond.rcg
rc-pick --set boundary=free diamond.rcg -o apart.rcg
claim "on a periodic map four nodes around one are joined across the edges" says '^  patches +2$' rc-info --patches diamond.rcg
claim "  on a free map they are four patches" says '^  patches +4$' rc-info --patches apart.rcg
claim "without contact there is no patch" bash -c 'rc-pick --set a=b apart.rcg |
    rc-info --json --patches >one.json && printf "0 0\n0 0\n" | rc-import --dx 1um --z-unit m - |
    sed "s/^channel=height/channel=pressure/" | reseal | rc-info --json --patches >none.json'
claim "  its lists are empty" test "$(ask none.json 'my $p = $_->{patches}; [@$p{qw(count largest_area areas pressure_histogram)}]')" = \
    '[0,0,[],{"counts":[],"edges":[]}]'

# ---- refusals ----

refuses 1 '\-\-areal is of heights, and no frame is a height; there is: psd' "heights that are not there" "rc-info --areal map.rcg"
refuses 1 '\-\-patches is of pressures, .*there is: height' "pressures that are not there" "rc-info --patches rough.rcg"
refuses 2 '\-\-fit takes two wavelengths, the shortest first' "a range of one end" "rc-info --fit 2um rough.rcg"
refuses 2 '\-\-fit takes two wavelengths, the shortest first' "a range that is turned round" "rc-info --fit 3um,2um rough.rcg"
refuses 2 '\-\-window Hann: it must be one of none|hann' "a window that is none" "rc-info --window Hann rough.rcg"
refuses 1 'no two rings of waves from 0.001 m to 0.002 m' "a range without waves" "rc-info --fit 1mm,2mm rough.rcg"
refuses 1 '\-\-psd-map nowhere/x.rcg: No such file' "a folder that is not there" "rc-info --psd-map nowhere/x.rcg rough.rcg"
refuses 2 '\-\-psd-map -: standard output is for the figures' "a map among the figures" "rc-info --psd-map - rough.rcg"
refuses 1 'needs? (about|at least) .* MiB, --memory allows 1' "more memory than allowed" "rc-info --areal --memory 1M rough.rcg"
claim "failed commands leave no map" bash -c '
    cat rough.rcg holes.rcg >both.rcg; ! rc-info --psd-map left.rcg both.rcg >/dev/null 2>&1 &&
    [ -z "$(ls | grep "^left")" ]'


# ---- the manual ----

# The example in rc-info(1), line by line.
claim "the example of the manual prints the shown output" bash -c '
    rc-import "$RC_SOURCE/sample_surfaces/rough-steel.x3p" | rc-detrend --fill --poly 2 |
        rc-info --areal --psd --fit 10um,90um >example.out
    sed -n "/^among others:/,/^.Ed/p" "$RC_SOURCE/man/rc-info.1" | grep "^  " >example.txt
    [ "$(wc -l <example.txt)" -ge 10 ] && ! grep -vxFf example.out example.txt >&2'
