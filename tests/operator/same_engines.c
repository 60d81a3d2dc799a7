/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every engine agrees with the double sum for every kernel, size and spacing. On periodic maps it agrees, if
 * it supports them, with the sum over all waves. Bodies and engines are those of the lists. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "tests/contact_case.h"
#include "libcontact/operator/operator.h"
#include "tests/body_case.h"

static const struct rc_engine *const engines[] = {
#define RC_ENGINE(name) &rc_engine_##name,
#include RC_ENGINES_LIST
#undef RC_ENGINE
};

static const struct rc_body_type *const types[] = {
#define RC_BODY(name) &rc_body_##name,
#include RC_BODIES_LIST
#undef RC_BODY
};

enum {
    ENGINES = sizeof engines / sizeof *engines,
    TYPES = sizeof types / sizeof *types
};

/* Bodies, one for each row of the list: uniform, under three layers of the thickness of a few cells, and a
 * layer on a rigid base. */
enum {
    BARE,
    LAYERED,
    ON_RIGID,
    BODIES
};
static struct rc_layer layers[3];

static struct rc_body
body_of(int which, double spacing)
{
    layers[0] = (struct rc_layer){1.3 * spacing, 9e9, 0.3};
    layers[1] = (struct rc_layer){0.4 * spacing, 1e9, 0.45};
    layers[2] = (struct rc_layer){5 * spacing, 7e9, 0.2};
    return which == BARE      ? (struct rc_body){.e = 2.2e9, .nu = 0.28}
           : which == LAYERED ? (struct rc_body){2e9, 0.28, 3, layers}
                              : (struct rc_body){INFINITY, 0.3, 1, layers + 2};
}

/* The displacement, then the twelve stresses; the kernels of stress in a layered body are slow, and
 * tests/layers/same_layers_stress.c compares them. */
static size_t
kernels_of(int which)
{
    return which == BARE ? 1 + RC_STRESS_KERNELS : 1;
}

static void
kernel_case(struct body_case *c, int which, size_t kernel, struct rc_shape shape,
            struct rc_boundary boundary)
{
    struct rc_body body = body_of(which, shape.dx);

    if (kernel == 0)
        surface_case(c, (struct rc_pair){.one = body, .two = {.e = 1e11}});
    else
        stress_case(c, body, 0.7 * shape.dx, boundary, (int)kernel - 1);
}

/* ---- reference sums, independent of the engines ---- */

/* The quarter of the kernel from which its parity gives the rest: nx ny values. */
static double *
quarter(const struct rc_sum *s)
{
    const struct rc_lattice nodes = {s->shape.dx, s->shape.dy, 1, 1};
    double *k = malloc(s->shape.nx * s->shape.ny * sizeof *k);

    s->kernel.rows(s->kernel.of, &nodes, s->shape.nx, 0, s->shape.ny, k);
    return k;
}

/* u = K p as a double sum, and the largest sum of |K| |p|, the reference of errors. */
static double
double_sum(const struct rc_sum *s, const double *p, double *u)
{
    size_t nx = s->shape.nx, n = nx * s->shape.ny;
    unsigned parity = s->kernel.parity;
    double *k = quarter(s), most = 0;

    for (size_t t = 0; t < n; t++) {
        long double sum = 0, all = 0;
        for (size_t from = 0; from < n; from++) {
            long di = (long)(t % nx) - (long)(from % nx), dj = (long)(t / nx) - (long)(from / nx);
            double term = k[(size_t)labs(dj) * nx + (size_t)labs(di)] * p[from];
            sum += (parity & RC_ODD_X && di < 0) != (parity & RC_ODD_Y && dj < 0) ? -term : term;
            all += fabs(term);
        }
        u[t] = (double)sum;
        most = fmax(most, (double)all);
    }
    free(k);
    return most;
}

/* The same on a periodic map, from the kernel's symbol, for p of mean 0 and odd sizes. K' is (-i)^d symbol
 * with d odd directions. The sum over q of it and p' e^(iqr) is real. */
