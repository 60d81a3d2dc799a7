/* rc-render: maps of a grid stream, or curves of a report, as a picture: PNG, SVG or PDF. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "formats/core/core.h"
#include "libcontact/contact.h"
#include "tools/cli/cli.h"
#include "tools/plot/plot.h"
#include "tools/render/render.h"

struct args {
    struct wish wish; /* which frame */
    const char *colormap, *range, *title;
    const char *width, *window, *depths, *keep;
    double dpi; /* as given */
    bool contour, figure, raw, clip, hertz;
    struct numbers depth, number; /* as asked for: of several frames, or the one of wish */
    const char *curve;            /* X:Y[,Y...]: tables are drawn instead of maps */
    const char *cut;
    const char *view;  /* AZ,EL: a relief */
    const char *sheet; /* COLSxROWS or "auto" */
    bool histogram, material_ratio, hillshade;
    struct curve_style
        style; /* its width, dpi and family are those of every picture, its log too */
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
     .arg = "LO:HI",
     .help = "ends of the colours: values as 0:2GPa, percentiles as 1%:99%, or symmetric"},
    {.name = "log", .type = OPT_CHOICE, .at = offsetof(struct args, style.log), .result = true,
     .arg = "x|y|xy", .optional = true,
     .help = "colours, or the axes of curves, by the logarithm (alone: both axes)"},
    {.name = "clip", .type = OPT_FLAG, .at = offsetof(struct args, clip), .result = true,
     .help = "leave half a per cent of the nodes beyond each end of the colours"},
    {.name = "contour", .type = OPT_FLAG, .at = offsetof(struct args, contour), .result = true,
     .help = "draw lines at the marks of the colour bar, and the edge of contact"},
    {.name = "hertz", .type = OPT_FLAG, .at = offsetof(struct args, hertz), .result = true,
     .help = "draw the circle of Hertz: of a sphere added to the height, without roughness"},
    {.name = "window", .type = OPT_TEXT, .at = offsetof(struct args, window), .result = true,
     .arg = "X0:X1,Y0:Y1", .help = "the part of the map to draw; or contact: what touches; or all"},
    {.name = "depth-range", .type = OPT_TEXT, .at = offsetof(struct args, depths), .result = true,
     .arg = "Z0:Z1", .help = "the depths of a section to draw"},
    {.name = "keep", .type = OPT_CHOICE, .at = offsetof(struct args, keep), .result = true,
     .arg = "mean|max", .help = "of the nodes that share a pixel: their mean (default) or largest"},
    {.name = "figure", .type = OPT_FLAG, .at = offsetof(struct args, figure), .result = true,
     .help = "with axes, colour bar and title: the default"},
    {.name = "raw", .type = OPT_FLAG, .at = offsetof(struct args, raw), .result = true,
     .help = "one pixel for each node and nothing else"},
    {.name = "title", .type = OPT_TEXT, .at = offsetof(struct args, title), .result = true,
     .arg = "TEXT", .help = "over the figure (default: what the channel is)"},
    {.name = "width", .type = OPT_TEXT, .at = offsetof(struct args, width), .result = true,
     .arg = "WIDTH",
     .help = "of the whole figure: pixels, or with a unit its width on paper, as in 85mm"},
    {.name = "dpi", .type = OPT_NUMBER, .at = offsetof(struct args, dpi), .min = 50, .max = 2400,
     .result = true, .arg = "PIXELS",
     .help = "pixels an inch; text is then 7 points high (default for a --width in mm: 300)"},
    {.name = "font", .type = OPT_TEXT, .at = offsetof(struct args, style.family), .result = true,
     .arg = "FAMILY", .help = "of all text (default: the sans serif of the system)"},
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

static bool
is_profile(const struct rc_grid *g)
{
    return (g->nx == 1) != (g->ny == 1) && rc_grid_get(g, "section") == NULL;
}

/* ---- pictures ---- */

