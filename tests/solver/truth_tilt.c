/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A counter body that is free to tilt is compared with a dense quadratic program with two further constraints
 * for the moments. Its first touch is compared with a search over all triangles of nodes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "dense.h"

enum {
    PROBLEMS = 400
};
static const double estar = 1;

static double
uniform(uint64_t *seed)
{
    return random_number(seed) + 0.5;
}

static double
arm(const struct dense *d, size_t c, size_t k)
{
    return d->sum[1 + c][k];
}

/* The height of a resting rigid face above the point of the force: the largest height that any triangle of
 * nodes around this point gives. */
static double
rests_at(const struct dense *d, const double *h)
{
    double best = -INFINITY;

    for (size_t i = 0; i < d->n; i++)
        for (size_t j = 0; j < d->n; j++) {
            double x0 = arm(d, 0, i), x1 = arm(d, 0, j);
            if (d->sums == 2 && x0 <= 0 && x1 > 0)
                best = fmax(best, (h[i] * x1 - h[j] * x0) / (x1 - x0));
            for (size_t k = 0; k < d->n && d->sums == 3 && i < j; k++) {
                double y0 = arm(d, 1, i), y1 = arm(d, 1, j), x2 = arm(d, 0, k), y2 = arm(d, 1, k);
                double a = x1 * y2 - x2 * y1, b = x2 * y0 - x0 * y2, c = x0 * y1 - x1 * y0;
                double all = a + b + c;
                if (k > j && fabs(all) > 1e-9 && a * all >= 0 && b * all >= 0 && c * all >= 0)
                    best = fmax(best, (a * h[i] + b * h[j] + c * h[k]) / all);
            }
        }
    return best;
}

static void
pose(struct dense *d, const struct rc_shape *s, const struct rc_problem *problem)
{
    const double *at = problem->force_at;

    dense_fill(d, s, RC_FREE, estar);
    d->sums = s->ny == 1 ? 2 : 3;
    d->value[0] = problem->load / (s->dx * s->dy);
    d->value[1] = d->value[2] = 0;
    for (size_t k = 0; k < d->n; k++) {
        d->sum[1][k] = node_x(*s, k) - at[0];
        d->sum[2][k] = node_y(*s, k) - at[1];
    }
}

struct tally {
    size_t taken, judged, few;
    double worst, least, high, convolutions;
};

static void
one(uint64_t seed, struct tally *t)
{
    static struct dense d;
    static double most[DENSE_NODES], p[DENSE_NODES], h[DENSE_NODES];
    size_t nx = (size_t)(3 + 20 * pow(uniform(&seed), 2));
    size_t ny = uniform(&seed) < 0.2 ? 1 : (size_t)(3 + 20 * pow(uniform(&seed), 2)), n = nx * ny;
    struct rc_shape s = {nx, ny, 1, 1};
    struct rc_selfaffine rough = {.hurst = 0.8, .rms_height = 1, .seed = seed};
    struct rc_problem problem = {.pair.estar = estar, .tilt_free = true, .threads = 1};
    double shift[DENSE_SUMS], error, highest = 0, size = 0, slope = 2 * random_number(&seed);
    struct solved a;
    size_t elastic = 0;
    bool bounded = uniform(&seed) < 0.4; /* such a body carries no load near its rim */
    double reach = bounded ? 0.25 : 0.9;

    problem.tol = pow(10, -1 - 8 * uniform(&seed));
    problem.load = pow(10, -3 + 5 * uniform(&seed)) * sqrt((double)n);
    problem.force_at[0] = random_number(&seed) * reach * (double)(nx - 1);
    problem.force_at[1] = random_number(&seed) * reach * (double)(ny - 1);
    assert_int_equal(rc_synth_selfaffine(&s, &rough, h, NULL), RC_OK);
    for (size_t k = 0; k < n; k++)
        h[k] += slope * node_x(s, k) - 0.3 * slope * node_y(s, k);
    pose(&d, &s, &problem);
    a = solve(s, h, problem);
    assert_int_equal(a.status, RC_OK);
    if (bounded) { /* repeated, and the highest pressures are too high */
        double least = 2 * problem.load / (double)n;
        problem.hardness = fmax((0.3 + 0.6 * uniform(&seed)) * a.c.max_pressure, least);
        solved_free(&a);
        a = solve(s, h, problem);
        assert_int_equal(a.status, RC_OK);
    }
    assert_true(a.c.converged);
    for (size_t k = 0; k < n; k++) {
        most[k] = problem.hardness > 0 ? problem.hardness : INFINITY;
        elastic += a.p[k] > 0 && a.p[k] < most[k];
    }
    t->taken++;
    t->convolutions += a.c.convolutions;
    if (elastic < d.sums) {
        t->few++;
        solved_free(&a);
        return;
    }
    memcpy(p, a.p, n * sizeof *p); /* a start */
    dense_solve(&d, h, most, p, shift);
    error = distance(n, a.p, p);
    t->worst = fmax(t->worst, error / problem.tol);
    if (error > 1e-11 && a.c.pressure_error < 1e-2) {
        t->judged++;
        t->least = fmin(t->least, a.c.pressure_error / error);
        t->high = fmax(t->high, a.c.pressure_error / error);
    }
    for (size_t k = 0; k < n; k++) {
        highest = fmax(highest, h[k]);
        size = fmax(size, fabs(dense_displacement(&d, p, k)));
    }
    for (size_t c = 0; c + 1 < d.sums; c++)
        assert_true(fabs(a.c.tilt[c] + shift[1 + c]) < 20 * problem.tol * size + 1e-12);
    if (n <= 64)
        assert_true(fabs(a.c.approach - (rests_at(&d, h) + shift[0])) <
                    20 * problem.tol * size + 1e-11 * (fabs(slope) * 20 + 1));
    solved_free(&a);
}

