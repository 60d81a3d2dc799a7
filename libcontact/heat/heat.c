/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Temperatures of two bodies that share the heat of their contact. f is the heat flux into body 1, of any
 * sign, and q - f that into body 2. D is the bulk of body 2 less that of body 1. Equal temperatures in
 * the contact need
 *
 *     (C1 + C2) f = C2 q + D   at the nodes in contact,   f = 0 elsewhere.
 *
 * C1 + C2 is not symmetric where a body moves, but its symmetric part is positive. It is solved by GMRES
 * without restart (Saad and Schultz 1986), with the preconditioner of inverse.c on the right. The residual is
 * then the difference of the temperatures, and its largest value decides when to stop.
 */
#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "heat.h"
#include "libcontact/expected.h"
#include "libcontact/memory.h"

enum {
    STEPS = 100, /* of the iteration, at most */
    TIMES = 64   /* time steps, at most, if the caller gives no number */
};
/* Part of the tolerance for the mismatch in each run, if the time steps are doubled until it is met. */
static const double own_part = 0.25;
static const double usual_tol = 1e-3;

/* Heat is constant in each of `n` time steps; step `at` is being solved. Number k of a body: its temperature
 * k steps after one in which heat flows. */
struct times {
    size_t n, at;
    struct rc_warming *lag[2];
    double *share;   /* heat into body 1 at the nodes in contact, for each time step */
    double *past[2]; /* K: rise due to earlier time steps, nx ny; NULL: there is one */
};

/* The iteration at the nodes in contact: C1 z = V h, with V orthonormal, z = M v */
struct space {
    double *right, *v[STEPS + 1], *z[STEPS];
    double h[STEPS][STEPS + 1]; /* column by column; its first rows are rotated to a triangle */
    double turn[STEPS][2], g[STEPS + 1];
    size_t steps; /* of this time step */
};

/* Runs with 1, 2, 4 ... time steps. The errors of a run are nearly proportional to the length of its steps.
 * So the result is 2 T - T', T' with half as many steps. All laws are linear, and hold for it too: no heat is
 * lost, and the temperatures match. */
struct doubling {
    bool on;
    struct rc_heat *finest, *half; /* NULL: this one, in one step */
    double *rise[2], *flux;        /* of the finest run */
    double change;     /* of the result since the last doubling, over the largest rise */
    double count;      /* convolutions of earlier runs */
    size_t iterations; /* of earlier runs */
};

struct rc_heat {
    struct rc_store own; /* the maps and arrays below */
    struct rc_shape shape;
    struct rc_heat_problem problem;
    struct rc_conduction *c;
    struct times times;
    struct rc_heat_inverse *inverse; /* NULL: heat is not matched */
    double drop;                     /* K: bulk temperature of body 2 less that of body 1 */
    double scale;                    /* K: largest rise of a body above its bulk          */
    size_t n, *node;                 /* in contact                                        */
    double *q, *flux[2],
        *rise[2]; /* heat and rise above their bulk, nx ny; heat is 0 out of contact */
    double *work; /* nx ny */
    struct space space;
    size_t earlier; /* steps of all time steps before */
    double worst;   /* largest mismatch of the time steps  */
    bool begun;
    double asked; /* tolerance of the caller */
    struct doubling doubling;
    struct rc_heat_figures figures;
};

#define FIGURE(member) RC_FIGURE(struct rc_heat_figures, member)
const struct rc_figure rc_figures_heat[] = {
    {FIGURE(heat_power), "W", "Heat", .says = "of the contact"},
    {FIGURE(heat_power_1), "W", "Heat into body 1"},
    {FIGURE(share_1), NULL, "Share of body 1",
     .says = "none where more heat crosses between bulk temperatures than the contact has"},
    {FIGURE(share_blok), NULL, "Share of body 1 of Blok",
     .says = "one number, for equal largest temperatures"},
    {FIGURE(share_charron), NULL, "Share of body 1 without motion"},
    {FIGURE(peclet_1), NULL, "Peclet number of body 1", .says = "of the largest patch"},
    {FIGURE(peclet_2), NULL, "Peclet number of body 2", .says = "of the largest patch"},
    {FIGURE(cell_peclet_1), NULL, "Peclet number of a cell of body 1", .role = RC_FIGURE_CHECK},
    {FIGURE(cell_peclet_2), NULL, "Peclet number of a cell of body 2", .role = RC_FIGURE_CHECK},
    {FIGURE(max_temperature), "K", "Largest temperature", .says = "above the bulk of body 1"},
    {FIGURE(max_x), "m", "Place of the largest temperature along x"},
    {FIGURE(max_y), "m", "Place of the largest temperature along y"},
    {FIGURE(mean_temperature), "K", "Mean temperature in contact", .says = "of the hotter body"},
    {RC_FIGURE_AS("temperature_error_estimate", struct rc_heat_figures, mismatch), NULL,
     "Error of the temperatures", .says = "largest difference of the bodies over the largest rise",
     .role = RC_FIGURE_ERROR, .by = "tol", .of = "max_temperature"},
    {RC_FIGURE_AS("time_error_estimate", struct rc_heat_figures, time_error), NULL,
     "Error of the time steps", .says = "largest error of a temperature over the largest rise",
     .role = RC_FIGURE_ERROR, .by = "time-steps", .of = "max_temperature"},
    {FIGURE(hot_nodes), NULL, "Nodes of the hottest spot along the motion",
     .role = RC_FIGURE_CHECK},
    {FIGURE(steady_time), "s", "Time to a steady state"},
    {FIGURE(iterations), NULL, "Iterations", .role = RC_FIGURE_COST},
    {FIGURE(convolutions), NULL, "Convolutions", .role = RC_FIGURE_COST},
    {FIGURE(converged), NULL, "Converged"},
    {0},
};

