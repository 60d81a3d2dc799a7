/* The library's estimates of memory are within a tenth of the peak, each in a process of its own: solver,
 * stiffness, stresses, friction, adhesion, plasticity, sums, flow and slabs, on maps large enough that code and plans
 * do not count. */
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

#include "libcontact/volume/volume.h"
#include "tests/exact.h"
#include "tools/machine/memory.h"

/* The second for what takes few bytes a node, the third for what takes long. */
static const struct rc_shape map = {701, 500, 1e-6, 1.1e-6}, large = {701, 4000, 1e-6, 1.1e-6},
                             small = {351, 250, 1e-6, 1.1e-6};
static const double tenth = 0.1;

struct work {
    const char *name;
    const struct rc_shape *shape;
    enum rc_boundary boundary;
    const char *engine;
    size_t code; /* bytes of code and plans, which the library does not count */
    /* Does the work on these heights and pressures, returns the estimate for it; 0: it failed. */
    size_t (*run)(const struct work *work, const double *h, const double *p);
};

static size_t
nodes_of(const struct work *w)
{
    return w->shape->nx * w->shape->ny;
}

static size_t
solve_with(const struct work *w, const double *h, const double *hardness)
{
    struct rc_problem problem = {.boundary = w->boundary,
                                 .engine = w->engine,
                                 .pair.estar = 3e9,
                                 .hardness_map = hardness,
                                 .load = 1e7 * (double)(w->shape->nx * w->shape->ny) *
                                         w->shape->dx * w->shape->dy,
                                 .tol = 1e-2};
    size_t bytes = rc_solver_memory(w->shape, &problem);
    struct rc_solver *s = rc_solver_new(w->shape, h, &problem, NULL);
    struct rc_contact contact;

    if (s == NULL)
        return 0;
    while (rc_solver_step(s) == RC_MORE)
        continue;
    rc_solver_result(s, NULL, NULL, &contact);
    rc_solver_free(s);
    return bytes;
}

static size_t
solve(const struct work *w, const double *h, const double *p)
{
    (void)p;
    return solve_with(w, h, NULL);
}

/* The map of hardness is kept beside the caller's. */
static size_t
solve_mapped(const struct work *w, const double *h, const double *p)
{
    double *hardness = malloc(nodes_of(w) * sizeof *hardness);
    size_t bytes = 0;

    (void)p;
    for (size_t k = 0; k < nodes_of(w) && hardness != NULL; k++)
        hardness[k] = k % 1000 < 500 ? 1e8 : NAN;
    if (hardness != NULL)
        bytes = solve_with(w, h, hardness) + nodes_of(w) * sizeof *hardness;
    free(hardness);
    return bytes;
}

static size_t
sum(const struct work *w, const double *h, const double *p)
{
    const struct rc_conv_options options = {.boundary = w->boundary, .engine = w->engine};
    size_t bytes = rc_conv_memory(w->shape, &options) + nodes_of(w) * sizeof(double);
    struct rc_conv *conv = rc_conv_new(w->shape, &(struct rc_pair){.estar = 3e9}, &options, NULL);
    double *u = malloc(nodes_of(w) * sizeof *u);

    (void)h;
    if (conv != NULL && u != NULL)
        rc_conv_apply(conv, p, u);
    else
        bytes = 0;
    rc_conv_free(conv);
    free(u);
    return bytes;
}

static size_t
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
    size_t bytes =
        rc_stress_memory(w->shape, &options, &depth, 1, 0) + nodes_of(w) * sizeof(double);
    struct rc_stress *s = rc_stress_new(w->shape, p, &options, NULL);
    double *to[RC_STRESSES] = {NULL};

    to[RC_MISES] = malloc(nodes_of(w) * sizeof(double));
    if (s == NULL || to[RC_MISES] == NULL || rc_stress_slice(s, depth, to, NULL) != RC_OK)
        bytes = 0;
    rc_stress_free(s);
    free(to[RC_MISES]);
    return bytes;
}

static size_t
stress(const struct work *w, const double *h, const double *p)
{
    (void)h;
    return stress_of(w, p, NULL, NULL);
}

static size_t
stress_dragged(const struct work *w, const double *h, const double *p)
{
    (void)h;
    return stress_of(w, p, NULL, p);
}

/* Beside that of the pressure the stress of strain in a few slabs. */
static size_t
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

static size_t
patches(const struct work *w, const double *h, const double *p)
{
    const struct rc_patch_options options = {.boundary = w->boundary, .each = true};
    size_t bytes = rc_patches_memory(w->shape, p, &options);
    struct rc_patches found;

    (void)h;
    if (rc_patches_find(w->shape, p, &options, &found, NULL) != RC_OK)
        return 0;
    rc_patches_free(&found);
    return bytes;
}

