/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * sigma = (w/rho) exp(-g/rho). The law is smooth and has an infinite range.
 */
#include <stdint.h>
#include <string.h>

#include "law.h"

/* Computes exp(x) for -700 <= x <= 0, to 2 units in the last place, in a form that compilers vectorise. It
 * splits x = k ln 2 + r with |r| <= ln(2)/2, and sums the series of exp(r). */
static inline double
exponential(double x)
{
    const double shift = 0x1.8p52, high = 0x1.62e42fefap-1, low = 0x1.cf79abc9e3b39p-40;
    double t = x * 0x1.71547652b82fep0 + shift, k = t - shift, r = (x - k * high) - k * low, e;
    uint64_t bits;

    e = 1.0 / 479001600;
    e = e * r + 1.0 / 39916800;
    e = e * r + 1.0 / 3628800;
    e = e * r + 1.0 / 362880;
    e = e * r + 1.0 / 40320;
    e = e * r + 1.0 / 5040;
    e = e * r + 1.0 / 720;
    e = e * r + 1.0 / 120;
    e = e * r + 1.0 / 24;
    e = e * r + 1.0 / 6;
    e = e * r + 0.5;
    e = e * r + 1;
    e = e * r + 1;
    memcpy(&bits, &t, sizeof bits);
    bits = (bits << 52) + ((uint64_t)1023 << 52);
    memcpy(&k, &bits, sizeof k);
    return e * k;
}

static void
set(struct rc_attraction *a, double diagonal)
{
    (void)diagonal;
    a->strength = a->work / a->range;
    a->steepest = a->strength / a->range;
    a->reach = 700 * a->range;
    a->spread = 0;
}

static double
range(double work, double cohesive, double diagonal)
{
    (void)diagonal;
    return sqrt(work * cohesive);
}

RC_CLONES static void
at(const struct rc_attraction *a, size_t n, const double *restrict g, double *restrict v,
   double *restrict s, double *restrict d)
{
    const double per = 1 / a->range, strength = a->strength, work = a->work;

    for (size_t k = 0; k < n; k++) {
        double below = g[k] < 0 ? g[k] : 0, x = (below - g[k]) * per;
        double e = exponential(x > -700 ? x : -700);
        e = x > -700 ? e : 0;
        s[k] = strength * e;
        v[k] = strength * below - work * e;
        d[k] = g[k] < 0 ? 0 : strength * per * e;
    }
}

const struct rc_adhesion_law rc_adhesion_exponential = {
    .info = {.name = "exponential",
             .summary = "traction falls to 1/e over the range, smoothly and without an end",
             .ranged = true},
    .set = set,
    .range = range,
    .at = at,
};
