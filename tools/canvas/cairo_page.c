/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Draws the items of a canvas with cairo, as pixels or as the pages of a PDF.
 */
#include <cairo-pdf.h>
#include <cairo.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "canvas_list.h"

static void
set_colour(cairo_t *cairo, struct rgb colour)
{
    cairo_set_source_rgb(cairo, colour.r / 255.0, colour.g / 255.0, colour.b / 255.0);
}

/* ---- items ---- */

static void
show_text(struct canvas *c, cairo_t *cairo, const struct item *i)
{
    cairo_save(cairo);
    cairo_translate(cairo, i->x, i->y);
    if (i->upwards)
        cairo_rotate(cairo, -acos(0.0));
    cairo_move_to(cairo, -i->part * i->length, 0);
    lettering_show(c->lettering, cairo, &i->font, i->text);
    cairo_restore(cairo);
}

/* Lines are stroked in pieces of this number of points, because cairo's memory for a stroke drawn as pixels
 * grows with its points. Its time grows faster. Ends and corners are round, so that the seams are invisible;
 * dashed lines are stroked at once, because each stroke begins with a dash. */
enum {
    STROKE = 100
};

static void
show_lines(cairo_t *cairo, const struct item *i)
{
    size_t most = i->kind == ITEM_POLYGON || i->dash > 0 ? i->points : STROKE;

    set_colour(cairo, i->colour);
    cairo_set_line_width(cairo, i->width);
    cairo_set_line_cap(cairo, i->dash > 0 ? CAIRO_LINE_CAP_BUTT : CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    if (i->dash > 0)
        cairo_set_dash(cairo, &i->dash, 1, 0);
    for (size_t k = 0; k < i->points; k++) {
        if (k > 0 && k % most == 0) {
            cairo_stroke(cairo);
            cairo_move_to(cairo, i->point[k - 1].x, i->point[k - 1].y);
        }
        if (i->point[k].begins)
            cairo_move_to(cairo, i->point[k].x, i->point[k].y);
        else
            cairo_line_to(cairo, i->point[k].x, i->point[k].y);
    }
    if (i->kind == ITEM_POLYGON) {
        cairo_close_path(cairo);
        cairo_fill(cairo);
    } else {
        cairo_stroke(cairo);
    }
    cairo_set_dash(cairo, NULL, 0, 0);
}

/* Pixels are 0xAARRGGBB. */
static void
show_image(struct canvas *c, cairo_t *cairo, const struct item *i)
{
    RC_OWNED unsigned *pixel = malloc(i->nx * i->ny * sizeof *pixel);
    cairo_surface_t *image = cairo_image_surface_create_for_data(
        (unsigned char *)pixel, i->inked != NULL ? CAIRO_FORMAT_ARGB32 : CAIRO_FORMAT_RGB24,
        (int)i->nx, (int)i->ny, 4 * (int)i->nx);

    c->short_of_memory = c->short_of_memory || pixel == NULL;
    for (size_t k = 0; k < i->nx * i->ny && pixel != NULL; k++)
        pixel[k] = i->inked != NULL && !i->inked[k]
                       ? 0
                       : 0xff000000U | (unsigned)i->pixel[k].r << 16 |
                             (unsigned)i->pixel[k].g << 8 | i->pixel[k].b;
    cairo_save(cairo);
    cairo_translate(cairo, i->x, i->y);
    cairo_scale(cairo, i->w / (double)i->nx, i->h / (double)i->ny);
    cairo_set_source_surface(cairo, image, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(cairo), CAIRO_FILTER_NEAREST);
    cairo_rectangle(cairo, 0, 0, (double)i->nx, (double)i->ny);
    cairo_fill(cairo);
    cairo_restore(cairo);
    cairo_surface_destroy(image);
}

static void
show(struct canvas *c, cairo_t *cairo, const struct item *i)
{
    switch (i->kind) {
    case ITEM_TEXT:
        show_text(c, cairo, i);
        break;
    case ITEM_FILL:
        set_colour(cairo, i->colour);
        cairo_rectangle(cairo, i->x, i->y, i->w, i->h);
        cairo_fill(cairo);
        break;
    case ITEM_FRAME:
        set_colour(cairo, i->colour);
        cairo_set_line_width(cairo, i->width);
        cairo_set_line_join(cairo, CAIRO_LINE_JOIN_MITER);
        cairo_rectangle(cairo, i->x, i->y, i->w, i->h);
        cairo_stroke(cairo);
        break;
    case ITEM_CLIP:
        cairo_reset_clip(cairo);
        if (i->w > 0) {
            cairo_rectangle(cairo, i->x, i->y, i->w, i->h);
            cairo_clip(cairo);
        }
        break;
    case ITEM_POLYGON:
    case ITEM_LINES:
        show_lines(cairo, i);
        break;
    case ITEM_IMAGE:
        show_image(c, cairo, i);
        break;
    }
}

static enum rc_status
check(const struct canvas *c, cairo_t *cairo, struct rc_err *err)
{
    if (canvas_check(c, err) != RC_OK)
        return RC_FAIL;
    if (cairo_status(cairo) != CAIRO_STATUS_SUCCESS)
        return rc_err_set(err, "the figure cannot be drawn: %s",
                          cairo_status_to_string(cairo_status(cairo)));
    return RC_OK;
}

/* ---- pixels ---- */

enum rc_status
drawn_update(struct canvas *c, struct rc_err *err)
{
    cairo_surface_t *surface;
    cairo_t *cairo;
    enum rc_status status;

    if (c->drawn != NULL)
        return RC_OK;
    if ((c->drawn = calloc(c->w * c->h, sizeof *c->drawn)) == NULL)
        return rc_err_set(err, "out of memory for a figure of %zu by %zu pixels", c->w, c->h);
    surface = cairo_image_surface_create_for_data((unsigned char *)c->drawn, CAIRO_FORMAT_RGB24,
                                                  (int)c->w, (int)c->h, 4 * (int)c->w);
    cairo = cairo_create(surface);
    for (size_t k = 0; k < c->items; k++)
        show(c, cairo, &c->item[k]);
    status = check(c, cairo, err);
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
    return status;
}

/* ---- PDF ---- */

struct sink {
    FILE *file;
    int why;
};

static cairo_status_t
put(void *ctx, const unsigned char *bytes, unsigned n)
{
    struct sink *s = ctx;

    if (fwrite(bytes, 1, n, s->file) == n)
        return CAIRO_STATUS_SUCCESS;
    s->why = errno;
    return CAIRO_STATUS_WRITE_ERROR;
}

static const char *
find(const struct picture_text *text, size_t texts, const char *keyword)
{
    for (size_t k = 0; k < texts; k++)
        if (strcmp(text[k].keyword, keyword) == 0 && text[k].text != NULL)
            return text[k].text;
    return "";
}

enum rc_status
pdf_write(struct canvas *c, const struct picture_text *text, size_t texts, FILE *file,
          struct rc_err *err)
{
    struct sink sink = {.file = file};
    double point = 72 / c->dpi;
    cairo_surface_t *surface =
        cairo_pdf_surface_create_for_stream(put, &sink, point * (double)c->w, point * (double)c->h);
    cairo_t *cairo = cairo_create(surface);
    enum rc_status status;

    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, find(text, texts, "Title"));
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_SUBJECT,
                                   find(text, texts, "Description"));
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_KEYWORDS,
                                   find(text, texts, "Warning"));
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATOR,
                                   find(text, texts, "Software"));
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, NULL);
    cairo_scale(cairo, point, point);
    for (size_t k = 0; k < c->items; k++) {
        struct item *i = &c->item[k];

        show(c, cairo, i);
        if (i->kind == ITEM_IMAGE && (i->reserved = malloc(4 * i->nx * i->ny)) == NULL)
            c->short_of_memory = true;
    }
    cairo_show_page(cairo);
    status = check(c, cairo, err);
    cairo_destroy(cairo);
    cairo_surface_finish(surface);
    if (sink.why != 0)
        status = rc_err_set(err, "the PDF cannot be written: %s", strerror(sink.why));
    else if (status == RC_OK && cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS)
        status = rc_err_set(err, "the PDF cannot be written: %s",
                            cairo_status_to_string(cairo_surface_status(surface)));
    cairo_surface_destroy(surface);
    return status;
}