static size_t
psd(const struct work *w, const double *h, const double *p)
{
    const struct rc_psd_options options = {.boundary = w->boundary};
    size_t bytes = rc_psd_memory(w->shape);
    struct rc_psd *found = rc_psd_new(w->shape, h, &options, NULL);

    (void)p;
    if (found == NULL)
        return 0;
    rc_psd_free(found);
    return bytes;
}

#ifdef RC_LEAK
/* The heights as a gap, open everywhere: the most that there can be. */
static size_t
leak_found(const struct work *w, const double *h, const double *p)
{
    struct rc_leak *leak = rc_leak_new(w->shape, NULL, h, &(struct rc_leak_options){0}, NULL);

    (void)p;
    rc_leak_free(leak);
    return leak == NULL ? 0 : rc_leak_memory(w->shape);
}

static size_t
leak_solved(const struct work *w, const double *h, const double *p)
{
    size_t before = memory_held(), bytes;
    struct rc_leak *leak = rc_leak_new(w->shape, NULL, h, &(struct rc_leak_options){0}, NULL);

    (void)p;
    if (leak == NULL)
        return 0;
    bytes = memory_held() - before + rc_leak_step_memory(leak);
    while (rc_leak_step(leak, NULL) == RC_MORE)
        continue;
    rc_leak_free(leak);
    return bytes;
}
#endif

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

/* Slabs of strain, up and down: at most 64 bytes a node and slab, or 32. */
static size_t
slabs_in(const struct work *w, enum rc_precision precision, const double *h, const double *p)
{
    static const double thickness[] = {1e-6, 1e-6, 2e-6, 2e-6, 4e-6, 4e-6, 8e-6, 8e-6, 8e-6};
    const struct rc_slabs_options options = {
        .slabs = 9, .thickness = thickness, .shear = 1e9, .nu = 0.3, .precision = precision};
    size_t bytes = rc_slabs_memory(w->shape, &options);
    const double *heights = h;
    const struct rc_slab_strain strain = {NULL, slab_strain, &heights};
    const struct rc_slab_stress stress = {NULL, slab_stress, NULL};
    struct rc_slabs *slabs = rc_slabs_new(w->shape, &options, NULL);

    if (slabs == NULL || bytes > (precision == RC_SINGLE ? 32u : 64u) * 9 * nodes_of(w)) {
        rc_slabs_free(slabs);
        return 0;
    }
    rc_slabs_up(slabs, &strain, NULL);
    rc_slabs_down(slabs, p, &stress);
    rc_slabs_free(slabs);
    return bytes;
}

static size_t
slabs_double(const struct work *w, const double *h, const double *p)
{
    return slabs_in(w, RC_DOUBLE, h, p);
}

static size_t
slabs_single(const struct work *w, const double *h, const double *p)
{
    return slabs_in(w, RC_SINGLE, h, p);
}

/* Of dissimilar bodies, to a tenth. */
static size_t
friction(const struct work *w, const double *h, const double *p)
{
    const struct rc_slip_problem problem = {
        .boundary = w->boundary, .pair.one = {.e = 3e9, .nu = 0.3}, .mu = 0.3, .tol = 0.1};
    size_t bytes = rc_slip_memory(w->shape, &problem);
    struct rc_slip *slip = rc_slip_new(w->shape, &problem, NULL);
    enum rc_status status = RC_FAIL;

    (void)h;
    if (slip != NULL && rc_slip_set_pressure(slip, p, NULL, NULL) == RC_OK &&
        rc_slip_set_force(slip, 1e4 * (double)nodes_of(w) * w->shape->dx * w->shape->dy, 0, NULL) ==
            RC_OK)
        do
            status = rc_slip_step(slip, NULL);
        while (status == RC_MORE);
    rc_slip_free(slip);
    return status == RC_OK ? bytes : 0;
}

static size_t
states_of(const struct rc_adhesion *a)
{
    struct rc_adhesion_progress progress;

    rc_adhesion_progress(a, &progress);
    return progress.state;
}

/* A state to its end, with its eigenvalue, and four of a retraction. */
static size_t
adhesion(const struct work *w, const double *h, const double *p)
{
    const struct rc_adhesion_problem problem = {
        .contact = {.boundary = w->boundary, .pair.estar = 3e9, .tol = 1e-3},
        .work = 0.1,
        .law = "jkr"};
    size_t bytes =
        rc_adhesion_memory(w->shape, &problem) + rc_adhesion_pull_off_memory(w->shape, &problem);
    struct rc_adhesion *a = rc_adhesion_new(w->shape, h, &problem, NULL);
    enum rc_status status = RC_FAIL;

    (void)p;
    if (a != NULL && rc_adhesion_set_approach(a, 1e-8, NULL) == RC_OK) {
        while ((status = rc_adhesion_step(a, NULL)) == RC_MORE)
            ;
        status = rc_adhesion_pull_off(a, NULL);
        while (status != RC_FAIL && states_of(a) <= 4 &&
               (status = rc_adhesion_step(a, NULL)) == RC_MORE)
            ;
    }
    rc_adhesion_free(a);
    return status != RC_FAIL ? bytes : 0;
}

