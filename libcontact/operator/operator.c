/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The operator of two bodies. An engine computes K p in double precision; transforms compute it row by row in
 * single precision, for the preconditioner too. If the engine must not be mixed with single precision, rows
 * are gathered into a map that the engine sums.
 */
#include "operator.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/body/line.h"
#include "libcontact/memory.h"

enum {
    STRIP_STEPS = 256
};
/* Sums over wave numbers from end exp(-k step) to end, 1/Pa; end = 0: the map is not a strip. */
struct strip {
    double end, step, sum[STRIP_STEPS];
    double width; /* width of the map, m */
};

struct own {
    struct rc_operator op;
    struct rc_solids own;           /* the bodies, except on a coarse grid                  */
    const struct rc_solids *bodies; /* this operator, or that of the finer grid */
    bool positive;                  /* the spectrum of their kernel is positive on any map  */
    double estar;                   /* E* of the pair, for waves as short as the roughness */
    double same;                    /* E*, if it is the same for all waves; NAN: it is not */
    double bends;                   /* m: the length over which stiff coatings bend         */
    double far;                     /* m/(N/m): what the datum adds for a line load         */
    double nearest;                 /* m: see rc_operator                                   */
    struct rc_conv *conv;           /* K p in double precision; NULL: none                  */
    struct rc_fft *fft;             /* single precision, lengths in units of sqrt(dx dy) */
    struct rc_fft *framed;          /* the same with the frame; NULL: no frame              */
    struct rc_spectrum *kernel, *inverse;
    struct strip strip;
    struct {
        double norm, diagonal;
    } bare;        /* spectrum of K without its diagonal term */
    double *p, *u; /* scratch for engines without single precision: maps */
    float *row; /* a row for each thread, for these and for a diagonal by nodes; otherwise NULL */
    int row_threads;
    struct rc_store memory;
};

static struct rc_conv_options
conv_options(const struct rc_operator_options *o)
{
    return (struct rc_conv_options){.boundary = o->boundary,
                                    .engine = o->engine,
                                    .tol = o->tol,
                                    .precise = true,
                                    .threads = o->threads,
                                    .ranks = o->ranks};
}

/* ---- figures ---- */

/* The norm of K without its diagonal term. On the free boundary the largest row sum of K is the displacement
 * in the middle of a rectangle a x b under uniform pressure. This is 2 (a asinh(b/a) + b asinh(a/b)) / (pi
 * E*) (Love 1929; Johnson 1985, eq. 3.25). On a periodic map the eigenvalues are known, and the longest wave
 * has the largest, 2 / (E* q), q = 2 pi / L. If only one axis repeats, it is the largest of such a wave along
 * this axis and of the row sum of a strip of width w, 2 w (ln(2 datum / w) + 1) / (pi E*). E* is the least
 * E*(q) of the bodies. */
static double
norm(const struct own *s)
{
    const struct rc_shape *shape = &s->op.whole;
    double a = shape->dx * (double)shape->nx, b = shape->dy * (double)shape->ny;
    double most = 1 / rc_solids_softest(s->bodies);

    if (!rc_has_mean(s->op.boundary))
        return most * fmax(a, b) / RC_PI;
    if (rc_repeats(s->op.boundary) == 1) {
        double w = s->op.boundary.x ? b : a, period = s->op.boundary.x ? a : b;
        return most * fmax(period, 2 * w * (log(2 * s->op.boundary.datum / w) + 1)) / RC_PI;
    }
    return most * 2 * (a * asinh(b / a) + b * asinh(a / b)) / RC_PI;
}

static double
diagonal(const struct own *s)
{
    const struct rc_surface surface = {s->bodies, 1, 1};
    const struct rc_kernel kernel = rc_surface_kernel(&surface);
    struct rc_lattice cell = {s->op.whole.dx, s->op.whole.dy, 1, 1};
    double self;

    kernel.rows(kernel.of, &cell, 1, 0, 1, &self);
    return self;
}

static struct rc_shape
unit_of(const struct rc_shape *s)
{
    double unit = sqrt(s->dx) * sqrt(s->dy);

    return (struct rc_shape){s->nx, s->ny, s->dx / unit, s->dy / unit};
}

static struct rc_boundary
unit_boundary(struct rc_boundary boundary, double unit)
{
    boundary.datum /= unit;
    return boundary;
}

