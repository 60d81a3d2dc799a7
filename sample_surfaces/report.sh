#!/usr/bin/env bash
# Writes one page about a measured surface, as an example of the tools: parameters, maps, a load curve,
# stresses, their errors, and the command lines that repeat them.
#
#     sample_surfaces/report.sh [OPTION VALUE]... FILE [PAGE.html]
#
#     --estar E (114GPa)  --hardness H (6GPa)  --nu NU (0.28)
#     --mean-pressure LIST (2MPa:64MPa:log:6), or --load LIST
#     --outliers T: removes points further than T deviations from their neighbours (default: keeps all)
#     --mirror: makes the surface periodic by mirror images, and solves it so
#
# ESTAR, HARDNESS, NU and PRESSURES in the environment are other defaults. The tools on PATH are used, or those of build/.
# The page holds its pictures; nothing else is left behind.
set -euo pipefail
fail() {
    echo "report.sh: $*: see report.sh --help" >&2
    exit 2
}
estar=${ESTAR-114GPa} hardness=${HARDNESS-6GPa} nu=${NU-0.28} load="--mean-pressure ${PRESSURES-2MPa:64MPa:log:6}"
outliers= mirror= periodic=
while [[ ${1-} == -* ]]; do
    option=$1
    shift
    case $option in
    -h | --help)
        sed -n '2,14s/^# \{0,1\}//p' "$0"
        exit 0
        ;;
    --mirror)
        mirror=" --mirror" periodic=" --periodic"
        continue
        ;;
    esac
    [ $# -gt 0 ] || fail "option $option is unknown or needs a value"
    value=$(printf '%q' "$1")
    shift
    case $option in
    --estar) estar=$value ;;
    --hardness) hardness=$value ;;
    --nu) nu=$value ;;
    --outliers) outliers=" --outliers $value" ;;
    --load | --mean-pressure) load="$option $value" ;;
    *) fail "unknown option $option" ;;
    esac
done
[ $# -eq 1 ] || [ $# -eq 2 ] || fail "one file, and at most a name for the page"
file=$(realpath "$1")
page=$(realpath -m "${2-$(basename "$file").html}")
command -v rc-import >/dev/null || PATH="$(dirname "$(realpath "$0")")/../build/tools:$PATH"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
printf 'set -o pipefail\n' >commands.sh

escape() { sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g'; }
# Runs a command line as the page prints it, and keeps its warnings.
run() {
    echo "$1" >>commands.sh
    bash -e -o pipefail -c "$1" 2>>said.txt
}
picture() {
    printf '<figure><img src="data:image/png;base64,%s" alt="%s"><figcaption>%s</figcaption></figure>\n' \
        "$(base64 -w 0 "$1")" "$2" "$2"
}
# These columns of a table of --report, to four digits.
table() {
    awk -F '\t' -v wanted="$2" '
        BEGIN { n = split(wanted, want, " ") }
        NR == 1 { for (c = 1; c <= NF; c++) { name = $c; sub(/\/.*/, "", name); at[name] = c } }
        { printf "<tr>"; for (k = 1; k <= n; k++) { v = $at[want[k]]; if (v + 0 == v && v != "") v = sprintf("%.4g", v)
              gsub(/_/, " ", v); printf NR == 1 ? "<th>%s</th>" : "<td>%s</td>", v } print "</tr>" }' "$1"
}

run "rc-import $(printf '%q' "$file") | rc-detrend --poly 2$outliers --fill$mirror -o surface.rcg"
run "rc-render --quiet --hillshade --width 800 -o heights.png surface.rcg"
run "rc-render --quiet --material-ratio --width 800 -o ratio.png surface.rcg"
run "rc-info --areal --psd surface.rcg >parameters.txt"
run "rc-info --profile rows surface.rcg >profiles.txt"
run "rc-solve$periodic $load --estar $estar --hardness $hardness --output pressure --report loads.tsv -o contact.rcg surface.rcg"
run "rc-render --quiet --curve mean_pressure:contact_fraction --log xy --y-unit % --width 800 -o curve.png loads.tsv"
last=$(($(wc -l <loads.tsv) - 1))
run "rc-render --quiet --case $last --width 800 -o pressure.png contact.rcg"
run "rc-info --patches contact.rcg | grep -E '^  (load|contact|pressure|approach|hardness|converged|patches|corrected|perimeter|largest)' | tail -n 11 >contact.txt"
run "rc-pick --case $last contact.rcg | rc-stress --nu $nu --section y=0 --depths auto --components mises -o section.rcg"
run "rc-render --quiet --log --width 800 -o section.png section.rcg"
{
    printf '<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><title>%s</title>\n' "$(basename "$file" | escape)"
    echo '<style>body{font:16px/1.5 sans-serif;max-width:52em;margin:2em auto;padding:0 1em;color:#222}img{max-width:100%}
figure{margin:1em 0}figcaption{color:#595959}pre{background:#f4f4f4;padding:.8em;overflow:auto}td,th{padding:.2em .8em;text-align:right}</style>'
    printf '<h1>%s</h1>\n<h2>The surface</h2>\n' "$(basename "$file" | escape)"
    picture heights.png "Heights, form of second degree taken off, missing points filled"
    picture ratio.png "The share of the surface at or above each height"
    printf '<pre>%s</pre>\n' "$(grep -E '^  (grid|size|missing|S|V|Hurst)' parameters.txt | escape)"
    printf '<h2>Its profiles</h2>\n<pre>%s</pre>\n' "$(grep -E '^  (profile|R)' profiles.txt | escape)"
    printf '<h2>Under load</h2>\n<p>E* %s, hardness %s, pressed against a flat.</p>\n' "$estar" "$hardness"
    picture curve.png "Real contact against the mean pressure"
    picture pressure.png "Contact pressure under the largest load"
    printf '<pre>%s</pre>\n' "$(escape <contact.txt)"
    picture section.png "Mises stress below the middle of the map"
    printf '<h2>How far to trust it</h2>\n<table>%s</table>\n' "$(table loads.tsv 'mean_pressure load contact_fraction max_pressure converged pressure_error_estimate edge_load_fraction nodes_per_patch')"
    printf '<p>What the tools warned of:</p>\n<pre>%s</pre>\n' "$([ -s said.txt ] && escape <said.txt || echo nothing)"
    printf '<h2>Once more</h2>\n<pre id="commands">%s</pre>\n<p>%s, %s</p></html>\n' "$(escape <commands.sh)" "$(rc-solve --version | head -n 1)" "$(date -I)"
} >page.html
mv page.html "$page"
echo "$page"
