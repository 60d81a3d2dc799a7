/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "figure.h"

#include <math.h>
#include <stdlib.h>

#include "page.h"
#include "raster.h"
#include "ticks.h"

static const struct rgb light = {0xff, 0xff, 0xff}, hard_ink = {0x00, 0x9e, 0x73},
                        circle_ink = {0x1f, 0x8f, 0xd1}, edge_on_dark = {0xff, 0x8c, 0x1a};

enum {
    STEPS = 512,       /* pixels of the colours in the bar */
    IMAGE_MOST = 2400, /* largest number of pixels a side of a map in a PDF or SVG: 600 per inch
                          over 100 mm */
    BAND = 64          /* rows of pixels that are in memory at a time as means */
};

static struct rgb
mix(struct rgb a, double x, struct rgb b, double y)
{
    return (struct rgb){(unsigned char)(x * a.r + y * b.r + 0.5),
                        (unsigned char)(x * a.g + y * b.g + 0.5),
                        (unsigned char)(x * a.b + y * b.b + 0.5)};
}

double
figure_place(const struct figure *f, double value)
{
    if (!f->bar.log)
        return colormap_place(f->bar.lo, f->bar.hi, value);
    return value > f->bar.lo ? log(value / f->bar.lo) / log(f->bar.hi / f->bar.lo) : 0;
}

static struct rgb
colour_of(const struct figure *f, double value)
{
    double t = figure_place(f, value);

    if (f->nodes.is == NULL)
        return colormap_at(f->bar.map, t);
    return mix(colormap_at(f->bar.map, 0), 1 - t, colormap_at(f->bar.map, 1),
               t); /* size in pixels of both */
}

/* Missing nodes are chequered, so that they cannot be confused with a colour of a value. */
static struct rgb
missing_at(const struct page *p, size_t x, size_t y)
{
    size_t side = (size_t)fmax(4, round(7 * p->u));

    return (x / side + y / side) % 2 == 0 ? p->f->bar.map->missing
                                          : mix(p->f->bar.map->missing, 0.5, light, 0.5);
}

/* Light and shadow for each node, or for each cell of the image if there are more nodes. */
struct shades {
    struct raster *raster;
    float *bright; /* NULL: no shades */
};

static enum rc_status
shades_new(const struct page *p, size_t image_w, size_t image_h, struct shades *s,
           struct rc_err *err)
{
    const struct figure *f = p->f;
    size_t w = p->g->nx < image_w ? p->g->nx : image_w;
    size_t h = p->g->ny < image_h ? p->g->ny : image_h;
    double aspect =
        (f->at.bottom - f->at.top) / (double)h / ((f->at.right - f->at.left) / (double)w);

    if (!f->hillshade)
        return RC_OK;
    if ((s->raster = raster_new(p->g, f->nodes.zero_is_none, w, h, err)) == NULL)
        return RC_FAIL;
    s->bright = hillshade_new(s->raster, aspect, err);
    return s->bright != NULL ? RC_OK : RC_FAIL;
}

static void
shades_free(struct shades *s)
{
    raster_free(s->raster);
    free(s->bright);
}

/* The colour of cell (i, j) of w by h with its shade. */
static struct rgb
lit(const struct shades *s, struct rgb c, size_t i, size_t j, size_t w, size_t h)
{
    double b;

    if (s->bright == NULL)
        return c;
    b = (double)s->bright[j * s->raster->h / h * s->raster->w + i * s->raster->w / w];
    return (struct rgb){(unsigned char)fmin(255, c.r * b + 0.5),
                        (unsigned char)fmin(255, c.g * b + 0.5),
                        (unsigned char)fmin(255, c.b * b + 0.5)};
}

