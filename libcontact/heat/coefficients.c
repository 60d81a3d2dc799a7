/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Temperature at a distance (x, y, z) from the middle of a cell dx by dy with a heat flux of 1 (Carslaw and
 * Jaeger 1959, section 10.7, with tau = sqrt(4 kap t)):
 *
 *     C = 1/(k sqrt(pi)) int_S^T X Y exp(-z^2/tau^2) dtau,   T = sqrt(4 kap time), or infinite,
 *     X = [erf((x + dx/2 - px tau^2/2)/tau) - erf((x - dx/2 - px tau^2/2)/tau)]/2,   Y likewise.
 *
 * S is 0, or T for the time since heating ended. X and Y depend on one index each, so all coefficients are
 * one matrix product over the points of a quadrature. Each factor is stored as its even and its odd part, and
 * only at the nodes that it reaches at this tau.
 *
 * For a wave of heat exp(i Q y) along an axis that repeats, Y is the factor of this wave:
 *
 *     Y = exp(-(Q^2 + 2 i Q py) tau^2/4)
 *
 * Its phase makes the quadrature long if the body moves fast along y alone, or nearly so. The coefficients
 * then follow from the symbol, steady 1/(k m) with m^2 = (q + i px)^2 + M^2, M^2 = px^2 + Q^2 + 2 i Q py. The
 * nearest of its singularities is q = -Im M + i (Re M - |px|), and the field decreases as exp(-(Re M - |px|)
 * x). At finite times it does so where px = 0; else the heat of the beginning moves through the map.
 */
#include <stdlib.h>
#include <string.h>

#include "heat.h"
#include "libcontact/body/line.h"
#include "libcontact/body/quadrature.h"
#include "libcontact/memory.h"

enum {
    GAUSS = 8 /* points of a panel */
};
/* erfc(6) = 2e-17. Half makes errors of 1e-5, erfc(3); double changes no bit (17 runs of
 * bench/constants.py). */
static const double reach = 6;
static const double ratio = 1.5; /* of the edges of panels */
/* Of the smaller side of a cell: the first panel. Not sensitive: half and double change temperatures by
 * less than 1e-11 (17 runs of bench/constants.py). */
static const double first_part = 14;
/* Where the integrand is a polynomial of 1/tau. Not sensitive: half and double change only rounding (17
 * runs of bench/constants.py). */
static const double tail_panels = 4;
/* d/(2 tau) below which X follows from its series: half^4 is below rounding. The difference of erf then has
 * an error of 1e-12. */
static const double narrow = 1e-4;

/* The symbol is integrated where Re M - |px| is at least these parts of Q and of |Im M|. Both ways then agree
 * to 2e-10 of the largest temperature, with half of these values to 7e-9 (10,000 random bodies). Twice these
 * values leave no body that moves along y alone to the symbol. */
static const double of_wave = 0.5, of_phase = 0.8;
/* Panels up to which the quadrature is faster than the symbol. Not sensitive: half and double change the time
 * for 512 x 512 nodes by at most 40 ms. */
static const double few_panels = 200;

/* X or Y at the nodes first .. first + n - 1 for one tau. */
struct span {
    size_t first, n, at;
};
struct factor {
    struct span *span; /* of each point                           */
    double *v[2];      /* even and odd part; NULL: the part is 0 */
};
struct rc_heat_cells {
    size_t n; /* points */
    double *tau, *w;
    struct factor x, y; /* 1 along an axis that repeats */
    struct rc_boundary boundary;
    struct rc_heat_waves waves;
    double longest; /* the lowest wave number above 0 along an axis that repeats; 0: none */
    double left;    /* tau after which all material has left the map */
    struct rc_store own;
};

/* ---- waves along an axis that repeats ---- */

/* P along the free axis, and along the other. */
static double
along(const struct rc_heat_cells *c)
{
    return c->boundary.y ? c->waves.body.px : c->waves.body.py;
}

static double
across(const struct rc_heat_cells *c)
{
    return c->boundary.y ? c->waves.body.py : c->waves.body.px;
}

/* True if a wave is steady on the map at sqrt(4 kap t) = T, within rounding: nothing of its first heat
 * remains, or what remains has left. */
