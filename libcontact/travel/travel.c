/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The model of a contact that travels along x over body 1. At the position X the heights are
 *
 *     h(x, y; X) = h1(x, y) + h2(x - r X, y) - ((x - X)^2 + y^2)/(2 R)
 *
 * with the heights h1 of body 1, which stays, h2 of body 2, and a ball of radius R (without y^2: a cylinder).
 * The roughness of body 2 travels r times as far as the contact: r = 1 while it slides, 0 while it rolls. The
 * contact is solved on the whole map of body 1, or in a window of it that goes along by whole nodes. h1 is
 * therefore never interpolated; h2 is, by cubic polynomials, where r X is not a whole number of nodes.
 *
 * A short step starts from 2 p(n) - p(n-1), both carried with body 1. On rough balls this takes 4.5
 * convolutions, and a start from coarser grids 6; after longer steps the coarser grids are as good.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/model/row.h"

static const double short_step = 2; /* nodes */
/* In nodes: smaller parts of a node are rounding. Half and double change no bit (23 runs of
 * bench/constants.py). */
static const double rounding = 1e-6;

struct travel {
    struct rc_model base;
    struct rc_travel_problem problem;
    bool whole; /* the whole map of body 1 is solved */
    size_t n;
    double *h;             /* heights at the position */
    const double *h1, *h2; /* rows of both bodies under the rows held here; h2 NULL: smooth */
    double *p[2];          /* pressures at the last positions, the last one first */
    double x[2];           /* nodes: these positions, */
    double column[2];      /* and the first column of the window there */
    size_t known;          /* of these pressures */
    bool taken;            /* the pressure of the present point is among them */
    double first_top;      /* m: highest node at the first position */
    struct rc_travel_figures figures;
};

const struct rc_figure rc_figures_travel[] = {
    {RC_FIGURE(struct rc_travel_figures, position), "m", "Position",
     .says = "x of the middle of the contact on the map of body 1"},
    {RC_FIGURE(struct rc_travel_figures, height), "m", "Height of body 2",
     .says = "highest node less the approach: in a datum that stays with body 1"},
    {RC_FIGURE(struct rc_travel_figures, window_x), "m", "Middle of the window",
     .says = "x on the map of body 1"},
    {0},
};
static const struct rc_figure_set sets[] = {{rc_figures_travel, offsetof(struct travel, figures)},
                                            {NULL, 0}};

enum {
    HEIGHT
};
static const struct rc_frame_kind frames[] = {[HEIGHT] = {"height", "m", "Height"},
                                              {NULL, NULL, NULL}};

/* ---- heights at a position ---- */

static double
nodes_of(const struct travel *v)
{
    return v->base.to.at[RC_POSITION] / v->base.shape.dx;
}

/* The column of body 1 under the first column of the window. */
static double
column_of(const struct travel *v)
{
    const double beside = (double)v->problem.track.nx - (double)v->base.shape.nx;

    return v->whole ? 0 : floor(nodes_of(v) + beside / 2 + 0.5);
}

/* The index i of a line of n nodes that repeats, or i if it is inside. False: i is outside. */
static bool
reach(double i, size_t n, bool repeats, size_t *at)
{
    if (repeats)
        i -= (double)n * floor(i / (double)n);
    *at = (size_t)fmax(i, 0);
    return i >= 0 && i < (double)n;
}

static enum rc_status
check_position(const struct travel *v, struct rc_err *err)
{
    const struct rc_shape *track = &v->problem.track, *window = &v->base.shape;
    const double beside = (double)(track->nx - (v->whole ? 1 : window->nx)) / 2;

    if (v->problem.repeats || fabs(nodes_of(v)) <= beside + rounding)
        return RC_OK;
    return rc_err_set(
        err, "position %.9g m: %s reaches beyond the map: take positions from %.9g to %.9g m",
        v->base.to.at[RC_POSITION], v->whole ? "the contact" : "the window", -beside * track->dx,
        beside * track->dx);
}

/* Adds the ball or the cylinder. On a map that repeats, its nearest image. */
static void
add_ball(struct travel *v, double column)
{
    const struct rc_shape *s = &v->base.shape;
    const double middle = nodes_of(v) + (double)(v->problem.track.nx - 1) / 2 - column;

    for (size_t j = 0; j < v->base.rows.n; j++)
        for (size_t i = 0; i < s->nx; i++) {
            double x = (double)i - middle, y = (double)(v->base.rows.first + j);
            y = (y - (double)(s->ny - 1) / 2) * s->dy;
            if (v->problem.cylinder)
                y = 0;
            if (v->whole && v->problem.repeats)
                x -= (double)s->nx * round(x / (double)s->nx);
            x *= s->dx;
            v->h[j * s->nx + i] -= (x * x + y * y) / (2 * v->problem.radius);
        }
}

