/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws of steady rolling. B is monotone, and the solution is unique; rolling in time never leads away from
 * it; the energies agree. The tractions obey Coulomb's law. The error is within the estimate, the work is
 * bounded, and impossible requests are refused with the reason. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "libcontact/rolling/steady.h"
#include "rolling_case.h"
#include "tests/friction/slip_case.h"

static struct rc_err err;

enum {
    NX = 26,
    NY = 22,
    N = NX * NY
};

/* A rough contact with spin, in units of the cell over E*. `way`: a seed for its tractions at the start. */
static struct rc_steady *
rough(uint64_t way, double tol)
{
    const struct rc_shape shape = {NX, NY, 1, 1};
    const struct rc_shear shear = {1, 0.4, 0};
    struct rc_steady *d = rc_steady_new(NULL, &shape, RC_FREE, &shear, false, false, 1, &err);
    uint64_t seed = 3;

    assert_non_null(d);
    for (size_t k = 0; k < N; k++) {
        const double x = ((double)(k % NX) - 12) / 10, y = ((double)(k / NX) - 10) / 9;
        const double p = slip_noise(&seed) * (1 - x * x - y * y), turn = 6.3 * slip_noise(&way);
        d->g[k] = p > 0.05 ? 0.3 * p : 0;
        d->rigid[0][k] = 0.02 * y;
        d->rigid[1][k] = -0.02 * x;
        d->q[0][k] = d->g[k] * cos(turn);
        d->q[1][k] = d->g[k] * sin(turn);
    }
    d->v[0] = 0.02;
    d->v[1] = 0.01;
    d->asked.tol = tol;
    d->asked.most = 200;
    if (way == 0)
        rc_steady_guess(d);
    rc_steady_begin(d);
    return d;
}

static void
solve(struct rc_steady *d)
{
    enum rc_status status;

    while ((status = rc_steady_step(d, &err)) == RC_MORE)
        ;
    assert_int_equal(status, RC_OK);
}

/* Computes a'T b over both directions. shift: of q - S q, else of q. */
static double
product(struct rc_steady *d, const double *const q[2], bool shift)
{
    double *v[2] = {malloc(N * sizeof(double)), malloc(N * sizeof(double))},
           *u[2] = {malloc(N * sizeof(double)), malloc(N * sizeof(double))}, sum = 0;

    for (int c = 0; c < 2; c++)
        for (size_t k = 0; k < N; k++)
            v[c][k] = q[c][k] - (shift && (k + 1) % NX != 0 ? q[c][k + 1] : 0);
    rc_tangential_apply(d->t, v, u);
    for (int c = 0; c < 2; c++) {
        for (size_t k = 0; k < N; k++)
            sum += v[c][k] * u[c][k];
        free(v[c]);
        free(u[c]);
    }
    return sum;
}

/* q'Bq = |q - Sq|_T^2/2 holds for tractions off the edges. It is positive for any of them, and smallest for
 * even ones. */
static void
test_monotone(void **state)
{
    struct rc_steady *d = rough(0, 1e-6);
    double least = 1;

    (void)state;
    for (uint64_t seed = 1; seed <= 50; seed++) {
        uint64_t at = seed;
        double *q[2] = {d->step.old[0], d->step.old[1]}, qbq = 0, half, all = 0;
        const double *const v[2] = {q[0], q[1]};
        for (size_t k = 0; k < N; k++)
            for (int c = 0; c < 2; c++)
                q[c][k] = d->g[k] == 0 ? 0 : seed % 2 ? slip_noise(&at) : slip_noise(&at) - 0.5;
        rc_tangential_apply(d->t, q, d->u);
        for (size_t k = 0; k < N; k++)
            for (int c = 0; c < 2; c++) {
                qbq += d->g[k] == 0 ? 0 : q[c][k] * (d->u[c][k] - d->u[c][k + 1]);
                all += q[c][k] * q[c][k];
            }
        half = product(d, v, true) / 2;
        assert_true(fabs(qbq - half) < 1e-12 * all);
        least = fmin(least, qbq / (all * d->self));
    }
    printf("least q'Bq/(b q'q): %.3g\n", least);
    assert_true(least > 1e-2);
    rc_steady_free(d);
}

/* Three starts have one end. */
static void
test_unique(void **state)
{
    struct rc_steady *a = rough(0, 1e-11);

    (void)state;
    solve(a);
    for (uint64_t seed = 1; seed <= 3; seed++) {
        struct rc_steady *b = rough(seed, 1e-11);
        double off = 0;
        solve(b);
        for (size_t k = 0; k < N; k++)
            off += hypot(a->q[0][k] - b->q[0][k], a->q[1][k] - b->q[1][k]);
        assert_true(off < 1e-9 * a->found.size);
        rc_steady_free(b);
    }
    rc_steady_free(a);
}

