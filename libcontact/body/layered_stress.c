/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Stresses at one depth of a layered body. Under a wave they come from the stack itself. Under a unit load on
 * a cell they are integrals over the cell of functions of the distance,
 *
 *     H_m[G](r) = 1/2 pi integral of G J_m(q r) q dq,     x = r cos(phi), y = r sin(phi):
 *
 *     pressure  szz  H_0[S]         sxz  cos(phi) H_1[T]         syz  sin(phi) H_1[T]
 *               sxx, syy  H_0[(L + N)/2] -+ cos(2 phi) H_2[(L - N)/2]
 *               sxy  -sin(2 phi) H_2[(L - N)/2]
 *     along x   szz  -cos(phi) H_1[S]                 e = (L - N - 2 V)/4
 *               sxz  H_0[(T - R)/2] - cos(2 phi) H_2[(T + R)/2]
 *               syz  -sin(2 phi) H_2[(T + R)/2]
 *               sxx  -cos(phi) H_1[(3 L + N + 2 V)/4] + cos(3 phi) H_3[e]
 *               syy  -cos(phi) H_1[(L + 3 N - 2 V)/4] - cos(3 phi) H_3[e]
 *               sxy  -sin(phi) H_1[(L - N + 2 V)/4] + sin(3 phi) H_3[e]
 *
 * In the top layer G is the difference between the stack and a half-space of the layer's material, whose
 * closed forms are added elsewhere. It decreases as exp(-q s), s = 2 t - z, t the thickness. Below the top
 * layer G is the complete stress, and decreases as exp(-q z), s = z. The functions are smooth on the scale s,
 * which replaces the depth in the rules of integration. A cell too near for any rule is halved.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "forms.h"
#include "layered.h"
#include "quadrature.h"
#include "radial.h"

enum {
    BLOCK = 64,       /* points looked up together           */
    NEAREST = 4,      /* half sides: a nearer cell is halved */
    PRESSURE = 4,     /* functions of the pressure           */
    FUNCTIONS = 4 + 7 /* functions of both loads             */
};
/* In cells: beyond this means on a line of nodes, whose next term is below 1e-13 of a load's stress, as
 * in cell.c. */
static const double far = 80;

struct inside {
    struct rc_inside in;
    const struct rc_stack *stack;
    size_t medium;
    double depth;             /* depth in the top layer; at most its thickness */
    bool shear;               /* also for the tangential load             */
    double scale;             /* s, m                                     */
    struct rc_radial *radial; /* tables of the functions above; NULL: waves only */
};

_Static_assert((int)RC_UNDER_BOTH <= (int)RC_WAVE_NUMBERS,
               "of a wave more is known than there is room for");

/* ---- a wave ---- */

static size_t
numbers(bool shear)
{
    return shear ? RC_UNDER_BOTH : RC_UNDER_PRESSURE;
}

static void
waves(const struct rc_inside *inside, size_t n, const double *q, double *out)
{
    const struct inside *in = (const struct inside *)inside;
    size_t m = numbers(in->shear);

    for (size_t k = 0; k < n; k++)
        rc_stack_inside(in->stack, in->medium, in->depth, q[k], m, out + k * m);
}

/* The stress of the wave with the direction (x, y), over (-i)^(number of odd directions). */
static double
wave_stress(int kernel, double x, double y, const double *f)
{
    double x2 = x * x, y2 = y * y;

    switch (kernel) {
    case RC_SXX:
        return x2 * f[RC_P_L] + y2 * f[RC_P_N];
    case RC_SYY:
        return y2 * f[RC_P_L] + x2 * f[RC_P_N];
    case RC_SZZ:
        return f[RC_P_S];
    case RC_SXY:
        return -x * y * (f[RC_P_L] - f[RC_P_N]);
    case RC_SXZ:
        return x * f[RC_P_T];
    case RC_SYZ:
        return y * f[RC_P_T];
    case RC_COMPONENTS + RC_SXX:
        return -x * (x2 * f[RC_T_L] + y2 * (f[RC_T_N] + 2 * f[RC_T_V]));
    case RC_COMPONENTS + RC_SYY:
        return -x * (y2 * (f[RC_T_L] - 2 * f[RC_T_V]) + x2 * f[RC_T_N]);
    case RC_COMPONENTS + RC_SZZ:
        return -x * f[RC_T_S];
    case RC_COMPONENTS + RC_SXY:
        return -y * (x2 * (f[RC_T_L] - f[RC_T_N]) - (x2 - y2) * f[RC_T_V]);
    case RC_COMPONENTS + RC_SXZ:
        return x2 * f[RC_T_T] - y2 * f[RC_T_R];
    default:
        return -x * y * (f[RC_T_T] + f[RC_T_R]);
    }
}

