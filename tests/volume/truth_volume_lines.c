/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The volume under a map that repeats along one axis. Stresses under a line load in closed form; strain
 * beside a map that repeats after many times its width. Pressure and strain act on each other in the same way
 * in both directions, equal rows are one row, and a turned map gives the turned stresses. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "volume_case.h"

static const double h[] = {0.9, 1.3, 0.7, 2.1, 3};
enum {
    SLABS = sizeof h / sizeof *h
};
static const struct rc_boundary along[] = {{.x = true}, {.y = true}};

static struct rc_slabs_options
options_of(struct rc_boundary boundary)
{
    return (struct rc_slabs_options){
        .boundary = boundary, .slabs = SLABS, .thickness = h, .shear = 3, .nu = 0.3, .whole = true};
}

/* ---- line loads ---- */

/* Stresses at x and the depth z under a unit load at 0 per length, without its sign (Flamant; Johnson 1985,
 * 2.3). */
static void
flamant(double x, double z, double s[RC_COMPONENTS])
{
    const double r2 = x * x + z * z, f = -2 * z / (exact_pi * r2 * r2);

    memset(s, 0, RC_COMPONENTS * sizeof *s);
    s[RC_SXX] = f * x * x;
    s[RC_SZZ] = f * z * z;
    s[RC_SXZ] = f * x * z;
    s[RC_SYY] = 0.3 * (s[RC_SXX] + s[RC_SZZ]);
}

/* Two smooth loads, cos^2 over 2 WIDE nodes. The images at 32 times the width of the map leave errors of some
 * 1e-4 of the pressure; those at twice the width would leave 5e-2. */
static void
stresses_of_line_loads(void **state)
{
    enum {
        N = 48,
        WIDE = 9,
        POINTS = 8,
        FINE = 40
    };
    const double place[] = {0, -13}, size[] = {1, 0.4};

    (void)state;
    for (int axis = 0; axis < 2; axis++) {
        const struct rc_shape shape =
            axis == 0 ? (struct rc_shape){2, N, 1.7, 1} : (struct rc_shape){N, 2, 1, 1.7};
        struct rc_slabs *v = volume_new(shape, options_of(along[axis]));
        struct voxels s = voxels_new(shape, SLABS);
        double p[2 * N] = {0}, worst = 0, top = 0;

        for (size_t k = 0; k < 2 * N; k++)
            for (int load = 0; load < 2; load++) {
                double x = (double)(axis == 0 ? k / 2 : k % N) - (N - 1) / 2.0 - place[load];
                if (fabs(x) < WIDE)
                    p[k] += size[load] * pow(cos(exact_pi * x / (2 * WIDE)), 2);
            }
        volume_apply(v, NULL, NULL, p, NULL, &s);
        for (size_t slab = 0; slab < SLABS; slab++) {
            for (size_t i = 0; i < N; i++) {
                double exact[RC_COMPONENTS] = {0};
                for (int q = 0; q < POINTS; q++) /* the mean over the slab */
                    for (int load = 0; load < 2; load++)
                        for (int k = -WIDE * FINE; k < WIDE * FINE; k++) {
                            double at = (k + 0.5) / FINE, one[RC_COMPONENTS];
                            flamant((double)i - (N - 1) / 2.0 - place[load] - at,
                                    top + h[slab] * (q + 0.5) / POINTS, one);
                            for (int c = 0; c < RC_COMPONENTS; c++)
                                exact[c] += one[c] * size[load] / FINE / POINTS *
                                            pow(cos(exact_pi * at / (2 * WIDE)), 2);
                        }
                if (axis == 0) {
                    double xx = exact[RC_SXX];
                    exact[RC_SXX] = exact[RC_SYY];
                    exact[RC_SYY] = xx;
                    exact[RC_SYZ] = exact[RC_SXZ];
                    exact[RC_SXZ] = 0;
                }
                for (int c = 0; c < RC_COMPONENTS; c++)
                    worst = fmax(
                        worst,
                        fabs(voxels_map(&s, slab, (enum rc_component)c)[axis == 0 ? 2 * i : i] -
                             exact[c]));
            }
            top += h[slab];
        }
        print_message("line loads, %s: stresses within %.1e of the pressure\n",
                      rc_boundary_word(along[axis]), worst);
        assert_true(worst < 4e-4);
        rc_slabs_free(v);
        free(s.v);
    }
}

/* ---- strain ---- */

struct slice {
    double *to; /* RC_COMPONENTS maps */
    size_t nx, n;
};

