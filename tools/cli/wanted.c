#include "wanted.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tools/text/text.h"

/* The current place in the input, for messages. */
struct place {
    const char *source;
    size_t frame;
};

/* A waiting frame. sure: it is selected, whatever frames follow. */
struct held {
    struct rc_grid *grid;
    double depth;
    bool kept, sure;
    size_t seen; /* its index in wanted->seen */
    struct place place;
};

struct wanted_depths {
    size_t number; /* number of the case; 0: none yet */
    double *depth; /* its frames that match except perhaps in depth */
    size_t n, room;
    bool *met; /* for each requested depth: some case has it */
    struct held *held;
    size_t waiting, space;
    struct place place;
    bool ended;
};

/* ---- frames that were read ---- */

struct seen *
seen_add(struct seen_list *l, struct tool *t, const struct rc_grid *g)
{
    const char *section = rc_grid_get(g, "section");
    struct seen *s;

    l->seen = tool_grown(t, l->seen, l->n, &l->room, sizeof *l->seen, "a list of frames");
    s = &l->seen[l->n++];
    *s = (struct seen){.channel = tool_copy(t, g->channel),
                       .section = section == NULL ? '\0' : section[0],
                       .number = rc_grid_case(g)};
    if (!rc_grid_number(g, "depth", &s->depth))
        s->depth = NAN;
    return s;
}

void
seen_free(struct seen_list *l)
{
    for (size_t k = 0; k < l->n; k++)
        free(l->seen[k].channel);
    free(l->seen);
}

void
seen_channels(const struct seen_list *l, struct name_list *to)
{
    for (size_t k = 0, i; k < l->n; k++) {
        for (i = 0; strcmp(l->seen[i].channel, l->seen[k].channel) != 0;)
            i++;
        if (i == k)
            name_list_add(to, l->seen[k].channel);
    }
}

void
seen_cases(const struct seen_list *l, seen_right *right, const void *ctx, struct name_list *to)
{
    size_t last = 0;
    char text[32];

    for (size_t k = 0; k < l->n; k++) {
        if (!right(ctx, &l->seen[k]) || l->seen[k].number == last)
            continue;
        last = l->seen[k].number;
        snprintf(text, sizeof text, "%zu", last);
        name_list_add(to, text);
    }
}

void
seen_depths(const struct seen_list *l, seen_right *right, const void *ctx, struct name_list *to)
{
    for (size_t k = 0, i; k < l->n; k++) {
        if (isnan(l->seen[k].depth) || !right(ctx, &l->seen[k]))
            continue;
        for (i = 0; !right(ctx, &l->seen[i]) || l->seen[i].depth != l->seen[k].depth;)
            i++;
        if (i == k)
            name_list_add(to, rc_number(l->seen[k].depth));
    }
}

/* ---- whether a frame meets a list ---- */

/* Name k of the list: its start and length; NULL past the last. */
static const char *
name_at(const char *names, size_t k, size_t *length)
{
    for (; names != NULL; k--) {
        *length = strcspn(names, ",");
        if (k == 0)
            return names;
        names = names[*length] == ',' ? names + *length + 1 : NULL;
    }
    return NULL;
}

static bool
is_name(const struct seen *s, const char *name, size_t n)
{
    return strlen(s->channel) == n && strncmp(s->channel, name, n) == 0;
}

static bool
right_channel(const void *ctx, const struct seen *s)
{
    const struct wanted *w = ctx;
    const char *name;
    size_t n;

    for (size_t k = 0; (name = name_at(w->channel, k, &n)) != NULL; k++)
        if (is_name(s, name, n))
            return true;
    return w->channel == NULL;
}

static bool
right_case(const struct wanted *w, const struct seen *s)
{
    for (size_t k = 0; k < w->number.n; k++)
        if ((double)s->number == w->number.v[k])
            return true;
    return w->number.n == 0;
}

/* ---- depths ---- */

static double
off(double depth, double asked)
{
    double d = fabs(depth - asked);

    return d <= 1e-9 * asked ? 0 : d; /* the last digits of 10um and of 1e-05 differ */
}

static double
nearest_of(const double *depth, size_t n, double asked)
{
    double nearest = NAN;

    for (size_t k = 0; k < n; k++)
        if (isnan(nearest) || off(depth[k], asked) < off(nearest, asked))
            nearest = depth[k];
    return nearest;
}

double
wanted_depth(const double *depth, size_t n, double asked)
{
    double nearest = nearest_of(depth, n, asked), between = INFINITY, beyond = INFINITY;

    for (size_t k = 0; k < n; k++) { /* distances to the next depths: towards `asked`, and away */
        double step = fabs(depth[k] - nearest);
        if (step > 0 && (depth[k] > nearest) == (asked > nearest))
            between = fmin(between, step);
        else if (step > 0)
            beyond = fmin(beyond, step);
    }
    if (off(nearest, asked) <= 1e-3 * asked || isfinite(between))
        return nearest;
    return isfinite(beyond) && fabs(asked - nearest) <= 0.5 * (1 + 1e-9) * beyond ? nearest : NAN;
}

