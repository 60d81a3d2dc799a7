/*
 * The face of this folder: rc-solve's options, its run, and what is told about it.
 */
#ifndef RC_SOLVE_H
#define RC_SOLVE_H

#include <stdio.h>

#include "libcontact/contact.h"
#include "tools/cli/cli.h"
#include "tools/model/model.h"
#include "tools/problem/problem.h"

enum solve_frame { /* in the order of --output's words, and of writing */
    SOLVE_CONTACT, /* before the pressure: who reads frame by frame knows by then what touches */
    SOLVE_PRESSURE,
    SOLVE_GAP,
    SOLVE_DISPLACEMENT,
    SOLVE_HEIGHT,
    SOLVE_PLASTIC,
    SOLVE_RESIDUAL,
    SOLVE_STRAIN, /* several frames of each slab */
    SOLVE_ADHESION,
    SOLVE_FRAMES
};
struct solve_frame_kind {
    const char *name, *unit;
};
extern const struct solve_frame_kind solve_frames[SOLVE_FRAMES];
const char *solve_frame_word(size_t k); /* of --output */

struct solve_args {
    struct physics physics;
    double tol;
    const char *kernel, *method;
    const char *conductivity; /* of both bodies, or NULL                                  */
    const char *yield, *increments, *slabs; /* words of the line, or NULL                   */
    const char *adhesion; /* words of the command line, or NULL                       */
    bool pull_off;        /* a case of it comes last                                  */
    const char *tilt;     /* a word, or NULL                                          */
    struct numbers at;    /* x and y; none: the middle                                */
    bool stiffness, discretization;
    size_t output; /* bits of enum solve_frame */
    struct drive_args drive;
};

extern const struct opt solve_contact_options[]; /* for a struct solve_args */

/* --yield: body 1 yields inside. */
struct yielding {
    bool wanted;
    struct yield_law read;
    struct rc_yield law;
    size_t asked;        /* increments of a load on the line, 0: auto                     */
    size_t slab_count;   /* on the line, 0: auto                                          */
    struct numbers list; /* or thicknesses                                                */
    bool on;             /* something has yielded                                       */
    const struct rc_yielding_figures *found; /* NULL: no load was looked at */
    size_t worst; /* the case with the largest error of increments, its increments */
    size_t worst_increments;
    double worst_error;
};

/* --adhesion: the bodies attract each other. */
struct adhering {
    bool wanted;
    struct attraction law;
    struct rc_adhesion_scales scales; /* on this grid                                      */
    const struct rc_adhesion_figures *figures; /* of the point that was looked at; NULL: none */
    bool pulling; /* this case is the one of --pull-off                */
};

struct run {
    struct tool t;
    const struct solve_args *args;
    const struct numbers *steps; /* the list of loads or approaches               */
    size_t step;                 /* which of them, from 0                         */
    bool apart;                  /* it is 0: no load                              */
    enum rc_status status;       /* of the load                                   */
    struct course course;        /* and the number of the case                    */
    struct rc_model *model;      /* of the map                                    */
    struct rc_solver *solver;    /* of the model, which has the solution          */
    bool stiffness, conductance; /* whether they are found                            */
    struct yielding yielding;
    struct adhering adhering;
    bool tilt;                         /* the counter body is free to                       */
    double k[2];                       /* conductivities of the bodies, SI                  */
    const char *conductance_unit;      /* W/K or S; NULL: the conductivities have no unit   */
    double rms_slope;                  /* of the heights that came in; only for a report */
    double height_error;               /* m: of the heights that came in */
    const struct rc_grid *hardness;    /* a map of it, in the case; NULL: a number or none */
    double hardness_min, hardness_max; /* Pa, of the numbers; no number: INFINITY, -INFINITY */
    struct report report;
    struct checkpoint *checkpoint; /* NULL: none */
    char crc[16],
        hardness_crc[16]; /* of the heights, the sphere included, and of the map of hardness */
    double began, setup, iterate, result, done; /* seconds */
};

static inline bool
solve_wanted(const struct solve_args *args, int frame)
{
    return args->output >> frame & 1;
}

static inline double
solve_now(void)
{
    return tool_now();
}

/* What is known of a solution. */
struct solution {
    struct rc_contact contact;
    struct error_parts errors;         /* of contact.pressure_error, where it has several         */
    struct rc_patches patches;         /* of the contact; the list of them only for a report */
    double slope;                      /* RMS, where the bodies touch; NAN: not looked at         */
    double stiffness;                  /* N/m; NAN: unknown                                       */
    double nodes_per_patch;            /* of the row that is reported                            */
    struct rc_conductance conductance; /* NAN: unknown */
    /* m, in a history, from the first touch of the first shape; NAN: unknown. Of this solution, and
     * of the first touch of the shape that it leaves. */
    double indentation, residual_indentation;
    /* of a tapered map: contact inside of the taper, m^2, and its share of what lies inside; NAN: not
     * tapered, or nothing does */
    double inside_area, inside_fraction;
};
#define SOLUTION_NONE                                                                              \
    {                                                                                              \
        .slope = NAN, .stiffness = NAN, .conductance = {NAN, NAN, NAN}, .indentation = NAN,        \
        .residual_indentation = NAN, .inside_area = NAN, .inside_fraction = NAN                    \
    }

