# SPDX-License-Identifier: GPL-3.0-or-later
# Infinite heights are missing points, counted in a warning, in X3P and elsewhere; a root ISO5436 is read.
. "$(dirname "$0")/../pipe.sh"

# x3p FILE ROOT HEIGHT...: writes a map of 3 rows with these heights in main.xml, and its checksum.
x3p() {
    local file=$1 root=$2
    shift 2
    {
        printf '<?xml version="1.0"?><p:%s xmlns:p="http://www.opengps.eu/2008/ISO5436_2">' "$root"
        printf '<Record1><Revision>ISO5436 - 2000</Revision><FeatureType>SUR</FeatureType><Axes>'
        printf '<%s><AxisType>I</AxisType><Increment>%s</Increment></%s>' CX 1.1e-6 CX CY 1.29e-6 CY
        printf '<CZ><AxisType>A</AxisType><DataType>D</DataType></CZ></Axes></Record1><Record3><MatrixDimension>'
        printf '<SizeX>%d</SizeX><SizeY>3</SizeY><SizeZ>1</SizeZ></MatrixDimension><DataList>' $(($# / 3))
        printf '<Datum>%s</Datum>' "$@"
        printf '</DataList></Record3><Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4></p:%s>' "$root"
    } >main.xml
    md5sum main.xml | sed 's/ .*/ *main.xml/' >md5checksum.hex
    perl -MIO::Compress::Zip=zip,:constants -e \
        'zip(["main.xml", "md5checksum.hex"] => $ARGV[0], Method => ZIP_CM_DEFLATE) or die' "$file"
}

x3p infinite.x3p ISO5436_2 1e-6 2e-6 inf -inf 5e-6 6e-6
claim "the file is read with a warning that counts them" \
    warns "infinite.x3p: 2 of 6 values are infinite and read as missing, the first at column 0, row 1 \(from 0\)" \
    rc-import infinite.x3p -o infinite.rcg
rc-info --json infinite.rcg >infinite.json
near "$(field missing infinite.json)" 2 "$same" "they are missing points"
near "$(field maximum infinite.json)" 6e-6 "$converted" "the highest is the highest that was measured"
near "$(field minimum infinite.json)" 1e-6 "$converted" "and so is the lowest"
claim "missing points can be filled" rc-detrend --fill infinite.rcg -o filled.rcg
claim "--list has the range of the measured points" says '^[*] +1 .* m +1e-06 +6e-06 ' rc-import --list infinite.x3p
rc-import --quiet infinite.x3p 2>quiet.err >/dev/null
claim "--quiet suppresses the warning" test ! -s quiet.err
x3p all.x3p ISO5436_2 inf inf inf
refuses 1 "all.x3p: every value that is there is infinite" "where all of them are the file is refused" 'rc-import all.x3p'

# ---- elsewhere ----

claim "the same holds in text" warns "1 of 4 values is infinite and read as missing, the first at column 1, row 0" \
    bash -c 'printf "1 inf\n3 4\n" | rc-import --dx 1um --z-unit nm -'
printf 'aISO-1.0\nNumPoints = 2\nNumProfiles = 2\nXscale = 1e-6\nYscale = 1e-6\nZscale = 1e-9\nDataType = 7\n*\n1 -inf\nBAD 4\n*\n' >a.sdf
claim "the same holds in SDF" warns "a.sdf: 1 of 4 values is infinite" rc-import a.sdf
{
    printf 'Gwyddion Simple Field 1.0\nXRes = 2\nYRes = 1\nXReal = 2e-6\nXYUnits = m\nZUnits = m\n\0\0\0\0'
    perl -e 'print pack("f<2", 9**9**9, 1e-6)'
} >a.gsf
size=$(($(wc -c <a.gsf) - 8))
claim "the GSF header ends at a multiple of four bytes" test $((size % 4)) = 0
claim "the same holds for its floats" warns "a.gsf: 1 of 2 values is infinite" rc-import a.gsf

# ---- the root ----

x3p old.x3p ISO5436 1e-7 2e-7 3e-7 4e-7 5e-7 6e-7
claim "an X3P without the part of the standard is read, with a warning" \
    warns "old.x3p: the root of its main.xml is ISO5436, where the standard has ISO5436_2" rc-import old.x3p -o old.rcg
x3p new.x3p ISO5436_2 1e-7 2e-7 3e-7 4e-7 5e-7 6e-7
rc-import new.x3p 2>new.err | sed 's/^source=.*//' >new.txt
claim "its heights are right" bash -c '
    cmp <(sed "s/^source=.*//; s/crc32 [0-9a-f]*$//" old.rcg) <(sed "s/crc32 [0-9a-f]*$//" new.txt)'
claim "the complete file causes no warning" test ! -s new.err
x3p other.x3p html 1e-6 2e-6 3e-6
refuses 1 "the root of its main.xml is 'html', not ISO5436_2" "another root is refused" 'rc-import other.x3p'
