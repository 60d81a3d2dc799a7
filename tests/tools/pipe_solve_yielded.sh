# What yields under this load and what is at the hardness are told apart, and the mean gap is that between
# the bodies.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 120 --ny 110 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 40um --short-cut 4um --seed 7 -o s.rcg
press() { rc-solve --quiet --periodic --load 50mN --estar 3GPa --hardness 100MPa --output gap,pressure,plastic --report "$1" "${@:2}"; }
export -f press
press first.json s.rcg -o first.rcg
between 1e-12 "$(field yielded_area first.json)" "$(field plastic_area first.json)" "some of what is at the hardness yields"
# the mean of max(gap, 0), from the gaps themselves
mean=$(rc-export --channel gap --format csv first.rcg | tr ',;\t' '\n\n\n' |
    awk '/^ *-?[0-9]/ { n++; if ($1 > 0) sum += $1 } END { printf "%.17g\n", sum / n }')
near "$(field mean_gap first.json)" "$mean" "$summed" "mean_gap is the mean of max(gap, 0)"

# pressed again: the plastic shape, under the name of a height
rc-export --channel plastic --format npy first.rcg -o shape.npy
rc-import shape.npy --dx 1um --z-unit m -o bare.rcg
claim "the shape says how far off it may be" says 'height\.error=[0-9.e-]+$' rc-info first.rcg
error=$(rc-info first.rcg | sed -n 's/.*height\.error=//p' | tail -n 1)
sed "s/^unit=m\$/unit=m\nheight.error=$error/" bare.rcg | reseal >again.rcg
press second.json again.rcg -o second.rcg
near "$(field max_pressure second.json)" 1e8 "$same" "pressed again it is at the hardness"
between 1e-12 "$(field plastic_area second.json)" 1e-8 "  in places"
near "$(field yielded_area second.json)" 0 0 "  and yields nowhere"
near "$(field contact_area second.json)" "$(field contact_area first.json)" 0.01 "  on the same contact"

finish
