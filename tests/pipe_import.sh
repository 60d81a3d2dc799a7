# rc-import turns real files into height streams, and what it refuses leaves no half of one.
. "$(dirname "$0")/pipe.sh"

# header NAME FILE: a line of the first frame's header.
header() {
    head -c 4096 "$2" | grep -a "^$1=" | head -n 1 | sed "s/^$1=//"
}

# first_value FILE: the first value of the stream's first frame, of type f64.
first_value() {
    local start
    start=$(sed -n '/^$/q; p' "$1" | wc -c)
    tail -c +$((start + 2)) "$1" | head -c 8 | od -An -t fD | tr -d ' '
}

printf '# Channel: Topo\n# Width: 6 um\n# Height: 5 um\n# Value units: nm\n1 2 3\n4 5 NaN\n' >map.txt
printf '1 2 3\n4 5 6\n7 8 9\n' >bare.txt

# ---- streams ----

claim "a text matrix becomes a stream" rc-import map.txt -o map.rcg
near "$(header dx map.rcg)" 2e-6 1e-15 "dx is the width over the columns"
near "$(header dy map.rcg)" 2.5e-6 1e-15 "dy is the height over the rows"
near "$(first_value map.rcg)" 1e-9 1e-15 "heights are in metres"
claim "the frame is called height" test "$(header channel map.rcg) $(header unit map.rcg)" = "height m"
claim "the source is the base name" test "$(header source map.rcg)" = map.txt
claim "one file makes no case number" test -z "$(header case map.rcg)"
claim "history names tool and version" grep -aq '^history=rc-import [0-9.]*$' map.rcg
claim "a pipe does as well as a file" bash -c 'cat map.txt | rc-import - | grep -aq "^nx=3$"'
claim "--type f32 is obeyed" bash -c 'rc-import --type f32 map.txt | grep -aq "^type=f32$"'
rc-import map.txt ./map.txt map.txt >three.rcg
claim "several files are several cases" \
    test "$(grep -a '^case=' three.rcg | tr '\n' ' ')" = "case=1 case=2 case=3 "
claim "and one stream" test "$(tail -n 1 three.rcg)" = "RCGEND 3"

# ---- what the user adds ----

rc-import --dx 1.1um --z-unit nm bare.txt >bare.rcg
near "$(header dx bare.rcg)" 1.1e-6 1e-15 "--dx gives the spacing"
near "$(header dy bare.rcg)" 1.1e-6 1e-15 "dy defaults to dx"
near "$(first_value bare.rcg)" 1e-9 1e-15 "--z-unit gives the unit"
claim "history holds what was given, in SI" \
    grep -aq '^history=rc-import [0-9.]* --dx 1.1e-06 --z-unit 1e-09$' bare.rcg
rc-import --dx 4um map.txt >wider.rcg 2>wider.err
near "$(header dx wider.rcg)" 4e-6 1e-15 "--dx wins over the file"
claim "which is said" grep -q 'in x is 4e-06 m as given; the file says 2e-06 m' wider.err
claim "and kept in history" grep -aq '^history=.* --dx 4e-06$' wider.rcg
rc-import --quiet --dx 4um map.txt >/dev/null 2>quiet.err
claim "--quiet says nothing" test ! -s quiet.err
printf '1|2\nlost|4,5\n' >odd.txt
rc-import --format ascii --dx 1um --z-unit 1e-6 --separator '|' --decimal , --missing lost odd.txt >odd.rcg
near "$(header nx odd.rcg)" 2 0 "--separator, --decimal and --missing read an odd file"

# ---- text ----

printf '\223NUMPY' >cut.npy
refuses 1 "of version 0" "a format is known by its content" 'rc-import - <cut.npy'
formats=$(sed -n 's/^RC_FORMAT(\(.*\))$/\1/p' "$RC_SOURCE/formats/formats.list")
claim "--formats has a line for each reader, in order" \
    test "$(rc-import --formats | cut -d ' ' -f 1)" = "$formats"
