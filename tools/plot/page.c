/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "page.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SMALL 21 /* size of the marks for a design unit of 1 */
#define CUT "\xe2\x80\xa6"

const struct rgb page_alarm = {0xb0, 0x1e, 0x1e};
const struct rgb page_ink = {0x22, 0x22, 0x22}, page_faint = {0x59, 0x59, 0x59};

/* ---- text ---- */

/* Bytes of the longest beginning of text[0..n) that does not end inside a character. */
static size_t
whole_characters(const char *text, size_t n)
{
    while (n > 0 && ((unsigned char)text[n] & 0xc0) == 0x80)
        n--;
    return n;
}

static void
copy_text(char line[LINE], const char *text, size_t n)
{
    n = n < LINE ? n : whole_characters(text, LINE - 1);
    for (size_t k = 0; k < n; k++) {
        unsigned char byte = (unsigned char)text[k];
        line[k] = byte < 0x20 || byte == 0x7f ? ' ' : text[k];
    }
    line[n] = '\0';
}

/* Cuts after a word, unless the first word is already too long. */
void
page_shorten(struct page *p, const struct canvas_font *font, double width, char line[LINE])
{
    size_t n = strlen(line);

    if (canvas_text_width(p->c, font, line) <= width)
        return;
    n = n < LINE - 4 ? n : LINE - 4;
    do {
        size_t word = n - 1;

        while (word > 0 && line[word] != ' ')
            word--;
        while (word > 0 && line[word - 1] == ' ')
            word--;
        n = word > 0 ? word : whole_characters(line, n - 1);
        strcpy(line + n, CUT);
    } while (n > 0 && canvas_text_width(p->c, font, line) > width);
}

static size_t
piece(const char *text, const char *separator)
{
    const char *end = strstr(text, separator);

    return end == NULL ? strlen(text) : (size_t)(end - text);
}

/* Bytes of the pieces of the text that fit on a line, at least one piece. */
static size_t
fit(struct page *p, const struct canvas_font *font, double width, const char *separator,
    const char *text)
{
    size_t gap = strlen(separator), n = piece(text, separator);
    char trial[LINE];

    while (text[n] != '\0') {
        size_t next = n + gap + piece(text + n + gap, separator);

        copy_text(trial, text, next);
        if (next >= LINE || canvas_text_width(p->c, font, trial) > width)
            break;
        n = next;
    }
    return n;
}

/* Breaks text at the separators into lines; a piece that is too long for a line is broken between words. The
 * last line is cut if necessary. */
void
page_wrap(struct page *p, const struct canvas_font *font, double width, const char *separator,
          const char *text, struct text *t)
{
    for (t->n = 0; *text != '\0' && t->n < LINES; t->n++) {
        size_t n = t->n + 1 < LINES ? fit(p, font, width, separator, text) : strlen(text);

        copy_text(t->line[t->n], text, n);
        if (t->n + 1 < LINES && canvas_text_width(p->c, font, t->line[t->n]) > width) {
            n = fit(p, font, width, " ", text);
            copy_text(t->line[t->n], text, n);
        }
        page_shorten(p, font, width, t->line[t->n]);
        text += text[n] == '\0'                                        ? n
                : strncmp(text + n, separator, strlen(separator)) == 0 ? n + strlen(separator)
                                                                       : n + 1;
    }
}

/* ---- heading ---- */

static double
longest_word(struct canvas *c, const struct canvas_font *font, const char *text)
{
    char word[LINE];
    double longest = 1;

    while (*text != '\0') {
        size_t n = piece(text, " ");

        copy_text(word, text, n);
        longest = fmax(longest, canvas_text_width(c, font, word));
        text += text[n] == '\0' ? n : n + 1;
    }
    return longest;
}

/* Breaks title and subtitle into lines; a title with a word that is too long for a line gets smaller. */
static void
break_words(struct page *p, double width)
{
    p->font.heading.size *=
        fmin(1, fmax(0.5, width / longest_word(p->c, &p->font.heading, p->paper->title)));
    page_wrap(p, &p->font.heading, width, " ", p->paper->title, &p->title);
    page_wrap(p, &p->font.subheading, width, BETWEEN, p->paper->subtitle, &p->subtitle);
}

static double
heading_height(const struct page *p)
{
    const double stamp = p->paper->stamp == NULL ? 0 : 2.1 * p->font.stamp.size;

    return 24 * p->u + stamp + 1.3 * p->font.heading.size * (double)p->title.n +
           1.4 * p->font.subheading.size * (double)p->subtitle.n;
}

