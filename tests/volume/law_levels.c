/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws of slabs with fewer nodes: reciprocity, symmetry, and strain of long waves, which such slabs represent
 * exactly. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "volume_case.h"

static const double h[] = {0.5, 0.6, 0.8, 1, 1.3, 1.6, 2, 2.5, 3.1, 3.9, 4.9, 6.1};
enum {
    SLABS = sizeof h / sizeof *h
};
static const struct {
    struct rc_shape shape;
    struct rc_boundary boundary;
    size_t deepest; /* level */
} maps[] = {{{64, 32, 1, 0.8}, {.x = true, .y = true}, 1},
            {{96, 128, 0.7, 1}, {.x = true, .y = true}, 2},
            {{100, 68, 1, 1}, {.x = true, .y = true}, 2},
            {{64, 64, 1, 1}, {0}, 2},
            {{35, 64, 1, 1}, {.x = true, .y = true}, 0}};
enum {
    MAPS = sizeof maps / sizeof *maps
};

/* Numbers of one of the maps, with the nodes that each slab has. */
struct numbers {
    const struct rc_slabs *slabs;
    struct rc_shape shape;
    double *v;
};

static double *
map_of(const struct numbers *x, size_t slab, size_t c)
{
    return x->v + (slab * RC_COMPONENTS + c) * x->shape.nx * x->shape.ny;
}

static size_t
wide(const struct numbers *x, size_t slab)
{
    return x->shape.nx >> rc_slabs_level(x->slabs, slab);
}

static size_t
nodes(const struct numbers *x, size_t slab)
{
    return wide(x, slab) * (x->shape.ny >> rc_slabs_level(x->slabs, slab));
}

static struct numbers
numbers_new(const struct rc_slabs *slabs, struct rc_shape shape)
{
    struct numbers x = {slabs, shape, calloc(shape.nx * shape.ny * SLABS * RC_COMPONENTS, 8)};

    assert_non_null(x.v);
    return x;
}

static bool
strain_row(void *ctx, size_t slab, enum rc_component c, size_t j, double *row)
{
    const struct numbers *x = ctx;

    memcpy(row, map_of(x, slab, c) + j * wide(x, slab), wide(x, slab) * sizeof *row);
    return true;
}

static void
stress_row(void *ctx, size_t slab, size_t j, double *const s[RC_COMPONENTS])
{
    const struct numbers *x = ctx;

    for (size_t c = 0; c < RC_COMPONENTS; c++)
        if (s[c] != NULL)
            memcpy(map_of(x, slab, c) + j * wide(x, slab), s[c], wide(x, slab) * sizeof **s);
    for (size_t i = 0; i < wide(x, slab); i++)
        map_of(x, slab, RC_SZZ)[j * wide(x, slab) + i] = -s[RC_SXX][i] - s[RC_SYY][i];
}

static void
apply(struct rc_slabs *v, const struct numbers *e, const double *p, double *u, struct numbers *s)
{
    const bool none[SLABS] = {false};
    const struct rc_slab_strain strain = {e == NULL ? none : NULL, strain_row, (void *)e};
    const struct rc_slab_stress stress = {NULL, stress_row, s};

    rc_slabs_up(v, &strain, u);
    rc_slabs_down(v, p, &stress);
}

static void
fill(struct numbers *x, uint64_t *seed)
{
    for (size_t k = 0; k < SLABS; k++) {
        for (size_t c = 0; c < RC_COMPONENTS; c++)
            for (size_t i = 0; i < nodes(x, k); i++)
                map_of(x, k, c)[i] = random_number(seed);
        for (size_t i = 0; i < nodes(x, k); i++)
            map_of(x, k, RC_SZZ)[i] = -map_of(x, k, RC_SXX)[i] - map_of(x, k, RC_SYY)[i];
    }
}

/* The sum over the volume of a : b. */
static double
product(const struct numbers *a, const struct numbers *b)
{
    double sum = 0;

    for (size_t k = 0; k < SLABS; k++)
        for (size_t c = 0; c < RC_COMPONENTS; c++)
            for (size_t i = 0; i < nodes(a, k); i++)
                sum += (c < RC_SXY ? 1 : 2) * ldexp(h[k], 2 * (int)rc_slabs_level(a->slabs, k)) *
                       map_of(a, k, c)[i] * map_of(b, k, c)[i];
    return sum;
}

static struct rc_slabs *
slabs_new(size_t map, double coarser, size_t threads)
{
    return volume_new(maps[map].shape, (struct rc_slabs_options){.boundary = maps[map].boundary,
                                                                 .slabs = SLABS,
                                                                 .thickness = h,
                                                                 .coarser = coarser,
                                                                 .shear = 3,
                                                                 .nu = 0.3,
                                                                 .threads = threads});
}

