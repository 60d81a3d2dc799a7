/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Maps of traction in several ways. A traction of mu times the pressure equals friction. A traction along y
 * equals one along x on the map with x and y exchanged. All loads together give the sum of their fields, and
 * each load costs only what it needs. Bare and coated bodies, free and periodic, are tested on maps and
 * sections with all engines. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

enum {
    SIX = (1 << RC_COMPONENTS) - 1,
    NX = 23,
    NY = 18,
    N = NX * NY
};
static const struct rc_shape shape = {NX, NY, 1.1e-6, 0.9e-6};
static const struct rc_layer coat[] = {{1.5e-6, 4e11, 0.2}, {2e-6, 1e11, 0.4}};

struct maps {
    double p[N], tx[N], ty[N];
};

static struct maps
maps_new(void)
{
    struct maps m;
    uint64_t seed = 35;

    for (size_t k = 0; k < N; k++) {
        bool in = fabs(node_x(shape, k)) < 9e-6 && fabs(node_y(shape, k) - 1e-6) < 6e-6;
        m.p[k] = in ? 1e9 * (0.5 + random_number(&seed)) : 0;
        m.tx[k] = in ? 4e8 * random_number(&seed) : 0;
        m.ty[k] = in ? 4e8 * random_number(&seed) : 0;
    }
    return m;
}

/* All combinations of the options. */
struct way {
    struct rc_boundary boundary;
    bool coated;
    char section;
    const char *engine;
    double tol; /* tolerance of the result, over the largest pressure */
};
static const struct way ways[] = {
    {{.x = false}, false, 0, NULL, 0},
    {{.x = false}, true, 0, NULL, 0},
    {{.x = true, .y = true}, false, 0, NULL, 0},
    {{.x = true, .y = true}, true, 0, NULL, 0},
    {{.x = false}, false, 'x', NULL, 0},
    {{.x = false}, false, 'y', NULL, 0},
    {{.x = false}, true, 'x', NULL, 0},
    {{.x = false}, true, 'y', NULL, 0},
    {{.x = true, .y = true}, false, 'x', NULL, 0},
    {{.x = true, .y = true}, false, 'y', NULL, 0},
    {{.x = true, .y = true}, true, 'x', NULL, 0},
    {{.x = true, .y = true}, true, 'y', NULL, 0},
    {{.x = false}, false, 0, "direct", 0},
    {{.x = false}, true, 0, "direct", 0},
    {{.x = false}, false, 0, "mlms", 1e-4},
    {{.x = false}, false, 0, NULL, 1e-3},
    {{.x = true, .y = true}, false, 0, NULL, 1e-3},
};
enum {
    WAYS = sizeof ways / sizeof *ways
};
static const double depths[] = {0, 0.9e-6, 2.6e-6, 8e-6};

static struct rc_stress_options
options_of(const struct way *w)
{
    struct rc_stress_options o = {.boundary = w->boundary,
                                  .body = {.e = 2e11, .nu = 0.3},
                                  .wanted = SIX,
                                  .section = w->section,
                                  .at = 0.77e-6,
                                  .engine = w->engine,
                                  .tol = w->tol,
                                  .threads = 2};

    if (w->coated) {
        o.body.layer = coat;
        o.body.layers = 2;
    }
    return o;
}

/* The permitted difference of two results. */
static double
apart_by(const struct way *w)
{
    return 1e9 * (w->tol > 0 ? 2 * w->tol : 1e-12);
}

static size_t
stresses(struct rc_shape s, const double *p, const struct rc_stress_options *o, double depth,
         double (*out)[N])
{
    double *to[RC_STRESSES] = {NULL};
    struct rc_err err = {""};
    struct rc_stress *stress = rc_stress_new(&s, p, o, &err);
    size_t n;

    if (stress == NULL)
        print_error("%s\n", err.text);
    assert_non_null(stress);
    for (int c = 0; c < RC_COMPONENTS; c++)
        to[c] = out[c];
    assert_int_equal(rc_stress_slice(stress, depth, to, &err), RC_OK);
    n = rc_stress_values(stress);
    rc_stress_free(stress);
    return n;
}

static double
largest_difference(size_t n, double (*a)[N], double (*b)[N])
{
    double worst = 0;

    for (int c = 0; c < RC_COMPONENTS; c++)
        for (size_t k = 0; k < n; k++)
            worst = larger(fabs(a[c][k] - b[c][k]), worst);
    return worst;
}

