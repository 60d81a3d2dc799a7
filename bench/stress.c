/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The cost of stresses:
 *
 *     bench-stress [slice] [parts] [sizes] [mlms] [layers]       (default: all)
 *
 * slice  a slice of six components and Mises, compared with its transforms and with writing it
 * parts  the parts of the time of a slice: coefficients, their transforms, fields
 * sizes  the time of a slice and of one convolution of the deflection, in the same run
 * mlms   the multi-level sum and the transforms
 * layers a slice and a section of coated bodies and of one material
 *
 * Times are the shortest of several runs. RC_THREADS sets the threads.
 */
#include <omp.h>

#include "bench.h"

#include "formats/rcg/rcg.h"
#include "libcontact/operator/operator.h"
#include "libcontact/stress/stress.h"
#include "tools/machine/machine.h"

static size_t threads;

struct maps {
    double *s[RC_STRESSES];
};

static struct maps
maps_new(size_t n)
{
    struct maps m;

    for (int c = 0; c < RC_STRESSES; c++)
        m.s[c] = map_new(n);
    return m;
}

static void
maps_free(struct maps *m)
{
    for (int c = 0; c < RC_STRESSES; c++)
        free(m->s[c]);
}

/* Hertz's pressure on a disc that nearly fills a square map of side 2. */
static double *
disc(size_t m, struct rc_shape *shape)
{
    double d = 2 / (double)m, *p = must(malloc(m * m * sizeof *p));

    *shape = (struct rc_shape){m, m, d, d};
    for (size_t k = 0; k < m * m; k++) {
        double x = ((double)(k % m) + 0.5) * d - 1, y = ((double)(k / m) + 0.5) * d - 1;
        double r2 = (x * x + y * y) / 0.9;
        p[k] = r2 < 1 ? sqrt(1 - r2) : 0;
    }
    return p;
}

struct slice_work {
    struct rc_stress *stress;
    double depth, **s;
};

static void
slice_run(void *what)
{
    struct slice_work *w = what;
    struct rc_err err;

    must_be(rc_stress_slice(w->stress, w->depth, w->s, &err), &err);
}

/* The shortest time of a slice of a plan, in seconds. */
static double
slice_seconds(const struct rc_shape *shape, const double *p, const struct rc_stress_options *o,
              double depth, struct maps *m, int runs)
{
    struct rc_err err;
    struct slice_work slice = {must(rc_stress_new(shape, p, o, &err)), depth, m->s};
    double least;

    take_turns(1, &(struct work){slice_run, &slice}, runs, 0, &least);
    rc_stress_free(slice.stress);
    return least;
}

/* ---- slice ---- */

/* Two fields back from the pressure's transform, with an even and an odd kernel. */
struct field_work {
    struct rc_fft *fft;
    double *quarter, *u[2];
    size_t cx, cy;
};

static void
zero_symbol(const void *of, size_t i, double qx, size_t n, const double *qy, double *out)
{
    (void)of, (void)i, (void)qx, (void)qy;
    memset(out, 0, n * sizeof *out);
}

static void
field_run(void *what)
{
    const struct field_work *w = what;
    const struct rc_fft_kernel kernel[] = {{0, w->quarter, zero_symbol, NULL},
                                           {RC_ODD_X | RC_ODD_Y, w->quarter, zero_symbol, NULL}};
    const struct rc_fft_sum sum[] = {{w->u[0], 1, {{0, 0, 1}}}, {w->u[1], 1, {{1, 0, 1}}}};
    struct rc_err err;

    must_be(rc_fft_fields(w->fft, w->cx, 2, kernel, 2, sum, &err), &err);
}

/* Transforms the rows of both kernels. */
static void
kernel_run(void *what)
{
    const struct field_work *w = what;
    double *twice = must(malloc((size_t)threads * w->cx * sizeof *twice));

#pragma omp parallel for num_threads((int)threads) schedule(dynamic, 4)
    for (size_t j = 0; j < w->cy; j++) {
        double *row[] = {w->quarter + j * w->cx, twice + (size_t)omp_get_thread_num() * w->cx};
        memset(row[1], 0, w->cx * sizeof *twice);
        rc_fft_quarter_line(w->fft, 2, 2, row);
    }
    free(twice);
}

enum {
    FRAMES = RC_COMPONENTS + 1
};

/* Frames of a slice are written to a program that reads and discards them. */
struct write_work {
    FILE *pipe;
    struct rc_writer *writer; /* NULL: only their bytes, without a stream */
    struct rc_grid *frame[FRAMES];
};

