/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random cases of steady rolling, to several tolerances. The contacts are smooth, rough, white noise or
 * flat punches, of similar and dissimilar bodies, with long cells and any nu, mu, spin, and creepage or
 * force, on free maps and on maps that repeat along y, where half of them are rollers. Each is compared
 * with its solution to 1e-10: no error is above its estimate, half of the estimates are below 5 times the
 * error, and half of the runs take less work than a bound. Each step of random paths, two in five of them
 * of profiles, is compared with the same path to 1e-10. Arguments: seed, cases, 1 to print each, and a
 * pattern of tests. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>

#include "tests/rolling/rolling_case.h"
#include "tests/friction/slip_case.h"

enum {
    TOLS = 3
};
static const double tols[TOLS] = {1e-2, 1e-3, 1e-4};
static uint64_t seed = 11;
static size_t cases;
static bool all_shown;
static struct rc_err err;

static double
between(double a, double b)
{
    return a + (b - a) * slip_noise(&seed);
}

static double
ratio_between(double a, double b)
{
    return exp(between(log(a), log(b)));
}

static const char *const kinds[] = {"ellipse", "rough ball", "white noise", "flat punch", "capped"};

struct rolls {
    bool force; /* x and y are a force, N, else a creepage */
    size_t kind;
    struct rc_shape shape;
    struct rc_rolling_problem law;
    double *p, load, x, y, spin;
};

/* Creepages are in proportion to that of full slip, about mu p/E*. */
static struct rolls
random_case(bool line)
{
    struct rolls r = {.kind = (size_t)between(0, 5)};
    const bool roller = line && slip_noise(&seed) < 0.5;
    const size_t n = (size_t)ratio_between(16, 130);
    const double a = ratio_between(0.4, 2.5), e = 1e9, p0 = 1e6,
                 cells = r.kind == 2 ? ratio_between(0.25, 4) : 1;
    double scale, turn = between(0, 6.3), part = ratio_between(0.02, 20), peak = 0;

    r.shape = ellipse_shape(n, a, cells);
    r.law = (struct rc_rolling_problem){
        .law = {
            .pair.estar = e, .nu = between(0, 0.5), .mu = ratio_between(0.01, 2), .threads = 1}};
    r.law.law.boundary.y = line;
    r.p = hertz_ellipse(&r.shape, a, roller ? INFINITY : cells, p0);
    for (size_t k = 0; k < n * n; k++) {
        if (r.kind == 2)
            r.p[k] *= slip_noise(&seed) < 0.6;
        else if (r.kind == 3)
            r.p[k] = r.p[k] > 0 ? p0 : 0;
        peak = fmax(peak, r.p[k]);
    }
    if (r.kind == 1) {
        const struct rc_selfaffine rough = {
            .hurst = 0.7, .rms_slope = between(0.5, 3) * p0 / e, .seed = (uint64_t)between(1, 1e6)};
        const struct rc_problem contact = {.boundary = r.law.law.boundary,
                                           .pair.estar = e,
                                           .load = rolling_load(&r.shape, r.p),
                                           .tol = 1e-6,
                                           .threads = 1};
        double *h = malloc(n * n * sizeof *h);
        struct rc_solver *solver;
        assert_true(h != NULL && rc_synth_selfaffine(&r.shape, &rough, h, &err) == RC_OK);
        for (size_t k = 0; k < n * n; k++) {
            const double x = ((double)(k % n) - (double)(n - 1) / 2) * r.shape.dx;
            const double y = roller ? 0 : ((double)(k / n) - (double)(n - 1) / 2) * r.shape.dy;
            h[k] -= (x * x / a + y * y) * p0 / e * 0.8 + (k % n == n - 1);
        }
        solver = rc_solver_new(&r.shape, h, &contact, &err);
        assert_non_null(solver);
        while (rc_solver_step(solver) == RC_MORE)
            ;
        memcpy(r.p, rc_solver_pressure(solver), n * n * sizeof *r.p);
        rc_solver_free(solver);
        free(h);
    }
    if (r.kind == 4)
        r.law.law.tau_max = between(0.3, 0.8) * r.law.law.mu * p0;
    scale = part * r.law.law.mu * p0 / e;
    r.load = rolling_load(&r.shape, r.p);
    r.x = scale * cos(turn);
    r.y = scale * sin(turn);
    r.spin = slip_noise(&seed) < 0.5 ? 0 : scale * between(-2, 2);
    if (roller || (line && r.kind == 1)) /* the contact may reach the next period */
        r.spin = 0;
    if (slip_noise(&seed) < 0.25) {
        r.law.law.nu = 0;
        r.law.law.pair =
            (struct rc_pair){.one = {.e = 1.4 * e, .nu = between(0, 0.45)},
                             .two = {.e = e * ratio_between(2, 20), .nu = between(0, 0.45)}};
    }
    return r;
}

