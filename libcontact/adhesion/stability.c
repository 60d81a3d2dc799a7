/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The smallest eigenvalue of the stiffness, on the nodes outside contact. The stiffness is A minus the
 * softening by the traction. It solves (A - D) x = mu W x, where W is the inverse of K on these nodes. All
 * eigenvalues are at most about 1, and the number of far smaller ones is the number of soft modes of the
 * traction.
 *
 * Each step takes the best x in the space of x, of its residual times K, and of the last change of x. W x and
 * (A - D) x of these vectors are updated with them, in single precision. Every mu on the way is above the
 * smallest eigenvalue.
 *
 * The corrections z = K r of the descent span nearly the same space as those of this search. For each of them
 * W z and A z are known. The descent therefore finds the first vector of the search without a convolution.
 */
#include "gap.h"

#include <stdint.h>
#include <string.h>

enum {
    X,
    Y = 3,
    D = 6, /* a vector, W times it, A - D times it */
    SPACE = 3
};
/* Squared part of a unit vector outside the space of the others: below it single precision leaves no
 * digit. Half and double change no bit (27 runs of bench/constants.py). */
static const double dependent = 1e-5;
/* mu over the last one, above which a step is slow. Half takes 1 % fewer convolutions and leaves the
 * eigenvalue less accurate (27 runs of bench/constants.py). */
static const double steady = 0.98;
/* Part of the slope that must be left at twice the linear step. Half changes no bit. Double lets no
 * step pass and takes 23 % more convolutions (27 runs of bench/constants.py). */
static const double margin = 0.5;

/* ---- K r and (A - D) x, of one vector ---- */

struct product {
    struct rc_gap *g;
    const float *from;
    float *to;
    double mean, scale; /* mean of the input; factor */
};

static bool
take_row(void *ctx, size_t j, void *to)
{
    const struct product *p = ctx;
    const struct rc_gap *g = p->g;
    const unsigned char *off = g->maps.off + j * g->problem.px;
    const float *from = p->from + j * g->problem.px;
    float *row = to;
    bool any = false;

    for (size_t i = 0; i < g->problem.px; i++) {
        row[i] = off[i] ? 0 : from[i];
        any |= row[i] != 0;
    }
    return any;
}

enum {
    GIVEN_ALL,  /* sum of the product */
    GIVEN_FREE, /* the same on free nodes */
    GIVEN_FROM, /* sum of the vector on free nodes */
    GIVEN_NODES /* free nodes */
};

static bool
give_row(void *ctx, size_t j, void *from)
{
    const struct product *p = ctx;
    struct rc_gap *g = p->g;
    const float *row = from;
    double *sums = rc_sums_of(&g->sums, j);

    for (size_t i = 0; i < g->problem.px; i++) {
        bool off = g->maps.off[j * g->problem.px + i];
        p->to[j * g->problem.px + i] = row[i];
        sums[GIVEN_ALL] += (double)row[i];
        sums[GIVEN_FREE] += off ? 0 : (double)row[i];
        sums[GIVEN_FROM] += off ? 0 : (double)p->from[j * g->problem.px + i];
        sums[GIVEN_NODES] += !off;
    }
    return true;
}

/* The mean of the output over all nodes, and the value to add on free nodes. */
static void
add_mean(const struct product *p, double add)
{
    struct rc_gap *g = p->g;

#pragma omp parallel for num_threads(g->sums.threads) schedule(static)
    for (size_t k = 0; k < g->problem.n; k++)
        p->to[k] = g->maps.off[k] ? 0 : (float)((double)p->to[k] + add);
}

static void
apply_k(struct rc_gap *g, const float *from, float *to)
{
    struct product p = {.g = g, .from = from, .to = to};
    double sums[RC_GAP_SUMS];

    rc_sums_clear(&g->sums);
    rc_whole_rows(g->problem.whole, RC_WHOLE_ROUGH, take_row, give_row, &p);
    rc_sums_total(&g->sums, sums);
    g->run.convolutions += 0.5;
    add_mean(&p, g->set.control == RC_GAP_MEAN && sums[GIVEN_NODES] > 0
                     ? -sums[GIVEN_FREE] / sums[GIVEN_NODES]
                     : g->set.lift * sums[GIVEN_FROM] / (double)g->problem.all);
}

