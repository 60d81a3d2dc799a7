# SPDX-License-Identifier: GPL-3.0-or-later
# Under mpirun each model gives the stream and the figures of one process, also where a process has no rows or
# no contact; bad input, short memory and a killed process end all processes. RC_RANKS: the numbers of
# processes to compare with one, by default "2".
. "$(dirname "$0")/../pipe.sh"
ranks=${RC_RANKS:-2}
export RC_THREADS=1

# figures REPORT: without those of the run itself.
figures() {
    sed -E 's/"(threads|ranks|exchanges|messages|bytes_exchanged|other_bytes|exchange_seconds|peak_memory|memory_estimate)": [^,}]*(, )?//g
        s/"seconds": \{[^}]*\}(, )?//; s/"kernel": "(the fastest engine|several processes)[^"]*"//' "$1"
}
# same "command without -o and --report": 1 process and each other number of processes write the same.
same() {
    local command=$1 n
    bash -c "$command -o alone.rcg --report alone.json" || [ $? = 3 ] || return
    for n in $ranks; do
        $MPIRUN -n "$n" bash -c "$command -o shared.rcg --report shared.json" || [ $? = 3 ] || return
        cmp alone.rcg shared.rcg && diff <(figures alone.json) <(figures shared.json) || return
    done
}
# 45 rows are three units, so that one of four processes has none. The ball touches in the middle unit only.
rc-synth selfaffine --nx 131 --ny 45 --dx 1um --hurst 0.8 --rms-slope 0.1 --short-cut 8um --seed 5 -o rough.rcg
rc-synth selfaffine --nx 160 --ny 57 --dx 1um --hurst 0.8 --rms-slope 0.05 --short-cut 8um --seed 7 -o other.rcg
rc-synth selfaffine --nx 128 --ny 96 --dx 1um --hurst 0.8 --rms-slope 0.1 --short-cut 8um --long-cut 60um --seed 5 -o even.rcg
rc-synth sphere --nx 131 --ny 45 --dx 1um --radius 200um -o ball.rcg
rc-solve --periodic --estar 1GPa --mean-pressure 2MPa --quiet -o pressed.rcg rough.rcg
rc-solve --periodic --estar 1GPa --mean-pressure 2MPa,4MPa --quiet -o loads.rcg rough.rcg
rc-solve --estar 1GPa --load 0.2mN --quiet -o pressed-ball.rcg ball.rcg

# ---- surfaces ----

synth() {
    local n
    rc-synth "$@" -o alone.rcg || return
    for n in $ranks; do
        $MPIRUN -n "$n" rc-synth "$@" -o shared.rcg && cmp alone.rcg shared.rcg || return
    done
}
claim "a surface from a seed" synth selfaffine --nx 131 --ny 45 --dx 1um --hurst 0.8 --rms-height 0.1um --anisotropy 3 --direction 20 --threads 2
claim "  a profile along y" synth selfaffine --nx 1 --ny 300 --dx 1um --hurst 0.5 --rms-slope 0.1
claim "a paraboloid beside the middle" synth paraboloid --nx 64 --ny 45 --dx 1um --dy 0.7um --radius 2mm,1mm --direction 30 --place 3um,-7.3um
claim "a cone on the highest node of another process" synth cone --slope 0.05 --like even.rcg --place highest
claim "a wave" synth wave --nx 64 --ny 39 --dx 1um --amplitude 1um --wavelength 16um,13um
refuses 1 'no node lies within the radius' "a punch between nodes" "$MPIRUN -n 2 rc-synth punch --nx 64 --dx 1um --radius 0.1um --height 5um -o no.rcg"
claim "  the message is printed once" test "$(grep -c 'no node' refuses.err)" = 1
refuses 1 'not Gaussian need the whole map' "skewed heights" "$MPIRUN -n 2 rc-synth selfaffine --nx 64 --dx 1um --hurst 0.5 --rms-slope 0.1 --skewness -1 -o no.rcg"

# ---- models ----

