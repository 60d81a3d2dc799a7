# SPDX-License-Identifier: GPL-3.0-or-later
# rc-solve --adhesion: a ball that is pressed, pulled and pulled off; balance of loads; paths; frames; the
# curve; warnings and refusals.
. "$(dirname "$0")/../pipe.sh"

column() { # NAME ROW FILE
    awk -F '\t' -v n="$1" -v r="$2" 'NR == 1 { for (i = 1; i <= NF; i++) { split($i, h, "/"); if (h[1] == n) c = i } } NR == r + 1 { print $c }' "$3"
}
sum() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.12g", a + b }'; }
unit=$(awk 'BEGIN { printf "%.12g", 3.14159265358979 * 0.05 * 1e-3 }') # pi w R
times() { awk -v f="$1" -v u="$unit" 'BEGIN { printf "%.12g", f * u }'; }

rc-synth sphere --nx 64 --dx 3um --radius 1mm -o ball.rcg
rc-synth wave --nx 64 --dx 3um --amplitude 1fm --wavelength 192um -o flat.rcg
soft="rc-solve --quiet --estar 2MPa"

# ---- a ball: pressed, pulled, pulled off ----

$soft --adhesion 50mJ/m2,jkr --approach=-1um,2um,-1um,0 --pull-off --output pressure,gap,displacement,height,adhesion --report p.tsv ball.rcg -o p.rcg
claim "a list is a path, and pull-off is an additional case" test "$(wc -l <p.tsv)" = 6
for row in 1 2 3 4 5; do
    near "$(column load $row p.tsv)" "$(sum "$(column repulsive_load $row p.tsv)" "-$(column attractive_load $row p.tsv)")" 1e-9 "state $row: what pushes less what pulls is the load"
    claim "  the state is stable and converged" test "$(column stable $row p.tsv) $(column converged $row p.tsv)" = "yes true"
done
near "$(column approach 2 p.tsv)" 2e-6 1e-9 "the approach that was asked for"
between "$(times -1.65)" "$(column pull_off_load 5 p.tsv)" "$(times -1.5)" "pulled off at little more than 3/2 pi w R: a range that the grid holds"
between 0 "$(column pull_off_spread 5 p.tsv)" "$(times 0.02)" "  and that is known to a percent"
claim "  without --adhesion the figure is null" test "$(column pull_off_load 1 p.tsv)" = NaN
claim "on separation the ball stays in contact at approaches without contact before" awk -v a="$(column contact_area 1 p.tsv)" -v b="$(column contact_area 3 p.tsv)" 'BEGIN { exit !(b >= a) }'
near "$(rc-pick --channel pressure --case 2 p.rcg | rc-info --json | grep -o '"mean": [^,]*' | head -n 1 | sed 's/.* //' | awk '{ print $1 * 4096 * 9e-12 }')" \
    "$(column load 2 p.tsv)" 1e-6 "the pressures in the stream carry the load"
claim "gaps are never negative" awk -v m="$(rc-pick --channel gap --case 3 p.rcg | rc-info --json | grep -o '"min[a-z]*": [^,]*' | head -n 1 | sed 's/.* //')" 'BEGIN { exit !(m >= 0) }'
claim "the frames have the key of the attraction" says "adhesion" rc-info p.rcg

$soft --adhesion 50mJ/m2,jkr --approach 2um --pull-off --output pressure --report two.tsv ball.rcg -o two.rcg
claim "  it is named as the pull-off, not as a load" bash -c "rc-solve --verbose --estar 2MPa --adhesion 50mJ/m2,jkr --approach 2um --pull-off --report two.tsv ball.rcg -o two.rcg 2>said; grep -q 'case 2, pull-off: pull-off at .*on a retraction from approach 2 um' said"
claim "  and no approach was asked of it" test "$(column asked_approach 1 two.tsv) $(column asked_approach 2 two.tsv)" = "2e-06 NaN"
# lists that pass the pull-off themselves: the bodies apart, in contact beyond it, separated by a load, and apart since
for list in --approach=2um,0,-1.5um,-3um --approach=2um,-1.2um --load=0.2mN,-0.1mN,-0.5mN --load=0.2mN,-0.5mN,-0.1mN,0; do
    rm -f passed.rcg
    $soft --adhesion 50mJ/m2,jkr "$list" --pull-off --checkpoint passed.rcg --report passed.tsv ball.rcg -o x.rcg
    rows=$(($(wc -l <passed.tsv) - 1))
    between -1 "$(awk -v a="$(column pull_off_load $rows passed.tsv)" -v b="$(column pull_off_load 2 two.tsv)" -v s="$(column pull_off_spread $rows passed.tsv)" -v t="$(column pull_off_spread 2 two.tsv)" 'BEGIN { print (a - b) / (s + t) }')" 1 \
        "$list passes the pull-off, and --pull-off finds its load from the last contact"
    near "$(column load $rows passed.tsv)" "$(column pull_off_load $rows passed.tsv)" 0.01 "  with the state of that load"
    $soft --adhesion 50mJ/m2,jkr "$list" --pull-off --checkpoint passed.rcg --resume --report resumed.tsv ball.rcg -o x.rcg
    near "$(column pull_off_load $rows resumed.tsv)" "$(column pull_off_load $rows passed.tsv)" 2e-3 "  a checkpoint has that contact"
