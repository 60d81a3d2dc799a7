/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A modulus and its compliance belong together to rounding: over 20 decades, with times that nearly coincide
 * and moduli that nearly vanish, and for a fluid. A standard linear solid has its closed form. The fit of a
 * master curve of a fractional solid has the known misfit, and averages the noise of the curve. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <string.h>

#include "libcontact/contact.h"
#include "libcontact/viscoelastic/wake.h"
#include "tests/exact.h"

/* The definitions of E(i w) and J(i w). */
static double complex
modulus(double relaxed, size_t n, const double *e, const double *tau, double w)
{
    double complex sum = relaxed;

    for (size_t k = 0; k < n; k++)
        sum += e[k] / (1 - I / (w * tau[k]));
    return sum;
}

static double complex
compliance(const struct rc_relaxation *r, double w)
{
    double complex sum = r->instant + r->fluidity / (I * w);

    for (size_t j = 0; j < r->creep_terms; j++)
        sum += r->compliance[j] / (1 + I * w * r->retardation[j]);
    return sum;
}

/* The largest |E(i w) J(i w) - 1|, with a few frequencies a decade. Compares the library's values too. */
static double
worst_product(double relaxed, size_t n, const double *e, const double *tau, double low, double high)
{
    struct rc_err err = {""};
    struct rc_relaxation *r = rc_relaxation_new(relaxed, n, e, tau, &err);
    double worst = 0, em[2], jm[2];

    if (r == NULL)
        fail_msg("%s", err.text);
    for (double w = low; w < high; w *= 1.7) {
        const double complex is = modulus(relaxed, n, e, tau, w), j = compliance(r, w);
        worst = larger(worst, cabs(is * j - 1));
        rc_relaxation_dynamic(r, w, em, jm);
        assert_true(cabs(em[0] + I * em[1] - is) <= of_sum * cabs(is));
        assert_true(cabs(jm[0] + I * jm[1] - j) <= of_sum * cabs(j));
    }
    for (size_t j = 0; j < r->creep_terms; j++)
        assert_true(r->compliance[j] > 0 && (j == 0 || r->retardation[j] > r->retardation[j - 1]));
    rc_relaxation_free(r);
    return worst;
}

static void
product_over_20_decades(void **state)
{
    enum {
        N = 40
    };
    double e[N], tau[N];

    (void)state;
    for (int k = 0; k < N; k++) {
        tau[k] = pow(10, -10 + 20. * k / (N - 1));
        e[k] = 1e9 * pow(10, -6. * k / (N - 1)) * (1 + 0.5 * sin(3 * k));
    }
    assert_true(worst_product(1e3, N, e, tau, 1e-13, 1e13) < of_sum);
    assert_true(worst_product(0, N, e, tau, 1e-13, 1e13) < of_sum); /* a fluid */
}

static void
product_of_near_times(void **state)
{
    const double tau[] = {1, 1e-3 * (1 + 1e-7), 1e3, 1 + 1e-7, 1e-3, 7};
    const double e[] = {1e6, 2e6, 1e-3, 1e6, 3e5, 1e-3};

    (void)state;
    assert_true(worst_product(1e6, 6, e, tau, 1e-6, 1e6) < of_sum);
    assert_true(worst_product(1e-3, 6, e, tau, 1e-16, 1e6) < of_sum);
}

