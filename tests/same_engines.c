/* Every engine gives what the direct sum gives, for every kernel, size and spacing. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "exact.h"
#include "libcontact/operator/operator.h"

static double
random_number(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005U + 1442695040888963407U;
    return (double)(*seed >> 11) / 9007199254740992.0 - 0.5;
}

/* Sum of |K| about the middle of the map times the largest |p|: what an error is judged against. */
static double
magnitude(const struct rc_sum *s, const double *p)
{
    const struct rc_lattice at = {s->shape.dx, s->shape.dy, 1, 1};
    size_t nx = s->shape.nx, ny = s->shape.ny, mx = nx / 2, my = ny / 2;
    double *k = malloc(nx * ny * sizeof *k), sum = 0, largest = 0;

    s->kernel->rows(&s->medium, s->component, &at, nx, 0, ny, k);
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            size_t a = i > mx ? i - mx : mx - i, b = j > my ? j - my : my - j;
            sum += fabs(k[b * nx + a]);
            largest = fmax(largest, fabs(p[j * nx + i]));
        }
    free(k);
    return sum * largest;
}

/* Largest difference of u from what `engine` makes of p, over `magnitude` and rounding. */
static double
off(const struct rc_sum *sum, const struct rc_engine *engine, bool precise, double tol,
    const double *p, const double *u)
{
    struct rc_sum asked = *sum;
    size_t n = sum->shape.nx * sum->shape.ny;
    double *v = malloc(n * sizeof *v), worst = 0, largest = magnitude(sum, p);
    struct rc_err err;
    void *plan;

    asked.tol = tol;
    asked.precise = precise;
    plan = engine->new (&asked, &err);
    assert_non_null(plan);
    assert_true(tol == 0 || engine->error(plan) <= tol);
    engine->apply(plan, p, v);
    for (size_t k = 0; k < n; k++)
        worst = fmax(worst, fabs(u[k] - v[k]));
    engine->free(plan);
    free(v);
    /* tables made in different blocks differ by rounding: for stresses 1e-16 of the pressure */
    if (sum->kernel == &rc_kernel_stress)
        largest += 0.01 * sqrt((double)n);
    return worst / largest;
}

static void
compare(struct rc_shape shape, const struct rc_kernel *kernel, size_t component, size_t threads)
{
    static const struct {
        const struct rc_engine *engine;
        bool precise;
        double tol, within;
    } other[] = {{&rc_engine_fft, false, 0, 1e-14},
                 {&rc_engine_fft, true, 1e-3, 1e-14},
                 {&rc_engine_mlms, false, 0, 2e-14},
                 {&rc_engine_mlms, false, 1e-3, 1e-3}};
    struct rc_sum sum = {.shape = shape,
                         .kernel = kernel,
                         .component = component,
                         .medium = {.estar = 2.385e9, .nu = 0.28, .depth = 0.7 * shape.dx},
                         .threads = threads};
    size_t n = shape.nx * shape.ny;
    double *p = malloc(n * sizeof *p), *u = malloc(n * sizeof *u);
    uint64_t seed = 1999;
    struct rc_err err;
    void *direct = rc_engine_direct.new(&sum, &err);

    assert_non_null(direct);
    for (size_t k = 0; k < n; k++)
        p[k] = random_number(&seed);
    rc_engine_direct.apply(direct, p, u);
    for (size_t e = 0; e < sizeof other / sizeof *other; e++) {
        double by = off(&sum, other[e].engine, other[e].precise, other[e].tol, p, u);
        if (by > other[e].within)
            print_error("%zu x %zu, %s %zu by %s: off by %g\n", shape.nx, shape.ny,
                        kernel->info.name, component, other[e].engine->info.name, by);
        assert_true(by <= other[e].within);
    }
    rc_engine_direct.free(direct);
    free(p);
    free(u);
}

static void
every_size_and_component(void **state)
{
    static const struct rc_shape shapes[] = {
        {33, 47, 1.1e-6, 1e-6}, {1, 17, 1, 1},  {17, 1, 1, 1},     {1, 1, 3, 2},     {2, 3, 1, 1},
        {3, 211, 1, 5},         {64, 64, 1, 1}, {97, 31, 1, 0.01}, {50, 20, 1, 100},
    };

    (void)state;
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
        compare(shapes[s], &rc_kernel_boussinesq, 0, 2);
        for (size_t c = 0; c < rc_kernel_stress.info.components; c++)
            compare(shapes[s], &rc_kernel_stress, c, 1 + s % 3);
    }
}

/* Loading once and asking for fields gives what one-by-one application gives. */
static void
one_transform_serves_all_kernels(void **state)
{
    struct rc_shape shape = {37, 22, 1, 1.3};
    struct rc_medium medium = {.nu = 0.3, .depth = 1.1};
    size_t n = shape.nx * shape.ny;
    double *p = calloc(n, sizeof *p), *u = malloc(n * sizeof *u), *v = malloc(n * sizeof *v);
    struct rc_err err;
    struct rc_fft *fft = rc_fft_new(&shape, RC_FREE, RC_DOUBLE, 2, &err);
    struct rc_spectrum *k = rc_spectrum_new(fft, &err);

    (void)state;
    p[5 * 37 + 9] = 3;
    p[20 * 37 + 30] = -1;
    assert_int_equal(rc_fft_load(fft, p, &err), RC_OK);
    for (size_t c = 0; c < rc_kernel_stress.info.components; c++) {
        assert_int_equal(rc_spectrum_set(k, fft, &rc_kernel_stress, c, &medium, &err), RC_OK);
        rc_fft_field(fft, k, u);
        rc_fft_apply(fft, k, p, v);
        for (size_t i = 0; i < n; i++)
            assert_true(fabs(u[i] - v[i]) <= rounding);
    }
    rc_spectrum_free(k);
    rc_fft_free(fft);
    free(p);
    free(u);
    free(v);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_size_and_component),
        cmocka_unit_test(one_transform_serves_all_kernels),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
