/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rc_detrend_form removes exactly the added form: polynomials, spheres and cylinders of either sign, any
 * position and tilt, with missing points, noise and spikes. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/exact.h"
#include "maps.h"

static const struct rc_shape shape = {.nx = 61, .ny = 47, .dx = 1.1e-6, .dy = 1e-6};

/* The permitted rest, relative to the height of the form. */
static const double left_of_form = 1e-7;

static double
place(size_t i, size_t n, double d)
{
    return ((double)i - 0.5 * (double)(n - 1)) * d;
}

static double
span(const double *h, size_t n)
{
    double low = INFINITY, high = -INFINITY;

    for (size_t k = 0; k < n; k++)
        if (!isnan(h[k])) {
            low = fmin(low, h[k]);
            high = fmax(high, h[k]);
        }
    return high - low;
}

static double
highest(const double *h, size_t n)
{
    double m = 0;

    for (size_t k = 0; k < n; k++)
        m = isnan(h[k]) ? m : fmax(m, fabs(h[k]));
    return m;
}

static void
lose(double *h, size_t n, int one_in)
{
    for (size_t k = 0; k < n; k++)
        if (rand() % one_in == 0)
            h[k] = NAN;
}

/* ---- the forms ---- */

/* A ball of radius |R| with its centre at (x, y, z): its upper side, or the lower one for a hollow (R <
 * 0). */
struct ball {
    double radius, x, y, z;
};

static void
make_ball(const struct rc_shape *s, struct ball b, double *h)
{
    for (size_t k = 0; k < s->nx * s->ny; k++) {
        long double x = place(k % s->nx, s->nx, s->dx) - b.x, y = place(k / s->nx, s->ny, s->dy);
        long double r = b.radius, up;
        y -= b.y;
        assert_true(r * r > x * x + y * y);
        up = sqrtl(r * r - x * x - y * y);
        h[k] = (double)(b.z + (r > 0 ? up : -up));
    }
}

/* A cylinder whose axis passes through (x, y, z) along `direction` (rad, from x towards y) and rises
 * by `rise`. A point on it has the distance |R| from the axis: a quadratic equation in z. */
struct rod {
    double radius, direction, rise, x, y, z;
};

static void
make_rod(const struct rc_shape *s, struct rod r, double *h)
{
    long double length = sqrtl(1 + (long double)r.rise * r.rise);
    long double ax = cosl(r.direction) / length, ay = sinl(r.direction) / length;
    long double az = r.rise / length;

    for (size_t k = 0; k < s->nx * s->ny; k++) {
        long double x = place(k % s->nx, s->nx, s->dx) - r.x, y = place(k / s->nx, s->ny, s->dy);
        long double along, a = 1 - az * az, b, c, root;
        y -= r.y;
        along = ax * x + ay * y;
        /* x^2 + y^2 + z^2 - (along + az z)^2 = R^2 */
        b = -along * az;
        c = x * x + y * y - along * along - (long double)r.radius * r.radius;
        assert_true(b * b > a * c);
        root = sqrtl(b * b - a * c);
        h[k] = (double)(r.z + (-b + (r.radius > 0 ? root : -root)) / a);
    }
}

static double
take_off(const struct rc_shape *s, struct rc_form form, double *h)
{
    struct rc_err err;
    double radius;

    if (rc_detrend_form(s, &form, h, &radius, &err) != RC_OK)
        fail_msg("%s", err.text);
    return radius;
}

/* Checks that nothing remains of a form of radius R. */
static void
check_gone(const struct rc_shape *s, struct rc_form form, double *h, double expected)
{
    size_t n = s->nx * s->ny;
    double height = span(h, n), radius = take_off(s, form, h), most = highest(h, n);

    if (!(most <= left_of_form * height))
        fail_msg("R = %g: %g is left of %g", expected, most, height);
    if (!(fabs(radius - expected) <= left_of_form * fabs(expected)))
        fail_msg("R = %.12g, not %.12g", radius, expected);
}

static void
test_spheres(void **state)
{
    const struct ball balls[] = {
        {2.385e-3, 0, 0, -2.385e-3},
        {-2.385e-3, 3e-6, -7e-6, 1e-3},
        {50e-6, 4e-6, -3e-6, 10e-6},
        {-45e-6, 0, 2e-6, 0},
        {2.385e-3, 1e-3, 0.7e-3, -2.4e-3},
        {-2.385e-3, -1.5e-3, 1.1e-3, 2e-3},
        {1, 0.1, -0.2, -0.97},
        {300e-6, 200e-6, 100e-6, 1e-3},
    };
    double *h = new_map(&shape);

    (void)state;
    srand(41);
    for (size_t k = 0; k < sizeof balls / sizeof *balls; k++) {
        make_ball(&shape, balls[k], h);
        lose(h, shape.nx * shape.ny, 4);
        check_gone(&shape, (struct rc_form){.kind = RC_SPHERE}, h, balls[k].radius);
    }
    free(h);
}

