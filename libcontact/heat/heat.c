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
    TIMES = 64,  /* time steps, at most, if the caller gives no number */
    GUESSES = 5  /* parts of a guess, at most */
};
/* Part of the tolerance for the mismatch in each run, if the time steps are doubled until it is met. */
static const double own_part = 0.25;
static const double usual_tol = 1e-3;

/* The temperatures of a body k time steps after the end of a step whose heat is 1 at this end, for the first
 * step, the second one and later ones. Heat is constant in the first step, linear in others. The constant one
 * is that of linear heat at 2/3 of the step, by its temperature at the end of the step. Linear heat goes on
 * from there, so that the second step begins with 3/4 of the first heat and 1/4 of its own. */
struct lags {
    struct rc_warming *first, *second, *later; /* NULL: there is one step */
};

/* Terms of a field, n of them, with room for those of any step. */
struct sum {
    size_t n;
    struct rc_heating *of;
};

/* Time steps; step `at` is being solved. */
struct times {
    size_t n, at;
    struct lags lags[2];
    struct rc_warming
        total;             /* body 2, for heat that has been constant until the end of this step */
    double **share;        /* heat into body 1 at the nodes in contact, at the end of each step  */
    double **waves, *heat; /* the transforms of these, and of the heat; NULL: one run, one step  */
    double *guess;         /* of the heat at the end of this step */
    struct sum sum;
};

/* A part of a guess: a heat of an earlier step, or of a run with half as many. */
struct guess {
    const double *share, *waves;
    double times;
};

/* The iteration at the nodes in contact: C1 z = V h, with V orthonormal, z = M v */
struct space {
    double *right, *v[STEPS + 1], *z[STEPS];
    double h[STEPS][STEPS + 1]; /* column by column; its first rows are rotated to a triangle */
    double turn[STEPS][2], g[STEPS + 1];
    size_t steps; /* of this time step */
};

/* Runs with 1, 2, 4 ... time steps. The errors of runs with linear heat fall at least by half, and nearly 4
 * times where the steps resolve the heat. So the result is (4 T - T')/3, T' with half as many steps; that of
 * two steps is T, because heat of one step is constant. All laws are linear, and hold for it too: no heat is
 * lost, and the temperatures match. */
struct doubling {
    bool on;
    struct rc_heat *finest, *half; /* NULL: this one, in one step */
    double *rise[2], *flux;        /* of the finest run */
    double change;                 /* between the last two runs, over the largest rise */
    double front;                  /* error due to fronts of the last run; 0: unknown */
    double count;                  /* convolutions of earlier runs */
    size_t iterations;             /* of earlier runs */
};

struct rc_heat {
    struct rc_store own;   /* the maps and arrays below */
    struct rc_shape shape; /* of the whole map          */
    struct rc_rows rows;   /* held here                 */
    size_t nodes;          /* of these rows             */
    size_t *deal;          /* the first row of each rank, the number of rows, and as much scratch */
    struct rc_heat_problem problem;
    struct rc_conduction *c;
    struct times times;
    struct rc_heat_inverse *inverse; /* NULL: heat is not matched */
    double drop;                     /* K: bulk temperature of body 2 less that of body 1 */
    double scale;                    /* K: largest rise of a body above its bulk          */
    size_t n, *node;                 /* in contact, of the rows held here                 */
    size_t all;                      /* in contact on the whole map                       */
    double *q, *flux[2], *rise[2];   /* heat and rise above their bulk; heat is 0 out of contact */
    double *work;
    unsigned char *line; /* 1 at the nodes in contact of a row or column, and scratch */
    struct space space;
    size_t earlier; /* steps of all time steps before */
    double worst;   /* largest mismatch of the time steps  */
    bool begun;
    double asked; /* tolerance of the caller */
    struct doubling doubling;
    const struct rc_heat *coarse; /* a finished run with half as many time steps; NULL: none */
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
                              "becomes warmer without end: give the time since heating began",
                              b + 1, p->boundary.x ? 'y' : 'x', p->boundary.x ? 'x' : 'y');
    }
    if (!(p->time >= 0) || isinf(p->time))
        return rc_err_set(err, "time %g s: it must be above 0, or 0 for the steady state", p->time);
    if (!rc_has_mean(p->boundary) && p->time == 0)
        return rc_err_set(err, "a periodic map becomes warmer without end, and has no steady "
                               "temperature: give the time since heating began");
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

/* Keeps the heat, and counts the nodes in contact. */
static enum rc_status
set_heat(struct rc_heat *h, const double *q, const double *contact, struct rc_err *err)
{
    for (size_t k = 0; k < h->nodes; k++) {
        const bool in = contact != NULL ? rc_in_contact(contact[k]) : q[k] != 0;
        if (!isfinite(q[k]) || (q[k] != 0 && !in))
            return rc_err_set(
                err,
                "heat flux %g W/m2 at column %zu, row %zu: it must be finite, and 0 out of "
                "contact",
                q[k], k % h->shape.nx, h->rows.first + k / h->shape.nx);
        h->q[k] = q[k];
        h->n += in;
    }
    return RC_OK;
}

static enum rc_status
set_contact(struct rc_heat *h, const double *q, const double *contact, struct rc_err *err)
{
    const struct rc_ranks *ranks = h->rows.ranks;

    if (rc_ranks_agree(ranks, set_heat(h, q, contact, err), err) != RC_OK)
        return RC_FAIL;
    if ((h->all = rc_ranks_sum(ranks, h->n)) == 0)
        return rc_err_set(err, "no node is in contact, so no heat flows");
    h->node = rc_store_take(&h->own, h->n, sizeof *h->node);
    if (rc_ranks_need(ranks, h->node != NULL, err, "out of memory for %zu nodes in contact",
                      h->n) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0, n = 0; k < h->nodes; k++)
        if (contact != NULL ? rc_in_contact(contact[k]) : q[k] != 0)
            h->node[n++] = k;
    return RC_OK;
}

