# SPDX-License-Identifier: GPL-3.0-or-later
# Every tool accepts maps of one node, one row or one column or refuses them with the reason. A map of 46,400
# x 46,400 nodes has more nodes than 32 bits count. If it does not fit into memory, the message gives the
# right size.
. "$(dirname "$0")/../pipe.sh"

# answers "sentence" command...: exit status 0, or 1 if the map is too small for the task.
too_small='a single node has no spectrum|unknowns, and only|coefficients, and only|longer than the map|narrower than a node|do not determine'
answers() {
    local sentence=$1 status
    shift
    bash -c "$*" >answers.out 2>answers.err </dev/null
    status=$?
    if [ $status = 0 ] || { [ $status = 1 ] && grep -qE "^rc-.*($too_small)" answers.err; }; then
        passed "$sentence: $([ $status = 0 ] && echo done || cut -c1-120 answers.err | head -n 1)"
    else
        failed "$sentence: exit status $status"
        sed 's/^/    /' answers.err
    fi
}

for size in "1 1" "1 9" "9 1" "2 1" "2 2"; do
    set -- $size
    rc-synth wave --nx "$1" --ny "$2" --dx 1um --amplitude 10nm --wavelength 9um -o map.rcg
    rc-synth sphere --nx "$1" --ny "$2" --dx 1um --radius 1mm -o ball.rcg
    for boundary in "" --periodic; do
        answers "$1 x $2: contact $boundary" "rc-solve $boundary --load 1uN --estar 1GPa ball.rcg -o contact$boundary.rcg"
        answers "$1 x $2: coated contact $boundary" \
            "rc-solve $boundary --load 1uN --E1 1GPa --nu1 0.3 --E2 rigid --layer 1um,2GPa,0.3 ball.rcg -o coated$boundary.rcg"
        answers "$1 x $2: stress $boundary" \
            "[ ! -e contact$boundary.rcg ] || rc-stress --nu 0.3 --depths auto contact$boundary.rcg -o stress.rcg"
    done
    answers "$1 x $2: section" "rc-stress --nu 0.3 --section y=0 --depths 0:1um:3 contact.rcg -o section.rcg"
    answers "$1 x $2: displacement" "rc-deflect --estar 1GPa contact.rcg"
    answers "$1 x $2: friction" "rc-slip --quiet --mu 0.3 --nu 0.3 --displacement 1pm contact.rcg"
    answers "$1 x $2: leakage" "rc-leak contact.rcg"
    answers "$1 x $2: figures" "rc-info --areal --psd map.rcg"
    answers "$1 x $2: patches" "rc-info --patches contact.rcg"
    for step in "--plane" "--poly 2" "--sphere" "--cylinder" "--lowpass 2um" "--highpass 2um --robust" "--outliers 3" "--spikes 3" "--taper 0.5um" "--fill"; do
        answers "$1 x $2: rc-detrend $step" "rc-detrend $step map.rcg"
    done
    for step in "--resample 0.5um" "--resample 2um" "--crop 0,0,1,1" "--mirror x" "--rotate 90"; do
        answers "$1 x $2: rc-pick $step" "rc-pick $step map.rcg"
    done
    answers "$1 x $2: a sum" "rc-add map.rcg ball.rcg"
    for format in x3p sdf gsf npy vti vtr csv xyz hdf5 gwy sur; do
        answers "$1 x $2: written as $format" "rc-export --format $format map.rcg -o map.$format"
    done
    answers "$1 x $2: read as npy" "rc-import --dx 1um --z-unit m map.npy"
    answers "$1 x $2: read as sdf" "rc-import map.sdf"
    answers "$1 x $2: drawn" "rc-render --figure map.rcg -o map.png"
    rm -f ./*.rcg map.*
done

rc-synth sphere --nx 3 --dx 1um --radius 1mm -o small.rcg
sed -e '/^nx=/s/.*/nx=46400/' -e '/^ny=/s/.*/ny=46400/' small.rcg >huge.rcg
# it exceeds an address space of 32 bits, for any --memory
told='46400 x 46400 nodes need about 164[0-9]{2} MiB, --memory allows 4096 MiB: |2152960000 x 8 is more than this machine can address'
for tool in "rc-info --areal" "rc-pick --rotate 90" "rc-detrend --lowpass 9um" "rc-solve --load 1N --estar 1GPa" "rc-stress --nu 0.3 --depths 1um" \
    "rc-deflect --estar 1GPa" "rc-slip --mu 0.3 --nu 0.3 --tangential 1N" rc-leak "rc-export --format npy" "rc-add --subtract --align huge.rcg" "rc-render -o x.png"; do
    refuses 1 "$told" "$tool: no room for 46,400 x 46,400" "$tool --memory 4G huge.rcg | cat"
done
refuses 1 "$told" "rc-cost: no room for it either" "rc-cost --memory 4G huge.rcg -- rc-solve --load 1N --estar 1GPa | cat"
refuses 1 'about 16[0-9]{3} MiB|17223680000 bytes|164[0-9][0-9] MiB|2152960000 x 8 is more' "rc-synth: no room for it either" \
    "rc-synth sphere --nx 46400 --dx 1um --radius 1mm --memory 4G -o x.rcg"
refuses 1 'do not fit|overflow|too many|more than' "more nodes than 64 bits count" \
    "sed -e '/^nx=/s/.*/nx=4294967297/' -e '/^ny=/s/.*/ny=4294967297/' small.rcg | rc-info --verbose"
