# Words of a file in messages do not act on a terminal: no control character comes through, of whatever tool.
. "$(dirname "$0")/../pipe.sh"

# harmless "sentence" 'shell command': what it says holds something, and no control character but line feeds.
harmless() {
    claims=$((claims + 1))
    bash -c "$2" >words.out 2>words.err </dev/null
    if [ -s words.err ] && [ "$(LC_ALL=C tr -d '\n' <words.err | LC_ALL=C tr -dc '\000-\037\177' | wc -c)" = 0 ] &&
        ! LC_ALL=C grep -q "$(printf '\302[\200-\237]')" words.err; then
        echo "ok: $1: $(head -n 1 words.err | cut -c1-100)"
    else
        echo "NOT OK: $1"
        cat -v words.err
        failures=$((failures + 1))
    fi
}

rc-synth sphere --nx 5 --dx 1um --radius 1mm -o plain.rcg
escape=$(printf '\033]0;title\007\033[31m\302\233')
sed -e "s/^channel=.*/channel=he$escape/" plain.rcg | reseal >channel.rcg
sed -e "s/^unit=.*/unit=m\nsource=x$escape\\\\ny/" plain.rcg | reseal >source.rcg
sed -e "s/^nx=.*/nx=$escape/" plain.rcg >size.rcg
sed -e "s/^nx=.*/n$escape/" plain.rcg >line.rcg
{ sed -e /^RCGEND/d plain.rcg && echo "middle $escape"; } >middle.rcg
{ sed -e /^RCGEND/d plain.rcg && echo "RCGFAIL a tool: $escape"; } >failed.rcg
for tool in "rc-info" "rc-pick --channel pressure" "rc-detrend --plane" "rc-solve --estar 1GPa --load 1N" "rc-stress --nu 0.3 --depths 1um" \
    "rc-deflect --estar 1GPa" "rc-export --format npy --channel pressure" "rc-render --channel pressure -o x.png"; do
    for file in size line middle failed; do harmless "$tool $file" "$tool $file.rcg | cat"; done
    [ "$tool" = rc-info ] || [ "${tool%% *}" = rc-detrend ] || harmless "$tool channel" "$tool channel.rcg | cat"
done
printf 'x' >"bad$escape.x3p"
harmless "rc-import" "rc-import bad*.x3p | cat"
harmless "rc-import --list, which goes on" "rc-import --list --quiet bad*.x3p"
harmless "the source" "rc-solve --estar 1GPa --load 1N source.rcg -o x.rcg"
claim "the source is shown without them too" bash -c 'rc-info source.rcg | LC_ALL=C tr -d "\n" | LC_ALL=C tr -dc "\000-\037\177" | wc -c | grep -qx 0'

finish
