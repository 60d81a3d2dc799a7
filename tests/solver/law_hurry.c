/* SPDX-License-Identifier: GPL-3.0-or-later */
/* If the caller sets the flag `hurry`, a solver stops at once in any state. It does no further convolution
 * unless no gap exists yet. It carries the load, gives the displacement of the pressure to single precision,
 * and never reports a wrong convergence. Without the flag nothing changes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <sys/time.h>

#include "libcontact/operator/operator.h"
#include "tests/contact_case.h"

enum {
    NX = 150,
    NY = 132,
    N = NX * NY
};
static const struct rc_shape shape = {NX, NY, 1e-6, 1.1e-6};
static const double estar = 10e9, tol = 1e-7;
static volatile sig_atomic_t hurry;

static struct rc_problem
rough(struct rc_boundary boundary, double *h)
{
    struct rc_selfaffine what = {
        .hurst = 0.8, .rms_slope = 0.1, .rolloff = 30e-6, .short_cut = 4.4e-6, .seed = 11};
    struct rc_err err;

    assert_int_equal(rc_synth_selfaffine(&shape, &what, h, &err), RC_OK);
    return (struct rc_problem){.boundary = boundary,
                               .pair.estar = estar,
                               .load = 0.01 * estar * N * shape.dx * shape.dy,
                               .tol = tol,
                               .method = contact_method};
}

/* True if u equals K p, summed directly or transformed in double precision, to this fraction of the largest
 * u. */
static bool
displaced(double within, struct rc_boundary boundary, const double *p, const double *u)
{
    const struct rc_pair pair = {.estar = estar};
    const struct rc_conv_options options = {.boundary = boundary,
                                            .engine =
                                                rc_repeats(boundary) == 0 ? "direct" : "fft64",
                                            .threads = 1};
    struct rc_err err;
    struct rc_conv *conv = rc_conv_new(&shape, &pair, &options, &err);
    double *right = malloc(N * sizeof *right), most = 0, largest = 0;

    assert_non_null(conv);
    rc_conv_apply(conv, p, right);
    for (size_t k = 0; k < N; k++) {
        most = fmax(most, fabs(u[k] - right[k]));
        largest = fmax(largest, fabs(right[k]));
    }
    rc_conv_free(conv);
    free(right);
    /* 10 nm: on a periodic map a uniform pressure causes no displacement */
    return most <= within * fmax(largest, 1e-8);
}

/* Sets the flag after the given number of steps, and with `again` before one more; true if the solution had
 * been found before. */
static bool
stopped_after(size_t steps, bool again, struct rc_boundary boundary, const double *h,
              struct rc_problem problem)
{
    double *u = malloc(N * sizeof *u), *before = malloc(N * sizeof *before), convolutions, sum = 0;
    struct rc_err err;
    struct rc_solver *solver;
    struct rc_progress at;
    struct rc_contact c;
    enum rc_status status = RC_MORE;

    problem.hurry = &hurry;
    hurry = 0;
    solver = rc_solver_new(&shape, h, &problem, &err);
    assert_non_null(solver);
    for (size_t k = 0; k < steps && status == RC_MORE; k++)
        status = rc_solver_step(solver);
    rc_solver_progress(solver, &at);
    memcpy(before, rc_solver_pressure(solver), N * sizeof *before);
    hurry = 1;
    convolutions = rc_solver_convolutions(solver);
    if (again && status == RC_MORE && !at.coarser) {
        assert_int_equal(rc_solver_step(solver), RC_MORE);
        assert_memory_equal(rc_solver_pressure(solver), before, N * sizeof *before);
    }
    rc_solver_result(solver, u, NULL, &c);
    for (size_t k = 0; k < N; k++)
        sum += rc_solver_pressure(solver)[k];
    assert_true(fabs(sum * shape.dx * shape.dy - problem.load) <= 1e-9 * problem.load);
    assert_true(c.converged == (status == RC_OK));
    /* the first gap of a grid, in single precision, if there is none yet */
    if (status == RC_MORE)
        assert_true(rc_solver_convolutions(solver) - convolutions <= 0.5 + 1e-9);
    assert_true(displaced(status == RC_OK ? 1e-12 : 3e-6, boundary, rc_solver_pressure(solver), u));
    rc_solver_free(solver);
    free(before);
    free(u);
    return status == RC_OK;
}

static void
stops(void **state)
{
    double *h = malloc(N * sizeof *h);

    (void)state;
    for (int b = 0; b < 2; b++) {
        struct rc_problem problem = rough(b == 0 ? RC_FREE : RC_PERIODIC, h);
        size_t steps = 0;
        while (!stopped_after(steps, true, (b == 0 ? RC_FREE : RC_PERIODIC), h, problem) &&
               !stopped_after(steps, false, (b == 0 ? RC_FREE : RC_PERIODIC), h, problem))
            steps++;
        assert_true(steps > 5);
    }
    free(h);
}

struct rows {
    size_t in, out, last; /* calls; the flag is set in this one */
};

static bool
count_in(void *at, size_t j, void *row)
{
    struct rows *r = at;

    memset(row, 0, NX * sizeof(float));
    ((float *)row)[j] = 1;
    hurry = r->in++ + r->out == r->last;
    return true;
}

