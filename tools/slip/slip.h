/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Declarations for all files of rc-slip. */
#ifndef RC_TOOL_SLIP_H
#define RC_TOOL_SLIP_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"
#include "tools/frames/frames.h"
#include "tools/model/model.h"
#include "tools/problem/problem.h"

enum slip_frame { /* in the order of the words of --output */
    SLIP_PRESSURE,
    SLIP_TRACTION_X,
    SLIP_TRACTION_Y,
    SLIP_SLIP_X,
    SLIP_SLIP_Y,
    SLIP_STATE,
    SLIP_HEIGHT,
    SLIP_LENGTH, /* of the path of slip since the last case */
    SLIP_TRACTION,
    SLIP_DISSIPATION, /* J/m2, since the last case               */
    SLIP_FRAMES
};

struct slip_args {
    double mu, tau_max, nu, e1, nu1, e2, nu2, tol;
    struct numbers tangential, displacement; /* N, m */
    struct numbers creep_force;              /* N */
    const char *creep, *path, *history, *increments, *coupling;
    size_t output; /* bits of enum slip_frame */
    struct boundary_args repeats;
    bool steady;
    struct drive_args drive;
};

/* A corner of a path. The path to it is straight. */
struct slip_corner {
    double load;  /* N */
    double to[2]; /* N, or m where `moved` */
    bool moved;
    bool silent; /* not written to the output */
    struct rc_leg leg;
};

struct slip_pair {
    struct rc_pair pair;
    double nu;        /* Poisson's ratio of both bodies, if only E* is known */
    double kap, beta; /* contact-theory(7) */
};

/* The state at a corner, or where a signal ended the run. */
struct slip_state {
    const struct slip_corner *corner;
    struct rc_friction_figures figures;
    double dissipated_total;   /* J, since the start of the path */
    struct error_parts errors; /* parts of the error of the tractions */
    double traction_error;     /* their sum; NAN: unknown        */
    /* of all corners so far: increments that their goals need, and the error of as many as are proposed */
    double needed, reached;
    bool converged;
};

struct slip_run {
    struct drive d;
    const struct slip_args *args;
    struct slip_corner *given; /* --path, --history; NULL: neither */
    size_t givens, room;       /* room: for as many there is memory */
    size_t increments;         /* 0: auto */
    enum rc_coupling coupling;
    size_t number; /* number of the written case */
    /* frames of the input case; gap and height may be NULL */
    struct rc_grid *p, *gap, *height, *contact;
    struct slip_pair bodies;
    struct rc_boundary boundary;
    double load; /* N, load of the pressure in the stream */
    struct slip_corner *corner;
    size_t corners;
    struct slip_state state; /* of the corner that was reached last */
    /* m, three maps: slip along x and y at the last corner, path of slip since the last case; NULL: not
     * wanted */
    double *slipped;
    struct rc_friction_problem law;
    bool coupled;    /* the pressure moves the bodies along each other  */
    bool alternates; /* tractions change the pressure too               */
    bool solves;     /* contacts are solved                             */
    const struct slip_motion *motion;
};

/* A motion of the bodies is a row: slip_motions has them, and the first one that the options ask for
 * moves the bodies of all cases. */
struct slip_motion {
    bool (*ask)(const struct slip_args *args);
    void (*read)(struct slip_run *run,
                 struct slip_args *args); /* ends the tool if they make no sense */
    void (*move)(struct slip_run *run);   /* in a case: plans, solves and reports */
    /* Its columns; returns whether the row has converged. */
    bool (*report)(struct report *r, const struct slip_run *run, const struct rc_model *m);
    /* The columns at the end of its row; NULL: none. */
    void (*report_last)(struct report *r, const struct slip_run *run);
    void (*close)(void);   /* NULL: nothing is left */
    double tol;            /* without --tol */
    const char *work;      /* more words about the plan */
    const char *uncoupled; /* what neglects the effect of tractions on the pressure */
};
extern const struct slip_motion *const slip_motions[]; /* the last is NULL */
extern const struct slip_motion slip_motion_steady, slip_motion_rolling;

/* ---- path.c ---- */

/* Reads --path, --history and --increments; ends the tool if they make no sense. */
void slip_read_path(struct slip_run *run, struct slip_args *args);
/* The corners of this case, the law of friction with its tolerance, and whether contacts are solved. */
void slip_plan_path(struct slip_run *run);
struct rc_point slip_point(const struct slip_corner *c);
/* The law of friction without its tolerance. */
struct rc_friction_problem slip_law(const struct slip_run *run);

/* ---- bodies.c ---- */

/* Finds the bodies of the case; ends the tool if they are unknown, coated, or not those of the pressure. */
void slip_find_bodies(struct slip_run *run);

/* ---- case.c ---- */

extern const char *const slip_frames[]; /* of --output; the last is NULL */
void slip_case(struct slip_run *run);
/* Keys of a frame under any motion. */
void slip_set_keys(struct slip_run *run, struct rc_grid *g, bool converged, double load,
                   double approach);
/* A frame of the tool; NULL: it is one of the model. */
const double *slip_frame(struct drive *d, struct rc_model *m, struct rc_grid *frame,
                         const char *word);

/* ---- report.c ---- */

/* The allowed relative L1 error of the tractions, from increments and iteration together. */
double slip_goal(const struct slip_run *run);
/* Warnings printed before the run. */
void slip_judge_plan(struct slip_run *run);
void slip_judge(struct slip_run *run, struct slip_state *s);
/* A row of the report, for tools/model. */
void slip_report(struct drive *d, const struct rc_model *m);
/* Passes of an increment in which tractions change the pressure too; else 1. */
double slip_passes(const struct slip_run *run);
void slip_say_plan(struct slip_run *run, const struct rc_expected *expected);

#endif
