# SPDX-License-Identifier: GPL-3.0-or-later
# The law of --resume (resume.py): a run with one option, key, frame or file changed since its checkpoint is
# refused, and the message names the change, or its result is that of a fresh run. Before a release all modes
# of the tools are walked; of every commit some.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/python.sh"

python=$(python_with json 2>why.txt) || skip "$(cat why.txt)"
walk() { "$python" "$RC_SOURCE/tests/tools/resume.py" "$@" | tee walk.txt >&2; }
if before_release; then
    claim "whatever changes is refused by its name or takes effect, in all modes" walk full "$scratch"
else
    claim "whatever changes is refused by its name or takes effect" walk quick "$scratch" history yield passes tangential path-file wear
fi
tail -n 1 walk.txt
