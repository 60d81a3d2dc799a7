/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Functions shared by the files of this folder; its model is in contact.h. Internal: never installed.
 */
#ifndef RC_YIELD_H
#define RC_YIELD_H

#include "libcontact/contact.h"
#include "libcontact/model/row.h"
#include "libcontact/volume/volume.h"
#include "voxels.h"

/* Part of the last increment in the base of the next one: w^2/(1 + 2 w), w = 1. */
#define RC_YIELD_BETA (1.0 / 3)

/* The nodes of a deep slab lie apart by at most this part of its depth. On five rough contacts the pressure
 * changed by 1e-4 to 2e-3 for 0.35 and 0.4, by 3e-4 to 2e-3 for 0.5, and by 1e-3 to 5e-3 for 0.7, with 1.6,
 * 1.7, 1.8 and 2.3 times less memory and time. */
#define RC_YIELD_COARSER 0.4

/* Loads that need more increments for an error of 1e-2 are severe: the terms of second order then tell less
 * of the error. */
enum {
    RC_YIELD_SEVERE = 28
};

enum rc_yield_solver_stage {
    RC_YIELD_NEW,   /* no load was set */
    RC_YIELD_PROBE, /* elastic trials of the load, which change no strain */
    RC_YIELD_TRIAL, /* increments */
    RC_YIELD_ORDER, /* the contact with the terms of second order */
    RC_YIELD_STATE, /* the contact of the accepted strain */
    RC_YIELD_AGAIN, /* the contact of a finished state that was read */
    RC_YIELD_DONE
};

struct rc_yield_body {
    struct rc_yield_law law;
    double shear, nu, yield; /* mu, Poisson's ratio, initial yield stress */
};

struct rc_yield_maps {
    double *h, *u, *form; /* heights, displacement of the surface by e, heights minus that */
    double *thickness;    /* of each slab */
    double *other;        /* an earlier pressure, for comparison */
    double *line;         /* sums over the lines across the axis that repeats */
    double *beside;       /* the rows of the pressure before and after those held here */
    double *some;         /* whether each slab has strain, on some rank */
};

/* The request of the caller. */
struct rc_yield_asked {
    bool once;         /* one increment follows, and all of its flow counts as an error */
    bool thorough;     /* increments also for little flow */
    bool follows;      /* the load is one more increment of the last one, on other heights */
    bool travels;      /* such loads may come */
    bool yields;       /* the first load is far above the first yield: it needs no elastic trials */
    bool chosen;       /* the caller did not give the slabs */
    bool mild;         /* no load of the plan is severe, and this load is not repeated */
    size_t increments; /* of a load with flow */
    double tol;        /* of the contacts */
    double lag;        /* allowed */
};

/* Loads of an increment. */
struct rc_yield_way {
    double from, to, set; /* loads: of the last result, requested, of this increment */
    double low, high;     /* parts of the load change: without flow, and with flow */
    double start;         /* load at which the increments start */
};

/* The course of the iteration. */
struct rc_yield_run {
    size_t count;            /* increments of this load */
    size_t increment, trial; /* index of the increment, and of its application */
    size_t taken;            /* increments of all loads so far                                */
    double tol;              /* of the contacts of this load */
    double order, resistance;
    double mix; /* Anderson's weight of the previous trial */
};

struct rc_yield_errors {
    double kept;   /* error from tolerances of earlier contacts, kept by plastic flow */
    double worst;  /* largest error of the increments at the positions of this load */
    double judged; /* factor of the terms of second order of this load, see rc_yield_solver_judge */
    bool few;      /* some load was reached in too few increments to know their error */
};

struct rc_yield_is {
    bool alone;   /* no load: p is 0                                                          */
    bool flows;   /* some voxel flowed in the last application */
    bool elastic; /* no voxel flows up to this load */
    bool failed;  /* a row had no memory */
    bool pressed; /* a load was solved: the next contact starts from its pressure */
    bool stopped; /* a contact stopped short                                                  */
    bool moved;   /* the heights have changed */
    bool paired;  /* pairs of slabs have the mean of their strain */
};

