# SPDX-License-Identifier: GPL-3.0-or-later
# A picture is a PNG, SVG or PDF according to its name: another suffix is a wrong command line, reported
# before the work. Curves, sheets and reliefs, like single maps, are available in all three, with the
# requested width on paper, text as text, and the requested font.
. "$(dirname "$0")/../pipe.sh"

# ---- the ending ----

rc-synth sphere --nx 16 --dx 1um --radius 1mm -o sphere.rcg

for name in b.eps b.svgz b b. bpng b.png.txt b.jpeg .pngx; do
    refuses 2 "rc-render: -o $name: a picture is a PNG, SVG or PDF: its name has to end in .png, .svg or .pdf" "rc-render -o $name" \
        "rc-render -o $name sphere.rcg"
    refuses 2 "rc-cost: --plot $name: a picture is a PNG, SVG or PDF" "rc-cost --plot $name" \
        "rc-cost --plot $name sphere.rcg -- rc-solve --load 1mN --estar 100GPa"
done
claim "refused commands leave no file" test "$(echo *)" = "refuses.err refuses.out sphere.rcg"
refuses 2 'has to end in .png, .svg or .pdf' "before anything is read" 'rc-render -o b.eps nowhere.rcg'
for name in a.png A.PNG b.Png ./c.d/x.png; do
    mkdir -p c.d
    claim "rc-render -o $name" bash -c "rc-render -o $name sphere.rcg && [ -s $name ]"
done
for name in a.svg A.SVG a.pdf ./c.d/X.Pdf; do
    claim "rc-render -o $name" bash -c "rc-render -o $name sphere.rcg && [ -s $name ]"
done
claim "an SVG file has the format SVG" bash -c 'head -c 5 A.SVG | grep -qx "<?xml" && grep -q "^<svg " A.SVG'
claim "a PDF file has the format PDF" bash -c 'head -c 5 c.d/X.Pdf | grep -qx "%PDF-"'
claim "standard output needs no suffix" bash -c 'rc-render -o - sphere.rcg | cmp - a.png'
claim "a device needs none" rc-render -o /dev/null sphere.rcg
claim "  a link to a device needs none" bash -c 'rc-render -o /dev/stdout sphere.rcg | cmp - a.png'
mkfifo pipe
claim "a FIFO keeps its name" bash -c 'cmp a.png pipe & rc-render -o pipe sphere.rcg && wait $!'
ln -s /dev/null nothing
claim "a link to a device keeps its name" rc-render -o nothing sphere.rcg

# ---- every kind ----

rc-synth sphere --nx 65 --dx 10um --radius 7.5mm -o ball.rcg
rc-solve --quiet --load 1N,2N --estar 114GPa --report r.tsv --output pressure -o p.rcg ball.rcg

# prints the width of a PNG in pixels, and its pixels per inch
png() {
    perl -e 'open my $f, "<:raw", $ARGV[0] or die; local $/; my $b = <$f>;
        my $at = index $b, "pHYs"; die "no pHYs" if $at < 0;
        printf "%d %.2f\n", unpack("N", substr $b, 16), 0.0254 * unpack("N", substr $b, $at + 4)' "$1"
}

# kind, the label of the horizontal axis, and the options
while read -r kind across options; do
    draw="rc-render --quiet --title Gutenberg --width 120mm $options"
    for ending in png svg pdf; do
        claim "$kind.$ending" $draw -o "$kind.$ending"
    done
    read -r w dpi <<<"$(png "$kind.png")"
    near "$w" 1417.3 0.0004 "$kind.png: 120 mm are 1417 pixels"
    near "$dpi" 300 1e-3 "  of which 300 are an inch"
    near "$(pdfinfo "$kind.pdf" | awk '/^Page size/ { print $3 }')" 340.16 1e-3 "  the PDF is 340.2 points wide"
    claim "  the SVG is 120 mm wide" says 'width="(120|119\.9[0-9]*|120\.0[0-9]*)mm"' head -n 5 "$kind.svg"
    pdftotext -layout "$kind.pdf" "$kind.txt"
    claim "  the PDF has its title as text" says '^ *Gutenberg$' cat "$kind.txt"
    claim "  the title of its axis too" says "$across \(" cat "$kind.txt"
    claim "  the SVG has its title as text" says ">Gutenberg</text>" cat "$kind.svg"
    claim "  the title of its axis too" says "<text .*>$across \(" cat "$kind.svg"
    # 7 points at 300 pixels an inch
    near "$(sed -n 's/.*<text [^>]*font-size="\([0-9.]*\)".*/\1/p' "$kind.svg" | sort -g | head -n 1)" 27.8 0.05 \
        "  and no text of it is smaller than 6.7 points"
    claim "  librsvg draws it" rsvg-convert -o "$kind.from.png" "$kind.svg"
    claim "  a second run gives the same bytes" bash -c "$draw -o again.pdf && cmp again.pdf $kind.pdf"
    claim "  --size in pixels sets the width" bash -c "
        ${draw/120mm/700} -o px.png && perl -e 'open F, q(px.png); read F, \$_, 20; exit(unpack(q(N), substr \$_, 16) != 700)'"
    claim "  a missing font causes a message" warns "no font of that name" ${draw/--quiet/} --font Gutenbergia -o no.pdf
