# SPDX-License-Identifier: GPL-3.0-or-later
# Pictures for papers are SVG and PDF with text as text. They have the requested size on paper, the unchanged
# map, and the same bytes at any time.
. "$(dirname "$0")/../pipe.sh"

# a ramp of 6 by 4 nodes: node (i, j) is i + 6 j um, from 0 to 23
for j in 0 1 2 3; do
    echo "$((6 * j)) $((6 * j + 1)) $((6 * j + 2)) $((6 * j + 3)) $((6 * j + 4)) $((6 * j + 5))"
done | rc-import --dx 2um --z-unit um - -o ramp.rcg
rc-synth wave --nx 200 --ny 1 --dx 1um --amplitude 1um --wavelength 50um -o curve.rcg

# ---- text ----

for kind in ramp curve; do
    unit=µm # the largest value: 23 um; 998 nm, because no node lies on the crest of the wave
    [ $kind = ramp ] || unit=nm
    for ending in pdf svg; do
        claim "$kind.$ending" rc-render --width 85mm -o "$kind.$ending" "$kind.rcg"
    done
    pdftotext -layout "$kind.pdf" "$kind.txt"
    claim "$kind.pdf: poppler reads the title" says '^ *Height$' cat "$kind.txt"
    claim "  the title of the x axis is text" says '^ *x \(µm\)' cat "$kind.txt"
    claim "  the upright title of the colour bar is text" says "Height \($unit\)" cat "$kind.txt"
    claim "  a mark with its minus sign is text" says '−[0-9]' cat "$kind.txt"
    claim "  all fonts are embedded" bash -c \
        "pdffonts $kind.pdf | tail -n +3 | awk '{ n++; bad += \$(NF - 4) != \"yes\" } END { exit !(n > 0 && bad == 0) }'"
    claim "$kind.svg: labels are text" says '<text .*>x \(µm\)</text>' cat "$kind.svg"
    claim "  librsvg draws it" rsvg-convert -o "$kind.png" "$kind.svg"
done
claim "powers are raised digits in a PDF" bash -c \
    'rc-render --title "q⁻⁴ × 10³" -o power.pdf ramp.rcg && pdftotext power.pdf - | says "q−4 × 103" cat'
claim "  in an SVG they are raised at seven tenths of the size" bash -c \
    'rc-render --title "a < 10³ & b" --width 1200 -o power.svg ramp.rcg &&
     says "a &lt; 10<tspan dy=\"-10.08\" font-size=\"19.6\">3</tspan><tspan dy=\"10.08\"> &amp; b</tspan></text>" cat power.svg'
claim "--font selects another family" bash -c \
    'rc-render --font "DejaVu Sans Mono" -o mono.pdf ramp.rcg 2>mono.err; [ -s mono.err ] || pdffonts mono.pdf | says Mono cat'
claim "a missing family causes a message" warns "no font of that name, .* is used" rc-render --font Gutenbergia -o no.pdf ramp.rcg

# ---- the map ----

claim "in a PDF a node is a pixel of the map, not smoothed" bash -c \
    "pdfimages -list ramp.pdf | awk '\$4 == 6 && \$5 == 4 && \$10 == \"no\" { found = 1 } END { exit !found }'"
# node k of 24 is k 255 / 23 of 255
claim "  it has the colours of its values" bash -c '
    rc-render --colormap grey --range 0:23um -o grey.pdf ramp.rcg && pdfimages grey.pdf grey &&
    perl -0777 -ne "s/^P6\s6 4\s255\s// or die q(no map); my @v = unpack q(C*), \$_; @v == 72 or die scalar @v;
        for (0 .. 71) { abs(\$v[\$_] - int(\$_ / 3) * 255 / 23) <= 1 or die qq(value \$_ is \$v[\$_]) }" grey-000.ppm'