/* J = 1/E0 - (1/E0 - 1/(E0 + E1)) exp(-t/th), th = tau (E0 + E1)/E0 (Johnson 1985, section 6.5). */
static void
standard_solid(void **state)
{
    const double e0 = 2e6, e1 = 7e6, tau = 0.3, th = tau * (e0 + e1) / e0;
    const double e[] = {0, e1}, times[] = {5, tau};
    struct rc_err err = {""};
    struct rc_relaxation *r = rc_relaxation_new(e0, 2, e, times, &err);
    double mean = 0, em[2], jm[2];
    const double width = 2.5 / th;

    (void)state;
    assert_non_null(r);
    assert_int_equal(r->creep_terms, 1);
    for (double t = 0; t < 20; t += 0.7) {
        const double j = 1 / e0 - (1 / e0 - 1 / (e0 + e1)) * exp(-t / th);
        assert_true(fabs(rc_relaxation_compliance(r, t) - j) < of_sum * j);
        assert_true(fabs(rc_relaxation_modulus(r, t) - e0 - e1 * exp(-t / tau)) < of_sum * e0);
    }
    for (int k = 0; k < 4000; k++) { /* the midpoint rule */
        rc_relaxation_dynamic(r, (k + 0.5) / 4000 * width, em, jm);
        mean += jm[0] / 4000;
    }
    assert_true(fabs(rc_relaxation_mean_compliance(r, width) / mean - 1) < 1e-7);
    assert_true(fabs(rc_relaxation_mean_compliance(r, 0) * e0 - 1) < of_sum);
    rc_relaxation_free(r);
}

/* The modulus of a fractional solid: E0 + (Eg - E0)/(1 + (i w)^-a). */
static double
misfit_of(double slope, double per_decade, double noise, double *truth)
{
    enum {
        N = 113
    };
    double w[N], storage[N], loss[N], misfit, sum = 0;
    double complex exact[N];
    struct rc_err err = {""};
    struct rc_relaxation *r;

    for (int i = 0; i < N; i++) {
        w[i] = pow(10, -7 + 14. * i / (N - 1));
        exact[i] = 1e6 + 999e6 / (1 + cpow(I * w[i], -slope));
        storage[i] = creal(exact[i]) * (1 + noise * sin(17.3 * i * i));
        loss[i] = cimag(exact[i]) * (1 + noise * sin(31.7 * i * i + 1));
    }
    r = rc_relaxation_fit(N, w, storage, loss, per_decade, &misfit, &err);
    if (r == NULL)
        fail_msg("%s", err.text);
    for (int i = 0; i < N; i++) {
        double em[2], jm[2];
        rc_relaxation_dynamic(r, w[i], em, jm);
        sum += pow(em[0] / storage[i] - 1, 2) + pow(em[1] / loss[i] - 1, 2);
        if (truth != NULL)
            *truth += pow(em[0] / creal(exact[i]) - 1, 2) / N;
    }
    assert_true(fabs(sqrt(sum / (2 * N)) / misfit - 1) < 1e-6);
    rc_relaxation_free(r);
    return misfit;
}

static void
master_curve(void **state)
{
    double truth = 0;
    const double noisy = misfit_of(0.5, 1, 0.07, &truth); /* 0.05 RMS */

    (void)state;
    assert_true(misfit_of(0.3, 1, 0, NULL) < 0.032);
    assert_true(misfit_of(0.5, 1, 0, NULL) < 0.032);
    assert_true(misfit_of(0.3, 0, 0, NULL) < 0.005);
    assert_true(misfit_of(0.5, 0, 0, NULL) < 0.005);
    assert_true(misfit_of(0.5, 2, 0, NULL) < 0.002);
    /* the fit is nearer to the truth than half of the noise */
    assert_true(noisy > 0.035 && noisy < 0.06 && sqrt(truth) < 0.025);
}

/* Terms between the usual times of the fit, at its own and at other frequencies: without noise the modulus is
 * that of the material to 0.2 % RMS. With noise of 3.5 % RMS the error is below 0.7 of the noise. A smooth
 * spectrum keeps the usual fit. */
