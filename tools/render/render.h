/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: the frame of a stream that rc-render draws, and the texts of the figure.
 */
#ifndef RC_RENDER_H
#define RC_RENDER_H

#include "tools/cli/cli.h"
#include "tools/frames/frames.h"
#include "tools/plot/plot.h"

/* Other frames of the case of the drawn frame, on its grid; NULL: none, or it is the drawn frame itself. */
struct beside {
    struct rc_grid *pressure, *contact;
};

/* ---- channels.c ---- */

struct channel {
    const char *name, *title, *colormap;
    bool from_zero;      /* the colours begin at 0 if no value is negative */
    bool to_zero;        /* they end there                                    */
    const char *none;    /* the meaning of the value 0, if it has a separate colour; NULL: a
                            value */
    const char *missing; /* the meaning of a missing value; NULL: not measured */
    const char *is[2];   /* the meanings of 1 and 2 for categories; NULL: no categories */
    const char *axis;    /* title of a curve; NULL: the title */
    const char *sign;    /* the meaning of the sign, for titles; NULL: none */
};

/* An unknown channel has its own name as title, and diverging colours if its values have both signs. */
struct channel channel_of(const struct rc_grid *grid, const struct survey *survey);
enum {
    CHANNEL_TITLE = 256
};
/* The title with these words behind it, and the meaning of the sign: "Net pressure about the contact (tension
 * negative)". */
const char *channel_title(const struct channel *channel, const char *words,
                          char text[CHANNEL_TITLE]);

/* ---- window.c ---- */

struct window {
    double left, right, top, bottom; /* metres from the middle of the whole map, its outer edges */
    double part;                     /* fraction of the map's area that is drawn */
    bool contact;                    /* the window is that of the contact */
};

/* Cuts the map, and the frames beside it, to the window of `text`: X0:X1,Y0:Y1, contact, all, or NULL. NULL
 * cuts to the contact if it is a small part of a pressure map, except for a raw picture (`raw`). `touch`
 * determines the contact (NULL: unknown). The values move to the front of the grids. */
void window_cut(struct tool *tool, const char *text, bool raw, struct rc_grid *grid,
                const struct beside *beside, const struct rc_grid *touch, struct window *window);

/* ---- means.c: pressures on a body that yields inside ---- */

struct means {
    bool taken;
    double four, one; /* Pa: the largest mean of 2 x 2 nodes, and the largest single node */
};

/* Replaces a map whose nodes alternate by the means about its nodes; for several maps *largest is their
 * maximum. */
void means_take(struct tool *tool, struct rc_grid *grid, struct means *means);

/* ---- section.c ---- */

/* The depths of the rows of a section, in metres; the caller frees them. */
double *section_depths(struct tool *tool, const struct rc_grid *grid);
/* The depths to draw: all, or those of `text`, Z0:Z1. */
void section_range(struct tool *tool, const char *text, const struct rc_grid *grid,
                   const double *depth, double *top, double *bottom);
/* The section from top to bottom on even rows. A smooth curve interpolates between its rows and stays between
 * the adjacent values; between columns it is linear. Between rows in two media a point has the value of the
 * row in its own medium. */
struct rc_grid *section_even(struct tool *tool, const struct rc_grid *grid, const double *depth,
                             const struct layers *layers, double top, double bottom);

/* ---- media.c: materials of a coated body ---- */

enum {
    MEDIA_NAME = 32
};

/* The media in the figure of a section; the caller frees `medium`. */
void media_set(struct tool *tool, const struct layers *layers, struct figure *figure);
/* "layer 2" or "substrate": the place of a slice of stresses; NULL: unknown. */
const char *media_name(char text[MEDIA_NAME], const struct rc_grid *grid);
/* Depths of the interfaces in metres, which the caller frees; NULL: there is none. */
double *media_bottoms(const struct rc_grid *grid, size_t *n);

/* ---- range.c ---- */

