/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of bench-paper: the measurements of Polonsky and Keer, Wear 231 (1999) 206-219. Numbers of
 * equations are those of the paper. */
#ifndef PAPER_H
#define PAPER_H

#include "bench.h"

/* Sections 4.1 and 4.2: E1 = E2 = 210 GPa, nu = 0.28, two spheres of 30 mm diameter. */
static const double paper_radius = 7.5e-3, paper_estar = 113.93e9, paper_load = 240,
                    paper_nu = 0.28;
static const double paper_dx = 1.1e-6, paper_dy = 1.29e-6, paper_hardness = 6e9;

enum {
    PAPER_NX = 483,
    PAPER_NY = 412
};

extern size_t threads;
extern double limit; /* time limit of a solution in seconds */
/* True if a grid with this number of columns, or a method of fig3, was requested. */
bool size_wanted(size_t nx);
bool way_wanted(const char *title);

/* 3.2: the tolerance M_min^(-3/2) and sums right to M_min^(-2), p from the mean pressure,
 * stopped by the change of the pressure, (32). Returns the solver, which the caller frees; *done is false if
 * `limit` seconds were not enough. */
struct rc_solver *paper_solve(struct rc_shape shape, const double *h, struct rc_problem problem,
                              bool *done);

/* 3.1 */
void table1(void);
/* 4.1 */
void fig1(void);
/* 4.2 */
void fig3(void);
void stresses(void);
/* 5 */
void section5(void);

#endif