static void
friction_is_a_map(void **state)
{
    const double mu = 0.37;
    static double a[RC_COMPONENTS][N], b[RC_COMPONENTS][N];
    struct maps m = maps_new();
    double worst = 0;

    (void)state;
    for (size_t k = 0; k < N; k++)
        m.tx[k] = mu * m.p[k];
    for (size_t q = 0; q < WAYS; q++)
        for (size_t d = 0; d < 4; d++) {
            struct rc_stress_options o = options_of(&ways[q]);
            double off;
            size_t n;
            o.mu = mu;
            n = stresses(shape, m.p, &o, depths[d], a);
            o.mu = 0;
            o.traction[0] = m.tx;
            assert_int_equal(stresses(shape, m.p, &o, depths[d], b), n);
            off = largest_difference(n, a, b);
            if (ways[q].tol <= 0)
                worst = fmax(worst, off / 1e9);
            if (off > apart_by(&ways[q]))
                print_error("way %zu, depth %g m: %.2e Pa apart\n", q, depths[d], off);
            assert_true(off <= apart_by(&ways[q]));
        }
    print_message("mu p in a map: within %.1e of the largest pressure\n", worst);
}

/* Onto the map with x and y exchanged. */
static void
exchange(struct rc_shape s, const double *from, double *to)
{
    for (size_t j = 0; j < s.ny; j++)
        for (size_t i = 0; i < s.nx; i++)
            to[i * s.ny + j] = from[j * s.nx + i];
}

static void
along_y_is_along_x_exchanged(void **state)
{
    static const int other[] = {RC_SYY, RC_SXX, RC_SZZ, RC_SXY, RC_SYZ, RC_SXZ};
    static double a[RC_COMPONENTS][N], b[RC_COMPONENTS][N], is[RC_COMPONENTS][N], p[N], t[N];
    const struct rc_shape turned = {NY, NX, shape.dy, shape.dx};
    struct maps m = maps_new();
    double worst = 0;

    (void)state;
    exchange(shape, m.p, p);
    exchange(shape, m.ty, t);
    for (size_t q = 0; q < WAYS; q++)
        for (size_t d = 0; d < 4; d++) {
            struct rc_stress_options o = options_of(&ways[q]);
            double off;
            size_t n;
            o.traction[1] = m.ty;
            n = stresses(shape, m.p, &o, depths[d], a);
            o.traction[1] = NULL;
            o.traction[0] = t;
            o.section = o.section == 'x' ? 'y' : o.section == 'y' ? 'x' : 0;
            assert_int_equal(stresses(turned, p, &o, depths[d], b), n);
            for (int c = 0; c < RC_COMPONENTS; c++)
                if (o.section == 0)
                    exchange(turned, b[other[c]], is[c]);
                else
                    memcpy(is[c], b[other[c]], n * sizeof(double));
            off = largest_difference(n, a, is);
            if (ways[q].tol <= 0)
                worst = fmax(worst, off / 1e9);
            if (off > apart_by(&ways[q]))
                print_error("way %zu, depth %g m: %.2e Pa apart\n", q, depths[d], off);
            assert_true(off <= apart_by(&ways[q]));
        }
    print_message("along y: within %.1e of the largest pressure\n", worst);
}

static void
loads_add(void **state)
{
    static double all[RC_COMPONENTS][N], sum[RC_COMPONENTS][N], one[RC_COMPONENTS][N];
    static const double none[N];
    struct maps m = maps_new();

    (void)state;
    for (size_t q = 0; q < WAYS; q++)
        for (size_t d = 0; d < 4; d++) {
            struct rc_stress_options o = options_of(&ways[q]);
            size_t n = 0;
            memset(sum, 0, sizeof sum);
            for (int load = 0; load < 3; load++) {
                o.traction[0] = load == 1 ? m.tx : NULL;
                o.traction[1] = load == 2 ? m.ty : NULL;
                n = stresses(shape, load == 0 ? m.p : none, &o, depths[d], one);
                for (int c = 0; c < RC_COMPONENTS; c++)
                    for (size_t k = 0; k < n; k++)
                        sum[c][k] += one[c][k];
            }
            o.traction[0] = m.tx;
            o.traction[1] = m.ty;
            (void)stresses(shape, m.p, &o, depths[d], all);
            assert_true(largest_difference(n, all, sum) <= 2 * apart_by(&ways[q]));
        }
}

/* A component alone equals the same component computed with others: it does not depend on the stored
 * spectra. */
