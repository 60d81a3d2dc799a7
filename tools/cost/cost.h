/*
 * The face of this folder: rc-cost. A trial is one way to solve the contact, and what came of it; a
 * case has many of them, and one reference solution. Each trial runs in a process of its own
 * (process.c), as a command would: what it takes in time and memory is not helped by the trials
 * before it.
 */
#ifndef RC_COST_H
#define RC_COST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "libcontact/contact.h"
#include "tools/cli/cli.h"
#include "tools/problem/problem.h"

/* ---- trials.c: which trials there are ---- */

struct cost_settings {
    const char *method, *kernel;
    const char *arithmetic; /* of the displacements                                           */
    unsigned coarse;        /* nodes of the map, along a side, for one of the grid solved     */
    double tol;
    size_t increments; /* of a body that yields inside; 0: elastic, or a hardness                 */
    double stack;      /* its slabs, in times of those that rc-solve would take                   */
    bool precise;      /* its strains in double precision                                         */
    bool attracts;     /* bodies that attract each other                                          */
};

enum cost_state {
    COST_OPEN,
    COST_DONE,
    COST_LEFT_OUT, /* not begun: `why`        */
    COST_STOPPED,  /* begun, no result: `why` */
};

struct cost_trial {
    struct cost_settings settings;
    enum cost_state state;
    char why[256];
    double expected;       /* s, before it ran                                                */
    struct rc_shape shape; /* of the grid that is solved                                      */
    double seconds;        /* heights to pressure, plans and coarse levels included: the least
                              of all runs                                                     */
    size_t runs;
    double convolutions; /* in equivalents of one on the map's own grid                       */
    size_t memory;       /* bytes beyond the map and the result                               */
    size_t slabs, applications; /* of a body that yields inside: what was taken, and what it took */
    double cohesive_nodes; /* cohesive length in nodes of its grid; NAN: nothing attracts         */
    struct rc_contact contact;
    double error; /* relative L1, of the pressure on the map's own grid                       */
    double area_error, peak_error, approach_error; /* relative, signed; NAN: unknown          */
    double flow, flow_error, flow_seconds; /* of rc-leak on its own grid: m^3, relative, s     */
    bool front;      /* no other is both quicker and nearer                                   */
    bool optimistic; /* its estimate is below its error, by more than 1 %                     */
};

/* The trials, *n of them, which the caller frees. `kernels` and `methods`: bit k stands for row
 * k of libcontact's tables. NULL: memory is short. */
struct cost_trial *cost_trials(size_t kernels, size_t methods, size_t *n);
/* The same of a body that yields inside. */
struct cost_trial *cost_yielding_trials(size_t *n);
/* A grid of about 1/factor of the nodes a side on the same area, so that a period stays what it was
 * and a load has the same mean: where the number of nodes cannot be divided its cells are a little
 * wider or narrower. A side of one node keeps it. */
struct rc_shape cost_coarse_shape(const struct rc_shape *map, unsigned factor);
/* Place of the settings' method and engine among all pairs of these that are tried, or of their slabs; and
 * what the series is called, and a point of it. */
size_t cost_series(const struct cost_settings *settings);
const char *cost_series_name(char text[64], const struct cost_trial *trial);
const char *cost_point_name(char text[32], const struct cost_settings *settings);
/* The same of bodies that attract each other. */
struct cost_trial *cost_attracting_trials(size_t *n);
struct cost_settings cost_attracting_reference(void);
/* Settings of the reference: double precision throughout, to 1e-12; of a body that yields, more increments
 * than any trial and the finest slabs. */
struct cost_settings cost_reference(bool yields);

/* A trial of the stresses. */
struct cost_stress {
    const char *kernel;
    double tol; /* of a component over the largest pressure; 0: rounding                      */
    bool reference;
    enum cost_state state;
    char why[256];
    double expected, seconds;
    size_t runs, memory, coarse; /* coarse: depths that came from a coarser grid              */
    double error; /* largest of any component, over the largest pressure                      */
    double rms;   /* the same, root of the mean square                                        */
    double mises; /* of the largest Mises' stress, relative, signed                           */
    bool front;
};

/* ---- a case ---- */