done
claim "a retraction of bodies that never touched does not know its load" warns 'the pull-off load is unknown, because the retraction begins at .*beyond it' \
    bash -c "${soft/--quiet /} --adhesion 50mJ/m2,jkr --approach=-2um,-3um --pull-off --report beyond.json -o beyond.rcg ball.rcg"
claim "  and says null" grep -q '"pull_off_load": null' beyond.json
claim "  a separation with --pull-off is not told to take it" bash -c "rc-solve --estar 2MPa --adhesion 50mJ/m2,jkr --load=0.2mN,-0.5mN --pull-off ball.rcg -o s.rcg 2>said; grep -q 'because no state carries this load$' said"
claim "one state and its pull-off are two cases" test "$(rc-info --json two.rcg | grep -o '"case": [0-9]' | sort -u | tr -d '\n')" = '"case": 1"case": 2'

# ---- the same in other words ----

$soft --adhesion 50mN/m,jkr --radius 1mm --approach 2um --report a.json flat.rcg -o a.rcg
$soft --adhesion 0.05,jkr --radius 1mm --approach 2000nm --report b.json flat.rcg -o b.rcg
claim "50 mJ/m2, 50 mN/m and 0.05 are equal" cmp <(rc-pick --channel pressure a.rcg | rc-export --format csv) <(rc-pick --channel pressure b.rcg | rc-export --format csv)
near "$(field adhesion_work a.json)" 0.05 "$same" "  and the report says it"
near "$(field tabor a.json)" "$(awk -v r="$(field adhesion_range a.json)" 'BEGIN { printf "%.12g", (1e-3 * (0.05 / 2e6) ^ 2) ^ (1 / 3) / r }')" 1e-9 "  and Tabor's number is that of the ball"
claim "  and the pull-off of the theories for this ball, 3/2 and 2 pi w R" grep -q '"adhesion": "on: jkr.* pulls off at 235.6[0-9]* uN by JKR and 314.1[0-9]* uN by DMT' a.json

# ---- the ball of rc-synth ----

exponential="rc-solve --quiet --estar 60GPa --adhesion 50mJ/m2,exponential,1nm --load 1nN"
rc-synth sphere --nx 64 --dx 0.5nm --radius 20nm -o tip.rcg
$exponential --report tip.json -o tip-on.rcg tip.rcg
near "$(field tabor tip.json)" "$(awk 'BEGIN { printf "%.12g", (20e-9 * (0.05 / 60e9) ^ 2) ^ (1 / 3) / 1e-9 }')" 1e-9 "Tabor's number of the ball of rc-synth needs no --radius"
claim "  the line of adhesion has its radius and both pull-off loads" grep -q 'a smooth ball of 20 nm radius pulls off at 4.71239 nN by JKR and 6.28319 nN by DMT' tip.json
line_of() { rc-solve --estar 60GPa --adhesion 50mJ/m2,exponential,1nm --load 1nN --dry-run "$1" | grep '  adhesion'; }
claim "  --dry-run has them too" says 'of 20 nm radius pulls off at 4.71239 nN by JKR' line_of tip.rcg
rc-synth selfaffine --hurst 0.8 --rms-height 0.05nm --rolloff 8nm --nx 64 --dx 0.5nm -o bumps.rcg
rc-add --quiet tip.rcg bumps.rcg -o bumpy.rcg
claim "  a rough tip has those of its ball, and its distance from it" says 'of 20 nm radius \(these heights differ from it by up to [12][0-9.]* pm\) pulls off at 4.71239 nN' line_of bumpy.rcg
rc-detrend --sphere bumpy.rcg -o none.rcg
claim "  without its sphere it has no radius" says "Tabor's number needs --radius or --cylinder" line_of none.rcg
for step in "--poly 2" "--cylinder" "--highpass 8nm"; do
    claim "  rc-detrend $step removes the key" bash -c "! rc-detrend $step bumpy.rcg | strings | grep -q '^form=' && rc-detrend --plane bumpy.rcg | strings | grep -q '^form=sphere 2e-08$'"
