/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Threads that call GSL through the library at the same time never call the error handler that the caller has
 * set. It is still set afterwards. */
#include <gsl/gsl_errno.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>

#include "maps.h"

enum {
    ROUNDS = 50,
    FITS = 20,
    SURFACES = 4,
    NX = 33,
    NY = 47
};

static const struct rc_shape shape = {NX, NY, 1.1e-6, 1e-6};
static atomic_size_t called, wrong;

static void
callers_own(const char *reason, const char *file, int line, int number)
{
    (void)reason, (void)file, (void)line, (void)number;
    called++;
}

/* Points in one row do not determine a plane, and GSL reports that the equations are singular. */
static void *
detrend(void *unused)
{
    struct rc_form plane = {.degree = 1, .threads = 1};
    double h[NX * NY];

    (void)unused;
    for (size_t n = 0; n < FITS; n++) {
        for (size_t k = 0; k < NX * NY; k++)
            h[k] = k / NX == 5 ? 1 : NAN;
        wrong += rc_detrend_form(&shape, &plane, h, NULL, NULL) != RC_FAIL;
    }
    return NULL;
}

static void *
synthesise(void *unused)
{
    struct rc_selfaffine what = {.hurst = 0.7, .rms_height = 1e-7, .seed = 1927, .skewness = -1.5};
    double h[NX * NY];

    (void)unused;
    for (size_t n = 0; n < SURFACES; n++)
        wrong += rc_synth_selfaffine(&shape, &what, h, NULL) != RC_OK;
    return NULL;
}

/* In rounds: the handler is checked when the threads of a round have ended. */
static void
test_handler_stays_and_is_not_called(void **state)
{
    void *(*const work[])(void *) = {detrend, synthesise, detrend};
    pthread_t thread[3];

    (void)state;
    gsl_set_error_handler(callers_own);
    for (size_t round = 0; round < ROUNDS; round++) {
        for (size_t t = 0; t < 3; t++)
            assert_int_equal(pthread_create(&thread[t], NULL, work[t], NULL), 0);
        for (size_t t = 0; t < 3; t++)
            pthread_join(thread[t], NULL);
        assert_ptr_equal(gsl_set_error_handler(callers_own), callers_own);
    }
    assert_int_equal(called, 0);
    assert_int_equal(wrong, 0);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_handler_stays_and_is_not_called),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
