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
    double depth;        /* metres: the nearest within half a step; NAN: whatever     */
    size_t number;       /* of the case; 0: the first                                 */
    bool contact;        /* the pressure of its case is kept too                      */
};

/* What stands beside a frame that is drawn, of its case and on its grid; NULL: nothing, or it is that
 * frame. */
struct beside {
    struct rc_grid *pressure, *contact;
};

struct choice {
    const struct wish *wish;
    struct rc_grid *grid; /* the best so far; NULL: none matched                      */
    struct beside beside;
    double size;       /* its largest |value|                                      */
    bool by_size;      /* settled: preferred to other depths for that              */
    struct seen *seen; /* every frame that came by, without its values             */
    size_t n, capacity;
};

/* Keeps the frame when it is better than the one kept, or frees it. Of several depths the one with
 * the largest |value| is better, of several cases the first. */
void choice_offer(struct choice *choice, struct tool *tool, struct rc_grid *grid);
/* After the last frame: fails, naming what there is, when none matched, and says which frames were
 * left out that the user might have meant. */
void choice_settle(struct choice *choice, struct tool *tool);
void choice_free(struct choice *choice);
/* Place of a channel among those that are preferred; the others share the one past them. */
size_t choice_rank(const char *channel);

/* ---- channels.c ---- */

