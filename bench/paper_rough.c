/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Section 4.2 of the paper: the rough sphere, its Fig. 3 and its stresses. */
#include "paper.h"

/* Self-affine roughness that gives 0.55 of Hertz's area on the largest grid of the paper
 * (sample_surfaces/make.sh). It is cut at the edges for the smaller grids, and generated again for larger
 * ones. The radius of the sphere grows with the map, and the load with its area. */
static double *
rough_sphere(struct rc_shape shape, struct rc_problem *problem)
{
    struct rc_shape whole = {PAPER_NX, PAPER_NY, paper_dx, paper_dy};
    struct rc_selfaffine roughness = {
        .hurst = 0.8, .rms_height = 0.405e-6, .short_cut = 16e-6, .rolloff = 100e-6, .seed = 1999};
    double *h = map_new(shape.nx * shape.ny), *rough;
    double area = (double)(shape.nx * shape.ny) * shape.dx * shape.dy;
    double length = (double)shape.nx * shape.dx / (PAPER_NX * paper_dx);
    size_t left, top;
    struct rc_err err;

    if (shape.nx > whole.nx)
        whole = shape;
    rough = map_new(whole.nx * whole.ny);
    must_be(rc_synth_selfaffine(&whole, &roughness, rough, &err), &err);
    rc_synth_sphere(&shape, paper_radius * length, h);
    left = (whole.nx - shape.nx) / 2;
    top = (whole.ny - shape.ny) / 2;
    for (size_t k = 0; k < shape.nx * shape.ny; k++)
        h[k] += rough[(top + k / shape.nx) * whole.nx + left + k % shape.nx];
    free(rough);
    *problem = (struct rc_problem){.pair.estar = paper_estar,
                                   .hardness = paper_hardness,
                                   .threads = threads,
                                   .load = paper_load * area /
                                           (PAPER_NX * PAPER_NY * paper_dx * paper_dy)};
    return h;
}

struct cost {
    size_t iterations;
    double convolutions, seconds, error;
    bool done;
};

enum {
    PK99_MLMS,
    PCG_MLMS,
    PCG_FFT,
    WAYS
};

static const struct {
    const char *method, *engine, *title;
} ways[WAYS] = {{"pk99", "mlms", "pk99+mlms, stopped by (32)"},
                {"pcg", "mlms", "pcg+mlms, certified"},
                {"pcg", "fft", "pcg+fft, certified"}};

/* The shortest of several times, if they are short. */
static struct cost
spent(int way, struct rc_shape shape, const double *h, struct rc_problem problem,
      const double *truth)
{
    struct cost c = {.seconds = INFINITY};
    double start = now();
    int runs = 0;

    problem.method = ways[way].method;
    problem.engine = ways[way].engine;
    do {
        double t = now();
        struct rc_solver *solver;
        if (way == PK99_MLMS) {
            solver = paper_solve(shape, h, problem, &c.done);
        } else {
            solver = solver_new(shape, h, problem);
            solver_run(solver);
            c.done = solver_progress(solver).error <= problem.tol;
        }
        c.seconds = fmin(c.seconds, now() - t);
        c.iterations = solver_progress(solver).iterations;
        c.convolutions = rc_solver_convolutions(solver);
        c.error = error_l1(shape.nx * shape.ny, rc_solver_pressure(solver), truth);
        rc_solver_free(solver);
        runs++;
    } while (once_more(start, runs));
    return c;
}

static double *
converged(struct rc_shape shape, const double *h, struct rc_problem problem)
{
    size_t n = shape.nx * shape.ny;
    double *p = map_new(n);
    struct rc_solver *solver;

    problem.tol *= 1e-2;
    solver = solver_new(shape, h, problem);
    solver_run(solver);
    memcpy(p, rc_solver_pressure(solver), n * sizeof *p);
    rc_solver_free(solver);
    return p;
}

enum {
    GRIDS = 7
};

/* Costs of a method on the grids that it solved. */
struct series {
    size_t count;
    double seconds[GRIDS], steps[GRIDS];
};

static void
exponents(const char *name, const double *nodes, size_t first, const struct series *way)
{
    printf("%-23s", name);
    for (int w = 0; w < WAYS; w++) {
        size_t n = way[w].count > first ? way[w].count - first : 0;
        printf(" | %6.2f %7s %9.2f %8s", exponent(n, nodes + first, way[w].steps + first), "",
               exponent(n, nodes + first, way[w].seconds + first), "");
    }
    printf("\n");
}

