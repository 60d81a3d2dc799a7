/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The axes of maps, colour bars and graphs: their marks and their drawing.
 */
#include <math.h>
#include <stdio.h>

#include "page.h"

double
axis_place(const struct axis *a, double value)
{
    if (a->log)
        value = value > 0 ? log10(value) : -INFINITY;
    return (value - a->lo) / (a->hi - a->lo);
}

/* ---- marks ---- */

static void
add_mark(struct axis *a, double value, bool major, const char *text)
{
    const double at = axis_place(a, value);

    if (a->marks == MARKS || !(at >= -1e-9 && at <= 1 + 1e-9))
        return;
    a->mark[a->marks].value = value;
    a->mark[a->marks].at = at;
    a->mark[a->marks].major = major;
    snprintf(a->mark[a->marks++].text, TICKS_TEXT, "%.60s", text);
}

/* Marks at steps of 1, 2 or 5, which minor marks divide into 5, 4 and 5 parts. */
static void
mark_steps(struct axis *a)
{
    const struct ticks *t = &a->ticks;
    const int parts = !a->minor ? 1 : t->digit == 2 ? 4 : 5;

    a->marks = 0;
    for (long long k = t->first - 1; k <= t->last; k++)
        for (int m = 0; m < parts; m++)
            add_mark(a, ticks_at(t, k) + m * ticks_at(t, 1) / parts, m == 0,
                     m == 0 ? ticks_text(t, k) : "");
}

/* Marks at powers of ten, with minor marks at 2 to 9 times each; with few powers 2 and 5 have a number too.
 * Numbers are written without exponents if all of them are short. */
static void
mark_decades(struct axis *a, double most)
{
    const int step = (int)ceil((a->hi - a->lo) / most);
    const bool plain = a->lo > -3.5 && a->hi < 4.5, few = a->hi - a->lo < 2.5;

    a->marks = 0;
    for (int k = (int)floor(a->lo); k <= (int)ceil(a->hi); k++)
        for (int d = 1; d < 10; d++) {
            const struct ticks t = {.digit = d, .power = k};
            const bool major = d == 1 ? k % step == 0 : few && plain && (d == 2 || d == 5);

            if (d == 1 || a->hi - a->lo <= 12)
                add_mark(a, ticks_at(&t, 1), major,
                         !major  ? ""
                         : plain ? ticks_text(&t, 1)
                                 : power_text(k));
        }
}

/* Omits numbers that would touch the previous one. Returns true if it omitted any. */
static bool
thin_marks(struct page *p, struct axis *a, double length, bool upright)
{
    double end = -INFINITY, gap = 12 * p->u;
    bool thinned = false;

    a->widest = 0;
    for (size_t k = 0; k < a->marks; k++) {
        double w, half, at = a->mark[k].at * length;

        if (a->mark[k].text[0] == '\0')
            continue;
        w = canvas_text_width(p->c, &p->font.small, a->mark[k].text);
        half = upright ? 0.55 * p->font.small.size : 0.5 * (w + gap);
        if (at - half < end) {
            a->mark[k].text[0] = '\0';
            thinned = true;
            continue;
        }
        end = at + half;
        a->widest = fmax(a->widest, w);
    }
    return thinned;
}

/* Words are horizontal if they fit, otherwise vertical. */
static void
mark_words(struct page *p, struct axis *a, double length)
{
    double slot = length / (double)a->words - 8 * p->u;
    char text[LINE];

    a->widest = 0;
    for (size_t k = 0; k < a->words; k++)
        a->widest = fmax(a->widest, canvas_text_width(p->c, &p->font.small, a->word[k]));
    a->upwards = a->widest > slot;
    a->widest = fmin(a->widest, a->upwards ? 0.6 * length : slot);
    a->marks = 0;
    for (size_t k = 0; k < a->words; k++) {
        snprintf(text, sizeof text, "%s", a->word[k]);
        page_shorten(p, &p->font.small, a->widest + 1, text);
        add_mark(a, (double)k, true, text);
    }
}

void
axis_mark(struct page *p, struct axis *a, double length, bool upright)
{
    double most = fmin(9, a->minor ? length / (p->font.small.size * (upright ? 2 : 4.5)) : 9);
    bool thinned = true;

    if (a->words > 0) {
        mark_words(p, a, length);
        return;
    }
    if (a->log && a->hi - a->lo >= 1) {
        mark_decades(a, most);
        thin_marks(p, a, length, upright);
        return;
    }
    for (; thinned && most > 1e-3; most = most > 1 ? most - 1 : 0.5 * most) {
        ticks_choose(&a->ticks, a->log ? pow(10, a->lo) : a->lo, a->log ? pow(10, a->hi) : a->hi,
                     most);
        mark_steps(a);
        thinned = thin_marks(p, a, length, upright) && !a->minor;
    }
}

