/* SPDX-License-Identifier: GPL-3.0-or-later */
/* On a map that repeats along one axis the displacement is the integral of the pressure over the half-space:
 * a sum over images, a strip in closed form, one row in closed form. The pressure is constant in a cell along
 * the free axis, and has the waves of the grid along the other. A turned map has the turned displacement. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"
#include "tests/line_truth.h"

static const double exact_sum = 1e-10; /* of a sum over images, over the largest displacement */

enum {
    NODES = 64, /* of a map, at most */
    IMAGES = 100
};

/* A map that repeats along its second axis: along y, or turned along x. */
struct line_map {
    size_t free, round; /* nodes along the axes */
    double d, step;     /* m: cell of the free axis, spacing of the other */
    double datum;
};

static const struct line_map maps[] = {
    {6, 5, 1.1, 0.7, 0}, {5, 6, 0.02, 1.3, 0.9}, {1, 7, 1e-6, 3e-6, 0}, {7, 1, 2, 9, 1e4},
    {2, 4, 1, 0.05, 0},  {2, 2, 1, 1, 1e-3},     {1, 1, 3, 2, 0},       {9, 3, 1, 1, 0}};

enum {
    MAPS = sizeof maps / sizeof *maps
};

static double
datum_of(const struct line_map *m)
{
    return m->datum > 0 ? m->datum : m->d * (double)m->free;
}

static struct rc_shape
shape_of(const struct line_map *m, bool turned)
{
    return turned ? (struct rc_shape){m->round, m->free, m->step, m->d}
                  : (struct rc_shape){m->free, m->round, m->d, m->step};
}

/* Node i of the free axis and j of the other. */
static size_t
node(const struct line_map *m, bool turned, size_t i, size_t j)
{
    return turned ? i * m->round + j : j * m->free + i;
}

static void
apply(const struct line_map *m, bool turned, struct rc_pair pair, const double *p, double *u)
{
    const struct rc_shape s = shape_of(m, turned);
    const struct rc_conv_options o = {.boundary = {.x = turned, .y = !turned, .datum = m->datum}};
    struct rc_err err;
    struct rc_conv *conv = rc_conv_new(&s, &pair, &o, &err);

    assert_non_null(conv);
    rc_conv_apply(conv, p, u);
    rc_conv_free(conv);
}

/* Turned over: p of a map to that of the turned map. */
static void
turn(const struct line_map *m, const double *p, double *to)
{
    for (size_t i = 0; i < m->free; i++)
        for (size_t j = 0; j < m->round; j++)
            to[node(m, true, i, j)] = p[node(m, false, i, j)];
}

/* ---- against influence coefficients ---- */

/* at[j free + i]: the displacement i cells and j nodes away from a pressure of 1 on one node. */
typedef void influence(const struct line_map *m, double *at);

/* The waves of the grid, of a pressure of 1 on node 0. */
static double
grid_wave(const struct line_map *m, double y)
{
    const double n = (double)m->round;
    double sum = 1;

    for (size_t k = 1; 2 * k <= m->round; k++)
        sum += (2 * k == m->round ? 1 : 2) * cos(2 * exact_pi * (double)k * y / (n * m->step));
    return sum / n;
}

struct image {
    const struct line_map *m;
    double x, y; /* the node, from the loaded cell */
};

/* The integral of 1/r over a cell at the distance x along the free axis; its derivative and its integral
 * by y. */
static double
across(double d, double x, double y)
{
    return asinh((x + d / 2) / fabs(y)) - asinh((x - d / 2) / fabs(y));
}

static double
across_slope(double d, double x, double y)
{
    double a = x + d / 2, b = x - d / 2;

    return -(a / hypot(a, y) - b / hypot(b, y)) / y;
}

static double
across_sum(double d, double x, double y)
{
    return love_corner(x + d / 2, y) - love_corner(x - d / 2, y);
}

/* The sum of `across` over the images, every period L. Images beyond the last are an integral from the
 * middle between two of them, and the first correction of this midpoint rule. The integral to the
 * distance Y less 2 d ln(2 Y/datum)/L, the displacement at the datum, has a limit. */
