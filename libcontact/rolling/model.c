/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The model of rolling: Coulomb's friction in a contact that rolls with creepage (steady.h). The pressure
 * is that of an inner model, or is known. Tractions do not change it. Each point is a steady state, or
 * the next step of a path.
 *
 * The iteration of a steady state starts on coarser grids. Each has every second node of the next finer
 * one, the last column included, and the same load. A node of the finer grid starts from the q/g of a
 * node beside it. The difference of the two finest grids tells the error of the spacing, which is of
 * first order.
 *
 * Ranks own rows of each grid. Those of a coarser grid belong to other ranks than the same places of the
 * finer one: the pressure moves to them, and q/g of the rows beside those of the finer grid is fetched back.
 *
 * On each grid the motion over the step from a node to the next one is that in the middle of the step.
 *
 * A path begins with the bodies pressed together without friction. Each step moves tractions with the
 * material. Those of nodes that leave the contact are replaced by others with the same displacements. Such a
 * sweeping does not increase the sum of |q|, so that an error of a step stays as large as it was, at most,
 * until the contact has rolled over its own length. It is then forgotten (remembered()). The tolerance of a
 * step is its share of the tolerance, if all steps that are not forgotten have the same error.
 */
#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/expected.h"
#include "libcontact/memory.h"
#include "libcontact/friction/friction.h"
#include "steady.h"

enum stage {
    REST,
    PRESSING, /* the inner model steps            */
    ROLLING,  /* a grid is solved                 */
    THERE     /* all grids are solved             */
};
enum {
    LEVELS = 12,
    AGES = 10,
    /* Nodes of a contact along x that a coarser grid pays for. Half takes 3 % fewer convolutions, each
     * run between 0.8 and 1.3 times as many; double takes 1 % more (22 runs of bench/constants.py). */
    RUN = 16
};
/* Of a steady state, of a path: errors of a path add up over its steps, and 1e-2 is the error of usual
 * coefficients of friction. */
static const double usual_tol[] = {1e-3, 1e-2};
/* Of the tolerance: for the first point of a path, and for all errors, because a change of the tractions
 * changes their relative size. */
static const double of_first = 0.25, most_used = 0.75;
/* Most, of grids that give a start. Not sensitive: half and double change the convolutions by less than
 * 1 % (30 runs of bench/constants.py). */
static const double coarse_tol = 3e-2;
/* Least, of the grid that tells the error of the spacing. Half changes no bit, double takes up to 2 %
 * fewer convolutions (30 runs of bench/constants.py). */
static const double told_tol = 1e-3;
/* From the contact to the map: beyond it a part of a column is lost to rounding. */
static const double most_columns = 1e9;
/* Of a creepage or spin, far below overflow in single precision (3e38). */
static const double most_motion = 1e30;
/* Of the difference between the two finest grids: an error of first order in the spacing is once this
 * difference. Nothing else depends on it; tests/rolling/law_rolling.c compares it with true
 * errors. */
static const double caution = 1.5;

/* A grid, the finest first. */
struct level {
    struct rc_steady *d;
    double unit, length; /* m/Pa; m: length of a step         */
    double x, y;         /* m: first node, from the middle of the contact */
    double period[2];    /* m; 0: the map does not repeat                 */
};

/* Errors of the tractions of the steps of a path, in N, the latest ones first, and the lengths of the contact
 * over which it has rolled since then. Errors of steps within 1/8 of a length are added up, as if all were as
 * young as the last one. */
struct errors {
    double size[AGES], age[AGES];
    double span;      /* age of the oldest error in size[0] */
    double tractions; /* N: their sum after the last step   */
};

struct rolling {
    struct rc_model base;
    struct rc_rolling_problem problem;
    struct rc_shear shear;
    size_t n, stage, level, levels; /* n: nodes held here */
    struct level at[LEVELS];
    double *p;
    double *touched; /* of a column: 1 with a load, else 0          */
    size_t *dealt;   /* on ranks: rows of two grids, for each rank  */
    double pressure_error, inner_convolutions, convolutions; /* convolutions: until the last go */
    struct rc_rolling_figures coarse;                        /* of the second finest grid        */
    double coarse_error;                                     /* N: of the iteration on this grid */
    bool good;                                               /* the contact has converged */
    /* of a path */
    bool rolls;           /* there is a step before this point                              */
    double dissipates;    /* factor of the friction energy of nodes that slip */
    double x;             /* m: middle of the map at the last point kept                    */
    double length;        /* m, of this step                                                */
    double rolled;        /* the same in lengths of the contact                             */
    double own;           /* error of this step, relative to its tractions                  */
    struct errors errors; /* those of the earlier steps                                  */
    bool again;           /* a state was read: its contact must be solved again */
    bool resumes;         /* and the finest grid starts from its tractions */
    struct rc_rolling_figures f;
};

