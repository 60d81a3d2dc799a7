# SPDX-License-Identifier: GPL-3.0-or-later
# A section of a coated body shows its materials. It has a line at each interface, visible on every colour,
# the number of each medium beside the plot, and its material in the legend. Values jump only at interfaces,
# and slices name their medium.
. "$(dirname "$0")/../pipe.sh"

# made DEPTHS LAYERS 'perl expression of the depth $z in um': writes a section with 21 columns of 2 um
made() {
    perl -MCompress::Zlib -e 'binmode STDOUT; my ($depths, $layers, $value) = @ARGV; my @z = split /,/, $depths;
        my $f = "RCG1\nchannel=mises\nnx=21\nny=" . @z . "\ndx=2e-06\ndy=1e-06\nunit=Pa\ntype=f64\n";
        $f .= "section=y\nat=0\n" . ($layers ne "" ? "layers=$layers\n" : "");
        $f .= "depths=" . join(",", map { $_ * 1e-6 } @z) . "\n\n";
        my $get = eval "sub { my \$z = shift; $value }";
        for my $z (@z) { $f .= pack "d<", $get->($z) for 0 .. 20 }
        printf "%scrc32 %08x\nRCGEND 1\n", $f, crc32($f)' "$@"
}
plot() {
    sed -nE 's/.*<image x="([0-9.]*)" y="([0-9.]*)" width="([0-9.]*)" height="([0-9.]*)".*/\1 \2 \3 \4/p' "$1" |
        head -n 1
}
# lines FILE COLOUR: prints the heights of the horizontal lines across the plot with this colour
lines() {
    sed -n 's/.*<path d="M'"$x"' \([0-9.]*\)L[0-9.]* \([0-9.]*\)" .*stroke="'"$2"'".*/\1 \2/p' "$1"
}
# numbers FILE: prints "x y size number" of the bold numbers beside the plot
numbers() {
    local bold='font-weight="bold" fill="#222222"'
    sed -nE "s/<text x=\"([0-9.]*)\" y=\"([0-9.]*)\" font-size=\"([0-9.]*)\" $bold>([0-9])<.*/\1 \2 \3 \4/p" "$1"
}
# greys FILE: prints the greys of the middle column of a PDF, from the top
greys() {
    pdfimages "$1" "$1"
    perl -0777 -ne 's/^P6\s(\d+) (\d+)\s255\s// or die; my @v = unpack "C*", $_;
        print $v[3 * ($_ * $1 + int($1 / 2))], "\n" for 0 .. $2 - 1' "$1-000.ppm"
}

three='4e-06,4e11,0.2;6e-06,1.5e11,0.25;inf,2.08e11,0.3'
made 0,2,4,4.001,7,10,10.001,20,40 "$three" '1e6 * ($z <= 4 ? 40 : $z <= 10 ? 10 : 30)' >coat.rcg
rc-render --width 1200 -o coat.svg coat.rcg
read -r x y w h <<<"$(plot coat.svg)"
for ink in '#ffffff' '#222222'; do
    claim "each interface, 4 and 10 of 40 um deep, has a line in $ink" eval "
        lines coat.svg '$ink' | sort -g | awk -v y=$y -v h=$h '
            { want = y + h * (NR == 1 ? 4 : 10) / 40; a = \$1 - want; b = \$2 - want; bad += a * a > 0.01 || b * b > 0.01 }
            END { exit !(NR == 2 && bad == 0) }'"
done
claim "  a dark line lies under the light one" eval \
    "grep -n '<path d=\"M$x ' coat.svg |
        sed 's/.*stroke=\"\(#......\)\".*/\1/' | xargs | grep -q '^#ffffff #222222 #ffffff #222222$'"
for m in '1: layer of 4 µm, E 400 GPa, ν 0.2' '2: layer of 6 µm, E 150 GPa, ν 0.25' '3: substrate, E 208 GPa, ν 0.3'; do
    claim "the legend has $m" grep -qF ">$m<" coat.svg
