/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Repeated passes over a body that yields, without hardening. A line contact shakes down below p0 = 4 k
 * (Johnson 1962) and ratchets above. A ball does so at 4.68 k, which its groove raises in a few passes.
 * Plastic work never falls. A contact that travels the other way leaves the mirror image of the strain.
 * The estimated error of the steps is above the difference from much shorter steps. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

enum {
    NX = 64,   /* nodes of the period of a line contact, */
    BALL = 48, /* of that of a ball, along both sides,   */
    HALF = 8   /* and of the half width of the contact   */
};
static const double node = 1e-6, e1 = 200e9, nu = 0.3, yield = 1e9;
static const double flat[BALL * BALL];

struct line {
    struct rc_model *m;
    double load, work;
    size_t nx, ny;
};

/* A line contact, or a ball if ny is above 1. */
static struct line
contact(double p0_over_k, size_t nx, size_t ny)
{
    const struct rc_shape s = {nx, ny, node, node};
    const double p0 = p0_over_k * yield / sqrt(3), estar = e1 / (1 - nu * nu), a = HALF * node;
    const double pi = acos(-1), line_load = pi * a * p0 / 2 * node;
    const struct rc_yield_problem problem = {
        .contact = {.boundary = RC_PERIODIC,
                    .pair = {.one = {e1, nu}, .two.e = INFINITY},
                    .threads = 1},
        .law = {.stress = yield}};
    const struct rc_travel_problem travel = {.track = s,
                                             .h1 = flat,
                                             .repeats = true,
                                             .radius = ny == 1 ? a * estar / (2 * p0)
                                                               : 2 * a * estar / (pi * p0)};
    struct line line = {.load = ny == 1 ? line_load : pi * a * a * p0 * 2 / 3, .nx = nx, .ny = ny};
    struct rc_err err = {""};

    line.m = rc_travel_new(rc_yield_new(&s, flat, &problem, &err), &travel, &err);
    if (line.m == NULL)
        fail_msg("%s", err.text);
    return line;
}

static struct line
line_contact(double p0_over_k)
{
    return contact(p0_over_k, NX, 1);
}

static void
move(struct line *line, double nodes)
{
    struct rc_point to = {0};
    struct rc_err err = {""};
    double work;

    rc_point_set(&to, RC_LOAD, line->load);
    rc_point_set(&to, RC_POSITION, nodes * node);
    if (rc_model_run(line->m, &to, &err) == RC_FAIL ||
        rc_model_look(line->m, NULL, &err) != RC_OK || rc_model_keep(line->m, &err) != RC_OK)
        fail_msg("position %g: %s", nodes, err.text);
    work = rc_yield_result(line->m)->last.work;
    assert_true(work >= line->work * (1 - 1e-12));
    line->work = work;
}

/* A pass in steps of so many nodes: the largest gain, over Y/E, of the mean equivalent strain of a row of a
 * slab. */
static double
pass(struct line *line, double step, double *mean)
{
    double peeq[BALL * BALL], *to[RC_YIELD_STRAINS] = {NULL}, most = 0;

    for (size_t k = 0; (double)k * step < (double)line->nx - 1e-9; k++)
        move(line, (double)k * step - (double)line->nx / 2);
    to[RC_PEEQ] = peeq;
    for (size_t q = 0; rc_yield_strain(line->m, q, to); q++)
        for (size_t j = 0; j < line->ny; j++) {
            double *row = &mean[q * line->ny + j], before = *row;
            *row = 0;
            for (size_t k = 0; k < line->nx; k++)
                *row += peeq[j * line->nx + k] / (double)line->nx;
            most = fmax(most, *row - before);
        }
    return most * e1 / yield;
}

