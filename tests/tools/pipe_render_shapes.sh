# SPDX-License-Identifier: GPL-3.0-or-later
# Shapes of figures: reliefs with a given exaggeration, and strips with a stretched vertical axis. The border
# of the contact is drawn on maps of other channels, single or in a sheet. Titles are for a journal. Lengths
# are measured in the SVG.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 60 --ny 45 --dx 1um --dy 2um --hurst 0.8 --rms-height 20nm --rolloff 30um --seed 4 -o rough.rcg
rc-solve --quiet --periodic --load 10mN,60mN --estar 100GPa -o two.rcg rough.rcg
rc-pick --case 2 two.rcg -o one.rcg
rc-stress --quiet --nu 0.3 --section y=0 --depths 0:5um:6 --components mises one.rcg -o strip.rcg
draw='rc-render --quiet -o out.svg'

# ---- the border of the contact ----

# Prints the lines of the border in the SVG in units of nodes, from the size of the image of the map.
border_length() {
    perl -0777 -ne '
        my ($w, $h) = /<image [^>]*?width="([\d.]+)" height="([\d.]+)"/ or die "image";
        my ($sum) = (0);
        while (/<path d="([^"]*)" fill="none"[^>]*stroke="(#222222|#ff8c1a)"/g) {
            my @p = $1 =~ /([ML])([-\d.]+) ([-\d.]+)/g;
            my ($x, $y);
            while (my ($what, $px, $py) = splice @p, 0, 3) {
                $sum += abs($px - $x) / $w * 60e-6 + abs($py - $y) / $h * 90e-6 if $what eq "L";
                ($x, $y) = ($px, $py);
            }
            last;
        }
        printf "%.9g\n", $sum' "$1"
}
rc-solve --quiet --load 60mN --estar 100GPa -o free.rcg rough.rcg
perimeter=$(rc-info --json --patches free.rcg | sed -n 's/.*"perimeter": \([^,]*\),.*/\1/p')
claim "a map of heights has the border of the contact" rc-render --channel height --border -o border.svg free.rcg
near "$(border_length border.svg)" "$perimeter" 1e-3 "  as long as the perimeter of the patches"
claim "  it has no other line" eval 'rc-render --channel height --contour -o contour.svg free.rcg && test $(wc -c <contour.svg) -gt $(wc -c <border.svg)'
claim "  the second case has the border of its own pressure" rc-render --channel height --border --case 2 -o second.svg two.rcg
claim "    the line is drawn" says '>edge of contact<' cat second.svg
claim "  the legend names it" says '>edge of contact<' cat border.svg
claim "it is bright on a gap, which is dark there" eval 'rc-render --channel gap --border -o gap.svg free.rcg && says "stroke=\"#ff8c1a\"" cat gap.svg'
near "$(border_length gap.svg)" "$perimeter" 1e-3 "  and as long"
claim "a sheet of gaps has the border of each case" eval 'rc-render --channel gap --sheet 2x1 --border -o sheet.svg two.rcg &&
    test $(grep -o "stroke=\"#ff8c1a\"" sheet.svg | wc -l) -ge 3'
claim "  --contour can be added" eval 'rc-render --channel gap --case 1,2 --contour -o sheet.svg two.rcg && says ">edge of contact<" cat sheet.svg'
claim "  a window can be selected" rc-render --channel gap --case 1,2 --border --window -10um:10um,-10um:10um -o sheet.svg two.rcg
claim "  without a pressure there is none" eval 'rc-pick --channel gap two.rcg | rc-render --sheet 2x1 --border -o sheet.svg && ! says ">edge of contact<" cat sheet.svg'
rc-solve --quiet --history --load 60mN,0 --estar 100GPa --hardness 1GPa -o apart.rcg rough.rcg
claim "  without contact there is none" eval 'rc-render --channel gap --case 2 --border -o none.svg apart.rcg && ! says "edge of contact" cat none.svg'
claim "  a sheet names it if the first map has no contact" eval 'rc-pick --case 2 apart.rcg >a.rcg && cat a.rcg two.rcg | rc-render --channel gap --border --sheet auto -o sheet.svg && says ">edge of contact<" cat sheet.svg'

