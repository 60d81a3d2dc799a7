/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Adhesion against closed forms: Maugis' sphere, the limits of JKR and DMT, Bradley's rigid sphere, Johnson's
 * wave. A small map is compared with Newton's method for the pressures, with an influence matrix from closed
 * forms. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "adhesion_case.h"
#include "tests/solver/dense.h"

/* ---- a sphere ---- */

static const double radius = 2.385e-3, estar = 3.1e6;

/* `nodes` is the number of nodes in the radius of the JKR contact at zero load. The apex lies at no symmetric
 * point of the grid, because there the errors of the grid are largest, with either sign. */
struct sphere {
    struct rc_shape shape;
    double work, load, length, approach; /* J/m2; Maugis' units */
    double *h;
};

static struct sphere
sphere_of(size_t n, double nodes)
{
    const double kay = 4 * estar / 3;
    struct sphere s = {.shape = {n, n, 1.1e-6, 1.1e-6}, .h = calloc(n * n, sizeof *s.h)};
    struct rc_place apex = {s.shape.dx / 4, s.shape.dx / 4};
    double a0 = nodes * s.shape.dx;

    assert_non_null(s.h);
    s.work = a0 * a0 * a0 * kay / (6 * exact_pi * radius * radius);
    s.load = exact_pi * s.work * radius;
    s.length = cbrt(exact_pi * s.work * radius * radius / kay);
    s.approach = s.length * s.length / radius;
    rc_synth_paraboloid(&s.shape, apex, radius, radius, 0, s.h);
    return s;
}

/* Bounds: of the load that should be 0, over pi w R; of the lowest load, relative. They are errors of the
 * grid. If the attracting ring is 4, 1.6 or 0.6 nodes wide, load against approach is a saw-tooth curve. Its
 * lowest tooth is 0.2, 0.26 or 0.77 % below Maugis' lowest load: in 200 states, the last in 3000. */
static const struct {
    double lambda, nodes;
    size_t n;
    double load, pull_off;
} rows[] = {
    {0.1, 20, 128, 1.5e-3, 3e-4}, {0.5, 40, 128, 1.6e-3, 8.4e-4}, {1, 40, 120, 2.3e-3, 2.5e-3},
    {3, 40, 104, 1.2e-3, 3e-3},   {5, 40, 104, 2.6e-3, 7.8e-3},
};
static const double of_radius = 0.02; /* error of the radius in units of Maugis; it is less than a
                                         node */

static void
sphere_of_maugis(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k += thorough(1, 4)) {
        struct sphere s = sphere_of(rows[k].n, rows[k].nodes);
        struct maugis none = maugis_of_load(rows[k].lambda, 0);
        double kay = 4 * estar / 3,
               strength = rows[k].lambda / 2 / cbrt(radius / (exact_pi * s.work * kay * kay)),
               lowest = maugis_pull_off(rows[k].lambda), is, a;
        const struct rc_adhesion_problem problem = {.contact = {.pair.estar = estar, .tol = 1e-4},
                                                    .work = s.work,
                                                    .law = "dugdale",
                                                    .range = s.work / strength};
        struct rc_adhesion_solver *path = adhesion_new(s.shape, s.h, problem);
        const struct rc_adhesion_state *f = adhesion_to_approach(path, none.approach * s.approach);

        assert_true(f->converged && f->stable);
        is = f->load / s.load;
        a = sqrt(f->contact_area / exact_pi) / s.length;
        print_message("lambda %g: load %+.1e (%.1e), radius %.4f (%.4f), %.0f convolutions\n",
                      rows[k].lambda, is, rows[k].load, a, none.a, f->convolutions);
        assert_true(fabs(is) <= rows[k].load);
        assert_true(fabs(a - none.a) <= of_radius);
        f = adhesion_pull(path);
        is = f->pull_off_load / s.load;
        print_message("    lowest load %.5f (%.5f): %+.1e (%.1e), spread %.1e, %zu states, %.0f "
                      "convolutions\n",
                      is, lowest, is / lowest - 1, rows[k].pull_off,
                      f->pull_off_spread / fabs(f->pull_off_load), f->states, f->convolutions);
        assert_true(f->converged);
        assert_true(fabs(is / lowest - 1) <= rows[k].pull_off);
        assert_true(f->pull_off_spread <= 0.01 * fabs(f->pull_off_load));
        rc_adhesion_solver_free(path);
        free(s.h);
    }
}

