/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The errors and the work of the multi-level sum:
 *
 *     bench-mlms [calibrate] [stability] [shapes] [counts]       (default: all)
 *
 * calibrate  the table of mlms_design.c: errors under the worst pressures found, and their estimate
 * stability  orders t = 1 .. 50 at 1024^2 with the paper's m_c, against the Fourier engine
 * shapes     aspect ratios of grid and spacing up to 100, with a requested error of 1e-6
 * counts     direct and multi-level sums on one thread: times and products, with the paper's t, m_c
 *
 * Errors are the largest of the map over the largest sum of |K| |p|. Estimates hold for any p.
 */
#include "bench.h"

#include <time.h>

#include "libcontact/operator/real_space/mlms.h"

/* A sum with both engines. */
struct pair {
    struct rc_sum sum;
    size_t n;
    struct rc_mlms *mlms;
    void *fft;
    double *p, *u, *v, *absolute;
};

static struct pair
pair_new(struct rc_sum sum)
{
    size_t n = sum.shape.nx * sum.shape.ny;
    struct pair a = {.sum = sum, .n = n};
    struct rc_err err;

    a.mlms = must(rc_engine_mlms.new(&sum, &err));
    sum.tol = 0;
    a.fft = must(rc_engine_fft.new(&sum, &err));
    a.p = map_new(n);
    a.u = map_new(n);
    a.v = map_new(n);
    a.absolute = map_new(n);
    return a;
}

static void
pair_free(struct pair *a)
{
    rc_engine_mlms.free(a->mlms);
    rc_engine_fft.free(a->fft);
    free(a->p);
    free(a->u);
    free(a->v);
    free(a->absolute);
}

static double
error(struct pair *a)
{
    double most = 0, magnitude = 0;

    for (size_t k = 0; k < a->n; k++)
        a->absolute[k] = fabs(a->p[k]);
    rc_engine_fft.apply(a->fft, a->absolute, a->v);
    for (size_t k = 0; k < a->n; k++)
        magnitude = fmax(magnitude, a->v[k]);
    rc_engine_mlms.apply(a->mlms, a->p, a->u);
    rc_engine_fft.apply(a->fft, a->p, a->v);
    for (size_t k = 0; k < a->n; k++)
        most = fmax(most, fabs(a->u[k] - a->v[k]));
    return most / magnitude;
}

/* Errors under random, alternating and single-node pressures. */
static void
usual(struct pair *a, double e[3])
{
    size_t nx = a->sum.shape.nx, ny = a->sum.shape.ny;
    uint64_t seed = 1999;

    for (size_t k = 0; k < a->n; k++)
        a->p[k] = uniform(&seed) - 0.5;
    e[0] = error(a);
    for (size_t k = 0; k < a->n; k++)
        a->p[k] = (k % nx + k / nx) % 2 == 0 ? 1 : -1;
    e[1] = error(a);
    e[2] = 0;
    for (size_t k = 0; k < 4; k++) {
        memset(a->p, 0, a->n * sizeof *a->p);
        a->p[((ny / 2 + k / 2) % ny) * nx + (nx / 2 + k % 2) % nx] = 1;
        e[2] = fmax(e[2], error(a));
    }
}

/* ---- calibrate ---- */

/* Error under the pressure |e|^a sign(e), where e is the error around a loaded node. */
static double
contrived(struct pair *a)
{
    size_t nx = a->sum.shape.nx, ny = a->sum.shape.ny;
    double *e = map_new(a->n), worst = 0;

    for (size_t node = 0; node < 4; node++) {
        double most = 0;
        memset(a->p, 0, a->n * sizeof *a->p);
        a->p[(ny / 2 + node / 2) * nx + nx / 2 + node % 2] = 1;
        worst = fmax(worst, error(a));
        for (size_t k = 0; k < a->n; k++) {
            e[k] = a->u[k] - a->v[k];
            most = fmax(most, fabs(e[k]));
        }
        for (int power = 0; power <= 2; power++)
            for (double part = 0.8; part > 1e-3; part *= 0.7) {
                for (size_t k = 0; k < a->n; k++)
                    a->p[k] = fabs(e[k]) < part * most
                                  ? 0
                                  : copysign(pow(fabs(e[k]) / most, power / 2.0), e[k]);
                worst = fmax(worst, error(a));
            }
    }
    for (size_t k = 0; k < a->n; k++)
        a->p[k] = 1;
    worst = fmax(worst, error(a));
    free(e);
    return worst;
}

/* Q(t, m_c + 1) times the kernel at this distance, over the kernel at the node. */
static double
expected(size_t t, size_t reach)
{
    double r = (double)reach + 1, q = 1 / (3.525 * r);

    for (size_t k = 1; k <= t; k++) {
        double odd = 2 * (double)k - 1;
        q *= odd * odd / (r * r - odd * odd);
    }
    return q;
}

static void
calibrate(void)
{
    static const double row[][2] = {{2, 1e-2},   {2, 1e-3},  {3, 1e-3},  {3, 1e-5},  {4, 1e-4},
                                    {4, 1e-6},   {5, 1e-5},  {5, 1e-6},  {6, 1e-6},  {6, 1e-8},
                                    {8, 1e-7},   {8, 1e-9},  {8, 1e-10}, {10, 1e-9}, {10, 1e-11},
                                    {12, 1e-10}, {12, 1e-12}};

    printf("256 x 256 nodes, elliptic correction regions\n");
    printf("%4s %4s %10s %8s %10s %10s\n", "t", "m_c", "one", "one/Q", "worst", "estimate");
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        struct rc_sum sum = point_sum((struct rc_shape){256, 256, 1, 1});
        struct pair a;
        double one, all;
        sum.order = (size_t)row[k][0];
        sum.tol = row[k][1];
        a = pair_new(sum);
        rc_mlms_left_out(&sum, &a.mlms->d, &one, &all);
        printf("%4zu %4zu %10.2g %8.2f %10.2g %10.2g\n", a.mlms->d.t, a.mlms->d.reach, one,
               one / expected(a.mlms->d.t, a.mlms->d.reach), contrived(&a), a.mlms->d.error);
        pair_free(&a);
    }
}

