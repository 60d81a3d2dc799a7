# SPDX-License-Identifier: GPL-3.0-or-later
# rc-slip: partial slip, loop and displacement of a ball; paths, histories and cases; dissimilar bodies;
# frames, plan, report, warnings; refusals.
. "$(dirname "$0")/../pipe.sh"

steel="--E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3"
rc-synth sphere --nx 64 --dx 10um --radius 7.5mm -o sphere.rcg
rc-solve --quiet --load 240N $steel -o ball.rcg sphere.rcg
column() { # NAME ROW FILE
    awk -F '\t' -v n="$1" -v r="$2" 'NR == 1 { for (i = 1; i <= NF; i++) { split($i, h, "/"); if (h[1] == n) c = i } } NR == r + 1 { print $c }' "$3"
}
values() { rc-pick --channel "$2" --case "${3:-1}" "$1" | rc-export --format csv | grep -v '^#'; }

# ---- a ball ----

# a^3 = 3 P R/(4 E*), E* = 115.385 GPa; displacement 3 mu P (2 + kap)/(8 a E*) (1 - (1 - F/mu P)^(2/3)) (Mindlin 1949)
exact() {
    awk -v f="$1" 'BEGIN { e = 210e9 / 0.91 / 2; a = (3 * 240 * 7.5e-3 / (4 * e)) ^ (1 / 3)
        print 3 * 0.3 * 240 * (2 + 3 / 7) / (8 * a * e) * (1 - (1 - f / 72) ^ (2 / 3)) }'
}
rc-slip --mu 0.3 --tangential 36N --report one.tsv -o one.rcg ball.rcg
near "$(column displacement_x 1 one.tsv)" "$(exact 36)" 2e-3 "the ball creeps as Mindlin's does"
near "$(column tangential_x 1 one.tsv)" 36 1e-9 "  under the force that was asked for"
near "$(awk -v a="$(column stick_area 1 one.tsv)" -v b="$(column slip_area 1 one.tsv)" 'BEGIN { print sqrt(a / (a + b)) }')" \
    0.7937 "$coarse_grid" "  and sticks inside of Cattaneo's radius"
claim "  the iteration is accurate to its estimate" awk -v e="$(column iteration_error_estimate 1 one.tsv)" 'BEGIN { exit !(e > 0 && e <= 1e-4) }'
# the first of two increments goes to 0.9 of the path: compared with many increments
rc-slip --mu 0.3 --path "$(awk 'BEGIN { for (k = 0; k <= 32; k++) printf "240N,%gN,0;", 36 * k / 32 }')" --increments 1 --tol 1e-6 --output traction-x,traction-y --quiet -o many.rcg ball.rcg
error() { # FILE CASE FILE CASE: prints the relative L1 distance of the tractions
    paste -d ' ' <(values "$1" traction-x "$2" | tr ',' '\n') <(values "$1" traction-y "$2" | tr ',' '\n') \
        <(values "$3" traction-x "$4" | tr ',' '\n') <(values "$3" traction-y "$4" | tr ',' '\n') |
        awk '{ s += sqrt(($1 - $3) ^ 2 + ($2 - $4) ^ 2); t += sqrt($3 ^ 2 + $4 ^ 2) } END { print s / t }'
}
off=$(error one.rcg 1 many.rcg 33)
between "$off" "$(column traction_error_estimate 1 one.tsv)" "$(awk -v e="$off" 'BEGIN { print 7 * e }')" "  and what its increments leave is told"
claim "the frames are pressure, tractions and slip" test "$(rc-info --json one.rcg | grep -o '"channel": "[a-z-]*"' | tr '\n' ' ')" = \
    '"channel": "pressure" "channel": "traction-x" "channel": "traction-y" "channel": "slip-x" "channel": "slip-y" '
claim "  the pressure is that of the stream" cmp <(values ball.rcg pressure) <(values one.rcg pressure)
paste -d ' ' <(values one.rcg pressure | tr ',' '\n') <(values one.rcg traction-x | tr ',' '\n') <(values one.rcg traction-y | tr ',' '\n') \
    <(values one.rcg slip-x | tr ',' '\n') <(values one.rcg slip-y | tr ',' '\n') >five.txt
