# The sample surfaces are what their script makes, and the demo runs on them.
. "$(dirname "$0")/pipe.sh"

claim "make.sh makes the samples again, bit for bit" bash -c '
    mkdir again && bash "$RC_SOURCE/sample_surfaces/make.sh" again &&
    cmp again/rough-steel.x3p "$RC_SOURCE/sample_surfaces/rough-steel.x3p" &&
    cmp again/rough-sphere.x3p "$RC_SOURCE/sample_surfaces/rough-sphere.x3p" &&
    cmp again/turned-brass.txt "$RC_SOURCE/sample_surfaces/turned-brass.txt"'
# 0.55 of pi a^2, a^3 = 3 F R / 4 E*; the pressure reaches the hardness exactly, and nowhere more
claim "the rough sphere of the paper: contact area 0.55 of that of Hertz, cut at 6 GPa" bash -c '
    rc-import "$RC_SOURCE/sample_surfaces/rough-sphere.x3p" |
        rc-solve --radius 7.5mm --load 240N --estar 113.93GPa --hardness 6GPa --output pressure \
            --report sphere.json -o sphere.rcg &&
    perl -ne "exit(!(/\"contact_area\": ([^,]*)/ && abs(\$1 / (3.14159265 * (0.75 * 240 * 7.5e-3 / 113.93e9) ** (2 / 3)) - 0.55) < 0.005 &&
        /\"max_pressure\": 6000000000,/ && /\"plastic_area\": ([^,]*)/ && \$1 > 0 && \$1 < 6e-9))" sphere.json'

for sample in rough-steel.x3p rough-sphere.x3p turned-brass.txt; do
    claim "$sample goes from file to picture in one line" bash -c "
        set -o pipefail
        rc-import '$RC_SOURCE/sample_surfaces/$sample' | rc-detrend --fill --poly 2 |
            rc-solve --mean-pressure 30MPa --estar 114GPa --hardness 6GPa --quiet |
            rc-stress --nu 0.3 --depths 0,2um,5um --components mises |
            rc-render --channel mises -o $sample.png && [ -s $sample.png ]"
done

if [ -d "$RC_CORPUS/corpus" ]; then
    real=$RC_CORPUS/corpus/x3p/bulletxtrctr__Hamby252_Barrel1_Bullet1_Land1.x3p
    claim "a real X3P goes from file to picture in one line" bash -c "
        set -o pipefail
        rc-import '$real' | rc-detrend --poly 2 --fill |
            rc-solve --mean-pressure 30MPa --estar 114GPa --hardness 6GPa --quiet |
            rc-stress --nu 0.3 --depths 0,5um --components mises |
            rc-render --channel mises -o real.png && [ -s real.png ]"
else
    echo "not run: no corpus of real files beside the project"
fi

finish