enum range_kind {
    RANGE_AUTO, /* all values except outliers */
    RANGE_VALUES,
    RANGE_PERCENT,
    RANGE_SYMMETRIC, /* symmetric about 0 */
    RANGE_CLIP       /* without 0.5 % at each end */
};

struct range {
    enum range_kind kind;
    double low_percent, high_percent;
    double lo, hi;
    char note[80]; /* its note in the legend; may be empty */
};

/* For qsort: the order of two numbers. */
int range_compare(const void *a, const void *b);
/* Reads LO:HI or LO,HI in the unit of the grid, P%:Q% or symmetric; ends the tool for another text. */
void range_read(struct tool *tool, const char *text, const struct rc_grid *grid,
                struct range *range);
/* "LO:HI" in SI, valid until the next call. */
const char *range_text(const struct range *range);
/* The ends of the colours for all values of n frames; a given end is kept. A percentile is the value below
 * which this per cent of the finite values lie, with linear interpolation. For a pressure only values in
 * contact count, which touch[k] determines (NULL: all count). */
void range_choose(struct rc_grid *const *grid, const struct rc_grid *const *touch, size_t n,
                  const struct survey *survey, const struct colormap *map,
                  const struct channel *what, struct range *range);
/* Warns of a range LO:HI, given as `text` of this option, in which values from min to max can hardly be
 * distinguished. */
void range_doubt(struct tool *tool, const char *option, const char *text, const char *unit,
                 double min, double max, const struct range *range);
/* Moves the lower end above 0, to the smallest positive value, but at most six decades below the largest. */
void range_take_logarithm(struct tool *tool, struct rc_grid *const *grid, size_t n,
                          struct range *range);
/* The smallest value; the end of the range if it is below that only by rounding. */
double range_least(struct rc_grid *const *grid, const struct rc_grid *const *touch, size_t n,
                   const struct survey *survey, const struct range *range);

/* ---- subtitle.c ---- */

struct subtitle {
    char text[1024];
    size_t n;
    bool titled; /* the title says where a section lies */
};
enum {
    SECTION_TITLE = 160
};

/* The title of sections that lie at one place: "von Mises stress at y = 0"; `title` of other frames. */
const char *subtitle_section(char text[SECTION_TITLE], struct rc_grid *const *grid, size_t n,
                             const char *title);
/* Adds a piece to the subtitle; a piece that does not fit is omitted. */
void subtitle_add(struct subtitle *subtitle, const char *name, const char *value);
/* The largest value of means, and of single nodes. */
void means_say(const struct means *means, struct subtitle *subtitle, const char *unit);
/* The properties that are the same in all frames of a picture: source, case, load, section, depth. `largest`:
 * the depth was chosen because its magnitude is the largest of several. */
void subtitle_common(struct subtitle *subtitle, struct rc_grid *const *grid, size_t n,
                     bool largest);
/* True if a key is the same in all frames. */
bool subtitle_same(struct rc_grid *const *grid, size_t n, const char *key);
/* "load 10 N, depth 5 um": the properties in which frame k differs from the others of its picture. */
void frame_label(char *text, size_t size, struct rc_grid *const *grid, size_t n, size_t k);
/* The common properties, the fraction `part` of the map that is drawn, and the extremes (not for categories);
 * for means those of the means and of single nodes. */
void subtitle_write(struct subtitle *subtitle, struct rc_grid *const *grid, size_t n,
                    const struct survey *survey, const struct means *means, double part,
                    bool largest);

struct words { /* words of the legend */
    char largest[256];
};

/* "largest 2.3 GPa at x = 3 µm, depth 12 µm" */
const char *words_largest(struct words *words, const struct rc_grid *grid, double value,
                          const char *across, double x, double depth);

/* ---- table.c: columns of reports: tables with tabs, lines of JSON ---- */

