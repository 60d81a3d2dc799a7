/*
 * Chooses the frame of a stream to draw.
 */
#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const preferred[] = {"mises", "pressure", "height"};

enum {
    PREFERRED = sizeof preferred / sizeof *preferred
};

size_t
choice_rank(const char *channel)
{
    size_t k = 0;

    while (k < PREFERRED && strcmp(preferred[k], channel) != 0)
        k++;
    return k;
}

/* ---- frames of the stream ---- */

static bool
right_channel(const void *wish, const struct seen *s)
{
    const struct wish *w = wish;

    return w->channel == NULL || strcmp(w->channel, s->channel) == 0;
}

static bool
right_frame(const void *wish, const struct seen *s)
{
    const struct wish *w = wish;

    return right_channel(w, s) && (w->number == 0 || w->number == s->number);
}

static bool
right_section(const struct wish *w, const struct seen *s)
{
    return w->section == NULL || w->section[0] == s->section;
}

/* ---- the best ---- */

static double
largest(const struct rc_grid *g)
{
    double size = 0;

    for (size_t k = 0; k < g->nx * g->ny; k++)
        if (isfinite(g->v[k]))
            size = fmax(size, fabs(g->v[k]));
    return size;
}

/* True if the frame, recorded as *s, replaces the kept one. */
static bool
is_better(const struct choice *c, const struct rc_grid *g, const struct seen *s, double size)
{
    const struct rc_grid *old = c->grid;
    double depth;

    if (old == NULL)
        return true;
    if (c->wish->channel == NULL && choice_rank(g->channel) != choice_rank(old->channel))
        return choice_rank(g->channel) < choice_rank(old->channel);
    if (strcmp(g->channel, old->channel) != 0 || s->number != rc_grid_case(old) ||
        isnan(s->depth) || !rc_grid_number(old, "depth", &depth))
        return false;
    if (!isnan(c->wish->depth))
        return fabs(s->depth - c->wish->depth) < fabs(depth - c->wish->depth);
    return size > c->size;
}

/* The place in which a further frame is kept; NULL: it is not kept. */
static struct rc_grid **
place_beside(struct choice *c, const struct rc_grid *g)
{
    if (strcmp(g->channel, CONTACT_CHANNEL) == 0)
        return &c->beside.contact;
    return c->wish->contact && strcmp(g->channel, "pressure") == 0 ? &c->beside.pressure : NULL;
}

/* Handles a frame that is not drawn, or no longer. */
static void
let_go(struct choice *c, struct rc_grid *g)
{
    struct rc_grid **to;
    bool same = c->grid != NULL && g != NULL && rc_grid_case(c->grid) == rc_grid_case(g);

    if (g != NULL && c->wish->number != 0) /* the case is known before its frame was read */
        same = rc_grid_case(g) == c->wish->number;
    if (g == NULL || (to = place_beside(c, g)) == NULL || !(*to == NULL || same)) {
        rc_grid_free(g);
        return;
    }
    rc_grid_free(*to);
    *to = g;
}

/* The case of the kept frame has ended: now it is known whether its depth is near enough. */
static void
end_case(struct choice *c, struct tool *t)
{
    double *depth, own;
    size_t n = 0;

    if (c->grid == NULL || !rc_grid_number(c->grid, "depth", &own) || isnan(c->wish->depth))
        return;
    depth = tool_room(t, c->list.n, sizeof *depth, "a list of depths");
    for (size_t k = 0; k < c->list.n; k++)
        if (strcmp(c->list.seen[k].channel, c->grid->channel) == 0 &&
            c->list.seen[k].number == rc_grid_case(c->grid) && !isnan(c->list.seen[k].depth))
            depth[n++] = c->list.seen[k].depth;
    if (isnan(wanted_depth(depth, n, c->wish->depth))) {
        rc_grid_free(c->grid);
        c->grid = NULL;
    }
    free(depth);
}

void
choice_offer(struct choice *c, struct tool *t, struct rc_grid *g)
{
    const struct wish *w = c->wish;
    const struct seen *s;
    double size;

    if (c->list.n > 0 && c->list.seen[c->list.n - 1].number != rc_grid_case(g))
        end_case(c, t);
    s = seen_add(&c->list, t, g);
    size = isnan(s->depth) ? 0 : largest(g);
    if (right_frame(w, s) && right_section(w, s) && (isnan(w->depth) || !isnan(s->depth)) &&
        is_better(c, g, s, size)) {
        struct rc_grid *old = c->grid;

        c->grid = g;
        c->size = size;
        let_go(c, old);
    } else {
        let_go(c, g);
    }
}

