/*
 * Projected nonlinear conjugate gradients on the gap. The preconditioner is K on the nodes outside contact,
 * in single precision: because K A = 1, it leaves only the effects of contact and traction. A step costs A d
 * and K r, and, when a node has reached 0, A times the clipped part. Along the direction Phi is known without
 * a convolution.
 */
#include "gap.h"

#include <stdlib.h>
#include <string.h>

static const double clipped_anew =
    0.02; /* part of the free nodes: if more reach 0 in a step, CG restarts */
static const double curvature = 0.05; /* factor of d'A d: the least curvature that a step assumes */
static const double shorter = 0.4;
static const double single = 1e-6;           /* error of A d in single precision */
static const double float_rounding = 1.2e-7; /* error of the pressures of a step, L1 */
static const double vanishing = 1e-12;       /* relative to the largest traction */
static const double rounding = 4e-15;        /* error of A u in double precision, L1 */
static const double fresh =
    1e-4; /* when the error has fallen by this factor, A u is computed again */
static const double linear = 1e-2; /* an error below which the corrections are those of the state */
static const double most_cut = 0.2; /* part of the error from neglected coefficients */
static const double exact = 1e-3;   /* part of the slope that a line search may leave */
enum {
    LINE = RC_GAP_LINE,
    NEWTON = 12,
    SHORTEN = 12,
    PROJECT = 4,
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
hard_at(const struct rc_gap *g, size_t j, size_t i)
{
    return g->hards != NULL ? g->hards[j * g->nx + i] : g->hard;
}

/* Applies a function to all rows of the grid; ctx is the state, or the state and a number. */
static void
rows(const struct rc_gap *g, rc_sums_work *work, void *ctx, double *sums)
{
    rc_sums_rows(&g->sums, work, ctx, sums);
}

/* The state and a number for a row function. */
struct by {
    struct rc_gap *g;
    double a;
};

/* The tangent of V at the frozen gaps. */
static void
frozen_law(const struct rc_gap *g, const float *frozen, size_t n, const double *gap, double *v,
           double *s, double *d)
{
    double at[LINE] = {0};

    for (size_t k = 0; k < n; k++)
        at[k] = (double)frozen[k];
    g->law.law->at(&g->law, n, at, v, s, d);
    for (size_t k = 0; k < n; k++) {
        v[k] += s[k] * (gap[k] - at[k]);
        d[k] = 0;
    }
}

/* sigma, V and D at n <= LINE gaps of row j from node i on, with the hardness. */
void
rc_gap_law(const struct rc_gap *g, size_t j, size_t i, size_t n, const double *gap, double *v,
           double *s, double *d)
{
    if (g->frozen.on)
        frozen_law(g, g->frozen.x + j * g->px + i, n, gap, v, s, d);
    else
        g->law.law->at(&g->law, n, gap, v, s, d);
    if (!g->yields)
        return;
    for (size_t k = 0; k < n; k++)
        if (gap[k] < 0) {
            double hard = hard_at(g, j, i + k);
            v[k] -= hard * gap[k];
            s[k] -= hard;
        }
}

/* ---- A u ---- */

static bool
u_in(void *ctx, size_t j, void *to)
{
    const struct rc_gap *g = ctx;
    const double c = g->control == RC_GAP_SHIFT ? g->given : 0;
    double *row = to;

    for (size_t i = 0; i < g->px; i++)
        row[i] = g->x[j * g->px + i] + c;
    for (size_t i = 0; i < rc_gap_on_map(g, j); i++)
        row[i] += g->h[j * g->nx + i];
    return true;
}

static bool
u_out(void *ctx, size_t j, void *from)
{
    struct rc_gap *g = ctx;
    const double *row = from;
    double *sums = rc_sums_of(&g->sums, j);

    memcpy(g->au + j * g->px, row, g->px * sizeof *row);
    for (size_t i = 0; i < g->px; i++)
        sums[0] += row[i];
    return true;
}

/* Under a given load A ignores the mean. */
static void
take_mean(const struct rc_gap *g, double *v, double mean)
{
    if (g->control != RC_GAP_LOAD || mean == 0)
        return;
#pragma omp parallel for num_threads(g->sums.threads) schedule(static)
    for (size_t k = 0; k < g->n; k++)
        v[k] -= mean;
}

static void
find_au(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS];

    rc_sums_clear(&g->sums);
    rc_whole_rows(g->whole, RC_WHOLE_INVERSE, u_in, u_out, g);
    rc_sums_total(&g->sums, sums);
    take_mean(g, g->au, sums[0] / (double)g->n);
    g->convolutions++;
    g->told.drift = g->told.cuts = 0;
}

