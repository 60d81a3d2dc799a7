/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Gwyddion's own format: GWYP and a tree of objects, little-endian. An object is its name, a NUL, its size in
 * 32 bits and its items. An item is its name, a NUL, a letter for the type and the value. At the top, items
 * /N/data are fields of doubles, /N/data/title their titles. A field /N/mask is 1 where a point is masked,
 * which is taken for missing here unless the user wishes otherwise.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/format.h"

struct item {
    struct rc_piece name;
    char type;
    size_t at, n; /* bytes of the value; those of an object begin with its name */
};

struct field {
    double nx, ny, width, height;
    size_t data, count; /* first byte, numbers */
    struct rc_piece xy, z;
};

/* Text up to a NUL. */
static bool
take_text(struct rc_bytes *b, size_t end, struct rc_piece *text)
{
    const unsigned char *s = b->data + b->at, *nul = memchr(s, 0, end - b->at);

    if (nul == NULL)
        return false;
    *text = (struct rc_piece){(const char *)s, (size_t)(nul - s)};
    b->at += text->n + 1;
    return true;
}

static bool
take_count(struct rc_bytes *b, size_t end, size_t *count)
{
    if (end - b->at < 4)
        return false;
    *count = rc_bytes_u32(b);
    return true;
}

static bool
skip(struct rc_bytes *b, size_t end, size_t count, size_t width)
{
    if (count > (end - b->at) / width)
        return false;
    b->at += count * width;
    return true;
}

/* Steps over the value of an item; false when it does not end before `end`. A capital letter is an
 * array of its small one. */
static bool
step_over(struct rc_bytes *b, size_t end, char type)
{
    static const struct {
        char one, many;
        size_t width; /* 0: texts and objects, whose lengths vary */
    } types[] = {{'b', 0, 1},   {'c', 'C', 1}, {'i', 'I', 4}, {'q', 'Q', 8},
                 {'d', 'D', 8}, {'s', 'S', 0}, {'o', 'O', 0}};
    struct rc_piece text;
    size_t k = 0, count = 1, size = 0;

    while (k < sizeof types / sizeof *types && type != types[k].one && type != types[k].many)
        k++;
    if (type == '\0' || k == sizeof types / sizeof *types ||
        (type == types[k].many && !take_count(b, end, &count)))
        return false;
    if (types[k].width > 0)
        return skip(b, end, count, types[k].width);
    for (; count > 0; count--)
        if (!take_text(b, end, &text) ||
            (types[k].one == 'o' && (!take_count(b, end, &size) || !skip(b, end, size, 1))))
            return false;
    return true;
}

/* The next item of an object; false at its end, with *err set where it is damaged. */
static bool
next_item(struct rc_bytes *b, size_t end, struct item *item, bool *damaged, struct rc_err *err)
{
    size_t start = b->at;

    if (start >= end)
        return false;
    if (!take_text(b, end, &item->name) || b->at == end) {
        rc_err_set(err, "an item at byte %zu does not end inside its object", start);
        *damaged = true;
        return false;
    }
    item->type = (char)b->data[b->at++];
    item->at = b->at;
    if (step_over(b, end, item->type)) {
        item->n = b->at - item->at;
        return true;
    }
    rc_err_set(err, "item '%s' at byte %zu has type '%c' and does not end inside its object",
               rc_piece_shown(item->name), start,
               item->type >= ' ' && item->type < 127 ? item->type : '?');
    *damaged = true;
    return false;
}

/* Moves to the first item of an object of that name and gives the object's end; 0 when it is
 * another object. */
static size_t
enter(struct rc_bytes *b, size_t end, const char *name)
{
    struct rc_piece text;
    size_t size;

    if (!take_text(b, end, &text) || !rc_piece_is(text, name) || end - b->at < 4)
        return 0;
    size = rc_bytes_u32(b);
    return size > end - b->at ? 0 : b->at + size;
}

static enum rc_status
read_unit(const struct rc_file *file, const struct item *from, struct rc_piece *unit,
          struct rc_err *err)
{
    struct rc_bytes b = rc_file_bytes(file, false);
    bool damaged = false;
    struct item item;
    size_t end;

    b.at = from->at;
    if ((end = enter(&b, from->at + from->n, "GwySIUnit")) == 0)
        return RC_OK;
    while (next_item(&b, end, &item, &damaged, err))
        if (rc_piece_is(item.name, "unitstr") && item.type == 's')
            *unit = (struct rc_piece){(const char *)file->data + item.at, item.n - 1};
    return damaged ? RC_FAIL : RC_OK;
}

static enum rc_status
read_field(const struct rc_file *file, const struct item *from, struct field *f, struct rc_err *err)
{
    static const struct {
        const char *name;
        char type;
        enum rc_raw raw;
        size_t at;
    } numbers[] = {
        {"xres", 'i', RC_RAW_I32, offsetof(struct field, nx)},
        {"yres", 'i', RC_RAW_I32, offsetof(struct field, ny)},
        {"xreal", 'd', RC_RAW_F64, offsetof(struct field, width)},
        {"yreal", 'd', RC_RAW_F64, offsetof(struct field, height)},
    };
    struct rc_bytes b = rc_file_bytes(file, false), value = b;
    bool damaged = false;
    struct item item;
    size_t end;

    *f = (struct field){.xy = {"", 0}, .z = {"", 0}};
    b.at = from->at;
    if ((end = enter(&b, from->at + from->n, "GwyDataField")) == 0)
        return rc_err_set(err, "an item that should be a GwyDataField is not one");
    while (next_item(&b, end, &item, &damaged, err)) {
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
            if (rc_piece_is(item.name, numbers[k].name) && item.type == numbers[k].type) {
                double number = rc_bytes_at(&value, item.at, numbers[k].raw);
                memcpy((char *)f + numbers[k].at, &number, sizeof number);
            }
        if (rc_piece_is(item.name, "data") && item.type == 'D') {
            f->data = item.at + 4;
            f->count = (item.n - 4) / 8;
        }
        if (item.type == 'o' &&
            ((rc_piece_is(item.name, "si_unit_xy") &&
              read_unit(file, &item, &f->xy, err) != RC_OK) ||
             (rc_piece_is(item.name, "si_unit_z") && read_unit(file, &item, &f->z, err) != RC_OK)))
            return RC_FAIL;
    }
    return damaged ? RC_FAIL : RC_OK;
}