struct column {
    const char *name; /* the requested name; in JSON also a member of an object, "psd.q" or "q" */
    bool optional;    /* may be absent: then all its values are NaN                        */
    bool label;       /* its cells are kept as words, and v holds their indices            */
    bool either;      /* the same if none of its cells is a number                         */
    bool found, words, numbers; /* words: some cells are text; numbers: some are numbers */
    char unit[24];              /* from the heading; empty: unknown                         */
    char nearest[NAME_SIZE];    /* the existing names, if it is missing                     */
    double *v;                  /* true is 1, false 0; NaN: unknown                         */
    char **word;                /* words of labels, in the order of their first rows */
    size_t word_count, room, word_room;
};

struct table {
    const char *source; /* name of the file, for messages                               */
    struct column *column;
    size_t columns, rows;
    size_t *piece; /* rows at which further curves begin: arrays of further lines       */
    size_t pieces, piece_room;
};

/* Reads the columns whose names are set; "-" is standard input. Ends the tool if the file is not a table, or
 * lacks a column, with a list of its columns. */
void table_read(struct table *table, struct tool *tool, const char *file);
void table_free(struct table *table);
/* Advice for an input that begins like a table; NULL: it does not. */
const char *table_remedy(const char *head);

/* ---- groups.c: rows that belong together ---- */

enum {
    GROUP_COLUMNS = 2
};

/* Sorts the rows into pieces with the same labels in n columns, in the order of their first rows; `pieces`:
 * inside the existing pieces. */
void groups_sort(struct table *table, struct tool *tool, const size_t *by, size_t n, bool pieces);

/* Makes one point of rows with the same x, to a millionth. It has the mean of y, and one standard deviation
 * to both sides of it (n - 1; NaN for one row). */
struct spread {
    double *x, *y, *low, *high; /* one allocation, at x, which the caller frees */
    size_t n, least, most;      /* number of points; rows in each */
};

void spread_take(struct spread *spread, struct tool *tool, const double *x, const double *y,
                 size_t n);

/* ---- law.c: published laws beside the points ---- */

struct law_given {
    double estar, radius, rms_slope; /* Pa, m, 1; NAN: not given */
    double area;                     /* area of the map, m2 */
};

struct law {
    const char *name, *title, *x, *y; /* x and y: names between blanks */
    const char *says;                 /* the same for a message        */
    bool radius, rms_slope;           /* needed beside E*              */
    double (*value)(const struct law_given *given, const char *x, double value, const char *y);
};

const char *law_word(size_t k);
const struct law *law_named(const char *name);
/* The missing values that it needs, as options; NULL: none. */
const char *law_lacks(const char *law, const struct law_given *given);
/* True if it relates the two quantities, named as in reports of rc-solve. */
bool law_knows(const char *law, const char *x, const char *y);
/* True if it needs the area of the map. */
bool law_needs_area(const char *law, const struct law_given *given, const char *x, const char *y);
/* The value of y for the other quantity x, SI; NAN: undefined. */
double law_value(const char *law, const struct law_given *given, const char *x, double x_value,
                 const char *y);
/* Density of the pressure p over the whole map, 1/Pa, under the mean pressure `mean` (Persson). */
double law_pressure_density(const struct law_given *given, double mean, double p);

/* ---- hertz.c: the contact of a smooth sphere, or of a cylinder whose axis repeats ---- */

struct hertz_contact {
    double half, peak; /* radius, or half width of a strip, m; the largest pressure, Pa */
    char across;       /* the axis across a strip, x or y; 0: a circle */
    char text[96];     /* "Hertz, radius 12 µm" */
};

/* From the options or the keys of a whole map; ends the tool if both lack a figure. */
void hertz_read(struct tool *tool, const struct rc_grid *grid, const struct law_given *given,
                struct hertz_contact *hertz);
/* The pressure in Pa at this distance in m from the origin. */
double hertz_pressure_at(const struct hertz_contact *hertz, double x, double y);

/* ---- wording.c: words of a figure as the command line gives them ---- */