claim "  tractions are at most mu p, and nodes below this limit do not slip" awk '
    { q = sqrt($2 ^ 2 + $3 ^ 2); s = sqrt($4 ^ 2 + $5 ^ 2); if (q > 0.3 * $1 * (1 + 1e-9)) exit bad = 1
      if (q < 0.3 * $1 * (1 - 1e-6) && s != 0) exit bad = 1; if (s > 0) { n++; if ($2 * $4 + $3 * $5 > 0) exit bad = 1 } }
    END { exit bad || NR != 4096 || n < 100 }' five.txt
near "$(awk '{ f += $2 * 1e-10 } END { print f }' five.txt)" 36 1e-6 "  the tractions add up to the force"
rc-slip --mu 0.3 --displacement "$(column displacement_x 1 one.tsv),0" --report moved.tsv -o moved.rcg ball.rcg
near "$(column tangential_x 1 moved.tsv)" 36 1e-4 "moved by that much it takes that force"
rc-slip --mu 0.3 --tangential 0,36N --report across.tsv -o across.rcg ball.rcg
near "$(column displacement_y 1 across.tsv)" "$(column displacement_x 1 one.tsv)" 1e-6 "along y it is the same"
rc-slip --mu 0.3 --tau-max 300MPa --tangential 36N --report cap.tsv -o cap.rcg ball.rcg
claim "--tau-max limits the traction" awk -v l="$(column limit 1 cap.tsv)" 'BEGIN { exit !(l < 72) }'
near "$(paste -d ' ' <(values cap.rcg traction-x | tr ',' '\n') <(values cap.rcg traction-y | tr ',' '\n') |
    awk '{ q = sqrt($1 ^ 2 + $2 ^ 2); if (q > m) m = q } END { printf "%.12g", m }')" 3e8 1e-9 "  to that stress"
rc-slip --mu 0.3 --tangential 36N --output state,traction-x --report state.tsv -o state.rcg ball.rcg
claim "--output state writes 1 for stick, 2 for slip and 0 elsewhere" test "$(values state.rcg state | tr ',' '\n' | sort -n | uniq -c | awk '{ printf "%d:%d ", $2, $1 }')" = \
    "0:$((4096 - $(column stick_nodes 1 one.tsv) - $(column slip_nodes 1 one.tsv))) 1:$(column stick_nodes 1 one.tsv) 2:$(column slip_nodes 1 one.tsv) "
