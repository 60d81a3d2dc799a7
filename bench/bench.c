/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bench.h"

#include <time.h>

int
parts_run(size_t count, const struct part *parts, int names, char **name)
{
    for (int k = 0; k < names; k++) {
        bool known = false;
        for (size_t i = 0; i < count; i++)
            known = known || strcmp(name[k], parts[i].name) == 0;
        if (known)
            continue;
        fprintf(stderr, "no part '%s': there are", name[k]);
        for (size_t i = 0; i < count; i++)
            fprintf(stderr, " %s", parts[i].name);
        fprintf(stderr, "\n");
        return 2;
    }
    for (size_t i = 0; i < count; i++) {
        bool wanted = names == 0 && !parts[i].only_asked;
        for (int k = 0; k < names; k++)
            wanted = wanted || strcmp(name[k], parts[i].name) == 0;
        if (wanted)
            parts[i].run();
        fflush(stdout);
    }
    return 0;
}

size_t
threads_wanted(void)
{
    const char *wish = getenv("RC_THREADS");
    size_t count = wish == NULL ? 0 : strtoul(wish, NULL, 10);

    return count > 0 ? count : rc_threads_available();
}

size_t
sizes_read(const char *text, size_t most, size_t *sizes)
{
    size_t count = 0;
    char *end;

    for (; count < most; text = end + 1) {
        sizes[count++] = strtoul(text, &end, 10);
        if (*end != ',')
            break;
    }
    return count;
}

double
now(void)
{
    struct timespec ts;

    clock_gettime(CLOCK_MONOTONIC, &ts);
    return (double)ts.tv_sec + 1e-9 * (double)ts.tv_nsec;
}

void
take_turns(size_t count, const struct work *work, int runs, double seconds, double *least)
{
    double start = now();

    for (size_t k = 0; k < count; k++)
        least[k] = INFINITY;
    do {
        for (size_t k = 0; k < count; k++)
            for (int run = 0; run < runs; run++) {
                double t = now();
                work[k].run(work[k].what);
                least[k] = fmin(least[k], now() - t);
            }
    } while (now() - start < seconds);
}

bool
once_more(double start, int runs)
{
    double spent = now() - start;

    return spent < 0.5 || (runs < 2 && spent < 5);
}

void
sum_run(void *sum_work)
{
    const struct sum_work *w = sum_work;

    w->e->apply(w->plan, w->p, w->u);
}

double
sum_seconds(struct sum_work sum, int runs)
{
    double least;

    take_turns(1, &(struct work){sum_run, &sum}, runs, runs > 1 ? 0.1 : 0, &least);
    return least;
}

void *
must(void *p)
{
    if (p == NULL) {
        fprintf(stderr, "out of memory, or a plan could not be made\n");
        exit(1);
    }
    return p;
}

void
must_be(enum rc_status status, const struct rc_err *err)
{
    if (status == RC_OK)
        return;
    fprintf(stderr, "%s\n", err->text);
    exit(1);
}

double *
map_new(size_t n)
{
    return must(calloc(n, sizeof(double)));
}

const struct rc_engine *
engine_named(const char *name)
{
    const struct rc_engine *engine = rc_engine_named(name, NULL);

    if (engine == NULL) {
        fprintf(stderr, "there is no engine '%s'\n", name);
        exit(1);
    }
    return engine;
}

struct rc_solver *
solver_new(struct rc_shape shape, const double *h, struct rc_problem problem)
{
    struct rc_err err;
    struct rc_solver *solver = rc_solver_new(&shape, h, &problem, &err);

    must_be(solver == NULL ? RC_FAIL : RC_OK, &err);
    return solver;
}

void
solver_run(struct rc_solver *solver)
{
    while (rc_solver_step(solver) == RC_MORE)
        continue;
}

struct rc_progress
solver_progress(const struct rc_solver *solver)
{
    struct rc_progress at;

    rc_solver_progress(solver, &at);
    return at;
}

double
error_l1(size_t n, const double *a, const double *b)
{
    double apart = 0, size = 0;

    for (size_t k = 0; k < n; k++) {
        apart += fabs(a[k] - b[k]);
        size += fabs(b[k]);
    }
    return apart / size;
}

double
error_l2(size_t n, const double *a, const double *b)
{
    double apart = 0, size = 0;

    for (size_t k = 0; k < n; k++) {
        apart += (a[k] - b[k]) * (a[k] - b[k]);
        size += b[k] * b[k];
    }
    return sqrt(apart / size);
}

double
exponent(size_t count, const double *x, const double *y)
{
    double sx = 0, sy = 0, sxx = 0, sxy = 0, n = (double)count;

    for (size_t k = 0; k < count; k++) {
        sx += log(x[k]);
        sy += log(y[k]);
        sxx += log(x[k]) * log(x[k]);
        sxy += log(x[k]) * log(y[k]);
    }
    return count < 3 ? NAN : (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

double
uniform(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005U + 1442695040888963407U;
    return (double)(*seed >> 11) / 9007199254740992.0;
}

struct rc_sum
point_sum(struct rc_shape shape)
{
    static struct rc_solids bodies;
    static const struct rc_surface surface = {&bodies, 1, 1};
    const struct rc_pair pair = {.estar = 1 / RC_PI};
    struct rc_err err;

    if (bodies.n == 0)
        must_be(rc_solids_new(&bodies, &pair, NULL, NULL, &err), &err);
    return (struct rc_sum){.shape = shape, .kernel = rc_surface_kernel(&surface)};
}

void
hemisphere(size_t nx, size_t ny, double *p)
{
    for (size_t k = 0; k < nx * ny; k++) {
        double x = nx > 1 ? 2 * (double)(k % nx) / (double)(nx - 1) - 1 : 0;
        double y = ny > 1 ? 2 * (double)(k / nx) / (double)(ny - 1) - 1 : 0, r2 = x * x + y * y;
        p[k] = r2 < 1 ? sqrt(1 - r2) : 0;
    }
}

size_t
paper_order(size_t m)
{
    return (size_t)lround(0.84 * log((double)m));
}

size_t
paper_correction(size_t t, size_t m)
{
    return (size_t)ceil(fmax(2 * (double)t, 0.7 * (double)t * pow((double)m, 1 / (double)t) - 1));
}