/* ---- residual ---- */

/* Computes r = A u + S + sigma and its sum over open nodes. */
static void
residual_row(void *ctx, size_t j, double *sums)
{
    struct rc_gap *g = ctx;
    const double *x = g->x + j * g->px, *au = g->au + j * g->px;
    const double load = g->control == RC_GAP_LOAD ? g->given : 0;
    double *r = g->r + j * g->px;
    size_t m = rc_gap_on_map(g, j);

    for (size_t i = 0; i < m; i += LINE) {
        size_t n = m - i < LINE ? m - i : LINE;
        double v[LINE], s[LINE], d[LINE];
        rc_gap_law(g, j, i, n, x + i, v, s, d);
        for (size_t k = 0; k < n; k++) {
            bool apart = x[i + k] != 0;
            r[i + k] = au[i + k] + load + s[k];
            sums[0] += apart ? r[i + k] : 0;
            sums[1] += apart;
        }
    }
    for (size_t i = m; i < g->px; i++) {
        r[i] = au[i] + load;
        sums[0] += r[i];
    }
    sums[1] += (double)(g->px - m);
}

/* Finds the held nodes and counts the changes. r becomes the negative residual on free nodes, and 0 on held
 * nodes. */
static void
hold_row(void *ctx, size_t j, double *sums)
{
    struct rc_gap *g = ctx;
    const double *x = g->x + j * g->px;
    double *r = g->r + j * g->px;
    unsigned char *off = g->off + j * g->px;
    size_t m = rc_gap_on_map(g, j);

    for (size_t i = 0; i < g->px; i++) {
        double at = r[i] - g->level;
        bool held = false;
        if (i < m && x[i] == 0) {
            double hard = g->yields ? hard_at(g, j, i) : INFINITY;
            held = at >= 0 && at <= hard;
            at = at > hard ? at - hard : at;
        }
        sums[2] += off[i] != held;
        off[i] = held;
        r[i] = held ? 0 : -at;
        sums[0] += r[i];
        sums[1] += !held;
        sums[RC_GAP_MOST] = larger(sums[RC_GAP_MOST], fabs(r[i]));
    }
}

static void
find_residual(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS];

    rows(g, residual_row, g, sums);
    g->level = g->control == RC_GAP_MEAN && sums[1] > 0 ? sums[0] / sums[1] : 0;
    rows(g, hold_row, g, sums);
    g->free = (size_t)sums[1];
    g->way.same = sums[2] == 0;
    g->mean_r = g->control != RC_GAP_MEAN ? sums[0] / (double)g->n
                : g->free > 0             ? sums[0] / sums[1]
                                          : 0;
    g->scale = sums[RC_GAP_MOST];
}

/* ---- z = K r ---- */

static bool
r_in(void *ctx, size_t j, void *to)
{
    const struct rc_gap *g = ctx;
    const unsigned char *off = g->off + j * g->px;
    double *r = g->r + j * g->px, per = 1 / g->scale;
    float *row = to;
    bool any = false;

    for (size_t i = 0; i < g->px; i++) {
        if (g->control == RC_GAP_MEAN && !off[i])
            r[i] -= g->mean_r;
        row[i] = (float)(r[i] * per);
        any |= row[i] != 0;
    }
    return any;
}

