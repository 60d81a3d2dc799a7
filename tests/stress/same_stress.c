/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Different ways to compute the same stress agree. Each computes only what is needed: sections and slices,
 * engines, threads, one component or all; a table of counts. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

enum {
    SIX = (1 << RC_COMPONENTS) - 1,
    ALL = (1 << RC_STRESSES) - 1
};

struct scene {
    struct rc_shape shape;
    double *p, largest;
};

/* Pressure on an off-centre patch with gaps in it; on a line of nodes the patch lies on the line. */
static struct scene
scene_new(size_t nx, size_t ny, double dx, double dy)
{
    struct scene s = {.shape = {nx, ny, dx, dy}, .p = malloc(nx * ny * sizeof(double))};
    uint64_t seed = 1927;

    for (size_t k = 0; k < nx * ny; k++) {
        double x = (double)(k % nx) / (double)nx - 0.45, y = (double)(k / nx) / (double)ny - 0.55;
        double r = 2.2 * hypot(nx > 1 ? x : 0, ny > 1 ? y : 0), u = random_number(&seed);
        s.p[k] = r < 1 && u > -0.2 ? 1e9 * (0.6 + 0.5 * u) * sqrt(1 - r * r) : 0;
        s.largest = fmax(s.largest, s.p[k]);
    }
    return s;
}

static void
compute(const struct scene *s, struct rc_stress_options o, double z, double *out[RC_STRESSES],
        struct rc_stress_counts *counts)
{
    struct rc_err err = {""};
    struct rc_stress *stress = rc_stress_new(&s->shape, s->p, &o, &err);

    if (stress == NULL)
        print_error("%s\n", err.text);
    assert_non_null(stress);
    for (int c = 0; c < RC_STRESSES; c++) {
        out[c] = NULL;
        if (o.wanted >> c & 1)
            out[c] = malloc(rc_stress_values(stress) * sizeof(double));
    }
    assert_int_equal(rc_stress_slice(stress, z, out, &err), RC_OK);
    if (counts != NULL)
        *counts = *rc_stress_counted(stress);
    rc_stress_free(stress);
}

static void
release(double *out[RC_STRESSES])
{
    for (int c = 0; c < RC_STRESSES; c++)
        free(out[c]);
}

static double
apart(size_t n, double *const a[RC_STRESSES], double *const b[RC_STRESSES])
{
    double worst = 0;

    for (int c = 0; c < RC_STRESSES; c++)
        for (size_t k = 0; a[c] != NULL && b[c] != NULL && k < n; k++)
            worst = fmax(worst, fabs(a[c][k] - b[c][k]));
    return worst;
}

/* ---- engines ---- */

static void
engines_agree(void **state)
{
    static const struct {
        size_t nx, ny;
        double dx, dy, mu;
    } maps[] = {{33, 47, 1.1e-6, 1e-6, 0}, {40, 25, 1e-6, 2.3e-6, 0.37},
                {1, 17, 1, 1, 0.2},        {17, 1, 1, 1, 0},
                {1, 1, 1, 1, 0.1},         {61, 7, 1, 0.1, -0.4}};

    (void)state;
    for (size_t m = 0; m < sizeof maps / sizeof *maps; m++)
        for (double z = 0; z < 9; z = 3 * z + 0.4) {
            struct scene s = scene_new(maps[m].nx, maps[m].ny, maps[m].dx, maps[m].dy);
            struct rc_stress_options o = {
                .body.nu = 0.28, .mu = maps[m].mu, .wanted = ALL, .threads = 2};
            size_t n = s.shape.nx * s.shape.ny;
            double *a[RC_STRESSES], *b[RC_STRESSES];
            compute(&s, o, z * s.shape.dx, a, NULL);
            o.engine = "direct";
            compute(&s, o, z * s.shape.dx, b, NULL);
            assert_true(apart(n, a, b) <= rounding * fmax(s.largest, 1));
            release(b);
            o.engine = "mlms";
            o.wanted = SIX;
            for (double tol = 1e-2; tol > 1e-7; tol /= 100) {
                o.tol = tol;
                compute(&s, o, z * s.shape.dx, b, NULL);
                if (apart(n, a, b) > tol * s.largest)
                    print_error("map %zu, depth %g, tol %g: off by %g\n", m, z, tol,
                                apart(n, a, b) / s.largest);
                assert_true(apart(n, a, b) <= tol * s.largest);
                release(b);
            }
            release(a);
            free(s.p);
        }
}

