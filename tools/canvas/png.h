/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures as PNG: 8-bit sRGB, with texts that describe how they were made. */
#ifndef RC_PNG_H
#define RC_PNG_H

#include <stddef.h>
#include <stdio.h>

#include "libcontact/grid.h"

struct picture_text {
    const char *keyword; /* "Title", "Software", ...: 1 to 79 characters of ASCII */
    const char *text;    /* UTF-8; NULL: left out                                 */
};

/* Returns row y, from the top, as width times red, green, blue. */
typedef enum rc_status picture_row(void *ctx, size_t y, unsigned char *rgb, struct rc_err *err);

/* Writes a PNG of w by h pixels, with dpi pixels per inch (0: unknown), to `file`, which the caller keeps. No
 * time is written: the same picture gives the same bytes. RC_FAIL when PNG cannot hold the size, a row fails,
 * writing fails or memory is short. */
enum rc_status picture_write(FILE *file, size_t w, size_t h, double dpi,
                             const struct picture_text *text, size_t texts, picture_row *row,
                             void *ctx, struct rc_err *err);

#endif
