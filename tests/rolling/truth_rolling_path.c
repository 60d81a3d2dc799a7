/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A path of rolling with spin on a map that repeats along one axis or both is that of dense matrices,
 * which know nothing of transforms and of faces, with distances from the nearest middle. It does not
 * depend on where the map begins. A contact that reaches half a period from its middle is refused with
 * spin, and has no moment without. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "tests/friction/dense.h"
#include "rolling_case.h"
#include "tests/friction/slip_case.h"

static struct rc_err err;

enum {
    STEPS = 4
};

/* A rough ball that rolls over the end of its map. */
struct way {
    struct rc_shape shape;
    struct rc_boundary boundary;
    double nu, mu, creep[3], start, length; /* m: position of the first point, of a step */
    double axes[2];                         /* m: of the contact                         */
    uint64_t seed;                          /* of the roughness                          */
};

static double
between(uint64_t *seed, double low, double high)
{
    return low + (high - low) * slip_noise(seed);
}

/* m: node k from the nearest image of the middle. */
static void
nearest(const struct way *w, size_t k, double position, double ahead, double at[2])
{
    const struct rc_shape *s = &w->shape;

    at[0] = ((double)(k % s->nx) - (double)(s->nx - 1) / 2) * s->dx + ahead - position;
    at[1] = ((double)(k / s->nx) - (double)(s->ny - 1) / 2) * s->dy;
    if (w->boundary.x)
        at[0] = remainder(at[0], (double)s->nx * s->dx);
}

/* On a map that ends the contact stays within it. */
static struct way
random_way(uint64_t *seed, struct rc_boundary boundary)
{
    static const size_t sides[][2] = {{8, 8}, {9, 7}, {16, 4}, {12, 5}, {7, 9}, {10, 6}};
    const size_t which = (size_t)between(seed, 0, 6);
    struct way w = {.shape = {sides[which][0], sides[which][1], between(seed, .5, 2), 1}};
    const double period[2] = {(double)w.shape.nx * w.shape.dx, (double)w.shape.ny};

    w.nu = between(seed, 0, 0.5);
    w.mu = between(seed, 0.1, 0.6);
    w.length = w.shape.dx * (which % 2 ? 1 : between(seed, 0.3, 1.7));
    for (int c = 0; c < 2; c++)
        w.axes[c] =
            between(seed, 0.2, 0.5) * (period[c] - (c == 0 ? 2 * w.length + w.shape.dx : 1));
    w.start = between(seed, -1, 1) * period[0];
    w.boundary = boundary;
    if (!boundary.x) {
        w.axes[0] = fmax(0.4 * w.axes[0], w.shape.dx);
        w.start = -period[0] / 2 + w.axes[0] + w.shape.dx;
        w.length = fmin(w.length, (-2 * w.start - w.shape.dx) / (STEPS + 1));
    }
    for (int c = 0; c < 3; c++)
        w.creep[c] = between(seed, -1, 1) * w.mu / (c == 2 ? w.axes[1] : 1);
    w.seed = (uint64_t)between(seed, 1, 1e6);
    return w;
}

/* The pressure at a position, as high as the axes: its roughness belongs to the ball. */
static void
press(const struct way *w, double position, double *p)
{
    const size_t n = w->shape.nx * w->shape.ny;

    for (size_t k = 0; k < n; k++) {
        double at[2];
        nearest(w, k, position, 0, at);
        p[k] = sqrt(fmax(1 - pow(at[0] / w->axes[0], 2) - pow(at[1] / w->axes[1], 2), 0)) *
               (1 + 0.4 * sin((double)w->seed + 3 * at[0] + 5 * at[1]));
    }
}

static struct rc_model *
model_of(const struct way *w, const double *p)
{
    return rolling_new(&w->shape, p,
                       (struct rc_rolling_problem){.law = {.pair.estar = 1,
                                                           .nu = w->nu,
                                                           .mu = w->mu,
                                                           .boundary = w->boundary,
                                                           .tol = 1e-9,
                                                           .threads = 1},
                                                   .path = true},
                       &err);
}

/* One point further; q: both tractions. */
static struct rc_rolling_figures
roll_to(struct rc_model *m, const struct way *w, double position, double *q)
{
    const size_t n = w->shape.nx * w->shape.ny;
    struct rc_rolling_figures f;
    struct rc_point to = {0};

    rc_point_set(&to, RC_POSITION, position);
    for (int c = 0; c < 2; c++)
        rc_point_set(&to, RC_CREEP_X + c, w->creep[c]);
    rc_point_set(&to, RC_SPIN, w->creep[2]);
    if (rc_model_run(m, &to, &err) == RC_FAIL || rc_model_look(m, NULL, &err) != RC_OK ||
        rc_model_frame(m, "traction-x", q, &err) != RC_OK ||
        rc_model_frame(m, "traction-y", q + n, &err) != RC_OK)
        fail_msg("%s", err.text);
    f = *rc_rolling_result(m);
    assert_int_equal(rc_model_keep(m, &err), RC_OK);
    return f;
}

