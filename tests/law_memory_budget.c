/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The peak that the allocator counts agrees with the kernel's figure to a twentieth. Work that needs more
 * than the budget is refused and frees its memory. The work is solver, stresses, friction, adhesion,
 * plasticity, sums, flow and slabs. Each runs in a separate process, on maps so large that plans are
 * negligible. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "libcontact/adhesion/adhesion.h"
#include "libcontact/memory.h"
#include "libcontact/yield/yield.h"
#include "libcontact/friction/friction.h"
#include "libcontact/volume/volume.h"
#include "tests/exact.h"
#include "tools/machine/memory.h"

/* The second size is for work with few bytes per node, the third for slow work. */
static const struct rc_shape map = {701, 500, 1e-6, 1.1e-6}, large = {701, 4000, 1e-6, 1.1e-6},
                             small = {351, 250, 1e-6, 1.1e-6};
static const double twentieth = 0.05;

struct work {
    const char *name;
    const struct rc_shape *shape;
    struct rc_boundary boundary;
    const char *engine;
    size_t plans; /* bytes of plans of transforms, which the allocator does not count */
    /* Does the work on these heights and pressures; false: it failed. */
    bool (*run)(const struct work *work, const double *h, const double *p);
};

static size_t
nodes_of(const struct work *w)
{
    return w->shape->nx * w->shape->ny;
}

static bool
solve_with(const struct work *w, const double *h, const double *hardness)
{
    struct rc_problem problem = {.boundary = w->boundary,
                                 .engine = w->engine,
                                 .pair.estar = 3e9,
                                 .hardness_map = hardness,
                                 .load = 1e7 * (double)(w->shape->nx * w->shape->ny) *
                                         w->shape->dx * w->shape->dy,
                                 .tol = 1e-2};
    struct rc_solver *s = rc_solver_new(w->shape, h, &problem, NULL);
    struct rc_contact contact;

    if (s == NULL)
        return false;
    while (rc_solver_step(s) == RC_MORE)
        continue;
    rc_solver_result(s, NULL, NULL, &contact);
    rc_solver_free(s);
    return true;
}

static bool
solve(const struct work *w, const double *h, const double *p)
{
    (void)p;
    return solve_with(w, h, NULL);
}

/* The solver keeps its own copy of the map of hardness. */
static bool
solve_mapped(const struct work *w, const double *h, const double *p)
{
    double *hardness = rc_alloc(nodes_of(w), sizeof *hardness);
    bool solved;

    (void)p;
    if (hardness == NULL)
        return false;
    for (size_t k = 0; k < nodes_of(w); k++)
        hardness[k] = k % 1000 < 500 ? 1e8 : NAN;
    solved = solve_with(w, h, hardness);
    rc_free(hardness);
    return solved;
}

static bool
sum(const struct work *w, const double *h, const double *p)
{
    const struct rc_conv_options options = {.boundary = w->boundary, .engine = w->engine};
    struct rc_conv *conv = rc_conv_new(w->shape, &(struct rc_pair){.estar = 3e9}, &options, NULL);
    double *u = rc_alloc(nodes_of(w), sizeof *u);
    bool done = conv != NULL && u != NULL;

    (void)h;
    if (done)
        rc_conv_apply(conv, p, u);
    rc_conv_free(conv);
    rc_free(u);
    return done;
}

static bool
stress_of(const struct work *w, const double *p, const struct rc_eigenstrain *strain,
          const double *traction)
{
    const double depth = 5e-6;
    const struct rc_stress_options options = {.boundary = w->boundary,
                                              .body = {.e = 2e11, .nu = 0.3},
                                              .wanted = 1u << RC_MISES,
                                              .engine = w->engine,
                                              .strain = strain,
                                              .traction = {traction, traction}};
    struct rc_stress *s = rc_stress_new(w->shape, p, &options, NULL);
    double *to[RC_STRESSES] = {NULL};
    bool found;

    to[RC_MISES] = rc_alloc(nodes_of(w), sizeof(double));
    found = s != NULL && to[RC_MISES] != NULL && rc_stress_slice(s, depth, to, NULL) == RC_OK;
    rc_stress_free(s);
    rc_free(to[RC_MISES]);
    return found;
}