/* Properties of all pictures of curves. */
struct curve_style {
    const char *log;    /* NULL: linear; "" or "xy": both axes, "x", "y"   */
    struct paper paper; /* title or subtitle NULL: automatic */
    const char *law;
    const char *x_label, *y_label, *x_unit, *y_unit, *legend; /* NULL: what suits */
    const char *x_range, *y_range; /* ends of the axes; NULL: the points */
    const char *by, *error;        /* columns of tables */
    bool points, spread;
    bool hertz; /* beside a cut */
    struct law_given given;
};

/* The given subtitle, else that of the figure, but none under an empty title. */
const char *wording_subtitle(const struct paper *given, const char *own);
/* Descriptions of a picture beside its canvas. */
struct drawn {
    char title[256], source[256]; /* source empty: several */
    const char *stamp;            /* NULL: none */
};

/* True if --log selects this axis. */
bool wording_log(const struct curve_style *style, char axis);
/* Draws a graph of these series with the words, units and axes of the command line, else with the title
 * and the subtitle that suit it; sets drawn->title, and takes the stamp from there. */
struct canvas *wording_graph(struct tool *tool, const struct curve_style *style, const char *title,
                             const char *subtitle, struct graph *graph, struct graph_series *series,
                             struct drawn *drawn);

/* ---- curves.c ---- */

/* Reads the tables on the command line and draws the columns X:Y[,Y...]. */
struct canvas *curves_draw(struct tool *tool, const char *columns, const struct curve_style *style,
                           struct drawn *drawn);

/* ---- frames.c: the frames to draw ---- */

enum {
    FRAMES = 64
};

struct aside {
    struct rc_grid *grid[FRAMES];
    size_t n;
};

struct frames {
    struct wanted
        wanted; /* the request; without a channel: mises, pressure, height, else the first */
    bool
        one; /* true: only the best frame: of several cases the first, of several depths the one with the
                     largest magnitude */
    bool border;  /* true: pressures of the cases are kept beside frames of another channel */
    bool demands; /* true: the contact must be known */
    struct rc_grid *grid[FRAMES];
    size_t n;
    size_t left; /* number of frames beyond the limit */
    struct aside pressure, contact;
    const struct rc_grid *touch[FRAMES]; /* the contact in each frame; NULL: unknown */
    bool others;                         /* frames of another channel were left */
    double size;                         /* of one: its largest magnitude */
    size_t cases, last;                  /* of one: matching cases, and the last of them */
    size_t depths, same; /* of one: matching frames of its case with a depth, and without */
};

/* The other frames of the case of frame k. */
struct beside frames_beside(const struct frames *frames, size_t k);
/* True if the depth was chosen because its magnitude is the largest of several. */
bool frames_by_size(const struct frames *frames);

/* Reads all inputs and keeps the frames to draw. Ends the tool if there is none, and names omitted
 * frames that the user may have meant. */
void frames_read(struct frames *frames, struct tool *tool);
/* Frees the values, which the drawing no longer needs, and keeps the keys. */
void frames_empty(struct frames *frames);
void frames_free(struct frames *frames);

/* ---- sheet.c: the frames as panels ---- */

/* Reads "3x2"; "auto" gives 0 by 0. Ends the tool for another text. */
void sheet_size(struct tool *tool, const char *text, size_t *columns, size_t *rows);
/* Ends the tool if the frame and the first one, whose figures have their positions, cannot share a scale. */
void sheet_check_alike(struct tool *tool, const struct rc_grid *first,
                       const struct figure *of_first, const struct rc_grid *grid,
                       const struct figure *figure);
/* Statistics of all values, with nodes of the first frame; ends the tool if a frame has no finite value. */
void sheet_survey(struct tool *tool, const struct frames *frames, struct survey *all);
/* "a) load 10 N"; after z) comes aa). */
void sheet_label(struct panel *panel, const struct frames *frames, size_t k);

/* ---- view.c: reliefs ---- */

/* Reads AZ,EL in degrees; ends the tool for another text. */
void view_read(struct tool *tool, const char *text, struct view *view);
/* Ends the tool if --exaggeration is not possible for this picture. */
void view_check(struct tool *tool, const struct rc_grid *grid, const struct figure *figure);
/* Adds the notes of a relief to those of the figure. */
void view_say(const struct figure *figure, struct subtitle *subtitle);

