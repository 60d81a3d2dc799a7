#include "page.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SMALL 21 /* size of the marks for a design unit of 1 */
#define BETWEEN " \xc2\xb7 "
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

/* Breaks text at the separators into lines; a piece that is too long for a line is broken between words; the
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

/* ---- axes ---- */

static void
set_axis(struct axis *a, const char *quantity, const char *unit, double lo, double hi,
         double largest)
{
    scale_choose(&a->scale, largest, unit);
    a->lo = a->log ? log10(lo / a->scale.size) : lo / a->scale.size;
    a->hi = a->log ? log10(hi / a->scale.size) : hi / a->scale.size;
    scale_label(a->label, sizeof a->label, quantity, &a->scale);
}

/* If both axes of a map have one unit they get one step. */
static void
mark_map(struct page *p)
{
    const double w = (double)p->plot_w, h = (double)p->plot_h;

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
    double x = fmax(fabs(f->left), fabs(f->right)), y = fmax(fabs(f->top), fabs(f->bottom));
    double both = fmax(x, y);
    const char *unit = f->dunit == NULL ? "m" : f->dunit;

    p->values.log = f->log;
    set_axis(&p->values, f->quantity, f->unit, f->lo, f->hi, fmax(fabs(f->lo), fabs(f->hi)));
    set_axis(&p->across, f->across, unit, f->left, f->right,
             f->section || x < 0.01 * both ? x : both);
    set_axis(&p->down, f->down, unit, f->top, f->bottom, f->section || y < 0.01 * both ? y : both);
}

/* ---- layout ---- */

double
page_marks(const struct page *p)
{
    return 14 * p->u + p->small.size + 1.5 * p->large.size;
}

double
page_bar_right(const struct page *p)
{
    return fmax(28 * p->u + p->gutter, 0.5 * p->across.widest + 10 * p->u);
}

double
page_right(const struct page *p)
{
    if (p->f->is != NULL)
        return 24 * p->u + fmax(0.5 * p->across.widest, p->gutter);
    return page_bar_right(p) + 42 * p->u + p->values.widest + 1.8 * p->large.size + 24 * p->u;
}

double
page_bar_below(const struct page *p)
{
    return page_marks(p) + 18 * p->u;
}

void
page_fonts(struct page *p)
{
    p->small = (struct canvas_font){.size = SMALL * p->u, .colour = page_ink};
    p->large = (struct canvas_font){.size = 23 * p->u, .colour = page_ink};
    p->heading = (struct canvas_font){.size = 28 * p->u, .bold = true, .colour = page_ink};
    p->subheading = (struct canvas_font){.size = 20 * p->u, .colour = page_faint};
    p->stamp = (struct canvas_font){.size = 24 * p->u, .bold = true, .colour = page_alarm};
}

/* The unit of the design for text with a size on paper; 0: not requested. */
static double
unit_on_paper(const struct figure *f)
{
    return f->dpi * FIGURE_POINTS / 72 / SMALL;
}

static void
set_dpi(struct page *p)
{
    p->dpi = p->f->dpi > 0 ? p->f->dpi : 72 * p->small.size / FIGURE_POINTS;
}

/* Pixels of the longer side of a plot of n nodes: a whole number of pixels per node, or of nodes per pixel,
 * so that all cells look equal. */
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
    double aspect = (f->right - f->left) / (f->bottom - f->top);

    if (f->aspect > 0)
        return aspect / f->aspect;
    return fmin(fmax(aspect, 1.0 / FIGURE_ASPECT), FIGURE_ASPECT);
}

static bool
is_sheet(const struct page *p)
{
    return p->columns * p->rows > 1;
}

/* Sizes of maps of `width` pixels; 0: from the nodes of the only map. */
static void
set_plot(struct page *p, double width)
{
    double aspect = aspect_of(p->f), paper = unit_on_paper(p->f), w = width;

    p->distorted = aspect != (p->f->right - p->f->left) / (p->f->bottom - p->f->top);
    if (is_sheet(p))
        w = floor(width);
    else if (width > 0)
        w = fmin(width, 0.85 * (double)p->f->width * aspect);
    else
        w = aspect >= 1 ? natural_side(p->g->nx, paper) : natural_side(p->g->ny, paper) * aspect;
    p->plot_w = (size_t)fmax(round(w), 1);
    p->plot_h = (size_t)fmax(round(w / aspect), 1);
    if (width == 0 && paper == 0)
        p->u = fmax((double)p->plot_w, (double)p->plot_h) / 900;
    page_fonts(p);
    p->bar_below = (double)p->plot_h < 300 * p->u && p->f->is == NULL && !is_sheet(p);
}

