/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The drawn part of a map, and its position.
 */
#include "render.h"

#include <math.h>
#include <string.h>

/* ---- position ---- */

static void
place(const struct rc_grid *g, struct window *w)
{
    double i, j;

    rc_grid_origin(g, &i, &j);
    w->left = -(i + 0.5) * g->dx;
    w->right = ((double)g->nx - i - 0.5) * g->dx;
    w->top = -(j + 0.5) * g->dy;
    w->bottom = ((double)g->ny - j - 0.5) * g->dy;
}

/* Nodes of a window: the first, and the one after the last, along each axis. */
struct box {
    size_t x0, x1, y0, y1;
};

static void
cut_values(struct rc_grid *g, size_t x0, size_t nx, size_t y0, size_t ny)
{
    for (size_t j = 0; j < ny; j++)
        memmove(g->v + j * nx, g->v + (y0 + j) * g->nx + x0, nx * sizeof *g->v);
    g->nx = nx;
    g->ny = ny;
}

static void
cut(struct rc_grid *g, const struct beside *beside, struct window *w, const struct box *b)
{
    size_t x0 = b->x0, x1 = b->x1, y0 = b->y0, y1 = b->y1, nx = x1 - x0, ny = y1 - y0;

    if (nx == g->nx && ny == g->ny)
        return;
    w->part = (double)nx * (double)ny / ((double)g->nx * (double)g->ny);
    cut_values(g, x0, nx, y0, ny);
    if (beside->pressure != NULL)
        cut_values(beside->pressure, x0, nx, y0, ny);
    if (beside->contact != NULL)
        cut_values(beside->contact, x0, nx, y0, ny);
    w->right = w->left + (double)x1 * g->dx;
    w->left += (double)x0 * g->dx;
    w->bottom = w->top + (double)y1 * g->dy;
    w->top += (double)y0 * g->dy;
}

/* The nodes, of n with the origin at `middle`, whose centres lie from lo to hi. */
static bool
nodes_between(double lo, double hi, double middle, size_t n, double step, size_t *first,
              size_t *last)
{
    const double slack = 1e-6;
    double from = ceil(lo / step + middle - slack), to = floor(hi / step + middle + slack);

    from = fmax(from, 0);
    to = fmin(to, (double)n - 1);
    if (!(from <= to))
        return false;
    *first = (size_t)from;
    *last = (size_t)to + 1;
    return true;
}

/* ---- the contact ---- */

static bool
find_contact(const struct rc_grid *g, struct box *b)
{
    *b = (struct box){g->nx, 0, g->ny, 0};
    for (size_t j = 0; j < g->ny; j++)
        for (size_t i = 0; i < g->nx; i++)
            if (rc_in_contact(g->v[j * g->nx + i])) {
                b->x0 = i < b->x0 ? i : b->x0;
                b->x1 = i + 1 > b->x1 ? i + 1 : b->x1;
                b->y0 = j < b->y0 ? j : b->y0;
                b->y1 = j + 1;
            }
    return b->x1 > b->x0;
}

/* Widens first..last to `length` about its middle, inside n nodes. */
static void
widen(size_t *first, size_t *last, double length, double step, size_t n)
{
    double middle = 0.5 * (double)(*first + *last), half = 0.5 * length / step;
    double from = fmax(floor(middle - half), 0), to = fmin(ceil(middle + half), (double)n);

    *first = (size_t)from < *first ? (size_t)from : *first;
    *last = (size_t)to > *last ? (size_t)to : *last;
}

/* A square about the contact, with a margin of a quarter of its side all around; a length for a profile.
 * False: no contact. */
static bool
contact_box(const struct rc_grid *g, struct box *b)
{
    const double margin = 0.25, least = 8; /* nodes: with fewer their position is not visible */
    double w, h, side;

    if (!find_contact(g, b))
        return false;
    w = (double)(b->x1 - b->x0) * g->dx;
    h = (double)(b->y1 - b->y0) * g->dy;
    side = (1 + 2 * margin) * fmax(fmax(w, h), least * fmin(g->dx, g->dy));
    widen(&b->x0, &b->x1, side, g->dx, g->nx);
    widen(&b->y0, &b->y1, side, g->dy, g->ny);
    return true;
}

/* ---- options ---- */

static void
read_pair(struct tool *t, const struct rc_grid *g, const char *window, const char *text,
          double pair[2])
{
    if (look_pair(text, look_unit(g), pair, &t->err) != RC_OK)
        tool_usage(t, "--window %s: %s", window, t->err.text);
    if (!(pair[0] < pair[1]))
        tool_usage(t,
                   "--window %s: it must be X0:X1,Y0:Y1, two lengths with the lower first for each "
                   "axis, contact or all",
                   window);
}

static void
cut_lengths(struct tool *t, const char *window, struct rc_grid *g, const struct beside *beside,
            struct window *w)
{
    bool section = rc_grid_get(g, "section") != NULL;
    char first[256];
    char *second;
    double x[2], y[2] = {-INFINITY, INFINITY}, i, j;
    const char *unit = rc_grid_dunit(g);
    struct box b = {.y1 = g->ny};

    snprintf(first, sizeof first, "%s", window);
    if ((second = strchr(first, ',')) != NULL)
        *second++ = '\0';
    if (section && second != NULL)
        tool_usage(t,
                   "--window %s: of a section it is X0:X1 only: choose depths with --depth-range",
                   window);
    read_pair(t, g, window, first, x);
    if (second != NULL)
        read_pair(t, g, window, second, y);
    rc_grid_origin(g, &i, &j);
    if (!nodes_between(x[0], x[1], i, g->nx, g->dx, &b.x0, &b.x1) ||
        (second != NULL && !nodes_between(y[0], y[1], j, g->ny, g->dy, &b.y0, &b.y1)))
        tool_refuse(t, g,
                    "no node lies in the window %s: the map ends %s to the right of its middle and "
                    "%s below it",
                    window, scale_value(w->right, unit), scale_value(w->bottom, unit));
    cut(g, beside, w, &b);
}

void
window_cut(struct tool *t, const char *text, bool raw, struct rc_grid *g,
           const struct beside *beside, const struct rc_grid *touch, struct window *w)
{
    const double speck = 0.25; /* fraction of the sides of the map */
    bool asked;
    struct box b;

    *w = (struct window){.part = 1};
    place(g, w);
    asked = text != NULL && strcmp(text, "contact") == 0;
    if (asked && touch == NULL)
        tool_refuse(
            t, g,
            "--window contact goes by the pressure, and there is none on this grid: give the "
            "window as X0:X1,Y0:Y1");
    if (text != NULL && !asked) {
        if (strcmp(text, "all") != 0)
            cut_lengths(t, text, g, beside, w);
        return;
    }
    if (touch == NULL || (!asked && (raw || strcmp(g->channel, "pressure") != 0)))
        return;
    if (!contact_box(touch, &b)) {
        if (asked)
            tool_warn(t, "nothing touches: the whole map is drawn");
        return;
    }
    if (!asked && (g->nx == 1 || g->ny == 1 || (double)(b.x1 - b.x0) > speck * (double)g->nx ||
                   (double)(b.y1 - b.y0) > speck * (double)g->ny))
        return;
    cut(g, beside, w, &b);
    w->contact = w->part < 1;
}
