/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The items of a canvas as SVG 1.1, one element each. Text stays text, in the family that it was
 * measured with; images are PNGs inside the file.
 */
#define _GNU_SOURCE /* open_memstream is in POSIX since 2008 */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "canvas_list.h"
#include "formats/core/core.h"

struct svg {
    FILE *file;
    struct canvas *c;
    size_t clips;
    bool clipped;
};

/* Thousandths of a pixel are precise enough. */
static const char *
number(char text[RC_NUMBER_SIZE], double value)
{
    double rounded = round(1e3 * value) / 1e3;

    return rc_number_text(text, rounded == 0 ? 0 : rounded);
}

static void
put_attribute(struct svg *s, const char *name, double value)
{
    char text[RC_NUMBER_SIZE];

    fprintf(s->file, " %s=\"%s\"", name, number(text, value));
}

static void
put_colour(struct svg *s, const char *name, struct rgb colour)
{
    fprintf(s->file, " %s=\"#%02x%02x%02x\"", name, colour.r, colour.g, colour.b);
}

static void
put_escaped(struct svg *s, const char *text)
{
    char c[RC_ENTITY];

    for (; *text != '\0'; text++)
        fputs(rc_xml_character(c, *text), s->file);
}

static void
put_rectangle(struct svg *s, const struct item *i)
{
    put_attribute(s, "x", i->x);
    put_attribute(s, "y", i->y);
    put_attribute(s, "width", i->w);
    put_attribute(s, "height", i->h);
}

/* ---- text ---- */

static void
put_pieces(struct svg *s, const struct item *i)
{
    double rise = LETTERING_RISE * i->font.size;
    bool raised, up = false;
    size_t at = 0;
    char *letters;

    while (lettering_piece(s->c->lettering, i->text, &at, &letters, &raised)) {
        if (raised || up) {
            fputs("<tspan", s->file);
            put_attribute(s, "dy", raised ? -rise : rise);
            if (raised)
                put_attribute(s, "font-size", LETTERING_RAISED * i->font.size);
            fputc('>', s->file);
            put_escaped(s, letters);
            fputs("</tspan>", s->file);
        } else {
            put_escaped(s, letters);
        }
        up = raised;
        free(letters);
    }
}

static void
put_text(struct svg *s, const struct item *i)
{
    bool middle = i->part == 0.5, end = i->part == 1;
    double before = middle || end ? 0 : i->part * i->length;
    char x[RC_NUMBER_SIZE], y[RC_NUMBER_SIZE];

    fputs("<text", s->file);
    if (i->upwards) {
        fprintf(s->file, " transform=\"translate(%s %s) rotate(-90)\"", number(x, i->x),
                number(y, i->y));
    } else {
        put_attribute(s, "x", i->x - before);
        put_attribute(s, "y", i->y);
    }
    put_attribute(s, "font-size", i->font.size);
    if (i->font.bold)
        fputs(" font-weight=\"bold\"", s->file);
    if (middle || end)
        fprintf(s->file, " text-anchor=\"%s\"", middle ? "middle" : "end");
    put_colour(s, "fill", i->font.colour);
    fputc('>', s->file);
    put_pieces(s, i);
    fputs("</text>\n", s->file);
}

/* ---- shapes ---- */

static void
put_lines(struct svg *s, const struct item *i)
{
    char x[RC_NUMBER_SIZE], y[RC_NUMBER_SIZE];

    fputs("<path d=\"", s->file);
    for (size_t k = 0; k < i->points; k++) {
        const struct item_point *p = &i->point[k];

        /* a line of length 0 is a dot because of its round ends */
        fprintf(s->file, "%s%s %s", p->begins ? "M" : "L", number(x, p->x), number(y, p->y));
    }
    if (i->kind == ITEM_POLYGON) {
        fputs("Z\"", s->file);
        put_colour(s, "fill", i->colour);
    } else {
        fputs("\" fill=\"none\" stroke-linejoin=\"round\"", s->file);
        put_colour(s, "stroke", i->colour);
        put_attribute(s, "stroke-width", i->width);
        if (i->dash > 0)
            put_attribute(s, "stroke-dasharray", i->dash);
        else
            fputs(" stroke-linecap=\"round\"", s->file);
    }
    fputs("/>\n", s->file);
}

static void
put_clip(struct svg *s, const struct item *i)
{
    if (s->clipped)
        fputs("</g>\n", s->file);
    s->clipped = i->w > 0;
    if (!s->clipped)
        return;
    fprintf(s->file, "<clipPath id=\"clip%zu\"><rect", ++s->clips);
    put_rectangle(s, i);
    fprintf(s->file, "/></clipPath>\n<g clip-path=\"url(#clip%zu)\">\n", s->clips);
}

/* ---- images ---- */

/* Some viewers smooth images although the file forbids it: if a pixel is enlarged to a block of many, only
 * its edge is smoothed. */
enum {
    SHARP = 1600, /* largest number of pixels a side for which this is done */
};

struct enlarged {
    const struct item *item;
    size_t times;
};

static enum rc_status
image_row(void *ctx, size_t y, unsigned char *rgb, struct rc_err *err)
{
    const struct enlarged *e = ctx;
    const struct rgb *row = e->item->pixel + y / e->times * e->item->nx;

    (void)err;
    for (size_t x = 0; x < e->times * e->item->nx; x++)
        memcpy(rgb + 3 * x, row + x / e->times, 3);
    return RC_OK;
}

