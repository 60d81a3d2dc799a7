# SPDX-License-Identifier: GPL-3.0-or-later
# The notebooks run from the first cell to the last, without a warning, and draw their figures.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/python.sh"

if ! python=$(python_with numpy matplotlib nbclient ipykernel 2>why.txt); then
    skip "$(cat why.txt)"
fi
export PYTHONPATH="$RC_SOURCE/python" PYTHONDONTWRITEBYTECODE=1 HOME="$PWD" PYDEVD_DISABLE_FILE_VALIDATION=1
# the kernel is this Python, whatever others are on PATH
mkdir -p kernels/python3
printf '{"argv": ["%s", "-m", "ipykernel_launcher", "-f", "{connection_file}"], "display_name": "Python 3", "language": "python"}\n' \
    "$(command -v "$python")" >kernels/python3/kernel.json
export JUPYTER_PATH="$PWD"
mkdir pictures
# drawn NAME COUNT: the notebook runs and draws so many figures.
drawn() { says ": $2 pictures" "$python" "$RC_SOURCE/tests/tools/notebooks.py" pictures "$RC_SOURCE/notebooks/$1.ipynb"; }
claim "from a scan to a figure" drawn scan-to-figure 2
claim "thirty scans, a table with error bars" drawn many-scans 1
claim "elastic-plastic indentation" drawn indentation 2
claim "running-in" drawn running-in 2
claim "the notebook of a seal runs" drawn seal 2
claim "before and after, with a known volume" drawn before-and-after 1
claim "rolling with creepage" drawn rolling 2
claim "viscoelastic bodies: the creep of a ball, the friction of rubber" drawn viscoelastic 2
[ -z "${NOTEBOOK_PICTURES-}" ] || cp pictures/*.png "$NOTEBOOK_PICTURES" # to be looked at
claim "no notebook is left out, and none holds results" bash -c '
    [ "$(ls "$RC_SOURCE"/notebooks/*.ipynb | wc -l)" = 8 ] && ! grep -l "image/png" "$RC_SOURCE"/notebooks/*.ipynb'