const struct rc_figure rc_figures_rolling[] = {
#define FIGURE(member) RC_FIGURE(struct rc_rolling_figures, member)
#define AS(column, member) RC_FIGURE_AS(column, struct rc_rolling_figures, member)
    {FIGURE(load), "N", "Load", .says = "sum of the pressure"},
    {FIGURE(limit), "N", "Largest tangential force", .says = "that friction carries"},
    {AS("creep_x", creep[0]), NULL, "Creepage along x", .says = "of body 2 over body 1"},
    {AS("creep_y", creep[1]), NULL, "Creepage along y", .says = "of body 2 over body 1"},
    {FIGURE(spin), "rad/m", "Spin", .says = "of body 2 over body 1"},
    {AS("tangential_x", force[0]), "N", "Force along x", .says = "of body 2 on body 1"},
    {AS("tangential_y", force[1]), "N", "Force along y", .says = "of body 2 on body 1"},
    {FIGURE(moment), "Nm", "Moment about the middle of the contact"},
    {FIGURE(stick_nodes), NULL, "Nodes that stick"},
    {FIGURE(slip_nodes), NULL, "Nodes that slip"},
    {FIGURE(stick_fraction), NULL, "Part of the contact that sticks"},
    {FIGURE(power), "J/m", "Energy per length rolled",
     .says = "force times creepage, moment times spin"},
    {FIGURE(power_slip), "J/m", "Friction energy per length rolled",
     .says = "sum of the frame dissipation: mean traction of a step times slip"},
    {AS("extrapolated_creep_x", extrapolated_creep[0]), NULL, "Creepage along x, extrapolated",
     .says = "to a spacing of 0"},
    {AS("extrapolated_creep_y", extrapolated_creep[1]), NULL, "Creepage along y, extrapolated",
     .says = "to a spacing of 0"},
    {AS("extrapolated_tangential_x", extrapolated_force[0]), "N", "Force along x, extrapolated",
     .says = "to a spacing of 0"},
    {AS("extrapolated_tangential_y", extrapolated_force[1]), "N", "Force along y, extrapolated",
     .says = "to a spacing of 0"},
    {FIGURE(extrapolated_moment), "Nm", "Moment, extrapolated", .says = "to a spacing of 0"},
    {AS("ellipse_x", ellipse[0]), "m", "Semi-axis along x",
     .says = "of the ellipse with the same area and axes"},
    {AS("ellipse_y", ellipse[1]), "m", "Semi-axis along y",
     .says = "of the ellipse with the same area and axes"},
    {AS("kalker_c11", kalker[0]), NULL, "Kalker's C11",
     .says = "force along x per creepage along x"},
    {AS("kalker_c22", kalker[1]), NULL, "Kalker's C22",
     .says = "force along y per creepage along y"},
    {AS("kalker_c23", kalker[2]), NULL, "Kalker's C23", .says = "force along y per spin"},
    {AS("kalker_tangential_x", kalker_force[0]), "N", "Force along x in linear theory (Kalker)",
     .says = "of the ellipse with the same area and axes"},
    {AS("kalker_tangential_y", kalker_force[1]), "N", "Force along y in linear theory (Kalker)",
     .says = "of the ellipse with the same area and axes"},
    {AS("fastsim_tangential_x", fastsim_force[0]), "N", "Force along x by FASTSIM",
     .says = "of the ellipse with the same area and axes"},
    {AS("fastsim_tangential_y", fastsim_force[1]), "N", "Force along y by FASTSIM",
     .says = "of the ellipse with the same area and axes"},
    {FIGURE(steps), NULL, "Steps", .role = RC_FIGURE_COST,
     .says = "of Newton's method, on all grids"},
    {FIGURE(fallbacks), NULL, "Steps in time", .role = RC_FIGURE_COST,
     .says = "where no Newton step helped"},
    {FIGURE(convolutions), NULL, "Convolutions", .role = RC_FIGURE_COST,
     .says = "with those of the contact, in equivalents of one on the finest grid"},
    {AS("traction_error_estimate", traction_error), NULL, "Error of the tractions",
     .says = "estimated relative L1 error", .role = RC_FIGURE_ERROR, .by = "tol",
     .of = "traction-x"},
    {AS("discretization_error_estimate", discretization_error), NULL, "Error of the grid",
     .role = RC_FIGURE_ERROR, .by = "grid", .of = "tangential_x",
     .says = "estimated relative error of the force, or of the creepage if the force is given",
     .limit = 0.05, .warning = "the nodes are too far apart for this contact"},
    {FIGURE(converged), NULL, "Converged",
     .says = "traction_error_estimate is within the tolerance"},
    {0},
};
static const struct rc_figure_set sets[] = {{rc_figures_rolling, offsetof(struct rolling, f)},
                                            {NULL, 0}};

static const struct rc_frame_kind frames[] = {
    RC_SLIP_FRAME_KINDS("1", " per length rolled"),
    [RC_SLIP_DISSIPATION] = {"dissipation", "J/m3", "Dissipated energy per length rolled"},
    [RC_SLIP_LENGTH] = {"slip", "1", "Path of slip per length rolled"},
    {NULL, NULL, NULL}};

/* ---- the motion ---- */

/* Creepage in the units of a grid: the motion of a step. */
static double
step_of(const struct level *l)
{
    return l->length / l->unit;
}

static double
spin_of(const struct rolling *f)
{
    return rc_point_has(&f->base.to, RC_SPIN) ? f->base.to.at[RC_SPIN] : 0;
}

/* m: a point `ahead` of node k, from the middle of the contact. A map that repeats has a contact in each
 * period; the point belongs to the nearest one. */
static void
from_middle(const struct level *l, size_t k, double ahead, double at[2])
{
    const struct rc_shape *s = &l->d->shape;

    at[0] = l->x + (double)(k % s->nx) * s->dx + ahead;
    at[1] = l->y + (double)(l->d->t->rows.first + k / s->nx) * s->dy;
    for (int c = 0; c < 2; c++)
        if (l->period[c] > 0)
            at[c] -= l->period[c] * round(at[c] / l->period[c]);
}

/* The motion of body 2 over body 1 due to the spin, per length rolled, after node k. */
static void
spin_at(const struct level *l, double spin, size_t k, double v[2])
{
    double at[2];

    from_middle(l, k, 0.5 * l->length, at);
    v[0] = -spin * at[1];
    v[1] = spin * at[0];
}

/* True if the contact, in a step of this length, reaches the line between two periods from both sides, or
 * crosses it. Distances from the middle jump there. */
static bool
spans_period(const struct level *l, double length)
{
    const double size[2] = {l->d->shape.dx + length, l->d->shape.dy};
    double reaches[2][2] = {{0}}; /* by axes: from below, from above */

    if (!(l->period[0] + l->period[1] > 0))
        return false;
    for (size_t k = 0; k < l->d->n; k++) {
        double at[2];
        if (!(l->d->g[k] > 0))
            continue;
        from_middle(l, k, 0.5 * length, at);
        for (int c = 0; c < 2; c++) {
            const double end = 0.5 * (l->period[c] - size[c]), near = 1e-9 * l->period[c];
            if (l->period[c] > 0 && (at[c] < near - end || at[c] > end + near))
                reaches[c][0] = 1;
            if (l->period[c] > 0 && (at[c] > end - near || at[c] < -end - near))
                reaches[c][1] = 1;
        }
    }
    rc_ranks_each_most(l->d->t->rows.ranks, 4, reaches[0]);
    return reaches[0][0] * reaches[0][1] + reaches[1][0] * reaches[1][1] > 0;
}

/* ---- errors along a path ---- */

/* The most that is left of an error at an age. Dense solutions where all nodes stick, of 9 to 150 nodes along
 * a line and of circles with 9 and 13 nodes across, nu 0 to .5: the largest sum of |q| that is left of a
 * unit error is 1.00 below 1 length (1.04 if the force is given), .76 at 1.08, .46 at 1.4, .21 at 2, and .054
 * at 3.1. */
static const double at_length = 0.85, forgets = 1.3;

static double
left_of(double age)
{
    return age < 1 ? 1 : at_length * exp(forgets * (1 - age));
}

/* N: what is left of the earlier errors after a further step. */
static double
remembered(const struct errors *e, double rolled)
{
    double sum = 0;

    for (size_t k = 0; k < AGES; k++)
        sum += e->size[k] * left_of(e->age[k] + rolled);
    return sum;
}

/* Adds the error of a step, and the sum of its tractions. */
static void
remember(struct errors *e, double rolled, double error, double tractions)
{
    const size_t last = AGES - 1;

    for (size_t k = 0; k < AGES; k++)
        e->age[k] += rolled;
    e->span += rolled;
    if (e->span >= 1.0 / (AGES - 2)) {
        if (e->size[last] > 0)
            e->size[last - 1] += e->size[last] * left_of(e->age[last]) / left_of(e->age[last - 1]);
        memmove(e->size + 1, e->size, last * sizeof *e->size);
        memmove(e->age + 1, e->age, last * sizeof *e->age);
        e->size[0] = e->span = 0;
    }
    e->size[0] += error;
    e->age[0] = 0;
    e->tractions = tractions;
}

