# SPDX-License-Identifier: GPL-3.0-or-later
# The colour bar shows the range of its colours. Marks lie at the positions of their values, values beyond an
# end have an arrow with a dark outline, visible on white paper. Gaps begin at 0.
. "$(dirname "$0")/../pipe.sh"

# made NX CHANNEL UNIT 'perl expression of $i, $j': writes a stream of NX by NX nodes
made() {
    perl -MCompress::Zlib -e 'binmode STDOUT; my ($n, $channel, $unit, $value) = @ARGV;
        my $f = "RCG1\nchannel=$channel\nnx=$n\nny=$n\ndx=1e-06\ndy=1e-06\nunit=$unit\ntype=f64\n\n";
        my $get = eval "sub { my (\$i, \$j) = \@_; $value }";
        for my $j (0 .. $n - 1) { $f .= pack "d<", $get->($_, $j) for 0 .. $n - 1 }
        printf "%scrc32 %08x\nRCGEND 1\n", $f, crc32($f)' "$@"
}

# bar FILE: prints "top height" of the colour bar, the image of one column. marks FILE: prints "number y" of
# each mark to its right. arrows FILE: prints the number of arrows, and "inked" if each has a dark outline.
bar() {
    sed -n 's/.*<image x="[0-9.]*" y="\([0-9.]*\)" width="28" height="\([0-9.]*\)".*/\1 \2/p' "$1"
}
marks() {
    sed -n 's/.*<text x="\([0-9.]*\)" y="\([0-9.]*\)" font-size="21" text-anchor="end".*>\(.*\)<\/text>/\1 \2 \3/p' "$1" |
        sed 's/−/-/' | awk '$1 > 1000 { print $3, $2 - 0.36 * 21 }'
}
arrows() {
    grep -c '<path d="[^"]*Z" fill' "$1"
}

# marks_lie FILE LO HI LOG "sentence": each mark is at its position within a thousandth of the bar
marks_lie() {
    marks "$1" >marks.txt
    claim "$5" awk -v bar="$(bar "$1")" -v lo="$2" -v hi="$3" -v log_axis="$4" '
        BEGIN { split(bar, b) }
        { t = log_axis ? log($1 / lo) / log(hi / lo) : ($1 - lo) / (hi - lo)
          off = ($2 - (b[1] + (1 - t) * b[2])) / b[2]; n++; bad += off > 1e-3 || off < -1e-3 }
        END { exit !(n >= 3 && bad == 0 && b[2] > 100) }' marks.txt
}

made 30 height m '($i - 10) * 1e-7' >ramp.rcg
claim "a ramp has the range of its values" rc-render --width 1200 -o ramp.svg ramp.rcg
marks_lie ramp.svg -1 1.9 0 "marks lie at their values from end to end"
claim "no value is outside" test "$(arrows ramp.svg)" = 0
claim "--range sets the range" rc-render --width 1200 --range -500nm:3um -o wide.svg ramp.rcg
marks_lie wide.svg -0.5 3 0 "is where the marks say"
claim "values below it have an arrow" test "$(arrows wide.svg)" = 1
claim "  the arrow has a dark outline" bash -c 'grep -A 1 "Z\" fill" wide.svg | grep -q "fill=\"none\".*stroke=\"#222222\""'
claim "--range symmetric is symmetric" rc-render --width 1200 --range symmetric -o both.svg ramp.rcg
marks_lie both.svg -1.9 1.9 0 "is as far to one side of 0 as to the other"
claim "--range accepts percentiles" rc-render --width 1200 --range 10%:90% -o part.svg ramp.rcg
# 900 values, 30 in each column: rank 89.9 is between the last value of column 2 and the first one of column 3
marks_lie part.svg -0.71 1.61 0 "end where their columns do"
claim "  each end has an arrow" test "$(arrows part.svg)" = 2
claim "  a note explains them" says 'colours from 10 % to 90 % of the nodes' cat part.svg
claim "--log-colours takes logarithms" rc-render --width 1200 --log --range 1nm:10um -o log.svg ramp.rcg
sed -i 's/10<tspan[^>]*>\([−0-9]*\)<\/tspan>/1e\1/' log.svg
marks_lie log.svg 1e-9 1e-5 1 "have their powers where they are"
claim "  over more than three decades in the SI unit" says '>Height \(m\)<' cat log.svg
claim "  over fewer in that of the largest value" rc-render --width 1200 --log --range 1nm:1um -o few.svg ramp.rcg
claim "    with its prefix" says '>Height \(µm\)<' cat few.svg
sed -i 's/10<tspan[^>]*>\([−0-9]*\)<\/tspan>/1e\1/' few.svg
marks_lie few.svg 0.001 1 1 "    and its numbers"

