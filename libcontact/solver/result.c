/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Results of a solution: figures, gap, displacement and the shape after yielding.
 */
#include "solver.h"

#include <math.h>
#include <string.h>

/* A record of figures is flat, however long, because rows name its members. */
#define FIGURE(member) RC_FIGURE(struct rc_contact, member)
#define AS(column, member) RC_FIGURE_AS(column, struct rc_contact, member)
#define ERROR(lowered_by, belongs_to) .role = RC_FIGURE_ERROR, .by = lowered_by, .of = belongs_to
const struct rc_figure rc_figures_contact[] = {
    {FIGURE(load), "N", "Load", .says = "sum of the pressure"},
    {FIGURE(mean_pressure), "Pa", "Mean pressure", .says = "load over the area of the map"},
    {FIGURE(max_pressure), "Pa", "Largest pressure"},
    {FIGURE(contact_nodes), NULL, "Nodes in contact"},
    {FIGURE(contact_area), "m2", "Contact area"},
    {FIGURE(contact_fraction), NULL, "Contact fraction",
     .says = "contact area over the area of the map"},
    {FIGURE(plastic_area), "m2", "Area at the hardness"},
    {FIGURE(yielded_area), "m2", "Yielded area",
     .says = "area at the hardness that this load deforms"},
    {FIGURE(edge_load_fraction), NULL, "Share of the load at the edge",
     .says = "load on the outer 2 % of the map over the load", .role = RC_FIGURE_CHECK,
     .limit = 0.01, .warning = "the contact reaches the edge of the map"},
    {FIGURE(approach), "m", "Approach", .says = "of the bodies, from first touch"},
    {FIGURE(mean_gap), "m", "Mean gap", .says = "over the whole map"},
    {FIGURE(iterations), NULL, "Iterations", .role = RC_FIGURE_COST},
    {FIGURE(convolutions), NULL, "Convolutions", .role = RC_FIGURE_COST,
     .says = "in equivalents of one in double precision on this grid"},
    {FIGURE(kkt_residual), NULL, "Residual", .role = RC_FIGURE_CHECK,
     .says =
         "largest violation of the contact conditions over the spread of heights or displacements"},
    {AS("pressure_error_estimate", pressure_error), NULL, "Error of the pressure",
     .says = "estimated relative L1 error", ERROR("tol", "pressure")},
    {AS("contact_area_error_estimate", discretization.contact_area), NULL,
     "Error of the contact area by the grid", ERROR("grid", "contact_area")},
    {AS("max_pressure_error_estimate", discretization.max_pressure), NULL,
     "Error of the largest pressure", .says = "relative, by the grid",
     ERROR("grid", "max_pressure")},
    {AS("approach_error_estimate", discretization.approach), NULL,
     "Error of the approach by the grid", ERROR("grid", "approach")},
    {FIGURE(converged), NULL, "Converged", .says = "the error estimate is within the tolerance"},
    {AS("elastic_energy", elastic_energy), "J", "Elastic energy", .says = "of both bodies"},
    {0},
};

/* Load on the outer 2 % of the map, at least one line of nodes on each side. If only one axis repeats,
 * its ends are no edges. */
static double
edge_load(const struct rc_solver *s)
{
    size_t nx = s->posed.whole.nx, ny = s->posed.whole.ny;
    const bool one = rc_repeats(s->posed.boundary) == 1;
    size_t mx = nx < 3 || (one && s->posed.boundary.x) ? 0 : (nx + 49) / 50;
    size_t my = ny < 3 || (one && s->posed.boundary.y) ? 0 : (ny + 49) / 50;
    double total[RC_SUMS];

    rc_reduce_rows_begin(s);
    for (size_t j = 0; j < s->posed.shape.ny; j++) {
        size_t y = s->posed.rows.first + j, left = y < my || y + my >= ny ? nx : mx;
        double *sums = rc_reduce_row(s, j);
        for (size_t i = 0; i < left; i++)
            sums[0] += s->it.p[j * nx + i];
        for (size_t i = left < nx ? nx - mx : nx; i < nx; i++)
            sums[0] += s->it.p[j * nx + i];
    }
    rc_reduce_rows_end(s, total);
    return total[0] / s->load.sum;
}

