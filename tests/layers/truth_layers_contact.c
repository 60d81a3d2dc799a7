/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact of coated bodies compared with solutions of the dual integral equations of layers. The cases are
 * paraboloids, flat punches and waves on hard, soft and incompressible coats, thin and thick, on elastic and
 * rigid bases. The error decreases with finer grids. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"
#include "libcontact/operator/operator.h"

/* Known figures have twelve digits. */
static const double eleven_digits = 1e-10;

static const double a = 1e-3, R = 0.1, e = 100e9, estar = 100e9 / 0.91;

/* ---- paraboloids ---- */

/* P over 4 E*_s a^3/3R, approach over a^2/R, pressure in the middle over 2 E*_s a/pi R. */
struct answer {
    double load, approach, middle;
};

struct off {
    double approach, middle;
};

/* The error of the solution, on m by m nodes over 1.2 times the contact. */
static struct off
paraboloid(const struct rc_pair *c, const struct answer *known, double modulus, size_t m)
{
    struct rc_shape shape = {m, m, 2.4 * a / (double)m, 2.4 * a / (double)m};
    double *h = malloc(m * m * sizeof *h);
    struct rc_problem problem = {.pair = *c,
                                 .load = known->load * 4 * modulus * a * a * a / (3 * R),
                                 .tol = 1e-6,
                                 .threads = 2};
    struct solved s;
    struct off off;

    assert_non_null(h);
    rc_synth_sphere(&shape, R, h);
    s = solve(shape, h, problem);
    assert_int_equal(s.status, RC_OK);
    off.approach = s.c.approach * R / (a * a) / known->approach - 1;
    off.middle = s.p[m / 2 * m + m / 2] / (known->middle * 2 * modulus * a / (exact_pi * R)) - 1;
    solved_free(&s);
    free(h);
    return off;
}

static const struct {
    double ratio, nu, a_over_t;
    struct answer known;
} paraboloids[] = {
    {0.01, 0.3, 0.1, {0.0100051849, 0.9428459697, 0.0100052003}},
    {0.01, 0.3, 0.3, {0.0101278012, 0.8402558282, 0.0101310896}},
    {0.01, 0.3, 1, {0.0125475844, 0.6523876320, 0.0130241996}},
    {0.01, 0.3, 3, {0.0251962519, 0.5586742780, 0.0303522813}},
    {0.01, 0.3, 10, {0.0703973179, 0.5464804003, 0.0904784858}},
    {0.1, 0.3, 0.1, {0.1000455271, 0.9488181926, 0.1000456616}},
    {0.1, 0.3, 0.3, {0.1011216650, 0.8569299915, 0.1011502346}},
    {0.1, 0.3, 1, {0.1219377558, 0.6934610758, 0.1259888053}},
    {0.1, 0.3, 3, {0.2172953293, 0.6463303719, 0.2551424612}},
    {0.1, 0.3, 10, {0.4352218792, 0.7216003512, 0.5210559790}},
    {0.5, 0.3, 0.1, {0.5001109667, 0.9730790761, 0.5001112820}},
    {0.5, 0.3, 0.3, {0.5027297986, 0.9247139385, 0.5027965599}},
    {0.5, 0.3, 1, {0.5499757014, 0.8474154712, 0.5587488114}},
    {0.5, 0.3, 3, {0.6981413591, 0.8646315810, 0.7519587256}},
    {0.5, 0.3, 10, {0.8519560659, 0.9260784407, 0.9001665831}},
    {2, 0.3, 0.1, {1.9993652431, 1.0471209062, 1.9993636186}},
    {2, 0.3, 0.3, {1.9844296519, 1.1319050130, 1.9840879033}},
    {2, 0.3, 1, {1.7512459409, 1.2375639795, 1.7129462976}},
    {2, 0.3, 3, {1.3345702091, 1.1474604476, 1.2070648234}},
    {2, 0.3, 10, {1.1269654875, 1.0629790878, 1.0731126026}},
    {10, 0.3, 0.1, {9.9871306258, 1.3115973418, 9.9871043947}},
    {10, 0.3, 0.3, {9.6858761821, 1.8727761246, 9.6804273879}},
    {10, 0.3, 1, {5.9423756139, 2.3028302178, 5.4728630450}},
    {10, 0.3, 3, {2.3593078042, 1.5707193312, 1.5254990460}},
    {10, 0.3, 10, {1.4063773030, 1.1968177337, 1.1974224847}},
    {100, 0.3, 0.1, {99.7398555236, 2.7902458700, 99.7394891364}},
    {100, 0.3, 0.3, {93.7118077899, 5.9786402549, 93.6373940936}},
    {100, 0.3, 1, {36.9288100408, 6.8089159161, 32.3850913045}},
    {100, 0.3, 3, {6.6351877129, 2.8938918311, 1.9589762959}},
    {100, 0.3, 10, {2.1091704519, 1.5215667468, 1.3712019265}},
    {0.1, 0.5, 0.1, {0.1214176263, 0.9341590216, 0.1214178941}},
    {0.1, 0.5, 0.3, {0.1234055338, 0.8177268500, 0.1234624093}},
    {0.1, 0.5, 1, {0.1631135652, 0.6217249297, 0.1715289960}},
    {0.1, 0.5, 3, {0.3844414601, 0.6097417757, 0.4838673685}},
    {0.1, 0.5, 10, {0.8275190444, 0.8572926078, 1.0127652440}},
    {0.01, 0.5, 0.1, {0.0121429263, 0.9266306196, 0.0121429572}},
    {0.01, 0.5, 0.3, {0.0123692921, 0.7968404425, 0.0123758692}},
    {0.01, 0.5, 1, {0.0170274426, 0.5659597143, 0.0180313528}},
    {0.01, 0.5, 3, {0.0509403353, 0.4343245167, 0.0667729369}},
    {0.01, 0.5, 10, {0.3197944010, 0.5249729101, 0.4902584269}},
};