/* The part of the tolerance for the next step: twice its share, if all steps that are remembered have the
 * same error, of what the earlier ones have left. */
static double
share_of(const struct errors *e, double rolled, double tol)
{
    const double step = fmax(rolled, 1e-3), whole = ceil(1 / step),
                 steps = whole + left_of(fmax(whole * step, 1)) / (1 - exp(-forgets * step)),
                 used = remembered(e, rolled) / fmax(e->tractions * tol, DBL_MIN);

    return fmax(fmin(2 / steps, 0.8) * (most_used - used), 1 / (8 * steps));
}

/* ---- grids ---- */

/* The next coarser grid. Where the map repeats its period stays: an odd number of rows is kept. */
static struct rc_shape
coarser(const struct rc_shape *s, struct rc_boundary boundary)
{
    struct rc_shape to = rc_shape_coarser(s);

    if (boundary.y && s->ny % 2 == 1) {
        to.ny = s->ny;
        to.dy = s->dy;
    }
    return to;
}

/* The node of the finer grid, of n nodes, in the place of the first one of the coarser grid, of m. */
static size_t
first_of(size_t n, size_t m)
{
    return n > m ? (n - 1) % 2 : 0;
}

/* The same for node k of the coarser grid. */
static size_t
place_of(size_t k, size_t n, size_t m)
{
    return n > m ? 2 * k + first_of(n, m) : k;
}

/* The node of the coarser grid beside node k of the finer one: at most there, or `up` it. */
static size_t
beside(size_t k, size_t up, size_t n, size_t m)
{
    const size_t first = first_of(n, m), at = n > m ? (k + first + up) / 2 - first : k;

    return at < m ? at : 0;
}

/* The rows of the coarser grid, of m, in the places of the first k rows of the finer one, of n. */
static size_t
rows_within(size_t k, size_t n, size_t m)
{
    const size_t first = first_of(n, m);

    return n == m ? k : k > first ? (k - first + 1) / 2 : 0;
}

/* The first row of rank r. */
static size_t
dealt(const struct rc_shape *s, const struct rc_ranks *ranks, size_t r)
{
    return rc_rows_dealt(s->ny, rc_rows_unit(s->nx), rc_ranks_count(ranks), r);
}

/* m: the middle of the map, as the position of the contact is counted. */
static double
middle_of(const struct rolling *f)
{
    return f->problem.known != NULL ? f->problem.known->x : 0;
}

/* Makes grid l where it is missing, in units in which a cell has the area 1. */
static enum rc_status
make_level(struct rolling *f, size_t l, struct rc_err *err)
{
    const struct rc_friction_law *o = &f->problem.law;
    const struct rc_shear inside = {1, f->shear.kap, o->uncoupled ? 0 : f->shear.beta};
    struct rc_shape shape = f->base.shape;
    struct rc_boundary boundary = o->boundary;
    struct level *at = &f->at[l];

    at->x = middle_of(f) - f->base.to.at[RC_POSITION] - (double)(shape.nx - 1) / 2 * shape.dx;
    at->y = -(double)(shape.ny - 1) / 2 * shape.dy;
    if (!(fabs(at->x) <= most_columns * shape.dx))
        return rc_err_set(err,
                          "position %g m is %g m from the map, more than %g columns: measure "
                          "positions from the middle of the map",
                          f->base.to.at[RC_POSITION], fabs(at->x), most_columns);
    for (size_t k = 0; k < l; k++) {
        const struct rc_shape next = coarser(&shape, o->boundary);
        at->x += (double)first_of(shape.nx, next.nx) * shape.dx;
        at->y += (double)first_of(shape.ny, next.ny) * shape.dy;
        shape = next;
    }
    at->period[0] = o->boundary.x ? (double)shape.nx * shape.dx : 0;
    at->period[1] = o->boundary.y ? (double)shape.ny * shape.dy : 0;
    at->unit = sqrt(shape.dx) * sqrt(shape.dy) / f->shear.estar;
    at->length = f->problem.path ? f->length : shape.dx;
    if (at->d != NULL)
        return RC_OK;
    boundary.datum *=
        f->problem.path ? 1 / (sqrt(shape.dx) * sqrt(shape.dy)) : 0; /* (1 - S) 1 = 0 */
    at->d = rc_steady_new(f->base.rows.ranks,
                          &(struct rc_shape){shape.nx, shape.ny, sqrt(shape.dx / shape.dy),
                                             sqrt(shape.dy / shape.dx)},
                          boundary, &inside, f->problem.force, f->problem.path, o->threads, err);
    if (at->d == NULL)
        return RC_FAIL;
    at->d->shape = shape;
    at->d->asked.most = o->max_steps > 0 ? o->max_steps : 200;
    return RC_OK;
}

/* The pressure of every second node, in proportion to the load of the finer grid. */
static void
thin(const struct rolling *f, const struct level *fine, const double *p, struct level *to,
     double *less)
{
    const struct rc_ranks *ranks = f->base.rows.ranks;
    const struct rc_shape *s = &fine->d->shape, *t = &to->d->shape;
    const struct rc_rows *rows = &fine->d->t->rows;
    const size_t before = rows_within(rows->first, s->ny, t->ny),
                 end = rows_within(rows->first + rows->n, s->ny, t->ny);
    double *own = ranks == NULL ? less : fine->d->step.way[0]; /* larger than these rows */
    double all = rc_ranks_sum_of(ranks, p, fine->d->n) * s->dx * s->dy, sum;

    for (size_t j = before; j < end; j++)
        for (size_t i = 0; i < t->nx; i++)
            own[(j - before) * t->nx + i] =
                p[(place_of(j, s->ny, t->ny) - rows->first) * s->nx + place_of(i, s->nx, t->nx)];
    if (ranks != NULL) {
        const size_t count = rc_ranks_count(ranks);
        for (size_t r = 0; r <= count; r++) {
            f->dealt[r] = rows_within(dealt(s, ranks, r), s->ny, t->ny);
            f->dealt[count + 1 + r] = dealt(t, ranks, r);
        }
        rc_ranks_move(ranks, t->nx * sizeof *own, f->dealt, f->dealt + count + 1, 0, own, less);
    }
    sum = rc_ranks_sum_of(ranks, less, to->d->n) * t->dx * t->dy;
    for (size_t k = 0; k < to->d->n && sum > 0; k++)
        less[k] *= all / sum;
}