# ---- reliefs ----

claim "a relief can be ten times as high" eval 'rc-render --channel height --view 30,40 --exaggeration 10 -o r.svg rough.rcg && says "vertical exaggeration 10" cat r.svg'
claim "  its box grows" eval 'h() { rc-render --channel height --view 30,20 --exaggeration $1 --width 600 -o r.svg rough.rcg && sed -n "s/.*viewBox=\"0 0 [0-9]* \([0-9]*\)\".*/\1/p" r.svg; }
    test "$(h 400)" -gt "$(h 100)"'
refuses 2 '--exaggeration has no effect without --view' "a flat map" "$draw --exaggeration 2 rough.rcg"
refuses 2 '--exaggeration is for heights and other lengths, this is a pressure' "a relief of pressures" "$draw --channel pressure --view 30,40 --exaggeration 2 one.rcg"
refuses 2 'the box would be [0-9.]+e?[+0-9]* times as high as its longer side: give at most' "a tower" "$draw --channel height --view 30,40 --exaggeration 1e6 rough.rcg"
refuses 2 '--exaggeration 0: it must be above 0' "none" "$draw --view 30,40 --exaggeration 0 rough.rcg"

# ---- strips ----

# Width over height of the image of the map.
shape() {
    sed -n 's/.*<image [^>]*width="\([0-9.]*\)" height="\([0-9.]*\)".*/\1 \2/p' "$1" | awk 'NR == 1 { print $1 / $2 }'
}
claim "a narrow map can be drawn five times as deep" rc-render --aspect 5 -o strip.svg strip.rcg
near "$(shape strip.svg)" "$(awk 'BEGIN { print 60 / (5 * 5) }')" "$coarse_grid" "  60 um by 5 um, drawn 60 to 25"
claim "  the figure says so" says '>depth is drawn 5 times as large as x<' cat strip.svg
claim "the same holds for a map" rc-render --channel height --aspect 0.5 -o flat.svg rough.rcg
near "$(shape flat.svg)" "$(awk 'BEGIN { print 60 / 45 }')" "$coarse_grid" "  60 um by 90 um, drawn 60 to 45"
claim "the same holds for a sheet" eval 'rc-stress --quiet --nu 0.3 --section y=0 --depths 0:5um:6 --components mises two.rcg | rc-render --sheet 1x2 --aspect 5 -o sheet.svg && says ">depth is drawn 5 times" cat sheet.svg'
claim "  it says which section it is" says ">[^<]*at y = 0<" cat sheet.svg
for width in 700 800 900 1000 1100; do # the bar may be below the plot or beside it
    claim "the bar of lengths fits the page, $width pixels wide" eval 'rc-render --aspect 3.4 --width '$width' -o bar.svg strip.rcg &&
        perl -0777 -ne "my (\$w) = /viewBox=\"0 0 (\d+)/; while (/<image [^>]*?x=\"([\d.]+)\"[^>]*?width=\"([\d.]+)\"/g) { exit 1 if \$1 + \$2 > \$w }" bar.svg'
done
refuses 2 '--aspect 100: the plot would be [0-9.]+ times as high as wide: give a value for at most 12 times' "a tower" "$draw --aspect 100 --channel height rough.rcg"
refuses 2 '--view does not work with --aspect' "a relief" "$draw --view 30,40 --aspect 2 rough.rcg"
refuses 2 '--aspect does not work with --histogram' "a curve" "$draw --histogram --aspect 2 rough.rcg"
refuses 2 '--raw does not work with --border' "raw pixels" "rc-render --raw --border -o out.png rough.rcg"

# ---- words ----

claim "the title of a histogram is a distribution" eval 'rc-render --histogram --channel height -o d.svg rough.rcg && says ">Height distribution<" cat d.svg'
claim "the yielded nodes are called yielded area" eval 'printf "load/N\tyielded_area/m2\n1\t1e-9\n2\t2e-9\n" | rc-render --curve load:yielded_area -o y.svg && says ">Yielded area against load<" cat y.svg'
claim "refused commands leave no picture" bash -c '[ ! -e out.svg ] && [ ! -e out.png ]'
