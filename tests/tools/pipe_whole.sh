# SPDX-License-Identifier: GPL-3.0-or-later
# The whole pipeline works as commands, and bad input gets a clear error, the right exit status and
# no half-written file.
. "$(dirname "$0")/../pipe.sh"

# ---- Hertz, as a user would check it ----

hertz() {
    rc-synth sphere --nx "$1" --dx "$2" --radius 7.5mm |
        rc-solve --load 240N --estar 113.93GPa --report "hertz$1.json" -o "hertz$1.rcg"
}
claim "a sphere on 128 x 128 nodes solves" hertz 128 5.4um
claim "a sphere on 256 x 256 nodes solves" hertz 256 2.7um
# a = 227.981 um, p0 = 2.20473 GPa, approach = 6.93004 um (Johnson 1985, section 3.4)
for m in 128 256; do
    near "$(field max_pressure hertz$m.json)" 2.20473e9 "$coarse_grid" "peak pressure, $m"
    near "$(field approach hertz$m.json)" 6.93004e-6 "$coarse_grid" "approach, $m"
    near "$(field load hertz$m.json)" 240 "$summed" "load, $m"
    near "$(awk -v a="$(field contact_area hertz$m.json)" 'BEGIN { print sqrt(a / 3.14159265358979) }')" \
        227.981e-6 "$coarse_grid" "radius, $m"
done

# ---- the paper's section 4.2 ----

paper() {
    rc-synth selfaffine --nx 483 --ny 412 --dx 1.1um --dy 1.29um --hurst 0.8 --rms-height 0.3um \
        --rolloff 100um --short-cut 8um --seed 42 |
        rc-solve --radius 7.5mm --load 240N --E1 210GPa --nu1 0.28 --E2 210GPa --nu2 0.28 \
            --hardness 6GPa --report paper.json --output pressure --quiet -o paper.rcg
}
claim "the paper's rough sphere solves" paper
near "$(field load paper.json)" 240 "$summed" "its load is exact"
near "$(field max_pressure paper.json)" 6e9 "$same" "its largest pressure is the hardness"
near "$(rc-info --json paper.rcg | grep -o '"maximum": [^,]*' | cut -d' ' -f2)" 6e9 "$same" \
    "and no pressure in the stream is above it"
between 1e-12 "$(field plastic_area paper.json)" "$(field contact_area paper.json)" "its plastic area is not zero"
claim "rc-stress gets Poisson's ratio of body 1 from the stream" \
    bash -c 'rc-stress --depths 10um --components mises paper.rcg -o mises.rcg'
claim "the report is JSON that a parser reads" perl -MJSON::PP -e \
    'decode_json($_) for <>' paper.json

# ---- two files are two cases ----

claim "cases have consecutive numbers through the whole pipeline" bash -c '
    rc-synth sphere --nx 32 --dx 20um --radius 7.5mm -o one.rcg &&
    cat one.rcg one.rcg |
        rc-solve --load 100N --estar 100GPa --output pressure --report two.json |
        rc-stress --nu 0.3 --depths 0,50um --components szz,mises |
        rc-info --json >two.txt &&
    [ "$(wc -l <two.txt)" = 8 ] && [ "$(grep -c "\"case\": 2" two.txt)" = 4 ] &&
    [ "$(wc -l <two.json)" = 2 ]'
claim "the stream has the depth of every slice and their number" bash -c '
    [ "$(grep -c "\"frames\": \"4\"" two.txt)" = 8 ] && grep -q "\"depth\": \"5e-05\"" two.txt'

# ---- whole or not at all ----

rc-synth sphere --nx 16 --dx 1um --radius 1mm -o good.rcg
size=$(wc -c <good.rcg)
solve='rc-solve --load 1mN --estar 100GPa'
untouched() { [ ! -e out.rcg ] && [ -z "$(ls out.rcg.* 2>/dev/null)" ]; }

refuses 1 'the stream stops inside the values of a frame' "a truncated stream" "head -c $((size - 500)) good.rcg | $solve -o out.rcg"
claim "  no file is left" untouched
refuses 1 "the checksum is beef[0-9a-f]{4}, but that of the data is " "a wrong CRC" \
    "perl -pe 's/crc32 ..../crc32 beef/' good.rcg | $solve -o out.rcg"