/* Sets what a grid needs besides q. */
static void
pose_level(struct rolling *f, struct level *l, const double *p)
{
    const struct rc_friction_law *o = &f->problem.law;
    const double most = o->tau_max > 0 ? o->tau_max : INFINITY, spin = spin_of(f);
    struct rc_steady *d = l->d;
    const bool coupled = d->t->shear.beta != 0, path = f->problem.path;
    double *const *push = path ? d->step.way : d->u;

    if (coupled)
        rc_tangential_pressure(d->t, p, push);
    for (size_t k = 0; k < d->n; k++)
        d->g[k] = fmin(o->mu * p[k], most);
    for (size_t k = 0; k < d->n; k++) {
        double v[2];
        spin_at(l, spin, k, v);
        for (int c = 0; c < 2; c++)
            d->rigid[c][k] =
                -v[c] * step_of(l) + (!coupled ? 0
                                      : path   ? push[c][k]
                                      : k + 1 < d->n && (d->g[k] > 0 || d->g[k + 1] > 0)
                                          ? push[c][k] - push[c][k + 1]
                                          : 0);
    }
    for (int c = 0; c < 2; c++)
        d->asked.sum[c] = f->base.to.at[RC_TANGENTIAL_X + c] / (d->shape.dx * d->shape.dy);
    d->asked.tol = l == f->at       ? o->tol
                   : l == f->at + 1 ? fmin(coarse_tol, fmax(o->tol, told_tol))
                                    : coarse_tol;
}

/* Loaded nodes one behind the other, on average. */
static double
run_of(const struct rc_steady *d, const double *p)
{
    double sum[2] = {0, 0}; /* loaded nodes, runs */

    for (size_t k = 0; k < d->n; k++) {
        sum[0] += p[k] > 0;
        sum[1] += p[k] > 0 && ((k + 1) % d->shape.nx == 0 || !(p[k + 1] > 0));
    }
    rc_ranks_each_sum(d->t->rows.ranks, 2, sum);
    return sum[1] > 0 ? sum[0] / sum[1] : 0;
}

/* The length of the contact in columns; *end: the column behind its last one. On a periodic map all columns
 * but the longest row of free ones. */
static size_t
columns_of(const struct rolling *f, bool repeats, size_t *end)
{
    const size_t nx = f->base.shape.nx;
    size_t first = nx, gap = 0;

    memset(f->touched, 0, nx * sizeof *f->touched);
    for (size_t k = 0; k < f->n; k++)
        if (f->p[k] > 0)
            f->touched[k % nx] = 1;
    rc_ranks_each_most(f->base.rows.ranks, nx, f->touched);
    *end = 0;
    for (size_t i = 0; i < nx; i++) {
        if (f->touched[i] == 0)
            continue;
        gap = first < i && i - *end > gap ? i - *end : gap;
        first = i < first ? i : first;
        *end = i + 1;
    }
    gap = first + nx - *end > gap ? first + nx - *end : gap;
    return repeats ? nx - gap : *end - first;
}

/* The sum of the largest forces of all nodes. */
static void
add_limits(const void *of, double *limit)
{
    const struct rolling *f = of;

    for (size_t k = 0; k < f->n; k++)
        *limit += f->at->d->g[k] * f->base.shape.dx * f->base.shape.dy;
}

static enum rc_status
carries(const struct rolling *f, struct rc_err *err)
{
    const double *at = f->base.to.at, size = hypot(at[RC_TANGENTIAL_X], at[RC_TANGENTIAL_Y]);
    double limit = 0;

    if (!f->problem.force)
        return RC_OK;
    rc_ranks_in_turn(f->base.rows.ranks, add_limits, f, 1, &limit);
    return size < limit
               ? RC_OK
               : rc_err_set(
                     err,
                     "force %g N: friction carries less than %g N, beyond it the bodies slide; "
                     "give the creepage instead",
                     size, limit);
}

static enum rc_status
check_spin(const struct rolling *f, struct rc_err *err)
{
    if (spin_of(f) == 0 || !spans_period(f->at, f->at->length))
        return RC_OK;
    return rc_err_set(
        err, "the contact reaches half a period from its middle, where the spin of a map that "
             "repeats jumps: take a map with a longer period, or a boundary that is free there");
}

/* Poses the next step of a path, in a map that has moved by some columns. */
static enum rc_status
pose_step(struct rolling *f, size_t columns, struct rc_err *err)
{
    struct level *l = f->at;

    if (make_level(f, 0, err) != RC_OK)
        return RC_FAIL;
    pose_level(f, l, f->p);
    if (check_spin(f, err) != RC_OK)
        return RC_FAIL;
    f->levels = 1;
    l->d->asked.tol *= f->rolls ? share_of(&f->errors, f->rolled, f->problem.law.tol) : of_first;
    if (f->resumes && f->stage == THERE) {
        rc_steady_reach(l->d, columns);
        return RC_OK;
    }
    for (int c = 0; c < 2; c++) {
        memcpy(l->d->q[c], l->d->path.last[c], f->n * sizeof *f->p); /* also after a try */
        if (!f->rolls) /* the bodies are pressed without friction */
            memcpy(l->d->step.old[c], l->d->step.way[c], f->n * sizeof *f->p);
        l->d->v[c] = f->problem.force ? 0 : f->base.to.at[RC_CREEP_X + c] * step_of(l);
    }
    return carries(f, err) == RC_OK ? rc_steady_set_out(l->d, columns, err) : RC_FAIL;
}

/* Poses all grids for the pressure p, or the next step of a path. */
static enum rc_status
pose(struct rolling *f, struct rc_err *err)
{
    const struct rc_shape *s = &f->base.shape;
    const bool path = f->problem.path, free_map = !f->problem.law.boundary.x;
    const double *p = f->p, moved = f->rolls ? round((middle_of(f) - f->x) / s->dx) : 0;
    const size_t come = path ? (size_t)fmax(moved, 0) : 1;
    size_t end;

    if (!(rc_ranks_most(f->base.rows.ranks, rc_any(p, f->n)) > 0))
        return rc_err_set(err, "no node is in contact, so that nothing rolls: give a larger load");
    if (moved < 0)
        return rc_err_set(err, "the map moves back by %g columns: rolling is towards +x", -moved);
    f->rolled = f->length / ((double)columns_of(f, !free_map, &end) * s->dx);
    if (free_map && end + come > s->nx)
        return rc_err_set(
            err,
            "the contact reaches the leading edge of the map, column %zu of %zu: rolling is "
            "towards +x, so leave %s there",
            end - 1, s->nx, come > 1 ? "as many free columns as the map moves" : "free columns");
    f->levels = 0;
    if (path)
        return pose_step(f, (size_t)moved, err);
    for (bool more = true; more; f->levels++) {
        struct level *l = &f->at[f->levels];
        if (make_level(f, f->levels, err) != RC_OK)
            return RC_FAIL;
        if (l > f->at) {
            thin(f, l - 1, p, l, l->d->step.old[0]);
            p = l->d->step.old[0];
        }
        pose_level(f, l, p);
        more = f->levels + 1 < LEVELS && run_of(l->d, p) >= RUN;
    }
    return check_spin(f, err) == RC_OK ? carries(f, err) : RC_FAIL;
}

