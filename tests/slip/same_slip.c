/* Tractions of minimal energy equal those of another method: one node after another is minimised exactly on
 * its disc until nothing changes, and Newton's method finds the displacement for the force; dense matrices,
 * up to 24 nodes, with a history; also given displacements on periodic maps, where the contact may be
 * complete. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdio.h>

#include "libcontact/slip/slip.h"
#include "slip_case.h"

enum {
    MOST = 24,
    PROBLEMS = 20,
    PERIODIC = 80
};
static const double bound = 1e-9;

struct dense {
    size_t n;
    double t[2 * MOST][2 * MOST]; /* u = T q, first the x components of all nodes, then y */
    double g[MOST], w[2 * MOST];
};

/* The columns of T from the closed form for a uniform rectangle, E* = 1 (Love 1929, as in Johnson 1985,
 * section 3.5); truth_slip_kernel compares them with integrals of point loads. */
static double
corner(int kind, double x, double y)
{
    double a = y == 0 ? 0 : y * asinh(x / fabs(y)), b = x == 0 ? 0 : x * asinh(y / fabs(x));

    return kind == 0 ? a : kind == 1 ? b : -hypot(x, y);
}

static double
rectangle(int kind, double x, double y, double dx, double dy)
{
    return (corner(kind, x + dx / 2, y + dy / 2) - corner(kind, x - dx / 2, y + dy / 2) -
            corner(kind, x + dx / 2, y - dy / 2) + corner(kind, x - dx / 2, y - dy / 2)) /
           exact_pi;
}

static void
dense_matrix(struct dense *d, const struct rc_shape *s, double kap)
{
    d->n = s->nx * s->ny;
    for (size_t i = 0; i < d->n; i++)
        for (size_t j = 0; j < d->n; j++) {
            double x = ((double)(i % s->nx) - (double)(j % s->nx)) * s->dx;
            double y = ((double)(i / s->nx) - (double)(j / s->nx)) * s->dy;
            double xx = rectangle(0, x, y, s->dx, s->dy), yy = rectangle(1, x, y, s->dx, s->dy);
            double xy = rectangle(2, x, y, s->dx, s->dy);
            d->t[i][j] = (1 + kap) * xx + yy;
            d->t[d->n + i][d->n + j] = xx + (1 + kap) * yy;
            d->t[i][d->n + j] = d->t[d->n + i][j] = kap * xy;
        }
}

/* The same on a periodic map, from the response to a wave: 2/k along it and 2(1 + kap)/k across it; 0 for the
 * mean, and 0 across for waves of two nodes. */
static void
periodic_matrix(struct dense *d, const struct rc_shape *s, double kap)
{
    d->n = s->nx * s->ny;
    memset(d->t, 0, sizeof d->t);
    for (size_t wave = 1; wave < d->n; wave++) {
        size_t a = wave % s->nx, b = wave / s->nx;
        double kx = 2 * exact_pi * ((double)a - (2 * a > s->nx ? (double)s->nx : 0)) /
                    ((double)s->nx * s->dx);
        double ky = 2 * exact_pi * ((double)b - (2 * b > s->ny ? (double)s->ny : 0)) /
                    ((double)s->ny * s->dy);
        double k2 = kx * kx + ky * ky, unit = 2 / (sqrt(k2) * (double)d->n);
        bool nyquist = 2 * a == s->nx || 2 * b == s->ny;
        for (size_t i = 0; i < d->n; i++)
            for (size_t j = 0; j < d->n; j++) {
                double x = ((double)(i % s->nx) - (double)(j % s->nx)) * s->dx;
                double y = ((double)(i / s->nx) - (double)(j / s->nx)) * s->dy;
                double wavy = unit * cos(kx * x + ky * y);
                double cross = nyquist ? 0 : -kap * kx * ky / k2 * wavy;
                d->t[i][j] += (1 + kap * ky * ky / k2) * wavy;
                d->t[d->n + i][d->n + j] += (1 + kap * kx * kx / k2) * wavy;
                d->t[i][d->n + j] += cross;
                d->t[d->n + i][j] += cross;
            }
    }
}

