/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws of every contact with friction: tractions are within their bounds and carry the force, slip is
 * opposite to them. The error is within the estimate. The work does not grow with the map; invalid requests
 * are refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdio.h>

#include "slip_case.h"

/* Checks a solution: q'.s <= 0 and |q| <= g at every node, s = 0 where |q| < g, and the force. Slip and its
 * accuracy come from the library. */
struct problem {
    struct rc_shape shape;
    struct rc_boundary boundary;
    double nu, mu, tau_max, part, angle;
    double *p;
};

static struct rc_friction_solver *
slide(const struct problem *w, double tol, struct rc_friction_increment *f, enum rc_status *status)
{
    struct rc_friction_law what = {.boundary = w->boundary,
                                   .pair.estar = 1,
                                   .nu = w->nu,
                                   .mu = w->mu,
                                   .tau_max = w->tau_max,
                                   .tol = tol};
    struct rc_err err = {""};
    struct rc_friction_solver *slip = rc_friction_solver_new(&w->shape, &what, &err);
    double limit = 0;

    assert_non_null(slip);
    for (size_t k = 0; k < w->shape.nx * w->shape.ny; k++)
        limit += fmin(w->mu * w->p[k], w->tau_max > 0 ? w->tau_max : INFINITY);
    limit *= w->part * w->shape.dx * w->shape.dy;
    assert_int_equal(rc_friction_solver_set_pressure(slip, w->p, NULL, &err), RC_OK);
    assert_int_equal(
        rc_friction_solver_set_force(slip, limit * cos(w->angle), limit * sin(w->angle), &err),
        RC_OK);
    *status = slip_solve(slip, f);
    return slip;
}

/* Largest violation of the conditions, over the bounds and the largest slip. */
static double
violation(const struct problem *w, struct rc_friction_solver *slip,
          const struct rc_friction_increment *f)
{
    size_t n = w->shape.nx * w->shape.ny;
    double *s[2] = {malloc(n * sizeof(double)), malloc(n * sizeof(double))}, worst = 0, most = 0;
    double sum[2] = {0, 0}, cell = w->shape.dx * w->shape.dy;

    for (int c = 0; c < 2; c++)
        rc_friction_solver_slip(slip, c, s[c]);
    for (size_t k = 0; k < n; k++)
        most = fmax(most, hypot(s[0][k], s[1][k]));
    most =
        fmax(most, hypot(f->displacement[0], f->displacement[1])); /* where almost no node slips */
    for (size_t k = 0; k < n; k++) {
        double x = rc_friction_solver_traction(slip, 0)[k],
               y = rc_friction_solver_traction(slip, 1)[k], q = hypot(x, y);
        double g = fmin(w->mu * w->p[k], w->tau_max > 0 ? w->tau_max : INFINITY);
        double along = s[0][k] * x + s[1][k] * y, size = hypot(s[0][k], s[1][k]);
        sum[0] += x * cell;
        sum[1] += y * cell;
        worst = larger(worst, (q - g) / (g > 0 ? g : 1));
        if (g == 0)
            worst = larger(worst, q + size);
        if (size > 0 && q > 0) {
            worst = larger(worst, fabs(q / g - 1));           /* on the circle */
            worst = larger(worst, (along / q + size) / most); /* against it    */
        }
    }
    worst = larger(worst, hypot(sum[0] - f->limit * w->part * cos(w->angle),
                                sum[1] - f->limit * w->part * sin(w->angle)) /
                              f->limit);
    worst = larger(worst, f->slip_error / most);
    free(s[0]);
    free(s[1]);
    return worst;
}

static double *
pressure_of(const struct rc_shape *shape, struct rc_boundary boundary, double *h, double mean)
{
    struct pressed c =
        pressed_new(shape, boundary, h, 1,
                    mean * (double)(shape->nx * shape->ny) * shape->dx * shape->dy, 1e-6);
    double *p = malloc(c.n * sizeof *p);

    memcpy(p, c.p, c.n * sizeof *p);
    pressed_free(&c);
    return p;
}

static void
check_hard(const char *name, struct problem w)
{
    struct rc_friction_increment f;
    enum rc_status status;
    struct rc_friction_solver *slip = slide(&w, 1e-9, &f, &status);
    double worst = violation(&w, slip, &f);

    print_message("%-28s %3zu steps, %4.0f convolutions, estimate %.1e, violated by %.1e\n", name,
                  f.steps, f.convolutions, f.traction_error, worst);
    assert_int_equal(status, RC_OK);
    assert_true(worst < 1e-6);
    assert_true(f.steps <= 40);
    rc_friction_solver_free(slip);
}

