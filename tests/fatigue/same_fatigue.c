/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two ways to the same fatigue: positions of the contact and a pass, few and many rows at a time, one
 * and two threads, other loads on a plan and a new plan. A constant stress in a layer changes no
 * amplitude. The sampling error covers the error of the spacing, also below an index of 0. What cannot
 * be computed is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

enum {
    NX = 23,
    NY = 18,
    N = NX * NY
};
static const struct rc_shape shape = {NX, NY, 1.1e-6, 1e-6};
static const struct rc_fatigue_limits limits = {600e6, 372e6, 800e6};
static const unsigned four =
    1U << RC_CROSSLAND | 1U << RC_DANG_VAN | 1U << RC_FINDLEY | 1U << RC_AMPLITUDE;
static const double depth = 1.7e-6;
static double p[N], other[N];

static double
noise(size_t k)
{
    return (double)((k * 2654435761U + 12345) % 1000003) / 1000003;
}

static void
make_pressures(void)
{
    for (size_t k = 0; k < N; k++) {
        p[k] = noise(k) < 0.3 ? 1e9 * noise(k + N) : 0;
        other[k] = 3e8 * noise(k + 2 * N);
    }
}

static struct rc_fatigue *
plan(const struct rc_shape *s, const struct rc_fatigue_problem *problem)
{
    struct rc_err err = {""};
    struct rc_fatigue *f = rc_fatigue_new(s, problem, &err);

    if (f == NULL)
        fail_msg("%s", err.text);
    return f;
}

/* Values of one depth: out[c] for the wanted criteria, freed by the caller with one free of out[0]. */
static struct rc_fatigue_figures
run(const struct rc_shape *s, const struct rc_fatigue_problem *problem, double z,
    double *out[RC_FATIGUES])
{
    const struct rc_shape r = rc_fatigue_shape(s, problem);
    double *v = calloc(RC_FATIGUES * r.nx * r.ny, sizeof *v);
    struct rc_fatigue *f = plan(s, problem);
    struct rc_fatigue_figures figures;
    struct rc_err err = {""};

    for (size_t c = 0; c < RC_FATIGUES; c++)
        out[c] = v + c * r.nx * r.ny;
    if (rc_fatigue_depth(f, z, &limits, NULL, out, &err) != RC_OK)
        fail_msg("%s", err.text);
    figures = *rc_fatigue_result(f);
    rc_fatigue_free(f);
    return figures;
}

static void
close_to(double a, double b, double tol)
{
    if (!(fabs(a - b) <= tol * fabs(b)))
        fail_msg("%.12g instead of %.12g", a, b);
}

/* The contact goes over the body by one node a case: the node over which the whole map goes sees each stress
 * of its row once, and those of a pass. */
static void
positions(void **state)
{
    size_t column[NX];
    const double *maps[NX], *tractions[NX], *const one[] = {p}, *const shear[] = {other};
    double *pass[RC_FATIGUES], *cases[RC_FATIGUES];
    struct rc_fatigue_problem problem = {.stress = {.body.nu = 0.3, .threads = 1},
                                         .wanted = four,
                                         .pass = 'x',
                                         .cases = 1,
                                         .p = one,
                                         .traction = {NULL, shear}};
    (void)state;

    for (size_t t = 0; t < NX; t++) {
        column[t] = NX - 1 - t;
        maps[t] = p;
        tractions[t] = other;
    }
    for (int boundary = 0; boundary < BOUNDARIES; boundary++) {
        const bool wraps = each_boundary[boundary].x;
        struct rc_fatigue_problem many_cases = problem;
        struct rc_fatigue_figures few, many;
        struct rc_shape r;
        problem.stress.boundary = many_cases.stress.boundary = each_boundary[boundary];
        few = run(&shape, &problem, depth, pass);
        many_cases.pass = 0;
        many_cases.cases = NX;
        many_cases.p = maps;
        many_cases.traction[1] = tractions;
        many_cases.column = column;
        r = rc_fatigue_shape(&shape, &many_cases);
        assert_int_equal(r.nx, wraps ? NX : 2 * NX - 1);
        many = run(&shape, &many_cases, depth, cases);
        for (size_t c = 0; c < RC_FATIGUES; c++)
            for (size_t j = 0; four >> c & 1 && j < NY; j++) /* hydrostatic pressure cancels */
                close_to(cases[c][j * r.nx + NX - 1], pass[c][j], wraps ? 1e-5 : 1e-6);
        assert_int_equal(few.states, wraps ? NX : NX + 1);
        assert_int_equal(many.states, few.states);
        for (size_t c = 0; c <= RC_CRITERIA; c++) /* other nodes see fewer stresses of the row */
            if (four >> c & 1)
                assert_true(many.largest[c].value >= few.largest[c].value * (1 - 1e-6));
        free(pass[0]);
        free(cases[0]);
    }
}