static void
symbol(const struct rc_inside *in, int kernel, const struct rc_waves *w, double *out)
{
    size_t step = numbers(((const struct inside *)in)->shear);

    for (size_t k = 0; k < w->n; k++)
        out[k] = wave_stress(kernel, w->x[k], w->y[k], w->numbers + k * step);
}

/* Under a uniform load on a patch that grows without limit the strains along the surface are those of the
 * substrate. On a profile those along y are 0. */
static double
mean(const struct rc_inside *inside, int kernel, const struct rc_shape *shape)
{
    const struct inside *in = (const struct inside *)inside;
    const struct rc_material *m = &in->stack->material[in->medium];
    const struct rc_material *s = &in->stack->material[in->stack->layers];
    /* E (1 + nu_s)(1 - 2 nu_s)/E_s */
    double nu = m->nu, pulled = m->modulus * (1 + nu) * (1 - 2 * s->nu) / s->modulus;
    bool profile = (shape->nx == 1) != (shape->ny == 1);
    int along = shape->nx == 1 ? RC_SYY : RC_SXX, across = along == RC_SXX ? RC_SYY : RC_SXX;
    double both = -(nu / (1 - nu) + pulled / (2 * (1 - nu)));
    double line = -(nu / (1 - nu) + pulled / (1 - nu * nu));

    if (kernel == RC_SZZ || kernel == RC_COMPONENTS + RC_SXZ)
        return -1;
    if (kernel == along)
        return profile ? line : both;
    if (kernel == across)
        return profile ? nu * (line - 1) : both;
    return 0;
}

/* ---- a point ---- */

/* The same numbers for a half-space of one material. */
static void
half_space(double nu, double x, double *f)
{
    double e = exp(-x);

    f[RC_P_S] = -(1 + x) * e;
    f[RC_P_T] = -x * e;
    f[RC_P_L] = -(1 - x) * e;
    f[RC_P_N] = -2 * nu * e;
    f[RC_T_S] = x * e;
    f[RC_T_T] = -(1 - x) * e;
    f[RC_T_L] = (2 - x) * e;
    f[RC_T_N] = 2 * nu * e;
    f[RC_T_R] = f[RC_T_V] = e;
}

static const int order[FUNCTIONS] = {0, 1, 0, 2, 1, 0, 2, 1, 1, 1, 3};

/* G of each function, over 2 pi. */
static void
functions(const void *ctx, double q, double *g)
{
    const struct inside *in = ctx;
    double f[RC_UNDER_BOTH], bare[RC_UNDER_BOTH];
    size_t n = numbers(in->shear), m = in->shear ? FUNCTIONS : PRESSURE;

    waves(&in->in, 1, &q, f);
    if (in->medium == 0) {
        half_space(in->stack->material[0].nu, q * in->depth, bare);
        for (size_t k = 0; k < n; k++)
            f[k] -= bare[k];
    }
    g[0] = f[RC_P_S];
    g[1] = f[RC_P_T];
    g[2] = (f[RC_P_L] + f[RC_P_N]) / 2;
    g[3] = (f[RC_P_L] - f[RC_P_N]) / 2;
    if (in->shear) {
        g[4] = f[RC_T_S];
        g[5] = (f[RC_T_T] - f[RC_T_R]) / 2;
        g[6] = (f[RC_T_T] + f[RC_T_R]) / 2;
        g[7] = (3 * f[RC_T_L] + f[RC_T_N] + 2 * f[RC_T_V]) / 4;
        g[8] = (f[RC_T_L] + 3 * f[RC_T_N] - 2 * f[RC_T_V]) / 4;
        g[9] = (f[RC_T_L] - f[RC_T_N] + 2 * f[RC_T_V]) / 4;
        g[10] = (f[RC_T_L] - f[RC_T_N] - 2 * f[RC_T_V]) / 4;
    }
    for (size_t k = 0; k < m; k++)
        g[k] /= 2 * RC_PI;
}