/* The stamp is above the plot, where it covers no data. */
static void
draw_stamp(struct page *p, double middle, double y)
{
    double size = p->font.stamp.size, w, line = fmax(2, round(2.4 * p->u));

    if (p->paper->stamp == NULL)
        return;
    w = canvas_text_width(p->c, &p->font.stamp, p->paper->stamp) + 1.6 * size;
    y += 0.4 * size;
    canvas_frame(p->c, round(middle - 0.5 * w), round(y), round(w), round(1.55 * size), line,
                 page_alarm);
    canvas_text(p->c, &p->font.stamp, middle, y + 1.12 * size, 0.5, p->paper->stamp);
}

static void
draw_heading(struct page *p)
{
    double y = p->space.top + 24 * p->u, middle = 0.5 * (double)p->w;

    for (size_t k = 0; k < p->title.n; k++) {
        canvas_text(p->c, &p->font.heading, middle, y + p->font.heading.size, 0.5,
                    p->title.line[k]);
        y += 1.3 * p->font.heading.size;
    }
    for (size_t k = 0; k < p->subtitle.n; k++) {
        canvas_text(p->c, &p->font.subheading, middle, y + p->font.subheading.size, 0.5,
                    p->subtitle.line[k]);
        y += 1.4 * p->font.subheading.size;
    }
    draw_stamp(p, middle, y);
}

/* ---- the page around a plot ---- */

void
page_settle(struct page *p, double left, double above, double below)
{
    break_words(p, (double)p->w - 48 * p->u);
    legend_place(p);
    above += heading_height(p);
    p->plot.x = round(left);
    p->plot.y = round(above);
    p->h = (size_t)ceil(above + p->plot.h + below + p->legend.h + 22 * p->u);
}

void
page_frame(const struct page *p, double x, double y, double w, double h)
{
    canvas_frame(p->c, x, y, w, h, fmax(1, round(1.2 * p->u)), page_ink);
}

/* ---- axes ---- */

static void
set_axis(struct axis *a, const char *quantity, const char *unit, double lo, double hi,
         double largest)
{
    if (a->log && log10(hi / lo) > 3 + 1e-9)
        scale_keep(&a->scale, unit);
    else
        scale_choose(&a->scale, largest, unit);
    a->lo = a->log ? log10(lo / a->scale.size) : lo / a->scale.size;
    a->hi = a->log ? log10(hi / a->scale.size) : hi / a->scale.size;
    scale_label(a->label, sizeof a->label, quantity, &a->scale);
}

/* If both axes of a map have one unit they get one step. */
static void
mark_map(struct page *p)
{
    const double w = p->plot.w, h = p->plot.h;

    axis_mark(p, &p->across, w, false);
    axis_mark(p, &p->down, h, true);
    if (strcmp(p->across.scale.unit, p->down.scale.unit) != 0)
        return;
    if (ticks_at(&p->across.ticks, 1) < ticks_at(&p->down.ticks, 1))
        axis_even_steps(p, &p->down, &p->across, w, false);
    else
        axis_even_steps(p, &p->across, &p->down, h, true);
}

/* Gives both axes of a map one unit, unless one axis is too short for it. */
static void
set_axes(struct page *p)
{
    const struct figure *f = p->f;
    double x = fmax(fabs(f->at.left), fabs(f->at.right)),
           y = fmax(fabs(f->at.top), fabs(f->at.bottom));
    double both = fmax(x, y);
    const char *unit = f->at.dunit == NULL ? "m" : f->at.dunit;

    p->values.log = f->bar.log;
    set_axis(&p->values, f->bar.quantity, f->bar.unit, f->bar.lo, f->bar.hi,
             fmax(fabs(f->bar.lo), fabs(f->bar.hi)));
    set_axis(&p->across, f->at.across, unit, f->at.left, f->at.right,
             f->at.section || x < 0.01 * both ? x : both);
    set_axis(&p->down, f->at.down, unit, f->at.top, f->at.bottom,
             f->at.section || y < 0.01 * both ? y : both);
}

/* ---- layout ---- */

double
page_marks(const struct page *p)
{
    return 14 * p->u + p->font.small.size + 1.5 * p->font.large.size;
}

double
page_bar_right(const struct page *p)
{
    return fmax(28 * p->u + p->space.gutter, 0.5 * p->across.widest + 10 * p->u);
}

/* Distance from the right edge of the plot to the right edge of the page. */
static double
right_of_plot(const struct page *p)
{
    if (p->f->nodes.is != NULL)
        return 24 * p->u + fmax(0.5 * p->across.widest, p->space.gutter);
    return page_bar_right(p) + 42 * p->u + p->values.widest + 1.8 * p->font.large.size + 24 * p->u;
}

double
page_bar_below(const struct page *p)
{
    return page_marks(p) + 18 * p->u;
}

