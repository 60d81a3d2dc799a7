/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: a run of rc-solve. effect.h has the rows that it walks.
 */
#ifndef RC_SOLVE_H
#define RC_SOLVE_H

#include <stdio.h>

#include "libcontact/contact.h"
#include "tools/cli/cli.h"
#include "tools/frames/frames.h"
#include "tools/materials/materials.h"
#include "tools/model/model.h"
#include "tools/problem/problem.h"
#include "effect.h"

/* Fraction of E*: at a higher pressure a solid is not linear elastic. */
#define SOLVE_LINEAR 0.1
/* Key of a shape after yield: its possible error, m. */
#define HEIGHT_ERROR "height.error"

enum {
    SOLVE_EFFECTS = 32, /* most rows */
    SOLVE_FRAMES = 32   /* most words of --output */
};
enum solve_frame { /* frames without an effect; those of effects follow */
    SOLVE_CONTACT, /* before the pressure, because readers need it to interpret the pressure */
    SOLVE_PRESSURE,
    SOLVE_GAP,
    SOLVE_DISPLACEMENT,
    SOLVE_HEIGHT,
    SOLVE_PLASTIC
};

/* Options of every contact. */
struct solve_args {
    struct physics physics;
    double tol;
    const char *kernel, *method;
    const char *increments; /* words of the command line, or NULL */
    size_t output;          /* bits of the words of --output */
    struct drive_args drive;
};
extern struct solve_args solve_args;
extern const struct opt solve_increments[]; /* --increments, for an effect that has them */

enum {
    SOLVE_LARGEST = 10 /* patches */
};

/* The figures of a solution. */
struct solution {
    struct rc_contact contact;
    struct error_parts errors; /* parts of contact.pressure_error, if it has several */
    struct rc_patches patches; /* of the contact; a report lists the SOLVE_LARGEST largest */
    double peak;               /* Pa: the pressure that is judged */
    const char *peak_name;
    double softer;                     /* E* at once over that of the time; 0: both are E*      */
    char took[96];                     /* its cost in words; "": iterations and convolutions */
    double increments;                 /* of a load, or steps to a time; NAN: none */
    double slope;                      /* RMS slope where the bodies touch; NAN: not computed */
    double stiffness;                  /* N/m; NAN: unknown                                       */
    double contact_radius;             /* m, of a contact that is one round patch; NAN: it is not */
    double nodes_per_patch;            /* nodes per patch, for the report */
    struct rc_conductance conductance; /* NAN: unknown */
    /* m, in a history: approach from the first touch of the first shape, for this solution and for the first
     * touch of the shape after it; NAN: unknown. */
    double indentation, residual_indentation;
    /* for a tapered map: contact area inside the taper, m^2, and its fraction of the area inside; NAN: not
     * tapered, or no node lies inside */
    double inside_area, inside_fraction;
};

struct run {
    struct drive d;
    const struct solve_args *args;
    struct physics *physics;                    /* of args; `ask` of a row may change it */
    const struct effect *active[SOLVE_EFFECTS]; /* rows; the last is NULL */
    const double *
        asked; /* the times or speeds of the points, if several shifts make others of them; or NULL */
    const struct relaxation_law *material; /* of a viscoelastic body 1; NULL: it is elastic */
    const char *relief;          /* advice against high pressures, before "a smaller load" */
    const struct numbers *steps; /* the list of loads or approaches               */
    size_t step;                 /* index in the list, from 0 */
    size_t cases;                /* of the lists, for --dry-run */
    bool apart;                  /* the load is 0: the bodies are separated */
    struct rc_model *model;      /* model of the map */
    struct rc_solver *solver;    /* solver of the model, which has the solution */
    double bound_min, bound_max; /* Pa, range of the upper bounds of the pressure; without bounds:
                                    INFINITY, -INFINITY */
    bool bound_varies;           /* they are a map */
    double rms_slope;            /* of the input heights; only for a report */
    double height_error;         /* m: error of the input heights */
    double result, done;         /* seconds */
    struct rc_grid *g;           /* the heights of the case */
    struct solution solution;    /* of the load */
};

/* Active rows with this member. */
#define SOLVE_EACH(run, e, member)                                                                 \
    for (const struct effect *const *e##_at = (run)->active, *e; (e = *e##_at) != NULL; e##_at++)  \
        if (e->member)
/* The first active row with this member, or NULL. */
#define SOLVE_FIRST(run, member)                                                                   \
    solve_first(run, offsetof(struct effect, member), sizeof((struct effect){0}.member))
const struct effect *solve_first(const struct run *run, size_t at, size_t size);

extern const struct effect *const solve_effects[]; /* all rows; the last is NULL */
extern const struct rc_figure solve_figures[];     /* of the report, beside those of the library */
extern const char *solve_frames[];                 /* of --output; the last is NULL */

static inline bool
solve_wanted(const struct solve_args *args, size_t frame)
{
    return args->output >> frame & 1;
}
/* True if the heights of the case change with the position of a point. */
static inline bool
solve_moves(const struct run *run)
{
    return run->d.points > 0 && (run->d.point[0].given >> RC_POSITION & 1);
}

/* ---- options.c ---- */

/* The options of rc-solve, from its rows; sets solve_frames too. */
const struct opt *solve_options(void);
/* Reads and checks the command line. */
void solve_read(struct run *run);
/* Adds a word to --output. */
void solve_add_frame(const char *word);

/* ---- case.c ---- */

/* Solves the loads of the heights `g`, and writes and reports the results. */
void solve_case(struct run *run);
/* The contact at one load of the list. */
struct rc_problem solve_problem(struct run *run, size_t step);

/* ---- judge.c ---- */

/* True at the pull-off, the point after a list. */
bool solve_pulls_off(const struct run *run);
/* "steel.x3p, case 2, load 3 N": the name of a solution in messages. */
const char *solve_where(const struct run *run, const struct rc_grid *g, char *text, size_t size);
/* Warns of the limits of a solution and, with --verbose, prints its figures. */
void solve_judge(struct run *run, const struct solution *solution);
/* Parts of solve_judge. The limits of the figures are in the tables of the model. */
void solve_warn_of_limits(struct run *run, const char *where, const char *unstable);
void solve_warn_of_theory(struct run *run, const char *where, const struct solution *solution);
void solve_warn_of_end(struct run *run, const char *where, const struct solution *solution);

/* ---- report.c ---- */

/* Writes the row of the case if --report was given. */
void solve_report(struct drive *d, const struct rc_model *m);
/* Reports figures of the solution with these names. */
void solve_report_named(struct report *r, const struct run *run, const char *names);
/* Ends the tool if the memory is too small for the solution, before its plan. */
void solve_demand_memory(struct run *run, const struct rc_problem *problem);
/* Prints which effects will be computed, which are left out, and the cost. */
void solve_plan(struct run *run, const struct rc_problem *problem);

/* relaxation.c: the factor of all times of this case, and the temperature. */
void solve_report_shift(struct report *report, const struct run *run);
/* Whether a case leaves the table of --relaxation; null if it has none. */
void solve_report_extrapolated(struct report *report, int outside);

#endif
