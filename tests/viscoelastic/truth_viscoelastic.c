/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compares viscoelastic contacts in time with exact answers. Under a load that only rises, contact and
 * approach are those of elastic bodies under the equivalent load, on any rough map. After a fall of the load
 * the contact is an elastic one of the rise (Ting 1966). A ball follows Ting's load and Hertz's approach, a
 * cylinder his line contact. A
 * held contact stays. Errors of steps are of second order, and below their estimate. Each point is elastic if
 * all terms are 0. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

static const double glass = 1e9; /* Pa, E* of the instant */
static const struct rc_boundary along_x = {.x = true}, along_y = {.y = true};

struct bodies {
    struct rc_relaxation *material;
    struct rc_model *m;
    size_t n;
};

/* Moduli are given over the instantaneous one. */
static struct rc_relaxation *
material_of(double relaxed, size_t terms, const double *part, const double *tau)
{
    double modulus[8] = {0};
    struct rc_err err = {""};
    struct rc_relaxation *r;

    for (size_t k = 0; k < terms; k++)
        modulus[k] = part[k] * glass;
    if ((r = rc_relaxation_new(relaxed * glass, terms, modulus, tau, &err)) == NULL)
        fail_msg("%s", err.text);
    return r;
}

static const double tau[] = {0.1, 1, 10}, part[] = {0.3, 0.25, 0.25};

static struct bodies
bodies_of(const struct rc_shape *s, const double *h, struct rc_boundary boundary, double tol,
          size_t increments, struct rc_relaxation *material)
{
    const struct rc_problem contact = {
        .boundary = boundary, .pair.estar = glass, .tol = tol, .threads = 1};
    const struct rc_viscoelastic_problem law = {
        .material = material, .share = 1, .increments = increments};
    struct rc_err err = {""};
    struct bodies b = {.material = material, .n = s->nx * s->ny};

    b.m = rc_viscoelastic_new(rc_elastic_new(s, h, &contact, NULL, &err), h, &law, &err);
    if (b.m == NULL)
        fail_msg("%s", err.text);
    return b;
}

/* Goes to a load or approach at a time and keeps it. */
static const struct rc_viscoelastic_figures *
press(struct bodies *b, enum rc_axis axis, double value, double time, double *p)
{
    struct rc_point to = {0};
    struct rc_err err = {""};

    rc_point_set(&to, axis, value);
    rc_point_set(&to, RC_TIME, time);
    if (rc_model_run(b->m, &to, &err) == RC_FAIL || rc_model_look(b->m, NULL, &err) == RC_FAIL ||
        (p != NULL && rc_model_frame(b->m, "pressure", p, &err) != RC_OK) ||
        rc_model_keep(b->m, &err) != RC_OK)
        fail_msg("%s", err.text);
    return rc_viscoelastic_result(b->m);
}

static void
leave(struct bodies *b)
{
    rc_model_free(b->m);
    rc_relaxation_free(b->material);
}

/* ---- loads that only rise, and Ting's theorem ---- */

enum {
    NX = 128,
    N = NX * NX,
    PANELS = 400
};
static double h[N], p[N], reference[N];

static struct rc_shape
make_rough(void)
{
    const size_t nx = thorough(NX, NX / 2);
    const struct rc_shape s = {nx, nx, 1e-6, 1e-6};
    const struct rc_selfaffine what = {.hurst = 0.8,
                                       .rms_slope = 0.1,
                                       .seed = 5,
                                       .long_cut = (double)nx / 2 * 1e-6,
                                       .short_cut = 8e-6};
    struct rc_err err;

    assert_int_equal(rc_synth_selfaffine(&s, &what, h, &err), RC_OK);
    return s;
}

/* The integral of f(r, t - s) over s from a to b, by Simpson's rule. */
static double
memory_of(double (*f)(const struct rc_relaxation *r, double t), const struct rc_relaxation *r,
          double t, double a, double b)
{
    double sum = 0;

    for (int k = 0; k <= 2 * PANELS; k++)
        sum += (k == 0 || k == 2 * PANELS ? 1
                : k % 2 == 1              ? 4
                                          : 2) *
               f(r, t - a - (b - a) * k / (2 * PANELS));
    return sum * (b - a) / (6 * PANELS);
}