/* min q'A q/2 - b'q over |q| <= g, A 2 x 2: (A + m)q = b, with the m >= 0 that puts it on the circle, m is
 * found by bisection to the last bit. */
static void
on_disc(const double a[3], const double b[2], double g, double q[2])
{
    double low = 0, high = hypot(b[0], b[1]) / (g > 0 ? g : 1) + 1, m = 0;

    if (g == 0) {
        q[0] = q[1] = 0;
        return;
    }
    for (int k = 0; k < 200; k++) {
        double det = (a[0] + m) * (a[1] + m) - a[2] * a[2];
        q[0] = ((a[1] + m) * b[0] - a[2] * b[1]) / det;
        q[1] = ((a[0] + m) * b[1] - a[2] * b[0]) / det;
        if (hypot(q[0], q[1]) <= g) {
            if (m == 0)
                return;
            high = m;
        } else {
            low = m;
        }
        m = (low + high) / 2;
    }
}

static void
relax(const struct dense *d, const double delta[2], double *q)
{
    for (int sweep = 0; sweep < 20000; sweep++) {
        double change = 0, size = 0;
        for (size_t i = 0; i < d->n; i++) {
            size_t at[2] = {i, d->n + i};
            double a[3] = {d->t[at[0]][at[0]], d->t[at[1]][at[1]], d->t[at[0]][at[1]]}, b[2], x[2];
            for (int c = 0; c < 2; c++) {
                b[c] = d->w[at[c]] + delta[c];
                for (size_t j = 0; j < 2 * d->n; j++)
                    if (j != at[0] && j != at[1])
                        b[c] -= d->t[at[c]][j] * q[j];
            }
            on_disc(a, b, d->g[i], x);
            for (int c = 0; c < 2; c++) {
                change = fmax(change, fabs(x[c] - q[at[c]]));
                size = fmax(size, fabs(x[c]));
                q[at[c]] = x[c];
            }
        }
        if (change <= 1e-15 * size)
            break;
    }
}

static void
sum_of(const struct dense *d, const double *q, double sum[2])
{
    sum[0] = sum[1] = 0;
    for (size_t i = 0; i < d->n; i++) {
        sum[0] += q[i];
        sum[1] += q[d->n + i];
    }
}

/* The displacement under which the tractions carry `load`. Their sum is the gradient of a convex function of
 * the displacement; Newton's method is damped until it does not overshoot. */
static void
carry(const struct dense *d, const double load[2], double delta[2], double *q)
{
    double size = 0;

    for (size_t i = 0; i < d->n; i++)
        size += d->g[i];
    for (int step = 0; step < 100; step++) {
        double f[2], j[2][2], h = 1e-6, trial[2 * MOST], det, move[2], part = 1, there[2];
        relax(d, delta, q);
        sum_of(d, q, f);
        f[0] -= load[0];
        f[1] -= load[1];
        if (hypot(f[0], f[1]) < 1e-14 * size)
            return;
        for (int c = 0; c < 2; c++) {
            double other[2] = {delta[0], delta[1]};
            double step_size = h * (1 + fabs(delta[c]));
            other[c] += step_size;
            memcpy(trial, q, sizeof trial);
            relax(d, other, trial);
            sum_of(d, trial, there);
            for (int r = 0; r < 2; r++)
                j[r][c] = (there[r] - load[r] - f[r]) / step_size;
        }
        /* if all nodes slide in one direction the derivative is 0: a small number is added */
        for (int c = 0; c < 2; c++)
            j[c][c] += 1e-6;
        det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
        move[0] = -(j[1][1] * f[0] - j[0][1] * f[1]) / det;
        move[1] = -(j[0][0] * f[1] - j[1][0] * f[0]) / det;
        for (;; part /= 2) {
            double other[2] = {delta[0] + part * move[0], delta[1] + part * move[1]};
            memcpy(trial, q, sizeof trial);
            relax(d, other, trial);
            sum_of(d, trial, there);
            if (hypot(there[0] - load[0], there[1] - load[1]) < hypot(f[0], f[1]) || part < 1e-8)
                break;
        }
        delta[0] += part * move[0];
        delta[1] += part * move[1];
    }
}

