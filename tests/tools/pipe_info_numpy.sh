# SPDX-License-Identifier: GPL-3.0-or-later
# Feature and profile parameters of a sample surface equal those of a numpy program written from the
# standards. So do those of a surface that is rough down to its nodes.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/python.sh"

if ! python=$(python_with numpy 2>why.txt); then
    skip "$(cat why.txt)"
fi
export PYTHONPATH="$RC_SOURCE/python" PYTHONDONTWRITEBYTECODE=1
rc-import --quiet "$RC_SOURCE/sample_surfaces/rough-steel.x3p" | rc-detrend --quiet --poly 2 --fill -o steel.rcg
rc-synth selfaffine --nx 150 --ny 90 --dx 1um --dy 1.7um --hurst 0.4 --rms-height 50nm --seed 8 | rc-pick --set periodic=no -o rough.rcg
for surface in steel rough; do
    claim "$surface: features, profiles and material ratio agree with numpy" "$python" "$RC_SOURCE/tests/tools/python_parameters.py" $surface.rcg
    cat claim.out
done
