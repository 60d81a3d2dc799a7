/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bodies that yield under line contacts, on maps that repeat along one axis. Known results: where and under
 * which load a cylinder begins to yield, and its mean pressure in the fully plastic state. The estimated
 * error of the images is not below the error. Equal rows are one row, and a turned map gives the turned
 * pressure. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "libcontact/yield/yield.h"
#include "tests/volume/volume_case.h"

static const double nu = 0.3;
static const struct rc_boundary along_x = {.x = true}, along_y = {.y = true};

static struct rc_yield_solver *
pressed(struct rc_shape shape, const double *h, struct rc_yield_problem problem, double load)
{
    struct rc_yield_solver *plastic;
    enum rc_status status;
    struct rc_err err;

    problem.contact.pair = (struct rc_pair){.one = {.e = 1, .nu = nu}, .two.e = INFINITY};
    problem.contact.threads = 1;
    problem.contact.tol = problem.contact.tol > 0 ? problem.contact.tol : 1e-5;
    plastic = rc_yield_solver_new(&shape, h, &problem, &err);
    if (plastic == NULL)
        print_error("%s\n", err.text);
    assert_non_null(plastic);
    assert_int_equal(rc_yield_solver_set_load(plastic, load, &err), RC_OK);
    while ((status = rc_yield_solver_step(plastic, &err)) == RC_MORE)
        ;
    assert_int_equal(status, RC_OK);
    return plastic;
}

enum {
    SLABS = 14,
    WIDE = 32,
    TIMES = 4,
    LONG = 96,
    ALL = WIDE * TIMES * LONG
};

/* A cylinder along y or a ball, with waves along y or roughness. */
struct body {
    size_t rows;
    double radius;         /* of curvature across y */
    double crown;          /* curvature along y over that across it */
    double waves;          /* height of two waves along y */
    double rough;          /* rms slope */
    double off;            /* place of the middle */
    double yield, harden;  /* over E */
    double spot;           /* half of the expected width of the contact, in nodes */
    struct rc_shape shape; /* of the map that was solved */
};

/* Between 0 and 1. */
static double
random_part(uint64_t *seed)
{
    return (random_number(seed) + 1) / 2;
}

static struct body
random_body(uint64_t seed)
{
    static const size_t rows[] = {1, 4, 12, 24, 32, 48, 64, 96};
    const size_t kind = seed % 4;
    struct body b;

    for (int k = 0; k < 9; k++)
        (void)random_number(&seed);
    b = (struct body){.rows = rows[(size_t)(7.99 * random_part(&seed))],
                      .radius = 40 + 60 * random_part(&seed),
                      .off = 4 * random_number(&seed),
                      .yield = 0.006 * pow(6, random_part(&seed)),
                      .harden = 0.05 * random_part(&seed),
                      .spot = 2.5 * pow(4, random_part(&seed))};
    if (kind == 1 && b.rows > 4)
        b.crown = pow(0.03, random_part(&seed));
    if (kind == 2 && b.rows > 4)
        b.waves = 0.2 * random_part(&seed);
    if (kind == 3)
        b.rough = 0.08 * random_part(&seed);
    return b;
}

/* Heights of a map that is `wide` nodes wide. The roughness covers the same nodes on all. */
static void
heights(const struct body *b, size_t wide, uint64_t seed, double *h)
{
    static double rough[LONG * LONG];
    const struct rc_shape square = {LONG, LONG, 1, 1};
    const struct rc_selfaffine what = {
        .hurst = 0.8, .rms_slope = b->rough, .short_cut = 6, .rolloff = 16, .seed = seed};
    struct rc_err err;

    if (b->rough > 0)
        assert_int_equal(rc_synth_selfaffine(&square, &what, rough, &err), RC_OK);
    for (size_t j = 0; j < b->rows; j++)
        for (size_t i = 0; i < wide; i++) {
            double x = (double)i - (double)(wide - 1) / 2 - b->off;
            double y = (double)j - (double)(b->rows - 1) / 2 - 0.2;
            size_t at = i + LONG - wide / 2; /* the same column of the roughness */
            h[j * wide + i] = -(x * x + b->crown * y * y) / (2 * b->radius) +
                              b->waves * cos(4 * exact_pi * y / (double)b->rows);
            if (b->rough > 0)
                h[j * wide + i] += rough[j * LONG + at % LONG];
        }
}

