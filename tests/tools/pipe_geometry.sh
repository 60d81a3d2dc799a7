# SPDX-License-Identifier: GPL-3.0-or-later
# rc-pick crops, resamples, mirrors and rotates all frames of a case in the same way, in the order of the
# command line. It removes keys that are no longer true for the map, and refuses invalid options.
. "$(dirname "$0")/../pipe.sh"

# values FILE: prints all values of a stream of f64 frames in their order.
values() {
    perl -0777 -ne 'while (/\GRCG1\n(.*?)\n\n/gcs) { my %k = map { split /=/, $_, 2 } split /\n/, $1;
        my $n = $k{nx} * $k{ny} * ($k{type} eq "f64" ? 8 : 4); /\G(.{$n})crc32 \w{8}\n/gcs or die; print $1 }' "$1"
}
# heights FILE: prints the rows of a small map in micrometres.
heights() {
    rc-export --format csv "$1" | grep -v '^[#"]' | tr ',\n' '  ' | tr -s ' '
}
export -f values heights

printf '1 2 3 4\n5 6 7 8\n9 10 11 12\n' | rc-import --dx 2um --dy 1um --z-unit m -o map.rcg -
map() { # map EXPECTED OPTION...: compares the rows of map.rcg after these options
    local expected=$1
    shift
    rc-pick --quiet "$@" map.rcg -o out.rcg && values out.rcg | perl -e '
        binmode STDIN; local $/; print join(" ", unpack "d<*", <STDIN>), "\n"' >got.txt &&
        { [ "$(cat got.txt)" = "$expected" ] || { cat got.txt >&2; false; }; }
}

# ---- turning ----

claim "after a turn by 90 degrees the right column is the top row" map '4 8 12 3 7 11 2 6 10 1 5 9' --rotate 90
rc-info --json out.rcg >info.json
near "$(field nx info.json)" 3 "$same" "its columns"
near "$(field dx info.json)" 1e-6 "$same" "its spacings have changed places"
near "$(field dy info.json)" 2e-6 "$same" "  both"
claim "a turn by 180 degrees is right" map '12 11 10 9 8 7 6 5 4 3 2 1' --rotate 180
claim "a turn by 270 degrees is right" map '9 5 1 10 6 2 11 7 3 12 8 4' --rotate 270
claim "--flip x exchanges left and right" map '4 3 2 1 8 7 6 5 12 11 10 9' --mirror x
claim "--flip y exchanges top and bottom" map '9 10 11 12 5 6 7 8 1 2 3 4' --mirror y
claim "the options act in their order" map '7 8' --rotate 90 --crop 1,0,1,2 --rotate 90 --mirror x
claim "  another order gives another map" map '2 6' --crop 1,0,3,3 --mirror x --rotate 90 --rotate 180 --crop 1,2,2,1 --mirror x

rough='rc-synth selfaffine --hurst 0.8 --rms-height 0.3um --nx 66 --ny 47 --dx 1.1um --dy 1um'
$rough -o rough.rcg
claim "four turns by 90 degrees change no bit" bash -c '
    rc-pick --rotate 90 rough.rcg | rc-pick --rotate 90 | rc-pick --rotate 90 --rotate 90 -o four.rcg &&
    cmp <(values rough.rcg) <(values four.rcg) && says "^dx=1.1e-06$" cat four.rcg'
claim "a turned periodic surface is periodic" says '^periodic=yes' cat four.rcg
claim "the history has the steps in their order" says 'rc-pick [0-9.]* --rotate 90 --mirror x --crop 1,2,30,20 --resample 2e-06m,2e-06m --resample 20x10$' bash -c '
    rc-pick --quiet --rotate 90 --mirror x --crop 1,2,30,20 --resample 2um --resample 20x10 rough.rcg | grep -a ^history'