/* The same step by dense matrices: forces and moment, and q, from the tractions of the step before. */
static void
dense_step(struct dense *d, const struct way *w, double position, const double *p, double *q,
           double sum[3])
{
    const double cell = w->shape.dx * w->shape.dy;
    const double none[2] = {0, 0};
    double u[2 * DENSE_MOST];

    for (size_t i = 0; i < 2 * d->n; i++) {
        u[i] = 0;
        for (size_t j = 0; j < 2 * d->n; j++)
            u[i] += d->t[i][j] * q[j];
    }
    for (size_t k = 0; k < d->n; k++) {
        double at[2];
        nearest(w, k, position, w->length / 2, at);
        d->g[k] = w->mu * p[k];
        d->w[k] = u[k] + w->length * (w->creep[0] - w->creep[2] * at[1]);
        d->w[d->n + k] = u[d->n + k] + w->length * (w->creep[1] + w->creep[2] * at[0]);
    }
    relax(d, none, q);
    sum[0] = sum[1] = sum[2] = 0;
    for (size_t k = 0; k < d->n; k++) {
        double at[2];
        nearest(w, k, position, 0, at);
        sum[0] += q[k] * cell;
        sum[1] += q[d->n + k] * cell;
        sum[2] += (at[0] * q[d->n + k] - at[1] * q[k]) * cell;
    }
}

static void
test_dense_path(void **state)
{
    uint64_t seed = 77;
    double worst = 0, worst_sum = 0, worst_energy = 0;
    size_t stick = 0, slipping = 0;

    (void)state;
    for (int which = 0; which < 90; which++) {
        const struct way w = random_way(
            &seed, which < 50 ? RC_PERIODIC : rc_boundary_of(which % 2 == 0, which % 2 == 1));
        double p[DENSE_MOST], q[2 * DENSE_MOST], exact[2 * DENSE_MOST] = {0}, sum[3];
        static struct dense d;
        struct rc_model *m = model_of(&w, p);
        double stored = 0;

        matrix_of(&d, &w.shape, w.boundary, w.nu / (1 - w.nu));
        press(&w, w.start, p);
        roll_to(m, &w, w.start, q);
        for (int step = 1; step <= STEPS; step++) {
            const double position = w.start + step * w.length;
            struct rc_rolling_figures f;
            double off = 0, all = 0, before[2 * DENSE_MOST], supplied = 0, now = 0;
            memcpy(before, exact, sizeof before);
            press(&w, position, p);
            f = roll_to(m, &w, position, q);
            dense_step(&d, &w, position, p, exact, sum);
            for (size_t k = 0; k < d.n; k++) {
                off += hypot(q[k] - exact[k], q[d.n + k] - exact[d.n + k]);
                all += hypot(exact[k], exact[d.n + k]);
            }
            worst = fmax(worst, off / all);
            /* the bodies supply the mean tractions times their motion; a part is stored as elastic energy */
            for (size_t i = 0; i < 2 * d.n; i++) {
                double u = 0, at[2];
                const int c = i < d.n ? 0 : 1;
                for (size_t j = 0; j < 2 * d.n; j++)
                    u += d.t[i][j] * exact[j];
                nearest(&w, i % d.n, position, w.length / 2, at);
                now += exact[i] * u / 2;
                supplied += (exact[i] + before[i]) / 2 *
                            (w.creep[c] + w.creep[2] * (c == 0 ? -at[1] : at[0]));
            }
            supplied = (supplied - (now - stored) / w.length) * w.shape.dx * w.shape.dy;
            stored = now;
            worst_energy = fmax(worst_energy, fabs(f.power_slip - supplied) / (f.limit * w.mu));
            worst_sum = fmax(
                worst_sum, fmax(hypot(f.force[0] - sum[0], f.force[1] - sum[1]) / f.limit,
                                fabs(f.moment - sum[2]) / (f.limit * hypot(w.axes[0], w.axes[1]))));
            stick += f.stick_nodes;
            slipping += f.slip_nodes;
        }
        rc_model_free(m);
    }
    printf("tractions differ by %.1e at most, forces and moments by %.1e, energies by %.1e; %zu "
           "nodes stick, "
           "%zu slip\n",
           worst, worst_sum, worst_energy, stick, slipping);
    assert_true(worst < 1e-7 && worst_sum < 1e-7 && worst_energy < 1e-7);
    assert_true(stick > 200 && slipping > 200);
}

