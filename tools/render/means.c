/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Means of the pressure on a body that yields in its volume. Without hardening the pressure alternates from
 * node to node by some per cent, because waves of two nodes have no effect in the volume. Means over 2 x 2
 * nodes do not alternate. A node in contact is drawn with the mean of the four means to which it belongs.
 */
#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The limit of the hardening modulus, in yield stresses. */
static const double soft = 10;

/* True if the pressures of single nodes alternate, as with little hardening. */
static bool
alternates(const struct rc_grid *g)
{
    double yield, hardening;

    return strcmp(g->channel, "pressure") == 0 && rc_grid_get(g, "section") == NULL &&
           rc_grid_number(g, "yield", &yield) && rc_grid_number(g, "hardening", &hardening) &&
           hardening < soft * yield;
}

/* The neighbours of index k of n: across the edge on a periodic map, else the last index again. */
static size_t
before(size_t k, size_t n, bool round)
{
    return k > 0 ? k - 1 : round ? n - 1 : 0;
}

static size_t
after(size_t k, size_t n, bool round)
{
    return k + 1 < n ? k + 1 : round ? 0 : k;
}

static double
mean_of_four(const double *p, size_t nx, size_t i, size_t i1, size_t j, size_t j1)
{
    return (p[j * nx + i] + p[j * nx + i1] + p[j1 * nx + i] + p[j1 * nx + i1]) / 4;
}

void
means_take(struct tool *t, struct rc_grid *g, struct means *m)
{
    const struct rc_boundary round = map_boundary(g);
    size_t nx = g->nx, ny = g->ny;
    double *p;

    if (!alternates(g))
        return;
    p = tool_room(t, nx * ny, sizeof *p, "the means of a map");
    memcpy(p, g->v, nx * ny * sizeof *p);
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            size_t k = j * nx + i, left = before(i, nx, round.x), right = after(i, nx, round.x);
            size_t above = before(j, ny, round.y), below = after(j, ny, round.y);
            double next = mean_of_four(p, nx, i, right, j, below);

            m->four = fmax(m->four, next);
            m->one = fmax(m->one, p[k]);
            if (rc_in_contact(p[k]))
                g->v[k] = (next + mean_of_four(p, nx, left, i, j, below) +
                           mean_of_four(p, nx, i, right, above, j) +
                           mean_of_four(p, nx, left, i, above, j)) /
                          4;
        }
    m->taken = true;
    free(p);
}

void
means_say(const struct means *m, struct subtitle *w, const char *unit)
{
    char text[2 * TICKS_TEXT + 64];

    snprintf(text, sizeof text, "%s in means of 2 \xc3\x97 2 nodes, %s at one node",
             scale_value(m->four, unit), scale_value(m->one, unit));
    subtitle_add(w, "max ", text);
}
