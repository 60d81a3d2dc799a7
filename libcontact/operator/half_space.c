/*
 * The operator of an elastic half-space, bare or coated: K p by an engine in double precision, and row
 * by row in single precision by transforms, which serve the preconditioner too. Where the engine is not
 * to be mixed with single precision, rows are gathered and summed by it.
 */
#include "operator.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

static const double pi = 3.14159265358979323846;

struct half_space {
    struct rc_operator op;
    double estar;           /* of one material, or what it would have to be in the roughness      */
    struct rc_stack *stack; /* of the coating; NULL: one material                                 */
    bool shared;            /* the stack is that of a finer grid                                  */
    struct rc_conv *conv;   /* K p in double precision, or NULL                        */
    struct rc_fft *fft;     /* in single precision, on the grid in units of sqrt(dx dy) */
    struct rc_spectrum *kernel, *inverse;
    double *p, *u; /* maps and, for each thread, a row: for engines without   */
    float *row;    /* single precision; else NULL                             */
    int row_threads;
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

/* g(q) in 1/Pa: of one material 1/E* for every wave. */
static double
response(const struct half_space *s, double q)
{
    return s->stack == NULL ? 1 / s->estar : rc_stack_response(s->stack, q);
}

/* The largest of g over all waves, near enough: it is smooth in ln q. */
static double
largest_response(const struct half_space *s)
{
    double most = response(s, 0);

    for (size_t k = 0; s->stack != NULL && k < s->stack->layers; k++)
        for (int j = -20; j <= 20; j++)
            most = fmax(most, response(s, exp(0.5 * j) / s->stack->material[k].thickness));
    return most;
}

/* On the free boundary the largest row sum of K: what a uniform pressure does in the middle of a
 * rectangle a x b, 2 (a asinh(b/a) + b asinh(a/b)) / (pi E*) (Love 1929; Johnson 1985, eq.
 * 3.25). On a periodic map the eigenvalues are known, and the longest wave has the largest, 2 /
 * (E* q), q = 2 pi / L. A coated body is nowhere more compliant than one of its largest g. */
static double
norm(const struct half_space *s)
{
    const struct rc_shape *shape = &s->op.whole;
    double a = shape->dx * (double)shape->nx, b = shape->dy * (double)shape->ny;
    double most = largest_response(s);

    if (s->op.boundary == RC_PERIODIC)
        return most * fmax(a, b) / pi;
    return most * 2 * (a * asinh(b / a) + b * asinh(a / b)) / pi;
}

static const struct rc_kernel *
kernel_of(const struct half_space *s)
{
    return s->stack == NULL ? &rc_kernel_boussinesq : &rc_kernel_layered;
}

static double
diagonal(const struct half_space *s)
{
    struct rc_medium medium = {.estar = s->estar, .stack = s->stack, .length = 1, .modulus = 1};
    struct rc_lattice cell = {s->op.whole.dx, s->op.whole.dy, 1, 1};
    double self;

    kernel_of(s)->rows(&medium, 0, &cell, 1, 0, 1, &self);
    return self;
}

/* The mean of |q| / 2, over g E*, times cos(i qx dx) cos(j qy dy) over the wave numbers of the grid,
 * |qx| <= pi/dx and |qy| <= pi/dy, lengths in units of sqrt(dx dy). Without cosines and coating it is
 * half the mean distance of a rectangle's points from its middle; else a sum over the middles of cells. */
static void
set_inverse_near(struct half_space *s, const struct rc_shape *unit, double length)
{
    enum {
        CELLS = 64
    };
    double a = pi / unit->dx, b = pi / unit->dy, d = hypot(a, b), sum[2][2] = {{0}};

    for (int l = 0; l < CELLS; l++)
        for (int k = 0; k < CELLS; k++) {
            double x = (k + 0.5) / CELLS, y = (l + 0.5) / CELLS, q = hypot(a * x, b * y);
            double w = q / (2 * s->estar * response(s, q / length)) / (CELLS * CELLS);
            sum[0][0] += w;
            sum[0][1] += w * cos(pi * x);
            sum[1][0] += w * cos(pi * y);
            sum[1][1] += w * cos(pi * x) * cos(pi * y);
        }
    if (s->stack == NULL)
        sum[0][0] = (2 * d + a * a / b * asinh(b / a) + b * b / a * asinh(a / b)) / 12;
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++)
            s->op.inverse_near[j][i] = sum[j != 1][i != 1];
}

/* The inverse, (-Laplace)^(1/2) E* / 2, ties two nodes the stronger the nearer they are: as
 * |x|^(-3). */
static void
set_neighbours(struct rc_operator *op, const struct rc_shape *unit)
{
    for (int b = -1; b <= 1; b++)
        for (int a = -1; a <= 1; a++) {
            double r = hypot(a * unit->dx, b * unit->dy);
            op->neighbour[b + 1][a + 1] = r > 0 ? 1 / (r * r * r) : 0;
        }
}

