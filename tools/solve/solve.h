/*
 * The interface of this folder: options of rc-solve, its run, its messages and its report.
 */
#ifndef RC_SOLVE_H
#define RC_SOLVE_H

#include <stdio.h>

#include "libcontact/contact.h"
#include "tools/cli/cli.h"
#include "tools/model/model.h"
#include "tools/problem/problem.h"

/* Key of a shape after yield: its possible error, m. */
#define HEIGHT_ERROR "height.error"

enum solve_frame { /* in the order of the words of --output and of writing */
    SOLVE_CONTACT, /* before the pressure, because readers need it to interpret the pressure */
    SOLVE_PRESSURE,
    SOLVE_GAP,
    SOLVE_DISPLACEMENT,
    SOLVE_HEIGHT,
    SOLVE_PLASTIC,
    SOLVE_RESIDUAL,
    SOLVE_STRAIN, /* several frames for each slab */
    SOLVE_ADHESION,
    SOLVE_FRAMES
};
extern const char *const solve_frames[]; /* of --output; the last is NULL */

struct solve_args {
    struct physics physics;
    double tol;
    const char *kernel, *method;
    const char *conductivity; /* conductivities of both bodies, or NULL                   */
    const char *yield, *increments, *slabs; /* words of the command line, or NULL */
    const char *relaxation;                 /* words of the command line, or NULL */
    double shift;                           /* factor of all times of the material */
    struct numbers time;                    /* none: without --relaxation */
    struct numbers speed;                   /* none: without sliding      */
    const char *along, *track;              /* x or y; fresh or repeated  */
    const char *adhesion;         /* words of the command line, or NULL                       */
    bool pull_off;                /* pull-off is an additional last case */
    struct numbers travel;        /* positions; none: the contact stays */
    const char *counter, *window; /* words of the command line, or NULL */
    double counter_travel;
    size_t passes;
    const char *tilt;  /* a word, or NULL                                          */
    struct numbers at; /* x and y; none: the middle                                */
    bool stiffness, discretization;
    size_t output; /* bits of enum solve_frame */
    struct drive_args drive;
};

extern const struct opt solve_contact_options[]; /* for a struct solve_args */

/* --yield: body 1 yields in its volume. */
struct yielding {
    bool wanted;
    struct yield_law read;
    struct rc_yield_law law;
    size_t asked;        /* increments of a load on the command line; 0: auto */
    bool companion;      /* a second run with half of them estimates their error */
    size_t slab_count;   /* slabs on the command line; 0: auto */
    struct numbers list; /* or thicknesses                                                */
    bool on;             /* something has yielded                                       */
    const struct rc_yield_figures *found; /* NULL: no load was solved yet */
    size_t worst; /* the case with the largest error of increments, and its number of increments */
    size_t worst_increments;
    double worst_error;
};

/* --adhesion: the bodies attract each other. */
struct adhering {
    bool wanted;
    struct adhesion_law law;
    struct rc_adhesion_scales scales;        /* scales of the law on this grid */
    const struct rc_adhesion_state *figures; /* figures of the current point; NULL: none */
    bool pulling;                            /* this case is the pull-off */
};

/* --travel: the contact travels over the map. */
struct travelling {
    bool wanted;
    size_t window[2], passes;
    struct rc_grid *counter, *track; /* heights of body 2 (NULL: none), and of body 1 */
    const struct rc_travel_figures *found;
    double *row; /* mean equivalent plastic strain of each row of each slab, after the last pass */
    size_t rows; /* 0: nothing has yielded */
    double gain, first_gain; /* largest growth of such a mean in a pass, and in the first one */
};

/* --relaxation: body 1 is viscoelastic. */
struct relaxing {
    bool wanted;
    struct relaxation_law law;
    bool before;       /* the load acts before the first asked time */
    double shortest;   /* s, between two times */
    size_t increments; /* on the command line; 0: auto */
    const struct rc_viscoelastic_figures *found;
};

/* --speed: body 2 slides over body 1. */
struct sliding {
    bool wanted;
    struct rc_relaxation *material; /* of E/(1 - nu^2) */
    const struct rc_sliding_figures *found;
};