static struct rc_yield_solver *
press_body(struct body *b, size_t wide, uint64_t seed)
{
    static double h[ALL];
    double thickness[SLABS];
    const double length =
        b->crown > 0 ? fmin(b->spot / sqrt(b->crown), (double)b->rows / 2) : (double)b->rows / 2;
    const struct rc_yield_problem problem = {.contact.boundary = along_y,
                                             .law = {.stress = b->yield, .modulus = b->harden},
                                             .slabs = SLABS,
                                             .thickness = thickness,
                                             .increments = 16};

    for (size_t k = 0; k < SLABS; k++)
        thickness[k] = 0.5 * pow(1.2, (double)k);
    heights(b, wide, seed, h);
    b->shape = (struct rc_shape){wide, b->rows, 1, 1};
    return pressed(b->shape, h, problem, 2 * b->yield * 2 * b->spot * 2 * length);
}

/* The map, and one of TIMES its width. Two runs stop at different numbers of iterations, which differ by a
 * small part of the error of the increments. */
static void
images_are_known(void **state)
{
    double least = INFINITY, sum = 0, most = 0;
    size_t count = 0;

    (void)state;
    for (uint64_t seed = 1; seed <= thorough(240, 8); seed++) {
        struct body b = random_body(seed);
        struct rc_yield_solver *small = press_body(&b, WIDE, seed),
                               *large = press_body(&b, WIDE * TIMES, seed);
        const double said = small->figures.image_error;
        double off = 0, all = 0;

        for (size_t j = 0; j < b.rows; j++)
            for (size_t i = 0; i < WIDE; i++) {
                double p = rc_solver_pressure(small->solver)[j * WIDE + i];
                double q = rc_solver_pressure(
                    large->solver)[j * WIDE * TIMES + i + (TIMES - 1) * WIDE / 2];
                off += fabs(p - q);
                all += q;
            }
        off /= all;
        if (small->figures.voxels > 0) {
            least = fmin(least, said / off);
            sum += log(said / off);
            most = fmax(most, said);
            count++;
        }
        rc_yield_solver_free(small);
        rc_yield_solver_free(large);
    }
    print_message(
        "images of %zu bodies: at least %.2f of the error, %.1f in the mean, at most %.1e\n", count,
        least, exp(sum / (double)count), most);
    assert_true(least >= 1 && exp(sum / (double)count) < 10);
}

/* ---- known results ---- */

/* Presses a cylinder to a contact of 2 a nodes, elastic; returns the voxels that yield, and their mean depth
 * over a. */
static size_t
begins(double a, double part, double *depth)
{
    enum {
        THIN = 24,
        SIDE = 96
    };
    double h[SIDE], thickness[THIN], map[SIDE], z = 0, sum = 0;
    double *const to[RC_YIELD_STRAINS] = {[RC_PEEQ] = map};
    const double radius = 40 * a, p0 = a / (1 - nu * nu) / (2 * radius);
    /* p0 = 1.79 Y, .70 a deep (Johnson 1985, 4.49, von Mises, plane strain, nu .3) */
    const struct rc_yield_problem problem = {.contact.boundary = along_y,
                                             .law.stress = p0 / 1.793 / part,
                                             .slabs = THIN,
                                             .thickness = thickness,
                                             .increments = 1};
    struct rc_yield_solver *plastic;
    size_t count = 0;

    for (size_t k = 0; k < THIN; k++)
        thickness[k] = a / 16;
    for (size_t i = 0; i < SIDE; i++)
        h[i] = -pow((double)i - (SIDE - 1) / 2.0, 2) / (2 * radius);
    plastic = pressed((struct rc_shape){SIDE, 1, 1, 1}, h, problem, exact_pi * a * p0 / 2);
    for (size_t k = 0; k < THIN; k++, z += a / 16) {
        rc_yield_solver_strain(plastic, k, to);
        for (size_t i = 0; i < SIDE; i++)
            if (map[i] > 0) {
                count++;
                sum += z + a / 32;
            }
    }
    *depth = sum / (double)count / a;
    rc_yield_solver_free(plastic);
    return count;
}

/* Half of the map is in contact. */
static void
onset_of_a_cylinder(void **state)
{
    double depth;
    size_t none = begins(24, 0.99, &depth), some = begins(24, 1.01, &depth);

    (void)state;
    print_message("%zu voxels at 0.99 of p0 = 1.79 Y, %zu at 1.01 of it, %.2f a deep (0.70)\n",
                  none, some, depth);
    assert_int_equal(none, 0);
    assert_true(some > 0 && fabs(depth - 0.70) < 0.1);
}

/* Without hardening the mean pressure tends to that of the slip-line field of Prandtl, (2 + pi) Y/sqrt(3), as
 * the strain a/R grows beyond Y/E. The width is known to half a node at each edge. */
