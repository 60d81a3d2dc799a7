/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The error estimate is never below the true error, in any iteration, and not far above it. Below 1e-3 and at
 * the end of a solve it is at most 1.5 times the error, and 1.6 times with an active hardness. Before, it is
 * at most about 4 times the error. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

struct row {
    struct rc_boundary boundary;
    double sphere;     /* sag of a sphere at the map's edge over the map's length; 0: none      */
    double slope;      /* slope of the roughness */
    double hurst, cut; /* shortest wave in nodes                                               */
    double mean;       /* mean pressure over E*                                                */
    double hardness;   /* over the mean pressure; 0: none                                      */
    size_t large;      /* nodes a side; 0: 128                                                  */
    bool scattered;    /* hardly any node is elastic                                            */
};

/* A gap far from that of the solution leaves many nodes that would leave their bound. The estimate counts
 * each of them: 33 times the error before the first step, 2.6 times at 1e-3. */
static const double scattered_early = 40, scattered_small = 3;

/* clang-format off */
#define FREE {.x = false}
#define PERIODIC {.x = true, .y = true}

static const struct row rows[] = {
    {PERIODIC, 0, 0.1, 0.8, 8, 4e-4, 0, 0, false},  {PERIODIC, 0, 0.1, 0.8, 8, 4e-3, 0, 0, false},
    {PERIODIC, 0, 0.1, 0.8, 8, 0.018, 0, 0, false}, {PERIODIC, 0, 0.1, 0.3, 4, 0.03, 0, 0, false},
    {PERIODIC, 0, 0.1, 0.8, 8, 0.05, 0, 0, false},  {PERIODIC, 0, 0.1, 0.8, 8, 0.12, 0, 0, false},
    {PERIODIC, 0, 0.1, 0.8, 8, 0.01, 3, 0, false},  {PERIODIC, 0, 0.1, 0.8, 8, 0.01, 1.2, 0, false},
    {FREE, 0.02, 0, 0, 0, 1e-3, 0, 0, false},       {FREE, 0.02, 0.01, 0.8, 8, 1e-4, 0, 0, false},
    {FREE, 0.02, 0.01, 0.8, 8, 1e-3, 0, 0, false},  {FREE, 0.02, 0.01, 0.8, 8, 5e-3, 0, 0, false},
    {FREE, 0, 0.1, 0.8, 8, 0.01, 0, 0, false},      {FREE, 0, 0.1, 0.8, 8, 0.1, 0, 0, false},
    {FREE, 0, 0.1, 0.3, 4, 0.01, 0, 0, false},      {FREE, 0.02, 0.01, 0.8, 8, 1e-3, 10, 0, false},
    {FREE, 0, 0.1, 0.8, 8, 0.01, 2, 0, false},
    {PERIODIC, 0, 0.1, 0.8, 2, 9e-4, 1 / 0.9, 0, true},
    {FREE, 0, 0.1, 0.8, 2, 1.5e-3, 1 / 0.3, 0, true},
    {FREE, 0.00625, 0.005, 0.8, 8, 8.3e-4, 8, 512, false}, /* nodes outside of the working set count too */
    {PERIODIC, 0, 0.1, 0.8, 2, 0.055, 0, 256, false}, /* many nodes would only return to their bound */
};
/* clang-format on */

static double *
heights(const struct row *row, struct rc_shape s)
{
    size_t n = s.nx * s.ny;
    double *h = calloc(n, sizeof *h), side = s.dx * (double)s.nx;
    struct rc_selfaffine what = {.hurst = row->hurst,
                                 .rms_slope = row->slope,
                                 .rolloff = side / 4,
                                 .short_cut = row->cut * s.dx,
                                 .seed = 5};
    struct rc_err err;

    if (row->slope > 0)
        assert_int_equal(rc_synth_selfaffine(&s, &what, h, &err), RC_OK);
    for (size_t k = 0; k < n; k++)
        h[k] -= row->sphere * side * 4 * pow(node_r(s, k) / side, 2);
    return h;
}

