/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "graph.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "page.h"
#include "ticks.h"

/* Colours that colour-blind readers can distinguish (Okabe and Ito 2008). */
static const struct rgb palette[GRAPH_COLOURS] = {
    {0x00, 0x72, 0xb2}, {0xd5, 0x5e, 0x00}, {0x00, 0x9e, 0x73}, {0xcc, 0x79, 0xa7},
    {0xe6, 0x9f, 0x00}, {0x56, 0xb4, 0xe9}, {0x22, 0x22, 0x22}};
static const struct rgb rule = {0xe2, 0xe2, 0xe2}, sand = {0xf3, 0xf1, 0xec},
                        gold = {0xf4, 0xd0, 0x6f}, white = {255, 255, 255};

#define AIR 0.04 /* fraction of an axis beyond its points at both ends */

static const double nothing = 1e-290; /* counts as 0 on an axis */

enum {
    CROWDED = 60, /* a series with more points has no markers               */
    MARKERS = 4,  /* shapes: circle, square, triangle, diamond              */
    SWATCH = 56,  /* length of a line in the legend, in units of the design */
    LABELS = 64   /* labels of points of the front                          */
};

/* Results of the layout of a graph, and of drawing its labels. */
struct notes {
    size_t lost;              /* number of points not above 0 on a logarithmic axis */
    size_t beyond;            /* number of markers outside of the given ends of the axes */
    size_t sunk;              /* sunk of these, the number at the foot of the plot */
    struct box taken[LABELS]; /* by labels */
    size_t labels;
};

static struct notes *
notes_of(const struct page *p)
{
    return p->of;
}

/* ---- axes ---- */

/* True if a logarithmic axis from lo to hi, with its margins, is at least a decade long: its marks are then
 * powers of ten. */
static bool
has_decades(double lo, double hi)
{
    return (1 + 2 * AIR) * log10(hi / lo) >= 1;
}

/* The unit in which `least` is about the smallest number that the largest value may be. Square metres get the
 * prefix of a length. */
static void
choose_prefix(struct scale *s, double number, double least, const char *unit)
{
    static const struct {
        double size;
        const char *unit;
    } areas[] = {{1, "m²"}, {1e-6, "mm²"}, {1e-12, "µm²"}, {1e-18, "nm²"}};

    if (strcmp(unit, "m2") == 0) {
        size_t k = 0;

        while (k < 3 && number < least * areas[k].size)
            k++;
        s->size = areas[k].size;
        strcpy(s->unit, areas[k].unit);
    } else if (strncmp(unit, "1/", 2) == 0) { /* 1/GPa */
        struct scale of;

        scale_choose(&of, pow(1000, ceil(-log10(number) / 3 - 1e-12)), unit + 2);
        s->size = 1 / of.size;
        snprintf(s->unit, sizeof s->unit, "1/%.40s", of.unit);
    } else {
        scale_choose(s, number, unit);
    }
}

/* The unit of an axis from lo to hi. Where the marks are powers of ten, over at most three decades, the
 * prefix is that of the middle: the numbers are between 0.001 and 1000. Longer axes have the unit without a
 * prefix. */
static void
choose_scale(struct scale *s, double lo, double hi, const char *unit, bool powers)
{
    const double number = fmax(fabs(lo), fabs(hi)), half = 1.5; /* of three decades */
    const bool plain = *unit == '\0' || strcmp(unit, "1") == 0;

    if (number < nothing) { /* no power of ten is left to divide by */
        scale_choose(s, 1, unit);
    } else if (powers && log10(hi / lo) > 2 * half + 1e-9) {
        scale_keep(s, unit);
    } else if (powers) { /* of two prefixes as near, the one with numbers from 1 on */
        choose_prefix(s, sqrt(lo) * sqrt(hi) * pow(10, half) * (1 - 1e-6), pow(10, -half), unit);
        if (strncmp(s->unit, "10", 2) == 0)
            scale_keep(s, unit);
    } else if (plain && number >= 1e-3 && number < 1e4) {
        scale_keep(s, unit);
    } else {
        choose_prefix(s, number, 0.01, unit);
    }
}

