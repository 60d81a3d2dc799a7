/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Projected nonlinear conjugate gradients on the gap. The preconditioner is K on the nodes outside contact,
 * in single precision: because K A = 1, it leaves only the effects of contact and traction. A step costs A d
 * and K r, and, when a node has reached 0, A times the clipped part. Along the direction Phi is known without
 * a convolution.
 */
#include "gap.h"

#include <stdlib.h>
#include <string.h>

/* Part of the free nodes: if more reach 0 in a step, CG restarts. Not sensitive: half and double change
 * the convolutions of 9 pull-offs by less than 1 % (bench/constants.py). */
static const double clipped_anew = 0.02;
/* Factor of d'A d: the least curvature that a step assumes. Not sensitive: half and double change no
 * convolution (27 runs of bench/constants.py). */
static const double curvature = 0.05;
/* Factor of a step that rises. Not sensitive: half and double change the convolutions by at most 1 %
 * (27 runs of bench/constants.py). */
static const double shorter = 0.4;
/* Error of A d in single precision, some ten roundings of 1.2e-7. Half and double change no bit. */
static const double single = 1e-6;
/* Error of the pressures of a step, L1: the rounding of single precision. Half and double change the
 * estimate by at most 10 %. */
static const double float_rounding = 1.2e-7;
/* Relative to the largest traction: rounding of the sum of a map. Half and double change no bit (27
 * runs of bench/constants.py). */
static const double vanishing = 1e-12;
/* Error of A u in double precision, L1, some twenty roundings of 2.2e-16. Half and double change no
 * convolution. */
static const double rounding = 4e-15;
/* When the error has fallen by this factor, A u is computed again: single precision would be felt at
 * 1e-6. Half takes 2 % fewer convolutions and double 3 % more, with the same errors (9 pull-offs of
 * bench/constants.py). */
static const double fresh = 1e-4;
/* An error below which the corrections are those of the state. Not sensitive: half and double change
 * the convolutions by less than 1 % (27 runs of bench/constants.py). */
static const double linear = 1e-2;
/* Part of the error from neglected coefficients. */
static const double most_cut = 0.2;
/* Part of the slope that a line search may leave. Half changes no convolution, double takes 0.4 % more
 * (27 runs of bench/constants.py). */
static const double exact = 1e-3;
enum {
    LINE = RC_GAP_LINE,
    /* Most steps of Newton's method on a line. Not sensitive: half and double change the convolutions
     * by at most 1 % (27 runs of bench/constants.py). */
    NEWTON = 12,
    /* Most shorter trials of a step, down to 0.4^12 = 2e-5 of it. Not sensitive: half and double change
     * the convolutions by less than 1 % (27 runs of bench/constants.py). */
    SHORTEN = 12,
    /* Most steps of Newton's method for a given mean. Not sensitive: half and double change no
     * convolution (27 runs of bench/constants.py). */
    PROJECT = 4,
    /* Most longer trials, each twice as long. Half and double change no bit (27 runs of
     * bench/constants.py). */
    DOUBLE = 10
};

/* ---- rows ---- */

/* As fmax, which is a call for each node. */
static double
larger(double a, double b)
{
    return b > a ? b : a;
}

static double
hard_at(const struct rc_gap_problem *problem, size_t j, size_t i)
{
    return problem->hards != NULL ? problem->hards[j * problem->nx + i] : problem->hard;
}

/* The state and a number for a row function. */
struct by {
    struct rc_gap *g;
    double a;
};

/* The tangent of V at the frozen gaps. */
static void
frozen_law(const struct rc_attraction *law, const float *frozen, size_t n, const double *gap,
           double *v, double *s, double *d)
{
    double at[LINE] = {0};

    for (size_t k = 0; k < n; k++)
        at[k] = (double)frozen[k];
    law->law->at(law, n, at, v, s, d);
    for (size_t k = 0; k < n; k++) {
        v[k] += s[k] * (gap[k] - at[k]);
        d[k] = 0;
    }
}

/* sigma, V and D at n <= LINE gaps of row j from node i on, with the hardness. */
void
rc_gap_law(const struct rc_gap_problem *problem, const struct rc_gap_frozen *frozen, size_t j,
           size_t i, size_t n, const double *gap, double *v, double *s, double *d)
{
    if (frozen->on)
        frozen_law(&problem->law, frozen->x + j * problem->px + i, n, gap, v, s, d);
    else
        problem->law.law->at(&problem->law, n, gap, v, s, d);
    if (!problem->yields)
        return;
    for (size_t k = 0; k < n; k++)
        if (gap[k] < 0) {
            double hard = hard_at(problem, j, i + k);
            v[k] -= hard * gap[k];
            s[k] -= hard;
        }
}

/* ---- A u ---- */

static bool
u_in(void *ctx, size_t j, void *to)
{
    const struct rc_gap *g = ctx;
    const double c = g->set.control == RC_GAP_SHIFT ? g->set.given : 0;
    double *row = to;

    for (size_t i = 0; i < g->problem.px; i++)
        row[i] = g->maps.x[j * g->problem.px + i] + c;
    for (size_t i = 0; i < rc_gap_on_map(&g->problem, j); i++)
        row[i] += g->problem.h[j * g->problem.nx + i];
    return true;
}

enum {
    AU_SUM
};

static bool
u_out(void *ctx, size_t j, void *from)
{
    struct rc_gap *g = ctx;
    const double *row = from;
    double *sums = rc_sums_of(&g->sums, j);

    memcpy(g->maps.au + j * g->problem.px, row, g->problem.px * sizeof *row);
    for (size_t i = 0; i < g->problem.px; i++)
        sums[AU_SUM] += row[i];
    return true;
}

static void
take_mean(double *v, size_t n, double mean, int threads)
{
    if (mean == 0)
        return;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t k = 0; k < n; k++)
        v[k] -= mean;
}

/* Under a given load A ignores the mean. */
static void
find_au(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS];

    rc_sums_clear(&g->sums);
    rc_whole_rows(g->problem.whole, RC_WHOLE_INVERSE, u_in, u_out, g);
    rc_sums_total(&g->sums, sums);
    if (g->set.control == RC_GAP_LOAD)
        take_mean(g->maps.au, g->problem.n, sums[AU_SUM] / (double)g->problem.all, g->sums.threads);
    g->run.convolutions++;
    g->told.drift = g->told.cuts = 0;
}

/* ---- residual ---- */

enum {
    RESIDUAL_SUM, /* of open nodes */
    RESIDUAL_OPEN /* their number */
};