enum {
    PARABOLOIDS = sizeof paraboloids / sizeof *paraboloids
};

static struct off
paraboloid_on_one(size_t k, size_t m)
{
    struct rc_layer layer = {a / paraboloids[k].a_over_t, paraboloids[k].ratio * e,
                             paraboloids[k].nu};
    struct rc_pair coating = {.one = {e, 0.3, 1, &layer}};

    return paraboloid(&coating, &paraboloids[k].known, estar, m);
}

/* 38 nodes in the radius are enough: all errors are below those expected for 193 nodes. */
static void
one_layer(void **state)
{
    double approach = 0, middle = 0;

    (void)state;
    for (size_t k = 0; k < PARABOLOIDS; k++) {
        struct off off = paraboloid_on_one(k, 97);
        approach = larger(approach, fabs(off.approach));
        middle = larger(middle, fabs(off.middle));
    }
    print_message("%d paraboloids: approach to %.1e, pressure in the middle to %.1e\n", PARABOLOIDS,
                  approach, middle);
    assert_true(approach < 1e-4);
    assert_true(middle < 1.5e-4);
}

static void
three_layers_and_elastic_ball(void **state)
{
    struct rc_layer three[] = {{a / 2, 4 * e, 0.2}, {a, 0.2 * e, 0.45}, {2 * a, 10 * e, 0.3}};
    struct rc_layer one = {a, 10 * e, 0.3};
    struct rc_pair stack = {.one = {e, 0.3, 3, three}};
    /* the ball: E 3, nu 0.25 of the substrate's */
    struct rc_pair ball = {.one = {e, 0.3, 1, &one}, .two = {3 * e, 0.25}};
    /* given as P R/(E_s a^3), approach R/a^2, p(0) R/(E_s a) */
    struct answer on_stack = {1.2029459505, 1.1917565732, 0.7489221098};
    struct answer with_ball = {2.8610919406 * 3 / 4, 1.4281666803, 1.3411936279 * exact_pi / 2};
    struct off off;

    (void)state;
    off = paraboloid(&stack, &on_stack, estar, 193);
    print_message("three layers: approach %.1e, middle %.1e off\n", off.approach, off.middle);
    assert_true(fabs(off.approach) < 1e-4 && fabs(off.middle) < 4e-4);
    off = paraboloid(&ball, &with_ball, e, 193);
    print_message("elastic ball: approach %.1e, middle %.1e off\n", off.approach, off.middle);
    assert_true(fabs(off.approach) < 1e-4 && fabs(off.middle) < 4e-4);
}

