/*
 * The Gaussian regression filter of order 0 (ISO 16610-61; of profiles ISO 16610-21), and its
 * robust form (ISO 16610-71, 16610-31). With the weighting function s, and weights w that are 0
 * where nothing was measured, the low-pass surface is
 *
 *     s * (w h) / s * w,      s(x, y) = exp(-pi (x^2 + y^2) / a^2),    a = sqrt(ln 2 / pi) L
 *
 * s is a product of a factor of x and one of y, so both sums are done line by line, first along x,
 * then along y. Where a is many nodes long they go by coarser nodes: the product of two Gaussians
 * of the width a / sqrt(2), one about a fine node x and one about another, X, is the Gaussian of
 * width a of x - X times one of width a / 2 about the middle between them. Summed over coarse nodes
 * s apart that is a constant times the Gaussian of x - X but for a part 2 exp(-pi (a / 2s)^2),
 * which is less than rounding where s <= a / 7. The sums to the coarse nodes and back take the same
 * time for every L, and all terms are positive, so that a weighted mean stays one to rounding
 * however few points there are.
 */
#include "libcontact/common.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"
#include "robust.h"

enum {
    LANES = 8, /* lines that are summed at a time, numerators and denominators */
    BLOCK = 64 /* nodes of them that are turned at a time */
};

/* A Gaussian is cut where it is exp(-pi reach^2) = 2e-18 of its largest value. */
static const double reach = 3.6;
/* Coarse nodes to the width of the Gaussian. */
static const double coarse_per_width = 7;
/* Relative: a length that rounding has left just below two nodes counts as two. */
static const double slack = 1e-9;

/* Sums along a line: out[k] = sum over t < taps of w[(k % phases) taps + t] in[k step / phases +
 * start + t]. */
struct sums {
    size_t out, taps, step, phases;
    ptrdiff_t start;
    double *w;
};

/* The sums along one direction: down to the coarse nodes and up again; where `two` is false, `down`
 * does all. */
struct way {
    size_t n, m; /* nodes of the line, and after the first sums */
    bool two;
    struct sums down, up;
    size_t pad; /* nodes that are read on either side of a periodic line */
};

struct gauss {
    const struct rc_shape *shape;
    bool periodic;
    int threads;
    struct way x, y;
    double *mid;       /* for each row of the map x.m numerators, then as many denominators */
    size_t stride;     /* from numerators to denominators, and on to the next row */
    double *lines;     /* for each thread: in and out of the sums */
    size_t per_thread; /* doubles of it */
};

/* ---- sums along a line ---- */

static void
fill_gaussian(double *w, size_t taps, double first, double step, double width)
{

    for (size_t t = 0; t < taps; t++) {
        double u = (first + (double)t * step) / width;
        w[t] = exp(-RC_PI * u * u);
    }
}

static bool
sums_new(struct sums *s, size_t out, size_t taps, size_t phases)
{
    s->out = out;
    s->taps = taps;
    s->phases = phases;
    s->w = rc_alloc(taps * phases, sizeof *s->w);
    return s->w != NULL;
}

/* A width in nodes. */
static bool
way_direct(struct way *way, double width)
{
    size_t half = (size_t)ceil(reach * width);

    way->m = way->n;
    way->pad = half;
    way->down = (struct sums){.step = 1, .start = -(ptrdiff_t)half};
    if (!sums_new(&way->down, way->n, 2 * half + 1, 1))
        return false;
    fill_gaussian(way->down.w, way->down.taps, -(double)half, 1, width);
    return true;
}

/* Coarse node c is at the fine place (c - before) step, so that those within reach of the ends of
 * the line are there. */
