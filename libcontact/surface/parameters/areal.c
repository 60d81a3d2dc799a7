/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Parameters of a surface by ISO 25178-2: heights and slopes here, the others in their own files. Sums are
 * formed over pieces of the map, then over the pieces in order, so the number of threads changes no digit.
 */
#include "areal.h"

#include <stdlib.h>

#include "libcontact/ranks/ranks.h"

enum {
    PIECE = 4096 /* values of a sum that needs no compensation */
};

/* Sums of `sums` numbers over rows, or pieces, of the map. */
static enum rc_status
sum_up(struct rc_relief *r, rc_sums_work *work, size_t rows, size_t sums, double *total,
       struct rc_err *err)
{
    struct rc_sums s;

    if (rc_sums_new(&s, NULL, rows, sums, 0, r->threads) != RC_OK)
        return rc_err_set(err, "out of memory for the figures of %zu x %zu nodes", r->shape.nx,
                          r->shape.ny);
    rc_sums_rows(&s, work, r, total);
    free(s.row);
    return RC_OK;
}

/* ---- heights ---- */

enum { /* sums of the powers of d = v - mean, and of |d| */
    FIRST,
    SIZE,
    SECOND,
    THIRD,
    FOURTH,
    MOMENTS
};

RC_CLONES static void
add_moments(const double *v, size_t n, double mean, double *sums)
{
    double first = 0, size = 0, second = 0, third = 0, fourth = 0;

#pragma omp simd reduction(+ : first, size, second, third, fourth)
    for (size_t k = 0; k < n; k++) {
        double d = fabs(v[k]) <= DBL_MAX ? v[k] - mean : 0, d2 = d * d;
        first += d;
        size += fabs(d);
        second += d2;
        third += d2 * d;
        fourth += d2 * d2;
    }
    sums[FIRST] = first;
    sums[SIZE] = size;
    sums[SECOND] = second;
    sums[THIRD] = third;
    sums[FOURTH] = fourth;
}

static void
moments_of_piece(void *of, size_t k, double *sums)
{
    const struct rc_relief *r = of;
    const size_t left = r->shape.nx * r->shape.ny - k * PIECE;

    add_moments(r->h + k * PIECE, left < PIECE ? left : PIECE, r->mean, sums);
}

static void
measure_extent(struct rc_relief *r)
{
    struct rc_statistics s;

    rc_measure(&r->shape, r->h, &s);
    r->there = r->shape.nx * r->shape.ny - s.missing - s.infinite;
    r->minimum = s.minimum;
    r->maximum = s.maximum;
    /* for a flat far from 0, rounding may put the mean outside the extremes */
    r->mean = fmin(fmax(s.mean, s.minimum), s.maximum);
}

static enum rc_status
measure_heights(struct rc_relief *r, struct rc_areal *a, struct rc_err *err)
{
    const double there = (double)r->there;
    double sum[MOMENTS], variance, left;

    if (sum_up(r, moments_of_piece, (r->shape.nx * r->shape.ny - 1) / PIECE + 1, MOMENTS, sum,
               err) != RC_OK)
        return RC_FAIL;
    left = sum[FIRST] / there; /* the mean itself is rounded */
    variance = fmax(0, sum[SECOND] / there - left * left);
    a->sq = sqrt(variance);
    a->sa = sum[SIZE] / there;
    if (variance > 0) {
        a->ssk = sum[THIRD] / there / (variance * a->sq);
        a->sku = sum[FOURTH] / there / (variance * variance);
    }
    a->sp = r->maximum - r->mean;
    a->sv = r->mean - r->minimum;
    a->sz = r->maximum - r->minimum;
    return RC_OK;
}

/* ---- slopes ---- */

enum { /* sums and counts over pairs along x and y, over triangles, and over nodes */
    X2,
    X_PAIRS,
    Y2,
    Y_PAIRS,
    EXCESS,
    TRIANGLES,
    CURVED2,
    CURVED,
    SLOPES
};

