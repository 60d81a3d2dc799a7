/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Shared by the benchmarks: the clock, shortest times, errors, fitted exponents, and the parts of a program.
 */
#ifndef BENCH_H
#define BENCH_H

#include "libcontact/operator/operator.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Boundaries as initializers. */
/* clang-format off */
#define FREE {.x = false}
#define PERIODIC {.x = true, .y = true}
/* clang-format on */

/* A part: its name on the command line, and the function that prints it. */
struct part {
    const char *name;
    void (*run)(void);
    bool only_asked; /* omitted when no part is named */
};
/* Runs the named parts, or all. Returns the exit status: 2 for an unknown part. */
int parts_run(size_t count, const struct part *parts, int names, char **name);

/* RC_THREADS, else all. */
size_t threads_wanted(void);
/* Reads "512,1024": at most `most` numbers; returns their number. */
size_t sizes_read(const char *text, size_t most, size_t *sizes);

/* Seconds of a monotonic clock. */
double now(void);
/* The shortest time, in seconds, of each of several pieces of work. They run in turns, `runs` times each,
 * until `seconds` have passed, so that a disturbance affects all of them. */
struct work {
    void (*run)(void *what);
    void *what;
};
void take_turns(size_t count, const struct work *work, int runs, double seconds, double *least);
/* True if work that began at `start` should run again for its shortest time. It runs at least twice and for
 * half a second, unless this takes long. */
bool once_more(double start, int runs);

/* One application of a plan, as work for the functions above. */
struct sum_work {
    const struct rc_engine *e;
    void *plan;
    const double *p;
    double *u;
};
void sum_run(void *sum_work);
/* Its shortest time in seconds, over at least `runs` and, if these are several, a tenth of a second. */
double sum_seconds(struct sum_work sum, int runs);

/* These end the program on failure. */
void *must(void *p);
void must_be(enum rc_status status, const struct rc_err *err);
double *map_new(size_t n); /* zeros */
const struct rc_engine *engine_named(const char *name);
struct rc_solver *solver_new(struct rc_shape shape, const double *h, struct rc_problem problem);
/* Steps until the solution is found. */
void solver_run(struct rc_solver *solver);
struct rc_progress solver_progress(const struct rc_solver *solver);

/* Relative errors of a against b: sums of magnitudes, sums of squares. */
double error_l1(size_t n, const double *a, const double *b);
double error_l2(size_t n, const double *a, const double *b);
/* The exponent e of y = c x^e, by least squares of the logarithms; NAN for fewer than three points. */
double exponent(size_t count, const double *x, const double *y);
/* The next number of a fixed pseudo-random sequence in [0, 1). */
double uniform(uint64_t *seed);

/* Displacements in units in which a point load causes the displacement 1/r. */
struct rc_sum point_sum(struct rc_shape shape);
/* p = sqrt(1 - x^2 - y^2), nodes from -1 to 1 in both directions. */
void hemisphere(size_t nx, size_t ny, double *p);
/* The parameters of Polonsky and Keer (1999) for sums of M x M nodes: t by (20), m_c by (18), rounded up. */
size_t paper_order(size_t m);
size_t paper_correction(size_t t, size_t m);

#endif