static void
write_run(void *what)
{
    const struct write_work *w = what;
    struct rc_err err;

    for (int c = 0; c < FRAMES; c++) {
        const struct rc_grid *g = w->frame[c];
        if (w->writer != NULL)
            must_be(rc_writer_put(w->writer, g, &err), &err);
        else
            fwrite(g->v, sizeof *g->v, g->nx * g->ny, w->pipe);
    }
    fflush(w->pipe);
}

static struct write_work
write_new(const struct rc_shape *shape, bool stream)
{
    struct write_work w = {.pipe = must(popen("cat >/dev/null", "w"))};
    struct rc_err err;

    setvbuf(w.pipe, NULL, _IOFBF, 1 << 16);
    pipe_widen(fileno(w.pipe));
    if (stream)
        w.writer = must(rc_writer_new(w.pipe, &err));
    for (int c = 0; c < FRAMES; c++) {
        w.frame[c] = must(rc_grid_new(shape, rc_component_names[c], "Pa", &err));
        for (size_t k = 0; k < shape->nx * shape->ny; k++)
            w.frame[c]->v[k] = (double)k;
    }
    return w;
}

static void
write_free(struct write_work *w)
{
    rc_writer_free(w->writer);
    pclose(w->pipe);
    for (int c = 0; c < FRAMES; c++)
        rc_grid_free(w->frame[c]);
}

static void
slice_row(const struct rc_shape *shape, const double *p, const char *name,
          struct rc_boundary boundary, double depth, struct write_work *stream,
          struct write_work *bytes)
{
    const struct rc_stress_options o = {
        .boundary = boundary, .body.nu = 0.3, .wanted = (2u << RC_MISES) - 1, .threads = threads};
    size_t n = shape->nx * shape->ny;
    struct rc_err err;
    struct rc_fft *fft = must(rc_fft_new(NULL, NULL, shape, boundary, RC_DOUBLE, threads, &err));
    struct maps maps = maps_new(n);
    struct slice_work slice = {must(rc_stress_new(shape, p, &o, &err)), depth, maps.s};
    struct field_work field = {.fft = fft, .u = {maps.s[0], maps.s[1]}};
    struct work work[] = {{slice_run, &slice},
                          {field_run, &field},
                          {write_run, stream},
                          {write_run, bytes},
                          {kernel_run, &field}};
    double least[5] = {0}, transforms;

    rc_fft_quarter(fft, &field.cx, &field.cy);
    field.quarter = must(calloc(field.cx * field.cy, sizeof(double)));
    must_be(rc_fft_load(fft, 0, p, &err), &err);
    take_turns(rc_repeats(boundary) == 0 ? 5 : 4, work, 1, 4, least);
    transforms = RC_COMPONENTS / 2 * (least[1] + least[4]);
    printf("  %-24s%8.1f%8.1f%8.1f%8.2f%10.1f%8.1f%8.2f%8.0f\n", name, 3e3 * least[1],
           3e3 * least[4], 1e3 * least[0], least[0] / transforms, 1e3 * least[2], 1e3 * least[3],
           least[2] / least[0], (double)rc_memory_held().peak / (double)n);
    fflush(stdout);
    free(field.quarter);
    rc_stress_free(slice.stress);
    rc_fft_free(fft);
    maps_free(&maps);
}

static void
slice(void)
{
    enum {
        M = 1024
    };
    struct rc_shape shape;
    double *p = disc(M, &shape);
    struct write_work stream = write_new(&shape, true), bytes = write_new(&shape, false);

    printf(
        "slice: %d x %d nodes, six components and Mises, milliseconds, %zu threads.\n"
        "fields: back from the pressure's transform, with the columns of their kernels; kernels: "
        "their rows; ratio: slice to both;\nwritten: %d bytes a node to a pipe, bare: without "
        "headers and checksums; "
        "ratio: written to slice\n",
        M, M, threads, (int)(FRAMES * sizeof(double)));
    printf("  %-24s%8s%8s%8s%8s%10s%8s%8s%8s\n", "depth in spacings", "fields", "kernels", "slice",
           "ratio", "written", "bare", "ratio", "B/node");
    slice_row(&shape, p, "free, 5", RC_FREE, 5 * shape.dx, &stream, &bytes);
    slice_row(&shape, p, "periodic, 5", RC_PERIODIC, 5 * shape.dx, &stream, &bytes);
    slice_row(&shape, p, "periodic, 40", RC_PERIODIC, 40 * shape.dx, &stream, &bytes);
    write_free(&stream);
    write_free(&bytes);
    free(p);
}