claim "  there is no other frame" test "$(rc-info --json state.rcg | grep -c '"channel"')" = 2
near "$(column approach 1 one.tsv)" "$(rc-info --json ball.rcg | grep -o '"approach": "[^"]*' | head -n 1 | sed 's/.*"//')" "$same" "the approach is that of the stream"
# the tractions agree with the stresses of rc-stress just below the surface
claim "rc-stress reads the tractions" rc-stress --depths 0 --components sxz -o below.rcg one.rcg
near "$(values below.rcg sxz | tr ',' '\n' | sort -g | head -n 1)" "-$(values one.rcg traction-x | tr ',' '\n' | sort -g | tail -n 1)" 1e-6 "  and at the surface they are its shear"

# ---- pictures ----

# legend FILE: prints the words of an SVG in one line.
legend() { sed 's/<[^>]*>/ /g' "$1" | tr -s ' \n' '  '; }
for channel in traction-x slip-x; do rc-render --channel $channel one.rcg -o $channel.svg; done
rc-render --channel state state.rcg -o state.svg
claim "a picture of slip distinguishes stick and slip" says 'Slip along x .*no contact, or stick' legend slip-x.svg
claim "  a picture of traction distinguishes nodes without traction" says 'Traction along x .*no traction' legend traction-x.svg
claim "  a picture of states has all three" says 'Stick and slip .*no contact sticks slips' legend state.svg

# ---- paths ----

# The slip at nu = 0, at the radius r > c of a node: mu (u_a - a^2/R) less the same of the circle c that sticks,
# c/a = (1 - F/mu P)^(1/3). u_a(r) = (a^2 - r^2/2)/R, u_c(r) = ((2 c^2 - r^2) asin(c/r) + c sqrt(r^2 - c^2))/(pi R)
# (Johnson 1985, 3.42). After a reversal the slip is minus that before it.
rc-solve --quiet --load 240N --estar 114GPa -o smooth.rcg sphere.rcg
for n in 1 8; do
    rc-slip --quiet --mu 0.3 --nu 0 --path '240N,0,0; 240N,36N,0; 240N,-36N,0' --increments $n --report turn$n.tsv -o turn$n.rcg smooth.rcg
done
values turn8.rcg slip-x 3 | tr ',' '\n' | awk -v a="$(awk 'BEGIN { print (3 * 240 * 7.5e-3 / (4 * 114e9)) ^ (1 / 3) }')" '
    $1 > most { most = $1; x = ((NR - 1) % 64 - 31.5) * 1e-5; y = (int((NR - 1) / 64) - 31.5) * 1e-5; r = sqrt(x ^ 2 + y ^ 2) }
    END { c = a * 0.5 ^ (1 / 3); s = c / r; pi = 3.14159265358979
        u = ((2 * c ^ 2 - r ^ 2) * atan2(s, sqrt(1 - s ^ 2)) + c * sqrt(r ^ 2 - c ^ 2)) / pi
        printf "%.17g %.9g\n", most, 0.3 * ((a ^ 2 - r ^ 2 / 2) - u - (a ^ 2 - c ^ 2)) / -7.5e-3 }' >slip.txt
for n in 1 8; do
    near "$(column largest_slip_total 3 turn$n.tsv)" "$(cut -d ' ' -f 2 slip.txt)" "$coarse_grid" "the largest slip of a path of $n increments is Cattaneo's and Mindlin's"
done
near "$(column largest_slip_total 3 turn8.tsv)" "$(cut -d ' ' -f 1 slip.txt)" "$summed" "  and that of its frames"
claim "  largest_slip is that of the last increment" awk -v a="$(column largest_slip 3 turn1.tsv)" -v b="$(column largest_slip 3 turn8.tsv)" \
    -v t="$(column largest_slip_total 3 turn1.tsv)" 'BEGIN { exit !(a > 1.9 * t && b < 0.7 * t) }'

loop='240N,0,0; 240N,43.2N,0; 240N,-43.2N,0; 240N,43.2N,0'
rc-slip --mu 0.3 --path "$loop" --report loop.tsv -o loop.rcg ball.rcg
claim "each corner is a case" test "$(rc-info --json loop.rcg | grep -o '"channel": "slip-x"' | wc -l)" = 4
near "$(column displacement_x 2 loop.tsv)" "$(exact 43.2)" 2e-3 "the first way is that of a single force"
near "$(column displacement_x 3 loop.tsv)" "-$(column displacement_x 2 loop.tsv)" 1e-4 "  and the way back leads to the other side, but for what increments leave"
near "$(column displacement_x 4 loop.tsv)" "$(column displacement_x 2 loop.tsv)" 1e-5 "  and round"
# 4 F d - 8 int d dF for a loop between +-F, F = 0.6 mu P; half of it in each direction (Mindlin and
# Deresiewicz 1953)
near "$(column dissipated_energy 4 loop.tsv)" "$(awk 'BEGIN { e = 210e9 / 0.91 / 2; a = (3 * 240 * 7.5e-3 / (4 * e)) ^ (1 / 3)
    u = 3 * 72 * (2 + 3 / 7) / (8 * a * e); print (4 * 43.2 * u * (1 - 0.4 ^ (2 / 3)) - 8 * u * 72 * (0.6 - 0.6 * (1 - 0.4 ^ (5 / 3)))) / 2 }')" \
    "$coarse_grid" "  and dissipates what Mindlin and Deresiewicz found"
