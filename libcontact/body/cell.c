/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Stresses inside a half-space under unit load on a cell of its surface, from the closed forms of
 * forms.c.
 *
 * No single form is accurate everywhere. On and next to the cell, Love's differences over its four corners
 * apply, down to z = 0. Their error is absolute, some 1e-16 of the load, so they lose relative accuracy
 * farther away, where the stress decreases as 1/R^2. There Gauss's rule for the integral of point loads over
 * the cell is exact to rounding, with fewer points at larger distances. At the largest distances, on a line
 * of nodes, neighbours share their points: means over cells are computed from the values at the nodes.
 */
#include "forms.h"

#include <math.h>
#include <string.h>

#include "quadrature.h"

enum {
    BLOCK = 256, /* points evaluated together: their arrays fit into the first cache */
    /* distance from array to array, so that equal places do not share a cache line */
    STRIDE = BLOCK + 24
};

/* ---- by points ---- */

RC_WIDE_CLONES static void
distances(size_t n, const double *restrict x, const double *restrict y, double z,
          double *restrict r, double *restrict w)
{
    for (size_t i = 0; i < n; i++) {
        double R = sqrt(x[i] * x[i] + y[i] * y[i] + z * z);
        r[i] = 1 / R;
        w[i] = 1 / (R + z);
    }
}

RC_WIDE_CLONES static void
shift(size_t n, const double *restrict from, double by, double *restrict to)
{
    for (size_t i = 0; i < n; i++)
        to[i] = from[i] + by;
}

static void
add_points(int kernel, const struct rc_points *p, double weight, double *out)
{
    const struct rc_points turned = {p->n, p->y, p->x, p->r, p->w, p->z, p->nu};

    rc_stress_forms[rc_stress_unturned(kernel)].point(rc_stress_turned(kernel) ? &turned : p,
                                                      weight, out);
}

static void
by_points(const struct rc_closed *at, const struct rc_cell *c, unsigned kernels, int nx, int ny,
          size_t n, const double *x, const double *y, double *const out[RC_STRESS_KERNELS],
          size_t from)
{
    double a = c->dx / 2, b = c->dy / 2;
    _Alignas(64) double u[STRIDE], v[STRIDE], r[STRIDE], w[STRIDE];
    struct rc_points p = {.n = n, .x = u, .y = v, .r = r, .w = w, .z = at->depth, .nu = at->nu};

    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (kernels >> k & 1)
            memset(out[k] + from, 0, n * sizeof(double));
    for (int l = 0; l < ny; l++) {
        struct rc_gauss gy = rc_gauss_point(ny, l);
        shift(n, y, -b * gy.x, v);
        for (int m = 0; m < nx; m++) {
            struct rc_gauss gx = rc_gauss_point(nx, m);
            shift(n, x, -a * gx.x, u);
            distances(n, u, v, p.z, r, w);
            for (int k = 0; k < RC_STRESS_KERNELS; k++)
                if (kernels >> k & 1)
                    add_points(k, &p, a * b * gx.w * gy.w / (2 * RC_PI), out[k] + from);
        }
    }
}

/* ---- by points, on a line of nodes ---- */

/* Distance over the cell beyond which the next term is below 1e-13 of a load's stress. */
static const double far = 80;

RC_WIDE_CLONES static void
take_means(size_t n, const double *restrict f, double *restrict out)
{
    for (size_t i = 0; i < n; i++)
        out[i] = rc_mean_of[0] * f[i + 3] + rc_mean_of[1] * (f[i + 2] + f[i + 4]) +
                 rc_mean_of[2] * (f[i + 1] + f[i + 5]) + rc_mean_of[3] * (f[i] + f[i + 6]);
}

