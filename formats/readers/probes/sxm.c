/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Nanonis SXM (SPECS): `:KEY:` lines, each with lines of values below it, up to `:SCANIT_END:` and the bytes
 * 1a 04. Then come floats, channel after channel, as the table DATA_INFO lists them:
 *
 *     :DATA_INFO:
 *             Channel Name Unit Direction Calibration Offset          between tabs
 *             14      Z    m    both      -9.000E-9   0.000E+0
 *
 * Values are in that unit already. If the direction is both, the backward scan follows the forward scan, in
 * the order of measuring, from the right. A scan that went up begins with its lowest line. Lines that were
 * not scanned are NaN.
 *
 * The layout is the one that Gwyddion and nanonispy read.
 */
#include <math.h>
#include <string.h>

#include "formats/format.h"

static const char magic[] = ":NANONIS_VERSION:", end_tag[] = "SCANIT_END";

struct sxm {
    double nx, ny, width, height; /* NAN: not given */
    bool big, up, typed, ends;
    struct rc_piece info; /* the table DATA_INFO */
};

static const struct rc_keep texts[] = {
    {"REC_DATE", "file.date"},
    {"REC_TIME", "file.time"},
    {"COMMENT", "file.comment"},
    {"NANONIS_VERSION", "file.version"},
};

/* Two numbers of a line. */
static void
take_pair(struct rc_piece value, double *first, double *second)
{
    struct rc_piece rest;

    if (!rc_piece_number(value, first, &rest) || !rc_piece_number(rest, second, NULL))
        *first = *second = NAN;
}

static enum rc_status
take(struct sxm *s, struct rc_piece key, struct rc_piece value, struct rc_maps *maps,
     struct rc_err *err)
{
    rc_maps_keep(maps, texts, sizeof texts / sizeof *texts, key, value);
    if (rc_piece_is(key, "SCAN_PIXELS"))
        take_pair(value, &s->nx, &s->ny);
    else if (rc_piece_is(key, "SCAN_RANGE"))
        take_pair(value, &s->width, &s->height);
    else if (rc_piece_is(key, "SCAN_DIR"))
        s->up = rc_piece_is(value, "up");
    else if (rc_piece_is(key, "DATA_INFO"))
        s->info = value;
    else if (rc_piece_is(key, "SCANIT_TYPE")) {
        s->typed = rc_piece_begins(value, "FLOAT");
        s->big = rc_piece_find(value, "MSBFIRST") != NULL;
        if (!s->typed || (!s->big && rc_piece_find(value, "LSBFIRST") == NULL))
            return rc_err_set(err, "SCANIT_TYPE is '%s': it must be FLOAT MSBFIRST or LSBFIRST",
                              rc_piece_shown(value));
    }
    return RC_OK;
}

/* Reads the header; *data is the first byte behind it. */
static enum rc_status
read_header(const struct rc_file *file, struct sxm *s, struct rc_maps *maps, size_t *data,
            struct rc_err *err)
{
    struct rc_lines lines = rc_piece_lines(rc_file_piece(file));
    struct rc_piece key = {"", 0}, value = {"", 0}, line;

    while (!s->ends && rc_lines_next(&lines, &line.text, &line.n)) {
        struct rc_piece trimmed = rc_piece_trim(line);

        if (trimmed.n < 3 || trimmed.text[0] != ':' || trimmed.text[trimmed.n - 1] != ':') {
            if (value.n == 0)
                value.text = line.text;
            value.n = (size_t)(line.text + line.n - value.text);
            continue;
        }
        if (take(s, key, rc_piece_trim(value), maps, err) != RC_OK)
            return RC_FAIL;
        key = (struct rc_piece){trimmed.text + 1, trimmed.n - 2};
        value = (struct rc_piece){"", 0};
        s->ends = rc_piece_is(key, end_tag);
    }
    for (*data = (size_t)(lines.at - (const char *)file->data); s->ends && *data < file->size;
         ++*data)
        if (rc_file_holds(file, *data, "\x1a\x04", 2)) {
            *data += 2;
            return RC_OK;
        }
    return rc_err_set(err, "the header does not end with :%s: and the bytes 1a 04", end_tag);
}