/* The colour of cell (i, j) of a raster whose first row is the given row of the map. */
static struct rgb
cell_colour(const struct page *p, const struct raster *r, size_t i, size_t j, size_t first)
{
    const struct figure *f = p->f;
    size_t k = j * r->w + i;
    double none = (double)r->none[k], missing = raster_missing(r, k);
    struct rgb colour = missing_at(p, i, first + j), value;

    if (isnan(r->v[k]))
        return none > 0 ? mix(f->bar.map->none, none, colour, 1 - none) : colour;
    value = colour_of(f, r->v[k]);
    if (missing > 0)
        value = mix(value, fmax(0, 1 - missing), colour, fmin(missing, 1));
    return none > 0 ? mix(value, fmax(0, 1 - none), f->bar.map->none, fmin(none, 1)) : value;
}

static struct raster *
new_rows(struct page *p, size_t w, size_t h, size_t first, size_t rows, struct rc_err *err)
{
    if (p->f->keep_max && (w < p->g->nx || h < p->g->ny))
        return raster_rows_max(p->g, p->f->nodes.zero_is_none, w, h, first, rows, err);
    return raster_rows(p->g, p->f->nodes.zero_is_none, w, h, first, rows, err);
}

static enum rc_status
paint_rows(struct page *p, const struct shades *shades, size_t w, size_t h, size_t first,
           size_t rows, struct rgb *pixel, struct rc_err *err)
{
    RC_OWN(raster, r) = new_rows(p, w, h, first, rows, err);

    if (r == NULL)
        return RC_FAIL;
    for (size_t j = 0; j < rows; j++)
        for (size_t i = 0; i < w; i++)
            pixel[(first + j) * w + i] =
                lit(shades, cell_colour(p, r, i, j, first), i, first + j, w, h);
    return RC_OK;
}

/* The map on w by h pixels; some rows at a time are in memory as means. */
static enum rc_status
paint(struct page *p, size_t w, size_t h, struct rc_err *err)
{
    RC_OWNED struct rgb *pixel = malloc(w * h * sizeof *pixel);
    RC_ENDS(shades_free) struct shades shades = {0};

    if (pixel == NULL)
        return rc_err_set(err, "out of memory for a map of %zu by %zu pixels", w, h);
    if (shades_new(p, w, h, &shades, err) != RC_OK)
        return RC_FAIL;
    for (size_t first = 0; first < h; first += BAND)
        if (paint_rows(p, &shades, w, h, first, h - first < BAND ? h - first : BAND, pixel, err) !=
            RC_OK)
            return RC_FAIL;
    canvas_image(p->c, p->plot.x, p->plot.y, p->plot.w, p->plot.h, rc_give(&pixel), NULL, w, h);
    return RC_OK;
}

static void
stroke_lines(struct page *p, struct lines *l, const struct raster *r, double width,
             struct rgb colour)
{
    double x = p->plot.x, y = p->plot.y;
    double sx = p->plot.w / (double)r->w, sy = p->plot.h / (double)r->h;

    for (size_t k = 0; k < l->n; k++) {
        canvas_line(p->c, x + sx * l->at[k][0], y + sy * l->at[k][1], x + sx * l->at[k][2],
                    y + sy * l->at[k][3]);
    }
    canvas_stroke(p->c, width, colour);
    l->n = 0;
}

static struct rgb
line_colour(const struct figure *f, double value)
{
    return colormap_is_dark(colour_of(f, value)) ? light : page_ink;
}

/* The line is thinner than a node, so that a line around a single node does not hide it. */
static double
border_width(const struct page *p)
{
    double node = fmin(p->plot.w / (double)p->g->nx, p->plot.h / (double)p->g->ny);

    return fmin(1.5 * p->u, fmax(0.35 * node, 0.4 * p->u));
}

/* True if the nodes in contact have dark colours in a map of another channel. */
static bool
is_dark_in_contact(const struct panel *panel)
{
    const struct rc_grid *of = panel->figure.edge.contact, *g = panel->grid;
    double sum = 0, n = 0;

    if (!panel->figure.edge.contour || of == NULL || of == g || of->nx != g->nx || of->ny != g->ny)
        return false;
    for (size_t k = 0; k < of->nx * of->ny; k++)
        if (rc_in_contact(of->v[k]) && isfinite(g->v[k])) {
            sum += g->v[k];
            n++;
        }
    return n > 0 && colormap_is_dark(colour_of(&panel->figure, sum / n));
}

