/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rough periodic maps wear over four decades of distance under the usual tolerance of rc-wear. Worn depth,
 * pressure, largest pressure and contact area are compared with those of a reference run. Its tolerance is
 * 100 times smaller, and its contacts are 1000 times more accurate.
 *
 *     law_wear_rough [SIDE ...]        sides of the map in nodes (default 128)
 *
 * The distances are counted in dx/(k E*). Hurst exponent 0.8, RMS slope 0.1, rolled off at a quarter of the
 * side, shortest wave 8 nodes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

enum {
    LOADS = 3,
    OUTPUTS = 4,
    SEEDS = 2,
    MOST_SIDES = 8
};
static const double estar = 1e9, node = 1e-6, k_wear = 1e-15;
static const double mean[LOADS] = {0.002, 0.005, 0.02}; /* mean pressures in units of E* */
static const double at[OUTPUTS] = {1, 10, 100, 1000};   /* in dx/(k E*)     */
static const double usual = 0.1, finer = 100, finer_contacts = 1000;
/* Relative L1 errors. */
static const double most_wear = 5e-3, most_pressure = 2e-2;
static const double most_area = 0.01;
/* On maps above 256 x 256 nodes the contacts before an output are more accurate. */
static const double most_convolutions = 274, on_large_maps = 294;
static const double most_peak = 0.05;

static size_t side[MOST_SIDES] = {128}, sides = 1;

struct worn {
    double p, wear, peak, area; /* relative errors */
};

struct sliding {
    struct rc_model *m;
    size_t n;
    double *p, *wear;
};

static struct sliding
start(const struct rc_shape *s, const double *h, double tol, double contacts)
{
    const struct rc_problem contact = {
        .boundary = RC_PERIODIC, .pair.estar = estar, .tol = contacts, .threads = 1};
    const struct rc_wear_problem law = {.k = {k_wear, 0}, .estar = estar, .tol = tol};
    const size_t n = s->nx * s->ny;
    struct rc_err err = {""};
    struct sliding r = {.n = n, .p = calloc(2 * n, sizeof *r.p)};

    r.wear = r.p + n;
    r.m = rc_wear_new(rc_elastic_new(s, h, &contact, NULL, &err), h, &law, &err);
    if (r.m == NULL)
        fail_msg("%s", err.text);
    return r;
}

static void
slide(struct sliding *r, double load, double distance)
{
    struct rc_err err = {""};
    struct rc_point to = {0};

    rc_point_set(&to, RC_LOAD, load);
    rc_point_set(&to, RC_DISTANCE, distance);
    if (rc_model_run(r->m, &to, &err) == RC_FAIL || rc_model_look(r->m, NULL, &err) != RC_OK ||
        rc_model_frame(r->m, "pressure", r->p, &err) != RC_OK ||
        rc_model_frame(r->m, "wear", r->wear, &err) != RC_OK || rc_model_keep(r->m, &err) != RC_OK)
        fail_msg("%g m: %s", distance, err.text);
}

static double
differ(size_t n, const double *a, const double *b)
{
    double off = 0, size = 0;

    for (size_t k = 0; k < n; k++) {
        off += fabs(a[k] - b[k]);
        size += fabs(b[k]);
    }
    return off / size;
}

static struct worn
compare(const struct sliding *r, const struct sliding *fine)
{
    struct worn e = {.p = differ(r->n, r->p, fine->p), .wear = differ(r->n, r->wear, fine->wear)};

    e.peak =
        fabs(rc_model_number(r->m, "max_pressure") / rc_model_number(fine->m, "max_pressure") - 1);
    e.area =
        fabs(rc_model_number(r->m, "contact_area") / rc_model_number(fine->m, "contact_area") - 1);
    return e;
}

/* One map under one load. */
static void
wear_map(const struct rc_shape *s, const double *h, double part, unsigned seed, struct worn *worst)
{
    const double load = part * estar * s->dx * s->dy * (double)(s->nx * s->ny);
    struct sliding r = start(s, h, usual, usual / 100),
                   fine = start(s, h, usual / finer, usual / 100 / finer_contacts);
    const struct rc_wear_figures *f = rc_wear_result(r.m);

    for (int q = 0; q < OUTPUTS; q++) {
        const double distance = at[q] * node / (k_wear * estar);
        struct worn e;
        slide(&r, load, distance);
        slide(&fine, load, distance);
        e = compare(&r, &fine);
        print_message(
            "%zu, seed %u, p/E* %g, s %g: area %.3f, errors: wear %.1e (estimated %.1e), p %.1e "
            "(%.1e), max p %.1e (%.1e), area %.1e\n",
            s->nx, seed, part, at[q], rc_model_number(fine.m, "contact_fraction"), e.wear,
            f->wear_error, e.p, f->pressure_error, e.peak, f->max_pressure_error, e.area);
        assert_true(f->wear_error >= e.wear && f->pressure_error >= e.p);
        assert_true(f->max_pressure_error >= e.peak);
        *worst = (struct worn){.p = fmax(worst->p, e.p),
                               .wear = fmax(worst->wear, e.wear),
                               .peak = fmax(worst->peak, e.peak),
                               .area = fmax(worst->area, e.area)};
    }
    print_message("    %zu steps, %zu contacts, %.0f convolutions; the fine run: %zu steps, %.0f\n",
                  f->steps, f->contacts, f->convolutions, rc_wear_result(fine.m)->steps,
                  rc_wear_result(fine.m)->convolutions);
    assert_true(f->convolutions <= (s->nx > 256 ? on_large_maps : most_convolutions));
    rc_model_free(r.m);
    rc_model_free(fine.m);
    free(r.p);
    free(fine.p);
}

static void
rough_maps(void **state)
{
    (void)state;
    for (size_t k = 0; k < sides; k++) {
        const struct rc_shape s = {side[k], side[k], node, node};
        double *h = calloc(side[k] * side[k], sizeof *h);
        struct worn worst = {0};
        for (unsigned seed = 1; seed <= SEEDS; seed++) {
            const struct rc_selfaffine rough = {.hurst = 0.8,
                                                .rms_slope = 0.1,
                                                .rolloff = (double)side[k] / 4 * node,
                                                .short_cut = 8 * node,
                                                .seed = seed};
            assert_int_equal(rc_synth_selfaffine(&s, &rough, h, NULL), RC_OK);
            for (int q = 0; q < LOADS; q++)
                wear_map(&s, h, mean[q], seed, &worst);
        }
        print_message("%zu x %zu, at worst: wear %.1e, p %.1e, max p %.1e, area %.1e\n", side[k],
                      side[k], worst.wear, worst.p, worst.peak, worst.area);
        assert_true(worst.wear <= most_wear && worst.p <= most_pressure);
        assert_true(worst.peak <= most_peak && worst.area <= most_area);
        free(h);
    }
}

int
main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rough_maps),
    };

    for (int k = 1; k < argc && k <= MOST_SIDES; k++)
        side[k - 1] = (size_t)strtoul(argv[k], NULL, 10);
    sides = argc > 1 ? (size_t)argc - 1 : 1;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