static void
test_cylinders(void **state)
{
    const double radii[] = {2.385e-3, -2.385e-3, 60e-6, -60e-6, 0.1};
    const double directions[] = {0, 0.3, 0.5 * exact_pi, 2.2, -0.8};
    const double rises[] = {0, 0.02, -0.4, 1};
    double *h = new_map(&shape);

    (void)state;
    srand(42);
    for (size_t k = 0; k < 5 * 5 * 4; k++) {
        double r = radii[k % 5];
        struct rod rod = {r, directions[k / 5 % 5], rises[k / 25], 5e-6, -9e-6, 2e-6 - r};
        if (k % 2 == 1) /* beside the axis, where it also slopes across */
            rod.y += 0.2 * r * (fabs(r) < 1e-4 ? 0.3 : 1);
        make_rod(&shape, rod, h);
        lose(h, shape.nx * shape.ny, 5);
        check_gone(&shape, (struct rc_form){.kind = RC_CYLINDER}, h, r);
    }
    free(h);
}

static void
test_profiles(void **state)
{
    const struct rc_shape row = {97, 1, 1.1e-6, 1e-6}, column = {1, 97, 1e-6, 1.1e-6};
    double h[97];

    (void)state;
    srand(43);
    for (int sign = -1; sign <= 1; sign += 2)
        for (int kind = RC_SPHERE; kind <= RC_CYLINDER; kind++) {
            const struct rc_form form = {.kind = (enum rc_form_kind)kind};
            make_ball(&row, (struct ball){sign * 80e-6, 7e-6, 0, 3e-6}, h);
            lose(h, 97, 4);
            check_gone(&row, form, h, sign * 80e-6);
            make_ball(&column, (struct ball){sign * 80e-6, 0, -7e-6, 3e-6}, h);
            check_gone(&column, form, h, sign * 80e-6);
        }
}

/* As many points as unknowns: the form passes through them. */
static void
test_just_enough_points(void **state)
{
    const size_t points[] = {0, 60, 61 * 20 + 33, 61 * 46 + 2, 61 * 30 + 58};
    double *all = new_map(&shape), *h = new_map(&shape);

    (void)state;
    make_ball(&shape, (struct ball){60e-6, 1e-6, 2e-6, 0}, all);
    for (size_t k = 0; k < shape.nx * shape.ny; k++)
        h[k] = NAN;
    for (size_t k = 0; k < 4; k++)
        h[points[k]] = all[points[k]];
    check_gone(&shape, (struct rc_form){.kind = RC_SPHERE}, h, 60e-6);
    free(all);
    free(h);
}

/* A polynomial of total degree 10 on a long map with every third point missing. */
static void
test_polynomials(void **state)
{
    const struct rc_shape s = {1000, 37, 1.1e-6, 1.7e-6};
    const size_t n = s.nx * s.ny, degrees[] = {1, 2, 5, 10, 20};
    double *h = new_map(&s);

    (void)state;
    srand(44);
    for (size_t d = 0; d < sizeof degrees / sizeof *degrees; d++) {
        for (size_t k = 0; k < n; k++)
            h[k] = 0;
        for (size_t b = 0; b <= degrees[d]; b++)
            for (size_t a = 0; a + b <= degrees[d]; a++) {
                double c = 1e-6 * chance();
                for (size_t k = 0; k < n; k++)
                    h[k] += c * pow(2 * (double)(k % s.nx) / 999 - 1, (double)a) *
                            pow(2 * (double)(k / s.nx) / 36 - 1, (double)b);
            }
        for (size_t k = 0; k < n; k++)
            h[k] = rand() % 10 < 3 ? NAN : h[k];
        for (int robust = 0; robust < 2; robust++) {
            double *copy = new_map(&s), height = span(h, n);
            memcpy(copy, h, n * sizeof *h);
            take_off(&s, (struct rc_form){.degree = degrees[d], .robust = robust}, copy);
            if (!(highest(copy, n) <= 1e-10 * height))
                fail_msg("degree %zu leaves %g of %g", degrees[d], highest(copy, n), height);
            free(copy);
        }
    }
    free(h);
}

/* ---- least squares, with noise ---- */