/* The sums are: r z, r times the z of the previous step, z, and |z|. */
static bool
z_out(void *ctx, size_t j, void *from)
{
    struct rc_gap *g = ctx;
    const unsigned char *off = g->off + j * g->px;
    const double *r = g->r + j * g->px;
    const float *row = from;
    double *z = g->z + j * g->px, *sums = rc_sums_of(&g->sums, j);

    for (size_t i = 0; i < g->px; i++) {
        double is = off[i] ? 0 : (double)row[i] * g->scale + g->lift * g->mean_r;
        sums[1] += r[i] * z[i];
        z[i] = is;
        sums[0] += r[i] * is;
        sums[2] += is;
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
barred(const struct rc_gap *g, size_t at, bool map)
{
    return map && g->x[at] == 0 && g->d[at] * g->r[at] < 0;
}

/* d = z + beta d within the bounds, minus `a`: the mean of z if the mean of d must be 0. */
static void
direction_row(void *ctx, size_t j, double *sums)
{
    const struct by *c = ctx;
    struct rc_gap *g = c->g;
    size_t m = rc_gap_on_map(g, j);

    for (size_t i = 0; i < g->px; i++) {
        size_t at = j * g->px + i;
        double is = g->off[at] ? 0 : g->z[at] - c->a + g->way.beta * g->d[at];
        g->d[at] = is;
        if (barred(g, at, i < m))
            g->d[at] = is = 0;
        sums[0] += g->r[at] * is;
        sums[1] += is;
        sums[2] += is != 0;
        sums[RC_GAP_MOST] = larger(sums[RC_GAP_MOST], fabs(is));
    }
}

static void
level_row(void *ctx, size_t j, double *sums)
{
    const struct by *c = ctx;
    struct rc_gap *g = c->g;
    size_t m = rc_gap_on_map(g, j);

    for (size_t i = 0; i < g->px; i++) {
        size_t at = j * g->px + i;
        if (g->d[at] == 0)
            continue;
        g->d[at] -= c->a;
        if (barred(g, at, i < m))
            g->d[at] = 0;
        sums[0] += g->r[at] * g->d[at];
        sums[1] += g->d[at];
        sums[2] += g->d[at] != 0;
    }
}

/* r'd */
static double
set_direction(struct rc_gap *g, double sum_z)
{
    struct by by = {g, g->control == RC_GAP_MEAN ? sum_z / (double)g->free : 0};
    double sums[RC_GAP_SUMS];

    rows(g, direction_row, &by, sums);
    g->way.unit = sums[RC_GAP_MOST];
    g->way.whole = (size_t)sums[2] == g->free;
    for (int k = 0; k < PROJECT && g->control == RC_GAP_MEAN && sums[2] > 0; k++) {
        by.a = sums[1] / sums[2];
        rows(g, level_row, &by, sums);
    }
    g->way.whole &= (size_t)sums[2] == g->free;
    return sums[0];
}

/* ---- A d ---- */

static bool
d_in(void *ctx, size_t j, void *to)
{
    const struct rc_gap *g = ctx;

    return to_single(g->d + j * g->px, g->px, 1 / g->way.unit, to);
}

static bool
ad_out(void *ctx, size_t j, void *from)
{
    struct rc_gap *g = ctx;
    const float *row = from;
    const double *d = g->d + j * g->px, *au = g->au + j * g->px;
    const double plus = (g->control == RC_GAP_LOAD ? g->given : 0) - g->level;
    double *ad = g->ad + j * g->px, *sums = rc_sums_of(&g->sums, j);
    float *az = g->mode.e[RC_GAP_AZ] + j * g->px;
    size_t m = rc_gap_on_map(g, j);

    for (size_t i = 0; i < g->px; i++) {
        double is = (double)row[i] * g->way.unit;
        if (i < m) {
            sums[0] += fabs(is - g->way.beta * ad[i]);
            sums[1] += fabs(au[i] + plus);
            sums[6] += fabs(is);
        }
        sums[2] += is * d[i];
        sums[3] += is;
        sums[4] += d[i];
        sums[5] += fabs(is * d[i]);
        az[i] = (float)(is - g->way.beta * ad[i]);
        ad[i] = is;
    }
    return true;
}

static void
mark_row(void *ctx, size_t j, double *sums)
{
    struct rc_gap *g = ctx;
    float *mark = g->told.at_mark + j * g->px;

    for (size_t i = 0; i < rc_gap_on_map(g, j); i++) {
        float p = (float)rc_gap_pressure_at(g, j * g->px + i);
        sums[0] += fabs((double)p - (double)mark[i]);
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
    rows(g, mark_row, g, sums);
    g->told.mark = off;
    if (last == 0)
        return;
    g->told.ratios[1] = g->told.ratios[0];
    g->told.ratios[0] = sums[0] / (last - off);
    if (isinf(g->told.ratios[1]))
        g->told.ratios[1] = g->told.ratios[0];
}

/* Finds the error. Changes that are negligible compared with the traction are rounding. */
static void
find_error(struct rc_gap *g)
{
    double off = g->told.change + g->told.drift;

    g->told.vanishes = off <= vanishing * g->law.strength * (double)(g->nx * g->ny);
    if (off == 0)
        g->told.error = rounding;
    else
        g->told.error = g->told.size > 0 ? off / g->told.size + rounding : INFINITY;
}

static void
forget_error(struct rc_gap *g)
{
    g->told.error = g->told.last = g->told.calm = g->told.ratios[0] = g->told.ratios[1] = INFINITY;
    g->told.mark = 0;
    g->told.vanishes = false;
}

/* Returns d'A d; finds the error and the mean of d. */
static double
find_ad(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS], mean;

    rc_sums_clear(&g->sums);
    rc_whole_rows(g->whole, RC_WHOLE_ROUGH_INVERSE, d_in, ad_out, g);
    rc_sums_total(&g->sums, sums);
    g->convolutions += 0.5;
    mean = g->control == RC_GAP_LOAD ? sums[3] / (double)g->n : 0;
    take_mean(g, g->ad, mean);
    g->told.size = sums[1];
    g->told.moves = sums[6];
    g->told.change = sums[0];
    find_error(g);
    g->way.mean = sums[4] / (double)g->n;
    return fmax(sums[2] - mean * sums[4], single * sums[5]);
}

/* ---- along the direction ---- */

/* Sums over a row: V(x + a d) - V(x) - a sigma(x) d; (sigma(x + a d) - sigma(x)) d; D d^2; |V|. */
static void
line_row(void *ctx, size_t j, double *sums)
{
    const struct by *c = ctx;
    const struct rc_gap *g = c->g;
    const double *x = g->x + j * g->px, *d = g->d + j * g->px, a = c->a;
    size_t m = rc_gap_on_map(g, j);

    for (size_t i = 0; i < m; i += LINE) {
        size_t n = m - i < LINE ? m - i : LINE;
        double v[2][LINE], s[2][LINE], k[LINE], at[LINE];
        for (size_t q = 0; q < n; q++)
            at[q] = x[i + q] + a * d[i + q];
        rc_gap_law(g, j, i, n, x + i, v[0], s[0], k);
        rc_gap_law(g, j, i, n, at, v[1], s[1], k);
        for (size_t q = 0; q < n; q++) {
            double way = d[i + q];
            sums[0] += v[1][q] - v[0][q] - a * s[0][q] * way;
            sums[1] += (s[1][q] - s[0][q]) * way;
            sums[2] += k[q] * way * way;
            sums[3] += fabs(v[1][q]);
        }
    }
}

/* step = a d clipped to the bounds; sums[0] counts clipped nodes. */
static void
clip_row(void *ctx, size_t j, double *sums)
{
    const struct by *c = ctx;
    struct rc_gap *g = c->g;
    size_t m = rc_gap_on_map(g, j);

    for (size_t i = 0; i < g->px; i++) {
        size_t at = j * g->px + i;
        double x = g->x[at], to = x + c->a * g->d[at];
        if (i < m && ((x >= 0 && to < 0 && !(x == 0 && g->yields)) || (x < 0 && to > 0))) {
            to = 0;
            sums[0]++;
        }
        sums[1] += to;
        sums[2] += i >= m || to > 0;
        g->step[at] = to - x;
    }
}

/* For a given mean: subtracts the increase by clipping from the open nodes. */
static void
lower_row(void *ctx, size_t j, double *sums)
{
    const struct by *c = ctx;
    struct rc_gap *g = c->g;
    for (size_t i = 0; i < g->px; i++) {
        size_t at = j * g->px + i;
        double to = g->x[at] + g->step[at];
        if (to > 0) {
            to = larger(0, to - c->a);
            g->step[at] = to - g->x[at];
        }
        sums[1] += to;
        sums[2] += to > 0;
    }
}

static void
keep_mean(struct rc_gap *g, double sum, double count)
{
    const double want = g->given * (double)g->n;
    double sums[RC_GAP_SUMS] = {0, sum, count};

    for (int k = 0; k < NEWTON && sums[2] > 0; k++) {
        struct by by = {g, (sums[1] - want) / sums[2]};
        if (fabs(sums[1] - want) <= 1e-15 * want)
            return;
        rows(g, lower_row, &by, sums);
    }
}

static bool
step_in(void *ctx, size_t j, void *to)
{
    const struct rc_gap *g = ctx;

    return to_single(g->step + j * g->px, g->px, 1 / g->way.unit, to);
}

/* Sums over A s for the step s: s'A s/2, s'A u, A s, s, and |A s| on the map. */
static void
step_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;
    const double *step = g->step + j * g->px, *au = g->au + j * g->px;
    const double *to = g->a_step + j * g->px;
    size_t m = rc_gap_on_map(g, j);

    for (size_t i = 0; i < g->px; i++) {
        sums[0] += step[i] * to[i] / 2;
        sums[1] += step[i] * au[i];
        sums[2] += to[i];
        sums[3] += step[i];
        sums[4] += i < m ? fabs(to[i]) : 0;
    }
}

static bool
step_out(void *ctx, size_t j, void *from)
{
    struct rc_gap *g = ctx;
    const float *row = from;

    for (size_t i = 0; i < g->px; i++)
        g->a_step[j * g->px + i] = (double)row[i] * g->way.unit;
    step_row(g, j, rc_sums_of(&g->sums, j));
    return true;
}

/* Sums of the change of V by the step, and of |V|. */
static void
step_law_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;
    const double *x = g->x + j * g->px, *step = g->step + j * g->px;
    size_t m = rc_gap_on_map(g, j);

    for (size_t i = 0; i < m; i += LINE) {
        size_t n = m - i < LINE ? m - i : LINE;
        double v[2][LINE], s[LINE], k[LINE], at[LINE];
        for (size_t q = 0; q < n; q++)
            at[q] = x[i + q] + step[i + q];
        rc_gap_law(g, j, i, n, x + i, v[0], s, k);
        rc_gap_law(g, j, i, n, at, v[1], s, k);
        for (size_t q = 0; q < n; q++) {
            sums[0] += v[1][q] - v[0][q];
            sums[1] += fabs(v[1][q]);
        }
    }
}

