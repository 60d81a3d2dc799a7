/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Error against time: a point for each trial. */
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
    char name[SERIES][160], title[128], subtitle[400], x_name[128], y_name[128];
};

static void
describe(const struct cost_case *c, struct drawing *d)
{
    const char *source = rc_grid_get(c->first, "source");
    const bool labels = c->list[c->points].grid || strcmp(c->list[c->points].name, "tol") == 0;
    size_t n;

    snprintf(d->subtitle, sizeof d->subtitle, "%.60s%s%zu × %zu nodes · ",
             source == NULL ? "" : source, source == NULL ? "" : " · ", c->shape.nx, c->shape.ny);
    for (size_t k = 0; k < c->command.programs; k++) {
        n = strlen(d->subtitle);
        snprintf(d->subtitle + n, sizeof d->subtitle - n, "%s%s", k > 0 ? " | " : "",
                 c->command.program[k].name);
    }
    n = strlen(d->subtitle);
    snprintf(d->subtitle + n, sizeof d->subtitle - n, " · %zu thread%s", c->tool->threads,
             c->tool->threads == 1 ? "" : "s");
    snprintf(d->title, sizeof d->title, "What accuracy costs: %s", cost_object_name(c, c->ranked));
    snprintf(d->x_name, sizeof d->x_name, labels ? "time" : "time (s); at the points: %s",
             c->list[c->points].name);
    snprintf(d->y_name, sizeof d->y_name, "%s of %s",
             c->ranked.frame && c->channel[c->ranked.k].whole ? "share of other nodes"
             : c->ranked.frame                                ? "relative L1 error"
                                                              : "relative error",
             cost_object_name(c, c->ranked));
    d->graph = (struct graph){
        .paper = {.title = d->title, .subtitle = d->subtitle},
        .x = {.quantity = d->x_name, .unit = "s", .log = true, .lo = NAN, .hi = NAN, .shown = "s"},
        .y = {.quantity = d->y_name, .unit = "1", .log = true, .lo = NAN, .hi = NAN},
        .series = d->series,
        .front = "front: nothing is quicker and as accurate",
        .floor = c->reference_error,
        .floor_text = "below the reference's own error"};
}

/* The entry for a further point of the series of that name; SERIES: too many series to draw. */
static size_t
series_of(struct drawing *d, const char *name)
{
    size_t s = 0;

    while (s < d->graph.n && strcmp(d->name[s], name) != 0)
        s++;
    if (s == SERIES || (s < d->graph.n && d->series[s].n == POINTS))
        return SERIES;
    if (s == d->graph.n) {
        snprintf(d->name[s], sizeof d->name[s], "%s", name);
        d->series[s] = (struct graph_series){
            .name = d->name[s], .place = s, .x = d->x[s], .y = d->y[s], .point = d->point[s]};
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

/* The plane of the picture has no memory: its front is that of time and error, without the scatter. */
static bool
is_ahead(const struct cost_case *c, const struct cost_trial *t)
{
    const double error = fmax(t->error, c->reference_error);

    for (size_t k = 0; k < c->trials; k++) {
        const struct cost_trial *o = &c->trial[k];
        const double other = fmax(o->error, c->reference_error);
        if (o != t && o->state == COST_DONE && !(o->reference && c->trials > 1) && other <= error &&
            o->seconds <= t->seconds && (other < error || o->seconds < t->seconds))
            return false;
    }
    return true;
}

/* The place of a further point among those of the series, which are in the order of their times: its line
 * does not turn back. */
static size_t
place_of(struct drawing *d, size_t s, double seconds)
{
    size_t n = d->series[s].n++;

    for (; n > 0 && d->x[s][n - 1] > seconds; n--) {
        d->x[s][n] = d->x[s][n - 1];
        d->y[s][n] = d->y[s][n - 1];
        d->point[s][n] = d->point[s][n - 1];
    }
    return n;
}

static void
draw_trials(const struct cost_case *c, struct drawing *d)
{
    describe(c, d);
    for (size_t k = 0; k < c->trials; k++) {
        const struct cost_trial *t = &c->trial[k];
        size_t s, n;
        char name[160], label[COST_NAME];

        cost_name(c, t, true, name);
        if (t->state != COST_DONE || isnan(t->error) || (t->reference && c->trials > 1) ||
            (s = series_of(d, name[0] == '\0' ? "trials" : name)) == SERIES)
            continue;
        n = place_of(d, s, t->seconds);
        d->x[s][n] = t->seconds;
        d->y[s][n] = fmax(t->error, fmax(d->graph.floor / 10, 1e-15));
        d->point[s][n] = (struct graph_point){.hollow = t->coarse > 1, .front = is_ahead(c, t)};
        for (size_t l = 0; l < c->lists; l++)
            if (t->coarse > 1 ? c->list[l].grid : l == c->points)
                snprintf(d->point[s][n].label, sizeof d->point[s][n].label, "%.15s",
                         cost_value(&c->list[l], t->pick[l], label));
        if (t->coarse > 1)
            d->graph.hollow = "on a coarser grid: a part of the nodes a side";
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
cost_picture(struct tool *t, const char *title, const struct graph *graph, const char *ending,
             size_t *bytes, struct rc_err *err)
{
    const struct picture_text text[] = {
        {"Title", title}, {"Description", tool_history(t)}, {"Software", "rc-cost"}};
    char *picture = NULL, warning[512];
    enum rc_status status = RC_FAIL;
    struct canvas *canvas;
    FILE *file;

    rc_err_set(err, "out of memory");
    canvas = graph_draw(graph, err);
    if (canvas != NULL && (file = open_memstream(&picture, bytes)) != NULL) {
        status = canvas_write(canvas, canvas_format(ending), text, sizeof text / sizeof *text, file,
                              err);
        if (fclose(file) != 0)
            status = RC_FAIL;
    }
    if (canvas != NULL && canvas_warning(canvas, warning, sizeof warning) != NULL)
        tool_warn(t, "%s", warning);
    canvas_free(canvas);
    if (status != RC_OK) {
        free(picture);
        picture = NULL;
    }
    return (unsigned char *)picture;
}

unsigned char *
cost_plot(const struct cost_case *c, const char *ending, size_t *bytes, struct rc_err *err)
{
    struct drawing *d = calloc(1, sizeof *d);
    unsigned char *picture;

    if (d == NULL) {
        rc_err_set(err, "out of memory");
        return NULL;
    }
    draw_trials(c, d);
    picture = cost_picture(c->tool, "What accuracy costs", &d->graph, ending, bytes, err);
    free(d);
    return picture;
}
