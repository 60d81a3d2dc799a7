/*
 * What the rooms of rc-solve share: its options, the run, and what is told about it.
 */
#ifndef RC_SOLVE_H
#define RC_SOLVE_H

#include <stdio.h>

#include "../libcontact/contact.h"
#include "json.h"
#include "physics.h"
#include "tool.h"

enum solve_frame { /* in the order of --output's words, and of writing */
    SOLVE_PRESSURE,
    SOLVE_GAP,
    SOLVE_DISPLACEMENT,
    SOLVE_HEIGHT,
    SOLVE_PLASTIC,
    SOLVE_FRAMES
};
struct solve_frame_kind {
    const char *name, *unit;
};
extern const struct solve_frame_kind solve_frames[SOLVE_FRAMES];

struct solve_args {
    struct physics physics;
    double tol;
    const char *kernel, *method, *report;
    bool stiffness, discretization, dry_run;
    size_t output; /* bits of enum solve_frame */
};

struct run {
    struct tool t;
    const struct solve_args *args;
    const struct numbers *steps; /* the list of loads or approaches               */
    size_t step, number;         /* which of them, from 0; the case that it is    */
    bool stiffness;
    FILE *report;
    double began, setup, iterate, result; /* seconds */
};

static inline bool
solve_wanted(const struct solve_args *args, int frame)
{
    return args->output >> frame & 1;
}

/* Seconds on a clock that only goes forwards. */
double solve_now(void);

/* One JSON object for the case, where --report asks for it. */
void solve_report(struct run *run, const struct rc_grid *g, const struct rc_solver *solver,
                  const struct rc_contact *contact, double stiffness);
/* What the scene calls for and what it doesn't, and what that costs, in words. */
void solve_plan(struct run *run, const struct rc_grid *g, const struct rc_problem *problem);

#endif