/* The increase of an area or a length by a slope, over its projection; g2 is the squared slope. */
static inline double
excess(double g2)
{
    return g2 / (1 + sqrt(1 + g2));
}

/* Adds the squared slopes of the steps from v[i] to next[i], for n nodes, and their number. */
RC_CLONES static void
add_steps(const double *v, const double *next, size_t n, double per, double *sums)
{
    double sum = 0, count = 0;

#pragma omp simd reduction(+ : sum, count)
    for (size_t i = 0; i < n; i++) {
        double g = (next[i] - v[i]) * per;
        bool is = fabs(v[i]) <= DBL_MAX && fabs(next[i]) <= DBL_MAX;
        sum += is ? g * g : 0;
        count += is ? 1 : 0;
    }
    sums[0] += sum;
    sums[1] += count;
}

/* The four triangles of each four neighbouring nodes: both halves along either diagonal, each with a side
 * along x and one along y. NaN in a corner makes its triangles NaN. */
RC_CLONES static void
add_triangles(const double *v, const double *below, size_t n, double per_dx, double per_dy,
              double *sums)
{
    double sum = 0, count = 0;

#pragma omp simd reduction(+ : sum, count)
    for (size_t i = 0; i < n; i++) {
        double top = (v[i + 1] - v[i]) * per_dx, bottom = (below[i + 1] - below[i]) * per_dx;
        double left = (below[i] - v[i]) * per_dy, right = (below[i + 1] - v[i + 1]) * per_dy;
        double t2 = top * top, b2 = bottom * bottom, l2 = left * left, r2 = right * right;
        double tl = t2 + l2, tr = t2 + r2, bl = b2 + l2, br = b2 + r2;
        sum += tl <= DBL_MAX ? excess(tl) : 0;
        sum += tr <= DBL_MAX ? excess(tr) : 0;
        sum += bl <= DBL_MAX ? excess(bl) : 0;
        sum += br <= DBL_MAX ? excess(br) : 0;
        count += tl <= DBL_MAX ? 1 : 0;
        count += tr <= DBL_MAX ? 1 : 0;
        count += bl <= DBL_MAX ? 1 : 0;
        count += br <= DBL_MAX ? 1 : 0;
    }
    sums[EXCESS] += sum;
    sums[TRIANGLES] += count;
}

/* On a profile segments replace triangles. */
static void
add_segment(double from, double to_next, double per, double *sums)
{
    double g = (to_next - from) * per, g2 = g * g;

    if (!(g2 <= DBL_MAX))
        return;
    sums[EXCESS] += excess(g2);
    sums[TRIANGLES]++;
}

/* Mean curvatures of row j; on a periodic map neighbours wrap. */
static void
add_curvatures(const struct rc_relief *r, size_t j, double *sums)
{
    size_t nx = r->shape.nx, ny = r->shape.ny, across = !r->boundary.x, down = !r->boundary.y;
    double part = nx > 1 && ny > 1 ? 0.5 : 1;
    double xx = part / (r->shape.dx * r->shape.dx), yy = part / (r->shape.dy * r->shape.dy);
    const double *v = r->h + j * nx, *above = r->h + (j > 0 ? j - 1 : ny - 1) * nx,
                 *below = r->h + (j + 1 < ny ? j + 1 : 0) * nx;

    if (ny > 1 && (j < down || j + down >= ny))
        return;
    for (size_t i = nx > 1 ? across : 0; i + (nx > 1 ? across : 0) < nx; i++) {
        double c =
            nx > 1 ? xx * (v[i > 0 ? i - 1 : nx - 1] - 2 * v[i] + v[i + 1 < nx ? i + 1 : 0]) : 0;

        c += ny > 1 ? yy * (above[i] - 2 * v[i] + below[i]) : 0;
        if (!isfinite(c))
            continue;
        sums[CURVED2] += c * c;
        sums[CURVED]++;
    }
}