/* Computes r = A u + S + sigma and its sum over open nodes. */
static void
residual_row(void *ctx, size_t j, double *sums)
{
    struct rc_gap *g = ctx;
    const double *x = g->maps.x + j * g->problem.px, *au = g->maps.au + j * g->problem.px;
    const double load = g->set.control == RC_GAP_LOAD ? g->set.given : 0;
    double *r = g->maps.r + j * g->problem.px;
    size_t m = rc_gap_on_map(&g->problem, j);

    for (size_t i = 0; i < m; i += LINE) {
        size_t n = m - i < LINE ? m - i : LINE;
        double v[LINE], s[LINE], d[LINE];
        rc_gap_law(&g->problem, &g->frozen, j, i, n, x + i, v, s, d);
        for (size_t k = 0; k < n; k++) {
            bool apart = x[i + k] != 0;
            r[i + k] = au[i + k] + load + s[k];
            sums[RESIDUAL_SUM] += apart ? r[i + k] : 0;
            sums[RESIDUAL_OPEN] += apart;
        }
    }
    for (size_t i = m; i < g->problem.px; i++) {
        r[i] = au[i] + load;
        sums[RESIDUAL_SUM] += r[i];
    }
    sums[RESIDUAL_OPEN] += (double)(g->problem.px - m);
}

enum {
    HOLD_SUM,                  /* of the residual on free nodes */
    HOLD_FREE,                 /* free nodes */
    HOLD_CHANGED,              /* nodes held since now, and no longer held */
    HOLD_LARGEST = RC_GAP_MOST /* residual */
};

/* Finds the held nodes and counts the changes. r becomes the negative residual on free nodes, and 0 on held
 * nodes. */
static void
hold_row(void *ctx, size_t j, double *sums)
{
    struct rc_gap *g = ctx;
    const double *x = g->maps.x + j * g->problem.px;
    double *r = g->maps.r + j * g->problem.px;
    unsigned char *off = g->maps.off + j * g->problem.px;
    size_t m = rc_gap_on_map(&g->problem, j);

    for (size_t i = 0; i < g->problem.px; i++) {
        double at = r[i] - g->set.level;
        bool held = false;
        if (i < m && x[i] == 0) {
            double hard = g->problem.yields ? hard_at(&g->problem, j, i) : INFINITY;
            held = at >= 0 && at <= hard;
            at = at > hard ? at - hard : at;
        }
        sums[HOLD_CHANGED] += off[i] != held;
        off[i] = held;
        r[i] = held ? 0 : -at;
        sums[HOLD_SUM] += r[i];
        sums[HOLD_FREE] += !held;
        sums[HOLD_LARGEST] = larger(sums[HOLD_LARGEST], fabs(r[i]));
    }
}

static void
find_residual(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS];

    rc_sums_rows(&g->sums, residual_row, g, sums);
    g->set.level = g->set.control == RC_GAP_MEAN && sums[RESIDUAL_OPEN] > 0
                       ? sums[RESIDUAL_SUM] / sums[RESIDUAL_OPEN]
                       : 0;
    rc_sums_rows(&g->sums, hold_row, g, sums);
    g->residual.free = (size_t)sums[HOLD_FREE];
    g->way.same = sums[HOLD_CHANGED] == 0;
    g->residual.mean = g->set.control != RC_GAP_MEAN ? sums[HOLD_SUM] / (double)g->problem.all
                       : g->residual.free > 0        ? sums[HOLD_SUM] / sums[HOLD_FREE]
                                                     : 0;
    g->residual.largest = sums[HOLD_LARGEST];
}

/* ---- z = K r ---- */

static bool
r_in(void *ctx, size_t j, void *to)
{
    const struct rc_gap *g = ctx;
    const unsigned char *off = g->maps.off + j * g->problem.px;
    double *r = g->maps.r + j * g->problem.px, per = 1 / g->residual.largest;
    float *row = to;
    bool any = false;

    for (size_t i = 0; i < g->problem.px; i++) {
        if (g->set.control == RC_GAP_MEAN && !off[i])
            r[i] -= g->residual.mean;
        row[i] = (float)(r[i] * per);
        any |= row[i] != 0;
    }
    return any;
}

enum {
    Z_RZ,     /* r'z */
    Z_RZ_OLD, /* r'z with the z of the last step */
    Z_SUM
};

static bool
z_out(void *ctx, size_t j, void *from)
{
    struct rc_gap *g = ctx;
    const unsigned char *off = g->maps.off + j * g->problem.px;
    const double *r = g->maps.r + j * g->problem.px;
    const float *row = from;
    double *z = g->maps.z + j * g->problem.px, *sums = rc_sums_of(&g->sums, j);

    for (size_t i = 0; i < g->problem.px; i++) {
        double is =
            off[i] ? 0 : (double)row[i] * g->residual.largest + g->set.lift * g->residual.mean;
        sums[Z_RZ_OLD] += r[i] * z[i];
        z[i] = is;
        sums[Z_RZ] += r[i] * is;
        sums[Z_SUM] += is;
    }
    return true;
}

/* ---- direction ---- */

/* Multiplies n numbers by `per`. Returns false if all are 0. */
static bool
to_single(const double *v, size_t n, double per, float *to)
{
    bool any = false;

    for (size_t k = 0; k < n; k++) {
        to[k] = (float)(v[k] * per);
        any |= to[k] != 0;
    }
    return any;
}

/* True if a node at 0 must not move along d, because its residual points the other way. */
static bool
barred(const struct rc_gap_maps *maps, size_t at, bool map)
{
    return map && maps->x[at] == 0 && maps->d[at] * maps->r[at] < 0;
}

enum {
    DIRECTION_RD, /* r'd */
    DIRECTION_SUM,
    DIRECTION_MOVING, /* nodes */
    DIRECTION_LARGEST = RC_GAP_MOST
};

/* d = z + beta d within the bounds, minus `a`: the mean of z if the mean of d must be 0. */
static void
direction_row(void *ctx, size_t j, double *sums)
{
    const struct by *c = ctx;
    struct rc_gap *g = c->g;
    size_t m = rc_gap_on_map(&g->problem, j);

    for (size_t i = 0; i < g->problem.px; i++) {
        size_t at = j * g->problem.px + i;
        double is = g->maps.off[at] ? 0 : g->maps.z[at] - c->a + g->way.beta * g->maps.d[at];
        g->maps.d[at] = is;
        if (barred(&g->maps, at, i < m))
            g->maps.d[at] = is = 0;
        sums[DIRECTION_RD] += g->maps.r[at] * is;
        sums[DIRECTION_SUM] += is;
        sums[DIRECTION_MOVING] += is != 0;
        sums[DIRECTION_LARGEST] = larger(sums[DIRECTION_LARGEST], fabs(is));
    }
}

