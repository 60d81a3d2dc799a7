# SPDX-License-Identifier: GPL-3.0-or-later
# Results of the Python package as a data set of xarray and a table of pandas.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/python.sh"

if ! python=$(python_with numpy xarray pandas 2>why.txt); then
    skip "$(cat why.txt)"
fi
export PYTHONPATH="$RC_SOURCE/python" PYTHONDONTWRITEBYTECODE=1
rc-synth sphere --nx 33 --ny 47 --dx 1.1um --dy 1.29um --radius 2.385mm -o ball.rcg
claim "values, names, units and positions are right" "$python" "$RC_SOURCE/tests/tools/python_rcg.py" data_sets ball.rcg
