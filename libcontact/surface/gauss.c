/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The Gaussian regression filter of order 0 (ISO 16610-61; of profiles ISO 16610-21), and its
 * robust form (ISO 16610-71, 16610-31). With the weighting function s, and weights w that are 0
 * where nothing was measured, the low-pass surface is
 *
 *     s * (w h) / s * w,      s(x, y) = exp(-pi (x^2 + y^2) / a^2),    a = sqrt(ln 2 / pi) L
 *
 * s is a product of a factor in x and one in y. So the sums are computed first along x, line by line, then
 * along y, where whole rows are added. Where a is many nodes long, coarser nodes in between are used. The
 * product of two Gaussians of width a / sqrt(2), about the fine nodes x and X, is a Gaussian of width a in
 * x - X times one of width a / 2 about the middle between x and X. Summed over coarse nodes at a spacing s,
 * the second factor is constant but for a fraction 2 exp(-pi (a / 2s)^2). This fraction is below rounding for
 * s <= a / 7. The sums to the coarse nodes and back take the same time for every L. All terms are positive,
 * so a weighted mean remains accurate to rounding however few points there are.
 */
#include "libcontact/common.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"
#include "robust.h"

enum {
    WIDE = 8,         /* columns whose sums are kept in registers: a cache line */
    BLOCK = 4 * WIDE, /* sums along a line, likewise */
    TOGETHER = 4,     /* sums of rows that use the same rows */
    BAND = 128,       /* rows that a thread processes at a time */
    STRIP = 256       /* columns of a band whose rows stay in the cache */
};

/* A Gaussian is cut off where it is exp(-pi reach^2) = 2e-18 of its largest value. */
static const double reach = 3.6;
/* Coarse nodes per width of the Gaussian. */
static const double coarse_per_width = 7;
/* Relative: a length just below two nodes because of rounding counts as two. */
static const double slack = 1e-9;

/* Sums along a line, or of rows: out[k] = sum over t < taps of w[(k % phases) taps + t] in[k step / phases +
 * start + t]. */
struct sums {
    size_t out, taps, step, phases;
    ptrdiff_t start;
    double *w;
};

static struct sums
sums_new(struct rc_store *own, size_t out, size_t taps, size_t step, size_t phases, ptrdiff_t start)
{
    return (struct sums){out,    taps,  step,
                         phases, start, rc_store_take(own, taps * phases, sizeof(double))};
}

/* The sums along one direction: down to the coarse nodes and up again; if `two` is false, `down` is the whole
 * filter. */
struct way {
    size_t n, m; /* nodes of the line, and after the first sums */
    bool two;
    struct sums down, up;
    size_t pad; /* nodes read beyond each end of the line */
};

struct gauss {
    const struct rc_shape *shape;
    struct rc_boundary boundary;
    int threads;
    struct way x, y;
    double *mid;        /* each row of the map has x.m numerators, then as many denominators */
    double *low;        /* where y uses coarse nodes: the same for each coarse row           */
    size_t stride;      /* distance of numerators and denominators, and of the next row */
    double *room;       /* memory for each thread: lines, rows of sums and their weights */
    const double **row; /* for each thread: addresses of the rows to add */
    size_t per_thread, rows_per_thread;
    struct rc_store own;
};

static size_t
smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* ---- sums along a line ---- */

/* `w` may be NULL: memory is short. */
static void
fill_gaussian(double *w, size_t taps, double first, double step, double width)
{
    for (size_t t = 0; t < taps && w != NULL; t++) {
        double u = (first + (double)t * step) / width;
        w[t] = exp(-RC_PI * u * u);
    }
}

/* A width given in nodes. */
static void
way_direct(struct way *way, struct rc_store *own, double width)
{
    size_t half = (size_t)ceil(reach * width);

    way->m = way->n;
    way->pad = half;
    way->down = sums_new(own, way->n, 2 * half + 1, 1, 1, -(ptrdiff_t)half);
    fill_gaussian(way->down.w, way->down.taps, -(double)half, 1, width);
}

/* Coarse node c is at the fine place (c - before) step; includes those within reach of the ends of the
 * line. */
