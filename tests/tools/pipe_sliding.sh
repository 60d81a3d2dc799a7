# SPDX-License-Identifier: GPL-3.0-or-later
# rc-solve --relaxation --speed: the friction of a wave in full contact is that of the formula. Each speed is a
# case, a resumed run writes the same bytes, and contradictions are refused.
. "$(dirname "$0")/../pipe.sh"

rc-synth wave --nx 64 --ny 16 --dx 10um --wavelength 640um --amplitude 1um -o wave.rcg
rc-synth selfaffine --nx 64 --dx 10um --hurst 0.8 --rms-slope 0.2 --short-cut 80um --seed 3 -o road.rcg
rubber="--periodic --relaxation 1MPa,9MPa:1ms --nu1 0.5 --E2 rigid --quiet"

# E1 = 9 MPa at 0.1 m/s: w tau = 0.98175, loss 9 MPa w tau/(1 + (w tau)^2) over 1 - nu^2; the friction over the mean
# pressure is q^2 h^2 E''/4, with the wave number q
friction=$(awk 'BEGIN { q = 6.283185307179586 / 640e-6; x = q * 0.1 * 1e-3
    printf "%.17g", q * q * 1e-12 * 9 * x / (1 + x * x) / 0.75 / 4 }')
flat="rc-solve $rubber --mean-pressure 1MPa --speed 0.1"
claim "a wave slides in full contact" bash -c "$flat --tol 1e-12 --report wave.json -o flat.rcg wave.rcg"
claim "  all nodes touch" says '^1$' field contact_fraction wave.json
near "$(field friction wave.json)" "$friction" 1e-9 "its friction"
near "$(awk "BEGIN { printf \"%.17g\", $(field friction_force wave.json) * 0.1 }")" "$(field dissipated_power wave.json)" 1e-9 \
    "the power of the friction is that of the losses of its waves"
for tol in 1e-2 1e-3 1e-6; do
    $flat --tol $tol --report loose.json -o flat.rcg wave.rcg
    between 0 "$(awk "BEGIN { d = $(field friction loose.json) / $friction - 1; printf \"%.17g\", d < 0 ? -d : d }")" \
        "$(field friction_error_estimate loose.json)" "  with --tol $tol its relative error is below the estimate"
done

near "$(field friction_by_heights wave.json)" "$friction" 1e-9 "  the slopes of the wave give the same friction"

claim "each speed is a case" bash -c "
    rc-solve $rubber --mean-pressure 0.2MPa --speed=-0.1,0.01,1 --checkpoint kept.rcg --report road.tsv -o sliding.rcg road.rcg"
for speed in -0.1 0.01 1; do
    claim "  of four frames with the speed $speed as a key" says '^4$' bash -c "rc-info sliding.rcg | grep -cx ' .*speed=$speed'"
done
for case in 1 2 3; do near "$(total pressure sliding.rcg $case)" 0.08192 "$summed" "  whose pressures carry the load"; done
claim "  the resumed run gives the same bits" bash -c "
    rc-solve $rubber --mean-pressure 0.2MPa --speed=-0.1,0.01,1 --checkpoint kept.rcg --resume --report again.tsv -o again.rcg road.rcg &&
    cmp sliding.rcg again.rcg"
# figures FILE: a report without the columns of its cost
figures() {
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; i++) cost[i] = $i ~ /memory|seconds|convolutions/ }
        { for (i = 1; i <= NF; i++) if (!cost[i]) print $i }' "$1"
}
figures road.tsv >once.txt
figures again.tsv >twice.txt
claim "  and the same figures" cmp once.txt twice.txt
rc-synth sphere --nx 40 --ny 24 --dx 2um --radius 200um -o ball.rcg
once="rc-solve ${rubber#--periodic} --load 0.1mN --speed=-0.1,0.01 --checkpoint free.rcg"
claim "  so on a map that does not repeat" bash -c "
    $once -o once.rcg ball.rcg && $once --resume -o again.rcg ball.rcg && cmp once.rcg again.rcg"
# A signal comes when the checkpoint has a state of the case.
claim "  and an interrupted run goes on to the tolerance" bash -c "
    rc-synth selfaffine --nx 256 --dx 10um --hurst 0.8 --rms-slope 0.2 --short-cut 80um --seed 3 -o wide.rcg
    slow='rc-solve $rubber --mean-pressure 0.2MPa --tol 1e-9 --speed 0.01 --output pressure'
    \$slow --checkpoint half.rcg --interval 0.001 -o half.out wide.rcg & run=\$!
    until [ -s half.rcg ] || ! kill -0 \$run; do sleep 0.01; done
    kill \$run; wait \$run; [ \$? = 143 ] && rc-info --quiet half.out >info.txt; [ \$? = 3 ] &&
    \$slow --checkpoint half.rcg --resume --report half.json -o half.out wide.rcg && \$slow --report whole.json -o whole.out wide.rcg"
