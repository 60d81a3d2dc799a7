/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figures of a map. Sums are compensated and moments are taken about the mean, so that neither the number of
 * nodes nor a large constant costs digits. Several values are processed together, each in its own sum and
 * without branches, so that only memory limits the speed. */
#include "libcontact/common.h"
#include "libcontact/memory.h"
#include "libcontact/ranks/ranks.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "measure.h"

enum {
    LANES = RC_LANES
};

/* The sum of rc_total for each lane; its rounding error is computed without comparing magnitudes (Knuth, The
 * Art of Computer Programming 2, 4.2.2, theorem B). */
static inline void
add(struct rc_lane_sums *t, size_t lane, double v)
{
    double old = t->sum[lane], s = old + v, added = s - old;

    t->lost[lane] += (old - (s - added)) + (v - added);
    t->sum[lane] = s;
}

static double
value(const struct rc_lane_sums *t)
{
    struct rc_total all = {0};

    for (size_t l = 0; l < LANES; l++)
        rc_total_add(&all, t->sum[l]);
    for (size_t l = 0; l < LANES; l++)
        rc_total_add(&all, isfinite(all.sum) ? t->lost[l] : 0);
    return rc_total_value(&all);
}

static double
count(const double n[LANES])
{
    double all = 0;

    for (size_t l = 0; l < LANES; l++)
        all += n[l];
    return all;
}

/* ---- counts, extremes, sum ---- */

static inline void
take(struct rc_first *f, size_t lane, double v)
{
    bool is = rc_there(v);
    double low = f->minimum[lane], high = f->maximum[lane];

    f->there[lane] += is ? 1 : 0;
    f->missing[lane] += v != v ? 1 : 0;
    f->minimum[lane] = is && v < low ? v : low;
    f->maximum[lane] = is && v > high ? v : high;
    add(&f->sum, lane, is ? v : 0);
}

RC_CLONES static void
take_row(struct rc_first *restrict to, const double *restrict v, size_t n)
{
    struct rc_first f = *to;
    size_t k = 0;

    for (; k + LANES <= n; k += LANES) {
#pragma omp simd
        for (size_t l = 0; l < LANES; l++)
            take(&f, l, v[k + l]);
    }
    for (size_t l = 0; k < n; k++, l++)
        take(&f, l, v[k]);
    *to = f;
}

void
rc_first_begin(struct rc_first *f)
{
    *f = (struct rc_first){0};
    for (size_t l = 0; l < LANES; l++) {
        f->minimum[l] = INFINITY;
        f->maximum[l] = -INFINITY;
    }
}

void
rc_first_row(struct rc_first *f, const double *v, size_t n)
{
    take_row(f, v, n);
}

/* The extremes; NAN: no value. */
static void
extremes(const struct rc_first *f, double *minimum, double *maximum)
{
    *minimum = *maximum = NAN;
    for (size_t l = 0; l < LANES && count(f->there) > 0; l++) {
        *minimum = fmin(*minimum, f->minimum[l]);
        *maximum = fmax(*maximum, f->maximum[l]);
    }
}

double
rc_first_mean(const struct rc_first *f)
{
    const double mean = value(&f->sum) / count(f->there);
    double minimum, maximum;

    extremes(f, &minimum, &maximum);
    /* else the rounding of one height is larger */
    return fabs(mean) < DBL_EPSILON * fmax(fabs(minimum), fabs(maximum)) ? 0 : mean;
}

/* ---- the second moment ---- */

struct second {
    struct rc_lane_sums squares, rest;
};

static inline void
take_about(struct second *s, size_t lane, double v, double mean)
{
    double d = rc_there(v) ? v - mean : 0;

    add(&s->squares, lane, d * d);
    add(&s->rest, lane, d);
}

RC_CLONES static void
take_all_about(struct second *restrict to, const double *restrict v, size_t n, double mean)
{
    struct second s = *to;
    size_t k = 0;

    for (; k + LANES <= n; k += LANES) {
#pragma omp simd
        for (size_t l = 0; l < LANES; l++)
            take_about(&s, l, v[k + l], mean);
    }
    for (size_t l = 0; k < n; k++, l++)
        take_about(&s, l, v[k], mean);
    *to = s;
}

