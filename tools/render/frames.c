/*
 * The frames that a picture of several shows: of one channel, by lists of depths and cases.
 */
#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool
right_section(const struct frames *f, const struct rc_grid *g)
{
    const char *section = rc_grid_get(g, "section");

    return f->wish.section == NULL || (section != NULL && section[0] == f->wish.section[0]);
}

/* Drops what was kept of a channel that comes after this one in the order of preference. */
static bool
prefer(struct frames *f, const struct rc_grid *g)
{
    if (f->n == 0 || strcmp(f->grid[0]->channel, g->channel) == 0)
        return true;
    if (f->wish.channel != NULL || choice_rank(g->channel) >= choice_rank(f->grid[0]->channel))
        return false;
    for (size_t k = 0; k < f->n; k++)
        rc_grid_free(f->grid[k]);
    f->n = f->left = 0;
    return true;
}

static bool
keep_pressure(void *ctx, struct rc_grid *g)
{
    struct frames *f = ctx;

    if (strcmp(g->channel, "pressure") != 0 || f->pressures == FRAMES)
        return false;
    f->pressure[f->pressures++] = g;
    return true;
}

struct rc_grid *
frames_pressure(const struct frames *f, size_t k)
{
    const struct rc_grid *g = f->grid[k];

    if (strcmp(g->channel, "pressure") == 0)
        return f->grid[k];
    for (size_t p = 0; p < f->pressures; p++)
        if (rc_grid_case(f->pressure[p]) == rc_grid_case(g) && f->pressure[p]->nx == g->nx &&
            f->pressure[p]->ny == g->ny && rc_grid_get(g, "section") == NULL)
            return f->pressure[p];
    return NULL;
}

void
frames_read(struct frames *f, struct tool *t)
{
    struct rc_grid *g;

    if (f->border) {
        f->wanted.other = keep_pressure;
        f->wanted.ctx = f;
    }
    f->wanted.channel = f->wish.channel;
    wanted_check(&f->wanted, t);
    while ((g = wanted_read(&f->wanted, t)) != NULL) {
        if (!right_section(f, g) || !prefer(f, g)) {
            rc_grid_free(g);
        } else if (f->n == FRAMES) {
            f->left++;
            rc_grid_free(g);
        } else {
            f->grid[f->n++] = g;
        }
    }
    if (f->n == 0)
        tool_die(t, EXIT_IMPOSSIBLE, "%s: there is no frame%s%s to draw", t->source,
                 f->wish.section == NULL ? "" : " of a section across ",
                 f->wish.section == NULL ? "" : f->wish.section);
    if (f->left > 0)
        tool_die(t, EXIT_IMPOSSIBLE,
                 "%zu frames match, a picture shows at most %d: choose with --depth and --case",
                 f->n + f->left, FRAMES);
    if (f->wish.channel == NULL)
        tool_note(t, "drawing %s: choose another channel with --channel", f->grid[0]->channel);
}

void
frames_free(struct frames *f)
{
    for (size_t k = 0; k < f->n; k++)
        rc_grid_free(f->grid[k]);
    for (size_t k = 0; k < f->pressures; k++)
        rc_grid_free(f->pressure[k]);
    f->n = f->pressures = 0;
}