/* The error of a pressure that is constant in cells is of second order. On one grid it depends on the
 * position of the contact edge between the nodes, so the sum over four bodies is compared. */
static void
second_order(void **state)
{
    static const size_t nodes[] = {49, 97, 193}, body[] = {2, 13, 22, 38};
    enum {
        BODIES = sizeof body / sizeof *body
    };
    double rms[3][2] = {{0}};

    (void)state;
    for (size_t g = 0; g < 3; g++) {
        for (size_t k = 0; k < BODIES; k++) {
            struct off off = paraboloid_on_one(body[k], nodes[g]);
            rms[g][0] += off.approach * off.approach / BODIES;
            rms[g][1] += off.middle * off.middle / BODIES;
        }
        for (int i = 0; i < 2; i++)
            rms[g][i] = sqrt(rms[g][i]);
        print_message("%zu nodes: approach to %.2e, middle to %.2e\n", nodes[g], rms[g][0],
                      rms[g][1]);
    }
    for (int i = 0; i < 2; i++) {
        double order = log(rms[0][i] / rms[2][i]) / log(193.0 / 49);
        print_message("order %.2f\n", order);
        assert_true(order > 1.7);
        assert_true(rms[1][i] < rms[0][i] && rms[2][i] < rms[1][i]);
    }
}

/* ---- flat punches ---- */

/* A punch on m by m nodes over 1.1 times its radius a along each side. */
struct disc {
    struct rc_shape shape;
    double *h;     /* the values are 0 under the punch, and far below elsewhere */
    size_t under;  /* nodes                           */
    double radius; /* radius of the circle with the area of these nodes */
};

static struct disc
disc_new(size_t m)
{
    struct disc d = {.shape = {m, m, 2.2 * a / (double)m, 2.2 * a / (double)m},
                     .h = malloc(m * m * sizeof *d.h)};

    assert_non_null(d.h);
    for (size_t k = 0; k < m * m; k++) {
        d.h[k] = node_r(d.shape, k) <= a ? 0 : -a;
        d.under += d.h[k] == 0;
    }
    d.radius = sqrt((double)d.under * d.shape.dx * d.shape.dy / exact_pi);
    return d;
}

/* The load over 2 `over` a times the approach. */
static double
punch(const struct rc_pair *c, double over, size_t m)
{
    struct disc d = disc_new(m);
    double load = 0.01 * over * 2 * a * a;
    struct rc_problem problem = {.pair = *c, .load = load, .tol = 1e-7, .threads = 2};
    struct solved s = solve(d.shape, d.h, problem);

    assert_int_equal(s.status, RC_OK);
    assert_int_equal(s.c.contact_nodes, d.under);
    load /= 2 * over * d.radius * s.c.approach;
    solved_free(&s);
    free(d.h);
    return load;
}

/* The same for a bonded punch: under it the displacement is 1 m, and pressures may have any sign. The method
 * is plain conjugate gradients. */