/* The largest pressure at the free edges of the map; 0: none is free. */
static double
edge_pressure(const struct rc_solver *s)
{
    const size_t nx = s->posed.whole.nx, ny = s->posed.whole.ny;
    double most = 0;

    for (size_t j = 0; j < s->posed.shape.ny; j++) {
        const size_t y = s->posed.rows.first + j;
        const double *p = s->it.p + j * nx;
        if (!s->posed.boundary.y && ny > 1 && (y == 0 || y + 1 == ny))
            most = fmax(most, rc_highest(p, nx));
        if (!s->posed.boundary.x && nx > 1)
            most = fmax(most, fmax(p[0], p[nx - 1]));
    }
    return rc_ranks_most(s->posed.rows.ranks, most);
}

struct figures {
    const struct rc_solver *s;
    const double *v; /* of the solver, if it is known */
    double *displacement, *gap;
    double mean_h, mean_u;
    double worst; /* m: bound of the error of the gap: its largest violation */
};

enum { /* sums of the first pass, */
    CONTACT,
    PLASTIC,
    PRESSURE,
    HEIGHT,
    V,
    OWN, /* sum of D p */
    /* sums of the second pass */
    SPREAD_H = 0,
    SPREAD_U,
    OPEN,
    ENERGY,
};

static void
count_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_solver *s = ((struct figures *)at)->s;
    const struct rc_box box = rc_box(s, 0);
    const double *v = ((struct figures *)at)->v;
    double sum[RC_SUMS] = {0}; /* in registers */

    for (size_t k = first; k < first + n; k++) {
        double p = s->it.p[k];
        sum[CONTACT] += !rc_at_low(box, k, p);
        sum[PLASTIC] += rc_at_high(box, k, p);
        sum[PRESSURE] += p;
        sum[HEIGHT] += s->posed.h[k];
        sum[V] += v[k];
        sum[OWN] += rc_operator_own_motion(s->op, k, p);
        sum[RC_MOST] = p > sum[RC_MOST] ? p : sum[RC_MOST];
    }
    memcpy(sums, sum, sizeof sum);
}

/* Spread of heights and displacements, the largest violation, and the frames. */
static void
spread_block(void *at, size_t first, size_t n, double *sums)
{
    const struct figures *f = at;
    const struct rc_solver *s = f->s;
    const struct rc_box box = rc_box(s, 0);
    const double shift = s->it.shift, mean_h = f->mean_h, mean_u = f->mean_u;
    const bool own = s->op->soft.plus > 0 || s->op->soft.row > 0;
    const double rise = s->op->rise * s->load.sum;
    double sum[RC_SUMS] = {0};

    for (size_t k = first; k < first + n; k++) {
        double g = s->it.v[k] - shift, p = s->it.p[k], open = g > 0 ? g : 0;
        double u = s->it.v[k] + s->posed.h[k] - (own ? rc_operator_own_motion(s->op, k, p) : 0);
        double h = s->posed.h[k] - mean_h, around = u - mean_u;
        double worst = (rc_at_low(box, k, p) ? 0 : open) + (rc_at_high(box, k, p) ? 0 : open - g);

        sum[SPREAD_H] += h * h;
        sum[SPREAD_U] += around * around;
        sum[OPEN] += open;
        sum[ENERGY] += p * (u + rise);
        sum[RC_MOST] = worst > sum[RC_MOST] ? worst : sum[RC_MOST];
        if (f->displacement != NULL)
            f->displacement[k] = u + rise;
        if (f->gap != NULL)
            f->gap[k] = g;
    }
    memcpy(sums, sum, sizeof sum);
}

/* Nodes at their upper bounds whose gap is negative by more than `worst`. */
static void
yield_block(void *at, size_t first, size_t n, double *sums)
{
    const struct figures *f = at;
    const struct rc_solver *s = f->s;

    for (size_t k = first; k < first + n; k++)
        sums[0] += rc_at_high(rc_box(s, 0), k, s->it.p[k]) && s->it.v[k] - s->it.shift < -f->worst;
}

static size_t
yielded(const struct rc_solver *s, struct figures *f)
{
    double total[RC_SUMS];

    rc_reduce_blocks(s, yield_block, f, total);
    return (size_t)total[0];
}

/* ---- the error of the grid ---- */

enum {
    LEFT,
    RIGHT,
    ABOVE,
    BELOW,
    SIDES
};