/* The nodes whose contact differs from that of elastic bodies under this load. */
static size_t
others(struct rc_shape s, struct rc_boundary boundary, double load, const double *pressure,
       double *approach)
{
    struct rc_problem problem = {
        .boundary = boundary, .pair.estar = glass, .load = load, .tol = 1e-6, .threads = 1};
    struct solved elastic = solve(s, h, problem);
    size_t n = 0;

    assert_int_equal(elastic.status, RC_OK);
    for (size_t k = 0; k < s.nx * s.ny; k++)
        n += rc_in_contact(elastic.p[k]) != rc_in_contact(pressure[k]);
    *approach = elastic.c.approach;
    solved_free(&elastic);
    return n;
}

/* A jump, a rise and a hold. */
static void
rise(struct rc_boundary boundary)
{
    const struct rc_shape s = make_rough();
    const double load = 0.01 * glass * (double)(s.nx * s.ny) * 1e-12, hold = 30;
    struct bodies b;
    const struct rc_viscoelastic_figures *f;
    double now, approach;

    b = bodies_of(&s, h, boundary, 1e-6, 20, material_of(0.2, 3, part, tau));
    press(&b, RC_LOAD, load / 4, 0, NULL);
    press(&b, RC_LOAD, load, 1, NULL);
    f = press(&b, RC_LOAD, load, hold, p);
    now = load / 4 * rc_relaxation_compliance(b.material, hold) +
          3 * load / 4 * memory_of(rc_relaxation_compliance, b.material, hold, 0, 1);
    assert_true(fabs(f->equivalent_load / (now / b.material->instant) - 1) < 1e-9);
    assert_int_equal(others(s, boundary, f->equivalent_load, p, &approach), 0);
    assert_true(fabs(f->contact.approach / approach - 1) < 1e-3);
    assert_true(f->contact.contact_fraction > 0.1 && f->contact.converged);
    leave(&b);
}

static void
rising(void **state)
{
    (void)state;
    rise(RC_PERIODIC);
    rise(along_y);
}

/* A triangle of the load: up in 1 s, then down. */
static void
fall(struct rc_boundary boundary)
{
    const struct rc_shape s = make_rough();
    const double load = 0.02 * glass * (double)(s.nx * s.ny) * 1e-12, until = 1.5;
    const struct rc_viscoelastic_figures *f;
    struct bodies b;
    double low = 0, high = 1, now, approach;

    b = bodies_of(&s, h, boundary, 1e-6, 40, material_of(0.2, 3, part, tau));
    press(&b, RC_LOAD, 0, 0, NULL);
    press(&b, RC_LOAD, load, 1, NULL);
    f = press(&b, RC_LOAD, load * (2 - until), until, p);
    /* the integral of E(t - s) dS(s) from 0 to t1 is the load, with S' = load J(s) */
    for (int k = 0; k < 60; k++) {
        const double t1 = (low + high) / 2;
        double sum = 0;
        for (int q = 0; q <= 2 * PANELS; q++) {
            const double at = t1 * q / (2 * PANELS);
            sum += (q == 0 || q == 2 * PANELS ? 1
                    : q % 2 == 1              ? 4
                                              : 2) *
                   rc_relaxation_modulus(b.material, until - at) *
                   rc_relaxation_compliance(b.material, at);
        }
        *(sum * t1 / (6 * PANELS) < 2 - until ? &low : &high) = t1;
    }
    now = load * memory_of(rc_relaxation_compliance, b.material, low, 0, low);
    assert_int_equal(others(s, boundary, now / b.material->instant, p, &approach), 0);
    assert_true(f->contact.contact_fraction > 0.1 && f->contact.converged);
    leave(&b);
}

static void
falling(void **state)
{
    (void)state;
    fall(RC_FREE);
    fall(along_x);
}

/* ---- a ball ---- */

static const double radius = 1e-4;

static struct bodies
ball(size_t increments, size_t nx, struct rc_relaxation *material)
{
    const struct rc_shape s = {nx, nx, 1e-6, 1e-6};

    rc_synth_sphere(&s, radius, h);
    return bodies_of(&s, h, RC_FREE, 1e-5, increments, material);
}