/* Returns the change of Phi by `step`; finds `moves`, and a_step if it is not yet `known`. */
static double
rise(struct rc_gap *g, bool known, double *least)
{
    double sums[RC_GAP_SUMS], law[RC_GAP_SUMS], load = g->control == RC_GAP_LOAD ? g->given : 0,
                                                mean;

    if (known) {
        rows(g, step_row, g, sums);
    } else {
        rc_sums_clear(&g->sums);
        rc_whole_rows(g->whole, RC_WHOLE_ROUGH_INVERSE, step_in, step_out, g);
        rc_sums_total(&g->sums, sums);
        g->convolutions += 0.5;
        g->told.cut = 0;
    }
    mean = g->control == RC_GAP_LOAD ? sums[2] / (double)g->n : 0;
    take_mean(g, g->a_step, mean);
    rows(g, step_law_row, g, law);
    *least = 1e-14 * (law[1] + fabs(sums[1])) + single * fabs(sums[0]);
    g->told.moves = sums[4];
    return sums[0] - mean * sums[3] / 2 + sums[1] + load * sums[3] + law[0];
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
    for (size_t k = j * g->px; k < (j + 1) * g->px; k++) {
        g->x[k] += t->a * t->step[k];
        g->au[k] += t->a * t->a_step[k];
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

    rows(g, line_row, &(struct by){g, a}, sums);
    l->phi = a * (a * l->q / 2 - l->rd) + sums[0];
    l->slope = a * l->q - l->rd + sums[1];
    l->bend = l->q - sums[2];
    l->rounding = 1e-14 * (sums[3] + a * a * l->q);
}

/* The stiffness along d, with the curvature `bend` at a = 0. */
static double
way_of(const struct rc_gap *g, const struct line *l)
{
    return g->way.dwd > 0 ? l->bend / g->way.dwd : INFINITY;
}

/* The minimum along d by Newton's method from a = 0. Once slopes of both signs are known, the iterates stay
 * between them. */
static double
line_minimum(struct rc_gap *g, struct line *l, double most)
{
    double a = 0, low = 0, high = INFINITY;

    look(g, l, 0);
    g->way.stiffness = way_of(g, l);
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
        rows(g, clip_row, &by, sums);
        if (sums[0] == 0) {
            if (k > 0)
                look(g, l, by.a);
            g->told.drift += float_rounding * by.a * g->told.moves;
            rows(g, take_row, &(struct taken){g, by.a, g->d, g->ad}, sums);
            return;
        }
        g->way.restart = sums[0] > clipped_anew * (double)g->free;
        near = rc_gap_near(g, by.a, (size_t)sums[0], sums[1]);
        if (!near && g->control == RC_GAP_MEAN)
            keep_mean(g, sums[1], sums[2]);
        up = rise(g, near, &least);
        if (up <= least) {
            g->told.drift += float_rounding * g->told.moves + g->told.cut;
            g->told.cuts += g->told.cut;
            rows(g, take_row, &(struct taken){g, 1, g->step, g->a_step}, sums);
            return;
        }
        g->way.restart = true;
    }
    g->stuck = true;
}

