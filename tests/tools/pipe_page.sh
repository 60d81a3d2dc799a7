# SPDX-License-Identifier: GPL-3.0-or-later
# rc-report: a page of a surface is complete in itself, and its commands make it again. No name or key of a
# file acts as markup. A step that fails leaves nothing.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/python.sh"

mkdir tmp page again
export TMPDIR="$PWD/tmp" RC_THREADS=1
cp "$RC_SOURCE/sample_surfaces/turned-brass.txt" brass.txt
parsed() { says "$1" "$python" "$RC_SOURCE/tests/tools/python_page.py" "$2"; }
if ! python=$(python_with xml.etree.ElementTree 2>why.txt); then
    untried "the HTML, $(cat why.txt)"
    parsed() { grep -q '</html>' "$2"; }
fi

# ---- a page ----

claim "report.sh makes a page from a file" warns 'rc-report: no elasticity was given, so the bodies are steel on steel: E\* is 114 GPa, and the hardness is 6 GPa' \
    bash -c 'cd page && rc-report -o brass.html ../brass.txt'
claim "  no other file is left" test "$(ls page) $(ls tmp | wc -l)" = "brass.html 0"
claim "  it is HTML with all pictures inside" parsed '^6 pictures: brass.txt: brass.txt$' page/brass.html
claim "  it has units, metadata, parameters, loads and messages" bash -c '
    for words in "nodes, dx 5 um" "Sq  *[0-9.]* nm" "S10z " "Rsm " "Hurst " "source=brass.txt" "<td>yes</td>" "Error of the pressure" \
        "largest patch" "rc-solve: brass.txt, case 1.*the grid does not resolve it" "values of steel on steel"; do
        grep -q "$words" page/brass.html || { echo "$words" >&2; exit 1; }
    done'
sed -n '/<pre id="commands">/,/<\/pre>/p' page/brass.html | sed 's/<[^>]*>//g; s/&#60;/</g; s/&#62;/>/g; s/&#39;/\x27/g; s/&#38;/\&/g' >commands.sh
claim "  the commands on the page make it again" bash -c 'cd again && bash -e ../commands.sh 2>/dev/null && [ "$(ls *.png | wc -l)" = 6 ]'
sed -n 's/.*base64,\([^"]*\)".*/\1/p' page/brass.html >pictures.txt
k=0
for picture in heights ratio spectrum pressure curve section; do
    k=$((k + 1))
    claim "    $picture is equal byte for byte" cmp "again/$picture.png" <(sed -n "${k}p" pictures.txt | base64 -d)
done
contact="--load 0.02N --estar 70GPa"
rc-report $contact --quiet -o once.html brass.txt 2>said.txt
claim "--quiet prints no message, but the page has it" test ! -s said.txt -a "$(grep -c 'does not resolve' once.html)" = 1
claim "  one load gives no curve, and without a hardness the contact is elastic" bash -c '
    [ "$(grep -c "<img" once.html)" = 5 ] && grep -q "E\* is 70 GPa, the bodies are elastic, and the map ends" once.html && ! grep -q steel once.html'
claim "  a pipe and two threads give the same page" bash -c "rc-report --threads 2 $contact --quiet brass.txt | cmp - once.html"

# ---- bars ----

# The table on the page has the figures of rc-cost for the same surface and contact.
bars_again() {
    rc-report --quiet $contact --noise 3nm -o noisy.html brass.txt && rc-import --quiet brass.txt | rc-detrend --quiet --poly 2 --fill -o prepared.rcg &&
        rc-cost --quiet --noise 3nm --resolution --report bars.json -o bars.txt prepared.rcg -- rc-solve $contact &&
        perl -MJSON::PP -e '
            my ($page) = do { local (@ARGV, $/) = "noisy.html"; <> } =~ /<p>Noise of 3 nm(.*?)<\/table>/s or die "no table\n";
            my ($n, @row) = (0, grep { $_->{what} eq "figure" && $_->{bar} } map { decode_json($_) } do { local @ARGV = "bars.json"; <> });
            for my $r (@row) {
                my $line = sprintf "<td>%s</td><td>%.4g %s</td><td>%.3g %%</td><td>%s</td>", $r->{name} =~ tr/_/ /r, $r->{value}, $r->{unit} // "",
                    100 * $r->{bar_relative}, $r->{dominant};
                index($page, $line) >= 0 or die "missing: $line\n";
                $n++;
            }
            exit($n < 4)'
}
claim "--noise puts the bars of rc-cost on the page" bars_again
claim "  and says what they are" bash -c 'grep -q "<p>In 90 % of the cases the value of the true surface is within the bar" noisy.html && ! grep -q "Noise alone" noisy.html'
claim "  which has none without it" lacks 'Noise of' once.html
refuses 2 'noise takes a standard deviation and a length' "three numbers of --noise" "rc-report --noise 1nm,1um,1um brass.txt"

