# SPDX-License-Identifier: GPL-3.0-or-later
# rc-fatigue: a ball that rolls, in SI; positions and a pass agree; limits of materials and of a table, residual
# stress, reports, pictures; every wrong command line and stream is refused with its reason.
. "$(dirname "$0")/../pipe.sh"

limits="--bending-limit 600MPa --torsion-limit 372MPa"
pass="rc-fatigue --quiet $limits --pass x"
steel="--E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3"
rc-synth sphere --nx 48 --ny 48 --dx 3um --radius 3mm -o ball.rcg
rc-solve --quiet $steel --load 1N -o pressed.rcg ball.rcg
json() { # EXPRESSION FILE: its value; .by_depth.dangvan[1] is a field of the object
    perl -MJSON::PP -MList::Util=max -e 'my $e = shift; local $/; my $r = decode_json(<>);
        $e =~ s{((?:\.[a-z_]+)+)}{"\$r->" . join("", map { "{$_}" } grep { length } split(/[.]/, $1))}ge; print eval($e), "\n"' "$1" "$2"
}
column() { # NAME ROW FILE: a number of a table
    awk -F'\t' -v name="$1" -v row="$2" 'NR == 1 { for (k = 1; k <= NF; k++) { sub("/.*", "", $k); if ($k == name) c = k } }
        NR == row + 1 { print $c }' "$3"
}

# ---- a ball ----

a=$(awk 'BEGIN { printf "%.9g", (3 * 1 * 3e-3 / (4 * 115384615384.6)) ^ (1/3) }') # Hertz
p0=$(awk "BEGIN { printf \"%.9g\", 1.5 / (3.14159265 * $a * $a) }")
$pass --yield 1GPa --depths "$(awk "BEGIN { print .3 * $a \",\" .35 * $a \",\" .4 * $a }")" \
    --criteria crossland,dangvan,findley,shakedown,amplitude --planes --report ball.json \
    --by-depth depths.tsv -o fatigue.rcg pressed.rcg
near "$(json .amplitude ball.json)" "$(awk "BEGIN { print .2138 * $p0 }")" 2e-2 "amplitude of a ball"
near "$(json .amplitude_depth ball.json)" "$(awk "BEGIN { print .35 * $a }")" 1e-9 "  at 0.35 a"
near "$(json .crossland ball.json)" "$(json '.amplitude / 372e6' ball.json)" 1e-9 "Crossland: the unloaded state has h = 0"
near "$(json .safety ball.json)" "$(json '1 / max(.crossland, .dangvan, .findley, .shakedown)' ball.json)" 1e-12 "safety"
near "$(json .by_depth.dangvan[1] ball.json)" "$(json .dangvan ball.json)" 1e-12 "by depth"
near "$(column dangvan 2 depths.tsv)" "$(json .dangvan ball.json)" 1e-12 "  and as a table"
claim "a frame for each criterion, and two for the planes" [ "$(rc-info fatigue.rcg | grep -c "^sphere, case 1")" = 7 ]
claim "  a section whose rows are depths" [ "$(rc-info fatigue.rcg | grep -cE 'grid  *48 x 3 nodes|section=x')" = 14 ]
near "$(json .maximum <(rc-pick --channel amplitude fatigue.rcg | rc-info --json -))" "$(json .amplitude ball.json)" 1e-12 "  with the value of the report"
claim "a picture of a section" rc-render --channel dangvan -o section.png fatigue.rcg
claim "  and the index over depth" rc-render --curve depth:dangvan,crossland -o curve.svg depths.tsv
claim "    with its title" grep -q 'Index of' curve.svg
$pass --depths 5um --report y.json -o y.rcg pressed.rcg
rc-fatigue --quiet $limits --pass y --depths 5um --report x.json -o x.rcg pressed.rcg
near "$(json .dangvan y.json)" "$(json .dangvan x.json)" 1e-6 "along y the same"
rc-fatigue --quiet $limits --dangvan full --pass x --depths 5um --report full.json -o x.rcg pressed.rcg
between 0 "$(json .dangvan full.json)" "$(json '.dangvan * 0.9' y.json)" "--dangvan full is lower"
claim "limits without a unit cause a warning" warns 'a limit of 400 Pa is below a ten-thousandth .* as in 650MPa' \
    rc-fatigue --bending-limit 650 --torsion-limit 400 --pass x --depths 5um -o x.rcg pressed.rcg
