/* What rc-slip asks for, finds and tells. */
#ifndef RC_TOOL_SLIP_H
#define RC_TOOL_SLIP_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"
#include "tools/problem/problem.h"

enum {
    SLIP_JOINTS = 3 /* most: of all increments, of half of them, of a quarter */
};

enum slip_frame { /* in the order of --output's words, and of writing */
    SLIP_PRESSURE,
    SLIP_TRACTION_X,
    SLIP_TRACTION_Y,
    SLIP_SLIP_X,
    SLIP_SLIP_Y,
    SLIP_STATE,
    SLIP_FRAMES
};

struct slip_args {
    double mu, tau_max, nu, e1, nu1, e2, nu2, tol;
    struct numbers tangential, displacement; /* N, m */
    const char *path, *history, *increments, *coupling, *report, *checkpoint;
    size_t output; /* bits of enum slip_frame */
    bool periodic, resume, dry_run;
};

/* What is known of the error that the increments to a corner, and to those before, leave. */
enum slip_told {
    SLIP_EXACT,  /* there is none                                                 */
    SLIP_MANY,   /* half of them and a quarter tell it, with a factor; with more  */
    SLIP_SOME,   /* where the load changes                                        */
    SLIP_FEW,    /* where there are few                                           */
    SLIP_UNKNOWN /* nothing is: there are fewer than four, or eight of a changing load */
};

/* A place on a path, straight from the one before. */
struct slip_corner {
    double load;  /* N */
    double to[2]; /* N, or m where `moved` */
    bool moved;
    bool silent; /* on the way only: no case of its own */
    size_t increments;
    bool carries; /* tractions, also those that a force has left */
    bool late;    /* one increment, or two, the first of which goes nearly all of the way */
    enum slip_told told;
};

/* What a pair of bodies is beside E*. */
struct slip_pair {
    struct rc_pair pair;
    double nu;        /* of both, where only E* is known */
    double kap, beta; /* contact-theory(7) */
};

/* A corner that has been reached, or where it was given up. */
struct slip_state {
    const struct slip_corner *corner;
    struct rc_joint_figures figures;
    double dissipated, dissipated_total; /* J: since the corner before, since the start */
    double lagging;                      /* Pa: sum of the increments' error over the map */
    double doubt;                        /* relative: of the iteration of half of the increments */
    struct error_parts errors;           /* of the tractions */
    double traction_error;               /* their sum; NAN: unknown */
    double approach;                     /* m; NAN: unknown */
    size_t passes;
    double convolutions, seconds;
    bool converged;
};

struct slip_run {
    struct tool t;
    struct report report;
    const struct slip_args *args;
    struct slip_corner *given; /* --path, --history; NULL: neither */
    size_t givens;
    size_t increments; /* 0: auto */
    enum rc_coupling coupling;
    size_t number;                      /* of the case that is written */
    struct slip_checkpoint *checkpoint; /* NULL: none is kept */
    /* of the case that is read; gap and height may be NULL */
    struct rc_grid *p, *gap, *height, *contact;
    struct slip_pair bodies;
    enum rc_boundary boundary;
    double load; /* N, of the stream's pressure */
    struct slip_corner *corner;
    size_t corners;
    bool coupled;    /* the pressure moves the bodies along each other */
    bool alternates; /* and feels tractions                            */
    bool solves;     /* contacts are solved                            */
    double *lag
        [2]; /* Pa: tractions of all increments to the corner before less those of half of them */
    size_t joints; /* 1: nothing is told of increments; 2: half of them, 3: a quarter, too */
};

/* ---- path.c ---- */

/* --path, --history and --increments; ends the tool where they make no sense. */
void slip_read_path(struct slip_run *run, struct slip_args *args);
/* The corners of this case and the increments to each; which contacts are to be solved. */
void slip_plan_path(struct slip_run *run);
/* So many increments to a corner when it has n: of all, of half, of a quarter. */
size_t slip_fewer(size_t n, size_t joint);
/* Of all corners. */
size_t slip_all_increments(const struct slip_run *run);
/* Where increment k of n to a corner ends, 0 < k <= n. */
struct slip_corner slip_on_the_way(const struct slip_run *run, size_t corner, size_t k, size_t n);

/* ---- bodies.c ---- */

/* Ends the tool where the command line names half a pair. */
void slip_check_bodies(struct slip_run *run);
/* The bodies of the case; ends the tool where they are unknown, coated, or others than those of the
 * pressure. */
void slip_find_bodies(struct slip_run *run);

/* ---- case.c ---- */

const char *slip_frame_word(size_t k);
void slip_case(struct slip_run *run);

/* ---- checkpoint.c: where increments begin; NULL is allowed for each ---- */

/* Made, or with `resume` looked through; ends the tool where it cannot be. NULL for no name. */
struct slip_checkpoint *slip_checkpoint_open(struct slip_run *run, const char *name, bool resume);
void slip_checkpoint_case(struct slip_checkpoint *checkpoint);
/* The next increment, of the case and its options, begins with what was saved of it. Before it is set. False:
 * nothing was. */
bool slip_checkpoint_next(struct slip_checkpoint *checkpoint, struct rc_joint *joint);
void slip_checkpoint_save(struct slip_checkpoint *checkpoint, struct rc_joint *joint);
void slip_checkpoint_close(struct slip_checkpoint *checkpoint);
/* Bytes that it takes. */
size_t slip_checkpoint_memory(const struct slip_run *run);

/* ---- report.c ---- */

/* Relative L1 error of the tractions that is asked for: of increments and all. */
double slip_goal(const struct slip_run *run);
/* Warnings printed before the run. */
void slip_judge_plan(struct slip_run *run);
void slip_judge(struct slip_run *run, const struct slip_state *s);
void slip_report(struct slip_run *run, const struct slip_state *s);
/* What would be done, in words, in so many bytes. */
void slip_say_plan(struct slip_run *run, size_t memory);

#endif
