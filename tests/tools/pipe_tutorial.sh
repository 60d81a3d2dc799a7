# SPDX-License-Identifier: GPL-3.0-or-later
# The pipeline of README runs, and commands have the same meaning in bash and in zsh. Before a release the
# tutorial of contact(7) runs as printed. Its commands print the text on the page. The figures in its
# sentences are in that text or are computed here. Its commands draw its pictures.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/manual.sh"
page=$pages/contact.7
samples=$RC_SOURCE/sample_surfaces

# agrees PAGE OUTPUT: the words are the same, and every number agrees to one unit of the last digit on the
# page; "..." matches anything. In longer numbers the first six digits count. Solutions with the default
# tolerance agree on all machines to about 1e-7, because sums in another order round differently. The page has
# no numbers of nodes, steps and seconds.
cat >agrees.pl <<'END'
use List::Util 'min';
local $/;
my $digits = qr/[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?/;
sub words { open my $f, '<', $_[0] or die "$_[0]: $!\n"; my $text = <$f>; return split ' ', $text }
sub step { # one unit of the last digit, or of the sixth significant one; a count must be equal
    my ($whole, $decimals, $power) = $_[0] =~ /(\d+)(?:\.(\d+))?(?:[eE]([-+]?\d+))?$/;
    return 0 unless defined $decimals || defined $power;
    my $last = 10 ** (($power // 0) - length($decimals // ''));
    my $digits = length(($whole . ($decimals // '')) =~ s/^0+//r);
    return $last * 10 ** ($digits > 6 ? $digits - 6 : 0);
}
sub same {
    my ($x, $y) = @_;
    return 1 if $x eq $y;
    my @x = split /($digits)/, $x;
    my @y = split /($digits)/, $y;
    return 0 if @x != @y || @x < 2;
    for my $k (0 .. $#x) {
        next if $x[$k] eq $y[$k];
        return 0 if $k % 2 == 0;
        return 0 if abs($x[$k] - $y[$k]) > 1.001 * step($x[$k]);
    }
    return 1;
}
my @said = words($ARGV[0]);
my @done = words($ARGV[1]);
my ($i, $j) = (0, 0);
my ($far_i, $far_j) = (-1, 0);
my ($back_i, $back_j) = (-1, -1);
while ($j < @done || $i < @said) {
    if ($i < @said && $said[$i] eq '...') { ($back_i, $back_j) = (++$i, $j); next }
    if ($i < @said && $j < @done && same($said[$i], $done[$j])) { $i++; $j++; next }
    last if $i == @said && $back_i == @said;
    ($far_i, $far_j) = ($i, $j) if $i > $far_i;
    if ($back_i < 0 || $back_j >= @done) {
        print STDERR "it prints '@done[$far_j .. min($far_j + 12, $#done)]', not '@said[$far_i .. min($far_i + 12, $#said)]'\n";
        exit 1;
    }
    ($i, $j) = ($back_i, ++$back_j);
}
END
agrees() { perl agrees.pl "$1" "$2"; }


# ---- the judges ----

printf 'x 12.5 mm2 (3 of 7), ... at 4e-06 um; ...\n' >said.txt
printf 'x 12.51 mm2 (3 of 7), here and there at 4.001e-06 um; 0.2 s\n' >done.txt
claim "the shown output agrees with the printed one, except for ..." agrees said.txt done.txt
differs() { # PATTERN "sentence" SUBSTITUTION
    sed "$3" done.txt >other.txt
    refuses 1 "$1" "$2" "perl agrees.pl said.txt other.txt"
}
differs "prints '12.7 mm2" "  another number does not" 's/12.51/12.7/'
differs "prints '\(4 of" "  nor another count" 's/(3/(4/'
differs "not 'at 4e-06" "  nor another word after what is left out" 's/at 4/of 4/'
differs "not 'at 4e-06" "  nor what ends too early" 's/ at.*//'

# strangers NUMBERS SENTENCES: prints the numbers of the sentences that are not among these, rounded, with
# another SI prefix or in per cent. It goes section by section, each after a line "@@ name".
cat >strangers.pl <<'END'
my $number = qr/(?<![\w.])\d+(?:\.\d+)?(?:[eE][-+]?\d+)?/;
sub sections { # the numbers by the name of the section
    my %all;
    open my $f, '<', $_[0] or die "$_[0]: $!\n";
    my $name = '';
    while (<$f>) { if (/^@@ (.*)/) { $name = $1 } else { push @{$all{$name}}, /$number/g } }
    return %all;
}
my %known = sections($ARGV[0]);
my %quoted = sections($ARGV[1]);
my @scales = (1, 100, map { (1000 ** $_, 1000 ** -$_) } 1 .. 4);
for my $section (sort keys %quoted) {
    for my $x (@{$quoted{$section}}) {
        my ($decimals, $power) = $x =~ /(?:\.(\d+))?(?:[eE]([-+]?\d+))?$/;
        my $half = 0.5001 * 10 ** (($power // 0) - length($decimals // ''));
        print "$x\n" unless grep { my $k = $_; grep { abs($k * $_ - $x) <= $half } @scales } @{$known{$section}};
    }
}
END
strangers() { perl strangers.pl "$1" "$2"; }
printf '@@ a\n12.51 um and 3e-6\n@@ b\n77\n' >known.txt
printf '@@ a\nfrom 12.5 um to 3 um, 1251 per cent, but not 12.6, nor 0.25, nor 77\n@@ b\n77, not 3\n' >quoted.txt
claim "a figure in a sentence agrees with the output in its section, rounded" \
    test "$(strangers known.txt quoted.txt | tr '\n' ' ')" = "12.6 0.25 77 3 "

blocks "$page" '' "$scratch/blocks"
mkdir run
cp "$samples"/*.x3p run

# ---- in bash and in zsh ----

# Commands typed as printed have the same meaning in both shells: scripts in place of the tools record their
# arguments. An interactive zsh has no comments, and does not split an unquoted $variable into words.
mkdir stand_ins
printf '#!/bin/sh\nline=$(printf " <%%s>" "$@")\necho "${0##*/}$line" >>"$SAID"\n' >stand_ins/mpirun
chmod +x stand_ins/mpirun
for main in "$RC_SOURCE"/tools/rc-*.c; do
    cp stand_ins/mpirun "stand_ins/$(basename "$main" .c)"
done
# called COMMANDS SHELL...: prints the calls that these commands make, and comments that the shell takes for
# commands. They are sorted, because the commands of a pipe have no order.
called() {
    rm -f said
    (mkdir -p typed && cd typed && PATH="$scratch/stand_ins:$PATH" SAID=$scratch/said timeout 60 "${@:2}" <"$1" >/dev/null 2>called.err)
    sort said
    grep -ao 'found: #' typed/called.err || true
}
same_calls() { called "$1" bash >bash.said && called "$1" zsh -f -i >zsh.said && test -s bash.said && diff bash.said zsh.said >&2; }
if command -v zsh >/dev/null; then
    printf 'two="--load 1N"\nrc-solve $two\n' >typed.1
    printf 'rc-solve --load 1N | # presses\n    rc-info\n' >typed.2
    claim "the check finds an unquoted variable of two words" bash -c "$(declare -f called same_calls); scratch=$scratch; ! same_calls $scratch/typed.1"
    claim "  the check finds a comment inside a pipe" bash -c "$(declare -f called same_calls); scratch=$scratch; ! same_calls $scratch/typed.2"
    displays=0
    for name in "$pages"/*.1 "$pages"/contact*.7 README; do
        rm -rf shell_blocks
        blocks "$name" '' shell_blocks 2>/dev/null || mkdir -p shell_blocks
        [ "$name" = README ] && sed -n '/^## The pipeline/,/^| tool/s/^    //p' "$RC_SOURCE/README.md" >shell_blocks/1
        for block in $(grep -lE '^ *(mpirun .*)?rc-[a-z]+ ' shell_blocks/* | grep -v prints); do
            displays=$((displays + 1))
            same_calls "$scratch/$block" 2>differ || claim "$(basename "$name"): '$(head -n 1 "$block")' in zsh as in bash" bash -c 'cat differ >&2; false'
        done
    done
    between 60 "$displays" 1000 "displays of the manual and of README call the same in zsh and in bash"
else
    untried "the commands in zsh, which is not here"
fi
claim "the tutorial takes the columns of a table by their names" bash -c "! sed -n '/^\.Bd/,/^\.Ed/p' '$page' | grep -E '[$][0-9]{2}'"
# Files that a display writes, with a fixed name.
written() {
    for block in blocks/*; do
        [[ $block == *prints* ]] || grep -oE '(^| )(-o|--report|--steps|--checkpoint|>) *[a-z][a-z0-9-]*\.[a-z0-9]+' "$block" | sed 's/.*[ >]//' | sort -u
    done
}
claim "no two displays of the tutorial write the same file" test -z "$(written | sort | uniq -d)"
claim "  files were compared" test "$(written | wc -l)" -gt 50
claim "README has no comments among its commands" bash -c "! sed -n 's/^    //p' '$RC_SOURCE/README.md' | grep '#'"

# ---- the README's pipeline ----

sed -n '/^## The pipeline/,/^| tool/s/^    //p' "$RC_SOURCE/README.md" | grep -v '^|' >pipeline
claim "the README's pipeline runs" bash -c 'cd run && rm -f mises.png && bash -e -u -o pipefail ../pipeline && says PNG head -c 4 mises.png'
claim "  it equals that of the tutorial" bash -c \
    'for words in "$@"; do sed "s/ *#.*//" pipeline | tr -s "\\\\ \n" " " | grep -qF -- "$words" || { echo "$words" >&2; exit 1; }; done' - \
    "rc-detrend --poly 2 --spikes 5 --fill" "rc-solve --radius 3.75mm --load 60N --estar 114GPa --hardness 6GPa" "rc-stress --nu 0.28"
# The whole page takes minutes.
before_release || exit 0

# ---- the page runs ----

for block in $(cd blocks && ls | grep -v prints | sort -n); do
    claim "display $block runs: $(head -n 1 "blocks/$block")" bash -c \
        "cd run && bash -e -u -o pipefail ../blocks/$block </dev/null >../$block.out 2>&1 || { cat ../$block.out >&2; exit 1; }"
    if [ -e "blocks/$block.prints" ]; then
        claim "  it prints the shown output" agrees "blocks/$block.prints" "$block.out"
    else
        claim "  it prints nothing" test ! -s "$block.out"
    fi
done
claim "displays were run" test "$(ls blocks | grep -vc prints)" -gt 15
claim "  outputs were compared" test "$(ls blocks | grep -c prints)" -gt 10

# ---- its sentences ----

# The sections with commands, with displays and sentences separated, without macros, years and numbers of
# equations.
parted() {
    awk -v displays="$1" '
        /^\.Sh / { on = /A MEASURED SURFACE/ ? 1 : /FROM A SCAN|SEE ALSO/ ? 0 : on; if (on) print "@@ " $0 }
        /^\.Bd/ { inside = 1 }
        /^\.Ed/ { inside = 0 }
        on && inside == displays && !/^\./' "$page" |
        sed 's/\\-/-/g; s/ *([12][0-9][0-9][0-9])//g; s/ *(Johnson 1985[^)]*)//g'
}
parted 0 >sentences.txt
parted 1 >known.txt

# derived "sentence" PATTERN VALUE TOLERANCE: the number in the sentence, (N) in the pattern, is VALUE; for
# numbers that no command prints.
derived() {
    local pattern=${2/(N)/'([0-9.]*[0-9](?:e-[0-9]+)?)'}
    near "$(perl -0777 -ne "print \$1 if /$pattern/" sentences.txt)" "$3" "$4" "$1"
    perl -0777 -i -pe "s/$pattern//" sentences.txt
}
compute() { awk "BEGIN { pi = atan2(0, -1); print $1 }"; }
column() { awk -F '\t' -v name="$1" -v row="$3" 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == name) at = k } NR == row + 1 { print $at }' "$2"; }
cd run
rc-solve --radius 7.5mm --load 240N --estar 113.93GPa --hardness 6GPa --quiet --report rough.json -o /dev/null sphere.rcg
rc-solve --load 240N --estar 113.93GPa --quiet --report smooth.json -o /dev/null smooth.rcg
rc-solve --radius 3.75mm --load 60N --estar 114GPa --hardness 6GPa --quiet --report steel.json -o /dev/null flat.rcg
rc-stress --nu 0.3 --section y=0 --depths 80um:140um:121 --components mises --quiet --report below.json -o /dev/null smooth.rcg
mv rough.json smooth.json steel.json below.json sweep.tsv ..
cd ..
rough=$(field contact_area rough.json)
smooth=$(field contact_area smooth.json)
radius=$(compute "(0.75 * 240 * 7.5e-3 / 113.93e9) ^ (1 / 3)")
derived "the default tolerance" 'at most (N) by' "$(compute "$(field nx steel.json) ^ -0.75 * $(field ny steel.json) ^ -0.75")" 0.01
derived "the diameter of the ball" 'ball of (N) mm diameter' "$(compute '2 * 3.75')" 0
derived "the rough sphere touches on so much of Hertz's contact" 'same fraction, (N),' "$(compute "$rough / (pi * $radius ^ 2)")" 0.01
derived "the grid of the paper" 'grid of (N) x' "$(rc-info --json run/sphere.rcg | grep -o '"nx": [0-9]*' | grep -o '[0-9]*$')" 0
derived "  its rows" ' (N) nodes\.' "$(rc-info --json run/sphere.rcg | grep -o '"ny": [0-9]*' | grep -o '[0-9]*$')" 0
derived "Hertz: radius" 'radius a = (N) um' "$(compute "1e6 * $radius")" 5e-5
derived "Hertz: area" 'the area (N) mm\^2' "$(compute "1e6 * pi * $radius ^ 2")" 5e-5
derived "Hertz: pressure" 'the pressure (N) GPa in the middle' "$(compute "1.5e-9 * 240 / (pi * $radius ^ 2)")" 5e-5
derived "Hertz: approach" 'the approach (N) um' "$(compute "1e6 * $radius ^ 2 / 7.5e-3")" 5e-5
derived "the area that roughness takes" 'contact area by (N) %' "$(compute "100 * (1 - $rough / $smooth)")" 0.01
derived "how much closer the bodies come" 'approach by (N) um' \
    "$(compute "1e6 * ($(field approach rough.json) - $(field approach smooth.json))")" 0.01
derived "Hertz: how deep the stress is largest, in radii" 'lies at (N) a' "$(compute "$(field depth below.json) / $radius")" 0.01
derived "  in micrometres" ', (N) um deep\.' "$(compute "1e6 * $(field depth below.json)")" 0.01
derived "  where that of the tips has died away" 'the first (N) um' "$(grep -o '"by_depth": [^]]*' run/section.json | tr -d ' ' |
    tr '[,' '\n\n' | awk 'NR > 1 && NR < 50 && (least == 0 || $1 < least) { least = $1; at = 2 * (NR - 2) } END { print at }')" 0
between 0.51 "$(compute "$(field contact_area steel.json) / (pi * (0.75 * 60 * 3.75e-3 / 114e9) ^ (2 / 3))")" 0.55 \
    "the contact of README is little more than half of Hertz's"
first=$(column contact_area/m2 sweep.tsv 1)
last=$(column contact_area/m2 sweep.tsv 7)
derived "the power of the load" 'with the power (N) of' "$(compute "log($last / $first) / log(24)")" 0.006
derived "the share of Hertz's area at 10 N" "contact has (N) of" "$(compute "$first / (pi * $radius ^ 2 * (10 / 240) ^ (2 / 3))")" 0.015
derived "  at 240 N" 'at 240 N (N):' "$(compute "$last / (pi * $radius ^ 2)")" 0.01
derived "Persson's constant" 'sqrt\(8.pi\) = (N) by' "$(compute 'sqrt(8 / pi)')" 0.003
derived "that of Bush, Gibson and Thomas" 'sqrt\(2 pi\) = (N) by' "$(compute 'sqrt(2 * pi)')" 0.003
derived "what the film takes of the contact" 'the contact (N) % smaller' "$(compute '100 * (1 - 0.00142712 / 0.0015362)')" 0.02
derived "the slope that rc-solve warns of" 'exceeds about (N), the' "$(mandoc -Tutf8 "$pages/rc-solve.1" | col -b |
    tr -s '\n ' ' ' | grep -o 'RMS slope where the bodies touch is above [0-9.]*' | grep -o '[0-9.]*$')" 0
derived "the factor of safety" '1\/0\.78 = (N)\.' "$(compute '1 / 0.78')" 0.005
derived "Hertz's line contact" 'a\^2 = (N) P' 4 0
derived "the length of the raceway" 'along x, (N) mm, or' "$(compute '512 * 2e-3')" 0
# deepest TABLE FROM TO: the depth of the largest index between two depths, um
deepest() { awk -F '\t' -v from="$2" -v to="$3" 'NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k }
    NR > 1 { d = $at["depth/m"] * 1e6 } NR > 1 && d >= from && d <= to && $at["dangvan"] > most { most = $at["dangvan"]; where = d }
    END { print where }' "$1"; }
derived "the depth of the largest index under the raceway" 'maximum at (N) um depth' "$(deepest run/smooth-line-depth.tsv 20 300)" 0.02
derived "  and that of the grooves" 'a second one, (N) um deep' "$(deepest run/raceway-depth.tsv 0 20)" 0.2
derived "the instantaneous modulus, the sum of all" 'instantaneous modulus is (N) MPa' "$(sed -n 's/.*--relaxation \(1MPa,[^ ]*\).*/\1/p' "$page" | head -n 1 |
    tr ',' '\n' | awk -F 'MPa' '{ sum += $1 } END { print sum }')" 0
derived "between which loads the flow stops" 'known to about (N) %' "$(compute '100 * (1100 - 1000) / 1000')" 0.05
derived "the way of the wear that rc-cost studies" 'first (N) cm' "$(sed -n 's/.*--distance \([0-9]*\)cm$/\1/p' "$page" | tail -n 1)" 0
claim "figures in sentences agree with the output" test -z "$(strangers known.txt sentences.txt | tee strangers.txt)"
cat strangers.txt

# The work in contact-theory(7) for the same contact: on other machines steps may differ by one.
rc-solve --radius 7.5mm --load 240N --estar 113.93GPa --hardness 6GPa --tol 1e-4 --quiet --report work.json -o /dev/null run/sphere.rcg
quoted=$(sed -n 's/^it is \([0-9]*\) convolutions in \([0-9]*\) steps.*/\1 \2/p' "$pages/contact-theory.7")
near "$(field convolutions work.json)" "${quoted% *}" 0.25 "contact-theory(7): the convolutions of the rough sphere"
near "$(field iterations work.json)" "${quoted#* }" 0.25 "  and its steps"
rc-solve --radius 7.5mm --load 240N --estar 113.93GPa --hardness 6GPa --tol 1e-4 --method pk99 --quiet --report work.json \
    -o /dev/null run/sphere.rcg
quoted=$(sed -n 's/^takes \([0-9]*\) in \([0-9]*\)\.$/\1 \2/p' "$pages/contact-theory.7")
near "$(field convolutions work.json)" "${quoted% *}" 0.25 "  those of pk99"
near "$(field iterations work.json)" "${quoted#* }" 0.25 "  and its steps"
# The same contact on steel, with a film and without, as in contact-theory(7).
rc-import --quiet "$samples/rough-sphere.x3p" -o steel.rcg
of_steel() { # of_steel TOL [OPTION]...: prints the convolutions
    rc-solve --radius 7.5mm --load 240N --E1 208GPa --nu1 0.3 --E2 208GPa --nu2 0.3 --tol "$@" --quiet --report work.json \
        -o /dev/null steel.rcg && field convolutions work.json
}
film="--layer 20um,400GPa,0.2"
while read -r name film_4 steel_4 film_10 steel_10; do
    near "$(of_steel 1e-4 $film)" "$film_4" 0.25 "$name: the convolutions of a film to 1e-4"
    near "$(of_steel 1e-4)" "$steel_4" 0.25 "  those of steel"
    near "$(of_steel 1e-10 $film)" "$film_10" 0.25 "  of the film to 1e-10"
    near "$(of_steel 1e-10)" "$steel_10" 0.25 "  of steel"
done <<END
contact-theory(7) $(tr '\n' ' ' <"$pages/contact-theory.7" |
    sed -nE 's/.* takes ([0-9.]+) convolutions to 1e.-4, and ([0-9.]+) without the film\. To 1e.-10 it takes ([0-9.]+), and ([0-9.]+) without the film\..*/\1 \2 \3 \4/p')
END

# ---- real files ----

# row STEPS [RESAMPLED]: prints the row of the page's table for the surface scan.rcg after these steps.
row() {
    { if [ -n "$1" ]; then rc-detrend --quiet $1 scan.rcg; else cat scan.rcg; fi; } |
        { if [ -n "${2-}" ]; then rc-pick $2; else cat; fi; } >fit.rcg
    rc-solve --mean-pressure 200MPa --estar 100GPa --tol 1e-4 --quiet --report fit.json -o /dev/null fit.rcg
    rc-info --areal --json fit.rcg >fit.info
    awk -v sq="$(field sq fit.info)" -v sdq="$(field sdq fit.info)" -v fraction="$(field contact_fraction fit.json)" \
        -v patches="$(grep -o '"patches": {"count": [0-9]*' fit.json | grep -o '[0-9]*$')" -v most="$(field max_pressure fit.json)" \
        'BEGIN { printf "%.1f %.3f %.2f %d %.2f\n", sq * 1e9, sdq, fraction * 100, patches, most / 100e9 }'
}
if [ -d "$RC_CORPUS/corpus" ]; then
    rc-import --quiet "$RC_CORPUS/corpus/nanoscope/SurfaceTopography__di-4.di" -o scan.rcg
    fit="--poly 2 --spikes 5 --fill"
    awk '/^step  / { on = 1 } /^\.Ed/ { on = 0 } on' "$page" >table.txt
    while read -r line; do
        steps=$(sed -E 's/ +([0-9.]+ *){5}$//' <<<"$line")
        case $steps in
        step* | after* | further*) continue ;;
        "unchanged") row '' ;;
        --resample*) row "$fit" "$steps" ;;
        --plane | --poly\ 2*) row "$steps" ;;
        *) row "$fit $steps" ;;
        esac >row.txt
        echo "${line#"$steps"}" >shown.txt
        claim "the table of steps is right: $steps" agrees shown.txt row.txt
    done <table.txt
    claim "  has rows" test "$(wc -l <table.txt)" -gt 10

    # The commands of the first section work for a measured file too, with other figures.
    mkdir real
    cp "$RC_CORPUS/corpus/x3p/bulletxtrctr__Hamby252_Barrel1_Bullet1_Land1.x3p" real/rough-steel.x3p
    for block in 2 3 4 5 6 7 8; do
        claim "display $block runs on a file of an instrument" bash -c \
            "cd real && bash -e -u -o pipefail ../blocks/$block </dev/null >../real.out 2>&1 || { cat ../real.out >&2; exit 1; }"
    done
else
    untried "the table of steps and the first section on a measured file, for no corpus of real files is beside the project"
fi

# ---- its pictures ----

# drawn FILE: prints the command that made a picture, without the version of the tools.
drawn() {
    perl -0777 -ne 'while (/\G(?:\x89PNG\r\n\x1a\n)?(....)(....)/gs) { my ($n, $type) = (unpack("N", $1), $2);
        my $data = substr $_, pos, $n; pos = pos() + $n + 4;
        if ($type eq "tEXt" && $data =~ s/^Description\0//) { $data =~ s/\b(rc-[a-z]+) [0-9.]+/$1/g; print "$data\n" } }' "$1"
}
for picture in $(pictures "$page"); do
    claim "$picture is drawn" test -s "run/$picture"
    claim "  the picture among the samples is the same" diff <(drawn "run/$picture") <(drawn "$samples/$picture")
    claim "  it contains the command that made it" test -n "$(drawn "$samples/$picture")"
done
claim "no two pictures have the same name" test -z "$(pictures "$page" | sort | uniq -d)"
claim "pictures were compared" test "$(pictures "$page" | wc -l)" -ge 5
claim "  together they have less than 700 kB" test "$(cd "$samples" && cat $(pictures "$page") | wc -c)" -lt 700000