claim "a list of loads has a result each" bash -c "
    rc-solve --quiet $steel --load 0.5N,1N ball.rcg | $pass --depths 5um --report two.tsv -o two.rcg"
near "$(column dangvan 2 two.tsv)" "$(json .dangvan y.json)" 1e-4 "  the second is that of its load"
claim "--depths auto" $pass --depths auto --report auto.json -o auto.rcg pressed.rcg
claim "  begins below half a node" [ "$(json '.depth_list[0] >= 1.5e-6' auto.json)" = 1 ]
claim "the plan" says 'histories *48 at each depth' rc-fatigue $limits --pass x --depths 5um --dry-run pressed.rcg
$pass --depths 5um,6um,9um --life 10.3333333333 --report life.json -o x.rcg pressed.rcg
$pass --depths 5um,6um,9um --life 10.3333333333,0,100e6 --report above.json -o x.rcg pressed.rcg
between 0 "$(json .stressed_volume above.json)" "$(json .stressed_volume life.json)" "stressed volume above a threshold"

# ---- a roller ----

# Hertz's line contact, p0 = sqrt(P' E*/(pi R)) and a = 2 P'/(pi p0): the orthogonal shear stress is p0/4 at a/2.
a=105.682e-6 p0=602389633
rc-synth cylinder --radius 10mm --nx 160 --ny 160 --dx 2um --direction 90 | rc-pick --crop 0,0,160,4 |
    rc-solve --quiet --periodic=y --load 1e5N/m --estar 114GPa --output pressure -o roller.rcg
rolls="rc-fatigue --nu 0.3 $limits --depths 40um:66um:27 --criteria crossland,amplitude"
claim "a roller passes" $rolls --quiet --pass x --report roller.json -o x.rcg roller.rcg
near "$(json .amplitude roller.json)" "$(awk "BEGIN { print .25 * $p0 }")" 1e-3 "  its amplitude"
near "$(json .amplitude_depth roller.json)" "$(awk "BEGIN { print .5 * $a }")" 2e-2 "  at half of the half-width"
near "$(json .crossland roller.json)" "$(json '.amplitude / 372e6' roller.json)" 1e-9 "  Crossland: the unloaded state has h = 0"
claim "a pass along it has no amplitude, and causes a warning" warns 'the map repeats along the travel, and the points never unload' \
    $rolls --pass y --report along.json -o x.rcg roller.rcg
between 0 "$(json .amplitude along.json)" 1e3 "  but rounding, Pa"
# Every load is met by each node, and the unloaded state belongs to a contact that stays.
rc-fatigue --quiet --nu 0.3 $limits --depths 52um --criteria amplitude --report stays.json -o x.rcg roller.rcg
claim "loads of a roller that stays begin at none" [ "$(json .states stays.json)" = 2 ]
# The contact of the roller itself, at 81 positions over a flat: a = 57.5 um.
rc-synth wave --nx 160 --ny 2 --dx 2um --amplitude 1e-15 --wavelength 80um |
    rc-solve --quiet --periodic=y --cylinder 10mm --load 3e4N/m $steel --travel=-80um:80um:81 --window 100x2 --output pressure -o travels.rcg
rc-fatigue --quiet $limits --depths 24um,28.8um,34um --criteria amplitude --report travels.json -o x.rcg travels.rcg
near "$(json .amplitude travels.json)" "$(awk 'BEGIN { print .25 * sqrt(3e4 * 115384615384.6 / (3.14159265 * 10e-3)) }')" 2e-3 "a roller that travels has the amplitude of a pass"
claim "  with the unloaded state" [ "$(json .states travels.json)" = 82 ]

# ---- positions ----

# The pressure of one window, at each column: the middle column of the body sees a whole row.
moved() {
    local k
    for k in $(seq 0 47); do
        rc-pick --channel pressure --set position="$(awk "BEGIN { print ($k - 20) * 3e-6 }")" pressed.rcg >"moved-$k.rcg"
        moved+=("moved-$k.rcg")
    done
}
moved=()
moved
rc-fatigue --quiet $limits --depths 5um --report moved.json -o moved.rcg "${moved[@]}"
claim "positions: the columns that a case covers" [ "$(rc-info moved.rcg | grep -c '95 x 48 nodes')" = 3 ]
claim "  one history" [ "$(json .positions moved.json)" = 48 ]
near "$(json .maximum <(rc-pick --channel dangvan --crop 47,0,1,48 moved.rcg | rc-info --json -))" "$(json .dangvan y.json)" 1e-5 "  a node over which the contact goes has the index of the pass"
claim "little memory: bands of rows" bash -c "
    rc-fatigue --quiet $limits --depths 5um --memory 3M --report bands.json -o bands.rcg ${moved[*]} &&
    cmp <(rc-export --format csv bands.rcg | grep -v '^#') <(rc-export --format csv moved.rcg | grep -v '^#')"