static void
check_hard_cases(struct rc_boundary boundary)
{
    const struct rc_shape map = {64, 64, 1, 1}, tall = {64, 64, 1, 4}, line = {256, 1, 1, 1};
    struct problem w = {.shape = map, .boundary = boundary, .nu = 0.3, .mu = 0.3, .part = 0.5};
    double *rough = pressure_of(&map, boundary, slip_rough(&map, 0.1, 4, 7), 0.016);
    uint64_t seed = 5;
    static const double parts[] = {1e-4, 0.83, 0.99, 0.999, 0.9999, 0.99999};

    print_message("%s\n", rc_boundary_word(boundary));
    w.p = rough;
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        char name[40];
        snprintf(name, sizeof name, "F = %g mu P", parts[k]);
        w.part = parts[k];
        check_hard(name, w);
    }
    w.part = 0.5;
    w.angle = 2.2;
    check_hard("at an angle", w);
    w.nu = 0.5;
    check_hard("nu 0.5", w);
    w.nu = -0.4;
    check_hard("nu -0.4", w);
    w.nu = 0.3;
    w.tau_max = 0.02;
    check_hard("Tresca", w);
    w.tau_max = 0;
    w.p = malloc(4096 * sizeof(double));
    for (size_t k = 0; k < 4096; k++)
        w.p[k] = fmin(rough[k], 0.05);
    check_hard("capped pressure", w);
    for (size_t k = 0; k < 4096; k++)
        w.p[k] = slip_noise(&seed);
    check_hard("white noise, full contact", w);
    for (size_t k = 0; k < 4096; k++)
        w.p[k] = fmax(0, slip_noise(&seed) - 0.7);
    check_hard("white noise", w);
    for (size_t nodes = 1; nodes <= 3; nodes++) {
        memset(w.p, 0, 4096 * sizeof *w.p);
        for (size_t k = 0; k < nodes; k++)
            w.p[64 * 30 + 20 + 3 * k] = 1 + (double)k;
        check_hard(nodes == 1 ? "one node" : nodes == 2 ? "two nodes" : "three nodes", w);
        w.boundary = RC_FREE;
        check_hard("  on the free boundary", w);
        w.boundary = boundary;
    }
    for (size_t k = 0; k < 4096; k++)
        w.p[k] = hypot((double)(k % 64) - 31.5, (double)(k / 64) - 31.5) < 24;
    w.boundary = RC_FREE;
    check_hard("even pressure on a disc", w);
    free(w.p);
    w.p = pressure_of(&map, RC_FREE, slip_sphere(&map, 500), 0.01);
    check_hard("ball", w);
    free(w.p);
    w.shape = tall;
    w.boundary = boundary;
    w.p = pressure_of(&tall, boundary, slip_rough(&tall, 0.1, 16, 7), 0.012);
    check_hard("cells 1:4", w);
    free(w.p);
    w.shape = line;
    w.p = malloc(256 * sizeof(double));
    for (size_t k = 0; k < 256; k++)
        w.p[k] = fmax(0, cos(2 * exact_pi * ((double)k - 127.5) / 256));
    check_hard("a profile", w);
    free(w.p);
    free(rough);
}

static void
test_hard_cases(void **state)
{
    (void)state;
    check_hard_cases(RC_PERIODIC);
    check_hard_cases(rc_boundary_of(true, false));
    check_hard_cases(rc_boundary_of(false, true));
}

/* 60 problems, at every step with an error above 1e-6. The estimate is never below the error, and below 1e-2
 * it is at most 2.5 times the error. The reference is the end of the same iteration, at 1e-11; same_slip
 * compares it with another method. */
static void
test_estimate_bounds_the_error(void **state)
{
    enum {
        STEPS = 40
    };
    static const double means[] = {0.002, 0.006, 0.016, 0.03, 0.055}, nus[] = {0, 0.3, 0.5},
                        parts[] = {0.1, 0.3, 0.5, 0.7, 0.9};
    double least = INFINITY, most = 0, early = 0;
    size_t seen = 0;

    (void)state;
    for (int k = 0; k < 60; k++) {
        size_t nodes = k % 5 == 4 ? 64 : k % 2 == 0 ? 48 : 32, n = nodes * nodes, steps = 0;
        const struct rc_shape shape = {nodes, nodes, 1, 1};
        struct rc_boundary boundary = k >= 50      ? rc_boundary_of(k % 2 == 0, k % 2 == 1)
                                      : k % 7 == 3 ? RC_FREE
                                                   : RC_PERIODIC;
        double *h = slip_rough(&shape, 0.1, 4, 100 + (uint64_t)k), *p, limit = 0;
        double *q[STEPS][2], estimate[STEPS], angle = k, part = parts[(k / 3) % 5];
        struct rc_friction_law what = {
            .boundary = boundary, .pair.estar = 1, .nu = nus[k % 3], .mu = 0.3, .tol = 1e-11};
        struct rc_friction_solver *slip = rc_friction_solver_new(&shape, &what, NULL);
        enum rc_status status;

        assert_non_null(slip);
        if (rc_repeats(boundary) == 0)
            for (size_t i = 0; i < n; i++)
                h[i] -= (pow((double)(i % nodes) - (double)nodes / 2, 2) +
                         pow((double)(i / nodes) - (double)nodes / 2, 2)) /
                        (3 * (double)nodes);
        p = pressure_of(&shape, boundary, h, means[k % 5] / (rc_repeats(boundary) == 0 ? 3 : 1));
        for (size_t i = 0; i < n; i++)
            limit += 0.3 * p[i] * part;
        rc_friction_solver_set_pressure(slip, p, NULL, NULL);
        rc_friction_solver_set_force(slip, limit * cos(angle), limit * sin(angle), NULL);
        assert_int_equal(rc_friction_solver_step(slip, NULL), RC_MORE); /* where it begins */
        do {
            struct rc_friction_increment f;
            assert_true(steps < STEPS);
            for (int c = 0; c < 2; c++) {
                q[steps][c] = malloc(n * sizeof(double));
                memcpy(q[steps][c], rc_friction_solver_traction(slip, c), n * sizeof(double));
            }
            status = rc_friction_solver_step(slip, NULL);
            rc_friction_solver_result(slip, &f);
            estimate[steps++] = f.traction_error;
        } while (status == RC_MORE);
        assert_int_equal(status, RC_OK);
        for (size_t step = 0; step < steps; step++) {
            double error = slip_distance(n, (const double *const *)q[step],
                                         (const double *const *)q[steps - 1]);
            double ratio = estimate[step] / error;
            if (estimate[step] < 1e-6)
                continue;
            least = fmin(least, ratio);
            if (estimate[step] < 1e-2)
                most = fmax(most, ratio);
            else
                early = fmax(early, ratio);
            seen++;
        }
        for (size_t step = 0; step < steps; step++)
            for (int c = 0; c < 2; c++)
                free(q[step][c]);
        rc_friction_solver_free(slip);
        free(p);
    }
    print_message("%zu estimates: %.2f to %.2f of the error below 1e-2, up to %.1f above\n", seen,
                  least, most, early);
    assert_true(seen > 200);
    assert_true(least >= 1);
    assert_true(most <= 2.5);
}

