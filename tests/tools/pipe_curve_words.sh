# SPDX-License-Identifier: GPL-3.0-or-later
# Curves for a journal: means with error bars, requested units and labels, and groups of rows as separate
# curves with names. The test reads points from the SVG by the marks of its axes, and compares them with known
# means and deviations.
. "$(dirname "$0")/../pipe.sh"

points() {
    perl "$RC_SOURCE/tests/tools/points.pl" <"$1"
}
# draws FILE KIND NUMBER...: a path of this kind in the file has these numbers, to a thousandth of the largest.
draws() {
    points "$1" | awk -v kind="$2" -v want="${*:3}" '
        BEGIN { n = split(want, w); for (k in w) most = (w[k] > most ? w[k] : most) }
        $2 == kind && NF >= n + 2 { bad = 0
            for (k = 1; k <= n; k++) { d = $(k + 2) - w[k]; if (d < -1e-3 * most || d > 1e-3 * most) bad = 1 }
            if (!bad) found = 1 }
        END { exit !found }'
}
draw='rc-render --quiet -o out.svg'
shows() {
    says "$2" cat "$1"
}
export -f points draws shows

# ---- means, their spread, columns of errors ----

# 2 with deviations -1 0 1: deviation 1; 5 with -1 and 1: sqrt 2
printf 'x/N\ty/m2\tk\te/m2\n1\t1\ta\t0.5\n3\t4\tb\t1\n1\t2\tb\t0.5\n1\t3\ta\t0.25\n3\t6\ta\t1\n' >few.tsv
claim "rows with the same x become a point" rc-render --curve x:y --spread -o s.svg few.tsv
claim "  the point is their mean" draws s.svg solid 1 2 3 5
claim "  its bars are their standard deviation (n - 1)" draws s.svg bars 1 1 1 3
claim "  every point has bars" eval "points s.svg | awk '\$2 == \"bars\" { d = (\$18 - \$16) / 2; ok = (d - sqrt(2)) ^ 2 < 1e-5 } END { exit !ok }'"
claim "  the figure explains the bars" shows s.svg 'means of the rows that share x \(2 to 3 each\) · bars: their standard deviation'
claim "without --spread no means are drawn" eval 'rc-render --curve x:y -o z.svg few.tsv && draws z.svg solid 1 1 3 4 1 2 1 3 3 6'
printf 'x\ty\n1\t1\n2\t2\n1\t1.1\n2\t2.1\n1\t0.9\n2\t1.9\n' >seeds.tsv
claim "  a curve that goes back and forth causes a warning" warns 'seeds.tsv: the line turns back 4 times along x: --spread makes a point of rows that share it, --by COLUMN a curve of each group' \
    rc-render --curve x:y -o z.svg seeds.tsv
claim "    with --spread, or for a single turn, there is no warning" eval 'rc-render --curve x:y --spread -o z.svg seeds.tsv 2>said.txt && [ ! -s said.txt ] &&
    head -n 5 seeds.tsv | sed 4d | rc-render --curve x:y -o z.svg 2>said.txt && [ ! -s said.txt ]'
claim "a column of errors gives bars to both sides" eval 'rc-render --curve x:y --error e -o e.svg few.tsv && draws e.svg bars 1 0.5 1 1.5'
claim "  the figure names the column" shows e.svg 'bars: ± e<'
claim "bars that reach 0 end at the edge of a logarithmic axis" eval '
    printf "x/N\ty/m\te/m\n1\t1\t2\n2\t2\t0.5\n3\t3\t1\n" | rc-render --curve x:y --error e --log -o l.svg && shows l.svg "M[0-9.]+ [0-9]{4}[0-9.]*L"'
claim "--markers draws markers without lines" eval 'rc-render --curve x:y --points -o p.svg few.tsv && ! points p.svg | grep -q solid'
claim "  they are at their places" draws p.svg marker 3 6

# ---- ends of the axes ----

