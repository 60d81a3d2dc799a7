/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Processes that share a map get the same displacements and stresses of slabs as one process, bit
 * for bit. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "volume_case.h"
#include "libcontact/contact_mpi.h"

static struct rc_ranks *ranks;

static void
of_shared_maps(void **state)
{
    static const struct rc_shape shapes[] = {
        {40, 66, 1e-6, 0.8e-6}, {33, 47, 1.1e-6, 1e-6}, {1, 200, 1e-6, 1e-6}, {64, 1, 1e-6, 1e-6}};
    static const double h[] = {0.3e-6, 0.5e-6, 0.02e-6, 1.1e-6, 2e-6, 0.7e-6};
    enum {
        SLABS = sizeof h / sizeof *h
    };

    (void)state;
    for (size_t k = 0; k < 4 * sizeof shapes / sizeof *shapes; k++) {
        struct rc_shape s = shapes[k / 4], part = s;
        struct rc_slabs_options o = {.boundary = RC_PERIODIC,
                                     .slabs = SLABS,
                                     .thickness = h,
                                     .shear = 8e10,
                                     .nu = 0.3,
                                     .whole = k % 2 == 0,
                                     .precision = k / 2 % 2 == 0 ? RC_DOUBLE : RC_SINGLE,
                                     .threads = 1};
        struct voxels e = voxels_new(s, SLABS), t = voxels_new(s, SLABS), own_e, own_t;
        size_t n = s.nx * s.ny, first, all = 0, off = 0;
        double *p = calloc(n, sizeof *p), *u = calloc(n, sizeof *u), *own_u;
        uint64_t seed = 3 + k;
        struct rc_slabs *v;

        voxels_random(&e, 0x3b, &seed);
        for (size_t i = 0; i < n; i++)
            p[i] = 1e8 * (0.6 + random_number(&seed));
        v = volume_new(s, o);
        volume_apply(v, &e, NULL, p, u, &t);
        rc_slabs_free(v);
        rc_ranks_rows(ranks, &s, &first, &part.ny);
        first *= s.nx;
        own_e = voxels_new(part, SLABS);
        own_t = voxels_new(part, SLABS);
        own_u = calloc(own_e.n + 1, sizeof *own_u);
        for (size_t m = 0; m < SLABS * RC_COMPONENTS; m++)
            memcpy(own_e.v + m * own_e.n, e.v + m * n + first, own_e.n * sizeof(double));
        o.ranks = ranks;
        v = volume_new(s, o);
        volume_apply(v, &own_e, NULL, p + first, own_u, &own_t);
        rc_slabs_free(v);
        for (size_t i = 0; i < own_e.n; i++)
            off += own_u[i] != u[first + i];
        for (size_t m = 0; m < SLABS * RC_COMPONENTS; m++)
            for (size_t i = 0; i < own_e.n; i++)
                off += !(own_t.v[m * own_e.n + i] == t.v[m * n + first + i]);
        MPI_Allreduce(&own_e.n, &all, 1, MPI_UNSIGNED_LONG, MPI_SUM, MPI_COMM_WORLD);
        MPI_Allreduce(MPI_IN_PLACE, &off, 1, MPI_UNSIGNED_LONG, MPI_SUM, MPI_COMM_WORLD);
        assert_int_equal(all, n);
        assert_int_equal(off, 0);
        free(e.v);
        free(t.v);
        free(own_e.v);
        free(own_t.v);
        free(p);
        free(u);
        free(own_u);
    }
}

int
main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(of_shared_maps)};
    struct rc_err err;
    int failed;

    MPI_Init(&argc, &argv);
    ranks = rc_ranks_new(MPI_COMM_WORLD, &err);
    failed = ranks == NULL ? 1 : cmocka_run_group_tests(tests, NULL, NULL);
    rc_ranks_free(ranks);
    MPI_Finalize();
    return failed;
}
