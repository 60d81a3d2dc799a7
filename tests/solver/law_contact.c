/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws of every contact solution: load, bounds, complementarity, symmetry, and an error estimate that is not
 * below the true error. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

static const double estar = 114e9;

/* The paper's section 4.2: 483 x 412 nodes, composite radius 7.5 mm, 240 N; Hertz's maximum is 2.2 GPa. With
 * the roughness the pressure reaches a hardness of 6 GPa. */
static double *
paper_surface(struct rc_shape shape, double radius)
{
    size_t n = shape.nx * shape.ny;
    double *h = malloc(n * sizeof *h), *rough = malloc(n * sizeof *rough);
    struct rc_selfaffine what = {
        .hurst = 0.8, .rms_height = 0.3e-6, .rolloff = 100e-6, .short_cut = 8e-6, .seed = 483};
    struct rc_err err;

    assert_int_equal(rc_synth_selfaffine(&shape, &what, rough, &err), RC_OK);
    rc_synth_sphere(&shape, radius, h);
    for (size_t k = 0; k < n; k++)
        h[k] += rough[k];
    free(rough);
    return h;
}

static double
deviation(size_t n, const double *v)
{
    double mean = 0, sum = 0;

    for (size_t k = 0; k < n; k++)
        mean += v[k] / (double)n;
    for (size_t k = 0; k < n; k++)
        sum += (v[k] - mean) * (v[k] - mean);
    return sqrt(sum / (double)n);
}

static void
check_laws(struct rc_shape shape, const double *h, const struct solved *s, double load,
           double hardness)
{
    size_t n = shape.nx * shape.ny;
    long double sum = 0;
    double top = -INFINITY, worst = 0;

    for (size_t k = 0; k < n; k++)
        top = fmax(top, h[k]);
    for (size_t k = 0; k < n; k++) {
        assert_true(s->p[k] >= 0 && s->p[k] <= hardness);
        sum += s->p[k];
        if (s->p[k] > 0 && s->p[k] < hardness)
            worst = larger(worst, fabs(s->gap[k]));
        else if (s->p[k] == 0)
            worst = larger(worst, -s->gap[k]);
        else
            worst = larger(worst, s->gap[k]);
        /* gap = displacement - height - c, approach = c + max(height) */
        assert_true(fabs(s->gap[k] - (s->u[k] - h[k] - (s->c.approach - top))) <
                    summed * (fabs(top) + s->c.approach));
    }
    assert_true(fabs((double)sum * shape.dx * shape.dy / load - 1) < summed);
    assert_true(fabs(worst - s->c.kkt_residual * larger(deviation(n, h), deviation(n, s->u))) <=
                summed * worst);
}

static void
the_papers_rough_sphere(void **state)
{
    struct rc_shape shape = {483, 412, 1.1e-6, 1.29e-6};
    double *h = paper_surface(shape, 7.5e-3), load = 240, hardness = 6e9;
    struct rc_problem problem = {
        .pair.estar = estar, .load = load, .hardness = hardness, .threads = 2};
    struct solved s = solve(shape, h, problem);

    (void)state;
    assert_int_equal(s.status, RC_OK);
    print_message("%zu iterations, %.1f %% contact, %.2f %% plastic, load off by %.1e, KKT %.1e\n",
                  s.c.iterations, 100 * s.c.contact_fraction,
                  100 * s.c.plastic_area / s.c.contact_area, s.c.load / load - 1, s.c.kkt_residual);
    assert_true(s.c.max_pressure == hardness && s.c.plastic_nodes > 0);
    assert_true(s.c.pressure_error <= pow(483 * 412, -0.75));
    check_laws(shape, h, &s, load, hardness);
    solved_free(&s);
    free(h);
}

/* Compared with the same problem solved to 1e-10; the error of this reference may be a thousandth of the
 * difference. */
static void
the_estimate_does_not_flatter(void **state)
{
    static const double hardnesses[] = {INFINITY, 9e9, 5e9};
    struct rc_shape shape = {
        121, 103, 1.1e-6,
        1.29e-6}; /* the grid of the paper with a quarter of the nodes along each side */
    double *h = paper_surface(shape, 7.5e-3 / 4), load = 240.0 / 16;

    (void)state;
    for (size_t k = 0; k < 3; k++) {
        struct rc_problem problem = {.pair.estar = estar,
                                     .load = load,
                                     .hardness = hardnesses[k],
                                     .tol = 1e-10,
                                     .threads = 2};
        struct solved exact = solve(shape, h, problem);

        assert_int_equal(exact.status, RC_OK);
        assert_true(exact.c.kkt_residual < 10 * problem.tol); /* gaps are not pressures */
        check_laws(shape, h, &exact, load, hardnesses[k]);
        for (double tol = 1e-2; tol > 1e-8; tol /= 10) {
            struct solved s;
            double error;
            problem.tol = tol;
            s = solve(shape, h, problem);
            assert_int_equal(s.status, RC_OK);
            error = distance(shape.nx * shape.ny, s.p, exact.p);
            print_message("H %.0e, tol %.0e: estimated %.2e, true %.2e\n", hardnesses[k], tol,
                          s.c.pressure_error, error);
            assert_true(error <= tol);
            assert_true(s.c.pressure_error >= error * (1 - 1e-3));
            assert_true(s.c.pressure_error <= error * (s.c.pressure_error > estimate_small
                                                           ? estimate_early
                                                       : isinf(hardnesses[k]) ? estimate_elastic
                                                                              : estimate_plastic));
            solved_free(&s);
        }
        solved_free(&exact);
    }
    free(h);
}