/* Solves 4 equations by elimination; small and exact enough for a test. */
static void
solve4(long double m[4][5])
{
    for (int c = 0; c < 4; c++) {
        int best = c;
        for (int r = c + 1; r < 4; r++)
            best = fabsl(m[r][c]) > fabsl(m[best][c]) ? r : best;
        for (int k = 0; k < 5; k++) {
            long double keep = m[c][k];
            m[c][k] = m[best][k];
            m[best][k] = keep;
        }
        for (int r = 0; r < 4; r++) {
            long double f = m[r][c] / m[c][c];
            for (int k = 0; k < 5 && r != c; k++)
                m[r][k] -= f * m[c][k];
        }
    }
    for (int c = 0; c < 4; c++)
        m[c][4] /= m[c][c];
}

/* The ball through four points of a surface: x^2 + y^2 + z^2 = 2 x X + 2 y Y + 2 z Z + const. */
static struct ball
ball_through(const double *z, const size_t points[4])
{
    long double m[4][5];

    for (int r = 0; r < 4; r++) {
        long double x = place(points[r] % shape.nx, shape.nx, shape.dx) * 1e6L;
        long double y = place(points[r] / shape.nx, shape.ny, shape.dy) * 1e6L;
        long double h = z[points[r]] * 1e6L;
        m[r][0] = x;
        m[r][1] = y;
        m[r][2] = h;
        m[r][3] = 1;
        m[r][4] = x * x + y * y + h * h;
    }
    solve4(m);
    return (struct ball){.x = (double)(m[0][4] / 2e6L),
                         .y = (double)(m[1][4] / 2e6L),
                         .z = (double)(m[2][4] / 2e6L)};
}

/* The residual is orthogonal to all small changes of the sphere: of its centre and of its radius. */
static void
test_noisy_sphere_is_least_squares(void **state)
{
    const size_t n = shape.nx * shape.ny, points[4] = {5, 61 * 12 + 55, 61 * 30 + 3, 61 * 45 + 40};
    double *h = new_map(&shape), *copy = new_map(&shape), *z = new_map(&shape), radius;
    long double sum[4] = {0}, size[4] = {0};
    struct ball b;

    (void)state;
    srand(45);
    make_ball(&shape, (struct ball){90e-6, 8e-6, -6e-6, 1e-6}, h);
    for (size_t k = 0; k < n; k++)
        h[k] += 0.5e-6 * chance();
    memcpy(copy, h, n * sizeof *h);
    radius = take_off(&shape, (struct rc_form){.kind = RC_SPHERE}, h);
    assert_true(fabs(radius - 90e-6) < 2e-6 && fabs(radius - 90e-6) > 1e-9);
    for (size_t k = 0; k < n; k++)
        z[k] = copy[k] - h[k];
    b = ball_through(z, points);
    for (size_t k = 0; k < n; k++) {
        double x = place(k % shape.nx, shape.nx, shape.dx) - b.x, up = z[k] - b.z;
        double y = place(k / shape.nx, shape.ny, shape.dy) - b.y;
        double change[4] = {x / up, y / up, 1, radius / up};
        assert_true(fabs(hypot(hypot(x, y), up) - radius) < 1e-9 * radius); /* it is a sphere */
        for (int a = 0; a < 4; a++) {
            sum[a] += h[k] * change[a];
            size[a] += fabs(h[k] * change[a]);
        }
    }
    for (int a = 0; a < 4; a++)
        if (!(fabsl(sum[a]) <= 1e-9L * size[a]))
            fail_msg("change %d: %Lg of %Lg", a, sum[a], size[a]);
    free(h);
    free(copy);
    free(z);
}

/* No similar cylinder has a smaller residual. */
static void
test_noisy_cylinder_is_least_squares(void **state)
{
    const size_t n = shape.nx * shape.ny;
    const struct rod made = {-120e-6, 0.7, 0.15, 5e-6, 7e-6, 100e-6};
    double *noise = new_map(&shape), *h = new_map(&shape), *form = new_map(&shape);
    double squares = 0, radius;

    (void)state;
    srand(46);
    make_rod(&shape, made, h);
    for (size_t k = 0; k < n; k++) {
        noise[k] = 0.2e-6 * chance();
        h[k] += noise[k];
        noise[k] = h[k];
    }
    radius = take_off(&shape, (struct rc_form){.kind = RC_CYLINDER}, h);
    assert_true(fabs(radius + 120e-6) < 2e-6);
    for (size_t k = 0; k < n; k++)
        squares += h[k] * h[k];
    for (size_t t = 0; t < 400; t++) {
        struct rod r = made;
        double other = 0, mean = 0;
        double by = pow(10, -1 - (double)(t % 4));
        r.radius = radius * (1 + 0.01 * by * chance());
        r.direction += 0.02 * by * chance();
        r.rise += 0.01 * by * chance();
        r.x += 1e-6 * by * chance();
        r.y += 1e-6 * by * chance();
        make_rod(&shape, r, form);
        for (size_t k = 0; k < n; k++)
            mean += (noise[k] - form[k]) / (double)n;
        for (size_t k = 0; k < n; k++)
            other += pow(noise[k] - form[k] - mean, 2);
        assert_true(other >= squares);
    }
    free(noise);
    free(h);
    free(form);
}