/* Rolling in time comes nearer to the solution in each step, in the norm of T. */
static void
test_rolling_in_time(void **state)
{
    struct rc_steady *to = rough(0, 1e-11), *d = rough(7, 1e-6);
    double before = INFINITY, first = 0;

    (void)state;
    solve(to);
    for (int step = 0; step < 60; step++) {
        double *const q[2] = {d->step.old[0], d->step.old[1]};
        const double *const v[2] = {q[0], q[1]};
        double distance;
        for (int c = 0; c < 2; c++)
            for (size_t k = 0; k < N; k++)
                q[c][k] = d->q[c][k] - to->q[c][k];
        distance = sqrt(product(d, v, false));
        assert_true(distance < before || distance < 1e-5 * first);
        before = distance;
        first = step == 0 ? distance : first;
        d->found.estimate = 1e-6;
        assert_int_equal(rc_steady_roll(d, &err), RC_OK);
    }
    printf("distance after 60 nodes: %.2g of the first\n", before / first);
    assert_true(before < 1e-2 * first);
    rc_steady_free(to);
    rc_steady_free(d);
}

/* Slip is opposite to the traction, and occurs only where |q| = g. F.v = energy of slip + |q - Sq|_T^2/2. */
static void
test_conditions_and_energy(void **state)
{
    struct rc_steady *d = rough(0, 1e-12);
    double supplied = 0, lost = 0, most = 0, worst = 0;

    (void)state;
    solve(d);
    for (size_t k = 0; k < N; k++)
        most = fmax(most, hypot(d->s[0][k], d->s[1][k]) * (d->g[k] > 0));
    for (size_t k = 0; k < N; k++) {
        const double x = d->q[0][k], y = d->q[1][k], s = hypot(d->s[0][k], d->s[1][k]);
        if (d->g[k] == 0) {
            assert_true(x == 0 && y == 0);
            continue;
        }
        for (int c = 0; c < 2; c++) {
            supplied += d->q[c][k] * (d->v[c] - d->rigid[c][k]);
            lost -= d->q[c][k] * d->s[c][k];
        }
        worst = fmax(worst, hypot(x, y) / d->g[k] - 1);
        worst = fmax(
            worst,
            (d->face[k] == RC_FACE_STICK ? s : s + (d->s[0][k] * x + d->s[1][k] * y) / d->g[k]) /
                most);
    }
    printf("conditions %.2g; %.4g supplied, %.4g lost in slip\n", worst, supplied, lost);
    assert_true(worst < 1e-10);
    assert_true(fabs(supplied - lost - product(d, (const double *const *)d->q, true) / 2) <
                1e-12 * supplied);
    assert_true(lost < supplied);
    rc_steady_free(d);
}

/* ---- the model ---- */

/* n nodes over 2.2 semi-axes; mu p0/E* = 1e-3. */
static struct rc_model *
ellipse(size_t n, double ratio, double tol, bool force, double **p, double *load)
{
    const struct rc_shape shape = ellipse_shape(n, ratio, 1);
    const struct rc_rolling_problem law = {
        .law = {.pair.estar = 1e9, .nu = 0.28, .mu = 0.2, .tol = tol, .threads = 1},
        .force = force};

    *p = hertz_ellipse(&shape, ratio, 1, 5e6);
    *load = rolling_load(&shape, *p);
    return rolling_new(&shape, *p, law, &err);
}

/* Cases from nearly complete stick to nearly complete slip. Then the convolutions to 1e-2 and 1e-4 that are
 * enough for 48 and 96 nodes, as estimated. */
static const struct {
    double ratio, x, y, spin;
    size_t most[2];
} cases[] = {
    {0.5, 5e-4, 0, 0, {35, 60}}, {0.5, 1e-4, 0, 0, {40, 60}},     {2, 0, 3e-4, 1e-4, {40, 60}},
    {1, 0, 0, 1e-3, {35, 60}},   {1, 3e-4, 2e-4, 3e-4, {40, 60}}, {1, 3e-3, 0, 0, {15, 35}},
};

static double
distance(struct rc_model *m, const double *ref, size_t n, double *q)
{
    double off = 0, all = 0;

    assert_true(rc_model_frame(m, "traction-x", q, &err) == RC_OK &&
                rc_model_frame(m, "traction-y", q + n, &err) == RC_OK);
    for (size_t k = 0; k < n && ref != NULL; k++) {
        off += hypot(q[k] - ref[k], q[n + k] - ref[n + k]);
        all += hypot(ref[k], ref[n + k]);
    }
    return ref == NULL ? 0 : off / all;
}

