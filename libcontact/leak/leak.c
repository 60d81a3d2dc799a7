/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Leakage: pressure drives fluid through the gap from one edge of the map to the opposite one. Reynolds'
 * equation without sliding holds: div(g^3 grad P) = 0. The flow is steady and thin: inertia, slip and slopes
 * across the film are neglected, and the fluid does not deform the bodies.
 *
 * A node is a cell of uniform gap. Flow passes through the faces of cells (finite volumes, faces.c), and over
 * half a cell at inlet and outlet. Contact is where the pressure is positive; the gap cannot decide this,
 * because in contact it is 0 only within the tolerance of the contact.
 */
#include "leak.h"

#include <math.h>
#include <stdlib.h>

#include "libcontact/common.h"
#include "libcontact/expected.h"
#include "libcontact/memory.h"

enum stage {
    STAGE_LINEAR,
    STAGE_HARMONIC,
    STAGE_DONE
};

struct rc_leak {
    struct rc_shape shape;
    bool down;            /* fluid flows from the first row to the last */
    double along, across; /* sides of a cell, m                         */
    double largest;       /* gap, m                                     */
    int threads;
    struct rc_passage a;
    struct rc_store own;
    uint8_t *tree;
    struct rc_levels levels; /* pressures of the nodes of the passage; p NAN: no fluid, or
                                unknown */
    struct rc_elimination *elimination;
    enum stage stage;
    struct rc_leak_figures figures;
};

/* A map of more flowing nodes than `whole` computes the rows of regions below `again` nodes a second time. */
static const int32_t whole = 1 << 22, again = 1 << 16;

/* A gap below this fraction of the largest is closed; its cube is still a normal number. Half and
 * double change no bit (2 gaps of bench/constants.py). */
static const double closed = 1e-30;

#define FIGURE(member) RC_FIGURE(struct rc_leak_figures, member)
#define AS(column, member) RC_FIGURE_AS(column, struct rc_leak_figures, member)
const struct rc_figure rc_figures_leak[] = {
    {AS("flow_conductance", conductance), "m3", "Flow conductance"},
    {AS("flow_conductance_linear", conductance_linear), "m3", "Flow conductance, linear faces"},
    {AS("conductance_lower", lower), "m3", "Lower bound of the conductance"},
    {AS("conductance_upper", upper), "m3", "Upper bound of the conductance"},
    {AS("discretization_error_estimate", error), NULL, "Error of the grid",
     .says = "estimated, relative", .role = RC_FIGURE_ERROR, .by = "grid", .of = "flow_conductance",
     .limit = 0.05, .warning = "the grid is too coarse for the flow"},
    {FIGURE(flow_factor), NULL, "Flow factor", .says = "of Patir and Cheng"},
    {FIGURE(shear_flow_factor), NULL, "Shear flow factor", .says = "of Patir and Cheng",
     .of = "gap_rms"},
    {FIGURE(shear_stress_factor), NULL, "Shear stress factor",
     .says = "of the fluid pressure, of Patir and Cheng"},
    {FIGURE(mean_gap), "m", "Mean gap", .says = "over the whole map"},
    {FIGURE(gap_rms), "m", "RMS deviation of the gap from its mean", .says = "over the whole map"},
    {AS("gap_slope", slope), NULL, "RMS slope of the gap", .says = "where fluid flows",
     .role = RC_FIGURE_CHECK, .limit = 0.3,
     .warning = "the slope of the gap is beyond the theory of thin films"},
    {FIGURE(percolates), NULL, "Percolates", .says = "through the edges of cells"},
    {FIGURE(percolates_diagonal), NULL, "Percolates diagonally",
     .says = "through the corners of cells too"},
    {FIGURE(critical_gap), "m", "Critical gap", .says = "narrowest place of the widest path"},
    {FIGURE(critical_x), "m", "Place of the critical gap along x"},
    {FIGURE(critical_y), "m", "Place of the critical gap along y"},
    {FIGURE(throat_nodes), NULL, "Nodes across the critical gap", .role = RC_FIGURE_CHECK},
    {FIGURE(fluid_nodes), NULL, "Nodes with fluid"},
    {FIGURE(dead_nodes), NULL, "Nodes where fluid stands"},
    {FIGURE(unknowns), NULL, "Nodes where fluid flows", .role = RC_FIGURE_COST},
    {0},
};

/* ---- the passage ---- */

/* The place of node k of the passage in the map. */
static size_t
place_in_map(const struct rc_leak *l, size_t k)
{
    return l->down ? k % l->a.nx * l->shape.nx + k / l->a.nx : k;
}