# A rotated surface gives the rotated contact.
rc-solve --quiet --tol 1e-9 --load 0.1N --estar 100GPa --output pressure,height rough.rcg -o solved.rcg
rc-pick --rotate 90 rough.rcg | rc-solve --quiet --tol 1e-9 --load 0.1N --estar 100GPa --output pressure -o turned.rcg
claim "the solution of a turned surface is the turned solution" bash -c '
    rc-pick --channel pressure --rotate 90 solved.rcg | rc-pick --set channel=height --set unit=m -o x.rcg &&
    rc-pick --set channel=height --set unit=m turned.rcg | rc-add --subtract x.rcg - | rc-info --json >info.json'
rc-info --json x.rcg >pressure.json
near "$(awk -v a="$(field rms info.json)" -v b="$(field rms pressure.json)" 'BEGIN { print 1 + a / b }')" 1 1e-6 "  to the tolerance of both"
claim "all frames of a case are turned alike" bash -c '
    rc-pick --rotate 180 --crop 3,4,20,10 solved.rcg | rc-info --json >info.json &&
    [ "$(grep -c "\"nx\": 20, \"ny\": 10" info.json)" = 2 ]'

# ---- cutting ----

claim "--crop in nodes selects a part" map '7 8 11 12' --crop 2,1,2,2
claim "--crop in lengths counts from the edges of the first nodes" map '7 8 11 12' --crop 4um,1um,4um,2um
claim "  it takes the nodes whose centres are in the part" map '7 8 11 12' --crop 4.9um,0.6um,3.1um,2.4um
claim "  it may begin at 0" map '1 2' --crop 0,0,4um,1um
claim "it may be the whole map" map '1 2 3 4 5 6 7 8 9 10 11 12' --crop 0,0,8um,3um
claim "  the same holds in nodes" map '1 2 3 4 5 6 7 8 9 10 11 12' --crop 0,0,4,3
claim "a part of a periodic surface is not periodic, with a warning" warns 'a part of a periodic map is not periodic: it gets periodic=no' \
    rc-pick --crop 0,0,65,46 rough.rcg -o part.rcg
claim "  its key says so" says '^periodic=no' cat part.rcg
claim "the whole surface stays periodic" bash -c 'rc-pick --crop 0,0,66,47 rough.rcg -o whole.rcg 2>err.txt && [ ! -s err.txt ]'
claim "  its key says so" says '^periodic=yes' cat whole.rcg
rc-solve --quiet --periodic --load 0.1N --estar 100GPa --output pressure rough.rcg -o periodic.rcg
claim "a part of a solution has no load" bash -c '
    rc-pick --quiet --crop 0,0,30,30 periodic.rcg -o part.rcg && grep -aq "^estar=" part.rcg && lacks "^(load|boundary)=" part.rcg'
claim "  it is not periodic; a free boundary stays" bash -c '
    rc-pick --crop 0,0,30,30 solved.rcg >part.rcg && grep -aq "^boundary=free" part.rcg && lacks "^load=" part.rcg'
claim "a turned solution keeps load and boundary" bash -c 'rc-pick --rotate 90 periodic.rcg -o part.rcg && grep -aq "^load=" part.rcg && grep -aq "^boundary=periodic" part.rcg'
claim "counts of points are removed with the points" bash -c '
    rc-pick --set filled=3 --set outliers=2 --set form="sphere 0.002" --crop 1,1,2,2 map.rcg -o part.rcg && lacks "^(filled|outliers)=" part.rcg'
claim "  the key of an added sphere stays" says '^form=sphere 0.002' cat part.rcg
rc-stress --nu 0.3 --depths 0,5um --components mises,sxz solved.rcg -o stress.rcg
claim "stresses can be cropped" bash -c 'rc-pick --crop 3,4,20,10 stress.rcg | rc-info --json >info.json && [ "$(grep -c "\"nx\": 20, \"ny\": 10" info.json)" = 4 ]'

# ---- other spacings ----

