# SPDX-License-Identifier: GPL-3.0-or-later
# rc-app serves its page to this machine alone and with its token. It runs the tools with the commands that it
# shows, which give the same bytes in a shell. Hostile names, large, broken and foreign files, cancelled runs,
# several runs and closed pages end well.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/python.sh"

if ! python=$(python_with numpy 2>why.txt); then
    skip "$(cat why.txt)"
fi
export PYTHONPATH="$RC_SOURCE/python" PYTHONDONTWRITEBYTECODE=1 RC_THREADS=1 TMPDIR="$scratch/temporary"
mkdir "$TMPDIR"
app() { "$python" -m rcg.app "$@"; }
check() { "$python" "$RC_SOURCE/tests/tools/python_app.py" "$address" "$@"; }
# figures FILE: a report without its columns of memory and time, which differ between equal runs.
figures() {
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; i++) out[i] = $i ~ /memory|seconds/ } { for (i = 1; i <= NF; i++) if (!out[i]) print $i }' "$1"
}
export -f figures
# waits_for FILE: until the file has a line.
waits_for() {
    for _ in $(seq 1200); do
        [ -s "$1" ] && return
        sleep 0.05
    done
    return 1
}

cp "$RC_SOURCE/sample_surfaces/rough-steel.x3p" .
head -c 3000 rough-steel.x3p >broken.x3p
echo 'no surface at all' >note.doc

# ---- the command line ----

claim "--version names the version" says '^rc-app \(libcontact\) [0-9]+\.[0-9]' app --version
claim "--help has all options" says '\-\-no-browser' app --help
refuses 2 'unrecognized arguments: --token' "an unknown option" "'$python' -m rcg.app --token a"
refuses 1 'rc-app: none.x3p: No such file' "a missing file" "'$python' -m rcg.app --no-browser none.x3p"
refuses 1 'rc-app: rc-solve: not found' "missing tools" "RC_BIN=/nowhere '$python' -m rcg.app --no-browser"
refuses 1 'rc-app: --port 70000: ' "an impossible port" "'$python' -m rcg.app --no-browser --port 70000"
# The file is missing, so that it ends: it has found its tools and its package before.
clone=$(sed -n 's,^    \(RC_BIN=build/tools .* python3 -m rcg.app scan.x3p\)$,\1,p' "$RC_SOURCE/README.md")
refuses 1 'rc-app: scan.x3p: No such file' "README starts it in a clone" "env -u PYTHONPATH -u RC_BIN bash -c 'cd \"$RC_SOURCE\" && $(
    sed "s,build/tools,\"$RC_BIN\",; s,python3,\"$python\",; s,app,& --no-browser," <<<"$clone")'"
claim "  the tools that a relative RC_BIN names run in other folders" says '^rc-info ' env "RC_BIN=$(basename "$RC_BIN")" \
    bash -c 'cd "$1/.." && "$0" -c "from rcg import tools; print(tools.execute([\"rc-info\", \"--version\"], folder=\"/\")[1].decode())"' "$python" "$RC_BIN"
claim "  no temporary folder is left" bash -c '[ -z "$(ls "$TMPDIR")" ]'

# ---- the page ----

# A page that is closed for 0.3 s ends its tools here, in place of 3 s.
"$python" -c 'import rcg.app; rcg.app.GRACE = 0.3; rcg.app.main(["--no-browser"])' >address 2>app.err &
APP=$!
claim "rc-app prints its address" waits_for address
address=$(cat address)
"$python" "$RC_SOURCE/tests/tools/python_app.py" "$address" watch >watching &
WATCH=$!
waits_for watching
FOLDER=$(ls -d "$TMPDIR"/rc-app-*)
export APP WATCH FOLDER
claim "  its folder is private" bash -c '[ "$(stat -c %a "$FOLDER")" = 700 ]'
claim "  it listens on 127.0.0.1 alone" check loopback
claim "the page is served, with a policy that forbids all else" check page
claim "403 without the token or with a wrong one" check token
claim "403 for another Host" check host
claim "403 for another Origin" check origin
claim "names from the browser are harmless" check names
claim "only options of the tables are accepted" check options

# ---- files ----

