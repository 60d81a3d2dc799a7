/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The legend at the foot of a picture: texts side by side, most with a sample of what they explain.
 */
#include <math.h>
#include <stdio.h>

#include "page.h"

static double
sample_width(const struct page *p, size_t sample)
{
    return sample == 0 ? 0 : p->kind->sample_w * p->u;
}

static double
legend_width(const struct page *p)
{
    return (double)p->w - 48 * p->u;
}

static double
entry_width(const struct page *p, const struct entry *e)
{
    return sample_width(p, e->sample) + canvas_text_width(p->c, &p->font.small, e->text);
}

void
legend_add(struct page *p, size_t sample, const char *text)
{
    struct text lines = {.n = 0};

    if (text != NULL)
        page_wrap(p, &p->font.small, legend_width(p) - sample_width(p, sample), BETWEEN, text,
                  &lines);
    for (size_t k = 0; k < lines.n && p->legend.entries < ENTRIES; k++) {
        struct entry *e = &p->legend.entry[p->legend.entries++];

        e->sample = k == 0 ? sample : 0;
        snprintf(e->text, sizeof e->text, "%s", lines.line[k]);
    }
}

void
legend_place(struct page *p)
{
    double x = 0, y = 0, line = 1.55 * p->font.small.size;

    for (struct entry *e = p->legend.entry; e < p->legend.entry + p->legend.entries; e++) {
        const double w = entry_width(p, e);

        if (x > 0 && x + w > legend_width(p)) {
            x = 0;
            y += line;
        }
        e->x = x;
        e->y = y;
        x += w + 36 * p->u;
    }
    p->legend.h = p->legend.entries == 0 ? 0 : y + line + 10 * p->u;
}

void
legend_draw(struct page *p)
{
    const double u = p->u, side = p->font.small.size;
    double last = p->legend.entries == 0 ? 0 : p->legend.entry[p->legend.entries - 1].y, width = 0,
           x, y;

    for (size_t k = 0; k < p->legend.entries; k++)
        width = fmax(width, p->legend.entry[k].x + entry_width(p, &p->legend.entry[k]));
    x = 0.5 * ((double)p->w - width);
    y = p->space.top + (double)p->h - 22 * u - last - 1.55 * side;
    for (const struct entry *e = p->legend.entry; e < p->legend.entry + p->legend.entries; e++) {
        double left = round(x + e->x), top = round(y + e->y);

        if (e->sample != 0)
            p->kind->sample(p, e->sample, left, top, (size_t)round(side));
        canvas_text(p->c, &p->font.small, left + sample_width(p, e->sample), top + 0.86 * side, 0,
                    e->text);
    }
}
