/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The parts of a model, for the files that implement one. The struct of a model begins with struct
 * rc_model, and its file ends in the row. An outer model drives its inner one by the verbs of model.h only.
 */
#ifndef RC_MODEL_ROW_H
#define RC_MODEL_ROW_H

#include "libcontact/common.h"
#include "libcontact/memory.h"
#include "libcontact/ranks/ranks.h"

/* A state is a sequence of numbers. One function of a row counts, writes and reads them. */
struct rc_state;
void rc_state_numbers(struct rc_state *s, size_t n, double *v);
/* The same for numbers that must be finite, also in single precision; a state with other numbers is
 * refused. */
void rc_state_finite(struct rc_state *s, size_t n, double *v);
/* The same for one number of at least `least`. */
void rc_state_number(struct rc_state *s, double *v, double least);
/* A size, at most `most`, as one number. */
void rc_state_count(struct rc_state *s, size_t *n, size_t most);
/* Members one after the other, each by its address: finite numbers, finite ones of at least 0, counts,
 * booleans; open ones may be NaN or infinite. */
#define RC_STATE_NUMBERS(s, ...) rc_state_each_number(s, (double *const[]){__VA_ARGS__, NULL})
#define RC_STATE_OPEN(s, ...) rc_state_each_open(s, (double *const[]){__VA_ARGS__, NULL})
#define RC_STATE_SIZES(s, ...) rc_state_each_size(s, (double *const[]){__VA_ARGS__, NULL})
#define RC_STATE_COUNTS(s, ...) rc_state_each_count(s, (size_t *const[]){__VA_ARGS__, NULL})
#define RC_STATE_FLAGS(s, ...) rc_state_each_flag(s, (bool *const[]){__VA_ARGS__, NULL})
void rc_state_each_number(struct rc_state *s, double *const *v);
void rc_state_each_open(struct rc_state *s, double *const *v);
void rc_state_each_size(struct rc_state *s, double *const *v);
void rc_state_each_count(struct rc_state *s, size_t *const *n);
void rc_state_each_flag(struct rc_state *s, bool *const *flag);
/* A map: the n nodes of this rank. In a state all maps follow all numbers. Returns the place of the map in a
 * state that is being written, else NULL; v NULL: the caller writes to that place. */
double *rc_state_map(struct rc_state *s, size_t n, double *v);
/* One number of each row of this rank, in a map of its own. */
void rc_state_rows(struct rc_state *s, const struct rc_rows *rows, size_t nx, double *v);
/* Numbers of which each part of the map has its own count, such as voxels. `part` exchanges those of n rows
 * from `first` on, counted from the first row held here: ranks own whole such parts, so that a state can be
 * read on another number of ranks. They are stored in as many maps as the fullest part needs. */
void rc_state_parts(struct rc_state *s, const struct rc_rows *rows, size_t nx,
                    void (*part)(void *of, struct rc_state *s, size_t first, size_t n), void *of);
/* The next map of the state that is being read, as long as that state stays; NULL: it is refused. */
const double *rc_state_read_map(struct rc_state *s, size_t n);
/* True if n numbers are left in the state that is being read; otherwise refuses the state. */
bool rc_state_holds(struct rc_state *s, size_t n);
/* True if the state is being read and was not refused. */
bool rc_state_reads(const struct rc_state *s);
/* True if the state was refused: the members that were to be read are then unknown. */
bool rc_state_refused(const struct rc_state *s);
/* True for a copy in memory at a kept point, which holds only what the history is made of. */
bool rc_state_is_copy(const struct rc_state *s);
/* True if no rank has refused the state; else all ranks refuse it. All call it before a collective call that
 * a rank which has refused the state would leave out. */
bool rc_state_agree(struct rc_state *s, const struct rc_ranks *ranks);
/* Exchanges a further model that the row drives in addition to its inner one. */
void rc_state_model(struct rc_state *s, struct rc_model *m);
/* Refuses a state that is being read. `why` is copied: a part of a sentence. */
void rc_state_refuse(struct rc_state *s, const char *why);

/* A state in memory, made by a function that counts, writes and reads; zeroed: empty. */
struct rc_state_copy {
    double *v;
    size_t n, numbers, maps; /* n: all values; numbers: values before the maps */
};
/* RC_FAIL on all ranks: memory is short, or the state is refused, on one of them. */
enum rc_status rc_state_save(struct rc_state_copy *copy, const struct rc_ranks *ranks,
                             void (*part)(void *of, struct rc_state *s), void *of);
