/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Keyence's image data as text (VK-X, VR, VHX). Rows of values are in quotes, between commas, semicolons or
 * tabs. A header of keys in the user's language, then a title alone and the heights:
 *
 *     "Data type","ImageDataCsv"
 *     "XY Calibration","138.9","nm"          the only row of three: the spacing
 *     "Output image data","Height"
 *     "Horizontal","1024"
 *     "Vertical","768"
 *     "Unit","um"                            the last value that is a unit of length
 *
 *     "Height"
 *     "12.345","","12.347",...
 *
 * Keys are therefore not used: the size must be in two successive rows. Empty quotes are a missing
 * point. The micro sign comes in UTF-8, Latin-1, Shift-JIS, GBK and CP949.
 *
 * Written after other programs that read and write such files (kcsv2bcr and others).
 */
#include <math.h>
#include <string.h>

#include "formats/format.h"

enum {
    HEADER_MOST = 200, /* lines */
    SEEN = 4096        /* bytes that contain the magic word */
};

static const char magic[] = "ImageDataCsv";

struct keyence {
    struct rc_number_table table;
    double pitch, metres;  /* NAN: not given */
    struct rc_piece title; /* title of the heights */
    bool sized;            /* the header has the size of the table */
};

/* The first `most` cells of a row, without their quotes; gives their number. */
static size_t
cells_of(struct rc_piece line, struct rc_piece *cell, size_t most)
{
    size_t n = 0;

    for (line = rc_piece_trim(line); n < most && rc_piece_word(&line, ",;\t", &cell[n]);)
        n++;
    return n;
}

/* Works as rc_piece_metres, with the micrometres of Shift-JIS, GBK and CP949, and those of one letter. */
static double
metres_of(struct rc_piece unit)
{
    return rc_piece_is(unit, "\x83\xcam|\xa6\xccm|\xa5\xecm|\xa7\xad|\xe3\x8e\x9b") /* U+339B */
               ? 1e-6
               : rc_piece_metres(unit);
}

/* Reads the rows of the header, and moves behind the last one. */
static enum rc_status
read_header(struct rc_lines *lines, struct keyence *k, struct rc_lines *header, struct rc_err *err)
{
    struct rc_piece line, cell[4];
    double number, metres;

    *header = *lines;
    while (lines->number < HEADER_MOST && rc_lines_next(lines, &line.text, &line.n)) {
        size_t n = cells_of(line, cell, 4);

        if (n == 3 && rc_piece_number(cell[1], &number, NULL) &&
            !isnan(metres = metres_of(cell[2])))
            k->pitch = number * metres;
        else if (n == 2 && !isnan(metres = metres_of(cell[1])))
            k->metres = metres;
        else if (n == 1 && cell[0].n > 0 && !isnan(k->pitch)) {
            k->title = cell[0];
            header->end = line.text;
            return RC_OK;
        }
    }
    return rc_err_set(err, "the header has no row of a name, a number and a unit of length (XY "
                           "Calibration) and below it a title alone");
}

/* True if two rows that follow each other are the columns and rows of the table. */
static bool
has_size(struct rc_lines header, const struct rc_number_table *t)
{
    struct rc_piece line, cell[4];
    double number, last = NAN;

    while (rc_lines_next(&header, &line.text, &line.n)) {
        if (cells_of(line, cell, 4) != 2 || !rc_piece_number(cell[1], &number, NULL))
            number = NAN;
        if (last == (double)t->columns && number == (double)t->rows)
            return true;
        last = number;
    }
    return false;
}

static enum rc_status
keyence_open(const struct rc_file *file, const struct rc_wish *wish, struct keyence *k,
             struct rc_err *err)
{
    struct rc_piece start = {(const char *)file->data, file->size < SEEN ? file->size : SEEN};
    struct rc_lines lines = rc_piece_lines(rc_file_piece(file)), header;

    k->pitch = k->metres = NAN;
    if (rc_piece_find(start, magic) == NULL)
        return rc_err_set(err, "no image data of Keyence: there is no '%s' in its header", magic);
    if (read_header(&lines, k, &header, err) != RC_OK ||
        rc_number_table_open(&k->table, &lines, wish, err) != RC_OK)
        return RC_FAIL;
    if (has_size(header, &k->table))
        return RC_OK;
    return rc_err_set(err,
                      "the file has %zu columns and %zu rows of numbers, its header does not have "
                      "these two sizes in rows one below the other",
                      k->table.columns, k->table.rows);
}

static enum rc_status
fill_heights(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    struct keyence *k = map->opened;

    (void)file;
    return rc_number_table_read(&k->table, v, err);
}

static enum rc_status
keyence_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct keyence *k = rc_maps_open(maps, sizeof *k, NULL, err);
    struct rc_map *map;
    size_t n;

    if (k == NULL || keyence_open(file, maps->wish, k, err) != RC_OK ||
        rc_number_table_size(&k->table, &n, err) != RC_OK)
        return RC_FAIL;
    map = rc_maps_add(maps, k->title);
    map->nx = k->table.columns;
    map->ny = k->table.rows;
    map->dx = map->dy = k->pitch;
    map->fill = fill_heights;
    if (!isnan(k->metres)) {
        strcpy(map->unit, "m");
        map->si = k->metres;
    }
    return RC_OK;
}

static int
keyence_score(const struct rc_file *file)
{
    struct rc_piece start = {(const char *)file->data, file->size < SEEN ? file->size : SEEN};

    return rc_file_is_text(file) && rc_piece_find(start, magic) != NULL ? 92 : 0;
}

const struct rc_format rc_format_keyence = {
    .name = "keyence",
    .suffixes = ".csv",
    .summary = "Keyence image data as text",
    .score = keyence_score,
    .find = keyence_find,
};
