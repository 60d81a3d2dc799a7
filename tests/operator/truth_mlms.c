/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The error of the multi-level sum is at most the requested one, for any pressure, grid, spacing and
 * kernel. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "tests/exact.h"
#include "libcontact/operator/real_space/mlms.h"
#include "tests/body_case.h"

/* A sum by one engine, compared with another engine. */
/* K = 1/r of a point: E* = 1/pi. */
static struct body_case point;

struct trial {
    struct rc_sum sum;
    size_t n;
    void *mlms, *truth;
    const struct rc_engine *judge;
    double *p, *u, *v, *k;
    double k0, error; /* largest |K|; the plan's own estimate */
};

static struct trial
trial_new(struct rc_sum sum, const struct rc_engine *judge)
{
    const struct rc_lattice nodes = {sum.shape.dx, sum.shape.dy, 1, 1};
    struct trial t = {.sum = sum, .n = sum.shape.nx * sum.shape.ny, .judge = judge};
    struct rc_err err;

    t.mlms = rc_engine_mlms.new(&t.sum, &err);
    assert_non_null(t.mlms);
    t.error = rc_engine_mlms.error(t.mlms);
    t.sum.tol = 0;
    t.truth = judge->new (&t.sum, &err);
    assert_non_null(t.truth);
    t.p = calloc(t.n, sizeof *t.p);
    t.u = calloc(t.n, sizeof *t.u);
    t.v = calloc(t.n, sizeof *t.v);
    t.k = calloc(t.n, sizeof *t.k);
    sum.kernel.rows(sum.kernel.of, &nodes, sum.shape.nx, 0, sum.shape.ny, t.k);
    for (size_t i = 0; i < t.n; i++)
        t.k0 = fmax(t.k0, fabs(t.k[i]));
    return t;
}

static void
trial_free(struct trial *t)
{
    rc_engine_mlms.free(t->mlms);
    t->judge->free(t->truth);
    free(t->p);
    free(t->u);
    free(t->v);
    free(t->k);
}

/* Largest sum of |K| |p| over the map. For a kernel that changes sign only a lower bound: the sums at a
 * loaded node and near the middle of the map. */
static double
magnitude(struct trial *t)
{
    size_t nx = t->sum.shape.nx, ny = t->sum.shape.ny, mx = nx / 2, my = ny / 2;
    double *absolute = malloc(t->n * sizeof *absolute), *field = malloc(t->n * sizeof *field);
    double sum = 0, largest = 0;

    assert_true(t->n > 0 && absolute != NULL && field != NULL);
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            size_t a = i > mx ? i - mx : mx - i, b = j > my ? j - my : my - j;
            absolute[j * nx + i] = fabs(t->p[j * nx + i]);
            sum += fabs(t->k[b * nx + a]) * absolute[j * nx + i];
            largest = fmax(largest, absolute[j * nx + i]);
        }
    sum = fmax(sum, t->k0 * largest);
    if (t->sum.kernel.of == &point.surface) {
        t->judge->apply(t->truth, absolute, field);
        for (size_t i = 0; i < t->n; i++)
            sum = fmax(sum, field[i]);
    }
    free(absolute);
    free(field);
    return sum;
}

/* Largest error over the largest sum of |K| |p|. */
static double
worst(struct trial *t)
{
    double largest = 0;

    rc_engine_mlms.apply(t->mlms, t->p, t->u);
    t->judge->apply(t->truth, t->p, t->v);
    for (size_t i = 0; i < t->n; i++)
        largest = fmax(largest, fabs(t->u[i] - t->v[i]));
    return largest / magnitude(t);
}

static double
relative_l2(const struct trial *t)
{
    double e = 0, s = 0;

    for (size_t i = 0; i < t->n; i++) {
        e += (t->u[i] - t->v[i]) * (t->u[i] - t->v[i]);
        s += t->v[i] * t->v[i];
    }
    return sqrt(e / s);
}

static double
random_number(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005U + 1442695040888963407U;
    return (double)(*seed >> 11) / 9007199254740992.0 - 0.5;
}