static enum rc_status
check(const struct rc_shape *s, const double *p, const double *g, const struct rc_leak_options *o,
      struct rc_err *err)
{
    if (rc_shape_check(s, err) != RC_OK)
        return RC_FAIL;
    if (o->direction != 0 && o->direction != 'x' && o->direction != 'y')
        return rc_err_set(err, "a direction of flow is x or y, not '%c'", o->direction);
    if (s->nx * s->ny > INT32_MAX - 2)
        return rc_err_set(err, "%zu x %zu nodes are more than 32-bit counts allow: cut the map",
                          s->nx, s->ny);
    for (size_t k = 0; k < s->nx * s->ny; k++)
        if (!isfinite(g[k]) || (p != NULL && !isfinite(p[k])))
            return rc_err_set(
                err, "node (%zu, %zu) has no finite %s, but both gap and pressure must be finite",
                k % s->nx, k / s->nx, isfinite(g[k]) ? "pressure" : "gap");
    return RC_OK;
}

static void
set_gap(struct rc_leak *l, const double *p, const double *g)
{
    struct rc_total sum = {0};
    struct rc_passage *a = &l->a;

    l->largest = 0;
    l->figures = (struct rc_leak_figures){0};
    for (int32_t k = 0; k < a->nodes; k++) {
        size_t at = place_in_map(l, (size_t)k);
        a->g[k] = (p == NULL || !rc_in_contact(p[at])) && g[at] > 0 ? g[at] : 0;
        l->largest = fmax(l->largest, a->g[k]);
        rc_total_add(&sum, a->g[k]);
    }
    l->figures.mean_gap = rc_total_value(&sum) / (double)a->nodes;
    sum = (struct rc_total){0};
    for (int32_t k = 0; k < a->nodes; k++) {
        double off = l->largest > 0 ? (a->g[k] - l->figures.mean_gap) / l->largest : 0;
        rc_total_add(&sum, off * off);
        a->g[k] = a->g[k] > closed * l->largest ? a->g[k] / l->largest : 0;
        l->figures.fluid_nodes += a->g[k] > 0;
    }
    l->figures.gap_rms = l->largest * sqrt(rc_total_value(&sum) / (double)a->nodes);
}

/* RMS slope of the gap where fluid flows, from differences between neighbours. */
static double
slope_of(const struct rc_leak *l)
{
    static const enum rc_direction ways[] = {RC_ON, RC_DOWN};
    const double side[] = {l->along, l->across};
    const struct rc_passage *a = &l->a;
    double square = 0;

    for (int w = 0; w < 2; w++) {
        double sum = 0;
        size_t n = 0;
        for (int32_t k = 0; k < a->nodes; k++) {
            int32_t other = a->state[k] == RC_FLOWS ? rc_passage_beside(a, k, ways[w]) : -1;
            double step;
            if (other < 0 || other >= a->nodes || a->state[other] != RC_FLOWS)
                continue;
            step = (a->g[other] - a->g[k]) * l->largest / side[w];
            sum += step * step;
            n++;
        }
        square += n > 0 ? sum / (double)n : 0;
    }
    return l->figures.unknowns > 0 ? sqrt(square) : NAN;
}

static void
set_figures(struct rc_leak *l, const struct rc_critical *critical)
{
    const struct rc_shape *s = &l->shape;
    struct rc_leak_figures *f = &l->figures;

    for (int32_t k = 0; k < l->a.nodes; k++)
        f->dead_nodes += l->a.state[k] == RC_DEAD;
    f->unknowns = f->fluid_nodes - f->dead_nodes;
    f->slope = slope_of(l);
    f->percolates = critical->percolates;
    f->percolates_diagonal = critical->percolates_diagonal;
    f->throat_nodes = critical->width;
    f->critical_x = f->critical_y = NAN;
    f->error = NAN;
    if (critical->percolates) {
        size_t at = place_in_map(l, (size_t)critical->node);
        f->critical_gap = l->a.g[critical->node] * l->largest;
        f->critical_x = ((double)(at % s->nx) - (double)(s->nx - 1) / 2) * s->dx;
        f->critical_y = ((double)(at / s->nx) - (double)(s->ny - 1) / 2) * s->dy;
    }
}