/* ---- messages ---- */

static _Noreturn void
no_channel(struct choice *c, struct tool *t)
{
    struct name_list l = {.asked = c->wish->channel};

    seen_channels(&c->list, &l);
    tool_die(t, "%s: there is no channel %s: there are %s", t->source, c->wish->channel,
             name_list_end(&l));
}

static const char *
wished(const struct choice *c)
{
    return c->wish->channel == NULL ? "frame" : c->wish->channel;
}

static _Noreturn void
no_case(struct choice *c, struct tool *t)
{
    struct name_list l = {.n = 0};

    seen_cases(&c->list, right_channel, c->wish, &l);
    tool_die(t, "%s: case %zu has no %s: there are cases %s", t->source, c->wish->number, wished(c),
             name_list_end(&l));
}

static _Noreturn void
no_depth(struct choice *c, struct tool *t)
{
    struct name_list l = {.n = 0};

    seen_depths(&c->list, right_frame, c->wish, &l);
    tool_die(t, "%s: there is no %s at depth %s m: %s%s%s", t->source, wished(c),
             rc_number(c->wish->depth), l.n == 0 ? "no frame has a depth" : "there are ",
             name_list_end(&l), l.n == 0 ? "" : " m");
}

static _Noreturn void
fail(struct choice *c, struct tool *t)
{
    bool channel = false, number = false, section = false;

    for (size_t k = 0; k < c->list.n; k++) {
        const struct seen *s = &c->list.seen[k];

        channel = channel || right_channel(c->wish, s);
        number = number || right_frame(c->wish, s);
        section = section || (right_frame(c->wish, s) && right_section(c->wish, s));
    }
    if (c->list.n == 0)
        tool_die(t, "%s: the stream has no frame to draw", t->source);
    if (!channel)
        no_channel(c, t);
    if (!number)
        no_case(c, t);
    if (!section)
        tool_die(t, "%s: there is no section across %s, such as rc-stress --section %s=0 makes",
                 t->source, c->wish->section, c->wish->section);
    no_depth(c, t);
}

/* Frees *p unless it has the same grid as the other frame. */
static void
keep_beside(struct rc_grid **p, const struct rc_grid *g)
{
    const struct rc_grid *is = *p;

    if (is != NULL && rc_grid_case(is) == rc_grid_case(g) && rc_grid_get(g, "section") == NULL &&
        strcmp(g->channel, is->channel) != 0 && is->nx == g->nx && is->ny == g->ny &&
        is->dx == g->dx && is->dy == g->dy)
        return;
    rc_grid_free(*p);
    *p = NULL;
}

void
choice_settle(struct choice *c, struct tool *t)
{
    size_t number, cases = 0, depths = 0, same = 0, last = 0;
    bool others = false;
    double depth, drawn = NAN;

    end_case(c, t);
    if (c->grid == NULL)
        fail(c, t);
    if (!isnan(c->wish->depth) && rc_grid_number(c->grid, "depth", &drawn))
        wanted_tell(t, c->wish->depth, drawn);
    keep_beside(&c->beside.pressure, c->grid);
    keep_beside(&c->beside.contact, c->grid);
    number = rc_grid_case(c->grid);
    for (size_t k = 0; k < c->list.n; k++) {
        const struct seen *s = &c->list.seen[k];
        bool channel = strcmp(s->channel, c->grid->channel) == 0;

        others = others || !channel;
        if (!channel || !right_section(c->wish, s) || (!isnan(drawn) && s->depth != drawn))
            continue;
        cases += s->number != last;
        last = s->number;
        depths += s->number == number && !isnan(s->depth);
        same += s->number == number && isnan(s->depth);
    }
    if (cases > 1 && c->wish->number == 0)
        tool_warn(t, "%zu cases match: case %zu is drawn, the others are left: choose with --case",
                  cases, number);
    if (same > 1)
        tool_warn(t, "%zu frames of case %zu match (%s): the first is drawn", same, number,
                  c->grid->channel);
    if (others && c->wish->channel == NULL)
        tool_note(t, "drawing %s: choose another channel with --channel", c->grid->channel);
    c->by_size = depths > 1 && isnan(c->wish->depth);
    if (c->by_size && rc_grid_number(c->grid, "depth", &depth))
        tool_note(t, "of %zu depths drawing %s, where %s is largest: choose with --depth", depths,
                  scale_value(depth, "m"), c->grid->channel);
}

void
choice_free(struct choice *c)
{
    rc_grid_free(c->grid);
    rc_grid_free(c->beside.pressure);
    rc_grid_free(c->beside.contact);
    seen_free(&c->list);
}
