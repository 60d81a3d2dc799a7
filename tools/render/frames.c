/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The frames of a picture: the best one of the selected frames, or several of one channel, and beside them
 * the pressures and contacts of their cases.
 */
#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Index of a channel among the preferred ones; all others have the next index. */
static size_t
rank(const char *channel)
{
    static const char *const preferred[] = {"mises", "pressure", "height"};
    size_t k = 0;

    while (k < sizeof preferred / sizeof *preferred && strcmp(preferred[k], channel) != 0)
        k++;
    return k;
}

/* ---- frames beside ---- */

static void
drop_aside(struct aside *of)
{
    while (of->n > 0)
        rc_grid_free(of->grid[--of->n]);
}

/* Drops, of a picture of one frame, those of cases other than this one and that of the frame. */
static void
forget(const struct frames *f, struct aside *of, size_t number)
{
    size_t n = 0;

    for (size_t k = 0; k < of->n; k++) {
        const size_t is = rc_grid_case(of->grid[k]);

        if (is == number || (f->n > 0 && is == rc_grid_case(f->grid[0])))
            of->grid[n++] = of->grid[k];
        else
            rc_grid_free(of->grid[k]);
    }
    of->n = n;
}

static bool
keep_beside(void *ctx, struct rc_grid *g)
{
    struct frames *f = ctx;
    struct aside *of = strcmp(g->channel, CONTACT_CHANNEL) == 0           ? &f->contact
                       : f->border && strcmp(g->channel, "pressure") == 0 ? &f->pressure
                                                                          : NULL;

    if (of == NULL)
        return false;
    if (f->one)
        forget(f, of, rc_grid_case(g));
    if (of->n == FRAMES)
        return false;
    of->grid[of->n++] = g;
    return true;
}

static void
let_go(struct frames *f, struct rc_grid *g)
{
    if (!keep_beside(f, g))
        rc_grid_free(g);
}

static struct rc_grid *
find(const struct aside *of, const struct rc_grid *g)
{
    for (size_t k = 0; k < of->n && rc_grid_get(g, "section") == NULL; k++) {
        const struct rc_grid *is = of->grid[k];

        if (rc_grid_case(is) == rc_grid_case(g) && is->nx == g->nx && is->ny == g->ny &&
            is->dx == g->dx && is->dy == g->dy && strcmp(is->channel, g->channel) != 0)
            return of->grid[k];
    }
    return NULL;
}

struct beside
frames_beside(const struct frames *f, size_t k)
{
    return (struct beside){.pressure = find(&f->pressure, f->grid[k]),
                           .contact = find(&f->contact, f->grid[k])};
}

/* ---- which are drawn ---- */

/* Drops the kept frames of a channel with a lower preference than this one. */
static bool
prefer(struct frames *f, const struct rc_grid *g)
{
    if (f->n == 0 || strcmp(f->grid[0]->channel, g->channel) == 0)
        return true;
    f->others = true;
    if (f->wanted.channel != NULL || rank(g->channel) >= rank(f->grid[0]->channel))
        return false;
    for (size_t k = 0; k < f->n; k++)
        let_go(f, f->grid[k]);
    f->n = f->left = 0;
    return true;
}

static double
largest(const struct rc_grid *g)
{
    double size = 0;

    for (size_t k = 0; k < g->nx * g->ny; k++)
        if (isfinite(g->v[k]))
            size = fmax(size, fabs(g->v[k]));
    return size;
}

/* Of a picture of one frame: the first, but of several depths the one with the largest magnitude. Returns
 * the frame that is not kept. */
static struct rc_grid *
keep_best(struct frames *f, struct rc_grid *g)
{
    const bool deep = rc_grid_get(g, "depth") != NULL;
    const double size = deep && f->wanted.depth.n == 0 ? largest(g) : 0;
    struct rc_grid *old = f->n > 0 ? f->grid[0] : NULL;

    if (old == NULL)
        f->cases = f->depths = f->same = f->last = 0;
    f->cases += rc_grid_case(g) != f->last;
    f->last = rc_grid_case(g);
    if (f->cases > 1)
        return g;
    f->depths += deep;
    f->same += !deep;
    if (old != NULL && !(deep && size > f->size && rc_grid_get(old, "depth") != NULL))
        return g;
    f->grid[0] = g;
    f->size = size;
    f->n = 1;
    return old;
}

/* Names omitted frames that the user may have meant. */
static void
tell(const struct frames *f, struct tool *t)
{
    const struct rc_grid *g = f->grid[0];
    double depth;

    if (f->one && f->cases > 1)
        tool_warn(t, "%zu cases match: case %zu is drawn, the others are left: choose with --case",
                  f->cases, rc_grid_case(g));
    if (f->one && f->same > 1)
        tool_warn(t, "%zu frames of case %zu match (%s): the first is drawn", f->same,
                  rc_grid_case(g), g->channel);
    if (f->wanted.channel == NULL && f->others)
        tool_note(t, "drawing %s: choose another channel with --channel", g->channel);
    if (frames_by_size(f) && rc_grid_number(g, "depth", &depth))
        tool_note(t, "of %zu depths drawing %s, where %s is largest: choose with --depth",
                  f->depths, scale_value(depth, "m"), g->channel);
}

bool
frames_by_size(const struct frames *f)
{
    return f->one && f->depths > 1 && f->wanted.depth.n == 0;
}

void
frames_read(struct frames *f, struct tool *t)
{
    struct rc_grid *g;

    f->wanted.one = true;
    f->wanted.other = keep_beside;
    f->wanted.ctx = f;
    wanted_check(&f->wanted, t);
    while ((g = wanted_read(&f->wanted, t)) != NULL) {
        if (!prefer(f, g)) {
            let_go(f, g);
        } else if (f->one) {
            if ((g = keep_best(f, g)) != NULL)
                let_go(f, g);
        } else if (f->n == FRAMES) {
            f->left++;
            rc_grid_free(g);
        } else {
            f->grid[f->n++] = g;
        }
    }
    if (f->left > 0)
        tool_die(t, "%zu frames match, a picture shows at most %d: choose with --depth and --case",
                 f->n + f->left, FRAMES);
    tell(f, t);
    for (size_t k = 0; k < f->n; k++) {
        struct beside beside = frames_beside(f, k);
        f->touch[k] = look_touch(t, f->grid[k], &beside, f->demands);
    }
}

static void
empty(struct rc_grid *const *grid, size_t n)
{
    for (size_t k = 0; k < n; k++) {
        free(grid[k]->v);
        grid[k]->v = NULL;
    }
}

void
frames_empty(struct frames *f)
{
    empty(f->grid, f->n);
    empty(f->pressure.grid, f->pressure.n);
    empty(f->contact.grid, f->contact.n);
}

void
frames_free(struct frames *f)
{
    for (size_t k = 0; k < f->n; k++)
        rc_grid_free(f->grid[k]);
    drop_aside(&f->pressure);
    drop_aside(&f->contact);
    f->n = 0;
}
