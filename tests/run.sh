#!/usr/bin/env bash
# Installs what is missing (Debian, Ubuntu), builds with warnings as errors, runs every test.
# With CI=true also builds with the address and undefined-behaviour sanitizers and runs them there.
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)
cd "$top"
. cmake/packages.sh

# phase WHAT: how long it took.
phase() {
    echo "== $1: $((SECONDS - began)) s"
    began=$SECONDS
}
began=$SECONDS

# shellcheck disable=SC2086
need_packages $build_packages $test_packages

# The style is what clang-format 14 makes of .clang-format: other versions differ in details.
if clang-format --version 2>/dev/null | grep -q 'version 14\.'; then
    find libcontact formats tools tests bench -name '*.[ch]' -exec clang-format --dry-run -Werror {} +
else
    echo "Style: clang-format 14 is not here, so it is not checked."
fi
phase "packages and style"

if [ -d ../shared/corpus ]; then
    echo "Real instrument files: those in ../shared/corpus."
else
    echo "Real instrument files: ../shared/corpus is not here, so the tests on them do not run."
fi

# build PRESET, and its tests, side by side: none of them measures time closely.
build() {
    cmake --preset "$1" >/dev/null
    cmake --build --preset "$1" --parallel "$(cores)"
    phase "$1, build"
    ctest --test-dir "build-$1" --parallel "$(cores)" --output-on-failure --no-tests=error
    phase "$1, tests"
}

if [ "${CI-}" = true ]; then
    build sanitize
fi
build ci

# The difference that MPI makes: the tools and the tests that use it, on two processes, and the installed files.
cmake --preset mpi >/dev/null
cmake --build --preset mpi --parallel "$(cores)"
phase "mpi, build"
ctest --test-dir build-mpi -R '_ranks|law_folders|pipe_(installed|library(_page)?|solve)$' --output-on-failure --no-tests=error
phase "mpi, tests"