enum rc_status rc_state_load(const struct rc_state_copy *copy, const struct rc_ranks *ranks,
                             void (*part)(void *of, struct rc_state *s), void *of,
                             struct rc_err *err);
/* Exchanges the copy as a part of another state. */
void rc_state_copy(struct rc_state *s, struct rc_state_copy *copy);
void rc_state_forget(struct rc_state_copy *copy);

/* The frames that every model of contact has, first in its table. */
enum {
    RC_FRAME_CONTACT,
    RC_FRAME_PRESSURE,
    RC_FRAME_GAP,
    RC_FRAME_DISPLACEMENT,
    RC_CONTACT_FRAMES /* the place of the first frame of the model itself */
};
/* clang-format off */
#define RC_CONTACT_FRAME_KINDS                                                                     \
    [RC_FRAME_CONTACT] = {"contact", "1", "Contact"},                                              \
    [RC_FRAME_PRESSURE] = {"pressure", "Pa", "Pressure"},                                          \
    [RC_FRAME_GAP] = {"gap", "m", "Gap"},                                                          \
    [RC_FRAME_DISPLACEMENT] = {"displacement", "m", "Displacement"}
/* clang-format on */

/* Tables of figures, and where in the struct of the model their struct is; the last is NULL. */
struct rc_figure_set {
    const struct rc_figure *table;
    size_t at;
};

struct rc_model_row {
    const char *name, *summary;
    /* Axes: each axis of `needs`, or its partner, must have a value; axes that are not in `takes` are
     * refused. */
    unsigned needs, takes;
    /* true: `go` itself returns to the last kept point; false: model.c keeps a copy of the state for that. */
    bool forgets;
    const struct rc_figure_set *figures;
    const struct rc_frame_kind *frame; /* the last has no name */

    /* Starts from m->from towards m->to; both are already checked. */
    enum rc_status (*go)(struct rc_model *m, struct rc_err *err);
    enum rc_status (*step)(struct rc_model *m, struct rc_err *err);
    /* Fills the figures, and the axes of `at` that the model has found. */
    enum rc_status (*look)(struct rc_model *m, struct rc_point *at, struct rc_err *err);
    enum rc_status (*fill)(struct rc_model *m, size_t frame, double *to, struct rc_err *err);
    /* Exchanges the members on which the next step depends. The heights of the undeformed bodies are not
     * among them. An outer model that sets them, or the compliance, sets them here while it reads, before its
     * inner model reads. */
    void (*state)(struct rc_model *m, struct rc_state *s);
    /* The following functions may be NULL. `free` releases what m->own does not hold. keep is called after
     * look. */
    void (*free)(struct rc_model *m);
    enum rc_status (*keep)(struct rc_model *m, struct rc_err *err);
    enum rc_status (*heights)(struct rc_model *m, const double *h, struct rc_err *err);
    enum rc_status (*compliance)(struct rc_model *m, double c, const double *part, double along,
                                 struct rc_err *err);
    /* From the next go on, the tolerance is this part of the one that the maker was given. A model with
     * `compliance` has it. */
    void (*accuracy)(struct rc_model *m, double part);
    /* After `go`: starts the iteration from this pressure, Pa, which carries this load, N; p NULL: as if
     * there had been no earlier point. */
    enum rc_status (*start)(struct rc_model *m, double load, const double *p, struct rc_err *err);
    /* After `look`: z, Pa, is the approximate change of the pressure if the heights grow by e, m, under the
     * same load and contact. */
    enum rc_status (*respond)(struct rc_model *m, const double *e, double *z, struct rc_err *err);
    void (*progress)(const struct rc_model *m, struct rc_loops *loops);
    enum rc_status (*plan)(const struct rc_model *m, const struct rc_point *most,
                           struct rc_expected *expected, struct rc_err *err);
    struct rc_solver *(*solver)(const struct rc_model *m);
};
/* In a row: the figures `sets`, and the functions of the file that have the names of their members. */
#define RC_MODEL_VERBS                                                                             \
    .figures = sets, .go = go, .step = step, .look = look, .fill = fill, .state = state,           \
    .progress = progress

