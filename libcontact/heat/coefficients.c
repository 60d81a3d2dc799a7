/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Temperature at a distance (x, y, z) from the middle of a cell dx by dy with a heat flux of 1 (Carslaw and
 * Jaeger 1959, section 10.7, with tau = sqrt(4 kap t)):
 *
 *     C = 1/(k sqrt(pi)) int_S^T X Y exp(-z^2/tau^2) dtau,   T = sqrt(4 kap time), or infinite,
 *     X = [erf((x + dx/2 - px tau^2/2)/tau) - erf((x - dx/2 - px tau^2/2)/tau)]/2,   Y likewise.
 *
 * S is 0, or T for the time since heating ended. X and Y depend on one index each, so all coefficients are
 * one matrix product over the points of a quadrature. Y = 1 for strips without end. Each factor is stored
 * as its even and its odd part, and only at the nodes that it reaches at this tau.
 */
#include <stdlib.h>

#include "heat.h"
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
    struct factor x, y;
    struct rc_store own;
};

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

/* The end of a panel. */
static double
panel_end(double from, double p, double first)
{
    const double to = p * from > 0.5 ? fmin(from * ratio, from + 1 / p) : from * ratio;

    return fmax(to, p > 0 ? fmin(first, 0.5 / p) : first);
}

/* Panels get wider by a ratio. An edge of the cell passes a point within 1/P, so they are no wider than that.
 * The last ends where all heated material has left the map; without motion, where the distance of the
 * farthest node is small. Counts the points where there is no memory for them yet. */
static void
add_panels(struct rc_heat_cells *c, const struct rc_shape *s, const struct rc_heated *b)
{
    const double p = hypot(b->px, b->py);
    const double side = s->ny == 1 ? s->dx : s->nx == 1 ? s->dy : fmin(s->dx, s->dy);
    const double r = hypot(hypot((double)s->nx * s->dx, (double)s->ny * s->dy), b->depth);
    double end =
        p > 0 ? (reach + 0.5 + sqrt((reach + 0.5) * (reach + 0.5) + 2 * p * r)) / p : 2 * r;
    bool tail = p == 0 && isinf(b->diffusion);
    double from = b->ended;

    if (p == 0 && !tail)
        end = b->diffusion;
    end = fmin(end, b->diffusion);
    c->n = 0;
    do {
        const double to = panel_end(from, p, side / first_part);
        add_panel(c, from, fmin(to, fmax(end, from)), false);
        from = to;
    } while (from < end);
    for (int k = 0; tail && k < tail_panels; k++)
        add_panel(c, k / (tail_panels * end), (k + 1) / (tail_panels * end), true);
}

/* ---- factors ---- */

/* The mean over the cell of d about node i, times d: X or Y at node i. */
static double
at_node(double i, double d, double p, double tau)
{
    const double moved = p * tau * tau / 2;

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
factor_new(struct factor *f, struct rc_heat_cells *c, size_t n, double d, double p)
{
    size_t total = 0;

    if ((f->span = rc_store_take(&c->own, c->n, sizeof *f->span)) == NULL)
        return false;
    for (size_t k = 0; k < c->n; k++) {
        f->span[k] = n == 1 ? (struct span){0, 1, 0} : span_of(n, d, p, c->tau[k]);
        f->span[k].at = total;
        total += f->span[k].n;
    }
    for (int odd = 0; odd <= (p != 0); odd++)
        if ((f->v[odd] = rc_store_take(&c->own, total, sizeof(double))) == NULL)
            return false;
    for (size_t k = 0; k < c->n; k++)
        for (size_t i = 0; i < f->span[k].n; i++) {
            const double node = (double)(f->span[k].first + i);
            const double on = n == 1 ? 1 : at_node(node, d, p, c->tau[k]);
            const double back = p == 0 || node == 0 ? on : at_node(-node, d, p, c->tau[k]);
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
rc_heat_cells_new(const struct rc_shape *s, const struct rc_heated *b, struct rc_err *err)
{
    RC_OWN(rc_heat_cells, c) = calloc(1, sizeof *c);

    if (c == NULL)
        return rc_err_null(err, "out of memory for a plan");
    add_panels(c, s, b);
    c->w = rc_store_take(&c->own, c->n, sizeof *c->w);
    c->tau = c->w == NULL ? NULL : rc_store_take(&c->own, c->n, sizeof *c->tau);
    if (c->tau != NULL) {
        add_panels(c, s, b);
        for (size_t k = 0; k < c->n; k++) {
            const double z = b->depth / c->tau[k];
            c->w[k] *= exp(-z * z) / (b->k * sqrt(RC_PI));
        }
        if (factor_new(&c->x, c, s->nx, s->dx, s->nx > 1 ? b->px : 0) &&
            factor_new(&c->y, c, s->ny, s->dy, s->ny > 1 ? b->py : 0))
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

struct rc_kernel
rc_heat_kernel(const struct rc_heat_part *part)
{
    return (struct rc_kernel){.of = part, .parity = part->parity, .rows = rows};
}