struct rc_yield_solver {
    struct rc_shape shape; /* the whole map */
    struct rc_rows rows;   /* held here, with `n` nodes */
    size_t n;
    int threads;
    struct rc_boundary boundary;
    size_t lines;    /* lines across the axis, if exactly one repeats; 0: none or both do */
    double bearable; /* N: above it all depths yield under the mean pressure */
    struct rc_yield_body body;
    struct rc_yield_maps maps;
    struct rc_store own;
    struct rc_solver *solver;
    struct rc_slabs *slabs;
    struct rc_voxels voxels;
    struct rc_yield_asked asked;
    struct rc_yield_way way;
    struct rc_yield_run run;
    struct rc_yield_errors errors;
    struct rc_yield_is is;
    enum rc_yield_solver_stage stage;
    struct rc_yield_load figures;
};

/* h: nx ny m, copied. NULL when the problem is invalid, or memory is short. */
struct rc_yield_solver *rc_yield_solver_new(const struct rc_shape *shape, const double *h,
                                            const struct rc_yield_problem *problem,
                                            struct rc_err *err);
/* The next load of a history, N; 0 separates the bodies. */
enum rc_status rc_yield_solver_set_load(struct rc_yield_solver *plastic, double load,
                                        struct rc_err *err);
/* Increments of each load, from the next one that is set; 0: 16. */
void rc_yield_solver_set_increments(struct rc_yield_solver *plastic, size_t increments);
/* Sets the heights (nx ny, in m, of bodies without plastic strain) for the next load, for example after one
 * body has moved. */
void rc_yield_solver_set_heights(struct rc_yield_solver *plastic, const double *h);
/* One application: a contact and two sweeps through the volume. RC_MORE until the load is reached, then
 * RC_OK, or RC_SHORT if a contact or the iteration stopped short; RC_FAIL when memory is short. */
enum rc_status rc_yield_solver_step(struct rc_yield_solver *plastic, struct rc_err *err);
/* Plastic strain of a slab, nx ny each; NULL: not needed. */
void rc_yield_solver_strain(const struct rc_yield_solver *plastic, size_t slab,
                            double *const e[RC_YIELD_STRAINS]);
void rc_yield_solver_free(struct rc_yield_solver *plastic); /* NULL is allowed */
RC_OWNER(rc_yield_solver)
/* Checks that the body can yield. */
enum rc_status rc_yield_solver_check(const struct rc_yield_problem *problem, struct rc_err *err);
/* Slabs for a body that would yield under the elastic contact pressure p (nx ny, Pa). The first is about a
 * tenth of a node thick, and each next one is thicker by 3 to 18 %. The last one is below the depth where the
 * Mises stress falls below the yield stress. Slabs whose voxels miss the largest Mises stress are halved. */
struct rc_yield_depths {
    double wanted;        /* before the call: relative change of the pressure by pairs of slabs */
    size_t slabs;         /* 0: no stress reaches the yield stress */
    size_t looked;        /* depths where the stress was found */
    size_t halved;        /* how often each slab was halved; before the call: how often at least */
    double *thickness;    /* m, of each slab; the caller frees it; NULL: none */
    double part;          /* part of the nodes of these slabs whose Mises stress exceeds `yield` */
    double most, deepest; /* Pa, the largest Mises stress; m, its depth */
};
/* Takes boundary, body 1, threads and `hurry` of the contact. RC_FAIL as rc_stress_new, and if memory
 * is short; RC_MORE: the caller cannot wait, and nothing is known. */
enum rc_status rc_yield_depths(const struct rc_shape *shape, const struct rc_problem *contact,
                               const double *p, double yield, struct rc_yield_depths *depths,
                               struct rc_err *err);
/* n thicknesses that reach the depth found by rc_yield_depths. */
void rc_yield_solver_stack(const struct rc_yield_depths *found, size_t n, double *thickness);
/* The next load, equal to the last one, is one more increment of it, on other heights. */
void rc_yield_solver_follow(struct rc_yield_solver *plastic);
/* Sets the tolerance of the contacts from the next load on. */
void rc_yield_solver_solve_to(struct rc_yield_solver *plastic, double tol);
/* Keeps the pressure for comparison with the next one. */
void rc_yield_solver_keep_pressure(struct rc_yield_solver *plastic);
/* Replaces the errors of the increments of a reached load and of earlier loads by better estimates. Later
 * loads inherit the first one. */
void rc_yield_solver_judge(struct rc_yield_solver *plastic, double increment, double inherited);

/* Counts, writes or reads the state of a struct rc_yield_solver after any step. */
void rc_yield_solver_exchange(void *plastic, struct rc_state *s);

#endif