/* The mean of A / (1 + D A) cos(i qx dx) cos(j qy dy) over the wave numbers of the grid, |qx| <= pi/dx and
 * |qy| <= pi/dy, as a sum over the middles of cells. A = |q| / 2 E*(q) / E*, with E* that of the roughness;
 * lengths are in units of sqrt(dx dy). For i = j = 0 the mean of |q| has a closed form, the mean distance of
 * a rectangle's points from its middle. Where D is 0, only the difference from this form is summed. */
static void
set_inverse_near(struct own *s)
{
    enum {
        CELLS = 64
    };
    const struct rc_shape nodes = unit_of(&s->op.whole), *unit = &nodes;
    const double length = sqrt(s->op.whole.dx) * sqrt(s->op.whole.dy);
    const double plus = s->op.soft.plus / s->op.unit;
    double a = RC_PI / unit->dx, b = RC_PI / unit->dy, d = hypot(a, b), sum[2][2] = {{0}};

    for (int l = 0; l < CELLS; l++)
        for (int k = 0; k < CELLS; k++) {
            double x = (k + 0.5) / CELLS, y = (l + 0.5) / CELLS, q = hypot(a * x, b * y);
            double stiff = rc_solids_modulus(s->bodies, q / length) / s->estar;
            double w = q / 2 / (1 + plus * stiff * q / 2) / (CELLS * CELLS);
            sum[0][0] += w * (plus > 0 ? stiff : stiff - 1);
            sum[0][1] += w * stiff * cos(RC_PI * x);
            sum[1][0] += w * stiff * cos(RC_PI * y);
            sum[1][1] += w * stiff * cos(RC_PI * x) * cos(RC_PI * y);
        }
    if (plus == 0)
        sum[0][0] += (2 * d + a * a / b * asinh(b / a) + b * b / a * asinh(a / b)) / 12;
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++)
            s->op.near.inverse[j][i] = sum[j != 1][i != 1];
}

/* The inverse, (-Laplace)^(1/2) E* / 2, couples two nodes with the strength |x|^(-3) of their distance. */
static void
set_neighbours(struct rc_operator *op, const struct rc_shape *unit)
{
    for (int b = -1; b <= 1; b++)
        for (int a = -1; a <= 1; a++) {
            double r = hypot(a * unit->dx, b * unit->dy);
            op->near.neighbour[b + 1][a + 1] = r > 0 ? 1 / (r * r * r) : 0;
        }
}

/* The frame, as a fraction of the sides of a free map. The preconditioner's extension ends with the frame,
 * which makes edges of contact near the border too stiff. On 1024 x 1024 nodes with 32 % contact the largest
 * eigenvalue is 3.9 without a frame, and 1.15 with all of the padding. It is 1.6, 1.4 and 1.26 with a frame
 * of 1/32, 1/16 and 1/8 of the sides (the same at 512 x 512). A frame of 1/8 costs a quarter of the
 * transforms of rows, a twelfth of the total. */
static const size_t frame_part = 8;
/* A strip has few rows, and its frame is the whole padding. On 65536 x 16 nodes with 6 and 41 % contact an
 * eighth took 14 and 17 steps, and all of the padding took 9 and 11. */
static const size_t strip_part = 2;
/* A strip is at least this many times as long as wide. */
static const size_t strip = 8;

/* Under a stiff coating: this many times the length over which it bends, at most all of the padding. For
 * E1/Es 400, 16 nodes thick, 1024 x 200 nodes, three loads, it took 38 to 68 equivalents with an eighth of
 * the sides. With this frame it took 14 to 16. */
static const double frame_bends = 3;

static double
longest_side(const struct rc_shape *s)
{
    return fmax(s->dx * (double)s->nx, s->dy * (double)s->ny);
}

/* Ratio of the stiffness of the bodies for the shortest and the longest waves of a grid. */
static double
stiffening(const struct rc_solids *bodies, const struct rc_shape *s)
{
    double node = sqrt(s->dx) * sqrt(s->dy);

    return rc_solids_modulus(bodies, RC_PI / node) /
           rc_solids_modulus(bodies, 2 * RC_PI / longest_side(s));
}

/* An even number, so that coarser grids begin with the map. On a long side it is a multiple of the rows that
 * stay together on a rank. `bends` is in nodes. */
