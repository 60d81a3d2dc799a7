/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rc-render: maps of a grid stream, or curves of a report, as a picture: PNG, SVG or PDF. */
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "formats/core/core.h"
#include "tools/plot/plot.h"
#include "tools/render/render.h"

#define AT(field) .at = offsetof(struct args, field), .result = true
#define ABOVE_0 .min = 0, .max = INFINITY, .above = true
#define LINES "cut|histogram|material-ratio"
#define CURVES "curve|" LINES
#define SEVERAL "depth LIST|case LIST|sheet"
#define OF_MAPS .against = RULES({.with = "curve", .because = "--curve draws tables, not maps"})
#define OF_COLOURS .against = RULES({.with = CURVES, .because = "a curve has no colours"})
#define OF_PLACES                                                                                  \
    {                                                                                              \
        .with = CURVES, .because = "a curve is not part of a map"                                  \
    }
#define OF_CURVES .needs = RULES({.with = CURVES})
#define OF_TABLES .needs = RULES({.with = "curve"})
#define KIND(others) .against = RULES({.with = others, .because = "each is a kind of picture"})
/* clang-format off */
static const struct opt opts[] = {
    {.name = "channel", .type = OPT_TEXT, AT(wanted.channel), .arg = "NAME",
     OF_MAPS,
     .help = "channel to draw (default: mises, pressure, height, else the first)"},
    {.name = "depth", .type = OPT_NUMBERS, .unit = UNIT_M, AT(wanted.depth), .min = 0, .max = INFINITY,
     .arg = "LIST",
     OF_MAPS,
     .help = "depth of a stress, or the nearest within half a step (default: that of the largest magnitude)"},
    {.name = "section", .type = OPT_CHOICE, AT(wanted.section), .arg = "x|y",
     OF_MAPS,
     .help = "a section across this axis instead of a map"},
    {.name = "case", .type = OPT_NUMBERS, AT(wanted.number), .min = 1, .max = 9e15, .whole = true,
      .arg = "LIST",
     OF_MAPS,
     .help = "case, for several loads or files (default: the first)"},
    {.name = "colormap", .type = OPT_CHOICE, AT(colormap), .words = colormap_name,
     OF_COLOURS,
     .help = "colour map of the values (default: by channel)"},
    {.name = "range", .type = OPT_TEXT, AT(range), .arg = "LO:HI",
     .against = RULES({.with = "curve|histogram|material-ratio", .because = "it is for maps and --cut",
                       .remedy = "the axes of a curve have --x-range and --y-range"}),
     .help = "range of the colours: values as 0:2GPa, percentiles as 1%:99%, or symmetric"},
    {.name = "log", .type = OPT_CHOICE, AT(style.log), .arg = "x|y|xy", .optional = true,
     .needs = RULES({.with = CURVES, .word = "x|y|xy", .because = "the words name axes of curves",
                     .remedy = "for a map give --log without a word"}),
     .help = "logarithmic colours, or axes of curves (without a value: both axes)"},
    {.name = "clip", .type = OPT_FLAG, AT(clip),
     .against = RULES({.with = CURVES, .because = "a curve has no colours"},
                      {.with = "range", .because = "--clip chooses the range"}),
     .help = "range of the colours from 0.5 % to 99.5 % of the nodes"},
    {.name = "contour", .type = OPT_FLAG, AT(contour),
     OF_COLOURS,
     .help = "draw contour lines at the marks of the colour bar, and the edge of contact"},
    {.name = "border", .type = OPT_FLAG, AT(border),
     OF_COLOURS,
     .help = "of the contour lines only the edge of contact, if the stream has a pressure"},
    {.name = "hertz", .type = OPT_FLAG, AT(hertz),
     .against = RULES({.with = "curve|histogram|material-ratio", .because = "it is for a map or --cut",
                       .remedy = "with --curve take --law hertz"},
                      {.with = "view|" SEVERAL, .because = "it is for one flat map"}),
     .help = "draw the Hertzian contact of a smooth sphere or cylinder: its edge, with --cut its pressure"},
    {.name = "window", .type = OPT_TEXT, AT(window), .arg = "X0:X1,Y0:Y1",
     .against = RULES(OF_PLACES,
                      {.with = SEVERAL, .word = "contact", .because = "the contact differs from map to map",
                       .remedy = "give --window X0:X1,Y0:Y1"}),
     .help = "part of the map to draw; contact; or all"},
    {.name = "depth-range", .type = OPT_TEXT, AT(depths), .arg = "Z0:Z1",
     .against = RULES(OF_PLACES),
     .help = "the depths of a section to draw"},
    {.name = "keep", .type = OPT_CHOICE, AT(keep), .arg = "mean|max",
     OF_COLOURS,
     .help = "value of nodes that share a pixel: their mean (default) or largest"},
    {.name = "figure", .type = OPT_FLAG, AT(figure),
     .against = RULES({.with = CURVES "|raw", .because = "each is a kind of picture"}),
     .help = "with axes, colour bar and title: the default"},
    {.name = "raw", .type = OPT_FLAG, AT(raw),
     .against = RULES({.with = CURVES, .because = "each is a kind of picture"},
                      {.with = "contour|border|aspect|hertz", .because = "it draws only nodes"},
                      {.with = "width", .because = "such a picture has one pixel for each column of the map"},
                      {.with = "font", .because = "it draws no text"},
                      {.with = SEVERAL, .because = "it shows one frame",
                       .remedy = "give one --depth and one --case"}),
     .help = "one pixel for each node, without axes and text"},
    {.name = "title", .type = OPT_TEXT, AT(style.paper.title), .arg = "TEXT",
     .help = "title of the figure (default: by channel)"},
    {.name = "subtitle", .type = OPT_TEXT, AT(style.paper.subtitle), .arg = "TEXT",
     .help = "line below the title (default: source, load and others)"},
    {.name = "width", .type = OPT_TEXT, AT(width), .arg = "WIDTH",
     .help = "width of the whole figure in pixels, or with a unit on paper, as 85mm"},
    {.name = "dpi", .type = OPT_NUMBER, AT(dpi), .min = 50, .max = 2400, .arg = "PIXELS",
     .help = "pixels per inch; text is then 7 points high (default for a --width in mm: 300)"},
    {.name = "font", .type = OPT_TEXT, AT(style.paper.family), .arg = "FAMILY",
     .help = "font of all text (default: the sans serif of the system)"},
    {.name = "view", .type = OPT_TEXT, AT(view), .arg = "AZ,EL",
     .against = RULES({.with = CURVES "|raw|contour|border|" SEVERAL,
                       .because = "it draws one map as a relief"},
                      {.with = "aspect", .remedy = "a relief has --exaggeration"},
                      {.with = "log", .because = "a relief has an even axis upwards"}),
     .help = "draw a lit surface, seen from this azimuth and elevation in degrees"},
    {.name = "exaggeration", .type = OPT_NUMBER, AT(exaggeration), ABOVE_0, .arg = "N",
     .needs = RULES({.with = "view", .because = "a flat map has no heights to scale"}),
     .help = "of a relief: heights N times as large as lengths (default: by the range of heights)"},
    {.name = "aspect", .type = OPT_NUMBER, AT(aspect), ABOVE_0, .arg = "N",
     .against = RULES(OF_PLACES),
     .help = "scale of the vertical axis N times that of the horizontal one, for sections"},
    {.name = "hillshade", .type = OPT_FLAG, AT(hillshade),
     .against = RULES({.with = CURVES "|raw|view", .because = "it is for flat maps with axes"}),
     .help = "shade the slopes of the map with light from the upper left"},
    {.name = "sheet", .type = OPT_TEXT, AT(sheet), .arg = "COLSxROWS",
     .against = RULES({.with = CURVES, .because = "it is for maps"}),
     .help = "all matching frames in one picture, in this number of columns and rows, or auto"},
    {.name = "cut", .type = OPT_TEXT, AT(cut), .arg = "AXIS=PLACE",
     KIND("curve|histogram|material-ratio"),
     .help = "draw the values along a line, as in y=0"},
    {.name = "histogram", .type = OPT_FLAG, AT(histogram),
     KIND("curve|material-ratio"),
     .help = "draw the histogram of the values, for pressures of those in contact"},
    {.name = "material-ratio", .type = OPT_FLAG, AT(material_ratio),
     KIND("curve"),
     .help = "draw the material ratio: fraction of the map at or above each value"},
    {.name = "curve", .type = OPT_TEXT, AT(curve), .arg = "X:Y[,Y...]",
     .help = "draw columns Y over X of reports or tables instead of a map"},
    {.name = "by", .type = OPT_TEXT, AT(style.by), .arg = "COLUMN[,COLUMN]",
     OF_TABLES,
     .help = "a curve for each value of a column of --curve; of two: colour by one, dashes by the other"},
    {.name = "points", .type = OPT_FLAG, AT(style.points),
     OF_TABLES,
     .help = "of --curve: markers without lines"},
    {.name = "error", .type = OPT_TEXT, AT(style.error), .arg = "COLUMN[,...]",
     OF_TABLES,
     .help = "of --curve: error bars of this column"},
    {.name = "spread", .type = OPT_FLAG, AT(style.spread),
     OF_TABLES,
     .against = RULES({.with = "error", .because = "they are two kinds of bars"}),
     .help = "of --curve: mean of rows with equal x, with bars of their standard deviation"},
    {.name = "legend", .type = OPT_TEXT, AT(style.legend), .arg = "TEXT[;...]",
     OF_CURVES,
     .help = "names of the curves, in the order of the legend"},
    {.name = "x-label", .type = OPT_TEXT, AT(style.x_label), .arg = "TEXT",
     OF_CURVES,
     .help = "title of the horizontal axis of a curve"},
    {.name = "y-label", .type = OPT_TEXT, AT(style.y_label), .arg = "TEXT",
     OF_CURVES,
     .help = "the same upwards"},
    {.name = "x-unit", .type = OPT_TEXT, AT(style.x_unit), .arg = "UNIT",
     OF_CURVES,
     .help = "unit of the axis of a curve, as in mN, mm2 or %"},
    {.name = "y-unit", .type = OPT_TEXT, AT(style.y_unit), .arg = "UNIT",
     OF_CURVES,
     .help = "the same upwards"},
    {.name = "x-range", .type = OPT_TEXT, AT(style.x_range), .arg = "LO:HI",
     OF_CURVES,
     .help = "ends of the horizontal axis of a curve, as in 0:5mN (default: those of the points)"},
    {.name = "y-range", .type = OPT_TEXT, AT(style.y_range), .arg = "LO:HI",
     OF_CURVES,
     .against = RULES({.with = "range", .because = "both are the ends of the vertical axis"}),
     .help = "the same upwards (default: those of the points within --x-range)"},
    {.name = "law", .type = OPT_CHOICE, AT(style.law), .words = law_word,
     .needs = RULES({.with = "curve|histogram", .because = "it is for laws beside a curve"}),
     .help = "draw a published law beside the curve"},
    {.name = "estar", .type = OPT_NUMBER, .unit = UNIT_PA, AT(style.given.estar), ABOVE_0, .arg = "MODULUS",
     .needs = RULES({.with = "curve|histogram|hertz", .because = "it is for laws and --hertz"}),
     .help = "composite modulus E*, for --law and --hertz"},
    {.name = "radius", .type = OPT_NUMBER, .unit = UNIT_M, AT(style.given.radius), ABOVE_0, .arg = "LENGTH",
     .needs = RULES({.with = "curve|histogram|hertz", .because = "it is for laws and --hertz"}),
     .help = "composite radius of the sphere, for --law hertz and --hertz"},
    {.name = "rms-slope", .type = OPT_NUMBER, AT(style.given.rms_slope), ABOVE_0, .arg = "SLOPE",
     .needs = RULES({.with = "curve|histogram", .because = "it is for laws beside a curve"}),
     .help = "RMS gradient of the surface, for --law persson"},
    {.name = NULL},
};
/* clang-format on */

