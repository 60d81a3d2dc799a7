#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes the wheel that holds everything: tools, the libraries that they need, a font, manual pages, samples.
#
#     packaging/wheel/build.sh OUT [ROOT]
#
# The wheel for Linux appears in the folder OUT. It needs glibc 2.31 (Debian 11, Ubuntu 20.04, RHEL 9) and
# nothing else. It is built by this machine's gcc (12 or later) with headers and libraries of Debian 11, in a
# root that debootstrap makes. A folder ROOT keeps this root for the next time. MIRROR names another mirror of
# Debian. To be run by root, who alone may change into another root.
set -euo pipefail
top=$(cd "$(dirname "$0")/../.." && pwd)
. "$top/packaging/root.sh"
case "${1-}" in
-h | --help | '')
    sed -n '3,10s/^# \{0,1\}//p' "$0"
    exit $(($# == 0 ? 2 : 0))
    ;;
esac
mkdir -p "$1"
out=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
export ROOT
ROOT=$(realpath -m "${2-$work/root}")
phase() { echo "== $SECONDS s: $*"; }

here="libfftw3-dev libgsl-dev libpng-dev zlib1g-dev libzstd-dev libdeflate-dev libmd-dev
    libseccomp-dev libpango1.0-dev fonts-dejavu-core g++ libc6-dev make cmake ninja-build pkg-config patchelf python3
    autoconf automake autopoint libtool gettext gperf dpkg-dev libexpat1-dev uuid-dev"
newer="libxml2 libzip tiff hdf5 cairo fontconfig"

if [ ! -e "$ROOT/opt/rc/done" ]; then
    phase "a root of Debian 11"
    [ -e "$ROOT/usr/bin/apt-get" ] || make_root bullseye "$ROOT"
    mirror=$(sed -n 's/^deb \([^ ]*\) .*/\1/p' "$ROOT/etc/apt/sources.list" | head -n 1)
    {
        for suite in bullseye bullseye-security bookworm bookworm-security; do
            kind=deb archive=$mirror
            [[ $suite != bookworm* ]] || kind=deb-src
            [[ $suite != *-security ]] || archive=${mirror%/}-security
            echo "$kind $archive $suite main"
        done
    } >"$ROOT/etc/apt/sources.list"
    inside "$ROOT" "apt-get update -q=2 && apt-get install -q=2 -y --no-install-recommends $(tr '\n' ' ' <<<"$here")" >"$work/log" 2>&1 ||
        { tail "$work/log" >&2 && exit 1; }
    phase "libraries: $newer"
    mkdir -p "$ROOT/libraries"
    cp "$top/packaging/wheel/libraries.sh" "$ROOT/"
    inside "$ROOT" "cd /libraries && apt-get source -q=2 $newer && bash /libraries.sh" >"$ROOT/libraries.log" 2>&1 ||
        { tail -n 30 "$ROOT/libraries.log" >&2 && exit 1; }
    # Absolute links lead out of the root for the compiler of this machine.
    (cd "$ROOT" && find usr/lib usr/lib64 -type l -lname '/*' | while read -r link; do
        target=$(readlink "$link")
        [ ! -e ".$target" ] || ln -sfn "$(realpath -m --relative-to="$(dirname "$link")" ".$target")" "$link"
    done)
    # libgomp of the root, not of this machine, which needs a newer glibc.
    ln -sfn libgomp.so.1 "$ROOT/usr/lib/x86_64-linux-gnu/libgomp.so"
    touch "$ROOT/opt/rc/done"
fi

phase "the tools"
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q build scikit-build-core ninja numpy
folders=usr/lib/x86_64-linux-gnu/pkgconfig:usr/share/pkgconfig
export PKG_CONFIG_SYSROOT_DIR=$ROOT PKG_CONFIG_PATH='' CMAKE_TOOLCHAIN_FILE=$top/packaging/wheel/toolchain.cmake
export PKG_CONFIG_LIBDIR=$ROOT/opt/rc/lib/pkgconfig:$ROOT/${folders//:/:$ROOT/}
"$work/venv/bin/python" -m build --wheel --no-isolation --outdir "$work/wheel" -Ccmake.define.RC_OWN_FONTS=../share/rough-contact/fonts "$top" >"$work/log" 2>&1 || {
    { grep -i -A 5 error "$work/log" || tail -n 20 "$work/log"; } | head -n 60 >&2
    exit 1
}
phase "their libraries"
rm -rf "$ROOT/wheel"
mkdir "$ROOT/wheel"
cp "$work"/wheel/*.whl "$top/packaging/wheel/repair.py" "$ROOT/wheel"
inside "$ROOT" 'cd /wheel && mkdir done && LD_LIBRARY_PATH=/opt/rc/lib python3 repair.py *.whl done'
cp "$ROOT"/wheel/done/*.whl "$out"
phase "$(ls "$out"/*.whl)"
