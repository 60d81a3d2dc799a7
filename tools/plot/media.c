/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The media of a section: a line at each interface, and beside the plot the number of each medium, which the
 * legend explains.
 */
#include <math.h>
#include <stdio.h>

#include "page.h"

static const struct rgb light = {0xff, 0xff, 0xff};

/* Lines at smaller distances would merge, in units of the design. */
static const double apart = 4;

size_t
media_seen(const struct figure *f, size_t *first)
{
    size_t n = 0;

    *first = 0;
    for (size_t k = 0; k < f->media; k++) {
        double top = k == 0 ? 0 : f->medium[k - 1].bottom;

        if (f->medium[k].bottom <= f->at.top)
            *first = k + 1;
        else if (top < f->at.bottom)
            n++;
    }
    return n;
}

static struct canvas_font
number_font(const struct page_fonts *fonts)
{
    struct canvas_font font = fonts->small;

    font.bold = true;
    return font;
}

static double
number_height(const struct page_fonts *font)
{
    return 1.1 * font->small.size;
}

double
media_gutter(const struct page *p)
{
    struct canvas_font font = number_font(&p->font);
    size_t first, n = media_seen(p->f, &first);
    double widest = 0;
    char text[32];

    if (n == 0 || n > MEDIA_TOLD || (double)n * number_height(&p->font) > p->plot.h)
        return 0;
    for (size_t k = first; k < first + n; k++) {
        snprintf(text, sizeof text, "%zu", k + 1);
        widest = fmax(widest, canvas_text_width(p->c, &font, text));
    }
    return 24 * p->u + widest;
}

/* The position of a depth on the page, inside the plot. */
static double
place(const struct page *p, double depth)
{
    const struct figure *f = p->f;
    double t = (depth - f->at.top) / (f->at.bottom - f->at.top);

    return p->plot.y + fmin(fmax(t, 0), 1) * p->plot.h;
}

/* Dark with a light rim, visible on every colour. */
static void
draw_line(struct page *p, double y)
{
    for (int layer = 0; layer < 2; layer++) {
        canvas_line(p->c, p->plot.x, y, (p->plot.x + p->plot.w), y);
        canvas_stroke(p->c, (layer == 0 ? 3 : 1.2) * p->u, layer == 0 ? light : page_ink);
    }
}

/* Draws the lowest line, the surface of the substrate, first, then from the top the lines that are not too
 * near to a drawn one. */
static void
draw_lines(struct page *p, size_t first, size_t n)
{
    double lowest = place(p, p->f->medium[first + n - 2].bottom), last = -INFINITY;

    draw_line(p, lowest);
    for (size_t k = first; k + 2 < first + n; k++) {
        double y = place(p, p->f->medium[k].bottom);

        if (fmin(y - last, lowest - y) < apart * p->u)
            continue;
        draw_line(p, y);
        last = y;
    }
}

/* Each number is at the middle of its medium; for thin media the numbers move apart, inside the plot. */
static void
draw_numbers(struct page *p, size_t first, size_t n)
{
    double at[MEDIA_TOLD], middle[MEDIA_TOLD], high = number_height(&p->font), u = p->u;
    double x = (p->plot.x + p->plot.w), bottom = (p->plot.y + p->plot.h);
    struct canvas_font font = number_font(&p->font);
    char text[32];

    for (size_t k = 0; k < n; k++) {
        double top = first + k == 0 ? 0 : p->f->medium[first + k - 1].bottom;

        middle[k] = 0.5 * (place(p, top) + place(p, p->f->medium[first + k].bottom));
        at[k] = fmax(middle[k], k == 0 ? p->plot.y + 0.5 * high : at[k - 1] + high);
    }
    for (size_t k = n; k-- > 0;)
        at[k] = fmin(at[k], k + 1 == n ? bottom - 0.5 * high : at[k + 1] - high);
    for (size_t k = 0; k < n; k++) {
        canvas_move(p->c, x + 2 * u, middle[k]);
        canvas_draw_to(p->c, x + 6 * u, middle[k]);
        canvas_draw_to(p->c, x + 14 * u, at[k]);
        canvas_stroke(p->c, 1.4 * u, page_ink);
        snprintf(text, sizeof text, "%zu", first + k + 1);
        canvas_text(p->c, &font, x + 18 * u, at[k] + 0.36 * font.size, 0, text);
    }
}

void
media_draw(struct page *p)
{
    size_t first, n = media_seen(p->f, &first);

    page_clip(p);
    if (n > 1)
        draw_lines(p, first, n);
    page_clip_end(p);
    if (p->space.gutter > 0)
        draw_numbers(p, first, n);
}
