/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * An approximate inverse of C = C1 + C2 restricted to the nodes in contact: z = E' A E r. A is the
 * reciprocal of the spectrum of C on the padded map. E is the extension of pyramid/pyramid.h, which
 * decreases to 0 in a frame of padding along the free axes. The exact inverse has the same form, with the
 * extensions whose heat off the contact is 0. Where E is 0 off the contact, the steps of the iteration grow
 * by 1.2 when the map has twice the nodes a side. With this E they hardly grow.
 */
#include <stdlib.h>
#include <string.h>

#include "heat.h"
#include "libcontact/memory.h"
#include "libcontact/pyramid/pyramid.h"

struct rc_heat_inverse {
    struct rc_conduction *c;
    struct rc_shape grid; /* the rows held here with their part of the frame */
    struct rc_pyramid *pyramid;
    size_t n, *place; /* of the nodes in contact on the grid */
    float *v;         /* a number for each node of the grid  */
    struct rc_store own;
};

/* ---- plan ---- */

struct decrease {
    struct rc_heat_waves body[2];
    bool x, y; /* the map has waves along this axis */
};

/* The power a of the decrease C ~ q^-a, a mean over the directions. */
static double
power(const void *of, double q)
{
    const struct decrease *d = of;
    double mean = 0;

    for (int y = !d->x; y < 1 + d->y; y++) {
        double size[2];
        for (int k = 0; k < 2; k++) {
            const double x = y == 0 ? (1 + k) * q : 0, across = y == 0 ? 0 : (1 + k) * q;
            size[k] = cabs(rc_heat_symbol(&d->body[0], x, across) +
                           rc_heat_symbol(&d->body[1], x, across));
        }
        mean += log2(size[0] / size[1]) / (d->x && d->y ? 2 : 1);
    }
    return mean;
}

void
rc_heat_inverse_free(struct rc_heat_inverse *e)
{
    if (e == NULL)
        return;
    rc_pyramid_free(e->pyramid);
    rc_store_free(&e->own);
    free(e);
}

/* Adds a row of v; for the pyramid. */
static void
add_row(const void *of, int component, size_t j, float weight, float *to)
{
    const struct rc_heat_inverse *e = of;
    const float *v = e->v + j * e->grid.nx;

    (void)component;
    for (size_t i = 0; i < e->grid.nx; i++)
        to[i] += weight * v[i];
}

static void
clear(struct rc_heat_inverse *e)
{
    memset(e->v, 0, e->grid.nx * e->grid.ny * sizeof *e->v);
}

struct rc_heat_inverse *
rc_heat_inverse_new(struct rc_conduction *c, const struct rc_heated bodies[2], size_t n,
                    const size_t *node, struct rc_err *err)
{
    const size_t nx = c->shape.nx;
    RC_OWN(rc_heat_inverse, e) = calloc(1, sizeof *e);
    const struct decrease decrease = {
        .body = {rc_heat_waves_of(&bodies[0]), rc_heat_waves_of(&bodies[1])},
        .x = nx > 1 || c->shape.ny == 1,
        .y = c->shape.ny > 1};
    struct rc_pyramid_base base = rc_pyramid_base_of(&c->shape, c->boundary, c->frame, &c->rows);

    base.threads = c->threads;
    if (e != NULL) {
        e->c = c;
        e->grid = base.shape;
        e->grid.ny = base.n;
        e->n = n;
        e->place = rc_store_take(&e->own, n, sizeof *e->place);
        e->v = rc_store_take(&e->own, e->grid.nx * e->grid.ny, sizeof *e->v);
    }
    if (rc_ranks_need(c->rows.ranks, e != NULL && !e->own.failed, err,
                      "out of memory for %zu nodes in contact", n) != RC_OK ||
        (e->pyramid = rc_pyramid_new(&base, power, &decrease, err)) == NULL)
        return NULL;
    clear(e);
    for (size_t k = 0; k < n; k++) {
        e->place[k] = (node[k] / nx + c->above) * e->grid.nx + node[k] % nx + c->frame.x;
        e->v[e->place[k]] = 1;
    }
    rc_pyramid_set(e->pyramid, add_row, e);
    return rc_give(&e);
}

/* ---- use ---- */

/* v = the rows of the pyramid. */
static void
take_rows(struct rc_heat_inverse *e)
{
#pragma omp parallel for num_threads(e->c->threads) schedule(static)
    for (size_t j = 0; j < e->grid.ny; j++)
        rc_pyramid_row(e->pyramid, 0, j, e->v + j * e->grid.nx);
}

/* Lets v decrease in the frame. */
static void
fade(struct rc_heat_inverse *e)
{
    const struct rc_conduction *c = e->c;

#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t j = 0; j < e->grid.ny; j++) {
        const float of_row = rc_frame_fade(j, c->above, c->rows.n, c->frame.y);
        for (size_t i = 0; i < e->grid.nx; i++)
            e->v[j * e->grid.nx + i] *=
                of_row * rc_frame_fade(i, c->frame.x, c->shape.nx, c->frame.x);
    }
}

void
rc_heat_inverse_apply(struct rc_heat_inverse *e, const struct rc_warming *const bodies[2],
                      const double *r, double *z)
{
    clear(e);
    for (size_t k = 0; k < e->n; k++)
        e->v[e->place[k]] = (float)r[k];
    rc_pyramid_extend(e->pyramid, add_row, e, NULL);
    take_rows(e);
    fade(e);
    for (size_t k = 0; k < e->n; k++)
        e->v[e->place[k]] = (float)r[k];
    rc_conduction_inverse(e->c, bodies, e->v);
    for (size_t k = 0; k < e->n; k++) {
        z[k] = (double)e->v[e->place[k]];
        e->v[e->place[k]] = 0;
    }
    fade(e);
    rc_pyramid_gather(e->pyramid, add_row, e, NULL);
    take_rows(e);
    for (size_t k = 0; k < e->n; k++)
        z[k] += (double)e->v[e->place[k]];
}
