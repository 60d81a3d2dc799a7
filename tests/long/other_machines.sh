#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The tests on processors of other kinds:
#
#     tests/long/other_machines.sh [--keep FOLDER] ARCH...
#
# ARCH is Debian's name: s390x (most significant byte first), arm64, i386 (32 bits). For each, mmdebstrap
# makes a root with its libraries, with packages from the environment's MIRROR if it is set. Debian's cross
# compiler builds everything with warnings as errors. The tests run, foreign ones under qemu's user emulation.
# The results of the pipelines of pipelines.sh must equal those of this machine, and each machine reads the
# files of the other. FOLDER keeps root, build and logs for the next run. The script needs no privileges if
# mmdebstrap needs none (user namespaces). The table below lists the omitted tests with the reason, and the
# script prints them. A test that takes longer than 9000 s (or RC_LIMIT seconds) is named and counts as a
# failure; RC_TESTS_OF, a regular expression, selects tests. Under emulation all tests take about three hours
# on two cores.
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source=$(cd "$here/../.." && pwd)
surfaces=$source/sample_surfaces
. "$here/pipelines.sh"
. "$here/../python.sh"
. "$source/cmake/packages.sh"
suite=${SUITE:-bookworm}
limit=${RC_LIMIT:-9000}

# Each line has an omitted test (`all`, or only under emulation), a regular expression of whole names, and the
# reason.
left_out() {
    cat <<'END'
all       pipe_installed    pkg-config and find_package would find the libraries of this machine
all       law_release       of the sources, which are the same
emulated  law_folders       of the sources and their symbols, which are the same
emulated  pipe_library      starts a program that it links itself, which needs the emulator by its name
emulated  pipe_calls        watches the calls by seccomp's notifications, which the emulator has not
emulated  truth_memory_room bounds of address space, which the emulator does not set
emulated  pipe_cost         ends a run by a signal that comes, so much slower, before anything is measured
emulated  pipe_memory       bounds of memory, of which the emulator has its own
emulated  pipe_help         an example of rc-cost(1) bounds its time
emulated  law_memory_budget bounds of memory, of which the emulator has its own
emulated  format_hdf5       its file of 128 MiB ends by the bound of processor time, before that of memory
END
}

fail() {
    echo "other_machines.sh: $*" >&2
    exit "${status:-1}"
}
keep=
if [ "${1-}" = --keep ]; then
    keep=${2-}
    shift 2 || status=2 fail "--keep needs a folder"
fi
[ $# -gt 0 ] || status=2 fail "which machines? one or more of s390x, arm64, i386"
if [ -n "$keep" ]; then
    mkdir -p "$keep" && work=$(cd "$keep" && pwd) || exit 1
else
    work=$(mktemp -d) || exit 1
    trap 'rm -rf --one-file-system "$work"' EXIT
fi

# Each line has the prefix of its tools, the folder of its libraries, its emulator, compiler flags and the
# omitted tests.
describe() {
    emulator='' flags=''
    case $1 in
    s390x) triplet=s390x-linux-gnu libraries=$triplet emulator=qemu-s390x-static ;;
    arm64) triplet=aarch64-linux-gnu libraries=$triplet emulator=qemu-aarch64-static ;;
    # SSE2, because the x87 with its 80 bits rounds twice
    i386) triplet=i686-linux-gnu libraries=i386-linux-gnu flags='-msse2 -mfpmath=sse' ;;
    *) status=2 fail "$1: one of s390x, arm64, i386" ;;
    esac
    without=$(left_out | awk -v emulated="$emulator" '$1 == "all" || emulated != "" { print $2 }' | paste -sd '|')
}

# A folder with the unpacked packages of another machine, whose programs are not run: links are made relative
# to the folder.
make_root() {
    local arch=$1 root=$2 link packages
    [ -e "$root/made" ] && return
    rm -rf --one-file-system "$root" # the rest of an earlier attempt
    packages=$(printf '%s\n' $build_packages libcmocka-dev libgomp1 | grep -E '^lib.*|zlib' | paste -sd ,)
    mmdebstrap --variant=extract --arch="$arch" --include="$packages" "$suite" "$root" ${MIRROR:+"$MIRROR"} \
        >"$work/$arch.root.log" 2>&1 || {
        tail -n 5 "$work/$arch.root.log" >&2
        fail "no libraries for $arch: MIRROR=URL names another mirror"
    }
    find "$root" -type l -lname '/*' | while read -r link; do
        ln -sfn "$(realpath -sm --relative-to="$(dirname "$link")" "$root$(readlink "$link")")" "$link"
    done
    # links that the scripts of the packages would have made
    ln -sf hdf5-serial.pc "$root/usr/lib/$libraries/pkgconfig/hdf5.pc"
    touch "$root/made"
}

