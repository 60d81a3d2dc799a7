/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Olympus LEXT (OLS4000) is a TIFF with a page for each kind of picture. The description of the first page is
 * XML with the scales, in picometres; those of the other pages are their names. HEIGHT has the heights;
 * INVALID is 1 at missing points. A second XML text, in the Exif tag of device settings, may hold calibration
 * factors in millionths.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/format.h"

enum {
    DEVICE_SETTINGS = 0xa40b,
    WORD = 64,
};

enum scale {
    PIXEL_X,
    PIXEL_Y,
    PIXEL_Z,
    FACTOR_X,
    FACTOR_Y,
    FACTOR_Z,
    SCALES
};

static const char *const paths[SCALES] = {
    "TiffTagDescData/HeightInfo/HeightDataPerPixelX",
    "TiffTagDescData/HeightInfo/HeightDataPerPixelY",
    "TiffTagDescData/HeightInfo/HeightDataPerPixelZ",
    "ExifTagDescData/ImageCommonSettingsInfo/MakerCalibrationValueX",
    "ExifTagDescData/ImageCommonSettingsInfo/MakerCalibrationValueY",
    "ExifTagDescData/ImageCommonSettingsInfo/MakerCalibrationValueZ",
};

static const char magic[] = "<TiffTagDescData";

struct lext {
    struct rc_tiff *tiff;
    double scale[SCALES];   /* NAN: not there */
    size_t height, invalid; /* pages; 0: none */
    struct rc_tiff_shape shape;
    double dx, dy, dz; /* m */
    char date[WORD], program[WORD];
};

/* ---- XML ---- */

static enum rc_status
take_element(void *arg, const char *path, const char *text, struct rc_err *err)
{
    struct lext *l = arg;

    for (size_t k = 0; k < SCALES; k++) {
        const char *end;
        if (strcmp(path, paths[k]) != 0 || *text == '\0')
            continue;
        end = rc_number_read(text, false, &l->scale[k]);
        if (end == NULL || *end != '\0')
            return rc_err_set(err, "%s is '%s': that is not a number", strrchr(path, '/') + 1,
                              rc_word_shown(text));
    }
    return RC_OK;
}

/* The document that begins at the first '<' of a tag's bytes. */
static enum rc_status
read_xml(struct lext *l, const char *name, const unsigned char *bytes, size_t n, struct rc_err *err)
{
    const unsigned char *end = memchr(bytes, '\0', n), *start;

    n = end == NULL ? n : (size_t)(end - bytes);
    start = memchr(bytes, '<', n);
    if (start == NULL)
        return rc_err_set(err, "%s has no XML", name);
    n -= (size_t)(start - bytes);
    while (n > 0 && start[n - 1] != '>') /* the bytes after the document are padding */
        n--;
    return rc_xml_read(name, start, n, take_element, l, err);
}

static enum rc_status
read_scales(struct lext *l, struct rc_err *err)
{
    const unsigned char *bytes;
    size_t n;

    for (size_t k = 0; k < SCALES; k++)
        l->scale[k] = NAN;
    if (!rc_tiff_bytes(l->tiff, RC_TIFF_DESCRIPTION, &bytes, &n) || n < sizeof magic ||
        memcmp(bytes, "<", 1) != 0)
        return rc_err_set(err, "a TIFF, but no LEXT: its first page has no description in XML");
    if (read_xml(l, "the description of the first page", bytes, n, err) != RC_OK)
        return RC_FAIL;
    rc_tiff_text(l->tiff, RC_TIFF_DATE, l->date, sizeof l->date);
    rc_tiff_text(l->tiff, RC_TIFF_SOFTWARE, l->program, sizeof l->program);
    if (rc_tiff_exif(l->tiff) && rc_tiff_bytes(l->tiff, DEVICE_SETTINGS, &bytes, &n) &&
        memchr(bytes, '<', n) != NULL)
        return read_xml(l, "the Exif device settings", bytes, n, err);
    return RC_OK;
}

/* Metres of a step along one axis. */
static enum rc_status
scale_of(const struct lext *l, enum scale axis, double *metres, struct rc_err *err)
{
    double factor = l->scale[axis + FACTOR_X];

    if (isnan(l->scale[axis]))
        return rc_err_set(err, "the description gives no %s", strrchr(paths[axis], '/') + 1);
    *metres = l->scale[axis] / 1e12 * (isnan(factor) ? 1 : factor / 1e6);
    return RC_OK;
}

/* ---- pages ---- */

