/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * NRRD of Teem: lines `field: value` after NRRD000n up to an empty one, then the values. The first axis,
 * which is x, runs fastest; row 0 is the first. They are raw, packed with gzip, or text. Axes of one value
 * beyond two are passed over.
 *
 * The step of an axis is its spacing or the length of its direction in space. Otherwise it comes from the
 * least and the greatest position on the axis. These are at nodes where the axis is centred on nodes, else at
 * the borders of cells. `units` or `space units` have the units of the axes, in quotes, `sample units` that
 * of the values.
 *
 * Written from Teem's description of the format, and from files of Gwyddion.
 */
#include <math.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/format.h"

enum {
    AXES_MOST = 16
};

static const char magic[] = "NRRD000";

struct nrrd {
    struct rc_piece type, encoding, endian, dimension, sizes, spacings, mins, maxs, units, centers,
        unit;
    struct rc_piece file, skip, lines, title, directions, space_units;
    size_t data; /* byte behind the header */
};

#define TO(member) offsetof(struct nrrd, member)
static const struct rc_field fields[] = {
    {"type", RC_FIELD_TEXT, TO(type)},
    {"encoding", RC_FIELD_TEXT, TO(encoding)},
    {"endian", RC_FIELD_TEXT, TO(endian)},
    {"dimension", RC_FIELD_TEXT, TO(dimension)},
    {"sizes", RC_FIELD_TEXT, TO(sizes)},
    {"spacings", RC_FIELD_TEXT, TO(spacings)},
    {"axis mins|axismins", RC_FIELD_TEXT, TO(mins)},
    {"axis maxs|axismaxs", RC_FIELD_TEXT, TO(maxs)},
    {"units", RC_FIELD_TEXT, TO(units)},
    {"centers|centerings", RC_FIELD_TEXT, TO(centers)},
    {"sample units|sampleunits", RC_FIELD_TEXT, TO(unit)},
    {"data file|datafile", RC_FIELD_TEXT, TO(file)},
    {"byte skip|byteskip", RC_FIELD_TEXT, TO(skip)},
    {"line skip|lineskip", RC_FIELD_TEXT, TO(lines)},
    {"content", RC_FIELD_TEXT, TO(title)},
    {"space directions", RC_FIELD_TEXT, TO(directions)},
    {"space units", RC_FIELD_TEXT, TO(space_units)},
};
#undef TO

static const struct {
    const char *names;
    enum rc_raw raw;
} types[] = {
    {"signed char|int8|int8_t", RC_RAW_I8},
    {"uchar|unsigned char|uint8|uint8_t", RC_RAW_U8},
    {"short|short int|signed short|signed short int|int16|int16_t", RC_RAW_I16},
    {"ushort|unsigned short|unsigned short int|uint16|uint16_t", RC_RAW_U16},
    {"int|signed int|int32|int32_t", RC_RAW_I32},
    {"uint|unsigned int|uint32|uint32_t", RC_RAW_U32},
    {"longlong|long long|int64|int64_t", RC_RAW_I64},
    {"ulonglong|unsigned long long|uint64|uint64_t", RC_RAW_U64},
    {"float", RC_RAW_F32},
    {"double", RC_RAW_F64},
};

/* ---- header ---- */

static enum rc_status
read_header(const struct rc_file *file, struct nrrd *h, struct rc_err *err)
{
    struct rc_lines lines = rc_piece_lines(rc_file_piece(file));
    struct rc_piece line, key, value;

    for (size_t k = 0; k < sizeof fields / sizeof *fields; k++)
        *(struct rc_piece *)(void *)((char *)h + fields[k].at) = (struct rc_piece){"", 0};
    h->data = 0;
    rc_lines_next(&lines, &line.text, &line.n);
    while (rc_lines_next(&lines, &line.text, &line.n)) {
        if (line.n == 0) {
            h->data = (size_t)(lines.at - (const char *)file->data);
            return h->file.n == 0 ? RC_OK
                                  : rc_err_set(err, "the values are in another file: only NRRD "
                                                    "files with their own values are read");
        }
        if (*line.text != '#' && rc_piece_part(line, ":", &key, &value) &&
            (value.n == 0 || *value.text != '='))
            rc_field_take(fields, sizeof fields / sizeof *fields, key, value, h, NULL);
    }
    return rc_err_set(err, "the header does not end: there is no empty line");
}

static double
number_of(struct rc_piece word)
{
    double value;

    return word.n > 0 && rc_piece_number(word, &value, NULL) ? value : NAN;
}

static struct rc_piece
word_at(struct rc_piece list, size_t axis)
{
    struct rc_piece word = {"", 0};

    for (size_t k = 0; k <= axis; k++)
        rc_piece_word(&list, " \t", &word);
    return word;
}

/* The two axes that are longer than one value; without such axes, the first two. */
static enum rc_status
pick_axes(const struct nrrd *h, size_t axis[2], double size[2], struct rc_err *err)
{
    double dimension = number_of(h->dimension);
    size_t found = 0;

    if (!(dimension >= 1 && dimension <= AXES_MOST))
        return rc_err_set(err, "the dimension is '%s': maps have two",
                          rc_piece_shown(h->dimension));
    size[1] = 1;
    axis[1] = AXES_MOST;
    for (size_t k = 0; k < (size_t)dimension; k++) {
        double n = number_of(word_at(h->sizes, k));

        if (n == 1 && ((size_t)dimension - k > 2 - found))
            continue;
        if (found == 2)
            return rc_err_set(err, "the sizes are %s: maps have two axes longer than one value",
                              rc_piece_shown(h->sizes));
        axis[found] = k;
        size[found++] = n;
    }
    return RC_OK;
}