static double
place(const struct axis *a, double value)
{
    return axis_place(a, value / a->scale.size);
}

static bool
shows(const struct graph_axis *a, double value)
{
    return isfinite(value) && (value > 0 || !a->log);
}

/* True if point k of a series is drawn. */
static bool
is_point(const struct graph *g, const struct graph_series *s, size_t k)
{
    return shows(&g->x, s->x[k]) && (s->kind == GRAPH_BARS || shows(&g->y, s->y[k]));
}

static bool
has_markers(const struct graph_series *s)
{
    return s->kind == GRAPH_POINTS || (s->kind == GRAPH_MARKS && s->n <= CROWDED);
}

/* True if point k is at or below 0 on a logarithmic axis y: it is drawn at the foot of the plot. */
static bool
is_sunk(const struct graph *g, const struct graph_series *s, size_t k)
{
    return g->y.log && has_markers(s) && shows(&g->x, s->x[k]) && isfinite(s->y[k]) &&
           !shows(&g->y, s->y[k]);
}

/* True if a value is not outside of the given ends of an axis; 0.3 mN is rounded. */
static bool
is_within(const struct graph_axis *a, double value)
{
    const double slack = 1e-12 * fmax(fabs(a->lo), fabs(a->hi));

    return !(value < a->lo - slack) && !(value > a->hi + slack);
}

/* The smallest and the largest value of an axis; lo > hi: there is none. Bars start at 0. An axis y with
 * `part` has those of the points within the given ends of the axis x. */
static void
extremes(const struct graph *g, bool up, bool part, double *lo, double *hi)
{
    const struct graph_axis *a = up ? &g->y : &g->x;

    *lo = INFINITY;
    *hi = -INFINITY;
    for (size_t s = 0; s < g->n; s++)
        for (size_t k = 0; k < g->series[s].n; k++) {
            const struct graph_series *q = &g->series[s];
            bool last = q->kind == GRAPH_BARS && k + 1 == q->n;
            double v = up ? last ? NAN : q->y[k] : q->x[k];

            if (!(is_point(g, q, k) || (!up && is_sunk(g, q, k))) || !shows(a, v) ||
                (part && !is_within(&g->x, q->x[k])))
                continue;
            *lo = fmin(*lo, up && q->kind == GRAPH_BARS && !a->log ? 0 : v);
            *hi = fmax(*hi, v);
            if (up && q->low != NULL) {
                *lo = shows(a, q->low[k]) ? fmin(*lo, q->low[k]) : *lo;
                *hi = shows(a, q->high[k]) ? fmax(*hi, q->high[k]) : *hi;
            }
        }
}

/* The unit in brackets, unless the text already contains the requested unit. */
static void
label(struct axis *s, const struct graph_axis *a)
{
    const char *at = a->shown == NULL || *a->shown == '\0' ? NULL : strstr(a->quantity, a->shown);
    size_t n = at == NULL ? 0 : strlen(a->shown);

    if (*a->quantity == '\0' || (at != NULL && at > a->quantity &&
                                 !isalnum((unsigned char)at[-1]) && !isalnum((unsigned char)at[n])))
        snprintf(s->label, sizeof s->label, "%s", a->quantity);
    else
        scale_label(s->label, sizeof s->label, a->quantity, &s->scale);
}

