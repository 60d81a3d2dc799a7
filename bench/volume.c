/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The cost of the sweeps through slabs of plastic strain, in convolutions. A convolution is a real transform
 * of the map and back, including the product with a kernel, by the same transforms.
 *
 *     bench-volume [applications]       (default: all)
 *
 * applications  up and down through 12 slabs on 512 x 512 and 1024 x 1024 nodes, double and single
 *
 * All nodes have strain, or a tenth of the nodes of each row in the upper half of the slabs. Times are the
 * shortest of several runs. RC_THREADS sets the threads.
 */
#include "bench.h"

#include "libcontact/volume/volume.h"

enum {
    SLABS = 12
};

struct application {
    struct rc_slabs *slabs;
    struct rc_slab_strain strain;
    struct rc_slab_stress stress;
    double *p, *u, *map;
    size_t nx;
};

static bool
strain_row(void *ctx, size_t slab, enum rc_component c, size_t j, double *row)
{
    const struct application *a = ctx;

    (void)slab, (void)c;
    memcpy(row, a->map + j * a->nx, a->nx * sizeof *row);
    return true;
}

/* Loads a row of stresses: about the memory traffic of a return map. */
static void
stress_row(void *ctx, size_t slab, size_t j, double *const s[RC_COMPONENTS])
{
    struct application *a = ctx;

    (void)slab;
    for (size_t i = 0; i < a->nx; i++)
        a->u[j * a->nx + i] =
            s[RC_SXX][i] + s[RC_SYY][i] + s[RC_SXY][i] + s[RC_SXZ][i] + s[RC_SYZ][i];
}

static void
up(void *what)
{
    struct application *a = what;

    rc_slabs_up(a->slabs, &a->strain, a->u);
}

static void
both(void *what)
{
    struct application *a = what;

    rc_slabs_up(a->slabs, &a->strain, a->u);
    rc_slabs_down(a->slabs, a->p, &a->stress);
}

struct convolution {
    struct rc_fft *fft;
    struct rc_spectrum *kernel;
    double *p, *u;
};

static void
convolve(void *what)
{
    struct convolution *c = what;

    rc_fft_apply(c->fft, c->kernel, c->p, c->u);
}

static void
measure(size_t n, enum rc_precision precision, size_t threads, bool upper)
{
    struct rc_err err;
    struct rc_shape shape = {n, n, 1e-6, 1e-6};
    double h[SLABS], least[3];
    bool strained[SLABS];
    struct rc_slabs_options options = {.boundary = RC_PERIODIC,
                                       .slabs = SLABS,
                                       .thickness = h,
                                       .shear = 8e10,
                                       .nu = 0.3,
                                       .precision = precision,
                                       .threads = threads};
    struct application a = {.nx = n};
    struct convolution c;
    uint64_t seed = 1;
    size_t held;

    for (size_t k = 0; k < SLABS; k++) {
        h[k] = 0.5e-6 * pow(1.25, (double)k);
        strained[k] = !upper || k < SLABS / 2;
    }
    held = rc_memory_held().held;
    a.slabs = must(rc_slabs_new(&shape, &options, &err));
    held = rc_memory_held().held - held;
    a.p = map_new(n * n);
    a.u = map_new(n * n);
    a.map = map_new(n * n);
    for (size_t i = 0; i < n * n; i++) {
        a.p[i] = uniform(&seed);
        a.map[i] = 1e-3 * uniform(&seed);
    }
    a.strain = (struct rc_slab_strain){strained, strain_row, &a};
    a.stress = (struct rc_slab_stress){NULL, stress_row, &a};
    c = (struct convolution){
        must(rc_fft_new(NULL, NULL, &shape, RC_PERIODIC, RC_DOUBLE, threads, &err)), NULL, a.p,
        a.u};
    c.kernel = must(rc_spectrum_new(c.fft, &err));
    must_be(rc_spectrum_set(c.kernel, c.fft, &rc_kernel_of_one, &err), &err);
    take_turns(3, (struct work[]){{convolve, &c}, {up, &a}, {both, &a}}, 3, 2, least);
    printf("%5zu %7s %7zu %9s %9.2f %9.3f %9.3f %9.1f %9.2f %9.1f\n", n,
           precision == RC_SINGLE ? "single" : "double", threads, upper ? "upper 6" : "all",
           1e3 * least[0], least[1], least[2], least[2] / least[0], least[2] / least[0] / SLABS,
           (double)held / (double)(n * n * SLABS));
    rc_slabs_free(a.slabs);
    rc_spectrum_free(c.kernel);
    rc_fft_free(c.fft);
    free(a.p);
    free(a.u);
    free(a.map);
}

static void
applications(void)
{
    printf("%5s %7s %7s %9s %9s %9s %9s %9s %9s %9s\n", "nodes", "digits", "threads", "strained",
           "conv, ms", "up, s", "both, s", "conv.s", "a slab", "bytes");
    for (size_t n = 512; n <= 1024; n *= 2)
        for (size_t threads = 1; threads <= threads_wanted(); threads *= 2)
            for (int precision = 0; precision < 2; precision++)
                for (int upper = 0; upper < 2; upper++)
                    measure(n, (enum rc_precision)precision, threads, upper);
}

int
main(int argc, char **argv)
{
    const struct part parts[] = {{"applications", applications, false}};

    return parts_run(1, parts, argc - 1, argv + 1);
}
