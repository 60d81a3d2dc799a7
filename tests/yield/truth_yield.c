/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plasticity in the volume, compared with a minimum of the same convex energy that another method finds, with
 * a dense quadratic program for the contact. The return to the yield surface is compared with its closed
 * form. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/volume/volume_case.h"
#include "tests/solver/dense.h"
#include "libcontact/yield/yield.h"
#include "libcontact/yield/law.h"

enum {
    N = 16,
    NODES = N * N,
    SLABS = 8,
    ROUNDS = 4000
};
static const double nu = 0.3, shear = 1 / 2.6, estar = 1 / (1 - 0.09);

/* ---- the minimiser ---- */

struct state {
    struct dense d;
    struct rc_slabs *v;
    double yield, modulus, *h, *p;
    struct voxels e, x, y, f; /* strain; its increment: the last two iterates and the new one */
    struct voxels all, s;
    double *strain; /* equivalent */
};

static double
mises(const struct voxels *s, size_t slab, size_t i)
{
    double xx = voxels_map(s, slab, RC_SXX)[i], yy = voxels_map(s, slab, RC_SYY)[i];
    double zz = voxels_map(s, slab, RC_SZZ)[i], xy = voxels_map(s, slab, RC_SXY)[i];
    double xz = voxels_map(s, slab, RC_SXZ)[i], yz = voxels_map(s, slab, RC_SYZ)[i];

    return sqrt(((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx)) / 2 +
                3 * (xy * xy + xz * xz + yz * yz));
}

static void
sum_of(const struct voxels *a, const struct voxels *b, double factor, struct voxels *to)
{
    for (size_t k = 0; k < a->n * a->slabs * RC_COMPONENTS; k++)
        to->v[k] = a->v[k] + factor * b->v[k];
}

/* Pressure and stress of e + y. */
static void
equilibrium(struct state *t, double load)
{
    static double u[NODES], form[NODES], most[NODES];
    double shift[DENSE_SUMS];

    sum_of(&t->e, &t->y, 1, &t->all);
    volume_apply(t->v, &t->all, NULL, NULL, u, &t->s);
    for (size_t k = 0; k < NODES; k++) {
        form[k] = t->h[k] - u[k];
        most[k] = INFINITY;
        t->p[k] = load > 0 ? t->p[k] : 0;
    }
    t->d.value[0] = load;
    if (load > 0)
        dense_solve(&t->d, form, most, t->p, shift);
    volume_apply(t->v, &t->all, NULL, t->p, u, &t->s);
}

/* f = the proximal gradient step from y. */
static void
descend(struct state *t)
{
    sum_of(&t->s, &t->y, 2 * shear, &t->all);
    for (size_t k = 0; k < SLABS; k++)
        for (size_t i = 0; i < NODES; i++) {
            double size = mises(&t->all, k, i);
            double above = size - t->yield - t->modulus * t->strain[k * NODES + i];
            double grown = above > 0 ? above / (3 * shear + t->modulus) : 0;
            for (int c = 0; c < RC_COMPONENTS; c++) {
                enum rc_component q = (enum rc_component)c;
                voxels_map(&t->f, k, q)[i] =
                    grown > 0 ? 1.5 * grown * voxels_map(&t->all, k, q)[i] / size : 0;
            }
        }
}

/* Nesterov's accelerated descent, which restarts when it overshoots, until convergence. */
static void
minimise(struct state *t, double load)
{
    double pace = 1, change = INFINITY;

    memset(t->x.v, 0, NODES * SLABS * RC_COMPONENTS * sizeof(double));
    memset(t->y.v, 0, NODES * SLABS * RC_COMPONENTS * sizeof(double));
    for (int round = 0; round < ROUNDS && change > 1e-14; round++) {
        double next = (1 + sqrt(1 + 4 * pace * pace)) / 2, along = 0;
        change = 0;
        equilibrium(t, load);
        descend(t);
        for (size_t k = 0; k < NODES * SLABS * RC_COMPONENTS; k++) {
            change = fmax(change, fabs(t->f.v[k] - t->y.v[k]));
            along += (t->y.v[k] - t->f.v[k]) * (t->f.v[k] - t->x.v[k]);
        }
        if (along > 0)
            pace = 1, next = 1;
        for (size_t k = 0; k < NODES * SLABS * RC_COMPONENTS; k++) {
            t->y.v[k] = t->f.v[k] + (pace - 1) / next * (t->f.v[k] - t->x.v[k]);
            t->x.v[k] = t->f.v[k];
        }
        pace = next;
    }
    assert_true(change <= 1e-13);
    for (size_t k = 0; k < SLABS; k++)
        for (size_t i = 0; i < NODES; i++) /* mises() of a strain is 3/2 of its equivalent strain */
            t->strain[k * NODES + i] += 2 * mises(&t->x, k, i) / 3;
    sum_of(&t->e, &t->x, 1, &t->e);
    memset(t->y.v, 0, NODES * SLABS * RC_COMPONENTS * sizeof(double));
    equilibrium(t, load);
}