/* How fast the preconditioner's extension fades: 0.5 on one material; the slower, the softer the body is to
 * the longest waves against the shortest. Found by trial on coats from 0.01 to 100 times as stiff as
 * what they lie on. */
static double
extension(const struct half_space *s, double length)
{
    const struct rc_shape *shape = &s->op.whole;
    double side = fmin(shape->dx * (double)shape->nx, shape->dy * (double)shape->ny);

    if (s->stack == NULL)
        return 0.5;
    return fmin(fmax(0.5 * sqrt(response(s, pi / length) / response(s, 2 * pi / side)), 0.02), 4);
}

static struct rc_shape
unit_of(const struct rc_shape *s)
{
    double unit = sqrt(s->dx) * sqrt(s->dy);

    return (struct rc_shape){s->nx, s->ny, s->dx / unit, s->dy / unit};
}

/* ---- plan ---- */

static const struct rc_operator_type half_space;

static void
half_space_free(struct rc_operator *op)
{
    struct half_space *s = (struct half_space *)op;

    rc_fft_free(s->fft); /* works in memory of conv */
    rc_conv_free(s->conv);
    rc_spectrum_free(s->kernel);
    rc_spectrum_free(s->inverse);
    if (!s->shared)
        rc_stack_free(s->stack);
    free(s->p);
    free(s->u);
    free(s->row);
    free(s);
}

/* ---- the inverse ---- */

/* A stack's padded kernel may have a spectrum that is negative somewhere, on stiff coats that bend over
 * lengths near that of the map. Its inverse is kept within these bounds of that of a half-space, wave by
 * wave with the stiffness of the stack. */
static const double least = 0.7, most = 1.5;

struct bounded {
    const struct half_space *s;
    size_t first, n; /* first: of the columns held here              */
    double length, longest;
    double *kernel; /* spectrum of the kernel, column by column */
};

static void
keep_column(void *ctx, size_t i, size_t n, double *column)
{
    struct bounded *b = ctx;

    memcpy(b->kernel + (i - b->first) * n, column, n * sizeof *column);
}

/* The column of the spectrum of a half-space of E* = 1 becomes that of the inverse. */
static void
invert_column(void *ctx, size_t i, size_t n, double *column)
{
    const struct bounded *b = ctx;
    double qx = rc_fft_qx(b->s->fft, i);

    for (size_t j = 0; j < n; j++) {
        double q = fmax(hypot(qx, rc_fft_qy(b->s->fft, j)), b->longest) / b->length, q2 = q * q, g,
               near;
        rc_stack_responses(b->s->stack, 1, &q2, &g);
        near = column[j] * b->s->estar * g;
        column[j] = 1 / fmin(fmax(b->kernel[(i - b->first) * n + j], least * near), most * near);
    }
}

static enum rc_status
set_bounded(struct half_space *s, const struct rc_shape *unit, const struct rc_medium *medium,
            double length, struct rc_err *err)
{
    struct rc_medium bare = {.estar = 1};
    struct bounded b = {
        .s = s,
        .length = length,
        .longest = pi / (2 * fmax(unit->dx * (double)unit->nx, unit->dy * (double)unit->ny))};
    size_t columns;
    enum rc_status status;

    rc_fft_waves(s->fft, &columns, &b.n);
    rc_fft_columns(s->fft, &b.first, &columns);
    status = (b.kernel = rc_alloc(columns * b.n, sizeof *b.kernel)) == NULL ? RC_FAIL : RC_OK;
    if (status != RC_OK)
        rc_err_set(err, "out of memory for the inverse of a coated body");
    if (rc_ranks_agree(s->op.rows.ranks, status, err) != RC_OK) {
        free(b.kernel);
        return RC_FAIL;
    }
    status = rc_spectrum_set_by(s->kernel, s->fft, kernel_of(s), 0, medium, keep_column, &b, err);
    if (status == RC_OK && (s->inverse = rc_spectrum_new(s->fft, err)) != NULL)
        status = rc_spectrum_set_by(s->inverse, s->fft, &rc_kernel_boussinesq, 0, &bare,
                                    invert_column, &b, err);
    else
        status = RC_FAIL;
    free(b.kernel);
    return status;
}

static enum rc_status
set_spectra(struct half_space *s, const struct rc_shape *unit, double length, struct rc_err *err)
{
    struct rc_medium medium = {
        .estar = 1, .stack = s->stack, .length = length, .modulus = s->estar};

    if ((s->kernel = rc_spectrum_new(s->fft, err)) == NULL)
        return RC_FAIL;
    if (s->stack != NULL && s->op.boundary == RC_FREE)
        return set_bounded(s, unit, &medium, length, err);
    if (rc_spectrum_set(s->kernel, s->fft, kernel_of(s), 0, &medium, err) != RC_OK)
        return RC_FAIL;
    s->inverse = rc_spectrum_new_reciprocal(s->fft, s->kernel, err);
    return s->inverse == NULL ? RC_FAIL : RC_OK;
}

