/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bodies in contact have equal temperatures, and the mismatch bounds the error of the largest one. */
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <setjmp.h> /* after stdarg.h and stddef.h: cmocka needs them */

#include <cmocka.h>

#include "libcontact/contact.h"
#include "libcontact/heat/heat.h"
#include "tests/exact.h"

enum {
    N = 48,
    MOST = 128
};
static const struct rc_shape shape = {N, N, 1.1e-6, 1e-6};
static double q[MOST * MOST];

static void
near(double value, double truth, double tolerance, const char *what)
{
    if (!(fabs(value - truth) <= tolerance))
        fail_msg("%s: %.15g instead of %.15g, off by %.2g, allowed %.2g", what, value, truth,
                 value - truth, tolerance);
}

static struct rc_heat *
run(const struct rc_shape *s, const struct rc_heat_problem *problem, const double *heat,
    const double *contact)
{
    struct rc_err err = {""};
    struct rc_heat_problem steps = *problem;
    struct rc_heat *h;
    enum rc_status status;

    steps.time_steps =
        steps.time_steps > 0 ? steps.time_steps : 1; /* these laws hold for any number */
    h = rc_heat_new(s, &steps, heat, contact, &err);

    if (h == NULL)
        fail_msg("%s", err.text);
    while ((status = rc_heat_step(h, &err)) == RC_MORE)
        continue;
    assert_int_equal(status, RC_OK);
    return h;
}

static struct rc_heat_problem
steel(double speed)
{
    return (struct rc_heat_problem){.body = {{45, 1.2e-5, {0, 0}, 0}, {45, 1.2e-5, {speed, 0}, 0}},
                                    .threads = 1};
}

/* Heat of an ellipse, larger at one end. */
static void
set_heat(void)
{
    for (int k = 0; k < N * N; k++) {
        const double x = (k % N - 20) / 15.0, y = (k / N - 25) / 12.0, r = x * x + y * y;
        q[k] = r < 1 ? 1e9 * (1 + 0.5 * x) * sqrt(1 - r) : 0;
    }
}

/* ---- the operator ---- */

/* At P = 0 it is the operator of an elastic half-space with E* = 2 k. */
static void
elastic(void **state)
{
    const struct rc_pair pair = {.estar = 90};
    const struct rc_operator_options options = {
        .boundary = RC_FREE, .pair = &pair, .engine = "fft", .threads = 1};
    struct rc_heat_problem problem = steel(0);
    static double u[N * N], t[N * N];
    struct rc_err err = {""};
    struct rc_operator *op = rc_operator_new(&shape, &options, &err);
    struct rc_heat *h;
    double most = 0;
    (void)state;

    set_heat();
    rc_operator_apply(op, q, u);
    problem.partition = RC_HEAT_SHARE;
    problem.share = 1;
    h = run(&shape, &problem, q, NULL);
    assert_int_equal(rc_heat_temperature(h, 0, 0, t, &err), RC_OK);
    for (int k = 0; k < N * N; k++)
        most = fmax(most, u[k]);
    for (int k = 0; k < N * N; k++)
        near(t[k], u[k], 1e-12 * most, "elastic operator");
    rc_heat_free(h);
    rc_operator_free(op);
}

/* Motion along -x, along y and along a diagonal: the map mirrored, turned, or rotated by 90 degrees. */
static void
directions(void **state)
{
    static double turned[N * N], t[2][N * N];
    const struct rc_shape square = {N, N, 1e-6, 1e-6};
    struct rc_err err = {""};
    (void)state;

    set_heat();
    for (int way = 0; way < 3; way++) {
        struct rc_heat_problem problem = steel(20);
        struct rc_heat *h;
        if (way == 2)
            problem.body[1].velocity[1] = 8;
        h = run(&square, &problem, q, NULL);
        assert_int_equal(rc_heat_temperature(h, 0, 0, t[0], &err), RC_OK);
        rc_heat_free(h);
        for (int k = 0; k < N * N; k++) /* of node (i, j): (N-1-i, j); (j, i); (N-1-j, i) */
            turned[way == 0   ? k / N * N + N - 1 - k % N
                   : way == 1 ? k % N * N + k / N
                              : k % N * N + N - 1 - k / N] = q[k];
        problem.body[1].velocity[0] = way == 0 ? -20 : way == 1 ? 0 : -8;
        problem.body[1].velocity[1] = way == 0 ? 0 : 20;
        h = run(&square, &problem, turned, NULL);
        assert_int_equal(rc_heat_temperature(h, 1, 0, t[1], &err), RC_OK);
        for (int k = 0; k < N * N; k++)
            near(t[1][way == 0   ? k / N * N + N - 1 - k % N
                      : way == 1 ? k % N * N + k / N
                                 : k % N * N + N - 1 - k / N],
                 t[0][k], q[k] > 0 ? 2e-3 * rc_heat_result(h)->max_temperature : INFINITY,
                 "turned motion");
        rc_heat_free(h);
    }
}