static void
slopes_of_row(void *of, size_t j, double *sums)
{
    const struct rc_relief *r = of;
    size_t nx = r->shape.nx, ny = r->shape.ny;
    double per_dx = 1 / r->shape.dx, per_dy = 1 / r->shape.dy;
    const double *v = r->h + j * nx, *below = v + nx;

    add_curvatures(r, j, sums);
    add_steps(v, v + 1, nx - 1, per_dx, sums + X2);
    for (size_t i = 0; ny == 1 && i + 1 < nx; i++)
        add_segment(v[i], v[i + 1], per_dx, sums);
    if (j + 1 == ny)
        return;
    add_steps(v, below, nx, per_dy, sums + Y2);
    if (nx == 1)
        add_segment(v[0], below[0], per_dy, sums);
    else
        add_triangles(v, below, nx - 1, per_dx, per_dy, sums);
}

static enum rc_status
measure_slopes(struct rc_relief *r, struct rc_areal *a, struct rc_err *err)
{
    double sum[SLOPES], x, y;

    if (sum_up(r, slopes_of_row, r->shape.ny, SLOPES, sum, err) != RC_OK)
        return RC_FAIL;
    /* 0/0 = NAN along a side of several nodes without a pair */
    x = r->shape.nx > 1 ? sum[X2] / sum[X_PAIRS] : 0;
    y = r->shape.ny > 1 ? sum[Y2] / sum[Y_PAIRS] : 0;
    if (r->shape.nx * r->shape.ny > 1) {
        a->sdq = sqrt(x + y);
        a->rms_curvature = sqrt(sum[CURVED2] / sum[CURVED]);
    }
    a->sdr = sum[EXCESS] / sum[TRIANGLES];
    return RC_OK;
}

/* ---- all parameters ---- */

#define FIGURE(member) RC_FIGURE(struct rc_areal, member)
/* clang-format off */
const struct rc_figure rc_figures_areal[] = {
    {FIGURE(sq), "m", "Sq"}, {FIGURE(sa), "m", "Sa"}, {FIGURE(ssk), NULL, "Ssk"}, {FIGURE(sku), NULL, "Sku"},
    {FIGURE(sp), "m", "Sp"}, {FIGURE(sv), "m", "Sv"}, {FIGURE(sz), "m", "Sz"}, {FIGURE(sdq), NULL, "Sdq"},
    {FIGURE(sdr), NULL, "Sdr"}, {FIGURE(sal), "m", "Sal"}, {FIGURE(str), NULL, "Str"},
    {FIGURE(std), "deg", "Std"}, {FIGURE(sk), "m", "Sk"}, {FIGURE(spk), "m", "Spk"},
    {FIGURE(svk), "m", "Svk"}, {FIGURE(smr1), NULL, "Smr1"}, {FIGURE(smr2), NULL, "Smr2"},
    {FIGURE(vmp), "m", "Vmp"}, {FIGURE(vmc), "m", "Vmc"}, {FIGURE(vvc), "m", "Vvc"},
    {FIGURE(vvv), "m", "Vvv"}, {FIGURE(sxp), "m", "Sxp"}, {FIGURE(rms_curvature), "1/m", "RMS curvature"},
    {0},
};
/* clang-format on */

enum rc_status
rc_areal(const struct rc_shape *shape, const double *h, const struct rc_surface_options *options,
         struct rc_areal *a, struct rc_err *err)
{
    struct rc_relief r = {.h = h, .boundary = options->boundary};

    *a = (struct rc_areal){NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN,
                           NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    if (rc_shape_check(shape, err) != RC_OK)
        return RC_FAIL;
    r.shape = *shape;
    r.threads = rc_useful_threads(shape, options->threads);
    measure_extent(&r);
    if (r.there == 0)
        return RC_OK;
    if (measure_heights(&r, a, err) != RC_OK || measure_slopes(&r, a, err) != RC_OK ||
        (r.maximum > r.minimum && rc_texture(&r, a, err) != RC_OK))
        return RC_FAIL;
    return rc_material_ratio(&r, a, err);
}