static size_t
frame_of(size_t side, size_t other, double bends)
{
    size_t most = side / strip_part, n = side * strip <= other ? most : side / frame_part, unit;

    if (frame_bends * bends > (double)n)
        n = frame_bends * bends < (double)most ? (size_t)(frame_bends * bends) : most;
    unit = n >= 4 * RC_TILE_ROWS ? RC_TILE_ROWS : 2;
    return n / unit * unit;
}

/* `bends` is in m. */
static struct rc_frame
frame_around(const struct rc_shape *s, struct rc_boundary boundary, double bends)
{
    return (struct rc_frame){boundary.x ? 0 : frame_of(s->nx, s->ny, bends / s->dx),
                             boundary.y ? 0 : frame_of(s->ny, s->nx, bends / s->dy)};
}

static double
bending_length(const struct rc_shape *s, const struct rc_pair *pair)
{
    return rc_pair_bends(pair, longest_side(s));
}

struct rc_frame
rc_operator_frame(const struct rc_shape *s, const struct rc_operator_options *o)
{
    return frame_around(s, o->boundary, bending_length(s, o->pair));
}

/* ---- strips ---- */

/* A line load acts on the width b of a strip, a map that is free across. For waves along the strip that
 * are much longer than b, the displacement is the integral of 2 / (pi E*(k)) dk/k from q to 5.03 / b.
 * Here 5.03 = 2 exp(3/2 - 0.577). On uniform bodies this is a logarithm, which hardly depends on q. */
static void
set_strip(struct own *s)
{
    const struct rc_shape *w = &s->op.whole;
    double a = w->dx * (double)w->nx, b = w->dy * (double)w->ny;
    double end = 5.03 / fmin(a, b), longest = RC_PI / (4 * fmax(a, b));
    double step = log(end / longest) / STRIP_STEPS, sum = 0;

    if (rc_wraps(s->op.boundary, a < b ? RC_X : RC_Y) || fmax(a, b) < (double)strip * fmin(a, b))
        return;
    s->strip.end = end;
    s->strip.step = step;
    s->strip.width = fmin(a, b);
    for (int k = 0; k < STRIP_STEPS; k++) {
        s->strip.sum[k] = sum;
        sum += step / rc_solids_modulus(s->bodies, end * exp(-(k + 0.5) * step));
    }
}

/* True if the logarithm exceeds 1, its value for a plane. */
static bool
is_along_strip(const struct own *s, double q)
{
    return q < s->strip.end / exp(1);
}

static double
strip_sum(const struct own *s, double q)
{
    double at = fmin(log(s->strip.end / q) / s->strip.step, STRIP_STEPS - 1.001);
    size_t k = (size_t)at;

    return s->strip.sum[k] + (at - (double)k) * (s->strip.sum[k + 1] - s->strip.sum[k]);
}

/* E*(q) of waves, and of waves along a strip. */
static double
modulus_at(const struct own *s, double q)
{
    if (is_along_strip(s, q))
        return log(s->strip.end / q) / strip_sum(s, q);
    return rc_solids_modulus_of(s->bodies, q * q);
}

/* ---- plan ---- */

void
rc_operator_free(struct rc_operator *op)
{
    struct own *s = (struct own *)op;

    if (s == NULL)
        return;
    rc_fft_free(s->fft); /* uses memory of conv or of framed, which uses memory of conv */
    rc_fft_free(s->framed);
    rc_conv_free(s->conv);
    rc_spectrum_free(s->kernel);
    rc_spectrum_free(s->inverse);
    rc_solids_free(&s->own);
    rc_store_free(&s->memory);
    free(s->op.soft.sunk);
    free(s);
}

/* ---- the inverse ---- */

/* The spectrum of a padded kernel may be negative for some waves, under stiff coatings that bend over
 * lengths near that of the map. Its inverse is then kept within these bounds of the inverse of a uniform
 * half-space with the stiffness of the bodies for each wave. A positive spectrum, under soft coatings, is
 * used unchanged except for the longest waves. For thin, nearly incompressible coatings it decreases to
 * 0.005 of that half-space at the shortest waves. With these bounds the estimated error was down to half of
 * the error. */
static const double least = 0.7, most = 1.5;
/* Times half the smallest wave number of the padded map. Without bounds for these waves 320 estimates
 * of 3600 random coatings were below the error, 0.53 of it at worst; with them 7 of 6000, 0.98 at
 * worst. */