rc-synth sphere --nx 33 --dx 20um --radius 7.5mm -o ball.rcg
# axis FILE: the first and the last number of the marks of both axes.
axis() {
    perl -0777 -ne 'my (@x, @y);
        push @x, $1 while /text-anchor="middle" fill="#222222">((?:−)?[\d.]+)</g; push @y, $1 while /text-anchor="end" fill="#222222">((?:−)?[\d.]+)</g;
        print "$x[0] $x[-1] $y[0] $y[-1]"' "$1"
}
# path FILE: the points of the first curve in fractions of the plot.
path() {
    perl -0777 -ne 'my ($x, $y, $w, $h) = /<clipPath id="\w+"><rect x="([\d.]+)" y="([\d.]+)" width="([\d.]+)" height="([\d.]+)"/ or die;
        my ($d) = /<path d="([^"]*)" fill="none"/ or die;
        printf "%.3f %.3f ", ($1 - $x) / $w, 1 - ($2 - $y) / $h while $d =~ /[ML](-?[\d.]+) (-?[\d.]+)/g' "$1"
}
export -f axis path
printf 'x/N\ty/m2\n0\t0\n1e-3\t1\n2e-3\t4\n3e-3\t9\n4e-3\t16\n5e-3\t25\n' >square.tsv
claim "--x-range and --y-range set the ends of the axes" eval 'rc-render --curve x:y --x-range 0:8mN --y-range -10:40 -o r.svg square.tsv && [ "$(axis r.svg)" = "0 8 −10 40" ] && draws r.svg marker 5 25'
claim "  without a unit they are SI" eval 'rc-render --curve x:y --x-range 0:0.008 --y-range -10:40 -o z.svg square.tsv && sed "s,0:0.008,0:8mN," z.svg >y.svg && sed "s,0:0.008,0:8mN," r.svg | cmp y.svg -'
claim "  a comma means the same" eval 'rc-render --curve x:y --x-range 0,8mN --y-range -10,40 -o z.svg square.tsv && [ "$(axis z.svg)" = "0 8 −10 40" ]'
claim "  the unit of the numbers need not be that of the axis" eval 'rc-render --curve x:y --x-range 0:8000uN --x-unit mN -o z.svg square.tsv && [[ "$(axis z.svg)" = "0 8 "* ]]'
claim "a part of x has the ends of its points upwards" eval 'rc-render --curve x:y --x-range 1mN:3mN -o z.svg square.tsv && [ "$(axis z.svg)" = "1.0 3.0 0 8" ]'
claim "  only its points have markers" eval '[ "$(rc-render --curve x:y --points --x-range 1mN:3mN -o z.svg square.tsv; points z.svg | grep -c marker)" = 3 ]'
claim "  the figure counts the others" shows z.svg '>3 points outside of the axes<'
claim "  a point at an end is not outside of them" eval 'printf "x/N\ty\n%s\t1\n" 1e-4 2e-4 3e-4 7e-4 | rc-render --curve x:y --x-range 0.1mN:0.3mN -o y.svg && shows y.svg ">1 point outside of the axes<"'
claim "  a whole curve has no such line" eval '! shows r.svg "outside of the axes"'
printf 'x\ty\n0\t0\n100\t100\n' >line.tsv
claim "a line to points far outside keeps its slope" eval 'rc-render --curve x:y --x-range 49:50 --y-range 0:100 -o z.svg line.tsv && [ "$(path z.svg)" = "-1.000 0.480 2.000 0.510 " ]'
claim "  on logarithmic axes too" eval 'printf "x\ty\n1e-3\t1e-6\n1e6\t1e12\n" | rc-render --log --curve x:y --x-range 10:100 --y-range 1e-3:1e6 -o z.svg && [ "$(path z.svg)" = "-1.000 0.333 2.000 1.000 " ]'
claim "  a line beside the axes is not drawn" eval 'rc-render --curve x:y --x-range 0:10 --y-range 200:300 -o z.svg line.tsv 2>said.txt && ! points z.svg | grep -q solid'
claim "    with a warning" says 'y-range 200:300 goes from 200 to 300, but the values go from 0 to 100: was a unit forgotten\?' cat said.txt
claim "per cent of plain numbers" eval 'printf "x\ty\n0.1\t0.2\n0.3\t0.4\n" | rc-render --curve x:y --y-range 0:50% --y-unit % -o z.svg && [[ "$(axis z.svg)" = *" 0 50" ]]'
claim "a cut, a histogram and a material ratio have them too" eval '
    rc-render --cut y=0 --x-range -0.1mm:0.1mm --y-range -20um:10um -o z.svg ball.rcg && [ "$(axis z.svg)" = "−100 100 −20 10" ] &&
    rc-render --histogram --x-range -10um:10um -o z.svg ball.rcg && [[ "$(axis z.svg)" = "−10 10 "* ]] &&
    rc-render --material-ratio --x-range 0:50% -o z.svg ball.rcg && [[ "$(axis z.svg)" = "0 50 "* ]]'
