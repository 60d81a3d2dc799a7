/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Steady rolling against known answers: CONTACT's published outputs (Vollebregt, repository eve70a/CONTACT,
 * examples carter2d, tractcurv, bentall), Carter's strip, and Kalker's linear theory. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "libcontact/friction/friction.h"
#include "rolling_case.h"

static struct rc_err err;

static const struct rc_rolling_figures *
rolled(struct rc_model *m, double load, double x, double y, double spin, bool force)
{
    if (m == NULL || roll(m, load, x, y, spin, force, &err) != RC_OK)
        fail_msg("%s", err.text);
    return rc_rolling_result(m);
}

/* The cylinder of carter2d has 55 cells of 0.04 mm along x and one of 200 mm across. On each of the two
 * bodies G is 82 GPa and nu 0.28; it rolls at 30 m/s. */
static void
test_carter_of_contact(void **state)
{
    static const double traction[] = {8.47, 12.6, 15.6, 18.0, 20.1, 21.8, 23.4, 24.7, 26.0, 27.1,
                                      28.1, 29.0, 29.8, 30.5, 31.2, 31.7, 32.3, 32.7, 33.1, 33.4,
                                      28.3, 24.7, 22.6, 20.9, 19.5, 18.3, 17.2, 16.3, 15.4, 14.6,
                                      13.8, 13.1, 12.4, 11.8, 11.2, 10.6, 10.0, 9.47, 8.92, 8.38,
                                      7.85, 7.31, 6.77, 6.23, 5.67, 5.08, 4.46, 3.79, 3.02, 2.09};
    const struct rc_shape shape = {55, 1, 4e-5, 0.2};
    const struct rc_body steel = {.e = 2 * 1.28 * 82e9, .nu = 0.28};
    const struct rc_problem contact = {
        .pair = {.one = steel, .two = steel}, .tol = 1e-9, .threads = 1};
    const struct rc_rolling_problem law = {
        .law = {.pair = contact.pair, .mu = 0.3, .tol = 1e-7, .threads = 1}};
    const struct rc_rolling_figures *f;
    double h[55], q[55], s[55], power = 0;
    struct rc_model *m;

    (void)state;
    for (int i = 0; i < 55; i++)
        h[i] = -pow(-1.05e-3 + 4e-5 * i, 2);
    m = rc_rolling_new(rc_elastic_new(&shape, h, &contact, NULL, &err), &law, &err);
    f = rolled(m, 35780, 2.4e-4, 0, 0, false);
    assert_true(fabs(f->force[0] / (0.3 * 35780) - 0.6480) < 5e-5);
    assert_true(f->stick_nodes == 30 && f->slip_nodes == 20);
    assert_int_equal(rc_model_frame(m, "traction-x", q, &err), RC_OK);
    for (int i = 0; i < 50; i++) /* they are printed to three digits */
        assert_true(fabs(q[i + 2] / 1e6 - traction[i]) <
                    5.1e-3 * pow(10, floor(log10(traction[i]))));
    /* CONTACT's friction power takes the tractions at the end of a step. With those before and after it the
     * grid loses nothing. */
    assert_int_equal(rc_model_frame(m, "slip-x", s, &err), RC_OK);
    for (int i = 0; i < 55; i++)
        power -= q[i] * s[i] * shape.dx * shape.dy * 30;
    assert_true(fabs(power - 47.62) < 5e-3);
    assert_true(fabs(f->power_slip / (f->force[0] * 2.4e-4) - 1) < 1e-12);
    rc_model_free(m);
}

/* A strip without ends: creepage mu (a - c)/R gives F/(mu P) = 1 - c^2/a^2; it sticks at the front, over 2
 * c. */
