/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The cost of a contact:
 *
 *     bench-solve [-n SIZE,SIZE...] [-t TOL] [-m METHOD] [table] [estimate] [growth] [whole] [axes]
 *
 * table     convolution equivalents, iterations and seconds to a true relative L1 error of the pressure
 *           (default 1e-4), coarse levels included, and the cost of the certified solution to this tolerance
 *           (the default part)
 * estimate  estimate over true error, every iteration
 * growth    work against size on periodic surfaces with shortest waves of 2 nodes, with and without a
 *           roll-off, and of 8 nodes: equivalents to the true error, and of the certified solution
 * whole     seconds of certified solutions, compared with those of a convolution on the same grid
 * axes      work against size on maps that repeat along no, one or both axes, rough in both directions or
 *           extruded along y: as growth, with the processor seconds of the plans and of the iteration
 *
 * Surfaces of the first two: periodic self-affine (Hurst 0.8, cut at 8 nodes, rolled off at an eighth of the
 * map). The other is a sphere with such roughness on the free half-space. The reference is the same solver at
 * 1e-9. RC_THREADS sets the threads.
 */
#include "bench.h"

#include <time.h>
#include <unistd.h>

struct surface {
    const char *name;
    struct rc_boundary boundary;
    double load; /* periodic: mean pressure over E* and RMS slope; free: load relative to that for a
                 Hertz circle as wide as the map */
    double hardness; /* over the mean pressure; 0: none                                        */
};

static const struct surface surfaces[] = {
    {"periodic", PERIODIC, 0.004, 0},  {"periodic", PERIODIC, 0.04, 0},
    {"periodic", PERIODIC, 0.18, 0},   {"periodic", PERIODIC, 0.28, 0},
    {"periodic", PERIODIC, 0.5, 0},    {"periodic", PERIODIC, 1.2, 0},
    {"sphere", FREE, 0.004, 0},        {"sphere", FREE, 0.1, 0},
    {"periodic, H", PERIODIC, 0.1, 3}, {"sphere, H", FREE, 0.1, 1.2},
};

enum {
    SURFACES = sizeof surfaces / sizeof *surfaces
};

/* Roughness of a periodic map. */
struct roughness {
    double cut;     /* shortest wave, nodes                      */
    double rolloff; /* longest self-affine wave over the side    */
};
static const struct roughness roughnesses[] = {{2, 0.25}, {2, 1}, {8, 0.25}};
/* Mean pressures over E* and RMS slope for contact of about 1, 11, 39, 83 and 97 %. */
static const double pressures[] = {0.004, 0.049, 0.2, 0.6, 1.05};

/* The command line sets these. */
static size_t threads, sizes[16] = {512, 1024, 2048}, count = 3;
static double wanted = 1e-4;
static const char *method = "pcg";

static struct rc_problem
make(const struct surface *what, struct rc_shape shape, double *h)
{
    static const double slope = 0.1, estar = 1e9;
    double side = (double)shape.nx * shape.dx, area = side * side;
    struct rc_selfaffine roughness = {.hurst = 0.8,
                                      .rms_slope = slope,
                                      .short_cut = 8 * shape.dx,
                                      .rolloff = side / 8,
                                      .seed = 5};
    struct rc_problem problem = {
        .boundary = what->boundary, .pair.estar = estar, .tol = 1e-4, .threads = threads};
    struct rc_err err;

    must_be(rc_synth_selfaffine(&shape, &roughness, h, &err), &err);
    if (!rc_has_mean(what->boundary)) {
        problem.load = what->load * estar * slope * area;
    } else {
        double r = 20 * side, *sphere = map_new(shape.nx * shape.ny);
        rc_synth_sphere(&shape, r, sphere);
        for (size_t k = 0; k < shape.nx * shape.ny; k++)
            h[k] = 0.05 * h[k] + sphere[k];
        free(sphere);
        problem.load = what->load * 4 * estar * pow(side / 2, 3) / (3 * r);
    }
    if (what->hardness > 0)
        problem.hardness =
            what->hardness * problem.load / area *
            (rc_repeats(what->boundary) == 0 ? 1 / (0.7 * pow(what->load, 2. / 3)) : 1);
    return problem;
}

static double *
truth(struct rc_shape shape, const double *h, struct rc_problem problem, double tol,
      struct rc_contact *c)
{
    size_t n = shape.nx * shape.ny;
    double *p = map_new(n);
    struct rc_solver *s;