static void
sharp_terms(void **state)
{
    enum {
        N = 37, /* four a decade */
        TERMS = 5
    };
    const double tau[TERMS] = {2.1e-6, 2.1e-5, 2.1e-4, 2.1e-3, 2.1e-2};
    const double e[TERMS] = {32e6, 16e6, 8e6, 4e6, 2e6};

    (void)state;
    for (int noisy = 0; noisy < 2; noisy++) {
        const double noise = noisy ? 0.05 : 0;
        double w[N], storage[N], loss[N], misfit, em[2], sum = 0, n = 0;
        struct rc_err err = {""};
        struct rc_relaxation *r;

        for (int i = 0; i < N; i++) {
            double complex exact;
            w[i] = 0.0628 * pow(10, i / 4.);
            exact = modulus(2e6, TERMS, e, tau, w[i]);
            storage[i] = creal(exact) * (1 + noise * sin(17.3 * i * i));
            loss[i] = cimag(exact) * (1 + noise * sin(31.7 * i * i + 1));
        }
        r = rc_relaxation_fit(N, w, storage, loss, 0, &misfit, &err);
        if (r == NULL)
            fail_msg("%s", err.text);
        assert_true(misfit < (noisy ? 0.036 : 0.002));
        assert_true(r->terms <= 3 * TERMS);
        for (double x = 10; x < 2e6; x *= 1.37) {
            const double complex exact = modulus(2e6, TERMS, e, tau, x);
            rc_relaxation_dynamic(r, x, em, (double[2]){0});
            sum += pow(em[0] / creal(exact) - 1, 2) + pow(em[1] / cimag(exact) - 1, 2);
            n += 2;
        }
        assert_true(sqrt(sum / n) < (noisy ? 0.025 : 0.002));
        rc_relaxation_free(r);
    }
    assert_true(misfit_of(0.3, 0, 0.05, NULL) == misfit_of(0.3, 1.5, 0.05, NULL));
    assert_true(misfit_of(0.3, 0, 0, NULL) == misfit_of(0.3, 1.5, 0, NULL));
}

static void
refused(double relaxed, double e, double tau, const char *words)
{
    const double es[] = {1, e}, times[] = {1, tau};
    struct rc_err err = {""};

    assert_null(rc_relaxation_new(relaxed, 2, es, times, &err));
    if (strstr(err.text, words) == NULL)
        fail_msg("%s", err.text);
}

/* ---- a measured relaxation ---- */

enum {
    TIMES = 81
};

/* E(t) of published forms, with 10^7 Pa at first and 10^6 Pa at last. */
static double
zener(double t)
{
    return 1e6 + 9e6 * exp(-t / 0.037);
}

static double
kohlrausch(double t)
{
    return 1e6 + 9e6 * exp(-pow(t / 0.3, 0.45));
}

static double
prony(double t)
{
    return 1e6 + 4e6 * exp(-t / 2e-3) + 3e6 * exp(-t / 0.05) + 2e6 * exp(-t / 7);
}

/* Fits E(t) from 10^-4 s to 10^4 s; returns the largest relative error of the fit at other times. */
static double
worst_fit(double (*law)(double), double noise, double relaxed, double *misfit,
          struct rc_relaxation **fit)
{
    double t[TIMES], e[TIMES], worst = 0;
    struct rc_err err = {""};

    for (int i = 0; i < TIMES; i++) {
        t[i] = pow(10, -4 + 8. * i / (TIMES - 1));
        e[i] = law(t[i]) * (1 + noise * sin(17.3 * i * i));
    }
    *fit = rc_relaxation_fit_time(TIMES, t, e, relaxed, 0, misfit, &err);
    if (*fit == NULL)
        fail_msg("%s", err.text);
    for (double s = 1.3e-4; s < 1e4; s *= 1.37)
        worst = larger(worst, fabs(rc_relaxation_modulus(*fit, s) / law(s) - 1));
    return worst;
}

/* The fit of E(t) has also the storage and loss moduli of the law, where they have a formula. Of a single
 * time two neighbours of the quarter of a decade take the place. */