struct cost_case {
    struct tool *tool;
    const struct rc_grid *heights;
    struct rc_shape shape;
    struct rc_problem problem;    /* engine, method and tol are those of a trial                 */
    bool by_approach;             /* that is given, not the load                                  */
    char leak;                    /* direction of a flow through the gap; 0: none                */
    const struct rc_yield *yield; /* of body 1; NULL: it is elastic, or has a hardness            */
    const struct rc_adhesion_problem *adhesion; /* but for the contact; NULL: nothing attracts    */
    double limit, began;  /* s: for all trials; when the first one started               */
    double budget, error; /* s, -: what a command is chosen for; NAN: the other, or none */
    bool choosing, shown; /* for one of them; all trials are shown nevertheless          */
    struct cost_trial reference;
    double *pressure; /* of the reference */
    struct cost_trial *trial;
    size_t trials;
    struct numbers depths; /* none: no stresses */
    double nu, mu;
    struct cost_stress *stress;
    size_t stresses;
};

/* "method, engine, tol 1e-04, 512 x 512" */
const char *cost_name(char text[128], const struct cost_trial *trial);

/* ---- expected_time.c ---- */

/* Seconds, from what has been measured on this map so far, else from what is known of machines. */
double cost_expect(const struct cost_case *c, const struct cost_trial *trial);
double cost_expect_stress(const struct cost_case *c, const struct cost_stress *trial);

/* ---- process.c ---- */

/* Memory, zeroed, that a process begun later shares. NULL: memory is short. */
void *cost_share(size_t bytes);
void cost_unshare(void *shared, size_t bytes);

enum cost_end {
    COST_ENDED,
    COST_LATE,        /* not done in the time allowed   */
    COST_INTERRUPTED, /* the tool has had a signal      */
    COST_DIED,        /* by a signal, or without a word */
};
/* work(ctx) in a process of its own; what it writes to shared memory is seen. `watch` is called
 * now and then. No thread may have been started in this process before. */
enum cost_end cost_run(void (*work)(void *ctx), void *ctx, double allowed,
                       void (*watch)(void *ctx));

/* ---- pressure.c ---- */

/* Bytes that a trial takes beside the maps of the case. */
size_t cost_memory(const struct cost_case *c, const struct cost_trial *trial);
/* Runs a trial once more, keeps the least of its times, and tells how far its solution is from
 * the reference, where there is one; `pressure`, on the map's own grid, may be NULL. False when
 * the tool was interrupted. */
bool cost_trial_run(struct cost_case *c, struct cost_trial *trial, double allowed,
                    double *pressure);

/* ---- stress.c ---- */

struct cost_stress *cost_stress_trials(const struct cost_case *c, size_t *n);
/* The depths that rc-stress --depths auto would take under the reference. */
void cost_stress_depths(struct cost_case *c);
bool cost_stress_run(struct cost_case *c, struct cost_stress *trial, double allowed);

/* ---- schedule.c ---- */

/* Leaves out what cannot be done on this map, or need not. */
void cost_exclude(struct cost_case *c);
/* Whether a trial that has been run so often, and takes so long, is to be run again. Short ones are
 * repeated, in turns: the least of their times is what the work takes, what is above it is due to
 * other programs. */
bool cost_again(size_t runs, double seconds);
/* Runs what fits into the limit, the quickest first, and what is short several times. */
void cost_run_trials(struct cost_case *c);

enum {
    COST_BODY = 48
};

/* ---- what was measured: front.c, command.c, table.c, report.c, plot.c ---- */

/* Sets `front` and `optimistic` of all trials. */
void cost_mark(struct cost_case *c);
/* The one command line for a time or an accuracy; ends the tool where there is none. */
void cost_command(const struct cost_case *c, FILE *out);
void cost_table(const struct cost_case *c, FILE *out);
/* "2 layers" after `between`; nothing of one material. */
const char *cost_body(const struct cost_case *c, const char *between, char text[COST_BODY]);
void cost_report(const struct cost_case *c, struct report *out);
/* Error against time as a PNG, SVG or PDF (`ending`: "png", ...) in memory, which the caller
 * frees. */
unsigned char *cost_plot(const struct cost_case *c, const char *ending, size_t *bytes,
                         struct rc_err *err);

#endif
