#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# From a measured surface to the stresses under it, in one command:
#
#     sample_surfaces/demo.sh [FILE]
#
# Installs what is missing (Debian, Ubuntu), builds the tools, and runs the pipeline on a sample, or
# on FILE, any surface that rc-import reads. Results appear in the folder rc-demo. With RC_BIN=FOLDER
# in the environment the tools are those in FOLDER, and nothing is installed or built; away from the
# sources of libcontact they are those that are installed.
set -euo pipefail

case "${1-}" in
-h | --help)
    sed -n '3,11s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
-*)
    echo "demo.sh: unknown option $1: see demo.sh --help" >&2
    exit 2
    ;;
esac

top=$(cd "$(dirname "$0")/.." && pwd)
file=${1-$top/sample_surfaces/rough-steel.x3p}
[ -r "$file" ] || {
    echo "demo.sh: $file: no such file, or not readable" >&2
    exit 1
}
if [ -z "${RC_BIN-}" ] && [ -f "$top/CMakeLists.txt" ]; then
    . "$top/cmake/packages.sh"
    # shellcheck disable=SC2086
    need_packages $build_packages
    echo "Building in $top/build ..."
    mkdir -p "$top/build"
    {
        cmake -S "$top" -B "$top/build" -DRC_TESTS=OFF &&
            cmake --build "$top/build" --parallel "$(cores)"
    } >"$top/build/demo.log" 2>&1 || {
        tail -n 20 "$top/build/demo.log" >&2
        echo "demo.sh: the build failed; $top/build/demo.log has all of it" >&2
        exit 1
    }
    RC_BIN=$top/build/tools
fi
PATH="${RC_BIN:+$RC_BIN:}$PATH"
command -v rc-import >/dev/null || {
    echo "demo.sh: no rc-import on PATH: install the tools, or name their folder in RC_BIN" >&2
    exit 1
}

# The sample is a flat rough specimen under a ball of 7.5 mm diameter against steel: half the size
# and a quarter of the load of Polonsky and Keer's example (1999). Your own FILE is pressed against a flat
# with a mean pressure, because the script does not know its size.
fit="--poly 2 --spikes 5 --fill"
if [ $# -eq 0 ]; then
    load="--radius 3.75mm --load 60N"
else
    load="--mean-pressure 50MPa"
fi
mkdir -p rc-demo

run() {
    echo
    echo "\$ $1"
    bash -c "set -o pipefail; $1"
}

surface=$(printf '%q' "$file")
run "rc-import $surface | rc-detrend $fit |
    rc-solve $load --estar 114GPa --hardness 6GPa --report rc-demo/report.json |
    tee rc-demo/contact.rcg |
    rc-stress --nu 0.28 --depths 0:20um:21 --components mises |
    rc-render --channel mises -o rc-demo/mises.png"
run "rc-render --channel pressure rc-demo/contact.rcg -o rc-demo/pressure.png"
run "rc-render --channel height rc-demo/contact.rcg -o rc-demo/height.png"
echo
rc-info rc-demo/contact.rcg | grep -E '^  (load|contact|pressure|approach|hardness|converged) '
sed -n 's/.*"pressure_error_estimate": \([0-9.e-]*\).*/\1/p' rc-demo/report.json |
    LC_ALL=C awk '{ printf "  %-10s %.2g of the pressure, estimated\n", "error", $1 }'
echo
echo "Drawn in rc-demo: height.png, pressure.png, and mises.png, the depth where it is largest."
