# SPDX-License-Identifier: GPL-3.0-or-later
# Materials by name: they set the options that the line does not give, as if they were typed. A table of the
# user has more of them, and faults of the table are named with their line.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 64 --dx 1um --radius 5mm --quiet -o ball.rcg

# ---- the built-in table ----

rc-solve --materials >table.tsv
claim "the table is printed, with a name and a source in each row" awk -F '\t' '
    NR == 1 { for (k = 1; k <= NF; k++) { sub(/ *$/, "", $k); at[$k] = k } columns = NF; next }
    { gsub(/ /, "", $1); bad += NF != columns || $1 == "" || $at["source"] !~ /[a-z]/ }
    END { exit !(NR > 25 && !bad) }' table.tsv
# The relations hold for all materials: yield is at most hardness, and the heat capacity of a volume, the
# conductivity over the diffusivity, lies between 1 and 4.2 MJ/(m3 K).
claim "  its values are possible" awk -F '\t' '
    function value(k) { v = $k; sub(/ *$/, "", v); return v == "-" ? -1 : v + 0 }
    function giga(k) { return $k ~ /MPa/ ? value(k) / 1000 : $k ~ /HV/ ? value(k) * 0.0105766 : value(k) }
    NR > 1 && $1 !~ /^rigid/ {
        bad += !(giga(2) > 0.001 && giga(2) < 1300 && value(3) > 0 && value(3) <= 0.5)
        if (giga(5) > 0) { bad += giga(5) > giga(4); n++ }
        if (value(6) > 0 && value(7) > 0) { c = value(6) / value(7); bad += !(c > 1 && c < 4.2); n++ }
    }
    END { exit !(n > 20 && !bad) }' table.tsv
alone() { rc-solve --load 0.5N --quiet --report "$1.json" -o "$1.rcg" "${@:2}" ball.rcg; }
alone names --body1 steel --body2 Al2O3
alone typed --E1 211.9GPa --nu1 0.291 --E2 370GPa --nu2 0.22
claim "two materials give the values of their numbers" test "$(field max_pressure names.json) $(field approach names.json)" = \
    "$(field max_pressure typed.json) $(field approach typed.json)"
# Hertz: p0 = (6 P E*^2 / (pi^3 R^2))^(1/3), with E* from the two moduli
near "$(field max_pressure names.json)" "$(awk 'BEGIN { pi = atan2(0, -1)
    e = 1 / ((1 - 0.291 ^ 2) / 211.9e9 + (1 - 0.22 ^ 2) / 370e9); print (6 * 0.5 * e ^ 2 / (pi ^ 3 * 25e-6)) ^ (1 / 3) }')" 0.02 \
    "  the largest pressure is that of Hertz"
claim "  the report says where they come from" grep -q \
    '"body_materials": "E1 211.9GPa (steel); nu1 0.291 (steel); E2 370GPa (Al2O3); nu2 0.22 (Al2O3)"' names.json
rc-solve --load 0.5N --body1 steel --body2 Al2O3 --quiet --report names.tsv -o names.rcg ball.rcg
claim "  in a table they have no blank" awk -F '\t' 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == "body_materials") c = k }
    NR == 2 { ok = c && $c == "E1_211.9GPa_(steel);_nu1_0.291_(steel);_E2_370GPa_(Al2O3);_nu2_0.22_(Al2O3)" && split($0, blank, " ") == NF }
    END { exit !ok }' names.tsv
claim "  without names it says nothing" bash -c '! grep -q body_materials typed.json'
claim "  the history has both" says 'rc-solve .*--E1 211900000000 .*--body1 steel --body2 Al2O3' rc-info names.rcg
alone rigid --body1 Copper --body2 rigid
claim "case does not matter, and rigid is a material" grep -q '"E1 129.8GPa (Copper); nu1 0.343 (Copper); E2 rigid (rigid)"' rigid.json
alone own --body1 copper --E1 100GPa --body2 rigid
alone numbers --E1 100GPa --nu1 0.343 --E2 rigid
claim "an option of the line wins" test "$(field max_pressure own.json)" = "$(field max_pressure numbers.json)"
claim "  and the report says so" grep -q '"E1 as given; nu1 0.343 (copper)' own.json
claim "--estar wins over both" says '"max_pressure"' bash -c 'rc-solve --load 0.5N --estar 80GPa --body1 copper --quiet --report - -o /dev/null ball.rcg'

# ---- other tools ----