void
wanted_tell(struct tool *t, double asked, double taken)
{
    if (off(taken, asked) > 1e-3 * asked)
        tool_warn(t, "--depth: no frame is at %s m: the nearest depth, %s m, is taken",
                  rc_number(asked), rc_number(taken));
}

/* ---- frame by frame ---- */

static bool
anything_goes(const struct wanted *w)
{
    return w->channel == NULL && w->depth.n == 0 && w->number.n == 0;
}

void
wanted_check(const struct wanted *w, struct tool *t)
{
    size_t n;

    for (size_t k = 0; name_at(w->channel, k, &n) != NULL; k++)
        if (n == 0)
            tool_usage(t, "--channel '%s': a name is empty", w->channel);
    for (size_t k = 0; k < w->number.n; k++)
        if (w->number.v[k] != floor(w->number.v[k]))
            tool_usage(t, "--case %g: it must be a whole number", w->number.v[k]);
}

static bool
only_depth(const void *ctx, const struct seen *s)
{
    const struct wanted *w = ctx;

    return right_channel(w, s) && right_case(w, s);
}

/* ---- frames that wait for others of their case ---- */

static void
begin_depths(struct wanted *w, struct tool *t)
{
    w->depths = tool_room(t, 1, sizeof *w->depths, "depths");
    w->depths->met = tool_room(t, w->depth.n, sizeof *w->depths->met, "depths");
}

/* Keeps the waiting frames at the depth that is so far the nearest to depth k of the list. They are sure if
 * the depth is exactly this, or at the `end` of the case. */
static void
keep_nearest(struct wanted *w, struct tool *t, size_t k, bool end)
{
    struct wanted_depths *d = w->depths;
    const double asked = w->depth.v[k];
    double nearest = end ? wanted_depth(d->depth, d->n, asked) : nearest_of(d->depth, d->n, asked);

    for (size_t i = 0; i < d->waiting; i++)
        if (!d->held[i].sure && d->held[i].depth == nearest) {
            d->held[i].kept = true;
            d->held[i].sure = end || off(nearest, asked) == 0;
        }
    if (end && !isnan(nearest)) {
        if (!d->met[k])
            wanted_tell(t, asked, nearest);
        d->met[k] = true;
    }
}

/* Frees the waiting frames that are not selected. */
static void
sort_out(struct wanted *w, struct tool *t, bool end)
{
    struct wanted_depths *d = w->depths;
    size_t n = 0;

    for (size_t i = 0; i < d->waiting; i++)
        d->held[i].kept = d->held[i].sure;
    for (size_t k = 0; k < w->depth.n; k++)
        keep_nearest(w, t, k, end);
    for (size_t i = 0; i < d->waiting; i++)
        if (d->held[i].kept)
            d->held[n++] = d->held[i];
        else
            rc_grid_free(d->held[i].grid);
    d->waiting = n;
}

static void
hold(struct wanted *w, struct tool *t, struct rc_grid *g)
{
    struct wanted_depths *d = w->depths;
    const struct seen *s = seen_add(&w->list, t, g);
    size_t k = 0;

    if (isnan(s->depth) || !only_depth(w, s)) {
        rc_grid_free(g);
        return;
    }
    while (k < d->n && d->depth[k] != s->depth)
        k++;
    if (k == d->n) {
        d->depth = tool_grown(t, d->depth, d->n, &d->room, sizeof *d->depth, "a list of frames");
        d->depth[d->n++] = s->depth;
    }
    d->held = tool_grown(t, d->held, d->waiting, &d->space, sizeof *d->held, "a list of frames");
    d->held[d->waiting++] =
        (struct held){.grid = g, .depth = s->depth, .seen = w->list.n - 1, .place = d->place};
    sort_out(w, t, false);
}

static void
set_place(struct tool *t, const struct place *place)
{
    t->source = place->source;
    t->frame = place->frame;
}

static struct rc_grid *
first_held(struct wanted *w, struct tool *t)
{
    struct wanted_depths *d = w->depths;
    const struct held first = d->held[0];

    memmove(d->held, d->held + 1, --d->waiting * sizeof *d->held);
    w->list.seen[first.seen].taken = true;
    set_place(t, &first.place);
    return first.grid;
}

