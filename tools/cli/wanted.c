#include "wanted.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tools/text/text.h"

struct seen {
    char *channel;
    double depth; /* NAN: none */
    size_t number;
};

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
right_channel(const struct wanted *w, const struct seen *s)
{
    const char *name;
    size_t n;

    for (size_t k = 0; (name = name_at(w->channel, k, &n)) != NULL; k++)
        if (is_name(s, name, n))
            return true;
    return w->channel == NULL;
}

static bool
is_depth(const struct seen *s, double depth)
{
    return fabs(s->depth - depth) <= 1e-3 * depth;
}

static bool
right_depth(const struct wanted *w, const struct seen *s)
{
    for (size_t k = 0; k < w->depth.n; k++)
        if (is_depth(s, w->depth.v[k]))
            return true;
    return w->depth.n == 0;
}

static bool
right_case(const struct wanted *w, const struct seen *s)
{
    for (size_t k = 0; k < w->number.n; k++)
        if ((double)s->number == w->number.v[k])
            return true;
    return w->number.n == 0;
}

static bool
is_wanted(const struct wanted *w, const struct seen *s)
{
    return right_channel(w, s) && right_depth(w, s) && right_case(w, s);
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
            tool_die(t, EXIT_USAGE, "--channel '%s': a name is empty", w->channel);
    for (size_t k = 0; k < w->number.n; k++)
        if (w->number.v[k] != floor(w->number.v[k]))
            tool_die(t, EXIT_USAGE, "--case %g: it must be a whole number", w->number.v[k]);
}

bool
wanted_frame(struct wanted *w, struct tool *t, const struct rc_grid *g)
{
    struct seen *s = w->seen;

    if (w->n > 0 && anything_goes(w)) /* no message will name a frame: the first is enough */
        return true;
    if (w->n == w->capacity) {
        w->capacity = w->capacity == 0 ? 64 : 2 * w->capacity;
        if ((s = realloc(w->seen, w->capacity * sizeof *s)) == NULL)
            tool_die(t, EXIT_IMPOSSIBLE, "out of memory for a list of %zu frames", w->capacity);
        w->seen = s;
    }
    s += w->n;
    *s = (struct seen){.channel = strdup(g->channel), .number = rc_grid_case(g)};
    if (s->channel == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "out of memory for a list of frames");
    if (!rc_grid_number(g, "depth", &s->depth))
        s->depth = NAN;
    w->n++;
    return is_wanted(w, s);
}

/* ---- what was not met ---- */

static _Noreturn void
no_channel(const struct wanted *w, struct tool *t, const char *name, size_t n)
{
    struct name_list l = {.n = 0};

    for (size_t k = 0, i; k < w->n; k++) {
        for (i = 0; strcmp(w->seen[i].channel, w->seen[k].channel) != 0;)
            i++;
        if (i == k)
            name_list_add(&l, w->seen[k].channel);
    }
    tool_die(t, EXIT_IMPOSSIBLE, "%s: no frame with the channel %.*s, only %s", t->source, (int)n,
             name, name_list_end(&l));
}

static _Noreturn void
no_case(const struct wanted *w, struct tool *t, double number)
{
    struct name_list l = {.n = 0};
    size_t last = 0;
    char text[32];

    for (size_t k = 0; k < w->n; k++) {
        if (!right_channel(w, &w->seen[k]) || w->seen[k].number == last)
            continue;
        last = w->seen[k].number;
        snprintf(text, sizeof text, "%zu", last);
        name_list_add(&l, text);
    }
    tool_die(t, EXIT_IMPOSSIBLE, "%s: no case %.0f%s%s: there are cases %s", t->source, number,
             w->channel == NULL ? "" : " with ", w->channel == NULL ? "" : w->channel,
             name_list_end(&l));
}

/* Whether only its depth can keep the frame from being wanted. */
static bool
is_deep(const struct wanted *w, const struct seen *s)
{
    return !isnan(s->depth) && right_channel(w, s) && right_case(w, s);
}

static _Noreturn void
no_depth(const struct wanted *w, struct tool *t, double depth)
{
    char text[RC_NUMBER_SIZE];
    struct name_list l = {.n = 0};

    for (size_t k = 0, i; k < w->n; k++) {
        if (!is_deep(w, &w->seen[k]))
            continue;
        for (i = 0; !is_deep(w, &w->seen[i]) || w->seen[i].depth != w->seen[k].depth;)
            i++;
        if (i == k)
            name_list_add(&l, rc_number_text(text, w->seen[k].depth));
    }
    tool_die(t, EXIT_IMPOSSIBLE, "%s: no frame at depth %s m: %s%s%s", t->source,
             rc_number_text(text, depth), l.n == 0 ? "no frame has a depth" : "there are ",
             name_list_end(&l), l.n == 0 ? "" : " m");
}

/* Ends the tool where no frame has a name of the list, with `wanted` no frame that is wanted. */
static void
demand_channels(const struct wanted *w, struct tool *t, bool wanted)
{
    const char *name;
    size_t n, i;

    for (size_t k = 0; (name = name_at(w->channel, k, &n)) != NULL; k++) {
        for (i = 0; i < w->n; i++)
            if (is_name(&w->seen[i], name, n) && (!wanted || is_wanted(w, &w->seen[i])))
                break;
        if (i == w->n && wanted)
            tool_die(t, EXIT_IMPOSSIBLE,
                     "%s: no frame with the channel %.*s among the cases and depths asked for",
                     t->source, (int)n, name);
        if (i == w->n)
            no_channel(w, t, name, n);
    }
}

static void
demand_cases(const struct wanted *w, struct tool *t)
{
    size_t i;

    for (size_t k = 0; k < w->number.n; k++) {
        for (i = 0; i < w->n; i++)
            if (right_channel(w, &w->seen[i]) && (double)w->seen[i].number == w->number.v[k])
                break;
        if (i == w->n)
            no_case(w, t, w->number.v[k]);
    }
}

static void
demand_depths(const struct wanted *w, struct tool *t)
{
    size_t i;

    for (size_t k = 0; k < w->depth.n; k++) {
        for (i = 0; i < w->n; i++)
            if (is_deep(w, &w->seen[i]) && is_depth(&w->seen[i], w->depth.v[k]))
                break;
        if (i == w->n)
            no_depth(w, t, w->depth.v[k]);
    }
}

void
wanted_end(struct wanted *w, struct tool *t)
{
    if (w->n == 0)
        tool_die(t, EXIT_IMPOSSIBLE, "%s: the stream holds no frame", t->source);
    demand_channels(w, t, false);
    demand_cases(w, t);
    demand_depths(w, t);
    demand_channels(w, t, true);
    for (size_t k = 0; k < w->n; k++)
        free(w->seen[k].channel);
    free(w->seen);
    free(w->depth.v);
    free(w->number.v);
}