static bool
is_steady(const struct rc_heat_cells *c, double wave, double end)
{
    return wave * end / 2 - c->waves.body.depth / end > reach || end > c->left;
}

/* Re M - |p| and Im M, where p is along the free axis. */
static double complex
singularity(const struct rc_heat_cells *c, double wave)
{
    const double p = along(c);

    return csqrt(CMPLX(p * p + wave * wave, 2 * wave * across(c))) - fabs(p);
}

/* True if the coefficients of this wave are sums over tau. */
static bool
by_time(const struct rc_heat_cells *c, double wave)
{
    const struct rc_heated *b = &c->waves.body;
    const double complex s = singularity(c, wave);

    return wave == 0 || fabs(across(c)) * fmin(b->diffusion, 2 * reach / c->longest) < few_panels ||
           creal(s) < of_wave * wave || creal(s) < of_phase * fabs(cimag(s)) ||
           (along(c) != 0 && !is_steady(c, wave, b->ended > 0 ? b->ended : b->diffusion));
}

static bool
any_by_time(const struct rc_heat_cells *c, size_t n)
{
    size_t k = 1;

    while (2 * k <= n && !by_time(c, (double)k * c->longest))
        k++;
    return 2 * k <= n;
}

/* ---- points ---- */

/* Adds the points of a panel; with `over` in the variable s = 1/tau. */
static void
add_panel(struct rc_heat_cells *c, double from, double to, bool over)
{
    for (int g = 0; g < GAUSS; g++) {
        const struct rc_gauss p = rc_gauss_point(GAUSS, g);
        const double t = (from + to) / 2 + (to - from) / 2 * p.x, w = (to - from) / 2 * p.w;
        if (c->tau != NULL) {
            c->tau[c->n] = over ? 1 / t : t;
            c->w[c->n] = over ? w / (t * t) : w;
        }
        c->n++;
    }
}

/* The lowest wave number above 0 of a map with n nodes; 0: there is none. */
static double
lowest_wave(size_t n, double d)
{
    return n > 1 ? 2 * RC_PI / ((double)n * d) : 0;
}

/* The end of a panel. */
static double
panel_end(double from, double p, double first)
{
    const double to = p * from > 0.5 ? fmin(from * ratio, from + 1 / p) : from * ratio;

    return fmax(to, p > 0 ? fmin(first, 0.5 / p) : first);
}

/* Panels get wider by a ratio. An edge of the cell passes a point within 1/P, so they are no wider than that.
 * The last ends where all heated material has left the map; without motion, where the distance of the
 * farthest node is small. Along an axis that repeats, motion narrows them while waves are left. Counts the
 * points where there is no memory for them yet. */
static void
add_panels(struct rc_heat_cells *c, const struct rc_shape *s)
{
    const struct rc_heated *b = &c->waves.body;
    const bool x = !c->boundary.x, y = !c->boundary.y;
    const double p = hypot(x ? b->px : 0, y ? b->py : 0);
    const double side = fmin(x ? s->dx : INFINITY, y ? s->dy : INFINITY);
    const double r =
        hypot(hypot((x ? (double)s->nx : 1) * s->dx, (y ? (double)s->ny : 1) * s->dy), b->depth);
    double end =
        p > 0 ? (reach + 0.5 + sqrt((reach + 0.5) * (reach + 0.5) + 2 * p * r)) / p : 2 * r;
    bool tail = p == 0 && isinf(b->diffusion), turns;
    double from = b->ended;

    c->left = p > 0 ? end : INFINITY;
    turns = c->longest > 0 && any_by_time(c, x ? s->ny : s->nx);
    if (p == 0 && !tail)
        end = b->diffusion;
    end = fmin(end, b->diffusion);
    c->n = 0;
    do {
        const bool waves = turns && c->longest * from < 2 * reach;
        const double to = panel_end(from, waves ? hypot(b->px, b->py) : p, side / first_part);
        add_panel(c, from, fmin(to, fmax(end, from)), false);
        from = to;
    } while (from < end);
    for (int k = 0; tail && k < tail_panels; k++)
        add_panel(c, k / (tail_panels * end), (k + 1) / (tail_panels * end), true);
}

/* ---- factors ---- */

