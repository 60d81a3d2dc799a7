# SPDX-License-Identifier: GPL-3.0-or-later
# Messages help: a message names the next step, a warning about a list of loads is printed once with its
# cases. The memory is printed on request.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 33 --dx 20um --radius 7.5mm -o ball.rcg
rc-synth selfaffine --nx 32 --dx 1um --hurst 0.8 --rms-height 10nm --seed 3 -o rough.rcg

# ---- one warning for a list ----

press() { rc-solve --estar 1GPa --output pressure "$@" -o p.rcg rough.rcg; }
export -f press
press --load 10mN,10.1mN,10.2mN,10.3mN 2>said.txt
claim "the first of four cases gets the full warning" says 'selfaffine-seed-3, case 1, load 10 mN: .* on the outer 2 % of the map.*: take a larger map, a smaller load, or --periodic' cat said.txt
claim "  it is printed once" test "$(grep -c 'on the outer 2 %' said.txt)" = 1
claim "  the other cases are listed in one line" says '^rc-solve: cases 2 to 4 too: the contact reaches the edge of the map$' cat said.txt
claim "a single other case is listed as one" eval 'press --load 10mN,11mN 2>said.txt; says "^rc-solve: case 2 too: the contact reaches" cat said.txt'
# under the first and the last load the contact of the ball reaches the edge, under the two between them it
# does not
claim "cases that are not consecutive are listed" eval 'rc-solve --estar 100GPa --output pressure --load 1500N,1N,1600N,1700N,1N,1800N -o p.rcg ball.rcg 2>said.txt;
    says "^rc-solve: cases 3 to 4, 6 too: the contact reaches the edge" cat said.txt'
claim "--quiet suppresses the list" eval '! press --quiet --load 10mN,11mN 2>&1 | grep .'

# ---- memory ----

claim "--verbose prints figures, but not the memory" eval 'rc-solve --verbose --periodic --estar 1GPa --load 1mN -o p.rcg rough.rcg 2>said.txt &&
    says "force 1 mN" cat said.txt && ! grep -q memory said.txt'
claim "--debug prints both" eval 'rc-solve --debug --periodic --estar 1GPa --load 1mN -o p.rcg rough.rcg 2>said.txt &&
    says "force 1 mN" cat said.txt && says "^rc-solve: memory: [0-9.]+ MiB counted, [0-9.]+ MiB taken$" cat said.txt'

# ---- advice ----

for unit in N Pa um mN s; do
    refuses 1 "^rc-solve: $unit: No such file or directory: a unit follows its number without a blank, as in 60$unit$" \
        "60 $unit" "rc-solve --load 60 $unit --estar 114GPa ball.rcg -o never.rcg"
done
refuses 1 '^rc-solve: none: No such file or directory$' "a word that is not a unit" "rc-solve --load 60 none --estar 114GPa -o never.rcg"
refuses 1 'no frame with the channel pressure, only height: rc-solve finds the pressure of heights under a load$' "stresses of heights" \
    "rc-stress --nu 0.3 --depths 0 ball.rcg -o never.rcg"
rc-synth wave --nx 64 --dx 1um --amplitude 1um --wavelength 16um -o ridges.rcg
claim "an undefined Str of ridges has a reason" says '^  Str +not defined: ridges run across the map: ' rc-info --areal ridges.rcg
printf '2 2 2\n2 2 2\n2 2 2\n' >flat.txt && rc-import --dx 1um --z-unit um flat.txt -o flat.rcg
claim "an undefined Str of a flat has one too" says '^  Str +not defined: the map is flat$' rc-info --areal flat.rcg

# ---- a misspelt name ----

rc-solve --quiet --periodic --estar 1GPa --load 1mN,2mN --report r.tsv -o p.rcg rough.rcg
meant() { refuses "$1" "did you mean $2\?$" "$3" "$4"; }
meant 1 contact_area "a column: a part of its name" "rc-render --curve load:area -o never.png r.tsv"
meant 1 gap "a channel of rc-render" "rc-render --channel gpa -o never.png p.rcg"
meant 1 pressure "  of rc-pick" "rc-pick --channel gap,presure -o never.rcg p.rcg"
meant 1 displacement "  of rc-export" "rc-export --format csv --channel displacment p.rcg"
meant 1 height "  of rc-import" "rc-import --channel hieght $RC_SOURCE/sample_surfaces/rough-steel.x3p -o never.rcg"
meant 2 mises "a component" "rc-stress --nu 0.3 --depths 0 --components szz,misses -o never.rcg p.rcg"
meant 2 pcg "a word of an option" "rc-solve --method pgc --load 1 --estar 1GPa -o never.rcg rough.rcg"
refuses 1 'no frame with the channel wear, only pressure, gap, displacement, height$' "none where no name is near" \
    "rc-render --channel wear -o never.png p.rcg"

claim "--list prints rounded numbers" eval 'perl -e "print \"# Width: 3 um\n# Height: 3 um\n# Value units: nm\n\"; print 1/3, \" 2 3\n4 5 6\n7 8 \", 20/3, \"\n\"" >third.txt &&
    says " 3.33333e-10 +8e-09 " rc-import --list third.txt'