/* Little memory: the rows come in bands, with the same results and the same estimates. */
static void
bands(void **state)
{
    size_t column[] = {0, 2, 3, 7};
    const double *maps[] = {p, other, p, other};
    double *whole[RC_FATIGUES], *parts[RC_FATIGUES];
    struct rc_fatigue_problem problem = {.stress = {.body.nu = 0.3, .threads = 1},
                                         .wanted = four,
                                         .cases = 4,
                                         .p = maps,
                                         .column = column};
    const struct rc_shape r = rc_fatigue_shape(&shape, &problem);
    struct rc_fatigue_figures a, b;
    size_t memory = rc_fatigue_memory(&shape, &problem);
    (void)state;

    a = run(&shape, &problem, depth, whole);
    problem.room = (5 + 2 * 3) * 4 * 6 * NX * sizeof(float) + 7; /* three rows beside a band */
    assert_true(rc_fatigue_memory(&shape, &problem) < memory);
    b = run(&shape, &problem, depth, parts);
    assert_int_equal(a.bands, 1);
    assert_int_equal(b.bands, 4);
    for (size_t c = 0; c < RC_FATIGUES; c++)
        if (four >> c & 1)
            assert_memory_equal(whole[c], parts[c], r.nx * r.ny * sizeof(double));
    b.bands = 1;
    assert_memory_equal(&a, &b, sizeof a);
    free(whole[0]);
    free(parts[0]);
}

/* Where the map repeats along x columns wrap around, and no state is unloaded. */
static void
wrapped_columns(void **state)
{
    size_t column[] = {0, 5}, wrapped[] = {NX, 5 + 3 * NX};
    const double *maps[] = {p, p};
    double *a[RC_FATIGUES], *b[RC_FATIGUES];
    struct rc_fatigue_problem problem = {
        .stress = {.boundary = RC_PERIODIC, .body.nu = 0.3, .threads = 1},
        .wanted = four,
        .cases = 2,
        .p = maps,
        .column = column};
    (void)state;

    for (int free_y = 0; free_y < 2; free_y++) {
        problem.stress.boundary.y = !free_y;
        problem.column = column;
        assert_int_equal(run(&shape, &problem, depth, a).states, 2);
        assert_int_equal(rc_fatigue_shape(&shape, &problem).nx, NX);
        problem.column = wrapped;
        run(&shape, &problem, depth, b);
        for (size_t c = 0; c < RC_FATIGUES; c++)
            if (four >> c & 1)
                assert_memory_equal(a[c], b[c], N * sizeof(double));
        free(a[0]);
        free(b[0]);
    }
}

/* The loads of a contact that stays begin and end with the unloaded state, unless the map repeats along both
 * axes; so a map that is turned has the turned result. */
static void
contact_that_stays(void **state)
{
    static double turned[2][N];
    const struct rc_shape across = {NY, NX, shape.dy, shape.dx};
    const double *maps[] = {p, other}, *turned_maps[] = {turned[0], turned[1]};
    (void)state;

    for (size_t k = 0; k < N; k++) {
        turned[0][k % NX * NY + k / NX] = p[k];
        turned[1][k % NX * NY + k / NX] = other[k];
    }
    for (int boundary = 0; boundary < BOUNDARIES; boundary++) {
        double *a[RC_FATIGUES], *b[RC_FATIGUES];
        struct rc_fatigue_problem problem = {
            .stress = {.boundary = each_boundary[boundary], .body.nu = 0.3, .threads = 1},
            .wanted = four & ~(1U << RC_FINDLEY),
            .cases = 2,
            .p = maps};
        assert_int_equal(run(&shape, &problem, depth, a).states, boundary == 1 ? 2 : 3);
        problem.p = turned_maps;
        problem.stress.boundary =
            rc_boundary_of(each_boundary[boundary].y, each_boundary[boundary].x);
        run(&across, &problem, depth, b);
        for (size_t c = 0; c <= RC_CRITERIA; c++)
            for (size_t k = 0; problem.wanted >> c & 1 && k < N; k++)
                close_to(b[c][k % NX * NY + k / NX], a[c][k], 1e-5);
        free(a[0]);
        free(b[0]);
    }
}