static void
level_row(void *ctx, size_t j, double *sums)
{
    const struct by *c = ctx;
    struct rc_gap *g = c->g;
    size_t m = rc_gap_on_map(&g->problem, j);

    for (size_t i = 0; i < g->problem.px; i++) {
        size_t at = j * g->problem.px + i;
        if (g->maps.d[at] == 0)
            continue;
        g->maps.d[at] -= c->a;
        if (barred(&g->maps, at, i < m))
            g->maps.d[at] = 0;
        sums[DIRECTION_RD] += g->maps.r[at] * g->maps.d[at];
        sums[DIRECTION_SUM] += g->maps.d[at];
        sums[DIRECTION_MOVING] += g->maps.d[at] != 0;
    }
}

/* r'd */
static double
set_direction(struct rc_gap *g, double sum_z)
{
    struct by by = {g, g->set.control == RC_GAP_MEAN ? sum_z / (double)g->residual.free : 0};
    double sums[RC_GAP_SUMS];

    rc_sums_rows(&g->sums, direction_row, &by, sums);
    g->way.unit = sums[DIRECTION_LARGEST];
    g->way.whole = (size_t)sums[DIRECTION_MOVING] == g->residual.free;
    for (int k = 0; k < PROJECT && g->set.control == RC_GAP_MEAN && sums[DIRECTION_MOVING] > 0;
         k++) {
        by.a = sums[DIRECTION_SUM] / sums[DIRECTION_MOVING];
        rc_sums_rows(&g->sums, level_row, &by, sums);
    }
    g->way.whole &= (size_t)sums[DIRECTION_MOVING] == g->residual.free;
    return sums[DIRECTION_RD];
}

/* ---- A d ---- */

static bool
d_in(void *ctx, size_t j, void *to)
{
    const struct rc_gap *g = ctx;

    return to_single(g->maps.d + j * g->problem.px, g->problem.px, 1 / g->way.unit, to);
}

enum {
    AD_CHANGE,   /* sum of |A z| on the map */
    AD_PRESSURE, /* sum of |p| on the map */
    AD_DAD,      /* d'A d */
    AD_SUM,      /* of A d */
    AD_D,        /* sum of d */
    AD_DAD_SIZE, /* sum of |d A d| */
    AD_MOVES     /* sum of |A d| on the map */
};

static bool
ad_out(void *ctx, size_t j, void *from)
{
    struct rc_gap *g = ctx;
    const float *row = from;
    const double *d = g->maps.d + j * g->problem.px, *au = g->maps.au + j * g->problem.px;
    const double plus = (g->set.control == RC_GAP_LOAD ? g->set.given : 0) - g->set.level;
    double *ad = g->maps.ad + j * g->problem.px, *sums = rc_sums_of(&g->sums, j);
    float *az = g->mode.e[RC_GAP_AZ] + j * g->problem.px;
    size_t m = rc_gap_on_map(&g->problem, j);

    for (size_t i = 0; i < g->problem.px; i++) {
        double is = (double)row[i] * g->way.unit;
        if (i < m) {
            sums[AD_CHANGE] += fabs(is - g->way.beta * ad[i]);
            sums[AD_PRESSURE] += fabs(au[i] + plus);
            sums[AD_MOVES] += fabs(is);
        }
        sums[AD_DAD] += is * d[i];
        sums[AD_SUM] += is;
        sums[AD_D] += d[i];
        sums[AD_DAD_SIZE] += fabs(is * d[i]);
        az[i] = (float)(is - g->way.beta * ad[i]);
        ad[i] = is;
    }
    return true;
}

enum {
    MARK_CHANGE
};

static void
mark_row(void *ctx, size_t j, double *sums)
{
    struct rc_gap *g = ctx;
    float *mark = g->told.at_mark + j * g->problem.px;

    for (size_t i = 0; i < rc_gap_on_map(&g->problem, j); i++) {
        float p = (float)rc_gap_pressure_at(&g->set, g->maps.au, j * g->problem.px + i);
        sums[MARK_CHANGE] += fabs((double)p - (double)mark[i]);
        mark[i] = p;
    }
}

/* When |A z| has halved since the mark, the change of the pressure is the error at the mark minus the present
 * one. With the same ratio of error to |A z| at both, this is the ratio. */
static void
measure_ratio(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS], off = g->told.change + g->told.drift, last = g->told.mark;

    g->told.calm = fmax(g->told.error, g->told.last / 2);
    g->told.last = g->told.error;
    if (last > 0 && off > last / 2)
        return;
    rc_sums_rows(&g->sums, mark_row, g, sums);
    g->told.mark = off;
    if (last == 0)
        return;
    g->told.ratios[1] = g->told.ratios[0];
    g->told.ratios[0] = sums[MARK_CHANGE] / (last - off);
    if (isinf(g->told.ratios[1]))
        g->told.ratios[1] = g->told.ratios[0];
}

/* Finds the error. Changes that are negligible compared with the traction are rounding. */
static void
find_error(const struct rc_gap_problem *problem, struct rc_gap_told *told)
{
    double off = told->change + told->drift;

    told->vanishes = off <= vanishing * problem->law.strength * (double)(problem->nx * problem->ny);
    if (off == 0)
        told->error = rounding;
    else
        told->error = told->size > 0 ? off / told->size + rounding : INFINITY;
}

static void
forget_error(struct rc_gap_told *told)
{
    told->error = told->last = told->calm = told->ratios[0] = told->ratios[1] = INFINITY;
    told->mark = 0;
    told->vanishes = false;
}

/* Returns d'A d; finds the error and the mean of d. */
static double
find_ad(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS], mean;

    rc_sums_clear(&g->sums);
    rc_whole_rows(g->problem.whole, RC_WHOLE_ROUGH_INVERSE, d_in, ad_out, g);
    rc_sums_total(&g->sums, sums);
    g->run.convolutions += 0.5;
    mean = g->set.control == RC_GAP_LOAD ? sums[AD_SUM] / (double)g->problem.all : 0;
    take_mean(g->maps.ad, g->problem.n, mean, g->sums.threads);
    g->told.size = sums[AD_PRESSURE];
    g->told.moves = sums[AD_MOVES];
    g->told.change = sums[AD_CHANGE];
    find_error(&g->problem, &g->told);
    g->way.mean = sums[AD_D] / (double)g->problem.all;
    return fmax(sums[AD_DAD] - mean * sums[AD_D], single * sums[AD_DAD_SIZE]);
}

