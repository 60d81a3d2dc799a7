/* Pictures as PNG: 8-bit sRGB, with the words that say how they were made. */
#ifndef RC_PNG_H
#define RC_PNG_H

#include <stddef.h>
#include <stdio.h>

#include "libcontact/grid.h"

struct picture; /* one being written, row by row */

struct picture_text {
    const char *keyword; /* "Title", "Software", ...: 1 to 79 characters of ASCII */
    const char *text;    /* UTF-8; NULL: left out                                 */
};

/* Starts a PNG of w by h pixels on `file`, which stays the caller's. No time is written: the same
 * picture is the same bytes. NULL when the size is more than PNG holds, the device refuses or
 * memory is short. */
struct picture *picture_new(FILE *file, size_t w, size_t h, const struct picture_text *text,
                            size_t texts, struct rc_err *err);
/* The next row, from the top: w times red, green, blue. */
enum rc_status picture_row(struct picture *picture, const unsigned char *rgb, struct rc_err *err);
/* After the last row: what ends the file. */
enum rc_status picture_end(struct picture *picture, struct rc_err *err);
void picture_free(struct picture *picture); /* NULL is allowed */

#endif
