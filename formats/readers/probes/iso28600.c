/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * ISO 28600, the data transfer format of ISO/TC 201 for scanning probes. It is text with 128 lines of header,
 * each known by its number alone. Then comes a line for each point with the values of its channels between
 * commas, and then "end of experiment". A map is of one channel (MAP_SC) or of several (MAP_MC).
 *
 * The layout is the one that Gwyddion writes and reads.
 */
#include <math.h>
#include <string.h>

#include "formats/format.h"

enum {
    LINES = 128,
    /* numbers of lines, from 1 */
    MODE = 8,
    MAPPING = 17,
    FAST_AXIS = 20,
    FAST_WAY = 21,
    SLOW_WAY = 23,
    COLUMNS = 24,
    ROWS = 25,
    X_UNIT = 26,
    Y_UNIT = 27,
    WIDTH = 28,
    HEIGHT = 29,
    NAME = 69,
    UNIT = 70,
    CHANNELS = 94,
    CHANNEL = 95, /* name, unit and comment of the first of several */
    CHANNELS_MOST = 8
};

static const char magic[] = "ISO/TC 201 SPM data transfer format", last[] = "end of header";

/* Lines that are kept as keys. */
static const struct {
    size_t line;
    const char *key;
} texts[] = {{4, "file.institution"}, {5, "file.model"}, {6, "file.operator"}, {7, "file.comment"}};

struct iso {
    struct rc_piece line[LINES + 1]; /* from 1, trimmed */
    size_t data;                     /* byte behind the header */
};

static enum rc_status
read_header(const struct rc_file *file, struct iso *iso, struct rc_err *err)
{
    struct rc_lines lines = rc_piece_lines(rc_file_piece(file));
    struct rc_piece line;

    for (size_t k = 1; k <= LINES; k++) {
        if (!rc_lines_next(&lines, &line.text, &line.n))
            return rc_err_set(err, "the header has %d lines, the file %zu", LINES, k - 1);
        iso->line[k] = rc_piece_trim(line);
    }
    if (!rc_piece_is(iso->line[LINES], last))
        return rc_err_set(err, "line %d of the header is not '%s'", LINES, last);
    iso->data = (size_t)(lines.at - (const char *)file->data);
    return RC_OK;
}

static double
number_in(const struct iso *iso, size_t line)
{
    double value;

    return rc_piece_number(iso->line[line], &value, NULL) ? value : NAN;
}

/* The number of channels; RC_FAIL if the data is not a regular map. */
static enum rc_status
judge_mode(const struct iso *iso, size_t *channels, struct rc_err *err)
{
    double number = number_in(iso, CHANNELS);

    *channels = 1;
    if (!rc_piece_is(iso->line[MODE], "MAP_SC") && !rc_piece_is(iso->line[MODE], "MAP_MC"))
        return rc_err_set(err, "the mode is '%s': only maps are read (MAP_SC, MAP_MC)",
                          rc_piece_shown(iso->line[MODE]));
    if (!rc_piece_is(iso->line[MAPPING], "REGULAR MAPPING"))
        return rc_err_set(err, "the mapping is '%s': only regular ones are read",
                          rc_piece_shown(iso->line[MAPPING]));
    if (rc_piece_is(iso->line[MODE], "MAP_SC"))
        return RC_OK;
    if (!(number >= 1 && number <= CHANNELS_MOST) || number != floor(number))
        return rc_err_set(err, "the number of channels is '%s': it must be from 1 to %d",
                          rc_piece_shown(iso->line[CHANNELS]), CHANNELS_MOST);
    *channels = (size_t)number;
    return RC_OK;
}

static enum rc_status
fill_channel(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    struct rc_piece rest = {(const char *)file->data + map->at, file->size - map->at};
    size_t channels = map->more / CHANNELS_MOST, channel = map->more % CHANNELS_MOST;
    struct rc_piece word, after;
    double value;

    for (size_t k = 0; k < map->nx * map->ny; k++)
        for (size_t c = 0; c < channels; c++) {
            if (!rc_piece_word(&rest, " \t\r\n,", &word) ||
                !rc_piece_number(word, &value, &after) || after.n > 0)
                return rc_err_set(err, "point %zu of %zu has '%s' in the place of a number", k + 1,
                                  map->nx * map->ny, rc_piece_shown(word));
            if (c == channel)
                v[k] = value;
        }
    return RC_OK;
}

static bool
says(const struct iso *iso, const char *way)
{
    return rc_piece_is(iso->line[FAST_WAY], way) || rc_piece_is(iso->line[SLOW_WAY], way);
}

static enum rc_status
iso28600_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct iso iso = {.data = 0};
    size_t channels, nx, ny, least;

    if (read_header(file, &iso, err) != RC_OK || judge_mode(&iso, &channels, err) != RC_OK ||
        rc_map_count("columns (line 24)", number_in(&iso, COLUMNS), &nx, err) != RC_OK ||
        rc_map_count("rows (line 25)", number_in(&iso, ROWS), &ny, err) != RC_OK ||
        rc_size_mul(nx, ny, &least, err) != RC_OK ||
        rc_size_mul(least, channels, &least, err) != RC_OK)
        return RC_FAIL;
    if (least > (file->size - iso.data + 1) / 2) /* a digit and a separator */
        return rc_err_set(
            err,
            "the header promises %zu x %zu points of %zu numbers, the file has %zu bytes for them",
            nx, ny, channels, file->size - iso.data);
    for (size_t k = 0; k < channels; k++) {
        bool several = rc_piece_is(iso.line[MODE], "MAP_MC");
        struct rc_piece name = iso.line[several ? CHANNEL + 3 * k : NAME];
        struct rc_piece unit = iso.line[several ? CHANNEL + 3 * k + 1 : UNIT];
        struct rc_map *map = rc_maps_add(maps, name);

        map->nx = nx;
        map->ny = ny;
        map->at = iso.data;
        map->fill = fill_channel;
        map->more = channels * CHANNELS_MOST + k;
        map->by_columns = rc_piece_is(iso.line[FAST_AXIS], "Y");
        map->right_first = says(&iso, "right to left");
        map->bottom_first = says(&iso, "bottom to top");
        map->dx = fabs(number_in(&iso, WIDTH)) / (double)nx * rc_piece_metres(iso.line[X_UNIT]);
        map->dy = fabs(number_in(&iso, HEIGHT)) / (double)ny * rc_piece_metres(iso.line[Y_UNIT]);
        if (!rc_piece_is(unit, "n") && !rc_piece_is(unit, "d")) /* none, no dimension */
            rc_map_unit(map, unit);
    }
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++)
        rc_maps_key(maps, texts[k].key, iso.line[texts[k].line]);
    return RC_OK;
}

const struct rc_format rc_format_iso28600 = {
    .name = "iso28600",
    .suffixes = ".spm",
    .summary = "ISO 28600: maps of scanning probes as text",
    .magic = {{magic, sizeof magic - 1}},
    .refusal = "no file of ISO 28600: it does not begin with 'ISO/TC 201 SPM data transfer format'",
    .find = iso28600_find,
};