/* The travel in the other direction, and along y over the turned map. */
static void
directions(void **state)
{
    static double mirrored[N], turned[N];
    const struct rc_shape across = {NY, NX, shape.dy, shape.dx};
    const double *maps[] = {p};
    double *a[RC_FATIGUES], *b[RC_FATIGUES];
    struct rc_fatigue_problem problem = {.stress = {.body.nu = 0.3, .threads = 1},
                                         .wanted = four | 1U << RC_SHAKEDOWN,
                                         .pass = 'x',
                                         .cases = 1,
                                         .p = maps};
    (void)state;

    for (size_t j = 0; j < NY; j++)
        for (size_t i = 0; i < NX; i++) {
            mirrored[j * NX + NX - 1 - i] = p[j * NX + i];
            turned[i * NY + j] = p[j * NX + i];
        }
    for (int boundary = 0; boundary < BOUNDARIES; boundary++) {
        problem.stress.boundary = each_boundary[boundary];
        problem.pass = 'x';
        maps[0] = p;
        run(&shape, &problem, depth, a);
        maps[0] = mirrored;
        run(&shape, &problem, depth, b);
        for (size_t c = 0; c <= RC_CRITERIA; c++)
            for (size_t j = 0; problem.wanted >> c & 1 && j < NY; j++)
                close_to(b[c][j], a[c][j], 1e-6);
        free(b[0]);
        maps[0] = turned;
        problem.pass = 'y';
        problem.stress.boundary =
            rc_boundary_of(each_boundary[boundary].y, each_boundary[boundary].x);
        run(&across, &problem, depth, b);
        for (size_t c = 0; c <= RC_CRITERIA; c++)
            for (size_t j = 0; problem.wanted >> c & 1 && j < NY; j++)
                close_to(b[c][j], a[c][j], c == RC_FINDLEY ? 1e-4 : 1e-9);
        free(a[0]);
        free(b[0]);
    }
}

static void
threads(void **state)
{
    enum {
        SIDE = 130
    };
    static double big[SIDE * SIDE];
    const struct rc_shape s = {SIDE, SIDE, 1e-6, 1e-6};
    const double *maps[] = {big, p};
    double *a[RC_FATIGUES], *b[RC_FATIGUES];
    struct rc_fatigue_problem problem = {.stress = {.body.nu = 0.3, .threads = 1},
                                         .wanted = four,
                                         .pass = 'x',
                                         .cases = 1,
                                         .p = maps};
    struct rc_fatigue_figures one, two;
    (void)state;

    for (size_t k = 0; k < SIDE * SIDE; k++)
        big[k] = noise(k) < 0.2 ? 1e9 * noise(k + 7) : 0;
    one = run(&s, &problem, 3e-6, a);
    problem.stress.threads = 2;
    two = run(&s, &problem, 3e-6, b);
    for (size_t c = 0; c < RC_FATIGUES; c++)
        if (four >> c & 1)
            assert_memory_equal(a[c], b[c], SIDE * sizeof(double));
    assert_memory_equal(&one, &two, sizeof one);
    free(a[0]);
    free(b[0]);
}