# ---- options ----

claim "options of the contact are passed to rc-solve" bash -c '
    rc-report --quiet --outliers 5 --mirror --load 0.01N,0.02N --E1 70GPa --nu1 0.3 --E2 rigid --hardness 2GPa --radius 5mm -o options.html brass.txt &&
    grep -q -- "^rc-detrend --poly 2 --outliers 5 --fill --mirror measured.rcg" options.html &&
    grep -q -- "rc-solve --periodic --load 0.01N,0.02N --E1 70GPa --nu1 0.3 --E2 rigid --hardness 2GPa --radius 5mm --output" options.html &&
    grep -q -- "^rc-stress --section" options.html && grep -q "a sphere of radius 5 mm is added, the hardness is 2 GPa, and the map repeats" options.html'

# ---- effects: those of rc-scene ----

known="--load 0.01N,20N --E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3 --mu 0.3 --yield 1GPa"
rc-synth sphere --radius 3mm --nx 48 --dx 4um -o steel.rcg
rc-report --quiet $known --hardness 1.5GPa -o steel.html steel.rcg
claim "the page has the verdicts of rc-scene" parsed '^6 pictures' steel.html
sed -n '/<h2>Effects/,/<h2>Accuracy/p' steel.html >effects.html
# Hertz: p0^3 = 6 F E*^2/(pi^3 R^2)
p0=$(awk 'BEGIN { pi = atan2(0, -1); print (6 * 20 * (210e9 / 1.82) ^ 2 / (pi ^ 3 * 9e-6)) ^ (1 / 3) }')
near "$(sed -n 's/.*<th>hardness<.*calls for it: changes the largest pressure by \([0-9.]*\) %.*/\1/p' effects.html)" \
    "$(awk -v p="$p0" 'BEGIN { print 100 * (1 - 1.5e9 / p) }')" 0.02 "  of the last load: the hardness lowers the largest pressure to 1.5 GPa"
claim "  with the command that computes it" grep -q '<pre>rc-solve --load 20N .*--hardness 1.5GPa surface.rcg -o scene-hardness.rcg</pre>' effects.html
rc-report --load 20N --body1 stainless-steel --body2 rigid --hardness 129HV --E1 1.93e5MPa -o typed.html steel.rcg 2>typed.txt
claim "  as it was typed" grep -q '<pre>rc-solve --load 20N --E1 1.93e5MPa --nu1 0.29 --E2 rigid --hardness 129HV surface.rcg -o scene-hardness.rcg</pre>' typed.html
claim "  a message about an option is said once" test "$(grep -c -- '--hardness 129HV is' typed.txt)" = 1
claim "  also on the page" test "$(sed -n '/<h2>Accuracy/,/<h2>Limits/p' typed.html | grep -c -- '--hardness 129HV is')" = 1
claim "  like bodies do not feel friction" grep -q 'friction of dissimilar bodies</th><td>negligible: changes nothing' effects.html
claim "  and the data that other effects need" grep -q 'Data are missing for: .*partial slip (--tangential)' effects.html
rc-report --quiet --load 20N --body1 steel --body2 100Cr6 -o named.html steel.rcg
claim "  the sentence of an effect that cannot be judged is whole" bash -c '
    grep -q "<tr><th>yield in the volume</th><td>cannot be judged: the table has no yield stress of steel, body 1: give --yield</td>" named.html &&
    grep -q "<tr><th>hardness</th><td>cannot be judged: the table has no hardness of steel, body 1; " named.html'