/* fft, fft64 and auto use the same code here: results are equal to the last bit, on any boundary. Each
 * reports its own name. */
static void
transforms_by_any_name(void **state)
{
    static const char *const asked[] = {NULL, "auto", "fft", "fft64"};
    static const char *const told[] = {"fft", "fft", "fft", "fft64"};
    struct scene s = scene_new(40, 30, 1e-6, 1.2e-6);
    double *a[RC_STRESSES], *b[RC_STRESSES];

    (void)state;
    for (int boundary = 0; boundary < BOUNDARIES; boundary++)
        for (size_t k = 0; k < 4; k++) {
            struct rc_stress_options o = {
                .boundary = each_boundary[boundary], .body.nu = 0.3, .mu = 0.2, .wanted = ALL};
            struct rc_err err;
            struct rc_stress *stress;
            compute(&s, o, 2e-6, a, NULL);
            o.engine = asked[k];
            compute(&s, o, 2e-6, b, NULL);
            assert_true(apart(40 * 30, a, b) == 0);
            stress = rc_stress_new(&s.shape, s.p, &o, &err);
            assert_string_equal(rc_stress_engine(stress), told[k]);
            rc_stress_free(stress);
            release(a);
            release(b);
        }
    free(s.p);
}

static void
engines_refused(void **state)
{
    struct scene s = scene_new(8, 8, 1e-6, 1e-6);
    struct rc_stress_options o = {.body.nu = 0.3, .wanted = SIX, .engine = "fftw"};
    struct rc_err err;
    char text[256];

    (void)state;
    assert_null(rc_stress_new(&s.shape, s.p, &o, &err));
    assert_string_equal(err.text,
                        "there is no engine 'fftw': take one of auto, fft, fft64, mlms, direct");
    o.engine = "mlms";
    o.section = 'y';
    assert_null(rc_stress_new(&s.shape, s.p, &o, &err));
    assert_string_equal(err.text,
                        "a section is summed by fft, not by mlms: leave the kernel to auto");
    o.section = 0;
    for (int boundary = 1; boundary < BOUNDARIES; boundary++)
        for (int engine = 0; engine < 2; engine++) {
            o.boundary = each_boundary[boundary];
            o.engine = engine == 0 ? "mlms" : "direct";
            assert_null(rc_stress_new(&s.shape, s.p, &o, &err));
            snprintf(
                text, sizeof text,
                "the sums of the engine '%s' have no end on a %s boundary: leave the choice to "
                "auto, or take 'fft'",
                o.engine, rc_boundary_word(o.boundary));
            assert_string_equal(err.text, text);
        }
    free(s.p);
}

/* ---- tolerances ---- */

/* With a sufficient tolerance slices are summed in single precision, and deep ones on grids that are coarser
 * along free axes. The error of all stresses is at most the tolerance, also for random signs. With a smaller
 * tolerance, or with fft64, no bit differs. */
static void
within_tolerance(void **state)
{
    static const struct {
        size_t nx, ny;
        double dx, dy;
    } maps[] = {{150, 131, 1e-6, 1e-6}, {200, 64, 1e-6, 3e-6}, {300, 1, 1e-6, 1e-6}};
    size_t coarse = 0;

    (void)state;
    for (size_t m = 0; m < 3 * BOUNDARIES; m++)
        for (int signs = 0; signs < 3; signs++) /* random signs, then derived stresses too */
            for (double tol = 1e-1; tol > 1e-8; tol /= 40) {
                struct scene s = scene_new(maps[m / BOUNDARIES].nx, maps[m / BOUNDARIES].ny,
                                           maps[m / BOUNDARIES].dx, maps[m / BOUNDARIES].dy);
                size_t n = s.shape.nx * s.shape.ny;
                double worst = 0;
                uint64_t seed = 77;
                for (size_t k = 0; signs && k < n; k++)
                    s.p[k] = random_number(&seed) > 0 ? s.largest : -s.largest;
                for (double z = 2e-6; z < 3e-4; z *= m % BOUNDARIES < 2 ? 2.1 : 4.4) {
                    struct rc_stress_options o = {.boundary = each_boundary[m % BOUNDARIES],
                                                  .body.nu = 0.3,
                                                  .mu = 0.25,
                                                  .wanted = signs < 2 ? SIX : ALL,
                                                  .threads = 2};
                    double *a[RC_STRESSES], *b[RC_STRESSES];
                    struct rc_stress_counts counts;
                    compute(&s, o, z, a, NULL);
                    o.tol = tol;
                    compute(&s, o, z, b, &counts);
                    worst = fmax(worst, apart(n, a, b) / s.largest);
                    if (counts.coarse_depths == 0)
                        assert_true((apart(n, a, b) > 0) == (tol > 1e-5));
                    coarse += counts.coarse_depths;
                    release(b);
                    o.engine = "fft64";
                    compute(&s, o, z, b, &counts);
                    if (counts.coarse_depths == 0)
                        assert_true(apart(n, a, b) == 0);
                    release(a);
                    release(b);
                }
                if (m < BOUNDARIES || worst > tol)
                    print_message("%s map, %s pressure, tolerance %.0e: error %.1e\n",
                                  rc_boundary_word(each_boundary[m % BOUNDARIES]),
                                  signs ? "random" : "contact", tol, worst);
                assert_true(worst <= tol);
                free(s.p);
            }
    assert_true(coarse > 60);
}

