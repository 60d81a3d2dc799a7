# SPDX-License-Identifier: GPL-3.0-or-later
# The law of the rules between options (rules.py): what the option tables say is refused, with the words that
# --help has, and the manual names it. Then --help of a tool whose options have headings.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/manual.sh"
. "$RC_SOURCE/tests/python.sh"

python=$(python_with json 2>why.txt) || skip "$(cat why.txt)"
tools=
for source in $(tool_sources); do
    tools="$tools $(basename "$source" .c)"
done
walk() { "$python" "$RC_SOURCE/tests/tools/rules.py" "$pages" "$@" | tee walk.txt >&2; }
claim "each rule of each tool is kept, and stands in --help" walk $tools
tail -n 1 walk.txt
claim "  there are rules" says 'against [1-9].* needs [1-9].* one_of [1-9]' cat walk.txt

# ---- what no rule forbids ----

rc-synth sphere --nx 17 --dx 5um --radius 7.5mm -o ball.rcg
rc-solve --load 2N --E1 210GPa --nu1 0.3 --E2 rigid --quiet -o pressed.rcg ball.rcg
printf '0 1\n1 3\n2 5\n' >profile.txt
claim "a rule for one word permits the others" rc-slip --mu 0.3 --creep 1e-3,0 --steady --coupling none --dry-run pressed.rcg
claim "a word that is the default need not be given" \
    rc-fatigue --depths 1um --bending-limit 1GPa --torsion-limit 0.6GPa --dangvan full --dry-run pressed.rcg
claim "a rule for an argument permits the option without it" rc-import --even --dx 1um --z-unit um -o even.rcg profile.txt
claim "a rule for a list permits one value" rc-render --raw --case 1 --channel pressure -o raw.png pressed.rcg
claim "a word in place of a number has rules of its own" \
    rc-slip --mu 0.3 --tangential 0.1N --E1 210GPa --nu1 0.3 --E2 rigid --dry-run pressed.rcg
refuses 2 '--nu2 does not work with --E2 rigid' "  against" \
    'rc-slip --mu 0.3 --tangential 0.1N --E1 210GPa --nu1 0.3 --E2 rigid --nu2 0.3 pressed.rcg'
refuses 2 '--E2 MODULUS has no effect without --nu2' "  and without the word" \
    'rc-slip --mu 0.3 --tangential 0.1N --E1 210GPa --nu1 0.3 --E2 210GPa pressed.rcg'

# ---- groups of options ----

listed() { grep -oE '^  --[A-Za-z0-9-]+' "$1" | sort; }
# in_groups: each option of the whole help is in exactly one group.
in_groups() {
    rc-solve --help >whole.txt
    sed -n '/^All tools:/,$d; /^Usage/d; s/:$//p' whole.txt | grep '^[A-Z]' >groups.txt
    while read -r group; do
        rc-solve --help "$group" || return
    done <groups.txt >each.txt
    sed '/^All tools:/,$d' whole.txt | listed - >there.txt
    listed each.txt | diff there.txt - >&2 && [ -s there.txt ]
}
claim "the groups of rc-solve --help have each option once" in_groups
for group in 'load and bodies' yield adhesion time sliding travel accuracy output; do
    claim "  one is '$group'" grep -qix "$group" groups.txt
done
rc-solve --help adhesion >adhesion.txt
claim "one group has its options" says '^  --adhesion WORK' cat adhesion.txt
claim "  and no others" bash -c '! grep -e "--tilt fixed" -e "--yield Y" adhesion.txt >&2'
claim "a beginning is enough" bash -c 'rc-solve --help adh | cmp - adhesion.txt'
claim "  also after -h" bash -c 'rc-solve -h adh | cmp - adhesion.txt'
claim "an equals sign may stand before it" bash -c 'rc-solve --help=adhesion | cmp - adhesion.txt'
for page in "$RC_SOURCE"/man/contact-*.7; do
    name=$(basename "$page" .7)
    name=${name#contact-}
    claim "  the name of a page of an effect is known: $name" bash -c "rc-solve --help $name | grep -qE '^  --[a-z]|contact-$name\(7\)'"
done
for words in creep:--relaxation coating:--layer visco:--time conductivity:--conductivity tilt:--at; do
    claim "  so is '${words%:*}', with ${words#*:}" bash -c "rc-solve --help ${words%:*} | grep -q '^  ${words#*:} '"
done
claim "  it has the rules of its options, and no others" bash -c "rc-solve --help tilt >tilt.txt && grep -q 'needs --tilt free' tilt.txt && ! grep -qe '--load LIST' tilt.txt"
refuses 2 '--help friction: there is no such group of options: the groups are load and bodies, yield, adhesion, ' \
    "an unknown group" 'rc-solve --help friction'
refuses 2 '--help t: this begins more than one group of options: the groups are' "a beginning of two" 'rc-solve --help t'
claim "a tool without groups prints all its help" bash -c 'rc-add --help load | cmp - <(rc-add --help)'
