/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * An engine that is not part of the library: one file and one row of a list. It is the double sum, with the
 * kernel computed row by row in the memory of one row.
 */
#include "libcontact/operator/operator.h"

#include <stdlib.h>
#include <string.h>

struct plan {
    struct rc_sum sum;
    double *row; /* the kernel at one offset in y */
};

static size_t
memory(const struct rc_sum *sum)
{
    return sum->shape.nx * sizeof(double);
}

static void
plan_free(void *at)
{
    struct plan *plan = at;

    if (plan != NULL)
        free(plan->row);
    free(plan);
}

static void *
plan_new(const struct rc_sum *sum, struct rc_err *err)
{
    struct plan *plan = NULL;

    if (rc_repeats(sum->boundary) > 0) {
        rc_err_set(err, "the toy sums free maps only");
        return NULL;
    }
    if ((plan = calloc(1, sizeof *plan)) == NULL || (plan->row = malloc(memory(sum))) == NULL) {
        rc_err_set(err, "out of memory for a row of %zu values", sum->shape.nx);
        plan_free(plan);
        return NULL;
    }
    plan->sum = *sum;
    return plan;
}

/* Adds the displacement of row `to` of u by row `from` of p; `sign` is the kernel's parity in y. */
static void
add(const struct plan *plan, double sign, const double *p, double *u)
{
    size_t nx = plan->sum.shape.nx;
    double mirror = plan->sum.kernel.parity & RC_ODD_X ? -sign : sign;

    for (size_t i = 0; i < nx; i++)
        for (size_t a = 0; a < nx; a++)
            u[i] += a > i ? mirror * plan->row[a - i] * p[a] : sign * plan->row[i - a] * p[a];
}

static void
apply(void *at, const double *p, double *u)
{
    struct plan *plan = at;
    const struct rc_sum *s = &plan->sum;
    const struct rc_lattice nodes = {s->shape.dx, s->shape.dy, 1, 1};
    double mirror = s->kernel.parity & RC_ODD_Y ? -1 : 1;
    size_t nx = s->shape.nx, ny = s->shape.ny;

    memset(u, 0, nx * ny * sizeof *u);
    for (size_t d = 0; d < ny; d++) {
        s->kernel.rows(s->kernel.of, &nodes, nx, d, d + 1, plan->row);
        for (size_t j = 0; j + d < ny; j++) {
            add(plan, 1, p + j * nx, u + (j + d) * nx);
            if (d > 0)
                add(plan, mirror, p + (j + d) * nx, u + j * nx);
        }
    }
}

/* The same error as that of the engine direct. */
static double
error(const void *plan)
{
    (void)plan;
    return 1e-15;
}

static double
seconds(const struct rc_sum *sum)
{
    double n = (double)(sum->shape.nx * sum->shape.ny);

    return 1e-9 * n * n;
}

const struct rc_engine rc_engine_toy = {
    .info = {.name = "toy", .summary = "the double sum, the kernel row by row", .order = 2},
    .seconds = seconds,
    .new = plan_new,
    .apply = apply,
    .error = error,
    .free = plan_free,
};
