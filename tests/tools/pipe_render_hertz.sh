# SPDX-License-Identifier: GPL-3.0-or-later
# Hertz's contact drawn on a map and on a cut, for a ball of rc-synth and for one added by rc-solve. Persson's
# law is drawn with the table of rc-solve. The curves follow the formulas.
. "$(dirname "$0")/../pipe.sh"

# The value at x of a curve in an SVG: its points, with linear interpolation between them.
value_at() {
    perl "$RC_SOURCE/tests/tools/points.pl" <"$1" | awk -v kind="$2" -v at="$3" '
        $2 == kind && NF > 6 { for (k = 3; k + 3 <= NF; k += 2) if ($k <= at && $(k + 2) >= at && $(k + 2) > $k) {
            printf "%.9g\n", $(k + 1) + (at - $k) / ($(k + 2) - $k) * ($(k + 3) - $(k + 1)); exit } }'
}
# p0 sqrt(1 - r^2/a^2) in GPa of 60 N on 7.5 mm, E* 114 GPa, at that distance in um
hertz() {
    perl -e '$a = (0.75 * 60 * 7.5e-3 / 114e9) ** (1 / 3); $r = 1e-6 * shift;
        printf "%.9g\n", $r < $a ? 1e-9 * 1.5 * 60 / (3.14159265358979 * $a ** 2) * sqrt(1 - $r ** 2 / $a ** 2) : 0' "$1"
}

rc-synth sphere --nx 129 --dx 10um --radius 7.5mm -o ball.rcg
rc-solve --quiet --load 60N --estar 114GPa --output pressure,gap -o p.rcg ball.rcg
draw='rc-render --quiet -o out.svg'

# ---- maps and cuts ----

claim "--hertz draws the circle of a ball of rc-synth" eval 'rc-render --hertz --radius 7.5mm --channel pressure -o c.svg p.rcg && says "Hertz, radius 143.6 µm" cat c.svg'
claim "  with the radius of its key form too" eval 'rc-render --hertz --channel pressure -o c.svg p.rcg 2>said && says "Hertz, radius 143.6 µm" cat c.svg && test ! -s said'
claim "  a map cut beside the middle causes a warning" warns 'the circle of Hertz is about the middle of the map, but the centre of the pressure is 200 µm away from it' eval 'rc-pick --quiet --crop 40,0,89,129 ball.rcg | rc-solve --quiet --load 60N --estar 114GPa --output pressure | rc-render --hertz -o c.svg'
claim "with the modulus of the stream, or another one" eval 'rc-render --hertz --radius 7.5mm --estar 14.25GPa --channel pressure -o c.svg p.rcg && says "Hertz, radius 287.2 µm" cat c.svg'
claim "a cut has Hertz's pressure too" rc-render --cut y=0 --hertz --radius 7.5mm --channel pressure --y-unit GPa --x-unit um -o cut.svg p.rcg
near "$(value_at cut.svg dashed 0)" "$(hertz 0)" 1e-3 "  in the middle"
near "$(value_at cut.svg dashed 100)" "$(hertz 100)" 1e-3 "  at 100 um"
claim "  it is 0 outside the contact" awk "BEGIN { exit !($(value_at cut.svg dashed 200) ^ 2 < 1e-6) }"
near "$(value_at cut.svg solid 100)" "$(hertz 100)" "$coarse_grid" "  which the map follows"
claim "a cut beside the centre has the right pressure" rc-render --cut x=80um --hertz --radius 7.5mm --channel pressure --y-unit GPa --x-unit um -o side.svg p.rcg
near "$(value_at side.svg dashed 60)" "$(hertz 100)" 1e-3 "  has it at its own distance"
rc-solve --quiet --radius 7.5mm --load 60N --estar 114GPa --output pressure -o added.rcg <(rc-synth wave --nx 129 --dx 10um --amplitude 0.01nm --wavelength 100um)
claim "a sphere added by rc-solve needs no radius" eval 'rc-render --cut y=0 --hertz --y-unit GPa --x-unit um -o added.svg added.rcg'
near "$(value_at added.svg dashed 100)" "$(hertz 100)" 1e-3 "  and has the same"

# ---- a cylinder: a strip of half width a = sqrt(4 W R / (pi E*)), p0 = 2 W / (pi a) ----

