/*
 * The face of this folder: which frame of a stream rc-render draws, and what the figure says of it.
 */
#ifndef RC_RENDER_H
#define RC_RENDER_H

#include "tools/cli/cli.h"
#include "tools/plot/plot.h"

/* ---- choice.c: which frame; the best one so far is held, and no other ---- */

struct wish {
    const char *channel; /* NULL: mises, pressure, height, else the first there is    */
    const char *section; /* "x" or "y": a section across that axis; NULL: whatever    */
    double depth;        /* metres, met within a thousandth; NAN: whatever            */
    size_t number;       /* of the case; 0: the first                                 */
    bool contact;        /* the pressure of its case is kept too                      */
};

struct choice {
    const struct wish *wish;
    struct rc_grid *grid;     /* the best so far; NULL: none matched                      */
    struct rc_grid *pressure; /* of its case, on its grid; NULL: none, or it is `grid`  */
    double size;              /* its largest |value|                                      */
    bool by_size;             /* settled: preferred to other depths for that              */
    struct seen *seen;        /* every frame that came by, without its values             */
    size_t n, capacity;
};

/* Keeps the frame when it is better than the one kept, or frees it. Of several depths the one with
 * the largest |value| is better, of several cases the first. */
void choice_offer(struct choice *choice, struct tool *tool, struct rc_grid *grid);
/* After the last frame: fails, naming what there is, when none matched, and says what was left out
 * where somebody might have meant that. */
void choice_settle(struct choice *choice, struct tool *tool);
void choice_free(struct choice *choice);

/* ---- channels.c ---- */

struct channel {
    const char *name, *title, *colormap;
    bool from_zero; /* the colours begin at 0 where no value is negative */
    bool to_zero;   /* they end there                                    */
};

/* A channel that is not known is called by its own name, and what has both signs gets colours for
 * both. */
struct channel channel_of(const struct rc_grid *grid, const struct survey *survey);
/* ---- window.c ---- */

struct window {
    double left, right, top, bottom; /* metres from the middle of the whole map, its outer edges */
    double part;                     /* of the map's area that is drawn                          */
    bool contact;                    /* it is about what touches                                 */
};

/* Cuts the map, and the pressure beside it unless that is NULL, to the window of `text`:
 * X0:X1,Y0:Y1, contact, all, or NULL: about the contact where that is a speck of the map of a
 * pressure, unless each node is to be a pixel (`raw`). The values move to the front of the
 * grids. */
void window_cut(struct tool *tool, const char *text, bool raw, struct rc_grid *grid,
                struct rc_grid *pressure, struct window *window);

/* ---- section.c ---- */

/* The depths of the rows of a section, metres, which the caller frees. */
double *section_depths(struct tool *tool, const struct rc_grid *grid);
/* Which depths are drawn: all, or those of `text`, Z0:Z1. */
void section_range(struct tool *tool, const char *text, const struct rc_grid *grid,
                   const double *depth, double *top, double *bottom);
/* The section from top to bottom on even rows, between its own ones a curve without corners that
 * never leaves the values beside it, and straight between columns. */
struct rc_grid *section_even(struct tool *tool, const struct rc_grid *grid, const double *depth,
                             double top, double bottom);

/* ---- range.c ---- */

enum range_kind {
    RANGE_AUTO, /* all values, but for outliers          */
    RANGE_VALUES,
    RANGE_PERCENT,
    RANGE_SYMMETRIC, /* as far below 0 as above               */
    RANGE_CLIP       /* without half a per cent at each end   */
};

struct range {
    enum range_kind kind;
    double low_percent, high_percent;
    double lo, hi;
    char note[80]; /* what the legend says of it; may be empty */
};

/* LO:HI or LO,HI in the unit of the grid, P%:Q% or symmetric; ends the tool where it is neither. */
void range_read(struct tool *tool, const char *text, const struct rc_grid *grid,
                struct range *range);
/* "LO:HI" in SI, valid until the next call. */
const char *range_text(const struct range *range);
/* The ends of the colours, or of the upright axis of a curve, as far as nobody chose them. */
void range_choose(const struct rc_grid *grid, const struct survey *survey,
                  const struct colormap *map, const struct channel *what, bool curve,
                  struct range *range);
/* Moves the lower end above 0, to the least value above it, six decades down at most. */
void range_take_logarithm(struct tool *tool, const struct rc_grid *grid, struct range *range);
/* The least value; the end of the range where it is below that by rounding only. */
double range_least(const struct rc_grid *grid, const struct survey *survey,
                   const struct range *range);
/* The value that so many per cent of the finite ones are below, straight between two of them; of a
 * pressure only those in contact count. */
double range_percentile(const struct rc_grid *grid, double percent);

/* ---- subtitle.c ---- */

struct subtitle {
    char text[1024];
    size_t n;
};

/* `part` of the map is drawn; `largest`: of several depths this one was chosen because its size is
 * largest. */
void subtitle_write(struct subtitle *subtitle, const struct rc_grid *grid,
                    const struct survey *survey, double part, bool largest);

struct words { /* of the legend */
    char largest[256], circle[96];
};

/* "largest 2.3 GPa at x = 3 µm, depth 12 µm" */
const char *words_largest(struct words *words, const struct rc_grid *grid, double value,
                          const char *across, double x, double depth);
/* "Hertz, radius 12 µm", and that radius; ends the tool when the keys do not say it. */
const char *words_hertz(struct tool *tool, struct words *words, const struct rc_grid *grid,
                        double *radius);

#endif