/* ---- along the direction ---- */

enum {
    LINE_RISE,  /* V(x + a d) - V(x) - a sigma(x) d */
    LINE_SLOPE, /* (sigma(x + a d) - sigma(x)) d */
    LINE_BEND,  /* D d^2 */
    LINE_SIZE   /* sum of |V| */
};

static void
line_row(void *ctx, size_t j, double *sums)
{
    const struct by *c = ctx;
    const struct rc_gap *g = c->g;
    const double *x = g->maps.x + j * g->problem.px, *d = g->maps.d + j * g->problem.px, a = c->a;
    size_t m = rc_gap_on_map(&g->problem, j);

    for (size_t i = 0; i < m; i += LINE) {
        size_t n = m - i < LINE ? m - i : LINE;
        double v[2][LINE], s[2][LINE], k[LINE], at[LINE];
        for (size_t q = 0; q < n; q++)
            at[q] = x[i + q] + a * d[i + q];
        rc_gap_law(&g->problem, &g->frozen, j, i, n, x + i, v[0], s[0], k);
        rc_gap_law(&g->problem, &g->frozen, j, i, n, at, v[1], s[1], k);
        for (size_t q = 0; q < n; q++) {
            double way = d[i + q];
            sums[LINE_RISE] += v[1][q] - v[0][q] - a * s[0][q] * way;
            sums[LINE_SLOPE] += (s[1][q] - s[0][q]) * way;
            sums[LINE_BEND] += k[q] * way * way;
            sums[LINE_SIZE] += fabs(v[1][q]);
        }
    }
}

/* step = a d clipped to the bounds. */
static void
clip_row(void *ctx, size_t j, double *sums)
{
    const struct by *c = ctx;
    struct rc_gap *g = c->g;
    size_t m = rc_gap_on_map(&g->problem, j);

    for (size_t i = 0; i < g->problem.px; i++) {
        size_t at = j * g->problem.px + i;
        double x = g->maps.x[at], to = x + c->a * g->maps.d[at];
        if (i < m && ((x >= 0 && to < 0 && !(x == 0 && g->problem.yields)) || (x < 0 && to > 0))) {
            to = 0;
            sums[RC_GAP_CLIPPED]++;
        }
        sums[RC_GAP_CLIP_SUM] += to;
        sums[RC_GAP_CLIP_OPEN] += i >= m || to > 0;
        g->maps.step[at] = to - x;
    }
}

/* For a given mean: subtracts the increase by clipping from the open nodes. */
static void
lower_row(void *ctx, size_t j, double *sums)
{
    const struct by *c = ctx;
    struct rc_gap *g = c->g;
    for (size_t i = 0; i < g->problem.px; i++) {
        size_t at = j * g->problem.px + i;
        double to = g->maps.x[at] + g->maps.step[at];
        if (to > 0) {
            to = larger(0, to - c->a);
            g->maps.step[at] = to - g->maps.x[at];
        }
        sums[RC_GAP_CLIP_SUM] += to;
        sums[RC_GAP_CLIP_OPEN] += to > 0;
    }
}

static void
keep_mean(struct rc_gap *g, double sum, double count)
{
    const double want = g->set.given * (double)g->problem.all;
    double sums[RC_GAP_SUMS] = {[RC_GAP_CLIP_SUM] = sum, [RC_GAP_CLIP_OPEN] = count};

    for (int k = 0; k < NEWTON && sums[RC_GAP_CLIP_OPEN] > 0; k++) {
        struct by by = {g, (sums[RC_GAP_CLIP_SUM] - want) / sums[RC_GAP_CLIP_OPEN]};
        if (fabs(sums[RC_GAP_CLIP_SUM] - want) <= 1e-15 * want)
            return;
        rc_sums_rows(&g->sums, lower_row, &by, sums);
    }
}

static bool
step_in(void *ctx, size_t j, void *to)
{
    const struct rc_gap *g = ctx;

    return to_single(g->maps.step + j * g->problem.px, g->problem.px, 1 / g->way.unit, to);
}

enum {
    STEP_SAS, /* s'A s/2 of the step s */
    STEP_SAU, /* s'A u */
    STEP_AS,  /* sum of A s */
    STEP_SUM,
    STEP_MOVES /* sum of |A s| on the map */
};

static void
step_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;
    const double *step = g->maps.step + j * g->problem.px, *au = g->maps.au + j * g->problem.px;
    const double *to = g->maps.a_step + j * g->problem.px;
    size_t m = rc_gap_on_map(&g->problem, j);

    for (size_t i = 0; i < g->problem.px; i++) {
        sums[STEP_SAS] += step[i] * to[i] / 2;
        sums[STEP_SAU] += step[i] * au[i];
        sums[STEP_AS] += to[i];
        sums[STEP_SUM] += step[i];
        sums[STEP_MOVES] += i < m ? fabs(to[i]) : 0;
    }
}

static bool
step_out(void *ctx, size_t j, void *from)
{
    struct rc_gap *g = ctx;
    const float *row = from;

    for (size_t i = 0; i < g->problem.px; i++)
        g->maps.a_step[j * g->problem.px + i] = (double)row[i] * g->way.unit;
    step_row(g, j, rc_sums_of(&g->sums, j));
    return true;
}

enum {
    STEP_V,     /* change of the sum of V */
    STEP_V_SIZE /* sum of |V| */
};

static void
step_law_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;
    const double *x = g->maps.x + j * g->problem.px, *step = g->maps.step + j * g->problem.px;
    size_t m = rc_gap_on_map(&g->problem, j);

    for (size_t i = 0; i < m; i += LINE) {
        size_t n = m - i < LINE ? m - i : LINE;
        double v[2][LINE], s[LINE], k[LINE], at[LINE];
        for (size_t q = 0; q < n; q++)
            at[q] = x[i + q] + step[i + q];
        rc_gap_law(&g->problem, &g->frozen, j, i, n, x + i, v[0], s, k);
        rc_gap_law(&g->problem, &g->frozen, j, i, n, at, v[1], s, k);
        for (size_t q = 0; q < n; q++) {
            sums[STEP_V] += v[1][q] - v[0][q];
            sums[STEP_V_SIZE] += fabs(v[1][q]);
        }
    }
}

