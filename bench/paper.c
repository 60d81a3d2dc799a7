/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The measurements of Polonsky and Keer, Wear 231 (1999) 206-219, repeated:
 *
 *     bench-paper [-n SIZE,SIZE...] [-m WAY] [-s SECONDS] [table1] [fig1] [fig3] [stresses] [section5]
 *
 * The parts, all of them when none is named:
 *
 * table1    errors and times of direct summation and MLMS, one thread
 * fig1      Hertz's contact: errors of contact radius, pressure and Mises' stress against the number of rows
 * fig3      rough spheres: time against nodes, from 61 x 52 as in the paper to 4096 x 4096
 * stresses  483 x 412 nodes, 45 depths, six components and Mises
 * section5  errors of periodic transforms for a contact on the free half-space as the domain grows, and the
 *           cost of the same accuracy with them, with padded transforms and with MLMS
 *
 * -n, -m: only the grids of fig3 with these numbers of columns, or only pk99+mlms, pcg+mlms or pcg+fft. -s: a
 * solution of fig3 that takes longer (default 100) is stopped. RC_THREADS sets the threads.
 */
#include "paper.h"

#include <unistd.h>

size_t threads;
double limit = 100;
static size_t sizes[16], count;
static const char *way = "";

bool
size_wanted(size_t nx)
{
    bool wanted = count == 0;

    for (size_t k = 0; k < count; k++)
        wanted = wanted || sizes[k] == nx;
    return wanted;
}

bool
way_wanted(const char *title)
{
    return strncmp(title, way, strlen(way)) == 0;
}

/* Relative L1 change from p to q: (32). */
static double
moved_by(size_t n, const double *p, const double *q)
{
    double change = 0, sum = 0;

    for (size_t k = 0; k < n; k++) {
        change += fabs(q[k] - p[k]);
        sum += q[k];
    }
    return change / sum;
}

struct rc_solver *
paper_solve(struct rc_shape shape, const double *h, struct rc_problem problem, bool *done)
{
    double m = (double)(shape.nx < shape.ny ? shape.nx : shape.ny), change = pow(m, -1.5),
           start = now();
    size_t n = shape.nx * shape.ny;
    struct rc_solver *solver;
    enum rc_status status;
    double *before, moved;

    problem.method = "pk99";
    problem.engine = "mlms";
    problem.tol = fmin(10 / (m * m), 0.5 * change); /* the errors of the sums are a tenth of it */
    solver = solver_new(shape, h, problem);
    before = map_new(n);
    do {
        memcpy(before, rc_solver_pressure(solver), n * sizeof *before);
        status = rc_solver_step(solver);
        moved = moved_by(n, before, rc_solver_pressure(solver));
    } while (status == RC_MORE && moved > change && now() - start < limit);
    free(before);
    *done = moved <= change;
    return solver;
}

/* The displacement by `hemisphere`, with K = 1/r. */
static void
hemisphere_displacement(size_t m, double *u)
{
    double d = 2 / (double)(m - 1);

    for (size_t k = 0; k < m * m; k++) {
        double x = -1 + d * (double)(k % m), y = -1 + d * (double)(k / m);
        double r2 = x * x + y * y, r = sqrt(r2);
        u[k] = r2 <= 1 ? RC_PI * RC_PI / 4 * (2 - r2)
                       : RC_PI / 2 * ((2 - r2) * asin(1 / r) + sqrt(r2 - 1));
    }
}

/* The shortest time of a sum in seconds. */
static double
summed(const char *engine, const struct rc_sum *sum, const double *p, double *u, int runs)
{
    struct rc_err err;
    const struct rc_engine *e = engine_named(engine);
    void *plan = must(e->new (sum, &err));
    double least = sum_seconds((struct sum_work){e, plan, p, u}, runs);

    e->free(plan);
    return least;
}

void
table1(void)
{
    printf("Table 1, one thread: relative L2 errors against the exact deflection\n");
    printf("%6s %12s %10s %12s %10s %5s %4s %12s %8s %8s\n", "M", "direct s", "error", "mlms s",
           "error", "t", "mc", "mlms-direct", "times M2", "speed-up");
    for (size_t m = 64; m <= 2048; m *= 2) {
        size_t n = m * m;
        double *p = map_new(n), *exact = map_new(n), *u = map_new(n), *v = map_new(n);
        bool direct_too = m <= 512; /* for larger M the Fourier engine gives the values */
        struct rc_sum sum =
            point_sum((struct rc_shape){m, m, 2 / (double)(m - 1), 2 / (double)(m - 1)});
        double t_direct, t_mlms;

        sum.threads = 1;
        hemisphere(m, m, p);
        hemisphere_displacement(m, exact);
        t_direct = summed(direct_too ? "direct" : "fft", &sum, p, u, m < 256 ? 5 : 1);
        sum.order = paper_order(m);
        sum.correction = paper_correction(sum.order, m);
        t_mlms = summed("mlms", &sum, p, v, 5);
        printf("%6zu ", m);
        if (direct_too)
            printf("%12.4f ", t_direct);
        else
            printf("%12s ", "-");
        printf("%10.3g %12.5f %10.3g %5zu %4zu %12.2e %8.3f ", error_l2(n, u, exact), t_mlms,
               error_l2(n, v, exact), sum.order, sum.correction, error_l2(n, v, u),
               error_l2(n, v, u) * (double)n);
        if (direct_too)
            printf("%8.1f\n", t_direct / t_mlms);
        else
            printf("%8s\n", "-");
        fflush(stdout);
        free(p);
        free(exact);
        free(u);
        free(v);
    }
}

int
main(int argc, char **argv)
{
    static const struct part parts[] = {{"table1", table1, false},
                                        {"fig1", fig1, false},
                                        {"fig3", fig3, false},
                                        {"stresses", stresses, false},
                                        {"section5", section5, false}};

    threads = threads_wanted();
    for (int option; (option = getopt(argc, argv, "n:m:s:")) != -1;)
        if (option == 'n')
            count = sizes_read(optarg, 16, sizes);
        else if (option == 'm')
            way = optarg;
        else if (option == 's')
            limit = atof(optarg);
        else
            return 2;
    return parts_run(sizeof parts / sizeof *parts, parts, argc - optind, argv + optind);
}
