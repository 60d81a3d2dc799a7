#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh BUILD SECONDS [FORMAT[:HARNESS]...]: fuzzes each reader for this time. It starts from the files of
# the tests (RC_TESTS names the folder of the built tests) and from real files in RC_CORPUS. Of each it takes
# the first 64 KiB, or the whole file if the format is a container. Prints executions and findings, which are
# kept in BUILD/findings; the corpus that the fuzzer has built up stays in BUILD/corpus for the next run.
# Limits: rc_memory_limit of memory held at a time, and one second of the processor. By the clock the limit is
# ten seconds, because the machine may be busy. The slowest file is named.
#
#     format   the reader in this process
#     zip      the same, changing the members of the archive
#     bypass   a reader that needs the sandbox, without the sandbox
#     sandbox  the same in the sandbox: a crash in the library is counted but is not a finding
#     whole    the same from whole files, up to 4 MiB
#     hdf      the reader with a substitute for libhdf5
#     gzip     not a reader, but the code that unpacks files, for any FORMAT (run.sh BUILD SECONDS any:gzip)
#     stream   the reader of grid streams (run.sh BUILD SECONDS rcg:stream), from streams of the tools in RC_BIN
#
# RC_RUNS in the environment limits the executions of each; SECONDS 0 then sets no time limit.
set -u
build=$1 seconds=$2
shift 2
here=$(cd "$(dirname "$0")/../.." && pwd)
seeds=$build/seeds
mkdir -p "$seeds" "$build/findings" "$build/logs"
formats=$(sed -n 's/^RC_FORMAT(\(.*\))$/\1/p' "$here/formats/formats.list")
for format in $formats; do mkdir -p "$seeds/$format"; done
"$build/fuzz-seeds" "$seeds" || exit 1
# shellcheck disable=SC2086
[ $# -gt 0 ] || set -- $formats
if [ -d "${RC_TESTS:-}" ]; then
    for test in "$RC_TESTS"/format_*; do
        [ -x "$test" ] && [ -f "$test" ] && RC_SEEDS=$seeds "$test" >"$build/logs/seeds" 2>&1
    done
fi

harnesses_of() {
    case $1 in
    x3p | plux | vk | zon | xlsx) echo zip ;;
    npy) echo format zip ;;
    jpk | park | lext | tiff) echo bypass sandbox whole ;;
    mat73) echo sandbox whole ;;
    hdf5 | datx) echo hdf sandbox whole ;; # libhdf5 1.10 itself reads beyond its memory: never bypass
    *) echo format ;;
    esac
}

# prints the reader for the FORMAT of the manifest; nothing if no reader exists
reader_of() {
    sed -n "s/^CORPUS_FORMAT(\"$1\", \"\(.*\)\")$/\1/p" "$here/tests/formats/corpus.list"
}
if [ -r "${RC_CORPUS:-}/manifest.tsv" ]; then
    tail -n +2 "$RC_CORPUS/manifest.tsv" | cut -f 1,2 | while IFS=$'\t' read -r file format; do
        reader=$(reader_of "$format")
        [ -n "$reader" ] || continue
        bytes=65536
        [ "$(harnesses_of "$reader")" = format ] || bytes=4194304
        head -c $bytes "$RC_CORPUS/corpus/$file" >"$seeds/$reader/${file##*/}"
    done
    cp "$here"/sample_surfaces/*.x3p "$seeds/x3p"
fi

# Streams of every tool that writes them: maps, cases, depths, sections, both types, several streams in one
# file, a stream that ends with a failure.
stream_seeds() (
    set -e
    PATH="$RC_BIN:$PATH"
    mkdir -p "$seeds/rcg" && cd "$seeds/rcg" || exit 1
    rc-synth sphere --nx 5 --ny 4 --dx 1.1um --dy 1um --radius 2mm -o sphere
    rc-synth wave --nx 3 --ny 1 --dx 1um --amplitude 1nm --wavelength 3um --type f32 -o profile
    rc-pick --set 'note=a\b' --set source=x sphere -o keys
    rc-solve --quiet --load 1mN:2mN:2 --estar 1GPa --hardness 5GPa sphere -o contact
    rc-solve --quiet --load 1mN --E1 1GPa --nu1 0.3 --E2 rigid --layer 1um,2GPa,0.3 sphere -o coated
    rc-stress --quiet --nu 0.3 --depths 1um,2um --components mises,sxz contact -o stress
    rc-stress --quiet --nu 0.3 --section y=0 --depths 0:2um:3 --components szz --type f32 contact -o section
    cat sphere profile >two
    { sed '/^RCGEND/d' sphere && echo "RCGFAIL a tool: it failed (exit status 2)"; } >failed
)
if [ -d "${RC_BIN:-}" ]; then stream_seeds || exit 1; fi

status=0
fuzz() { # FORMAT HARNESS
    local format=$1 harness=$2 run=$1-$2 program=$2 most=65536 bad log corpus
    local asan=allocator_may_return_null=1
    log=$build/logs/$run corpus=$build/corpus/$run
    mkdir -p "$corpus"
    local folders=("$corpus" "$seeds/$format")
    local -a bypass=()
    case $harness in
    zip) most=524288 ;;
    bypass)
        program=format bypass=(RC_FUZZ_BYPASS=library)
        asan=$asan:max_allocation_size_mb=128 # the same limit of memory as in the sandbox
        ;;
    sandbox) asan=$asan:detect_leaks=0 ;;
    whole) program=sandbox most=4194304 asan=$asan:detect_leaks=0 ;;
    gzip) program=format folders=("$corpus") bypass=(RC_GZIP=1) ;;
    stream) program=stream ;;
    hdf) folders=("$corpus") most=4096 bypass=(RC_FUZZ_BYPASS=1) ;;
    esac
    env "${bypass[@]}" RC_FORMAT="$format" ASAN_OPTIONS="$asan" "$build/fuzz-$program" \
        -max_total_time="$seconds" -runs="${RC_RUNS:--1}" -timeout=10 -max_len="$most" -rss_limit_mb=2048 \
        -malloc_limit_mb=2048 -print_final_stats=1 -entropic_scale_per_exec_time=1 \
        -artifact_prefix="$build/findings/$run-" "${folders[@]}" >"$log" 2>&1
    bad=$?
    echo "$format ($harness): $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") executions," \
        "$(sed -n 's/.*cov: \([0-9]*\).*/\1/p' "$log" | tail -n 1) edges," \
        "slowest $(sed -n 's/^stat::slowest_unit_time_sec: *//p' "$log") s," \
        "$(sed -n 's/^sandbox: \(.*\)/\1,/p' "$log")" \
        "$([ $bad -eq 0 ] && echo "no finding" ||
            echo "FINDING: $(grep -m 1 -E 'ERROR|runtime error|died in|held|it took|SUMMARY' "$log")")"
    [ $bad -eq 0 ] || status=1
}

for wanted; do
    case $wanted in
    *:*) fuzz "${wanted%%:*}" "${wanted##*:}" ;;
    *) for harness in $(harnesses_of "$wanted"); do fuzz "$wanted" "$harness"; done ;;
    esac
done
exit $status
