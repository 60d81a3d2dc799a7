/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Temperature of a wave of heat flux 1 exp(i q x) on a body that moves. Let m = sqrt(q^2 + 2 i P . q),
 * with Re m > 0. In the steady state the temperature is exp(-m z)/(k m). At a time t after heating began,
 * with s = sqrt(kap t) and a = z/(2 s), it is (Carslaw and Jaeger 1959, section 2.9)
 *
 *     [exp(-m z) erfc(a - m s) - exp(m z) erfc(a + m s)]/(2 k m).
 *
 * This is the integral over tau from 0 to T = 2 s of f = exp(-m^2 tau^2/4 - z^2/tau^2)/(k sqrt(pi)). A flux
 * that grows needs that of tau^2 f, too. Integrals I_n of tau^n f follow from each other by parts:
 *
 *     (n + 1) I_n = T^(n+1) f(T) + m^2/2 I_(n+2) - 2 z^2 I_(n-2),   I_(-2) = [exp(-m z) erfc(a - m s)
 *                                                     + exp(m z) erfc(a + m s)]/(4 k z).
 */
#include "heat.h"

/* Coefficients a_n of
 *
 *     exp(z^2) erfc(z) = 1/(sqrt(pi) (L + z)) + 2/(L + z)^2 sum of a_n Z^n,   Z = (L - z)/(L + z):
 *
 * They are those of the Fourier series of (L^2 + t^2) exp(-t^2), with t = L tan(theta/2). Z is in the unit
 * disc where Re z >= 0. With 40 terms the error is below 1e-13 (Weideman 1994, SIAM J. Numer. Anal. 31,
 * 1497). */
struct rc_heat_waves
rc_heat_waves_of(const struct rc_heated *body)
{
    enum {
        HALF = 2 * RC_ERFC_TERMS
    };
    struct rc_heat_waves w = {.body = *body, .length = sqrt(RC_ERFC_TERMS / sqrt(2))};

    for (int n = 0; n < RC_ERFC_TERMS; n++)
        for (int k = 1 - HALF; k < HALF; k++) {
            const double theta = k * RC_PI / HALF, t = w.length * tan(theta / 2);
            w.series[n] +=
                (w.length * w.length + t * t) * exp(-t * t) * cos((n + 1) * theta) / (2 * HALF);
        }
    return w;
}

double complex
rc_scaled_erfc(const struct rc_heat_waves *w, double complex z)
{
    const double complex over = 1 / (w->length + z), to = (w->length - z) * over;
    double complex sum = 0;

    for (int n = RC_ERFC_TERMS; n-- > 0;)
        sum = sum * to + w->series[n];
    return over / sqrt(RC_PI) + 2 * over * over * sum;
}

/* Below this m s the integral of tau^2 f is a series of m^2, with terms of 1e-2^5 at most. */
static const double slow = 0.1;

/* The integral of tau^2 f; `first`: that of f with m = 0. */
static double complex
of_square(const struct rc_heat_waves *w, double complex square, double s, double first)
{
    const double z = w->body.depth, end = 2 * s, a = z / end;
    const double last = exp(-a * a) / (w->body.k * sqrt(RC_PI));
    double complex sum = 0, term = 1;
    double power = end, integral = first;

    for (int n = 0; n < 6; n++) {
        power *= end * end;
        integral = (power * last - 2 * z * z * integral) / (2 * n + 3);
        sum += term * integral;
        term *= -square / (4 * (n + 1));
    }
    return sum;
}

/* At the time s^2/kap after heating began: the integral of f, and *second, that of tau^2 f. */
static double complex
after(const struct rc_heat_waves *w, double qx, double qy, double s, double complex *second)
{
    const struct rc_heated *b = &w->body;
    const double complex m = csqrt(CMPLX(qx * qx + qy * qy, 2 * (b->px * qx + b->py * qy)));
    const double z = b->depth, a = z / (2 * s);
    double complex below, above, fall;

    if (isinf(s)) {
        *second = 2 / (m * m) * (1 + m * z) * cexp(-m * z) / (b->k * m);
        return cexp(-m * z) / (b->k * m);
    }
    if (m == 0) {
        const double first = (2 * s / sqrt(RC_PI) * exp(-a * a) - z * erfc(a)) / b->k;
        *second = of_square(w, 0, s, first);
        return first;
    }
    fall = cexp(-a * a - m * m * s * s);
    above = fall * rc_scaled_erfc(w, a + m * s);
    below = a >= creal(m) * s ? fall * rc_scaled_erfc(w, a - m * s)
                              : 2 * cexp(-m * z) - fall * rc_scaled_erfc(w, m * s - a);
    *second = cabs(m * s) < slow
                  ? of_square(w, m * m, s, (2 * s / sqrt(RC_PI) * exp(-a * a) - z * erfc(a)) / b->k)
                  : 2 / (m * m) *
                        ((below - above) / (2 * b->k * m) + z * (below + above) / (2 * b->k) -
                         2 * s * fall / (b->k * sqrt(RC_PI)));
    return (below - above) / (2 * b->k * m);
}

double complex
rc_heat_symbol(const struct rc_heat_waves *w, double qx, double qy)
{
    const struct rc_heated *b = &w->body;
    double complex second[2] = {0, 0};
    const double complex first = after(w, qx, qy, b->diffusion / 2, &second[0]) -
                                 (b->ended > 0 ? after(w, qx, qy, b->ended / 2, &second[1]) : 0);

    return b->slope > 0 ? b->slope * (b->top * first - (second[0] - second[1])) : first;
}

/* From C at (qx, qy) and (qx, -qy), where C(-q) is the conjugate of C(q). */
void
rc_heat_symbol_parts(const struct rc_heat_waves *w, double qx, double qy,
                     double part[RC_HEAT_PARTS])
{
    const double complex on = rc_heat_symbol(w, qx, qy);
    const double complex back = w->body.py == 0   ? on
                                : w->body.px == 0 ? conj(on)
                                                  : rc_heat_symbol(w, qx, -qy);

    part[0] = creal(on + back) / 2;
    part[RC_ODD_X] = -cimag(on + back) / 2;
    part[RC_ODD_Y] = -cimag(on - back) / 2;
    part[RC_ODD_X | RC_ODD_Y] = -creal(on - back) / 2;
}