struct rc_model {
    const struct rc_model_row *row;
    struct rc_shape shape; /* the whole map */
    struct rc_rows rows;   /* held here; the innermost model sets them, outer ones have the same */
    struct rc_boundary boundary; /* of the contact; an outer model has that of its inner one */
    struct rc_model *inner;      /* owned; NULL: none                      */
    bool inside;                 /* true: the inner model of another one   */
    struct rc_point from, to;    /* last point kept, with its found axes; next one */
    enum rc_status status;       /* RC_MORE: the point is not reached yet */
    bool moved;                  /* true: steps were made since the last keep */
    bool looked;                 /* the figures belong to the present step */
    struct rc_state_copy kept;   /* state at the last keep                */
    struct rc_store own;         /* memory that is freed with the model   */
};

/* For makers: a zeroed model of `size` bytes; NULL if memory is short. It owns its inner model from now on,
 * also on failure. If the maker of the inner model failed (inner NULL), returns NULL and keeps *err. */
struct rc_model *rc_model_make(const struct rc_model_row *row, size_t size,
                               const struct rc_shape *shape, const struct rc_ranks *ranks,
                               struct rc_err *err);
struct rc_model *rc_model_make_outer(const struct rc_model_row *row, size_t size,
                                     struct rc_model *inner, struct rc_err *err);
/* RC_FAIL if this, the boundary of an outer model's own problem, is not that of its inner model. */
enum rc_status rc_model_same_boundary(const struct rc_model *m, struct rc_boundary boundary,
                                      struct rc_err *err);
/* Nodes of this rank. Tolerances, means and messages use shape.nx * shape.ny, all nodes. */
static inline size_t
rc_model_nodes(const struct rc_model *m)
{
    return m->rows.n * m->shape.nx;
}
/* RC_FAIL, with a sentence, if memory was short for a block of m->own on some rank. */
enum rc_status rc_model_room(const struct rc_model *m, struct rc_err *err);
/* The figures of this table of the first model of the chain that has them; NULL: none has. */
const void *rc_model_result(const struct rc_model *m, const struct rc_figure *table);
/* The model of this row in a chain of models; NULL: there is none. */
const struct rc_model *rc_model_find(const struct rc_model *m, const struct rc_model_row *row);
/* The axes of a point that a model or its inner models take. */
struct rc_point rc_point_for(const struct rc_model *m, const struct rc_point *point);
/* The point at this fraction, 0 to 1, of the path between two points. */
struct rc_point rc_point_between(const struct rc_point *from, const struct rc_point *to,
                                 double part);
bool rc_point_has(const struct rc_point *point, enum rc_axis axis);

/* ---- verbs for outer models, which call the functions of the row ---- */

/* True if rc_model_set_heights works. */
bool rc_model_takes_heights(const struct rc_model *m);
/* After rc_model_go: the iteration starts from the pressure p, Pa, which carries this load, N; p NULL: as if
 * there had been no earlier point. A model that chooses its own start ignores the call; rc_model_takes_start
 * is then false. */
enum rc_status rc_model_start(struct rc_model *m, double load, const double *p, struct rc_err *err);
bool rc_model_takes_start(const struct rc_model *m);
/* From the next go on, the tolerance is this part of the one that the maker was given. For a model that takes
 * a compliance. */
void rc_model_set_accuracy(struct rc_model *m, double part);
/* z, Pa: the change of the pressure when the heights grow by e, m; 0 from a model that cannot tell. */
enum rc_status rc_model_respond(struct rc_model *m, const double *e, double *z, struct rc_err *err);
void rc_loops_add(struct rc_loops *s, const char *what, const char *unit, double at, double of);

/* Copies the state at the last kept point, and restores it, which forgets all later steps (state.c). */
enum rc_status rc_model_remember(struct rc_model *m, struct rc_err *err);
enum rc_status rc_model_recall(struct rc_model *m, struct rc_err *err);

#define RC_FIGURES(name) extern const struct rc_figure rc_figures_##name[];
#include "figures.list"
#undef RC_FIGURES

/* -DRC_MODELS_LIST=... replaces the list (tests/toys does). */
#ifndef RC_MODELS_LIST
#define RC_MODELS_LIST "libcontact/model/models.list"
#endif
#define RC_MODEL(name) extern const struct rc_model_row rc_model_##name;
#include RC_MODELS_LIST
#undef RC_MODEL

#endif