/* ---- the problem ---- */

/* True if body b has a temperature: the time is finite, no axis repeats, or the body moves along the free
 * one. */
static bool
has_rise(const struct rc_heat_problem *p, int b)
{
    return p->time > 0 || rc_repeats(p->boundary) == 0 ||
           (rc_repeats(p->boundary) == 1 && p->body[b].velocity[p->boundary.x ? 1 : 0] != 0);
}

static bool
takes_heat(const struct rc_heat_problem *p, int b)
{
    return p->partition != RC_HEAT_SHARE || p->share != (b == 0 ? 0 : 1);
}

/* of a cell; the quadrature of the coefficients grows with it, and they tend to those of a body without
 * conduction along the motion */
static const double most_peclet = 1e9;

static enum rc_status
check(const struct rc_shape *shape, const struct rc_heat_problem *p, struct rc_err *err)
{
    if (rc_shape_check(shape, err) != RC_OK)
        return RC_FAIL;
    for (int b = 0; b < 2; b++) {
        const struct rc_heat_body *body = &p->body[b];
        if (!(body->conductivity > 0) || isinf(body->conductivity))
            return rc_err_set(err, "conductivity of body %d, %g W/(m K): it must be above 0", b + 1,
                              body->conductivity);
        if (!(body->diffusivity > 0) || isinf(body->diffusivity))
            return rc_err_set(err, "diffusivity of body %d, %g m2/s: it must be above 0", b + 1,
                              body->diffusivity);
        if (!isfinite(body->velocity[0]) || !isfinite(body->velocity[1]) || !isfinite(body->bulk))
            return rc_err_set(err, "velocity or bulk temperature of body %d is not a number",
                              b + 1);
        if (fmax(fabs(body->velocity[0]) * shape->dx, fabs(body->velocity[1]) * shape->dy) >
            most_peclet * 2 * body->diffusivity)
            return rc_err_set(err,
                              "velocity of body %d, %g and %g m/s: the Peclet number of a cell is "
                              "above %g: check the units of velocity, diffusivity and spacing",
                              b + 1, body->velocity[0], body->velocity[1], most_peclet);
        if (rc_repeats(p->boundary) == 1 && takes_heat(p, b) && !has_rise(p, b))
            return rc_err_set(err,
                              "body %d does not move along %c, and the map repeats along %c: it "
                              "becomes warmer without end: give a time",
                              b + 1, p->boundary.x ? 'y' : 'x', p->boundary.x ? 'x' : 'y');
    }
    if (!(p->time >= 0) || isinf(p->time))
        return rc_err_set(err, "time %g s: it must be above 0, or 0 for the steady state", p->time);
    if (!rc_has_mean(p->boundary) && p->time == 0)
        return rc_err_set(err, "a periodic map becomes warmer without end, and has no steady "
                               "temperature: give a time");
    if (p->partition == RC_HEAT_SHARE && !(p->share >= 0 && p->share <= 1))
        return rc_err_set(err, "share of body 1, %g: it must be from 0 to 1", p->share);
    if (!(p->tol >= 0 && p->tol < 1))
        return rc_err_set(err, "tolerance %g: it must be from 0 to 1", p->tol);
    return RC_OK;
}

/* Body b at a depth, `lag` time steps after one in which heat flows. Along an axis that repeats after one
 * node nothing changes, and motion has no effect. */
static struct rc_heated
heated(const struct rc_heat *h, int b, double depth, size_t lag)
{
    const struct rc_heat_body *body = &h->problem.body[b];
    const double time = h->problem.time / (double)h->times.n;
    const bool x = h->shape.nx > 1 || !rc_wraps(h->problem.boundary, RC_X);
    const bool y = h->shape.ny > 1 || !rc_wraps(h->problem.boundary, RC_Y);

    return (struct rc_heated){
        .k = body->conductivity,
        .px = x ? body->velocity[0] / (2 * body->diffusivity) : 0,
        .py = y ? body->velocity[1] / (2 * body->diffusivity) : 0,
        .diffusion = time > 0 ? 2 * sqrt(body->diffusivity * time * (double)(lag + 1)) : INFINITY,
        .ended = 2 * sqrt(body->diffusivity * time * (double)lag),
        .depth = depth,
    };
}

