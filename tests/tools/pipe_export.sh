# SPDX-License-Identifier: GPL-3.0-or-later
# rc-export writes the selected frames, completely or not at all, and refuses frames that a format cannot
# hold.
. "$(dirname "$0")/../pipe.sh"

rc-synth wave --wavelength 16um --amplitude 1um --nx 32 --ny 24 --dx 1um --dy 1.5um -o one.rcg
rc-synth sphere --radius 2mm --nx 32 --dx 4um |
    rc-solve --quiet --load 1N --estar 114GPa -o many.rcg
rc-stress --nu 0.3 --depths 0,5um,20um --components mises,szz many.rcg >deep.rcg

# ---- the format ----

for name in x3p sdf gsf gwy npy vti vtr csv xyz h5 hdf5 sur bsdf mat stl; do
    claim "the format of the suffix .$name is used" rc-export one.rcg -o "by.$name"
done
claim ".x3p is an archive" says '^PK$' head -c 2 by.x3p
claim ".bsdf is binary SDF" says '^bISO-1.0$' head -c 8 by.bsdf
claim "--format has priority over the suffix" bash -c '
    rc-export --format gsf one.rcg -o by.dat && says "^Gwyddion Simple Field" head -n 1 by.dat'
claim "--formats prints the table" says '^x3p +\.x3p +i16 i32 f32 f64 +one map' rc-export --formats
refuses 2 "which format\? --format NAME says it" "no format is a wrong command line" 'rc-export one.rcg'
refuses 2 "-o a.png: no format has this suffix" "so is a suffix of none" 'rc-export one.rcg -o a.png'
refuses 2 "--format png: no such format" "and a name of none" 'rc-export --format png one.rcg'
refuses 2 "--type f64: gsf holds only f32" "and a type that the format lacks" \
    'rc-export --format gsf --type f64 one.rcg'
refuses 2 "--type f64: csv is text and has no types" "and one for text" 'rc-export --format csv --type f64 one.rcg'
refuses 2 "--missing: npy is not a text format and marks missing points by its own rule" "--missing is for text" \
    'rc-export --format npy --missing X one.rcg'
refuses 2 "--missing 'a b': one word without blanks" "and takes one word" 'rc-export --format csv --missing "a b" one.rcg'

# ---- the output file ----

claim "text goes to standard output" says '^# Width: 3.2' rc-export --format csv one.rcg
claim "binary data goes to standard output if it is a pipe" \
    bash -c 'rc-export --format npy one.rcg | cmp - by.npy'
claim "the stream can come from a pipe" bash -c 'rc-export --format npy <one.rcg | cmp - by.npy'
if command -v script >/dev/null; then
    claim "text is written to a terminal" \
        says Channel script -qec "rc-export --format csv one.rcg" /dev/null
    # a message for the terminal appears on the standard output of script, as written numbers would
    claim "binary data is never written to a terminal" bash -c '
        script -qec "rc-export --format npy one.rcg" /dev/null </dev/null >terminal.txt
        [ $? = 1 ] && grep -q "standard output is a terminal" terminal.txt && lacks NUMPY terminal.txt'
fi
head -c 3000 one.rcg >cut.rcg
for name in x3p gwy csv vti h5; do
    refuses 1 'cut.rcg, frame 1: the stream stops inside the values' "a cut stream, .$name" "rc-export cut.rcg -o cut.$name"
done
claim "a refused command leaves no file" test "$(echo cut.*)" = cut.rcg
echo old >kept.csv
refuses 1 'the stream stops' "the same where there is a file" 'rc-export cut.rcg -o kept.csv'
claim "the old file stays" test "$(cat kept.*)" = old
refuses 1 "No space left" "a full device is told" 'rc-export --format npy one.rcg >/dev/full'
refuses 1 "No space left" "with text too" 'rc-export --format xyz one.rcg >/dev/full'

# ---- contents of the file ----

refuses 1 "a second frame, but gsf holds one map" "one map is one frame" 'rc-export -o a.gsf many.rcg'
refuses 1 "a second frame of channel mises" "several of one channel too" \
    'rc-export -o a.gsf --channel mises deep.rcg'
claim "--channel selects the channel" rc-export --channel height many.rcg -o height.x3p
refuses 1 "no frame with the channel strain, only pressure, gap, displacement, height" \
    "an absent channel names those present" 'rc-export -o a.npy --channel strain many.rcg'
refuses 1 "heights in metres, but these values are in 'Pa'" "metres are metres" \
    'rc-export -o a.x3p --channel pressure many.rcg'
claim "the name of the unit is written if it has one" \
    says '^ZUnits = Pa' rc-export --format gsf --channel pressure many.rcg