rc-heat --mu 0.1 --speed 1m/s --body1 steel --body2 brass --quiet --report heat.json -o /dev/null typed.rcg
rc-heat --mu 0.1 --speed 1m/s --conductivity 60.5W/mK,110W/mK --diffusivity 17.7mm2/s,33.9mm2/s --quiet --report heated.json -o /dev/null typed.rcg
claim "rc-heat: conductivities and diffusivities" test "$(field max_temperature heat.json)" = "$(field max_temperature heated.json)"
refuses 2 'the table has no conductivity of cast-iron: give --conductivity K1,K2' "  of a material without one" \
    "rc-heat --mu 0.1 --speed 1m/s --body1 cast-iron --body2 steel typed.rcg"
refuses 2 'give --conductivity' "  of one body they are not enough" "rc-heat --mu 0.1 --speed 1m/s --body1 steel typed.rcg"
rc-solve --load 0.5N --estar 114GPa --quiet -o estar.rcg ball.rcg
rc-stress --body1 gold --depths 5um --quiet --report stress.json -o /dev/null estar.rcg
rc-stress --nu 0.44 --depths 5um --quiet --report stressed.json -o /dev/null estar.rcg
mises() { grep -o '"mises": {"value": [0-9.e+-]*' "$1"; }
claim "rc-stress: Poisson's ratio" test "$(mises stress.json)" = "$(mises stressed.json)" -a "$(mises stress.json)"
alone alike --body1 aluminium --body2 aluminium
claim "rc-slip: both bodies" says '"body_materials": "E1 70.3GPa' rc-slip --mu 0.3 --tangential 0.05N --coupling none --body1 aluminium \
    --body2 aluminium --quiet --report - -o /dev/null alike.rcg
rc-scene --load 0.5N --body1 100Cr6 --body2 6061-T6 --mu 0.1 --speed 1m/s --report scene.json ball.rcg >/dev/null 2>&1
claim "rc-scene: the softer body's hardness, and heat of both" bash -c \
    'grep -q "hardness 107HV (6061-T6)" scene.json && grep -q "conductivity 46.6W/mK,167W/mK (both bodies)" scene.json'
claim "  its Vickers number, which the line does not have, needs no message" bash -c \
    'rc-scene --load 0.5N --body1 100Cr6 --body2 6061-T6 ball.rcg 2>hv.err >/dev/null && ! grep "HV is" hv.err'
claim "  that of the line has one" bash -c \
    'rc-scene --load 0.5N --body1 100Cr6 --body2 6061-T6 --hardness 107HV ball.rcg 2>&1 >/dev/null | grep -q -- "--hardness 107HV is"'

claim "  a material without a conductivity: the heat is missing, with its options" says \
    'frictional heat \(--mu --speed --conductivity --diffusivity\)' rc-scene --quiet --load 0.5N --body1 cast-iron --body2 steel ball.rcg
claim "  with data of friction only the conductivity and the diffusivity are" says 'frictional heat \(--conductivity --diffusivity\)' \
    rc-scene --quiet --load 0.5N --body1 cast-iron --body2 steel --mu 0.1 --speed 1m/s ball.rcg
lack() { # lack "claim" "line" OPTIONS: the line is the whole line
    rc-scene --quiet --load 0.5N ${@:3} ball.rcg >scene.txt
    claim "$1" grep -qFx "  $2" scene.txt
}
lack "rc-scene: the body without a hardness, and the option" \
    'hardness cannot be judged: the table has no hardness of steel, body 1; 100Cr6, body 2, has 848HV: give --hardness' --body1 steel --body2 100Cr6
lack "  in the other order" \
    'hardness cannot be judged: the table has no hardness of steel, body 2; 100Cr6, body 1, has 848HV: give --hardness' --body1 100Cr6 --body2 steel
lack "  both bodies" 'hardness cannot be judged: the table has no hardness of steel, body 1, or of gold, body 2: give --hardness' \
    --body1 steel --body2 gold
lack "  and the yield stress" 'yield in the volume cannot be judged: the table has no yield stress of 100Cr6, body 1: give --yield' \
    --body1 100Cr6 --body2 304
lack "  and the heat, where nothing else is missing" \
    'frictional heat cannot be judged: the table has no diffusivity of cast-iron, body 1; steel, body 2, has 17.7mm2/s: give --diffusivity' \
    --body1 cast-iron --body2 steel --mu 0.1 --speed 1m/s
