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
     "Error of the largest pressure by the grid", ERROR("grid", "max_pressure")},
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

/* Nodes in contact with a neighbour out of contact. */
static size_t
edge_nodes(const struct rc_solver *s)
{
    const struct rc_rows *rows = &s->posed.rows;
    size_t nx = s->posed.shape.nx, ny = s->posed.shape.ny, count = 0;
    const double low = s->posed.bounds.box.low;
    double before[RC_ROW_PIECE], after[RC_ROW_PIECE];
    bool has[2] = {false, false};

    for (size_t first = 0; first < nx; first += RC_ROW_PIECE) {
        size_t last = nx - first < RC_ROW_PIECE ? nx : first + RC_ROW_PIECE;
        if (rows->ranks != NULL)
            rc_ranks_beside(rows, false, (last - first) * sizeof *before, s->it.p + first,
                            s->it.p + (ny > 0 ? (ny - 1) * nx : 0) + first, before, after, has);
        for (size_t j = 0; j < ny; j++) {
            const double *p = s->it.p + j * nx;
            const double *above = j > 0 ? p + first - nx : has[0] ? before : p + first;
            const double *below = j + 1 < ny ? p + first + nx : has[1] ? after : p + first;
            for (size_t i = first; i < last; i++)
                count +=
                    p[i] > low && ((i > 0 && p[i - 1] <= low) || (i + 1 < nx && p[i + 1] <= low) ||
                                   above[i - first] <= low || below[i - first] <= low);
        }
    }
    return rc_ranks_sum(rows->ranks, count);
}

/* The discretization error, from a comparison with half the nodes a side. Peak pressure and approach converge
 * at least with the first power of the spacing. So their error is at most the difference of the two grids.
 * The error of the area is erratic, and at most half a cell along the edge. */
static struct rc_discretization
left_out(const struct rc_solver *s, const struct rc_contact *c)
{
    struct rc_discretization d = {NAN, NAN, NAN};

    if (isnan(s->coarse.max_pressure))
        return d;
    d.max_pressure = fabs(s->coarse.max_pressure / c->max_pressure - 1);
    d.approach = fabs(s->coarse.approach / c->approach - 1);
    d.contact_area = 0.5 * (double)edge_nodes(s) / (double)c->contact_nodes;
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