/* Other loads on a plan give the slices of a new plan, at the same depth and at the next. */
static void
other_loads(void **state)
{
    static double out[2][RC_COMPONENTS][N];
    const double *const none[2] = {NULL, NULL}, *const shear[2] = {other, NULL};
    (void)state;

    for (int kind = 0; kind < 7; kind++) {
        struct rc_stress_options o = {.boundary = each_boundary[kind == 1  ? 1
                                                                : kind > 4 ? kind - 3
                                                                           : 0],
                                      .body.nu = 0.3,
                                      .wanted = (1U << RC_COMPONENTS) - 1,
                                      .mu = kind == 2 ? 0.1 : 0,
                                      .tol = kind >= 4 ? 1e-2 : 0,
                                      .threads = 1,
                                      .traction = {kind == 3 ? p : NULL, NULL}};
        const double z[] = {depth, 12e-6};
        double *s[2][RC_STRESSES];
        struct rc_err err = {""};
        struct rc_stress *first = rc_stress_new(&shape, p, &o, &err), *second;
        for (int k = 0; k < 2; k++)
            for (int c = 0; c < RC_COMPONENTS; c++)
                s[k][c] = out[k][c];
        assert_int_equal(rc_stress_slice(first, z[1], s[0], &err), RC_OK);
        assert_int_equal(rc_stress_slice(first, z[0], s[0], &err), RC_OK);
        assert_int_equal(rc_stress_set_loads(first, other, kind == 3 ? shear : none, &err), RC_OK);
        o.traction[0] = kind == 3 ? other : NULL;
        second = rc_stress_new(&shape, other, &o, &err);
        for (int k = 0; k < 2; k++) {
            assert_int_equal(rc_stress_slice(first, z[k], s[0], &err), RC_OK);
            assert_int_equal(rc_stress_slice(second, z[k], s[1], &err), RC_OK);
            assert_memory_equal(out[0], out[1], sizeof out[0]);
        }
        rc_stress_free(first);
        rc_stress_free(second);
    }
    { /* not implemented */
        const struct rc_stress_options o = {
            .body.nu = 0.3, .wanted = 1, .engine = "direct", .threads = 1};
        struct rc_err err = {""};
        struct rc_stress *direct = rc_stress_new(&shape, p, &o, &err);
        assert_int_equal(rc_stress_set_loads(direct, other, none, &err), RC_FAIL);
        assert_non_null(strstr(err.text, "transforms"));
        rc_stress_free(direct);
    }
}

/* A stress that a layer has without load is in all states, the unloaded one too. */
static void
layers(void **state)
{
    const struct rc_layer layer = {3e-6, 300e9, 0.25};
    const double residual[] = {-2e9}, *maps[] = {p};
    double *a[RC_FATIGUES], *b[RC_FATIGUES];
    struct rc_fatigue_problem problem = {.stress = {.body = {200e9, 0.3, 1, &layer}, .threads = 1},
                                         .wanted = 1U << RC_AMPLITUDE | 1U << RC_CROSSLAND,
                                         .pass = 'x',
                                         .cases = 1,
                                         .p = maps};
    (void)state;

    run(&shape, &problem, depth, a);
    problem.stress.residual = residual;
    run(&shape, &problem, depth, b);
    for (size_t j = 0; j < NY; j++) {
        const double k = 3 * 0.62 - sqrt(3);
        close_to(b[RC_AMPLITUDE][j], a[RC_AMPLITUDE][j], 1e-9);
        close_to(b[RC_CROSSLAND][j], a[RC_CROSSLAND][j] - k * 4e9 / 3 / limits.torsion, 1e-9);
    }
    free(a[0]);
    free(b[0]);
}

/* A stress of the user that depends on the row. */
static void
residual_rows(void **state)
{
    double row[NY], *out[RC_FATIGUES] = {NULL}, v[2][NY];
    const double *maps[] = {p}, *const residual[RC_COMPONENTS] = {[RC_SYY] = row};
    const struct rc_fatigue_problem problem = {.stress = {.body.nu = 0.3, .threads = 1},
                                               .wanted = 1U << RC_CROSSLAND,
                                               .pass = 'x',
                                               .cases = 1,
                                               .p = maps};
    struct rc_fatigue *f = plan(&shape, &problem);
    struct rc_err err = {""};
    (void)state;

    for (size_t j = 0; j < NY; j++)
        row[j] = 1e7 * (double)j;
    for (int k = 0; k < 2; k++) {
        out[RC_CROSSLAND] = v[k];
        assert_int_equal(rc_fatigue_depth(f, depth, &limits, k ? residual : NULL, out, &err),
                         RC_OK);
    }
    for (size_t j = 0; j < NY; j++)
        close_to(v[1][j], v[0][j] + (3 * 0.62 - sqrt(3)) * row[j] / 3 / limits.torsion, 1e-9);
    rc_fatigue_free(f);
}

/* The same pressure in cells that are divided has more states, which are exact; without half of its states
 * the coarser history is as wrong as its sampling error says. */