/* Two nodes with long cells under a turning force near sliding: if both nodes slip only two pairs of
 * tractions carry the force. If neither pair is a solution the method must first let both nodes stick. */
static void
test_two_nodes_next_to_sliding(void **state)
{
    const struct rc_shape shape = {1, 3, 0.1, 10};
    const double p[3] = {0.8567, 0, 0.2633}, limit = 0.3 * (p[0] + p[2]);
    size_t slid = 0, missed = 0;

    (void)state;
    for (int k = 0; k < 64; k++) {
        double first = 0.2 * k, angle = 0.7 + 0.35 * (k % 7), part = 0.9 + 0.099 * (k % 5) / 4;
        struct rc_friction_law what = {
            .boundary = RC_PERIODIC, .pair.estar = 1, .nu = 0.45, .mu = 0.3, .tol = 1e-7};
        struct rc_friction_solver *slip = rc_friction_solver_new(&shape, &what, NULL);
        struct rc_friction_increment f;
        double s[2][3];

        rc_friction_solver_set_pressure(slip, p, NULL, NULL);
        rc_friction_solver_set_force(slip, 0.9 * limit * cos(first), 0.9 * limit * sin(first),
                                     NULL);
        assert_int_equal(slip_solve(slip, &f), RC_OK);
        rc_friction_solver_keep(slip);
        for (int c = 0; c < 2; c++)
            rc_friction_solver_slip(slip, c, s[c]);
        rc_friction_solver_set_pressure(slip, p, NULL, NULL);
        rc_friction_solver_set_force(slip, part * limit * cos(angle), part * limit * sin(angle),
                                     NULL);
        if (slip_solve(slip, &f) !=
            RC_OK) { /* some solutions are not found, and reported as not converged */
            assert_true(f.traction_error > 0.1);
            missed++;
        }
        for (int i = 0; i < 3 && f.converged; i += 2) {
            double q[2], more[2], along, across, now[3];
            for (int c = 0; c < 2; c++) {
                rc_friction_solver_slip(slip, c, now);
                q[c] = rc_friction_solver_traction(slip, c)[i];
                more[c] = now[i] - s[c][i];
            }
            along = (q[0] * more[0] + q[1] * more[1]) / (0.3 * p[i]);
            across = (q[0] * more[1] - q[1] * more[0]) / (0.3 * p[i]);
            slid += hypot(more[0], more[1]) > 0;
            assert_true(along <= 1e-4 * f.largest_slip);
            assert_true(fabs(across) <= 1e-4 * f.largest_slip); /* against its slip */
        }
        rc_friction_solver_free(slip);
    }
    assert_true(slid > 30 && missed < 6);
}

/* Convolutions until the true error is below 1e-2, 1e-4, 1e-6, at half of the friction limit, without a
 * starting value. They are at most these numbers, and hardly more on larger maps, on the free boundary, on
 * profiles and on long cells. */