/* A mirrored surface has the mirrored pressure; twice the load alone does not double the pressure, but twice
 * the load, modulus and hardness do. */
static void
mirror_and_scale(void **state)
{
    struct rc_shape shape = {61, 52, 1.1e-6, 1.29e-6};
    size_t n = shape.nx * shape.ny;
    double *h = paper_surface(shape, 7.5e-3 / 8), *mirrored = malloc(n * sizeof *mirrored);
    struct rc_problem problem = {
        .pair.estar = estar, .load = 240.0 / 64, .hardness = 5e9, .tol = 1e-9};
    struct solved a = solve(shape, h, problem), b;

    (void)state;
    for (size_t k = 0; k < n; k++)
        mirrored[k] = h[n - 1 - k];
    problem.load *= 2;
    problem.pair.estar *= 2;
    problem.hardness *= 2;
    b = solve(shape, mirrored, problem);
    for (size_t k = 0; k < n; k++)
        mirrored[k] = b.p[n - 1 - k] / 2;
    assert_int_equal(a.status, RC_OK);
    assert_int_equal(b.status, RC_OK);
    assert_true(distance(n, mirrored, a.p) < 2 * problem.tol); /* each to that */
    assert_true(fabs(a.c.approach / b.c.approach - 1) < 2 * problem.tol);
    solved_free(&a);
    solved_free(&b);
    free(h);
    free(mirrored);
}

/* The engine changes the pressure by less than the asked tolerance. */
static void
engines_agree(void **state)
{
    struct rc_shape shape = {121, 103, 1.1e-6, 1.29e-6};
    double *h = paper_surface(shape, 7.5e-3 / 4);
    struct rc_problem problem = {
        .pair.estar = estar, .load = 240.0 / 16, .hardness = 6e9, .tol = 1e-5, .threads = 2};
    struct solved fft, mlms;

    (void)state;
    problem.engine = "fft";
    fft = solve(shape, h, problem);
    problem.engine = "mlms";
    mlms = solve(shape, h, problem);
    assert_int_equal(mlms.status, RC_OK);
    print_message("MLMS differs from FFT by %.1e\n", distance(shape.nx * shape.ny, mlms.p, fft.p));
    assert_int_equal(fft.status, RC_OK);
    assert_true(distance(shape.nx * shape.ny, mlms.p, fft.p) < 2 * problem.tol); /* each to that */
    solved_free(&fft);
    solved_free(&mlms);
    free(h);
}

/* More load gives more contact and more approach. Less hardness gives more contact and more approach. */
static void
monotone(void **state)
{
    struct rc_shape shape = {61, 52, 1.1e-6, 1.29e-6};
    double *h = paper_surface(shape, 7.5e-3 / 8), area = 0, approach = 0;

    (void)state;
    for (double load = 0.01; load < 20; load *= 3) {
        struct rc_problem problem = {.pair.estar = estar, .load = load, .tol = 1e-6};
        struct solved s = solve(shape, h, problem);
        assert_int_equal(s.status, RC_OK);
        assert_true(s.c.contact_area >= area && s.c.approach > approach);
        area = s.c.contact_area;
        approach = s.c.approach;
        solved_free(&s);
    }
    area = approach = 0;
    for (double hardness = 50e9; hardness > 1.3e9; hardness /= 2) {
        struct rc_problem problem = {
            .pair.estar = estar, .load = 240.0 / 64, .hardness = hardness, .tol = 1e-6};
        struct solved s = solve(shape, h, problem);
        assert_int_equal(s.status, RC_OK);
        assert_true(s.c.contact_area >= area && s.c.approach >= approach * (1 - 2 * problem.tol));
        area = s.c.contact_area;
        approach = s.c.approach;
        solved_free(&s);
    }
    free(h);
}

int
main(void)
{
    int failed = 0;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_papers_rough_sphere),
        cmocka_unit_test(the_estimate_does_not_flatter),
        cmocka_unit_test(engines_agree),
        cmocka_unit_test(mirror_and_scale),
        cmocka_unit_test(monotone),
    };

    RUN_FOR_EACH_METHOD(tests, failed)
    return failed;
}
