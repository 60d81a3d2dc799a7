# A picture is a PNG, SVG or PDF and is called one: another ending is a wrong command line, told before the work.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 16 --dx 1um --radius 1mm -o sphere.rcg

for name in b.eps b.svgz b b. bpng b.png.txt b.jpeg .pngx; do
    refuses 2 "rc-render: -o $name: a picture is a PNG, SVG or PDF: its name has to end in .png, .svg or .pdf" "rc-render -o $name" \
        "rc-render -o $name sphere.rcg"
    refuses 2 "rc-cost: --plot $name: a picture is a PNG, SVG or PDF" "rc-cost --plot $name" \
        "rc-cost --load 1mN --estar 100GPa --plot $name sphere.rcg"
done
claim "none of them left a file" test "$(echo *)" = "refuses.err refuses.out sphere.rcg"
refuses 2 'has to end in .png, .svg or .pdf' "before anything is read" 'rc-render -o b.eps nowhere.rcg'
for name in a.png A.PNG b.Png ./c.d/x.png; do
    mkdir -p c.d
    claim "rc-render -o $name" bash -c "rc-render -o $name sphere.rcg && [ -s $name ]"
done
for name in a.svg A.SVG a.pdf ./c.d/X.Pdf; do
    claim "rc-render -o $name" bash -c "rc-render -o $name sphere.rcg && [ -s $name ]"
done
claim "an SVG is one" bash -c 'head -c 5 A.SVG | grep -qx "<?xml" && grep -q "^<svg " A.SVG'
claim "a PDF is one" bash -c 'head -c 5 c.d/X.Pdf | grep -qx "%PDF-"'
claim "standard output has no name" bash -c 'rc-render -o - sphere.rcg | cmp - a.png'
claim "nor has a device" rc-render -o /dev/null sphere.rcg
claim "  whatever it leads to" bash -c 'rc-render -o /dev/stdout sphere.rcg | cmp - a.png'
mkfifo pipe
claim "a FIFO has the name that it has" bash -c 'cmp a.png pipe & rc-render -o pipe sphere.rcg && wait $!'
ln -s /dev/null nothing
claim "and so has a link to a device" rc-render -o nothing sphere.rcg

finish
