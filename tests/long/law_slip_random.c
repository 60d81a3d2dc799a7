/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random problems of friction against a dense solution by another method. They have forces of 0.1 to 0.999 of
 * what friction carries, or displacements, on free and periodic maps and on maps that repeat along one axis.
 * 10 to 82 % of the nodes touch, cells are 1:1 to 1:100, and there is a history. None stops short, and no
 * estimate is below the error at any step. About 6 minutes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdio.h>

#include "libcontact/friction/friction.h"
#include "tests/friction/dense.h"
#include "tests/friction/slip_case.h"

enum {
    PROBLEMS = 150,
    LINES = 80,     /* on maps that repeat along one axis */
    INCREMENTS = 3, /* increments of each problem: 690 in all */
    DISPLACEMENTS = 200
};
static const double tight = 1e-9, noise_of_truth = 1e-7;

struct random {
    struct rc_shape shape;
    struct rc_boundary boundary;
    size_t n;
    double nu, contact; /* contact: part of the nodes */
    uint64_t seed;
};

static double
draw(struct random *r, double from, double to)
{
    return from + (to - from) * slip_noise(&r->seed);
}

static struct random
random_problem(uint64_t seed, struct rc_boundary boundary)
{
    static const size_t sides[][2] = {{8, 8}, {6, 6}, {5, 7}, {4, 16}, {1, 64}, {16, 2}, {10, 6}};
    struct random r = {.seed = seed};
    const size_t *side = sides[(size_t)draw(&r, 0, 7)];
    const double aspect = draw(&r, 0, 1) < 0.6 ? 1 : pow(10, draw(&r, -2, 2));

    r.shape = (struct rc_shape){side[0], side[1], sqrt(aspect), 1 / sqrt(aspect)};
    r.boundary = boundary;
    r.n = side[0] * side[1];
    r.nu = draw(&r, 0, 1) < 0.2 ? 0 : draw(&r, 0, 0.5);
    r.contact = draw(&r, 0.1, 0.82);
    return r;
}

/* Nodes at random, or hills: waves with random phases, cut at the level of this part of the nodes. */
static void
random_pressure(struct random *r, double *p)
{
    const bool hills = draw(r, 0, 1) < 0.5;
    double v[DENSE_MOST], sorted[DENSE_MOST], level;

    for (size_t k = 0; k < r->n; k++)
        v[k] = draw(r, 0, 1);
    for (int wave = 0; wave < 6 && hills; wave++) {
        const double kx = floor(draw(r, -2, 3)), ky = floor(draw(r, -2, 3)),
                     phase = draw(r, 0, 6.28);
        for (size_t k = 0; k < r->n; k++)
            v[k] += 2 * cos(6.283 * (kx * (double)(k % r->shape.nx) / (double)r->shape.nx +
                                     ky * (double)(k / r->shape.nx) / (double)r->shape.ny) +
                            phase);
    }
    memcpy(sorted, v, sizeof sorted);
    for (size_t i = 0; i < r->n; i++) /* few nodes */
        for (size_t j = i + 1; j < r->n; j++)
            if (sorted[j] > sorted[i]) {
                level = sorted[i];
                sorted[i] = sorted[j];
                sorted[j] = level;
            }
    level = sorted[(size_t)((double)(r->n - 1) * r->contact) + 1 < r->n
                       ? (size_t)((double)(r->n - 1) * r->contact) + 1
                       : r->n - 1];
    for (size_t k = 0; k < r->n; k++)
        p[k] = fmax(0, v[k] - level);
}

struct tally {
    size_t increments, short_of, states, below, wrong, untrue, steps, most;
    double least, worst;
};

/* Relative L1 distance, in the norm of the estimate. */
static double
distance_to(const struct rc_friction_solver *slip, size_t n, const double *truth)
{
    double far = 0, size = 0;

    for (size_t k = 0; k < n; k++) {
        const double x = rc_friction_solver_traction(slip, 0)[k],
                     y = rc_friction_solver_traction(slip, 1)[k];
        far += hypot(x - truth[k], y - truth[n + k]);
        size += hypot(x, y);
    }
    return size > 0 ? far / size : 0;
}

/* Steps to the end. Compares the estimate of each step with the error, down to the error of the truth. */
static void
solve(struct rc_friction_solver *slip, size_t n, const double *truth, const char *what,
      struct tally *t)
{
    struct rc_friction_increment f;
    enum rc_status status = RC_MORE;
    double error = 0;

    for (size_t step = 0; status == RC_MORE; step++) {
        status = rc_friction_solver_step(slip, NULL);
        rc_friction_solver_result(slip, &f);
        error = distance_to(slip, n, truth);
        if (step == 0 || !(error > noise_of_truth))
            continue;
        t->states++;
        t->least = fmin(t->least, f.traction_error / error);
        if (f.traction_error < 0.99 * error) {
            t->below++;
            print_message("%s: step %zu of %.6f mu P, estimate %.2e, error %.2e\n", what, step,
                          hypot(f.force[0], f.force[1]) / f.limit, f.traction_error, error);
        }
    }
    t->increments++;
    t->steps += f.steps;
    t->most = f.steps > t->most ? f.steps : t->most;
    t->worst = fmax(t->worst, error);
    if (status != RC_OK || error > noise_of_truth) {
        print_message("%s: status %d after %zu steps, estimate %.1e, error %.1e\n", what, status,
                      f.steps, f.traction_error, error);
        t->short_of += status != RC_OK;
        t->wrong += error > noise_of_truth;
    }
}

