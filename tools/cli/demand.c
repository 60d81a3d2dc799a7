/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The memory that a tool needs, checked before it begins to work.
 */
#include <math.h>
#include <string.h>

#include "libcontact/contact.h"
#include "tools/machine/machine.h"
#include "ranks.h"
#include "tool.h"

static const char smaller[] =
    "cut a part out with rc-pick --crop, or take fewer nodes with rc-pick --resample";

/* ---- the budget ---- */

/* Without --memory, processes of the same tool have equal parts of their memory and the free one. */
static void
share_with_siblings(struct tool *t, double *most)
{
    const struct siblings s = machine_siblings("");
    double part = (*most + s.bytes) / (double)s.n;

    if (s.n < 2 || !(part < *most))
        return;
    snprintf(t->room.part, sizeof t->room.part, "beside %zu others (--memory says how much) %s",
             s.n - 1, t->room.bound);
    t->room.bound = t->room.part;
    *most = part;
}

void
tool_budget(struct tool *t)
{
    const size_t beside = ranks_beside(t);
    const struct memory_room room = memory_room("", beside);
    double most = (double)rc_memory_held().held + room.bytes;

    t->room.bound = room.why;
    if (beside > 1) {
        snprintf(t->room.part, sizeof t->room.part, "for each of %zu processes %s", beside,
                 room.why);
        t->room.bound = t->room.part;
    }
    if (t->memory == 0 && t->ranks == NULL)
        share_with_siblings(t, &most);
    if (t->memory != 0 && (double)t->memory < most) {
        most = (double)t->memory;
        t->room.bound = "--memory allows";
    }
    t->room.budget = unit_size(fmax(most, 1));
    rc_memory_budget(t->room.budget);
    t->room.at = tool_now();
}

/* Writes the message: which work exceeds the budget, by how much, and what to do. */
static void
refusal(const struct tool *t, const struct rc_shape *shape, const char *need, char *text,
        size_t size)
{
    char what[64] = "out of memory: the work needs";

    if (shape != NULL)
        snprintf(what, sizeof what, "%zu x %zu nodes need", shape->nx, shape->ny);
    snprintf(text, size, "%s %s %s, %s %s: %s", what, need,
             shown_bytes((double)rc_memory_held().refused), t->room.bound,
             shown_bytes((double)t->room.budget), t->remedy == NULL ? smaller : t->remedy);
}

void
tool_add_refusal(const struct tool *t, const struct rc_grid *g, char *text, size_t size)
{
    const struct rc_shape shape = g != NULL ? rc_grid_shape(g) : (struct rc_shape){0};

    if (rc_memory_held().refused > 0 && strstr(text, "out of memory") != NULL)
        refusal(t, g != NULL ? &shape : NULL, "at least", text, size);
}

enum rc_status
tool_ask_memory(const struct tool *t, const struct rc_shape *shape, size_t bytes,
                struct rc_err *err)
{
    char text[256];

    if (rc_memory_ask(bytes))
        return RC_OK;
    refusal(t, shape, "about", text, sizeof text);
    return rc_err_set(err, "%s", text);
}

void
tool_demand_memory(struct tool *t, const struct rc_grid *g, size_t bytes)
{
    tool_must(t, g, tool_ask_memory(t, rc_shape_of(g), bytes, &t->err));
}

size_t
tool_memory_left(const struct tool *t)
{
    const size_t held = rc_memory_held().held;

    return t->room.budget > held ? t->room.budget - held : 1;
}

/* ---- memory in reports ---- */

/* Resident memory without the blocks: code, stacks, plans of other libraries. */
static size_t
beside(void)
{
    size_t held = rc_memory_held().held, resident;

    memory_give_back(); /* freed blocks would count as code */
    resident = memory_held();
    return resident > held ? resident - held : 0;
}

size_t
tool_own_memory(struct tool *t)
{
    const size_t now = beside();

    if (now > t->room.beside) /* untouched maps make the difference too small */
        t->room.beside = now;
    return rc_memory_held().peak + t->room.beside;
}

size_t
tool_counted_memory(struct tool *t)
{
    const size_t own = tool_own_memory(t);

    return own > t->room.counted ? own : t->room.counted;
}

size_t
tool_memory_with(size_t bytes)
{
    return size_sum(bytes, rc_memory_held().held + beside());
}

const char *
tool_leaner_engine(const struct tool *t, bool periodic,
                   size_t (*bytes)(const void *ctx, const char *engine), const void *ctx)
{
    static char remedy[64];
    const struct rc_engine_info *e;
    size_t left = tool_memory_left(t);
    bool transforms = periodic || t->ranks != NULL; /* with several processes the engine must be
                                                       fft */

    for (size_t k = 0; (e = rc_engine_info(k)) != NULL; k++)
        if (e->order == 1 && (e->periodic || !transforms) && bytes(ctx, e->name) <= left) {
            snprintf(remedy, sizeof remedy, "--kernel %s needs less", e->name);
            return remedy;
        }
    return NULL;
}
