# SPDX-License-Identifier: GPL-3.0-or-later
# rc-solve --travel: each position is the contact of a map that rc-pick has cut or rc-add has summed. A
# resumed run writes the same bytes, and contradictions are refused.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 200 --ny 64 --dx 1um --hurst 0.8 --rms-height 20nm --short-cut 8um --seed 3 -o track.rcg
rc-synth selfaffine --nx 120 --ny 64 --dx 1um --hurst 0.8 --rms-height 20nm --short-cut 8um --seed 4 -o other.rcg
solve="rc-solve --load 50mN --radius 2mm --estar 100GPa --tol 1e-6 --quiet"
window="--travel=-3um:3um:7 --window 64x48"

claim "a ball travels in a window" bash -c "$solve $window --report moving.json -o moving.rcg track.rcg"
claim "each position is a case of four frames" says '^28$' bash -c "rc-info moving.rcg | grep -c 'case [1-7], frame'"
claim "the keys are the place of the contact and of body 2" says 'position=3e-06' bash -c "rc-info moving.rcg | tail -30"
claim "rc-pick cuts the window of the last position" bash -c "
    rc-pick --crop 71,8,64,48 track.rcg 2>cut.txt | $solve --report still.json -o still.rcg &&
    tail -1 moving.json >last.json && head -1 moving.json >first.json"
for name in max_pressure approach contact_area; do
    near "$(field $name last.json)" "$(field $name still.json)" 1e-5 "its $name"
done
# The approach is counted from the first touch at each position, the height of body 2 from a fixed datum: their sum
# is the largest height there, of the track less the paraboloid of the ball.
rc-export --format csv track.rcg | grep -v '^#' >track.csv
for case in 1 4 7; do
    sed -n "${case}s/\"effects\": {[^}]*}//p" moving.json >at.json
    near "$(awk "BEGIN { printf \"%.17g\", $(field height at.json) + $(field approach at.json) }")" \
        "$(awk -F, -v at=$((case - 4)) '{ y = NR - 32.5
            for (i = 1; i <= NF; i++) { x = i - 100.5 - at; z = $i - (x * x + y * y) * 1e-12 / 4e-3; if (NR == 1 && i == 1 || z > most) most = z } }
            END { printf "%.17g", most }' track.csv)" 1e-9 "height and approach at position $case make the largest height"
done
claim "  both can be drawn" bash -c "
    rc-render --curve position:height,approach -o curve.svg moving.json && says 'Height.*Approach|Approach.*Height' tr '\n' ' ' <curve.svg"

claim "rc-add sums the surfaces at position 0" bash -c "
    rc-add track.rcg other.rcg 2>cut.txt | $solve --report sum.json --output pressure -o sum.rcg &&
    $solve --travel 0 --counter other.rcg --window 120x64 --report two.json --output pressure -o two.rcg track.rcg"
near "$(field max_pressure two.json)" "$(field max_pressure sum.json)" 1e-5 "the largest pressure of two rough bodies"

claim "a run keeps its states" bash -c "$solve $window --checkpoint kept.rcg -o whole.rcg track.rcg"
claim "the resumed run gives the same bits" bash -c "
    $solve $window --checkpoint kept.rcg --resume -o again.rcg track.rcg && cmp whole.rcg again.rcg"
claim "some of its states are enough" bash -c "
    head -c 200000 kept.rcg >torn.rcg &&
    $solve $window --checkpoint torn.rcg --resume --report torn.json -o torn-out.rcg track.rcg && tail -1 torn.json >end.json"
near "$(field max_pressure end.json)" "$(field max_pressure last.json)" 1e-5 "the same largest pressure at the end"
refuses 1 'another problem: position was -3e-06, is -2e-06' "states of other positions" \
    "$solve --travel=-2um:3um:7 --window 64x48 --checkpoint kept.rcg --resume -o x.rcg track.rcg"

# ---- passes ----

rc-synth wave --nx 48 --ny 1 --dx 1um --wavelength 48um --amplitude 1nm -o wave.rcg
rc-add --subtract wave.rcg wave.rcg 2>cut.txt >flat.rcg
# p0/k 3.8 with a half width of 8 nodes
line="rc-solve --periodic --load 27571N/m --radius 401um --E1 200GPa --nu1 0.3 --E2 rigid --yield 1GPa --tol 0.05 \
    --travel=-24um:22um:24 --output pressure,residual --quiet"
