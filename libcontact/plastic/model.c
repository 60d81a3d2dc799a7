/*
 * The model of a body that may yield in its volume: rc_press along a history of loads.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "plastic.h"

#include "libcontact/memory.h"
#include "libcontact/model/row.h"

struct yielding {
    struct rc_model base;
    struct rc_plastic_problem problem;
    size_t n;
    double *h;             /* m: undeformed heights                          */
    double first_top, top; /* m: their highest; that of those that plastic strain leaves */
    struct rc_press *press;
    bool looked;
    struct rc_yielding_figures figures;
};

const struct rc_figure rc_figures_yielding[] = {
#define FIGURE(member) RC_FIGURE(struct rc_yielding_figures, member)
#define AS(column, member) RC_FIGURE_AS(column, struct rc_yielding_figures, member)
    {AS("increments", plastic.increments), NULL, "Increments", .role = RC_FIGURE_COST},
    {AS("applications", plastic.applications), NULL, "Applications", .role = RC_FIGURE_COST},
    {FIGURE(slabs), NULL, "Slabs", .says = "layers that may yield"},
    {AS("plastic_depth", plastic.depth), "m", "Plastic depth"},
    {AS("plastic_volume", plastic.volume), "m3", "Plastic volume"},
    {AS("max_plastic_strain", plastic.max_strain), NULL, "Largest plastic strain", .limit = 0.1,
     .warning = "the plastic strain is beyond the theory of small strains"},
    {AS("plastic_work", plastic.work), "J", "Plastic work", .says = "of all loads so far"},
    {AS("max_pressure_mean4", plastic.max_pressure_mean4), "Pa",
     "Largest pressure over 2 x 2 nodes"},
    {FIGURE(max_mises_over_yield), NULL, "Mises stress over the yield stress",
     .says = "largest, where nothing has yielded"},
    {FIGURE(max_mises_depth), "m", "Depth of the largest Mises stress"},
    {FIGURE(indentation), "m", "Indentation",
     .says = "approach from the first touch of the first shape"},
    {FIGURE(residual_indentation), "m", "Residual indentation",
     .says = "first touch of the shape that is left, from that of the first shape"},
    {AS("increment_error_estimate", plastic.increment_error), NULL, "Error of the increments",
     .role = RC_FIGURE_ERROR, .by = "increments"},
    {AS("inherited_error_estimate", plastic.inherited_error), NULL, "Error of earlier loads",
     .role = RC_FIGURE_ERROR, .by = "increments"},
    {AS("iteration_error_estimate", plastic.iteration_error), NULL, "Error of the iteration",
     .role = RC_FIGURE_ERROR, .by = "tol"},
    {AS("contact_error_estimate", plastic.contact_error), NULL, "Error of the contacts",
     .role = RC_FIGURE_ERROR, .by = "tol"},
    {AS("image_error_estimate", plastic.image_error), NULL, "Error of the edge of the map",
     .role = RC_FIGURE_ERROR, .by = "boundary"},
    {0},
};
static const struct rc_figure_set sets[] = {
    {rc_figures_contact, offsetof(struct yielding, figures.contact)},
    {rc_figures_yielding, offsetof(struct yielding, figures)},
    {NULL, 0},
};

enum {
    RESIDUAL = RC_CONTACT_FRAMES,
    SHAPE
};
static const struct rc_frame_kind frames[] = {
    RC_CONTACT_FRAME_KINDS,
    [RESIDUAL] = {"residual", "m", "Residual displacement"},
    [SHAPE] = {"plastic", "m", "Height after yield"},
    {NULL, NULL, NULL},
};

/* ---- verbs ---- */

static enum rc_status
go(struct rc_model *m, struct rc_err *err)
{
    struct yielding *y = (struct yielding *)m;

    y->looked = false;
    return rc_press_set_load(y->press, m->to.at[RC_LOAD], err);
}

static enum rc_status
step(struct rc_model *m, struct rc_err *err)
{
    return rc_press_step(((struct yielding *)m)->press, err);
}

/* What plastic strain does to the surface. */
static void
displace(const struct yielding *y, double factor, double *v)
{
    struct rc_plastic *plastic = rc_press_plastic(y->press);
    const double *u = plastic != NULL ? rc_plastic_residual(plastic) : NULL;

    for (size_t k = 0; k < y->n && u != NULL; k++)
        v[k] += factor * u[k];
}

