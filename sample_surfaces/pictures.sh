#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Draws every kind of picture of rc-render, once for a screen (800 pixels) and once for the column of a
# journal (85 mm, PDF). Look at them when the code of the drawing has changed.
#
#     sample_surfaces/pictures.sh FOLDER        # the tools on PATH, or those of build/
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
folder=${1:?"usage: pictures.sh FOLDER"}
command -v rc-render >/dev/null || PATH="$here/../build/tools:$PATH"
mkdir -p "$folder"
cd "$folder"

# draw NAME ARGUMENT...: NAME.png and NAME.pdf
draw() {
    local name=$1
    shift
    rc-render --quiet --width 800 -o "$name.png" "$@"
    rc-render --quiet --width 85mm -o "$name.pdf" "$@"
    echo "$name"
}

rc-import --quiet "$here/rough-sphere.x3p" -o surface.rcg
rc-solve --quiet --radius 7.5mm --load 240N --estar 113.93GPa --hardness 6GPa --output pressure,gap,height surface.rcg -o contact.rcg
rc-stress --nu 0.3 --mu 0.15 --section y=0 --depths 0:300um:151 --components mises contact.rcg -o section.rcg
rc-stress --nu 0.3 --mu 0.15 --depths 0,5um,20um,80um --components mises,sxx contact.rcg -o slices.rcg
rc-solve --quiet --periodic --load 1N:60N:log:9 --estar 113.93GPa --report sweep.tsv --output pressure surface.rcg -o sweep.rcg

draw heights --channel height surface.rcg
draw pressure --channel pressure --contour contact.rcg
draw gap --channel gap contact.rcg
draw section section.rcg
rc-solve --quiet --radius 7.5mm --load 240N --E1 208GPa --nu1 0.3 --E2 208GPa --nu2 0.3 --layer 20um,400GPa,0.2 --layer 5um,280GPa,0.21 \
    --output pressure surface.rcg -o coated.rcg
rc-stress --section y=0 --depths auto --components mises,sxx coated.rcg -o media.rcg
draw media --depth-range 0:300um media.rcg
draw media-cut --channel sxx --cut x=0 media.rcg
draw slice --channel sxx --depth 5um slices.rcg
rc-synth selfaffine --nx 200 --ny 150 --dx 1um --hurst 0.8 --rms-height 20nm --seed 4 -o rough.rcg
rc-export --format xyz rough.rcg | awk '/^[-0-9]/ && ++n == 15060 { $3 = 4e-6 } { print }' >spike.xyz
rc-import --quiet --format xyz --dx 1um --z-unit m spike.xyz -o outlier.rcg
draw outlier outlier.rcg
rc-synth selfaffine --nx 400 --dx 5um --hurst 0.8 --rms-height 5nm --rolloff 200um --short-cut 50um --seed 2 |
    rc-solve --quiet --radius 10mm --load 1N --estar 100GPa --output pressure -o speck.rcg
draw speck --hertz speck.rcg
rc-pick --crop 0,100,483,1 surface.rcg -o profile.rcg
draw profile profile.rcg
rc-pick --resample 6um,1.5um surface.rcg -o oblong.rcg
draw oblong oblong.rcg
rc-detrend --quiet --outliers 3 rough.rcg -o missing.rcg
draw missing missing.rcg
draw sheet --channel mises --depth 0,5um,20um,80um --sheet 2x2 slices.rcg
draw relief --channel pressure --view 30,40 contact.rcg
draw curve --curve load:contact_fraction --log xy sweep.tsv
for seed in $(seq 20); do
    rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-height 10nm --seed "$seed"
done | rc-solve --quiet --periodic --load 10mN:80mN:log:4 --estar 100GPa --output pressure --report seeds.tsv -o seeds.rcg
draw seeds --curve load:contact_fraction --spread --points --log xy --y-unit % --y-label 'Real contact' --title '' seeds.tsv
rc-import --quiet "$here/rough-sphere.x3p" "$here/rough-steel.x3p" | rc-detrend --quiet --fill |
    rc-solve --quiet --load 10N:160N:log:5 --radius 7.5mm --estar 114GPa --output pressure --report two.tsv -o two.rcg
draw sources --curve load:contact_area --y-unit mm2 two.tsv
draw cut --channel pressure --cut y=0 contact.rcg
rc-slip --quiet --mu 0.3 --nu 0.3 --displacement 0.2um --output traction-x,slip-x,state contact.rcg -o slip.rcg
for channel in traction-x slip-x state; do draw "$channel" --channel "$channel" slip.rcg; done
rc-synth sphere --nx 129 --dx 10um --radius 7.5mm | rc-solve --quiet --load 60N --estar 114GPa --output pressure -o ball.rcg
draw hertz --cut y=0 --hertz --radius 7.5mm ball.rcg
rc-leak --quiet --viscosity 1mPas --pressure-drop 100kPa --output channel contact.rcg -o leak.rcg
draw channel leak.rcg
printf 'mean_pressure/Pa\tflow_rate/m3/s\n1e8\t1e-12\n3e8\t2e-13\n6e8\t0\n' >seal.tsv
draw seal --curve mean_pressure:flow_rate --log y seal.tsv
rc-solve --quiet --history --radius 7.5mm --load 0,20N,60N,20N,0,60N,90N,0 --estar 114GPa --hardness 6GPa --output pressure --report history.tsv surface.rcg -o history.rcg
draw history --curve indentation:load history.tsv
printf 'material\tload/N\nsteel\t1\nbronze\t3\nPTFE, filled with glass\t2\n' >materials.tsv
draw categories --curve material:load materials.tsv
draw persson --curve mean_pressure:contact_fraction --law persson --log xy sweep.tsv
draw histogram --channel pressure --histogram contact.rcg
rc-solve --quiet --radius 7.5mm --load 60N,240N --estar 113.93GPa --hardness 6GPa --output pressure,gap,height surface.rcg -o loads.rcg
draw border --channel height --hillshade --colormap grey --border --case 2 loads.rcg
draw borders --channel gap --border --sheet 2x1 loads.rcg
draw strip --depth-range 0:40um --aspect 4 section.rcg
draw tall --channel height --view 30,40 --exaggeration 40 surface.rcg
draw hillshade --channel height --hillshade surface.rcg
