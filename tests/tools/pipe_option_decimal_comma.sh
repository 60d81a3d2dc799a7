# Two whole numbers with a comma between them may be one with a decimal comma: the list is taken as a list, with a
# warning that says what to write instead.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 17 --dx 5um --radius 7.5mm -o ball.rcg
press="rc-solve --estar 114GPa --output pressure -o out.rcg"

claim "two loads, or one and a half" \
    warns 'load 1,5: two values, 1 N and 5 N: for one number write 1\.5$' $press --load 1,5 ball.rcg
claim "  they are two cases" says '^case=2$' cat out.rcg
claim "a zero after the comma is kept" warns 'two values, 1 N and 5 N: for one number write 1\.05$' $press --load 1,05 ball.rcg
claim "other lists too" warns 'depths 2,3: two values, 2 m and 3 m: .* 2\.3$' rc-stress --nu 0.3 --depths 2,3 out.rcg
claim "and plain numbers in metres" warns 'wavelength 2,5: two values' \
    rc-synth wave --nx 8 --dx 1 --wavelength 2,5 --amplitude 1 -o wave.rcg

# silent COMMAND...: it succeeds and speaks of no two values.
silent() {
    "$@" 2>silent.err >/dev/null && ! grep 'two values' silent.err >&2
}
claim "not with --quiet before it" silent $press --quiet --load 1,5 ball.rcg
claim "nor with --quiet after it" silent $press --load 1,5 ball.rcg --quiet
claim "not of three" silent $press --load 1,2,5 ball.rcg
claim "nor with units" silent $press --load 1N,5N ball.rcg
claim "nor with points" silent $press --load 1.0,5 ball.rcg
claim "nor of numbers far apart" silent $press --load 1,10 ball.rcg
claim "nor of a range" silent $press --load 1:5:2 ball.rcg
claim "nor of a list that another one replaced" silent $press --load 1,5 --load 2 ball.rcg
refuses 2 'with and without a unit .*; the decimal mark is a point' "with one unit it is no list" \
    "$press --load 1,5N ball.rcg"

finish