/* Adds a margin at both ends, but none between the curves and a 0 at which they begin. */
static enum rc_status
set_range(struct axis *s, const struct graph *g, bool up, struct rc_err *err)
{
    const struct graph_axis *a = up ? &g->y : &g->x;
    double lo, hi, air;

    s->log = a->log;
    s->minor = true;
    extremes(g, up, up, &lo, &hi);
    if (up && !(lo <= hi)) /* lines cross the part, their points are outside */
        extremes(g, up, false, &lo, &hi);
    if (a->words > 0 && lo <= hi) {
        *s = (struct axis){.scale.size = 1,
                           .minor = true,
                           .lo = -0.5,
                           .hi = (double)a->words - 0.5,
                           .word = a->word,
                           .words = a->words};
        snprintf(s->label, sizeof s->label, "%s", a->quantity);
        return RC_OK;
    }
    if (!(lo <= hi))
        return g->x.log || g->y.log
                   ? rc_err_set(err, "no point lies above 0 on its logarithmic axes: leave out "
                                     "--log, or give it one axis, x or y")
                   : rc_err_set(err, "%s: no point has a number on both axes", a->quantity);
    lo = isnan(a->lo) ? lo : a->lo;
    hi = isnan(a->hi) ? hi : a->hi;
    if (a->shown == NULL || !scale_given(&s->scale, a->shown, a->unit))
        choose_scale(&s->scale, lo, hi, a->unit, a->log && has_decades(lo, hi));
    label(s, a);
    if (!a->log && fmax(fabs(lo), fabs(hi)) < nothing)
        lo = hi = 0;
    lo /= s->scale.size;
    hi /= s->scale.size;
    if (a->log) {
        lo = log10(lo);
        hi = log10(hi);
    }
    if (hi - lo <= 1e-9 * fmax(fabs(lo), fabs(hi)) || hi == lo) {
        air = a->log ? 0.5 : lo == 0 ? 1 : 0.1 * fabs(lo);
        lo -= air;
        hi += air;
    }
    air = AIR * (hi - lo);
    s->lo = !isnan(a->lo) || (!a->log && lo == 0) ? lo : lo - air;
    s->hi = isnan(a->hi) ? hi + air : hi;
    if (!a->log && isnan(a->lo) && lo > 0 && lo < 0.3 * hi)
        s->lo = 0;
    return RC_OK;
}

/* ---- drawing ---- */

static double
x_of(const struct page *p, double value)
{
    return p->plot.x + fmin(fmax(place(&p->across, value), -10), 10) * p->plot.w;
}

static double
y_of(const struct page *p, double value)
{
    double t = p->graph->y.log && !(value > 0) ? -10 : place(&p->down, value);

    return p->plot.y + (1 - fmin(fmax(t, -10), 10)) * p->plot.h;
}

static void
draw_marker(struct page *p, size_t which, double x, double y, double size, struct rgb colour)
{
    static const double corner[3][4][2] = {
        {{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}},  /* square   */
        {{0, -1.15}, {1.1, 0.85}, {-1.1, 0.85}, {-1.1, 0.85}}, /* triangle */
        {{0, -1.25}, {1.25, 0}, {0, 1.25}, {-1.25, 0}}};       /* diamond  */
    double r = 0.5 * size, at[3][2];

    if (which % MARKERS == 0) {
        canvas_line(p->c, x, y, x, y);
        canvas_stroke(p->c, size, colour);
        return;
    }
    for (int half = 0; half < 2; half++) {
        for (int k = 0; k < 3; k++) {
            const double *q = corner[which % MARKERS - 1][half == 0 ? k : (k + 2) % 4];

            at[k][0] = x + r * q[0];
            at[k][1] = y + r * q[1];
        }
        canvas_triangle(p->c, at, colour);
    }
}

static bool
is_hollow(const struct graph_series *s, size_t k)
{
    return s->point != NULL && s->point[k].hollow;
}

/* In a series of many points, of the points from k on in one column of pixels only the extremes and the last
 * are drawn. Returns the last. */
static size_t
draw_column(struct page *p, const struct graph_series *s, size_t k)
{
    const double x = x_of(p, s->x[k]);
    double lo = s->y[k], hi = lo;
    size_t last = k;

    while ((double)s->n > 8 * p->plot.w && last + 1 < s->n && is_point(p->graph, s, last + 1) &&
           floor(x_of(p, s->x[last + 1])) == floor(x)) {
        lo = fmin(lo, s->y[++last]);
        hi = fmax(hi, s->y[last]);
    }
    if (last > k) {
        canvas_draw_to(p->c, x, y_of(p, lo));
        canvas_draw_to(p->c, x, y_of(p, hi));
        canvas_draw_to(p->c, x, y_of(p, s->y[last]));
    }
    return last;
}