/* Returns the change of Phi by `step`; finds `moves`, and a_step if it is not yet `known`. */
static double
rise(struct rc_gap *g, bool known, double *least)
{
    double sums[RC_GAP_SUMS], law[RC_GAP_SUMS],
        load = g->set.control == RC_GAP_LOAD ? g->set.given : 0, mean;

    if (known) {
        rc_sums_rows(&g->sums, step_row, g, sums);
    } else {
        rc_sums_clear(&g->sums);
        rc_whole_rows(g->problem.whole, RC_WHOLE_ROUGH_INVERSE, step_in, step_out, g);
        rc_sums_total(&g->sums, sums);
        g->run.convolutions += 0.5;
        g->told.cut = 0;
    }
    mean = g->set.control == RC_GAP_LOAD ? sums[STEP_AS] / (double)g->problem.all : 0;
    take_mean(g->maps.a_step, g->problem.n, mean, g->sums.threads);
    rc_sums_rows(&g->sums, step_law_row, g, law);
    *least = 1e-14 * (law[STEP_V_SIZE] + fabs(sums[STEP_SAU])) + single * fabs(sums[STEP_SAS]);
    g->told.moves = sums[STEP_MOVES];
    return sums[STEP_SAS] - mean * sums[STEP_SUM] / 2 + sums[STEP_SAU] + load * sums[STEP_SUM] +
           law[STEP_V];
}

/* `a` times a step, with A times it. */
struct taken {
    struct rc_gap *g;
    double a;
    const double *step, *a_step;
};

static void
take_row(void *ctx, size_t j, double *sums)
{
    const struct taken *t = ctx;
    struct rc_gap *g = t->g;
    (void)sums;
    for (size_t k = j * g->problem.px; k < (j + 1) * g->problem.px; k++) {
        g->maps.x[k] += t->a * t->step[k];
        g->maps.au[k] += t->a * t->a_step[k];
    }
}

/* Phi along a d minus Phi at a = 0, its slope and its curvature. */
struct line {
    double rd, q; /* r'd, d'A d */
    double phi, slope, bend, rounding;
};

static void
look(struct rc_gap *g, struct line *l, double a)
{
    double sums[RC_GAP_SUMS];

    rc_sums_rows(&g->sums, line_row, &(struct by){g, a}, sums);
    l->phi = a * (a * l->q / 2 - l->rd) + sums[LINE_RISE];
    l->slope = a * l->q - l->rd + sums[LINE_SLOPE];
    l->bend = l->q - sums[LINE_BEND];
    l->rounding = 1e-14 * (sums[LINE_SIZE] + a * a * l->q);
}

/* The stiffness along d, with the curvature `bend` at a = 0. A pinned W is too large: it has the right
 * sign. */
static double
way_of(const struct rc_gap_way *way, bool pinned, const struct line *l)
{
    return way->dwd > 0 && !(pinned && l->bend > 0) ? l->bend / way->dwd : INFINITY;
}

/* The minimum along d by Newton's method from a = 0. Once slopes of both signs are known, the iterates stay
 * between them. */
static double
line_minimum(struct rc_gap *g, struct line *l, double most)
{
    double a = 0, low = 0, high = INFINITY;

    look(g, l, 0);
    g->way.stiffness = way_of(&g->way, g->set.pinned, l);
    for (int k = 0; k < NEWTON; k++) {
        double bend = fmax(l->bend, curvature * l->q);
        double next = bend > 0 ? a - l->slope / bend : most;
        if (l->slope < 0)
            low = a;
        else
            high = a;
        if (!(next > low && next < high))
            next = isinf(high) ? 2 * fmax(low, 1) : (low + high) / 2;
        a = fmin(next, most);
        look(g, l, a);
        if (fabs(l->slope) <= exact * l->rd || (a == most && l->slope < 0))
            break;
    }
    for (int k = 0; k < SHORTEN && l->phi > l->rounding; k++)
        look(g, l, a *= shorter);
    return a;
}

/* Takes the step a d, shortened until Phi does not rise. */
static void
go(struct rc_gap *g, struct line *l, double a)
{
    struct by by = {g, a};
    double sums[RC_GAP_SUMS];

    for (int k = 0; k < SHORTEN; k++, by.a *= shorter) {
        double least, up;
        bool near;
        rc_sums_rows(&g->sums, clip_row, &by, sums);
        if (sums[RC_GAP_CLIPPED] == 0) {
            if (k > 0)
                look(g, l, by.a);
            g->told.drift += float_rounding * by.a * g->told.moves;
            rc_sums_rows(&g->sums, take_row, &(struct taken){g, by.a, g->maps.d, g->maps.ad}, sums);
            return;
        }
        g->way.restart = sums[RC_GAP_CLIPPED] > clipped_anew * (double)g->residual.free;
        near = rc_gap_near(g, by.a, (size_t)sums[RC_GAP_CLIPPED], sums[RC_GAP_CLIP_SUM]);
        if (!near && g->set.control == RC_GAP_MEAN)
            keep_mean(g, sums[RC_GAP_CLIP_SUM], sums[RC_GAP_CLIP_OPEN]);
        up = rise(g, near, &least);
        if (up <= least) {
            g->told.drift += float_rounding * g->told.moves + g->told.cut;
            g->told.cuts += g->told.cut;
            rc_sums_rows(&g->sums, take_row, &(struct taken){g, 1, g->maps.step, g->maps.a_step},
                         sums);
            return;
        }
        g->way.restart = true;
    }
    g->run.stuck = true;
}

enum {
    MOST = RC_GAP_MOST
};

static void
largest_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;

    for (size_t i = 0; i < rc_gap_on_map(&g->problem, j); i++)
        sums[MOST] = larger(sums[MOST], fabs(g->maps.d[j * g->problem.px + i]));
}

/* The largest step before an open node reaches 0. */
static void
reach_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;
    const double *x = g->maps.x + j * g->problem.px, *d = g->maps.d + j * g->problem.px;

    for (size_t i = 0; i < rc_gap_on_map(&g->problem, j); i++)
        if (x[i] > 0 && d[i] < 0)
            sums[MOST] = larger(sums[MOST], -x[i] / d[i]);
}

static void
nearest_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;

    sums[MOST] = -INFINITY;
    for (size_t i = 0; i < rc_gap_on_map(&g->problem, j); i++)
        sums[MOST] = larger(sums[MOST], -g->maps.x[j * g->problem.px + i]);
}

