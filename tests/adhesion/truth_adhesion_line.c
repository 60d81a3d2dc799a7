/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Adhesion on maps that repeat along one axis: cylinders against closed forms, for cohesive zones of constant
 * traction and for the limit of short ranges. A map of equal rows is one row, a turned map gives the turned
 * state, and balls far apart are balls. The datum only changes approaches. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "adhesion_case.h"

/* ---- a cylinder with a cohesive zone ---- */

static const double radius = 1.1e-3, estar = 2.3e6, work = 0.05, width = 256e-6, datum = 0.7e-3;

/* A parabola presses the strip |x| < a, and a constant traction s pulls at a < |x| < c. The pressure is
 * that of flat punches of all half-widths t, with the loads f(t) dt (Hill and Storakers 1990): f = pi
 * E* t/(2 R) up to a, because the slope of the surface is -x/R there, and -2 s t/sqrt(c^2 - t^2)
 * beyond, which Abel's equation gives for a constant traction. All loads are per length of the
 * cylinder. */
struct zone {
    double load, approach, outer;
};

/* The gap at c. */
static double
opening(double a, double m, double strength)
{
    const double root = sqrt(m * m - 1);

    return a * a / (2 * radius) * (m * root - acosh(m)) +
           4 * strength * a / (exact_pi * estar) * (root * acosh(m) - m * log(m));
}

static struct zone
zone_of(double a, double range)
{
    enum {
        PARTS = 2000
    };
    const double strength = work / range;
    double low = 1, high = 2, root, pulls = 0, presses;
    struct zone z;

    while (opening(a, high, strength) < range)
        high *= 2;
    for (int k = 0; k < 100; k++)
        *(opening(a, (low + high) / 2, strength) < range ? &low : &high) = (low + high) / 2;
    z.outer = low * a;
    root = sqrt(z.outer * z.outer - a * a);
    z.load = exact_pi * estar * a * a / (4 * radius) - 2 * strength * root;
    /* a punch of half-width t displaces by 2/(pi E*) ln(2 datum/t) of its load; v = sqrt(c^2 - t^2) */
    presses = exact_pi * estar / (2 * radius) * a * a * (log(2 * datum / a) / 2 + 0.25);
    for (int k = 0; k < PARTS; k++) {
        double v = root * (k + 0.5) / PARTS;
        pulls += 2 * strength * root / PARTS * log(2 * datum / sqrt(z.outer * z.outer - v * v));
    }
    z.approach = 2 / (exact_pi * estar) * (presses - pulls);
    return z;
}

/* The lowest load, by golden sections. */
static struct zone
lowest(double range)
{
    const double ratio = (sqrt(5) - 1) / 2;
    double low = 1e-7, high = width / 4;

    while (high - low > 1e-9) {
        double part = ratio * (high - low);
        if (zone_of(high - part, range).load < zone_of(low + part, range).load)
            high = low + part;
        else
            low = high - part;
    }
    return zone_of((low + high) / 2, range);
}

/* The limit of short ranges: the singular pressure -P1/(pi sqrt(a^2 - x^2)) has the energy release rate
 * P1^2/(2 pi E* a) = w, so that P = pi E* a^2/(4 R) - sqrt(2 pi E* w a) (Barquins 1988; Chaudhury, Weaver,
 * Hui and Kramer 1996). Its minimum is at a = (2 w R^2/(pi E*))^(1/3). */
static double
pull_off_of_short_range(void)
{
    return -0.75 * cbrt(4 * exact_pi * estar * work * work * radius);
}

/* `along`: the axis of the cylinder; `apex`: its place in the cell, in nodes. */
static struct rc_adhesion_solver *
cylinder(size_t n, size_t rows, enum rc_map_axis along, const char *law, double range, double apex,
         double **h)
{
    const double d = width / (double)n;
    const struct rc_shape shape = along == RC_Y ? (struct rc_shape){n, rows, d, 1.3 * d}
                                                : (struct rc_shape){rows, n, 1.3 * d, d};
    const struct rc_adhesion_problem problem = {
        .contact = {.boundary = {.x = along == RC_X, .y = along == RC_Y, .datum = datum},
                    .pair.estar = estar,
                    .tol = 1e-4},
        .work = work,
        .law = law,
        .range = range};

    *h = calloc(n * rows, sizeof **h);
    assert_non_null(*h);
    for (size_t k = 0; k < n * rows; k++) {
        double x = ((double)(along == RC_Y ? k % n : k / rows) - (double)(n - 1) / 2 - apex) * d;
        (*h)[k] = -x * x / (2 * radius);
    }
    return adhesion_new(shape, *h, problem);
}

