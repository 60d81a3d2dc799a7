# SPDX-License-Identifier: GPL-3.0-or-later
# An installation works in its folder, after it was moved, and under a name with a blank. Tools run, man finds
# the pages, and other programs are built with the library, shared and static, by pkg-config and by
# find_package.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/manual.sh"
. "$RC_SOURCE/tests/python.sh"
. "$RC_SOURCE/tests/symbols.sh"

build=$(dirname "$RC_BIN")
prefix="$scratch/my prefix"
sanitizers=$(sanitizers "$build/libcontact/libcontact.a")
shared_parts=$sanitizers
with_mpi && shared_parts="$sanitizers mpi"
unset PKG_CONFIG_PATH PKG_CONFIG_LIBDIR PKG_CONFIG_SYSROOT_DIR CMAKE_PREFIX_PATH DESTDIR LD_LIBRARY_PATH MANPATH

# Absolute folders outside of the prefix belong to the system: the test does not install there.
if grep -E '^CMAKE_INSTALL_(BIN|LIB|INCLUDE|DATAROOT|MAN)DIR:[A-Z]*=/' "$build/CMakeCache.txt"; then
    skip "this build is installed in folders of its own, whatever the prefix"
fi
claim "cmake --install succeeds" cmake --install "$build" --prefix "$scratch/first"
mv first "$prefix"
pc=$(find "$prefix" -name libcontact.pc)
libdir=$(dirname "$(dirname "$pc")")

# ---- tools and pages ----

for source in $(tool_sources); do
    tool=$(basename "$source" .c)
    claim "$tool runs" says "^$tool .*[0-9]\.[0-9]" "$prefix/bin/$tool" --version
done

# found_by READER... SECTION NAME: man finds this page, and no other page of this name.
found_by() {
    local page
    page=$(PATH="$prefix/bin:$PATH" "$@") && [ "${page%.gz}" -ef "$prefix/share/man/man${*: -2:1}/${*: -1}.${*: -2:1}" ]
}
if says '^man [0-9]' man --version 2>man.err; then
    reader=(man -w) # searches beside the tools
elif command -v mman >/dev/null; then
    reader=(mman -M "$prefix/share/man" -w)
else
    reader=(man -M "$prefix/share/man" -w)