static void
test_work_does_not_grow(void **state)
{
    static const struct {
        struct rc_shape shape;
        struct rc_boundary boundary;
        double mean, most[3];
    } cases[] = {
        {{64, 64, 1, 1}, {.x = true, .y = true}, 0.004, {14, 20, 23}},
        {{64, 64, 1, 1}, {.x = true, .y = true}, 0.016, {14, 20, 23}},
        {{128, 128, 1, 1}, {.x = true, .y = true}, 0.016, {14, 20, 26}},
        {{128, 128, 1, 1}, {.x = true, .y = true}, 0.055, {14, 20, 26}},
        {{256, 256, 1, 1}, {.x = true, .y = true}, 0.016, {14, 20, 26}},
        {{64, 64, 1, 1}, {.x = false}, 0.01, {14, 20, 23}},
        {{128, 128, 1, 1}, {.x = false}, 0.01, {14, 20, 23}},
        {{64, 64, 1, 100}, {.x = true, .y = true}, 0.016, {14, 20, 23}},
        {{64, 64, 1, 100}, {.x = false}, 0.004, {20, 32, 41}},
        {{4096, 1, 1, 1}, {.x = true, .y = true}, 0.016, {17, 23, 26}},
        {{4096, 1, 1, 1}, {.x = false}, 0.004, {11, 20, 23}},
        {{64, 64, 1, 1}, {.y = true}, 0.01, {14, 20, 23}},
        {{128, 128, 1, 1}, {.y = true}, 0.01, {14, 20, 23}},
        {{128, 128, 1, 1}, {.x = true}, 0.01, {14, 20, 23}},
        {{256, 256, 1, 1}, {.x = true}, 0.016, {14, 20, 26}},
        {{64, 64, 1, 100}, {.y = true}, 0.016, {20, 32, 41}},
        {{64, 64, 1, 100}, {.x = true}, 0.004, {20, 32, 41}},
        {{4096, 1, 1, 1}, {.y = true}, 0.004, {17, 26, 32}},
        {{4096, 1, 1, 1}, {.x = true}, 0.004, {11, 17, 23}},
    };
    static const double levels[3] = {1e-2, 1e-4, 1e-6};

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const struct rc_shape shape = cases[k].shape, square = {shape.nx, shape.ny, 1, 1};
        size_t n = shape.nx * shape.ny, level = 0;
        struct problem w = {
            .shape = shape, .boundary = cases[k].boundary, .nu = 0.3, .mu = 0.3, .part = 0.5};
        struct rc_friction_law what = {
            .boundary = cases[k].boundary, .pair.estar = 1, .nu = 0.3, .mu = 0.3, .tol = 1e-9};
        struct rc_friction_solver *truth, *slip = rc_friction_solver_new(&shape, &what, NULL);
        double begun, counts[3] = {0, 0, 0};
        struct rc_friction_increment f;
        enum rc_status status;
        const double *exact[2], *q[2];

        assert_non_null(slip);
        w.p = pressure_of(&shape, w.boundary, slip_rough(&square, 0.1, 4, 7), cases[k].mean);
        truth = slide(&w, 1e-10, &f, &status);
        assert_int_equal(status, RC_OK);
        rc_friction_solver_set_pressure(slip, w.p, NULL, NULL);
        rc_friction_solver_set_force(slip, f.force[0], f.force[1], NULL);
        rc_friction_solver_result(slip, &f);
        begun = f.convolutions;
        for (int c = 0; c < 2; c++) {
            exact[c] = rc_friction_solver_traction(truth, c);
            q[c] = rc_friction_solver_traction(slip, c);
        }
        do {
            status = rc_friction_solver_step(slip, NULL);
            rc_friction_solver_result(slip, &f);
            while (level < 3 && slip_distance(n, q, exact) < levels[level])
                counts[level++] = f.convolutions - begun;
        } while (status == RC_MORE);
        print_message("%zu x %zu nodes of 1:%g, %s, mean %.3f: %.1f %.1f %.1f convolutions\n",
                      shape.nx, shape.ny, shape.dy, rc_boundary_word(w.boundary), cases[k].mean,
                      counts[0], counts[1], counts[2]);
        assert_int_equal(level, 3);
        for (int c = 0; c < 3; c++)
            assert_true(counts[c] <= cases[k].most[c]);
        rc_friction_solver_free(truth);
        rc_friction_solver_free(slip);
        free(w.p);
    }
}

static void
refused(struct rc_friction_law problem, const char *word)
{
    const struct rc_shape shape = {8, 8, 1, 1};
    struct rc_err err = {""};

    assert_null(rc_friction_solver_new(&shape, &problem, &err));
    if (strstr(err.text, word) == NULL)
        print_message("%s\n", err.text);
    assert_non_null(strstr(err.text, word));
}

static void
test_nonsense_is_refused(void **state)
{
    const struct rc_shape shape = {8, 8, 1e-6, 1e-6};
    const struct rc_layer layer = {1e-6, 1e9, 0.3};
    struct rc_friction_law good = {.pair.estar = 1e9, .nu = 0.3, .mu = 0.2}, bad;
    struct rc_friction_solver *slip = rc_friction_solver_new(&shape, &good, NULL), *near;
    struct rc_err err = {""};
    double p[64] = {1e6}, load = 1e6 * 1e-12;
    struct rc_friction_increment f;

    (void)state;
    assert_non_null(slip);
    bad = good, bad.mu = 0;
    refused(bad, "coefficient of friction 0");
    bad = good, bad.mu = NAN;
    refused(bad, "coefficient of friction nan");
    bad = good, bad.nu = 0.7;
    refused(bad, "Poisson's ratio 0.7");
    bad = good, bad.tau_max = -1;
    refused(bad, "largest traction -1 Pa");
    bad = good, bad.tol = 1;
    refused(bad, "tolerance 1");
    bad = good,
    bad.pair = (struct rc_pair){.one = {.e = 1e9, .nu = 0.3, .layers = 1, .layer = &layer}};
    refused(bad, "layers");
    bad = good, bad.pair = (struct rc_pair){.estar = 0};
    refused(bad, "moduli of both bodies are 0: give E*");

    assert_int_equal(rc_friction_solver_step(slip, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "neither a force nor a displacement"));
    p[3] = -2;
    assert_int_equal(rc_friction_solver_set_pressure(slip, p, NULL, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "pressure -2 Pa at node 3"));
    p[3] = NAN;
    assert_int_equal(rc_friction_solver_set_pressure(slip, p, NULL, &err), RC_FAIL);
    p[3] = 0;
    assert_int_equal(rc_friction_solver_set_pressure(slip, p, NULL, &err), RC_OK);
    /* both numbers */
    assert_int_equal(rc_friction_solver_set_force(slip, load * 0.25, 0, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "force 2.5e-07 N"));
    assert_non_null(strstr(err.text, "less than 2e-07 N"));
    assert_int_equal(rc_friction_solver_set_force(slip, INFINITY, 0, &err), RC_FAIL);
    assert_int_equal(rc_friction_solver_set_displacement(slip, NAN, 0, &err), RC_FAIL);
    /* a datum within the contact, 4 nodes wide */
    good.boundary = (struct rc_boundary){.y = true, .datum = 0.9e-6};
    near = rc_friction_solver_new(&shape, &good, &err);
    assert_non_null(near);
    assert_int_equal(rc_friction_solver_set_pressure(near, p, NULL, &err), RC_OK);
    assert_int_equal(rc_friction_solver_set_displacement(near, 1e-9, 0, &err), RC_OK);
    p[3] = p[0];
    assert_int_equal(rc_friction_solver_set_pressure(near, p, NULL, &err), RC_OK);
    assert_int_equal(rc_friction_solver_set_displacement(near, 1e-9, 0, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "datum 9e-07 m, in a contact 4e-06 m wide"));
    assert_int_equal(rc_friction_solver_set_force(near, load * 0.1, 0, &err), RC_OK);
    assert_int_equal(slip_solve(near, &f), RC_OK);
    rc_friction_solver_free(near);
    p[3] = 0;
    assert_int_equal(rc_friction_solver_set_force(slip, 0, load * 0.15, &err), RC_OK);
    assert_int_equal(slip_solve(slip, &f), RC_OK);
    assert_true(fabs(f.force[1] / (load * 0.15) - 1) < summed && f.stick_nodes == 1);
    /* separated bodies carry no traction */
    rc_friction_solver_keep(slip);
    assert_int_equal(rc_friction_solver_set_pressure(slip, NULL, NULL, &err), RC_OK);
    assert_int_equal(rc_friction_solver_set_force(slip, 1e-9, 0, &err), RC_FAIL);
    assert_int_equal(rc_friction_solver_set_force(slip, 0, 0, &err), RC_OK);
    assert_int_equal(slip_solve(slip, &f), RC_OK);
    assert_true(f.force[1] == 0 && f.stick_nodes == 0 && isnan(f.stiffness));
    rc_friction_solver_free(slip);
}

