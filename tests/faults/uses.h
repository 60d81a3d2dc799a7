/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Calls of libcontact whose allocations fail in the tests, in one process (law_memory.c) and in several that
 * share a map (law_memory_ranks.c). */
#ifndef USES_H
#define USES_H

#include <math.h>
#include <string.h>

#include "libcontact/contact.h"

/* A use calls some functions and writes their results to the front of out, which holds zeros before. */
typedef enum rc_status use(double *out, struct rc_err *err);

/* Uses of the functions convolved, solved or stressed, which each test defines for its own maps. The options
 * are two bodies, bare or layered, or the first body only. */
#define CONVOLUTION(name, bodies, ...)                                                             \
    static enum rc_status name(double *out, struct rc_err *err)                                    \
    {                                                                                              \
        static const struct rc_conv_options o = {.threads = 1, __VA_ARGS__};                       \
        return convolved(&bodies, &o, out, err);                                                   \
    }
#define CONTACT(name, bodies, ...)                                                                 \
    static enum rc_status name(double *out, struct rc_err *err)                                    \
    {                                                                                              \
        struct rc_problem o = {.threads = 1, .tol = 1e-5, __VA_ARGS__};                            \
        o.pair = bodies;                                                                           \
        return solved(&o, out, err);                                                               \
    }
#define STRESS(name, bodies, ...)                                                                  \
    static enum rc_status name(double *out, struct rc_err *err)                                    \
    {                                                                                              \
        struct rc_stress_options o = {.threads = 1,                                                \
                                      .wanted =                                                    \
                                          1 << RC_SXX | 1 << RC_SXZ | 1 << RC_MISES | 1 << RC_S1,  \
                                      __VA_ARGS__};                                                \
        o.body = bodies.one;                                                                       \
        return stressed(&o, out, err);                                                             \
    }

static const struct rc_pair bare = {.one = {.e = 0.91e9, .nu = 0.3}}; /* E* 1 GPa */

static enum rc_status
finish_load(struct rc_solver *solver, struct rc_err *err)
{
    enum rc_status status;

    while ((status = rc_solver_step(solver)) == RC_MORE)
        continue;
    return status == RC_OK ? RC_OK
                           : rc_err_set(err, "the solution stops short: status %d", (int)status);
}

/* Solves a contact and, starting from its solution, one under a load that is a tenth higher, whose shape is
 * kept. Returns fields of n nodes each: the pressure of the second contact; gap, displacement and yielded
 * shape of the first. */
static enum rc_status
solve_twice(const struct rc_shape *shape, const double *heights, const struct rc_problem *problem,
            size_t n, double *const field[4], double *stiffness, struct rc_err *err)
{
    struct rc_solver *solver = rc_solver_new(shape, heights, problem, err);
    struct rc_conductance conducts;
    struct rc_contact contact;
    enum rc_status status = RC_FAIL;

    if (solver == NULL || finish_load(solver, err) != RC_OK)
        goto done;
    rc_solver_result(solver, field[1], field[2], &contact);
    if (rc_solver_plastic(solver, field[3], err) != RC_OK ||
        rc_solver_stiffness(solver, stiffness, err) != RC_OK ||
        rc_solver_conductance(solver, 45, 16, &conducts, err) != RC_OK ||
        rc_solver_set_load(solver, 1.1 * contact.load, 0, err) != RC_OK ||
        rc_solver_warm_start(solver, contact.load, rc_solver_pressure(solver), err) != RC_OK ||
        finish_load(solver, err) != RC_OK)
        goto done;
    *stiffness +=
        isnan(conducts.value) ? 0 : conducts.value; /* coated bodies have no conductance */
    memcpy(field[0], rc_solver_pressure(solver), n * sizeof *field[0]);
    rc_solver_result(solver, NULL, NULL, &contact);
    if (rc_solver_set_heights(solver, field[3], err) == RC_OK &&
        finish_load(solver, err) == RC_OK) {
        rc_solver_result(solver, NULL, NULL, &contact);
        status = rc_solver_keep_shape(solver, &contact, field[3], err);
    }
done:
    rc_solver_free(solver);
    return status;
}

/* Four stresses at two depths, the second on a coarser grid where the tolerance permits; its stresses remain
 * in the arrays. */
static enum rc_status
two_slices(const struct rc_shape *shape, const double *pressure,
           const struct rc_stress_options *options, double *const field[4], struct rc_err *err)
{
    double *const slice[RC_STRESSES] = {
        [RC_SXX] = field[0], [RC_SXZ] = field[1], [RC_MISES] = field[2], [RC_S1] = field[3]};
    struct rc_stress *stress = rc_stress_new(shape, pressure, options, err);
    enum rc_status status = RC_FAIL;

    if (stress != NULL && (status = rc_stress_slice(stress, 1.5e-6, slice, err)) == RC_OK)
        status = rc_stress_slice(stress, 2e-5, slice, err);
    rc_stress_free(stress);
    return status;
}

#endif
