/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Parts of maps, mirrored and rotated maps, and the sum of two facing surfaces.
 */
#include "libcontact/contact.h"

#include <math.h>
#include <string.h>

enum rc_status
rc_crop(const struct rc_shape *from, const double *v, size_t left, size_t top,
        const struct rc_shape *to, double *out, struct rc_err *err)
{
    if (to->nx == 0 || to->ny == 0 || left > from->nx || to->nx > from->nx - left ||
        top > from->ny || to->ny > from->ny - top)
        return rc_err_set(
            err,
            "%zu x %zu nodes from column %zu and row %zu on: the map has columns 0 to "
            "%zu and rows 0 to %zu",
            to->nx, to->ny, left, top, from->nx - 1, from->ny - 1);
    for (size_t j = 0; v != NULL && j < to->ny;
         j++) /* if out is v, each value is read before it is overwritten */
        memmove(out + j * to->nx, v + (top + j) * from->nx + left, to->nx * sizeof *v);
    return RC_OK;
}

/* ---- mirror and rotation ---- */

static void
swap(double *a, double *b)
{
    double c = *a;

    *a = *b;
    *b = c;
}

void
rc_mirror(const struct rc_shape *shape, char axis, double *v)
{
    size_t nx = shape->nx, ny = shape->ny;

    for (size_t j = 0; axis == 'x' && j < ny; j++)
        for (size_t i = 0; i < nx / 2; i++)
            swap(&v[j * nx + i], &v[j * nx + nx - 1 - i]);
    for (size_t j = 0; axis == 'y' && j < ny / 2; j++)
        for (size_t i = 0; i < nx; i++)
            swap(&v[j * nx + i], &v[(ny - 1 - j) * nx + i]);
}

struct rc_shape
rc_reflect_shape(const struct rc_shape *from, struct rc_boundary along)
{
    struct rc_shape to = *from;

    to.nx *= along.x && from->nx > 1 ? 2 : 1;
    to.ny *= along.y && from->ny > 1 ? 2 : 1;
    return to;
}

/* The image of a node at the edge is its neighbour: the reflection is about the edge of the cells, not about
 * the outermost nodes. So the period is twice the map, and each height has the same weight. */
void
rc_reflect(const struct rc_shape *from, const double *v, struct rc_boundary along, double *out)
{
    struct rc_shape to = rc_reflect_shape(from, along);

    for (size_t j = 0; j < to.ny; j++) {
        const double *row = v + (j < from->ny ? j : to.ny - 1 - j) * from->nx;
        for (size_t i = 0; i < to.nx; i++)
            out[j * to.nx + i] = row[i < from->nx ? i : to.nx - 1 - i];
    }
}

struct rc_shape
rc_rotate_shape(const struct rc_shape *from, size_t quarters)
{
    if (quarters % 2 == 0)
        return *from;
    return (struct rc_shape){.nx = from->ny, .ny = from->nx, .dx = from->dy, .dy = from->dx};
}

/* A quarter turn reads along columns: block by block, so that every fetched cache line is used fully. */
void
rc_rotate(const struct rc_shape *from, const double *v, size_t quarters, double *out)
{
    enum {
        BLOCK = 32
    };
    size_t nx = from->nx, ny = from->ny;

    quarters %= 4;
    for (size_t b = 0; b < ny; b += BLOCK)
        for (size_t a = 0; a < nx; a += BLOCK)
            for (size_t j = b; j < ny && j < b + BLOCK; j++)
                for (size_t i = a; i < nx && i < a + BLOCK; i++) {
                    size_t to = quarters == 0   ? j * nx + i
                                : quarters == 1 ? (nx - 1 - i) * ny + j
                                : quarters == 2 ? (ny - 1 - j) * nx + nx - 1 - i
                                                : i * ny + ny - 1 - j;
                    out[to] = v[j * nx + i];
                }
}

/* ---- two facing surfaces ---- */

enum rc_status
rc_add_shape(const struct rc_shape *a, const struct rc_shape *b, struct rc_shape *sum,
             struct rc_err *err)
{
    if (!(fabs(b->dx - a->dx) <= RC_SAME_SPACING * a->dx) ||
        !(fabs(b->dy - a->dy) <= RC_SAME_SPACING * a->dy))
        return rc_err_set(err, "spacings of %.9g x %.9g m and of %.9g x %.9g m: nodes do not meet",
                          a->dx, a->dy, b->dx, b->dy);
    *sum = *a;
    sum->nx = a->nx < b->nx ? a->nx : b->nx;
    sum->ny = a->ny < b->ny ? a->ny : b->ny;
    return RC_OK;
}

/* Each map is cut before it is mirrored, so exchanging a and b only changes the side from which the sum is
 * seen. */
static enum rc_status
combine(const struct rc_shape *a, const double *ha, const struct rc_shape *b, const double *hb,
        bool subtract, double *out, struct rc_err *err)
{
    struct rc_shape sum;

    if (rc_add_shape(a, b, &sum, err) != RC_OK)
        return RC_FAIL;
    ha += (a->ny - sum.ny) / 2 * a->nx + (a->nx - sum.nx) / 2;
    hb += (b->ny - sum.ny) / 2 * b->nx + (b->nx - sum.nx) / 2;
    for (size_t j = 0; j < sum.ny; j++, ha += a->nx, hb += b->nx, out += sum.nx)
        for (size_t i = 0; i < sum.nx; i++)
            out[i] = subtract ? ha[i] - hb[i] : ha[i] + hb[sum.nx - 1 - i];
    return RC_OK;
}

enum rc_status
rc_add(const struct rc_shape *a, const double *ha, const struct rc_shape *b, const double *hb,
       double *out, struct rc_err *err)
{
    return combine(a, ha, b, hb, false, out, err);
}

enum rc_status
rc_subtract(const struct rc_shape *a, const double *ha, const struct rc_shape *b, const double *hb,
            double *out, struct rc_err *err)
{
    return combine(a, ha, b, hb, true, out, err);
}