/* ---- frame_curves.c: curves of frames, one each ---- */

/* The values along the line `cut`, as in "y=0"; lo and hi: ends of the vertical axis, NAN: automatic. */
struct canvas *cut_draw(struct tool *tool, struct rc_grid *const *grid, size_t n, const char *cut,
                        double lo, double hi, const struct curve_style *style, struct drawn *drawn);
/* The histogram of the values; for pressures those in contact, which touch[k] determines, with a note about
 * the rest. */
struct canvas *histogram_draw(struct tool *tool, struct rc_grid *const *grid,
                              const struct rc_grid *const *touch, size_t n,
                              const struct curve_style *style, struct drawn *drawn);
/* The fraction of the map at or above each value. */
struct canvas *material_ratio_draw(struct tool *tool, struct rc_grid *const *grid, size_t n,
                                   const struct curve_style *style, struct drawn *drawn);

/* ---- args.c: options ---- */

struct args {
    struct wanted wanted; /* which frames */
    const char *colormap, *range;
    const char *width, *window, *depths, *keep;
    double dpi;                  /* as given                                 */
    double aspect, exaggeration; /* the given value; NAN: automatic */
    bool contour, border, figure, raw, clip, hertz;
    const char *curve; /* X:Y[,Y...]: tables are drawn instead of maps */
    const char *cut;
    const char *view;  /* AZ,EL: a relief */
    const char *sheet; /* COLSxROWS or "auto" */
    bool histogram, material_ratio, hillshade;
    struct curve_style style; /* log and paper are for every picture */
};

/* Ends the tool for contradicting options; determines the size of the picture. */
void args_check(struct tool *tool, struct args *args);
/* True if the picture has curves of frames: values along a line, histogram, material ratio. */
bool args_lines(const struct args *args);
/* True if it shows several frames: a list of several, or a sheet. */
bool args_several(const struct args *args);

/* ---- look.c: appearance of a figure ---- */

/* Sets the content of a figure, and the range of its colours. */
struct look {
    struct channel what;
    struct range range;
};

bool look_is_profile(const struct rc_grid *grid);
/* Reads two numbers, "LO:HI" or "LO,HI"; both are NAN if there are fewer or more. */
enum rc_status look_pair(const char *text, enum unit unit, double pair[2], struct rc_err *err);
/* The warning for the stamp; NULL: none. */
const char *look_stamp(const struct rc_grid *grid);
/* The properties of a figure of n frames, except subtitle, edge of contact, and positions. */
void look_figure(struct tool *tool, struct args *args, struct rc_grid *const *grid,
                 const struct rc_grid *const *touch, size_t n, const struct survey *survey,
                 struct look *look, struct figure *figure);
/* The frame that determines the contact of a frame: itself or another one; NULL: unknown. */
const struct rc_grid *look_touch(struct tool *tool, const struct rc_grid *grid,
                                 const struct beside *beside, bool demanded);
/* Sets the contact, if it is known, and the pressure at which it yields. */
void look_contact(struct figure *figure, const struct rc_grid *grid, const struct beside *beside,
                  const struct rc_grid *touch);
/* The unit of positions in a frame: lengths, or plain numbers if its key dunit is another unit. */
enum unit look_unit(const struct rc_grid *grid);
/* Sets the position of a map. */
void look_extent(const struct window *window, struct figure *figure);
/* Ends the tool if --aspect would make the plot too long. */
void look_aspect(struct tool *tool, const struct rc_grid *grid, const struct figure *figure);
/* True if a frame of rc-leak has a critical constriction inside the figure: the cross marks it. */
bool look_throat(const struct rc_grid *grid, struct figure *figure);
/* The position of a section between the requested depths, and its materials; returns it on even rows, and the
 * media of the figure. The caller frees both. */
struct rc_grid *look_section(struct tool *tool, const struct args *args, const struct rc_grid *grid,
                             struct figure *figure);

#endif
