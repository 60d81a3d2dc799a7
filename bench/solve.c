/*
 * What a contact costs:
 *
 *     bench-solve [-n SIZE,SIZE...] [-t TOL] [-m METHOD] [table] [estimate] [hertz]        (default: table)
 *
 * table     convolution equivalents, iterations and seconds to a true relative L1 error of the
 *           pressure (default 1e-4), coarse levels included, and what the certified solution to that
 *           tolerance costs
 * estimate  estimate over true error, every iteration
 * hertz     the paper's Fig. 1: errors of contact radius and pressure against the exact ones at a tenth of
 *           its tolerance M^(-3/2), and the iterations of both methods at that tolerance, of pk99 also by the paper's criterion, (32)
 *
 * Surfaces: periodic self-affine (Hurst 0.8, cut at 8 nodes, rolled off at an eighth of the map) and a
 * sphere with such roughness on the free half-space. The truth is the same solver at 1e-9. RC_THREADS sets
 * the threads.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "libcontact/contact.h"

struct surface {
    const char *name;
    enum rc_boundary boundary;
    double load;     /* periodic: mean pressure over E* and RMS slope; free: load as a part of that which
                        makes a Hertz circle as wide as the map                               */
    double hardness; /* over the mean pressure; 0: none                                        */
};

static const struct surface surfaces[] = {
    {"periodic", RC_PERIODIC, 0.004, 0},  {"periodic", RC_PERIODIC, 0.04, 0},
    {"periodic", RC_PERIODIC, 0.18, 0},   {"periodic", RC_PERIODIC, 0.28, 0},
    {"periodic", RC_PERIODIC, 0.5, 0},    {"periodic", RC_PERIODIC, 1.2, 0},
    {"sphere", RC_FREE, 0.004, 0},        {"sphere", RC_FREE, 0.1, 0},
    {"periodic, H", RC_PERIODIC, 0.1, 3}, {"sphere, H", RC_FREE, 0.1, 1.2},
};

enum {
    SURFACES = sizeof surfaces / sizeof *surfaces
};

static size_t threads;

static double
now(void)
{
    struct timespec ts;

    clock_gettime(CLOCK_MONOTONIC, &ts);
    return (double)ts.tv_sec + 1e-9 * (double)ts.tv_nsec;
}

static void *
must(void *p)
{
    if (p == NULL) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
    return p;
}

static struct rc_problem
make(const struct surface *what, struct rc_shape shape, double *h)
{
    static const double slope = 0.1, estar = 1e9;
    double side = (double)shape.nx * shape.dx, area = side * side;
    struct rc_selfaffine roughness = {.hurst = 0.8, .rms_slope = slope, .rms_height = NAN,
                                      .short_cut = 8 * shape.dx, .rolloff = side / 8, .long_cut = NAN,
                                      .seed = 5};
    struct rc_problem problem = {.boundary = what->boundary, .estar = estar, .hardness = INFINITY,
                                 .tol = 1e-4, .threads = threads};
    struct rc_err err;

    if (rc_synth_selfaffine(&shape, &roughness, h, &err) != RC_OK) {
        fprintf(stderr, "%s\n", err.text);
        exit(1);
    }
    if (what->boundary == RC_PERIODIC) {
        problem.load = what->load * estar * slope * area;
    } else {
        double r = 20 * side, *sphere = must(malloc(shape.nx * shape.ny * sizeof *sphere));
        rc_synth_sphere(&shape, r, sphere);
        for (size_t k = 0; k < shape.nx * shape.ny; k++)
            h[k] = 0.05 * h[k] + sphere[k];
        free(sphere);
        problem.load = what->load * 4 * estar * pow(side / 2, 3) / (3 * r);
    }
    if (what->hardness > 0)
        problem.hardness = what->hardness * problem.load / area *
                           (what->boundary == RC_FREE ? 1 / (0.7 * pow(what->load, 2. / 3)) : 1);
    return problem;
}

static struct rc_solver *
start(struct rc_shape shape, const double *h, const struct rc_problem *problem)
{
    struct rc_err err;
    struct rc_solver *s = rc_solver_new(&shape, h, problem, &err);

    if (s == NULL) {
        fprintf(stderr, "%s\n", err.text);
        exit(1);
    }
    return s;
}

