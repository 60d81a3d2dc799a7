#!/usr/bin/env bash
# Installs what is missing (Debian, Ubuntu), builds with warnings as errors, runs every test.
# With CI=true also builds with the address and undefined-behaviour sanitizers and runs them there.
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)
cd "$top"
. cmake/packages.sh

# shellcheck disable=SC2086
need_packages $build_packages $test_packages

# The style is what clang-format 14 makes of .clang-format: other versions differ in details.
if clang-format --version 2>/dev/null | grep -q 'version 14\.'; then
    find libcontact formats tools tests bench -name '*.[ch]' -exec clang-format --dry-run -Werror {} +
else
    echo "Style: clang-format 14 is not here, so it is not checked."
fi

if [ -d ../shared/corpus ]; then
    echo "Real instrument files: those in ../shared/corpus."
else
    echo "Real instrument files: ../shared/corpus is not here, so the tests on them do not run."
fi

if [ "${CI-}" = true ]; then
    cmake --preset sanitize >/dev/null
    cmake --build --preset sanitize --parallel "$(cores)"
    ctest --test-dir build-sanitize --output-on-failure --no-tests=error
fi
cmake --preset ci >/dev/null
cmake --build --preset ci --parallel "$(cores)"
ctest --test-dir build-ci --output-on-failure --no-tests=error