static void
raw_row(const struct rc_grid *g, const struct figure *f, size_t j, unsigned char *rgb)
{
    const double *v = g->v + j * g->nx;

    for (size_t i = 0; i < g->nx; i++) {
        struct rgb c = isnan(v[i])                    ? f->map->missing
                       : f->zero_is_none && v[i] == 0 ? f->map->none
                                                      : figure_colour(f, v[i]);

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
};

static enum rc_status
next_row(void *ctx, size_t y, unsigned char *rgb, struct rc_err *err)
{
    const struct drawing *d = ctx;

    (void)err;
    tool_progress(d->tool, "row %zu of %zu", y, d->grid->ny);
    raw_row(d->grid, d->figure, y, rgb);
    return RC_OK;
}

/* The picture, without a canvas a pixel for each node, says how it was made. Without a grid the words
 * are in the figure's. */
static void
write_picture(struct tool *t, const struct rc_grid *g, const struct figure *f, struct canvas *c)
{
    struct drawing d = {t, g, f};
    const char *history = g == NULL ? NULL : rc_grid_get(g, "history"), *own = tool_history(t);
    size_t size = strlen(own) + (history == NULL ? 0 : strlen(history)) + 4;
    char *made = malloc(size), software[64];
    const struct picture_text text[] = {
        {"Title", f->title},
        {"Description", made},
        {"Warning", f->stamp},
        {"Software", software},
        {"Source", g == NULL ? f->subtitle : rc_grid_get(g, "source")}};
    size_t texts = sizeof text / sizeof *text;
    struct rc_err err;

    if (made == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "out of memory");
    snprintf(made, size, "%s%s%s", history == NULL ? "" : history, history == NULL ? "" : " | ",
             own);
    snprintf(software, sizeof software, "rc-render %s", rc_version());
    if ((c != NULL
             ? canvas_write(c, canvas_format(ending_of(t->out_name)), text, texts, t->out, &err)
             : picture_write(t->out, g->nx, g->ny, f->dpi, text, texts, next_row, &d, &err)) !=
        RC_OK)
        tool_die(t, EXIT_IMPOSSIBLE, "%s", err.text);
    free(made);
}

/* Fontconfig always finds something. */
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
    if (a->style.family != NULL)
        warn_of_family(t, a->style.family, canvas_set_family(c, a->style.family));
}

static void
set_extent(const struct window *w, struct figure *f)
{
    f->across = "x";
    f->down = "y";
    f->left = w->left;
    f->right = w->right;
    f->top = w->top;
    f->bottom = w->bottom;
}

/* A section on even rows, between the depths that are asked for. */
static struct rc_grid *
lay_section(struct tool *t, const struct args *a, const struct rc_grid *g, struct figure *f)
{
    double *depth = section_depths(t, g);
    struct rc_grid *even;

    section_range(t, a->depths, g, depth, &f->top, &f->bottom);
    f->across = strcmp(rc_grid_get(g, "section"), "x") == 0 ? "y" : "x";
    f->down = "depth";
    f->section = true;
    even = section_even(t, g, depth, f->top, f->bottom);
    free(depth);
    return even;
}

/* A cross where the size is largest, where that is drawn. */
static void
mark_largest(struct tool *t, const struct rc_grid *g, const struct survey *s, struct figure *f,
             struct words *w)
{
    double *depth = section_depths(t, g);
    size_t at = fabs(s->min) > fabs(s->max) ? s->min_at : s->max_at;

    f->largest_x = f->left + ((double)(at % g->nx) + 0.5) * g->dx;
    f->largest_y = depth[at / g->nx];
    if (f->largest_y >= f->top && f->largest_y <= f->bottom)
        f->largest = words_largest(w, g, g->v[at], f->across, f->largest_x, f->largest_y);
    free(depth);
}

static void
draw_figure(struct tool *t, const struct args *a, const struct rc_grid *g, const struct survey *s,
            struct figure *f)
{
    struct rc_grid *even = NULL;
    struct words words;
    struct canvas *c;
    struct rc_err err;

    if (rc_grid_get(g, "section") != NULL) {
        even = lay_section(t, a, g, f);
        mark_largest(t, g, s, f, &words);
    }
    if (a->hertz)
        f->circle = words_hertz(t, &words, g, &f->radius);
    if ((c = figure_draw(f, even == NULL ? g : even, &err)) == NULL)
        tool_die_at(t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    warn_of_text(t, a, c);
    write_picture(t, g, f, c);
    canvas_free(c);
    rc_grid_free(even);
}

/* ---- reliefs ---- */

static void
draw_relief(struct tool *t, const struct args *a, const struct rc_grid *g, struct figure *f,
            struct subtitle *subtitle)
{
    struct view view;
    struct canvas *c;
    struct rc_err err;

