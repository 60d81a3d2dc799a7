/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Two locks. fftw_make_planner_thread_safe switches on FFTW's own lock for the whole process. Every call of
 * its planner then takes the lock, also calls from the program that uses this library. It is switched on when
 * this library is loaded. A thread that is planning at that moment would leave it unlocked for good.
 * libfftw3_omp has the same function, but there it does nothing. If the program loads libfftw3_omp first,
 * this library's own lock still protects its plans.
 */
#include "planner.h"

#include <complex.h> /* before fftw3.h: its complex numbers are then C's own */
#include <fftw3.h>
#include <pthread.h>

static pthread_once_t once = PTHREAD_ONCE_INIT;
static pthread_mutex_t own = PTHREAD_MUTEX_INITIALIZER;

static void
switch_on(void)
{
    fftw_make_planner_thread_safe();
    fftwf_make_planner_thread_safe();
}

#if defined(__GNUC__)
__attribute__((constructor)) static void
at_load(void)
{
    pthread_once(&once, switch_on);
}
#endif

void
rc_planner_lock(void)
{
    pthread_once(&once, switch_on); /* where there is no constructor */
    pthread_mutex_lock(&own);
}

void
rc_planner_unlock(void)
{
    pthread_mutex_unlock(&own);
}