/* Subtracts D x. */
static void
soften(const struct rc_gap_problem *problem, const struct rc_gap_frozen *frozen,
       const struct rc_gap_maps *maps, int threads, const float *x, float *to)
{
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t j = 0; j < problem->on_map; j++)
        for (size_t i = 0; i < problem->nx; i += RC_GAP_LINE) {
            size_t n = problem->nx - i < RC_GAP_LINE ? problem->nx - i : RC_GAP_LINE,
                   at = j * problem->px + i;
            double v[RC_GAP_LINE], s[RC_GAP_LINE], d[RC_GAP_LINE];
            rc_gap_law(problem, frozen, j, i, n, maps->x + at, v, s, d);
            for (size_t k = 0; k < n; k++)
                if (!maps->off[at + k])
                    to[at + k] -= (float)(d[k] * (double)x[at + k]);
        }
}

static void
apply_stiffness(struct rc_gap *g, const float *from, float *to)
{
    struct product p = {.g = g, .from = from, .to = to};
    double sums[RC_GAP_SUMS];

    rc_sums_clear(&g->sums);
    rc_whole_rows(g->problem.whole, RC_WHOLE_ROUGH_INVERSE, take_row, give_row, &p);
    rc_sums_total(&g->sums, sums);
    g->run.convolutions += 0.5;
    add_mean(&p, g->set.control == RC_GAP_LOAD ? -sums[GIVEN_ALL] / (double)g->problem.all : 0);
    soften(&g->problem, &g->frozen, &g->maps, g->sums.threads, from, to);
}

/* ---- the space of three ---- */

enum {
    GRAM_W,    /* W, row by row up to its diagonal */
    GRAM_T = 6 /* A - D, in the same order */
};

static void
gram_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;
    for (size_t k = j * g->problem.px; k < (j + 1) * g->problem.px; k++) {
        size_t q = 0;
        for (size_t a = 0; a < SPACE; a++)
            for (size_t b = 0; b <= a; b++, q++) {
                sums[GRAM_W + q] += (double)g->mode.e[3 * a][k] * (double)g->mode.e[3 * b + 1][k];
                sums[GRAM_T + q] += (double)g->mode.e[3 * a][k] * (double)g->mode.e[3 * b + 2][k];
            }
    }
}

/* The eigenvector of the smallest eigenvalue of a symmetric m x m matrix, by Jacobi's rotations. */
static double
smallest(size_t m, double a[SPACE][SPACE], double *vector)
{
    double v[SPACE][SPACE] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    size_t least = 0;

    for (int sweep = 0; sweep < 30; sweep++)
        for (size_t p = 0; p < m; p++)
            for (size_t q = p + 1; q < m; q++) {
                double t, c, s, theta;
                if (a[p][q] == 0)
                    continue;
                theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
                t = (theta < 0 ? -1 : 1) / (fabs(theta) + hypot(theta, 1));
                c = 1 / hypot(t, 1);
                s = t * c;
                for (size_t k = 0; k < m; k++) {
                    double x = a[k][p], y = a[k][q];
                    a[k][p] = c * x - s * y;
                    a[k][q] = s * x + c * y;
                }
                for (size_t k = 0; k < m; k++) {
                    double x = a[p][k], y = a[q][k];
                    a[p][k] = c * x - s * y;
                    a[q][k] = s * x + c * y;
                    x = v[k][p];
                    y = v[k][q];
                    v[k][p] = c * x - s * y;
                    v[k][q] = s * x + c * y;
                }
            }
    for (size_t k = 1; k < m; k++)
        if (a[k][k] < a[least][least])
            least = k;
    for (size_t k = 0; k < m; k++)
        vector[k] = v[k][least];
    return a[least][least];
}