/* Before heat of the images arrives, a map that repeats along an axis or both is a free one; depths too. */
static void
periodic(void **state)
{
    static double t[4][N * N];
    struct rc_err err = {""};
    (void)state;

    for (int k = 0; k < N * N; k++) /* smooth: for it cells and waves agree */
        q[k] = 1e9 * exp(-(pow(k % N - 20, 2) + pow(k / N - 24, 2)) / 50);
    for (int depth = 0; depth < 2; depth++) {
        for (int repeats = 0; repeats < 4; repeats++) {
            struct rc_heat_problem problem = steel(10);
            struct rc_heat *h;
            problem.boundary = rc_boundary_of(repeats & 1, repeats & 2);
            problem.body[1].velocity[1] = -6;
            problem.time = 5e-7;
            problem.partition = RC_HEAT_SHARE;
            h = run(&shape, &problem, q, NULL);
            assert_int_equal(rc_heat_temperature(h, 1, depth * 2e-6, t[repeats], &err), RC_OK);
            rc_heat_free(h);
        }
        for (int k = 0; k < N * N; k++)
            for (int repeats = 1; repeats < 4; repeats++)
                near(t[repeats][k], t[0][k], 4e-3 * t[0][20 + 24 * N], "periodic and free");
    }
}

/* A column is a row that is turned: motion along it cools, motion across it does nothing. */
static void
column(void **state)
{
    const struct rc_shape row = {N, 1, 1e-6, 3e-6}, turned = {1, N, 3e-6, 1e-6};
    (void)state;

    set_heat();
    for (int k = 0; k < 3; k++) {
        struct rc_heat_problem along = steel(k == 0 ? 0.3 : k == 1 ? 30 : 0), across;
        struct rc_heat *a, *b;

        along.body[0].velocity[0] = k == 2 ? 0 : -0.1;
        along.time = k == 2 ? 1e-5 : 0;
        along.tol = 1e-10;
        across = along;
        along.boundary.y = across.boundary.x = true;
        for (int i = 0; i < 2; i++) {
            across.body[i].velocity[1] = across.body[i].velocity[0];
            across.body[i].velocity[0] = along.body[i].velocity[1] = 1 + i;
        }
        a = run(&row, &along, q + (size_t)(25 * N), NULL);
        b = run(&turned, &across, q + (size_t)(25 * N), NULL);
        for (int i = 0; i < N; i++)
            near(rc_heat_flux(b, 0)[i], rc_heat_flux(a, 0)[i], 1e-7 * 1e9, "heat of a column");
        near(rc_heat_result(b)->max_temperature, rc_heat_result(a)->max_temperature,
             1e-9 * rc_heat_result(a)->max_temperature, "temperature of a column");
        rc_heat_free(a);
        rc_heat_free(b);
    }
}

/* ---- maps that repeat along one axis ---- */

/* A map that repeats along y, or the same map turned, which repeats along x; heat moved by rows. */
struct turn {
    bool turned;
    size_t rows, moved;
};

/* The temperature of body 1 and the heat into it, in the order of the map that is not turned. Heat is that of
 * set_heat, or that of its middle row in all rows. */
