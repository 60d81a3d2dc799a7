# SPDX-License-Identifier: GPL-3.0-or-later
# Gwyddion reads the files of rc-export with the same numbers. It depends on GTK 2, so it is not among the
# packages that the tests install:
#     apt-get install gwyddion libgwyddion20-dev libgtk2.0-dev libgtkglext1-dev xvfb
. "$(dirname "$0")/../pipe.sh"

if ! pkg-config --exists gwyddion 2>/dev/null || ! command -v xvfb-run >/dev/null; then
    skip "Gwyddion, its headers or xvfb are not installed; ${0##*/} says how"
fi
# shellcheck disable=SC2046
cc -w -O1 "$RC_SOURCE/tests/tools/gwyddion.c" -o gwyddion $(pkg-config --cflags --libs gwyddion) -lm || exit 1

rc-synth selfaffine --nx 61 --ny 37 --dx 1.1um --dy 0.7um --hurst 0.8 --rms-height 0.4um --seed 5 \
    -o whole.rcg
# some missing points, made by a text file
rc-export --format csv whole.rcg | awk -F, -v OFS=, '/^#/ { print; next }
    { for (i = 1; i <= NF; i++) if ((NR * 31 + i * 17) % 11 == 0) $i = "NaN"; print }' >holes.csv
rc-import holes.csv -o holes.rcg

# opens STREAM FORMAT PART [OPTION...]: Gwyddion reads heights that differ by at most PART of the largest.
opens() {
    local stream=$1 format=$2 part=$3
    shift 3
    rm -f file.*
    rc-export --format "$format" "$@" "$stream.rcg" -o "file.${format%%-binary}" &&
        rc-export --format npy "$stream.rcg" -o file.npy &&
        xvfb-run -a ./gwyddion "file.${format%%-binary}" file.npy 1.1e-6 0.7e-6 "$part" | tee said
}

check() {
    claim "$1: $2 ${5-} opens" opens "$@"
    sed 's/^/    /' said
}

for stream in whole holes; do
    check $stream x3p 0 --type f64
    check $stream x3p 6e-8 --type f32
    check $stream x3p 3e-10 --type i32
    check $stream x3p 2e-5 --type i16
    check $stream sdf 0 --missing NaN
    check $stream sdf-binary 0 --type f64
    check $stream sdf-binary 3e-10 --type i32
    check $stream sdf-binary 2e-5 --type i16
    check $stream gsf 6e-8
    check $stream gwy 0
    check $stream xyz 0
done
# Gwyddion ignores the flag for missing points of this format
check whole sur 1e-9 --type i32
check whole sur 4e-5 --type i16
