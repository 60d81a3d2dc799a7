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

static void
describe(const struct cost_case *c, struct drawing *d)
{
    const char *source = rc_grid_get(c->heights, "source");
    char text[TICKS_TEXT], body[COST_BODY];

    snprintf(d->subtitle, sizeof d->subtitle,
             "%.60s%s%zu × %zu nodes, %s%s · %s %s · %.3g %% contact · %zu threads",
             source == NULL ? "" : source, source == NULL ? "" : " · ", c->shape.nx, c->shape.ny,
             c->problem.boundary == RC_FREE ? "free" : "periodic", cost_body(c, " · ", body),
             c->problem.approach > 0 ? "approach" : "load",
             c->problem.approach > 0 ? scale_value(text, c->problem.approach, "m")
                                     : scale_value(text, c->problem.load, "N"),
             100 * c->reference.contact.contact_fraction, c->tool->threads);
    d->chart.subtitle = d->subtitle;
    d->chart.across = c->yield != NULL ? "time (s); at the points: increments" : "time (s)";
}

static void
draw_pressures(const struct cost_case *c, struct drawing *d)
{
    describe(c, d);
    d->chart.title = "What accuracy costs: the contact pressure";
    d->chart.up = "relative L1 error of the pressure";
    d->chart.floor = c->reference.contact.pressure_error;
    d->chart.floor_text = "below the reference's own error";
    for (size_t k = 0; k < c->trials; k++) {
        const struct cost_trial *m = &c->trial[k];
        struct chart_point *p;
        char name[NAME], label[32];

        cost_series_name(name, m);
        if (m->state != COST_DONE || (p = new_point(d, name, cost_series(&m->settings))) == NULL)
            continue;
        *p = (struct chart_point){
            .x = m->seconds, .y = m->error, .hollow = m->settings.coarse > 1, .front = m->front};
        snprintf(p->label, sizeof p->label, "%s", cost_point_name(label, &m->settings));
        if (m->settings.coarse > 1)
            d->chart.hollow = "on 1/2, 1/4, 1/8 of the nodes a side";
    }
}

static const double rounding =
    1e-14; /* of a stress over the largest pressure, on maps of some million nodes */

static void
draw_stresses(const struct cost_case *c, struct drawing *d)
{
    describe(c, d);
    d->chart.title = "What accuracy costs: the stresses";
    d->chart.up = "error over the largest pressure";
    d->chart.floor = rounding;
    d->chart.floor_text = "rounding";
    for (size_t k = 0; k < c->stresses; k++) {
        const struct cost_stress *s = &c->stress[(k + 1) % c->stresses]; /* the exact one last */
        const char *remark = s->kernel == c->stress[0].kernel ? ", deep slices coarser" : "";
        struct chart_point *p;
        char name[NAME];

        snprintf(name, sizeof name, "%s%s", s->kernel, remark);
        if (s->state != COST_DONE ||
            (p = new_point(d, name, words_engine_place(s->kernel))) == NULL)
            continue;
        *p = (struct chart_point){
            .x = s->seconds, .y = s->reference ? rounding / 10 : s->error, .front = s->front};
        snprintf(p->label, sizeof p->label, s->tol > 0 ? "%.0e" : "exact", s->tol);
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
    bool stresses = false;
    struct canvas *canvas = NULL;
    char *picture = NULL, text[512];
    FILE *file;
    enum rc_status status = RC_FAIL;

    rc_err_set(err, "out of memory");
    if (d == NULL)
        return NULL;
    draw_pressures(c, &d[0]);
    for (size_t k = 0; k < c->stresses; k++)
        stresses = stresses || c->stress[k].state == COST_DONE;
    if (stresses)
        draw_stresses(c, &d[1]);
    canvas = draw(d, stresses ? 2 : 1, err);
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
