/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Texts of a figure that the command line replaces.
 */
#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *
wording_subtitle(const struct paper *given, const char *own)
{
    if (given->subtitle != NULL)
        return given->subtitle;
    return given->title != NULL && *given->title == '\0' ? "" : own;
}

bool
wording_log(const struct curve_style *s, char axis)
{
    return s->log != NULL && (s->log[0] == '\0' || strchr(s->log, axis) != NULL);
}

/* ---- axes ---- */

/* The unit of an axis in a message; empty for plain numbers. */
static const char *
unit_of_axis(const struct graph_axis *axis)
{
    return strcmp(axis->unit, "1") == 0 ? "" : axis->unit;
}

/* Reads the first n bytes of a text, a number with or without a unit of the axis, in SI. */
static bool
read_end(const char *text, size_t n, const char *unit, double *value, bool *has_unit)
{
    char number[64], own[64];
    struct scale scale = {.size = 1};
    struct rc_err err;
    char *end;

    if (n == 0 || n >= sizeof number)
        return false;
    memcpy(number, text, n);
    number[n] = '\0';
    strtod(number, &end);
    snprintf(own, sizeof own, "%s", end);
    *end = '\0';
    *has_unit = *own != '\0';
    if (unit_number(number, UNIT_NONE, value, &err) != RC_OK ||
        (*has_unit && !scale_given(&scale, own, *unit == '\0' ? "1" : unit)))
        return false;
    *value *= scale.size;
    return true;
}

/* The smallest and the largest coordinate of the points along an axis. */
static void
find_extremes(const struct graph *graph, char which, double *min, double *max)
{
    *min = INFINITY;
    *max = -INFINITY;
    for (size_t s = 0; s < graph->n; s++) {
        const struct graph_series *q = &graph->series[s];
        const double *v = which == 'x' ? q->x : q->y;

        for (size_t k = 0; k < q->n; k++)
            if (isfinite(q->x[k]) && isfinite(q->y[k])) {
                *min = fmin(*min, v[k]);
                *max = fmax(*max, v[k]);
            }
    }
}

/* The ends of an axis, LO:HI. A small part of a curve causes no warning. */
static void
set_range(struct tool *t, const char *text, char which, const struct graph *graph,
          struct graph_axis *axis)
{
    const size_t n = strcspn(text, ":,");
    const char *unit = unit_of_axis(axis);
    const char option[] = {which, '-', 'r', 'a', 'n', 'g', 'e', '\0'};
    struct range r = {.kind = RANGE_VALUES};
    bool has_unit[2];
    double min, max;

    if (axis->words > 0)
        tool_usage(t, "--%s: the axis has words, which have no range: leave it out", option);
    if (text[n] == '\0' || !read_end(text, n, axis->unit, &r.lo, &has_unit[0]) ||
        !read_end(text + n + 1, strlen(text + n + 1), axis->unit, &r.hi, &has_unit[1]) ||
        !(r.lo < r.hi))
        tool_usage(t, "--%s %s: it must be LO:HI, two values with LO below HI, %s%s%s", option,
                   text, *unit == '\0' ? "as plain numbers or in %" : "in ", unit,
                   *unit == '\0' ? "" : " with or without a prefix");
    if (has_unit[0] != has_unit[1] && r.lo != 0 && r.hi != 0)
        tool_usage(t, "--%s %s: give both values their unit, or neither", option, text);
    if (axis->log && !(r.lo > 0))
        tool_usage(t, "--log has no place for 0 and below: give a --%s above it", option);
    find_extremes(graph, which, &min, &max);
    if (r.hi < min || r.lo > max || (!axis->log && max - min < 1e-3 * (r.hi - r.lo)))
        range_doubt(t, option, text, unit, min, max, &r);
    axis->lo = r.lo;
    axis->hi = r.hi;
}

/* Ends the tool if the unit does not fit the quantity. */
static void
set_axis(struct tool *t, const struct curve_style *s, char which, const struct graph *graph,
         struct graph_axis *axis)
{
    const char *text = which == 'x' ? s->x_label : s->y_label;
    const char *range = which == 'x' ? s->x_range : s->y_range;
    const bool plain = *unit_of_axis(axis) == '\0';
    struct scale scale;

    axis->log = wording_log(s, which);
    axis->shown = which == 'x' ? s->x_unit : s->y_unit;
    if (text != NULL)
        axis->quantity = text;
    if (axis->shown != NULL && !scale_given(&scale, axis->shown, axis->unit))
        tool_usage(t, "--%c-unit %s: the axis is in %s: it must be %s", which, axis->shown,
                   plain ? "plain numbers" : axis->unit,
                   plain ? "1 or %" : "that unit, with or without a prefix");
    if (range != NULL)
        set_range(t, range, which, graph, axis);
}

/* ---- names ---- */

/* The existing names; a single curve without a name can get one. */
static size_t
names_there(const struct graph_series *series, size_t n)
{
    size_t names = 0;

    for (size_t k = 0; k < n; k++)
        names += series[k].name != NULL;
    return names;
}

/* Names of curves, in *text; ends the tool if their number differs from that of the legend. */
static void
set_names(struct tool *t, char *text, struct graph_series *series, size_t n)
{
    size_t names = names_there(series, n), given = 1, k = 0;
    bool alone = names == 0;
    char *at = text;

    if (*text != '\0') {
        for (const char *c = text; *c != '\0'; c++)
            given += *c == ';';
        if (given != (alone ? 1 : names))
            tool_usage(t,
                       "--legend: %zu text%s for %zu curve%s of the legend: give one each, in its "
                       "order, separated by ';', or none at all",
                       given, given == 1 ? "" : "s", alone ? 1 : names,
                       alone || names == 1 ? "" : "s");
    }
    for (; k < n; k++) {
        if (series[k].name == NULL && !(alone && k == 0))
            continue;
        if (at == NULL || *at == '\0' || *at == ';') {
            series[k].name = NULL;
            at = at != NULL && *at == ';' ? at + 1 : at;
            continue;
        }
        series[k].name = at;
        if ((at = strchr(at, ';')) != NULL)
            *at++ = '\0';
    }
}

/* Series of one name get one look, and one entry in the legend. */
static void
join_names(struct graph_series *series, size_t n)
{
    for (size_t k = 1; k < n; k++)
        for (size_t i = 0; i < k; i++)
            if (series[k].name != NULL && series[i].name != NULL &&
                series[k].kind == series[i].kind && strcmp(series[k].name, series[i].name) == 0) {
                series[k].place = series[i].place;
                series[k].mark = series[i].mark;
                break;
            }
}

struct canvas *
wording_graph(struct tool *t, const struct curve_style *s, const char *title, const char *subtitle,
              struct graph *graph, struct graph_series *series, struct drawn *drawn)
{
    RC_OWNED char *names = s->legend == NULL ? NULL : tool_copy(t, s->legend);

    graph->paper = s->paper;
    snprintf(drawn->title, sizeof drawn->title, "%s",
             s->paper.title == NULL ? title : s->paper.title);
    graph->paper.title = drawn->title;
    graph->paper.subtitle = wording_subtitle(&s->paper, subtitle);
    graph->paper.stamp = drawn->stamp;
    graph->series = series;
    set_axis(t, s, 'x', graph, &graph->x);
    set_axis(t, s, 'y', graph, &graph->y);
    if (names != NULL)
        set_names(t, names, series, graph->n);
    join_names(series, graph->n);
    return tool_made(t, NULL, graph_draw(graph, &t->err));
}
