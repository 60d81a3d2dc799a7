/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stress of plastic strain in slices. Its mean over a slab equals that of the sweeps through the volume,
 * also over a thin slab cut out of another. It adds to the stress of the pressure, and a section is a row of
 * a map. All depths together cost one sweep. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <gsl/gsl_integration.h>

#include "tests/volume/volume_case.h"

enum {
    NX = 18,
    NY = 15,
    NODES = NX * NY,
    SLABS = 9
};
static const struct rc_shape shape = {NX, NY, 1.1e-6, 1e-6};
static const double thickness[SLABS] = {0.5e-6, 0.7e-6, 0.4e-6, 1e-6,  1.3e-6,
                                        0.3e-6, 2e-6,   0.9e-6, 1.1e-6};
static const double e = 2e11, nu = 0.28;

struct strained {
    struct voxels e;
    const double *map[SLABS * STRAINS];
    struct rc_eigenstrain strain;
    double p[NODES];
};

static void
make(struct strained *s)
{
    uint64_t seed = 11;

    s->e = voxels_new(shape, SLABS);
    voxels_random(&s->e, 0x17b, &seed); /* two of the slabs have no strain */
    for (size_t k = 0; k < SLABS; k++)
        for (size_t c = 0; c < STRAINS; c++)
            s->map[k * STRAINS + c] = k == 2 || k == 7 ? NULL : voxels_map(&s->e, k, strains[c]);
    s->strain = (struct rc_eigenstrain){.slabs = SLABS, .thickness = thickness, .map = s->map};
    for (size_t k = 0; k < NODES; k++)
        s->p[k] = 1e9 * (random_number(&seed) + 0.5);
}

static struct rc_stress_options
options_of(const struct strained *s, bool strain, unsigned wanted)
{
    return (struct rc_stress_options){.boundary = RC_PERIODIC,
                                      .body = {.e = e, .nu = nu},
                                      .wanted = wanted,
                                      .threads = 2,
                                      .strain = strain ? &s->strain : NULL};
}

/* All six components and Mises' stress at a depth. */
static void
slice(const struct strained *s, const double *p, bool strain, double depth, double (*to)[NODES])
{
    const struct rc_stress_options o = options_of(s, strain, (2U << RC_MISES) - 1);
    double *const at[RC_STRESSES] = {to[0], to[1], to[2], to[3], to[4], to[5], to[6]};
    struct rc_stress *stress;
    struct rc_err err;

    stress = rc_stress_new(&shape, p, &o, &err);
    assert_non_null(stress);
    assert_int_equal(rc_stress_slice(stress, depth, at, &err), RC_OK);
    rc_stress_free(stress);
}

/* ---- against the volume ---- */

/* Adds the mean of slices over an interval of depths, by Gauss's rule of n points. */
static void
add_mean(struct rc_stress *stress, size_t n, double from, double to, struct voxels *sum,
         size_t slab)
{
    gsl_integration_glfixed_table *rule = gsl_integration_glfixed_table_alloc(n);
    static double map[RC_COMPONENTS][NODES];
    double *const at[RC_STRESSES] = {map[0], map[1], map[2], map[3], map[4], map[5]};

    assert_non_null(rule);
    for (size_t g = 0; g < n; g++) {
        double depth, weight;
        gsl_integration_glfixed_point(from, to, g, &depth, &weight, rule);
        assert_int_equal(rc_stress_slice(stress, depth, at, NULL), RC_OK);
        for (int c = 0; c < RC_COMPONENTS; c++)
            for (size_t i = 0; i < NODES; i++)
                voxels_map(sum, slab, (enum rc_component)c)[i] += weight / (to - from) * at[c][i];
    }
    gsl_integration_glfixed_table_free(rule);
}

static void
slices_average_to_slabs(void **state)
{
    static struct strained s;
    static double zero[NODES];

    (void)state;
    make(&s);
    for (int q = 0; q < 4; q++) {
        const struct rc_boundary boundary = rc_boundary_of(q & 1, q & 2);
        struct rc_stress_options o = options_of(&s, true, (1U << RC_COMPONENTS) - 1);
        struct rc_slabs *v =
            volume_new(shape, (struct rc_slabs_options){.slabs = SLABS,
                                                        .thickness = thickness,
                                                        .shear = e / (2 * (1 + nu)),
                                                        .nu = nu,
                                                        .boundary = boundary,
                                                        .whole = true});
        struct voxels sum = voxels_new(shape, SLABS), known = voxels_new(shape, SLABS);
        struct rc_stress *stress;
        double top = 0;
        o.boundary = boundary;
        stress = rc_stress_new(&shape, zero, &o, NULL);
        assert_non_null(stress);
        volume_apply(v, &s.e, NULL, NULL, NULL, &known);
        for (size_t k = 0; k < SLABS; k++) {
            add_mean(stress, 16, top, top + thickness[k], &sum, k);
            top += thickness[k];
        }
        print_message("slices average to slabs within %.1e, %s\n", voxels_apart(&sum, &known),
                      rc_boundary_word(boundary));
        assert_true(voxels_apart(&sum, &known) < 1e-12);
        rc_stress_free(stress);
        rc_slabs_free(v);
        free(sum.v);
        free(known.v);
    }
    free(s.e.v);
}

