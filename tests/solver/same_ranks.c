/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Processes that share a map get the same results as one process, bit for bit: displacements,
 * contact, stresses. Each rank also solves the whole map alone. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/contact_case.h"
#include "libcontact/contact_mpi.h"

static struct rc_ranks *ranks;

/* The rows of a map on this rank. */
struct part {
    size_t first, n; /* nodes */
};

static struct part
part_of(struct rc_shape s)
{
    size_t first, n;

    rc_ranks_rows(ranks, &s, &first, &n);
    return (struct part){first * s.nx, n * s.nx};
}

/* Equal to the last bit on all ranks; otherwise prints the largest difference. */
static void
assert_same(size_t n, const double *a, const double *b, const char *what)
{
    double worst[2] = {0, 0};
    int own, count;

    for (size_t k = 0; k < n; k++) {
        worst[0] = fmax(worst[0], fabs(a[k] - b[k]));
        worst[1] = fmax(worst[1], fabs(b[k]));
        if (!(a[k] == b[k]) && !(isnan(a[k]) && isnan(b[k])))
            worst[0] = fmax(worst[0], 1e-300);
    }
    MPI_Allreduce(MPI_IN_PLACE, worst, 2, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    MPI_Comm_rank(MPI_COMM_WORLD, &own);
    MPI_Comm_size(MPI_COMM_WORLD, &count);
    if (own == 0 && worst[0] != 0)
        printf("# %s, %d ranks: off by %.3g of %.3g\n", what, count, worst[0], worst[1]);
    assert_true(worst[0] == 0);
}

/* A rough map: waves of all lengths with random phases. */
static double *
rough(struct rc_shape s, uint64_t seed)
{
    double *h = malloc(s.nx * s.ny * sizeof *h);
    struct {
        double a, x, y, phase;
    } wave[40];

    for (int w = 0; w < 40; w++) {
        wave[w].x = floor(16 * random_number(&seed)) * 6.283185307179586 / (double)s.nx;
        wave[w].y = floor(16 * random_number(&seed)) * 6.283185307179586 / (double)s.ny;
        wave[w].phase = 6.3 * random_number(&seed);
        wave[w].a = 1e-7 / (1 + 20 * hypot(wave[w].x, wave[w].y));
    }
    for (size_t k = 0; k < s.nx * s.ny; k++) {
        double x = (double)(k % s.nx), y = (double)(k / s.nx);
        h[k] = 1e-9 * random_number(&seed);
        for (int w = 0; w < 40; w++)
            h[k] += wave[w].a * sin(wave[w].x * x + wave[w].y * y + wave[w].phase);
    }
    return h;
}

enum {
    SHAPES = 8
};
/* The cases before a release, and those of every commit, which are of the same kinds with fewer nodes. */
static const struct rc_shape large[SHAPES] = {
    {1000, 37, 1e-6, 1.1e-6}, {37, 1000, 1.3e-6, 1e-6}, {513, 511, 1e-6, 1e-6},
    {256, 256, 1e-6, 1e-6},   {5, 16, 1e-6, 1e-6},      {300, 1, 1e-6, 1e-6},
    {5000, 40, 1e-6, 2e-6},   {1, 20000, 1e-6, 1e-6},
};
static const struct rc_shape small[SHAPES] = {
    {250, 37, 1e-6, 1.1e-6}, {37, 250, 1.3e-6, 1e-6}, {101, 99, 1e-6, 1e-6}, {64, 64, 1e-6, 1e-6},
    {5, 16, 1e-6, 1e-6},     {300, 1, 1e-6, 1e-6},    {2500, 6, 1e-6, 2e-6}, {1, 2000, 1e-6, 1e-6},
};
static const struct rc_shape *shapes = small;

/* ---- displacements ---- */

static void
displacements(void **state)
{
    (void)state;
    for (size_t q = 0; q < BOUNDARIES * SHAPES; q++) {
        struct rc_shape s = shapes[q / BOUNDARIES];
        struct rc_conv_options o = {.boundary = each_boundary[q % BOUNDARIES],
                                    .engine = "fft64",
                                    .threads = 1 + q / BOUNDARIES % 2};
        struct part part = part_of(s);
        double *p = rough(s, q), *u = calloc(s.nx * s.ny, sizeof *u);
        double *own = calloc(part.n + 1, sizeof *own);
        struct rc_body coating = {
            .layers = 1,
            .layer = (const struct rc_layer[]){{.thickness = 3e-6, .e = 4e11, .nu = 0.2}},
            .e = 1e11,
            .nu = 0.3};
        struct rc_pair pair = {.estar = 1e11};
        struct rc_conv *alone, *shared;
        struct rc_err err;

        if (q % 3 == 2)
            pair = (struct rc_pair){.one = coating};
        alone = rc_conv_new(&s, &pair, &o, &err);
        o.ranks = ranks;
        shared = rc_conv_new(&s, &pair, &o, &err);
        assert_non_null(alone);
        assert_non_null(shared);
        rc_conv_apply(alone, p, u);
        rc_conv_apply(shared, p + part.first, own);
        assert_same(part.n, own, u + part.first, "displacement");
        rc_conv_free(alone);
        rc_conv_free(shared);
        free(p);
        free(u);
        free(own);
    }
}

static void
refusals(void **state)
{
    struct rc_shape s = {64, 64, 1e-6, 1e-6};
    struct rc_conv_options o = {.engine = "mlms", .ranks = ranks};
    const struct rc_pair pair = {.estar = 1e11};
    struct rc_err err;
    int count;

    (void)state;
    MPI_Comm_size(MPI_COMM_WORLD, &count);
    if (count == 1)
        skip();
    assert_null(rc_conv_new(&s, &pair, &o, &err));
    assert_non_null(strstr(err.text, "in one process"));
}

/* ---- contact ---- */

struct outcome {
    struct rc_contact c;
    double *p, *gap, *u, stiffness;
    struct rc_conductance conductance;
    struct rc_patches patches;
};

/* Several loads one after another; returns the result of the last one. */
static struct outcome
contact(struct rc_shape s, size_t n, const double *h, struct rc_problem problem, size_t loads)
{
    struct rc_patch_options look = {
        .boundary = problem.boundary, .largest = SIZE_MAX, .threads = 1, .ranks = problem.ranks};
    struct outcome o = {.p = calloc(n + 1, sizeof(double)),
                        .gap = calloc(n + 1, sizeof(double)),
                        .u = calloc(n + 1, sizeof(double))};
    struct rc_solver *solver;
    struct rc_err err;

    solver = rc_solver_new(&s, h, &problem, &err);
    if (solver == NULL)
        print_error("%s\n", err.text);
    assert_non_null(solver);
    for (size_t k = 0; k < loads; k++) {
        if (k > 0)
            assert_int_equal(rc_solver_set_load(solver, problem.load * (double)(1 + k),
                                                problem.approach * (double)(1 + k), &err),
                             RC_OK);
        while (rc_solver_step(solver) == RC_MORE)
            ;
        rc_solver_result(solver, o.u, o.gap, &o.c);
    }
    assert_int_equal(rc_solver_stiffness(solver, &o.stiffness, &err), RC_OK);
    assert_int_equal(rc_solver_conductance(solver, 45, 16, &o.conductance, &err), RC_OK);
    memcpy(o.p, rc_solver_pressure(solver), n * sizeof *o.p);
    assert_int_equal(rc_patches_find(&s, o.p, &look, &o.patches, &err), RC_OK);
    rc_solver_free(solver);
    return o;
}

static void
outcome_free(struct outcome *o)
{
    free(o->p);
    free(o->gap);
    free(o->u);
    rc_patches_free(&o->patches);
}

static void
assert_same_patches(const struct rc_patches *a, const struct rc_patches *b)
{
    assert_int_equal(a->count, b->count);
    assert_int_equal(a->contact_nodes, b->contact_nodes);
    assert_true(a->perimeter == b->perimeter);
    assert_true(a->contact_area_corrected == b->contact_area_corrected);
    for (size_t k = 0; k < a->count; k++)
        assert_int_equal(a->patch[k].nodes, b->patch[k].nodes);
}

static void
compare(struct rc_shape s, struct rc_problem problem, size_t loads, const char *what)
{
    struct part part = part_of(s);
    double *h = rough(s, 3);
    const double *hardness = problem.hardness_map;
    struct outcome alone = contact(s, s.nx * s.ny, h, problem, loads), shared;

    problem.ranks = ranks;
    if (hardness != NULL)
        problem.hardness_map = hardness + part.first;
    shared = contact(s, part.n, h + part.first, problem, loads);
    assert_same(part.n, shared.p, alone.p + part.first, what);
    assert_same(part.n, shared.gap, alone.gap + part.first, what);
    assert_same(part.n, shared.u, alone.u + part.first, what);
    assert_same(1, &shared.stiffness, &alone.stiffness, "stiffness");
    assert_same(1, &shared.conductance.value, &alone.conductance.value, "conductance");
    assert_same(1, &shared.conductance.lower, &alone.conductance.lower, "its bound");
    assert_same(1, &shared.c.mean_gap, &alone.c.mean_gap, "mean gap");
    assert_same(1, &shared.c.kkt_residual, &alone.c.kkt_residual, "residual");
    assert_same(1, &shared.c.edge_load_fraction, &alone.c.edge_load_fraction, "edge load");
    assert_same(1, &shared.c.discretization.contact_area, &alone.c.discretization.contact_area,
                "area left out");
    assert_same(1, &shared.c.approach, &alone.c.approach, "approach");
    assert_same(2, shared.c.tilt, alone.c.tilt, "tilt");
    assert_int_equal(shared.c.iterations, alone.c.iterations);
    assert_int_equal(shared.c.yielded_nodes, alone.c.yielded_nodes);
    assert_same_patches(&shared.patches, &alone.patches);
    outcome_free(&alone);
    outcome_free(&shared);
    free(h);
}

static void
contacts(void **state)
{
    (void)state;
    for (size_t q = 0; q < BOUNDARIES * SHAPES; q++) {
        struct rc_shape s = shapes[q / BOUNDARIES];
        double area = (double)(s.nx * s.ny) * s.dx * s.dy;
        struct rc_problem problem = {.boundary = each_boundary[q % BOUNDARIES],
                                     .pair.estar = 1e11,
                                     .load = 3e8 * area,
                                     .engine = "fft",
                                     .tol = 1e-6,
                                     .threads = 1 + q / BOUNDARIES % 2};
        compare(s, problem, 1, "elastic");
        problem.hardness = 1e9;
        problem.discretization = true;
        compare(s, problem, 2, "hardness, two loads");
    }
}

/* Loads of some nodes, and up to the capacity of all nodes, where nodes join in the order of their gaps. */
static void
hardness_maps(void **state)
{
    (void)state;
    for (size_t q = 0; q < BOUNDARIES * SHAPES; q++) {
        struct rc_shape s = shapes[q / BOUNDARIES];
        size_t n = s.nx * s.ny;
        double *map = calloc(n, sizeof *map), sum = 0;
        struct rc_problem problem = {.boundary = each_boundary[q % BOUNDARIES],
                                     .pair.estar = 1e11,
                                     .hardness_map = map,
                                     .engine = "fft",
                                     .tol = 1e-6,
                                     .threads = 1 + q / BOUNDARIES % 2};

        for (size_t k = 0; k < n; k++) {
            map[k] = k % 5 < 2 ? 5e8 : 1e9 * (double)(1 + k % 3);
            sum += map[k];
        }
        problem.load = 0.3 * sum * s.dx * s.dy;
        problem.discretization = true;
        compare(s, problem, 2, "a map of hardness, two loads");
        problem.load = 0.999 * sum * s.dx * s.dy;
        compare(s, problem, 1, "a map of hardness, nearly all");
        map[n - 1] = NAN;
        problem.load = 0.5 * sum * s.dx * s.dy;
        compare(s, problem, 1, "a map of hardness, one node without");
        free(map);
    }
}

static void
approaches(void **state)
{
    struct rc_shape s = {200, 190, 1e-6, 1e-6};
    struct rc_problem problem = {
        .pair.estar = 1e11, .approach = 2e-8, .engine = "fft", .tol = 1e-6, .threads = 1};

    (void)state;
    for (size_t q = 0; q < BOUNDARIES; q++) {
        problem.boundary = each_boundary[q % BOUNDARIES];
        problem.boundary.datum = 1e-3;
        compare(s, problem, 2, "approach");
    }
}

/* Near saturation nodes join in the order of their gaps, and some methods need the safeguard. */
static void
saturation(void **state)
{
    struct rc_shape s = {96, 130, 1e-6, 1e-6};
    double area = (double)(s.nx * s.ny) * s.dx * s.dy;

    (void)state;
    for (int q = 0; q < 4; q++) {
        struct rc_problem problem = {.boundary = q % 2 ? RC_PERIODIC : RC_FREE,
                                     .pair.estar = 1e11,
                                     .hardness = 1e9,
                                     .load = (q < 2 ? 0.999 : 1.0) * 1e9 * area,
                                     .engine = "fft",
                                     .tol = 1e-5,
                                     .threads = 1};
        compare(s, problem, 1, "saturation");
        problem.method = "pk99";
        problem.max_iterations = 60;
        compare(s, problem, 1, "saturation, pk99");
    }
}

/* The tilt follows from sums over all ranks, and the first touch is searched for on all of them. */
static void
tilts(void **state)
{
    struct rc_shape s = {180, 210, 1e-6, 1e-6};
    struct rc_problem problem = {.pair.estar = 1e11,
                                 .load = 0.5,
                                 .engine = "fft",
                                 .tol = 1e-6,
                                 .tilt_free = true,
                                 .force_at = {12e-6, -9e-6},
                                 .threads = 1};

    (void)state;
    compare(s, problem, 2, "tilt");
    s.ny = 1500;
    compare(s, problem, 1, "tilt of a long map");
    s.nx = 5;
    problem.force_at[0] = 0;
    compare(s, problem, 1, "tilt of a strip");
}

/* In double precision rows of two maps are kept, only those of this rank. */
static void
memory(void **state)
{
    struct rc_shape s = {512, 512, 1e-6, 1e-6};
    struct rc_problem problem = {.pair.estar = 1e11, .load = 1, .threads = 1};
    unsigned long most = (unsigned long)part_of(s).n;
    struct rc_expected expected[2];

    (void)state;
    MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_UNSIGNED_LONG, MPI_MAX, MPI_COMM_WORLD);
    for (int q = 0; q < 2; q++) {
        problem.ranks = q == 0 ? NULL : ranks;
        assert_int_equal(rc_solver_expect(&s, &problem, &expected[q], NULL), RC_OK);
    }
    assert_true(expected[1].memory >= 80 * most - 1 && expected[0].memory > 80 * s.nx * s.ny);
}

