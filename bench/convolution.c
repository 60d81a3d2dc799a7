/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The cost of a convolution for each engine:
 *
 *     bench-convolution [fftw] [sparse] [sizes]       (default: all)
 *
 * fftw    the Fourier engine and FFTW's two-dimensional transforms, in the same run
 * sparse  MLMS and the Fourier engine, with all nodes loaded and with 5 % of them
 * sizes   time a node from 256^2 to 4096^2
 *
 * Times are the shortest of several runs. RC_THREADS sets the threads.
 */
#include "bench.h"

#include <complex.h>
#include <fftw3.h>
#include <sys/wait.h>
#include <unistd.h>

#include "libcontact/memory.h"

static size_t threads;

static struct rc_sum
square(size_t m)
{
    struct rc_sum sum = point_sum((struct rc_shape){m, m, 1, 1});

    sum.threads = threads;
    return sum;
}

/* ---- against FFTW ---- */

/* FFTW's forward and inverse transform of px x py reals, with measured plans, in place. */
struct pair {
    double *x;
    fftw_plan plan[2];
};

static void
pair_run(void *what)
{
    const struct pair *its = what;

    fftw_execute(its->plan[0]);
    fftw_execute(its->plan[1]);
}

static struct pair
pair_new(size_t px, size_t py)
{
    size_t stride = 2 * (px / 2 + 1);
    struct pair its = {.x = must(rc_alloc(stride * py, sizeof *its.x))};

    fftw_plan_with_nthreads((int)threads);
    its.plan[0] = must(
        fftw_plan_dft_r2c_2d((int)py, (int)px, its.x, (fftw_complex *)(void *)its.x, FFTW_MEASURE));
    its.plan[1] = must(
        fftw_plan_dft_c2r_2d((int)py, (int)px, (fftw_complex *)(void *)its.x, its.x, FFTW_MEASURE));
    fftw_plan_with_nthreads(1); /* otherwise it would also apply to the engine's plans */
    memset(its.x, 0, stride * py * sizeof *its.x);
    return its;
}

static void
pair_free(struct pair *its)
{
    fftw_destroy_plan(its->plan[0]);
    fftw_destroy_plan(its->plan[1]);
    free(its->x);
}

/* The shortest times of two pieces of work, five times each in turns for four seconds. */
static void
duel(struct work a, struct work b, double least[2])
{
    take_turns(2, (struct work[2]){a, b}, 5, 4, least);
}

/* Prints the bytes per node for planning and applying beyond p and u. They are the growth of the peak
 * resident set, in a separate process (below), because memory freed before would hide it. */
static void
peak_bytes(const struct rc_engine *e, const struct rc_sum *sum)
{
    char m[32], tol[32];
    int status;
    pid_t child;

    snprintf(m, sizeof m, "%zu", sum->shape.nx);
    snprintf(tol, sizeof tol, "%g", sum->tol);
    fflush(stdout);
    child = fork();
    if (child == 0) {
        execl("/proc/self/exe", "bench-convolution", "peak", e->info.name, m,
              rc_boundary_word(sum->boundary), tol, (char *)NULL);
        _exit(1);
    }
    waitpid(child, &status, 0);
}

/* Peak resident set so far, in bytes. (getrusage would include the process before exec.) */
static double
peak_now(void)
{
    FILE *status = must(fopen("/proc/self/status", "r"));
    char line[256];
    double kib = 0;

    while (fgets(line, sizeof line, status) != NULL)
        if (strncmp(line, "VmHWM:", 6) == 0)
            kib = atof(line + 6);
    fclose(status);
    return 1024 * kib;
}