done <<'END'
curve Load --curve load:contact_area --law hertz --radius 7.5mm --estar 114GPa r.tsv
gap Load --curve load:mean_gap --log xy r.tsv
stiffness Load --curve load:stiffness --log xy r.tsv
cut x --cut y=0 --case 1,2 p.rcg
histogram Pressure|pressure --histogram --case 1 p.rcg
ratio Material.ratio --material-ratio ball.rcg
sheet x --sheet 2x1 --contour p.rcg
relief x --view 30,35 ball.rcg
END

# Words lie at addresses of the command line, which with 32 bits can equal the first half of a number. Without
# address randomisation they always do.
fixed=$(setarch -R true 2>setarch.err && echo setarch -R)
claim "the file contains the command with its options" bash -c "
    $fixed rc-render --quiet --title Gutenberg --curve load:stiffness --log xy -o told.svg r.tsv && says ' --log xy ' cat told.svg"

claim "a picture of one of several cases names the case" says ' --case 1,2 ' cat cut.svg
claim "a legend of curves is text" says 'Hertz \(Johnson 1985' cat curve.txt
claim "titles of panels are text" says 'a\) load 1 N +b\) load 2 N' cat sheet.txt
claim "  they are complete in narrow panels too" bash -c \
    'rc-render --quiet --sheet 2x1 --width 60mm -o narrow.svg p.rcg && says ">a\) load 1 N<" cat narrow.svg && says ">b\) load 2 N<" cat narrow.svg'
claim "a relief of an SVG is one image" test "$(grep -c '<image' relief.svg)" = 2
claim "  the PNG has the size of the SVG" test "$(png relief.png | cut -d ' ' -f 1)" = 1417

# ---- options of maps ----

claim "a sheet with logarithmic colours is drawn" bash -c 'rc-render --quiet --sheet auto --log --range 1MPa:100MPa -o out.pdf p.rcg &&
    pdftotext out.pdf - | says "^5$" cat' # axis marks with even steps include 20, 40, 60
# 11 by 11 of 65 by 65 nodes
claim "a sheet of a window is drawn" bash -c 'rc-render --quiet --sheet auto --window -50um:50um,-50um:50um -o out.pdf p.rcg &&
    pdftotext out.pdf - | says "2.9 % of the map" cat'
claim "a relief of a window is drawn" rc-render --quiet --view 30,35 --window -50um:50um,-50um:50um -o out.svg ball.rcg
rm -f out.*
draw='rc-render -o out.png'
refuses 2 '--log x has no effect without --curve, --cut, --histogram or --material-ratio' "an axis of a map" "$draw --log x p.rcg"
refuses 2 '--view does not work with --log' "a relief by logarithm" "$draw --view 30,35 --log p.rcg"
refuses 1 'there is no room for a relief: ask for a larger --width' "a relief on 60 mm" \
    "$draw --view 30,35 --width 60mm ball.rcg"
refuses 2 '--hertz does not work with --sheet' "the circle of Hertz on a sheet" "$draw --hertz --sheet auto p.rcg"
refuses 2 '--window contact does not work with --sheet' "a window of what touches on a sheet" \
    "$draw --window contact --sheet auto p.rcg"
refuses 2 '--window does not work with --cut' "a window of a curve" "$draw --cut y=0 --window 0:9um,0:9um p.rcg"
refuses 2 '--clip does not work with --curve' "clipped curves" "$draw --curve load:approach --clip r.tsv"
refuses 2 '--range 1%:99%: for --cut it must be LO:HI' "percentiles of a curve" "$draw --cut y=0 --range 1%:99% p.rcg"
claim "refused commands leave no picture" bash -c '[ ! -e out.png ]'