/* The position on the page of a place on the map in metres. */
static double
page_x(const struct page *p, double x)
{
    return p->plot.x + (x - p->f->at.left) / (p->f->at.right - p->f->at.left) * p->plot.w;
}

static double
page_y(const struct page *p, double y)
{
    return p->plot.y + (y - p->f->at.top) / (p->f->at.bottom - p->f->at.top) * p->plot.h;
}

static void
draw_circle(struct page *p)
{
    const int steps = p->f->mark.across == '\0' ? 360 : -1;
    const double r = p->f->mark.radius;

    page_clip(p);
    for (int side = -1; side <= 1 && p->f->mark.across == 'x'; side += 2)
        canvas_line(p->c, page_x(p, side * r), p->plot.y, page_x(p, side * r),
                    p->plot.y + p->plot.h);
    for (int side = -1; side <= 1 && p->f->mark.across == 'y'; side += 2)
        canvas_line(p->c, p->plot.x, page_y(p, side * r), p->plot.x + p->plot.w,
                    page_y(p, side * r));
    for (int k = 0; k <= steps; k++) {
        double turn = 4 * acos(0.0) * k / steps;
        double x = page_x(p, r * cos(turn)), y = page_y(p, r * sin(turn));

        if (k == 0)
            canvas_move(p->c, x, y);
        else
            canvas_draw_to(p->c, x, y);
    }
    canvas_dashes(p->c, 2 * p->u, 9 * p->u, circle_ink);
    page_clip_end(p);
}

/* A cross with a light rim, visible on every colour. */
static void
draw_cross(struct page *p, double x, double y)
{
    for (int layer = 0; layer < 2; layer++) {
        double reach = (layer == 0 ? 11 : 10) * p->u;

        canvas_line(p->c, x - reach, y, x + reach, y);
        canvas_line(p->c, x, y - reach, x, y + reach);
        canvas_stroke(p->c, (layer == 0 ? 5 : 2) * p->u, layer == 0 ? light : page_ink);
    }
}

static enum rc_status
draw_contours(struct page *p, const struct raster *r, struct rc_err *err)
{
    const struct axis *a = &p->values;
    struct lines lines = {0};
    enum rc_status status = RC_OK;

    page_clip(p);
    for (size_t k = 0; k < a->marks && status == RC_OK; k++) {
        double level = a->mark[k].value * a->scale.size;

        if (p->f->edge.border || !a->mark[k].major || (p->f->nodes.zero_is_none && level == 0))
            continue; /* the edge of the contact shows this better */
        status = raster_contour(r, level, &lines, err);
        stroke_lines(p, &lines, r, p->f->nodes.zero_is_none ? border_width(p) : 1.5 * p->u,
                     line_colour(p->f, level));
    }
    if (status == RC_OK && p->f->edge.contact != NULL) {
        status = raster_border(p->f->edge.contact, 0, r->w, r->h, &lines, err);
        stroke_lines(p, &lines, r, border_width(p), p->edge);
    }
    if (status == RC_OK && p->f->edge.hard > 0) {
        status = raster_border(p->f->edge.pressure, p->f->edge.hard, r->w, r->h, &lines, err);
        stroke_lines(p, &lines, r, border_width(p), hard_ink);
    }
    page_clip_end(p);
    free(lines.at);
    return status;
}

/* In a PDF or SVG a node is a pixel of the image at any size. The chequers of missing nodes need the pixels
 * of the page. Contours pass through the nodes of an enlarged map and through the pixels of a reduced one. */
static enum rc_status
draw_map(struct page *p, struct rc_err *err)
{
    const struct figure *f = p->f;
    size_t nx = p->g->nx, ny = p->g->ny, plot_w = (size_t)p->plot.w, plot_h = (size_t)p->plot.h;
    size_t w = plot_w, h = plot_h;
    RC_OWN(raster, r) = NULL;

    if (f->vector && f->nodes.missing == 0) {
        w = nx < IMAGE_MOST ? nx : IMAGE_MOST;
        h = ny < IMAGE_MOST ? ny : IMAGE_MOST;
    }
    if (paint(p, w, h, err) != RC_OK)
        return RC_FAIL;
    if (!f->edge.contour)
        return RC_OK;
    w = nx < plot_w ? nx : plot_w;
    h = ny < plot_h ? ny : plot_h;
    r = new_rows(p, w, h, 0, h, err);
    return r != NULL ? draw_contours(p, r, err) : RC_FAIL;
}

