# SPDX-License-Identifier: GPL-3.0-or-later
# A release has the same version in all files, is complete without git, and all links of its manual as web
# pages have a target.
. "$(dirname "$0")/pipe.sh"
. "$RC_SOURCE/tests/manual.sh"

version=$(sed -n 's/^project(libcontact VERSION \([0-9.]*\).*/\1/p' "$RC_SOURCE/CMakeLists.txt")
claim "the version is a single one" bash -c "[[ '$version' =~ ^[0-9]+\.[0-9]+\.[0-9]+\$ ]]"
claim "  the tools have this version" says " $version\$" rc-info --version
# line FILE "text": the file contains this complete line.
line() { grep -qxF -- "$2" "$RC_SOURCE/$1"; }
claim "  CITATION.cff has this version" line CITATION.cff "version: $version"
claim "  the newest section of CHANGELOG.md has this version" test "$(grep -m 1 '^## ' "$RC_SOURCE/CHANGELOG.md")" = "## $version"
claim "  the Python package has this version" line python/rcg/__init__.py "__version__ = '$version'"
claim "  the Debian packages have this version" says "^libcontact \($version-" head -n 1 "$RC_SOURCE/debian/changelog"
# 0.1.2 -> 0.1, 1.2.3 -> 1
case $version in 0.*) soname=${version%.*} ;; *) soname=${version%%.*} ;; esac
claim "  the Debian package of the library has the soname of this version" line debian/control "Package: libcontact$soname"
claim "  its list of symbols has it too" line "debian/libcontact$soname.symbols" "libcontact.so.$soname libcontact$soname #MINVER#"
claim "  the built library has this soname" test -e "$(dirname "$RC_BIN")/libcontact/libcontact.so.$soname"
claim "  the manual names it" grep -qxF ".Pa libcontact.so.$soname ." "$library_page"

# ---- a tarball ----

# dist SOURCE OUT: writes the tarball of this tree to OUT.
dist() {
    mkdir -p "$2" && cmake -D SOURCE="$1" -D OUT="$2" -D NAME="libcontact-$version" -P "$1/cmake/dist.cmake"
}
tarball=libcontact-$version.tar.gz
claim "a tarball of the tree can be made" dist "$RC_SOURCE" first
claim "  it unpacks into one folder" test "$(tar tzf "first/$tarball" | cut -d / -f 1 | sort -u)" = "libcontact-$version"
tar xzf "first/$tarball"
claim "  the unpacked tree, without git, gives the same tarball" dist "$PWD/libcontact-$version" second
listed() { tar tzf "$1" | grep -v '/$' | sort; }
claim "  it has the same files" diff <(listed "first/$tarball") <(listed "second/$tarball")
claim "  it has all files that the build and the tests use" bash -c '
    cd "$0" && ls CMakeLists.txt CMakePresets.json LICENSE README.md CHANGELOG.md CITATION.cff .clang-format python/rcg/*.py \
        sample_surfaces/*.x3p tests/*.sh tests/tools/*.sh debian/control' "libcontact-$version"
claim "  the unpacked tree can be configured" cmake -S "libcontact-$version" -B alone -DCMAKE_C_COMPILER="${CC:-cc}"
# without those under mpirun, which only a build with MPI has
tests_in() { sed -n 's/^add_test(\[*=*\[*\([a-z_0-9]*\).*/\1/p' "$1/tests/CTestTestfile.cmake" | grep -v _ranks | sort; }
claim "  it has every test" diff <(tests_in "$(dirname "$RC_BIN")") <(tests_in alone)
claim "  the tests are many" test "$(tests_in alone | wc -l)" -gt 50
# The files of pkg-config without cmocka.pc.
mkdir modules
pkg-config --variable pc_path pkg-config | tr : '\n' | while read -r folder; do
    find "$folder" -name '*.pc' ! -name cmocka.pc -exec ln -sf -t modules {} + 2>find.err
done
mkdir lent
: >lent/numpy.py
without_cmocka() { PYTHONPATH="$PWD/lent" PKG_CONFIG_PATH='' PKG_CONFIG_LIBDIR=modules cmake -S "libcontact-$version" -B untested -DCMAKE_C_COMPILER="${CC:-cc}" "$@"; }
claim "  without cmocka the configuration succeeds and says that there are no tests" says '^-- Without the tests: ' without_cmocka
claim "  no test exists" test ! -e untested/tests
claim "  ctest says so" says 'no_tests_were_built__tests/run.sh_builds_and_runs_them [(]Skipped' ctest --test-dir untested
claim "  the type hints of Python are made with the numpy of PYTHONPATH, which pip lends to a build" \
    grep -rqs --include=build.make --include=build.ninja "/python:$PWD/lent " untested
export -f without_cmocka
refuses 1 "cmocka" "  where tests are asked for, it does not" "version=$version; without_cmocka -DRC_TESTS=ON >&2"

# ---- web pages ----

if command -v mandoc >/dev/null; then
    claim "the manual becomes web pages" \
        cmake -D SOURCE="$RC_SOURCE" -D LIBRARY_PAGE="$library_page" -D OUT="$PWD/html" -D VERSION="$version" -P "$RC_SOURCE/cmake/html.cmake"
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
    for page in "$pages"/*.[1-9] "$library_page"; do
        name=$(basename "$page")
        claim "$name: the index has a link to the page" grep -qF "href=\"$name.html\"" html/index.html
        claim "$name:   the page has links to others" leads_on "html/$name.html"
    done
    pictures=$(cat "$pages"/*.7 | sed -n 's/^\.Lk \([^ ]*\.png\) .*/\1/p')
    claim "the page of the tutorial shows its pictures" bash -c '
        [ $# -gt 5 ] && for picture; do
            grep -qF "<img src=\"$picture\" alt=" html/contact*.html && cmp "html/$picture" "$RC_SOURCE/sample_surfaces/$picture" ||
                { echo "$picture" >&2; exit 1; }
        done' - $pictures
    claim "rc-solve.1 has a link to rcg.5" grep -q 'href="rcg.5.html"' html/rc-solve.1.html
    claim "  every link of the index has a target" leads_on html/index.html
else
    untried "web pages, because mandoc is not here"
fi
