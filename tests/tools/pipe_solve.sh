# SPDX-License-Identifier: GPL-3.0-or-later
# rc-solve reacts to a signal while it waits for its input, and removes the keys of an earlier solution.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/symbols.sh"

rc-synth sphere --nx 33 --ny 29 --dx 20um --radius 7.5mm -o ball.rcg

# 143: ended by SIGTERM. The FIFO stays open, so the tool waits for a frame that never comes: it has read all bytes
# (FIONREAD is 0x541B), and sleeps.
waiting() {
    local tool status
    mkfifo fifo
    rc-solve --load 100N --estar 100GPa -o never.rcg fifo &
    tool=$!
    exec 9>fifo
    head -c 100 ball.rcg >&9
    until perl -e 'my $n = "\0" x 4; ioctl(STDIN, 0x541B, $n) or exit 0; exit(unpack("i", $n) != 0)' <&9 &&
        grep -q '^State:.[SZ]' "/proc/$tool/status"; do sleep 0.02; done
    kill -TERM "$tool"
    wait "$tool"
    status=$?
    exec 9>&-
    [ "$status" = 143 ] && ! ls never.rcg* 2>/dev/null
}
claim "a signal ends a tool that waits for input, with the status of the signal and no file" waiting

rc-solve --quiet --load 100N --estar 100GPa --hardness 1GPa --output height ball.rcg -o once.rcg
claim "the frames of a solution with a hardness have its key" \
    says 'hardness=1000000000$' rc-info once.rcg
claim "an elastic solution of the same heights has no such key" bash -c '
    rc-solve --quiet --load 100N --estar 100GPa --output pressure once.rcg -o twice.rcg &&
    rc-info twice.rcg >twice.txt && lacks hardness= twice.txt'
# all nodes are at the hardness: no node is elastic, and the approach is undefined
claim "a saturated solution does not keep an earlier approach" bash -c '
    rc-solve --quiet --mean-pressure 1GPa --hardness 1GPa --estar 100GPa --output pressure \
        once.rcg -o full.rcg && rc-info full.rcg >full.txt && lacks approach= full.txt && grep -q load= full.txt'
claim "once.rcg had one" says approach= rc-info once.rcg

claim "Poisson's ratio of an earlier solution is removed if --estar is given" bash -c '
    rc-solve --quiet --load 9N --E1 1GPa --nu1 0.3 --E2 1GPa --nu2 0.3 --output height ball.rcg |
        rc-solve --quiet --load 9N --estar 1GPa --output pressure -o later.rcg &&
    rc-info later.rcg >later.txt && lacks "nu=" later.txt'

sed 's/^unit=m$/unit=rad/' ball.rcg | reseal >rad.rcg
refuses 1 "case 1, frame 1 \(height\): its unit is 'rad': heights are in metres" "heights that are not heights" \
    "rc-solve --load 1N --estar 1GPa rad.rcg"
refuses 1 '--report nowhere/r.json: No such file' "a report that cannot be written, before the work" \
    "rc-solve --load 1N --estar 1GPa --report nowhere/r.json ball.rcg"
refuses 0 'strip 20 um wide, which carries the force,' "a profile is solved, with a warning that it is a strip" \
    "rc-synth sphere --nx 50 --ny 1 --dx 20um --radius 1mm | rc-solve --load 1mN --estar 1GPa | cat"

claim "each load of a list is a case with its frames and a line of the report" bash -c '
    rc-solve --load 10N:240N:3 --estar 114GPa --output pressure,gap --report list.json ball.rcg -o list.rcg &&
    [ "$(wc -l <list.json)" = 3 ] && says "^6$" bash -c "rc-info list.rcg | grep -c \"case [123], frame\"" &&
    [ "$(grep -c "\"stiffness\": [0-9]" list.json)" = 3 ]'
claim "the requested approach is reached, and its load computed" bash -c '
    rc-solve --approach 5um --estar 114GPa --tol 1e-5 --output pressure --report near.json ball.rcg -o near.rcg'
near "$(field approach near.json)" 5e-6 1e-6 "to a tenth of the tolerance"
claim "the stream has the same values" says "approach=$(field approach near.json)\$" rc-info near.rcg
claim "--dry-run prints the plan in words and writes nothing" bash -c '
    rc-solve --dry-run --load 10N --estar 114GPa -o dry.rcg ball.rcg >plan.txt &&
    grep -q "left out: no --hardness" plan.txt && grep -Eq "about [0-9.]+ convolutions" plan.txt && [ ! -e dry.rcg ]'