static enum rc_status
set_contact(struct rc_heat *h, const double *q, const double *contact, struct rc_err *err)
{
    const struct rc_shape *s = &h->shape;

    for (size_t k = 0; k < s->nx * s->ny; k++) {
        const bool in = contact != NULL ? rc_in_contact(contact[k]) : q[k] != 0;
        if (!isfinite(q[k]) || (q[k] != 0 && !in))
            return rc_err_set(
                err,
                "heat flux %g W/m2 at column %zu, row %zu: it must be finite, and 0 out of "
                "contact",
                q[k], k % s->nx, k / s->nx);
        h->q[k] = q[k];
        h->n += in;
    }
    if (h->n == 0)
        return rc_err_set(err, "no node is in contact, so no heat flows");
    if ((h->node = rc_store_take(&h->own, h->n, sizeof *h->node)) == NULL)
        return rc_err_set(err, "out of memory for %zu nodes in contact", h->n);
    for (size_t k = 0, n = 0; k < s->nx * s->ny; k++)
        if (contact != NULL ? rc_in_contact(contact[k]) : q[k] != 0)
            h->node[n++] = k;
    return RC_OK;
}

/* The length of a map that repeats along one axis, along this axis. */
static double
length_around(const struct rc_heat *h)
{
    return h->problem.boundary.x ? (double)h->shape.nx * h->shape.dx
                                 : (double)h->shape.ny * h->shape.dy;
}

/* True if the largest patch joins itself around a map that repeats along one axis, as a line contact does. On
 * two such maps beside each other it then has twice the area. */
static enum rc_status
is_band(const struct rc_heat *h, const double *contact, const struct rc_patch_options *options,
        double area, bool *band, struct rc_err *err)
{
    const bool x = h->problem.boundary.x;
    const size_t nx = h->shape.nx, ny = h->shape.ny, n = x ? nx : nx * ny;
    const struct rc_shape two = {x ? 2 * nx : nx, x ? ny : 2 * ny, h->shape.dx, h->shape.dy};
    RC_OWNED double *twice = NULL;
    struct rc_patches patches;
    enum rc_status status;

    *band = false;
    if (rc_repeats(h->problem.boundary) != 1)
        return RC_OK;
    if ((twice = rc_alloc(2 * nx * ny, sizeof *twice)) == NULL)
        return rc_err_set(err, "out of memory for the contact of %zu x %zu nodes", nx, ny);
    for (size_t k = 0; k < 2 * nx * ny; k++)
        twice[k] = contact[k / n / 2 * n + k % n];
    status = rc_patches_find(&two, twice, options, &patches, err);
    *band = status == RC_OK && patches.patch[0].area > 1.5 * area;
    rc_patches_free(&patches);
    return status;
}

/* Figures that need no temperature. */
static enum rc_status
set_figures(struct rc_heat *h, const double *contact, struct rc_err *err)
{
    const struct rc_patch_options options = {
        .boundary = h->problem.boundary, .each = true, .threads = h->problem.threads};
    const struct rc_heat_body *body = h->problem.body;
    struct rc_heat_figures *f = &h->figures;
    struct rc_patches patches;

    double peclet[2], of_cell[2], radius = 0;
    bool band = false;
    enum rc_status status = rc_patches_find(&h->shape, contact, &options, &patches, err);

    if (status == RC_OK)
        status = is_band(h, contact, &options, patches.patch[0].area, &band, err);
    if (status == RC_OK)
        radius = band ? patches.patch[0].area / length_around(h) / 2
                      : sqrt(patches.patch[0].area / RC_PI);
    for (int b = 0; b < 2 && status == RC_OK; b++) {
        const struct rc_heated p = heated(h, b, 0, 0);
        peclet[b] = hypot(p.px, p.py) * radius;
        of_cell[b] = fmax(fabs(p.px) * h->shape.dx, fabs(p.py) * h->shape.dy);
    }
    if (status == RC_OK) {
        f->peclet_1 = peclet[0];
        f->peclet_2 = peclet[1];
        f->cell_peclet_1 = of_cell[0];
        f->cell_peclet_2 = of_cell[1];
        f->heat_power = rc_sum(h->q, h->shape.nx * h->shape.ny) * h->shape.dx * h->shape.dy;
        f->steady_time =
            (band ? pow(patches.contact_area / length_around(h), 2) : patches.contact_area) /
            fmin(body[0].diffusivity, body[1].diffusivity);
        f->share_charron = body[0].conductivity / (body[0].conductivity + body[1].conductivity);
    }
    rc_patches_free(&patches);
    return status;
}

/* The temperatures of body b at a depth, for each lag, in memory of `own`; NULL: *err says why. They are left
 * 0 for a body that takes no heat and has no steady state. */
static struct rc_warming *
lags_new(const struct rc_heat *h, int b, double depth, struct rc_store *own, struct rc_err *err)
{
    struct rc_warming *lag = rc_store_zeros(own, h->times.n, sizeof *lag);

    if (lag == NULL)
        return rc_err_null(err, "out of memory for %zu time steps", h->times.n);
    for (size_t k = 0; k < h->times.n && has_rise(&h->problem, b); k++) {
        const struct rc_heated body = heated(h, b, depth, k);
        if (rc_warming_set(&lag[k], own, h->c, &body, err) != RC_OK)
            return NULL;
    }
    return lag;
}

void
rc_heat_free(struct rc_heat *h)
{
    if (h == NULL)
        return;
    rc_heat_free(h->doubling.finest);
    rc_heat_free(h->doubling.half);
    rc_heat_inverse_free(h->inverse);
    rc_conduction_free(h->c);
    rc_store_free(&h->own);
    free(h);
}