static void
keep_slice(void *ctx, enum rc_component c, size_t j, const double *row)
{
    const struct slice *s = ctx;

    memcpy(s->to + c * s->n + j * s->nx, row, s->nx * sizeof *row);
}

/* The displacement, the stresses of the slabs, and those of a slice at a depth, of a strain and a pressure.
 * */
struct field {
    double *u, *slice;
    struct voxels s;
};

static struct field
field_of(struct rc_shape shape, struct rc_boundary boundary, struct voxels *e, const double *p)
{
    const size_t n = shape.nx * shape.ny;
    struct field f = {calloc(n, sizeof(double)), calloc(RC_COMPONENTS * n, sizeof(double)),
                      voxels_new(shape, SLABS)};
    struct slice slice = {f.slice, shape.nx, n};
    const struct rc_slab_strain strain = {NULL, voxels_strain, e};
    const struct rc_slice_stress stress = {(1U << RC_COMPONENTS) - 1, keep_slice, &slice};
    struct rc_slabs_options o = options_of(boundary);
    struct rc_slabs *v = volume_new(shape, o);

    volume_apply(v, e, NULL, p, f.u, &f.s);
    rc_slabs_free(v);
    o.slices = true;
    v = volume_new(shape, o);
    rc_slabs_up(v, &strain, NULL);
    rc_slabs_through(v);
    rc_slabs_slice(v, 2.6, &stress);
    rc_slabs_free(v);
    return f;
}

static void
field_free(struct field *f)
{
    free(f->u);
    free(f->slice);
    free(f->s.v);
}

enum {
    WIDE = 24,
    LONG = 16,
    TIMES = 40
};

/* Strain and pressure at column i and row j of a map, which may be turned; `part` varies along the rows. */
static void
put(struct voxels *e, double *p, size_t at, double i, double j, double part, bool turned)
{
    const double x = exp(-i * i / 18), vary = 1 + part * cos(2 * exact_pi * j / LONG);
    const enum rc_component xx = turned ? RC_SYY : RC_SXX, yy = turned ? RC_SXX : RC_SYY,
                            xz = turned ? RC_SYZ : RC_SXZ, yz = turned ? RC_SXZ : RC_SYZ;

    p[at] = x * (2 + i / 20) * vary;
    for (size_t k = 0; k < SLABS; k++) {
        const double size = 0.01 * x * vary * (1 + (double)k) / SLABS;
        voxels_map(e, k, xx)[at] = size;
        voxels_map(e, k, yy)[at] = size * (0.2 - i / 10);
        voxels_map(e, k, RC_SZZ)[at] = -size * (1.2 - i / 10);
        voxels_map(e, k, RC_SXY)[at] = size * part * sin(2 * exact_pi * j / LONG);
        voxels_map(e, k, xz)[at] = size * i / 8;
        voxels_map(e, k, yz)[at] = 0.3 * size * part * (1 - i / 9);
    }
}

/* The map with `rows` rows, and one of TIMES its width, both axes of which repeat. What is uniform along the
 * rows has images at 32 times the width on one map, and at TIMES times on the other. */