done
for form in "sphere 18nm" "sphere 1um" "sphere -20nm" "sphere" "cylinder 2e-08" "sphere 2e-08 + sphere 2e-08"; do
    rc-pick --set "form=$form" tip.rcg -o wrong.rcg
    $exponential --report wrong.json -o wrong-on.rcg wrong.rcg
    claim "a wrong key, form=$form, gives no Tabor's number" grep -q '"tabor": null' wrong.json
done
rc-pick --set form="sphere 17nm" tip.rcg -o wrong.rcg
claim "  the line has the radii of the heights" says "no Tabor's number: by the key form=sphere 17nm the heights are a ball, but their radii of curvature are 20 nm along x and 20 nm along y" line_of wrong.rcg
rc-synth paraboloid --nx 64 --dx 0.5nm --radius 20nm,25nm | rc-pick --set form="sphere 20nm" -o wrong.rcg
claim "  also where they differ along one axis" says "but their radii of curvature are 20 nm along x and 25 nm along y" line_of wrong.rcg
refuses 1 'a sphere was already added to these heights \(form=sphere 2e-08\): remove --radius' "a second sphere is not added to it" "$exponential --radius 20nm tip.rcg -o x.rcg"
claim "  except to one that is flat beside it, whose key it replaces" bash -c "rc-synth sphere --nx 64 --dx 0.5nm --radius 1m | $exponential --radius 20nm --output height | strings | grep -q '^form=sphere 2e-08$'"
claim "  and of a body that travels, which has a form of its own" bash -c "rc-solve --quiet --estar 60GPa --load 1uN --radius 40nm --travel 0 --output height tip.rcg | strings | grep -q '^form=sphere 2e-08 + sphere 4e-08$'"
claim "without --adhesion its figures are null, with the reason" bash -c '
    rc-solve --quiet --estar 2MPa --load 1mN --report none.json ball.rcg -o none.rcg
    grep -q "\"adhesion\": \"left out: no --adhesion\"" none.json && grep -q "\"adhesion_work\": null" none.json'

# ---- the range that the grid sets ----

# silicon on silica, 0.3 nm: Tabor 0.09 and DMT, 2 pi w R = 6.28 nN; the grid's range of 14 pm: JKR, 4.71 nN
rc-synth sphere --nx 128 --dx 0.1nm --radius 20nm -o fine.rcg
glass="--body1 silicon --body2 fused-silica --load 5nN"
rc-solve $glass --adhesion 50mJ/m2 --pull-off --report own.tsv fine.rcg -o x.rcg 2>own.said
rc-solve $glass --adhesion 50mJ/m2,exponential,0.3nm --pull-off --report real.tsv fine.rcg -o x.rcg 2>real.said
near "$(column adhesion_range 1 own.tsv)" 1.43e-11 0.01 "the default range is in the report"
near "$(column tabor 1 real.tsv)" 0.09 0.02 "Tabor's number at a real range"
between -6.283e-9 "$(column pull_off_load 2 real.tsv)" -5.97e-9 "  with the pull-off of DMT theory, nearly"
between -5.1e-9 "$(column pull_off_load 2 own.tsv)" -4.7e-9 "  and not at the default range, with that of JKR theory"
claim "  a warning names the default range, its reason, and atoms" grep -q \
    'the range of adhesion, 14[0-9.]* pm, the default for this grid (a cohesive length of 2 nodes), is below the spacing of atoms: .* as --adhesion 50mJ/m2,exponential,0.3nm$' own.said