    view_read(t, a->view, &view);
    if (is_profile(g) || rc_grid_get(g, "section") != NULL || g->nx == 1 || g->ny == 1)
        tool_die_at(t, g, EXIT_IMPOSSIBLE,
                    "a relief is of a map, this is a profile or a section: leave out --view");
    view.peaks = a->keep == NULL ? f->zero_is_none : f->keep_max;
    view_say(f, subtitle);
    f->missing = 0; /* they are holes */
    if ((c = relief_draw(f, &view, g, &err)) == NULL)
        tool_die_at(t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    warn_of_text(t, a, c);
    write_picture(t, g, f, c);
    canvas_free(c);
}

/* ---- what a figure is like ---- */

/* What nobody may overlook; NULL: nothing. */
static const char *
stamp_of(const struct rc_grid *g)
{
    const char *converged = rc_grid_get(g, "converged");

    return converged != NULL && strcmp(converged, "no") == 0 ? "not converged" : NULL;
}

/* From which pressure on a node yields; 0: none does. */
static double
hardness_of(const struct rc_grid *p)
{
    const double rounding = 1e-9;
    double hardness, largest = 0;

    if (p == NULL || !rc_grid_number(p, "hardness", &hardness) || !(hardness > 0))
        return 0;
    for (size_t k = 0; k < p->nx * p->ny; k++)
        largest = fmax(largest, p->v[k]);
    hardness *= 1 - rounding;
    return largest >= hardness ? hardness : 0;
}

/* What a figure says in words of its own. */
struct look {
    struct channel what;
    struct range range;
};

static void
choose_range(struct tool *t, struct args *a, struct rc_grid *const *grid, size_t n,
             const struct survey *s, struct look *look, struct figure *f)
{
    struct range *r = &look->range;

    *r = (struct range){.kind = a->clip ? RANGE_CLIP : RANGE_AUTO};
    if (a->range != NULL)
        range_read(t, a->range, grid[0], r);
    range_choose(grid, n, s, f->map, &look->what, is_profile(grid[0]) && !a->raw, r);
    if (r->kind == RANGE_VALUES)
        a->range = range_text(r);
    if (a->style.log != NULL)
        range_take_logarithm(t, grid, n, r);
    f->lo = r->lo;
    f->hi = r->hi;
    f->min = range_least(grid, n, s, r);
    f->log = a->style.log != NULL;
    f->note = r->note[0] == '\0' ? NULL : r->note;
}

/* What a figure of n frames is like, but for its subtitle, what touches, and where they lie. */
static void
set_figure(struct tool *t, struct args *a, struct rc_grid *const *grid, size_t n,
           const struct survey *s, struct look *look, struct figure *f)
{
    const struct rc_grid *g = grid[0];

    look->what = channel_of(g, s);
    *f = (struct figure){
        .title = a->title == NULL ? look->what.title : a->title,
        .stamp = stamp_of(g),
        .quantity = look->what.title,
        .unit = g->unit,
        .map = colormap_find(a->colormap == NULL ? look->what.colormap : a->colormap),
        .min = s->min,
        .max = s->max,
        .missing = s->missing,
        .zero_is_none = strcmp(g->channel, "pressure") == 0,
        .zeros = s->zeros,
        .contour = a->contour,
        .hillshade = a->hillshade,
        .keep_max = a->keep != NULL && strcmp(a->keep, "max") == 0,
        .width = a->style.width,
        .dpi = a->style.dpi,
        .family = a->style.family,
        .vector = canvas_format(ending_of(t->out_name)) != CANVAS_PNG,
    };
    choose_range(t, a, grid, n, s, look, f);
    if (a->depths != NULL && rc_grid_get(g, "section") == NULL)
        tool_warn(t, "--depth-range is for sections: this %s has no rows of depths", g->channel);
}

static void
set_contact(struct figure *f, const struct rc_grid *pressure)
{
    f->pressure = pressure;
    f->hard = hardness_of(pressure);
}

static const char shaded[] = "shaded, light from the upper left";

static void
render(struct tool *t, struct args *a, struct rc_grid *g, struct rc_grid *beside, bool largest)
{
    char title[256];
    struct window w;
    struct survey s;
    struct subtitle subtitle = {.n = 0};
    struct look look;
    struct figure f;

    window_cut(t, a->window, a->raw, g, beside, &w);
    survey_map(g, &s);
    if (isnan(s.min))
        tool_die_at(t, g, EXIT_IMPOSSIBLE,
                    "none of its %zu values is a finite number: there is "
                    "nothing to draw",
                    g->nx * g->ny);
    subtitle_write(&subtitle, g, &s, w.part, largest);
    set_figure(t, a, &g, 1, &s, &look, &f);
    set_extent(&w, &f);
    set_contact(&f, f.zero_is_none ? g : beside);
    snprintf(title, sizeof title, "%.80s about the contact", look.what.title);
    if (a->title == NULL && w.contact)
        f.title = title;
    f.subtitle = subtitle.text;
    if (a->hillshade && !is_profile(g))
        subtitle_add(&subtitle, shaded, "");
    if ((a->contour || a->hertz || a->hillshade) && is_profile(g))
        tool_warn(t, "a profile is drawn as a curve: --%s does nothing",
                  a->contour ? "contour"
                  : a->hertz ? "hertz"
                             : "hillshade");
    if (a->raw)
        write_picture(t, g, &f, NULL);
    else if (a->view != NULL)
        draw_relief(t, a, g, &f, &subtitle);
    else
        draw_figure(t, a, g, &s, &f);
}

/* ---- sheets ---- */

/* The panels, and what their legend says of all; gives the maps that are drawn for sections, NULL
 * for others, which the caller frees. */
static void
set_panels(struct tool *t, const struct args *a, const struct frames *frames,
           const struct window *window, struct figure *f, struct panel *panel,
           struct rc_grid **even)
{
    double hard = 0;

