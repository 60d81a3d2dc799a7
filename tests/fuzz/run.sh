#!/bin/bash
# run.sh BUILD SECONDS [FORMAT...]: fuzzes each reader for so long, from the files of the tests and
# the real ones (RC_CORPUS, first 64 KiB of each); prints executions and findings, which are kept in
# BUILD/findings. Limits: 64 MiB and 16 times the size of a file in one piece of memory, and ten
# seconds for it by the clock, because the machine may be busy; the slowest is named.
set -u
build=$1 seconds=$2
shift 2
here=$(cd "$(dirname "$0")/../.." && pwd)
seeds=$build/seeds
mkdir -p "$seeds" "$build/findings" "$build/logs"
"$build/fuzz-seeds" "$seeds" || exit 1
if [ $# -eq 0 ]; then
    set -- $(sed -n 's/^RC_FORMAT(\(.*\))$/\1/p' "$here/formats/formats.list")
fi

# what the manifest calls the formats that have another name here
name_here() {
    case $1 in
    ascii-matrix | spip-asc) echo ascii ;;
    sdf-ascii) echo sdf ;;
    digitalsurf-*) echo sur ;;
    wyko-opd) echo opd ;;
    metropro-dat) echo metropro ;;
    alicona-al3d) echo al3d ;;
    sensofar-plu) echo plu ;;
    nanosurf-nid) echo nid ;;
    igor-ibw) echo ibw ;;
    mi-picoview) echo mi ;;
    wsxm-*) echo wsxm ;;
    bcrf) echo bcr ;;
    truemap-tmd) echo tmd ;;
    surfer-grd) echo grd ;;
    esri-asc) echo esri ;;
    profile-text) echo profile ;;
    *) echo "$1" ;;
    esac
}
if [ -r "${RC_CORPUS:-}/manifest.tsv" ]; then
    tail -n +2 "$RC_CORPUS/manifest.tsv" | cut -f 1,2 | while IFS=$'\t' read -r file format; do
        folder=$seeds/$(name_here "$format")
        mkdir -p "$folder"
        head -c 65536 "$RC_CORPUS/corpus/$file" >"$folder/${file##*/}"
    done
fi

status=0
for format; do
    log=$build/logs/$format
    mkdir -p "$seeds/$format"
    RC_FORMAT=$format "$build/fuzz-format" -max_total_time="$seconds" -timeout=10 -max_len=65536 \
        -rss_limit_mb=2048 -malloc_limit_mb=66 -print_final_stats=1 \
        -artifact_prefix="$build/findings/$format-" "$seeds/$format" >"$log" 2>&1
    bad=$?
    echo "$format: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") executions," \
        "$(sed -n 's/.*cov: \([0-9]*\).*/\1/p' "$log" | tail -n 1) edges," \
        "slowest $(sed -n 's/^stat::slowest_unit_time_sec: *//p' "$log") s," \
        "$([ $bad -eq 0 ] && echo "no finding" ||
            echo "FINDING: $(grep -m 1 -E 'ERROR|runtime error|SUMMARY' "$log")")"
    [ $bad -eq 0 ] || status=1
done
exit $status
