#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Tries a wheel where nothing else is: in a new root of Debian with Python alone, without fonts.
#
#     packaging/wheel/try.sh SUITE WHEEL [ROOT]
#
# SUITE is a release of Debian, such as bookworm; a folder ROOT keeps its root. pip installs the wheel and
# numpy. Then it runs the pipeline of README, pictures, a page, HDF5 written and read again, and the tests of
# the Python package. MIRROR names another mirror of Debian. To be run by root, who alone may change into
# another root.
set -euo pipefail
top=$(cd "$(dirname "$0")/../.." && pwd)
. "$top/packaging/root.sh"
[ $# -ge 2 ] || {
    sed -n '3,9s/^# \{0,1\}//p' "$0"
    exit 2
}
work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
root=$(realpath -m "${3-$work/root}")
if [ ! -e "$root/usr/bin/python3" ]; then
    make_root "$1" "$root"
    inside "$root" "apt-get update -q=2 && apt-get install -q=2 -y --no-install-recommends python3-venv >/dev/null 2>&1"
fi
rm -rf "$root/try"
mkdir "$root/try"
# the clean root reaches no registry: numpy comes as a wheel for its Python
version=$(inside "$root" "python3 -c 'import sys; print(\"%d%d\" % sys.version_info[:2])'")
python3 -m pip download -q --only-binary :all: --python-version "$version" --implementation cp --platform manylinux_2_17_x86_64 \
    --platform manylinux_2_28_x86_64 --no-deps -d "$root/try" numpy
cp "$2" "$root/try"
cp "$top"/tests/tools/python_rcg.py "$top"/sample_surfaces/rough-steel.x3p "$root/try"
cat >"$root/try/commands" <<'END_OF_COMMANDS'
cd /try
export RC_THREADS=1
echo "Debian $(cat /etc/debian_version), $(python3 --version), $(find / -xdev -name '*.ttf' | wc -l) fonts"
rm -rf /venv
python3 -m venv /venv
start=$(date +%s%N)
/venv/bin/pip install -q --no-index --find-links /try rough-contact 2>&1 | grep -v 'WARNING\|new release' || true
echo "installed in $((($(date +%s%N) - start) / 1000000)) ms, $(du -sm /venv/share/rough-contact | cut -f 1) MB of libraries"
export PATH=/venv/bin:$PATH
for tool in /venv/bin/rc-*; do
    "$tool" --version >/dev/null
    [ "$tool" = /venv/bin/rc-app ] || ldd "$tool" 2>&1 | grep -v /venv/ | awk '{ print $1 }'
done | sort -u | tr '\n' ' '
echo "are the libraries of the system"
rc-import rough-steel.x3p | rc-detrend --poly 2 --spikes 5 --fill |
    rc-solve --radius 3.75mm --load 60N --estar 114GPa --hardness 6GPa --report report.json | tee contact.rcg |
    rc-stress --nu 0.28 --depths 0:20um:21 | rc-render --channel mises -o mises.png
echo "pipeline: $(sha256sum <contact.rcg | cut -c 1-16), $(grep -o '"contact_area": [^,]*' report.json)"
for format in png svg pdf; do
    rc-render --channel pressure --border contact.rcg -o "pressure.$format"
done
rc-report --quiet --load 1N --estar 114GPa -o page.html rough-steel.x3p
[ "$(grep -c '<img' page.html)" = 5 ] && grep '<title>' page.html
rc-export --channel height contact.rcg -o heights.h5
rc-import heights.h5 -o again.rcg
head -c 3000 heights.h5 >damaged.h5
! rc-import damaged.h5 -o damaged.rcg
rc-synth sphere --nx 33 --ny 47 --dx 1.1um --dy 1.29um --radius 2.385mm -o ball.rcg

for check in 'round_trip ball.rcg' arrays no_frames 'run ball.rcg' 'report ball.rcg' 'options ball.rcg' short warns 'functions ball.rcg' 'steps ball.rcg' \
    'layers ball.rcg' 'mistakes ball.rcg' unfinished 'pictures ball.rcg' progress documented; do
    python3 python_rcg.py $check && echo "ok: $check"
done
rc-app --no-browser rough-steel.x3p >address &
sleep 2
python3 -c 'import sys, urllib.request; print(urllib.request.urlopen(sys.argv[1]).read().decode()[:60])' "$(cat address)" | grep -i doctype
kill $!
wait
PATH=/usr/bin:/bin /venv/bin/python - <<'PYTHON'
import os, time
start = time.perf_counter()
import numpy
middle = time.perf_counter()
import rcg
end = time.perf_counter()
print('import: numpy %.3f s, rcg %.3f s more' % (middle - start, end - middle))
surface = rcg.detrend(rcg.open(rcg.sample()), poly=2, spikes=5, fill=True)
print(rcg.solve(surface, radius='3.75mm', load='60N', estar='114GPa', hardness='6GPa'))
assert os.path.exists(os.path.join(os.path.dirname(rcg.__file__), '__init__.pyi'))
PYTHON
/venv/bin/pip uninstall -q -y rough-contact
! ls /venv/bin/rc-* 2>/dev/null
END_OF_COMMANDS
inside "$root" 'bash -euo pipefail /try/commands'
