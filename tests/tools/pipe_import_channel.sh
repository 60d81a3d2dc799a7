# SPDX-License-Identifier: GPL-3.0-or-later
# Without --channel rc-import reads the topography, recognised by name and unit; --channel accepts the
# beginning of a name.
. "$(dirname "$0")/../pipe.sh"

# nid FILE "NAME|FRAME|UNIT"...: writes a Nanosurf file of 2 x 2 maps; every value of the k-th map is k in its
# unit.
nid() {
    local file=$1 k=0 name frame unit
    shift
    {
        printf '[DataSet]\r\nVersion=2\r\nGroupCount=1\r\nGr0-Count=%d\r\n' $#
        while [ $k -lt $# ]; do
            printf 'Gr0-Ch%d=DataSet-0:%d\r\n' $k $k
            k=$((k + 1))
        done
        k=0
        for channel; do
            IFS='|' read -r name frame unit <<<"$channel"
            printf '\r\n[DataSet-0:%d]\r\nPoints=2\r\nLines=2\r\nFrame=%s\r\n' $k "$frame"
            printf 'Dim0Unit=m\r\nDim0Range=2e-6\r\nDim1Unit=m\r\nDim1Range=2e-6\r\nDim2Name=%s\r\n' "$name"
            printf 'Dim2Unit=%s\r\nDim2Range=65536\r\nDim2Min=-32768\r\nSaveMode=Binary\r\n' "$unit"
            printf 'SaveBits=16\r\nSaveSign=Signed\r\nSaveOrder=Intel\r\n'
            k=$((k + 1))
        done
        printf '\r\n#!'
        for ((k = 1; k <= $#; k++)); do
            perl -e "print pack('s<', $k) x 4"
        done
    } >"$file"
}

# reads NUMBER "sentence" CHANNEL...: from these channels rc-import reads this one by default.
reads() {
    local number=$1 sentence=$2
    shift 2
    nid of.nid "$@"
    rc-import --type f64 of.nid -o read.rcg 2>of.err
    if [ "$(first_value read.rcg)" = "$number" ]; then
        passed "$sentence"
    else
        failed "$sentence: channel $(first_value read.rcg) was read"
    fi
    claim "$sentence: --list marks it" says "^[*] +$number " rc-import --list of.nid
    claim "it marks no other" test "$(rc-import --list of.nid | grep -c '^[*]')" = 1
}

first_value() {
    local start
    start=$(sed -n '/^$/q; p' "$1" | wc -c)
    tail -c +$((start + 2)) "$1" | head -c 8 | od -An -t fD | tr -d ' '
}

# ---- names ----

reads 2 "a deflection in metres is not a topography" 'Deflection|Scan forward|m' 'Z-Axis|Scan forward|m'
reads 2 "nor is a height that is an error" 'Height Error|Scan forward|m' 'Topography|Scan forward|m'
reads 2 "a name that says nothing comes before a deflection" 'Deflection||m' 'User||m'
reads 3 "and after a topography" 'Deflection||m' 'User||m' 'Topography||m'
reads 2 "a height must be in metres" 'Z-Axis||V' 'User||m'
reads 2 "forward before backward" 'Z-Axis|Scan backward|m' 'Z-Axis|Scan forward|m'
reads 2 "trace before retrace" 'HeightRetrace||m' 'HeightTrace||m'
reads 2 "what a sensor measured before what drove the piezo" 'Height||m' 'Height Sensor||m'
reads 1 "but forward is more" 'Height|Scan forward|m' 'Height Sensor|Scan backward|m'
reads 2 "raw before derived" 'Height Sensor corrected||m' 'Height||m'
reads 2 "words may be run together" 'DeflectionTrace||m' 'ZSensorTrace||m' 'AmplitudeTrace||m'
reads 2 "in either case" 'DEFLECTION||m' 'HEIGHT||m'
reads 1 "the order of the file is the last word" 'Topography||m' 'Height||m'
reads 2 "a position is none" 'X Sensor||m' 'Z (height)||m' 'Y Sensor||m'

# ---- messages ----

nid many.nid 'Deflection|Scan forward|m' 'Z-Axis|Scan forward|m' 'Z-Axis|Scan backward|m' \
    'Z-Axis Sensor|Scan forward|m' 'Phase|Scan forward|deg'
claim "a message names the chosen channel and the option to choose" \
    warns "many.nid: 3 channels are heights: 'Z-Axis Sensor, Scan forward' \(4\) is read; --channel takes another" \
    rc-import many.nid
rc-import many.nid 2>all.err >/dev/null
claim "it is printed once" test "$(wc -l <all.err)" = 1
rc-import --quiet many.nid 2>quiet.err >/dev/null
claim "--quiet suppresses it" test ! -s quiet.err
nid one.nid 'Deflection|Scan forward|m' 'Z-Axis|Scan forward|m'
rc-import one.nid 2>one.err >/dev/null
claim "a file with one height causes no message" test ! -s one.err
nid none.nid 'Deflection||m' 'Phase||deg'
claim "a deflection in place of a height causes a message" \
    warns "no channel in metres is named as a topography: 'Deflection' \(1\) is read" rc-import none.nid
nid single.nid 'Phase||m'
rc-import single.nid 2>single.err >/dev/null
claim "the only channel of a file causes none" test ! -s single.err

# ---- --channel ----

# takes NUMBER NAME: --channel NAME reads that channel of many.nid
takes() {
    rc-import --channel "$2" many.nid -o taken.rcg 2>taken.err && [ "$(first_value taken.rcg)" = "$1" ]
}
claim "--channel accepts the first letters of a name" takes 1 defl
claim "they must be unique" takes 3 'z-axis, scan b'
claim "a number counts as in --list" takes 2 2
claim "a complete name has priority" takes 4 'Z-Axis Sensor, Scan forward'
claim "upper and lower case are equal" takes 1 'DEFLECTION, scan forward'
refuses 1 "many.nid: 'z-a' is the beginning of 3 names of channels: 2 'Z-Axis, Scan forward' in m, 3 'Z-Axis, Scan backward' in m, 4 'Z-Axis Sensor, Scan forward' in m" \
    "several that it could be are named" 'rc-import --channel z-a many.nid'
refuses 1 "no channel 'Axis'; there are 1 'Deflection, Scan forward' in m, 2 " \
    "the middle of a name is none" 'rc-import --channel Axis many.nid'
refuses 1 "no channel ''; there are 1" "nor is nothing" "rc-import --channel '' many.nid"
refuses 1 "no channel '6'; there are 1" "nor a number past the last" "rc-import --channel 6 many.nid"
claim "--list marks the channel of --channel" says '^[*] +1 .*Deflection' rc-import --list --channel defl many.nid
nid twins.nid 'Height||m' 'Height||m' 'Height 2||m'
claim "of two channels with the same name the first is read, with a message" \
    warns "2 channels are called 'Height': the first, 1, is read; --channel takes another by its number" \
    rc-import --channel Height twins.nid
nid numbers.nid '2||m' 'Height||m'
rc-import --channel 2 numbers.nid -o number.rcg 2>number.err
claim "a channel with the name 2 has priority over the number 2" test "$(first_value number.rcg)" = 1

# ---- real files ----

corpus="${RC_CORPUS:-}/corpus"
if [ -d "$corpus" ]; then
    while IFS='|' read -r file said name; do
        rc-import "$corpus/$file" -o real.rcg 2>real.err
        claim "$file: $name" grep -aqxF "file.channel=$name" real.rcg
        if [ -n "$said" ]; then
            claim "$file: a message says so" grep -q "$said: .$name" real.err
        else
            claim "$file: there is no message" bash -c '! grep -v "mask of the file covers" real.err'
        fi
    done <<'END'
nanosurf-nid/NSFopen__circles.nid|2 channels are heights|Topography, Scan forward
nanoscope/SurfaceTopography__di-4.di||Height Sensor
nanoscope/SurfaceTopography__di-2.di|2 channels are heights|Height
igor-ibw/SurfaceTopography__spot_1-1000nm.ibw|2 channels are heights|HeightTrace
jpk-image/AFMReader__sample_0.jpk|4 channels are heights|Height (measured)
mi-picoview/SurfaceTopography__mi-1.mi||Topography
generated/frt-2.gwy||Topography (top sensor) 1
metropro-dat/SurfaceTopography__metropro-1.dat||Phase
END
    claim "a backward scan has this in its name" says '2 .* Height \(retrace\)$' \
        rc-import --list "$corpus/nanoscope/SurfaceTopography__di-2.di"
    rc-import --list "$corpus/jpk-image/AFMReader__sample_0.jpk" >jpk.txt 2>jpk.err
    claim "channels in other units are listed with their ranges" grep -q ' 9 .* deg  *-9[.]6.* -8[.]2.* Lock-In Phase$' jpk.txt
    claim "standard error is empty" test ! -s jpk.err
else
    untried "RC_CORPUS names no folder of real files"
fi
