/*
 * The tangential operator by Fourier transforms: a quarter of each kernel's spectrum, and the waves of
 * two maps.
 */
#include "tangential.h"

#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

/* ---- the spectra ---- */

struct keeper {
    double *to;
    size_t cy;
};

static void
keep_column(void *ctx, size_t i, size_t n, double *column)
{
    const struct keeper *k = ctx;

    memcpy(k->to + i * k->cy, column, n * sizeof *column);
}

static void
sample(const struct rc_tangential *t, const struct rc_kernel *kernel, double *to)
{
    size_t nx = t->shape.nx, ny = t->shape.ny;

#pragma omp parallel for num_threads(t->threads) schedule(static)
    for (size_t i = 0; i < t->columns; i++)
        for (size_t j = 0; j < t->cy; j++) {
            /* a wave of two nodes in a direction in which the kernel is odd is zero at all nodes */
            bool none = (i == 0 && j == 0) || (2 * i == nx && kernel->parity & RC_ODD_X) ||
                        (2 * j == ny && kernel->parity & RC_ODD_Y);
            to[i * t->cy + j] =
                none ? 0 : kernel->symbol(kernel->of, rc_fft_qx(t->fft, i), rc_fft_qy(t->fft, j));
        }
}

static enum rc_status
set_spectra(struct rc_tangential *t, struct rc_err *err)
{
    struct rc_spectrum *passing = NULL;

    if (t->boundary == RC_FREE && (passing = rc_spectrum_new(t->fft, err)) == NULL)
        return RC_FAIL;
    for (int k = 0; k < RC_SHEAR_KERNELS; k++) {
        const struct rc_shear_field field = {&t->shear, (enum rc_shear_which)k};
        const struct rc_kernel kernel = rc_shear_kernel(&field);
        struct keeper keeper = {t->quarter[k], t->cy};

        if (t->quarter[k] == NULL)
            continue;
        if (passing == NULL)
            sample(t, &kernel, t->quarter[k]);
        else if (rc_spectrum_set_by(passing, t->fft, &kernel, keep_column, &keeper, err) != RC_OK) {
            rc_spectrum_free(passing);
            return RC_FAIL;
        }
    }
    rc_spectrum_free(passing);
    return RC_OK;
}

/* A unit traction on a node: the mean of the spectrum over all waves. */
static void
set_self(struct rc_tangential *t)
{
    size_t nx = t->boundary == RC_FREE ? 2 * (t->columns - 1) : t->shape.nx;
    size_t ny = t->boundary == RC_FREE ? 2 * (t->cy - 1) : t->shape.ny;

    for (int k = 0; k < 2; k++) {
        double sum = 0;
        for (size_t i = 0; i < t->columns; i++) {
            double twice = i == 0 || 2 * i == nx ? 1 : 2;
            for (size_t j = 0; j < t->cy; j++)
                sum += twice * (j == 0 || 2 * j == ny ? 1 : 2) *
                       t->quarter[k == 0 ? RC_SHEAR_XX : RC_SHEAR_YY][i * t->cy + j];
        }
        t->self[k] = sum / ((double)nx * (double)ny);
    }
}

/* ---- plan ---- */

void
rc_tangential_free(struct rc_tangential *t)
{
    if (t == NULL)
        return;
    rc_fft_free(t->fft);
    for (int k = 0; k < RC_SHEAR_KERNELS; k++)
        free(t->quarter[k]);
    free(t->waves[0]);
    free(t->waves[1]);
    free(t->wave);
    free(t->mirror);
    free(t);
}

static bool
allocate(struct rc_tangential *t)
{
    size_t padded;

    rc_fft_waves(t->fft, &t->columns, &t->cy);
    t->length = padded = rc_fft_length(t->fft);
    for (int k = 0; k < RC_SHEAR_KERNELS; k++)
        if ((k < RC_SHEAR_XZ || t->shear.beta != 0) &&
            (t->quarter[k] = rc_alloc(t->columns * t->cy, sizeof(double))) == NULL)
            return false;
    for (int k = 0; k < 2; k++)
        if ((t->waves[k] = rc_alloc(2 * t->columns * t->length, sizeof(double))) == NULL)
            return false;
    t->wave = rc_alloc(t->length, sizeof *t->wave);
    t->mirror = rc_alloc(t->length, sizeof *t->mirror);
    if (t->wave == NULL || t->mirror == NULL)
        return false;
    for (size_t n = 0; n < t->length; n++) {
        size_t j = rc_fft_wave(t->fft, n);
        t->wave[n] = 2 * j <= padded ? j : padded - j;
        t->mirror[n] = 2 * j <= padded ? 1 : -1;
    }
    return true;
}