claim "a body that yields is passed three times" bash -c "$line --passes 3 --checkpoint passes.rcg --report passes.tsv -o third.rcg flat.rcg"
claim "  frames are those of the last pass" says '^48$' bash -c "rc-info third.rcg | grep -c ', frame [0-9]* ('"
claim "  it shakes down, as a line contact below p0 = 4 k does" says '^null no yes$' bash -c "
    awk -F'\t' 'NR == 1 { for (k = 1; k <= NF; k++) at[\$k] = k }
        NR > 1 && \$at[\"strain_gain\"] != \"NaN\" { print \$at[\"shakedown\"] }' passes.tsv | sed 's/NaN/null/' | xargs"
claim "  the resumed run gives the same bits" bash -c "
    $line --passes 3 --checkpoint passes.rcg --resume --report resumed.tsv -o resumed.rcg flat.rcg && cmp third.rcg resumed.rcg"

# As after a power failure: the file ends after each of its states, also of a position where nothing flows.
short="${line/-24um:22um:24/-2um:2um:3} --passes 2 --interval 0"
$short --checkpoint all.rcg --report all.json -o all-out.rcg flat.rcg
states=$(grep -ac '^checkpoint.numbers=' all.rcg) # the last frame of each has its numbers
before_release && every=1 || every=8
goes_on() {
    local k
    for k in $(seq 1 $every "$states"); do
        perl -e 'local $/; open F, "all.rcg"; print join "", (<F> =~ /\G.*?^checkpoint.numbers=.*?RCGEND 1\n/gms)[0 .. $ARGV[0] - 1]' "$k" >part.rcg
        ${short/--interval 0/} --checkpoint part.rcg --resume --report part.json -o part-out.rcg flat.rcg || return
        tail -n 1 part.json >>ends.json
    done
}
claim "  a run continues from its $states states, each ${every}th is tried" goes_on
claim "  with the same largest pressure" bash -c "
    right=\$(tail -n 1 all.json | grep -o '\"max_pressure\": [^,]*' | cut -d' ' -f2)
    grep -o '\"max_pressure\": [^,]*' ends.json | cut -d' ' -f2 |
        awk -v right=\$right -v n=$(((states + every - 1) / every)) '{ d = \$1 / right - 1 } d * d > 1e-8 { exit 1 } END { exit NR != n }'"

# Below the limit the body carries the passes with the residual stress that they left (Melan); without it,
# it would yield. The strain is constant in each slab, so that the excess at the edges of slabs falls with
# their number: 2.8, 1.8 and 0.6 % with 24, 48 and 72. The residual stress is in equilibrium: no traction on the
# surface, no mean on a plane below.
$line --slabs 72 --passes 3 --output pressure,strain -o strained.rcg flat.rcg
rc-pick --case 72 strained.rcg -o last.rcg
most() { # STREAM [NAME]: the largest number with this name in all frames
    rc-info --json "$1" | grep -o "\"${2-maximum}\": [^,}]*" | awk '{ a = $2 < 0 ? -$2 : $2 } a > m { m = a } END { printf "%.9g", m }'
}
rc-stress --quiet --depths 1um:12um:23 --components mises -o both.rcg last.rcg
rc-pick --channel pressure --set slabs= last.rcg | rc-stress --quiet --depths 1um:12um:23 --components mises -o alone.rcg
between 0.97e9 "$(most both.rcg)" 1.015e9 "  the stress with the residual stress reaches the yield stress and not more"
between 1.1e9 "$(most alone.rcg)" 1.3e9 "  without it, it would exceed the yield stress"
rc-stress --quiet --residual --depths 0 --components szz,sxz -o surface.rcg last.rcg
rc-stress --quiet --residual --depths 5um --components szz,sxz -o inside.rcg last.rcg
between 0 "$(most surface.rcg)" 1 "  the residual stress leaves the surface free"
between 0 "$(most inside.rcg mean)" 1 "    and has no mean on a plane below"
between 1e6 "$(most inside.rcg)" 1e9 "    where it is not 0"
claim "  the gains make a curve" bash -c "rc-render --curve pass:strain_gain --log y -o gains.png passes.tsv && [ -s gains.png ]"
refuses 2 '--window does not work with --yield' "a window over plastic strain" "$line --window 8x1 flat.rcg"

claim "--dry-run counts the positions" says '64 x 48 nodes, boundary free, 7 positions' \
    bash -c "$solve $window --dry-run track.rcg"
refuses 2 '--travel does not work with --load LIST' "a list of loads" \
    "rc-solve --load 1mN,2mN --radius 2mm --estar 1GPa --travel 0 track.rcg"
refuses 2 '--travel has no effect without --radius, --cylinder or --counter, because nothing travels' "a contact without a body that travels" \
    "rc-solve --load 1mN --estar 1GPa --travel 0 track.rcg"
refuses 2 '--window has no effect without --travel' "a window that stays" \
    "rc-solve --load 1mN --estar 1GPa --window 8x8 track.rcg"
refuses 2 '--passes has no effect without --yield' "passes of an elastic body" "$solve --travel 0 --passes 3 track.rcg"
refuses 2 'must be numbers of nodes, WxH' "a window of one number" "$solve --travel 0 --window 64 track.rcg"
refuses 1 'window of 47 rows on a map of 64 rows.*take a window of 48 rows' "a window half a row beside the map" \
    "$solve --travel 0 --window 64x47 -o x.rcg track.rcg"
rc-pick --crop 0,0,120,63 other.rcg -o odd.rcg
refuses 1 'map of body 2 has 63 rows and the contact 48.*cut the map of body 2 to 62 rows' "a surface half a row beside the map" \
    "$solve --travel 0 --window 64x48 --counter odd.rcg -o x.rcg track.rcg"
refuses 1 'take positions from -6.8e-05 to 6.8e-05 m' "a window that leaves the map" \
    "rc-pick --set periodic=no track.rcg | $solve --travel 70um --window 64x48"
refuses 1 'does not cover the contact: take a longer map' "a counter surface that is too short" \
    "rc-pick --set periodic=no other.rcg -o short.rcg; $solve --travel 0 --counter short.rcg track.rcg"

# ---- a roller along y, on a map that repeats along y ----

roll="rc-solve --quiet --periodic=y --cylinder 2mm --load 1N/m --estar 1GPa --tol 1e-8"
rc-synth selfaffine --nx 128 --ny 24 --dx 1um --hurst 0.8 --rms-height 5nm --short-cut 8um --seed 5 | rc-pick --set periodic=y -o raceway.rcg
claim "a roller travels in a window with the rows of the map" bash -c "
    $roll --travel=-4um:4um:5 --window 96x24 --report roller.json -o roller.rcg raceway.rcg"
claim "  which repeats along y" says 'periodic=y.*boundary=periodic-y.*datum=9.6e-05' bash -c "rc-info roller.rcg | tr '\\n' ' '"
claim "rc-pick cuts the window of the last position" bash -c "
    rc-pick --crop 20,0,96,24 --set periodic=y raceway.rcg | $roll --report still.json -o still.rcg"
claim "  where the pressure is that of a contact of its own" awk '
    { d = $1 - $2; off += d < 0 ? -d : d; sum += $2 } END { exit !(NR == 96 * 24 && sum > 0 && off < 1e-6 * sum) }' \
    <(paste <(rc-pick --case 5 --channel pressure roller.rcg | rc-export --format xyz | awk '!/^#/ { print $3 }') \
        <(rc-pick --channel pressure still.rcg | rc-export --format xyz | awk '!/^#/ { print $3 }'))
refuses 1 'window 96x12: with --periodic=y it has the rows of the map: take 96x24' "a window of other rows" \
    "$roll --travel 0 --window 96x12 raceway.rcg"
refuses 2 '--window does not work with --periodic=x, because a window is not a period' "a window across the seam" \
    "${roll/--periodic=y --cylinder/--periodic=x --radius} --travel 0 --window 96x24 raceway.rcg"
refuses 2 '--window does not work with --periodic, because' "  of both axes" \
    "${roll/--periodic=y --cylinder/--periodic --radius} --travel 0 --window 96x24 raceway.rcg"
refuses 2 '--travel does not work with --cylinder and --periodic=x' "a roller along its axis" \
    "${roll/--periodic=y/--periodic=x} --travel 0 raceway.rcg"
rc-pick --crop 0,0,120,12 raceway.rcg -o fewer.rcg
refuses 1 'both surfaces must have the same period' "a counter surface of another period" \
    "$roll --travel 0 --counter fewer.rcg raceway.rcg"
