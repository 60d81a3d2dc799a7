# SPDX-License-Identifier: GPL-3.0-or-later
# The readers in rcg(5) run as printed. For every frame of a stream each prints channel, size and largest
# value as rc-info does, for both types. Each fails if the stream is cut off.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/manual.sh"
. "$RC_SOURCE/tests/python.sh"

rc-synth selfaffine --nx 33 --ny 47 --dx 1.1um --dy 1.29um --hurst 0.7 --rms-height 0.4um --seed 5 -o rough.rcg
rc-solve --quiet --load 0.5,1 --estar 114GPa rough.rcg -o f64.rcg
rc-solve --quiet --load 1 --estar 114GPa --type f32 rough.rcg -o f32.rcg
printf '5 6 7\n6 NaN 8\n7 8 9\n' >hole.txt
rc-import --dx 0.1um --z-unit nm hole.txt -o hole.rcg
printf 'RCGEND 0\n' >none.rcg
# cut off in the values, before a checksum, and before the end line
head -c 9000 f64.rcg >inside.rcg
head -c -30 f64.rcg >checksum.rcg
sed '/^RCGEND/d' f64.rcg >end.rcg

# expected FILE: prints channel, columns, rows and largest value of each frame.
expected() {
    rc-info --json "$1" | sed 's/.*"channel": "\([^"]*\)".*"nx": \([0-9]*\).*"ny": \([0-9]*\).*"maximum": \([^,}]*\).*/\1 \2 \3 \4/'
}
# agrees TOLERANCE FILE READER...: the reader prints the expected lines for the file, with numbers within a
# relative tolerance.
agrees() {
    local tolerance=$1 file=$2
    expected "$file" >wanted.txt
    "${@:3}" "$file" >got.txt || return
    paste -d ' ' wanted.txt got.txt | awk -v t="$tolerance" '
        { d = $4 - $8; m = $4 < 0 ? -$4 : $4
          if (NF != 8 || $1 != $5 || $2 != $6 || $3 != $7 || d > t * m || -d > t * m) { print; exit 1 } }' >&2
}
fails_on() { ! "${@:2}" "$1"; }

# try NAME READER...: the reader gives the right values, and detects a stream that is cut off.
try() {
    claim "$1: every frame of a stream is read, f64" agrees "$same" f64.rcg "${@:2}"
    claim "$1:   f32 too" agrees "$six_digits" f32.rcg "${@:2}"
    claim "$1:   a missing point too" agrees "$same" hole.rcg "${@:2}"
    claim "$1:   a stream without frames gives none" agrees "$same" none.rcg "${@:2}"
    for file in inside checksum end; do
        claim "$1:   a truncated stream ($file) is detected" fails_on "$file.rcg" "${@:2}"
    done
}
claim "there are frames to read" test "$(expected f64.rcg | awk 'NF == 4 && $4 > 0' | wc -l)" = 8

# what NUMBER NAME: saves this display of the section READERS.
blocks "$pages/rcg.5" READERS readers
claim "the page prints five readers" test "$(ls readers | wc -l)" = 5

cp readers/1 reader.c
claim "the reader in C compiles" ${CC:-cc} -std=c99 -O2 -Wall -Wextra -o reader reader.c -lm
in_c() { ./reader <"$1"; }
try C in_c

in_awk() { LC_ALL=C awk -f readers/3 "$1"; }
try awk in_awk

if python=$(python_with numpy 2>why.txt); then
    in_python() { "$python" readers/2 <"$1"; }
    try Python in_python
else
    untried "Python: $(cat why.txt)"
fi

# on FILE PROGRAM...: runs a program that reads surface.rcg in its folder.
on() {
    mkdir -p "run.$1" && cp "$1" "run.$1/surface.rcg" && (cd "run.$1" && "${@:2}")
}
if command -v octave-cli >/dev/null; then
    in_octave() { on "$1" octave-cli --no-gui --no-init-file "$scratch/readers/4"; }
    try Octave in_octave
else
    untried "Octave, which is not here"
fi
if command -v julia >/dev/null; then
    in_julia() { on "$1" julia --startup-file=no "$scratch/readers/5"; }
    try Julia in_julia
else
    untried "Julia, which is not here"
fi
