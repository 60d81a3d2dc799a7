/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Bonded layers on a half-space. A cell dx x dy under unit pressure displaces the surface of the layered body
 * by the sum of two parts. The first is that of a half-space of the top material, in closed form. The second
 * is the integral over the cell of D(r), the difference between the stack and that half-space. D is smooth on
 * the scale s = twice the thickness of the top layer.
 *
 * Gauss's rule integrates D, with fewer points the larger sqrt(r^2 + s^2) is compared with the sides. A cell
 * too near for any rule is halved. Beyond forty cells means are computed from the values at the nodes, which
 * neighbours share.
 */

#include <math.h>
#include <stdlib.h>

#include "layered.h"
#include "quadrature.h"
#include "uniform.h"

enum {
    BLOCK = 128, /* distances looked up together */
    TILE = 96,   /* columns whose node values are computed together */
    TALL = 40,   /* rows of such a tile */
    NEAREST = 4  /* half sides: a nearer cell is halved */
};
static const double far = 40; /* cells */

/* The integrand, in the units of the grid. */
struct part {
    const struct rc_stack *stack;
    double unit;   /* m^2 per unit of squared length */
    double scale;  /* s in these units               */
    double factor; /* factor of the result */
};

/* Adds up weight * D over n <= BLOCK points. */
static double
sum_points(const struct part *d, size_t n, const double *r2, const double *weight)
{
    double value[BLOCK], sum = 0;

    rc_stack_far(d->stack, n, r2, value);
    for (size_t k = 0; k < n; k++)
        sum += weight[k] * value[k];
    return sum;
}

/* Integral over the rectangle of half sides a, b whose middle is (x, y) away. */
static double
integral(const struct part *d, double x, double y, double a, double b)
{
    double distance = sqrt(x * x + y * y + d->scale * d->scale), low = 0, high = INFINITY, sum = 0;
    double r2[BLOCK], weight[BLOCK];
    size_t n = 0;
    int nx, ny;

    if (distance < NEAREST * fmax(a, b)) {
        bool along_x = a >= b, along_y = b >= a;
        for (int j = along_y ? -1 : 0; j <= 1; j += 2)
            for (int i = along_x ? -1 : 0; i <= 1; i += 2)
                sum += integral(d, x + i * a / 2, y + j * b / 2, along_x ? a / 2 : a,
                                along_y ? b / 2 : b);
        return sum;
    }
    nx = rc_gauss_points(distance, a, &low, &high);
    ny = rc_gauss_points(distance, b, &low, &high);
    for (int l = 0; l < ny; l++)
        for (int m = 0; m < nx; m++) {
            struct rc_gauss u = rc_gauss_point(nx, m), v = rc_gauss_point(ny, l);
            r2[n] = d->unit * (pow(x - a * u.x, 2) + pow(y - b * v.x, 2));
            weight[n++] = u.w * v.w;
            if (n == BLOCK) {
                sum += sum_points(d, n, r2, weight);
                n = 0;
            }
        }
    return (sum + sum_points(d, n, r2, weight)) * a * b;
}

/* ---- far away: means of node values ---- */

struct tile {
    double node[TALL][TILE + 2 * RC_MEAN_REACH]; /* D, from three rows above to three below     */
    double mean[TALL][TILE];                     /* along x                                     */
};

/* Computes D in rows first - 3 .. last + 2 and columns left - 3 .. right + 2. */
static void
fill_tile(const struct part *d, const struct rc_lattice *at, size_t left, size_t right,
          size_t first, size_t last, struct tile *t)
{
    size_t n = right - left + 2 * RC_MEAN_REACH;
    double r2[TILE + 2 * RC_MEAN_REACH];

    for (size_t j = 0; j < last - first + 2 * RC_MEAN_REACH; j++) {
        double y = ((double)(first + j) - RC_MEAN_REACH) * at->dy;
        double *node = t->node[j];
        for (size_t i = 0; i < n; i++) {
            double x = ((double)(left + i) - RC_MEAN_REACH) * at->dx;
            r2[i] = d->unit * (x * x + y * y);
        }
        rc_stack_far(d->stack, n, r2, node);
        for (size_t i = 0; i < right - left; i++) {
            const double *c = node + i + RC_MEAN_REACH;
            t->mean[j][i] = rc_mean_of[0] * c[0] + rc_mean_of[1] * (c[-1] + c[1]) +
                            rc_mean_of[2] * (c[-2] + c[2]) + rc_mean_of[3] * (c[-3] + c[3]);
        }
    }
}

static double
mean_at(const struct tile *t, size_t j, size_t i)
{
    size_t c = j + RC_MEAN_REACH;

    return rc_mean_of[0] * t->mean[c][i] + rc_mean_of[1] * (t->mean[c - 1][i] + t->mean[c + 1][i]) +
           rc_mean_of[2] * (t->mean[c - 2][i] + t->mean[c + 2][i]) +
           rc_mean_of[3] * (t->mean[c - 3][i] + t->mean[c + 3][i]);
}

/* Columns of row j within forty cells, which are integrated. All columns on a lattice that skips nodes. */
static size_t
near_columns(const struct rc_lattice *at, double y, size_t n)
{
    double reach = far * fmax(at->dx, at->dy), rest = reach * reach - y * y;

    if (at->sx > 1 || at->sy > 1)
        return n;
    return rest > 0 && sqrt(rest) / at->dx < (double)n ? (size_t)ceil(sqrt(rest) / at->dx)
           : rest > 0                                  ? n
                                                       : 0;
}

