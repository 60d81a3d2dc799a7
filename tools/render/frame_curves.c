/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Curves of frames: values along a line, their distribution, and the fraction of the map above a value.
 */
#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    BINS = 60,      /* most bins of a histogram         */
    SAMPLES = 1000, /* points of a long curve           */
    LAW = 300,      /* points of a law                  */
    LABEL = 256
};

/* Curves of n frames, and one of a law. */
struct set {
    struct tool *tool;
    struct rc_grid *const *grid;
    const struct rc_grid *const *touch; /* for histograms: the contact of each frame */
    size_t n;
    const struct curve_style *style;
    struct graph_series *series; /* n + 1 */
    double **x, **y;             /* coordinates of the series, n + 1 each */
    char (*label)[LABEL];
    struct subtitle subtitle;
    struct channel channel;
};

static void *
room(struct tool *t, size_t n, size_t size)
{
    return tool_room(t, n, size, "a curve");
}

static void
set_begin(struct set *s)
{
    struct survey survey;

    s->series = room(s->tool, s->n + 1, sizeof *s->series);
    s->x = room(s->tool, s->n + 1, sizeof *s->x);
    s->y = room(s->tool, s->n + 1, sizeof *s->y);
    s->label = room(s->tool, s->n + 1, sizeof *s->label);
    for (size_t k = 0; k < s->n; k++) {
        survey_map(s->grid[k], &survey);
        if (isnan(survey.min))
            tool_refuse(s->tool, s->grid[k],
                        "none of its %zu values is a finite number: there is nothing to draw",
                        s->grid[k]->nx * s->grid[k]->ny);
        frame_label(s->label[k], LABEL, s->grid, s->n, k);
    }
    s->channel = channel_of(s->grid[0], &survey);
    subtitle_common(&s->subtitle, s->grid, s->n, false);
}

/* Adds series k, which has a name if there are several series or a law. */
static void
set_series(struct set *s, size_t k, enum graph_kind kind, size_t n)
{
    s->x[k] = room(s->tool, n + 1, sizeof *s->x[k]);
    s->y[k] = room(s->tool, n + 1, sizeof *s->y[k]);
    s->series[k] = (struct graph_series){.name = s->n > 1 ? s->label[k] : NULL,
                                         .kind = kind,
                                         .place = k,
                                         .x = s->x[k],
                                         .y = s->y[k],
                                         .n = n};
}

static struct canvas *
set_draw(struct set *s, struct graph *graph, const char *title, struct drawn *drawn)
{
    const char *source = rc_grid_get(s->grid[0], "source");
    struct canvas *canvas;

    snprintf(drawn->source, sizeof drawn->source, "%s", source == NULL ? "" : source);
    drawn->stamp = NULL;
    for (size_t k = 0; k < s->n && drawn->stamp == NULL; k++)
        drawn->stamp = look_stamp(s->grid[k]);
    canvas = wording_graph(s->tool, s->style, title, s->subtitle.text, graph, s->series, drawn);
    for (size_t k = 0; k <= s->n; k++) {
        free(s->x[k]);
        free(s->y[k]);
    }
    free(s->series);
    free(s->x);
    free(s->y);
    free(s->label);
    return canvas;
}

/* ---- along a line ---- */

/* One axis of a map or a section: the coordinates of its nodes. */
struct line {
    const char *name;
    size_t n;
    double step, *at; /* `at` NULL: even steps */
    double origin;    /* index of the origin, which may be between two nodes */
    const char *title, *unit;
};

static double
line_at(const struct line *l, size_t k)
{
    return l->at != NULL ? l->at[k] : ((double)k - l->origin) * l->step;
}

/* The two axes of a frame. In a section one of them is the depth, whose steps may be uneven. */
static void
set_lines(struct tool *t, const struct rc_grid *g, struct line *across, struct line *down)
{
    const char *section = rc_grid_get(g, "section");
    const char *unit = rc_grid_dunit(g);
    bool waves = strcmp(unit, "rad/m") == 0;
    double i, j;

    rc_grid_origin(g, &i, &j);
    *across = (struct line){.name = section != NULL && section[0] == 'x' ? "y" : "x",
                            .n = g->nx,
                            .step = g->dx,
                            .origin = i,
                            .unit = unit};
    *down = (struct line){.name = section != NULL ? "depth" : "y",
                          .n = g->ny,
                          .step = g->dy,
                          .origin = j,
                          .unit = unit};
    across->title = waves ? "qx" : across->name;
    down->title = waves ? "qy" : down->name;
    if (section != NULL)
        down->at = section_depths(t, g);
}