static bool
count_out(void *at, size_t j, void *row)
{
    struct rows *r = at;

    (void)j;
    (void)row;
    hurry = r->out++ + r->in == r->last;
    return true;
}

/* A convolution reads and writes no row after the flag is set. */
static void
ends_a_convolution(void **state)
{
    const struct rc_pair pair = {.estar = estar};
    const struct rc_operator_options options = {.pair = &pair, .threads = 1};
    struct rc_err err;
    struct rc_operator *op = rc_operator_new(&shape, &options, &err);

    (void)state;
    assert_non_null(op);
    for (size_t last = 0; last <= 2 * NY; last++) {
        struct rows rows = {.last = last};
        hurry = 0;
        rc_fft_hurry = &hurry;
        rc_operator_apply_rows(op, count_in, count_out, &rows);
        rc_fft_hurry = NULL;
        assert_int_equal(rows.in + rows.out, last < 2 * NY ? last + 1 : 2 * NY);
    }
    rc_operator_free(op);
}

static void
set_flag(int number)
{
    (void)number;
    hurry = 1;
}

static double
now(void)
{
    struct timeval t;

    gettimeofday(&t, NULL);
    return (double)t.tv_sec + 1e-6 * (double)t.tv_usec;
}

/* Solves until a timer sets the flag. */
static enum rc_status
solve_until(struct rc_solver *solver, double seconds)
{
    const struct itimerval timer = {.it_value.tv_usec = 1 + (suseconds_t)(1e6 * seconds)},
                           none = {0};
    enum rc_status status = RC_MORE;

    hurry = 0;
    signal(SIGALRM, set_flag);
    setitimer(ITIMER_REAL, &timer, NULL);
    while (status == RC_MORE && hurry == 0)
        status = rc_solver_step(solver);
    setitimer(ITIMER_REAL, &none, NULL);
    return status;
}

/* Stops anywhere within steps. The pressure carries the load, and no estimate is below the true error. The
 * gap costs no convolution unless it is asked for. A solver whose flag is cleared continues to the
 * solution. */
static void
stops_within_steps(void **state)
{
    enum {
        TIMES = 40
    };
    double *h = malloc(N * sizeof *h), *u = malloc(N * sizeof *u), start, all;
    struct rc_problem problem = rough(RC_PERIODIC, h);
    struct solved right;
    size_t stopped = 0, unknown = 0;

    (void)state;
    hurry = 0;
    start = now();
    right = solve(shape, h, problem);
    all = now() - start;
    problem.hurry = &hurry;
    problem.threads = 1;
    for (size_t k = 0; k < TIMES; k++) {
        struct rc_err err;
        struct rc_solver *solver = rc_solver_new(&shape, h, &problem, &err);
        enum rc_status status = solve_until(solver, all * (double)(k + 1) / TIMES);
        double before = rc_solver_convolutions(solver), sum = 0, error = 0, total = 0;
        const double *p = rc_solver_pressure(solver);
        struct rc_contact c;

        hurry = 1;
        rc_solver_result(solver, k % 2 == 0 ? u : NULL, NULL, &c);
        for (size_t i = 0; i < N; i++) {
            sum += p[i];
            error += fabs(p[i] - right.p[i]);
            total += right.p[i];
        }
        assert_true(fabs(sum * shape.dx * shape.dy - problem.load) <= 1e-9 * problem.load);
        assert_true(c.converged == (status == RC_OK));
        assert_true(isnan(c.pressure_error) || c.pressure_error >= (1 - 1e-3) * error / total);
        assert_true(c.converged || k % 2 == 0 || rc_solver_convolutions(solver) <= before);
        if (k % 2 == 0)
            assert_true(displaced(status == RC_OK ? 1e-12 : 3e-6, RC_PERIODIC, p, u));
        if (k % 2 == 0)
            assert_true(c.mean_gap >= 0);
        assert_int_equal(isnan(c.mean_gap) ? 1 : 0, isnan(c.elastic_energy) ? 1 : 0);
        stopped += status == RC_MORE ? 1 : 0;
        unknown += isnan(c.mean_gap) ? 1 : 0;
        if (status == RC_MORE && k % 2 == 1) {
            hurry = 0;
            while ((status = rc_solver_step(solver)) == RC_MORE)
                continue;
            assert_int_equal(status, RC_OK);
        }
        rc_solver_free(solver);
    }
    assert_true(stopped > 0);
    if (getenv("RC_SHOW") != NULL)
        printf("%zu of %d stopped, %zu without a gap\n", stopped, TIMES, unknown);
    solved_free(&right);
    free(h);
    free(u);
}

/* A flag that stays 0 has no effect. */
static void
waits(void **state)
{
    double *h = malloc(N * sizeof *h);
    struct rc_problem problem = rough(RC_FREE, h);
    struct solved without = solve(shape, h, problem), with;

    (void)state;
    hurry = 0;
    problem.hurry = &hurry;
    with = solve(shape, h, problem);
    assert_memory_equal(with.p, without.p, N * sizeof *with.p);
    assert_memory_equal(with.u, without.u, N * sizeof *with.u);
    assert_memory_equal(with.gap, without.gap, N * sizeof *with.gap);
    solved_free(&with);
    solved_free(&without);
    free(h);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stops), cmocka_unit_test(ends_a_convolution),
        cmocka_unit_test(stops_within_steps), cmocka_unit_test(waits)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
