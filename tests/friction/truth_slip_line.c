/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Line contact, on maps that repeat along one axis: partial slip of Cattaneo and Mindlin across the line
 * and along it, with the displacement under the datum, and its loop. The superposition of Ciavarella and
 * Jaeger holds to rounding. Dissimilar bodies under a load alone stick in the part of Spence. Rows that
 * are equal are one row, and a turned map gives the turned result. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <gsl/gsl_sf_ellint.h>
#include <stdio.h>

#include "slip_case.h"

static const double mu = 0.3;

/* A cylinder whose contact is 2 a wide, on a map that is 2.4 a wide. E* = 1, and P, F are forces per
 * metre. */
struct line {
    size_t nodes, rows;
    double dx, dy; /* across the line, and along it */
    struct rc_shape shape;
    struct rc_boundary boundary;
    bool turned; /* the line is along x */
    double a, radius, load;
};

static struct line
line_of(size_t nodes, size_t rows, bool turned, double datum)
{
    struct line l = {.nodes = nodes, .rows = rows, .dx = 0.7, .dy = 1.9, .turned = turned};

    l.shape = turned ? (struct rc_shape){rows, nodes, l.dy, l.dx}
                     : (struct rc_shape){nodes, rows, l.dx, l.dy};
    l.boundary = (struct rc_boundary){.x = turned, .y = !turned, .datum = datum};
    l.a = (double)nodes * l.dx / 2.4;
    l.radius = 30 * l.a;
    l.load = exact_pi * l.a * l.a / (4 * l.radius); /* Johnson 1985, eq. 4.43 */
    return l;
}

/* m: the distance of node k from the line. */
static double
across(const struct line *l, size_t k)
{
    const size_t at = l->turned ? k / l->rows : k % l->nodes;

    return ((double)at - ((double)l->nodes - 1) / 2) * l->dx;
}

static struct pressed
press(const struct line *l, double load)
{
    double *h = malloc(l->nodes * l->rows * sizeof *h);

    for (size_t k = 0; k < l->nodes * l->rows; k++)
        h[k] = -across(l, k) * across(l, k) / (2 * l->radius);
    return pressed_new(&l->shape, l->boundary, h, 1, load * (double)l->rows * l->dy, 1e-13);
}

/* The half width under a load per metre, and the approach (Johnson 1985, section 5.6; the datum is the depth
 * or distance where nothing moves). */
static double
half_width(const struct line *l, double load)
{
    return l->a * sqrt(load / l->load);
}

static double
approach(const struct line *l, double load)
{
    return load / exact_pi * (2 * log(2 * l->boundary.datum / half_width(l, load)) + 1);
}

static struct rc_friction_solver *
slip_on(const struct line *l, double nu)
{
    const struct rc_friction_law problem = {
        .boundary = l->boundary, .pair.estar = 1, .nu = nu, .mu = mu, .tol = 1e-11};
    struct rc_friction_solver *slip = rc_friction_solver_new(&l->shape, &problem, NULL);

    assert_non_null(slip);
    return slip;
}

/* Moves to a force per metre along the line, or across it. */
static void
pull(struct rc_friction_solver *slip, const struct line *l, bool along, double force,
     struct rc_friction_increment *f)
{
    const double of[2] = {force * (double)l->rows * l->dy, 0};
    const int x = along == l->turned ? 0 : 1;

    assert_int_equal(rc_friction_solver_set_force(slip, of[x], of[1 - x], NULL), RC_OK);
    assert_int_equal(slip_solve(slip, f), RC_OK);
    assert_true(f->steps <= 30);
}

/* q = mu (p(P) - p(P - F/mu)), and the bodies move by mu times the difference of the approaches. Along the
 * line, in antiplane shear, they move 1 + kap times as far: a line force F moves a half-space of the shear
 * modulus G by F/(pi G) log(datum/r), and the sum of 1/G is 2 (1 + kap)/E*. */
static void
test_partial_slip(void **state)
{
    static const size_t rows[] = {1, 4};
    static const double parts[] = {0.2, 0.7};

    (void)state;
    for (int k = 0; k < 32; k++) {
        const size_t nodes = k & 1 ? 200 : 50;
        const struct line l = line_of(nodes, rows[k >> 1 & 1], k & 4, 1000);
        const bool along = k & 8;
        const double nu = along ? 0.35 : 0.2, part = parts[k >> 4], kap = nu / (1 - nu);
        const double left = l.load * (1 - part), c = half_width(&l, left);
        const double p0 = 2 * l.load / (exact_pi * l.a), factor = along ? 1 + kap : 1;
        struct pressed full = press(&l, l.load), less = press(&l, left);
        struct rc_friction_solver *slip = slip_on(&l, nu);
        struct rc_friction_increment f;
        double off = 0, far = 0, size = 0,
               moved = factor * mu * (approach(&l, l.load) - approach(&l, left));
        const double *q[2];
        const int x = along == l.turned ? 0 : 1;

        assert_int_equal(rc_friction_solver_set_pressure(slip, full.p, full.gap, NULL), RC_OK);
        pull(slip, &l, along, part * mu * l.load, &f);
        q[0] = rc_friction_solver_traction(slip, x);
        q[1] = rc_friction_solver_traction(slip, 1 - x);
        for (size_t n = 0; n < full.n; n++) {
            const double at = across(&l, n) / l.a, in = across(&l, n) / c;
            double truth = fabs(at) < 1 ? sqrt(1 - at * at) : 0;
            truth -= fabs(in) < 1 ? c / l.a * sqrt(1 - in * in) : 0;
            off = larger(off, hypot(q[0][n] - mu * (full.p[n] - less.p[n]), q[1][n]));
            far += fabs(q[0][n] - mu * p0 * truth);
            size += q[0][n];
        }
        print_message(
            "%s, %s the line, %zu nodes, F %.1f: %.1e of the superposition, %.1e of the closed "
            "form; stick %.4f, exact %.4f; displacement %.1e\n",
            rc_boundary_word(l.boundary), along ? "along" : "across", nodes, part, off / (mu * p0),
            far / size, f.stick_fraction, c / l.a, f.displacement[x] / moved - 1);
        assert_true(off < 1e-9 * mu * p0);
        assert_true(far / size < 1 / (double)nodes);
        assert_true(fabs(f.stick_fraction - c / l.a) < 2.4 / (double)nodes);
        assert_true(fabs(f.displacement[x] / moved - 1) < 0.1 / (double)nodes);
        assert_true(fabs(f.displacement[1 - x]) < 1e-9 * moved);
        pressed_free(&full);
        pressed_free(&less);
        rc_friction_solver_free(slip);
    }
}