/* p . u(e) = e : S p for every p without a mean, a : G b = b : G a, 0 < a : G a <= 2 mu a : a. */
static void
is_reciprocal(void **state)
{
    (void)state;
    for (size_t m = 0; m < MAPS; m++) {
        const struct rc_shape shape = maps[m].shape;
        const size_t n = shape.nx * shape.ny;
        struct rc_slabs *v = slabs_new(m, 0.4, 1);
        struct numbers a = numbers_new(v, shape), b = numbers_new(v, shape),
                       ga = numbers_new(v, shape), gb = numbers_new(v, shape),
                       sp = numbers_new(v, shape);
        double *p = calloc(n, sizeof *p), *u = calloc(n, sizeof *u), pu = 0, size = 0, mean = 0;
        uint64_t seed = 3 + m;

        assert_int_equal(rc_slabs_level(v, SLABS - 1), maps[m].deepest);
        fill(&a, &seed);
        fill(&b, &seed);
        for (size_t i = 0; i < n; i++)
            mean += p[i] = random_number(&seed);
        for (size_t i = 0; i < n; i++)
            p[i] -= mean / (double)n;
        apply(v, &a, NULL, u, &ga);
        apply(v, &b, NULL, NULL, &gb);
        apply(v, NULL, p, NULL, &sp);
        for (size_t i = 0; i < n; i++) {
            pu += p[i] * u[i];
            size += fabs(p[i] * u[i]);
        }
        print_message("%zu x %zu: reciprocal to %.1e, symmetric to %.1e\n", shape.nx, shape.ny,
                      (pu - product(&a, &sp)) / size, product(&a, &gb) / product(&b, &ga) - 1);
        assert_true(fabs(pu - product(&a, &sp)) < rounding * size);
        assert_true(fabs(product(&a, &gb) - product(&b, &ga)) < -rounding * product(&a, &ga));
        assert_true(product(&a, &ga) < 0); /* stress is -G e */
        assert_true(-product(&a, &ga) <= 2 * 3 * product(&a, &a));
        rc_slabs_free(v);
        free(a.v);
        free(b.v);
        free(ga.v);
        free(gb.v);
        free(sp.v);
        free(p);
        free(u);
    }
}

/* Strain and pressure of waves that the coarsest slabs have give the same displacement and stresses, at all
 * nodes that a slab has, as slabs with all nodes. */
static void
is_exact_for_long_waves(void **state)
{
    (void)state;
    for (size_t m = 0; m < MAPS; m++) {
        const struct rc_shape shape = maps[m].shape;
        const size_t n = shape.nx * shape.ny;
        struct rc_slabs *v = slabs_new(m, 0.4, 1), *all = slabs_new(m, 0, 1);
        struct numbers a = numbers_new(v, shape), b = numbers_new(all, shape),
                       ga = numbers_new(v, shape), gb = numbers_new(all, shape);
        double *p = calloc(n, sizeof *p), *u = calloc(n, sizeof *u), *w = calloc(n, sizeof *w);
        double most = 0, size = 0, off = 0, large = 0;

        if (!rc_has_mean(maps[m].boundary)) { /* a free map has no waves of its own */
            for (size_t j = 0; j < shape.ny; j++)
                for (size_t i = 0; i < shape.nx; i++)
                    for (size_t k = 0; k < SLABS; k++)
                        for (size_t c = 0; c < RC_COMPONENTS; c++) {
                            const size_t level = rc_slabs_level(v, k);
                            const double x = 2 * exact_pi * (double)i / (double)shape.nx,
                                         y = 2 * exact_pi * (double)j / (double)shape.ny,
                                         wave = (double)(1 + k) * cos(2 * x - 3 * y + (double)c) +
                                                (double)(1 + c) * cos(x + 2 * y - (double)k);
                            map_of(&b, k, c)[j * shape.nx + i] = c == RC_SZZ ? 0 : wave;
                            if (i % ((size_t)1 << level) == 0 && j % ((size_t)1 << level) == 0)
                                map_of(&a, k, c)[(j >> level) * wide(&a, k) + (i >> level)] =
                                    c == RC_SZZ ? 0 : wave;
                            p[j * shape.nx + i] = 2 + wave;
                        }
            apply(v, &a, p, u, &ga);
            apply(all, &b, p, w, &gb);
            for (size_t i = 0; i < n; i++) {
                most = fmax(most, fabs(u[i] - w[i]));
                size = fmax(size, fabs(w[i]));
            }
            for (size_t k = 0; k < SLABS; k++) {
                double *map = calloc(n, sizeof *map);
                memcpy(map, map_of(&ga, k, RC_SXZ), nodes(&ga, k) * sizeof *map);
                rc_slabs_refine(v, k, map);
                for (size_t i = 0; i < n; i++) {
                    off = fmax(off, fabs(map[i] - map_of(&gb, k, RC_SXZ)[i]));
                    large = fmax(large, fabs(map_of(&gb, k, RC_SXZ)[i]));
                }
                free(map);
            }
            print_message("%zu x %zu: displacement to %.1e, stress to %.1e\n", shape.nx, shape.ny,
                          most / size, off / large);
            assert_true(most < rounding * size && off < rounding * large);
        }
        rc_slabs_free(v);
        rc_slabs_free(all);
        free(a.v);
        free(b.v);
        free(ga.v);
        free(gb.v);
        free(p);
        free(u);
        free(w);
    }
}

/* Any number of threads gives the same bytes. */
static void
for_any_threads(void **state)
{
    const struct rc_shape shape = maps[1].shape;
    const size_t n = shape.nx * shape.ny;
    struct rc_slabs *v = slabs_new(1, 0.4, 1), *w = slabs_new(1, 0.4, 3);
    struct numbers a = numbers_new(v, shape), ga = numbers_new(v, shape),
                   gb = numbers_new(v, shape);
    double *u[2] = {calloc(n, sizeof **u), calloc(n, sizeof **u)};
    uint64_t seed = 1;

    (void)state;
    fill(&a, &seed);
    apply(v, &a, map_of(&a, 0, 0), u[0], &ga);
    for (int again = 0; again < 2; again++) {
        apply(w, &a, map_of(&a, 0, 0), u[1], &gb);
        assert_memory_equal(u[0], u[1], n * sizeof **u);
        assert_memory_equal(ga.v, gb.v, n * SLABS * RC_COMPONENTS * sizeof *ga.v);
    }
    rc_slabs_free(v);
    rc_slabs_free(w);
    free(a.v);
    free(ga.v);
    free(gb.v);
    free(u[0]);
    free(u[1]);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_reciprocal),
        cmocka_unit_test(is_exact_for_long_waves),
        cmocka_unit_test(for_any_threads),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
