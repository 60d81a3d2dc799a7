/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The layout of a figure: sizes, marks and lines of text, determined before drawing. All lengths are in
 * pixels. */
#ifndef RC_PAGE_H
#define RC_PAGE_H

#include <stdbool.h>
#include <stddef.h>

#include "tools/canvas/canvas.h"
#include "figure.h"
#include "graph.h"
#include "ticks.h"

#define BETWEEN " \xc2\xb7 " /* between parts of a text: a line may break there */

enum {
    LINE = 1024, /* bytes of a line of text */
    LINES = 4,
    ENTRIES = 128, /* of a legend */
    MARKS = 256,   /* marks of an axis */
    MEDIA_TOLD = 8 /* most numbered media in the legend; further media are lines only */
};

/* axis_place gives the position of a value v, in the unit of the scale, between the ends. */
struct axis {
    struct scale scale;
    struct ticks ticks; /* steps of even marks */
    double lo, hi;   /* ends in the unit of the scale; decimal logarithms for a logarithmic axis */
    bool log, minor; /* minor: marks between the numbers too */
    char label[LINE];
    char more[LINE]; /* second line of the label; may be empty */
    struct {
        double value, at; /* at: 0 to 1 */
        bool major;
        char text[TICKS_TEXT]; /* may be empty */
    } mark[MARKS];
    size_t marks;
    double widest;           /* mark's text, pixels                           */
    const char *const *word; /* words of an axis of categories, at 0, 1, ...  */
    size_t words;            /* 0: of numbers                                 */
    bool upwards;            /* the words are too long to be side by side     */
};

struct text {
    char line[LINES][LINE];
    size_t n;
};

struct box {
    double x, y, w, h;
};

struct page;
/* A kind of picture: its layout, which measures text with page->c, adds the entries of the legend and ends
 * with page_settle; its drawing between heading and legend; and the samples of its legend. */
struct page_kind {
    size_t design; /* pixels: the width by default */
    enum rc_status (*lay_out)(struct page *page, struct rc_err *err);
    enum rc_status (*draw)(struct page *page, struct rc_err *err);
    double sample_w; /* units of the design: width of a sample and of the gap to its text */
    /* Draws a sample with its upper left corner at (x, y), n pixels high. */
    void (*sample)(struct page *page, size_t sample, double x, double y, size_t n);
};

struct page_fonts {
    struct canvas_font small, large, heading, subheading, stamp;
};

struct page_legend {
    struct entry {
        size_t sample; /* 0: none */
        char text[LINE];
        double x, y; /* position from the left and top of the legend, pixels */
    } entry[ENTRIES];
    size_t entries;
    double h;
};

struct page_maps {
    size_t columns, rows;          /* of maps */
    double w, h;                   /* size of each map, whole pixels            */
    double across_step, down_step; /* distance from one to the next, pixels     */
};

struct page_space {
    double gutter;      /* width right of a plot for the numbers of media */
    double left, right; /* beside the plot, margins included   */
    double top;         /* position of the page on its canvas        */
};

struct page {
    const struct page_kind *kind;
    void *of; /* what is drawn, for the functions of its kind */
    const struct paper *paper;
    const struct figure *f; /* figure of a map; NULL: the page is a graph */
    const struct graph *graph;
    const struct rc_grid *g;
    struct canvas *c;
    bool bar_below, distorted;
    double u; /* the unit of the design, to which text, gaps and lines are proportional */
    struct page_fonts font;
    struct axis across, down, values;
    struct text title, subtitle;
    struct page_legend legend;
    struct rgb edge; /* colour of the edge of the contact */
    struct page_space space;
    struct page_maps maps;
    struct box plot; /* size of all maps, whole pixels */
    size_t w, h;
    double dpi; /* pixels of the page per inch of paper */
};

extern const struct rgb page_ink, page_faint;

extern const struct rgb page_alarm;