claim "sealed cases outside of them have no mark" eval 'printf "mean_pressure/Pa\tflow_rate/m3/s\n1\t1e-9\n2\t1e-12\n3\t0\n4\t0\n" |
    rc-render --log y --curve mean_pressure:flow_rate --x-range 0:3 -o z.svg && [ "$(grep -o "<path d=\"[^\"]*Z\"" z.svg | wc -l)" = 2 ] && shows z.svg ">1 case sealed"'

# ---- groups ----

claim "each value of a column gets a curve" eval 'rc-render --curve x:y --by k -o k.svg few.tsv &&
    draws k.svg solid 1 1 1 3 3 6 && draws k.svg solid 3 4 1 2'
claim "  the curve has the name of the value" eval 'shows k.svg ">k a<" && shows k.svg ">k b<"'
claim "groups have their own means" eval 'rc-render --curve x:y --by k --spread -o k.svg few.tsv && draws k.svg solid 1 2 3 6'
printf 'x\ty\ta\tb\n1\t1\tp\t10\n2\t2\tp\t10\n1\t2\tp\t20\n2\t3\tp\t20\n1\t3\tq\t10\n2\t4\tq\t10\n1\t4\tq\t20\n2\t5\tq\t20\n' >two.tsv
claim "of two columns the first sets the colours, the second the dashes" eval '
    rc-render --curve x:y --by a,b -o two.svg two.tsv && points two.svg | grep -E "solid|dashed" >lines &&
    [ "$(cut -d " " -f 1 lines | sort | uniq -c | tr -s " " | cut -d " " -f 2 | paste -s -d ,)" = 2,2 ] &&
    [ "$(grep -c solid lines)" = 2 ]'
for seed in 1 2; do
    rc-synth selfaffine --nx 32 --dx 1um --hurst 0.8 --rms-height 10nm --seed $seed -o $seed.rcg
    rc-export --format gsf -o seed-$seed.gsf $seed.rcg
done
for report in r.tsv r.json; do
    rc-import --quiet seed-1.gsf seed-2.gsf |
        rc-solve --quiet --periodic --load 10mN,20mN --estar 100GPa --report $report --output pressure -o p.rcg
done
for kind in tsv json; do
    claim "rows of several sources become one curve each, $kind" eval "rc-render --curve load:approach -o sources.svg r.$kind &&
        [ \$(points sources.svg | grep -c solid) = 2 ]"
    claim "  the curves have the names of the sources" eval 'shows sources.svg ">seed-1.gsf<" && shows sources.svg ">seed-2.gsf<"'
    claim "  a single case has no number" eval '! shows sources.svg ">case"'
done
claim "spectra have the names of their loads" eval '
    printf "{\"load\": 1, \"q\": [1, 2], \"c\": [2, 1]}\n{\"load\": 2000, \"q\": [1, 2], \"c\": [3, 2]}\n" |
        rc-render --curve q:c -o q.svg && shows q.svg ">load 1 N<" && shows q.svg ">load 2 kN<"'

# ---- words and units ----

claim "--units converts the units" eval 'rc-render --curve x:y --points --x-unit mN --y-unit mm2 -o u.svg few.tsv && draws u.svg marker 3e3 6e6'
claim "  the axes show them" eval 'shows u.svg ">x \\(mN\\)<" && shows u.svg "mm<"'
claim "a fraction can be shown in per cent" eval 'printf "x\ty\n0.1\t0.2\n0.3\t0.4\n" | rc-render --curve x:y --points --y-unit % -o u.svg && draws u.svg marker 0.3 40 && shows u.svg ">y \\(%\\)<"'
claim "a reciprocal unit can be shown" eval 'printf "x/1/Pa\ty/um\n2e-9\t1\n4e-9\t2\n" | rc-render --curve x:y --points --x-unit 1/GPa -o u.svg && draws u.svg marker 4 2'
claim "a prefix is raised with its own symbol: 0.05 J/m2 is 50 mJ/m2" eval 'printf "x\ty/J/m2\tz/m3/s\n1\t0.05\t1e-12\n2\t0.07\t3e-12\n" >raised.tsv &&
    rc-render --curve x:y --points --y-unit mJ/m2 -o u.svg raised.tsv && draws u.svg marker 1 50 && draws u.svg marker 2 70'
