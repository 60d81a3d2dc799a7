/* SPDX-License-Identifier: GPL-3.0-or-later */
/* X3P: maps with an absolute axis, whose points have their own positions. A point is x and y, where these
 * are, and z. The places must lie on an even grid: then they say no more than its steps and directions. */
#include <math.h>
#include <stdlib.h>

#include "x3p_internal.h"

/* Points and where the places in them are. */
struct points {
    struct rc_bytes b;
    size_t stride;
};

static double
place_of(struct points *p, size_t point, size_t skip, enum rc_raw raw)
{
    return rc_bytes_at(&p->b, point * p->stride + skip, raw);
}

/* The step along an axis of n points, `apart` from each other in the file, and whether they fall. Every point
 * of the map must lie within a tenth of a step of its place on even ones. */
static enum rc_status
find_step(const struct rc_x3p *x, struct points *p, bool is_x, double *step, bool *falls,
          struct rc_err *err)
{
    size_t n = is_x ? x->nx : x->ny, apart = is_x ? 1 : x->nx, skip = is_x ? 0 : x->at.before_y;
    enum rc_raw raw = is_x ? x->at.raw_x : x->at.raw_y;
    RC_OWNED double *place = malloc(n * sizeof *place);
    double first, even;

    if (n < 2)
        return rc_err_set(err, "axis %s is absolute and has one point: it has no spacing",
                          is_x ? "CX" : "CY");
    if (place == NULL)
        return rc_err_set(err, "out of memory for %zu places", n);
    for (size_t k = 0; k < n; k++)
        place[k] = place_of(p, k * apart, skip, raw);
    first = place[0];
    *falls = place[n - 1] < first;
    if (rc_axis_step(is_x ? "CX" : "CY", place, n, &even, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < x->n; k++) {
        double steps = (double)(is_x ? k % x->nx : k / x->nx), here = place_of(p, k, skip, raw);

        if (!(fabs(here - first - (*falls ? -even : even) * steps) <= 0.1 * even))
            return rc_err_set(
                err, "the places of axis %s do not form a grid: point %zu is not where its %s is",
                is_x ? "CX" : "CY", k + 1, is_x ? "column" : "row");
    }
    *step = even;
    return RC_OK;
}

/* Puts the heights where an axis that rises has them. */
static void
take_heights(const struct rc_x3p *x, struct points *p, bool x_falls, bool y_falls, double *v)
{
    for (size_t k = 0; k < x->n; k++) {
        size_t i = k % x->nx, j = k / x->nx;

        i = x_falls ? x->nx - 1 - i : i;
        j = y_falls ? x->ny - 1 - j : j;
        v[j * x->nx + i] = place_of(p, k, x->at.before_z, x->raw);
    }
}

enum rc_status
rc_x3p_axes(struct rc_x3p *x, const struct rc_file *file, double *v, struct rc_notes *notes,
            struct rc_err *err)
{
    size_t member, size = x->n * (x->at.before_z + rc_raw_width(x->raw));
    struct points p = {.stride = x->at.before_z + rc_raw_width(x->raw)};
    bool x_falls = false, y_falls = false;
    RC_OWNED unsigned char *data = NULL;
    double step;

    if (rc_x3p_find_points(x, &member, err) != RC_OK || rc_map_fits(file, x->n, 5, err) != RC_OK ||
        (data = rc_x3p_unpack_points(x, member, size, notes, err)) == NULL)
        return RC_FAIL;
    p.b = (struct rc_bytes){.data = data, .size = size};
    if (x->at.absolute_x) {
        if (find_step(x, &p, true, &step, &x_falls, err) != RC_OK)
            return RC_FAIL;
        x->dx = step * fabs(x->at.x_increment);
        x_falls = x_falls != (x->at.x_increment < 0);
    }
    if (x->at.absolute_y) {
        if (find_step(x, &p, false, &step, &y_falls, err) != RC_OK)
            return RC_FAIL;
        x->dy = step * fabs(x->at.y_increment);
        y_falls = y_falls != (x->at.y_increment < 0);
    }
    if (v != NULL)
        take_heights(x, &p, x_falls, y_falls, v);
    return RC_OK;
}
