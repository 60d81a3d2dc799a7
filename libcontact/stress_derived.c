/*
 * What is derived from the six components of a stress, point by point.
 */
#include "stress.h"

#include <math.h>

RC_WIDE_CLONES static void
mises(size_t n, const double *const s[RC_COMPONENTS], double *restrict out)
{
    const double *restrict xx = s[RC_SXX], *restrict yy = s[RC_SYY], *restrict zz = s[RC_SZZ];
    const double *restrict xy = s[RC_SXY], *restrict xz = s[RC_SXZ], *restrict yz = s[RC_SYZ];

    for (size_t k = 0; k < n; k++) {
        double a = xx[k] - yy[k], b = yy[k] - zz[k], c = zz[k] - xx[k];
        double t = xy[k] * xy[k] + xz[k] * xz[k] + yz[k] * yz[k];
        out[k] = sqrt((a * a + b * b + c * c) / 2 + 3 * t);
    }
}

RC_WIDE_CLONES static double
largest_size(size_t n, const double *v)
{
    double largest[8] = {0};

    for (size_t k = 0; k + 8 <= n; k += 8)
        for (size_t i = 0; i < 8; i++)
            largest[i] = fabs(v[k + i]) > largest[i] ? fabs(v[k + i]) : largest[i];
    for (size_t k = n / 8 * 8; k < n; k++)
        largest[0] = fmax(largest[0], fabs(v[k]));
    for (size_t i = 1; i < 8; i++)
        largest[0] = fmax(largest[0], largest[i]);
    return largest[0];
}

size_t
rc_largest(size_t n, const double *v)
{
    double size = largest_size(n, v);

    for (size_t k = 0; k < n; k++)
        if (fabs(v[k]) == size)
            return k;
    return 0;
}

/*
 * The eigenvalues of a symmetric matrix are m + 2 r cos(phi - 2 pi k / 3), m the mean of the
 * diagonal, r^2 a sixth of the squared deviator, cos 3 phi = det(deviator / r) / 2 (Smith 1961,
 * Comm. ACM 4, 168). Relative to r they have the errors of acos: near twofold eigenvalues about the
 * square root of rounding in phi, which moves them by rounding only.
 */
static void
principal(const double *const s[RC_COMPONENTS], size_t k, double e[3])
{
    static const double third = 2.0943951023931954923; /* 2 pi / 3 */
    double m = (s[RC_SXX][k] + s[RC_SYY][k] + s[RC_SZZ][k]) / 3;
    double a = s[RC_SXX][k] - m, b = s[RC_SYY][k] - m, c = s[RC_SZZ][k] - m;
    double d = s[RC_SXY][k], f = s[RC_SXZ][k], g = s[RC_SYZ][k];
    double r = sqrt((a * a + b * b + c * c) / 6 + (d * d + f * f + g * g) / 3), det, phi, low, high;

    if (!(r > 0)) {
        e[0] = e[1] = e[2] = m;
        return;
    }
    a /= r, b /= r, c /= r, d /= r, f /= r, g /= r;
    det = a * (b * c - g * g) - d * (d * c - g * f) + f * (d * g - b * f);
    phi = acos(fmax(-1, fmin(1, det / 2))) / 3; /* 0 .. pi/3 */
    high = 2 * r * cos(phi);
    low = 2 * r * cos(phi + third);
    e[0] = m + high;
    e[1] = m - high - low;
    e[2] = m + low;
}

void
rc_stress_derive(enum rc_component what, size_t n, const double *const s[RC_COMPONENTS],
                 double *out)
{
    if (what == RC_MISES) {
        mises(n, s, out);
        return;
    }
    for (size_t k = 0; k < n; k++) {
        double e[3];
        principal(s, k, e);
        out[k] = what == RC_TRESCA ? e[0] - e[2] : e[what - RC_S1];
    }
}