static void
way_coarse(struct way *way, struct rc_store *own, double width, size_t step)
{
    double half_width = width / sqrt(2);
    size_t half = (size_t)ceil(reach * half_width), before = (half + step - 1) / step;

    way->two = true;
    way->m = (way->n - 1) / step + 2 * before + 2;
    way->pad = before * step + half + 2 * step;
    way->down = sums_new(own, way->m, 2 * half + 1, step, 1, -(ptrdiff_t)(before * step + half));
    way->up = sums_new(own, way->n, 2 * before + 2, 1, step, 0);
    fill_gaussian(way->down.w, way->down.taps, -(double)half, 1, half_width);
    for (size_t p = 0; p < step && way->up.w != NULL; p++)
        fill_gaussian(way->up.w + p * way->up.taps, way->up.taps, (double)(p + before * step),
                      -(double)step, half_width);
}

/* `width` of the Gaussian in nodes; a line of one node is not filtered. */
static void
way_new(struct way *way, struct rc_store *own, size_t n, double width)
{
    size_t step = (size_t)(width / coarse_per_width);

    *way = (struct way){.n = n, .m = 1};
    if (n == 1) {
        way->down = sums_new(own, 1, 1, 1, 1, 0);
        fill_gaussian(way->down.w, 1, 0, 1, 1);
    } else if (step < 2) {
        way_direct(way, own, width);
    } else {
        way_coarse(way, own, width, step);
    }
}

/* First input of sum k. */
static inline ptrdiff_t
first_of(const struct sums *s, size_t k)
{
    return (ptrdiff_t)(k * s->step / s->phases) + s->start;
}

/* Adds `block` sums whose inputs begin one place after each other. Weights are `apart` numbers apart. */
static inline void
sum_some(const double *restrict in, const double *restrict w, size_t taps, size_t apart,
         size_t block, double *restrict sum)
{
    for (size_t t = 0; t < taps; t++)
        for (size_t l = 0; l < block; l++)
            sum[l] += w[t * apart] * in[t + l];
}

/* BLOCK of them, which stay in registers. */
static inline void
sum_block(const double *restrict in, const double *restrict w, size_t taps, size_t apart,
          double *restrict sum)
{
    double s0[WIDE], s1[WIDE], s2[WIDE], s3[WIDE];

    memcpy(s0, sum, sizeof s0);
    memcpy(s1, sum + WIDE, sizeof s1);
    memcpy(s2, sum + 2 * WIDE, sizeof s2);
    memcpy(s3, sum + 3 * WIDE, sizeof s3);
    for (size_t t = 0; t < taps; t++) {
        const double *at = in + t, by = w[t * apart];
#pragma omp simd
        for (size_t l = 0; l < WIDE; l++) {
            s0[l] += by * at[l];
            s1[l] += by * at[WIDE + l];
            s2[l] += by * at[2 * WIDE + l];
            s3[l] += by * at[3 * WIDE + l];
        }
    }
    memcpy(sum, s0, sizeof s0);
    memcpy(sum + WIDE, s1, sizeof s1);
    memcpy(sum + 2 * WIDE, s2, sizeof s2);
    memcpy(sum + 3 * WIDE, s3, sizeof s3);
}

static inline void
add_block(const double *in, const double *w, size_t taps, size_t apart, size_t block, double *sum)
{
    if (block == BLOCK)
        sum_block(in, w, taps, apart, sum);
    else
        sum_some(in, w, taps, apart, block, sum);
}

/* All sums along a line whose place 0 is `in`, phase by phase; step is 1. */
RC_WIDE_CLONES static void
sum_phases(const struct sums *s, const double *restrict in, double *restrict out)
{
    for (size_t p = 0; p < s->phases && p < s->out; p++) {
        size_t n = (s->out - p - 1) / s->phases + 1;
        for (size_t k = 0; k < n; k += BLOCK) {
            size_t block = smaller(n - k, BLOCK);
            double sum[BLOCK] = {0};
            add_block(in + (ptrdiff_t)k + s->start, s->w + p * s->taps, s->taps, 1, block, sum);
            for (size_t l = 0; l < block; l++)
                out[(k + l) * s->phases + p] = sum[l];
        }
    }
}

/* The same for a step above 1, without phases. It first collects every step-th number in `part`, which needs
 * out + taps/step + 1 numbers. */