# prints width, height and pixels per inch of a PNG
png() {
    perl -e 'open my $f, "<:raw", $ARGV[0] or die; local $/; my $b = <$f>;
        my ($w, $h) = unpack "NN", substr $b, 16; my $at = index $b, "pHYs";
        my ($x, $y, $unit) = $at < 0 ? (0, 0, 0) : unpack "NNC", substr $b, $at + 4;
        die "two kinds of pixels" if $x != $y || ($at >= 0 && $unit != 1);
        printf "%d %d %.2f\n", $w, $h, 0.0254 * $x' "$1"
}

# ---- sizes ----

read -r w _ dpi <<<"$(rc-render --width 85mm -o - ramp.rcg >a.png && png a.png)"
near "$w" 1003.94 0.0006 "85 mm are 1004 pixels"
near "$dpi" 300 1e-3 "  of which 300 are an inch"
read -r w _ dpi <<<"$(rc-render --width 85mm --dpi 600 -o b.png ramp.rcg && png b.png)"
near "$w" 2007.87 0.0006 "--dpi 600 doubles them"
near "$dpi" 600 1e-3 "  and says so"
read -r w _ dpi <<<"$(rc-render --width 800 -o c.png ramp.rcg && png c.png)"
near "$w" 800 0 "plain numbers are pixels"
near "$dpi" 144 1e-3 "  where text of 14 pixels is 7 points high"
read -r w _ dpi <<<"$(rc-render --dpi 432 -o d.png ramp.rcg && png d.png)"
read -r w2 _ dpi2 <<<"$(rc-render -o e.png ramp.rcg && png e.png)"
near "$(awk "BEGIN { print $w / $dpi }")" "$(awk "BEGIN { print $w2 / $dpi2 }")" 0.01 "without --width the size on paper stays"
near "$dpi" 432 1e-3 "  at the pixels asked for"
read -r _ _ dpi <<<"$(rc-render --raw --dpi 150 -o f.png ramp.rcg && png f.png)"
near "$dpi" 150 1e-3 "a raw picture says what it is told"
near "$(pdfinfo ramp.pdf | awk '/Page size/ { print $3 }')" 240.945 0.001 "a PDF of 85 mm is 240.9 points wide"
near "$(sed -n 's/.*<svg.* width="\([0-9.]*\)mm".*/\1/p' ramp.svg)" 85 0.001 "an SVG of 85 mm says so"
near "$(rc-render --width 640 -o g.svg ramp.rcg && sed -n 's/.*<svg.* width="\([0-9.]*\)".*/\1/p' g.svg)" 640 0 "one of 640 pixels too"

# ---- the same bytes ----

for ending in png svg pdf; do rc-render -o one.$ending ramp.rcg; done
second=$(date +%s)
until [ "$(date +%s)" != "$second" ]; do sleep 0.02; done
for ending in png svg pdf; do
    claim "two runs give the same $ending at any time" bash -c "rc-render -o two.$ending ramp.rcg && cmp one.$ending two.$ending"
done
claim "no date is in the PDF" bash -c 'pdfinfo one.pdf >of_pdf && ! grep -q Date of_pdf'
claim "the PDF contains the command that made it" bash -c 'pdfinfo one.pdf | says "^Subject: .*rc-import .* rc-render" cat'
claim "the SVG does too" says '^<desc>rc-import .* rc-render .*</desc>' cat one.svg
for ending in svg pdf; do
    ln -sf /dev/full "full.$ending"
    refuses 1 "the ${ending^^} cannot be written: No space left on device" "a full device, $ending" \
        "rc-render -o full.$ending ramp.rcg"
done
claim "rc-cost draws a PDF too" bash -c '
    rc-synth sphere --nx 16 --dx 1um --radius 1mm | rc-cost --vary increments=8,16 --quiet --plot cost.pdf - -- rc-solve --load 1mN --E1 100GPa --nu1 0.3 --E2 rigid --yield 1GPa >/dev/null &&
    pdftotext cost.pdf - | says "time \(s\)" cat'