claim "  a real range causes none" bash -c '! grep -q "range of adhesion" real.said'
claim "  a range given below that of atoms causes one too" warns "the range of adhesion, 50 pm, is below the spacing of atoms" rc-solve $glass --adhesion 50mJ/m2,exponential,50pm fine.rcg -o x.rcg
claim "  so does the law jkr, without another spacing" bash -c "rc-solve $glass --adhesion 50mJ/m2,jkr fine.rcg -o x.rcg 2>said; grep -q 'below the spacing of atoms' said && ! grep -q 'take a spacing' said"
claim "a default range with Tabor's number below 3 causes a warning" warns "the range of adhesion, 387[0-9.]* nm, the default for this grid .* changes loads and areas, because Tabor's number is 2.2, below 3: .* take a spacing of 1.[0-9]* um" rc-solve --estar 2MPa --adhesion 50mJ/m2 --load 0 ball.rcg -o x.rcg
claim "  at larger numbers a note has it" bash -c "rc-solve --verbose --estar 0.2MPa --adhesion 50mJ/m2 --load 0 ball.rcg -o x.rcg 2>said; grep -q 'the range of adhesion is .* um, the default for this grid (a cohesive length of 2 nodes), as none is given' said"
claim "a work without unit causes a warning with the unit" bash -c "rc-solve $glass --adhesion 50 fine.rcg -o x.rcg 2>said; grep -q 'the work of adhesion, 50 J/m2, is far above that of clean surfaces, about 0.01 to 10 J/m2: was the unit forgotten, as in --adhesion 50mJ/m2' said && ! grep -q 'is the range right' said"
claim "  that of a tape, with its unit, causes none" bash -c "rc-solve --estar 200MPa --radius 1m --adhesion 100J/m2,jkr --load 0 ball.rcg -o x.rcg 2>said; ! grep -q 'work of adhesion' said"

# ---- loads ----

$soft --adhesion 50mJ/m2,jkr --load 0.2mN,0,-0.1mN --report l.tsv ball.rcg -o l.rcg
near "$(column load 3 l.tsv)" -1e-4 1e-3 "a load that pulls is carried, to the tolerance"
$soft --adhesion 50mJ/m2,jkr --load 0.2mN,-0.5mN --report s.tsv ball.rcg -o s.rcg
status=$?
claim "a load below pull-off separates the bodies, with exit status 3" test "$status $(column separated 2 s.tsv)" = "3 yes"
claim "  a message says so" bash -c "rc-solve --estar 2MPa --adhesion 50mJ/m2,jkr --load 0.2mN,-0.5mN ball.rcg -o s.rcg 2>said; grep -q 'the bodies have separated, because no state carries this load' said"
rc-solve --verbose --estar 2MPa --adhesion 50mJ/m2,jkr --load=0,-0.5mN,-0.1mN,0,0.1mN --report s.tsv ball.rcg -o s.rcg 2>said
status=$?
claim "separated bodies stay apart under a tensile load above pull-off and at 0, until a load presses them" \
    test "$status $(for k in 1 2 3 4 5; do column separated $k s.tsv; column converged $k s.tsv; done | tr '\n' ' ')" = \
    "3 no true yes false yes false yes true no true "
claim "  their force is 0, in the report, in the note and in the frames" bash -c '
    test "$(rc-info --json s.rcg | grep -c "\"load\": 0,")" -ge 3 && ! grep "load -0.5 mN: force" said' 
claim "  the message of the later load has its reason" bash -c "grep -q 'load -100 uN: the bodies separated at an earlier load, and separated bodies carry no tensile load: list the loads' said && ! grep -q 'load -100 uN: .*no state carries' said && ! grep -q 'load 0 N: not converged' said"
for row in 2 3 4; do
    claim "  row $row has load 0" test "$(column load $row s.tsv)" = 0