static enum rc_status
put_image(struct svg *s, struct item *i, struct rc_err *err)
{
    char *png = NULL, four[5];
    size_t n = 0;
    FILE *memory = open_memstream(&png, &n);
    size_t larger = i->nx > i->ny ? i->nx : i->ny;
    struct enlarged e = {i, larger > 0 && larger < SHARP ? SHARP / larger : 1};
    enum rc_status status;

    if (memory == NULL)
        return rc_err_set(err, "out of memory for an image");
    status =
        picture_write(memory, e.times * i->nx, e.times * i->ny, 0, NULL, 0, image_row, &e, err);
    if (fclose(memory) != 0 && status == RC_OK)
        status = rc_err_set(err, "out of memory for an image");
    if (status == RC_OK) {
        fputs("<image", s->file);
        put_rectangle(s, i);
        fputs(" preserveAspectRatio=\"none\" image-rendering=\"optimizeSpeed\" "
              "style=\"image-rendering:crisp-edges;image-rendering:pixelated\" "
              "xlink:href=\"data:image/png;base64,",
              s->file);
        for (size_t k = 0; k < n; k += 3)
            fputs(rc_base64(four, (unsigned char *)png + k, n - k), s->file);
        fputs("\"/>\n", s->file);
    }
    free(png);
    return status;
}

/* An image with only some pixels set: a clip path selects these, row by row. */
static enum rc_status
put_dots(struct svg *s, struct item *i, struct rc_err *err)
{
    enum rc_status status;

    fprintf(s->file, "<clipPath id=\"clip%zu\"><path d=\"", ++s->clips);
    for (size_t y = 0; y < i->ny; y++)
        for (size_t x = 0, n; x < i->nx; x += n) {
            const bool *inked = i->inked + y * i->nx + x;

            for (n = 1; x + n < i->nx && inked[n] == inked[0];)
                n++;
            if (inked[0])
                fprintf(s->file, "M%.0f %.0fh%zuv1h-%zuz", i->x + (double)x, i->y + (double)y, n,
                        n);
        }
    fprintf(s->file, "\"/></clipPath>\n<g clip-path=\"url(#clip%zu)\">\n", s->clips);
    status = put_image(s, i, err);
    fputs("</g>\n", s->file);
    return status;
}

/* ---- the whole ---- */

static enum rc_status
put_item(struct svg *s, struct item *i, struct rc_err *err)
{
    switch (i->kind) {
    case ITEM_TEXT:
        put_text(s, i);
        break;
    case ITEM_FILL:
    case ITEM_FRAME:
        fputs("<rect", s->file);
        put_rectangle(s, i);
        if (i->kind == ITEM_FRAME) {
            fputs(" fill=\"none\"", s->file);
            put_attribute(s, "stroke-width", i->width);
        }
        put_colour(s, i->kind == ITEM_FRAME ? "stroke" : "fill", i->colour);
        fputs("/>\n", s->file);
        break;
    case ITEM_CLIP:
        put_clip(s, i);
        break;
    case ITEM_POLYGON:
    case ITEM_LINES:
        put_lines(s, i);
        break;
    case ITEM_IMAGE:
        return (i->inked != NULL ? put_dots : put_image)(s, i, err);
    }
    return RC_OK;
}

static void
put_head(struct svg *s, const struct picture_text *text, size_t texts)
{
    double mm = s->c->screen ? 1 : 25.4 / s->c->dpi;
    const char *unit = s->c->screen ? "" : "mm";
    char w[RC_NUMBER_SIZE], h[RC_NUMBER_SIZE];

    fprintf(s->file,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<svg xmlns=\"http://www.w3.org/2000/svg\" "
            "xmlns:xlink=\"http://www.w3.org/1999/xlink\" version=\"1.1\" "
            "width=\"%s%s\" height=\"%s%s\" viewBox=\"0 0 %zu %zu\" font-family=\"",
            number(w, mm * (double)s->c->w), unit, number(h, mm * (double)s->c->h), unit, s->c->w,
            s->c->h);
    put_escaped(s, lettering_family(s->c->lettering));
    fputs(", sans-serif\">\n", s->file);
    for (size_t k = 0; k < texts; k++) {
        bool title = strcmp(text[k].keyword, "Title") == 0;

        if (text[k].text == NULL || (!title && strcmp(text[k].keyword, "Description") != 0))
            continue;
        fprintf(s->file, "<%s>", title ? "title" : "desc");
        put_escaped(s, text[k].text);
        fprintf(s->file, "</%s>\n", title ? "title" : "desc");
    }
}

enum rc_status
svg_write(struct canvas *c, const struct picture_text *text, size_t texts, FILE *file,
          struct rc_err *err)
{
    struct svg s = {.file = file, .c = c};
    enum rc_status status = RC_OK;

    errno = 0;
    put_head(&s, text, texts);
    for (size_t k = 0; k < c->items && status == RC_OK; k++)
        status = put_item(&s, &c->item[k], err);
    if (s.clipped)
        fputs("</g>\n", file);
    fputs("</svg>\n", file);
    if (status == RC_OK && (fflush(file) != 0 || ferror(file)))
        return rc_err_set(err, "the SVG cannot be written: %s", strerror(errno));
    return status;
}
