/* SPDX-License-Identifier: GPL-3.0-or-later */
/* On random maps that repeat along one axis the pressure is that of a dense quadratic program with influence
 * coefficients from closed forms and integrals. The estimated error is not below the error, and not far above
 * it; the approach is that of the same program. Uniform and coated bodies, with and without a hardness or a
 * map of it, by loads and by approaches. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#define DENSE_MOST 4096
#include "dense.h"
#include "tests/line_truth.h"

static const double cell_size = 1e-6, base = 1e9;
static uint64_t seed;

static double
uniform(double from, double to)
{
    return from + (to - from) * (random_number(&seed) + 0.5);
}

static double
powers(double from, double to)
{
    return pow(10, uniform(from, to));
}

/* A contact: the map repeats along y, or along x if it is turned. */
struct line_case {
    size_t free, round;
    double d, step;
    bool turned;
    struct rc_layer coat;
    struct rc_problem problem;
    double *h;   /* of the map, also if that is turned        */
    double *map; /* hardness of the nodes; NULL: one for all */
};

static size_t
node_at(const struct line_case *c, size_t i, size_t j)
{
    return c->turned ? i * c->round + j : j * c->free + i;
}

static struct rc_shape
shape_of(const struct line_case *c)
{
    return c->turned ? (struct rc_shape){c->round, c->free, c->step, c->d}
                     : (struct rc_shape){c->free, c->round, c->d, c->step};
}

static size_t
side(void)
{
    return (size_t)powers(log10(8), log10((double)thorough(65, 33)));
}

/* Heights: rough, extruded and rough, or a rough cylinder. */
static void
make_heights(struct line_case *c)
{
    const struct rc_shape s = shape_of(c);
    const double rms = powers(-8.5, -6.5), kind = uniform(0, 1), radius = powers(-4.5, -2.5);
    const struct rc_selfaffine rough = {.hurst = uniform(0.3, 0.9),
                                        .rms_height = rms,
                                        .short_cut = uniform(2, 4) * fmax(c->d, c->step),
                                        .seed = seed};
    double row[64];
    struct rc_err err;

    c->h = malloc(s.nx * s.ny * sizeof *c->h);
    if (rc_synth_selfaffine(&s, &rough, c->h, &err) != RC_OK)
        fail_msg("%s", err.text);
    for (size_t i = 0; i < c->free; i++) {
        double x = ((double)i - (double)(c->free - 1) / 2) * c->d;
        row[i] = kind < 0.3 ? 5 * c->h[node_at(c, i, 0)] : kind < 0.6 ? -x * x / (2 * radius) : 0;
    }
    for (size_t i = 0; i < c->free; i++)
        for (size_t j = 0; j < c->round; j++)
            c->h[node_at(c, i, j)] += row[i];
}

/* The mean pressure over E* that gives contact of this fraction, very roughly: that of the heights'
 * spread. */
static double
pressure_for(const struct line_case *c, double fraction)
{
    size_t n = c->free * c->round;
    double slope = 0;

    for (size_t i = 0; i + 1 < c->free; i++)
        for (size_t j = 0; j < c->round; j++)
            slope += pow((c->h[node_at(c, i + 1, j)] - c->h[node_at(c, i, j)]) / c->d, 2);
    return 0.5 * fraction * sqrt(slope / (double)n);
}

static void
make(struct line_case *c, uint64_t of, bool coated)
{
    static const double tols[] = {1e-2, 1e-3, 1e-4, 1e-5};
    double mean;

    seed = of;
    for (int k = 0; k < 20; k++)
        (void)random_number(&seed);
    *c = (struct line_case){.d = cell_size, .step = cell_size * powers(-0.3, 0.3)};
    do {
        c->free = side();
        c->round = side();
    } while (c->free * c->round > thorough(DENSE_MOST, 576));
    c->turned = uniform(0, 1) < 0.5;
    make_heights(c);
    mean = base * pressure_for(c, powers(-3, 0));
    c->coat = (struct rc_layer){c->d * powers(-0.5, 1), base * powers(-2, 2), uniform(0, 0.5)};
    c->problem = (struct rc_problem){.boundary = {.x = c->turned, .y = !c->turned},
                                     .tol = tols[(size_t)uniform(0, 4)],
                                     .load = mean * (double)(c->free * c->round) * c->d * c->step,
                                     .threads = 1};
    if (coated)
        c->problem.pair.one = (struct rc_body){base, 0.3, 1, &c->coat};
    else
        c->problem.pair.estar = base;
    if (uniform(0, 1) < 0.5)
        c->problem.boundary.datum = c->d * (double)c->free * powers(-2, 4);
    if (uniform(0, 1) < 0.4)
        c->problem.hardness = mean / uniform(0.02, 0.98);
    if (c->problem.hardness > 0 && uniform(0, 1) < 0.3) {
        c->map = malloc(c->free * c->round * sizeof *c->map);
        assert_non_null(c->map);
        for (size_t k = 0; k < c->free * c->round; k++)
            c->map[k] = uniform(0, 1) < 0.1 ? NAN : c->problem.hardness * uniform(1, 3);
        c->problem.hardness_map = c->map;
        c->problem.hardness = 0;
    }
}

