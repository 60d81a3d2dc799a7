# SPDX-License-Identifier: GPL-3.0-or-later
# rc-render on the pressure of a body that yields in its volume with little hardening. It draws means about
# the nodes, in which the alternation from node to node cancels, and prints both largest values.
. "$(dirname "$0")/../pipe.sh"

# stream KEYS 'perl expression of $i, $j': writes a pressure of 24 x 20 nodes.
stream() {
    perl -MCompress::Raw::Zlib -e '
        binmode STDOUT;
        my ($keys, $value) = @ARGV;
        my $f = "RCG1\nchannel=pressure\nnx=24\nny=20\ndx=1e-06\ndy=1e-06\nunit=Pa\ntype=f64\n" . join("", map { "$_\n" } split / /, $keys) . "\n";
        my $get = eval "sub { my (\$i, \$j) = \@_; $value }";
        for my $j (0 .. 19) { $f .= pack "d<", $get->($_, $j) for 0 .. 23 }
        print $f, sprintf("crc32 %08x\n", Compress::Raw::Zlib::crc32($f)), "RCGEND 1\n";' -- "$1" "$2"
}
# drawn FILE: prints the drawing without the text.
drawn() { grep -v '<text\|<metadata\|<desc\|<title\|<dc:\|<!--' "$1" | tr -d '\n' | grep -o '<image.*</svg>' | sha256sum; }
# words FILE: prints the line under the title
words() { sed -n 's/<[^>]*>//g; /max/p' "$1" | head -n 1; }
export -f drawn words

soft="boundary=free yield=1e9 hardening=9.99e9"
hard="boundary=free yield=1e9 hardening=1e10"
ramp='1e9 + 2**24 * (3 * $i + 5 * $j)'
# waves of two nodes, (-1)^i g(j) + (-1)^j g(i), with linear g, for which the means are 0
noise='2**20 * ((-1)**$i * (7 + $j) + (-1)**$j * (11 - $i))'
stream "$hard" "$ramp" >ramp.rcg
stream "$soft" "$ramp + $noise" >soft.rcg
stream "$hard" "$ramp + $noise" >hard.rcg
stream "boundary=free" "$ramp + $noise" >elastic.rcg
for f in ramp soft hard elastic; do
    rc-render --window -8um:8um,-6um:6um --range 1GPa:4GPa --width 600 -o $f.svg $f.rcg
done
claim "waves of two nodes are not drawn" test "$(drawn soft.svg)" = "$(drawn ramp.svg)"
claim "  with a hardening of ten times the yield stress they are drawn" test "$(drawn hard.svg)" != "$(drawn ramp.svg)"
claim "  on an elastic body they are drawn" test "$(drawn hard.svg)" = "$(drawn elastic.svg)"
one=$(awk 'BEGIN { for (i = 0; i < 24; i++) for (j = 0; j < 20; j++) { p = 1e9 + 2^24 * (3 * i + 5 * j) + 2^20 * ((-1)^i * (7 + j) + (-1)^j * (11 - i)); if (p > m) m = p } printf "%.4g", m / 1e9 }')
rc-render --range 1GPa:4GPa --width 600 -o whole.svg soft.rcg
# at an edge the last nodes are repeated beyond it, and means keep the waves along it
says_both() { words "$1" | grep -q "max $2 GPa in means of 2 .* 2 nodes, $3 GPa at one node" || { words "$1" >&2; return 1; }; }
claim "both largest values are printed" says_both whole.svg "[34].[0-9]*" "$one"
claim "for other bodies one is printed" bash -c 'words hard.svg | grep -q "max [0-9.]* GPa$"'
stream "boundary=periodic yield=1e9 hardening=0" '2e9 + 1e8 * (-1)**$i + 5e7 * (-1)**$j' >round.rcg
stream "boundary=periodic" '2e9' >flat.rcg
for f in round flat; do rc-render --range 1GPa:4GPa --width 600 -o $f.svg $f.rcg; done
claim "on a periodic map means continue across the edges" test "$(drawn round.svg)" = "$(drawn flat.svg)"
claim "  a note says so" says_both round.svg 2 2.15
# nodes outside of the contact stay outside, nodes in contact stay in contact
island='$i > 5 && $i < 15 && $j > 5 && $j < 15'
stream "boundary=periodic yield=1e9 hardening=0" "$island ? 2e9 : 0" >island.rcg
stream "boundary=periodic" "$island ? 2e9 : 0" >bare.rcg
for f in island bare; do rc-render --quiet --window all --contour --range 1MPa:100GPa --width 600 -o $f.svg $f.rcg; done
edge() { grep -o '<path d="[^"]*"' "$1" | sort | sha256sum; }
export -f edge
claim "the border of the contact is that of single nodes" bash -c '
    [ "$(edge island.svg)" = "$(edge bare.svg)" ] && [ "$(edge island.svg)" != "$(edge flat.svg)" ] '
