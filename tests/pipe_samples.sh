# The sample surfaces are what their script makes, and the demo runs on them.
. "$(dirname "$0")/pipe.sh"

claim "make.sh makes the samples again, bit for bit" bash -c '
    mkdir again && bash "$RC_SOURCE/sample_surfaces/make.sh" again &&
    cmp again/rough-steel.x3p "$RC_SOURCE/sample_surfaces/rough-steel.x3p" &&
    cmp again/turned-brass.txt "$RC_SOURCE/sample_surfaces/turned-brass.txt"'

for sample in rough-steel.x3p turned-brass.txt; do
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
