/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A thousand solves of different sizes in one process leave its memory unchanged. Two solvers in two threads
 * at a time give the same results as alone, to the last bit. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <malloc.h>
#include <pthread.h>
#include <unistd.h>

#include "tests/contact_case.h"

enum {
    SOLVES = 1000,
    WARM = 200,  /* after this number FFTW and the allocator hold all their permanent memory */
    SIDE = 97,   /* largest number of nodes along a side */
    PAIRS = 200, /* number of solves of each of two threads */
    N = SIDE * SIDE
};

/* The memory, in MiB, that a run may hold more than the run before. It is fragments, not maps (one leaked map
 * per solve would be 12 MiB at the end). */
static const double growth_most = 4;

static size_t
pages_held(void)
{
    FILE *f = fopen("/proc/self/statm", "r");
    unsigned long all, held = 0;

    if (f == NULL)
        return 0;
    if (fscanf(f, "%lu %lu", &all, &held) != 2)
        held = 0;
    fclose(f);
    return held;
}

static double
mib_held(void)
{
#ifdef __GLIBC__
    malloc_trim(0); /* free memory that was not returned to the system is not a leak */
#endif
    return (double)pages_held() * (double)sysconf(_SC_PAGESIZE) / (1 << 20);
}

/* Problem k: cycles through sizes, boundaries, engines, methods and materials. */
static void
make(size_t k, struct rc_shape *shape, struct rc_problem *problem, double *h)
{
    static const struct rc_layer layer = {3e-6, 4e9, 0.3};
    static const struct rc_body coating = {.layers = 1, .layer = &layer, .e = 1e9, .nu = 0.4};
    static const char *const engines[] = {NULL, "fft", "mlms"};
    struct rc_selfaffine what = {.hurst = 0.8, .rms_slope = 0.1, .short_cut = 8e-6, .seed = 1 + k};

    *shape = (struct rc_shape){17 + k * 31 % (SIDE - 16), 17 + k * 47 % (SIDE - 16), 1.1e-6, 1e-6};
    *problem = (struct rc_problem){.pair.estar = 1e9,
                                   .boundary = k % 2 == 0 ? RC_FREE : RC_PERIODIC,
                                   .hardness = k % 3 == 0 ? 5e7 : 0,
                                   .method = k % 5 == 4 ? "pk99" : NULL,
                                   .engine = k % 2 == 0 ? engines[k % 3] : NULL,
                                   .discretization = k % 11 == 0,
                                   .tol = 1e-4,
                                   .threads = 1};
    if (k % 7 == 6 && k % 2 == 1)
        problem->pair = (struct rc_pair){.one = coating};
    problem->load = 2e6 * (double)(shape->nx * shape->ny) * shape->dx * shape->dy;
    if (rc_synth_selfaffine(shape, &what, h, NULL) != RC_OK)
        abort();
}

/* Pressure of problem k into p; false: not solved. */
static bool
solve_one(size_t k, double *p)
{
    struct rc_shape shape;
    struct rc_problem problem;
    struct rc_contact contact;
    struct rc_solver *solver;
    double h[N], stiffness;
    enum rc_status status;

    make(k, &shape, &problem, h);
    if ((solver = rc_solver_new(&shape, h, &problem, NULL)) == NULL)
        return false;
    while ((status = rc_solver_step(solver)) == RC_MORE)
        continue;
    rc_solver_result(solver, NULL, NULL, &contact);
    if (k % 13 == 0 && rc_solver_stiffness(solver, &stiffness, NULL) != RC_OK)
        status = RC_FAIL;
    memcpy(p, rc_solver_pressure(solver), shape.nx * shape.ny * sizeof *p);
    rc_solver_free(solver);
    return status == RC_OK && fabs(contact.load / problem.load - 1) < 1e-6;
}

static void
a_thousand_solves(void **state)
{
    static double p[N];
    double before = 0, after;
    size_t solved = 0;

    (void)state;
    for (size_t k = 0; k < WARM + SOLVES; k++) {
        if (k == WARM)
            before = mib_held();
        solved += solve_one(k % 401, p);
    }
    after = mib_held();
    printf("%d solves: %.1f MiB held before, %.1f after\n", SOLVES, before, after);
    assert_int_equal(solved, WARM + SOLVES);
    assert_true(before > 0);
    (void)growth_most;
#if !defined(__SANITIZE_ADDRESS__) /* which holds freed memory */
    assert_true(after - before < growth_most);
#endif
}

struct half {
    size_t first, wrong;
    double *alone; /* PAIRS maps of N */
};

static void *
run_half(void *arg)
{
    struct half *half = arg;
    double p[N];

    for (size_t k = 0; k < PAIRS; k++) {
        memset(p, 0, sizeof p);
        half->wrong +=
            !solve_one(half->first + k, p) || memcmp(p, half->alone + k * N, sizeof p) != 0;
    }
    return NULL;
}

static void
two_threads(void **state)
{
    struct half half[2] = {{.first = 0}, {.first = 100}};
    pthread_t thread[2];

    (void)state;
    for (size_t t = 0; t < 2; t++) {
        half[t].alone = calloc((size_t)PAIRS * N, sizeof(double));
        assert_non_null(half[t].alone);
        for (size_t k = 0; k < PAIRS; k++)
            assert_true(solve_one(half[t].first + k, half[t].alone + k * N));
    }
    for (size_t t = 0; t < 2; t++)
        assert_int_equal(pthread_create(&thread[t], NULL, run_half, &half[t]), 0);
    for (size_t t = 0; t < 2; t++)
        assert_int_equal(pthread_join(thread[t], NULL), 0);
    for (size_t t = 0; t < 2; t++) {
        assert_int_equal(half[t].wrong, 0);
        free(half[t].alone);
    }
    printf("2 threads, %d solves each: as alone, to the last bit\n", PAIRS);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_thousand_solves),
        cmocka_unit_test(two_threads),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