    for (size_t k = 0; k < frames->n; k++) {
        struct rc_grid *g = frames->grid[k];
        struct figure *of = &panel[k].figure;

        *of = *f;
        set_extent(&window[k], of);
        even[k] = rc_grid_get(g, "section") == NULL ? NULL : lay_section(t, a, g, of);
        panel[k].grid = even[k] == NULL ? g : even[k];
        if (of->zero_is_none)
            set_contact(of, g);
        hard = fmax(hard, of->hard);
        sheet_check_alike(t, frames->grid[0], &panel[0].figure, g, of);
        sheet_label(&panel[k], frames, k);
    }
    for (size_t k = 0; k < frames->n; k++) {
        f->stamp = f->stamp == NULL ? stamp_of(frames->grid[k]) : f->stamp;
        f->nodes += frames->grid[k]->nx * frames->grid[k]->ny;
    }
    set_extent(&window[0], f);
    f->top = panel[0].figure.top;
    f->bottom = panel[0].figure.bottom;
    f->across = panel[0].figure.across;
    f->down = panel[0].figure.down;
    f->section = panel[0].figure.section;
    f->pressure = panel[0].figure.pressure;
    f->hard = hard;
}

static void
say_of_sheet(struct subtitle *subtitle, const struct args *a, const struct frames *frames,
             const struct survey *all, double part)
{
    subtitle_common(subtitle, frames->grid, frames->n);
    subtitle_part(subtitle, part);
    subtitle_range(subtitle, all, frames->grid[0]->unit);
    if (a->hillshade)
        subtitle_add(subtitle, shaded, "");
}

static void
render_sheet(struct tool *t, struct args *a, const struct frames *frames)
{
    static struct panel panel[FRAMES];
    struct window window[FRAMES];
    struct rc_grid *even[FRAMES];
    struct subtitle subtitle = {.n = 0};
    struct survey all;
    struct look look;
    struct figure f;
    size_t columns, rows;
    struct canvas *c;
    struct rc_err err;

    sheet_size(t, a->sheet == NULL ? "auto" : a->sheet, &columns, &rows);
    if (columns > 0 && frames->n > columns * rows)
        tool_die(t, EXIT_IMPOSSIBLE,
                 "%zu frames match, --sheet %s holds %zu: choose with --case and --depth",
                 frames->n, a->sheet, columns * rows);
    for (size_t k = 0; k < frames->n; k++)
        window_cut(t, a->window == NULL ? "all" : a->window, false, frames->grid[k], NULL,
                   &window[k]);
    sheet_survey(t, frames, &all);
    set_figure(t, a, frames->grid, frames->n, &all, &look, &f);
    say_of_sheet(&subtitle, a, frames, &all, window[0].part);
    f.subtitle = subtitle.text;
    set_panels(t, a, frames, window, &f, panel, even);
    if (columns == 0)
        columns = panels_columns(frames->n, (f.right - f.left) / (f.bottom - f.top));
    c = panels_draw(&(struct panels){&f, panel, frames->n, columns}, &err);
    if (c == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "%s", err.text);
    warn_of_text(t, a, c);
    write_picture(t, frames->grid[0], &f, c);
    canvas_free(c);
    for (size_t k = 0; k < frames->n; k++)
        rc_grid_free(even[k]);
}

/* ---- curves ---- */

static void
render_curves(struct tool *t, struct args *a)
{
    struct drawn drawn = {.stamp = NULL};
    struct figure words;
    struct canvas *c;

    a->style.title = a->title;
    c = curves_draw(t, a->curve, &a->style, &drawn);
    words = (struct figure){.title = drawn.title,
                            .stamp = drawn.stamp,
                            .subtitle = *drawn.source == '\0' ? NULL : drawn.source};
    warn_of_text(t, a, c);
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
    struct range range = {.lo = NAN, .hi = NAN};

    if (a->cut == NULL)
        return (a->histogram ? histogram_draw : material_ratio_draw)(t, f->grid, f->n, &a->style,
                                                                     drawn);
    if (a->range != NULL) {
        range_read(t, a->range, f->grid[0], &range);
        if (range.kind != RANGE_VALUES)
            tool_die(t, EXIT_USAGE, "--range %s: for --cut it must be LO:HI, two values", a->range);
        a->range = range_text(&range);
    }
    return cut_draw(t, f->grid, f->n, a->cut, range.lo, range.hi, &a->style, drawn);
}

static void
render_lines(struct tool *t, struct args *a, const struct frames *f)
{
    struct drawn drawn = {.stamp = NULL};
    struct canvas *c;

    a->style.title = a->title;
    c = draw_lines(t, a, f, &drawn);
    warn_of_text(t, a, c);
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
    static const char *const of_maps[] = {"channel", "depth", "section", "case", "range", NULL};
    static const char *const of_colours[] = {"colormap", "contour", "clip", "keep", NULL};
    static const char *const of_places[] = {"window", "depth-range", "hertz", NULL};
    static const char *const of_laws[] = {"law", "estar", "radius", "rms-slope", NULL};
    int kinds = (a->curve != NULL) + (a->cut != NULL) + a->histogram + a->material_ratio +
                (a->raw || a->figure);

    if (kinds > 1 && !(a->raw && a->figure))
        tool_die(t, EXIT_USAGE,
                 "--raw, --figure, --curve, --cut, --histogram and --material-ratio are kinds of "
                 "picture: give one");
    if (a->curve != NULL)
        leave_out(t, "--curve draws tables, not maps", of_maps);
    if (a->curve != NULL || draws_lines(a)) {
        leave_out(t, "a curve has no colours", of_colours);
        leave_out(t, "a curve is no part of a map", of_places);
    }
    if (a->range != NULL && (a->histogram || a->material_ratio))
        tool_die(t, EXIT_USAGE, "--range is for maps and for --cut: leave it out");
    if (a->curve == NULL && !draws_lines(a) && a->style.log != NULL && *a->style.log != '\0')
        tool_die(t, EXIT_USAGE,
                 "--log %s names an axis of a curve: of a map --log stands alone, or add --curve "
                 "X:Y",
                 a->style.log);
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
    if (a->view != NULL && a->style.log != NULL)
        tool_die(t, EXIT_USAGE, "--view has an even axis upwards: leave out --log");
    if (a->hertz && (a->view != NULL || shows_several(a)))
        tool_die(t, EXIT_USAGE, "--hertz is for one flat map: leave it out");
    if (shows_several(a) && a->window != NULL && strcmp(a->window, "contact") == 0)
        tool_die(t, EXIT_USAGE,
                 "--window contact is another one in each map: of several give it as X0:X1,Y0:Y1");
    if (a->sheet != NULL && (a->raw || a->curve != NULL || draws_lines(a)))
        tool_die(t, EXIT_USAGE, "--sheet is for maps: leave it out");
    if (a->depth.n == 1)
        a->wish.depth = a->depth.v[0];
    if (a->number.n == 1)
        a->wish.number = (size_t)a->number.v[0];
}

/* Pixels when plain, or a length on paper. */
static void
read_width(struct tool *t, struct args *a)
{
    const double dpi = 300, inch = 0.0254;
    const double narrow = 0.06; /* metres: text and axes leave no room for a map on less */
    bool plain = a->width != NULL && a->width[strspn(a->width, "0123456789")] == '\0';
    double width = 0;
    struct rc_err err;

    a->style.dpi = isnan(a->dpi) ? 0 : a->dpi;
    if (a->width == NULL)
        return;
    if (unit_number(a->width, plain ? UNIT_NONE : UNIT_M, &width, &err) != RC_OK)
        tool_die(t, EXIT_USAGE, "--width %s: %s", a->width, err.text);
    if (!plain) {
        a->style.dpi = a->style.dpi > 0 ? a->style.dpi : dpi;
        width *= a->style.dpi / inch;
    }
    if (a->style.dpi > 0 && !(width >= narrow / inch * a->style.dpi))
        tool_die(t, EXIT_USAGE, "--width %s: on paper it must be at least 60mm", a->width);
    if (!(width >= FIGURE_NARROW && width <= FIGURE_WIDE))
        tool_die(t, EXIT_USAGE, "--width %s: it must be %d to %d pixels%s", a->width, FIGURE_NARROW,
                 FIGURE_WIDE, plain ? "" : ", which is a matter of --dpi");
    a->style.width = (size_t)round(width);
}

static void
check_options(struct tool *t, const struct args *a)
{
    if (a->raw && a->figure)
        tool_die(t, EXIT_USAGE, "--raw and --figure are two kinds of picture: give one");
    if (a->raw && a->contour)
        tool_die(t, EXIT_USAGE, "--raw draws nothing but nodes: leave out --contour");
    if (a->raw && a->width != NULL)
        tool_die(t, EXIT_USAGE, "--raw is as wide as the map has columns: leave out --width");
    if (a->raw && a->style.family != NULL)
        tool_die(t, EXIT_USAGE, "--raw holds no text: leave out --font");
    if (a->raw && canvas_format(ending_of(t->out_name)) != CANVAS_PNG)
        tool_die(t, EXIT_USAGE,
                 "--raw has a pixel for each node, which only a PNG has: -o must end in .png");
    if (a->raw && a->hertz)
        tool_die(t, EXIT_USAGE, "--raw draws nothing but nodes: leave out --hertz");
    if (a->clip && a->range != NULL)
        tool_die(t, EXIT_USAGE, "--clip chooses the range: leave out --range");
    if (a->title != NULL && !rc_utf8_valid(a->title))
        tool_die(t, EXIT_USAGE, "--title: the text is not UTF-8");
}

/* One frame: the best of all. */
static void
read_one(struct tool *t, struct args *a)
{
    struct choice choice = {.wish = &a->wish};
    struct rc_grid *g;

    a->wish.contact = a->contour || (a->window != NULL && strcmp(a->window, "contact") == 0);
    while ((g = tool_read(t)) != NULL)
        choice_offer(&choice, t, g);
    choice_settle(&choice, t);
    if (draws_lines(a))
        render_lines(t, a, &(struct frames){.grid = {choice.grid}, .n = 1});
    else
        render(t, a, choice.grid, choice.pressure, choice.by_size);
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
                        .dpi = NAN,
                        .style.given = {.estar = NAN, .radius = NAN, .rms_slope = NAN}};
    struct tool t;

    tool_start(&t, &info, argc, argv, &args);
    check_options(&t, &args);
    read_width(&t, &args);
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
