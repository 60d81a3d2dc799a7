/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "png.h"

#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "libcontact/owned.h"

enum {
    FAST = 4000000 /* a PNG with more pixels is compressed fast, a smaller one well */
};

/* State of a PNG that is being written. */
struct picture {
    png_structp png;
    png_infop info;
    char why[256]; /* the last message of libpng */
};

static _Noreturn void
give_up(png_structp png, png_const_charp why)
{
    struct picture *p = png_get_error_ptr(png);

    snprintf(p->why, sizeof p->why, "%s", why);
    longjmp(png_jmpbuf(png), 1);
}

static void
ignore(png_structp png, png_const_charp why)
{
    (void)png;
    (void)why;
}

/* libpng's default function reports only "Write Error". */
static void
write_bytes(png_structp png, png_bytep bytes, size_t n)
{
    if (fwrite(bytes, 1, n, png_get_io_ptr(png)) != n)
        png_error(png, strerror(errno));
}

static void
flush_bytes(png_structp png)
{
    (void)png; /* the caller flushes the file */
}

static bool
is_ascii(const char *s)
{
    while (*s > 0)
        s++;
    return *s == '\0';
}

/* tEXt is Latin-1 by the standard. Text beyond ASCII goes into iTXt, which is UTF-8. libpng copies the texts,
 * although its pointers are not to const. */
static void
put_texts(struct picture *p, const struct picture_text *text, size_t texts)
{
    for (size_t k = 0; k < texts; k++) {
        png_text chunk = {.key = (char *)text[k].keyword, .text = (char *)text[k].text};

        if (text[k].text == NULL)
            continue;
        chunk.compression =
            is_ascii(text[k].text) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
        png_set_text(p->png, p->info, &chunk, 1);
    }
}

/* The part between creation and release; a failure of libpng ends in setjmp. */
static enum rc_status
write_rows(struct picture *p, FILE *file, size_t w, size_t h, double dpi,
           const struct picture_text *text, size_t texts, picture_row *row, void *ctx,
           unsigned char *rgb, struct rc_err *err)
{
    if (setjmp(png_jmpbuf(p->png)) != 0)
        return rc_err_set(err, "the PNG cannot be written: %s", p->why);
    png_set_write_fn(p->png, file, write_bytes, flush_bytes);
    png_set_user_limits(p->png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(p->png, p->info, (png_uint_32)w, (png_uint_32)h, 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (w > FAST / h) { /* rows of a map are similar to the rows above them */
        png_set_compression_strategy(p->png, Z_RLE);
        png_set_compression_level(p->png, 1);
        png_set_filter(p->png, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
    }
    png_set_sRGB(p->png, p->info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (dpi > 0) {
        png_uint_32 a_metre = (png_uint_32)(dpi / 0.0254 + 0.5);

        png_set_pHYs(p->png, p->info, a_metre, a_metre, PNG_RESOLUTION_METER);
    }
    put_texts(p, text, texts);
    png_write_info(p->png, p->info);
    for (size_t y = 0; y < h; y++) {
        if (row(ctx, y, rgb, err) != RC_OK)
            return RC_FAIL;
        png_write_row(p->png, rgb);
    }
    png_write_end(p->png, NULL);
    return RC_OK;
}

enum rc_status
picture_write(FILE *file, size_t w, size_t h, double dpi, const struct picture_text *text,
              size_t texts, picture_row *row, void *ctx, struct rc_err *err)
{
    struct picture p = {.png = NULL};
    RC_OWNED unsigned char *rgb = NULL;
    enum rc_status status;

    if (w > PNG_UINT_31_MAX || h > PNG_UINT_31_MAX || w > SIZE_MAX / 8)
        return rc_err_set(
            err, "a picture of %zu by %zu pixels: PNG allows at most 2147483647 a side", w, h);
    if ((rgb = malloc(3 * w)) == NULL)
        return rc_err_set(err, "out of memory for a picture of %zu pixels a row", w);
    p.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &p, give_up, ignore);
    if (p.png == NULL || (p.info = png_create_info_struct(p.png)) == NULL)
        status = rc_err_set(err, "out of memory for a PNG");
    else
        status = write_rows(&p, file, w, h, dpi, text, texts, row, ctx, rgb, err);
    png_destroy_write_struct(&p.png, &p.info);
    return status;
}