claim "--resample takes means of pairs" map '1.5 3.5 5.5 7.5 9.5 11.5' --resample 4um,1um
claim "one factor holds for both directions" map '6.5' --resample 1x1
rc-info --json out.rcg >info.json
near "$(field dx info.json)" 8e-6 "$same" "as wide as the map"
near "$(field dy info.json)" 3e-6 "$same" "and as high"
claim "unchanged spacings change nothing" bash -c 'rc-pick --resample 1.1um,1um rough.rcg -o same.rcg && cmp <(values same.rcg) <(values rough.rcg)'
claim "  spacings that differ by less than a millionth change nothing" bash -c 'rc-pick --resample 1.1000005um,1um rough.rcg -o same.rcg && cmp <(values same.rcg) <(values rough.rcg) && says ^dx=1.1e-06$ cat same.rcg'
claim "one spacing holds for both directions" bash -c 'rc-pick --quiet --resample 2.2um rough.rcg | rc-info --json >info.json'
near "$(field nx info.json)" 33 "$same" "33 columns of 2.2 um"
near "$(field ny info.json)" 21 "$same" "21 rows of them fit in 47 um"
claim "a remainder is cut, and the surface is then not periodic" warns 'not periodic along y: it gets periodic=x' rc-pick --resample 2.2um rough.rcg -o part.rcg
claim "without a remainder it stays periodic" bash -c 'rc-pick --resample 33x94 rough.rcg -o fine.rcg 2>err.txt && [ ! -s err.txt ]'
claim "  its key says so" says '^periodic=yes' cat fine.rcg
claim "a profile stays a profile, with the width of its spacing" bash -c '
    rc-synth wave --amplitude 1um --wavelength 50um --nx 200 --ny 1 --dx 1um -o profile.rcg &&
    rc-pick --resample 0.5um profile.rcg | rc-info --json >info.json && rc-pick --resample 400x1 profile.rcg | rc-info --json >info2.json'
near "$(field nx info.json)" 400 "$same" "400 nodes"
near "$(field ny info.json)" 1 "$same" "in a row"
near "$(field dy info.json)" 5e-7 "$same" "of half the width"
near "$(field dy info2.json)" 5e-7 "$same" "  by numbers too"
# four nodes in 25 um: the error of the cubics is at most 1e-6
near "$(field rms info.json)" 7.0710678118654755e-07 1e-5 "the wave is still one"
claim "means over the whole map keep the load" bash -c 'rc-pick --resample 33x47 solved.rcg -o part.rcg && grep -aq ^load= part.rcg'
claim "  other means remove it" bash -c 'rc-pick --resample 132x47 solved.rcg -o part.rcg && lacks ^load= part.rcg'
printf '1 NaN\n1 NaN\n' | rc-import --dx 1um --z-unit m -o half.rcg -
claim "a mean over half of a cell counts as measured" bash -c '[ "$(rc-pick --resample 1x1 half.rcg | values - | perl -e "print unpack q(d<), <STDIN>")" = 1 ]'
claim "missing points stay missing on a finer grid" bash -c '
    rc-pick --resample 4x4 half.rcg | rc-info --json >info.json'
near "$(field missing info.json)" 8 "$same" "eight of sixteen"
claim "the command that rc-add proposes works" bash -c '
    rc-synth cone --slope 0.1 --nx 40 --dx 2um -o cone.rcg
    rc-add rough.rcg cone.rcg 2>err.txt >/dev/null
    command=$(sed -n "s/.*bring them together by //p" err.txt) &&
    [ "$command" = "rc-pick --resample 2e-06,2e-06 rough.rcg" ] && $command --quiet | rc-add - cone.rcg -o sum.rcg'

# The example of rc-synth(1): the apex of an indenter on the highest node of a surface.
rc-synth cone --slope 1 --place highest --like rough.rcg | rc-pick --mirror x | rc-add --quiet rough.rcg - -o cone.rcg
highest() {
    rc-export --format xyz "$1" | grep -v '^#' | sort -g -k 3,3 | tail -n 1 | cut -d ' ' -f 1-3
}
claim "a mirrored indenter has its tip on the highest node" test "$(highest cone.rcg)" = "$(highest rough.rcg)"