static enum rc_status
fill_masked(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    struct rc_bytes data = rc_file_bytes(file, false), mask = data;
    size_t n = map->nx * map->ny, masked = 0;

    (void)err;
    data.at = map->at;
    rc_bytes_values(&data, RC_RAW_F64, v, n);
    for (size_t k = 0; k < n; k++)
        if (rc_bytes_at(&mask, map->more + 8 * k, RC_RAW_F64) >= 0.5) {
            masked++;
            if (!map->wish->ignore_mask)
                v[k] = NAN;
        }
    if (masked > 0)
        rc_note(map->notes, "the mask of the file covers %zu of %zu points, which are %s", masked,
                n, map->wish->ignore_mask ? "kept" : "missing: --mask ignore keeps them");
    return RC_OK;
}

/* Splits "/N/data" into N and the rest. Returns false for another name. */
static bool
part_name(struct rc_piece name, long *number, struct rc_piece *rest)
{
    char copy[64], *end;

    if (name.n < 2 || name.n >= sizeof copy || *name.text != '/' || name.text[1] < '0' ||
        name.text[1] > '9')
        return false;
    memcpy(copy, name.text + 1, name.n - 1);
    copy[name.n - 1] = '\0';
    *number = strtol(copy, &end, 10);
    *rest = (struct rc_piece){name.text + 1 + (end - copy), (size_t)(copy + name.n - 1 - end)};
    return true;
}

static enum rc_status
add_field(const struct rc_file *file, const struct item *item, struct rc_maps *maps,
          struct rc_err *err)
{
    struct rc_map *map = rc_maps_add(maps, rc_piece_of(""));
    struct field f;

    if (read_field(file, item, &f, err) != RC_OK ||
        rc_map_size(map, f.nx, "xres", f.ny, "yres", err) != RC_OK)
        return RC_FAIL;
    if ((double)f.count != f.nx * f.ny)
        return rc_err_set(err, "a field of %zu x %zu values has %zu values", map->nx, map->ny,
                          f.count);
    map->raw = RC_RAW_F64;
    map->at = f.data;
    rc_map_steps(map, f.width / f.nx, f.height / f.ny, f.xy);
    rc_map_unit(map, f.z);
    return RC_OK;
}

/* Titles and masks may come before their fields: a second pass. */
static enum rc_status
add_rest(const struct rc_file *file, const struct item *item, const char *what, struct rc_map *map,
         struct rc_err *err)
{
    struct field f;

    if (strcmp(what, "/data/title") == 0 && item->type == 's' && item->n > 1)
        rc_text_clean(map->name, sizeof map->name, (const char *)file->data + item->at,
                      item->n - 1);
    if (strcmp(what, "/mask") != 0 || item->type != 'o')
        return RC_OK;
    if (read_field(file, item, &f, err) != RC_OK)
        return RC_FAIL;
    if (f.nx != (double)map->nx || f.ny != (double)map->ny || (double)f.count != f.nx * f.ny)
        return rc_err_set(err, "the mask of '%s' has %g x %g points, not %zu x %zu", map->name,
                          f.nx, f.ny, map->nx, map->ny);
    map->more = f.data;
    map->fill = fill_masked;
    return RC_OK;
}

static enum rc_status
gwy_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    static const char *const parts[] = {"/data", "/data/title", "/mask"};
    struct rc_bytes b = rc_file_bytes(file, false);
    long number, of[RC_MAPS_MOST] = {0};
    bool damaged = false;
    size_t end, start;
    struct rc_piece rest;
    struct item item;

    b.at = 4;
    if (!rc_file_holds(file, 0, "GWYP", 4) || (end = enter(&b, file->size, "GwyContainer")) == 0)
        return rc_err_set(
            err, "not a Gwyddion file, or cut off: it must have GWYP and a complete GwyContainer");
    start = b.at;
    for (size_t p = 0; p < sizeof parts / sizeof *parts; p++)
        for (b.at = start; next_item(&b, end, &item, &damaged, err);) {
            if (!part_name(item.name, &number, &rest) || !rc_piece_is(rest, parts[p]))
                continue;
            if (p == 0 && item.type == 'o') {
                if (add_field(file, &item, maps, err) != RC_OK)
                    return RC_FAIL;
                if (maps->n <= RC_MAPS_MOST)
                    of[maps->n - 1] = number;
            }
            for (size_t k = 0; p > 0 && k < maps->n && k < RC_MAPS_MOST; k++)
                if (of[k] == number && add_rest(file, &item, parts[p], &maps->map[k], err) != RC_OK)
                    return RC_FAIL;
        }
    if (damaged)
        return RC_FAIL;
    return maps->n > 0 ? RC_OK : rc_err_set(err, "the file has no image (/0/data and so on)");
}

const struct rc_format rc_format_gwy = {
    .name = "gwy",
    .suffixes = ".gwy",
    .summary = "Gwyddion's own format: images, with their masks",
    .magic = {{"GWYP", 4}},
    .find = gwy_find,
};
