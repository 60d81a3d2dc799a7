/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Bounds of the conductance G of a network, from any pressures P of its nodes:
 *
 *     G <= sum of k (dP)^2 over the faces, P cut off at 0 and 1     (Dirichlet)
 *     G >= q^2 / sum of f^2/k                                       (Thomson)
 *
 * for flows f through the faces that are conserved at every node and have the sum q at the inlet. They are k
 * dP, plus corrections: the imbalance of each node is sent along the trees of greatest gaps to inlet or
 * outlet.
 */
#include "leak.h"

#include "libcontact/common.h"
#include "libcontact/memory.h"
#include "libcontact/ranks/ranks.h"

struct repair {
    const struct rc_passage *a;
    const struct rc_levels *levels;
    double *down;   /* flow sent from a node to its parent */
    int32_t *order; /* flowing nodes, parents first */
    uint8_t *way;   /* direction to the parent */
    int32_t n;
};

/* P of a node, limited to 0 .. 1. */
static void
level_of(const struct rc_passage *a, const struct rc_levels *levels, int32_t k, double *p,
         double *rest)
{
    *p = k == a->inlet ? 1 : k == a->outlet ? 0 : levels->p[k];
    *rest = k >= a->nodes ? 0 : levels->rest[k];
    if (rc_level_difference(*p, *rest, 1, 0) > 0)
        *p = 1, *rest = 0;
    if (rc_level_difference(*p, *rest, 0, 0) < 0)
        *p = *rest = 0;
}

double
rc_leak_driven(const struct rc_passage *a, const struct rc_levels *levels, int32_t k, int32_t other,
               enum rc_direction d, double *c)
{
    double p, rest, p_other, rest_other;

    level_of(a, levels, k, &p, &rest);
    level_of(a, levels, other, &p_other, &rest_other);
    *c = rc_face(a, RC_HARMONIC, k, other, d);
    return *c * rc_level_difference(p, rest, p_other, rest_other);
}

/* The neighbour of node k with flowing fluid, or -1. */
static int32_t
flowing_beside(const struct rc_passage *a, int32_t k, enum rc_direction d)
{
    int32_t other = rc_passage_beside(a, k, d);

    return other < 0 || other >= a->nodes || a->state[other] == RC_FLOWS ? other : -1;
}

/* The correction of the flow through the face from node k in this direction. */
static double
sent(const struct repair *r, int32_t k, int32_t other, enum rc_direction d)
{
    double f = r->way[k] == d ? r->down[k] : 0;

    if (other < r->a->nodes && r->way[other] == rc_opposite(d))
        f -= r->down[other];
    return f;
}

static void
set_parents(struct repair *r, const uint8_t *tree)
{
    const struct rc_passage *a = r->a;

    for (int32_t k = 0; k < a->nodes; k++) {
        r->way[k] = RC_DIRECTIONS;
        for (int d = RC_ON; d <= RC_BACK && a->state[k] == RC_FLOWS; d++)
            if (tree[k] >> d & 1 && rc_passage_beside(a, k, (enum rc_direction)d) >= a->nodes) {
                r->way[k] = (uint8_t)d;
                r->order[r->n++] = k;
                break;
            }
    }
    for (int32_t m = 0; m < r->n; m++)
        for (int d = 0; d < RC_DIRECTIONS; d++) {
            int32_t k = r->order[m], other = flowing_beside(a, k, (enum rc_direction)d);
            if (!(tree[k] >> d & 1) || other < 0 || other >= a->nodes ||
                r->way[other] != RC_DIRECTIONS)
                continue;
            r->way[other] = (uint8_t)rc_opposite((enum rc_direction)d);
            r->order[r->n++] = other;
        }
}

/* Sends the imbalance of each node to its parent. */
static void
send_down(struct repair *r, int threads)
{
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int32_t k = 0; k < r->a->nodes; k++) {
        if (r->way[k] == RC_DIRECTIONS)
            continue;
        r->down[k] = 0;
        for (int d = 0; d < RC_DIRECTIONS; d++) {
            int32_t other = flowing_beside(r->a, k, (enum rc_direction)d);
            double c;
            if (other >= 0)
                r->down[k] -= rc_leak_driven(r->a, r->levels, k, other, (enum rc_direction)d, &c);
        }
    }
    for (int32_t m = r->n; m-- > 0;) {
        int32_t k = r->order[m], parent = rc_passage_beside(r->a, k, (enum rc_direction)r->way[k]);
        if (parent < r->a->nodes)
            r->down[parent] += r->down[k];
    }
}

enum { /* sums */
    ENERGY,
    DISSIPATED,
    FLOW,
    SUMS
};

static void
add_row(void *ctx, size_t j, double *sums)
{
    const struct repair *r = ctx;
    const int32_t nx = (int32_t)r->a->nx, first = (int32_t)j * nx;
    struct rc_total energy = {0}, dissipated = {0}, flow = {0};

    for (int32_t k = first; k < first + nx; k++)
        for (int d = 0; d < RC_DIRECTIONS && r->way[k] != RC_DIRECTIONS; d++) {
            int32_t other = flowing_beside(r->a, k, (enum rc_direction)d);
            double c, f;
            if (other < 0 || (other < r->a->nodes && (d == RC_BACK || d == RC_UP)))
                continue; /* count each face once */
            f = rc_leak_driven(r->a, r->levels, k, other, (enum rc_direction)d, &c);
            rc_total_add(&energy, f / c * f);
            f += sent(r, k, other, (enum rc_direction)d);
            rc_total_add(&dissipated, f / c * f);
            if (other == r->a->inlet)
                rc_total_add(&flow, -f);
        }
    sums[ENERGY] = rc_total_value(&energy);
    sums[DISSIPATED] = rc_total_value(&dissipated);
    sums[FLOW] = rc_total_value(&flow);
}

enum rc_status
rc_leak_bounds(const struct rc_passage *a, const uint8_t *tree, const struct rc_levels *levels,
               int threads, double *lower, double *upper, struct rc_err *err)
{
    size_t n = (size_t)a->nodes;
    struct repair r = {.a = a, .levels = levels};
    RC_ENDS(rc_store_free) struct rc_store own = {0};
    RC_OWNED double *partial = NULL;
    struct rc_sums rows;
    double sums[SUMS];

    r.down = rc_store_take(&own, n, sizeof *r.down);
    r.order = rc_store_take(&own, n, sizeof *r.order);
    r.way = rc_store_take(&own, n, sizeof *r.way);
    own.failed |= rc_sums_new(&rows, NULL, a->ny, SUMS, 0, threads) != RC_OK;
    partial = rows.row;
    if (own.failed)
        return rc_err_set(err, "out of memory for the bounds of the flow through %zu x %zu nodes",
                          a->nx, a->ny);
    set_parents(&r, tree);
    send_down(&r, threads);
    rc_sums_rows(&rows, add_row, &r, sums);
    *upper = sums[ENERGY];
    *lower = sums[FLOW] / sums[DISSIPATED] * sums[FLOW];
    return RC_OK;
}
