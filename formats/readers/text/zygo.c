/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Zygo as text: `Zygo XYZ Data File - Format 1` and `Zygo ASCII Data File - Format 2`. A header whose
 * lines have their meaning by their number, up to a line `#`:
 *
 *     2    software, version, "date"
 *     4    of the phases: first column, first row, columns, rows
 *     5    "comment"
 *     8    source, interferometric scale factor S, wavelength (m), aperture, obliquity factor O,
 *          magnification, size of a pixel (m; 0: not calibrated), time
 *     11   phase resolution, ...
 *
 * Format 1: then lines of column, row and micrometres, or `No Data`, up to `#`. Format 2: intensities up to
 * `#`, and phases up to `#`, row by row. Phases are whole numbers of S O wavelength / R, where R is 4096,
 * 32768 or 131072 by the phase resolution. They are missing from 2147483640 on. The first row is the top
 * one, as in MetroPro's binary files.
 *
 * Written after other programs that read and write such files (prysm and others).
 */
#include <math.h>
#include <string.h>

#include "formats/format.h"

enum {
    HEADER_MOST = 60, /* lines                  */
    NUMBERS = 8       /* numbers in the eighth line */
};

static const char xyz_magic[] = "Zygo XYZ Data File", ascii_magic[] = "Zygo ASCII Data File";

struct zygo {
    double rect[4]; /* rectangle of the phases */
    double system[NUMBERS];
    double resolution;
    struct rc_piece comment;
    struct rc_lines points; /* from the last `#` of the header to the `#` that ends the numbers */
};

static size_t
numbers_of(struct rc_piece line, double *number, size_t most)
{
    size_t n = 0;

    while (n < most && rc_piece_number(line, &number[n], &line))
        n++;
    return n;
}

static bool
is_mark(struct rc_piece line)
{
    return rc_piece_is(rc_piece_trim(line), "#");
}

/* Skips the lines up to the next mark. Returns false if there is none. *end is its position. */
static bool
next_mark(struct rc_lines *lines, const char **end)
{
    struct rc_piece line;

    while (rc_lines_next(lines, &line.text, &line.n))
        if (is_mark(line)) {
            *end = line.text;
            return true;
        }
    return false;
}

static enum rc_status
read_header(const struct rc_file *file, struct zygo *z, bool *xyz, struct rc_err *err)
{
    struct rc_lines lines = rc_piece_lines(rc_file_piece(file)), rest;
    struct rc_piece line = {"", 0};
    const char *end = NULL;

    *xyz = rc_file_holds(file, 0, xyz_magic, strlen(xyz_magic));
    *z = (struct zygo){.resolution = NAN, .comment = {"", 0}};
    z->rect[2] = z->rect[3] = z->system[6] = NAN;
    while (lines.number < HEADER_MOST && rc_lines_next(&lines, &line.text, &line.n) &&
           !is_mark(line)) {
        if (lines.number == 4)
            numbers_of(line, z->rect, 4);
        else if (lines.number == 5)
            z->comment = rc_piece_bare(line);
        else if (lines.number == 8)
            numbers_of(line, z->system, NUMBERS);
        else if (lines.number == 11)
            numbers_of(line, &z->resolution, 1);
    }
    if (!is_mark(line) || lines.number < 13)
        return rc_err_set(err, "the header does not end with a line '#' after at least 12 lines");
    if (!*xyz && !next_mark(&lines, &end))
        return rc_err_set(err, "the intensities do not end with a line '#'");
    z->points = rest = lines;
    if (!next_mark(&rest, &end))
        return rc_err_set(err, "the heights do not end with a line '#': the file is cut off");
    z->points.end = end;
    return RC_OK;
}

static enum rc_status
bad_point(const struct rc_lines *lines, struct rc_piece line, struct rc_err *err)
{
    return rc_err_set(err,
                      "line %zu is '%s': a column, a row and a height or 'No Data' are expected",
                      lines->number, rc_piece_shown(rc_piece_trim(line)));
}

static enum rc_status
fill_points(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    struct zygo z = *(struct zygo *)map->opened;
    struct rc_piece line, rest;

    (void)file;
    for (size_t k = 0; k < map->nx * map->ny; k++)
        v[k] = NAN;
    while (rc_lines_next(&z.points, &line.text, &line.n)) {
        double x, y, height = NAN;

        if (rc_piece_trim(line).n == 0)
            continue;
        if (!rc_piece_number(line, &x, &rest) || !rc_piece_number(rest, &y, &rest) ||
            (!rc_piece_is(rest, "No Data") &&
             (!rc_piece_number(rest, &height, &rest) || rest.n > 0)))
            return bad_point(&z.points, line, err);
        x -= z.rect[0];
        y -= z.rect[1];
        if (!(x >= 0 && x < (double)map->nx && y >= 0 && y < (double)map->ny) || x != floor(x) ||
            y != floor(y))
            return rc_err_set(err, "the point of line %zu is outside the %zu x %zu of the header",
                              z.points.number, map->nx, map->ny);
        v[(size_t)y * map->nx + (size_t)x] = height;
    }
    return RC_OK;
}

static enum rc_status
zygo_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct zygo *z = rc_maps_open(maps, sizeof *z, NULL, err);
    struct rc_map *map;
    bool xyz;

    if (z == NULL || read_header(file, z, &xyz, err) != RC_OK)
        return RC_FAIL;
    rc_maps_key(maps, "file.comment", z->comment);
    map = rc_maps_add(maps, rc_piece_of(""));
    if (rc_map_size(map, z->rect[2], "line 4", z->rect[3], "line 4", err) != RC_OK ||
        rc_map_fits(file, map->nx, map->ny, err) != RC_OK)
        return RC_FAIL;
    map->dx = map->dy = z->system[6] == 0 ? NAN : z->system[6];
    rc_map_unit(map, rc_piece_of(xyz ? "um" : "m"));
    if (xyz) {
        map->fill = fill_points;
        return RC_OK;
    }
    if (z->resolution != 0 && z->resolution != 1 && z->resolution != 2)
        return rc_err_set(err, "the phase resolution (line 11) is %g, not 0, 1 or 2",
                          z->resolution);
    map->scale = z->system[1] * z->system[4] * z->system[2] /
                 (z->resolution == 0   ? 4096
                  : z->resolution == 1 ? 32768
                                       : 131072);
    map->missing_from = 2147483640;
    map->missing_to = INFINITY;
    return rc_map_is_text(map, file, (size_t)(z->points.at - (const char *)file->data), err);
}

const struct rc_format rc_format_zygo = {
    .name = "zygo",
    .suffixes = ".xyz .asc .txt",
    .summary = "Zygo XYZ and ASCII data",
    .magic = {{xyz_magic, sizeof xyz_magic - 1}, {ascii_magic, sizeof ascii_magic - 1}},
    .refusal = "not a Zygo text: it must begin with 'Zygo XYZ Data File' or 'Zygo ASCII Data File'",
    .find = zygo_find,
};
