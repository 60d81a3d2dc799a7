#include "chart.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "ticks.h"

static const struct rgb ink = {0x22, 0x22, 0x22}, faint = {0x59, 0x59, 0x59},
                        rule = {0xdd, 0xdd, 0xdd}, pale = {0xf3, 0xf1, 0xec},
                        gold = {0xf4, 0xd0, 0x6f}, white = {255, 255, 255};
static const struct canvas_font heading = {28, true, {0x22, 0x22, 0x22}},
                                subheading = {20, false, {0x59, 0x59, 0x59}},
                                large = {23, false, {0x22, 0x22, 0x22}},
                                small = {21, false, {0x22, 0x22, 0x22}},
                                tiny = {17, false, {0x22, 0x22, 0x22}};

enum {
    LEFT = 130,
    RIGHT = 40,
    TOP = 112,
    PLOT = 620,  /* height of the plot       */
    MARKS = 78,  /* what is written under it */
    LEGEND = 36, /* a line of the legend     */
    BELOW = 18,
    LABELS = 64
};

struct range {
    double lo, hi; /* decimal logarithms */
};

struct box {
    double x, y, w, h;
};

struct panel {
    struct canvas *c;
    const struct chart *chart;
    struct range across, up;
    double x, y, w, h;
    struct box taken[LABELS]; /* by labels */
    size_t labels;
};

/* ---- axes ---- */

static void
stretch(struct range *r, double value)
{
    r->lo = fmin(r->lo, log10(value));
    r->hi = fmax(r->hi, log10(value));
}

static void
set_ranges(struct panel *p)
{
    const double lowest = 1e-15;
    struct range none = {INFINITY, -INFINITY};

    p->across = p->up = none;
    for (size_t s = 0; s < p->chart->n; s++)
        for (size_t k = 0; k < p->chart->series[s].n; k++) {
            stretch(&p->across, p->chart->series[s].point[k].x);
            stretch(&p->up,
                    fmax(p->chart->series[s].point[k].y, fmax(lowest, p->chart->floor / 10)));
        }
    if (p->across.lo > p->across.hi)
        p->across = p->up = (struct range){-1, 0};
    p->across.lo -= 0.08 + 0.04 * (p->across.hi - p->across.lo);
    p->across.hi += 0.12 + 0.04 * (p->across.hi - p->across.lo);
    p->up.lo = floor(p->up.lo - 0.1);
    p->up.hi = ceil(p->up.hi + 0.1);
}

static double
across(const struct panel *p, double x)
{
    return p->x + (log10(x) - p->across.lo) / (p->across.hi - p->across.lo) * p->w;
}

static double
up(const struct panel *p, double y)
{
    double t = (log10(fmax(y, 1e-300)) - p->up.lo) / (p->up.hi - p->up.lo);

    return p->y + (1 - fmin(fmax(t, 0), 1)) * p->h;
}

static void
draw_up(struct panel *p)
{
    int step = p->up.hi - p->up.lo > 10 ? 2 : 1;
    char text[TICKS_TEXT];

    for (int k = (int)p->up.lo; k <= (int)p->up.hi; k++) {
        double at = up(p, pow(10, k));

        canvas_fill(p->c, p->x, at - 0.6, p->w, 1.2, rule);
        if ((k - (int)p->up.hi) % step != 0)
            continue;
        canvas_fill(p->c, p->x - 8, at - 0.8, 8, 1.6, ink);
        canvas_text(p->c, &small, p->x - 14, at + 0.36 * small.size, 1,
                    k == 0 ? "1" : power_text(text, k));
    }
    canvas_text_upwards(p->c, &large, p->x - 88, p->y + 0.5 * p->h, p->chart->up);
}

