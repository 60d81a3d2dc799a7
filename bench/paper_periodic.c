/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Section 5 of the paper: transforms without padding solve a periodic problem; a larger grid moves the images
 * away. For Hertz's contact of radius a in a domain of side L the images add the displacement P / (pi E*) S /
 * (4 L^3) r^2 + const. Here S = sum of 1/|n|^3 = 9.0336 over the lattice. This is a curvature. The radius
 * decreases by 2 S / (9 pi) (a/L)^3 = 0.639 (a/L)^3. The relative L1 error of the pressure is 4 / sqrt(3) of
 * that, 1.475 (a/L)^3.
 *
 * Periodic pressure is band-limited, free pressure constant in each cell. To isolate the effect of the
 * images, a periodic solution is compared with the limit of periodic solutions. The limit is extrapolated
 * from the widest domain and half of it, with an error proportional to L^-3.
 */
#include "paper.h"

#include "tests/contact_case.h"

enum {
    M = 256, /* nodes across the free map */
    DOMAINS = 8
};
static const double domain[DOMAINS] = {1, 1.5, 2, 3,
                                       4, 6,   8, 16}; /* sides, in sides of the free map */
static const double width = 2.1;                       /* side of the free map, in a      */

/* The middle part of a solution. */
struct run {
    size_t m;           /* nodes across the domain  */
    double seconds, *p; /* p of the middle M x M    */
};

/* Heights of M x M nodes in the middle of m x m, with the sphere continued around them. */
static double *
extended(size_t m, double step, const double *rough)
{
    struct rc_shape shape = {m, m, step, step};
    double *h = map_new(m * m);
    size_t edge = (m - M) / 2;

    rc_synth_sphere(&shape, paper_radius, h);
    for (size_t k = 0; rough != NULL && k < M * M; k++)
        h[(edge + k / M) * m + edge + k % M] += rough[k];
    return h;
}

static struct run
in_middle(size_t m, double step, const double *rough, struct rc_boundary boundary,
          const char *engine, double tol)
{
    struct rc_shape shape = {m, m, step, step};
    struct rc_problem problem = {.boundary = boundary,
                                 .pair.estar = paper_estar,
                                 .load = paper_load,
                                 .engine = engine,
                                 .tol = tol,
                                 .threads = threads,
                                 .method = "pcg"};
    double *h = extended(m, step, rough), start = now();
    struct run run = {.m = m, .seconds = INFINITY, .p = map_new(M * M)};
    size_t edge = (m - M) / 2;
    int runs = 0;

    do {
        double t = now();
        struct rc_solver *solver = solver_new(shape, h, problem);
        solver_run(solver);
        run.seconds = fmin(run.seconds, now() - t);
        for (size_t j = 0; j < M; j++)
            memcpy(run.p + j * M, rc_solver_pressure(solver) + (edge + j) * m + edge,
                   M * sizeof *run.p);
        rc_solver_free(solver);
        runs++;
    } while (once_more(start, runs));
    free(h);
    return run;
}

/* The next size with fast transforms: no prime factor above 7, and even, like M. */
static size_t
good_size(double wish)
{
    for (size_t m = 2 * (size_t)ceil(wish / 2);; m += 2) {
        size_t rest = m;
        for (size_t prime = 2; prime <= 7; prime++)
            while (rest % prime == 0)
                rest /= prime;
        if (rest == 1)
            return m;
    }
}

/* The domain for which the error of the images is `error`, and its cost compared with the free half-space. */
static void
equal(double error, double scale, double step, const double *rough)
{
    size_t m = good_size(M * cbrt(scale / error));
    struct run run[3];

    if (m > 16 * M) {
        printf("%9.1e %8.1f %8.0f  too large to be measured\n", error, (double)m / M,
               (double)(m * m) / (M * M));
        return;
    }
    m = m < M ? M : m;
    run[0] = in_middle(m, step, rough, RC_PERIODIC, "fft", error);
    run[1] = in_middle(M, step, rough, RC_FREE, "fft", error);
    run[2] = in_middle(M, step, rough, RC_FREE, "mlms", error);
    printf("%9.1e %8.2f %8.1f %10.4f %10.4f %10.4f %8.1f %8.1f\n", error, (double)m / M,
           (double)(m * m) / (M * M), run[0].seconds, run[1].seconds, run[2].seconds,
           run[0].seconds / run[1].seconds, run[0].seconds / run[2].seconds);
    fflush(stdout);
    for (int k = 0; k < 3; k++)
        free(run[k].p);
}

