# SPDX-License-Identifier: GPL-3.0-or-later
# Tables and reports become curves. rc-render reads the reports of rc-solve in both forms. It refuses other
# files, missing columns and tables without a curve, with the right exit status and without a picture.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 65 --dx 10um --radius 7.5mm -o ball.rcg
rc-solve --quiet --load 1N,2N,4N --estar 114GPa --report r.tsv --output pressure -o p.rcg ball.rcg
rc-solve --quiet --load 1N,2N,4N --estar 114GPa --report - ball.rcg >r.json
draw='rc-render -o out.png'

# ---- drawings ----

claim "a table becomes a curve" rc-render --curve load:contact_area -o t.png r.tsv
claim "lines of JSON become a curve" rc-render --curve load:contact_area -o j.png r.json
claim "  a pipe becomes a curve" bash -c 'rc-render --curve load:contact_area <r.json >k.png'
claim "the same numbers give the same picture, except for the name of the file" bash -c '
    mkdir -p a b && cp r.tsv a/r && cp r.json b/r &&
    rc-render --curve load:contact_area --quiet -o a.png a/r &&
    rc-render --curve load:contact_area --quiet -o b.png b/r && cmp a.png b.png'
claim "several columns, several files and a law can be drawn together" bash -c '
    rc-render --curve load:contact_area,plastic_area --log x -o m.png r.tsv r.json &&
    rc-render --curve load:max_pressure --law hertz --radius 7.5mm --estar 114GPa -o l.png r.tsv'
claim "--log accepts its words with =, without = or not at all" bash -c '
    rc-render --curve load:approach --log=xy --title T <r.json >a.png &&
    rc-render --curve load:approach --log xy --title T <r.json >b.png &&
    rc-render --curve load:approach --log --title T <r.json >c.png &&
    rc-render --log y --curve load:approach --title T <r.json >d.png &&
    for f in a b c d; do perl -0777 -ne "print \$1 while /IDAT(.*?)....IEND/gs" $f.png >$f.idat; done
    cmp a.idat b.idat && cmp a.idat c.idat && ! cmp -s a.idat d.idat'
claim "the picture contains the command that made it" grep -aqF -- '--log --title T --curve load:approach' c.png
claim "unknown values are gaps in the curve" bash -c '
    printf "x/m\ty/m\n1\t1\n2\tNaN\n3\t\n4\t2\n" | rc-render --curve x:y -o g.png'
sed 's/"converged": true/"converged": false/' r.json >short.json
rc-render --curve load:approach --quiet -o s.png short.json
claim "a solution that stopped short makes the exit status 3" test $? = 3
claim "  the picture says so" bash -c 'tr "\0" = <s.png | says "tEXtWarning=not converged" cat'

while read -r x y; do
    claim "a point at $x and $y is drawn" bash -c "printf 'x/m\ty/Pa\n0\t0\n$x\t$y\n' | rc-render --curve x:y -o g.png"
    claim "  a single point too" bash -c "printf 'x/m\ty/Pa\n$x\t$y\n' | rc-render --curve x:y -o g.png"
    claim "  on logarithmic axes too" bash -c "printf 'x/m\ty/m2\n${x#-}\t${y#-}\n1e-3\t7\n' | rc-render --curve x:y --log -o g.png"
done <<'END'
1e308 -1e308
5e-324 1e-300
1e300 1e-300
1.0000000000001 1
END

# ---- refusals ----

refuses 1 'p.rcg is a grid stream: --curve draws tables' "a stream" "$draw --curve load:approach p.rcg"
refuses 1 'r.json is not a grid stream: it looks like a table: draw columns of it, as in --curve' \
    "a report without --curve" "$draw r.json"
refuses 1 'standard input is not a grid stream: it looks like a table' "a table in a pipe without --curve" "$draw <r.tsv"
refuses 1 'r.tsv: there is no column force: there are case, source, nx' "a column that is not there" \
    "$draw --curve force:approach r.tsv"
refuses 1 'r.json: there is no column force: there are case, source, nx' "the same of JSON" "$draw --curve force:approach r.json"
refuses 1 'r.tsv: column boundary holds no number, but words' "a column of words" "$draw --curve load:boundary r.tsv"
refuses 1 'approach is in m, contact_area in m2: an axis has one unit' "two units on an axis" \
    "$draw --curve load:contact_area,approach r.tsv"
refuses 1 'line 3: it has 1 columns, the heading has 2' "a row too short" \
    "printf 'a\tb\n1\t2\n3\n' | $draw --curve a:b"