static double
distance(size_t n, const double *a, const double *b)
{
    double apart = 0, size = 0;

    for (size_t k = 0; k < n; k++) {
        apart += fabs(a[k] - b[k]);
        size += fabs(b[k]);
    }
    return apart / size;
}

static double *
truth(struct rc_shape shape, const double *h, struct rc_problem problem, struct rc_contact *c)
{
    size_t n = shape.nx * shape.ny;
    double *p = must(malloc(n * sizeof *p));
    struct rc_solver *s;

    problem.tol = 1e-9;
    problem.method = NULL;
    s = start(shape, h, &problem);
    while (rc_solver_step(s) == RC_MORE)
        ;
    rc_solver_result(s, NULL, NULL, c);
    memcpy(p, rc_solver_pressure(s), n * sizeof *p);
    rc_solver_free(s);
    return p;
}

static void
table(size_t m, double tol, const char *method)
{
    struct rc_shape shape = {m, m, 1e-6, 1e-6};
    size_t n = m * m;
    double *h = must(malloc(n * sizeof *h));

    printf("\n%zu x %zu, %s, true error %.0e, %zu threads\n", m, m, method, tol, threads);
    printf("%-12s %8s %8s %6s | %6s %6s | %6s %6s %8s %8s %8s\n", "surface", "contact", "plastic", "at 1e-9", "its",
           "equiv", "its", "equiv", "seconds", "estimate", "true");
    for (size_t k = 0; k < SURFACES; k++) {
        struct rc_problem problem = make(&surfaces[k], shape, h);
        struct rc_contact exact, c;
        double *p = truth(shape, h, problem, &exact), seconds, reached = NAN;
        struct rc_solver *s;
        size_t its = 0;

        problem.method = method;
        problem.tol = 1e-12; /* steps without an end: how far is it? */
        s = start(shape, h, &problem);
        while (rc_solver_step(s) == RC_MORE) {
            if (distance(n, rc_solver_pressure(s), p) <= tol) {
                reached = rc_solver_convolutions(s);
                its = rc_solver_iterations(s);
                break;
            }
        }
        rc_solver_free(s);
        problem.tol = tol;
        seconds = now();
        s = start(shape, h, &problem);
        while (rc_solver_step(s) == RC_MORE)
            ;
        seconds = now() - seconds;
        c.convolutions = rc_solver_convolutions(s);
        printf("%-12s %8.4f %8.4f %6.1f | %6zu %6.1f | %6zu %6.1f %8.3f %8.1e %8.1e\n", surfaces[k].name,
               exact.contact_fraction, (double)exact.plastic_nodes / (double)n, exact.convolutions, its, reached,
               rc_solver_iterations(s), c.convolutions, seconds, rc_solver_error(s),
               distance(n, rc_solver_pressure(s), p));
        fflush(stdout);
        rc_solver_free(s);
        free(p);
    }
    free(h);
}

static void
estimate(size_t m, const char *method)
{
    struct rc_shape shape = {m, m, 1e-6, 1e-6};
    size_t n = m * m;
    double *h = must(malloc(n * sizeof *h));

    printf("\n%zu x %zu, %s: estimate over true error, every iteration with a true error above 1e-8\n", m,
           m, method);
    for (size_t k = 0; k < SURFACES; k++) {
        struct rc_problem problem = make(&surfaces[k], shape, h);
        struct rc_contact exact;
        double *p = truth(shape, h, problem, &exact), before, *old = must(malloc(n * sizeof *old));
        struct rc_solver *s;
        enum rc_status status;

        problem.method = method;
        problem.tol = 1e-8;
        s = start(shape, h, &problem);
        printf("%-12s %.4f:", surfaces[k].name, exact.contact_fraction);
        do { /* the estimate of a step is that of the pressure before it */
            memcpy(old, rc_solver_pressure(s), n * sizeof *old);
            status = rc_solver_step(s);
            before = distance(n, old, p);
            if (before > 1e-8 && !isnan(rc_solver_error(s)))
                printf(" %.2f@%.0e", rc_solver_error(s) / before, before);
        } while (status == RC_MORE);
        printf("\n");
        rc_solver_free(s);
        free(p);
        free(old);
    }
    free(h);
}

/* ---- the paper's Fig. 1 ---- */

static struct rc_contact
solved(struct rc_shape shape, const double *h, struct rc_problem problem, double *p)
{
    struct rc_solver *s = start(shape, h, &problem);
    struct rc_contact c;

    while (rc_solver_step(s) == RC_MORE)
        ;
    rc_solver_result(s, NULL, NULL, &c);
    memcpy(p, rc_solver_pressure(s), shape.nx * shape.ny * sizeof *p);
    rc_solver_free(s);
    return c;
}