static struct rolls
random_force(bool line)
{
    struct rolls r = random_case(line);
    const double turn = between(0, 6.3), part = between(0.02, 0.98);
    double limit = 0;

    for (size_t k = 0; k < r.shape.nx * r.shape.ny; k++)
        limit += fmin(r.law.law.mu * r.p[k], r.law.law.tau_max > 0 ? r.law.law.tau_max : INFINITY) *
                 r.shape.dx * r.shape.dy;
    r.force = true;
    r.x = part * limit * cos(turn);
    r.y = part * limit * sin(turn);
    r.spin *= between(0, 1) < 0.5 ? 0 : 0.2;
    return r;
}

static struct rc_rolling_figures
solved(const struct rolls *r, double tol, double *q, enum rc_status *status)
{
    struct rc_rolling_problem law = r->law;
    struct rc_model *m;
    struct rc_rolling_figures f;
    const size_t n = r->shape.nx * r->shape.ny;

    law.law.tol = tol;
    law.force = r->force;
    m = rolling_new(&r->shape, r->p, law, &err);
    if (m == NULL || (*status = roll(m, r->load, r->x, r->y, r->spin, r->force, &err)) == RC_FAIL)
        fail_msg("%s", err.text);
    f = *rc_rolling_result(m);
    assert_true(rc_model_frame(m, "traction-x", q, &err) == RC_OK &&
                rc_model_frame(m, "traction-y", q + n, &err) == RC_OK);
    rc_model_free(m);
    return f;
}

/* The relative L1 distance of the tractions q to those of `ref`. */
static double
away(const double *q, const double *ref, size_t n)
{
    double off = 0, size = 0;

    for (size_t k = 0; k < n; k++) {
        off += hypot(q[k] - ref[k], q[n + k] - ref[n + k]);
        size += hypot(ref[k], ref[n + k]);
    }
    return off / size;
}

