/*
 * The face of this folder: rc-cost. A trial is one way to solve the contact, or to find the stresses under
 * the reference, the most accurate solution. rc-solve, rc-stress and rc-leak do the work, a process a trial,
 * and rc-pick makes the coarser maps; what the trials cost stands in the reports of these tools.
 */
#ifndef RC_COST_H
#define RC_COST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

/* ---- figures ---- */

enum cost_figure { /* in the order of the report */
    COST_INCREMENTS,
    COST_SLABS,
    COST_APPLICATIONS,
    COST_COHESIVE,
    COST_SECONDS,
    COST_RUNS,
    COST_COARSE_DEPTHS,
    COST_CONVOLUTIONS,
    COST_MEMORY,
    COST_ITERATIONS,
    COST_ESTIMATE,
    COST_ERROR,
    COST_AREA_ERROR,
    COST_PEAK_ERROR,
    COST_APPROACH_ERROR,
    COST_RMS_ERROR,
    COST_MISES_ERROR,
    COST_FLOW,
    COST_FLOW_ERROR,
    COST_FLOW_SECONDS,
    COST_FIGURES
};

enum { /* what a trial is about, and a case */
    COST_PRESSURE = 1,
    COST_YIELD = 2,
    COST_ADHESION = 4,
    COST_LEAK = 8,
    COST_STRESS = 16,
};

/* A figure: where it comes from, and how it is shown. */
struct cost_column {
    const char *key, *unit; /* in rc-cost's report                                              */
    unsigned of;            /* bits of what it belongs to                                       */
    const char *from;       /* its key in the report of the tool that did the work; NULL: none  */
    bool relative;          /* to that of the reference, less 1                                 */
    const char *head,
        *format;  /* in the table; NULL: not there                                    */
    double scale; /* of its value there; 0: 1                                         */
};
extern const struct cost_column cost_columns[COST_FIGURES];

/* ---- trials.c: which trials there are ---- */

enum cost_state {
    COST_OPEN,
    COST_DONE,
    COST_LEFT_OUT, /* not begun: `why`        */
    COST_STOPPED,  /* begun, no result: `why` */
};

struct cost_trial {
    unsigned about; /* COST_STRESS; else COST_PRESSURE and the bits of the case */
    bool reference;
    const char *method, *kernel;
    const char *arithmetic; /* of the displacements                                           */
    unsigned coarse;        /* nodes of the map, along a side, for one of the grid solved     */
    double tol;             /* 0: rounding                                                    */
    double goal; /* --tol of rc-solve; 0: its own. Of a body that yields the error asked for  */
    size_t increments;         /* of a body that yields                                          */
    double stack;              /* its slabs, in times of those that rc-solve takes               */
    struct rc_shape shape;     /* of the grid that is solved                                     */
    double planned, mebibytes; /* s and memory, as rc-solve --dry-run says; NAN: unknown      */
    enum cost_state state;
    char why[256];
    double expected; /* s, before it ran */
    double figure[COST_FIGURES];
    bool converged;
    bool front;      /* no other is both quicker and nearer                                   */
    bool optimistic; /* its estimate is below its error, by more than 1 %                     */
};

enum {
    COST_WORDS = 192 /* of a command line */
};

struct cost_case {
    struct tool *tool;
    const struct rc_grid *heights;
    struct rc_shape shape;
    unsigned about;
    const char *word[COST_WORDS]; /* the contact, as rc-solve takes it */
    size_t words;
    bool periodic;
    const char *leak, *depths, *nu, *mu; /* as on the line, or NULL */
    double limit, began;  /* s: for all trials; when the first one started               */
    double budget, error; /* s, -: what a command is chosen for; NAN: the other, or none */
    bool choosing, shown; /* for one of them; all trials are shown nevertheless          */
    double around;        /* s that a process takes beside its solution                  */
    struct cost_trial reference;
    double *pressure;         /* of the reference */
    char *solved;             /* its report */
    char *stressed;           /* the report of the most accurate stresses, or NULL */
    double base_slabs;        /* that rc-solve takes; NAN: not known yet */
    struct cost_trial *trial; /* of pressures, then of stresses */
    size_t pressures, trials;
    int grid[4]; /* files: the map, and at 1/2, 1/4, 1/8 of its nodes a side; -1: not made */
    int solution, output; /* files: of the reference, and of the trial that ran last */
    int nowhere;          /* /dev/null */
    char *said;           /* by the program that ran last, on standard error */
};