/* Finds q and g of the coarser grid in the rows beside those of the finer one that are held here. Returns
 * the first of these rows. On ranks they are fetched to maps of the finer grid that its iteration has not
 * begun to use, and which are larger. */
static size_t
rows_beside(const struct rolling *f, const struct level *from, const struct level *to,
            const double *v[3])
{
    const struct rc_ranks *ranks = f->base.rows.ranks;
    const struct rc_shape *s = &from->d->shape, *t = &to->d->shape;
    const size_t count = rc_ranks_count(ranks);
    size_t *held = f->dealt, *first = held + count + 1, *n = first + count;
    double *const room[3] = {to->d->u[0], to->d->u[1], to->d->step.way[0]};

    v[0] = from->d->q[0];
    v[1] = from->d->q[1];
    v[2] = from->d->g;
    if (ranks == NULL)
        return 0;
    for (size_t r = 0; r <= count; r++)
        held[r] = dealt(s, ranks, r);
    for (size_t r = 0; r < count; r++) {
        const size_t j = dealt(t, ranks, r), end = dealt(t, ranks, r + 1);
        first[r] = j < end ? beside(j, 0, t->ny, s->ny) : 0;
        n[r] = j < end ? beside(end - 1, 1, t->ny, s->ny) + 1 - first[r] : 0;
    }
    for (int k = 0; k < 3; k++) {
        rc_ranks_fetch(ranks, s->nx * sizeof **v, held, first, n, v[k], room[k]);
        v[k] = room[k];
    }
    return first[rc_ranks_own(ranks)];
}

/* The start of a grid: the q/g of the coarser one. */
static void
refine(const struct rolling *f, const struct level *from, struct level *to)
{
    const struct rc_shape *s = &from->d->shape, *t = &to->d->shape;
    const double *v[3]; /* q, g */
    const size_t first = rows_beside(f, from, to, v);

    for (size_t k = 0; k < to->d->n; k++) {
        const size_t j = to->d->t->rows.first + k / t->nx;
        size_t at = 0;
        for (size_t up = 0; up < 4; up++) { /* the first neighbour with a load */
            at = (beside(j, up / 2, t->ny, s->ny) - first) * s->nx +
                 beside(k % t->nx, up % 2, t->nx, s->nx);
            if (v[2][at] > 0)
                break;
        }
        for (int c = 0; c < 2; c++)
            to->d->q[c][k] = v[2][at] > 0 ? v[c][at] / v[2][at] * to->d->g[k] : 0;
    }
    for (int c = 0; c < 2; c++)
        to->d->v[c] = from->d->v[c] * step_of(to) / step_of(from);
}

/* Begins a grid: from the coarser one, from the tractions of a state, or anew. */
static void
begin(struct rolling *f)
{
    struct level *l = &f->at[f->level];

    f->stage = ROLLING;
    if (f->problem.path) {
        f->resumes = false;
        return;
    }
    for (int c = 0; c < 2 && !f->problem.force; c++)
        l->d->v[c] = f->base.to.at[RC_CREEP_X + c] * step_of(l);
    if (!f->resumes && f->level + 1 == f->levels) {
        for (int c = 0; c < 2 && f->problem.force; c++)
            l->d->v[c] = 0;
        rc_steady_guess(l->d);
    } else if (!f->resumes) {
        refine(f, l + 1, l);
    }
    (f->resumes ? rc_steady_begin_again : rc_steady_begin)(l->d);
    f->resumes = false;
}

/* ---- figures ---- */

/* N: the sum of the lengths of all tractions. */
static double
size_of(const struct level *l)
{
    return l->d->found.size * l->d->shape.dx * l->d->shape.dy;
}

/* Linear and simplified theory, of the ellipse with this area and ratio of axes; `none`: 0, or NAN without
 * an ellipse. */
static void
look_at_ellipse(const struct rolling *f, double area, double ratio, double none,
                struct rc_rolling_figures *to)
{
    const double ab = area / RC_PI, g = f->shear.estar / (1 + f->shear.kap);

    to->ellipse[0] = none + sqrt(ab * ratio);
    to->ellipse[1] = none + sqrt(ab / ratio);
    rc_kalker(none + ratio, f->shear.kap / (1 + f->shear.kap), to->kalker);
    for (int c = 0; c < 2; c++)
        to->kalker_force[c] =
            ab * g *
            (to->kalker[c] * to->creep[c] + (c == 1 ? to->kalker[2] * sqrt(ab) * to->spin : 0));
    rc_fastsim(to->ellipse, g, to->kalker, to->limit, to->creep, to->spin, to->fastsim_force);
}

/* Sums over a grid, of which some have two components. */
enum {
    LIMIT,
    MOMENT,
    FORCE,
    NODES = FORCE + 2, /* with load                       */
    DISTANCES,         /* of these nodes from the middle  */
    SQUARES = DISTANCES + 2,
    SUMS = SQUARES + 2
};

static void
add_nodes(const void *of, double *sum)
{
    const struct level *l = of;
    const struct rc_steady *d = l->d;
    const double cell = d->shape.dx * d->shape.dy;

    for (size_t k = 0; k < d->n; k++) {
        double at[2];
        if (!(d->g[k] > 0))
            continue;
        from_middle(l, k, 0, at);
        sum[LIMIT] += d->g[k] * cell;
        sum[MOMENT] += (at[0] * d->q[1][k] - at[1] * d->q[0][k]) * cell;
        sum[NODES]++;
        for (int c = 0; c < 2; c++) {
            sum[FORCE + c] += d->q[c][k] * cell;
            sum[DISTANCES + c] += at[c];
            sum[SQUARES + c] += at[c] * at[c];
        }
    }
}

/* The figures of one grid. Second moments of the contact are about its middle. */
static void
look_at(const struct rolling *f, const struct level *l, struct rc_rolling_figures *to)
{
    const struct rc_steady *d = l->d;
    const double spin = spin_of(f), none = spans_period(l, 0) ? NAN : 0;
    double sum[SUMS] = {0}, moment[2];

    *to = (struct rc_rolling_figures){.load = f->f.load, .spin = spin};
    for (int c = 0; c < 2; c++)
        to->creep[c] = !f->problem.force ? f->base.to.at[RC_CREEP_X + c]
                       : l->length > 0   ? d->v[c] / step_of(l)
                                         : NAN;
    rc_ranks_in_turn(f->base.rows.ranks, add_nodes, l, SUMS, sum);
    to->limit = sum[LIMIT];
    to->moment = sum[MOMENT];
    for (int c = 0; c < 2; c++) {
        to->force[c] = sum[FORCE + c];
        moment[c] = sum[SQUARES + c] - sum[DISTANCES + c] * sum[DISTANCES + c] / sum[NODES];
    }
    to->power = to->force[0] * to->creep[0] + to->force[1] * to->creep[1] + to->moment * spin;
    to->moment += none;
    look_at_ellipse(f, sum[NODES] * (d->shape.dx * d->shape.dy), sqrt(moment[0] / moment[1]), none,
                    to);
    to->stick_nodes = d->found.stick;
    to->slip_nodes = d->found.slipping;
    to->stick_fraction = (double)d->found.stick / (double)(d->found.stick + d->found.slipping);
    to->traction_error = d->found.estimate;
}

