# SPDX-License-Identifier: GPL-3.0-or-later
# Estimated errors are almost never below the true errors: random problems compared with solutions of low
# tolerance. Lists of loads on a body that yields, histories with a hardness, adhesive paths, tilted contacts,
# free maps. Bodies yield near first yield; errors of the grid.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/python.sh"
if ! python=$(python_with numpy 2>why.txt); then
    skip "$(cat why.txt)"
fi
long=$RC_SOURCE/tests/long
export RC_THREADS=1
claim "errors of a body that yields are below their estimates" "$python" "$long/yield_lists.py" 1 60
claim "  and with companion runs" "$python" "$long/yield_lists.py" 61 60 rc-solve 16,half
for kind in hist:100 adhesion:60 tilt:60 maps:20 first:320 grid:320 heat:100 passes:60; do
    claim "$kind" "$python" "$long/estimates.py" "${kind%:*}" 1 "${kind#*:}" "$RC_BIN"
done