/* The longest step under a given load, where a uniform motion has no other bound. If the bodies separate,
 * the step must not pass over the range of the attraction; if they approach, it ends where the last node
 * touches. */
static double
longest(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS];

    if (g->set.control != RC_GAP_LOAD || g->way.mean == 0 || (g->way.mean > 0 && g->set.given >= 0))
        return INFINITY;
    rc_sums_rows(&g->sums, g->way.mean < 0 ? reach_row : largest_row, g, sums);
    if (g->way.mean < 0)
        return sums[MOST] > 0 ? sums[MOST] : INFINITY;
    return 4 * g->problem.law.range / sums[MOST];
}

void
rc_gap_look_along(struct rc_gap *g)
{
    struct line line = {.rd = g->way.rd, .q = g->way.dad};

    g->way.stiffness = INFINITY;
    if (g->run.stuck || !(g->way.rd > 0))
        return;
    look(g, &line, 0);
    g->way.stiffness = way_of(&g->way, g->set.pinned, &line);
}

static double
find_z(struct rc_gap *g, double *old, double *sum_z)
{
    double sums[RC_GAP_SUMS];

    if (g->residual.largest == 0) {
        memset(g->maps.z, 0, g->problem.n * sizeof *g->maps.z);
        *old = *sum_z = 0;
        return 0;
    }
    rc_sums_clear(&g->sums);
    rc_whole_rows(g->problem.whole, RC_WHOLE_ROUGH, r_in, z_out, g);
    rc_sums_total(&g->sums, sums);
    g->run.convolutions += 0.5;
    *old = sums[Z_RZ_OLD];
    *sum_z = sums[Z_SUM];
    return sums[Z_RZ];
}

static void
refresh(struct rc_gap *g)
{
    find_au(g);
    g->told.fresh = g->told.error;
}

/* True if most of the error comes from A u in single precision. */
static bool
drifted(const struct rc_gap_told *told)
{
    return told->drift > 10 * told->change || told->cuts > most_cut * told->change;
}

/* Computes d'W d, where W is the inverse of K on the free nodes, from r'z = z'W z and r = W z. NAN if the set
 * of free nodes has changed since the last direction. */
static void
measure_way(struct rc_gap_way *way, double rz)
{
    double along = way->rd - rz; /* beta times r'd of the last direction */
    double last = way->beta > 0 ? (way->same ? way->beta * way->beta * way->dwd : NAN) : 0;

    way->dwd = way->whole ? rz + 2 * along + last : NAN;
}

void
rc_gap_look(struct rc_gap *g)
{
    double rz, old, sum_z;

    if (g->told.error <= fresh * g->told.fresh || drifted(&g->told))
        refresh(g);
    find_residual(g);
    rz = find_z(g, &old, &sum_z);
    g->way.beta = g->way.restart || !(g->way.rz > 0) ? 0 : fmax((rz - old) / g->way.rz, 0);
    g->way.rd = set_direction(g, sum_z);
    if (!(g->way.rd > 0) && g->way.beta > 0) {
        g->way.beta = 0;
        g->way.rd = set_direction(g, sum_z);
    }
    measure_way(&g->way, rz);
    g->way.rz = rz;
    g->way.restart = false;
    g->run.iterations++;
    if (g->way.rd > 0) {
        g->way.dad = find_ad(g);
        measure_ratio(g);
        if (!g->mode.known && !g->frozen.on && g->told.error < linear)
            rc_gap_track(g, g->set.control == RC_GAP_MEAN ? sum_z / (double)g->residual.free : 0);
        return;
    }
    if (g->told.drift > 0) { /* the residual is rounding, perhaps of A u: compute A u again */
        refresh(g);
        g->way.restart = true;
        return;
    }
    g->run.stuck = true;
    if (rz > 0 && g->told.size > 0)
        find_error(&g->problem, &g->told);
    else
        g->told.error = rounding;
}

void
rc_gap_move(struct rc_gap *g)
{
    struct line line = {.rd = g->way.rd, .q = g->way.dad};
    double sums[RC_GAP_SUMS];

    if (g->run.stuck || !(g->way.rd > 0))
        return;
    go(g, &line, line_minimum(g, &line, longest(g)));
    if (g->run.stuck && drifted(&g->told)) { /* first compute A u again */
        refresh(g);
        g->way.restart = true;
        g->run.stuck = false;
    }
    g->run.parting = g->set.control == RC_GAP_LOAD && g->set.given < 0 && g->way.mean > 0;
    if (g->run.parting) {
        rc_sums_rows(&g->sums, nearest_row, g, sums);
        g->run.parting = -sums[MOST] > RC_GAP_PARTED * g->problem.law.range;
    }
}

/* ---- states ---- */

enum {
    MEAN_SUM /* of u - c */
};

static void
mean_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = *(const struct rc_gap *const *)ctx;
    size_t m = rc_gap_on_map(&g->problem, j);

    for (size_t i = 0; i < g->problem.px; i++)
        sums[MEAN_SUM] += g->maps.x[j * g->problem.px + i];
    for (size_t i = 0; i < m; i++)
        sums[MEAN_SUM] += g->problem.h[j * g->problem.nx + i];
}

double
rc_gap_shift(const struct rc_gap *g)
{
    double sums[RC_GAP_SUMS], mean;

    if (g->set.control == RC_GAP_SHIFT)
        return g->set.given;
    rc_sums_rows(&g->sums, mean_row, &g, sums);
    mean = sums[MEAN_SUM] / (double)g->problem.all;
    return (g->set.control == RC_GAP_LOAD ? g->problem.whole->mean * g->set.given : 0) - mean;
}

void
rc_gap_apart(struct rc_gap *g, double clearance)
{
    for (size_t j = 0; j < g->problem.rows.n; j++)
        for (size_t i = 0; i < g->problem.px; i++) {
            bool map = i < rc_gap_on_map(&g->problem, j);
            g->maps.x[j * g->problem.px + i] =
                clearance - (map ? g->problem.h[j * g->problem.nx + i] : 0);
        }
    g->set.control = rc_has_mean(g->problem.whole->boundary) ? RC_GAP_SHIFT : RC_GAP_MEAN;
    g->set.given = -clearance;
    g->mode.known = false;
}

enum {
    SHIFT_SUM, /* of x */
    SHIFT_OPEN /* nodes that are open or beyond the map */
};