/* Extrapolates from the two finest grids. Relative to the creepage an error of the force counts as much. */
static void
extrapolate(const struct rolling *f, struct rc_rolling_figures *to)
{
    const struct rc_rolling_figures *c = &f->coarse;
    const double none = f->levels > 1 ? 0 : NAN;
    const double *fine = f->problem.force ? to->creep : to->force,
                 *coarse = f->problem.force ? c->creep : c->force, size = hypot(fine[0], fine[1]);
    const double iteration = f->coarse_error + to->traction_error * size_of(f->at);

    for (int k = 0; k < 2; k++) {
        to->extrapolated_force[k] = 2 * to->force[k] - c->force[k] + none;
        to->extrapolated_creep[k] = 2 * to->creep[k] - c->creep[k] + none;
    }
    to->extrapolated_moment = 2 * to->moment - c->moment + none;
    to->discretization_error =
        size > 0 ? caution * hypot(fine[0] - coarse[0], fine[1] - coarse[1]) / size +
                       iteration / (f->problem.force ? to->limit : size) + none
                 : NAN;
}

/* Sums: friction energy, with and without the parts that rc_steady_dissipated() leaves out. */
static void
add_dissipation(const void *of, double *sum)
{
    const struct level *l = of;
    const double unit = l->d->shape.dx * l->d->shape.dy / step_of(l);

    for (size_t k = 0; k < l->d->n; k++) {
        sum[0] += rc_steady_dissipated(l->d, k, true) * unit;
        sum[1] += rc_steady_dissipated(l->d, k, false) * unit;
    }
}

/* Finds the friction energy, and the factor by which that of the nodes that slip becomes all of it. In
 * a steady state of similar bodies it is the supplied energy. */
static void
find_dissipation(struct rolling *f, struct rc_rolling_figures *to)
{
    double sum[2] = {0, 0}, all;

    rc_ranks_in_turn(f->base.rows.ranks, add_dissipation, f->at, 2, sum);
    all = !f->problem.path && f->at->d->t->shear.beta == 0 ? to->power : sum[0];
    f->dissipates = sum[1] > 0 && all > 0 ? all / sum[1] : 1;
    to->power_slip = f->dissipates * sum[1];
}

static double
all_convolutions(const struct rolling *f)
{
    const struct rc_shape *s = &f->base.shape;
    double sum = f->inner_convolutions;

    for (size_t k = 0; k < LEVELS && f->at[k].d != NULL; k++) {
        const struct rc_shape *own = &f->at[k].d->shape;
        sum += f->at[k].d->t->convolutions * (double)(own->nx * own->ny) / (double)(s->nx * s->ny);
    }
    return sum;
}

static void
find_figures(struct rolling *f)
{
    struct rc_rolling_figures *to = &f->f;

    to->load =
        rc_ranks_sum_of(f->base.rows.ranks, f->p, f->n) * f->base.shape.dx * f->base.shape.dy;
    if (f->at->d == NULL || f->stage < ROLLING || f->again)
        return;
    for (size_t k = f->level; k > 0; k--) /* the best so far */
        refine(f, &f->at[k], &f->at[k - 1]);
    look_at(f, f->at, to);
    find_dissipation(f, to);
    extrapolate(f, to);
    for (size_t k = f->level; k < f->levels; k++) {
        to->steps += f->at[k].d->found.steps;
        to->fallbacks += f->at[k].d->found.fallbacks;
    }
    to->convolutions = all_convolutions(f) - f->convolutions;
    if (f->level > 0)
        to->traction_error = INFINITY;
    if (size_of(f->at) > 0)
        to->traction_error += f->pressure_error * to->limit / size_of(f->at);
    f->own = to->traction_error;
    if (f->problem.path && size_of(f->at) > 0)
        to->traction_error += remembered(&f->errors, f->rolled) / size_of(f->at);
    to->converged = f->stage == THERE && f->good && to->traction_error <= f->problem.law.tol;
}

/* ---- verbs ---- */

static bool
has_both(const struct rolling *f, enum rc_axis x)
{
    return rc_point_has(&f->base.to, x) && rc_point_has(&f->base.to, x + 1);
}

/* Sends the inner model to its point, unless its pressure is known. */
static enum rc_status
press(struct rolling *f, struct rc_err *err)
{
    const struct rc_rolling_problem *o = &f->problem;
    struct rc_point to = rc_point_for(f->base.inner, &f->base.to);

    f->stage = PRESSING;
    f->good = true;
    f->pressure_error = 0;
    return o->known == NULL ? rc_model_go(f->base.inner, &to, err) : RC_MORE;
}

static enum rc_status
go(struct rc_model *m, struct rc_err *err)
{
    struct rolling *f = (struct rolling *)m;
    const bool force = f->problem.force;

    if (!has_both(f, force ? RC_TANGENTIAL_X : RC_CREEP_X))
        return rc_err_set(err, "rolling needs the %s along x and y", force ? "force" : "creepage");
    if (m->to.given & (force ? 1u << RC_CREEP_X | 1u << RC_CREEP_Y
                             : 1u << RC_TANGENTIAL_X | 1u << RC_TANGENTIAL_Y))
        return rc_err_set(err, "this model of rolling finds the %s: give the %s only",
                          force ? "creepage" : "force", force ? "force" : "creepage");
    for (enum rc_axis k = RC_CREEP_X; k <= RC_SPIN; k++)
        if (rc_point_has(&m->to, k) && !(fabs(m->to.at[k]) <= most_motion))
            return rc_err_set(err, "%s %g: it must be at most %g", rc_axis_info(k)->name,
                              m->to.at[k], most_motion);
    if (f->problem.path && !rc_point_has(&m->to, RC_POSITION))
        return rc_err_set(err, "rolling along a path needs the position");
    f->length = f->rolls ? m->to.at[RC_POSITION] - m->from.at[RC_POSITION] : 0;
    if (f->length < 0)
        return rc_err_set(err, "position %g m after %g m: rolling is towards +x",
                          m->to.at[RC_POSITION], m->from.at[RC_POSITION]);
    f->convolutions = all_convolutions(f);
    f->again = f->resumes = false;
    return press(f, err) == RC_MORE ? RC_OK : RC_FAIL;
}

static enum rc_status
there(struct rolling *f)
{
    f->stage = THERE;
    f->resumes = false;
    find_figures(f);
    return f->f.converged ? RC_OK : RC_SHORT;
}