/* What the neighbours of the nodes tell about a finer grid. */
struct between {
    double low;     /* Pa: pressure out of contact */
    double most;    /* Pa: largest pressure */
    double top;     /* m: highest point between the nodes, over the highest node */
    double peak;    /* Pa: largest pressure, between and at nodes whose neighbours are in contact */
    double edge;    /* Pa: largest pressure of a node with a neighbour out of contact */
    size_t open[2]; /* sides along x and along y between a node in contact and one that is not */
    bool outside;   /* a node in contact lies at a free edge of the map */
    bool near;      /* a node with a neighbour out of contact is beside the largest pressure */
};

/* A node with the value `at` and its neighbours; NAN: none, beyond a free edge of the map. */
typedef void visit(struct between *b, double at, const double beside[SIDES]);

/* A line of one or two nodes has no neighbours in its direction. */
static void
visit_nodes(const struct rc_solver *s, const double *v, visit *do_it, struct between *b)
{
    const struct rc_rows *rows = &s->posed.rows;
    const size_t nx = s->posed.shape.nx, ny = s->posed.shape.ny, all = s->posed.whole.ny;
    const bool round = s->posed.boundary.y;
    double before[RC_ROW_PIECE], after[RC_ROW_PIECE];
    bool has[2] = {round, round};

    for (size_t first = 0; first < nx; first += RC_ROW_PIECE) {
        const size_t n = nx - first < RC_ROW_PIECE ? nx - first : RC_ROW_PIECE;
        const double *last = v + (ny > 0 ? (ny - 1) * nx : 0) + first;
        if (rows->ranks != NULL) {
            rc_ranks_beside(rows, round, n * sizeof *before, v + first, last, before, after, has);
        } else {
            memcpy(before, last, n * sizeof *before);
            memcpy(after, v + first, n * sizeof *after);
        }
        for (size_t j = 0; j < ny; j++)
            for (size_t i = first; i < first + n; i++) {
                const double *at = v + j * nx + i;
                const bool wide = nx > 2, wraps = s->posed.boundary.x;
                double beside[SIDES] = {
                    [LEFT] = i > 0   ? at[-1]
                             : wraps ? at[nx - 1]
                                     : NAN,
                    [RIGHT] = i + 1 < nx ? at[1]
                              : wraps    ? v[j * nx]
                                         : NAN,
                    [ABOVE] = j > 0    ? *(at - nx)
                              : has[0] ? before[i - first]
                                       : NAN,
                    [BELOW] = j + 1 < ny ? at[nx]
                              : has[1]   ? after[i - first]
                                         : NAN,
                };
                if (!wide)
                    beside[LEFT] = beside[RIGHT] = *at;
                if (all <= 2)
                    beside[ABOVE] = beside[BELOW] = *at;
                do_it(b, *at, beside);
            }
    }
}

/* The rise from the middle one of three nodes to the top of the curve through them, for a parabola and for a
 * wave of four nodes. A shorter wave is not allowed; the wave rises up to twice as far as the parabola. */
struct rise {
    double parabola, wave;
};

/* 0: the top is not near the middle node. */
static struct rise
rise(double before, double at, double after)
{
    const double bend = 2 * at - before - after, slope = (after - before) / 2;

    if (!(bend > 0 && fabs(slope) <= bend))
        return (struct rise){0};
    return (struct rise){slope * slope / (2 * bend), hypot(bend / 2, slope) - bend / 2};
}

/* A summit lies anywhere between two nodes: over the higher one by at most this part of its second
 * difference with its neighbours, for waves of four or more nodes. It is (1 - cos(pi/4))/(2 cos(pi/4)),
 * and an eighth for a parabola. */
static const double summit = 0.2071;

static void
visit_height(struct between *b, double h, const double beside[SIDES])
{
    double more = 0;

    for (size_t q = 0; q < SIDES; q += 2)
        more += fmax(summit * (2 * h - beside[q] - beside[q + 1]), 0); /* NAN: 0 */
    b->top = fmax(b->top, h + more);
}

static void
visit_pressure(struct between *b, double p, const double beside[SIDES])
{
    const struct rise x = rise(beside[LEFT], p, beside[RIGHT]),
                      y = rise(beside[ABOVE], p, beside[BELOW]);
    size_t open = 0;
    bool outside = false;

    if (p <= b->low)
        return;
    for (size_t q = 0; q < SIDES; q++) {
        const size_t ends = beside[q] <= b->low;
        outside = outside || isnan(beside[q]);
        b->open[q / 2] += ends;
        open += ends;
    }
    b->outside = b->outside || outside;
    for (size_t q = 0; q < SIDES && open > 0; q++)
        b->near = b->near || beside[q] >= b->most;
    if (open > 0)
        b->edge = fmax(b->edge, p);
    if (open > 0 || outside)
        return;
    b->peak = fmax(b->peak, p + fmax(x.parabola + y.parabola, fmax(x.wave, y.wave)));
}