/* ---- spikes ---- */

/* Every form again, with noise and with spikes at every tenth point. The robust fit finds the form to half of
 * the noise; the other fit does not. */
static void
check_spikes(struct rc_form form, const double *made, double noise, double spike)
{
    size_t n = shape.nx * shape.ny;
    double *h = new_map(&shape), *robust = new_map(&shape), *plain = new_map(&shape);
    double worst = 0, usual = 0;

    for (size_t k = 0; k < n; k++)
        h[k] = made[k] + noise * chance() + (rand() % 10 == 0 ? spike * (1 + chance()) : 0);
    lose(h, n, 6);
    memcpy(robust, h, n * sizeof *h);
    memcpy(plain, h, n * sizeof *h);
    take_off(&shape, form, plain);
    form.robust = true;
    take_off(&shape, form, robust);
    for (size_t k = 0; k < n; k++)
        if (!isnan(h[k])) {
            worst = fmax(worst, fabs(h[k] - robust[k] - made[k]));
            usual = fmax(usual, fabs(h[k] - plain[k] - made[k]));
        }
    if (!(worst <= 0.5 * noise && usual > noise))
        fail_msg("kind %d: off by %g, without weights by %g; noise %g", (int)form.kind, worst,
                 usual, noise);
    free(h);
    free(robust);
    free(plain);
}

static void
test_spikes(void **state)
{
    double *made = new_map(&shape);
    const double spikes[] = {2e-6, 30e-6};

    (void)state;
    srand(47);
    for (size_t k = 0; k < 2; k++) {
        make_ball(&shape, (struct ball){2.385e-3, 20e-6, 10e-6, 0}, made);
        check_spikes((struct rc_form){.kind = RC_SPHERE}, made, 0.1e-6, spikes[k]);
        make_ball(&shape, (struct ball){-100e-6, -10e-6, 5e-6, 0}, made);
        check_spikes((struct rc_form){.kind = RC_SPHERE}, made, 0.1e-6, spikes[k]);
        make_rod(&shape, (struct rod){150e-6, 0.4, 0.1, 0, 0, 0}, made);
        check_spikes((struct rc_form){.kind = RC_CYLINDER}, made, 0.1e-6, spikes[k]);
        for (size_t i = 0; i < shape.nx * shape.ny; i++)
            made[i] = 3e-6 + 1e-7 * (double)(i % shape.nx) - 2e-7 * (double)(i / shape.nx);
        check_spikes((struct rc_form){.degree = 1}, made, 0.1e-6, spikes[k]);
        check_spikes((struct rc_form){.degree = 3}, made, 0.1e-6, spikes[k]);
    }
    free(made);
}

/* Spikes on a form without noise: the form is found exactly. */
static void
test_spikes_alone(void **state)
{
    double *made = new_map(&shape), *h = new_map(&shape);
    const size_t n = shape.nx * shape.ny;

    (void)state;
    srand(48);
    for (int kind = RC_POLYNOMIAL; kind <= RC_CYLINDER; kind++) {
        struct rc_form form = {.kind = (enum rc_form_kind)kind, .degree = 2, .robust = true};
        make_ball(&shape, (struct ball){0.1, 0.01, 0, 0}, made);
        if (kind != RC_SPHERE)
            for (size_t k = 0; k < n; k++)
                made[k] = 1e-8 * (double)((k % shape.nx) * (k % shape.nx));
        if (kind == RC_CYLINDER)
            make_rod(&shape, (struct rod){90e-6, 1, 0, 0, 0, 0}, made);
        for (size_t k = 0; k < n; k++)
            h[k] = made[k] + (rand() % 10 == 0 ? 1e-5 : 0);
        for (size_t k = 0; k < n; k++)
            made[k] = h[k] - made[k];
        take_off(&shape, form, h);
        for (size_t k = 0; k < n; k++)
            if (fabs(h[k] - made[k]) > 1e-9 * 1e-5)
                fail_msg("kind %d, point %zu: %g is left, not %g", kind, k, h[k], made[k]);
    }
    free(made);
    free(h);
}