claim "  more than one" [ "$(json '.bands > 1' bands.json)" = 1 ]
claim "two threads" bash -c "rc-fatigue --quiet $limits --depths 5um --threads 2 -o two.rcg ${moved[*]} &&
    cmp <(rc-export --format csv two.rcg | grep -v '^#') <(rc-export --format csv moved.rcg | grep -v '^#')"
claim "a picture of a depth" rc-render --channel dangvan -o map.png moved.rcg
claim "positions between nodes cause a warning" warns 'rounded to columns' bash -c "
    rc-pick --set position=7e-7 moved-3.rcg |
    rc-fatigue $limits --depths 5um -o x.rcg moved-1.rcg -"
# A window follows the contact, and the whole map stays: the same histories.
rc-synth wave --nx 64 --ny 24 --dx 3um --wavelength 192um --amplitude 1nm -o flat.rcg
travel="rc-solve --quiet $steel --radius 1mm --load 1N --tol 1e-6 --output pressure --travel=-30um:30um:21 flat.rcg"
$travel | rc-fatigue --quiet $limits --depths 5um --report whole.json -o whole.rcg
$travel --window 24x24 | rc-fatigue --quiet $limits --depths 5um --report window.json -o window.rcg
near "$(json .dangvan window.json)" "$(json .dangvan whole.json)" 1e-4 "rc-solve --travel: a window and the whole map"
claim "  the whole map is not shifted" [ "$(rc-info whole.rcg | grep -c '64 x 24 nodes')" = 3 ]
claim "  the window is" [ "$(rc-info window.rcg | grep -c '44 x 24 nodes')" = 3 ]
claim "cases without a position stay" bash -c "
    rc-solve --quiet $steel --load 0.5N,1N ball.rcg | rc-fatigue --quiet $limits --depths 5um --report stay.json -o stay.rcg"
claim "  and are two states and the unloaded one" [ "$(json .states stay.json)" = 3 ]

rc-solve --quiet $steel --load 0.5N,1N,2N ball.rcg >loads.rcg
rc-fatigue $limits --depths 1.5um -o x.rcg loads.rcg 2>stay.txt
claim "  which a warning says, with the way to judge each" grep -q 'loads.rcg: the 3 cases are taken as the states of one history, of a contact that stays in its place; --pass x judges each case' stay.txt
claim "  and no distance of 0 m" bash -c 'grep -q "sphere, case 1: crossland: .*the history has 3 cases: its sampling error" stay.txt && ! grep -q " 0 m " stay.txt'
claim "  of one load too" warns 'loaded and unloaded in its place; --pass x judges one that passes' bash -c "rc-pick --case 1 loads.rcg | rc-fatigue $limits --depths 1.5um -o x.rcg"
rc-fatigue $limits --pass x --depths 1.5um -o x.rcg loads.rcg 2>pass.txt
claim "each case of a pass by itself: the warning names the first one" grep -q 'sphere, case 1: crossland: .* up to 3 um apart: its sampling error' pass.txt
claim "  and counts the others" grep -q '^rc-fatigue: 2 other cases too: a large sampling error$' pass.txt
claim "  --verbose names each" test "$(rc-fatigue --verbose $limits --pass x --depths 1.5um -o x.rcg loads.rcg 2>&1 | grep -c 'case [123]: crossland: .*sampling error')" = 3

# ---- limits ----

rc-solve --quiet --layer 4um,300GPa,0.25 $steel --load 1N -o coated.rcg ball.rcg
list="--bending-limit 600MPa,300MPa --torsion-limit 372MPa,186MPa"
$pass --depths 3um,5um --report one.json -o x.rcg coated.rcg
rc-fatigue --quiet $list --pass x --depths 3um,5um --report each.json -o each.rcg coated.rcg
near "$(json .by_depth.crossland[0] each.json)" "$(json .by_depth.crossland[0] one.json)" 1e-12 "a coat has its own limits"
near "$(json .by_depth.crossland[1] each.json)" "$(json '2 * .by_depth.crossland[1]' one.json)" 1e-9 "  the body below others"
printf 'depth bending torsion\n0 900MPa 558MPa\n4um 900MPa 558MPa # case\n6um 300MPa 186MPa\n' >limits.txt
rc-fatigue --quiet --limits limits.txt --pass x --depths 3um,5um,9um --report table.json -o x.rcg pressed.rcg
$pass --depths 3um,5um,9um --report plain.json -o x.rcg pressed.rcg
near "$(json '.by_depth.crossland[0] * 558' table.json)" "$(json '.by_depth.crossland[0] * 372' plain.json)" 1e-9 "a table of limits: above"
near "$(json '.by_depth.crossland[1]' table.json)" "$(json '.by_depth.crossland[1]' plain.json)" 1e-6 "  half-way"
near "$(json '.by_depth.crossland[2]' table.json)" "$(json '.by_depth.crossland[2] * 2' plain.json)" 1e-9 "  below"

