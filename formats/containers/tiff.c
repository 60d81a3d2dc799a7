/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tiff.h"

#include <stdlib.h>
#include <string.h>
#include <tiffio.h>

#include "formats/core/core.h"

enum {
    PAGES_MOST = 1024,
    EXIF = 34665,
};

struct rc_tiff {
    TIFF *tiff;
    const unsigned char *data;
    size_t size;
    toff_t at; /* the position set by libtiff; it may be beyond the end */
};

/* ---- a file in memory, for libtiff ---- */

static tmsize_t
read_some(thandle_t handle, void *to, tmsize_t n)
{
    struct rc_tiff *t = handle;
    size_t wanted = n < 0 ? 0 : (size_t)n, there = t->at < t->size ? t->size - (size_t)t->at : 0;

    if (wanted > there)
        wanted = there;
    memcpy(to, t->data + (wanted > 0 ? (size_t)t->at : 0), wanted);
    t->at += wanted;
    return (tmsize_t)wanted;
}

static tmsize_t
write_none(thandle_t handle, void *from, tmsize_t n)
{
    (void)handle, (void)from, (void)n;
    return 0;
}

static toff_t
seek(thandle_t handle, toff_t offset, int whence)
{
    struct rc_tiff *t = handle;

    t->at = whence == SEEK_SET ? offset : whence == SEEK_CUR ? t->at + offset : t->size + offset;
    return t->at;
}

static int
close_nothing(thandle_t handle)
{
    (void)handle;
    return 0;
}

static toff_t
size_of(thandle_t handle)
{
    return ((struct rc_tiff *)handle)->size;
}

struct rc_tiff *
rc_tiff_new(const struct rc_file *file, struct rc_err *err)
{
    RC_OWNED struct rc_tiff *t = calloc(1, sizeof *t);

    if (t == NULL)
        return rc_err_null(err, "out of memory for reading a TIFF");
    TIFFSetErrorHandler(NULL); /* errors are reported here, not by the library */
    TIFFSetWarningHandler(NULL);
    t->data = file->data;
    t->size = file->size;
    t->tiff = TIFFClientOpen("file", "rm", t, read_some, write_none, seek, close_nothing, size_of,
                             NULL, NULL);
    if (t->tiff == NULL)
        return rc_err_null(err, "no TIFF, or a damaged one: its first page cannot be read");
    return rc_give(&t);
}

void
rc_tiff_free(struct rc_tiff *t)
{
    if (t == NULL)
        return;
    TIFFClose(t->tiff);
    free(t);
}

enum rc_status
rc_tiff_pages(struct rc_tiff *t, size_t *pages, struct rc_err *err)
{
    for (*pages = 1; !TIFFLastDirectory(t->tiff); ++*pages)
        if (*pages == PAGES_MOST || TIFFReadDirectory(t->tiff) != 1)
            return rc_err_set(
                err, "page %zu (from 0) is damaged or cut off, or there is no end to the pages",
                *pages);
    return rc_tiff_page(t, 0) ? RC_OK : rc_err_set(err, "the first page cannot be read");
}

bool
rc_tiff_page(struct rc_tiff *t, size_t page)
{
    return page < PAGES_MOST && TIFFSetDirectory(t->tiff, (tdir_t)page) == 1;
}

bool
rc_tiff_exif(struct rc_tiff *t)
{
    toff_t at = 0;

    return TIFFGetField(t->tiff, EXIF, &at) == 1 && TIFFReadEXIFDirectory(t->tiff, at) == 1;
}

/* ---- tags ---- */

/* Reads the bytes of a tag that is not in libtiff's table, which then returns a count and an array. */
static bool
private_tag(struct rc_tiff *t, const TIFFField *field, const void **bytes, size_t *count)
{
    uint32_t wide = 0;
    uint16_t narrow = 0;
    void *at = NULL;
    int got;

    if (!TIFFFieldPassCount(field))
        return false;
    if (TIFFFieldReadCount(field) == TIFF_VARIABLE2) {
        got = TIFFGetField(t->tiff, TIFFFieldTag(field), &wide, &at);
    } else {
        got = TIFFGetField(t->tiff, TIFFFieldTag(field), &narrow, &at);
        wide = narrow;
    }
    *bytes = at;
    *count = wide;
    return got == 1 && at != NULL;
}

