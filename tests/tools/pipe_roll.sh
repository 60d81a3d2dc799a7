# SPDX-License-Identifier: GPL-3.0-or-later
# rc-slip --creep and --creep-force: rolling, steady and from case to case, against CONTACT's published outputs
# (Vollebregt, repository eve70a/CONTACT, examples carter2d, bentall and catt_to_cart), Kalker's table and the laws of power; plan, frames, refusals.
. "$(dirname "$0")/../pipe.sh"

column() { # NAME FILE [ROW]
    awk -F '\t' -v n="$1" -v r="${3:-1}" 'NR == 1 { for (i = 1; i <= NF; i++) { split($i, h, "/"); if (h[1] == n) c = i } } NR == r + 1 { print $c }' "$2"
}
number() { awk "BEGIN { printf \"%.12g\", ($1) }"; }
values() { rc-pick --channel "$2" --case "${3:-1}" "$1" | rc-export --format csv | grep -v '^#'; }
strip() { # NODES DX DY CURVATURE MIDDLE: writes the heights of a cylinder
    awk -v n="$1" -v dx="$2" -v c="$4" -v m="$5" 'BEGIN { for (i = 0; i < n; i++) printf "%.17g%s", -c * ((i - m) * dx) ^ 2, i < n - 1 ? "," : "\n" }' |
        rc-import --format ascii --dx "$2" --dy "$3" --z-unit m -
}

# ---- carter2d: G 82 GPa, nu 0.28; it rolls at 30 m/s ----

steel="--E1 209.92GPa --nu1 0.28 --E2 209.92GPa --nu2 0.28"
strip 55 4e-5 0.2 1 26.25 | rc-solve --quiet --load 35780N --tol 1e-9 $steel -o carter.rcg
rc-slip --mu 0.3 --creep 2.4e-4,0 --steady --tol 1e-7 --quiet --report carter.tsv -o rolled.rcg carter.rcg
near "$(number "$(column tangential_x carter.tsv) / $(column limit carter.tsv)")" 0.6480 1e-4 "Carter's cylinder has the force of CONTACT"
near "$(paste -d ' ' <(values rolled.rcg traction-x | tr ',' '\n') <(values rolled.rcg slip-x | tr ',' '\n') | awk '{ w -= $1 * $2 * 30 * 4e-5 * 0.2 } END { printf "%.12g", w }')" \
    47.62 1e-4 "  and its friction power, of the tractions at the end of a step"
claim "  and its nodes that stick and slip" test "$(column stick_nodes carter.tsv) $(column slip_nodes carter.tsv)" = "30 20"
near "$(column power carter.tsv)" "$(number "2.4e-4 * $(column tangential_x carter.tsv)")" 1e-9 "power is force times creepage"
near "$(column power_slip carter.tsv)" "$(column power carter.tsv)" 1e-9 "  which friction dissipates, without a loss by the grid"

# ---- bentall: aluminium on steel; rolls freely, driven and braked ----

two="--E1 60.26GPa --nu1 0.31 --E2 209.92GPa --nu2 0.28"
strip 216 1e-6 1 20 107.5 | rc-solve --quiet --load 16201.9N --tol 1e-8 $two -o rollers.rcg
for case in "0 4.294e-4" "607.57125N 5.392e-4" "-607.57125N 2.108e-4"; do
    rc-slip --mu 0.05 --creep-force "${case% *}" --steady --tol 1e-6 --quiet --report bentall.tsv -o x.rcg rollers.rcg
    near "$(column creep_x bentall.tsv | tr -d -)" "${case#* }" 1e-2 "rollers that differ, under ${case% *}, creep as in CONTACT"
done
claim "  and rc-slip warns of what is neglected" warns "rolling neglects the effect of tractions on the pressure" \
    rc-slip --mu 0.05 --creep-force 0 --steady -o x.rcg rollers.rcg
claim "  which --coupling none takes for similar bodies" says '"creep_x": -?0,.*"stick_nodes": 200,' \
    rc-slip --mu 0.05 --creep-force 0 --steady --coupling none --quiet --report - rollers.rcg

