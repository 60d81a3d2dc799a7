/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The list of items on the page; cairo_page.c and svg.c write it to files.
 */
#include "canvas.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "canvas_list.h"

struct canvas *
canvas_new(size_t w, size_t h, struct rc_err *err)
{
    struct canvas *c;

    if (w == 0 || h == 0 || w > CANVAS_MOST || h > CANVAS_MOST)
        return rc_err_null(err, "a figure of %zu by %zu pixels: a side is 1 to %d", w, h,
                           CANVAS_MOST);
    c = calloc(1, sizeof *c);
    if (c == NULL || (c->lettering = lettering_new()) == NULL) {
        free(c);
        return rc_err_null(err, "out of memory for a figure");
    }
    c->w = w;
    c->h = h;
    c->dpi = 216;
    canvas_fill(c, 0, 0, (double)w, (double)h, (struct rgb){255, 255, 255});
    return c;
}

static void
item_clear(struct item *i)
{
    free(i->text);
    free(i->point);
    free(i->pixel);
    free(i->inked);
    free(i->reserved);
}

void
canvas_free(struct canvas *c)
{
    if (c == NULL)
        return;
    for (size_t k = 0; k < c->items; k++)
        item_clear(&c->item[k]);
    free(c->item);
    free(c->path);
    lettering_free(c->lettering);
    free(c->drawn);
    free(c);
}

/* Takes over the memory that the item owns, also on failure. */
static void
add(struct canvas *c, struct item item)
{
    if (c->items == c->capacity) {
        size_t capacity = c->capacity == 0 ? 64 : 2 * c->capacity;
        struct item *list = realloc(c->item, capacity * sizeof *list);

        if (list == NULL) {
            c->short_of_memory = true;
            item_clear(&item);
            return;
        }
        c->item = list;
        c->capacity = capacity;
    }
    c->item[c->items++] = item;
}

/* ---- text ---- */

const char *
canvas_set_family(struct canvas *c, const char *family)
{
    lettering_set_family(c->lettering, family);
    return lettering_family(c->lettering);
}

double
canvas_text_width(struct canvas *c, const struct canvas_font *f, const char *text)
{
    return lettering_width(c->lettering, f, text);
}

static void
add_text(struct canvas *c, struct item item, const char *text)
{
    item.kind = ITEM_TEXT;
    item.length = lettering_width(c->lettering, &item.font, text);
    if ((item.text = strdup(text)) == NULL)
        c->short_of_memory = true;
    else
        add(c, item);
}

void
canvas_text(struct canvas *c, const struct canvas_font *f, double x, double y, double part,
            const char *text)
{
    add_text(c, (struct item){.font = *f, .x = x, .y = y, .part = part}, text);
}

void
canvas_text_upwards(struct canvas *c, const struct canvas_font *f, double x, double y,
                    const char *text)
{
    add_text(c, (struct item){.font = *f, .x = x, .y = y, .part = 0.5, .upwards = true}, text);
}

const char *
canvas_unknown(const struct canvas *c)
{
    return lettering_unknown(c->lettering);
}

const char *
canvas_warning(const struct canvas *c, char *text, size_t size)
{
    const char *unknown = canvas_unknown(c);

    if (*unknown == '\0')
        return NULL;
    snprintf(text, size,
             "no font has the characters '%s': a question mark is drawn for each; install a font "
             "that has them",
             unknown);
    return text;
}

/* ---- shapes ---- */

void
canvas_fill(struct canvas *c, double x, double y, double w, double h, struct rgb colour)
{
    add(c, (struct item){.kind = ITEM_FILL, .x = x, .y = y, .w = w, .h = h, .colour = colour});
}

void
canvas_frame(struct canvas *c, double x, double y, double w, double h, double width,
             struct rgb colour)
{
    add(c, (struct item){.kind = ITEM_FRAME,
                         .x = x - 0.5 * width,
                         .y = y - 0.5 * width,
                         .w = w + width,
                         .h = h + width,
                         .width = width,
                         .colour = colour});
}

void
canvas_clip(struct canvas *c, double x, double y, double w, double h)
{
    add(c, (struct item){.kind = ITEM_CLIP, .x = x, .y = y, .w = w > 0 ? w : 0, .h = h});
}

