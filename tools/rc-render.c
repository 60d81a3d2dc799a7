/* rc-render: maps of a grid stream, or curves of a report, as a PNG. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"
#include "libcontact/contact.h"
#include "tools/cli/cli.h"
#include "tools/plot/plot.h"
#include "tools/render/render.h"

struct args {
    struct wish wish; /* which frame */
    const char *colormap, *range, *title;
    size_t width;
    bool contour, figure, raw;
    struct numbers depth, number; /* as asked for: of several frames, or the one of wish */
    const char *curve;            /* X:Y[,Y...]: tables are drawn instead of maps */
    const char *cut;
    const char *view;  /* AZ,EL: a relief */
    const char *sheet; /* COLSxROWS or "auto" */
    bool histogram, material_ratio, hillshade;
    struct curve_style style;
};

/* clang-format off */
static const struct opt opts[] = {
    {.name = "channel", .type = OPT_TEXT, .at = offsetof(struct args, wish.channel),
     .result = true, .arg = "NAME",
     .help = "what to draw (default: mises, pressure, height, else the first)"},
    {.name = "depth", .type = OPT_NUMBERS, .unit = UNIT_M, .at = offsetof(struct args, depth),
     .min = 0, .max = INFINITY, .result = true, .arg = "LIST",
     .help = "of a stress (default: where its size is largest)"},
    {.name = "section", .type = OPT_CHOICE, .at = offsetof(struct args, wish.section),
     .result = true, .arg = "x|y", .help = "a section across this axis instead of a map"},
    {.name = "case", .type = OPT_NUMBERS, .at = offsetof(struct args, number), .min = 1,
     .max = 9e15, .whole = true, .result = true, .arg = "LIST",
     .help = "of several loads or files (default: the first)"},
    {.name = "colormap", .type = OPT_CHOICE, .at = offsetof(struct args, colormap), .result = true,
     .words = colormap_name, .help = "colours for the values (default: what suits the channel)"},
    {.name = "range", .type = OPT_TEXT, .at = offsetof(struct args, range), .result = true,
     .arg = "LO:HI", .help = "values at the ends of the colours, as in 0:2GPa or -50nm:50nm"},
    {.name = "contour", .type = OPT_FLAG, .at = offsetof(struct args, contour), .result = true,
     .help = "draw lines at the marks of the colour bar, and the edge of contact"},
    {.name = "figure", .type = OPT_FLAG, .at = offsetof(struct args, figure), .result = true,
     .help = "with axes, colour bar and title: the default"},
    {.name = "raw", .type = OPT_FLAG, .at = offsetof(struct args, raw), .result = true,
     .help = "one pixel for each node and nothing else"},
    {.name = "title", .type = OPT_TEXT, .at = offsetof(struct args, title), .result = true,
     .arg = "TEXT", .help = "over the figure (default: what the channel is)"},
    {.name = "width", .type = OPT_COUNT, .at = offsetof(struct args, width), .min = FIGURE_NARROW,
     .max = FIGURE_WIDE, .result = true, .arg = "PIXELS",
     .help = "of the whole figure (default: what suits the map)"},
    {.name = "view", .type = OPT_TEXT, .at = offsetof(struct args, view), .result = true,
     .arg = "AZ,EL", .help = "as a lit surface, seen from azimuth and elevation in degrees"},
    {.name = "hillshade", .type = OPT_FLAG, .at = offsetof(struct args, hillshade), .result = true,
     .help = "with light from the upper left on the slopes of the map"},
    {.name = "sheet", .type = OPT_TEXT, .at = offsetof(struct args, sheet), .result = true,
     .arg = "COLSxROWS",
     .help = "all frames that match in one picture, in so many columns and rows, or auto"},
    {.name = "cut", .type = OPT_TEXT, .at = offsetof(struct args, cut), .result = true,
     .arg = "AXIS=PLACE", .help = "draw the values along a line, as in y=0"},
    {.name = "histogram", .type = OPT_FLAG, .at = offsetof(struct args, histogram), .result = true,
     .help = "draw how the values spread; of pressures, those in contact"},
    {.name = "material-ratio", .type = OPT_FLAG, .at = offsetof(struct args, material_ratio),
     .result = true, .help = "draw the share of the map at or above each value"},
    {.name = "curve", .type = OPT_TEXT, .at = offsetof(struct args, curve), .result = true,
     .arg = "X:Y[,Y...]", .help = "draw columns Y over X of reports or tables instead of a map"},
    {.name = "log", .type = OPT_CHOICE, .at = offsetof(struct args, style.log), .result = true,
     .arg = "x|y|xy", .optional = true, .help = "logarithmic axes of curves (alone: both)"},
    {.name = "law", .type = OPT_CHOICE, .at = offsetof(struct args, style.law), .result = true,
     .words = law_word, .help = "draw a published law beside the curve"},
    {.name = "estar", .type = OPT_NUMBER, .unit = UNIT_PA,
     .at = offsetof(struct args, style.given.estar), .min = 0, .max = INFINITY, .above = true,
     .result = true, .arg = "MODULUS", .help = "composite modulus E*, for --law"},
    {.name = "radius", .type = OPT_NUMBER, .unit = UNIT_M,
     .at = offsetof(struct args, style.given.radius), .min = 0, .max = INFINITY, .above = true,
     .result = true, .arg = "LENGTH", .help = "composite radius of the sphere, for --law hertz"},
    {.name = "rms-slope", .type = OPT_NUMBER, .at = offsetof(struct args, style.given.rms_slope),
     .min = 0, .max = INFINITY, .above = true, .result = true, .arg = "SLOPE",
     .help = "RMS gradient of the surface, for --law persson"},
    {.name = NULL},
};
/* clang-format on */

