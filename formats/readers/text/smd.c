/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * SMD is the file of software measurement standards (ISO 5436-2:2001). It has records of text, each
 * ended by the byte 3,
 *
 *     ISO 5436 - 2 - 2001         revision
 *     PRF 0 line                  a profile, its number and name
 *     CX I 5 MM 1.0e0 D 0.001     axis, incremental, points, unit, factor, type, increment
 *     CZ A 5 UM 1.0e0 D           heights, times the factor in their unit
 *
 * then one of other words, the heights, a line each, and a checksum, which is not looked at. Written from a
 * description, not from the standard.
 */
#include <math.h>
#include <string.h>

#include "formats/format.h"

enum {
    END = 3, /* size of the end of a record */
    WORDS = 7
};

static const char magic[] = "ISO 5436";

struct smd {
    struct rc_piece name, x_unit, z_unit;
    double points, heights, step, scale;
    bool profile;
};

static bool
is_smd(const struct rc_file *file)
{
    return rc_file_holds(file, 0, magic, sizeof magic - 1) &&
           memchr(file->data, END, file->size) != NULL;
}

/* Splits a line into at most WORDS words; the last one has the rest. Returns their number. */
static size_t
part_words(struct rc_piece line, struct rc_piece word[WORDS])
{
    size_t n = 0;

    for (line = rc_piece_trim(line); line.n > 0 && n < WORDS; n++)
        if (n + 1 == WORDS || !rc_piece_part(line, " \t", &word[n], &line)) {
            word[n++] = line;
            break;
        }
    return n;
}

/* "CX I 5 MM 1.0e0 D 0.001" */
static enum rc_status
take_axis(struct smd *s, const struct rc_piece *word, size_t n, struct rc_err *err)
{
    bool is_x = rc_piece_is(word[0], "CX");
    double *points = is_x ? &s->points : &s->heights, scale, step = 1;
    char quote[RC_SHOWN];

    rc_piece_shown_to(quote, word[0]);
    if (n < 5 || !rc_piece_number(word[2], points, NULL) || !rc_piece_number(word[4], &scale, NULL))
        return rc_err_set(err, "the axis %s has no number of points, unit and factor", quote);
    if (!rc_piece_is(word[1], is_x ? "I" : "A"))
        return rc_err_set(
            err, is_x ? "the positions are not in even steps (axis CX is not I): that is not read"
                      : "the heights are in steps (axis CZ is not A): that is not read");
    if (is_x && (n < 7 || !rc_piece_number(word[6], &step, NULL)))
        return rc_err_set(err, "the axis %s has no increment", quote);
    *(is_x ? &s->x_unit : &s->z_unit) = word[3];
    *(is_x ? &s->step : &s->scale) = scale * step;
    return RC_OK;
}

static enum rc_status
take_line(struct smd *s, struct rc_piece line, struct rc_err *err)
{
    struct rc_piece word[WORDS];
    size_t n = part_words(line, word);

    if (n > 0 && rc_piece_is(word[0], "CX|CZ"))
        return take_axis(s, word, n, err);
    if (n > 0 && rc_piece_is(word[0], "PRF")) {
        s->profile = true;
        if (n > 2)
            s->name = (struct rc_piece){word[2].text, (size_t)(line.text + line.n - word[2].text)};
    }
    if (n > 0 && rc_piece_is(word[0], "CY|SUR|PCL"))
        return rc_err_set(err, "the file is not a single profile (%s), and others are not read",
                          rc_piece_shown(word[0]));
    return RC_OK;
}

/* The next record without its mark; false when none is there. */
static bool
next_record(struct rc_piece *rest, struct rc_piece *record)
{
    const char *end = memchr(rest->text, END, rest->n);

    if (end == NULL)
        return false;
    *record = (struct rc_piece){rest->text, (size_t)(end - rest->text)};
    rest->n -= record->n + 1;
    rest->text = end + 1;
    return true;
}

static enum rc_status
fill_heights(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    struct rc_piece text = {(const char *)file->data + map->at, map->more};

    if (rc_flow_read(&text, v, map->nx, err) != RC_OK)
        return RC_FAIL;
    return rc_piece_trim(text).n == 0
               ? RC_OK
               : rc_err_set(err, "the record of heights has more values than the %zu of the header",
                            map->nx);
}

static enum rc_status
smd_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct smd s = {.step = NAN, .scale = NAN};
    struct rc_piece rest = rc_file_piece(file), head, other, data, line;
    struct rc_map *map = rc_maps_add(maps, rc_piece_of(""));
    struct rc_lines lines;

    if (!is_smd(file) || !next_record(&rest, &head) || !next_record(&rest, &other) ||
        !next_record(&rest, &data))
        return rc_err_set(
            err, "no SMD file: it does not begin with %s, or lacks one of its three records",
            magic);
    lines = rc_piece_lines(head);
    while (rc_lines_next(&lines, &line.text, &line.n))
        if (take_line(&s, line, err) != RC_OK)
            return RC_FAIL;
    if (!s.profile || isnan(s.step) || isnan(s.scale))
        return rc_err_set(err, "the header lacks a line PRF, CX or CZ");
    if (rc_map_count("points (CX)", s.points, &map->nx, err) != RC_OK)
        return RC_FAIL;
    if (s.heights != s.points || map->nx > data.n / 2 + 1)
        return rc_err_set(err, "the header promises %zu positions and %g heights, in %zu bytes",
                          map->nx, s.heights, data.n);
    if (isnan(rc_piece_metres_in_capitals(s.x_unit)) ||
        isnan(rc_piece_metres_in_capitals(s.z_unit)))
        return rc_err_set(
            err, "'%s' is not a unit of length",
            rc_piece_shown(isnan(rc_piece_metres_in_capitals(s.x_unit)) ? s.x_unit : s.z_unit));
    map->ny = 1;
    map->at = (size_t)(data.text - (const char *)file->data);
    map->more = data.n;
    map->fill = fill_heights;
    map->dx = s.step * rc_piece_metres_in_capitals(s.x_unit);
    map->scale = s.scale;
    map->si = rc_piece_metres_in_capitals(s.z_unit);
    strcpy(map->unit, "m");
    rc_maps_key(maps, "file.title", s.name);
    return RC_OK;
}

const struct rc_format rc_format_smd = {
    .name = "smd",
    .suffixes = ".smd",
    .summary = "profiles of ISO 5436-2:2001",
    .is = is_smd,
    .find = smd_find,
};