/* Table 1 of the paper: nodes from -1 to 1, both included. */
static void
hertz_map(const struct rc_shape *s, double *p)
{
    for (size_t j = 0; j < s->ny; j++)
        for (size_t i = 0; i < s->nx; i++) {
            double x = s->nx > 1 ? 2 * (double)i / (double)(s->nx - 1) - 1 : 0;
            double y = s->ny > 1 ? 2 * (double)j / (double)(s->ny - 1) - 1 : 0, r2 = x * x + y * y;
            p[j * s->nx + i] = r2 < 1 ? sqrt(1 - r2) : 0;
        }
}

static double
single_node(struct trial *t)
{
    size_t nx = t->sum.shape.nx, ny = t->sum.shape.ny, x = nx / 2, y = ny / 2;
    size_t at[4][2] = {{x, y}, {x + 1, y}, {x + 1, y + 1}, {0, ny - 1}};
    double largest = 0;

    for (size_t k = 0; k < 4; k++) {
        memset(t->p, 0, t->n * sizeof *t->p);
        t->p[(at[k][1] < ny ? at[k][1] : 0) * nx + (at[k][0] < nx ? at[k][0] : 0)] = -2.5;
        largest = fmax(largest, worst(t));
    }
    return largest;
}

/* The largest error for these pressures: that of Table 1, random ones, alternating signs, single nodes. */
static double
usual_pressures(struct trial *t)
{
    uint64_t seed = 1999;
    double largest;

    hertz_map(&t->sum.shape, t->p);
    for (size_t i = 0; t->n < 50 && i < t->n; i++)
        t->p[i] = 1; /* a map with too few nodes has no contact inside */
    largest = worst(t);
    for (size_t i = 0; i < t->n; i++)
        t->p[i] = random_number(&seed);
    largest = fmax(largest, worst(t));
    for (size_t i = 0; i < t->n; i++)
        t->p[i] = (i % t->sum.shape.nx + i / t->sum.shape.nx) % 2 == 0 ? 1 : -1;
    largest = fmax(largest, worst(t));
    return fmax(largest, single_node(t));
}

static struct rc_sum
displacement(size_t nx, size_t ny, double dx, double dy)
{
    return (struct rc_sum){.shape = {nx, ny, dx, dy}, .kernel = point.kernel, .threads = 2};
}

/* (20) and (18) of the paper; m_c is rounded up. */
static size_t
paper_order(size_t nodes)
{
    return (size_t)lround(0.84 * log((double)nodes));
}

static size_t
paper_correction(size_t t, size_t nodes)
{
    double m = 0.7 * (double)t * pow((double)nodes, 1 / (double)t) - 1;

    return m > 2 * (double)t ? (size_t)ceil(m) : 2 * t;
}

/* ---- Table 1 ---- */

/* Deflection under sqrt(1 - r^2) in units where K = 1/r (Johnson 1985, eqs. 3.41 and 3.42). */
static double
deflection(double r)
{
    if (r <= 1)
        return exact_pi * exact_pi / 4 * (2 - r * r);
    return exact_pi / 2 * ((2 - r * r) * asin(1 / r) + sqrt(r * r - 1));
}

static double
error_to_exact(const struct rc_shape *s, const double *u)
{
    double e = 0, sum = 0;

    for (size_t j = 0; j < s->ny; j++)
        for (size_t i = 0; i < s->nx; i++) {
            double x = 2 * (double)i / (double)(s->nx - 1) - 1;
            double y = 2 * (double)j / (double)(s->ny - 1) - 1, truth = deflection(hypot(x, y));
            double difference = u[j * s->nx + i] - truth;
            e += difference * difference;
            sum += truth * truth;
        }
    return sqrt(e / sum);
}

static void
table_1(void **state)
{
    static const struct {
        size_t nodes;
        double direct, digit; /* published with this last digit by the exact sum */
    } row[] = {{64, 5.42e-4, 1e-6},
               {128, 1.13e-4, 1e-6},
               {256, 3.22e-5, 1e-7},
               {512, 8.87e-6, 1e-8},
               {1024, 0, 0}};

    (void)state;
    for (size_t k = 0; k < thorough(sizeof row / sizeof *row, 3); k++) {
        size_t m = row[k].nodes, t = paper_order(m);
        double d = 2 / (double)(m - 1), direct, mlms, between;
        struct rc_sum sum = displacement(m, m, d, d);
        struct trial trial;
        sum.order = t;
        sum.correction = paper_correction(t, m);
        trial = trial_new(sum, row[k].direct > 0 ? &rc_engine_direct : &rc_engine_fft);
        hertz_map(&sum.shape, trial.p);
        worst(&trial);
        direct = error_to_exact(&sum.shape, trial.v);
        mlms = error_to_exact(&sum.shape, trial.u);
        between = relative_l2(&trial);
        if (row[k].direct > 0)
            assert_true(fabs(direct - row[k].direct) <= 0.5 * row[k].digit);
        assert_true(between <= 1 / (double)(m * m));
        assert_true(fabs(mlms - direct) <= 1 / (double)(m * m));
        trial_free(&trial);
    }
}

