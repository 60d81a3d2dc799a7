# A warning names the case and the load that it is about, also in a list.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 33 --dx 10um --radius 10mm -o ball.rcg
press() { rc-solve --estar 100GPa --output pressure "$@" ball.rcg -o p.rcg; }
export -f press
claim "the third of four loads reaches the edge: case 3" \
    warns 'ball.rcg, case 3, load 100 N: [0-9.]+ % of the load is on the outer 2 %' press --load 1N,5N,100N
claim "  and the others do not" bash -c '! grep -E "case [12], .*outer" warns.err'
claim "a mean pressure, an approach" bash -c '
    warns "case 1, mean pressure 1 GPa: .*outer" press --mean-pressure 1GPa &&
    warns "case 1, approach 10 um: .*outer" press --approach 10um'
claim "a list that does not rise" warns 'load: the list does not rise: each is a first loading of its own' press --load 5N,3N,4N
claim "  and one that does" bash -c 'press --load 3N,4N,5N 2>err; ! grep -q rise err'
refuses 2 '--load 0: it must be above 0: 0 takes the bodies apart, in a --history' "no load is no first loading" \
    'rc-solve --estar 1GPa --load 0,3N ball.rcg'

finish