static void
add_point(struct canvas *c, double x, double y, bool begins)
{
    if (c->points == c->point_capacity) {
        size_t capacity = 64 + c->point_capacity + c->point_capacity / 4;
        struct item_point *path = realloc(c->path, capacity * sizeof *path);

        if (path == NULL) {
            c->short_of_memory = true;
            return;
        }
        c->path = path;
        c->point_capacity = capacity;
    }
    c->path[c->points++] = (struct item_point){x, y, begins};
}

void
canvas_move(struct canvas *c, double x, double y)
{
    add_point(c, x, y, true);
}

void
canvas_draw_to(struct canvas *c, double x, double y)
{
    add_point(c, x, y, c->points == 0);
}

void
canvas_line(struct canvas *c, double x0, double y0, double x1, double y1)
{
    canvas_move(c, x0, y0);
    canvas_draw_to(c, x1, y1);
}

/* Makes an item of the current path, which keeps no room for further points. */
static void
add_path(struct canvas *c, struct item item)
{
    struct item_point *exact;

    if (c->points == 0)
        return;
    exact = realloc(c->path, c->points * sizeof *exact);
    item.point = exact != NULL ? exact : c->path;
    item.points = c->points;
    c->path = NULL;
    c->points = c->point_capacity = 0;
    add(c, item);
}

void
canvas_stroke(struct canvas *c, double width, struct rgb colour)
{
    canvas_dashes(c, width, 0, colour);
}

void
canvas_dashes(struct canvas *c, double width, double dash, struct rgb colour)
{
    add_path(c, (struct item){.kind = ITEM_LINES, .width = width, .dash = dash, .colour = colour});
}

void
canvas_triangle(struct canvas *c, double corner[3][2], struct rgb colour)
{
    for (int k = 0; k < 3; k++)
        add_point(c, corner[k][0], corner[k][1], k == 0);
    add_path(c, (struct item){.kind = ITEM_POLYGON, .colour = colour});
}

/* ---- pixels ---- */

void
canvas_image(struct canvas *c, double x, double y, double w, double h, struct rgb *pixel,
             bool *inked, size_t nx, size_t ny)
{
    add(c, (struct item){.kind = ITEM_IMAGE,
                         .x = x,
                         .y = y,
                         .w = w,
                         .h = h,
                         .pixel = pixel,
                         .inked = inked,
                         .nx = nx,
                         .ny = ny});
    c->short_of_memory = c->short_of_memory || pixel == NULL;
}

enum rc_status
canvas_check(const struct canvas *c, struct rc_err *err)
{
    if (lettering_has_no_font(c->lettering))
        return rc_err_set(
            err,
            "no font was found: install one, such as DejaVu Sans, or add its folder to fontconfig");
    if (c->short_of_memory)
        return rc_err_set(err, "the figure cannot be drawn: out of memory");
    return RC_OK;
}

enum rc_status
canvas_row(struct canvas *c, size_t y, unsigned char *rgb, struct rc_err *err)
{
    const unsigned *row;

    if (canvas_check(c, err) != RC_OK || drawn_update(c, err) != RC_OK)
        return RC_FAIL;
    row = c->drawn + y * c->w;
    for (size_t x = 0; x < c->w; x++) {
        rgb[3 * x] = (unsigned char)(row[x] >> 16 & 0xff);
        rgb[3 * x + 1] = (unsigned char)(row[x] >> 8 & 0xff);
        rgb[3 * x + 2] = (unsigned char)(row[x] & 0xff);
    }
    return RC_OK;
}

/* ---- files ---- */

void
canvas_set_dpi(struct canvas *c, double dpi, bool pixels)
{
    c->dpi = dpi;
    c->screen = pixels;
}

enum canvas_format
canvas_format(const char *name)
{
    return strcmp(name, "svg") == 0   ? CANVAS_SVG
           : strcmp(name, "pdf") == 0 ? CANVAS_PDF
                                      : CANVAS_PNG;
}

static enum rc_status
next_row(void *ctx, size_t y, unsigned char *rgb, struct rc_err *err)
{
    return canvas_row(ctx, y, rgb, err);
}

enum rc_status
canvas_write(struct canvas *c, enum canvas_format format, const struct picture_text *text,
             size_t texts, FILE *file, struct rc_err *err)
{
    if (canvas_check(c, err) != RC_OK)
        return RC_FAIL;
    if (format == CANVAS_SVG)
        return svg_write(c, text, texts, file, err);
    if (format == CANVAS_PDF)
        return pdf_write(c, text, texts, file, err);
    return picture_write(file, c->w, c->h, c->dpi, text, texts, next_row, c, err);
}
