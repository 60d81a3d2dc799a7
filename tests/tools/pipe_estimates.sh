# SPDX-License-Identifier: GPL-3.0-or-later
# A part of the campaigns of tests/long/estimates.py.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/python.sh"
if ! python=$(python_with numpy 2>why.txt); then
    skip "$(cat why.txt)"
fi
estimates() { # KIND SEED COUNT
    RC_THREADS=1 "$python" "$RC_SOURCE/tests/long/estimates.py" "$@" "$RC_BIN"
}

claim "bodies yield where their largest Mises stress is 1.02 to 1.3 times the yield stress" estimates first 1 20
claim "errors of the grid are below their estimates, and a warning names each contact at the edge of the map" estimates grid 1 12
claim "errors of the time steps of rc-heat are below their estimates" estimates heat 1 8
claim "a warning names steps of a contact that travels whose error may be above its estimate" estimates passes 1 2
