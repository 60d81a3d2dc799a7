# SPDX-License-Identifier: GPL-3.0-or-later
# A window shows only this part of the map, with the coordinates of the map. A contact that is small compared
# with its map gets a window by default. The title says so; the lines over a map lie at the border of the
# contact.
. "$(dirname "$0")/../pipe.sh"

# made NX NY CHANNEL UNIT KEYS 'perl expression of $i, $j': writes a frame with nodes of 1 by 1 um
made() {
    perl -MCompress::Zlib -e 'binmode STDOUT; my ($nx, $ny, $channel, $unit, $keys, $value) = @ARGV;
        my $f = "RCG1\nchannel=$channel\nnx=$nx\nny=$ny\ndx=1e-06\ndy=1e-06\nunit=$unit\ntype=f64\n" .
            join("", map { "$_\n" } split /;/, $keys) . "\n";
        my $get = eval "sub { my (\$i, \$j) = \@_; $value }";
        for my $j (0 .. $ny - 1) { $f .= pack "d<", $get->($_, $j) for 0 .. $nx - 1 }
        printf "%scrc32 %08x\nRCGEND 1\n", $f, crc32($f)' "$@"
}
# plot FILE: prints "x y width height" of the map in an SVG, whose image comes before that of the bar
plot() {
    sed -n 's/.*<image x="\([0-9.]*\)" y="\([0-9.]*\)" width="\([0-9.]*\)" height="\([0-9.]*\)".*/\1 \2 \3 \4/p' "$1" | head -n 1
}
# across FILE: prints "number x" of the marks under the map; down FILE: "number y" of those to its left
across() {
    sed -n 's/.*<text x="\([0-9.]*\)" y="[0-9.]*" font-size="21" text-anchor="middle".*>\([−0-9.]*\)<\/text>/\2 \1/p' "$1" | sed 's/−/-/'
}
down() {
    local left
    left=$(plot "$1" | cut -d ' ' -f 1)
    sed -n 's/.*<text x="\([0-9.]*\)" y="\([0-9.]*\)" font-size="21" text-anchor="end".*>\([−0-9.]*\)<\/text>/\1 \2 \3/p' "$1" |
        sed 's/−/-/' | awk -v left="$left" '$1 < left { print $3, $2 - 0.36 * 21 }'
}
# lies FILE LO HI start length "sentence" <marks: each mark of the axis from LO to HI is at its position
lies() {
    awk -v lo="$1" -v hi="$2" -v start="$3" -v length_="$4" '
        { off = $2 - start - ($1 - lo) / (hi - lo) * length_; n++; bad += off > 0.6 || off < -0.6 }
        END { exit !(n >= 2 && bad == 0) }'
}
# axes FILE X0 X1 Y0 Y1 "sentence"
axes() {
    read -r x y w h <<<"$(plot "$1")"
    claim "$6: columns are right" eval "across $1 | lies $2 $3 $x $w"
    claim "$6: rows are right" eval "down $1 | lies $4 $5 $y $h"
}

made 41 21 height m '' '$i * 1e-7 + $j * 1e-9' >ramp.rcg
claim "--window in micrometres selects a part" rc-render --width 1200 --window=-10um:5um,-4um:9um -o w.svg ramp.rcg
# nodes lie at whole micrometres about 0: cells extend half a micrometre further
axes w.svg -10.5 5.5 -4.5 9.5 "its cells are at their places"
claim "a raw picture of it has its nodes" bash -c '
    rc-render --raw --window=-10um:5um,-4um:9um -o w.png ramp.rcg && [ "$(od -An -j 16 -N 8 -t u1 w.png | tr -s " ")" = " 0 0 0 16 0 0 0 14" ]'
claim "  it has its range" says 'min 1.006 µm · max 2.519 µm' cat w.svg
claim "a window may give columns only" rc-render --width 1200 --window 0:10um -o c.svg ramp.rcg
axes c.svg -0.5 10.5 -10.5 10.5 "all rows are there"
claim "a window beyond the map ends with the map" rc-render --width 1200 --window 0:1mm,0:1mm -o b.svg ramp.rcg
axes b.svg -0.5 20.5 -0.5 10.5 "at its edge"
for window in 1um 1um:0 0:1um,5um 0:1N 0:1um,0:1um,0:1um here ''; do
    refuses 2 "--window $window: " "--window '$window'" "rc-render --window '$window' ramp.rcg >no.png"