/* The length of the vector of an axis, "(1.1,0,0)"; NAN: it has no vector. */
static double
vector_length(struct rc_piece list, size_t axis)
{
    struct rc_piece vector = {"", 0}, number, skipped;
    double length = 0;

    for (size_t k = 0; k <= axis; k++) {
        list = rc_piece_trim(list);
        if (rc_piece_begins(list, "none")) {
            vector = (struct rc_piece){"", 0};
            list = (struct rc_piece){list.text + 4, list.n - 4};
        } else if (!rc_piece_part(list, "(", &skipped, &list) ||
                   !rc_piece_part(list, ")", &vector, &list))
            return NAN;
    }
    if (vector.n == 0)
        return NAN;
    while (rc_piece_part(vector, ",", &number, &vector))
        length = hypot(length, number_of(number));
    return hypot(length, number_of(vector));
}

static double
step_of(const struct nrrd *h, size_t axis, double n)
{
    double spacing = number_of(word_at(h->spacings, axis));
    double vector = vector_length(h->directions, axis);
    double length = number_of(word_at(h->maxs, axis)) - number_of(word_at(h->mins, axis));

    if (!isnan(spacing))
        return fabs(spacing);
    if (!isnan(vector))
        return vector;
    return fabs(length) / (rc_piece_is(word_at(h->centers, axis), "node") ? n - 1 : n);
}

/* ---- values ---- */

static unsigned char *
unpack(const struct rc_file *file, const struct rc_map *map, size_t *n, struct rc_err *err)
{
    struct rc_file packed = {file->name, file->data + map->more, file->size - map->more};
    size_t wanted = map->nx * map->ny * rc_raw_width(map->raw);
    RC_OWNED unsigned char *bytes = NULL;

    if (!rc_file_packed(&packed))
        return rc_err_null(err, "the values are not packed with gzip, as the header says");
    bytes = rc_file_unpack(&packed, wanted, n, err);
    return bytes != NULL && rc_bytes_agree("values", wanted, *n, err) == RC_OK ? rc_give(&bytes)
                                                                               : NULL;
}

static enum rc_status
set_type(const struct nrrd *h, const struct rc_file *file, struct rc_map *map, struct rc_err *err)
{
    size_t k = 0;

    while (k < sizeof types / sizeof *types && !rc_piece_is(h->type, types[k].names))
        k++;
    if (k == sizeof types / sizeof *types)
        return rc_err_set(err, "the type '%s' is not supported", rc_piece_shown(h->type));
    map->raw = types[k].raw;
    map->at = h->data;
    map->big = rc_piece_is(h->endian, "big");
    if ((h->skip.n > 0 && number_of(h->skip) != 0) || (h->lines.n > 0 && number_of(h->lines) != 0))
        return rc_err_set(err,
                          "bytes or lines before the values are to be skipped: that is not read");
    if (rc_piece_is(h->encoding, "raw"))
        return RC_OK;
    if (rc_piece_is(h->encoding, "gzip|gz")) {
        map->unpack = unpack;
        map->more = h->data;
        map->at = 0;
        return rc_map_bound(
            map, file, (double)map->nx * (double)map->ny * (double)rc_raw_width(map->raw), err);
    }
    if (rc_piece_is(h->encoding, "ascii|text|txt"))
        return rc_map_is_text(map, file, h->data, err);
    return rc_err_set(err, "the encoding is '%s': raw, gzip and ascii are read",
                      rc_piece_shown(h->encoding));
}

static enum rc_status
nrrd_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_piece x_unit, y_unit;
    struct rc_map *map;
    struct nrrd h;
    size_t axis[2];
    double size[2], dx, dy;

    if (read_header(file, &h, err) != RC_OK || pick_axes(&h, axis, size, err) != RC_OK)
        return RC_FAIL;
    map = rc_maps_add(maps, h.title);
    if (rc_map_size(map, size[0], "sizes", size[1], "sizes", err) != RC_OK ||
        set_type(&h, file, map, err) != RC_OK)
        return RC_FAIL;
    dx = step_of(&h, axis[0], size[0]);
    dy = map->ny == 1 ? dx : step_of(&h, axis[1], size[1]);
    x_unit = h.units.n > 0 ? word_at(h.units, axis[0]) : word_at(h.space_units, 0);
    y_unit = map->ny == 1    ? x_unit
             : h.units.n > 0 ? word_at(h.units, axis[1])
                             : word_at(h.space_units, 1);
    if (!isnan(dx) && !isnan(dy) &&
        (isnan(rc_piece_metres(x_unit)) || isnan(rc_piece_metres(y_unit))))
        rc_map_hint(map, dx, dy);
    map->dx = dx * rc_piece_metres(x_unit);
    map->dy = dy * rc_piece_metres(y_unit);
    rc_map_unit(map, rc_piece_bare(h.unit));
    return RC_OK;
}

const struct rc_format rc_format_nrrd = {
    .name = "nrrd",
    .suffixes = ".nrrd",
    .summary = "NRRD of two axes: raw, gzip or text",
    .magic = {{magic, sizeof magic - 1}},
    .refusal = "no NRRD file: it does not begin with NRRD000",
    .find = nrrd_find,
};