static int
upwards(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* Returns the median. */
static double
show(const char *what, double *v, size_t n)
{
    qsort(v, n, sizeof *v, upwards);
    printf("%s: %zu, least %.3g, median %.3g, 90 %% %.3g, most %.3g\n", what, n, v[0], v[n / 2],
           v[n * 9 / 10], v[n - 1]);
    return v[n / 2];
}

static void
check_estimates(bool line, bool force)
{
    double *over = malloc(cases * TOLS * sizeof *over), *work[TOLS], median;
    size_t states = 0, below = 0, count = 0, fallbacks = 0, worst_tol = 0, late = 0;
    bool few = true;

    for (int t = 0; t < TOLS; t++)
        work[t] = malloc(cases * sizeof **work);
    for (size_t c = 0; c < cases; c++) {
        const uint64_t start = seed;
        struct rolls r = force ? random_force(line) : random_case(line);
        const size_t n = r.shape.nx * r.shape.ny;
        double *ref = malloc(2 * n * sizeof *ref), *q = malloc(2 * n * sizeof *q);
        enum rc_status status;
        struct rc_rolling_figures f = solved(&r, 1e-10, ref, &status);
        late += status != RC_OK;
        fallbacks += f.fallbacks;
        if (all_shown)
            printf("%zu (%llu): %s, %zu nodes, F/limit %.3f, stick %.2f, to 1e-10: %.0f", c,
                   (unsigned long long)start, kinds[r.kind], r.shape.nx,
                   hypot(f.force[0], f.force[1]) / f.limit, f.stick_fraction, f.convolutions);
        for (int t = 0; t < TOLS; t++) {
            f = solved(&r, tols[t], q, &status);
            const double off = away(q, ref, n);
            worst_tol += off > tols[t];
            late += status != RC_OK;
            fallbacks += f.fallbacks;
            work[t][count] = f.convolutions;
            if (off > 1e-9)
                over[states++] = f.traction_error / off;
            below += off > 1e-9 && f.traction_error < off;
            if (all_shown)
                printf(" | %.0f: %.1e (%.2f)", f.convolutions, off, f.traction_error / off);
        }
        if (all_shown)
            printf("\n");
        count++;
        free(r.p);
        free(ref);
        free(q);
    }
    median = show("estimate over error", over, states);
    for (int t = 0; t < TOLS; t++) {
        char what[64];
        snprintf(what, sizeof what, "convolutions to %g", tols[t]);
        few = show(what, work[t], count) < 60 + 25 * t && few;
        free(work[t]);
    }
    printf("%zu of %zu estimates below; %zu errors above the tolerance; %zu steps in time; %zu "
           "runs short\n",
           below, states, worst_tol, fallbacks, late);
    free(over);
    assert_true(below == 0 && worst_tol == 0 && late == 0 && median < 5 && few);
}

static void
test_free_maps(void **state)
{
    (void)state;
    check_estimates(false, false);
}

static void
test_maps_that_repeat_along_y(void **state)
{
    (void)state;
    check_estimates(true, false);
}

static void
test_forces(void **state)
{
    (void)state;
    check_estimates(false, true);
    check_estimates(true, true);
}

/* A flat punch under a force, found among 4,500 states: its nodes begin to slip one after another, and each
 * step leaves two thirds of the error. */
static void
test_slow_steps(void **state)
{
    (void)state;
    seed = 13053371223731153075u;
    struct rolls r = random_force(false);
    const size_t n = r.shape.nx * r.shape.ny;
    double *ref = malloc(2 * n * sizeof *ref), *q = malloc(2 * n * sizeof *q);
    enum rc_status status;

    solved(&r, 1e-10, ref, &status);
    for (int t = 0; t < 2; t++) {
        const struct rc_rolling_figures f = solved(&r, tols[t], q, &status);
        const double off = away(q, ref, n);
        assert_true(off > 1e-5 && off <= tols[t] && off <= f.traction_error);
    }
    free(r.p);
    free(ref);
    free(q);
}

/* ---- paths ---- */

enum {
    WAY = 24 /* steps of a path */
};

struct way {
    struct rolls r;
    size_t columns; /* of a step: the map follows by as many */
    double grain;   /* of the roughness that comes in, as part of the pressure */
    uint64_t seed;
    bool force;
};

enum {
    PUNCHES = 4
};

/* The first ones are flat punches along x that stick under a small force: the contact keeps an error until it
 * has rolled over its own length. */
static struct way
random_way(size_t c)
{
    static const size_t long_punch[PUNCHES] = {12, 19, 23, 45};
    struct way w = {.r = random_case(slip_noise(&seed) < 0.3)};
    struct rolls *r = &w.r;

    if (c < PUNCHES || slip_noise(&seed) < 0.4) { /* a profile */
        const size_t nx = c < PUNCHES ? long_punch[c] : (size_t)ratio_between(12, 80);
        free(r->p);
        r->kind = c >= PUNCHES && slip_noise(&seed) < 0.5 ? 0 : 3;
        r->shape = (struct rc_shape){nx, 1, 2.2 / (double)nx, 1};
        r->p = hertz_ellipse(&r->shape, 0.9, 1, 1e6);
        for (size_t k = 0; k < nx && r->kind == 3; k++)
            r->p[k] = r->p[k] > 0 ? 1e6 : 0;
        r->spin = 0;
    }
    w.columns = (size_t)between(1, 4);
    w.grain = slip_noise(&seed) < 0.5 ? 0 : between(0, 1.5);
    w.seed = (uint64_t)between(1, 1e6);
    w.force = slip_noise(&seed) < 0.3;
    if (c < PUNCHES) {
        w.columns = c % 2 + 1;
        w.grain = 0;
        w.force = true;
        r->x = r->y = r->law.law.mu * 1e-4;
    }
    return w;
}

/* The pressure of step m: roughness comes in with the material. */
static void
press(const struct way *w, size_t m, double *p)
{
    const struct rc_shape *s = &w->r.shape;
    const size_t come = w->columns;

    for (size_t k = 0; k < s->nx * s->ny; k++) {
        uint64_t at = w->seed * 1000003 + (k % s->nx + m * come) * 1009 + k / s->nx;
        slip_noise(&at);
        p[k] = k % s->nx + come < s->nx
                   ? w->r.p[k] * fmax(1 + w->grain * (2 * slip_noise(&at) - 1), 0)
                   : 0;
    }
}

/* Rolls along the whole path; the tractions and figures of each step. */
static void
rolled(const struct way *w, double tol, double *q, struct rc_rolling_figures *f)
{
    const struct rolls *r = &w->r;
    const size_t n = r->shape.nx * r->shape.ny;
    double *p = calloc(n, sizeof *p);
    struct rc_rolling_contact known = {.p = p};
    struct rc_rolling_problem law = r->law;
    const struct rc_problem contact = {
        .boundary = law.law.boundary, .pair = law.law.pair, .threads = 1};
    struct rc_model *m;

    law.law.tol = tol;
    law.path = true;
    law.force = w->force;
    law.known = &known;
    m = rc_rolling_new(rc_elastic_new(&r->shape, p, &contact, NULL, &err), &law, &err);
    assert_non_null(m);
    for (size_t k = 0; k < WAY; k++) {
        struct rc_point to = {0};
        const double turn = sin((double)k);
        double limit;
        known.x = (double)(k * w->columns) * r->shape.dx;
        press(w, k, p);
        limit = law.law.mu * rolling_load(&r->shape, p);
        rc_point_set(&to, RC_POSITION, known.x);
        if (w->force) {
            double part = fmin(hypot(r->x, r->y) * 1e9 / (law.law.mu * 1e6), 10) / 16;
            if (law.law.tau_max > 0)
                part *= 0.3;
            rc_point_set(&to, RC_TANGENTIAL_X, part * limit * (0.6 + 0.4 * turn));
            rc_point_set(&to, RC_TANGENTIAL_Y, part * limit * 0.3);
        } else {
            rc_point_set(&to, RC_CREEP_X, r->x * (0.7 + 0.3 * turn));
            rc_point_set(&to, RC_CREEP_Y, r->y);
        }
        rc_point_set(&to, RC_SPIN, r->spin);
        if (rc_model_run(m, &to, &err) == RC_FAIL || rc_model_look(m, NULL, &err) != RC_OK)
            fail_msg("%s", err.text);
        f[k] = *rc_rolling_result(m);
        assert_true(rc_model_frame(m, "traction-x", q + 2 * k * n, &err) == RC_OK &&
                    rc_model_frame(m, "traction-y", q + (2 * k + 1) * n, &err) == RC_OK &&
                    rc_model_keep(m, &err) == RC_OK);
    }
    rc_model_free(m);
    free(p);
}

static void
test_paths(void **state)
{
    const size_t paths = cases > 20 ? cases : PUNCHES + 1, most = TOLS * WAY * paths;
    double *over = malloc(most * sizeof *over), *work = malloc(most * sizeof *work), median;
    size_t states = 0, below = 0, count = 0, worst_tol = 0, late = 0;

    (void)state;
    for (size_t c = 0; c < paths; c++) {
        struct way w = random_way(c);
        const size_t n = w.r.shape.nx * w.r.shape.ny;
        double *ref = malloc(2 * WAY * n * sizeof *ref), *q = malloc(2 * WAY * n * sizeof *q);
        struct rc_rolling_figures f[WAY];
        rolled(&w, 1e-10, ref, f);
        for (int t = 0; t < TOLS; t++) {
            rolled(&w, tols[t], q, f);
            for (size_t k = 0; k < WAY; k++) {
                const double *a = q + 2 * k * n, *b = ref + 2 * k * n;
                double off = 0, size = 0;
                for (size_t i = 0; i < n; i++) {
                    off += hypot(a[i] - b[i], a[n + i] - b[n + i]);
                    size += hypot(b[i], b[n + i]);
                }
                off = size > 0 ? off / size : 0;
                work[count++] = f[k].convolutions;
                worst_tol += off > tols[t] && f[k].converged;
                late += !f[k].converged;
                if (off < 1e-9)
                    continue;
                over[states++] = f[k].traction_error / off;
                below += off > 1e-5 && f[k].traction_error < 0.99 * off;
                if (all_shown && f[k].traction_error < 0.99 * off)
                    printf(
                        "%zu, %s, %zu x %zu, step %zu of %zu columns, tol %g, grain %.2f, %s, nu "
                        "%.2f, F/limit %.3f, stick %zu, slip %zu, converged %d: error %.2e "
                        "(%.2f)\n",
                        c, kinds[w.r.kind], w.r.shape.nx, w.r.shape.ny, k, w.columns, tols[t],
                        w.grain, w.force ? "force" : "creep", w.r.law.law.nu,
                        hypot(f[k].force[0], f[k].force[1]) / f[k].limit, f[k].stick_nodes,
                        f[k].slip_nodes, f[k].converged, off, f[k].traction_error / off);
            }
        }
        free(w.r.p);
        free(ref);
        free(q);
    }
    median = show("estimate over error", over, states);
    show("convolutions of a step", work, count);
    printf("%zu of %zu estimates below; %zu errors above the tolerance; %zu steps short\n", below,
           states, worst_tol, late);
    free(over);
    free(work);
    assert_true(below == 0 && worst_tol == 0 && median < 5);
}

int
main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_free_maps),
                                       cmocka_unit_test(test_maps_that_repeat_along_y),
                                       cmocka_unit_test(test_forces), cmocka_unit_test(test_paths),
                                       cmocka_unit_test(test_slow_steps)};

    seed = argc > 1 ? strtoull(argv[1], NULL, 10) : seed;
    cases = argc > 2 ? strtoull(argv[2], NULL, 10) : thorough(300, 12);
    all_shown = argc > 3;
    if (argc > 4)
        cmocka_set_test_filter(argv[4]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
