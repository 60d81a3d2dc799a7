/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hard cases of adhesion: invalid requests, saddle points, separating bodies, jumps, thin and odd maps,
 * unequal spacings, a hardness, coatings. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "adhesion_case.h"

static const double estar = 3.1e6, radius = 2.385e-3;

/* ---- requests ---- */

static void
refused(struct rc_shape shape, struct rc_adhesion_problem problem, const char *word)
{
    double *h = calloc(shape.nx * shape.ny, sizeof *h);
    struct rc_adhesion_scales scales;
    struct rc_expected expected;
    struct rc_err err = {0}, other = {0};

    assert_non_null(h);
    assert_null(rc_adhesion_solver_new(&shape, h, &problem, &err));
    if (strstr(err.text, word) == NULL)
        print_error("'%s' is not in: %s\n", word, err.text);
    assert_non_null(strstr(err.text, word));
    assert_int_equal(rc_adhesion_check(&shape, &problem, &scales, &other), RC_FAIL);
    assert_string_equal(err.text, other.text);
    assert_int_equal(rc_adhesion_expect(&shape, &problem, &expected, &other), RC_FAIL);
    assert_string_equal(err.text, other.text);
    free(h);
}

static void
requests(void **state)
{
    const struct rc_shape shape = {32, 32, 1e-6, 1e-6};
    const struct rc_adhesion_problem good = {
        .contact = {.pair.estar = estar}, .work = 0.05, .range = 3e-7};
    struct rc_adhesion_problem bad;
    struct rc_adhesion_solver *a;
    double h[32 * 32] = {0}, p[32 * 32] = {0};
    struct rc_err err;

    (void)state;
#define REFUSED(change, word)                                                                      \
    {                                                                                              \
        bad = good;                                                                                \
        bad.change;                                                                                \
        refused(shape, bad, word);                                                                 \
    }
    REFUSED(work = 0, "work of adhesion 0 J/m2")
    REFUSED(work = -0.05, "must be positive")
    REFUSED(work = INFINITY, "finite")
    REFUSED(work = NAN, "work of adhesion")
    REFUSED(range = 1e-4, "below the longer side of the map")
    REFUSED(range = -1e-9, "range")
    REFUSED(range = NAN, "range")
    REFUSED(law = "velcro", "no law of adhesion 'velcro': take one of exponential, dugdale, ")
    REFUSED(law = "jkr", "takes its range from the grid")
    REFUSED(contact.engine = "mlms", "inverse of K")
    REFUSED(contact.engine = "direct", "inverse of K")
    REFUSED(contact.engine = "abacus", "no engine 'abacus'")
    REFUSED(contact.method = "pk99", "does not support adhesion")
    REFUSED(contact.method = "pcg", "does not support adhesion")
    REFUSED(contact.tilt_free = true, "tilt")
    REFUSED(contact.hardness = -1, "hardness")
    REFUSED(contact.tol = -1, "tolerance")
    REFUSED(contact.pair.estar = -1, "E*")
    REFUSED(contact.pair = ((struct rc_pair){.two = {.e = 1e9}}), "body 1 is not")
    bad = good;
    bad.law = "dugdale";
    bad.range = 1e-8;
    refused(shape, bad, "within a node");
    bad.range = 0; /* the message names this field */
    assert_int_equal(rc_adhesion_check(&shape, &bad, &(struct rc_adhesion_scales){0}, &err), RC_OK);

    a = adhesion_new(shape, h, good);
    assert_int_equal(rc_adhesion_solver_step(a, &err), RC_FAIL);
    assert_int_equal(rc_adhesion_solver_pull_off(a, &err), RC_FAIL);
    assert_int_equal(rc_adhesion_solver_set_load(a, NAN, &err), RC_FAIL);
    assert_int_equal(rc_adhesion_solver_set_approach(a, INFINITY, &err), RC_FAIL);
    p[7] = INFINITY;
    assert_int_equal(rc_adhesion_solver_start(a, p, 0, &err), RC_FAIL);
    p[7] = -1e37; /* of a damaged state: no contact of these bodies has it */
    assert_int_equal(rc_adhesion_solver_start(a, p, 0, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "pressure 7, -1e+37 Pa"));
    assert_int_equal(rc_adhesion_solver_start(a, h, NAN, &err), RC_FAIL);
    rc_adhesion_solver_free(a);
    h[9] = NAN;
    assert_null(rc_adhesion_solver_new(&shape, h, &good, &err));
    assert_non_null(strstr(err.text, "height 9"));
    h[9] = 0;
    bad = good;
    bad.contact.boundary = RC_PERIODIC;
    a = adhesion_new(shape, h, bad);
    assert_int_equal(rc_adhesion_solver_set_approach(a, 1e-7, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "mean gap"));
    rc_adhesion_solver_free(a);
    bad = good;
    bad.contact.hardness = 1e6; /* at this gap the traction is 1e6 - 0.05/3e-7 Pa */
    a = adhesion_new(shape, h, bad);
    assert_int_equal(rc_adhesion_solver_set_load(a, 0.9 * 1e6 * 1024e-12, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "the map carries only"));
    assert_int_equal(rc_adhesion_solver_set_load(a, 0.8 * 1e6 * 1024e-12, &err), RC_OK);
    rc_adhesion_solver_free(a);
    bad.contact.hardness = 1; /* the attraction pulls a yielding node in */
    a = adhesion_new(shape, h, bad);
    assert_int_equal(rc_adhesion_solver_set_load(a, 1e-20, &err), RC_FAIL);
    assert_int_equal(rc_adhesion_solver_set_load(a, -1e-6, &err), RC_OK);
    rc_adhesion_solver_free(a);
    rc_adhesion_solver_free(NULL);
    for (size_t k = 0; rc_adhesion_law_info(k) != NULL; k++)
        assert_true(strlen(rc_adhesion_law_info(k)->summary) > 0);
}