static double
rms_of(const struct second *s, double nodes)
{
    /* the mean is rounded itself: corrects for its error */
    const double left = value(&s->rest) / nodes;
    const double square = value(&s->squares) / nodes - left * left;

    return square <= 0 ? 0 : sqrt(square); /* NaN, from an overflow of the squares, stays NaN */
}

/* ---- slope: over nodes with a measured next neighbour, along each side of more than one node ---- */

struct slope {
    double there[LANES];
    struct rc_lane_sums squares;
};

static inline void
take_slope(struct slope *s, size_t lane, double v, double right, double below, const double per[2])
{
    bool is = rc_there(v) && rc_there(right) && rc_there(below);
    double gx = (right - v) * per[0], gy = (below - v) * per[1], g2 = gx * gx + gy * gy;

    s->there[lane] += is ? 1 : 0;
    add(&s->squares, lane, is ? g2 : 0);
}

/* per: 1/dx, 1/dy. */
RC_CLONES static void
take_slopes(struct slope *restrict to, const double *v, const double *right, const double *below,
            size_t n, const double per[2])
{
    struct slope s = *to;
    double by[2] = {per[0], per[1]};
    size_t k = 0;

    for (; k + LANES <= n; k += LANES) {
#pragma omp simd
        for (size_t l = 0; l < LANES; l++)
            take_slope(&s, l, v[k + l], right[k + l], below[k + l], by);
    }
    for (size_t l = 0; k < n; k++, l++)
        take_slope(&s, l, v[k], right[k], below[k], by);
    *to = s;
}

/* ---- all figures ---- */

#define FIGURE(member) RC_FIGURE(struct rc_statistics, member)
/* clang-format off */
const struct rc_figure rc_figures_statistics[] = {
    {FIGURE(minimum), NULL, "Minimum"}, {FIGURE(maximum), NULL, "Maximum"}, {FIGURE(mean), NULL, "Mean"},
    {FIGURE(rms), NULL, "RMS"}, {FIGURE(rms_slope), NULL, "RMS slope"}, {FIGURE(sum), NULL, "Sum"},
    {FIGURE(missing), NULL, "Missing values"}, {FIGURE(infinite), NULL, "Infinite values"},
    {0},
};
/* clang-format on */

/* The figures of a map in two passes over its rows. */
struct passes {
    const struct rc_shape *shape;
    struct rc_first first;
    struct slope slope;
    struct second second;
};

/* The slopes of a row; another row follows it unless the map has only one. */
static void
take_slopes_of(struct passes *p, const double *row)
{
    const size_t nx = p->shape->nx, right = nx > 1 ? 1 : 0, below = p->shape->ny > 1 ? nx : 0;
    const double per[2] = {1 / p->shape->dx, 1 / p->shape->dy};

    take_slopes(&p->slope, row, row + right, row + below, nx - right, per);
}

/* All but the second moment. */
static void
end_first(const struct passes *p, struct rc_statistics *result)
{
    const size_t all = p->shape->nx * p->shape->ny;
    const double nodes = count(p->first.there);

    *result = (struct rc_statistics){
        .minimum = NAN, .maximum = NAN, .mean = NAN, .rms = NAN, .rms_slope = NAN};
    result->missing = (size_t)count(p->first.missing);
    result->infinite = all - (size_t)nodes - result->missing;
    result->sum = value(&p->first.sum);
    if (nodes == 0)
        return;
    extremes(&p->first, &result->minimum, &result->maximum);
    result->mean = rc_first_mean(&p->first);
    if (all > 1 && count(p->slope.there) > 0)
        result->rms_slope = sqrt(value(&p->slope.squares) / count(p->slope.there));
}

void
rc_measure(const struct rc_shape *shape, const double *v, struct rc_statistics *result)
{
    struct passes p = {.shape = shape};
    double nodes;

    rc_first_begin(&p.first);
    for (size_t j = 0; j < shape->ny; j++) {
        take_row(&p.first, v + j * shape->nx, shape->nx);
        if (j + 1 < shape->ny || shape->ny == 1)
            take_slopes_of(&p, v + j * shape->nx);
    }
    end_first(&p, result);
    if ((nodes = count(p.first.there)) == 0)
        return;
    take_all_about(&p.second, v, shape->nx * shape->ny, result->sum / nodes);
    result->rms = rms_of(&p.second, nodes);
}