static bool
way_coarse(struct way *way, double width, size_t step)
{
    double half_width = width / sqrt(2);
    size_t half = (size_t)ceil(reach * half_width), before = (half + step - 1) / step;

    way->two = true;
    way->m = (way->n - 1) / step + 2 * before + 2;
    way->down = (struct sums){.step = step, .start = -(ptrdiff_t)(before * step + half)};
    way->up = (struct sums){.step = 1};
    way->pad = before * step + half + 2 * step;
    if (!sums_new(&way->down, way->m, 2 * half + 1, 1) ||
        !sums_new(&way->up, way->n, 2 * before + 2, step))
        return false;
    fill_gaussian(way->down.w, way->down.taps, -(double)half, 1, half_width);
    for (size_t p = 0; p < step; p++)
        fill_gaussian(way->up.w + p * way->up.taps, way->up.taps, (double)(p + before * step),
                      -(double)step, half_width);
    return true;
}

/* `width` of the Gaussian in nodes; a line of one node stays what it is. */
static bool
way_new(struct way *way, size_t n, double width)
{
    size_t step = (size_t)(width / coarse_per_width);

    *way = (struct way){.n = n};
    if (n == 1) {
        way->m = 1;
        way->down = (struct sums){.step = 1};
        if (!sums_new(&way->down, 1, 1, 1))
            return false;
        way->down.w[0] = 1;
        return true;
    }
    return step < 2 ? way_direct(way, width) : way_coarse(way, width, step);
}

/* Lines lie side by side, `wide` numbers at each place. `in` is place 0; places from low to high
 * may be read, and what would lie beyond is 0. */
static inline void
sum_wide(const struct sums *s, ptrdiff_t low, ptrdiff_t high, size_t wide,
         const double *restrict in, double *restrict out)
{
    for (size_t k = 0; k < s->out; k++) {
        ptrdiff_t first = (ptrdiff_t)(k * s->step / s->phases) + s->start;
        ptrdiff_t begin = first < low ? low - first : 0;
        ptrdiff_t end = first + (ptrdiff_t)s->taps > high ? high - first : (ptrdiff_t)s->taps;
        const double *w = s->w + k % s->phases * s->taps;
        double sum[2 * LANES] = {0};
        for (ptrdiff_t t = begin; t < end; t++) {
            const double *at = in + (first + t) * (ptrdiff_t)wide;
#pragma omp simd
            for (size_t l = 0; l < wide; l++)
                sum[l] += w[t] * at[l];
        }
        for (size_t l = 0; l < wide; l++)
            out[k * wide + l] = sum[l];
    }
}

RC_CLONES static void
sum_lanes(const struct sums *s, ptrdiff_t low, ptrdiff_t high, size_t lanes, const double *in,
          double *out)
{
    if (lanes == LANES)
        sum_wide(s, low, high, 2 * LANES, in, out);
    else
        sum_wide(s, low, high, 2 * lanes, in, out);
}

/* ---- the plan ---- */

static void
gauss_free(struct gauss *g)
{
    free(g->x.down.w);
    free(g->x.up.w);
    free(g->y.down.w);
    free(g->y.up.w);
    free(g->mid);
    free(g->lines);
}

/* Places that a line and its sums take, those beyond the ends of a periodic line included. */
static size_t
places_in(const struct gauss *g, const struct way *way)
{
    size_t n = way->n + (g->periodic && way->n > 1 ? 2 * way->pad : 0);

    return n > way->m ? n : way->m;
}

static size_t
places_out(const struct way *way)
{
    return way->m > way->n ? way->m : way->n;
}

static size_t
smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

static size_t
larger(size_t a, size_t b)
{
    return a > b ? a : b;
}

/* The sums, and how much room they take. */
static bool
plan(struct gauss *g, double cutoff)
{
    double width = sqrt(log(2) / RC_PI) * cutoff;
    size_t lanes_x = smaller(g->shape->ny, LANES), lanes_y, in, out;

    if (!way_new(&g->x, g->shape->nx, width / g->shape->dx) ||
        !way_new(&g->y, g->shape->ny, width / g->shape->dy))
        return false;
    lanes_y = smaller(g->x.m, LANES);
    in = larger(places_in(g, &g->x) * lanes_x, places_in(g, &g->y) * lanes_y);
    out = larger(places_out(&g->x) * lanes_x, places_out(&g->y) * lanes_y);
    g->per_thread = 2 * (in + out);
    /* whole cache lines, and not all in the same places of the cache */
    g->stride = (g->x.m + LANES - 1) / LANES * LANES + LANES;
    return true;
}