static double
period(size_t n, size_t rows)
{
    return 1.3 * width / (double)n * (double)rows;
}

/* Errors of the grid: of the loads and of the pull-off load, over the latter. */
static const struct {
    double range, load, pull_off;
    size_t n;
} rows[] = {{4e-6, 2e-4, 2e-4, 256}, {2e-6, 1e-4, 4e-4, 512}, {1e-6, 1e-3, 1e-3, 512}};

static void
cylinder_of_maugis(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int axis = 0; axis < 2; axis++) {
            const double range = rows[k].range, d = width / (double)rows[k].n,
                         unit = fabs(lowest(range).load), length = period(rows[k].n, 3);
            double *h, worst = 0, wide = 0, least;
            struct rc_adhesion_solver *path =
                cylinder(rows[k].n, 3, axis == 0 ? RC_Y : RC_X, "dugdale", range, 0.2, &h);
            const struct rc_adhesion_state *f;

            for (int step = 0; step < 6; step++) {
                const double a = (60 - 6 * step) * 1e-6;
                const struct zone z = zone_of(a, range);
                f = adhesion_to_approach(path, z.approach);
                assert_true(f->converged && f->stable);
                worst = fmax(worst, fabs(f->load / length - z.load) / unit);
                wide = fmax(wide, fabs(f->contact_area / length / 2 - a) / d);
            }
            f = adhesion_pull(path);
            least = f->pull_off_load / length;
            print_message(
                "range %g um: loads within %.1e of the pull-off load, half-widths within "
                "%.2f nodes; pull-off %+.1e, spread %.1e, %zu states, %.0f convolutions\n",
                range * 1e6, worst, wide, least / -unit - 1, f->pull_off_spread / length / unit,
                f->states, f->convolutions);
            assert_true(f->converged);
            assert_true(worst <= rows[k].load && wide <= 1);
            assert_true(fabs(least / -unit - 1) <= rows[k].pull_off);
            assert_true(f->pull_off_spread / length <= 0.01 * unit);
            rc_adhesion_solver_free(path);
            free(h);
        }
}

/* The law jkr: the shorter the range, the nearer is the load of this limit. */
static void
cylinder_of_short_range(void **state)
{
    const double exact = pull_off_of_short_range();

    (void)state;
    for (size_t n = 128; n <= 1024; n *= 2) {
        double *h, off;
        struct rc_adhesion_solver *path = cylinder(n, 1, RC_Y, "jkr", 0, 0.2, &h);

        (void)adhesion_to_approach(path, 0);
        off = adhesion_pull(path)->pull_off_load / period(n, 1) / exact - 1;
        print_message("jkr, %zu nodes: %+.4f\n", n, off);
        assert_true(fabs(off) <= 2.0 / (double)n);
        rc_adhesion_solver_free(path);
        free(h);
    }
}

/* As nodes of a line separate together, the load over the approach is a saw on grids that resolve the
 * law too. The result differs from the lowest load of a path in small steps by at most the reported
 * spread. */
static void
spread_holds_the_saw(void **state)
{
    const char *const laws[] = {"dugdale", "exponential", "compact", "jkr"};
    const double apexes[] = {0, 0.2, 0.5, 0.37};
    const int each = (int)thorough(4, 1);
    double worst = 0, most = 0;
    size_t states = 0;

    (void)state;
    for (int k = 0; k < 16 * each; k++) {
        const size_t n = 96 + 16 * (size_t)(k % 3);
        const char *law = laws[k % 4];
        const double range = k % 4 == 3 ? 0 : 0.6e-6 * pow(6, (double)(k / 4) / (4 * each - 1));
        double *h, least = INFINITY, found, spread;
        struct rc_adhesion_solver *path = cylinder(n, 1, RC_Y, law, range, apexes[k / 4 % 4], &h);

        (void)adhesion_to_approach(path, 1e-6);
        (void)adhesion_pull(path);
        found = rc_adhesion_solver_result(path)->pull_off_load;
        spread = rc_adhesion_solver_result(path)->pull_off_spread;
        states += rc_adhesion_solver_result(path)->states;
        (void)adhesion_to_approach(path, -1e-6);
        for (double c = -1e-6; c > -4.5e-6; c -= 0.006e-6) {
            double load = adhesion_to_approach(path, c)->load;
            least = fmin(least, load);
            if (load > least / 2)
                break;
        }
        worst = fmax(worst, fabs(found - least) / spread);
        most = fmax(most, spread / -least);
        rc_adhesion_solver_free(path);
        free(h);
    }
    print_message(
        "off by at most %.2f of the spread, which is at most %.3f of the load; %.0f states\n",
        worst, most, (double)states / (16 * each));
    assert_true(worst <= 1 && most <= 0.1);
}

