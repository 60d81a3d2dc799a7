# SPDX-License-Identifier: GPL-3.0-or-later
# The example of coated bodies, a hard film on steel under a rough ball, runs as printed in contact-layers(7)
# and rc-stress(1). It gives the figures in these pages.
. "$(dirname "$0")/../pipe.sh"

# block PAGE 'first words': prints the literal block that begins with these words, as a user types it
block() {
    awk -v first="$2" '
        /^\.Bd -literal/ { inside = 1; text = ""; next }
        inside && /^\.Ed/ { inside = 0; if (index(text, first) == 1) printf "%s", text; next }
        inside { gsub(/\\e/, "\\"); gsub(/\\-/, "-"); text = text $0 "\n" }' "$RC_SOURCE/man/$1"
}
figure() {
    grep -aqE -- "$1" "$RC_SOURCE/man/$2"
}

block contact-layers.7 'rc-synth selfaffine --nx 400' >case.sh
claim "contact-layers(7) has the example of a coated body" test "$(wc -l <case.sh)" = 12
claim "  it runs" bash -c 'bash -e case.sh >said.txt 2>told.txt'
read -r steel coated <<<"$(sed -n 's/.*largest pressure \([0-9.]*\) GPa.*/\1/p' told.txt | xargs)"
near "$steel" 4.13 "$three_digits" "  largest pressure on steel, GPa"
near "$coated" 4.73 "$three_digits" "  and on the film"
read -r steel coated <<<"$(sed -n 's/.*contact area \([0-9.]*\) mm2.*/\1/p' told.txt | xargs)"
near "$steel" 1536e-6 "$three_digits" "  contact area on steel, mm2"
near "$coated" 1427e-6 "$three_digits" "  and on the film"
read -r steel film below <<<"$(sed 's/.*\[//; s/,//g' said.txt | xargs)"
near "$steel" 1.86e9 "$three_digits" "  largest Mises stress in steel without the film, Pa"
near "$film" 2.23e9 "$three_digits" "  in the film"
near "$below" 1.66e9 "$three_digits" "  in the steel under it"
near "$(total pressure coated.rcg 1)" "$(sed -n 's/^load=//p' <(head -c 2000 coated.rcg | tr -d '\0'))" "$summed" "  the film carries the load"
rc-stress --depths 2um,2.000002um --components mises --report sides.json -o sides.rcg coated.rcg
near "$(grep -o '"by_depth": \[[^],]*' sides.json | head -n 1 | sed 's/.*\[//')" 2.19e9 "$three_digits" \
    "  on the lower side of the film"
for told in 1427 1536 4.73 4.13 1.86 1.66 2.23 2.19; do
    claim "  the page says $told" figure "(^|[^0-9.])$told([^0-9]|$)" contact-layers.7
done

block rc-stress.1 'rc-synth selfaffine --nx 400' >plane.sh
claim "rc-stress(1) has the example of a section" test "$(wc -l <plane.sh)" = 7
claim "  it draws a picture" bash -c \
    'bash -e plane.sh && says PNG head -c 4 mises.png && says PNG head -c 4 sxx.png'
rc-pick --channel mises plane.rcg | rc-info --json >mises.json
near "$(grep -o '"maximum": [^,]*' mises.json | sed 's/.* //')" 2.24e9 "$three_digits" \
    "  largest Mises stress"
rc-pick --channel sxx plane.rcg | rc-export --format xyz -o plane.xyz -
sxx() {
    awk -v z="$1" '($1 - 8.3e-6) ^ 2 < 1e-16 && ($2 - z) ^ 2 < 1e-16 { print $3 }' plane.xyz
}
near "$(sxx 0)" -4.22e9 "$three_digits" "  sxx at the surface"
near "$(sxx 2e-6)" -0.31e9 0.01 "  on the lower side of the film"
near "$(sxx 2.1e-6)" -0.83e9 0.01 "  and in the steel below"