/* ---- accuracy ---- */

/* Pressures with the signs of the error at one node, where it exceeds a fraction of the largest. */
static double
contrived_pressures(struct trial *t)
{
    size_t nx = t->sum.shape.nx, middle = t->sum.shape.ny / 2 * nx + nx / 2, n = t->n;
    double *e = malloc(n * sizeof *e), largest = 0;

    for (size_t k = 0; k < 4; k++) {
        double most = 0;
        memset(t->p, 0, n * sizeof *t->p);
        t->p[middle + k % 2 + k / 2 * nx] = 1;
        worst(t);
        for (size_t i = 0; i < n; i++) {
            e[i] = t->u[i] - t->v[i];
            most = fmax(most, fabs(e[i]));
        }
        for (double part = 0.5; part > 0.01; part /= 2) {
            for (size_t i = 0; i < n; i++)
                t->p[i] = fabs(e[i]) < part * most ? 0 : e[i] < 0 ? -1 : 1;
            largest = fmax(largest, worst(t));
        }
    }
    free(e);
    return largest;
}

static void
as_exact_as_asked(void **state)
{
    const size_t tols = thorough(10, 4);

    (void)state;
    for (size_t k = 0; k < tols; k++) {
        const double tol = pow(10, -3 - 9 * (double)k / (double)(tols - 1));
        struct rc_sum sum = displacement(201, 256, 1.1, 1);
        struct trial t;
        double usual, contrived;
        sum.tol = tol;
        t = trial_new(sum, &rc_engine_fft);
        usual = usual_pressures(&t);
        contrived = contrived_pressures(&t);
        if (t.error > tol || usual > t.error || contrived > t.error || usual < tol / 300)
            print_error("asked %g: estimate %g, usual %g, contrived %g\n", tol, t.error, usual,
                        contrived);
        assert_true(t.error <= tol);
        assert_true(usual <= t.error && contrived <= t.error);
        assert_true(usual >= tol / 300); /* and little work for values that were not requested */
        trial_free(&t);
    }
}

/* Without a tolerance the engine is exact to rounding. */
static void
as_exact_as_rounding(void **state)
{
    struct trial t = trial_new(displacement(300, 211, 1, 1), &rc_engine_direct);

    (void)state;
    assert_true(t.error <= 2e-14);
    assert_true(usual_pressures(&t) <= t.error);
    trial_free(&t);
}

/* Any order with the correction region of (18) is stable, and its error is never above the stated one. */
static void
any_order(void **state)
{
    (void)state;
    for (size_t m = 64; m <= 256; m *= 2)
        for (size_t t = 1; t <= 50; t += m < 256 ? thorough(1, 7) : t < 8 ? 3 : 14) {
            double d = 2 / (double)(m - 1), smooth, usual;
            struct rc_sum sum = displacement(m, m, d, d);
            struct trial trial;
            sum.order = t;
            sum.correction = paper_correction(t, m);
            trial = trial_new(sum, &rc_engine_fft);
            hertz_map(&sum.shape, trial.p);
            worst(&trial);
            smooth = relative_l2(&trial);
            usual = usual_pressures(&trial);
            if (smooth > 1 / (double)(m * m) || usual > trial.error)
                print_error("%zu nodes, t = %zu: smooth %g, usual %g, estimate %g\n", m, t, smooth,
                            usual, trial.error);
            assert_true(smooth <= 1 / (double)(m * m));
            assert_true(usual <= trial.error);
            trial_free(&trial);
        }
}