static const double long_waves = 6;

struct bounded {
    const struct own *s;
    size_t first, n; /* first: of the columns held here              */
    double length, longest;
    double *kernel; /* spectrum of the kernel, column by column */
    bool positive;  /* the spectrum is positive, and used except for the longest waves */
};

static void
keep_column(void *ctx, size_t i, size_t n, double *column)
{
    struct bounded *b = ctx;

    rc_keep_column(b->kernel, i - b->first, n, column);
}

static double
wave(const struct bounded *b, size_t i, size_t j)
{
    return hypot(rc_fft_qx(b->s->fft, i), rc_fft_qy(b->s->fft, j));
}

static bool
all_positive(const struct bounded *b, size_t columns)
{
    double low = INFINITY;

    for (size_t i = 0; i < columns; i++)
        for (size_t j = 0; j < b->n; j++)
            if (wave(b, b->first + i, j) > long_waves * b->longest)
                low = fmin(low, b->kernel[i * b->n + j]);
    return -rc_ranks_most(b->s->op.rows.ranks, -low) > 0;
}

/* Turns the column of the spectrum of a half-space of E* = 1 into the column of its inverse. */
static void
invert_column(void *ctx, size_t i, size_t n, double *column)
{
    const struct bounded *b = ctx;

    for (size_t j = 0; j < n; j++) {
        bool kept = b->positive && wave(b, i, j) > long_waves * b->longest;
        double q = fmax(wave(b, i, j), b->longest) / b->length;
        double near = column[j] * b->s->estar / modulus_at(b->s, q);
        double kernel = b->kernel[(i - b->first) * n + j];
        column[j] = 1 / (kept ? kernel : fmin(fmax(kernel, least * near), most * near));
    }
}

static enum rc_status
set_bounded(struct own *s, const struct rc_shape *unit, const struct rc_kernel *kernel,
            double length, struct rc_err *err)
{
    const struct rc_boundary boundary = unit_boundary(s->op.boundary, length);
    struct bounded b = {
        .s = s,
        .length = length,
        .longest = RC_PI / (2 * fmax(unit->dx * (double)unit->nx, unit->dy * (double)unit->ny))};
    RC_OWNED double *values = NULL;
    size_t columns;

    rc_fft_waves(s->fft, &columns, &b.n);
    rc_fft_columns(s->fft, &b.first, &columns);
    b.kernel = values = rc_alloc(columns * b.n, sizeof *values);
    if (rc_ranks_need(s->op.rows.ranks, values != NULL, err,
                      "out of memory for the inverse of a layered body") != RC_OK ||
        rc_spectrum_set_by(s->kernel, s->fft, kernel, boundary, keep_column, &b, err) != RC_OK)
        return RC_FAIL;
    b.positive = all_positive(&b, columns) && stiffening(s->bodies, &s->op.whole) <= 1;
    return (s->inverse = rc_spectrum_new(s->fft, err)) != NULL
               ? rc_spectrum_set_by(s->inverse, s->fft, &rc_kernel_of_one, boundary, invert_column,
                                    &b, err)
               : RC_FAIL;
}

static enum rc_status
set_spectra(struct own *s, const struct rc_shape *unit, double length, struct rc_err *err)
{
    const struct rc_surface surface = {s->bodies, length, s->estar};
    const struct rc_kernel kernel = rc_surface_kernel(&surface);

    if ((s->kernel = rc_spectrum_new(s->fft, err)) == NULL)
        return RC_FAIL;
    if (!s->positive && rc_has_mean(s->op.boundary))
        return set_bounded(s, unit, &kernel, length, err);
    if (rc_spectrum_set(s->kernel, s->fft, &kernel, err) != RC_OK)
        return RC_FAIL;
    s->inverse = rc_spectrum_new_reciprocal(s->fft, s->kernel, err);
    return s->inverse == NULL ? RC_FAIL : RC_OK;
}

static struct own *
own_new(const struct rc_ranks *ranks, struct rc_err *err)
{
    RC_OWNED struct own *s = calloc(1, sizeof *s);

    return rc_ranks_need(ranks, s != NULL, err, "out of memory for a plan") == RC_OK ? rc_give(&s)
                                                                                     : NULL;
}

