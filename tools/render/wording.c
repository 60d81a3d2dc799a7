/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Texts of a figure that the command line replaces.
 */
#include "render.h"

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

/* Ends the tool if the unit does not fit the quantity. */
static void
set_axis(struct tool *t, const struct curve_style *s, char which, struct graph_axis *axis)
{
    const char *text = which == 'x' ? s->x_label : s->y_label;
    const bool plain = *axis->unit == '\0' || strcmp(axis->unit, "1") == 0;
    struct scale scale;

    axis->log = wording_log(s, which);
    axis->shown = which == 'x' ? s->x_unit : s->y_unit;
    if (text != NULL)
        axis->quantity = text;
    if (axis->shown != NULL && !scale_given(&scale, axis->shown, axis->unit))
        tool_usage(t, "--%c-unit %s: the axis is in %s: it must be %s", which, axis->shown,
                   plain ? "plain numbers" : axis->unit,
                   plain ? "1 or %" : "that unit, with or without a prefix");
}

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
    set_axis(t, s, 'x', &graph->x);
    set_axis(t, s, 'y', &graph->y);
    if (names != NULL)
        set_names(t, names, series, graph->n);
    join_names(series, graph->n);
    return tool_made(t, NULL, graph_draw(graph, &t->err));
}