/* The estimated errors by the tolerance, against sums of all pairs without transforms or coarser grids:
 * none is below the sum of |error| over the sum of |stress|. Rough pressures, random signs, and waves of 5
 * nodes; pressure alone, friction, and a map of traction. Coarser grids are tried. */
static void
estimates_hold(void **state)
{
    size_t tried = 0, coarse = 0, ample = 0;

    (void)state;
    for (int kind = 0; kind < 3; kind++)
        for (int load = 0; load < 3; load++) {
            struct scene s = scene_new(72, 80, 1e-6, kind == 2 ? 1.4e-6 : 1e-6);
            const size_t n = s.shape.nx * s.shape.ny;
            uint64_t seed = 77 + (uint64_t)load;
            struct rc_stress_options o = {.body.nu = 0.3,
                                          .mu = load == 1 ? 0.25 : 0,
                                          .wanted = ALL,
                                          .threads = 2,
                                          .estimate = true};
            for (size_t k = 0; kind > 0 && k < n; k++)
                s.p[k] =
                    kind == 1 ? random_number(&seed) : 1 + cos(2 * 3.14159 / 5 * (double)(k % 72));
            if (load == 2)
                o.traction[0] = s.p;
            for (double z = 9e-6; z < 30e-6; z *= 2.5) {
                double *truth[RC_STRESSES], *found[RC_STRESSES];
                o.engine = "direct";
                o.tol = 0;
                compute(&s, o, z, truth, NULL);
                o.engine = NULL;
                for (o.tol = 0.1; o.tol > 1e-6; o.tol /= 12) {
                    struct rc_stress_counts counts;
                    compute(&s, o, z, found, &counts);
                    coarse += counts.coarse_depths;
                    for (int c = 0; c < RC_STRESSES; c++) {
                        double off = 0, size = 0;
                        for (size_t k = 0; k < n; k++) {
                            off += fabs(found[c][k] - truth[c][k]);
                            size += fabs(truth[c][k]);
                        }
                        tried++;
                        ample += counts.error[c] > 12 * off / size;
                        if (!(counts.error[c] >= off / size))
                            print_error("kind %d, load %d, depth %g, tol %g, %s: %.2e, told %.2e\n",
                                        kind, load, z, o.tol, rc_component_names[c], off / size,
                                        counts.error[c]);
                        /* below 1e-11 the truth has rounding errors of its own */
                        assert_true(counts.error[c] >= off / size || off < 1e-11 * size);
                    }
                    release(found);
                }
                release(truth);
            }
            free(s.p);
        }
    print_message("%zu estimates, %zu depths on coarser grids, %zu estimates above 12 errors\n",
                  tried, coarse, ample);
    assert_true(coarse > 25 && 3 * ample < 2 * tried);
}