/* The usual number of time steps if the tolerance determines it, of 108 contacts. A contact that has become
 * steady needs few. The others need 1.6 times as many for each decade of the tolerance. */
static double
usual_steps(const struct rc_shape *shape, const struct rc_heat_problem *p)
{
    const double patch = 0.05; /* area of the largest patch over that of the map */
    const double few = 4, long_time = 3;
    const double steady = patch * (double)(shape->nx * shape->ny) * shape->dx * shape->dy /
                          fmin(p->body[0].diffusivity, p->body[1].diffusivity);
    const double tol = p->tol > 0 ? p->tol : usual_tol;

    return p->time > long_time * steady ? few
                                        : fmin(few * pow(1.6, fmax(log10(1e-2 / tol), 0)), TIMES);
}

enum rc_status
rc_heat_expect(const struct rc_shape *shape, const struct rc_heat_problem *p, size_t depths,
               struct rc_expected *expected, struct rc_err *err)
{
    const struct rc_conv_options sum = {.boundary = p->boundary, .threads = p->threads};
    const bool matched = p->partition == RC_HEAT_MATCHED;
    const bool doubles = matched && p->time > 0 && p->time_steps == 0;
    const double nodes = (double)(shape->nx * shape->ny), times = doubles ? usual_steps(shape, p)
                                                                  : matched && p->time > 0
                                                                      ? (double)p->time_steps
                                                                      : 1;
    const double one = rc_conv_seconds(shape, &sum),
                 cores = (double)(p->threads == 0 ? rc_threads_available() : p->threads);
    static const double bytes[2][2] = RC_HEAT_BYTES;

    if (check(shape, p, err) != RC_OK)
        return RC_FAIL;
    *expected = (struct rc_expected){
        .convolutions = RC_HEAT_WORK + (matched ? RC_HEAT_STEP * times : 0) + times * (times + 1),
        .memory =
            (size_t)(nodes * (rc_by_padding(p->boundary, bytes[0][!matched], bytes[1][!matched]) +
                              RC_HEAT_TIME_BYTES * (times - 1)))};
    for (double n = times / 2; doubles && n >= 1; n /= 2) {
        expected->convolutions += RC_HEAT_WORK + RC_HEAT_STEP * n + n * (n + 1);
        expected->memory +=
            n < times / 2 && n > 1
                ? 0
                : (size_t)(nodes * (rc_by_padding(p->boundary, bytes[0][0], bytes[1][0]) +
                                    RC_HEAT_TIME_BYTES * (n - 1)));
    }
    expected->seconds = one * expected->convolutions +
                        (RC_HEAT_NODE + RC_HEAT_DEPTH * (double)depths) * nodes * 2 / cores;
    return RC_OK;
}

struct rc_heat *
rc_heat_new(const struct rc_shape *shape, const struct rc_heat_problem *problem, const double *q,
            const double *contact, struct rc_err *err)
{
    const size_t nodes = shape->nx * shape->ny;
    struct rc_heated body[2];
    RC_OWN(rc_heat, h) = NULL;

    if (check(shape, problem, err) != RC_OK)
        return NULL;
    if ((h = calloc(1, sizeof *h)) == NULL ||
        (h->q = rc_store_take(&h->own, 6 * nodes, sizeof *h->q)) == NULL)
        return rc_err_null(err, "out of memory for the heat of %zu x %zu nodes", shape->nx,
                           shape->ny);
    h->shape = *shape;
    h->problem = *problem;
    h->asked = problem->tol > 0 ? problem->tol : usual_tol;
    h->doubling.on =
        problem->time > 0 && problem->time_steps == 0 && problem->partition == RC_HEAT_MATCHED;
    h->problem.tol = h->doubling.on ? own_part * h->asked : h->asked;
    if (problem->time > 0 && problem->time_steps > 0 && problem->partition == RC_HEAT_MATCHED)
        h->figures.time_error = NAN;
    h->drop = problem->body[1].bulk - problem->body[0].bulk;
    h->times.n = problem->time > 0 && problem->time_steps > 0 &&
                         problem->partition == RC_HEAT_MATCHED /* else the shares are constant */
                     ? problem->time_steps
                     : 1;
    for (int b = 0; b < 2; b++) {
        h->flux[b] = h->q + (size_t)(1 + b) * nodes;
        h->rise[b] = h->q + (size_t)(3 + b) * nodes;
    }
    h->work = h->q + 5 * nodes;
    memset(h->q, 0, 6 * nodes * sizeof *h->q);
    if (set_contact(h, q, contact, err) != RC_OK)
        return NULL;
    h->space.right = rc_store_take(&h->own, h->n, sizeof *h->space.right);
    h->times.share = rc_store_take(&h->own, h->times.n * h->n, sizeof *h->times.share);
    for (int b = 0; b < 2 && h->times.n > 1; b++)
        h->times.past[b] = rc_store_take(&h->own, nodes, sizeof **h->times.past);
    for (int b = 0; b < 2 && h->doubling.on; b++)
        h->doubling.rise[b] = rc_store_take(&h->own, nodes, sizeof **h->doubling.rise);
    if (h->doubling.on)
        h->doubling.flux = rc_store_take(&h->own, nodes, sizeof *h->doubling.flux);
    if (h->own.failed)
        return rc_err_null(err, "out of memory for %zu nodes in contact", h->n);
    for (size_t k = 0; k < h->n; k++)
        h->work[h->node[k]] = 1;
    if (set_figures(h, h->work, err) != RC_OK ||
        (h->c = rc_conduction_new(shape, problem->boundary, problem->threads, err)) == NULL)
        return NULL;
    for (int b = 0; b < 2; b++) {
        body[b] = heated(h, b, 0, 0);
        if ((h->times.lag[b] = lags_new(h, b, 0, &h->own, err)) == NULL)
            return NULL;
    }
    if (problem->partition == RC_HEAT_MATCHED &&
        (h->inverse = rc_heat_inverse_new(h->c, body, h->n, h->node, err)) == NULL)
        return NULL;
    return rc_give(&h);
}