# "reads X3P, SDF, ... (N names) and M more" in the README: N + M of them
row=$(sed -n 's/^| `rc-import` .*(\(.*\) and \([0-9]*\) more).*/\1; \2/p' "$RC_SOURCE/README.md")
claim "the README counts them right" \
    test "$(($(tr -cd , <<<"$row" | wc -c) + 1 + ${row##*; }))" -eq "$(wc -w <<<"$formats")"
for format in $(rc-import --formats | cut -d ' ' -f 1); do
    section=$(awk -v s=".Ss $format" '$0 == s {on = 1; next} /^\.S[sh]/ {on = 0} on' \
        "$RC_SOURCE/man/rc-import.1")
    claim "the manual has a section on $format, which says what is ignored" grep -qi ignored <<<"$section"
done
claim "--formats prints the formats" bash -c 'rc-import --formats | grep -q "^x3p "'
claim "--list prints the channels" \
    bash -c 'rc-import --list map.txt | grep -Eq "^ +1 +3 +2 +2e-06 +2.5e-06 +m +[-0-9.e]+ +[-0-9.e]+ +Topo$"'
claim "--list shows what the file does not say" \
    bash -c 'rc-import --list bare.txt | grep -Eq "^ +1 +3 +3 +- +- +- +[-0-9.e]+ +[-0-9.e]+ +height$"'
claim "--channel takes a number" bash -c 'rc-import --channel 1 map.txt | grep -aq "^nx=3$"'
claim "--channel takes a name" bash -c 'rc-import --channel Topo map.txt | grep -aq "^nx=3$"'
if command -v script >/dev/null; then
    claim "--list writes even to a terminal" \
        bash -c 'script -qec "rc-import --list map.txt" /dev/null </dev/null | grep -q Topo'
    claim "a stream does not" \
        bash -c '! script -qec "rc-import map.txt" /dev/null </dev/null | grep -q RCG1'
fi

# ---- refusals ----

refuses 2 "name the files" "no file is a wrong command line" 'rc-import'
refuses 2 "no such format" "an unknown format is a wrong command line" 'rc-import --format xyzzy map.txt'
refuses 2 "must be . or ," "so is a decimal mark that is none" 'rc-import --decimal x map.txt'
refuses 2 "both ','" "and one that also separates" 'rc-import --decimal , --separator comma map.txt'
refuses 2 "one character" "and a separator of digits" 'rc-import --separator 1 map.txt'
refuses 2 "unit of length" "and a unit that is no length" 'rc-import --z-unit V map.txt'
refuses 2 "above 0" "and a spacing of zero" 'rc-import --dx 0 map.txt'
refuses 1 "bare.txt: .*--dx LENGTH" "an absent spacing names the option" 'rc-import --z-unit nm bare.txt'
refuses 1 "bare.txt: .*--z-unit" "an absent unit names the option" 'rc-import --dx 1um bare.txt'
refuses 1 "no channel 'Phase'; there are 1 'Topo'" "an absent channel names those present" \
    'rc-import --channel Phase map.txt'
refuses 1 "nowhere.txt: No such file" "a file that is not there" 'rc-import nowhere.txt'
refuses 1 "reading failed" "a folder" 'rc-import .'
refuses 1 "the file is empty" "an empty file" 'rc-import /dev/null'
refuses 1 "gzip" "a compressed file" 'gzip -c map.txt | rc-import -'
refuses 1 "line 2: 1 values" "a row that is too short" \
    'printf "1 2\n3\n" | rc-import --dx 1um --z-unit um -'
refuses 1 "--memory" "a file that --memory has no room for" 'rc-import --memory 10 map.txt'
refuses 1 "writing failed|No space" "a full disk" 'rc-import map.txt >/dev/full'
refuses 1 "bare.txt" "the second of two files" 'rc-import map.txt bare.txt >half.rcg'
claim "then the stream says that it failed" grep -aq '^RCGFAIL ' half.rcg
refuses 1 "bare.txt" "with -o" 'rc-import map.txt bare.txt -o half2.rcg'
claim "nothing is left behind" bash -c '! ls half2.rcg* 2>/dev/null'

# ---- real files ----