/* The share of the told change that the whole error of the loads makes on one cell. */
static void
one_cell_within(const struct scene *s, struct rc_stress_options o, double z, size_t at, double told,
                double least[RC_STRESSES])
{
    const size_t n = s->shape.nx * s->shape.ny;
    struct rc_stress_counts counts;
    double *before[RC_STRESSES], *after[RC_STRESSES], *map, kept, sum = 0;
    struct scene other = *s;

    o.estimate = true;
    if (o.traction[1] != NULL) {
        o.traction_error = told;
        map = (double *)(uintptr_t)o.traction[1];
        for (size_t k = 0; k < n; k++)
            sum += hypot(o.traction[0] == NULL ? 0 : o.traction[0][k], map[k]);
    } else {
        o.pressure_error = told;
        map = other.p;
        for (size_t k = 0; k < n; k++)
            sum += fabs(map[k]);
    }
    compute(s, o, z, before, &counts);
    o.estimate = false;
    kept = map[at];
    map[at] += told * sum;
    compute(&other, o, z, after, NULL);
    map[at] = kept;
    for (int c = 0; c < RC_STRESSES; c++) {
        double change = 0, size = 0;
        for (size_t k = 0; k < n; k++) {
            change += fabs(after[c][k] - before[c][k]);
            size += fabs(before[c][k]);
        }
        if (change > 1e-9 * told * size && counts.error[c] < change / size) {
            print_error("%s at %g m, cell %zu: told %g, true %g\n", rc_component_names[c], z, at,
                        counts.error[c], change / size);
            fail();
        }
        if (change > 1e-9 * told * size)
            least[c] = fmin(least[c], counts.error[c] * size / change);
    }
    release(before);
    release(after);
}

/* An error of the loads changes no stress by more than the estimate, whichever cell has the error; and some
 * cell changes the six components by most of it. All boundaries, one material and a coat, pressure, friction
 * and maps of traction. */
static void
errors_of_loads_hold(void **state)
{
    const struct rc_layer coat = {.thickness = 3e-6, .e = 6e11, .nu = 0.2};
    double least[RC_STRESSES], mean = 0;

    (void)state;
    for (int c = 0; c < RC_STRESSES; c++)
        least[c] = INFINITY;
    for (int kind = 0; kind < 12; kind++) {
        struct scene s = scene_new(kind == 7 ? 100 : 44, kind % 6 == 5 ? 1 : 37, 1e-6,
                                   kind % 5 == 4 ? 2e-6 : 1e-6);
        const size_t n = s.shape.nx * s.shape.ny;
        struct rc_stress_options o = {.boundary = {.x = kind & 1, .y = kind & 2 || s.shape.ny == 1},
                                      .body = {.nu = 0.1 * (kind % 6)},
                                      .mu = kind % 3 == 1 ? 0.4 : 0,
                                      .wanted = ALL,
                                      .threads = 1};
        double *map = malloc(n * sizeof *map);

        if (kind % 4 == 3)
            o.body = (struct rc_body){.e = 2e11, .nu = 0.3, .layer = &coat, .layers = 1};
        for (size_t k = 0; k < n; k++)
            map[k] = 0.3 * s.p[n - 1 - k];
        if (kind % 3 == 2) {
            o.traction[0] = s.p;
            o.traction[1] = map;
        }
        for (double z = kind % 2 == 0 ? 0 : 0.3e-6; z < 30e-6; z = 8 * z + 1.3e-6) {
            one_cell_within(&s, o, z, s.shape.ny / 2 * s.shape.nx + s.shape.nx / 2, 0.05, least);
            one_cell_within(&s, o, z, 3, 1e-3, least);
            one_cell_within(&s, o, z, n - 1, 1, least);
        }
        free(map);
        free(s.p);
    }
    for (int c = 0; c < RC_STRESSES; c++)
        mean += least[c] / RC_STRESSES;
    print_message("least estimates over the changes: %.2f on average\n", mean);
    assert_true(mean < 1.2);
}

/* Unknown errors of the loads, and errors of the loads of a section. */
static void
unknown_errors_stay_unknown(void **state)
{
    struct scene s = scene_new(20, 16, 1e-6, 1e-6);
    const struct rc_stress_options all = {
        .body = {.nu = 0.3}, .wanted = ALL, .threads = 1, .estimate = true};

    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        struct rc_stress_options o = all;
        struct rc_stress_counts counts;
        double *out[RC_STRESSES];

        o.pressure_error = kind == 0 ? NAN : kind == 2 ? 0.1 : 0;
        o.traction_error = kind == 1 ? NAN : 0;
        if (kind >= 2)
            o.section = 'x';
        compute(&s, o, 2e-6, out, &counts);
        for (int c = 0; c < RC_STRESSES; c++)
            assert_int_equal(isnan(counts.error[c]), kind < 3);
        release(out);
    }
    free(s.p);
}

/* Without a tolerance deep slices are summed on coarser grids too, to rounding: sections, which have no
 * coarser grid, agree. */