# ---- a ball ----

ball() { rc-synth sphere --nx "$1" --dx "$2" --radius 7.5mm | rc-solve --quiet --load 240N --E1 210GPa --nu1 0.25 --E2 210GPa --nu2 0.25 -o "$3"; }
ball 64 10um ball.rcg
rc-slip --mu 100 --creep 1e-5,2e-5,0.03 --steady --quiet --report small.tsv -o x.rcg ball.rcg
# C11 4.12, C22 3.67, C23 1.47 at nu = 0.25; a^3 = 3 P R/(4 E*), G = 84 GPa
kalker() { awk "BEGIN { a = (3 * 240 * 7.5e-3 / (4 * 112e9)) ^ (1 / 3); print 84e9 * a ^ 2 * ($1) }"; }
near "$(column extrapolated_tangential_x small.tsv)" "$(kalker '4.12 * 1e-5')" 2e-2 "small creepages give the force of Kalker's linear theory along x"
near "$(column extrapolated_tangential_y small.tsv)" "$(kalker '3.67 * 2e-5 + 1.47 * a * 0.03')" 2e-2 "  and with spin along y"
near "$(column kalker_tangential_y small.tsv)" "$(kalker '3.67 * 2e-5 + 1.47 * a * 0.03')" 2e-2 "  which the report has beside it"
near "$(column kalker_c11 small.tsv)" 4.12 1e-3 "  with its coefficient C11"
near "$(column kalker_c23 small.tsv)" 1.47 1e-3 "  and C23"
near "$(column ellipse_x small.tsv)" "$(awk 'BEGIN { print (3 * 240 * 7.5e-3 / (4 * 112e9)) ^ (1 / 3) }')" 1e-2 "  and the radius of Hertz's contact"
near "$(column fastsim_tangential_y small.tsv)" "$(kalker '3.67 * 2e-5 + 1.47 * a * 0.03')" 2e-2 "  and FASTSIM"

# ranges: each value is a case
rc-slip --mu 0.3 --creep 0.01%:0.5%:log:3,0,0:4rad/m:3 --steady --quiet --report range.tsv -o range.rcg ball.rcg
for k in 1 2 3; do
    rc-slip --mu 0.3 --creep "$(awk "BEGIN { print 1e-4 * sqrt(50) ^ ($k - 1) }"),0,$((2 * (k - 1)))/m" --steady --quiet --report "case$k.tsv" -o x.rcg ball.rcg
    near "$(awk -v k=$k 'NR == k + 1' range.tsv | cut -f"$(head -1 range.tsv | tr '\t' '\n' | grep -n '^tangential_x' | cut -d: -f1)")" \
        "$(column tangential_x "case$k.tsv")" 2e-3 "case $k of a range is that of its creepages"
done
claim "  its cases are numbered" test "$(rc-info --json range.rcg | grep -o '"case": [0-9][0-9]*' | sort -u | tr -d '\n')" = '"case": 1"case": 2"case": 3'
refuses 2 'ranges have 3 and 2 values' "ranges of two lengths" 'rc-slip --mu 0.3 --creep 0:1:3,0:1:2 --steady -o x.rcg ball.rcg'
rc-slip --mu 0.3 --creep 0.1% --steady --quiet --report alone.tsv -o x.rcg ball.rcg
rc-slip --mu 0.3 --creep 1e-3,0,0 --steady --quiet --report three.tsv -o x.rcg ball.rcg
claim "a creepage alone is that along x" [ "$(column tangential_x alone.tsv)" = "$(column tangential_x three.tsv)" ]
claim "a decimal comma of a creepage has a warning" warns 'creep 0,1%: two values, 0 % and 1 %: for one number write 0\.1%, for two 0%,1%$' rc-slip --mu 0.3 --creep 0,1% --steady -o x.rcg ball.rcg
refuses 2 'must be a creepage along x, or two' "four creepages" 'rc-slip --mu 0.3 --creep 1e-3,0,0,1 --steady -o x.rcg ball.rcg'
refuses 2 'a range is for --steady' "a range on a path" 'rc-slip --mu 0.3 --creep 0:1e-3:3,0 -o x.rcg ball.rcg'
refuses 2 "unknown unit 'permille': a plain number or a percentage" "a wrong unit" 'rc-slip --mu 0.3 --creep 1permille,0 --steady -o x.rcg ball.rcg'

