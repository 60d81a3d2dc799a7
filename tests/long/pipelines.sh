# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by compilers.sh and other_machines.sh. It has pipelines that use every part of the tools, and the
# permitted differences of their results with another compiler, processor or number of threads. Each line is a
# pipeline: the name of its result, the kind of comparison, the commands. A pipeline reads the results of the
# reference in $from, so that a difference comes from this step only.
#
#   exact   the same bytes
#   close   |a - b| <= 1e-12 max |b|: sums over a map in another order
#   sums    the same, for results that are small compared with the terms of their sums: 1e-10
#   solved  the sum of |a - b| <= 2e-9 times that of |b|: two solutions, each of --tol 1e-9
table() {
    cat <<'END'
rough.rcg       close   rc-synth selfaffine --nx 256 --ny 224 --dx 1um --dy 1.1um --hurst 0.8 --rms-slope 0.1 --rolloff 60um --short-cut 4um --seed 7
skew.rcg        close   rc-synth selfaffine --nx 75 --ny 64 --dx 1um --hurst 0.6 --rms-height 0.3um --weibull 3 --seed 11
steel.rcg       exact   rc-import $surfaces/rough-steel.x3p
brass.rcg       exact   rc-import $surfaces/turned-brass.txt
holes.rcg       close   rc-detrend --quiet --poly 2 --outliers 3 $from/steel.rcg
filled.rcg      sums    rc-detrend --quiet --fill --sphere $from/holes.rcg
low.rcg         close   rc-detrend --quiet --lowpass 12um $from/rough.rcg
robust.rcg      sums    rc-detrend --quiet --robust --plane --highpass 25um $from/rough.rcg
taper.rcg       close   rc-detrend --quiet --taper 15um $from/rough.rcg
fine.rcg        close   rc-pick --quiet --crop 10,20,60,50 --rotate 90 --resample 0.7um,0.8um $from/rough.rcg
both.rcg        exact   rc-add $from/rough.rcg $from/low.rcg
areal.json      sums    rc-info --json --areal --psd $from/rough.rcg
free.rcg        solved  rc-solve --quiet --load 0.5N --estar 100GPa --radius 5mm --tol 1e-9 --output pressure $from/rough.rcg
loads.rcg       solved  rc-solve --quiet --load 0.1N:1N:3 --estar 100GPa --radius 5mm --kernel mlms --tol 1e-9 --output pressure $from/rough.rcg
pk99.rcg        solved  rc-solve --quiet --load 0.5N --estar 100GPa --radius 5mm --method pk99 --tol 1e-9 --output pressure $from/rough.rcg
periodic.rcg    solved  rc-solve --quiet --periodic --mean-pressure 200MPa --estar 100GPa --tol 1e-9 --output pressure $from/rough.rcg
approach.rcg    solved  rc-solve --quiet --periodic --approach 1um --estar 100GPa --tol 1e-9 --output pressure $from/rough.rcg
hard.rcg        solved  rc-solve --quiet --load 3N --estar 100GPa --radius 5mm --hardness 4GPa --tol 1e-9 --output pressure $from/rough.rcg
coated.rcg      solved  rc-solve --quiet --load 0.5N --E1 210GPa --nu1 0.3 --layer 3um,400GPa,0.2 --E2 rigid --radius 5mm --tol 1e-9 --output pressure $from/rough.rcg
deflect.rcg     close   rc-deflect --estar 100GPa $from/free.rcg
wrapped.rcg     close   rc-deflect --estar 100GPa --periodic $from/periodic.rcg
levels.rcg      close   rc-deflect --estar 100GPa --kernel mlms --tol 1e-8 $from/free.rcg
patches.json    exact   rc-info --json --patches $from/free.rcg
friction.rcg    close   rc-stress --quiet --nu 0.3 --mu 0.2 --depths 0,2um,9um $from/free.rcg
below.rcg       close   rc-stress --quiet --nu 0.3 --mu 0.2 --depths 1um,5um --components sxx,szz,sxz $from/periodic.rcg
principal.rcg   close   rc-stress --quiet --nu 0.3 --depths 3um --components s1,s2,s3,tresca $from/hard.rcg
layered.rcg     sums    rc-stress --quiet --mu 0.1 --depths 1um,6um $from/coated.rcg
section.rcg     close   rc-stress --quiet --nu 0.3 --section y=0 --depths 0:20um:9 --components mises $from/free.rcg
END
}

# run_pipelines OUT FROM: runs every pipeline with the tools on PATH, results into OUT. It stops if a tool
# fails.
run_pipelines() {
    local out=$1 from=$2 name how command
    mkdir -p "$out"
    while read -r name how command; do
        surfaces=$surfaces from=$from bash -o pipefail -c "$command" >"$out/$name" </dev/null || {
            echo "$name: $command: exit status $?" >&2
            return 1
        }
    done < <(table)
}

# compare OUT REFERENCE: compares each result with the reference; prints a line with the largest difference.
compare() {
    table | "$python" "$here/compare.py" "$1" "$2"
}

# same_bytes OUT AGAIN: all files have the same bytes.
same_bytes() {
    diff -rq "$1" "$2"
}

# emulated FOLDER TOOLS COMMAND...: writes to FOLDER a script for each of the TOOLS, which runs it by COMMAND.
emulated() {
    local folder=$1 tools=$2 tool
    shift 2
    mkdir -p "$folder"
    for tool in "$tools"/rc-*; do
        printf '#!/bin/sh\nexec %s -0 %s %s "$@"\n' "$*" "${tool##*/}" "$tool" >"$folder/${tool##*/}"
        chmod +x "$folder/${tool##*/}"
    done
}
