# A release has the same version in all files, is complete without git, and all links of its manual as web
# pages have a target.
. "$(dirname "$0")/pipe.sh"
. "$RC_SOURCE/tests/manual.sh"

version=$(sed -n 's/^project(libcontact VERSION \([0-9.]*\).*/\1/p' "$RC_SOURCE/CMakeLists.txt")
claim "the version is one" bash -c "[[ '$version' =~ ^[0-9]+\.[0-9]+\.[0-9]+\$ ]]"
claim "  it is that of the tools" says " $version\$" rc-info --version
# line FILE "text": the file contains this complete line.
line() { grep -qxF -- "$2" "$RC_SOURCE/$1"; }
claim "  of CITATION.cff" line CITATION.cff "version: $version"
claim "  of the newest section of CHANGELOG.md" test "$(grep -m 1 '^## ' "$RC_SOURCE/CHANGELOG.md")" = "## $version"
claim "  of the Python package" line python/rcg/__init__.py "__version__ = '$version'"
claim "  of the Debian packages" says "^libcontact \($version-" head -n 1 "$RC_SOURCE/debian/changelog"
claim "  and the name of the library has its beginning" grep -q "^Package: libcontact${version%%.*}\$" "$RC_SOURCE/debian/control"

# ---- a tarball ----

# dist SOURCE OUT: writes the tarball of this tree to OUT.
dist() {
    mkdir -p "$2" && cmake -D SOURCE="$1" -D OUT="$2" -D NAME="libcontact-$version" -P "$1/cmake/dist.cmake"
}
tarball=libcontact-$version.tar.gz
claim "a tarball is made of the tree" dist "$RC_SOURCE" first
claim "  it unpacks into one folder" test "$(tar tzf "first/$tarball" | cut -d / -f 1 | sort -u)" = "libcontact-$version"
tar xzf "first/$tarball"
claim "  without git, the same is made of what was unpacked" dist "$PWD/libcontact-$version" second
listed() { tar tzf "$1" | grep -v '/$' | sort; }
claim "  file by file" diff <(listed "first/$tarball") <(listed "second/$tarball")
claim "  with all that the build and the tests look for" bash -c '
    cd "$0" && ls CMakeLists.txt CMakePresets.json LICENSE README.md CHANGELOG.md CITATION.cff .clang-format python/rcg/*.py \
        sample_surfaces/*.x3p tests/*.sh tests/tools/*.sh debian/control' "libcontact-$version"
claim "  it configures alone" cmake -S "libcontact-$version" -B alone -DCMAKE_C_COMPILER="${CC:-cc}" "-DRC_LEAK=$(with_leak && echo AUTO || echo OFF)"
# without those under mpirun, which only a build with MPI has
tests_in() { sed -n 's/^add_test(\[*=*\[*\([a-z_0-9]*\).*/\1/p' "$1/tests/CTestTestfile.cmake" | grep -v _ranks | sort; }
claim "  with every test" diff <(tests_in "$(dirname "$RC_BIN")") <(tests_in alone)
claim "  of which there are many" test "$(tests_in alone | wc -l)" -gt 50
# The files of pkg-config without cmocka.pc.
mkdir modules
pkg-config --variable pc_path pkg-config | tr : '\n' | while read -r folder; do
    find "$folder" -name '*.pc' ! -name cmocka.pc -exec ln -sf -t modules {} + 2>find.err
done
without_cmocka() { PKG_CONFIG_PATH='' PKG_CONFIG_LIBDIR=modules cmake -S "libcontact-$version" -B untested -DCMAKE_C_COMPILER="${CC:-cc}" "$@"; }
claim "  without cmocka it configures, and says that it has no tests" says '^-- Without the tests: ' without_cmocka
claim "  nor has it any" test ! -e untested/tests
claim "  but says so to ctest" says 'no_tests_were_built__tests/run.sh_builds_and_runs_them [(]Skipped' ctest --test-dir untested
export -f without_cmocka
refuses 1 "cmocka" "  where tests are asked for, it does not" "version=$version; without_cmocka -DRC_TESTS=ON >&2"

without_amd() { cmake -S "libcontact-$version" -B dry -DCMAKE_C_COMPILER="${CC:-cc}" -DCMAKE_IGNORE_PATH="$(dirname "$(sed -n 's/^AMD_INCLUDE:[A-Z]*=//p' "$(dirname "$RC_BIN")/CMakeCache.txt")/amd.h")" -DRC_TESTS=OFF "$@"; }
if with_leak; then
    claim "  without AMD it configures, and says that there is no rc-leak" says '^-- Without rc-leak: it needs AMD of SuiteSparse' without_amd
    claim "  nor is there one" bash -c '! grep -rqs rc-leak dry/tools/CMakeFiles/TargetDirectories.txt dry/CMakeFiles/TargetDirectories.txt && grep -q rc-solve dry/CMakeFiles/TargetDirectories.txt'
    export -f without_amd
    refuses 1 "RC_LEAK=ON needs AMD" "  where it is asked for, it does not" "version=$version; without_amd -DRC_LEAK=ON >&2"
fi

# ---- web pages ----

if command -v mandoc >/dev/null; then
    claim "the manual becomes web pages" \
        cmake -D SOURCE="$RC_SOURCE" -D OUT="$PWD/html" -D VERSION="$version" -P "$RC_SOURCE/cmake/html.cmake"
    # leads_on FILE: each of its local links leads to an existing file and anchor.
    leads_on() {
        grep -o 'href="[^"]*"' "$1" | sed 's/^href="//; s/"$//' | grep -v '^https://' | sort -u | while read -r link; do
            file=${link%%#*}
            file=html/${file:-${1#html/}}
            [ -s "$file" ] && { [ "${link%#*}" = "$link" ] || grep -qF "id=\"${link#*#}\"" "$file"; } || {
                echo "$1: $link" >&2
                exit 1
            }
        done
    }
    for page in "$pages"/*.[1-9]; do
        name=$(basename "$page")
        claim "$name: the index leads to it" grep -qF "href=\"$name.html\"" html/index.html
        claim "$name:   and on from there" leads_on "html/$name.html"
    done
    pictures=$(cat "$pages"/*.7 | sed -n 's/^\.Lk \([^ ]*\.png\) .*/\1/p')
    claim "pictures of the tutorial are shown, and are there" bash -c '
        [ $# -gt 5 ] && for picture; do
            grep -qF "<img src=\"$picture\" alt=" html/contact*.html && cmp "html/$picture" "$RC_SOURCE/sample_surfaces/$picture" ||
                { echo "$picture" >&2; exit 1; }
        done' - $pictures
    claim "rc-solve.1 leads to rcg.5, here" grep -q 'href="rcg.5.html"' html/rc-solve.1.html
    claim "  and the index to what there is" leads_on html/index.html
else
    echo "not tried: web pages, because mandoc is not here"
fi

finish