static struct rc_heat_figures
run_turned(const struct turn *turn, const struct rc_heat_problem *problem, bool rows_differ,
           double *t, double *f)
{
    static double heat[N * N], map[N * N];
    const size_t n = turn->rows;
    const struct rc_shape s = turn->turned ? (struct rc_shape){n, N, 1e-6, 1.1e-6}
                                           : (struct rc_shape){N, n, 1.1e-6, 1e-6};
    struct rc_heat_problem p = *problem;
    struct rc_heat_figures figures;
    struct rc_err err = {""};
    struct rc_heat *h;

    p.boundary = rc_boundary_of(turn->turned, !turn->turned);
    for (int b = 0; b < 2 && turn->turned; b++) {
        p.body[b].velocity[0] = problem->body[b].velocity[1];
        p.body[b].velocity[1] = problem->body[b].velocity[0];
    }
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < N; i++)
            heat[turn->turned ? i * n + j : j * N + i] =
                q[(rows_differ ? (j + turn->moved) % n : 25) * N + i];
    h = run(&s, &p, heat, NULL);
    assert_int_equal(rc_heat_temperature(h, 0, 0, map, &err), RC_OK);
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < N; i++) {
            const size_t from = turn->turned ? i * n + j : j * N + i,
                         to = (rows_differ ? (j + turn->moved) % n : j) * N + i;
            t[to] = map[from];
            f[to] = rc_heat_flux(h, 0)[from];
        }
    figures = *rc_heat_result(h);
    rc_heat_free(h);
    return figures;
}

/* A turned map has the turned result; rows that are moved, those that leave entering on the other side, have
 * the moved result. With all partitions, in steady states and in time. */
static void
turned(void **state)
{
    static const enum rc_heat_partition by[] = {RC_HEAT_MATCHED, RC_HEAT_BLOK, RC_HEAT_CHARRON};
    static double t[3][N * N], f[3][N * N];
    static const struct turn turns[] = {{false, N, 0}, {true, N, 0}, {false, N, 11}};
    (void)state;

    set_heat();
    for (int c = 0; c < 9; c++) {
        struct rc_heat_problem problem = steel(c % 3 == 0 ? 0.5 : 20);
        problem.body[0] = (struct rc_heat_body){16, 4e-6, {-3, c % 3 == 2 ? 7 : 0}, 0};
        problem.body[1].velocity[1] = c % 3 == 2 ? -400 : 0;
        problem.partition = by[c / 3];
        problem.time = c % 3 == 1 ? 1e-5 : 0;
        problem.time_steps = 2;
        problem.tol = 1e-11;
        for (int k = 0; k < 3; k++) {
            const struct rc_heat_figures figures =
                run_turned(&turns[k], &problem, true, t[k], f[k]);
            for (int i = 0; i < N * N; i++) {
                near(t[k][i], t[0][i], 1e-9 * figures.max_temperature, "turned temperature");
                near(f[k][i], f[0][i], 1e-7 * 1e9, "turned heat");
            }
        }
    }
}

/* A map of n equal rows is one row. Its Peclet number has half the width of the contact. */
static void
equal_rows(void **state)
{
    static double t[3][N * N], f[3][N * N];
    static const struct turn turns[] = {{false, 1, 0}, {false, 12, 0}, {true, 7, 0}};
    (void)state;

    set_heat();
    for (int c = 0; c < 4; c++) {
        struct rc_heat_problem problem = steel(c == 0 ? 0.01 : 30);
        double width = 0;
        problem.body[0] = (struct rc_heat_body){16, 4e-6, {c == 3 ? 0 : -3, 0}, 0};
        problem.body[1].velocity[1] = c == 2 ? 5 : 0;
        problem.time = c == 3 ? 1e-5 : 0;
        problem.tol = 1e-11;
        for (int i = 0; i < N; i++)
            width += q[25 * N + i] > 0 ? 1.1e-6 : 0;
        for (int k = 0; k < 3; k++) {
            const struct rc_heat_figures g = run_turned(&turns[k], &problem, false, t[k], f[k]);
            for (size_t i = 0; i < N * turns[k].rows; i++) {
                near(t[k][i], t[0][i % N], 1e-9 * g.max_temperature, "temperature of equal rows");
                near(f[k][i], f[0][i % N], 1e-7 * 1e9, "heat of equal rows");
            }
            near(g.steady_time, width * width / 4e-6, 1e-12 * g.steady_time, "time of a line");
            near(g.peclet_1, fabs(problem.body[0].velocity[0]) * width / 2 / 8e-6, 1e-9,
                 "Peclet number of a line");
            assert_int_equal(g.hot_nodes, lround(width / 1.1e-6));
        }
    }
}