static enum rc_status
find_pages(struct lext *l, struct rc_err *err)
{
    struct rc_piece name;
    char text[WORD];
    size_t pages;

    if (!rc_tiff_page(l->tiff, 0)) /* after the Exif data */
        return rc_err_set(err, "the first page cannot be read again");
    if (rc_tiff_pages(l->tiff, &pages, err) != RC_OK)
        return RC_FAIL;
    for (size_t page = 1; page < pages; page++) {
        if (!rc_tiff_page(l->tiff, page))
            continue;
        rc_tiff_text(l->tiff, RC_TIFF_DESCRIPTION, text, sizeof text);
        name = (struct rc_piece){text, strlen(text)};
        if (l->height == 0 && rc_piece_is(name, "HEIGHT"))
            l->height = page;
        if (l->invalid == 0 && rc_piece_is(name, "INVALID"))
            l->invalid = page;
    }
    if (l->height == 0)
        return rc_err_set(err, "the file has only pictures, no page HEIGHT");
    if (!rc_tiff_page(l->tiff, l->height))
        return rc_err_set(err, "the page HEIGHT cannot be read");
    return rc_tiff_shape(l->tiff, &l->shape, err);
}

static void
lext_close(void *opened)
{
    rc_tiff_free(((struct lext *)opened)->tiff);
}

static enum rc_status
lext_open(struct lext *l, const struct rc_file *file, struct rc_err *err)
{
    if ((l->tiff = rc_tiff_new(file, err)) == NULL || read_scales(l, err) != RC_OK ||
        find_pages(l, err) != RC_OK || scale_of(l, PIXEL_X, &l->dx, err) != RC_OK ||
        scale_of(l, PIXEL_Y, &l->dy, err) != RC_OK)
        return RC_FAIL;
    return scale_of(l, PIXEL_Z, &l->dz, err);
}

/* ---- values ---- */

static enum rc_status
mask_invalid(struct lext *l, double *v, struct rc_notes *notes, struct rc_err *err)
{
    size_t n = l->shape.nx * l->shape.ny;
    struct rc_tiff_shape page;
    enum rc_status status;
    RC_OWNED double *mask = NULL;

    if (l->invalid == 0)
        return RC_OK;
    if (!rc_tiff_page(l->tiff, l->invalid) || rc_tiff_shape(l->tiff, &page, err) != RC_OK)
        return rc_err_set(err, "the page INVALID cannot be read");
    if (page.nx != l->shape.nx || page.ny != l->shape.ny) {
        rc_note(notes,
                "the page INVALID has %zu x %zu pixels, other than the heights: it is ignored",
                page.nx, page.ny);
        return RC_OK;
    }
    if ((mask = malloc(n * sizeof *mask)) == NULL)
        return rc_err_set(err, "out of memory for %zu marks of missing points", n);
    status = rc_tiff_values(l->tiff, &page, mask, err);
    for (size_t k = 0; status == RC_OK && k < n; k++)
        if (mask[k] != 0)
            v[k] = NAN;
    return status;
}

static enum rc_status
fill_heights(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    struct lext *l = map->opened;

    (void)file;
    if (!rc_tiff_page(l->tiff, l->height))
        return rc_err_set(err, "the page HEIGHT cannot be read");
    return rc_tiff_values(l->tiff, &l->shape, v, err) == RC_OK ? mask_invalid(l, v, map->notes, err)
                                                               : RC_FAIL;
}

static enum rc_status
lext_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_map *map = rc_maps_add(maps, rc_piece_of("height"));
    struct lext *l = rc_maps_open(maps, sizeof *l, lext_close, err);

    if (l == NULL || lext_open(l, file, err) != RC_OK)
        return RC_FAIL;
    map->nx = l->shape.nx;
    map->ny = l->shape.ny;
    map->dx = l->dx;
    map->dy = l->dy;
    strcpy(map->unit, "m");
    map->si = l->dz;
    map->fill = fill_heights;
    rc_maps_key(maps, "file.date", rc_piece_of(l->date));
    rc_maps_key(maps, "file.version", rc_piece_of(l->program));
    return RC_OK;
}

/* ---- the entry in formats.list ---- */

static int
lext_score(const struct rc_file *file)
{
    return rc_tiff_is(file) && rc_piece_find(rc_file_piece(file), magic) != NULL ? 90 : 0;
}

const struct rc_format rc_format_lext = {
    .name = "lext",
    .suffixes = ".lext",
    .summary = "Olympus LEXT (OLS4000)",
    .score = lext_score,
    .find = lext_find,
    .sandboxed = true,
};