/* Direction of a point from the load, and the functions there. */
struct place {
    double c, s, c2, s2, c3, s3; /* cosines and sines of phi, 2 phi, 3 phi */
    const double *h;
};

static struct place
place_of(double x, double y, double r, const double *h)
{
    double c = r > 0 ? x / r : 1, s = r > 0 ? y / r : 0, c2 = c * c - s * s, s2 = 2 * c * s;

    return (struct place){c, s, c2, s2, c * c2 - s * s2, s * c2 + c * s2, h};
}

/* Adds the stresses under the traction along x. */
static void
add_shear(const struct place *p, double weight, const enum rc_component to[RC_COMPONENTS],
          double *sum)
{
    const double *h = p->h;

    sum[to[RC_SXX]] += weight * (p->c3 * h[10] - p->c * h[7]);
    sum[to[RC_SYY]] -= weight * (p->c3 * h[10] + p->c * h[8]);
    sum[to[RC_SZZ]] -= weight * p->c * h[4];
    sum[to[RC_SXY]] += weight * (p->s3 * h[10] - p->s * h[9]);
    sum[to[RC_SXZ]] += weight * (h[5] - p->c2 * h[6]);
    sum[to[RC_SYZ]] -= weight * p->s2 * h[6];
}

/* Adds weight times the stresses of all kernels of the loads; with `turned` those of the traction along y. */
static void
add_stresses(const struct inside *in, const struct place *p, double weight, bool turned,
             double *sum)
{
    static const enum rc_component same[] = {RC_SXX, RC_SYY, RC_SZZ, RC_SXY, RC_SXZ, RC_SYZ};
    /* x and y exchanged: pi/2 - phi */
    const struct place other = {p->s, p->c, -p->c2, p->s2, -p->s3, -p->c3, p->h};
    const double *h = p->h;

    sum[RC_SXX] += weight * (h[2] - p->c2 * h[3]);
    sum[RC_SYY] += weight * (h[2] + p->c2 * h[3]);
    sum[RC_SZZ] += weight * h[0];
    sum[RC_SXY] -= weight * p->s2 * h[3];
    sum[RC_SXZ] += weight * p->c * h[1];
    sum[RC_SYZ] += weight * p->s * h[1];
    if (!in->shear)
        return;
    add_shear(p, weight, same, sum + RC_COMPONENTS);
    if (turned)
        add_shear(&other, weight, rc_stress_exchanged, sum + (size_t)RC_TURNED * RC_COMPONENTS);
}

/* ---- a cell ---- */

/* Points of one rule, looked up together. */
struct block {
    bool turned; /* the traction along y is needed too */
    size_t n;
    double x[BLOCK], y[BLOCK], r[BLOCK], weight[BLOCK];
};

static void
flush(const struct inside *in, struct block *b, double *sum)
{
    double h[BLOCK * FUNCTIONS];
    size_t m = in->shear ? FUNCTIONS : PRESSURE;

    rc_radial_values(in->radial, b->n, b->r, h);
    for (size_t k = 0; k < b->n; k++) {
        struct place p = place_of(b->x[k], b->y[k], b->r[k], h + k * m);
        add_stresses(in, &p, b->weight[k], b->turned, sum);
    }
    b->n = 0;
}