static double
images(const struct line_map *m, double x, double y)
{
    const double d = m->d, period = m->step * (double)m->round;
    const double end = (IMAGES + 0.5) * period;
    double sum = -2 * d * log_cell(x / d, d, datum_of(m)) / period;

    for (int k = -IMAGES; k <= IMAGES; k++)
        sum += across(d, x, y + k * period);
    sum -= (across_sum(d, x, end + y) + across_sum(d, x, end - y)) / period;
    return sum + (across_slope(d, x, end + y) + across_slope(d, x, end - y)) * period / 24;
}

static double
image_at(double y, void *of)
{
    const struct image *t = of;

    return (grid_wave(t->m, t->y - y) + grid_wave(t->m, t->y + y)) * images(t->m, t->x, y);
}

/* Of E* = 1. The integral over a period, whose ends are the logarithms of the load. */
static void
by_images(const struct line_map *m, double *at)
{
    for (size_t j = 0; j < m->round; j++)
        for (size_t i = 0; i < m->free; i++) {
            struct image t = {m, (double)i * m->d, (double)j * m->step};
            gsl_function f = {image_at, &t};
            double error;
            gsl_integration_qags(&f, 0, m->step * (double)m->round / 2, 0, 1e-12, MOST, space,
                                 &at[j * m->free + i], &error);
            at[j * m->free + i] /= exact_pi;
        }
}

static const struct rc_layer soft[] = {{0.8, 0.3, 0.45}}, stiff[] = {{0.8, 40, 0.2}, {2, 3, 0.3}};
static const struct rc_body coated[] = {{.e = 2, .nu = 0.3, .layer = soft, .layers = 1},
                                        {.e = 2, .nu = 0.3, .layer = stiff, .layers = 2}};
static const struct rc_body *coat;

/* Of a coated body: the coefficient of each wave. */
static void
by_waves(const struct line_map *m, double *at)
{
    struct rc_err err;
    RC_OWN(rc_stack, stack) = rc_stack_new(coat, &err);
    const double n = (double)m->round;

    assert_non_null(stack);
    memset(at, 0, m->free * m->round * sizeof *at);
    for (size_t k = 0; 2 * k <= m->round; k++)
        for (size_t i = 0; i < m->free; i++) {
            double wave = 2 * exact_pi * (double)k / (n * m->step);
            double c = coat_truth(stack, m->d, wave, datum_of(m), i);
            for (size_t j = 0; j < m->round; j++)
                at[j * m->free + i] += (k == 0 || 2 * k == m->round ? 1 : 2) / n * c *
                                       cos(2 * exact_pi * (double)(k * j) / n);
        }
}

static double
off(const struct line_map *m, struct rc_pair pair, influence *of)
{
    size_t n = m->free * m->round;
    double at[NODES], p[NODES], u[NODES], t[NODES], v[NODES], worst = 0, most = 0;
    uint64_t seed = 1912;

    assert_true(n <= NODES);
    for (size_t k = 0; k < n; k++)
        p[k] = random_number(&seed) + 0.3;
    of(m, at);
    apply(m, false, pair, p, u);
    turn(m, p, t);
    apply(m, true, pair, t, v);
    for (size_t j = 0; j < m->round; j++)
        for (size_t i = 0; i < m->free; i++) {
            double sum = 0, all = 0;
            for (size_t b = 0; b < m->round; b++)
                for (size_t a = 0; a < m->free; a++) {
                    double k =
                        at[(j + m->round - b) % m->round * m->free + (i > a ? i - a : a - i)];
                    sum += k * p[b * m->free + a];
                    all += fabs(k * p[b * m->free + a]);
                }
            worst = larger(worst, fabs(u[node(m, false, i, j)] - sum));
            worst = larger(worst, fabs(v[node(m, true, i, j)] - sum));
            most = fmax(most, all);
        }
    return worst / most;
}

static void
sum_of_images(void **state)
{
    (void)state;
    for (int k = 0; k < MAPS; k++) {
        double error = off(&maps[k], (struct rc_pair){.estar = 1}, by_images);
        print_message("%zu cells, %zu nodes of the axis that repeats: %.1e\n", maps[k].free,
                      maps[k].round, error);
        assert_true(error <= exact_sum);
    }
}