static void
compare(struct rc_yield_solver *plastic, const struct state *t, double load)
{
    static double found[RC_YIELD_STRAINS][NODES];
    double *const to[] = {found[0], found[1], found[2], found[3], found[4], found[5]};
    double most = 0, worst = 0;
    size_t yields = 0;

    for (size_t k = 0; k < SLABS; k++) {
        rc_yield_solver_strain(plastic, k, to);
        for (size_t i = 0; i < NODES; i++) {
            double is = t->strain[k * NODES + i];
            for (int c = 0; c < STRAINS; c++)
                worst = fmax(worst, fabs(found[c][i] - voxels_map(&t->e, k, strains[c])[i]));
            worst = fmax(worst, fabs(found[RC_PEEQ][i] - is));
            most = fmax(most, is);
            yields += is > 0;
        }
    }
    print_message("load %.3g: %zu voxels yield, strain to %.3g, off by %.1e of it", load, yields,
                  most, worst / most);
    assert_true(yields > 50);
    assert_true(worst <= 1e-8 * most);
    if (load > 0) {
        double off = distance(NODES, rc_solver_pressure(plastic->solver), t->p);
        print_message("; pressure by %.1e", off);
        assert_true(off <= 1e-8);
    }
    print_message("\n");
}

/* The loads, each in one increment: a load, a higher one, unloading by half, separation, and loading
 * again. */
static void
convex_minimum(void **state)
{
    static struct state t;
    static const double loads[] = {0.02, 0.035, 0.01, 0, 0.03};
    const struct rc_shape shape = {N, N, 1, 1};
    double thickness[SLABS], h[NODES];
    struct rc_selfaffine rough = {.hurst = 0.8, .rms_slope = 0.25, .short_cut = 4, .seed = 8};
    struct rc_yield_problem problem = {
        .contact = {.boundary = RC_PERIODIC,
                    .pair = {.one = {.e = 1, .nu = nu}, .two = {.e = INFINITY}},
                    .tol = 1e-11,
                    .threads = 1},
        .law = {.stress = 0.04, .modulus = 0.05},
        .slabs = SLABS,
        .thickness = thickness,
        .increments = 1,
        .lag = 1e-11,
        .precise = true};
    struct rc_yield_solver *plastic;
    struct rc_err err;

    (void)state;
    for (size_t k = 0; k < SLABS; k++)
        thickness[k] = 0.4 + 0.1 * (double)k;
    assert_int_equal(rc_synth_selfaffine(&shape, &rough, h, NULL), RC_OK);
    t = (struct state){.yield = 0.04, .modulus = 0.05, .h = h};
    t.v = volume_new(shape, (struct rc_slabs_options){.boundary = RC_PERIODIC,
                                                      .slabs = SLABS,
                                                      .thickness = thickness,
                                                      .shear = shear,
                                                      .nu = nu});
    dense_fill(&t.d, &shape, RC_PERIODIC, estar);
    t.p = calloc(NODES, sizeof *t.p);
    t.strain = calloc(NODES * SLABS, sizeof *t.strain);
    t.e = voxels_new(shape, SLABS);
    t.x = voxels_new(shape, SLABS);
    t.y = voxels_new(shape, SLABS);
    t.f = voxels_new(shape, SLABS);
    t.all = voxels_new(shape, SLABS);
    t.s = voxels_new(shape, SLABS);
    plastic = rc_yield_solver_new(&shape, h, &problem, &err);
    assert_non_null(plastic);
    for (size_t q = 0; q < sizeof loads / sizeof *loads; q++) {
        enum rc_status status;
        assert_int_equal(rc_yield_solver_set_load(plastic, loads[q] * NODES, &err), RC_OK);
        while ((status = rc_yield_solver_step(plastic, &err)) == RC_MORE)
            ;
        assert_int_equal(status, RC_OK);
        for (size_t k = 0; k < NODES && loads[q] > 0; k++) /* where to begin */
            t.p[k] = rc_solver_pressure(plastic->solver)[k];
        minimise(&t, loads[q] * NODES);
        compare(plastic, &t, loads[q]);
    }
    rc_yield_solver_free(plastic);
    rc_slabs_free(t.v);
    free(t.p);
    free(t.strain);
    free(t.e.v);
    free(t.x.v);
    free(t.y.v);
    free(t.f.v);
    free(t.all.v);
    free(t.s.v);
}

