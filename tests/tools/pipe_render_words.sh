# Words on a figure: long titles break between words, units are printed as people write them, and what no
# font has is told in every kind of picture.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 9 --dx 1um --radius 1mm -o map.rcg
long='The contact of a rough sphere with a half-space under a load that grows from step to step until it yields'
claim "a long title" rc-render --width 85mm --title "$long" -o long.svg map.rcg
sed -n 's/.*font-weight="bold".*>\(.*\)<\/text>/\1/p' long.svg >lines.txt
claim "has several lines" test "$(wc -l <lines.txt)" -ge 3
claim "  which are its words, all of them" test "$(paste -s -d ' ' lines.txt)" = "$long"
claim "one that is too long for four lines" rc-render --width 85mm --title "$long, $long" -o cut.svg map.rcg
sed -n 's/.*font-weight="bold".*>\(.*\)<\/text>/\1/p' cut.svg >lines.txt
claim "  is cut behind a word" awk -v words=" $long, $long " '
    END { n = split($0, w, " "); last = w[n]; sub(/…$/, "", last)
          exit !(NR == 4 && $0 ~ /…$/ && index(words, " " last " ") > 0) }' lines.txt
claim "a long word" rc-render --width 85mm --title 'Kontaktmechanikgrenzflächenuntersuchung' -o word.svg map.rcg
claim "  is set smaller, not cut" says 'font-weight="bold".*>Kontaktmechanikgrenzflächenuntersuchung</text>' cat word.svg
claim "  than others" bash -c '
    size() { sed -n "s/.*font-size=\"\([0-9.]*\)\" font-weight=\"bold\".*/\1/p" $1 | head -n 1; }
    awk "BEGIN { exit !($(size word.svg) < 0.98 * $(size long.svg)) }"'
sed 's/^unit=m/unit=m4/; s/^channel=height/channel=psd/' map.rcg | reseal >power.rcg
claim "m4 is a raised power" bash -c 'rc-render -o power.svg power.rcg && says " m</tspan><tspan dy=\"-[0-9.]*\" font-size=\"[0-9.]*\">4</tspan>" cat power.svg'
private=$(printf '\364\217\277\275')
for ending in svg pdf; do
    claim "a character that no font has is told, $ending" warns "no font has the characters '$private'" \
        rc-render --title "No $private here" -o "no.$ending" map.rcg
done
claim "  and is a question mark" says '>No \? here</text>' cat no.svg

finish
