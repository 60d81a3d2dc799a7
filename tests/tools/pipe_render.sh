# SPDX-License-Identifier: GPL-3.0-or-later
# rc-render draws the selected frame, from complete streams only, and otherwise fails with the right exit
# status and without a picture.
. "$(dirname "$0")/../pipe.sh"

# stream CHANNEL UNIT NX NY "KEY=VALUE..." 'perl expression of $i, $j' [the same six again]...: writes a
# stream of such frames. The expression gives a value, which may be "nan".
stream() {
    perl -MCompress::Raw::Zlib -e '
        binmode STDOUT;
        my $frames = 0;
        while (my ($channel, $unit, $nx, $ny, $keys, $value) = splice @ARGV, 0, 6) {
            my $f = "RCG1\nchannel=$channel\nnx=$nx\nny=$ny\ndx=1e-06\ndy=1.3e-06\nunit=$unit\n" .
                    "type=f64\n" . join("", map { "$_\n" } split / /, $keys) . "\n";
            my $get = eval "sub { my (\$i, \$j) = \@_; $value }";
            for my $j (0 .. $ny - 1) { $f .= pack "d<", $get->($_, $j) for 0 .. $nx - 1 }
            print $f, sprintf "crc32 %08x\n", Compress::Raw::Zlib::crc32($f);
            $frames++;
        }
        print "RCGEND $frames\n";' -- "$@"
}

# size WIDTH HEIGHT FILE: checks the size in the header of the PNG; - for any number.
size() {
    perl -e 'my ($w, $h, $file) = @ARGV; open my $f, "<:raw", $file or die; read $f, my $b, 24;
        die "no PNG" if substr($b, 0, 8) ne "\x89PNG\r\n\x1a\n";
        my @is = unpack "NN", substr $b, 16;
        die "it is @is" if ($w ne "-" && $w != $is[0]) || ($h ne "-" && $h != $is[1])' "$@"
}

# pixels: prints the PNG without its text chunks.
pixels() {
    perl -0777 -ne 'print unpack("H*", $1) while /IDAT(.*?)....IEND/gs'
}
export -f pixels

# describes PATTERN FILE: the uncompressed chunks of the picture contain the text.
describes() {
    LC_ALL=C grep -aqF -- "$1" "$2"
}

stream height m 33 47 "" '1e-7 * ($i - 0.3 * $j)' >height.rcg
stream height m 33 47 "" '1e-7 * $i' pressure Pa 21 20 "" '$i > 5 ? 1e9 * $i : 0' \
    gap m 33 47 "" '1e-7 * $j' >three.rcg
stream szz Pa 8 9 "depth=0" '-1e9 * $i' szz Pa 8 9 "depth=1.23456e-05" '-3e9 * $i' \
    szz Pa 8 9 "depth=4e-05" '-2e9 * $i' >depths.rcg
stream pressure Pa 8 9 "case=1" '1e9' pressure Pa 10 11 "case=2" '2e9' >cases.rcg
stream height m 12 9 "" '$i < 3 ? "nan" : 1e-6 * $i * $j' >missing.rcg
stream mises Pa 20 4 "section=y at=0 depths=0,1e-06,3e-06,1e-05" '1e8 * $j' >section.rcg

# ---- sizes, and which frame ----

claim "a raw picture has a pixel for each node" bash -c \
    'rc-render --raw <height.rcg >raw.png'
claim "the picture has 33 x 47 pixels" size 33 47 raw.png
claim "the default channel is pressure, then height, then the first" rc-render --raw -o p.png three.rcg
claim "the values are those of the frame" size 21 20 p.png
claim "--channel selects the channel" rc-render --raw --channel gap -o g.png three.rcg
claim "the values are those of the frame" size 33 47 g.png
claim "--case selects the case" rc-render --raw --case 2 -o c.png cases.rcg
claim "the values are those of the frame" size 10 11 c.png
claim "of several cases the first is drawn, with a warning" bash -c \
    'warns "2 cases match: case 1" rc-render --raw -o c.png cases.rcg'
claim "the values are those of the frame" size 8 9 c.png
claim "--verbose names the chosen channel" \
    warns 'drawing pressure' rc-render --verbose --raw three.rcg
claim "of several depths the one with the largest value is drawn" \
    warns 'drawing 12.35 µm' rc-render --verbose --raw depths.rcg