static void
deep_slices_are_exact(void **state)
{
    struct scene s = scene_new(150, 131, 1e-6, 1.2e-6);

    (void)state;
    for (double z = 30e-6; z < 3e-3; z *= 1.6) {
        struct rc_stress_options o = {.body.nu = 0.3, .mu = 0.25, .wanted = ALL, .threads = 2};
        double *map[RC_STRESSES], *line[RC_STRESSES];
        struct rc_stress_counts counts;
        compute(&s, o, z, map, &counts);
        assert_int_equal(counts.coarse_depths, z > 45e-6);
        for (size_t j = 0; j < 131; j += 26) {
            o.section = 'y';
            o.at = ((double)j - 65) * s.shape.dy;
            compute(&s, o, z, line, NULL);
            for (int c = 0; c < RC_STRESSES; c++)
                for (size_t i = 0; i < 150; i++)
                    assert_true(fabs(map[c][j * 150 + i] - line[c][i]) <=
                                rounding / 10 * s.largest);
            release(line);
        }
        release(map);
    }
    free(s.p);
}

/* ---- sections ---- */

/* A section through nodes is a row or a column of the slice. */
static void
sections_are_lines_of_slices(void **state)
{
    static const struct {
        size_t nx, ny;
    } maps[] = {{37, 29}, {36, 30}, {1, 12}, {12, 1}, {1, 1}};

    (void)state;
    for (int boundary = 0; boundary < BOUNDARIES; boundary++)
        for (size_t m = 0; m < 5; m++)
            for (int across = 0; across < 2; across++) {
                struct scene s = scene_new(maps[m].nx, maps[m].ny, 1.1e-6, 0.9e-6);
                struct rc_stress_options o = {.boundary = each_boundary[boundary],
                                              .body.nu = 0.3,
                                              .mu = 0.25,
                                              .wanted = ALL,
                                              .threads = 2};
                size_t nx = s.shape.nx, ny = s.shape.ny, along = across ? ny : nx;
                double *map[RC_STRESSES], *line[RC_STRESSES];
                /* some waves do not reach the last but one depth, and almost none reach the last */
                for (double z = 0; z < 1e-4; z += z < 4e-6 ? 1.3e-6 : 3 * z) {
                    o.section = 0;
                    compute(&s, o, z, map, NULL);
                    o.section = across ? 'x' : 'y';
                    for (size_t at = 0; at < (across ? nx : ny); at += 3) {
                        o.at = across ? ((double)at - (double)(nx - 1) / 2) * s.shape.dx
                                      : ((double)at - (double)(ny - 1) / 2) * s.shape.dy;
                        compute(&s, o, z, line, NULL);
                        for (int c = 0; c < RC_STRESSES; c++)
                            for (size_t k = 0; k < along; k++) {
                                double v = map[c][across ? k * nx + at : at * nx + k];
                                assert_true(fabs(line[c][k] - v) <= rounding * s.largest);
                            }
                        release(line);
                    }
                    release(map);
                }
                free(s.p);
            }
}

/* The section lies between the rows. The plane y = 0 of a map with an even number of rows lies between rows.
 * It equals the middle row of the same pressure on a map with half the spacing of rows. */
static void
sections_between_rows(void **state)
{
    struct scene s = scene_new(24, 16, 1e-6, 1.2e-6), fine = scene_new(24, 32, 1e-6, 0.6e-6);
    struct rc_stress_options o = {
        .body.nu = 0.3, .mu = 0.25, .wanted = SIX, .section = 'y', .threads = 2};

    (void)state;
    for (size_t k = 0; k < 24 * 32; k++)
        fine.p[k] = s.p[k / 48 * 24 + k % 24];
    for (double z = 0; z < 5e-6; z += 0.7e-6)
        for (double at = -1.2e-6; at < 8e-6; at += 1.2e-6) {
            double *a[RC_STRESSES], *b[RC_STRESSES];
            o.at = at;
            compute(&s, o, z, a, NULL);
            compute(&fine, o, z, b, NULL);
            /* at the surface logarithms are cut off at a fraction of the cell: sxx, syy, sxy differ */
            for (int c = 0; c < RC_COMPONENTS; c++)
                for (size_t k = 0; k < 24; k++)
                    if (z > 0 || c == RC_SZZ || c == RC_SXZ || c == RC_SYZ)
                        assert_true(fabs(a[c][k] - b[c][k]) <= rounding * s.largest);
                    else
                        assert_true(isfinite(a[c][k]));
            release(a);
            release(b);
        }
    free(s.p);
    free(fine.p);
}

/* Where the map repeats across the plane, a section is that of a map with half the spacing of rows and
 * the sum of the same waves. Where it repeats along the plane only, it is interpolated between those of
 * two rows. */