rc-render --curve displacement_x:tangential_x loop.tsv -o loop.svg
claim "  a loop is drawn" says 'Force along x against displacement along x' legend loop.svg
printf 'load fx fy # of a joint\n240N 0 0\n\n240N,43.2N,0\n240N\t-43.2N\t0\n240 43.2 0\n' >loop.txt
rc-slip --mu 0.3 --history loop.txt --report loop2.tsv -o loop2.rcg ball.rcg
claim "--history is --path from a file" cmp <(cut -f 1-39 loop.tsv) <(cut -f 1-39 loop2.tsv)
printf 'load (kN);fx (N);fy (N)\n0,24;0;0\n0,24;43,2;0\n0,24;-43,2;0\n0,24;43,2;0\n' >loop.csv
rc-slip --mu 0.3 --history loop.csv --report loop3.tsv -o loop3.rcg ball.rcg
claim "  with units in the heading and decimal commas too" cmp <(cut -f 1-39 loop.tsv) <(cut -f 1-39 loop3.tsv)
# 14,000 characters, which the history of the stream and a checkpoint keep completely
rc-synth sphere --nx 4 --dx 10um --radius 1mm | rc-solve --quiet --load 1N $steel -o small.rcg
awk 'BEGIN { for (k = 0; k < 600; k++) printf "1N %.15fN 0\n", k % 2 * 0.123456789012345 + k * 1e-6 }' >long.txt
sed '$s/0[.]12/0.02/' long.txt >other.txt
long='rc-slip --quiet --mu 0.3 --increments 1 --checkpoint long-kept.rcg -o long.rcg small.rcg'
$long --history long.txt
claim "the history of a long path is complete" bash -c "rc-info long.rcg | grep -c ';1,0.124055789012345,0 --increments 1'"
refuses 1 'belongs to another problem: --path was CRC-32 [0-9a-f]{8}, is CRC-32' "  and another last corner is another path" "$long --resume --history other.txt"
rc-slip --quiet --mu 0.3 --path '100N,0,0; 240N,43.2N,0; 120N,20N,0; 0,0,0' --report grow.tsv -o grow.rcg ball.rcg
near "$(column load 1 grow.tsv)" 100 1e-9 "loads change: contacts are solved on the way"
rc-solve --quiet --load 100N $steel -o less.rcg sphere.rcg
claim "  at the last corner the pressure is that of rc-solve" awk -F ' ' '{ d = $1 - $2; s += d < 0 ? -d : d; t += $2 } END { exit !(NR == 4096 && s < 1e-3 * t) }' \
    <(paste -d ' ' <(values grow.rcg pressure 1 | tr ',' '\n') <(values less.rcg pressure | tr ',' '\n'))
claim "  more increments have a known error" awk -v n="$(column increments 2 grow.tsv)" -v e="$(column increment_error_estimate 2 grow.tsv)" \
    'BEGIN { exit !(n == 16 && e > 1e-4 && e < 0.05) }'
claim "  at load 0 no node touches" test "$(column stick_nodes 4 grow.tsv)$(column slip_area 4 grow.tsv)" = 00
rc-slip --quiet --mu 0.3 --path '240N,0,0; 240N,50N,0; 0,0,0; 240N,0,0; 240N,36N,0' --report anew.tsv -o anew.rcg ball.rcg
for figure in displacement_x tangential_stiffness; do
    near "$(column $figure 5 anew.tsv)" "$(column $figure 1 one.tsv)" 1e-4 "  after which $figure counts from the next touch"
done
claim "  slip becomes 0 too" awk '{ d = $1 - $2; s += d < 0 ? -d : d; t += $2 < 0 ? -$2 : $2 } END { exit !(NR == 4096 && s < 1e-3 * t) }' \
    <(paste -d ' ' <(values anew.rcg slip-x 5 | tr ',' '\n') <(values one.rcg slip-x | tr ',' '\n'))
rc-slip --quiet --mu 0.3 --path '0,0,0; 240N,20N,10N' --increments 1 --nu 0 --report - -o oblique.rcg \
    <(rc-solve --quiet --load 240N --estar 114GPa sphere.rcg) >oblique.json
claim "at nu = 0 tractions grow like the pressure, in one increment, for a force proportional to the load" awk '
    { for (k = 0; k < 2; k++) { d = $(2 + k) - $1 * (k == 0 ? 20 : 10) / 240; s += d < 0 ? -d : d } t += $1 } END { exit !(NR == 4096 && s < 1e-3 * t) }' \
    <(paste -d ' ' <(values oblique.rcg pressure 2 | tr ',' '\n') <(values oblique.rcg traction-x 2 | tr ',' '\n') <(values oblique.rcg traction-y 2 | tr ',' '\n'))

# ---- a periodic map, moved ----

rc-synth selfaffine --nx 32 --dx 1um --hurst 0.8 --rms-slope 0.001 --rolloff 16um --short-cut 8um --seed 3 |
    rc-solve --quiet --periodic --mean-pressure 500MPa $steel -o whole.rcg