claim "  rc-solve does not get them" bash -c '! grep "^rc-solve.*--yield" steel.html | grep -v "<pre>"'
rc-report --quiet --load 1N --E1 rigid --layer 5um,3GPa,0.4 --E2 rigid -o layers.html steel.rcg
claim "layers on a rigid body 1: no verdicts" lacks '<h2>Effects' layers.html

# ---- sections of effects, and the first paragraph: a ball of 3 mm on a flat, Hertz ----

# figure FILE TITLE: the value of a row of a table, without its unit, in SI
figure() {
    sed -n "s/.*<th>$2<\/th><td>\([^<]*\)<.*/\1/p" "$1" | head -n 1 |
        awk '{ split("p n u m k M G", prefix); split("1e-12 1e-9 1e-6 1e-3 1e3 1e6 1e9", size)
            for (k in prefix) if (index($2, prefix[k]) == 1 && length($2) > 1 && $2 != "m3" && $2 != "m/s") $1 *= size[k]
            printf "%.17g\n", $1 }'
}
said() { sed -n '/<p id="verdict">/,/<\/p>/p' "$1" | tr '\n' ' '; }
effects='--load 20N --E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3 --mu 0.3 --tangential 3N --coefficient 1e-8mm3/Nm --distance 1m
    --speed 2m/s --conductivity 40,40 --diffusivity 1.2e-5,1.2e-5 --pressure-drop 1e5 --bending-limit 500MPa --torsion-limit 300MPa --yield 3GPa'
claim "a page has sections of the effects whose data are given" bash -c "rc-report --quiet $(echo $effects) -o effects-of.html steel.rcg"
claim "  in their order" test "$(sed -n 's/<h2>\(.*\)<\/h2>/\1/p' effects-of.html | tr '\n' ,)" = \
    "The surface,Heights and wavelengths,Profiles along x,Under load,Friction,Wear,Heat,Leak,Fatigue,Shakedown,Effects,Accuracy,Limits,Origin,Commands,"
claim "  a page without data has none" bash -c '! grep -E "<h2>(Travel|Creep|Friction|Rolling|Wear|Heat|Leak|Fatigue|Shakedown)<" once.html'
near "$(figure effects-of.html 'Part of the contact that sticks')" "$(awk 'BEGIN { print (1 - 3 / 6) ^ (2 / 3) }')" 0.05 \
    "  friction: the part that sticks is Cattaneo's, to a row of nodes"
rc-solve --quiet --load 20N --E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3 steel.rcg | rc-slip --quiet --mu 0.3 --tangential 3N -o slips.rcg
near "$(figure effects-of.html 'Largest slip')" "$(paste -d ' ' <(rc-export --quiet --channel slip-x --format csv slips.rcg | grep -v '^#' | tr ',' '\n') \
    <(rc-export --quiet --channel slip-y --format csv slips.rcg | grep -v '^#' | tr ',' '\n') | awk '{ s = sqrt($1 ^ 2 + $2 ^ 2); if (s > m) m = s } END { print m }')" \
    "$three_digits" "  and the largest slip that of the frames, of all increments"
near "$(figure effects-of.html 'Worn volume')" 2e-16 1e-3 "  wear: the volume is Archard's"
near "$(figure effects-of.html 'Heat')" 12 1e-3 "  heat: the power of friction"
claim "  leak: fluid flows around a ball" says 'A fluid gets through the gap\.' said effects-of.html
claim "  fatigue and shakedown are those of a smooth body 1" bash -c 'sed -n "/<p id=\"verdict\">/,/<\/p>/p" effects-of.html | tr "\n" " " |
    grep -q "As if this surface passed along x over a smooth body 1, the safety factor against fatigue is [0-9.]*; a rough body 1, over which a smooth body passes, needs .rc-solve --travel.\..*As if this surface passed along x over a smooth body 1, the index of elastic shakedown is"'
