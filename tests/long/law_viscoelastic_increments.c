/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The estimated error of viscoelastic pressures is above the error, for 60 random materials, histories and
 * rough maps, against eight times as many increments. Errors below 1e-6 do not count: the contacts of the
 * reference have a tolerance of 1e-7. Then for 60 more whose increments the model chooses, against 480; there
 * the estimate of the reference counts as its error. Prints the ratios. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

enum {
    NX = 32,
    N = NX * NX,
    POINTS = 5,
    PATHS = 60,
    TIMES = 8 /* increments of the reference over those of the run */
};
static const double glass = 1e9; /* Pa */
static double h[N], p[N], truth[POINTS][N], uncertain[POINTS];
static unsigned long long seed = 61;
static size_t points, missed; /* of the runs whose increments the model chooses */

static double
draw(double low, double high)
{
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

static struct rc_relaxation *
random_material(void)
{
    const size_t terms = (size_t)draw(1, 5.99);
    const double relaxed = draw(0, 1) < 0.2 ? 0 : glass * pow(10, draw(-2, -0.5));
    double modulus[5], time[5];
    struct rc_err err = {""};
    struct rc_relaxation *r;

    for (size_t k = 0; k < terms; k++) {
        modulus[k] = glass * draw(0.1, 1);
        time[k] = pow(10, draw(-2, 1.5));
    }
    if ((r = rc_relaxation_new(relaxed, terms, modulus, time, &err)) == NULL)
        fail_msg("%s", err.text);
    return r;
}

struct path {
    struct rc_boundary boundary;
    enum rc_axis axis;
    double value[POINTS], time[POINTS];
};

/* The first point is a jump or no load. Later ones rise, fall, hold or jump. */
static struct path
random_path(void)
{
    struct path a = {.boundary = draw(0, 1) < 0.5 ? RC_FREE : RC_PERIODIC,
                     .axis = draw(0, 1) < 0.3 ? RC_APPROACH : RC_LOAD};
    const double size = draw(0, 1); /* a periodic contact is complete from some 3e-7 m on */
    const double unit = a.axis == RC_LOAD ? pow(10, -2.5 + 1.5 * size) * 0.1 * glass * N * 1e-12
                        : rc_repeats(a.boundary) == 0 ? pow(10, -7 + size)
                                                      : pow(10, -7.5 + size / 2);

    a.value[0] = draw(0, 1) < 0.5 ? 0 : unit * draw(0.1, 1);
    for (int k = 1; k < POINTS; k++) {
        const double kind = draw(0, 1);
        a.value[k] = kind < 0.25 && a.value[k - 1] > 0 ? a.value[k - 1] : unit * draw(0.02, 1);
        a.time[k] = a.time[k - 1] + (kind > 0.9 && k > 1 ? 0 : pow(10, draw(-1.5, 1)));
    }
    return a;
}

/* The least estimate over error; the pressures go to `truth`, or are compared with it. */
static double
follow(const struct path *a, struct rc_relaxation *material, size_t increments, double tol,
       bool reference)
{
    const struct rc_shape s = {NX, NX, 1e-6, 1e-6};
    const struct rc_problem contact = {
        .boundary = a->boundary, .pair.estar = glass, .tol = 1e-7, .threads = 1};
    const struct rc_viscoelastic_problem law = {
        .material = material, .share = 1, .increments = increments, .tol = tol};
    const struct rc_viscoelastic_figures *f;
    struct rc_err err = {""};
    struct rc_model *m =
        rc_viscoelastic_new(rc_elastic_new(&s, h, &contact, NULL, &err), h, &law, &err);
    double worst = INFINITY;

    if (m == NULL)
        fail_msg("%s", err.text);
    for (int k = 0; k < POINTS; k++) {
        struct rc_point to = {0};
        rc_point_set(&to, a->axis, a->value[k]);
        rc_point_set(&to, RC_TIME, a->time[k]);
        if (rc_model_run(m, &to, &err) == RC_FAIL || rc_model_look(m, NULL, &err) != RC_OK ||
            rc_model_frame(m, "pressure", reference ? truth[k] : p, &err) != RC_OK ||
            rc_model_keep(m, &err) != RC_OK)
            fail_msg("%s", err.text);
        f = rc_viscoelastic_result(m);
        if (reference)
            uncertain[k] = f->increment_error;
        if (!reference && k > 0 && f->contact.contact_nodes > 0) {
            const double error = distance(N, p, truth[k]);
            const double of_all = f->contact.pressure_error + (increments == 0) * uncertain[k];
            if (error > 1e-6) {
                printf("%2zu increments, point %d at %8.3g s: error %8.2g, estimate over error "
                       "%.2f\n",
                       increments, k, a->time[k], error, f->increment_error / error);
                worst = fmin(worst, of_all / error);
            }
            points += increments == 0;
            missed += increments == 0 && f->increment_error > tol;
        }
    }
    rc_model_free(m);
    return worst;
}

static void
estimates(void **state)
{
    double worst = INFINITY;

    (void)state;
    for (int k = 0; k < 2 * PATHS; k++) {
        const struct rc_shape s = {NX, NX, 1e-6, 1e-6};
        const struct rc_selfaffine what = {.hurst = 0.8,
                                           .rms_slope = 0.1,
                                           .seed = (unsigned long)k,
                                           .long_cut = draw(12e-6, 32e-6),
                                           .short_cut = draw(3e-6, 8e-6)};
        struct rc_relaxation *material = random_material();
        const struct path a = random_path();
        const size_t increments = k % 3 == 0 ? 40 : k % 3 == 1 ? 20 : 10;
        struct rc_err err;
        assert_int_equal(rc_synth_selfaffine(&s, &what, h, &err), RC_OK);
        if (k < PATHS) {
            follow(&a, material, TIMES * increments, 0, true);
            worst = fmin(worst, follow(&a, material, increments, 0, false));
        } else {
            const double tol = k % 2 == 0 ? 0.01 : 0.003;
            follow(&a, material, 480, 0, true);
            worst = fmin(worst, follow(&a, material, 0, tol, false));
        }
        rc_relaxation_free(material);
    }
    printf("least estimate over error: %.2f; %zu of %zu chosen increments miss the tolerance\n",
           worst, missed, points);
    assert_true(worst >= 1);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(estimates)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