/* Ratios of estimate and true error. */
struct ratios {
    double least, most; /* most: the largest ratio of small errors */
    double early;       /* the largest ratio of the others */
    size_t judged;      /* steps                        */
};

/* At the end of a solve the estimate uses the whole working set. */
static void
ends(struct rc_shape s, const double *h, struct rc_problem problem, const double *exact,
     struct ratios *r)
{
    static const double tols[] = {1e-3, 3e-4, 1e-4, 1e-6};

    for (size_t k = 0; k < sizeof tols / sizeof *tols; k++) {
        struct solved a;
        double ratio;
        problem.tol = tols[k];
        a = solve(s, h, problem);
        assert_int_equal(a.status, RC_OK);
        ratio = a.c.pressure_error / distance(s.nx * s.ny, a.p, exact);
        r->least = fmin(r->least, ratio);
        r->most = fmax(r->most, ratio);
        solved_free(&a);
    }
}

/* The method of the paper finds the same pressure independently. */
static void
another_says_so(struct rc_shape s, const double *h, struct rc_problem problem, const double *exact)
{
    struct solved a;

    problem.method = "pk99";
    problem.tol = 1e-7;
    a = solve(s, h, problem);
    assert_int_equal(a.status, RC_OK);
    assert_true(distance(s.nx * s.ny, a.p, exact) < problem.tol);
    solved_free(&a);
}

/* Records each step down to a tolerance: the estimate of a step refers to the pressure before it. */
static enum rc_status
steps(struct rc_shape s, const double *h, struct rc_problem problem, const double *exact,
      struct ratios *r)
{
    size_t n = s.nx * s.ny;
    double *old = malloc(n * sizeof *old);
    struct rc_err err;
    struct rc_solver *solver = rc_solver_new(&s, h, &problem, &err);
    enum rc_status status;

    assert_non_null(old);
    assert_non_null(solver);
    do {
        double error, ratio;
        struct rc_progress at;
        memcpy(old, rc_solver_pressure(solver), n * sizeof *old);
        status = rc_solver_step(solver);
        error = distance(n, old, exact);
        rc_solver_progress(solver, &at);
        ratio = at.error / error;
        assert_true(error >= 0);
        if (at.coarser || isnan(at.error) || error < problem.tol)
            continue;
        r->judged++;
        r->least =
            fmin(r->least, ratio); /* a valid ratio: neither estimate nor error is NaN or 0 */
        if (at.error < estimate_small)
            r->most = fmax(r->most, ratio);
        else
            r->early = fmax(r->early, ratio);
    } while (status == RC_MORE);
    rc_solver_free(solver);
    free(old);
    return status;
}

/* The reference is the same method at 1e-12, verified by its KKT residual; ratios are taken down to errors of
 * 1e-9. */
static void
never_below_never_far_above(void **state)
{
    static const double floor_ = 1e-9;
    size_t wrong = 0;

    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct row *row = &rows[k];
        size_t m = row->large > 0 ? row->large : 128, n = m * m;
        struct rc_shape s = {m, m, 1e-6, 1e-6};
        double *h = heights(row, s), mean = 1e9 * row->mean, bound, early;
        struct rc_problem problem = {.boundary = row->boundary,
                                     .pair.estar = 1e9,
                                     .method = "pcg",
                                     .load = mean * s.dx * s.dy * (double)n,
                                     .tol = 1e-12,
                                     .hardness =
                                         row->hardness > 0 ? row->hardness * mean : INFINITY};
        struct solved exact = solve(s, h, problem);
        bool yields = exact.c.plastic_nodes > 0;
        struct ratios r = {.least = INFINITY};
        enum rc_status status;

        assert_int_equal(exact.status, RC_OK);
        assert_true(exact.c.kkt_residual < 100 * problem.tol); /* gaps are not pressures */
        if (m == 128)
            another_says_so(s, h, problem, exact.p);
        ends(s, h, problem, exact.p, &r);
        problem.tol = floor_;
        status = steps(s, h, problem, exact.p, &r);
        print_message("%s contact %.3f, plastic %.3f, %zu iterations: %.3f to %.2f, before %.2f\n",
                      rc_repeats(row->boundary) == 0 ? "free    " : "periodic",
                      exact.c.contact_fraction, (double)exact.c.plastic_nodes / (double)n, r.judged,
                      r.least, r.most, r.early);
        bound = row->scattered ? scattered_small : yields ? estimate_plastic : estimate_elastic;
        early = row->scattered ? scattered_early : 1.1 * estimate_early;
        if (status != RC_OK || r.judged < 2 || r.most == 0 || r.least < 1 || r.most > bound ||
            r.early > early) { /* 4.2 where nearly every node yields */
            print_error("out of bounds\n");
            wrong++;
        }
        assert_true(yields == (row->hardness > 0));
        solved_free(&exact);
        free(h);
    }
    assert_int_equal(wrong, 0);
}

