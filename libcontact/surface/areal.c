/*
 * Parameters of a surface by ISO 25178-2: heights and slopes here, the others in their own files. Sums are
 * formed over pieces of the map, then over the pieces in order, so the number of threads changes no digit.
 */
#include "areal.h"

#include <stdlib.h>

enum {
    PIECE = 4096 /* values of a sum that needs no compensation */
};

/* ---- heights ---- */

/* Sums of the powers of d = v - mean, and of |d|. */
struct moments {
    double first, size, second, third, fourth;
};

RC_CLONES static struct moments
moments_of(const double *v, size_t n, double mean)
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
    return (struct moments){first, size, second, third, fourth};
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

static void
measure_heights(const struct rc_relief *r, struct moments *piece, size_t pieces, struct rc_areal *a)
{
    size_t n = r->shape.nx * r->shape.ny;
    double there = (double)r->there, variance, left;
    struct rc_total sum[5] = {{0}};

#pragma omp parallel for num_threads(r->threads) schedule(static)
    for (size_t k = 0; k < pieces; k++)
        piece[k] = moments_of(r->h + k * PIECE, k + 1 < pieces ? PIECE : n - k * PIECE, r->mean);
    for (size_t k = 0; k < pieces; k++) {
        const struct moments *m = &piece[k];
        rc_total_add(&sum[0], m->first);
        rc_total_add(&sum[1], m->size);
        rc_total_add(&sum[2], m->second);
        rc_total_add(&sum[3], m->third);
        rc_total_add(&sum[4], m->fourth);
    }
    left = rc_total_value(&sum[0]) / there; /* the mean itself is rounded */
    variance = fmax(0, rc_total_value(&sum[2]) / there - left * left);
    a->sq = sqrt(variance);
    a->sa = rc_total_value(&sum[1]) / there;
    if (variance > 0) {
        a->ssk = rc_total_value(&sum[3]) / there / (variance * a->sq);
        a->sku = rc_total_value(&sum[4]) / there / (variance * variance);
    }
    a->sp = r->maximum - r->mean;
    a->sv = r->mean - r->minimum;
    a->sz = r->maximum - r->minimum;
}

/* ---- slopes ---- */

/* Sums and counts over pairs along x and y, and over triangles. */
struct slopes {
    double x2, x_pairs, y2, y_pairs, excess, triangles, curved2, curved;
};

/* The increase of an area or a length by a slope, over its projection; g2 is the squared slope. */
static inline double
excess(double g2)
{
    return g2 / (1 + sqrt(1 + g2));
}

/* Adds the squared slopes of the steps from v[i] to next[i], for n nodes, and their number. */
RC_CLONES static void
add_steps(const double *v, const double *next, size_t n, double per, double *squares, double *pairs)
{
    double sum = 0, count = 0;

#pragma omp simd reduction(+ : sum, count)
    for (size_t i = 0; i < n; i++) {
        double g = (next[i] - v[i]) * per;
        bool is = fabs(v[i]) <= DBL_MAX && fabs(next[i]) <= DBL_MAX;
        sum += is ? g * g : 0;
        count += is ? 1 : 0;
    }
    *squares += sum;
    *pairs += count;
}

/* The four triangles of each four neighbouring nodes: both halves along either diagonal, each with a side
 * along x and one along y. NaN in a corner makes its triangles NaN. */
RC_CLONES static void
add_triangles(const double *v, const double *below, size_t n, double per_dx, double per_dy,
              struct slopes *to)
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
    to->excess += sum;
    to->triangles += count;
}

/* On a profile segments replace triangles. */
static void
add_segment(double from, double to_next, double per, struct slopes *to)
{
    double g = (to_next - from) * per, g2 = g * g;

    if (!(g2 <= DBL_MAX))
        return;
    to->excess += excess(g2);
    to->triangles++;
}