/* Of the largest pressure: the most of a node with a neighbour out of contact. Where there is more, the peak
 * may lie beside that node and be much higher, as in a spot of two nodes. */
static const double edge_most = 0.9;

/* The discretization error, from a comparison with half the nodes a side, and from the values between nodes.
 * - Area: half a cell along the edge of the contact. If all edges are across one axis, as in a profile, the
 *   errors of the two ends of a spot do not average, and each is at most a cell.
 * - Approach, from the mean heights: it converges at least with the first power of the spacing, so that its
 *   error is at most the difference of the two grids. The highest point, from which the approach counts,
 *   lies between nodes: a higher one. The two errors are not of one sign, and the larger one is told.
 * - Largest pressure, at a node whose neighbours are in contact: it may lie between nodes; and at the nodes
 *   it converges nearly with the second power of the spacing, so that the error is at most half of the
 *   difference.
 * At a free edge of the map the pressure of a contact has no bound, and where a node at the edge of the
 * contact has nearly the largest pressure the grid does not resolve it: then there is no estimate. In a
 * profile there is none either if such a node is beside the largest pressure: the spot has fewer than five
 * nodes, and the difference may vanish by chance. 185 of 316 random profiles had such a spot, and 9 of their
 * estimates would be .3 to .9 of the error; of the others none is below it. */
static struct rc_discretization
left_out(const struct rc_solver *s, const struct rc_contact *c)
{
    const struct rc_ranks *ranks = s->posed.rows.ranks;
    struct rc_discretization d = {NAN, NAN, NAN};
    struct between b = {.low = s->posed.bounds.box.low, .most = c->max_pressure};
    bool line; /* all edges of the contact are across one axis */

    if (isnan(s->coarse.max_pressure))
        return d;
    visit_nodes(s, s->it.p, visit_pressure, &b);
    visit_nodes(s, s->posed.h, visit_height, &b); /* the largest h is 0 */
    for (size_t a = 0; a < 2; a++)
        b.open[a] = rc_ranks_sum(ranks, b.open[a]);
    line = s->posed.whole.nx == 1 || s->posed.whole.ny == 1 || (b.open[0] == 0) != (b.open[1] == 0);
    b.outside = rc_ranks_sum(ranks, b.outside) > 0;
    b.near = rc_ranks_sum(ranks, b.near) > 0;
    b.peak = rc_ranks_most(ranks, b.peak);
    b.edge = rc_ranks_most(ranks, b.edge);
    b.top = rc_ranks_most(ranks, b.top);
    d.contact_area = (line ? 1 : 0.5) * (double)(b.open[0] + b.open[1]) / (double)c->contact_nodes;
    if (c->hardness_active)
        d.max_pressure = fabs(s->coarse.max_pressure / c->max_pressure - 1);
    else if (!b.outside && b.edge <= edge_most * c->max_pressure && !(line && b.near))
        d.max_pressure =
            fabs(s->coarse.max_pressure / c->max_pressure - 1) / 2 + (b.peak / c->max_pressure - 1);
    if (!b.outside)
        d.approach = fmax(fabs(s->coarse.approach - c->approach), b.top) / c->approach;
    return d;
}

enum rc_status
rc_solver_plastic(const struct rc_solver *s, double *h, struct rc_err *err)
{
    if (s->stage != RC_STAGE_JUDGED)
        return rc_err_set(err,
                          "the shape after yield belongs to a result: call rc_solver_result first");
#pragma omp parallel for num_threads(s->posed.threads) schedule(static)
    for (size_t k = 0; k < s->posed.n; k++) {
        double g = s->it.v[k] - s->it.shift;
        h[k] = s->posed.h[k] + rc_tilt_rise(s, k) + s->posed.top;
        if (rc_at_high(rc_box(s, 0), k, s->it.p[k]) && g < 0)
            h[k] += g;
    }
    return RC_OK;
}