static void
test_carter(void **state)
{
    enum {
        N = 220
    };
    const double a = 1, part = 0.6, estar = 1e9, p0 = 1e6, radius = a * estar / (2 * p0), mu = 0.3;
    const struct rc_shape shape = {N, 1, 2.2 * a / N, 1000};
    const struct rc_rolling_problem law = {
        .law = {.pair.estar = estar, .mu = mu, .tol = 1e-6, .threads = 1}};
    double *p = hertz_ellipse(&shape, a, 1, p0), q[N], off = 0, all = 0;
    struct rc_model *m = rolling_new(&shape, p, law, &err);
    const struct rc_rolling_figures *f =
        rolled(m, rolling_load(&shape, p), mu * a * (1 - part) / radius, 0, 0, false);

    (void)state;
    assert_true(fabs(f->force[0] / f->limit - (1 - part * part)) < 3e-3);
    assert_true(fabs(f->extrapolated_force[0] / f->limit - (1 - part * part)) <
                f->discretization_error);
    assert_int_equal(rc_model_frame(m, "traction-x", q, &err), RC_OK);
    for (int i = 0; i < N; i++) {
        const double x = (i - (N - 1) / 2.0) * shape.dx, to = (x - (1 - part) * a) / (part * a);
        const double exact = mu * (p[i] - part * p0 * sqrt(fmax(1 - to * to, 0)));
        off += fabs(q[i] - fmax(exact, 0));
        all += fabs(exact);
    }
    assert_true(off < 1e-2 * all);
    rc_model_free(m);
    free(p);
}

/* The same on a map that repeats along y, with bodies of nu 0.3: a roller of any length, and without the
 * error of its ends. Along y the surfaces are 1/(1 - nu) times as soft, in antiplane shear. Equal rows are
 * one row, the force that a creepage needs finds it again, and a spin has no middle. Rows: 5 is odd on the
 * coarser grids. */
static void
test_carter_of_a_roller(void **state)
{
    enum {
        N = 220
    };
    static const size_t rows[] = {1, 4, 5};
    const double a = 1, part = 0.6, estar = 1e9, p0 = 1e6, radius = a * estar / (2 * p0), mu = 0.3;
    double first = 0;

    (void)state;
    for (int k = 0; k < 6; k++) {
        const int along = k / 3;
        const size_t ny = rows[k % 3];
        const struct rc_shape shape = {N, ny, 2.2 * a / N, ny == 4 ? 0.03 : 7};
        struct rc_rolling_problem law = {.law = {.boundary = {.y = true},
                                                 .pair.estar = estar,
                                                 .nu = 0.3,
                                                 .mu = mu,
                                                 .tol = 1e-6,
                                                 .threads = 1}};
        const double creep = mu * a * (1 - part) / radius / (along ? 0.7 : 1);
        const double *v = (double[]){along ? 0 : creep, along ? creep : 0};
        double *p = hertz_ellipse(&shape, a, INFINITY, p0), *q = malloc(N * ny * sizeof *q),
               off = 0, all = 0;
        const double load = rolling_load(&shape, p);
        struct rc_model *m = rolling_new(&shape, p, law, &err);
        struct rc_rolling_figures f = *rolled(m, load, v[0], v[1], 0, false);
        const double force = f.force[along] / f.limit, fine = f.extrapolated_force[along] / f.limit;

        print_message("%zu rows, along %c: %.5f, extrapolated %.5f, exact %.5f, estimate %.1e; "
                      "%.0f convolutions\n",
                      ny, "xy"[along], force, fine, 1 - part * part, f.discretization_error,
                      f.convolutions);
        assert_true(fabs(force - (1 - part * part)) < 3e-3);
        assert_true(fabs(fine - (1 - part * part)) < f.discretization_error);
        assert_true(fabs(f.force[1 - along]) < 1e-6 * f.limit);
        assert_true(fabs(f.power_slip / (f.force[along] * creep) - 1) < 1e-9);
        assert_true(isnan(f.moment) && isnan(f.kalker_force[0]) && isnan(f.kalker_force[1]));
        first = k % 3 == 0 ? force : first;
        assert_true(fabs(force / first - 1) < 1e-5);
        assert_int_equal(rc_model_frame(m, along ? "traction-y" : "traction-x", q, &err), RC_OK);
        for (size_t i = 0; i < N * ny; i++) {
            const double x = ((double)(i % N) - (N - 1) / 2.0) * shape.dx;
            const double to = (x - (1 - part) * a) / (part * a);
            const double exact = fmax(mu * (p[i] - part * p0 * sqrt(fmax(1 - to * to, 0))), 0);
            off += fabs(q[i] - exact);
            all += exact;
        }
        assert_true(off < 1e-2 * all);
        assert_int_equal(roll(m, load, v[0], v[1], 1e-4, false, &err), RC_FAIL);
        assert_non_null(strstr(err.text, "where the spin of a map that repeats jumps"));
        rc_model_free(m);
        law.force = true;
        m = rolling_new(&shape, p, law, &err);
        f = *rolled(m, load, f.force[0], f.force[1], 0, true);
        assert_true(fabs(f.creep[along] / creep - 1) < 1e-5);
        rc_model_free(m);
        free(p);
        free(q);
    }
}