/* The colours over the rectangle, along its longer side, low values left or at the bottom. */
static void
paint_bar(struct page *p, double x, double y, double w, double h)
{
    struct rgb *pixel = malloc(STEPS * sizeof *pixel);

    for (size_t k = 0; k < STEPS && pixel != NULL; k++) {
        double t = ((double)k + 0.5) / STEPS;

        pixel[k] = colormap_at(p->f->bar.map, p->bar_below ? t : 1 - t);
    }
    canvas_image(p->c, x, y, w, h, pixel, NULL, p->bar_below ? STEPS : 1, p->bar_below ? 1 : STEPS);
}

/* Draws a triangle at each end of the bar beyond which there are values. */
static void
point_bar(struct page *p, double x, double y, double w, double h)
{
    const struct figure *f = p->f;
    double reach = 18 * p->u, gap = 4 * p->u;

    for (int end = 0; end < 2; end++) {
        struct rgb colour = colormap_at(f->bar.map, end);
        double sign = end == 0 ? -1 : 1;
        double corner[3][2];

        if (!(end == 0 ? f->bar.min < f->bar.lo : f->bar.max > f->bar.hi))
            continue;
        for (int k = 0; k < 3; k++) {
            double out = sign * (gap + (k == 1 ? reach : 0)), along = 0.5 * (double)k;

            corner[k][0] = p->bar_below ? (end == 0 ? x : x + w) + out : x + along * w;
            corner[k][1] = p->bar_below ? y + along * h : (end == 0 ? y + h : y) - out;
        }
        canvas_triangle(p->c, corner, colour);
        for (int k = 0; k < 4; k++) /* a pale end would be invisible on white paper */
            if (k == 0)
                canvas_move(p->c, corner[0][0], corner[0][1]);
            else
                canvas_draw_to(p->c, corner[k % 3][0], corner[k % 3][1]);
        canvas_stroke(p->c, fmax(1, 1.2 * p->u), page_ink);
    }
}

void
figure_bar(struct page *p)
{
    double u = p->u, thick = round(28 * u);
    double x = p->plot.x, y = p->plot.y, w = p->plot.w, h = p->plot.h;
    const struct axis *a = &p->values;

    if (p->f->nodes.is != NULL)
        return;
    if (p->bar_below) {
        y = round(y + h + page_bar_below(p));
        h = thick;
    } else {
        x = round(x + w + page_bar_right(p));
        w = thick;
    }
    paint_bar(p, x, y, w, h);
    point_bar(p, x, y, w, h);
    for (size_t k = 0; p->f->edge.contour && !p->f->edge.border && k < a->marks; k++) {
        double t = a->mark[k].at;
        struct rgb colour = line_colour(p->f, a->mark[k].value * a->scale.size);

        if (!a->mark[k].major || t < 0.002 || t > 0.998)
            continue; /* the frame is already drawn */
        if (p->bar_below)
            canvas_fill(p->c, x + t * w - 0.75 * u, y, 1.5 * u, h, colour);
        else
            canvas_fill(p->c, x, y + (1 - t) * h - 0.75 * u, w, 1.5 * u, colour);
    }
    page_frame(p, x, y, w, h);
    if (p->bar_below)
        axis_across(p, a, x, y + h, w);
    else
        axis_upright(p, a, x + w, y, h, false, false);
}

/* ---- legend ---- */

/* Samples in the legend. */
enum sample {
    NO_SAMPLE,
    NONE,
    ONE,
    TWO,
    MISSING,
    CONTACT,
    HARD,
    CIRCLE,
    LARGEST
};