static void
full_plasticity_of_a_cylinder(void **state)
{
    enum {
        SIDE = 64
    };
    const double yield = 4e-4, radius = 200, limit = (2 + exact_pi) / sqrt(3);
    double h[SIDE], thickness[SLABS], last = 0, mean = 0;

    (void)state;
    for (size_t k = 0; k < SLABS; k++)
        thickness[k] = pow(1.2, (double)k);
    for (size_t i = 0; i < SIDE; i++)
        h[i] = -pow((double)i - (SIDE - 1) / 2.0, 2) / (2 * radius);
    for (int wide = 6; wide <= 18; wide += 12) {
        const struct rc_yield_problem problem = {.contact.boundary = along_y,
                                                 .law.stress = yield,
                                                 .slabs = SLABS,
                                                 .thickness = thickness,
                                                 .increments = 16};
        struct rc_yield_solver *plastic =
            pressed((struct rc_shape){SIDE, 1, 1, 1}, h, problem, 3 * yield * wide);
        const double *p = rc_solver_pressure(plastic->solver);
        double load = rc_sum(p, SIDE);
        size_t touching = 0;

        for (size_t i = 0; i < SIDE; i++)
            touching += p[i] > 0;
        mean = load / (double)touching / yield;
        print_message("E* a/(R Y) %.0f: %zu nodes, mean pressure %.2f Y (%.2f)\n",
                      (double)touching / 2 / (1 - nu * nu) / radius / yield, touching, mean, limit);
        last = (double)touching;
        rc_yield_solver_free(plastic);
    }
    assert_true(fabs(mean / limit - 1) < 1 / last);
}

/* ---- laws ---- */

static void
equal_rows_are_one_row(void **state)
{
    struct body b = {
        .rows = 1, .radius = 60, .off = 1.3, .yield = 0.015, .harden = 0.02, .spot = 6};
    struct rc_yield_solver *one = press_body(&b, WIDE, 1), *rows;
    double off = 0, bend = 0;

    (void)state;
    b.rows = 7;
    rows = press_body(&b, WIDE, 1);
    for (size_t k = 0; k < 7 * (size_t)WIDE; k++) {
        off = fmax(off, fabs(rc_solver_pressure(rows->solver)[k] -
                             rc_solver_pressure(one->solver)[k % WIDE]));
        bend = fmax(bend, fabs(rows->maps.u[k] - one->maps.u[k % WIDE]));
    }
    print_message("rows: pressure %.1e Y, displacement %.1e apart\n", off / b.yield, bend);
    assert_true(one->figures.voxels > 50 && rows->figures.voxels == 7 * one->figures.voxels);
    assert_true(off < 1e-3 * b.yield && bend < 1e-4);
    rc_yield_solver_free(one);
    rc_yield_solver_free(rows);
}

static void
turned_maps_give_turned_pressures(void **state)
{
    enum {
        ROWS = 24,
        NODES = ROWS * WIDE
    };
    static double h[NODES], turned[NODES];
    struct body b = {.rows = ROWS, .radius = 70, .rough = 0.05, .off = 1};
    double thickness[SLABS], off = 0;
    struct rc_yield_solver *plastic[2];

    (void)state;
    heights(&b, WIDE, 5, h);
    for (size_t k = 0; k < SLABS; k++)
        thickness[k] = 0.5 * pow(1.2, (double)k);
    for (size_t k = 0; k < NODES; k++)
        turned[k % WIDE * ROWS + k / WIDE] = h[k];
    for (int k = 0; k < 2; k++) {
        const struct rc_yield_problem problem = {.contact.boundary = k == 0 ? along_y : along_x,
                                                 .law = {.stress = 0.01, .modulus = 0.02},
                                                 .slabs = SLABS,
                                                 .thickness = thickness,
                                                 .increments = 8};
        plastic[k] = pressed(k == 0 ? (struct rc_shape){WIDE, ROWS, 1, 1}
                                    : (struct rc_shape){ROWS, WIDE, 1, 1},
                             k == 0 ? h : turned, problem, 0.02 * 10 * ROWS);
    }
    for (size_t k = 0; k < NODES; k++)
        off = fmax(off, fabs(rc_solver_pressure(plastic[0]->solver)[k] -
                             rc_solver_pressure(plastic[1]->solver)[k % WIDE * ROWS + k / WIDE]));
    print_message("turned: pressure %.1e Y apart, images %.2e and %.2e\n", off / 0.01,
                  plastic[0]->figures.image_error, plastic[1]->figures.image_error);
    assert_true(plastic[0]->figures.voxels > 100 && off < 0.01 * 0.01);
    assert_true(fabs(plastic[0]->figures.image_error / plastic[1]->figures.image_error - 1) < 0.01);
    rc_yield_solver_free(plastic[0]);
    rc_yield_solver_free(plastic[1]);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_are_known),
        cmocka_unit_test(onset_of_a_cylinder),
        cmocka_unit_test(full_plasticity_of_a_cylinder),
        cmocka_unit_test(equal_rows_are_one_row),
        cmocka_unit_test(turned_maps_give_turned_pressures),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