/* Sets everything but the bodies and K p in double precision, which exist. */
static enum rc_status
plan(struct own *s, const struct rc_shape *shape, const struct rc_operator_options *o,
     struct rc_err *err)
{
    const struct rc_shape unit = unit_of(shape);
    double length = sqrt(shape->dx) * sqrt(shape->dy);
    struct rc_boundary boundary;
    struct rc_fft *lender = s->conv == NULL ? NULL : rc_conv_fft(s->conv);

    s->estar = rc_solids_modulus(s->bodies, RC_PI / length);
    s->op = (struct rc_operator){.whole = *shape,
                                 .rows = rc_rows_of(o->ranks, shape),
                                 .boundary = rc_boundary_on(shape, o->boundary),
                                 .threads = o->threads,
                                 .unit = length / s->estar,
                                 .row_error = 2e-7, /* 1e-5 for |u| of 50, at 1024 x 1024 */
                                 .row_cost = 0.5,
                                 .factor_cost = 0.5,
                                 .bends = stiffening(s->bodies, shape) > 1.1,
                                 .edges = !s->positive && rc_has_mean(o->boundary),
                                 .mean_free = !rc_has_mean(o->boundary)};
    s->op.shape = rc_rows_shape(&s->op.rows, shape);
    s->op.estar = s->same;
    s->op.nearest = s->nearest;
    s->op.rise =
        s->far * (o->boundary.x ? shape->dy / (double)shape->nx : shape->dx / (double)shape->ny);
    s->op.norm = s->bare.norm = norm(s);
    s->op.diagonal = s->bare.diagonal = diagonal(s);
    boundary = unit_boundary(s->op.boundary, length);
    set_strip(s);
    set_inverse_near(s);
    set_neighbours(&s->op, &unit);
    s->op.frame = frame_around(shape, o->boundary, s->bends);
    if (s->op.frame.x + s->op.frame.y > 0) {
        s->framed = rc_fft_new_framed(o->ranks, lender, &unit, boundary, &s->op.frame, RC_SINGLE,
                                      o->threads, err);
        if (s->framed == NULL)
            return RC_FAIL;
    }
    s->fft = rc_fft_new(o->ranks, lender == NULL ? s->framed : lender, &unit, boundary, RC_SINGLE,
                        o->threads, err);
    if (s->fft == NULL || set_spectra(s, &unit, length, err) != RC_OK)
        return RC_FAIL;
    s->op.kernel = s->kernel;
    s->op.inverse = s->inverse;
    return RC_OK;
}

static enum rc_status
make_rows(struct own *s, struct rc_err *err)
{
    s->row_threads = rc_useful_threads(&s->op.shape, s->op.threads);
    if (s->row == NULL)
        s->row = rc_store_take(&s->memory, (size_t)s->row_threads * s->op.shape.nx, sizeof *s->row);
    return s->row != NULL ? RC_OK : rc_err_set(err, "out of memory for rows of displacements");
}

/* Allocates the maps and rows for an engine that must not be mixed with single precision. */
static enum rc_status
make_room(struct own *s, const struct rc_operator_options *o, struct rc_err *err)
{
    const size_t n = s->op.shape.nx * s->op.rows.n;

    s->p = rc_store_take(&s->memory, n, sizeof *s->p);
    s->u = rc_store_take(&s->memory, n, sizeof *s->u);
    return rc_ranks_need(o->ranks, make_rows(s, NULL) == RC_OK && !s->memory.failed, err,
                         "out of memory for the displacements of %zu nodes", n);
}

static double
symbol_along(const struct rc_kernel *kernel, bool x, double q)
{
    return kernel->symbol(kernel->of, x ? q : 0, x ? 0 : q);
}

/* A line load of 1 N/m displaces by -2 ln(x / datum) / (pi E*) far away, where E* is that of the
 * longest waves; on a rigid base the displacement has a limit, and no datum matters. On uniform bodies
 * and with the length L of the map as datum, the sum of K over the padded map is twice that of its
 * longest wave. Under a stiff coat that is thicker than the map it is negative, and large beside all
 * waves. The datum of K is then so much larger that the sum is that of the longest wave. `far`: what
 * the datum of the problem adds. A load on a rigid strip as wide as the map does not move it if the
 * datum is L/4; on other bodies the nearest datum is the one with the same ratio of the two sums. */
