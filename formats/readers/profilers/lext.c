/*
 * Olympus LEXT (OLS4000): a TIFF with a page for each kind of picture. The description of the first page is
 * XML with the scales, in picometres; those of the other pages are their names. HEIGHT has the heights;
 * INVALID is 1 at missing points. A second XML text, in the Exif tag of device settings, may hold calibration
 * factors in millionths.
 */
#include <math.h>
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
    char quote[RC_SHOWN];

    for (size_t k = 0; k < SCALES; k++) {
        const char *end;
        if (strcmp(path, paths[k]) != 0 || *text == '\0')
            continue;
        end = rc_number_read(text, false, &l->scale[k]);
        if (end == NULL || *end != '\0')
            return rc_err_set(err, "%s is '%s': that is no number", strrchr(path, '/') + 1,
                              rc_word_shown(quote, text));
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

static enum rc_status
lext_open(struct lext *l, const struct rc_file *file, struct rc_err *err)
{
    *l = (struct lext){.tiff = rc_tiff_new(file, err)};
    if (l->tiff == NULL || read_scales(l, err) != RC_OK || find_pages(l, err) != RC_OK ||
        scale_of(l, PIXEL_X, &l->dx, err) != RC_OK || scale_of(l, PIXEL_Y, &l->dy, err) != RC_OK)
        return RC_FAIL;
    return scale_of(l, PIXEL_Z, &l->dz, err);
}

static struct rc_heights
heights_of(const struct lext *l)
{
    return (struct rc_heights){.nx = l->shape.nx,
                               .ny = l->shape.ny,
                               .dx = l->dx,
                               .dy = l->dy,
                               .metres = l->dz,
                               .unit = ""};
}

static size_t
list_channels(const struct rc_file *file, const struct rc_wish *wish, struct rc_channel *channel,
              size_t most, struct rc_err *err)
{
    struct lext l;
    size_t n = 0;

    (void)wish;
    if (lext_open(&l, file, err) == RC_OK) {
        n = 1;
        if (most > 0) {
            struct rc_heights h = heights_of(&l);
            *channel = rc_heights_channel(&h, "height");
        }
    }
    rc_tiff_free(l.tiff);
    return n;
}

/* ---- values ---- */

static enum rc_status
mask_invalid(struct lext *l, struct rc_grid *g, struct rc_notes *notes, struct rc_err *err)
{
    struct rc_shape shape = rc_grid_shape(g);
    struct rc_tiff_shape page;
    enum rc_status status = RC_FAIL;
    struct rc_grid *mask;

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
    if ((mask = rc_grid_new(&shape, "mask", "", err)) == NULL)
        return RC_FAIL;
    if (rc_tiff_values(l->tiff, &page, mask->v, err) == RC_OK) {
        for (size_t k = 0; k < g->nx * g->ny; k++)
            if (mask->v[k] != 0)
                g->v[k] = NAN;
        status = RC_OK;
    }
    rc_grid_free(mask);
    return status;
}

static struct rc_grid *
read_values(const struct rc_file *file, const struct rc_wish *wish, size_t index,
            struct rc_notes *notes, struct rc_err *err)
{
    struct rc_grid *g = NULL;
    struct rc_heights h;
    struct lext l;
    double metres;
    bool good = false;

    if (lext_open(&l, file, err) != RC_OK)
        goto done;
    if (index != 0) {
        rc_err_set(err, "a LEXT file has one channel of heights, not %zu", index + 1);
        goto done;
    }
    h = heights_of(&l);
    if ((g = rc_heights_new(&h, file, wish, &metres, notes, err)) == NULL ||
        rc_word_keep(g, "file.date", l.date, err) != RC_OK ||
        rc_word_keep(g, "file.version", l.program, err) != RC_OK ||
        rc_tiff_values(l.tiff, &l.shape, g->v, err) != RC_OK)
        goto done;
    for (size_t k = 0; k < g->nx * g->ny; k++)
        g->v[k] *= metres;
    good = mask_invalid(&l, g, notes, err) == RC_OK && rc_heights_finite(g, notes, err) == RC_OK;
done:
    rc_tiff_free(l.tiff);
    if (good)
        return g;
    rc_grid_free(g);
    return NULL;
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
    .list = list_channels,
    .read = read_values,
    .sandboxed = true,
};