/* bench-convolution peak ENGINE M BOUNDARY TOL */
static void
peak_child(char **argv)
{
    struct rc_sum sum = square((size_t)strtoul(argv[3], NULL, 10));
    const struct rc_engine *e = engine_named(argv[2]);
    size_t n = sum.shape.nx * sum.shape.ny;
    double *p = must(rc_alloc(n, sizeof *p)), *u = must(rc_alloc(n, sizeof *u));
    struct rc_err err;
    double before;
    void *plan;

    sum.boundary = strcmp(argv[4], rc_boundary_word(RC_FREE)) == 0 ? RC_FREE : RC_PERIODIC;
    sum.tol = atof(argv[5]);
    for (size_t k = 0; k < n; k++)
        u[k] = p[k] = 1;
    before = peak_now();
    plan = must(e->new (&sum, &err));
    e->apply(plan, p, u);
    printf("%.1f", (peak_now() - before) / (double)n);
    e->free(plan);
    free(p);
    free(u);
}

static void
against_fftw(void)
{
    const struct rc_engine *e = engine_named("fft");

    printf("\nThe Fourier engine against FFTW's two-dimensional pair (FFTW_MEASURE, no "
           "multiplication), %zu threads\n",
           threads);
    printf("%6s %-9s %10s %10s %8s %12s %12s %s\n", "M", "boundary", "ours ms", "FFTW ms", "ratio",
           "our plan ms", "its plan ms", "bytes a node beyond p and u");
    for (size_t m = 512; m <= 2048; m *= 2)
        for (int periodic = 0; periodic < 2; periodic++) {
            const struct rc_boundary boundary = periodic ? RC_PERIODIC : RC_FREE;
            struct rc_sum sum = square(m);
            size_t padded = periodic ? m : 2 * m;
            double *p = must(rc_alloc(m * m, sizeof *p)), *u = must(rc_alloc(m * m, sizeof *u));
            struct pair its;
            struct sum_work sum_work;
            double plan_time, its_plan, best[2];
            uint64_t seed = 1;
            struct rc_err err;
            void *plan;

            sum.boundary = boundary;
            for (size_t k = 0; k < m * m; k++)
                p[k] = uniform(&seed);
            plan_time = now();
            plan = must(e->new (&sum, &err));
            plan_time = now() - plan_time;
            its_plan = now();
            its = pair_new(padded, padded);
            its_plan = now() - its_plan;
            sum_work = (struct sum_work){e, plan, p, u};
            duel((struct work){sum_run, &sum_work}, (struct work){pair_run, &its}, best);
            e->free(plan);
            pair_free(&its);
            printf("%6zu %-9s %10.2f %10.2f %8.2f %12.1f %12.1f ", m, rc_boundary_word(boundary),
                   1e3 * best[0], 1e3 * best[1], best[0] / best[1], 1e3 * plan_time,
                   1e3 * its_plan);
            fflush(stdout);
            peak_bytes(e, &sum);
            printf("\n");
            free(p);
            free(u);
        }
}

/* ---- MLMS against the Fourier engine ---- */

enum load {
    ALL,
    DISC,
    SPOTS
};

/* Pressure on every node; on a disc of 5 % of the map; on as many nodes in 300 spots. */
static void
load_map(enum load what, size_t m, double *p)
{
    uint64_t seed = 3;
    double area = 0.05 * (double)m * (double)m;

    for (size_t k = 0; k < m * m; k++) {
        double x = (double)(k % m) - (double)m / 2, y = (double)(k / m) - (double)m / 2;
        p[k] = what == ALL || (what == DISC && RC_PI * (x * x + y * y) < area) ? uniform(&seed) : 0;
    }
    for (int spot = 0; what == SPOTS && spot < 300; spot++) {
        double cx = uniform(&seed) * (double)m, cy = uniform(&seed) * (double)m;
        double r = sqrt(area / 300 / RC_PI);
        for (double y = fmax(0, cy - r); y < fmin(cy + r, (double)m - 1); y++)
            for (double x = fmax(0, cx - r); x < fmin(cx + r, (double)m - 1); x++)
                if (hypot(x - cx, y - cy) < r)
                    p[(size_t)y * m + (size_t)x] = uniform(&seed);
    }
}