static void
shakedown_limit(void **state)
{
    static const double ratio[] = {3.64, 3.94, 4.45}; /* p0/k; the limit is 4 */
    double gain[3][3];

    (void)state;
    for (size_t r = 0; r < 3; r++) {
        struct line line = line_contact(ratio[r]);
        double mean[64] = {0};
        for (size_t k = 0; k < 3; k++)
            gain[r][k] = pass(&line, 2, mean);
        print_message("p0/k %g: %.3g %.3g %.3g\n", ratio[r], gain[r][0], gain[r][1], gain[r][2]);
        rc_model_free(line.m);
    }
    assert_true(gain[0][1] < 0.01 * gain[0][0]);
    assert_true(gain[1][1] < 0.1 * gain[1][0] && gain[1][2] < 0.7 * gain[1][1]);
    assert_true(gain[2][2] > 0.9 * gain[2][1] && gain[2][2] > 1);
}

/* A ball rolls in the groove that it makes. Its limit is p0 = 4.68 k; the groove carries more than the first
 * contact did, so that passes at 5.2 k shake down too. */
static void
shakedown_of_a_ball(void **state)
{
    static const struct {
        double ratio; /* p0/k */
        bool shakes_down;
    } ball[] = {{4.4, true}, {8, false}, {5.2, true}, {6, false}};
    const size_t passes = thorough(8, 3);

    (void)state;
    for (size_t r = 0; r < thorough(4, 2); r++) {
        struct line line = contact(ball[r].ratio, BALL, BALL);
        double mean[64 * BALL] = {0}, first = 0, last = 0;
        for (size_t k = 0; k < passes; k++) {
            last = pass(&line, 2, mean);
            first = k == 0 ? last : first;
        }
        print_message("ball, p0/k %g: %.3g, at last %.3g\n", ball[r].ratio, first, last);
        rc_model_free(line.m);
        assert_true(ball[r].shakes_down ? last < 0.02 * first : last > 0.08 * first);
    }
}

static void
strain_of(const struct line *line, size_t slab, double *exx)
{
    double *to[RC_YIELD_STRAINS] = {exx};

    assert_true(rc_yield_strain(line->m, slab, to));
}

static void
mirror_image(void **state)
{
    struct line there = line_contact(4.2), back = line_contact(4.2);
    double a[NX], b[NX], off = 0, most = 0;

    (void)state;
    for (int x = -10; x <= 10; x += 2) {
        move(&there, x);
        move(&back, -x);
    }
    for (size_t q = 0; q < rc_yield_result(there.m)->slabs; q++) {
        strain_of(&there, q, a);
        strain_of(&back, q, b);
        for (size_t k = 0; k < NX; k++) {
            most = fmax(most, fabs(a[k]));
            off = fmax(off, fabs(a[k] - b[NX - 1 - k]));
        }
    }
    assert_true(most > 0.1 * yield / e1);
    if (off > 1e-3 * most)
        fail_msg("strains off by %g of the largest", off / most);
    rc_model_free(there.m);
    rc_model_free(back.m);
}

/* At x = 12 nodes after a way of 24. */
static void
way(double step, double *p, double *error)
{
    struct line line = line_contact(4.45);
    struct rc_err err = {""};

    for (double x = -12; x <= 12 + 1e-9; x += step)
        move(&line, x);
    assert_int_equal(rc_model_frame(line.m, "pressure", p, &err), RC_OK);
    *error = rc_yield_result(line.m)->last.error;
    rc_model_free(line.m);
}

static void
error_of_the_steps(void **state)
{
    static double fine[NX], p[NX];
    double error;

    (void)state;
    way(0.25, fine, &error);
    for (double step = 1; step <= 4; step *= 2) {
        double off = 0, sum = 0;
        way(step, p, &error);
        for (size_t k = 0; k < NX; k++) {
            off += fabs(p[k] - fine[k]);
            sum += fine[k];
        }
        print_message("step %g: error %.3g, estimated %.3g\n", step, off / sum, error);
        assert_true(error >= off / sum && error < 12 * off / sum);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shakedown_limit), cmocka_unit_test(shakedown_of_a_ball),
        cmocka_unit_test(mirror_image), cmocka_unit_test(error_of_the_steps)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