static struct rc_leak *
new_passage(const struct rc_shape *s, const struct rc_leak_options *o, struct rc_err *err)
{
    RC_OWN(rc_leak, l) = calloc(1, sizeof *l);
    size_t n = s->nx * s->ny;

    if (l == NULL)
        return rc_err_null(err, "out of memory for a plan");
    l->shape = *s;
    l->down = o->direction == 'y';
    l->along = l->down ? s->dy : s->dx;
    l->across = l->down ? s->dx : s->dy;
    l->threads = rc_useful_threads(s, o->threads);
    l->a = (struct rc_passage){.nx = l->down ? s->ny : s->nx,
                               .ny = l->down ? s->nx : s->ny,
                               .nodes = (int32_t)n,
                               .inlet = (int32_t)n,
                               .outlet = (int32_t)n + 1,
                               .aspect = l->across / l->along,
                               .around = o->around};
    l->a.g = rc_store_take(&l->own, n, sizeof *l->a.g);
    l->a.state = rc_store_take(&l->own, n, 1);
    l->tree = rc_store_take(&l->own, n, 1);
    if (l->own.failed)
        return rc_err_null(err, "out of memory for the gap of %zu x %zu nodes", s->nx, s->ny);
    return rc_give(&l);
}

/* Takes the gap, and finds the percolating path while other threads find the order of elimination. */
static enum rc_status
begin(struct rc_leak *l, const double *p, const double *g, struct rc_err *err)
{
    struct rc_critical critical;
    const size_t n = (size_t)l->a.nodes + 2; /* inlet and outlet too */
    enum rc_status path = RC_OK;
    struct rc_err of_path;

    set_gap(l, p, g);
    rc_elimination_free(l->elimination);
    l->elimination = NULL;
    free(l->levels.p);
    l->levels.p = NULL;
    l->stage = STAGE_LINEAR;
#pragma omp parallel num_threads(l->threads)
#pragma omp single
    {
#pragma omp task shared(path, critical, of_path)
        path = rc_percolation(&l->a, &critical, l->tree, &of_path);
        if (rc_blocks(&l->a, err) == RC_OK)
            l->elimination = rc_elimination_new(&l->a, l->threads, err);
    }
    if (path != RC_OK)
        *err = of_path;
    if (path != RC_OK || l->elimination == NULL)
        return RC_FAIL;
    l->levels.p = rc_alloc(2 * n, sizeof *l->levels.p);
    if (l->levels.p == NULL)
        return rc_err_set(err, "out of memory for the pressures of %zu nodes", n);
    l->levels.rest = l->levels.p + n;
    set_figures(l, &critical);
    return RC_OK;
}

struct rc_leak *
rc_leak_new(const struct rc_shape *shape, const double *p, const double *g,
            const struct rc_leak_options *options, struct rc_err *err)
{
    RC_OWN(rc_leak, l) = NULL;

    if (check(shape, p, g, options, err) != RC_OK || (l = new_passage(shape, options, err)) == NULL)
        return NULL;
    return begin(l, p, g, err) == RC_OK ? rc_give(&l) : NULL;
}

enum rc_status
rc_leak_set_gap(struct rc_leak *l, const double *p, const double *g, struct rc_err *err)
{
    return check(&l->shape, p, g, &(struct rc_leak_options){0}, err) == RC_OK ? begin(l, p, g, err)
                                                                              : RC_FAIL;
}

/* ---- steps ---- */

/* <g dP/dx> for the unit gradient of P, by the faces along the flow. Still fluid has no part in it. One face
 * slides at U along the flow and the rough one is at rest: U/2 times this is the flow per width, because
 * q = U g/2 - g^3 grad p and div q = 0 with p = 0 at both edges give Q = - integral of q grad P. */
static double
dragged_gap(const struct rc_leak *l)
{
    const struct rc_passage *a = &l->a;
    struct rc_total sum = {0};

    for (int32_t k = 0; k < a->nodes; k++)
        for (int side = 0; side < 2 && a->state[k] == RC_FLOWS; side++) {
            enum rc_direction d = side == 0 ? RC_ON : RC_BACK;
            int32_t other = rc_passage_beside(a, k, d);
            double c, flow;
            if (other < 0 || (other < a->nodes && (d == RC_BACK || a->state[other] != RC_FLOWS)))
                continue; /* count each face once */
            flow = rc_leak_driven(a, &l->levels, k, other, d, &c);
            rc_total_add(&sum, (side == 0 ? 1 : -1) * flow / c * rc_face_drag(a, k, other));
        }
    return rc_total_value(&sum) / (double)a->ny * l->largest;
}

/* A gap that varies by less than this part of its mean is even: rounding hides its factor. Half and
 * double change no bit (2 gaps of bench/constants.py). */
static const double even = 1e-8;

static void
set_shear(struct rc_leak *l)
{
    struct rc_leak_figures *f = &l->figures;
    double gap = dragged_gap(l);

    f->shear_stress_factor = f->mean_gap > 0 ? gap / f->mean_gap : 0;
    f->shear_flow_factor = f->gap_rms > even * f->mean_gap ? (gap - f->mean_gap) / f->gap_rms : NAN;
}