static double
glued_punch(const struct rc_pair *c, double over, size_t m)
{
    struct disc d = disc_new(m);
    size_t n = m * m;
    double *p = calloc(n, sizeof *p), *r = calloc(n, sizeof *r), *t = calloc(n, sizeof *t),
           *u = malloc(n * sizeof *u), rr = (double)d.under, load;
    struct rc_conv_options options = {.threads = 2, .precise = true};
    struct rc_err err;
    struct rc_conv *conv = rc_conv_new(&d.shape, c, &options, &err);

    assert_non_null(conv);
    for (size_t k = 0; k < n; k++)
        r[k] = t[k] = d.h[k] == 0;
    for (int step = 0; step < 400 && rr > 1e-16 * (double)d.under; step++) {
        double tu = 0, next = 0, by;
        rc_conv_apply(conv, t, u);
        for (size_t k = 0; k < n; k++)
            tu += t[k] * u[k];
        by = rr / tu;
        for (size_t k = 0; k < n; k++)
            if (d.h[k] == 0) {
                p[k] += by * t[k];
                r[k] -= by * u[k];
                next += r[k] * r[k];
            }
        for (size_t k = 0; k < n; k++)
            t[k] = d.h[k] == 0 ? r[k] + next / rr * t[k] : 0;
        rr = next;
    }
    assert_true(rr <= 1e-16 * (double)d.under);
    load = rc_sum(p, n) * d.shape.dx * d.shape.dy / (2 * over * d.radius);
    rc_conv_free(conv);
    free(d.h);
    free(p);
    free(r);
    free(t);
    free(u);
    return load;
}

/* The pressure is singular at the edge, so the error is of first order, at most half a node in the radius.
 * Extrapolation from two grids leaves a fourth of it. Under stiff coats the middle of the punch separates,
 * which the integral equations do not include: there the punch is bonded. */
static const double half_a_node = 0.5 * 2.2;

/* Adds their absolute values to sum. */
static void
check_punch(double coarse, double fine, double sum[2])
{
    print_message("%.1e, %.1e; together %.1e\n", coarse, fine, 2 * fine - coarse);
    assert_true(fabs(coarse) < half_a_node / 101);
    assert_true(fabs(fine) < half_a_node / 201);
    assert_true(fabs(2 * fine - coarse) < 0.25 * half_a_node / 101);
    sum[0] += fabs(coarse);
    sum[1] += fabs(fine);
}

static void
punches(void **state)
{
    static const double ratio[] = {0.01, 0.1, 0.5, 2, 10, 100};
    static const double known[] = {0.0244307141, 0.2135175689, 0.6992677256,
                                   1.3137664657, 2.0879867398, 3.9093722437};
    double sum[2] = {0, 0};

    (void)state;
    for (size_t k = 0; k < sizeof ratio / sizeof *ratio; k++) {
        struct rc_layer layer = {a, ratio[k] * e, 0.3};
        struct rc_pair coating = {.one = {e, 0.3, 1, &layer}};
        double (*press)(const struct rc_pair *, double, size_t) =
            ratio[k] < 10 ? punch : glued_punch;
        double coarse = press(&coating, estar, 101), fine = press(&coating, estar, 201);
        print_message("E1/Es %g: off by ", ratio[k]);
        check_punch(coarse / known[k] - 1, fine / known[k] - 1, sum);
        if (ratio[k] == 2)
            assert_true(fabs(glued_punch(&coating, estar, 101) / coarse - 1) < six_digits);
    }
    assert_true(sum[1] < 0.6 * sum[0]);
}

/* Hayes, Keer, Herrmann and Mockros 1972 give P (1 - nu)/(4 G a approach) on a layer on a rigid base. Here it
 * has more digits than in the paper. */
static void
punches_on_rigid_base(void **state)
{
    static const struct {
        double nu, a_over_t, kappa;
    } known[] = {
        {0.3, 0.2, 1.206558}, {0.3, 1, 2.483525}, {0.5, 0.2, 1.280637}, {0.5, 1, 3.618736}};
    double sum[2] = {0, 0};

    (void)state;
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        double nu = known[k].nu, over = e / (1 - nu * nu); /* 2 G/(1 - nu) */
        struct rc_layer layer = {a / known[k].a_over_t, e, nu};
        struct rc_pair coating = {.one = {INFINITY, 0.3, 1, &layer}};
        double coarse = punch(&coating, over, 101), fine = punch(&coating, over, 201);
        print_message("nu %g, a/t %g: off by ", nu, known[k].a_over_t);
        check_punch(coarse / known[k].kappa - 1, fine / known[k].kappa - 1, sum);
    }
    assert_true(sum[1] < 0.6 * sum[0]);
}