static void
add_map(const struct sxm *s, struct rc_piece name, struct rc_piece unit, bool back, size_t index,
        size_t data, struct rc_maps *maps)
{
    char both[80], start[64];
    struct rc_map *map;

    rc_text_clean(start, sizeof start - sizeof " (backward)", name.text, name.n);
    snprintf(both, sizeof both, "%s%s", start, back ? " (backward)" : "");
    map = rc_maps_add(maps, rc_piece_of(both));
    map->nx = (size_t)s->nx;
    map->ny = (size_t)s->ny;
    map->dx = s->width / s->nx;
    map->dy = s->height / s->ny;
    map->raw = RC_RAW_F32;
    map->big = s->big;
    map->right_first = back;
    map->bottom_first = s->up;
    map->at =
        data + 4 * map->nx * map->ny * index; /* both counts are below 2^31, `index` is checked */
    rc_map_unit(map, unit);
}

/* The cells of a row of the table: Channel, Name, Unit, Direction. */
static bool
part_row(struct rc_piece line, struct rc_piece cell[4])
{
    line = rc_piece_trim(line);
    for (size_t k = 0; k < 4; k++)
        if (!rc_piece_part(line, "\t", &cell[k], &line))
            return false;
    return true;
}

static enum rc_status
sxm_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct sxm s = {.nx = NAN, .ny = NAN, .width = NAN, .height = NAN, .info = {"", 0}};
    struct rc_piece line, cell[4];
    struct rc_lines rows;
    size_t data, nx, ny, index = 0, bytes;

    if (read_header(file, &s, maps, &data, err) != RC_OK ||
        rc_map_count("columns (SCAN_PIXELS)", s.nx, &nx, err) != RC_OK ||
        rc_map_count("rows (SCAN_PIXELS)", s.ny, &ny, err) != RC_OK ||
        rc_size_mul(nx, ny, &bytes, err) != RC_OK)
        return RC_FAIL;
    if (!s.typed)
        return rc_err_set(err, "the header has no SCANIT_TYPE");
    rows = rc_piece_lines(s.info);
    while (rc_lines_next(&rows, &line.text, &line.n)) {
        bool both;

        if (rc_piece_trim(line).n == 0 || rc_piece_begins(rc_piece_trim(line), "Channel"))
            continue;
        if (!part_row(line, cell))
            return rc_err_set(err, "DATA_INFO has a row without name, unit and direction: '%s'",
                              rc_piece_shown(rc_piece_trim(line)));
        both = rc_piece_is(cell[3], "both");
        if (!both && !rc_piece_is(cell[3], "forward") && !rc_piece_is(cell[3], "backward"))
            return rc_err_set(err,
                              "a direction in DATA_INFO is '%s', not forward, backward or both",
                              rc_piece_shown(cell[3]));
        for (int way = 0; way < 1 + both; way++, index++) {
            if (bytes > (file->size - data) / 4 / (index + 1))
                return rc_err_set(err,
                                  "the header promises %zu maps of %zu x %zu floats from byte %zu "
                                  "on, the file has %zu in all",
                                  index + 1, nx, ny, data, file->size);
            add_map(&s, cell[1], cell[2], way == 1 || rc_piece_is(cell[3], "backward"), index, data,
                    maps);
        }
    }
    return RC_OK;
}

const struct rc_format rc_format_sxm = {
    .name = "sxm",
    .suffixes = ".sxm",
    .summary = "Nanonis scans",
    .magic = {{magic, sizeof magic - 1}},
    .refusal = "no SXM file: it does not begin with :NANONIS_VERSION:",
    .find = sxm_find,
};