/* On a grid that hardly resolves the law the load is a saw-tooth curve, whose teeth depend on the position of
 * the apex. The result of the search differs from the lowest tooth of a path with small steps by at most the
 * reported spread. The spread is of the size of the teeth. */
static void
spread_holds_the_saw(void **state)
{
    static const struct {
        size_t row;
        double apex; /* position of the apex in the cell, in spacings along x */
    } cases[] = {{2, 0.05}, {3, 0.5}, {4, 0.5}};

    (void)state;
    for (size_t k = 0; k < thorough(sizeof cases / sizeof *cases, 1); k++) {
        size_t row = cases[k].row;
        struct sphere s = sphere_of(rows[row].n, rows[row].nodes);
        double kay = 4 * estar / 3,
               strength = rows[row].lambda / 2 / cbrt(radius / (exact_pi * s.work * kay * kay)),
               lowest = 0, found, spread;
        const struct rc_place apex = {cases[k].apex * s.shape.dx, 0.7 * cases[k].apex * s.shape.dx};
        const struct rc_adhesion_problem problem = {.contact = {.pair.estar = estar, .tol = 1e-4},
                                                    .work = s.work,
                                                    .law = "dugdale",
                                                    .range = s.work / strength};
        struct rc_adhesion_solver *path;

        rc_synth_paraboloid(&s.shape, apex, radius, radius, 0, s.h);
        path = adhesion_new(s.shape, s.h, problem);
        (void)adhesion_to_approach(path, 0);
        found = adhesion_pull(path)->pull_off_load;
        spread = rc_adhesion_solver_result(path)->pull_off_spread;
        (void)adhesion_to_approach(path, 0);
        for (int step = 0; step <= 30; step++) {
            double load = adhesion_to_approach(path, -(0.4 + 0.006 * step) * s.approach)->load;
            lowest = fmin(lowest, load);
        }
        print_message("lambda %g, apex %g: %.5f, give or take %.5f; in small steps %.5f\n",
                      rows[row].lambda, cases[k].apex, found / s.load, spread / s.load,
                      lowest / s.load);
        assert_true(lowest < 0 && found <= lowest + spread && found >= lowest - spread);
        assert_true(spread < 0.03 * -lowest);
        rc_adhesion_solver_free(path);
        free(s.h);
    }
}

/* If only the work of adhesion matters the lowest load is -3/2 pi w R (Johnson, Kendall and Roberts 1971).
 * Its size approaches this limit from above as the range decreases: in Maugis' theory it is 1.2 % larger at
 * Tabor's number 5. */
static void
sphere_of_jkr(void **state)
{
    double last = INFINITY;

    (void)state;
    for (size_t n = 48; n <= thorough(144, 96); n += 48) {
        struct sphere s = sphere_of(n, (double)n * 0.4);
        const struct rc_adhesion_problem problem = {
            .contact = {.pair.estar = estar, .tol = 1e-4}, .work = s.work, .law = "jkr"};
        struct rc_adhesion_solver *path = adhesion_new(s.shape, s.h, problem);
        struct rc_adhesion_scales scales;
        double tabor, off;

        assert_int_equal(rc_adhesion_check(&s.shape, &problem, &scales, &adhesion_err), RC_OK);
        tabor = cbrt(radius * s.work * s.work / (estar * estar)) / scales.range;
        (void)adhesion_to_approach(path, 0);
        off = adhesion_pull(path)->pull_off_load / s.load / -1.5 - 1;
        print_message("jkr, Tabor %.2f: %+.4f\n", tabor, off);
        assert_true(off > -2e-3 && off < last);
        last = off;
        rc_adhesion_solver_free(path);
        free(s.h);
    }
    assert_true(last < (thorough(true, false) ? 0.05 : 0.06));
}

