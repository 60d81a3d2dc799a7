# SPDX-License-Identifier: GPL-3.0-or-later
# A section shows each depth at its position on the axis, for any steps between its rows, without bands. Its
# largest value is marked, with its position.
. "$(dirname "$0")/../pipe.sh"

# made DEPTHS 'perl expression of $i and the depth $z in um': writes a section with 21 columns of 2 um
made() {
    perl -MCompress::Zlib -e 'binmode STDOUT; my ($depths, $value) = @ARGV; my @z = split /,/, $depths;
        my $f = "RCG1\nchannel=mises\nnx=21\nny=" . @z . "\ndx=2e-06\ndy=1e-06\nunit=Pa\ntype=f64\nsection=y\nat=0\ndepths=" .
            join(",", map { $_ * 1e-6 } @z) . "\n\n";
        my $get = eval "sub { my (\$i, \$z) = \@_; $value }";
        for my $z (@z) { $f .= pack "d<", $get->($_, $z) for 0 .. 20 }
        printf "%scrc32 %08x\nRCGEND 1\n", $f, crc32($f)' "$@"
}
plot() {
    sed -n 's/.*<image x="\([0-9.]*\)" y="\([0-9.]*\)" width="\([0-9.]*\)" height="\([0-9.]*\)".*/\1 \2 \3 \4/p' "$1" | head -n 1
}
# column FILE: prints the greys of the middle column of the map in a PDF, from the top
column() {
    pdfimages "$1" column
    perl -0777 -ne 's/^P6\s(\d+) (\d+)\s255\s// or die; my @v = unpack "C*", $_;
        print $v[3 * ($_ * $1 + int($1 / 2))], "\n" for 0 .. $2 - 1' column-000.ppm
}

uneven=0,1,3,10,11,40
made $uneven '1e6 * $z' >line.rcg
claim "a stress that grows with depth is drawn" rc-render --colormap grey --range 0:40MPa -o line.pdf line.rcg
column line.pdf >line.txt
claim "its grey level follows the depth, from 0 to 40 um" awk '
    { want = 255 * (NR - 0.5) / 900; off = $1 - want; bad += off > 1 || off < -1 } END { exit !(NR == 900 && bad == 0) }' line.txt
made $uneven '1e6 * ($z == 3 ? 40 : $z == 10 ? 20 : $z == 11 ? 30 : 10)' >rows.rcg
claim "a section with different rows is drawn" rc-render --colormap grey --range 0:40MPa -o rows.pdf rows.rcg
column rows.pdf >rows.txt
# row k of 900 is at (k - 0.5) 40 / 900 um
claim "the rows are at their depths" awk '
    function row(z) { return int(z * 900 / 40 + 0.5) }
    { v[NR] = $1 }
    END { exit !(v[row(3)] == 255 && v[row(10)] <= 129 && v[row(10)] >= 127 && v[row(11)] >= 190 && v[row(11)] <= 192) }' rows.txt
claim "values between two rows lie between their values" awk '
    { z = (NR - 0.5) * 40 / 900; lo = z < 3 ? 63 : z < 10 ? 127 : z < 11 ? 127 : 63; hi = z < 10 ? 255 : z < 11 ? 192 : 192
      bad += $1 < lo || $1 > hi } END { exit !(NR == 900 && bad == 0) }' rows.txt
claim "there are no bands: colours change by at most a hundredth down to 30 um" awk '
    NR > 262 && last - $1 > 3 { bad++ } { last = $1 } END { exit bad > 0 }' rows.txt