static enum rc_status
gauss_new(struct gauss *g, const struct rc_shape *shape, const struct rc_filter *what,
          struct rc_err *err)
{
    *g = (struct gauss){.shape = shape, .periodic = what->periodic};
    g->threads = rc_useful_threads(shape, what->threads);
    if (plan(g, what->cutoff)) {
        g->mid = rc_alloc(shape->ny, 2 * g->stride * sizeof *g->mid);
        g->lines = rc_alloc((size_t)g->threads, g->per_thread * sizeof *g->lines);
    }
    if (g->mid == NULL || g->lines == NULL)
        return rc_err_set(err, "out of memory for a filter of %zu x %zu nodes", shape->nx,
                          shape->ny);
    return RC_OK;
}

/* ---- one filtering ---- */

/* What is filtered: heights less their mean, weighted by the residuals r (NULL: all alike). */
struct weighted {
    const double *h, *r;
    double mean, reach;
};

/* Puts the ends of a periodic line before its start and behind its end. */
static void
wrap(const struct way *way, size_t wide, double *line)
{
    ptrdiff_t n = (ptrdiff_t)way->n, pad = (ptrdiff_t)way->pad;

    for (ptrdiff_t i = 0; i < pad; i++) {
        ptrdiff_t back = i % n;
        memcpy(line + (n + i) * (ptrdiff_t)wide, line + back * (ptrdiff_t)wide,
               wide * sizeof *line);
        memcpy(line - (1 + i) * (ptrdiff_t)wide, line + (n - 1 - back) * (ptrdiff_t)wide,
               wide * sizeof *line);
    }
}

/* Numerators of the nodes begin ... end-1 of a row of the map, every `wide`-th number of `line`;
 * each denominator stands wide/2 numbers behind its numerator. */
static void
take_row(const struct weighted *of, size_t row, size_t begin, size_t end, size_t wide, double *line)
{
    const double *h = of->h + row, *r = of->r == NULL ? NULL : of->r + row;

    for (size_t i = begin; i < end; i++) {
        bool there = !isnan(h[i]);
        double w = r == NULL ? 1 : rc_biweight(r[i], of->reach);
        line[i * wide] = there ? w * (h[i] - of->mean) : 0;
        line[i * wide + wide / 2] = there ? w : 0;
    }
}

/* `lanes` rows side by side. */
static void
take_rows(const struct gauss *g, const struct weighted *of, size_t j, size_t lanes, double *line)
{
    size_t nx = g->shape->nx;

    for (size_t i = 0; i < nx; i += BLOCK)
        for (size_t l = 0; l < lanes; l++)
            take_row(of, (j + l) * nx, i, smaller(i + BLOCK, nx), 2 * lanes, line + l);
}

static double *
mid_row(const struct gauss *g, size_t j, size_t lane, size_t lanes)
{
    return g->mid + ((j + lane % lanes) * 2 + lane / lanes) * g->stride;
}

static void
put_mid(const struct gauss *g, size_t j, size_t lanes, const double *line)
{
    size_t m = g->x.m;

    for (size_t i = 0; i < m; i += BLOCK)
        for (size_t l = 0; l < 2 * lanes; l++) {
            double *row = mid_row(g, j, l, lanes);
            for (size_t k = i; k < smaller(i + BLOCK, m); k++)
                row[k] = line[k * 2 * lanes + l];
        }
}

static void
take_mid(const struct gauss *g, size_t j, size_t lanes, double *line)
{
    size_t m = g->x.m;

    for (size_t i = 0; i < m; i += BLOCK)
        for (size_t l = 0; l < 2 * lanes; l++) {
            const double *row = mid_row(g, j, l, lanes);
            for (size_t k = i; k < smaller(i + BLOCK, m); k++)
                line[k * 2 * lanes + l] = row[k];
        }
}