/* Their numbers are beside the plot. */
static void
add_media(struct page *p)
{
    char text[LINE];
    size_t first, n = media_seen(p->f, &first);

    if (n > MEDIA_TOLD) {
        snprintf(text, sizeof text, "lines: where %zu media meet", n);
        legend_add(p, NO_SAMPLE, text);
        return;
    }
    for (size_t k = first; k < first + n; k++) {
        snprintf(text, sizeof text, "%zu: %s", k + 1, p->f->medium[k].text);
        legend_add(p, NO_SAMPLE, text);
    }
}

static const char *
say_scales(const struct figure *f, char *text, size_t size)
{
    if (f->at.aspect > 0)
        snprintf(text, size, "%s is drawn %.4g times as large as %s", f->at.down, f->at.aspect,
                 f->at.across);
    else
        snprintf(text, size, "the axes differ in scale");
    return text;
}

void
figure_legend(struct page *p)
{
    char text[LINE];

    if (p->f->nodes.zero_is_none && (p->f->nodes.zeros > 0 || p->f->nodes.is != NULL))
        legend_add(p, NONE, p->f->nodes.none);
    for (int k = 0; k < 2 && p->f->nodes.is != NULL && p->f->nodes.is[k] != NULL; k++)
        legend_add(p, k == 0 ? ONE : TWO, p->f->nodes.is[k]);
    snprintf(text, sizeof text, "%s (%zu of %zu nodes)",
             p->f->nodes.missing_is == NULL ? "not measured" : p->f->nodes.missing_is,
             p->f->nodes.missing, p->f->nodes.all != 0 ? p->f->nodes.all : p->g->nx * p->g->ny);
    if (p->f->nodes.missing > 0)
        legend_add(p, MISSING, text);
    if (p->f->edge.contour && p->f->edge.contact != NULL)
        legend_add(p, CONTACT, "edge of contact");
    if (p->f->edge.contour && p->f->edge.hard > 0)
        legend_add(p, HARD, "pressure at the hardness");
    legend_add(p, CIRCLE, p->f->mark.circle);
    legend_add(p, LARGEST, p->f->mark.largest);
    add_media(p);
    legend_add(p, NO_SAMPLE, p->f->bar.note);
    if (p->distorted)
        legend_add(p, NO_SAMPLE, say_scales(p->f, text, sizeof text));
}

static void
draw_missing(struct page *p, double x, double y, size_t w, size_t h)
{
    struct rgb *pixel = malloc(w * h * sizeof *pixel);

    for (size_t k = 0; k < w * h && pixel != NULL; k++)
        pixel[k] = missing_at(p, k % w, k / w);
    canvas_image(p->c, x, y, (double)w, (double)h, pixel, NULL, w, h);
}

/* It is 4 n / 3 wide. */
void
figure_sample(struct page *p, size_t sample, double x, double y, size_t n)
{
    double w = (double)(n + n / 3), h = (double)n, u = p->u;

    if (sample == LARGEST)
        draw_cross(p, x + 0.5 * w, y + 0.5 * h);
    if (sample == CONTACT || sample == HARD || sample == CIRCLE) {
        canvas_line(p->c, x, y + 0.5 * h, x + w, y + 0.5 * h);
        if (sample == CIRCLE)
            canvas_dashes(p->c, 2 * u, 9 * u, circle_ink);
        else
            canvas_stroke(p->c, 2 * u, sample == HARD ? hard_ink : p->edge);
    }
    if (sample == NONE)
        canvas_fill(p->c, x, y, w, h, p->f->bar.map->none);
    if (sample == ONE || sample == TWO)
        canvas_fill(p->c, x, y, w, h, colour_of(p->f, sample == ONE ? 1 : 2));
    if (sample == MISSING)
        draw_missing(p, x, y, n + n / 3, n);
    if (sample >= NONE && sample <= MISSING)
        page_frame(p, x, y, w, h);
}

/* ---- the whole ---- */