/* Before a file is made of that name. */
static void
settle(struct tool *t)
{
    ending_demand_png(t, "-o", t->out_name);
}

static const struct tool_info info = {
    .name = "rc-render",
    .summary = "Draw maps of a grid stream, or curves of a report, as a PNG",
    .operands = "[FILE...]",
    .foreign = table_remedy,
    .examples =
        "  rc-synth sphere --nx 65 --ny 65 --dx 1um --radius 1mm | rc-render -o sphere.png\n"
        "  rc-render --channel pressure --range 0:6GPa --contour -o contact.png result.rcg\n"
        "  rc-solve --radius 2mm --load 0.1N:1N:4 --estar 114GPa --report r.tsv -o r.rcg flat.rcg\n"
        "  rc-render --curve load:contact_area --log -o area.png r.tsv\n",
    .opts = opts,
    .reads = READS_STREAM,
    .writes = WRITES_BYTES,
    .settle = settle,
};

static bool
is_profile(const struct rc_grid *g)
{
    return (g->nx == 1) != (g->ny == 1) && rc_grid_get(g, "section") == NULL;
}

/* ---- sections: rows are depths ---- */

/* Where the rows of a section begin and end; the surface bounds the first one. */
static double *
section_rows(struct tool *t, const struct rc_grid *g)
{
    const char *depths = rc_grid_get(g, "depths");
    double *edge = malloc((g->ny + 1) * sizeof *edge);
    struct numbers d = {0};
    struct rc_err err;

    if (edge == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "out of memory for %zu depths", g->ny);
    if (depths != NULL && unit_numbers(depths, UNIT_M, &d, &err) != RC_OK)
        tool_die_at(t, g, EXIT_IMPOSSIBLE, "its key depths: %s", err.text);
    if (depths != NULL && d.n != g->ny)
        tool_die_at(t, g, EXIT_IMPOSSIBLE, "its key depths holds %zu depths for %zu rows", d.n,
                    g->ny);
    for (size_t j = 0; j <= g->ny; j++)
        edge[j] = ((double)j - 0.5) * g->dy;
    for (size_t j = 1; depths != NULL && j < g->ny; j++) {
        if (!(d.v[j] > d.v[j - 1]))
            tool_die_at(t, g, EXIT_IMPOSSIBLE, "its key depths must rise from row to row");
        edge[j] = 0.5 * (d.v[j] + d.v[j - 1]);
    }
    if (depths != NULL && g->ny > 1) {
        edge[0] = d.v[0] - (edge[1] - d.v[0]);
        edge[g->ny] = d.v[g->ny - 1] + (d.v[g->ny - 1] - edge[g->ny - 1]);
    }
    edge[0] = fmax(edge[0], 0);
    free(d.v);
    return edge;
}