claim "  and 1e-12 m3/s are 0.001 mm3/s" eval 'rc-render --curve x:z --points --y-unit mm3/s -o u.svg raised.tsv && draws u.svg marker 2 3e-3'
claim "the texts of the axes can be set" eval 'rc-render --curve x:y --x-label "Normal load" --y-label "Real area, m2" --y-unit m2 -o w.svg few.tsv &&
    shows w.svg ">Normal load \\(N\\)<" && ! shows w.svg "m2 \\(m"'
claim "the texts of the legend can be set" eval 'rc-render --curve x:y --by k --legend "rough;worn, twice" -o w.svg few.tsv && shows w.svg ">rough<" && shows w.svg ">worn, twice<" && ! shows w.svg ">k a<"'
claim "  a single curve then has a legend too" eval 'rc-render --curve x:y --legend steel -o w.svg few.tsv && shows w.svg ">steel<"'
claim "  the legend can be omitted" eval 'rc-render --curve x:y --by k --legend "" -o w.svg few.tsv && ! shows w.svg ">k a<"'
claim "an empty title also removes the subtitle" eval 'rc-render --curve x:y --title "" -o t.svg few.tsv && ! shows t.svg ">few.tsv<"'
claim "  unless a subtitle is given" eval 'rc-render --curve x:y --title "" --subtitle "20 °C" -o t.svg few.tsv && shows t.svg ">20 °C<"'
claim "  the same holds for a map, a cut and a sheet" bash -c '
    for how in "" "--cut y=0" "--sheet 1x1"; do
        rc-render $how --channel height --title "" -o t.svg ball.rcg && ! shows t.svg ">[^<]*(sphere|RMS|mean)[^<]*</text>" || exit 1
        rc-render $how --channel height --subtitle "as turned" -o t.svg ball.rcg && shows t.svg ">as turned<" || exit 1
    done'
claim "units and texts of a cut can be set" eval 'rc-render --cut y=0 --x-unit mm --y-unit nm --x-label Place -o c.svg ball.rcg && shows c.svg ">Place \\(mm\\)<" && shows c.svg "\\(nm\\)<"'

# ---- histories: loading and unloading ----

printf 'load/N\tindentation/m\tcontact_area/m2\n0\t0\t0\n1\t1\t1\n2\t2\t2\n1\t1.5\t1.1\n0\t0.5\t0\n1\t1.5\t1.1\n2\t2\t2\n3\t3\t3\n1\t2\t1.2\n2\t2.5\t2.1\n1\t2\t1.2\n' >history.tsv
claim "a loading history causes no warning about turns" eval 'rc-render --curve indentation:load -o h.svg history.tsv 2>said.txt && [ ! -s said.txt ]'
claim "  its loading has one colour" draws h.svg solid 0 0 1 1 2 2 0.5 0 1.5 1 2 2 3 3 2 1 2.5 2
claim "  its unloading has another colour" draws h.svg solid 2 2 1.5 1 0.5 0 3 3 2 1 2.5 2 2 1
claim "    the two colours differ" eval '[ "$(points h.svg | grep solid | cut -d " " -f 1 | sort -u | wc -l)" = 2 ]'
claim "  the legend names both" eval 'shows h.svg ">loading<" && shows h.svg ">unloading<" && shows h.svg ">Indentation \\(m\\)<"'
claim "  the same holds with the load as x" eval 'rc-render --curve load:contact_area -o h.svg history.tsv && draws h.svg solid 2 2 1 1.1 0 0 3 3 1 1.2 2 2.1 1 1.2'
claim "loads that only grow give one curve" eval 'head -n 4 history.tsv | rc-render --curve indentation:load -o h.svg && draws h.svg solid 0 0 1 1 2 2 && ! shows h.svg ">loading<"'
claim "forty cycles give two curves" eval '{ printf "load\tindentation\n"; perl -e "printf qq(%g\t%g\n0\t%g\n), \$_, \$_, 0.5 * \$_ for 1 .. 40"; } |
    rc-render --curve indentation:load -o h.svg && [ "$(points h.svg | grep -c solid)" = 2 ]'

# ---- seals, notes, categories ----

