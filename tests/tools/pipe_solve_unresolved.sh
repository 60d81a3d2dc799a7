# A contact of a few nodes, or of patches of a few nodes, is said to be unresolved.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 65 --dx 5um --radius 10mm -o ball.rcg
press() { rc-solve --estar 100GPa --output pressure --report r.json "$@" -o p.rcg; }
export -f press

# a^3 = 3 F R / (4 E*): 1 N: a = 42.2 um, some 223 nodes; 0.01 N: 9.1 um, some 10
claim "a resolved contact: not a word" bash -c 'press --load 1N ball.rcg 2>err && [ ! -s err ]'
between 200 "$(field contact_nodes r.json)" 250 "  of its some 223 nodes"
near "$(field nodes_per_patch r.json)" "$(field contact_nodes r.json)" "$same" "  in one patch"
claim "ten nodes" warns 'case 1, load 10 mN: [0-9]+ nodes in contact, in 1 patch: the grid does not resolve it: .*--discretization' \
    press --load 10mN ball.rcg

# one node in 64 stands out by 1 um
awk 'BEGIN { for (j = 0; j < 128; j++) for (i = 0; i < 128; i++)
    printf "%d%s", i % 8 == 0 && j % 8 == 0, i < 127 ? " " : "\n" }' >comb.txt
rc-import --dx 1um --z-unit um comb.txt -o comb.rcg
claim "many nodes in patches of one" \
    warns '256 nodes in contact, in 256 patches: the grid does not resolve it' press --periodic --load 1mN comb.rcg
near "$(field nodes_per_patch r.json)" 1 "$same" "  1 node each"

finish