/* Coefficients of the best vector of the space, with x'W x = 1; a vector that depends on others gets 0. */
static void
best(const double *sums, double *c)
{
    double w[SPACE][SPACE], t[SPACE][SPACE], low[SPACE][SPACE] = {{0}}, is[SPACE][SPACE],
                                             unit[SPACE], y[SPACE];
    size_t kept[SPACE], m = 0;

    for (size_t a = 0, q = 0; a < SPACE; a++)
        for (size_t b = 0; b <= a; b++, q++) {
            w[a][b] = w[b][a] = sums[GRAM_W + q];
            t[a][b] = t[b][a] = sums[GRAM_T + q];
        }
    memset(c, 0, SPACE * sizeof *c);
    /* Cholesky factor of W on unit vectors */
    for (size_t a = 0; a < SPACE; a++) {
        double rest = 1;
        if (!(w[a][a] > 0))
            continue;
        unit[m] = 1 / sqrt(w[a][a]);
        for (size_t b = 0; b < m; b++) {
            double sum = w[a][kept[b]] * unit[m] * unit[b];
            for (size_t k = 0; k < b; k++)
                sum -= low[m][k] * low[b][k];
            low[m][b] = sum / low[b][b];
            rest -= low[m][b] * low[m][b];
        }
        if (rest < dependent)
            continue;
        low[m][m] = sqrt(rest);
        kept[m++] = a;
    }
    /* L^-1 T L^-T */
    for (size_t b = 0; b < m; b++)
        for (size_t a = 0; a < m; a++) {
            double sum = t[kept[a]][kept[b]] * unit[a] * unit[b];
            for (size_t k = 0; k < a; k++)
                sum -= low[a][k] * is[k][b];
            is[a][b] = sum / low[a][a];
        }
    for (size_t a = 0; a < m; a++)
        for (size_t b = 0; b < m; b++) {
            double sum = is[a][b];
            for (size_t k = 0; k < b; k++)
                sum -= low[b][k] * is[a][k];
            is[a][b] = sum / low[b][b];
        }
    if (m == 0)
        return;
    (void)smallest(m, is, y);
    for (size_t a = m; a-- > 0;) {
        double sum = y[a];
        for (size_t k = a + 1; k < m; k++)
            sum -= low[k][a] * y[k];
        y[a] = sum / low[a][a];
    }
    for (size_t a = 0; a < m; a++)
        c[kept[a]] = y[a] * unit[a];
}

/* ---- the iteration ---- */

struct first {
    struct rc_gap *g;
    bool given;
    double noise, released; /* W x of released nodes; 0: none has been released in this state */
};

/* True for a free node of the map that was held when W x was found. */
static bool
released(const unsigned char *off, const struct rc_gap_mode *mode, size_t at)
{
    return !off[at] && mode->e[X + 1][at] == 0;
}

enum {
    FIRST_SUM,   /* of W x */
    FIRST_FREE,  /* free nodes */
    FIRST_SQUARE /* sum of (W x)^2 */
};

static void
size_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;

    for (size_t k = j * g->problem.px; k < (j + 1) * g->problem.px; k++)
        sums[FIRST_SQUARE] += (double)g->mode.e[X + 1][k] * (double)g->mode.e[X + 1][k];
}

/* If no first vector is given, W x is the softening by the traction. A
 * released node may have softer modes than the given one, and the first vector contains its motion. */
static void
first_row(void *ctx, size_t j, double *sums)
{
    const struct first *c = ctx;
    struct rc_gap *g = c->g;
    size_t m = rc_gap_on_map(&g->problem, j);
    float *w = g->mode.e[X + 1] + j * g->problem.px;

    for (size_t i = 0; i < m && !c->given; i += RC_GAP_LINE) {
        size_t n = m - i < RC_GAP_LINE ? m - i : RC_GAP_LINE, at = j * g->problem.px + i;
        double v[RC_GAP_LINE], s[RC_GAP_LINE], d[RC_GAP_LINE];
        rc_gap_law(&g->problem, &g->frozen, j, i, n, g->maps.x + at, v, s, d);
        for (size_t k = 0; k < n; k++)
            w[i + k] = (float)(d[k] / g->problem.law.steepest);
    }
    /* with noise, x has a part of every wave: symmetry then hides no eigenvector */
    for (size_t i = 0; i < g->problem.px; i++) {
        const size_t at = (g->problem.rows.first + j) * g->problem.px + i;
        uint64_t hash = ((uint64_t)at + 1) * 0x9e3779b97f4a7c15u;
        double noise = (double)(hash >> 40) / 0x1p24 - 0.5;
        if (!c->given && i >= m)
            w[i] = 0;
        if (c->released > 0 && i < m && released(g->maps.off, &g->mode, j * g->problem.px + i))
            w[i] = (float)c->released;
        if (i < m)
            w[i] = (float)((double)w[i] * (1 + noise / 4) + c->noise * noise);
        if (g->maps.off[j * g->problem.px + i])
            w[i] = 0;
        sums[FIRST_SUM] += (double)w[i];
        sums[FIRST_FREE] += !g->maps.off[j * g->problem.px + i];
        sums[FIRST_SQUARE] += (double)w[i] * (double)w[i];
    }
}

