# SPDX-License-Identifier: GPL-3.0-or-later
# rc-app in headless Chromium: a real scan from the choice of the file to downloads by keyboard alone, a broken file,
# a wrong unit, a cancelled run, titles, effects and bars, a spike, a large map, a narrow window and dark colours.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/python.sh"

# The browser and its driver are large: no other test needs them.
chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
if [ -z "$chromium" ] || ! python=$(python_with numpy playwright 2>why.txt); then
    echo "Install it with 'apt-get install chromium', and 'pip install numpy playwright' in an environment whose python3 is RC_PYTHON."
    skip "rc-app in a browser. Chromium: ${chromium:-missing}. $(cat why.txt 2>/dev/null)"
fi
export PYTHONPATH="$RC_SOURCE/python" PYTHONDONTWRITEBYTECODE=1
folder=${RC_SHOTS:-$scratch/folder}
mkdir -p "$folder/shots" pasted
cp "$RC_SOURCE/sample_surfaces/rough-steel.x3p" "$folder"
head -c 3000 "$folder/rough-steel.x3p" >"$folder/broken.x3p"
rc-synth selfaffine --nx 2048 --dx 1um --hurst 0.8 --rms-slope 0.05 --rolloff 500um --short-cut 8um --seed 1 | rc-export --format x3p -o "$folder/big.x3p"
rc-synth selfaffine --nx 512 --dx 0.25um --hurst 0.7 --rms-slope 0.1 --rolloff 24um --seed 7 | rc-pick --quiet --resample 128x128 -o "$folder/jagged.rcg"
"$python" - "$folder/node.rcg" "$folder/spike.rcg" "$folder" <<'END'
import sys, numpy, rcg
pressure = numpy.zeros((2048, 2048))
pressure[1234, 567] = 1e9
pressure[700, 1300] = 3e8
rcg.write(sys.argv[1], rcg.frame('pressure', pressure, dx=1e-6))
height = 1e-6 * numpy.sin(numpy.arange(10000)).reshape(100, 100)
height[40, 60] = 1e-3
rcg.write(sys.argv[2], rcg.frame('height', height, dx=1e-6))
whole = rcg.synth('selfaffine', nx=220, dx='1um', hurst=0.8, rms_height='0.5um', rolloff='60um', short_cut='6um', seed=3).height
worn = whole[33:193, 25:185].copy()
worn[60:90, 40:80] -= 1e-6
worn[20, 20] += 1e-4
for name, values in (('new', whole[30:190, 30:190]), ('worn', worn)):
    rcg.export(rcg.frame('height', values, '1um'), sys.argv[3] + '/%s.x3p' % name)
END
"$python" -m rcg.app --no-browser >address &
app=$!
for _ in $(seq 100); do
    [ -s address ] && break
    sleep 0.1
done
claim "the checks run to their end" "$python" "$RC_SOURCE/tests/long/app_browser.py" "$chromium" "$(cat address)" "$folder"
while read -r line; do
    case $line in
    ok:*) passed "${line#ok: }" ;;
    *) failed "${line#NOT OK: }" ;;
    esac
done <claim.out
kill "$app"
wait "$app"
cp "$folder/rough-steel.x3p" pasted
claim "the commands of the page run in a shell" bash -c 'cd pasted && bash -e -u -o pipefail "$0/commands"' "$folder"
claim "  they give the bytes of the download" cmp "$folder/3-solve.rcg" pasted/3-solve.rcg