# 400 N/mm on 8 mm, E* 115.38 GPa: p0 sqrt(1 - x^2/a^2) in GPa at that distance in um; without one a in um
strip() {
    perl -e '$a = sqrt(4 * 400e3 * 8e-3 / (3.14159265358979 * 115.38e9)); exit !printf "%.4g", 1e6 * $a if @ARGV == 0; $x = 1e-6 * shift;
        printf "%.9g\n", $x < $a ? 1e-9 * 2 * 400e3 / (3.14159265358979 * $a) * sqrt(1 - $x ** 2 / $a ** 2) : 0' "$@"
}
# roller AXIS NX NY FILE: a roller whose axis is AXIS; its load is per metre, its map 130 um or one node along the axis.
roller() {
    rc-synth wave --nx "$2" --ny "$3" --dx 10um --amplitude 0.01nm --wavelength 100um |
        rc-solve --quiet --cylinder 8mm --periodic="$1" --load 400N/mm --estar 115.38GPa --output pressure -o "$4"
}
roller y 129 13 along_y.rcg
roller x 13 129 along_x.rcg
roller y 129 1 row.rcg
draws_lines() { # FILE: two dashed lines of Hertz, which are parallel
    grep -o '<path d="M[0-9.]* [0-9.]*L[0-9.]* [0-9.]*M[0-9.]* [0-9.]*L[0-9.]* [0-9.]*" [^>]*stroke-dasharray' "$1" | head -n 1 | tr -c '0-9.' ' '
}
claim "the contact of a cylinder is a strip" eval 'rc-render --hertz --window all --channel pressure -o c.svg along_y.rcg 2>said && says "Hertz, half width $(strip) µm" cat c.svg && test ! -s said'
width=$(grep -o '<clipPath id="[a-z0-9]*"><rect x="[0-9.]*" y="[0-9.]*" width="[0-9.]*"' c.svg | head -n 1 | sed 's/.*width="//; s/"//')
near "$(draws_lines c.svg | awk -v w="$width" '{ printf "%.9g", ($5 - $1) / w * 1290 / 2 }')" "$(strip)" 2e-3 "  its lines are that far from the middle"
claim "  upright ones" eval 'draws_lines c.svg | awk "{ exit !(\$1 == \$3 && \$5 == \$7) }"'
claim "  a window does not change it" eval 'rc-render --hertz --window -300um:300um,-30um:30um --channel pressure -o w.svg along_y.rcg 2>said && says "Hertz, half width $(strip) µm" cat w.svg && test ! -s said'
claim "  level ones if the axis is x" eval 'rc-render --hertz --window all --channel pressure -o c.svg along_x.rcg && says "Hertz, half width $(strip) µm" cat c.svg && draws_lines c.svg | awk "{ exit !(\$2 == \$4 && \$6 == \$8) }"'
for cut in "y=0 along_y" "x=0 along_x" "y=0 row"; do
    claim "a cut across has the half-ellipse, $cut" rc-render --cut ${cut% *} --hertz --channel pressure --y-unit GPa --x-unit um -o cut.svg ${cut#* }.rcg
    near "$(value_at cut.svg dashed 0)" "$(strip 0)" 1e-3 "  in the middle"
    near "$(value_at cut.svg dashed 120)" "$(strip 120)" 2e-3 "  at 120 um"
    near "$(value_at cut.svg solid 120)" "$(strip 120)" "$coarse_grid" "  which the map follows"
done
claim "  a cut along the axis has the largest pressure everywhere" rc-render --cut x=0 --hertz --channel pressure --y-unit GPa --x-unit um -o cut.svg along_y.rcg
near "$(value_at cut.svg dashed 50)" "$(strip 0)" 1e-3 "    also at its end"
claim "  a profile is drawn without it, with a warning" warns 'a profile is drawn as a curve, so that --hertz has no effect: add --cut' rc-render --hertz -o c.svg row.rcg

# ---- Persson by the table ----

rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 32um --short-cut 8um --seed 2 -o rough.rcg
rc-solve --quiet --periodic --mean-pressure 100MPa,2GPa --estar 100GPa --output pressure --report r.tsv -o q.rcg rough.rcg
rc-solve --quiet --periodic --radius 10mm --mean-pressure 100MPa --estar 100GPa --output pressure --report with.tsv -o q.rcg rough.rcg
last() { awk -F '\t' 'NR == 1 { for (c = 1; c <= NF; c++) if ($c == "rms_slope") at = c } NR == 2 { print $at }' "$1"; }
near "$(last r.tsv)" "$(rc-info --json rough.rcg | sed 's/.*"rms_slope": \([^,]*\),.*/\1/')" "$summed" "rms_slope in the report is that of rc-info"
near "$(last with.tsv)" "$(last r.tsv)" "$same" "  of the heights before a ball is added"
claim "--law persson takes E* and the slope from the table" rc-render --curve mean_pressure:contact_fraction --law persson --x-unit GPa -o law.svg r.tsv
near "$(value_at law.svg dashed 1)" "$(perl -e '$x = sqrt(2) * 1e9 / (100e9 * shift); $n = 20000;
    for $k (0 .. $n - 1) { $t = $x * ($k + 0.5) / $n; $s += exp(-$t * $t) } printf "%.9g", $s * $x / $n * 2 / sqrt(3.14159265358979)' "$(last r.tsv)")" 1e-3 "  and is erf(sqrt(2) p / (E* h'))"