static void
test_estimate_and_work(void **state)
{
    double least = INFINITY, most = 0;

    (void)state;
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++)
        for (size_t n = 48; n <= 96; n *= 2) {
            double *p, load, *ref = malloc(2 * n * n * sizeof *ref),
                             *q = malloc(2 * n * n * sizeof *q);
            struct rc_model *m = ellipse(n, cases[c].ratio, 1e-8, false, &p, &load);
            assert_true(ref != NULL && q != NULL);
            assert_int_equal(roll(m, load, cases[c].x, cases[c].y, cases[c].spin, false, &err),
                             RC_OK);
            distance(m, NULL, n * n, ref);
            rc_model_free(m);
            free(p);
            for (int t = 0; t < 2; t++) {
                const struct rc_rolling_figures *f;
                double off;
                m = ellipse(n, cases[c].ratio, t == 0 ? 1e-2 : 1e-4, false, &p, &load);
                assert_int_equal(roll(m, load, cases[c].x, cases[c].y, cases[c].spin, false, &err),
                                 RC_OK);
                f = rc_rolling_result(m);
                off = distance(m, ref, n * n, q);
                printf(
                    "case %zu, %zu nodes, F/limit %.3f, stick %.2f: error %.1e (told %.1e), %.0f "
                    "convolutions, spacing %.4f\n",
                    c, n, hypot(f->force[0], f->force[1]) / f->limit, f->stick_fraction, off,
                    f->traction_error, f->convolutions, f->discretization_error);
                least = fmin(least, f->traction_error / off);
                most = fmax(most, f->traction_error / off);
                assert_true(f->fallbacks == 0 && f->convolutions <= (double)cases[c].most[t]);
                rc_model_free(m);
                free(p);
            }
            free(ref);
            free(q);
        }
    printf("estimate over error: %.2f to %.2f\n", least, most);
    assert_true(least > 1 && most < 5);
}

/* The error of the spacing that 48 nodes tell, against 192. The force grows with the creepage. */
static void
test_spacing_and_curve(void **state)
{
    double *p, load, before = 0;
    struct rc_model *m;

    (void)state;
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        double force[2][2], told = 0, extrapolated[2];
        for (int k = 0; k < 2; k++) {
            const struct rc_rolling_figures *f;
            m = ellipse(k == 0 ? 48 : 192, cases[c].ratio, k == 0 ? 1e-3 : 1e-6, false, &p, &load);
            assert_int_equal(roll(m, load, cases[c].x, cases[c].y, cases[c].spin, false, &err),
                             RC_OK);
            f = rc_rolling_result(m);
            for (int d = 0; d < 2; d++) {
                force[k][d] = f->force[d];
                if (k == 0)
                    extrapolated[d] = f->extrapolated_force[d];
            }
            told = k == 0 ? f->discretization_error * hypot(f->force[0], f->force[1]) : told;
            if (k == 1)
                printf("case %zu: spacing %.2f of the estimate, extrapolated %.2f\n", c,
                       hypot(force[0][0] - f->extrapolated_force[0],
                             force[0][1] - f->extrapolated_force[1]) /
                           told,
                       hypot(extrapolated[0] - f->extrapolated_force[0],
                             extrapolated[1] - f->extrapolated_force[1]) /
                           told);
            if (k == 1)
                assert_true(hypot(force[0][0] - f->extrapolated_force[0],
                                  force[0][1] - f->extrapolated_force[1]) < told);
            rc_model_free(m);
            free(p);
        }
    }
    m = ellipse(24, 1, 1e-6, false, &p, &load);
    for (int k = 1; k < 12; k++) {
        assert_int_equal(roll(m, load, 3e-4 * k, 0, 2e-4, false, &err), RC_OK);
        assert_true(rc_rolling_result(m)->force[0] > before);
        before = rc_rolling_result(m)->force[0];
    }
    rc_model_free(m);
    free(p);
}