bool
rc_tiff_bytes(struct rc_tiff *t, uint32_t tag, const unsigned char **bytes, size_t *n)
{
    const TIFFField *field = TIFFFindField(t->tiff, tag, TIFF_ANY);
    const void *at = NULL;
    const char *text = NULL;

    if (field == NULL)
        return false;
    if (private_tag(t, field, &at, n)) {
        *bytes = at;
        *n *= (size_t)TIFFDataWidth(TIFFFieldDataType(field));
        return true;
    }
    if (TIFFFieldPassCount(field) || TIFFFieldDataType(field) != TIFF_ASCII ||
        TIFFGetField(t->tiff, tag, &text) != 1 || text == NULL)
        return false;
    *bytes = (const unsigned char *)text;
    *n = strlen(text);
    return true;
}

char *
rc_tiff_text(struct rc_tiff *t, uint32_t tag, char *to, size_t size)
{
    const TIFFField *field = TIFFFindField(t->tiff, tag, TIFF_ANY);
    const unsigned char *bytes;
    const char *end;
    size_t n;

    to[0] = '\0';
    if (field == NULL || TIFFFieldDataType(field) != TIFF_ASCII ||
        !rc_tiff_bytes(t, tag, &bytes, &n))
        return to;
    end = memchr(bytes, '\0', n);
    return rc_text_clean(to, size, (const char *)bytes,
                         end == NULL ? n : (size_t)(end - (const char *)bytes));
}

/* Number k of an array in the byte order of this machine. */
static double
own_number(const void *at, size_t k, enum rc_raw raw)
{
    static const uint16_t one = 1;
    struct rc_bytes b = {
        .data = at, .size = (k + 1) * rc_raw_width(raw), .big = *(const unsigned char *)&one == 0};

    return rc_bytes_at(&b, k * rc_raw_width(raw), raw);
}

bool
rc_tiff_number(struct rc_tiff *t, uint32_t tag, double *value)
{
    static const struct {
        TIFFDataType type;
        enum rc_raw raw; /* as libtiff returns them: rational numbers are floats */
    } types[] = {
        {TIFF_BYTE, RC_RAW_U8},    {TIFF_SHORT, RC_RAW_U16},    {TIFF_SSHORT, RC_RAW_I16},
        {TIFF_LONG, RC_RAW_U32},   {TIFF_SLONG, RC_RAW_I32},    {TIFF_FLOAT, RC_RAW_F32},
        {TIFF_DOUBLE, RC_RAW_F64}, {TIFF_RATIONAL, RC_RAW_F32}, {TIFF_SRATIONAL, RC_RAW_F32},
    };
    const TIFFField *field = TIFFFindField(t->tiff, tag, TIFF_ANY);
    const void *at;
    size_t count;

    if (field == NULL || !private_tag(t, field, &at, &count) || count == 0)
        return false;
    for (size_t k = 0; k < sizeof types / sizeof *types; k++)
        if (TIFFFieldDataType(field) == types[k].type) {
            *value = own_number(at, 0, types[k].raw);
            return true;
        }
    return false;
}

bool
rc_tiff_resolution(struct rc_tiff *t, double *x, double *y)
{
    float across = 0, down = 0;

    if (TIFFGetField(t->tiff, TIFFTAG_XRESOLUTION, &across) != 1 ||
        TIFFGetField(t->tiff, TIFFTAG_YRESOLUTION, &down) != 1)
        return false;
    *x = (double)across;
    *y = (double)down;
    return true;
}

/* ---- pixels ---- */