static void
combine(struct rc_gap_mode *mode, size_t n, int threads, const double *c)
{
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t k = 0; k < n; k++)
        for (size_t q = 0; q < 3; q++) {
            double way = c[1] * (double)mode->e[Y + q][k] + c[2] * (double)mode->e[D + q][k];
            mode->e[D + q][k] = (float)way;
            mode->e[X + q][k] = (float)(c[0] * (double)mode->e[X + q][k] + way);
        }
}

static void
clear(struct rc_gap_mode *mode, size_t n, size_t first)
{
    for (size_t q = 0; q < 3; q++)
        memset(mode->e[first + q], 0, n * sizeof *mode->e[0]);
}

enum {
    RESIDUAL_SUM,
    RESIDUAL_FREE /* free nodes */
};

/* W y = t - mu w, minus its mean on free nodes if the mean is given. */
static void
residual_row(void *ctx, size_t j, double *sums)
{
    struct rc_gap *g = ctx;
    for (size_t k = j * g->problem.px; k < (j + 1) * g->problem.px; k++) {
        double r = g->maps.off[k]
                       ? 0
                       : (double)g->mode.e[X + 2][k] - g->mode.mu * (double)g->mode.e[X + 1][k];
        g->mode.e[Y + 1][k] = (float)r;
        sums[RESIDUAL_SUM] += r;
        sums[RESIDUAL_FREE] += !g->maps.off[k];
    }
}

static void
take_off(const unsigned char *off, size_t n, int threads, float *v, double mean)
{
    if (mean == 0)
        return;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t k = 0; k < n; k++)
        if (!off[k])
            v[k] = (float)((double)v[k] - mean);
}

/* Takes the best x of the space. */
static void
improve(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS], c[SPACE];

    rc_sums_rows(&g->sums, gram_row, g, sums);
    g->mode.error = sqrt(fmax(sums[GRAM_W + 2], 0)); /* y'W y, for x with x'W x = 1 */
    best(sums, c);
    combine(&g->mode, g->problem.n, g->sums.threads, c);
}

enum {
    QUOTIENT_W, /* x'W x */
    QUOTIENT_T  /* x'(A - D) x */
};

static void
quotient_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;
    for (size_t k = j * g->problem.px; k < (j + 1) * g->problem.px; k++) {
        sums[QUOTIENT_W] += (double)g->mode.e[X][k] * (double)g->mode.e[X + 1][k];
        sums[QUOTIENT_T] += (double)g->mode.e[X][k] * (double)g->mode.e[X + 2][k];
    }
}

/* mu of x, x'T x / x'W x. */
static double
quotient(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS];

    rc_sums_rows(&g->sums, quotient_row, g, sums);
    return sums[QUOTIENT_T] / sums[QUOTIENT_W];
}

void
rc_gap_eigen_begin(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS];
    struct first first = {g, g->mode.known || g->mode.tracked, 0, 0};
    const bool again = g->mode.steps > 0;

    g->mode.mu = 1;
    g->mode.error = g->mode.bare = 0;
    g->mode.steps = g->mode.slow = 0;
    /* all nodes of the map are held: nothing softens */
    if (g->residual.free == g->problem.all - g->problem.nx * g->problem.ny)
        return;
    first.noise = first.given ? 0 : 0.05;
    if (again && first.given) {
        rc_sums_rows(&g->sums, size_row, g, sums);
        first.released = sqrt(sums[FIRST_SQUARE] / (double)g->residual.free);
    }
    rc_sums_rows(&g->sums, first_row, &first, sums);
    if (!(sums[FIRST_SQUARE] > 0)) { /* the given vector has no free node */
        first = (struct first){g, .noise = 0.05};
        rc_sums_rows(&g->sums, first_row, &first, sums);
    }
    if (g->set.control == RC_GAP_MEAN)
        take_off(g->maps.off, g->problem.n, g->sums.threads, g->mode.e[X + 1],
                 sums[FIRST_SUM] / sums[FIRST_FREE]);
    apply_k(g, g->mode.e[X + 1], g->mode.e[X]);
    apply_stiffness(g, g->mode.e[X], g->mode.e[X + 2]);
    clear(&g->mode, g->problem.n, Y);
    clear(&g->mode, g->problem.n, D);
    improve(g);
    g->mode.mu = quotient(g);
    g->mode.error = INFINITY;
}