/* Rigid bodies: the load at a clearance d is -2 pi w R (1 - d/gc)^3 (Bradley 1932, for this law). */
static void
sphere_of_bradley(void **state)
{
    const double tabor = 0.0005, nodes = 28;
    const size_t n = 64;
    const struct rc_shape shape = {n, n, 1e-6, 1e-6};
    double *h = calloc(n * n, sizeof *h), range, work;
    struct rc_place apex = {0.25e-6, 0.1e-6};
    struct rc_adhesion_problem problem = {.contact = {.pair.estar = estar, .tol = 1e-6},
                                          .law = "compact"};
    struct rc_adhesion_solver *path;

    (void)state;
    assert_non_null(h);
    range = nodes * nodes * 1e-12 / (2 * radius);
    work = estar * sqrt(pow(tabor * range, 3) / radius);
    problem.work = work;
    problem.range = range;
    rc_synth_paraboloid(&shape, apex, radius, radius, 0, h);
    path = adhesion_new(shape, h, problem);
    for (int k = 4; k >= 0; k--) {
        double d = k * range / 5, exact = -2 * exact_pi * work * radius * pow(1 - k / 5.0, 3);
        double lift = 0; /* depth of the highest node below the apex */
        for (size_t i = 0; i < n * n; i++)
            lift = i == 0 ? h[i] : fmax(lift, h[i]);
        const struct rc_adhesion_state *f = adhesion_to_approach(path, -d + lift);
        print_message("rigid, clearance %.1f ranges: %+.1e\n", k / 5.0, f->load / exact - 1);
        assert_true(f->converged && fabs(f->load - exact) <= 4e-4 * 2 * exact_pi * work * radius);
    }
    rc_adhesion_solver_free(path);
    free(h);
}

/* ---- Johnson's wave ---- */

enum {
    WAVE = 256
};

/* Westergaard's pressure of a contact of half-width a without adhesion (Johnson 1985, eq. 13.8). */
static double
westergaard(double peak, double psi, double angle)
{
    double s = sin(psi), t = sin(angle), below = s * s - t * t;

    return below > 0 ? 2 * peak * cos(angle) * sqrt(below) : 0;
}

static void
wave_of_johnson(void **state)
{
    const double alphas[] = {0.1, 0.3, 0.6},
                 widths[3][3] = {{0.15, 0.25, 0.35}, {0.15, 0.2, 0.25}, {0.15, 0.18, 0.2}};
    const double length = 1e-3, height = 1e-6, peak = exact_pi * estar * height / length;
    const struct rc_shape shape = {WAVE, 1, length / WAVE, length / WAVE};
    double h[WAVE], p[WAVE], u[WAVE], worst = 0;
    const struct rc_pair pair = {.estar = estar};
    const struct rc_conv_options options = {.boundary = RC_PERIODIC};
    struct rc_conv *conv = rc_conv_new(&shape, &pair, &options, &adhesion_err);

    (void)state;
    assert_non_null(conv);
    rc_synth_wave(&shape, height, length, INFINITY, h);
    for (size_t k = 0; k < 3; k++)
        for (size_t w = 0; w < 3; w++) {
            double psi = exact_pi * widths[k][w], top = -INFINITY, c, is;
            const struct rc_adhesion_problem problem = {
                .contact = {.boundary = RC_PERIODIC, .pair = pair, .tol = 1e-5},
                .work = alphas[k] * alphas[k] * peak * peak * length / (2 * estar),
                .law = "jkr"};
            struct rc_adhesion_solver *path = adhesion_new(shape, h, problem);
            const struct rc_adhesion_state *f;

            for (size_t i = 0; i < WAVE; i++) {
                p[i] = westergaard(peak, psi, exact_pi * ((double)i - (WAVE - 1) / 2.0) / WAVE);
                top = fmax(top, h[i]);
            }
            rc_conv_apply(conv, p, u);
            c = u[WAVE / 2] - h[WAVE / 2];
            assert_int_equal(rc_adhesion_solver_start(path, p, c + top, &adhesion_err), RC_OK);
            f = adhesion_to_approach(path, c + top);
            f = adhesion_to_load(path,
                                 peak * johnson_wave(alphas[k], widths[k][w]) * length * shape.dy);
            is = f->contact_fraction / 2;
            print_message("alpha %.1f, a/l %.3f: %.4f, %zu steps, stability %.2g\n", alphas[k],
                          widths[k][w], is, f->iterations, f->stability);
            assert_true(f->converged && f->stable);
            worst = fmax(worst, fabs(is - widths[k][w]));
            rc_adhesion_solver_free(path);
        }
    assert_true(worst <= 0.006);
    rc_conv_free(conv);
}