# the traction is the length of the two
rc-slip --mu 0.3 --creep 1e-3,-5e-4,2 --steady --quiet --output traction-x,traction-y,traction -o length.rcg ball.rcg
claim "the frame traction is the length of the vector" awk '
    { bad += !(($3 - sqrt($1 ^ 2 + $2 ^ 2)) ^ 2 <= (1e-9 * $3) ^ 2); some += $3 > 0 } END { exit bad || !some }' \
    <(paste -d ' ' <(values length.rcg traction-x | tr ',' '\n') <(values length.rcg traction-y | tr ',' '\n') <(values length.rcg traction | tr ',' '\n'))
rc-slip --mu 0.3 --creep 1e-3,-5e-4,2 --steady --tol 1e-6 --report both.tsv -o both.rcg ball.rcg
for c in x:traction-x:tangential_x y:traction-y:tangential_y; do
    field=${c#*:}
    near "$(values both.rcg "${field%:*}" | tr ',' '\n' | awk '{ f += $1 * 1e-10 } END { printf "%.12g", f }')" "$(column "${field#*:}" both.tsv)" 1e-9 "the tractions along ${c%%:*} add up to the force"
done
near "$(number "1e-3 * $(column tangential_x both.tsv) - 5e-4 * $(column tangential_y both.tsv) + 2 * $(column moment both.tsv)")" \
    "$(column power both.tsv)" 1e-9 "power is force times creepage plus moment times spin"
paste -d ' ' <(values both.rcg pressure | tr ',' '\n') <(values both.rcg traction-x | tr ',' '\n') <(values both.rcg traction-y | tr ',' '\n') \
    <(values both.rcg slip-x | tr ',' '\n') <(values both.rcg slip-y | tr ',' '\n') >five.txt
claim "the frames are those of the page" test "$(channels both.rcg)" = "pressure traction-x traction-y slip-x slip-y"
claim "tractions are at most mu p, and slip is opposite to them and 0 below this limit" awk '
    { if (NF != 5) exit bad = 1; q = sqrt($2 ^ 2 + $3 ^ 2); s = sqrt($4 ^ 2 + $5 ^ 2); if (q > 0.3 * $1 * (1 + 1e-9)) exit bad = 1
      if (q < 0.3 * $1 * (1 - 1e-6) && s != 0) exit bad = 1; if (s > 0) { n++; if ($2 * $4 + $3 * $5 > 0) exit bad = 1 } }
    END { exit bad || NR != 4096 || n < 100 }' five.txt
rc-slip --mu 0.3 --creep-force "$(column tangential_x both.tsv),$(column tangential_y both.tsv)" --steady --tol 1e-6 --report back.tsv -o back.rcg ball.rcg
rc-slip --mu 0.3 --creep "$(column creep_x back.tsv),$(column creep_y back.tsv)" --steady --tol 1e-6 --report again.tsv -o again.rcg ball.rcg
near "$(column tangential_x again.tsv)" "$(column tangential_x both.tsv)" 1e-4 "the creepages that a force finds give this force"
claim "frames have the creepages and the force" says 'creep_x=0.001.*creep_y=-0.0005.*spin=2.*tangential_x=[0-9.]+' bash -c "rc-info both.rcg | tr '\\n' ' '"
claim "--dry-run tells the work" says 'steady rolling$|about 135 convolutions' rc-slip --mu 0.3 --creep 1e-3,0 --steady --dry-run ball.rcg
ball 36 20um coarse.rcg
claim "a coarse map gets a warning" warns 'error of the grid is .*, above 0.05: the nodes are too far apart' \
    rc-slip --mu 0.3 --creep 0,0,5 --steady -o x.rcg coarse.rcg

# ---- catt_to_cart: two balls are pushed, and roll under the same force. G 1, nu 0.28, mu 0.4013; 0.25 a step ----

awk 'BEGIN { for (j = 0; j < 33; j++) for (i = 0; i < 34; i++)
    printf "%.17g%s", -0.002963 * ((i - 16) ^ 2 + (j - 16) ^ 2) / 16, i < 33 ? "," : "\n" }' |
    rc-import --format ascii --dx 0.25 --dy 0.25 --z-unit m - |
    rc-solve --quiet --load 0.4705N --tol 1e-9 --E1 2.56 --nu1 0.28 --E2 2.56 --nu2 0.28 --output pressure -o balls.rcg
for k in 0 1 2 3 4; do
    rc-pick --set position=$(number "$k / 4") --set window_x=$(number "$k / 4") balls.rcg
done >way.rcg
push="--mu 0.4013 --creep-force 0.1240496N --quiet"
rc-slip $push --report way.tsv -o way-q.rcg way.rcg
claim "a stream of positions is a path: each is a case" test "$(wc -l <way.tsv) $(column position way.tsv 5) $(rc-info --json way-q.rcg | grep -c traction-x)" = "6 1 5"
claim "  before the first step there is no creepage" test "$(column creep_x way.tsv 1)" = NaN
k=1
for creepage in 1.824e-3 1.882e-3 1.955e-3 2.050e-3; do
    k=$((k + 1))
    near "$(column creep_x way.tsv $k)" $creepage 1e-2 "  after step $((k - 1)) the creepage is that of CONTACT, within the default accuracy"
done
rc-slip $push --tol 1e-5 --report fine.tsv -o fine.rcg way.rcg
near "$(column creep_x fine.tsv 5)" 2.050e-3 3e-4 "  to all its digits with a smaller --tol"
claim "  and its first step the nodes that stick and slip" test "$(number "$(column stick_nodes fine.tsv 2) == 422 && $(column slip_nodes fine.tsv 2) == 199")" = 1
rc-slip $push --checkpoint path.ck -o three.rcg <(rc-pick --case 1,2,3 way.rcg)
rc-slip $push --checkpoint path.ck --resume --report again.tsv -o again-q.rcg way.rcg
near "$(column creep_x again.tsv 5)" "$(column creep_x way.tsv 5)" 1e-3 "a path continues from its checkpoint"
claim "  whose cases are not solved again" test "$(number "$(column convolutions again.tsv 2) < $(column convolutions way.tsv 2)")" = 1
claim "--dry-run tells the work of a position" says 'about 25 convolutions' rc-slip $push --dry-run way.rcg

# ---- rc-solve --travel: a ball over a rough map, on the whole map and in a window ----

rc-synth selfaffine --nx 96 --ny 40 --dx 10um --hurst 0.8 --rms-height 0.2um --short-cut 60um --seed 3 -o rough.rcg
travel="--radius 7.5mm --load 60N --E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3 --quiet --tol 1e-6 --travel -60um:60um:13"
roll="--mu 0.3 --creep 2e-3,5e-4,3 --tol 1e-4 --quiet"
rc-solve $travel rough.rcg | rc-slip $roll --report whole.tsv -o x.rcg
rc-solve $travel --window 50x40 rough.rcg | rc-slip $roll --report window.tsv -o x.rcg
for f in tangential_x tangential_y moment power_slip; do
    near "$(column $f window.tsv 13)" "$(column $f whole.tsv 13)" 1e-3 "a ball that travels: $f in a window is that on the whole map"
done
claim "  and rolls on from case to case" test "$(number "$(column tangential_x whole.tsv 13) > 2 * $(column tangential_x whole.tsv 5)")" = 1
rc-solve $travel --window 16x40 rough.rcg -o narrow.rcg
refuses 1 'leading edge of the map' "a window that the contact fills" 'rc-slip --mu 0.3 --creep 1e-3,0 -o x.rcg narrow.rcg'

# ---- a periodic map has a contact in each period ----

awk 'BEGIN { for (j = 0; j < 32; j++) for (i = 0; i < 32; i++) printf "0%s", i < 31 ? "," : "\n" }' |
    rc-import --format ascii --dx 1um --z-unit m -o round-map.rcg -
soft="--E1 1GPa --nu1 0.3 --E2 1GPa --nu2 0.3"
for start in -6 10; do
    rc-solve --quiet --periodic --radius 0.1mm --load 0.2mN $soft --tol 1e-8 --travel=${start}um:$((start + 7))um:8 round-map.rcg |
        rc-slip --mu 0.3 --creep 1e-3,5e-3,2000 --tol 1e-6 --quiet --report "round$start.tsv" -o x.rcg
done
for f in tangential_x tangential_y moment kalker_tangential_y; do
    near "$(column $f round10.tsv 8)" "$(column $f round-6.tsv 8)" 1e-5 "half a period further on, over the end of the map: $f is the same"
done
rc-solve --quiet --periodic --radius 0.1mm --load 60mN $soft --travel=0,1um round-map.rcg -o wide.rcg
refuses 1 'reaches half a period from its middle.*longer period' "spin where two periods meet" 'rc-slip --mu 0.3 --creep 0,0,2000 --quiet -o x.rcg wide.rcg'
claim "  without spin it has no moment" says '"moment": null.*"moment": null' \
    bash -c "rc-slip --mu 0.3 --creep 1e-3,0 --quiet --report - wide.rcg | tr '\\n' ' '"

# ---- refusals: the reason, and a way out ----

refuses 1 'limit|slide; give the creepage instead' "a force beyond the limit" 'rc-slip --mu 0.3 --creep-force 100N --steady -o x.rcg ball.rcg'
rc-pick --crop 0,0,53,64 ball.rcg -o edge.rcg
refuses 1 'leading edge of the map, column 52 of 53: .*leave free columns' "a contact at the leading edge" 'rc-slip --mu 0.3 --creep 1e-3,0 --steady -o x.rcg edge.rcg'
rc-synth sphere --nx 64 --dx 10um --radius 7.5mm | rc-solve --quiet --periodic --load 240N --E1 210GPa --nu1 0.25 --E2 210GPa --nu2 0.25 -o round.rcg
refuses 1 'periodic along x has no leading edge' "a periodic map" 'rc-slip --mu 0.3 --creep 1e-3,0 --steady -o x.rcg round.rcg'
for x in 0 1e-5; do rc-pick --set position=$x ball.rcg -o at-$x.rcg; done
refuses 1 'position is 1e-05 m, that of the case before 0 m: .*leave out --steady' "positions that differ" \
    'cat at-0.rcg at-1e-5.rcg | rc-slip --mu 0.3 --creep 1e-3,0 --steady -o x.rcg'
refuses 1 'no key position.*give --steady' "a path without positions" 'rc-slip --mu 0.3 --creep 1e-3,0 -o x.rcg ball.rcg'
refuses 1 'position 0 m after 1e-05 m: rolling is towards' "a path backwards" \
    'cat at-1e-5.rcg at-0.rcg | rc-slip --mu 0.3 --creep 1e-3,0 -o x.rcg'
rc-pick --set position=1e-4 --crop 0,0,60,64 ball.rcg -o other.rcg
refuses 1 'differ from those of the case before' "a path over other maps" \
    'cat at-0.rcg other.rcg | rc-slip --mu 0.3 --creep 1e-3,0 -o x.rcg'
refuses 2 'give one of --tangential' "a creepage and a force" 'rc-slip --mu 0.3 --creep 1e-3,0 --tangential 3N -o x.rcg ball.rcg'
refuses 2 '--steady has no effect without --creep or --creep-force' "--steady alone" 'rc-slip --mu 0.3 --tangential 3N --steady -o x.rcg ball.rcg'
refuses 2 'take --coupling goodman' "full coupling" 'rc-slip --mu 0.3 --creep 1e-3,0 --steady --coupling full -o x.rcg ball.rcg'
refuses 2 '--increments does not work with --creep, because' "increments" 'rc-slip --mu 0.3 --creep 1e-3,0 --steady --increments 4 -o x.rcg ball.rcg'