static enum rc_status
step_contact(struct rolling *f, struct rc_err *err)
{
    struct rc_model *inner = f->base.inner;
    const enum rc_status status = f->problem.known != NULL ? RC_OK : rc_model_step(inner, err);

    if (status == RC_MORE || status == RC_FAIL)
        return status;
    f->good = status == RC_OK;
    if (f->problem.known == NULL) {
        if (rc_model_look(inner, NULL, err) != RC_OK ||
            rc_model_frame(inner, "pressure", f->p, err) != RC_OK)
            return RC_FAIL;
        f->inner_convolutions += f->resumes ? 0 : rc_model_number(inner, "convolutions");
        f->pressure_error = rc_model_number(inner, "pressure_error_estimate");
    }
    if (f->problem.known != NULL)
        memcpy(f->p, f->problem.known->p, f->n * sizeof *f->p);
    if (pose(f, err) != RC_OK)
        return RC_FAIL;
    f->level = f->resumes ? 0 : f->levels - 1;
    if (f->resumes && f->problem.path && f->stage == THERE)
        return there(f);
    begin(f);
    return RC_MORE;
}

static enum rc_status
step(struct rc_model *m, struct rc_err *err)
{
    struct rolling *f = (struct rolling *)m;
    enum rc_status status;

    if (f->again) {
        f->again = false;
        f->resumes = f->level == 0; /* coarser grids begin again */
        f->pressure_error = 0;
        return step_contact(f, err);
    }
    if (f->stage == PRESSING)
        return step_contact(f, err);
    status = f->problem.path ? rc_steady_follow(f->at->d) : rc_steady_step(f->at[f->level].d, err);
    if (status == RC_MORE || status == RC_FAIL)
        return status;
    if (f->level > 0) {
        look_at(f, &f->at[f->level], &f->coarse);
        f->coarse_error = f->coarse.traction_error * size_of(&f->at[f->level]);
        f->level--;
        begin(f);
        return RC_MORE;
    }
    return there(f);
}

static enum rc_status
look(struct rc_model *m, struct rc_point *at, struct rc_err *err)
{
    struct rolling *f = (struct rolling *)m;

    if (f->again && m->status != RC_MORE) { /* the point of a state, which was reached */
        enum rc_status status;
        do
            status = step(m, err);
        while (status == RC_MORE);
        if (status == RC_FAIL || rc_model_look(m->inner, at, err) != RC_OK)
            return RC_FAIL;
    }
    find_figures(f);
    for (int c = 0; c < 2; c++)
        at->at[(f->problem.force ? RC_CREEP_X : RC_TANGENTIAL_X) + c] =
            !f->problem.force      ? f->f.force[c]
            : isnan(f->f.creep[c]) ? 0
                                   : f->f.creep[c];
    return RC_OK;
}

static enum rc_status
keep(struct rc_model *m, struct rc_err *err)
{
    struct rolling *f = (struct rolling *)m;

    f->stage = REST;
    if (f->problem.path) {
        remember(&f->errors, f->rolled, f->own * size_of(f->at), size_of(f->at));
        f->x = middle_of(f);
        f->rolls = true;
        rc_steady_arrive(f->at->d);
    }
    return f->problem.known == NULL ? rc_model_keep(m->inner, err) : RC_OK;
}

/* J/m3: friction energy per area and length rolled. */
static double
dissipation(const struct rolling *f, size_t k)
{
    const struct rc_steady *d = f->at->d;

    return d == NULL || !(f->at->length > 0)
               ? 0
               : f->dissipates * rc_steady_dissipated(d, k, false) / step_of(f->at);
}

static enum rc_status
fill(struct rc_model *m, size_t frame, double *to, struct rc_err *err)
{
    const struct rolling *f = (const struct rolling *)m;
    const struct rc_steady *d = f->at->d;

    (void)err;
    for (size_t k = 0; k < f->n; k++)
        switch (frame) {
        case RC_SLIP_PRESSURE:
            to[k] = f->p[k];
            break;
        case RC_SLIP_TRACTION_X:
        case RC_SLIP_TRACTION_Y:
            to[k] = d == NULL ? 0 : d->q[frame - RC_SLIP_TRACTION_X][k];
            break;
        case RC_SLIP_TRACTION:
            to[k] = d == NULL ? 0 : hypot(d->q[0][k], d->q[1][k]);
            break;
        case RC_SLIP_STATE:
            to[k] = d == NULL || d->g[k] == 0 ? 0 : d->face[k] == RC_FACE_STICK ? 1 : 2;
            break;
        case RC_SLIP_DISSIPATION:
            to[k] = dissipation(f, k);
            break;
        case RC_SLIP_LENGTH:
            to[k] = d == NULL || d->g[k] == 0 ? 0 : dissipation(f, k) / d->g[k];
            break;
        default: /* a node that sticks has none: what is left there is an error */
            to[k] = d == NULL || d->g[k] == 0 || d->face[k] == RC_FACE_STICK ? 0
                    : f->at->length > 0 ? d->s[frame - RC_SLIP_SLIP_X][k] / step_of(f->at)
                                        : 0;
        }
    return RC_OK;
}

static enum rc_status
set_heights(struct rc_model *m, const double *h, struct rc_err *err)
{
    return rc_model_set_heights(m->inner, h, err);
}

/* ---- states ---- */

static void
exchange_faces(struct rc_steady *d, struct rc_state *s)
{
    const double *from = NULL;
    double *to = NULL;

    RC_STATE_COUNTS(s, &d->found.stick, &d->found.slipping);
    if (rc_state_reads(s))
        from = rc_state_read_map(s, d->n);
    else
        to = rc_state_map(s, d->n, NULL);
    for (size_t k = 0; k < d->n && to != NULL; k++)
        to[k] = d->face[k];
    for (size_t k = 0; k < d->n && from != NULL; k++)
        if (from[k] == RC_FACE_OFF || from[k] == RC_FACE_STICK || from[k] == RC_FACE_SLIP)
            d->face[k] = (unsigned char)from[k];
        else
            rc_state_refuse(s, "a face is out of range");
}

/* The tractions due to v, which may be those of an earlier step. */
static void
exchange_border(struct rc_steady *d, struct rc_state *s)
{
    rc_state_count(s, &d->motion.slipping, d->shape.nx * d->shape.ny);
    rc_state_finite(s, 4, d->motion.of_sum);
    for (int m = 0; m < 4; m++) {
        float *due = d->motion.due[m / 2][m % 2];
        const double *from = rc_state_reads(s) ? rc_state_read_map(s, d->n) : NULL;
        double *to = from == NULL ? rc_state_map(s, d->n, NULL) : NULL;
        for (size_t k = 0; k < d->n && to != NULL; k++)
            to[k] = due[k];
        for (size_t k = 0; k < d->n && from != NULL; k++)
            due[k] = (float)from[k];
    }
}

