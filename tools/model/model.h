/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: a tool drives a model (libcontact/model.h) through the points of a history.
 * The tool itself has its options, the maker of its model and, if needed, keys of frames, columns of the
 * report and advice in warnings:
 *
 *     static struct args {
 *         struct numbers load, time;
 *         size_t output;
 *         struct drive_args drive;
 *     } args = {.output = 3, .drive.interval = 60};
 *     static const struct opt opts[] = {
 *         ..., {.group = drive_options, .at = offsetof(struct args, drive)}, {.name = NULL}};
 *
 *     static struct drive d = {.args = &args.drive, .list = frames, .output = &args.output};
 *     const struct drive_axis axes[] = {{RC_LOAD, &args.load}, {RC_TIME, &args.time}, {0, NULL}};
 *     tool_start(&d.t, &info, argc, argv, &args);
 *     drive_open(&d, axes);                         (the lists become the points of the history)
 *     while ((g = drive_next(&d)) != NULL) {        (a height map)
 *         drive_case(&d, g, toy_new(...), &err);    (points, frames, report, warnings; frees the model)
 *         rc_grid_free(g);
 *     }
 *     return drive_close(&d);
 *
 * drive_case starts each point from the last one, with a progress line, signals and --checkpoint. It writes
 * the frames of --output, and a row of --report with the figures of the model and its inner ones. It warns of
 * figures beyond their limits and of errors above the tolerance. With --dry-run it prints what it would do.
 * tests/toys/rc-toy.c is such a tool. A tool with more to say calls course_set, course_run and course_warn
 * itself.
 */
#ifndef RC_TOOL_MODEL_H
#define RC_TOOL_MODEL_H

#include <stdint.h>

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

enum {
    COURSE_MARKS = TOOL_OPTIONS + RC_AXES + 32,
    COURSE_WARNINGS = 16
};

/* A value in which a state of --checkpoint and the resumed case must agree; empty: neither has it. */
struct mark {
    enum mark_kind {
        MARK_OPTION, /* of the command line */
        MARK_BOUND,  /* the same, a number that may rise */
        MARK_FILE,   /* CRC-32 of what an option has read from a file */
        MARK_FRAME,  /* CRC-32 of a map     */
        MARK_KEY,    /* of the input        */
        MARK_POINT,  /* an axis of the point */
        MARK_EARLIER /* CRC-32 of the points before it */
    } kind;
    const char *name;
    char value[2 * RC_NUMBER_SIZE];
};

/* A warning that several cases share. */
struct again {
    const char *words; /* NULL: none so far                              */
    size_t first;      /* the case that was warned of in full            */
    size_t from, to;   /* the last run of other cases, from 0: none      */
    char cases[256];   /* the runs before it                             */
    bool several;
};

struct course {
    struct tool *t;
    struct checkpoint *checkpoint; /* NULL: no checkpoint */
    const struct rc_grid *g;       /* heights of the case                                   */
    size_t number;                 /* number of the case */
    struct mark mark[COURSE_MARKS];
    size_t marks;
    bool resumed;   /* the point continues from the checkpoint                               */
    double iterate; /* seconds that the steps took                                          */
    void (*stepped)(struct course *c, struct rc_model *m); /* after each step; NULL: nothing */
    struct { /* the error at the start of the present grid                           */
        size_t nodes;
        double iterations, error, at;
    } since;
    struct again again[COURSE_WARNINGS];
};

/* Sets a mark. A text that is too long is replaced by its CRC-32. */
void course_mark(struct course *c, enum mark_kind kind, const char *name, const char *value);
void course_mark_crc(struct course *c, enum mark_kind kind, const char *name, uint32_t crc);
/* A key of a map, which the mark calls `name`. */
void course_mark_key(struct course *c, const struct rc_grid *map, const char *key,
                     const char *name);
/* CRC-32 of a map (NULL: none), of all ranks. */
void course_mark_map(struct course *c, const char *name, const struct rc_grid *map);
/* Starts towards a point, from the state of this case in the checkpoint or from the last kept point. */
void course_set(struct course *c, struct rc_model *m, const struct rc_point *to);
/* Steps until the point is reached; RC_MORE: a signal came first. */
enum rc_status course_run(struct course *c, struct rc_model *m);
/* The peak of a run whose models take so many more bytes, for --dry-run. */
size_t course_peak(size_t bytes);
/* Seconds of a run on this machine, for --dry-run: its expected seconds in the units of rc_solver_expect,
 * times the measured over the expected seconds of a small contact; with files, figures and frames of the
 * points. */
double course_seconds(const struct rc_grid *g, double seconds, size_t points);
/* Ends the plan of a map that takes so much for so many points. */
void course_plan(const struct plan *plan, const struct rc_grid *g, struct rc_expected expected,
                 size_t points);

/* ---- again.c ---- */