claim "  no file is left" untouched
refuses 1 'the stream stops without an end line' "a missing end line" "head -c $((size - 9)) good.rcg | $solve -o out.rcg"
claim "  no file is left" untouched
refuses 1 'the program that wrote this stream failed: disk on fire' "a producer that failed" \
    "{ head -c $((size - 9)) good.rcg; echo 'RCGFAIL disk on fire'; } >fire.rcg; $solve -o out.rcg <fire.rcg"
refuses 1 'the stream stops before it begins' "an empty stream" "$solve -o out.rcg </dev/null"
refuses 1 'spacing dx=0 m: it must be positive' "a zero spacing" "sed 's/^dx=.*/dx=0/' good.rcg | $solve -o out.rcg"
refuses 1 'spacing dy=-1e-6 m: it must be positive' "a negative spacing" "sed 's/^dy=.*/dy=-1e-6/' good.rcg | $solve -o out.rcg"
refuses 2 '--dx 0 m: it must be above 0' "a zero spacing on the command line" "rc-synth sphere --nx 4 --dx 0 --radius 1mm"
refuses 2 '--dx -1e-06 m: it must be above 0' "a negative spacing on the command line" \
    "rc-synth sphere --nx 4 --dx -1um --radius 1mm"
refuses 1 'load 1 N is above hardness times area, 1000000 Pa x 2.56e-10 m2' "a load above hardness times area" \
    "rc-solve --load 1N --estar 100GPa --hardness 1MPa good.rcg -o out.rcg"
claim "  no file is left" untouched
refuses 2 "unknown unit 'kip'" "an unknown unit" "rc-solve --load 24kip --estar 1GPa good.rcg"
refuses 2 "unknown unit 'Pa'" "a unit of the wrong kind" "rc-solve --load 24Pa --estar 1GPa good.rcg"
refuses 2 '--depths 0,1um,2: numbers with and without a unit' "a list with and without units" \
    "rc-stress --nu 0.3 --depths 0,1um,2 good.rcg"
refuses 2 'give one of --load, --mean-pressure and --approach' "no load" "rc-solve --estar 1GPa good.rcg"
refuses 2 'give the elasticity: --estar, or' "no elasticity" "rc-solve --load 1N good.rcg"
refuses 2 'give the elasticity: .* all four' "half an elasticity" "rc-solve --load 1N --E1 210GPa --nu1 0.3 good.rcg"
refuses 2 'unknown option --lode: did you mean --load' "an unknown option" "rc-solve --lode 1N good.rcg"
refuses 1 'nowhere.rcg: No such file' "a file that is not there" "$solve nowhere.rcg"
refuses 1 'no frame with the channel pressure, only height' "a stream without pressure" \
    "rc-stress --nu 0.3 --depths 0 good.rcg"
refuses 2 "Poisson's ratio is not in the stream: give it with --nu" "no Poisson's ratio anywhere" "$solve good.rcg | rc-stress --depths 0"
refuses 1 'writing failed \(No space left on device\)' "a full disk" "$solve good.rcg >/dev/full"
refuses 1 '16 x 16 nodes need about [0-9.]+ [KM]iB, --memory allows 1 KiB: ' "more memory than is allowed" "$solve --memory 1k good.rcg"
refuses 3 'not converged after .*: accept it with a larger --tol' "an accuracy out of reach" \
    "rc-synth selfaffine --nx 32 --dx 1um --hurst 0.8 --rms-height 10nm | $solve --load 100mN --tol 1e-18 | cat >short.rcg"
claim "  the best state is written and marked" grep -aq '^converged=no' short.rcg
refuses 3 'selfaffine-seed-1, .*\(converged=no\): results from it are no more accurate' "  and what follows from it says so" \
    "rc-stress --nu 0.3 --depths 0 short.rcg | cat >/dev/null"

# ---- through links ----