/* The figures of a solution. */
struct solution {
    struct rc_contact contact;
    struct error_parts errors;         /* parts of contact.pressure_error, if it has several */
    struct rc_patches patches;         /* patches of the contact; their list only for a report */
    double slope;                      /* RMS slope where the bodies touch; NAN: not computed */
    double stiffness;                  /* N/m; NAN: unknown                                       */
    double nodes_per_patch;            /* nodes per patch, for the report */
    struct rc_conductance conductance; /* NAN: unknown */
    /* m, in a history: approach from the first touch of the first shape, for this solution and for the first
     * touch of the shape after it; NAN: unknown. */
    double indentation, residual_indentation;
    /* for a tapered map: contact area inside the taper, m^2, and its fraction of the area inside; NAN: not
     * tapered, or no node lies inside */
    double inside_area, inside_fraction;
};
#define SOLUTION_NONE                                                                              \
    {                                                                                              \
        .slope = NAN, .stiffness = NAN, .conductance = {NAN, NAN, NAN}, .indentation = NAN,        \
        .residual_indentation = NAN, .inside_area = NAN, .inside_fraction = NAN                    \
    }

struct run {
    struct drive d;
    const struct solve_args *args;
    const struct numbers *steps; /* the list of loads or approaches               */
    size_t step;                 /* index in the list, from 0 */
    bool apart;                  /* the load is 0: the bodies are separated */
    struct rc_model *model;      /* model of the map */
    struct rc_solver *solver;    /* solver of the model, which has the solution */
    bool stiffness, conductance; /* whether they are computed */
    struct yielding yielding;
    struct adhering adhering;
    struct travelling travelling;
    struct relaxing relaxing;
    struct sliding sliding;
    bool tilt;                         /* the counter body is free to tilt */
    double k[2];                       /* conductivities of the bodies, SI                  */
    const char *conductance_unit;      /* W/K or S; NULL: the conductivities have no unit   */
    double rms_slope;                  /* of the input heights; only for a report */
    double height_error;               /* m: error of the input heights */
    struct rc_grid *hardness;          /* map of the hardness in the case; NULL: a number or none */
    double hardness_min, hardness_max; /* Pa, range of the numbers; without numbers: INFINITY,
                                          -INFINITY */
    double result, done;               /* seconds */
    struct rc_grid *g;                 /* the heights of the case */
    struct solution solution;          /* of the load */
};

static inline bool
solve_wanted(const struct solve_args *args, int frame)
{
    return args->output >> frame & 1;
}

/* "steel.x3p, case 2, load 3 N": the name of a solution in messages. */
const char *solve_where(const struct run *run, const struct rc_grid *g, char *text, size_t size);
/* Warns of the limits of a solution and, with --verbose, prints its figures. */
void solve_judge(struct run *run, const struct rc_grid *g, const struct solution *solution);

/* Writes the row of the case if --report was given. `solver` is NULL for separated bodies. */
void solve_report(struct drive *d, const struct rc_model *m);
/* The bytes that a solution needs in addition to this map. */
size_t solve_memory(const struct run *run, const struct rc_grid *g,
                    const struct rc_problem *problem);
/* Prints which effects will be computed, which are left out, and the cost. */
void solve_plan(struct run *run, const struct rc_grid *g, const struct rc_problem *problem);

/* ---- case.c ---- */

/* Solves the loads of the heights `g`, and writes and reports the results. */
void solve_case(struct run *run);

/* Parts of solve_judge. The limits of the figures are in the tables of the model. */
void solve_warn_of_limits(struct run *run, const char *where);
void solve_warn_of_theory(struct run *run, const struct rc_grid *g, const char *where,
                          const struct solution *solution);
void solve_warn_of_end(struct run *run, const char *where, const struct rc_contact *contact);

/* ---- adhesion.c ---- */

/* Reads --adhesion and --pull-off; ends the tool if they are invalid. */
void adhesion_read(struct run *run);
struct rc_model *adhesion_model(struct run *run, const struct rc_grid *g,
                                const struct rc_problem *contact);
/* Sets the keys of frames of an adhesive contact; none without --adhesion. */
void adhesion_set_key(struct run *run, struct rc_grid *as, const struct rc_contact *c);
/* Takes the place of solve_judge for an adhesive contact. */
void adhesion_judge(struct run *run, const struct rc_grid *g, const struct solution *solution);
size_t adhesion_memory(const struct run *run, const struct rc_grid *g,
                       const struct rc_problem *contact);
/* Finds the cost of a state and the scales of the law on this grid; ends the tool if they are invalid. */
void adhesion_expect(struct run *run, const struct rc_grid *g, const struct rc_problem *contact,
                     struct rc_expected *expected);
const char *adhesion_state(const struct run *run);
void adhesion_report(struct report *report, const struct run *run);

