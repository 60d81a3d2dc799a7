# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced after pipe.sh by the tests that inspect the build and the symbols of the linker.

# declared HEADER...: prints the functions and objects rc_... that the headers declare, one per line.
declared() {
    local header
    for header; do
        ${CC:-cc} -E -P -std=c17 -I "$RC_SOURCE" "$header" || return 1
    done | perl -0777 -ne '
        my ($round, $curly);
        $round = qr/\((?:[^()]++|(??{ $round }))*\)/;
        $curly = qr/\{(?:[^{}]++|(??{ $curly }))*\}/;
        s/__attribute__\s*$round//g;
        s/extern\s+"C"\s*\{//g;
        s/\bstatic\s+inline\b[^(;]*$round\s*$curly//g;
        s/$curly//g;
        for (split /;/) {
            next if /\btypedef\b/;
            print "$1\n" if /^[^(]*?\b(rc_\w+)\s*\(/ || /\bextern\b[^(]*\b(rc_\w+)\s*(?:\[[^\]]*\]\s*)*$/;
        }' | sort -u
}

# objects BUILD FOLDER...: prints the object files of these folders of a build, as "object source", without
# those of removed sources.
objects() {
    local build=$1 object source
    shift
    find "${@/#/$build/}" -name '*.o' | sed -E "s,^$build/(.*)CMakeFiles/[^/]*\.dir/(.*)\.o\$,& \1\2," |
        while read -r object source; do
            [ ! -f "$RC_SOURCE/$source" ] || echo "$object $source"
        done
}

# sanitizers LIBRARY: prints the sanitizer options with which the archive was compiled, which programs with it
# need too.
sanitizers() {
    nm "$1" 2>nm.err >nm.txt || cat nm.err >&2
    if grep -q __asan_init nm.txt; then
        echo "-fsanitize=address,undefined"
    fi
}

# with_mpi: true if this build has MPI.
with_mpi() {
    grep -qs '^RC_MPI:BOOL=ON' "$(dirname "$RC_BIN")/CMakeCache.txt"
}
