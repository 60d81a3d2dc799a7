# SPDX-License-Identifier: GPL-3.0-or-later
# The force on a profile may be given per unit width. For a plain force the report has the width; a rigid body
# needs no modulus.
. "$(dirname "$0")/../pipe.sh"

# A cylinder on a half-space in plane strain: p0 = sqrt(P E*/(pi R)), a = 2 sqrt(P R/(pi E*)) (Johnson 1985,
# section 4.2c). With P = 5 kN/m, R = 10 mm, E* = 100 GPa: p0 = 126.157 MPa, a = 25.2313 um; a period of 2 mm.
rc-synth sphere --nx 4096 --ny 1 --dx 500nm --radius 10mm -o ridge.rcg
press() { rc-solve --periodic --estar 100GPa --output pressure --report r.json "$@" ridge.rcg -o p.rcg; }
export -f press
claim "5 kN/m on a profile causes no message" bash -c 'press --load 5kN/m 2>err && [ ! -s err ]'
near "$(field max_pressure r.json)" 126.157e6 1e-3 "Hertz's largest pressure of a line contact"
near "$(field load r.json)" 2.5e-3 "$summed" "  5 kN/m on 500 nm: 2.5 mN"
near "$(total pressure p.rcg 1)" 2.5e-3 "$summed" "  which its pressures carry"
claim "  the history has it as given" says 'rc-solve.* --load 5000N/m' rc-info p.rcg
claim "the same force in N causes a note about the width" warns 'the force on this profile acts on a width of 500 nm: give --load in N/m' press --load 2.5mN
near "$(field max_pressure r.json)" 126.157e6 1e-3 "  and does the same"
rc-pick --rotate 90 ridge.rcg -o column.rcg
claim "5 kN/m on a column causes no message" bash -c 'rc-solve --periodic --estar 100GPa --load 5kN/m --output pressure --report c.json column.rcg -o c.rcg 2>err && [ ! -s err ]'
near "$(field max_pressure c.json)" 126.157e6 1e-3 "  and the same pressure"
near "$(field load c.json)" 2.5e-3 "$summed" "  its load too"
refuses 1 "in N/m is for profiles and for maps that repeat along one axis, and this map has 33 rows: give the whole force, in N" "a map carries a force" \
    "rc-synth sphere --nx 33 --dx 1um --radius 1mm | rc-solve --load 1N/m --estar 1GPa | cat >/dev/null"

# A wave in contact over 2 a: sin^2(pi a/l) = p/p*, p* = pi E* A/l, largest 2 p/sin(pi a/l) (Westergaard). The
# map has 400 nodes, p = 10 MPa, E* = 100 GPa, A = 0.1 um, l = 400 um. Then p* = 78.53982 MPa, 2 a = 92.911
# um, and the largest pressure is 56.04991 MPa.
rc-synth wave --nx 400 --ny 1 --dx 1um --amplitude 100nm --wavelength 400um -o wave.rcg
claim "93 nodes in contact resolve a profile, without a message" bash -c '
    rc-solve --periodic --estar 100GPa --mean-pressure 10MPa --discretization --output pressure --report w.json wave.rcg -o w.rcg 2>err && [ ! -s err ]'
claim "  the default tolerance is at most 1e-3, although 400^(-3/4) is 1.1e-2" grep -q '"tol": 0.001' w.json
of_area=$(field contact_area_error_estimate w.json) of_peak=$(field max_pressure_error_estimate w.json)
near "$(field contact_area w.json)" 92.911e-12 "$(awk -v e="$of_area" 'BEGIN { print 2 * e }')" "  its area off by less than twice the estimate for the grid"
near "$(field max_pressure w.json)" 56.04991e6 "$of_peak" "  its largest pressure by less than that"
between 1e-4 "$of_peak" 1e-3 "  which is of use"
claim "10 nodes in contact cause a warning" warns 'the grid does not resolve it: .*--discretization' \
    rc-solve --periodic --estar 100GPa --mean-pressure 100kPa --output pressure wave.rcg -o w.rcg

rc-synth sphere --nx 33 --dx 10um --radius 10mm -o ball.rcg
rc-solve --load 1N --E1 210GPa --nu1 0.3 --E2 rigid --output pressure --report rigid.json ball.rcg -o rigid.rcg
# E* = 210 GPa/(1 - 0.09)
rc-solve --load 1N --estar 230.769230769230769GPa --output pressure --report estar.json ball.rcg -o estar.rcg
near "$(field max_pressure rigid.json)" "$(field max_pressure estar.json)" "$summed" "--E2 rigid leaves E1/(1 - nu1^2)"
claim "  the history has the word rigid" says 'E2 rigid' rc-info rigid.rcg
refuses 2 'all four \(--E2 rigid needs no --nu2\)' "two moduli need two ratios" \
    "rc-solve --load 1N --E1 210GPa --nu1 0.3 --E2 1GPa ball.rcg"