/* Where all nodes slip along the creepage, q = (mu p, 0) is exact: for nu = 0, and for a profile. */
static void
test_full_slide(void **state)
{
    static const double creep[] = {0.01, 0.03, 0.1};

    (void)state;
    for (int what = 0; what < 3; what++)
        for (size_t c = 0; c < 3; c++) {
            const struct rc_shape shape =
                what == 2 ? (struct rc_shape){64, 1, 0.03, 1000} : ellipse_shape(48, 1, 1);
            const struct rc_rolling_problem law = {.law = {.pair.estar = 1e9,
                                                           .nu = what == 2 ? 0.3 : 0,
                                                           .mu = 0.2,
                                                           .tol = 1e-6,
                                                           .threads = 1}};
            double *p = hertz_ellipse(&shape, 0.9, 1, 5e6), q[48 * 48];
            uint64_t seed = 7;
            struct rc_model *m;
            for (size_t k = 0; k < shape.nx * shape.ny && what == 1; k++)
                p[k] *= slip_noise(&seed);
            m = rolling_new(&shape, p, law, &err);
            assert_int_equal(roll(m, rolling_load(&shape, p), creep[c], 0, 0, false, &err), RC_OK);
            assert_int_equal(rc_model_frame(m, "traction-x", q, &err), RC_OK);
            for (size_t k = 0; k < shape.nx * shape.ny; k++)
                assert_true(fabs(q[k] - 0.2 * p[k]) <= 1e-12 * 5e6);
            assert_true(rc_rolling_result(m)->convolutions < 45);
            rc_model_free(m);
            free(p);
        }
}

/* With little creepage all nodes stick, the force is in proportion to it, and the work does not grow. */
static void
test_little_creepage(void **state)
{
    double *p, load, part = 0;
    struct rc_model *m = ellipse(48, 1, 1e-4, false, &p, &load);
    const struct rc_rolling_figures *f = rc_rolling_result(m);

    (void)state;
    for (double creep = 1e-12; creep < 1e-6; creep *= 1e3) {
        assert_int_equal(roll(m, load, creep, 0, 0, false, &err), RC_OK);
        part = creep == 1e-12 ? f->force[0] / creep : part;
        assert_true(f->slip_nodes == 0 && fabs(f->force[0] / (part * creep) - 1) < 1e-4);
        assert_true(f->convolutions < 110);
    }
    rc_model_free(m);
    free(p);
}

/* Friction energy is above 0 at nodes that slip, or is that of the trailing edge, and its sum is force times
 * creepage and moment times spin. Slip times the largest traction is the same energy. */
static void
test_dissipation(void **state)
{
    (void)state;
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        enum {
            NODES = 48 * 48
        };
        double *p, load, spent[NODES], slip[NODES], is[NODES], sum = 0, by_slip = 0;
        struct rc_model *m = ellipse(48, cases[c].ratio, 1e-3, false, &p, &load);
        const struct rc_rolling_figures *f = rc_rolling_result(m);
        assert_int_equal(roll(m, load, cases[c].x, cases[c].y, cases[c].spin, false, &err), RC_OK);
        assert_true(rc_model_frame(m, "dissipation", spent, &err) == RC_OK &&
                    rc_model_frame(m, "slip", slip, &err) == RC_OK &&
                    rc_model_frame(m, "state", is, &err) == RC_OK);
        for (size_t k = 0; k < NODES; k++) {
            const bool edge = k % 48 > 0 && is[k - 1] == 0;
            assert_true(spent[k] >= 0 && (spent[k] == 0 || is[k] == 2 || (is[k] == 1 && edge)));
            sum += spent[k] * 2.2 * 2.2 * cases[c].ratio / NODES;
            by_slip += 0.2 * p[k] * slip[k] * 2.2 * 2.2 * cases[c].ratio / NODES;
        }
        assert_true(fabs(sum / f->power_slip - 1) < 1e-12 && fabs(by_slip / sum - 1) < 1e-12);
        assert_true(fabs(f->force[0] * cases[c].x + f->force[1] * cases[c].y +
                         f->moment * cases[c].spin - sum) < 1e-12 * sum);
        rc_model_free(m);
        free(p);
    }
}

/* The creepage that a force finds gives this force. */
static void
test_force_given(void **state)
{
    (void)state;
    for (int k = 1; k <= 4; k++) {
        double *p, *other, load, creep[2];
        struct rc_model *m = ellipse(48, 1, 1e-6, true, &p, &load), *back;
        const double x = (k == 4 ? 0.97 : 0.3 * k) * 0.2 * load * 0.8, y = x * 0.75;
        const struct rc_rolling_figures *f = rc_rolling_result(m);
        assert_int_equal(roll(m, load, x, y, 1e-4, true, &err), RC_OK);
        assert_true(f->convolutions < 68);
        creep[0] = f->creep[0];
        creep[1] = f->creep[1];
        printf("%.2f of the limit: creepage %.4g, %.4g; %.0f convolutions\n",
               hypot(x, y) / f->limit, creep[0], creep[1], f->convolutions);
        back = ellipse(48, 1, 1e-6, false, &other, &load);
        assert_int_equal(roll(back, load, creep[0], creep[1], 1e-4, false, &err), RC_OK);
        f = rc_rolling_result(back);
        assert_true(hypot(f->force[0] - x, f->force[1] - y) < 1e-5 * f->limit);
        rc_model_free(m);
        rc_model_free(back);
        free(p);
        free(other);
    }
}