static void
strain_beside_a_wide_map(void **state)
{
    (void)state;
    for (int axis = 0; axis < 2; axis++)
        for (int part = 0; part < 2; part++) {
            const bool turned = axis == 0;
            const size_t rows = part == 0 ? 1 : LONG, wide = WIDE * TIMES,
                         off = (TIMES - 1) * WIDE / 2;
            const struct rc_shape small =
                turned ? (struct rc_shape){rows, WIDE, 1, 1} : (struct rc_shape){WIDE, rows, 1, 1};
            const struct rc_shape large =
                turned ? (struct rc_shape){rows, wide, 1, 1} : (struct rc_shape){wide, rows, 1, 1};
            struct voxels e = voxels_new(small, SLABS), b = voxels_new(large, SLABS);
            double *p = calloc(small.nx * small.ny, sizeof *p),
                   *q = calloc(large.nx * large.ny, sizeof *q), most[3] = {0}, size[3] = {0}, rest,
                   mean;
            struct field f, g;

            for (size_t j = 0; j < rows; j++)
                for (size_t i = 0; i < WIDE; i++) {
                    const double x = (double)i - (WIDE - 1) / 2.0, y = (double)j;
                    put(&e, p, turned ? i * rows + j : j * WIDE + i, x, y, part, turned);
                    put(&b, q, turned ? (i + off) * rows + j : j * wide + i + off, x, y, part,
                        turned);
                }
            /* the stress of a mean pressure on a map of several rows, against that of lines */
            mean = rows == 1 ? 0 : 0.2 * rc_sum(q, large.nx * large.ny) / (double)(wide * rows);
            f = field_of(small, along[axis], &e, p);
            g = field_of(large, RC_PERIODIC, &b, q);
            rest = 0; /* far from the strain */
            for (size_t j = 0; j < rows; j++)
                rest += g.u[turned ? j : j * wide] / (double)rows;
            for (size_t j = 0; j < rows; j++)
                for (size_t i = 0; i < WIDE; i++) {
                    const size_t at = turned ? i * rows + j : j * WIDE + i,
                                 there = turned ? (i + off) * rows + j : j * wide + i + off;
                    most[0] = fmax(most[0], fabs(f.u[at] - (g.u[there] - rest)));
                    size[0] = fmax(size[0], fabs(f.u[at]));
                    for (int c = 0; c < RC_COMPONENTS; c++) {
                        const size_t n = small.nx * small.ny, m = large.nx * large.ny;
                        for (size_t k = 0; k < SLABS; k++) {
                            double is = voxels_map(&f.s, k, (enum rc_component)c)[at],
                                   are = voxels_map(&g.s, k, (enum rc_component)c)[there];
                            if (c == RC_SXX || c == RC_SYY)
                                are += (c == RC_SXX) == turned ? mean : -mean;
                            most[1] = fmax(most[1], fabs(is - are));
                            size[1] = fmax(size[1], fabs(is));
                        }
                        most[2] = fmax(most[2], fabs(f.slice[(size_t)c * n + at] -
                                                     g.slice[(size_t)c * m + there]));
                        size[2] = fmax(size[2], fabs(f.slice[(size_t)c * n + at]));
                    }
                }
            print_message("%s, %s: displacement %.1e, stresses %.1e, of a slice %.1e apart\n",
                          rc_boundary_word(along[axis]), part == 0 ? "a line" : "waves",
                          most[0] / size[0], most[1] / size[1], most[2] / size[2]);
            assert_true(most[0] < 2e-3 * size[0] && most[1] < 5e-4 * size[1] &&
                        most[2] < 5e-4 * size[2]);
            field_free(&f);
            field_free(&g);
            free(e.v);
            free(b.v);
            free(p);
            free(q);
        }
}

/* p . u(e) = e . S p for every p without a mean, a . G b = b . G a. */
static void
is_reciprocal(void **state)
{
    static const struct rc_shape shapes[] = {{15, 12, 1, 0.8}, {1, 23, 1, 0.6}, {24, 1, 0.6, 1}};
    static const struct rc_boundary boundaries[] = {{.y = true}, {.x = true}, {.y = true}};

    (void)state;
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++) {
        struct rc_shape s = shapes[k];
        size_t n = s.nx * s.ny;
        uint64_t seed = 17 + k;
        struct rc_slabs *v = volume_new(s, options_of(boundaries[k]));
        struct voxels a = voxels_new(s, SLABS), b = voxels_new(s, SLABS), ga = voxels_new(s, SLABS),
                      gb = voxels_new(s, SLABS), sp = voxels_new(s, SLABS);
        double *p = calloc(n, sizeof *p), *u = calloc(n, sizeof *u), pu = 0, size = 0;
        double mean, asp, agb, bga, scale;

        for (size_t i = 0; i < n; i++)
            p[i] = random_number(&seed);
        mean = rc_sum(p, n) / (double)n;
        for (size_t i = 0; i < n; i++)
            p[i] -= mean;
        voxels_random(&a, 0x1f, &seed);
        voxels_random(&b, 0x1d, &seed);
        volume_apply(v, &a, NULL, NULL, u, &ga);
        volume_apply(v, &b, NULL, NULL, NULL, &gb);
        volume_apply(v, NULL, NULL, p, NULL, &sp);
        for (size_t i = 0; i < n; i++) {
            pu += p[i] * u[i];
            size += fabs(p[i] * u[i]);
        }
        asp = voxels_product(&a, &sp, h);
        agb = voxels_product(&a, &gb, h);
        bga = voxels_product(&b, &ga, h);
        scale = sqrt(voxels_product(&a, &ga, h) * voxels_product(&b, &gb, h));
        print_message("%zu x %zu: %.1e, %.1e\n", s.nx, s.ny, (pu - asp) / size,
                      (agb - bga) / scale);
        assert_true(fabs(pu - asp) < 1e-11 * size && fabs(agb - bga) < 1e-11 * scale);
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

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stresses_of_line_loads),
        cmocka_unit_test(strain_beside_a_wide_map),
        cmocka_unit_test(is_reciprocal),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