rc-slip --mu 0.3 --displacement 1mm --report far.tsv -o far.rcg whole.rcg
near "$(column tangential_x 1 far.tsv)" "$(awk -v p="$(column load 1 far.tsv)" 'BEGIN { print 0.3 * p }')" 1e-6 "complete contact that is moved far slides under mu P"
claim "  this holds at every node" test "$(column stick_nodes 1 far.tsv) $(column slip_nodes 1 far.tsv)" = "0 1024"

# ---- dissimilar bodies ----

rc-solve --quiet --load 240N --E1 210GPa --nu1 0.3 --E2 rigid -o rigid.rcg sphere.rcg
rc-slip --mu 0.3 --tangential 20N --report full.tsv -o full.rcg rigid.rcg
near "$(column beta 1 full.tsv)" 0.285714 "$six_digits" "bodies that are not alike: Dundurs' constant"
claim "  dissimilar bodies slip while they are pressed, and are then moved" test "$(wc -l <full.tsv)" = 3
between 1e-8 "$(column slip_area 1 full.tsv)" 1e-7 "  a ring slips"
claim "  they need several passes and converge" awk -v n="$(column passes 1 full.tsv)" -v a="$(column converged 1 full.tsv)" -v b="$(column converged 2 full.tsv)" \
    'BEGIN { exit !(n > 16 && a == "true" && b == "true") }'
near "$(column tangential_x 2 full.tsv)" 20 1e-9 "  under the force"
claim "--coupling goodman causes a warning" warns "coupling goodman neglects" rc-slip --mu 0.3 --tangential 20N --coupling goodman --report good.tsv -o good.rcg rigid.rcg
near "$(column displacement_x 2 good.tsv)" "$(column displacement_x 2 full.tsv)" 0.05 "  and is near"
claim "  it takes one pass per increment" test "$(column passes 1 good.tsv)" = "$(column increments 1 good.tsv)"
# under a normal load, with Goodman's simplification: (a/2c) ln((a + c)/(a - c)) = (mu/beta) K(sqrt(1 -
# c^2/a^2)), c/a = 0.918 (Spence 1975)
for n in 32 64; do rc-slip --quiet --mu 0.3 --tangential 0 --coupling goodman --increments $n --report s$n.tsv -o s.rcg rigid.rcg; done
near "$(awk -v a="$(column stick_fraction 1 s64.tsv)" 'BEGIN { print sqrt(a) }')" 0.918 "$coarse_grid" "pressed alone it sticks inside of Spence's radius"
near "$(column increment_error_estimate 1 s64.tsv)" "$(awk -v e="$(column increment_error_estimate 1 s32.tsv)" 'BEGIN { print e / 2 }')" 0.1 \
    "  and the error of increments falls as their number rises"
claim "--coupling none causes a warning" warns "16 to 87" rc-slip --mu 0.3 --tangential 20N --coupling none --report none.tsv -o none.rcg rigid.rcg
rc-pick --set e1=210e9 --set nu=0.3 --set e2=208e9 --set nu2=0.29 rigid.rcg -o alike.rcg
claim "  of bodies that are nearly alike with a smaller error" warns "beta -0.00736., and --coupling none .*tractions are wrong by up to 4.4 %" \
    rc-slip --mu 0.3 --tangential 20N --coupling none -o near.rcg alike.rcg
claim "  and --coupling goodman, whose error is .2 %, with no warning" bash -c 'rc-slip --mu 0.3 --tangential 20N --coupling goodman -o near.rcg alike.rcg 2>x.err; ! grep beta x.err'
claim "  pressing is then no case" test "$(wc -l <none.tsv)" = 2

# ---- messages ----