/* ---- stability ---- */

static void
stability(void)
{
    size_t m = 1024;

    printf("%zu x %zu; smooth: relative L2 error, at most %.2g\n", m, m, 1 / (double)(m * m));
    printf("%4s %4s %10s %10s %10s %10s %10s\n", "t", "m_c", "smooth", "random", "alternate",
           "one node", "estimate");
    for (size_t t = 1; t <= 50; t += t < 8 ? 1 : t < 20 ? 4 : 10) {
        struct rc_sum sum =
            point_sum((struct rc_shape){m, m, 2 / (double)(m - 1), 2 / (double)(m - 1)});
        struct pair a;
        double e[3], smooth;
        sum.order = t;
        sum.correction = paper_correction(t, m);
        a = pair_new(sum);
        hemisphere(a.sum.shape.nx, a.sum.shape.ny, a.p);
        error(&a);
        smooth = error_l2(a.n, a.u, a.v);
        usual(&a, e);
        printf("%4zu %4zu %10.2g %10.2g %10.2g %10.2g %10.2g\n", t, sum.correction, smooth, e[0],
               e[1], e[2], a.mlms->d.error);
        pair_free(&a);
    }
}

/* ---- shapes ---- */

static void
shapes(void)
{
    static const struct rc_shape shape[] = {
        {512, 512, 1, 1},   {512, 512, 1, 3},   {512, 512, 1, 10},  {512, 512, 1, 30},
        {512, 512, 1, 100}, {512, 512, 100, 1}, {1000, 100, 1, 1},  {3000, 30, 1, 1},
        {30, 3000, 1, 1},   {2000, 20, 1, 100}, {20, 2000, 1, 100}, {3, 1000, 1, 1},
        {1, 10000, 1, 1}};

    printf("%14s %8s %3s %4s %6s %10s %10s %10s %10s %10s\n", "nodes", "dy/dx", "t", "m_c",
           "levels", "smooth", "random", "alternate", "one node", "estimate");
    for (size_t k = 0; k < sizeof shape / sizeof *shape; k++) {
        const struct rc_shape *s = &shape[k];
        struct rc_sum sum = point_sum(*s);
        struct pair a;
        double e[3], smooth;
        sum.tol = 1e-6;
        a = pair_new(sum);
        hemisphere(a.sum.shape.nx, a.sum.shape.ny, a.p);
        smooth = error(&a);
        usual(&a, e);
        printf("%6zu x %5zu %8g %3zu %4zu %6zu %10.2g %10.2g %10.2g %10.2g %10.2g\n", s->nx, s->ny,
               s->dy / s->dx, a.mlms->d.t, a.mlms->d.reach, a.mlms->d.levels, smooth, e[0], e[1],
               e[2], a.mlms->d.error);
        pair_free(&a);
    }
}

/* ---- counts ---- */

/* Shortest processor time of several runs, in seconds, which excludes other processes. */
static double
seconds(const struct rc_engine *e, void *plan, const double *p, double *u, int runs)
{
    double best = INFINITY;

    for (int k = 0; k < runs; k++) {
        clock_t t = clock();
        e->apply(plan, p, u);
        best = fmin(best, (double)(clock() - t) / CLOCKS_PER_SEC);
    }
    return best;
}

static void
counts(void)
{
    printf("one thread; products as the equations are written, those with zeros too\n");
    printf("%6s %3s %4s %11s %11s %10s %10s %8s %8s\n", "M", "t", "m_c", "direct", "mlms",
           "direct s", "mlms s", "counts", "times");
    for (size_t m = 128; m <= 512; m *= 2) {
        struct rc_sum sum = point_sum((struct rc_shape){m, m, 1, 1});
        size_t n = m * m, t = paper_order(m);
        double *p = map_new(n), *u = map_new(n), direct, mlms, terms = (double)n * (double)n;
        uint64_t seed = 1;
        struct rc_err err;
        struct rc_mlms *plan;
        void *exact;

        for (size_t k = 0; k < n; k++)
            p[k] = 1 + uniform(&seed);
        sum.threads = 1;
        exact = must(rc_engine_direct.new(&sum, &err));
        direct = seconds(&rc_engine_direct, exact, p, u, m < 512 ? 5 : 2);
        rc_engine_direct.free(exact);
        sum.order = t;
        sum.correction = paper_correction(t, m);
        plan = must(rc_engine_mlms.new(&sum, &err));
        mlms = seconds(&rc_engine_mlms, plan, p, u, 20);
        printf("%6zu %3zu %4zu %11.4g %11.4g %10.4f %10.5f %8.1f %8.1f\n", m, t, sum.correction,
               terms, plan->d.terms, direct, mlms, terms / plan->d.terms, direct / mlms);
        rc_engine_mlms.free(plan);
        free(p);
        free(u);
    }
}

int
main(int argc, char **argv)
{
    static const struct part parts[] = {{"calibrate", calibrate, false},
                                        {"stability", stability, false},
                                        {"shapes", shapes, false},
                                        {"counts", counts, false}};

    return parts_run(sizeof parts / sizeof *parts, parts, argc - 1, argv + 1);
}