static bool
stress(const struct work *w, const double *h, const double *p)
{
    (void)h;
    return stress_of(w, p, NULL, NULL);
}

static bool
stress_dragged(const struct work *w, const double *h, const double *p)
{
    (void)h;
    return stress_of(w, p, NULL, p);
}

/* The stress of the pressure and of plastic strain in a few slabs. */
static bool
stress_strained(const struct work *w, const double *h, const double *p)
{
    enum {
        SLABS = 5,
        MAPS = 5
    };
    static const double thickness[SLABS] = {1e-6, 1e-6, 2e-6, 2e-6, 3e-6};
    const double *maps[SLABS * MAPS];
    const struct rc_eigenstrain strain = {SLABS, thickness, maps};

    for (size_t k = 0; k < SLABS * MAPS; k++)
        maps[k] = h;
    return stress_of(w, p, &strain, NULL);
}

static bool
patches(const struct work *w, const double *h, const double *p)
{
    const struct rc_patch_options options = {.boundary = w->boundary, .largest = SIZE_MAX};
    struct rc_patches found;

    (void)h;
    if (rc_patches_find(w->shape, p, &options, &found, NULL) != RC_OK)
        return false;
    rc_patches_free(&found);
    return true;
}

static bool
psd(const struct work *w, const double *h, const double *p)
{
    const struct rc_psd_options options = {.boundary = w->boundary};
    struct rc_psd *found = rc_psd_new(w->shape, h, &options, NULL);

    (void)p;
    if (found == NULL)
        return false;
    rc_psd_free(found);
    return true;
}

/* The heights as a gap that is open everywhere, which needs the most memory. */
static bool
leak(const struct work *w, const double *h, const double *p)
{
    struct rc_leak *leak = rc_leak_new(w->shape, NULL, h, &(struct rc_leak_options){0}, NULL);
    enum rc_status status = leak == NULL ? RC_FAIL : RC_MORE;

    (void)p;
    while (status == RC_MORE)
        status = rc_leak_step(leak, NULL);
    rc_leak_free(leak);
    return status == RC_OK;
}

static bool
slab_strain(void *ctx, size_t slab, enum rc_component c, size_t j, double *row)
{
    const double *const *h = ctx;

    (void)slab, (void)c;
    memcpy(row, *h + j * map.nx, map.nx * sizeof *row);
    return true;
}

static void
slab_stress(void *ctx, size_t slab, size_t j, double *const s[RC_COMPONENTS])
{
    (void)ctx, (void)slab, (void)j, (void)s;
}

/* Slabs of plastic strain: sweeps up and down. */
static bool
slabs_in(const struct work *w, enum rc_precision precision, const double *h, const double *p)
{
    static const double thickness[] = {1e-6, 1e-6, 2e-6, 2e-6, 4e-6, 4e-6, 8e-6, 8e-6, 8e-6};
    const struct rc_slabs_options options = {.boundary = RC_PERIODIC,
                                             .slabs = 9,
                                             .thickness = thickness,
                                             .shear = 1e9,
                                             .nu = 0.3,
                                             .precision = precision};
    const double *heights = h;
    const struct rc_slab_strain strain = {NULL, slab_strain, &heights};
    const struct rc_slab_stress stress = {NULL, slab_stress, NULL};
    struct rc_slabs *slabs = rc_slabs_new(w->shape, &options, NULL);

    if (slabs == NULL)
        return false;
    rc_slabs_up(slabs, &strain, NULL);
    rc_slabs_down(slabs, p, &stress);
    rc_slabs_free(slabs);
    return true;
}

static bool
slabs_double(const struct work *w, const double *h, const double *p)
{
    return slabs_in(w, RC_DOUBLE, h, p);
}

