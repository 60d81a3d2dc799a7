# SPDX-License-Identifier: GPL-3.0-or-later
# --cylinder adds a cylinder to the heights: a roller on a flat map is Hertz's line contact, and on any map the
# cylinder is the one of rc-synth. Its axis is the axis that repeats, and no tool takes it for a sphere.
. "$(dirname "$0")/../pipe.sh"

flat() { # NX NY: a flat map
    awk -v nx="$1" -v ny="$2" 'BEGIN { for (j = 0; j < ny; j++) for (i = 0; i < nx; i++) printf "0%s", i < nx - 1 ? " " : "\n" }' >flat.txt
    rc-import --quiet --format ascii --dx 2um --z-unit m flat.txt
}
roller() { rc-solve --quiet --load 1e5N/m --estar 114GPa --cylinder 10mm "$@"; }
same_values() { # FILE FILE: the first frames have the same numbers
    cmp <(rc-export --format csv --case 1 --channel height "$1" | grep -v '^#') <(rc-export --format csv --case 1 --channel height "$2" | grep -v '^#')
}
export -f roller same_values
flat 256 4 >wide.rcg
flat 4 256 >high.rcg
flat 256 1 >row.rcg
rc-pick --rotate 90 row.rcg -o column.rcg

# ---- Hertz: a^2 = 4 P' R/(pi E*), p0 = 2 P'/(pi a), approach = P'/(pi E*) (2 ln(2 datum/a) + 1) ----

eval "$(awk 'BEGIN { pi = 3.14159265358979; a = sqrt(4 * 1e5 * 10e-3 / (pi * 114e9))
    printf "half=%.9g peak=%.9g approach=%.9g", a, 2e5 / (pi * a), 1e5 / (pi * 114e9) * (2 * log(2 * 512e-6 / a) + 1) }')"
for map in wide:y high:x row:y column:x; do
    roller --periodic="${map#*:}" --report "${map%:*}.json" -o "${map%:*}.p.rcg" "${map%:*}.rcg"
    near "$(field max_pressure "${map%:*}.json")" "$peak" 2e-3 "a roller along ${map#*:} on the map ${map%:*} has Hertz's largest pressure"
    near "$(field approach "${map%:*}.json")" "$approach" 2e-3 "  and approach"
done
near "$(field contact_nodes wide.json)" "$(awk "BEGIN { print 4 * 2 * $half / 2e-6 }")" 0.02 "  and width of the contact"
near "$(field max_pressure high.json)" "$(field max_pressure wide.json)" "$six_digits" "the turned map has the same pressure"

# ---- the added shape ----

rc-synth selfaffine --nx 48 --ny 32 --dx 2um --dy 3um --hurst 0.8 --rms-height 5nm --rolloff 40um --short-cut 12um --seed 5 -o s.rcg
for case in ":90" "--periodic:90" "--periodic=y:90" "--periodic=x:0"; do
    rc-synth cylinder --like s.rcg --radius 3mm --direction "${case#*:}" -o c.rcg
    rc-add --quiet --subtract s.rcg c.rcg -o less.rcg # s - c, and twice s less that: s + c
    rc-add --quiet --subtract s.rcg less.rcg -o c-again.rcg
    rc-solve --quiet ${case%:*} --cylinder 3mm --load 1N --estar 100GPa --output height s.rcg -o h.rcg
    rc-add --quiet --subtract h.rcg s.rcg | rc-add --quiet --subtract - c-again.rcg | rc-info --json >d.json
    between 0 "$(field rms d.json)" 1e-19 "the cylinder of '${case%:*}' has its axis at ${case#*:} degrees"
    claim "  the key names it" says '^form=cylinder 0.003$' cat h.rcg
done
refuses 1 'a cylinder was already added to these heights \(form=cylinder 0.003\): remove --cylinder' "a second cylinder is refused" \
    'rc-solve --cylinder 3mm --load 1N --estar 100GPa h.rcg >/dev/null'
refuses 1 'a cylinder was already added to these heights \(form=cylinder 0.003\): remove --radius' "  and a sphere" \
    'rc-solve --radius 3mm --load 1N --estar 100GPa h.rcg >/dev/null'
refuses 2 '--cylinder does not work with --radius' "one shape at a time" \
    'rc-solve --cylinder 3mm --radius 3mm --load 1N --estar 100GPa s.rcg >/dev/null'
claim "on a free solve the periodic surface still repeats along the axis" \
    warns 'the surface is periodic along y, .*add --periodic=y' rc-solve --cylinder 3mm --load 1N --estar 100GPa --output height s.rcg -o h.rcg
claim "a radius without its unit is doubted" warns '--cylinder: a radius of 10 m .*write 10mm' rc-solve --load 1N --estar 114GPa --cylinder 10 --output height wide.rcg -o p.rcg

# ---- reports and other tools ----

claim "the report has the radius" says '"radius": null.*"cylinder": 0.01[,}]' cat wide.json
claim "  and the axis among the effects" says '"sphere": "left out: no --radius", "cylinder": "on: along y"' cat wide.json
claim "    which --dry-run prints" bash -c 'roller --periodic=x --dry-run high.rcg >dry.txt 2>&1; grep -q "cylinder.*on: along x" dry.txt'
claim "rc-render --hertz draws its strip" rc-render --hertz --channel pressure -o p.png wide.p.rcg
claim "rc-report names it" bash -c 'rc-report --quiet --periodic=y --cylinder 10mm --load 1e5N/m --estar 114GPa s.rcg -o page.html && grep -q "a cylinder of radius 10 mm is added" page.html'
claim "rc-cost solves with it" says 'max_pressure 602[0-9]{6} Pa' rc-cost --tol 1e-2 --limit 1s --quiet wide.rcg -- \
    rc-solve --periodic=y --cylinder 10mm --load 1e5N/m --estar 114GPa

# ---- a roller that travels ----

rc-solve --quiet --periodic=y --load 1e5N/m --estar 114GPa --cylinder 10mm --travel=-40um,0,20um --report t.json -o t.rcg wide.rcg
for k in 1 2 3; do
    near "$(sed -n "${k}p" t.json | grep -o '"max_pressure": [^,]*' | cut -d ' ' -f 2)" "$peak" 2e-3 "a roller has Hertz's pressure at position $k"
done
claim "  its middle is at the position" says '^0.00002|^1.9999' bash -c "rc-export --quiet --format xyz --channel pressure --case 3 t.rcg |
    awk '!/^#/ && NF { s += \$3; m += \$1 * \$3 } END { printf \"%.9g\n\", m / s }'"
near "$(head -n 1 t.json | grep -o '"cylinder": [^,}]*' | tail -n 1 | cut -d ' ' -f 2)" 0.01 "$same" "  its report has the radius"
refuses 2 'the cylinder would travel along its axis: take --periodic=y' "it does not travel along its axis" \
    'roller --periodic=x --travel 0 high.rcg >/dev/null'
refuses 2 '--travel has no effect without --radius, --cylinder or --counter' "nothing travels without a body 2" \
    'rc-solve --periodic=y --load 1N --estar 114GPa --travel 0 wide.rcg >/dev/null'