/* The approach rises in 1 s, and falls. P = 4/3 sqrt(R) times the integral of E*(t - s) d delta^(3/2)(s) up
 * to t. While the approach falls, it goes up to t1, where the integral of E(t - s) d delta(s) from t1 to t is
 * 0 (Ting 1966, J. Appl. Mech. 33, 845). The bodies part before the approach is 0. */
static void
ting_ball(void **state)
{
    const double most = 4e-6, times[] = {0.2, 1, 1.2, 1.4, 1.9};
    const struct rc_viscoelastic_figures *f;
    struct bodies b = ball(20, thorough(64, 48), material_of(0.2, 3, part, tau));

    (void)state;
    press(&b, RC_APPROACH, 0, 0, NULL);
    for (int k = 0; k < 4; k++) {
        const double t = times[k], up = fmin(t, 1),
                     falls = memory_of(rc_relaxation_modulus, b.material, t, up, t);
        double low = 0, high = up, sum = 0;
        f = press(&b, RC_APPROACH, most * (up - (t - up)), t, NULL);
        for (int q = 0; q < 60 && t > 1; q++) {
            const double t1 = (low + high) / 2;
            *(memory_of(rc_relaxation_modulus, b.material, t, t1, 1) > falls ? &low : &high) = t1;
        }
        for (int q = 0; q <= 2 * PANELS; q++) { /* s = x^2 */
            const double x = sqrt(high) * q / (2 * PANELS);
            sum += (q == 0 || q == 2 * PANELS ? 1
                    : q % 2 == 1              ? 4
                                              : 2) *
                   rc_relaxation_modulus(b.material, t - x * x) * 3 * x * x;
        }
        sum *= sqrt(high) / (6 * PANELS) * 4 / 3 * sqrt(radius) * pow(most, 1.5);
        assert_true(fabs(f->contact.load / sum - 1) < coarse_grid);
        assert_true(fabs(sqrt(f->contact.contact_area / exact_pi / radius / most / high) - 1) <
                    2 * coarse_grid);
    }
    f = press(&b, RC_APPROACH, most / 10, times[4], p);
    assert_int_equal(f->contact.contact_nodes, 0);
    assert_true(f->contact.load == 0 && f->residual_indentation > most / 10);
    leave(&b);
}

/* a^3 = 3/4 P R J(t), and the approach is a^2/R. */
static void
creeping_ball(void **state)
{
    const double load = 0.01;
    const struct rc_viscoelastic_figures *f = NULL;
    struct bodies b = ball(20, 64, material_of(0.2, 3, part, tau));

    (void)state;
    for (double t = 0; t < 100; t = 10 * t + 0.1) {
        const double a = cbrt(load * radius * 3 / 4 * rc_relaxation_compliance(b.material, t));
        f = press(&b, RC_LOAD, load, t, NULL);
        assert_true(fabs(f->equivalent_load / load * b.material->instant /
                             rc_relaxation_compliance(b.material, t) -
                         1) < summed);
        assert_true(fabs(f->contact.approach / (a * a / radius) - 1) < coarse_grid);
    }
    leave(&b);
}

/* ---- a cylinder ---- */

/* Under a load P per length, a^2 = 4 P R J(t)/pi, and the approach is P J(t)/pi (2 ln(2 datum/a) + 1)
 * (Hertz). One row and several, along both axes. A held approach: the load falls as the modulus. */
