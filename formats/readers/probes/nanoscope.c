/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * NanoScope (Digital Instruments, Veeco, Bruker) has a text header in sections. Then come images of whole
 * numbers, little-endian, the bottom row first.
 *
 *     \*Scanner list
 *     \@Sens. Zscan: V 13.22830 nm/V
 *     \*Ciao image list
 *     \Data offset: 40960
 *     \@2:Image Data: S [Height] "Height"
 *     \@2:Z scale: V [Sens. Zscan] (0.002934346 V/LSB) 192.3024 V
 *     \*File list end
 *
 * A value is number * hard / 2^bits * sensitivity, hard being the value behind the parentheses and bits 8 *
 * Bytes/pixel. Since version 9.2 numbers are stored in 32 bits for any Bytes/pixel, so that the length of the
 * data decides.
 */
#include <math.h>
#include <string.h>

#include "formats/format.h"

struct image {
    double at, bytes, width, columns, rows;
    struct rc_piece size, scale, data, note, line;
};

static const struct image no_image = {
    .size = {"", 0}, .scale = {"", 0}, .data = {"", 0}, .note = {"", 0}, .line = {"", 0}};

static const struct rc_field image_fields[] = {
    {"\\Data offset", RC_FIELD_NUMBER, offsetof(struct image, at)},
    {"\\Data length", RC_FIELD_NUMBER, offsetof(struct image, bytes)},
    {"\\Bytes/pixel", RC_FIELD_NUMBER, offsetof(struct image, width)},
    {"\\Samps/line", RC_FIELD_NUMBER, offsetof(struct image, columns)},
    {"\\Number of lines", RC_FIELD_NUMBER, offsetof(struct image, rows)},
    {"\\Scan size", RC_FIELD_TEXT, offsetof(struct image, size)},
    {"\\@2:Z scale", RC_FIELD_TEXT, offsetof(struct image, scale)},
    {"\\@2:Image Data", RC_FIELD_TEXT, offsetof(struct image, data)},
    {"\\Note", RC_FIELD_TEXT, offsetof(struct image, note)},
    {"\\Line direction", RC_FIELD_TEXT, offsetof(struct image, line)},
};

static const struct rc_keep keys[] = {
    {"\\Date", "file.date"},
    {"\\Version", "file.version"},
    {"\\Microscope", "file.model"},
    {"\\Serial number", "file.serial"},
    {"\\Scanner type", "file.scanner"},
    {"\\Operator", "file.operator"},
};

/* Parts a line into key and value, but not at the colon of a key that begins as "\@2:Z scale: V
 * ..." does. */
static bool
part_line(struct rc_piece line, struct rc_piece *key, struct rc_piece *value)
{
    size_t mark = 0;

    if (line.n > 4 && line.text[1] == '@' && line.text[2] >= '0' && line.text[2] <= '9')
        mark = 4;
    while (mark < line.n && line.text[mark] != ':')
        mark++;
    if (mark >= line.n)
        return false;
    *key = rc_piece_trim((struct rc_piece){line.text, mark});
    *value = rc_piece_trim((struct rc_piece){line.text + mark + 1, line.n - mark - 1});
    return true;
}

/* The text between two characters; empty if they are missing. */
static struct rc_piece
between(struct rc_piece piece, char first, char last)
{
    const char *from = memchr(piece.text, first, piece.n), *to;
    size_t left;

    if (from == NULL)
        return (struct rc_piece){piece.text, 0};
    left = piece.n - (size_t)(from - piece.text) - 1;
    to = memchr(from + 1, last, left);
    return (struct rc_piece){from + 1, to == NULL ? 0 : (size_t)(to - from - 1)};
}

/* The header; empty when it does not end. */
static struct rc_piece
header_of(const struct rc_file *file)
{
    struct rc_piece all = rc_file_piece(file);
    const char *end = rc_piece_find(all, "\\*File list end");

    all.n = end == NULL ? 0 : (size_t)(end - all.text);
    return all;
}

