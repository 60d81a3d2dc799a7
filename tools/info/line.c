/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Profiles of a map and their parameters. The profiles are all rows, all columns, or one line at any angle.
 */
#include "info.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE (INFO_2PI / 360)

/* ---- the line asked for ---- */

static void
read_place(struct tool *t, const char *along, const char *text, struct rc_place *place)
{
    char copy[256], *comma;
    struct rc_err err;

    snprintf(copy, sizeof copy, "%s", text);
    if ((comma = strchr(copy, ',')) != NULL)
        *comma = '\0';
    if (comma == NULL || unit_number(copy, UNIT_M, &place->x, &err) != RC_OK ||
        unit_number(comma + 1, UNIT_M, &place->y, &err) != RC_OK)
        tool_usage(t,
                   "--profile %s: it must be rows, columns, an angle in degrees, or X0,Y0:X1,Y1, "
                   "places from the middle of "
                   "the map, y down",
                   along);
}

void
info_line_read(struct tool *t, const char *along, struct info_line_wanted *w)
{
    char copy[256], *colon;
    struct rc_err err;

    *w = (struct info_line_wanted){.along = along};
    if (along == NULL)
        return;
    w->rows = strcmp(along, "rows") == 0;
    w->columns = strcmp(along, "columns") == 0;
    if (w->rows || w->columns)
        return;
    w->angle = NAN;
    snprintf(copy, sizeof copy, "%s", along);
    if ((colon = strchr(copy, ':')) == NULL &&
        unit_number(copy, UNIT_NONE, &w->angle, &err) == RC_OK)
        return;
    if (colon != NULL)
        *colon = '\0';
    read_place(t, along, copy, &w->from);
    read_place(t, along, colon == NULL ? "" : colon + 1, &w->to);
    if (w->from.x == w->to.x && w->from.y == w->to.y)
        tool_usage(t, "--profile %s: the line has no length", along);
}

/* The line through the middle at this angle, as long as the map allows. */
static void
set_ends(const struct rc_shape *s, struct info_line_wanted *w)
{
    double x = cos(w->angle * DEGREE), y = -sin(w->angle * DEGREE), reach;

    x = fabs(x) < 1e-15 ? 0 : x;
    y = fabs(y) < 1e-15 ? 0 : y;
    reach = fmin(x == 0 ? INFINITY : 0.5 * (double)(s->nx - 1) * s->dx / fabs(x),
                 y == 0 ? INFINITY : 0.5 * (double)(s->ny - 1) * s->dy / fabs(y));
    w->from = (struct rc_place){-reach * x, -reach * y};
    w->to = (struct rc_place){reach * x, reach * y};
}

static bool
is_within(const struct rc_shape *s, struct rc_place p)
{
    const double slack = 1 + 1e-9;

    return fabs(p.x) <= 0.5 * (double)(s->nx - 1) * s->dx * slack &&
           fabs(p.y) <= 0.5 * (double)(s->ny - 1) * s->dy * slack;
}

/* ---- parameters of several lines ---- */

static double *
field(struct rc_profile *p, const struct rc_figure *which)
{
    return (double *)(void *)((char *)p + which->at);
}

/* Means over the lines with a value, and their standard deviations (n - 1). */
static void
average(const struct rc_profile *line, size_t lines, struct info_profile *to)
{
    for (const struct rc_figure *p = rc_figures("profile"); p->name != NULL; p++) {
        double sum = 0, squares = 0, n = 0, mean;

        for (size_t k = 0; k < lines; k++)
            if (!isnan(rc_figure_number(p, &line[k]))) {
                sum += rc_figure_number(p, &line[k]);
                n++;
            }
        mean = sum / n;
        for (size_t k = 0; k < lines; k++)
            if (!isnan(rc_figure_number(p, &line[k])))
                squares += pow(rc_figure_number(p, &line[k]) - mean, 2);
        *field(&to->mean, p) = mean;
        *field(&to->deviation, p) = n > 1 ? sqrt(squares / (n - 1)) : NAN;
    }
    for (size_t k = 0; k < lines; k++)
        to->elements += line[k].elements;
}

static void
demand_points(struct tool *t, const struct rc_grid *g, const struct info_line_wanted *w, size_t n,
              size_t sections)
{
    if (n < sections || n < 2)
        tool_refuse(
            t, g,
            "--profile %s: a profile of %zu points has no %zu sections: give fewer --sections",
            w->along, n, sections);
}

static void
measure_rows(struct tool *t, const struct rc_grid *g, const struct info_line_wanted *w,
             size_t sections, struct info_profile *to)
{
    size_t n = w->rows ? g->nx : g->ny, lines = w->rows ? g->ny : g->nx;
    double *z = tool_room(t, n, sizeof *z, "a profile"), step = w->rows ? g->dx : g->dy;
    struct rc_profile *line;

    demand_points(t, g, w, n, sections);
    line = tool_room(t, lines, sizeof *line, "the figures of the profiles");
    for (size_t k = 0; k < lines; k++) {
        struct rc_err err;

        for (size_t i = 0; i < n; i++)
            z[i] = w->rows ? g->v[k * g->nx + i] : g->v[i * g->nx + k];
        if (rc_profile_measure(n, step, z, sections, &line[to->lines], &err) == RC_OK)
            to->lines++;
    }
    if (to->lines == 0)
        tool_refuse(t, g,
                    "--profile %s: all of them have missing points: fill them first, with "
                    "rc-detrend --fill",
                    w->along);
    to->skipped = lines - to->lines;
    to->points = n;
    to->length = (double)n * step;
    average(line, to->lines, to);
    free(line);
    free(z);
}

void
info_line_measure(struct tool *t, const struct rc_grid *g, const struct info_line_wanted *wanted,
                  size_t sections, struct info_profile *to)
{
    const struct rc_shape shape = rc_grid_shape(g);
    struct info_line_wanted w = *wanted;
    struct rc_profile line;
    double length, *z;

    *to = (struct info_profile){.sections = sections};
    if (w.rows || w.columns) {
        measure_rows(t, g, &w, sections, to);
        return;
    }
    if (!isnan(w.angle))
        set_ends(&shape, &w);
    else if (!is_within(&shape, w.from) || !is_within(&shape, w.to))
        tool_refuse(
            t, g,
            "--profile %s: the line leaves the map, whose nodes reach %g m by %g m from its middle",
            w.along, 0.5 * (double)(g->nx - 1) * g->dx, 0.5 * (double)(g->ny - 1) * g->dy);
    length = hypot(w.to.x - w.from.x, w.to.y - w.from.y);
    to->points = (size_t)floor(length / fmin(g->dx, g->dy) * (1 + 1e-12)) + 1;
    demand_points(t, g, &w, to->points, sections);
    z = tool_room(t, to->points, sizeof *z, "a profile");
    rc_profile_along(&shape, g->v, w.from, w.to, to->points, z);
    if (rc_profile_measure(to->points, length / (double)(to->points - 1), z, sections, &line,
                           &t->err) != RC_OK)
        tool_refuse(t, g, "--profile %s: %s: fill the map first, with rc-detrend --fill", w.along,
                    t->err.text);
    to->lines = 1;
    to->length = length;
    average(&line, 1, to);
    free(z);
}