/* ---- parts ---- */

static void
parts(void)
{
    enum {
        M = 1024
    };
    static const struct {
        const char *what;
        unsigned components;
        bool shear;
    } set[] = {{"szz", 1u << RC_SZZ, false},
               {"six", (1u << RC_COMPONENTS) - 1, false},
               {"six, with friction", (1u << RC_COMPONENTS) - 1, true}};
    struct rc_shape shape;
    double *p = disc(M, &shape), *u = map_new(M * M), *v = map_new(M * M), t, best;
    struct rc_err err;
    struct rc_fft *fft = must(rc_fft_new(NULL, NULL, &shape, RC_FREE, RC_DOUBLE, threads, &err));
    size_t cx, cy;
    double *x, *out[RC_STRESS_KERNELS] = {NULL};
    struct rc_dct *dct;
    struct field_work field;
    const struct rc_body body = {.nu = 0.3};
    struct rc_solid *solid = must(rc_body_uniform.new(&body, &err));
    struct rc_inside *inside =
        must(solid->type->inside->new (solid, 5 * shape.dx, true, RC_FREE, &err));

    rc_fft_quarter(fft, &cx, &cy);
    x = must(calloc(cx, sizeof *x));
    printf("parts, %d x %d nodes, one thread for coefficients and lines:\n", M, M);
    for (int s = 0; s < 3; s++) {
        unsigned kernels =
            rc_stress_distinct(rc_body_uniform.inside, set[s].components, set[s].shear);
        const struct rc_cell cell = {shape.dx, shape.dy};
        for (int c = 0; c < RC_STRESS_KERNELS; c++)
            if (kernels >> c & 1 && out[c] == NULL)
                out[c] = must(malloc(cx * sizeof(double)));
        t = now();
        for (size_t j = 0; j < cy; j++)
            inside->type->line(inside, &cell, kernels, shape.dx, cx, (double)j * shape.dy, out);
        printf("  %zu x %zu coefficients, %s: %.1f ms\n", cx, cy, set[s].what, 1e3 * (now() - t));
    }
    rc_inside_free(inside);
    rc_solid_free(solid);
    dct = must(rc_dct_new(cx, 1, &err));
    t = now();
    for (size_t j = 0; j < cy; j++)
        rc_dct_run(dct, 1, 0, &x);
    printf("  %zu lines of a kernel transformed: %.1f ms\n", cy, 1e3 * (now() - t));
    rc_dct_free(dct);
    must_be(rc_fft_load(fft, 0, p, &err), &err);
    field = (struct field_work){fft, must(calloc(cx * cy, sizeof(double))), {u, v}, cx, cy};
    take_turns(1, &(struct work){field_run, &field}, 5, 0, &best);
    printf("  two fields from the pressure's transform, %zu threads: %.1f ms\n", threads,
           1e3 * best);
    free(field.quarter);
    rc_fft_free(fft);
    for (int c = 0; c < RC_STRESS_KERNELS; c++)
        free(out[c]);
    free(x);
    free(p);
    free(u);
    free(v);
}

/* ---- sizes ---- */

struct conv_work {
    struct rc_conv *conv;
    const double *p;
    double *u;
};

static void
conv_run(void *what)
{
    const struct conv_work *w = what;

    rc_conv_apply(w->conv, w->p, w->u);
}

static double
convolution_seconds(const struct rc_shape *shape, const double *p, double *u)
{
    struct rc_conv_options o = {.boundary = RC_FREE, .engine = "fft", .threads = threads};
    struct rc_err err;
    struct conv_work conv = {must(rc_conv_new(shape, &(struct rc_pair){.estar = 1}, &o, &err)), p,
                             u};
    double least;

    take_turns(1, &(struct work){conv_run, &conv}, 5, 0.3, &least);
    rc_conv_free(conv.conv);
    return least;
}