/* Mean curvatures of row j; on a periodic map neighbours wrap. */
static void
add_curvatures(const struct rc_relief *r, size_t j, struct slopes *to)
{
    size_t nx = r->shape.nx, ny = r->shape.ny, edge = r->boundary == RC_PERIODIC ? 0 : 1;
    double part = nx > 1 && ny > 1 ? 0.5 : 1;
    double xx = part / (r->shape.dx * r->shape.dx), yy = part / (r->shape.dy * r->shape.dy);
    const double *v = r->h + j * nx, *above = r->h + (j > 0 ? j - 1 : ny - 1) * nx,
                 *below = r->h + (j + 1 < ny ? j + 1 : 0) * nx;

    if (ny > 1 && (j < edge || j + edge >= ny))
        return;
    for (size_t i = nx > 1 ? edge : 0; i + (nx > 1 ? edge : 0) < nx; i++) {
        double c =
            nx > 1 ? xx * (v[i > 0 ? i - 1 : nx - 1] - 2 * v[i] + v[i + 1 < nx ? i + 1 : 0]) : 0;

        c += ny > 1 ? yy * (above[i] - 2 * v[i] + below[i]) : 0;
        if (!isfinite(c))
            continue;
        to->curved2 += c * c;
        to->curved++;
    }
}

static struct slopes
slopes_of_row(const struct rc_relief *r, size_t j)
{
    size_t nx = r->shape.nx, ny = r->shape.ny;
    double per_dx = 1 / r->shape.dx, per_dy = 1 / r->shape.dy;
    const double *v = r->h + j * nx, *below = v + nx;
    struct slopes s = {0};

    add_curvatures(r, j, &s);
    add_steps(v, v + 1, nx - 1, per_dx, &s.x2, &s.x_pairs);
    for (size_t i = 0; ny == 1 && i + 1 < nx; i++)
        add_segment(v[i], v[i + 1], per_dx, &s);
    if (j + 1 == ny)
        return s;
    add_steps(v, below, nx, per_dy, &s.y2, &s.y_pairs);
    if (nx == 1)
        add_segment(v[0], below[0], per_dy, &s);
    else
        add_triangles(v, below, nx - 1, per_dx, per_dy, &s);
    return s;
}

static void
measure_slopes(const struct rc_relief *r, struct slopes *row, struct rc_areal *a)
{
    struct rc_total sum[8] = {{0}};
    double x, y;

#pragma omp parallel for num_threads(r->threads) schedule(static)
    for (size_t j = 0; j < r->shape.ny; j++)
        row[j] = slopes_of_row(r, j);
    for (size_t j = 0; j < r->shape.ny; j++) {
        rc_total_add(&sum[0], row[j].x2);
        rc_total_add(&sum[1], row[j].x_pairs);
        rc_total_add(&sum[2], row[j].y2);
        rc_total_add(&sum[3], row[j].y_pairs);
        rc_total_add(&sum[4], row[j].excess);
        rc_total_add(&sum[5], row[j].triangles);
        rc_total_add(&sum[6], row[j].curved2);
        rc_total_add(&sum[7], row[j].curved);
    }
    /* 0/0 = NAN along a side of several nodes without a pair */
    x = r->shape.nx > 1 ? rc_total_value(&sum[0]) / rc_total_value(&sum[1]) : 0;
    y = r->shape.ny > 1 ? rc_total_value(&sum[2]) / rc_total_value(&sum[3]) : 0;
    if (r->shape.nx * r->shape.ny > 1)
        a->sdq = sqrt(x + y);
    if (r->shape.nx * r->shape.ny > 1)
        a->rms_curvature = sqrt(rc_total_value(&sum[6]) / rc_total_value(&sum[7]));
    a->sdr = rc_total_value(&sum[4]) / rc_total_value(&sum[5]);
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
    RC_OWNED struct moments *piece = NULL;
    RC_OWNED struct slopes *row = NULL;
    size_t pieces;

    *a = (struct rc_areal){NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN,
                           NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    if (rc_shape_check(shape, err) != RC_OK)
        return RC_FAIL;
    r.shape = *shape;
    r.threads = rc_useful_threads(shape, options->threads);
    pieces = (shape->nx * shape->ny - 1) / PIECE + 1;
    piece = malloc(pieces * sizeof *piece);
    row = malloc(shape->ny * sizeof *row);
    if (piece == NULL || row == NULL)
        return rc_err_set(err, "out of memory for the figures of %zu x %zu nodes", shape->nx,
                          shape->ny);
    measure_extent(&r);
    if (r.there == 0)
        return RC_OK;
    measure_heights(&r, piece, pieces, a);
    measure_slopes(&r, row, a);
    if (r.maximum > r.minimum && rc_texture(&r, a, err) != RC_OK)
        return RC_FAIL;
    return rc_material_ratio(&r, a, err);
}