/* All trials of the case, of which c->about and c->periodic are known. `kernels` and `methods`: bit k stands
 * for row k of libcontact's tables. Ends the tool where memory is short. */
void cost_trials(struct cost_case *c, size_t kernels, size_t methods);
/* Place of its series among all of them, what the series is called, and a point of it. */
size_t cost_series(const struct cost_trial *trial);
const char *cost_series_name(char text[64], const struct cost_trial *trial);
const char *cost_point_name(char text[32], const struct cost_trial *trial);
/* "method, engine, tol 1e-04, 512 x 512" */
const char *cost_name(char text[128], const struct cost_trial *trial);
/* The options of the trial for rc-solve, after n words; the number of words then. Valid until the next call. */
size_t cost_trial_words(const struct cost_trial *trial, const char *word[], size_t n);

/* ---- run.c: programs ---- */

/* A file without a name, which goes with its last descriptor. Ends the tool where none can be made. */
int cost_file(struct tool *tool);
/* The stream in it, from the beginning; the caller closes it. */
FILE *cost_file_read(struct tool *tool, int file);

enum cost_end {
    COST_ENDED,       /* with exit status 0 or 3        */
    COST_FAILED,      /* with another exit status       */
    COST_LATE,        /* not done in the time allowed   */
    COST_INTERRUPTED, /* the tool has had a signal      */
    COST_DIED,        /* by a signal                    */
};
/* Runs a command, the tool of that name beside this one or else on PATH, `in` and `out` its standard input
 * and output (-1: what it writes is said). What it says is in c->said then, its exit status in *status.
 * `doing`: for the progress line. */
enum cost_end cost_run(struct cost_case *c, const char *const word[], int in, int out,
                       double allowed, const char *doing, int *status);
/* Starts one whose standard output is read from *out. */
int cost_start(struct tool *tool, const char *const word[], int in, FILE **out);
/* Waits for it, or ends it first. */
void cost_wait(int process, bool kill);
/* A number, or true or false, under this key in the last object of a report; NAN: there is none. */
double cost_number(const char *report, const char *key);
/* The last message in what a tool has said, without the tool's name and the place of the frame; "": there is
 * none. Valid until the next call. */
const char *cost_message(const char *said);

/* ---- measure.c ---- */

/* Finds what the trial will cost, as far as rc-solve says; leaves it out where it cannot be done. */
void cost_plan(struct cost_case *c, struct cost_trial *trial);
/* Runs a trial once more, keeps the least of its times, and finds how far it is from the reference. False
 * when the tool was interrupted. */
bool cost_trial_run(struct cost_case *c, struct cost_trial *trial, double allowed);
/* The reference; ends the tool where there is none. */
void cost_solve_reference(struct cost_case *c);

/* ---- schedule.c ---- */

/* Seconds, from what has been measured on this map so far, else from the plan. */
double cost_expect(const struct cost_case *c, const struct cost_trial *trial);
/* Whether a trial that has been run so often, and takes so long, is to be run again. Short ones are
 * repeated, in turns: the least of their times is what the work takes, what is above it is due to
 * other programs. */
bool cost_again(double runs, double seconds);
/* Whether --error may choose it. By the triangle inequality the error is at most the distance from the reference
 * plus the error of the reference. On a coarser grid it is the error of the pressures there, which are means
 * over its cells. A body that yields needs an estimate, which rc-solve found small enough, too. */
bool cost_is_near(const struct cost_case *c, const struct cost_trial *trial);
/* Runs what fits into the limit, the quickest first, and what is short several times. */
void cost_run_trials(struct cost_case *c);

/* ---- show.c, plot.c: what was measured ---- */

enum {
    COST_BODY = 48
};

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