/* Moves the open nodes of the map, and the nodes beyond the map, by `a`. */
static void
shift_row(void *ctx, size_t j, double *sums)
{
    const struct by *c = ctx;
    struct rc_gap *g = c->g;
    size_t m = rc_gap_on_map(&g->problem, j);

    for (size_t i = 0; i < g->problem.px; i++) {
        double *x = g->maps.x + j * g->problem.px + i;
        if (i >= m || *x > 0)
            *x = i < m ? fmax(*x + c->a, 0) : *x + c->a;
        sums[SHIFT_SUM] += *x;
        sums[SHIFT_OPEN] += i >= m || *x > 0;
    }
}

static void
shift(struct rc_gap *g, double a)
{
    struct by by = {g, a};
    double sums[RC_GAP_SUMS];

    rc_sums_rows(&g->sums, shift_row, &by, sums);
    if (g->set.control == RC_GAP_MEAN &&
        sums[SHIFT_OPEN] == 0) { /* no node is open, so that none would move */
        for (size_t k = 0; k < g->problem.n; k++)
            g->maps.x[k] = g->set.given;
        return;
    }
    for (int k = 0; k < NEWTON && g->set.control == RC_GAP_MEAN && sums[SHIFT_OPEN] > 0; k++) {
        by.a = (g->set.given * (double)g->problem.all - sums[SHIFT_SUM]) / sums[SHIFT_OPEN];
        if (fabs(by.a) <= 1e-15 * g->set.given)
            break;
        rc_sums_rows(&g->sums, shift_row, &by, sums);
    }
}

static void
keep(const double *x, size_t n, int threads, float *to)
{
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t k = 0; k < n; k++)
        to[k] = (float)x[k];
}

void
rc_gap_keep(struct rc_gap *g)
{
    keep(g->maps.x, g->problem.n, g->sums.threads, g->maps.start);
}

void
rc_gap_return(struct rc_gap *g, enum rc_gap_control control, double given)
{
#pragma omp parallel for num_threads(g->sums.threads) schedule(static)
    for (size_t k = 0; k < g->problem.n; k++)
        g->maps.x[k] = (double)g->maps.start[k];
    g->set.control = control;
    g->set.given = given;
    g->mode.known = false; /* its softest mode belongs to another gap */
}

void
rc_gap_freeze(struct rc_gap *g, bool at_start)
{
    if (at_start)
        memcpy(g->frozen.x, g->maps.start, g->problem.n * sizeof *g->maps.start);
    else
        keep(g->maps.x, g->problem.n, g->sums.threads, g->frozen.x);
    g->way.restart = g->frozen.on = true;
    g->way.rz = 0;
    g->run.stuck = false;
    forget_error(&g->told);
}

enum {
    EDGES /* between a closed and an open node */
};

static void
edges_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;
    const struct rc_rows *rows = &g->problem.rows;
    const double *x = g->maps.x + j * g->problem.px, *next = x;
    const size_t m = rc_gap_on_map(&g->problem, j);

    if (rows->first + j + 1 < g->problem.ny)
        next = j + 1 < rows->n ? x + g->problem.px : g->maps.beside + g->problem.px;

    for (size_t i = 0; i < m; i++)
        sums[EDGES] +=
            (i + 1 < m && (x[i] == 0) != (x[i + 1] == 0)) + ((x[i] == 0) != (next[i] == 0));
}

/* Contacts hold the waves that are longer than the distances between them, and K does not know of them:
 * there K r is too large. As punches of radius a, with a share f of the area, they have the stiffness 2
 * f/(pi a) per area. The staircase around a disc has 8 a/dx edges, so that this is a quarter of the
 * edges per node. Half and double take 3 and 5 % more convolutions, 0 takes 22 % more (8 maps of
 * bench/adhesion.py, 256 nodes). */
static double
pinning(struct rc_gap *g)
{
    const struct rc_gap_problem *p = &g->problem;
    double sums[RC_GAP_SUMS], *x = g->maps.x, *beside = g->maps.beside;
    bool has[2];

    if (p->rows.ranks != NULL)
        rc_ranks_beside(&p->rows, false, p->px * sizeof *x, x,
                        x + (p->rows.n > 0 ? p->rows.n - 1 : 0) * p->px, beside, beside + p->px,
                        has);
    rc_sums_rows(&g->sums, edges_row, g, sums);
    return sums[EDGES] / 4 / (double)p->all;
}

/* The compliance of a wave, with this stiffness added. */
static double
pinned(double compliance, double stiffness)
{
    return compliance / (1 + stiffness * compliance);
}

/* Under a load A ignores the mean: the preconditioner gives the mean twice the largest factor of K. */
void
rc_gap_pin(struct rc_gap *g, bool on)
{
    const double stiffness = on ? g->set.stiffness : 0;

    rc_whole_pin(g->problem.whole, stiffness);
    g->set.pinned = stiffness > 0;
    g->set.lift = g->set.control == RC_GAP_LOAD ? pinned(2 * g->problem.whole->most, stiffness) -
                                                      pinned(g->problem.whole->mean, stiffness)
                                                : 0;
}

void
rc_gap_begin(struct rc_gap *g, enum rc_gap_control control, double given, bool first)
{
    double c = rc_gap_shift(g);

    g->set.control = control;
    g->set.given = given;
    if (control == RC_GAP_SHIFT && given != c)
        shift(g, c - given);
    if (control == RC_GAP_MEAN)
        shift(g, 0);
    g->set.stiffness = first ? pinning(g) : 0;
    rc_gap_pin(g, true);
    g->set.level = 0;
    g->way.restart = true;
    g->way.rz = 0;
    forget_error(&g->told);
    g->told.fresh = 1;
    g->run.stuck = g->run.parting = g->frozen.on = false;
    g->run.iterations = g->mode.steps = 0;
    g->run.convolutions = 0;
    g->near.known = false;
    memset(g->maps.z, 0, g->problem.n * sizeof *g->maps.z);
    memset(g->maps.d, 0, g->problem.n * sizeof *g->maps.d);
    memset(g->maps.ad, 0, g->problem.n * sizeof *g->maps.ad);
    g->mode.tracked = false;
    find_au(g);
}

/* ---- energy ---- */

enum {
    ENERGY_X, /* sums over x, u = x + h, p, u p, V */
    ENERGY_U,
    ENERGY_P,
    ENERGY_UP,
    ENERGY_V,
    ENERGY_P_SIZE, /* sums over |p|, |u p|, |V| */
    ENERGY_UP_SIZE,
    ENERGY_V_SIZE,
    ENERGY_CONTACT /* nodes */
};

