/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Wyko (Veeco, Bruker) as text: `Wyko ASCII Data File Format 0`, two flags, then names and values between
 * tabs. Then come the blocks of an OPD file, one a line: name, type, length, value. The numbers of a
 * block of heights follow it, a column of the map in each line, the lowest first, as in the binary file:
 *
 *     Wyko ASCII Data File Format 0 <tab> 0 <tab> 1
 *     X Size <tab> 640
 *     Y Size <tab> 480
 *     Block Name <tab> Type <tab> Length <tab> Value
 *     Wavelength <tab> 7 <tab> 4 <tab> 632.8         nm
 *     Pixel_size <tab> 7 <tab> 4 <tab> 0.002         mm
 *     RAW_DATA <tab> 3 <tab> 1228800 <tab>
 *
 * Numbers are in units of the wavelength over Mult, or, where the first flag is 1, nanometres. `Bad` is
 * missing. Other files have a point a line instead, x and y in millimetres and z in nanometres, column by
 * column. The layout is the one that Gwyddion and SurfaceTopography read. Gwyddion multiplies by Mult since
 * a version between 2.50 and 2.71, in nanometres too. Before, it divided by Mult, as SurfaceTopography
 * does.
 */
#include <math.h>
#include <string.h>

#include "formats/format.h"

static const char magic[] = "Wyko ASCII Data File Format";

struct wyko {
    double nx, ny, wavelength, pixel, aspect, factor;
    bool nanometres;
    struct rc_lines heights; /* the lines after the line of their block */
};

static const struct rc_field fields[] = {
    {"X Size", RC_FIELD_NUMBER, offsetof(struct wyko, nx)},
    {"Y Size", RC_FIELD_NUMBER, offsetof(struct wyko, ny)},
    {"Wavelength", RC_FIELD_NUMBER, offsetof(struct wyko, wavelength)},
    {"Pixel_size", RC_FIELD_NUMBER, offsetof(struct wyko, pixel)},
    {"Aspect", RC_FIELD_NUMBER, offsetof(struct wyko, aspect)},
    {"Mult", RC_FIELD_NUMBER, offsetof(struct wyko, factor)},
};

static const struct rc_keep texts[] = {
    {"Title", "file.title"},
    {"Date", "file.date"},
    {"Time", "file.time"},
    {"Note", "file.comment"},
};

/* Reads up to the line of the heights. */
static enum rc_status
read_header(const struct rc_file *file, struct wyko *w, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_lines lines = rc_piece_lines(rc_file_piece(file));
    struct rc_piece line, key, value, rest;
    double flag;

    w->nanometres = rc_lines_next(&lines, &line.text, &line.n) &&
                    rc_piece_part(line, "\t", &key, &rest) && rc_piece_number(rest, &flag, NULL) &&
                    flag == 1;
    while (rc_lines_next(&lines, &line.text, &line.n)) {
        if (!rc_piece_part(line, "\t", &key, &value))
            continue;
        if (rc_piece_is(key, "RAW_DATA|RAW DATA|OPD|SAMPLE_DATA")) {
            w->heights = lines;
            return RC_OK;
        }
        /* a block: its type and length before its value */
        if (rc_piece_part(value, "\t", &line, &rest) && rc_piece_part(rest, "\t", &line, &value)) {
            rc_maps_keep(maps, texts, sizeof texts / sizeof *texts, key, value);
        } else if (!rc_piece_is(key, "X Size|Y Size"))
            continue;
        if (rc_field_take(fields, sizeof fields / sizeof *fields, key, value, w, err) != RC_OK)
            return RC_FAIL;
    }
    return rc_err_set(err, "the file has no block RAW_DATA, OPD or SAMPLE_DATA");
}

/* ---- points ---- */

/* The next line that is not empty. */
static bool
next_line(struct rc_lines *lines, struct rc_piece *line)
{
    while (rc_lines_next(lines, &line->text, &line->n))
        if ((*line = rc_piece_trim(*line)).n > 0)
            return true;
    return false;
}

static size_t
words_of(struct rc_piece line)
{
    size_t n = 0;

    for (size_t k = 0; k < line.n; k++)
        n += line.text[k] > ' ' && (k == 0 || line.text[k - 1] <= ' ');
    return n;
}