refuses 1 "line 2: this is not JSON: '}' is missing|line 2: this is not JSON: ',' is missing" "JSON that is cut off" \
    "printf '{\"a\": 1, \"b\": 2}\n{\"a\": 3' | $draw --curve a:b"
refuses 1 'this is not JSON' "half of JSON" "printf '{\"a\": 1, \"b\" 2}' | $draw --curve a:b"
refuses 1 'its JSON is nested too deep' "JSON of a thousand brackets" \
    "perl -e 'print \"{\\\"a\\\":\" . \"[\" x 100000' | $draw --curve a:b"
refuses 1 'its arrays have 3 and 2 values' "arrays that differ" \
    "printf '{\"a\": [1,2,3], \"b\": [1,2]}' | $draw --curve a:b"
refuses 1 'it holds binary data' "a table with a NUL" "printf 'a\tb\n1\t\0002\n' | $draw --curve a:b"
refuses 1 'standard input is empty' "nothing" "$draw --curve a:b </dev/null"
refuses 1 'a heading and no row' "a heading alone" "printf 'a\tb\n' | $draw --curve a:b"
refuses 1 'no point lies above 0 on its logarithmic axes: leave out --log' "a logarithm of nothing" \
    "printf 'a\tb\n1\t-1\n' | $draw --curve a:b --log"
refuses 1 'a table of more than 100 bytes is not read' "a table over --memory" "$draw --memory 100 --curve load:approach r.tsv"
refuses 1 'nowhere.tsv: No such file' "a file that is not there" "$draw --curve a:b nowhere.tsv"
refuses 2 'it must be X:Y' "no colon" "$draw --curve load r.tsv"
refuses 2 'it must be X:Y' "no column" "$draw --curve load:approach, r.tsv"
refuses 2 '--channel does not work with --curve' "an option of maps" "$draw --curve load:approach --channel gap r.tsv"
refuses 2 '--law has no effect without --curve or --histogram' "a law of no curve" "$draw --law hertz p.rcg"
refuses 2 '--law hertz needs --radius: give it' "a law without its radius" "$draw --curve load:approach --law hertz --estar 1GPa r.tsv"
refuses 2 '--law persson relates contact_fraction or contact_area over load' "a law of something else" \
    "$draw --curve load:approach --law persson --estar 1GPa --rms-slope 0.1 r.tsv"
printf 'load/N\tcontact_fraction\n1\t0.5\n' >few.tsv
refuses 1 'it needs the area of the map, the columns nx, ny, dx and dy' "a law without the area of the map" \
    "$draw --curve load:contact_fraction --law hertz --estar 1GPa --radius 1mm few.tsv"
refuses 1 'no point has a number on both axes' "points of halves" "printf 'a\tb\nNaN\t1\n2\tNaN\n' | $draw --curve a:b"
claim "refused commands leave no picture" bash -c '[ ! -e out.png ] && [ -z "$(ls out.png.* 2>/dev/null)" ]'


# ---- curves of frames ----

draw='rc-render -o out.png'
claim "a cut of several cases is drawn" rc-render --cut x=0.1mm --case 1,3 -o c.png p.rcg
claim "a cut of a section at a depth and at a place too" bash -c '
    rc-stress --quiet --nu 0.3 --section y=0 --depths 5um,10um,40um --components mises p.rcg >s.rcg &&
    rc-render --cut depth=9um --case 1 -o c.png s.rcg && rc-render --cut x=0 --case 1,2 -o d.png s.rcg'
refuses 2 '--cut z=0: it must be x=PLACE or y=PLACE, as in y=0' "a cut across no axis" "$draw --cut z=0 --case 1 p.rcg"
refuses 2 '--cut y=0: it must be x=PLACE or depth=PLACE' "a cut of a section across y" "$draw --cut y=0 --case 1 s.rcg"
refuses 2 "--cut y=3N: unknown unit 'N'|--cut y=3N" "a place in newtons" "$draw --cut y=3N --case 1 p.rcg"
refuses 1 'it has nodes from y = −320 µm to 320 µm' "a cut beyond the map" "$draw --cut y=1mm --case 1 p.rcg"
refuses 1 'has no frame|no frame|no case|case 7' "a case that is not there" "$draw --cut y=0 --case 1,7 p.rcg"
refuses 2 '--cut does not work with --histogram' "two kinds of curves" "$draw --cut y=0 --histogram p.rcg"
refuses 2 '--colormap does not work with --cut' "colours of a curve" "$draw --cut y=0 --colormap grey p.rcg"
refuses 2 '--law hertz: a histogram has the law persson' "another law" "$draw --histogram --case 1 --law hertz --radius 1mm p.rcg"
refuses 2 '--law persson needs --rms-slope' "a law without its slope" "$draw --histogram --case 1 --law persson p.rcg"