# Kalker's linear theory of small creepage: Fx = C11 G a b xi, C11 = 4.12 for a circle at nu = 0.25
rc-report --quiet --load 20N --E1 210GPa --nu1 0.25 --E2 210GPa --nu2 0.25 --mu 0.3 --creep 1e-5 -o rolls.html steel.rcg
near "$(figure rolls.html 'Force along x')" "$(awk 'BEGIN { a2 = (0.75 * 20 * 3e-3 / (210e9 / 1.875)) ^ (2 / 3); print 4.12 * 84e9 * a2 * 1e-5 }')" 0.05 "rolling: the force is Kalker's"
claim "  with a picture of stick and slip" grep -q '<figcaption>Where the contact sticks, and where it slips, in steady rolling' rolls.html
claim "  and the first paragraph" says 'Rolling with these creepages leaves a share of 0\.99[0-9]* of the contact sticking\.' said rolls.html
# Hills and Ashelby: a ball that passes without friction shakes down elastically up to p0 = 4.7 k
near "$(figure effects-of.html 'Index of shakedown')" "$(awk -v p="$p0" 'BEGIN { print p / (4.7 * 3e9 / sqrt(3)) }')" 0.1 "  shakedown: the index is that of a ball on a half-space"
area=$(awk 'BEGIN { pi = atan2(0, -1); print pi * (0.75 * 20 * 3e-3 / (210e9 / 1.82)) ^ (2 / 3) * 1e6 }') # mm2
near "$(said effects-of.html | sed 's/.*% of the map, \([0-9.]*\) mm2.*/\1/')" "$area" 0.03 "the first paragraph has the area of the contact"
near "$(said effects-of.html | sed 's/.*The largest pressure is \([0-9.]*\) GPa.*/\1e9/')" "$p0" 0.03 "  the largest pressure"
near "$(said effects-of.html | sed 's/.*the largest Mises stress is \([0-9.]*\) GPa.*/\1e9/')" "$(awk -v p="$p0" 'BEGIN { print 0.62 * p }')" 0.03 "  the largest Mises stress"
claim "  below the yield stress" says ', 0\.3[67][0-9]* times the yield stress of 3 GPa: the volume stays elastic' said effects-of.html
rc-report --quiet --load 20N --E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3 --yield 500MPa -o yields.html steel.rcg
claim "  above it" says 'times the yield stress of 500 MPa: the volume yields' said yields.html
near "$(said yields.html | sed 's/.*, \([0-9.]*\) times the yield stress.*/\1/')" "$(awk -v p="$p0" 'BEGIN { print 0.62 * p / 500e6 }')" 0.03 "    by this factor"
claim "  a named material has the yield stress of its table" says 'times the yield stress of 215 MPa: the volume yields' \
    bash -c 'rc-report --quiet --load 20N --body1 stainless-steel --body2 rigid steel.rcg'
printf 'name\tE\tnu\tyield\nhard\t210GPa\t0.3\t8GPa\nunknown\t210GPa\t0.3\t-\n' >materials.tsv
named() { rc-report --quiet --load 20N --materials materials.tsv --body1 "$@" --body2 rigid steel.rcg; }
claim "    also of a table of the user" says ', 0\.2[0-9]* times the yield stress of 8 GPa: the volume stays elastic' named hard
claim "    the commands have the values of the table" says '^rc-solve --load 20N .*--E1 210GPa --nu1 0.3 --E2 rigid' named hard
claim "    --yield goes before" says 'times the yield stress of 500 MPa: the volume yields' named hard --yield 500MPa
claim "    without one the verdict names the stress" says 'a material with a lower yield stress yields there' named unknown
claim "  what yields at a hardness" says '1.5 GPa: the hardness, at which [0-9.]* % of the contact yields' said steel.html
claim "  the error" says 'The estimated error of the solution on this grid, in the pressure, is 0\.0[0-9]* %\.' said steel.html
claim "  and what limits the trust" says 'What limits .*: the edge of the map carries [0-9.]* % of the load.*; no elasticity was given' said page/brass.html
claim "  or that the checks found nothing" says 'no estimated error or change by a finer grid is above 10 %; --noise adds bars' said effects-of.html
# a jagged roller whose stresses are wanted at a depth of half a node: errors above 10 % are in the first paragraph
rc-synth selfaffine --nx 48 --dx 4um --hurst 0.8 --rms-height 0.1um --rolloff 60um --short-cut 8um --seed 2 -o jagged.rcg
roller="--load 50kN/m --cylinder 5mm --E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3 --periodic=y"
limits="--bending-limit 700MPa --torsion-limit 430MPa"
rc-report --quiet $roller $limits --noise 2nm -o jagged.html jagged.rcg
rc-detrend --quiet --fill jagged.rcg | rc-solve --quiet $roller | rc-fatigue --quiet $limits --pass x --depths auto --report jagged.json -o x.rcg
near "$(said jagged.html | sed 's/.*the estimated error of the index of Dang Van is \([0-9.]*\) % under Fatigue.*/\1/')" "$(awk -v e="$(field dangvan_error_estimate jagged.json)" 'BEGIN { print 100 * e }')" 5e-3 \
    "  the error of rc-fatigue by the sampling"
