#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes the Debian packages in a separate root and tests them in another, clean one:
#
#     debian/try.sh [--keep FOLDER] SUITE [FILE]
#
# SUITE is a release of Debian, such as bookworm. Both roots are made by debootstrap, with packages from the
# environment's MIRROR if it is set. The packages are built, source and binary, and checked by lintian, which
# must find nothing; installed by apt, tested by the demo on FILE, any surface that rc-import reads, and
# purged, which must leave no file; installed again and tested by debian/tests with autopkgtest. FOLDER
# receives the packages and the pictures of the demo. Run it as root, because only root may change into
# another root.
set -euo pipefail

usage() {
    sed -n '3,12s/^# \{0,1\}//p' "$0"
}
fail() {
    echo "try.sh: $*" >&2
    exit "${status:-1}"
}
keep=
case "${1-}" in
-h | --help)
    usage
    exit 0
    ;;
--keep)
    keep=${2-}
    [ -n "$keep" ] || status=2 fail "--keep needs a folder: see try.sh --help"
    shift 2
    ;;
-*) status=2 fail "unknown option $1: see try.sh --help" ;;
esac
[ $# -ge 1 ] && [ $# -le 2 ] || status=2 fail "a suite, and at most a file: see try.sh --help"
suite=$1
file=$(realpath "${2-$(dirname "$0")/../sample_surfaces/rough-steel.x3p}")
[ -r "$file" ] || fail "$file: no such file, or not readable"
[ -z "$keep" ] || mkdir -p "$keep"
command -v cmake >/dev/null || fail "cmake is not here, which makes the tarball"

top=$(cd "$(dirname "$0")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
began=$SECONDS

# phase WHAT: prints the next phase.
phase() {
    echo "== $suite, $((SECONDS - began)) s: $*"
}

. "$top/packaging/root.sh"
# in_root ROOT 'COMMANDS': runs the commands in the folder with the packages.
in_root() {
    inside "$1" "cd /packages && $2"
}
get='apt-get -q=2 -y --no-install-recommends -o Dpkg::Use-Pty=0 -o APT::Keep-Downloaded-Packages=true'
get="$get -o APT::AutoRemove::SuggestsImportant=false -o APT::AutoRemove::RecommendsImportant=false"

# downloaded ROOT: prints the megabytes that apt has downloaded there, lists and packages.
downloaded() {
    find "$1/var/cache/apt/archives" "$1/var/lib/apt/lists" -type f -printf '%s\n' | awk '{ n += $1 } END { printf "%d", n / 1e6 }'
}

# everything ROOT: lists its files, except the logs of apt, dpkg and adduser.
everything() {
    (cd "$1" && find . \( -path ./packages -o -path ./proc -o -path ./dev -o -path ./tmp -o -path ./run -o -path './etc/*-' -o -path ./var/cache -o -path ./var/log \
        -o -path ./var/lib/apt -o -path ./var/lib/dpkg \) -prune -o -print | sort)
}

phase "two roots"
make_root "$suite" "$work/clean" || fail "no root of $suite"
mkdir "$work/clean/packages"
inside "$work/clean" "apt-get update -q=2 && apt-get clean"
cp -a "$work/clean" "$work/build"

phase "packages"
version=$(sed -n 's/^project(libcontact VERSION \([0-9.]*\).*/\1/p' "$top/CMakeLists.txt")
name=libcontact-$version
cmake -D SOURCE="$top" -D OUT="$work" -D NAME="$name" -P "$top/cmake/dist.cmake" >/dev/null
tar xzf "$work/$name.tar.gz" -C "$work/build/packages"
tar czf "$work/build/packages/libcontact_$version.orig.tar.gz" --exclude="$name/debian" -C "$work/build/packages" "$name"
in_root "$work/build" "
    $get install build-essential lintian >/dev/null 2>&1
    $get build-dep ./$name >/dev/null 2>&1
    cd $name && DEB_BUILD_OPTIONS=terse dpkg-buildpackage -us -uc >../log 2>&1" || {
    [ -z "$keep" ] || cp "$work/build/packages/log" "$keep"
    { grep -iE -A 8 'error' "$work/build/packages/log" || tail "$work/build/packages/log"; } | head -n 60 >&2
    fail "the packages are not built; with --keep FOLDER the whole log is there"
}
if grep -n 'warning:' "$work/build/packages/log"; then
    fail "the compiler warns"
fi

phase "lintian"
# The changelog closes no bug of Debian, because no bug requests these packages.
in_root "$work/build" "
    lintian --version
    lintian --allow-root --info --display-info --fail-on error,warning \
        --suppress-tags initial-upload-closes-no-bugs *.changes" || fail "lintian is not content"

phase "installed by apt"
for folder in "$work/clean/packages" ${keep:+"$keep"}; do
    find "$work/build/packages" -maxdepth 1 -type f -exec cp -t "$folder" {} +
done
before=$(downloaded "$work/clean")
start=$SECONDS
in_root "$work/clean" "$get install ./libcontact0.1_*.deb ./rough-contact_*.deb >/dev/null 2>&1"
echo "rough-contact and what it needs: $(($(downloaded "$work/clean") - before)) MB fetched, $((SECONDS - start)) s"
in_root "$work/clean" "$get purge rough-contact libcontact0.1 >/dev/null && $get autoremove --purge >/dev/null
    # these stay, for man -k, and because autoremove keeps packages of priority \"important\"; other
    # dependencies are removed
    $get install man-db adduser netbase >/dev/null 2>&1"
everything "$work/clean" >"$work/before"
in_root "$work/clean" "$get install ./*.deb >/dev/null"
in_root "$work/clean" "dpkg -l | awk '/contact|rcg/ { print \$2, \$3 }'"

phase "the demo on $(basename "$file")"
cp "$file" "$work/clean/packages/"
in_root "$work/clean" "
    man -k contact
    /usr/share/doc/rough-contact/examples/sample_surfaces/demo.sh '$(basename "$file")'"
if [ -n "$keep" ]; then
    cp "$work"/clean/packages/rc-demo/*.png "$keep"
fi

phase "purged"
in_root "$work/clean" "$get purge '~ncontact' '~nrcg' >/dev/null && $get autoremove --purge >/dev/null"
everything "$work/clean" >"$work/after"
diff "$work/before" "$work/after" || fail "these files were left, or taken, by what is gone"

phase "debian/tests"
in_root "$work/clean" "
    $get install autopkgtest gcc libc6-dev octave pkgconf python3-matplotlib ./*.deb >/dev/null 2>&1
    autopkgtest -q --no-built-binaries *.dsc *.deb -- null" || fail "a test of the packages fails"
phase "done"