/* On a map that repeats along one axis or both: prescribing the displacement found for a force gives this
 * force. Where both repeat complete contact carries the friction limit under any displacement and
 * direction. */
static void
test_periodic_displacement_gives_the_force(void **state)
{
    const struct rc_shape shape = {48, 40, 1, 1.3};
    static const double means[] = {0.006, 0.03, 0.055}, parts[] = {0.1, 0.5, 0.95};
    size_t n = shape.nx * shape.ny;
    double worst = 0, far = 0, *even = malloc(n * sizeof *even);
    struct problem w = {.shape = shape, .boundary = RC_PERIODIC, .nu = 0.3, .mu = 0.3};
    struct rc_friction_law what = {
        .boundary = RC_PERIODIC, .pair.estar = 1, .nu = w.nu, .mu = w.mu, .tol = 1e-9};
    struct rc_friction_increment f, back;
    enum rc_status status;

    (void)state;
    for (size_t k = 0; k < 15; k++) {
        struct rc_friction_solver *slip, *moved;
        const double *q[2], *exact[2];
        w.boundary = what.boundary = k < 9 ? RC_PERIODIC : rc_boundary_of(k % 2 == 0, k % 2 == 1);
        moved = rc_friction_solver_new(&shape, &what, NULL);
        w.p = pressure_of(&shape, w.boundary, slip_rough(&shape, 0.1, 4, 11 + k), means[k % 3]);
        w.part = parts[k / 3 % 3];
        w.angle = (double)k;
        slip = slide(&w, 1e-9, &f, &status);
        assert_int_equal(status, RC_OK);
        rc_friction_solver_set_pressure(moved, w.p, NULL, NULL);
        rc_friction_solver_set_displacement(moved, f.displacement[0], f.displacement[1], NULL);
        assert_int_equal(slip_solve(moved, &back), RC_OK);
        worst = larger(worst, hypot(back.force[0] - f.force[0], back.force[1] - f.force[1]) /
                                  hypot(f.force[0], f.force[1]));
        for (int c = 0; c < 2; c++) {
            q[c] = rc_friction_solver_traction(moved, c);
            exact[c] = rc_friction_solver_traction(slip, c);
        }
        far = larger(far, slip_distance(n, q, exact));
        rc_friction_solver_free(slip);
        rc_friction_solver_free(moved);
        free(w.p);
    }
    what.boundary = RC_PERIODIC;
    for (int k = 0; k < 8; k++) {
        double size = pow(10, 3 - k),
               angle = k; /* over E*, with cells of 1: complete contact slides */
        struct rc_friction_solver *slip = rc_friction_solver_new(&shape, &what, NULL);
        uint64_t seed = 9;
        for (size_t i = 0; i < n; i++)
            even[i] = 0.02 * (k % 2 == 0 ? 1 : 1 + 0.3 * slip_noise(&seed));
        rc_friction_solver_set_pressure(slip, even, NULL, NULL);
        rc_friction_solver_set_displacement(slip, size * cos(angle), size * sin(angle), NULL);
        assert_int_equal(slip_solve(slip, &f), RC_OK);
        print_message("moved by %g: %.9f of mu P, %zu steps, %zu stick\n", size,
                      hypot(f.force[0], f.force[1]) / f.limit, f.steps, f.stick_nodes);
        if (k % 2 == 0 || size >= 1) { /* otherwise a part still sticks */
            assert_true(fabs(hypot(f.force[0], f.force[1]) / f.limit - 1) < 1e-3);
            assert_int_equal(f.stick_nodes, 0);
        }
        rc_friction_solver_free(slip);
    }
    print_message("forces %.1e, tractions %.1e\n", worst, far);
    assert_true(worst < 1e-7 && far < 1e-7);
    free(even);
}

