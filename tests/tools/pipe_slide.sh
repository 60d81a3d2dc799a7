# rc-solve --relaxation --speed: the friction of a wave in full contact is that of the formula. Each speed is a
# case, a resumed run writes the same bytes, and contradictions are refused.
. "$(dirname "$0")/../pipe.sh"

rc-synth wave --nx 64 --ny 16 --dx 10um --wavelength 640um --amplitude 1um -o wave.rcg
rc-synth selfaffine --nx 64 --dx 10um --hurst 0.8 --rms-slope 0.2 --short-cut 80um --seed 3 -o road.rcg
rubber="--periodic --relaxation 1MPa,9MPa:1ms --nu1 0.5 --E2 rigid --quiet"

# E1 = 9 MPa at 0.1 m/s: w tau = 0.98175, loss 9 MPa w tau/(1 + (w tau)^2) over 1 - nu^2; the friction over the mean
# pressure is q^2 h^2 E''/4, with the wave number q
claim "a wave slides in full contact" bash -c "rc-solve $rubber --mean-pressure 1MPa --speed 0.1 --report wave.json -o flat.rcg wave.rcg"
claim "  all nodes touch" says '^1$' field contact_fraction wave.json
near "$(field friction wave.json)" "$(awk 'BEGIN { q = 6.283185307179586 / 640e-6; x = q * 0.1 * 1e-3
    print q * q * 1e-12 * 9 * x / (1 + x * x) / 0.75 / 4 }')" 1e-9 "its friction"
near "$(awk "BEGIN { print $(field friction_force wave.json) * 0.1 }")" "$(field dissipated_power wave.json)" 1e-9 "the power of the friction"

claim "each speed is a case" bash -c "
    rc-solve $rubber --mean-pressure 0.2MPa --speed=-0.1,0.01,1 --checkpoint kept.rcg --report road.tsv -o sliding.rcg road.rcg"
claim "  of four frames with the speed as a key" says '^4$' bash -c "rc-info sliding.rcg | grep -c speed=-0.1"
claim "  the resumed run gives the same bits" bash -c "
    rc-solve $rubber --mean-pressure 0.2MPa --speed=-0.1,0.01,1 --checkpoint kept.rcg --resume -o again.rcg road.rcg && cmp sliding.rcg again.rcg"
refuses 1 'another problem: speed was 1, is 2' "states of another speed" \
    "rc-solve $rubber --mean-pressure 0.2MPa --speed=-0.1,0.01,2 --checkpoint kept.rcg --resume -o x.rcg road.rcg"
claim "  a curve of the friction" bash -c "rc-render --curve speed:friction -o curve.png road.tsv && [ -s curve.png ]"
claim "the plan counts convolutions" says 'sliding .*along y, fresh track' \
    bash -c "rc-solve $rubber --mean-pressure 0.2MPa --speed 1 --along y --dry-run road.rcg"

refuses 2 'give --relaxation' "a speed without a material" "rc-solve --periodic --estar 1MPa --load 1N --speed 1 road.rcg"
refuses 2 'give --periodic' "a repeated track on a free map" \
    "rc-solve --relaxation 1MPa,9MPa:1ms --nu1 0.5 --E2 rigid --load 1N --speed 1 --track repeated road.rcg"
refuses 2 'no effect without --speed' "a track without a speed" "rc-solve $rubber --load 1N --time 1 --track fresh road.rcg"
refuses 1 'tan delta of the material reaches 4.9' "a material with large losses" \
    "rc-solve --periodic --relaxation 1MPa,99MPa:0.01ms --nu1 0.5 --E2 rigid --quiet --load 1mN --speed 0.5 -o x.rcg road.rcg"
refuses 2 'relaxed modulus is 0' "a fluid" \
    "rc-solve --periodic --relaxation 0MPa,9MPa:1ms --nu1 0.5 --E2 rigid --quiet --load 1mN --speed 1 -o x.rcg road.rcg"