static void
refused(struct rc_model *m, double load, double x, double y, bool force, const char *why)
{
    if (m == NULL || roll(m, load, x, y, 0, force, &err) == RC_FAIL) {
        if (strstr(err.text, why) == NULL)
            fail_msg("\"%s\", not \"%s\"", err.text, why);
    } else {
        fail_msg("not refused: %s", why);
    }
    rc_model_free(m);
}

static void
test_refusals(void **state)
{
    const struct rc_shape shape = {16, 8, 1e-6, 1e-6};
    struct rc_rolling_problem law = {
        .law = {.pair.estar = 1e9, .nu = 0.3, .mu = 0.2, .threads = 1}};
    double p[128] = {0}, none[128] = {0}, load;
    struct rc_point to = {0};
    struct rc_model *m;

    (void)state;
    p[67] = p[68] = 1e6;
    load = rolling_load(&shape, p);
    refused(rolling_new(&shape, none, law, &err), 0, 1e-3, 0, false, "no node is in contact");
    refused(rolling_new(&shape, p, law, &err), load, 1, 0, true,
            "needs the creepage along x and y");
    law.force = true;
    refused(rolling_new(&shape, p, law, &err), load, 1e-3, 0, false,
            "needs the force along x and y");
    refused(rolling_new(&shape, p, law, &err), load, 0.2 * load, 0, true, "the bodies slide");
    m = rolling_new(&shape, p, law, &err);
    rc_point_set(&to, RC_LOAD, load);
    rc_point_set(&to, RC_CREEP_X, 1e-3);
    rc_point_set(&to, RC_TANGENTIAL_X, 0.1 * load);
    rc_point_set(&to, RC_TANGENTIAL_Y, 0);
    assert_int_equal(rc_model_run(m, &to, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "give the force only"));
    rc_model_free(m);
    law.force = false;
    p[79] = 1e6;
    refused(rolling_new(&shape, p, law, &err), rolling_load(&shape, p), 1e-3, 0, false,
            "leading edge");
    law.law.mu = 0;
    refused(rolling_new(&shape, p, law, &err), load, 1e-3, 0, false, "coefficient of friction 0");
    law.law.mu = 0.2;
    law.law.boundary = RC_PERIODIC;
    refused(rolling_new(&shape, p, law, &err), load, 1e-3, 0, false, "periodic along x");
    law.law.boundary.y = false;
    refused(rolling_new(&shape, p, law, &err), load, 1e-3, 0, false, "periodic along x");
}

/* The cases are one node, one column of nodes, a line of nodes, and no creepage. */
static void
test_small_contacts(void **state)
{
    const struct rc_shape shape = {16, 8, 1e-6, 2e-6};
    const struct rc_rolling_problem law = {
        .law = {.pair.estar = 1e9, .nu = 0.3, .mu = 0.2, .tol = 1e-8, .threads = 1}};

    (void)state;
    for (int what = 0; what < 4; what++) {
        double p[128] = {0};
        const struct rc_rolling_figures *f;
        struct rc_model *m;
        for (size_t k = 0; k < 128; k++)
            if (what == 0 ? k == 67 : what == 1 ? k % 16 == 5 : k / 16 == 3 && k % 16 < 14)
                p[k] = 1e6;
        m = rolling_new(&shape, p, law, &err);
        assert_int_equal(roll(m, rolling_load(&shape, p), what == 3 ? 0 : 1e-4, 0, 0, false, &err),
                         RC_OK);
        f = rc_rolling_result(m);
        assert_true(what == 3 ? f->force[0] == 0
                              : f->force[0] > 0 && f->force[0] <= f->limit * (1 + 1e-12));
        assert_true(fabs(f->force[1]) < 1e-6 * f->limit);
        rc_model_free(m);
    }
}

/* A look on the way shows the best tractions so far, in their bounds, and says that they have not
 * converged. */