/* NULL when memory is short. */
struct page *page_new(const struct page_kind *kind, void *of, const struct paper *paper,
                      struct rc_err *err);
/* Lays out n pages and draws them on one canvas, one below the other; f and g of maps are set. NULL
 * when memory is short or a layout is not possible. */
struct canvas *pages_draw(struct page *const page[], size_t n, struct rc_err *err);
/* Clips to the plot what is drawn until page_clip_end. */
void page_clip(const struct page *page);
void page_clip_end(const struct page *page);
/* Lays out a page of maps, with columns and rows set. RC_FAIL: the page is too narrow for the columns. */
enum rc_status page_lay_out(struct page *page, struct rc_err *err);
/* Distance from the plot's right edge to a bar beside it, and from its lower edge to a bar below. */
double page_bar_right(const struct page *page);
double page_bar_below(const struct page *page);
/* The height of marks and label below an axis. */
double page_marks(const struct page *page);
/* Cuts a line to `width`. */
void page_shorten(struct page *page, const struct canvas_font *font, double width, char line[LINE]);
/* Breaks text at the separators into lines; a piece that is too long for a line is broken between words. The
 * last line is cut if necessary. */
void page_wrap(struct page *page, const struct canvas_font *font, double width,
               const char *separator, const char *text, struct text *lines);
/* Chooses the marks of all axes for the plot and a bar of the same height. */
void page_measure(struct page *page);
/* The layout around a plot of known size: its position, and the height of the page. `left`, `above` and
 * `below` are the spaces from the left edge of the page, from the heading and to the legend. */
void page_settle(struct page *page, double left, double above, double below);
/* A frame just outside of the rectangle. */
void page_frame(const struct page *page, double x, double y, double w, double h);

/* ---- figure.c: for maps and reliefs ---- */

enum {
    FIGURE_SAMPLE = 38
};

void figure_legend(struct page *page);
void figure_sample(struct page *page, size_t sample, double x, double y, size_t n);
/* Draws the colour bar beside the plot. */
void figure_bar(struct page *page);

/* ---- legend.c ---- */

/* Adds an entry (NULL: none); a text that is too long for a line continues in further entries. */
void legend_add(struct page *page, size_t sample, const char *text);
/* Puts the entries side by side, as many as fit in a line. */
void legend_place(struct page *page);
/* Draws them at the foot of the page. */
void legend_draw(struct page *page);

/* ---- axis.c ---- */

/* The position of a value between the ends of the axis, 0 to 1. */
double axis_place(const struct axis *axis, double value);
/* Chooses marks for this number of pixels, whose numbers do not touch each other. */
void axis_mark(struct page *page, struct axis *axis, double length, bool upright);
/* The finer axis gets the steps of the coarser one, unless it would have too few marks. */
void axis_even_steps(struct page *page, struct axis *coarse, struct axis *fine, double length,
                     bool upright);
/* The additional height below a plot of words that read upwards, compared with numbers. */
double axis_word_room(const struct page *page, const struct axis *axis);
/* Breaks the label into at most two lines of this length, and shortens what is still too long, but not its
 * unit. */
void axis_fit_label(struct page *page, struct axis *axis, double length);
/* The additional room for the second line of the label. */
double axis_label_room(const struct page *page, const struct axis *axis);
/* Draws marks and label below a plot, or beside it, with values that rise downwards or upwards. */
void axis_across(struct page *page, const struct axis *axis, double x, double y, double w);
void axis_upright(struct page *page, const struct axis *axis, double x, double y, double h,
                  bool left, bool rises_down);

/* ---- media.c ---- */

/* The media in the figure: the first one, and their number. */
size_t media_seen(const struct figure *figure, size_t *first);
/* The width of their numbers right of a plot; 0 without any. */
double media_gutter(const struct page *page);
/* Draws lines at interfaces and, if there is a gutter right of the plot, the numbers of the media. */
void media_draw(struct page *page);

#endif
