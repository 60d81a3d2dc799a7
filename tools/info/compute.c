/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "info.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- parameters and kinds of frames ---- */

static bool
is(const struct rc_grid *g, const char *channel)
{
    return strcmp(g->channel, channel) == 0;
}

void
info_check(struct info_wanted *w, struct tool *t)
{
    if (w->fit.n != 0 && (w->fit.n != 2 || !(w->fit.v[0] > 0 && w->fit.v[1] > w->fit.v[0])))
        tool_usage(t, "--fit takes two wavelengths, the shortest first: --fit 2um,50um");
    if (w->smr.n > INFO_HEIGHTS)
        tool_usage(t, "--smr: it takes %d heights at most", INFO_HEIGHTS);
    for (size_t k = 0; k < w->smr.n; k++) {
        snprintf(w->smr_name[k], sizeof w->smr_name[k], "smr_%s", rc_number(w->smr.v[k]));
    }
    w->areal = w->areal || w->smr.n > 0;
    info_line_read(t, w->profile, &w->line);
    report_open(&w->out, t, w->report);
    w->psd = w->psd || w->fit.n != 0 || w->window != NULL || w->psd_map != NULL;
    if (w->psd_map != NULL)
        w->file = info_file_new(t, "--psd-map", w->psd_map);
}

void
info_end(struct info_wanted *w, struct tool *t)
{
    report_close(&w->out);
    if ((w->areal || w->psd || w->profile != NULL) && !w->height)
        tool_die(t, "%s is of heights, and no frame is a height; there is: %s",
                 w->areal ? "--areal"
                 : w->psd ? "--psd"
                          : "--profile",
                 name_list_end(&w->present));
    if (w->patches && !w->pressure)
        tool_die(t, "--patches is of pressures, and no frame is a pressure; there is: %s",
                 name_list_end(&w->present));
    if (w->file != NULL)
        info_file_end(w->file);
}

/* ---- figures ---- */

/* The fraction of the measured points at or above this height. */
static void
find_smr(const struct info_wanted *w, const struct rc_grid *g, struct info_figures *f)
{
    struct rc_statistics s;

    rc_measure(rc_shape_of(g), g->v, &s);
    for (size_t c = 0; c < w->smr.n; c++) {
        size_t above = 0, there = 0;

        for (size_t k = 0; k < rc_grid_nodes(g); k++) {
            there += isfinite(g->v[k]) ? 1 : 0;
            above += isfinite(g->v[k]) && g->v[k] - s.mean >= w->smr.v[c] ? 1 : 0;
        }
        f->smr[c] = there > 0 ? (double)above / (double)there : NAN;
    }
}

static void
find_areal(const struct info_wanted *w, struct tool *t, const struct rc_grid *g,
           struct info_figures *f)
{
    const struct rc_surface_options options = {.boundary = map_boundary(g), .threads = t->threads};
    const struct rc_shape shape = rc_grid_shape(g);

    f->areal = tool_room(t, 1, sizeof *f->areal, "the parameters of a map");
    tool_must(t, g, rc_areal(&shape, g->v, &options, f->areal, &t->err));
    find_smr(w, g, f);
    if (g->nx == 1 || g->ny == 1)
        return;
    f->features = tool_room(t, 1, sizeof *f->features, "the features of a map");
    tool_must(t, g, rc_features(&shape, g->v, &options, f->features, &t->err));
}

/* The spectrum as a frame, whose spacings are steps of wave numbers. */
static struct rc_grid *
map_frame(struct info_wanted *w, struct tool *t, const struct rc_grid *g)
{
    bool row = g->ny == 1, column = g->nx == 1;
    char step[64];
    struct rc_grid *map = tool_frame_like(t, g, NULL, "psd", row || column ? "m3" : "m4");
    map->dx = INFO_2PI / ((double)g->nx * g->dx);
    map->dy = INFO_2PI / ((double)g->ny * g->dy);
    if (row)
        map->dy = map->dx;
    if (column)
        map->dx = map->dy;
    snprintf(step, sizeof step, "rc-info %s --psd-map%s%s", rc_version(),
             w->window != NULL ? " --window " : "", w->window != NULL ? w->window : "");
    tool_set(t, map, "periodic", NULL);
    tool_set(t, map, "dunit", "rad/m");
    tool_must(t, g, rc_grid_history(map, step, &t->err));
    return map;
}