    problem.tol = tol;
    problem.method = NULL;
    s = solver_new(shape, h, problem);
    solver_run(s);
    rc_solver_result(s, NULL, NULL, c);
    memcpy(p, rc_solver_pressure(s), n * sizeof *p);
    rc_solver_free(s);
    return p;
}

static void
table(size_t m)
{
    struct rc_shape shape = {m, m, 1e-6, 1e-6};
    size_t n = m * m;
    double *h = map_new(n);

    printf("\n%zu x %zu, %s, true error %.0e, %zu threads\n", m, m, method, wanted, threads);
    printf("%-12s %8s %8s %6s | %6s %6s | %6s %6s %8s %8s %8s\n", "surface", "contact", "plastic",
           "at 1e-9", "its", "equiv", "its", "equiv", "seconds", "estimate", "true");
    for (size_t k = 0; k < SURFACES; k++) {
        struct rc_problem problem = make(&surfaces[k], shape, h);
        struct rc_contact exact, c;
        double *p = truth(shape, h, problem, 1e-9, &exact), seconds, reached = NAN;
        struct rc_solver *s;
        size_t its = 0;

        problem.method = method;
        problem.tol = 1e-12; /* never reached: errors are measured on the way */
        s = solver_new(shape, h, problem);
        while (rc_solver_step(s) == RC_MORE) {
            if (error_l1(n, rc_solver_pressure(s), p) <= wanted) {
                reached = rc_solver_convolutions(s);
                its = solver_progress(s).iterations;
                break;
            }
        }
        rc_solver_free(s);
        problem.tol = wanted;
        seconds = now();
        s = solver_new(shape, h, problem);
        solver_run(s);
        seconds = now() - seconds;
        c.convolutions = rc_solver_convolutions(s);
        printf("%-12s %8.4f %8.4f %6.1f | %6zu %6.1f | %6zu %6.1f %8.3f %8.1e %8.1e\n",
               surfaces[k].name, exact.contact_fraction, (double)exact.plastic_nodes / (double)n,
               exact.convolutions, its, reached, solver_progress(s).iterations, c.convolutions,
               seconds, solver_progress(s).error, error_l1(n, rc_solver_pressure(s), p));
        fflush(stdout);
        rc_solver_free(s);
        free(p);
    }
    free(h);
}

static void
estimate(size_t m)
{
    struct rc_shape shape = {m, m, 1e-6, 1e-6};
    size_t n = m * m;
    double *h = map_new(n);

    printf(
        "\n%zu x %zu, %s: estimate over true error, every iteration with a true error above 1e-8\n",
        m, m, method);
    for (size_t k = 0; k < SURFACES; k++) {
        struct rc_problem problem = make(&surfaces[k], shape, h);
        struct rc_contact exact;
        double *p = truth(shape, h, problem, 1e-9, &exact), before, *old = map_new(n);
        struct rc_progress at;
        struct rc_solver *s;
        enum rc_status status;

        problem.method = method;
        problem.tol = 1e-8;
        s = solver_new(shape, h, problem);
        printf("%-12s %.4f:", surfaces[k].name, exact.contact_fraction);
        do { /* the estimate of a step is that of the pressure before it */
            memcpy(old, rc_solver_pressure(s), n * sizeof *old);
            status = rc_solver_step(s);
            before = error_l1(n, old, p);
            at = solver_progress(s);
            if (before > 1e-8 && !at.coarser && !isnan(at.error))
                printf(" %.2f@%.0e", at.error / before, before);
        } while (status == RC_MORE);
        printf("\n");
        rc_solver_free(s);
        free(p);
        free(old);
    }
    free(h);
}

/* ---- work against size ---- */

static struct rc_problem
make_periodic(const struct roughness *what, double pressure, struct rc_shape shape, double *h)
{
    static const double slope = 0.1, estar = 1e9;
    double side = (double)shape.nx * shape.dx;
    struct rc_selfaffine roughness = {.hurst = 0.8,
                                      .rms_slope = slope,
                                      .short_cut = what->cut * shape.dx,
                                      .rolloff = what->rolloff * side,
                                      .seed = 5};
    struct rc_err err;

    must_be(rc_synth_selfaffine(&shape, &roughness, h, &err), &err);
    return (struct rc_problem){.boundary = RC_PERIODIC,
                               .pair.estar = estar,
                               .load = pressure * estar * slope * side * side,
                               .tol = wanted,
                               .threads = threads};
}

