# SPDX-License-Identifier: GPL-3.0-or-later
# The filter in rcg(5) compiles as printed and follows the rules for pipes: the tools read its output, and it
# refuses a damaged stream.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/manual.sh"

claim "the page has a program" program "$pages/rcg.5" rcg-scale.c
claim "it compiles" ${CC:-cc} -std=c99 -O2 -Wall -Wextra -o rcg-scale rcg-scale.c
PATH="$scratch:$PATH"

figure() { rc-info --json "$2" | head -n 1 | grep -o "\"$1\": [^,]*" | cut -d' ' -f2; }
# A stream without the parts that the filter changes even with the factor 1.
bare() { LC_ALL=C sed -e '/^history=/d' -e 's/crc32 [0-9a-f]\{8\}$//' "$1"; }

rc-synth selfaffine --nx 33 --ny 47 --dx 1.1um --dy 1.29um --hurst 0.7 --rms-height 0.4um \
    --seed 5 -o rough.rcg
for type in f64 f32; do
    claim "heights are doubled, $type" bash -c "
        rc-synth sphere --nx 33 --ny 47 --dx 1.1um --radius 2.385mm --type $type -o ball.rcg &&
        rcg-scale 2 <ball.rcg >twice.rcg"
    # twice a binary number is exact
    for name in minimum maximum mean rms; do
        near "$(figure $name twice.rcg)" "$(awk -v a="$(figure $name ball.rcg)" 'BEGIN { printf "%.17g", 2 * a }')" \
            "$same" "$name is doubled, $type"
    done
    claim "the type stays $type" says "^type=$type$" head -n 8 twice.rcg
done
claim "the history has one more step" says '^ *rcg-scale 2$' rc-info twice.rcg
claim "a factor of 1 keeps every value and key" bash -c "
    $(declare -f bare)
    rcg-scale 1 <rough.rcg >same.rcg && cmp <(bare rough.rcg) <(bare same.rcg)"
rc-solve --quiet --load 1N --estar 100GPa --output pressure,gap rough.rcg -o contact.rcg
claim "other channels are passed on unchanged" bash -c "
    $(declare -f bare)
    rcg-scale 3 <contact.rcg >passed.rcg && cmp <(bare contact.rcg) <(bare passed.rcg) &&
    lacks 'rcg-scale' passed.rcg"
printf '5 6 7\n6 NaN 8\n7 8 9\n' >hole.txt
claim "missing points are passed on" bash -c 'rc-import --dx 1.1um --z-unit nm hole.txt | rcg-scale 2 >hole.rcg'
near "$(figure missing hole.rcg)" 1 "$same" "  and stay missing"
near "$(figure mean hole.rcg)" 14e-9 "$of_sum" "  beside those that are doubled"

refuses 1 'rcg-scale: a checksum is wrong' "a damaged value is refused" '
    cp rough.rcg bad.rcg
    printf "\125" | dd of=bad.rcg bs=1 seek=2000 conv=notrunc status=none
    rcg-scale 2 <bad.rcg | cat >/dev/null'
refuses 1 'rcg-scale: the stream is cut off' "a stream that was cut off is refused" \
    'head -c 3000 rough.rcg | rcg-scale 2 | cat >/dev/null'
refuses 1 'rc-info: .*the program that wrote it failed: rcg-scale: disk on fire' "the message of a producer that failed goes on through the filter" '
    set +o pipefail # the status is that of rc-info
    { sed "/^RCGEND/d" rough.rcg; echo "RCGFAIL disk on fire"; } | rcg-scale 2 | rc-info --verbose'
refuses 1 'rc-info: .*more than one stream' "what the filter refuses, its reader refuses" \
    'set +o pipefail; cat rough.rcg rough.rcg | rcg-scale 2 | rc-info --verbose'
