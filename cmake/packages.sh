# SPDX-License-Identifier: GPL-3.0-or-later
# Checks that the packages for the build are installed: bash cmake/packages.sh, or `bash cmake/packages.sh tests` for
# the build and the tests. On Debian and Ubuntu it installs missing ones; elsewhere it prints what is needed.
# demo.sh and tests/run.sh source it and name the packages.

build_packages="gcc libc6-dev make cmake pkg-config libfftw3-dev libgsl-dev libpng-dev libxml2-dev
    libzip-dev zlib1g-dev libzstd-dev libdeflate-dev libhdf5-dev libtiff-dev libmd-dev libseccomp-dev libpango1.0-dev fonts-dejavu-core"
test_packages="ccache libcmocka-dev mandoc zip unzip perl clang-format poppler-utils librsvg2-bin
    python3-numpy python3-matplotlib python3-pandas python3-xarray python3-nbclient
    python3-ipykernel parallel zsh fish openmpi-bin libopenmpi-dev"

need_packages() {
    local missing="" package as_root=""
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        cat <<'EOT'
This is neither Debian nor Ubuntu: please see that these are installed, with their headers:
  a C17 compiler with OpenMP, make, CMake 3.20 or later, pkg-config, awk
  FFTW 3.3.5 or later (double and single precision, with threads), GSL 2.2 or later, libpng,
  libxml2, libzip, zlib, libzstd, libdeflate, libhdf5, libtiff, libmd, libseccomp (Linux), Pango with cairo, and a sans serif font that
  fontconfig finds, such as DejaVu Sans
  for the tests also: cmocka, mandoc, zip, unzip, perl, poppler, rsvg-convert, clang-format 14,
  Python with numpy, matplotlib, pandas, xarray, nbclient and ipykernel, GNU parallel, zsh, fish, and Open MPI for tests/run.sh; where Octave or Julia is,
  the readers in their languages are tried too
EOT
        return 0
    fi
    for package in "$@"; do
        dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' ||
            missing="$missing $package"
    done
    [ -z "$missing" ] && return 0
    echo "Installing:$missing"
    if [ "$(id -u)" != 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "These packages are missing and you are not root: apt-get install$missing" >&2
            return 1
        fi
        as_root=sudo
    fi
    $as_root apt-get update -qq || return 1
    # shellcheck disable=SC2086
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
        $missing >/dev/null
}

# Prints the number of cores for building.
cores() {
    getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1
}

# shellcheck disable=SC2086
[ "${BASH_SOURCE[0]}" != "$0" ] || need_packages $build_packages ${1:+$test_packages}