claim "the plan lists omitted effects" says "left out: beta = 0, so that pressure and tractions do not influence each other" rc-slip --mu 0.3 --tangential 36N --dry-run ball.rcg
claim "  it has the number of increments" says "to +P 240 N, 36 N, 0 N: 2 increments$" rc-slip --mu 0.3 --tangential 36N --dry-run ball.rcg
claim "  it lists active effects" says "beta +0.286: about 5 passes" rc-slip --mu 0.3 --tangential 36N --dry-run rigid.rcg
claim "a force close to sliding causes a warning" warns "the force is 0.995 of the friction limit" rc-slip --mu 0.3 --tangential 71.64N -o edge.rcg ball.rcg
rc-slip --mu 0.3 --displacement 1m --report slides.tsv -o slides.rcg ball.rcg 2>slides.err
claim "  a displacement beyond sliding causes none" test ! -s slides.err
near "$(column tangential_x 1 slides.tsv)" 72 1e-9 "    under all that friction carries"
near "$(column dissipated_energy 1 slides.tsv)" 72 1e-5 "    which takes the work of that force"
# the proposals of the messages, with a path of dissimilar bodies
rc-synth sphere --nx 16 --dx 40um --radius 7.5mm | rc-solve --quiet --load 240N --E1 210GPa --nu1 0.3 --E2 rigid -o coarse.rcg
proposed() { # OPTIONS...: prints the options that the last message proposes
    rc-slip --mu 0.3 --tangential 20N "$@" -o asked.rcg coarse.rcg 2>&1 | sed -n 's/.*take \(--increments [0-9]*\( --tol [0-9.e-]*\)\{0,1\}\).*/\1/p' | tail -n 1 || true
}
claim "a message about increments names a number" says '^--increments [0-9]*$' proposed
# shellcheck disable=SC2046
claim "  with it there is no message" test -z "$(rc-slip --mu 0.3 --tangential 20N $(proposed) -o asked.rcg coarse.rcg 2>&1)"
claim "  and where it would be too large, a tolerance that can be reached" says '^--increments 1000 --tol 0\.0[0-9]*$' proposed --tol 1e-6
# shellcheck disable=SC2046
claim "    as its run shows" rc-slip --mu 0.3 --tangential 20N $(proposed --tol 1e-6) --report most.tsv -o asked.rcg coarse.rcg
claim "  a force of the order of rounding is 0" warns 'a force of 0 N: the increments' rc-slip --mu 0.3 --tangential 20N -o asked.rcg coarse.rcg
rc-slip --verbose --mu 0.3 --path '240N,0,0; 240N,36N,0; 0,0,0' --report told.tsv -o asked.rcg ball.rcg 2>told.txt
told() { sed -n "s/.*case $1, .*$2 \([0-9.]*\) .*/\1/p" told.txt; }
near "$(told 2 'largest slip')e-9" "$(column largest_slip_total 2 told.tsv)" 1e-4 "--verbose prints the figures of each case: slip"
near "$(told 2 'displacement along x')e-9" "$(column displacement_x 2 told.tsv)" 1e-4 "  displacement"
claim "  without those that are unknown" lacks 'nan' told.txt
claim "  of rolling too" warns 'creepage along x 0.001, .*friction energy per length rolled' rc-slip --verbose --mu 0.3 --steady --creep 1e-3 -o asked.rcg ball.rcg
claim "too few increments for an estimate cause a warning" warns "increments 1 is too few to estimate" rc-slip --mu 0.3 --path '240N,40N,0' --increments 1 --report few.tsv -o big.rcg ball.rcg
claim "  the estimate is then null" test "$(column traction_error_estimate 1 few.tsv)$(column increment_error_estimate 1 few.tsv) $(column error_limited_by 1 few.tsv)" = "NaNNaN unknown"
refuses 3 'the increments cause an error of .* take --increments' "an error above --tol is not converged" "rc-slip --mu 0.3 --tangential 36N --tol 1e-4 --increments 8 --report tight.tsv -o tight.rcg ball.rcg"
claim "  the stream is marked, and a warning names the remedy" test "$(column converged 1 tight.tsv) $(column error_limited_by 1 tight.tsv)" = "false increments"
rc-pick --channel pressure --set yield=1e9 ball.rcg -o flowed.rcg
claim "a yielded body causes a warning" warns 'the body has yielded .yield stress 1e.09 Pa' rc-slip --mu 0.3 --tangential 20N -o flows.rcg flowed.rcg
claim "  a pressure at the hardness causes it too" warns 'the body has yielded .hardness 1e.09 Pa' rc-slip --mu 0.3 --tangential 20N -o flows.rcg <(rc-solve --quiet --load 240N $steel --hardness 1GPa sphere.rcg)
claim "  a pressure far below the hardness causes none" test -z "$(rc-slip --mu 0.3 --tangential 20N -o flows.rcg <(rc-solve --quiet --load 240N $steel --hardness 100GPa sphere.rcg) 2>&1)"
rc-pick --channel pressure ball.rcg | rc-pick --set converged=no >short.rcg
refuses 3 'converged' "a pressure that stopped short is carried on" "rc-slip --mu 0.3 --tangential 36N -o short2.rcg short.rcg"
claim "  the stream is marked" grep -aq '^converged=no' short2.rcg
claim "an interrupted run writes its current state" bash -c '
    rc-slip --mu 0.3 --tangential 20N --increments 2000 --progress line -o cut.rcg rigid.rcg 2>cut.err &
    until grep -q "increment [1-9]" cut.err || ! kill -0 $!; do sleep 0.02; done
    kill -TERM $!; wait $!; test $? = 143 && grep -aq "^converged=no" cut.rcg'

