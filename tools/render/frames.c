/*
 * The frames in a picture of several: one channel, selected by lists of depths and cases.
 */
#include "render.h"

#include <string.h>

static bool
right_section(const struct frames *f, const struct rc_grid *g)
{
    const char *section = rc_grid_get(g, "section");

    return f->wish.section == NULL || (section != NULL && section[0] == f->wish.section[0]);
}

static bool
keep_beside(void *ctx, struct rc_grid *g)
{
    struct frames *f = ctx;

    if (strcmp(g->channel, CONTACT_CHANNEL) == 0 && f->contacts < FRAMES)
        f->contact[f->contacts++] = g;
    else if (f->border && strcmp(g->channel, "pressure") == 0 && f->pressures < FRAMES)
        f->pressure[f->pressures++] = g;
    else
        return false;
    return true;
}

static void
let_go(struct frames *f, struct rc_grid *g)
{
    if (!keep_beside(f, g))
        rc_grid_free(g);
}

/* Drops the kept frames of a channel with a lower preference than this one. */
static bool
prefer(struct frames *f, const struct rc_grid *g)
{
    if (f->n == 0 || strcmp(f->grid[0]->channel, g->channel) == 0)
        return true;
    if (f->wish.channel != NULL || choice_rank(g->channel) >= choice_rank(f->grid[0]->channel))
        return false;
    for (size_t k = 0; k < f->n; k++)
        let_go(f, f->grid[k]);
    f->n = f->left = 0;
    return true;
}

static struct rc_grid *
find(struct rc_grid *const *of, size_t n, const struct rc_grid *g)
{
    for (size_t k = 0; k < n && rc_grid_get(g, "section") == NULL; k++)
        if (rc_grid_case(of[k]) == rc_grid_case(g) && of[k]->nx == g->nx && of[k]->ny == g->ny &&
            strcmp(of[k]->channel, g->channel) != 0)
            return of[k];
    return NULL;
}

struct beside
frames_beside(const struct frames *f, size_t k)
{
    return (struct beside){.pressure = find(f->pressure, f->pressures, f->grid[k]),
                           .contact = find(f->contact, f->contacts, f->grid[k])};
}

void
frames_read(struct frames *f, struct tool *t)
{
    struct rc_grid *g;

    f->wanted.other = keep_beside;
    f->wanted.ctx = f;
    f->wanted.channel = f->wish.channel;
    wanted_check(&f->wanted, t);
    while ((g = wanted_read(&f->wanted, t)) != NULL) {
        if (!right_section(f, g) || !prefer(f, g)) {
            let_go(f, g);
        } else if (f->n == FRAMES) {
            f->left++;
            rc_grid_free(g);
        } else {
            f->grid[f->n++] = g;
        }
    }
    if (f->n == 0)
        tool_die(t, "%s: there is no frame%s%s to draw", t->source,
                 f->wish.section == NULL ? "" : " of a section across ",
                 f->wish.section == NULL ? "" : f->wish.section);
    if (f->left > 0)
        tool_die(t, "%zu frames match, a picture shows at most %d: choose with --depth and --case",
                 f->n + f->left, FRAMES);
    if (f->wish.channel == NULL)
        tool_note(t, "drawing %s: choose another channel with --channel", f->grid[0]->channel);
    for (size_t k = 0; k < f->n; k++) {
        struct beside beside = frames_beside(f, k);
        f->touch[k] = look_touch(t, f->grid[k], &beside, f->demands);
    }
}

void
frames_free(struct frames *f)
{
    for (size_t k = 0; k < f->n; k++)
        rc_grid_free(f->grid[k]);
    for (size_t k = 0; k < f->pressures; k++)
        rc_grid_free(f->pressure[k]);
    for (size_t k = 0; k < f->contacts; k++)
        rc_grid_free(f->contact[k]);
    f->n = f->pressures = f->contacts = 0;
}