printf 'mean_pressure/Pa\tflow_rate/m3/s\n1\t1e-9\n2\t1e-12\n3\t0\n4\t0\n' >seal.tsv
claim "a sealed load has a mark at the bottom of a leak curve" rc-render --width 85mm --log y --curve mean_pressure:flow_rate -o seal.svg seal.tsv
claim "  each sealed load has a mark, and the legend has one" test "$(grep -o "<path d=\"[^\"]*Z\"" seal.svg | wc -l)" = 3
claim "  the axis includes these loads" shows seal.svg 'text-anchor="middle" fill="#222222">4(\.0)?<'
claim "  the legend calls them sealed" shows seal.svg '>2 cases sealed \(no flow\)<'
claim "  the power of the unit is raised" shows seal.svg 'm<tspan dy="-[0-9.]*" font-size="[0-9.]*">3</tspan><tspan dy="[0-9.]*">/s|m</tspan><tspan [^>]*>3</tspan>'
claim "  the axis has a power of ten if its marks have none" eval 'printf "load/N\tflow_rate/m3/s\n1\t1e-12\n2\t2e-13\n" | rc-render --log --curve load:flow_rate -o z.svg && ! shows z.svg ">0\\.000" && shows z.svg ">Flow rate \\(10<"'
claim "other columns have normal points there" eval 'sed s/flow_rate/y/ seal.tsv | rc-render --log --curve mean_pressure:y -o z.svg && shows z.svg ">2 points at or below 0<"'
claim "a note that is too long continues on the next line" eval 'sed "1s/x/pressure_over_the_whole_map/" few.tsv | rc-render --curve pressure_over_the_whole_map:y --spread --width 85mm -o n.svg && ! grep -q "…</text>" n.svg && shows n.svg "standard deviation</text>"'
printf 'time/s\tload/N\tmean_pressure/Pa\tflow_rate/m3/s\n0\t5\t1\t1e-9\n1\t5\t1.1\t1e-12\n2\t5\t1.2\t0\n3\t5\t1.3\t0\n' >relaxes.tsv
claim "  in a report of times too" eval 'rc-render --log y --curve time:flow_rate -o seal.svg relaxes.tsv && shows seal.svg ">2 cases sealed \(no flow\)<"'
claim "    whatever x is" eval 'rc-render --log y --curve mean_pressure:flow_rate -o seal.svg relaxes.tsv && shows seal.svg ">2 cases sealed \(no flow\)<"'

# ---- units of logarithmic axes, equal entries of a legend ----

# axis X/UNIT FIRST LAST: the title of a logarithmic axis x from FIRST to LAST.
log_axis() {
    printf '%s\ty\n%s\t1\n%s\t2\n' "$@" >log.tsv && rc-render --log x --curve "${1%%/*}:y" -o log.svg log.tsv &&
        sed 's/<tspan[^>]*>//g; s/<\/tspan>//g' log.svg | grep -o '>[^<]*([^<]*)<' | head -n 1
}
claim "a logarithmic axis of at most three decades has the unit of its middle" test "$(log_axis distance/m 1e-3 1)" = '>Sliding distance (mm)<'
claim "  with numbers from 0.001 to 1000" test "$(log_axis distance/m 10e-3 10)" = '>Sliding distance (m)<'
claim "  pressures too" test "$(log_axis mean_pressure/Pa 1e6 1e9)" = '>Mean pressure (MPa)<'
claim "  areas too" test "$(log_axis area/m2 1e-12 1e-9)" = '>area (µm2)<'
claim "    with the larger unit if the middle is nearer to it" test "$(log_axis area/m2 1e-10 1e-7)" = '>area (mm2)<'
claim "  reciprocal units too" test "$(log_axis k/1/Pa 1e-9 1e-7)" = '>k (1/GPa)<'
claim "a longer one has the SI unit" test "$(log_axis distance/m 1e-3 100)" = '>Sliding distance (m)<'
claim "  and numbers or powers of ten" eval 'shows log.svg ">0\.001<" && shows log.svg ">100<" &&
    [ "$(log_axis speed/m/s 1e-6 10)" = ">Sliding speed (m/s)<" ] && shows log.svg ">10<tspan dy=\"-[0-9.]*\" font-size=\"[0-9.]*\">−6"'