RC_WIDE_CLONES static void
sum_steps(const struct sums *s, const double *restrict in, double *restrict part,
          double *restrict out)
{
    memset(out, 0, s->out * sizeof *out);
    for (size_t p = 0; p < s->step; p++) {
        size_t taps = (s->taps - p - 1) / s->step + 1;
        for (size_t k = 0; k < s->out + taps - 1; k++)
            part[k] = in[(ptrdiff_t)(k * s->step + p) + s->start];
        for (size_t k = 0; k < s->out; k += BLOCK)
            add_block(part + k, s->w + p, taps, s->step, smaller(s->out - k, BLOCK), out + k);
    }
}

/* ---- sums of rows ---- */

/* Rows of a map, 2 stride numbers from each to the next. */
struct rows {
    const double *v;
    size_t n, stride;
    bool wraps;
};

/* The rows used by TOGETHER sums from k on, and TOGETHER weights for each. */
static size_t
gather(const struct sums *s, const struct rows *of, size_t k, const double **row, double *w)
{
    size_t last = k + TOGETHER < s->out ? k + TOGETHER - 1 : s->out - 1, count = 0;
    ptrdiff_t n = (ptrdiff_t)of->n;

    for (ptrdiff_t j = first_of(s, k); j < first_of(s, last) + (ptrdiff_t)s->taps; j++) {
        if (!of->wraps && (j < 0 || j >= n))
            continue;
        for (size_t r = 0; r < TOGETHER; r++) {
            ptrdiff_t t = j - first_of(s, k + r);
            bool counts = k + r <= last && t >= 0 && t < (ptrdiff_t)s->taps;
            w[count * TOGETHER + r] = counts ? s->w[(k + r) % s->phases * s->taps + (size_t)t] : 0;
        }
        row[count++] = of->v + (size_t)((j % n + n) % n) * 2 * of->stride;
    }
    return count;
}

/* Sums of the columns first ... first+n-1 of these rows: TOGETHER sums, `apart` numbers from each to the
 * next. n is a multiple of WIDE. */
RC_WIDE_CLONES static void
add_rows(size_t rows, const double *const *row, const double *w, size_t first, size_t n,
         size_t apart, double *restrict out)
{
    for (size_t i = 0; i < n; i += WIDE) {
        double s0[WIDE] = {0}, s1[WIDE] = {0}, s2[WIDE] = {0}, s3[WIDE] = {0};
        for (size_t t = 0; t < rows; t++) {
            const double *at = row[t] + first + i, *by = w + t * TOGETHER;
#pragma omp simd
            for (size_t l = 0; l < WIDE; l++) {
                s0[l] += by[0] * at[l];
                s1[l] += by[1] * at[l];
                s2[l] += by[2] * at[l];
                s3[l] += by[3] * at[l];
            }
        }
        memcpy(out + i, s0, sizeof s0);
        memcpy(out + apart + i, s1, sizeof s1);
        memcpy(out + 2 * apart + i, s2, sizeof s2);
        memcpy(out + 3 * apart + i, s3, sizeof s3);
    }
}

/* ---- the plan ---- */

/* Number of rows used by TOGETHER sums. */
static size_t
rows_of(const struct sums *s)
{
    return s->taps + TOGETHER * s->step;
}

/* Length of a line with both paddings, a multiple of WIDE. */
static size_t
line_room(const struct way *way)
{
    return (way->n + 2 * way->pad + WIDE - 1) / WIDE * WIDE;
}

static enum rc_status
gauss_new(struct gauss *g, const struct rc_shape *shape, const struct rc_filter *what,
          struct rc_err *err)
{
    const double width = sqrt(log(2) / RC_PI) * what->cutoff;
    size_t low, down, up;

    *g = (struct gauss){.shape = shape, .boundary = what->boundary};
    g->threads = rc_useful_threads(shape, what->threads);
    way_new(&g->x, &g->own, shape->nx, width / shape->dx);
    way_new(&g->y, &g->own, shape->ny, width / shape->dy);
    /* a row fills whole cache lines; one more line keeps rows out of the same cache sets */
    g->stride = (g->x.m + WIDE - 1) / WIDE * WIDE + WIDE;
    low = g->y.two ? g->y.m * 2 * g->stride : 0;
    down = rows_of(&g->y.down);
    up = g->y.two ? rows_of(&g->y.up) : 0;
    g->rows_per_thread = down > up ? down : up;
    g->per_thread = 2 * line_room(&g->x) + 2 * TOGETHER * g->stride +
                    (TOGETHER * g->rows_per_thread + WIDE - 1) / WIDE * WIDE;
    g->mid = rc_store_take(&g->own, shape->ny, 2 * g->stride * sizeof *g->mid);
    g->low = rc_store_take(&g->own, low, sizeof *g->low);
    g->room = rc_store_take(&g->own, (size_t)g->threads, g->per_thread * sizeof *g->room);
    g->row = rc_store_take(&g->own, (size_t)g->threads, g->rows_per_thread * sizeof *g->row);
    if (g->own.failed)
        return rc_err_set(err, "out of memory for a filter of %zu x %zu nodes", shape->nx,
                          shape->ny);
    return RC_OK;
}

