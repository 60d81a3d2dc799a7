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

/* The stack with its voxels. A voxel of a coarse slab is the node at its place. */
struct stack {
    struct rc_slabs *slabs;
    struct voxels *voxels;
};

static bool
take_nodes(void *ctx, size_t slab, enum rc_component c, size_t j, double *row)
{
    const struct stack *s = ctx;
    const size_t level = rc_slabs_level(s->slabs, slab), nx = s->voxels->nx;
    const double *from = voxels_map(s->voxels, slab, c) + (j << level) * nx;

    for (size_t i = 0; i < nx >> level; i++)
        row[i] = from[i << level];
    return true;
}

static void
keep_nodes(void *ctx, size_t slab, size_t j, double *const row[RC_COMPONENTS])
{
    const struct stack *s = ctx;
    const size_t level = rc_slabs_level(s->slabs, slab), nx = s->voxels->nx;

    for (size_t k = 0; k < STRAINS; k++)
        for (size_t i = 0; i < nx >> level; i++)
            voxels_map(s->voxels, slab, strains[k])[(j << level) * nx + (i << level)] =
                row[strains[k]][i];
}

/* Displacements, stresses, and the first strain of each coarse slab on the nodes of the map. */
static void
apply_stack(struct rc_slabs *v, struct voxels *e, const bool *strained, const double *p, double *u,
            struct voxels *t, double *refined)
{
    struct stack in = {v, e}, out = {v, t};
    const struct rc_slab_strain strain = {strained, take_nodes, &in};
    const struct rc_slab_stress stress = {NULL, keep_nodes, &out};

    rc_slabs_up(v, &strain, u);
    rc_slabs_down(v, p, &stress);
    for (size_t k = 0; k < e->slabs && refined != NULL; k++) {
        const size_t level = rc_slabs_level(v, k), nx = e->nx;
        double *map = refined + k * e->n;
        for (size_t j = 0; j << level < e->n / nx; j++)
            (void)take_nodes(&in, k, RC_SXX, j, map + j * (nx >> level));
        rc_slabs_refine(v, k, map);
    }
}

/* Slabs on coarser grids, whose rows and columns ranks own by another rule. */
static void
of_levels(void **state)
{
    static const struct {
        struct rc_shape shape;
        bool periodic;
    } cases[] = {{{128, 64, 1e-6, 1e-6}, true},
                 {{128, 256, 1e-6, 0.8e-6}, true},
                 {{320, 64, 1e-6, 0.9e-6}, false},
                 {{1056, 48, 1e-6, 1e-6}, true}};
    static const double h[] = {0.5e-6, 1e-6, 4e-6, 6e-6, 6e-6, 9e-6, 9e-6, 12e-6, 12e-6};
    enum {
        SLABS = sizeof h / sizeof *h
    };
    size_t deepest = 0;

    (void)state;
    for (size_t k = 0; k < 4 * sizeof cases / sizeof *cases; k++) {
        struct rc_shape s = cases[k / 4].shape, part = s;
        const bool none[SLABS] = {false}, all[SLABS] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
        struct rc_slabs_options o = {.boundary = cases[k / 4].periodic ? RC_PERIODIC : RC_FREE,
                                     .slabs = SLABS,
                                     .thickness = h,
                                     .shear = 8e10,
                                     .nu = 0.3,
                                     .coarser = 0.4,
                                     .precision = k % 2 == 0 ? RC_DOUBLE : RC_SINGLE,
                                     .threads = 1 + k / 2 % 2};
        const bool *strained = k % 4 == 3 ? none : all; /* none: nothing moves on the way up */
        struct voxels e = voxels_new(s, SLABS), t = voxels_new(s, SLABS), own_e, own_t;
        size_t n = s.nx * s.ny, first, off = 0;
        double *p = calloc(n, sizeof *p), *u = calloc(n, sizeof *u), *own_u;
        double *map = calloc(n * SLABS, sizeof *map), *own_map;
        uint64_t seed = 3 + k;
        struct rc_slabs *v;

        voxels_random(&e, (1U << SLABS) - 1, &seed);
        for (size_t i = 0; i < n; i++)
            p[i] = 1e8 * (0.6 + random_number(&seed));
        v = volume_new(s, o);
        deepest = rc_slabs_level(v, SLABS - 1) > deepest ? rc_slabs_level(v, SLABS - 1) : deepest;
        apply_stack(v, &e, strained, p, u, &t, map);
        rc_slabs_free(v);
        rc_ranks_rows(ranks, &s, &first, &part.ny);
        first *= s.nx;
        own_e = voxels_new((struct rc_shape){s.nx, part.ny + 1, s.dx, s.dy}, SLABS);
        own_t = voxels_new((struct rc_shape){s.nx, part.ny + 1, s.dx, s.dy}, SLABS);
        own_e.n = own_t.n = s.nx * part.ny;
        own_u = calloc(own_e.n + 1, sizeof *own_u);
        own_map = calloc(own_e.n * SLABS + 1, sizeof *own_map);
        for (size_t m = 0; m < SLABS * RC_COMPONENTS; m++)
            memcpy(own_e.v + m * own_e.n, e.v + m * n + first, own_e.n * sizeof(double));
        o.ranks = ranks;
        v = volume_new(s, o);
        apply_stack(v, &own_e, strained, p + first, own_u, &own_t, own_map);
        rc_slabs_free(v);
        for (size_t i = 0; i < own_e.n; i++)
            off += own_u[i] != u[first + i];
        for (size_t m = 0; m < SLABS; m++)
            for (size_t i = 0; i < own_e.n; i++)
                off += !(own_map[m * own_e.n + i] == map[m * n + first + i]);
        for (size_t m = 0; m < SLABS * RC_COMPONENTS; m++)
            for (size_t i = 0; i < own_e.n; i++)
                off += !(own_t.v[m * own_e.n + i] == t.v[m * n + first + i]);
        MPI_Allreduce(MPI_IN_PLACE, &off, 1, MPI_UNSIGNED_LONG, MPI_SUM, MPI_COMM_WORLD);
        assert_int_equal(off, 0);
        free(e.v);
        free(t.v);
        free(own_e.v);
        free(own_t.v);
        free(p);
        free(u);
        free(own_u);
        free(map);
        free(own_map);
    }
    assert_int_equal(deepest, 3);
}

int
main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(of_shared_maps),
                                       cmocka_unit_test(of_levels)};
    struct rc_err err;
    int failed;

    MPI_Init(&argc, &argv);
    ranks = rc_ranks_new(MPI_COMM_WORLD, &err);
    failed = ranks == NULL ? 1 : cmocka_run_group_tests(tests, NULL, NULL);
    rc_ranks_free(ranks);
    MPI_Finalize();
    return failed;
}