/* `truth`: Hertz's pressure, or NULL: the free solution is used. */
static void
grows(const char *title, double step, const double *rough, const double *truth)
{
    static const double fine = 1e-7, errors[] = {1e-2, 1e-3, 1e-4};
    struct run run[DOMAINS], free_fft = in_middle(M, step, rough, RC_FREE, "fft", fine);
    struct run free_mlms = in_middle(M, step, rough, RC_FREE, "mlms", fine);
    double *widest = map_new(M * M), images[DOMAINS], scale = 0;
    const double *other = truth != NULL ? truth : free_fft.p;

    for (int k = 0; k < DOMAINS; k++)
        run[k] = in_middle((size_t)(M * domain[k]), step, rough, RC_PERIODIC, "fft", fine);
    for (size_t k = 0; k < M * M; k++)
        widest[k] = run[DOMAINS - 1].p[k] + (run[DOMAINS - 1].p[k] - run[DOMAINS - 2].p[k]) / 7;
    printf("%s\n%-22s %6s %10s %10s %10s %10s\n", title, "", "nodes", "images", "predicted",
           truth != NULL ? "to Hertz" : "to free", "s, to 1e-7");
    printf("%-22s %6d %10s %10s %10.2e %10.3f\n", "free, padded FFT", M, "-", "-",
           error_l1(M * M, free_fft.p, other), free_fft.seconds);
    printf("%-22s %6d %10s %10s %10.2e %10.3f\n", "free, MLMS", M, "-", "-",
           error_l1(M * M, free_mlms.p, other), free_mlms.seconds);
    for (int k = 0; k < DOMAINS; k++) {
        images[k] = error_l1(M * M, run[k].p, widest);
        printf("%-11s x %-8.1f %6zu %10.2e %10.2e %10.2e %10.3f\n", "periodic", domain[k], run[k].m,
               images[k], 1.475 * pow(width * domain[k], -3), error_l1(M * M, run[k].p, other),
               run[k].seconds);
    }
    printf("exponent of the images' error, 2 to 8: %.2f\n", exponent(5, domain + 2, images + 2));
    for (int k = 2; k < 7; k++)
        scale += images[k] * pow(domain[k], 3) / 5;
    printf("a periodic domain whose images err as much as is asked, all three solved to that "
           "tolerance:\n");
    printf("%9s %8s %8s %10s %10s %10s %8s %8s\n", "error", "domain", "nodes", "periodic s",
           "padded s", "MLMS s", "/ padded", "/ MLMS");
    for (size_t k = 0; k < 3; k++)
        equal(errors[k], scale, step, rough);
    if (truth != NULL) {
        printf("and as much as the free solution errs:\n");
        equal(error_l1(M * M, free_fft.p, truth), scale, step, rough);
    }
    for (int k = 0; k < DOMAINS; k++)
        free(run[k].p);
    free(free_fft.p);
    free(free_mlms.p);
    free(widest);
}

void
section5(void)
{
    struct hertz exact = hertz(paper_load, paper_radius, paper_estar);
    double step = width * exact.a / M, *truth = map_new(M * M), *rough = map_new(M * M);
    struct rc_shape shape = {M, M, step, step};
    struct rc_selfaffine roughness = {
        .hurst = 0.8, .rms_height = 0.405e-6, .short_cut = 16e-6, .rolloff = 100e-6, .seed = 1999};
    struct rc_err err;

    for (size_t k = 0; k < M * M; k++)
        truth[k] = hertz_pressure(exact, node_r(shape, k));
    must_be(rc_synth_selfaffine(&shape, &roughness, rough, &err), &err);
    printf("\nSection 5: a contact on the free half-space, the map %g a wide, relative L1 errors "
           "of its pressure, %zu "
           "threads\n",
           width, threads);
    grows("Hertz's contact", step, NULL, truth);
    grows("the rough sphere of Fig. 3, without hardness, the sphere smooth around the map", step,
          rough, NULL);
    free(truth);
    free(rough);
}