/* ---- temperatures and figures ---- */

/* out = the field of the loaded map, or with `add` out + this field; `out` is not h->work then. */
static void
field(struct rc_heat *h, const struct rc_warming *w, bool add, double *out)
{
    double *to = add ? h->work : out;

    rc_conduction_field(h->c, 1, &w, to);
    for (size_t k = 0; k < h->shape.nx * h->shape.ny && add; k++)
        out[k] += to[k];
}

/* Adds to `out` the rise of body b at the end of time step `last` due to the heat of the steps 0 .. n - 1. */
static void
add_rise(struct rc_heat *h, int b, const struct rc_warming *lag, size_t n, size_t last, double *out)
{
    for (size_t j = 0; j < n; j++) {
        const double *share = h->times.share + j * h->n;
        memset(h->work, 0, h->shape.nx * h->shape.ny * sizeof *h->work);
        for (size_t k = 0; k < h->n; k++)
            h->work[h->node[k]] = b == 0 ? share[k] : h->q[h->node[k]] - share[k];
        rc_conduction_load(h->c, h->work);
        field(h, &lag[last - j], true, out);
    }
}

static double
largest(const size_t *node, size_t n, const double *map)
{
    double most = 0;

    for (size_t k = 0; k < n; k++)
        most = fmax(most, fabs(map[node[k]]));
    return most;
}

/* Nodes in contact in a row through node k along this axis; all n of a row that joins itself. */
static size_t
nodes_along(const struct rc_heat *h, size_t k, enum rc_map_axis axis)
{
    const size_t nx = h->shape.nx, n = axis == RC_Y ? h->shape.ny : nx;
    const size_t at = axis == RC_Y ? k / nx : k % nx, step = axis == RC_Y ? nx : 1;
    const double *row = h->work + (k - at * step);
    const bool wraps = rc_wraps(h->problem.boundary, axis);
    size_t before = 0, after = 0;

    while (before + 1 < n && (wraps || before < at) && row[(at + n - before - 1) % n * step] > 0)
        before++;
    while (before + after + 1 < n && (wraps || at + after + 1 < n) &&
           row[(at + after + 1) % n * step] > 0)
        after++;
    return before + after + 1;
}

/* Nodes in contact in a row through node k, along the faster direction of the body that moves faster. A row
 * that joins itself has no trailing edge; the row along the other axis then counts. */
static size_t
row_of_nodes(struct rc_heat *h, size_t k)
{
    const struct rc_shape *s = &h->shape;
    const struct rc_heated one = heated(h, 0, 0, 0), two = heated(h, 1, 0, 0);
    const bool along_y = fmax(fabs(one.py), fabs(two.py)) > fmax(fabs(one.px), fabs(two.px));
    const enum rc_map_axis axis = along_y ? RC_Y : RC_X;
    size_t count;

    memset(h->work, 0, s->nx * s->ny * sizeof *h->work);
    for (size_t i = 0; i < h->n; i++)
        h->work[h->node[i]] = 1;
    count = nodes_along(h, k, axis);
    return rc_wraps(h->problem.boundary, axis) && count == (along_y ? s->ny : s->nx)
               ? nodes_along(h, k, along_y ? RC_X : RC_Y)
               : count;
}

/* The share of body 1. Between bodies of different bulk temperatures more heat may cross than the contact
 * has; it is then no share. */
static double
share_of(const struct rc_heat_figures *f, double drop)
{
    const double share = f->heat_power != 0 ? f->heat_power_1 / f->heat_power : NAN;

    return drop == 0 || (share >= 0 && share <= 1) ? share : NAN;
}

/* Finds the figures of the temperatures. */
static void
judge(struct rc_heat *h)
{
    const struct rc_shape *s = &h->shape;
    const size_t nodes = s->nx * s->ny;
    struct rc_heat_figures *f = &h->figures;
    double sum[2] = {0, 0}, most = -INFINITY, differs = 0;
    size_t hottest = 0;

    h->scale =
        fmax(fmax(largest(h->node, h->n, h->rise[0]), largest(h->node, h->n, h->rise[1])), DBL_MIN);
    for (size_t i = 0; i < h->n; i++) {
        const size_t k = h->node[i];
        const double one = h->rise[0][k], two = h->rise[1][k] + h->drop;
        sum[0] += one;
        sum[1] += two;
        differs = fmax(differs, fabs(one - two));
        if (fmax(one, two) > most) {
            most = fmax(one, two);
            hottest = k;
        }
    }
    f->max_temperature = most;
    f->max_x = ((double)(hottest % s->nx) - (double)(s->nx - 1) / 2) * s->dx;
    f->max_y = ((double)(hottest / s->nx) - (double)(s->ny - 1) / 2) * s->dy;
    f->mean_temperature = fmax(sum[0], sum[1]) / (double)h->n;
    f->hot_nodes = row_of_nodes(h, hottest);
    f->heat_power_1 = rc_sum(h->flux[0], nodes) * s->dx * s->dy;
    f->share_1 = share_of(&h->figures, h->drop);
    f->mismatch = fmax(h->worst, differs / h->scale);
    f->iterations = h->doubling.iterations + h->earlier + h->space.steps;
    f->convolutions = h->doubling.count + h->c->count;
    f->converged = h->problem.partition != RC_HEAT_MATCHED || f->mismatch <= h->problem.tol;
}

