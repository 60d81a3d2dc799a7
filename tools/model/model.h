/*
 * The face of this folder: how a tool leads a model (libcontact/model.h) through the points of a history: steps
 * with a progress line, signals, and --checkpoint with --resume.
 */
#ifndef RC_TOOL_MODEL_H
#define RC_TOOL_MODEL_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

enum {
    COURSE_MARKS = 16
};

/* What a frame of --checkpoint must agree in with the case that goes on from it; an empty value: neither has
 * it. */
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
    bool resumed;   /* the point goes on from the checkpoint                                 */
    double iterate; /* seconds that the steps took                                          */
    struct {        /* where the error stood when the grid that is iterated was begun       */
        size_t nodes;
        double iterations, error, at;
    } since;
};

/* Sets out for a point: from the state that the checkpoint has of this case, else from the last point kept. */
void course_set(struct course *c, struct rc_model *m, const struct rc_point *to);
/* Steps to its end, or to a signal: RC_MORE. */
enum rc_status course_run(struct course *c, struct rc_model *m);

/* ---- checkpoint.c ---- */

/* The file `name` (NULL: none), new or, to resume, as it is. Does not return when it cannot be used. */
struct checkpoint *checkpoint_open(struct tool *t, const char *name, bool resume, double interval);
void checkpoint_close(struct checkpoint *checkpoint);
/* CRC-32 of a map, of all ranks, for a mark. */
void checkpoint_crc(struct tool *t, const struct rc_grid *g, char text[16]);
/* A case begins, or a point of it: its last state, as rc_model_state wrote it, which the caller frees; NULL:
 * there is none. */
double *checkpoint_load(struct course *c, size_t *n);
/* Keeps a state of n numbers. */
void checkpoint_save(struct course *c, const double *state, size_t n);
/* Whether it is time to keep what is reached; then the next time is twice as far. */
bool checkpoint_due(struct checkpoint *checkpoint);
/* Ends the tool: the state of this case cannot be gone on with. */
_Noreturn void checkpoint_refuse(const struct course *c, const char *why);

#endif