/* The node nearest to the position; of two at the same distance the later one. */
static size_t
nearest(struct tool *t, const struct rc_grid *g, const struct line *l, double place)
{
    size_t best = 0;
    double slack = 0.5 * l->step * (1 + 1e-9);

    if (place < line_at(l, 0) - slack || place > line_at(l, l->n - 1) + slack)
        tool_refuse(t, g, "--cut: it has nodes from %s = %s to %s", l->title,
                    scale_value(line_at(l, 0), l->unit),
                    scale_value(line_at(l, l->n - 1), l->unit));
    for (size_t k = 1; k < l->n; k++)
        if (fabs(line_at(l, k) - place) <= fabs(line_at(l, best) - place) + 1e-9 * l->step)
            best = k;
    return best;
}

/* Reads NAME=PLACE, the axis and the position of the line; ends the tool for another text. */
static double
read_cut(struct tool *t, const struct rc_grid *g, const char *cut, const struct line *across,
         const struct line *down, bool *along_x)
{
    const char *is = strchr(cut, '=');
    size_t n = is == NULL ? 0 : (size_t)(is - cut);
    double place;

    *along_x = n == strlen(down->name) && strncmp(cut, down->name, n) == 0;
    if (is == NULL || (!*along_x && (n != strlen(across->name) || strncmp(cut, across->name, n))))
        tool_usage(t, "--cut %s: it must be %s=PLACE or %s=PLACE, as in %s=0", cut, across->name,
                   down->name, down->name);
    if (unit_number(is + 1, look_unit(g), &place, &t->err) != RC_OK)
        tool_usage(t, "--cut %s: %s", cut, t->err.text);
    return place;
}

/* Adds lines at the interfaces and a note about them; the caller frees their depths. */
static double *
mark_interfaces(const struct rc_grid *g, struct graph *graph, char *note, size_t size)
{
    double *bottom = media_bottoms(g, &graph->uprights);
    size_t used = 0;

    if (bottom == NULL)
        return NULL;
    graph->upright = bottom;
    graph->note = note;
    used = (size_t)snprintf(note, size, "dashed: where media meet, at a depth of ");
    for (size_t k = 0; k < graph->uprights && used < size; k++)
        used += (size_t)snprintf(note + used, size - used, "%s%s", k == 0 ? "" : ", ",
                                 scale_value(bottom[k], "m"));
    return bottom;
}

/* Hertz's pressure along a line of nodes at this distance from the origin. */
static void
add_hertz(struct set *s, const struct line *along, bool along_x, double across)
{
    const struct rc_grid *g = s->grid[0];
    double lo = line_at(along, 0), hi = line_at(along, along->n - 1);
    struct hertz_contact hertz;

    if (s->n > 1 || strcmp(g->channel, "pressure") != 0)
        tool_usage(s->tool, "--hertz with --cut needs a single pressure: leave it out");
    hertz_read(s->tool, g, &s->style->given, &hertz);
    snprintf(s->label[1], LABEL, "%s", hertz.text);
    set_series(s, 1, GRAPH_LAW, SAMPLES);
    s->series[0].name = "pressure of the map";
    s->series[1].name = s->label[1];
    for (size_t k = 0; k < SAMPLES; k++) {
        double x = lo + (hi - lo) * (double)k / (SAMPLES - 1);

        s->x[1][k] = x;
        s->y[1][k] = hertz_pressure_at(&hertz, along_x ? x : across, along_x ? across : x);
    }
}

