/*
 * What the benches share: the clock, least times, errors, fitted exponents, and the parts of a
 * program.
 */
#ifndef BENCH_H
#define BENCH_H

#include "libcontact/operator/operator.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A name on the command line, and what it prints. */
struct part {
    const char *name;
    void (*run)(void);
    bool only_asked; /* not when no part is named */
};
/* Runs the parts that are named, or all. The status to exit with: 2 when there is no such part. */
int parts_run(size_t count, const struct part *parts, int names, char **name);

/* RC_THREADS, else all. */
size_t threads_wanted(void);
/* "512,1024": at most `most` numbers, and how many there were. */
size_t sizes_read(const char *text, size_t most, size_t *sizes);

/* Seconds of a clock that never goes back. */
double now(void);
/* Least seconds of each of several pieces of work. They take turns, `runs` times each, until
 * `seconds` have gone, so that a disturbance falls on all of them. */
struct work {
    void (*run)(void *what);
    void *what;
};
void take_turns(size_t count, const struct work *work, int runs, double seconds, double *least);
/* Whether work that began at `start` and has run so often runs again, for its least time: at least
 * twice and for half a second, unless that takes long. */
bool once_more(double start, int runs);

/* One application of a plan: work for the above. */
struct sum_work {
    const struct rc_engine *e;
    void *plan;
    const double *p;
    double *u;
};
void sum_run(void *sum_work);
/* Least seconds of it, over at least `runs` and, when they are several, a tenth of a second. */
double sum_seconds(struct sum_work sum, int runs);

/* These end the program when something is missing. */
void *must(void *p);
void must_be(enum rc_status status, const struct rc_err *err);
double *map_new(size_t n); /* zeros */
const struct rc_engine *engine_named(const char *name);
struct rc_solver *solver_new(struct rc_shape shape, const double *h, struct rc_problem problem);
/* Steps to the end. */
void solver_run(struct rc_solver *solver);
struct rc_progress solver_progress(const struct rc_solver *solver);

/* Relative errors of a against b: sums of magnitudes, sums of squares. */
double error_l1(size_t n, const double *a, const double *b);
double error_l2(size_t n, const double *a, const double *b);
/* The e of y = c x^e, by least squares of the logarithms; NAN for fewer than three. */
double exponent(size_t count, const double *x, const double *y);
/* Numbers of a fixed sequence in [0, 1). */
double uniform(uint64_t *seed);

/* Displacements in units in which a point load displaces by 1/r. */
struct rc_sum point_sum(struct rc_shape shape);
/* p = sqrt(1 - x^2 - y^2), nodes from -1 to 1 in either direction. */
void hemisphere(size_t nx, size_t ny, double *p);
/* What Polonsky and Keer (1999) take for sums of M x M nodes: t by (20), m_c by (18), rounded up. */
size_t paper_order(size_t m);
size_t paper_correction(size_t t, size_t m);

#endif