/* And the contact with it. */
static size_t
friction_found(const struct work *w, const double *h, const double *p)
{
    double load = 1e5 * (double)nodes_of(w) * w->shape->dx * w->shape->dy;
    const struct rc_joint_problem problem = {.contact = {.boundary = w->boundary,
                                                         .pair.one = {.e = 3e9, .nu = 0.3},
                                                         .load = load,
                                                         .tol = 0.01},
                                             .slip = {.mu = 0.3, .tol = 0.1}};
    struct rc_joint *joint = rc_joint_new(w->shape, h, &problem, NULL);
    enum rc_status status = RC_FAIL;

    (void)p;
    if (joint != NULL && rc_joint_set_force(joint, load, 0.1 * load, 0, NULL) == RC_OK)
        do
            status = rc_joint_step(joint, NULL);
        while (status == RC_MORE);
    rc_joint_free(joint);
    return status == RC_OK ? rc_joint_memory(w->shape, &problem, true) : 0;
}

/* Of the voxels that have yielded in the end, a tenth at least: no others have taken memory. */
static size_t
yielding(const struct work *w, const double *h, const double *p)
{
    enum {
        SLABS = 12
    };
    double thickness[SLABS];
    struct rc_plastic_problem problem = {.contact = {.boundary = w->boundary,
                                                     .pair.one = {.e = 3e9, .nu = 0.3},
                                                     .pair.two.e = INFINITY},
                                         .yield = {.stress = 1e7, .modulus = 1e8},
                                         .slabs = SLABS,
                                         .thickness = thickness,
                                         .increments = 1,
                                         .lag = 0.5};
    double load = 1e7 * (double)nodes_of(w) * w->shape->dx * w->shape->dy;
    struct rc_plastic *plastic;
    enum rc_status status = RC_FAIL;
    size_t bytes = 0;

    (void)p;
    for (int k = 0; k < SLABS; k++)
        thickness[k] = 1e-6;
    plastic = rc_plastic_new(w->shape, h, &problem, NULL);
    if (plastic != NULL && rc_plastic_set_load(plastic, load, NULL) == RC_OK)
        do
            status = rc_plastic_step(plastic, NULL);
        while (status == RC_MORE);
    if (status != RC_FAIL) {
        double yielded = (double)rc_plastic_result(plastic)->voxels / (double)(nodes_of(w) * SLABS);
        bytes = yielded < 0.1 ? 0 : rc_plastic_memory(w->shape, &problem, yielded);
    }
    rc_plastic_free(plastic);
    return bytes;
}

/* In a child: as an exit status, 0 when the memory it took agrees with the estimate. */
static int
measured(const struct work *w)
{
    size_t n = nodes_of(w), before, said, took;
    double *h = malloc(n * sizeof *h), *p = malloc(n * sizeof *p);

    memory_keep_maps_apart();
    if (h == NULL || p == NULL)
        return 2;
    for (size_t k = 0; k < n; k++) { /* waves a few nodes long, and pressure in strips of a fifth */
        size_t i = k % w->shape->nx, j = k / w->shape->nx;
        h[k] = 1e-7 * (2 + sin(0.31 * (double)i) + cos(0.23 * (double)j) +
                       0.1 * (double)(k * 7919 % 97) / 97);
        p[k] = k * 7919 % 15 < 3 || i % 15 < 3 ? 1e6 : 0;
    }
    before = memory_held();
    if ((said = w->run(w, h, p)) == 0)
        return 3;
    took = memory_peak() - before;
    if ((double)said <= (1 + tenth) * (double)took &&
        (double)said >= (1 - tenth) * (double)took - (double)w->code)
        return 0;
    fprintf(stderr, "%s: %.1f MiB said, %.1f MiB taken\n", w->name, (double)said / (1 << 20),
            (double)took / (1 << 20));
    return 1;
}

static const size_t transforms = 5 << 19; /* of one precision */

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
#ifdef RC_LEAK
        {"channels of a gap", &map, RC_FREE, NULL, 0, leak_found},
        {"flow through it", &map, RC_FREE, NULL, 0, leak_solved},
#endif
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
#ifndef __SANITIZE_ADDRESS__ /* it takes memory of its own */
    assert_int_equal(missed, 0);
#endif
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(holds)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