static void
sampling(void **state)
{
    enum {
        SIDE = 48,
        PARTS = 4
    };
    static double coarse[SIDE * SIDE], fine[SIDE * SIDE * PARTS * PARTS];
    const struct rc_shape s = {SIDE, SIDE, 1e-6, 1e-6};
    const struct rc_shape divided = {SIDE * PARTS, SIDE * PARTS, 1e-6 / PARTS, 1e-6 / PARTS};
    const double *maps[] = {coarse}, *divided_maps[] = {fine};
    struct rc_fatigue_problem problem = {.stress = {.body.nu = 0.3, .threads = 1},
                                         .wanted = four & ~(1U << RC_FINDLEY),
                                         .pass = 'x',
                                         .cases = 1,
                                         .p = maps};
    (void)state;

    for (size_t k = 0; k < SIDE * SIDE; k++)
        coarse[k] = noise(k + 99) < 0.25 ? 1e9 * noise(k + 5) : 0;
    for (size_t j = 0; j < SIDE * PARTS; j++)
        for (size_t i = 0; i < SIDE * PARTS; i++)
            fine[j * SIDE * PARTS + i] = coarse[j / PARTS * SIDE + i / PARTS];
    for (double z = 1e-6; z < 9e-6; z *= 2) { /* rows between those of the map are not compared */
        double *a[RC_FATIGUES], *b[RC_FATIGUES];
        struct rc_fatigue_figures few = run(&s, &problem, z, a);
        struct rc_fatigue_problem all = problem;
        all.p = divided_maps;
        run(&divided, &all, z, b);
        for (size_t c = 0; c <= RC_CRITERIA; c++) {
            double largest = 0;
            if (!(problem.wanted >> c & 1))
                continue;
            for (size_t j = 0; j < SIDE; j++)
                largest = fmax(largest, (b[c][j * PARTS + 1] + b[c][j * PARTS + 2]) / 2);
            assert_true(fabs(largest - few.largest[c].value) <=
                        few.largest[c].value * few.largest[c].sampling_error);
        }
        free(a[0]);
        free(b[0]);
    }
}

/* A hydrostatic residual stress shifts the index below 0; the error stays the same. */
static void
below_zero(void **state)
{
    double row[NY], *none[RC_FATIGUES] = {NULL}, error[2] = {0, 0}, value[2] = {0, 0};
    const double *maps[] = {p}, *const residual[RC_COMPONENTS] = {row, row, row};
    const struct rc_fatigue_problem problem = {.stress = {.body.nu = 0.3, .threads = 1},
                                               .wanted = 1U << RC_CROSSLAND | 1U << RC_FINDLEY,
                                               .pass = 'x',
                                               .cases = 1,
                                               .p = maps};
    struct rc_fatigue *f = plan(&shape, &problem);
    struct rc_err err = {""};
    (void)state;

    for (size_t j = 0; j < NY; j++)
        row[j] = -3e10;
    for (int k = 0; k < 2; k++) {
        const struct rc_fatigue_place *at = rc_fatigue_at_depth(f)->largest;
        assert_int_equal(rc_fatigue_depth(f, depth, &limits, k ? residual : NULL, none, &err),
                         RC_OK);
        value[k] = at[RC_CROSSLAND].value;
        error[k] = at[RC_CROSSLAND].sampling_error * fabs(value[k]);
        assert_true(k == 0 || (at[RC_FINDLEY].value < 0 && at[RC_FINDLEY].sampling_error > 0));
    }
    assert_true(value[1] < 0 && error[1] > 0);
    close_to(error[1], error[0], 1e-3);
    rc_fatigue_free(f);
}

/* ---- stressed volume ---- */

static void
volume(void **state)
{
    const double *maps[] = {p}, z[] = {1e-6, 2e-6, 5e-6};
    double sum = 0, before = 0, r[NY], *out[RC_FATIGUES] = {NULL};
    struct rc_fatigue_problem problem = {.stress = {.body.nu = 0.3, .threads = 1},
                                         .wanted = 1U << RC_AMPLITUDE,
                                         .pass = 'x',
                                         .cases = 1,
                                         .p = maps,
                                         .power = 31.0 / 3,
                                         .depth_power = 7.0 / 3,
                                         .threshold = 1e7};
    struct rc_fatigue *f = plan(&shape, &problem);
    struct rc_err err = {""};
    (void)state;

    out[RC_AMPLITUDE] = r;
    for (int k = 0; k < 3; k++) {
        double here = 0;
        assert_int_equal(rc_fatigue_depth(f, z[k], &limits, NULL, out, &err), RC_OK);
        for (size_t j = 0; j < NY; j++)
            here += r[j] > 1e7 ? pow((r[j] - 1e7) / 1e9, 31.0 / 3) * shape.dy : 0;
        here *= pow(z[k], -7.0 / 3);
        sum += k == 0 ? 0 : (here + before) / 2 * (z[k] - z[k - 1]);
        before = here;
    }
    close_to(rc_fatigue_result(f)->stressed_volume, sum, 1e-12);
    assert_int_equal(rc_fatigue_depth(f, 0, &limits, NULL, out, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "power of the depth"));
    rc_fatigue_free(f);
}

