/*
 * Chooses the frame of a stream to draw.
 */
#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct seen {
    char *channel;
    char section; /* 'x', 'y', or 0 */
    double depth; /* NAN: none      */
    size_t number;
};

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

static void
remember(struct choice *c, struct tool *t, const struct rc_grid *g)
{
    const char *section = rc_grid_get(g, "section");
    struct seen *s = c->seen;

    if (c->n == c->capacity) {
        c->capacity = c->capacity == 0 ? 64 : 2 * c->capacity;
        s = realloc(c->seen, c->capacity * sizeof *s);
        if (s == NULL)
            tool_die(t, EXIT_IMPOSSIBLE, "out of memory for a list of %zu frames", c->capacity);
        c->seen = s;
    }
    s += c->n;
    *s = (struct seen){.channel = strdup(g->channel),
                       .section = section == NULL ? '\0' : section[0],
                       .depth = NAN,
                       .number = rc_grid_case(g)};
    if (s->channel == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "out of memory for a list of frames");
    rc_grid_number(g, "depth", &s->depth);
    c->n++;
}

static bool
right_channel(const struct wish *w, const struct seen *s)
{
    return w->channel == NULL || strcmp(w->channel, s->channel) == 0;
}

static bool
right_case(const struct wish *w, const struct seen *s)
{
    return w->number == 0 || w->number == s->number;
}

static bool
right_section(const struct wish *w, const struct seen *s)
{
    return w->section == NULL || w->section[0] == s->section;
}

static bool
right_depth(const struct wish *w, const struct seen *s)
{
    return isnan(w->depth) || !isnan(s->depth);
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
    if ((depth = malloc(c->n * sizeof *depth)) == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "out of memory for %zu depths", c->n);
    for (size_t k = 0; k < c->n; k++)
        if (strcmp(c->seen[k].channel, c->grid->channel) == 0 &&
            c->seen[k].number == rc_grid_case(c->grid) && !isnan(c->seen[k].depth))
            depth[n++] = c->seen[k].depth;
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

    if (c->n > 0 && c->seen[c->n - 1].number != rc_grid_case(g))
        end_case(c, t);
    remember(c, t, g);
    s = &c->seen[c->n - 1];
    size = isnan(s->depth) ? 0 : largest(g);
    if (right_channel(w, s) && right_case(w, s) && right_section(w, s) && right_depth(w, s) &&
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

    for (size_t k = 0, i; k < c->n; k++) {
        for (i = 0; i < k && strcmp(c->seen[i].channel, c->seen[k].channel) != 0;)
            i++;
        if (i == k)
            name_list_add(&l, c->seen[k].channel);
    }
    tool_die(t, EXIT_IMPOSSIBLE, "%s: there is no channel %s: there are %s", t->source,
             c->wish->channel, name_list_end(&l));
}

static _Noreturn void
no_case(struct choice *c, struct tool *t)
{
    char text[TICKS_TEXT];
    struct name_list l = {.n = 0};

    for (size_t k = 0; k < c->n; k++) {
        if (!right_channel(c->wish, &c->seen[k]) ||
            (k > 0 && c->seen[k].number == c->seen[k - 1].number && l.n > 0))
            continue;
        snprintf(text, sizeof text, "%zu", c->seen[k].number);
        name_list_add(&l, text);
    }
    tool_die(t, EXIT_IMPOSSIBLE, "%s: case %zu holds no %s: there are cases %s", t->source,
             c->wish->number, c->wish->channel == NULL ? "frame" : c->wish->channel,
             name_list_end(&l));
}

static _Noreturn void
no_depth(struct choice *c, struct tool *t)
{
    char text[TICKS_TEXT];
    struct name_list l = {.n = 0};

    for (size_t k = 0, i; k < c->n; k++) {
        const struct seen *s = &c->seen[k];

        if (isnan(s->depth) || !right_channel(c->wish, s) || !right_case(c->wish, s))
            continue;
        for (i = 0;
             i < k && (c->seen[i].depth != s->depth || !right_channel(c->wish, &c->seen[i]) ||
                       !right_case(c->wish, &c->seen[i]));)
            i++;
        if (i == k)
            name_list_add(&l, rc_number_text(text, s->depth));
    }
    tool_die(t, EXIT_IMPOSSIBLE, "%s: there is no %s at depth %s m: %s%s%s", t->source,
             c->wish->channel == NULL ? "frame" : c->wish->channel,
             rc_number_text(text, c->wish->depth), l.n == 0 ? "no frame has a depth" : "there are ",
             name_list_end(&l), l.n == 0 ? "" : " m");
}

static _Noreturn void
fail(struct choice *c, struct tool *t)
{
    bool channel = false, number = false, section = false;

    for (size_t k = 0; k < c->n; k++) {
        const struct seen *s = &c->seen[k];

        channel = channel || right_channel(c->wish, s);
        number = number || (right_channel(c->wish, s) && right_case(c->wish, s));
        section = section || (right_channel(c->wish, s) && right_case(c->wish, s) &&
                              right_section(c->wish, s));
    }
    if (c->n == 0)
        tool_die(t, EXIT_IMPOSSIBLE, "%s: the stream holds no frame: there is nothing to draw",
                 t->source);
    if (!channel)
        no_channel(c, t);
    if (!number)
        no_case(c, t);
    if (!section)
        tool_die(t, EXIT_IMPOSSIBLE,
                 "%s: there is no section across %s, such as rc-stress --section %s=0 makes",
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
    char where[TICKS_TEXT];
    double depth, drawn = NAN;

    end_case(c, t);
    if (c->grid == NULL)
        fail(c, t);
    if (!isnan(c->wish->depth) && rc_grid_number(c->grid, "depth", &drawn))
        wanted_tell(t, c->wish->depth, drawn);
    keep_beside(&c->beside.pressure, c->grid);
    keep_beside(&c->beside.contact, c->grid);
    number = rc_grid_case(c->grid);
    for (size_t k = 0; k < c->n; k++) {
        const struct seen *s = &c->seen[k];
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
                  scale_value(where, depth, "m"), c->grid->channel);
}

void
choice_free(struct choice *c)
{
    rc_grid_free(c->grid);
    rc_grid_free(c->beside.pressure);
    rc_grid_free(c->beside.contact);
    for (size_t k = 0; k < c->n; k++)
        free(c->seen[k].channel);
    free(c->seen);
}
