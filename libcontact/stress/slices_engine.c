/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Stress maps by a row of engines.list. Each kernel, depth and map that uses the kernel takes one sum, with
 * little memory besides the maps (Polonsky and Keer 1999, section 3.3).
 */
#include "stress.h"

#include <stdlib.h>
#include <string.h>

struct plan {
    struct rc_stress_task task;
    double u[]; /* displacements of one kernel */
};

/* An engine's tolerance is relative to the sum of |K| |p|. The sum of |K| grows with the logarithm of the map
 * size, to some 2 under pressure and 8 under shear. The errors of all loads add up. */
static struct rc_sum
sum_of(const struct rc_stress_task *t, const struct rc_stress_field *field)
{
    return (struct rc_sum){.shape = t->shape,
                           .boundary = t->options.boundary,
                           .kernel = rc_stress_field_kernel(field),
                           .tol = t->options.tol / (2 + 8 * rc_stress_shear(t)),
                           .precise = t->precise,
                           .threads = t->options.threads};
}

static void *
plan_new(const struct rc_stress_task *task, struct rc_err *err)
{
    const size_t n = task->shape.nx * task->shape.ny;
    struct plan *plan = malloc(sizeof *plan + n * sizeof *plan->u);

    if (plan == NULL)
        return rc_err_null(err, "out of memory for a map of %zu nodes", n);
    plan->task = *task;
    return plan;
}

static void
add(size_t n, double weight, const double *u, double *s)
{
    for (size_t k = 0; k < n; k++)
        s[k] += weight * u[k];
}

/* The weight of a source in a component by a kernel; 0: no contribution. */
static double
weight_of(const struct rc_stress_task *t, size_t source, int kernel, int component)
{
    double weight = 0;

    for (int load = 0; load < RC_LOADS; load++)
        if (rc_stress_has(t, load) && t->load[load].source == source &&
            rc_stress_kernel(t->type, load, component) == kernel)
            weight += t->load[load].weight;
    return weight;
}

/* Adds the contribution of a source by a kernel, if any. */
static void
add_source(struct plan *plan, void *one, size_t source, int kernel, double *const s[RC_COMPONENTS])
{
    const struct rc_stress_task *t = &plan->task;
    size_t n = t->shape.nx * t->shape.ny;
    bool summed = false;

    for (int c = 0; c < RC_COMPONENTS; c++) {
        double weight = t->components >> c & 1 ? weight_of(t, source, kernel, c) : 0;
        if (weight == 0)
            continue;
        if (!summed) {
            t->engine->apply(one, t->source[source], plan->u);
            t->counts->engine_sums++;
            summed = true;
        }
        add(n, weight, plan->u, s[c]);
    }
}

static enum rc_status
slice(void *at, double depth, double *const s[RC_COMPONENTS], struct rc_err *err)
{
    struct plan *plan = at;
    const struct rc_stress_task *t = &plan->task;
    size_t n = t->shape.nx * t->shape.ny;
    struct rc_inside *inside = rc_stress_inside(t, depth, err);
    enum rc_status status = RC_OK;

    if (inside == NULL)
        return RC_FAIL;
    for (int c = 0; c < RC_COMPONENTS; c++)
        if (t->components >> c & 1)
            memset(s[c], 0, n * sizeof *s[c]);
    for (int k = 0; k < RC_STRESS_KERNELS && status == RC_OK; k++) {
        const struct rc_stress_field field = {inside, k};
        struct rc_sum sum = sum_of(t, &field);
        void *one;
        if (!(t->kernels >> k & 1))
            continue;
        if ((one = t->engine->new (&sum, err)) == NULL) {
            status = RC_FAIL;
            break;
        }
        for (size_t source = 0; source < t->sources; source++)
            add_source(plan, one, source, k, s);
        t->engine->free(one);
        rc_stress_count(t, k, 0);
    }
    rc_inside_free(inside);
    return status;
}

const struct rc_stress_evaluator rc_stress_slices_engine = {
    .new = plan_new,
    .slice = slice,
    .free = free,
};