static void
test_another_method_finds_the_same(void **state)
{
    double worst = 0, moved = 0;
    size_t stuck = 0, slid = 0;

    (void)state;
    for (int problem = 0; problem < PROBLEMS; problem++) {
        uint64_t seed = 77 + (uint64_t)problem;
        static const struct rc_shape shapes[] = {{6, 4, 1, 1},   {4, 5, 1, 1.7}, {3, 3, 1, 1},
                                                 {8, 3, 0.6, 1}, {2, 1, 1, 1},   {1, 7, 1, 1}};
        const struct rc_shape shape = shapes[problem % 6];
        size_t n = shape.nx * shape.ny;
        double nu = problem % 3 == 0 ? 0 : 0.5 * slip_noise(&seed), kap = nu / (1 - nu);
        bool given = problem % 4 == 3;
        struct rc_slip_problem what = {.pair.estar = 1,
                                       .nu = nu,
                                       .mu = 0.1 + slip_noise(&seed),
                                       .tau_max = problem % 5 == 2 ? 0.2 : 0,
                                       .tol = 1e-13};
        struct rc_err err;
        struct rc_slip *slip = rc_slip_new(&shape, &what, &err);
        struct dense d = {.n = 0};
        double q[2 * MOST] = {0}, delta[2] = {0, 0}, origin[2 * MOST] = {0};

        assert_non_null(slip);
        dense_matrix(&d, &shape, kap);
        for (int increment = 0; increment < 3; increment++) {
            double p[MOST], limit = 0, load[2], angle = 6.3 * slip_noise(&seed), size = 0, far = 0;
            struct rc_slip_figures figures;
            enum rc_status status;
            for (size_t k = 0; k < n; k++) {
                p[k] = fmax(0, slip_noise(&seed) - 0.2);
                if (k == 0)
                    p[k] = 0.5;
                d.g[k] = fmin(what.mu * p[k], what.tau_max > 0 ? what.tau_max : INFINITY);
                limit += d.g[k];
            }
            memcpy(d.w, origin, sizeof origin);
            for (int c = 0; c < 2; c++)
                load[c] =
                    (0.1 + 0.85 * slip_noise(&seed)) * limit * (c == 0 ? cos(angle) : sin(angle));
            assert_int_equal(rc_slip_set_pressure(slip, p, NULL, &err), RC_OK);
            if (given) {
                for (int c = 0; c < 2; c++)
                    delta[c] = (slip_noise(&seed) - 0.5) * 2 * limit / sqrt((double)n);
                relax(&d, delta, q);
                assert_int_equal(rc_slip_set_displacement(slip, delta[0], delta[1], &err), RC_OK);
            } else {
                carry(&d, load, delta, q);
                assert_int_equal(rc_slip_set_force(slip, load[0] * shape.dx * shape.dy,
                                                   load[1] * shape.dx * shape.dy, &err),
                                 RC_OK);
            }
            status = slip_solve(slip, &figures);
            if (status != RC_OK)
                print_message("problem %d, increment %d: %d after %zu, estimate %.1e\n", problem,
                              increment, status, figures.steps, figures.traction_error);
            for (size_t k = 0; k < 2 * n; k++) {
                far = fmax(far, fabs(rc_slip_traction(slip, k >= n)[k % n] - q[k]));
                size = fmax(size, fabs(q[k]));
            }
            stuck += figures.stick_nodes;
            slid += figures.slip_nodes;
            worst = larger(worst, far / size);
            if (figures.stick_nodes >
                0) /* otherwise delta is nearly undetermined if all nodes slide in one direction */
                for (int c = 0; c < 2; c++)
                    moved = larger(moved, fabs(figures.displacement[c] - delta[c]) /
                                              hypot(delta[0], delta[1]));
            for (size_t k = 0; k < 2 * n; k++) {
                origin[k] = -delta[k >= n];
                for (size_t j = 0; j < 2 * n; j++)
                    origin[k] += d.t[k][j] * q[j];
            }
            rc_slip_keep(slip);
        }
        rc_slip_free(slip);
    }
    print_message("tractions %.1e, displacements %.1e; %zu stick, %zu slip\n", worst, moved, stuck,
                  slid);
    assert_true(worst < bound && moved < bound);
    assert_true(stuck > 100 && slid > 100);
}