/* x and y in millimetres, and the number that is the height, NAN where it is Bad. */
static enum rc_status
next_point(struct rc_lines *lines, double point[3], struct rc_err *err)
{
    struct rc_piece line, rest;

    if (!next_line(lines, &line))
        return rc_err_set(err, "the file ends before its last point");
    point[2] = NAN;
    if (rc_piece_number(line, &point[0], &rest) && rc_piece_number(rest, &point[1], &rest) &&
        (rc_piece_is(rest, "Bad") || (rc_piece_number(rest, &point[2], &rest) && rest.n == 0)))
        return RC_OK;
    return rc_err_set(err, "line %zu is '%s': x, y and a height or 'Bad' are expected",
                      lines->number, rc_piece_shown(line));
}

static enum rc_status
fill_points(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    struct rc_lines lines = *(struct rc_lines *)map->opened;
    double point[3], x = NAN;

    (void)file;
    for (size_t k = 0; k < map->nx * map->ny; k++) {
        if (next_point(&lines, point, err) != RC_OK)
            return RC_FAIL;
        if ((point[0] == x) == (k % map->ny == 0))
            return rc_err_set(err, "line %zu is at x = %g: the %zu points of a column are at one x",
                              lines.number, point[0], map->ny);
        x = point[0];
        v[k] = point[2];
    }
    return RC_OK;
}

/* The start of the first column and of the second, and whether the first rises. */
static enum rc_status
set_points(struct wyko *w, struct rc_map *map, struct rc_err *err)
{
    struct rc_lines lines = w->heights;
    double first[3], point[3];

    if (next_point(&lines, first, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 1; k <= map->ny && map->nx * map->ny > k; k++) {
        if (next_point(&lines, point, err) != RC_OK)
            return RC_FAIL;
        if (k == 1 && map->ny > 1)
            map->bottom_first = point[1] > first[1];
        if (k == map->ny)
            map->right_first = point[0] < first[0];
    }
    map->fill = fill_points;
    if (!w->nanometres)
        map->doubt = "the first line says wavelengths, files of points that are known have "
                     "nanometres, which are taken: override with --z-unit";
    w->nanometres = true;
    return RC_OK;
}

static enum rc_status
wykotext_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct wyko w = {
        .nx = NAN, .ny = NAN, .wavelength = NAN, .pixel = NAN, .aspect = 1, .factor = 1};
    struct rc_lines *heights = rc_maps_open(maps, sizeof *heights, NULL, err), lines;
    struct rc_piece line = {"", 0};
    struct rc_map *map;
    size_t words;

    if (heights == NULL || read_header(file, &w, maps, err) != RC_OK)
        return RC_FAIL;
    map = rc_maps_add(maps, rc_piece_of(""));
    if (rc_map_size(map, w.nx, "X Size", w.ny, "Y Size", err) != RC_OK ||
        rc_map_is_text(map, file, (size_t)(w.heights.at - (const char *)file->data), err) != RC_OK)
        return RC_FAIL;
    map->by_columns = map->bottom_first = true;
    map->dx = w.pixel * 1e-3;
    map->dy = w.pixel * w.aspect * 1e-3;
    if (w.factor != 1)
        map->doubt =
            "Mult is not 1: heights in wavelengths are divided by it, as in OPD files, those in "
            "nanometres are not; other programs multiply by it: override with --z-unit";
    lines = *heights = w.heights;
    next_line(&lines, &line);
    words = words_of(line);
    if (words != map->ny && words != 3)
        return rc_err_set(err,
                          "line %zu has %zu numbers: it must have the %zu of Y Size, or be a point",
                          lines.number, words, map->ny);
    if (words != map->ny && set_points(&w, map, err) != RC_OK)
        return RC_FAIL;
    if (w.nanometres)
        w.wavelength = w.factor = 1;
    map->scale = (isnan(w.wavelength) ? 1 : w.wavelength) / w.factor;
    if (isnan(w.wavelength)) /* the numbers are in units of it: the user has to say it */
        return RC_OK;
    strcpy(map->unit, "m");
    map->si = 1e-9;
    return RC_OK;
}

const struct rc_format rc_format_wykotext = {
    .name = "wykotext",
    .suffixes = ".asc .txt",
    .summary = "Wyko (Veeco, Bruker) as text",
    .magic = {{magic, sizeof magic - 1}},
    .refusal = "no Wyko text: it does not begin with 'Wyko ASCII Data File Format'",
    .find = wykotext_find,
};
