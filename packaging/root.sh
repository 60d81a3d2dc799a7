# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by scripts that work in a root of their own: a folder with a small Debian, made by debootstrap.

# make_root SUITE FOLDER: packages come from MIRROR where the environment names one.
make_root() {
    [ "$(id -u)" = 0 ] || { echo "this needs root, for debootstrap and chroot" >&2 && return 1; }
    command -v debootstrap >/dev/null || { echo "debootstrap is missing: apt-get install debootstrap" >&2 && return 1; }
    debootstrap --variant=minbase "$1" "$2" ${MIRROR:+"$MIRROR"} >"$2.log" 2>&1 || {
        tail -n 5 "$2.log" >&2
        return 1
    }
}

# inside ROOT COMMANDS: bash runs them there, with a /proc, a /dev and a process tree that end with it.
inside() {
    # shellcheck disable=SC2016
    unshare --mount --pid --fork --kill-child bash -c '
        mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && exec chroot "$0" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin \
            LANG=C.UTF-8 HOME=/root DEBIAN_FRONTEND=noninteractive bash -euo pipefail -c "$@"' "$@"
}