made 30 height m '$i == 7 && $j == 9 ? 1e-3 : sin($i / 3) * 1e-6' >spike.rcg
claim "one outlier does not set the range" rc-render --width 1200 -o spike.svg spike.rcg
claim "a note says so" says 'colours from 0.5 % to 99.5 % of the nodes' cat spike.svg
claim "  it has an arrow" test "$(arrows spike.svg)" -ge 1
claim "  the subtitle has its height" says 'max 1 mm' cat spike.svg
claim "--range 0%:100% includes it" rc-render --width 1200 --range 0%:100% -o all.svg spike.rcg
claim "  there is no arrow" test "$(arrows all.svg)" = 0

made 30 gap m '$i < 9 ? -1e-12 * ($j % 2) : ($i - 8) * 1e-8' >gap.rcg
claim "the range of a gap begins at 0" rc-render --width 1200 -o gap.svg gap.rcg
marks_lie gap.svg 0 210 0 "begins at 0"
claim "  values below 0 by rounding are not outside" test "$(arrows gap.svg)" = 0
made 30 gap m '($i + 5) * 1e-8' >open.rcg
claim "the range of a gap without contact is that of its values" rc-render --width 1200 -o open.svg open.rcg
marks_lie open.svg 0 340 0 "shows 0 too"
made 30 gap m '($i - 8) * 1e-8' >dent.rcg
claim "the range of a gap with yield includes negative values" rc-render --width 1200 -o dent.svg dent.rcg
marks_lie dent.svg -80 210 0 "has its sign"
claim "  0 is at a mark" grep -q '^0 ' marks.txt
made 30 sxx Pa '($i - 3) * 1e7' >signed.rcg
claim "the range of a stress with both signs is symmetric" rc-render --width 1200 -o signed.svg signed.rcg
marks_lie signed.svg -260 260 0 "has 0 in the middle"
made 30 pressure Pa '$i < 9 ? 0 : 1e6 * ($i - 8) ** 2' >touch.rcg
claim "the range of a pressure begins at 0" rc-render --width 1200 --log -o touch.svg touch.rcg
claim "logarithmic colours begin at the lowest pressure in contact" test "$(arrows touch.svg)" = 0
marks_lie touch.svg 1 441 1 "  nor off its mark"
claim "a range from 10 MPa is drawn" rc-render --width 1200 --range 10MPa:500MPa -o touch.svg touch.rcg
claim "contact below it has an arrow" test "$(arrows touch.svg)" = 1
made 30 szz Pa '-$i * 1e7' >pressed.rcg
claim "the range of a stress of one sign begins or ends at 0" rc-render --width 1200 -o pressed.svg pressed.rcg
marks_lie pressed.svg -290 0 0 "ends at 0"

# ---- a forgotten unit ----

doubted() { # doubted RANGE: a map and a cut with this range give a warning
    warns "range $1 goes from .*, but the values go from 0 Pa to 441 MPa: was a unit forgotten" rc-render --range "$1" -o doubt.png touch.rcg &&
        warns 'was a unit forgotten' rc-render --range "$1" --cut y=0 -o doubt.png touch.rcg
}
for range in 0:6 2GPa:6GPa 0:1000GPa; do
    claim "--range $range hides most values up to 441 MPa, and causes a warning" doubted $range
done
quiet() { rc-render "$@" -o doubt.png 2>said.txt && ! grep -q forgotten said.txt; }
claim "a range that contains the values causes none" quiet --range 0:6GPa touch.rcg
claim "  a range with a hundredth of the values causes none" quiet --range 1MPa:6MPa touch.rcg
made 30 height m 1e-6 >flat.rcg
claim "  a map with a single value causes none" quiet --range 0:2um flat.rcg

for range in 1%:2 1%:101% 5%:5% 90%:10% -1%:5% 1% %:5% x%:5%; do
    refuses 2 "--range $range: percentiles are P%:Q%" "--range $range" "rc-render --range $range ramp.rcg >no.png"
done
refuses 2 '--clip does not work with --range' "two ranges" 'rc-render --clip --range 0:1um ramp.rcg >no.png'
refuses 2 '--log has no place for 0 and below' "a logarithm of less than 0" 'rc-render --log --range -1um:1um ramp.rcg >no.png'
refuses 1 'no value is above 0, and only those have a logarithm' "a logarithm of nothing" 'rc-render --log pressed.rcg >no.png'