enum {
    TRACK_AZ /* sum of A z */
};

/* z, W z = r, and the sum of A z. */
static void
track_row(void *ctx, size_t j, double *sums)
{
    struct rc_gap *g = ctx;

    for (size_t k = j * g->problem.px; k < (j + 1) * g->problem.px; k++) {
        g->mode.e[Y][k] = g->maps.off[k] ? 0 : (float)g->maps.z[k];
        g->mode.e[Y + 1][k] = g->maps.off[k] ? 0 : (float)g->maps.r[k];
        sums[TRACK_AZ] += (double)g->mode.e[Y + 2][k];
    }
}

void
rc_gap_track(struct rc_gap *g, double mean)
{
    double sums[RC_GAP_SUMS];

    if (!g->mode.tracked) {
        clear(&g->mode, g->problem.n, X);
        clear(&g->mode, g->problem.n, D);
    }
    g->mode.tracked = true;
    rc_sums_rows(&g->sums, track_row, g, sums);
    take_off(g->maps.off, g->problem.n, g->sums.threads, g->mode.e[Y], mean);
    take_off(g->maps.off, g->problem.n, g->sums.threads, g->mode.e[Y + 2],
             g->set.control == RC_GAP_LOAD ? sums[TRACK_AZ] / (double)g->problem.all : 0);
    soften(&g->problem, &g->frozen, &g->maps, g->sums.threads, g->mode.e[Y], g->mode.e[Y + 2]);
    improve(g);
}

void
rc_gap_eigen_step(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS], last = g->mode.mu;

    rc_sums_rows(&g->sums, residual_row, g, sums);
    if (g->set.control == RC_GAP_MEAN)
        take_off(g->maps.off, g->problem.n, g->sums.threads, g->mode.e[Y + 1],
                 sums[RESIDUAL_SUM] / sums[RESIDUAL_FREE]);
    apply_k(g, g->mode.e[Y + 1], g->mode.e[Y]);
    apply_stiffness(g, g->mode.e[Y], g->mode.e[Y + 2]);
    improve(g);
    g->mode.mu = quotient(g);
    g->mode.slow = g->mode.mu > steady * last ? g->mode.slow + 1 : 0;
    g->mode.steps++;
    g->mode.known = true;
}

/* ---- along the mode ---- */

struct push {
    struct rc_gap *g;
    double a;
};

enum {
    SOFT_XR,      /* x'r */
    SOFT_XWX,     /* x'W x */
    SOFT_AX,      /* sum of |A x| on open nodes */
    SOFT_XDX,     /* x'D x */
    SOFT_RELEASED /* nodes */
};

static void
soft_row(void *ctx, size_t j, double *sums)
{
    struct rc_gap *g = ctx;
    size_t m = rc_gap_on_map(&g->problem, j);

    for (size_t i = 0; i < g->problem.px; i += RC_GAP_LINE) {
        size_t n = g->problem.px - i < RC_GAP_LINE ? g->problem.px - i : RC_GAP_LINE,
               at = j * g->problem.px + i;
        double v[RC_GAP_LINE], s[RC_GAP_LINE], d[RC_GAP_LINE];
        if (i < m)
            rc_gap_law(&g->problem, &g->frozen, j, i, m - i < n ? m - i : n, g->maps.x + at, v, s,
                       d);
        for (size_t k = 0; k < n; k++) {
            double x = (double)g->mode.e[X][at + k];
            sums[SOFT_XR] += x * g->maps.r[at + k];
            sums[SOFT_XWX] += x * (double)g->mode.e[X + 1][at + k];
            if (i + k < m && !g->maps.off[at + k]) {
                sums[SOFT_AX] += fabs((double)g->mode.e[X + 2][at + k] + d[k] * x);
                sums[SOFT_XDX] += d[k] * x * x;
                sums[SOFT_RELEASED] += released(g->maps.off, &g->mode, at + k);
            }
        }
    }
}

enum {
    BENT_SLOPE
};

/* The slope of V along the mode after a step, without its linear part: the sum of
 * x (sigma - sigma(0) + a D x). */
