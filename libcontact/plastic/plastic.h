/*
 * What the files of this folder share beside the face, which is in contact.h. Internal: never installed.
 */
#ifndef RC_PLASTIC_H
#define RC_PLASTIC_H

#include "libcontact/contact.h"
#include "libcontact/model/row.h"
#include "libcontact/volume/volume.h"
#include "voxels.h"

/* Part of the last increment in the base of the next: w^2/(1 + 2 w), w = 1. */
#define RC_PLASTIC_BETA (1.0 / 3)

enum rc_plastic_stage {
    RC_PLASTIC_NEW,   /* no load is asked for */
    RC_PLASTIC_PROBE, /* elastic trials of the load, which change no strain */
    RC_PLASTIC_TRIAL, /* increments */
    RC_PLASTIC_ORDER, /* the contact with what the order of the integration adds */
    RC_PLASTIC_STATE, /* the contact of the strain that has been accepted */
    RC_PLASTIC_AGAIN, /* the contact of a state that was taken over when it was done */
    RC_PLASTIC_DONE
};

struct rc_plastic {
    struct rc_shape shape;
    size_t n;
    int threads;
    struct rc_yield law;
    double shear, nu, yield,
        lag;              /* mu, yield stress of what is new, the lag that is asked for    */
    double *h, *u, *form; /* heights, what e does to the surface, and heights less that    */
    double *thickness;
    struct rc_solver *solver;
    struct rc_slabs *slabs;
    struct rc_voxels voxels;
    bool round;      /* the map repeats */
    double bearable; /* N: beyond it all depths yield under the mean pressure                */
    double *other;   /* a pressure to compare with                                               */
    bool alone;      /* no load: p is 0                                                          */
    bool flows;      /* some voxel did in the last application                                   */
    bool elastic;    /* nothing flows on the way to this load                                    */
    bool once;       /* one increment follows, whose flow counts as missed */
    bool thorough;   /* not even where little flows                        */
    bool few;        /* some load so far was reached in too few increments to tell their error   */
    bool failed;     /* memory was short in a row                                                */
    bool pressed;    /* a load has been: the solver's pressure is one to start from */
    bool stopped;    /* a contact stopped short                                                  */
    bool moved;      /* the heights are new                                                      */
    double from, to, set; /* loads: of the last result, asked for, of this increment           */
    double low, high; /* shares of the way from one to the next: nothing flows up to, flows at  */
    double start;     /* load from which the increments go                                      */
    size_t increments, count; /* of a load that flows, and of this one                         */
    size_t increment, trial;  /* which of them, and which application of it                    */
    size_t taken;             /* increments of all loads so far                                */
    double tol, asked_tol;    /* of the contacts of this load, and as asked for                */
    double kept;              /* error that plastic flow has kept of the contacts' tolerances  */
    double order, resistance;
    double mix; /* Anderson's share of the trial before                                        */
    enum rc_plastic_stage stage;
    struct rc_plastic_figures figures;
};

/* Whether this is a body that can yield. */
enum rc_status rc_plastic_check(const struct rc_plastic_problem *problem, struct rc_err *err);
/* Slabs for a body that would yield under the elastic contact pressure p (nx ny Pa): half a node thick
 * at the surface, each by a quarter thicker than the one above, down to below where Mises' stress falls
 * under the yield stress. */
struct rc_plastic_depths {
    size_t slabs;         /* 0: nothing yields                                                    */
    double *thickness;    /* m, of each, the caller's to free; NULL: none                         */
    double most, deepest; /* Pa, the largest Mises stress, and its depth, m                       */
};
/* RC_FAIL as rc_stress_new, and when memory is short. */
enum rc_status rc_plastic_depths(const struct rc_shape *shape, enum rc_boundary boundary,
                                 const double *p, const struct rc_body *body, double yield,
                                 size_t threads, struct rc_plastic_depths *depths,
                                 struct rc_err *err);
/* n thicknesses to the depth of the stack that rc_plastic_depths has found. */
void rc_plastic_stack(const struct rc_plastic_depths *found, size_t n, double *thickness);
/* The contacts are found to this tolerance from the next load that is set. */
void rc_plastic_solve_to(struct rc_plastic *plastic, double tol);
/* The pressure becomes the one that the next is compared with. */
void rc_plastic_keep_pressure(struct rc_plastic *plastic);

/* Counts, writes or reads the state of a struct rc_plastic after any step. */
void rc_plastic_exchange(void *plastic, struct rc_state *s);

#endif