static void
find_psd(struct info_wanted *w, struct tool *t, const struct rc_grid *g, struct info_figures *f)
{
    struct rc_psd_options options = {
        .boundary = map_boundary(g), .window = w->window, .threads = t->threads};
    struct rc_grid *map = NULL;

    tool_demand_finite(t, g, "fill them first, with rc-detrend --fill");
    if (w->fit.n == 2) {
        options.shortest = w->fit.v[0];
        options.longest = w->fit.v[1];
    }
    if (w->file != NULL) {
        map = map_frame(w, t, g);
        options.map = map->v;
    }
    f->psd = tool_made(t, g, rc_psd_new(rc_shape_of(g), g->v, &options, &t->err));
    if (map != NULL) {
        tool_must(t, g, rc_grid_set(map, "window", f->psd->window, &t->err));
        info_file_put(w->file, map);
    }
    rc_grid_free(map);
}

/* The histogram of the pressures in contact, in bins of equal width from 0, or the smallest pressure if it is
 * negative, to the largest. */
static void
count_pressures(struct tool *t, const struct rc_grid *g, const double *touch,
                struct info_figures *f)
{
    double largest = 0, least = 0;

    for (size_t k = 0; k < g->nx * g->ny; k++)
        if (rc_in_contact(touch[k])) {
            largest = fmax(largest, g->v[k]);
            least = fmin(least, g->v[k]);
        }
    if (largest == least)
        return;
    f->edges = tool_room(t, INFO_BINS + 1, sizeof *f->edges, "a histogram");
    f->counts = tool_room(t, INFO_BINS, sizeof *f->counts, "a histogram");
    for (size_t b = 0; b <= INFO_BINS; b++)
        f->edges[b] = least + (largest - least) * ((double)b / INFO_BINS);
    for (size_t k = 0; k < g->nx * g->ny; k++)
        if (rc_in_contact(touch[k])) {
            size_t b = (size_t)((g->v[k] - least) / (largest - least) * INFO_BINS);
            b = b < INFO_BINS ? b : INFO_BINS - 1; /* the largest itself */
            f->counts[b]++;
        }
}

static void
find_patches(struct tool *t, const struct rc_grid *g, const double *touch, struct info_figures *f)
{
    const struct rc_patch_options options = {
        .boundary = map_boundary(g), .largest = SIZE_MAX, .threads = t->threads};

    tool_demand_finite(t, g, "solve the contact again");
    f->patches = tool_room(t, 1, sizeof *f->patches, "the patches of a contact");
    tool_must(t, g, rc_patches_find(rc_shape_of(g), touch, &options, f->patches, &t->err));
    count_pressures(t, g, touch, f);
}

void
info_compute(struct info_wanted *w, struct tool *t, const struct rc_grid *g,
             const struct rc_grid *touch, struct info_figures *f)
{
    bool height = is(g, "height"), pressure = is(g, "pressure");

    *f = (struct info_figures){.grid = g, .touch = touch};
    name_list_add(&w->present, g->channel);
    w->height = w->height || height;
    w->pressure = w->pressure || pressure;
    if (((w->areal || w->psd || w->profile != NULL) && height) || (w->patches && pressure))
        tool_demand_lengths(t, g);
    if (w->areal && height)
        find_areal(w, t, g, f);
    if (w->profile != NULL && height) {
        f->profile = tool_room(t, 1, sizeof *f->profile, "a profile");
        info_line_measure(t, g, &w->line, w->sections, f->profile);
    }
    if (w->psd && height)
        find_psd(w, t, g, f);
    if (w->patches && pressure)
        find_patches(t, g, touch != NULL ? touch->v : g->v, f);
}

void
info_free(struct info_figures *f)
{
    free(f->areal);
    free(f->features);
    free(f->profile);
    rc_psd_free(f->psd);
    if (f->patches != NULL)
        rc_patches_free(f->patches);
    free(f->patches);
    free(f->edges);
    free(f->counts);
    *f = (struct info_figures){0};
}