/* ---- limits ---- */

/* A thin compressible layer on a rigid base is an elastic foundation, p = M u/t; an incompressible one must
 * flow sideways. P over pi M a^4/4Rt or pi G a^6/32Rt^3 tends to 1 as t goes to 0. So does the approach over
 * a^2/2R or a^2/4R. `off`: the grid is coarse where t is 2.4 cells and the layer is incompressible. */
static void
thin_on_rigid(void **state)
{
    static const struct {
        double nu, t_over_a, load, approach, off;
    } known[] = {{0.3, 0.1, 1.050126, 1.025873, 1e-4},
                 {0.3, 0.03, 1.014740, 1.007463, 1e-4},
                 {0.5, 0.1, 2.233304, 1.249041, 1e-4},
                 {0.5, 0.03, 1.292456, 1.083217, 1e-3}};

    (void)state;
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        double nu = known[k].nu, t = known[k].t_over_a * a, g = e / (2 * (1 + nu));
        double springs = exact_pi * 2 * g * (1 - nu) / (1 - 2 * nu) * pow(a, 4) / (4 * R * t);
        double squeezed = exact_pi * g * pow(a, 6) / (32 * R * pow(t, 3));
        struct rc_layer layer = {t, e, nu};
        struct rc_pair coating = {.one = {INFINITY, 0.3, 1, &layer}};
        struct answer answer = {.middle = 1};
        struct off coarse, fine;
        answer.load = known[k].load * (nu < 0.5 ? springs : squeezed);
        answer.load /= 4 * estar * a * a * a / (3 * R);
        answer.approach = known[k].approach / (nu < 0.5 ? 2 : 4);
        coarse = paraboloid(&coating, &answer, estar, 97);
        fine = paraboloid(&coating, &answer, estar, 193);
        print_message("nu %g, t/a %g: approach %.1e, %.1e off\n", nu, known[k].t_over_a,
                      coarse.approach, fine.approach);
        assert_true(fabs(fine.approach) < known[k].off);
        assert_true(fabs(fine.approach) < 0.5 * fabs(coarse.approach));
    }
}

/* Pressure and approach of a ball on a coat of this thickness, compared with one material on the same
 * grid. */
static struct off
beside_one(const struct solved *bare, struct rc_problem problem, const double *h,
           struct rc_shape shape, double thickness, double ratio)
{
    struct rc_layer layer = {thickness, ratio * e, 0.3};
    struct rc_pair coating = {.one = {e, 0.3, 1, &layer}};
    struct solved s;
    struct off off;

    problem.pair = coating;
    s = solve(shape, h, problem);
    assert_int_equal(s.status, RC_OK);
    off.middle = distance(shape.nx * shape.ny, s.p, bare->p);
    off.approach = fabs(s.c.approach / bare->c.approach - 1);
    print_message("E1/Es %g, t/a %g: pressure %.1e, approach %.1e from one material\n", ratio,
                  thickness / a, off.middle, off.approach);
    solved_free(&s);
    return off;
}

/* The effect of a thin coat is proportional to its thickness. The effect of the substrate below a thick coat
 * is proportional to a/t, because the whole coat sinks. The change of the shape is proportional to the third
 * power. */