# Without an emulator, which would take the path of the root as an option, the programs contain the paths of
# loader and libraries.
make_build() {
    local root=$1 build=$2 log=$3 runner="$emulator;-L;$root" # the command by which CMake starts the programs
    linker=
    [ -n "$emulator" ] ||
        runner=env linker="-Wl,--disable-new-dtags,-rpath,$root/usr/lib/$libraries:$root/lib/$libraries,--dynamic-linker,$root/lib/ld-linux.so.2"
    # The tools of an earlier build are put back, because the linker would write over the scripts.
    [ ! -d "$build/elf" ] || { cp -p "$build"/elf/rc-* "$build/tools/" && rm -r "$build/elf"; }
    PKG_CONFIG_LIBDIR=$root/usr/lib/$libraries/pkgconfig:$root/usr/share/pkgconfig PKG_CONFIG_SYSROOT_DIR=$root \
        cmake -S "$source" -B "$build" -DRC_WERROR=ON -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR="${triplet%%-*}" \
        -DCMAKE_C_COMPILER="$triplet-gcc" -DCMAKE_C_FLAGS="$flags" -DCMAKE_EXE_LINKER_FLAGS="$linker" \
        -DCMAKE_SYSROOT="$root" -DCMAKE_LIBRARY_ARCHITECTURE="$libraries" -DCMAKE_FIND_ROOT_PATH="$root" \
        -DCMAKE_FIND_ROOT_PATH_MODE_PROGRAM=NEVER -DCMAKE_FIND_ROOT_PATH_MODE_LIBRARY=ONLY \
        -DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY -DCMAKE_CROSSCOMPILING_EMULATOR="$runner" \
        >"$log" 2>&1 &&
        cmake --build "$build" --parallel "$(nproc)" >>"$log" 2>&1
}

# The tests start the tools by their names: scripts with these names start the emulator.
wrap_tools() {
    local root=$1 build=$2
    [ -n "$emulator" ] || return 0
    mkdir -p "$build/elf" && mv "$build"/tools/rc-* "$build/elf/" &&
        emulated "$build/tools" "$build/elf" "$emulator" -L "$root"
}

run_tests() {
    local arch=$1 root=$2 build=$3 status
    # Emulation is about thirty times slower: tests that have not ended by then are named and stopped.
    find "$build/tests" -name CTestTestfile.cmake -exec sed -i -E "s/TIMEOUT \"[36]00\"/TIMEOUT \"$limit\"/" {} +
    # Programs that a test compiles and starts run without an emulator.
    if [ -z "$emulator" ]; then
        printf '#!/bin/sh\nexec %s "$@" %s\n' "$triplet-gcc --sysroot=$root $flags" "$linker" >"$work/$arch.cc"
        chmod +x "$work/$arch.cc"
    fi
    env ${linker:+CC="$work/$arch.cc"} ctest --test-dir "$build" --parallel "$(nproc)" -R "${RC_TESTS_OF:-.}" \
        -E "^($without)\$" --no-tests=error --timeout "$limit" --output-on-failure >"$work/$arch.tests.log" 2>&1
    status=$?
    left_out | sed -nE "s/^all +([^ ]+) +/left out: \1: /p${emulator:+; s/^emulated +([^ ]+) +/left out: \1: /p}"
    grep -E 'tests passed|^\s*[0-9]+ - .*\((Failed|Timeout|SEGFAULT|Not Run|Subprocess)' "$work/$arch.tests.log"
    return $status
}

machine() {
    local arch=$1 root=$work/$1.root build=$work/$1.build out=$work/$1.out began=$SECONDS
    describe "$arch"
    command -v "$triplet-gcc" >/dev/null || fail "$triplet-gcc is not here: apt-get install crossbuild-essential-$arch"
    [ -z "$emulator" ] || command -v "$emulator" >/dev/null ||
        fail "$emulator is not here: apt-get install qemu-user-static"
    echo "== $arch"
    make_root "$arch" "$root"
    make_build "$root" "$build" "$work/$arch.build.log" || {
        grep -E 'error:|warning:|Error' "$work/$arch.build.log" | head
        fail "no build for $arch: see $work/$arch.build.log"
    }
    wrap_tools "$root" "$build" || exit 1
    echo "built, no warning ($((SECONDS - began)) s)"
    PATH="$build/tools:$PATH" RC_THREADS=2 run_pipelines "$out" "$work/here.out" 2>"$work/$arch.pipelines.log" || {
        tail -n 3 "$work/$arch.pipelines.log"
        failed=1
    }
    echo "its tools on streams of this machine, read here and beside this machine's:"
    compare "$out" "$work/here.out" || failed=1
    for stream in "$out"/*.rcg; do
        "$work/here/tools/rc-info" --json "$stream" >/dev/null || failed=1
    done
    run_tests "$arch" "$root" "$build" || failed=1
    echo "($((SECONDS - began)) s)"
}

for need in mmdebstrap cmake; do
    command -v $need >/dev/null || fail "$need is not here: apt-get install $need"
done
python=$(cd "$work" && python_with numpy) || exit 1
failed=0
cmake -S "$source" -B "$work/here" -DRC_TESTS=OFF >"$work/here.log" 2>&1 &&
    cmake --build "$work/here" --parallel "$(nproc)" >>"$work/here.log" 2>&1 || fail "no build: see $work/here.log"
PATH="$work/here/tools:$PATH" RC_THREADS=2 run_pipelines "$work/here.out" "$work/here.out" 2>/dev/null || exit 1
for arch; do
    machine "$arch"
done
[ "$failed" = 0 ] && echo "Every machine gives what this one gives."
exit "$failed"