/* A place in fractions of the plot, upwards and to the right. */
struct spot {
    double x, y;
};

/* Cuts a segment to the plot and as much around it, since a canvas has no place for far points (Liang and
 * Barsky 1984). False: nothing is left. */
static bool
cut_segment(struct spot *a, struct spot *b)
{
    const struct spot from = *a, along = {b->x - a->x, b->y - a->y};
    const double by[4] = {-along.x, along.x, -along.y, along.y};
    const double room[4] = {from.x + 1, 2 - from.x, from.y + 1, 2 - from.y};
    double first = 0, last = 1;

    for (int k = 0; k < 4; k++) {
        if (by[k] == 0 && room[k] < 0)
            return false;
        if (by[k] < 0)
            first = fmax(first, room[k] / by[k]);
        else if (by[k] > 0)
            last = fmin(last, room[k] / by[k]);
    }
    if (first > last)
        return false;
    if (last < 1)
        *b = (struct spot){from.x + last * along.x, from.y + last * along.y};
    if (first > 0)
        *a = (struct spot){from.x + first * along.x, from.y + first * along.y};
    return true;
}

static bool
is_same_spot(const struct spot *a, const struct spot *b)
{
    return a->x == b->x && a->y == b->y;
}

/* Laws are dashed; points of different kinds are not joined. */
static void
draw_line(struct page *p, const struct graph_series *s, struct rgb colour)
{
    const struct box *plot = &p->plot;
    struct spot last = {0, 0}, pen = {0, 0};
    bool joined = false;

    for (size_t k = 0; k < s->n; k++) {
        struct spot at, from, to;
        bool begins;

        if (!is_point(p->graph, s, k)) {
            joined = false;
            continue;
        }
        at = to = (struct spot){place(&p->across, s->x[k]), place(&p->down, s->y[k])};
        begins = !joined || is_hollow(s, k) != is_hollow(s, k - 1);
        from = begins ? at : last;
        joined = true;
        last = at;
        if (!cut_segment(&from, &to))
            continue;
        if (begins || !is_same_spot(&from, &pen)) /* after a cut the pen is elsewhere */
            canvas_move(p->c, plot->x + from.x * plot->w, plot->y + (1 - from.y) * plot->h);
        canvas_draw_to(p->c, plot->x + to.x * plot->w, plot->y + (1 - to.y) * plot->h);
        pen = to;
        if (!is_same_spot(&to, &at))
            continue;
        k = draw_column(p, s, k);
        pen = last = (struct spot){place(&p->across, s->x[k]), place(&p->down, s->y[k])};
    }
    if (s->kind == GRAPH_LAW)
        canvas_dashes(p->c, 2 * p->u, 11 * p->u, colour);
    else if (s->mark > 1)
        canvas_dashes(p->c, 2.2 * p->u, (s->mark % 2 == 0 ? 16 : 6) * p->u, colour);
    else
        canvas_stroke(p->c, 2.2 * p->u, colour);
}

static struct rgb
pale(struct rgb c)
{
    return (struct rgb){(unsigned char)((c.r + 2 * 255) / 3), (unsigned char)((c.g + 2 * 255) / 3),
                        (unsigned char)((c.b + 2 * 255) / 3)};
}

static void
draw_bars(struct page *p, const struct graph_series *s, struct rgb colour)
{
    double floor_y = p->plot.y + p->plot.h;

    for (size_t k = 0; k + 1 < s->n; k++) {
        double x = round(x_of(p, s->x[k])), end = round(x_of(p, s->x[k + 1]));
        double y = y_of(p, s->y[k]);

        canvas_fill(p->c, x, y, end - x, fmax(floor_y - y, 0), pale(colour));
        if (k > 0) { /* no gap between two bars */
            y = fmax(y, y_of(p, s->y[k - 1]));
            canvas_fill(p->c, x - 1, y, 2, fmax(floor_y - y, 0), pale(colour));
        }
    }
    for (size_t k = 0; k + 1 < s->n; k++) {
        double y = y_of(p, s->y[k]);

        if (k == 0)
            canvas_move(p->c, x_of(p, s->x[0]), floor_y);
        canvas_draw_to(p->c, x_of(p, s->x[k]), y);
        canvas_draw_to(p->c, x_of(p, s->x[k + 1]), y);
    }
    if (s->n > 1)
        canvas_draw_to(p->c, x_of(p, s->x[s->n - 1]), floor_y);
    canvas_stroke(p->c, 1.6 * p->u, colour);
}