static void
measured_relaxation(void **state)
{
    static double (*const laws[])(double) = {zener, kohlrausch, prony};
    struct rc_relaxation *r;
    double misfit, em[2];

    (void)state;
    for (size_t k = 0; k < 3; k++) {
        assert_true(worst_fit(laws[k], 0, NAN, &misfit, &r) < 0.05);
        assert_true(misfit < 0.01);
        assert_true(fabs(r->relaxed / 1e6 - 1) < 0.01);
        for (size_t q = 0; q < r->terms; q++)
            assert_true(r->modulus[q] > 0);
        if (k == 0)
            for (double w = 1e-2; w < 1e3; w *= 3.3) {
                const double x = w * 0.037;
                rc_relaxation_dynamic(r, w, em, (double[2]){0});
                assert_true(fabs(em[0] / (1e6 + 9e6 * x * x / (1 + x * x)) - 1) < 0.03);
                if (x > 0.1 && x < 10)
                    assert_true(fabs(em[1] / (9e6 * x / (1 + x * x)) - 1) < 0.1);
            }
        rc_relaxation_free(r);
        /* noise of 5 % RMS is the misfit, and not in the fit */
        assert_true(worst_fit(laws[k], 0.0707, NAN, &misfit, &r) < 0.07);
        assert_true(fabs(misfit / 0.05 - 1) < 0.2);
        rc_relaxation_free(r);
        /* a given relaxed modulus is kept, also one of a fluid */
        worst_fit(laws[k], 0.01, 0.9e6, &misfit, &r);
        assert_true(r->relaxed == 0.9e6);
        rc_relaxation_free(r);
        worst_fit(laws[k], 0.01, 0, &misfit, &r);
        assert_true(r->relaxed == 0 && r->fluidity > 0);
        rc_relaxation_free(r);
    }
}

static void
refusals(void **state)
{
    const double w[] = {1, 2, 3, 2}, one[] = {1, 1, 1, 1}, lossless[] = {1, 0, 1, 1};
    const double zero = 0;
    double misfit;
    struct rc_err err = {""};

    (void)state;
    refused(-1, 1, 2, "relaxed modulus -1 Pa");
    refused(1, -1, 2, "modulus -1 Pa of a term");
    refused(1, 1, 0, "relaxation time 0 s");
    refused(1, 1, NAN, "relaxation time nan s");
    refused(1, 1, 1, "relaxation time 1 s: it must be given only once");
    assert_null(rc_relaxation_new(0, 1, &zero, one, &err));
    assert_non_null(strstr(err.text, "all moduli are 0"));
    assert_null(rc_relaxation_fit_time(4, w, one, NAN, 0, &misfit, &err));
    assert_non_null(strstr(err.text, "time 2 s: it must be given only once"));
    assert_null(rc_relaxation_fit_time(4, w, lossless, NAN, 0, &misfit, &err));
    assert_non_null(strstr(err.text, "modulus 0 Pa in line 2"));
    assert_null(rc_relaxation_fit_time(3, w, one, NAN, 0, &misfit, &err));
    assert_non_null(strstr(err.text, "3 times"));
    assert_null(rc_relaxation_fit_time(3, w, one, -1, 0, &misfit, &err));
    assert_non_null(strstr(err.text, "relaxed modulus -1 Pa"));
    assert_null(rc_relaxation_fit(3, w, one, one, 0, &misfit, &err));
    assert_non_null(strstr(err.text, "3 frequencies"));
    assert_null(rc_relaxation_fit(4, w, one, one, 0, &misfit, &err));
    assert_non_null(strstr(err.text, "2 rad/s: it must be given only once"));
    assert_null(rc_relaxation_fit(4, w, one, lossless, 0, &misfit, &err));
    assert_non_null(strstr(err.text, "loss modulus 0 in line 2"));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(product_over_20_decades),
        cmocka_unit_test(product_of_near_times),
        cmocka_unit_test(standard_solid),
        cmocka_unit_test(master_curve),
        cmocka_unit_test(sharp_terms),
        cmocka_unit_test(measured_relaxation),
        cmocka_unit_test(refusals),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