/* The errors of the iterations accumulate along a path. With a coarse tolerance their sum is not below the
 * error, at any increment of a turning path. The part of the last increment alone is below the error. When
 * the bodies separate the sum becomes 0. */
static void
test_errors_of_a_path_add_up(void **state)
{
    const struct rc_shape shape = {32, 32, 1, 1};
    size_t n = shape.nx * shape.ny, below = 0, alone = 0;
    double least = INFINITY, most = 0;

    (void)state;
    for (int k = 0; k < 15; k++) {
        struct rc_boundary boundary = k >= 12      ? rc_boundary_of(k % 2 == 0, k % 2 == 1)
                                      : k % 3 == 0 ? RC_FREE
                                                   : RC_PERIODIC;
        double *h = slip_rough(&shape, 0.1, 4, 60 + (uint64_t)k), *p, load = 0;
        struct rc_model *model[2];
        uint64_t seed = 40 + (uint64_t)k;
        double force[2] = {0, 0}, *q[2][2];
        for (size_t i = 0; i < n && rc_repeats(boundary) == 0; i++)
            h[i] -= (pow((double)(i % 32) - 16, 2) + pow((double)(i / 32) - 16, 2)) / 90;
        p = pressure_of(&shape, boundary, h, 0.004 * (1 + k % 4));
        for (size_t i = 0; i < n; i++)
            load += p[i];
        for (int c = 0; c < 2; c++) {
            const struct rc_problem contact = {.boundary = boundary, .pair.estar = 1};
            const struct rc_friction_problem law = {.law = {.boundary = boundary,
                                                            .pair.estar = 1,
                                                            .nu = 0.1 * (k % 6),
                                                            .mu = 0.3,
                                                            .tol = c == 0 ? 3e-2 : 1e-10},
                                                    .increments = 1,
                                                    .known_load = load,
                                                    .known_p = p};
            model[c] = slip_model(&shape, NULL, &contact, &law, NULL);
            assert_non_null(model[c]);
            q[c][0] = malloc(n * sizeof **q[c]);
            q[c][1] = malloc(n * sizeof **q[c]);
        }
        for (int step = 0; step < 16; step++) {
            struct rc_friction_figures f[2];
            double error;
            for (int c = 0; c < 2; c++) /* the force turns on a square of 0.06 to 0.26 of the
                                           friction limit */
                force[c] += (slip_noise(&seed) - 0.5) * 0.15 * load;
            for (int c = 0; c < 2; c++)
                force[c] = fmax(-0.18 * load, fmin(0.18 * load, force[c]));
            for (int c = 0; c < 2; c++) {
                assert_int_equal(slip_go(model[c], load, force[0], force[1], false, NULL), RC_OK);
                f[c] = *rc_friction_result(model[c]);
                assert_int_equal(rc_model_frame(model[c], "traction-x", q[c][0], NULL), RC_OK);
                assert_int_equal(rc_model_frame(model[c], "traction-y", q[c][1], NULL), RC_OK);
                assert_int_equal(rc_model_keep(model[c], NULL), RC_OK);
            }
            error = slip_distance(n, (const double *[2]){q[0][0], q[0][1]},
                                  (const double *[2]){q[1][0], q[1][1]});
            below += f[0].traction_error + f[0].inherited_error < error;
            alone += f[0].traction_error < error;
            least = fmin(least, (f[0].traction_error + f[0].inherited_error) / error);
            most = fmax(most, (f[0].traction_error + f[0].inherited_error) / error);
            assert_true(f[0].contact_error == 0 && (step > 0 || f[0].inherited_error == 0));
        }
        for (int c = 0; c < 2; c++) {
            assert_int_equal(slip_go(model[c], 0, 0, 0, false, NULL), RC_OK);
            assert_int_equal(rc_model_keep(model[c], NULL), RC_OK);
            assert_int_equal(slip_go(model[c], load, force[0], force[1], false, NULL), RC_OK);
            assert_true(rc_friction_result(model[c])->inherited_error == 0);
            rc_model_free(model[c]);
            free(q[c][0]);
            free(q[c][1]);
        }
        free(p);
    }
    print_message("240 states: sum %.2f to %.1f of the error, %zu below; the last alone %zu\n",
                  least, most, below, alone);
    assert_int_equal(below, 0);
    assert_true(alone > 30);
}

/* Separated bodies start again from 0: displacement, slip, stiffness and tractions are then those of bodies
 * that have never touched. */
