# A solution that was stopped short, or interrupted, says so.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 256 --dx 1um --hurst 0.8 --rms-height 100nm --rolloff 60um --short-cut 4um --seed 5 -o s.rcg
claim "a tolerance that cannot be reached: said, with exit status 3" bash -c '
    rc-solve --periodic --load 1N --estar 100GPa --tol 1e-17 s.rcg -o short.rcg 2>err; [ $? = 3 ] &&
    grep -q "case 1, load 1 N: stopped short after [0-9]* iterations: its estimated error is [0-9.e-]*: raise --tol" err'

rc-synth selfaffine --nx 2048 --dx 1um --hurst 0.8 --rms-height 1um --short-cut 2um --seed 5 -o large.rcg
interrupted() {
    local status
    rc-solve --periodic --load 40N --estar 100GPa --tol 1e-12 --method pk99 --output pressure large.rcg -o cut.rcg 2>err &
    local tool=$!
    sleep 1.5
    kill -INT "$tool"
    wait "$tool"
    status=$?
    cat err >&2
    [ "$status" = 130 ] && grep -q 'interrupted after [0-9]* iterations: what is written is the best so far, not a solution' err
}
# bash lets a command in the background ignore SIGINT unless it has job control
set -m
claim "an interrupted one: said" interrupted
claim "  and in the stream" bash -c 'rc-info cut.rcg 2>/dev/null >cut.txt; grep converged=no cut.txt'

finish