# Every exchange waits for the other process, so few steps and a large tolerance keep their number small. The bytes of
# unfinished iterations are as sensitive to a wrong sum as those of a solution.
yield="rc-solve --E1 100GPa --nu1 0.3 --E2 rigid --yield 1GPa,20GPa --slabs 2 --increments 1 --tol 1e-1 --quiet"
yields() { grep -q '"plastic_volume": [1-9]' shared.json; }
claim "yield, periodic, a history" same "$yield --periodic --mean-pressure 20MPa,5MPa,25MPa --history --output pressure,strain,plastic,residual rough.rcg"
claim "  the body yields" yields
deep=${yield/--slabs 2/--slabs 8}
claim "yield, deep slabs on coarser grids" same "$deep --periodic --mean-pressure 30MPa --output pressure,strain even.rcg"
claim "  the body yields" yields
claim "yield, free, slabs chosen, several threads" same "RC_THREADS=2 ${yield/1GPa,20GPa --slabs 2/0.5GPa,20GPa} --load 40mN,0 --history ball.rcg"
claim "  the body yields" yields
claim "creep" same "rc-solve --periodic --relaxation 1MPa,9MPa:1s --nu1 0.5 --E2 rigid --mean-pressure 20kPa --time 0,1s --increments 4 --quiet rough.rcg"
claim "relaxation at an approach" same "rc-solve --relaxation 1MPa,9MPa:1s --nu1 0.5 --E2 rigid --approach 0.5um --time 0,1s --increments 4 --quiet ball.rcg"
speed="rc-solve --relaxation 1MPa,9MPa:1s --nu1 0.5 --E2 rigid --quiet --speed"
claim "sliding on rubber, loads and an approach" same "$speed 10um/s,-40um/s --periodic --mean-pressure 20kPa rough.rcg"
claim "  an approach, a repeated track, several threads" same "RC_THREADS=2 $speed 10um/s --track repeated --periodic --approach 0.5um rough.rcg"
travel="rc-solve --estar 1GPa --radius 200um --load 1mN --quiet"
claim "travel against a rough map with more rows" same "$travel --travel=-1um,0,0.5um --counter other.rcg rough.rcg"
claim "travel of a window" same "$travel --travel=-1um,0,1um --window 110x37 rough.rcg"
claim "travel over a body that yields" same "$yield --periodic --radius 200um --load 30mN --travel=-1um,0,1um --passes 2 rough.rcg"
claim "  it yields" yields
wear="rc-wear --coefficient 1e-3mm3/Nm,1e-3mm3/Nm --tol 0.3 --quiet"
claim "wear" same "$wear --distance 1mm,2mm pressed.rcg"
claim "  its report has the exchanges" grep -q '"exchanges": [1-9]' shared.json
claim "wear to a contact area" same "$wear --distance 10m --until area=0.05 pressed.rcg"
claim "wear of a track" same "$wear --motion track:1mm --distance 10mm pressed-ball.rcg"
rough_wear="${wear/0.3/0.5} --motion sliding --counter rough.rcg --distance 5um pressed.rcg"
claim "wear of two rough bodies" same "$rough_wear"
slip="rc-slip --mu 0.3 --quiet --tol 0.1 --output pressure,traction-x,traction-y,slip-x,slip-y,state,slip,dissipation"
for edges in "" --periodic; do
    rc-solve --quiet $edges --E1 3GPa --nu1 0.3 --E2 3GPa --nu2 0.3 --mean-pressure 60MPa -o similar$edges.rcg rough.rcg
    rc-solve --quiet $edges --E1 3GPa --nu1 0.3 --E2 rigid --mean-pressure 60MPa -o dissimilar$edges.rcg rough.rcg
    claim "friction, loads and forces${edges:+, periodic}" same \
        "$slip --path '0.3N,0,0; 0.3N,50mN,0; 0.2N,30mN,20mN; 0,0,0; 0.3N,20mN,0' --increments 2 similar$edges.rcg"
    claim "  a displacement" same "$slip --displacement 0.5um,0.2um --tau-max 60MPa similar$edges.rcg"
    claim "  dissimilar bodies" same "$slip --tangential 30mN --increments 1 dissimilar$edges.rcg"
done
claim "friction, several threads" same "RC_THREADS=2 $slip --tangential 30mN,30mN similar--periodic.rcg"
# Spectra in double and in single precision have other columns on each process; on the ball only one has contact.
claim "friction of a ball" same "$slip --nu 0.3 --tangential 20uN,10uN pressed-ball.rcg"