static void
sparse(void)
{
    static const char *const names[] = {"all nodes", "5 % in a disc", "5 % in 300 spots"};
    size_t m = 1024;
    double *p = must(rc_alloc(m * m, sizeof *p)), *u = must(rc_alloc(m * m, sizeof *u));
    double *v = must(rc_alloc(m * m, sizeof *v));
    struct rc_err err;

    printf("\nMLMS for an error of 1e-6 against the Fourier engine, %zu x %zu, %zu threads\n", m, m,
           threads);
    printf("%-18s %10s %10s %8s %12s\n", "loaded", "mlms ms", "fft ms", "ratio", "difference");
    for (int what = 0; what < 3; what++) {
        struct rc_sum sum = square(m);
        void *fft = must(engine_named("fft")->new (&sum, &err)), *mlms;
        double best[2];

        sum.tol = 1e-6;
        mlms = must(engine_named("mlms")->new (&sum, &err));
        load_map((enum load)what, m, p);
        duel((struct work){sum_run, &(struct sum_work){engine_named("mlms"), mlms, p, v}},
             (struct work){sum_run, &(struct sum_work){engine_named("fft"), fft, p, u}}, best);
        printf("%-18s %10.2f %10.2f %8.2f %12.1e\n", names[what], 1e3 * best[0], 1e3 * best[1],
               best[0] / best[1], error_l2(m * m, v, u));
        engine_named("fft")->free(fft);
        engine_named("mlms")->free(mlms);
    }
    {
        struct rc_sum sum = square(m);
        printf("peak bytes a node beyond p and u: fft ");
        peak_bytes(engine_named("fft"), &sum);
        sum.tol = 1e-6;
        printf(", mlms ");
        peak_bytes(engine_named("mlms"), &sum);
        printf("\n");
    }
    free(p);
    free(u);
    free(v);
}

/* ---- time a node ---- */

static void
sizes(void)
{
    printf("\nNanoseconds a node, %zu threads\n", threads);
    printf("%6s %10s %10s %10s %10s %10s\n", "M", "direct", "fft", "fft float", "periodic",
           "mlms 1e-6");
    for (size_t m = 256; m <= 4096; m *= 2) {
        static const struct {
            const char *name;
            double tol;
            struct rc_boundary boundary;
        } columns[] = {{"direct", 0, FREE},
                       {"fft", 0, FREE},
                       {"fft", 1e-4, FREE},
                       {"fft", 0, PERIODIC},
                       {"mlms", 1e-6, FREE}};
        double *p = must(rc_alloc(m * m, sizeof *p)), *u = must(rc_alloc(m * m, sizeof *u));
        uint64_t seed = 1;

        for (size_t k = 0; k < m * m; k++)
            p[k] = uniform(&seed);
        printf("%6zu", m);
        for (size_t c = 0; c < sizeof columns / sizeof *columns; c++) {
            struct rc_sum sum = square(m);
            const struct rc_engine *e = engine_named(columns[c].name);
            struct rc_err err;
            void *plan;

            if (c == 0 && m > 256) {
                printf(" %10s", "-");
                continue;
            }
            sum.tol = columns[c].tol;
            sum.boundary = columns[c].boundary;
            plan = must(e->new (&sum, &err));
            printf(" %10.2f", 1e9 * sum_seconds((struct sum_work){e, plan, p, u}, c == 0 ? 1 : 5) /
                                  (double)(m * m));
            fflush(stdout);
            e->free(plan);
        }
        printf("\n");
        free(p);
        free(u);
    }
}

int
main(int argc, char **argv)
{
    static const struct part parts[] = {
        {"fftw", against_fftw, false}, {"sparse", sparse, false}, {"sizes", sizes, false}};

    threads = threads_wanted();
    if (argc == 6 && strcmp(argv[1], "peak") == 0) {
        peak_child(argv);
        return 0;
    }
    fftw_init_threads();
    return parts_run(sizeof parts / sizeof *parts, parts, argc - 1, argv + 1);
}