claim "a file of 200 MB is accepted" check large
claim "a file above the limit is refused" check limit
claim "a broken file gives the message of rc-import" check broken broken.x3p 'the ZIP archive is damaged or cut off'
claim "a file that is not a surface" check broken note.doc 'not recognised'
claim "a wrong unit gives the message of rc-solve" check wrong_unit
claim "all four boundaries can be chosen" check boundaries

# ---- runs ----

claim "files of one name stay different files" check same_names
claim "each step runs as the page adds it" check added_steps
claim "a second scan is compared with the first one" check compare
claim "a scan is read, cropped, levelled, pressed, and the stresses computed" check pipeline
mkdir pasted
cp rough-steel.x3p pasted
claim "  the commands run in a shell" bash -c 'cd pasted && bash -e -u -o pipefail ../commands'
rm pasted/rough-steel.x3p
for name in shown/*; do
    name=${name##*/}
    if [ "${name##*.}" = tsv ]; then
        claim "  they give the figures of $name" bash -c 'diff <(figures "shown/$0") <(figures "pasted/$0")' "$name"
    else
        claim "  they give the bytes of $name" cmp "shown/$name" "pasted/$name"
    fi
done
claim "the effects of the contact are judged" check effects
claim "the contact gets the bars of rc-cost" check accuracy
claim "frames and colours are those of the tools" check frames
claim "a run uses the results of an earlier one; one that is removed leaves the others" check again
claim "two runs at once, a third waits; cancelled, their tools end" check cancel
claim "a fifth page is refused" check pages
claim "a closed page ends its tools" check closed
claim "Quit ends rc-app" check quit
wait "$APP"
claim "  its exit status is 0" [ $? = 0 ]
claim "  it said nothing else" cmp app.err /dev/null
claim "  its temporary folder is removed" bash -c '[ -z "$(ls "$TMPDIR")" ]'

# ---- signals ----

printf '#!/bin/sh\ncat /proc/[0-9]*/cmdline 2>/dev/null | tr "\\0" " " >cmdlines\necho "$1" >opened\n' >browser
chmod +x browser
BROWSER="$PWD/browser %s" DISPLAY=:9 "$python" -m rcg.app rough-steel.x3p >address 2>app.err &
APP=$!
waits_for address && waits_for opened
address=$(cat address)
claim "the browser gets a private file, which is removed, and no command line has the address" check first "$(cat opened)"
claim "  the file of the command line is on the page" check has rough-steel.x3p
kill "$APP"
wait "$APP"
claim "a signal ends it, and its folder is removed" bash -c '[ "$0" = 0 ] && [ -z "$(ls "$TMPDIR")" ]' $?
rc-synth sphere --nx 33 --dx 1um --radius 1mm -o 1-pick.rcg
cp 1-pick.rcg before.rcg
"$python" -m rcg.app --no-browser 1-pick.rcg >address 2>app.err &
APP=$!
waits_for address
address=$(cat address)
claim "a file of the command line with the name of an output is not written to" check kept 1-pick.rcg before.rcg
claim "  it ends" check quit
wait "$APP"
cat >busy.py <<'END'
import tempfile, threading, types, urllib.request
from rcg import app
clock = iter(range(0, 10**6, 60))  # on a busy machine a minute passes between two looks
app.time = types.SimpleNamespace(monotonic=lambda: next(clock))
desk, ended = app.Desk(0, tempfile.gettempdir(), None), []
threading.Thread(target=desk.serve_forever, daemon=True).start()
desk.runs[1] = types.SimpleNamespace(cancel=lambda: ended.append(True))
looks = [desk.watch() for _ in range(20)]  # the browser starts
assert all(looks) and ended, (looks, ended)
ended.clear()
urllib.request.urlopen(desk.address() + 'page.css').close()  # the page starts a run and is not connected yet
counts = [(desk.watch(), len(ended))[1] for _ in range(8)]
assert counts == [0, 0, 0, 0, 0, 0, 1, 2], counts
END
claim "on a busy machine a run goes on until its page is connected, and ends 3 s after its last request" "$python" busy.py
claim "without a page it ends by itself" timeout 20 "$python" -c 'import rcg.app; rcg.app.IDLE = 0.3; rcg.app.main(["--no-browser"])'