/* The buffers of this thread; `in` is place 0 of a line, with room for what wraps before it. */
static void
buffers(const struct gauss *g, const struct way *way, size_t wide, double **in, double **out)
{
    double *at = g->lines + (size_t)omp_get_thread_num() * g->per_thread;
    size_t pad = g->periodic && way->n > 1 ? way->pad : 0;

    *in = at + pad * wide;
    *out = at + places_in(g, way) * wide;
}

static void
sum_down(const struct gauss *g, const struct way *way, size_t lanes, double *in, double *out)
{
    ptrdiff_t pad = g->periodic && way->n > 1 ? (ptrdiff_t)way->pad : 0;

    if (pad > 0)
        wrap(way, 2 * lanes, in);
    sum_lanes(&way->down, -pad, (ptrdiff_t)way->n + pad, lanes, in, out);
}

static void
sum_rows(const struct gauss *g, const struct weighted *of)
{
    size_t ny = g->shape->ny;

#pragma omp parallel for schedule(static) num_threads(g->threads)
    for (size_t j = 0; j < ny; j += LANES) {
        size_t lanes = smaller(ny - j, LANES);
        double *in, *out;
        buffers(g, &g->x, 2 * lanes, &in, &out);
        take_rows(g, of, j, lanes, in);
        sum_down(g, &g->x, lanes, in, out);
        put_mid(g, j, lanes, out);
    }
}

/* All sums along y, within `mid`. */
static void
sum_columns(const struct gauss *g)
{
    size_t ny = g->shape->ny, m = g->x.m;

    if (ny == 1)
        return;
#pragma omp parallel for schedule(static) num_threads(g->threads)
    for (size_t i = 0; i < m; i += LANES) {
        size_t lanes = smaller(m - i, LANES);
        double *in, *out;
        buffers(g, &g->y, 2 * lanes, &in, &out);
        for (size_t j = 0; j < 2 * ny; j++)
            memcpy(in + j * lanes, g->mid + j * g->stride + i, lanes * sizeof *in);
        sum_down(g, &g->y, lanes, in, out);
        if (g->y.two) {
            in = g->lines + (size_t)omp_get_thread_num() * g->per_thread;
            sum_lanes(&g->y.up, 0, (ptrdiff_t)g->y.m, lanes, out, in);
            out = in;
        }
        for (size_t j = 0; j < 2 * ny; j++)
            memcpy(g->mid + j * g->stride + i, out + j * lanes, lanes * sizeof *in);
    }
}

/* Writes the nodes begin ... end-1 of a row: the quotient plus the mean or, of the high-pass, the
 * input less both. A node with no weight within reach stays as it is. */
static void
put_row(const struct weighted *of, bool low, size_t row, size_t begin, size_t end, size_t wide,
        const double *line, double *to)
{
    for (size_t i = begin; i < end; i++) {
        double h = of->h[row + i], below = line[i * wide + wide / 2];
        double quotient = line[i * wide] / below;
        if (isnan(h))
            to[row + i] = h;
        else if (below > 0)
            to[row + i] = low ? quotient + of->mean : (h - of->mean) - quotient;
    }
}

static void
put_rows(const struct gauss *g, const struct weighted *of, bool low, size_t j, size_t lanes,
         const double *line, double *to)
{
    size_t nx = g->shape->nx;

    for (size_t i = 0; i < nx; i += BLOCK)
        for (size_t l = 0; l < lanes; l++)
            put_row(of, low, (j + l) * nx, i, smaller(i + BLOCK, nx), 2 * lanes, line + l, to);
}

/* The low-pass of h or, less its mean, the high-pass; `to` may be the residuals that the weights
 * are made of, or h itself. */
