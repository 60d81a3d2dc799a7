# SPDX-License-Identifier: GPL-3.0-or-later
# Bars of measured maps hold the values of the true surfaces: random surfaces whose figures are known on four times as many
# nodes a side, measured with noise. Fractals are flagged, and quarters tell how far a patch stands for its surface.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/python.sh"
if ! python=$(python_with numpy 2>why.txt); then
    skip "$(cat why.txt)"
fi
export RC_THREADS=1
for kind in scenes:112 fractals:28 patches:40; do
    claim "$kind" "$python" "$RC_SOURCE/tests/long/bars.py" "${kind%:*}" 31 "${kind#*:}" "$RC_BIN"
done