# Rolling has coarser grids, whose rows belong to other processes, where the contact is 32 nodes long. The balls touch in the
# rows of both processes. Where the map repeats along y, an odd number of rows stays, and the coarse cells are not square.
roll="rc-slip --mu 0.3 --quiet --tol 3e-2 --output pressure,traction-x,traction-y,slip-x,slip-y,state,slip,dissipation"
steady="$roll --steady"
rolls="$roll --nu 0.3"
rc-synth sphere --nx 69 --ny 71 --dx 1um --dy 1.1um --radius 400um |
    rc-solve --quiet --E1 3GPa --nu1 0.3 --E2 3GPa --nu2 0.3 --load 20mN -o rolls-alike.rcg
rc-pick --crop 0,0,45,71 rolls-alike.rcg >at-edge.rcg
rc-synth sphere --nx 66 --ny 66 --dx 1um --radius 400um -o even-ball.rcg
rc-solve --quiet --E1 3GPa --nu1 0.3 --E2 rigid --load 10mN -o rolls-unlike.rcg even-ball.rcg
rc-solve --quiet --periodic=y --estar 1GPa --load 10mN -o rolls-repeated.rcg even-ball.rcg
for rows in 75 76; do
    rc-synth selfaffine --nx 91 --ny $rows --dx 1um --hurst 0.8 --rms-slope 0.02 --short-cut 8um --seed 5 |
        rc-solve --quiet --periodic=y --cylinder 1mm --E1 3GPa --nu1 0.3 --E2 $([ $rows = 75 ] && echo 3GPa --nu2 0.3 || echo rigid) --load 500N/m -o line-$rows.rcg
done
rc-synth cylinder --nx 200 --ny 1 --dx 1um --radius 1mm --direction 90 | rc-solve --quiet --periodic=y --estar 1GPa --load 2kN/m -o line-profile.rcg
rc-solve --quiet --estar 1GPa --radius 200um --load 1mN --travel=-4um,-3um,-1um rough.rcg -o way.rcg
rc-solve --quiet --estar 1GPa --radius 200um --load 1mN --travel=-3um,0,3um --window 110x37 rough.rcg -o way-window.rcg
rc-solve --quiet --periodic --E1 3GPa --nu1 0.3 --E2 rigid --radius 200um --load 1mN --travel=-3um,0,3um rough.rcg -o way-unlike.rcg
further() { ! before_release || claim "$@"; }
ranks="2 3 4" claim "rolling, steady: a contact on one process" same "$steady --nu 0.3 --creep 1e-3,5e-4,300 pressed-ball.rcg"
claim "  coarser grids, with spin" same "$steady --creep 2e-3,1e-3,200 rolls-alike.rcg"
claim "    there are such grids" grep -q '"discretization_error_estimate": [0-9]' shared.json
further "  a force" same "$steady --creep-force 3mN,1mN rolls-alike.rcg"
claim "  creepages from stick to full slip, several threads" same \
    "RC_THREADS=2 $steady --tau-max 30MPa --creep 1e-4:5e-2:log:3,0,0:200:3 rolls-alike.rcg"
claim "  dissimilar bodies, even rows" same "$steady --creep 2e-3,-1e-3,200 rolls-unlike.rcg"
further "  dissimilar bodies, a force" same "$steady --creep-force 1mN,0.5mN rolls-unlike.rcg"
claim "  spin on a map that repeats along y" same "$steady --nu 0.3 --creep 1e-3,0,300 rolls-repeated.rcg"
claim "  a line contact, odd rows of a map that repeats" same "$steady --creep 1e-3,1e-3 line-75.rcg"
further "    a force" same "$steady --creep-force 3mN,1mN line-75.rcg"
further "  a line contact, even rows, dissimilar bodies" same "$steady --creep 1e-3,1e-3 line-76.rcg"
claim "  a profile" same "$steady --nu 0.3 --creep 1e-3,1e-3 line-profile.rcg"
ranks="2 3 4" claim "rolling over a path, with spin" same "$rolls --creep 1e-3,5e-4,300 way.rcg"
further "  a force" same "$rolls --creep-force 0.1mN,0.05mN way.rcg"
claim "  in a window that moves, several threads" same "RC_THREADS=2 $rolls --creep 1e-3,5e-4 way-window.rcg"
claim "  periodic, dissimilar bodies" same "$roll --creep 1e-3,5e-4 way-unlike.rcg"
further "    a force" same "$roll --creep-force 0.1mN,5uN way-unlike.rcg"