# ---- refusals ----

refuses 1 '--hertz needs the keys load, estar and form=sphere RADIUS: give what is missing with --estar and --radius' "a ball of unknown radius" "$draw --hertz <(rc-synth sphere --place 1um,0 --nx 129 --dx 10um --radius 7.5mm | rc-solve --quiet --load 60N --estar 114GPa --output pressure)"
refuses 1 'an elliptic contact has no such circle, so there --radius does not help' "an ellipse" "$draw --hertz <(rc-synth paraboloid --nx 129 --dx 10um --radius 5mm,10mm | rc-solve --quiet --load 60N --estar 114GPa --output pressure)"
refuses 1 '--radius is that of a sphere, but this is the contact of a cylinder \(form=cylinder 0.008\): leave out --radius' "the radius of a sphere for a cylinder" "$draw --hertz --radius 8mm along_y.rcg"
refuses 1 '--radius is that of a sphere, but this is the contact of a cylinder \(form=cylinder 0.008\)' "the same on a cut" "$draw --cut y=0 --hertz --radius 8mm along_y.rcg"
refuses 1 '--radius is that of a sphere, but this is the contact of a cylinder \(boundary=periodic-y\)' "the same of a cylinder in the heights" "$draw --hertz --radius 8mm <(rc-synth cylinder --nx 65 --ny 9 --dx 20um --radius 8mm | rc-solve --quiet --periodic=y --load 400N/mm --estar 115.38GPa --output pressure)"
refuses 1 'whose axis repeats alone, but its boundary is free: solve with --periodic=y' "a cylinder that ends" "$draw --hertz <(rc-synth wave --nx 65 --ny 65 --dx 20um --amplitude 0.01nm --wavelength 100um | rc-solve --quiet --cylinder 8mm --load 100N --estar 115.38GPa --output pressure)"
# a viscoelastic body has estar = that of fast loads in its stream; (3 F R / (4 E*))^(1/3) of the relaxed modulus
rc-solve --quiet --load 0.2mN --relaxation 1MPa,9MPa:1ms --nu1 0.5 --E2 rigid --time 10 --report soft.tsv -o soft.rcg ball.rcg
refuses 1 'body 1 is viscoelastic .time=10.*: give the modulus of this time with --estar' "the circle of a viscoelastic body" "$draw --hertz --channel pressure soft.rcg"
claim "  with it" eval 'rc-render --hertz --estar 1.3333333MPa --channel pressure -o soft.svg soft.rcg && says "Hertz, radius 94.49 µm" cat soft.svg'
refuses 1 'give the modulus of this time with --estar' "the histogram of one" "$draw --histogram --channel pressure --law persson --rms-slope 0.1 soft.rcg"
refuses 2 'law persson: the rows have times, .*: give the modulus of these times with --estar' "the law of one" "$draw --curve load:contact_fraction --law persson --rms-slope 0.1 soft.tsv"
refuses 2 '--hertz with --cut needs a single pressure' "a gap" "$draw --cut y=0 --hertz --radius 7.5mm --channel gap p.rcg"
refuses 2 '--hertz does not work with --histogram' "a histogram" "$draw --histogram --hertz --radius 7.5mm p.rcg"
refuses 2 '--radius has no effect without --curve, --histogram or --hertz' "a radius of nothing" "$draw --radius 7.5mm p.rcg"