struct rc_expected
rc_leak_expect(size_t fluid, size_t threads)
{
    static const double bytes[] = RC_LEAK_BYTES;
    const double cores = (double)(threads == 0 ? rc_threads_available() : threads);

    return (struct rc_expected){.convolutions = NAN,
                                .seconds = RC_LEAK_NODE * (double)fluid *
                                           pow((double)fluid / 262144, 1.0 / 7) * 2 / cores,
                                .memory = (size_t)(bytes[fluid > (size_t)whole] * (double)fluid)};
}

static enum rc_status
step_linear(struct rc_leak *l, struct rc_err *err)
{
    double size = l->largest * l->largest * l->largest;

    if (rc_elimination_run(l->elimination, RC_LINEAR, NULL, 0, &l->figures.conductance_linear,
                           err) != RC_OK)
        return RC_FAIL;
    l->figures.conductance_linear *= size;
    return RC_MORE;
}

static enum rc_status
step_harmonic(struct rc_leak *l, struct rc_err *err)
{
    double size = l->largest * l->largest * l->largest;
    double wide = (double)l->a.ny * l->across, mean = l->figures.mean_gap;
    struct rc_leak_figures *f = &l->figures;
    const int32_t keep = f->unknowns <= (size_t)whole ? 0 : again;

    if (l->elimination != NULL) {
        if (rc_elimination_run(l->elimination, RC_HARMONIC, &l->levels, keep, &f->conductance,
                               err) != RC_OK)
            return RC_FAIL;
        rc_elimination_free(l->elimination); /* the next step needs the memory */
        l->elimination = NULL;
        f->conductance *= size;
    }
    if (rc_blocks_fill(&l->a, &l->levels, err) != RC_OK)
        return RC_FAIL;
    if (f->percolates) {
        if (rc_leak_bounds(&l->a, l->tree, &l->levels, l->threads, &f->lower, &f->upper, err) !=
            RC_OK)
            return RC_FAIL;
        f->lower *= size;
        f->upper *= size;
        f->error = (f->conductance_linear - f->conductance) / (2 * f->conductance);
    }
    f->flow_factor =
        mean > 0 ? f->conductance * ((double)l->a.nx * l->along) / (wide * mean * mean * mean) : 0;
    set_shear(l);
    return RC_OK;
}

enum rc_status
rc_leak_step(struct rc_leak *l, struct rc_err *err)
{
    enum rc_status status = RC_OK;

    if (l->stage == STAGE_LINEAR)
        status = step_linear(l, err);
    else if (l->stage == STAGE_HARMONIC)
        status = step_harmonic(l, err);
    if (status == RC_MORE || status == RC_OK)
        l->stage = l->stage == STAGE_LINEAR ? STAGE_HARMONIC : STAGE_DONE;
    return status;
}

const struct rc_leak_figures *
rc_leak_result(const struct rc_leak *l)
{
    return &l->figures;
}

/* ---- maps ---- */

void
rc_leak_pressure(const struct rc_leak *l, double *pressure)
{
    size_t n = l->shape.nx * l->shape.ny;

#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t k = 0; k < n; k++)
        pressure[place_in_map(l, k)] = l->levels.p[k];
}

/* Flux along a direction, m^2: the mean of the flows through the two faces. */
static double
flux_along(const struct rc_leak *l, int32_t k, enum rc_direction d)
{
    const struct rc_passage *a = &l->a;
    double sum = 0;

    for (int side = 0; side < 2; side++, d = rc_opposite(d)) {
        int32_t other = rc_passage_beside(a, k, d);
        double c;
        if (other < 0 || (other < a->nodes && a->state[other] != RC_FLOWS))
            continue;
        sum += (side == 0 ? 1 : -1) * rc_leak_driven(a, &l->levels, k, other, d, &c);
    }
    return sum / 2 * l->largest * l->largest * l->largest /
           (d == RC_ON || d == RC_BACK ? l->across : l->along);
}

void
rc_leak_flux(const struct rc_leak *l, double *flux)
{
#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (int32_t k = 0; k < l->a.nodes; k++) {
        double q = l->a.state[k] == RC_DRY ? NAN : 0;
        if (l->a.state[k] == RC_FLOWS)
            q = hypot(flux_along(l, k, RC_ON), flux_along(l, k, RC_DOWN));
        flux[place_in_map(l, (size_t)k)] = q;
    }
}

void
rc_leak_channel(const struct rc_leak *l, double *channel)
{
    for (size_t k = 0; k < l->shape.nx * l->shape.ny; k++)
        channel[place_in_map(l, k)] = l->a.state[k];
}

void
rc_leak_free(struct rc_leak *l)
{
    if (l == NULL)
        return;
    free(l->levels.p);
    rc_elimination_free(l->elimination);
    rc_store_free(&l->own);
    free(l);
}
