/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * TIFF of floats has one sample a pixel and a map a page, with the first row on top. Programs that save
 * heights so give no unit; the spacing is that of ImageJ, whose description names the unit of the resolution,
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

static void
close_tiff(void *opened)
{
    rc_tiff_free(*(struct rc_tiff **)opened);
}

static enum rc_status
fill_page(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    struct rc_tiff *t = *(struct rc_tiff **)map->opened;
    struct rc_tiff_shape shape;

    (void)file;
    if (!rc_tiff_page(t, map->more))
        return rc_err_set(err, "page %zu cannot be read again", map->more);
    return rc_tiff_shape(t, &shape, err) == RC_OK ? rc_tiff_values(t, &shape, v, err) : RC_FAIL;
}

/* Adds the current page. */
static enum rc_status
add_page(struct rc_tiff *t, const char *description, size_t number, size_t pages,
         struct rc_maps *maps, struct rc_err *err)
{
    double metres = metres_of(value_of(description, "unit")), x, y;
    struct rc_tiff_shape shape;
    struct rc_map *map;
    char name[32] = "";

    if (rc_tiff_shape(t, &shape, err) != RC_OK)
        return RC_FAIL;
    if (!shape.floats || shape.samples != 1)
        return rc_err_set(err,
                          "a TIFF with %u sample%s of %u bits a pixel%s: pictures without heights "
                          "are not read, heights are as one float of 32 or 64 bits a pixel",
                          shape.samples, shape.samples == 1 ? "" : "s", shape.bits,
                          shape.floats ? "" : ", whole numbers");
    if (pages > 1)
        snprintf(name, sizeof name, "page %zu", number + 1);
    map = rc_maps_add(maps, rc_piece_of(name));
    map->nx = shape.nx;
    map->ny = shape.ny;
    map->heights = true;
    map->fill = fill_page;
    map->more = number;
    rc_map_unit(map, value_of(description, "vunit"));
    if (strncmp(description, "ImageJ=", 7) == 0 && !isnan(metres) &&
        rc_tiff_resolution(t, &x, &y) && x > 0 && y > 0) {
        map->dx = metres / x;
        map->dy = metres / y;
    }
    return RC_OK;
}

static enum rc_status
tiff_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    char description[DESCRIPTION], program[64];
    struct rc_tiff **opened = rc_maps_open(maps, sizeof(struct rc_tiff *), close_tiff, err);
    struct rc_tiff *t = opened == NULL ? NULL : (*opened = rc_tiff_new(file, err));
    size_t pages;

    if (t != NULL && rc_tiff_pages(t, &pages, err) == RC_OK) {
        read_description(t, description);
        rc_tiff_text(t, RC_TIFF_SOFTWARE, program, sizeof program);
        rc_maps_key(maps, "file.version", rc_piece_of(program));
        while (maps->n < pages && rc_tiff_page(t, maps->n) &&
               add_page(t, description, maps->n, pages, maps, maps->n == 0 ? err : NULL) == RC_OK)
            ; /* pages after the heights may be pictures */
    }
    return maps->n > 0 ? RC_OK : RC_FAIL;
}

/* Any TIFF that no other format takes: to say why it is refused. */
const struct rc_format rc_format_tiff = {
    .name = "tiff",
    .suffixes = ".tif .tiff",
    .summary = "TIFF of floats, with the spacing of ImageJ",
    .is = rc_tiff_is,
    .sure = 4,
    .find = tiff_find,
    .sandboxed = true,
    .copies = true,
};
