/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Threads that use the library at the same time get the same results as one thread. Their program plans its
 * own transforms with FFTW. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <complex.h> /* before fftw3.h: its complex numbers are then C's own */
#include <fftw3.h>
#include <pthread.h>

#include "tests/contact_case.h"

enum {
    WORKERS = 12,
    PIECES = 60, /* kinds of work: each worker does all of them */
    ROUNDS = 4,  /* so many times                         */
    N = 48 * 48  /* most values that a piece of work returns */
};

/* Piece k of the work of one kind: writes its results to the front of out. */
typedef void work(size_t k, double *out);

static struct rc_shape
some_shape(size_t k)
{
    return (struct rc_shape){17 + k * 7 % 32, 15 + k * 11 % 34, 1.1e-6, 1e-6};
}

static void
some_pressure(const struct rc_shape *s, double *p)
{
    uint64_t seed = 1927;

    for (size_t i = 0; i < s->nx * s->ny; i++)
        p[i] = 1e6 * fmax(0, random_number(&seed));
}

/* ---- the library's ---- */

static void
convolve(size_t k, double *out)
{
    struct rc_shape s = some_shape(k);
    struct rc_conv_options o = {.engine = "fft", .tol = k % 2 == 0 ? 0 : 1e-3, .threads = 1};
    struct rc_conv *conv;
    double p[N];

    o.boundary = k % 3 == 0 ? RC_PERIODIC : RC_FREE;
    some_pressure(&s, p);
    if ((conv = rc_conv_new(&s, &(struct rc_pair){.estar = 1e9}, &o, NULL)) != NULL)
        rc_conv_apply(conv, p, out);
    rc_conv_free(conv);
}

static void
stress(size_t k, double *out)
{
    struct rc_shape s = some_shape(k);
    struct rc_stress_options o = {.body.nu = 0.3, .wanted = 1 << RC_SXZ, .threads = 1};
    double *slice[RC_STRESSES] = {[RC_SXZ] = out}, p[N];
    struct rc_stress *plan;

    o.section = k % 3 == 0 ? 'y' : 0;
    some_pressure(&s, p);
    if ((plan = rc_stress_new(&s, p, &o, NULL)) != NULL)
        rc_stress_slice(plan, 2e-6, slice, NULL);
    rc_stress_free(plan);
}

static void
roughness(size_t k, double *out)
{
    struct rc_shape s = some_shape(k);
    struct rc_selfaffine what = {.hurst = 0.7, .rms_height = 1e-7, .seed = k};

    rc_synth_selfaffine(&s, &what, out, NULL);
}

/* ---- the program's own ---- */

static void
own_double(size_t k, double *out)
{
    size_t nx = 30 + k * 5 % 17, ny = 30 + k * 3 % 17;
    fftw_complex *a = fftw_malloc(nx * ny * sizeof *a), *b = fftw_malloc(nx * ny * sizeof *b);
    fftw_plan plan = fftw_plan_dft_2d((int)ny, (int)nx, a, b, FFTW_FORWARD, FFTW_ESTIMATE);

    for (size_t i = 0; i < nx * ny; i++)
        a[i] = (double)(i * i % 101);
    fftw_execute(plan);
    for (size_t i = 0; i < nx * ny; i++)
        out[i] = cabs(b[i]);
    fftw_destroy_plan(plan);
    fftw_free(a);
    fftw_free(b);
}

static void
own_single(size_t k, double *out)
{
    size_t n = 1000 + k * 37 % 1200;
    float *a = fftwf_malloc(n * sizeof *a), *b = fftwf_malloc(n * sizeof *b);
    fftwf_plan plan = fftwf_plan_r2r_1d((int)n, a, b, FFTW_R2HC, FFTW_ESTIMATE);

    for (size_t i = 0; i < n; i++)
        a[i] = (float)(i * i % 101);
    fftwf_execute(plan);
    for (size_t i = 0; i < n; i++)
        out[i] = (double)b[i];
    fftwf_destroy_plan(plan);
    fftwf_free(a);
    fftwf_free(b);
}

/* ---- together ---- */

struct worker {
    work *run;
    size_t number;
    double (*got)[N]; /* got of each piece */
    size_t differ;    /* number of later rounds with another result */
};

static void *
worker_run(void *at)
{
    struct worker *w = at;

    for (size_t k = 0; k < ROUNDS * PIECES; k++) {
        size_t piece = (k + 5 * w->number) % PIECES;
        double out[N] = {0};
        w->run(piece, out);
        if (k < PIECES)
            memcpy(w->got[piece], out, sizeof out);
        else
            /* compares bits, not values */
            /* NOLINTNEXTLINE(bugprone-suspicious-memory-comparison,cert-exp42-c,cert-flp37-c) */
            w->differ += memcmp(out, w->got[piece], sizeof out) != 0;
    }
    return NULL;
}

/* First all at once, then one after another, so that the library makes its first plans while other threads
 * plan. */
static void
beside_each_other(work *const *kinds, size_t n)
{
    struct worker worker[WORKERS];
    pthread_t thread[WORKERS];

    for (size_t t = 0; t < WORKERS; t++) {
        worker[t] = (struct worker){kinds[t % n], t, calloc(PIECES, sizeof(double[N])), 0};
        assert_non_null(worker[t].got);
    }
    for (size_t t = 0; t < WORKERS; t++)
        assert_int_equal(pthread_create(&thread[t], NULL, worker_run, &worker[t]), 0);
    for (size_t t = 0; t < WORKERS; t++)
        pthread_join(thread[t], NULL);
    for (size_t t = 0; t < WORKERS; t++) {
        for (size_t k = 0; k < PIECES; k++) {
            double out[N] = {0};
            worker[t].run(k, out);
            assert_true(out[3] != 0);
            assert_memory_equal(out, worker[t].got[k], sizeof out);
        }
        assert_int_equal(worker[t].differ, 0);
        free(worker[t].got);
    }
}

static void
beside_another_user_of_fftw(void **state)
{
    static work *const kinds[] = {convolve, own_double, stress, own_single, roughness, own_double};

    (void)state;
    beside_each_other(kinds, 6);
}

/* Functions of FFTW that its headers do not declare; FFTW calls the installed hooks before and after each use
 * of its planner. */
extern void fftw_set_planner_hooks(void (*before)(void), void (*after)(void));
extern void fftwf_set_planner_hooks(void (*before)(void), void (*after)(void));

/* Also without FFTW's lock, as in a program that links libfftw3_omp, whose lock does nothing. */
static void
beside_themselves(void **state)
{
    static work *const kinds[] = {convolve, stress, roughness};

    (void)state;
    fftw_set_planner_hooks(NULL, NULL);
    fftwf_set_planner_hooks(NULL, NULL);
    beside_each_other(kinds, 3);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(beside_another_user_of_fftw),
        cmocka_unit_test(beside_themselves),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