/* Takes conv, K p in double precision, or NULL, and, unless it is shared, the stack. */
static struct half_space *
half_space_new(const struct rc_shape *shape, const struct rc_operator_options *o,
               struct rc_stack *stack, double estar, bool shared, struct rc_conv *conv,
               struct rc_err *err)
{
    const struct rc_shape unit = unit_of(shape);
    double length = sqrt(shape->dx) * sqrt(shape->dy);
    struct half_space *s = calloc(1, sizeof *s);

    if (s == NULL)
        rc_err_set(err, "out of memory for a plan");
    if (rc_ranks_agree(o->ranks, s == NULL ? RC_FAIL : RC_OK, err) != RC_OK) {
        rc_conv_free(conv);
        if (!shared)
            rc_stack_free(stack);
        free(s);
        return NULL;
    }
    s->conv = conv;
    s->stack = stack;
    s->shared = shared;
    s->estar = stack == NULL ? estar : 1 / rc_stack_response(stack, pi / length);
    s->op = (struct rc_operator){.type = &half_space,
                                 .whole = *shape,
                                 .rows = rc_rows_of(o->ranks, shape),
                                 .boundary = o->boundary,
                                 .threads = o->threads,
                                 .unit = length / s->estar,
                                 .row_error = 2e-7, /* 1e-5 for |u| of 50, at 1024 x 1024 */
                                 .row_cost = 0.5,
                                 .factor_cost = 0.5,
                                 .mean_free = o->boundary == RC_PERIODIC};
    s->op.shape = rc_rows_shape(&s->op.rows, shape);
    s->op.norm = norm(s);
    s->op.diagonal = diagonal(s);
    s->op.extension = extension(s, length);
    set_inverse_near(s, &unit, length);
    set_neighbours(&s->op, &unit);
    s->fft = rc_fft_new_on(o->ranks, conv == NULL ? NULL : rc_conv_fft(conv), &unit, o->boundary,
                           RC_SINGLE, o->threads, err);
    if (s->fft == NULL || set_spectra(s, &unit, length, err) != RC_OK) {
        half_space_free(&s->op);
        return NULL;
    }
    s->op.kernel = s->kernel;
    s->op.inverse = s->inverse;
    return s;
}

struct rc_operator *
rc_half_space_new(const struct rc_shape *shape, const struct rc_operator_options *o,
                  struct rc_err *err)
{
    struct rc_conv_options options = conv_options(o);
    size_t n; /* nodes held here */
    enum rc_status status;
    double estar = rc_pair_estar(o->pair);
    struct rc_stack *stack;
    struct rc_conv *conv;
    struct half_space *s;

    if (rc_shape_check(shape, err) != RC_OK)
        return NULL;
    status = rc_stack_of(o->pair, &stack, err);
    if (rc_ranks_agree(o->ranks, status, err) != RC_OK) {
        rc_stack_free(stack);
        return NULL;
    }
    if ((conv = rc_conv_new_on(stack, estar, shape, &options, err)) == NULL) {
        rc_stack_free(stack);
        return NULL;
    }
    if ((s = half_space_new(shape, o, stack, estar, false, conv, err)) == NULL)
        return NULL;
    s->op.exact = true;
    s->op.error = rc_conv_error(s->conv);
    s->op.engine = rc_conv_engine(s->conv);
    s->op.reason = rc_conv_reason(s->conv);
    if (rc_conv_mixed(s->conv))
        return &s->op;
    s->op.row_cost = 1;
    n = shape->nx * s->op.rows.n;
    s->row_threads = rc_useful_threads(&s->op.shape, o->threads);
    s->p = rc_alloc(n, sizeof *s->p);
    s->u = rc_alloc(n, sizeof *s->u);
    s->row = rc_alloc((size_t)s->row_threads * shape->nx, sizeof *s->row);
    if (s->p == NULL || s->u == NULL || s->row == NULL)
        rc_err_set(err, "out of memory for the displacements of %zu nodes", n);
    if (rc_ranks_agree(o->ranks, s->p == NULL || s->u == NULL || s->row == NULL ? RC_FAIL : RC_OK,
                       err) != RC_OK) {
        half_space_free(&s->op);
        return NULL;
    }
    return &s->op;
}

static struct rc_operator *
coarse(const struct rc_operator *op, const struct rc_ranks *ranks, const struct rc_shape *shape,
       struct rc_err *err)
{
    const struct half_space *fine = (const struct half_space *)op;
    struct rc_operator_options o = {
        .boundary = op->boundary, .threads = op->threads, .ranks = ranks};
    struct half_space *s = half_space_new(shape, &o, fine->stack, fine->estar, true, NULL, err);