/* The semi-axis along x of Hertz's ellipse with b = 2 a under the load, where the gap is 0.8 x^2 per m. */
static double
half_width(double load, double estar)
{
    enum {
        STEPS = 2000
    };
    const double m = 0.75;
    double k = 0, e = 0;

    for (int i = 0; i < STEPS;
         i++) { /* the midpoint rule is exact to rounding: the functions are periodic */
        const double s = sin((i + 0.5) * RC_PI / (2 * STEPS)), root = sqrt(1 - m * s * s);
        k += RC_PI / (2 * STEPS) / root;
        e += RC_PI / (2 * STEPS) * root;
    }
    return cbrt(3 * load / (4 * RC_PI * estar) * (4 * e - k) /
                (4 * m * 0.8)); /* Johnson 1985, eq. 4.26 */
}

/* tractcurv: 106.7 kN on an ellipse a/b 0.5, mu 0.33, 48 x 44 nodes on 2.2 semi-axes. */
static void
test_creep_curve(void **state)
{
    static const double curve[] = {.2588, .4742, .6482, .7831, .8816, .9467, .9832, .9976};
    const double estar = 82e9 / 0.72, a = half_width(106700, estar),
                 p0 = 3 * 106700 / (4 * RC_PI * a * a);
    const struct rc_shape shape = {48, 44, 2.2 * a / 48, 4.4 * a / 44};
    const struct rc_rolling_problem law = {
        .law = {.pair.estar = estar, .nu = 0.28, .mu = 0.33, .tol = 1e-4, .threads = 1}};
    double *p = hertz_ellipse(&shape, a, 2 * a, p0);
    struct rc_model *m = rolling_new(&shape, p, law, &err);

    (void)state;
    for (int k = 0; k < 8; k++) {
        const struct rc_rolling_figures *f =
            rolled(m, rolling_load(&shape, p), 4e-4 * (k + 1), 0, 0, false);
        const double part = f->force[0] / f->limit;
        printf("creepage %.4f: %.4f, %zu nodes stick\n", 4e-4 * (k + 1), part, f->stick_nodes);
        assert_true(fabs(part - curve[k]) < 1e-3);
    }
    rc_model_free(m);
    free(p);
}

/* A coefficient by grids of n and 2 n nodes a diameter, without the area of their staircases. */
static void
coefficients(double ratio, double nu, size_t n, double c[3])
{
    static const double v[3][3] = {{1e-6, 0, 0}, {0, 1e-6, 0}, {0, 0, 1e-6}};
    const struct rc_rolling_problem law = {
        .law = {.pair.estar = 1, .nu = nu, .mu = 1e6, .tol = 1e-3, .threads = 1}};
    const double a = sqrt(ratio), b = 1 / a;
    double grid[2][3];

    for (size_t k = 0; k < 2; k++) {
        const size_t nodes = (size_t)lround(1.1 * (double)(n << k));
        const struct rc_shape shape = ellipse_shape(nodes, a, b);
        double *p = hertz_ellipse(&shape, a, b, 1), area = 0;
        struct rc_model *m = rolling_new(&shape, p, law, &err);
        for (size_t i = 0; i < nodes * nodes; i++)
            area += (p[i] > 0) * shape.dx * shape.dy;
        for (int w = 0; w < 3; w++) {
            const struct rc_rolling_figures *f =
                rolled(m, rolling_load(&shape, p), v[w][0], v[w][1], v[w][2], false);
            const double axes = area / RC_PI; /* G = E* (1 - nu) */
            assert_true(f->slip_nodes == 0);
            grid[k][w] =
                f->force[w == 0 ? 0 : 1] / (1e-6 * (1 - nu) * (w < 2 ? axes : pow(axes, 1.5)));
        }
        rc_model_free(m);
        free(p);
    }
    for (int w = 0; w < 3; w++)
        c[w] = 2 * grid[1][w] - grid[0][w];
}