static void
test_look_on_the_way(void **state)
{
    enum {
        NODES = 48 * 48
    };
    double *p, load, x[NODES], y[NODES];
    struct rc_model *m = ellipse(48, 1, 1e-6, false, &p, &load);
    struct rc_point to = {0};
    int looks = 0, rolling = 0;

    (void)state;
    rc_point_set(&to, RC_LOAD, load);
    rc_point_set(&to, RC_CREEP_X, 3e-4);
    rc_point_set(&to, RC_CREEP_Y, 0);
    assert_int_equal(rc_model_go(m, &to, &err), RC_MORE);
    while (rc_model_step(m, &err) == RC_MORE) {
        const struct rc_rolling_figures *f = rc_rolling_result(m);
        assert_true(rc_model_look(m, NULL, &err) == RC_OK &&
                    rc_model_frame(m, "traction-x", x, &err) == RC_OK &&
                    rc_model_frame(m, "traction-y", y, &err) == RC_OK);
        assert_true(!f->converged && f->traction_error > 1e-6);
        for (size_t k = 0; k < NODES; k++)
            assert_true(hypot(x[k], y[k]) <= 0.2 * p[k] * (1 + 1e-9));
        looks++;
        rolling += f->force[0] > 0.3 * f->limit && f->force[0] < 0.6 * f->limit;
    }
    printf("%d looks, %d of them at tractions near the last ones, %.3f\n", looks, rolling,
           rc_rolling_result(m)->force[0] / rc_rolling_result(m)->limit);
    assert_true(rolling >= looks - 3);
    rc_model_free(m);
    free(p);
}

/* ---- a path ---- */

/* The pressure of a step: that of the window, some columns further on a longer map. */
static void
lay(const struct rc_shape *window, const double *p, const struct rc_shape *map, size_t column,
    double *to)
{
    memset(to, 0, map->nx * map->ny * sizeof *to);
    for (size_t n = 0; n < window->nx * window->ny; n++)
        to[n / window->nx * map->nx + n % window->nx + column] = p[n];
}

enum {
    WAY = 70, /* steps of a path */
    SIDE = 24
};
/* A ball that is followed by its map, which has WAY columns more if it `stays`. */
struct path {
    struct rc_shape window, map;
    double *window_p, *p, load;
    bool stays;
    struct rc_rolling_contact known;
    struct rc_model *m;
};

static const struct rc_body soft = {.e = 2e9, .nu = 0.3}, hard = {.e = 6e9, .nu = 0.2};

static void
begin_path(struct path *a, bool stays, bool coupled, struct rc_boundary boundary, double tol)
{
    const struct rc_pair pair = {.one = soft, .two = coupled ? hard : soft};
    const struct rc_problem contact = {.pair = pair, .boundary = boundary, .threads = 1};
    const struct rc_rolling_problem law = {
        .law = {.pair = pair, .boundary = boundary, .mu = 0.2, .tol = tol, .threads = 1},
        .path = true,
        .known = &a->known};

    a->stays = stays;
    a->window = a->map = ellipse_shape(SIDE, 1, 1);
    a->map.nx += stays ? WAY : 0;
    a->window_p = hertz_ellipse(&a->window, 1, 1, 5e6);
    a->p = malloc(a->map.nx * a->map.ny * sizeof *a->p);
    assert_true(a->window_p != NULL && a->p != NULL);
    a->known.p = a->p;
    a->known.x = stays ? WAY / 2.0 * a->map.dx : 0;
    a->m = rc_rolling_new(rc_elastic_new(&a->map, a->p, &contact, NULL, &err), &law, &err);
    assert_non_null(a->m);
}

static void
end_path(struct path *a)
{
    rc_model_free(a->m);
    free(a->p);
    free(a->window_p);
}

/* Goes to step k, without keeping it. */
static const struct rc_rolling_figures *
roll_on(struct path *a, size_t k, const double creep[3])
{
    struct rc_point to = {0};

    lay(&a->window, a->window_p, &a->map, a->stays ? k : 0, a->p);
    rc_point_set(&to, RC_POSITION, (double)k * a->map.dx);
    if (!a->stays)
        a->known.x = to.at[RC_POSITION];
    rc_point_set(&to, RC_CREEP_X, creep[0]);
    rc_point_set(&to, RC_CREEP_Y, creep[1]);
    rc_point_set(&to, RC_SPIN, creep[2]);
    if (rc_model_run(a->m, &to, &err) != RC_OK || rc_model_look(a->m, NULL, &err) != RC_OK)
        fail_msg("step %zu: %s", k, err.text);
    return rc_rolling_result(a->m);
}

static void
tractions(struct path *a, double *q)
{
    const size_t n = a->map.nx * a->map.ny;

    assert_true(rc_model_frame(a->m, "traction-x", q, &err) == RC_OK &&
                rc_model_frame(a->m, "traction-y", q + n, &err) == RC_OK);
}

static const double turns[3] = {3e-4, 2e-4, 3e-4};

/* A map that follows the contact and one that stays give the same; in the end both roll steadily, dissimilar
 * bodies too. On the way the true error is within its estimate, and that within the tolerance. */