/* Computes stresses at x = (first + i) dx, i < n: Gauss's rule across the line, and along it the means. */
static void
by_means(const struct rc_closed *at, const struct rc_cell *c, unsigned kernels, double y,
         size_t first, size_t n, double *const out[RC_STRESS_KERNELS])
{
    double b = c->dy / 2, low = 0, high = INFINITY, x0 = (double)first * c->dx;
    int ny = rc_gauss_points(sqrt(x0 * x0 + y * y + at->depth * at->depth), b, &low, &high);
    _Alignas(64) double u[STRIDE], v[STRIDE], r[STRIDE], w[STRIDE], sum[RC_STRESS_KERNELS][STRIDE];
    struct rc_points p = {
        .n = n + 2 * RC_MEAN_REACH, .x = u, .y = v, .r = r, .w = w, .z = at->depth, .nu = at->nu};

    for (size_t i = 0; i < p.n; i++)
        u[i] = ((double)(first + i) - RC_MEAN_REACH) * c->dx;
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (kernels >> k & 1)
            memset(sum[k], 0, p.n * sizeof(double));
    for (int l = 0; l < ny; l++) {
        struct rc_gauss g = rc_gauss_point(ny, l);
        for (size_t i = 0; i < p.n; i++)
            v[i] = y - b * g.x;
        distances(p.n, u, v, p.z, r, w);
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            if (kernels >> k & 1)
                add_points(k, &p, c->dx * b * g.w / (2 * RC_PI), sum[k]);
    }
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (kernels >> k & 1)
            take_means(n, sum[k], out[k] + first);
}

/* ---- by corners ---- */

/* A point within rounding of an edge is put on it. */
static double
snap(double x, double side)
{
    return fabs(x) < 1e-9 * side ? 0 : x;
}

static double
by_corners(const struct rc_closed *at, const struct rc_cell *c, int kernel, double x, double y)
{
    bool turned = rc_stress_turned(kernel);
    double sum = 0;

    for (int s = -1; s <= 1; s += 2)
        for (int t = -1; t <= 1; t += 2) {
            double a = snap(x + s * c->dx / 2, c->dx), b = snap(y + t * c->dy / 2, c->dy);
            struct rc_corner k = {.x = turned ? b : a,
                                  .y = turned ? a : b,
                                  .z = at->depth,
                                  .nu = at->nu,
                                  .floor = 1e-3 * fmin(c->dx, c->dy)};
            k.r = sqrt(k.x * k.x + k.y * k.y + k.z * k.z);
            sum += s * t * rc_stress_forms[rc_stress_unturned(kernel)].corner(&k);
        }
    return sum / (2 * RC_PI);
}

/* ---- choice of the accurate form ---- */

void
rc_closed_coefficients(const struct rc_closed *at, const struct rc_cell *c, unsigned kernels,
                       size_t n, const double *x, const double *y,
                       double *const out[RC_STRESS_KERNELS])
{
    double z2 = at->depth * at->depth;

    for (size_t i = 0, last; i < n; i = last) {
        double r2 = x[i] * x[i] + y[i] * y[i] + z2, low = 0, high = INFINITY;
        int along_x = rc_gauss_points(sqrt(r2), c->dx / 2, &low, &high);
        int along_y = rc_gauss_points(sqrt(r2), c->dy / 2, &low, &high);

        for (last = i + 1; last < n && last - i < BLOCK; last++) {
            r2 = x[last] * x[last] + y[last] * y[last] + z2;
            if (!(r2 >= low * low && r2 < high * high))
                break;
        }
        if (along_x > 0 && along_y > 0) {
            by_points(at, c, kernels, along_x, along_y, last - i, x + i, y + i, out, i);
            continue;
        }
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            for (size_t j = i; kernels >> k & 1 && j < last; j++)
                out[k][j] = by_corners(at, c, k, x[j], y[j]);
    }
}

void
rc_closed_line(const struct rc_closed *at, const struct rc_cell *c, unsigned kernels, double step,
               size_t n, double y, double *const out[RC_STRESS_KERNELS])
{
    double beyond = far * far * fmax(c->dx * c->dx, c->dy * c->dy) - y * y - at->depth * at->depth;
    double inner = beyond > 0 ? ceil(sqrt(beyond) / c->dx) : 0;
    size_t near = step != c->dx || inner >= (double)n ? n : (size_t)inner;
    size_t most = BLOCK - 2 * RC_MEAN_REACH;
    double x[BLOCK], ys[BLOCK], *to[RC_STRESS_KERNELS];

    for (size_t start = 0; start < near; start += BLOCK) {
        size_t count = near - start < BLOCK ? near - start : BLOCK;
        for (size_t i = 0; i < count; i++) {
            x[i] = (double)(start + i) * step;
            ys[i] = y;
        }
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            to[k] = kernels >> k & 1 ? out[k] + start : NULL;
        rc_closed_coefficients(at, c, kernels, count, x, ys, to);
    }
    for (size_t start = near; start < n; start += most)
        by_means(at, c, kernels, y, start, n - start < most ? n - start : most, out);
}