struct channel {
    const char *name, *title, *colormap;
    bool from_zero;      /* the colours begin at 0 where no value is negative */
    bool to_zero;        /* they end there                                    */
    const char *none;    /* what a value of 0 means, where that is no colour; NULL: itself */
    const char *missing; /* what a missing one means; NULL: not measured                   */
    const char *is[2];   /* what 1 and 2 mean where values are categories; NULL: none      */
    const char *axis;    /* of a curve of these; NULL: the title                           */
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

/* Cuts the map, and what stands beside it, to the window of `text`: X0:X1,Y0:Y1, contact, all, or NULL: about
 * the contact where that is a speck of the map of a pressure, unless each node is to be a pixel (`raw`).
 * `touch` tells what touches (NULL: nothing does). The values move to the front of the grids. */
void window_cut(struct tool *tool, const char *text, bool raw, struct rc_grid *grid,
                const struct beside *beside, const struct rc_grid *touch, struct window *window);

/* ---- means.c: pressures on a body that yields inside ---- */

struct means {
    bool taken;
    double four, one; /* Pa: the largest mean of 2 x 2 nodes, and the largest of a node */
};

/* A map whose nodes alternate becomes that of means about its nodes; of several maps the largest. */
void means_take(struct tool *tool, struct rc_grid *grid, struct means *means);

/* ---- section.c ---- */

/* The depths of the rows of a section, metres, which the caller frees. */
double *section_depths(struct tool *tool, const struct rc_grid *grid);
/* Which depths are drawn: all, or those of `text`, Z0:Z1. */
void section_range(struct tool *tool, const char *text, const struct rc_grid *grid,
                   const double *depth, double *top, double *bottom);
/* The section from top to bottom on even rows, between its own ones by a smooth curve that never
 * leaves the values beside it, and linearly between columns. Between rows in two media a point has
 * the value of the row in its own medium. */
struct rc_grid *section_even(struct tool *tool, const struct rc_grid *grid, const double *depth,
                             const struct layers *layers, double top, double bottom);

/* ---- media.c: what a coated body is made of ---- */

enum {
    MEDIA_NAME = 32
};

/* From the key `layers`; ends the tool where that makes no sense. */
void media_read(struct tool *tool, const struct rc_grid *grid, struct layers *layers);
/* The media of a section's figure, of which the caller frees `medium`. */
void media_set(struct tool *tool, const struct layers *layers, struct figure *figure);
/* "layer 2" or "substrate": where a slice of stresses lies; NULL: its keys do not say. */
const char *media_name(char text[MEDIA_NAME], const struct rc_grid *grid);
/* Depths of the interfaces, metres, which the caller frees; NULL: there is none. */
double *media_bottoms(const struct rc_grid *grid, size_t *n);

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
/* The ends of the colours of n frames, whose values are taken together; an end that was given stays. A
 * percentile is the value that so many per cent of the finite values are below, linear between two values;
 * of a pressure only values in contact count, which touch[k] tells (NULL: all count). */
void range_choose(struct rc_grid *const *grid, const struct rc_grid *const *touch, size_t n,
                  const struct survey *survey, const struct colormap *map,
                  const struct channel *what, struct range *range);
/* Warns of a range LO:HI, given as `text`, in which hardly any value can be told from another. */
void range_doubt(struct tool *tool, const char *text, const char *unit, const struct survey *survey,
                 const struct range *range);
/* Moves the lower end above 0, to the least value above it, six decades down at most. */
void range_take_logarithm(struct tool *tool, struct rc_grid *const *grid, size_t n,
                          struct range *range);
/* The least value; the end of the range where it is below that by rounding only. */
double range_least(struct rc_grid *const *grid, const struct rc_grid *const *touch, size_t n,
                   const struct survey *survey, const struct range *range);

/* ---- subtitle.c ---- */

struct subtitle {
    char text[1024];
    size_t n;
};

/* Adds a piece to the subtitle; one that does not fit is left out whole. */
void subtitle_add(struct subtitle *subtitle, const char *name, const char *value);
/* The largest value of means, and of single nodes. */
void means_say(const struct means *means, struct subtitle *subtitle, const char *unit);
/* The extremes, which categories have not; of means, of them and of single nodes. */
void subtitle_range(struct subtitle *subtitle, const struct rc_grid *grid,
                    const struct survey *survey, const struct means *means);
/* What all frames of a picture have in common: source, case, load, depth. */
void subtitle_common(struct subtitle *subtitle, struct rc_grid *const *grid, size_t n);
/* Whether a key is the same in all frames. */
bool subtitle_same(struct rc_grid *const *grid, size_t n, const char *key);
/* "load 10 N, depth 5 um": in what frame k differs from others of its picture. */
void frame_label(char *text, size_t size, struct rc_grid *const *grid, size_t n, size_t k);
/* `part` of the map is drawn. */
void subtitle_part(struct subtitle *subtitle, double part);
/* `largest`: of several depths this one was chosen because its size is largest. */
void subtitle_write(struct subtitle *subtitle, const struct rc_grid *grid,
                    const struct survey *survey, const struct means *means, double part,
                    bool largest);

struct words { /* of the legend */
    char largest[256], circle[96];
};

/* "largest 2.3 GPa at x = 3 µm, depth 12 µm" */
const char *words_largest(struct words *words, const struct rc_grid *grid, double value,
                          const char *across, double x, double depth);
/* "Hertz, radius 12 µm", and that radius, by what is given or by the keys; ends the tool when
 * neither says it. */
struct law_given;
const char *words_hertz(struct tool *tool, struct words *words, const struct rc_grid *grid,
                        const struct law_given *given, double *radius);

/* ---- table.c: columns of reports: tables with tabs, lines of JSON ---- */

struct column {
    const char *name; /* as asked for: of JSON also what is inside objects, "psd.q" or "q" */
    bool optional;    /* may be absent: then all its values are NaN                        */
    bool label;       /* its cells are kept as words, and v holds the numbers of these     */
    bool either;      /* the same where none of its cells is a number                      */
    bool found, words, numbers; /* words: some of its cells are text, numbers: some are none */
    char unit[24];              /* from the heading; empty: not said                        */
    char nearest[NAME_SIZE];    /* of the names there are, where there is no such one       */
    double *v;                  /* true is 1, false 0; NaN: unknown                         */
    char **word;                /* of labels, in the order in which they came               */
    size_t word_count;
};

struct table {
    const char *source; /* name of the file, for messages                               */
    struct column *column;
    size_t columns, rows, capacity;
    size_t *piece; /* rows at which curves of their own begin: arrays of further lines  */
    size_t pieces;
};

/* Reads the columns whose names are set; "-" is standard input. Ends the tool where the file is no
 * table, or lacks a column, naming those that it has. */
void table_read(struct table *table, struct tool *tool, const char *file);
void table_free(struct table *table);
/* What to do with an input that begins like a table; NULL: it does not. */
const char *table_remedy(const char *head);

/* ---- groups.c: rows that belong together ---- */

enum {
    GROUP_COLUMNS = 2
};

/* Orders the rows by the labels of n columns, which become pieces, in the order of their first rows;
 * `pieces`: within the pieces that there are. */
void groups_sort(struct table *table, struct tool *tool, const size_t *by, size_t n, bool pieces);

/* Rows that share an x, to a millionth of it, as one point: the mean of y, and one standard deviation to both
 * sides of it (n - 1; NaN of one row). */
struct spread {
    double *x, *y, *low, *high; /* one allocation, at x, which the caller frees */
    size_t n, least, most;      /* points; rows of one */
};

void spread_take(struct spread *spread, struct tool *tool, const struct table *table,
                 const double *x, const double *y, size_t n);

/* ---- law.c: published laws beside the points ---- */

struct law_given {
    double estar, radius, rms_slope; /* Pa, m, 1; NAN: not given */
    double area;                     /* of the map, m2            */
};

const char *law_word(size_t k);
/* What the law is called in a legend, with its source. */
const char *law_title(const char *law);
/* What it needs and is not given, as options; NULL: nothing. */
const char *law_lacks(const char *law, const struct law_given *given);
/* Whether it ties the two quantities, which are called as in reports of rc-solve. */
bool law_knows(const char *law, const char *x, const char *y);
/* Names of the quantities that it ties. */
const char *law_quantities(const char *law);
/* Whether the area of the map comes in. */
bool law_needs_area(const char *law, const struct law_given *given, const char *x, const char *y);
/* y where the other is x, SI; NAN: the law does not say. */
double law_value(const char *law, const struct law_given *given, const char *x, double x_value,
                 const char *y);
/* Density of the pressure p over the whole map, 1/Pa, under the mean pressure `mean` (Persson). */
double law_pressure_density(const struct law_given *given, double mean, double p);

/* ---- curves.c ---- */

/* What all pictures of curves share. */
struct curve_style {
    const char *log; /* NULL: linear; "" or "xy": both axes, "x", "y"   */
    const char *title, *subtitle, *law;
    const char *x_label, *y_label, *x_unit, *y_unit, *legend; /* NULL: what suits */
    const char *by, *error;                                   /* columns of tables */
    bool points, spread;
    bool hertz; /* beside a cut */
    struct law_given given;
    size_t width; /* as of a figure */
    double dpi;
    const char *family;
};

/* ---- wording.c: words of a figure as the command line gives them ---- */

/* The subtitle given, else the figure's own, but none under an empty title. */
const char *wording_subtitle(const char *title, const char *subtitle, const char *own);
/* Text and unit of the axis 'x' or 'y'; ends the tool where the unit is none of it. */
void wording_axis(struct tool *tool, const struct curve_style *style, char which,
                  struct graph_axis *axis);
/* Names of curves, kept in `text`; ends the tool where there are more or fewer than in the legend. */
void wording_legend(struct tool *tool, const struct curve_style *style, struct graph_series *series,
                    size_t n, char *text, size_t size);

/* What a picture says of itself beside its canvas. */
struct drawn {
    char title[256], source[256]; /* source empty: several */
    const char *stamp;            /* NULL: none */
};

/* Reads the tables named on the command line and draws the columns asked for as X:Y[,Y...]. */
struct canvas *curves_draw(struct tool *tool, const char *columns, const struct curve_style *style,
                           struct drawn *drawn);
/* Whether --log asks for that axis. */
bool curve_log(const struct curve_style *style, char axis);

/* ---- frames.c: several frames of one channel in one picture ---- */

enum {
    FRAMES = 64
};

struct frames {
    struct wish wish;     /* channel and section; of depths and cases the lists count */
    struct wanted wanted; /* depths and cases asked for; none: all                    */
    struct rc_grid *grid[FRAMES];
    size_t n;
    size_t left;  /* frames that were too many */
    bool border;  /* pressures of the cases are kept beside frames of another channel */
    bool demands; /* it must be known what touches                                    */
    struct rc_grid *pressure[FRAMES], *contact[FRAMES]; /* of cases */
    size_t pressures, contacts;
    const struct rc_grid *touch[FRAMES]; /* what touches in each frame; NULL: nothing tells */
};

/* What stands beside frame k. */
struct beside frames_beside(const struct frames *frames, size_t k);

/* Reads all inputs and keeps the frames that are asked for, of the channel that stands first in the
 * order of struct wish where none is. Ends the tool when there is none. */
void frames_read(struct frames *frames, struct tool *tool);
void frames_free(struct frames *frames);

/* ---- sheet.c: the frames as panels ---- */

/* "3x2"; "auto" gives 0 by 0. Ends the tool where it is neither. */
void sheet_size(struct tool *tool, const char *text, size_t *columns, size_t *rows);
/* Ends the tool when the frame and the first one, of which the figures say where they lie, cannot
 * share a scale. */
void sheet_check_alike(struct tool *tool, const struct rc_grid *first,
                       const struct figure *of_first, const struct rc_grid *grid,
                       const struct figure *figure);
/* All values together; ends the tool where a frame has no finite one. */
void sheet_survey(struct tool *tool, const struct frames *frames, struct survey *all);
/* Whether all are of one material, or of the same ones: one legend does for them. */
bool sheet_one_body(const struct frames *frames);
/* "a) load 10 N"; past z it is aa). */
void sheet_label(struct panel *panel, const struct frames *frames, size_t k);

/* ---- view.c: reliefs ---- */

/* AZ,EL in degrees; ends the tool where it is no such. */
void view_read(struct tool *tool, const char *text, struct view *view);
/* Ends the tool where --exaggeration does not suit what is drawn. */
void view_check(struct tool *tool, const struct rc_grid *grid, const struct figure *figure);
/* What a relief leaves to be said, after what the figure says. */
void view_say(const struct figure *figure, struct subtitle *subtitle);

/* ---- frame_curves.c: curves of frames, one each ---- */

/* The values along the line `cut`, as in "y=0"; lo and hi: of the upright axis, NAN: what suits. */
struct canvas *cut_draw(struct tool *tool, struct rc_grid *const *grid, size_t n, const char *cut,
                        double lo, double hi, const struct curve_style *style, struct drawn *drawn);
/* How values spread over the map; of pressures those in contact, which touch[k] tells, the rest as a note. */
struct canvas *histogram_draw(struct tool *tool, struct rc_grid *const *grid,
                              const struct rc_grid *const *touch, size_t n,
                              const struct curve_style *style, struct drawn *drawn);
/* The share of the map at or above each value. */
struct canvas *material_ratio_draw(struct tool *tool, struct rc_grid *const *grid, size_t n,
                                   const struct curve_style *style, struct drawn *drawn);

/* ---- args.c: what was asked for ---- */

struct args {
    struct wish wish; /* which frame */
    const char *colormap, *range, *title;
    const char *width, *window, *depths, *keep;
    double dpi;                  /* as given                                 */
    double aspect, exaggeration; /* as given; NAN: what suits                */
    bool contour, border, figure, raw, clip, hertz;
    struct numbers depth, number; /* as asked for: of several frames, or the one of wish */
    const char *curve;            /* X:Y[,Y...]: tables are drawn instead of maps */
    const char *cut;
    const char *view;  /* AZ,EL: a relief */
    const char *sheet; /* COLSxROWS or "auto" */
    bool histogram, material_ratio, hillshade;
    struct curve_style style; /* log, width, dpi and family: of every picture */
};

/* Ends the tool where options do not go together; settles the size of the picture, and of lists the
 * one depth and case that a picture of one frame shows. */
void args_check(struct tool *tool, struct args *args);
/* Whether the picture has curves of frames: along a line, how values spread, material ratio. */
bool args_lines(const struct args *args);
/* Whether it shows several frames: of a list of several, or a sheet. */
bool args_several(const struct args *args);

/* ---- look.c: what a figure is like ---- */

/* What a figure shows, and the values that its colours span. */
struct look {
    struct channel what;
    struct range range;
};

bool look_is_profile(const struct rc_grid *grid);
/* A warning that must not be overlooked; NULL: none. */
const char *look_stamp(const struct rc_grid *grid);
/* What a figure of n frames is like, but for its subtitle, the edge of contact, and where they lie. */
void look_figure(struct tool *tool, struct args *args, struct rc_grid *const *grid,
                 const struct rc_grid *const *touch, size_t n, const struct survey *survey,
                 struct look *look, struct figure *figure);
/* What tells the contact of a frame, of itself or beside it; NULL: nothing does. */
const struct rc_grid *look_touch(struct tool *tool, const struct rc_grid *grid,
                                 const struct beside *beside, bool demanded);
/* What touches, if anything does, and from which pressure on it yields. */
void look_contact(struct figure *figure, const struct rc_grid *grid, const struct beside *beside,
                  const struct rc_grid *touch);
/* In which places of a frame are read: lengths, or plain numbers where its key dunit says another
 * unit. */
enum unit look_unit(const struct rc_grid *grid);
/* Where a map lies. */
void look_extent(const struct window *window, struct figure *figure);
/* Ends the tool where --aspect would make the plot too long. */
void look_aspect(struct tool *tool, const struct rc_grid *grid, const struct figure *figure);
/* Whether a frame of rc-leak has the narrowest place of a way through, where the figure lies: the cross
 * stands there. */
bool look_throat(const struct rc_grid *grid, struct figure *figure);
/* Where a section lies, between the depths that are asked for, and what it is made of; gives it on
 * even rows, which the caller frees, and the medium of the figure. */
struct rc_grid *look_section(struct tool *tool, const struct args *args, const struct rc_grid *grid,
                             struct figure *figure);

#endif