static void
coats_by_waves(void **state)
{
    (void)state;
    for (size_t c = 0; c < 2; c++)
        for (int k = 0; k < MAPS; k++) {
            double error;
            if (maps[k].d < 1e-3)
                continue; /* its coat would be thick beyond all grids */
            coat = &coated[c];
            error = off(&maps[k], (struct rc_pair){.one = *coat}, by_waves);
            print_message("coat %zu, %zu cells, %zu nodes: %.1e\n", c, maps[k].free, maps[k].round,
                          error);
            assert_true(error <= exact_sum);
        }
}

/* ---- closed forms ---- */

/* Under p = cos(q y) on |x| < b the middle line has u = 4/(pi E* q) F(q b) cos(q y), F(z) = the
 * integral of K0 from 0 to z. */
static void
strip_of_a_wave(void **state)
{
    enum {
        FREE = 21,
        ROUND = 12,
        HALF = 4 /* and the middle cell: 9 cells */
    };
    const struct line_map m = {FREE, ROUND, 0.7, 1.3, 0};
    double p[FREE * ROUND], u[FREE * ROUND], t[FREE * ROUND], v[FREE * ROUND];

    (void)state;
    for (size_t wave = 1; wave <= ROUND / 2; wave++) {
        const double q = 2 * exact_pi * (double)wave / (ROUND * m.step), b = (HALF + 0.5) * m.d;
        const double truth = 2 / (exact_pi * q) * cell(k0, 2 * b, q, 0) * q / 2;
        for (size_t k = 0; k < FREE * ROUND; k++)
            p[k] = fabs((double)(k % FREE) - FREE / 2) > HALF
                       ? 0
                       : cos(2 * exact_pi * (double)(wave * (k / FREE)) / ROUND);
        apply(&m, false, (struct rc_pair){.estar = 1}, p, u);
        turn(&m, p, t);
        apply(&m, true, (struct rc_pair){.estar = 1}, t, v);
        for (size_t j = 0; j < ROUND; j++) {
            double is = truth * cos(2 * exact_pi * (double)(wave * j) / ROUND);
            assert_true(fabs(u[node(&m, false, FREE / 2, j)] - is) <= exact_sum * truth);
            assert_true(fabs(v[node(&m, true, FREE / 2, j)] - is) <= exact_sum * truth);
        }
    }
}

/* Equal rows are one row, and that is a sum of logarithms, whatever the spacing of the rows. */
static void
equal_rows(void **state)
{
    enum {
        FREE = 37,
        ROWS = 5
    };
    static const double datums[] = {0, 1e-4, 2.5, 1e9};
    const double d = 0.7;
    double p[FREE * ROWS], u[FREE * ROWS], t[FREE * ROWS], v[FREE * ROWS], sum[FREE], most;
    uint64_t seed = 6;

    (void)state;
    for (size_t k = 0; k < FREE * ROWS; k++)
        p[k] = k < FREE ? random_number(&seed) + 0.5 : p[k - FREE];
    for (size_t q = 0; q < sizeof datums / sizeof *datums; q++)
        for (size_t rows = 1; rows <= ROWS; rows += 2) {
            const struct line_map m = {FREE, rows, d, 0.1 * (double)rows, datums[q]};
            most = 0;
            for (size_t i = 0; i < FREE; i++) {
                sum[i] = 0;
                for (size_t a = 0; a < FREE; a++)
                    sum[i] -= 2 / exact_pi * d * p[a] *
                              log_cell(fabs((double)i - (double)a), d, datum_of(&m));
                most = fmax(most, fabs(sum[i]));
            }
            apply(&m, false, (struct rc_pair){.estar = 1}, p, u);
            turn(&m, p, t);
            apply(&m, true, (struct rc_pair){.estar = 1}, t, v);
            for (size_t k = 0; k < FREE * rows; k++) {
                assert_true(fabs(u[k] - sum[k % FREE]) <= summed * most);
                assert_true(fabs(v[k] - sum[k / rows]) <= summed * most);
            }
        }
}

/* ---- laws ---- */

/* A map that is not so small: the transforms of several radices and threads. */
static const struct line_map large[] = {{100, 64, 1e-6, 1.1e-6, 0},
                                        {33, 47, 1e-6, 1e-6, 1},
                                        {512, 3, 1e-6, 1e-6, 0},
                                        {3, 500, 1, 1, 0}};

static double *
random_map(size_t n, uint64_t seed)
{
    double *p = malloc(n * sizeof *p);

    assert_non_null(p);
    for (size_t k = 0; k < n; k++)
        p[k] = random_number(&seed) + 0.1;
    return p;
}