struct rc_tangential *
rc_tangential_new(const struct rc_shape *shape, enum rc_boundary boundary,
                  const struct rc_shear *shear, size_t threads, struct rc_err *err)
{
    struct rc_tangential *t = calloc(1, sizeof *t);

    if (t == NULL) {
        rc_err_set(err, "out of memory for a plan");
        return NULL;
    }
    t->shape = *shape;
    t->boundary = boundary;
    t->shear = *shear;
    t->threads = rc_useful_threads(shape, threads);
    t->fft = rc_fft_new(NULL, NULL, shape, boundary, RC_DOUBLE, threads, err);
    if (t->fft == NULL)
        goto fail;
    if (!allocate(t)) {
        rc_err_set(err, "out of memory for the shear of %zu x %zu nodes", shape->nx, shape->ny);
        goto fail;
    }
    if (set_spectra(t, err) != RC_OK)
        goto fail;
    set_self(t);
    return t;
fail:
    rc_tangential_free(t);
    return NULL;
}

size_t
rc_tangential_memory(const struct rc_shape *shape, enum rc_boundary boundary, bool coupled,
                     size_t threads)
{
    size_t quarter = rc_spectrum_memory(shape, boundary, RC_DOUBLE, 1);
    size_t py = boundary == RC_FREE ? rc_fourier_length(shape->ny, 4) : shape->ny;
    size_t columns = quarter / sizeof(double) / (py / 2 + 1);

    return rc_fft_memory(shape, boundary, RC_DOUBLE, 1) - quarter +
           rc_fft_scratch(shape, boundary, RC_DOUBLE, threads) + (coupled ? 5 : 3) * quarter +
           4 * columns * py * sizeof(double) + 2 * py * sizeof(double);
}

/* ---- rows ---- */

struct pass {
    struct rc_tangential *t;
    const double *from, *weight;
    double *to;
    bool add;
    int which;    /* of the two maps, or the only one */
    double shift; /* d */
};

static bool
row_in(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    size_t nx = p->t->shape.nx;
    const double *from = p->from + j * nx;
    double *to = row;

    if (!rc_any(from, nx))
        return false;
    if (p->weight == NULL)
        memcpy(to, from, nx * sizeof *to);
    else
        for (size_t i = 0; i < nx; i++)
            to[i] = p->weight[j * nx + i] * from[i];
    return true;
}

static bool
row_out(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    size_t nx = p->t->shape.nx, at = j * nx;
    const double *from = row;

    for (size_t i = 0; i < nx; i++) {
        double v = p->weight == NULL ? from[i] : p->weight[at + i] * from[i];
        p->to[at + i] = p->add ? p->to[at + i] + v : v;
    }
    return true;
}

/* ---- waves ---- */

/* A column of two maps, and what becomes of it: u = a X + b Y. b is what a kernel is that is odd in both directions:
 * its transform is (-i)^2 b. */
static void
mix(const struct rc_tangential *t, size_t i, const double *a, const double *b, int which,
    double *to)
{
    const double *x = t->waves[which] + 2 * i * t->length;
    const double *y = t->waves[1 - which] + 2 * i * t->length;
    size_t n = t->length;

    for (size_t k = 0; k < n; k++) {
        double straight = a[t->wave[k]], cross = -t->mirror[k] * b[t->wave[k]];
        to[k] = straight * x[k] + cross * y[k];
        to[n + k] = straight * x[n + k] + cross * y[n + k];
    }
}

static void
apply_column(void *ctx, size_t i, void *column)
{
    const struct pass *p = ctx;
    const struct rc_tangential *t = p->t;
    const double *a = t->quarter[p->which == 0 ? RC_SHEAR_XX : RC_SHEAR_YY];

    mix(t, i, a + i * t->cy, t->quarter[RC_SHEAR_XY] + i * t->cy, p->which, column);
}

