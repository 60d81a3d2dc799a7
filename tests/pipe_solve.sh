# rc-solve minds what lies around the solution: a signal while it waits for its input, and the keys
# of an earlier solution.
. "$(dirname "$0")/pipe.sh"

rc-synth sphere --nx 33 --ny 29 --dx 20um --radius 7.5mm -o ball.rcg

# 143: ended by SIGTERM. The FIFO is held open, so the tool waits for a frame that never comes.
waiting() {
    local tool status
    mkfifo fifo
    rc-solve --load 100N --estar 100GPa -o never.rcg fifo &
    tool=$!
    exec 9>fifo
    head -c 100 ball.rcg >&9
    sleep 0.5
    kill -TERM "$tool"
    wait "$tool"
    status=$?
    exec 9>&-
    [ "$status" = 143 ] && ! ls never.rcg* 2>/dev/null
}
claim "a signal ends it while it waits for input, by that signal and without remains" waiting

rc-solve --quiet --load 100N --estar 100GPa --hardness 1GPa --output height ball.rcg -o once.rcg
claim "a solution with a hardness says so in its frames" \
    bash -c 'rc-info once.rcg | grep -q "hardness=1000000000$"'
claim "an elastic solution of the same heights does not" bash -c '
    rc-solve --quiet --load 100N --estar 100GPa --output pressure once.rcg -o twice.rcg &&
    rc-info twice.rcg >twice.txt && ! grep -q hardness= twice.txt'
# every node at the hardness: nothing is elastic, and there is no approach to speak of
claim "nor does a saturated one keep the approach of an earlier one" bash -c '
    rc-solve --quiet --mean-pressure 1GPa --hardness 1GPa --estar 100GPa --output pressure \
        once.rcg -o full.rcg && rc-info full.rcg >full.txt && ! grep -q approach= full.txt'

finish