done
claim "  their approach and mean gap are unknown" test "$(column approach 2 s.tsv) $(column mean_gap 3 s.tsv) $(column contact_area 2 s.tsv)" = "NaN NaN 0"
claim "  rc-info, rc-render and their warning say separated" bash -c "rc-pick --case 2 s.rcg -o two.rcg 2>pick.said; rc-info two.rcg >info.txt 2>info.said; test \$? = 3 && grep -q '^  separated  yes' info.txt && ! grep -q 'stopped short' info.txt info.said && grep -q 'the bodies have separated (separated=yes)' info.said && rc-render --channel gap -o two.svg two.rcg 2>two.said; test \$? = 3 && grep -q 'separated' two.svg && ! grep -q 'not converged' two.svg"
claim "  without adhesion their heights have no such key" bash -c "rc-pick --case 2 --channel height s.rcg -o height.rcg 2>pick.said; rc-solve --quiet --estar 2MPa --load 1mN -o pressed.rcg height.rcg; strings pressed.rcg >pressed.txt; strings height.rcg | grep '^separated=yes' && grep -q '^boundary=free' pressed.txt && ! grep -q '^separated=' pressed.txt"
drawn() { # CURVE WORD: 1 if the legend has the word
    rc-render --curve "$1" -o drawn.svg s.tsv 2>drawn.said
    status=$?
    grep -c ">$2<" drawn.svg
}
claim "  curves say separated, and not that rows stopped short" bash -c "rc-render --curve load:contact_area -o drawn.svg s.tsv 2>drawn.said; test \$? = 3 && grep -q 'in 2 of the rows the bodies have separated' drawn.said && ! grep -q 'short' drawn.said && ! grep -q 'not converged' drawn.svg"
claim "  a curve of the area has the jump to area 0, from a state of loading" test "$(drawn load:contact_area jump) $(drawn load:contact_area retraction) $(drawn load:contact_area loading)" = "1 1 1"
claim "  one of the radius, which they do not have, has none" test "$(drawn load:contact_radius jump)" = 0
claim "  and one of the approach has none" test "$(drawn approach:load jump)" = 0
$soft --adhesion 50mJ/m2,jkr --load 0.1mN --report one.tsv ball.rcg -o one.rcg
near "$(column contact_area 5 s.tsv)" "$(column contact_area 1 one.tsv)" 0.02 "  a later contact is that of fresh bodies"

# ---- a cylinder: the map repeats along its axis ----

rc-synth wave --nx 128 --ny 3 --dx 2um --amplitude 1fm --wavelength 256um -o long.rcg
rc-synth wave --nx 3 --ny 128 --dx 2um --amplitude 1fm --wavelength 0.256mm -o tall.rcg
roller="$soft --cylinder 1mm --adhesion 50mJ/m2"
$roller,jkr --periodic=y --approach 0 --pull-off --report y.tsv long.rcg -o y.rcg
$roller,jkr --periodic=x --approach 0 --pull-off --report x.tsv tall.rcg -o x.rcg
limit=$(awk 'BEGIN { printf "%.12g", -0.75 * (4 * 3.14159265358979 * 2e6 * 0.05 ^ 2 * 1e-3) ^ (1 / 3) }')
near "$(column load_per_metre 2 y.tsv)" "$limit" 0.02 "a cylinder comes off at 3/4 (4 pi E* w^2 R)^(1/3) per metre"
near "$(column load_per_metre 2 x.tsv)" "$(column load_per_metre 2 y.tsv)" 1e-5 "  along the other axis too"
near "$(column cohesive_nodes 1 y.tsv)" 4 1e-9 "the default range is twice as long there"
near "$(column tabor 1 y.tsv)" "$(awk -v r="$(column adhesion_range 1 y.tsv)" 'BEGIN { printf "%.12g", (1e-3 * (0.05 / 2e6) ^ 2) ^ (1 / 3) / r }')" 1e-9 "Tabor's number is that of the cylinder"
claim "a cohesive length of 2 nodes is too short there" warns "the cohesive length, .*, is 2 of the spacing: .*take a spacing of 1 um" rc-solve --estar 2MPa --cylinder 1mm --periodic=y --adhesion 50mJ/m2,exponential,316.2278nm --approach 0 long.rcg -o w.rcg
$roller,jkr --periodic=y --load 0 --report d1.tsv long.rcg -o d1.rcg
$roller,jkr --periodic=y --datum 1mm --load 0 --report d2.tsv long.rcg -o d2.rcg
near "$(column contact_area 1 d2.tsv)" "$(column contact_area 1 d1.tsv)" 1e-9 "under a load the datum does not change the contact"
refuses 1 "datum 2e-05 m: with adhesion it must not be so far below the length of the map" "a datum that is too short is refused by name" \
    'rc-solve --estar 2MPa --cylinder 1mm --periodic=y --datum 20um --adhesion 50mJ/m2,jkr --approach 0 long.rcg -o w.rcg'

# ---- a list with a large step ----