/* Moves rows of `bytes` from their owners: rank r gets rows to[r] .. to[r + 1] - 1; NULL: all of them. */
static void
move_rows(const struct rc_heat *h, size_t bytes, const size_t *to, const void *v, void *w)
{
    if (h->rows.ranks == NULL)
        memcpy(w, v, h->shape.ny * bytes);
    else
        rc_ranks_move(h->rows.ranks, bytes, h->deal, to, 0, v, w);
}

/* The rows held here of two copies of a map beside each other, along x or along y. */
static void
set_twice(const struct rc_heat *h, const struct rc_shape *two, const double *map, double *twice)
{
    const size_t nx = h->shape.nx, ny = h->shape.ny, unit = rc_rows_unit(two->nx);
    const size_t count = rc_ranks_count(h->rows.ranks), own = rc_ranks_own(h->rows.ranks);
    size_t *to = h->deal + count + 1, n = 0;

    for (size_t copy = 0; copy < two->ny / ny; copy++) {
        for (size_t r = 0; r <= count; r++) {
            const size_t row = rc_rows_dealt(two->ny, unit, count, r);
            to[r] = row < copy * ny ? 0 : row < (copy + 1) * ny ? row - copy * ny : ny;
        }
        n += copy == 0 && two->nx > nx ? to[own + 1] - to[own] : 0; /* room to spread them */
        move_rows(h, nx * sizeof *map, to, map, twice + n * nx);
        n += to[own + 1] - to[own];
    }
    for (size_t j = 0; two->nx > nx && j < n / 2; j++)
        for (size_t k = 0; k < 2; k++)
            memmove(twice + (2 * j + k) * nx, twice + (n / 2 + j) * nx, nx * sizeof *twice);
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
    const size_t nx = h->shape.nx, ny = h->shape.ny;
    const struct rc_shape two = {x ? 2 * nx : nx, x ? ny : 2 * ny, h->shape.dx, h->shape.dy};
    RC_OWNED double *twice = NULL;
    struct rc_patches patches;
    enum rc_status status;

    *band = false;
    if (rc_repeats(h->problem.boundary) != 1)
        return RC_OK;
    twice = rc_alloc(two.nx * rc_rows_of(h->rows.ranks, &two).n, sizeof *twice);
    if (rc_ranks_need(h->rows.ranks, twice != NULL, err,
                      "out of memory for the contact of %zu x %zu nodes", nx, ny) != RC_OK)
        return RC_FAIL;
    set_twice(h, &two, contact, twice);
    status = rc_patches_find(&two, twice, options, &patches, err);
    *band = status == RC_OK && patches.patch[0].area > 1.5 * area;
    rc_patches_free(&patches);
    return status;
}

/* Figures that need no temperature. */
static enum rc_status
set_figures(struct rc_heat *h, const double *contact, struct rc_err *err)
{
    const struct rc_patch_options options = {.boundary = h->problem.boundary,
                                             .largest = 1,
                                             .threads = h->problem.threads,
                                             .ranks = h->rows.ranks};
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
        f->heat_power = rc_ranks_sum_of(h->rows.ranks, h->q, h->nodes) * h->shape.dx * h->shape.dy;
        f->steady_time =
            (band ? pow(patches.contact_area / length_around(h), 2) : patches.contact_area) /
            fmin(body[0].diffusivity, body[1].diffusivity);
        f->share_charron = body[0].conductivity / (body[0].conductivity + body[1].conductivity);
    }
    rc_patches_free(&patches);
    return status;
}

/* The same for heat that grows from 0 to 1 in the step. */
static struct rc_heated
growing(const struct rc_heat *h, int b, double depth, size_t lag)
{
    struct rc_heated body = heated(h, b, depth, lag);

    body.top = body.diffusion * body.diffusion;
    body.slope = 1 / (body.top - body.ended * body.ended);
    return body;
}

/* Part of the heat of the second step in its beginning. */
static const double second_own = 0.25;

/* Adds the temperature of heat that decreases from 1 to 0 in the step before the last k ones. */
static void
add_start(const struct rc_heat *h, struct rc_warming *to, double times, const struct lags *lags,
          size_t k)
{
    rc_warming_add(h->c, to, times, &lags->first[k]);
    rc_warming_add(h->c, to, -times, &lags->later[k]);
}

/* Sets the temperatures of body b at a depth, for each lag, in memory of `own`. They are left 0 for a body
 * that takes no heat and has no steady state. With heat constant in step k back, G, and growing, U, a heat at
 * the end of a step has U of its own step and G - U of the next one. */
static enum rc_status
set_lags(const struct rc_heat *h, int b, double depth, struct lags *lags, struct rc_store *own,
         struct rc_err *err)
{
    const size_t n = h->times.n;

    lags->first = rc_store_zeros(own, n, sizeof *lags->first);
    lags->second = n > 1 ? rc_store_zeros(own, n, sizeof *lags->second) : NULL;
    lags->later = n > 1 ? rc_store_zeros(own, n, sizeof *lags->later) : NULL;
    if (rc_ranks_need(h->rows.ranks, !own->failed, err, "out of memory for %zu time steps", n) !=
        RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < n && has_rise(&h->problem, b); k++) {
        const struct rc_heated body = heated(h, b, depth, k), grows = growing(h, b, depth, k);
        if (rc_warming_set(&lags->first[k], own, h->c, &body, err) != RC_OK ||
            (n > 1 && (rc_warming_set(&lags->later[k], own, h->c, &grows, err) != RC_OK ||
                       rc_warming_new(&lags->second[k], own, h->c, &body, err) != RC_OK)))
            return RC_FAIL;
    }
    for (size_t k = n; n > 1 && k-- > 0 && has_rise(&h->problem, b);) {
        rc_warming_add(h->c, &lags->second[k], second_own, &lags->first[k]);
        rc_warming_add(h->c, &lags->second[k], 1 - second_own, &lags->later[k]);
        if (k > 0) {
            add_start(h, &lags->first[k], 1 - second_own, lags, k - 1);
            add_start(h, &lags->second[k], 1, lags, k - 1);
            add_start(h, &lags->later[k], 1, lags, k - 1);
        }
    }
    return RC_OK;
}