static void
test_linear_theory(void **state)
{
    static const struct {
        double ratio, nu, c[3];
        size_t n;
    } of[] = {{.5, 0, {2.88, 2.88, .827}, 30},   {.5, .25, {3.62, 3.01, .929}, 30},
              {.5, .5, {4.83, 3.14, 1.07}, 30},  {1, 0, {3.40, 3.40, 1.33}, 30},
              {1, .25, {4.12, 3.67, 1.47}, 30},  {1, .5, {5.20, 3.98, 1.63}, 30},
              {.3, .25, {3.44, 2.75, .715}, 60}, {10 / 3., .25, {6.34, 6.40, 4.32}, 60}};

    (void)state;
    for (size_t k = 0; k < sizeof of / sizeof *of; k++) {
        double c[3], table[3];
        coefficients(of[k].ratio, of[k].nu, of[k].n, c);
        rc_kalker(of[k].ratio, of[k].nu, table);
        printf("a/b %.2f, nu %.2f: %.3f %.3f %.3f\n", of[k].ratio, of[k].nu, c[0], c[1], c[2]);
        for (int w = 0; w < 3; w++) {
            assert_true(fabs(c[w] / of[k].c[w] - 1) < 1e-2);
            assert_true(fabs(table[w] / of[k].c[w] - 1) < 6e-3);
        }
    }
}

/* The figures of the ellipse itself, between the rows of the table too, and of bodies that differ. */
static void
test_kalker_figures(void **state)
{
    const double a = 1.3, b = 0.9;
    const struct rc_shape shape = ellipse_shape(66, a, b);
    const struct rc_rolling_problem law = {.law = {.pair = {.one = {1, 0.3}, .two = {3, 0.2}},
                                                   .mu = 1e6,
                                                   .uncoupled = true,
                                                   .threads = 1}};
    double *p = hertz_ellipse(&shape, a, b, 1);
    struct rc_model *m = rolling_new(&shape, p, law, &err);
    const struct rc_rolling_figures *f =
        rolled(m, rolling_load(&shape, p), 1e-6, 2e-6, 3e-6, false);

    (void)state;
    for (int c = 0; c < 2; c++) {
        printf("%.4g of linear theory\n", f->extrapolated_force[c] / f->kalker_force[c]);
        assert_true(fabs(f->extrapolated_force[c] / f->kalker_force[c] - 1) < 2e-2);
    }
    rc_model_free(m);
    free(p);
}

/* The force of one row of the simplified theory under a creepage along x: a traction that rises by
 * `rise` from the leading edge at +half, and ends where it meets the bound most (half^2 - x^2). */
static double
row_of_simplified_theory(double half, double rise, double most)
{
    const double x = fmin(rise / most - half, half), stick = half - x; /* they meet at x */

    return rise * stick * stick / 2 +
           most * (half * half * (x + half) - (x * x * x + half * half * half) / 3);
}