# A pass along y needs columns of all processes; positions need the neighbouring rows. The results of positions have more
# columns than the map, and therefore other rows on each process.
fatigue="rc-fatigue --nu 0.3 --bending-limit 20MPa --torsion-limit 12MPa --criteria crossland,dangvan,papadopoulos,findley,amplitude --planes --life 3 --quiet"
rc-pick --channel pressure --crop 5,0,120,45 pressed-ball.rcg >one.rcg
for ((k = 0; k < 6; k++)); do rc-pick --set position="$((k * k))e-6" one.rcg; done >positions.rcg
rc-stress --quiet --nu 0.3 --depths 4um --components sxx,syy pressed-ball.rcg | rc-pick --crop 65,0,1,45 -o lines.rcg
rc-slip --nu 0.3 --mu 0.3 --quiet --tol 0.1 --increments 1 --tangential 20uN --output pressure,traction-x,traction-y -o slipped.rcg pressed-ball.rcg
claim "fatigue, a pass along x" same "$fatigue --criteria crossland,shakedown --yield 10MPa --pass x --depths auto pressed.rcg"
claim "  a pass along y, several threads" same "RC_THREADS=2 $fatigue --pass y --depths 1um,4um pressed.rcg"
claim "  free, with traction and residual stress" same "$fatigue --pass x --depths 4um --residual lines.rcg slipped.rcg"
claim "  positions" same "$fatigue --depths 1um,4um positions.rcg"
bands() {
    $MPIRUN -n 2 $fatigue --depths 1um,4um --memory 1700k -o bands.rcg --report bands.json positions.rcg &&
        ! grep -q '"bands": 1,' bands.json && cmp alone.rcg bands.rcg &&
        diff <(figures alone.json | sed 's/"bands": [0-9]*//') <(figures bands.json | sed 's/"bands": [0-9]*//')
}
claim "    little memory: the same in bands of rows" bands
refuses 1 'need about .* --memory allows' "    too little memory" "$MPIRUN -n 2 $fatigue --depths 1um,4um --memory 1M -o no.rcg positions.rcg"
claim "      the message is printed once" test "$(grep -c 'need about' refuses.err)" = 1
claim "  loads of a contact that stays, periodic" same "$fatigue --depths 20um pressed.rcg loads.rcg"

# The ball touches on one process only. Where nx is even, the last column of a spectrum has waves of two nodes. A
# line contact goes around a map that repeats along one axis.
rc-solve --periodic --estar 1GPa --mean-pressure 2MPa --quiet -o pressed-even.rcg even.rcg
bodies="--conductivity 45W/mK,16W/mK --diffusivity 12mm2/s,4mm2/s --tol 0.1 --quiet"
heat="rc-heat --mu 0.3 $bodies"
for axis in x y; do
    rc-synth cylinder --nx 91 --ny 93 --dx 1um --radius 1mm --direction $([ $axis = y ] && echo 90 || echo 0) |
        rc-solve --periodic=$axis --estar 1GPa --approach 10nm --quiet -o line-$axis.rcg
done
rc-slip --mu 0.3 --nu 0.3 --quiet --tol 0.1 --increments 1 --path '0.2mN,0,0; 0.2mN,20uN,0; 0.2mN,-20uN,0' \
    --output pressure,dissipation pressed-ball.rcg | rc-pick --case 2,3 -o cycle.rcg
claim "heat, free, below the surface" same "$heat --speed 1m/s,0.3m/s --bulk 20degC,25degC --depths 0,3um pressed-ball.rcg"
claim "  periodic, in time steps, several threads" same \
    "RC_THREADS=2 $heat --speed 1m/s,2m/s --time 1us --time-steps 2 pressed-even.rcg"
