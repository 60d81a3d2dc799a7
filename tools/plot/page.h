/* What goes where on a figure: sizes, marks and broken lines of text, settled before anything is
 * drawn. All lengths are pixels. */
#ifndef RC_PAGE_H
#define RC_PAGE_H

#include <stdbool.h>
#include <stddef.h>

#include "tools/canvas/canvas.h"
#include "figure.h"
#include "ticks.h"

enum {
    LINE = 1024, /* bytes of a line of text */
    LINES = 4,
    NOTES = 16,
    MARKS = 256,   /* of an axis */
    MEDIA_TOLD = 8 /* numbered, and described in the legend: more are lines only */
};

/* A value v, in the unit of the scale, lies at axis_place between the ends. */
struct axis {
    struct scale scale;
    struct ticks ticks; /* of marks at even steps                                         */
    double lo, hi;   /* in the unit of the scale; of a logarithmic axis their decimal logarithms */
    bool log, minor; /* minor: with marks between the numbers                          */
    char label[LINE];
    struct {
        double value, at; /* at: 0 to 1 */
        bool major;
        char text[TICKS_TEXT]; /* may be empty */
    } mark[MARKS];
    size_t marks;
    double widest;           /* mark's text, pixels                           */
    const char *const *word; /* of an axis of categories, at 0, 1, ...        */
    size_t words;            /* 0: of numbers                                 */
    bool upwards;            /* words too long to stand side by side          */
};

struct text {
    char line[LINES][LINE];
    size_t n;
};

enum swatch {
    SWATCH_NOTHING,
    SWATCH_NONE,
    SWATCH_ONE,
    SWATCH_TWO,
    SWATCH_MISSING,
    SWATCH_CONTACT,
    SWATCH_HARD,
    SWATCH_CIRCLE,
    SWATCH_LARGEST
};

struct page {
    const struct figure *f;
    const struct rc_grid *g;
    struct canvas *c;
    bool bar_below, distorted;
    double u; /* the unit of the design: text, gaps and lines grow with the plot       */
    struct canvas_font small, large, heading, subheading, stamp;
    struct axis across, down, values;
    struct text title, subtitle;
    struct {
        enum swatch swatch;
        char text[LINE];
        double x, y; /* from the left and top of the legend, pixels */
    } note[NOTES];
    size_t notes;
    double legend_h;
    double gutter;                        /* right of a plot, for the numbers of media */
    double stamp_h;                       /* 0 without one */
    double left_w, right_w, above, below; /* around the plot, margins included         */
    double top;                           /* of the page on its canvas                 */
    size_t columns, rows;                 /* of maps                                   */
    size_t map_w, map_h;                  /* of each; plot_w and plot_h are of all     */
    double across_step, down_step;        /* from one to the next, pixels              */
    size_t plot_x, plot_y, plot_w, plot_h, w, h;
    double dpi; /* pixels of the page in an inch of paper */
};

extern const struct rgb page_ink, page_faint;

extern const struct rgb page_alarm;

/* Settles everything of a page of maps whose f, g, columns and rows are set, measuring text on c. RC_FAIL:
 * the page is too narrow for so many columns. */
enum rc_status page_lay_out(struct page *page, struct rc_err *err);
/* Pixels that the swatch of note k takes, gap included. */
double page_swatch(const struct page *page, size_t k);
/* From the plot's right edge to a bar beside it, and from its lower edge to a bar below. */
double page_bar_right(const struct page *page);
/* From the plot's right edge to that of the page, with a bar beside it or, of categories, none. */
double page_right(const struct page *page);
/* Pixels from one row of maps to the next, beside their height. */
double page_between_rows(const struct page *page);
double page_bar_below(const struct page *page);
/* The height that marks and label take below an axis. */
double page_marks(const struct page *page);
/* Sets width, unit, fonts and dpi as the figure asks for, of a page that is `design` pixels wide
 * where nothing is asked for. */
void page_size(struct page *page, size_t design);
/* A canvas of that size for the page, with the font and the size on paper that the figure asks for.
 * NULL as canvas_new. */
struct canvas *page_canvas(const struct page *page, size_t w, size_t h, struct rc_err *err);
/* Sets the fonts of the page for its u. */
void page_fonts(struct page *page);
/* Cuts the end of a line that is wider than `width`. */
void page_shorten(struct page *page, const struct canvas_font *font, double width, char line[LINE]);
/* Breaks text at the separators into lines that fit, a piece too long for a line between its words;
 * what is too much for the last one is cut. */
void page_wrap(struct page *page, const struct canvas_font *font, double width,
               const char *separator, const char *text, struct text *lines);
/* Breaks title and subtitle into lines; a title with a word too long for one gets smaller. */
void page_words(struct page *page, double width);
/* What they and the stamp take above a plot. */
double page_words_height(const struct page *page);
/* Draws title, subtitle and stamp, over the plot. In figure.c. */
void page_heading(struct page *page);
/* Chooses the marks of all axes for a plot of plot_w by plot_h pixels, the bar as high as that. */
void page_measure(struct page *page);
/* Settles what the legend says, and its height. */
void page_legend(struct page *page, double width);
/* Draws the colour bar beside the plot, and the legend at the foot of the page. */
void page_bar(struct page *page);
/* ---- axis.c ---- */

/* Where a value lies between the ends of the axis, 0 to 1. */
double axis_place(const struct axis *axis, double value);
/* Chooses marks for so many pixels, whose numbers do not touch each other. */
void axis_mark(struct page *page, struct axis *axis, double length, bool upright);
/* The finer one gets the steps of the coarser one, unless that leaves it too few marks. */
void axis_even_steps(struct page *page, struct axis *coarse, struct axis *fine, double length,
                     bool upright);
/* The height that words which read upwards take below a plot, beyond that of numbers. */
double axis_word_room(const struct page *page, const struct axis *axis);
/* Draws marks and label below a plot, or beside it, where values rise downwards or upwards. */
void axis_across(struct page *page, const struct axis *axis, double x, double y, double w);
void axis_upright(struct page *page, const struct axis *axis, double x, double y, double h,
                  bool left, bool rises_down);

/* ---- media.c ---- */

/* The media that the figure shows a part of: the first, and how many. */
size_t media_seen(const struct figure *figure, size_t *first);
/* The width of their numbers right of a plot; 0 without any. */
double media_gutter(const struct page *page);
/* Lines where they meet, and right of the plot their numbers, if it has a gutter. */
void media_draw(struct page *page);

#endif