/* Equivalents until the error against p is the requested one; *its: iterations. */
static double
work_to(const double *p, struct rc_shape shape, const double *h, struct rc_problem problem,
        size_t *its)
{
    struct rc_solver *s;
    double reached = NAN;

    problem.tol = 1e-12; /* never reached: errors are measured on the way */
    problem.method = method;
    s = solver_new(shape, h, problem);
    while (rc_solver_step(s) == RC_MORE)
        if (error_l1(shape.nx * shape.ny, rc_solver_pressure(s), p) <= wanted) {
            reached = rc_solver_convolutions(s);
            break;
        }
    *its = solver_progress(s).iterations;
    rc_solver_free(s);
    return reached;
}

static void
growth(void)
{
    printf("periodic, Hurst 0.8, %s, true error %.0e, %zu threads\n", method, wanted, threads);
    printf("%4s %8s %6s %8s | %4s %6s | %4s %6s %8s %8s %8s\n", "cut", "roll-off", "nodes",
           "contact", "its", "equiv", "its", "equiv", "seconds", "estimate", "true");
    for (size_t r = 0; r < sizeof roughnesses / sizeof *roughnesses; r++)
        for (size_t k = 0; k < sizeof pressures / sizeof *pressures; k++)
            for (size_t i = 0; i < count; i++) {
                size_t m = sizes[i], its;
                struct rc_shape shape = {m, m, 1e-6, 1e-6};
                double *h = map_new(m * m), *p, reached, seconds;
                struct rc_problem problem = make_periodic(&roughnesses[r], pressures[k], shape, h);
                struct rc_contact exact;
                struct rc_solver *s;

                p = truth(shape, h, problem, 1e-3 * wanted, &exact);
                reached = work_to(p, shape, h, problem, &its);
                problem.method = method;
                seconds = now();
                s = solver_new(shape, h, problem);
                solver_run(s);
                seconds = now() - seconds;
                printf("%4g %8g %6zu %7.1f%% | %4zu %6.1f | %4zu %6.1f %8.3f %8.1e %8.1e\n",
                       roughnesses[r].cut, roughnesses[r].rolloff, m, 100 * exact.contact_fraction,
                       its, reached, solver_progress(s).iterations, rc_solver_convolutions(s),
                       seconds, solver_progress(s).error,
                       error_l1(m * m, rc_solver_pressure(s), p));
                fflush(stdout);
                rc_solver_free(s);
                free(p);
                free(h);
            }
}

/* ---- a solve beside its convolutions ---- */

struct conv_work {
    struct rc_conv *conv;
    const double *p;
    double *u;
};

static void
conv_run(void *at)
{
    struct conv_work *w = at;

    rc_conv_apply(w->conv, w->p, w->u);
}

struct solve {
    struct rc_shape shape;
    const double *h;
    struct rc_problem problem;
    double convolutions;
};

static void
solve_run(void *at)
{
    struct solve *w = at;
    struct rc_solver *s = solver_new(w->shape, w->h, w->problem);

    solver_run(s);
    w->convolutions = rc_solver_convolutions(s);
    rc_solver_free(s);
}

static void
whole(void)
{
    static const size_t some[] = {0, 2, 4};

    printf("periodic, Hurst 0.8, tolerance %.0e, %zu threads\n", wanted, threads);
    printf("%4s %6s %8s | %8s %8s %10s %6s\n", "cut", "nodes", "pressure", "seconds", "equiv",
           "one, ms", "ratio");
    for (size_t r = 0; r < sizeof roughnesses / sizeof *roughnesses; r += 2)
        for (size_t i = 0; i < count; i++)
            for (size_t k = 0; k < sizeof some / sizeof *some; k++) {
                size_t m = sizes[i];
                struct rc_shape shape = {m, m, 1e-6, 1e-6};
                double *h = map_new(m * m), *u = map_new(m * m), least[2];
                double pressure = pressures[some[k]];
                struct solve one = {.shape = shape, .h = h};
                struct rc_conv_options options = {
                    .boundary = RC_PERIODIC, .engine = "fft64", .threads = threads};
                struct rc_err err;
                struct rc_conv *conv =
                    must(rc_conv_new(&shape, &(struct rc_pair){.estar = 1e9}, &options, &err));
                struct conv_work convolution = {conv, h, u};
                struct work work[] = {{solve_run, &one}, {conv_run, &convolution}};

                one.problem = make_periodic(&roughnesses[r], pressure, shape, h);
                one.problem.method = method;
                take_turns(2, work, 5, 20, least);
                printf("%4g %6zu %8g | %8.3f %8.1f %10.2f %6.2f\n", roughnesses[r].cut, m, pressure,
                       least[0], one.convolutions, 1e3 * least[1],
                       least[0] / (one.convolutions * least[1]));
                fflush(stdout);
                rc_conv_free(conv);
                free(h);
                free(u);
            }
}