static void
inverse_column(void *ctx, size_t i, void *column)
{
    const struct pass *p = ctx;
    const struct rc_tangential *t = p->t;
    const double *xx = t->quarter[RC_SHEAR_XX] + i * t->cy;
    const double *yy = t->quarter[RC_SHEAR_YY] + i * t->cy;
    const double *xy = t->quarter[RC_SHEAR_XY] + i * t->cy;
    const double *x = t->waves[0] + 2 * i * t->length, *y = t->waves[1] + 2 * i * t->length;
    double *to = column;
    size_t n = t->length;

    for (size_t k = 0; k < n; k++) {
        size_t w = t->wave[k];
        double a = xx[w] + p->shift, c = yy[w] + p->shift, b = -t->mirror[k] * xy[w];
        double det = a * c - b * b, over = det > 0 ? 1 / det : 0;
        double straight = (p->which == 0 ? c : a) * over, cross = -b * over;
        const double *own = p->which == 0 ? x : y, *other = p->which == 0 ? y : x;
        to[k] = straight * own[k] + cross * other[k];
        to[n + k] = straight * own[n + k] + cross * other[n + k];
    }
}

/* -i (x X + y Y) of both maps: to the normal direction. */
static void
normal_column(void *ctx, size_t i, void *column)
{
    const struct pass *p = ctx;
    const struct rc_tangential *t = p->t;
    const double *a = t->quarter[RC_SHEAR_XZ] + i * t->cy;
    const double *b = t->quarter[RC_SHEAR_YZ] + i * t->cy;
    const double *x = t->waves[0] + 2 * i * t->length, *y = t->waves[1] + 2 * i * t->length;
    double *to = column;
    size_t n = t->length;

    for (size_t k = 0; k < n; k++) {
        double ax = a[t->wave[k]], by = t->mirror[k] * b[t->wave[k]];
        to[k] = ax * x[n + k] + by * y[n + k];
        to[n + k] = -ax * x[k] - by * y[k];
    }
}

/* i x P: what a pressure does along the surface. */
static void
pressure_column(void *ctx, size_t i, void *column)
{
    const struct pass *p = ctx;
    const struct rc_tangential *t = p->t;
    const double *a = t->quarter[p->which == 0 ? RC_SHEAR_XZ : RC_SHEAR_YZ] + i * t->cy;
    const double *x = t->waves[0] + 2 * i * t->length;
    double *to = column;
    size_t n = t->length;

    for (size_t k = 0; k < n; k++) {
        double s = a[t->wave[k]] * (p->which == 0 ? 1 : t->mirror[k]);
        to[k] = -s * x[n + k];
        to[n + k] = s * x[k];
    }
}

static void
forward(struct rc_tangential *t, const double *map, const double *weight, int which)
{
    struct pass pass = {.t = t, .from = map, .weight = weight};

    rc_fft_forward(t->fft, row_in, &pass, t->waves[which], NULL);
    t->convolutions += 0.5;
}

static void
back(struct rc_tangential *t, rc_wave_column *column, struct pass pass)
{
    pass.t = t;
    rc_fft_back(t->fft, NULL, column, row_out, &pass);
    t->convolutions += 0.5;
}

/* ---- the face ---- */

void
rc_tangential_apply(struct rc_tangential *t, double *const q[2], double *const u[2])
{
    for (int k = 0; k < 2; k++)
        forward(t, q[k], NULL, k);
    for (int k = 0; k < 2; k++)
        back(t, apply_column, (struct pass){.to = u[k], .which = k});
}

void
rc_tangential_inverse(struct rc_tangential *t, double d, const double *weight, double *const u[2],
                      double *const q[2], bool add)
{
    for (int k = 0; k < 2; k++)
        forward(t, u[k], weight, k);
    for (int k = 0; k < 2; k++)
        back(t, inverse_column,
             (struct pass){.to = q[k], .weight = weight, .add = add, .which = k, .shift = d});
}

void
rc_tangential_normal(struct rc_tangential *t, double *const q[2], double *uz)
{
    for (int k = 0; k < 2; k++)
        forward(t, q[k], NULL, k);
    back(t, normal_column, (struct pass){.to = uz});
}

void
rc_tangential_pressure(struct rc_tangential *t, const double *p, double *const u[2])
{
    forward(t, p, NULL, 0);
    for (int k = 0; k < 2; k++)
        back(t, pressure_column, (struct pass){.to = u[k], .which = k});
}
