/*
 * TIFF of floats, one sample a pixel: a map a page, the first row on top. Programs that save heights so give
 * no unit; the spacing is that of ImageJ, whose description names the unit of the resolution,
 *
 *     ImageJ=1.54f
 *     unit=um
 *     vunit=nm           of the values, where they are calibrated
 *
 * Integer values are grey levels of a picture and are refused.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/format.h"

enum {
    DESCRIPTION = 2000
};

struct page {
    struct rc_tiff_shape shape;
    double dx, dy; /* m; NAN where the file does not say */
    char z_unit[16], name[32];
};

/* A line `key=value` of ImageJ's description; "" for none. */
static struct rc_piece
value_of(const char *description, const char *key)
{
    struct rc_lines lines = rc_piece_lines((struct rc_piece){description, strlen(description)});
    struct rc_piece line, name, value;

    while (rc_lines_next(&lines, &line.text, &line.n))
        if (rc_piece_part(line, "=", &name, &value) && rc_piece_is(name, key))
            return value;
    return (struct rc_piece){"", 0};
}

/* ImageJ writes the micro sign as an escape. */
static double
metres_of(struct rc_piece unit)
{
    return rc_piece_is(unit, "\\u00B5m") ? 1e-6 : rc_piece_metres(unit);
}

/* The description with its lines: rc_tiff_text would make one of them. */
static void
read_description(struct rc_tiff *t, char text[DESCRIPTION])
{
    const unsigned char *bytes;
    size_t n;

    text[0] = '\0';
    if (!rc_tiff_bytes(t, RC_TIFF_DESCRIPTION, &bytes, &n))
        return;
    n = n < DESCRIPTION - 1 ? n : DESCRIPTION - 1;
    memcpy(text, bytes, n);
    text[n] = '\0';
}

/* Describes the current page. */
static enum rc_status
read_page(struct rc_tiff *t, const char *description, size_t number, size_t pages, struct page *p,
          struct rc_err *err)
{
    struct rc_piece unit = value_of(description, "vunit");
    double metres = metres_of(value_of(description, "unit")), x, y;

    *p = (struct page){.dx = NAN, .dy = NAN};
    if (rc_tiff_shape(t, &p->shape, err) != RC_OK)
        return RC_FAIL;
    if (!p->shape.floats || p->shape.samples != 1)
        return rc_err_set(err,
                          "a TIFF with %u sample%s of %u bits a pixel%s: pictures without heights "
                          "are not read, heights are as one float of 32 or 64 bits a pixel",
                          p->shape.samples, p->shape.samples == 1 ? "" : "s", p->shape.bits,
                          p->shape.floats ? "" : ", whole numbers");
    rc_text_clean(p->z_unit, sizeof p->z_unit, unit.text, unit.n);
    if (strncmp(description, "ImageJ=", 7) == 0 && !isnan(metres) &&
        rc_tiff_resolution(t, &x, &y) && x > 0 && y > 0) {
        p->dx = metres / x;
        p->dy = metres / y;
    }
    if (pages > 1)
        snprintf(p->name, sizeof p->name, "page %zu", number + 1);
    return RC_OK;
}

static struct rc_heights
heights_of(const struct page *p)
{
    return (struct rc_heights){.nx = p->shape.nx,
                               .ny = p->shape.ny,
                               .dx = p->dx,
                               .dy = p->dy,
                               .metres = rc_word_metres(p->z_unit),
                               .unit = p->z_unit};
}

static size_t
list_channels(const struct rc_file *file, const struct rc_wish *wish, struct rc_channel *channel,
              size_t most, struct rc_err *err)
{
    char description[DESCRIPTION];
    struct rc_tiff *t = rc_tiff_new(file, err);
    size_t pages = 0, n = 0;
    struct page p;

    (void)wish;
    if (t == NULL || rc_tiff_pages(t, &pages, err) != RC_OK)
        pages = 0;
    else
        read_description(t, description);
    for (; n < pages && n < most; n++) {
        struct rc_heights h;

        if (!rc_tiff_page(t, n) ||
            read_page(t, description, n, pages, &p, n == 0 ? err : NULL) != RC_OK)
            break; /* further pages may be pictures */
        h = heights_of(&p);
        channel[n] = rc_heights_channel(&h, p.name[0] == '\0' ? "height" : p.name);
    }
    rc_tiff_free(t);
    return most == 0 ? pages : n;
}

static struct rc_grid *
read_values(const struct rc_file *file, const struct rc_wish *wish, size_t index,
            struct rc_notes *notes, struct rc_err *err)
{
    struct rc_tiff *t = rc_tiff_new(file, err);
    char description[DESCRIPTION], program[64];
    struct rc_grid *g = NULL;
    struct rc_heights h;
    struct page p;
    double metres;
    size_t pages;
    bool good = false;

    if (t == NULL || rc_tiff_pages(t, &pages, err) != RC_OK)
        goto done;
    read_description(t, description);
    rc_tiff_text(t, RC_TIFF_SOFTWARE, program, sizeof program);
    if (index >= pages || !rc_tiff_page(t, index)) {
        rc_err_set(err, "there is no channel %zu: the file has %zu pages", index + 1, pages);
        goto done;
    }
    if (read_page(t, description, index, pages, &p, err) != RC_OK)
        goto done;
    h = heights_of(&p);
    if ((g = rc_heights_new(&h, file, wish, &metres, notes, err)) == NULL ||
        rc_tiff_values(t, &p.shape, g->v, err) != RC_OK ||
        rc_word_keep(g, "file.version", program, err) != RC_OK ||
        rc_word_keep(g, "file.channel", p.name, err) != RC_OK)
        goto done;
    for (size_t k = 0; k < g->nx * g->ny; k++)
        g->v[k] *= metres;
    good = rc_heights_finite(g, notes, err) == RC_OK;
done:
    rc_tiff_free(t);
    if (good)
        return g;
    rc_grid_free(g);
    return NULL;
}

/* Any TIFF that no other format takes: to say why it is refused. */
const struct rc_format rc_format_tiff = {
    .name = "tiff",
    .suffixes = ".tif .tiff",
    .summary = "TIFF of floats, with the spacing of ImageJ",
    .is = rc_tiff_is,
    .sure = 4,
    .list = list_channels,
    .read = read_values,
    .sandboxed = true,
    .copies = true,
};