/* ---- a sphere that sticks ---- */

enum {
    N = 64,
    LARGE = 128
};
static double h[LARGE * LARGE], p[LARGE * LARGE], gap[LARGE * LARGE];

struct sphere {
    struct rc_shape shape;
    struct rc_adhesion_problem problem;
    double load, approach; /* pi w R; Maugis' unit of approach */
};

static struct sphere
sphere_of(size_t n, double tabor)
{
    struct sphere s = {.shape = {n, n, 1e-6, 1e-6}};
    struct rc_place apex = {0.25e-6, 0.25e-6};
    double kay = 4 * estar / 3, a0 = 13e-6 * (double)n / N, length;

    s.problem = (struct rc_adhesion_problem){.contact = {.pair.estar = estar, .tol = 1e-5}};
    s.problem.work = a0 * a0 * a0 * kay / (6 * exact_pi * radius * radius);
    s.problem.range = cbrt(radius * s.problem.work * s.problem.work / (estar * estar)) / tabor;
    s.load = exact_pi * s.problem.work * radius;
    length = cbrt(exact_pi * s.problem.work * radius * radius / kay);
    s.approach = length * length / radius;
    rc_synth_paraboloid(&s.shape, apex, radius, radius, 0, h);
    return s;
}

/* Retraction by approach has no jump until the bodies separate, and one jump then. Under the same loads the
 * states beyond pull-off are saddle points. A residual does not distinguish them from minima, but the solver
 * must leave them. */