claim "  as many steps as the tolerance needs, a line contact along y" same "$heat --moving 1m/s,0.8m/s --time 1us line-y.rcg"
claim "  one share, a line contact along x" same "$heat --speed 0,2m/s --moving 1 --time 1us --partition blok line-x.rcg"
claim "  of a cycle of micro-slip" same "rc-heat --frequency 50Hz $bodies cycle.rcg"

# With adhesion a free map is solved on a padded grid, of which the second process has the padding only.
rc-synth sphere --nx 51 --ny 45 --dx 3um --radius 200um -o small-ball.rcg
rc-synth wave --nx 35 --ny 128 --dx 2um --amplitude 1fm --wavelength 256um -o tall.rcg
rc-synth selfaffine --nx 262 --ny 253 --dx 1um --hurst 0.8 --rms-slope 0.05 --short-cut 8um --seed 5 -o large.rcg
stick="rc-solve --quiet --adhesion 50mJ/m2"
claim "adhesion, free, loads and a pull-off" same \
    "$stick --estar 2MPa --load 0.1mN,0 --pull-off --output pressure,gap,displacement,adhesion small-ball.rcg"
claim "  a history of approaches with a hardness" same \
    "$stick --estar 2MPa --load 2mN,0.1mN,3mN --history --hardness 0.4MPa --output pressure,height,gap small-ball.rcg"
# The cut-off parts of steps, which only a map of 65536 nodes and more computes from near nodes.
claim "  periodic, under a load: near nodes of other processes" same "$stick --periodic --estar 1GPa --mean-pressure 2MPa large.rcg"
claim "    they replace convolutions" grep -qE '"convolutions": [0-9]+\.[0-9]{3}' alone.json
claim "  periodic, several threads: approaches" same "RC_THREADS=2 $stick --periodic --estar 1GPa --approach 0.2um,0.4um,0 large.rcg"
claim "  a cylinder, across the rows of all processes" same \
    "$stick,jkr --estar 2MPa --cylinder 1mm --periodic=x --approach 0 $(before_release && echo --pull-off) tall.rcg"

# ---- states ----

# kept COMMAND [PARTS]: two processes write the checkpoint of one. Its first half, or each of these parts,
# resumes on one and on three.
kept() {
    local command="$1 --interval 0" n middle part
    rm -f *.kept
    $command --checkpoint alone.kept -o alone.rcg || [ $? = 3 ] || return
    $MPIRUN -n 2 $command --checkpoint shared.kept -o shared.rcg || [ $? = 3 ] || return
    cmp alone.kept shared.kept && cmp alone.rcg shared.rcg || return
    for part in ${2:-0.5}; do
        middle=$(perl -0777 -ne 'push @at, pos while /RCGEND 1\n/g; print $at[$#at * '$part']' shared.kept)
        for n in 1 3; do
            head -c "$middle" shared.kept >"resumed-$n.kept"
            $MPIRUN -n "$n" $command --checkpoint "resumed-$n.kept" --resume -o "resumed-$n.rcg" || [ $? = 3 ] || return
        done
        cmp resumed-1.rcg resumed-3.rcg && cmp resumed-1.kept resumed-3.kept || return
    done
}
claim "a checkpoint of yield" kept "$yield --periodic --mean-pressure 20MPa,5MPa --history rough.rcg"
claim "  of yield, deep slabs on coarser grids" kept "$deep --periodic --mean-pressure 20MPa even.rcg"
claim "  of creep" kept "rc-solve --periodic --relaxation 1MPa,9MPa:1s --nu1 0.5 --E2 rigid --mean-pressure 20kPa --time 0,1s --increments 2 --tol 0.1 --quiet rough.rcg"
claim "  of sliding on rubber" kept "$speed 10um/s --periodic --mean-pressure 20kPa rough.rcg"
claim "  of wear" kept "$wear --distance 1mm pressed.rcg"
# The states of the first point have no maps.
claim "  of adhesion with a hardness" kept "$stick --estar 2MPa --load 2mN,0.1mN --history --hardness 0.4MPa small-ball.rcg" "0 0.7"
claim "  of friction" kept "rc-slip --nu 0.3 --mu 0.3 --quiet --tol 0.1 --increments 1 --tangential 20uN --output pressure,traction-x,dissipation pressed-ball.rcg"
# A state on a coarser grid has no maps, and begins the point again.
claim "  of steady rolling" kept "$steady --creep 1e-3,0 rolls-alike.rcg" "0.3 0.9"
claim "  of rolling over a path" kept "$rolls --creep 1e-3,5e-4 way.rcg" "0.5 0.8"
if before_release; then
    claim "  of steady rolling, a force" kept "$steady --creep-force 1mN,0.5mN rolls-unlike.rcg" "0.3 0.6 0.9"
    claim "  of rolling over a path, a force" kept "$roll --creep-force 0.1mN,5uN way-unlike.rcg" "0.4 0.8"
    claim "  of adhesion, pulled off" kept "$stick --estar 2MPa --load 2mN,0.1mN --pull-off small-ball.rcg"
    claim "  of friction, loads and forces" kept "$slip --path '0.3N,0,0;0.3N,50mN,0;0.2N,30mN,20mN' --increments 4 similar.rcg"
    claim "  of friction, dissimilar bodies" kept "$slip --tangential 30mN --increments 2 dissimilar--periodic.rcg"
    claim "  of yield, no contact on one process" kept "${yield/1GPa/0.5GPa} --load 40mN,60mN --history ball.rcg"
    claim "  of travel over a body that yields" kept "$yield --periodic --radius 200um --load 30mN --travel=-2um,0,2um --passes 2 rough.rcg"
    claim "  of wear of two rough bodies" kept "$rough_wear"
