/* TIFF in memory, for the instrument files that are one; the only place that knows libtiff. To be
 * used in the sandbox (sandbox.h): tags that say they are large make the library ask for so much
 * memory. */
#ifndef RC_TIFF_H
#define RC_TIFF_H

#include <stddef.h>
#include <stdint.h>

#include "formats/core/core.h"
#include "libcontact/grid.h"

enum {
    RC_TIFF_DESCRIPTION = 270,
    RC_TIFF_SOFTWARE = 305,
    RC_TIFF_DATE = 306,
};

struct rc_tiff;

/* Stands on the first page. The file's bytes must outlive it. */
struct rc_tiff *rc_tiff_new(const struct rc_file *file, struct rc_err *err);
void rc_tiff_free(struct rc_tiff *tiff); /* NULL is allowed */

/* The number of pages; RC_FAIL when one is damaged or leads nowhere. Afterwards the first page is
 * the current one. */
enum rc_status rc_tiff_pages(struct rc_tiff *tiff, size_t *pages, struct rc_err *err);
/* Goes to a page, from 0; false when there is none. */
bool rc_tiff_page(struct rc_tiff *tiff, size_t page);
/* Goes to the page that the Exif tag of this one points to. */
bool rc_tiff_exif(struct rc_tiff *tiff);

/* Of the page: bytes of a tag, which stay valid until the next page. Text may lack its NUL. */
bool rc_tiff_bytes(struct rc_tiff *tiff, uint32_t tag, const unsigned char **bytes, size_t *n);
/* A tag as cleaned text (text.h); "" when it is absent or no text. */
char *rc_tiff_text(struct rc_tiff *tiff, uint32_t tag, char *to, size_t size);
/* A tag's first number, whatever its type. */
bool rc_tiff_number(struct rc_tiff *tiff, uint32_t tag, double *value);

/* Pixels along x and y in the page's unit of resolution; false when it has none. */
bool rc_tiff_resolution(struct rc_tiff *tiff, double *x, double *y);

struct rc_tiff_shape {
    size_t nx, ny;
    unsigned samples, bits; /* of a pixel; of a sample */
    bool floats;
};
enum rc_status rc_tiff_shape(struct rc_tiff *tiff, struct rc_tiff_shape *shape, struct rc_err *err);
/* The first sample of every pixel, row 0 first: whole numbers of 1, 8, 16 or 32 bits, with or
 * without sign, or floats of 32 or 64, as the page says. */
enum rc_status rc_tiff_values(struct rc_tiff *tiff, const struct rc_tiff_shape *shape, double *v,
                              struct rc_err *err);

/* Whether it begins as a TIFF does. */
bool rc_tiff_is(const struct rc_file *file);
/* Whether the file holds, anywhere, the bytes of a directory entry for the tag, of this type: a
 * quick look for scores. */
bool rc_tiff_hints(const struct rc_file *file, uint16_t tag, uint16_t type);

#endif
