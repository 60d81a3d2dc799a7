/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The slabs of a body that may yield, from the stresses under the elastic pressure. Yielding spreads the
 * pressure, so that plastic strain does not reach as deep as the elastic stress suggests. The stresses are
 * found at the middles of a coarse stack; the slabs are thinner.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"
#include "yield.h"

enum {
    MOST = 160,  /* most slabs */
    HALVINGS = 3 /* most times that each slab is halved */
};
/* Of the stack where the stresses are found: the first slab in nodes, and the growth of the thickness from
 * slab to slab, because the stress changes over lengths as large as its depth. */
static const double looked_first = 0.5, looked_growth = 0.25;
/* The same of the slabs, if they need a scale of 1. The error of each pair of slabs is then about the
 * same: the strain changes most at the edges of spots, within the first node. */
static const double slab_first = 0.1, slab_growth = 0.12;
/* At this scale, the change of the pressure by pairs of slabs is `pairs` times the largest elastic Mises
 * stress over the yield stress to the power `of_stress`, times the number of nodes in contact to the power
 * `of_nodes`. On 99 random maps of 8 to 64 nodes a side it differed from that by a factor of 1.6 (RMS). It
 * falls with the square of the scale. */
static const double pairs = 4.1e-3, of_stress = 1.37, of_nodes = -0.33;
/* The bounds of the scale. */
static const double scale_least = 0.25, scale_most = 1.5;
/* Of the largest excess of the Mises stress over the yield stress: the least that the voxels resolve.
 * Otherwise the slabs are halved. Without halving, 44 of 320 bodies with a Mises stress of 1.05 to 1.3 times
 * the yield stress remain elastic (tests/long/estimates.py). */
static const double resolved = 0.5;
/* The slabs are halved if the largest Mises stress over the yield stress is above the first number, and
 * its value at the middles is below the second one. */
static const double worth = 1.02, clear = 1.5;
/* Of the largest Mises stress at the middles: between slabs with less the stress is not searched. */
static const double searched = 0.5;

/* The stresses under a pressure, depth by depth. */
struct probe {
    const struct rc_shape *shape;
    const struct rc_problem *contact;
    const double *p; /* Pa */
    double yield;    /* Pa */
    double *map;     /* Pa: Mises stress at a depth */
    size_t nodes;    /* of this rank */
};

/* True if the caller cannot wait. Ranks always wait: a signal reaches them at different times. */
static bool
hurried(const struct probe *q)
{
    return q->contact->ranks == NULL && q->contact->hurry != NULL && *q->contact->hurry != 0;
}

/* Finds the largest Mises stress at each depth, and the number of nodes with more than the yield stress.
 * RC_MORE: the caller cannot wait. */
static enum rc_status
look(const struct probe *q, size_t n, const double *depth, double *mises, size_t *beyond,
     struct rc_err *err)
{
    const struct rc_stress_options options = {.boundary = q->contact->boundary,
                                              .body = q->contact->pair.one,
                                              .wanted = 1U << RC_MISES,
                                              .tol = 1e-3,
                                              .depth = depth,
                                              .depths = n,
                                              .threads = q->contact->threads,
                                              .ranks = q->contact->ranks};
    const size_t nodes = q->nodes;
    double *const to[RC_STRESSES] = {[RC_MISES] = q->map};
    enum rc_status status = RC_OK;
    struct rc_stress *stress;

    if (n == 0)
        return RC_OK;
    stress = rc_stress_new(q->shape, q->p, &options, err);
    if (stress == NULL)
        return RC_FAIL;
    for (size_t k = 0; k < n && status == RC_OK; k++) {
        struct rc_total above = {0};
        double sum;
        if (hurried(q)) {
            status = RC_MORE;
            break;
        }
        status = rc_stress_slice(stress, depth[k], to, err);
        if (status != RC_OK)
            break;
        mises[k] = rc_highest(q->map, nodes);
        for (size_t i = 0; i < nodes; i++)
            above.sum += q->map[i] > q->yield;
        rc_ranks_totals(q->contact->ranks, 1, &above, &sum, 1, &mises[k]);
        beyond[k] = (size_t)sum;
    }
    rc_stress_free(stress);
    return status;
}