/* A periodic map moved by three displacements, small or large, for partial and complete contact. If all nodes
 * stick nothing resists the mean motion, and with continuing motion they slide. */
static void
test_displacements_of_periodic_maps(void **state)
{
    static const struct rc_shape shapes[] = {{6, 4, 1, 1},   {4, 5, 1, 1.7}, {3, 3, 1, 1},
                                             {8, 3, 0.6, 1}, {4, 4, 1, 3},   {1, 7, 1, 1}};
    double worst = 0;
    size_t most = 0, slid = 0, stuck = 0, wrong = 0;

    (void)state;
    for (int problem = 0; problem < PERIODIC; problem++) {
        uint64_t seed = 4321 + (uint64_t)problem;
        const struct rc_shape shape = shapes[problem % 6];
        size_t n = shape.nx * shape.ny;
        double nu = problem % 3 == 0 ? 0 : 0.5 * slip_noise(&seed);
        struct rc_slip_problem what = {
            .boundary = RC_PERIODIC, .pair.estar = 1, .nu = nu, .mu = 0.3, .tol = 1e-12};
        struct rc_slip *slip = rc_slip_new(&shape, &what, NULL);
        struct dense d;
        double q[2 * MOST] = {0}, delta[2] = {0, 0}, origin[2 * MOST] = {0}, p[MOST];
        double missing = problem % 4 < 2 ? 0 : 0.4, far = pow(10, 2 - 4 * slip_noise(&seed));

        assert_non_null(slip);
        periodic_matrix(&d, &shape, nu / (1 - nu));
        for (size_t k = 0; k < n; k++) {
            p[k] = fmax(0, slip_noise(&seed) - missing) + (k == 0 ? 0.5 : 0);
            d.g[k] = what.mu * p[k];
        }
        for (int increment = 0; increment < 3; increment++) {
            struct rc_slip_figures figures;
            double off = 0, size = 0;
            enum rc_status status;
            memcpy(d.w, origin, sizeof origin);
            for (int c = 0; c < 2; c++)
                delta[c] += far * (slip_noise(&seed) - 0.5);
            relax(&d, delta, q);
            assert_int_equal(rc_slip_set_pressure(slip, p, NULL, NULL), RC_OK);
            assert_int_equal(rc_slip_set_displacement(slip, delta[0], delta[1], NULL), RC_OK);
            status = slip_solve(slip, &figures);
            for (size_t k = 0; k < 2 * n; k++) {
                off = fmax(off, fabs(rc_slip_traction(slip, k >= n)[k % n] - q[k]));
                size = fmax(size, fabs(q[k]));
            }
            if (status != RC_OK || off > bound * size)
                print_message("problem %d, increment %d: %d after %zu steps, off by %.1e, estimate "
                              "%.1e\n",
                              problem, increment, status, figures.steps, off / size,
                              figures.traction_error),
                    wrong++;
            most = figures.steps > most ? figures.steps : most;
            worst = larger(worst, off / size);
            stuck += figures.stick_nodes;
            slid += figures.slip_nodes;
            for (size_t k = 0; k < 2 * n; k++) {
                origin[k] = -delta[k >= n];
                for (size_t j = 0; j < 2 * n; j++)
                    origin[k] += d.t[k][j] * q[j];
            }
            rc_slip_keep(slip);
        }
        rc_slip_free(slip);
    }
    print_message("tractions %.1e, up to %zu steps; %zu stick, %zu slip\n", worst, most, stuck,
                  slid);
    assert_int_equal(wrong, 0);
    assert_true(stuck > 300 && slid > 300);
}

/* ---- the model of friction, and rc_solver and rc_slip driven by hand ---- */

enum {
    SIDE = 20,
    NODES = SIDE * SIDE,
    EACH = 3 /* increments from point to point */
};