static void
alone_as_in_company(void **state)
{
    static double all[RC_COMPONENTS][N], one[RC_COMPONENTS][N];
    struct maps m = maps_new();

    (void)state;
    for (size_t q = 0; q < 4; q++) {
        struct rc_stress_options o = options_of(&ways[q]);
        o.traction[0] = m.tx;
        o.traction[1] = m.ty;
        (void)stresses(shape, m.p, &o, depths[2], all);
        for (int c = 0; c < RC_COMPONENTS; c++) {
            o.wanted = 1U << c;
            (void)stresses(shape, m.p, &o, depths[2], one);
            /* kernels in company share transforms */
            for (size_t k = 0; k < N; k++)
                assert_true(fabs(one[c][k] - all[c][k]) <= 1e9 * rounding);
        }
    }
}

/* ---- only the necessary transforms ---- */

static void
nothing_is_done_unasked(void **state)
{
    /* transforms of quarters of the padded map. Of the 6 kernels of each traction, szz is a kernel of the
     * pressure, and sxz along y is syz along x */
    static const struct {
        const char *what;
        int maps; /* bits: along x, along y */
        unsigned wanted;
        const char *engine;
        size_t sources, normal, shear, fields, sums;
    } row[] = {
        {"none", 0, SIX, NULL, 1, 6, 0, 6, 0},
        {"along x", 1, SIX, NULL, 2, 6, 5, 6, 0},
        {"along y", 2, SIX, NULL, 2, 6, 5, 6, 0},
        {"both", 3, SIX, NULL, 3, 6, 9, 6, 0},
        {"both, one component", 3, 1U << RC_SXX, NULL, 3, 1, 2, 1, 0},
        {"both, szz", 3, 1U << RC_SZZ, NULL, 3, 1, 2, 1, 0},
        {"none, direct", 0, SIX, "direct", 0, 6, 0, 0, 6},
        {"along x, direct", 1, SIX, "direct", 0, 6, 5, 0, 6 + 6},
        {"both, direct", 3, SIX, "direct", 0, 6, 9, 0, 6 + 6 + 6},
    };
    static double out[RC_COMPONENTS][N];
    struct maps m = maps_new();

    (void)state;
    for (size_t q = 0; q < sizeof row / sizeof *row; q++) {
        struct rc_stress_options o = options_of(&ways[0]);
        struct rc_stress_counts c;
        struct rc_stress *stress;
        double *to[RC_STRESSES] = {NULL};
        o.wanted = row[q].wanted;
        o.engine = row[q].engine;
        o.traction[0] = row[q].maps & 1 ? m.tx : NULL;
        o.traction[1] = row[q].maps & 2 ? m.ty : NULL;
        stress = rc_stress_new(&shape, m.p, &o, NULL);
        assert_non_null(stress);
        for (int k = 0; k < RC_COMPONENTS; k++)
            to[k] = out[k];
        assert_int_equal(rc_stress_slice(stress, depths[1], to, NULL), RC_OK);
        c = *rc_stress_counted(stress);
        print_message("%s: %zu sources, %zu + %zu kernels, %zu transforms of them, %zu fields\n",
                      row[q].what, c.source_transforms, c.normal_kernels, c.shear_kernels,
                      c.kernel_transforms, c.field_transforms);
        assert_int_equal(c.source_transforms, row[q].sources);
        assert_int_equal(c.normal_kernels, row[q].normal);
        assert_int_equal(c.shear_kernels, row[q].shear);
        assert_int_equal(c.field_transforms, row[q].fields);
        assert_int_equal(c.engine_sums, row[q].sums);
        rc_stress_free(stress);
    }
}

static void
friction_beside_a_map_is_refused(void **state)
{
    struct rc_stress_options o = options_of(&ways[0]);
    struct maps m = maps_new();
    struct rc_err err;

    (void)state;
    o.mu = 0.2;
    for (int k = 0; k < 2; k++) {
        o.traction[k] = m.tx;
        o.traction[1 - k] = NULL;
        assert_int_equal(rc_stress_check(&shape, &o, &err), RC_FAIL);
        assert_non_null(strstr(err.text, "map of traction"));
        assert_null(rc_stress_new(&shape, m.p, &o, &err));
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(friction_is_a_map),
        cmocka_unit_test(along_y_is_along_x_exchanged),
        cmocka_unit_test(loads_add),
        cmocka_unit_test(alone_as_in_company),
        cmocka_unit_test(nothing_is_done_unasked),
        cmocka_unit_test(friction_beside_a_map_is_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
