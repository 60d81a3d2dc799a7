/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contacts with a hardness, from a load at which nearly all nodes yield to a hardness that is just not
 * reached. Waves that approach full contact are solved too. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hard_case.h"

static double
sphere(struct rc_shape s, size_t k, double a, uint64_t *seed)
{
    double x = node_x(s, k) / (s.dx * (double)s.nx), y = node_y(s, k) / (s.dy * (double)s.ny);

    return -(x * x + y * y) + a * random_number(seed);
}

/* Smooth and rough surfaces consist of a few waves with different phases. */
static double
waves(struct rc_shape s, size_t k, double a, uint64_t *seed)
{
    double x = 2 * exact_pi * node_x(s, k) / (s.dx * (double)s.nx), sum = 0;
    double y = 2 * exact_pi * node_y(s, k) / (s.dy * (double)s.ny);
    uint64_t own = 17;

    (void)seed;
    for (int i = 1; i <= (int)a; i++)
        for (int j = -(int)a; j <= (int)a; j++)
            sum += cos(i * x + j * y + 6.2831853 * random_number(&own)) / (i * i + j * j);
    return sum;
}

/* ---- hardness ---- */

/* Every node carries at most H, which gives the smallest number of touching nodes; the plastic nodes carry at
 * most the load. */
static double
counts(const struct hard_case *c, const struct rc_problem *problem, const double *h,
       const struct solved *s)
{
    double nodes = (double)(c->shape.nx * c->shape.ny);
    bool right = (double)s->c.contact_nodes * c->hardness >= nodes * (1 - summed) &&
                 (double)s->c.plastic_nodes * c->hardness <= nodes * (1 + summed) &&
                 (s->c.plastic_nodes == 0 || s->c.max_pressure == problem->hardness);

    (void)h;
    return right ? 0 : INFINITY;
}

static const double hardnesses[] = {1.0000001, 1.00001, 1.001, 1.05, 1.6, 3, 10};

static const struct hard_case yielding[] = {
    {"sphere", {48, 41, 1e-6, 1.1e-6}, BOTH, sphere, 0, 1e-6, 1e-2, 0, 0, counts, 0},
    {"rough sphere", {48, 41, 1e-6, 1.1e-6}, BOTH, sphere, 0.1, 1e-6, 1e-2, 0, 0, counts, 0},
    {"waves", {48, 41, 1e-6, 1.1e-6}, BOTH, waves, 5, 1e-6, 1e-2, 0, 0, counts, 0},
    {"noise", {48, 41, 1e-6, 1.1e-6}, BOTH, hard_noise, 0, 1e-6, 1e-2, 0, 0, counts, 0},
    {"noise, light", {48, 41, 1e-6, 1.1e-6}, BOTH, hard_noise, 0, 1e-6, 1e-5, 0, 0, counts, 0},
    {"noise, heavy", {48, 41, 1e-6, 1.1e-6}, BOTH, hard_noise, 0, 1e-6, 1, 0, 0, counts, 0},
    {"waves, larger", {160, 140, 1e-6, 1.1e-6}, BOTH, waves, 9, 1e-6, 1e-2, 0, 0, counts, 0},
};

static void
from_the_mean_pressure_up(void **state)
{
    size_t failed = 0;

    (void)state;
    for (size_t k = 0; k < sizeof yielding / sizeof *yielding; k++)
        for (size_t j = 0; j < sizeof hardnesses / sizeof *hardnesses; j++) {
            struct hard_case c = yielding[k];
            char name[64];
            snprintf(name, sizeof name, "%s, H %.9g", c.name, hardnesses[j]);
            c.name = name;
            c.hardness = hardnesses[j];
            failed += hard_failures(&c);
        }
    assert_int_equal(failed, 0);
}

