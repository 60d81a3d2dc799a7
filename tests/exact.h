/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exact solutions with their sources. SI units; tension positive; z into the body. */
#ifndef EXACT_H
#define EXACT_H

#include <complex.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>

static const double exact_pi = 3.14159265358979323846;

/* Relative tolerances by name: a test uses one of these names or explains its own bound. pipe.sh reads
 * them from here, a line each. */
static const double same = 0;            /* the same number, or its decimal read back           */
static const double converted = 1e-15;   /* read from text and multiplied by its unit           */
static const double of_sum = 1e-14;      /* rounding of a sum, over the sum of absolute values  */
static const double rounding = 1e-13;    /* a few operations in double precision                */
static const double summed = 1e-12;      /* sums over a map                                     */
static const double six_digits = 5e-6;   /* half a unit of the last of six printed digits       */
static const double three_digits = 5e-3; /* and of three                                        */
static const double coarse_grid = 0.01;  /* against a closed form, tens of nodes in the contact */

/* Permitted error of a solution with constant pressure in each cell against Hertz's, with n nodes in the
 * radius of the contact. It is this constant over n^2 for approach and peak, and over n for the area (its
 * edge is a line of nodes). The numbers are about five times the published numerical errors: 2e-5 and 5e-5
 * with 21.5 nodes in the radius. */
static const double grid_approach = 0.1;
static const double grid_peak = 0.5;
static const double grid_area = 1;
/* The same for a rigid cone: a cell blunts its apex; approach over n. */
static const double grid_cone = 0.2;

/* Returns the first number in the tests before a release (RC_LONG, tests/CMakeLists.txt), the second one in
 * the tests of every commit. The numbers count cases, or steps from one case to the next. */
static inline size_t
thorough(size_t release, size_t commit)
{
    return getenv("RC_LONG") != NULL ? release : commit;
}

/* The larger of two numbers, and NaN where one of them is NaN: fmax would return the other. */
static inline double
larger(double a, double b)
{
    return isnan(a) || a >= b ? a : b;
}

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

/* Cylinder of composite radius R under a load per length (Johnson 1985, sections 4.2 and 5.6): half
 * width, peak pressure, and the approach of a point at the distance `datum`. */
