# A grid stream that is given to rc-import is refused with what to do instead, and that works.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 5 --dx 1um --radius 1mm -o ball.rcg
refuses 1 "ball.rcg: it is a grid stream already and needs no import: give it to the next tool, as in 'rc-info ball.rcg'" \
    "a stream in a file" 'rc-import ball.rcg'
command=$(rc-import ball.rcg 2>&1 | sed "s/.* as in '\(.*\)'/\1/")
claim "the command that it names runs" says height bash -c "$command"
refuses 1 "standard input: it is a grid stream already.*as in '... [|] rc-info'" "a stream in a pipe" \
    'rc-synth sphere --nx 5 --dx 1um --radius 1mm | rc-import -'
refuses 1 "it is a grid stream already" "with --list" 'rc-import --list ball.rcg'
refuses 1 "it is a grid stream already" "whatever its name" 'cp ball.rcg ball.txt; rc-import ball.txt'

finish