static double
datum_of(const struct line_case *c)
{
    return c->problem.boundary.datum > 0 ? c->problem.boundary.datum : c->d * (double)c->free;
}

/* A contact that is found by its approach, if a load causes one. The campaign then compares the load that was
 * found. */
static void
ask_for_approach(struct line_case *c)
{
    struct solved a = solve(shape_of(c), c->h, c->problem);

    if (a.status == RC_OK && a.c.approach > 0 && datum_of(c) > c->d * (double)c->free) {
        c->problem.approach = a.c.approach;
        c->problem.load = 0;
    }
    solved_free(&a);
}

/* The displacement by a row of unit load per length at the datum far away: the influence has another datum,
 * which makes K definite. */
static const double far = 4; /* lengths of the free axis */

static void
fill(struct dense *d, const struct line_case *c)
{
    const double n = (double)c->round, datum = far * c->d * (double)c->free;
    const struct rc_layer *coat = c->problem.pair.one.layer;
    struct rc_err err;
    RC_OWN(rc_stack, stack) = coat == NULL ? NULL : rc_stack_new(&c->problem.pair.one, &err);
    double *at = calloc(c->free * c->round, sizeof *at);
    const struct rc_shape s = shape_of(c);

    for (size_t k = 0; 2 * k <= c->round; k++)
        for (size_t i = 0; i < c->free; i++) {
            double q = 2 * exact_pi * (double)k / (n * c->step), w;
            if (stack != NULL)
                w = coat_truth(stack, c->d, q, datum, i);
            else
                w = (k == 0 ? -2 * c->d * log_cell((double)i, c->d, datum) : cell(k0, c->d, q, i)) /
                    (exact_pi * base);
            for (size_t j = 0; j < c->round; j++)
                at[node_at(c, i, j)] += (k == 0 || 2 * k == c->round ? 1 : 2) / n * w *
                                        cos(2 * exact_pi * (double)(k * j % c->round) / n);
        }
    d->n = s.nx * s.ny;
    d->sums = 1;
    for (size_t k = 0; k < d->n; k++) {
        d->sum[0][k] = 1;
        for (size_t l = 0; l < d->n; l++) {
            size_t i = k % s.nx, j = k / s.nx, x = l % s.nx, y = l / s.nx;
            size_t di = i > x ? i - x : x - i, dj = j > y ? j - y : y - j;
            d->K[k][l] = at[dj * s.nx + di];
        }
    }
    free(at);
}

/* 1/E* of the substrate. */
static double
compliance(const struct line_case *c)
{
    const struct rc_body *b = &c->problem.pair.one;

    return b->layers > 0 ? (1 - b->nu * b->nu) / b->e : 1 / base;
}

struct seen {
    size_t cases, judged, below, loose, failed;
    double ratio[4096], convolutions;
    double shift; /* the largest error of the approach over that of the gap */
};

static int
by_size(const void *a, const void *b)
{
    const double *x = a, *y = b;

    return (*x > *y) - (*x < *y);
}

