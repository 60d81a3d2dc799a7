# SPDX-License-Identifier: GPL-3.0-or-later
# The Python package rcg reads and writes streams like the tools, bit for bit, refuses the same streams, and
# runs the tools. The output is that in a shell, and a failure has the message and the exit status of the
# tool.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/manual.sh"
. "$RC_SOURCE/tests/python.sh"

if ! python=$(python_with numpy matplotlib 2>/dev/null) && ! python=$(python_with numpy 2>why.txt); then
    skip "$(cat why.txt)"
fi
"$python" -c 'import numpy, sys; print("Python", sys.version.split()[0] + ", numpy", numpy.__version__)'
export PYTHONPATH="$RC_SOURCE/python" PYTHONDONTWRITEBYTECODE=1

# check NAME FILE...: runs this check of tests/tools/python_rcg.py, which waits for names.
coproc CHECKS { exec "$python" "$RC_SOURCE/tests/tools/python_rcg.py"; }
check() {
    local status=1
    printf '%s\0' "$@" >asked
    echo >&"${CHECKS[1]}" && read -r status <&"${CHECKS[0]}"
    cat said.out
    cat said.err >&2
    return "$status"
}

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

claim "a stream that is read and written is equal bit for bit" check round_trip ball.rcg single.rcg hole.rcg escaped.rcg cases.rcg \
    stress.rcg none.rcg
claim "  a text with a line feed and backslashes is read" check text_is escaped.rcg note 'two\backslashes\\and a
line, µm, ='
rc-synth wave --amplitude 1nm --wavelength 16um --nx 64 --dx 1um | rc-info --psd-map waves.rcg - >/dev/null
claim "  the unit of the spacings is read" check waves waves.rcg
claim "  a missing point is NaN" check missing hole.rcg 1 1
rc-export --format npy -o ball.npy ball.rcg
rc-export --format npy -o single.npy single.rcg
claim "values are those of rc-export, f64" check same_values ball.rcg ball.npy
claim "  for f32 too" check same_values single.rcg single.npy
cat cases.rcg ball.rcg stress.rcg >joined.rcg
rc-pick --case 1:5:5 joined.rcg -o numbered.rcg
claim "cases of joined streams have consecutive numbers, as in the tools" check joined joined.rcg numbered.rcg

# ---- damaged streams ----

rc-synth sphere --nx 3 --dx 1um --radius 1mm -o small.rcg
claim "a stream truncated at any place is refused" check cut small.rcg
claim "a stream with any changed byte is refused" check changed small.rcg
claim "rcg refuses the headers that rc-info refuses" check headers
{ sed '/^RCGEND/d' small.rcg && echo 'RCGFAIL rc-solve: disk on fire (exit status 2)'; } >failed.rcg
claim "the message and the status of a failed producer are repeated" check failed failed.rcg

# ---- frames of numpy ----

claim "arrays of all kinds become frames" check arrays
claim "other objects are refused" check no_frames
claim "rc-solve presses a numpy paraboloid with Hertz's area and pressure" check hertz "$grid_peak"

# ---- tools ----

claim "rcg.run returns the frames that the tool writes" check run ball.rcg
claim "rcg.report returns the lines of --report, and those of rc-info" check report ball.rcg
claim "a result shows the range of all cases, and numpy takes one map" check summaries ball.rcg
claim "rcg.scene returns the verdicts of rc-scene" check scenes ball.rcg
claim "messages quote values whole, and no temporary file is named" check messages ball.rcg
claim "rcg.cost returns the trials of a command as a table" check costs ball.rcg
claim "  and the figures of a measured map with their bars" check bars ball.rcg
claim "options can be numbers, lists, flags, letters and files" check options ball.rcg
claim "a failed tool raises an error with its message and exit status" check fails hole.rcg
claim "a result that stopped short is in the exception" check short
claim "a warning of a tool becomes a Python warning" check warns

# ---- functions ----

claim "a list of files gives a case for each file" check files ball.rcg hole.txt
claim "the table of materials is that of rc-solve" check named_materials
claim "functions accept a file, a frame, an array or a result, and return what the tools write" check functions ball.rcg
claim "  steps act in the order of the keywords" check steps ball.rcg
claim "  layers are a list of tuples" check layers ball.rcg
claim "  errors of a call are raised before the tool runs" check mistakes ball.rcg
claim "  a result that stopped short raises, and warnings have the line of the user" check unfinished
claim "  functions make pictures, curves and files of other programs" check pictures ball.rcg
mkdir short
for tool in "$RC_BIN"/rc-*[a-z]; do
    ln -s "$tool" short
done
rm short/rc-report short/rc-solve
cp "$RC_BIN/rc-report" short
printf '#!/bin/sh\n"%s/rc-solve" "$@"\nexit 3\n' "$RC_BIN" >short/rc-solve
chmod +x short/rc-solve
claim "  a page is made from a file and from arrays" check page ball.rcg
claim "the documentation of functions has every option of --help" check documented
claim "  it begins with an example, which works" check exemplified ball.rcg
mkdir mutated
printf '#!/bin/sh\n%s "$@" | sed "s/\"hardness\"/\"hardened\"/"\n' "$RC_BIN/rc-solve" >mutated/rc-solve
chmod +x mutated/rc-solve
claim "  it comes from the option table alone" check mutated "$PWD/mutated"
build=$(dirname "$RC_BIN")
if [ -e "$build/tools/completions/__init__.pyi" ]; then
    claim "type hints have the options of the tables" check hints "$build/tools/completions/__init__.pyi" "$build/tools/completions/tables.json"
else
    untried "type hints, which this build does not have: no Python had numpy"
fi
claim "progress can go to a function or to a line" check progress
claim "Ctrl-C ends a call and its tool, whatever the tool does" check interrupts
claim "a tool that timeout= stops says so" check timeouts
claim "arrays, keys and options that no tool can take raise an exception with a reason; all others arrive unchanged" check hostile
claim "results, frames, errors and warnings can be pickled and copied" check pickles ball.rcg
claim "a pool of processes gives the results of one process" check pool 6
version=$(rc-info --version | grep -o '[0-9.]*$')
claim "the version is that of the tools" says "^$version\$" "$python" -c 'import rcg; print(rcg.__version__)'

# ---- the script that rcg(5) prints ----

claim "rcg(5) has a script for numpy" bash -c '. "$RC_SOURCE/tests/manual.sh"; blocks "$pages/rcg.5" NUMPY script && [ -s script/1 ]'
claim "  it has 15 lines at most" bash -c '[ $(grep -c . script/1) -le 15 ]'
if python_with numpy matplotlib >/dev/null 2>why.txt; then
    claim "  it runs" env MPLBACKEND=Agg "$python" script/1
    claim "  it draws a figure" says 'PNG image data|PNG' head -c 8 area.png
    claim "  the area agrees with Hertz under every load" check drawn script/1
else
    untried "the script of rcg(5), $(cat why.txt)"
fi
