/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * An effect is a row: its options, its model, and what it adds to points, frames, messages and the report.
 * Its options and its state are in its own file, which ends in its `struct effect`; effects.list has the
 * rows, and the other files of this folder walk them. An effect tells the others what it found through struct
 * run, in the words of a contact: loads, bodies, bounds, points. -DRC_EFFECTS_LIST=... replaces the list;
 * tests/toys/settling.c is a row of another list.
 */
#ifndef RC_SOLVE_EFFECT_H
#define RC_SOLVE_EFFECT_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

struct run;
struct solution;

/* Whether a run with another --tol continues from a checkpoint. */
enum solve_tol {
    TOL_AS_LOADS, /* it may rise, because the errors of earlier points stay, if loads act in sequence */
    TOL_FREE,
    TOL_MAY_RISE,
    TOL_FIXED
};

/* Where the columns of a row are among those of all contacts; rows at one place follow the list. */
enum solve_place {
    COLUMNS_OF_POINTS,
    COLUMNS_OF_BOUNDS,
    COLUMNS_OF_BODIES,
    COLUMNS_OF_VOLUME,
    COLUMNS_OF_GAP,
    COLUMNS_LAST
};

/* All members may be absent. Functions are called for active rows only, in the order of the list. */
struct effect {
    const char *name;          /* in `effects` of the report and of --dry-run; NULL: not listed */
    const char *title;         /* of its options in --help */
    const struct opt *options; /* with the .base of their values */

    /* Before bodies and loads are checked; false: the row is not active. NULL: it is always active. */
    bool (*ask)(struct run *run);
    /* After these checks: ends the tool if the options contradict others. */
    void (*read)(struct run *run);
    void (*warn)(struct run *run); /* then warns of them */
    bool sequence;                 /* loads act one after another, and 0 separates the bodies */
    bool follows;                  /* each point depends on those before it, under one load too */
    enum solve_tol tol;
    const char *no_stiffness; /* why the stiffness is not computed by default */

    /* A map of the case that it reads beside the heights, or else has from a file: for marks. */
    struct tool_frame map;
    bool beside;
    void (*take)(struct run *run);  /* a case begins: its maps, before the heights are checked */
    void (*open)(struct run *run);  /* and after that */
    void (*close)(struct run *run); /* the case ends */
    void (*mark)(struct run *run);  /* of a checkpoint, beside options and maps */

    /* An axis of the points. `points` adds points to those of the lists. */
    enum rc_axis axis;
    const struct numbers *list;
    void (*points)(struct run *run);
    const char *noun; /* of a point in --dry-run, "load" otherwise */

    /* Changes the contact problem of a point. */
    void (*problem)(struct run *run, struct rc_problem *problem);
    /* The model in place of the elastic one, and one around the model so far. */
    struct rc_model *(*base)(struct run *run, const struct rc_problem *problem);
    struct rc_model *(*outer)(struct run *run, struct rc_model *inner);
    bool at_once; /* the first point plans the solvers of all points */
    bool
        by_gap; /* the pressure does not show which nodes touch, but frame `contact` of the model does */
    const char *method, *engine; /* words of the report for a model without a solver */

    /* Cost. `expect`: of a point; the model must exist, also for --dry-run. `plan`: instead of it in
     * --dry-run. `loads`: of all points over the first one. `work`: convolutions for figures of each
     * point. */
    enum rc_status (*expect)(struct run *run, const struct rc_problem *problem,
                             struct rc_expected *expected, struct rc_err *err);
    void (*plan)(struct run *run, const struct rc_problem *problem, struct rc_expected *expected);
    double (*loads)(const struct run *run);
    double (*work)(const struct run *run);
    /* Memory, in bytes: of all instead of the usual sum; a node of maps; a node of the largest work after the
     * solution. */
    size_t (*memory)(struct run *run, const struct rc_problem *problem);
    size_t (*bytes)(const struct run *run);
    size_t later;

    /* Before a point; the largest checkpoint is chosen. */
    void (*begin)(struct run *run, struct rc_model *m, const struct rc_problem *problem);
    /* After it: takes figures of the model; false: the point is not a case. `find` asks a solver with a
     * pressure for more figures. `errors`, at the end, replaces the estimated error and its parts. */
    bool (*look)(struct run *run, struct rc_model *m, struct solution *s);
    void (*find)(struct run *run, struct rc_solver *solver, struct solution *s);
    void (*errors)(struct run *run, struct solution *s);

    /* Warnings. `judge_alone`: instead of all others. `high`: of a high pressure, a part of E*; true:
     * it has warned. `end`: last, and why the point did not converge; true: it has said why. */
    void (*judge)(struct run *run, const char *where, const struct solution *s);
    void (*judge_alone)(struct run *run, const char *where, const struct solution *s);
    bool (*high)(struct run *run, const char *where, const struct solution *s);
    bool (*end)(struct run *run, const char *where, const struct solution *s);

    /* Frames: keys; words of --output that belong to it, and what to say of them without it; values
     * that are not those of the model (NULL: they are). */
    const char *const
        *foreign; /* keys that the heights may have, and frames without the effect have not */
    void (*keys)(struct run *run, struct rc_grid *g);
    const char *const *frames;
    const char *frames_alone;
    const double *(*frame)(struct run *run, struct rc_model *m, struct rc_grid *as,
                           const char *word);

    /* Its state, "on" or "left out: why"; `off`: without it, else `state` says that too. */
    const char *off;
    const char *(*state)(const struct run *run);
    enum solve_place place;
    bool columns; /* its columns are there without it, too */
    void (*report)(struct report *r, const struct run *run);
    /* columns after those of all rows, and at the end */
    void (*report_last)(struct report *r, const struct run *run);
    void (*report_end)(struct report *r, const struct run *run);
};

#endif
