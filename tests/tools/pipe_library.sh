# SPDX-License-Identifier: GPL-3.0-or-later
# The example at the top of contact.h agrees with Hertz, and the programs of libcontact(3) with the solutions that they
# name; the shared library exports the names that its headers declare and no other.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/manual.sh"
. "$RC_SOURCE/tests/symbols.sh"

library=$(dirname "$RC_BIN")/libcontact
flags="-fopenmp $(sanitizers "$library/libcontact.a")"
with_mpi && flags="$flags -lmpi"

# compiled PROGRAM: compiles PROGRAM.c against the static library, and runs it into PROGRAM.txt.
compiled() {
    # shellcheck disable=SC2086
    ${CC:-cc} -std=c17 -Wall -Wextra -Werror -pedantic -I "$RC_SOURCE" -o "$1" "$1.c" "$library/libcontact.a" $flags \
        -lfftw3_threads -lfftw3f_threads -lfftw3 -lfftw3f -lgsl -lgslcblas -lm && "./$1" >"$1.txt"
}

# ---- the example of the header ----

claim "contact.h has a program" head_program hertz.c
claim "  its main has 20 lines at most" [ "$(sed '1,/^main/d' hertz.c | wc -l)" -le 20 ]
claim "  it compiles and runs" compiled hertz
# approach, contact area, pressure: a = 227.934 um, p0 = 2.20563 GPa, approach = 6.92720 um (Johnson 1985, section 4.2);
# 129 nodes over three radii
on_grid() { awk -v order="$1" 'BEGIN { print order / (129 / 3) ^ 2 }'; }
near "$(awk '{ print $2 }' hertz.txt)" 6.92720e-6 "$(on_grid "$grid_approach")" "  approach"
near "$(awk '{ print $10 }' hertz.txt)" 2.20563e9 "$(on_grid "$grid_peak")" "  pressure in the middle"
near "$(awk '{ print $6 }' hertz.txt)" 1.63217e-7 "$(awk -v order="$grid_area" 'BEGIN { print order / (129 / 3) }')" "  area"
# shellcheck disable=SC2086
claim "  it compiles against the shared library" ${CC:-cc} -std=c17 -I "$RC_SOURCE" -o shared \
    hertz.c -L "$library" -lcontact $flags -lm
claim "  it gives the same result" bash -c "
    LD_LIBRARY_PATH='$library' ./shared >shared.txt && cmp hertz.txt shared.txt"

# ---- the programs of the page ----

blocks "$library_page" EXAMPLES page
# shown FILE: a display of the page is this file without its first two lines.
shown() {
    local block
    for block in page/*; do
        tail -n +3 "$1" | cmp -s - "$block" && return
    done
    return 1
}
for source in "$RC_SOURCE"/man/examples/*.c; do
    name=$(basename "$source" .c)
    cp "$source" .
    claim "$name.c compiles and runs" compiled "$name"
    claim "  the page has it" shown "$source"
done
# agree FILE PATTERN TOLERANCE TEXT: lines with the pattern, "... A ... B ...", have the numbers A and B alike.
agree() {
    sed -nE "s/.*$2.*/\1 \2/p" "$1" >pairs.txt
    claim "  $1 has numbers of both" [ -s pairs.txt ]
    while read -r number wanted; do near "$number" "$wanted" "$3" "  $4"; done <pairs.txt
}
value='([-+.0-9e]+)'
# The pressure in complete contact is exactly linear in the heights; its tolerance is 1e-5.
near "$(sed -n 's/.*contact on 1.0000 .* pressure \([^ ]*\) Pa$/\1/p' rough.txt)" \
    "$(sed -n 's/^complete .* pressure \([^ ]*\) Pa$/\1/p' rough.txt)" 1e-5 "rough.c: pressure of complete contact"
claim "  it has the four pressures, and all converged" bash -c '[ "$(grep -c "contact on" rough.txt)" = 4 ] && ! grep -q not rough.txt'
# The load is exact, and so is the volume.
sed -i '/^0.0 m/d' wear.txt
agree wear.txt "worn $value m3, Archard $value m3" 1e-5 "worn volume"
# 21 nodes over the radius: the displacement of a ball that sticks has an error of the order of the grid.
sed -i '/^0.00 N: moved 0 m/d' path.txt
agree path.txt "moved $value m, Mindlin $value m" 1e-2 "displacement along a path"
# 8 to 16 nodes over the radius, and steps in time to 8e-3.
agree creep.txt "approach $value m, Lee and Radok $value m" 1.2e-2 "approach in time"
agree seal.txt "conductance $value m3, sum of the cubes $value m3" 1e-5 "conductance of ridges"
sed 's/index/1 = index/' fatigue.txt >index.txt
agree index.txt "$value = index $value" 1e-3 "index at the endurance limit"
# 100 N on 65 x 65 cells of 1e-5 m; Hertz's approach, with 17 nodes over the radius
near "$(sed -n 's/^frame pressure: mean \([^ ]*\) .*/\1/p' figures.txt)" 2.36686391e8 "$six_digits" "figures.c: mean pressure"
near "$(sed -n 's/^approach: \([^ ]*\) .*/\1/p' figures.txt)" 3.86459e-6 "$(awk -v order="$grid_approach" 'BEGIN { print order / 17 ^ 2 }')" "  approach"

claim "history.c: its loop has a dozen lines" [ "$(sed -n '/^    for/,/^    }/p' history.c | wc -l)" -le 13 ]
claim "  the first load yields" grep -Eq '^240 N: [1-9][0-9]* nodes in contact, [1-9][0-9]* yield$' history.txt
claim "  a load of 0 has no contact" grep -qx '0 N: 0 nodes in contact, 0 yield' history.txt
claim "  the same load again causes no further yield" grep -Eq '^240 N: [1-9][0-9]* nodes in contact, 0 yield$' history.txt
claim "  a higher load does" grep -Eq '^300 N: [1-9][0-9]* nodes in contact, [1-9][0-9]* yield$' history.txt

# Names with a leading underscore belong to the compiler: marks of sanitizers.
offered() {
    local headers=("$RC_SOURCE"/libcontact/{contact,model,surface,grid}.h) CC=${CC-}
    with_mpi && headers+=("$RC_SOURCE/libcontact/contact_mpi.h") CC=mpicc
    declared "${headers[@]}" >declared.txt &&
        nm -D --defined-only "$library/libcontact.so" | awk '$3 !~ /^_/ { print $3 }' | sort >offered.txt &&
        diff declared.txt offered.txt >&2
}
if command -v nm >/dev/null; then
    claim "the shared library exports exactly the symbols of its headers" offered
    # The package is built without MPI.
    packaged() { sed -n 's/^ \(.*\)@Base .*/\1/p' "$RC_SOURCE/debian/libcontact0.1.symbols" | sort | diff - <(grep -v '^rc_ranks_' offered.txt) >&2; }
    claim "  its Debian package lists the same" packaged
    claim "  they are functions and an object" bash -c 'grep -qx rc_solver_new offered.txt && grep -qx rc_component_names offered.txt'
else
    untried "what the shared library offers, because nm is not here"
fi
