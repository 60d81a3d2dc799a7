/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Several maps in one picture: number of columns and rows, common properties, titles of the panels.
 */
#include "render.h"

#include <math.h>
#include <string.h>

void
sheet_size(struct tool *t, const char *text, size_t *columns, size_t *rows)
{
    double value[2] = {0, 0};
    const char *end = rc_number_read(text, false, &value[0]);

    *columns = *rows = 0;
    if (strcmp(text, "auto") == 0)
        return;
    if (end != NULL && *end == 'x')
        end = rc_number_read(end + 1, false, &value[1]);
    else
        end = NULL;
    for (int k = 0; k < 2; k++)
        if (end == NULL || *end != '\0' || !(value[k] >= 1 && value[k] <= FRAMES) ||
            value[k] != floor(value[k]))
            tool_usage(t, "--sheet %s: it must be COLSxROWS, as in 3x2, or auto", text);
    *columns = (size_t)value[0];
    *rows = (size_t)value[1];
}

void
sheet_check_alike(struct tool *t, const struct rc_grid *first, const struct figure *of_first,
                  const struct rc_grid *g, const struct figure *f)
{
    double size = fabs(of_first->at.right - of_first->at.left),
           high = of_first->at.bottom - of_first->at.top;

    if ((g->nx == 1) != (g->ny == 1) && rc_grid_get(g, "section") == NULL)
        tool_refuse(t, g, "a profile is not a map: draw several as curves, with --cut y=0");
    if (strcmp(first->unit, g->unit) != 0 || strcmp(f->at.down, of_first->at.down) != 0 ||
        strcmp(f->at.across, of_first->at.across) != 0 ||
        fabs(f->at.right - f->at.left - size) > 1e-6 * size ||
        fabs(f->at.bottom - f->at.top - high) > 1e-6 * high)
        tool_refuse(t, g,
                    "it is not of the size of the frame before: a sheet shows maps of one size: "
                    "choose with --case and --depth");
}

void
sheet_survey(struct tool *t, const struct frames *frames, struct survey *all)
{
    for (size_t k = 0; k < frames->n; k++) {
        struct survey s;

        survey_map(frames->grid[k], &s);
        if (isnan(s.min))
            tool_refuse(t, frames->grid[k],
                        "none of its %zu values is a finite number: there is nothing to draw",
                        frames->grid[k]->nx * frames->grid[k]->ny);
        if (k == 0) {
            *all = s;
            continue;
        }
        all->min = fmin(all->min, s.min);
        all->max = fmax(all->max, s.max);
        all->missing += s.missing;
        all->zeros += s.zeros;
    }
}

void
sheet_label(struct panel *panel, const struct frames *frames, size_t k)
{
    char what[200];

    frame_label(what, sizeof what, frames->grid, frames->n, k);
    snprintf(panel->label, sizeof panel->label, "%s%c) %s",
             k < 26   ? ""
             : k < 52 ? "a"
                      : "b",
             (char)('a' + k % 26), what);
}