enum rc_status
rc_tiff_shape(struct rc_tiff *t, struct rc_tiff_shape *shape, struct rc_err *err)
{
    uint32_t nx = 0, ny = 0;
    uint16_t samples = 1, bits = 1, kind = SAMPLEFORMAT_UINT;

    TIFFGetFieldDefaulted(t->tiff, TIFFTAG_IMAGEWIDTH, &nx);
    TIFFGetFieldDefaulted(t->tiff, TIFFTAG_IMAGELENGTH, &ny);
    TIFFGetFieldDefaulted(t->tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
    TIFFGetFieldDefaulted(t->tiff, TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetFieldDefaulted(t->tiff, TIFFTAG_SAMPLEFORMAT, &kind);
    *shape = (struct rc_tiff_shape){nx, ny, samples, bits, kind == SAMPLEFORMAT_IEEEFP};
    if (nx == 0 || ny == 0)
        return rc_err_set(err, "a page of %zu x %zu pixels is empty", shape->nx, shape->ny);
    if (bits != 1 && bits != 8 && bits != 16 && bits != 32 && !(bits == 64 && shape->floats))
        return rc_err_set(err, "a page with %u bits a sample: only 1, 8, 16 and 32 are read",
                          (unsigned)bits);
    return RC_OK;
}

/* The type of the samples of more than one bit. */
static enum rc_raw
raw_of(unsigned bits, unsigned kind)
{
    if (kind == SAMPLEFORMAT_IEEEFP)
        return bits == 64 ? RC_RAW_F64 : RC_RAW_F32;
    if (kind == SAMPLEFORMAT_INT)
        return bits == 8 ? RC_RAW_I8 : bits == 16 ? RC_RAW_I16 : RC_RAW_I32;
    return bits == 8 ? RC_RAW_U8 : bits == 16 ? RC_RAW_U16 : RC_RAW_U32;
}

enum rc_status
rc_tiff_values(struct rc_tiff *t, const struct rc_tiff_shape *shape, double *v, struct rc_err *err)
{
    uint16_t planar = PLANARCONFIG_CONTIG, kind = SAMPLEFORMAT_UINT;
    RC_OWNED unsigned char *row = NULL;
    tmsize_t size = TIFFScanlineSize(t->tiff);
    size_t stride, least;

    TIFFGetFieldDefaulted(t->tiff, TIFFTAG_PLANARCONFIG, &planar);
    TIFFGetFieldDefaulted(t->tiff, TIFFTAG_SAMPLEFORMAT, &kind);
    if (TIFFIsTiled(t->tiff))
        return rc_err_set(err, "the page has tiles, and only pages with strips are read");
    if (kind == SAMPLEFORMAT_IEEEFP && shape->bits != 32 && shape->bits != 64)
        return rc_err_set(err, "floats of %u bits: only floats of 32 and 64 bits are read",
                          shape->bits);
    stride = planar == PLANARCONFIG_CONTIG ? shape->samples : 1;
    least = (shape->nx * stride * shape->bits + 7) / 8;
    if (size <= 0 || (size_t)size < least)
        return rc_err_set(err, "rows of %zu bytes for %zu pixels of %u x %u bits", (size_t)size,
                          shape->nx, shape->samples, shape->bits);
    if ((row = malloc((size_t)size)) == NULL)
        return rc_err_set(err, "out of memory for a row of %zu pixels", shape->nx);
    for (size_t j = 0; j < shape->ny; j++) {
        if (TIFFReadScanline(t->tiff, row, (uint32_t)j, 0) != 1)
            return rc_err_set(
                err, "row %zu of %zu (from 0) cannot be unpacked: the file is damaged or cut off",
                j, shape->ny);
        for (size_t i = 0; i < shape->nx; i++)
            v[j * shape->nx + i] = shape->bits == 1
                                       ? row[i * stride / 8] >> (7 - i * stride % 8) & 1
                                       : own_number(row, i * stride, raw_of(shape->bits, kind));
    }
    return RC_OK;
}

/* ---- a quick look ---- */

bool
rc_tiff_is(const struct rc_file *file)
{
    return file->size >= 8 &&
           (rc_file_holds(file, 0, "II\x2a\0", 4) || rc_file_holds(file, 0, "MM\0\x2a", 4));
}

bool
rc_tiff_hints(const struct rc_file *file, uint16_t tag, uint16_t type)
{
    bool big = file->data[0] == 'M';
    unsigned char entry[4] = {(unsigned char)(big ? tag >> 8 : tag & 0xff),
                              (unsigned char)(big ? tag & 0xff : tag >> 8),
                              (unsigned char)(big ? type >> 8 : type & 0xff),
                              (unsigned char)(big ? type & 0xff : type >> 8)};

    for (size_t k = 8; k + 12 <= file->size; k += 2) /* directories begin at even positions */
        if (file->data[k] == entry[0] && memcmp(file->data + k, entry, sizeof entry) == 0)
            return true;
    return false;
}