static void
fig3_heading(void)
{
    printf("\nFig. 3: rough spheres with a hardness, tolerance M_min^(-3/2), %zu threads\n",
           threads);
    printf("%14s %8s", "", "");
    for (int w = 0; w < WAYS; w++)
        printf(" | %-33s", ways[w].title);
    printf("\n%14s %8s", "nodes", "wanted");
    for (int w = 0; w < WAYS; w++)
        printf(" | %6s %7s %9s %8s", "steps", "equiv", "seconds", "error");
    printf("\n");
}

void
fig3(void)
{
    /* square cells of the same area on the larger ones */
    const double d = sqrt(paper_dx * paper_dy);
    const struct rc_shape grids[GRIDS] = {{61, 52, paper_dx, paper_dy},
                                          {121, 103, paper_dx, paper_dy},
                                          {242, 206, paper_dx, paper_dy},
                                          {PAPER_NX, PAPER_NY, paper_dx, paper_dy},
                                          {1024, 1024, d, d},
                                          {2048, 2048, d, d},
                                          {4096, 4096, d, d}};
    struct series way[WAYS] = {0};
    double nodes[GRIDS];

    fig3_heading();
    for (size_t k = 0, at = 0; at < GRIDS; at++) {
        struct rc_shape shape = grids[at];
        double m = (double)(shape.nx < shape.ny ? shape.nx : shape.ny), *h, *truth;
        struct rc_problem problem;

        if (!size_wanted(shape.nx))
            continue;
        h = rough_sphere(shape, &problem);
        problem.tol = pow(m, -1.5);
        truth = converged(shape, h, problem);
        nodes[k] = (double)(shape.nx * shape.ny);
        printf("%6zu x %5zu %8.1e", shape.nx, shape.ny, problem.tol);
        for (int w = 0; w < WAYS; w++) {
            struct cost c;
            if (!way_wanted(ways[w].title)) {
                printf(" | %33s", "");
                continue;
            }
            c = spent(w, shape, h, problem, truth);
            printf(" | %6zu %7.1f %9.4f %8.1e", c.iterations, c.convolutions, c.seconds, c.error);
            if (!c.done)
                printf(" (given up)");
            if (c.done && way[w].count == k) {
                way[w].seconds[k] = c.seconds;
                way[w].steps[k] = (double)c.iterations;
                way[w].count++;
            }
            fflush(stdout);
        }
        printf("\n");
        free(h);
        free(truth);
        k++;
    }
    exponents("exponents, all", nodes, 0, way);
    exponents("without the first three", nodes, 3, way);
}

void
stresses(void)
{
    enum {
        DEPTHS = 45
    };
    const struct rc_shape shape = {PAPER_NX, PAPER_NY, paper_dx, paper_dy};
    struct rc_problem problem;
    double *h = rough_sphere(shape, &problem), *s[RC_STRESSES];
    struct rc_solver *solver;

    problem.tol = 0;
    solver = solver_new(shape, h, problem);
    solver_run(solver);
    for (int c = 0; c < RC_STRESSES; c++)
        s[c] = map_new(PAPER_NX * PAPER_NY);
    printf(
        "\nstresses: %d x %d, %d depths, six components and Mises, %zu threads (theirs: 4.3 h)\n",
        PAPER_NX, PAPER_NY, DEPTHS, threads);
    for (int run = 0; run < 4; run++) {
        struct rc_stress_options o = {.body.nu = paper_nu,
                                      .wanted = (2u << RC_MISES) - 1,
                                      .threads = threads,
                                      .mu = run % 2 * 0.15,
                                      .tol = run / 2 * 1e-4};
        struct rc_err err;
        double t = now();
        struct rc_stress *stress =
            must(rc_stress_new(&shape, rc_solver_pressure(solver), &o, &err));
        for (int k = 0; k < DEPTHS; k++)
            must_be(rc_stress_slice(stress, 10e-6 * k, s, &err), &err);
        printf("  mu = %.2f, tol %g: %.2f s\n", o.mu, o.tol, now() - t);
        rc_stress_free(stress);
    }
    for (int c = 0; c < RC_STRESSES; c++)
        free(s[c]);
    rc_solver_free(solver);
    free(h);
}