static enum rc_status
set_datum(struct own *s, const struct rc_shape *shape, double datum, struct rc_boundary *boundary,
          struct rc_err *err)
{
    const struct rc_surface surface = {s->bodies, 1, 1};
    const struct rc_kernel kernel = rc_surface_kernel(&surface);
    const bool x = !boundary->x; /* the free axis */
    const size_t n = x ? shape->nx : shape->ny;
    const double d = x ? shape->dx : shape->dy, length = (double)n * d, q = 1e-20 / length;
    const double slope = q / RC_PI * symbol_along(&kernel, x, q);
    const double wave = symbol_along(&kernel, x, RC_PI / length);
    const struct rc_line_at at = {d, 1, n + 1, 0, length};
    RC_OWNED double *u = NULL;
    double sum;

    boundary->datum = length;
    s->nearest = length / 4;
    s->far = slope * log((datum > 0 ? datum : length) / length);
    if (!isnan(s->same))
        return RC_OK;
    if (symbol_along(&kernel, x, 2 * q) > 0.75 * symbol_along(&kernel, x, q)) { /* a rigid base */
        s->nearest = s->far = 0;
        return RC_OK;
    }
    if ((u = rc_alloc(at.n, sizeof *u)) == NULL)
        return rc_err_set(err, "out of memory for a line of %zu nodes", n);
    if (rc_kernel_line(&kernel, x, &at, u, err) != RC_OK)
        return RC_FAIL;
    sum = 2 * rc_sum(u, n) - u[0] + u[n];
    boundary->datum *= exp(fmax(wave - sum, 0) / (2 * slope * length));
    s->nearest = length * exp((2 * (1 - log(4)) * wave - sum) / (2 * slope * length));
    s->far = slope * log((datum > 0 ? datum : length) / boundary->datum);
    return RC_OK;
}

struct rc_operator *
rc_operator_new(const struct rc_shape *shape, const struct rc_operator_options *o,
                struct rc_err *err)
{
    struct rc_operator_options own = *o;
    RC_OWN(rc_operator, op) = NULL;
    struct rc_conv_options options;
    struct own *s;

    if (rc_shape_check(shape, err) != RC_OK || (s = own_new(o->ranks, err)) == NULL)
        return NULL;
    op = &s->op;
    s->bodies = &s->own;
    s->positive = rc_pair_positive(o->pair);
    s->bends = bending_length(shape, o->pair);
    s->same = rc_pair_modulus(o->pair);
    if (rc_solids_new(&s->own, o->pair, o->along, o->ranks, err) != RC_OK)
        return NULL;
    if (rc_repeats(o->boundary) == 1 &&
        rc_ranks_agree(o->ranks, set_datum(s, shape, o->boundary.datum, &own.boundary, err), err) !=
            RC_OK)
        return NULL;
    options = conv_options(&own);
    if ((s->conv = rc_conv_new_of(s->bodies, shape, &options, err)) == NULL ||
        plan(s, shape, &own, err) != RC_OK)
        return NULL;
    op->exact = true;
    op->error = rc_conv_error(s->conv);
    op->engine = rc_conv_engine(s->conv);
    op->reason = rc_conv_reason(s->conv);
    if (rc_conv_mixed(s->conv))
        return rc_give(&op);
    op->row_cost = 1;
    return make_room(s, o, err) == RC_OK ? rc_give(&op) : NULL;
}

struct rc_operator *
rc_operator_coarse(const struct rc_operator *op, const struct rc_ranks *ranks,
                   const struct rc_shape *shape, struct rc_err *err)
{
    const struct own *fine = (const struct own *)op;
    struct rc_operator_options o = {
        .boundary = op->boundary, .threads = op->threads, .ranks = ranks};
    struct own *s = own_new(ranks, err);
    RC_OWN(rc_operator, coarse) = s == NULL ? NULL : &s->op;

    if (s == NULL)
        return NULL;
    s->bodies = fine->bodies;
    s->positive = fine->positive;
    s->bends = fine->bends;
    s->same = fine->same;
    s->far = fine->far;
    s->nearest = fine->nearest;
    if (plan(s, shape, &o, err) != RC_OK)
        return NULL;
    return (op->soft.plus == 0 && op->soft.row == 0) ||
                   rc_operator_set_diagonal(coarse, op->soft.plus, NULL, op->soft.row, err) == RC_OK
               ? rc_give(&coarse)
               : NULL;
}