/* Without a time both bodies must move along the free axis; a body that takes no heat stays cold. */
static void
no_steady_state(void **state)
{
    static const struct rc_boundary mixed[] = {{.y = true}, {.x = true}};
    struct rc_err err = {""};
    (void)state;

    set_heat();
    for (int k = 0; k < 2; k++)
        for (int b = 0; b < 2; b++) {
            static const char *const says[2][2] = {
                {"body 1 does not move along x, and the map repeats along y",
                 "body 2 does not move along x"},
                {"body 1 does not move along y, and the map repeats along x",
                 "body 2 does not move along y"}};
            struct rc_heat_problem problem = steel(1);
            struct rc_heat *h;
            problem.boundary = mixed[k];
            problem.body[b].velocity[k] = 0;
            problem.body[1 - b].velocity[k] = 2;
            problem.body[0].velocity[1 - k] = problem.body[1].velocity[1 - k] = 3;
            for (int by = RC_HEAT_MATCHED; by <= RC_HEAT_SHARE; by++) {
                problem.partition = (enum rc_heat_partition)by;
                problem.share = 0.5;
                assert_null(rc_heat_new(&shape, &problem, q, NULL, &err));
                assert_non_null(strstr(err.text, says[k][b]));
                assert_non_null(strstr(
                    err.text, "it becomes warmer without end: give the time since heating began"));
            }
            problem.share = b == 0 ? 0 : 1; /* the body that does not move takes no heat */
            h = run(&shape, &problem, q, NULL);
            assert_true(isnan(rc_heat_result(h)->share_blok));
            assert_true(rc_heat_result(h)->max_temperature > 0 &&
                        isfinite(rc_heat_result(h)->max_temperature));
            rc_heat_free(h);
            problem.partition = RC_HEAT_MATCHED;
            problem.time = 1e-5;
            rc_heat_free(run(&shape, &problem, q, NULL));
        }
}

/* The row of the hottest node continues on the other side of a map that repeats; a row without ends has no
 * trailing edge. */
static void
hot_row(void **state)
{
    const struct rc_shape s = {16, 8, 1e-6, 1e-6};
    (void)state;

    for (int x = 0; x < 2; x++)
        for (int ring = 0; ring < 2; ring++) {
            struct rc_heat_problem problem = steel(0);
            struct rc_heat *h;
            problem.boundary = rc_boundary_of(x == 1, x == 0);
            problem.body[0].velocity[0] = problem.body[0].velocity[1] =
                problem.body[1].velocity[x] = 0.5;
            problem.body[1].velocity[1 - x] = 30; /* along the axis that repeats */
            for (int k = 0; k < 128; k++) {
                const int i = k % 16, j = k / 16;
                q[k] = x == 0 ? (i >= 4 && i < 9 && (ring || j < 2 || j > 5) ? 1e9 : 0)
                              : (j >= 2 && j < 7 && (ring || i < 5 || i > 13) ? 1e9 : 0);
            }
            h = run(&s, &problem, q, NULL);
            assert_int_equal(rc_heat_result(h)->hot_nodes, ring ? 5 : x == 0 ? 4 : 7);
            rc_heat_free(h);
        }
}

/* ---- partition ---- */

/* Without motion each node gives body 1 the share k1/(k1 + k2); heat is conserved. */
static void
charron(void **state)
{
    struct rc_heat_problem problem = steel(0);
    struct rc_heat *h;
    (void)state;

    set_heat();
    problem.body[0].conductivity = 16;
    problem.tol = 1e-12;
    h = run(&shape, &problem, q, NULL);
    near(rc_heat_result(h)->share_1, 16.0 / 61, 1e-11, "share without motion");
    near(rc_heat_result(h)->share_blok, 16.0 / 61, 1e-11, "Blok's share without motion");
    for (int k = 0; k < N * N; k++) {
        near(rc_heat_flux(h, 0)[k], 16.0 / 61 * q[k], 1e-9 * 1e9, "heat into body 1");
        near(rc_heat_flux(h, 0)[k] + rc_heat_flux(h, 1)[k], q[k], 1e-15 * 1e9, "sum of the heat");
    }
    rc_heat_free(h);
}