/* ---- one filtering ---- */

/* The input: heights less their mean, weighted by the residuals r (NULL: equal weights). */
struct weighted {
    const double *h, *r;
    double mean, reach;
};

/* Fills the padding of a line: from its other end if it repeats, else with zeros. */
static void
fill_ends(const struct way *way, bool repeats, double *line)
{
    ptrdiff_t n = (ptrdiff_t)way->n, pad = (ptrdiff_t)way->pad;

    for (ptrdiff_t i = 0; i < pad; i++) {
        line[n + i] = repeats ? line[i % n] : 0;
        line[-1 - i] = repeats ? line[n - 1 - i % n] : 0;
    }
}

/* Numerators and denominators of n nodes. */
RC_WIDE_CLONES static void
take_row(const struct weighted *of, size_t first, size_t n, double *restrict above,
         double *restrict below)
{
    const double *h = of->h + first, *r = of->r == NULL ? NULL : of->r + first;
    const double mean = of->mean, far = of->reach;

    for (size_t i = 0; i < n; i++)
        below[i] = h[i] == h[i] ? 1 : 0;
    for (size_t i = 0; i < n && r != NULL; i++)
        below[i] *= rc_biweight(r[i], far);
    for (size_t i = 0; i < n; i++)
        above[i] = h[i] == h[i] ? below[i] * (h[i] - mean) : 0;
}

/* The scratch of this thread: place 0 of two lines, rows of sums, and weights. */
struct room {
    double *above, *below, *sums, *w;
    const double **row;
};

static struct room
room_of(const struct gauss *g)
{
    size_t thread = (size_t)omp_get_thread_num(), line = line_room(&g->x);
    double *at = g->room + thread * g->per_thread, *sums = at + 2 * line;

    return (struct room){at + g->x.pad, at + line + g->x.pad, sums, sums + 2 * TOGETHER * g->stride,
                         g->row + thread * g->rows_per_thread};
}

static void
sum_down_x(const struct gauss *g, const struct room *room, const double *line, double *to)
{
    if (g->x.two)
        sum_steps(&g->x.down, line, room->sums, to);
    else
        sum_phases(&g->x.down, line, to);
}

/* Sums along x of all rows, into `mid`; its padding is added too, and must contain numbers. */
static void
sum_along_x(const struct gauss *g, const struct weighted *of)
{
    size_t nx = g->shape->nx, pad = g->stride - g->x.m;

#pragma omp parallel for schedule(static) num_threads(g->threads)
    for (size_t j = 0; j < g->shape->ny; j++) {
        struct room room = room_of(g);
        double *above = g->mid + 2 * j * g->stride, *below = above + g->stride;
        take_row(of, j * nx, nx, room.above, room.below);
        fill_ends(&g->x, g->boundary.x, room.above);
        fill_ends(&g->x, g->boundary.x, room.below);
        sum_down_x(g, &room, room.above, above);
        sum_down_x(g, &room, room.below, below);
        memset(above + g->x.m, 0, pad * sizeof *above);
        memset(below + g->x.m, 0, pad * sizeof *below);
    }
}

/* Sums along y at the coarse nodes, into `low`. */
static void
sum_down_y(const struct gauss *g)
{
    const struct rows mid = {g->mid, g->shape->ny, g->stride, g->boundary.y};

#pragma omp parallel for schedule(static) num_threads(g->threads)
    for (size_t k = 0; k < g->y.m; k += TOGETHER) {
        struct room room = room_of(g);
        size_t rows = gather(&g->y.down, &mid, k, room.row, room.w);
        add_rows(rows, room.row, room.w, 0, 2 * g->stride, 2 * g->stride, room.sums);
        memcpy(g->low + k * 2 * g->stride, room.sums,
               smaller(g->y.m - k, TOGETHER) * 2 * g->stride * sizeof *g->low);
    }
}