/* The shape that plastic strain leaves. */
static void
shape(const struct yielding *y, double *to)
{
    memcpy(to, y->h, y->n * sizeof *to);
    displace(y, -1, to);
}

/* Figures of bodies that are apart, and the gap (NULL: not wanted). */
static enum rc_status
look_apart(const struct yielding *y, double *gap, struct rc_contact *c, struct rc_err *err)
{
    double *left = rc_alloc(y->n, sizeof *left);

    if (left == NULL)
        return rc_err_set(err, "out of memory for the shape that is left");
    shape(y, left);
    rc_contact_apart(NULL, &y->base.shape, left, gap, c);
    free(left);
    return RC_OK;
}

static double
highest(const struct yielding *y)
{
    struct rc_plastic *plastic = rc_press_plastic(y->press);
    const double *u = plastic != NULL ? rc_plastic_residual(plastic) : NULL;
    double top = -INFINITY;

    for (size_t k = 0; k < y->n; k++)
        top = fmax(top, u != NULL ? y->h[k] - u[k] : y->h[k]);
    return top;
}

static enum rc_status
look(struct rc_model *m, struct rc_point *at, struct rc_err *err)
{
    static const struct rc_plastic_figures none;
    struct yielding *y = (struct yielding *)m;
    struct rc_yielding_figures *f = &y->figures;
    const struct rc_press_figures *press = rc_press_result(y->press);
    struct rc_plastic *plastic = rc_press_plastic(y->press);

    y->top = highest(y);
    if (m->to.at[RC_LOAD] == 0 && look_apart(y, NULL, &f->contact, err) != RC_OK)
        return RC_FAIL;
    if (m->to.at[RC_LOAD] > 0)
        rc_solver_result(rc_press_solver(y->press), NULL, NULL, &f->contact);
    f->plastic = plastic != NULL ? *rc_plastic_result(plastic) : none;
    f->slabs = press->slabs;
    f->max_mises_over_yield = plastic == NULL && press->most > 0 ? press->most : NAN;
    f->max_mises_depth = plastic == NULL && press->most > 0 ? press->deepest : NAN;
    if (plastic != NULL) {
        f->contact.pressure_error = f->plastic.error;
        f->contact.convolutions = NAN; /* nearly all of the work is in the volume */
        /* the error is unknown where few increments were asked for */
        f->contact.converged = m->status == RC_OK && f->contact.converged &&
                               (f->plastic.error <= press->goal ||
                                (y->problem.increments > 0 && isnan(f->plastic.error)));
    }
    f->residual_indentation = y->first_top - y->top;
    f->indentation = (m->to.at[RC_LOAD] > 0 ? f->contact.approach : 0) + y->first_top - y->top;
    at->at[RC_LOAD] = f->contact.load;
    at->at[RC_APPROACH] = f->contact.approach;
    y->looked = true;
    return RC_OK;
}

static enum rc_status
fill(struct rc_model *m, size_t frame, double *to, struct rc_err *err)
{
    struct yielding *y = (struct yielding *)m;
    struct rc_contact again;

    if (!y->looked)
        return rc_err_set(err, "frames are those of a point that was looked at");
    memset(to, 0, y->n * sizeof *to);
    if (frame == SHAPE)
        shape(y, to);
    else if (frame == RC_FRAME_GAP && m->to.at[RC_LOAD] == 0)
        return look_apart(y, to, &again, err);
    else if (m->to.at[RC_LOAD] > 0 && (frame == RC_FRAME_PRESSURE || frame == RC_FRAME_CONTACT))
        memcpy(to, rc_solver_pressure(rc_press_solver(y->press)), y->n * sizeof *to);
    else if (frame != RESIDUAL && m->to.at[RC_LOAD] > 0)
        rc_solver_result(rc_press_solver(y->press), frame == RC_FRAME_DISPLACEMENT ? to : NULL,
                         frame == RC_FRAME_GAP ? to : NULL, &again);
    if (frame == RESIDUAL || frame == RC_FRAME_DISPLACEMENT)
        displace(y, 1, to);
    for (size_t k = 0; k < y->n && frame == RC_FRAME_CONTACT; k++)
        to[k] = rc_in_contact(to[k]) ? 1 : 0;
    return RC_OK;
}

/* ---- states ---- */

