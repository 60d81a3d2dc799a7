/*
 * The interface of this folder: a tool drives a model (libcontact/model.h) through the points of a history,
 * with a progress line, signals, and --checkpoint with --resume.
 */
#ifndef RC_TOOL_MODEL_H
#define RC_TOOL_MODEL_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

enum {
    COURSE_MARKS = 16
};

/* A key that a frame of --checkpoint and the resumed case must share; empty: neither has the key. */
struct mark {
    const char *name;
    char value[2 * RC_NUMBER_SIZE];
};

struct course {
    struct tool *t;
    struct checkpoint *checkpoint; /* NULL: none; nothing is kept and nothing resumed       */
    const struct rc_grid *g;       /* heights of the case                                   */
    size_t number;                 /* of the case                                           */
    struct mark mark[COURSE_MARKS];
    size_t marks;
    bool resumed;   /* the point continues from the checkpoint                               */
    double iterate; /* seconds that the steps took                                          */
    struct {        /* the error at the start of the present grid                           */
        size_t nodes;
        double iterations, error, at;
    } since;
};

/* Starts towards a point, from the state of this case in the checkpoint or from the last kept point. */
void course_set(struct course *c, struct rc_model *m, const struct rc_point *to);
/* Steps until the point is reached; RC_MORE: a signal came first. */
enum rc_status course_run(struct course *c, struct rc_model *m);

/* ---- checkpoint.c ---- */

/* Opens the file `name` (NULL: none); resume: the file may exist. Does not return if the file cannot be
 * used. */
struct checkpoint *checkpoint_open(struct tool *t, const char *name, bool resume, double interval);
void checkpoint_close(struct checkpoint *checkpoint);
/* CRC-32 of a map, of all ranks, for a mark. */
void checkpoint_crc(struct tool *t, const struct rc_grid *g, char text[16]);
/* Begins a case, or a point of a case. Returns its last state, as rc_model_state wrote it, which the caller
 * frees; NULL: none. */
double *checkpoint_load(struct course *c, size_t *n);
/* Appends a state of n numbers. */
void checkpoint_save(struct course *c, const double *state, size_t n);
/* Whether a state is due; the next one is due after twice the time. */
bool checkpoint_due(struct checkpoint *checkpoint);
/* Ends the tool, because the state of this case cannot be used. */
_Noreturn void checkpoint_refuse(const struct course *c, const char *why);

#endif