claim "  times too" test "$(log_axis time/s 1e-3 1e4)" = '>Time (s)<'
claim "  areas too" test "$(log_axis area/m2 1e-12 1e-7)" = '>area (m2)<'
claim "plain numbers have no power of ten beside them, logarithmic" test "$(log_axis friction 2e-3 8e-3)" = ''
claim "  or not" eval 'rc-render --curve friction:y -o log.svg log.tsv && ! shows log.svg "10<tspan" && shows log.svg ">0\.00[0-9]<"'
claim "  less than a decade has the unit of the largest value" test "$(log_axis distance/m 0.4 2)" = '>Sliding distance (m)<'
claim "  a unit without a prefix stays" test "$(log_axis wear_volume/m3 1e-15 1e-12)" = '>Worn volume (m3)<'
claim "equal entries of a legend are joined, and their curves have one colour" eval 'printf "x\ty\n1\t2\n2\t3\n" >one.tsv && mkdir -p other && printf "x\ty\n1\t3\n2\t4\n" >other/one.tsv &&
    rc-render --curve x:y --legend "steel;steel" -o l.svg one.tsv other/one.tsv && [ "$(grep -o ">steel<" l.svg | wc -l)" = 1 ] &&
    [ "$(points l.svg | grep solid | cut -d " " -f 1 | sort -u | wc -l)" = 1 ]'
claim "  other entries stay" eval 'rc-render --curve x:y --legend "steel;brass" -o l.svg one.tsv other/one.tsv && shows l.svg ">steel<" && shows l.svg ">brass<" &&
    [ "$(points l.svg | grep solid | cut -d " " -f 1 | sort -u | wc -l)" = 2 ]'

printf 'mat\ty/N\nsteel\t1\nrubber\t3\nsteel\t2\nPTFE, filled with bronze\t2\n' >words.tsv
# Prints the positions of the markers across the plot, 0 to 1.
across() {
    perl -0777 -ne 'my ($x, $w) = /<clipPath id="\w+"><rect x="([\d.]+)" y="[\d.]+" width="([\d.]+)"/ or die;
        printf "%.3f ", ($1 - $x) / $w while /<path d="M([\d.]+) ([\d.]+)L\1 \2"/g' "$1"
}
claim "words become categories of the x axis, in their order" eval 'rc-render --curve mat:y -o c.svg words.tsv &&
    [ "$(across c.svg)" = "0.167 0.500 0.167 0.833 " ] && shows c.svg ">steel<" && shows c.svg ">rubber<"'
claim "  in JSON too" eval 'printf "{\"mat\": \"a\", \"y\": 1}\n{\"mat\": \"b\", \"y\": 2}\n" | rc-render --curve mat:y -o c.svg && [ "$(across c.svg)" = "0.250 0.750 " ]'
claim "  with means too" eval 'rc-render --curve mat:y --spread -o c.svg words.tsv && [ "$(across c.svg)" = "0.167 0.500 0.833 " ]'
claim "  the same word in two tables is one category" eval 'sed "s/PTFE/PA/" words.tsv | sed 2d >a.tsv && rc-render --curve mat:y -o c.svg words.tsv a.tsv &&
    [[ "$(across c.svg)" = "0.125 0.375 0.125 0.625 "* ]]'
claim "  long words are drawn upright and complete" eval 'rc-render --width 85mm --curve mat:y -o c.svg words.tsv && shows c.svg "rotate.*>PTFE, filled with bronze<"'
claim "a column with one number counts as numeric" eval 'printf "x\ty\na\t1\n2\t3\n4\t5\n" | rc-render --curve x:y -o c.svg && draws c.svg solid 2 3 4 5'

# ---- refusals ----

refuses 2 '--log: column mat contains words, which have no logarithm: give the other axis alone, as in --log y' "a logarithm of words" "$draw --log --curve mat:y words.tsv"
refuses 1 'few.tsv: column x holds numbers, that of n.tsv words: draw two pictures' "words and numbers" "printf 'x/N\ty/m2\na\t1\n' >n.tsv && $draw --curve x:y n.tsv few.tsv"
refuses 1 'column k holds more than 40 different words, too many for an axis' "a word a row" "perl -e 'print \"k\ty\n\"; print \"a\$_\t1\n\" for 1 .. 41' | $draw --curve k:y"