static void
state(struct rc_model *m, struct rc_state *s)
{
    struct rolling *f = (struct rolling *)m;
    const bool path = f->problem.path, border = f->problem.force && !path && !rc_state_is_copy(s);
    struct rc_steady *d;
    bool there;

    rc_state_count(s, &f->stage, THERE);
    rc_state_count(s, &f->level, LEVELS - 1);
    RC_STATE_FLAGS(s, &f->rolls);
    RC_STATE_NUMBERS(s, &f->x, &f->errors.span, &f->errors.tractions, &f->coarse.moment,
                     &f->coarse_error);
    rc_state_finite(s, AGES, f->errors.size);
    rc_state_finite(s, AGES, f->errors.age);
    rc_state_finite(s, 2, f->coarse.force);
    rc_state_finite(s, 2, f->coarse.creep);
    if (!rc_state_agree(s, f->base.rows.ranks))
        return;
    if (rc_state_reads(s)) {
        f->resumes = false;
        f->again = f->stage == ROLLING || f->stage == THERE;
        f->convolutions = all_convolutions(f);
        f->length = f->rolls && path ? m->to.at[RC_POSITION] - m->from.at[RC_POSITION] : 0;
    }
    if (f->level > 0 || (f->stage != ROLLING && f->stage != THERE && !(path && f->rolls)))
        return;
    if (rc_state_reads(s)) {
        struct rc_err err;
        if (make_level(f, 0, &err) != RC_OK) {
            rc_state_refuse(s, "memory is short");
            return;
        }
    }
    d = f->at->d;
    there = path && f->stage == THERE;
    rc_state_finite(s, 2, d->v);
    RC_STATE_OPEN(s, &d->found.estimate);
    RC_STATE_SIZES(s, &d->found.left);
    for (int k = 0; k < RC_STEADY_PAST; k++)
        RC_STATE_SIZES(s, &d->found.past[k]);
    RC_STATE_COUNTS(s, &d->found.steps, &d->found.fallbacks);
    for (int c = 0; c < 2; c++) {
        if (path) { /* a step that has not ended begins again */
            rc_state_map(s, d->n, d->path.last[c]);
            rc_state_map(s, d->n, d->step.old[c]);
        }
        if (!path || there)
            rc_state_map(s, d->n, d->q[c]);
        if (there)
            rc_state_map(s, d->n, d->u[c]);
    }
    if (there)
        exchange_faces(d, s);
    if (border)
        exchange_border(d, s);
}

static void
progress(const struct rc_model *m, struct rc_loops *l)
{
    const struct rolling *f = (const struct rolling *)m;
    const struct rc_steady *d = f->at[f->level].d;

    if (f->stage < ROLLING || d == NULL) {
        rc_loops_add(l, "grid", NULL, 0, NAN);
        return;
    }
    rc_loops_add(l, "grid", NULL, (double)(f->levels - f->level), (double)f->levels);
    rc_loops_add(l, "step", NULL, (double)d->found.steps, NAN);
    l->grid = d->shape;
    l->error = d->found.estimate;
    l->tol = d->asked.tol;
}

/* The bytes are those on 512 x 512 nodes, counted in maps of doubles: on a free map, and what is less
 * where both axes repeat. */
static enum rc_status
plan(const struct rc_model *m, const struct rc_point *most, struct rc_expected *expected,
     struct rc_err *err)
{
    const struct rolling *f = (const struct rolling *)m;
    const struct rc_rolling_problem *o = &f->problem;
    const struct rc_point inner = rc_point_for(m->inner, most);
    const double below = fmax(log10(1e-2 / o->law.tol), -1);
    const double work = o->path
                            ? RC_ROLLING_STEP * (1 + below / 2)
                            : (o->force ? RC_ROLLING_FORCE : RC_ROLLING_STEADY) * (1 + below / 3);
    const double maps = (o->path    ? 53
                         : o->force ? 67
                                    : 64) -
                        rc_by_padding(o->law.boundary, 0, o->path ? 12 : 14) +
                        (f->shear.beta != 0 && !o->law.uncoupled ? 2 : 0);
    double each;

    *expected = (struct rc_expected){0, 0, 0};
    if (o->known == NULL && rc_model_plan(m->inner, &inner, expected, err) != RC_OK)
        return RC_FAIL;
    each = rc_conv_seconds(&m->shape, &(struct rc_conv_options){.boundary = o->law.boundary,
                                                                .threads = o->law.threads,
                                                                .ranks = f->base.rows.ranks});
    expected->seconds += work * (o->path ? 1 : RC_ROLLING_PASSES) * each;
    expected->convolutions += work;
    expected->memory += (size_t)(maps * (double)f->n) * sizeof(double);
    return RC_OK;
}

static void
release(struct rc_model *m)
{
    struct rolling *f = (struct rolling *)m;

    for (size_t k = 0; k < LEVELS; k++)
        rc_steady_free(f->at[k].d);
}

const struct rc_model_row rc_model_rolling = {
    .name = "rolling",
    .summary = "rolling with creepage, over an inner model",
    .takes = 1u << RC_CREEP_X | 1u << RC_CREEP_Y | 1u << RC_SPIN | 1u << RC_TANGENTIAL_X |
             1u << RC_TANGENTIAL_Y | 1u << RC_POSITION,
    RC_MODEL_VERBS,
    .frame = frames,
    .free = release,
    .keep = keep,
    .heights = set_heights,
    .plan = plan,
};

/* ---- the maker ---- */

static enum rc_status
make(struct rolling *f, struct rc_err *err)
{
    const struct rc_ranks *ranks = f->base.rows.ranks;
    struct rc_friction_law *o = &f->problem.law;

    if (rc_friction_solver_check(&f->base.shape, o, &f->shear, err) != RC_OK ||
        rc_model_same_boundary(&f->base, o->boundary, err) != RC_OK)
        return RC_FAIL;
    if (o->boundary.x && !f->problem.path)
        return rc_err_set(err, "steady rolling on a map that is periodic along x has no leading "
                               "edge, where free surface "
                               "comes in: take a boundary that is free along x");
    f->n = rc_model_nodes(&f->base);
    o->tol = o->tol > 0 ? o->tol : usual_tol[f->problem.path];
    f->p = rc_store_zeros(&f->base.own, f->n, sizeof *f->p);
    f->touched = rc_store_take(&f->base.own, f->base.shape.nx, sizeof *f->touched);
    if (ranks != NULL)
        f->dealt = rc_store_take(&f->base.own, 3 * (rc_ranks_count(ranks) + 1), sizeof *f->dealt);
    return rc_model_room(&f->base, err);
}

struct rc_model *
rc_rolling_new(struct rc_model *inner, const struct rc_rolling_problem *problem, struct rc_err *err)
{
    RC_OWN(rc_model, m) =
        rc_model_make_outer(&rc_model_rolling, sizeof(struct rolling), inner, err);

    if (m == NULL)
        return NULL;
    ((struct rolling *)m)->problem = *problem;
    return make((struct rolling *)m, err) == RC_OK ? rc_give(&m) : NULL;
}
