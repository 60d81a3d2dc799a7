#include "canvas.h"

#include <cairo.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

struct canvas {
    cairo_surface_t *surface;
    cairo_t *cairo;
    size_t w, h;
};

static void
set_colour(struct canvas *c, struct rgb colour)
{
    cairo_set_source_rgb(c->cairo, colour.r / 255.0, colour.g / 255.0, colour.b / 255.0);
}

struct canvas *
canvas_new(size_t w, size_t h, struct rc_err *err)
{
    struct canvas *c;
    cairo_font_options_t *font;

    if (w == 0 || h == 0 || w > CANVAS_MOST || h > CANVAS_MOST) {
        rc_err_set(err, "a figure of %zu by %zu pixels: a side is 1 to %d", w, h, CANVAS_MOST);
        return NULL;
    }
    c = calloc(1, sizeof *c);
    if (c == NULL) {
        rc_err_set(err, "out of memory for a figure");
        return NULL;
    }
    *c = (struct canvas){.w = w, .h = h};
    c->surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)w, (int)h);
    c->cairo = cairo_create(c->surface);
    if (cairo_status(c->cairo) != CAIRO_STATUS_SUCCESS) {
        rc_err_set(err, "a figure of %zu by %zu pixels: %s", w, h,
                   cairo_status_to_string(cairo_status(c->cairo)));
        canvas_free(c);
        return NULL;
    }
    /* Shades of grey and unrounded widths: text looks the same whatever the screen of the machine.
     */
    font = cairo_font_options_create();
    cairo_font_options_set_antialias(font, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(font, CAIRO_HINT_STYLE_SLIGHT);
    cairo_font_options_set_hint_metrics(font, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(c->cairo, font);
    cairo_font_options_destroy(font);
    canvas_fill(c, 0, 0, (double)w, (double)h, (struct rgb){255, 255, 255});
    return c;
}

void
canvas_free(struct canvas *c)
{
    if (c == NULL)
        return;
    cairo_destroy(c->cairo);
    cairo_surface_destroy(c->surface);
    free(c);
}

size_t
canvas_width(const struct canvas *c)
{
    return c->w;
}

size_t
canvas_height(const struct canvas *c)
{
    return c->h;
}

/* ---- text ---- */

static void
set_font(struct canvas *c, const struct canvas_font *f)
{
    cairo_select_font_face(c->cairo, "sans", CAIRO_FONT_SLANT_NORMAL,
                           f->bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(c->cairo, f->size);
    set_colour(c, f->colour);
}

double
canvas_text_width(struct canvas *c, const struct canvas_font *f, const char *text)
{
    cairo_text_extents_t e;

    set_font(c, f);
    cairo_text_extents(c->cairo, text, &e);
    return e.x_advance;
}

void
canvas_text(struct canvas *c, const struct canvas_font *f, double x, double y, double part,
            const char *text)
{
    double w = canvas_text_width(c, f, text);

    cairo_move_to(c->cairo, x - part * w, y);
    cairo_show_text(c->cairo, text);
    cairo_new_path(c->cairo);
}

void
canvas_text_upwards(struct canvas *c, const struct canvas_font *f, double x, double y,
                    const char *text)
{
    double w = canvas_text_width(c, f, text);

    cairo_save(c->cairo);
    cairo_translate(c->cairo, x, y + 0.5 * w);
    cairo_rotate(c->cairo, -acos(0.0));
    cairo_move_to(c->cairo, 0, 0);
    cairo_show_text(c->cairo, text);
    cairo_new_path(c->cairo);
    cairo_restore(c->cairo);
}

/* ---- shapes ---- */

void
canvas_fill(struct canvas *c, double x, double y, double w, double h, struct rgb colour)
{
    set_colour(c, colour);
    cairo_rectangle(c->cairo, x, y, w, h);
    cairo_fill(c->cairo);
}

void
canvas_frame(struct canvas *c, double x, double y, double w, double h, double width,
             struct rgb colour)
{
    set_colour(c, colour);
    cairo_set_line_width(c->cairo, width);
    cairo_set_line_join(c->cairo, CAIRO_LINE_JOIN_MITER);
    cairo_rectangle(c->cairo, x - 0.5 * width, y - 0.5 * width, w + width, h + width);
    cairo_stroke(c->cairo);
}

void
canvas_triangle(struct canvas *c, double corner[3][2], struct rgb colour)
{
    set_colour(c, colour);
    for (int k = 0; k < 3; k++)
        cairo_line_to(c->cairo, corner[k][0], corner[k][1]);
    cairo_close_path(c->cairo);
    cairo_fill(c->cairo);
}

void
canvas_clip(struct canvas *c, double x, double y, double w, double h)
{
    cairo_reset_clip(c->cairo);
    if (w <= 0)
        return;
    cairo_rectangle(c->cairo, x, y, w, h);
    cairo_clip(c->cairo);
}

void
canvas_move(struct canvas *c, double x, double y)
{
    cairo_move_to(c->cairo, x, y);
}

void
canvas_draw_to(struct canvas *c, double x, double y)
{
    cairo_line_to(c->cairo, x, y);
}

void
canvas_stroke(struct canvas *c, double width, struct rgb colour)
{
    set_colour(c, colour);
    cairo_set_line_width(c->cairo, width);
    cairo_set_line_cap(c->cairo, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(c->cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_stroke(c->cairo);
    cairo_set_line_cap(c->cairo, CAIRO_LINE_CAP_BUTT);
}

/* ---- pixels: 32 bits each, 0xXXRRGGBB in the byte order of the machine ---- */

static uint32_t *
row_at(struct canvas *c, size_t y)
{
    size_t stride = (size_t)cairo_image_surface_get_stride(c->surface);

    return (uint32_t *)(void *)(cairo_image_surface_get_data(c->surface) + y * stride);
}

void
canvas_pixel(struct canvas *c, size_t x, size_t y, struct rgb colour)
{
    cairo_surface_flush(c->surface);
    row_at(c, y)[x] = (uint32_t)colour.r << 16 | (uint32_t)colour.g << 8 | colour.b;
    cairo_surface_mark_dirty_rectangle(c->surface, (int)x, (int)y, 1, 1);
}

enum rc_status
canvas_row(struct canvas *c, size_t y, unsigned char *rgb, struct rc_err *err)
{
    const uint32_t *row;

    if (cairo_status(c->cairo) != CAIRO_STATUS_SUCCESS)
        return rc_err_set(err, "the figure cannot be drawn: %s",
                          cairo_status_to_string(cairo_status(c->cairo)));
    cairo_surface_flush(c->surface);
    row = row_at(c, y);
    for (size_t x = 0; x < c->w; x++) {
        rgb[3 * x] = (unsigned char)(row[x] >> 16 & 0xff);
        rgb[3 * x + 1] = (unsigned char)(row[x] >> 8 & 0xff);
        rgb[3 * x + 2] = (unsigned char)(row[x] & 0xff);
    }
    return RC_OK;
}