/* Of heat at the end of step k, at the end of the present one. */
static const struct rc_warming *
warming_of(const struct rc_heat *h, const struct lags *lags, size_t k)
{
    return k == 0   ? &lags->first[h->times.at]
           : k == 1 ? &lags->second[h->times.at - 1]
                    : &lags->later[h->times.at - k];
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

/* The usual number of time steps if the tolerance determines it, of 83 contacts. Most need few. On a map that
 * repeats, a body that moves by more than its heat spreads comes back hot, and the share of the heat changes
 * most during the first passes. A contact that is not steady needs 2.2 times as many for each decade of the
 * tolerance. */
static double
usual_steps(const struct rc_shape *shape, const struct rc_heat_problem *p)
{
    const double patch = 0.05; /* area of the largest patch over that of the map */
    const double few = 2, long_time = 3, least_peclet = 0.3;
    const struct {
        double passes, steps;
    } again[] = {{1000, 2}, {5, 4}, {1, 20}}; /* of the map */
    const double steady = patch * (double)(shape->nx * shape->ny) * shape->dx * shape->dy /
                          fmin(p->body[0].diffusivity, p->body[1].diffusivity);
    const double tol = p->tol > 0 ? p->tol : usual_tol;
    double steps = few, peclet = 0, speed = 0; /* peclet: of a node */

    for (int b = 0; b < 2; b++) {
        const double v = hypot(p->body[b].velocity[0], p->body[b].velocity[1]);
        speed = fmax(speed, v);
        peclet = fmax(peclet, v * shape->dx / p->body[b].diffusivity);
    }
    if (rc_repeats(p->boundary) == 2 && peclet > least_peclet) {
        const double passes = speed * p->time / ((double)shape->nx * shape->dx);
        for (size_t k = 0; k < sizeof again / sizeof *again; k++)
            if (passes > again[k].passes) {
                steps = again[k].steps;
                break;
            }
    }
    if (p->time > long_time * steady)
        return steps;
    return fmin(steps * pow(2.2, fmax(log10(usual_tol / tol), 0)), TIMES);
}

/* Adds the work and the memory of n time steps, on a rank; `part`: how probable this run is. Each step has
 * coefficients of its own. */
static void
expect_run(const struct rc_heat_problem *p, size_t n, double nodes, double part,
           struct rc_expected *expected)
{
    static const double bytes[2][2] = RC_HEAT_BYTES, of_step[2] = RC_HEAT_TIME_BYTES;
    const bool matched = p->partition == RC_HEAT_MATCHED;

    expected->convolutions += part * (RC_HEAT_WORK + (matched ? RC_HEAT_STEP : 0) + 2 +
                                      RC_HEAT_TIME_STEP * ((double)n - 1));
    expected->seconds += part * RC_HEAT_STEP_NODE * nodes * 2 * ((double)n - 1);
    expected->memory +=
        (size_t)(nodes *
                 (rc_by_padding(p->boundary, bytes[0][!matched], bytes[1][!matched]) +
                  rc_by_padding(p->boundary, of_step[0], of_step[1]) * ((double)n - 1)) /
                 (double)rc_ranks_count(p->ranks));
}

enum rc_status
rc_heat_expect(const struct rc_shape *shape, const struct rc_heat_problem *p, size_t depths,
               struct rc_expected *expected, struct rc_err *err)
{
    const struct rc_conv_options sum = {.boundary = p->boundary, .threads = p->threads};
    const bool matched = p->partition == RC_HEAT_MATCHED && p->time > 0;
    const bool doubles = matched && p->time_steps == 0;
    const size_t given = matched && !doubles ? p->time_steps : 1;
    const double steps = doubles ? usual_steps(shape, p) : (double)given;
    const double nodes = (double)(shape->nx * shape->ny);
    const double one = rc_conv_seconds(shape, &sum),
                 cores = (double)(p->threads == 0 ? rc_threads_available() : p->threads);

    if (check(shape, p, err) != RC_OK)
        return RC_FAIL;
    *expected = (struct rc_expected){0};
    for (size_t n = given; (double)n < 2 * steps; n *= 2)
        expect_run(p, n, nodes, fmin(2 * steps / (double)n - 1, 1), expected);
    expected->seconds =
        one * expected->convolutions +
        (expected->seconds + (RC_HEAT_NODE + RC_HEAT_DEPTH * (double)depths) * nodes * 2) / cores;
    return RC_OK;
}

/* True if the heats of the steps are needed later. */
static bool
keeps_waves(const struct rc_heat *h)
{
    return h->times.n > 1 || h->doubling.on;
}

static enum rc_status
set_times(struct rc_heat *h, struct rc_err *err)
{
    struct times *t = &h->times;
    const size_t size = keeps_waves(h) ? rc_conduction_size(h->c) : 0;
    struct rc_heated body = heated(h, 1, 0, 0);

    for (int b = 0; b < 2; b++)
        if (set_lags(h, b, 0, &t->lags[b], &h->own, err) != RC_OK)
            return RC_FAIL;
    for (size_t k = 0; k < t->n; k++) {
        t->share[k] = rc_store_take(&h->own, h->n, sizeof(double));
        t->waves[k] = size > 0 ? rc_store_take(&h->own, size, sizeof(double)) : NULL;
    }
    t->sum.of = rc_store_take(&h->own, 2 * t->n + 2 * GUESSES + 2, sizeof *t->sum.of);
    t->heat = size > 0 ? rc_store_take(&h->own, size, sizeof(double)) : NULL;
    if (rc_ranks_need(h->rows.ranks, !h->own.failed, err, "out of memory for %zu time steps",
                      t->n) != RC_OK)
        return RC_FAIL;
    return t->n > 1 && has_rise(&h->problem, 1)
               ? rc_warming_set(&t->total, &h->own, h->c, &body, err)
               : RC_OK;
}

/* The maps of the rows held here; NULL: memory is short on a rank. */
static struct rc_heat *
with_maps(const struct rc_shape *shape, const struct rc_ranks *ranks, struct rc_err *err)
{
    RC_OWN(rc_heat, h) = calloc(1, sizeof *h);
    const size_t count = rc_ranks_count(ranks);

    if (h != NULL) {
        h->shape = *shape;
        h->rows = rc_rows_of(ranks, shape);
        h->nodes = shape->nx * h->rows.n;
        h->q = rc_store_zeros(&h->own, 6 * h->nodes, sizeof *h->q);
        h->deal = rc_store_take(&h->own, 2 * (count + 1), sizeof *h->deal);
        h->line =
            rc_store_take(&h->own, (shape->nx > shape->ny ? shape->nx : shape->ny) + h->rows.n, 1);
    }
    if (rc_ranks_need(ranks, h != NULL && !h->own.failed, err,
                      "out of memory for the heat of %zu x %zu nodes", shape->nx,
                      shape->ny) != RC_OK)
        return NULL;
    for (size_t r = 0; r <= count; r++)
        h->deal[r] = rc_rows_dealt(shape->ny, rc_rows_unit(shape->nx), count, r);
    for (int b = 0; b < 2; b++) {
        h->flux[b] = h->q + (size_t)(1 + b) * h->nodes;
        h->rise[b] = h->q + (size_t)(3 + b) * h->nodes;
    }
    h->work = h->q + 5 * h->nodes;
    return rc_give(&h);
}

struct rc_heat *
rc_heat_new(const struct rc_shape *shape, const struct rc_heat_problem *problem, const double *q,
            const double *contact, struct rc_err *err)
{
    struct rc_heated body[2];
    RC_OWN(rc_heat, h) = NULL;

    if (check(shape, problem, err) != RC_OK || (h = with_maps(shape, problem->ranks, err)) == NULL)
        return NULL;
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
    if (set_contact(h, q, contact, err) != RC_OK)
        return NULL;
    h->space.right = rc_store_take(&h->own, h->n, sizeof *h->space.right);
    h->times.share = rc_store_zeros(&h->own, h->times.n, sizeof *h->times.share);
    h->times.waves = rc_store_zeros(&h->own, h->times.n, sizeof *h->times.waves);
    h->times.guess = rc_store_take(&h->own, h->n, sizeof *h->times.guess);
    for (int b = 0; b < 2 && h->doubling.on; b++)
        h->doubling.rise[b] = rc_store_take(&h->own, h->nodes, sizeof **h->doubling.rise);
    if (h->doubling.on)
        h->doubling.flux = rc_store_take(&h->own, h->nodes, sizeof *h->doubling.flux);
    if (rc_ranks_need(h->rows.ranks, !h->own.failed, err, "out of memory for %zu nodes in contact",
                      h->n) != RC_OK)
        return NULL;
    for (size_t k = 0; k < h->n; k++)
        h->work[h->node[k]] = 1;
    if (set_figures(h, h->work, err) != RC_OK ||
        (h->c = rc_conduction_new(shape, problem->boundary, problem->ranks, problem->threads,
                                  err)) == NULL ||
        set_times(h, err) != RC_OK)
        return NULL;
    for (int b = 0; b < 2; b++)
        body[b] = heated(h, b, 0, 0);
    if (problem->partition == RC_HEAT_MATCHED &&
        (h->inverse = rc_heat_inverse_new(h->c, body, h->n, h->node, err)) == NULL)
        return NULL;
    return rc_give(&h);
}

/* ---- temperatures and figures ---- */

/* out = the field of the loaded map. */
static void
field(struct rc_heat *h, const struct rc_warming *w, double *out)
{
    rc_conduction_field(h->c, 1, &w, out);
}

/* Adds terms of the rise of body b at the end of the present step: those of its heats at the end of steps
 * 0 .. n - 1. `total`: of body 2, see times; NULL: not known. */
static void
rise_of(const struct rc_heat *h, int b, const struct lags *lags, const struct rc_warming *total,
        size_t n, struct sum *to)
{
    for (size_t k = 0; k < n; k++) {
        const struct rc_warming *w = warming_of(h, lags, k);
        to->of[to->n++] = (struct rc_heating){w, h->times.waves[k], b == 0 ? 1 : -1};
        if (b == 1 && total == NULL)
            to->of[to->n++] = (struct rc_heating){w, h->times.heat, 1};
    }
    if (b == 1 && total != NULL)
        to->of[to->n++] = (struct rc_heating){total, h->times.heat, 1};
}

/* The largest absolute value of a map at n nodes; NULL: of n numbers. */
static double
highest(const size_t *node, size_t n, const double *map)
{
    double most = 0;

    for (size_t k = 0; k < n; k++)
        most = fmax(most, fabs(map[node != NULL ? node[k] : k]));
    return most;
}

/* The same at all nodes in contact. */
static double
largest(const struct rc_heat *h, const double *map)
{
    return rc_ranks_most(h->rows.ranks, highest(h->node, h->n, map));
}

/* Marks in h->line the nodes in contact of the row or column, along this axis, through column i of row j. */
static void
set_line(struct rc_heat *h, size_t i, size_t j, enum rc_map_axis axis)
{
    const size_t nx = h->shape.nx, n = axis == RC_Y ? h->rows.n : nx;
    unsigned char *own = axis == RC_Y ? h->line + h->shape.ny : h->line;
    size_t root = 0;

    memset(own, 0, n);
    for (size_t k = 0; k < h->n; k++) {
        const size_t column = h->node[k] % nx, row = h->node[k] / nx;
        if (axis == RC_Y && column == i)
            own[row] = 1;
        if (axis == RC_X && h->rows.first + row == j)
            own[column] = 1;
    }
    while (h->deal[root + 1] <= j)
        root++;
    if (axis == RC_Y)
        move_rows(h, 1, NULL, own, h->line);
    else
        rc_ranks_share(h->rows.ranks, root, nx, h->line);
}

/* Nodes in contact in a row through node k of the whole map along this axis; all n of a row that joins
 * itself. */
static size_t
nodes_along(struct rc_heat *h, size_t k, enum rc_map_axis axis)
{
    const size_t nx = h->shape.nx, n = axis == RC_Y ? h->shape.ny : nx;
    const size_t at = axis == RC_Y ? k / nx : k % nx;
    const bool wraps = rc_wraps(h->problem.boundary, axis);
    size_t before = 0, after = 0;

    set_line(h, k % nx, k / nx, axis);
    while (before + 1 < n && (wraps || before < at) && h->line[(at + n - before - 1) % n])
        before++;
    while (before + after + 1 < n && (wraps || at + after + 1 < n) && h->line[(at + after + 1) % n])
        after++;
    return before + after + 1;
}

/* Nodes in contact in a row through node k of the whole map, along the faster direction of the body that
 * moves faster. A row that joins itself has no trailing edge; the row along the other axis then counts. */
static size_t
row_of_nodes(struct rc_heat *h, size_t k)
{
    const struct rc_shape *s = &h->shape;
    const struct rc_heated one = heated(h, 0, 0, 0), two = heated(h, 1, 0, 0);
    const bool along_y = fmax(fabs(one.py), fabs(two.py)) > fmax(fabs(one.px), fabs(two.px));
    const enum rc_map_axis axis = along_y ? RC_Y : RC_X;
    const size_t count = nodes_along(h, k, axis);

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
    const struct rc_ranks *ranks = h->rows.ranks;
    struct rc_heat_figures *f = &h->figures;
    struct rc_total total[2] = {{0}};
    double most[4] = {highest(h->node, h->n, h->rise[0]), highest(h->node, h->n, h->rise[1])};
    double sum[2], own = -INFINITY;
    size_t hottest = 0;

    for (size_t i = 0; i < h->n; i++) {
        const size_t k = h->node[i];
        const double one = h->rise[0][k], two = h->rise[1][k] + h->drop;
        rc_total_add(&total[0], one);
        rc_total_add(&total[1], two);
        most[2] = fmax(most[2], fabs(one - two));
        if (fmax(one, two) > own) {
            own = fmax(one, two);
            hottest = h->rows.first * s->nx + k;
        }
    }
    most[3] = own;
    rc_ranks_totals(ranks, 2, total, sum, 4, most);
    /* the first of equal nodes */
    hottest = (size_t)-rc_ranks_most(ranks, own == most[3] ? -(double)hottest : -INFINITY);
    h->scale = fmax(fmax(most[0], most[1]), DBL_MIN);
    f->max_temperature = most[3];
    f->max_x = ((double)(hottest % s->nx) - (double)(s->nx - 1) / 2) * s->dx;
    f->max_y = ((double)(hottest / s->nx) - (double)(s->ny - 1) / 2) * s->dy;
    f->mean_temperature = fmax(sum[0], sum[1]) / (double)h->all;
    f->hot_nodes = row_of_nodes(h, hottest);
    f->heat_power_1 = rc_ranks_sum_of(ranks, h->flux[0], h->nodes) * s->dx * s->dy;
    f->share_1 = share_of(&h->figures, h->drop);
    f->mismatch = fmax(h->worst, most[2] / h->scale);
    f->iterations = h->doubling.iterations + h->earlier + h->space.steps;
    f->convolutions = h->doubling.count + h->c->count;
    f->converged = h->problem.partition != RC_HEAT_MATCHED || f->mismatch <= h->problem.tol;
}

/* Rises at the end of a later time step. */
static void
find_rises(struct rc_heat *h)
{
    struct times *t = &h->times;

    for (int b = 0; b < 2; b++) {
        t->sum.n = 0;
        rise_of(h, b, &t->lags[b], &t->total, t->at + 1, &t->sum);
        rc_conduction_sum(h->c, t->sum.n, t->sum.of, h->rise[b]);
    }
}

/* Keeps the heat in flux[0] of this time step; finds temperatures and figures at its end. */
static void
finish(struct rc_heat *h)
{
    for (size_t k = 0; k < h->nodes; k++)
        h->flux[1][k] = h->q[k] - h->flux[0][k];
    for (size_t k = 0; k < h->n; k++)
        h->times.share[h->times.at][k] = h->flux[0][h->node[k]];
    for (int b = 0; b < 2; b++) {
        rc_conduction_load(h->c, h->flux[b]);
        if (b == 0 && h->times.waves[0] != NULL)
            rc_conduction_keep(h->c, h->times.waves[h->times.at]);
        if (h->times.at == 0)
            field(h, h->times.lags[b].first, h->rise[b]);
        else if (b == 1)
            find_rises(h);
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
product(const struct rc_heat *h, const double *a, const double *b)
{
    struct rc_total sum = {0, 0};

    for (size_t k = 0; k < h->n; k++)
        rc_total_add(&sum, a[k] * b[k]);
    return rc_ranks_total(h->rows.ranks, sum);
}

/* to = (C1 + C2) z at the nodes in contact, z = M v. */
static void
apply(struct rc_heat *h, const double *v, double *z, double *to)
{
    const size_t at = h->times.at;
    const struct rc_warming *const both[] = {warming_of(h, &h->times.lags[0], at),
                                             warming_of(h, &h->times.lags[1], at)};

    rc_heat_inverse_apply(h->inverse, both, v, z);
    memset(h->work, 0, h->nodes * sizeof *h->work);
    for (size_t k = 0; k < h->n; k++)
        h->work[h->node[k]] = z[k];
    rc_conduction_load(h->c, h->work);
    rc_conduction_field(h->c, 2, both, h->work);
    for (size_t k = 0; k < h->n; k++)
        to[k] = h->work[h->node[k]];
}

/* The largest rise of body b from all heat since the start, in contact. */
static double
largest_rise(struct rc_heat *h, int b)
{
    struct times *t = &h->times;

    if (t->n == 1) {
        field(h, t->lags[b].first, h->rise[b]);
        return largest(h, h->rise[b]);
    }
    t->sum.n = 0;
    t->at = t->n - 1;
    for (size_t k = 0; k < t->n; k++)
        t->sum.of[t->sum.n++] = (struct rc_heating){warming_of(h, &t->lags[b], k), t->heat, 1};
    t->at = 0;
    rc_conduction_sum(h->c, t->sum.n, t->sum.of, h->rise[b]);
    return largest(h, h->rise[b]);
}

/* Blok's share for heat since the start, and with it a guess of the largest rise in this time step. */
static void
find_blok(struct rc_heat *h)
{
    double most[2], first[2];

    rc_conduction_load(h->c, h->q);
    if (h->times.heat != NULL)
        rc_conduction_keep(h->c, h->times.heat);
    for (int b = 0; b < 2; b++) {
        most[b] = largest_rise(h, b);
        if (h->times.n > 1)
            field(h, h->times.lags[b].first, h->rise[b]);
        first[b] = h->times.n > 1 ? largest(h, h->rise[b]) : most[b];
    }
    h->figures.share_blok =
        has_rise(&h->problem, 0) && has_rise(&h->problem, 1) && most[0] + most[1] > 0
            ? most[1] / (most[0] + most[1])
            : NAN;
    h->scale = first[0] + first[1] > 0 ? first[0] * first[1] / (first[0] + first[1]) : 0;
    h->scale = fmax(h->scale, fabs(h->drop) / 2);
}

/* Adds the heat of the coarse run at the end of this step, linear in its steps. */
static size_t
interpolate(const struct times *t, size_t at, double times, struct guess *to)
{
    const size_t before = at / 2 == 0 ? 0 : at / 2 - 1, after = at / 2;

    if (at % 2 == 1 || after == before) {
        to[0] = (struct guess){t->share[after], t->waves[after], times};
        return 1;
    }
    to[0] = (struct guess){t->share[before], t->waves[before], times / 2};
    to[1] = (struct guess){t->share[after], t->waves[after], times / 2};
    return 2;
}

/* The heat at the end of this step by the coarse run and its error in the last step, or linear from the last
 * two. */
static size_t
find_guess(const struct rc_heat *h, struct guess *to)
{
    const struct times *t = &h->times, *coarse = h->coarse != NULL ? &h->coarse->times : NULL;
    const size_t at = t->at;
    size_t n = 0;

    if (coarse != NULL)
        n += interpolate(coarse, at, 1, to);
    if (at > 0)
        to[n++] =
            (struct guess){t->share[at - 1], t->waves[at - 1], at > 1 && coarse == NULL ? 2 : 1};
    if (at > 0 && coarse != NULL)
        n += interpolate(coarse, at - 1, -1, to + n);
    else if (at > 1)
        to[n++] = (struct guess){t->share[at - 2], t->waves[at - 2], -1};
    return n;
}

/* The difference of the temperatures with the heat of earlier steps and the guess. */
static void
find_right(struct rc_heat *h)
{
    struct times *t = &h->times;
    struct guess guess[GUESSES];
    const size_t guesses = find_guess(h, guess);

    memset(t->guess, 0, h->n * sizeof *t->guess);
    for (size_t i = 0; i < guesses; i++)
        for (size_t k = 0; k < h->n; k++)
            t->guess[k] += guess[i].times * guess[i].share[k];
    if (t->at == 0 && guesses == 0) {
        rc_conduction_load(h->c, h->q);
        field(h, t->lags[1].first, h->work);
        return;
    }
    t->sum.n = 0;
    for (int b = 0; b < 2; b++) {
        const size_t first = t->sum.n;
        rise_of(h, b, &t->lags[b], &t->total, t->at, &t->sum);
        for (size_t k = first; k < t->sum.n && b == 0; k++)
            t->sum.of[k].times = -1;
        for (size_t i = 0; i < guesses; i++)
            t->sum.of[t->sum.n++] = (struct rc_heating){warming_of(h, &t->lags[b], t->at),
                                                        guess[i].waves, -guess[i].times};
    }
    rc_conduction_sum(h->c, t->sum.n, t->sum.of, h->work);
}

/* Moves the rise of body 2 from constant heat to the end of the next step. */
static void
next_total(struct rc_heat *h)
{
    struct times *t = &h->times;
    const struct lags *l = &t->lags[1];

    if (!has_rise(&h->problem, 1))
        return;
    rc_warming_add(h->c, &t->total, 1, &l->first[t->at + 1]);
    rc_warming_add(h->c, &t->total, -1, &l->first[t->at]);
    rc_warming_add(h->c, &t->total, 1, &l->second[t->at]);
    if (t->at == 0)
        return;
    rc_warming_add(h->c, &t->total, -1, &l->second[t->at - 1]);
    rc_warming_add(h->c, &t->total, 1, &l->later[t->at - 1]);
}

/* The right side of this time step. */
static enum rc_status
begin(struct rc_heat *h, struct rc_err *err)
{
    double size;

    if (h->times.at == 0)
        find_blok(h);
    find_right(h);
    for (size_t k = 0; k < h->n; k++)
        h->space.right[k] = h->work[h->node[k]] + h->drop;
    if (rc_ranks_agree(h->rows.ranks, need_vector(&h->own, h->n, &h->space.v[0], err), err) !=
        RC_OK)
        return RC_FAIL;
    size = h->space.g[0] = sqrt(product(h, h->space.right, h->space.right));
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
    enum rc_status status = need_vector(&h->own, h->n, &h->space.z[m], err);

    if (status == RC_OK)
        status = need_vector(&h->own, h->n, &h->space.v[m + 1], err);
    if (rc_ranks_agree(h->rows.ranks, status, err) != RC_OK)
        return RC_FAIL;
    next = h->space.v[m + 1];
    apply(h, h->space.v[m], h->space.z[m], next);
    for (size_t i = 0; i <= m; i++) {
        column[i] = product(h, h->space.v[i], next);
        for (size_t k = 0; k < h->n; k++)
            next[k] -= column[i] * h->space.v[i][k];
    }
    size = column[m + 1] = sqrt(product(h, next, next));
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
largest_residual(const struct rc_heat *h)
{
    const struct space *space = &h->space;
    double y[STEPS + 1] = {0}, most = 0;
    const size_t m = space->steps;

    y[m] = space->g[m];
    for (size_t i = m; i-- > 0;) {
        const double a = y[i], b = y[i + 1];
        y[i] = space->turn[i][0] * a - space->turn[i][1] * b;
        y[i + 1] = space->turn[i][1] * a + space->turn[i][0] * b;
    }
    for (size_t k = 0; k < h->n; k++) {
        double r = 0;
        for (size_t i = 0; i <= m; i++)
            r += y[i] * space->v[i][k];
        most = fmax(most, fabs(r));
    }
    return rc_ranks_most(h->rows.ranks, most);
}

/* f = guess + Z y with the least residual. */
static void
take_solution(const struct space *space, const size_t *node, size_t n, const double *guess,
              double *flux)
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
        flux[node[k]] = guess[k] + f;
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

/* Ends a time step before the last one, whose temperatures nobody needs. */
static void
end_step(struct rc_heat *h, double residual)
{
    struct times *t = &h->times;

    for (size_t k = 0; k < h->n; k++)
        t->share[t->at][k] = h->flux[0][h->node[k]];
    rc_conduction_load(h->c, h->flux[0]);
    rc_conduction_keep(h->c, t->waves[t->at]);
    h->worst = fmax(h->worst, residual / h->scale);
}

/* A step of a run with given time steps. */
static enum rc_status
advance(struct rc_heat *h, struct rc_err *err)
{
    struct times *t = &h->times;
    const bool final = t->at + 1 == t->n;
    double residual = INFINITY;
    bool begins = !h->begun, last;

    if (begins && begin(h, err) != RC_OK)
        return RC_FAIL;
    if (h->problem.partition != RC_HEAT_MATCHED) {
        share_heat(h);
        finish(h);
        return RC_OK;
    }
    if (begins && t->n > 1 &&
        (residual = rc_ranks_most(h->rows.ranks, highest(NULL, h->n, h->space.right))) <=
            h->problem.tol * h->scale)
        last = false;
    else if (extend(h, err) != RC_OK)
        return RC_FAIL;
    last = h->space.steps == STEPS ||
           fabs(h->space.g[h->space.steps]) <= 16 * DBL_EPSILON * fabs(h->space.g[0]);
    if (h->space.steps > 0)
        residual = largest_residual(h);
    if (!last && residual > h->problem.tol * h->scale)
        return RC_MORE;
    take_solution(&h->space, h->node, h->n, t->guess, h->flux[0]);
    if (final || t->at == 0)
        finish(h); /* finds the scale too */
    else
        end_step(h, residual);
    if ((final || t->at == 0) && !h->figures.converged && !last)
        return RC_MORE;
    if (final)
        return h->figures.converged ? RC_OK : RC_SHORT;
    h->worst = fmax(h->worst, t->at == 0 ? h->figures.mismatch : 0);
    h->earlier += h->space.steps;
    h->space.steps = 0;
    next_total(h);
    t->at++;
    h->begun = false;
    return RC_MORE;
}

/* Part of the change between two runs that the result takes on. */
static double
beyond(const struct rc_heat *finest)
{
    return finest->times.n > 2 ? 1.0 / 3 : 0;
}

/* Takes the temperatures of the finest run into the result, and returns their change since the run before it,
 * in contact, over the largest rise. */
static double
extrapolate(struct rc_heat *h, const struct rc_heat *finest)
{
    struct doubling *d = &h->doubling;
    const size_t nodes = h->nodes;
    const double more = beyond(finest);
    double change = 0;

    for (int b = 0; b < 2; b++) {
        for (size_t i = 0; i < h->n; i++)
            change = fmax(change, fabs(finest->rise[b][h->node[i]] - d->rise[b][h->node[i]]));
        for (size_t k = 0; k < nodes; k++)
            h->rise[b][k] = finest->rise[b][k] + more * (finest->rise[b][k] - d->rise[b][k]);
        memcpy(d->rise[b], finest->rise[b], nodes * sizeof *h->work);
    }
    for (size_t k = 0; k < nodes; k++) {
        h->flux[0][k] = finest->flux[0][k] + more * (finest->flux[0][k] - d->flux[k]);
        h->flux[1][k] = h->q[k] - h->flux[0][k];
    }
    memcpy(d->flux, finest->flux[0], nodes * sizeof *d->flux);
    d->count += finest->c->count;
    d->iterations += finest->figures.iterations;
    judge(h);
    return rc_ranks_most(h->rows.ranks, change) / h->scale;
}

/* True if body b moves so far in one of n time steps that they do not resolve how the front of its first heat
 * passes: by more than twice the width of the front, or by a quarter of a map that repeats. A front that is
 * wider than this map has gone. */
static bool
passes_front(const struct rc_heat *h, int b, size_t n)
{
    const struct rc_heat_problem *p = &h->problem;
    const struct rc_heated body = heated(h, b, 0, 0);
    const size_t nodes[2] = {h->shape.nx, h->shape.ny};
    const double side[2] = {h->shape.dx, h->shape.dy}, moves[2] = {body.px, body.py};
    bool passes = false;

    for (int k = 0; k < 2; k++) {
        const bool repeats = k == 0 ? p->boundary.x : p->boundary.y;
        const double way = fabs(moves[k]) * 2 * p->body[b].diffusivity * p->time / (double)n;
        const double width = 2 * fmax(body.diffusion, side[k]);
        const double length = repeats ? (double)nodes[k] * side[k] : INFINITY;
        passes = passes || (body.diffusion < length && way > fmin(width, length / 4));
    }
    return passes;
}

/* The largest rise of body b from all heat within the last of n time steps, less the rise that is linear in
 * it, over the largest rise. */
static enum rc_status
find_ripple(struct rc_heat *h, int b, size_t n, double *ripple, struct rc_err *err)
{
    static const double golden[2] = {0.381966011250105, 0.618033988749895};
    const double step = h->problem.time / (double)n;

    *ripple = 0;
    rc_conduction_load(h->c, h->q);
    for (int k = 0; k < 2; k++) {
        RC_ENDS(rc_store_free) struct rc_store own = {0};
        const double at[3] = {golden[k], 1, 0}, times[3] = {1, -golden[k], golden[k] - 1};
        struct rc_warming sum, one;
        for (int m = 0; m < 3; m++) {
            struct rc_heated body = heated(h, b, 0, 0);
            body.diffusion *= sqrt(fmax(0, 1 - at[m] * step / h->problem.time));
            if (body.diffusion > 0 &&
                rc_warming_set(m == 0 ? &sum : &one, &own, h->c, &body, err) != RC_OK)
                return RC_FAIL;
            if (m > 0 && body.diffusion > 0)
                rc_warming_add(h->c, &sum, times[m], &one);
        }
        field(h, &sum, h->work);
        *ripple = fmax(*ripple, largest(h, h->work) / h->scale);
    }
    return RC_OK;
}

/* The error due to fronts that n time steps do not resolve. All runs miss them alike, so that their
 * difference does not tell. The rise that the heat of a contact causes in one body divides as e, its
 * conductivity over the root of its diffusivity, of the other one. */
static enum rc_status
find_front(struct rc_heat *h, size_t n, double *error, struct rc_err *err)
{
    double e[2], ripple;

    *error = 0;
    for (int b = 0; b < 2; b++)
        e[b] = h->problem.body[b].conductivity / sqrt(h->problem.body[b].diffusivity);
    for (int b = 0; b < 2; b++)
        if (passes_front(h, b, n)) {
            if (find_ripple(h, b, n, &ripple, err) != RC_OK)
                return RC_FAIL;
            *error += e[b] / (e[0] + e[1]) * ripple;
        }
    return RC_OK;
}

/* True if no number of time steps resolves a front. */
static bool
never_resolved(const struct rc_heat *h)
{
    return passes_front(h, 0, TIMES) || passes_front(h, 1, TIMES);
}

/* Begins a run with twice the time steps. */
static enum rc_status
refine(struct rc_heat *h, struct rc_err *err)
{
    struct doubling *d = &h->doubling;
    struct rc_heat_problem problem = h->problem;

    rc_heat_free(d->half);
    d->half = d->finest;
    problem.time_steps = d->half != NULL ? 2 * d->half->times.n : 2;
    memset(h->work, 0, h->nodes * sizeof *h->work);
    for (size_t i = 0; i < h->n; i++)
        h->work[h->node[i]] = 1;
    d->finest = rc_heat_new(&h->shape, &problem, h->q, h->work, err);
    if (d->finest == NULL)
        return RC_FAIL;
    d->finest->coarse = d->half != NULL ? d->half : h;
    return RC_MORE;
}

/* The error of the result from the changes of the last two doublings, without fronts. With errors that fall
 * r times with each doubling, that of the finest run is its change over r - 1, of which the result takes 1/3.
 * r is that of the two changes, at least `least_fall`, from 8 steps on. The first change is one from constant
 * to linear heat, where errors fall at least 2.25 times. A part of the change before guards against a last
 * change that is small by chance. */
static double
time_error(size_t n, double change, double former)
{
    const double of_two = 0.8, least_fall = 1.5, of_last = 0.75,
                 of_former = n == 4 ? 1.0 / 6 : 1.0 / 8;
    double part = of_last;

    if (n == 2)
        return of_two * change;
    if (n > 4 && change > 0)
        part = fmax(part, 1 / (fmax(least_fall, former / change) - 1) - 1.0 / 3);
    return fmax(part * change, of_former * former);
}

/* After a run: keeps its result, and begins one with twice the time steps while the error is too large. */
static enum rc_status
redouble(struct rc_heat *h, enum rc_status status, struct rc_err *err)
{
    struct doubling *d = &h->doubling;
    struct rc_heat_figures *f = &h->figures;
    const size_t nodes = h->nodes;
    double front = 0;

    if (d->finest == NULL) {
        for (int b = 0; b < 2; b++)
            memcpy(d->rise[b], h->rise[b], nodes * sizeof *h->rise[b]);
        memcpy(d->flux, h->flux[0], nodes * sizeof *d->flux);
        f->time_error = INFINITY;
    } else {
        const size_t n = d->finest->times.n;
        const double change = extrapolate(h, d->finest);
        f->time_error = time_error(n, change, d->change);
        f->mismatch = fmax(f->mismatch, d->finest->figures.mismatch);
        d->change = change;
        if ((f->time_error <= h->asked || n == TIMES) && find_front(h, n, &front, err) != RC_OK)
            return RC_FAIL;
    }
    f->convolutions = d->count + h->c->count;
    f->converged = f->mismatch <= h->asked && fmax(f->time_error, front) <= h->asked;
    if (f->converged || (status == RC_SHORT && f->mismatch > h->asked) ||
        (d->finest != NULL && (d->finest->times.n == TIMES ||
                               (d->front > 0 && front > d->front / 2 && never_resolved(h))))) {
        f->time_error = fmax(f->time_error, front);
        return f->converged ? RC_OK : RC_SHORT;
    }
    d->front = front;
    return refine(h, err);
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
    RC_ENDS(rc_store_free) struct rc_store own = {0};
    struct lags lags;
    double *rise;

    if (set_lags(h, b, depth, &lags, &own, err) != RC_OK)
        return RC_FAIL;
    rise = rc_store_zeros(&own, h->nodes, sizeof *rise);
    if (rc_ranks_need(h->rows.ranks, rise != NULL, err,
                      "out of memory for the temperatures of %zu x %zu nodes", h->shape.nx,
                      h->shape.ny) != RC_OK)
        return RC_FAIL;
    if (h->times.waves[0] != NULL) {
        h->times.sum.n = 0;
        rise_of(h, b, &lags, NULL, h->times.n, &h->times.sum);
        rc_conduction_sum(h->c, h->times.sum.n, h->times.sum.of, rise);
    } else {
        rc_conduction_load(h->c, h->flux[b]);
        field(h, lags.first, rise);
    }
    for (size_t k = 0; k < h->nodes; k++)
        to[k] += weight * rise[k];
    return RC_OK;
}

enum rc_status
rc_heat_temperature(struct rc_heat *h, int b, double depth, double *to, struct rc_err *err)
{
    const size_t nodes = h->nodes;
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
    else if (depth > 0 &&
             (status = add_rise_at(d->finest, b, depth, 1 + beyond(d->finest), to, err)) == RC_OK &&
             d->half != NULL)
        status = add_rise_at(d->half, b, depth, -beyond(d->finest), to, err);
    for (size_t k = 0; k < nodes; k++)
        to[k] += b == 1 ? h->drop : 0;
    return status;
}