struct by_hand {
    struct rc_solver *solver;
    struct rc_slip *slip;
    double h[NODES], less[NODES], gap[NODES];
};

static struct by_hand *
by_hand_new(const struct rc_shape *shape, const double *h, const struct rc_problem *contact,
            const struct rc_slip_problem *slip)
{
    struct by_hand *b = malloc(sizeof *b);
    struct rc_slip_figures f;
    struct rc_contact apart;

    b->solver = rc_solver_new(shape, h, contact, NULL);
    b->slip = rc_slip_new(shape, slip, NULL);
    assert_true(b->solver != NULL && b->slip != NULL);
    memcpy(b->h, h, sizeof b->h);
    rc_contact_apart(NULL, shape, h, b->gap, &apart);
    assert_int_equal(rc_slip_set_pressure(b->slip, NULL, b->gap, NULL), RC_OK);
    assert_int_equal(rc_slip_set_force(b->slip, 0, 0, NULL), RC_OK);
    assert_int_equal(slip_solve(b->slip, &f), RC_OK);
    rc_slip_keep(b->slip);
    return b;
}

/* One increment, in so many passes of pressure and tractions; its approach from first touch of h. */
static double
by_hand_go(struct by_hand *b, const double to[3], bool moved, bool full, struct rc_slip_figures *f)
{
    struct rc_contact contact;
    double top = -INFINITY, less = -INFINITY;

    for (int pass = 0; pass < (full ? 30 : 1); pass++) {
        rc_slip_normal(b->slip, b->less);
        top = less = -INFINITY;
        for (size_t k = 0; k < NODES; k++) {
            b->less[k] = b->h[k] - (full ? b->less[k] : 0);
            top = fmax(top, b->h[k]);
            less = fmax(less, b->less[k]);
        }
        assert_int_equal(rc_solver_set_heights(b->solver, b->less, NULL), RC_OK);
        assert_int_equal(rc_solver_set_load(b->solver, to[0], 0, NULL), RC_OK);
        while (rc_solver_step(b->solver) == RC_MORE)
            ;
        rc_solver_result(b->solver, NULL, b->gap, &contact);
        assert_int_equal(rc_slip_set_pressure(b->slip, rc_solver_pressure(b->solver), b->gap, NULL),
                         RC_OK);
        assert_int_equal(moved ? rc_slip_set_displacement(b->slip, to[1], to[2], NULL)
                               : rc_slip_set_force(b->slip, to[1], to[2], NULL),
                         RC_OK);
        assert_int_equal(slip_solve(b->slip, f), RC_OK);
    }
    rc_slip_keep(b->slip);
    return contact.approach + top - less;
}

/* Largest distance of the results at points of a path, relative, under loads, and forces or displacements. */
static double
apart_from_hand(const struct rc_problem *contact, const struct rc_friction_problem *law,
                const double (*at)[3], size_t points, bool moved)
{
    const struct rc_shape shape = {SIDE, SIDE, 1e-6, 1e-6};
    const bool full = law->coupling == RC_COUPLING_FULL && law->slip.pair.estar == 0;
    double *h = slip_rough(&shape, 0.1, 4e-6, 3), q[2][NODES], before[3] = {0, 0, 0}, worst = 0;
    struct rc_model *m = slip_model(&shape, h, contact, law, NULL);
    struct by_hand *b = by_hand_new(&shape, h, contact, &law->slip);

    assert_non_null(m);
    for (size_t k = 0; k < points; k++) {
        const struct rc_leg falls = {.increments = EACH, .falls = at[k][0] < before[0]};
        struct rc_slip_figures f;
        double approach = 0;
        for (size_t i = 1; i <= EACH; i++) {
            double v[3];
            for (int a = 0; a < 3; a++)
                v[a] = before[a] + (at[k][a] - before[a]) * rc_leg_part(&falls, i, EACH);
            approach = by_hand_go(b, v, moved, full, &f);
        }
        assert_int_equal(slip_go(m, at[k][0], at[k][1], at[k][2], moved, NULL), RC_OK);
        assert_true(rc_model_frame(m, "traction-x", q[0], NULL) == RC_OK &&
                    rc_model_frame(m, "traction-y", q[1], NULL) == RC_OK);
        worst = larger(worst, slip_distance(NODES, (const double *[2]){q[0], q[1]},
                                            (const double *[2]){rc_slip_traction(b->slip, 0),
                                                                rc_slip_traction(b->slip, 1)}));
        worst = larger(worst, fabs(rc_friction_result(m)->approach / approach - 1));
        worst = larger(worst, fabs(rc_model_number(m, moved ? "tangential_x" : "displacement_x") /
                                       (moved ? f.force[0] : f.displacement[0]) -
                                   1));
        assert_int_equal(rc_model_keep(m, NULL), RC_OK);
        memcpy(before, at[k], sizeof before);
    }
    rc_solver_free(b->solver);
    rc_slip_free(b->slip);
    free(b);
    rc_model_free(m);
    free(h);
    return worst;
}

