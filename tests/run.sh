#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what is missing (Debian, Ubuntu), builds with warnings as errors, runs every test.
# With CI=true also builds with the address and undefined-behaviour sanitizers and runs them there.
# At the end it lists the tests that were skipped, with the reasons. It fails if a test fails, or passes although a
# claim of it failed (outcome.sh).
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)
cd "$top"
. cmake/packages.sh

# phase WHAT: prints its time.
phase() {
    echo "== $1: $((SECONDS - began)) s"
    began=$SECONDS
}
began=$SECONDS
outcomes=$(mktemp -d)
trap 'cat "$outcomes"/* 2>/dev/null; rm -rf "$outcomes"' EXIT

# shellcheck disable=SC2086
need_packages $build_packages $test_packages

# Most sources give the same preprocessed text with and without MPI, and in the library with the rows of
# tests/toys.
if [ -z "${CMAKE_C_COMPILER_LAUNCHER-}" ] && command -v ccache >/dev/null; then
    export CMAKE_C_COMPILER_LAUNCHER=ccache
fi

# The style is that of clang-format 14 with .clang-format: other versions differ in details.
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

# build PRESET [OPTIONS]
build() {
    local preset=$1
    shift
    cmake --preset "$preset" >/dev/null
    cmake --build --preset "$preset" --parallel "$(cores)" "$@"
    phase "$preset, build"
}

# One test more than cores: some wait for a limit of time, a signal or another process.
parallel=$(($(cores) + 1))

# try PRESET [OPTIONS]: builds, and runs the tests in parallel, because none of them measures time closely.
try() {
    local preset=$1 failed=0 list
    shift
    list=$(mktemp "$outcomes/$preset.XXXXXX")
    ctest --test-dir "build-$preset" --output-on-failure --no-tests=error "$@" || failed=1
    echo "== $preset" >"$list"
    tests/outcome.sh "build-$preset/Testing/Temporary/LastTest.log" >>"$list" || failed=1
    return "$failed"
}

without=()
if [ "${CI-}" = true ]; then
    # Damaged files, and calls and allocations that fail: only with the sanitizers, which see more.
    without=(-E '^format_|^pipe_(mutants|wild|import.*|calls|allocations)$|^law_(memory|nan_toys)$')
    build sanitize
    try sanitize --parallel "$parallel"
    phase "sanitize, tests"
fi
build ci

# With MPI only the tests that it affects run: tools and tests on two processes, and the installed files. Two
# processes that solve together wait for each other at every sum: beside other tests they take ten times as
# long, and their waiting keeps the cores busy. They run alone. The others mostly wait for launchers, so the
# tests without MPI run at the same time.
build mpi --target mpi_tested
failed=0
try mpi -R '^(same|law).*_ranks$|^pipe_models_ranks$' || failed=1
phase "mpi, tests of two processes that solve together"
try mpi -R '^pipe_ranks$|law_folders|pipe_(installed|library(_page)?|solve)$' >build-mpi/tests.log 2>&1 &
shared=$!
try ci --parallel "$parallel" "${without[@]}" || failed=1
phase "ci, tests"
wait "$shared" || failed=1
cat build-mpi/tests.log
phase "mpi, other tests"
exit "$failed"