/* The mean over a thin slab about a depth, from *first to *last, in a separate stack. One slab is divided in
 * three, or two slabs are added below. */
static void
piece(const struct strained *s, bool padded, double depth, struct voxels *to, double *first,
      double *last)
{
    const double t = 1e-2 * fmin(shape.dx, shape.dy);
    double thick[SLABS + 2], top = 0;
    size_t from[SLABS + 2], n = 0, which = SLABS;
    struct rc_slabs_options o = {.thickness = thick,
                                 .shear = e / (2 * (1 + nu)),
                                 .nu = nu,
                                 .boundary = padded ? RC_FREE : RC_PERIODIC,
                                 .whole = true};
    struct voxels pieces, all;
    struct rc_slabs *v;

    for (size_t k = 0; k < SLABS; k++, top += thickness[k - 1]) {
        double own = fmin(t, thickness[k] / 2), above = depth - top - own / 2;
        double parts[3] = {fmin(fmax(above, 0), thickness[k] - own), own};
        parts[2] = thickness[k] - own - parts[0];
        if (depth < top || depth >= top + thickness[k]) {
            from[n] = k;
            thick[n++] = thickness[k];
            continue;
        }
        *first = top + parts[0];
        *last = *first + own;
        for (size_t q = 0; q < 3; q++) {
            if (!(parts[q] > 0))
                continue;
            which = q == 1 ? n : which;
            from[n] = k;
            thick[n++] = parts[q];
        }
    }
    for (size_t q = 0; depth >= top && q < 2; q++) {
        which = n;
        from[n] = SLABS;
        thick[n++] = q == 0 ? depth - top - t / 2 : t;
        *first = depth - t / 2;
        *last = depth + t / 2;
    }
    o.slabs = n;
    pieces = voxels_new(shape, n);
    all = voxels_new(shape, n);
    for (size_t k = 0; k < n; k++)
        for (int c = 0; c < RC_COMPONENTS && from[k] < SLABS; c++)
            memcpy(voxels_map(&pieces, k, (enum rc_component)c),
                   voxels_map(&s->e, from[k], (enum rc_component)c), NODES * sizeof(double));
    v = volume_new(shape, o);
    volume_apply(v, &pieces, NULL, NULL, NULL, &all);
    memcpy(to->v, voxels_map(&all, which, RC_SXX), RC_COMPONENTS * NODES * sizeof(double));
    rc_slabs_free(v);
    free(pieces.v);
    free(all.v);
}

/* Depths in any order, and several with the same plan. They are faces between slabs, in the first and the
 * last slab, and below. */
static void
slices_are_pieces(void **state)
{
    static const double depths[] = {1.1e-6, 0,      8.6e-6,  0.25e-6, 0.5e-6, 4.05e-6, 3.9e-6,
                                    1.6e-6, 9.1e-6, 4.21e-6, 7e-6,    20e-6,  2.2e-6};
    static struct strained s;
    double zero[NODES] = {0};

    (void)state;
    make(&s);
    for (int padded = 0; padded < 2; padded++) {
        struct rc_stress_options o = options_of(&s, true, (1U << RC_COMPONENTS) - 1);
        struct voxels is = voxels_new(shape, 1);
        double worst = 0;
        struct rc_stress *stress;
        struct rc_err err;
        o.boundary = padded ? RC_FREE : RC_PERIODIC;
        stress = rc_stress_new(&shape, zero, &o, &err);
        assert_non_null(stress);
        for (size_t q = 0; q < sizeof depths / sizeof *depths; q++) {
            struct voxels mean = voxels_new(shape, 1);
            double first = 0, last = 0;
            piece(&s, padded, depths[q], &is, &first, &last);
            add_mean(stress, 3, first, last, &mean, 0);
            worst = fmax(worst, voxels_apart(&mean, &is));
            free(mean.v);
        }
        print_message("slices are pieces of a stack within %.1e, %s\n", worst,
                      padded ? "free" : "periodic");
        assert_true(worst < 1e-12);
        rc_stress_free(stress);
        free(is.v);
    }
    free(s.e.v);
}

/* ---- cost ---- */