/* Marks at 1, 2, 5 times powers of ten; over many decades at the powers only. */
static void
draw_across(struct panel *p)
{
    static const int digits[] = {1, 2, 5};
    bool many = p->across.hi - p->across.lo > 4.5;
    char text[32];

    for (int k = (int)floor(p->across.lo); k <= (int)ceil(p->across.hi); k++)
        for (int d = 0; d < (many ? 1 : 3); d++) {
            double value = digits[d] * pow(10, k), at = across(p, value);

            if (at < p->x || at > p->x + p->w)
                continue;
            snprintf(text, sizeof text, "%g", value);
            canvas_fill(p->c, at - 0.6, p->y, 1.2, p->h, rule);
            canvas_fill(p->c, at - 0.8, p->y + p->h, 1.6, 8, ink);
            canvas_text(p->c, &small, at, p->y + p->h + 12 + 0.78 * small.size, 0.5, text);
        }
    canvas_text(p->c, &large, p->x + 0.5 * p->w, p->y + p->h + 12 + small.size + 1.1 * large.size,
                0.5, p->chart->across);
}

static void
draw_floor(struct panel *p)
{
    double top;

    if (!(p->chart->floor > 0))
        return;
    top = up(p, p->chart->floor);
    if (top >= p->y + p->h - 1)
        return;
    canvas_fill(p->c, p->x, top, p->w, p->y + p->h - top, pale);
    if (p->y + p->h - top > 1.4 * tiny.size)
        canvas_text(p->c, &(struct canvas_font){tiny.size, false, faint}, p->x + p->w - 10,
                    p->y + p->h - 8, 1, p->chart->floor_text);
}

/* ---- points ---- */

static void
dot(struct panel *p, double x, double y, double size, struct rgb colour)
{
    canvas_move(p->c, x, y);
    canvas_draw_to(p->c, x, y);
    canvas_stroke(p->c, size, colour);
}

/* Joins the points of the front from left to right. */
static void
draw_front(struct panel *p)
{
    double last = -INFINITY;
    bool down = false;

    for (;;) {
        const struct chart_point *next = NULL;

        for (size_t s = 0; s < p->chart->n; s++)
            for (size_t k = 0; k < p->chart->series[s].n; k++) {
                const struct chart_point *q = &p->chart->series[s].point[k];
                if (q->front && q->x > last && (next == NULL || q->x < next->x))
                    next = q;
            }
        if (next == NULL)
            break;
        if (!down)
            canvas_move(p->c, across(p, next->x), up(p, next->y));
        canvas_draw_to(p->c, across(p, next->x), up(p, next->y));
        down = true;
        last = next->x;
    }
    canvas_stroke(p->c, 13, gold);
}

static void
draw_series(struct panel *p, const struct chart_series *s)
{
    for (size_t k = 0; k < s->n; k++)
        if (k == 0 || s->point[k].hollow != s->point[k - 1].hollow)
            canvas_move(p->c, across(p, s->point[k].x), up(p, s->point[k].y));
        else
            canvas_draw_to(p->c, across(p, s->point[k].x), up(p, s->point[k].y));
    canvas_stroke(p->c, 1.6, s->colour);
    for (size_t k = 0; k < s->n; k++) {
        double x = across(p, s->point[k].x), y = up(p, s->point[k].y);

        dot(p, x, y, 14, s->colour);
        if (s->point[k].hollow)
            dot(p, x, y, 7.5, white);
    }
}

static bool
overlap(const struct box *a, const struct box *b)
{
    return a->x < b->x + b->w && b->x < a->x + a->w && a->y < b->y + b->h && b->y < a->y + a->h;
}

static bool
place_free(struct panel *p, const struct box *b)
{
    if (b->x < p->x || b->x + b->w > p->x + p->w || b->y < p->y || b->y + b->h > p->y + p->h)
        return false;
    for (size_t k = 0; k < p->labels; k++)
        if (overlap(b, &p->taken[k]))
            return false;
    for (size_t s = 0; s < p->chart->n; s++)
        for (size_t k = 0; k < p->chart->series[s].n; k++) {
            const struct chart_point *q = &p->chart->series[s].point[k];
            struct box dots = {across(p, q->x) - 7, up(p, q->y) - 7, 14, 14};
            if (overlap(b, &dots))
                return false;
        }
    return p->labels < LABELS;
}