/* Adds to sum[] the integrals over the rectangle of half sides a, b with its middle at (x, y). */
static void
integrate(const struct inside *in, double x, double y, double a, double b, struct block *block,
          double *sum)
{
    double distance = sqrt(x * x + y * y + in->scale * in->scale), low = 0, high = INFINITY;
    int nx, ny;

    if (distance < NEAREST * fmax(a, b)) {
        bool along_x = a >= b, along_y = b >= a;
        for (int j = along_y ? -1 : 0; j <= 1; j += 2)
            for (int i = along_x ? -1 : 0; i <= 1; i += 2)
                integrate(in, x + i * a / 2, y + j * b / 2, along_x ? a / 2 : a,
                          along_y ? b / 2 : b, block, sum);
        return;
    }
    nx = rc_gauss_points(distance, a, &low, &high);
    ny = rc_gauss_points(distance, b, &low, &high);
    for (int l = 0; l < ny; l++)
        for (int m = 0; m < nx; m++) {
            struct rc_gauss u = rc_gauss_point(nx, m), v = rc_gauss_point(ny, l);
            size_t k = block->n++;
            block->x[k] = x - a * u.x;
            block->y[k] = y - b * v.x;
            block->r[k] = sqrt(block->x[k] * block->x[k] + block->y[k] * block->y[k]);
            block->weight[k] = a * b * u.w * v.w;
            if (block->n == BLOCK)
                flush(in, block, sum);
        }
}

static void
add_coefficients(const struct inside *in, const struct rc_cell *c, unsigned kernels, size_t n,
                 const double *x, const double *y, double *const out[RC_STRESS_KERNELS])
{
    for (size_t i = 0; i < n; i++) {
        double sum[RC_STRESS_KERNELS] = {0};
        struct block block;
        block.turned = kernels >> RC_TURNED * RC_COMPONENTS != 0;
        block.n = 0;
        integrate(in, x[i], y[i], c->dx / 2, c->dy / 2, &block, sum);
        flush(in, &block, sum);
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            if (kernels >> k & 1)
                out[k][i] += sum[k];
    }
}

/* ---- a cell, on a line of nodes ---- */

enum {
    LINE = 96 /* nodes together */
};

/* Values at the nodes of a line, integrated across it by Gauss's rule. */
struct line {
    double value[LINE + 2 * RC_MEAN_REACH][RC_STRESS_KERNELS];
};

static void
fill_line(const struct inside *in, const struct rc_cell *c, bool turned, double y, size_t first,
          size_t n, struct line *line)
{
    double b = c->dy / 2, low = 0, high = INFINITY, x0 = (double)first * c->dx;
    int ny = rc_gauss_points(sqrt(x0 * x0 + y * y + in->scale * in->scale), b, &low, &high);
    size_t m = in->shear ? FUNCTIONS : PRESSURE;
    double r[LINE + 2 * RC_MEAN_REACH], h[(LINE + 2 * RC_MEAN_REACH) * FUNCTIONS];

    memset(line->value, 0, n * sizeof *line->value);
    for (int l = 0; l < ny; l++) {
        struct rc_gauss g = rc_gauss_point(ny, l);
        double v = y - b * g.x;
        for (size_t i = 0; i < n; i++) {
            double u = ((double)(first + i) - RC_MEAN_REACH) * c->dx;
            r[i] = sqrt(u * u + v * v);
        }
        rc_radial_values(in->radial, n, r, h);
        for (size_t i = 0; i < n; i++) {
            double u = ((double)(first + i) - RC_MEAN_REACH) * c->dx;
            struct place p = place_of(u, v, r[i], h + i * m);
            add_stresses(in, &p, c->dx * b * g.w, turned, line->value[i]);
        }
    }
}

static void
add_means(const struct inside *in, const struct rc_cell *c, unsigned kernels, double y,
          size_t first, size_t n, double *const out[RC_STRESS_KERNELS])
{
    struct line line;

    fill_line(in, c, kernels >> RC_TURNED * RC_COMPONENTS != 0, y, first, n + 2 * RC_MEAN_REACH,
              &line);
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        for (size_t i = 0; kernels >> k & 1 && i < n; i++) {
            double(*v)[RC_STRESS_KERNELS] = line.value + i + RC_MEAN_REACH, sum = 0;
            for (int j = 1; j <= RC_MEAN_REACH; j++)
                sum += rc_mean_of[j] * (v[-j][k] + v[j][k]);
            out[k][first + i] += rc_mean_of[0] * v[0][k] + sum;
        }
}