/* Draws the title of each of several maps; smaller if they are narrow. */
static struct canvas_font
label_font(const struct page *p, const struct panels *panels)
{
    struct canvas_font font = p->font.small;
    double widest = 1;

    font.bold = true;
    for (size_t k = 0; k < panels->n; k++)
        widest = fmax(widest, canvas_text_width(p->c, &font, panels->panel[k].label));
    font.size *= fmin(1, fmax(0.6, 0.97 * p->maps.w / widest));
    return font;
}

/* Axes are left of the first column and under the lowest map of each column. */
static enum rc_status
draw_panel(struct page *p, const struct panels *panels, size_t k, struct rc_err *err)
{
    const struct panel *panel = &panels->panel[k];
    struct canvas_font font = label_font(p, panels);
    const struct box *at = &p->plot;
    char label[LINE];

    p->f = &panel->figure;
    p->g = panel->grid;
    p->plot.x += floor(p->maps.across_step * (double)(k % p->maps.columns));
    p->plot.y += floor(p->maps.down_step * (double)(k / p->maps.columns));
    p->plot.w = p->maps.w;
    p->plot.h = p->maps.h;
    snprintf(label, sizeof label, "%s", panel->label);
    page_shorten(p, &font, at->w, label);
    if (*label != '\0')
        canvas_text(p->c, &font, at->x, at->y - 0.45 * p->font.small.size, 0, label);
    if (draw_map(p, err) != RC_OK)
        return RC_FAIL;
    media_draw(p);
    if (p->f->mark.circle != NULL)
        draw_circle(p);
    if (p->f->mark.largest != NULL)
        draw_cross(p, page_x(p, p->f->mark.x), page_y(p, p->f->mark.y));
    page_frame(p, at->x, at->y, at->w, at->h);
    if (k % p->maps.columns == 0)
        axis_upright(p, &p->down, at->x, at->y, at->h, true, true);
    if (k + p->maps.columns >= panels->n)
        axis_across(p, &p->across, at->x, at->y + at->h, at->w);
    return RC_OK;
}

static enum rc_status
draw(struct page *p, struct rc_err *err)
{
    const struct panels *panels = p->of;
    const struct box plot = p->plot;

    p->edge = page_ink;
    for (size_t k = 0; k < panels->n; k++)
        if (is_dark_in_contact(&panels->panel[k]))
            p->edge = edge_on_dark; /* visible on white too */
    for (size_t k = 0; k < panels->n; k++) {
        if (draw_panel(p, panels, k, err) != RC_OK)
            return RC_FAIL;
        p->plot = plot;
    }
    p->f = panels->figure;
    p->g = panels->panel[0].grid;
    figure_bar(p);
    return RC_OK;
}

static const struct page_kind one_map = {1200, page_lay_out, draw, FIGURE_SAMPLE, figure_sample},
                              several_maps = {SHEET_WIDTH, page_lay_out, draw, FIGURE_SAMPLE,
                                              figure_sample};

struct canvas *
panels_draw(const struct panels *panels, struct rc_err *err)
{
    RC_OWNED struct page *p = page_new(panels->n * panels->columns > 1 ? &several_maps : &one_map,
                                       (void *)panels, &panels->figure->paper, err);

    if (p == NULL)
        return NULL;
    p->f = panels->figure;
    p->g = panels->panel[0].grid;
    p->maps.columns = panels->columns;
    p->maps.rows = (panels->n + panels->columns - 1) / panels->columns;
    return pages_draw(&p, 1, err);
}

struct canvas *
figure_draw(const struct figure *f, const struct rc_grid *g, struct rc_err *err)
{
    const struct panel panel = {.figure = *f, .grid = g};

    return panels_draw(&(struct panels){f, &panel, 1, 1}, err);
}

size_t
panels_columns(size_t n, double aspect)
{
    const double page = 1.4; /* width over height */
    double least = INFINITY;
    size_t best = 1;

    for (size_t columns = 1; columns <= n; columns++) {
        size_t rows = (n + columns - 1) / columns;
        double empty = (double)(columns * rows - n) / (double)n;
        double cost = fabs(log(aspect * (double)columns / (double)rows / page)) + 2 * empty;

        if (cost < least - 1e-9) {
            least = cost;
            best = columns;
        }
    }
    return best;
}