static void
sections_between_waves(void **state)
{
    enum {
        N = 20,
        M = 15
    };
    struct scene s = scene_new(N, M, 1e-6, 1.2e-6), fine = scene_new(N, 2 * M, 1e-6, 0.6e-6);
    struct rc_stress_options o = {
        .body.nu = 0.3, .mu = 0.25, .wanted = SIX, .section = 'y', .threads = 2};
    double *a[RC_STRESSES], *b[RC_STRESSES], *c[RC_STRESSES];

    (void)state;
    for (size_t k = 0; k < N * 2 * M; k++) {
        fine.p[k] = 0;
        for (size_t j = 0; j < M; j++) {
            const double t = exact_pi / M * ((double)(k / N) / 2 - (double)j);
            fine.p[k] += s.p[j * N + k % N] * (t == 0 ? 1 : sin(M * t) / (M * sin(t)));
        }
    }
    for (double z = 0; z < 9e-6; z += 1.7e-6) {
        o.boundary = rc_boundary_of(false, true);
        for (int row = 0; row < 2 * M - 1; row += 3) {
            o.at = (row / 2.0 - (M - 1) / 2.0) * s.shape.dy;
            compute(&s, o, z, a, NULL);
            o.at = (row - (2 * M - 1) / 2.0) * fine.shape.dy;
            compute(&fine, o, z, b, NULL);
            assert_true(apart(N, a, b) <= rounding * s.largest);
            release(a);
            release(b);
        }
        o.boundary = rc_boundary_of(true, false);
        for (int row = 0; row < M - 1; row++) {
            const double first = (row - (M - 1) / 2.0) * s.shape.dy;
            o.at = first;
            compute(&s, o, z, a, NULL);
            o.at = first + 0.25 * s.shape.dy;
            compute(&s, o, z, b, NULL);
            o.at = first + s.shape.dy;
            compute(&s, o, z, c, NULL);
            for (int k = 0; k < RC_COMPONENTS; k++)
                for (size_t i = 0; i < N; i++)
                    a[k][i] = 0.75 * a[k][i] + 0.25 * c[k][i];
            assert_true(apart(N, a, b) <= rounding * s.largest);
            release(a);
            release(b);
            release(c);
        }
    }
    free(s.p);
    free(fine.p);
}

/* ---- threads, together and alone ---- */

static void
threads_change_no_bit(void **state)
{
    struct scene s = scene_new(150, 140, 1e-6, 1e-6);

    (void)state;
    for (int boundary = 0; boundary < BOUNDARIES; boundary++)
        for (int section = 0; section < 2; section++) {
            double *a[RC_STRESSES], *b[RC_STRESSES];
            struct rc_stress_options o = {.boundary = each_boundary[boundary],
                                          .body.nu = 0.3,
                                          .mu = 0.25,
                                          .wanted = ALL,
                                          .section = section ? 'x' : 0,
                                          .threads = 1};
            compute(&s, o, 2e-6, a, NULL);
            for (o.threads = 2; o.threads < 5; o.threads++) {
                compute(&s, o, 2e-6, b, NULL);
                for (int c = 0; c < RC_STRESSES; c++)
                    assert_memory_equal(a[c], b[c], (section ? 140 : 150 * 140) * sizeof(double));
                release(b);
            }
            release(a);
        }
    free(s.p);
}

static void
alone_as_in_company(void **state)
{
    struct scene s = scene_new(45, 38, 1e-6, 1.1e-6);
    double *all[RC_STRESSES], *one[RC_STRESSES];
    struct rc_stress_options o = {.body.nu = 0.3, .mu = 0.25, .wanted = ALL, .threads = 2};

    (void)state;
    for (int boundary = 0; boundary < BOUNDARIES; boundary++) {
        o.boundary = each_boundary[boundary];
        compute(&s, o, 1e-6, all, NULL);
        for (int c = 0; c < RC_STRESSES; c++) {
            o.wanted = 1u << c;
            compute(&s, o, 1e-6, one, NULL);
            assert_true(apart(45 * 38, all, one) <= rounding * s.largest);
            release(one);
        }
        o.wanted = ALL;
        release(all);
    }
    free(s.p);
}

/* rc_extremes returns the first of the smallest and of the largest values, anywhere in a map; NaN is
 * ignored. */
