#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Results do not depend on the compiler, the processor and the number of threads: tests/long/compilers.sh
# [FOLDER] Builds the tools with gcc and clang, each with -O3 and -O0, in FOLDER (by default a temporary one).
# Runs the pipelines of pipelines.sh and compares. qemu emulates the processors without AVX-512 and without
# AVX2. There the program, FFTW and the C library use other code paths. The same build with the same number of
# threads must give the same bytes twice.
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source=$(cd "$here/../.." && pwd)
surfaces=$source/sample_surfaces
. "$here/pipelines.sh"
. "$here/../python.sh"
for need in gcc clang python3 qemu-x86_64-static cmake; do
    command -v $need >/dev/null || {
        echo "compilers.sh: $need is not here: apt-get install gcc clang libomp-dev python3-numpy qemu-user-static cmake" >&2
        exit 1
    }
done
python=$(cd /tmp && python_with numpy) || exit 1
if [ $# -gt 0 ]; then
    mkdir -p "$1" && work=$(cd "$1" && pwd) || exit 1
else
    work=$(mktemp -d) || exit 1
    trap 'rm -rf "$work"' EXIT
fi
failed=0
tools=$(sed -n 's/^set(tools \(.*\))/\1/p' "$source/tools/CMakeLists.txt")

# build NAME COMPILER FLAGS: builds the tools in $work/NAME; warnings are errors.
build() {
    cmake -S "$source" -B "$work/$1" -DCMAKE_BUILD_TYPE=None -DCMAKE_C_COMPILER="$2" -DCMAKE_C_FLAGS="$3" \
        -DRC_WERROR=ON -DRC_TESTS=OFF >"$work/$1.log" 2>&1 &&
        cmake --build "$work/$1" --parallel "$(nproc)" --target $(printf 'rc-%s ' $tools) >>"$work/$1.log" 2>&1 || {
        grep -E 'error|Error' "$work/$1.log" | head
        echo "NOT OK: $1 does not build: see $work/$1.log"
        exit 1
    }
}

# beside NAME PATH THREADS: runs the pipelines with the tools of PATH and compares them with the reference.
beside() {
    local began=$SECONDS
    if ! PATH="$2:$PATH" RC_THREADS=$3 run_pipelines "$work/out/$1" "$work/out/reference"; then
        failed=1
        return
    fi
    printf '%-34s' "$1:"
    compare "$work/out/$1" "$work/out/reference" || failed=1
    echo "    ($((SECONDS - began)) s)"
}

# twice NAME PATH THREADS: the same, and a second run gives the same bytes.
twice() {
    beside "$@"
    if PATH="$2:$PATH" RC_THREADS=$3 run_pipelines "$work/out/again" "$work/out/reference" &&
        same_bytes "$work/out/again" "$work/out/$1"; then
        echo "    twice the same bytes"
    else
        echo "NOT OK: $1 gives other bytes when it is run again"
        failed=1
    fi
}

gcc --version | head -n 1
clang --version | head -n 1
build gcc-O3 gcc -O3
PATH="$work/gcc-O3/tools:$PATH" RC_THREADS=1 run_pipelines "$work/out/reference" "$work/out/reference" || exit 1
twice "gcc -O3, 1 thread" "$work/gcc-O3/tools" 1
twice "gcc -O3, 2 threads" "$work/gcc-O3/tools" 2
twice "gcc -O3, 7 threads" "$work/gcc-O3/tools" 7
build gcc-O0 gcc -O0
beside "gcc -O0, 2 threads" "$work/gcc-O0/tools" 2
build clang-O3 clang -O3
twice "clang -O3, 1 thread" "$work/clang-O3/tools" 1
twice "clang -O3, 7 threads" "$work/clang-O3/tools" 7
build clang-O0 clang -O0
beside "clang -O0, 2 threads" "$work/clang-O0/tools" 2
# Processors of qemu: the first has the named extension, the second has not.
emulated "$work/avx2" "$work/gcc-O3/tools" qemu-x86_64-static -cpu Haswell
emulated "$work/sse" "$work/gcc-O3/tools" qemu-x86_64-static -cpu Nehalem
beside "gcc -O3, AVX2, no AVX-512" "$work/avx2" 1
beside "gcc -O3, neither" "$work/sse" 1
[ "$failed" = 0 ] && echo "All within what is allowed."
exit "$failed"
