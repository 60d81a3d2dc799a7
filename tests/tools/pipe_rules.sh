# The law of the rules between options (rules.py): what the option tables say is refused, with the words that
# --help has, and the manual names it.
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
