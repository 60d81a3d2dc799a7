# SPDX-License-Identifier: GPL-3.0-or-later
# rc-import converts real files to height streams, and leaves no incomplete stream if it refuses a file.
. "$(dirname "$0")/../pipe.sh"

# header NAME FILE: prints a line of the first frame's header.
header() {
    head -c 4096 "$2" | grep -a "^$1=" | head -n 1 | sed "s/^$1=//"
}

# first_value FILE: prints the first value of the first frame, of type f64.
first_value() {
    local start
    start=$(sed -n '/^$/q; p' "$1" | wc -c)
    tail -c +$((start + 2)) "$1" | head -c 8 | od -An -t fD | tr -d ' '
}

printf '# Channel: Topo\n# Width: 6 um\n# Height: 5 um\n# Value units: nm\n1 2 3\n4 5 NaN\n' >map.txt
printf '1 2 3\n4 5 6\n7 8 9\n' >bare.txt

# ---- streams ----

claim "a text matrix becomes a stream" rc-import map.txt -o map.rcg
near "$(header dx map.rcg)" 2e-6 "$converted" "dx is the width over the columns"
near "$(header dy map.rcg)" 2.5e-6 "$converted" "dy is the height over the rows"
near "$(first_value map.rcg)" 1e-9 "$converted" "heights are in metres"
claim "the frame is called height" test "$(header channel map.rcg) $(header unit map.rcg)" = "height m"
claim "the source is the base name" test "$(header source map.rcg)" = map.txt
claim "a single file gives no case number" test -z "$(header case map.rcg)"
claim "the history has the tool and its version" grep -aq '^history=rc-import [0-9.]*$' map.rcg
claim "a file can come from a pipe" says '^nx=3$' bash -c 'cat map.txt | rc-import -'
claim "--type f32 sets the type" says '^type=f32$' rc-import --type f32 map.txt
rc-import map.txt ./map.txt map.txt >three.rcg
claim "several files give several cases" \
    test "$(grep -a '^case=' three.rcg | tr '\n' ' ')" = "case=1 case=2 case=3 "
claim "they form one stream" test "$(tail -n 1 three.rcg)" = "RCGEND 3"

cp map.txt good.txt
printf 'words and no more\n' >bad.txt
refuses 1 'bad.txt: ' "a bad file among several ends the import" 'rc-import good.txt bad.txt map.txt'
claim "--keep-going reads the other files and exits with 1" bash -c '
    rc-import --keep-going good.txt bad.txt map.txt >going.rcg 2>going.err
    [ $? -eq 1 ] && grep -q "^rc-import: bad.txt: " going.err'
claim "the stream of the other files is complete, with their case numbers" \
    test "$(grep -a '^case=\|^RCGEND\|^RCGFAIL' going.rcg | tr '\n' ' ')" = "case=1 case=3 RCGEND 2 "
refuses 1 'none of the 2 files can be read' "where none is good there is no stream" \
    'rc-import --keep-going bad.txt bad.txt'

# ---- keys added by the user ----

rc-import --dx 1.1um --z-unit nm bare.txt >bare.rcg
near "$(header dx bare.rcg)" 1.1e-6 "$converted" "--dx gives the spacing"
near "$(header dy bare.rcg)" 1.1e-6 "$converted" "dy defaults to dx"
near "$(first_value bare.rcg)" 1e-9 "$converted" "--z-unit gives the unit"
claim "the history has the given options in SI" \
    grep -aq '^history=rc-import [0-9.]* --dx 1.1e-06 --z-unit 1e-09$' bare.rcg
rc-import --dx 4um map.txt >wider.rcg 2>wider.err
near "$(header dx wider.rcg)" 4e-6 "$converted" "--dx wins over the file"
claim "a message says so" grep -q 'in x is 4e-06 m as given; the file says 2e-06 m' wider.err
claim "the history has it" grep -aq '^history=.* --dx 4e-06$' wider.rcg
claim "--quiet suppresses the message" bash -c '
    rc-import --quiet --dx 4um map.txt 2>quiet.err | cmp - wider.rcg && [ ! -s quiet.err ]'
printf '1|2\nlost|4,5\n' >odd.txt
rc-import --format ascii --dx 1um --z-unit 1e-6 --separator '|' --decimal , --missing lost odd.txt >odd.rcg
near "$(header nx odd.rcg)" 2 "$same" "--separator, --decimal and --missing read an odd file"

# ---- text ----

printf '\223NUMPY' >cut.npy
refuses 1 "the file is of version 0: 1 to 3 are read" "a format is known by its content" 'rc-import - <cut.npy'
formats=$(sed -n 's/^RC_FORMAT(\(.*\))$/\1/p' "$RC_SOURCE/formats/formats.list")
claim "formats.list has rows" test -n "$formats"
claim "--formats has a line for each reader, in order" \
    test "$(rc-import --formats | cut -d ' ' -f 1)" = "$formats"
