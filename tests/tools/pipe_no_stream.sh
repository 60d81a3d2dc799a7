# SPDX-License-Identifier: GPL-3.0-or-later
# A tool that gets another file than a grid stream names the kind of file and the command that converts it.
# The message for a pipe whose first program wrote nothing is different. If rc-import gets a stream, it names
# the command to use instead, and that command works.
. "$(dirname "$0")/../pipe.sh"

# ---- another file in place of a stream ----

press='rc-solve --load 1 --estar 114GPa --quiet -o never.rcg'
sample="$RC_SOURCE/sample_surfaces/rough-steel.x3p"
cp "$sample" steel.x3p
cp "$sample" 'my steel.x3p'
printf '0 1 0\n1 3 1\n0 1 0\n' >heights.txt
gzip -c heights.txt >heights.gz
rc-synth sphere --nx 17 --dx 5um --radius 7.5mm -o ball.rcg
rc-render -o ball.png ball.rcg

refuses 1 '^rc-solve: steel.x3p is not a grid stream, it looks like a ZIP archive: rc-import steel.x3p [|] rc-solve \.\.\.$' \
    "an instrument's file" "$press steel.x3p"
claim "  the message is right" bash -c 'rc-import steel.x3p | rc-info >/dev/null'
refuses 1 "not a grid stream, it looks like a ZIP archive: rc-import 'my steel.x3p' [|] rc-info" "a name with a blank" "rc-info 'my steel.x3p'"
refuses 1 'heights.txt is not a grid stream, it looks like text: rc-import heights.txt [|] rc-detrend' "text" "rc-detrend --plane heights.txt"
refuses 1 'heights.gz is not a grid stream, it looks like GZIP' "something compressed" "rc-stress --nu 0.3 --depths 0 heights.gz"
refuses 1 '^rc-info: standard input is not a grid stream, it looks like text: rc-import - [|] rc-info' "through a pipe" "cat heights.txt | rc-info"
refuses 1 'ball.png is not a grid stream, but looks like a PNG picture: rc-info reads streams of rc-import$' "a picture" "rc-info ball.png"
printf '{"case": 1}\n' >report.json
refuses 1 'report.json is not a grid stream: it looks like a table: draw columns of it, as in --curve' "a report" "rc-render -o x.png report.json"
head -c 3000 /dev/zero >zeros
refuses 1 'zeros is not a grid stream: rc-import zeros [|] rc-info' "zeros" "rc-info zeros"
tr '\0' 'x' <zeros >exes
refuses 1 'exes is not a grid stream, it looks like text' "a line without an end" "rc-info exes"
sed 's/$/\r/' ball.rcg >dos.rcg
refuses 1 'dos.rcg: a copy in text mode has changed its line ends' "a stream copied as text" "rc-info dos.rcg"
refuses 1 '^rc-info: steel.x3p is not a grid stream' "the second of two files" "rc-info ball.rcg steel.x3p"

# ---- empty ----

: >empty.rcg
refuses 1 '^rc-solve: empty.rcg is empty, the stream stops before it begins: make it again$' "an empty file" "$press empty.rcg"
refuses 1 '^rc-solve: standard input is empty, .*: the program before this one in the pipe wrote no output$' \
    "a pipe whose first program died" "true | $press"
refuses 1 '^rc-solve: standard input is empty' "no input" "$press"

# ---- streams, if damaged ones ----

for n in 1 3 4; do
    refuses 1 'the stream stops inside a line, 0 whole frames' "a stream of $n bytes is one that was cut" "head -c $n ball.rcg | rc-info"
done
refuses 1 'stops inside a header' "a stream cut in its header is one" "head -c 20 ball.rcg | rc-info"
refuses 1 "frame 2: 'rubbish' is in place of a frame" "something behind a frame" \
    "{ sed '/^RCGEND/d' ball.rcg; echo rubbish; } | rc-info"
claim "no file was written" test ! -e never.rcg

# ---- a stream in place of another file ----

rc-synth sphere --nx 5 --dx 1um --radius 1mm -o ball.rcg
refuses 1 "ball.rcg: it is a grid stream already and needs no import: give it to the next tool, as in 'rc-info ball.rcg'" \
    "a stream in a file" 'rc-import ball.rcg'
command=$(rc-import ball.rcg 2>&1 | sed "s/.* as in '\(.*\)'/\1/")
claim "the proposed command runs" says height bash -c "$command"
refuses 1 "standard input: it is a grid stream already.*as in '... [|] rc-info'" "a stream in a pipe" \
    'rc-synth sphere --nx 5 --dx 1um --radius 1mm | rc-import -'
refuses 1 "it is a grid stream already" "with --list" 'rc-import --list ball.rcg'
refuses 1 "it is a grid stream already" "whatever its name" 'cp ball.rcg ball.txt; rc-import ball.txt'