static struct rc_grid *
read_by_depth(struct wanted *w, struct tool *t)
{
    struct wanted_depths *d = w->depths;

    while (!d->ended && !(d->waiting > 0 && d->held[0].sure)) {
        struct rc_grid *g;
        if (d->number != 0)
            set_place(t, &d->place);
        g = tool_read(t);
        d->place = (struct place){t->source, t->frame};
        if (g == NULL || rc_grid_case(g) != d->number) {
            sort_out(w, t, true);
            d->n = 0;
            d->number = g == NULL ? 0 : rc_grid_case(g);
        }
        d->ended = g == NULL;
        if (g != NULL)
            hold(w, t, g);
    }
    return d->waiting > 0 ? first_held(w, t) : NULL;
}

/* ---- requests that no frame met ---- */

static _Noreturn void
no_channel(const struct wanted *w, struct tool *t, const char *name, size_t n)
{
    char asked[NAME_SIZE];
    struct name_list l = {.asked = asked};

    snprintf(asked, sizeof asked, "%.*s", (int)n, name);
    seen_channels(&w->list, &l);
    tool_die(t, "%s: no frame with the channel %.*s, only %s", t->source, (int)n, name,
             name_list_end(&l));
}

static _Noreturn void
no_case(const struct wanted *w, struct tool *t, double number)
{
    struct name_list l = {.n = 0};

    seen_cases(&w->list, right_channel, w, &l);
    tool_die(t, "%s: no case %.0f%s%s: there are cases %s", t->source, number,
             w->channel == NULL ? "" : " with ", w->channel == NULL ? "" : w->channel,
             name_list_end(&l));
}

static _Noreturn void
no_depth(const struct wanted *w, struct tool *t, double depth)
{
    struct name_list l = {.n = 0};

    seen_depths(&w->list, only_depth, w, &l);
    tool_die(t, "%s: no frame at depth %s m: %s%s%s", t->source, rc_number(depth),
             l.n == 0 ? "no frame has a depth" : "there are ", name_list_end(&l),
             l.n == 0 ? "" : " m");
}

/* Ends the tool if no frame (with `wanted`: no selected frame) has a name of the list. */
static void
demand_channels(const struct wanted *w, struct tool *t, bool wanted)
{
    const char *name;
    size_t n, i;

    for (size_t k = 0; (name = name_at(w->channel, k, &n)) != NULL; k++) {
        for (i = 0; i < w->list.n; i++)
            if (is_name(&w->list.seen[i], name, n) && (!wanted || w->list.seen[i].taken))
                break;
        if (i == w->list.n && wanted)
            tool_die(t, "%s: no frame with the channel %.*s among the requested cases and depths",
                     t->source, (int)n, name);
        if (i == w->list.n)
            no_channel(w, t, name, n);
    }
}

static void
demand_cases(const struct wanted *w, struct tool *t)
{
    size_t i;

    for (size_t k = 0; k < w->number.n; k++) {
        for (i = 0; i < w->list.n; i++)
            if (right_channel(w, &w->list.seen[i]) &&
                (double)w->list.seen[i].number == w->number.v[k])
                break;
        if (i == w->list.n)
            no_case(w, t, w->number.v[k]);
    }
}

static void
demand_depths(const struct wanted *w, struct tool *t)
{
    for (size_t k = 0; k < w->depth.n; k++)
        if (!w->depths->met[k])
            no_depth(w, t, w->depth.v[k]);
}

/* Decides after the last frame. */
static void
settle(struct wanted *w, struct tool *t)
{
    if (w->list.n == 0)
        tool_die(t, "%s: the stream has no frame", t->source);
    demand_channels(w, t, false);
    demand_cases(w, t);
    demand_depths(w, t);
    demand_channels(w, t, true);
    seen_free(&w->list);
    if (w->depths != NULL) {
        free(w->depths->depth);
        free(w->depths->met);
        free(w->depths->held);
    }
    free(w->depths);
}

/* ---- both ---- */

/* True if the frame is selected, without regard to depths. */
static bool
is_wanted(struct wanted *w, struct tool *t, const struct rc_grid *g)
{
    struct seen *s;

    if (w->list.n > 0 && anything_goes(w)) /* the message names no frame: the first one is enough */
        return true;
    s = seen_add(&w->list, t, g);
    return s->taken = only_depth(w, s);
}

struct rc_grid *
wanted_read(struct wanted *w, struct tool *t)
{
    struct rc_grid *g;

    if (w->depth.n > 0 && w->depths == NULL)
        begin_depths(w, t);
    if (w->depths != NULL) {
        g = read_by_depth(w, t);
    } else {
        while ((g = tool_read(t)) != NULL && !is_wanted(w, t, g))
            if (w->other == NULL || !w->other(w->ctx, g))
                rc_grid_free(g);
    }
    if (g == NULL)
        settle(w, t);
    return g;
}