claim "--depth selects a depth to a thousandth" bash -c 'rc-render --depth 12.35um -o d.png depths.rcg 2>told && [ ! -s told ]'
for asked in 12um 26um; do
    claim "  the nearest depth to $asked is drawn, with a message" bash -c "
        warns 'no frame is at .*: the nearest depth, 1.23456e-05 m, is taken' \
            rc-render --raw --depth $asked -o near.png depths.rcg &&
        [ \"\$(rc-render --raw --depth $asked depths.rcg 2>near.err | pixels)\" = \"\$(rc-render --raw --depth 12.3456um depths.rcg | pixels)\" ]"
done
stream szz Pa 8 9 "depth=0 case=1" '$i' szz Pa 8 9 "depth=1e-06 case=1" '-$i' \
    szz Pa 8 9 "depth=0 case=2" '$j' szz Pa 8 9 "depth=1e-05 case=2" '-$j' >two.rcg
claim "  it comes from the first case with a depth" warns 'the nearest depth, 1e-05 m, is taken' rc-render --raw --depth 9um -o near.png two.rcg
stream pressure Pa 8 9 "case=1" '$i < 4 ? 1e9 : 0' mises Pa 8 9 "depth=0 case=1" '1e8 * $i' mises Pa 8 9 "depth=1e-06 case=1" '2e8 * $j' \
    pressure Pa 8 9 "case=2" '$j < 4 ? 1e9 : 0' szz Pa 8 9 "depth=0 case=2" '$i' >beside.rcg
claim "the edge of the contact comes from the pressure of its case" bash -c \
    'rc-render --channel szz --border -o edge.svg beside.rcg && says ">edge of contact<" cat edge.svg'
claim "  in a sheet of depths too" bash -c \
    'rc-render --channel mises --depth 0,1um --border -o edge.svg beside.rcg && says ">edge of contact<" cat edge.svg'
claim "--size sets the width of a figure" rc-render --width 777 -o w.png height.rcg
claim "it has 777 pixels" size 777 - w.png

# ---- every kind of picture ----

# says_extremes VALUE NX NY FILE: the figure, an SVG, gives the least and the largest finite value of this
# expression to four digits.
says_extremes() {
    perl -CS -0777 -e '
        my ($value, $nx, $ny, $file) = @ARGV;
        my $get = eval "sub { my (\$i, \$j) = \@_; $value }";
        my @v = sort { $a <=> $b } grep { $_ - $_ == 0 } map { my $j = $_; map { $get->($_, $j) } 0 .. $nx - 1 } 0 .. $ny - 1;
        open my $f, "<:utf8", $file or die; my $svg = <$f>;
        $svg =~ s{10(?:</tspan>)?<tspan[^>]*>([^<]*)</tspan>}{10^$1}g; $svg =~ s{</?tspan[^>]*>}{}g; $svg =~ s/<[^>]*>/\n/g;
        my ($line) = $svg =~ /(min .* max .*)/ or die "no extremes\n";
        $line =~ s/\x{2212}/-/g;
        my %prefix = (m => -3, "\x{b5}" => -6, n => -9, p => -12, k => 3, M => 6, G => 9);
        for my $which (["min", $v[0]], ["max", $v[-1]]) {
            my ($digits, $power, $prefix) = $line =~ /$which->[0] (-?[0-9.]+(?:e-?\d+)?)(?:\x{b7}10\^(-?\d+))?(?: ([pn\x{b5}mkMG]?)(?:m|Pa)\b)?/
                or die "no number in $line\n";
            my ($mantissa, $own) = (split(/e/, $digits), 0);
            my $is = $mantissa . "e" . ($own + ($power // 0) + ($prefix{$prefix // ""} // 0));
            my $most = abs $which->[1];
            die "$line: $is is not $which->[1]\n" if abs($is - $which->[1]) > 6e-4 * $most + 1e-323;
        }' -- "$@"
}
claim "a figure with contours is drawn" rc-render --contour -o f.svg three.rcg
claim "  of its pressure" says_extremes '$i > 5 ? 1e9 * $i : 0' 21 20 f.svg
claim "a figure with missing nodes is drawn" rc-render -o f.svg missing.rcg
claim "  with the extremes of the others" says_extremes '$i < 3 ? "nan" : 1e-6 * $i * $j' 12 9 f.svg
claim "a section with uneven depths is drawn" rc-render --contour --section y -o f.svg section.rcg
claim "  with its extremes" says_extremes '1e8 * $j' 20 4 f.svg
while read -r nx ny; do
    heights='1e-9 * (($i * 7 + $j * 3) % 11)'
    stream height m "$nx" "$ny" "" "$heights" >shape.rcg
    claim "a figure of $nx x $ny nodes is drawn" rc-render --contour --quiet -o f.svg shape.rcg
    claim "  with its extremes" says_extremes "$heights" "$nx" "$ny" f.svg
    claim "a raw picture of $nx x $ny nodes is drawn" rc-render --raw -o f.png shape.rcg
    claim "  with $nx x $ny pixels" size "$nx" "$ny" f.png
done <<'END'
1000 3
3 1000
7 5
1 1
1 64
64 1
1400 40
END
while read -r value; do
    stream height m 9 8 "" "$value" >value.rcg
    claim "a figure of the values $value is drawn" rc-render --contour -o f.svg value.rcg
    claim "  with its extremes" says_extremes "$value" 9 8 f.svg
    stream pressure Pa 9 1 "" "$value" >value.rcg
    claim "a curve of the values $value is drawn" rc-render -o f.svg value.rcg
    claim "  with its extremes" says_extremes "$value" 9 1 f.svg
done <<'END'
0
3e-6
-3e-6
1.7e308
5e-324
($i - 4) * 1e-320
($i - 4) * 4e307
1 + $i * 2.3e-16
1e-3 + $i * 1e-12
$i == 3 ? 9**9**9 : $i
$i == 3 ? "nan" : $i == 1 ? -9**9**9 : $i * $j - $i
END

# ---- the same picture is the same bytes ----

for kind in --figure --raw "--contour --colormap magma"; do
    # shellcheck disable=SC2086
    claim "$kind: a second run gives the same bytes" bash -c \
        "rc-render $kind height.rcg >a.png && rc-render $kind <height.rcg >b.png && cmp a.png b.png"
done
claim "the picture contains the command that made it" describes "rc-render" a.png
claim "with its options in SI" bash -c \
    'rc-render --range -1um:2.5um -o a.png height.rcg && grep -aqF -- "--range -1e-06:2.5e-06" a.png'

# ---- text ----

# A character at the end of Unicode's private area, which no font has.
private=$(printf '\364\217\277\275')
claim "a character that no font has causes a warning, and the figure is drawn" bash -c \
    "rc-render --title 'No $private here' -o f.png height.rcg 2>warned && grep -q \"no font has the characters '$private'\" warned"
claim "a character of a font causes none" bash -c \
    'rc-render --title "Rauheit, 10⁻³ m²" -o f.png height.rcg 2>warned && [ ! -s warned ]'
printf '<?xml version="1.0"?>\n<fontconfig><cachedir>%s/cache</cachedir></fontconfig>\n' "$PWD" >fonts.conf
refuses 1 'no font was found' "a figure without any font" "FONTCONFIG_FILE='$PWD/fonts.conf' rc-render -o out.png height.rcg"
claim "a raw picture needs no font" env FONTCONFIG_FILE="$PWD/fonts.conf" rc-render --raw -o f.png height.rcg

# ---- refusals ----

none() { [ ! -e out.png ] && [ -z "$(ls out.png.* 2>/dev/null)" ]; }

draw='rc-render -o out.png'
stream height m 5 5 "" '"nan"' >empty.rcg
refuses 1 'none of its 25 values is a finite number: there is nothing to draw' "a map without a number" "$draw empty.rcg"
refuses 1 'no frame with the channel mises, only height, pressure, gap' "an absent channel" \
    "$draw --channel mises three.rcg"
refuses 1 'no case 7: there are cases 1, 2' "an absent case" "$draw --case 7 cases.rcg"
refuses 1 'there are 0, 1.23456e-05, 4e-05 m' "an absent depth" "$draw --depth 54um depths.rcg"
stream szz Pa 8 9 "depth=0" 1 mises Pa 8 9 "depth=0" 1 szz Pa 8 9 "depth=1e-05" 1 mises Pa 8 9 "depth=1e-05" 1 >turns.rcg
refuses 1 'there are 0, 1e-05 m' "an absent depth of the second channel" "$draw --channel mises --depth 16um turns.rcg"
refuses 1 'no frame at depth 1.3e-05 m: no frame has a depth' "a depth where there is none" "$draw --depth 13um height.rcg"
refuses 1 'no section across x' "an absent section" "$draw --section x section.rcg"
refuses 1 'the stream has no frame' "a stream without frames" "printf 'RCGEND 0\n' | $draw"
refuses 2 '--range 2um:1um: it must be LO:HI, two values with LO below HI' "a range upside down" "$draw --range 2um:1um height.rcg"
refuses 2 '--range 1um:1um: it must be LO:HI' "a range without extent" "$draw --range 1um:1um height.rcg"
refuses 2 '--range 1,2,3: it must be LO:HI' "a range of three" "$draw --range 1,2,3 height.rcg"
refuses 2 '--range 1um: it must be LO:HI' "a range of one" "$draw --range 1um height.rcg"
refuses 2 "--range 0:1GPa: unknown unit 'GPa': m is expected" "a range in another unit" "$draw --range 0:1GPa height.rcg"
refuses 2 '--range 1:2um: numbers with and without a unit' "a range in two units" "$draw --range 1:2um height.rcg"
refuses 2 '--colormap jet: it must be one of viridis' "an unknown map of colours" "$draw --colormap jet height.rcg"
refuses 2 '--figure does not work with --raw' "two kinds of picture" "$draw --raw --figure height.rcg"
refuses 2 '--raw does not work with --contour' "contours in a raw picture" "$draw --raw --contour height.rcg"
refuses 2 '--raw does not work with --width' "a raw picture of some width" "$draw --raw --width 500 height.rcg"
refuses 2 '--width 100: it must be 320 to 16000 pixels' "a figure too narrow" "$draw --width 100 height.rcg"
refuses 2 '--width 85m: it must be 320 to 16000 pixels, which is a matter of --dpi' "a figure for a wall" "$draw --width 85m height.rcg"
refuses 2 '--width 30mm: on paper it must be at least 60mm' "a figure for a stamp" "$draw --width 30mm height.rcg"
refuses 2 '--width -85mm: on paper it must be at least 60mm' "a width below nothing" "$draw --width -85mm height.rcg"
refuses 2 '--width 85N: unknown unit' "a width in newtons" "$draw --width 85N height.rcg"
refuses 2 '--raw does not work with --font' "letters in a raw picture" "$draw --raw --font serif height.rcg"
refuses 2 '--raw has a pixel for each node, which only a PNG has' "a raw SVG" "rc-render --raw -o out.svg height.rcg"
refuses 2 '--title: the text is not UTF-8' "a title that is not text" "$draw --title $'\\xff' height.rcg"
refuses 2 'unknown option --hue: see rc-render --help' "an unknown option" "$draw --hue red height.rcg"
stream mises Pa 20 4 "section=y depths=0,1e-06" 1 >few.rcg
refuses 1 'its key depths has 2 depths, but there are 4 rows' "a section with too few depths" "$draw few.rcg"
stream mises Pa 20 3 "section=y depths=0,2e-06,1e-06" 1 >falling.rcg
refuses 1 'its key depths must rise from row to row' "a section whose depths do not rise" "$draw falling.rcg"

whole=$(wc -c <three.rcg)
while read -r n where; do
    refuses 1 "the stream stops $where, [0-3] whole frames after its start" "a stream cut after $n of $whole bytes" \
        "head -c $n three.rcg | $draw"
done <<END
1 inside a line
100 inside the values of a frame
1000 inside the values of a frame
$((whole / 2)) inside the values of a frame
$((whole - 9)) without an end line
$((whole - 1)) inside a line
END
refuses 1 'standard input is empty, the stream stops before it begins' "a stream of nothing" "head -c 0 three.rcg | $draw"
refuses 1 'this stream failed: out of load' "a producer that failed" \
    "{ head -c $((whole - 9)) three.rcg; printf 'RCGFAIL out of load\n'; } >out-of.rcg; $draw <out-of.rcg"
claim "refused commands leave no picture or part of one" none
cp height.rcg out.png
refuses 1 'the stream stops inside the values of a frame' "a cut stream over a file that is there" "head -c 1000 three.rcg | $draw"
claim "the old file stays" cmp height.rcg out.png
refuses 1 'the PNG cannot be written: No space left on device' "a full device" "rc-render height.rcg >/dev/full"
refuses 1 'the PNG cannot be written: No space left on device' "a full device named" "rc-render -o /dev/full height.rcg"
