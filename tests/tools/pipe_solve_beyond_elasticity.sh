# A pressure beyond linear elasticity does not pass in silence, and one above E* names the unit that was
# probably forgotten.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 96 --ny 80 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 40um --short-cut 6um --seed 5 -o s.rcg

solve() { # ESTAR LOAD [OPTION...]
    local estar=$1 load=$2
    shift 2
    rc-solve --periodic --estar "$estar" --load "$load" --output pressure "$@" s.rcg -o p.rcg
}
export -f solve
# The peak of a case, and the load at which the warning has to begin, by bisection of nothing but the report.
solve 3GPa 1mN --quiet --report soft.json
between 0 "$(field max_pressure soft.json)" 3e8 "a light load stays below a tenth of E*"
claim "and says nothing of it" bash -c 'solve 3GPa 1mN 2>err; ! grep -q "E\*" err'
solve 3GPa 1 --quiet --report hard.json
between 3e8 "$(field max_pressure hard.json)" 3e9 "a heavy one is above"
claim "which is said, with its share of E*" \
    warns 'case 1, load 1 N: the largest pressure, [0-9.]+ [MG]Pa, is 0\.[0-9]+ of E\*' solve 3GPa 1
claim "E* without its unit: is named" warns 'above E\*, which is 3 Pa: was its unit forgotten' solve 3 1mN
claim "the load without its unit: its mean over the map" \
    warns 'above E\* = 3 GPa; on a map of 96 um by 80 um the mean is 65[0-9.]+ GPa: was the unit of the load' solve 3GPa 500
rc-synth selfaffine --nx 96 --ny 80 --dx 1um --hurst 0.8 --rms-slope 40 --rolloff 40um --short-cut 6um --seed 5 -o s.rcg
claim "heights in a wrong unit: their slope" \
    warns 'above E\* = 3 GPa, and the RMS slope in contact is [0-9.]+: are heights and spacings' solve 3GPa 20mN
claim "--quiet: nothing" bash -c 'solve 3GPa 1 --quiet 2>err && [ ! -s err ]'

finish