static void
add_block(const struct part *d, const struct rc_lattice *at, size_t n, size_t first, size_t last,
          double *out)
{
    double dx = (double)at->sx * at->dx, dy = (double)at->sy * at->dy;
    size_t least = n;
    struct tile t;

    for (size_t j = first; j < last; j++) {
        double y = (double)j * dy, *row = out + (j - first) * n;
        size_t near = near_columns(at, y, n);
        for (size_t i = 0; i < near; i++)
            row[i] += d->factor * integral(d, (double)i * dx, y, at->dx / 2, at->dy / 2);
        least = near < least ? near : least;
    }
    for (size_t left = least; left < n; left += TILE) {
        size_t right = left + TILE < n ? left + TILE : n;
        fill_tile(d, at, left, right, first, last, &t);
        for (size_t j = first; j < last; j++) {
            double *row = out + (j - first) * n;
            size_t near = near_columns(at, (double)j * dy, n);
            for (size_t i = left > near ? left : near; i < right; i++)
                row[i] += d->factor * at->dx * at->dy * mean_at(&t, j - first, i - left);
        }
    }
}

/* ---- the row ---- */

struct layered {
    struct rc_solid solid;
    struct rc_stack *stack;
};

const struct rc_stack *
rc_layered_stack(const struct rc_solid *s)
{
    return ((const struct layered *)s)->stack;
}

static bool
takes(const struct rc_body *b)
{
    return b->layers > 0;
}

static enum rc_status
check(const struct rc_body *b, enum rc_use use, struct rc_err *err)
{
    (void)use;
    return rc_stack_check(b, err);
}

static void
solid_free(struct rc_solid *s)
{
    rc_stack_free(((struct layered *)s)->stack);
    free(s);
}

static struct rc_solid *
solid_new(const struct rc_body *b, struct rc_err *err)
{
    struct layered *l = malloc(sizeof *l);

    if (l == NULL)
        return rc_err_null(err, "out of memory for a body");
    *l = (struct layered){{&rc_body_layered}, rc_stack_new(b, err)};
    if (l->stack == NULL) {
        free(l);
        return NULL;
    }
    return &l->solid;
}

static double
modulus(const struct rc_solid *s, double q)
{
    return 1 / rc_stack_response(rc_layered_stack(s), q);
}

static double
modulus_of(const struct rc_solid *s, double q2)
{
    double g;

    rc_stack_responses(rc_layered_stack(s), 1, &q2, &g);
    return 1 / g;
}

/* The response is smooth in ln q. */
static double
softest(const struct rc_solid *solid)
{
    const struct rc_stack *s = rc_layered_stack(solid);
    double most = rc_stack_response(s, 0);

    for (size_t k = 0; k < s->layers; k++)
        for (int j = -20; j <= 20; j++)
            most = fmax(most, rc_stack_response(s, exp(0.5 * j) / s->material[k].thickness));
    return 1 / most;
}

static double
plane_strain(double e, double nu)
{
    return e / (1 - nu * nu);
}

/* The softest material below layer k. */
static double
softest_below(const struct rc_body *b, size_t k)
{
    double soft = plane_strain(b->e, b->nu);

    while (++k < b->layers)
        soft = fmin(soft, plane_strain(b->layer[k].e, b->layer[k].nu));
    return soft;
}

/* Bonded layers from the top down act as a plate of stiffness D about its neutral plane. On a half-space a
 * plate bends over (2 D / E')^(1/3), E' = E/(1 - nu^2). */
static double
bends(const struct rc_body *b, double side)
{
    double depth = 0, sums[3] = {0}, most = 0; /* sums of E' z^n dz */

    for (size_t k = 0; k < b->layers; k++) {
        double below = depth + b->layer[k].thickness, length;
        double e = plane_strain(b->layer[k].e, b->layer[k].nu);
        sums[0] += e * (below - depth);
        sums[1] += e * (below * below - depth * depth) / 2;
        sums[2] += e * (below * below * below - depth * depth * depth) / 3;
        depth = below;
        length = cbrt(2 * (sums[2] - sums[1] * sums[1] / sums[0]) / softest_below(b, k));
        if (length > depth && 2 * RC_PI * depth < side)
            most = fmax(most, length);
    }
    return most;
}

static void
add_rows(const struct rc_solid *solid, double length, double modulus, const struct rc_lattice *at,
         size_t n, size_t first, size_t last, double *out)
{
    const struct rc_stack *s = rc_layered_stack(solid);
    const struct part d = {.stack = s,
                           .unit = length * length,
                           .scale = 2 * s->material[0].thickness / length,
                           .factor = modulus * length};
    size_t most = TALL - 2 * RC_MEAN_REACH;

    rc_uniform_add_rows(1 / (s->top * modulus), at, n, first, last, out);
    for (; first < last; first += most, out += most * n)
        add_block(&d, at, n, first, last - first < most ? last : first + most, out);
}

const struct rc_body_type rc_body_layered = {
    .name = "layered",
    .summary = "bonded layers on a half-space",
    .takes = takes,
    .check = check,
    .new = solid_new,
    .free = solid_free,
    .modulus = modulus,
    .modulus_of = modulus_of,
    .softest = softest,
    .bends = bends,
    .add_rows = add_rows,
    .inside = &rc_layered_inside,
};
