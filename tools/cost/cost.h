/*
 * What the rooms of rc-cost share. A rung is one way to solve the contact; a case is the ladder of
 * them, beside one reference solution. Each rung runs in a process of its own (run.c), as a
 * command would: what it takes in time and memory is not helped by the rungs before.
 */
#ifndef RC_COST_H
#define RC_COST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "libcontact/contact.h"
#include "coarse.h"
#include "tools/cli/cli.h"

/* ---- cost_ladder.c: which rungs there are ---- */

struct cost_rung {
    const char *method, *kernel;
    const char *arithmetic; /* of the displacements                                            */
    unsigned coarse;        /* nodes of the map a side under one of the grid that is solved    */
    double tol;
};

enum cost_state {
    COST_OPEN,
    COST_DONE,
    COST_LEFT_OUT, /* not begun: `why` */
    COST_STOPPED,  /* begun, no result: `why` */
};

/* A rung, and what came of it. */
struct cost {
    struct cost_rung rung;
    enum cost_state state;
    char why[256];
    double expected;       /* s, before it ran                                                    */
    struct rc_shape shape; /* of the grid that is solved                                       */
    double seconds;        /* heights to pressure, plans and coarse levels included: least of ... */
    size_t runs;           /* ... so many                                                         */
    double convolutions;   /* in equivalents of one on the map's own grid                        */
    size_t memory;         /* bytes beyond the map and the result                                 */
    struct rc_contact contact;
    double error; /* relative L1, of the pressure on the map's own grid                  */
    double area_error, peak_error, approach_error; /* relative, signed; NAN: unknown           */
    bool front;    /* no other is both quicker and nearer                                 */
    bool flatters; /* its estimate is below its error, by more than 1 %                   */
};

/* The rungs; the caller frees them. `kernels` and `methods`: bits of
 * cost_kernels and cost_methods that are wanted. */
#define COST_KERNELS "fft|fft64|mlms|direct"
#define COST_METHODS "pcg|pk99"
struct cost *cost_ladder(size_t kernels, size_t methods, size_t *n);
/* The best that there is: in double precision throughout, to 1e-12. */
extern const struct cost_rung cost_reference;

/* ---- cost_stress.c: the same for stresses ---- */

struct cost_stress {
    const char *kernel;
    double tol; /* of a component over the largest pressure; 0: rounding                 */
    bool reference;
    enum cost_state state;
    char why[256];
    double expected, seconds;
    size_t runs, memory, coarse; /* coarse: depths that came from a coarser grid               */
    double error; /* largest of any component, over the largest pressure                   */
    double rms;   /* the same, root of the mean square                                     */
    double mises; /* of the largest Mises' stress, relative, signed                        */
    bool front;
};

/* ---- a case ---- */

struct cost_case {
    struct tool *tool;
    const struct rc_grid *heights;
    struct rc_shape shape;
    struct rc_problem problem; /* engine, method, tol: a rung's                                */
    double limit, began;       /* s: for all rungs; when the first one started                 */
    double budget, error;      /* s, -: what a command is chosen for; NAN: the other, or none  */
    bool choosing, shown;      /* for one of them; all rungs are shown nevertheless            */
    struct cost reference;
    double *pressure; /* of the reference                                             */
    struct cost *rung;
    size_t rungs;
    struct numbers depths; /* none: no stresses                                            */
    double nu, mu;
    struct cost_stress *stress;
    size_t stresses;
};

double cost_now(void);
/* "pcg, fft, tol 1e-04, 512 x 512" */
const char *cost_name(char text[128], const struct cost *cost);

/* ---- cost_expect.c: what a rung will take ---- */

/* Seconds, from what has been measured on this map so far, else from what is known of machines. */
double cost_expect(const struct cost_case *c, const struct cost *rung);
double cost_expect_stress(const struct cost_case *c, const struct cost_stress *rung);
/* Short runs are repeated, in turns: the least of their times is what the work takes, the rest
 * is the work of others on this machine. */
static inline bool
cost_again(size_t runs, double seconds)
{
    return runs < 5 && (double)runs * seconds < 0.5;
}

/* ---- run.c: processes ---- */

/* Memory, zeroed, that a process begun later shares. NULL: memory is short. */
void *cost_share(size_t bytes);
void cost_unshare(void *shared, size_t bytes);

enum cost_end {
    COST_ENDED,
    COST_LATE,        /* not done in the time allowed    */
    COST_INTERRUPTED, /* the tool has had a signal       */
    COST_DIED,        /* by a signal, or without a word  */
};
/* work(ctx) in a process of its own; what it writes to shared memory is seen. `watch` is called
 * now and then. No thread may have been started in this process before. */
enum cost_end cost_run(void (*work)(void *ctx), void *ctx, double allowed,
                       void (*watch)(void *ctx));
/* Bytes that this process holds at most so far. */
size_t cost_peak(void);

/* ---- cost_solve.c ---- */

/* Runs a rung once more, keeps the least of its times, and tells how far its solution is from
 * the reference, where there is one; `pressure`, on the map's own grid, may be NULL. False when
 * the tool was interrupted. */
bool cost_solve(struct cost_case *c, struct cost *cost, double allowed, double *pressure);

/* ---- cost_stress.c ---- */

struct cost_stress *cost_stress_ladder(const struct cost_case *c, size_t *n);
/* The depths that rc-stress --depths auto would take under the reference. */
void cost_stress_depths(struct cost_case *c);
bool cost_stress_run(struct cost_case *c, struct cost_stress *s, double allowed);

/* ---- cost_climb.c ---- */

/* Leaves out what cannot be done on this map, or need not. */
void cost_sift(struct cost_case *c);
/* Runs what fits into the limit, the quickest first, and what is short several times. */
void cost_climb(struct cost_case *c);

/* ---- cost_choose.c ---- */

/* Prints the command; ends the tool where there is none. */
void cost_choose(const struct cost_case *c, FILE *out);

/* ---- cost_table.c ---- */

/* Marks the front, and what flatters. */
void cost_judge(struct cost_case *c);
void cost_table(const struct cost_case *c, FILE *out);
void cost_report(const struct cost_case *c, FILE *out);

/* ---- cost_plot.c ---- */

/* Error against time as a PNG in memory, which the caller frees. */
unsigned char *cost_plot(const struct cost_case *c, size_t *bytes, struct rc_err *err);

#endif