/* A hardness at and near the largest elastic pressure: above this pressure it has no effect and no cost. */
static void
about_the_elastic_maximum(void **state)
{
    static const double factors[] = {1.000001, 1 + 1e-9, 1 - 1e-9, 0.999999, 0.99};
    size_t failed = 0;

    (void)state;
    for (size_t k = 0; k < sizeof yielding / sizeof *yielding; k++)
        for (int b = 0; b < 2; b++) {
            struct hard_case c = yielding[k];
            struct rc_boundary boundary = b == 0 ? RC_FREE : RC_PERIODIC;
            double *h = hard_heights(&c);
            struct rc_problem problem = hard_problem(&c, boundary);
            struct solved elastic = solve(c.shape, h, problem);
            size_t n = c.shape.nx * c.shape.ny;
            double mean = problem.load / (c.shape.dx * c.shape.dy * (double)n);
            for (size_t j = 0; j < sizeof factors / sizeof *factors; j++) {
                char name[64];
                snprintf(name, sizeof name, "%s, %.9g of maximum", yielding[k].name, factors[j]);
                c.name = name;
                c.hardness = factors[j] * elastic.c.max_pressure / mean;
                failed += !hard_holds(&c, boundary);
                if (factors[j] > 1) {
                    struct solved s;
                    double apart = 0;
                    problem.hardness = c.hardness * mean;
                    s = solve(c.shape, h, problem);
                    for (size_t i = 0; i < n; i++)
                        apart += fabs(s.p[i] - elastic.p[i]);
                    assert_int_equal(s.status, RC_OK);
                    /* each pressure is within its tolerance */
                    assert_true(apart <= 2 * hard_tol * mean * (double)n);
                    assert_int_equal(s.c.plastic_nodes, 0);
                    solved_free(&s);
                }
            }
            solved_free(&elastic);
            free(h);
        }
    assert_int_equal(failed, 0);
}

/* ---- full contact ---- */

static double
cosine(struct rc_shape s, size_t k, double a, uint64_t *seed)
{
    (void)a, (void)seed;
    return cos(2 * exact_pi * node_x(s, k) / (s.dx * (double)s.nx));
}

static double
crossed(struct rc_shape s, size_t k, double a, uint64_t *seed)
{
    return cosine(s, k, a, seed) * cos(2 * exact_pi * node_y(s, k) / (s.dy * (double)s.ny));
}

/* Compares with Westergaard: the contact fraction to a node at each edge, the largest pressure, and the mean
 * error of the pressure. The resolution of the grid is the width of a node over that of the contact or of the
 * gap, whichever is smaller. */
static double
westergaard(const struct hard_case *c, const struct rc_problem *problem, const double *h,
            const struct solved *s)
{
    double n = (double)c->shape.nx, length = c->shape.dx * n, mean = c->mean * problem->pair.estar;
    double full = wave_full(c->unit, length, problem->pair.estar), above = 0, off;
    double fraction = wave_fraction(mean, full);

    (void)h;
    for (size_t i = 0; i < c->shape.nx; i++)
        above += fabs(s->p[i] - wave_pressure(mean, full, length, node_x(c->shape, i)));
    off = fabs(s->c.contact_fraction - fraction) * n / 2;
    off = larger(off, fabs(s->c.max_pressure / (2 * sqrt(mean * full)) - 1) * n * fraction / 2);
    return larger(off, above / (n * mean) * n * fraction / 2);
}

static void
a_wave_from_a_thousandth_on(void **state)
{
    static const double fractions[] = {0.001, 0.003, 0.01, 0.03, 0.035, 0.1,
                                       0.3,   0.5,   0.9,  0.99, 0.999, 0.9999};
    size_t failed = 0;

    (void)state;
    for (size_t k = 0; k < sizeof fractions / sizeof *fractions; k++) {
        struct hard_case c = {
            "", {16384, 1, 1e-6, 1e-6}, PERIODIC, cosine, 0, 1e-4, 0, 0, 0, westergaard, 0};
        char name[32];
        snprintf(name, sizeof name, "wave, %g", fractions[k]);
        c.name = name;
        c.mean = wave_full(c.unit, 16384e-6, 1) * pow(sin(exact_pi / 2 * fractions[k]), 2);
        failed += hard_failures(&c);
    }
    assert_int_equal(failed, 0);
}