/* ---- pictures ---- */

static void
raw_row(const struct rc_grid *g, const struct figure *f, size_t j, unsigned char *rgb)
{
    const double *v = g->v + j * g->nx;

    for (size_t i = 0; i < g->nx; i++) {
        struct rgb c = isnan(v[i])                    ? f->map->missing
                       : f->zero_is_none && v[i] == 0 ? f->map->none
                                                      : colormap_value(f->map, f->lo, f->hi, v[i]);

        rgb[3 * i] = c.r;
        rgb[3 * i + 1] = c.g;
        rgb[3 * i + 2] = c.b;
    }
}

/* What is written: a canvas, or without one a pixel for each node. */
struct drawing {
    struct tool *tool;
    const struct rc_grid *grid;
    const struct figure *figure;
    struct canvas *canvas;
    size_t rows;
};

static enum rc_status
next_row(void *ctx, size_t y, unsigned char *rgb, struct rc_err *err)
{
    const struct drawing *d = ctx;

    tool_progress(d->tool, "row %zu of %zu", y, d->rows);
    if (d->canvas != NULL)
        return canvas_row(d->canvas, y, rgb, err);
    raw_row(d->grid, d->figure, y, rgb);
    return RC_OK;
}

/* The picture says how it was made. Without a grid the words are in the figure's. */
static void
write_picture(struct tool *t, const struct rc_grid *g, const struct figure *f, struct canvas *c)
{
    size_t w = c == NULL ? g->nx : canvas_width(c), h = c == NULL ? g->ny : canvas_height(c);
    struct drawing d = {t, g, f, c, h};
    const char *history = g == NULL ? NULL : rc_grid_get(g, "history"), *own = tool_history(t);
    size_t size = strlen(own) + (history == NULL ? 0 : strlen(history)) + 4;
    char *made = malloc(size), software[64];
    const struct picture_text text[] = {
        {"Title", f->title},
        {"Description", made},
        {"Warning", f->stamp},
        {"Software", software},
        {"Source", g == NULL ? f->subtitle : rc_grid_get(g, "source")}};
    struct rc_err err;

    if (made == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "out of memory");
    snprintf(made, size, "%s%s%s", history == NULL ? "" : history, history == NULL ? "" : " | ",
             own);
    snprintf(software, sizeof software, "rc-render %s", rc_version());
    if (picture_write(t->out, w, h, text, sizeof text / sizeof *text, next_row, &d, &err) != RC_OK)
        tool_die(t, EXIT_IMPOSSIBLE, "%s", err.text);
    free(made);
}

static void
warn_of_characters(struct tool *t, const struct canvas *c)
{
    char text[512];

    if (canvas_warning(c, text, sizeof text) != NULL)
        tool_warn(t, "%s", text);
}

/* Where the values of a frame lie. Gives, of a section, the edges of its rows, which the caller
 * frees; NULL of a map. */
static double *
set_extent(struct tool *t, const struct rc_grid *g, struct figure *f)
{
    const char *section = rc_grid_get(g, "section");
    double *rows;

    f->across = "x";
    f->down = "y";
    f->right = 0.5 * (double)g->nx * g->dx;
    f->left = -f->right;
    f->bottom = 0.5 * (double)g->ny * g->dy;
    f->top = -f->bottom;
    if (section == NULL)
        return NULL;
    f->row_edge = rows = section_rows(t, g);
    f->across = strcmp(section, "x") == 0 ? "y" : "x";
    f->down = "depth";
    f->top = rows[0];
    f->bottom = rows[g->ny];
    return rows;
}