for heading in 'depth/um bending/MPa torsion/MPa' '# depth (um) bending (MPa) torsion (MPa)'; do
    printf '%s\n0 900 558\n4 900 558\n6 300 186\n' "$heading" >units.txt
    rc-fatigue --quiet --limits units.txt --pass x --depths 3um,5um,9um --report units.json -o x.rcg pressed.rcg
    near "$(json '.by_depth.crossland[1]' units.json)" "$(json '.by_depth.crossland[1]' table.json)" 1e-12 \
        "  with units in the heading '$heading'"
done

# ---- residual stress ----

rc-stress --quiet --depths 5um --components sxx,syy pressed.rcg -o uneven.rcg
refuses 1 'varies along the travel by .* %' "a residual stress that varies" "$pass --depths 5um --residual uneven.rcg -o x.rcg pressed.rcg"
rc-pick --crop 24,0,1,48 uneven.rcg >line.rcg
$pass --criteria amplitude,crossland --depths 5um --residual line.rcg --report residual.json -o x.rcg pressed.rcg
near "$(json .amplitude residual.json)" "$(json .amplitude y.json)" 1e-9 "a residual stress changes no amplitude"
between 0 "$(json .crossland residual.json)" "$(json '.crossland * 0.99' y.json)" "  in compression it lowers Crossland's index"
refuses 1 'no stresses at the depth 6e-06' "none at a depth" "$pass --depths 6um --residual line.rcg -o x.rcg pressed.rcg"
refuses 1 'it holds no stresses' "a file without stresses" "$pass --depths 6um --residual pressed.rcg -o x.rcg pressed.rcg"
refuses 1 'No such file' "no file" "$pass --depths 6um --residual never.rcg -o x.rcg pressed.rcg"
refuses 1 'lines along the travel' "another map" "$pass --depths 5um --residual <(rc-pick --crop 24,0,1,40 uneven.rcg) -o x.rcg pressed.rcg"

# ---- warnings and refusals ----

loud="rc-fatigue $limits --pass x"
claim "a depth at the surface causes a warning" warns 'less than half the distance of nodes' $loud --depths 0.1um -o x.rcg pressed.rcg
claim "  and so does --dangvan full under pressure" warns 'hydrostatic pressure, which lowers' $loud --dangvan full --depths 5um -o x.rcg pressed.rcg
claim "  a body that does not shake down" warns 'yields in every cycle' $loud --criteria shakedown --yield 100MPa --depths 5um -o x.rcg pressed.rcg
claim "  a periodic map" warns 'points never unload' bash -c "rc-solve --quiet --periodic $steel --mean-pressure 10MPa ball.rcg | $loud --depths 5um -o x.rcg"
claim "  one column along the travel" warns 'its sampling error is [1-9]' \
    $loud --depths 5um --report column.json -o x.rcg <(rc-pick --crop 24,0,1,48 pressed.rcg)
claim "  few states" warns 'sampling error' rc-fatigue $limits --depths 5um -o x.rcg moved-0.rcg moved-10.rcg moved-20.rcg moved-40.rcg
claim "  a body that has yielded" warns 'give the file to --residual' bash -c "rc-pick --set slabs=8 pressed.rcg | $loud --depths 5um -o x.rcg"
refuses 2 'give both endurance limits' "one limit" "rc-fatigue --bending-limit 600MPa --pass x --depths 5um -o x.rcg pressed.rcg"
refuses 2 'Dang Van needs a ratio above 0.5' "limits outside a criterion" "rc-fatigue --bending-limit 600MPa --torsion-limit 300MPa --criteria dangvan --pass x --depths 5um -o x.rcg pressed.rcg"
refuses 2 'Papadopoulos needs a ratio above 0.577 and below 0.8' "  of Papadopoulos" "rc-fatigue --bending-limit 600MPa --torsion-limit 500MPa --criteria papadopoulos --pass x --depths 5um -o x.rcg pressed.rcg"
refuses 2 '4.3e.08 Pa in bending and 7e.08 Pa in torsion: no material .* were the two exchanged' "  that were exchanged" \
    "rc-fatigue --bending-limit 430MPa --torsion-limit 700MPa --criteria dangvan --pass x --depths 5um -o x.rcg pressed.rcg"