/* The widths of axes and bar left and right of the plot, and between maps. */
static void
measure_sides(struct page *p)
{
    double u = p->u;

    mark_map(p);
    p->left_w = 24 * u + 1.3 * p->large.size + 8 * u + p->down.widest + 14 * u;
    p->gutter = media_gutter(p);
    axis_mark(p, &p->values, (double)(p->bar_below ? p->plot_w : p->plot_h), !p->bar_below);
    p->right_w = page_right(p);
    if (p->bar_below)
        p->right_w =
            24 * u + fmax(fmax(0.5 * p->across.widest, p->gutter), 0.5 * p->values.widest + 14 * u);
    p->across_step = fmax(22 * u + p->gutter, p->across.widest + 14 * u); /* marks at both edges */
}

double
page_swatch(const struct page *p, size_t k)
{
    return p->note[k].swatch == SWATCH_NOTHING ? 0 : 38 * p->u;
}

/* A text that is too long for the width continues in another note. */
static void
add_note(struct page *p, double width, enum swatch swatch, const char *text)
{
    while (*text != '\0' && p->notes < NOTES) {
        size_t n;

        p->note[p->notes].swatch = swatch;
        n = fit(p, &p->small, width - page_swatch(p, p->notes), " ", text);
        copy_text(p->note[p->notes++].text, text, n);
        text += text[n] == '\0' ? n : n + 1;
        swatch = SWATCH_NOTHING;
    }
}

/* Their numbers are beside the plot. */
static void
add_media(struct page *p, double width)
{
    char text[LINE];
    size_t first, n = media_seen(p->f, &first);

    if (n > MEDIA_TOLD) {
        snprintf(text, sizeof text, "lines: where %zu media meet", n);
        add_note(p, width, SWATCH_NOTHING, text);
        return;
    }
    for (size_t k = first; k < first + n; k++) {
        snprintf(text, sizeof text, "%zu: %s", k + 1, p->f->medium[k].text);
        add_note(p, width, SWATCH_NOTHING, text);
    }
}

static const char *
say_scales(const struct figure *f, char *text, size_t size)
{
    if (f->aspect > 0)
        snprintf(text, size, "%s is drawn %.4g times as large as %s", f->down, f->aspect,
                 f->across);
    else
        snprintf(text, size, "the axes differ in scale");
    return text;
}

/* Content and positions of the legend: as many entries side by side as fit in a line. */
void
page_legend(struct page *p, double width)
{
    double x = 0, y = 0, line = 1.55 * p->small.size;
    char text[LINE];

    p->notes = 0;
    if (p->f->zero_is_none && (p->f->zeros > 0 || p->f->is != NULL))
        add_note(p, width, SWATCH_NONE, p->f->none);
    for (int k = 0; k < 2 && p->f->is != NULL && p->f->is[k] != NULL; k++)
        add_note(p, width, k == 0 ? SWATCH_ONE : SWATCH_TWO, p->f->is[k]);
    snprintf(text, sizeof text, "%s (%zu of %zu nodes)",
             p->f->missing_is == NULL ? "not measured" : p->f->missing_is, p->f->missing,
             p->f->nodes != 0 ? p->f->nodes : p->g->nx * p->g->ny);
    if (p->f->missing > 0)
        add_note(p, width, SWATCH_MISSING, text);
    if (p->f->contour && p->f->contact != NULL)
        add_note(p, width, SWATCH_CONTACT, "edge of contact");
    if (p->f->contour && p->f->hard > 0)
        add_note(p, width, SWATCH_HARD, "pressure at the hardness");
    if (p->f->circle != NULL)
        add_note(p, width, SWATCH_CIRCLE, p->f->circle);
    if (p->f->largest != NULL)
        add_note(p, width, SWATCH_LARGEST, p->f->largest);
    add_media(p, width);
    if (p->f->note != NULL)
        add_note(p, width, SWATCH_NOTHING, p->f->note);
    if (p->distorted)
        add_note(p, width, SWATCH_NOTHING, say_scales(p->f, text, sizeof text));
    for (size_t k = 0; k < p->notes; k++) {
        double w;

        page_shorten(p, &p->small, width - page_swatch(p, k), p->note[k].text);
        w = page_swatch(p, k) + canvas_text_width(p->c, &p->small, p->note[k].text);
        if (x > 0 && x + w > width) {
            x = 0;
            y += line;
        }
        p->note[k].x = x;
        p->note[k].y = y;
        x += w + 36 * p->u;
    }
    p->legend_h = p->notes == 0 ? 0 : y + line + 10 * p->u;
}

/* A vertical label may be longer than the height of the plot: half of the excess. */
static double
overhang(struct page *p)
{
    double longest = canvas_text_width(p->c, &p->large, p->down.label);

    if (!p->bar_below && p->f->is == NULL)
        longest = fmax(longest, canvas_text_width(p->c, &p->large, p->values.label));
    return fmax(0, 0.5 * (longest - (double)p->plot_h));
}

/* ---- title and subtitle ---- */