/* The stack of slabs, each halved some times. */
struct stack {
    size_t n;
    double thickness[MOST << HALVINGS], middle[MOST << HALVINGS]; /* m */
    double mises[MOST << HALVINGS];                               /* Pa, the largest of a slab */
    size_t beyond[MOST << HALVINGS];                              /* nodes above the yield stress */
    double sum[MOST << HALVINGS];                                 /* the same, over the ranks */
};

static int
by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* Makes slabs down to a depth or beyond it. Returns the depth of the last one. */
static double
fill_stack(struct stack *s, double depth, double first, double growth)
{
    double z = 0;

    s->n = 0;
    for (double dz = first; s->n < MOST && z < depth; dz *= 1 + growth) {
        s->thickness[s->n] = dz;
        s->middle[s->n++] = z + dz / 2;
        z += dz;
    }
    return z;
}

/* Replaces the slabs by thinner ones, whose pairs change the pressure by about `wanted`. Each has the nodes
 * above the yield stress of the slab that it lies in. */
static void
make_thinner(struct stack *s, const struct rc_yield_depths *d, double yield, size_t touching,
             double step)
{
    const struct stack from = *s;
    const double change = pairs * pow(d->most / yield, of_stress) *
                          pow(fmax((double)touching, 1), of_nodes),
                 scale = fmin(fmax(sqrt(d->wanted / change), scale_least), scale_most);
    double bottom = 0, depth = 0, reached;
    size_t in = 0;

    for (size_t k = 0; k < from.n; k++)
        depth += from.thickness[k];
    reached = fill_stack(s, depth, slab_first * scale * step, slab_growth * scale);
    for (size_t k = 0; k < s->n; k++) {
        s->thickness[k] *= depth / reached;
        s->middle[k] *= depth / reached;
        while (in + 1 < from.n && bottom + from.thickness[in] < s->middle[k])
            bottom += from.thickness[in++];
        s->beyond[k] = from.beyond[in];
    }
}

/* Looks at the faces of the slabs and at the depths that rc_stress_depths chooses, between slabs with much
 * stress. Sets the largest Mises stress, its depth, and the largest depth with more than the yield stress. */
static enum rc_status
look_between(const struct probe *q, const struct stack *s, struct rc_yield_depths *d, double *reach,
             struct rc_err *err)
{
    RC_OWNED double *more = NULL, *depth = NULL, *mises = NULL;
    RC_OWNED size_t *beyond = NULL;
    size_t automatic, all, n = 0, k = 0;
    enum rc_status status;

    if (rc_stress_depths(q->contact->ranks, q->shape, q->p, q->contact->boundary,
                         &q->contact->pair.one, &more, &automatic, err) != RC_OK)
        return RC_FAIL;
    all = automatic + s->n;
    depth = rc_alloc(all, sizeof *depth);
    mises = rc_alloc(all, sizeof *mises);
    beyond = rc_alloc(all, sizeof *beyond);
    if (rc_ranks_need(q->contact->ranks, depth != NULL && mises != NULL && beyond != NULL, err,
                      "out of memory for %zu depths", all) != RC_OK)
        return RC_FAIL;
    memcpy(depth, more, automatic * sizeof *depth);
    for (size_t i = 0; i < s->n; i++)
        depth[automatic + i] = i > 0 ? depth[automatic + i - 1] + s->thickness[i - 1] : 0;
    qsort(depth, all, sizeof *depth, by_size);
    for (size_t i = 0; i < all; i++) {
        while (k < s->n && s->middle[k] < depth[i])
            k++;
        if (fmax(k > 0 ? s->mises[k - 1] : 0, k < s->n ? s->mises[k] : 0) > searched * d->most &&
            (n == 0 || depth[i] > depth[n - 1]))
            depth[n++] = depth[i];
    }
    d->looked += n;
    status = look(q, n, depth, mises, beyond, err);
    for (size_t i = 0; i < n && status == RC_OK; i++) {
        if (mises[i] > d->most) {
            d->most = mises[i];
            d->deepest = depth[i];
        }
        if (mises[i] > q->yield)
            *reach = depth[i];
    }
    return status;
}