/* A cycle between forces +-F dissipates 4 F d(F) - 8 integral of d dF to F (Mindlin and Deresiewicz 1953),
 * with d(F) above: of d the part s log(s)/2 mu P/(pi E*) 2 counts, s = 1 - F/(mu P). */
static void
test_loop(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        const struct line l = line_of(100, 2, k & 1, 500);
        const bool along = k & 2;
        const double nu = 0.3, part = 0.6, s = 1 - part,
                     unit = 2 * mu * l.load / exact_pi * (along ? 1 / (1 - nu) : 1);
        const double exact =
            mu * l.load * unit * (l.dy * (double)l.rows) *
            (2 * part * s * log(s) - 4 * (-0.25 - (s * s / 2 * log(s) - s * s / 4)));
        struct pressed c = press(&l, l.load);
        struct rc_friction_solver *slip = slip_on(&l, nu);
        struct rc_friction_increment f;
        double cycle = 0;

        assert_int_equal(rc_friction_solver_set_pressure(slip, c.p, c.gap, NULL), RC_OK);
        for (int leg = 0; leg < 3; leg++) {
            pull(slip, &l, along, (leg % 2 == 0 ? part : -part) * mu * l.load, &f);
            cycle += leg > 0 ? f.dissipated : 0;
            rc_friction_solver_keep(slip);
        }
        print_message("%s: loop %.5f of the closed form\n", along ? "along" : "across",
                      cycle / exact);
        assert_true(fabs(cycle / exact - 1) < 2e-3);
        pressed_free(&c);
        rc_friction_solver_free(slip);
    }
}

/* ---- dissimilar bodies ---- */

/* K(k)/K'(k) = mu/beta for k = c/a: the part that sticks while a load grows, if tractions do not change the
 * pressure (Spence 1975, J. Elast. 5, 297; the increment of the pressure is that of a flat punch). */
static double
spence(double friction, double beta)
{
    double low = 1e-9, high = 1 - 1e-12;

    for (int k = 0; k < 100; k++) {
        const double c = (low + high) / 2;
        if (gsl_sf_ellint_Kcomp(c, GSL_PREC_DOUBLE) * beta <
            gsl_sf_ellint_Kcomp(sqrt(1 - c * c), GSL_PREC_DOUBLE) * friction)
            low = c;
        else
            high = c;
    }
    return (low + high) / 2;
}

/* The part that sticks after a load alone, in so many increments of the half width. */
static double
press_alone(const struct line *l, double friction, size_t increments)
{
    const struct rc_pair pair = {.one = {.e = 0.91, .nu = 0.3}}; /* E* = 1, beta 2/7 */
    const struct rc_friction_law what = {
        .boundary = l->boundary, .pair = pair, .mu = friction, .tol = 1e-6};
    struct rc_friction_solver *slip = rc_friction_solver_new(&l->shape, &what, NULL);
    struct rc_friction_increment f;

    assert_non_null(slip);
    for (size_t k = 1; k <= increments; k++) {
        const double part = (double)k / (double)increments;
        struct pressed c = press(l, l->load * part * part);
        assert_int_equal(rc_friction_solver_set_pressure(slip, c.p, NULL, NULL), RC_OK);
        pull(slip, l, false, 0, &f);
        rc_friction_solver_keep(slip);
        pressed_free(&c);
    }
    rc_friction_solver_free(slip);
    return f.stick_fraction;
}

static void
test_a_load_alone(void **state)
{
    static const double mus[] = {0.1, 0.2, 0.4};

    (void)state;
    for (int k = 0; k < 3; k++) {
        const struct line l = line_of(200, 1, k == 1, 0);
        const double exact = spence(mus[k], 2 / 7.0);
        const double coarse = press_alone(&l, mus[k], 25), fine = press_alone(&l, mus[k], 50);
        print_message("mu %.1f: sticks %.3f, %.3f, so %.3f, Spence %.3f\n", mus[k], coarse, fine,
                      2 * fine - coarse, exact);
        assert_true(fabs(2 * fine - coarse - exact) < 0.0125); /* a node on both sides */
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_partial_slip),
        cmocka_unit_test(test_loop),
        cmocka_unit_test(test_a_load_alone),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
