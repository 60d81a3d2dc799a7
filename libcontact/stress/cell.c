/*
 * Stresses inside a half-space under unit load on a cell of its surface, from the closed forms of
 * kernel_stress.c.
 *
 * No single form keeps its digits everywhere. On and next to the cell Love's differences over its
 * four corners hold, down to z = 0; their error is absolute, some 1e-16 of the load, so farther
 * away, where the stress falls as 1/R^2, they lose. There Gauss's rule for the integral of the
 * point loads over the cell is exact to rounding, with fewer points the farther it is. Farthest,
 * on a line of nodes, neighbours share their points: means over cells are taken from the values at
 * the nodes.
 */
#include "stress.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

enum {
    BLOCK = 256,         /* points evaluated together: their arrays stay in the first cache     */
    STRIDE = BLOCK + 24, /* from array to array: else equal places share a line of the cache */
    MOST = 12            /* points of a rule in one direction                                   */
};

/* Distance over the half side of a cell from which a rule of so many points in that direction
 * leaves less than 1e-13 of load times (cell / distance)^2 / 2 pi of any kernel. */
static const struct rule {
    double from;
    int points;
} rules[] = {{3, 12}, {4, 9}, {6, 8}, {8, 7}, {10, 6}, {17, 5}, {38, 4}, {160, 3}};

enum {
    RULES = sizeof rules / sizeof *rules
};

/* Abscissas and weights of Gauss's rules on (-1, 1), the positive half of each (Abramowitz and
 * Stegun 1964, 25.4). */
static const struct gauss {
    double x, w;
} gauss3[] = {{0, 0.888888888888888889}, {0.774596669241483377, 0.555555555555555556}},
  gauss4[] = {{0.339981043584856265, 0.652145154862546143},
              {0.861136311594052575, 0.347854845137453857}},
  gauss5[] = {{0, 0.568888888888888889},
              {0.538469310105683091, 0.478628670499366468},
              {0.906179845938663993, 0.236926885056189088}},
  gauss6[] = {{0.238619186083196909, 0.467913934572691047},
              {0.661209386466264514, 0.360761573048138608},
              {0.932469514203152028, 0.171324492379170345}},
  gauss7[] = {{0, 0.417959183673469388},
              {0.405845151377397167, 0.381830050505118945},
              {0.741531185599394440, 0.279705391489276668},
              {0.949107912342758525, 0.129484966168869693}},
  gauss8[] = {{0.183434642495649805, 0.362683783378361983},
              {0.525532409916328986, 0.313706645877887287},
              {0.796666477413626740, 0.222381034453374471},
              {0.960289856497536232, 0.101228536290376259}},
  gauss9[] = {{0, 0.330239355001259763},
              {0.324253423403808929, 0.312347077040002840},
              {0.613371432700590397, 0.260610696402935462},
              {0.836031107326635794, 0.180648160694857404},
              {0.968160239507626090, 0.081274388361574412}},
  gauss12[] = {
      {0.125233408511468916, 0.249147045813402785}, {0.367831498998180194, 0.233492536538354809},
      {0.587317954286617447, 0.203167426723065922}, {0.769902674194304687, 0.160078328543346226},
      {0.904117256370474857, 0.106939325995318431}, {0.981560634246719251, 0.047175336386511827}};
static const struct gauss *const halves[MOST + 1] = {
    [3] = gauss3, [4] = gauss4, [5] = gauss5, [6] = gauss6,
    [7] = gauss7, [8] = gauss8, [9] = gauss9, [12] = gauss12};

/* Point k of n, from the lowest. */
static struct gauss
gauss_point(int n, int k)
{
    int half = n / 2, from = k - half;
    struct gauss g;

    if (n % 2 == 0)
        g = halves[n][from >= 0 ? from : -from - 1];
    else
        g = halves[n][from >= 0 ? from : -from];
    if (from < 0)
        g.x = -g.x;
    return g;
}

/* The rule of a direction at this distance: -1, the corners. Distances from *low up to *high, which
 * are narrowed, have the same. */
static int
rule_at(double distance, double half_side, double *low, double *high)
{
    int k = -1;

    while (k + 1 < RULES && distance >= rules[k + 1].from * half_side)
        k++;
    if (k >= 0)
        *low = fmax(*low, rules[k].from * half_side);
    if (k + 1 < RULES)
        *high = fmin(*high, rules[k + 1].from * half_side);
    return k;
}

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
by_points(const struct rc_cell *c, unsigned kernels, int nx, int ny, size_t n, const double *x,
          const double *y, double *const out[RC_STRESS_KERNELS], size_t at)
{
    double a = c->dx / 2, b = c->dy / 2;
    _Alignas(64) double u[STRIDE], v[STRIDE], r[STRIDE], w[STRIDE];
    struct rc_points p = {.n = n, .x = u, .y = v, .r = r, .w = w, .z = c->depth, .nu = c->nu};

    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (kernels >> k & 1)
            memset(out[k] + at, 0, n * sizeof(double));
    for (int l = 0; l < ny; l++) {
        struct gauss gy = gauss_point(ny, l);
        shift(n, y, -b * gy.x, v);
        for (int m = 0; m < nx; m++) {
            struct gauss gx = gauss_point(nx, m);
            shift(n, x, -a * gx.x, u);
            distances(n, u, v, p.z, r, w);
            for (int k = 0; k < RC_STRESS_KERNELS; k++)
                if (kernels >> k & 1)
                    rc_stress_forms[k].point(&p, a * b * gx.w * gy.w / (2 * pi), out[k] + at);
        }
    }
}

/* ---- by points, on a line of nodes ---- */

enum {
    REACH = 3 /* nodes on either side that a mean is taken from */
};