/* Against the integral of its rows, the linear theory and full slip. */
static void
test_simplified_theory(void **state)
{
    const double axis[2] = {1.3, 0.9}, g = 2, c[3] = {4.5, 4, 1.7}, limit = 3;
    const double ab = axis[0] * axis[1], most = 2 * limit / (RC_PI * pow(axis[0], 3) * axis[1]);
    const double size = g * ab * c[0]; /* force over creepage in linear theory */
    enum {
        ROWS = 20000
    };

    (void)state;
    for (double creep = 0.02 * limit / size; creep < 5 * limit / size; creep *= 1.4) {
        double force[2], sum = 0;
        rc_fastsim(axis, g, c, limit, (double[]){creep, 0}, 0, force);
        for (int j = 0; j < ROWS; j++) {
            const double y = (2 * (j + 0.5) / ROWS - 1), half = axis[0] * sqrt(1 - y * y);
            sum += row_of_simplified_theory(half, creep * 3 * g * c[0] / (8 * axis[0]), most) * 2 *
                   axis[1] / ROWS;
        }
        assert_true(fabs(force[0] - sum) < 5e-4 * sum && force[1] == 0);
    }
    for (int k = 0; k < 2; k++) { /* the two forces of small motions, which spin has too */
        const double creep[2] = {k == 0 ? 1e-7 : 0, k == 1 ? 1e-7 : 0}, spin = k == 1 ? 2e-7 : 0;
        const double linear = g * ab * (c[k] * 1e-7 + c[2] * sqrt(ab) * spin);
        double force[2];
        rc_fastsim(axis, g, c, limit, creep, spin, force);
        assert_true(fabs(force[k] / linear - 1) < 1e-3);
    }
    { /* full slip has the direction of the elastic motion */
        const double x = -3 * c[0], y = 4 * c[1];
        double force[2];
        rc_fastsim(axis, g, c, limit, (double[]){-3, 4}, 0, force);
        assert_true(fabs(force[0] / (limit * x / hypot(x, y)) - 1) < 1e-3);
        assert_true(fabs(force[1] / (limit * y / hypot(x, y)) - 1) < 1e-3);
    }
}

/* bentall: a roller of aluminium (G 23 GPa, nu 0.31) on one of steel (82 GPa, 0.28), 200 nodes, mu 0.05. It
 * rolls freely, driven and braked. CONTACT rolls towards -x there, so that its forces have the other sign. */
static void
test_dissimilar_rollers(void **state)
{
    static const double part[] = {0, .75, -.75}, creepage[] = {4.294e-4, 5.392e-4, 2.108e-4};
    const struct rc_shape shape = {216, 1, 1e-6, 1};
    const struct rc_pair pair = {.one = {2 * 1.31 * 23e9, 0.31}, .two = {2 * 1.28 * 82e9, 0.28}};
    const double load = 16201.9e3 * 1e-3;
    double h[216];

    (void)state;
    for (int i = 0; i < 216; i++)
        h[i] = -20 * pow((i - 107.5) * 1e-6, 2);
    for (int k = 0; k < 6; k++) { /* a cell of 1 m across, then a map that repeats */
        const struct rc_boundary boundary = rc_boundary_of(false, k >= 3);
        const struct rc_problem contact = {
            .boundary = boundary, .pair = pair, .tol = 1e-8, .threads = 1};
        const struct rc_rolling_problem law = {
            .law = {.boundary = boundary, .pair = pair, .mu = 0.05, .tol = 1e-6, .threads = 1},
            .force = true};
        struct rc_model *m =
            rc_rolling_new(rc_elastic_new(&shape, h, &contact, NULL, &err), &law, &err);
        const struct rc_rolling_figures *f = rolled(m, load, part[k % 3] * 0.05 * load, 0, 0, true);
        printf("F/(mu P) %.2f: creepage %.4g (%.4g), %zu nodes stick, %zu slip\n", part[k % 3],
               f->creep[0], creepage[k % 3], f->stick_nodes, f->slip_nodes);
        assert_true(fabs(fabs(f->creep[0]) / creepage[k % 3] - 1) < 1e-2);
        rc_model_free(m);
    }
}

/* catt_to_cart: two balls, G 1, nu 0.28, mu 0.4013, are pressed and pushed (Cattaneo), and roll under the
 * same force over two diameters of their contact (Carter). The creepages of the 56 steps are printed to 4
 * digits. */
