# SPDX-License-Identifier: GPL-3.0-or-later
# rc-solve on maps that repeat along one axis: the datum changes approach, stiffness and conductance by what
# theory says and no pressure. Loads per metre, approaches, hardness, histories, forecasts and refusals are tested.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 64 --ny 48 --dx 2um --hurst 0.8 --rms-height 40nm --rolloff 60um --short-cut 10um --seed 5 -o y.rcg
rc-pick --rotate 90 y.rcg -o x.rcg
press="rc-solve --quiet --estar 114GPa --tol 1e-6"
same_pressure() { # FILE FILE
    cmp <(rc-export --format csv --channel pressure "$1" | grep -v '^#') <(rc-export --format csv --channel pressure "$2" | grep -v '^#')
}
export -f same_pressure
values() { rc-export --format csv --channel "$2" "$1" | grep -v '^#' | tr ',' '\n'; }

# ---- the datum ----

pi=3.14159265358979
for axis in x y; do
    $press --periodic=$axis --load 2e4N/m --stiffness --conductivity 45W/mK,16W/mK --report near.json -o near.rcg $axis.rcg
    $press --periodic=$axis --datum 3m --load 2e4N/m --stiffness --conductivity 45W/mK,16W/mK --report far.json -o far.rcg $axis.rcg
    near "$(field datum near.json)" 128e-6 "$rounding" "along $axis the datum is the length of the other axis"
    near "$(field load_per_metre near.json)" 2e4 "$summed" "  a load per metre is one"
    near "$(field load near.json)" "$(awk 'BEGIN { print 2e4 * 48 * 2e-6 }')" "$summed" "  whose load is that of the period"
    claim "  another datum gives the same pressure" same_pressure near.rcg far.rcg
    rise=$(awk "BEGIN { printf \"%.12g\", 2 / ($pi * 114e9) * log(3 / 128e-6) }")
    near "$(field approach far.json)" "$(awk -v a="$(field approach near.json)" "BEGIN { printf \"%.12g\", a + 2e4 * $rise }")" 1e-9 \
        "  an approach larger by 2 P'/(pi E*) ln of their ratio"
    near "$(field stiffness far.json)" \
        "$(awk -v s="$(field stiffness near.json)" "BEGIN { printf \"%.12g\", 1 / (1 / s + $rise / (48 * 2e-6)) }")" 1e-9 \
        "  and the compliance that belongs to it"
    near "$(field conductance far.json)" \
        "$(awk -v s="$(field stiffness far.json)" "BEGIN { printf \"%.12g\", 2 * s / (114e9 * (1 / 45 + 1 / 16)) }")" 1e-6 "  as the conductance has"
    claim "  the frames have it" says '^datum=3$' cat far.rcg
    $press --periodic=$axis --datum 3m --load 2e4N/m --output displacement,height,pressure -o moved.rcg $axis.rcg
    top=$(rc-pick --channel height moved.rcg | rc-export --format csv | grep -v '^#' | tr ',' '\n' | sort -g | tail -n 1)
    near "$(paste <(values moved.rcg displacement) <(values moved.rcg height) <(values moved.rcg pressure) | awk -v t="$top" '$3 > 0 { s += $1 - $2 + t; n++ } END { printf "%.12g", s / n }')" \
        "$(field approach far.json)" 1e-5 "  the displacement in the contact is the approach less the depth below the highest node"
    $press --periodic=$axis --datum 3m --approach "$(field approach far.json)" --report back.json -o back.rcg $axis.rcg
    near "$(field load_per_metre back.json)" 2e4 1e-5 "  the load of this approach is the load"
    mv near.json $axis.json
done
near "$(field max_pressure x.json)" "$(field max_pressure y.json)" "$six_digits" "a turned map has the same largest pressure"
near "$(field approach x.json)" "$(field approach y.json)" "$six_digits" "  and approach"
$press --periodic=y --datum 1um --load 2e4N/m --stiffness --conductivity 45W/mK,16W/mK --report inside.json -o inside.rcg y.rcg
claim "with a datum inside the contact stiffness and conductance are null" says '"stiffness": null.*"conductance": null' cat inside.json

# ---- hardness, histories, the grid ----

$press --periodic=y --load 1e5N/m,2e5N/m,5e4N/m --history --hardness 2GPa --report h.tsv -o h.rcg y.rcg
cell() { awk -F '\t' -v row="$1" -v name="$2" 'NR == 1 { for (i = 1; i <= NF; i++) { sub(/\/.*/, "", $i); if ($i == name) c = i } } NR == row + 1 { print $c }' h.tsv; }
near "$(cell 2 max_pressure)" 2e9 "$rounding" "with a hardness the largest pressure is the hardness"
between 1e-12 "$(cell 2 yielded_area)" 1 "  the second load yields"
near "$(cell 3 yielded_area)" 0 "$same" "  the third, smaller one does not"
near "$(cell 3 load_per_metre)" 5e4 "$summed" "  and carries its load"
rc-pick --channel height y.rcg | rc-solve --quiet --estar 114GPa --periodic=y --load 1e5N/m --hardness 2GPa --discretization --report d.json -o d.rcg
between 1e-3 "$(field contact_area_error_estimate d.json)" 1 "--discretization estimates the error of the grid"
claim "  but not that of the approach of a contact at a free edge" grep -q '"approach_error_estimate": null' d.json
rc-synth wave --amplitude 20nm --nx 64 --ny 48 --dx 2um --wavelength 128um -o w.rcg
rc-solve --quiet --estar 114GPa --periodic=y --load 1e3N/m --radius 10mm --discretization --report d.json -o d.rcg w.rcg
between 1e-4 "$(field approach_error_estimate d.json)" 0.1 "  which it tells of a contact inside"
# ---- refusals ----

refuses 2 '--tilt free does not work with --periodic' "no tilt" 'rc-solve --periodic=y --tilt free --load 1N --estar 1GPa y.rcg >/dev/null'
refuses 2 '--datum has no effect without --periodic x or --periodic y' "no datum without an axis that repeats" \
    'rc-solve --datum 1m --load 1N --estar 1GPa y.rcg >/dev/null'
refuses 2 '--datum has no effect without --periodic x or --periodic y' "  or with two" \
    'rc-solve --periodic --datum 1m --load 1N --estar 1GPa y.rcg >/dev/null'
refuses 2 '--datum 0 m: it must be above 0' "a datum of 0" 'rc-solve --periodic=y --datum 0 --load 1N --estar 1GPa y.rcg >/dev/null'
refuses 1 'datum 3e-05 m: an approach that grows with the load needs one of at least 3.2e-05 m' "a near datum for an approach" \
    'rc-solve --periodic=y --datum 30um --approach 1nm --estar 1GPa y.rcg >/dev/null'
refuses 1 'datum 0.000128 m: an approach that grows with the load needs one of at least 0.0[0-9]* m' "  the default one above a stiff coat thicker than the map" \
    'rc-solve --periodic=y --approach 1nm --layer 1mm,1000GPa,0.3 --E1 1GPa --nu1 0.3 --E2 rigid y.rcg >/dev/null'
refuses 1 "the sums of the engine 'mlms' have no end" "sums without end" 'rc-solve --periodic=y --kernel mlms --load 1N --estar 1GPa y.rcg >/dev/null'