/* Adds the heights of body 2, by the cubic polynomial through four nodes of a row. */
static enum rc_status
add_counter(struct travel *v, double column, struct rc_err *err)
{
    const struct rc_travel_problem *a = &v->problem;
    const struct rc_shape *s = &v->base.shape, *other = &a->counter;
    const double from =
        column - a->ratio * nodes_of(v) + ((double)other->nx - (double)a->track.nx) / 2;
    double first = floor(from + rounding), t = fmax(from - first, 0);
    const double weight[] = {-t * (1 - t) * (2 - t) / 6, (1 + t) * (1 - t) * (2 - t) / 2,
                             t * (1 + t) * (2 - t) / 2, -t * (1 + t) * (1 - t) / 6};
    const bool between = t > rounding;

    for (size_t i = 0; i < s->nx; i++)
        for (int q = between ? 0 : 1; q < (between ? 4 : 2); q++) {
            size_t at;
            if (!reach(first + (double)i + q - 1, other->nx, a->counter_repeats, &at))
                return rc_err_set(
                    err,
                    "position %.9g m: the map of body 2, %zu columns, does not cover the "
                    "contact: take a longer map, or one that repeats",
                    v->base.to.at[RC_POSITION], other->nx);
            for (size_t j = 0; j < v->base.rows.n; j++)
                v->h[j * s->nx + i] += (between ? weight[q] : 1) * v->h2[j * other->nx + at];
        }
    return RC_OK;
}

/* Gives the inner model the heights at the position. */
static enum rc_status
pose(struct travel *v, struct rc_err *err)
{
    const struct rc_travel_problem *a = &v->problem;
    const struct rc_shape *s = &v->base.shape;
    const double column = column_of(v);
    size_t at;

    if (check_position(v, err) != RC_OK)
        return RC_FAIL;
    for (size_t i = 0; i < s->nx; i++) {
        (void)reach(column + (double)i, a->track.nx, a->repeats, &at);
        for (size_t j = 0; j < v->base.rows.n; j++)
            v->h[j * s->nx + i] = v->h1[j * a->track.nx + at];
    }
    if (a->radius > 0)
        add_ball(v, column);
    if (v->h2 != NULL && add_counter(v, column, err) != RC_OK)
        return RC_FAIL;
    return rc_model_set_heights(v->base.inner, v->h, err);
}

/* ---- the start of a contact ---- */

/* Sets p[1] to p[0] + more (p[0] - p[1]), both carried with body 1, and returns its sum. */
static double
extrapolate(struct travel *v, double column, double more)
{
    const size_t nx = v->base.shape.nx;
    const double forth = column - v->column[0], back = column - v->column[1];
    struct rc_total sum = {0};

    for (size_t q = 0; q < v->n; q++) {
        const size_t k = back < 0 ? v->n - 1 - q : q, row = k / nx * nx; /* p[1] is read ahead */
        size_t last, before;
        double p = 0;
        if (reach((double)(k - row) + forth, nx, false, &last))
            p += (1 + more) * v->p[0][row + last];
        if (reach((double)(k - row) + back, nx, false, &before))
            p -= more * v->p[1][row + before];
        v->p[1][k] = fmax(p, 0);
        rc_total_add(&sum, v->p[1][k]);
    }
    return rc_ranks_total(v->base.rows.ranks, sum);
}

static enum rc_status
start(struct travel *v, struct rc_err *err)
{
    const double step = nodes_of(v) - v->x[0], last = v->x[0] - v->x[1];
    const size_t known = v->known;
    struct rc_model *inner = v->base.inner;
    double sum;

    if (!rc_model_takes_start(inner) || known == 0)
        return RC_OK;
    v->known = 1; /* p[1] is used up */
    if (known < 2 || !(step * last > 0) || fabs(step) > short_step + rounding ||
        fabs(last) > short_step + rounding)
        return rc_model_start(inner, 0, NULL, err);
    sum = extrapolate(v, column_of(v), step / last);
    return rc_model_start(inner, sum * v->base.shape.dx * v->base.shape.dy, v->p[1], err);
}