static void
dense_program(void **state)
{
    struct tally t = {.least = INFINITY};

    (void)state;
    for (uint64_t q = 0; q < PROBLEMS; q++)
        one(7000 + q, &t);
    print_message("%zu problems, %zu of them with few elastic nodes, to %.2f of the tolerance in "
                  "%.0f convolutions each; estimates of %zu %.3f to %.2f of the error\n",
                  t.taken, t.few, t.worst, t.convolutions / (double)t.taken, t.judged, t.least,
                  t.high);
    assert_true(t.worst <= 1 && t.least >= 1);
    assert_true(t.judged > PROBLEMS / 2 && t.few < PROBLEMS / 20);
}

/* Under a force beside its apex a ball rolls until it touches there: a parabola plus a plane is the same
 * parabola at another position. */
static void
a_ball_rolls(void **state)
{
    const struct rc_shape s = {129, 101, 1e-6, 1e-6};
    const double radius = 1e-3, a = 20e-6, e = 1e11, at[2] = {11e-6, -7e-6};
    size_t n = s.nx * s.ny;
    double *h = malloc(n * sizeof *h), *moved = malloc(n * sizeof *h), peak = 2 * a * e;
    struct rc_problem problem = {.pair.estar = e,
                                 .load = 4 * e * a * a * a / (3 * radius),
                                 .tol = 1e-6,
                                 .tilt_free = true,
                                 .force_at = {at[0], at[1]}};
    struct solved rolled, there;

    (void)state;
    for (size_t k = 0; k < n; k++) {
        double x = node_x(s, k), y = node_y(s, k);
        h[k] = -(x * x + y * y) / (2 * radius);
        moved[k] = -(pow(x - at[0], 2) + pow(y - at[1], 2)) / (2 * radius);
    }
    rolled = solve(s, h, problem);
    problem.tilt_free = false;
    there = solve(s, moved, problem);
    assert_int_equal(rolled.status, RC_OK);
    assert_true(distance(n, rolled.p, there.p) < 3e-6);
    assert_true(fabs(rolled.c.tilt[0] + at[0] / radius) < 1e-8);
    assert_true(fabs(rolled.c.tilt[1] + at[1] / radius) < 1e-8);
    assert_true(fabs(rolled.c.approach / there.c.approach - 1) < 1e-6);
    peak /= exact_pi * radius;
    assert_true(fabs(rolled.c.approach * radius / (a * a) - 1) < 1e-2);
    assert_true(fabs(rolled.c.max_pressure / peak - 1) < 1e-2);
    solved_free(&rolled);
    solved_free(&there);
    free(h);
    free(moved);
}

static double
approach_at(struct rc_solver *s, double load, double *stiffness)
{
    struct rc_contact c;
    struct rc_err err;

    assert_int_equal(rc_solver_set_load(s, load, 0, &err), RC_OK);
    c = finish(s);
    assert_int_equal(rc_solver_stiffness(s, stiffness, &err), RC_OK);
    return c.approach;
}

/* A growing load tilts the face too, and the stiffness includes this. A requested approach gives the load
 * that has this approach; after setting other heights the result is that of a new solver. */
static void
load_and_approach(void **state)
{
    const struct rc_shape s = {40, 33, 1, 1.2};
    size_t n = s.nx * s.ny;
    double *h = malloc(n * sizeof *h), stiffness, some, low, high;
    const double load = 30, step = 1e-3;
    struct rc_selfaffine rough = {.hurst = 0.8, .rms_height = 1, .seed = 5};
    struct rc_problem problem = {.pair.estar = estar,
                                 .load = load,
                                 .tol = 1e-8,
                                 .method = contact_method,
                                 .tilt_free = true,
                                 .force_at = {4, -3}};
    struct rc_solver *solver;
    struct rc_contact c;
    struct rc_err err;

    (void)state;
    assert_int_equal(rc_synth_selfaffine(&s, &rough, h, NULL), RC_OK);
    solver = rc_solver_new(&s, h, &problem, &err);
    assert_non_null(solver);
    low = approach_at(solver, load * (1 - step), &some);
    high = approach_at(solver, load * (1 + step), &some);
    (void)approach_at(solver, load, &stiffness);
    /* nodes change their state within the step: the central difference is of second order */
    assert_true(fabs(2 * step * load / (high - low) / stiffness - 1) < 5e-3);
    assert_int_equal(rc_solver_set_load(solver, 0, high, &err), RC_OK);
    c = finish(solver);
    assert_true(fabs(c.load / (load * (1 + step)) - 1) < 1e-6);
    for (size_t k = 0; k < n; k++)
        h[k] += 0.1 * node_x(s, k) + 3;
    assert_int_equal(rc_solver_set_load(solver, load * (1 + step), 0, &err), RC_OK);
    assert_int_equal(rc_solver_set_heights(solver, h, &err), RC_OK);
    low = c.tilt[0];
    c = finish(solver);
    assert_true(fabs(c.approach / high - 1) < 1e-6);
    assert_true(fabs(c.tilt[0] - low - 0.1) < 1e-6);
    rc_solver_free(solver);
    free(h);
}