static void
saddles(void **state)
{
    struct sphere s = sphere_of(LARGE, 2);
    struct rc_adhesion_solver *a = adhesion_new(s.shape, h, s.problem);
    double lowest = 0, last = 0;
    size_t jumps = 0, falling = 0, rising = 0;
    bool held = true;

    (void)state;
    (void)adhesion_to_approach(a, 0);
    for (int k = 1; k <= 30; k++) {
        const struct rc_adhesion_state *f = adhesion_to_approach(a, -0.05 * k * s.approach);
        struct rc_adhesion_solver *b;
        double load = f->load;

        assert_true(f->converged && f->stable);
        if (held && f->contact_nodes == 0) {
            assert_true(f->jumps > 0);
            jumps++;
        } else if (load < 0.7 * lowest || !held) {
            assert_int_equal(f->jumps, 0);
        }
        held = f->contact_nodes > 0;
        rc_adhesion_solver_pressure(a, p);
        if (f->jumps == 0 && k % 3 == 0 && f->contact_nodes > 0) {
            b = adhesion_new(s.shape, h, s.problem);
            assert_int_equal(rc_adhesion_solver_start(b, p, f->approach, &adhesion_err), RC_OK);
            f = adhesion_to_load(b, load);
            if (load > last + 0.01 * s.load) { /* beyond the lowest load there is no stable state */
                assert_true(f->jumps > 0);
                assert_true(f->separated || f->stable);
                assert_int_equal(rc_adhesion_solver_step(b, &adhesion_err),
                                 f->separated ? RC_SHORT : RC_OK);
                rising++;
            } else if (load < last - 0.01 * s.load) {
                assert_true(f->converged && f->stable && f->jumps == 0);
                falling++;
            }
            rc_adhesion_solver_free(b);
        }
        last = load;
        lowest = fmin(lowest, load);
    }
    print_message("lowest %.3f, %zu jumps, %zu saddles, %zu stable states\n", lowest / s.load,
                  jumps, rising, falling);
    assert_int_equal(jumps, 1);
    assert_true(falling > 0 && rising > 0);
    rc_adhesion_solver_free(a);
}

/* A load below pull-off separates the bodies, and the figures say so; above it they stay in contact. */
static void
parting(void **state)
{
    struct sphere s = sphere_of(N, 1);
    struct rc_adhesion_solver *a = adhesion_new(s.shape, h, s.problem);
    const struct rc_adhesion_state *f = adhesion_to_load(a, 0);
    double lowest;

    (void)state;
    assert_true(f->converged && f->stable && f->contact_nodes > 0);
    f = adhesion_pull(a);
    lowest = f->pull_off_load;
    assert_true(f->converged && lowest < -1.5 * s.load && f->pull_off_approach < 0);
    assert_true(f->pull_off_spread <= 1e-3 * -lowest);
    f = adhesion_to_load(a, 0);
    assert_true(f->converged && !f->separated);
    f = adhesion_to_load(a, 0.98 * lowest);
    assert_true(f->converged && f->stable && !f->separated);
    assert_true(fabs(f->load - 0.98 * lowest) <= 1e-5 * -lowest);
    assert_int_equal(rc_adhesion_solver_set_load(a, 1.02 * lowest, &adhesion_err), RC_OK);
    assert_int_equal(adhesion_run(a), RC_SHORT);
    f = rc_adhesion_solver_result(a);
    assert_true(f->separated && !f->converged && f->contact_nodes == 0);
    assert_true(f->load == 0 && f->max_pressure == 0 && f->jumps == 1 && !f->was_separated);
    /* separated bodies carry no tension, also at a load above pull-off, and stay apart at load 0 */
    assert_int_equal(rc_adhesion_solver_set_load(a, 0.5 * lowest, &adhesion_err), RC_OK);
    assert_int_equal(adhesion_run(a), RC_SHORT);
    f = rc_adhesion_solver_result(a);
    assert_true(f->separated && f->was_separated && !f->converged && f->jumps == 0);
    assert_true(f->load == 0 && f->iterations == 0);
    f = adhesion_to_load(a, 0);
    assert_true(f->separated && f->converged && f->stable && f->load == 0 && f->iterations == 0);
    rc_adhesion_solver_pressure(a, p);
    for (size_t k = 0; k < s.shape.nx * s.shape.ny; k++)
        assert_true(p[k] == 0);
    /* and the path continues from there */
    f = adhesion_to_load(a, 0.1 * s.load);
    assert_true(f->converged && f->contact_nodes > 0);
    rc_adhesion_solver_free(a);
}

