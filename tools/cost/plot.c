/*
 * Error against time: one picture of the pressures, and, where there are stresses, one below of
 * them.
 */
#define _GNU_SOURCE /* open_memstream, in POSIX since 2008 */
#include "cost.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tools/plot/plot.h"

/* Colours that the colour-blind tell apart (Okabe and Ito 2008), by the place of a series. */
static const struct rgb palette[] = {{0x00, 0x72, 0xb2}, {0x56, 0xb4, 0xe9}, {0x00, 0x9e, 0x73},
                                     {0xe6, 0x9f, 0x00}, {0xd5, 0x5e, 0x00}, {0xcc, 0x79, 0xa7},
                                     {0xf0, 0xe4, 0x42}, {0x00, 0x00, 0x00}};

enum {
    COLOURS = sizeof palette / sizeof *palette,
    SERIES = 32,
    POINTS = 64,
    NAME = 64
};

struct drawing {
    struct chart chart;
    struct chart_series series[SERIES];
    struct chart_point point[SERIES][POINTS];
    char name[SERIES][NAME];
    char subtitle[400], floor_text[100];
};

/* Another point of the series of that name, whose colour is the one at `place`; NULL: there are too
 * many to be drawn. */
static struct chart_point *
new_point(struct drawing *d, const char *name, size_t place)
{
    size_t s = 0;

    while (s < d->chart.n && strcmp(d->name[s], name) != 0)
        s++;
    if (s == SERIES || (s < d->chart.n && d->series[s].n == POINTS))
        return NULL;
    if (s == d->chart.n) {
        snprintf(d->name[s], NAME, "%s", name);
        d->series[s] = (struct chart_series){d->name[s], palette[place % COLOURS], d->point[s], 0};
        d->chart.series = d->series;
        d->chart.n++;
    }
    return &d->point[s][d->series[s].n++];
}

/* Of a stress over the largest pressure, on maps of some million nodes. */
static const double rounding = 1e-14;

static void
describe(const struct cost_case *c, struct drawing *d, bool stress)
{
    const char *source = rc_grid_get(c->heights, "source");
    const double approach = cost_number(c->solved, "asked_approach");
    char text[TICKS_TEXT], body[COST_BODY];

    snprintf(d->subtitle, sizeof d->subtitle,
             "%.60s%s%zu × %zu nodes, %s%s · %s %s · %.3g %% contact · %zu threads",
             source == NULL ? "" : source, source == NULL ? "" : " · ", c->shape.nx, c->shape.ny,
             c->periodic ? "periodic" : "free", cost_body(c, " · ", body),
             isnan(approach) ? "load" : "approach",
             isnan(approach) ? scale_value(text, cost_number(c->solved, "load"), "N")
                             : scale_value(text, approach, "m"),
             100 * cost_number(c->solved, "contact_fraction"), c->tool->threads);
    d->chart.subtitle = d->subtitle;
    d->chart.across = (c->about & COST_YIELD) ? "time (s); at the points: increments" : "time (s)";
    d->chart.title =
        stress ? "What accuracy costs: the stresses" : "What accuracy costs: the contact pressure";
    d->chart.up = stress ? "error over the largest pressure" : "relative L1 error of the pressure";
    d->chart.floor = stress ? rounding : c->reference.figure[COST_ESTIMATE];
    d->chart.floor_text = stress ? "rounding" : "below the reference's own error";
}

/* Trials from one place to another; the exact stresses, which are the first of them, last. */
static void
draw_trials(const struct cost_case *c, struct drawing *d, size_t from, size_t to)
{
    const bool stress = from > 0;

    describe(c, d, stress);
    for (size_t k = 0; k < to - from; k++) {
        const struct cost_trial *m = &c->trial[from + (k + stress) % (to - from)];
        struct chart_point *p;
        char name[NAME], label[32];

        cost_series_name(name, m);
        if (m->state != COST_DONE || (p = new_point(d, name, cost_series(m))) == NULL)
            continue;
        *p = (struct chart_point){.x = m->figure[COST_SECONDS],
                                  .y = m->reference ? rounding / 10 : m->figure[COST_ERROR],
                                  .hollow = m->coarse > 1,
                                  .front = m->front};
        snprintf(p->label, sizeof p->label, "%s", cost_point_name(label, m));
        if (m->coarse > 1)
            d->chart.hollow = "on 1/2, 1/4, 1/8 of the nodes a side";
    }
}

/* ---- the file ---- */

static enum rc_status
write_picture(struct canvas *c, enum canvas_format format, FILE *file, const char *made,
              struct rc_err *err)
{
    const struct picture_text text[] = {
        {"Title", "What accuracy costs"}, {"Description", made}, {"Software", "rc-cost"}};

    return canvas_write(c, format, text, sizeof text / sizeof *text, file, err);
}

static struct canvas *
draw(const struct drawing *d, size_t n, struct rc_err *err)
{
    struct canvas *c = canvas_new(1, 1, err); /* to measure text on */
    double height = 0, y = 0;

    if (c == NULL)
        return NULL;
    for (size_t k = 0; k < n; k++)
        height += chart_height(c, &d[k].chart);
    canvas_free(c);
    if ((c = canvas_new(CHART_WIDTH, (size_t)ceil(height), err)) == NULL)
        return NULL;
    for (size_t k = 0; k < n; k++) {
        chart_draw(c, y, &d[k].chart);
        y += chart_height(c, &d[k].chart);
    }
    return c;
}

unsigned char *
cost_plot(const struct cost_case *c, const char *ending, size_t *bytes, struct rc_err *err)
{
    struct drawing *d = calloc(2, sizeof *d);
    struct canvas *canvas = NULL;
    char *picture = NULL, text[512];
    FILE *file;
    enum rc_status status = RC_FAIL;

    rc_err_set(err, "out of memory");
    if (d == NULL)
        return NULL;
    draw_trials(c, &d[0], 0, c->pressures);
    if (c->stressed != NULL)
        draw_trials(c, &d[1], c->pressures, c->trials);
    canvas = draw(d, c->stressed != NULL ? 2 : 1, err);
    if (canvas != NULL)
        tool_demand_memory(c->tool, c->heights, canvas_memory(canvas, canvas_format(ending)));
    if (canvas != NULL && (file = open_memstream(&picture, bytes)) != NULL) {
        status = write_picture(canvas, canvas_format(ending), file, tool_history(c->tool), err);
        if (fclose(file) != 0)
            status = RC_FAIL;
    }
    if (canvas != NULL && canvas_warning(canvas, text, sizeof text) != NULL)
        tool_warn(c->tool, "%s", text);
    canvas_free(canvas);
    free(d);
    if (status != RC_OK) {
        free(picture);
        picture = NULL;
    }
    return (unsigned char *)picture;
}
