/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The plastic strain that follows the pressure in a case, as rc-solve --yield writes it. For each slab, from
 * the surface down, it has exx eyy exy exz eyz, and peeq, which causes no stress.
 */
#include "stress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    PARTS = 5
};
static const char *const names[PARTS] = {"exx", "eyy", "exy", "exz", "eyz"};

static void
keep(struct tool *t, struct stress_strain *s, struct rc_grid *g, size_t part)
{
    size_t k = s->maps++;
    double thickness;

    if (k % PARTS != part || k / PARTS >= s->slabs)
        tool_refuse(
            t, g,
            "plastic strain comes slab by slab, exx eyy exy exz eyz in that order, %zu slabs: "
            "take the stream as rc-solve has written it",
            s->slabs);
    if (!rc_grid_number(g, "thickness", &thickness) || !(thickness > 0) || isinf(thickness))
        tool_refuse(t, g, "its key thickness is not a length above 0");
    tool_demand_finite(t, g, "recompute the map");
    s->thickness[k / PARTS] = thickness;
    s->frame[k] = g;
    s->map[k] = g->v;
}

/* Allocates the strain when a key of the pressure announces it. */
static bool
begin(struct tool *t, const struct rc_grid *p, struct stress_strain *s)
{
    double number;

    if (s->thickness != NULL)
        return true;
    if (!rc_grid_number(p, "slabs", &number))
        return false;
    if (!(number >= 1) || number > 1e4 || number != floor(number))
        tool_refuse(t, p, "its key slabs is %g: it must be a whole number", number);
    s->slabs = (size_t)number;
    s->thickness = tool_room(t, s->slabs, sizeof *s->thickness, "the strain of slabs");
    s->frame = tool_room(t, s->slabs * PARTS, sizeof *s->frame, "the strain of slabs");
    s->map = tool_room(t, s->slabs * PARTS, sizeof *s->map, "the strain of slabs");
    return true;
}

bool
stress_strain_take(struct tool *t, const struct rc_grid *p, struct rc_grid *g,
                   struct stress_strain *s)
{
    size_t part = 0;

    while (part < PARTS && strcmp(g->channel, names[part]) != 0)
        part++;
    if (part == PARTS)
        return false;
    if (!begin(t, p, s))
        tool_refuse(
            t, g,
            "the pressure before this plastic strain has no key slabs, so it belongs to another "
            "body: take the stream as rc-solve has written it");
    tool_demand_grid_of(t, g, p);
    keep(t, s, g, part);
    return true;
}

bool
stress_strain_whole(struct tool *t, const struct rc_grid *p, struct stress_strain *s)
{
    if (!begin(t, p, s))
        return false;
    if (s->maps != s->slabs * PARTS) {
        tool_warn(
            t,
            "%s: the body has yielded inside, and %s of its strain in the stream: these are the "
            "stresses of the pressure alone: see rc-solve --output strain",
            tool_where(t, p), s->maps == 0 ? "nothing" : "only a part");
        return false;
    }
    s->strain = (struct rc_eigenstrain){
        .slabs = s->slabs, .thickness = s->thickness, .map = (const double *const *)s->map};
    return true;
}

void
stress_strain_free(struct stress_strain *s)
{
    for (size_t k = 0; k < s->maps; k++)
        rc_grid_free(s->frame[k]);
    free(s->thickness);
    free(s->frame);
    free(s->map);
    *s = (struct stress_strain){0};
}

/* The middles of the slabs, and a few depths below, with steps that grow like the thickness of the slabs. */
double *
stress_strain_depths(const struct stress_strain *s, size_t *n)
{
    enum {
        BELOW = 2
    };
    size_t slabs = s->strain.slabs;
    double *depth = malloc((slabs + BELOW) * sizeof *depth), z = 0, step;

    if (depth == NULL)
        return NULL;
    for (size_t k = 0; k < slabs; k++) {
        depth[k] = z + s->thickness[k] / 2;
        z += s->thickness[k];
    }
    step = s->thickness[slabs - 1];
    for (size_t k = 0; k < BELOW; k++, step *= 1.25) {
        depth[slabs + k] = z + step / 2;
        z += step;
    }
    *n = slabs + BELOW;
    return depth;
}