static void
set_fonts(struct page_fonts *font, double u)
{
    font->small = (struct canvas_font){.size = SMALL * u, .colour = page_ink};
    font->large = (struct canvas_font){.size = 23 * u, .colour = page_ink};
    font->heading = (struct canvas_font){.size = 28 * u, .bold = true, .colour = page_ink};
    font->subheading = (struct canvas_font){.size = 20 * u, .colour = page_faint};
    font->stamp = (struct canvas_font){.size = 24 * u, .bold = true, .colour = page_alarm};
}

/* The unit of the design for text with a size on paper; 0: not requested. */
static double
unit_on_paper(const struct paper *paper)
{
    return paper->dpi * FIGURE_POINTS / 72 / SMALL;
}

static void
set_dpi(struct page *p)
{
    p->dpi = p->paper->dpi > 0 ? p->paper->dpi : 72 * p->font.small.size / FIGURE_POINTS;
}

/* Pixels of the longer side of a plot of n nodes. It is a whole number of pixels per node, or of nodes per
 * pixel, so that all cells look equal. */
static double
natural_side(size_t n, double u)
{
    double wish = 900 * (u > 0 ? u : 1), most = 1.5 * wish;
    double nodes = (double)n;

    if (nodes <= most)
        return nodes * fmax(1, round(wish / nodes));
    return round(nodes / ceil(nodes / most));
}

/* Width over height of a drawn map. */
static double
aspect_of(const struct figure *f)
{
    double aspect = (f->at.right - f->at.left) / (f->at.bottom - f->at.top);

    if (f->at.aspect > 0)
        return aspect / f->at.aspect;
    return fmin(fmax(aspect, 1.0 / FIGURE_ASPECT), FIGURE_ASPECT);
}

static bool
is_sheet(const struct page_maps *maps)
{
    return maps->columns * maps->rows > 1;
}

/* Sizes of maps of `width` pixels; 0: from the nodes of the only map. */
static void
set_plot(struct page *p, double width)
{
    double aspect = aspect_of(p->f), paper = unit_on_paper(p->paper), w = width;

    p->distorted = aspect != (p->f->at.right - p->f->at.left) / (p->f->at.bottom - p->f->at.top);
    if (is_sheet(&p->maps))
        w = floor(width);
    else if (width > 0)
        w = fmin(width, 0.85 * (double)p->paper->width * aspect);
    else
        w = aspect >= 1 ? natural_side(p->g->nx, paper) : natural_side(p->g->ny, paper) * aspect;
    p->plot.w = fmax(round(w), 1);
    p->plot.h = fmax(round(w / aspect), 1);
    if (width == 0 && paper == 0)
        p->u = fmax(p->plot.w, p->plot.h) / 900;
    set_fonts(&p->font, p->u);
    p->bar_below = p->plot.h < 300 * p->u && p->f->nodes.is == NULL && !is_sheet(&p->maps);
}

/* The widths of axes and bar left and right of the plot, and between maps. */
static void
measure_sides(struct page *p)
{
    double u = p->u;

    mark_map(p);
    p->space.left = 24 * u + 1.3 * p->font.large.size + 8 * u + p->down.widest + 14 * u;
    p->space.gutter = media_gutter(p);
    axis_mark(p, &p->values, p->bar_below ? p->plot.w : p->plot.h, !p->bar_below);
    p->space.right = right_of_plot(p);
    if (p->bar_below)
        p->space.right = 24 * u + fmax(fmax(0.5 * p->across.widest, p->space.gutter),
                                       0.5 * p->values.widest + 14 * u);
    p->maps.across_step =
        fmax(22 * u + p->space.gutter, p->across.widest + 14 * u); /* marks at both edges */
}

/* A vertical label may be longer than the height of the plot: half of the excess. */
static double
overhang(struct page *p)
{
    double longest = canvas_text_width(p->c, &p->font.large, p->down.label);

    if (!p->bar_below && p->f->nodes.is == NULL)
        longest = fmax(longest, canvas_text_width(p->c, &p->font.large, p->values.label));
    return fmax(0, 0.5 * (longest - p->plot.h));
}

static double
between_rows(const struct page_fonts *font)
{
    return 2.1 * font->small.size;
}

/* Arranges the maps as the plot of the page. */
static void
set_page(struct page *p)
{
    double u = p->u, marks = page_marks(p), free, content, over;

    p->maps.w = p->plot.w;
    p->maps.h = p->plot.h;
    p->maps.across_step += p->maps.w;
    p->maps.down_step = p->maps.h + between_rows(&p->font);
    p->plot.w += floor(p->maps.across_step * (double)(p->maps.columns - 1));
    p->plot.h += floor(p->maps.down_step * (double)(p->maps.rows - 1));
    content = p->space.left + p->plot.w + p->space.right;
    over = overhang(p);
    if (p->paper->width == 0 && !is_sheet(&p->maps))
        p->w = (size_t)ceil(fmax(content, 680 * u));
    if (p->bar_below)
        marks = page_bar_below(p) + 28 * u + marks;
    free = is_sheet(&p->maps) ? 0 : fmax(0, (double)p->w - content);
    figure_legend(p);
    page_settle(p, p->space.left + 0.5 * free,
                (is_sheet(&p->maps) ? between_rows(&p->font) : 22 * u) + over, fmax(marks, over));
    set_dpi(p);
}