/* On a profile few waves carry the error, and they may cancel. E of a coat is given over that of the base; 0:
 * no coat. */
static void
on_profiles(struct rc_boundary boundary, double coat)
{
    const size_t profiles = 200, step = thorough(1, 7);
    const struct rc_layer layer = {3e-6, coat * 1e9, 0.3};
    const double exact_tol = coat > 10 ? 1e-11 : 1e-12; /* the limit of rounding */
    double least = INFINITY, most = 0;
    size_t judged = 0;

    for (unsigned k = 0; k < profiles; k += (unsigned)step) {
        size_t n = 40 + 13 * k % 1500, waves = 1 + k % 7;
        struct rc_shape s = {k % 3 == 0 ? 1 : n, k % 3 == 0 ? n : 1, 1e-6, 1e-6};
        double *h = calloc(n, sizeof *h), mean = 1e7 * pow(10, -4 + 0.03 * (double)(37 * k % 100));
        struct rc_selfaffine what = {.hurst = 0.8, .rms_height = 1e-7, .seed = k + 1};
        struct rc_problem problem = {
            .boundary = boundary, .load = mean * s.dx * s.dy * (double)n, .tol = exact_tol};
        struct solved exact, a;
        double error, ratio;

        if (coat > 0) {
            problem.pair.one = (struct rc_body){1e9, 0.3, 1, &layer};
            problem.pair.two = (struct rc_body){INFINITY, 0, 0, NULL};
        } else {
            problem.pair.estar = 1e9;
        }
        assert_int_equal(rc_synth_selfaffine(&s, &what, h, NULL), RC_OK);
        for (size_t i = 0; i < n && k % 2 == 1; i++)
            h[i] = 1e-6 * cos(2 * exact_pi * (double)(waves * i) / (double)n);
        exact = solve(s, h, problem);
        problem.tol = k % 4 < 2 ? 3e-4 : 3e-7;
        a = solve(s, h, problem);
        assert_true(exact.status == RC_OK && a.status == RC_OK);
        error = distance(n, a.p, exact.p);
        if (error > 100 * exact_tol) { /* otherwise the starting pressure was the solution */
            ratio = a.c.pressure_error / error;
            least = fmin(least, ratio);
            most = fmax(most, ratio);
            judged++;
        }
        solved_free(&exact);
        solved_free(&a);
        free(h);
    }
    print_message("%zu profiles, %s, coat %g: %.3f to %.2f\n", judged, rc_boundary_word(boundary),
                  coat, least, most);
    assert_true(judged > profiles / step / 2 && least >= 1 && most < (coat > 10 ? 5 : 2.5));
}

static void
not_below_on_profiles(void **state)
{
    (void)state;
    for (int periodic = 0; periodic < 2; periodic++) {
        const struct rc_boundary b = periodic ? RC_PERIODIC : RC_FREE;
        on_profiles(b, 0);
        on_profiles(b, 0.1);
        on_profiles(b, 10);
        on_profiles(b, 100);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(never_below_never_far_above),
        cmocka_unit_test(not_below_on_profiles),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