fi
for page in "$pages"/*.[1-9] "$library_page"; do
    name=$(basename "$page")
    claim "man finds $name" found_by "${reader[@]}" "${name##*.}" "${name%.*}"
done

# ---- completions of shells ----

# has_completions TOOL: completions are in the folders that bash, zsh and fish search by default.
has_completions() {
    for file in "bash-completion/completions/$1" "zsh/site-functions/_$1" "fish/vendor_completions.d/$1.fish"; do
        [ -s "$prefix/share/$file" ] && grep -q -e "$1" "$prefix/share/$file" || return
    done
}
for source in $(tool_sources); do
    tool=$(basename "$source" .c)
    claim "completions of $tool are installed" has_completions "$tool"
done

# ---- for users of numpy ----

claim "the Python package is installed" diff -r -x __pycache__ -x tables.json -x '*.pyi' -x samples "$RC_SOURCE/python" "$prefix/share/libcontact/python"
claim "  it has the option tables of the tools" bash -c '[ "$(wc -l <"$0")" = "$(ls "$1"/bin/rc-* | grep -vc "mpi\|rc-app")" ]' \
    "$prefix/share/libcontact/python/rcg/tables.json" "$prefix"
if python=$(python_with numpy 2>/dev/null); then
    claim "  rc-app runs" says '^rc-app .*[0-9]\.[0-9]' "$python" "$prefix/bin/rc-app" --version
fi
claim "  the sample surfaces are installed" cmp "$RC_SOURCE/sample_surfaces/rough-steel.x3p" "$prefix/share/libcontact/python/rcg/samples/rough-steel.x3p"

# ---- a user's program, by pkg-config ----

claim "the header has a program" head_program hertz.c
# finds_hertz PROGRAM [LIBDIR]: it runs, and finds Hertz's pressure to the accuracy of 129 nodes over three
# radii.
finds_hertz() {
    LD_LIBRARY_PATH=${2-} "$1" >hertz.txt && awk -v order="$grid_peak" '
        /^approach/ { off = $10 / 2.20563e9 - 1; most = order / (129 / 3) ^ 2; found = off <= most && -off <= most }
        END { exit !found }' hertz.txt
}

# compiled PC PROGRAM OPTION...: compiles with the options of pkg-config for this file. The runtime of a
# sanitizer, and often MPI, is only available as a shared library: programs with them are not fully static.
compiled() {
    local words program=$2 kind=${3-}
    words=$(PKG_CONFIG_PATH=$(dirname "$1") pkg-config --cflags --libs "${@:3}" libcontact) || return
    case $kind$shared_parts in
    --static) words="-static $words" ;;
    --static*) words=${words/ -lcontact/ -l:libcontact.a} ;;
    esac
    eval "${CC:-cc} -std=c17 $sanitizers -o $program hertz.c $words -lm"
}

claim "pkg-config builds it with the shared library" compiled "$pc" shared
claim "  it runs" finds_hertz ./shared "$libdir"
claim "pkg-config builds it with the static library" compiled "$pc" static --static
claim "  it runs without the shared library" finds_hertz ./static

# ---- by find_package ----

mkdir outside
cp hertz.c outside
cat >outside/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.20)
project(outside LANGUAGES C)
find_package(libcontact 0.1 REQUIRED COMPONENTS ${KINDS})
foreach(library IN LISTS LIBRARIES)
    add_executable(with_${library} hertz.c)
    target_link_libraries(with_${library} PRIVATE libcontact::${library} m)
endforeach()
END
# project FOLDER KINDS LIBRARIES OPTION...: configures and builds a project there.
project() {
    cmake -S outside -B "$1" -DCMAKE_C_COMPILER="${CC:-cc}" -DCMAKE_C_FLAGS="$sanitizers" -DKINDS="$2" -DLIBRARIES="$3" \
        "${@:4}" && cmake --build "$1"
}
claim "find_package builds it" project found 'shared;static' 'contact;contact_static' -DCMAKE_PREFIX_PATH="$prefix"
claim "  libcontact::contact runs" finds_hertz found/with_contact
claim "  libcontact::contact_static runs" finds_hertz found/with_contact_static
mv "$libdir" away
claim "  it runs without the shared library" finds_hertz found/with_contact_static
claim "  the other program needs the shared library" bash -c '! found/with_contact'
mv away "$libdir"
refuses 1 'no libcontact::contact_static, which needs fftw3 fftw3f gsl' "without FFTW and GSL, what is asked for is refused" \
    "PKG_CONFIG_LIBDIR=/ cmake -S outside -B lacking -DCMAKE_C_COMPILER='${CC:-cc}' -DKINDS=static -DCMAKE_PREFIX_PATH='$prefix'"
bare() { PKG_CONFIG_LIBDIR=/ project bare '' contact -DCMAKE_PREFIX_PATH="$prefix"; }
claim "  the shared library needs neither of them" bare
claim "  it runs" finds_hertz bare/with_contact
refuses 1 'requested version "1\.0"' "another major version is refused" \
    "sed 's/libcontact 0.1 /libcontact 1.0 /' outside/CMakeLists.txt >newer.txt && mkdir newer && cp newer.txt newer/CMakeLists.txt &&
        cmake -S newer -B newer/build -DCMAKE_C_COMPILER='${CC:-cc}' -DCMAKE_PREFIX_PATH='$prefix'"

# ---- on a communicator ----

if with_mpi; then
    cat >shared.c <<'END'
#include <libcontact/contact_mpi.h>
int
main(int argc, char **argv)
{
    struct rc_shape shape = {48, 100, 1e-6, 1e-6};
    struct rc_err err;
    struct rc_ranks *ranks;
    size_t first, n;

    MPI_Init(&argc, &argv);
    ranks = rc_ranks_new(MPI_COMM_SELF, &err);
    rc_ranks_rows(ranks, &shape, &first, &n);
    rc_ranks_free(ranks);
    MPI_Finalize();
    return first != 0 || n != 100;
}
END
    for kind in '' --static; do
        claim "mpicc builds it${kind:+, $kind}" bash -c "PKG_CONFIG_PATH='$(dirname "$pc")' pkg-config --cflags --libs $kind libcontact >words.txt &&
            sed -i '${kind:+s/ -lcontact/ -l:libcontact.a/}' words.txt && eval mpicc -std=c17 $sanitizers -o on_ranks shared.c \"\$(cat words.txt)\""
        claim "  it runs" env LD_LIBRARY_PATH="$libdir" OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 ./on_ranks
    done
fi

# ---- other layouts ----

# layout PREFIX OPTION...: installs the library of this build there, as another configuration would.
layout() {
    cmake -S "$RC_SOURCE" -B other -DCMAKE_C_COMPILER="${CC:-cc}" -DRC_TESTS=OFF "${@:2}" &&
        cp -P "$build"/libcontact/libcontact.{a,so*} other/libcontact &&
        cmake --install other/libcontact --prefix "$1"
}
export DESTDIR=$scratch/stage
claim "a staged installation in a folder of the architecture succeeds" layout /opt/contact -DCMAKE_INSTALL_LIBDIR=lib/x86_64-linux-gnu
unset DESTDIR
staged=stage/opt/contact/lib/x86_64-linux-gnu
claim "  pkg-config builds the program" compiled $staged/pkgconfig/libcontact.pc staged
claim "  it runs" finds_hertz ./staged $staged
claim "  find_package builds the program" project found_staged '' contact -DCMAKE_PREFIX_PATH="$scratch/stage/opt/contact" \
    -DCMAKE_LIBRARY_ARCHITECTURE=x86_64-linux-gnu
claim "  it runs" finds_hertz found_staged/with_contact

claim "libraries in a folder outside the prefix are installed" \
    layout "beside it" -DCMAKE_INSTALL_LIBDIR="$scratch/their own"
claim "  pkg-config builds the program" compiled "their own/pkgconfig/libcontact.pc" apart
claim "  it runs" finds_hertz ./apart "their own"
claim "  find_package builds the program" project found_apart '' contact -DCMAKE_PREFIX_PATH="$scratch/beside it"
claim "  it runs" finds_hertz found_apart/with_contact

# names_none FOLDER...: the files that find the library contain no paths except the given ones.
names_none() {
    find "$@" \( -name '*.pc' -o -name '*.cmake' \) -exec cat {} + >finders.txt &&
        [ -s finders.txt ] && ! grep -nF -e "$build" -e "$RC_SOURCE" -e /usr/local -e "$scratch/first" finders.txt >&2
}
claim "no file contains a path of the build" names_none "$prefix" stage "beside it" "their own"