/* Writes n nodes: the quotient plus the mean or, for the high-pass, the input less both. A node without any
 * weight within reach is not changed. */
RC_WIDE_CLONES static void
put_row(const struct weighted *of, bool low, size_t first, size_t n, const double *above,
        const double *below, double *to)
{
    const double mean = of->mean, *from = of->h + first;

    to += first;
#pragma omp simd
    for (size_t i = 0; i < n; i++) {
        double h = from[i], quotient = above[i] / below[i], was = to[i];
        double is = low ? quotient + mean : (h - mean) - quotient;
        to[i] = h != h ? h : below[i] > 0 ? is : was;
    }
}

/* TOGETHER rows of results from j on, in the columns first ... first+n-1 of the sums along x. */
static void
finish_rows(const struct gauss *g, const struct weighted *of, bool low, size_t j, size_t first,
            size_t n, double *to)
{
    const struct rows mid = {g->mid, g->shape->ny, g->stride, g->boundary.y};
    const struct rows coarse = {g->low, g->y.m, g->stride, false};
    struct room room = room_of(g);
    size_t nx = g->shape->nx, wide = (n + WIDE - 1) / WIDE * WIDE;
    double *above = room.sums, *below = room.sums + TOGETHER * wide;
    size_t rows =
        gather(g->y.two ? &g->y.up : &g->y.down, g->y.two ? &coarse : &mid, j, room.row, room.w);

    add_rows(rows, room.row, room.w, first, wide, wide, above);
    add_rows(rows, room.row, room.w, g->stride + first, wide, wide, below);
    for (size_t r = 0; r < TOGETHER && j + r < g->shape->ny; r++, above += wide, below += wide) {
        if (!g->x.two) {
            put_row(of, low, (j + r) * nx + first, n, above, below, to);
            continue;
        }
        sum_phases(&g->x.up, above, room.above);
        sum_phases(&g->x.up, below, room.below);
        put_row(of, low, (j + r) * nx, nx, room.above, room.below, to);
    }
}

/* The low-pass of h or, less its mean, the high-pass; `to` may be the residuals used for the weights, or h
 * itself. */
static void
pass(const struct gauss *g, const struct weighted *of, bool low, double *to)
{
    size_t ny = g->shape->ny, m = g->x.m, strip = g->x.two ? m : STRIP;

    sum_along_x(g, of);
    if (g->y.two)
        sum_down_y(g);
#pragma omp parallel for schedule(dynamic) num_threads(g->threads)
    for (size_t band = 0; band < ny; band += BAND)
        for (size_t i = 0; i < m; i += strip)
            for (size_t j = band; j < smaller(band + BAND, ny); j += TOGETHER)
                finish_rows(g, of, low, j, i, smaller(strip, m - i), to);
}

/* ---- the filters ---- */

static enum rc_status
check_cutoff(const struct rc_shape *shape, const struct rc_filter *what, struct rc_err *err)
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
    return RC_OK;
}

static enum rc_status
check(const struct rc_shape *shape, const struct rc_filter *what, const struct rc_statistics *s,
      struct rc_err *err)
{
    if (check_cutoff(shape, what, err) != RC_OK)
        return RC_FAIL;
    if (s->infinite > 0)
        return rc_err_set(err, "%zu infinite heights: no filter takes them", s->infinite);
    if (s->missing == shape->nx * shape->ny)
        return rc_err_set(err, "all %zu heights are missing: nothing to filter", s->missing);
    return RC_OK;
}

/* Residuals of the filter, with weights from them, until the weights no longer change. */
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
    struct rc_statistics s;
    enum rc_status status;
    struct gauss g;
    double *r;

    rc_measure(shape, h, &s);
    if (check(shape, what, &s, err) != RC_OK)
        return RC_FAIL;
    status = gauss_new(&g, shape, what, err);
    r = what->robust ? rc_store_take(&g.own, n, sizeof *r) : NULL;
    if (status == RC_OK && g.own.failed)
        status = rc_err_set(err, "out of memory for the residuals of %zu heights", n);
    if (status == RC_OK && !what->robust)
        pass(&g, &(struct weighted){.h = h, .mean = s.mean}, !what->high, h);
    if (status == RC_OK && what->robust) {
        reweight(&g, &s, h, r);
        for (size_t k = 0; k < n; k++)
            h[k] = what->high ? r[k] : h[k] - r[k];
    }
    rc_store_free(&g.own);
    return status;
}