static void
extremes_as_one_by_one(void **state)
{
    static double v[20000];
    uint64_t seed = 1882;

    (void)state;
    for (size_t n = 1; n <= sizeof v / sizeof *v; n = n * 5 / 2 + 1) {
        size_t first[2] = {0, 0}, least, largest;
        for (size_t k = 0; k < n; k++)
            v[k] = floor(1000 * random_number(&seed)) +
                   (n % 2 ? -2000 : 1000); /* number of equal values */
        for (size_t k = 1; k < n; k++) {
            first[0] = v[k] < v[first[0]] ? k : first[0];
            first[1] = v[k] > v[first[1]] ? k : first[1];
        }
        rc_extremes(n, v, &least, &largest);
        assert_int_equal(least, first[0]);
        assert_int_equal(largest, first[1]);
        v[n / 3] = -7e9;
        v[n - 1] = 7e9;
        v[n / 2] = n > 3 ? NAN : v[n / 2];
        rc_extremes(n, v, &least, &largest);
        assert_int_equal(least, n == 1 ? 0 : n / 3);
        assert_int_equal(largest, n - 1);
    }
}

/* ---- only the necessary transforms ---- */

enum {
    NX = 50,
    NY = 40,
    QUARTER = (100 / 2 + 1) * (80 / 2 + 1), /* for the map padded to 100 x 80 */
    LINES_X = (100 / 2 + 1) * (NY / 2 + 1), /* padded along x only */
    LINES_Y = (NX / 2 + 1) * (80 / 2 + 1),
    WAVES = (NX / 2 + 1) * (NY / 2 + 1)
};