/* Sizes depend on texts, texts on marks, and marks on sizes: for a given width a few iterations find them. */
enum rc_status
page_lay_out(struct page *p, struct rc_err *err)
{
    const double least = 40,
                 columns = (double)p->maps.columns; /* smallest width in pixels of one of
                                                              several maps */
    bool beside = false,
         again = false; /* the bar was beside the plot, then below it again: it stays below */
    double width;

    set_axes(p);
    width =
        is_sheet(&p->maps) ? ((double)p->w - 260 * p->u) / columns : 0.8 * (double)p->paper->width;
    for (int round = 0; round < (is_sheet(&p->maps) ? 4 : 6); round++) {
        set_plot(p, width);
        again = again || (beside && p->bar_below);
        beside = beside || !p->bar_below;
        p->bar_below = p->bar_below || again;
        measure_sides(p);
        if (p->paper->width == 0 && !is_sheet(&p->maps))
            break;
        width =
            ((double)p->w - p->space.left - p->space.right - p->maps.across_step * (columns - 1)) /
            columns;
        if (is_sheet(&p->maps) && width < least)
            return rc_err_set(err,
                              "%zu columns on %zu pixels leave %d for each: ask for fewer "
                              "columns or a larger --width",
                              p->maps.columns, p->w, width < 0 ? 0 : (int)width);
        width = fmax(width, 1);
    }
    set_page(p);
    return RC_OK;
}

/* ---- pages of all kinds ---- */

struct page *
page_new(const struct page_kind *kind, void *of, const struct paper *paper, struct rc_err *err)
{
    struct page *p = calloc(1, sizeof *p);

    if (p == NULL)
        rc_err_set(err, "out of memory for a figure");
    else
        *p = (struct page){.kind = kind, .of = of, .paper = paper};
    return p;
}

/* Sets width, unit, fonts and dpi. */
static void
set_size(struct page *p)
{
    double paper = unit_on_paper(p->paper), design = (double)p->kind->design,
           w = (double)p->paper->width;

    if (p->paper->width == 0)
        w = round(design * (paper > 0 ? paper : 1));
    p->w = (size_t)w;
    p->u = paper > 0 ? paper : fmax(w / design, 0.5);
    set_fonts(&p->font, p->u);
    set_dpi(p);
}

/* A canvas of this size, with the font and the size on paper of the page. */
static struct canvas *
new_canvas(const struct page *p, size_t w, size_t h, struct rc_err *err)
{
    struct canvas *c = canvas_new(w, h, err);

    if (c == NULL)
        return NULL;
    if (p->paper->family != NULL)
        canvas_set_family(c, p->paper->family);
    canvas_set_dpi(c, p->dpi, p->paper->width > 0 && p->paper->dpi == 0);
    return c;
}

static enum rc_status
lay_out(struct page *p, struct rc_err *err)
{
    enum rc_status status;

    set_size(p);
    if ((p->c = new_canvas(p, 1, 1, err)) == NULL) /* only to measure text */
        return RC_FAIL;
    status = p->kind->lay_out(p, err);
    canvas_free(p->c);
    return status;
}

struct canvas *
pages_draw(struct page *const page[], size_t n, struct rc_err *err)
{
    enum rc_status status = RC_OK;
    struct canvas *c;
    size_t h = 0;

    for (size_t k = 0; k < n; k++) {
        if (lay_out(page[k], err) != RC_OK)
            return NULL;
        page[k]->space.top = (double)h;
        h += page[k]->h;
    }
    if ((c = new_canvas(page[0], page[0]->w, h, err)) == NULL)
        return NULL;
    for (size_t k = 0; k < n && status == RC_OK; k++) {
        page[k]->c = c;
        page[k]->plot.y += page[k]->space.top;
        draw_heading(page[k]);
        status = page[k]->kind->draw(page[k], err);
        legend_draw(page[k]);
    }
    if (status == RC_OK && canvas_check(c, err) == RC_OK)
        return c;
    canvas_free(c);
    return NULL;
}

void
page_clip(const struct page *p)
{
    canvas_clip(p->c, p->plot.x, p->plot.y, p->plot.w, p->plot.h);
}

void
page_clip_end(const struct page *p)
{
    canvas_clip(p->c, 0, 0, 0, 0);
}

void
page_measure(struct page *p)
{
    set_axes(p);
    mark_map(p);
    axis_mark(p, &p->values, p->plot.h, true);
    p->space.gutter = media_gutter(p);
}
