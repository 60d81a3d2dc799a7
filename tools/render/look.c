/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The properties of a figure of frames: words, colours, contact, and position.
 */
#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool
look_is_profile(const struct rc_grid *g)
{
    return (g->nx == 1) != (g->ny == 1) && rc_grid_get(g, "section") == NULL;
}

enum unit
look_unit(const struct rc_grid *g)
{
    return strcmp(rc_grid_dunit(g), "m") == 0 ? UNIT_M : UNIT_NONE;
}

enum rc_status
look_pair(const char *text, enum unit unit, double pair[2], struct rc_err *err)
{
    struct numbers n = {0};
    char list[256], *colon;

    if (strlen(text) >= sizeof list)
        return rc_err_set(err, "it is longer than %zu bytes", sizeof list - 1);
    strcpy(list, text);
    if ((colon = strchr(list, ':')) != NULL)
        *colon = ',';
    if (unit_numbers(list, unit, &n, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < 2; k++)
        pair[k] = n.n == 2 ? n.v[k] : NAN;
    free(n.v);
    return RC_OK;
}

const char *
look_stamp(const struct rc_grid *g)
{
    return map_says(g, "separated", "yes")  ? "separated"
           : map_says(g, "converged", "no") ? "not converged"
                                            : NULL;
}

static void
choose_range(struct tool *t, struct args *a, struct rc_grid *const *grid,
             const struct rc_grid *const *touch, size_t n, const struct survey *s,
             struct look *look, struct figure *f)
{
    struct range *r = &look->range;
    bool axis = false; /* range of the values */

    *r = (struct range){.kind = a->clip ? RANGE_CLIP : RANGE_AUTO};
    if (a->range != NULL)
        range_read(t, a->range, grid[0], r);
    range_doubt(t, "range", a->range, grid[0]->unit, s->min, s->max, r);
    axis = r->kind == RANGE_AUTO && look_is_profile(grid[0]) && !a->raw;
    range_choose(grid, touch, n, s, f->bar.map, &look->what, r);
    if (r->kind == RANGE_VALUES)
        a->range = range_text(r);
    if (a->style.log != NULL)
        range_take_logarithm(t, grid, n, r);
    f->bar.lo = axis ? NAN : r->lo;
    f->bar.hi = axis ? NAN : r->hi;
    f->bar.min = range_least(grid, touch, n, s, r);
    f->bar.log = a->style.log != NULL;
    f->bar.note = r->note[0] == '\0' ? NULL : r->note;
}

/* Category 1 has the first colour of the map, 2 the last. */
static void
set_categories(struct tool *t, const struct args *a, const struct look *look, struct figure *f)
{
    if (a->range != NULL || a->clip || a->style.log != NULL)
        tool_warn(t, "channel %s holds categories, not values: --%s does nothing", look->what.name,
                  a->range != NULL ? "range"
                  : a->clip        ? "clip"
                                   : "log");
    f->nodes.is = look->what.is;
    f->bar.lo = 1;
    f->bar.hi = 2;
    f->edge.border = true;
}

void
look_figure(struct tool *t, struct args *a, struct rc_grid *const *grid,
            const struct rc_grid *const *touch, size_t n, const struct survey *s, struct look *look,
            struct figure *f)
{
    const struct rc_grid *g = grid[0];
    bool curve = look_is_profile(g) && !a->raw;

    look->what = channel_of(g, s);
    *f = (struct figure){
        .paper = a->style.paper,
        .bar = {.quantity = look->what.axis != NULL && curve ? look->what.axis : look->what.title,
                .unit = g->unit,
                .map = colormap_find(a->colormap == NULL ? look->what.colormap : a->colormap),
                .min = s->min,
                .max = s->max},
        .at = {.dunit = rc_grid_dunit(g),
               .aspect = isnan(a->aspect) ? 0 : a->aspect,
               .exaggeration = isnan(a->exaggeration) ? 0 : a->exaggeration},
        .edge = {.contour = a->contour || a->border, .border = a->border && !a->contour},
        .nodes = {.missing = s->missing,
                  .missing_is = look->what.missing,
                  .zero_is_none = look->what.none != NULL,
                  .zeros = s->zeros,
                  .none = look->what.none},
        .hillshade = a->hillshade,
        .keep_max = a->keep != NULL && strcmp(a->keep, "max") == 0,
        .vector = canvas_format(ending_of(t->out_name)) != CANVAS_PNG,
    };
    f->paper.stamp = look_stamp(g);
    if (f->paper.title == NULL)
        f->paper.title = look->what.title;
    if (look->what.is[0] != NULL && !curve)
        set_categories(t, a, look, f);
    else
        choose_range(t, a, grid, touch, n, s, look, f);
    if (a->depths != NULL && rc_grid_get(g, "section") == NULL)
        tool_warn(t, "--depth-range is for sections: this %s has no rows of depths", g->channel);
}

static const struct rc_grid *
channel_or(const struct rc_grid *g, const char *channel, const struct rc_grid *beside)
{
    return strcmp(g->channel, channel) == 0 ? g : beside;
}

const struct rc_grid *
look_touch(struct tool *t, const struct rc_grid *g, const struct beside *beside, bool demanded)
{
    const struct rc_grid *p, *contact = channel_or(g, CONTACT_CHANNEL, beside->contact);

    if (rc_grid_get(g, "section") != NULL)
        return NULL;
    p = channel_or(g, "pressure", beside->pressure);
    return (demanded ? contact_demand : contact_frame)(t, p, contact);
}

void
look_contact(struct figure *f, const struct rc_grid *g, const struct beside *beside,
             const struct rc_grid *touch)
{
    const double rounding = 1e-9;
    const struct rc_grid *p = channel_or(g, "pressure", beside->pressure);
    double hardness, largest = 0;
    bool any = false;

    for (size_t k = 0; touch != NULL && k < touch->nx * touch->ny && !any; k++)
        any = rc_in_contact(touch->v[k]);
    for (size_t k = 0; p != NULL && k < p->nx * p->ny; k++)
        largest = fmax(largest, p->v[k]);
    f->edge.contact = any ? touch : NULL;
    f->edge.pressure = p;
    f->edge.hard = 0;
    if (largest > 0 && rc_grid_number(p, "hardness", &hardness) && hardness > 0 &&
        largest >= hardness * (1 - rounding))
        f->edge.hard = hardness * (1 - rounding);
}

void
look_extent(const struct window *w, struct figure *f)
{
    bool waves = f->at.dunit != NULL && strcmp(f->at.dunit, "rad/m") == 0;

    f->at.across = waves ? "qx" : "x";
    f->at.down = waves ? "qy" : "y";
    f->at.left = w->left;
    f->at.right = w->right;
    f->at.top = w->top;
    f->at.bottom = w->bottom;
}

void
look_aspect(struct tool *t, const struct rc_grid *g, const struct figure *f)
{
    double aspect = (f->at.right - f->at.left) / (f->at.bottom - f->at.top) / f->at.aspect;

    if (f->at.aspect > 0 && !(aspect <= FIGURE_ASPECT && aspect >= 1.0 / FIGURE_ASPECT))
        tool_die_at(
            t, g, EXIT_USAGE,
            "--aspect %.6g: the plot would be %.3g times as %s: give a value for at most %d times",
            f->at.aspect, aspect > 1 ? aspect : 1 / aspect,
            aspect > 1 ? "wide as high" : "high as wide", FIGURE_ASPECT);
}

bool
look_throat(const struct rc_grid *g, struct figure *f)
{
    return rc_grid_number(g, "throat_x", &f->mark.x) && rc_grid_number(g, "throat_y", &f->mark.y) &&
           f->mark.x >= f->at.left && f->mark.x <= f->at.right && f->mark.y >= f->at.top &&
           f->mark.y <= f->at.bottom;
}

struct rc_grid *
look_section(struct tool *t, const struct args *a, const struct rc_grid *g, struct figure *f)
{
    RC_OWNED double *depth = section_depths(t, g);
    struct layers layers;
    struct rc_grid *even;

    tool_must(t, g, layers_read(g, &layers, &t->err));
    media_set(t, &layers, f);
    section_range(t, a->depths, g, depth, &f->at.top, &f->at.bottom);
    f->at.across = strcmp(rc_grid_get(g, "section"), "x") == 0 ? "y" : "x";
    f->at.down = "depth";
    f->at.section = true;
    even = section_even(t, g, depth, &layers, f->at.top, f->at.bottom);
    layers_free(&layers);
    return even;
}