corpus="${RC_CORPUS:-}/corpus"
if [ -d "$corpus" ]; then
    # file, format, nx, ny, dx, dy and the probe at the first point, as the manifest has them
    # with the unit of x and z in the file: the others are read by tests/format_corpus
    awk -F '\t' '$2 ~ /^(x3p|ascii-matrix|sdf-ascii|digitalsurf-sur|wyko-opd|metropro-dat|alicona-al3d|sensofar-plu|nanoscope|nanosurf-nid|gsf|igor-ibw|mi-picoview|wsxm-stp|wsxm-top|bcrf|frt)$/ &&
        $11 == "m" && $13 == "m" && $1 !~ / / { print $1, $7, $8, $9, $10, $19 }' \
        "$RC_CORPUS/manifest.tsv" >rows.txt
    claim "the manifest has rows for these formats" test -s rows.txt
    while read -r file nx ny dx dy probes; do
        rc-import "$corpus/$file" >real.rcg 2>real.err
        claim "$file is read" test "$(tail -n 1 real.rcg)" = "RCGEND 1"
        claim "$file has its size" \
            test "$(header nx real.rcg) $(header ny real.rcg)" = "$nx $ny"
        near "$(header dx real.rcg)" "$dx" 1e-12 "$file: dx"
        near "$(header dy real.rcg)" "$dy" 1e-12 "$file: dy"
        case $probes in
        0,0,*)
            value=${probes#0,0,}
            near "$(first_value real.rcg)" "${value%%;*}" 1e-12 "$file: first height"
            ;;
        esac
    done <rows.txt
    claim "csafe-logo's wrong checksum is only a warning" bash -c \
        "rc-import '$corpus/x3p/x3ptools__csafe-logo.x3p' 2>&1 >/dev/null | grep -q 51f0b43f25b587b72aa51b954c2134eb"
    bad=$corpus/bad
    refuses 1 "sample2.x3p: .*PCL" "a cloud of points" "rc-import '$bad/x3p__ISO5436-sample2.x3p'"
    refuses 1 "sample3.x3p: axis CY" "an absolute axis" "rc-import '$bad/x3p__ISO5436-sample3.x3p'"
    refuses 1 "not recognised" "prose" "rc-import '$bad/SurfaceTopography__nonsense_txt_file.txt'"
    refuses 1 "in one column" "one column" "rc-import '$bad/SurfaceTopography__single_column.txt'"
    refuses 1 "no X3P" "a ZIP archive of another kind" \
        "rc-import '$bad/SurfaceTopography__mitutoyo_mock.xlsx'"
    claim "a list of points is told from a matrix" bash -c "rc-import --list --dx 1um --z-unit um \
        '$corpus/xyz/SurfaceTopography__xyz-1.txt' | grep -q ': xyz$'"
    claim "and so is a profile" bash -c "rc-import --list --dx 1um --z-unit um \
        '$corpus/profile-text/SurfaceTopography__xy-4.txt' | grep -q ': profile$'"
    di=$corpus/nanoscope/SurfaceTopography__di-4.di
    claim "--list has a line for every channel" \
        test "$(rc-import --list "$di" | grep -Ec '^ +[123] +512 +512 ')" = 3
    claim "with its range" bash -c "rc-import --list '$di' |
        grep -Eq 'm +-2.08214509398651.*e-07 +2.72935345420074.*e-07 Height Sensor$'"
    claim "another channel keeps its name and unit" bash -c "rc-import --channel Phase '$di' |
        head -n 20 | tr '\n' ' ' | grep -aq 'channel=Phase nx=512 ny=512 .* unit=deg '"
    claim "by number too" bash -c "rc-import --channel 2 '$di' | grep -aq '^file.channel=Amplitude Error'"
    refuses 1 "no channel 'Topography'; there are 1 'Height Sensor' in m, 2 'Amplitude Error' in m" \
        "an absent channel names all" "rc-import --channel Topography '$di'"
    refuses 1 "its steps are 1 and 10 of a unit not given" "steps without a unit are named" \
        "rc-import '$corpus/surfer-grd/fatiando__simple_surfer.grd'"
    refuses 1 "not evenly apart" "an uneven profile" \
        "rc-import --z-unit um '$corpus/profile-text/SurfaceTopography__xy-1.txt'"
else
    echo "not tried: RC_CORPUS names no folder of real files"
fi

finish