/* The mean of a smooth function over a cell from its values f at the nodes: f + d2/24 - 17 d4/5760
 * + 367 d6/967680, with the central differences d2, d4, d6. */
static const double mean_of[REACH + 1] = {
    1 - 2 / 24.0 - 6 * 17 / 5760.0 - 20 * 367 / 967680.0,
    1 / 24.0 + 4 * 17 / 5760.0 + 15 * 367 / 967680.0,
    -17 / 5760.0 - 6 * 367 / 967680.0,
    367 / 967680.0,
};

/* Distance over the cell from which the next term is below 1e-13 of a load's stress. */
static const double far = 80;

RC_WIDE_CLONES static void
take_means(size_t n, const double *restrict f, double *restrict out)
{
    for (size_t i = 0; i < n; i++)
        out[i] = mean_of[0] * f[i + 3] + mean_of[1] * (f[i + 2] + f[i + 4]) +
                 mean_of[2] * (f[i + 1] + f[i + 5]) + mean_of[3] * (f[i] + f[i + 6]);
}

/* Stresses at x = (first + i) dx, i < n: Gauss's rule across the line, and along it the means. */
static void
by_means(const struct rc_cell *c, unsigned kernels, double y, size_t first, size_t n,
         double *const out[RC_STRESS_KERNELS])
{
    double b = c->dy / 2, low = 0, high = INFINITY, x0 = (double)first * c->dx;
    int rule = rule_at(sqrt(x0 * x0 + y * y + c->depth * c->depth), b, &low, &high);
    int ny = rules[rule].points;
    _Alignas(64) double u[STRIDE], v[STRIDE], r[STRIDE], w[STRIDE], sum[RC_STRESS_KERNELS][STRIDE];
    struct rc_points p = {
        .n = n + 2 * REACH, .x = u, .y = v, .r = r, .w = w, .z = c->depth, .nu = c->nu};

    for (size_t i = 0; i < p.n; i++)
        u[i] = ((double)(first + i) - REACH) * c->dx;
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (kernels >> k & 1)
            memset(sum[k], 0, p.n * sizeof(double));
    for (int l = 0; l < ny; l++) {
        struct gauss g = gauss_point(ny, l);
        for (size_t i = 0; i < p.n; i++)
            v[i] = y - b * g.x;
        distances(p.n, u, v, p.z, r, w);
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            if (kernels >> k & 1)
                rc_stress_forms[k].point(&p, c->dx * b * g.w / (2 * pi), sum[k]);
    }
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (kernels >> k & 1)
            take_means(n, sum[k], out[k] + first);
}

/* ---- by corners ---- */

/* A point on an edge but for rounding is on it. */
static double
snap(double x, double side)
{
    return fabs(x) < 1e-9 * side ? 0 : x;
}

static double
by_corners(const struct rc_cell *c, int kernel, double x, double y)
{
    double sum = 0;

    for (int s = -1; s <= 1; s += 2)
        for (int t = -1; t <= 1; t += 2) {
            struct rc_corner k = {.x = snap(x + s * c->dx / 2, c->dx),
                                  .y = snap(y + t * c->dy / 2, c->dy),
                                  .z = c->depth,
                                  .nu = c->nu,
                                  .floor = 1e-3 * fmin(c->dx, c->dy)};
            k.r = sqrt(k.x * k.x + k.y * k.y + k.z * k.z);
            sum += s * t * rc_stress_forms[kernel].corner(&k);
        }
    return sum / (2 * pi);
}

/* ---- both ---- */

void
rc_stress_coefficients(const struct rc_cell *c, unsigned kernels, size_t n, const double *x,
                       const double *y, double *const out[RC_STRESS_KERNELS])
{
    double z2 = c->depth * c->depth;

    for (size_t i = 0, last; i < n; i = last) {
        double r2 = x[i] * x[i] + y[i] * y[i] + z2, low = 0, high = INFINITY;
        int along_x = rule_at(sqrt(r2), c->dx / 2, &low, &high);
        int along_y = rule_at(sqrt(r2), c->dy / 2, &low, &high);

        for (last = i + 1; last < n && last - i < BLOCK; last++) {
            r2 = x[last] * x[last] + y[last] * y[last] + z2;
            if (!(r2 >= low * low && r2 < high * high))
                break;
        }
        if (along_x >= 0 && along_y >= 0) {
            by_points(c, kernels, rules[along_x].points, rules[along_y].points, last - i, x + i,
                      y + i, out, i);
            continue;
        }
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            for (size_t j = i; kernels >> k & 1 && j < last; j++)
                out[k][j] = by_corners(c, k, x[j], y[j]);
    }
}

void
rc_stress_line(const struct rc_cell *c, unsigned kernels, double step, size_t n, double y,
               double *const out[RC_STRESS_KERNELS])
{
    double beyond = far * far * fmax(c->dx * c->dx, c->dy * c->dy) - y * y - c->depth * c->depth;
    double inner = beyond > 0 ? ceil(sqrt(beyond) / c->dx) : 0;
    size_t near = step != c->dx || inner >= (double)n ? n : (size_t)inner;
    size_t most = BLOCK - 2 * REACH;
    double x[BLOCK], ys[BLOCK], *to[RC_STRESS_KERNELS];

    for (size_t start = 0; start < near; start += BLOCK) {
        size_t count = near - start < BLOCK ? near - start : BLOCK;
        for (size_t i = 0; i < count; i++) {
            x[i] = (double)(start + i) * step;
            ys[i] = y;
        }
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            to[k] = kernels >> k & 1 ? out[k] + start : NULL;
        rc_stress_coefficients(c, kernels, count, x, ys, to);
    }
    for (size_t start = near; start < n; start += most)
        by_means(c, kernels, y, start, n - start < most ? n - start : most, out);
}
