# SPDX-License-Identifier: GPL-3.0-or-later
# Keys with a fixed meaning: no tool that reads a stream takes a value that the key does not have (tests/formats/law_keys.c has these
# values), and rc-pick corrects it.
. "$(dirname "$0")/../pipe.sh"

table() { sed -n 's/^    {"\([a-z0-9._-]*\)", \([A-Z]*\).*/\1 \2/p' "$RC_SOURCE/formats/rcg/keys.c"; }
table >table.txt
claim "the table has keys of all kinds" bash -c 'for kind in TEXT WORDS NUMBER FROM ABOVE RATIO COUNT LIST; do grep -q " $kind$" table.txt || exit 1; done'

rc-synth selfaffine --nx 16 --ny 12 --dx 1um --hurst 0.8 --rms-height 20nm --seed 4 -o heights.rcg
rc-solve --quiet --mean-pressure 100MPa --E1 200GPa --nu1 0.3 --E2 rigid --periodic --output pressure,gap,height heights.rcg -o solved.rcg 2>/dev/null
rc-stress --quiet --depths 0,1um --components sxx,syy,szz,sxy,sxz,syz solved.rcg -o stress.rcg
rc-pick --channel pressure solved.rcg -o pressure.rcg

# with KEY VALUE FILE: the first frame of the stream with this key.
with() {
    perl -MCompress::Zlib -0777 -e '
        my ($key, $value, $file) = @ARGV;
        open my $in, "<:raw", $file; $_ = <$in>;
        /^(RCG1\n.*?\n\n)/s or die;
        my ($head, $rest) = ($1, $'"'"'); my ($nx, $ny) = ($head =~ /nx=(\d+)\nny=(\d+)/);
        my $size = $nx * $ny * ($head =~ /type=f32/ ? 4 : 8);
        $head =~ s/^\Q$key\E=.*\n//mg; $head =~ s/\n\n$/\n$key=$value\n\n/;
        my $body = $head . substr($rest, 0, $size);
        print $body, sprintf("crc32 %08x\n", crc32($body)), substr($rest, $size + 15)' "$@"
}
export -f with

# ---- every tool ----

refused() { # KEY VALUE COMMAND: it exits with 1 and names the key and the value
    "${@:3}" >refused.out 2>refused.err </dev/null
    [ $? = 1 ] && [ ! -s refused.out ] && grep -qF -- "$1=$2" refused.err
}
# Each tool, with the file that has the wrong key as bad.rcg. An entry: file to be changed, command.
tools() {
    cat <<'END'
heights.rcg rc-detrend --plane bad.rcg
heights.rcg rc-add bad.rcg heights.rcg
heights.rcg rc-add heights.rcg bad.rcg
heights.rcg rc-solve --load 1mN --estar 1GPa bad.rcg
heights.rcg rc-solve --load 1mN --estar 1GPa --travel 0,1um --counter bad.rcg heights.rcg
heights.rcg rc-synth sphere --radius 1mm --like bad.rcg
heights.rcg rc-cost bad.rcg -- rc-solve --load 1mN --estar 1GPa
heights.rcg rc-report --load 1mN --estar 1GPa bad.rcg
heights.rcg rc-scene --load 1mN --estar 1GPa bad.rcg
solved.rcg rc-slip --mu 0.3 --tangential 1uN bad.rcg
solved.rcg rc-stress --depths 0,1um bad.rcg
solved.rcg rc-fatigue --bending-limit 1GPa --torsion-limit 1GPa --depths 1um --pass x bad.rcg
stress.rcg rc-fatigue --bending-limit 1GPa --torsion-limit 1GPa --depths 1um --pass x --residual bad.rcg pressure.rcg
solved.rcg rc-leak bad.rcg
pressure.rcg rc-deflect bad.rcg
solved.rcg rc-wear --coefficient 1e-6mm3/Nm --distance 1m bad.rcg
heights.rcg rc-wear --coefficient 1e-6mm3/Nm --distance 1m --motion sliding --counter bad.rcg solved.rcg
pressure.rcg rc-heat --mu 0.3 --speed 1m/s --conductivity 40,40 --diffusivity 1e-5,1e-5 bad.rcg
heights.rcg rc-render -o x.png bad.rcg
heights.rcg rc-info --areal bad.rcg
heights.rcg rc-export --format csv bad.rcg
heights.rcg rc-pick --set note=1 bad.rcg
END
}
each_tool() {
    local file command key kind value
    while read -r file command; do
        [ -x "$RC_BIN/${command%% *}" ] || continue
        while read -r key kind; do
            case $key in periodic | boundary | load | depth) ;; *) before_release && [ "$kind" != TEXT ] || continue ;; esac
            value=abc
            with "$key" "$value" "$file" >bad.rcg
            # shellcheck disable=SC2086
            refused "$key" "$value" $command || { echo >&2 "$command, $key='$value': $(cat refused.err)" && return 1; }
        done <table.txt
    done < <(tools)
}
claim "all tools refuse them" each_tool
listed() { for tool in $(tool_sources); do tool=${tool##*/} && [ "$tool" = rc-import.c ] || tools | grep -q " ${tool%.c} " || return; done; }
claim "  each tool is in the list" listed
claim "rc-pick corrects a wrong value" bash -c 'with load abc heights.rcg >bad.rcg && rc-pick --set load=2 bad.rcg | rc-info >out.txt && grep -q "load=2$" out.txt &&
    with boundary perodic heights.rcg >bad.rcg && rc-pick --set boundary= bad.rcg | rc-info >out.txt && lacks perodic out.txt'
refuses 2 "set boundary=perodic: it must be free, periodic, periodic-x or periodic-y" "  and sets none" "rc-pick --set boundary=perodic heights.rcg"
