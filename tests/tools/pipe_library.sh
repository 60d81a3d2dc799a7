# The program in libcontact(3) compiles as printed and agrees with Hertz; the shared library exports the names
# that its headers declare and no other.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/manual.sh"
. "$RC_SOURCE/tests/symbols.sh"

library=$(dirname "$RC_BIN")/libcontact
flags="-fopenmp $(sanitizers "$library/libcontact.a")"
with_mpi && flags="$flags -lmpi"

claim "the page has a program" program "$pages/libcontact.3" hertz.c
claim "  it has 30 lines at most" [ "$(wc -l <hertz.c)" -le 30 ]
# shellcheck disable=SC2086
claim "it compiles against the static library" ${CC:-cc} -std=c17 -Wall -Wextra -pedantic \
    -I "$RC_SOURCE" -o hertz hertz.c "$library/libcontact.a" $flags \
    -lfftw3_threads -lfftw3f_threads -lfftw3 -lfftw3f -lgsl -lgslcblas -lm
claim "it runs" bash -c './hertz >hertz.txt'
# a = 227.934 um, p0 = 2.20563 GPa, approach = 6.92720 um (Johnson 1985, section 4.2)
near "$(awk '/^approach/ { print $5 }' hertz.txt)" 6.92720e-6 "$six_digits" "approach of Hertz"
near "$(awk '/^pressure/ { print $5 }' hertz.txt)" 2.20563e9 "$six_digits" "peak pressure of Hertz"
near "$(awk '/^radius/ { print $5 }' hertz.txt)" 227.934e-6 "$six_digits" "radius of Hertz"
# 129 nodes over three radii
on_grid() { awk -v order="$1" 'BEGIN { print order / (129 / 3) ^ 2 }'; }
near "$(awk '/^approach/ { print $2 }' hertz.txt)" 6.92720e-6 "$(on_grid "$grid_approach")" "approach"
near "$(awk '/^pressure/ { print $2 }' hertz.txt)" 2.20563e9 "$(on_grid "$grid_peak")" "pressure in the middle"
# The error of the area is order / n, that of the radius half of it.
near "$(awk '/^radius/ { print $2 }' hertz.txt)" 227.934e-6 "$(awk -v order="$grid_area" 'BEGIN { print order / (129 / 3) / 2 }')" "radius"
# shellcheck disable=SC2086
claim "it compiles against the shared library" ${CC:-cc} -std=c17 -I "$RC_SOURCE" -o shared \
    hertz.c -L "$library" -lcontact $flags -lm
claim "it gives the same result" bash -c "
    LD_LIBRARY_PATH='$library' ./shared >shared.txt && cmp hertz.txt shared.txt"

claim "the page has a program of a loading history" program "$pages/libcontact.3" history.c rc_solver_keep_shape
claim "  its loop has a dozen lines" [ "$(sed -n '/^    for/,/^    }/p' history.c | wc -l)" -le 13 ]
# shellcheck disable=SC2086
claim "  it compiles" ${CC:-cc} -std=c17 -Wall -Wextra -pedantic -I "$RC_SOURCE" -o history \
    history.c "$library/libcontact.a" $flags -lfftw3_threads -lfftw3f_threads -lfftw3 -lfftw3f -lgsl -lgslcblas -lm
claim "  it runs" bash -c './history >history.txt'
claim "  the first load yields" grep -Eq '^240 N: [1-9][0-9]* nodes in contact, [1-9][0-9]* yield$' history.txt
claim "  a load of 0 has no contact" grep -qx '0 N: 0 nodes in contact, 0 yield' history.txt
claim "  the same load again causes no further yield" grep -Eq '^240 N: [1-9][0-9]* nodes in contact, 0 yield$' history.txt
claim "  a higher load does" grep -Eq '^300 N: [1-9][0-9]* nodes in contact, [1-9][0-9]* yield$' history.txt

# Names with a leading underscore belong to the compiler: marks of sanitizers.
offered() {
    local headers=("$RC_SOURCE"/libcontact/{contact,model,grid}.h) CC=${CC-}
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