done
refuses 1 'no node lies in the window .*the map ends 20.5 µm to the right of its middle' "a window elsewhere" \
    'rc-render --window 30um:40um ramp.rcg >no.png'
refuses 1 '--window contact goes by the pressure' "the contact of a height" 'rc-render --window contact ramp.rcg >no.png'

# ---- contact ----

# in contact: columns 60 to 69 and rows 30 to 35 of 200 by 200 nodes, whose cells are -40..-30 and -70..-64
# um. The window is 1.5 times as large: a square of 15 um, enlarged to whole nodes.
keys='load=1e-3;estar=1e11;hardness=2e9;form=sphere 0.001'
made 200 200 pressure Pa "$keys" '$i >= 60 && $i < 70 && $j >= 30 && $j < 36 ? ($i < 64 ? 2e9 : 1e8 * ($i - 59)) : 0' >speck.rcg
claim "a very small contact sets the window" rc-render --width 1200 -o s.svg speck.rcg
axes s.svg -43 -27 -75 -59 "is windowed by itself"
claim "  the title says so" says 'Contact pressure about the contact' cat s.svg
claim "  the title has its share of the map" says '0.64 % of the map' cat s.svg
made 200 200 pressure Pa "$keys" '$i >= 60 && $i < 70 && $j >= 30 && $j < 36 ? ($i < 64 ? 2e9 : -1e9) : 0' >net.rcg
rc-render --width 1200 -o net.svg net.rcg
claim "  the meaning of a sign comes after the place" says '>Net pressure about the contact \(tension negative\)</text>' cat net.svg
rc-render --width 1200 --window all -o net.svg net.rcg
claim "  or after the title" says '>Net pressure \(tension negative\)</text>' cat net.svg
claim "  the colour bar has the unit alone" says '>Net pressure \(GPa\)</text>' cat net.svg
rc-render --cut y=-66um -o net.svg net.rcg
claim "  a curve along a line too" says '>Net pressure along y = .* \(tension negative\)</text>' cat net.svg
claim "--window all draws the whole map" rc-render --width 1200 --window all -o a.svg speck.rcg
axes a.svg -100 100 -100 100 "of it"
claim "  its title has no share" says '>Contact pressure</text>' cat a.svg
claim "raw pictures have all nodes" bash -c \
    'rc-render --raw -o r.png speck.rcg && [ "$(od -An -j 16 -N 8 -t u1 r.png | tr -s " ")" = " 0 0 0 200 0 0 0 200" ]'
made 40 40 pressure Pa '' '$i >= 10 && $i < 30 && $j >= 10 && $j < 30 ? 1e9 : 0' >large.rcg
claim "a large contact sets no window" rc-render --width 1200 -o l.svg large.rcg
axes l.svg -20 20 -20 20 "is shown on its map"
claim "--window contact does" rc-render --width 1200 --window contact -o l.svg large.rcg
axes l.svg -15 15 -15 15 "is about it, a quarter of its side around"
made 40 40 pressure Pa '' 0 >none.rcg
claim "without contact a message says so" warns 'nothing touches: the whole map is drawn' rc-render --window contact none.rcg

# ---- lines over the map ----

# paths FILE COLOUR: prints the corners "x y" of the lines of this colour, in micrometres of the map
paths() {
    read -r x y w h <<<"$(plot "$1")"
    sed -n "s/.*<path d=\"\([^\"]*\)\" fill=\"none\".*stroke=\"$2\".*/\1/p" "$1" | sed -n "$3p" | tr 'ML' '\n\n' |
        awk -v x="$x" -v y="$y" -v w="$w" -v h="$h" -v x0="$4" -v x1="$5" -v y0="$6" -v y1="$7" \
            'NF { print x0 + ($1 - x) / w * (x1 - x0), y0 + ($2 - y) / h * (y1 - y0) }'
}
# within X0 X1 Y0 Y1 <corners: they span exactly this range, to a fiftieth of a node
within() {
    awk -v x0="$1" -v x1="$2" -v y0="$3" -v y1="$4" 'function off(a, b) { return a - b > 0.02 || b - a > 0.02 }
        NR == 1 { a = b = $1; c = d = $2 }
        { if ($1 < a) a = $1; if ($1 > b) b = $1; if ($2 < c) c = $2; if ($2 > d) d = $2 }
        END { print a, b, c, d; exit NR < 4 || off(a, x0) || off(b, x1) || off(c, y0) || off(d, y1) }'
}
claim "contours of a window are drawn" rc-render --width 1200 --contour -o k.svg speck.rcg
claim "--border draws the border of the yielded nodes" eval "paths k.svg '#009e73' 1 -43 -27 -75 -59 | within -40 -36 -70 -64"
claim "  the legend names it" says 'pressure at the hardness' cat k.svg
claim "--border draws the border of the contact" eval \
    "grep -n 'path' k.svg >/dev/null; n=\$(grep -c 'fill=\"none\".*stroke=\"#222222\"' k.svg); for k in \$(seq \$n); do paths k.svg '#222222' \$k -43 -27 -75 -59 | within -40 -30 -70 -64 && break; done"