static enum rc_status
go(struct rc_model *m, struct rc_err *err)
{
    struct travel *v = (struct travel *)m;
    const struct rc_point inner = rc_point_for(m->inner, &m->to);

    if (!(m->to.at[rc_point_has(&m->to, RC_APPROACH) ? RC_APPROACH : RC_LOAD] > 0))
        return rc_err_set(err, "bodies that travel need a load or an approach above 0");
    v->taken = false;
    if (pose(v, err) != RC_OK || rc_model_go(m->inner, &inner, err) == RC_FAIL)
        return RC_FAIL;
    if (m->inner->from.given == 0)
        v->first_top = rc_ranks_highest(v->base.rows.ranks, v->h, v->n);
    return start(v, err);
}

/* Keeps the pressure as a start for the next positions. */
static enum rc_status
take(struct travel *v, struct rc_err *err)
{
    double *p = v->p[1];

    v->taken = true;
    if (!rc_model_takes_start(v->base.inner))
        return RC_OK;
    if (rc_model_look(v->base.inner, NULL, err) != RC_OK ||
        rc_model_frame(v->base.inner, "pressure", p, err) != RC_OK)
        return RC_FAIL;
    v->p[1] = v->p[0];
    v->p[0] = p;
    v->x[1] = v->x[0];
    v->x[0] = nodes_of(v);
    v->column[1] = v->column[0];
    v->column[0] = column_of(v);
    v->known += v->known < 2;
    return RC_OK;
}

static enum rc_status
step(struct rc_model *m, struct rc_err *err)
{
    struct travel *v = (struct travel *)m;
    const enum rc_status status = rc_model_step(m->inner, err);

    return (status == RC_OK || status == RC_SHORT) && !v->taken && take(v, err) != RC_OK ? RC_FAIL
                                                                                         : status;
}

/* ---- results ---- */

static enum rc_status
look(struct rc_model *m, struct rc_point *at, struct rc_err *err)
{
    struct travel *v = (struct travel *)m;

    (void)err;
    v->figures.position = at->at[RC_POSITION];
    v->figures.window_x =
        (column_of(v) - ((double)v->problem.track.nx - (double)v->base.shape.nx) / 2) *
        v->base.shape.dx;
    v->figures.height = v->first_top - rc_model_number(m->inner, "indentation");
    return RC_OK;
}

static enum rc_status
fill(struct rc_model *m, size_t frame, double *to, struct rc_err *err)
{
    const struct travel *v = (const struct travel *)m;

    (void)frame;
    (void)err;
    memcpy(to, v->h, v->n * sizeof *to);
    return RC_OK;
}

/* Body 1 keeps the shape of the whole map. In a window every position is a first contact. */
static enum rc_status
keep(struct rc_model *m, struct rc_err *err)
{
    return ((struct travel *)m)->whole ? rc_model_keep(m->inner, err) : RC_OK;
}

static void
state(struct rc_model *m, struct rc_state *s)
{
    struct travel *v = (struct travel *)m;
    struct rc_err err;

    rc_state_count(s, &v->known, 2);
    RC_STATE_FLAGS(s, &v->taken);
    RC_STATE_NUMBERS(s, &v->first_top);
    rc_state_finite(s, 2, v->x);
    rc_state_finite(s, 2, v->column);
    for (size_t k = 0; k < v->known; k++)
        rc_state_map(s, v->n, v->p[k]);
    if (rc_state_reads(s) && m->to.given != 0 && pose(v, &err) != RC_OK)
        rc_state_refuse(s, err.text);
}

static void
progress(const struct rc_model *m, struct rc_loops *l)
{
    rc_loops_add(l, "position", "m", m->to.at[RC_POSITION], NAN);
}

static enum rc_status
plan(const struct rc_model *m, const struct rc_point *most, struct rc_expected *expected,
     struct rc_err *err)
{
    const struct travel *v = (const struct travel *)m;
    const struct rc_point inner = rc_point_for(m->inner, most);
    const size_t maps = rc_model_takes_start(m->inner) ? 3 : 1;

    if (rc_model_plan(m->inner, &inner, expected, err) != RC_OK)
        return RC_FAIL;
    expected->memory += maps * v->n * sizeof(double);
    return RC_OK;
}

const struct rc_model_row rc_model_travel = {
    .name = "travel",
    .summary = "a contact that travels over body 1, over an inner model",
    .needs = 1u << RC_LOAD | 1u << RC_POSITION,
    .takes = 1u << RC_POSITION,
    .forgets = true, /* the pressures that it stores are only starts */
    RC_MODEL_VERBS,
    .frame = frames,
    .keep = keep,
    .plan = plan,
};

