/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bars as a picture: for each figure the relative half width, and the share of each source. */
#include "scan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tools/plot/plot.h"

enum {
    FIGURES = 40,
    SERIES = SCAN_SOURCES + 1 /* the bars come first */
};

struct bars {
    struct graph graph;
    struct graph_series series[SERIES];
    double x[SERIES][FIGURES], y[SERIES][FIGURES];
    const char *word[FIGURES];
    char name[FIGURES][64], subtitle[256];
};

/* The last case of the report. */
static size_t
last_line(const struct scan *s)
{
    size_t line = 0;

    for (size_t k = 0; k < s->bars; k++)
        line = s->bar[k].line > line ? s->bar[k].line : line;
    return line;
}

/* Puts a part of figure k, relative to its value, into a series; nothing for one that is 0 or unknown. */
static void
put_point(struct bars *b, size_t series, size_t k, double part, double value)
{
    struct graph_series *s = &b->series[series];
    const double relative = part / fabs(value);

    if (!(relative > 0) || !isfinite(relative))
        return;
    b->x[series][s->n] = (double)k;
    b->y[series][s->n++] = relative;
}

static void
fill(const struct scan *s, struct bars *b)
{
    static const char *const names[SERIES] = {"bar, 90 %",        "noise", "grid", "patch",
                                              "holes of the map", "filter"};
    const size_t line = last_line(s);
    size_t n = 0;

    for (size_t k = 0; k < SERIES; k++)
        b->series[k] = (struct graph_series){
            .name = names[k], .kind = GRAPH_POINTS, .place = k, .x = b->x[k], .y = b->y[k]};
    for (size_t k = 0; k < s->bars && n < FIGURES; k++) {
        const struct scan_bar *bar = &s->bar[k];

        if (bar->line != line || !(bar->bar > 0) || bar->value == 0)
            continue;
        put_point(b, 0, n, bar->bar, bar->value);
        for (size_t i = 0; i < SCAN_SOURCES; i++)
            put_point(b, 1 + i, n, bar->part[i], bar->value);
        snprintf(b->name[n], sizeof *b->name, "%.60s", bar->name);
        for (char *c = b->name[n]; (c = strchr(c, '_')) != NULL;)
            *c = ' ';
        b->word[n] = b->name[n];
        n++;
    }
    b->graph = (struct graph){
        .paper = {.title = "How far the measurement lets each figure be trusted",
                  .subtitle = b->subtitle},
        .x = {.quantity = "", .unit = "1", .lo = NAN, .hi = NAN, .word = b->word, .words = n},
        .y = {.quantity = "half width of the bar",
              .unit = "1",
              .log = true,
              .lo = NAN,
              .hi = NAN,
              .shown = "%"},
        .series = b->series};
    for (size_t k = 0; k < SERIES; k++) /* sources that were not studied have no points */
        if (b->series[k].n > 0)
            b->series[b->graph.n++] = b->series[k];
}

unsigned char *
scan_plot(const struct scan *s, const char *ending, size_t *bytes, struct rc_err *err)
{
    const struct cost_case *c = s->c;
    const char *source = rc_grid_get(c->first, "source");
    struct bars *b = calloc(1, sizeof *b);
    unsigned char *picture = NULL;

    if (b == NULL) {
        rc_err_set(err, "out of memory");
        return NULL;
    }
    snprintf(b->subtitle, sizeof b->subtitle, "%.60s%s%zu × %zu nodes · %s",
             source == NULL ? "" : source, source == NULL ? "" : " · ", c->shape.nx, c->shape.ny,
             c->command.program[c->command.programs - 1].name);
    if (last_line(s) > 0)
        snprintf(b->subtitle + strlen(b->subtitle), sizeof b->subtitle - strlen(b->subtitle),
                 " · case %zu", last_line(s) + 1);
    fill(s, b);
    if (b->graph.n == 0)
        rc_err_set(err, "no figure has a bar, so there is nothing to draw");
    else
        picture = cost_picture(c->tool, b->graph.paper.title, &b->graph, ending, bytes, err);
    free(b);
    return picture;
}
