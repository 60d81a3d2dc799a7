# Curves as a figure in a journal has them: points that are means with their bars, in the units and words that are
# asked for, groups of rows told apart by what they are. Points are read off the SVG by the marks of its axes, and
# compared with means and deviations that are known.
. "$(dirname "$0")/../pipe.sh"

points() {
    perl "$RC_SOURCE/tests/tools/points.pl" <"$1"
}
# near FILE KIND NUMBER...: one of its paths of that kind has these numbers, to a thousandth of the largest.
near() {
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
export -f points near shows

# ---- means, their spread, columns of errors ----

# 2 with deviations -1 0 1: deviation 1; 5 with -1 and 1: sqrt 2
printf 'x/N\ty/m2\tk\te/m2\n1\t1\ta\t0.5\n3\t4\tb\t1\n1\t2\tb\t0.5\n1\t3\ta\t0.25\n3\t6\ta\t1\n' >few.tsv
claim "rows that share an x are a point" rc-render --curve x:y --spread -o s.svg few.tsv
claim "  their mean" near s.svg solid 1 2 3 5
claim "  with bars as long as their standard deviation (n - 1)" near s.svg bars 1 1 1 3
claim "  at each" eval "points s.svg | awk '\$2 == \"bars\" { d = (\$18 - \$16) / 2; ok = (d - sqrt(2)) ^ 2 < 1e-5 } END { exit !ok }'"
claim "  and the figure says what they are" shows s.svg 'means of the rows that share x \(2 to 3 each\) · bars: their standard deviation'
claim "without --spread nothing is a mean" eval 'rc-render --curve x:y -o z.svg few.tsv && near z.svg solid 1 1 3 4 1 2 1 3 3 6'
printf 'x\ty\n1\t1\n2\t2\n1\t1.1\n2\t2.1\n1\t0.9\n2\t1.9\n' >seeds.tsv
claim "  but a line that goes back and forth is warned of" warns 'seeds.tsv: the line turns back 4 times along x: --spread makes a point of rows that share it, --by COLUMN a curve of each group' \
    rc-render --curve x:y -o z.svg seeds.tsv
claim "    not with --spread, nor one that turns back once" eval 'rc-render --curve x:y --spread -o z.svg seeds.tsv 2>said.txt && [ ! -s said.txt ] &&
    head -n 5 seeds.tsv | sed 4d | rc-render --curve x:y -o z.svg 2>said.txt && [ ! -s said.txt ]'
claim "a column of errors is a bar to both sides" eval 'rc-render --curve x:y --error e -o e.svg few.tsv && near e.svg bars 1 0.5 1 1.5'
claim "  and the figure says which" shows e.svg 'bars: ± e<'
claim "bars that reach to 0 run out of a logarithmic axis" eval '
    printf "x/N\ty/m\te/m\n1\t1\t2\n2\t2\t0.5\n3\t3\t1\n" | rc-render --curve x:y --error e --log -o l.svg && shows l.svg "M[0-9.]+ [0-9]{4}[0-9.]*L"'
claim "markers without lines" eval 'rc-render --curve x:y --points -o p.svg few.tsv && ! points p.svg | grep -q solid'
claim "  in their places" near p.svg marker 3 6

# ---- groups ----

claim "a curve for each value of a column" eval 'rc-render --curve x:y --by k -o k.svg few.tsv &&
    near k.svg solid 1 1 1 3 3 6 && near k.svg solid 3 4 1 2'
claim "  called after it" eval 'shows k.svg ">k a<" && shows k.svg ">k b<"'
claim "groups have means of their own" eval 'rc-render --curve x:y --by k --spread -o k.svg few.tsv && near k.svg solid 1 2 3 6'
printf 'x\ty\ta\tb\n1\t1\tp\t10\n2\t2\tp\t10\n1\t2\tp\t20\n2\t3\tp\t20\n1\t3\tq\t10\n2\t4\tq\t10\n1\t4\tq\t20\n2\t5\tq\t20\n' >two.tsv
claim "of two columns colours tell the one, dashes the other" eval '
    rc-render --curve x:y --by a,b -o two.svg two.tsv && points two.svg | grep -E "solid|dashed" >lines &&
    [ "$(cut -d " " -f 1 lines | sort | uniq -c | tr -s " " | cut -d " " -f 2 | paste -s -d ,)" = 2,2 ] &&
    [ "$(grep -c solid lines)" = 2 ]'
rc-synth sphere --nx 33 --dx 20um --radius 7.5mm -o ball.rcg
for seed in 1 2; do
    rc-synth selfaffine --nx 32 --dx 1um --hurst 0.8 --rms-height 10nm --seed $seed -o $seed.rcg
    rc-export --format gsf -o seed-$seed.gsf $seed.rcg
done
for report in r.tsv r.json; do
    rc-import --quiet seed-1.gsf seed-2.gsf |
        rc-solve --quiet --periodic --load 10mN,20mN --estar 100GPa --report $report --output pressure -o p.rcg
done
for kind in tsv json; do
    claim "rows of several sources are a curve each, $kind" eval "rc-render --curve load:approach -o sources.svg r.$kind &&
        [ \$(points sources.svg | grep -c solid) = 2 ]"
    claim "  called after these" eval 'shows sources.svg ">seed-1.gsf<" && shows sources.svg ">seed-2.gsf<"'
    claim "  no case has a number" eval '! shows sources.svg ">case"'
done
claim "spectra are called after the loads that they are of" eval '
    printf "{\"load\": 1, \"q\": [1, 2], \"c\": [2, 1]}\n{\"load\": 2000, \"q\": [1, 2], \"c\": [3, 2]}\n" |
        rc-render --curve q:c -o q.svg && shows q.svg ">load 1 N<" && shows q.svg ">load 2 kN<"'

# ---- words and units ----

claim "units as asked for" eval 'rc-render --curve x:y --points --x-unit mN --y-unit mm2 -o u.svg few.tsv && near u.svg marker 3e3 6e6'
claim "  on the axes" eval 'shows u.svg ">x \\(mN\\)<" && shows u.svg "mm<"'
claim "per cents" eval 'printf "x\ty\n0.1\t0.2\n0.3\t0.4\n" | rc-render --curve x:y --points --y-unit % -o u.svg && near u.svg marker 0.3 40 && shows u.svg ">y \\(%\\)<"'
claim "a reciprocal" eval 'printf "x/1/Pa\ty/um\n2e-9\t1\n4e-9\t2\n" | rc-render --curve x:y --points --x-unit 1/GPa -o u.svg && near u.svg marker 4 2'
claim "texts of the axes" eval 'rc-render --curve x:y --x-label "Normal load" --y-label "Real area, m2" --y-unit m2 -o w.svg few.tsv &&
    shows w.svg ">Normal load \\(N\\)<" && ! shows w.svg "m2 \\(m"'
claim "texts of the legend" eval 'rc-render --curve x:y --by k --legend "rough;worn, twice" -o w.svg few.tsv && shows w.svg ">rough<" && shows w.svg ">worn, twice<" && ! shows w.svg ">k a<"'
claim "  of one curve, which else has none" eval 'rc-render --curve x:y --legend steel -o w.svg few.tsv && shows w.svg ">steel<"'
claim "  or none at all" eval 'rc-render --curve x:y --by k --legend "" -o w.svg few.tsv && ! shows w.svg ">k a<"'
claim "an empty title takes the subtitle too" eval 'rc-render --curve x:y --title "" -o t.svg few.tsv && ! shows t.svg ">few.tsv<"'
claim "  unless one is given" eval 'rc-render --curve x:y --title "" --subtitle "20 °C" -o t.svg few.tsv && shows t.svg ">20 °C<"'
claim "  of a map, a cut and a sheet too" bash -c '
    for how in "" "--cut y=0" "--sheet 1x1"; do
        rc-render $how --channel height --title "" -o t.svg ball.rcg && ! shows t.svg ">[^<]*(sphere|RMS|mean)[^<]*</text>" || exit 1
        rc-render $how --channel height --subtitle "as turned" -o t.svg ball.rcg && shows t.svg ">as turned<" || exit 1
    done'
claim "units and texts of a cut" eval 'rc-render --cut y=0 --x-unit mm --y-unit nm --x-label Place -o c.svg ball.rcg && shows c.svg ">Place \\(mm\\)<" && shows c.svg "\\(nm\\)<"'

# ---- what is not ----

refuses 2 '--x-unit m: the axis is in N: it must be that with a prefix or without' "a unit of something else" "$draw --curve x:y --x-unit m few.tsv"
refuses 2 '--y-unit N: the axis is in plain numbers: it must be 1 or %' "a unit of a number" "printf 'x\ty\n1\t2\n' | $draw --curve x:y --y-unit N"
refuses 2 "--legend: 1 text for 2 curves of the legend: give one each, in its order, separated by ';'" "too few names" "$draw --curve x:y --by k --legend a few.tsv"
refuses 2 '--error e: it must be one column for each of --curve' "too few errors" "$draw --curve x:y,e --error e few.tsv"
refuses 2 '--spread and --error are two kinds of bars: give one' "two kinds of bars" "$draw --curve x:y --error e --spread few.tsv"
refuses 2 '--by k,e,x: it must be names of columns, 2 at most' "three columns to tell apart" "$draw --curve x:y --by k,e,x few.tsv"
refuses 2 '--by ,k: it must be names of columns' "a column without a name" "$draw --curve x:y --by ,k few.tsv"
refuses 1 'few.tsv: there is no column z: there are x, y, k, e' "a column that is not there" "$draw --curve x:y --by z few.tsv"
refuses 2 'it is for tables, with --curve X:Y: leave out --spread' "the spread of a map" "$draw --spread ball.rcg"
refuses 2 'it is for curves: --curve, --cut, --histogram, --material-ratio: leave out --x-unit' "units of a map" "$draw --x-unit mm ball.rcg"
refuses 2 'the text is not UTF-8' "a legend that is no text" "$draw --curve x:y --legend \$'\\xff' few.tsv"
refuses 1 'more than 63 curves in one picture' "a curve a row" "perl -e 'print \"x\ty\tk\n\"; print \"\$_\t1\t\$_\n\" for 1 .. 80' | $draw --curve x:y --by k"
claim "none of these left a picture behind" bash -c '[ ! -e out.svg ] && [ -z "$(ls out.svg.* 2>/dev/null)" ]'

finish