fi

# ---- faults ----

run="$MPIRUN -n 2"
# NaN in the last row.
perl -0777 -ne '/^(.*?\n\n)(.*)crc32/s; $v = $2; substr($v, 8 * (131 * 44 + 7), 8) = "\0\0\0\0\0\0\xf8\x7f";
    print "$1${v}crc32 00000000\nRCGEND 1\n"' ball.rcg | reseal >nan.rcg
refuses 1 '1 of 5895 values are NaN or infinite, the first in column 7 of row 44' "NaN in the last row" \
    "$run $yield --load 40mN -o no.rcg nan.rcg"
claim "  the message is printed once" test "$(grep -c 'are NaN' refuses.err)" = 1
refuses 1 'repeats along one axis only cannot be shared among processes' "yield on a map that repeats along one axis" \
    "$run ${yield/1GPa/0.5GPa} --periodic=x --load 40mN -o no.rcg ball.rcg"
claim "  the message is printed once" test "$(grep -c 'along one axis' refuses.err)" = 1
refuses 1 'several processes needs a periodic map' "sliding on a free map" "$run $speed 10um/s --load 1mN -o no.rcg ball.rcg"
claim "  the message is printed once" test "$(grep -c 'needs a periodic' refuses.err)" = 1
refuses 1 'rotate the map with rc-pick --rotate 90' "  along y" "$run $speed 10um/s --along y --periodic --mean-pressure 20kPa -o no.rcg rough.rcg"
refuses 1 'the contact reaches the leading edge of the map, column 44 of 45' "rolling, a contact at the edge" \
    "$run $steady --creep 1e-3,0 -o no.rcg at-edge.rcg"
