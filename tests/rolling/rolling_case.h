/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts shared by the tests of rolling: pressures of ellipses, and models that roll under a known
 * pressure. */
#ifndef ROLLING_CASE_H
#define ROLLING_CASE_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/contact.h"
#include "tests/exact.h"

/* Hertz's pressure, of maximum p0, on the ellipse of semi-axes a, b about the middle of the map. */
static inline double *
hertz_ellipse(const struct rc_shape *s, double a, double b, double p0)
{
    double *p = malloc(s->nx * s->ny * sizeof *p);

    for (size_t k = 0; k < s->nx * s->ny; k++) {
        const double x = ((double)(k % s->nx) - (double)(s->nx - 1) / 2) * s->dx / a;
        const double y = ((double)(k / s->nx) - (double)(s->ny - 1) / 2) * s->dy / b;
        p[k] = p0 * sqrt(fmax(1 - x * x - y * y, 0));
    }
    return p;
}

/* n nodes over 2.2 semi-axes. */
static inline struct rc_shape
ellipse_shape(size_t n, double a, double b)
{
    return (struct rc_shape){n, n, 2.2 * a / (double)n, 2.2 * b / (double)n};
}

static inline double
rolling_load(const struct rc_shape *s, const double *p)
{
    double sum = 0;

    for (size_t k = 0; k < s->nx * s->ny; k++)
        sum += p[k];
    return sum * s->dx * s->dy;
}

enum {
    MODELS = 8 /* at the same time */
};

/* Rolls under the known pressure p, which must stay as long as the model; there is no contact to be
 * solved. */
static inline struct rc_model *
rolling_new(const struct rc_shape *s, const double *p, struct rc_rolling_problem o,
            struct rc_err *err)
{
    static struct rc_rolling_contact known[MODELS];
    static size_t models;
    const struct rc_problem contact = {
        .boundary = o.law.boundary, .pair = o.law.pair, .threads = o.law.threads};

    o.known = &known[models++ % MODELS];
    known[(models - 1) % MODELS].p = p;
    return rc_rolling_new(rc_elastic_new(s, p, &contact, NULL, err), &o, err);
}

static inline enum rc_status
roll(struct rc_model *m, double load, double x, double y, double spin, bool force,
     struct rc_err *err)
{
    struct rc_point to = {0};
    enum rc_status status;

    rc_point_set(&to, RC_LOAD, load);
    rc_point_set(&to, force ? RC_TANGENTIAL_X : RC_CREEP_X, x);
    rc_point_set(&to, force ? RC_TANGENTIAL_Y : RC_CREEP_Y, y);
    rc_point_set(&to, RC_SPIN, spin);
    status = rc_model_run(m, &to, err);
    if (status != RC_FAIL && rc_model_look(m, NULL, err) != RC_OK)
        return RC_FAIL;
    return status;
}

#endif
