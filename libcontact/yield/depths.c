/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The slabs of a body that may yield, from the stresses under the elastic pressure. Yielding spreads the
 * pressure, so that plastic strain does not reach as deep as the elastic stress suggests.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"
#include "yield.h"

enum {
    MOST = 80 /* most slabs: starting with half a node, so many reach deeper than any map needs */
};
/* Thickness of a slab over that of the one above it: the stress changes over lengths as large as its
 * depth. */
static const double growth = 1.25;

/* Finds the largest Mises stress at the middle of each slab, and the number of nodes with more than
 * `yield`. RC_MORE: the caller cannot wait. */
static enum rc_status
look(const struct rc_shape *shape, const struct rc_problem *contact, const double *p, double yield,
     size_t n, const double *middle, double *mises, size_t *beyond, struct rc_err *err)
{
    const struct rc_stress_options options = {.boundary = contact->boundary,
                                              .body = contact->pair.one,
                                              .wanted = 1U << RC_MISES,
                                              .tol = 1e-3,
                                              .depth = middle,
                                              .depths = n,
                                              .threads = contact->threads};
    RC_OWNED double *map = rc_alloc(shape->nx * shape->ny, sizeof *map);
    double *const to[RC_STRESSES] = {[RC_MISES] = map};
    enum rc_status status = RC_OK;
    struct rc_stress *stress;

    if (map == NULL)
        return rc_err_set(err, "out of memory for the stresses of %zu x %zu nodes", shape->nx,
                          shape->ny);
    stress = rc_stress_new(shape, p, &options, err);
    if (stress == NULL)
        status = RC_FAIL;
    for (size_t k = 0; k < n && status == RC_OK; k++) {
        size_t least, largest;
        if (contact->hurry != NULL && *contact->hurry != 0) {
            status = RC_MORE;
            break;
        }
        status = rc_stress_slice(stress, middle[k], to, err);
        if (status == RC_OK) {
            rc_extremes(shape->nx * shape->ny, map, &least, &largest);
            mises[k] = map[largest];
        }
        beyond[k] = 0;
        for (size_t i = 0; i < shape->nx * shape->ny && status == RC_OK; i++)
            beyond[k] += map[i] > yield;
    }
    rc_stress_free(stress);
    return status;
}

enum rc_status
rc_yield_depths(const struct rc_shape *shape, const struct rc_problem *contact, const double *p,
                double yield, struct rc_yield_depths *d, struct rc_err *err)
{
    enum rc_status status;
    double thickness[MOST], middle[MOST], mises[MOST], z = 0;
    double side = fmax((double)shape->nx * shape->dx, (double)shape->ny * shape->dy);
    double step = shape->nx == 1   ? shape->dy
                  : shape->ny == 1 ? shape->dx
                                   : fmin(shape->dx, shape->dy);
    size_t n = 0, beyond[MOST];

    *d = (struct rc_yield_depths){0};
    for (double dz = step / 2; n < MOST && z < side / 2; dz *= growth) {
        thickness[n] = dz;
        middle[n++] = z + dz / 2;
        z += dz;
    }
    status = look(shape, contact, p, yield, n, middle, mises, beyond, err);
    if (status != RC_OK)
        return status;
    for (size_t k = 0; k < n; k++) {
        if (mises[k] > d->most) {
            d->most = mises[k];
            d->deepest = middle[k];
        }
        if (mises[k] > yield)
            d->slabs = k + 1 < n ? k + 2 : k + 1;
    }
    if (d->slabs == 0)
        return RC_OK;
    d->thickness = malloc(d->slabs * sizeof *d->thickness);
    if (d->thickness == NULL)
        return rc_err_set(err, "out of memory for the depths");
    for (size_t k = 0; k < d->slabs; k++) {
        d->thickness[k] = thickness[k];
        d->part += (double)beyond[k] / (double)(d->slabs * shape->nx * shape->ny);
    }
    return RC_OK;
}

/* Keeps the growth of the computed stack. Each slab is divided or joined alike, so that the ratio of
 * thicknesses changes with the number of slabs. */
void
rc_yield_solver_stack(const struct rc_yield_depths *found, size_t n, double *thickness)
{
    double depth = 0, first, ratio;

    if (n == found->slabs) {
        memcpy(thickness, found->thickness, n * sizeof *thickness);
        return;
    }
    for (size_t k = 0; k < found->slabs; k++)
        depth += found->thickness[k];
    first = found->slabs > 1 ? found->thickness[1] / found->thickness[0] : 1;
    ratio = pow(first, (double)found->slabs / (double)n);
    first = ratio > 1 ? depth * (ratio - 1) / (pow(ratio, (double)n) - 1) : depth / (double)n;
    for (size_t k = 0; k < n; k++, first *= ratio)
        thickness[k] = first;
}