static void
thick_and_thin(void **state)
{
    enum {
        N = 65
    };
    static const double ratio[] = {0.1, 10}, tenth[] = {0.08, 0.13};
    struct rc_shape shape = {N, N, 2.4 * a / N, 2.4 * a / N};
    double *h = malloc(N * N * sizeof *h);

    (void)state;
    assert_non_null(h);
    rc_synth_sphere(&shape, R, h);
    for (int thick = 0; thick < 2; thick++)
        for (int k = 0; k < 2; k++) {
            double one = thick ? ratio[k] * estar : estar, t = thick ? 100 * a : 1e-4 * a;
            struct rc_problem problem = {.pair.estar = one,
                                         .load = 4 * one * a * a * a / (3 * R),
                                         .tol = 1e-10,
                                         .threads = 2};
            struct solved bare = solve(shape, h, problem);
            struct off first = beside_one(&bare, problem, h, shape, t, ratio[k]);
            struct off next =
                beside_one(&bare, problem, h, shape, thick ? 10 * t : t / 10, ratio[k]);
            double p = next.middle / first.middle, z = next.approach / first.approach;
            assert_true(z > tenth[0] && z < tenth[1]);
            assert_true(p > (thick ? 5e-4 : tenth[0]) && p < (thick ? 2e-3 : tenth[1]));
            solved_free(&bare);
        }
    free(h);
}

/* ---- complete contact ---- */

/* A flattened wave: the amplitude of pressure over that of height is q/(2 g(q)), g by Airy's
 * functions with 50 digits, E_s = 1. */
static void
waves_pressed_flat(void **state)
{
    enum {
        N = 32
    };
    const struct {
        struct rc_layer layer[3];
        size_t n;
        double nu, q[6], g[6];
    } body[] = {{{{1, 10, 0.3}}, 1, 0.3, {exact_pi / 4}, {exact_pi / 7.07117620919}},
                {{{1, 0.05, 0.5}},
                 1,
                 0.2,
                 {0.01, 0.1, 0.5, 1, 2, 5},
                 {0.952643472293, 0.89789072314, 1.54944475075, 4.16149272505, 9.95167180567,
                  14.9236926588}},
                {{{0.25, 4, 0.2}, {0.5, 0.2, 0.45}, {1, 10, 0.3}},
                 3,
                 0.3,
                 {0.01, 0.1, 0.5, 1, 2, 5},
                 {0.89602326143, 0.855414012131, 0.730621324924, 0.694806936189, 1.17717611955,
                  0.782928607402}}};
    double h[N * N], worst = 0;

    (void)state;
    for (size_t b = 0; b < 3; b++)
        for (size_t k = 0; k < 6 && body[b].q[k] > 0; k++)
            for (int turned = 0; turned < 2; turned++) {
                double wave = 2 * exact_pi / body[b].q[k], amplitude = 1e-6 * wave;
                double stiff = body[b].q[k] / (2 * body[b].g[k]);
                struct rc_shape shape = {N, N, wave / N, wave / N};
                struct rc_pair coating = {.one = {1, body[b].nu, body[b].n, body[b].layer}};
                struct rc_problem problem = {.boundary = RC_PERIODIC,
                                             .pair = coating,
                                             .load = 2 * stiff * amplitude * wave * wave,
                                             .tol = 1e-12};
                struct solved s;
                rc_synth_wave(&shape, amplitude, turned ? INFINITY : wave, turned ? wave : INFINITY,
                              h);
                s = solve(shape, h, problem);
                assert_int_equal(s.status, RC_OK);
                assert_int_equal(s.c.contact_nodes, N * N);
                for (size_t i = 0; i < N * N; i++)
                    worst =
                        larger(worst, fabs(s.p[i] / (stiff * amplitude) - 2 - h[i] / amplitude));
                solved_free(&s);
            }
    print_message("pressures off by %.1e of their amplitude\n", worst);
    assert_true(worst < eleven_digits);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_layer),
        cmocka_unit_test(three_layers_and_elastic_ball),
        cmocka_unit_test(second_order),
        cmocka_unit_test(punches),
        cmocka_unit_test(punches_on_rigid_base),
        cmocka_unit_test(thin_on_rigid),
        cmocka_unit_test(thick_and_thin),
        cmocka_unit_test(waves_pressed_flat),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
