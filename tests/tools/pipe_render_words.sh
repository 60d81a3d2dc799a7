# SPDX-License-Identifier: GPL-3.0-or-later
# Text on a figure. Long titles break between words, and units have their usual notation. Characters that no
# font has give a warning for every kind of picture. The figure of an unconverged solution has a stamp beside
# the data, not over them.
. "$(dirname "$0")/../pipe.sh"

# ---- titles, units, letters without a glyph ----

rc-synth sphere --nx 9 --dx 1um --radius 1mm -o map.rcg
long='The contact of a rough sphere with a half-space under a load that grows from step to step until it yields'
claim "a long title is drawn" rc-render --width 85mm --title "$long" -o long.svg map.rcg
sed -n 's/.*font-weight="bold".*>\(.*\)<\/text>/\1/p' long.svg >lines.txt
claim "it has several lines" test "$(wc -l <lines.txt)" -ge 3
claim "  they contain all its words" test "$(paste -s -d ' ' lines.txt)" = "$long"
claim "a title that is too long for four lines is drawn" rc-render --width 85mm --title "$long, $long" -o cut.svg map.rcg
sed -n 's/.*font-weight="bold".*>\(.*\)<\/text>/\1/p' cut.svg >lines.txt
claim "  it is cut after a word" awk -v words=" $long, $long " '
    END { n = split($0, w, " "); last = w[n]; sub(/…$/, "", last)
          exit !(NR == 4 && $0 ~ /…$/ && index(words, " " last " ") > 0) }' lines.txt
claim "a long word is drawn" rc-render --width 85mm --title 'Kontaktmechanikgrenzflächenuntersuchung' -o word.svg map.rcg
claim "  it is set smaller and complete" says 'font-weight="bold".*>Kontaktmechanikgrenzflächenuntersuchung</text>' cat word.svg
claim "  other titles are larger" bash -c '
    size() { sed -n "s/.*font-size=\"\([0-9.]*\)\" font-weight=\"bold\".*/\1/p" $1 | head -n 1; }
    awk "BEGIN { exit !($(size word.svg) < 0.98 * $(size long.svg)) }"'
sed 's/^unit=m/unit=m4/; s/^channel=height/channel=psd/' map.rcg | reseal >power.rcg
claim "m4 is written with a raised power" bash -c 'rc-render -o power.svg power.rcg && says " m</tspan><tspan dy=\"-[0-9.]*\" font-size=\"[0-9.]*\">4</tspan>" cat power.svg'
printf 'load/N\tcontact_radius/m\tindentation/m\n1\t1e-3\t1e-6\n2\t2e-3\t2e-6\n' >radius.tsv
rc-render --width 200mm --curve load:contact_radius -o radius.svg radius.tsv
claim "a curve of rc-solve has its title in words" says '>Contact radius against load</text>' cat radius.svg
claim "  and its axis" says '>Contact radius \(mm\)</text>' cat radius.svg
private=$(printf '\364\217\277\275')
for ending in svg pdf; do
    claim "a character that no font has causes a message, $ending" warns "no font has the characters '$private'" \
        rc-render --title "No $private here" -o "no.$ending" map.rcg
done
claim "  it is drawn as a question mark" says '>No \? here</text>' cat no.svg

# ---- a solution that did not converge ----

rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-height 10nm --seed 2 |
    rc-solve --quiet --load 100mN --estar 100GPa --tol 1e-18 --output pressure -o short.rcg
sed 's/^converged=no/converged=yes/' short.rcg | reseal >whole.rcg

# draw OPTION... NAME: draws NAME.rcg, and checks the exit status for its solution.
draw() {
    local name=${!#}
    rc-render --quiet "${@:1:$#-1}" -o "$name.png" "$name.rcg"
    case $name:$? in short:3 | whole:0) ;; *) false ;; esac
}
# Unpacks both pictures into @short and @whole, rows of bytes.
rows='sub rows {
    open my $f, "<:raw", $_[0] or die; local $/; my $b = <$f>; my ($w, $h) = unpack "NN", substr $b, 16;
    my ($z, $at, @rows) = ("", 8);
    while ($at < length $b) { my ($n, $what) = unpack "Na4", substr $b, $at, 8;
        $z .= substr $b, $at + 8, $n if $what eq "IDAT"; $at += 12 + $n }
    my $raw = Compress::Zlib::uncompress($z); my @last = (0) x (3 * $w);
    for my $y (0 .. $h - 1) {
        my ($kind, @x) = unpack "C*", substr $raw, $y * (3 * $w + 1), 3 * $w + 1;
        for my $i (0 .. $#x) {
            my ($a, $up, $c) = ($i > 2 ? $x[$i - 3] : 0, $last[$i], $i > 2 ? $last[$i - 3] : 0);
            my $p = $a + $up - $c; my ($pa, $pb, $pc) = map { abs($p - $_) } $a, $up, $c;
            $x[$i] = ($x[$i] + (0, $a, $up, int(($a + $up) / 2),
                $pa <= $pb && $pa <= $pc ? $a : $pb <= $pc ? $up : $c)[$kind]) & 255 }
        @last = @x; push @rows, pack "C*", @x }
    return @rows }