static void
largest_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;

    for (size_t i = 0; i < rc_gap_on_map(g, j); i++)
        sums[RC_GAP_MOST] = larger(sums[RC_GAP_MOST], fabs(g->d[j * g->px + i]));
}

/* The largest step before an open node reaches 0. */
static void
reach_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;
    const double *x = g->x + j * g->px, *d = g->d + j * g->px;

    for (size_t i = 0; i < rc_gap_on_map(g, j); i++)
        if (x[i] > 0 && d[i] < 0)
            sums[RC_GAP_MOST] = larger(sums[RC_GAP_MOST], -x[i] / d[i]);
}

static void
nearest_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;

    sums[RC_GAP_MOST] = -INFINITY;
    for (size_t i = 0; i < rc_gap_on_map(g, j); i++)
        sums[RC_GAP_MOST] = larger(sums[RC_GAP_MOST], -g->x[j * g->px + i]);
}

/* The longest step under a given load, where a uniform motion has no other bound. If the bodies separate,
 * the step must not pass over the range of the attraction; if they approach, it ends where the last node
 * touches. */
static double
longest(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS];

    if (g->control != RC_GAP_LOAD || g->way.mean == 0 || (g->way.mean > 0 && g->given >= 0))
        return INFINITY;
    rows(g, g->way.mean < 0 ? reach_row : largest_row, g, sums);
    if (g->way.mean < 0)
        return sums[RC_GAP_MOST] > 0 ? sums[RC_GAP_MOST] : INFINITY;
    return 4 * g->law.range / sums[RC_GAP_MOST];
}