rc-render -o place.svg line.rcg
claim "the title says where a section lies" grep -q ">von Mises stress at y = 0<" place.svg
rc-render --title "Under a tip" -o place.svg line.rcg
claim "  the line under another title does" grep -q "section y = 0" place.svg
rc-pick --set at= line.rcg | rc-render -o place.svg
claim "  a section of the largest values says so" grep -q 'largest over all y' place.svg
claim "contours of a section are drawn" rc-render --width 1200 --contour -o line.svg line.rcg
read -r x y w h <<<"$(plot line.svg)"
# marks of 0 to 40 MPa: lines at 10, 20, 30 MPa lie at 10, 20, 30 um
claim "a contour is at its depth" eval "
    grep -o '<path d=\"[^\"]*\" fill=\"none\"' line.svg | tr 'ML' '\n\n' | grep '^[0-9]' | awk -v y=$y -v h=$h '
        { z = (\$2 - y) / h * 40; n = int(z / 5 + 0.5) * 5 ; if (\$2 > y + 1 && \$2 < y + h - 1) { c++; bad += z - n > 0.05 || n - z > 0.05; seen[n] = 1 } }
        END { exit !(c > 50 && bad < 0.02 * c && (10 in seen) && (20 in seen) && (30 in seen)) }'"

made $uneven '1e8 * exp(-(($i - 14) / 4) ** 2 - (($z - 10) / 5) ** 2)' >peak.rcg
claim "the largest value is printed with its place" bash -c \
    'rc-render --width 1200 -o peak.svg peak.rcg && says "largest 100 MPa at x = 8 µm, depth 10 µm" cat peak.svg'
read -r x y w h <<<"$(plot peak.svg)"
# the middle of the cross: column 14 of 21 is (14 + 0.5) / 21 across, 10 of 40 um down
claim "  it is marked in the picture" eval "
    grep -o 'path d=\"M[^\"]*\" fill=\"none\"[^/]*stroke=\"#ffffff\"' peak.svg | tr 'ML\"' '\n\n\n' | grep '^[0-9]' | head -n 4 |
    awk -v x=$x -v y=$y -v w=$w -v h=$h '{ a += \$1 / 4; b += \$2 / 4 }
        END { a -= x + w * 14.5 / 21; b -= y + h / 4; exit !(NR == 4 && a * a < 0.1 && b * b < 0.1) }'"
made $uneven '-1e8 * exp(-(($i - 14) / 4) ** 2)' | sed 's/^channel=mises/channel=szz/' | reseal >pressed.rcg
claim "for a compression it is the smallest value" bash -c \
    'rc-render --width 1200 -o pressed.svg pressed.rcg && says "least −100 MPa at x = 8 µm, depth 0" cat pressed.svg'
claim "--depth-range draws these depths only" rc-render --colormap grey --range 0:40MPa --depth-range 5um:25um -o part.pdf line.rcg
column part.pdf >part.txt
claim "  from the first to the last" awk '
    { want = 255 * (5 + 20 * (NR - 0.5) / 900) / 40; off = $1 - want; bad += off > 1 || off < -1 } END { exit !(NR == 900 && bad == 0) }' part.txt
claim "--window of a section selects columns" bash -c \
    'rc-render --colormap grey --window 0:10um -o w.pdf line.rcg && pdftotext w.pdf - | says "^10$" cat'
claim "depths can have another unit" bash -c "
    $(declare -f made); made 0,0.1,0.25,0.4 '1e6 * \$z' >thin.rcg && rc-render -o thin.pdf thin.rcg && pdftotext thin.pdf - >thin.txt &&
    grep -q 'depth (nm)' thin.txt && grep -q 'x (µm)' thin.txt"
refuses 1 '--depth-range 50um:60um: its depths go from 0 to 40 µm' "depths that are not there" 'rc-render --depth-range 50um:60um line.rcg >no.png'
refuses 2 '--depth-range 5um: it must be Z0:Z1' "one depth" 'rc-render --depth-range 5um line.rcg >no.png'
refuses 2 '--depth-range 9um:5um: it must be Z0:Z1' "depths upside down" 'rc-render --depth-range 9um:5um line.rcg >no.png'
refuses 2 'of a section it is X0:X1 only: choose depths with --depth-range' "a window of depths" 'rc-render --window 0:1um,0:1um line.rcg >no.png'
refuses 1 '--hertz is a circle or a strip on a map' "a circle in a section" 'rc-render --hertz line.rcg >no.png'
rc-synth sphere --nx 9 --dx 1um --radius 1mm -o map.rcg
claim "--depth-range of a map causes a message" warns '--depth-range is for sections' rc-render --depth-range 0:1um map.rcg