/* The stresses of the voxels, for keep_largest. */
struct seen {
    struct stack *s;
    const struct rc_slabs *slabs;
    size_t nx;
    double yield; /* Pa */
};

/* Keeps the largest Mises stress of a row of a slab. */
static void
keep_largest(void *ctx, size_t slab, size_t j, double *const c[RC_COMPONENTS])
{
    const struct seen *seen = ctx;
    double most = 0;
    const size_t level = rc_slabs_level(seen->slabs, slab);
    size_t beyond = 0;

    (void)j;
    for (size_t i = 0; i < seen->nx >> level; i++) {
        const double at[RC_DEVIATOR] = {c[RC_SXX][i], c[RC_SYY][i], c[RC_SXY][i], c[RC_SXZ][i],
                                        c[RC_SYZ][i]};
        const double mises = rc_mises_of(at);
        most = fmax(most, mises);
        beyond += (size_t)(mises > seen->yield) << 2 * level;
    }
#pragma omp critical
    {
        seen->s->mises[slab] = fmax(seen->s->mises[slab], most);
        seen->s->beyond[slab] += beyond;
    }
}

/* Finds the largest mean stress of the slabs, which is the stress of their voxels. */
static enum rc_status
look_at_voxels(const struct probe *q, struct stack *s, double *most, struct rc_err *err)
{
    struct seen seen = {s, NULL, q->shape->nx, q->yield};
    const struct rc_slab_stress stress = {.row = keep_largest, .ctx = &seen};
    const bool strained[MOST << HALVINGS] = {false};
    const struct rc_slab_strain none = {.strained = strained};
    const struct rc_slabs_options options = {.slabs = s->n,
                                             .thickness = s->thickness,
                                             .shear = 1, /* Pa; without strain it has no effect */
                                             .nu = q->contact->pair.one.nu,
                                             .boundary = q->contact->boundary,
                                             .coarser = RC_YIELD_COARSER,
                                             .precision = RC_SINGLE,
                                             .threads = q->contact->threads,
                                             .ranks = q->contact->ranks};
    RC_OWN(rc_slabs, slabs) = rc_slabs_new(q->shape, &options, err);

    if (slabs == NULL)
        return RC_FAIL;
    seen.slabs = slabs;
    memset(s->mises, 0, s->n * sizeof *s->mises);
    memset(s->beyond, 0, s->n * sizeof *s->beyond);
    rc_slabs_up(slabs, &none, NULL);
    rc_slabs_down(slabs, q->p, &stress);
    for (size_t k = 0; k < s->n; k++)
        s->sum[k] = (double)s->beyond[k];
    rc_ranks_each_most(q->contact->ranks, s->n, s->mises);
    rc_ranks_each_sum(q->contact->ranks, s->n, s->sum);
    *most = 0;
    for (size_t k = 0; k < s->n; k++) {
        s->beyond[k] = (size_t)s->sum[k];
        *most = fmax(*most, s->mises[k]);
    }
    return RC_OK;
}

/* Halves each slab as often as asked, and until the voxels resolve the yield. */
static enum rc_status
resolve(const struct probe *q, struct stack *s, struct rc_yield_depths *d, struct rc_err *err)
{
    const double wanted = q->yield + resolved * (d->most - q->yield);
    const size_t least = d->halved;
    double most = 0, thickness[MOST << HALVINGS];

    for (d->halved = 0;; d->halved++) {
        const struct rc_yield_depths whole = {.slabs = s->n, .thickness = s->thickness};
        if (hurried(q))
            return RC_MORE;
        if (d->halved >= least && look_at_voxels(q, s, &most, err) != RC_OK)
            return RC_FAIL;
        if (most >= wanted || d->halved == HALVINGS)
            return RC_OK;
        rc_yield_solver_stack(&whole, 2 * s->n, thickness);
        s->n *= 2;
        memcpy(s->thickness, thickness, s->n * sizeof *thickness);
    }
}