mkdir -p there/in empty
ln -s there/old.rcg old_link
ln -s ../there/in/made.rcg empty/second
ln -s empty/second new_link
ln -s nowhere/made.rcg lost_link
ln -s circle_b circle_a
ln -s circle_a circle_b
cp good.rcg there/old.rcg
written() { # written LINK TARGET: the link is still a link, and its target is the written file
    rc-synth wave --wavelength 16um --amplitude 1um --nx 16 --dx 1um -o "$1" && [ -L "$1" ] && [ ! -L "$2" ] &&
        rc-info --quiet "$2" >/dev/null && ! cmp -s "$2" good.rcg && [ -z "$(find . -name '*.rcg.??????')" ]
}
claim "a link to a file stays a link, and the file is written" written old_link there/old.rcg
claim "a link to a link to a missing file stays a link, and the file is made" written new_link there/in/made.rcg
claim "  the second link stays a link too" test -L empty/second
rm there/in/made.rcg
claim "  --psd-map follows links too" bash -c 'rc-info --psd --psd-map new_link good.rcg >/dev/null && [ -L new_link ] && [ -s there/in/made.rcg ]'
refuses 1 'No such file or directory' "a link into a folder that is not there" "rc-synth sphere --nx 16 --dx 1um --radius 1mm -o lost_link"
claim "  the file stays unchanged" test -L lost_link
refuses 1 'Too many levels of symbolic links' "links in a circle" "rc-synth sphere --nx 16 --dx 1um --radius 1mm -o circle_a"
claim "  the files stay unchanged" test -L circle_a -a -L circle_b
claim "/dev/stdout is a link to a pipe" \
    says max_pressure bash -c 'rc-solve --load 1mN --estar 100GPa --quiet --report /dev/stdout -o x.rcg good.rcg | cat'
claim "  -o accepts it" says RCGEND bash -c 'rc-synth sphere --nx 16 --dx 1um --radius 1mm -o /dev/stdout | tail -c 20'

# NaN heights
printf '1 2 3 4\n2 NaN 3 1\n1 3 2 4\n' >hole.txt
refuses 1 '1 of 12 values are NaN or infinite, the first in column 1 of row 1: fill them with rc-detrend --fill' "missing heights without --fill" \
    "rc-import --dx 1um --z-unit nm hole.txt | $solve -o out.rcg"
claim "  no file is left" untouched
claim "--fill fills missing heights" bash -c \
    "rc-import --dx 1um --z-unit nm hole.txt | rc-detrend --fill | $solve --quiet -o filled.rcg"

# a ZIP archive that is not an X3P file
echo hello >hello.txt
echo again >again.txt
zip -q hello.zip hello.txt again.txt
cp hello.zip hello.x3p
refuses 1 "hello.x3p: a ZIP archive, but no X3P: it has no main.xml .* is 'hello.txt'" "a zip that is no X3P" \
    "rc-import hello.x3p -o out.rcg"
refuses 1 "hello.zip: a ZIP archive, but no X3P: it has no main.xml" "a zip under another name" "rc-import hello.zip -o out.rcg"
claim "  no file is left" untouched

# A terminal as output. `script` gives the command one.
refuses 1 'standard output is a terminal' "a terminal as output" \
    "script -qec '$solve good.rcg' /dev/null >terminal.txt; s=\$?; cat terminal.txt >&2; exit \$s"

# ---- interrupted ----

interrupted() {
    rc-synth selfaffine --nx 512 --dx 1um --hurst 0.8 --rms-height 1um -o big.rcg || return 1
    rc-solve --load 50N --estar 100GPa --tol 1e-30 --method pk99 --progress line -o stopped.rcg big.rcg 2>progress.txt &
    until grep -q 'iteration [1-9]' progress.txt || ! kill -0 $!; do sleep 0.02; done
    kill -TERM $!
    wait $!
    [ $? = 143 ] && grep -aq '^converged=no' stopped.rcg || return 1
    rc-info stopped.rcg >/dev/null
    [ $? = 3 ]
}
claim "after SIGTERM the best state is written completely, and the signal ends the tool" interrupted
twice() {
    rc-solve --load 1N:50N:1000 --estar 100GPa --tol 1e-9 --progress line -o twice.rcg big.rcg 2>progress.txt &
    until grep -q 'iteration [1-9]' progress.txt || ! kill -0 $!; do sleep 0.02; done
    kill -TERM $!
    sleep 0.02
    kill -TERM $!
    wait $!
    [ $? = 143 ] && ! ls twice.rcg.*
}
claim "a second SIGTERM leaves no incomplete file" twice