/* Long grids, long cells, odd and prime sizes, and profiles are all as accurate as a square. */
static void
any_shape(void **state)
{
    static const struct rc_shape shapes[] = {
        {128, 128, 1, 1},    {512, 64, 1, 100},  {64, 512, 1, 100},  {300, 150, 1, 10},
        {149, 303, 30, 1},   {200, 200, 1, 1.9}, {200, 200, 1.4, 1}, {3, 1000, 1, 1},
        {1000, 3, 1, 1},     {1, 997, 1, 1},     {997, 1, 1, 1},     {1, 500, 100, 1},
        {10, 1000, 1, 1},    {1000, 10, 1, 1},   {97, 131, 1, 1.3},  {257, 101, 0.01, 0.02},
        {1009, 31, 1, 0.01}, {33, 2, 1, 1},      {2, 2, 1, 1},       {1, 1, 1, 2}};

    (void)state;
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++)
        for (double tol = 1e-4; tol > 1e-9; tol /= 1e4) {
            const struct rc_shape *s = &shapes[k];
            struct rc_sum sum = displacement(s->nx, s->ny, s->dx, s->dy);
            struct trial t;
            double usual;
            sum.tol = tol;
            t = trial_new(sum, &rc_engine_fft);
            usual = usual_pressures(&t);
            if (t.error > tol || usual > t.error)
                print_error("%zu x %zu, %g x %g, asked %g: estimate %g, error %g\n", shapes[k].nx,
                            shapes[k].ny, shapes[k].dx, shapes[k].dy, tol, t.error, usual);
            assert_true(t.error <= tol && usual <= t.error);
            trial_free(&t);
        }
}

static void
any_stress(void **state)
{
    static const double depths[] = {0.1, 1, 5, 40};

    (void)state;
    for (size_t d = 0; d < sizeof depths / sizeof *depths; d += thorough(1, 3))
        for (int c = 0; c < RC_STRESS_KERNELS; c++) {
            struct body_case stress;
            struct rc_sum sum = displacement(170, 143, 1, 1.2);
            struct trial t;
            double usual;
            stress_case(&stress, (struct rc_body){.nu = 0.3}, depths[d], RC_FREE, c);
            sum.kernel = stress.kernel;
            sum.tol = 1e-5;
            t = trial_new(sum, &rc_engine_fft);
            usual = usual_pressures(&t);
            if (t.error > sum.tol || usual > t.error)
                print_error("component %d at %g: estimate %g, error %g\n", c, depths[d], t.error,
                            usual);
            assert_true(t.error <= sum.tol && usual <= t.error);
            trial_free(&t);
            body_case_free(&stress);
        }
}

/* ---- laws ---- */

static void
reciprocal(void **state)
{
    struct rc_sum sum = displacement(301, 220, 1, 1.1);
    struct trial t;
    double xky = 0, ykx = 0, all;
    uint64_t seed = 7;

    (void)state;
    sum.tol = 1e-5;
    t = trial_new(sum, &rc_engine_fft);
    for (size_t i = 0; i < t.n; i++) {
        t.p[i] = random_number(&seed) + 0.5;
        t.v[i] = random_number(&seed) + 0.5;
    }
    rc_engine_mlms.apply(t.mlms, t.p, t.u);
    for (size_t i = 0; i < t.n; i++)
        ykx += t.v[i] * t.u[i];
    all = ykx; /* no term is negative: this is also the sum of |K| |x| |y| */
    rc_engine_mlms.apply(t.mlms, t.v, t.u);
    for (size_t i = 0; i < t.n; i++)
        xky += t.p[i] * t.u[i];
    assert_true(fabs(xky - ykx) <= t.error * all);
    trial_free(&t);
}

/* A map with an empty part, a sparsely loaded part and a fully loaded part. */
static void
fill_unevenly(const struct rc_shape *s, double *p)
{
    uint64_t seed = 5;

    for (size_t j = 0; j < s->ny; j++)
        for (size_t i = 0; i < s->nx; i++) {
            double value = random_number(&seed), chance = random_number(&seed) + 0.5;
            p[j * s->nx + i] = i > 2 * s->nx / 3 || (i > s->nx / 3 && chance < 0.04) ? value : 0;
        }
}