/* ---- the return ---- */

static void
returns(void **state)
{
    static const double strain[] = {0, 0.01, 0.03, 0.1}, stress[] = {100, 150, 170, 170};
    const struct rc_yield_law line = {.stress = 100, .modulus = 40};
    const struct rc_yield_law table = {.points = 4, .strain_at = strain, .stress_at = stress};
    const double stiffness = 3000;
    uint64_t seed = 4;

    (void)state;
    assert_true(fabs(rc_yield_law_return(&line, stiffness, 0.5, 200) - (200 - 120) / 3040.0) <
                1e-15);
    assert_true(rc_yield_law_return(&line, stiffness, 0.5, 120) == 0);
    assert_true(fabs(rc_yield_law_stress(&table, 0.02) - 160) < 1e-12);
    assert_true(rc_yield_law_stress(&table, 7) == 170);
    assert_true(fabs(rc_yield_law_work(&table, 0.05) - (1.25 + 3.2 + 3.4)) < 1e-12);
    assert_true(fabs(rc_yield_law_work(&line, 0.2) - (20 + 0.8)) < 1e-12);
    for (int q = 0; q < 1000;
         q++) { /* the stress after the return is on the curve, on any of its segments */
        double from = 0.12 * (random_number(&seed) + 0.5);
        double mises = rc_yield_law_stress(&table, from) + 300 * (random_number(&seed) + 0.5);
        double grown = rc_yield_law_return(&table, stiffness, from, mises);
        assert_true(fabs(mises - stiffness * grown - rc_yield_law_stress(&table, from + grown)) <
                    1e-10);
    }
}

static void
refused(void **state)
{
    static const double falls[] = {0, 0.1}, stress[] = {2, 1};
    const struct rc_shape shape = {8, 8, 1, 1};
    const double h[64] = {0}, thickness = 1;
    const struct rc_yield_problem good = {
        .contact = {.boundary = RC_PERIODIC,
                    .pair = {.one = {.e = 1, .nu = nu}, .two = {.e = INFINITY}}},
        .law = {.stress = 0.01},
        .slabs = 1,
        .thickness = &thickness};
    struct rc_yield_problem bad[7] = {good, good, good, good, good, good, good};
    struct rc_yield_solver *plastic = rc_yield_solver_new(&shape, h, &good, NULL);
    struct rc_err err;

    (void)state;
    assert_non_null(plastic);
    assert_int_equal(rc_yield_solver_step(plastic, &err), RC_FAIL);
    assert_int_equal(rc_yield_solver_set_load(plastic, -1, &err), RC_FAIL);
    rc_yield_solver_free(plastic);
    bad[0].law.stress = 0;
    bad[1].law.modulus = -1;
    bad[2].law = (struct rc_yield_law){.points = 2, .strain_at = falls, .stress_at = stress};
    bad[3].slabs = 0;
    bad[4].contact.pair.one.nu = 0.5;
    bad[5].contact.hardness = 1;
    bad[6].contact.pair = (struct rc_pair){.estar = 1};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        err.text[0] = '\0';
        assert_null(rc_yield_solver_new(&shape, h, &bad[k], &err));
        assert_true(strlen(err.text) > 10);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(returns),
        cmocka_unit_test(refused),
        cmocka_unit_test(convex_minimum),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