struct canvas *
cut_draw(struct tool *t, struct rc_grid *const *grid, size_t n, const char *cut, double lo,
         double hi, const struct curve_style *style, struct drawn *drawn)
{
    struct set s = {.tool = t, .grid = grid, .n = n, .style = style};
    struct graph graph = {.n = n, .y.lo = lo, .y.hi = hi, .x.lo = NAN, .x.hi = NAN};
    char text[TICKS_TEXT + 32], quantity[8], note[512] = "", words[80], title[CHANNEL_TITLE];
    struct canvas *canvas;
    double *bottom = NULL;

    set_begin(&s);
    for (size_t k = 0; k < n; k++) {
        const struct rc_grid *g = grid[k];
        struct line across, down;
        const struct line *along, *over;
        bool along_x;
        size_t at;
        double place;

        set_lines(t, g, &across, &down);
        place = read_cut(t, g, cut, &across, &down, &along_x);
        along = along_x ? &across : &down;
        over = along_x ? &down : &across;
        at = nearest(t, g, over, place);
        set_series(&s, k, GRAPH_LINE, along->n);
        for (size_t i = 0; i < along->n; i++) {
            s.x[k][i] = line_at(along, i);
            s.y[k][i] = g->v[along_x ? at * g->nx + i : i * g->nx + at];
        }
        snprintf(quantity, sizeof quantity, "%s", along->title);
        snprintf(text, sizeof text, "%s = %s", over->title,
                 scale_value(line_at(over, at), over->unit));
        if (k == 0 && style->paper.title != NULL)
            subtitle_add(&s.subtitle, "along ", text);
        snprintf(words, sizeof words, "along %.60s", text);
        if (k == 0)
            channel_title(&s.channel, words, title);
        if (style->hertz) {
            add_hertz(&s, along, along_x, line_at(over, at));
            graph.n = 2;
        }
        free(down.at);
    }
    graph.x.quantity = quantity;
    graph.x.unit = rc_grid_dunit(grid[0]);
    graph.y.quantity = s.channel.title;
    graph.y.unit = grid[0]->unit;
    if (strcmp(quantity, "depth") == 0 && subtitle_same(grid, n, "layers"))
        bottom = mark_interfaces(grid[0], &graph, note, sizeof note);
    canvas = set_draw(&s, &graph, title, drawn);
    free(bottom);
    return canvas;
}

/* ---- how values spread ---- */

/* True if value i of frame k belongs to the histogram: for a pressure, if the node is in contact. */
static bool
counts(const struct set *s, size_t k, size_t i)
{
    return isfinite(s->grid[k]->v[i]) &&
           (strcmp(s->grid[k]->channel, "pressure") != 0 || rc_in_contact(s->touch[k]->v[i]));
}

static void
find_range(const struct set *s, double *lo, double *hi)
{
    *lo = INFINITY;
    *hi = -INFINITY;
    for (size_t k = 0; k < s->n; k++)
        for (size_t i = 0; i < s->grid[k]->nx * s->grid[k]->ny; i++)
            if (counts(s, k, i)) {
                *lo = fmin(*lo, s->grid[k]->v[i]);
                *hi = fmax(*hi, s->grid[k]->v[i]);
            }
    if (*lo > *hi)
        tool_refuse(s->tool, s->grid[0], "no node is in contact: there is no pressure to count");
    if (strcmp(s->grid[0]->channel, "pressure") == 0)
        *lo = fmin(*lo, 0);
    if (!(*hi - *lo > 1e-12 * fmax(fabs(*lo), fabs(*hi)))) {
        double size = *hi == 0 ? 1e-9 : 0.1 * fabs(*hi);

        *lo -= size;
        *hi += size;
    }
}

/* Counts the values of a frame in bins; *out is the fraction of its measured nodes that is excluded. */
static double
fill_bins(const struct set *s, size_t k, double first, double step, size_t bins, double *density,
          double *mean)
{
    const struct rc_grid *g = s->grid[k];
    size_t measured = 0, out = 0;

    *mean = 0;
    for (size_t b = 0; b < bins; b++)
        density[b] = 0;
    for (size_t i = 0; i < g->nx * g->ny; i++) {
        double v = g->v[i], place;

        if (!isfinite(v))
            continue;
        measured++;
        *mean += v;
        if (!counts(s, k, i)) {
            out++;
            continue;
        }
        place = floor((v - first) / step);
        density[place < 0 ? 0 : place < (double)bins ? (size_t)place : bins - 1] += 1;
    }
    for (size_t b = 0; b < bins; b++)
        density[b] /= (double)measured * step;
    *mean /= (double)measured;
    return (double)out / (double)measured;
}

/* Adds Persson's distribution of the pressures for their mean, on request. */
static bool
add_distribution(struct set *s, double mean, double lo, double hi)
{
    struct law_given given = s->style->given;
    const char *lacks;
    double estar;

    if (s->style->law == NULL)
        return false;
    if (strcmp(s->style->law, "persson") != 0 || strcmp(s->grid[0]->channel, "pressure") != 0 ||
        s->n > 1)
        tool_usage(s->tool, "--law %s: a histogram has the law persson, of one pressure",
                   s->style->law);
    if (isnan(given.estar))
        bodies_demand_elastic(s->tool, s->grid[0], "give the modulus of this time with --estar");
    if (isnan(given.estar) && rc_grid_number(s->grid[0], "estar", &estar))
        given.estar = estar;
    if ((lacks = law_lacks("persson", &given)) != NULL)
        tool_usage(s->tool, "--law persson needs %s: give it", lacks);
    set_series(s, s->n, GRAPH_LAW, LAW);
    s->series[s->n].name = law_named("persson")->title;
    s->series[0].name = "pressures of the map";
    for (size_t k = 0; k < LAW; k++) {
        s->x[s->n][k] = lo + (hi - lo) * (double)k / (LAW - 1);
        s->y[s->n][k] = law_pressure_density(&given, mean, s->x[s->n][k]);
    }
    return true;
}