/* A label is put to the lower left of its point, where no other point of the front can lie, or,
 * where that place is taken, at one of the others in turn; where all are taken it is left out. */
static void
draw_label(struct panel *p, const struct chart_point *q)
{
    double w = canvas_text_width(p->c, &tiny, q->label), x = across(p, q->x), y = up(p, q->y);
    struct box at[] = {{x - 10 - w, y + 5, w, tiny.size},
                       {x - 12 - w, y - 8, w, tiny.size},
                       {x + 11, y - 8, w, tiny.size},
                       {x + 8, y - 24, w, tiny.size}};

    for (size_t k = 0; k < sizeof at / sizeof *at; k++)
        if (place_free(p, &at[k])) {
            canvas_text(p->c, &tiny, at[k].x, at[k].y + 0.8 * tiny.size, 0, q->label);
            p->taken[p->labels++] = at[k];
            return;
        }
}

/* ---- the legend ---- */

/* Lays its entries side by side, line by line; draws them when asked to. Returns the lines. */
static size_t
legend(struct canvas *c, const struct chart *chart, double y, bool draw)
{
    double x = LEFT, right = CHART_WIDTH - RIGHT;
    size_t lines = 1;
    struct panel p = {.c = c, .chart = chart};

    for (size_t s = 0; s < chart->n + 2; s++) {
        bool hollow = s == chart->n, front = s == chart->n + 1;
        const char *text = hollow  ? chart->hollow
                           : front ? "front: nothing is both quicker and nearer"
                                   : chart->series[s].name;
        double w;

        if (text == NULL)
            continue;
        w = 30 + canvas_text_width(c, &small, text);
        if (x > LEFT && x + w > right) {
            x = LEFT;
            lines++;
        }
        if (draw) {
            double at = y + LEGEND * ((double)lines - 0.5);
            if (front)
                canvas_fill(c, x - 4, at - 6, 26, 13, gold);
            else
                dot(&p, x + 9, at, 14, hollow ? faint : chart->series[s].colour);
            if (hollow)
                dot(&p, x + 9, at, 7.5, white);
            canvas_text(c, &small, x + 30, at + 0.36 * small.size, 0, text);
        }
        x += w + 34;
    }
    return lines;
}

/* ---- the whole ---- */

double
chart_height(struct canvas *c, const struct chart *chart)
{
    return TOP + PLOT + MARKS + LEGEND * (double)legend(c, chart, 0, false) + BELOW;
}

void
chart_draw(struct canvas *c, double y, const struct chart *chart)
{
    struct panel p = {.c = c,
                      .chart = chart,
                      .x = LEFT,
                      .y = y + TOP,
                      .w = CHART_WIDTH - LEFT - RIGHT,
                      .h = PLOT};

    set_ranges(&p);
    canvas_text(c, &heading, 0.5 * CHART_WIDTH, y + 24 + heading.size, 0.5, chart->title);
    canvas_text(c, &subheading, 0.5 * CHART_WIDTH, y + 24 + 1.3 * heading.size + subheading.size,
                0.5, chart->subtitle);
    draw_floor(&p);
    draw_up(&p);
    draw_across(&p);
    canvas_clip(c, p.x, p.y, p.w, p.h);
    draw_front(&p);
    for (size_t s = chart->n; s-- > 0;) /* the first above the others */
        draw_series(&p, &chart->series[s]);
    canvas_clip(c, 0, 0, 0, 0);
    for (size_t s = 0; s < chart->n; s++)
        for (size_t k = 0; k < chart->series[s].n; k++)
            if (chart->series[s].point[k].front)
                draw_label(&p, &chart->series[s].point[k]);
    canvas_frame(c, p.x, p.y, p.w, p.h, 1, ink);
    legend(c, chart, p.y + p.h + MARKS, true);
}