for dry in "" --dry-run; do
    refuses 1 "sums of the engine 'mlms' have no end on a periodic boundary: leave the choice to auto, or take 'fft'" \
        "an engine that sums no periodic map${dry:+, in a plan}" \
        "rc-solve $dry --periodic --kernel mlms --load 10N --estar 114GPa -o dry.rcg ball.rcg"
    refuses 1 'load 1000 N is above hardness times area' "a load beyond the hardness${dry:+, in a plan}" \
        "rc-solve $dry --hardness 1MPa --load 1kN --estar 114GPa -o dry.rcg ball.rcg"
done
claim "--discretization has an entry in the report, otherwise null" bash -c '
    rc-solve --load 10N --estar 114GPa --discretization --report d.json --output pressure ball.rcg -o d.rcg &&
    grep -q "\"contact_area_error_estimate\": 0.*\"approach_error_estimate\": [0-9]" d.json &&
    grep -q "\"contact_area_error_estimate\": null," near.json'
claim "the shape after yield is a frame" bash -c '
    rc-solve --load 100N --estar 100GPa --hardness 1GPa --output plastic ball.rcg -o plastic.rcg &&
    says "frame 1 \(plastic\)" rc-info plastic.rcg'
refuses 2 'give one of --load, --mean-pressure and --approach' "two ways to say the load" \
    "rc-solve --load 1N --approach 1um --estar 1GPa ball.rcg"

# checksums FILE...: prints the checksums of their frames, headers included, one per line.
checksums() { cat "$@" | grep -ao 'crc32 [0-9a-f]\{8\}'; }
export -f checksums
claim "frames requested together equal those requested one by one, bit for bit" bash -c '
    for frame in pressure gap displacement height plastic; do
        rc-solve --quiet --load 100N --estar 100GPa --hardness 1GPa --output $frame ball.rcg -o $frame.rcg || exit
    done
    rc-solve --quiet --load 100N --estar 100GPa --hardness 1GPa --output pressure,gap,displacement,height,plastic \
        ball.rcg -o all.rcg &&
    checksums pressure.rcg gap.rcg displacement.rcg height.rcg plastic.rcg >one.txt && checksums all.rcg >all.txt &&
    [ "$(wc -l <all.txt)" = 5 ] && cmp one.txt all.txt'
claim "the input heights are written unchanged, in their type" bash -c '
    rc-synth sphere --nx 33 --ny 29 --dx 20um --radius 7.5mm --type f32 -o narrow.rcg &&
    rc-solve --quiet --load 100N --estar 100GPa --output height narrow.rcg -o same.rcg &&
    says "type +f32" rc-info same.rcg &&
    cmp <(tail -c $((33 * 29 * 4 + 24)) narrow.rcg | head -c $((33 * 29 * 4))) \
        <(tail -c $((33 * 29 * 4 + 24)) same.rcg | head -c $((33 * 29 * 4)))'
claim "the history of every case has the step once" bash -c '
    rc-solve --quiet --load 10N:240N:3 --estar 114GPa --output pressure,height ball.rcg -o steps.rcg &&
    grep -a "^history=" steps.rcg >steps.txt && [ "$(wc -l <steps.txt)" = 6 ] &&
    [ "$(sort -u steps.txt | wc -l)" = 1 ] && ! grep -q "rc-solve.*rc-solve" steps.txt'
rc-synth sphere --nx 1024 --dx 1um --radius 7.5mm -o large.rcg
claim "all frames together need memory for one map, and the pressure needs none" bash -c '
    rc-solve --quiet --periodic --load 1N --estar 100GPa --tol 0.1 --report all.json large.rcg -o all.rcg &&
    rc-solve --quiet --periodic --load 1N --estar 100GPa --tol 0.1 --report one.json --output pressure large.rcg -o one.rcg'
with_address_sanitizer || claim "a map is 8 MiB here" [ "$(($(field peak_memory all.json) - $(field peak_memory one.json)))" -lt $((12 << 20)) ]

if ! with_mpi; then
    export OMPI_COMM_WORLD_SIZE=2
    several="rc-solve --quiet --load 10N --estar 114GPa ball.rcg"
    for tool in "$several" "rc-info ball.rcg"; do
        refuses 2 "^${tool%% *}: .* is built without MPI, and a launcher has started it 2 times: start one process" \
            "a build without MPI refuses two processes: ${tool%% *}" "OMPI_COMM_WORLD_RANK=0 $tool"
        claim "  the message is printed once" bash -c "OMPI_COMM_WORLD_RANK=1 $tool 2>second.err >/dev/null; [ \$? = 2 ] && [ ! -s second.err ]"
    done
    claim "  --help works" says 'Usage' env OMPI_COMM_WORLD_RANK=0 rc-info --help
    unset OMPI_COMM_WORLD_SIZE
fi