sub red { my $n = 0; for my $row (@_) { $n++ while $row =~ /\G(?:...)*?\xb0\x1e\x1e/gs } return $n }
@short = rows("short.png"); @whole = rows("whole.png");'
pixels() {
    perl -MCompress::Zlib -e "$rows exit !($1)"
}

claim "figures of a converged and of another result are drawn" eval 'draw --width 400 short && draw --width 400 whole'
claim "the stamp is drawn" pixels 'red(@short) > 100'
claim "  the converged one has no stamp" pixels 'red(@whole) == 0'
# the plot begins at row 80, without a stamp before row 60
claim "  no part of the stamp is on the plot" pixels 'red(@short[80 .. $#short]) == 0'
claim "the data of both figures are equal, pixel for pixel" pixels \
    'index(join("", @short), join("", @whole[60 .. 300])) > 0 && @short > @whole'
claim "the text of the picture says so" bash -c 'tr "\0" = <short.png | says "tEXtWarning=not converged" cat'
claim "  the text of the converged one does not" lacks tEXtWarning whole.png
claim "raw pictures contain only nodes" eval 'draw --raw short && draw --raw whole'
claim "  both have the same pixels" pixels 'join("", @short) eq join("", @whole)'
claim "  their texts differ" bash -c 'tr "\0" = <short.png | says "tEXtWarning=not converged" cat'
rc-stress --quiet --nu 0.3 --depths 1um --components mises short.rcg -o stress.rcg
claim "stresses of the result end with 3" test $? = 3
mv stress.rcg short.rcg
claim "stresses of the result have the stamp too" eval 'draw --width 400 short && pixels "red(@short) > 100"'

# ---- a difference of two scans, and rolling ----

title_of() { rc-render -o title.svg "$@" && sed -n 's/.*<title>\(.*\)<\/title>.*/\1/p' title.svg; }
rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-height 0.5um --rolloff 30um --short-cut 4um --seed 1 -o before.rcg
rc-pick --mirror x before.rcg -o after.rcg
rc-add --quiet after.rcg before.rcg -o sum.rcg
rc-add --quiet --subtract after.rcg before.rcg -o change.rcg
rc-detrend --plane change.rcg -o level.rcg
rc-add --quiet --subtract --align before.rcg before.rcg -o aligned.rcg
rc-add --quiet before.rcg change.rcg -o onto.rcg
for name in change level aligned; do
    claim "a difference of two scans is a change of height: $name" test "$(title_of $name.rcg)" = "Change of height"
done
claim "  the bar of colours says so" says '>Change of height' cat title.svg
for name in before sum onto; do
    claim "  other heights are heights: $name" test "$(title_of $name.rcg)" = Height
done
rc-synth sphere --nx 32 --dx 5um --radius 5mm | rc-solve --quiet --load 1N --estar 100GPa --output pressure |
    rc-slip --quiet --mu 0.3 --nu 0.3 --creep 0.1%:0.2%:2,0 --steady -o roll.rcg
claim "the line under a traction of rolling has the creepage" bash -c \
    'rc-render --channel traction-x --case 1 -o roll.svg roll.rcg && grep -q "creepage along x 0.1 %" roll.svg && ! grep -q "creepage along y" roll.svg && ! grep -q "spin " roll.svg'
claim "  two maps have the creepage of each" bash -c \
    'rc-render --channel traction-x --case 1,2 -o roll.svg roll.rcg && grep -q "creepage along x 0.1 %" roll.svg && grep -q "creepage along x 0.2 %" roll.svg'