void
rc_gap_look_along(struct rc_gap *g)
{
    struct line line = {.rd = g->way.rd, .q = g->way.dad};

    g->way.stiffness = INFINITY;
    if (g->stuck || !(g->way.rd > 0))
        return;
    look(g, &line, 0);
    g->way.stiffness = way_of(g, &line);
}

static double
find_z(struct rc_gap *g, double *old, double *sum_z)
{
    double sums[RC_GAP_SUMS];

    if (g->scale == 0) {
        memset(g->z, 0, g->n * sizeof *g->z);
        *old = *sum_z = 0;
        return 0;
    }
    rc_sums_clear(&g->sums);
    rc_whole_rows(g->whole, RC_WHOLE_ROUGH, r_in, z_out, g);
    rc_sums_total(&g->sums, sums);
    g->convolutions += 0.5;
    *old = sums[1];
    *sum_z = sums[2];
    return sums[0];
}

static void
refresh(struct rc_gap *g)
{
    find_au(g);
    g->told.fresh = g->told.error;
}

/* True if most of the error comes from A u in single precision. */
static bool
drifted(const struct rc_gap *g)
{
    return g->told.drift > 10 * g->told.change || g->told.cuts > most_cut * g->told.change;
}

/* Computes d'W d, where W is the inverse of K on the free nodes, from r'z = z'W z and r = W z. NAN if the set
 * of free nodes has changed since the last direction. */
static void
measure_way(struct rc_gap *g, double rz)
{
    double along = g->way.rd - rz; /* beta times r'd of the last direction */
    double last =
        g->way.beta > 0 ? (g->way.same ? g->way.beta * g->way.beta * g->way.dwd : NAN) : 0;

    g->way.dwd = g->way.whole ? rz + 2 * along + last : NAN;
}

void
rc_gap_look(struct rc_gap *g)
{
    double rz, old, sum_z;

    if (g->told.error <= fresh * g->told.fresh || drifted(g))
        refresh(g);
    find_residual(g);
    rz = find_z(g, &old, &sum_z);
    g->way.beta = g->way.restart || !(g->way.rz > 0) ? 0 : fmax((rz - old) / g->way.rz, 0);
    g->way.rd = set_direction(g, sum_z);
    if (!(g->way.rd > 0) && g->way.beta > 0) {
        g->way.beta = 0;
        g->way.rd = set_direction(g, sum_z);
    }
    measure_way(g, rz);
    g->way.rz = rz;
    g->way.restart = false;
    g->iterations++;
    if (g->way.rd > 0) {
        g->way.dad = find_ad(g);
        measure_ratio(g);
        if (!g->mode.known && !g->frozen.on && g->told.error < linear)
            rc_gap_track(g, g->control == RC_GAP_MEAN ? sum_z / (double)g->free : 0);
        return;
    }
    if (g->told.drift > 0) { /* the residual is rounding, perhaps of A u: compute A u again */
        refresh(g);
        g->way.restart = true;
        return;
    }
    g->stuck = true;
    if (rz > 0 && g->told.size > 0)
        find_error(g);
    else
        g->told.error = rounding;
}

void
rc_gap_move(struct rc_gap *g)
{
    struct line line = {.rd = g->way.rd, .q = g->way.dad};
    double sums[RC_GAP_SUMS];

    if (g->stuck || !(g->way.rd > 0))
        return;
    go(g, &line, line_minimum(g, &line, longest(g)));
    if (g->stuck && drifted(g)) { /* first compute A u again */
        refresh(g);
        g->way.restart = true;
        g->stuck = false;
    }
    g->parting = g->control == RC_GAP_LOAD && g->given < 0 && g->way.mean > 0;
    if (g->parting) {
        rows(g, nearest_row, g, sums);
        g->parting = -sums[RC_GAP_MOST] > 20 * g->law.range;
    }
}

/* ---- states ---- */