claim "  the message is printed once" test "$(grep -c 'leading edge' refuses.err)" = 1
refuses 1 'the contact reaches half a period from its middle' "  spin of a line contact" "$run $steady --creep 1e-3,0,9 -o no.rcg line-75.rcg"
refuses 1 'friction carries less than' "  a force above the limit" "$run $steady --creep-force 9N -o no.rcg rolls-alike.rcg"
rc-pick --channel pressure --case 1 way.rcg | sed 's/^dx=1e-06$/dx=4e-06/' | reseal >long-cells.rcg
refuses 1 'processes cannot share the map' "  a path on long cells" "$run $rolls --creep 1e-3,0 -o no.rcg long-cells.rcg"
refuses 1 'friction carries less than' "a force above the limit" "$run $slip --tangential 9N -o no.rcg similar.rcg"
claim "  the message is printed once" test "$(grep -c 'carries less' refuses.err)" = 1
relax="rc-solve --periodic --relaxation 1MPa,9MPa:1s --nu1 0.5 --E2 rigid --mean-pressure 20kPa --time 0,1s --increments 2 --quiet"
refuses 1 'NaN or infinite, the first in column 7 of row 44' "  creep" "$run $relax -o no.rcg nan.rcg"
refuses 1 'NaN or infinite, the first in column 7 of row 44' "  adhesion" "$run $stick --estar 1GPa --load 1mN -o no.rcg nan.rcg"
refuses 1 'NaN or infinite, the first in column 7 of row 44' "  travel: the counter surface" "$run $travel --travel=-1um,0,0.5um --counter nan.rcg -o no.rcg rough.rcg"
perl -MCompress::Zlib -0777 -pe 's/(RCG1\nchannel=height\n.*?\n\n.{46160}).{8}(.{992})crc32 .{8}\n/
    my $to = "$1\0\0\0\0\0\0\xf8\x7f$2"; sprintf("%scrc32 %08x\n", $to, crc32($to))/se' pressed.rcg >nan-pressed.rcg
refuses 1 'height 5770 is not a finite number' "  wear" "$run $wear --distance 0.01m -o no.rcg nan-pressed.rcg"
claim "  nothing else is printed" test "$(grep -ac '^rc-wear' refuses.err)" = 1
refuses 1 'NaN or infinite, the first in column 7 of row 44' "  sliding on rubber" "$run $speed 10um/s --periodic --mean-pressure 20kPa -o no.rcg nan.rcg"
perl -MCompress::Zlib -0777 -pe 's/(RCG1\nchannel=pressure\n.*?\n\n.{46160}).{8}(.{992})crc32 .{8}\n/
    my $to = "$1\0\0\0\0\0\0\xf8\x7f$2"; sprintf("%scrc32 %08x\n", $to, crc32($to))/se' pressed.rcg >nan-pressure.rcg
for command in "$slip --nu 0.3 --tangential 20uN" "$heat --speed 1m/s --time 1us" "$fatigue --pass x --depths 4um"; do
    refuses 1 'NaN or infinite, the first in column 6 of row 44' "  ${command%% *}" "$run $command -o no.rcg nan-pressure.rcg"
    claim "    the message is printed once" test "$(grep -ac 'are NaN' refuses.err)" = 1
done
perl -MCompress::Zlib -0777 -pe 's/(RCG1\nchannel=pressure\n.*?\n\n.{46160}).{8}(.{992})crc32 .{8}\n/
    my $to = "$1\0\0\0\0\0\0\xf0\xbf$2"; sprintf("%scrc32 %08x\n", $to, crc32($to))/se' pressed.rcg >pulled.rcg
