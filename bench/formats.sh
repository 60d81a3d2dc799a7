#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The cost of files. A frame of 64 MB is written in every binary format and read back if a reader exists, in
# milliseconds, best of three, through a pipe. It is compared with `cat` through a pipe with a CRC.
#
#     bench/formats.sh BUILD [FOLDER]      BUILD holds the tools, FOLDER takes 500 MB
set -euo pipefail
[ $# -ge 1 ] || { sed -n '3,7s/^# \{0,1\}//p' "$0"; exit 2; }
PATH="$(cd "$1" && pwd)/tools:$PATH"
folder=$(mktemp -d "${2:-/tmp}/formats.XXXXXX")
trap 'rm -rf "$folder"' EXIT
cd "$folder"

best() { # LABEL COMMAND
    local start took least=
    for _ in 1 2 3; do
        start=$(date +%s%N)
        bash -c "set -o pipefail; $2" || return
        took=$((($(date +%s%N) - start) / 1000000))
        if [ -z "$least" ] || [ "$took" -lt "$least" ]; then least=$took; fi
    done
    printf '%-22s %6d ms\n' "$1" "$least"
}

rc-synth selfaffine --nx 2048 --ny 4096 --dx 1um --hurst 0.8 --rms-height 1um --seed 3 -o frame.rcg
best "cat, CRC-32 by zlib" "cat frame.rcg |
    perl -MCompress::Zlib=crc32 -e 'my \$c; \$c = crc32(\$_, \$c) while read STDIN, \$_, 1 << 20'"
for name in npy gsf vti vtr gwy sur sdf-binary hdf5 x3p; do
    best "rc-export $name" "rc-export --format $name frame.rcg | cat >/dev/null"
    if rc-import --formats | grep -q "^${name%-binary} "; then
        rc-export --format "$name" frame.rcg >"frame.$name"
        says=""
        [ "$name" != npy ] || says="--dx 1um --z-unit m" # it holds only numbers
        best "rc-import $name" "rc-import $says frame.$name | cat >/dev/null"
    fi
done