near "$(field friction half.json)" "$(field friction whole.json)" 1e-7 "    with the same friction"
refuses 1 'another problem: speed was 1, is 2' "states of another speed" \
    "rc-solve $rubber --mean-pressure 0.2MPa --speed=-0.1,0.01,2 --checkpoint kept.rcg --resume -o x.rcg road.rcg"
claim "  a curve of the friction" bash -c "rc-render --curve speed:friction -o curve.png road.tsv && [ -s curve.png ]"
claim "the plan counts convolutions" says 'sliding .*along y, fresh track' \
    bash -c "rc-solve $rubber --mean-pressure 0.2MPa --speed 1 --along y --dry-run road.rcg"

# Waves of L m excite at v/L Hz: of 8 nodes at 12500 Hz, as long as the map at 1562.5 Hz, along y at 4 times as much.
curve() { # curve LOW HIGH: a master curve between two frequencies
    awk -v low="$1" -v high="$2" 'BEGIN { print "frequency/Hz storage/MPa loss/MPa"
        for (i = 0; i <= 20; i++) { f = low * (high / low) ^ (i / 20); x = 6.283185307 * f * 1e-4
            printf "%.9g %.9g %.9g\n", f, 1 + 2 * x * x / (1 + x * x), 2 * x / (1 + x * x) } }'
}
curve 1500 13000 >covers.txt
curve 1500 12000 >short.txt
curve 1600 13000 >late.txt
curve 1500 10e6 >wide.txt
awk 'BEGIN { print "time/s E/MPa"; for (i = 0; i <= 20; i++) { t = 20e-6 * 50 ^ (i / 20); print t, 1 + 2 * exp(-t / 1e-4) } }' >times.txt
rc-synth wave --nx 64 --ny 64 --dx 10um --dy 2.5um --wavelength 640um --amplitude 0.1um -o long.rcg
range="rc-solve --threads 1 --tol 1e-2 --periodic --nu1 0.5 --E2 rigid --mean-pressure 1MPa --output pressure -o ranged.rcg"
above='waves of 8 nodes .80 um. excite the material at 12500 Hz, above the last frequency of the table,'
below='waves as long as the map .640 um. excite the material at 1562.5 Hz, below the first frequency of the table,'
none() { # none ARG...: a run of these options without a warning of the range
    claim "waves inside the range of the table: $*" bash -c '"$@" 2>ranged.err && ! grep -E "excite" ranged.err' - $range "$@" long.rcg
}
none --speed 1 --relaxation covers.txt
none --speed 1 --relaxation wide.txt
none --speed=-1 --relaxation wide.txt
none --speed 2 --shift 0.5 --relaxation covers.txt
none --speed 0 --relaxation late.txt
none --speed 100 --relaxation 1MPa,2MPa:0.1ms
claim "waves above it have a warning with both frequencies" warns "at 1 m/s $above 12000 Hz" $range --speed 1 --relaxation short.txt long.rcg
claim "  with the table after its shift" warns "at 1 m/s $above 6500 Hz" $range --speed 1 --shift 2 --relaxation covers.txt long.rcg
claim "  each of a list of shifts" warns "case 2, .*: at 1 m/s $above 6500 Hz" $range --speed 1 --shift 1,2 --relaxation covers.txt long.rcg
claim "  of times" warns 'excite the material at 12500 Hz, above 7957.75 Hz, 1/.2 pi t. of the first time of the table, 2e-05 s' \
    $range --speed 1 --relaxation times.txt long.rcg
claim "  along y" warns 'waves of 8 nodes .20 um. excite the material at 50000 Hz' $range --along y --speed 1 --relaxation covers.txt long.rcg
claim "waves below it" warns "at 1 m/s $below 1600 Hz" $range --speed 1 --relaxation late.txt long.rcg

refuses 2 '--speed has no effect without --relaxation' "a speed without a material" "rc-solve --periodic --estar 1MPa --load 1N --speed 1 road.rcg"
refuses 2 '--track repeated has no effect without --periodic' "a repeated track on a free map" \
    "rc-solve --relaxation 1MPa,9MPa:1ms --nu1 0.5 --E2 rigid --load 1N --speed 1 --track repeated road.rcg"
refuses 2 'no effect without --speed' "a track without a speed" "rc-solve $rubber --load 1N --time 1 --track fresh road.rcg"
refuses 1 'tan delta of the material reaches 4.9' "a material with large losses" \
    "rc-solve --periodic --relaxation 1MPa,99MPa:0.01ms --nu1 0.5 --E2 rigid --quiet --load 1mN --speed 0.5 -o x.rcg road.rcg"
refuses 2 'relaxed modulus is 0' "a fluid" \
    "rc-solve --periodic --relaxation 0MPa,9MPa:1ms --nu1 0.5 --E2 rigid --quiet --load 1mN --speed 1 -o x.rcg road.rcg"
