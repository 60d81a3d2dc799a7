/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Self-affine roughness from a seed. */
#include <complex.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/common.h"
#include "libcontact/memory.h"
#include "libcontact/ranks/ranks.h"
#include "libcontact/transform/transform.h"
#include "synth.h"

/* Relative, so that waves at a cut-off are included despite the rounding of decimal numbers. */
static const double slack = 1e-9;

enum {
    STEPS = 20 /* between heights and waves: more steps change little */
};

/* The wanted spectrum; wave numbers in 1/m without the factor 2 pi: 1 / wavelength. */
struct spectrum {
    double low, high; /* smallest and largest wave number, both included */
    double rolloff;   /* flat below                                      */
    double power;     /* amplitudes fall as q^-power above               */
    uint64_t seed;
    double anisotropy, c, s; /* ratio of the lay, cosine and sine of its direction */
};

/* 0 means not given. */
static bool
bad_length(double length)
{
    return !(length >= 0 && isfinite(length));
}

/* The shortest wavelength that the grid resolves in all directions. */
static double
resolved(const struct rc_shape *shape)
{
    if (shape->ny == 1)
        return 2 * shape->dx;
    if (shape->nx == 1)
        return 2 * shape->dy;
    return 2 * fmax(shape->dx, shape->dy);
}

static enum rc_status
check_size(const struct rc_selfaffine *what, struct rc_err *err)
{
    bool slope = what->rms_height == 0;
    double size = slope ? what->rms_slope : what->rms_height;

    if (slope == (what->rms_slope == 0))
        return rc_err_set(err, "give one of RMS height and RMS slope: the other one follows");
    if (!(size > 0) || isinf(size))
        return rc_err_set(err, "RMS %s %g: it must be positive and finite",
                          slope ? "slope" : "height", size);
    return RC_OK;
}

static enum rc_status
check_lay(const struct rc_shape *shape, const struct rc_selfaffine *what, struct rc_err *err)
{
    if (what->anisotropy != 0 && !(what->anisotropy >= 1 && isfinite(what->anisotropy)))
        return rc_err_set(err, "anisotropy %g: it must be at least 1", what->anisotropy);
    if (what->anisotropy > 1 && (shape->nx == 1 || shape->ny == 1))
        return rc_err_set(err, "anisotropy %g: a profile has one direction only", what->anisotropy);
    if (!isfinite(what->direction))
        return rc_err_set(err, "direction %g: it must be finite", what->direction);
    return RC_OK;
}

static enum rc_status
check_spectrum(const struct rc_shape *shape, const struct rc_selfaffine *what, struct rc_err *err)
{
    double shortest = resolved(shape);

    if (!(what->hurst > 0 && what->hurst <= 1))
        return rc_err_set(err, "Hurst exponent %g: it must be above 0 and at most 1", what->hurst);
    if (bad_length(what->long_cut) || bad_length(what->rolloff) || bad_length(what->short_cut))
        return rc_err_set(err,
                          "long cut-off %g m, roll-off %g m, short cut-off %g m: wavelengths "
                          "must be positive and finite",
                          what->long_cut, what->rolloff, what->short_cut);
    if (what->short_cut != 0 && what->short_cut < shortest * (1 - slack))
        return rc_err_set(err,
                          "short cut-off %g m: the nodes hold wavelengths from %g m on, twice "
                          "their spacing",
                          what->short_cut, shortest);
    if (what->short_cut != 0)
        shortest = what->short_cut;
    if (what->long_cut != 0 && what->long_cut < shortest)
        return rc_err_set(err, "long cut-off %g m: it must not be below the short one, %g m",
                          what->long_cut, shortest);
    if (what->rolloff != 0 && what->rolloff < shortest)
        return rc_err_set(err, "roll-off %g m: it must not be below the short cut-off, %g m",
                          what->rolloff, shortest);
    if (check_lay(shape, what, err) != RC_OK || rc_heights_check(what, err) != RC_OK)
        return RC_FAIL;
    return check_size(what, err);
}

