/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A model: two bodies, the law of their deformation, and their history. Each kind of model has its own maker
 * (rc_elastic_new); the verbs of this file drive all of them:
 *
 *     struct rc_model *m = rc_elastic_new(&shape, h, &problem, NULL, &err);
 *     struct rc_point to = {0}, at;
 *     rc_point_set(&to, RC_LOAD, 10);
 *     if (rc_model_go(m, &to, &err) == RC_MORE)
 *         while (rc_model_step(m, &err) == RC_MORE)
 *             continue; // show progress, obey signals, write a checkpoint
 *     if (rc_model_look(m, &at, &err) != RC_OK)
 *         fprintf(stderr, "%s\n", err.text); // the figures are then NAN
 *     printf("%g m, %g Pa\n", at.at[RC_APPROACH],
 *            rc_model_number(m, "max_pressure"));
 *     rc_model_keep(m, &err); // without it the next go forgets the point
 *
 * rc_model_run is the go with all steps, where the caller has nothing to do between them. A maker checks the
 * problem; the first go allocates the large arrays. Everything is SI. This header comes with contact.h.
 */
#ifndef RC_MODEL_H
#define RC_MODEL_H

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>

#include "grid.h"

#ifdef __cplusplus
extern "C" {
#endif

struct rc_model;
struct rc_solver;

/* ---- axes: quantities that a history prescribes ---- */

enum rc_axis {
    RC_LOAD,         /* N, positive when the bodies are pressed together */
    RC_APPROACH,     /* m, from first touch; -INFINITY separates bodies that attract each other */
    RC_TANGENTIAL_X, /* N, of body 2 on body 1 */
    RC_TANGENTIAL_Y,
    RC_DISPLACEMENT_X, /* m, of body 2 over body 1 */
    RC_DISPLACEMENT_Y,
    RC_CREEP_X, /* creepages */
    RC_CREEP_Y,
    RC_SPIN,     /* rad/m */
    RC_TIME,     /* s */
    RC_DISTANCE, /* m, slid */
    RC_POSITION, /* m, of the contact on body 1 */
    RC_SPEED,    /* m/s */
    RC_AXES
};
/* Names of options, columns and keys are made from this table. */
struct rc_axis_info {
    /* unit NULL: a plain number */
    const char *name, *unit, *title;
    /* a later point has at least the value of the earlier one */
    bool rises;
    /* load and approach are partners: one is given and the other is found; an axis without a
     * partner is its own partner */
    enum rc_axis partner;
};
/* Row k of the table; NULL past the last. */
RC_API const struct rc_axis_info *rc_axis_info(size_t k);

/* A point of a history. An axis that is not given keeps its last value, unless its partner is given. From the
 * last point kept, all axes change in proportion; the model chooses how many increments that takes. */
struct rc_point {
    unsigned given; /* bit of each axis */
    double at[RC_AXES];
};
/* Gives an axis a value; its partner is then found. */
RC_API void rc_point_set(struct rc_point *point, enum rc_axis axis, double value);

/* ---- figures: each number of a result, declared once ---- */

enum rc_figure_kind {
    RC_NUMBER, /* double; NAN: unknown */
    RC_COUNT,  /* size_t */
    RC_YESNO,  /* bool */
    RC_WORD    /* const char *; NULL: unknown */
};
enum rc_figure_role {
    RC_FIGURE_RESULT,
    RC_FIGURE_ERROR, /* an estimated relative error, or a part of one, of `of`; `by` lowers it */
    RC_FIGURE_CHECK, /* tells how far the results can be trusted: nodes of a patch, a slope   */
    RC_FIGURE_COST   /* work: iterations, convolutions, nodes                                 */
};
/* A row of a table of figures; the last row of a table has no name. RC_FIGURE gives the first three. */
struct rc_figure {
    enum rc_figure_kind kind;
    /* offset of the member in its struct */
    size_t at;
    /* name of the column. "object.name" is inside an object */
    const char *name;
    /* SI unit, NULL: a plain number; title of an axis */
    const char *unit, *title;
    /* explanation, a part of a sentence; NULL: the title is enough */
    const char *says;
    enum rc_figure_role role;
    /* of an error: the member of the problem that lowers it, or "grid" for the spacing */
    const char *by;
    /* of an error: the figure or frame that it belongs to; of a quotient: the figure that it is divided by */
    const char *of;
    /* a warning is printed above it, or below it if `least` is set; 0: no limit */
    double limit;
    bool least;
    /* text of this warning, without the name of an option */
    const char *warning;
};
/* {RC_FIGURE(struct rc_leak_figures, mean_gap), "m", "Mean gap"}: the kind follows from the type of the
 * member. A member that does not exist does not compile. RC_FIGURE_AS: the column has another name. */
#define RC_KIND_OF(type, member)                                                                   \
    _Generic(((type *)0)->member, double : RC_NUMBER, size_t : RC_COUNT, bool : RC_YESNO,          \
             const char * : RC_WORD, char * : RC_WORD)
#define RC_FIGURE_AS(column, type, member)                                                         \
    .kind = RC_KIND_OF(type, member), .at = offsetof(type, member), .name = column
#define RC_FIGURE(type, member) RC_FIGURE_AS(#member, type, member)

/* The value in the struct that `data` points to; counts and yes/no as numbers. NAN: unknown, a word, or data
 * NULL. */
RC_API double rc_figure_number(const struct rc_figure *figure, const void *data);
/* The word; NULL: unknown, a number, or data NULL. */
RC_API const char *rc_figure_word(const struct rc_figure *figure, const void *data);
/* The table of the figures of a struct of this library. NULL: no table has this name. The names are:
 *
 *     contact elastic yield adhesion friction rolling wear travel
 *     viscoelastic sliding leak heat stress fatigue
 *     statistics areal features profile psd patches
 */
RC_API const struct rc_figure *rc_figures(const char *name);
/* The row of that name in any table of this library, for titles and units of a table read from a file; NULL:
 * none. */
RC_API const struct rc_figure *rc_figure_find(const char *name);

/* Figure k of the model, those of inner models first; NULL past the last. `data`: its struct; NULL, so that
 * the figure is unknown, unless a look came after the last step. A name that an outer model has too is the
 * outer one's, and is given once. */
RC_API const struct rc_figure *rc_model_figure(const struct rc_model *model, size_t k,
                                               const void **data);
/* The value of a figure by its name, which is that of a column of the reports of the tools. NAN: it is
 * unknown, a word, or the model has no figure of this name: rc_model_figure lists them. */
RC_API double rc_model_number(const struct rc_model *model, const char *name);

/* ---- frames: the maps of a result ---- */

/* The frames contact (1 or 0), pressure (Pa), gap and displacement (m) are those of the contact. Models add
 * their own, as their makers say. */
struct rc_frame_kind {
    const char *name, *unit, *title;
};
/* Row k, those of the outermost model first; NULL past the last. */
RC_API const struct rc_frame_kind *rc_model_frame_kind(const struct rc_model *model, size_t k);
/* nx ny values of the frame of that name, after a look. RC_FAIL when there is none: the sentence lists the
 * frames. */
RC_API enum rc_status rc_model_frame(struct rc_model *model, const char *name, double *to,
                                     struct rc_err *err);

/* ---- verbs ---- */

/* Sets out for a point from the last point kept: RC_MORE, or RC_FAIL when the point is impossible or memory
 * is short. This forgets all steps since the last keep. The first point must have all axes of the model. */
RC_API enum rc_status rc_model_go(struct rc_model *model, const struct rc_point *to,
                                  struct rc_err *err);
/* RC_MORE until the point is reached; then RC_OK, or RC_SHORT when the accuracy is not. One may stop after
 * any step: a look then shows the best so far. */
RC_API enum rc_status rc_model_step(struct rc_model *model, struct rc_err *err);
/* go and all steps. */
RC_API enum rc_status rc_model_run(struct rc_model *model, const struct rc_point *to,
                                   struct rc_err *err);
/* Brings the figures up to date. `at` (or NULL): the point with the axes that were found, NAN where
 * unknown. RC_FAIL after a go or a step that failed, with NAN in `at`. */
RC_API enum rc_status rc_model_look(struct rc_model *model, struct rc_point *at,
                                    struct rc_err *err);
/* The point that was reached becomes history. RC_FAIL when none is reached, or memory is short. */
RC_API enum rc_status rc_model_keep(struct rc_model *model, struct rc_err *err);
/* Sets other heights of the undeformed bodies, nx ny m, from the next go on: worn, moved or warped
 * surfaces. */
RC_API enum rc_status rc_model_set_heights(struct rc_model *model, const double *h,
                                           struct rc_err *err);
/* Sets a compliance c >= 0, m/Pa, of each single node, from the next go on. Under a pressure p the surface
 * moves by c p more, as if a film were worn off or crushed. The answer is that of bodies with the heights
 * h - c p. Its gap is K p + c p - h - shift, and its displacement K p, of the elastic bodies alone. The
 * approach is counted from the highest node of h. part: nx ny numbers >= 0 that multiply c at each node
 * (NULL: all 1). Keep them until others are set. Each row, along x, also moves by `along`, 1/Pa, times the
 * integral of its pressure, as a track does that a body passes and wears. RC_FAIL where the model cannot. */
RC_API enum rc_status rc_model_set_compliance(struct rc_model *model, double c, const double *part,
                                              double along, struct rc_err *err);
/* The grid of its frames. */
RC_API struct rc_shape rc_model_shape(const struct rc_model *model);
/* The solver of the contact of this model or of its inner one, for its pressure, names and progress; only the
 * model steps it. NULL: there is none, or no load so far. */
RC_API struct rc_solver *rc_model_solver(const struct rc_model *model);
/* The name of its kind: "elastic", "wear", ... */
RC_API const char *rc_model_name(const struct rc_model *model);
/* Frees the model and its inner models. */
RC_API void rc_model_free(struct rc_model *model);

/* ---- cost before, progress during ---- */

struct rc_expected;
/* Expected cost of this point; give the largest point of a history. If an outer model does not know its own
 * cost, it returns the cost of its inner model. RC_FAIL when the point is impossible. */
RC_API enum rc_status rc_model_plan(const struct rc_model *model, const struct rc_point *most,
                                    struct rc_expected *expected, struct rc_err *err);

enum {
    RC_LOOPS = 8
};
struct rc_loop {
    const char *what, *unit; /* unit NULL: a count */
    double at, of;           /* position, and the total; total NAN: unknown */
};
/* The order is from the outermost loop to the innermost: time 0.3 of 1 s, increment 3 of 16, iteration 5. */
struct rc_loops {
    size_t n;
    struct rc_loop loop[RC_LOOPS];
    struct rc_shape grid; /* the present grid, at first a coarser one */
    double error, tol;    /* error of the innermost model; NAN before the first estimate */
    bool worth;           /* a state is worth keeping now: steps soon add much to it */
    size_t coming;        /* bytes that the next step allocates; 0: none, or few */
};
/* The loops of the model and its inner models, and the error of the innermost one. */
RC_API void rc_model_progress(const struct rc_model *model, struct rc_loops *loops);

/* ---- states: numbers that a file may keep ---- */

/* Call these after any step. Fewest right after a keep; no heights of the undeformed bodies. The first two
 * tell how many numbers and maps there are; the maps come behind the numbers, each with the nodes of this
 * rank. The numbers of all ranks are the same. */
RC_API size_t rc_model_state_size(struct rc_model *model);
RC_API void rc_model_state(struct rc_model *model, double *state);
/* Continues from this state in a model that was made in the same way. *going: a point is set and not reached
 * yet, so that steps follow, and no go. RC_FAIL when the numbers are not a state of such a model, which then
 * can only be freed. */
RC_API enum rc_status rc_model_restore(struct rc_model *model, const double *state, size_t n,
                                       bool *going, struct rc_err *err);

#ifdef __cplusplus
}
#endif

#endif