static void
creeping_cylinder(void **state)
{
    enum {
        ACROSS = 256
    };
    const double load = 1000, datum = 3e-3, across = 1e-6, along = 1.7e-6; /* N/m; m */

    (void)state;
    for (int run = 0; run < 3; run++) {
        const size_t rows = run == 0 ? 1 : 5;
        const bool turned = run == 2;
        const struct rc_shape s = turned ? (struct rc_shape){rows, ACROSS, along, across}
                                         : (struct rc_shape){ACROSS, rows, across, along};
        struct rc_boundary boundary = turned ? along_x : along_y;
        const struct rc_viscoelastic_figures *f;
        struct bodies b;
        double held, off = 0, length = (double)rows * along;

        boundary.datum = datum;
        for (size_t k = 0; k < ACROSS * rows; k++)
            h[k] = -pow(turned ? node_y(s, k) : node_x(s, k), 2) / (2 * radius);
        b = bodies_of(&s, h, boundary, 1e-7, 20, material_of(0.2, 3, part, tau));
        for (double t = 0; t < 100; t = 10 * t + 0.1) {
            const double j = rc_relaxation_compliance(b.material, t),
                         a = sqrt(4 * load * radius * j / exact_pi);
            f = press(&b, RC_LOAD, load * length, t, NULL);
            /* counted from the highest node, half a node beside the apex */
            off = fmax(off, fabs((f->contact.approach + pow(across / 2, 2) / (2 * radius)) /
                                     (load * j / exact_pi * (2 * log(2 * datum / a) + 1)) -
                                 1));
        }
        print_message("a cylinder, %zu rows: approach within %.1e\n", rows, off);
        assert_true(off < 2e-4);
        leave(&b);
        b = bodies_of(&s, h, boundary, 1e-7, 20, material_of(0.2, 3, part, tau));
        held = press(&b, RC_APPROACH, 1e-6, 0, NULL)->contact.load;
        f = press(&b, RC_APPROACH, 1e-6, 3, NULL);
        assert_true(fabs(f->contact.load * glass / held / rc_relaxation_modulus(b.material, 3) -
                         1) < f->increment_error + 1e-6 &&
                    f->increment_error < 3e-3);
        leave(&b);
    }
}

/* The pressures of a held approach stay in proportion to each other. With a history in single precision they
 * would differ by 1e-6 and more. */
static void
keep_shape(void)
{
    const struct rc_shape s = {24, 24, 1e-6, 1e-6};
    struct bodies b;
    double start, end;

    rc_synth_sphere(&s, radius, h);
    b = bodies_of(&s, h, RC_FREE, 1e-12, 40, material_of(0.2, 3, part, tau));
    start = press(&b, RC_APPROACH, 1e-7, 0, reference)->contact.load;
    end = press(&b, RC_APPROACH, 1e-7, 3, p)->contact.load;
    for (size_t k = 0; k < b.n; k++)
        assert_true(fabs(p[k] / end - reference[k] / start) * s.dx * s.dy < 1e-9);
    leave(&b);
}

/* The contact of a held approach stays, and its pressures fall as the modulus. */
static void
held_ball(void **state)
{
    const struct rc_viscoelastic_figures *f;
    struct bodies b = ball(20, 32, material_of(0.2, 3, part, tau));
    double worst = 0, fallen;

    (void)state;
    press(&b, RC_APPROACH, 1e-6, 0, reference);
    f = press(&b, RC_APPROACH, 1e-6, 3, p);
    fallen = rc_relaxation_modulus(b.material, 3) / glass;
    for (size_t k = 0; k < b.n; k++) {
        assert_int_equal(rc_in_contact(p[k]), rc_in_contact(reference[k]));
        worst = fmax(worst, fabs(p[k] - fallen * reference[k]) / f->contact.max_pressure);
    }
    assert_true(worst < 3 * f->increment_error + 1e-4 && f->increment_error < 3e-3);
    leave(&b);
    keep_shape();
}

/* The same on a rough periodic map up to nearly complete contact, at a second and a year. The heights of each
 * step have their own approach of complete contact; a refusal names that of the bodies. */