static void
nothing_is_done_unasked(void **state)
{
    /* clang-format off */
    static const struct {
        const char *what;
        struct rc_boundary boundary;
        double mu;
        unsigned wanted;
        char section;
        const char *engine;
        struct rc_stress_counts counts;
    } row[] = {
        {"six", {.x = false}, 0, SIX, 0, NULL,
         {.depths = 1, .source_transforms = 1, .normal_kernels = 6, .coefficients = 6 * QUARTER,
          .kernel_transforms = 6, .field_transforms = 6}},
        {"six with friction", {.x = false}, 0.2, SIX, 0, NULL,
         {.depths = 1, .source_transforms = 1, .normal_kernels = 6, .shear_kernels = 5,
          .coefficients = 11 * QUARTER, .kernel_transforms = 11, .field_transforms = 6}},
        {"one", {.x = false}, 0, 1 << RC_SZZ, 0, NULL,
         {.depths = 1, .source_transforms = 1, .normal_kernels = 1, .coefficients = QUARTER,
          .kernel_transforms = 1, .field_transforms = 1}},
        {"one with friction", {.x = false}, 0.2, 1 << RC_SXX, 0, NULL,
         {.depths = 1, .source_transforms = 1, .normal_kernels = 1, .shear_kernels = 1,
          .coefficients = 2 * QUARTER, .kernel_transforms = 2, .field_transforms = 1}},
        {"mises alone", {.x = false}, 0, 1 << RC_MISES, 0, NULL,
         {.depths = 1, .source_transforms = 1, .normal_kernels = 6, .coefficients = 6 * QUARTER,
          .kernel_transforms = 6, .field_transforms = 6}},
        {"periodic", {.x = true, .y = true}, 0, SIX, 0, NULL,
         {.depths = 1, .source_transforms = 1, .normal_kernels = 6, .coefficients = 6 * WAVES,
          .field_transforms = 6}},
        {"periodic with friction", {.x = true, .y = true}, 0.2, SIX, 0, NULL,
         {.depths = 1, .source_transforms = 1, .normal_kernels = 6, .shear_kernels = 5,
          .coefficients = 11 * WAVES, .field_transforms = 6}},
        {"repeats along y", {.y = true}, 0, SIX, 0, NULL,
         {.depths = 1, .source_transforms = 1, .normal_kernels = 6, .coefficients = 6 * LINES_X,
          .kernel_transforms = 6, .field_transforms = 6}},
        {"repeats along x, with friction", {.x = true}, 0.2, SIX, 0, NULL,
         {.depths = 1, .source_transforms = 1, .normal_kernels = 6, .shear_kernels = 5,
          .coefficients = 11 * LINES_Y, .kernel_transforms = 11, .field_transforms = 6}},
        /* 40 lines are 20 pairs, so the section computes a quarter of the coefficients of a slice, and no
         * map */
        {"section", {.x = false}, 0, SIX, 'y', NULL,
         {.depths = 1, .normal_kernels = 6, .coefficients = 6 * 51 * 20,
          .line_transforms = 40 + 6 * 20 + 6}},
        {"section with friction", {.x = false}, 0.2, SIX, 'y', NULL,
         {.depths = 1, .normal_kernels = 6, .shear_kernels = 5, .coefficients = 11 * 51 * 20,
          .line_transforms = 40 + 11 * 20 + 6}},
        {"section, one", {.x = false}, 0, 1 << RC_SZZ, 'x', NULL,
         {.depths = 1, .normal_kernels = 1, .coefficients = 41 * 25,
          .line_transforms = 50 + 25 + 1}},
        /* 21 waves across the plane; the pressure is transformed across, then along */
        {"section across waves", {.y = true}, 0, SIX, 'y', NULL,
         {.depths = 1, .normal_kernels = 6, .coefficients = 6 * 51 * 21,
          .line_transforms = 50 + 40 + 6 * 21 + 6}},
        {"section along waves", {.x = true}, 0, 1 << RC_SZZ, 'y', NULL,
         {.depths = 1, .normal_kernels = 1, .coefficients = (NX / 2 + 1) * (NY + 1),
          .line_transforms = 40 + 1}},
        {"periodic section", {.x = true, .y = true}, 0, SIX, 'y', NULL,
         {.depths = 1, .source_transforms = 1, .normal_kernels = 6,
          .coefficients = 6 * (NX / 2 + 1) * NY, .line_transforms = 6}},
        /* at a depth of 40 um, to 1 %: 12 um apart, 4 + 24 by 3 + 24 nodes, padded to 56 x 56 */
        {"six on a coarser grid", {.x = false}, 0, SIX, 0, "auto",
         {.depths = 1, .source_transforms = 2, .normal_kernels = 6, .coefficients = 6 * 29 * 29,
          .kernel_transforms = 6, .field_transforms = 6, .coarse_depths = 1}},
        {"six by mlms", {.x = false}, 0, SIX, 0, "mlms",
         {.depths = 1, .normal_kernels = 6, .engine_sums = 6}},
        {"six by mlms with friction", {.x = false}, 0.2, SIX, 0, "mlms",
         {.depths = 1, .normal_kernels = 6, .shear_kernels = 5, .engine_sums = 11}},
    };
    /* clang-format on */
    struct scene s = scene_new(NX, NY, 1e-6, 1e-6);

    (void)state;
    for (size_t k = 0; k < NX * NY; k++)
        s.p[k] += 1e8; /* no line without pressure */
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        struct rc_stress_options o = {.boundary = row[k].boundary,
                                      .body.nu = 0.3,
                                      .mu = row[k].mu,
                                      .wanted = row[k].wanted,
                                      .section = row[k].section,
                                      .engine = row[k].engine,
                                      .threads = 2};
        const size_t *got, *expected = (const size_t *)(const void *)&row[k].counts;
        struct rc_stress_counts counts;
        double *out[RC_STRESSES];
        o.tol = row[k].engine == NULL ? 0 : 1e-2;
        compute(&s, o, row[k].counts.coarse_depths > 0 ? 40e-6 : 1e-6, out, &counts);
        release(out);
        got = (const size_t *)(const void *)&counts;
        for (int c = 0; c < RC_STRESSES; c++)
            assert_true(isnan(counts.error[c])); /* no estimate was asked for */
        for (size_t i = 0; i < offsetof(struct rc_stress_counts, error) / sizeof *got; i++) {
            if (got[i] != expected[i])
                print_error("%s: count %zu is %zu, expected %zu\n", row[k].what, i, got[i],
                            expected[i]);
            assert_int_equal(got[i], expected[i]);
        }
    }
    free(s.p);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(engines_agree),
        cmocka_unit_test(transforms_by_any_name),
        cmocka_unit_test(engines_refused),
        cmocka_unit_test(within_tolerance),
        cmocka_unit_test(estimates_hold),
        cmocka_unit_test(errors_of_loads_hold),
        cmocka_unit_test(unknown_errors_stay_unknown),
        cmocka_unit_test(deep_slices_are_exact),
        cmocka_unit_test(sections_are_lines_of_slices),
        cmocka_unit_test(sections_between_rows),
        cmocka_unit_test(sections_between_waves),
        cmocka_unit_test(threads_change_no_bit),
        cmocka_unit_test(alone_as_in_company),
        cmocka_unit_test(extremes_as_one_by_one),
        cmocka_unit_test(nothing_is_done_unasked),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