/* The lowest load is the same from 6 steps as from 25. */
static void
pull_off_by_hand(void **state)
{
    struct sphere s = sphere_of(N, 1);
    struct rc_adhesion_solver *a = adhesion_new(s.shape, h, s.problem);
    double lowest = 0, is;

    (void)state;
    (void)adhesion_to_approach(a, s.approach);
    is = adhesion_pull(a)->pull_off_load;
    (void)adhesion_to_approach(a, s.approach);
    for (int k = 0; k <= 100; k++)
        lowest = fmin(lowest, adhesion_to_approach(a, s.approach * (1 - 0.02 * k))->load);
    print_message("lowest load %.5f, by a hundred steps %.5f\n", is / s.load, lowest / s.load);
    assert_true(fabs(is - lowest) <= 1e-3 * -lowest);
    rc_adhesion_solver_free(a);
}

/* The frames of a pull-off on a periodic map belong to its load. */
static void
pull_off_of_periodic(void **state)
{
    const struct rc_shape shape = {32, 32, 1e-6, 1e-6};
    const struct rc_selfaffine rough = {
        .hurst = 0.8, .short_cut = 4e-6, .seed = 3, .rms_height = 1e-7};
    const struct rc_adhesion_problem problem = {
        .contact = {.pair.estar = 1e9, .boundary = RC_PERIODIC}, .work = 0.05};
    static double pressure[32 * 32];
    struct rc_adhesion_solver *a;
    double load, sum = 0;

    (void)state;
    assert_int_equal(rc_synth_selfaffine(&shape, &rough, h, &adhesion_err), RC_OK);
    a = adhesion_new(shape, h, problem);
    (void)adhesion_to_approach(a, 5e-8);
    load = adhesion_pull(a)->load;
    rc_adhesion_solver_pressure(a, pressure);
    for (size_t k = 0; k < 32 * 32; k++)
        sum += pressure[k] * shape.dx * shape.dy;
    print_message("pull-off at %.6e N, the pressures sum to %.6e N\n", load, sum);
    assert_true(load < 0 && fabs(sum - load) <= 1e-9 * -load);
    rc_adhesion_solver_free(a);
}

/* A rough ball separates spot by spot: its load against approach has several local minima, with jumps between
 * them. The search must find the lowest one, as a path of two hundred steps does, and its error must be
 * within the reported spread. */
static void
pull_off_of_rough(void **state)
{
    const struct rc_shape shape = {96, 96, 2e-6, 2e-6};
    const struct rc_place apex = {0.5e-6, 0.5e-6};
    const struct rc_adhesion_problem problem = {
        .contact = {.pair.estar = 2e6}, .work = 0.05, .law = "jkr"};
    const double heights[] = {0.3e-6, 0.6e-6, 1.5e-6};

    (void)state;
    for (size_t k = thorough(0, 2); k < sizeof heights / sizeof *heights; k++) {
        const struct rc_selfaffine rough = {.hurst = 0.8,
                                            .rolloff = 40e-6,
                                            .short_cut = 16e-6,
                                            .seed = 3,
                                            .rms_height = heights[k]};
        static double ball[96 * 96];
        const struct rc_adhesion_state *f;
        struct rc_adhesion_solver *a;
        double start, lowest = 0, is, spread;

        assert_int_equal(rc_synth_selfaffine(&shape, &rough, h, &adhesion_err), RC_OK);
        rc_synth_paraboloid(&shape, apex, 1e-3, 1e-3, 0, ball);
        for (size_t i = 0; i < 96 * 96; i++)
            h[i] += ball[i];
        a = adhesion_new(shape, h, problem);
        start = adhesion_to_load(a, 0.3e-3)->approach;
        f = adhesion_pull(a);
        is = f->pull_off_load;
        spread = f->pull_off_spread;
        print_message("RMS %g um: %.3f uN, give or take %.2f, %zu states, %.0f convolutions; ",
                      heights[k] * 1e6, is * 1e6, spread * 1e6, f->states, f->convolutions);
        assert_true(f->converged);
        (void)adhesion_to_load(a, 0.3e-3);
        for (int i = 0; i <= 200; i++) {
            f = adhesion_to_approach(a, start - i * (start + 1e-6) / 200);
            lowest = fmin(lowest, f->load);
        }
        print_message("in small steps %.3f\n", lowest * 1e6);
        assert_true(is <= lowest + 1e-3 * fabs(lowest));
        assert_true(is >= lowest * 1.03); /* between two steps the load may be lower */
        assert_true(spread >= 0 && spread <= 2e-3 * fabs(is));
        rc_adhesion_solver_free(a);
    }
}