static bool
slabs_single(const struct work *w, const double *h, const double *p)
{
    return slabs_in(w, RC_SINGLE, h, p);
}

/* Dissimilar bodies, to an error of a tenth. */
static bool
friction(const struct work *w, const double *h, const double *p)
{
    const struct rc_friction_law problem = {
        .boundary = w->boundary, .pair.one = {.e = 3e9, .nu = 0.3}, .mu = 0.3, .tol = 0.1};
    struct rc_friction_solver *slip = rc_friction_solver_new(w->shape, &problem, NULL);
    enum rc_status status = RC_FAIL;

    (void)h;
    if (slip != NULL && rc_friction_solver_set_pressure(slip, p, NULL, NULL) == RC_OK &&
        rc_friction_solver_set_force(slip, 1e4 * (double)nodes_of(w) * w->shape->dx * w->shape->dy,
                                     0, NULL) == RC_OK)
        do
            status = rc_friction_solver_step(slip, NULL);
        while (status == RC_MORE);
    rc_friction_solver_free(slip);
    return status == RC_OK;
}

static size_t
states_of(const struct rc_adhesion_solver *a)
{
    struct rc_adhesion_solver_progress progress;

    rc_adhesion_solver_progress(a, &progress);
    return progress.state;
}

/* A state with its eigenvalue, and four states of a retraction. */
static bool
adhesion(const struct work *w, const double *h, const double *p)
{
    const struct rc_adhesion_problem problem = {
        .contact = {.boundary = w->boundary, .pair.estar = 3e9, .tol = 1e-3},
        .work = 0.1,
        .law = "jkr"};
    struct rc_adhesion_solver *a = rc_adhesion_solver_new(w->shape, h, &problem, NULL);
    enum rc_status status = RC_FAIL;

    (void)p;
    if (a != NULL && rc_adhesion_solver_set_approach(a, 1e-8, NULL) == RC_OK) {
        while ((status = rc_adhesion_solver_step(a, NULL)) == RC_MORE)
            ;
        status = rc_adhesion_solver_pull_off(a, NULL);
        while (status != RC_FAIL && states_of(a) <= 4 &&
               (status = rc_adhesion_solver_step(a, NULL)) == RC_MORE)
            ;
    }
    rc_adhesion_solver_free(a);
    return status != RC_FAIL;
}

/* Friction together with the contact. */
static bool
friction_found(const struct work *w, const double *h, const double *p)
{
    double load = 1e5 * (double)nodes_of(w) * w->shape->dx * w->shape->dy;
    const struct rc_pair pair = {.one = {.e = 3e9, .nu = 0.3}};
    const struct rc_problem contact = {.boundary = w->boundary, .pair = pair, .tol = 0.01};
    const struct rc_friction_problem law = {
        .law = {.boundary = w->boundary, .pair = pair, .mu = 0.3, .tol = 0.1}, .increments = 1};
    struct rc_model *m =
        rc_friction_new(rc_elastic_new(w->shape, h, &contact, NULL, NULL), h, &law, NULL);
    enum rc_status status = RC_FAIL;
    struct rc_point to = {0};

    (void)p;
    rc_point_set(&to, RC_LOAD, load);
    rc_point_set(&to, RC_TANGENTIAL_X, 0.1 * load);
    rc_point_set(&to, RC_TANGENTIAL_Y, 0);
    if (m != NULL)
        status = rc_model_run(m, &to, NULL);
    rc_model_free(m);
    return status == RC_OK;
}