enum rc_status
rc_operator_check(const struct rc_shape *shape, const struct rc_operator_options *o,
                  struct rc_err *err)
{
    struct rc_conv_options options = conv_options(o);

    return rc_conv_check(shape, &options, err);
}

const char *
rc_operator_engine(const struct rc_shape *shape, const struct rc_operator_options *o,
                   const char **reason)
{
    struct rc_conv_options options = conv_options(o);

    return rc_conv_choice(shape, &options, reason);
}

double
rc_operator_seconds(const struct rc_shape *shape, const struct rc_operator_options *o)
{
    struct rc_conv_options options = conv_options(o);

    return rc_conv_seconds(shape, &options);
}

/* ---- the diagonal term ---- */

void
rc_operator_own_range(const struct rc_operator *op, double *lowest, double *highest)
{
    const size_t n = op->soft.part == NULL ? 0 : op->shape.nx * op->shape.ny;
    double low = op->soft.part == NULL ? op->soft.plus : INFINITY,
           high = op->soft.part == NULL ? op->soft.plus : 0;

    for (size_t k = 0; k < n; k++) {
        low = fmin(low, rc_operator_own(op, k));
        high = fmax(high, rc_operator_own(op, k));
    }
    *highest = rc_ranks_most(op->rows.ranks, high);
    *lowest = -rc_ranks_most(op->rows.ranks, -low);
}

enum rc_status
rc_operator_set_diagonal(struct rc_operator *op, double plus, const double *part, double row,
                         struct rc_err *err)
{
    struct own *s = (struct own *)op;
    double lowest, highest;

    op->soft.plus = op->soft.own = plus;
    op->soft.part = plus > 0 ? part : NULL;
    if (op->soft.part != NULL && make_rows(s, err) != RC_OK)
        return RC_FAIL;
    op->soft.row = row;
    free(op->soft.sunk);
    op->soft.sunk = row > 0 ? rc_alloc(op->shape.ny, sizeof *op->soft.sunk) : NULL;
    if (row > 0 && op->soft.sunk == NULL)
        return rc_err_set(err, "out of memory for the motion of %zu rows", op->shape.ny);
    rc_operator_own_range(op, &lowest, &highest);
    if (op->soft.part != NULL)
        op->soft.plus =
            sqrt(fmax(lowest, RC_LEAST_OWN * op->unit) * fmax(highest, RC_LEAST_OWN * op->unit));
    op->norm = s->bare.norm + highest + row * op->shape.dx * (double)op->shape.nx;
    op->diagonal = s->bare.diagonal + op->soft.plus + row * op->shape.dx;
    op->mean_free = !rc_has_mean(op->boundary) && plus == 0 && row == 0;
    op->edges = plus > 0 || row > 0 || (rc_has_mean(op->boundary) && !s->positive);
    rc_spectrum_add(s->kernel, s->fft, false, op->soft.part == NULL ? plus / op->unit : 0,
                    row * op->shape.dx / op->unit);
    rc_operator_set_inverse(op, op->soft.plus);
    set_inverse_near(s);
    return RC_OK;
}

void
rc_operator_set_inverse(struct rc_operator *op, double plus)
{
    struct own *s = (struct own *)op;

    rc_spectrum_add(s->inverse, s->fft, true, plus / op->unit,
                    op->soft.row * op->shape.dx / op->unit);
}

/* ---- use ---- */

void
rc_operator_sink(struct rc_operator *op, const double *p)
{
    for (size_t j = 0; j < op->shape.ny && op->soft.sunk != NULL; j++)
        op->soft.sunk[j] = op->soft.row * op->shape.dx * rc_sum(p + j * op->shape.nx, op->shape.nx);
}

void
rc_operator_apply(struct rc_operator *op, const double *p, double *u)
{
    struct own *s = (struct own *)op;
    const size_t n = op->shape.nx * op->shape.ny;

    rc_conv_apply(s->conv, p, u);
    if (op->soft.plus == 0 && op->soft.row == 0)
        return;
    rc_operator_sink(op, p);
#pragma omp parallel for num_threads(rc_useful_threads(&op->shape, op->threads)) schedule(static)
    for (size_t k = 0; k < n; k++)
        u[k] += rc_operator_own_motion(op, k, p[k]);
}

