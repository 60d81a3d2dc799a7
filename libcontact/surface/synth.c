/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Surfaces from a formula or from a seed. */
#include "synth.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

#include "libcontact/common.h"
#include "libcontact/transform/transform.h"

/* Relative, so that waves at a cut-off and nodes on a rim are included despite the rounding of decimal
 * numbers. */
static const double slack = 1e-9;

static double
place(size_t i, size_t n, double d)
{
    return ((double)i - 0.5 * (double)(n - 1)) * d;
}

/* Cosine and sine of an angle in degrees, exact at right angles. */
static void
direction_of(double degrees, double *c, double *s)
{
    double quarter = remainder(degrees, 360) / 90;

    *c = quarter == -1 || quarter == 1 ? 0 : cos(quarter * RC_PI / 2);
    *s = quarter == 0 || quarter == -2 || quarter == 2 ? 0 : sin(quarter * RC_PI / 2);
}

void
rc_synth_sphere(const struct rc_shape *shape, double radius, double *h)
{
    rc_synth_paraboloid(shape, (struct rc_place){0, 0}, radius, radius, 0, h);
}

void
rc_synth_paraboloid(const struct rc_shape *shape, struct rc_place apex, double radius_1,
                    double radius_2, double direction, double *h)
{
    double c, s;

    direction_of(direction, &c, &s);
    for (size_t j = 0; j < shape->ny; j++) {
        double y = place(j, shape->ny, shape->dy) - apex.y;
        for (size_t i = 0; i < shape->nx; i++) {
            double x = place(i, shape->nx, shape->dx) - apex.x;
            double along = c * x - s * y, across = s * x + c * y;
            double sag = radius_1 == radius_2
                             ? (x * x + y * y) / (2 * radius_1)
                             : along * along / (2 * radius_1) + across * across / (2 * radius_2);
            h[j * shape->nx + i] = 0 - sag; /* never -0 */
        }
    }
}

/* Distance of a node from the apex. */
static double
distance(const struct rc_shape *shape, struct rc_place apex, size_t i, size_t j)
{
    return hypot(place(i, shape->nx, shape->dx) - apex.x, place(j, shape->ny, shape->dy) - apex.y);
}

void
rc_synth_cone(const struct rc_shape *shape, struct rc_place apex, double slope, double *h)
{
    for (size_t j = 0; j < shape->ny; j++)
        for (size_t i = 0; i < shape->nx; i++)
            h[j * shape->nx + i] = 0 - slope * distance(shape, apex, i, j);
}

void
rc_synth_punch(const struct rc_shape *shape, struct rc_place apex, double radius, double edge,
               double height, double *h)
{
    for (size_t j = 0; j < shape->ny; j++)
        for (size_t i = 0; i < shape->nx; i++) {
            double out = distance(shape, apex, i, j) - radius;
            double depth = out <= slack * radius ? 0
                           : edge > 0            ? fmin(out * out / (2 * edge), height)
                                                 : height;
            h[j * shape->nx + i] = 0 - depth;
        }
}

void
rc_synth_wave(const struct rc_shape *shape, double amplitude, double wavelength_x,
              double wavelength_y, double *h)
{
    for (size_t j = 0; j < shape->ny; j++) {
        double a = amplitude * cos(2 * RC_PI * place(j, shape->ny, shape->dy) / wavelength_y);
        for (size_t i = 0; i < shape->nx; i++)
            h[j * shape->nx + i] =
                a * cos(2 * RC_PI * place(i, shape->nx, shape->dx) / wavelength_x);
    }
}

/* ---- self-affine roughness ---- */

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
    direction_of(what->direction, &s.c, &s.s);
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

/* Fills the spectrum; the mean squares of height and slope follow from Parseval's theorem. */
static void
make_waves(const struct rc_shape *shape, const struct spectrum *what, double complex *s,
           double *height2, double *slope2)
{
    size_t columns = rc_fourier_columns(shape);

    *height2 = *slope2 = 0;
    for (size_t j = 0; j < shape->ny; j++) {
        long ky = rc_fourier_number(j, shape->ny);
        double row_height2 = 0, row_slope2 = 0; /* summed row by row to keep digits */
        for (size_t i = 0; i < columns; i++) {
            double complex a = amplitude(shape, what, (long)i, ky);
            double qx = rc_fourier_q(i, shape->nx, shape->dx);
            double qy = rc_fourier_q(j, shape->ny, shape->dy);
            double a2 = creal(a) * creal(a) + cimag(a) * cimag(a);
            if (i > 0)
                a2 *= 2; /* includes the conjugate, which is not stored */
            row_height2 += a2;
            row_slope2 += a2 * (qx * qx + qy * qy);
            s[j * columns + i] = a;
        }
        *height2 += row_height2;
        *slope2 += row_slope2;
    }
}

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
    enum rc_status status;
    RC_OWNED double complex *s = NULL;
    struct spectrum spectrum;
    size_t n = rc_fourier_size(shape);
    double height2, slope2, scale, misfit;

    if (check_spectrum(shape, what, err) != RC_OK)
        return RC_FAIL;
    spectrum = spectrum_of(shape, what);
    s = malloc(n * sizeof *s);
    if (s == NULL)
        return rc_err_set(err, "out of memory for %zu waves (%zu bytes)", n, n * sizeof *s);
    make_waves(shape, &spectrum, s, &height2, &slope2);
    if (height2 == 0)
        return rc_err_set(
            err, "no wave of a map of %g m x %g m lies between the wavelengths %g m and %g m",
            (double)shape->nx * shape->dx, (double)shape->ny * shape->dy, 1 / spectrum.high,
            1 / spectrum.low);
    scale =
        what->rms_slope == 0 ? what->rms_height / sqrt(height2) : what->rms_slope / sqrt(slope2);
    for (size_t k = 0; k < n; k++)
        s[k] *= scale;
    status = rc_fourier_backward(shape, s, h, err);
    if (status == RC_OK && rc_heights_skewed(what))
        status = rc_heights_shape(shape, what, STEPS, h, &misfit, err);
    if (status == RC_OK && rc_heights_skewed(what))
        status = set_size(shape, what, s, h, err);
    return status;
}