refuses 1 'pressure -1 Pa at column 6, row 44' "  heat of a negative pressure" "$run $heat --speed 1m/s --time 1us -o no.rcg pulled.rcg"
claim "  nothing else is printed" test "$(grep -ac '^rc-heat' refuses.err)" = 1
# An allocation of the second process fails: the work is done nevertheless, or all end with status 1 and a message.
memory() {
    local command=$1 n last status
    rm -f count
    for ((n = 0; n <= ${last:-0}; n += last / ${RC_TRIES:-3} + 1)); do
        timeout -s KILL 60 $MPIRUN -n 1 $command -o no.rcg : -n 1 env LD_PRELOAD="$RC_FAILING_MALLOC" RC_FAULT_AT="$n" \
            RC_FAULT_COUNT="$PWD/count" $command -o no.rcg 2>memory.err
        status=$?
        [ $n != 0 ] || last=$(cat count)
        [ $status = 0 ] || { [ $n != 0 ] && [ $status = 1 ] && grep -aq '^rc-[a-z]*: ' memory.err && [ ! -e no.rcg ]; } ||
            { echo "allocation $n of $last: status $status: $(cat memory.err)" >&2 && return 1; }
        rm -f no.rcg
    done
    echo "$last allocations" >&2
}
export ASAN_OPTIONS="${ASAN_OPTIONS-}:verify_asan_link_order=0"
claim "allocations of one process fail: yield" memory "${yield/1GPa/0.5GPa} --load 40mN ball.rcg"
claim "  adhesion" memory "$stick --estar 2MPa --load 0.1mN --tol 1e-3 small-ball.rcg"
claim "  friction" memory "rc-slip --nu 0.3 --mu 0.3 --quiet --tol 0.1 --tangential 20uN pressed-ball.rcg"
claim "  steady rolling" memory "$steady --nu 0.3 --creep-force 50uN,5uN pressed-ball.rcg"
claim "  rolling over a path" memory "$rolls --creep 1e-3,0 way.rcg"
claim "  creep" memory "$relax --tol 0.1 rough.rcg"
claim "  wear" memory "$wear --distance 1mm pressed-ball.rcg"
claim "  heat" memory "$heat --speed 1m/s --time 1us line-x.rcg"
# kill_second PID: the second process of this launcher.
kill_second() {
    local child victim=
    for child in $(pgrep -P "$1"); do
        ! grep -zqsx '\(OMPI_COMM_WORLD\|PMI\)_RANK=1' "/proc/$child/environ" || victim=$child
    done
    kill -KILL "$victim"
}
# killed COMMAND: it prints its progress, and its second process is killed after the first lines.
killed() {
    local launcher
    rm -f no.rcg
    $run $1 --progress line -o no.rcg >/dev/null 2>killed.err &
    launcher=$!
    until [ "$(grep -ac '^rc-' killed.err)" -ge 2 ] || ! kill -0 "$launcher"; do sleep 0.05; done
    kill_second "$launcher" || return
    wait "$launcher" && echo "it ended first: $(tail -n 3 killed.err)" >&2 && return 1
    [ -z "$(ls no.rcg* 2>/dev/null)" ]
}
claim "a process that is killed among the increments ends all and leaves no file" \
    killed "${yield/--increments 1 --tol 1e-1 --quiet/} --periodic --increments 200 --mean-pressure 60MPa,20MPa,70MPa --history rough.rcg"
further "  adhesion" killed "${stick/--quiet/} --periodic --estar 1GPa --approach 0:1um:400 rough.rcg"
further "  creep" killed "${relax/--increments 2 --quiet/} --increments 400 rough.rcg"
further "  sliding on rubber" killed "${speed/--quiet --speed/--speed} 1um/s:100um/s:40 --periodic --mean-pressure 20kPa rough.rcg"
further "  travel" killed "${travel/--quiet/} --travel=-20um:20um:400 rough.rcg"
further "  friction" killed "rc-slip --mu 0.3 --nu 0.3 --tol 1e-6 --tangential 1mN --increments 200 pressed.rcg"
further "  steady rolling" killed "${steady/--quiet --tol 3e-2/--tol 1e-6} --creep 1e-4:5e-2:log:60,0 rolls-alike.rcg"
further "  wear" killed "rc-wear --coefficient 1e-3mm3/Nm --distance 1m --tol 1e-3 pressed.rcg"
further "  heat" killed "${heat/--tol 0.1 --quiet/} --speed 1m/s --time 1us --time-steps 900 pressed.rcg"
further "  fatigue" killed "${fatigue/--quiet/} --pass x --depths 1um:40um:80 pressed.rcg"
# The second process is killed after 5 states; the others continue from the last one.
killed_states() {
    local launcher n command="${yield/--increments 1/--increments 10} --periodic --mean-pressure 25MPa,5MPa --history rough.rcg"
    rm -f *.kept
    $run $command --interval 0 --checkpoint killed.kept -o no.rcg >/dev/null 2>killed.err &
    launcher=$!
    until n=$(grep -acs '^checkpoint.numbers=' killed.kept) && [ "$n" -ge 5 ] || ! kill -0 "$launcher"; do sleep 0.05; done
    kill_second "$launcher" || return
    wait "$launcher" && return 1
    for n in 1 3; do
        cp killed.kept "on-$n.kept"
        $MPIRUN -n "$n" $command --checkpoint "on-$n.kept" --resume -o "on-$n.rcg" || [ $? = 3 ] || return
    done
    [ -z "$(ls no.rcg* 2>/dev/null)" ] && cmp on-1.rcg on-3.rcg && cmp on-1.kept on-3.kept
}
claim "a process that is killed among its states: one and three processes continue with equal bytes" killed_states
