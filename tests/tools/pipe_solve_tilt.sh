# SPDX-License-Identifier: GPL-3.0-or-later
# rc-solve --tilt free. A ball rolls to the point where the load acts, and planes in the heights do not
# matter. Without the option nothing changes. --at, checkpoints, lists and refusals are tested too.
. "$(dirname "$0")/../pipe.sh"

rc-synth paraboloid --nx 129 --ny 101 --dx 1um --radius 1mm,1mm -o ball.rcg
rc-synth selfaffine --nx 96 --ny 80 --dx 1um --hurst 0.8 --rms-height 0.2um --seed 3 -o rough.rcg
press="rc-solve --quiet --estar 100GPa --output pressure"

# ---- a ball ----

# Under a load beside its apex it touches there: the tilt is this distance over the radius, and the peak is
# Hertz's.
$press --load 1.0666N --tol 1e-5 --tilt free --at 11um,-7um --report rolled.json ball.rcg -o rolled.rcg
near "$(field tilt_x rolled.json)" -0.011 1e-3 "a ball leans by what its top is beside the load"
near "$(field tilt_y rolled.json)" 0.007 1e-3 "  along y too"
near "$(field max_pressure rolled.json)" "$(awk 'BEGIN { print (6 * 1.0666 * 1e22 / 1e-6) ^ (1 / 3) / 3.14159265 }')" "$coarse_grid" \
    "  and carries Hertz's largest pressure"
near "$(field approach rolled.json)" "$(awk 'BEGIN { print (9 * 1.0666 ^ 2 / (16 * 1e-3 * 1e22)) ^ (1 / 3) }')" "$coarse_grid" \
    "  at Hertz's approach"

# ---- a rough surface ----

$press --load 0.3N --tilt free --tol 1e-6 --report rest.json rough.rcg -o rest.rcg
rc-detrend --poly 1 rough.rcg | $press --load 0.3N --tilt free --tol 1e-6 --report level.json -o level.rcg
near "$(field contact_area level.json)" "$(field contact_area rest.json)" "$same" "a plane in the heights does not matter"
near "$(field max_pressure level.json)" "$(field max_pressure rest.json)" 1e-4 "  to the largest pressure"
# the moment, summed from the frame
claim "the moment is 0" bash -c "rc-export --format csv rest.rcg | grep -v '^#' | awk -F , '
    { for (i = 1; i <= NF; i++) { p += \$i; x += (i - 48.5) * \$i; y += (NR - 40.5) * \$i; f += (i - 48.5) ^ 2 * \$i } }
    END { exit !(NR == 80 && x * x + y * y < 1e-10 * p * f) }'"
$press --load 0.3N --tilt fixed --tol 1e-6 rough.rcg -o fixed.rcg
$press --load 0.3N --tol 1e-6 --report none.json rough.rcg -o none.rcg
claim "--tilt fixed equals no option" bash -c 'cmp -s <(rc-export --format csv fixed.rcg) <(rc-export --format csv none.rcg)'
claim "  its angles are null, with the reason" bash -c '
    grep -q "\"tilt_x\": null, \"tilt_y\": null" none.json && grep -q "\"tilt\": \"left out: no --tilt free\"" none.json'
claim "  --tilt free takes more convolutions" awk -v a="$(field convolutions none.json)" -v b="$(field convolutions rest.json)" 'BEGIN { exit !(b > a) }'
$press --load 0.1N,0.3N --tilt free --tol 1e-6 --report list.tsv rough.rcg -o list.rcg
near "$(total pressure list.rcg 1)" 0.1 "$summed" "a list of loads has the first one"
near "$(total pressure list.rcg 2)" 0.3 "$summed" "  and the last one"
near "$(awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ "^tilt_x") c = i } NR == 3 { print $c }' list.tsv)" \
    "$(field tilt_x rest.json)" 1e-4 "a list of loads comes to the same angle"
$press --approach "$(field approach rest.json)" --tilt free --tol 1e-6 --report back.json rough.rcg -o back.rcg
near "$(field load back.json)" 0.3 1e-4 "an approach comes to the load that makes it"
$press --load 0.3N --tilt free --tol 1e-6 --checkpoint kept.rcg --report first.json rough.rcg -o first.rcg
$press --load 0.3N --tilt free --tol 1e-6 --checkpoint kept.rcg --resume --report again.json rough.rcg -o again.rcg
near "$(field tilt_x again.json)" "$(field tilt_x first.json)" 1e-4 "resumed, it leans as before"
claim "  an impossible equilibrium is detected at once" awk -v a="$(field iterations first.json)" -v b="$(field iterations again.json)" 'BEGIN { exit !(4 * b < a) }'
claim "--dry-run lists the tilt" bash -c 'says "tilt +on" rc-solve --dry-run --load 1N --estar 1GPa --tilt free rough.rcg'

# ---- refusals ----

refuses 2 '--tilt free does not work with --periodic, because a periodic map has no centre of tilt' "a periodic map" "rc-solve --load 1N --estar 1GPa --periodic --tilt free rough.rcg"
refuses 2 '--tilt free does not work with --history' "a history" "rc-solve --load 1N --estar 1GPa --hardness 1GPa --history --tilt free rough.rcg"
refuses 2 '--at has no effect without --tilt free' "a place without" "rc-solve --load 1N --estar 1GPa --at 1um,0 rough.rcg"
refuses 2 'it must be X,Y' "half a place" "rc-solve --load 1N --estar 1GPa --tilt free --at 1um rough.rcg"
refuses 1 'it must act on the map' "a place beside the map" "rc-solve --load 1N --estar 1GPa --tilt free --at 50um,0 rough.rcg"
refuses 3 "may not be able to balance the load at this point" "what yields cannot balance any load" \
    "rc-solve --load 0.5N --estar 100GPa --hardness 0.1GPa --tilt free --at 40um,30um rough.rcg -o c.rcg"