/* Checks the suffix of -o before a file of that name is made. */
static void
settle(struct tool *t)
{
    ending_demand_picture(t, "-o", t->out_name);
}

static const struct tool_info info = {
    .name = "rc-render",
    .summary = "Draw maps of a grid stream, or curves of a report, as a PNG, SVG or PDF",
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

/* ---- pictures ---- */

static void
raw_row(const struct rc_grid *g, const struct figure *f, const struct colormap_table *table,
        size_t j, unsigned char *rgb)
{
    const double *v = g->v + j * g->nx;

    for (size_t i = 0; i < g->nx; i++) {
        struct rgb c = isnan(v[i]) ? f->bar.map->missing
                       : f->nodes.zero_is_none && v[i] == 0
                           ? f->bar.map->none
                           : colormap_look_up(table, figure_place(f, v[i]));

        rgb[3 * i] = c.r;
        rgb[3 * i + 1] = c.g;
        rgb[3 * i + 2] = c.b;
    }
}

/* A raw picture, row by row. */
struct drawing {
    struct tool *tool;
    const struct rc_grid *grid;
    const struct figure *figure;
    struct colormap_table colours;
};

static enum rc_status
next_row(void *ctx, size_t y, unsigned char *rgb, struct rc_err *err)
{
    const struct drawing *d = ctx;

    (void)err;
    tool_progress(d->tool, (double)y / (double)d->grid->ny, "row %zu of %zu", y, d->grid->ny);
    raw_row(d->grid, d->figure, &d->colours, y, rgb);
    return RC_OK;
}

/* Writes the canvas or, if it is NULL, the raw picture of the figure, with texts that describe how it was
 * made. Without a grid the source is the subtitle. */
static void
write_picture(struct tool *t, const struct rc_grid *g, const struct paper *paper,
              const struct figure *raw, struct canvas *c)
{
    struct drawing d = {t, g, raw, .colours = {.map = NULL}};
    const char *history = g == NULL ? NULL : rc_grid_get(g, "history"), *own = tool_history(t);
    size_t size = strlen(own) + (history == NULL ? 0 : strlen(history)) + 4;
    char *made = tool_room(t, size, 1, "the history"), software[64];
    const struct picture_text text[] = {
        {"Title", paper->title},
        {"Description", made},
        {"Warning", paper->stamp},
        {"Software", software},
        {"Source", g == NULL ? paper->subtitle : rc_grid_get(g, "source")}};
    size_t texts = sizeof text / sizeof *text;

    assert(c != NULL || (g != NULL && raw != NULL));
    if (c == NULL)
        colormap_tabulate(&d.colours, raw->bar.map);
    snprintf(made, size, "%s%s%s", history == NULL ? "" : history, history == NULL ? "" : " | ",
             own);
    snprintf(software, sizeof software, "rc-render %s", rc_version());
    if ((c != NULL ? canvas_write(c, canvas_format(ending_of(t->out_name)), text, texts,
                                  t->output.file, &t->err)
                   : picture_write(t->output.file, g->nx, g->ny, paper->dpi, text, texts, next_row,
                                   &d, &t->err)) != RC_OK)
        tool_die(t, "%s", t->err.text);
    free(made);
}

/* Fontconfig always finds some font; its name shows whether it is the requested one. */
static void
warn_of_family(struct tool *t, const char *wanted, const char *found)
{
    static const char *const any[] = {"sans", "sans-serif", "serif", "monospace"};

    for (size_t k = 0; k < sizeof any / sizeof *any; k++)
        if (strcasecmp(wanted, any[k]) == 0)
            return;
    if (strcasecmp(wanted, found) != 0)
        tool_warn(t,
                  "--font %s: there is no font of that name, %s is used: fc-list shows those "
                  "there are",
                  wanted, found);
}

static void
warn_of_text(struct tool *t, const struct args *a, struct canvas *c)
{
    char text[512];

    if (canvas_warning(c, text, sizeof text) != NULL)
        tool_warn(t, "%s", text);
    if (a->style.paper.family != NULL)
        warn_of_family(t, a->style.paper.family, canvas_set_family(c, a->style.paper.family));
}

/* Writes the figure on its canvas and frees the canvas; grid NULL: a figure of tables. */
static void
finish(struct tool *t, const struct args *a, const struct rc_grid *g, const struct paper *paper,
       struct canvas *c)
{
    warn_of_text(t, a, c);
    write_picture(t, g, paper, NULL, c);
    canvas_free(c);
}

/* ---- profiles ---- */

/* A curve along the single row or column of a map, from edge to edge. */
static void
draw_profile(struct tool *t, const struct args *a, const struct rc_grid *g, const struct figure *f)
{
    const bool row = g->ny == 1;
    const double first = row ? f->at.left : f->at.top, step = row ? g->dx : g->dy;
    const size_t n = g->nx * g->ny;
    double *x = tool_room(t, n, sizeof *x, "a curve");
    struct graph_series series = {.kind = GRAPH_LINE, .x = x, .y = g->v, .n = n};
    char gaps[128];
    struct graph graph = {.paper = f->paper,
                          .x = {row ? f->at.across : f->at.down, f->at.dunit, false, first,
                                row ? f->at.right : f->at.bottom},
                          .y = {f->bar.quantity, f->bar.unit, f->bar.log, f->bar.lo, f->bar.hi},
                          .series = &series,
                          .n = 1,
                          .note = f->nodes.missing > 0 ? gaps : NULL};

    for (size_t k = 0; k < n; k++)
        x[k] = first + ((double)k + 0.5) * step;
    snprintf(gaps, sizeof gaps, "gaps: %s (%zu of %zu nodes)",
             f->nodes.missing_is == NULL ? "not measured" : f->nodes.missing_is, f->nodes.missing,
             n);
    finish(t, a, g, &f->paper, tool_made(t, g, graph_draw(&graph, &t->err)));
    free(x);
}

/* ---- reliefs ---- */

static void
draw_relief(struct tool *t, const struct args *a, const struct rc_grid *g, struct figure *f,
            struct subtitle *subtitle)
{
    struct view view;

    view_read(t, a->view, &view);
    if (look_is_profile(g) || rc_grid_get(g, "section") != NULL || g->nx == 1 || g->ny == 1)
        tool_refuse(t, g, "a relief is of a map, this is a profile or a section: leave out --view");
    view.peaks = a->keep == NULL ? f->nodes.zero_is_none : f->keep_max;
    view_check(t, g, f);
    view_say(f, subtitle);
    f->nodes.missing = 0; /* they are holes */
    finish(t, a, g, &f->paper, tool_made(t, g, relief_draw(f, &view, g, &t->err)));
}

/* ---- maps: one, or the panels of a sheet ---- */

/* Marks the largest magnitude with a cross, if its node is drawn. */
static void
mark_largest(struct tool *t, const struct rc_grid *g, const struct survey *s, struct figure *f,
             struct words *w)
{
    RC_OWNED double *depth = section_depths(t, g);
    size_t at = fabs(s->min) > fabs(s->max) ? s->min_at : s->max_at;

    f->mark.x = f->at.left + ((double)(at % g->nx) + 0.5) * g->dx;
    f->mark.y = depth[at / g->nx];
    if (f->mark.y >= f->at.top && f->mark.y <= f->at.bottom)
        f->mark.largest = words_largest(w, g, g->v[at], f->at.across, f->mark.x, f->mark.y);
}

/* Marks on a single map. */
static void
add_marks(struct tool *t, const struct rc_grid *g, const struct survey *s, struct figure *f,
          struct words *words)
{
    if (rc_grid_get(g, "section") != NULL)
        mark_largest(t, g, s, f, words);
    else if (look_throat(g, f))
        f->mark.largest = "the critical constriction";
}

/* The panels of the figure *f, which becomes that of their common legend. Sections are drawn as maps of their
 * own. */
static void
set_panels(struct tool *t, const struct args *a, const struct frames *frames,
           const struct window *window, const struct survey *all, struct figure *f,
           struct panel *panel, struct words *words)
{
    const struct figure own = *f;

    for (size_t k = 0; k < frames->n; k++) {
        struct rc_grid *g = frames->grid[k];
        const struct beside beside = frames_beside(frames, k);
        struct figure *of = &panel[k].figure;

        *of = own;
        look_extent(&window[k], of);
        panel[k].grid =
            rc_grid_get(g, "section") == NULL ? g : look_section(t, a, g, &panel[k].figure);
        look_contact(of, g, &beside, frames->touch[k]);
        if (frames->one) {
            add_marks(t, g, all, of, words);
        } else {
            sheet_check_alike(t, frames->grid[0], &panel[0].figure, g, of);
            sheet_label(&panel[k], frames, k);
        }
        if (k == 0)
            *f = *of;
        f->edge.hard = fmax(f->edge.hard, of->edge.hard);
        f->edge.contact = f->edge.contact == NULL ? of->edge.contact : f->edge.contact;
        f->paper.stamp = f->paper.stamp == NULL ? look_stamp(g) : f->paper.stamp;
        f->nodes.all += g->nx * g->ny;
    }
    look_aspect(t, frames->grid[0], f);
    if (!subtitle_same(frames->grid, frames->n, "layers")) /* one legend for all */
        f->media = 0;
}

static void
draw_panels(struct tool *t, const struct args *a, struct frames *frames,
            const struct window *window, const struct survey *all, struct figure *f)
{
    static struct panel panel[FRAMES];
    const struct rc_grid *first = frames->grid[0];
    struct panels panels = {f, panel, frames->n, 1};
    struct words words;
    struct canvas *c;
    size_t rows = 1;

    if (!frames->one)
        sheet_size(t, a->sheet == NULL ? "auto" : a->sheet, &panels.columns, &rows);
    if (panels.columns > 0 && frames->n > panels.columns * rows)
        tool_die(
            t, "%zu frames match, but --sheet %s has room for %zu: choose with --case and --depth",
            frames->n, a->sheet, panels.columns * rows);
    set_panels(t, a, frames, window, all, f, panel, &words);
    if (panels.columns == 0)
        panels.columns =
            panels_columns(frames->n, (f->at.right - f->at.left) / (f->at.bottom - f->at.top));
    c = tool_made(t, frames->one ? first : NULL, panels_draw(&panels, &t->err));
    for (size_t k = 0; k < frames->n; k++) {
        if (panel[k].grid != frames->grid[k])
            rc_grid_free((struct rc_grid *)panel[k].grid);
        free(panel[k].figure.medium);
    }
    frames_empty(frames);
    finish(t, a, first, &f->paper, c);
}

/* True if the window is the contact. */
static bool
about_contact(const struct args *a)
{
    return a->window != NULL && strcmp(a->window, "contact") == 0;
}

static void
warn_of_profile(struct tool *t, const struct args *a)
{
    const char *option = a->contour          ? "contour"
                         : a->border         ? "border"
                         : a->hertz          ? "hertz"
                         : a->hillshade      ? "hillshade"
                         : !isnan(a->aspect) ? "aspect"
                                             : NULL;

    if (option != NULL)
        tool_warn(t, "a profile is drawn as a curve, so that --%s has no effect%s", option,
                  strcmp(option, "hertz") == 0 ? ": add --cut" : "");
}

static void
render_maps(struct tool *t, struct args *a, struct frames *frames)
{
    struct rc_grid *first = frames->grid[0];
    const bool profile = frames->one && look_is_profile(first);
    struct window window[FRAMES];
    struct survey all;
    struct subtitle subtitle = {.titled = a->style.paper.title == NULL};
    struct look look;
    struct figure f;
    struct means means = {false, 0, 0};
    struct hertz_contact hertz = {.half = 0};
    char title[CHANNEL_TITLE], section[SECTION_TITLE];

    if (a->hertz && !profile)
        hertz_read(t, first, &a->style.given, &hertz);
    for (size_t k = 0; k < frames->n && !a->raw; k++)
        means_take(t, frames->grid[k], &means);
    for (size_t k = 0; k < frames->n; k++) {
        const struct beside beside = frames_beside(frames, k);

        window_cut(t, a->window == NULL && !frames->one ? "all" : a->window, a->raw,
                   frames->grid[k], &beside, frames->touch[k], &window[k]);
    }
    sheet_survey(t, frames, &all);
    look_figure(t, a, frames->grid, frames->touch, frames->n, &all, &look, &f);
    look_extent(&window[0], &f);
    f.mark.circle = hertz.half > 0 ? hertz.text : NULL;
    f.mark.radius = hertz.half;
    f.mark.across = hertz.across;
    subtitle_write(&subtitle, frames->grid, frames->n, &all, &means, window[0].part,
                   frames_by_size(frames));
    if (a->hillshade && !profile)
        subtitle_add(&subtitle, "shaded, light from the upper left", "");
    f.paper.subtitle = wording_subtitle(&a->style.paper, subtitle.text);
    channel_title(&look.what, window[0].contact ? "about the contact" : "", title);
    if (a->style.paper.title == NULL)
        f.paper.title = subtitle_section(section, frames->grid, frames->n, title);
    if (profile)
        warn_of_profile(t, a);
    if (a->raw)
        write_picture(t, first, &f.paper, &f, NULL);
    else if (a->view != NULL)
        draw_relief(t, a, first, &f, &subtitle);
    else if (profile)
        draw_profile(t, a, first, &f);
    else
        draw_panels(t, a, frames, window, &all, &f);
}

/* ---- curves ---- */

static void
render_curves(struct tool *t, struct args *a)
{
    struct drawn drawn = {.stamp = NULL};
    struct canvas *c = curves_draw(t, a->curve, &a->style, &drawn);
    const struct paper paper = {.title = drawn.title,
                                .stamp = drawn.stamp,
                                .subtitle = *drawn.source == '\0' ? NULL : drawn.source};

    finish(t, a, NULL, &paper, c);
}

static struct canvas *
draw_lines(struct tool *t, struct args *a, const struct frames *f, struct drawn *drawn)
{
    struct range range = {.lo = NAN, .hi = NAN};
    struct survey all;

    if (a->histogram)
        return histogram_draw(t, f->grid, f->touch, f->n, &a->style, drawn);
    if (a->material_ratio)
        return material_ratio_draw(t, f->grid, f->n, &a->style, drawn);
    if (a->range != NULL) {
        range_read(t, a->range, f->grid[0], &range);
        if (range.kind != RANGE_VALUES)
            tool_usage(t, "--range %s: for --cut it must be LO:HI, two values", a->range);
        sheet_survey(t, f, &all);
        range_doubt(t, "range", a->range, f->grid[0]->unit, all.min, all.max, &range);
        a->range = range_text(&range);
    }
    return cut_draw(t, f->grid, f->n, a->cut, range.lo, range.hi, &a->style, drawn);
}

static void
render_lines(struct tool *t, struct args *a, struct frames *f)
{
    struct drawn drawn = {.stamp = NULL};
    struct canvas *c;

    a->style.hertz = a->hertz;
    c = draw_lines(t, a, f, &drawn);
    finish(t, a, f->grid[0], &(struct paper){.title = drawn.title, .stamp = drawn.stamp}, c);
}

/* ---- kinds of pictures ---- */

static void
render_frames(struct tool *t, struct args *a)
{
    static struct frames frames;

    frames.wanted = a->wanted;
    frames.one = !args_several(a);
    frames.border = a->contour || a->border || about_contact(a);
    frames.demands = a->histogram || about_contact(a);
    frames_read(&frames, t);
    (args_lines(a) ? render_lines : render_maps)(t, a, &frames);
    frames_free(&frames);
}

static void
check_text(struct tool *t, const char *option, const char *text)
{
    if (text != NULL && !rc_utf8_valid(text))
        tool_usage(t, "--%s: the text is not UTF-8", option);
}

int
main(int argc, char **argv)
{
    struct args args = {.dpi = NAN,
                        .aspect = NAN,
                        .exaggeration = NAN,
                        .style.given = {.estar = NAN, .radius = NAN, .rms_slope = NAN}};
    struct tool t;

    tool_start(&t, &info, argc, argv, &args);
    args_check(&t, &args);
    check_text(&t, "title", args.style.paper.title);
    check_text(&t, "subtitle", args.style.paper.subtitle);
    check_text(&t, "legend", args.style.legend);
    check_text(&t, "x-label", args.style.x_label);
    check_text(&t, "y-label", args.style.y_label);
    if (args.curve != NULL)
        render_curves(&t, &args);
    else
        render_frames(&t, &args);
    free(args.wanted.depth.v);
    free(args.wanted.number.v);
    return tool_finish(&t);
}