/* ---- travel.c: all but travel_read do nothing without --travel ---- */

/* Reads --travel and its options; ends the tool if they are invalid. */
void travel_read(struct run *run);
/* Puts a map of the heights at a position in the place of the heights of the case, and removes it. */
void travel_begin(struct run *run);
void travel_end(struct run *run);
struct rc_model *travel_model(struct run *run, struct rc_model *inner);
size_t travel_points(const struct run *run);
/* Bytes a node of the maps of the model. */
size_t travel_bytes(const struct run *run);
double travel_position(const struct run *run, size_t point);
void travel_mark(struct run *run);
void travel_look(struct run *run, struct rc_model *m);
void travel_end_pass(struct run *run, const struct rc_model *m);
void travel_set_keys(struct run *run, struct rc_grid *as);
void travel_report(struct report *report, const struct run *run);
const char *travel_state(const struct run *run);

/* ---- relax.c: all but relax_read do nothing without --relaxation ---- */

/* Reads --relaxation, before the checks of the bodies, and checks it after them; ends the tool if it is
 * invalid. */
void relax_read(struct run *run, struct solve_args *args);
void relax_check(struct run *run);
void relax_warn_of_material(struct run *run);
/* The points of the history, their times, and their places in the list of loads. */
size_t relax_points(const struct run *run);
double relax_time(const struct run *run, size_t point);
size_t relax_step(const struct run *run, size_t point);
size_t relax_largest(const struct run *run);
/* The part of --tol for each contact, or for the steps in time. */
double relax_part(const struct run *run, bool contacts);
struct rc_model *relax_model(struct run *run, struct rc_model *inner);
void relax_mark(struct run *run);
bool relax_look(struct run *run, const struct rc_model *m);
/* Sets the parts of the error. */
void relax_parts(const struct run *run, struct solution *solution);
bool relax_warn_of_end(struct run *run, const char *where, const struct rc_contact *contact);
void relax_report(struct report *report, const struct run *run);
const char *relax_state(const struct run *run);

/* ---- slide.c: all do nothing without --speed ---- */

/* Ends the tool if the options are invalid. */
void slide_check(struct run *run);
/* The cases, their speeds, and their places in the list of loads. */
size_t slide_points(const struct run *run);
double slide_speed(const struct run *run, size_t point);
size_t slide_step(const struct run *run, size_t point);
struct rc_model *slide_model(struct run *run, const struct rc_problem *problem);
/* Takes the figures of a case. */
void slide_look(struct run *run, const struct rc_model *m, struct rc_contact *contact);
void slide_warn(struct run *run, const char *where);
void slide_report(struct report *report, const struct run *run);
const char *slide_state(const struct run *run);

/* ---- yield.c: all but yield_read do nothing without --yield ---- */

/* Reads --yield, --increments and --slabs; ends the tool if they are invalid. */
void yield_read(struct run *run);
void yield_free(struct run *run);
/* The model of a body that may yield. */
struct rc_model *yield_model(struct run *run, const struct rc_grid *g,
                             const struct rc_problem *problem);
/* Plans the remaining loads, before a load in N; and after a load takes its figures. */
void yield_plan(struct run *run, struct rc_model *m, double load);
/* For --dry-run: solves the elastic contact, which shows how deep the body yields. Sets the cost of the first
 * load, and returns that of all loads over it. */
double yield_expect(struct run *run, double load, struct rc_expected *expected);
void yield_found(struct run *run, const struct rc_model *m);
void yield_mark(struct run *run);
/* Replaces the estimated error of the contact, and its parts, by those of the plastic body. */
void yield_look(struct run *run, struct solution *solution);
/* Writes the plastic strain slab by slab; `like`: shape and keys of the frames; buffer: memory for a map. */
void yield_put_strain(struct run *run, const struct rc_model *m, const struct rc_grid *like);
/* The largest pressure and its name (NULL: not needed). If the pressures of single nodes alternate, it is the
 * largest mean over 2 x 2 nodes. */
double yield_peak(const struct run *run, double max_pressure, const char **name);
void yield_judge(struct run *run, const char *where, const struct solution *solution);
/* Warns of a load whose error is above the goal or unknown. Returns false if there was no warning. */
bool yield_warn_of_end(struct run *run, const char *where, const struct solution *solution);
/* The cost of the solution in words. */
void yield_tell(const struct run *run, const struct rc_contact *contact, char *text, size_t size);
const char *yield_state(const struct run *run);
void yield_report(struct report *report, const struct run *run);

#endif