static void
uneven_pressure(void **state)
{
    static const struct rc_shape shapes[] = {{500, 411, 1, 1}, {700, 200, 1, 25}, {150, 600, 4, 1}};

    (void)state;
    for (size_t k = 0; k < 3; k++) {
        struct rc_sum sum = displacement(shapes[k].nx, shapes[k].ny, shapes[k].dx, shapes[k].dy);
        struct trial t;
        sum.tol = 1e-7;
        t = trial_new(sum, &rc_engine_fft);
        fill_unevenly(&shapes[k], t.p);
        assert_true(worst(&t) <= t.error);
        trial_free(&t);
    }
}

static void
threads_change_nothing(void **state)
{
    struct rc_sum sum = displacement(401, 389, 1, 1.1);
    struct trial t;

    (void)state;
    sum.tol = 1e-6;
    t = trial_new(sum, &rc_engine_fft);
    fill_unevenly(&sum.shape, t.p);
    rc_engine_mlms.apply(t.mlms, t.p, t.u);
    for (size_t threads = 1; threads <= 5; threads += 2) {
        struct rc_err err;
        void *plan;
        sum.threads = threads;
        plan = rc_engine_mlms.new(&sum, &err);
        assert_non_null(plan);
        rc_engine_mlms.apply(plan, t.p, t.v);
        rc_engine_mlms.apply(plan, t.p,
                             t.v); /* earlier applications of a plan do not change the result */
        assert_memory_equal(t.u, t.v, t.n * sizeof *t.u);
        rc_engine_mlms.free(plan);
    }
    trial_free(&t);
}

static void
zero_gives_zero(void **state)
{
    struct rc_sum sum = displacement(150, 97, 1, 1);
    struct trial t;

    (void)state;
    sum.tol = 1e-6;
    t = trial_new(sum, &rc_engine_fft);
    t.p[40 * 150 + 70] = 1;
    rc_engine_mlms.apply(t.mlms, t.p, t.u);
    t.p[40 * 150 + 70] = 0;
    rc_engine_mlms.apply(t.mlms, t.p, t.u);
    for (size_t i = 0; i < t.n; i++)
        assert_true(t.u[i] == 0);
    trial_free(&t);
}

/* Bytes that a plan allocates. */
static size_t
plan_bytes(const struct rc_engine *engine, const struct rc_sum *sum)
{
    const size_t before = rc_memory_held().held;
    struct rc_err err;
    void *plan = engine->new (sum, &err);
    size_t bytes = rc_memory_held().held - before;

    assert_non_null(plan);
    engine->free(plan);
    return bytes;
}

static void
little_memory(void **state)
{
    struct rc_sum sum = displacement(1024, 1024, 1, 1);

    (void)state;
    sum.tol = 1e-6;
    assert_true(plan_bytes(&rc_engine_mlms, &sum) <= plan_bytes(&rc_engine_fft, &sum) / 2);
    assert_true(plan_bytes(&rc_engine_mlms, &sum) <= 12 * 1024 * 1024);
}

static void
refused(void **state)
{
    struct rc_sum sum = displacement(64, 64, 1, 1);
    struct rc_err err;

    (void)state;
    sum.boundary = RC_PERIODIC;
    assert_null(rc_engine_mlms.new(&sum, &err));
    assert_non_null(strstr(err.text, "periodic"));
    sum.boundary = RC_FREE;
    sum.order = 65;
    sum.correction = 130;
    assert_null(rc_engine_mlms.new(&sum, &err));
    assert_non_null(strstr(err.text, "65"));
    sum.order = 0;
    assert_null(rc_engine_mlms.new(&sum, &err));
    assert_non_null(strstr(err.text, "130"));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_1),
        cmocka_unit_test(as_exact_as_asked),
        cmocka_unit_test(as_exact_as_rounding),
        cmocka_unit_test(any_order),
        cmocka_unit_test(any_shape),
        cmocka_unit_test(any_stress),
        cmocka_unit_test(reciprocal),
        cmocka_unit_test(uneven_pressure),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(zero_gives_zero),
        cmocka_unit_test(little_memory),
        cmocka_unit_test(refused),
    };

    int failed;

    surface_case(&point, (struct rc_pair){.estar = 1 / exact_pi});
    failed = cmocka_run_group_tests(tests, NULL, NULL);
    body_case_free(&point);
    return failed;
}