static void
bent_row(void *ctx, size_t j, double *sums)
{
    const struct push *c = ctx;
    const struct rc_gap *g = c->g;
    size_t m = rc_gap_on_map(&g->problem, j);

    for (size_t i = 0; i < m; i += RC_GAP_LINE) {
        size_t n = m - i < RC_GAP_LINE ? m - i : RC_GAP_LINE, at = j * g->problem.px + i;
        double to[RC_GAP_LINE], v[RC_GAP_LINE], s[2][RC_GAP_LINE], d[RC_GAP_LINE];
        for (size_t k = 0; k < n; k++)
            to[k] = g->maps.x[at + k] + c->a * (double)g->mode.e[X][at + k];
        rc_gap_law(&g->problem, &g->frozen, j, i, n, to, v, s[1], d);
        rc_gap_law(&g->problem, &g->frozen, j, i, n, g->maps.x + at, v, s[0], d);
        for (size_t k = 0; k < n; k++) {
            double x = (double)g->mode.e[X][at + k];
            sums[BENT_SLOPE] += g->maps.off[at + k] ? 0 : x * (s[1][k] - s[0][k] + c->a * d[k] * x);
        }
    }
}

/* Along the mode the slope of Phi is -b + mu a + T a^2/2 after a step a. Here b = x'r, and T is the sum of
 * the third derivatives of V times x^3. If the slope at twice the linear step, 2 b/mu, is positive, a
 * stationary point is near, at a = 2 b/(mu + sqrt(mu^2 + 2 b T)). Close to a jump the slope has a minimum
 * near 0. The margin is half of b, because b and mu have errors. */
double
rc_gap_soft_error(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS], bent[RC_GAP_SUMS], left;

    rc_sums_rows(&g->sums, soft_row, g, sums);
    if (!(sums[SOFT_XWX] > 0))
        return 0;
    if (g->mode.bare == 0)
        g->mode.bare = g->mode.mu + sums[SOFT_XDX] / sums[SOFT_XWX];
    g->mode.mu = g->mode.bare - sums[SOFT_XDX] / sums[SOFT_XWX];
    g->mode.grown = sums[SOFT_RELEASED] > 0;
    if (sums[SOFT_XR] == 0)
        return 0;
    if (g->mode.mu <= 0)
        return INFINITY;
    rc_sums_rows(&g->sums, bent_row,
                 &(struct push){g, 2 * sums[SOFT_XR] / (sums[SOFT_XWX] * g->mode.mu)}, bent);
    left = fmin(1 + bent[BENT_SLOPE] / sums[SOFT_XR], 1);
    if (left < margin)
        return INFINITY;
    /* the sum of A x vanishes, so that nodes in contact have about as much as open ones */
    return 4 / (1 + sqrt(left)) * fabs(sums[SOFT_XR]) / sums[SOFT_XWX] * sums[SOFT_AX] /
           g->told.size;
}

enum {
    PUSH_RD,                    /* r'd */
    PUSH_LARGEST = RC_GAP_MOST, /* d on the map */
    PUSH_LARGEST_ALL            /* d on the grid */
};

/* d = a times the mode. */
static void
push_row(void *ctx, size_t j, double *sums)
{
    const struct push *c = ctx;
    struct rc_gap *g = c->g;
    size_t m = rc_gap_on_map(&g->problem, j);

    for (size_t i = 0; i < g->problem.px; i++) {
        size_t at = j * g->problem.px + i;
        g->maps.d[at] = g->maps.off[at] ? 0 : c->a * (double)g->mode.e[X][at];
        if (i < m)
            sums[PUSH_LARGEST] = fmax(sums[PUSH_LARGEST], fabs(g->maps.d[at]));
        sums[PUSH_LARGEST_ALL] = fmax(sums[PUSH_LARGEST_ALL], fabs(g->maps.d[at]));
        sums[PUSH_RD] += g->maps.d[at] * g->maps.r[at];
    }
}

void
rc_gap_turn(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS];

    rc_sums_rows(&g->sums, push_row, &(struct push){g, 1}, sums);
    if (sums[PUSH_RD] < 0)
        rc_sums_rows(&g->sums, push_row, &(struct push){g, -1}, sums);
    g->way.unit = sums[PUSH_LARGEST_ALL];
    rc_gap_aim(g, sums[PUSH_RD]);
}

void
rc_gap_leave(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS];

    rc_sums_rows(&g->sums, push_row, &(struct push){g, 1}, sums);
    g->way.unit = sums[PUSH_LARGEST_ALL];
    rc_gap_down(g, 0.1 * g->problem.law.range / sums[PUSH_LARGEST]);
}
