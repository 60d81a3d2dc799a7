/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: rc-cost. A trial is one way to solve the contact, or to compute its stresses.
 * The reference is the most accurate solution. rc-solve, rc-stress and rc-leak do the work, one process per
 * trial, and rc-pick makes the coarser maps. The cost of each trial is in the reports of these tools.
 */
#ifndef RC_COST_H
#define RC_COST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

/* ---- figures ---- */

struct cost_figures { /* NAN: unknown */
    double increments, slabs, applications, cohesive_nodes, seconds, runs, coarse_depths;
    double convolutions, memory, iterations, estimate, error, contact_area_error;
    double max_pressure_error, approach_error, rms_error, mises_error, flow_conductance;
    double flow_error, flow_seconds;
};

enum { /* subjects of a trial and of a case */
    COST_PRESSURE = 1,
    COST_YIELD = 2,
    COST_ADHESION = 4,
    COST_LEAK = 8,
    COST_STRESS = 16,
};

/* A figure has a source and a format. */
struct cost_column {
    struct rc_figure figure;   /* in rc-cost's report; without a name: the end        */
    unsigned of;               /* bits: its subjects                                  */
    const char *head, *format; /* in the table; NULL: not in the table                */
    const char *from;          /* its key in the report of the tool; NULL: none       */
    bool relative;             /* relative difference from the reference              */
    bool early;                /* known before the run                                */
    double scale;              /* divides it in the table; 0: 1                       */
};
extern const struct cost_column cost_columns[];
double *cost_value(const struct cost_column *column, struct cost_figures *figures);

/* ---- trials.c: the list of trials ---- */

enum cost_state {
    COST_OPEN,
    COST_DONE,
    COST_LEFT_OUT, /* not started: `why` */
    COST_STOPPED,  /* started, no result: `why` */
};

struct cost_trial {
    unsigned about; /* COST_STRESS; else COST_PRESSURE and the bits of the case */
    bool reference;
    const char *method, *kernel;
    const char *arithmetic; /* arithmetic of the convolutions */
    unsigned coarse;        /* nodes of the map per node of the solved grid, along a side */
    double tol;             /* 0: rounding                                                */
    double goal; /* --tol of rc-solve; 0: its default. For a body that yields, the asked error */
    size_t increments;         /* only for a body that yields */
    double stack;              /* number of its slabs, relative to rc-solve's default */
    struct rc_shape shape;     /* nodes of the solved grid */
    double planned, mebibytes; /* s and memory by rc-solve --dry-run; NAN: unknown */
    enum cost_state state;
    char why[256];
    double expected; /* s, before the run */
    struct cost_figures is;
    bool converged;
    bool front;      /* no other trial is both faster and more accurate */
    bool optimistic; /* its estimated error is below its error by more than 1 % */
};

enum {
    COST_WORDS = 192 /* most words of a command line */
};

/* The contact as options of rc-solve, and text of the command line, or NULL. */
struct cost_line {
    const char *word[COST_WORDS];
    size_t words;
    struct rc_boundary boundary;
    const char *leak, *depths, *nu, *mu;
};

struct cost_files {
    int grid[4]; /* the map, and the map with 1/2, 1/4, 1/8 of its nodes a side; -1: not made */
    int solution, output; /* solution of the reference, output of the last trial */
    int nowhere;          /* /dev/null */
};

struct cost_case {
    struct tool *tool;
    const struct rc_grid *heights;
    struct rc_shape shape;
    unsigned about;
    struct cost_line line;
    double limit, began; /* s: limit of all trials; start of the first one */
    /* s, relative error: wanted time or accuracy of the command; NAN: not given */
    double budget, error;
    bool choosing, shown; /* a command is wanted; all trials are shown nevertheless */
    double around;        /* s of a process besides its solution */
    struct cost_trial reference;
    double *pressure;         /* pressure of the reference */
    char *solved;             /* its report */
    char *stressed;           /* the report of the most accurate stresses, or NULL */
    double base_slabs;        /* slabs by default of rc-solve; NAN: not known yet */
    struct cost_trial *trial; /* trials of pressures, then of stresses */
    size_t pressures, trials, room;
    struct cost_files files;
    char *said; /* standard error of the last program */
};