enum {
    TOGETHER = 1 << 16 /* values that are read together */
};

/* Rows that are read together: a multiple of RC_LANES, so that a value of the second pass has the lane that
 * it has in a map in memory. */
static size_t
rows_together(const struct rc_shape *shape)
{
    const size_t n =
        (shape->nx < TOGETHER / RC_LANES ? TOGETHER / RC_LANES / shape->nx : 1) * RC_LANES;

    return n < shape->ny ? n : shape->ny;
}

/* One pass over the source. Of a map of several rows room has one more: the last row of the piece before. */
static enum rc_status
pass(struct passes *p, const struct rc_row_source *from, double mean, bool second, double *room,
     struct rc_err *err)
{
    const size_t nx = p->shape->nx, ny = p->shape->ny, together = rows_together(p->shape);
    double *v = room + (ny > 1 ? nx : 0);

    if (from->again(from->ctx, err) != RC_OK)
        return RC_FAIL;
    for (size_t n, j = 0; j < ny; j += n) {
        n = together < ny - j ? together : ny - j;
        if (from->get(from->ctx, n, v, err) != RC_OK)
            return RC_FAIL;
        if (second)
            take_all_about(&p->second, v, n * nx, mean);
        for (size_t k = 0; k < n && !second; k++) {
            take_row(&p->first, v + k * nx, nx);
            if (j + k > 0 || ny == 1)
                take_slopes_of(p, ny == 1 ? v : v + k * nx - nx);
        }
        if (ny > 1)
            memcpy(room, v + (n - 1) * nx, nx * sizeof *room);
    }
    return RC_OK;
}

enum rc_status
rc_measure_source(const struct rc_shape *shape, const struct rc_row_source *from,
                  struct rc_statistics *result, struct rc_err *err)
{
    struct passes p = {.shape = shape};
    RC_OWNED double *room =
        rc_alloc((rows_together(shape) + (shape->ny > 1)) * shape->nx, sizeof *room);
    double nodes;

    if (room == NULL)
        return rc_err_set(err, "out of memory for rows of %zu nodes", shape->nx);
    rc_first_begin(&p.first);
    if (pass(&p, from, 0, false, room, err) != RC_OK)
        return RC_FAIL;
    end_first(&p, result);
    if ((nodes = count(p.first.there)) == 0)
        return RC_OK;
    if (pass(&p, from, result->sum / nodes, true, room, err) != RC_OK)
        return RC_FAIL;
    result->rms = rms_of(&p.second, nodes);
    return RC_OK;
}

/* ---- slopes in contact, and steps across the period ---- */

static size_t
piece_of(size_t nx, size_t first)
{
    return nx - first < RC_ROW_PIECE ? nx - first : RC_ROW_PIECE;
}

/* The rows before and after those held here, n of their columns: RC_ROW_PIECE numbers each. */
static void
fetch_beside(const struct rc_rows *rows, bool round, const struct rc_shape *shape, const double *v,
             size_t first, size_t n, double *beside, bool has[2])
{
    size_t last = (rows->n > 0 ? rows->n - 1 : 0) * shape->nx;

    if (rows->n == 0)
        first = 0;
    rc_ranks_beside(rows, round, n * sizeof *v, v + first, v + last + first, beside,
                    beside + RC_ROW_PIECE, has);
}

/* Adds the squared slopes of n nodes in contact, and their number; `right`: the columns to the next node. */
RC_CLONES static void
take_contact(struct rc_total sums[2], const double *row, const double *below, const double *load,
             size_t n, size_t right, const double per[2])
{
    double sum = 0, count = 0;

#pragma omp simd reduction(+ : sum, count)
    for (size_t i = 0; i < n; i++) {
        double gx = (row[i + right] - row[i]) * per[0];
        double gy = (below[i] - row[i]) * per[1];
        double touches = rc_in_contact(load[i]) ? 1 : 0;
        sum += touches * (gx * gx + gy * gy);
        count += touches;
    }
    rc_total_add(&sums[0], sum);
    rc_total_add(&sums[1], count);
}