static double
wave_sum(const struct rc_sum *s, const double *p, double *u)
{
    struct rc_shape m = s->shape;
    long nx = (long)m.nx, ny = (long)m.ny;
    unsigned parity = s->kernel.parity;
    size_t n = m.nx * m.ny;
    double most = 0;

    for (size_t t = 0; t < n; t++) {
        long double sum = 0, all = 0;
        for (long b = -ny / 2; b <= ny / 2; b++)
            for (long a = -nx / 2; a <= nx / 2; a++) {
                double qx = 2 * exact_pi * (double)a / (m.dx * (double)nx);
                double qy = 2 * exact_pi * (double)b / (m.dy * (double)ny);
                double k =
                    a == 0 && b == 0 ? 0 : s->kernel.symbol(s->kernel.of, qx, qy) / (double)n;
                for (size_t from = 0; from < n; from++) {
                    double angle = qx * (node_x(m, t) - node_x(m, from)) +
                                   qy * (node_y(m, t) - node_y(m, from));
                    sum += k * p[from] *
                           (parity == 0                     ? cos(angle)
                            : parity == RC_ODD_X + RC_ODD_Y ? -cos(angle)
                                                            : sin(angle));
                }
                all += fabs(k);
            }
        u[t] = (double)sum;
        most = fmax(most, (double)all);
    }
    return most;
}

/* ---- the comparison ---- */

/* The permitted difference between an engine and the double sum, over the sum of |K| |p|. It is the requested
 * error, else rounding, and twice this for an engine that interpolates. */
static double
allowed(const struct rc_engine *engine, double tol, bool precise)
{
    return tol > 0 && !precise ? tol : engine == &rc_engine_mlms ? 2 * of_sum : of_sum;
}

/* Largest difference between u and the result of `engine` for p. */
static double
off(const struct rc_sum *sum, const struct rc_engine *engine, const double *p, const double *u)
{
    size_t n = sum->shape.nx * sum->shape.ny;
    double *v = malloc(n * sizeof *v), worst = 0;
    struct rc_err err;
    void *plan = engine->new (sum, &err);

    assert_non_null(plan);
    assert_true(sum->tol == 0 || engine->error(plan) <= sum->tol);
    engine->apply(plan, p, v);
    for (size_t k = 0; k < n; k++)
        worst = larger(worst, fabs(u[k] - v[k]));
    engine->free(plan);
    free(v);
    return worst;
}

/* Failures of all engines on one map. */
static size_t
compare(struct rc_shape shape, struct rc_boundary boundary, int body, size_t kernel, size_t threads)
{
    static const double tols[] = {0, 1e-3, 1e-3};
    static const bool precise[] = {false, false, true};
    struct rc_sum sum = {.shape = shape, .boundary = boundary, .threads = threads};
    struct body_case c;
    size_t n = shape.nx * shape.ny, failed = 0;
    double *p = malloc(n * sizeof *p), *u = malloc(n * sizeof *u), mean = 0, size;
    uint64_t seed = 1999;

    kernel_case(&c, body, kernel, shape, boundary);
    sum.kernel = c.kernel;
    for (size_t k = 0; k < n; k++)
        mean += (p[k] = random_number(&seed)) / (double)n;
    for (size_t k = 0; k < n && !rc_has_mean(boundary); k++)
        p[k] -= mean;
    size = !rc_has_mean(boundary) ? wave_sum(&sum, p, u) : double_sum(&sum, p, u);
    /* tables made in different blocks differ by rounding: for stresses 1e-16 of the pressure */
    if (kernel > 0)
        size += 0.01 * sqrt((double)n);
    for (size_t e = 0; e < ENGINES; e++)
        for (size_t k = 0; k < 3; k++) {
            double by, within = allowed(engines[e], tols[k], precise[k]);
            if ((!rc_has_mean(boundary) && !engines[e]->info.periodic) ||
                (precise[k] && engines[e]->precise.name == NULL))
                continue;
            sum.tol = tols[k];
            sum.precise = precise[k];
            by = off(&sum, engines[e], p, u) / size;
            if (!(by <= within)) {
                print_error(
                    "%s %zu x %zu, body %d, kernel %zu by %s, tol %g%s: off by %g, not %g\n",
                    rc_boundary_word(boundary), shape.nx, shape.ny, body, kernel,
                    engines[e]->info.name, tols[k], precise[k] ? ", precise" : "", by, within);
                failed++;
            }
        }
    body_case_free(&c);
    free(p);
    free(u);
    return failed;
}

/* Each row of the list is selected for exactly one of the bodies above. */
static void
every_body(void **state)
{
    bool seen[TYPES] = {false};

    (void)state;
    for (int which = 0; which < BODIES; which++) {
        struct rc_body body = body_of(which, 1e-6);
        for (size_t k = 0; k < TYPES; k++)
            seen[k] |= rc_body_type(&body) == types[k];
    }
    for (size_t k = 0; k < TYPES; k++)
        assert_true(seen[k]);
}