static void
held_rough(void **state)
{
    const struct rc_shape s = {32, 32, 1e-6, 1e-6};
    const struct rc_selfaffine what = {
        .hurst = 0.8, .rms_slope = 0.1, .seed = 5, .long_cut = 32e-6, .short_cut = 8e-6};
    const double times[] = {0, 1, 3.15e7}, taus[][2] = {{1, 2}, {1e-3, 0.1}},
                 parts[][2] = {{0.3, 0.2}, {0.6, 1.0 / 3}}, depths[] = {0.3, 0.7, 0.95};
    double top = -INFINITY, said[2];
    struct rc_point to = {0};
    struct rc_err err;

    (void)state;
    assert_int_equal(rc_synth_selfaffine(&s, &what, h, &err), RC_OK);
    for (size_t k = 0; k < 1024; k++)
        top = fmax(top, h[k]); /* over the mean plane: the approach of complete contact */
    for (int q = 0; q < 12; q++) {
        const double depth = depths[q / 2 % 3] * top;
        struct rc_problem contact = {
            .boundary = RC_PERIODIC, .pair.estar = glass, .tol = 1e-8, .threads = 1};
        struct bodies b = {.material = material_of(1 - parts[q % 2][0] - parts[q % 2][1], 2,
                                                   parts[q % 2], taus[q % 2]),
                           .n = 1024};
        /* the times of the results as a caller knows them, or not */
        const struct rc_viscoelastic_problem law = {.material = b.material,
                                                    .share = 1,
                                                    .shortest = q < 6 ? 0 : times[q % 2 + 1],
                                                    .longest = q < 6 ? 0 : times[2]};
        b.m = rc_viscoelastic_new(rc_elastic_new(&s, h, &contact, NULL, &err), h, &law, &err);
        assert_non_null(b.m);
        contact.approach = depth;
        for (int k = 0; k < 3; k++) {
            const double fallen = rc_relaxation_modulus(b.material, times[k]) / glass;
            const struct rc_viscoelastic_figures *f;
            struct solved elastic;
            double worst = 0;
            if (k == 1 && q >= 6 && q % 2 == 1)
                continue; /* earlier than the shortest time */
            f = press(&b, RC_APPROACH, depth, times[k], p);
            elastic = solve(s, h, contact);
            assert_true(elastic.status == RC_OK && f->contact.converged);
            assert_true(f->contact.contact_fraction == elastic.c.contact_fraction);
            for (size_t i = 0; i < b.n; i++) {
                assert_int_equal(rc_in_contact(p[i]), rc_in_contact(elastic.p[i]));
                worst = fmax(worst, fabs(p[i] / fallen - elastic.p[i]) / elastic.c.max_pressure);
            }
            assert_true(worst < f->increment_error + 1e-6 && f->increment_error <= 0.01);
            solved_free(&elastic);
        }
        rc_point_set(&to, RC_APPROACH, 1.01 * top);
        rc_point_set(&to, RC_TIME, 2 * times[2]);
        assert_int_equal(rc_model_run(b.m, &to, &err), RC_FAIL);
        assert_int_equal(sscanf(err.text,
                                "approach %lf m: the contact of this periodic surface is complete "
                                "at %lf m",
                                &said[0], &said[1]),
                         2);
        assert_true(fabs(said[0] / top - 1.01) < 1e-8 && fabs(said[1] / top - 1) < 1e-8);
        leave(&b);
    }
}

/* Without a number of increments a load cycle takes more of them until the error is within the tolerance,
 * fewer than 160 here. */
static void
chosen_increments(void **state)
{
    const double loads[] = {0.002, 0.02, 0.004}, tols[] = {0.05, 1e-4};
    struct rc_viscoelastic_problem law = {.share = 1};
    const struct rc_problem contact = {.pair.estar = glass, .tol = 1e-6, .threads = 1};
    const struct rc_shape s = {24, 24, 1e-6, 1e-6};
    size_t steps = 31; /* one less than with 20 increments */

    (void)state;
    rc_synth_sphere(&s, radius, h);
    for (int q = 0; q < 3; q++) {
        struct bodies b = {.material = material_of(0.2, 3, part, tau), .n = 576};
        const struct rc_viscoelastic_figures *f = NULL;
        struct rc_err err;
        law.material = b.material;
        law.increments = q == 2 ? 160 : 0;
        law.tol = tols[q == 1];
        b.m = rc_viscoelastic_new(rc_elastic_new(&s, h, &contact, NULL, &err), h, &law, &err);
        assert_non_null(b.m);
        for (int k = 0; k < 3; k++) {
            f = press(&b, RC_LOAD, loads[k], k, q == 2 ? reference : p);
            assert_true(f->contact.converged);
        }
        assert_true(f->increments > steps);
        steps = f->increments;
        if (q == 1) {
            law.tol = f->increment_error;
            memcpy(h + 576, p, 576 * sizeof *p);
        }
        leave(&b);
    }
    assert_true(distance(576, h + 576, reference) < law.tol);
}