# a worn map: a node that has just come into contact, with a wide estimate of the largest pressure
rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-slope 0.1 --short-cut 8um --seed 3 -o runs-in.rcg
wears="--coefficient 1e-7mm3/Nm --distance 10m"
rc-report --quiet --periodic --mean-pressure 500MPa --estar 114GPa $wears -o runs-in.html runs-in.rcg
rc-solve --quiet --periodic --mean-pressure 500MPa --estar 114GPa runs-in.rcg | rc-wear --quiet $wears --report runs-in.json -o x.rcg
near "$(said runs-in.html | sed 's/.*the estimated error of the largest pressure is \([0-9.]*\) % under Wear (it covers each node.*/\1/')" \
    "$(awk -v e="$(field max_pressure_error_estimate runs-in.json)" 'BEGIN { print 100 * e }')" 5e-3 "  the error of the largest pressure by wear, and what it covers"
near "$(figure runs-in.html 'Error of the pressure')" "$(field pressure_error_estimate runs-in.json)" "$three_digits" "    beside it stands the error of the whole pressure"
claim "  the change by a finer grid of rc-scene" test "$(said jagged.html | sed 's/.*: a finer grid changes the \([a-z ]*\) by up to \([0-9.]*\) %;.*/\1 \2/')" = \
    "$(rc-scene --quiet $roller jagged.rcg | sed -n 's/^  finer grid .*: changes the \([a-z ]*\) by .* to \([0-9.]*\) %/\1 \2/p')"
claim "  bars without a limit on the grid" says 'the largest pressure has no bar: a finer grid may change it further, so give the spacing, 4 um, with the value \(noise alone changes it by [0-9.]* %\)' said jagged.html
rc-cost --quiet --noise 2nm --resolution --report jagged-bars.json -o x.txt jagged.rcg -- rc-solve $roller
share() { perl -MJSON::PP -ne 'my $r = decode_json($_); print 100 * $r->{noise_relative} if $r->{what} eq "figure" && $r->{name} eq "max_pressure"' jagged-bars.json; }
near "$(said jagged.html | sed 's/.*the largest pressure has no bar[^(]*(noise alone changes it by \([0-9.]*\) %).*/\1/')" "$(share)" 5e-3 "    with the part of the noise of rc-cost"
near "$(sed -n 's/.*<td>max pressure<.*<td>noise alone \([0-9.]*\) %<.*a finer grid may change it further, so give the spacing, 4 um, with the value<.*/\1/p' jagged.html)" "$(share)" 5e-3 "    in the table too"
claim "    where no figure has a bar, the page does not explain bars" bash -c '! grep -q "is within the bar" jagged.html && grep -q "<p>Noise alone: in 90 %" jagged.html'
claim "  not that nothing limits" bash -c '! grep -q "found nothing that limits" jagged.html'
near "$(said noisy.html | sed 's/.*the bar of the largest pressure is \([0-9.]*\) %.*/\1/')" \
    "$(awk -F '"bar_relative": ' '/"figure", "name": "max_pressure"/ { print 100 * $2 }' bars.json)" 5e-3 "  the bars of rc-cost"