void
rc_solver_result(struct rc_solver *s, double *displacement, double *gap, struct rc_contact *c)
{
    struct figures f = {.s = s, .displacement = displacement, .gap = gap};
    double total[RC_SUMS], n = (double)s->posed.nodes, scale;
    /* no gap is known, and the caller cannot wait for a precise one */
    bool early = s->nested.ahead || (rc_solver_hurried(s) && !s->it.known), stopped, hurried;
    bool blind; /* the figures of the gap stay unknown, because the gap would cost a convolution */

    rc_nested_end(s); /* a nested start that was interrupted: use its pressure */
    *c = (struct rc_contact){.iterations = s->it.iterations};
    /* an estimate above the tolerance needs no confirmation in double precision */
    hurried =
        rc_solver_hurried(s) && s->it.checked == s->it.iterations && s->it.error > s->load.tol;
    stopped = !s->it.known || (!s->it.fresh && !early && !hurried);
    blind = stopped && early && rc_solver_hurried(s) && displacement == NULL && gap == NULL &&
            !rc_bounded(&s->posed.bounds);
    f.v = blind ? s->posed.h : s->it.v;
    if (blind)
        s->it.shift = NAN;
    else if (stopped && early)
        (void)rc_iterate_displace_rows(s); /* this pressure needs no better gap */
    else if (stopped)
        rc_iterate_displace(s);
    if (!blind)
        rc_iterate_shift(s);
    rc_operator_sink(s->op, s->it.p);
    rc_reduce_blocks(s, count_block, &f, total);
    c->contact_nodes = (size_t)total[CONTACT];
    c->plastic_nodes = (size_t)total[PLASTIC];
    c->max_pressure = total[RC_MOST];
    c->load = total[PRESSURE] * s->posed.cell;
    c->mean_pressure = total[PRESSURE] / n;
    c->contact_area = s->posed.cell * (double)c->contact_nodes;
    c->contact_fraction = (double)c->contact_nodes / n;
    c->plastic_area = s->posed.cell * (double)c->plastic_nodes;
    c->hardness_active = c->plastic_nodes > 0;
    c->edge_load_fraction = edge_load(s);
    c->edge_pressure = edge_pressure(s);
    c->approach = /* the largest h is 0 */
        s->it.elastic > 0 || s->load.target > 0 ? rc_tilt_approach(s) : NAN;
    for (size_t a = 0; a < 2; a++)
        c->tilt[a] = rc_tilt_slope(s, a);
    f.mean_h = total[HEIGHT] / n;
    f.mean_u = (total[V] + total[HEIGHT] - total[OWN]) / n;
    if (!blind)
        rc_reduce_blocks(s, spread_block, &f, total);
    for (size_t q = 0; blind && q < RC_SUMS; q++)
        total[q] = NAN;
    scale = sqrt(fmax(total[SPREAD_H], total[SPREAD_U]) / n);
    if (total[SPREAD_H] == 0) /* all heights are equal: both figures would be only error */
        scale = s->op->norm * c->mean_pressure;
    c->kkt_residual = total[RC_MOST] == 0 ? 0 : total[RC_MOST] / scale;
    c->mean_gap = total[OPEN] / n;
    c->elastic_energy = 0.5 * s->posed.cell * total[ENERGY];
    c->gap_error = total[RC_MOST];
    c->shape_error = s->posed.height_error;
    /* With 4 no node of 273 shapes yields when they are pressed again to the load that made them. */
    f.worst = 4 * (c->gap_error + s->posed.height_error) + 1e-12 * scale;
    if (c->hardness_active)
        c->yielded_nodes = yielded(s, &f);
    if (c->yielded_nodes > 0)
        c->shape_error = fmax(c->shape_error, c->gap_error);
    c->yielded_area = s->posed.cell * (double)c->yielded_nodes;
    /* Not after a stop on a coarser grid, where the estimate would take longer than the iteration. */
    if (!early && (stopped || s->it.checked != s->it.iterations || isnan(s->it.error))) {
        rc_working_set_find(s, false);
        rc_iterate_checked(s, rc_working_set_estimate(s), 1);
    }
    c->inherited_error = rc_history_error(s);
    c->pressure_error = rc_tilt_error(s, s->it.error) + c->inherited_error;
    c->converged =
        c->pressure_error <= s->posed.tol && rc_iterate_keeps_load(s) && rc_load_reached(s);
    s->load.error = rc_load_error(s);
    c->pressure_error += s->load.error;
    c->convolutions = s->it.convolutions;
    c->discretization = left_out(s, c);
    s->stage = RC_STAGE_JUDGED;
}