/* The numbers go into a new press where this one has yielded and cannot return to a body that has not. */
static void
read_press(struct yielding *y, struct rc_state *s, const double *v, size_t n)
{
    struct rc_press *press = y->press;
    struct rc_err err = {""};

    if (!rc_press_returns(press, v, n)) {
        if ((press = rc_press_new(&y->base.shape, y->h, &y->problem, &err)) == NULL) {
            rc_state_refuse(s, err.text);
            return;
        }
        rc_press_free(y->press);
        y->press = press;
    }
    if (rc_press_restore(press, v, n, &err) != RC_OK)
        rc_state_refuse(s, err.text);
    if (y->base.moved)
        y->base.status = RC_MORE; /* a step tells whether it is the solution */
    y->looked = false;
}

static void
state(struct rc_model *m, struct rc_state *s)
{
    struct yielding *y = (struct yielding *)m;
    size_t n = rc_press_state(y->press, NULL);
    double *v;

    rc_state_count(s, &n, SIZE_MAX / sizeof *v - 1);
    if (!rc_state_holds(s, n))
        return;
    if ((v = malloc((n + 1) * sizeof *v)) == NULL) {
        rc_state_refuse(s, "memory is short");
        return;
    }
    if (!rc_state_reads(s))
        (void)rc_press_state(y->press, v);
    rc_state_numbers(s, n, v);
    if (rc_state_reads(s))
        read_press(y, s, v, n);
    free(v);
}

static void
progress(const struct rc_model *m, struct rc_loops *l)
{
    const struct yielding *y = (const struct yielding *)m;
    struct rc_plastic *plastic = rc_press_plastic(y->press);
    struct rc_solver *solver = rc_press_solver(y->press);
    struct rc_progress at;
    size_t increment, application;
    double load, most;

    l->coming = rc_press_memory(y->press, NULL, 0, true);
    if (plastic != NULL) {
        most = (double)rc_press_result(y->press)->increments;
        rc_plastic_progress(plastic, &load, &increment, &application);
        rc_loops_add(l, "load", "N", load, NAN);
        rc_loops_add(l, "increment", NULL, fmin((double)increment, most), most);
        rc_loops_add(l, "application", NULL, (double)application, NAN);
        /* between increments a state is smaller; the last may take long */
        l->worth = application == 0 || (double)increment >= most;
    } else if (solver != NULL) {
        rc_solver_progress(solver, &at);
        rc_loops_add(l, "iteration", NULL, (double)at.iterations, NAN);
        l->grid = at.grid;
        l->error = at.error;
        l->tol = at.tol;
        l->worth = !at.coarser && at.iterations > 0;
    }
}

static void
release(struct rc_model *m)
{
    struct yielding *y = (struct yielding *)m;

    rc_press_free(y->press);
    free(y->h);
}

const struct rc_model_row rc_model_yielding = {
    .name = "yielding",
    .summary = "a body that yields in its volume",
    .needs = 1u << RC_LOAD,
    .takes = 1u << RC_LOAD,
    .figures = sets,
    .frame = frames,
    .go = go,
    .step = step,
    .look = look,
    .fill = fill,
    .state = state,
    .free = release,
    .progress = progress,
};

struct rc_model *
rc_yielding_new(const struct rc_shape *shape, const double *h,
                const struct rc_plastic_problem *problem, struct rc_err *err)
{
    struct rc_model *m;
    struct yielding *y;

    if (rc_shape_check(shape, err) != RC_OK ||
        (m = rc_model_make(&rc_model_yielding, sizeof *y, shape, err)) == NULL)
        return NULL;
    y = (struct yielding *)m;
    y->problem = *problem;
    y->n = shape->nx * shape->ny;
    if ((y->h = rc_alloc(y->n, sizeof *y->h)) == NULL) {
        rc_err_set(err, "out of memory for the heights");
        rc_model_free(m);
        return NULL;
    }
    memcpy(y->h, h, y->n * sizeof *h);
    if ((y->press = rc_press_new(shape, h, problem, err)) == NULL) {
        rc_model_free(m);
        return NULL;
    }
    y->first_top = highest(y);
    return m;
}

struct rc_press *
rc_yielding_press(const struct rc_model *m)
{
    while (m != NULL && m->row != &rc_model_yielding)
        m = m->inner;
    return m != NULL ? ((const struct yielding *)m)->press : NULL;
}

const struct rc_yielding_figures *
rc_yielding_result(const struct rc_model *m)
{
    while (m != NULL && m->row != &rc_model_yielding)
        m = m->inner;
    return m != NULL ? &((const struct yielding *)m)->figures : NULL;
}