/* Both axes get one step, unless one of them would then have too few marks. */
void
axis_even_steps(struct page *p, struct axis *coarse, struct axis *fine, double length, bool upright)
{
    struct ticks t;

    ticks_choose(&t, fine->lo, fine->hi, (fine->hi - fine->lo) / ticks_at(&coarse->ticks, 1));
    if (t.last - t.first < 2)
        return;
    fine->ticks = t;
    mark_steps(fine);
    thin_marks(p, fine, length, upright);
}

/* ---- label ---- */

/* The number of bytes, up to a blank, of the longest beginning of text that fits; 0: not even a word. */
static size_t
words_that_fit(struct page *p, const char *text, double length)
{
    char trial[LINE];

    for (size_t n = strlen(text); n > 0; n--) {
        if (text[n] != '\0' && text[n] != ' ')
            continue;
        snprintf(trial, sizeof trial, "%.*s", (int)n, text);
        if (canvas_text_width(p->c, &p->font.large, trial) <= length)
            return n;
    }
    return 0;
}

void
axis_fit_label(struct page *p, struct axis *a, double length)
{
    const struct canvas_font *font = &p->font.large;
    char unit[LINE] = "";
    const char *bracket;
    size_t n;

    a->more[0] = '\0';
    if (canvas_text_width(p->c, font, a->label) <= length)
        return;
    if ((n = words_that_fit(p, a->label, length)) == 0) {
        page_shorten(p, font, length, a->label);
        return;
    }
    snprintf(a->more, sizeof a->more, "%s", a->label + n + 1);
    a->label[n] = '\0';
    if (canvas_text_width(p->c, font, a->more) <= length)
        return;
    snprintf(unit, sizeof unit, " (%s", a->scale.unit);
    if (a->scale.unit[0] != '\0' && (bracket = strstr(a->more, unit)) != NULL) {
        snprintf(unit, sizeof unit, "%s", bracket);
        a->more[bracket - a->more] = '\0';
    } else {
        unit[0] = '\0';
    }
    page_shorten(p, font, length - canvas_text_width(p->c, font, unit), a->more);
    n = strlen(a->more);
    snprintf(a->more + n, sizeof a->more - n, "%s", unit);
}

double
axis_label_room(const struct page *p, const struct axis *a)
{
    return a->more[0] == '\0' ? 0 : 1.2 * p->font.large.size;
}

/* ---- drawing ---- */

/* The additional height below a plot of words that read upwards. */
double
axis_word_room(const struct page *p, const struct axis *a)
{
    return a->upwards ? a->widest - p->font.small.size : 0;
}

/* Length in pixels of the marks with a number, slightly longer if there are minor marks. */
static double
reach(const struct page *p, const struct axis *a)
{
    return (a->minor ? 9 : 8) * p->u;
}

void
axis_across(struct page *p, const struct axis *a, double x, double y, double w)
{
    const double u = p->u, size = p->font.small.size, low = y + reach(p, a) + 4 * u;

    for (size_t k = 0; k < a->marks; k++) {
        const char *text = a->mark[k].text;
        double at = x + a->mark[k].at * w;

        canvas_fill(p->c, at - 0.8 * u, y, 1.6 * u, a->mark[k].major ? reach(p, a) : 5 * u,
                    page_ink);
        if (a->upwards)
            canvas_text_upwards(p->c, &p->font.small, at + 0.36 * size,
                                low + 0.5 * canvas_text_width(p->c, &p->font.small, text), text);
        else if (*text != '\0')
            canvas_text(p->c, &p->font.small, at, low + 0.78 * size, 0.5, text);
    }
    canvas_text(p->c, &p->font.large, x + 0.5 * w,
                low + axis_word_room(p, a) + size + 1.1 * p->font.large.size, 0.5, a->label);
    if (a->more[0] != '\0')
        canvas_text(p->c, &p->font.large, x + 0.5 * w,
                    low + axis_word_room(p, a) + size + 2.3 * p->font.large.size, 0.5, a->more);
}

void
axis_upright(struct page *p, const struct axis *a, double x, double y, double h, bool left,
             bool rises_down)
{
    const double u = p->u, out = reach(p, a) + 5 * u;
    const double label =
        14 * u + a->widest + (left ? (a->minor ? 12 : 10) * u : 1.35 * p->font.large.size);

    for (size_t k = 0; k < a->marks; k++) {
        double at = y + (rises_down ? a->mark[k].at : 1 - a->mark[k].at) * h;
        double length = a->mark[k].major ? reach(p, a) : 5 * u;

        canvas_fill(p->c, left ? x - length : x, at - 0.8 * u, length, 1.6 * u, page_ink);
        if (a->mark[k].text[0] != '\0')
            canvas_text(p->c, &p->font.small, left ? x - out : x + out + a->widest,
                        at + 0.36 * p->font.small.size, 1, a->mark[k].text);
    }
    if (left && a->more[0] != '\0')
        canvas_text_upwards(p->c, &p->font.large, x - label, y + 0.5 * h, a->more);
    canvas_text_upwards(p->c, &p->font.large, left ? x - label - axis_label_room(p, a) : x + label,
                        y + 0.5 * h, a->label);
}