/* At least a tenth of the voxels yields. */
static bool
yielding(const struct work *w, const double *h, const double *p)
{
    enum {
        SLABS = 12
    };
    double thickness[SLABS];
    struct rc_yield_problem problem = {.contact = {.boundary = w->boundary,
                                                   .pair.one = {.e = 3e9, .nu = 0.3},
                                                   .pair.two.e = INFINITY},
                                       .law = {.stress = 1e7, .modulus = 1e8},
                                       .slabs = SLABS,
                                       .thickness = thickness,
                                       .increments = 1,
                                       .lag = 0.5};
    double load = 1e7 * (double)nodes_of(w) * w->shape->dx * w->shape->dy;
    struct rc_yield_solver *plastic;
    enum rc_status status = RC_FAIL;
    bool enough = false;

    (void)p;
    for (int k = 0; k < SLABS; k++)
        thickness[k] = 1e-6;
    plastic = rc_yield_solver_new(w->shape, h, &problem, NULL);
    if (plastic != NULL && rc_yield_solver_set_load(plastic, load, NULL) == RC_OK)
        do
            status = rc_yield_solver_step(plastic, NULL);
        while (status == RC_MORE);
    if (status != RC_FAIL)
        enough = 10 * plastic->figures.voxels > nodes_of(w) * SLABS;
    rc_yield_solver_free(plastic);
    return enough;
}

/* The result of a child process as its exit status; 0: as expected. */
static int
refused(const struct work *w, const double *h, const double *p, size_t peak)
{
    const size_t before = rc_memory_held().held;

    rc_memory_budget(before + peak / 2);
    if (w->run(w, h, p) || rc_memory_held().refused <= before + peak / 2)
        return 4;
    return rc_memory_held().held < before + peak / 50 ? 0 : 5; /* FFTW keeps its plans */
}

/* Bytes of files in memory: code of the libraries. How much of it the kernel maps at once differs from
 * machine to machine. */
static size_t
code_held(void)
{
    char line[256];
    unsigned long kib = 0;
    FILE *f = fopen("/proc/self/status", "r");

    while (f != NULL && fgets(line, sizeof line, f) != NULL)
        if (sscanf(line, "RssFile: %lu", &kib) == 1)
            break;
    if (f != NULL)
        fclose(f);
    return (size_t)kib << 10;
}

static int
measured(const struct work *w)
{
    size_t n = nodes_of(w), before, code, held, said, took;
    double *h = malloc(n * sizeof *h), *p = malloc(n * sizeof *p);

    memory_keep_maps_apart();
    if (h == NULL || p == NULL)
        return 2;
    for (size_t k = 0; k < n;
         k++) { /* waves of a few nodes, and pressure in strips on a fifth of the map */
        size_t i = k % w->shape->nx, j = k / w->shape->nx;
        h[k] = 1e-7 * (2 + sin(0.31 * (double)i) + cos(0.23 * (double)j) +
                       0.1 * (double)(k * 7919 % 97) / 97);
        p[k] = k * 7919 % 15 < 3 || i % 15 < 3 ? 1e6 : 0;
    }
    before = memory_held();
    code = code_held();
    held = rc_memory_held().held;
    if (!w->run(w, h, p))
        return 3;
    said = rc_memory_held().peak - held;
    took = memory_peak() - before;
    code = code_held() - code; /* at the end; at the peak it may have been less */
    if ((double)said <= (1 + twentieth) * (double)took &&
        (double)said >= (1 - twentieth) * (double)(took - code) - (double)w->plans)
        return refused(w, h, p, said);
    fprintf(stderr, "%s: %.1f MiB counted, %.1f MiB taken, of which %.1f MiB code\n", w->name,
            (double)said / (1 << 20), (double)took / (1 << 20), (double)code / (1 << 20));
    return 1;
}

static const size_t transforms = 3 << 19; /* bytes of plans of one precision */