static void
pass(const struct gauss *g, const struct weighted *of, bool low, double *to)
{
    size_t ny = g->shape->ny;

    sum_rows(g, of);
    sum_columns(g);
#pragma omp parallel for schedule(static) num_threads(g->threads)
    for (size_t j = 0; j < ny; j += LANES) {
        size_t lanes = smaller(ny - j, LANES);
        double *in = g->lines + (size_t)omp_get_thread_num() * g->per_thread;
        double *out = in + places_in(g, &g->x) * 2 * lanes;
        take_mid(g, j, lanes, in);
        if (g->x.two)
            sum_lanes(&g->x.up, 0, (ptrdiff_t)g->x.m, lanes, in, out);
        put_rows(g, of, low, j, lanes, g->x.two ? out : in, to);
    }
}

/* ---- what is asked for ---- */

static enum rc_status
check(const struct rc_shape *shape, const struct rc_filter *what, const struct rc_statistics *s,
      struct rc_err *err)
{
    double dx = shape->nx > 1 || shape->ny == 1 ? shape->dx : 0, dy = shape->ny > 1 ? shape->dy : 0;
    double nodes = 2 * fmax(dx, dy), side = fmax((double)shape->nx * dx, (double)shape->ny * dy);

    if (!(what->cutoff >= nodes * (1 - slack)))
        return rc_err_set(err, "a cut-off of %g m is below two nodes, %g m: take a longer one",
                          what->cutoff, nodes);
    if (!(what->cutoff <= side * (1 + slack)))
        return rc_err_set(err,
                          "a cut-off of %g m is longer than the map, %g m: take a shorter one, or "
                          "subtract a form",
                          what->cutoff, side);
    if (s->infinite > 0)
        return rc_err_set(err, "%zu infinite heights: no filter takes them", s->infinite);
    if (s->missing == shape->nx * shape->ny)
        return rc_err_set(err, "all %zu heights are missing: nothing to filter", s->missing);
    return RC_OK;
}

/* Residuals of the filter, weighted anew by them until the weights stay. */
static void
reweight(const struct gauss *g, const struct rc_statistics *s, const double *h, double *r)
{
    struct weighted of = {.h = h, .mean = s->mean};
    double size = fmax(s->maximum - s->mean, s->mean - s->minimum);
    size_t n = g->shape->nx * g->shape->ny;

    pass(g, &of, false, r);
    of.r = r;
    for (size_t k = 0; k < RC_REWEIGHT_MAX; k++) {
        double before = of.reach;
        of.reach = rc_biweight_reach * rc_median(r, n, 0, true, g->threads);
        if (rc_reweighted(of.reach, before, size))
            break;
        pass(g, &of, false, r);
    }
}

enum rc_status
rc_filter(const struct rc_shape *shape, const struct rc_filter *what, double *h, struct rc_err *err)
{
    size_t n = shape->nx * shape->ny;
    struct gauss g = {0};
    struct rc_statistics s;
    enum rc_status status;
    double *r = NULL;

    rc_measure(shape, h, &s);
    if (check(shape, what, &s, err) != RC_OK)
        return RC_FAIL;
    status = gauss_new(&g, shape, what, err);
    if (status == RC_OK && what->robust && (r = rc_alloc(n, sizeof *r)) == NULL)
        status = rc_err_set(err, "out of memory for the residuals of %zu heights", n);
    if (status == RC_OK && !what->robust)
        pass(&g, &(struct weighted){.h = h, .mean = s.mean}, !what->high, h);
    if (status == RC_OK && what->robust) {
        reweight(&g, &s, h, r);
        for (size_t k = 0; k < n; k++)
            h[k] = what->high ? r[k] : h[k] - r[k];
    }
    free(r);
    gauss_free(&g);
    return status;
}

size_t
rc_filter_memory(const struct rc_shape *shape, const struct rc_filter *what)
{
    struct gauss g = {.shape = shape, .periodic = what->periodic};
    size_t bytes = 0;

    g.threads = rc_useful_threads(shape, what->threads);
    if (plan(&g, what->cutoff))
        bytes = (shape->ny * 2 * g.stride + (size_t)g.threads * g.per_thread +
                 (what->robust ? shape->nx * shape->ny : 0)) *
                sizeof(double);
    gauss_free(&g);
    return bytes;
}
