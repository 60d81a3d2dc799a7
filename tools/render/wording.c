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

struct paper
wording_paper(const struct curve_style *s, const char *title, const char *subtitle,
              struct drawn *drawn)
{
    struct paper paper = s->paper;

    snprintf(drawn->title, sizeof drawn->title, "%s", paper.title == NULL ? title : paper.title);
    paper.title = drawn->title;
    paper.subtitle = wording_subtitle(&s->paper, subtitle);
    paper.stamp = drawn->stamp;
    return paper;
}

void
wording_axis(struct tool *t, const struct curve_style *s, char which, struct graph_axis *axis)
{
    const char *text = which == 'x' ? s->x_label : s->y_label;
    struct scale scale;

    axis->shown = which == 'x' ? s->x_unit : s->y_unit;
    if (text != NULL)
        axis->quantity = text;
    if (axis->shown != NULL && !scale_given(&scale, axis->shown, axis->unit))
        tool_usage(t, "--%c-unit %s: the axis is in %s: it must be %s", which, axis->shown,
                   *axis->unit == '\0' || strcmp(axis->unit, "1") == 0 ? "plain numbers"
                                                                       : axis->unit,
                   *axis->unit == '\0' || strcmp(axis->unit, "1") == 0
                       ? "1 or %"
                       : "that unit, with or without a prefix");
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

void
wording_legend(struct tool *t, const struct curve_style *s, struct graph_series *series, size_t n,
               char *text, size_t size)
{
    size_t names = names_there(series, n), given = 1, k = 0;
    bool alone = names == 0;
    char *at = text;

    if (s->legend == NULL)
        return;
    if (strlen(s->legend) >= size)
        tool_usage(t, "--legend: it is longer than %zu bytes", size - 1);
    strcpy(text, s->legend);
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