static double
longest_word(struct page *p, const struct canvas_font *font, const char *text)
{
    char word[LINE];
    double longest = 1;

    while (*text != '\0') {
        size_t n = piece(text, " ");

        copy_text(word, text, n);
        longest = fmax(longest, canvas_text_width(p->c, font, word));
        text += text[n] == '\0' ? n : n + 1;
    }
    return longest;
}

void
page_words(struct page *p, double width)
{
    p->heading.size *= fmin(1, fmax(0.5, width / longest_word(p, &p->heading, p->f->title)));
    page_wrap(p, &p->heading, width, " ", p->f->title, &p->title);
    page_wrap(p, &p->subheading, width, BETWEEN, p->f->subtitle, &p->subtitle);
    p->stamp_h = p->f->stamp == NULL ? 0 : 2.1 * p->stamp.size;
}

double
page_words_height(const struct page *p)
{
    return 24 * p->u + p->stamp_h + 1.3 * p->heading.size * (double)p->title.n +
           1.4 * p->subheading.size * (double)p->subtitle.n;
}

double
page_between_rows(const struct page *p)
{
    return 2.1 * p->small.size;
}

/* Arranges the maps as the plot of the page. */
static void
set_page(struct page *p)
{
    double u = p->u, text_w, marks = page_marks(p), free, content, over;

    p->map_w = p->plot_w;
    p->map_h = p->plot_h;
    p->across_step += (double)p->map_w;
    p->down_step = (double)p->map_h + page_between_rows(p);
    p->plot_w += (size_t)(p->across_step * (double)(p->columns - 1));
    p->plot_h += (size_t)(p->down_step * (double)(p->rows - 1));
    content = p->left_w + (double)p->plot_w + p->right_w;
    over = overhang(p);
    if (p->f->width == 0 && !is_sheet(p))
        p->w = (size_t)ceil(fmax(content, 680 * u));
    text_w = (double)p->w - 48 * u;
    page_words(p, text_w);
    page_legend(p, text_w);
    p->above = page_words_height(p) + (is_sheet(p) ? page_between_rows(p) : 22 * u) + over;
    if (p->bar_below)
        marks = page_bar_below(p) + 28 * u + marks;
    p->below = fmax(marks, over) + p->legend_h + 22 * u;
    free = is_sheet(p) ? 0 : fmax(0, (double)p->w - content);
    p->plot_x = (size_t)round(p->left_w + 0.5 * free);
    p->plot_y = (size_t)round(p->above);
    p->h = (size_t)ceil(p->above + (double)p->plot_h + p->below);
    set_dpi(p);
}

/* Sizes depend on texts, texts on marks, and marks on sizes: for a given width a few iterations find them. */
enum rc_status
page_lay_out(struct page *p, struct rc_err *err)
{
    const double least = 40, columns = (double)p->columns; /* smallest width in pixels of one of
                                                              several maps */
    bool beside = false,
         again = false; /* the bar was beside the plot, then below it again: it stays below */
    double width;

    page_size(p, is_sheet(p) ? SHEET_WIDTH : 1200);
    set_axes(p);
    width = is_sheet(p) ? ((double)p->w - 260 * p->u) / columns : 0.8 * (double)p->f->width;
    for (int round = 0; round < (is_sheet(p) ? 4 : 6); round++) {
        set_plot(p, width);
        again = again || (beside && p->bar_below);
        beside = beside || !p->bar_below;
        p->bar_below = p->bar_below || again;
        measure_sides(p);
        if (p->f->width == 0 && !is_sheet(p))
            break;
        width = ((double)p->w - p->left_w - p->right_w - p->across_step * (columns - 1)) / columns;
        if (is_sheet(p) && width < least)
            return rc_err_set(err,
                              "%zu columns on %zu pixels leave %d for each: ask for fewer "
                              "columns or a larger --width",
                              p->columns, p->w, width < 0 ? 0 : (int)width);
        width = fmax(width, 1);
    }
    set_page(p);
    return RC_OK;
}

struct canvas *
page_canvas(const struct page *p, size_t w, size_t h, struct rc_err *err)
{
    struct canvas *c = canvas_new(w, h, err);

    if (c == NULL)
        return NULL;
    if (p->f->family != NULL)
        canvas_set_family(c, p->f->family);
    canvas_set_dpi(c, p->dpi, p->f->width > 0 && p->f->dpi == 0);
    return c;
}

/* ---- pages of other shapes ---- */

void
page_size(struct page *p, size_t design)
{
    double paper = unit_on_paper(p->f), w = (double)p->f->width;

    if (p->f->width == 0)
        w = round((double)design * (paper > 0 ? paper : 1));
    p->w = (size_t)w;
    p->u = paper > 0 ? paper : fmax(w / (double)design, 0.5);
    page_fonts(p);
    set_dpi(p);
}

void
page_measure(struct page *p)
{
    set_axes(p);
    mark_map(p);
    axis_mark(p, &p->values, (double)p->plot_h, true);
    p->gutter = media_gutter(p);
}
