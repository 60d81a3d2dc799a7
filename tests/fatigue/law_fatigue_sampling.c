/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sampling error of fatigue covers the true one below random rough contacts, at depths from half to eight
 * times the distance of nodes. The pressure of each contact is constant in its cells. The truth is the same
 * pressure on cells that are divided into five: each history then has five times as many states, of the same
 * stresses. Arguments: first seed, maps. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

enum {
    SIDE = 96,
    PARTS = 5, /* odd: the middle of a cell stays the middle of a part */
    FINE = SIDE * PARTS,
    DEPTHS = 5
};
static const double node = 1e-6;
static const double depth[DEPTHS] = {0.5e-6, 1e-6, 2e-6, 4e-6, 8e-6};
static const unsigned wanted =
    1U << RC_CROSSLAND | 1U << RC_DANG_VAN | 1U << RC_SHAKEDOWN | 1U << RC_AMPLITUDE;
static size_t first = 1, maps = 60;

static struct rc_fatigue *
pass_of(const struct rc_shape *shape, const double *const *p)
{
    const struct rc_fatigue_problem problem = {.stress = {.body.nu = 0.3, .threads = 1},
                                               .wanted = wanted,
                                               .pass = 'x',
                                               .cases = 1,
                                               .p = p};
    struct rc_err err = {""};
    struct rc_fatigue *f = rc_fatigue_new(shape, &problem, &err);

    if (f == NULL)
        fail_msg("%s", err.text);
    return f;
}

/* A free rough map under a load that differs from seed to seed. */
static void
press(size_t seed, const struct rc_shape *shape, double *h, struct solved *s)
{
    const double estar = 115e9, slope = 0.05, side = SIDE * node;
    const struct rc_selfaffine rough = {.hurst = 0.8,
                                        .seed = seed,
                                        .rms_slope = slope,
                                        .short_cut = (double)(4 << seed % 3) * node,
                                        .long_cut = side};
    const struct rc_problem problem = {.pair.estar = estar,
                                       .load = (0.04 + 0.06 * (double)(seed % 4)) * slope * estar *
                                               side * side,
                                       .tol = 1e-5,
                                       .threads = 1};
    struct rc_err err = {""};

    assert_int_equal(rc_synth_selfaffine(shape, &rough, h, &err), RC_OK);
    *s = solve(*shape, h, problem);
    assert_int_equal(s->status, RC_OK);
}

static void
sampling(void **state)
{
    const struct rc_shape shape = {SIDE, SIDE, node, node};
    const struct rc_shape divided = {FINE, FINE, node / PARTS, node / PARTS};
    double *h = malloc((size_t)(SIDE * SIDE + FINE * FINE) * sizeof *h), *fine = h + SIDE * SIDE;
    double values[RC_CRITERIA + 1][FINE], *out[RC_FATIGUES] = {NULL};
    const struct rc_fatigue_limits limits = {600e6, 372e6, 1e9};
    (void)state;

    for (size_t c = 0; c <= RC_CRITERIA; c++)
        out[c] = values[c];
    for (size_t seed = first; seed < first + maps; seed++) {
        struct solved s;
        struct rc_fatigue *few, *all;
        const double *p[1], *of_parts[] = {fine};
        struct rc_err err = {""};
        press(seed, &shape, h, &s);
        p[0] = s.p;
        for (size_t j = 0; j < FINE; j++)
            for (size_t i = 0; i < FINE; i++)
                fine[j * FINE + i] = s.p[j / PARTS * SIDE + i / PARTS];
        few = pass_of(&shape, p);
        all = pass_of(&divided, of_parts);
        for (size_t k = 0; k < DEPTHS; k++) {
            double *none[RC_FATIGUES] = {NULL};
            assert_int_equal(rc_fatigue_depth(few, depth[k], &limits, NULL, none, &err), RC_OK);
            assert_int_equal(rc_fatigue_depth(all, depth[k], &limits, NULL, out, &err), RC_OK);
            for (size_t c = 0; c <= RC_CRITERIA; c++) {
                const struct rc_fatigue_place *at = &rc_fatigue_at_depth(few)->largest[c];
                double truth = 0;
                for (size_t j = 0; wanted >> c & 1 && j < SIDE; j++) /* the rows of both grids */
                    truth = fmax(truth, values[c][j * PARTS + PARTS / 2]);
                if (wanted >> c & 1 && fabs(truth / at->value - 1) > at->sampling_error)
                    fail_msg("seed %zu, %g m, %s: error %.4f, estimate %.4f", seed, depth[k],
                             rc_criterion_names[c], fabs(truth / at->value - 1),
                             at->sampling_error);
            }
        }
        rc_fatigue_free(few);
        rc_fatigue_free(all);
        solved_free(&s);
    }
    free(h);
}

int
main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sampling)};

    first = argc > 1 ? strtoul(argv[1], NULL, 10) : first;
    maps = argc > 2 ? strtoul(argv[2], NULL, 10) : maps;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
