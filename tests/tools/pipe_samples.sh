# SPDX-License-Identifier: GPL-3.0-or-later
# Their script reproduces the sample surfaces, and the demo runs on them.
. "$(dirname "$0")/../pipe.sh"

# Every sample has a row here, and make.sh makes no other file.
samples="rough-steel.x3p rough-sphere.x3p turned-brass.txt"
claim "make.sh makes the samples again, bit for bit" bash -c '
    mkdir again && bash "$RC_SOURCE/sample_surfaces/make.sh" again &&
    [ "$(ls again | wc -l)" = '"$(wc -w <<<"$samples")"' ] &&
    for sample in '"$samples"'; do cmp "again/$sample" "$RC_SOURCE/sample_surfaces/$sample" || exit 1; done'
# with_origin FILE...: sample_surfaces/README.md has each of them, in backquotes.
with_origin() {
    [ $# -gt 20 ] || return
    for file; do
        grep -qF "\`${file##*/}\`" "$RC_SOURCE/sample_surfaces/README.md" || { echo "$file" >&2; return 1; }
    done
}
claim "the origin of each sample and picture is listed" with_origin "$RC_SOURCE"/sample_surfaces/*.{png,x3p,txt}
# 0.55 of pi a^2, a^3 = 3 F R / 4 E*; the largest pressure is exactly the hardness
claim "the rough sphere of the paper has 0.55 of Hertz's contact area, with a hardness of 6 GPa" bash -c '
    rc-import "$RC_SOURCE/sample_surfaces/rough-sphere.x3p" |
        rc-solve --radius 7.5mm --load 240N --estar 113.93GPa --hardness 6GPa --output pressure \
            --report sphere.json -o sphere.rcg'
hertz=$(awk 'BEGIN { print 3.14159265 * (0.75 * 240 * 7.5e-3 / 113.93e9) ^ (2 / 3) }')
between 0.545 "$(awk -v a="$(field contact_area sphere.json)" -v b="$hertz" 'BEGIN { print a / b }')" 0.555 \
    "  that is, 0.55 to two digits"
near "$(field max_pressure sphere.json)" 6e9 "$same" "  the largest pressure is the hardness"
between 1e-9 "$(field plastic_area sphere.json)" 6e-9 "  on a part of it"

# one_line FILE WORDS DEPTHS LEVEL LIMIT: a pipeline of one line draws it. The pressure carries the load, and the
# hardness limits it if the tips reach it (LIMIT, else empty). The picture shows the largest stress of its depth.
one_line() {
    local most
    claim "a pipeline of one line draws $2" bash -c "
        rc-import '$1' | rc-detrend $4 |
            rc-solve --mean-pressure 30MPa --estar 114GPa --hardness 6GPa --quiet --report line.json |
            rc-stress --nu 0.3 --depths $3 --components mises | tee line.rcg |
            rc-render --channel mises --depth 0 -o line.svg"
    near "$(field mean_pressure line.json)" 30e6 "$summed" "  the load is that of its mean pressure"
    between "${5:-30e6}" "$(field max_pressure line.json)" 6e9 "  the hardness limits its tips"
    most=$(rc-pick --channel mises --depth 0 line.rcg | rc-export --format csv | grep -v '^#' | tr , '\n' | awk '$1 > m { m = $1 } END { print m }')
    near "$(sed -n 's/.*max \([0-9.]*\) GPa<.*/\1e9/p; s/.*max \([0-9.]*\) MPa<.*/\1e6/p' line.svg)" "$most" 1e-3 \
        "  the picture shows the largest stress"
}
for sample in $samples; do
    case $sample in *brass*) limit= ;; *) limit=6e9 ;; esac
    one_line "$RC_SOURCE/sample_surfaces/$sample" "$sample" 0,2um,5um '--fill --poly 2' $limit
done
claim "the demo runs" bash -c '
    mkdir demo && cd demo && bash "$RC_SOURCE/sample_surfaces/demo.sh" >said.txt &&
    says PNG head -c 4 rc-demo/height.png && says PNG head -c 4 rc-demo/pressure.png &&
    says PNG head -c 4 rc-demo/mises.png'
near "$(sed -n 's/^  load *\([0-9.]*\) N$/\1/p' demo/said.txt)" 60 "$summed" "  and says what it found, with units"
near "$(sed -n 's/^  pressure *at most \([0-9.]*\) GPa$/\1/p' demo/said.txt)" 6 "$same" "  with the hardness that it gave"
claim "  it runs on another file too" bash -c '
    cd demo && says "^  load +[0-9.]+ N$" bash "$RC_SOURCE/sample_surfaces/demo.sh" ../again/turned-brass.txt'

if [ -d "$RC_CORPUS/corpus" ]; then
    one_line "$RC_CORPUS/corpus/x3p/bulletxtrctr__Hamby252_Barrel1_Bullet1_Land1.x3p" "a real X3P" 0,5um '--poly 2 --fill' 6e9
else
    untried "real files: there is no corpus beside the project"
fi