/* "steel.x3p, case 2, load 3 N": which solution is meant, for messages. */
const char *solve_where(const struct run *run, const struct rc_grid *g, char *text, size_t size);
/* Warns of a solution that is not what it looks like, and, with --verbose, tells its figures. */
void solve_judge(struct run *run, const struct rc_grid *g, const struct solution *solution);

/* The row of the case, where --report asks for it. `solver` is NULL for bodies that are apart. */
void solve_report(struct run *run, const struct rc_grid *g, const struct rc_solver *solver,
                  const struct solution *solution);
/* Bytes that a solution of this map takes beside the map. */
size_t solve_memory(const struct run *run, const struct rc_grid *g,
                    const struct rc_problem *problem);
/* What the scene calls for and what it doesn't, and what that costs, in words. */
void solve_plan(struct run *run, const struct rc_grid *g, const struct rc_problem *problem);

/* ---- case.c ---- */

/* Solves the loads of these heights, and writes and reports what is found. hardness: a map of it, or NULL. */
void solve_case(struct run *run, struct rc_grid *g, const struct rc_grid *hardness);

/* Parts of solve_judge. Limits: of figures of the model, in their tables. */
void solve_warn_of_limits(struct run *run, const char *where);
void solve_warn_of_theory(struct run *run, const struct rc_grid *g, const char *where,
                          const struct solution *solution);
void solve_warn_of_end(struct run *run, const char *where, const struct rc_contact *contact);

/* ---- adhesion.c ---- */

/* Reads --adhesion and --pull-off, or ends the tool. */
void adhesion_read(struct run *run);
struct rc_model *adhesion_model(struct run *run, const struct rc_grid *g,
                                const struct rc_problem *contact);
/* The keys of frames of such a contact; none without --adhesion. */
void adhesion_set_key(struct run *run, struct rc_grid *as, const struct rc_contact *c);
/* Instead of solve_judge. */
void adhesion_judge(struct run *run, const struct rc_grid *g, const struct solution *solution);
size_t adhesion_memory(const struct run *run, const struct rc_grid *g,
                       const struct rc_problem *contact);
/* What a state will take, and with it the law on this grid; or ends the tool. */
void adhesion_expect(struct run *run, const struct rc_grid *g, const struct rc_problem *contact,
                     struct rc_expected *expected);
/* What a checkpoint has to agree in; "" without --adhesion. */
void adhesion_mark(const struct run *run, char *value, size_t size);
const char *adhesion_state(const struct run *run);
void adhesion_report(struct report *report, const struct run *run);

/* ---- yield.c: all but yield_read do nothing without --yield ---- */

/* Reads --yield, --increments, --slabs, or ends the tool. */
void yield_read(struct run *run);
void yield_free(struct run *run);
/* The model of a body that may yield. */
struct rc_model *yield_model(struct run *run, const struct rc_grid *g,
                             const struct rc_problem *problem);
/* Before a load, N: the loads that are left; and after it. */
void yield_plan(struct run *run, struct rc_model *m, double load);
void yield_found(struct run *run, const struct rc_model *m);
/* What a checkpoint of such a body must agree in, k from 0 on: its name, and its value, empty
 * without --yield. */
enum {
    YIELD_MARKS = 6
};
const char *yield_mark(const struct run *run, int k, char *value, size_t size);
/* Puts the estimated error of the plastic body, and its parts, in place of the contact's. */
void yield_look(struct run *run, struct solution *solution);
/* The plastic strain slab by slab; `like`: the frames' shape and keys; buffer: room for a map. */
void yield_put_strain(struct run *run, const struct rc_model *m, const struct rc_grid *like,
                      double *buffer);
/* The largest pressure, and its name (NULL: not wanted): of means of 2 x 2 nodes where single nodes
 * alternate. */
double yield_peak(const struct run *run, double max_pressure, const char **name);
void yield_judge(struct run *run, const char *where, const struct solution *solution);
/* Warns of a load whose error is larger than asked for, or unknown. False: there is nothing to say of
 * that. */
bool yield_warn_of_end(struct run *run, const char *where, const struct solution *solution);
/* What the solution took, in words. */
void yield_tell(const struct run *run, const struct rc_contact *contact, char *text, size_t size);
const char *yield_state(const struct run *run);
void yield_report(struct report *report, const struct run *run);

#endif