static void
costs_one_sweep(void **state)
{
    static struct strained s;
    static double map[RC_STRESSES][NODES];
    double *const to[RC_STRESSES] = {map[0], map[1], map[2], map[3], map[4], map[5], map[6]};
    double zero[NODES] = {0};

    (void)state;
    make(&s);
    for (int q = 0; q < 4; q++) { /* the requests are one component, five, six for derived stresses,
                                     no strain */
        static const unsigned wanted[] = {1U << RC_SXZ, 0x2f, 1U << RC_MISES, 1U << RC_MISES};
        static const size_t components[] = {1, 5, 6, 0};
        struct rc_stress_options o = options_of(&s, q < 3, wanted[q]);
        const struct rc_stress_counts *counts;
        struct rc_stress *stress;
        struct rc_err err;
        stress = rc_stress_new(&shape, zero, &o, &err);
        assert_non_null(stress);
        counts = rc_stress_counted(stress);
        for (size_t k = 0; k < 7; k++) {
            assert_int_equal(counts->strain_transforms, q < 3 ? STRAINS * (SLABS - 2) : 0);
            assert_int_equal(counts->strain_field_transforms, k * components[q]);
            assert_int_equal(rc_stress_slice(stress, 1.3e-6 * (double)k, to, &err), RC_OK);
        }
        rc_stress_free(stress);
    }
    free(s.e.v);
}

/* ---- sums, sections ---- */

static void
adds_to_the_pressure(void **state)
{
    static struct strained s;
    static double both[RC_COMPONENTS + 1][NODES], alone[RC_COMPONENTS + 1][NODES];
    static double pressed[RC_COMPONENTS + 1][NODES];
    double zero[NODES] = {0};

    (void)state;
    make(&s);
    for (int q = 0; q < 3; q++) { /* depths at the surface, in a slab, below all */
        double depth = q == 0 ? 0 : q == 1 ? 1.3e-6 : 11e-6, most = 0;
        slice(&s, s.p, true, depth, both);
        slice(&s, zero, true, depth, alone);
        slice(&s, s.p, false, depth, pressed);
        for (int c = 0; c < RC_COMPONENTS; c++)
            for (size_t i = 0; i < NODES; i++)
                most = fmax(most, fabs(both[c][i] - alone[c][i] - pressed[c][i]));
        assert_true(most < 1e-3); /* Pa, of GPa */
        for (size_t i = 0; i < NODES; i++) {
            double xx = both[0][i], yy = both[1][i], zz = both[2][i], shear = 0;
            for (int c = RC_SXY; c <= RC_SYZ; c++)
                shear += both[c][i] * both[c][i];
            assert_true(
                fabs(sqrt(((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx)) /
                              2 +
                          3 * shear) -
                     both[RC_MISES][i]) < 1);
            if (q == 0) /* the surface carries only the pressure */
                assert_true(fabs(alone[RC_SZZ][i]) < 1e-12 * 1e-3 * e);
        }
    }
    free(s.e.v);
}

static void
sections(void **state)
{
    static struct strained s;
    static double map[RC_COMPONENTS + 1][NODES];
    double line[NX + NY], zero[NODES] = {0};
    struct rc_stress *stress;
    struct rc_err err;

    (void)state;
    make(&s);
    slice(&s, zero, true, 1.4e-6, map);
    for (int q = 0; q < 3; q++) { /* sections along a row, a column, between two columns */
        struct rc_stress_options o = options_of(&s, true, 1U << RC_SXX);
        double *const to[RC_STRESSES] = {line};
        o.section = q == 0 ? 'y' : 'x';
        o.at = q == 0 ? 3 * shape.dy : q == 1 ? 1.5 * shape.dx : 2 * shape.dx;
        stress = rc_stress_new(&shape, zero, &o, &err);
        assert_non_null(stress);
        assert_int_equal(rc_stress_slice(stress, 1.4e-6, to, &err), RC_OK);
        for (size_t i = 0; i < (q == 0 ? NX : NY); i++) {
            const double *row = map[RC_SXX] + i * NX;
            double is = q == 0   ? map[RC_SXX][(NY / 2 + 3) * NX + i]
                        : q == 1 ? row[NX / 2 + 1]
                                 : (row[NX / 2 + 1] + row[NX / 2 + 2]) / 2;
            assert_true(fabs(line[i] - is) < 1e-3);
        }
        rc_stress_free(stress);
    }
    free(s.e.v);
}

static void
refused(void **state)
{
    static struct strained s;
    struct rc_stress_options o;
    struct rc_err err;

    (void)state;
    make(&s);
    for (int q = 0; q < 3; q++) {
        o = options_of(&s, true, 1);
        if (q == 0)
            o.body.e = INFINITY;
        else if (q == 1)
            o.body.e = 0;
        else
            s.strain.slabs = 0;
        assert_int_equal(rc_stress_check(&shape, &o, &err), RC_FAIL);
        assert_non_null(strstr(err.text, "plastic strain"));
    }
    free(s.e.v);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slices_average_to_slabs),
        cmocka_unit_test(slices_are_pieces),
        cmocka_unit_test(costs_one_sweep),
        cmocka_unit_test(adds_to_the_pressure),
        cmocka_unit_test(sections),
        cmocka_unit_test(refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
