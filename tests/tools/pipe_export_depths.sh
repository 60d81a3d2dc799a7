# SPDX-License-Identifier: GPL-3.0-or-later
# rc-export selects one case and some depths of a stream, and writes the depths of a stress as one array.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 16 --ny 12 --dx 1um --hurst 0.8 --rms-height 10nm --seed 2 |
    rc-solve --quiet --load 10mN,20mN --estar 100GPa --output pressure -o result.rcg
rc-stress --nu 0.3 --depths 0:10um:3 --components mises,szz result.rcg -o stress.rcg

# slices LIST...: prints the values of the frames, each selected by rc-pick, one after another.
slices() {
    for depth in "$@"; do
        rc-pick --channel szz --case 2 --depth "$depth" stress.rcg | rc-export --format npy | tail -c $((16 * 12 * 8))
    done
}
# head FILE: prints the header dictionary of an NPY file.
head_of() {
    head -c 128 "$1" | tail -c +11
}
export -f slices head_of

claim "a stack becomes a three-dimensional array, with depth as first index" bash -c '
    rc-export --channel szz --case 2 stress.rcg -o szz.npy &&
    head_of szz.npy | grep -qF "'"'shape': (3, 12, 16)"'" && slices 0 5um 10um >want && tail -c +129 szz.npy | cmp - want'
claim "--depth selects depths to a thousandth" bash -c '
    rc-export --channel szz --case 2 --depth 10.005um,0 stress.rcg -o two.npy &&
    head_of two.npy | grep -qF "(2, 12, 16)" && slices 0 10um >want && tail -c +129 two.npy | cmp - want'
claim "one depth becomes a map" bash -c '
    rc-export --channel szz --case 2 --depth 5um stress.rcg -o one.npy && head_of one.npy | grep -qF "(12, 16)"'
claim "any format of one map can have it" rc-export --channel szz --case 2 --depth 5um stress.rcg -o one.gsf
claim "--case selects the case for VTK" bash -c '
    rc-export --case 1 stress.rcg -o one.vti && says "Name=\"szz\"" cat one.vti && lacks _case one.vti'
claim "a list of cases is accepted" bash -c 'rc-export --case 1,2 stress.rcg -o both.vti && says "Name=\"szz_case2\"" cat both.vti'
claim "HDF5 has a block for each stress and each case" rc-export stress.rcg -o stress.h5
claim "  rc-import reads these blocks, slices or not" bash -c '
    rc-export --depth 5um --channel szz stress.rcg -o slices.h5 && rc-import --list slices.h5 2>&1 | grep szz_z5e-06'

refuses 1 'a second frame of channel szz, but npy holds one map or the depths of one channel and case: choose with --channel, --case and --depth' \
    "an array is of one case" 'rc-export --channel szz stress.rcg -o no.npy'
refuses 1 'a second frame, but npy holds' "and of one channel" 'rc-export --case 1 stress.rcg -o no.npy'
refuses 1 'a second frame of channel szz, but gsf holds one map: choose' "a format of one map takes one depth" \
    'rc-export --channel szz --case 1 stress.rcg -o no.gsf'
claim "the nearest depth is taken, with a message" bash -c '
    warns "no frame is at 7e-06 m: the nearest depth, 5e-06 m, is taken" \
        rc-export --channel szz --case 2 --depth 7um stress.rcg -o near.npy && cmp near.npy one.npy'
refuses 1 'no frame at depth 1.3e-05 m: there are 0, 5e-06, 1e-05 m' "a depth that is not there" 'rc-export --depth 5um,13um stress.rcg -o no.vti'
refuses 1 'no case 3: there are cases 1, 2' "nor a case" 'rc-export --case 3 stress.rcg -o no.vti'
refuses 1 'no frame with the channel mises, only pressure$' "nor a channel" 'rc-export --channel mises result.rcg -o no.vti'
refuses 2 '--depth -1e-06 m: it must be at least 0' "a depth above the surface" 'rc-export --depth -1um stress.rcg -o no.vti'
rc-stress --nu 0.3 --depths 0,5um,20um --components szz result.rcg -o uneven.rcg
refuses 1 'the depths have uneven steps, which npy cannot say: write vtr or hdf5' "uneven depths in an array" \
    'rc-export --case 1 uneven.rcg -o no.npy'
claim "  HDF5 has the depths beside the values" rc-export uneven.rcg -o uneven.h5
claim "refused commands leave no file" test -z "$(ls no.* 2>/dev/null)"