static void
every_size_and_kernel(void **state)
{
    static const struct rc_shape shapes[] = {
        {33, 47, 1.1e-6, 1e-6}, {1, 17, 1, 1},  {17, 1, 1, 1},     {1, 1, 3, 2},     {2, 3, 1, 1},
        {3, 211, 1, 5},         {64, 64, 1, 1}, {97, 31, 1, 0.01}, {50, 20, 1, 100},
    };
    size_t failed = 0;

    (void)state;
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++)
        for (int body = 0; body < BODIES; body++)
            for (size_t k = 0; k < kernels_of(body); k++)
                failed += compare(shapes[s], RC_FREE, body, k, 1 + s % 3);
    assert_int_equal(failed, 0);
}

static void
every_wave(void **state)
{
    static const struct rc_shape shapes[] = {
        {7, 5, 1, 1.3}, {13, 1, 1e-6, 1e-6}, {1, 11, 1, 2}, {9, 15, 1.7e-6, 1e-6}};
    size_t failed = 0;

    (void)state;
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++)
        for (int body = 0; body < BODIES; body++)
            for (size_t k = 0; k < kernels_of(body); k++)
                failed += compare(shapes[s], RC_PERIODIC, body, k, 2);
    assert_int_equal(failed, 0);
}

/* Two fields that share their kernels and sources equal separate applications, for all pairs of parities. */
static void
fields_share_transforms(void **state)
{
    struct rc_shape shape = {37, 22, 1, 1.3};
    const struct rc_lattice nodes = {1, 1.3, 1, 1};
    size_t n = shape.nx * shape.ny, cx, cy;
    double *map[6], *quarter[RC_STRESS_KERNELS];
    struct rc_err err;
    struct rc_fft *fft = rc_fft_new(NULL, NULL, &shape, RC_FREE, RC_DOUBLE, 2, &err);
    struct rc_spectrum *spectrum[RC_STRESS_KERNELS];
    unsigned odd = 0;

    (void)state;
    for (int k = 0; k < 6; k++)
        map[k] = calloc(n, sizeof **map);
    for (int source = 0; source < 2; source++) {
        map[source][(size_t)(5 + source) * 37 + 9] = 3;
        map[source][20 * 37 + 30] = -1;
        assert_int_equal(rc_fft_load(fft, (size_t)source, map[source], &err), RC_OK);
    }
    rc_fft_quarter(fft, &cx, &cy);
    for (int k = 0; k < RC_STRESS_KERNELS; k++) {
        struct body_case c;
        stress_case(&c, (struct rc_body){.nu = 0.3}, 1.1, RC_FREE, k);
        spectrum[k] = rc_spectrum_new(fft, &err);
        assert_int_equal(rc_spectrum_set(spectrum[k], fft, &c.kernel, &err), RC_OK);
        quarter[k] = malloc(rc_fft_quarter_size(fft) * sizeof **quarter);
        c.kernel.rows(c.kernel.of, &nodes, cx, 0, cy, quarter[k]);
        odd |= c.kernel.parity & RC_ODD_X ? 1u << k : 0;
        body_case_free(&c);
    }
    for (size_t j = 0; j < cy; j++) {
        double *row[RC_STRESS_KERNELS];
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            row[k] = quarter[k] + j * cx;
        rc_fft_quarter_line(fft, RC_STRESS_KERNELS, odd, row);
    }
    for (int a = 0; a < RC_STRESS_KERNELS; a++)
        for (int b = 0; b < RC_STRESS_KERNELS; b++) {
            const struct rc_fft_kernel kernel[] = {{rc_stress_parity[a], quarter[a], NULL, NULL},
                                                   {rc_stress_parity[b], quarter[b], NULL, NULL}};
            const struct rc_fft_sum sum[] = {{map[2], 1, {{0, 1, 1}}},
                                             {map[3], 2, {{1, 0, 1}, {0, 1, -0.7}}}};
            assert_int_equal(rc_fft_fields(fft, cx, 2, kernel, 2, sum, &err), RC_OK);
            rc_fft_apply(fft, spectrum[a], map[1], map[4]);
            rc_fft_apply(fft, spectrum[b], map[0], map[5]);
            for (size_t i = 0; i < n; i++) {
                assert_true(fabs(map[2][i] - map[4][i]) <= rounding);
                assert_true(fabs(map[3][i] - (map[5][i] - 0.7 * map[4][i])) <= rounding);
            }
        }
    for (int k = 0; k < RC_STRESS_KERNELS; k++) {
        rc_spectrum_free(spectrum[k]);
        free(quarter[k]);
    }
    rc_fft_free(fft);
    for (int k = 0; k < 6; k++)
        free(map[k]);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_body),
        cmocka_unit_test(every_size_and_kernel),
        cmocka_unit_test(every_wave),
        cmocka_unit_test(fields_share_transforms),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