# "X3P, SDF, ... (N names) and M more, packed" in the README: N + M of them
row=$(sed -n 's/^| `rc-import` .*(\(.*\) and \([0-9]*\) more, .*/\1; \2/p' "$RC_SOURCE/README.md")
claim "the README has the right number of formats" \
    test "$(($(tr -cd , <<<"$row" | wc -c) + 1 + ${row##*; }))" -eq "$(wc -w <<<"$formats")"
for format in $(rc-import --formats | cut -d ' ' -f 1); do
    section=$(awk -v s=".Ss $format" '$0 == s {on = 1; next} /^\.S[sh]/ {on = 0} on' \
        "$RC_SOURCE/man/rc-import.1")
    claim "the manual has a section about $format, with the ignored parts" grep -qi ignored <<<"$section"
done
claim "--formats prints the formats" says '^x3p ' rc-import --formats
claim "--list prints the channels" \
    says '^[*] +1 +3 +2 +2e-06 +2.5e-06 +m +1e-09 +5e-09 +Topo$' rc-import --list map.txt
claim "--list shows which figures the file lacks" \
    says '^[*] +1 +3 +3 +- +- +- +1 +9 +height$' rc-import --list bare.txt
claim "--channel accepts a number" says '^nx=3$' rc-import --channel 1 map.txt
claim "--channel accepts a name" says '^nx=3$' rc-import --channel Topo map.txt
if command -v script >/dev/null; then
    claim "--list may write to a terminal" says Topo script -qec "rc-import --list map.txt" /dev/null
    # a message for the terminal appears on the standard output of script, as a stream would
    claim "a stream may not" bash -c '
        script -qec "rc-import map.txt" /dev/null </dev/null >terminal.txt
        [ $? = 1 ] && grep -q "standard output is a terminal" terminal.txt && lacks RCG1 terminal.txt'
fi

# ---- refusals ----

refuses 2 "name the files to import, or -" "no file is a wrong command line" 'rc-import'
refuses 2 "--format xyzzy: no such format" "an unknown format is a wrong command line" 'rc-import --format xyzzy map.txt'
refuses 2 "--decimal x: it must be [.] or ," "so is a decimal mark that is none" 'rc-import --decimal x map.txt'
refuses 2 "--decimal and --separator are both ','" "and one that also separates" 'rc-import --decimal , --separator comma map.txt'
refuses 2 "--separator '1': .*one character that is not part of a number" "and a separator of digits" 'rc-import --separator 1 map.txt'
refuses 2 "--z-unit V: a unit of length" "and a unit that is not a length" 'rc-import --z-unit V map.txt'
refuses 2 "--dx 0 m: it must be above 0" "and a spacing of zero" 'rc-import --dx 0 map.txt'
refuses 1 "bare.txt: the file does not give the spacing in x: --dx LENGTH" "an absent spacing names the option" 'rc-import --z-unit nm bare.txt'
refuses 1 "bare.txt: the file does not give the unit of its heights: --z-unit" "an absent unit names the option" 'rc-import --dx 1um bare.txt'
refuses 1 "no channel 'Phase'; there are 1 'Topo'" "an absent channel names those present" \
    'rc-import --channel Phase map.txt'
rc-import map.txt | rc-export --format mat >whole.mat
head -c 400 whole.mat >cut.mat
refuses 1 "cut.mat: the variable at byte [0-9]+ promises more bytes than the file has" "a file cut off" 'rc-import cut.mat'
printf '\001\260\223\377%32s' '' >empty.mdt
refuses 1 "empty.mdt: the file ends before frame 1" "a header without what it promises" 'rc-import empty.mdt'
printf 'NRRD0004\ntype: float\nencoding: gzip\ndimension: 2\nsizes: 99999 99999\n\n' >bomb.nrrd
refuses 1 "bomb.nrrd: the header promises 99999 x 99999 heights in [0-9]+ bytes: the file is damaged" "a size that lies" 'rc-import bomb.nrrd'
printf 'KPK0\377\377\377\377PK' >lies.zon
refuses 1 "lies.zon: the picture takes 4294967295 bytes, the file has 10" "a length that lies" 'rc-import lies.zon'
refuses 1 "nowhere.txt: No such file" "a file that is not there" 'rc-import nowhere.txt'
refuses 1 "reading failed \(Is a directory\)" "a folder" 'rc-import .'
refuses 1 "the file is empty" "an empty file" 'rc-import /dev/null'
refuses 1 "line 2: 1 values, where the first row \(line 1\) has 2" "a row that is too short" \
    'printf "1 2\n3\n" | rc-import --dx 1um --z-unit um -'
refuses 1 "map.txt: reading it needs more memory than the 10 bytes of --memory" "a file that --memory has no room for" 'rc-import --memory 10 map.txt'
refuses 1 "writing failed \(No space left on device\)" "a full disk" 'rc-import map.txt >/dev/full'
refuses 1 "bare.txt: the file does not give the spacing" "the second of two files" 'rc-import map.txt bare.txt >half.rcg'
claim "a failed stream says that it failed" says '^RCGFAIL .*bare.txt' tail -n 1 half.rcg
refuses 1 "bare.txt: the file does not give the spacing" "with -o" 'rc-import map.txt bare.txt -o half2.rcg'
claim "no file is left" bash -c '! ls half2.rcg* 2>/dev/null'

