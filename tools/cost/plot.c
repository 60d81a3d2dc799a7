/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Error against time: a graph of the pressures and, if there are stresses, one below for them.
 */
#define _GNU_SOURCE /* open_memstream, in POSIX since 2008 */
#include "cost.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tools/plot/plot.h"

enum {
    SERIES = 32,
    POINTS = 64
};

/* A graph and the data to which it points. */
struct drawing {
    struct graph graph;
    struct graph_series series[SERIES];
    double x[SERIES][POINTS], y[SERIES][POINTS];
    struct graph_point point[SERIES][POINTS];
    char name[SERIES][64], subtitle[400];
};

/* Error of a stress relative to the largest pressure, on maps of some million nodes. */
static const double rounding = 1e-14;

static void
describe(const struct cost_case *c, struct drawing *d, bool stress)
{
    const char *source = rc_grid_get(c->heights, "source");
    const double approach = cost_number(c->solved, "asked_approach");
    char body[COST_BODY];

    snprintf(d->subtitle, sizeof d->subtitle,
             "%.60s%s%zu × %zu nodes, %s%s · %s %s · %.3g %% contact · %zu threads",
             source == NULL ? "" : source, source == NULL ? "" : " · ", c->shape.nx, c->shape.ny,
             rc_boundary_word(c->line.boundary), cost_body(c, " · ", body),
             isnan(approach) ? "load" : "approach",
             isnan(approach) ? scale_value(cost_number(c->solved, "load"), "N")
                             : scale_value(approach, "m"),
             100 * cost_number(c->solved, "contact_fraction"), c->tool->threads);
    d->graph = (struct graph){
        .paper = {.title = stress ? "What accuracy costs: the stresses"
                                  : "What accuracy costs: the contact pressure",
                  .subtitle = d->subtitle},
        .x = {.quantity = (c->about & COST_YIELD) ? "time (s); at the points: increments" : "time",
              .unit = "s",
              .log = true,
              .lo = NAN,
              .hi = NAN,
              .shown = "s"},
        .y = {.quantity =
                  stress ? "error over the largest pressure" : "relative L1 error of the pressure",
              .unit = "1",
              .log = true,
              .lo = NAN,
              .hi = NAN},
        .series = d->series,
        .front = "front: nothing is both quicker and nearer",
        .floor = stress ? rounding : c->reference.is.estimate,
        .floor_text = stress ? "rounding" : "below the reference's own error"};
}

/* The entry for a further point of the series of that name; SERIES: too many series to draw. */
static size_t
series_of(struct drawing *d, const char *name, size_t place)
{
    size_t s = 0;

    while (s < d->graph.n && strcmp(d->name[s], name) != 0)
        s++;
    if (s == SERIES || (s < d->graph.n && d->series[s].n == POINTS))
        return SERIES;
    if (s == d->graph.n) {
        snprintf(d->name[s], sizeof d->name[s], "%s", name);
        d->series[s] = (struct graph_series){
            .name = d->name[s], .place = place, .x = d->x[s], .y = d->y[s], .point = d->point[s]};
        d->graph.n++;
    }
    return s;
}

static void
stretch(struct graph_axis *a, double value)
{
    a->lo = fmin(a->lo, value);
    a->hi = fmax(a->hi, value);
}

/* Trials from `from` to `to`; the exact stresses, which are the first, come last. */
static void
draw_trials(const struct cost_case *c, struct drawing *d, size_t from, size_t to)
{
    const bool stress = from > 0;

    describe(c, d, stress);
    for (size_t k = 0; k < to - from; k++) {
        const struct cost_trial *m = &c->trial[from + (k + stress) % (to - from)];
        size_t s, n;
        char name[64], label[32];

        cost_series_name(name, m);
        if (m->state != COST_DONE || (s = series_of(d, name, cost_series(m))) == SERIES)
            continue;
        n = d->series[s].n++;
        d->x[s][n] = m->is.seconds;
        d->y[s][n] = fmax(m->reference ? 0 : m->is.error, fmax(d->graph.floor / 10, 1e-15));
        d->point[s][n] = (struct graph_point){.hollow = m->coarse > 1, .front = m->front};
        snprintf(d->point[s][n].label, sizeof d->point[s][n].label, "%s",
                 cost_point_name(label, m));
        if (m->coarse > 1)
            d->graph.hollow = "on 1/2, 1/4, 1/8 of the nodes a side";
        stretch(&d->graph.x, d->x[s][n]);
        stretch(&d->graph.y, d->y[s][n]);
    }
    if (d->graph.n == 0) { /* no measurements */
        d->graph.x.lo = d->graph.y.lo = 0.1;
        d->graph.x.hi = d->graph.y.hi = 1;
    } else { /* with margins for labels; whole decades */
        d->graph.x.lo /= 1.3;
        d->graph.x.hi *= 1.2;
        d->graph.y.lo = pow(10, floor(log10(d->graph.y.lo) - 0.1));
        d->graph.y.hi = pow(10, ceil(log10(d->graph.y.hi) + 0.1));
    }
}

unsigned char *
cost_plot(const struct cost_case *c, const char *ending, size_t *bytes, struct rc_err *err)
{
    const size_t n = c->stressed != NULL ? 2 : 1;
    const struct picture_text text[] = {{"Title", "What accuracy costs"},
                                        {"Description", tool_history(c->tool)},
                                        {"Software", "rc-cost"}};
    struct drawing *d = calloc(n, sizeof *d);
    struct graph graph[2];
    struct canvas *canvas;
    char *picture = NULL, warning[512];
    enum rc_status status = RC_FAIL;
    FILE *file;

    rc_err_set(err, "out of memory");
    if (d == NULL)
        return NULL;
    draw_trials(c, &d[0], 0, c->pressures);
    if (n > 1)
        draw_trials(c, &d[1], c->pressures, c->trials);
    for (size_t k = 0; k < n; k++)
        graph[k] = d[k].graph;
    canvas = graphs_draw(graph, n, err);
    if (canvas != NULL && (file = open_memstream(&picture, bytes)) != NULL) {
        status = canvas_write(canvas, canvas_format(ending), text, sizeof text / sizeof *text, file,
                              err);
        if (fclose(file) != 0)
            status = RC_FAIL;
    }
    if (canvas != NULL && canvas_warning(canvas, warning, sizeof warning) != NULL)
        tool_warn(c->tool, "%s", warning);
    canvas_free(canvas);
    free(d);
    if (status != RC_OK) {
        free(picture);
        picture = NULL;
    }
    return (unsigned char *)picture;
}
