# SPDX-License-Identifier: GPL-3.0-or-later
# A pipe that fails gives the reason once, in the tool that failed. All later tools end with the exit status
# of that tool and leave nothing behind. Only streams carry the reason.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 17 --dx 5um --radius 7.5mm -o ball.rcg
rc-solve --load 1 --estar 114GPa --quiet -o pressed.rcg ball.rcg
press='rc-solve --load 1 --estar 114GPa --quiet'

# fails "STATUS..." "pattern" "sentence" 'pipe': its commands end with these statuses, and standard error is a
# single line that matches the pattern.
fails() {
    local got
    got=$(bash -c "set +o pipefail; $4 >pipe.out; echo \${PIPESTATUS[@]}" 2>pipe.err </dev/null)
    if [ "$got" = "$1" ] && [ "$(wc -l <pipe.err)" = 1 ] && grep -qE -- "$2" pipe.err; then
        passed "$3"
    else
        failed "$3: exit status $got (expected $1), standard error:"
        sed 's/^/    /' pipe.err
    fi
}

# ---- one message ----

fails '1 1 1 1' '^rc-import: nosuch.x3p: No such file' "a file that is not there" \
    "rc-import nosuch.x3p | rc-detrend --plane | $press | rc-info"
fails '2 2' '^rc-solve: .*--lod' "a misspelt option" 'rc-solve --lod 3 ball.rcg | rc-info'
fails '2 2 2 2' '^rc-solve: give one of --load' "an option that is missing, found when the output was open" \
    'rc-solve --estar 1GPa ball.rcg | rc-stress --nu 0.3 --depths 0 | rc-deflect | rc-info'
fails '2 2 2' '^rc-solve: --load 0: it must be above 0' "a value out of bounds, in the middle" \
    'rc-solve --load 0 --estar 1GPa ball.rcg | rc-detrend --plane | rc-info'
fails '0 1 1' 'rc-solve: .*no frame with the channel height' "of three the second, when all was read" \
    "rc-stress --nu 0.3 --depths 0 pressed.rcg | $press | rc-info"
fails '1 1' 'No such file' "after a whole case" "$press ball.rcg nosuch.rcg | rc-info"
claim "  it was printed" says pressure cat pipe.out
fails '2 2' '^rc-synth: ' "rc-synth" 'rc-synth sphere --nx 0 | rc-info'
fails '2 2' '^rc-import: ' "rc-import" 'rc-import --nothing | rc-info'

# ---- tools at the end of a pipe leave nothing ----

for last in 'rc-render -o out.png' 'rc-export -o out.csv' 'rc-info -o out.txt' "$press -o out.rcg" \
    'rc-cost -o out.table -- rc-solve --load 1 --estar 1GPa' 'rc-deflect -o out.u' 'rc-stress --nu 0.3 --depths 0 -o out.s' \
    'rc-detrend --plane -o out.level'; do
    fails '2 2' '^rc-solve: ' "$last is silent" "rc-solve --lod 3 ball.rcg | $last"
done
claim "no file is left" bash -c '! ls -d out.* >&2'
claim "--verbose repeats the message, with the name of the tool that failed" bash -c '
    rc-solve --lod 3 ball.rcg 2>/dev/null | rc-info --verbose 2>said.txt
    grep -q "^rc-info: standard input: the program that wrote it failed: rc-solve: .*--lod" said.txt'

# ---- contents of the stream ----

# after "sentence" EXPECTED 'command': compares its complete standard output, which is a pipe.
after() {
    bash -c "set +o pipefail; { $3; } 2>/dev/null </dev/null | cat >after.out"
    if tail -n 1 after.out >after.last && grep -aqxE -- "$2" after.last; then
        passed "$1"
    else
        failed "$1: '$(tail -n 1 after.out)'"
    fi
}
after "status 1 is not named" 'RCGFAIL rc-import: nosuch.x3p: No such file or directory' 'rc-import nosuch.x3p'
after "status 2 is" 'RCGFAIL rc-solve: .* \(exit status 2\)' 'rc-solve --lod 3 ball.rcg'
after "it is passed on as it came" 'RCGFAIL rc-solve: .*--lod.* \(exit status 2\)' \
    'rc-solve --lod 3 ball.rcg | rc-stress --nu 0.3 --depths 0 | rc-deflect'
after "the status stands at the end of a long message too" 'RCGFAIL rc-solve: x{0}.* \(exit status 2\)' \
    "rc-solve --load \$(printf 'x%.0s' {1..2000}) ball.rcg"
claim "  the length of the message is limited" test "$(tail -n 1 after.out | wc -c)" = 408

# No such line if the output is a file or text.
nothing() {
    "$@" >nothing.out 2>/dev/null
    [ $? = 2 ] && [ ! -s nothing.out ]
}
claim "a file without a stream gets no failure line" nothing rc-solve --lod 3 ball.rcg
for words in '--help' '--version' '--dry-run' '--report -' '-o elsewhere.rcg' '--report=-'; do
    claim "rc-solve --lod 3 $words: there is no stream to mark" \
        bash -c "set +o pipefail; rc-solve --lod 3 $words ball.rcg 2>/dev/null | cat >piped; [ ! -s piped ] && [ ! -e elsewhere.rcg ]"
done
for words in 'rc-import --list nosuch.x3p' 'rc-cost --lod 3 ball.rcg' 'rc-info --lod ball.rcg' 'rc-export --format csv nosuch.rcg'; do
    claim "$words: there is no stream to mark either" bash -c "set +o pipefail; $words 2>/dev/null | cat >piped; ! grep RCGFAIL piped >&2"
done

# ---- a message from a file ----

rc-solve --lod 3 ball.rcg 2>/dev/null | cat >failed.rcg
refuses 1 'rc-info: failed.rcg, frame 1: the program that wrote this stream failed: rc-solve: .*--lod[^)]*$' \
    "is repeated, and the line of this tool was right" "rc-info failed.rcg"
refuses 1 'standard input, frame 1: the program that wrote this stream failed: rc-solve: ' "from < too" "rc-info <failed.rcg"
fails '1 1' '^rc-detrend: failed.rcg, frame 1: the program that' "in a pipe once" 'rc-detrend --plane failed.rcg | rc-info'
printf 'RCGFAIL \033[2Jgone\n' >escape.rcg
refuses 1 'failed: \?\[2Jgone$' "what would change a terminal is not repeated" "rc-info escape.rcg"
printf 'RCGFAIL\n' >short.rcg
refuses 1 'failed: without a message' "a line without a message" "rc-info short.rcg"
