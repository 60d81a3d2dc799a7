# SPDX-License-Identifier: GPL-3.0-or-later
# rc-import reads the lengths of the file, and warns of implausible maps. They have a side above 1 m or below
# 10 nm, or heights that span more than the longer side.
. "$(dirname "$0")/../pipe.sh"

# an X3P file whose writer used micrometres instead of the metres of the standard: 300 x 200 points with a
# spacing of 7.8 "m"
rc-synth wave --nx 300 --ny 200 --dx 7.8m --amplitude 1.5m --wavelength 780m | rc-export -o um.x3p
claim "a map of kilometres is read as the standard says" says '^dx=7[.]8$' rc-import um.x3p
claim "a warning names the options that correct it" \
    warns '^rc-import: um.x3p: the map is 2340 m by 1560 m, which is implausible: if the file means another unit, --dx and --dy give the spacing$' \
    rc-import um.x3p
quiet() { "$@" >out.rcg 2>err.txt && [ ! -s err.txt ]; }
claim "it is printed once" test "$(rc-import um.x3p 2>&1 >out.rcg | wc -l)" = 1
claim "--quiet suppresses it" quiet rc-import --quiet um.x3p
rc-import --dx 7.8um --z-unit um um.x3p -o mended.rcg 2>mended.err
claim "--dx and --z-unit correct the map" \
    bash -c 'rc-info --json mended.rcg | tee mended.json | grep -q "\"dx\": 7.8e-06"'
near "$(sed 's/.*"maximum": \([^,}]*\).*/\1/' mended.json)" \
    "$(awk 'BEGIN { printf "%.17g", 1.5e-6 * cos(atan2(0, -1) / 100) }')" "$six_digits" "so are its heights" # beside the crest
claim "it causes no warning then" bash -c '! grep -q implausible mended.err'

matrix() { # WIDTH HEIGHT UNIT: writes 4 x 3 heights of 1 to 12
    printf '# Width: %s\n# Height: %s\n# Value units: %s\n1 2 3 4\n5 6 7 8\n9 10 11 12\n' "$@"
}
matrix '0.9 m' '0.9 m' nm >large.txt
claim "a map of less than a metre causes no warning" quiet rc-import large.txt
matrix '1.1 m' '0.9 m' nm >larger.txt
claim "a larger one does" warns 'larger.txt: the map is 1.1 m by 0.9' rc-import larger.txt
matrix '11 nm' '11 nm' pm >small.txt
claim "a map of more than 10 nm causes no warning" quiet rc-import small.txt
matrix '11 nm' '9 nm' pm >smaller.txt
claim "a smaller one does" warns 'smaller.txt: the map is 1.1e-08 m by 9' rc-import smaller.txt
claim "not if the spacing is given" quiet rc-import --quiet --dx 1m smaller.txt
matrix '10 um' '10 um' um >tall.txt # they span 11 um
claim "heights with a range above the longer side cause a warning" \
    warns 'tall.txt: the heights span 1.1e-05 m, more than the 1e-05 m of the longer side, which is implausible: .* --z-unit' \
    rc-import tall.txt
claim "a slightly smaller range causes none" quiet bash -c "rc-import <(sed 's/10 um/11.1 um/' tall.txt)"
claim "a given unit causes none" bash -c '! rc-import --z-unit um tall.txt 2>&1 >out.rcg | grep implausible'
saw() { # HEIGHT: teeth of this height in um, 2 um apart
    printf '# Width: 8 um\n# Height: 6 um\n# Value units: um\n0 %s 0 %s\n%s 0 %s 0\n0 %s 0 %s\n' "$1" "$1" "$1" "$1" "$1" "$1"
}
export -f saw
saw 7 >steep.txt
claim "an RMS slope of 3.5 causes a warning" warns 'the RMS slope is 3.5 \(74 degrees\), which is implausible' rc-import steep.txt
sed 's/ um/ mm/' steep.txt | grep -v '^#' >bare.txt
claim "  with a unit that was given too" \
    warns '^rc-import: bare.txt: the RMS slope is 3.5e\+03 \(90 degrees\), which is implausible: are --z-unit and the spacing right\?$' \
    rc-import --dx 2um --z-unit mm bare.txt
claim "  in one line" test "$(rc-import --dx 2um --z-unit mm bare.txt 2>&1 >steep.rcg | wc -l)" = 1
claim "  rc-info warns too" warns 'bare.txt, case 1, frame 1 \(height\): the RMS slope is [0-9.e+]* \(90 degrees\), which is implausible: if a unit is wrong, import' rc-info steep.rcg
claim "  and not of the right unit" bash -c 'saw 1 | grep -v "^#" | rc-import --dx 2um --z-unit um - 2>err | rc-info 2>>err >out && [ ! -s err ]'
saw 5 >flat.txt
claim "one of 2.5 causes none" quiet rc-import flat.txt
printf 'x [m] z [um]\n0 1\n1 2\n2 3\n' >long.txt
claim "the length of a profile is checked alone" warns 'long.txt: the profile is 3 m long, which is implausible: .* --dx gives the spacing$' \
    rc-import long.txt

# the check applies to the map of any file
rc-synth wave --nx 30 --ny 20 --dx 7.8m --amplitude 1.5m --wavelength 78m -o wide.rcg
for format in x3p sdf sdf-binary gsf gwy csv hdf5 sur mat; do
    rc-export --format $format wide.rcg >"wide.$format"
    claim "a map of 234 m in $format causes a warning" warns 'the map is 234 m by 156' rc-import "wide.$format"
done
