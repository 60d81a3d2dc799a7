/* rc-render: one map of a grid stream as a picture: PNG, SVG or PDF. */
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
    const char *width, *font, *window, *depths, *keep;
    double dpi;
    bool contour, figure, raw, log, clip, hertz;
};

/* clang-format off */
static const struct opt opts[] = {
    {.name = "channel", .type = OPT_TEXT, .at = offsetof(struct args, wish.channel),
     .result = true, .arg = "NAME",
     .help = "what to draw (default: mises, pressure, height, else the first)"},
    {.name = "depth", .type = OPT_NUMBER, .unit = UNIT_M, .at = offsetof(struct args, wish.depth),
     .min = 0, .max = INFINITY, .result = true, .arg = "LENGTH",
     .help = "of a stress (default: where its size is largest)"},
    {.name = "section", .type = OPT_CHOICE, .at = offsetof(struct args, wish.section),
     .result = true, .arg = "x|y", .help = "a section across this axis instead of a map"},
    {.name = "case", .type = OPT_COUNT, .at = offsetof(struct args, wish.number), .min = 1,
     .max = 9e15, .result = true, .arg = "N",
     .help = "of several loads or files (default: the first)"},
    {.name = "colormap", .type = OPT_CHOICE, .at = offsetof(struct args, colormap), .result = true,
     .words = colormap_name, .help = "colours for the values (default: what suits the channel)"},
    {.name = "range", .type = OPT_TEXT, .at = offsetof(struct args, range), .result = true,
     .arg = "LO:HI",
     .help = "ends of the colours: values as 0:2GPa, percentiles as 1%:99%, or symmetric"},
    {.name = "log", .type = OPT_FLAG, .at = offsetof(struct args, log), .result = true,
     .help = "colours by the logarithm of the value"},
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
    {.name = "font", .type = OPT_TEXT, .at = offsetof(struct args, font), .result = true,
     .arg = "FAMILY", .help = "of all text (default: the sans serif of the system)"},
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
    .summary = "Draw one map of a grid stream as a PNG, SVG or PDF",
    .operands = "[FILE...]",
    .examples =
        "  rc-synth sphere --nx 65 --ny 65 --dx 1um --radius 1mm | rc-render -o sphere.png\n"
        "  rc-render --channel pressure --range 0:6GPa --contour -o contact.png result.rcg\n",
    .opts = opts,
    .reads = READS_STREAM,
    .writes = WRITES_BYTES,
    .settle = settle,
};

/* Metres: text and axes leave no room for a map on less. */
#define NARROW_PAPER 0.06

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