/* The load over the approach is far from a parabola (first map), has jumps of single nodes (second), or is
 * like a saw (third). By the stiffness of a punch, the first step jumps past the lowest load (fourth).
 * Coarse steps pass over a saw that only the states beside the lowest load show (fifth). The lowest load of
 * 400 steps is below the found one by at most the spread. */
static void
pull_off_has_spread(void **state)
{
    static const struct {
        size_t n;
        struct rc_selfaffine rough;
        const char *law;
        double work, range, from; /* from: part of the highest node above the mean */
        struct rc_boundary boundary;
    } cases[] = {
        {63,
         {.hurst = 0.8, .rms_slope = 0.0792876, .short_cut = 2, .rolloff = 15.75, .seed = 627803},
         "exponential",
         0.0146205,
         0.3255228,
         0.98,
         {.x = true, .y = true}},
        {39,
         {.hurst = 0.8, .rms_slope = 0.0814774, .short_cut = 4, .rolloff = 9.75, .seed = 604370},
         "exponential",
         9.59238e-4,
         0.0361906,
         0.82,
         {.x = true, .y = true}},
        {42,
         {.hurst = 0.8, .rms_slope = 0.0338718, .short_cut = 4, .rolloff = 10.5, .seed = 184910},
         "compact",
         5.7623e-4,
         0.0869521,
         0.97,
         {.x = false}},
        {48,
         {.hurst = 0.8, .rms_slope = 0.0143839, .short_cut = 8, .rolloff = 12, .seed = 853695},
         "dugdale",
         2.211047e-4,
         0.01918840,
         0.947,
         {.x = true, .y = true}},
        {54,
         {.hurst = 0.8, .rms_slope = 0.0682327, .short_cut = 4, .rolloff = 13.5, .seed = 758324},
         "dugdale",
         1.737158e-3,
         0.1108541,
         0.809204,
         {.x = true, .y = true}}};

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const struct rc_shape shape = {cases[k].n, cases[k].n, 1, 1};
        const struct rc_adhesion_problem problem = {
            .contact = {.boundary = cases[k].boundary, .pair.estar = 1, .tol = 1e-4},
            .work = cases[k].work,
            .law = cases[k].law,
            .range = cases[k].range};
        const size_t n = shape.nx * shape.ny;
        const struct rc_adhesion_state *f;
        struct rc_adhesion_solver *a;
        double first = -INFINITY, last, lowest = 0, is, spread;

        assert_int_equal(rc_synth_selfaffine(&shape, &cases[k].rough, h, &adhesion_err), RC_OK);
        for (size_t i = 0; i < n; i++)
            first = fmax(first, h[i]);
        first = cases[k].from * (first - rc_sum(h, n) / (double)n);
        a = adhesion_new(shape, h, problem);
        (void)adhesion_to_approach(a, first);
        f = adhesion_pull(a);
        is = f->pull_off_load;
        spread = f->pull_off_spread;
        last = f->pull_off_approach - 0.1 * (first - f->pull_off_approach);
        assert_true(f->converged);
        rc_adhesion_solver_free(a);
        a = adhesion_new(shape, h, problem);
        for (int i = 0; i <= 400; i++) {
            f = adhesion_to_approach(a, first - i * (first - last) / 400);
            lowest = fmin(lowest, f->load);
        }
        rc_adhesion_solver_free(a);
        print_message("pull-off at %.5f, spread %.1e of it, in small steps %.5f\n", is,
                      spread / -is, lowest);
        assert_true(is <= lowest + spread);
        assert_true(spread <= 0.05 * -is);
    }
}