double
rc_measure_contact_slope(const struct rc_ranks *ranks, const struct rc_shape *shape,
                         const double *h, const double *p)
{
    const struct rc_rows rows = rc_rows_of(ranks, shape);
    size_t nx = shape->nx, right = nx > 1 ? 1 : 0;
    const double per[2] = {1 / shape->dx, 1 / shape->dy};
    struct rc_total sums[2] = {{0}};
    double beside[2 * RC_ROW_PIECE] = {0}, total[2];
    bool has[2] = {false, false};
    double all[RC_ROW_PIECE];

    for (size_t i = 0; p == NULL && i < RC_ROW_PIECE; i++)
        all[i] = 1;
    for (size_t first = 0; first < nx; first += RC_ROW_PIECE) {
        size_t n = piece_of(nx, first), steps = first + n < nx ? n : n - right;
        if (rows.ranks != NULL)
            fetch_beside(&rows, false, shape, h, first, n, beside, has);
        for (size_t j = 0; j < rows.n; j++) {
            const double *row = h + j * nx + first;
            const double *below = j + 1 < rows.n ? row + nx : has[1] ? beside + RC_ROW_PIECE : row;
            if (below == row && shape->ny > 1)
                break;
            take_contact(sums, row, below, p == NULL ? all : p + j * nx + first, steps, right, per);
        }
    }
    rc_ranks_totals(rows.ranks, 2, sums, total, 0, NULL);
    return sqrt(total[0] / total[1]);
}

/* Adds the squared steps from a[i] to b[i], piece by piece as rows of other ranks arrive. */
RC_CLONES static void
add_steps(struct rc_total *squares, const double *a, const double *b, size_t n)
{
    for (size_t first = 0; first < n; first += RC_ROW_PIECE) {
        size_t last = first + piece_of(n, first);
        double sum = 0;
#pragma omp simd reduction(+ : sum)
        for (size_t i = first; i < last; i++)
            sum += (b[i] - a[i]) * (b[i] - a[i]);
        rc_total_add(squares, sum);
    }
}

enum { /* squared steps */
    INSIDE_X,
    INSIDE_Y,
    ACROSS_X,
    ACROSS_Y,
    STEPS
};

void
rc_measure_seam(const struct rc_ranks *ranks, const struct rc_shape *shape, const double *v,
                struct rc_seam *seam)
{
    const struct rc_rows rows = rc_rows_of(ranks, shape);
    size_t nx = shape->nx, ny = shape->ny;
    struct rc_total squares[STEPS] = {{0}};
    double beside[2 * RC_ROW_PIECE] = {0}, sum[STEPS];
    bool has[2];

    for (size_t j = 0; j < rows.n; j++) {
        const double *row = v + j * nx;
        add_steps(&squares[INSIDE_X], row, row + 1, nx - 1);
        add_steps(&squares[ACROSS_X], row + nx - 1, row, 1);
        if (j > 0)
            add_steps(&squares[INSIDE_Y], row - nx, row, nx);
    }
    /* differences to the row before those held here */
    for (size_t first = 0; first < nx; first += RC_ROW_PIECE) {
        size_t n = piece_of(nx, first);
        const double *before = v + (rows.n > 0 ? (rows.n - 1) * nx + first : 0);
        if (rows.ranks != NULL) {
            fetch_beside(&rows, true, shape, v, first, n, beside, has);
            before = beside;
        }
        if (rows.n > 0)
            add_steps(&squares[rows.first > 0 ? INSIDE_Y : ACROSS_Y], before, v + first, n);
    }
    rc_ranks_totals(rows.ranks, STEPS, squares, sum, 0, NULL);
    *seam = (struct rc_seam){{NAN, NAN}, {NAN, NAN}};
    if (nx > 1) {
        seam->inside[0] = sqrt(sum[INSIDE_X] / (double)(ny * (nx - 1)));
        seam->across[0] = sqrt(sum[ACROSS_X] / (double)ny);
    }
    if (ny > 1) {
        seam->inside[1] = sqrt(sum[INSIDE_Y] / (double)(nx * (ny - 1)));
        seam->across[1] = sqrt(sum[ACROSS_Y] / (double)nx);
    }
}