# ---- refusals ----

refuses 1 'force 80 N: friction carries less than 72 N' "a force beyond friction, with both numbers" "rc-slip --mu 0.3 --tangential 80N -o x.rcg ball.rcg"
claim "  no file is left" test ! -e x.rcg
refuses 2 'give --mu, as in --mu 0.3' "no coefficient" "rc-slip --tangential 1N -o x.rcg ball.rcg"
refuses 2 'one of --tangential' "no force" "rc-slip --mu 0.3 -o x.rcg ball.rcg"
refuses 2 'one of --tangential' "two of them" "rc-slip --mu 0.3 --tangential 1N --displacement 1um -o x.rcg ball.rcg"
refuses 2 'one value .along x. or two .x and y.' "a force in three directions" "rc-slip --mu 0.3 --tangential 1N,2N,3N -o x.rcg ball.rcg"
refuses 2 'LOAD,FX,FY' "a corner of two numbers" "rc-slip --mu 0.3 --path '240N,1N' -o x.rcg ball.rcg"
refuses 2 'must be finite and not negative' "a load that pulls" "rc-slip --mu 0.3 --path '-240N,1N,0' -o x.rcg ball.rcg"
printf '240N 0 0\n240N zero 0\n' >bad.txt
refuses 2 'line 2' "a history with a word, and its line" "rc-slip --mu 0.3 --history bad.txt -o x.rcg ball.rcg"
refuses 2 'bad.txt: line 2: the load must be finite and not negative' "  with a load that pulls" \
    "printf 'load/N fx/N fy/N\n-1 0 0\n' >bad.txt; rc-slip --mu 0.3 --history bad.txt -o x.rcg ball.rcg"