/* A retraction that starts where the load already rises cannot know the pull-off load. */
static void
pull_off_at_start(void **state)
{
    struct sphere s = sphere_of(N, 1);
    struct rc_adhesion_solver *a = adhesion_new(s.shape, h, s.problem);
    const struct rc_adhesion_state *f;

    (void)state;
    (void)adhesion_to_approach(a, s.approach);
    (void)adhesion_to_approach(a, -0.5 * s.approach);
    assert_true(adhesion_to_approach(a, -1.2 * s.approach)->load < 0);
    f = adhesion_pull(a);
    assert_true(f->converged && f->pull_off_at_start);
    assert_true(isnan(f->pull_off_load) && isnan(f->pull_off_spread) &&
                isnan(f->pull_off_approach));
    rc_adhesion_solver_free(a);
}

/* ---- maps ---- */

static void
maps(void **state)
{
    const struct rc_shape shapes[] = {{1, 64, 1e-6, 1e-6}, {64, 1, 1e-6, 1e-6},
                                      {2, 37, 1e-6, 1e-6}, {37, 41, 1e-6, 2e-6},
                                      {33, 5, 3e-6, 1e-6}, {1, 1, 1e-6, 1e-6}};

    (void)state;
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++)
        for (int b = 0; b < 2; b++) {
            struct rc_shape s = shapes[k];
            size_t n = s.nx * s.ny;
            struct rc_adhesion_problem problem = {.contact = {.boundary = b ? RC_PERIODIC : RC_FREE,
                                                              .pair.estar = estar,
                                                              .tol = 1e-6},
                                                  .work = 0.02};
            struct rc_adhesion_solver *a;
            const struct rc_adhesion_state *f;
            struct rc_conv *conv;
            const struct rc_conv_options options = {.boundary = problem.contact.boundary};
            double worst = 0, size = 0;

            rc_synth_wave(&s, 1e-7, s.nx > 2 ? (double)s.nx * s.dx : INFINITY,
                          s.ny > 2 ? (double)s.ny * s.dy : INFINITY, h);
            if (b == 1 && n == 1)
                continue;
            a = adhesion_new(s, h, problem);
            f = adhesion_to_approach(a, b ? -1e-8 : 1e-8);
            if (!f->converged || !f->stable)
                print_error("%zu x %zu, %d: error %g\n", s.nx, s.ny, b, f->pressure_error);
            assert_true(f->converged && f->stable);
            assert_true(f->attractive_load > 0);
            rc_adhesion_solver_pressure(a, p);
            rc_adhesion_solver_displacement(a, gap);
            conv = rc_conv_new(&s, &problem.contact.pair, &options, &adhesion_err);
            assert_non_null(conv);
            rc_conv_apply(conv, p, h);
            for (size_t i = 0; i < n; i++) {
                worst = fmax(worst, fabs(h[i] - gap[i]));
                size = fmax(size, fabs(h[i]));
            }
            if (worst > 1e-5 * size)
                print_error("%zu x %zu, %d: displacement off by %g of %g\n", s.nx, s.ny, b, worst,
                            size);
            assert_true(worst <= 1e-5 * size + 1e-25);
            rc_conv_free(conv);
            rc_adhesion_solver_free(a);
        }
}

/* ---- hardness ---- */

/* p + sigma is at most the hardness; gaps are negative only at nodes that reach it, and such nodes exist.
 * After separation the overlap has been removed from the heights, and the same load causes no further
 * yielding. */