/* ---- threads and unusual calls ---- */

static void
test_threads(void **state)
{
    const struct rc_shape s = {131, 257, 1e-6, 1e-6};
    const size_t n = s.nx * s.ny;
    double *h = new_map(&s), *one = new_map(&s), *many = new_map(&s);

    (void)state;
    srand(49);
    make_rod(&s, (struct rod){1e-3, 0.4, 0.1, 0, 0, 0}, h);
    for (size_t k = 0; k < n; k++)
        h[k] += 1e-7 * chance();
    lose(h, n, 7);
    for (int k = 0; k < 6; k++) {
        struct rc_form form = {.kind = (enum rc_form_kind)(k % 3), .degree = 4, .robust = k > 2};
        memcpy(one, h, n * sizeof *h);
        memcpy(many, h, n * sizeof *h);
        form.threads = 1;
        take_off(&s, form, one);
        form.threads = 3;
        take_off(&s, form, many);
        for (size_t i = 0; i < n; i++)
            assert_true(isnan(h[i]) ? isnan(many[i]) : one[i] == many[i]);
    }
    free(h);
    free(one);
    free(many);
}

static void
check_refused(struct rc_form form, double *h, const char *reason)
{
    size_t bytes = shape.nx * shape.ny * sizeof *h;
    double *before = new_map(&shape);
    struct rc_err err;

    memcpy(before, h, bytes);
    assert_int_equal(rc_detrend_form(&shape, &form, h, NULL, &err), RC_FAIL);
    if (strstr(err.text, reason) == NULL)
        fail_msg("'%s' does not say '%s'", err.text, reason);
    assert_memory_equal(h, before, bytes);
    free(before);
}

static void
test_refusals(void **state)
{
    const struct rc_form sphere = {.kind = RC_SPHERE}, cylinder = {.kind = RC_CYLINDER};
    const size_t n = shape.nx * shape.ny;
    double *h = new_map(&shape);

    (void)state;
    for (size_t k = 0; k < n; k++)
        h[k] = NAN;
    h[3] = h[70] = h[200] = 1e-6;
    check_refused(sphere, h, "a sphere has 4 unknowns, and only 3 points are there");
    check_refused(cylinder, h, "a cylinder has 5 unknowns, and only 3 points are there");
    for (size_t k = 0; k < n; k++)
        h[k] = k / shape.nx == 5 ? 1e-8 * (double)(k * k % 17) : NAN;
    check_refused(sphere, h, "do not determine a sphere"); /* one row */
    for (size_t k = 0; k < n; k++)
        h[k] = 2e-3 + 1e-7 * (double)(k % shape.nx);
    check_refused(sphere, h, "no curvature");
    check_refused(cylinder, h, "no curvature");
    for (size_t k = 0; k < n; k++)
        h[k] = 1e-3;
    check_refused(sphere, h, "no curvature");
    h[7] = INFINITY;
    check_refused(sphere, h, "1 infinite heights: no sphere fits them");
    /* a ball that is narrower than the map, on a flat: the weights exclude the flat */
    for (size_t k = 0; k < n; k++) {
        double x = place(k % shape.nx, shape.nx, shape.dx),
               y = place(k / shape.nx, shape.ny, shape.dy);
        double r2 = x * x + y * y;
        h[k] = r2 < 400e-12 ? sqrt(410e-12 - r2) : -50e-6;
    }
    for (size_t k = 0; k < n; k++)
        if (h[k] < 0 && k % 37 != 0)
            h[k] = NAN;
    check_refused((struct rc_form){.kind = RC_SPHERE, .robust = true}, h, "points lie beside");
    /* more than half of the points on a step, the others scattered: the points with weight are flat */
    srand(50);
    for (size_t k = 0; k < n; k++)
        h[k] = rand() % 3 == 0 ? 1e-5 * chance() : 1e-6;
    check_refused((struct rc_form){.kind = RC_CYLINDER, .robust = true}, h, "with weight do not");
    free(h);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_spheres),
        cmocka_unit_test(test_cylinders),
        cmocka_unit_test(test_profiles),
        cmocka_unit_test(test_just_enough_points),
        cmocka_unit_test(test_polynomials),
        cmocka_unit_test(test_noisy_sphere_is_least_squares),
        cmocka_unit_test(test_noisy_cylinder_is_least_squares),
        cmocka_unit_test(test_spikes),
        cmocka_unit_test(test_spikes_alone),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_refusals),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