/* Makes all trials of the case; c->about and c->boundary must be set. `kernels` and `methods`: bit k stands
 * for row k of libcontact's tables. Ends the tool when memory is short. */
void cost_trials(struct cost_case *c, size_t kernels, size_t methods);
/* Index of the trial's series among all series, the name of the series, and of a point in it. */
size_t cost_series(const struct cost_trial *trial);
const char *cost_series_name(char text[64], const struct cost_trial *trial);
const char *cost_point_name(char text[32], const struct cost_trial *trial);
/* "method, engine, tol 1e-04, 512 x 512" */
const char *cost_name(char text[128], const struct cost_trial *trial);
/* Appends the options of the trial for rc-solve after n words; returns the number of words. Valid until the
 * next call. */
size_t cost_trial_words(const struct cost_trial *trial, const char *word[], size_t n);

/* ---- run.c: programs ---- */

/* An unnamed file, deleted when its last descriptor is closed. Ends the tool on failure. */
int cost_file(struct tool *tool);
/* Opens it for reading from the beginning; the caller closes it. */
FILE *cost_file_read(struct tool *tool, int file);

/* Runs a command. `in` and `out`: its standard input and output, which is emptied first (-1: the output is
 * captured). Its standard error is then in c->said, its exit status in *status. `doing`: for the progress
 * line. */
enum process_end cost_run(struct cost_case *c, const char *const word[], int in, int out,
                          double allowed, const char *doing, int *status);
/* The number, or true or false, under this key in the last object of a report; NAN: none. */
double cost_number(const char *report, const char *key);
/* The last message of a tool, without the tool's name and the place of the frame; "": none. Valid until the
 * next call. */
const char *cost_message(const char *said);

/* ---- measure.c ---- */

/* Sets the expected cost of a trial, as far as rc-solve gives it; leaves out a trial that is not possible. */
void cost_plan(struct cost_case *c, struct cost_trial *trial);
/* Runs a trial once more, keeps the shortest time, and computes its error against the reference. False when
 * the tool was interrupted. */
bool cost_trial_run(struct cost_case *c, struct cost_trial *trial, double allowed);
/* Solves the reference; ends the tool on failure. */
void cost_solve_reference(struct cost_case *c);

/* ---- schedule.c ---- */

/* True if a trial with this many runs and this time is run again. Short trials are repeated in turns: the
 * shortest time is that of the work; the excess is due to other programs. */
bool cost_again(double runs, double seconds);
/* True if --error may choose it. By the triangle inequality the error is at most the distance from the
 * reference plus the error of the reference. On a coarser grid it is the error of the pressures there, which
 * are means over its cells. For a body that yields, rc-solve's estimate must be small enough too. */
bool cost_is_near(const struct cost_case *c, const struct cost_trial *trial);
/* Runs the trials that fit into the time limit, the fastest first; short ones several times. */
void cost_run_trials(struct cost_case *c);

/* ---- show.c, plot.c: results ---- */

enum {
    COST_BODY = 48
};

/* Sets `front` and `optimistic` of all trials. */
void cost_mark(struct cost_case *c);
/* Prints the command for a time or an accuracy; ends the tool when there is none. */
void cost_command(const struct cost_case *c, FILE *out);
void cost_table(const struct cost_case *c, FILE *out);
/* Writes "2 layers" after `between`; nothing for uniform bodies. */
const char *cost_body(const struct cost_case *c, const char *between, char text[COST_BODY]);
void cost_report(const struct cost_case *c, struct report *out);
/* A plot of error against time as a PNG, SVG or PDF (`ending`: "png", ...) in memory, which the caller
 * frees. */
unsigned char *cost_plot(const struct cost_case *c, const char *ending, size_t *bytes,
                         struct rc_err *err);

#endif