static void
holds(void **state)
{
    const struct work works[] = {
        {"solver", &map, RC_FREE, NULL, 2 * transforms, solve},
        {"solver, periodic", &map, RC_PERIODIC, NULL, 2 * transforms, solve},
        {"solver, mlms", &map, RC_FREE, "mlms", 2 * transforms, solve},
        {"solver, a map of hardness", &map, RC_FREE, NULL, 2 * transforms, solve_mapped},
        {"sums", &map, RC_FREE, "fft64", transforms, sum},
        {"sums, periodic", &map, RC_PERIODIC, "fft64", transforms, sum},
        {"sums, mlms", &map, RC_FREE, "mlms", transforms, sum},
        {"stress", &map, RC_FREE, NULL, transforms, stress},
        {"stress, periodic", &map, RC_PERIODIC, NULL, transforms, stress},
        {"stress, tractions", &map, RC_FREE, NULL, transforms, stress_dragged},
        {"stress, tractions, periodic", &map, RC_PERIODIC, NULL, transforms, stress_dragged},
        {"stress, strained", &map, RC_FREE, NULL, 2 * transforms, stress_strained},
        {"stress, strained, periodic", &map, RC_PERIODIC, NULL, 2 * transforms, stress_strained},
        {"friction", &map, RC_FREE, NULL, 2 * transforms, friction},
        {"friction, periodic", &map, RC_PERIODIC, NULL, 2 * transforms, friction},
        {"adhesion, pulled off", &small, RC_FREE, NULL, 2 * transforms, adhesion},
        {"adhesion, pulled off, periodic", &small, RC_PERIODIC, NULL, 2 * transforms, adhesion},
        {"friction and contact", &map, RC_FREE, NULL, 2 * transforms, friction_found},
        {"patches", &large, RC_FREE, NULL, 0, patches},
        {"spectrum", &map, RC_PERIODIC, NULL, transforms, psd},
        {"flow through a gap", &map, RC_FREE, NULL, 0, leak},
        {"a body that yields inside", &map, RC_PERIODIC, NULL, 2 * transforms, yielding},
        {"slabs", &map, RC_PERIODIC, NULL, transforms, slabs_double},
        {"slabs, single precision", &map, RC_PERIODIC, NULL, transforms, slabs_single},
    };
    int missed = 0;

    (void)state;
    for (size_t k = 0; k < sizeof works / sizeof *works; k += thorough(1, 4)) {
        int status = 0;
        pid_t child = fork();

        if (child == 0)
            _exit(measured(&works[k]));
        assert_true(waitpid(child, &status, 0) == child);
        if (status != 0)
            fprintf(stderr, "%s: status %d\n", works[k].name, status);
        missed += status != 0;
    }
#ifndef __SANITIZE_ADDRESS__ /* it takes additional memory */
    assert_int_equal(missed, 0);
#endif
}

/* Each block counts until it is freed, whichever function allocated it. */
static void
counts(void **state)
{
    const size_t n = (size_t)8 << 20;
    size_t before = rc_memory_held().held;
    void *a = rc_alloc(n, 1), *b = rc_malloc(n), *c = rc_calloc(n, 1), *d = rc_realloc(NULL, 1);

    (void)state;
    assert_true(a != NULL && b != NULL && c != NULL && d != NULL);
    assert_true(rc_memory_held().held >= before + 3 * n);
    assert_true(rc_memory_held().held < before + 3 * n + n / 100);
    assert_true(rc_memory_held().peak >= before + 3 * n);
    rc_memory_budget(before + 5 * n);
    assert_true(rc_memory_ask(n));
    assert_non_null(d = rc_realloc(d, n));
    assert_int_equal(rc_memory_held().refused, 0);
    assert_false(rc_memory_ask(2 * n));
    assert_true(rc_memory_held().refused >= before + 6 * n);
    assert_null(rc_alloc(2 * n, 1));
    assert_null(rc_malloc(2 * n));
    assert_null(rc_calloc(2, n));
    assert_null(rc_calloc(SIZE_MAX, 2));
    assert_null(rc_realloc(d, 3 * n));
    rc_free(a);
    assert_non_null(a = rc_aligned_alloc(64, n));
    rc_free(b);
    assert_non_null(b = rc_alloc(n + n / 2, 1));
    rc_free(a);
    rc_free(b);
    rc_free(c);
    rc_free(d);
    rc_free(NULL);
    assert_true(rc_memory_held().held < before + n / 100);
    rc_memory_budget(0);
    assert_true(rc_memory_ask(SIZE_MAX));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(holds), cmocka_unit_test(counts)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