/* Iterations until the relative change of the pressure, (32) of the paper, is at most tol. */
static size_t
by_change(struct rc_shape shape, const double *h, struct rc_problem problem, double tol, double *old)
{
    size_t n = shape.nx * shape.ny, its = 0;
    struct rc_solver *s;
    double change;

    problem.tol = 1e-3 * tol; /* goes on until it is told to stop */
    s = start(shape, h, &problem);
    do {
        memcpy(old, rc_solver_pressure(s), n * sizeof *old);
        if (rc_solver_step(s) != RC_MORE)
            break;
        change = distance(n, old, rc_solver_pressure(s));
        its++;
    } while (change > tol);
    rc_solver_free(s);
    return its;
}

static void
hertz(size_t m)
{
    static const double pi = 3.14159265358979323846, radius = 7.5e-3, estar = 113.93e9, load = 240;
    double a = cbrt(0.75 * load * radius / estar), step = 2.1 * a / (double)m;
    struct rc_shape shape = {m, m, step, step};
    double peak = 1.5 * load / (pi * a * a), tol = pow((double)m, -1.5);
    double *h = must(malloc(m * m * sizeof *h)), *p = must(malloc(m * m * sizeof *p));
    struct rc_problem problem = {.boundary = RC_FREE, .estar = estar, .load = load, .hardness = INFINITY,
                                 .tol = 0.1 * tol, .method = "pcg", .threads = threads};
    double off = 0, size = 0, r, r_off;
    struct rc_contact c;
    size_t its[3];

    rc_synth_sphere(&shape, radius, h);
    c = solved(shape, h, problem, p);
    for (size_t k = 0; k < m * m; k++) {
        double x = ((double)(k % m) - ((double)m - 1) / 2) * step;
        double y = ((double)(k / m) - ((double)m - 1) / 2) * step;
        double exact = peak * sqrt(fmax(0, 1 - (x * x + y * y) / (a * a)));
        off += fabs(p[k] - exact);
        size += exact;
    }
    r = sqrt(c.contact_area / pi);
    r_off = fabs(r / a - 1);
    problem.tol = tol;
    its[0] = solved(shape, h, problem, p).iterations;
    problem.method = "pk99";
    its[1] = solved(shape, h, problem, p).iterations;
    its[2] = by_change(shape, h, problem, tol, p);
    printf("%6zu %10.2e %8.2f %10.2e %8.2f %8zu %8zu %8zu\n", m, r_off, r_off * (double)m, off / size,
           off / size / tol, its[0], its[1], its[2]);
    free(h);
    free(p);
}

int
main(int argc, char **argv)
{
    const char *threads_text = getenv("RC_THREADS"), *method = "pcg";
    size_t sizes[16] = {512, 1024, 2048}, count = 3;
    double tol = 1e-4;
    bool any = false;

    threads = threads_text == NULL ? 0 : strtoul(threads_text, NULL, 10);
    for (int k = 1; k < argc; k++) {
        if (strcmp(argv[k], "-n") == 0 && k + 1 < argc) {
            count = 0;
            for (char *w = strtok(argv[++k], ","); w != NULL && count < 16; w = strtok(NULL, ","))
                sizes[count++] = strtoul(w, NULL, 10);
        } else if (strcmp(argv[k], "-t") == 0 && k + 1 < argc) {
            tol = atof(argv[++k]);
        } else if (strcmp(argv[k], "-m") == 0 && k + 1 < argc) {
            method = argv[++k];
        } else {
            any = true;
            if (strcmp(argv[k], "hertz") == 0) {
                printf("\n%6s %10s %8s %10s %8s %8s %8s %8s\n", "M", "radius", "x M", "pressure",
                       "x M^1.5", "pcg its", "pk99 its", "by (32)");
                for (size_t m = 64; m <= 1024; m *= 2)
                    hertz(m);
                continue;
            }
            for (size_t i = 0; i < count; i++)
                if (strcmp(argv[k], "estimate") == 0)
                    estimate(sizes[i], method);
                else
                    table(sizes[i], tol, method);
        }
    }
    for (size_t i = 0; !any && i < count; i++)
        table(sizes[i], tol, method);
    return 0;
}