refuses 2 '--x-unit m: the axis is in N: it must be that unit, with or without a prefix' "a unit of something else" "$draw --curve x:y --x-unit m few.tsv"
refuses 2 '--y-unit N: the axis is in plain numbers: it must be 1 or %' "a unit of a number" "printf 'x\ty\n1\t2\n' | $draw --curve x:y --y-unit N"
refuses 2 "--legend: 1 text for 2 curves of the legend: give one each, in its order, separated by ';'" "too few names" "$draw --curve x:y --by k --legend a few.tsv"
refuses 2 '--error e: it must be one column for each of --curve' "too few errors" "$draw --curve x:y,e --error e few.tsv"
refuses 2 '--spread does not work with --error' "two kinds of bars" "$draw --curve x:y --error e --spread few.tsv"
refuses 2 '--by k,e,x: it must be names of columns, 2 at most' "three columns to tell apart" "$draw --curve x:y --by k,e,x few.tsv"
refuses 2 '--by ,k: it must be names of columns' "a column without a name" "$draw --curve x:y --by ,k few.tsv"
refuses 1 'few.tsv: there is no column z: there are x, y, k, e' "a column that is not there" "$draw --curve x:y --by z few.tsv"
refuses 2 '--spread has no effect without --curve' "the spread of a map" "$draw --spread ball.rcg"
refuses 2 '--x-unit has no effect without --curve, --cut, --histogram or --material-ratio' "units of a map" "$draw --x-unit mm ball.rcg"
refuses 2 'the text is not UTF-8' "a legend that is not text" "$draw --curve x:y --legend \$'\\xff' few.tsv"
refuses 1 'more than 63 curves in one picture' "a curve a row" "perl -e 'print \"x\ty\tk\n\"; print \"\$_\t1\t\$_\n\" for 1 .. 80' | $draw --curve x:y --by k"
refuses 2 '--range does not work with --curve, because it is for maps and --cut: the axes of a curve have --x-range and --y-range' "the range of colours" "$draw --curve x:y --range 0:1 few.tsv"
refuses 2 '--y-range does not work with --range' "two ranges of a cut" "$draw --cut y=0 --range 0:1um --y-range 0:1um ball.rcg"
refuses 2 '--x-range has no effect without --curve, --cut, --histogram or --material-ratio' "ends of the axis of a map" "$draw --x-range 0:1mm ball.rcg"
refuses 2 '--x-range 0:1m: it must be LO:HI, two values with LO below HI, in N with or without a prefix' "an end in another unit" "$draw --curve x:y --x-range 0:1m few.tsv"
for wrong in 1 1: :1 1:1 2:1 1:2:3 a:b nan:1 0:inf 0x1:0x2 1:; do
    refuses 2 "--x-range $wrong: it must be LO:HI" "ends $wrong" "$draw --curve x:y --x-range $wrong few.tsv"
done
refuses 2 '--x-range 1:2N: give both values their unit, or neither' "one unit of two" "$draw --curve x:y --x-range 1:2N few.tsv"
refuses 2 '--log has no place for 0 and below: give a --y-range above it' "a logarithm of 0" "$draw --log y --curve x:y --y-range 0:9 few.tsv"
refuses 2 '--x-range: the axis has words, which have no range: leave it out' "a range of words" "$draw --curve mat:y --x-range 0:1 words.tsv"
claim "refused commands leave no picture" bash -c '[ ! -e out.svg ] && [ -z "$(ls out.svg.* 2>/dev/null)" ]'

# ---- titles of figures ----

printf 'sa/m\tsq/m\tlimit/N\tstick_fraction\n1\t2\t3\t4\n2\t3\t4\t5\n' >figures.tsv
claim "parameters of a surface have the names of their standard" eval 'rc-render --curve sa:sq -o t.svg figures.tsv && shows t.svg ">Sq against Sa<"'
claim "  moments and energies of rolling have a unit with a prefix" eval 'printf "creep_x\tmoment/Nm\tpower/J/m\n0\t1e-6\t2e-3\n1\t5e-6\t4e-3\n" >rolls.tsv && rc-render --curve creep_x:moment -o t.svg rolls.tsv && shows t.svg "\(µNm\)<" &&
    rc-render --curve creep_x:power -o t.svg rolls.tsv && shows t.svg "\(mJ/m\)<"'
claim "  figures of friction have their titles" eval 'rc-render --curve limit:stick_fraction -o t.svg figures.tsv &&
    shows t.svg ">Part of the contact that sticks against largest tangential force<"'