/* Bodies whose terms are 0, and the first point of others, are elastic to the last bit. */
static void
elastic(void **state)
{
    const struct rc_shape s = {32, 32, 1e-6, 1e-6};
    const struct rc_problem problem = {
        .pair.estar = glass, .load = 0.01, .tol = 1e-5, .threads = 1};
    const double nothing[] = {0, 0, 0};
    struct bodies b = ball(2, 32, material_of(1, 3, nothing, tau)),
                  other = ball(2, 32, material_of(0.2, 3, part, tau));
    struct solved is = solve(s, h, problem);

    (void)state;
    assert_true(press(&b, RC_LOAD, 0.01, 0, p)->contact.convolutions == is.c.convolutions);
    assert_memory_equal(p, is.p, b.n * sizeof *p);
    press(&other, RC_LOAD, 0.01, 0, p);
    assert_memory_equal(p, is.p, b.n * sizeof *p);
    press(&b, RC_LOAD, 0.03, 1, NULL);
    press(&b, RC_LOAD, 0.01, 2, p);
    for (size_t k = 0; k < b.n; k++)
        assert_true(fabs(p[k] - is.p[k]) < 1e-4 * is.c.max_pressure);
    solved_free(&is);
    leave(&b);
    leave(&other);
}

/* ---- steps ---- */

/* Up, down and a hold: pressures of 30 and 60 steps a leg against 240. Before a release they are 30, 60 and
 * 120, against 480. */
static void
order_on(struct rc_boundary boundary)
{
    const struct rc_shape s = {32, 32, 1e-6, 1e-6};
    const struct rc_selfaffine what = {
        .hurst = 0.8, .rms_slope = 0.1, .seed = 5, .long_cut = 32e-6, .short_cut = 16e-6};
    const double load = 0.02 * glass * 1024e-12, loads[] = {0, 1.5 * load, load, load};
    const size_t steps[] = {thorough(480, 240), 30, 60, 120}, runs = thorough(4, 3);
    static double truth[4][1024];
    double before = 0;
    struct rc_err err;

    assert_int_equal(rc_synth_selfaffine(&s, &what, h, &err), RC_OK);
    for (size_t q = 0; q < runs; q++) {
        struct bodies b =
            bodies_of(&s, h, boundary, 1e-7, steps[q], material_of(0.2, 3, part, tau));
        double sum = 0;
        for (int k = 0; k < 4; k++) {
            const struct rc_viscoelastic_figures *f =
                press(&b, RC_LOAD, loads[k], k, q == 0 ? truth[k] : p);
            const double error = k == 0 || q == 0 ? 0 : distance(b.n, p, truth[k]);
            assert_true(f->increment_error >= error);
            assert_true(error == 0 || f->increment_error < 6 * error);
            sum += error;
        }
        if (q > 1)
            assert_true(before / sum > 3.5 && before / sum < 4.5);
        before = sum;
        leave(&b);
    }
}

static void
second_order(void **state)
{
    (void)state;
    order_on(RC_PERIODIC);
    order_on(along_x);
}

/* A fluid under a load that makes the contact of a periodic map complete: the pressure becomes uniform,
 * also if the leg has a million relaxation times. */
static void
flowing(void **state)
{
    const struct rc_shape s = {16, 16, 1e-3, 1e-3};
    const double times[] = {1e-3, 1e-1}, whole[] = {1}, parts[] = {0.7, 0.3},
                 load = 1e-3 * glass * 256e-6;

    (void)state;
    for (int q = 0; q < 4; q++) {
        struct bodies b;
        for (size_t k = 0; k < 256; k++) {
            const double x = (double)(k % 16) - 7.5, y = (double)(k / 16) - 7.5;
            h[k] = -(x * x + y * y) * 2e-6;
        }
        b = bodies_of(&s, h, RC_PERIODIC, 1e-6, q < 2 ? 20 : 0,
                      q % 2 == 0 ? material_of(0, 1, whole, times)
                                 : material_of(0, 2, parts, times));
        press(&b, RC_LOAD, load, 0, p);
        assert_true(p[0] == 0);
        assert_true(press(&b, RC_LOAD, load, 1000, p)->contact.converged);
        for (size_t k = 0; k < 256; k++)
            assert_true(fabs(p[k] * 256e-6 / load - 1) < 1e-4);
        leave(&b);
    }
}

