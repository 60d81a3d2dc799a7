/*
 * What a tool demands of the memory before it begins to work.
 */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "libcontact/contact.h"
#include "tools/machine/machine.h"
#include "tool.h"

enum {
    LATER = 5 << 16,     /* code and libraries that are not yet in memory, stacks of threads */
    UNSEEN = 16 << 20,   /* taken without asking the system, which takes longer than a small map */
    FEW_BYTES = 1 << 20, /* for which the system is not asked */
};

static const char smaller[] =
    "cut a part out with rc-pick --crop, or take fewer nodes with rc-pick --resample";

/* ---- the budget ---- */

void
tool_budget(struct tool *t)
{
    const size_t held = rc_memory_held().held, resident = memory_held();
    const struct memory_room room = memory_room("");
    double most = (double)held + room.bytes;

    if (t->beside == 0)
        t->beside = LATER + (resident > held ? resident - held : 0);
    t->bound = room.why;
    if (t->memory != 0 && (double)t->memory - (double)t->beside < most) {
        most = (double)t->memory - (double)t->beside;
        t->bound = "--memory allows";
    }
    t->budget = unit_size(fmax(most, 1));
    rc_memory_budget(t->budget);
    t->budget_at = tool_now();
}

void
tool_add_refusal(const struct tool *t, const struct rc_grid *g, char *text, size_t size)
{
    const size_t refused = rc_memory_held().refused;
    char need[SHOWN_NUMBER], allowed[SHOWN_NUMBER], what[64] = "out of memory: the work needs";

    if (refused == 0 || strstr(text, "out of memory") == NULL)
        return;
    if (g != NULL)
        snprintf(what, sizeof what, "%zu x %zu nodes need", g->nx, g->ny);
    snprintf(text, size, "%s about %s, %s %s: %s", what,
             shown_bytes(need, (double)size_sum(refused, t->beside)), t->bound,
             t->memory != 0 && strcmp(t->bound, "--memory allows") == 0
                 ? shown_bytes(allowed, (double)t->memory)
                 : shown_bytes(allowed, (double)size_sum(t->budget, t->beside)),
             t->remedy == NULL ? smaller : t->remedy);
}

void
tool_demand_memory(struct tool *t, const struct rc_grid *g, size_t bytes)
{
    if (!rc_memory_ask(bytes))
        tool_die_at(t, g, EXIT_IMPOSSIBLE, "out of memory for %zu x %zu nodes", g->nx, g->ny);
}

size_t
tool_counted_memory(const struct tool *t)
{
    return rc_memory_held().peak + t->beside;
}

/* ---- estimates ---- */

size_t
tool_memory_with(size_t bytes)
{
    size_t held = memory_held(), peak = memory_peak();
    size_t with = size_sum(bytes, held + LATER);

    return with > peak ? with : peak;
}

size_t
tool_code(const struct tool *t, size_t bytes)
{
    return bytes > t->code_memory ? bytes - t->code_memory : 0;
}

void
tool_code_there(struct tool *t, size_t bytes)
{
    t->code_memory = bytes > t->code_memory ? bytes : t->code_memory;
}

size_t
tool_memory_left(const struct tool *t)
{
    double left = memory_room("").bytes, held = (double)memory_held() + LATER;

    if (t->memory != 0)
        left = fmin(left, fmax((double)t->memory - held, 1));
    return unit_size(left);
}

const char *
tool_leaner_engine(const struct tool *t, bool periodic,
                   size_t (*bytes)(const void *ctx, const char *engine), const void *ctx)
{
    static char remedy[64];
    const struct rc_engine_info *e;
    size_t left = tool_memory_left(t);
    bool transforms = periodic || t->ranks != NULL; /* several processes share no other sums */

    for (size_t k = 0; (e = rc_engine_info(k)) != NULL; k++)
        if (e->order == 1 && (e->periodic || !transforms) && bytes(ctx, e->name) <= left) {
            snprintf(remedy, sizeof remedy, "--kernel %s needs less", e->name);
            return remedy;
        }
    return NULL;
}

enum rc_status
tool_ask_memory(struct tool *t, const struct rc_shape *shape, size_t bytes, const char *remedy,
                struct rc_err *err)
{
    size_t with;
    char need[SHOWN_NUMBER], allowed[SHOWN_NUMBER], what[64];
    struct memory_room room;

    if (bytes >= FEW_BYTES) /* what earlier maps left is not held any more */
        memory_give_back();
    with = tool_memory_with(bytes);
    if (remedy == NULL)
        remedy = smaller;
    if (shape == NULL)
        snprintf(what, sizeof what, "the curves");
    else
        snprintf(what, sizeof what, "%zu x %zu nodes", shape->nx, shape->ny);
    if (t->memory != 0 && with > t->memory)
        return rc_err_set(err, "%s need about %s, --memory allows %s: %s", what,
                          shown_bytes(need, (double)with), shown_bytes(allowed, (double)t->memory),
                          remedy);
    t->unseen_memory = size_sum(t->unseen_memory, bytes);
    if (t->unseen_memory < UNSEEN && bytes < FEW_BYTES)
        return RC_OK;
    t->unseen_memory = 0;
    room = memory_room("");
    if ((double)bytes <= room.bytes)
        return RC_OK;
    return rc_err_set(err, "%s need about %s more, %s %s: %s", what,
                      shown_bytes(need, (double)bytes), room.why, shown_bytes(allowed, room.bytes),
                      remedy);
}

void
tool_demand_memory_or(struct tool *t, const struct rc_grid *g, size_t bytes, const char *remedy)
{
    struct rc_shape shape = rc_grid_shape(g);
    struct rc_err err;

    if (tool_ask_memory(t, &shape, bytes, remedy, &err) != RC_OK)
        tool_die_at(t, g, EXIT_IMPOSSIBLE, "%s", err.text);
}