static void
add_line(const struct inside *in, const struct rc_cell *c, unsigned kernels, double step, size_t n,
         double y, double *const out[RC_STRESS_KERNELS])
{
    double s = in->scale;
    double beyond = far * far * fmax(c->dx * c->dx, c->dy * c->dy) - y * y - s * s;
    double inner = beyond > 0 ? ceil(sqrt(beyond) / c->dx) : 0;
    size_t near = step != c->dx || inner >= (double)n ? n : (size_t)inner;

    for (size_t i = 0; i < near; i++) {
        double x = (double)i * step, *to[RC_STRESS_KERNELS] = {NULL};
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            to[k] = kernels >> k & 1 ? out[k] + i : NULL;
        add_coefficients(in, c, kernels, 1, &x, &y, to);
    }
    for (size_t start = near; start < n; start += LINE)
        add_means(in, c, kernels, y, start, n - start < LINE ? n - start : LINE, out);
}

/* ---- made ---- */

/* The part in closed form: in the top layer the stress of a half-space of its material; deeper all values are
 * 0. */
static bool
closed(const struct inside *in, unsigned kernels, size_t n, struct rc_closed *at,
       double *const out[RC_STRESS_KERNELS])
{
    *at = (struct rc_closed){in->in.depth, in->stack->material[in->medium].nu};
    for (int k = 0; k < RC_STRESS_KERNELS && in->medium > 0; k++)
        if (kernels >> k & 1)
            memset(out[k], 0, n * sizeof(double));
    return in->medium == 0;
}

static void
coefficients(const struct rc_inside *inside, const struct rc_cell *c, unsigned kernels, size_t n,
             const double *x, const double *y, double *const out[RC_STRESS_KERNELS])
{
    const struct inside *in = (const struct inside *)inside;
    struct rc_closed at;

    if (closed(in, kernels, n, &at, out))
        rc_closed_coefficients(&at, c, kernels, n, x, y, out);
    add_coefficients(in, c, kernels, n, x, y, out);
}

static void
line(const struct rc_inside *inside, const struct rc_cell *c, unsigned kernels, double step,
     size_t n, double y, double *const out[RC_STRESS_KERNELS])
{
    const struct inside *in = (const struct inside *)inside;
    struct rc_closed at;

    if (closed(in, kernels, n, &at, out))
        rc_closed_line(&at, c, kernels, step, n, y, out);
    add_line(in, c, kernels, step, n, y, out);
}

static void
inside_free(struct rc_inside *inside)
{
    rc_radial_free(((struct inside *)inside)->radial);
    free(inside);
}

static struct rc_inside *
inside_new(const struct rc_solid *solid, double depth, bool shear, struct rc_boundary boundary,
           struct rc_err *err)
{
    const struct rc_stack *s = rc_layered_stack(solid);
    size_t medium = rc_stack_medium(s, depth);
    static const char message[] = "out of memory for the depth %g m of a layered body";
    RC_OWNED struct inside *in = NULL;

    if (isinf(s->material[medium].modulus))
        return rc_err_null(err,
                           "depth %g m: the body is rigid from %g m on, where stresses are unknown",
                           depth, rc_stack_top(s, medium));
    if ((in = calloc(1, sizeof *in)) == NULL)
        return rc_err_null(err, message, depth);
    in->in = (struct rc_inside){&rc_layered_inside, depth};
    in->stack = s;
    in->medium = medium;
    in->depth = medium == 0 ? fmin(depth, s->material[0].thickness) : depth;
    in->shear = shear;
    in->scale = medium == 0 ? 2 * s->material[0].thickness - in->depth : depth;
    if (rc_repeats(boundary) == 0) {
        struct rc_radial_source source = {.n = in->shear ? FUNCTIONS : PRESSURE,
                                          .order = order,
                                          .scale = in->scale,
                                          .unit = in->scale,
                                          .last = 40,
                                          .wave = functions,
                                          .ctx = in};
        if ((in->radial = rc_radial_new(&source)) == NULL)
            return rc_err_null(err, message, depth);
    }
    return rc_give(&in);
}

const struct rc_inside_type rc_layered_inside = {
    .numbers = numbers,
    .new = inside_new,
    .free = inside_free,
    .waves = waves,
    .symbol = symbol,
    .mean = mean,
    .coefficients = coefficients,
    .line = line,
};