done
# numbers: bold, right of the plot, left of the edge of the page, at the middle of their media
claim "numbers are beside the plot at the middles of their materials" eval "
    numbers coat.svg |
    awk -v x=$x -v y=$y -v w=$w -v h=$h '
        { want = y + h * (\$4 == 1 ? 2 : \$4 == 2 ? 7 : 25) / 40 + 0.36 * \$3; d = \$2 - want
          bad += \$4 != NR || d * d > 1 || \$1 < x + w || \$1 > 1190 } END { exit !(NR == 3 && bad == 0) }'"

# thin layers: their numbers move apart, no two touch, and none leaves the plot
made 0,0.05,0.1,0.15,0.5,20,40 '5e-08,4e11,0.2;5e-08,3e11,0.2;5e-08,2e11,0.2;inf,inf,0.3' '1e6' >thin.rcg
rc-render --width 1200 -o thin.svg thin.rcg
read -r x y w h <<<"$(plot thin.svg)"
claim "numbers of thin layers do not overlap" eval "
    numbers thin.svg | awk -v y=$y -v h=$h '
        { bad += NR > 1 && \$2 - last < \$3 || \$2 - 0.8 * \$3 < y - 1 || \$2 > y + h; last = \$2 }
        END { exit !(NR == 4 && bad == 0) }'"
claim "  each has a line to the edge of the plot" eval "
    grep -c '<path d=\"M$(awk "BEGIN { print $x + $w + 2 }") [^\"]*L[^\"]*L[^\"]*\"' thin.svg | grep -qx 4"
claim "  of coinciding lines the lowest is drawn" eval "
    lines thin.svg '#222222' | awk -v y=$y -v h=$h '
        { d = \$1 - y - h * 0.15 / 40; bad += d * d > 0.01 } END { exit !(NR == 1 && bad == 0) }'"
claim "a rigid substrate is named so" grep -qF '>4: substrate, rigid<' thin.svg

# media outside of the window of depths are not named
rc-render --width 1200 --depth-range 5um:30um -o part.svg coat.rcg
claim "the legend has only visible materials" bash -c '
    lacks ">1: layer" part.svg && grep -q ">2: layer" part.svg && grep -q ">3: substrate" part.svg'
read -r x y w h <<<"$(plot part.svg)"
claim "  the plot has only their lines" eval "
    lines part.svg '#222222' | awk -v y=$y -v h=$h '
        { d = \$1 - y - h * 5 / 25; bad += d * d > 0.01 } END { exit !(NR == 1 && bad == 0) }'"

# many
many=$(awk 'BEGIN { for (k = 0; k < 30; k++) printf "1e-06,%g,0.3;", 4e11 - k * 6e9; print "inf,2e11,0.3" }')
made 0,10,20,30,40 "$many" '1e6 * $z' >many.rcg
claim "with many materials the legend has their number" bash -c \
    'rc-render --width 1200 -o many.svg many.rcg &&
     says ">lines: where 31 media meet<" cat many.svg && lacks ">1: layer" many.svg'

# none
made 0,2,4,7,10,20,40 '' '1e6 * $z' >bare.rcg
rc-render --width 1200 -o bare.svg bare.rcg
read -r x y w h <<<"$(plot bare.svg)"
claim "without layers there is no line, number or legend" eval "
    test -z \"\$(lines bare.svg '#222222')\" && lacks 'substrate' bare.svg &&
    lacks 'weight=\"bold\" fill=\"#222222\">[0-9]<' bare.svg"

# ---- values ----

rc-render --colormap grey --range 0:40MPa -o coat.pdf coat.rcg
greys coat.pdf >column.txt
claim "values up to an interface are those of their own material" awk '
    { z = (NR - 0.5) * 40 / 900; want = z < 4 ? 255 : z < 10 ? 64 : 191; off = $1 - want; bad += off > 1 || off < -1 }
    END { exit !(NR == 900 && bad == 0) }' column.txt