refuses 2 'no material .* is a unit wrong' "  with the unit of one" "rc-fatigue --bending-limit 700MPa --torsion-limit 430GPa --pass x --depths 5um -o x.rcg pressed.rcg"
refuses 2 'Crossland needs .* is a unit wrong' "  of the other one" "rc-fatigue --bending-limit 700GPa --torsion-limit 430MPa --pass x --depths 5um -o x.rcg pressed.rcg"
refuses 2 'no material' "  of a table" "rc-fatigue --limits <(printf 'depth bending torsion\n0 430MPa 700MPa\n') --pass x --depths 5um -o x.rcg pressed.rcg"
claim "limits in GPa cause a warning" warns 'an endurance limit of 700 GPa is above that of any material' \
    rc-fatigue --bending-limit 700GPa --torsion-limit 430GPa --pass x --depths 5um -o x.rcg pressed.rcg
refuses 2 'shakedown needs' "shakedown without a yield stress" "$pass --criteria shakedown --depths 5um -o x.rcg pressed.rcg"
refuses 2 '--criteria shakedown has no effect without --pass' "  of positions" "rc-fatigue --yield 1GPa --criteria shakedown --depths 5um -o x.rcg pressed.rcg"
refuses 2 'give --depths' "no depths" "$pass -o x.rcg pressed.rcg"
refuses 2 'depths must increase' "depths that fall" "$pass --depths 5um,4um -o x.rcg pressed.rcg"
refuses 2 '--dangvan has no effect without --criteria dangvan' "--dangvan without it" "$pass --criteria crossland --dangvan full --depths 5um -o x.rcg pressed.rcg"
refuses 1 'leave out --pass x' "a pass of positions" "$pass --depths 5um -o x.rcg moved-0.rcg"
refuses 1 'has 1 material, and there are limits of 2' "limits of a coat, without one" "rc-fatigue $list --pass x --depths 5um -o x.rcg pressed.rcg"
refuses 2 '--limits does not work with --torsion-limit' "limits twice" "$pass --limits limits.txt --depths 5um -o x.rcg pressed.rcg"
refuses 2 'line 2' "a table with a wrong line" "rc-fatigue --limits <(printf '0 1MPa .6MPa\n1um 2MPa\n') --pass x --depths 5um -o x.rcg pressed.rcg"
refuses 2 'no column .torsoin.: .*did you mean torsion' "  of other columns" "rc-fatigue --limits <(printf 'depth bending torsoin\n0 1 .6\n') --pass x --depths 5um -o x.rcg pressed.rcg"
refuses 2 'line 2: -1e.08: it must be at least 0' "  with a negative limit" "rc-fatigue --limits <(printf 'depth bending/MPa torsion/MPa\n0 -100 60\n') --pass x --depths 5um -o x.rcg pressed.rcg"
refuses 2 'depths must increase' "  with depths that fall" "rc-fatigue --limits <(printf '1um 1MPa .6MPa\n0 1MPa .6MPa\n') --pass x --depths 5um -o x.rcg pressed.rcg"
refuses 2 'must be C' "a life without a power" "$pass --life 0 --depths 5um -o x.rcg pressed.rcg"
refuses 1 'only some of the cases have the key position' "a case without its position" "rc-fatigue $limits --depths 5um -o x.rcg moved-0.rcg pressed.rcg"
refuses 1 'grid' "cases of different size" "rc-fatigue $limits --depths 5um -o x.rcg moved-0.rcg <(rc-pick --crop 0,0,40,40 moved-1.rcg)"
refuses 1 'are positions in metres' "positions without a unit" "rc-fatigue $limits --depths 5um -o x.rcg moved-0.rcg <(rc-pick --set position=100 moved-1.rcg)"
refuses 1 'must have the same body' "cases of two bodies" "rc-fatigue $limits --depths 5um -o x.rcg moved-0.rcg <(rc-pick --set nu=0.25 moved-1.rcg)"