/* ---- stresses ---- */

static void
stresses(void **state)
{
    static const double depth[] = {0, 2e-6, 4e-6, 1e-4, 4e-4}; /* the last ones on coarser grids */
    size_t coarse = 0;

    (void)state;
    for (size_t q = 0; q < 8; q++) {
        struct rc_shape s = shapes[q / 2];
        struct part part = part_of(s);
        struct rc_body coating = {
            .layers = 1,
            .layer = (const struct rc_layer[]){{.thickness = 3e-6, .e = 4e11, .nu = 0.2}},
            .e = 1e11,
            .nu = 0.3};
        struct rc_stress_options o = {.boundary = q % 2 ? RC_PERIODIC : RC_FREE,
                                      .body.nu = 0.3,
                                      .mu = q % 4 < 2 ? 0.2 : 0,
                                      .tol = q % 4 == 2 ? 1e-4 : 0,
                                      .wanted = 1u << RC_MISES | 1u << RC_SXY,
                                      .threads = 1 + q / 2 % 2};
        double *p = rough(s, q), *s1[RC_STRESSES] = {NULL}, *s2[RC_STRESSES] = {NULL};
        struct rc_stress *alone, *shared;
        double *d1, *d2;
        size_t n1, n2;
        struct rc_err err;

        if (q == 4 || q == 5)
            o.body = coating;
        s1[RC_MISES] = calloc(s.nx * s.ny, sizeof(double));
        s1[RC_SXY] = calloc(s.nx * s.ny, sizeof(double));
        s2[RC_MISES] = calloc(part.n + 1, sizeof(double));
        s2[RC_SXY] = calloc(part.n + 1, sizeof(double));
        alone = rc_stress_new(&s, p, &o, &err);
        assert_int_equal(rc_stress_depths(NULL, &s, p, o.boundary, &o.body, &d1, &n1, &err), RC_OK);
        o.ranks = ranks;
        shared = rc_stress_new(&s, p + part.first, &o, &err);
        assert_non_null(alone);
        assert_non_null(shared);
        assert_int_equal(
            rc_stress_depths(ranks, &s, p + part.first, o.boundary, &o.body, &d2, &n2, &err),
            RC_OK);
        assert_int_equal(n1, n2);
        assert_same(n1, d2, d1, "depths");
        for (size_t z = 0; z < sizeof depth / sizeof *depth; z++) {
            assert_int_equal(rc_stress_slice(alone, depth[z], s1, &err), RC_OK);
            assert_int_equal(rc_stress_slice(shared, depth[z], s2, &err), RC_OK);
            assert_same(part.n, s2[RC_MISES], s1[RC_MISES] + part.first, "mises");
            assert_same(part.n, s2[RC_SXY], s1[RC_SXY] + part.first, "sxy");
        }
        assert_int_equal(rc_stress_counted(shared)->coarse_depths,
                         rc_stress_counted(alone)->coarse_depths);
        coarse += rc_stress_counted(shared)->coarse_depths;
        rc_stress_free(alone);
        rc_stress_free(shared);
        free(d1);
        free(d2);
        for (int c = 0; c < RC_STRESSES; c++) {
            free(s1[c]);
            free(s2[c]);
        }
        free(p);
    }
    assert_true(coarse >= 6);
}

int
main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(displacements), cmocka_unit_test(refusals),   cmocka_unit_test(contacts),
        cmocka_unit_test(hardness_maps), cmocka_unit_test(approaches), cmocka_unit_test(tilts),
        cmocka_unit_test(saturation),    cmocka_unit_test(memory),     cmocka_unit_test(stresses),
    };
    struct rc_err err;
    int failed;

    if (thorough(true, false))
        shapes = large;
    MPI_Init(&argc, &argv);
    ranks = rc_ranks_new(MPI_COMM_WORLD, &err);
    failed = ranks == NULL ? 1 : cmocka_run_group_tests(tests, NULL, NULL);
    rc_ranks_free(ranks);
    MPI_Finalize();
    return failed;
}