/* X or Y at node i. In the wake of a slow strip d is so small beside tau that the difference of erf is lost;
 * its series is not. */
static double
at_node(const struct rc_heat_cells *c, double i, double d, double p, double tau)
{
    const double moved = p * tau * tau / 2;
    const double middle = (i * d - moved) / tau, half = d / 2 / tau;

    if (half < narrow && rc_repeats(c->boundary) > 0)
        return 2 * half / sqrt(RC_PI) * exp(-middle * middle) *
               (1 + half * half * (2 * middle * middle - 1) / 3);
    return (erf(((i + 0.5) * d - moved) / tau) - erf(((i - 0.5) * d - moved) / tau)) / 2;
}

static struct span
span_of(size_t n, double d, double p, double tau)
{
    const double moved = fabs(p) * tau * tau / 2;
    const double low = fmax(0, ceil((moved - reach * tau) / d - 0.5));
    const double high = fmin((double)n - 1, floor((moved + reach * tau) / d + 0.5));

    return low > high ? (struct span){0} : (struct span){(size_t)low, (size_t)(high - low) + 1, 0};
}

static bool
factor_new(struct factor *f, struct rc_heat_cells *c, bool repeats, size_t nodes, double d,
           double velocity)
{
    const size_t n = repeats ? 1 : nodes;
    const double p = repeats ? 0 : velocity;
    size_t total = 0;

    if ((f->span = rc_store_take(&c->own, c->n, sizeof *f->span)) == NULL)
        return false;
    for (size_t k = 0; k < c->n; k++) {
        f->span[k] = repeats ? (struct span){0, 1, 0} : span_of(n, d, p, c->tau[k]);
        f->span[k].at = total;
        total += f->span[k].n;
    }
    for (int odd = 0; odd <= (p != 0); odd++)
        if ((f->v[odd] = rc_store_take(&c->own, total, sizeof(double))) == NULL)
            return false;
    for (size_t k = 0; k < c->n; k++)
        for (size_t i = 0; i < f->span[k].n; i++) {
            const double node = (double)(f->span[k].first + i);
            const double on = repeats ? 1 : at_node(c, node, d, p, c->tau[k]);
            const double back = p == 0 || node == 0 ? on : at_node(c, -node, d, p, c->tau[k]);
            f->v[0][f->span[k].at + i] = (on + back) / 2;
            if (p != 0)
                f->v[1][f->span[k].at + i] = (on - back) / 2;
        }
    return true;
}

/* ---- the interface ---- */

void
rc_heat_cells_free(struct rc_heat_cells *c)
{
    if (c == NULL)
        return;
    rc_store_free(&c->own);
    free(c);
}

struct rc_heat_cells *
rc_heat_cells_new(const struct rc_shape *s, struct rc_boundary boundary, const struct rc_heated *b,
                  struct rc_err *err)
{
    RC_OWN(rc_heat_cells, c) = calloc(1, sizeof *c);

    if (c == NULL)
        return rc_err_null(err, "out of memory for a plan");
    c->boundary = boundary;
    c->waves = rc_heat_waves_of(b);
    c->longest = boundary.x   ? lowest_wave(s->nx, s->dx)
                 : boundary.y ? lowest_wave(s->ny, s->dy)
                              : 0;
    add_panels(c, s);
    c->w = rc_store_take(&c->own, c->n, sizeof *c->w);
    c->tau = c->w == NULL ? NULL : rc_store_take(&c->own, c->n, sizeof *c->tau);
    if (c->tau != NULL) {
        add_panels(c, s);
        for (size_t k = 0; k < c->n; k++) {
            const double z = b->depth / c->tau[k];
            c->w[k] *= exp(-z * z) / (b->k * sqrt(RC_PI));
            if (b->slope > 0)
                c->w[k] *= b->slope * (b->top - c->tau[k] * c->tau[k]);
        }
        if (factor_new(&c->x, c, boundary.x, s->nx, s->dx, b->px) &&
            factor_new(&c->y, c, boundary.y, s->ny, s->dy, b->py))
            return rc_give(&c);
    }
    return rc_err_null(err, "out of memory for the temperatures of %zu x %zu cells", s->nx, s->ny);
}