static struct rgb
colour_of(const struct graph_series *s)
{
    return s->kind == GRAPH_LAW ? page_ink : palette[s->place % GRAPH_COLOURS];
}

static double
marker_size(const struct page *p, const struct graph_series *s)
{
    return (s->n > CROWDED ? 7 : 12) * p->u;
}

static size_t
marker_of(const struct graph_series *s)
{
    return s->mark > 0 ? s->mark - 1 : s->place + s->place / GRAPH_COLOURS;
}

static void
draw_error_bars(struct page *p, const struct graph_series *s)
{
    double cap = 7 * p->u;

    for (size_t k = 0; s->low != NULL && k < s->n; k++) {
        double x, end[2];

        if (!is_point(p->graph, s, k) || !isfinite(s->low[k]) || !isfinite(s->high[k]))
            continue;
        x = x_of(p, s->x[k]);
        end[0] = y_of(p, s->low[k]);
        end[1] = y_of(p, s->high[k]);
        canvas_line(p->c, x, end[0], x, end[1]);
        for (int e = 0; e < 2; e++) {
            canvas_line(p->c, x - cap, end[e], x + cap, end[e]);
        }
    }
    if (s->low != NULL)
        canvas_stroke(p->c, 1.5 * p->u, colour_of(s));
}

static void
draw_series(struct page *p, const struct graph_series *s)
{
    struct rgb colour = colour_of(s);

    if (s->kind == GRAPH_BARS)
        draw_bars(p, s, colour);
    else if (s->kind != GRAPH_POINTS)
        draw_line(p, s, colour);
    draw_error_bars(p, s);
}

/* A triangle that points down to (x, y). */
static void
draw_sunk(struct page *p, double x, double y, struct rgb colour)
{
    double r = 8 * p->u, at[3][2] = {{x - r, y - 1.8 * r}, {x + r, y - 1.8 * r}, {x, y}};

    canvas_triangle(p->c, at, colour);
}

/* Draws the markers of a series. A marker on the frame is drawn whole. */
static void
draw_markers(struct page *p, const struct graph_series *s)
{
    for (size_t k = 0; has_markers(s) && k < s->n; k++) {
        double x, y;

        if (is_sunk(p->graph, s, k) && is_within(&p->graph->x, s->x[k]))
            draw_sunk(p, x_of(p, s->x[k]), p->plot.y + p->plot.h - 2 * p->u, colour_of(s));
        if (!is_point(p->graph, s, k))
            continue;
        x = x_of(p, s->x[k]);
        y = y_of(p, s->y[k]);
        if (x >= p->plot.x - 1 && x <= p->plot.x + p->plot.w + 1 && y >= p->plot.y - 1 &&
            y <= p->plot.y + p->plot.h + 1)
            draw_marker(p, marker_of(s), x, y, marker_size(p, s), colour_of(s));
        if (is_hollow(s, k))
            draw_marker(p, marker_of(s), x, y, 0.5 * marker_size(p, s), white);
    }
}

/* ---- the front ---- */

static void
draw_floor(struct page *p)
{
    double top = y_of(p, p->graph->floor), foot = p->plot.y + p->plot.h;
    struct canvas_font font = p->font.small;

    if (!(p->graph->floor > 0) || top >= foot - 1)
        return;
    font.colour = page_faint;
    canvas_fill(p->c, p->plot.x, top, p->plot.w, foot - top, sand);
    if (foot - top > 1.4 * font.size)
        canvas_text(p->c, &font, p->plot.x + p->plot.w - 10 * p->u, foot - 8 * p->u, 1,
                    p->graph->floor_text);
}