sed -n '/^Limits:/,/^## /s/^\(- \|  \)//p' "$RC_SOURCE/README.md" | tr -s ' \n' ' ' >readme.txt
claim "the page has the limits of README" test "$(cat readme.txt)" = "$(sed -n '/<h2>Limits/,/<\/ul>/s/<li>\(.*\)<\/li>/\1/p' effects-of.html | tr '\n' ' ')"
rc-pick --set form= steel.rcg -o bump.rcg # a second sphere is added
rc-report --quiet --load 20N --relaxation 2GPa,100GPa:1s --nu1 0.3 --E2 rigid --time 100s --travel=-10um,0,10um --radius 3mm -o soft.html bump.rcg
claim "travel and creep have sections" test "$(grep -c -E '<h2>(Travel|Creep)<' soft.html)" = 2
rc-synth sphere --radius 3mm --nx 64 --dx 8um -o wide.rcg
rc-report --quiet --load 20N --relaxation 20GPa,180GPa:1s --nu1 0.3 --E2 rigid --time 100s -o creep.html wide.rcg
# Lee and Radok: a constant load has the area of the relaxed modulus in the end
near "$(said creep.html | sed 's/.*in contact becomes \([0-9.]*\) .*/\1/')" \
    "$(awk 'BEGIN { pi = atan2(0, -1); print pi * (0.75 * 20 * 3e-3 / (20e9 / 0.91)) ^ (2 / 3) / (64 * 8e-6) ^ 2 }')" 0.03 "  creep ends at the area of the relaxed modulus"
near "$(said creep.html | sed 's/.*touch on \([0-9.]*\) %.*/\1e-2/')" \
    "$(awk 'BEGIN { pi = atan2(0, -1); print pi * (0.75 * 20 * 3e-3 / (200e9 / 0.91)) ^ (2 / 3) / (64 * 8e-6) ^ 2 }')" 0.05 "  and begins at that of the modulus at once"
printf 'time (s),modulus (GPa)\n0.1,180\n1,90\n10,30\n100,20\n1000,20\n' >table.csv
rc-report --quiet --load 20N --relaxation table.csv --nu1 0.3 --E2 rigid --time 100s --pressure-drop 1kPa -o of-table.html wide.rcg
claim "a table of a relaxation modulus is found from the folder of the page" test "$(figure of-table.html 'Real contact area')$(grep -c 'was not computed' of-table.html)" != 1
claim "  its name stands as it was given" bash -c 'grep -q -e "--relaxation table.csv" of-table.html && ! grep -q "$PWD/table.csv" of-table.html'
claim "  other effects are those before creep" says 'of other effects are those of the contact before creep' said of-table.html
claim "the first paragraph comes first" test "$(grep -n -m 1 'id="verdict"' creep.html | cut -d : -f 1)" -lt "$(grep -n -m 1 '<h2>' creep.html | cut -d : -f 1)"
rc-synth wave --amplitude 1e-15 --wavelength 320um --nx 8 --dx 40um -o coarse.rcg
rc-report --quiet --load 20N --radius 3mm --E1 210GPa --nu1 0.3 --E2 rigid --yield 0.5GPa --travel=0,40um --passes 1 -o short.html coarse.rcg
claim "an effect short of its accuracy is named" says 'the requested accuracy was not reached under Travel' said short.html
rc-synth selfaffine --nx 64 --dx 5um --hurst 0.8 --rms-height 20nm --rolloff 100um --short-cut 30um --seed 5 -o fine.rcg
rc-report --quiet --load 20N --radius 10mm --E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3 --mu 0.05 --speed 2m/s --viscosity 0.1Pas --pressure-viscosity 20/GPa -o film.html fine.rcg
claim "the page has the warning of a film" grep -q 'a film of the fluid may carry load' film.html
rc-synth wave --amplitude 1e-15 --wavelength 96um --nx 96 --dx 4um -o flat.rcg
rc-report --quiet --load 20N --E1 210GPa --nu1 0.3 --E2 rigid --radius 3mm --travel=-20um,0,20um -o travel.html flat.rcg
p1=$(awk 'BEGIN { pi = atan2(0, -1); print (6 * 20 * (210e9 / 0.91) ^ 2 / (pi ^ 3 * 9e-6)) ^ (1 / 3) / 1e9 }')
claim "  travel: the pressure on a flat is Hertz's at each place" awk -v p="$p1" '
    /<h2>Travel/ { on = 1 } /<h2>Effects/ { on = 0 }
    on && /<tr><td>/ { sub(/.*<tr><td>/, ""); n += $1 > 0.98 * p && $1 < 1.02 * p && $2 ~ /^GPa/ } END { exit n != 3 }' travel.html