/* Gathers rows into a map, sums, and passes the rows of the result. */
static void
apply_by_map(struct own *s, rc_row *in, rc_row *out, void *ctx)
{
    size_t nx = s->op.shape.nx, ny = s->op.shape.ny;

#pragma omp parallel for num_threads(s->row_threads) schedule(static)
    for (size_t j = 0; j < ny; j++) {
        float *row = s->row + (size_t)omp_get_thread_num() * nx;
        bool any = in(ctx, j, row);
        for (size_t i = 0; i < nx; i++)
            s->p[j * nx + i] = any ? (double)row[i] : 0;
    }
    rc_operator_apply(&s->op, s->p, s->u);
#pragma omp parallel for num_threads(s->row_threads) schedule(static)
    for (size_t j = 0; j < ny; j++) {
        float *row = s->row + (size_t)omp_get_thread_num() * nx;
        for (size_t i = 0; i < nx; i++)
            row[i] = (float)(s->u[j * nx + i] / s->op.unit);
        out(ctx, j, row);
    }
}

/* A diagonal that differs by node: `in` writes each row of p a second time, beside that of K p. */
struct beside {
    struct own *s;
    rc_row *in, *out;
    void *ctx;
};

static bool
row_in(void *at, size_t j, void *row)
{
    const struct beside *b = at;

    return b->in(b->ctx, j, row);
}

static bool
row_out(void *at, size_t j, void *row)
{
    const struct beside *b = at;
    const struct rc_operator *op = &b->s->op;
    const size_t nx = op->shape.nx;
    const float *u = row, unit = (float)op->unit;
    float *own = b->s->row + (size_t)omp_get_thread_num() * nx;
    const bool any = b->in(b->ctx, j, own);

    for (size_t i = 0; i < nx; i++)
        own[i] = u[i] + (any ? (float)rc_operator_own(op, j * nx + i) / unit * own[i] : 0);
    return b->out(b->ctx, j, own);
}

void
rc_operator_apply_rows(struct rc_operator *op, rc_row *in, rc_row *out, void *ctx)
{
    struct own *s = (struct own *)op;
    const struct rc_spectrum *factors[] = {s->kernel};
    struct beside beside = {s, in, out, ctx};
    const bool by_node = op->soft.part != NULL;
    rc_row *rows[] = {by_node ? row_in : in, by_node ? row_out : out};

    if (s->p != NULL)
        apply_by_map(s, in, out, ctx);
    else
        rc_fft_chain(s->fft, 1, factors, rows, by_node ? (void *)&beside : ctx);
}

void
rc_operator_chain(struct rc_operator *op, size_t n, const struct rc_spectrum *const *factors,
                  rc_row *const *rows, void *ctx)
{
    rc_fft_chain(((struct own *)op)->fft, n, factors, rows, ctx);
}

void
rc_operator_chain_framed(struct rc_operator *op, size_t n, const struct rc_spectrum *const *factors,
                         rc_row *const *rows, void *ctx)
{
    struct own *s = (struct own *)op;

    rc_fft_chain(s->framed == NULL ? s->fft : s->framed, n, factors, rows, ctx);
}

/* The power on a plane: 1 plus that of the stiffness of the bodies. */
static double
of_plane(const struct own *s, double q)
{
    const double step =
        1.05; /* of a central difference, whose error is of second order in log(step) */
    double below = rc_solids_modulus(s->bodies, q / step);
    double above = rc_solids_modulus(s->bodies, q * step);

    return 1 + log(above / below) / (2 * log(step));
}

double
rc_operator_power(const struct rc_operator *op, double q)
{
    const struct own *s = (const struct own *)op;
    double a, inverse; /* A = 1/K(q), Pa/m */

    q /= sqrt(op->whole.dx) * sqrt(op->whole.dy);
    if (is_along_strip(s, q)) {
        a = 1 / (rc_solids_modulus(s->bodies, q) * strip_sum(s, q));
        inverse = RC_PI / (2 * s->strip.width * strip_sum(s, q));
    } else {
        a = of_plane(s, q);
        inverse = rc_solids_modulus(s->bodies, q) * q / 2;
    }
    return a / (1 + op->soft.plus * inverse);
}