claim "frames become arrays" says '^4$' bash -c '
    rc-export --format vti many.rcg | grep -ac "Name=\"\(pressure\|gap\|displacement\|height\)\""'
refuses 1 "the depths have uneven steps.*: write vtr" "an image wants even depths" 'rc-export -o a.vti deep.rcg'
claim "vtr has no such arrays" rc-export --format vtr -o a.vtr deep.rcg
claim "a list of channels is accepted" \
    bash -c 'rc-export --format vtr --channel mises,szz deep.rcg | cmp - a.vtr'
refuses 1 "the stream has no frame" "an empty stream" 'printf "RCGEND 0\n" | rc-export --format csv'
refuses 1 "need about [0-9.]+ [KM]iB, --memory allows 2 KiB: " "--memory is minded" 'rc-export --memory 2K --format csv one.rcg'
rc-synth sphere --radius 1m --nx 1000 --dx 1um -o large.rcg
claim "the memory of one frame is within --memory" bash -c "rc-export --memory 12M --format vti large.rcg >/dev/null"
refuses 1 "frame 2: 1000 x 1000 nodes need about .*, --memory allows" "by all frames together" \
    "cat large.rcg large.rcg | rc-export --memory 12M --format vti"

# ---- reliefs ----

claim "--dry-run prints the size of a relief" \
    warns '^rc-export: stl: a block of 89[.]8[56] x 100 x 7 mm, .* times the map, .*; 1750 triangles, 87584 bytes$' \
    rc-export --verbose --relief 5mm one.rcg -o relief.stl
claim "the file has this size" test "$(wc -c <relief.stl)" -eq 87584
refuses 2 "--relief: csv keeps the heights" "other formats are none" 'rc-export --format csv --relief 5mm one.rcg'

# ---- export and import ----

back() { # FILE: its heights, read by rc-import, equal those of one.rcg bit for bit
    rc-import "$1" | rc-export --format npy | cmp - by.npy
}
claim "X3P is read back bit for bit" back by.x3p
claim "CSV is read back bit for bit" back by.csv
claim "MAT is read back bit for bit" back by.mat
if python3 -c 'import scipy.io' 2>/dev/null; then
    claim "scipy reads the array of MAT with its spacings and units" python3 - <<'END'
import numpy, scipy.io
mat, npy = scipy.io.loadmat('by.mat'), numpy.load('by.npy')
assert (mat['height'] == npy).all() and mat['height'].shape == (24, 32)
assert mat['dx'] == 1e-6 and mat['dy'] == 1.5e-6 and mat['unit'] == 'm' and mat['dunit'] == 'm'
END
else
    untried "MAT in scipy, because that is not here"
fi
claim "the history is written, with this step" bash -c '
    rc-export --format x3p --type i16 one.rcg >h.x3p &&
        says "<Comment>rc-synth .* \| rc-export [0-9.]* --format x3p --type i16</Comment>" unzip -p h.x3p main.xml'
printf '1 2 3\n4 NaN 6\n' >map.txt
rc-import --dx 1um --z-unit um map.txt -o map.rcg
rc-export map.rcg -o map.x3p
claim "a missing point is read back as missing" says 'missing +1 ' bash -c 'rc-import map.x3p | rc-info'
claim "--missing sets the value of missing points" says ' NaN ' rc-export --format sdf --missing NaN map.rcg
claim "its default depends on the format" says ' BAD ' rc-export --format sdf map.rcg
SOURCE_DATE_EPOCH=86400 rc-export one.rcg -o dated.sdf
claim "SOURCE_DATE_EPOCH sets the date" grep -q '^CreateDate  = 020119700000$' dated.sdf
SOURCE_DATE_EPOCH=86400 rc-export one.rcg -o a.x3p
step=$(($(date +%s) / 2)) # a ZIP archive has the time in steps of two seconds
until [ $(($(date +%s) / 2)) != "$step" ]; do sleep 0.02; done
SOURCE_DATE_EPOCH=86400 rc-export one.rcg -o b.x3p
claim "equal dates give equal files" cmp a.x3p b.x3p
refuses 2 "SOURCE_DATE_EPOCH=today: it must be seconds since 1970" "and must be a number" \
    'SOURCE_DATE_EPOCH=today rc-export --format csv one.rcg'
rc-synth selfaffine --nx 32 --dx 1um --hurst 0.8 --rms-height 10nm |
    rc-solve --load 100mN --estar 100GPa --tol 1e-18 --output pressure --quiet -o short.rcg
refuses 3 'converged=no' "an unfinished solution says so" 'rc-export short.rcg -o short.npy'
claim "the file is written" test -s short.npy
