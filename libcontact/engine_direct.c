/*
 * The sum as it is written: u_ij = sum_kl K_(i-k)(j-l) p_kl. N^2 operations, no approximation: the
 * engine that judges the others.
 */
#include "inside.h"

#include <stdlib.h>

struct plan {
    size_t nx, ny;
    int threads;
    /* K at x offsets -(nx-1) .. nx-1 (so that the inner loop is contiguous), y offsets 0 .. ny-1 */
    double *k;
    double mirror; /* factor for negative y offsets */
};

static void
plan_free(void *at)
{
    struct plan *plan = at;

    if (plan == NULL)
        return;
    free(plan->k);
    free(plan);
}

static size_t
memory(const struct rc_sum *sum)
{
    return (2 * sum->shape.nx - 1) * sum->shape.ny * sizeof(double);
}

static void *
plan_new(const struct rc_sum *sum, struct rc_err *err)
{
    const struct rc_shape *s = &sum->shape;
    const struct rc_lattice nodes = {s->dx, s->dy, 1, 1};
    struct plan *plan;
    unsigned parity = sum->kernel->parity[sum->component];
    size_t width = 2 * s->nx - 1;

    if (rc_shape_check(s, err) != RC_OK)
        return NULL;
    if (sum->boundary != RC_FREE) {
        rc_err_set(err, "the direct sum has no end on a periodic boundary: use fft");
        return NULL;
    }
    plan = calloc(1, sizeof *plan);
    if (plan == NULL || (plan->k = malloc(width * s->ny * sizeof(double))) == NULL) {
        rc_err_set(err, "out of memory for a kernel of %zu x %zu values", width, s->ny);
        plan_free(plan);
        return NULL;
    }
    plan->nx = s->nx;
    plan->ny = s->ny;
    plan->threads = (int)(sum->threads == 0 ? rc_threads_available() : sum->threads);
    plan->mirror = parity & RC_ODD_Y ? -1 : 1;
#pragma omp parallel for num_threads(plan->threads) schedule(dynamic)
    for (size_t j = 0; j < s->ny; j++) {
        double *row = plan->k + j * width + s->nx - 1;
        sum->kernel->rows(&sum->medium, sum->component, &nodes, s->nx, j, j + 1, row);
        for (size_t i = 1; i < s->nx; i++)
            *(row - i) = parity & RC_ODD_X ? -row[i] : row[i];
    }
    return plan;
}

/* u[i] += sum_k K[i - k] p[k] along one pair of rows. */
static void
add_row(size_t nx, const double *restrict k, double factor, const double *restrict p,
        double *restrict u)
{
    for (size_t a = 0; a < nx; a++) {
        double value = factor * p[a];
        const double *from = k - a;
        if (value == 0)
            continue;
        for (size_t i = 0; i < nx; i++)
            u[i] += value * from[i];
    }
}

static void
apply(void *at, const double *p, double *u)
{
    const struct plan *plan = at;
    size_t nx = plan->nx, ny = plan->ny, width = 2 * nx - 1;

#pragma omp parallel for num_threads(plan->threads) schedule(dynamic)
    for (size_t j = 0; j < ny; j++) {
        double *row = u + j * nx;
        for (size_t i = 0; i < nx; i++)
            row[i] = 0;
        for (size_t l = 0; l < ny; l++) {
            size_t d = j > l ? j - l : l - j;
            add_row(nx, plan->k + d * width + nx - 1, j >= l ? 1 : plan->mirror, p + l * nx, row);
        }
    }
}

/* Random signs add up as the square root of their number; this covers a thousand nodes a side. */
static double
error(const void *at)
{
    (void)at;
    return 1e-15;
}

const struct rc_engine rc_engine_direct = {
    .name = "direct",
    .summary = "the double sum as it is written: exact to rounding, N^2",
    .memory = memory,
    .new = plan_new,
    .apply = apply,
    .error = error,
    .free = plan_free,
};