static void
sizes(void)
{
    static const struct {
        const char *what;
        struct rc_stress_options o;
        double depth; /* spacings */
    } row[] = {
        {"szz alone", {.wanted = 1u << RC_SZZ}, 5},
        {"six, Mises", {.wanted = (2u << RC_MISES) - 1}, 5},
        {"six, Mises, friction", {.wanted = (2u << RC_MISES) - 1, .mu = 0.15}, 5},
        {"all eleven, friction", {.wanted = (1u << RC_STRESSES) - 1, .mu = 0.15}, 5},
        {"section, six, Mises", {.wanted = (2u << RC_MISES) - 1, .section = 'y'}, 5},
        {"40 spacings deep, tol 1e-4", {.wanted = (2u << RC_MISES) - 1, .tol = 1e-4}, 40},
        {"periodic, six, Mises", {.wanted = (2u << RC_MISES) - 1, .boundary = PERIODIC}, 5},
    };

    printf("sizes: milliseconds a slice, and the same in convolutions (free) of the deflection, "
           "%zu threads\n",
           threads);
    for (size_t m = 256; m <= 2048; m *= 2) {
        struct rc_shape shape;
        double *p = disc(m, &shape);
        struct maps maps = maps_new(m * m);
        double conv = convolution_seconds(&shape, p, maps.s[0]);
        printf("  %4zu^2: convolution %.2f ms\n", m, 1e3 * conv);
        for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
            struct rc_stress_options o = row[k].o;
            double t;
            o.body.nu = 0.3;
            o.threads = threads;
            t = slice_seconds(&shape, p, &o, row[k].depth * shape.dx, &maps, m > 1024 ? 3 : 6);
            printf("    %-28s %8.2f ms  %5.2f\n", row[k].what, 1e3 * t, t / conv);
        }
        fflush(stdout);
        maps_free(&maps);
        free(p);
    }
}

/* ---- mlms ---- */

static void
mlms(void)
{
    printf("mlms: szz at 5 spacings, milliseconds with the tables, error over the largest "
           "pressure\n");
    for (size_t m = 256; m <= 1024; m *= 2) {
        struct rc_shape shape;
        double *p = disc(m, &shape);
        struct maps a = maps_new(m * m), b = maps_new(m * m);
        struct rc_stress_options o = {.body.nu = 0.3, .wanted = 1u << RC_SZZ, .threads = threads};
        printf("  %4zu^2: fft %.1f ms", m, 1e3 * slice_seconds(&shape, p, &o, 5 * shape.dx, &a, 3));
        o.engine = "mlms";
        for (double tol = 1e-3; tol > 1e-8; tol /= 100) {
            double worst = 0, t;
            o.tol = tol;
            t = slice_seconds(&shape, p, &o, 5 * shape.dx, &b, 2);
            for (size_t k = 0; k < m * m; k++)
                worst = fmax(worst, fabs(a.s[RC_SZZ][k] - b.s[RC_SZZ][k]));
            printf("   tol %.0e: %.1f ms, %.1e", tol, 1e3 * t, worst);
        }
        printf("\n");
        fflush(stdout);
        maps_free(&a);
        maps_free(&b);
        free(p);
    }
}

/* ---- layers ---- */

static void
layers(void)
{
    enum {
        M = 512
    };
    static const struct rc_layer one[] = {{0.03, 4e11, 0.2}}, three[] = {{0.01, 4e11, 0.2},
                                                                         {0.01, 2e10, 0.45},
                                                                         {0.01, 9e10, 0.3}};
    static const struct rc_body coats[] = {{2e11, 0.3, 1, one}, {2e11, 0.3, 3, three}};
    struct rc_shape shape;
    double *p = disc(M, &shape);
    struct maps m = maps_new(M * M);

    printf("\n%d^2, seconds: one material; one layer, in it and below; three, in the second and "
           "below\n",
           M);
    for (int k = 0; k < 8; k++) {
        struct rc_stress_options o = {.boundary = k & 4 ? RC_PERIODIC : RC_FREE,
                                      .body.nu = 0.3,
                                      .mu = k & 2 ? 0.3 : 0,
                                      .wanted = (2u << RC_MISES) - 1,
                                      .section = k & 1 ? 'y' : 0,
                                      .threads = threads};
        printf("%-9s%-9s%-9s%.4f", k & 4 ? "periodic" : "free", k & 2 ? "friction" : "",
               k & 1 ? "section" : "slice", slice_seconds(&shape, p, &o, 0.015, &m, 5));
        for (int body = 0; body < 2; body++) {
            o.body = coats[body];
            printf("  %.4f %.4f", slice_seconds(&shape, p, &o, 0.015, &m, 5),
                   slice_seconds(&shape, p, &o, 0.05, &m, 5));
        }
        printf("\n");
    }
    maps_free(&m);
    free(p);
}

int
main(int argc, char **argv)
{
    static const struct part table[] = {{"slice", slice, false},
                                        {"parts", parts, false},
                                        {"sizes", sizes, false},
                                        {"mlms", mlms, false},
                                        {"layers", layers, false}};

    threads = threads_wanted();
    return parts_run(sizeof table / sizeof *table, table, argc - 1, argv + 1);
}
