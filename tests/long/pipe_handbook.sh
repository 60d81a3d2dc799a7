# SPDX-License-Identifier: GPL-3.0-or-later
# All contacts of tests/scene/handbook.txt, see tests/tools/pipe_scene_handbook.sh.
RC_EVERY=1 bash "$(dirname "$0")/../tools/pipe_scene_handbook.sh"