/* Warns in full of the first case. Other cases with a warning of the same `words` are listed at the end. */
void course_warn(struct course *c, const char *words, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void course_warn_at_end(struct course *c);

/* ---- drive.c ---- */

/* Options of every tool that drives a model. */
struct drive_args {
    const char *report, *checkpoint; /* files, or NULL                          */
    double interval;                 /* s, to the first state on the way         */
    bool resume, dry_run;
};
extern const struct opt drive_options[];

/* An axis and the list that an option gives for it; the last list is NULL. */
struct drive_axis {
    enum rc_axis axis;
    const struct numbers *list; /* n = 0: the option was not given */
};
/* An axis that the tool shows as another quantity, such as a number of cycles. */
struct drive_shown {
    enum rc_axis axis;
    const char *name, *unit; /* name NULL: no axis is shown so; unit NULL: a plain number */
    double one;              /* value of the axis where the quantity is 1 */
};
/* What to do about a figure beyond its limit, naming options; advice NULL: the limit does not hold. The last
 * has no name. */
struct drive_advice {
    const char *figure, *advice;
};

struct drive;
struct rc_model;

/* Functions of the tool; each may be NULL. */
struct drive_calls {
    void (*mark)(struct drive *d); /* sets further marks of a case */
    void (*keys)(struct drive *d, struct rc_model *m, struct rc_grid *frame);
    void (*columns)(struct drive *d, const struct rc_model *m); /* before those of the model */
    /* The effects of the case: computed, or why not; and, for --dry-run, lines about its points. */
    const struct effect_state *(*effects)(struct drive *d);
    void (*plan)(struct drive *d, const struct plan *plan);
    /* For a tool with more output than usual. It adds text before a point (plan), warnings, and all
     * keys of the frames. It sets the values of a frame (NULL: those of the model) and the columns of the
     * report. It also says how a point becomes history. */
    void (*begin)(struct drive *d, struct rc_model *m);
    void (*judge)(struct drive *d, struct rc_model *m);
    void (*all_keys)(struct drive *d, const struct rc_model *m, struct rc_grid *frame);
    const double *(*frame)(struct drive *d, struct rc_model *m, struct rc_grid *frame,
                           const char *word);
    void (*keep)(struct drive *d, struct rc_model *m);
    void (*row)(struct drive *d, const struct rc_model *m);
};

struct drive_is {
    bool ended;  /* set by `keys` or `judge`: later points of the case are left out */
    bool lasts;  /* set by the tool, which frees the model: it serves further cases */
    bool silent; /* set by `judge`: the point has no frames and no row */
    bool spare;  /* set by the tool: the values of the heights are free for those of frames */
    double began, setup,
        looked;         /* s: start of the point; until its first step; its figures are known */
    struct rc_point at; /* the point, with the distance where it ended */
};

struct drive {
    struct tool t;
    const struct drive_args *args;
    const size_t *output;    /* bits of --output                               */
    const char *const *list; /* its words: names of frames of the model, or "height" */
    struct drive_calls calls;
    const struct drive_advice *advice;
    const char *const *tells; /* names of figures that --verbose prints; the last is NULL */
    /* What the model depends on beside the options and the main map of the case: other maps, and keys of the
     * main map. `changeable`: options that may differ when a run is resumed, although they change the result.
     * The lists end with NULL. */
    const struct tool_frame *beside;
    const char *const *reads, *const *changeable;
    struct drive_shown shown;
    const char *bound;    /* option of a number that may rise; NULL: none */
    bool independent;     /* no point depends on those before it */
    const char *boundary; /* of the case; NULL: as the map says */
    const char *unit;     /* unit of frames that are not of the model; NULL: that of the heights */
    /* set by drive_open and drive_case */
    struct report report;
    struct course course;
    struct checkpoint *checkpoint;
    const struct drive_axis *axes;
    struct rc_point *point;
    size_t points, at; /* at: the point that is reached */
    struct drive_is is;
    enum rc_status status;
};

/* Ends the tool where options contradict each other; the lists must have the same length, or one number. axes
 * NULL: the tool makes the points. */
void drive_open(struct drive *d, const struct drive_axis *axes);
/* The points of lists, for a tool that makes them in each case; the caller frees d->point. */
void drive_make_points(struct drive *d, const struct drive_axis *axes);
/* The next height map; NULL: none, or a signal came. */
struct rc_grid *drive_next(struct drive *d);
/* Leads the model, which it frees, through the points. m NULL: ends the tool with the error. */
void drive_case(struct drive *d, const struct rc_grid *g, struct rc_model *m,
                const struct rc_err *err);
/* The same without the plan, which the tool has handled. */
void drive_points(struct drive *d, const struct rc_grid *g, struct rc_model *m);
/* The point becomes history, unless a signal came first. */
void drive_keep(struct drive *d, struct rc_model *m);
/* The exit status of main. */
int drive_close(struct drive *d);
/* Warns of what the model found, in the way of all tools: what d->judge NULL does. */
void drive_judge_point(struct drive *d, struct rc_model *m);
/* Prints the figures that the tool names, with --verbose. */
void drive_tell(struct drive *drive, const struct rc_model *model);
/* Warns of figures of the model that are beyond their limits. */
void drive_judge(struct course *c, const struct rc_model *m, const struct drive_advice *advice,
                 const char *where);
/* Warns of an RMS slope in contact that is not small. */
void drive_judge_slope(struct course *c, double slope, const char *where);
/* The quantity by which an axis is shown; *value, of the axis, becomes a value of it. */
struct drive_shown drive_show_axis(const struct drive *d, enum rc_axis axis, double *value);
/* "surface.rcg, case 2, load 3 N, time 0.1 s": the point of a warning. */
void drive_where(const struct drive *d, const struct rc_grid *g, char *text, size_t size);

/* ---- checkpoint.c ---- */

/* Opens the file `name` (NULL: none); resume: the file may exist. Does not return if the file cannot be
 * used. */
struct checkpoint *checkpoint_open(struct tool *t, const char *name, bool resume, double interval);
void checkpoint_close(struct checkpoint *checkpoint);
/* Begins a case, or a point of a case. Returns its last state, as rc_model_state wrote it, which the caller
 * frees; NULL: none. */
double *checkpoint_load(struct course *c, size_t *n);
/* Appends a state of n numbers. */
void checkpoint_save(struct course *c, const double *state, size_t n);
/* True if a state is due; the next one is due after twice the time. */
bool checkpoint_due(struct checkpoint *checkpoint);
/* Ends the tool, because the state of this case cannot be used. */
_Noreturn void checkpoint_refuse(const struct course *c, const char *why);

#endif