static void
test_cattaneo_to_carter(void **state)
{
    static const double creepage[] = {
        1.824, 1.882, 1.955, 2.050, 2.140, 2.221, 2.334, 2.428, 2.551, 2.676, 2.801, 2.968,
        3.184, 3.403, 3.402, 3.334, 3.241, 3.192, 3.123, 3.112, 3.088, 3.072, 3.064, 3.062,
        3.064, 3.070, 3.077, 3.085, 3.093, 3.101, 3.107, 3.111, 3.111, 3.110, 3.107, 3.105,
        3.103, 3.101, 3.100, 3.099, 3.099, 3.099, 3.099, 3.099, 3.100, 3.100, 3.100, 3.101,
        3.101, 3.101, 3.101, 3.101, 3.101, 3.101, 3.101, 3.101};
    enum {
        STEPS = sizeof creepage / sizeof *creepage,
        NX = 34,
        NY = 33
    };
    const struct rc_shape shape = {NX, NY, 0.25, 0.25};
    const double load = 0.4705, estar = 1 / 0.72, force = 0.657 * 0.4013 * load;
    const struct rc_problem contact = {
        .pair.estar = estar, .load = load, .tol = 1e-10, .threads = 1};
    struct rc_rolling_contact known = {0};
    const struct rc_rolling_problem law = {
        .law = {.pair.estar = estar, .nu = 0.28, .mu = 0.4013, .tol = 1e-5, .threads = 1},
        .force = true,
        .path = true,
        .known = &known};
    double h[NX * NY], worst = 0;
    const struct rc_rolling_figures *f;
    struct rc_solver *solver;
    struct rc_model *m;

    (void)state;
    for (int k = 0; k < NX * NY; k++)
        h[k] = -0.002963 * (pow((k % NX - 16) * 0.25, 2) + pow((k / NX - 16) * 0.25, 2));
    solver = rc_solver_new(&shape, h, &contact, &err);
    assert_non_null(solver);
    while (rc_solver_step(solver) == RC_MORE)
        ;
    known.p = rc_solver_pressure(solver);
    m = rc_rolling_new(rc_elastic_new(&shape, h, &contact, NULL, &err), &law, &err);
    f = rc_rolling_result(m);
    for (int k = 0; k <= STEPS; k++) {
        struct rc_point to = {0};
        known.x = 0.25 * k;
        rc_point_set(&to, RC_POSITION, known.x);
        rc_point_set(&to, RC_TANGENTIAL_X, force);
        rc_point_set(&to, RC_TANGENTIAL_Y, 0);
        if (rc_model_run(m, &to, &err) != RC_OK || rc_model_look(m, NULL, &err) != RC_OK)
            fail_msg("step %d: %s", k, err.text);
        assert_true(k == 0       ? f->stick_nodes == 305 && f->slip_nodes == 316
                    : k == 1     ? f->stick_nodes == 422 && f->slip_nodes == 199
                    : k == STEPS ? f->stick_nodes == 346 && f->slip_nodes == 275
                                 : f->stick_nodes + f->slip_nodes == 621);
        assert_true((k == 0) == isnan(f->creep[0]));
        worst = fmax(worst, k == 0 ? 0 : fabs(f->creep[0] * 1e3 / creepage[k - 1] - 1));
        assert_int_equal(rc_model_keep(m, &err), RC_OK);
    }
    printf("creepages are off by %.1e at the most, after %.0f convolutions a step\n", worst,
           f->convolutions);
    assert_true(worst < 3e-4); /* half of the last digit: 2.7e-4 */
    rc_model_free(m);
    rc_solver_free(solver);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cattaneo_to_carter),
        cmocka_unit_test(test_carter_of_contact),
        cmocka_unit_test(test_carter),
        cmocka_unit_test(test_carter_of_a_roller),
        cmocka_unit_test(test_creep_curve),
        cmocka_unit_test(test_linear_theory),
        cmocka_unit_test(test_kalker_figures),
        cmocka_unit_test(test_simplified_theory),
        cmocka_unit_test(test_dissimilar_rollers),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