/* Joins the points from left to right. */
static void
draw_front(struct page *p)
{
    double last = -INFINITY;

    for (;;) {
        const struct graph_series *next = NULL;
        size_t at = 0;

        for (size_t s = 0; s < p->graph->n; s++)
            for (size_t k = 0; p->graph->series[s].point != NULL && k < p->graph->series[s].n;
                 k++) {
                const struct graph_series *q = &p->graph->series[s];
                if (q->point[k].front && q->x[k] > last &&
                    (next == NULL || q->x[k] < next->x[at])) {
                    next = q;
                    at = k;
                }
            }
        if (next == NULL)
            break;
        if (isinf(last))
            canvas_move(p->c, x_of(p, next->x[at]), y_of(p, next->y[at]));
        canvas_draw_to(p->c, x_of(p, next->x[at]), y_of(p, next->y[at]));
        last = next->x[at];
    }
    canvas_stroke(p->c, 13 * p->u, gold);
}

static bool
overlap(const struct box *a, const struct box *b)
{
    return a->x < b->x + b->w && b->x < a->x + a->w && a->y < b->y + b->h && b->y < a->y + a->h;
}

static bool
is_free(const struct page *p, const struct box *b)
{
    const double size = 14 * p->u;

    if (b->x < p->plot.x || b->x + b->w > p->plot.x + p->plot.w || b->y < p->plot.y ||
        b->y + b->h > p->plot.y + p->plot.h)
        return false;
    for (size_t k = 0; k < notes_of(p)->labels; k++)
        if (overlap(b, &notes_of(p)->taken[k]))
            return false;
    for (size_t s = 0; s < p->graph->n; s++)
        for (size_t k = 0; k < p->graph->series[s].n; k++) {
            struct box mark = {x_of(p, p->graph->series[s].x[k]) - 0.5 * size,
                               y_of(p, p->graph->series[s].y[k]) - 0.5 * size, size, size};
            if (overlap(b, &mark))
                return false;
        }
    return notes_of(p)->labels < LABELS;
}

/* A label is at the lower left of its point, where no other point of the front can be. If this place is
 * taken, the other places are tried in turn; if all are taken, the label is omitted. */
static void
draw_labels(struct page *p, const struct graph_series *s)
{
    struct canvas_font font = p->font.small;
    const double u = p->u;

    font.size *= 0.81;
    for (size_t k = 0; s->point != NULL && k < s->n; k++) {
        const char *label = s->point[k].label;
        double w = canvas_text_width(p->c, &font, label), x = x_of(p, s->x[k]),
               y = y_of(p, s->y[k]);
        struct box at[] = {{x - 10 * u - w, y + 5 * u, w, font.size},
                           {x - 12 * u - w, y - 8 * u, w, font.size},
                           {x + 11 * u, y - 8 * u, w, font.size},
                           {x + 8 * u, y - 24 * u, w, font.size}};
        size_t n = sizeof at / sizeof *at, free = 0;

        while (free < n && !is_free(p, &at[free]))
            free++;
        if (!s->point[k].front || free == n)
            continue;
        canvas_text(p->c, &font, at[free].x, at[free].y + 0.8 * font.size, 0, label);
        notes_of(p)->taken[notes_of(p)->labels++] = at[free];
    }
}

static void
draw_rules(struct page *p)
{
    for (size_t k = 0; k < p->across.marks; k++)
        if (p->across.mark[k].major)
            canvas_fill(p->c, p->plot.x + p->across.mark[k].at * p->plot.w - 0.6 * p->u, p->plot.y,
                        1.2 * p->u, p->plot.h, rule);
    for (size_t k = 0; k < p->down.marks; k++)
        if (p->down.mark[k].major)
            canvas_fill(p->c, p->plot.x,
                        p->plot.y + (1 - p->down.mark[k].at) * p->plot.h - 0.6 * p->u, p->plot.w,
                        1.2 * p->u, rule);
}