/* Some columns further on, all is the same. */
static void
test_begin_of_map(void **state)
{
    uint64_t seed = 5;

    (void)state;
    for (int which = 0; which < 8; which++) {
        const struct way w =
            random_way(&seed, which % 2 == 0 ? RC_PERIODIC : rc_boundary_of(true, false));
        double p[2][DENSE_MOST], q[2][2 * DENSE_MOST];
        const size_t nx = w.shape.nx, n = nx * w.shape.ny, columns = nx / 2;
        struct rc_model *m[2] = {model_of(&w, p[0]), model_of(&w, p[1])};

        for (int step = 0; step <= STEPS; step++) {
            struct rc_rolling_figures f[2];
            for (int k = 0; k < 2; k++) {
                const double position =
                    w.start + step * w.length + (k == 1 ? (double)columns * w.shape.dx : 0);
                press(&w, position, p[k]);
                f[k] = roll_to(m[k], &w, position, q[k]);
            }
            for (size_t k = 0; k < 2 * n; k++) {
                const size_t moved = k - k % nx + (k % nx + columns) % nx;
                assert_true(fabs(q[0][k] - q[1][moved]) < 1e-7 * w.mu);
            }
            assert_true(fabs(f[0].moment - f[1].moment) < 1e-7 * f[0].limit);
            for (int c = 0; c < 2; c++)
                assert_true(isnan(f[0].kalker_force[c]) == isnan(f[1].kalker_force[c]) &&
                            !(fabs(f[0].kalker_force[c] - f[1].kalker_force[c]) >
                              1e-7 * fabs(f[0].kalker_force[c])));
        }
        for (int k = 0; k < 2; k++)
            rc_model_free(m[k]);
    }
}

/* Contacts that reach the line between two periods along x, along y, only in the step, or not. */
static void
test_half_a_period(void **state)
{
    static const struct {
        size_t first[2], last[2]; /* columns and rows of the contact */
        bool there, in_step;
        struct rc_boundary boundary;
    } of[] = {{{2, 1}, {8, 4}, false, false, {true, true, 0}},
              {{0, 2}, {9, 3}, true, true, {true, true, 0}},
              {{3, 0}, {5, 5}, true, true, {true, true, 0}},
              {{0, 2}, {1, 3}, false, false, {true, true, 0}},
              {{3, 0}, {5, 2}, false, false, {true, true, 0}},
              {{6, 2}, {9, 3}, false, true, {true, true, 0}},
              {{3, 0}, {5, 5}, true, true, {false, true, 0}},
              {{0, 2}, {8, 3}, false, false, {false, true, 0}},
              {{3, 0}, {5, 5}, false, false, {true, false, 0}},
              {{0, 2}, {9, 3}, true, true, {true, false, 0}}};
    struct way w = {.shape = {10, 6, 1, 1}, .nu = 0.3, .mu = 0.3, .length = 1};

    (void)state;
    for (size_t k = 0; k < sizeof of / sizeof *of; k++)
        for (int spin = 0; spin < 2; spin++) {
            double p[60] = {0}, q[120];
            struct rc_point to = {0};
            struct rc_model *m;

            w.boundary = of[k].boundary;
            m = model_of(&w, p);
            for (size_t i = of[k].first[0]; i <= of[k].last[0]; i++)
                for (size_t j = of[k].first[1]; j <= of[k].last[1]; j++)
                    p[j * 10 + i] = 1;
            w.creep[0] = 0.01;
            w.creep[2] = 0;
            if (spin == 0) {
                struct rc_rolling_figures f;
                roll_to(m, &w, -1, q);
                f = roll_to(m, &w, 0, q);
                assert_true(isnan(f.moment) == of[k].there && isfinite(f.force[0]));
            } else {
                rc_point_set(&to, RC_POSITION, -1);
                rc_point_set(&to, RC_CREEP_X, 0.01);
                rc_point_set(&to, RC_CREEP_Y, 0);
                assert_true(rc_model_run(m, &to, &err) != RC_FAIL);
                assert_int_equal(rc_model_keep(m, &err), RC_OK);
                rc_point_set(&to, RC_POSITION, 0);
                rc_point_set(&to, RC_SPIN, 0.01);
                assert_int_equal(rc_model_run(m, &to, &err) == RC_FAIL, of[k].in_step);
                if (of[k].in_step)
                    assert_non_null(strstr(err.text, "reaches half a period from its middle"));
            }
            rc_model_free(m);
        }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_dense_path),
        cmocka_unit_test(test_begin_of_map),
        cmocka_unit_test(test_half_a_period),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