/* The history that the dense solution leaves. */
static void
keep_dense(const struct dense *d, const double delta[2], const double *q, double *origin)
{
    for (size_t k = 0; k < 2 * d->n; k++) {
        origin[k] = -delta[k >= d->n];
        for (size_t j = 0; j < 2 * d->n; j++)
            origin[k] += d->t[k][j] * q[j];
    }
}

static void
increments(uint64_t seed, struct rc_boundary boundary, bool moved, size_t n, struct tally *t)
{
    static struct dense d;
    struct random r = random_problem(seed, boundary);
    const struct rc_friction_law what = {
        .boundary = r.boundary, .pair.estar = 1, .nu = r.nu, .mu = 0.3, .tol = tight, .threads = 1};
    struct rc_friction_solver *slip = rc_friction_solver_new(&r.shape, &what, NULL);
    double q[2 * DENSE_MOST] = {0}, delta[2] = {0, 0}, origin[2 * DENSE_MOST] = {0};
    const double far = pow(10, draw(&r, -2, 1));

    assert_non_null(slip);
    matrix_of(&d, &r.shape, boundary, r.nu / (1 - r.nu));
    for (size_t k = 0; k < n; k++) {
        double p[DENSE_MOST], limit = 0, load[2], off = 0;
        const double part =
            draw(&r, 0, 1) < 0.3 ? 1 - pow(10, draw(&r, -3, -1)) : draw(&r, 0.1, 0.95);
        const double angle = draw(&r, 0, 6.28);
        char name[96];
        random_pressure(&r, p);
        for (size_t i = 0; i < r.n; i++)
            limit += d.g[i] = what.mu * p[i];
        memcpy(d.w, origin, sizeof origin);
        load[0] = part * limit * cos(angle);
        load[1] = part * limit * sin(angle);
        assert_int_equal(rc_friction_solver_set_pressure(slip, p, NULL, NULL), RC_OK);
        if (moved) {
            delta[0] += far * draw(&r, -0.5, 0.5);
            delta[1] += far * draw(&r, -0.5, 0.5);
            relax(&d, delta, q);
            assert_int_equal(rc_friction_solver_set_displacement(slip, delta[0], delta[1], NULL),
                             RC_OK);
        } else {
            off = carry(&d, load, delta, q);
            assert_int_equal(rc_friction_solver_set_force(slip, load[0], load[1], NULL), RC_OK);
        }
        snprintf(name, sizeof name, "seed %d, %zu x %zu, dx/dy %.3g, %s, nu %.2f", (int)seed,
                 r.shape.nx, r.shape.ny, r.shape.dx / r.shape.dy, rc_boundary_word(boundary), r.nu);
        if (off > 1e-10) { /* no truth: the history would not be the same */
            print_message("%s: the dense solution lacks %.1e of the force\n", name, off);
            t->untrue++;
            break;
        }
        solve(slip, r.n, q, name, t);
        rc_friction_solver_keep(slip);
        keep_dense(&d, delta, q, origin);
    }
    rc_friction_solver_free(slip);
}

static void
print(const char *what, const struct tally *t)
{
    print_message(
        "%s: %zu increments, %zu stop short, %zu wrong, steps %.1f on average, at most %zu; %zu "
        "states, %zu below the error, least %.3f of it; %zu without a truth\n",
        what, t->increments, t->short_of, t->wrong, (double)t->steps / (double)t->increments,
        t->most, t->states, t->below, t->least, t->untrue);
}

static void
test_forces_and_displacements(void **state)
{
    struct tally t = {.least = INFINITY};

    (void)state;
    for (size_t k = 0; k < PROBLEMS; k++)
        increments(9000 + k, k % 2 == 0 ? RC_PERIODIC : RC_FREE, k % 3 == 2, INCREMENTS, &t);
    print("forces and displacements", &t);
    assert_int_equal(t.short_of + t.wrong + t.below, 0);
    assert_true(t.states > 500 && t.untrue < PROBLEMS / 10);
}

static void
test_displacements_of_periodic_maps(void **state)
{
    struct tally t = {.least = INFINITY};

    (void)state;
    for (size_t k = 0; k < DISPLACEMENTS; k++)
        increments(6000 + k, RC_PERIODIC, true, 1, &t);
    print("displacements of periodic maps", &t);
    assert_int_equal(t.short_of + t.wrong + t.below, 0);
    assert_int_equal(t.increments, DISPLACEMENTS);
}

static void
test_maps_that_repeat_along_one_axis(void **state)
{
    struct tally t = {.least = INFINITY};

    (void)state;
    for (size_t k = 0; k < LINES; k++)
        increments(3000 + k, rc_boundary_of(k % 2 == 0, k % 2 == 1), k % 3 == 2, INCREMENTS, &t);
    print("maps that repeat along one axis", &t);
    assert_int_equal(t.short_of + t.wrong + t.below, 0);
    assert_true(t.states > 300 && t.untrue < LINES / 10);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_forces_and_displacements),
        cmocka_unit_test(test_displacements_of_periodic_maps),
        cmocka_unit_test(test_maps_that_repeat_along_one_axis),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