/* Full contact: p = mean + E* |q| h / 2, wave by wave. */
static double
multiplier(const struct hard_case *c, const struct rc_problem *problem, const double *h,
           const struct solved *s)
{
    size_t n = c->shape.nx * c->shape.ny;
    double a = 1 / (c->shape.dx * (double)c->shape.nx), b = 1 / (c->shape.dy * (double)c->shape.ny);
    double factor = exact_pi * problem->pair.estar * (c->height == crossed ? hypot(a, b) : a),
           worst = 0;

    if (s->c.contact_nodes != n)
        return INFINITY;
    for (size_t k = 0; k < n; k++)
        worst = larger(worst, fabs(s->p[k] - (c->mean * problem->pair.estar + factor * h[k])));
    return worst / (hard_error * c->mean * problem->pair.estar);
}

/* Johnson, Greenwood and Higginson 1985; fractions from an independent computation at 512 x 512,
 * corrected for the perimeter, +-0.001. The count of nodes is high by half a node along the
 * edge. */
static double
two_waves(const struct hard_case *c, const struct rc_problem *problem, const double *h,
          const struct solved *s)
{
    static const double table[][2] = {
        {0.05, 0.1129}, {0.2, 0.3457}, {0.5, 0.7043}, {0.8, 0.8975}, {0.95, 0.9758}};
    double full = sqrt(2) * wave_full(c->unit, c->shape.dx * (double)c->shape.nx, 1);
    double off = INFINITY, high = 4 / (double)c->shape.nx, known = 0.001;

    (void)problem, (void)h;
    for (size_t k = 0; k < sizeof table / sizeof *table; k++)
        if (fabs(c->mean / full - table[k][0]) < rounding)
            off = fabs(s->c.contact_fraction - table[k][1] - high / 2 + known) / (high / 2 + known);
    return off;
}

#define WAVE                                                                                       \
    {                                                                                              \
        64, 48, 1e-6, 1.3e-6                                                                       \
    }
#define JGH                                                                                        \
    {                                                                                              \
        192, 192, 1e-6, 1e-6                                                                       \
    }

/* clang-format off */
static const struct hard_case full_contact[] = {
    {"wave, full", WAVE, PERIODIC, cosine, 0, 1e-7, 1.001 * 3.14159265358979 * 1e-7 / 64e-6, 0, 0,
     multiplier, 0},
    {"wave, far beyond", WAVE, PERIODIC, cosine, 0, 1e-7, 0.1, 0, 0, multiplier, 1e-13},
    {"crossed waves, full", WAVE, PERIODIC, crossed, 0, 1e-7, 8e-3, 0, 0, multiplier, 0},
    {"Johnson, 0.05", JGH, PERIODIC, crossed, 0, 1e-6, 0, 0, 0, two_waves, 0},
    {"Johnson, 0.2", JGH, PERIODIC, crossed, 0, 1e-6, 0, 0, 0, two_waves, 0},
    {"Johnson, 0.5", JGH, PERIODIC, crossed, 0, 1e-6, 0, 0, 0, two_waves, 0},
    {"Johnson, 0.8", JGH, PERIODIC, crossed, 0, 1e-6, 0, 0, 0, two_waves, 0},
    {"Johnson, 0.95", JGH, PERIODIC, crossed, 0, 1e-6, 0, 0, 0, two_waves, 0},
};
/* clang-format on */

static void
up_to_full_contact(void **state)
{
    size_t failed = 0;

    (void)state;
    for (size_t k = 0; k < sizeof full_contact / sizeof *full_contact; k++) {
        struct hard_case c = full_contact[k];
        if (c.truth == two_waves)
            c.mean = atof(strchr(c.name, ',') + 1) * sqrt(2) * wave_full(c.unit, 192e-6, 1);
        failed += hard_failures(&c);
    }
    assert_int_equal(failed, 0);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(from_the_mean_pressure_up),
        cmocka_unit_test(about_the_elastic_maximum),
        cmocka_unit_test(a_wave_from_a_thousandth_on),
        cmocka_unit_test(up_to_full_contact),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