static inline struct hertz
hertz_line(double load, double radius, double estar, double datum)
{
    double a = sqrt(4 * load * radius / (exact_pi * estar));

    return (struct hertz){.a = a,
                          .p0 = 2 * load / (exact_pi * a),
                          .approach = load / (exact_pi * estar) * (2 * log(2 * datum / a) + 1)};
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

/* Westergaard 1939 (Johnson 1985, section 13.2): a wave of amplitude A and wavelength L pressed against a
 * flat. At the mean pressure `full` it touches everywhere. */
static inline double
wave_full(double amplitude, double wavelength, double estar)
{
    return exact_pi * estar * amplitude / wavelength;
}

/* Fraction in contact, and pressure at x from a crest, at the mean pressure `mean` < full. */
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

/* Stresses under a unit force at the origin, normal (into the body) or along +x (Boussinesq,
 * Cerruti; Johnson 1985, eqs. 3.19 and 3.75), in the order sxx syy szz sxy sxz syz. */
static inline void
point_stress(bool shear, double nu, double x, double y, double z, double s[6])
{
    double r2 = x * x + y * y, R = sqrt(r2 + z * z), R2 = R * R, R3 = R2 * R, R5 = R3 * R2;
    double c = 1 - 2 * nu, b = R + z, b2 = b * b, scale = 1 / (2 * exact_pi);

    if (shear) {
        s[0] = -3 * x * x * x / R5 + c * (x / R3 - 3 * x / (R * b2) + x * x * x / (R3 * b2) +
                                          2 * x * x * x / (R2 * b2 * b));
        s[1] = -3 * x * y * y / R5 +
               c * (x / R3 - x / (R * b2) + x * y * y / (R3 * b2) + 2 * x * y * y / (R2 * b2 * b));
        s[2] = -3 * x * z * z / R5;
        s[3] = -3 * x * x * y / R5 +
               c * (-y / (R * b2) + x * x * y / (R3 * b2) + 2 * x * x * y / (R2 * b2 * b));
        s[4] = -3 * x * x * z / R5;
        s[5] = -3 * x * y * z / R5;
    } else {
        /* (1 - z/R) / r^2 and related terms, without r in the denominator */
        double d = 1 / (R * b), e = (2 * R + z) / (R3 * b2);
        s[0] = c * (z / R3 - d + x * x * e) - 3 * z * x * x / R5;
        s[1] = c * (z / R3 - d + y * y * e) - 3 * z * y * y / R5;
        s[2] = -3 * z * z * z / R5;
        s[3] = c * x * y * e - 3 * x * y * z / R5;
        s[4] = -3 * x * z * z / R5;
        s[5] = -3 * y * z * z / R5;
    }
    for (int k = 0; k < 6; k++)
        s[k] *= scale;
}

/* Loads on the surface that are uniform along y: for the profile f(s), the integral of f(s)/(w - s)
 * over s and its derivative, w = x + i z. */
struct line_load {
    double z;
    double complex of, d;
};

/* 1 on |s| < a. */
static inline struct line_load
line_load_strip(double x, double z, double a)
{
    const double complex w = CMPLX(x, z);

    return (struct line_load){z, clog(w + a) - clog(w - a), 1 / (w + a) - 1 / (w - a)};
}

/* sqrt(1 - s^2/a^2): Hertz's pressure under a roller; and its integral over s < x. */
static inline struct line_load
line_load_roller(double x, double z, double a)
{
    const double complex w = CMPLX(x, z), root = csqrt(w - a) * csqrt(w + a);

    return (struct line_load){z, exact_pi / a * (w - root), exact_pi / a * (1 - w / root)};
}

static inline double
roller_load(double a, double x)
{
    const double t = fmin(fmax(x / a, -1), 1);

    return a / 2 * (exact_pi / 2 + asin(t) + t * sqrt(1 - t * t));
}

/* Adds weight times its stresses, in plane or antiplane strain: of a pressure (load 0), of a traction
 * along x (1) or y (2). They are integrals of those of a force on a line (Flamant; Johnson 1985, eqs.
 * 2.15, 2.17), sxx = -2/pi z x^2/r^4, szz = -2/pi z^3/r^4 and so on. */
static inline void
line_load_stress(int load, double nu, struct line_load f, double weight, double s[6])
{
    const double x_r2 = creal(f.of), z_r2 = -cimag(f.of); /* of x/r^2, z/r^2 */
    const double even = -f.z * creal(f.d),
                 odd = -f.z * cimag(f.d) / 2; /* z (x^2 - z^2)/r^4, -x z^2/r^4 */
    const double scale = weight / exact_pi;

    if (load == 2) {
        s[3] -= scale * x_r2;
        s[5] -= scale * z_r2;
        return;
    }
    s[0] -= scale * (load == 0 ? z_r2 + even : 2 * (x_r2 + odd));
    s[1] -= scale * 2 * nu * (load == 0 ? z_r2 : x_r2);
    s[2] -= scale * (load == 0 ? z_r2 - even : -2 * odd);
    s[4] -= scale * (load == 0 ? -2 * odd : z_r2 + even);
}

/* Stresses under uniform pressure (Love 1929, sections 6 and 7) or uniform shear along +x of 1 on the
 * rectangle |x| <= a, |y| <= b, z > 0, in the same order. They are in extended precision, because far away
 * the terms cancel. */
static inline long double
rectangle_corner(bool shear, int component, long double nu, long double x, long double y,
                 long double z)
{
    long double R = sqrtl(x * x + y * y + z * z), p = x * x + z * z, q = y * y + z * z;
    long double around = atanl(x * y / (z * R)), c = 1 - 2 * nu;

    switch (shear ? 6 + component : component) {
    case 0:
        return -around + c * atan2l(x * y, y * y + z * z + z * R) + z * x * y / (R * p);
    case 1:
        return -around + c * atan2l(x * y, x * x + z * z + z * R) + z * x * y / (R * q);
    case 2:
        return -around - z * x * y * (p + q) / (R * p * q);
    case 3:
        return -z / R - c * logl(R + z);
    case 4:
    case 8:
        return z * z * y / (R * p);
    case 5:
        return z * z * x / (R * q);
    case 6:
        return 2 * asinhl(y / sqrtl(p)) + 2 * nu * y / (R + z) + z * y / (R * (R + z)) -
               z * z * y / (R * p);
    case 7:
        return 2 * nu * asinhl(y / sqrtl(p)) - 2 * nu * y / (R + z) - z * y / (R * (R + z));
    case 9:
        return asinhl(x / sqrtl(q)) - 2 * nu * x / (R + z) - z * x / (R * (R + z));
    case 10:
        return -around + z * x * y / (R * p);
    default:
        return -z / R;
    }
}

static inline double
rectangle_stress(bool shear, int component, double nu, double x, double y, double z, double a,
                 double b)
{
    long double sum = 0;

    for (int s = -1; s <= 1; s += 2)
        for (int t = -1; t <= 1; t += 2)
            sum += s * t *
                   rectangle_corner(shear, component, (long double)nu,
                                    (long double)x + s * (long double)a,
                                    (long double)y + t * (long double)b, (long double)z);
    return (double)(sum / (2 * (long double)exact_pi));
}

/*
 * Sliding sphere: pressure p0 sqrt(1 - r^2/a^2) and the traction mu times it along +x (Hamilton 1983, Proc.
 * Inst. Mech. Eng. 197C, 53; Sackfield and Hills 1983, J. Strain Anal. 18, 107), z > 0 or, at the surface, r
 * < a. The potential of that pressure is that of point sources at the depths z + it, |t| < a, of strength
 * a^2 - t^2. So each stress is -p0 (Re F2 - Im F3 / a). F2 and F3 are the second and third antiderivative in
 * z of the stress of a point source, at the depth z + ia. Let w = R + z, f1 = ln w, f2 = z f1 - R, fn the
 * antiderivative of f(n-1). The derivatives of fn by x and y are those of gn = fn'/r, hn = gn'/r, kn = hn'/r.
 */
static inline void
sliding_sphere(struct hertz s, double nu, double mu, double x, double y, double depth,
               double stress[6])
{
    double r2 = x * x + y * y, r4 = r2 * r2, c = 1 - 2 * nu;
    double complex z = CMPLX(depth, s.a), R = csqrt(r2 + z * z), w = R + z, L = clog(w);
    double complex w2 = w * w, w3 = w2 * w, w4 = w2 * w2, w5 = w4 * w;
    double complex f[6] = {1 / R, L, z * L - R}, g[6] = {0}, h[6] = {0}, k[6] = {0};

    g[1] = 1 / (R * w);
    g[2] = -1 / w;
    g[3] = -(z / w + L) / 2;
    g[4] = -((w + r4 / (3 * w3)) / 4 + z * L - R) / 2;
    h[2] = 1 / (R * w2);
    h[3] = -1 / (2 * w2);
    h[4] = (1 / w + r2 / (3 * w3)) / 4;
    h[5] = (L - 2 * r2 / (3 * w2) - r4 / (12 * w4)) / 8;
    k[3] = 1 / (R * w3);
    k[4] = (2 / (3 * w3) - 1 / (R * w2) - r2 / (R * w4)) / 4;
    k[5] = (1 / (R * w) - 4 * (1 / w2 - r2 / (R * w3)) / 3 - (r2 / w4 - r4 / (R * w5)) / 3) / 8;
    for (int i = 0; i < 6; i++)
        stress[i] = 0;
    for (int n = 2; n <= 3; n++) {
        double complex F[6];
        F[0] =
            2 * nu * f[n - 1] - depth * (g[n] + x * x * h[n]) - c * (g[n + 1] + x * x * h[n + 1]);
        F[1] =
            2 * nu * f[n - 1] - depth * (g[n] + y * y * h[n]) - c * (g[n + 1] + y * y * h[n + 1]);
        F[2] = f[n - 1] - depth * f[n - 2];
        F[3] = -x * y * (depth * h[n] + c * h[n + 1]);
        F[4] = -depth * x * g[n - 1];
        F[5] = -depth * y * g[n - 1];
        F[0] += mu * x *
                (2 * (1 + nu) * g[n] + 2 * nu * (3 * h[n + 2] + x * x * k[n + 2]) -
                 depth * (3 * h[n + 1] + x * x * k[n + 1]));
        F[1] +=
            mu * x *
            (2 * nu * (g[n] + h[n + 2] + y * y * k[n + 2]) - depth * (h[n + 1] + y * y * k[n + 1]));
        F[2] += -mu * depth * x * g[n - 1];
        F[3] +=
            mu * y *
            (g[n] + 2 * nu * (h[n + 2] + x * x * k[n + 2]) - depth * (h[n + 1] + x * x * k[n + 1]));
        F[4] += mu * (f[n - 1] - depth * (g[n] + x * x * h[n]));
        F[5] += -mu * depth * x * y * h[n];
        for (int i = 0; i < 6; i++)
            stress[i] -= s.p0 * (n == 2 ? creal(F[i]) : -cimag(F[i]) / s.a);
    }
}

static inline double
mises_of(const double s[6])
{
    double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];

    return sqrt((a * a + b * b + c * c) / 2 + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

/* Depth of the largest Mises stress under a sliding sphere, to a thousandth of a. It is sought in the plane
 * y = 0 by steps of 0.002 a along x. */
static inline double
mises_depth(struct hertz h, double nu, double mu)
{
    double best = 0, place = 0;

    for (double z = 0.3; z < 0.6; z += 0.001)
        for (double x = 0; x < 0.5; x += 0.002) {
            double s[6], m;
            sliding_sphere(h, nu, mu, x * h.a, 0, z * h.a, s);
            m = mises_of(s);
            place = m > best ? z : place;
            best = fmax(m, best);
        }
    return place * h.a;
}

/* Sphere with a Dugdale zone (Maugis, J. Colloid Interface Sci. 150 (1992) 243), K = 4/3 E*: radius a of
 * the contact, load, and approach in units of (pi w R^2/K)^(1/3), pi w R, (pi^2 w^2 R/K^2)^(1/3); lambda =
 * 2 sigma0 (R/(pi w K^2))^(1/3). m is the outer radius of the zone over a. */
struct maugis {
    double a, m, load, approach;
};

static inline struct maugis
maugis(double lambda, double a)
{
    double low = 1, high = 1e8;

    for (int k = 0; k < 200; k++) {
        double m = sqrt(low * high), s = sqrt(m * m - 1), t = atan(s);
        double is = lambda * a * a / 2 * (s + (m * m - 2) * t) +
                    4 * lambda * lambda * a / 3 * (s * t - m + 1);
        if (is < 1)
            low = m;
        else
            high = m;
    }
    double m = sqrt(low * high), s = sqrt(m * m - 1), t = atan(s);
    return (struct maugis){.a = a,
                           .m = m,
                           .load = a * a * a - lambda * a * a * (s + m * m * t),
                           .approach = a * a - 4 * lambda * a * s / 3};
}

/* The contact that carries this load, on the branch that a retraction follows. */
static inline struct maugis
maugis_of_load(double lambda, double load)
{
    double low = 1e-3, high = 10, lowest = INFINITY;

    for (int k = 0; k <= 2000; k++) { /* that branch begins at the lowest load */
        double a = 10 - (10 - 1e-3) * k / 2000, is = maugis(lambda, a).load;
        if (is < lowest) {
            lowest = is;
            low = a;
        }
    }
    for (int k = 0; k < 100; k++) {
        double a = (low + high) / 2;
        if (maugis(lambda, a).load < load)
            low = a;
        else
            high = a;
    }
    return maugis(lambda, low);
}

static inline double
maugis_pull_off(double lambda)
{
    double low = 1e-4, high = 3;

    for (int k = 0; k < 200; k++) { /* the load has one minimum */
        double b = low + (high - low) / 3, c = high - (high - low) / 3;
        if (maugis(lambda, b).load < maugis(lambda, c).load)
            high = c;
        else
            low = b;
    }
    return maugis(lambda, low).load;
}

/* A wave h = D cos(2 pi x/l) of a surface that sticks (Johnson, Int. J. Solids Struct. 32 (1995) 423): mean
 * pressure over p* = pi E* D/l where the contact is 2 a wide; alpha^2 = 2 E* w/(p*^2 l). */
static inline double
johnson_wave(double alpha, double a_over_l)
{
    double s = sin(exact_pi * a_over_l);

    return s * s - alpha * sqrt(tan(exact_pi * a_over_l));
}

#endif