/* Dashed lines across the plot, for example at the interfaces of media. */
static void
draw_uprights(struct page *p)
{
    for (size_t k = 0; k < p->graph->uprights; k++) {
        double at = place(&p->across, p->graph->upright[k]);

        if (!(at >= 0 && at <= 1))
            continue;
        canvas_line(p->c, p->plot.x + at * p->plot.w, p->plot.y, p->plot.x + at * p->plot.w,
                    p->plot.y + p->plot.h);
    }
    canvas_dashes(p->c, 1.4 * p->u, 5 * p->u, page_faint);
}

/* ---- legend ---- */

static void
draw_swatch(struct page *p, const struct graph_series *s, double x, double y)
{
    double w = (SWATCH - 14) * p->u;
    struct rgb colour = colour_of(s);
    bool dashes = s->kind == GRAPH_LAW || s->mark > 1;

    if (s->kind == GRAPH_BARS) {
        canvas_fill(p->c, x, y - 8 * p->u, w, 16 * p->u, pale(colour));
        canvas_frame(p->c, x, y - 8 * p->u, w, 16 * p->u, 1.6 * p->u, colour);
        return;
    }
    for (int k = 0; k < (dashes ? 3 : 1) && s->kind != GRAPH_POINTS; k++) {
        canvas_line(p->c, dashes ? x + 0.37 * k * w : x, y,
                    dashes ? x + (0.37 * k + 0.26) * w : x + w, y);
    }
    if (s->kind != GRAPH_POINTS)
        canvas_stroke(p->c, 2.2 * p->u, colour);
    if (has_markers(s))
        draw_marker(p, marker_of(s), x + 0.5 * w, y, 12 * p->u, colour);
}

/* Entries after the series: points at the foot, hollow points, the front; their index over the number of
 * series. */
enum {
    SUNK,
    HOLLOW,
    FRONT
};

static void
draw_sample(struct page *p, size_t sample, double x, double y, size_t n)
{
    const double u = p->u, middle = x + 0.5 * (SWATCH - 14) * u;
    const size_t series = p->graph->n, k = sample - 1;

    y += 0.5 * (double)n;
    if (k < series) {
        draw_swatch(p, &p->graph->series[k], x, y);
    } else if (k == series + SUNK) {
        draw_sunk(p, middle, y + 7 * u, page_ink);
    } else if (k == series + HOLLOW) {
        draw_marker(p, 0, middle, y, 12 * u, page_faint);
        draw_marker(p, 0, middle, y, 6 * u, white);
    } else {
        canvas_fill(p->c, x, y - 6 * u, (SWATCH - 14) * u, 13 * u, gold);
    }
}

/* True if an earlier series has the same name and look. */
static bool
is_repeated(const struct graph *g, size_t k)
{
    const struct graph_series *s = &g->series[k];

    for (size_t i = 0; i < k; i++) {
        const struct graph_series *e = &g->series[i];

        if (s->name != NULL && e->name != NULL && strcmp(s->name, e->name) == 0 &&
            s->kind == e->kind &&
            (s->kind == GRAPH_LAW || (s->place == e->place && s->mark == e->mark)))
            return true;
    }
    return false;
}

static void
set_legend(struct page *p)
{
    const struct graph *g = p->graph;
    const struct notes *notes = notes_of(p);
    char text[LINE];

    for (size_t k = 0; k < g->n; k++)
        legend_add(p, 1 + k, is_repeated(g, k) ? NULL : g->series[k].name);
    snprintf(text, sizeof text, "%zu %s%s %s", notes->sunk, g->zero == NULL ? "point" : "case",
             notes->sunk == 1 ? "" : "s", g->zero == NULL ? "at or below 0" : g->zero);
    legend_add(p, 1 + g->n + SUNK, notes->sunk > 0 ? text : NULL);
    legend_add(p, 1 + g->n + HOLLOW, g->hollow);
    legend_add(p, 1 + g->n + FRONT, g->front);
    legend_add(p, 0, g->note);
    snprintf(text, sizeof text, "%zu %s at or below 0 left out: logarithmic axis", notes->lost,
             notes->lost == 1 ? "point" : "points");
    legend_add(p, 0, notes->lost > 0 ? text : NULL);
    snprintf(text, sizeof text, "%zu %s outside of the axes", notes->beyond,
             notes->beyond == 1 ? "point" : "points");
    legend_add(p, 0, notes->beyond > 0 ? text : NULL);
}