/* ---- the maker ---- */

static enum rc_status
check(const struct rc_shape *window, const struct rc_travel_problem *a, struct rc_err *err)
{
    if (window->nx > a->track.nx || window->ny > a->track.ny)
        return rc_err_set(err,
                          "a window of %zu x %zu nodes on a map of %zu x %zu: it must be smaller",
                          window->nx, window->ny, a->track.nx, a->track.ny);
    if ((a->track.ny - window->ny) % 2 != 0)
        return rc_err_set(
            err,
            "a window of %zu rows on a map of %zu rows: the middle of the one is half "
            "a row from the middle of the other: take a window of %zu rows",
            window->ny, a->track.ny, window->ny + 1);
    if (!(a->radius >= 0) || isinf(a->radius))
        return rc_err_set(err, "radius %g m: it must be at least 0 and finite", a->radius);
    if (!isfinite(a->ratio))
        return rc_err_set(err, "travel of body 2 over that of the contact, %g: it must be finite",
                          a->ratio);
    if (a->h2 == NULL && a->radius == 0)
        return rc_err_set(err, "nothing travels: body 2 must be a ball, or have heights");
    if (a->h2 != NULL && a->counter.ny < window->ny)
        return rc_err_set(err, "the map of body 2 has %zu rows: it must have at least %zu",
                          a->counter.ny, window->ny);
    if (a->h2 != NULL && (a->counter.ny - window->ny) % 2 != 0)
        return rc_err_set(
            err,
            "the map of body 2 has %zu rows and the contact %zu: the middle of the one "
            "is half a row from the middle of the other: cut the map of body 2 to "
            "%zu rows",
            a->counter.ny, window->ny, a->counter.ny - 1);
    return RC_OK;
}

/* The rows of a map under the rows of the window that are held here: a place in the given rows, or a copy of
 * the rows of other ranks. */
static enum rc_status
take_rows(struct travel *v, const struct rc_shape *of, const double *given, const double **rows,
          struct rc_err *err)
{
    const struct rc_model *m = &v->base;
    const struct rc_ranks *ranks = m->rows.ranks;
    const size_t before = (of->ny - m->shape.ny) / 2, count = rc_ranks_count(ranks);
    RC_OWNED size_t *from = NULL;
    double *copy = NULL;
    bool same = before == 0;

    *rows = given + before * of->nx;
    if (ranks == NULL)
        return RC_OK;
    from = malloc(2 * (count + 1) * sizeof *from);
    for (size_t r = 0; r <= count && from != NULL; r++) {
        from[r] = rc_rows_dealt(of->ny, rc_rows_unit(of->nx), count, r);
        from[count + 1 + r] =
            before + rc_rows_dealt(m->shape.ny, rc_rows_unit(m->shape.nx), count, r);
        same = same && from[r] == from[count + 1 + r];
    }
    if (from != NULL && !same)
        copy = rc_store_take(&v->base.own, m->rows.n * of->nx, sizeof *copy);
    if (rc_ranks_need(ranks, from != NULL, err, "out of memory for the rows of %zu processes",
                      count) != RC_OK ||
        rc_model_room(m, err) != RC_OK)
        return RC_FAIL;
    if (!same)
        rc_ranks_move(ranks, of->nx * sizeof *copy, from, from + count + 1, 0, given, copy);
    *rows = same ? given : copy;
    return RC_OK;
}

struct rc_model *
rc_travel_new(struct rc_model *inner, const struct rc_travel_problem *problem, struct rc_err *err)
{
    RC_OWN(rc_model, m) = rc_model_make_outer(&rc_model_travel, sizeof(struct travel), inner, err);
    struct travel *v = (struct travel *)m;

    if (m == NULL)
        return NULL;
    v->problem = *problem;
    v->n = rc_model_nodes(m);
    v->whole = m->shape.nx == problem->track.nx;
    if (check(&m->shape, problem, err) != RC_OK)
        return NULL;
    v->h = rc_store_take(&m->own, v->n, sizeof *v->h);
    for (int k = 0; k < 2 && rc_model_takes_start(m->inner); k++)
        v->p[k] = rc_store_take(&m->own, v->n, sizeof *v->h);
    return rc_model_room(m, err) == RC_OK &&
                   take_rows(v, &problem->track, problem->h1, &v->h1, err) == RC_OK &&
                   (problem->h2 == NULL ||
                    take_rows(v, &problem->counter, problem->h2, &v->h2, err) == RC_OK)
               ? rc_give(&m)
               : NULL;
}