/* Keeps the heat in flux[0] of this time step; finds temperatures and figures at its end. */
static void
finish(struct rc_heat *h)
{
    const size_t nodes = h->shape.nx * h->shape.ny;

    for (size_t k = 0; k < nodes; k++)
        h->flux[1][k] = h->q[k] - h->flux[0][k];
    for (size_t k = 0; k < h->n; k++)
        h->times.share[h->times.at * h->n + k] = h->flux[0][h->node[k]];
    for (int b = 0; b < 2; b++) {
        rc_conduction_load(h->c, h->flux[b]);
        if (h->times.at > 0)
            memcpy(h->rise[b], h->times.past[b], nodes * sizeof *h->rise[b]);
        field(h, h->times.lag[b], h->times.at > 0, h->rise[b]);
    }
    judge(h);
}

/* ---- the iteration ---- */

/* Makes a vector where it is missing. */
static enum rc_status
need_vector(struct rc_store *own, size_t n, double **v, struct rc_err *err)
{
    if (*v == NULL && (*v = rc_store_take(own, n, sizeof **v)) == NULL)
        return rc_err_set(err, "out of memory for %zu nodes in contact", n);
    return RC_OK;
}

static double
product(size_t n, const double *a, const double *b)
{
    struct rc_total sum = {0, 0};

    for (size_t k = 0; k < n; k++)
        rc_total_add(&sum, a[k] * b[k]);
    return rc_total_value(&sum);
}

/* to = (C1 + C2) z at the nodes in contact, z = M v. */
static void
apply(struct rc_heat *h, const double *v, double *z, double *to)
{
    const struct rc_warming *const both[] = {h->times.lag[0], h->times.lag[1]};

    rc_heat_inverse_apply(h->inverse, both, v, z);
    memset(h->work, 0, h->shape.nx * h->shape.ny * sizeof *h->work);
    for (size_t k = 0; k < h->n; k++)
        h->work[h->node[k]] = z[k];
    rc_conduction_load(h->c, h->work);
    rc_conduction_field(h->c, 2, both, h->work);
    for (size_t k = 0; k < h->n; k++)
        to[k] = h->work[h->node[k]];
}

/* Blok's share for heat since the start, and with it a guess of the largest rise in this time step. */
static void
find_blok(struct rc_heat *h)
{
    double most[2], first[2];

    rc_conduction_load(h->c, h->q);
    for (int b = 0; b < 2; b++) {
        field(h, h->times.lag[b], false, h->rise[b]);
        first[b] = largest(h->node, h->n, h->rise[b]);
        for (size_t k = 1; k < h->times.n; k++)
            field(h, &h->times.lag[b][k], true, h->rise[b]);
        most[b] = largest(h->node, h->n, h->rise[b]);
    }
    h->figures.share_blok =
        has_rise(&h->problem, 0) && has_rise(&h->problem, 1) && most[0] + most[1] > 0
            ? most[1] / (most[0] + most[1])
            : NAN;
    h->scale = first[0] + first[1] > 0 ? first[0] * first[1] / (first[0] + first[1]) : 0;
    h->scale = fmax(h->scale, fabs(h->drop) / 2);
}

/* The right side of this time step. */
static enum rc_status
begin(struct rc_heat *h, struct rc_err *err)
{
    const size_t nodes = h->shape.nx * h->shape.ny;
    double size;

    if (h->times.at == 0)
        find_blok(h);
    for (int b = 0; b < 2 && h->times.at > 0; b++) {
        memset(h->times.past[b], 0, nodes * sizeof *h->times.past[b]);
        add_rise(h, b, h->times.lag[b], h->times.at, h->times.at, h->times.past[b]);
    }
    rc_conduction_load(h->c, h->q);
    field(h, h->times.lag[1], false, h->work);
    for (size_t k = 0; k < h->n; k++) {
        const size_t at = h->node[k];
        h->space.right[k] = h->work[at] + h->drop +
                            (h->times.at > 0 ? h->times.past[1][at] - h->times.past[0][at] : 0);
    }
    if (need_vector(&h->own, h->n, &h->space.v[0], err) != RC_OK)
        return RC_FAIL;
    size = h->space.g[0] = sqrt(product(h->n, h->space.right, h->space.right));
    for (size_t k = 0; k < h->n; k++)
        h->space.v[0][k] = size > 0 ? h->space.right[k] / size : 0;
    h->begun = true;
    return RC_OK;
}