# the same lines over the height of the case, which comes after its pressure
{ made 200 200 pressure Pa "$keys" '$i >= 60 && $i < 70 && $j >= 30 && $j < 36 ? ($i < 64 ? 2e9 : 1e8 * ($i - 59)) : 0' | sed '/^RCGEND/d'
  made 200 200 height m '' '0' | sed 's/^RCGEND 1/RCGEND 2/'; } >both.rcg
claim "a height has the border of its contact" rc-render --width 1200 --channel height --window contact --contour -o both.svg both.rcg
axes both.svg -43 -27 -75 -59 "is windowed by the pressure"
claim "  it has the border of the yielded nodes" eval "paths both.svg '#009e73' 1 -43 -27 -75 -59 | within -40 -36 -70 -64"
claim "  the title explains it" says '>Height about the contact</text>' cat both.svg
claim "without these options the whole map is drawn" rc-render --width 1200 --channel height -o both.svg both.rcg
axes both.svg -100 100 -100 100 "the whole height"
# a single node of a map that is two pixels wide, and lines thinner than that
made 400 400 pressure Pa '' '$i == 200 && $j == 100 || $i > 250 ? 1e9 : 0' >node.rcg
claim "a contact of one node is drawn" rc-render --width 1200 --contour -o n.svg node.rcg
read -r _ _ w _ <<<"$(plot n.svg)"
between 0.1 "$(sed -n 's/.*stroke="#222222" stroke-width="\([0-9.]*\)" stroke-linecap.*/\1/p' n.svg | head -n 1)" \
    "$(awk "BEGIN { print 0.5 * $w / 400 }")" "has a line thinner than half of it around"

# a^3 = 3 F R / (4 E*) = 0.75 * 1e-3 * 1e-3 / 1e11: a = 1.9574 um; about the origin
claim "--hertz draws a circle" rc-render --width 1200 --hertz --window=-5um:5um,-5um:5um --title t -o h.svg \
    <(made 200 200 pressure Pa "$keys" 1e8)
claim "  its radius follows a^3 = 3 F R / (4 E*)" eval "paths h.svg '#1f8fd1' 1 -5 5 -5 5 | within -1.9574 1.9574 -1.9574 1.9574"
claim "  the figure prints the radius" says 'Hertz, radius 1.957 µm' cat h.svg
refuses 1 '--hertz needs the keys load, estar and form=sphere RADIUS' "a circle without a sphere" 'rc-render --hertz large.rcg >no.png'
refuses 2 '--raw does not work with --hertz' "a circle in a raw picture" 'rc-render --raw --hertz speck.rcg >no.png'

# ---- many nodes on a pixel ----

made 3000 600 height m '' '$i == 1234 && $j == 321 ? 1e-6 : 0' >peak.rcg
for keep in mean max; do
    claim "--keep $keep" rc-render --width 700 --colormap grey --range 0:2um --keep "$keep" -o "$keep.pdf" peak.rcg
    pdfimages "$keep.pdf" "$keep"
    perl -0777 -ne 's/^P6\s(\d+) (\d+)\s255\s// or die; my $m = 0; for (unpack "C*", $_) { $m = $_ if $_ > $m } print "$1 $m\n"' \
        "$keep-000.ppm" >"$keep.txt"
done
claim "--keep keeps the largest value of a pixel" grep -qx '2400 128' max.txt
# 3000 nodes on 2400 pixels: the node covers at most 0.8 of the width of a pixel, and its whole height
between 50 "$(cut -d ' ' -f 2 mean.txt)" 103 "or its mean over what the pixel covers"
