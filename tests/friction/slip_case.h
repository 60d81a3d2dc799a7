/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts shared by the tests of friction: pressures on sliding bodies, and solutions of increments. */
#ifndef SLIP_CASE_H
#define SLIP_CASE_H

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/friction/friction.h"
#include "tests/exact.h"

/* Uniform in [0, 1). */
static inline double
slip_noise(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) / 9007199254740992.0;
}

struct pressed {
    size_t n;
    double *h, *p, *gap, *apart; /* apart: the gap of the bodies at first touch */
    double fraction;
};

/* The contact of these heights, taken over, under each load in turn; the last one is left. */
static inline struct pressed
pressed_new(const struct rc_shape *shape, struct rc_boundary boundary, double *h, double estar,
            double load, double tol)
{
    struct pressed c = {.n = shape->nx * shape->ny, .h = h};
    struct rc_problem problem = {
        .boundary = boundary, .pair.estar = estar, .load = load, .tol = tol, .engine = "fft64"};
    struct rc_err err;
    struct rc_solver *solver = rc_solver_new(shape, h, &problem, &err);
    struct rc_contact figures;

    if (solver == NULL) {
        fprintf(stderr, "%s\n", err.text);
        abort();
    }
    c.p = malloc(c.n * sizeof *c.p);
    c.gap = malloc(c.n * sizeof *c.gap);
    c.apart = malloc(c.n * sizeof *c.apart);
    while (rc_solver_step(solver) == RC_MORE)
        ;
    rc_solver_result(solver, NULL, c.gap, &figures);
    memcpy(c.p, rc_solver_pressure(solver), c.n * sizeof *c.p);
    rc_solver_free(solver);
    rc_contact_apart(NULL, shape, h, c.apart, &figures);
    for (size_t k = 0; k < c.n; k++)
        c.fraction += (c.p[k] > 0) / (double)c.n;
    return c;
}

static inline void
pressed_free(struct pressed *c)
{
    free(c->h);
    free(c->p);
    free(c->gap);
    free(c->apart);
}

static inline double *
slip_rough(const struct rc_shape *shape, double slope, double cut, uint64_t seed)
{
    struct rc_selfaffine what = {.hurst = 0.8,
                                 .rms_slope = slope,
                                 .short_cut = cut,
                                 .rolloff = shape->dx * (double)shape->nx / 4,
                                 .seed = seed};
    double *h = malloc(shape->nx * shape->ny * sizeof *h);
    struct rc_err err;

    if (shape->dx * (double)shape->nx / 4 < cut)
        what.rolloff = 0;
    if (rc_synth_selfaffine(shape, &what, h, &err) != RC_OK) {
        fprintf(stderr, "%s\n", err.text);
        abort();
    }
    return h;
}

static inline double *
slip_sphere(const struct rc_shape *shape, double radius)
{
    double *h = malloc(shape->nx * shape->ny * sizeof *h);

    rc_synth_sphere(shape, radius, h);
    return h;
}

/* Steps to the end of an increment. */
static inline enum rc_status
slip_solve(struct rc_friction_solver *slip, struct rc_friction_increment *figures)
{
    struct rc_err err = {""};
    enum rc_status status;

    do
        status = rc_friction_solver_step(slip, &err);
    while (status == RC_MORE);
    if (status == RC_FAIL)
        fprintf(stderr, "%s\n", err.text);
    rc_friction_solver_result(slip, figures);
    return status;
}

/* Relative L1 distance of two fields of tractions. */
static inline double
slip_distance(size_t n, const double *const q[2], const double *const truth[2])
{
    double sum = 0, all = 0;

    for (size_t k = 0; k < n; k++) {
        sum += hypot(q[0][k] - truth[0][k], q[1][k] - truth[1][k]);
        all += hypot(truth[0][k], truth[1][k]);
    }
    return sum / all;
}

/* Friction over an elastic contact; h NULL: only the known contact of the law. */
static inline struct rc_model *
slip_model(const struct rc_shape *shape, const double *h, const struct rc_problem *contact,
           const struct rc_friction_problem *law, struct rc_err *err)
{
    return rc_friction_new(rc_elastic_new(shape, h != NULL ? h : law->known_p, contact, NULL, err),
                           h, law, err);
}

/* Goes to this load and force, or displacement, and looks. */
static inline enum rc_status
slip_go(struct rc_model *m, double load, double x, double y, bool moved, struct rc_err *err)
{
    struct rc_point to = {0};
    enum rc_status status;

    rc_point_set(&to, RC_LOAD, load);
    rc_point_set(&to, moved ? RC_DISPLACEMENT_X : RC_TANGENTIAL_X, x);
    rc_point_set(&to, moved ? RC_DISPLACEMENT_Y : RC_TANGENTIAL_Y, y);
    status = rc_model_run(m, &to, err);
    return status == RC_FAIL || rc_model_look(m, NULL, err) != RC_OK ? RC_FAIL : status;
}

#endif