static void
test_bodies_apart_forget(void **state)
{
    const struct rc_shape shape = {32, 32, 1, 1};
    size_t n = shape.nx * shape.ny;
    double *p = pressure_of(&shape, RC_FREE, slip_sphere(&shape, 300), 0.01), limit = 0;
    double *slips[2] = {malloc(n * sizeof(double)), malloc(n * sizeof(double))};
    struct rc_friction_law what = {.pair.estar = 1, .nu = 0.3, .mu = 0.3, .tol = 1e-10};
    struct rc_friction_solver *slip[2] = {rc_friction_solver_new(&shape, &what, NULL),
                                          rc_friction_solver_new(&shape, &what, NULL)};
    struct rc_friction_increment f[2];

    (void)state;
    for (size_t k = 0; k < n; k++)
        limit += what.mu * p[k];
    for (int moved = 0; moved < 2; moved++) {
        for (int k = 0; k < 2; k++) { /* the first path touches, slips and separates before */
            for (int step = k == 0 ? 0 : 3; step < 5; step++) {
                double to = step == 1 ? -0.8 * limit : step == 2 ? 0 : step == 4 ? 0.5 * limit : 0;
                rc_friction_solver_set_pressure(slip[k], step == 2 ? NULL : p, NULL, NULL);
                if (moved)
                    rc_friction_solver_set_displacement(slip[k], step == 2 ? 7 : to / 30, 0, NULL);
                else
                    rc_friction_solver_set_force(slip[k], to, to / 3, NULL);
                assert_int_equal(slip_solve(slip[k], &f[k]), RC_OK);
                rc_friction_solver_keep(slip[k]);
                rc_friction_solver_slip(slip[k], 0, slips[k]);
                if (step == 2)
                    assert_true(f[k].displacement[0] == 0 && f[k].displacement[1] == 0 &&
                                slips[k][n / 2] == 0);
            }
        }
        assert_true(f[1].slip_nodes > 0 && f[1].stick_nodes > 0);
        assert_int_equal(f[0].slip_nodes, f[1].slip_nodes);
        assert_true(fabs(f[0].displacement[0] / f[1].displacement[0] - 1) < 1e-9);
        assert_true(fabs(f[0].stiffness / f[1].stiffness - 1) < 1e-9);
        for (size_t k = 0; k < n; k++) {
            assert_true(fabs(rc_friction_solver_traction(slip[0], 0)[k] -
                             rc_friction_solver_traction(slip[1], 0)[k]) < 1e-8 * what.mu);
            assert_true(fabs(slips[0][k] - slips[1][k]) <= 1e-8 * f[1].largest_slip);
        }
        rc_friction_solver_set_pressure(slip[0], NULL, NULL, NULL);
        rc_friction_solver_set_force(slip[0], 0, 0, NULL);
        slip_solve(slip[0], &f[0]);
        rc_friction_solver_keep(slip[0]);
        rc_friction_solver_free(slip[1]);
        slip[1] = rc_friction_solver_new(&shape, &what, NULL);
    }
    for (int k = 0; k < 2; k++) {
        rc_friction_solver_free(slip[k]);
        free(slips[k]);
    }
    free(p);
}

/* Results scale with the units, transform with the axes and with the direction of the force, and do not
 * depend on the threads. */
static void
check_units_axes_and_threads(struct rc_boundary boundary)
{
    const struct rc_shape map = {48, 40, 1, 1.3}, turned = {40, 48, 1.3, 1};
    const struct rc_shape small = {48, 40, 1e-7, 1.3e-7};
    size_t n = 48 * 40;
    double *p = pressure_of(&map, boundary, slip_rough(&map, 0.1, 6, 3), 0.016), limit = 0;
    double *side = malloc(n * sizeof *side), *high = malloc(n * sizeof *high);
    struct rc_friction_law what = {
        .boundary = boundary, .pair.estar = 1, .nu = 0.4, .mu = 0.3, .tol = 1e-11};
    struct rc_friction_solver *slip[4];
    struct rc_friction_increment f[4];
    double far[2] = {0, 0}, size = 0;

    for (size_t k = 0; k < n; k++) {
        side[k % 48 * 40 + k / 48] = p[k];
        high[k] = p[k] * 3e11;
        limit += 0.3 * p[k] * 1.3;
    }
    slip[0] = rc_friction_solver_new(&map, &what, NULL);
    what.boundary.x = boundary.y;
    what.boundary.y = boundary.x;
    slip[1] = rc_friction_solver_new(&turned, &what, NULL);
    what.boundary = boundary;
    what.pair.estar = 3e11;
    what.boundary.datum *= 1e-7;
    slip[2] = rc_friction_solver_new(&small, &what, NULL);
    what.boundary = boundary;
    what.pair.estar = 1;
    what.threads = 1;
    slip[3] = rc_friction_solver_new(&map, &what, NULL);
    for (int k = 0; k < 4; k++) {
        double unit = k == 2 ? 3e11 * 1e-14 : 1, x = 0.5 * limit * unit, y = 0.2 * limit * unit;
        assert_int_equal(rc_friction_solver_set_pressure(slip[k],
                                                         k == 1   ? side
                                                         : k == 2 ? high
                                                                  : p,
                                                         NULL, NULL),
                         RC_OK);
        assert_int_equal(
            rc_friction_solver_set_force(slip[k], k == 1 ? y : x, k == 1 ? x : y, NULL), RC_OK);
        assert_int_equal(slip_solve(slip[k], &f[k]), RC_OK);
    }
    for (int c = 0; c < 2; c++)
        for (size_t k = 0; k < n; k++) {
            double q = rc_friction_solver_traction(slip[0], c)[k];
            size = fmax(size, fabs(q));
            far[0] =
                fmax(far[0],
                     fabs(q - rc_friction_solver_traction(slip[1], 1 - c)[k % 48 * 40 + k / 48]));
            far[1] = fmax(far[1], fabs(q - rc_friction_solver_traction(slip[2], c)[k] / 3e11));
            assert_true(q == rc_friction_solver_traction(slip[3], c)[k]);
        }
    print_message("axes %.1e, units %.1e\n", far[0] / size, far[1] / size);
    assert_true(fabs(f[1].displacement[1] / f[0].displacement[0] - 1) < 1e-9);
    assert_true(far[0] < 1e-9 * size && far[1] < 1e-9 * size);
    assert_true(fabs(f[2].displacement[0] / (f[0].displacement[0] * 1e-7) - 1) < 1e-9);
    assert_true(fabs(f[2].dissipated / (f[0].dissipated * 3e11 * 1e-21) - 1) < 1e-6);
    for (int k = 0; k < 4; k++)
        rc_friction_solver_free(slip[k]);
    free(p);
    free(side);
    free(high);
}