/* ---- laws of such maps ---- */

enum {
    SIDE = 40,
    NODES = SIDE * SIDE
};
static double h[NODES], other[NODES], p[2][NODES];

static const struct rc_boundary along_y = {.y = true}, along_x = {.x = true};

static struct rc_adhesion_problem
law_of(struct rc_boundary boundary, double tol)
{
    return (struct rc_adhesion_problem){
        .contact = {.boundary = boundary, .pair.estar = 1, .tol = tol, .max_iterations = 3000},
        .work = 3 * 0.1 * 0.1,
        .range = 3 * 0.1};
}

/* A rough cylinder along y. */
static void
rough(uint64_t seed)
{
    const struct rc_shape shape = {SIDE, SIDE, 1, 1};
    const struct rc_selfaffine what = {
        .hurst = 0.8, .rms_slope = 0.1, .short_cut = 8, .rolloff = SIDE / 4, .seed = seed};

    assert_int_equal(rc_synth_selfaffine(&shape, &what, h, &adhesion_err), RC_OK);
    for (size_t k = 0; k < NODES; k++) {
        double x = ((double)(k % SIDE) - (double)(SIDE - 1) / 2) / SIDE;
        h[k] -= 0.4 * SIDE * x * x;
    }
}

/* On layers too. */
static void
equal_rows_are_one_row(void **state)
{
    const struct rc_layer layer = {.e = 4, .nu = 0.3, .thickness = 3};
    const size_t count[] = {1, 7};

    (void)state;
    rough(1);
    for (int coated = 0; coated < 2; coated++) {
        double load[2], approach[2], least[2];
        for (int k = 0; k < 2; k++) {
            const struct rc_shape shape = {SIDE, count[k], 1, 1};
            struct rc_adhesion_problem problem = law_of(along_y, 1e-8);
            struct rc_adhesion_solver *path;

            if (coated)
                problem.contact.pair = (struct rc_pair){
                    .one = {.e = 1, .nu = 0.3, .layers = 1, .layer = &layer}, .two.e = INFINITY};
            for (size_t j = 0; j < count[k]; j++)
                memcpy(other + j * SIDE, h, SIDE * sizeof *h);
            path = adhesion_new(shape, other, problem);
            approach[k] = adhesion_to_approach(path, 1)->approach;
            load[k] = adhesion_to_approach(path, 0.5)->load / (double)count[k];
            rc_adhesion_solver_pressure(path, p[k]);
            least[k] = adhesion_pull(path)->pull_off_load / (double)count[k];
            rc_adhesion_solver_free(path);
        }
        print_message("rows: loads %.12g and %.12g, pull-off %.8g and %.8g\n", load[0], load[1],
                      least[0], least[1]);
        assert_true(fabs(load[1] / load[0] - 1) < 1e-6 && fabs(least[1] / least[0] - 1) < 1e-4);
        assert_true(fabs(approach[1] - approach[0]) < 1e-12);
        for (size_t j = 0; j < 7; j++)
            assert_true(adhesion_distance(SIDE, p[1] + j * SIDE, p[0]) < 1e-6);
    }
}

static void
turned_maps_give_turned_states(void **state)
{
    const struct rc_shape shape = {SIDE, SIDE, 1, 1};
    double most = 0;

    (void)state;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        struct rc_adhesion_solver *path[2];

        rough(seed);
        for (size_t k = 0; k < NODES; k++)
            other[k] = h[k % SIDE * SIDE + k / SIDE];
        path[0] = adhesion_new(shape, h, law_of(along_y, 1e-9));
        path[1] = adhesion_new(shape, other, law_of(along_x, 1e-9));
        for (int step = 0; step < 4; step++) {
            const double approach[] = {0.5, 2, 1, -0.3};
            for (int k = 0; k < 2; k++) {
                const struct rc_adhesion_state *f = adhesion_to_approach(path[k], approach[step]);
                assert_true(f->converged && f->stable);
                rc_adhesion_solver_pressure(path[k], p[k]);
            }
            for (size_t k = 0; k < NODES; k++)
                other[k] = p[1][k % SIDE * SIDE + k / SIDE];
            most = fmax(most, adhesion_distance(NODES, other, p[0]));
        }
        rc_adhesion_solver_free(path[0]);
        rc_adhesion_solver_free(path[1]);
    }
    print_message("turned: within %.1e\n", most);
    assert_true(most < 1e-7);
}