# a wave that is pressed flat has a gap of rounding alone
rc-synth wave --amplitude 0.1um --wavelength 64um --nx 32 --dx 2um -o wave.rcg
rc-report --quiet --mean-pressure 1GPa --periodic --relaxation 2GPa,100GPa:1s --nu1 0.3 --E2 rigid --time 100s -o wave.html wave.rcg
claim "a length below rounding is 0" bash -c '[ "$(sed -n "/<h2>Creep/,/<h2>Effects/p" wave.html | grep -c "<td>0 m</td>")" -ge 3 ] && lacks "e-[12][0-9] m<" wave.html'
claim "a section whose tool refuses the problem says so, and the page is written" bash -c '
    rc-report --quiet --load 20N --estar 100GPa --mu 0.3 --tangential 30N -o refused.html steel.rcg 2>refused.txt; [ $? = 0 ] && [ -s refused.txt ] &&
    grep -A 1 "<h2>Friction" refused.html | grep -q "This was not computed"'
claim "  in the first paragraph too" says 'trust in these figures: .*not computed: Friction' said refused.html

rc-synth sphere --nx 33 --dx 1um --radius 1mm -o ball.rcg
rc-report --quiet --load 0.1N --estar 114GPa -o ball.html ball.rcg
claim "the form of a grid stream is not removed" bash -c '
    grep -q "^<pre id=.commands.>rc-detrend --fill ball.rcg -o surface.rcg" ball.html && ! grep -q -- "--poly" ball.html'
# Hertz: a^3 = 3 F R / 4 E*
near "$(grep -o 'contact area  *[0-9.]* um2' ball.html | awk '{ print $3 }')" \
    "$(awk 'BEGIN { print 3.14159265 * (0.75 * 1e-4 / 114e9) ^ (2 / 3) * 1e12 }')" 0.06 "  the area of a ball is Hertz's, to a row of nodes at its edge"
claim "a profile has a page too" bash -c 'rc-pick --crop 0,16,33,1 ball.rcg | rc-pick --set periodic=no -o line.rcg &&
    rc-report --quiet --load 1N/m --estar 114GPa -o line.html line.rcg'

# ---- names and keys that look like markup or options ----

mark='<script>alert(1)</script>&amp;"'
rc-import brass.txt | rc-pick --set "file.comment=$mark" -o marked.rcg
cp marked.rcg -- "-o my 'b' \$(touch hacked) <b>&.rcg"
claim "a file name with quotes, blanks, a leading hyphen and markup is accepted" bash -c '
    rc-report --quiet '"$contact"' -o hostile.html -- "-o my '"'b'"' \$(touch hacked) <b>&.rcg" && [ ! -e hacked ]'
claim "  the page shows it as text" parsed "^5 pictures: -o my 'b' \\\$\(touch hacked\) <b>&.rcg: -o my" hostile.html
claim "  metadata and history are text too" bash -c '[ "$(grep -c "&#60;script&#62;alert(1)&#60;/script&#62;&#38;amp;&#34;" hostile.html)" = 2 ]'
claim "  the page has no script" lacks '<script' hostile.html
claim "  its first command reads this file" bash -c '
    sed -n "s/.*<pre id=.commands.>//p" hostile.html | sed "s/&#60;/</g; s/&#62;/>/g; s/&#39;/\x27/g; s/&#38;/\&/g; s/&#34;/\"/g" >first.sh &&
    bash -e first.sh 2>/dev/null && [ ! -e hacked ] && cmp <(rc-info surface.rcg) <(rc-detrend --fill marked.rcg 2>/dev/null | rc-info)'
claim "--title sets the title" bash -c "rc-report --quiet $contact --title '$mark' -o title.html ball.rcg"
claim "  it is text" parsed '^5 pictures: <script>alert\(1\)</script>&amp;": <script>' title.html
claim "a file name that is not UTF-8 is accepted" bash -c 'cp ball.rcg "$(printf "b\\377ll.rcg")" && rc-report --quiet '"$contact"' -o latin.html "$(printf "b\\377ll.rcg")"'
claim "  the wrong byte is omitted" parsed '^5 pictures: b\?ll.rcg' latin.html

# ---- failures ----

