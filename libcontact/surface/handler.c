/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * GSL has one error handler for all threads, and the default one ends the process: it is off while at least
 * one thread uses GSL. If each thread restored the handler that it found, the last could leave it off for
 * good. Another could also switch it on while a third thread still uses GSL.
 */
#include "handler.h"

#include <gsl/gsl_errno.h>
#include <pthread.h>
#include <stddef.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static size_t users;                 /* threads between begin and end */
static gsl_error_handler_t *callers; /* the handler before the first began */

void
rc_handler_begin(void)
{
    pthread_mutex_lock(&lock);
    if (users++ == 0)
        callers = gsl_set_error_handler_off();
    pthread_mutex_unlock(&lock);
}

void
rc_handler_end(void)
{
    pthread_mutex_lock(&lock);
    if (--users == 0)
        gsl_set_error_handler(callers);
    pthread_mutex_unlock(&lock);
}
