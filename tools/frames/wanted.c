/* SPDX-License-Identifier: GPL-3.0-or-later */
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

/* A frame that was read, without its values. */
struct seen {
    char *channel;
    char section; /* 'x', 'y', or 0 */
    double depth; /* NAN: none      */
    size_t number;
    bool right; /* its channel, case and section are requested */
    bool taken;
};

/* A selected frame, or one that may be. sure: it is selected, whatever frames follow. */
struct held {
    struct rc_grid *grid;
    bool kept, sure;
    size_t seen; /* its index */
    struct place place;
};

struct asked_depth {
    double nearest; /* of the current case so far; NAN: none */
    bool met;       /* some case has it */
};

struct wanted_frames {
    struct seen *seen;
    size_t n, room, first; /* first: of the current case */
    struct asked_depth *asked;
    struct held *held;
    size_t waiting, space;
    struct rc_grid *next; /* was read, but follows the frames that wait */
    struct place place;
    bool ended;
};

/* ---- whether a frame is requested ---- */

/* Name k of the list: its start and length; NULL past the last. */
static const char *
name_at(const struct wanted *w, size_t k, size_t *length)
{
    for (const char *names = w->channel; names != NULL; k--) {
        *length = w->one ? strlen(names) : strcspn(names, ",");
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
right_channel(const struct wanted *w, const struct seen *s)
{
    const char *name;
    size_t n;

    for (size_t k = 0; (name = name_at(w, k, &n)) != NULL; k++)
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

void
wanted_check(const struct wanted *w, struct tool *t)
{
    size_t n;

    for (size_t k = 0; name_at(w, k, &n) != NULL; k++)
        if (n == 0)
            tool_usage(t, "--channel '%s': a name is empty", w->channel);
}

static struct seen *
record(const struct wanted *w, struct tool *t, const struct rc_grid *g)
{
    struct wanted_frames *f = w->frames;
    const char *section = rc_grid_get(g, "section");
    struct seen *s;

    f->seen = tool_grown(t, f->seen, f->n, &f->room, sizeof *f->seen, "a list of frames");
    s = &f->seen[f->n++];
    *s = (struct seen){.channel = tool_copy(t, g->channel),
                       .section = section == NULL ? '\0' : section[0],
                       .number = rc_grid_case(g)};
    if (!rc_grid_number(g, "depth", &s->depth))
        s->depth = NAN;
    s->right = right_channel(w, s) && right_case(w, s) &&
               (w->section == NULL || w->section[0] == s->section);
    return s;
}

/* ---- depths ---- */

static double
off(double depth, double asked)
{
    double d = fabs(depth - asked);

    return d <= 1e-9 * asked ? 0 : d; /* the last digits of 10um and of 1e-05 differ */
}

/* The nearest depth of the current case, unless it is too far: NAN. */
static double
near_enough(const struct wanted_frames *f, double nearest, double asked)
{
    double between = INFINITY, beyond = INFINITY;

    for (size_t k = f->first; k < f->n;
         k++) { /* distances to the next: towards `asked`, and away */
        double step = f->seen[k].right ? fabs(f->seen[k].depth - nearest) : 0;

        if (step > 0 && (f->seen[k].depth > nearest) == (asked > nearest))
            between = fmin(between, step);
        else if (step > 0)
            beyond = fmin(beyond, step);
    }
    if (off(nearest, asked) <= 1e-3 * asked || isfinite(between))
        return nearest;
    return isfinite(beyond) && fabs(asked - nearest) <= 0.5 * (1 + 1e-9) * beyond ? nearest : NAN;
}

/* Keeps the waiting frames at the depth that is so far the nearest to depth k of the list. They are sure if
 * the depth is exactly this, or at the `end` of the case. */
static void
keep_nearest(const struct wanted *w, struct tool *t, size_t k, bool end)
{
    struct wanted_frames *f = w->frames;
    const double asked = w->depth.v[k];
    double nearest = f->asked[k].nearest;

    if (end)
        nearest = near_enough(f, nearest, asked);
    for (size_t i = 0; i < f->waiting; i++)
        if (!f->held[i].sure && f->seen[f->held[i].seen].depth == nearest) {
            f->held[i].kept = true;
            f->held[i].sure = end || off(nearest, asked) == 0;
        }
    if (!end)
        return;
    f->asked[k].nearest = NAN;
    if (!f->asked[k].met && off(nearest, asked) > 1e-3 * asked)
        tool_warn(t, "--depth: no frame is at %s m: the nearest depth, %s m, is taken",
                  rc_number(asked), rc_number(nearest));
    f->asked[k].met |= !isnan(nearest);
}

/* Frees the waiting frames that are not selected. */
static void
sort_out(const struct wanted *w, struct tool *t, bool end)
{
    struct wanted_frames *f = w->frames;
    size_t n = 0;

    for (size_t i = 0; i < f->waiting; i++)
        f->held[i].kept = f->held[i].sure;
    for (size_t k = 0; k < w->depth.n; k++)
        keep_nearest(w, t, k, end);
    for (size_t i = 0; i < f->waiting; i++)
        if (f->held[i].kept)
            f->held[n++] = f->held[i];
        else
            rc_grid_free(f->held[i].grid);
    f->waiting = n;
}

/* ---- frame by frame ---- */

static void
hold(const struct wanted *w, struct tool *t, struct rc_grid *g)
{
    struct wanted_frames *f = w->frames;
    const struct seen *s = record(w, t, g);

    if (!s->right || (w->depth.n > 0 && isnan(s->depth))) {
        if (w->other == NULL || !right_case(w, s) || !w->other(w->ctx, g))
            rc_grid_free(g);
        return;
    }
    for (size_t k = 0; k < w->depth.n; k++)
        if (isnan(f->asked[k].nearest) ||
            off(s->depth, w->depth.v[k]) < off(f->asked[k].nearest, w->depth.v[k]))
            f->asked[k].nearest = s->depth;
    f->held = tool_grown(t, f->held, f->waiting, &f->space, sizeof *f->held, "a list of frames");
    f->held[f->waiting++] =
        (struct held){.grid = g, .seen = f->n - 1, .sure = w->depth.n == 0, .place = f->place};
    sort_out(w, t, false);
}

static void
set_place(struct tool *t, const struct place *place)
{
    t->input.source = place->source;
    t->input.frame = place->frame;
}

/* Reads a frame. At the end of a case the next frame waits until the selected ones were taken. */
static void
read_on(const struct wanted *w, struct tool *t)
{
    struct wanted_frames *f = w->frames;
    struct rc_grid *g = f->next;

    f->next = NULL;
    if (g == NULL) {
        if (f->n > 0)
            set_place(t, &f->place);
        g = tool_read(t);
        f->place = (struct place){t->input.source, t->input.frame};
        if (f->first < f->n && (g == NULL || rc_grid_case(g) != f->seen[f->first].number)) {
            sort_out(w, t, true);
            f->first = f->n;
            f->next = g;
            f->ended = g == NULL;
            return;
        }
    }
    f->ended = g == NULL;
    if (g != NULL)
        hold(w, t, g);
}

static struct rc_grid *
first_held(struct wanted_frames *f, struct tool *t)
{
    const struct held first = f->held[0];

    memmove(f->held, f->held + 1, --f->waiting * sizeof *f->held);
    f->seen[first.seen].taken = true;
    set_place(t, &first.place);
    return first.grid;
}

/* ---- requests that no frame met ---- */

static _Noreturn void
no_channel(const struct wanted *w, struct tool *t, const char *name, size_t n)
{
    const struct wanted_frames *f = w->frames;
    char asked[NAME_SIZE];
    struct name_list l = {.asked = asked};

    snprintf(asked, sizeof asked, "%.*s", (int)n, name);
    for (size_t k = 0, i; k < f->n; k++) {
        for (i = 0; strcmp(f->seen[i].channel, f->seen[k].channel) != 0;)
            i++;
        if (i == k)
            name_list_add(&l, f->seen[k].channel);
    }
    tool_die(t, "%s: no frame with the channel %.*s, only %s", t->input.source, (int)n, name,
             name_list_end(&l));
}

static _Noreturn void
no_case(const struct wanted *w, struct tool *t, double number)
{
    struct name_list l = {.n = 0};
    size_t last = 0;
    char text[32];

    for (const struct seen *s = w->frames->seen; s < w->frames->seen + w->frames->n; s++) {
        if (!right_channel(w, s) || s->number == last)
            continue;
        last = s->number;
        snprintf(text, sizeof text, "%zu", last);
        name_list_add(&l, text);
    }
    tool_die(t, "%s: no case %.0f%s%s: there are cases %s", t->input.source, number,
             w->channel == NULL ? "" : " with ", w->channel == NULL ? "" : w->channel,
             name_list_end(&l));
}

static _Noreturn void
no_depth(const struct wanted *w, struct tool *t, double depth)
{
    const struct seen *seen = w->frames->seen;
    struct name_list l = {.n = 0};

    for (size_t k = 0, i; k < w->frames->n; k++) {
        if (isnan(seen[k].depth) || !seen[k].right)
            continue;
        for (i = 0; !seen[i].right || seen[i].depth != seen[k].depth;)
            i++;
        if (i == k)
            name_list_add(&l, rc_number(seen[k].depth));
    }
    tool_die(t, "%s: no frame at depth %s m: %s%s%s", t->input.source, rc_number(depth),
             l.n == 0 ? "no frame has a depth" : "there are ", name_list_end(&l),
             l.n == 0 ? "" : " m");
}

/* Ends the tool if no frame (with `taken`: no selected frame) has a name of the list. */
static void
demand_channels(const struct wanted *w, struct tool *t, bool taken)
{
    const struct wanted_frames *f = w->frames;
    const char *name;
    size_t n, i;

    for (size_t k = 0; (name = name_at(w, k, &n)) != NULL; k++) {
        for (i = 0; i < f->n; i++)
            if (is_name(&f->seen[i], name, n) && (!taken || f->seen[i].taken))
                break;
        if (i == f->n && taken)
            tool_die(t, "%s: no frame with the channel %.*s among the requested cases and depths",
                     t->input.source, (int)n, name);
        if (i == f->n)
            no_channel(w, t, name, n);
    }
}

static void
demand_cases(const struct wanted *w, struct tool *t)
{
    const struct wanted_frames *f = w->frames;
    size_t i;

    for (size_t k = 0; k < w->number.n; k++) {
        for (i = 0; i < f->n; i++)
            if (right_channel(w, &f->seen[i]) && (double)f->seen[i].number == w->number.v[k])
                break;
        if (i == f->n)
            no_case(w, t, w->number.v[k]);
    }
}

static void
demand_section(const struct wanted *w, struct tool *t)
{
    size_t i = 0;

    while (i < w->frames->n && !w->frames->seen[i].right)
        i++;
    if (w->section != NULL && i == w->frames->n)
        tool_die(t, "%s: there is no section across %s, such as rc-stress --section %s=0 makes",
                 t->input.source, w->section, w->section);
}

/* Decides after the last frame. */
static void
settle(const struct wanted *w, struct tool *t)
{
    struct wanted_frames *f = w->frames;

    if (f->n == 0)
        tool_die(t, "%s: the stream has no frame", t->input.source);
    demand_channels(w, t, false);
    demand_cases(w, t);
    demand_section(w, t);
    for (size_t k = 0; k < w->depth.n; k++)
        if (!f->asked[k].met)
            no_depth(w, t, w->depth.v[k]);
    demand_channels(w, t, true);
    for (size_t k = 0; k < f->n; k++)
        free(f->seen[k].channel);
    free(f->seen);
    free(f->asked);
    free(f->held);
    free(f);
}

struct rc_grid *
wanted_read(struct wanted *w, struct tool *t)
{
    if (w->frames == NULL) {
        w->frames = tool_room(t, 1, sizeof *w->frames, "a list of frames");
        w->frames->asked = tool_room(t, w->depth.n, sizeof *w->frames->asked, "a list of depths");
        for (size_t k = 0; k < w->depth.n; k++)
            w->frames->asked[k].nearest = NAN;
    }
    while (!w->frames->ended && !(w->frames->waiting > 0 && w->frames->held[0].sure))
        read_on(w, t);
    if (w->frames->waiting > 0)
        return first_held(w->frames, t);
    settle(w, t);
    return NULL;
}