rc-synth wave --nx 128 --ny 1 --dx 7.8125um --amplitude 5um --wavelength 1mm -o wave.rcg
wave="rc-solve --quiet --periodic --estar 1MPa --adhesion 1.2337mJ/m2,jkr"
$wave --mean-pressure 785.4,7854 --report large.tsv wave.rcg -o large.rcg
near "$(column contact_fraction 2 large.tsv)" 0.572 0.03 "a path of one large step follows its branch (Johnson 1995: 0.572)"
claim "  without a jump" test "$(column jumps 2 large.tsv) $(column stable 2 large.tsv)" = "0 yes"

# ---- an interrupted run ----

path="--adhesion 50mJ/m2,jkr --approach=-1um,2um,1um,0"
$soft $path --pull-off --report straight.tsv ball.rcg -o straight.rcg
$soft --adhesion 50mJ/m2,jkr --approach=-1um,2um --checkpoint half.rcg ball.rcg -o x.rcg # as after a power failure: the file ends after two states
$soft $path --pull-off --checkpoint half.rcg --resume --report on.tsv ball.rcg -o on.rcg
for row in 1 2 3 4 5; do
    near "$(column load $row on.tsv)" "$(column load $row straight.tsv)" 2e-3 "gone on with, state $row is the same"
done
near "$(column pull_off_load 5 on.tsv)" "$(column pull_off_load 5 straight.tsv)" 2e-3 "  and so is the pull-off"
between 0 "$(column iterations 2 on.tsv)" 3 "  what was there is not found again"
$soft --adhesion 50mJ/m2,jkr --load=0,-0.5mN,-0.1mN --checkpoint apart.rcg ball.rcg -o x.rcg
$soft --adhesion 50mJ/m2,jkr --load=0,-0.5mN,-0.1mN,0 --checkpoint apart.rcg --resume --report on.tsv ball.rcg -o on.rcg
claim "bodies that separated before an interruption stay apart" test "$(for k in 3 4; do for c in separated iterations load; do column $c $k on.tsv; done; done | tr '\n' ' ')" = "yes 0 0 yes 0 0 "
refuses 1 'another problem: --adhesion was 50mJ/m2,jkr, is 40mJ/m2,jkr' "a checkpoint of another attraction" \
    "$soft --adhesion 40mJ/m2,jkr --approach=-1um,2um --checkpoint half.rcg --resume ball.rcg -o y.rcg"
refuses 1 'another problem: --adhesion was 50mJ/m2,jkr, is not given' "  of none" \
    "$soft --approach 1um,2um --checkpoint half.rcg --resume ball.rcg -o y.rcg"
refuses 1 'another problem: approach was -1e-06, is -2e-06' "  of another way" \
    "$soft --adhesion 50mJ/m2,jkr --approach=-2um,2um --checkpoint half.rcg --resume ball.rcg -o y.rcg"

# ---- later tools ----

claim "rc-stress reads the net pressure" bash -c "rc-pick --case 2 p.rcg | rc-stress --quiet --nu 0.49 --depths 0 --components szz -o z.rcg"
near "$(rc-info --json z.rcg | grep -o '"max[a-z]*": [^,]*' | head -n 1 | sed 's/.* //')" "$(awk -v m="$(column min_pressure 2 p.tsv)" 'BEGIN { print -m }')" 1e-3 "  tension where it pulls"
claim "the colours of net pressures are symmetric about 0" rc-render --case 2 --channel pressure -o net.png p.rcg
claim "the path is drawn as a curve" bash -c "rc-render --curve approach:load -o path.svg p.tsv && grep -q retraction path.svg && grep -q loading path.svg"
# 247 uN is drawn by no line: the path ends at the last approach of the list.
claim "  no line joins the pull-off to it: a mark of its own" bash -c 'grep -q ">pull-off<" path.svg && perl "$RC_SOURCE/tests/tools/points.pl" <path.svg >points.txt && grep -q "solid.* -215\.9[0-9]*$" points.txt &&
    ! grep -q "solid.*-247\.3" points.txt'
claim "  in other curves too" bash -c "rc-render --curve case:contact_area -o case.svg p.tsv && grep -q '>pull-off<' case.svg && perl \"\$RC_SOURCE/tests/tools/points.pl\" <case.svg >points.txt && ! grep -q 'solid.* 5 [-0-9.e]*\$' points.txt"

# ---- plan, warnings and refusals ----