    return s == NULL ? NULL : &s->op;
}

size_t
rc_half_space_memory(const struct rc_shape *shape, const struct rc_operator_options *o)
{
    struct rc_conv_options options = conv_options(o);
    const char *reason;
    const struct rc_engine *engine;
    size_t conv = rc_conv_memory(shape, &options), own;
    bool precise, bounded = o->pair->one.layers > 0 && o->boundary == RC_FREE;
    size_t ranks = rc_ranks_count(o->ranks), rows;

    if (conv == 0)
        return 0;
    engine = rc_engine_named(rc_conv_choice(shape, &options, &reason), &precise);
    own = rc_spectrum_memory(shape, o->boundary, RC_SINGLE, ranks) * (bounded ? 2 : 1) +
          rc_fft_scratch(shape, o->boundary, RC_SINGLE, o->threads);
    if (engine->fft == NULL) /* else rows are transformed in the memory of conv */
        own += rc_fft_memory(shape, o->boundary, RC_SINGLE, ranks) -
               rc_spectrum_memory(shape, o->boundary, RC_SINGLE, ranks);
    rows = ranks > 1 ? rc_rows_most(shape, ranks) : shape->ny;
    if (!engine->info.mixed || precise)
        own += 2 * shape->nx * rows * sizeof(double);
    return own + conv;
}

enum rc_status
rc_half_space_check(const struct rc_shape *shape, const struct rc_operator_options *o,
                    struct rc_err *err)
{
    struct rc_conv_options options = conv_options(o);

    return rc_conv_check(shape, &options, err);
}

const char *
rc_half_space_engine(const struct rc_shape *shape, const struct rc_operator_options *o,
                     const char **reason)
{
    struct rc_conv_options options = conv_options(o);

    return rc_conv_choice(shape, &options, reason);
}

double
rc_half_space_seconds(const struct rc_shape *shape, const struct rc_operator_options *o)
{
    struct rc_conv_options options = conv_options(o);

    return rc_conv_seconds(shape, &options);
}

/* ---- use ---- */

static void
apply(struct rc_operator *op, const double *p, double *u)
{
    rc_conv_apply(((struct half_space *)op)->conv, p, u);
}

/* Rows are gathered into a map, summed, and handed out again. */
static void
apply_by_map(struct half_space *s, rc_row *in, rc_row *out, void *ctx)
{
    size_t nx = s->op.shape.nx, ny = s->op.shape.ny;

#pragma omp parallel for num_threads(s->row_threads) schedule(static)
    for (size_t j = 0; j < ny; j++) {
        float *row = s->row + (size_t)omp_get_thread_num() * nx;
        bool any = in(ctx, j, row);
        for (size_t i = 0; i < nx; i++)
            s->p[j * nx + i] = any ? (double)row[i] : 0;
    }
    rc_conv_apply(s->conv, s->p, s->u);
#pragma omp parallel for num_threads(s->row_threads) schedule(static)
    for (size_t j = 0; j < ny; j++) {
        float *row = s->row + (size_t)omp_get_thread_num() * nx;
        for (size_t i = 0; i < nx; i++)
            row[i] = (float)(s->u[j * nx + i] / s->op.unit);
        out(ctx, j, row);
    }
}

static void
apply_rows(struct rc_operator *op, rc_row *in, rc_row *out, void *ctx)
{
    struct half_space *s = (struct half_space *)op;
    const struct rc_spectrum *factors[] = {s->kernel};
    rc_row *rows[] = {in, out};

    if (s->p != NULL)
        apply_by_map(s, in, out, ctx);
    else
        rc_fft_chain(s->fft, 1, factors, rows, ctx);
}

static void
chain(struct rc_operator *op, size_t n, const struct rc_spectrum *const *factors,
      rc_row *const *rows, void *ctx)
{
    rc_fft_chain(((struct half_space *)op)->fft, n, factors, rows, ctx);
}

static struct rc_spectrum *
spectrum(struct rc_operator *op, const struct rc_kernel *values, struct rc_err *err)
{
    const struct half_space *s = (const struct half_space *)op;
    struct rc_medium none = {0};
    struct rc_spectrum *k = rc_spectrum_new(s->fft, err);

    if (k != NULL && rc_spectrum_set_values(k, s->fft, values, 0, &none, err) != RC_OK) {
        rc_spectrum_free(k);
        return NULL;
    }
    return k;
}

static const struct rc_operator_type half_space = {
    .apply = apply,
    .apply_rows = apply_rows,
    .chain = chain,
    .spectrum = spectrum,
    .coarse = coarse,
    .free = half_space_free,
};