static void
test_units_axes_and_threads(void **state)
{
    (void)state;
    check_units_axes_and_threads(RC_PERIODIC);
    check_units_axes_and_threads((struct rc_boundary){.x = true, .datum = 700});
    check_units_axes_and_threads((struct rc_boundary){.y = true, .datum = 700});
}

/* Histories that share operator and iteration have the bytes of histories on their own, and the present
 * increment of the main one survives those of the others. Each further one takes less than a third of the
 * memory. */
static void
test_histories_side_by_side(void **state)
{
    enum {
        MORE = 2
    };
    const struct rc_shape shape = {48, 40, 1, 1.1};
    const size_t n = shape.nx * shape.ny;
    const struct rc_pair pairs[] = {{.estar = 1}, {.one = {.e = 0.9, .nu = 0.2}}};
    double *p = pressure_of(&shape, RC_FREE, slip_rough(&shape, 0.1, 6, 4), 0.016), limit = 0;
    double *slip[2] = {malloc(n * sizeof(double)), malloc(n * sizeof(double))};

    (void)state;
    for (size_t k = 0; k < n; k++)
        limit += 0.3 * p[k] * shape.dx * shape.dy;
    for (size_t pair = 0; pair < 2; pair++) {
        struct rc_friction_law what = {.pair = pairs[pair], .nu = 0.3, .mu = 0.3, .tol = 1e-5};
        struct rc_friction_solver *alone[1 + MORE], *beside[1 + MORE];
        size_t held = rc_memory_held().held, first;

        beside[0] = rc_friction_solver_new(&shape, &what, NULL);
        first = rc_memory_held().held - held;
        for (size_t j = 1; j <= MORE; j++)
            beside[j] = rc_friction_solver_beside(beside[0], 1e-6, NULL);
        assert_true(rc_memory_held().held - held - first < MORE * first / 3);
        for (size_t j = 0; j <= MORE; j++) {
            what.tol = j == 0 ? 1e-5 : 1e-6;
            alone[j] = rc_friction_solver_new(&shape, &what, NULL);
        }
        for (int step = 0; step < 4; step++) {
            static const double to[4][2] = {{0.5, 0}, {0.3, 0.3}, {0.2, -0.4}, {0, 0}};
            struct rc_friction_increment f[2];
            for (size_t j = 0; j <= MORE; j++) {
                struct rc_friction_solver *both[2] = {alone[j], beside[j]};
                for (int k = 0; k < 2; k++) {
                    rc_friction_solver_set_pressure(both[k], p, NULL, NULL);
                    rc_friction_solver_set_force(both[k], limit * (to[step][0] + 0.05 * (double)j),
                                                 limit * to[step][1], NULL);
                    assert_int_equal(slip_solve(both[k], &f[k]), RC_OK);
                    if (j > 0)
                        rc_friction_solver_keep(both[k]);
                }
                assert_true(f[0].dissipated == f[1].dissipated);
                for (int c = 0; c < 2 && j > 0; c++)
                    assert_memory_equal(rc_friction_solver_kept(alone[j], c),
                                        rc_friction_solver_kept(beside[j], c), n * sizeof *p);
            }
            rc_friction_solver_result(alone[0], &f[0]);
            rc_friction_solver_result(beside[0], &f[1]);
            assert_true(f[0].slip_nodes > 0 && f[0].slip_nodes == f[1].slip_nodes);
            assert_true(f[0].dissipated == f[1].dissipated);
            for (int c = 0; c < 2; c++) {
                assert_memory_equal(rc_friction_solver_traction(alone[0], c),
                                    rc_friction_solver_traction(beside[0], c), n * sizeof *p);
                rc_friction_solver_slip(alone[0], c, slip[0]);
                rc_friction_solver_slip(beside[0], c, slip[1]);
                assert_memory_equal(slip[0], slip[1], n * sizeof *p);
            }
            rc_friction_solver_keep(alone[0]);
            rc_friction_solver_keep(beside[0]);
        }
        for (size_t j = 1 + MORE; j-- > 0;) {
            rc_friction_solver_free(alone[j]);
            rc_friction_solver_free(beside[j]);
        }
        assert_true(rc_memory_held().held == held);
    }
    free(slip[0]);
    free(slip[1]);
    free(p);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hard_cases),
        cmocka_unit_test(test_estimate_bounds_the_error),
        cmocka_unit_test(test_two_nodes_next_to_sliding),
        cmocka_unit_test(test_work_does_not_grow),
        cmocka_unit_test(test_nonsense_is_refused),
        cmocka_unit_test(test_periodic_displacement_gives_the_force),
        cmocka_unit_test(test_errors_of_a_path_add_up),
        cmocka_unit_test(test_bodies_apart_forget),
        cmocka_unit_test(test_units_axes_and_threads),
        cmocka_unit_test(test_histories_side_by_side),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