/* The solution continues from a saved pressure. */
static void
resumed(void **state)
{
    const struct rc_shape s = {60, 50, 1, 1};
    double *h = malloc(60 * 50 * sizeof *h);
    struct rc_selfaffine rough = {.hurst = 0.8, .rms_height = 1, .seed = 6};
    struct rc_problem problem = {
        .pair.estar = estar, .load = 50, .tol = 1e-6, .method = contact_method, .tilt_free = true};
    struct rc_solver *solver;
    struct rc_contact first, again;
    struct solved kept;
    struct rc_err err;

    (void)state;
    assert_int_equal(rc_synth_selfaffine(&s, &rough, h, NULL), RC_OK);
    kept = solve(s, h, problem);
    first = kept.c;
    solver = rc_solver_new(&s, h, &problem, &err);
    assert_int_equal(rc_solver_warm_start(solver, problem.load, kept.p, &err), RC_OK);
    again = finish(solver);
    assert_true(4 * again.iterations < first.iterations);
    assert_true(fabs(again.tilt[0] - first.tilt[0]) < 1e-5 * fabs(first.tilt[0]) + 1e-9);
    rc_solver_free(solver);
    solved_free(&kept);
    free(h);
}

/* The estimate uses the stiffness of the contact at the end of the search, also if the face was not tilted on
 * this grid. It does not use that of an earlier contact, which may have few elastic nodes. Compared with the
 * same contact at a low tolerance. */
static void
ends_with_its_stiffness(void **state)
{
    static const struct {
        struct rc_shape s;
        struct rc_selfaffine rough;
        double load, at, hardness; /* on E* = 1 GPa */
    } cases[] = {{{32, 1, 1e-6, 1e-6},
                  {.hurst = 0.8233381118546687,
                   .rms_height = 7.601397816248184e-09,
                   .short_cut = 8e-06,
                   .seed = 653475},
                  1.991348492648231e-05,
                  0,
                  0},
                 {{31, 31, 1e-6, 1e-6},
                  {.hurst = 0.7805096579155517,
                   .rms_height = 3.161000526202052e-08,
                   .short_cut = 4e-06,
                   .seed = 135267},
                  3.2570921913302186e-06,
                  -10.0653e-6,
                  318988.7816037546}};
    static double h[31 * 31];

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct rc_shape s = cases[k].s;
        struct rc_problem problem = {.pair.estar = 1e9,
                                     .load = cases[k].load,
                                     .hardness = cases[k].hardness,
                                     .force_at = {cases[k].at, 0},
                                     .tol = 1e-3,
                                     .method = contact_method,
                                     .tilt_free = true};
        struct solved loose, tight;
        double error;
        assert_int_equal(rc_synth_selfaffine(&s, &cases[k].rough, h, NULL), RC_OK);
        loose = solve(s, h, problem);
        problem.tol = 1e-9;
        tight = solve(s, h, problem);
        assert_true(loose.c.converged && tight.c.converged);
        error = distance(s.nx * s.ny, loose.p, tight.p);
        print_message("%zu x %zu nodes: error %.1e, told %.1e\n", s.nx, s.ny, error,
                      loose.c.pressure_error);
        assert_true(loose.c.pressure_error >= error);
        solved_free(&loose);
        solved_free(&tight);
    }
}

static void
refused(void **state)
{
    const struct rc_shape s = {8, 6, 1, 1};
    const double h[48] = {0};
    struct rc_problem problem = {
        .pair.estar = estar, .load = 1, .tilt_free = true, .boundary = RC_PERIODIC};
    struct rc_err err;

    (void)state;
    assert_null(rc_solver_new(&s, h, &problem, &err));
    assert_non_null(strstr(err.text, "periodic"));
    problem.boundary = RC_FREE;
    problem.force_at[0] = 3.5;
    assert_null(rc_solver_new(&s, h, &problem, &err));
    assert_non_null(strstr(err.text, "must act on the map"));
    problem.force_at[0] = NAN;
    assert_null(rc_solver_new(&s, h, &problem, &err));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dense_program),     cmocka_unit_test(a_ball_rolls),
        cmocka_unit_test(load_and_approach), cmocka_unit_test(resumed),
        cmocka_unit_test(refused),           cmocka_unit_test(ends_with_its_stiffness),
    };
    int failed = 0;

    RUN_FOR_EACH_METHOD(tests, failed);
    return failed;
}