/* Under a load the datum d shifts the approach by 2/(pi E*) ln(d) of the load per length, and changes nothing
 * else; the shifted approach gives the same state. A datum so short that a load on the whole map would lift
 * the map is refused by name. */
static void
datum_shifts_the_approach(void **state)
{
    const struct rc_shape shape = {SIDE, SIDE, 1, 1};
    const double load = 3;
    double approach[2], gap;
    struct rc_adhesion_problem problem = law_of(along_y, 1e-10);

    (void)state;
    rough(5);
    for (int k = 0; k < 2; k++) {
        struct rc_adhesion_solver *path;
        const struct rc_adhesion_state *f;

        problem.contact.boundary.datum = k == 0 ? 0 : 1e4;
        path = adhesion_new(shape, h, problem);
        f = adhesion_to_load(path, load);
        assert_true(f->converged && f->stable);
        approach[k] = f->approach;
        rc_adhesion_solver_pressure(path, p[k]);
        if (k == 1) {
            f = adhesion_to_approach(path, approach[1]);
            assert_true(fabs(f->load / load - 1) < 1e-7);
        }
        rc_adhesion_solver_free(path);
    }
    gap = 2 / exact_pi * log(1e4 / SIDE) * load / SIDE;
    print_message("datum: %.1e in the pressure, approach %g + %g\n",
                  adhesion_distance(NODES, p[1], p[0]), approach[0], approach[1] - approach[0]);
    assert_true(adhesion_distance(NODES, p[1], p[0]) < 1e-8);
    assert_true(fabs(approach[1] - approach[0] - gap) < 1e-8 * gap);
    problem.contact.boundary.datum = SIDE / 8;
    assert_null(rc_adhesion_solver_new(&shape, h, &problem, &adhesion_err));
    assert_non_null(strstr(adhesion_err.text, "datum 5 m"));
}

/* A ball whose images are far apart: the states of a free map. An image at the distance L moves the
 * surface as the load of the ball would, and an even displacement changes no pressure. Along y a cell
 * of the free map has a constant pressure, and the other map has waves: on 11 nodes of contact the
 * pressures differ by 1.4 %. */
static void
balls_far_apart_are_balls(void **state)
{
    enum {
        N = 32,
        LONG = 8 * N
    };
    static double ball[LONG * N], pressure[2][LONG * N];
    double least[2], worst = 0;

    (void)state;
    for (int k = 0; k < 2; k++) {
        const struct rc_shape shape = {N, k == 0 ? N : LONG, 1, 1};
        const size_t above = (shape.ny - N) / 2;
        struct rc_adhesion_solver *path;

        for (size_t at = 0; at < shape.nx * shape.ny; at++) {
            double x = (double)(at % N) - (N - 1) / 2.0;
            double y = (double)(at / N) - ((double)shape.ny - 1) / 2;
            ball[at] = -(x * x + y * y) / (2 * 60);
        }
        path = adhesion_new(shape, ball, law_of(k == 0 ? RC_FREE : along_y, 1e-6));
        assert_true(adhesion_to_load(path, 3)->converged);
        rc_adhesion_solver_pressure(path, pressure[k]);
        if (k == 1)
            worst = adhesion_distance(N * N, pressure[1] + above * N, pressure[0]);
        least[k] = adhesion_pull(path)->pull_off_load;
        rc_adhesion_solver_free(path);
    }
    print_message("balls: pressure within %.1e, pull-off %+.1e\n", worst, least[1] / least[0] - 1);
    assert_true(worst < 0.02 && fabs(least[1] / least[0] - 1) < 1e-3);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cylinder_of_maugis),
        cmocka_unit_test(cylinder_of_short_range),
        cmocka_unit_test(spread_holds_the_saw),
        cmocka_unit_test(equal_rows_are_one_row),
        cmocka_unit_test(turned_maps_give_turned_states),
        cmocka_unit_test(datum_shifts_the_approach),
        cmocka_unit_test(balls_far_apart_are_balls),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