# ---- sheets ----

claim "a list of cases becomes a sheet" rc-render --case 1,3 -o c.png p.rcg
claim "a sheet of sections is drawn" rc-render --sheet 1x3 -o c.png s.rcg
claim "the texts of a sheet come from its frames" bash -c 'grep -aqF -- "--sheet 1x3" c.png'
refuses 1 '3 frames match, but --sheet 1x2 has room for 2' "a sheet too small" "$draw --sheet 1x2 p.rcg"
refuses 2 '--sheet 2: it must be COLSxROWS, as in 3x2, or auto' "a sheet of one number" "$draw --sheet 2 p.rcg"
refuses 2 '--sheet 0x2: it must be' "a sheet of no column" "$draw --sheet 0x2 p.rcg"
refuses 2 '--raw does not work with --case LIST' "raw pictures of several" "$draw --raw --case 1,2 p.rcg"
refuses 2 '--sheet does not work with --histogram' "a sheet of curves" "$draw --sheet auto --histogram p.rcg"
refuses 1 '20 columns on 400 pixels leave' "a sheet too narrow" "$draw --sheet 20x1 --width 400 p.rcg"
rc-synth sphere --nx 33 --dx 10um --radius 7.5mm -o small.rcg
refuses 1 'a sheet shows maps of one size' "maps of two sizes" "$draw --sheet auto ball.rcg small.rcg"
rc-synth wave --nx 30 --ny 1 --dx 1um --amplitude 1um --wavelength 10um -o wave.rcg
refuses 1 'a profile is not a map: draw several as curves' "profiles" "$draw --sheet auto wave.rcg wave.rcg"
claim "profiles are drawn as curves" rc-render --cut y=0 --case 1,2 -o c.png wave.rcg wave.rcg

# ---- reliefs ----

claim "reliefs are drawn from any direction" bash -c '
    rc-render --view 30,35 -o v.png ball.rcg && rc-render --view=-400e-1,10 -o w.png ball.rcg'
printf '0 1 0 nan\n1 3 1 2\n0 nan 0 1\n1 1 1 1\n' >holes.txt
claim "a map with holes is drawn" bash -c '
    rc-import --dx 1um --z-unit um holes.txt | rc-render --view 30,35 --quiet -o h.png && [ -s h.png ]'
claim "maps of 2 x 3 nodes, of equal values, and a hundred times longer than wide are drawn" bash -c '
    rc-synth wave --nx 2 --ny 3 --dx 1um --amplitude 1um --wavelength 2um | rc-render --view 30,35 -o h.png &&
    printf '2 2 2\\n2 2 2\\n2 2 2\\n' >flat.txt && rc-import --dx 1um --z-unit um flat.txt | rc-render --view 30,35 -o h.png &&
    rc-synth wave --nx 400 --ny 4 --dx 1um --amplitude 1um --wavelength 20um | rc-render --view 30,35 -o h.png'
claim "a map with shadows and a sheet of such maps are drawn" bash -c '
    rc-render --hillshade -o h.png ball.rcg && rc-render --hillshade --sheet 2x2 -o h.png p.rcg'
refuses 2 '--view 30: it must be AZ,EL in degrees' "one angle" "$draw --view 30 ball.rcg"
refuses 2 '--view 30,0: it must be AZ,EL' "a view along the map" "$draw --view 30,0 ball.rcg"
refuses 2 '--view 30,91: it must be AZ,EL' "a view from below the other side" "$draw --view 30,91 ball.rcg"
refuses 2 '--view x,y: ' "a view of words" "$draw --view x,y ball.rcg"
refuses 2 '--view does not work with --raw' "a raw relief" "$draw --view 30,35 --raw ball.rcg"
refuses 2 '--hillshade does not work with --view' "shadows on a relief" "$draw --view 30,35 --hillshade ball.rcg"
refuses 1 'a relief is of a map, this is a profile or a section' "a relief of a section" "$draw --view 30,35 --case 1 s.rcg"
claim "refused commands leave no picture" bash -c '[ ! -e out.png ] && [ -z "$(ls out.png.* 2>/dev/null)" ]'