rc-scene --quiet --load 0.5N --body1 304 --body2 rigid --report rigid.json ball.rcg >rigid.txt
claim "  a rigid body limits no pressure: the hardness is that of the other" bash -c \
    'grep -q "hardness 129HV (304)" rigid.json && ! grep "cannot be judged" rigid.txt && grep -q "^  hardness  " rigid.txt'
rc-scene --quiet --load 0.5N --body1 steel --body2 100Cr6 --hardness 2GPa --yield 1GPa ball.rcg >given.txt
claim "  a value of the line is enough" bash -c '! grep "cannot be judged" given.txt'

# ---- a table of the user ----

claim "  no hardness if the softer body may be the one without" bash -c \
    'rc-pick --set form= ball.rcg | rc-scene --load 2N --radius 3mm --body1 steel --body2 100Cr6 --report - -o x.txt | grep -q "\"missing\": \"hardness\""'
printf '# hip joint\nname\tE\tnu\thardness\tsource\nCoCr | F75\t230GPa\t0.3\t-\tnorm\nsteel\t200GPa\t0.3\t250HV\tmine\n\n' >mine.tsv
alone table --materials mine.tsv --body1 F75 --body2 steel
claim "a table of the user has precedence" grep -q '"E1 230GPa (F75); nu1 0.3 (F75); E2 200GPa (steel); nu2 0.3 (steel)"' table.json
while IFS=$'\t' read -r name _; do
    name=${name%%[ |]*}
    [ "$name" = name ] || [ "$name" = rigid ] && continue
    rc-solve --load 0.5N --body1 "$name" --body2 rigid --quiet --report - -o /dev/null ball.rcg
    rc-solve --materials table.tsv --load 0.5N --body1 "$name" --body2 rigid --quiet --report - -o /dev/null ball.rcg
done <table.tsv | grep -o '"body_materials": "[^"]*"\|"max_pressure": [0-9.e]*' | paste - - | uniq -c >pairs.txt
claim "the printed table is read again, with the same results" awk '$1 != 2 { bad = 1 } END { exit bad || NR < 25 }' pairs.txt

bad() { # bad "message" "claim" TABLE
    printf "$3" >bad.tsv
    refuses 2 "$1" "$2" "rc-solve --materials bad.tsv --load 1N --body1 x --body2 rigid ball.rcg"
}
bad "line 2, E: unknown unit 'Gpx'" "a wrong unit" 'name\tE\nx\t5Gpx\n'
bad "'colour' is no column" "an unknown column" 'name\tcolour\nx\tred\n'
bad "no column 'name'" "no names" 'E\tnu\n5GPa\t0.3\n'
bad "two columns are named 'E'" "a column twice" 'name\tE\tE\nx\t5GPa\t6GPa\n'
bad 'line 2: it has more cells' "too many cells" 'name\tE\nx\t5GPa\t3\n'
bad 'line 3: it has no name' "a row without a name" 'name\tE\n\n\t5GPa\n'
bad 'has more than [0-9]* bytes' "a long line" "name\n$(printf 'x%.0s' {1..5000})\n"
bad 'it is in no table' "an empty file" ''
refuses 1 'missing.tsv: No such file' "no such file" "rc-solve --materials missing.tsv --load 1N --body1 x --body2 rigid ball.rcg"
refuses 2 'stel: it is in no table; .* reads yours: did you mean steel?' "a mistyped name" "rc-solve --load 1N --body1 stel --body2 rigid ball.rcg"
for name in rail-steel gear-steel 100Cr7 AISI-52109 rubber 6061-T5; do
    claim "no other material is offered for $name" bash -c \
        '! rc-solve --load 1N --body1 "$1" --body2 rigid ball.rcg 2>said.txt >ball.out; grep -q "$1: it is in no table; --materials prints" said.txt && ! grep -q "did you mean" said.txt' - "$name"
done
for pair in alumninium:aluminium stainles-steel:stainless-steel 100cr6s:100Cr6 tungsten-carbid:tungsten-carbide; do
    refuses 2 "${pair%:*}: it is in no table; .*: did you mean ${pair#*:}?" "a misspelling of ${pair#*:}" \
        "rc-solve --load 1N --body1 ${pair%:*} --body2 rigid ball.rcg"
done
refuses 2 "'steel' is not a number; a material by its name is --body1 or --body2, and --materials prints the names" "a name instead of a number" "rc-solve --load 1N --E1 steel ball.rcg"
refuses 2 'or materials by name' "one body only" "rc-solve --load 1N --body1 steel ball.rcg"