static struct spectrum
spectrum_of(const struct rc_shape *shape, const struct rc_selfaffine *what)
{
    bool profile = shape->nx == 1 || shape->ny == 1;
    double size = hypot((double)shape->nx * shape->dx, (double)shape->ny * shape->dy);
    double shortest = what->short_cut == 0 ? resolved(shape) : what->short_cut;
    struct spectrum s = {
        .low = what->long_cut == 0 ? 0 : (1 - slack) / what->long_cut,
        .high = (1 + slack) / shortest,
        /* no flat part: below all other wave numbers */
        .rolloff = 1 / (what->rolloff == 0 ? size : what->rolloff),
        .power = what->hurst + (profile ? 0.5 : 1),
        .seed = what->seed,
        .anisotropy = what->anisotropy == 0 ? 1 : what->anisotropy,
    };
    rc_synth_direction(what->direction, &s.c, &s.s);
    return s;
}

/* Wave number, across the lay, of the wave with the same power. */
static double
wave_number(const struct spectrum *what, double qx, double qy)
{
    if (what->anisotropy == 1)
        return hypot(qx, qy);
    return hypot(what->anisotropy * (what->c * qx - what->s * qy), what->s * qx + what->c * qy);
}

/* The finaliser of splitmix64 (Steele, Lea, Flood 2014): every input bit moves every output bit. */
static uint64_t
scramble(uint64_t z)
{
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

/* A complex Gaussian number with mean square 1 that depends on seed, kx and ky alone (Box and Muller 1958).
 * Its phase is shifted by this number of periods. */
static double complex
draw(uint64_t seed, long kx, long ky, double periods)
{
    const uint64_t step = UINT64_C(0x9e3779b97f4a7c15);
    uint64_t z = scramble(seed + step);
    double u, angle;

    z = scramble(z + step * (uint64_t)kx);
    z = scramble(z + step * (uint64_t)ky);
    u = ((double)(z >> 11) + 1) * 0x1p-53; /* (0, 1] */
    angle = 2 * RC_PI * ((double)(scramble(z + step) >> 11) * 0x1p-53 + periods);
    return sqrt(-log(u)) * (cos(angle) + I * sin(angle));
}

/* Amplitude of the wave exp(2 pi i (kx x / Lx + ky y / Ly)). The phases refer to the middle of the map, so
 * that they are the same on every grid. The transform counts from node (0, 0), hence the extra phase. Heights
 * are real if opposite waves are conjugate: a number is drawn for one of each pair. Waves of two nodes
 * (Nyquist) are left out: they are their own opposites. */
static double complex
amplitude(const struct rc_shape *shape, const struct spectrum *what, long kx, long ky)
{
    double nx = (double)shape->nx, ny = (double)shape->ny;
    double q = wave_number(what, (double)kx / (nx * shape->dx), (double)ky / (ny * shape->dy));
    double periods = -0.5 * ((double)kx * (nx - 1) / nx + (double)ky * (ny - 1) / ny);
    double size;

    if ((kx == 0 && ky == 0) || q < what->low || q > what->high ||
        2 * (size_t)labs(kx) == shape->nx || 2 * (size_t)labs(ky) == shape->ny)
        return 0;
    size = q > what->rolloff ? pow(what->rolloff / q, what->power) : 1;
    if (kx == 0 && ky < 0)
        return size * conj(draw(what->seed, 0, -ky, -periods));
    return size * draw(what->seed, kx, ky, periods);
}

/* ---- waves and heights by rows and columns ---- */

/* Each rank makes the waves of its rows of the spectrum, one exchange makes whole columns of them, which it
 * transforms, and one exchange brings back rows. Each line is transformed separately, so that the heights do
 * not depend on the number of ranks and threads. One process holds whole rows and columns, and exchanges
 * nothing. */
struct waves {
    const struct rc_shape *shape;
    const struct spectrum *what;
    struct rc_rows rows;
    struct rc_turn turn;
    struct rc_line *along_x;
    int threads;
    size_t wide; /* complex numbers in a row, and columns held here */
    size_t held;
    double complex *pieces,
        *columns;         /* of rows; the columns held here. One process: the same memory */
    double complex *line; /* one row for each thread */
    struct rc_sums sums;  /* squares of heights and slopes */
    struct rc_store own;
};

static void
waves_free(struct waves *w)
{
    free(w->sums.row);
    rc_turn_free(&w->turn);
    rc_line_free(w->along_x);
    rc_store_free(&w->own);
}

static enum rc_status
take_memory(struct waves *w, struct rc_err *err)
{
    const struct rc_ranks *ranks = w->rows.ranks;
    const struct rc_shape *s = w->shape;

    w->wide = w->held = rc_fourier_columns(s);
    if (ranks != NULL) {
        if (rc_turn_new(&w->turn, ranks, s->ny, rc_rows_unit(s->nx), 0, w->wide, sizeof *w->line,
                        err) != RC_OK)
            return RC_FAIL;
        w->held = w->turn.column[w->turn.own + 1] - w->turn.column[w->turn.own];
        w->pieces = rc_store_take(&w->own, w->rows.n * w->wide, sizeof *w->pieces);
    }
    w->columns = rc_store_take(&w->own, s->ny * w->held, sizeof *w->columns);
    w->line = rc_store_take(&w->own, (size_t)w->threads * w->wide, sizeof *w->line);
    w->along_x = rc_line_new(s->nx, (size_t)w->threads, err);
    if (w->own.failed || w->along_x == NULL ||
        rc_sums_new(&w->sums, ranks, w->rows.n, 2, 0, w->threads) != RC_OK)
        return rc_err_set(err, "out of memory for %zu waves (%zu bytes)", rc_fourier_size(s),
                          rc_fourier_size(s) * sizeof *w->line);
    if (ranks == NULL)
        w->pieces = w->columns;
    return RC_OK;
}

static double complex *
line_of(const struct waves *w)
{
    return w->line + (size_t)omp_get_thread_num() * w->wide;
}

static void
put_row(const struct waves *w, size_t j, const double complex *row)
{
    if (w->rows.ranks == NULL)
        memcpy(w->columns + j * w->wide, row, w->wide * sizeof *row);
    else
        rc_turn_put(&w->turn, j, row, w->pieces);
}

static void
get_row(const struct waves *w, size_t j, double complex *row)
{
    if (w->rows.ranks == NULL)
        memcpy(row, w->columns + j * w->wide, w->wide * sizeof *row);
    else
        rc_turn_get(&w->turn, j, w->pieces, row);
}

static void
make_row(void *ctx, size_t j, double *sums)
{
    const struct waves *w = ctx;
    const struct rc_shape *s = w->shape;
    const size_t row = w->rows.first + j;
    const long ky = rc_fourier_number(row, s->ny);
    const double qy = rc_fourier_q(row, s->ny, s->dy);
    double complex *line = line_of(w);

    for (size_t i = 0; i < w->wide; i++) {
        double complex a = amplitude(s, w->what, (long)i, ky);
        double qx = rc_fourier_q(i, s->nx, s->dx);
        double a2 = creal(a) * creal(a) + cimag(a) * cimag(a);
        if (i > 0)
            a2 *= 2; /* includes the conjugate, which is not stored */
        sums[0] += a2;
        sums[1] += a2 * (qx * qx + qy * qy);
        line[i] = a;
    }
    put_row(w, j, line);
}

/* The heights of these waves, times `scale`. */
static enum rc_status
make_heights(const struct waves *w, double scale, double *h, struct rc_err *err)
{
    const struct rc_ranks *ranks = w->rows.ranks;

    if (ranks != NULL)
        rc_ranks_turn(&w->turn, false, w->pieces, w->columns);
    if (rc_ranks_agree(
            ranks, rc_fourier_columns_backward(w->shape->ny, w->held, w->threads, w->columns, err),
            err) != RC_OK)
        return RC_FAIL;
    if (ranks != NULL)
        rc_ranks_turn(&w->turn, true, w->columns, w->pieces);
#pragma omp parallel for num_threads(w->threads) schedule(static)
    for (size_t j = 0; j < w->rows.n; j++) {
        double complex *line = line_of(w);

        get_row(w, j, line);
        for (size_t i = 0; i < w->wide; i++)
            line[i] *= scale;
        rc_line_backward(w->along_x, line, h + j * w->shape->nx);
    }
    return RC_OK;
}

/* ---- the wanted size ---- */

/* Scales heights of mean 0 and RMS 1 to the wanted size; s: scratch for their waves. */
static enum rc_status
set_size(const struct rc_shape *shape, const struct rc_selfaffine *what, double complex *s,
         double *h, struct rc_err *err)
{
    size_t columns = rc_fourier_columns(shape), n = shape->nx * shape->ny;
    double size = what->rms_height, slope2 = 0;

    if (what->rms_slope != 0) {
        if (rc_fourier_forward(shape, h, s, err) != RC_OK)
            return RC_FAIL;
        for (size_t j = 0; j < shape->ny; j++) {
            double row = 0; /* summed row by row to keep digits */

            for (size_t i = 0; i < columns; i++) {
                double q = hypot(rc_fourier_q(i, shape->nx, shape->dx),
                                 rc_fourier_q(j, shape->ny, shape->dy));
                double a = cabs(s[j * columns + i]) * q / (double)n;

                row += a * a * (i == 0 || 2 * i == shape->nx ? 1 : 2);
            }
            slope2 += row;
        }
        size = what->rms_slope / sqrt(slope2);
    }
    for (size_t k = 0; k < n; k++)
        h[k] *= size;
    return RC_OK;
}

enum rc_status
rc_synth_selfaffine(const struct rc_shape *shape, const struct rc_selfaffine *what, double *h,
                    struct rc_err *err)
{
    struct spectrum spectrum;
    RC_ENDS(waves_free)
    struct waves w = {.shape = shape,
                      .what = &spectrum,
                      .rows = rc_rows_of(what->ranks, shape),
                      .threads = rc_useful_threads(shape, what->threads)};
    double sums[2], misfit; /* mean squares of height and slope, by Parseval's theorem */
    enum rc_status status;

    if (check_spectrum(shape, what, err) != RC_OK || rc_fourier_check(shape, err) != RC_OK)
        return RC_FAIL;
    if (rc_heights_skewed(what) && rc_ranks_count(what->ranks) > 1)
        return rc_err_set(err, "heights that are not Gaussian need the whole map in one process");
    spectrum = spectrum_of(shape, what);
    if (rc_ranks_agree(what->ranks, take_memory(&w, err), err) != RC_OK)
        return RC_FAIL;
    rc_sums_rows(&w.sums, make_row, &w, sums);
    if (sums[0] == 0)
        return rc_err_set(
            err, "no wave of a map of %g m x %g m lies between the wavelengths %g m and %g m",
            (double)shape->nx * shape->dx, (double)shape->ny * shape->dy, 1 / spectrum.high,
            1 / spectrum.low);
    status = make_heights(&w,
                          what->rms_slope == 0 ? what->rms_height / sqrt(sums[0])
                                               : what->rms_slope / sqrt(sums[1]),
                          h, err);
    if (status == RC_OK && rc_heights_skewed(what))
        status = rc_heights_shape(shape, what, STEPS, h, &misfit, err);
    if (status == RC_OK && rc_heights_skewed(what))
        status = set_size(shape, what, w.columns, h, err);
    return status;
}