/* The half-width over the length on the stable branch. */
static double
johnson_width(double alpha, double load)
{
    double low = 0.05, high = 0.45;

    for (int k = 0; k < 50; k++) {
        double middle = (low + high) / 2;
        if (johnson_wave(alpha, middle) < load)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* A wave also has states of complete contact, which are stable at all these loads. A path of large steps up
 * and down must not jump there. */
static void
waves_in_large_steps(void **state)
{
    enum {
        SIDE = 128
    };
    static const double loads[] = {0.05, 0.5, 0.05, 0.7, 0.4, 0.6, 0, 0.3, 0.7, 0.2, 0.6, 0.05};
    const double length = 1e-3, height = 5e-6, soft = 1e6, alpha = 0.1;
    const double peak = exact_pi * soft * height / length;
    const struct rc_shape shape = {SIDE, 1, length / SIDE, length / SIDE};
    const struct rc_adhesion_problem problem = {
        .contact = {.boundary = RC_PERIODIC, .pair.estar = soft},
        .work = alpha * alpha * peak * peak * length / (2 * soft),
        .law = "jkr"};
    double h[SIDE], worst = 0, convolutions = 0;
    struct rc_adhesion_solver *path;

    (void)state;
    rc_synth_wave(&shape, height, length, INFINITY, h);
    path = adhesion_new(shape, h, problem);
    for (size_t k = 0; k < sizeof loads / sizeof *loads; k++) {
        const struct rc_adhesion_state *f =
            adhesion_to_load(path, loads[k] * peak * length * shape.dy);
        double off = f->contact_fraction - 2 * johnson_width(alpha, loads[k]);
        assert_true(f->converged && f->stable);
        assert_int_equal(f->jumps, 0);
        worst = fmax(worst, fabs(off));
        convolutions += f->convolutions;
    }
    print_message("large steps: contact within %.4f of Johnson's, %.0f convolutions\n", worst,
                  convolutions);
    assert_true(worst <= 0.02); /* 2.5 nodes; two of them are the range */
    rc_adhesion_solver_free(path);
}

/* ---- another formulation ---- */

/* Solves min(g, p + sigma) = 0, g = K p - h - c, for the pressures by Newton's method. A node with the
 * smaller gap has the row of K, the others that of 1 - D K. The matrix is not symmetric; the elimination has
 * pivots. */
enum {
    NX = 12,
    NY = 11,
    NODES = NX * NY,
    PARTS = 6 /* largest number of Newton's steps from one approach to the next */
};
static struct dense dense;
static double jacobian[NODES][NODES];

static void
eliminate(size_t n, double *x)
{
    for (size_t k = 0; k < n; k++) {
        size_t pivot = k;
        for (size_t i = k + 1; i < n; i++)
            if (fabs(jacobian[i][k]) > fabs(jacobian[pivot][k]))
                pivot = i;
        for (size_t j = k; j < n && pivot != k; j++) {
            double other = jacobian[k][j];
            jacobian[k][j] = jacobian[pivot][j];
            jacobian[pivot][j] = other;
        }
        double other = x[k];
        x[k] = x[pivot];
        x[pivot] = other;
        for (size_t i = k + 1; i < n; i++) {
            double factor = jacobian[i][k] / jacobian[k][k];
            if (factor == 0)
                continue;
            for (size_t j = k; j < n; j++)
                jacobian[i][j] -= factor * jacobian[k][j];
            x[i] -= factor * x[k];
        }
    }
    for (size_t k = n; k-- > 0;) {
        for (size_t j = k + 1; j < n; j++)
            x[k] -= jacobian[k][j] * x[j];
        x[k] /= jacobian[k][k];
    }
}

/* The exponential and the compact law, independent of the library. */
static double
traction(bool compact, double work, double range, double g, double *slope)
{
    double x = 1 - g / range;

    if (!compact) {
        *slope = -work / range / range * exp(-g / range);
        return work / range * exp(-g / range);
    }
    *slope = x > 0 ? -6 * work / range / range * x : 0;
    return x > 0 ? 3 * work / range * x * x : 0;
}

/* The integral of K0 from 0 to z, odd in z: K0(z) is that of exp(-z cosh t) over t > 0, and the trapezoidal
 * rule converges exponentially. */
static double
k0_integral(double z)
{
    const double step = 0.05;
    double sum = 0;

    for (int k = 0; k <= 800; k++) {
        double c = cosh(k * step);
        sum -= (k == 0 ? 0.5 : 1) * step * expm1(-fabs(z) * c) / c;
    }
    return z < 0 ? -sum : sum;
}

/* The integral of ln(|x|/datum). */
static double
log_integral(double x, double datum)
{
    return x == 0 ? 0 : x * log(fabs(x) / datum) - x;
}

/* The displacement i columns and j rows away from a unit pressure on a node. Along y the map repeats: the
 * pressure is the sum of the ny waves of the map. Along x it is constant in a cell. Without a wave the
 * displacement is 0 at the distance nx dx. */
static double
influence_of_waves(size_t nx, size_t ny, double dx, double dy, size_t i, size_t j)
{
    const double from = ((double)i - 0.5) * dx, to = ((double)i + 0.5) * dx,
                 datum = (double)nx * dx;
    double sum = -2 / exact_pi * (log_integral(to, datum) - log_integral(from, datum));

    for (size_t m = 1; m < ny; m++) {
        double q = 2 * exact_pi * (double)(m <= ny / 2 ? m : ny - m) / ((double)ny * dy);
        sum += 2 / (exact_pi * q) * (k0_integral(q * to) - k0_integral(q * from)) *
               cos(2 * exact_pi * (double)(m * j % ny) / (double)ny);
    }
    return sum / (double)ny / estar;
}

/* Finds the pressures at the shift c, starting from the present ones; false: it did not converge. */
static bool
newton(const double *h, bool compact, double work, double range, double c, double *p)
{
    static double x[NODES], g[NODES];

    for (int step = 0; step < 60; step++) {
        double most = 0, scale = work / range;
        for (size_t i = 0; i < NODES; i++) {
            double slope, s;
            g[i] = -h[i] - c;
            for (size_t j = 0; j < NODES; j++)
                g[i] += dense.K[i][j] * p[j];
            s = traction(compact, work, range, fmax(g[i], 0), &slope);
            /* both in their own units */
            if (g[i] / range < (p[i] + s) / scale) {
                x[i] = -g[i] / range;
                for (size_t j = 0; j < NODES; j++)
                    jacobian[i][j] = dense.K[i][j] / range;
            } else {
                x[i] = -(p[i] + s) / scale;
                for (size_t j = 0; j < NODES; j++)
                    jacobian[i][j] = slope * dense.K[i][j] / scale;
                jacobian[i][i] += 1 / scale;
            }
            most = fmax(most, fabs(x[i]));
        }
        if (most < 1e-12)
            return true;
        eliminate(NODES, x);
        for (size_t i = 0; i < NODES; i++)
            p[i] += x[i];
    }
    return false;
}

/* Approach from far away and retraction: the state after each approach starts from the last one. */
static void
same_as_newton(struct rc_boundary boundary, bool compact, double ell)
{
    const struct rc_shape shape = {NX, NY, 1.1e-6, 1e-6};
    const double side = rc_repeats(boundary) == 0 ? 0.3 : 0.5;
    double h[NODES], p[NODES], is[NODES], sum = 0, top = -INFINITY, worst = 0, work, range, unit,
                                          last, most = 0, least = 0;
    struct rc_adhesion_problem problem = {
        .contact = {.boundary = boundary, .pair.estar = estar, .tol = 1e-11},
        .law = compact ? "compact" : "exponential"};
    struct rc_adhesion_solver *path;

    /* a bump on waves, without symmetry */
    for (size_t k = 0; k < NODES; k++) {
        double x = 2 * exact_pi * ((double)(k % NX) + 0.3) / NX;
        double y = 2 * exact_pi * ((double)(k / NX) + 0.1) / NY;
        h[k] = 1e-6 * (cos(x) + cos(y) + side * cos(2 * x + y) - side * sin(3 * y - x) / 2);
        top = fmax(top, h[k]);
    }
    for (size_t i = 0; i < NODES; i++)
        for (size_t j = 0; j < NODES; j++) {
            size_t a = (size_t)abs((int)(i % NX) - (int)(j % NX));
            size_t b = (size_t)abs((int)(i / NX) - (int)(j / NX));
            dense.K[i][j] = rc_repeats(boundary) != 1
                                ? dense_influence(&shape, boundary, estar, a, b)
                            : boundary.y ? influence_of_waves(NX, NY, shape.dx, shape.dy, a, b)
                                         : influence_of_waves(NY, NX, shape.dy, shape.dx, b, a);
        }
    for (size_t j = 0; j < NODES; j++)
        sum += dense.K[0][j] / NODES;
    for (size_t i = 0; i < NODES && !rc_has_mean(boundary); i++)
        for (size_t j = 0; j < NODES; j++)
            dense.K[i][j] -= sum; /* a mean pressure causes no displacement */
    work = 0.15;                  /* J/m2 */
    unit = sqrt(work * ell * 1.1e-6 / estar);
    range = compact ? sqrt(6) * unit : unit;
    last = -5 * unit;
    problem.work = work;
    problem.range = range;
    path = adhesion_new(shape, h, problem);
    memset(p, 0, sizeof p);
    for (int k = 0; k < 14; k++) {
        double approach = unit * (-4 + 0.8 * (k < 8 ? k : 14 - k));
        const struct rc_adhesion_state *f = adhesion_to_approach(path, approach);
        assert_true(f->converged && f->stable);
        for (int part = 1; part <= PARTS; part++)
            assert_true(
                newton(h, compact, work, range, last + (approach - last) * part / PARTS - top, p));
        last = approach;
        rc_adhesion_solver_pressure(path, is);
        if (f->attractive_load > 0)
            worst = fmax(worst, adhesion_distance(NODES, is, p));
        most = fmax(most, f->contact_fraction);
        least = fmin(least, f->load);
    }
    print_message("%s, %s: within %.1e of Newton's, to %.2f in contact\n",
                  rc_boundary_word(boundary), problem.law, worst, most);
    assert_true(most > 0.05 && least < 0);
    assert_true(worst <= 1e-7);
    rc_adhesion_solver_free(path);
}

static void
pressures_by_newton(void **state)
{
    (void)state;
    same_as_newton(RC_FREE, false, 5);
    same_as_newton(RC_PERIODIC, false, 5);
    same_as_newton(RC_FREE, true, 5);
    same_as_newton(RC_PERIODIC, true, 5);
    same_as_newton(rc_boundary_of(true, false), false, 5);
    same_as_newton(rc_boundary_of(false, true), true, 5);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sphere_of_maugis),    cmocka_unit_test(spread_holds_the_saw),
        cmocka_unit_test(sphere_of_jkr),       cmocka_unit_test(sphere_of_bradley),
        cmocka_unit_test(wave_of_johnson),     cmocka_unit_test(waves_in_large_steps),
        cmocka_unit_test(pressures_by_newton),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