static void
test_path(void **state)
{
    (void)state;
    for (int coupled = 0; coupled < 2; coupled++) {
        struct path a[3];
        double q[2][2 * SIDE * SIDE], least = INFINITY, worst = 0, apart = 0, most = 0;
        struct rc_rolling_problem law = {
            .law = {.pair = {.one = soft, .two = coupled ? hard : soft},
                    .mu = 0.2,
                    .tol = 1e-7,
                    .threads = 1}};
        const struct rc_rolling_figures *f[3];
        struct rc_model *steady;

        for (int w = 0; w < 3; w++)
            begin_path(&a[w], w == 1, coupled, RC_FREE, w == 2 ? 1e-2 : 1e-7);
        for (size_t k = 0; k <= WAY; k++) {
            double off = 0, all = 0;
            for (int w = 0; w < 3; w++) {
                if (w == 1 && k % 7 == 3) /* a step that is not kept is forgotten */
                    roll_on(&a[w], k + 1 < WAY ? k + 1 : k, (const double[]){2e-3, 0, 0});
                f[w] = roll_on(&a[w], k, turns);
            }
            apart = fmax(apart, fabs(f[0]->force[0] - f[1]->force[0]) / f[0]->limit);
            apart = fmax(apart, fabs(f[0]->moment - f[1]->moment) / f[0]->limit);
            tractions(&a[0], q[0]);
            tractions(&a[2], q[1]);
            for (size_t n = 0; n < SIDE * SIDE; n++) {
                off += hypot(q[0][n] - q[1][n], q[0][n + SIDE * SIDE] - q[1][n + SIDE * SIDE]);
                all += hypot(q[0][n], q[0][n + SIDE * SIDE]);
            }
            worst = fmax(worst, k > 0 ? off / all : 0);
            most = fmax(most, f[2]->convolutions);
            if (off > 1e-6 * all)
                least = fmin(least, f[2]->traction_error / (off / all));
            for (int w = 0; w < 3; w++)
                assert_int_equal(rc_model_keep(a[w].m, &err), RC_OK);
        }
        steady = rolling_new(&a->window, a->window_p, law, &err);
        assert_int_equal(roll(steady, rolling_load(&a->window, a->window_p), turns[0], turns[1],
                              turns[2], false, &err),
                         RC_OK);
        printf("error %.1e, estimate over error %.2f or more, %.0f convolutions a step or less; "
               "%.1e apart; "
               "F/limit %.5f, steady %.5f\n",
               worst, least, most, apart, f[0]->force[0] / f[0]->limit,
               rc_rolling_result(steady)->force[0] / rc_rolling_result(steady)->limit);
        assert_true(worst < 1e-2 && least > 1 && apart < 1e-6);
        printf("friction energy %.5g, steady %.5g\n", f[0]->power_slip,
               rc_rolling_result(steady)->power_slip);
        assert_true(fabs(f[0]->power_slip / rc_rolling_result(steady)->power_slip - 1) < 1e-2);
        for (int c = 0; c < 2; c++)
            assert_true(fabs(f[0]->force[c] - rc_rolling_result(steady)->force[c]) <
                        5e-3 * f[0]->limit);
        rc_model_free(steady);
        for (int w = 0; w < 3; w++)
            end_path(&a[w]);
    }
}

/* A state in the middle of a step continues in another model, to the same tractions. On a periodic map the
 * contact leaves on one side and returns on the other. */
static void
test_path_state(void **state)
{
    (void)state;
    for (int periodic = 0; periodic < 2; periodic++) {
        struct path a, b;
        double q[2][2 * SIDE * SIDE], *saved, off = 0;
        struct rc_point to = {0};
        size_t n;
        bool going;

        begin_path(&a, false, true, periodic ? RC_PERIODIC : RC_FREE, 1e-6);
        begin_path(&b, false, true, periodic ? RC_PERIODIC : RC_FREE, 1e-6);
        for (size_t k = 0; k < 9; k++) {
            roll_on(&a, k, turns);
            assert_int_equal(rc_model_keep(a.m, &err), RC_OK);
        }
        lay(&a.window, a.window_p, &a.map, 0, a.p);
        a.known.x = 9 * a.map.dx;
        to = (struct rc_point){0};
        rc_point_set(&to, RC_POSITION, a.known.x);
        rc_point_set(&to, RC_CREEP_X, -1e-3);
        assert_int_equal(rc_model_go(a.m, &to, &err), RC_MORE);
        for (int k = 0; k < 3; k++)
            assert_int_equal(rc_model_step(a.m, &err), RC_MORE);
        n = rc_model_state_size(a.m);
        assert_non_null(saved = malloc(n * sizeof *saved));
        rc_model_state(a.m, saved);
        memcpy(b.p, a.p, SIDE * SIDE * sizeof *b.p);
        b.known.x = a.known.x;
        assert_int_equal(rc_model_restore(b.m, saved, n, &going, &err), RC_OK);
        assert_true(going);
        for (int w = 0; w < 2; w++) {
            struct rc_model *m = w == 0 ? a.m : b.m;
            while (rc_model_step(m, &err) == RC_MORE)
                ;
            assert_int_equal(rc_model_look(m, NULL, &err), RC_OK);
            tractions(w == 0 ? &a : &b, q[w]);
        }
        for (size_t k = 0; k < 2 * SIDE * SIDE; k++)
            off = fmax(off, fabs(q[0][k] - q[1][k]));
        printf("after a state the tractions are %.1e Pa apart\n", off);
        assert_true(off < 1e-5 * 0.2 * 5e6);
        free(saved);
        end_path(&a);
        end_path(&b);
    }
}

