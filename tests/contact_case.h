/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the tests of contact: solves a problem completely. */
#ifndef CONTACT_CASE_H
#define CONTACT_CASE_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/exact.h"
#include "libcontact/contact.h"

struct solved {
    enum rc_status status;
    struct rc_contact c;
    double *p, *gap, *u; /* n each, freed by solved_free */
    struct rc_err err;
};

static const struct rc_boundary each_boundary[] = {
    {false, false, 0}, {true, true, 0}, {false, true, 0}, {true, false, 0}};
enum {
    BOUNDARIES = sizeof each_boundary / sizeof *each_boundary
};

/* Every method of the library passes the same tests. Main runs its group once for each method, or for the one
 * that RC_METHOD in the environment names. */
static const char *contact_method = "pcg";

static inline bool
contact_take(size_t m)
{
    const char *only = getenv("RC_METHOD");

    contact_method = rc_method_info(m)->name;
    return only == NULL || strcmp(only, contact_method) == 0;
}

#define RUN_FOR_EACH_METHOD(tests, failed)                                                         \
    {                                                                                              \
        int ran_ = 0;                                                                              \
        for (size_t m_ = 0; rc_method_info(m_) != NULL; m_++)                                      \
            if (contact_take(m_)) {                                                                \
                failed += cmocka_run_group_tests_name(contact_method, tests, NULL, NULL);          \
                ran_++;                                                                            \
            }                                                                                      \
        failed += ran_ == 0;                                                                       \
    }

/* The largest permitted ratio of estimated and true error. There is one number below estimate_small, for
 * elastic contacts or with an active hardness, and one above it. The smallest permitted ratio is 1. */
static const double estimate_small = 1e-3;
static const double estimate_elastic = 1.5, estimate_plastic = 1.6, estimate_early = 4;

#ifdef CONTACT_RANKS /* the same tests under mpirun: the processes share every map that can be shared */
#include "contact_ranks.h"
#else
struct contact_part { /* the part of the map in this process: all of it */
    const double *h;
    double *p, *gap, *u;
};
static inline struct contact_part
contact_share(struct rc_shape shape, const double *h, struct rc_problem *problem, struct solved *s)
{
    (void)shape;
    (void)problem;
    return (struct contact_part){h, s->p, s->gap, s->u};
}
static inline size_t
contact_nodes_here(struct rc_shape shape, const struct rc_problem *problem)
{
    (void)problem;
    return shape.nx * shape.ny;
}
static inline void
contact_gather(struct rc_shape shape, const struct rc_problem *problem, struct solved *s)
{
    (void)shape;
    (void)problem;
    (void)s;
}
#endif

static inline struct solved
solve(struct rc_shape shape, const double *h, struct rc_problem problem)
{
    size_t n = shape.nx * shape.ny;
    struct solved s = {.p = calloc(n, sizeof(double)),
                       .gap = calloc(n, sizeof(double)),
                       .u = calloc(n, sizeof(double))};
    struct contact_part here = contact_share(shape, h, &problem, &s);
    struct rc_solver *solver;

    if (problem.method == NULL)
        problem.method = contact_method;
    solver = rc_solver_new(&shape, here.h, &problem, &s.err);
    if (solver == NULL) {
        s.status = RC_FAIL;
        return s;
    }
    do
        s.status = rc_solver_step(solver);
    while (s.status == RC_MORE);
    rc_solver_result(solver, here.u, here.gap, &s.c);
    memcpy(here.p, rc_solver_pressure(solver),
           contact_nodes_here(shape, &problem) * sizeof(double));
    rc_solver_free(solver);
    contact_gather(shape, &problem, &s);
    return s;
}

#ifdef assert_true /* the benchmarks include this file without cmocka */
/* Steps until the solution is within the tolerance. */
static inline struct rc_contact
finish(struct rc_solver *solver)
{
    struct rc_contact c;

    while (rc_solver_step(solver) == RC_MORE)
        ;
    rc_solver_result(solver, NULL, NULL, &c);
    assert_true(c.converged);
    return c;
}
#endif

/* Relative L1 distance of a from b. */
static inline double
distance(size_t n, const double *a, const double *b)
{
    double sum = 0, all = 0;

    for (size_t k = 0; k < n; k++) {
        sum += fabs(a[k] - b[k]);
        all += fabs(b[k]);
    }
    return sum / all;
}

static inline void
solved_free(struct solved *s)
{
    free(s->p);
    free(s->gap);
    free(s->u);
}

/* x and y of node k about the middle of the map. */
static inline double
node_x(struct rc_shape s, size_t k)
{
    size_t i = k % s.nx;

    return ((double)i - (double)(s.nx - 1) / 2) * s.dx;
}

static inline double
node_y(struct rc_shape s, size_t k)
{
    size_t j = k / s.nx;

    return ((double)j - (double)(s.ny - 1) / 2) * s.dy;
}

static inline double
node_r(struct rc_shape s, size_t k)
{
    return hypot(node_x(s, k), node_y(s, k));
}

/* If the numbers of columns and rows are even, no node lies at the apex of a sphere in the middle. The four
 * nearest nodes are lower by this depth, and the approach counts from them. */
static inline double
below_apex(struct rc_shape s, double radius)
{
    return (s.dx * s.dx + s.dy * s.dy) / (8 * radius);
}

/* The next number of a fixed pseudo-random sequence in (-1/2, 1/2). */
static inline double
random_number(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005U + 1442695040888963407U;
    return (double)(*seed >> 11) / 9007199254740992.0 - 0.5;
}

#endif
