/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The cost of a body that yields in its volume:
 *
 *     bench-plastic [increment] [loads]       (default: both)
 *
 * increment  one load in one increment: applications of the volume's operator, processor seconds on one
 *            thread, and the error of the pressure after each, on the heights that bench/peers/plastic.py
 *            gives Tamaas
 * loads      one load of 16 increments on 256 x 256 and 1024 x 1024 nodes, 12 slabs: applications, seconds,
 *            estimated errors
 *
 * Pressures over E, lengths over the spacing. RC_THREADS sets the threads of `loads`.
 */
#include "bench.h"
#include "libcontact/yield/yield.h"

#include <time.h>

enum {
    SLABS = 12,
    STEPS = 64
};

static struct rc_yield_problem
problem_of(const double *thickness, size_t increments)
{
    return (struct rc_yield_problem){
        .contact = {.boundary = RC_PERIODIC,
                    .pair = {.one = {.e = 1, .nu = 0.3}, .two = {.e = INFINITY}}},
        .law = {.stress = 0.04, .modulus = 0.01},
        .slabs = SLABS,
        .thickness = thickness,
        .increments = increments};
}

static double *
rough(struct rc_shape shape, double rolloff)
{
    const struct rc_selfaffine what = {
        .hurst = 0.8, .rms_slope = 0.25, .rolloff = rolloff, .short_cut = 6.4, .seed = 2};
    double *h = map_new(shape.nx * shape.ny);
    struct rc_err err;

    must_be(rc_synth_selfaffine(&shape, &what, h, &err), &err);
    return h;
}

static double
processor(void)
{
    struct timespec t;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The pressure after each application; returns their number; `end`: the pressure after the load. */
static size_t
follow(struct rc_shape shape, const double *h, struct rc_yield_problem problem, double load,
       double *after, double *seconds, double *end)
{
    size_t n = shape.nx * shape.ny, count = 0;
    double began = processor();
    struct rc_yield_solver *plastic;
    enum rc_status status;
    struct rc_err err;

    plastic = must(rc_yield_solver_new(&shape, h, &problem, &err));
    must_be(rc_yield_solver_set_load(plastic, load, &err), &err);
    do {
        status = rc_yield_solver_step(plastic, &err);
        if (after != NULL && count < STEPS && count < plastic->figures.applications) {
            seconds[count] = processor() - began;
            memcpy(after + n * count++, rc_solver_pressure(plastic->solver), n * sizeof *after);
        }
    } while (status == RC_MORE);
    if (status == RC_FAIL)
        must_be(status, &err);
    memcpy(end, rc_solver_pressure(plastic->solver), n * sizeof *end);
    rc_yield_solver_free(plastic);
    return count;
}

static void
increment(void)
{
    const struct rc_shape shape = {64, 64, 1, 1};
    const size_t n = shape.nx * shape.ny;
    const double load = 0.02 * (double)n;
    double thickness[SLABS], seconds[STEPS], *h = rough(shape, 16), *after = map_new(STEPS * n);
    double *truth = map_new(n), *end = map_new(n);
    struct rc_yield_problem problem;
    size_t count;

    for (size_t k = 0; k < SLABS; k++)
        thickness[k] = 1;
    problem = problem_of(thickness, 1);
    problem.contact.threads = 1;
    problem.contact.tol = 1e-4; /* as in rc-solve */
    count = follow(shape, h, problem, load, after, seconds, end);
    problem.lag = 1e-9;
    problem.precise = true;
    problem.contact.tol = 1e-10;
    (void)follow(shape, h, problem, load, NULL, NULL, truth);
    printf("%12s %10s %10s\n", "applications", "cpu, s", "error of p");
    for (size_t k = 0; k < count; k++)
        printf("%12zu %10.4f %10.1e\n", k + 1, seconds[k], error_l1(n, after + n * k, truth));
    printf("%12s %10s %10.1e\n", "end", "", error_l1(n, end, truth));
    free(h);
    free(after);
    free(truth);
    free(end);
}

static void
load_of(size_t side)
{
    const struct rc_shape shape = {side, side, 1, 1};
    const size_t n = side * side;
    double thickness[SLABS], *h = rough(shape, (double)side / 4), start;
    struct rc_yield_problem problem = problem_of(thickness, 16);
    const struct rc_yield_load *f;
    const double *p;
    struct rc_yield_solver *plastic;
    enum rc_status status;
    struct rc_err err;
    size_t touching = 0;

    for (size_t k = 0; k < SLABS; k++)
        thickness[k] = 0.5 * pow(1.25, (double)k);
    problem.contact.threads = threads_wanted();
    problem.contact.tol = 1e-4;
    start = now();
    plastic = must(rc_yield_solver_new(&shape, h, &problem, &err));
    must_be(rc_yield_solver_set_load(plastic, 0.0155 * (double)n, &err), &err);
    while ((status = rc_yield_solver_step(plastic, &err)) == RC_MORE)
        ;
    if (status == RC_FAIL)
        must_be(status, &err);
    start = now() - start;
    f = &plastic->figures;
    p = rc_solver_pressure(plastic->solver);
    for (size_t k = 0; k < n; k++)
        touching += p[k] > 0;
    printf("%6zu %8zu %8.3f %12zu %8.2f %10.1e %9.2f\n", side, threads_wanted(),
           (double)touching / (double)n, f->applications, start, f->error,
           (double)f->voxels / (double)(n * SLABS));
    rc_yield_solver_free(plastic);
    free(h);
}

static void
loads(void)
{
    printf("%6s %8s %8s %12s %8s %10s %9s\n", "nodes", "threads", "contact", "applications", "s",
           "estimate", "yielded");
    load_of(256);
    load_of(1024);
}

int
main(int argc, char **argv)
{
    const struct part parts[] = {{"increment", increment, false}, {"loads", loads, false}};

    return parts_run(2, parts, argc - 1, argv + 1);
}