/* ---- refusals ---- */

static void
refused_limits(unsigned wanted, double bending, double torsion, double yield, const char *why)
{
    struct rc_err err = {""};

    assert_int_equal(
        rc_fatigue_check_limits(wanted, &(struct rc_fatigue_limits){bending, torsion, yield}, &err),
        RC_FAIL);
    if (strstr(err.text, why) == NULL)
        fail_msg("'%s' without '%s'", err.text, why);
}

static void
refusals(void **state)
{
    const double *maps[] = {p};
    const struct rc_fatigue_problem good = {.stress = {.body.nu = 0.3, .threads = 1},
                                            .wanted = four,
                                            .pass = 'x',
                                            .cases = 1,
                                            .p = maps};
    struct rc_fatigue_problem bad;
    struct rc_err err = {""};
    (void)state;

    refused_limits(0, 1, 0.6, 0, "empty");
    refused_limits(1U << RC_FATIGUES, 1, 0.6, 0, "unknown");
    refused_limits(1U << RC_DANG_VAN, 1, 0, 0, "above 0");
    refused_limits(1U << RC_DANG_VAN, 0, 0.6, 0, "above 0");
    refused_limits(1U << RC_DANG_VAN, 1, 0.5, 0, "Dang Van needs a ratio above 0.5");
    refused_limits(1U << RC_CROSSLAND, 1, 0.57, 0, "Crossland needs a ratio above 0.577");
    refused_limits(1U << RC_PAPADOPOULOS, 1, 0.8, 0, "above 0.577 and below 0.8");
    refused_limits(1U << RC_DANG_VAN, 430e6, 700e6, 0, "no material has a larger one in torsion");
    refused_limits(1U << RC_CROSSLAND, 1, 1.0001, 0, "no material has a larger one in torsion");
    refused_limits(1U << RC_FINDLEY, 1, 1, 0, "below 1");
    refused_limits(1U << RC_PLANE_TURN, 1, 1, 0, "Findley");
    refused_limits(1U << RC_SHAKEDOWN, 0, 0, 0, "yield stress 0 Pa");
    assert_int_equal(rc_fatigue_check_limits(1U << RC_CROSSLAND | 1U << RC_DANG_VAN,
                                             &(struct rc_fatigue_limits){1, 1, 0}, &err),
                     RC_OK);
    assert_int_equal(
        rc_fatigue_check_limits(1U << RC_AMPLITUDE, &(struct rc_fatigue_limits){0}, &err), RC_OK);
    assert_int_equal(rc_fatigue_check(&shape, &good, &err), RC_OK);
    bad = good;
    bad.pass = 'z';
    assert_int_equal(rc_fatigue_check(&shape, &bad, &err), RC_FAIL);
    bad = good;
    bad.cases = 2;
    assert_int_equal(rc_fatigue_check(&shape, &bad, &err), RC_FAIL);
    bad = good;
    bad.pass = 0;
    bad.wanted |= 1U << RC_SHAKEDOWN;
    assert_int_equal(rc_fatigue_check(&shape, &bad, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "needs a pass"));
    bad = good;
    bad.power = -1;
    assert_int_equal(rc_fatigue_check(&shape, &bad, &err), RC_FAIL);
    bad = good;
    bad.stress.body.nu = 0.7;
    assert_null(rc_fatigue_new(&shape, &bad, &err));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(positions),       cmocka_unit_test(bands),
        cmocka_unit_test(wrapped_columns), cmocka_unit_test(contact_that_stays),
        cmocka_unit_test(directions),      cmocka_unit_test(threads),
        cmocka_unit_test(other_loads),     cmocka_unit_test(layers),
        cmocka_unit_test(residual_rows),   cmocka_unit_test(sampling),
        cmocka_unit_test(below_zero),      cmocka_unit_test(volume),
        cmocka_unit_test(refusals),
    };

    make_pressures();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