/* One vector more: C z = V h by the modified Gram-Schmidt process, and h rotated to a triangle. */
static enum rc_status
extend(struct rc_heat *h, struct rc_err *err)
{
    const size_t m = h->space.steps;
    double *column = h->space.h[m], *next, size, c, s;

    if (need_vector(&h->own, h->n, &h->space.z[m], err) != RC_OK ||
        need_vector(&h->own, h->n, &h->space.v[m + 1], err) != RC_OK)
        return RC_FAIL;
    next = h->space.v[m + 1];
    apply(h, h->space.v[m], h->space.z[m], next);
    for (size_t i = 0; i <= m; i++) {
        column[i] = product(h->n, h->space.v[i], next);
        for (size_t k = 0; k < h->n; k++)
            next[k] -= column[i] * h->space.v[i][k];
    }
    size = column[m + 1] = sqrt(product(h->n, next, next));
    for (size_t k = 0; k < h->n; k++)
        next[k] = size > 0 ? next[k] / size : 0;
    for (size_t i = 0; i < m; i++) {
        const double a = column[i], b = column[i + 1];
        column[i] = h->space.turn[i][0] * a + h->space.turn[i][1] * b;
        column[i + 1] = h->space.turn[i][0] * b - h->space.turn[i][1] * a;
    }
    size = hypot(column[m], column[m + 1]);
    c = h->space.turn[m][0] = size > 0 ? column[m] / size : 1;
    s = h->space.turn[m][1] = size > 0 ? column[m + 1] / size : 0;
    column[m] = size;
    h->space.g[m + 1] = -s * h->space.g[m];
    h->space.g[m] *= c;
    h->space.steps++;
    return RC_OK;
}

/* The largest value of the residual V Q'(0, ..., 0, g). */
static double
largest_residual(const struct space *space, size_t n)
{
    double y[STEPS + 1] = {0}, most = 0;
    const size_t m = space->steps;

    y[m] = space->g[m];
    for (size_t i = m; i-- > 0;) {
        const double a = y[i], b = y[i + 1];
        y[i] = space->turn[i][0] * a - space->turn[i][1] * b;
        y[i + 1] = space->turn[i][1] * a + space->turn[i][0] * b;
    }
    for (size_t k = 0; k < n; k++) {
        double r = 0;
        for (size_t i = 0; i <= m; i++)
            r += y[i] * space->v[i][k];
        most = fmax(most, fabs(r));
    }
    return most;
}

/* f = Z y with the least residual. */
static void
take_solution(const struct space *space, const size_t *node, size_t n, double *flux)
{
    double y[STEPS];

    for (size_t i = space->steps; i-- > 0;) {
        y[i] = space->g[i];
        for (size_t j = i + 1; j < space->steps; j++)
            y[i] -= space->h[j][i] * y[j];
        y[i] = space->h[i][i] != 0 ? y[i] / space->h[i][i] : 0;
    }
    for (size_t k = 0; k < n; k++) {
        double f = 0;
        for (size_t i = 0; i < space->steps; i++)
            f += y[i] * space->z[i][k];
        flux[node[k]] = f;
    }
}

static void
share_heat(struct rc_heat *h)
{
    const enum rc_heat_partition by = h->problem.partition;
    const double share = by == RC_HEAT_BLOK      ? h->figures.share_blok
                         : by == RC_HEAT_CHARRON ? h->figures.share_charron
                                                 : h->problem.share;

    for (size_t k = 0; k < h->n; k++)
        h->flux[0][h->node[k]] = h->q[h->node[k]] != 0 ? share * h->q[h->node[k]] : 0;
}

/* A step of a run with given time steps. */
static enum rc_status
advance(struct rc_heat *h, struct rc_err *err)
{
    bool last;

    if (!h->begun && begin(h, err) != RC_OK)
        return RC_FAIL;
    if (h->problem.partition != RC_HEAT_MATCHED) {
        share_heat(h);
        finish(h);
        return RC_OK;
    }
    if (extend(h, err) != RC_OK)
        return RC_FAIL;
    last = h->space.steps == STEPS ||
           fabs(h->space.g[h->space.steps]) <= 16 * DBL_EPSILON * fabs(h->space.g[0]);
    if (!last && largest_residual(&h->space, h->n) > h->problem.tol * h->scale)
        return RC_MORE;
    take_solution(&h->space, h->node, h->n, h->flux[0]);
    finish(h); /* finds the scale too */
    if (!h->figures.converged && !last)
        return RC_MORE;
    if (h->times.at + 1 == h->times.n)
        return h->figures.converged ? RC_OK : RC_SHORT;
    h->worst = h->figures.mismatch;
    h->earlier += h->space.steps;
    h->space.steps = 0;
    h->times.at++;
    h->begun = false;
    return RC_MORE;
}

/* Takes the temperatures of the finest run into the result. `change`: of the contact, over the largest
 * rise. */
