/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Maps for the tests of surfaces. */
#ifndef MAPS_H
#define MAPS_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "libcontact/contact.h"

/* Between -1 and 1. */
static inline double
chance(void)
{
    return 2.0 * rand() / RAND_MAX - 1;
}

/* A map of this shape without values; the caller frees it. */
static inline double *
new_map(const struct rc_shape *s)
{
    double *h = malloc(s->nx * s->ny * sizeof *h);

    assert_non_null(h);
    return h;
}

#endif