static bool
next_line(struct rc_lines *lines, struct rc_piece *line)
{
    if (!rc_lines_next(lines, &line->text, &line->n))
        return false;
    *line = rc_piece_trim(*line);
    return true;
}

/* The value of a key that is `\@` and the name, such as "Sens. Zscan". */
static bool
find_sensitivity(struct rc_piece header, struct rc_piece name, struct rc_piece *found)
{
    struct rc_lines lines = rc_piece_lines(header);
    struct rc_piece line, key;

    while (name.n > 0 && next_line(&lines, &line))
        if (line.n > name.n + 2 && line.text[1] == '@' &&
            memcmp(line.text + 2, name.text, name.n) == 0 && part_line(line, &key, found) &&
            key.n == name.n + 2)
            return true;
    return false;
}

/* "V 13.22830 nm/V" */
static bool
number_behind_v(struct rc_piece value, double *number, struct rc_piece *unit)
{
    if (rc_piece_begins(value, "V ") || rc_piece_begins(value, "C "))
        value = rc_piece_trim((struct rc_piece){value.text + 1, value.n - 1});
    return rc_piece_number(value, number, unit);
}

/* Moves behind the parentheses, which may be nested: "(0.00000000745058 log(Arb)/LSB) 32 log(Arb)". */
static void
skip_parentheses(struct rc_piece *piece)
{
    size_t open = 0;

    for (size_t k = 0; k < piece->n; k++) {
        open += piece->text[k] == '(';
        if (piece->text[k] != ')' || open == 0 || --open > 0)
            continue;
        *piece = (struct rc_piece){piece->text + k + 1, piece->n - k - 1};
        return;
    }
}

static enum rc_status
set_scale(struct rc_piece header, const struct image *m, struct rc_map *map, int bits,
          struct rc_err *err)
{
    struct rc_piece hard = m->scale, unit, value, per, upper, lower;
    struct rc_map given = {0}, wanted = {0};
    double number, sensitivity;

    skip_parentheses(&hard);
    if (!number_behind_v(rc_piece_trim(hard), &number, &unit))
        return rc_err_set(err, "image '%s': its Z scale is '%s', in which no value is found",
                          map->name, rc_piece_shown(m->scale));
    map->scale = ldexp(number, -bits);
    if (!find_sensitivity(header, between(m->scale, '[', ']'), &value) ||
        !number_behind_v(value, &sensitivity, &per) || !rc_piece_part(per, "/", &upper, &lower)) {
        rc_map_unit(map, unit);
        return RC_OK;
    }
    rc_map_unit(map, upper);
    rc_map_unit(&given, unit);
    rc_map_unit(&wanted, lower);
    map->scale *= sensitivity;
    if (strcmp(given.unit, wanted.unit) == 0)
        map->scale *= given.si / wanted.si; /* mV on a sensitivity per V */
    return RC_OK;
}

/* "300 300 nm", "2 2 ~m", "10000 nm" */
static void
set_spacing(struct rc_piece size, struct rc_map *map)
{
    struct rc_piece unit, rest;
    double x, y, metres;
    bool has_two;

    if (!rc_piece_number(size, &x, &unit))
        return;
    has_two = rc_piece_number(unit, &y, &rest);
    if (has_two)
        unit = rest;
    if (!rc_length_unit(unit.text, unit.n, &metres))
        return;
    map->dx = x * metres / (double)map->nx;
    map->dy = has_two ? y * metres / (double)map->ny : map->dx;
}