static void
mean_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = *(const struct rc_gap *const *)ctx;
    size_t m = rc_gap_on_map(g, j);

    for (size_t i = 0; i < g->px; i++)
        sums[0] += g->x[j * g->px + i];
    for (size_t i = 0; i < m; i++)
        sums[0] += g->h[j * g->nx + i];
}

double
rc_gap_shift(const struct rc_gap *g)
{
    double sums[RC_GAP_SUMS], mean;

    if (g->control == RC_GAP_SHIFT)
        return g->given;
    rows(g, mean_row, &g, sums);
    mean = sums[0] / (double)g->n;
    return (g->control == RC_GAP_LOAD ? g->whole->mean * g->given : 0) - mean;
}

void
rc_gap_apart(struct rc_gap *g, double clearance)
{
    for (size_t j = 0; j < g->py; j++)
        for (size_t i = 0; i < g->px; i++) {
            bool map = j < g->ny && i < g->nx;
            g->x[j * g->px + i] = clearance - (map ? g->h[j * g->nx + i] : 0);
        }
    g->control = g->whole->boundary == RC_FREE ? RC_GAP_SHIFT : RC_GAP_MEAN;
    g->given = -clearance;
    g->mode.known = false;
}

/* Moves the open nodes of the map, and the nodes beyond the map, by `a`. */
static void
shift_row(void *ctx, size_t j, double *sums)
{
    const struct by *c = ctx;
    struct rc_gap *g = c->g;
    size_t m = rc_gap_on_map(g, j);

    for (size_t i = 0; i < g->px; i++) {
        double *x = g->x + j * g->px + i;
        if (i >= m || *x > 0)
            *x = i < m ? fmax(*x + c->a, 0) : *x + c->a;
        sums[1] += *x;
        sums[2] += i >= m || *x > 0;
    }
}

static void
shift(struct rc_gap *g, double a)
{
    struct by by = {g, a};
    double sums[RC_GAP_SUMS];

    rows(g, shift_row, &by, sums);
    if (g->control == RC_GAP_MEAN && sums[2] == 0) { /* no node is open, so that none would move */
        for (size_t k = 0; k < g->n; k++)
            g->x[k] = g->given;
        return;
    }
    for (int k = 0; k < NEWTON && g->control == RC_GAP_MEAN && sums[2] > 0; k++) {
        by.a = (g->given * (double)g->n - sums[1]) / sums[2];
        if (fabs(by.a) <= 1e-15 * g->given)
            break;
        rows(g, shift_row, &by, sums);
    }
}

static void
keep(const struct rc_gap *g, float *to)
{
#pragma omp parallel for num_threads(g->sums.threads) schedule(static)
    for (size_t k = 0; k < g->n; k++)
        to[k] = (float)g->x[k];
}

void
rc_gap_keep(struct rc_gap *g)
{
    keep(g, g->start);
}

void
rc_gap_return(struct rc_gap *g, enum rc_gap_control control, double given)
{
#pragma omp parallel for num_threads(g->sums.threads) schedule(static)
    for (size_t k = 0; k < g->n; k++)
        g->x[k] = (double)g->start[k];
    g->control = control;
    g->given = given;
    g->mode.known = false; /* its softest mode belongs to another gap */
}

void
rc_gap_freeze(struct rc_gap *g, bool at_start)
{
    if (at_start)
        memcpy(g->frozen.x, g->start, g->n * sizeof *g->start);
    else
        keep(g, g->frozen.x);
    g->way.restart = g->frozen.on = true;
    g->way.rz = 0;
    g->stuck = false;
    forget_error(g);
}

void
rc_gap_begin(struct rc_gap *g, enum rc_gap_control control, double given)
{
    double c = rc_gap_shift(g);

    g->control = control;
    g->given = given;
    if (control == RC_GAP_SHIFT && given != c)
        shift(g, c - given);
    if (control == RC_GAP_MEAN)
        shift(g, 0);
    /* under a load, lifts the factor of the mean to twice the largest factor; otherwise K has the mean */
    g->lift = control == RC_GAP_LOAD ? (2 * g->whole->most - g->whole->mean) : 0;
    g->level = 0;
    g->way.restart = true;
    g->way.rz = 0;
    forget_error(g);
    g->told.fresh = 1;
    g->stuck = g->parting = g->frozen.on = false;
    g->iterations = g->mode.steps = 0;
    g->convolutions = 0;
    g->near.known = false;
    memset(g->z, 0, g->n * sizeof *g->z);
    memset(g->d, 0, g->n * sizeof *g->d);
    memset(g->ad, 0, g->n * sizeof *g->ad);
    g->mode.tracked = false;
    find_au(g);
}

