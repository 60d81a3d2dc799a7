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

enum {
    LINE = 1024, /* bytes of a line of text */
    LINES = 4,
    NOTES = 16,
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

struct box {
    double x, y, w, h;
};

struct page;
/* A kind of picture: its layout, which measures text with page->c and sets w and h of the page, and its
 * drawing. */
struct page_kind {
    size_t design; /* pixels: the width by default */
    enum rc_status (*lay_out)(struct page *page, struct rc_err *err);
    enum rc_status (*draw)(struct page *page, struct rc_err *err);
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
    struct canvas_font small, large, heading, subheading, stamp;
    struct axis across, down, values;
    struct text title, subtitle;
    struct {
        enum swatch swatch;
        char text[LINE];
        double x, y; /* position from the left and top of the legend, pixels */
    } note[NOTES];
    size_t notes;
    double legend_h;
    double gutter;                        /* width right of a plot for the numbers of media */
    double stamp_h;                       /* 0 without one */
    double left_w, right_w, above, below; /* space around the plot, margins included   */
    double top;                           /* position of the page on its canvas        */
    size_t columns, rows;                 /* columns and rows of maps */
    double map_w, map_h;                  /* size of each map, whole pixels            */
    double across_step, down_step;        /* distance from one to the next, pixels     */
    struct box plot;                      /* size of all maps, whole pixels */
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
/* Width of the swatch of note k, gap included. */
double page_swatch(const struct page *page, size_t k);
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
/* Breaks title and subtitle into lines; a title with a word that is too long for a line gets smaller. */
void page_words(struct page *page, double width);
/* The height of title, subtitle and stamp above a plot. */
double page_words_height(const struct page *page);
/* Draws title, subtitle and stamp above the plot. In figure.c. */
void page_heading(struct page *page);
/* Chooses the marks of all axes for the plot and a bar of the same height. */
void page_measure(struct page *page);
/* Determines the content of the legend, and its height. */
void page_legend(struct page *page, double width);
/* Draws the colour bar beside the plot, and the legend at the foot of the page. */
void page_bar(struct page *page);
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
