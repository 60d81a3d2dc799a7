# The Python package rcg reads and writes streams like the tools, bit for bit, refuses the same streams, and
# runs the tools: the output is that in a shell, and a failure has the message and the exit status of the
# tool.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/manual.sh"
. "$RC_SOURCE/tests/python.sh"

if ! python=$(python_with numpy matplotlib 2>/dev/null) && ! python=$(python_with numpy 2>why.txt); then
    echo "not tried: $(cat why.txt)"
    exit 77
fi
"$python" -c 'import numpy, sys; print("Python", sys.version.split()[0] + ", numpy", numpy.__version__)'
export PYTHONPATH="$RC_SOURCE/python" PYTHONDONTWRITEBYTECODE=1

# check NAME FILE...: runs this check of tests/tools/python_rcg.py.
check() { "$python" "$RC_SOURCE/tests/tools/python_rcg.py" "$@"; }

# ---- streams ----

rc-synth sphere --nx 33 --ny 47 --dx 1.1um --dy 1.29um --radius 2.385mm -o ball.rcg
rc-synth sphere --nx 33 --ny 47 --dx 1.1um --radius 2.385mm --type f32 -o single.rcg
printf '5 6 7\n6 NaN 8\n7 8 9\n' >hole.txt
rc-import --dx 0.1um --z-unit nm hole.txt -o hole.rcg
rc-pick --set 'note=two\backslashes\\and a
line, µm, =' ball.rcg -o escaped.rcg
rc-solve --quiet --load 0.5,1.25 --estar 114GPa ball.rcg -o cases.rcg
rc-stress --nu 0.3 --depths 0:3um:3 cases.rcg -o stress.rcg
rc-pick --channel nothing ball.rcg -o none.rcg 2>/dev/null || printf 'RCGEND 0\n' >none.rcg

claim "what was read is written as it was, bit for bit" check round_trip ball.rcg single.rcg hole.rcg escaped.rcg cases.rcg \
    stress.rcg none.rcg
claim "  a text with a line feed and backslashes is read" check text_is escaped.rcg note 'two\backslashes\\and a
line, µm, ='
rc-synth wave --amplitude 1nm --wavelength 16um --nx 64 --dx 1um | rc-info --psd-map waves.rcg - >/dev/null
claim "  the unit of the spacings" check waves waves.rcg
claim "  a missing point is NaN" check missing hole.rcg 1 1
rc-export --format npy -o ball.npy ball.rcg
rc-export --format npy -o single.npy single.rcg
claim "values are those that rc-export writes, f64" check same_values ball.rcg ball.npy
claim "  f32" check same_values single.rcg single.npy
cat cases.rcg ball.rcg stress.rcg >joined.rcg
rc-pick --case 1:5:5 joined.rcg -o numbered.rcg
claim "cases of joined streams are numbered on, as the tools do" check joined joined.rcg numbered.rcg

# ---- damaged streams ----

rc-synth sphere --nx 3 --dx 1um --radius 1mm -o small.rcg
claim "a stream that is cut off anywhere is refused" check cut small.rcg
claim "a stream with any byte changed is refused" check changed small.rcg
claim "headers are refused as rc-info refuses them" check headers
{ sed '/^RCGEND/d' small.rcg && echo 'RCGFAIL rc-solve: disk on fire (exit status 2)'; } >failed.rcg
claim "the message of a producer that failed is repeated, with its status" check failed failed.rcg

# ---- frames of numpy ----

claim "arrays of all kinds become frames" check arrays
claim "what is no frame is refused" check no_frames
claim "a paraboloid of numpy, pressed: Hertz's area and pressure" check hertz "$grid_peak"

# ---- tools ----

claim "what rcg.run gives is what the tool writes" check run ball.rcg
claim "rcg.report gives the lines of --report, and those of rc-info" check report ball.rcg
claim "options: numbers, lists, flags, letters, files" check options ball.rcg
claim "a tool that fails: its words and exit status" check fails hole.rcg
claim "one that stopped short: its best as well" check short
claim "what a tool warns of is a warning" check warns

# ---- functions ----

claim "functions give what the tools write, from a file, a frame, an array, a result" check functions ball.rcg
claim "  steps in the order of the keywords" check steps ball.rcg
claim "  layers, a list of tuples" check layers ball.rcg
claim "  what is wrong in a call is said before the tool runs" check mistakes ball.rcg
claim "  one that stopped short, and warnings at the line of the user" check unfinished
claim "  pictures, curves, files of other programs" check pictures ball.rcg
mkdir short
for tool in "$RC_BIN"/rc-*[a-z]; do
    ln -s "$tool" short
done
rm short/rc-report short/rc-solve
cp "$RC_BIN/rc-report" short
printf '#!/bin/sh\n"%s/rc-solve" "$@"\nexit 3\n' "$RC_BIN" >short/rc-solve
chmod +x short/rc-solve
claim "  a page, of a file and of arrays" check page ball.rcg
claim "their documentation has every option of --help" check documented
mkdir mutated
printf '#!/bin/sh\n%s "$@" | sed "s/\"hardness\"/\"hardened\"/"\n' "$RC_BIN/rc-solve" >mutated/rc-solve
chmod +x mutated/rc-solve
claim "  from the option table and nothing else" check mutated "$PWD/mutated"
build=$(dirname "$RC_BIN")
if [ -e "$build/tools/completions/__init__.pyi" ]; then
    claim "type hints have the options of the tables" check hints "$build/tools/completions/__init__.pyi" "$build/tools/completions/tables.json"
else
    echo "not tried: type hints, which this build does not have: no Python had numpy"
fi
claim "progress, for a function and as a line" check progress
version=$(rc-info --version | grep -o '[0-9.]*$')
claim "its version is that of the tools" says "^$version\$" "$python" -c 'import rcg; print(rcg.__version__)'

# ---- the script that rcg(5) prints ----

claim "rcg(5) has a script for numpy" bash -c '. "$RC_SOURCE/tests/manual.sh"; blocks "$pages/rcg.5" NUMPY script && [ -s script/1 ]'
claim "  of 15 lines at the most" bash -c '[ $(grep -c . script/1) -le 15 ]'
if python_with numpy matplotlib >/dev/null 2>why.txt; then
    claim "  it runs" env MPLBACKEND=Agg "$python" script/1
    claim "  and draws" says 'PNG image data|PNG' head -c 8 area.png
    claim "  the area that Hertz finds under every load" check drawn script/1
else
    echo "not tried: the script of rcg(5), $(cat why.txt)"
fi

finish