/* ---- the whole ---- */

static void
count_lost(const struct graph *g, struct notes *notes)
{
    for (size_t s = 0; s < g->n; s++)
        for (size_t k = 0; k < g->series[s].n && g->series[s].kind != GRAPH_BARS; k++) {
            const struct graph_series *q = &g->series[s];
            const bool point = is_point(g, q, k), sunk = is_sunk(g, q, k);
            const bool within = is_within(&g->x, q->x[k]) && (sunk || is_within(&g->y, q->y[k]));

            notes->sunk += sunk && within;
            notes->beyond += (sunk || (point && has_markers(q))) && !within;
            notes->lost += !point && !sunk && isfinite(q->x[k]) && isfinite(q->y[k]);
        }
}

static enum rc_status
lay_out(struct page *p, struct rc_err *err)
{
    double u = p->u, width = (double)p->w;

    if (set_range(&p->across, p->graph, false, err) != RC_OK ||
        set_range(&p->down, p->graph, true, err) != RC_OK)
        return RC_FAIL;
    count_lost(p->graph, notes_of(p));
    p->plot.h = round(0.56 * width);
    axis_mark(p, &p->down, p->plot.h, true);
    axis_fit_label(p, &p->down, p->plot.h);
    p->space.left = round(26 * u + 1.1 * p->font.large.size + p->down.widest + 28 * u +
                          axis_label_room(p, &p->down));
    for (int k = 0; k < 2; k++) {
        p->plot.w = round(width - p->space.left - 30 * u -
                          (p->across.words > 0 ? 0 : 0.5 * p->across.widest));
        axis_mark(p, &p->across, p->plot.w, false);
    }
    axis_fit_label(p, &p->across, p->plot.w);
    set_legend(p);
    page_settle(p, p->space.left, 22 * u,
                page_marks(p) + axis_word_room(p, &p->across) + axis_label_room(p, &p->across));
    return RC_OK;
}

static enum rc_status
draw(struct page *p, struct rc_err *err)
{
    const struct graph *g = p->graph;
    const struct box *at = &p->plot;

    (void)err;
    draw_floor(p);
    draw_rules(p);
    page_clip(p);
    draw_uprights(p);
    draw_front(p);
    for (size_t s = 0; s < g->n; s++)
        draw_series(p, &g->series[s]);
    page_clip_end(p);
    page_frame(p, at->x, at->y, at->w, at->h);
    for (size_t s = 0; s < g->n; s++)
        draw_markers(p, &g->series[s]);
    for (size_t s = 0; s < g->n; s++)
        draw_labels(p, &g->series[s]);
    axis_across(p, &p->across, at->x, at->y + at->h, at->w);
    axis_upright(p, &p->down, at->x, at->y, at->h, true, false);
    return RC_OK;
}

static const struct page_kind kind = {GRAPH_WIDTH, lay_out, draw, SWATCH, draw_sample};

enum {
    GRAPHS = 4 /* on a canvas */
};

struct canvas *
graphs_draw(const struct graph *g, size_t n, struct rc_err *err)
{
    struct notes notes[GRAPHS] = {{0}};
    struct page *p[GRAPHS] = {NULL};
    struct canvas *c = NULL;
    size_t k = 0;

    for (; k < n && k < GRAPHS && (p[k] = page_new(&kind, &notes[k], &g[k].paper, err)) != NULL;
         k++)
        p[k]->graph = &g[k];
    if (k == n)
        c = pages_draw(p, n, err);
    for (k = 0; k < GRAPHS; k++)
        free(p[k]);
    return c;
}

struct canvas *
graph_draw(const struct graph *g, struct rc_err *err)
{
    return graphs_draw(g, 1, err);
}