claim "--dry-run names the law and the cohesive length" says 'adhesion  *on: exponential, 0.05 J/m2 over 300 nm.*cohesive length' rc-solve --dry-run --estar 2MPa --adhesion 50mJ/m2,exponential,300nm --approach 1um ball.rcg
claim "  it counts no stiffness of a list" says 'stiffness  *left out: the bodies attract' rc-solve --dry-run --estar 2MPa --adhesion 50mJ/m2,exponential,300nm --approach 1um,2um ball.rcg
claim "a grid that does not resolve the range causes a warning" warns "the grid is too coarse for this law.*lattice pinning" rc-solve --estar 2MPa --adhesion 50mJ/m2,exponential,100nm --approach 1um ball.rcg -o w.rcg
advice=$(rc-solve --estar 2MPa --adhesion 50mJ/m2,exponential,100nm --approach 1um ball.rcg -o w.rcg 2>&1 | grep -o -- '--adhesion [^ ]*$')
claim "  its advice is a command without this warning" bash -c "test '$advice' = '--adhesion 50mJ/m2,exponential,387nm' && rc-solve --estar 2MPa $advice --approach 1um ball.rcg -o w.rcg 2>said && ! grep -q 'too coarse' said"
claim "a range too long for JKR theory causes a warning" warns "Tabor's number is 2.2, below 3: .*take a spacing of 1.6" rc-solve --estar 2MPa --adhesion 50mJ/m2,jkr --radius 1mm --approach 1um flat.rcg -o w.rcg
rc-synth wave --nx 128 --dx 1.5um --amplitude 1fm --wavelength 192um -o fine.rcg
claim "  a finer grid causes none" bash -c "rc-solve --estar 2MPa --adhesion 50mJ/m2,jkr --radius 1mm --approach 1um fine.rcg -o w.rcg 2>said; ! grep -q Tabor said"
claim "without a radius the report says why Tabor's number is missing" grep -q "Tabor's number needs --radius" <(rc-solve --quiet --estar 2MPa --adhesion 50mJ/m2,jkr --approach=-1nm flat.rcg --report -)
$soft --adhesion 50mJ/m2,jkr --approach 1um,2um --history --output gap ball.rcg -o h1.rcg
$soft --adhesion 50mJ/m2,jkr --approach 1um,2um --output gap ball.rcg -o h2.rcg
claim "--history does not change a path" cmp <(rc-pick --channel gap --case 2 h1.rcg | rc-export --format csv -o h1.csv && cat h1.csv) <(rc-pick --channel gap --case 2 h2.rcg | rc-export --format csv -o h2.csv && cat h2.csv)
claim "  the same holds for approaches" test -s h1.csv
refused() { # STATUS WORDS ARGS
    refuses "$1" "$2" "refused: $3" "rc-solve --quiet --estar 2MPa $3 ball.rcg -o x.rcg"
}
refused 2 "it must be at least 0: a negative load needs --adhesion" "--load=-1mN"
refused 2 "--pull-off has no effect without --adhesion" "--load 1mN --pull-off"
refused 2 "output adhesion needs --adhesion" "--load 1mN --output adhesion"
refused 2 "must be above 0" "--adhesion 0 --approach 1um"
refused 2 "must be above 0" "--adhesion=-50mJ/m2 --approach 1um"
refused 2 "there is no law 'JKR': write jkr$" "--adhesion 50mJ/m2,JKR --approach 1um"
refused 2 "no law 'DMT': .*jkr: DMT is the limit of a range that is long .*: take exponential" "--adhesion 50mJ/m2,DMT --approach 1um"
refused 2 "there is no law 'velcro': it must be one of exponential, dugdale, compact, jkr" "--adhesion 50mJ/m2,velcro --approach 1um"
refused 2 "J/m2 is expected, .* or N/m" "--adhesion 50mJ,jkr --approach 1um"
refused 2 "adhesion does not work with --tilt free" "--adhesion 50mJ/m2 --approach 1um --tilt free"
refused 1 "the map carries .* lower the load or raise the hardness" "--adhesion 50mJ/m2,jkr --hardness 1MPa --load 1N"
refused 2 "use a list of --approach values" "--adhesion 50mJ/m2 --approach 1um --stiffness"
refused 1 "" "--adhesion 50mJ/m2 --approach 1um --method pk99"
refused 1 "" "--adhesion 50mJ/m2 --approach 1um --kernel mlms"
refused 1 "" "--adhesion 50mJ/m2 --approach 1um --kernel direct"
