# SPDX-License-Identifier: GPL-3.0-or-later
# The message for a misspelt option names the intended option. The message for an ambiguous abbreviation names
# all matching options. British and American spelling are both accepted, and a value out of bounds never
# counts as a missing one.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 200 --dx 1um --radius 1mm -o ball.rcg

# ---- mistakes ----

# meant TYPED NAME: the message for the typed option suggests NAME.
meant() {
    refuses 2 "^rc-solve: unknown option ${1%%=*}: did you mean $2\\?$" "$1 is $2" "rc-solve $1 3"
}
meant --lod --load
meant --laod --load
meant --loads --load
meant --LOAD --load
meant --lod=3 --load
meant -load --load
meant -E1 --E1
meant --e1 --E1
meant --mean_pressure --mean-pressure
meant --meanpressure --mean-pressure
meant --pressure --mean-pressure
meant --peridoic --periodic
meant --quite --quiet
meant --treads --threads
refuses 2 '^rc-solve: unknown option --xyzzy: see rc-solve --help$' "one that is near to none" 'rc-solve --xyzzy'
refuses 2 '^rc-solve: unknown option -x: see rc-solve --help$' "a letter" 'rc-solve -x'
refuses 2 '^rc-solve: unknown option --a{63}' "a long one" "rc-solve --\$(printf 'a%.0s' {1..5000})"
refuses 2 '^rc-solve: option --re is ambiguous: --relaxation, --report, --resume$' "one that is cut too short" 'rc-solve --re'
refuses 2 '^rc-solve: option --E is ambiguous: --E1, --E2$' "another" 'rc-solve --E=3'
refuses 2 '^rc-solve: option --load needs an argument' "one without its argument" 'rc-solve --load'
refuses 2 '^rc-solve: option --history=3 takes no argument' "one with too many" 'rc-solve --history=3'
# forgets OPTION WORD: the option has lost its value, and the next word is an option
forgets() {
    refuses 2 "^rc-render: $1 needs a value; write $1${3-=}$2 for this one\$" "$1 before $2 has no value" "rc-render $1 $2 x.png ball.rcg"
}
forgets --title -o
forgets --title --channel
forgets --title --channel=height
forgets --title --verbose
forgets --channel -h
forgets --memory --colourmap
forgets -o --title ''
claim "  by = every text is a value" rc-render --title=-o -o text.png ball.rcg
claim "  and a word that is no option" rc-render --title --nothing -o text.png ball.rcg
refuses 2 '^rc-solve: --load -3 N: it must be at least 0' "  a negative number is a value" 'rc-solve --load -3 ball.rcg'
claim "a unique abbreviation of an option is accepted" rc-solve --loa 1 --est 1GPa --out pressure --quiet -o cut.rcg ball.rcg

# ---- spelling ----

press="rc-solve --load 1 --estar 114GPa --output pressure --quiet ball.rcg"
$press --discretization --report american.json -o american.rcg
claim "--discretisation is accepted" $press --discretisation --report british.json -o british.rcg
claim "  it gives the same result" test "$(field max_pressure_error_estimate british.json)" = "$(field max_pressure_error_estimate american.json)"
claim "  the option has an effect" bash -c '! grep -q "max_pressure_error_estimate\": null" british.json'
claim "  both spellings can be abbreviated before they differ" $press --disc -o british.rcg
rc-render --colormap grey -o american.png ball.rcg
claim "--colourmap is accepted" rc-render --colourmap grey -o british.png ball.rcg
claim "  it gives the same picture" cmp american.png british.png
claim "gray is grey, also in the history" rc-render --colormap gray -o gray.png ball.rcg
claim "  the pictures are equal to the byte" cmp american.png gray.png
claim "--help has one spelling" bash -c '! { rc-solve --help; rc-render --help; } | grep -E "discretisation|colourmap|gray" >&2'
refuses 2 'colormap green: it must be one of' "another colour is none" 'rc-render --colormap green -o x.png ball.rcg'

# ---- invalid values ----

for option in load mean-pressure approach; do
    for value in -1 0 -1e-300 -3:-1:3 1,-1; do
        refuses 2 "^rc-solve: --$option -?[0-9e-]+ (N|Pa|m): it must be at least 0|^rc-solve: --$option 0: it must be above 0" "--$option $value" \
            "rc-solve --estar 1GPa --$option $value ball.rcg -o never.rcg"
    done
    for value in nan NaN -nan inf -inf '1,nan' "''" "' '"; do
        refuses 2 "^rc-solve: --$option .*is not a number" "--$option $value" \
            "rc-solve --estar 1GPa --$option $value ball.rcg -o never.rcg"
    done
done
refuses 2 'give one of' "one that is wrong is given all the same" 'rc-solve --estar 1GPa --load 1 --approach 1 ball.rcg'
for value in 0 -1 0.5; do
    refuses 2 "memory $value bytes: it must be at least 1" "--memory $value" "$press -o never.rcg --memory $value"
done
refuses 2 "memory nan: 'nan' is not a number" "--memory nan" "$press -o never.rcg --memory nan"
refuses 1 'memory allows 600 KiB: ' "a limit under a mebibyte" "$press -o never.rcg --memory 600k"
refuses 1 'memory allows 2 MiB: ' "a limit above it" "$press -o never.rcg --memory 2M"
rc-synth sphere --nx 5 --dx 1um --radius 1mm -o small.rcg
refuses 1 'memory allows 900 bytes: ' "a limit under a kibibyte" "rc-solve --load 1 --estar 1GPa -o never.rcg --memory 900 small.rcg"
claim "refused commands write no file" test ! -e never.rcg