/* Bulk temperatures alone: the conductance of Barber's analogy, from the stiffness of the elastic contact. */
static void
conductance(void **state)
{
    static double heights[N * N], zero[N * N];
    const struct rc_selfaffine what = {.hurst = 0.8, .rms_slope = 0.05, .seed = 3};
    const struct rc_problem contact = {
        .pair = {.estar = 1e11}, .load = 0.05, .tol = 1e-9, .threads = 1};
    struct rc_heat_problem problem = steel(0);
    struct rc_conductance truth;
    struct rc_contact result;
    struct rc_solver *s;
    struct rc_heat *h;
    struct rc_err err = {""};
    (void)state;

    assert_int_equal(rc_synth_selfaffine(&shape, &what, heights, &err), RC_OK);
    s = rc_solver_new(&shape, heights, &contact, &err);
    while (rc_solver_step(s) == RC_MORE)
        continue;
    rc_solver_result(s, NULL, NULL, &result);
    assert_int_equal(rc_solver_conductance(s, 45, 16, &truth, &err), RC_OK);
    problem.body[1] = (struct rc_heat_body){16, 4e-6, {0, 0}, 1};
    problem.body[0].bulk = 11;
    problem.tol = 1e-10;
    h = run(&shape, &problem, zero, rc_solver_pressure(s));
    near(-rc_heat_result(h)->heat_power_1 / 10, truth.value, 1e-7 * truth.value, "conductance");
    rc_heat_free(h);
    rc_solver_free(s);
}

/* A share in time: with the heat of Hertz's pressure, fewer steps against 64. */
static void
time_steps(void **state)
{
    static const size_t times[] = {64, 16, 4, 2, 1};
    static const double error[] = {0, 3e-5, 1e-3, 4e-3, 4e-2};
    double found[5];
    (void)state;

    set_heat();
    for (int k = 0; k < 5; k++) {
        struct rc_heat_problem problem = steel(20);
        struct rc_heat *h;
        problem.time = 1e-6; /* a quarter of a^2/kap */
        problem.time_steps = times[k];
        problem.tol = 1e-6;
        h = run(&shape, &problem, q, NULL);
        found[k] = rc_heat_result(h)->max_temperature;
        near(found[k], found[0], error[k] * found[0], "largest temperature after time steps");
        rc_heat_free(h);
    }
    assert_true(found[4] > 1.001 * found[0]);
}

/* ---- one node in contact: a dense program ---- */

/* The temperature of the middle of a cell, a time after its heat of 1 began: by the rule of the middle. */
static double
response(const struct rc_heat_body *body, double t)
{
    const double p = body->velocity[0] / (2 * body->diffusivity);
    const size_t n = 2000;
    const double end = 2 * sqrt(body->diffusivity * t);
    double sum = 0;

    for (size_t k = 0; k < n; k++) {
        const double tau = end * ((double)k + 0.5) / (double)n, moved = p * tau * tau / 2;
        sum += (erf((0.5e-6 - moved) / tau) + erf((0.5e-6 + moved) / tau)) / 2 * erf(0.5e-6 / tau);
    }
    return end / (double)n * sum / (body->conductivity * sqrt(RC_PI));
}

/* The temperature after n steps of constant heat, which equal temperatures in their middles determine. */
static double
by_middles(const struct rc_heat_problem *p, size_t n, double heat)
{
    static double flux[400], c[2][801]; /* response after half steps */
    double t[2] = {0, p->body[1].bulk};

    for (size_t k = 0; k <= 2 * n; k++)
        for (int b = 0; b < 2; b++)
            c[b][k] = response(&p->body[b], p->time * (double)k / (double)(2 * n));
    for (size_t at = 0; at < n; at++) {
        double differs = p->body[1].bulk + c[1][2 * at + 1] * heat;
        for (size_t k = 0; k < at; k++)
            for (int b = 0; b < 2; b++)
                differs -= flux[k] * (c[b][2 * (at - k) + 1] - c[b][2 * (at - k) - 1]);
        flux[at] = differs / (c[0][1] + c[1][1]);
    }
    for (size_t k = 0; k < n; k++) {
        t[0] += flux[k] * (c[0][2 * (n - k)] - c[0][2 * (n - k - 1)]);
        t[1] += (heat - flux[k]) * (c[1][2 * (n - k)] - c[1][2 * (n - k - 1)]);
    }
    return (t[0] + t[1]) / 2;
}