static void
test_model(void **state)
{
    static const double forces[][3] = {{2e-3, 3e-4, 1e-4}, {3e-3, -2e-4, 4e-4}, {1e-3, 1e-4, 1e-4}};
    static const double moves[][3] = {{2e-3, 1e-8, 2e-9}, {3e-3, -1e-8, 5e-9}, {1e-3, 3e-8, 1e-9}};
    struct rc_problem contact = {.pair.estar = 1e9, .load = 1e-3, .tol = 1e-9, .threads = 1};
    struct rc_friction_problem law = {
        .slip = {.pair.estar = 1e9, .nu = 0.3, .mu = 0.3, .tol = 1e-8, .threads = 1},
        .increments = EACH};

    (void)state;
    assert_true(apart_from_hand(&contact, &law, forces, 3, false) < 1e-6);
    assert_true(apart_from_hand(&contact, &law, moves, 3, true) < 1e-6);
    contact.pair = law.slip.pair = (struct rc_pair){.one = {1e9, 0.3}, .two.e = INFINITY};
    law.slip.nu = 0;
    assert_true(apart_from_hand(&contact, &law, moves, 3, true) < 1e-5);
    law.coupling = RC_COUPLING_GOODMAN;
    assert_true(apart_from_hand(&contact, &law, forces, 3, false) < 1e-6);
}

/* Requests that a model of friction refuses, with their messages. */
static void
test_model_refuses(void **state)
{
    const struct rc_shape shape = {8, 8, 1e-6, 1e-6};
    const struct rc_friction_problem law = {.slip = {.pair.estar = 1e9, .nu = 0.3, .mu = 0.3}};
    const struct rc_problem contact = {.pair.estar = 1e9};
    double *h = slip_sphere(&shape, 1e-4);
    struct rc_err err = {""};
    struct rc_model *m =
        rc_friction_new(rc_elastic_new(&shape, h, &contact, NULL, &err), h, &law, &err);
    struct rc_point to = {0};

    (void)state;
    assert_non_null(m);
    rc_point_set(&to, RC_LOAD, 1e-4);
    assert_int_equal(rc_model_go(m, &to, &err), RC_FAIL);
    assert_string_equal(err.text, "a point of the friction model needs the tangential_x");
    rc_point_set(&to, RC_FORCE_X, 1e-5);
    rc_point_set(&to, RC_SHIFT_Y, 1e-9);
    assert_int_equal(rc_model_go(m, &to, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "give two forces or two displacements"));
    rc_point_set(&to, RC_FORCE_Y, 1e-4); /* more than mu P */
    assert_int_equal(rc_model_run(m, &to, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "friction carries less than"));
    rc_point_set(&to, RC_FORCE_Y, 0);
    assert_int_equal(rc_model_run(m, &to, &err), RC_OK); /* as without the failure */
    rc_model_free(m);
    assert_null(rc_friction_new(NULL, h, &law, &err));
    free(h);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_model),
        cmocka_unit_test(test_model_refuses),
        cmocka_unit_test(test_another_method_finds_the_same),
        cmocka_unit_test(test_displacements_of_periodic_maps),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
