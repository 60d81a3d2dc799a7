/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Profiles of stylus instruments as text: records of lines, each ended by EOR, and EOF at the end.
 *
 *     1 2
 *     NAME 0.0 PRF
 *     CX M 8.0e+00 MM 1.0e+00 D       the axis, points, unit
 *     CZ M 8.0e+00 MM 1.0e-06 L       the heights: number, unit, value of one count
 *     EOR
 *     SPACING CX 1.0e-03              the step in the unit of CX; other lines are ignored
 *     EOR
 *     10                              the counts, a line each
 *
 * Written from one small file, without a description of the format.
 */
#include <math.h>
#include <string.h>

#include "formats/format.h"

enum {
    WORDS = 6
};

struct prf {
    struct rc_piece x_unit, z_unit, name;
    double points, heights, step, count;
    bool profile;
};

/* Splits a line into at most WORDS words, and returns their number. */
static size_t
part_words(struct rc_piece line, struct rc_piece word[WORDS])
{
    size_t n = 0;

    while (n < WORDS && rc_piece_word(&line, " \t", &word[n]))
        n++;
    return n;
}

/* Takes the next line; false at the end of its record. */
static bool
next_line(struct rc_lines *lines, struct rc_piece word[WORDS], size_t *n)
{
    struct rc_piece line;

    if (!rc_lines_next(lines, &line.text, &line.n))
        return false;
    *n = part_words(line, word);
    return *n == 0 || !rc_piece_is(word[0], "EOR|EOF");
}

static bool
is_prf(const struct rc_file *file)
{
    struct rc_lines lines = rc_piece_lines(rc_file_piece(file));
    struct rc_piece word[WORDS];
    bool profile = false, axis = false;
    size_t n;

    while (lines.number < 12 && next_line(&lines, word, &n)) {
        profile = profile || (n == 3 && rc_piece_is(word[2], "PRF"));
        axis = axis || (n >= 5 && rc_piece_is(word[0], "CZ"));
    }
    return profile && axis;
}

/* "CX M 8.0e+00 MM 1.0e+00 D" */
static enum rc_status
take_axis(struct prf *p, const struct rc_piece *word, size_t n, struct rc_err *err)
{
    bool is_x = rc_piece_is(word[0], "CX");
    double unused;

    if (n < 5 || !rc_piece_number(word[2], is_x ? &p->points : &p->heights, NULL) ||
        !rc_piece_number(word[4], is_x ? &unused : &p->count, NULL) ||
        isnan(rc_piece_metres_in_capitals(word[3])))
        return rc_err_set(err, "the axis %s has no number of points, length and factor",
                          rc_piece_shown(word[0]));
    *(is_x ? &p->x_unit : &p->z_unit) = word[3];
    return RC_OK;
}

static enum rc_status
read_head(struct prf *p, struct rc_lines *lines, struct rc_err *err)
{
    struct rc_piece word[WORDS];
    size_t n;

    while (next_line(lines, word, &n)) {
        if (n > 0 && rc_piece_is(word[0], "CX|CZ") && take_axis(p, word, n, err) != RC_OK)
            return RC_FAIL;
        if (n > 0 && rc_piece_is(word[0], "CY"))
            return rc_err_set(err, "the file has an axis CY: only single profiles are read");
        if (n == 3 && rc_piece_is(word[2], "PRF")) {
            p->profile = true;
            p->name = word[0];
        }
    }
    while (next_line(lines, word, &n))
        if (n == 3 && rc_piece_is(word[0], "SPACING") && rc_piece_is(word[1], "CX"))
            rc_piece_number(word[2], &p->step, NULL);
    if (!p->profile || isnan(p->step) || isnan(p->count) || p->x_unit.n == 0)
        return rc_err_set(err, "no PRF file: it lacks a line PRF, CX, CZ or SPACING CX");
    return RC_OK;
}

static enum rc_status
fill_heights(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    struct rc_piece text = {(const char *)file->data + map->at, map->more};

    if (rc_flow_read(&text, v, map->nx, err) != RC_OK)
        return RC_FAIL;
    return rc_piece_trim(text).n == 0
               ? RC_OK
               : rc_err_set(err, "there are more heights than the %zu of the header", map->nx);
}

static enum rc_status
prf_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct prf p = {.step = NAN, .count = NAN};
    struct rc_map *map = rc_maps_add(maps, rc_piece_of(""));
    struct rc_lines lines = rc_piece_lines(rc_file_piece(file));
    struct rc_piece word[WORDS];
    const char *data, *end;
    size_t n;

    if (read_head(&p, &lines, err) != RC_OK ||
        rc_map_count("points (CX)", p.points, &map->nx, err) != RC_OK)
        return RC_FAIL;
    data = end = lines.at;
    while (next_line(&lines, word, &n))
        end = lines.at;
    if (p.heights != p.points || map->nx > (size_t)(end - data) / 2 + 1)
        return rc_err_set(err, "the header promises %zu positions and %g heights, in %zu bytes",
                          map->nx, p.heights, (size_t)(end - data));
    map->ny = 1;
    map->at = (size_t)(data - (const char *)file->data);
    map->more = (size_t)(end - data);
    map->fill = fill_heights;
    map->dx = p.step * rc_piece_metres_in_capitals(p.x_unit);
    map->scale = p.count;
    map->si = rc_piece_metres_in_capitals(p.z_unit);
    strcpy(map->unit, "m");
    rc_maps_key(maps, "file.title", p.name);
    return RC_OK;
}

const struct rc_format rc_format_prf = {
    .name = "prf",
    .suffixes = ".prf",
    .summary = "profiles of stylus instruments: PRF, text",
    .is = is_prf,
    .find = prf_find,
};