static struct rc_pair
pair_of(size_t k)
{
    return k % 2 == 0 ? (struct rc_pair){.estar = 1}
                      : (struct rc_pair){.one = coated[k / 2 % 2], .two = {.e = 7, .nu = 0.1}};
}

static void
turned_map(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof large / sizeof *large; k++)
        for (size_t c = 0; c < 2; c++) {
            const struct line_map *m = &large[k];
            size_t n = m->free * m->round;
            double *p = random_map(n, k), *t = malloc(n * sizeof *t), *u = malloc(n * sizeof *u);
            double *v = malloc(n * sizeof *v), most = 0, worst = 0;
            turn(m, p, t);
            apply(m, false, pair_of(c), p, u);
            apply(m, true, pair_of(c), t, v);
            turn(m, u, t);
            for (size_t i = 0; i < n; i++) {
                worst = larger(worst, fabs(v[i] - t[i]));
                most = fmax(most, fabs(t[i]));
            }
            assert_true(worst <= rounding * most);
            free(p);
            free(t);
            free(u);
            free(v);
        }
}

/* The same bytes with any number of threads, in a shared plan and again. */
static void
threads(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof large / sizeof *large; k++)
        for (int turned = 0; turned < 2; turned++) {
            const struct rc_shape s = shape_of(&large[k], turned);
            const struct rc_pair pair = pair_of(k);
            struct rc_conv_options o = {.boundary = {.x = turned, .y = !turned}, .threads = 1};
            size_t n = s.nx * s.ny;
            double *p = random_map(n, k), *one = malloc(n * sizeof *one),
                   *u = malloc(n * sizeof *u);
            for (o.threads = 1; o.threads < 8; o.threads += 2) {
                struct rc_err err;
                struct rc_conv *conv = rc_conv_new(&s, &pair, &o, &err);
                assert_non_null(conv);
                for (int again = 0; again < 2; again++) {
                    rc_conv_apply(conv, p, o.threads == 1 && again == 0 ? one : u);
                    if (o.threads > 1 || again > 0)
                        assert_memory_equal(one, u, n * sizeof *u);
                }
                rc_conv_free(conv);
            }
            free(p);
            free(one);
            free(u);
        }
}

/* The datum adds 2 P'/(pi E*) ln of its ratio, of the substrate below coats, and nothing else. */
static void
another_datum(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof large / sizeof *large; k++)
        for (size_t c = 0; c < 2; c++) {
            struct line_map m = large[k];
            size_t n = m.free * m.round;
            double *p = random_map(n, k), *u = malloc(n * sizeof *u), *v = malloc(n * sizeof *v);
            double load = 0, most = 0;
            const double compliance =
                c == 0 ? 1 : (1 - 0.3 * 0.3) / coated[0].e + (1 - 0.1 * 0.1) / 7;
            for (size_t i = 0; i < n; i++)
                load += p[i] * m.d / (double)m.round;
            m.datum = 3 * m.d;
            apply(&m, false, pair_of(c), p, u);
            m.datum = 1e5 * m.d;
            apply(&m, false, pair_of(c), p, v);
            for (size_t i = 0; i < n; i++)
                most = fmax(most, fabs(v[i]));
            for (size_t i = 0; i < n; i++)
                assert_true(fabs(v[i] - u[i] - 2 * load * compliance / exact_pi * log(1e5 / 3)) <=
                            summed * most);
            free(p);
            free(u);
            free(v);
        }
}

static void
refusals(void **state)
{
    static const double wrong[] = {-1, INFINITY, NAN};
    const struct rc_shape s = {8, 8, 1, 1};
    struct rc_err err;

    (void)state;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        const struct rc_conv_options o = {.boundary = {.y = true, .datum = wrong[k]}};
        assert_null(rc_conv_new(&s, &(struct rc_pair){.estar = 1}, &o, &err));
        assert_non_null(strstr(err.text, "datum"));
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sum_of_images),   cmocka_unit_test(coats_by_waves),
        cmocka_unit_test(strip_of_a_wave), cmocka_unit_test(equal_rows),
        cmocka_unit_test(turned_map),      cmocka_unit_test(threads),
        cmocka_unit_test(another_datum),   cmocka_unit_test(refusals),
    };

    return cmocka_run_group_tests(tests, line_begin, line_end);
}
