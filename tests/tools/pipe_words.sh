# SPDX-License-Identifier: GPL-3.0-or-later
# Texts and names in a file do not act on a terminal: no tool prints a control character, neither in messages
# nor in its output.
. "$(dirname "$0")/../pipe.sh"

# plain_words FILE: the file is not empty and has no control characters except line feeds.
plain_words() {
    [ -s "$1" ] && [ "$(LC_ALL=C tr -d '\n' <"$1" | LC_ALL=C tr -dc '\000-\037\177' | wc -c)" = 0 ] &&
        ! LC_ALL=C grep -q "$(printf '\302[\200-\237]')" "$1" && return
    cat -v "$1" >&2
    return 1
}
# harmless "sentence" 'shell command': its messages have no control characters; shown ...: the same for its
# standard output, and it succeeds.
harmless() {
    bash -c "$2" >words.out 2>words.err </dev/null
    claim "$1: $(head -n 1 words.err | cut -c1-100 | cat -v)" plain_words words.err
}
shown() {
    claim "$1" bash -c "{ $2; } >shown.out </dev/null"
    claim "  the output has no control characters" plain_words shown.out
}
claim "the check finds an escape character" eval '! { printf "a\033" >bad.out && plain_words bad.out; }'
claim "the check finds a control character of two bytes" eval '! { printf "a\302\233" >bad.out && plain_words bad.out; }'

rc-synth sphere --nx 5 --dx 1um --radius 1mm -o plain.rcg
escape=$(printf '\033]0;title\007\033[31m\302\233')
sed -e "s/^channel=.*/channel=he$escape/" plain.rcg | reseal >channel.rcg
sed -e "/^source=/d" -e "s/^unit=.*/unit=m\nsource=x$escape\\\\ny/" plain.rcg | reseal >source.rcg
sed -e "s/^nx=.*/nx=$escape/" plain.rcg >size.rcg
sed -e "s/^nx=.*/n$escape/" plain.rcg >line.rcg
{ sed -e /^RCGEND/d plain.rcg && echo "middle $escape"; } >middle.rcg
{ sed -e /^RCGEND/d plain.rcg && echo "RCGFAIL a tool: $escape"; } >failed.rcg
for tool in "rc-info" "rc-pick --channel pressure" "rc-detrend --plane" "rc-solve --estar 1GPa --load 1N" "rc-stress --nu 0.3 --depths 1um" \
    "rc-deflect --estar 1GPa" "rc-slip --mu 0.3 --nu 0.3 --tangential 1mN" rc-leak "rc-export --format npy --channel pressure" "rc-render --channel pressure -o x.png"; do
    for file in size line middle failed; do harmless "$tool $file" "$tool $file.rcg | cat"; done
    [ "$tool" = rc-info ] || [ "${tool%% *}" = rc-detrend ] || harmless "$tool channel" "$tool channel.rcg | cat"
done
printf 'x' >"bad$escape.x3p"
harmless "rc-import" "rc-import bad*.x3p | cat"
harmless "rc-import --list, which goes on" "rc-import --list --quiet bad*.x3p"
harmless "the source" "rc-solve --estar 1GPa --load 1N source.rcg -o x.rcg"

# ---- output ----

printf '# Channel: To%spo\n# Width: 6 um\n# Height: 5 um\n# Value units: nm\n1 2 3\n4 5 6\n' "$escape" >"map$escape.txt"
shown "rc-import --list" "rc-import --list map*.txt"
claim "    the names of file and channel are in the message" grep -q 'map.*title.*txt: ascii' shown.out
claim "    they are in its line" grep -qE '^[*] +1 +3 +2 .*To.*title.*po$' shown.out
contact="--estar 1GPa --load 1mN"
shown "rc-info" "rc-info source.rcg"
shown "rc-info --json" "rc-info --json source.rcg"
claim "    the file has this name" perl -MJSON::PP -0777 -e '
    my ($wanted, $json) = map { open my $f, "<", $_; <$f> } @ARGV;
    my $got = decode_json($json)->{keys}{source}; utf8::encode($got);
    exit($wanted ne $got)' <(printf 'x%s\ny' "$escape") shown.out
shown "rc-solve --dry-run" "rc-solve $contact --dry-run source.rcg"
shown "a report's table" "rc-solve $contact --report words.tsv source.rcg -o x.rcg && tr '\t' ' ' <words.tsv"
shown "rc-cost" "rc-cost --quiet --limit 5 source.rcg -- rc-solve $contact"