static void
hardness(void **state)
{
    struct sphere s = sphere_of(N, 1);
    double strength = s.problem.work / s.problem.range, hard = 1.5 * strength, load, volume = 0;
    static double sigma[N * N], before[N * N];
    struct rc_adhesion_solver *a;
    const struct rc_adhesion_state *f;

    (void)state;
    memcpy(before, h, sizeof before);
    s.problem.contact.hardness = hard;
    s.problem.contact.tol = 1e-7;
    a = adhesion_new(s.shape, h, s.problem);
    f = adhesion_to_approach(a, 2.5 * s.approach);
    load = f->load;
    assert_true(f->converged && f->stable && f->plastic_nodes > 10);
    print_message("hardness: %zu of %zu nodes, %zu steps\n", f->plastic_nodes, f->contact_nodes,
                  f->iterations);
    rc_adhesion_solver_pressure(a, p);
    rc_adhesion_solver_gap(a, gap);
    rc_adhesion_solver_traction(a, sigma);
    for (size_t k = 0; k < N * N; k++) {
        double is = p[k] + sigma[k];
        assert_true(is >= -1e-6 * hard && is <= hard * (1 + 1e-6));
        if (gap[k] < 0)
            assert_true(fabs(is - hard) <= 1e-6 * hard);
        volume += fmin(gap[k], 0);
    }
    rc_adhesion_solver_keep_shape(a, h);
    for (size_t k = 0; k < N * N; k++)
        volume += before[k] - h[k];
    assert_true(fabs(volume) <= 1e-12 * radius);
    f = adhesion_to_approach(a, 2.5 * s.approach);
    assert_true(f->converged && fabs(f->load - load) <= 1e-5 * fabs(load));
    rc_adhesion_solver_gap(a, gap);
    for (size_t k = 0; k < N * N; k++)
        assert_true(gap[k] >= -1e-6 * s.approach);
    f = adhesion_pull(a);
    assert_true(f->converged && f->pull_off_load < 0);
    rc_adhesion_solver_free(a);

    /* a hardness that is never reached, as a number or as a map, changes nothing */
    memcpy(h, before, sizeof before);
    for (size_t k = 0; k < N * N; k++)
        sigma[k] = k % 2 ? NAN : 1e6 * hard;
    s.problem.contact.hardness = 0;
    a = adhesion_new(s.shape, h, s.problem);
    (void)adhesion_to_approach(a, 2.5 * s.approach);
    rc_adhesion_solver_pressure(a, before);
    rc_adhesion_solver_free(a);
    s.problem.contact.hardness_map = sigma;
    a = adhesion_new(s.shape, h, s.problem);
    f = adhesion_to_approach(a, 2.5 * s.approach);
    assert_true(f->converged && f->plastic_nodes == 0);
    rc_adhesion_solver_pressure(a, p);
    assert_true(adhesion_distance(N * N, p, before) <= 1e-6);
    rc_adhesion_solver_free(a);
}

/* ---- no node apart ---- */

/* Rough free maps under a load that closes the gap everywhere. The pressures are A h plus a constant and
 * carry the load. The number of steps is as usual. */
static void
closed_by_a_load(void **state)
{
    const double load[] = {3e6, 20e6};
    const struct rc_shape shape = {N, N, 1e-6, 1e-6};

    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++)
        for (size_t k = 0; k < 2; k++) {
            struct rc_selfaffine rough = {.hurst = 0.8,
                                          .short_cut = 8e-6,
                                          .rms_height = 5e-8,
                                          .rolloff = 32e-6,
                                          .seed = seed};
            struct rc_adhesion_problem problem = {
                .contact = {.pair.estar = 10e6, .tol = 1e-6}, .work = 0.05, .range = 5e-8};
            const struct rc_adhesion_state *f;
            struct rc_adhesion_solver *a, *again;
            double area = N * N * 1e-12, c;

            assert_int_equal(rc_synth_selfaffine(&shape, &rough, h, &adhesion_err), RC_OK);
            a = adhesion_new(shape, h, problem);
            f = adhesion_to_load(a, load[k] * area);
            assert_true(f->converged && f->contact_nodes == N * N && f->iterations < 30);
            assert_true(fabs(f->load / (load[k] * area) - 1) < 1e-5);
            c = f->approach;
            again = adhesion_new(shape, h, problem);
            f = adhesion_to_approach(again, c); /* the same state, by its approach */
            assert_true(f->converged && fabs(f->load / (load[k] * area) - 1) < 1e-5);
            rc_adhesion_solver_free(a);
            rc_adhesion_solver_free(again);
        }
}

/* Two planes on a periodic map, so close that all nodes touch at the start. The gap must be the requested
 * one, and the pressure the traction of the law. */