enum rc_status
rc_yield_depths(const struct rc_shape *shape, const struct rc_problem *contact, const double *p,
                double yield, struct rc_yield_depths *d, struct rc_err *err)
{
    const size_t nodes = shape->nx * shape->ny;
    const double side = fmax((double)shape->nx * shape->dx, (double)shape->ny * shape->dy);
    const double step = shape->nx == 1   ? shape->dy
                        : shape->ny == 1 ? shape->dx
                                         : fmin(shape->dx, shape->dy);
    const size_t here = rc_rows_of(contact->ranks, shape).n * shape->nx;
    RC_OWNED double *map = rc_alloc(here, sizeof *map);
    RC_OWNED struct stack *s = malloc(sizeof *s);
    const struct probe q = {shape, contact, p, yield, map, here};
    enum rc_status status;
    double reach = 0, most;
    size_t n = 0, touching = 0;

    *d = (struct rc_yield_depths){.halved = d->halved, .wanted = d->wanted};
    if (rc_ranks_need(contact->ranks, map != NULL && s != NULL, err,
                      "out of memory for the stresses of %zu x %zu nodes", shape->nx,
                      shape->ny) != RC_OK)
        return RC_FAIL;
    (void)fill_stack(s, side / 2, looked_first * step, looked_growth);
    d->looked = s->n;
    status = look(&q, s->n, s->middle, s->mises, s->beyond, err);
    for (size_t k = 0; k < s->n && status == RC_OK; k++)
        if (s->mises[k] > d->most) {
            d->most = s->mises[k];
            d->deepest = s->middle[k];
        }
    most = d->most;
    if (status == RC_OK)
        status = look_between(&q, s, d, &reach, err);
    if (status != RC_OK || d->most <= yield)
        return status;
    for (size_t k = 0; k < s->n; k++)
        if (most > yield ? s->mises[k] > yield : s->middle[k] < reach)
            n = k + 1;
    s->n = n < s->n ? n + 1 : n;
    for (size_t k = 0; k < here; k++)
        touching += rc_in_contact(p[k]);
    make_thinner(s, d, yield, rc_ranks_sum(contact->ranks, touching), step);
    if (d->halved > 0 || (most < clear * yield && d->most > worth * yield))
        status = resolve(&q, s, d, err);
    if (status != RC_OK)
        return status;
    d->slabs = s->n;
    d->thickness = malloc(d->slabs * sizeof *d->thickness);
    if (rc_ranks_need(contact->ranks, d->thickness != NULL, err, "out of memory for the depths") !=
        RC_OK)
        return RC_FAIL;
    memcpy(d->thickness, s->thickness, d->slabs * sizeof *d->thickness);
    for (size_t k = 0; k < d->slabs; k++)
        d->part += (double)s->beyond[k] / (double)(d->slabs * nodes);
    return RC_OK;
}

/* Keeps the growth of the computed stack. Each slab is divided or joined alike, so that the ratio of
 * thicknesses changes with the number of slabs. */
void
rc_yield_solver_stack(const struct rc_yield_depths *found, size_t n, double *thickness)
{
    double depth = 0, first, ratio;

    if (n == found->slabs) {
        memcpy(thickness, found->thickness, n * sizeof *thickness);
        return;
    }
    for (size_t k = 0; k < found->slabs; k++)
        depth += found->thickness[k];
    first = found->slabs > 1 ? found->thickness[1] / found->thickness[0] : 1;
    ratio = pow(first, (double)found->slabs / (double)n);
    first = ratio > 1 ? depth * (ratio - 1) / (pow(ratio, (double)n) - 1) : depth / (double)n;
    for (size_t k = 0; k < n; k++, first *= ratio)
        thickness[k] = first;
}