struct canvas *
histogram_draw(struct tool *t, struct rc_grid *const *grid, const struct rc_grid *const *touch,
               size_t n, const struct curve_style *style, struct drawn *drawn)
{
    struct set s = {.tool = t, .grid = grid, .touch = touch, .n = n, .style = style};
    bool pressure = strcmp(grid[0]->channel, "pressure") == 0;
    double lo, hi, step, first, mean = 0;
    char note[1024] = "", unit[64], title[CHANNEL_TITLE];
    struct ticks ticks;
    size_t bins, used = 0;
    struct graph graph = {.x.lo = NAN, .x.hi = NAN, .y.lo = NAN, .y.hi = NAN, .note = note};

    set_begin(&s);
    find_range(&s, &lo, &hi);
    ticks_choose(&ticks, lo, hi, BINS);
    step = ticks_at(&ticks, 1);
    first = floor(lo / step + 1e-9) * step;
    bins = (size_t)fmax(1, ceil((hi - first) / step - 1e-9));
    for (size_t k = 0; k < n; k++) {
        double out;

        set_series(&s, k, n == 1 ? GRAPH_BARS : GRAPH_LINE, n == 1 ? bins + 1 : bins);
        out = fill_bins(&s, k, first, step, bins, s.y[k], &mean);
        for (size_t b = 0; b <= bins; b++)
            s.x[k][b] = first + ((double)b + (n == 1 ? 0 : 0.5)) * step;
        if (pressure && used < sizeof note)
            used += (size_t)snprintf(note + used, sizeof note - used,
                                     "%s%s%sout of contact: %.4g %%", used == 0 ? "" : " · ",
                                     n > 1 ? s.label[k] : "", n > 1 ? ": " : "", 100 * out);
    }
    if (pressure)
        tool_note(t, "%s", note);
    graph.n = n + add_distribution(&s, mean, lo, first + (double)bins * step);
    snprintf(unit, sizeof unit, "1/%.40s", grid[0]->unit);
    channel_title(&s.channel, "distribution", title);
    graph.x.quantity = s.channel.title;
    graph.x.unit = grid[0]->unit;
    graph.y.quantity = "Probability density";
    graph.y.unit = unit;
    return set_draw(&s, &graph, title, drawn);
}

/* ---- the share above a value ---- */

static size_t
sort_values(struct set *s, const struct rc_grid *g, double **values)
{
    size_t n = 0;

    tool_demand_memory(s->tool, g, 2 * g->nx * g->ny * sizeof **values); /* qsort needs the same
                                                                            memory again */
    *values = room(s->tool, g->nx * g->ny, sizeof **values);
    for (size_t i = 0; i < g->nx * g->ny; i++)
        if (isfinite(g->v[i]))
            (*values)[n++] = g->v[i];
    qsort(*values, n, sizeof **values, range_compare);
    return n;
}

struct canvas *
material_ratio_draw(struct tool *t, struct rc_grid *const *grid, size_t n,
                    const struct curve_style *style, struct drawn *drawn)
{
    struct set s = {.tool = t, .grid = grid, .n = n, .style = style};
    struct graph graph = {
        .n = n, .x = {"Material ratio", "%", false, 0, 100}, .y.lo = NAN, .y.hi = NAN};

    set_begin(&s);
    for (size_t k = 0; k < n; k++) {
        double *value;
        size_t nodes = sort_values(&s, grid[k], &value);
        size_t points = nodes < SAMPLES ? nodes : SAMPLES;

        set_series(&s, k, GRAPH_LINE, points);
        for (size_t p = 0; p < points; p++) {
            size_t i =
                points == nodes ? p : (size_t)((double)p / (SAMPLES - 1) * (double)(nodes - 1));

            s.x[k][p] = 100 * ((double)i + 0.5) / (double)nodes;
            s.y[k][p] = value[nodes - 1 - i];
        }
        free(value);
    }
    if (wording_log(style, 'x'))
        graph.x.lo = NAN;
    graph.y.quantity = s.channel.title;
    graph.y.unit = grid[0]->unit;
    return set_draw(&s, &graph, "Material ratio", drawn);
}