/* ---- energy ---- */

/* Sums over x, u = x + h, p, u p, V; over |p|, |u p|, |V|; nodes in contact. */
static void
energy_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;
    const double *x = g->x + j * g->px;
    size_t m = rc_gap_on_map(g, j);

    for (size_t i = 0; i < g->px; i++) {
        double u = i < m ? x[i] + g->h[j * g->nx + i] : x[i];
        double p = rc_gap_pressure_at(g, j * g->px + i);
        sums[0] += x[i];
        sums[1] += u;
        sums[2] += p;
        sums[3] += u * p;
        sums[5] += fabs(p);
        sums[6] += fabs(u * p);
    }
    for (size_t i = 0; i < m; i += LINE) {
        size_t n = m - i < LINE ? m - i : LINE;
        double v[LINE], s[LINE], d[LINE];
        rc_gap_law(g, j, i, n, x + i, v, s, d);
        for (size_t k = 0; k < n; k++) {
            sums[4] += v[k];
            sums[7] += fabs(v[k]);
            sums[8] += x[i + k] <= 0;
        }
    }
}

/* If c is not given, A ignores the mean; of a given mean Phi then has a part that does not depend on the
 * state. */
struct rc_gap_energy
rc_gap_energy(struct rc_gap *g, enum rc_gap_control control)
{
    double sums[RC_GAP_SUMS], n = (double)g->n, c = rc_gap_shift(g);
    struct rc_gap_energy e;

    rows(g, energy_row, g, sums);
    e.phi_scale = sums[6] + sums[7] + fabs(c) * sums[5];
    e.pressure = sums[5];
    e.contact = sums[8];
    e.force_scale = control == RC_GAP_LOAD ? sums[0] : sums[5];
    if (control == RC_GAP_SHIFT) {
        e.given = c;
        e.force = sums[2];
        e.phi = (sums[3] + c * sums[2]) / 2 + sums[4];
        return e;
    }
    e.given = (control == RC_GAP_LOAD ? sums[2] : sums[0]) / n;
    e.force = control == RC_GAP_LOAD ? sums[0] : -sums[2];
    e.phi = (sums[3] - sums[1] * sums[2] / n) / 2 + sums[4];
    if (control == RC_GAP_LOAD)
        e.phi += e.given * sums[0];
    return e;
}

enum {
    DOUBLES = 7
};

enum rc_status
rc_gap_new(struct rc_gap *g, struct rc_whole *whole, const struct rc_attraction *law,
           const double *h, double hard, double *hards, struct rc_err *err)
{
    size_t n = whole->grid.nx * whole->grid.ny;
    double **room[DOUBLES] = {&g->x, &g->au, &g->r, &g->z, &g->d, &g->ad, &g->step};

    *g = (struct rc_gap){.whole = whole,
                         .law = *law,
                         .nx = whole->map.nx,
                         .ny = whole->map.ny,
                         .px = whole->grid.nx,
                         .py = whole->grid.ny,
                         .n = n,
                         .h = h,
                         .hard = hard,
                         .hards = hards,
                         .yields = hards != NULL || !isinf(hard)};
    for (size_t k = 0; k < DOUBLES; k++)
        *room[k] = rc_store_take(&g->own, n, sizeof(double));
    if (g->step != NULL)
        for (size_t k = 1; k <= 2; k++)
            g->mode.e[RC_GAP_AZ - k] = (float *)g->step + (2 - k) * n;
    for (size_t k = 0; k < RC_GAP_FLOATS; k++)
        if (g->mode.e[k] == NULL)
            g->mode.e[k] = rc_store_take(&g->own, n, sizeof(float));
    g->told.at_mark = rc_store_take(&g->own, n, sizeof(float));
    g->near.ah = rc_store_take(&g->own, n, sizeof(float));
    g->frozen.x = rc_store_take(&g->own, n, sizeof(float));
    g->start = rc_store_take(&g->own, n, sizeof(float));
    g->off = rc_store_zeros(&g->own, n, 1);
    g->a_step = g->r;
    if (rc_sums_new(&g->sums, g->py, RC_GAP_MOST, RC_GAP_SUMS - RC_GAP_MOST, whole->threads) ==
            RC_OK &&
        !g->own.failed)
        return RC_OK;
    return rc_err_set(err, "out of memory for the adhesion of %zu x %zu nodes", g->nx, g->ny);
}

void
rc_gap_free(struct rc_gap *g)
{
    rc_store_free(&g->own);
    free(g->near.a);
    free(g->sums.row);
    free(g->hards);
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
    g->stuck = false;
    forget_error(g);
}