static void
energy_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;
    const double *x = g->maps.x + j * g->problem.px;
    size_t m = rc_gap_on_map(&g->problem, j);

    for (size_t i = 0; i < g->problem.px; i++) {
        double u = i < m ? x[i] + g->problem.h[j * g->problem.nx + i] : x[i];
        double p = rc_gap_pressure_at(&g->set, g->maps.au, j * g->problem.px + i);
        sums[ENERGY_X] += x[i];
        sums[ENERGY_U] += u;
        sums[ENERGY_P] += p;
        sums[ENERGY_UP] += u * p;
        sums[ENERGY_P_SIZE] += fabs(p);
        sums[ENERGY_UP_SIZE] += fabs(u * p);
    }
    for (size_t i = 0; i < m; i += LINE) {
        size_t n = m - i < LINE ? m - i : LINE;
        double v[LINE], s[LINE], d[LINE];
        rc_gap_law(&g->problem, &g->frozen, j, i, n, x + i, v, s, d);
        for (size_t k = 0; k < n; k++) {
            sums[ENERGY_V] += v[k];
            sums[ENERGY_V_SIZE] += fabs(v[k]);
            sums[ENERGY_CONTACT] += x[i + k] <= 0;
        }
    }
}

/* If c is not given, A ignores the mean; of a given mean Phi then has a part that does not depend on the
 * state. */
struct rc_gap_energy
rc_gap_energy(struct rc_gap *g, enum rc_gap_control control)
{
    double sums[RC_GAP_SUMS], n = (double)g->problem.all, c = rc_gap_shift(g);
    struct rc_gap_energy e;

    rc_sums_rows(&g->sums, energy_row, g, sums);
    e.phi_scale = sums[ENERGY_UP_SIZE] + sums[ENERGY_V_SIZE] + fabs(c) * sums[ENERGY_P_SIZE];
    e.pressure = sums[ENERGY_P_SIZE];
    e.contact = sums[ENERGY_CONTACT];
    e.force_scale = control == RC_GAP_LOAD ? sums[ENERGY_X] : sums[ENERGY_P_SIZE];
    if (control == RC_GAP_SHIFT) {
        e.given = c;
        e.force = sums[ENERGY_P];
        e.phi = (sums[ENERGY_UP] + c * sums[ENERGY_P]) / 2 + sums[ENERGY_V];
        return e;
    }
    e.given = (control == RC_GAP_LOAD ? sums[ENERGY_P] : sums[ENERGY_X]) / n;
    e.force = control == RC_GAP_LOAD ? sums[ENERGY_X] : -sums[ENERGY_P];
    e.phi = (sums[ENERGY_UP] - sums[ENERGY_U] * sums[ENERGY_P] / n) / 2 + sums[ENERGY_V];
    if (control == RC_GAP_LOAD)
        e.phi += e.given * sums[ENERGY_X];
    return e;
}

enum {
    DOUBLES = 7
};

enum rc_status
rc_gap_new(struct rc_gap *g, struct rc_whole *whole, const struct rc_attraction *law,
           struct rc_err *err)
{
    const struct rc_rows *rows = &whole->rows;
    const size_t n = whole->grid.nx * rows->n;
    const size_t left = rows->first < whole->map.ny ? whole->map.ny - rows->first : 0;
    double **room[DOUBLES] = {&g->maps.x, &g->maps.au, &g->maps.r,   &g->maps.z,
                              &g->maps.d, &g->maps.ad, &g->maps.step};
    enum rc_status status;

    *g = (struct rc_gap){.problem = {.whole = whole,
                                     .law = *law,
                                     .nx = whole->map.nx,
                                     .ny = whole->map.ny,
                                     .px = whole->grid.nx,
                                     .py = whole->grid.ny,
                                     .rows = *rows,
                                     .on_map = left < rows->n ? left : rows->n,
                                     .n = n,
                                     .all = whole->grid.nx * whole->grid.ny,
                                     .hard = INFINITY}};
    for (size_t k = 0; k < DOUBLES; k++)
        *room[k] = rc_store_take(&g->own, n, sizeof(double));
    if (g->maps.step != NULL)
        for (size_t k = 1; k <= 2; k++)
            g->mode.e[RC_GAP_AZ - k] = (float *)g->maps.step + (2 - k) * n;
    for (size_t k = 0; k < RC_GAP_FLOATS; k++)
        if (g->mode.e[k] == NULL)
            g->mode.e[k] = rc_store_take(&g->own, n, sizeof(float));
    g->told.at_mark = rc_store_take(&g->own, n, sizeof(float));
    g->near.ah = rc_store_take(&g->own, n, sizeof(float));
    g->frozen.x = rc_store_take(&g->own, n, sizeof(float));
    g->maps.start = rc_store_take(&g->own, n, sizeof(float));
    g->maps.off = rc_store_zeros(&g->own, n, 1);
    g->maps.a_step = g->maps.r;
    if (rows->ranks != NULL)
        g->maps.beside = rc_store_take(&g->own, 2 * g->problem.px, sizeof(double));
    status = rc_sums_new(&g->sums, rows->ranks, rows->n, RC_GAP_MOST, RC_GAP_SUMS - RC_GAP_MOST,
                         whole->threads);
    return rc_ranks_need(rows->ranks, status == RC_OK && !g->own.failed, err,
                         "out of memory for the adhesion of %zu x %zu nodes", g->problem.nx,
                         g->problem.ny);
}

void
rc_gap_free(struct rc_gap *g)
{
    rc_store_free(&g->own);
    free(g->near.a);
    free(g->sums.row);
    free(g->problem.hards);
}

/* ---- along the softest mode, and off a saddle ---- */

void
rc_gap_aim(struct rc_gap *g, double rd)
{
    g->way.beta = g->way.rz = 0;
    g->way.dwd = NAN;
    g->way.rd = rd;
    g->way.dad = find_ad(g);
}

void
rc_gap_down(struct rc_gap *g, double first)
{
    struct line line = {0}, other = {0};
    double a = first;

    line.q = other.q = find_ad(g);
    look(g, &line, a);
    look(g, &other, -a);
    if (other.phi < line.phi) {
        line = other;
        a = -a;
    }
    for (int k = 0; k < DOUBLE; k++) {
        look(g, &other, 2 * a);
        if (!(other.phi < line.phi))
            break;
        line = other;
        a *= 2;
    }
    go(g, &line, a);
    g->way.restart = true;
    g->way.rz = 0;
    g->run.stuck = false;
    forget_error(&g->told);
}