/* The picture, without a canvas a pixel for each node, says how it was made. */
static void
write_picture(struct tool *t, const struct rc_grid *g, const struct figure *f, struct canvas *c)
{
    struct drawing d = {t, g, f};
    const char *history = rc_grid_get(g, "history"), *own = tool_history(t);
    size_t size = strlen(own) + (history == NULL ? 0 : strlen(history)) + 4;
    char *made = malloc(size), software[64];
    const struct picture_text text[] = {{"Title", f->title},
                                        {"Description", made},
                                        {"Warning", f->stamp},
                                        {"Software", software},
                                        {"Source", rc_grid_get(g, "source")}};
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

/* A section on even rows, between the depths that are asked for. */
static struct rc_grid *
lay_section(struct tool *t, const struct args *a, const struct rc_grid *g, const struct survey *s,
            struct figure *f, struct words *w)
{
    double *depth = section_depths(t, g);
    size_t at = fabs(s->min) > fabs(s->max) ? s->min_at : s->max_at;
    struct rc_grid *even;

    section_range(t, a->depths, g, depth, &f->top, &f->bottom);
    f->across = strcmp(rc_grid_get(g, "section"), "x") == 0 ? "y" : "x";
    f->down = "depth";
    f->section = true;
    f->largest_x = f->left + ((double)(at % g->nx) + 0.5) * g->dx;
    f->largest_y = depth[at / g->nx];
    if (f->largest_y >= f->top && f->largest_y <= f->bottom)
        f->largest = words_largest(w, g, g->v[at], f->across, f->largest_x, f->largest_y);
    even = section_even(t, g, depth, f->top, f->bottom);
    free(depth);
    return even;
}

static void
draw_figure(struct tool *t, const struct args *a, const struct rc_grid *g, const struct survey *s,
            struct figure *f)
{
    struct rc_grid *even = NULL;
    struct words words;
    struct canvas *c;
    char text[512];
    struct rc_err err;

    f->across = "x";
    f->down = "y";
    if (rc_grid_get(g, "section") != NULL)
        even = lay_section(t, a, g, s, f, &words);
    if (a->hertz)
        f->circle = words_hertz(t, &words, g, &f->radius);
    if ((c = figure_draw(f, even == NULL ? g : even, &err)) == NULL)
        tool_die_at(t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    if (canvas_warning(c, text, sizeof text) != NULL)
        tool_warn(t, "%s", text);
    if (f->family != NULL)
        warn_of_family(t, f->family, canvas_set_family(c, f->family));
    write_picture(t, g, f, c);
    canvas_free(c);
    rc_grid_free(even);
}

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

/* Pixels when plain, or a length on paper. */
static void
read_width(struct tool *t, const struct args *a, struct figure *f)
{
    const double dpi = 300, inch = 0.0254;
    bool plain = a->width != NULL && a->width[strspn(a->width, "0123456789")] == '\0';
    double width = 0;
    struct rc_err err;

    f->dpi = isnan(a->dpi) ? 0 : a->dpi;
    if (a->width == NULL)
        return;
    if (unit_number(a->width, plain ? UNIT_NONE : UNIT_M, &width, &err) != RC_OK)
        tool_die(t, EXIT_USAGE, "--width %s: %s", a->width, err.text);
    if (!plain) {
        f->dpi = f->dpi > 0 ? f->dpi : dpi;
        width *= f->dpi / inch;
    }
    if (f->dpi > 0 && !(width >= NARROW_PAPER / inch * f->dpi))
        tool_die(t, EXIT_USAGE, "--width %s: on paper it must be at least 60mm", a->width);
    if (!(width >= FIGURE_NARROW && width <= FIGURE_WIDE))
        tool_die(t, EXIT_USAGE, "--width %s: it must be %d to %d pixels%s", a->width, FIGURE_NARROW,
                 FIGURE_WIDE, plain ? "" : ", which is a matter of --dpi");
    f->width = (size_t)round(width);
}

static void
choose_range(struct tool *t, struct args *a, const struct rc_grid *g, const struct survey *s,
             const struct channel *what, struct figure *f, struct range *r)
{
    *r = (struct range){.kind = a->clip ? RANGE_CLIP : RANGE_AUTO};
    if (a->range != NULL)
        range_read(t, a->range, g, r);
    range_choose(g, s, f->map, what, is_profile(g) && !a->raw, r);
    if (r->kind == RANGE_VALUES)
        a->range = range_text(r);
    if (a->log)
        range_take_logarithm(t, g, r);
    f->lo = r->lo;
    f->hi = r->hi;
    f->min = range_least(g, s, r);
    f->log = a->log;
    f->note = r->note[0] == '\0' ? NULL : r->note;
}

static void
render(struct tool *t, struct args *a, struct rc_grid *g, struct rc_grid *beside, bool largest)
{
    const struct rc_grid *pressure = strcmp(g->channel, "pressure") == 0 ? g : beside;
    char title[256];
    struct window w;
    struct survey s;
    struct subtitle subtitle = {.n = 0};
    struct channel what;
    struct range range;
    struct figure f;

    window_cut(t, a->window, a->raw, g, beside, &w);
    survey_map(g, &s);
    if (isnan(s.min))
        tool_die_at(t, g, EXIT_IMPOSSIBLE,
                    "none of its %zu values is a finite number: there is "
                    "nothing to draw",
                    g->nx * g->ny);
    what = channel_of(g, &s);
    snprintf(title, sizeof title, "%.80s about the contact", what.title);
    subtitle_write(&subtitle, g, &s, w.part, largest);
    f = (struct figure){
        .title = a->title != NULL ? a->title
                 : w.contact      ? title
                                  : what.title,
        .subtitle = subtitle.text,
        .stamp = stamp_of(g),
        .quantity = what.title,
        .unit = g->unit,
        .map = colormap_find(a->colormap == NULL ? what.colormap : a->colormap),
        .min = s.min,
        .max = s.max,
        .missing = s.missing,
        .zero_is_none = strcmp(g->channel, "pressure") == 0,
        .zeros = s.zeros,
        .contour = a->contour,
        .pressure = pressure,
        .hard = hardness_of(pressure),
        .keep_max = a->keep != NULL && strcmp(a->keep, "max") == 0,
        .left = w.left,
        .right = w.right,
        .top = w.top,
        .bottom = w.bottom,
        .vector = canvas_format(ending_of(t->out_name)) != CANVAS_PNG,
        .family = a->font,
    };
    read_width(t, a, &f);
    choose_range(t, a, g, &s, &what, &f, &range);
    if (a->depths != NULL && rc_grid_get(g, "section") == NULL)
        tool_warn(t, "--depth-range is for sections: this %s has no rows of depths", g->channel);
    if ((a->contour || a->hertz) && is_profile(g))
        tool_warn(t, "a profile is drawn as a curve: --%s does nothing",
                  a->contour ? "contour" : "hertz");
    if (a->raw)
        write_picture(t, g, &f, NULL);
    else
        draw_figure(t, a, g, &s, &f);
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
    if (a->raw && a->font != NULL)
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

int
main(int argc, char **argv)
{
    struct args args = {.wish = {.depth = NAN}, .dpi = NAN};
    struct choice choice = {.wish = &args.wish};
    struct rc_grid *g;
    struct tool t;

    tool_start(&t, &info, argc, argv, &args);
    check_options(&t, &args);
    args.wish.contact =
        args.contour || (args.window != NULL && strcmp(args.window, "contact") == 0);
    while ((g = tool_read(&t)) != NULL)
        choice_offer(&choice, &t, g);
    choice_settle(&choice, &t);
    render(&t, &args, choice.grid, choice.pressure, choice.by_size);
    choice_free(&choice);
    return tool_finish(&t);
}