claim "a sheet has means too" bash -c '
    cat round.rcg soft.rcg >two.rcg && rc-render --sheet 2x1 --width 900 -o sheet.svg two.rcg && words sheet.svg | grep -q "GPa in means of 2 .* 2 nodes, .* GPa at one node"'
claim "a raw picture has the values of single nodes" bash -c '
    rc-render --raw --range 1GPa:4GPa -o a.png hard.rcg && rc-render --raw --range 1GPa:4GPa -o b.png soft.rcg &&
    perl -0777 -ne "print unpack(q(H*), \$1) while /IDAT(.*?)....IEND/gs" a.png >a.hex &&
    perl -0777 -ne "print unpack(q(H*), \$1) while /IDAT(.*?)....IEND/gs" b.png >b.hex && [ -s a.hex ] && cmp a.hex b.hex'

# ---- from rc-solve ----

rc-synth sphere --nx 48 --dx 1um --radius 60um -o ball.rcg
solve="rc-solve --quiet --periodic --E1 100GPa --nu1 0.3 --E2 rigid --load 0.4N --increments 6 --output pressure"
$solve --yield 0.7GPa --report soft.json -o p.rcg ball.rcg
rc-render -o p.svg p.rcg
shown() { awk -v p="$1" 'BEGIN { printf "%.4g", p / 1e9 }'; }
claim "streams of rc-solve have the needed keys" says_both p.svg "$(shown "$(field max_pressure_mean4 soft.json)")" "$(shown "$(field max_pressure soft.json)")"
between 0.01 "$(awk -v a="$(field max_pressure soft.json)" -v b="$(field max_pressure_mean4 soft.json)" 'BEGIN { print a / b - 1 }')" 0.3 \
    "  there is something to take the mean of"
$solve --yield 0.7GPa,7GPa --report hard.json -o p.rcg ball.rcg
rc-render -o p.svg p.rcg
claim "  the hardening too" bash -c 'words p.svg | grep -q "max [0-9.]* GPa$"'
printf '0 0.7GPa\n0.01 0.7GPa\n1 70GPa\n' >table.tsv
$solve --yield table.tsv -o p.rcg ball.rcg
claim "  for a table its first slope" bash -c '[ "$(LC_ALL=C sed -n "s/^hardening=//p; /^$/q" p.rcg)" = 0 ] && [ "$(LC_ALL=C sed -n "s/^yield=//p; /^$/q" p.rcg)" = 700000000 ]'
$solve --yield 70GPa -o p.rcg ball.rcg
claim "  without yield there are no such keys" bash -c '! LC_ALL=C sed "/^$/q" p.rcg | grep -q "^yield="'

# ---- warnings go by the means ----

# few nodes in contact: the largest single node exceeds a tenth of E* = 109.9 GPa, but no mean does
beyond() {
    local load
    rc-synth sphere --nx 33 --dx 1um --radius 15um -o small.rcg
    for load in 0.1 0.12 0.14 0.16 0.18 0.2 0.22; do
        rc-solve --periodic --E1 100GPa --nu1 0.3 --E2 rigid --load ${load}N --increments 6 --output pressure --yield 6GPa \
            --report beyond.json -o p.rcg small.rcg 2>beyond.err || return 1
        echo "$(field max_pressure beyond.json) $(field max_pressure_mean4 beyond.json) $(grep -c 'largest pressure.* of E\*.*give a smaller load' beyond.err)"
    done >beyond.txt
    cat beyond.txt >&2
    awk -v tenth="$(awk 'BEGIN { print 0.1 * 100e9 / 0.91 }')" '
        { if (($2 > tenth) != ($3 > 0)) bad = 1; if ($1 > tenth && $2 < tenth) between++; if ($2 > tenth) above++ }
        END { exit bad || !between || !above }' beyond.txt
}
claim "a mean pressure above a tenth of E* causes a warning" beyond