/* The error of the time steps is below the estimate, and steps of linear heat are of second order. */
static void
one_node(void **state)
{
    const struct rc_shape s = {3, 3, 1e-6, 1e-6};
    static const double speed[] = {0, 30, 300}, ends[] = {1e-8, 1e-6, 3e-5};
    (void)state;

    memset(q, 0, sizeof q);
    q[4] = 1e9;
    for (int k = 0; k < 9; k++) {
        struct rc_heat_problem problem = steel(speed[k % 3]);
        const struct rc_heat_figures *f;
        struct rc_err err = {""};
        struct rc_heat *h;
        double truth, other, rise;
        problem.body[0] = (struct rc_heat_body){16, 1e-6, {0, 0}, 0};
        problem.body[1].bulk = k == 4 ? 10 : 0;
        problem.time = ends[k / 3];
        other = by_middles(&problem, 200, q[4]);
        truth = by_middles(&problem, 400, q[4]);
        for (size_t n = 4; n <= 64; n *= 4) {
            problem.time_steps = n;
            problem.tol = 1e-9;
            h = run(&s, &problem, q, NULL);
            near(rc_heat_result(h)->max_temperature, truth,
                 pow((double)n, -1.5) * 0.04 * truth + 3 * fabs(truth - other),
                 "time steps of one node");
            rc_heat_free(h);
        }
        problem.time_steps = 0;
        problem.tol = 1e-4;
        h = rc_heat_new(&s, &problem, q, NULL, &err);
        assert_non_null(h);
        while (rc_heat_step(h, &err) == RC_MORE)
            continue;
        f = rc_heat_result(h);
        rise = truth - fmin(0, problem.body[1].bulk);
        assert_true(f->converged && f->time_error <= 1e-4);
        near(f->max_temperature, truth, (f->time_error + f->mismatch) * rise + fabs(truth - other),
             "time steps of its own");
        rc_heat_free(h);
    }
}

/* Where like bodies move alike the share is 1/2 at all times, and time steps change nothing. */
static void
no_change(void **state)
{
    static double t[2][N * N];
    struct rc_err err = {""};
    (void)state;

    set_heat();
    for (int repeats = 0; repeats < 4; repeats++)
        for (int depth = 0; depth < 2; depth++) {
            for (int k = 0; k < 2; k++) {
                struct rc_heat_problem problem = steel(0);
                struct rc_heat *h;
                problem.boundary = rc_boundary_of(repeats & 1, repeats & 2);
                for (int b = 0; b < 2 && repeats > 0; b++) {
                    problem.body[b].velocity[0] = repeats & 1 ? 3000 : depth;
                    problem.body[b].velocity[1] = repeats & 1 ? depth : 3000;
                }
                problem.time = 4e-6;
                problem.time_steps = 1 + 6 * (size_t)k;
                problem.tol = 1e-9;
                h = run(&shape, &problem, q, NULL);
                assert_int_equal(rc_heat_temperature(h, 1, depth * 1e-6, t[k], &err), RC_OK);
                rc_heat_free(h);
            }
            for (int k = 0; k < N * N; k++)
                near(t[1][k], t[0][k], 1e-8 * fabs(t[0][20 + 25 * N]), "time steps of like bodies");
        }
}

/* ---- estimates and work ---- */

static uint64_t seed;

static double
number(void) /* 0 to 1 */
{
    seed = seed * 6364136223846793005U + 1442695040888963407U;
    return (double)(seed >> 11) / 9007199254740992.0;
}

/* Spots of 2 to 10 nodes radius, on a tenth of the map, each with Hertz's pressure. */
static void
set_spots(size_t n, double radius)
{
    memset(q, 0, n * n * sizeof *q);
    for (double area = 0; area < 0.1 * (double)(n * n); area += RC_PI * radius * radius) {
        const double x = number() * (double)n, y = number() * (double)n;
        for (size_t k = 0; k < n * n; k++) {
            const double r =
                (pow((double)(k % n) - x, 2) + pow((double)(k / n) - y, 2)) / (radius * radius);
            q[k] = r < 1 ? fmax(q[k], 1e9 * sqrt(1 - r)) : q[k];
        }
    }
}

/* The steps do not grow with the map: with an inverse that neglects the temperatures off the contact they
 * were 5 and 6. */