static void
test_path_refusals(void **state)
{
    struct path a;
    struct rc_point to = {0};

    (void)state;
    begin_path(&a, false, false, RC_FREE, 0);
    rc_point_set(&to, RC_CREEP_X, 1e-3);
    rc_point_set(&to, RC_CREEP_Y, 0);
    assert_int_equal(rc_model_run(a.m, &to, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "needs the position"));
    roll_on(&a, 4, turns);
    assert_int_equal(rc_model_keep(a.m, &err), RC_OK);
    rc_point_set(&to, RC_POSITION, 3 * a.map.dx);
    assert_int_equal(rc_model_run(a.m, &to, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "rolling is towards +x"));
    rc_point_set(&to, RC_POSITION, 9 * a.map.dx); /* there is one free column */
    a.known.x = 9 * a.map.dx;
    assert_int_equal(rc_model_run(a.m, &to, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "as many free columns as the map moves"));
    a.known.x = 3 * a.map.dx;
    assert_int_equal(rc_model_run(a.m, &to, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "moves back by 1 columns"));
    end_path(&a);
}

/* ---- increments of friction ---- */

/* A ball rolls from rest over a longer map, by one column in each increment of friction, which knows
 * nothing of rolling. A path in a map that follows the ball gives the same forces. */
static void
test_increments(void **state)
{
    const double creep[3] = {6e-4, 0, 0};
    struct rc_friction_law law = {.pair = {.one = soft, .two = soft}, .mu = 0.2, .tol = 1e-7};
    struct rc_friction_increment f;
    struct rc_shape map;
    struct rc_friction_solver *slip;
    struct path a;
    double *p, off = 0, first = 0;

    (void)state;
    begin_path(&a, false, false, RC_FREE, 1e-7);
    map = (struct rc_shape){a.map.nx + WAY, a.map.ny, a.map.dx, a.map.dy};
    p = malloc(map.nx * map.ny * sizeof *p);
    slip = rc_friction_solver_new(&map, &law, &err);
    assert_true(p != NULL && slip != NULL);
    for (size_t k = 0; k <= WAY; k++) {
        const struct rc_rolling_figures *path = roll_on(&a, k, creep);
        lay(&a.window, a.window_p, &map, k, p);
        assert_int_equal(rc_friction_solver_set_pressure(slip, p, NULL, &err), RC_OK);
        assert_int_equal(
            rc_friction_solver_set_displacement(slip, creep[0] * (double)k * map.dx, 0, &err),
            RC_OK);
        assert_int_equal(slip_solve(slip, &f), RC_OK);
        rc_friction_solver_keep(slip);
        off = fmax(off, fabs(f.force[0] - path->force[0]) / f.limit);
        first = k == 10 ? f.force[0] : first;
        assert_int_equal(rc_model_keep(a.m, &err), RC_OK);
    }
    printf("F/limit %.5f, then %.5f; %.1e apart\n", first / f.limit, f.force[0] / f.limit, off);
    assert_true(off < 1e-5 && first < 0.9 * f.force[0]);
    rc_friction_solver_free(slip);
    end_path(&a);
    free(p);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_monotone),          cmocka_unit_test(test_unique),
        cmocka_unit_test(test_rolling_in_time),   cmocka_unit_test(test_conditions_and_energy),
        cmocka_unit_test(test_estimate_and_work), cmocka_unit_test(test_spacing_and_curve),
        cmocka_unit_test(test_full_slide),        cmocka_unit_test(test_dissipation),
        cmocka_unit_test(test_little_creepage),   cmocka_unit_test(test_force_given),
        cmocka_unit_test(test_refusals),          cmocka_unit_test(test_small_contacts),
        cmocka_unit_test(test_look_on_the_way),   cmocka_unit_test(test_path),
        cmocka_unit_test(test_path_state),        cmocka_unit_test(test_path_refusals),
        cmocka_unit_test(test_increments),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