static enum rc_status
add_image(const struct rc_file *file, struct rc_piece header, const struct image *m,
          const struct image *scan, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_piece name = between(m->data, '"', '"');
    struct rc_map *map;
    double count;

    if (name.n == 0)
        name = between(m->data, '[', ']');
    map = rc_maps_add(maps, name);
    if (rc_map_size(map, m->columns, "Samps/line", m->rows, "Number of lines", err) != RC_OK)
        return RC_FAIL;
    count = (double)map->nx * (double)map->ny;
    if (!(m->at >= 0 && m->at <= (double)file->size))
        return rc_err_set(err, "image '%s' begins at byte %g of a file of %zu", map->name, m->at,
                          file->size);
    if (m->bytes != 2 * count && m->bytes != 4 * count && m->width != 2 && m->width != 4)
        return rc_err_set(err, "image '%s' has %g bytes a pixel: it must have 2 or 4", map->name,
                          m->width);
    map->raw =
        m->bytes == 4 * count || (m->bytes != 2 * count && m->width == 4) ? RC_RAW_I32 : RC_RAW_I16;
    map->at = (size_t)m->at;
    map->bottom_first = true;
    set_spacing(m->size.n > 0 ? m->size : scan->size, map);
    if (maps->n > RC_MAPS_MOST)
        return RC_OK; /* only counted */
    if (m->width == 2 || m->width == 4)
        return set_scale(header, m, map, 8 * (int)m->width, err);
    return set_scale(header, m, map, map->raw == RC_RAW_I16 ? 16 : 32, err);
}

/* A scan in both directions gives two images with one name; the name of the backward one gets a mark. */
static void
mark_retrace(struct rc_maps *maps, const bool back[RC_MAPS_MOST])
{
    static const char mark[] = " (retrace)";
    size_t n = maps->n < RC_MAPS_MOST ? maps->n : RC_MAPS_MOST;

    for (size_t k = 0; k < n; k++)
        for (size_t l = 0; l < n && back[k]; l++)
            if (!back[l] && strcmp(maps->map[l].name, maps->map[k].name) == 0 &&
                strlen(maps->map[k].name) + sizeof mark <= sizeof maps->map[k].name) {
                strcat(maps->map[k].name, mark);
                break;
            }
}

static enum rc_status
nanoscope_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_piece header = header_of(file);
    struct rc_lines lines = rc_piece_lines(header);
    struct image scan = no_image, image = no_image, *into = NULL;
    struct rc_piece line, key, value;
    bool more = true, back[RC_MAPS_MOST] = {false};

    if (!rc_file_holds(file, 0, "\\*File list", 11) && !rc_file_holds(file, 0, "\\*Ciao", 6))
        return rc_err_set(err, "no NanoScope file: it does not begin with \\*File list");
    if (header.n == 0)
        return rc_err_set(err, "the header does not end: there is no \\*File list end");
    while (more) {
        more = next_line(&lines, &line);
        if (!more || rc_piece_begins(line, "\\*")) {
            if (into == &image) {
                if (add_image(file, header, &image, &scan, maps, err) != RC_OK)
                    return RC_FAIL;
                if (maps->n <= RC_MAPS_MOST)
                    back[maps->n - 1] = rc_piece_is(image.line, "Retrace");
            }
            into = rc_piece_is(line, "\\*Ciao image list")  ? &image
                   : rc_piece_is(line, "\\*Ciao scan list") ? &scan
                                                            : NULL;
            image = no_image;
            continue;
        }
        if (!part_line(line, &key, &value))
            continue;
        if (into != NULL && rc_field_take(image_fields, sizeof image_fields / sizeof *image_fields,
                                          key, value, into, err) != RC_OK)
            return RC_FAIL;
        rc_maps_keep(maps, keys, sizeof keys / sizeof *keys, key, value);
    }
    mark_retrace(maps, back);
    if (maps->n == 0)
        return rc_err_set(err, "the header names no image (\\*Ciao image list)");
    return RC_OK;
}

static int
nanoscope_score(const struct rc_file *file)
{
    if (!rc_file_holds(file, 0, "\\*File list", 11))
        return 0;
    return memchr(file->data, 0x1a, file->size) != NULL || memchr(file->data, 0, file->size) != NULL
               ? 95
               : 35; /* all text: an export, or a header without its images */
}

const struct rc_format rc_format_nanoscope = {
    .name = "nanoscope",
    .suffixes = ".spm .001 .di",
    .summary = "Bruker (Veeco, Digital Instruments) NanoScope images",
    .score = nanoscope_score,
    .find = nanoscope_find,
};