# the curve between rows on one side of an interface does not depend on rows on the other side
made 0,1,2,3,4,4.000004,5,6,8,10 '4e-06,4e11,0.2;inf,2e11,0.3' '$z <= 4 ? 2e6 * $z : 0' >slope.rcg
rc-render --colormap grey --range 0:8MPa -o slope.pdf slope.rcg
greys slope.pdf >slope.txt
claim "a linear increase to an interface stays linear" awk '
    { z = (NR - 0.5) * 10 / 900; want = z < 4 ? 255 * z / 4 : 0; off = $1 - want; bad += off > 1 || off < -1 }
    END { exit !(NR == 900 && bad == 0) }' slope.txt

# ---- slices, sheets, curves ----

rc-synth sphere --nx 33 --dx 1um --radius 1mm |
    rc-solve --quiet --load 0.05N --E1 200GPa --nu1 0.3 --E2 rigid --layer 2um,400GPa,0.2 --output pressure -o p.rcg
rc-stress --depths 1um,2um,5um --components szz p.rcg -o s.rcg
claim "the title of a slice names the layer" bash -c \
    'rc-render --depth 2um -o s.svg s.rcg && says "depth 2 µm · layer 1 ·" cat s.svg'
claim "  or the substrate" bash -c \
    'rc-render --depth 5um -o s.svg s.rcg && says "depth 5 µm · substrate ·" cat s.svg'
claim "the panels of a sheet do so too" bash -c 'rc-render --width 1600 --sheet 3x1 -o s.svg s.rcg &&
    says ">a\) depth 1 µm, layer 1<" cat s.svg && says ">c\) depth 5 µm, substrate<" cat s.svg'
rc-stress --depths 0:10um:21 --section y=0 --components szz,sxx p.rcg -o section.rcg
claim "a curve over the depth has the interface" bash -c 'rc-render --channel sxx --cut x=0 -o c.svg section.rcg &&
    says ">dashed: where media meet, at a depth of 2 µm<" cat c.svg && says "stroke-dasharray" cat c.svg'
claim "  a curve along the surface has none" bash -c \
    'rc-render --channel sxx --cut depth=1um -o c.svg section.rcg && lacks "media meet" c.svg'
cat section.rcg section.rcg >two.rcg
claim "a sheet of sections has lines and numbers in each panel, and one legend" bash -c '
    rc-render --channel szz --sheet 1x2 -o two.svg two.rcg &&
    [ "$(grep -c "weight=\"bold\" fill=\"#222222\">1<" two.svg)" = 2 ] &&
    [ "$(grep -c ">2: substrate" two.svg)" = 1 ]'
{ cat section.rcg; rc-pick --set 'layers=3e-06,4e11,0.2;inf,2e11,0.3' section.rcg; } >other.rcg
claim "a sheet of different bodies has lines only, because one legend would be wrong" bash -c \
    'rc-render --channel szz --sheet 1x2 -o other.svg other.rcg && lacks "substrate" other.svg &&
     [ "$(grep -c "stroke=\"#222222\" stroke-width=\"1.2" other.svg)" -ge 2 ]'
claim "PNG and PDF have them too" bash -c 'rc-render -o c.png coat.rcg && rc-render -o c.pdf coat.rcg &&
    pdftotext c.pdf - | says "3: substrate, E 208 GPa" cat'

# ---- one depth, and invalid words ----

made 20 "$three" '1e6' >one.rcg
claim "a section with one depth is drawn at that depth" bash -c \
    'rc-render -o one.pdf one.rcg && pdftotext one.pdf - | says "^20.0$" cat &&
     pdftotext one.pdf - | says "^3: substrate" cat'
claim "  it is drawn in a range of depths that contains it" rc-render --depth-range 5um:30um -o one.png one.rcg
refuses 1 'its depths go from 20 µm to 20 µm' "  and not in another" \
    'rc-render --depth-range 5um:10um -o one.png one.rcg'
made 0,1,2 '2e-06,4e11' 1e6 >bad.rcg
refuses 1 'they must be t,E,nu of each material' "layers that make no sense" 'rc-render -o bad.png bad.rcg'
claim "  no picture is left" test ! -e bad.png