refuses 2 'rc-report: 0 files were given: give one' "no file" "rc-report"
refuses 2 'rc-report: 2 files were given: give one' "two" "rc-report ball.rcg ball.rcg"
refuses 2 'write standard input to a file' "standard input" "rc-report - <ball.rcg"
refuses 1 'rc-report: nosuch.x3p: No such file' "a file that is not there" "rc-report nosuch.x3p"
refuses 2 'unknown option --lod: did you mean --load' "an unknown option" "rc-report --lod 3N ball.rcg"
refuses 2 "rc-report: --load 1K: unknown unit 'K'" "a wrong unit, before the work" "rc-report --load 1K ball.rcg"
refuses 2 'give the elasticity' "half of an elasticity" "rc-report --E1 1GPa ball.rcg"
refuses 2 '--nu .*--nu1' "two ratios of Poisson" "rc-report --nu 0.3 --E1 1GPa --nu1 0.3 --E2 rigid ball.rcg"
cat ball.rcg ball.rcg >two.rcg
refuses 1 'two.rcg: it holds 2 maps' "two maps" "rc-report $contact two.rcg"
echo old >old.html
head -c 1000 brass.txt >cut.txt
echo 'no number' >>cut.txt
refuses 1 '^rc-import: .*cut.txt: ' "a file that a tool refuses, in the words of this tool" "rc-report $contact -o old.html cut.txt"
claim "  with the way out where it needs options of rc-import" grep -q 'rc-report: if this file needs options of rc-import, write its grid stream' refuses.err
refuses 1 '^rc-[a-z]*: .*--memory allows' "too little memory" "rc-report $contact --memory 100k -o old.html brass.txt"
claim "  after a failure the old page stays, and there is no other file" bash -c '[ "$(cat old.html)" = old ] && [ "$(ls old.html* | wc -l)$(ls tmp | wc -l)" = 10 ]'

# ---- the tools beside it ----

mkdir alone
ln "$RC_BIN/rc-report" alone 2>/dev/null || cp "$RC_BIN/rc-report" alone
claim "it runs the tools of its folder, otherwise those of PATH" bash -c "
    PATH=/nowhere '$RC_BIN/rc-report' --quiet $contact -o nowhere.html ball.rcg && cmp nowhere.html <(alone/rc-report --quiet $contact ball.rcg)"
refuses 1 'rc-detrend: it cannot be run' "  and says when there are none" "PATH=/nowhere alone/rc-report $contact ball.rcg"
printf '#!/bin/sh\necho "rc-cost: it fails" >&2\nexit 1\n' >alone/rc-cost
chmod +x alone/rc-cost
claim "bars that fail lose no page" warns 'rc-cost: it fails' alone/rc-report $contact --noise 1nm -o without.html ball.rcg
claim "  which says so, in the first paragraph too" bash -c 'grep -q "The bars were not computed: see the messages" without.html &&
    grep -q "the bars of the measurement were not computed" without.html && grep -q "</html>" without.html'
printf '#!/bin/sh\n"%s/rc-solve" "$@"\nexit 3\n' "$RC_BIN" >alone/rc-solve
chmod +x alone/rc-solve
alone/rc-report --quiet $contact -o short.html ball.rcg
claim "a solution that stopped short gives exit status 3" test $? = 3
claim "  the page is complete" parsed '^5 pictures' short.html
printf '#!/bin/sh\necho $$ >pid.txt\ncp pid.txt "%s"\nexec sleep 100\n' "$PWD" >alone/rc-solve
stopped() {
    alone/rc-report --quiet $contact -o stopped.html ball.rcg &
    local tool=$! child
    until [ -s pid.txt ] || ! kill -0 "$tool"; do sleep 0.05; done
    child=$(cat pid.txt) && kill "-$1" "$tool"
    wait "$tool"
    [ $? = $((128 + $(kill -l "$1"))) ] || return 1
    for n in {1..40}; do kill -0 "$child" 2>/dev/null || break; sleep 0.05; done
    rm pid.txt
    ! kill -0 "$child" 2>/dev/null && [ -z "$(ls stopped.html* 2>/dev/null)" ] && [ -z "$(ls tmp)" ]
}
claim "a reader that ends early leaves no folder" bash -c "set +o pipefail
    rc-report --quiet $contact ball.rcg | head -c 10 >/dev/null; [ -z \"\$(ls tmp)\" ]"
claim "SIGTERM ends rc-report and its tool, and no file is left" stopped TERM
claim "SIGHUP does the same" stopped HUP
