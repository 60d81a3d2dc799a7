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
claim "an equals sign may stand before it" bash -c 'rc-solve --help=adhesion | cmp - adhesion.txt'
refuses 2 '--help friction: there is no such group of options: the groups are load and bodies, yield, adhesion, ' \
    "an unknown group" 'rc-solve --help friction'
refuses 2 '--help t: this begins more than one group of options: the groups are' "a beginning of two" 'rc-solve --help t'
claim "a tool without groups prints all its help" bash -c 'rc-add --help load | cmp - <(rc-add --help)'
