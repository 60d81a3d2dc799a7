/* Exact solutions, with their sources and nothing else. SI; tension positive; z into the body. */
#ifndef EXACT_H
#define EXACT_H

#include <math.h>

static const double exact_pi = 3.14159265358979323846;

/* The ladder of tolerances: a test names the rung it stands on. */
static const double rounding = 1e-13; /* a few operations in double precision, relative          */
static const double summed = 1e-12;   /* sums over a map                                         */

/* Sphere of composite radius R on a half-space (Johnson 1985, section 3.4 and 4.2). */
struct hertz {
    double a, p0, approach;
};

static inline struct hertz
hertz(double load, double radius, double estar)
{
    double a = cbrt(3 * load * radius / (4 * estar));

    return (struct hertz){
        .a = a, .p0 = 3 * load / (2 * exact_pi * a * a), .approach = a * a / radius};
}

static inline double
hertz_pressure(struct hertz h, double r)
{
    return r < h.a ? h.p0 * sqrt(1 - r * r / (h.a * h.a)) : 0;
}

/* Surface displacement under it (Johnson eq. 3.42). */
static inline double
hertz_displacement(struct hertz h, double estar, double r)
{
    double a = h.a;

    if (r <= a)
        return exact_pi * h.p0 / (4 * estar * a) * (2 * a * a - r * r);
    return h.p0 / (2 * estar * a) *
           ((2 * a * a - r * r) * asin(a / r) + r * a * sqrt(1 - a * a / (r * r)));
}

/* Stresses on the axis (Johnson eq. 3.45). */
static inline double
hertz_axis_szz(struct hertz h, double z)
{
    return -h.p0 / (1 + z * z / (h.a * h.a));
}

static inline double
hertz_axis_sxx(struct hertz h, double nu, double z)
{
    double s = z / h.a;

    return h.p0 * (-(1 + nu) * (1 - (s == 0 ? 0 : s * atan(1 / s))) + 1 / (2 * (1 + s * s)));
}

/* Rigid cone, gap = slope * r (Johnson section 5.2): contact radius, approach. */
static inline double
cone_radius(double load, double slope, double estar)
{
    return sqrt(2 * load / (exact_pi * estar * slope));
}

static inline double
cone_approach(double load, double slope, double estar)
{
    return exact_pi / 2 * slope * cone_radius(load, slope, estar);
}

/* Rigid flat circular punch (Johnson section 3.4b): approach = load / (2 a E*). */
static inline double
punch_approach(double load, double a, double estar)
{
    return load / (2 * a * estar);
}

/* Love 1929: displacement at (x, y) of the surface under unit pressure on |x| <= a, |y| <= b. */
static inline double
love_corner(double x, double y)
{
    return (x == 0 ? 0 : x * asinh(y / fabs(x))) + (y == 0 ? 0 : y * asinh(x / fabs(y)));
}

static inline double
love_displacement(double x, double y, double a, double b, double estar)
{
    return (love_corner(x + a, y + b) - love_corner(x - a, y + b) - love_corner(x + a, y - b) +
            love_corner(x - a, y - b)) /
           (exact_pi * estar);
}

/* Westergaard 1939 (Johnson 1985, section 13.2): a wave of amplitude A and wavelength L pressed against
 * a flat; at the mean pressure `full` it touches everywhere. */
static inline double
wave_full(double amplitude, double wavelength, double estar)
{
    return exact_pi * estar * amplitude / wavelength;
}

/* Fraction in contact, pressure at x from a crest, at the mean pressure `mean` < full. */
static inline double
wave_fraction(double mean, double full)
{
    return 2 / exact_pi * asin(sqrt(mean / full));
}

static inline double
wave_pressure(double mean, double full, double wavelength, double x)
{
    double psi = exact_pi * x / wavelength, a = mean / full;

    psi -= exact_pi * floor(psi / exact_pi + 0.5);
    if (sin(psi) * sin(psi) >= a)
        return 0;
    return 2 * full * cos(psi) * sqrt(a - sin(psi) * sin(psi));
}

#endif