/* ---- maps that repeat along one axis ---- */

/* Rough with a shortest wave of 8 nodes, and of equal rows if it is extruded. */
static void
rough(struct rc_shape shape, bool extruded, double *h)
{
    struct rc_shape own = {shape.nx, extruded ? 1 : shape.ny, shape.dx, shape.dy};
    struct rc_selfaffine roughness = {.hurst = 0.8,
                                      .rms_slope = 0.1,
                                      .short_cut = 8 * shape.dx,
                                      .rolloff = (double)shape.nx * shape.dx / 4,
                                      .seed = 5};
    struct rc_err err;

    must_be(rc_synth_selfaffine(&own, &roughness, h, &err), &err);
    for (size_t j = 1; j < shape.ny && extruded; j++)
        memcpy(h + j * shape.nx, h, shape.nx * sizeof *h);
}

static void
axes(void)
{
    static const struct {
        const char *name;
        struct rc_boundary boundary;
    } kinds[] = {{"free", {.x = false}},
                 {"x", {.x = true}},
                 {"y", {.y = true}},
                 {"xy", {.x = true, .y = true}}};

    printf("Hurst 0.8, %s, true error %.0e, %zu threads\n", method, wanted, threads);
    printf("%-9s %8s %6s %7s %8s | %4s %6s | %4s %6s %8s %8s %8s %8s\n", "rough", "pressure",
           "nodes", "repeats", "contact", "its", "equiv", "its", "equiv", "plans, s", "steps, s",
           "estimate", "true");
    for (int extruded = 0; extruded < 2; extruded++)
        for (size_t k = 0; k < sizeof pressures / sizeof *pressures; k++)
            for (size_t i = 0; i < count; i++)
                for (size_t b = 0; b < sizeof kinds / sizeof *kinds; b++) {
                    size_t m = sizes[i], its;
                    struct rc_shape shape = {m, m, 1e-6, 1e-6};
                    double *h = map_new(m * m), *p, reached, plans, steps;
                    struct rc_problem problem = {.boundary = kinds[b].boundary,
                                                 .pair.estar = 1e9,
                                                 .load =
                                                     pressures[k] * 1e8 * (double)(m * m) * 1e-12,
                                                 .tol = wanted,
                                                 .threads = threads};
                    struct rc_contact exact;
                    struct rc_solver *s;

                    rough(shape, extruded, h);
                    p = truth(shape, h, problem, 1e-3 * wanted, &exact);
                    reached = work_to(p, shape, h, problem, &its);
                    problem.method = method;
                    plans = (double)clock();
                    s = solver_new(shape, h, problem);
                    steps = (double)clock();
                    plans = (steps - plans) / CLOCKS_PER_SEC;
                    solver_run(s);
                    steps = ((double)clock() - steps) / CLOCKS_PER_SEC;
                    printf("%-9s %8g %6zu %7s %7.1f%% | %4zu %6.1f | %4zu %6.1f %8.3f %8.3f %8.1e "
                           "%8.1e\n",
                           extruded ? "along x" : "both", pressures[k], m, kinds[b].name,
                           100 * exact.contact_fraction, its, reached,
                           solver_progress(s).iterations, rc_solver_convolutions(s), plans, steps,
                           solver_progress(s).error, error_l1(m * m, rc_solver_pressure(s), p));
                    fflush(stdout);
                    rc_solver_free(s);
                    free(p);
                    free(h);
                }
}

static void
tables(void)
{
    for (size_t i = 0; i < count; i++)
        table(sizes[i]);
}

static void
estimates(void)
{
    for (size_t i = 0; i < count; i++)
        estimate(sizes[i]);
}

int
main(int argc, char **argv)
{
    static const struct part parts[] = {{"table", tables, false},
                                        {"estimate", estimates, true},
                                        {"growth", growth, true},
                                        {"whole", whole, true},
                                        {"axes", axes, true}};

    threads = threads_wanted();
    for (int option; (option = getopt(argc, argv, "n:t:m:")) != -1;)
        switch (option) {
        case 'n':
            count = sizes_read(optarg, 16, sizes);
            break;
        case 't':
            wanted = atof(optarg);
            break;
        case 'm':
            method = optarg;
            break;
        default:
            return 2;
        }
    return parts_run(sizeof parts / sizeof *parts, parts, argc - optind, argv + optind);
}