# ---- real files ----

corpus="${RC_CORPUS:-}/corpus"
if [ -d "$corpus" ]; then
    # the manifest gives file, format, nx, ny, dx, dy and the value at the first point, with the units of x
    # and z in the file. tests/formats/format_corpus.c reads the other files
    awk -F '\t' '$2 ~ /^(x3p|ascii-matrix|sdf-ascii|digitalsurf-sur|wyko-opd|metropro-dat|alicona-al3d|sensofar-plu|nanoscope|nanosurf-nid|gsf|igor-ibw|mi-picoview|wsxm-stp|wsxm-top|bcrf|frt)$/ &&
        $11 == "m" && $13 == "m" && $1 !~ / / { print $1, $7, $8, $9, $10, $19 }' \
        "$RC_CORPUS/manifest.tsv" >rows.txt
    manifest=1e-12 # digits in the manifest
    heights=0
    while read -r file nx ny dx dy probes; do
        rc-import "$corpus/$file" >real.rcg 2>real.err
        claim "$file is read" test "$(tail -n 1 real.rcg)" = "RCGEND 1"
        claim "$file has its size" \
            test "$(header nx real.rcg) $(header ny real.rcg)" = "$nx $ny"
        near "$(header dx real.rcg)" "$dx" "$manifest" "$file: dx"
        near "$(header dy real.rcg)" "$dy" "$manifest" "$file: dy"
        case $probes in
        0,0,*)
            value=${probes#0,0,}
            near "$(first_value real.rcg)" "${value%%;*}" "$manifest" "$file: first height"
            heights=$((heights + 1))
            ;;
        esac
    done <rows.txt
    claim "the manifest had files of all these formats" test "$(wc -l <rows.txt)" -ge 30
    claim "their heights were compared" test $heights -ge 20
    claim "csafe-logo's wrong checksum is only a warning" \
        warns 51f0b43f25b587b72aa51b954c2134eb rc-import "$corpus/x3p/x3ptools__csafe-logo.x3p"
    bad=$corpus/bad
    refuses 1 "sample2.x3p: FeatureType PCL is a cloud of points" "a cloud of points" "rc-import '$bad/x3p__ISO5436-sample2.x3p'"
    refuses 1 "sample3.x3p: axis CY is of type 'A': only incremental axes" "an absolute axis" "rc-import '$bad/x3p__ISO5436-sample3.x3p'"
    refuses 1 "nonsense_txt_file.txt: not recognised: it has none of the formats" "prose" "rc-import '$bad/SurfaceTopography__nonsense_txt_file.txt'"
    refuses 1 "9 numbers in one column" "one column" "rc-import '$bad/SurfaceTopography__single_column.txt'"
    refuses 1 "a ZIP archive, but no X3P: it has no main.xml" "a ZIP archive of another kind" \
        "rc-import --format x3p '$bad/SurfaceTopography__mitutoyo_mock.xlsx'"
    claim "a list of points is distinguished from a matrix" says ': xyz$' rc-import --list --dx 1um --z-unit um \
        "$corpus/xyz/SurfaceTopography__xyz-1.txt"
    claim "a profile is distinguished too" says ': profile$' rc-import --list --dx 1um --z-unit um \
        "$corpus/profile-text/SurfaceTopography__xy-4.txt"
    di=$corpus/nanoscope/SurfaceTopography__di-4.di
    claim "--list has a line for each channel" \
        test "$(rc-import --list "$di" | grep -Ec '^[* ] +[123] +512 +512 ')" = 3
    claim "the line has its range" says 'm +-2.08215e-07 +2.72935e-07 Height Sensor$' \
        rc-import --list "$di"
    claim "another channel keeps its name and unit" bash -c "
        rc-import --channel Phase '$di' -o phase.rcg &&
        says 'channel=Phase nx=512 ny=512 .* unit=deg ' bash -c \"sed '/^\$/q' phase.rcg | tr '\\n' ' '\""
    claim "it can be chosen by its number" says '^file.channel=Amplitude Error' rc-import --channel 2 "$di"
    refuses 1 "no channel 'Topography'; there are 1 'Height Sensor' in m, 2 'Amplitude Error' in m" \
        "an absent channel names all" "rc-import --channel Topography '$di'"
    refuses 1 "its steps are 1 and 10 of a unit not given" "steps without a unit are named" \
        "rc-import '$corpus/surfer-grd/fatiando__simple_surfer.grd'"
    refuses 1 "the positions are not evenly spaced: point 61" "an uneven profile" \
        "rc-import --z-unit um '$corpus/profile-text/SurfaceTopography__xy-1.txt'"
else
    untried "RC_CORPUS names no folder of real files"
fi