static void
planes(void **state)
{
    const double away[] = {20e-9, 1e-9, 0.1e-9};
    const struct rc_shape shape = {8, 6, 1e-6, 1e-6};

    (void)state;
    for (size_t k = 0; k < 3; k++) {
        const struct rc_adhesion_problem problem = {
            .contact = {.pair.estar = 1e9, .boundary = RC_PERIODIC, .tol = 1e-6},
            .work = 0.05,
            .range = 20e-9};
        const struct rc_adhesion_state *f;
        struct rc_adhesion_solver *a;

        for (size_t i = 0; i < 48; i++)
            h[i] = 3.7e-6;
        a = adhesion_new(shape, h, problem);
        f = adhesion_to_approach(a, -away[k]);
        assert_true(f->converged && f->stable && f->contact_nodes == 0);
        assert_true(fabs(f->mean_gap / away[k] - 1) < 1e-9);
        assert_true(fabs(-f->mean_pressure / (0.05 / 20e-9 * exp(-away[k] / 20e-9)) - 1) < 1e-9);
        rc_adhesion_solver_free(a);
    }
}

/* ---- coatings ---- */

/* A layer of the substrate's material has no effect. With a stiffer or softer layer the state obeys the same
 * laws, where K is the displacement of rc_conv for this body. */
static void
coatings(void **state)
{
    const double ratio[] = {1, 10, 0.1};

    (void)state;
    for (int b = 0; b < 2; b++)
        for (size_t k = 0; k < 3; k++) {
            struct sphere s = sphere_of(N, 1);
            struct rc_layer layer = {4e-6, ratio[k] * estar, 0.3};
            struct rc_adhesion_problem problem = s.problem;
            const struct rc_conv_options options = {.boundary = b ? RC_PERIODIC : RC_FREE};
            static double bare[N * N], u[N * N], ku[N * N];
            struct rc_adhesion_solver *a;
            struct rc_conv *conv;
            const struct rc_adhesion_state *f;
            double worst = 0, size = 0;

            problem.contact.boundary = options.boundary;
            problem.contact.tol = 1e-8;
            problem.contact.pair = (struct rc_pair){.one = {.e = estar, .nu = 0.3}};
            if (k == 0) {
                a = adhesion_new(s.shape, h, problem);
                (void)adhesion_to_approach(a, 0);
                rc_adhesion_solver_pressure(a, bare);
                rc_adhesion_solver_free(a);
            }
            problem.contact.pair.one.layers = 1;
            problem.contact.pair.one.layer = &layer;
            a = adhesion_new(s.shape, h, problem);
            f = adhesion_to_approach(a, 0);
            assert_true(f->converged && f->stable && f->kkt_residual < 1e-6);
            print_message("layer %g times as stiff: %zu steps, %.0f convolutions, stability %.2g\n",
                          ratio[k], f->iterations, f->convolutions, f->stability);
            rc_adhesion_solver_pressure(a, p);
            rc_adhesion_solver_displacement(a, u);
            conv = rc_conv_new(&s.shape, &problem.contact.pair, &options, &adhesion_err);
            assert_non_null(conv);
            rc_conv_apply(conv, p, ku);
            rc_conv_free(conv);
            for (size_t i = 0; i < N * N; i++) {
                worst = fmax(worst, fabs(u[i] - ku[i]));
                size = fmax(size, fabs(ku[i]));
            }
            assert_true(worst <= 1e-8 * size);
            if (k == 0)
                assert_true(adhesion_distance(N * N, p, bare) <= 1e-5);
            rc_adhesion_solver_free(a);
        }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(requests),
        cmocka_unit_test(saddles),
        cmocka_unit_test(parting),
        cmocka_unit_test(pull_off_by_hand),
        cmocka_unit_test(pull_off_of_periodic),
        cmocka_unit_test(pull_off_of_rough),
        cmocka_unit_test(pull_off_has_spread),
        cmocka_unit_test(pull_off_at_start),
        cmocka_unit_test(maps),
        cmocka_unit_test(hardness),
        cmocka_unit_test(closed_by_a_load),
        cmocka_unit_test(planes),
        cmocka_unit_test(coatings),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