static void
add_row(const struct rc_heat_part *of, size_t j, size_t n, double *out)
{
    const struct rc_heat_cells *c = of->cells;
    const double *x = c->x.v[of->parity & RC_ODD_X ? 1 : 0];
    const double *y = c->y.v[of->parity & RC_ODD_Y ? 1 : 0];

    for (size_t i = 0; i < n; i++)
        out[i] = 0;
    for (size_t k = 0; k < c->n && x != NULL && y != NULL; k++) {
        const struct span a = c->x.span[k], b = c->y.span[k];
        double weight;
        if (j - b.first >= b.n) /* unsigned: also where j is below the first */
            continue;
        weight = c->w[k] * y[b.at + j - b.first];
        for (size_t i = 0; i < a.n && a.first + i < n; i++)
            out[a.first + i] += weight * x[a.at + i];
    }
}

static void
rows(const void *of, const struct rc_lattice *at, size_t n, size_t first, size_t last, double *out)
{
    (void)at;
    for (size_t j = first; j < last; j++)
        add_row(of, j, n, out + (j - first) * n);
}

/* A wave, and the axis of the cells. */
struct wave {
    const struct rc_heat_cells *cells;
    double q;
    bool x;
    struct rc_heat_waves of;
};

static void
add_wave(const struct wave *wave, unsigned parity, size_t n, double *out)
{
    const struct rc_heat_cells *c = wave->cells;
    const struct factor *f = wave->x ? &c->x : &c->y;
    const double *v = f->v[parity & (wave->x ? RC_ODD_X : RC_ODD_Y) ? 1 : 0];
    const bool odd = parity & (wave->x ? RC_ODD_Y : RC_ODD_X);

    for (size_t i = 0; i < n; i++)
        out[i] = 0;
    for (size_t k = 0; k < c->n && v != NULL; k++) {
        const struct span a = f->span[k];
        const double u = wave->q * c->tau[k] / 2, phase = across(c) * c->tau[k] * u;
        const double weight = c->w[k] * exp(-u * u) * (odd ? sin(phase) : cos(phase));
        for (size_t i = 0; i < a.n && a.first + i < n && u <= reach; i++)
            out[a.first + i] += weight * v[a.at + i];
    }
}

static void
wave_symbols(const void *of, size_t n, const double *q, double *const out[])
{
    const struct wave *wave = of;

    for (size_t k = 0; k < n; k++) {
        double part[RC_HEAT_PARTS];
        rc_heat_symbol_parts(&wave->of, wave->x ? q[k] : wave->q, wave->x ? wave->q : q[k], part);
        for (unsigned parity = 0; parity < RC_HEAT_PARTS; parity++)
            if (out[parity] != NULL)
                out[parity][k] = part[parity];
    }
}

static enum rc_status
line(const void *of, bool along_x, const struct rc_line_at *at, double *out, struct rc_err *err)
{
    const struct rc_heat_part *part = of;
    struct wave wave = {part->cells, at->wave, along_x, part->cells->waves};
    struct rc_heated *b = &wave.of.body;
    struct rc_line_at decreasing = *at;
    struct rc_line_source source = {RC_HEAT_PARTS, 0, wave_symbols, &wave};
    double *to[RC_LINE_MOST] = {NULL};

    if (by_time(part->cells, at->wave)) {
        add_wave(&wave, part->parity, at->n, out);
        return RC_OK;
    }
    if (b->ended > 0 && is_steady(part->cells, at->wave, b->ended)) {
        memset(out, 0, at->n * sizeof *out);
        return RC_OK;
    }
    if (is_steady(part->cells, at->wave, b->diffusion))
        b->diffusion = INFINITY;
    for (unsigned k = 0; k < RC_HEAT_PARTS; k++)
        source.odd |= k & (along_x ? RC_ODD_X : RC_ODD_Y) ? 1u << k : 0;
    to[part->parity] = out;
    decreasing.wave = fmin(at->wave, creal(singularity(part->cells, at->wave)));
    return rc_line_coefficients(&source, &decreasing, to, err);
}

struct rc_kernel
rc_heat_kernel(const struct rc_heat_part *part)
{
    return (struct rc_kernel){.of = part, .parity = part->parity, .rows = rows, .line = line};
}