refuses 2 'No such file' "a history that is not there" "rc-slip --mu 0.3 --history none.txt -o x.rcg ball.rcg"
refuses 2 'auto or a number' "increments of 0" "rc-slip --mu 0.3 --tangential 1N --increments 0 -o x.rcg ball.rcg"
refuses 2 '--E1 has no effect without --E2' "one body" "rc-slip --mu 0.3 --tangential 1N --E1 1GPa --nu1 0.3 -o x.rcg ball.rcg"
refuses 1 'solve the contact for these bodies first' "other bodies" "rc-slip --mu 0.3 --tangential 1N --E1 1GPa --nu1 0.3 --E2 rigid -o x.rcg ball.rcg"
refuses 1 'leave out --nu' "a second Poisson's ratio" "rc-slip --mu 0.3 --tangential 1N --nu 0.2 -o x.rcg ball.rcg"
refuses 2 "Poisson's ratio is not in the stream" "none" "rc-solve --quiet --load 1N --estar 1GPa sphere.rcg | rc-slip --mu 0.3 --tangential 0.1N -o x.rcg"
rc-pick --channel pressure ball.rcg -o alone.rcg
refuses 1 'need a height in the same case' "another load without a height" "rc-slip --mu 0.3 --path '100N,0,0' -o x.rcg alone.rcg"
rc-pick --channel pressure rigid.rcg -o alone.rcg
refuses 1 'coupling goodman or none' "coupling without a height" "rc-slip --mu 0.3 --tangential 1N -o x.rcg alone.rcg"
rc-solve --quiet --load 1N --E1 210GPa --nu1 0.3 --E2 rigid --hardness 6GPa -o hard.rcg sphere.rcg
refuses 1 'key hardness .* take --coupling none and the load of the stream alone' "dissimilar bodies with a hardness" "rc-slip --mu 0.3 --tangential 0.1N --coupling goodman -o x.rcg hard.rcg"
claim "  which works" rc-slip --quiet --mu 0.3 --tangential 0.1N --coupling none -o x.rcg hard.rcg
rc-pick --channel pressure --set 'layers=1e-6,1e9,0.3;inf,2e9,0.3' ball.rcg -o coated.rcg
refuses 1 'only bodies without layers' "a coated body" "rc-slip --mu 0.3 --tangential 1N -o x.rcg coated.rcg"
refuses 1 'pressure' "a stream without a pressure" "rc-slip --mu 0.3 --tangential 1N -o x.rcg sphere.rcg"
rc-solve --quiet --load 240N $steel --hardness 1GPa -o soft.rcg sphere.rcg
refuses 1 'its key hardness says that the bodies are not elastic' "other loads of a body that yields" "rc-slip --mu 0.3 --path '100N,0,0' -o x.rcg soft.rcg"
claim "  the load of the stream is accepted" rc-slip --mu 0.3 --tangential 36N -o x.rcg soft.rcg
rc-solve --quiet --load 1mN --adhesion 50J/m2 --estar 1GPa -o pulls.rcg sphere.rcg
refuses 1 'negative at [0-9]* of 4096 nodes, and friction needs' "bodies that attract each other" "rc-slip --mu 0.3 --nu 0.3 --tangential 1N -o x.rcg pulls.rcg"
refuses 1 'boundary is free, which contradicts --periodic' "another boundary" "rc-slip --mu 0.3 --periodic --tangential 1N -o x.rcg ball.rcg"
claim "a decimal comma causes a warning" warns 'two values, 1 N and 5 N' rc-slip --mu 0.3 --tangential 1,5 -o x.rcg ball.rcg
refuses 1 '--memory allows' "too little memory" "rc-slip --mu 0.3 --tangential 1N --memory 1M -o x.rcg ball.rcg"

# ---- streams ----

cat ball.rcg rigid.rcg one.rcg | rc-slip --quiet --mu 0.3 --tangential 10N --increments 2 --report cases.tsv -o cases.rcg
claim "cases have consecutive numbers, and dissimilar bodies have two" test "$(cut -f 1,11 cases.tsv | tail -n +2 | awk '{ printf "%d:%.3f ", $1, $2 }')" = \
    "1:0.000 2:0.286 3:0.286 4:0.000 "
claim "  the frames have the same numbers" test "$(rc-info --json cases.rcg | grep -o '"case": [0-9]*,' | uniq | tr -dc '0-9\n' | tr '\n' ' ')" = "1 2 3 4 "
for threads in 1 2; do rc-slip --quiet --mu 0.3 --tangential 10N --threads $threads --increments 4 -o threads$threads.rcg rigid.rcg; done
claim "threads change no bit" cmp threads1.rcg threads2.rcg
rc-solve --quiet --load 240N --estar "$(rc-info --json rigid.rcg | grep -o '"estar": "[^"]*' | head -n 1 | sed 's/.*"//')" -o named.rcg sphere.rcg
rc-slip --quiet --mu 0.3 --tangential 10N --increments 4 --E1 210GPa --nu1 0.3 --E2 rigid --report named.tsv -o x.rcg named.rcg
rc-slip --quiet --mu 0.3 --tangential 10N --increments 4 --report known.tsv -o x.rcg rigid.rcg
near "$(column displacement_x 2 named.tsv)" "$(column displacement_x 2 known.tsv)" 1e-6 "bodies of the command line are those of the stream"
rc-synth wave --nx 64 --ny 1 --dx 1um --wavelength 64um --amplitude 0.1um -o wave.rcg
rc-solve --quiet --periodic --mean-pressure 1MPa --estar 1GPa wave.rcg | rc-slip --mu 0.3 --nu 0.3 --tangential 1uN --report profile.tsv -o profile.rcg
claim "a profile can slip" awk -v a="$(column stick_nodes 1 profile.tsv)" -v b="$(column slip_nodes 1 profile.tsv)" 'BEGIN { exit !(a > 0 && b > 0) }'
