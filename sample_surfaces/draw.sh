#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Draws the pictures of the tutorial again, by its own commands:
#
#     sample_surfaces/draw.sh [FOLDER]
#
# The commands are taken from man/contact.7 and run in FOLDER, or in one that is removed when they are done; the pictures
# that the page shows go to sample_surfaces, with a palette of 256 colours (palette.pl, in perl). The tools on PATH are used, or those of build/. cost.png and
# coated-cost.png show times of this machine; the first and the last command of contact-theory(7), "What
# accuracy costs", draw them. measured.png of the README shows a file of another project, test_2.opd of the
# tests of surfalize:
#
#     rc-import test_2.opd | rc-detrend --poly 2 --fill --lowpass 10um |
#         rc-solve --mean-pressure 100MPa --estar 114GPa --hardness 4GPa |
#         rc-render --channel pressure --width 900 --title '' -o measured.png
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
RC_SOURCE=$here/..
[ -r "$RC_SOURCE/tests/manual.sh" ] || {
    echo "draw.sh: tests/manual.sh is not here: run it in the folder of the sources" >&2
    exit 1
}
command -v rc-render >/dev/null || PATH="$here/../build/tools:$PATH"
if [ $# -gt 0 ]; then
    mkdir -p "$1"
    cd "$1"
else
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
    cd "$folder"
fi
. "$RC_SOURCE/tests/manual.sh"
page=$pages/contact.7
blocks "$page" '' commands
cp "$here"/*.x3p .
for block in $(cd commands && ls | grep -v prints | sort -n); do
    bash -e -u -o pipefail "commands/$block" 2>&1
done
for picture in $(pictures "$page"); do
    cp "$picture" "$here"
    "$here/palette.pl" "$here/$picture"
    echo "sample_surfaces/$picture: $(wc -c <"$picture") bytes"
done