# ---- refusals ----

refuses 1 'map.rcg, case 1, frame 1 \(height\): --crop 3,0,2,1: 2 x 1 nodes from column 3 and row 0 on: the map has columns 0 to 3 and rows 0 to 2' \
    "beyond the map" "rc-pick --crop 3,0,2,1 map.rcg"
refuses 1 'crop 4e-06m,0,5e-06m,1e-06m: a part that begins at 4e-06 m and is 5e-06 m long is beyond the map, which is 8e-06 m there' "  in lengths" \
    "rc-pick --crop 4um,0,5um,1um map.rcg"
refuses 1 'the 2e-07 m from 0 m on contain no node, because nodes are 2e-06 m apart' "between nodes" "rc-pick --crop 0,0,0.2um,1um map.rcg"
refuses 1 'columns 0 to 3' "far beyond" "rc-pick --crop 9000000000000000,0,1,1 map.rcg"
refuses 1 'nodes need at least [0-9]{9,} MiB|4294967295 x 3 is more than this machine can address' "more nodes than memory has" \
    "rc-pick --resample 858993459200004x3 map.rcg"
for bad in 1,2,3 1,2,3,4,5 1,2,3um,4 1.5,2,3,4 1um,1um,2um,3 -1,0,1,1 0,0,0,1 0,0,1um,0 '' 1,,2,3 a,b,c,d 1e16,0,1,1; do
    refuses 2 "rc-pick: --crop $bad: " "--crop $bad" "rc-pick --crop '$bad' map.rcg"
done
refuses 2 'give four whole numbers .nodes., or four lengths with a unit' "  saying what is meant" "rc-pick --crop 1,2,3um,4 map.rcg"
for bad in 0 -1um 0x5 5x 5x5x5 1.5x2 1um,2um,3um x '' 1umx2; do
    refuses 2 "rc-pick: --resample $bad: " "--resample $bad" "rc-pick --resample '$bad' map.rcg"
done
refuses 2 'spacings DX or DX,DY are expected, or numbers of nodes, NXxNY' "  saying what is meant" "rc-pick --resample 5x map.rcg"
refuses 1 'a cell of 9e-06 m is wider than the map, 8e-06 m' "cells wider than the map" "rc-pick --resample 9um,1um map.rcg"
refuses 1 '\-\-resample 999999999999x999999999999: ' "more nodes than there can be" "rc-pick --resample 999999999999x999999999999 map.rcg"
refuses 1 '4 x 3 nodes need about [0-9.]+ [KM]iB, --memory allows 10 KiB' "more memory than is allowed" "rc-pick --memory 10k --resample 1000x1000 map.rcg"
refuses 2 '--mirror z: it must be x, left to right, or y, top to bottom' "a third axis" "rc-pick --mirror z map.rcg"
refuses 2 '--rotate 45: it must be 90, 180 or 270 degrees' "half a quarter" "rc-pick --rotate 45 map.rcg"
refuses 1 'selfaffine-seed-1, case 1, frame 1 \(sxz\): --mirror: stresses would change sign or places: do it to the pressure' "mirrored stresses" \
    "rc-pick --mirror x stress.rcg"
refuses 1 '\(sxz\): --rotate: stresses would change sign or places' "turned stresses" "rc-pick --channel sxz --rotate 90 stress.rcg"
rc-stress --nu 0.3 --section y=0 --depths 0:10um:5 --components mises solved.rcg -o section.rcg
for step in '--crop 0,0,2,2' '--resample 2um' '--mirror x' '--rotate 90'; do
    refuses 1 "\(mises\): ${step%% *}: a section is not a map: its rows are depths" "a section: $step" "rc-pick $step section.rcg"
done
rc-pick --set channel=psd --set unit=m4 rough.rcg -o psd.rcg
refuses 1 'a spectrum has its zero in the middle: do it to the surface' "a part of a spectrum" "rc-pick --crop 0,0,5,5 psd.rcg"