static void
steps(void **state)
{
    (void)state;
    for (size_t n = 64; n <= MOST; n *= 2) {
        const struct rc_shape s = {n, n, 1e-6, 1e-6};
        struct rc_heat *h;
        struct rc_heat_problem problem = steel(10);
        seed = 5;
        set_spots(n, 3);
        h = run(&s, &problem, q, NULL);
        if (rc_heat_result(h)->iterations > 4)
            fail_msg("%zu steps for %zu x %zu nodes", rc_heat_result(h)->iterations, n, n);
        rc_heat_free(h);
    }
}

/* K: the largest rise of a body above its bulk temperature, in contact. */
static double
largest_rise(const struct rc_shape *s, struct rc_heat *h, double drop)
{
    static double map[MOST * MOST];
    struct rc_err err = {""};
    double most = 0;

    for (int b = 0; b < 2; b++) {
        assert_int_equal(rc_heat_temperature(h, b, 0, map, &err), RC_OK);
        for (size_t k = 0; k < s->nx * s->ny; k++)
            if (q[k] != 0)
                most = fmax(most, fabs(map[k] - (b == 1 ? drop : 0)));
    }
    return most;
}

/* The bulk temperature of body 2 may be far from that of body 1: the error is relative to the largest rise,
 * beside which the largest temperature may be small. */
static void
estimates(void **state)
{
    const size_t cases = thorough(100, 4), n = 64;
    const struct rc_shape s = {n, n, 1e-6, 1e-6};
    double largest = 0;
    size_t most = 0;
    (void)state;

    for (size_t c = 0; c < cases; c++) {
        const double k[2] = {pow(10, 1 + number()), pow(10, 1 + number())};
        const double spot = 2 + 8 * number(), speed = pow(10, 4 * number() - 2);
        const struct rc_boundary boundary =
            rc_boundary_of(c % 4 == 2 || c % 4 == 3, c % 4 == 1 || c % 4 == 3);
        struct rc_heat_problem problem = {.boundary = boundary,
                                          .body = {{k[0], 1e-5 * (0.2 + number()), {0, 0}, 0},
                                                   {k[1],
                                                    1e-5 * (0.2 + number()),
                                                    {speed, c % 3 == 2 ? speed * number() : 0},
                                                    0}},
                                          .threads = 1};
        struct rc_heat *rough, *tight;
        double error;
        seed += c;
        set_spots(n, spot);
        if (c % 4 == 3 || c % 16 == 4 || (c % 4 > 0 && c % 7 != 6))
            problem.time = 1e-5 * pow(100, number());
        if (c % 8 == 3)
            problem.time_steps = 3;
        if (c % 5 == 2)
            problem.body[1].bulk = (number() < 0.5 ? 20 : 2000) * (number() - 0.5);
        if (c % 7 == 6)
            problem.body[0].velocity[0] = problem.body[0].velocity[1] = -speed * number();
        if (c % 4 == 2) /* along the free axis */
            problem.body[1].velocity[1] = speed;
        rough = run(&s, &problem, q, NULL);
        problem.tol = 1e-8;
        tight = run(&s, &problem, q, NULL);
        error =
            fabs(rc_heat_result(rough)->max_temperature - rc_heat_result(tight)->max_temperature) /
            largest_rise(&s, tight, problem.body[1].bulk);
        if (!(error <= rc_heat_result(rough)->mismatch))
            fail_msg("case %zu: the largest temperature is off by %g, the mismatch is %g", c, error,
                     rc_heat_result(rough)->mismatch);
        largest = fmax(largest, error / rc_heat_result(rough)->mismatch);
        most = rc_heat_result(rough)->iterations > most ? rc_heat_result(rough)->iterations : most;
        rc_heat_free(rough);
        rc_heat_free(tight);
    }
    print_message("%zu cases: largest error %.2f of the mismatch, at most %zu iterations\n", cases,
                  largest, most);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(elastic),         cmocka_unit_test(directions),
        cmocka_unit_test(periodic),        cmocka_unit_test(column),
        cmocka_unit_test(turned),          cmocka_unit_test(equal_rows),
        cmocka_unit_test(no_steady_state), cmocka_unit_test(hot_row),
        cmocka_unit_test(charron),         cmocka_unit_test(conductance),
        cmocka_unit_test(time_steps),      cmocka_unit_test(no_change),
        cmocka_unit_test(one_node),        cmocka_unit_test(steps),
        cmocka_unit_test(estimates),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