static void
judge(struct seen *seen, struct line_case *c, size_t which)
{
    static struct dense d;
    static double most[DENSE_NODES], p[DENSE_NODES];
    const struct rc_shape s = shape_of(c);
    size_t n = s.nx * s.ny;
    double top = -INFINITY, shift, error, ratio, approach, load;
    struct solved a = solve(s, c->h, c->problem);

    seen->cases++;
    if (a.status != RC_OK)
        print_message("case %zu: status %d %s\n", which, a.status,
                      a.status == RC_FAIL ? a.err.text : "");
    seen->convolutions += a.c.convolutions;
    if (a.status == RC_OK && a.c.contact_nodes < a.c.plastic_nodes + 2) {
        solved_free(&a); /* no load to exchange */
        return;
    }
    fill(&d, c);
    load = c->problem.approach > 0 ? a.c.load : c->problem.load;
    d.value[0] = load / (c->d * c->step);
    for (size_t k = 0; k < n; k++) {
        most[k] = c->map != NULL ? c->map[k] : c->problem.hardness;
        most[k] = most[k] > 0 ? most[k] : INFINITY;
        p[k] = a.status == RC_FAIL ? d.value[0] / (double)n : a.p[k];
        top = fmax(top, c->h[k]);
    }
    dense_solve(&d, c->h, most, p, &shift);
    error = distance(n, a.p, p);
    ratio = a.c.pressure_error / error;
    /* shift is K p - h with another datum; the approach counts from the highest node */
    approach = shift + top +
               2 / exact_pi * compliance(c) * load / (c->step * (double)c->round) *
                   log(datum_of(c) / (far * c->d * (double)c->free));
    if (a.status != RC_OK || (error > 2e-7 && !(ratio >= 1 && ratio < 5)) || getenv("RC_PRINT"))
        print_message("case %zu%s%s: %zu x %zu, %g, %scoat %.2g x %.2g, hardness %.3g of the mean, "
                      "datum %.2g, contact %.3f, tol %.0e: error %.2e, estimate %.3f of it, "
                      "approach %.3e off %.1e, %zu its, %.1f conv, elastic %zu\n",
                      which, c->problem.pair.one.layers > 0 ? " coated" : "",
                      c->turned ? " turned" : "", c->free, c->round, c->step / c->d,
                      c->map != NULL            ? "map of hardness, "
                      : c->problem.approach > 0 ? "approach, "
                                                : "",
                      c->coat.thickness / c->d, c->coat.e / base,
                      c->problem.hardness * c->d * c->step * (double)n / load,
                      c->problem.boundary.datum / c->d / (double)c->free, a.c.contact_fraction,
                      c->problem.tol, error, ratio, approach, a.c.approach - approach,
                      a.c.iterations, a.c.convolutions, a.c.contact_nodes - a.c.plastic_nodes);
    seen->failed += a.status != RC_OK;
    if (error > 2e-7) { /* corrections are in single precision */
        seen->below += ratio >= 1 ? 0 : 1;
        seen->loose += ratio < 5 ? 0 : 1;
        seen->ratio[seen->judged++] = ratio;
    }
    if (!isnan(a.c.approach))
        seen->shift =
            larger(seen->shift, fabs(a.c.approach - approach) /
                                    (a.c.gap_error + 1e-10 * (fabs(shift) + fabs(approach))));
    solved_free(&a);
}

static void
campaign(size_t cases, bool coated)
{
    struct seen seen = {0};

    for (size_t k = 0; k < cases; k++) {
        struct line_case c;
        make(&c, (coated ? 2000U : 1000U) + k, coated);
        if (k % 5 == 4)
            ask_for_approach(&c);
        judge(&seen, &c, k);
        free(c.h);
        free(c.map);
    }
    qsort(seen.ratio, seen.judged, sizeof *seen.ratio, by_size);
    print_message(
        "%zu contacts%s, %zu errors above 2e-7: estimates %.3f to %.2f of them, median "
        "%.3f, %zu below, %zu above 5; approach %.2f of the error of the gap, %.2f convolutions\n",
        seen.cases, coated ? " of coats" : "", seen.judged, seen.ratio[0],
        seen.ratio[seen.judged - 1], seen.ratio[seen.judged / 2], seen.below, seen.loose,
        seen.shift, seen.convolutions / (double)seen.cases);
    assert_true(seen.judged > cases / 2 && seen.below + seen.failed == 0);
    assert_true(seen.ratio[seen.judged / 2] < 1.5 && seen.loose <= cases / 20 && seen.shift <= 1);
}

static void
uniform_bodies(void **state)
{
    (void)state;
    campaign(thorough(140, 30), false);
}

static void
coated_bodies(void **state)
{
    (void)state;
    campaign(thorough(60, 10), true);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_bodies),
        cmocka_unit_test(coated_bodies),
    };

    return cmocka_run_group_tests(tests, line_begin, line_end);
}
