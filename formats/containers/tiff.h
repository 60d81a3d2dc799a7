/* SPDX-License-Identifier: GPL-3.0-or-later */
/* TIFF in memory, for instrument files based on TIFF; only this file uses libtiff. Use it in the sandbox
 * (sandbox.h): tags with a large size make the library allocate this memory. */
#ifndef RC_TIFF_H
#define RC_TIFF_H

#include <stddef.h>
#include <stdint.h>

#include "formats/core/core.h"
#include "libcontact/owned.h"

enum {
    RC_TIFF_DESCRIPTION = 270,
    RC_TIFF_SOFTWARE = 305,
    RC_TIFF_DATE = 306,
};

struct rc_tiff;

/* Opens the file at the first page. The bytes of the file must outlive it. */
struct rc_tiff *rc_tiff_new(const struct rc_file *file, struct rc_err *err);
void rc_tiff_free(struct rc_tiff *tiff); /* NULL is allowed */
RC_OWNER(rc_tiff)

/* The number of pages; RC_FAIL if one is damaged or points outside of the file. Afterwards the first page is
 * the current one. */
enum rc_status rc_tiff_pages(struct rc_tiff *tiff, size_t *pages, struct rc_err *err);
/* Goes to a page, counted from 0; false if there is none. */
bool rc_tiff_page(struct rc_tiff *tiff, size_t page);
/* Goes to the page to which the Exif tag of this page points. */
bool rc_tiff_exif(struct rc_tiff *tiff);

/* The bytes of a tag of the page, valid until the next page. Text may lack its NUL. */
bool rc_tiff_bytes(struct rc_tiff *tiff, uint32_t tag, const unsigned char **bytes, size_t *n);
/* A tag as cleaned text (text.h); "" if it is absent or not text. */
char *rc_tiff_text(struct rc_tiff *tiff, uint32_t tag, char *to, size_t size);
/* The first number of a tag, of any type. */
bool rc_tiff_number(struct rc_tiff *tiff, uint32_t tag, double *value);

/* Pixels along x and y per unit of resolution; false if the page has none. */
bool rc_tiff_resolution(struct rc_tiff *tiff, double *x, double *y);

struct rc_tiff_shape {
    size_t nx, ny;
    unsigned samples, bits; /* samples of a pixel; bits of a sample */
    bool floats;
};
enum rc_status rc_tiff_shape(struct rc_tiff *tiff, struct rc_tiff_shape *shape, struct rc_err *err);
/* The first sample of every pixel, row 0 first. Samples are whole numbers of 1, 8, 16 or 32 bits, with or
 * without sign, or floats of 32 or 64 bits, according to the page. */
enum rc_status rc_tiff_values(struct rc_tiff *tiff, const struct rc_tiff_shape *shape, double *v,
                              struct rc_err *err);

/* True if it begins like a TIFF file. */
bool rc_tiff_is(const struct rc_file *file);
/* True if the file contains anywhere the bytes of a directory entry for this tag and type: a fast test for
 * scores. */
bool rc_tiff_hints(const struct rc_file *file, uint16_t tag, uint16_t type);

#endif