static double
extrapolate(struct rc_heat *h, const struct rc_heat *finest)
{
    struct doubling *d = &h->doubling;
    const size_t nodes = h->shape.nx * h->shape.ny;
    double change = 0;

    for (int b = 0; b < 2; b++) {
        memcpy(h->work, h->rise[b], nodes * sizeof *h->work);
        for (size_t k = 0; k < nodes; k++)
            h->rise[b][k] = 2 * finest->rise[b][k] - d->rise[b][k];
        memcpy(d->rise[b], finest->rise[b], nodes * sizeof *h->work);
        for (size_t i = 0; i < h->n; i++)
            change = fmax(change, fabs(h->rise[b][h->node[i]] - h->work[h->node[i]]));
    }
    for (size_t k = 0; k < nodes; k++) {
        h->flux[0][k] = 2 * finest->flux[0][k] - d->flux[k];
        h->flux[1][k] = h->q[k] - h->flux[0][k];
    }
    memcpy(d->flux, finest->flux[0], nodes * sizeof *d->flux);
    d->count += finest->c->count;
    d->iterations += finest->figures.iterations;
    judge(h);
    return change / h->scale;
}

/* After a run: keeps its result, and begins one with twice the time steps while the error is too large. The
 * changes of the result fall at least by half with each doubling, so that its error is at most the last one;
 * half of the change before guards against a last change that is small by chance. */
static enum rc_status
redouble(struct rc_heat *h, enum rc_status status, struct rc_err *err)
{
    struct doubling *d = &h->doubling;
    struct rc_heat_figures *f = &h->figures;
    struct rc_heat_problem problem = h->problem;
    const size_t nodes = h->shape.nx * h->shape.ny;

    if (d->finest == NULL) {
        for (int b = 0; b < 2; b++)
            memcpy(d->rise[b], h->rise[b], nodes * sizeof *h->rise[b]);
        memcpy(d->flux, h->flux[0], nodes * sizeof *d->flux);
        f->time_error = d->change = NAN;
    } else {
        const double change = extrapolate(h, d->finest);
        f->time_error = isnan(d->change) ? INFINITY : fmax(change, d->change / 2);
        f->mismatch = fmax(f->mismatch, d->finest->figures.mismatch);
        d->change = change;
    }
    f->converged = f->mismatch <= h->asked && f->time_error <= h->asked;
    if (f->converged || (status == RC_SHORT && f->mismatch > h->asked) ||
        (d->finest != NULL && d->finest->times.n == TIMES))
        return f->converged ? RC_OK : RC_SHORT;
    rc_heat_free(d->half);
    d->half = d->finest;
    problem.time_steps = d->half != NULL ? 2 * d->half->times.n : 2;
    memset(h->work, 0, nodes * sizeof *h->work);
    for (size_t i = 0; i < h->n; i++)
        h->work[h->node[i]] = 1;
    d->finest = rc_heat_new(&h->shape, &problem, h->q, h->work, err);
    return d->finest != NULL ? RC_MORE : RC_FAIL;
}

enum rc_status
rc_heat_step(struct rc_heat *h, struct rc_err *err)
{
    struct rc_heat *at = h->doubling.finest != NULL ? h->doubling.finest : h;
    const enum rc_status status = advance(at, err);

    return h->doubling.on && (status == RC_OK || status == RC_SHORT) ? redouble(h, status, err)
                                                                     : status;
}

/* ---- results ---- */

const struct rc_heat_figures *
rc_heat_result(const struct rc_heat *h)
{
    return &h->figures;
}

const double *
rc_heat_flux(const struct rc_heat *h, int body)
{
    return h->flux[body];
}

/* Adds the rise of body b at a depth, times `weight`. */
static enum rc_status
add_rise_at(struct rc_heat *h, int b, double depth, double weight, double *to, struct rc_err *err)
{
    const size_t nodes = h->shape.nx * h->shape.ny;
    RC_ENDS(rc_store_free) struct rc_store own = {0};
    const struct rc_warming *lag = lags_new(h, b, depth, &own, err);
    double *rise = lag == NULL ? NULL : rc_store_zeros(&own, nodes, sizeof *rise);

    if (lag == NULL)
        return RC_FAIL;
    if (rise == NULL)
        return rc_err_set(err, "out of memory for the temperatures of %zu x %zu nodes", h->shape.nx,
                          h->shape.ny);
    add_rise(h, b, lag, h->times.n, h->times.n - 1, rise);
    for (size_t k = 0; k < nodes; k++)
        to[k] += weight * rise[k];
    return RC_OK;
}

enum rc_status
rc_heat_temperature(struct rc_heat *h, int b, double depth, double *to, struct rc_err *err)
{
    const size_t nodes = h->shape.nx * h->shape.ny;
    const struct doubling *d = &h->doubling;
    enum rc_status status = RC_OK;

    if (!(depth >= 0) || isinf(depth))
        return rc_err_set(err, "depth %g m: it must be at least 0", depth);
    if (depth == 0)
        memcpy(to, h->rise[b], nodes * sizeof *to);
    else
        memset(to, 0, nodes * sizeof *to);
    if (depth > 0 && d->finest == NULL)
        status = add_rise_at(h, b, depth, 1, to, err);
    else if (depth > 0 && (status = add_rise_at(d->finest, b, depth, 2, to, err)) == RC_OK)
        status = add_rise_at(d->half != NULL ? d->half : h, b, depth, -1, to, err);
    for (size_t k = 0; k < nodes; k++)
        to[k] += b == 1 ? h->drop : 0;
    return status;
}