# ---- titles of several columns ----

printf 'creep_x\ttangential_x/N\tkalker_tangential_x/N\n0\t0\t0\n1e-3\t10\t12\n' >theory.tsv
$draw --curve creep_x:tangential_x,kalker_tangential_x theory.tsv
claim "columns whose titles begin alike share the title of the axis" shows out.svg '>Force along x \(N\)<'
claim "  and of the figure" shows out.svg '>Force along x against creepage along x<'
claim "  and the legend has both" eval "shows out.svg '>Force along x<' && shows out.svg '>Force along x in linear theory \(Kalker\)<'"
$draw --curve creep_x:tangential_x,tangential_y <(sed '1s/kalker_tangential_x/tangential_y/' theory.tsv)
claim "others have the quantity that they share" shows out.svg '>Force \(N\)<'
claim "  in the title too" shows out.svg '>Force against creepage along x<'
claim "  and their names in the legend" eval "shows out.svg '>Force along x<' && shows out.svg '>Force along y<'"
# shares QUANTITY COLUMN/UNIT COLUMN/UNIT: the label of the axis of these two columns.
shares() {
    printf 'speed\t%s\t%s\n1\t1\t2\n2\t3\t4\n' "${@:2}" | $draw --width 85mm --curve "speed:${2%%/*},${3%%/*}" && shows out.svg "rotate[^>]*>$1<"
}
claim "  pressures too" shares 'Pressure \(Pa\)' max_pressure/Pa mean_pressure/Pa
claim "  stresses of two names are stresses" shares 'Stress \(Pa\)' max_pressure/Pa largest_hydrostatic/Pa
claim "  temperatures are those above the bodies" shares 'Temperature rise \(K\)' max_temperature/K mean_temperature/K
claim "  coefficients of friction too" shares 'Coefficient of friction' friction friction_by_heights
claim "  numbers that share nothing are all named" shares 'height ratio, twist' 'height ratio' twist
text='Indentation of the rough steel ball into the polished glass plate after polishing under water'
$draw --width 85mm --curve x:y --x-label "$text" --y-label "$text" few.tsv
claim "a long label has two lines, and the unit at their end" shows out.svg 'rotate[^>]*>Indentation of the rough steel ball<'
claim "  shortened between words" shows out.svg 'rotate[^>]*>into the polished glass… \(m'
claim "  on both axes" shows out.svg 'middle" fill="#222222">polished glass plate after[^<]* \(N\)<'
claim "  inside of the picture" eval "perl -ne 'push @x, \$1 while /<text x=\"(-?[0-9.]+)\"/g; END { print scalar(grep { \$_ < 0 } @x) }' out.svg | grep -qx 0"

# ---- speeds are no history ----

printf 'speed\tfriction\tload/N\tindentation/m\tresidual_indentation/m\tapproach/m\n1\t0.1\t1\t3e-6\t0\t3e-6\n2\t0.2\t1\t2e-6\t0\t2e-6\n' >speeds.tsv
$draw --curve speed:friction speeds.tsv
claim "cases with speeds have no loading and unloading" bash -c '! grep -q loading out.svg && grep -q "<path" out.svg'
$draw --curve load:friction <(sed '1s/speed/other/' speeds.tsv)
claim "  rows of a history have" shows out.svg 'unloading'

# ---- cases whose x begins anew ----

printf 'case\tdepth/m\tmises/Pa\n' >depths.tsv
for case in 1 2 3; do for depth in 0 1e-6 2e-6 3e-6; do printf '%s\t%s\t%s\n' $case $depth $((case * 1000)); done; done >>depths.tsv
claim "values by depth of three cases are three curves" eval 'rc-render --curve depth:mises -o depths.svg depths.tsv 2>depths.err && [ ! -s depths.err ] &&
    [ $(points depths.svg | grep -c solid) = 3 ]'
claim "  with the names of the cases" eval 'shows depths.svg ">case 1<" && shows depths.svg ">case 3<"'
awk 'NR > 1 { $2 = NR * 1e-6 } { print }' OFS='\t' depths.tsv >along.tsv
claim "  where x goes on, cases are one curve" eval 'rc-render --curve depth:mises -o along.svg along.tsv && [ $(points along.svg | grep -c solid) = 1 ]'