static void
draw_figure(struct tool *t, const struct rc_grid *g, struct figure *f)
{
    double *rows = set_extent(t, g, f);
    struct canvas *c;
    struct rc_err err;

    if ((c = figure_draw(f, g, &err)) == NULL)
        tool_die_at(t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    warn_of_characters(t, c);
    write_picture(t, g, f, c);
    canvas_free(c);
    free(rows);
}

/* ---- reliefs ---- */

static void
draw_relief(struct tool *t, const struct args *a, const struct rc_grid *g, struct figure *f,
            struct subtitle *subtitle)
{
    struct view view;
    double *rows;
    struct canvas *c;
    struct rc_err err;

    view_read(t, a->view, &view);
    if (is_profile(g) || rc_grid_get(g, "section") != NULL || g->nx == 1 || g->ny == 1)
        tool_die_at(t, g, EXIT_IMPOSSIBLE,
                    "a relief is of a map, this is a profile or a section: leave out --view");
    view.peaks = f->zero_is_none;
    rows = set_extent(t, g, f);
    view_say(f, subtitle);
    f->missing = 0; /* they are holes */
    if ((c = relief_draw(f, &view, g, &err)) == NULL)
        tool_die_at(t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    warn_of_characters(t, c);
    write_picture(t, g, f, c);
    canvas_free(c);
    free(rows);
}

/* What nobody may overlook; NULL: nothing. */
static const char *
stamp_of(const struct rc_grid *g)
{
    const char *converged = rc_grid_get(g, "converged");

    return converged != NULL && strcmp(converged, "no") == 0 ? "not converged" : NULL;
}

/* What a figure of these values is like, but for its subtitle and where they lie. */
static struct figure
set_figure(struct tool *t, struct args *a, const struct rc_grid *g, const struct survey *s)
{
    static struct channel what; /* its title lasts */
    struct figure f;

    what = channel_of(g, s);
    f = (struct figure){
        .title = a->title == NULL ? what.title : a->title,
        .stamp = stamp_of(g),
        .quantity = what.title,
        .unit = g->unit,
        .map = colormap_find(a->colormap == NULL ? what.colormap : a->colormap),
        .min = s->min,
        .max = s->max,
        .missing = s->missing,
        .zero_is_none = strcmp(g->channel, "pressure") == 0,
        .zeros = s->zeros,
        .contour = a->contour,
        .hillshade = a->hillshade,
        .width = a->width,
    };
    range_choose(g, s, f.map, &what, is_profile(g) && !a->raw, &f.lo, &f.hi);
    if (a->range != NULL)
        a->range = range_read(t, a->range, g, &f.lo, &f.hi);
    return f;
}

static const char shaded[] = "shaded, light from the upper left";

static void
render(struct tool *t, struct args *a, const struct rc_grid *g, bool largest)
{
    struct survey s;
    struct subtitle subtitle = {.n = 0};
    struct figure f;

    survey_map(g, &s);
    if (isnan(s.min))
        tool_die_at(t, g, EXIT_IMPOSSIBLE,
                    "none of its %zu values is a finite number: there is "
                    "nothing to draw",
                    g->nx * g->ny);
    subtitle_write(&subtitle, g, &s, largest);
    f = set_figure(t, a, g, &s);
    f.subtitle = subtitle.text;
    if (a->hillshade && !is_profile(g))
        subtitle_add(&subtitle, shaded, "");
    if ((a->contour || a->hillshade) && is_profile(g))
        tool_warn(t, "a profile is drawn as a curve: --%s does nothing",
                  a->contour ? "contour" : "hillshade");
    if (a->raw)
        write_picture(t, g, &f, NULL);
    else if (a->view != NULL)
        draw_relief(t, a, g, &f, &subtitle);
    else
        draw_figure(t, g, &f);
}

/* ---- sheets ---- */

static void
render_sheet(struct tool *t, struct args *a, const struct frames *frames)
{
    struct panel *panel = calloc(frames->n, sizeof *panel);
    struct subtitle subtitle = {.n = 0};
    struct survey all;
    struct figure f;
    size_t columns, rows, nodes = 0;
    double *edge[FRAMES + 1];
    struct canvas *c;
    struct rc_err err;

    if (panel == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "out of memory");
    sheet_size(t, a->sheet == NULL ? "auto" : a->sheet, &columns, &rows);
    if (columns > 0 && frames->n > columns * rows)
        tool_die(t, EXIT_IMPOSSIBLE,
                 "%zu frames match, --sheet %s holds %zu: choose with --case and --depth",
                 frames->n, a->sheet, columns * rows);
    sheet_survey(t, frames, &all);
    f = set_figure(t, a, frames->grid[0], &all);
    subtitle_common(&subtitle, frames->grid, frames->n);
    subtitle_range(&subtitle, &all, frames->grid[0]->unit);
    if (a->hillshade)
        subtitle_add(&subtitle, shaded, "");
    f.subtitle = subtitle.text;
    for (size_t k = 0; k < frames->n; k++) {
        panel[k].figure = f;
        panel[k].grid = frames->grid[k];
        edge[k] = set_extent(t, frames->grid[k], &panel[k].figure);
        sheet_check_alike(t, frames->grid[0], &panel[0].figure, frames->grid[k], &panel[k].figure);
        sheet_label(&panel[k], frames, k);
        f.stamp = f.stamp == NULL ? stamp_of(frames->grid[k]) : f.stamp;
        nodes += frames->grid[k]->nx * frames->grid[k]->ny;
    }
    f.nodes = nodes;
    edge[frames->n] = set_extent(t, frames->grid[0], &f);
    if (columns == 0)
        columns = panels_columns(frames->n, (f.right - f.left) / (f.bottom - f.top));
    c = panels_draw(&(struct panels){&f, panel, frames->n, columns, a->width}, &err);
    if (c == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "%s", err.text);
    warn_of_characters(t, c);
    write_picture(t, frames->grid[0], &f, c);
    canvas_free(c);
    for (size_t k = 0; k <= frames->n; k++)
        free(edge[k]);
    free(panel);
}

/* ---- curves ---- */

static void
render_curves(struct tool *t, struct args *a)
{
    struct drawn drawn = {.stamp = NULL};
    struct figure words;
    struct canvas *c;

    a->style.title = a->title;
    a->style.width = a->width;
    c = curves_draw(t, a->curve, &a->style, &drawn);
    words = (struct figure){.title = drawn.title,
                            .stamp = drawn.stamp,
                            .subtitle = *drawn.source == '\0' ? NULL : drawn.source};
    warn_of_characters(t, c);
    write_picture(t, NULL, &words, c);
    canvas_free(c);
}

/* Curves of frames: along a line, how values spread, material ratio. */
static bool
draws_lines(const struct args *a)
{
    return a->cut != NULL || a->histogram || a->material_ratio;
}

static struct canvas *
draw_lines(struct tool *t, struct args *a, const struct frames *f, struct drawn *drawn)
{
    double lo = NAN, hi = NAN;

    if (a->cut == NULL)
        return (a->histogram ? histogram_draw : material_ratio_draw)(t, f->grid, f->n, &a->style,
                                                                     drawn);
    if (a->range != NULL)
        a->range = range_read(t, a->range, f->grid[0], &lo, &hi);
    return cut_draw(t, f->grid, f->n, a->cut, lo, hi, &a->style, drawn);
}

static void
render_lines(struct tool *t, struct args *a, const struct frames *f)
{
    struct drawn drawn = {.stamp = NULL};
    struct canvas *c;

    a->style.title = a->title;
    a->style.width = a->width;
    c = draw_lines(t, a, f, &drawn);
    warn_of_characters(t, c);
    write_picture(t, f->grid[0], &(struct figure){.title = drawn.title, .stamp = drawn.stamp}, c);
    canvas_free(c);
}

/* ---- which picture ---- */

/* Options that go with some kinds of pictures only. */
static void
leave_out(struct tool *t, const char *kind, const char *const *option)
{
    for (; *option != NULL; option++)
        if (tool_given(t, *option))
            tool_die(t, EXIT_USAGE, "%s: leave out --%s", kind, *option);
}

static void
check_kinds(struct tool *t, const struct args *a)
{
    static const char *const of_maps[] = {"channel",  "depth", "section", "case",
                                          "colormap", "range", "contour", NULL};
    static const char *const of_colours[] = {"colormap", "contour", NULL};
    static const char *const of_laws[] = {"law", "estar", "radius", "rms-slope", NULL};
    int kinds = (a->curve != NULL) + (a->cut != NULL) + a->histogram + a->material_ratio +
                (a->raw || a->figure);

    if (kinds > 1 && !(a->raw && a->figure))
        tool_die(t, EXIT_USAGE,
                 "--raw, --figure, --curve, --cut, --histogram and --material-ratio are kinds of "
                 "picture: give one");
    if (a->curve != NULL)
        leave_out(t, "--curve draws tables, not maps", of_maps);
    if (draws_lines(a))
        leave_out(t, "a curve has no colours", of_colours);
    if (a->range != NULL && (a->histogram || a->material_ratio))
        tool_die(t, EXIT_USAGE, "--range is for maps and for --cut: leave it out");
    if (a->curve == NULL && !draws_lines(a) && a->style.log != NULL)
        tool_die(t, EXIT_USAGE, "--log is for curves: add --curve X:Y");
    if (a->curve == NULL && !a->histogram)
        leave_out(t, "laws stand beside --curve and --histogram", of_laws);
}

/* A list of several, or a sheet, shows several frames. */
static bool
shows_several(const struct args *a)
{
    return a->depth.n > 1 || a->number.n > 1 || a->sheet != NULL;
}

/* Of lists the one frame that a picture shows, unless it shows several. */
static void
check_lists(struct tool *t, struct args *a)
{
    if (shows_several(a) && (a->raw || a->curve != NULL))
        tool_die(t, EXIT_USAGE, "--raw shows one frame: give one --depth and one --case");
    if (a->hillshade && (a->raw || a->curve != NULL || draws_lines(a) || a->view != NULL))
        tool_die(t, EXIT_USAGE, "--hillshade is for flat maps with axes: leave it out");
    if (a->view != NULL &&
        (a->raw || a->curve != NULL || draws_lines(a) || a->contour || shows_several(a)))
        tool_die(t, EXIT_USAGE,
                 "--view draws one map as a relief: leave out --raw, --contour, curves and lists");
    if (a->sheet != NULL && (a->raw || a->curve != NULL || draws_lines(a)))
        tool_die(t, EXIT_USAGE, "--sheet is for maps: leave it out");
    if (a->depth.n == 1)
        a->wish.depth = a->depth.v[0];
    if (a->number.n == 1)
        a->wish.number = (size_t)a->number.v[0];
}

static void
check_options(struct tool *t, const struct args *a)
{
    if (a->raw && a->figure)
        tool_die(t, EXIT_USAGE, "--raw and --figure are two kinds of picture: give one");
    if (a->raw && a->contour)
        tool_die(t, EXIT_USAGE, "--raw draws nothing but nodes: leave out --contour");
    if (a->raw && a->width != 0)
        tool_die(t, EXIT_USAGE, "--raw is as wide as the map has columns: leave out --width");
    if (a->title != NULL && !rc_utf8_valid(a->title))
        tool_die(t, EXIT_USAGE, "--title: the text is not UTF-8");
}

/* One frame: the best of all. */
static void
read_one(struct tool *t, struct args *a)
{
    struct choice choice = {.wish = &a->wish};
    struct rc_grid *g;

    while ((g = tool_read(t)) != NULL)
        choice_offer(&choice, t, g);
    choice_settle(&choice, t);
    if (draws_lines(a))
        render_lines(t, a, &(struct frames){.grid = {choice.grid}, .n = 1});
    else
        render(t, a, choice.grid, choice.by_size);
    choice_free(&choice);
}

static void
read_several(struct tool *t, struct args *a)
{
    static struct frames frames;

    frames.wish = a->wish;
    frames.wanted = (struct wanted){.depth = a->depth, .number = a->number};
    frames_read(&frames, t); /* frees the lists */
    a->depth = a->number = (struct numbers){0};
    (draws_lines(a) ? render_lines : render_sheet)(t, a, &frames);
    frames_free(&frames);
}

int
main(int argc, char **argv)
{
    struct args args = {.wish = {.depth = NAN},
                        .style.given = {.estar = NAN, .radius = NAN, .rms_slope = NAN}};
    struct tool t;

    tool_start(&t, &info, argc, argv, &args);
    check_options(&t, &args);
    check_kinds(&t, &args);
    check_lists(&t, &args);
    if (args.curve != NULL)
        render_curves(&t, &args);
    else if (shows_several(&args))
        read_several(&t, &args);
    else
        read_one(&t, &args);
    free(args.depth.v);
    free(args.number.v);
    return tool_finish(&t);
}