/* The errors of the contacts under a load are larger beside a load of a 400th of it. The truth has the same
 * steps and tight contacts. */
static void
after_a_fall(void **state)
{
    const struct rc_shape s = {32, 32, 1e-6, 1e-6};
    const struct rc_selfaffine what = {
        .hurst = 0.8, .rms_slope = 0.1, .seed = 7, .long_cut = 32e-6, .short_cut = 8e-6};
    const double load = 0.02 * glass * 1024e-12, loads[] = {load, load, load / 400};
    struct rc_err err;

    (void)state;
    assert_int_equal(rc_synth_selfaffine(&s, &what, h, &err), RC_OK);
    for (int on = 0; on < BOUNDARIES; on++) {
        struct bodies b = bodies_of(&s, h, each_boundary[on], 1e-3, 20,
                                    material_of(0.2, 3, part, tau)),
                      tight = bodies_of(&s, h, each_boundary[on], 1e-9, 20,
                                        material_of(0.2, 3, part, tau));
        for (int k = 0; k < 3; k++) {
            const struct rc_viscoelastic_figures *f;
            double error, told;
            press(&tight, RC_LOAD, loads[k], k, reference);
            f = press(&b, RC_LOAD, loads[k], k, p);
            error = distance(b.n, p, reference);
            told = f->contact.pressure_error - f->increment_error;
            assert_true(told >= error);
            assert_true(k < 2 ||
                        f->contact.inherited_error > 10 * (told - f->contact.inherited_error));
        }
        leave(&b);
        leave(&tight);
    }
}

/* Fast and slow terms that are left out change the answer by less than the estimate says. */
static void
window(void **state)
{
    const struct rc_shape s = {32, 32, 1e-6, 1e-6};
    const double times[] = {1e-5, 0.1, 1, 10, 1e5}, parts[] = {0.1, 0.2, 0.2, 0.2, 0.1};
    struct rc_viscoelastic_problem law = {.share = 1, .increments = 20};
    const struct rc_problem contact = {.pair.estar = glass, .tol = 1e-7, .threads = 1};
    double estimate = 0, memory[2];

    (void)state;
    rc_synth_sphere(&s, radius, h);
    for (int q = 0; q < 2; q++) {
        struct bodies b = {.material = material_of(0.2, 5, parts, times), .n = 1024};
        struct rc_point to = {0};
        struct rc_expected expected;
        struct rc_err err;
        law.material = b.material;
        law.shortest = q;
        law.longest = 2 * q;
        b.m = rc_viscoelastic_new(rc_elastic_new(&s, h, &contact, NULL, &err), h, &law, &err);
        assert_non_null(b.m);
        rc_point_set(&to, RC_LOAD, 0.01);
        rc_point_set(&to, RC_TIME, 0);
        assert_int_equal(rc_model_plan(b.m, &to, &expected, &err), RC_OK);
        memory[q] = (double)expected.memory;
        press(&b, RC_LOAD, 0.01, 0, NULL);
        press(&b, RC_LOAD, 0.02, 1, NULL);
        estimate += press(&b, RC_LOAD, 0.005, 2, q == 0 ? reference : p)->increment_error;
        leave(&b);
    }
    assert_true(distance(1024, p, reference) < estimate && estimate < 6e-3);
    assert_true(memory[1] <= memory[0]);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rising),
        cmocka_unit_test(falling),
        cmocka_unit_test(ting_ball),
        cmocka_unit_test(creeping_ball),
        cmocka_unit_test(creeping_cylinder),
        cmocka_unit_test(held_ball),
        cmocka_unit_test(held_rough),
        cmocka_unit_test(elastic),
        cmocka_unit_test(second_order),
        cmocka_unit_test(window),
        cmocka_unit_test(flowing),
        cmocka_unit_test(after_a_fall),
        cmocka_unit_test(chosen_increments),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
