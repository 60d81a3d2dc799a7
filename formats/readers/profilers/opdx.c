/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Dektak OPDx (Bruker Vision64) has "VCA DATA" and a tree of items, little-endian. An item is a name (32 bits
 * of length, the bytes), a byte for the type, and a value. Profiles are doubles below 1D_Data, maps are
 * floats below 2D_Data; extents reach from the first point to the last.
 */
#include <math.h>
#include <string.h>

#include "formats/format.h"

enum {
    START = 12,
    DEEPEST = 8,
    ARRAY_LEAD = 5, /* bytes before the numbers of an array: type, size */
    MATRIX_LEAD = 8 /* u32 rows, columns                                */
};

enum how {
    FIXED,     /* so many bytes                           */
    SIZED,     /* a length, the bytes                     */
    TYPED,     /* the name of a type, a length, the bytes */
    MATRIX,    /* the same with more between them         */
    CONTAINER, /* a length, items                         */
    END
};

/* clang-format off */
static const struct {
    int type;
    enum how how;
    size_t n;
    enum rc_raw raw;
} types[] = {
    {0x00, MATRIX, 0, 0},          {0x01, FIXED, 1, RC_RAW_U8},   {0x04, FIXED, 2, RC_RAW_I16},
    {0x05, FIXED, 2, RC_RAW_U16},  {0x06, FIXED, 4, RC_RAW_I32},  {0x07, FIXED, 4, RC_RAW_U32},
    {0x0a, FIXED, 8, RC_RAW_I64},  {0x0b, FIXED, 8, RC_RAW_U64},  {0x0c, FIXED, 4, RC_RAW_F32},
    {0x0d, FIXED, 8, RC_RAW_F64},  {0x0e, TYPED, 0, 0},           {0x12, SIZED, 0, 0},
    {0x13, SIZED, 0, 0},           {0x15, FIXED, 9, 0},           {0x18, SIZED, 0, 0},
    {0x40, TYPED, 0, 0},           {0x42, TYPED, 0, 0},           {0x45, TYPED, 0, 0},
    {0x46, CONTAINER, 0, 0},       {0x47, CONTAINER, 0, 0},       {0x7c, TYPED, 0, 0},
    {0x7d, CONTAINER, 0, 0},       {0x7f, END, 0, 0},
};
/* clang-format on */

struct quantity {
    double value;
    struct rc_piece unit;
};

struct channel {
    struct rc_piece name, kind;
    bool is_map;
    double points, columns, rows;
    struct quantity x, y, scale;
    size_t at, n; /* the numbers */
};

struct opdx {
    const struct rc_file *file;
    struct rc_maps *maps;
    struct channel channel[RC_MAPS_MOST];
    size_t channels;
};

/* ---- items ---- */

static bool
take_text(struct rc_bytes *b, size_t end, struct rc_piece *text)
{
    size_t n = rc_bytes_u32(b);

    if (b->past || b->at > end || n > end - b->at)
        return false;
    *text = (struct rc_piece){(const char *)b->data + b->at, n};
    b->at += n;
    return true;
}

static bool
take_length(struct rc_bytes *b, size_t end, size_t *n)
{
    double width = rc_bytes_at(b, b->at, RC_RAW_U8);

    if (width != 1 && width != 2 && width != 4)
        return false;
    *n = width == 1   ? (size_t)rc_bytes_at(b, b->at, RC_RAW_U8)
         : width == 2 ? rc_bytes_u16(b)
                      : rc_bytes_u32(b);
    return !b->past && b->at <= end && *n <= end - b->at;
}

static struct quantity
quantity_at(const struct opdx *o, size_t at, size_t n)
{
    struct rc_bytes b = rc_file_bytes(o->file, false);
    struct quantity q = {.value = NAN, .unit = {"", 0}};
    struct rc_piece name;
    double value;

    if (n < 8)
        return q;
    value = rc_bytes_at(&b, at, RC_RAW_F64);
    if (take_text(&b, at + n, &name) && take_text(&b, at + n, &q.unit))
        q.value = value;
    return q;
}

static struct channel *
channel_of(struct opdx *o, struct rc_piece name, bool is_map)
{
    size_t k = 0;

    while (k < o->channels && (o->channel[k].is_map != is_map || o->channel[k].name.n != name.n ||
                               memcmp(o->channel[k].name.text, name.text, name.n) != 0))
        k++;
    if (k == RC_MAPS_MOST)
        return NULL;
    if (k == o->channels) {
        const struct quantity none = {NAN, {"", 0}};
        o->channel[o->channels++] = (struct channel){
            .name = name, .kind = {"", 0}, .is_map = is_map, .x = none, .y = none, .scale = none};
    }
    return &o->channel[k];
}

/* An item at /1D_Data/channel/name or /2D_Data/channel/name. */
static void
take_of_channel(struct opdx *o, const struct rc_piece *path, double number, size_t at, size_t n)
{
    bool is_map = rc_piece_is(path[0], "2D_Data");
    struct channel *c = channel_of(o, path[1], is_map);
    struct rc_bytes b = rc_file_bytes(o->file, false);
    struct rc_piece name = path[2];

    if (c == NULL)
        return;
    if (rc_piece_is(name, "NumPoints"))
        c->points = number;
    else if (rc_piece_is(name, "Dimension1Points"))
        c->rows = number;
    else if (rc_piece_is(name, "Dimension2Points"))
        c->columns = number;
    else if (rc_piece_is(name, is_map ? "Dimension2Extent" : "Extent"))
        c->x = quantity_at(o, at, n);
    else if (rc_piece_is(name, "Dimension1Extent"))
        c->y = quantity_at(o, at, n);
    else if (rc_piece_is(name, "DataScale"))
        c->scale = quantity_at(o, at, n);
    else if (rc_piece_is(name, "DataKind"))
        c->kind = (struct rc_piece){(const char *)o->file->data + at, n};
    else if (rc_piece_is(name, "Array") && !is_map && n >= ARRAY_LEAD) {
        c->at = at + ARRAY_LEAD;
        c->n = n - ARRAY_LEAD;
    } else if (rc_piece_is(name, "Matrix") && is_map && n >= MATRIX_LEAD) {
        c->rows = rc_bytes_at(&b, at, RC_RAW_U32);
        c->columns = rc_bytes_at(&b, at + 4, RC_RAW_U32);
        c->at = at + MATRIX_LEAD;
        c->n = n - MATRIX_LEAD;
    }
}

static void
take_item(struct opdx *o, const struct rc_piece *path, size_t depth, double number, size_t at,
          size_t n)
{
    static const struct rc_keep keys[] = {
        {"Date", "file.date"},
        {"Time", "file.time"},
        {"InstrumentName", "file.model"},
        {"InstrumentSerial", "file.serial"},
        {"SerialNumber", "file.serial"},
        {"Operator", "file.operator"},
    };

    if (depth == 3 && rc_piece_is(path[0], "1D_Data|2D_Data"))
        take_of_channel(o, path, number, at, n);
    if (depth >= 2 && rc_piece_is(path[0], "MetaData"))
        rc_maps_keep(o->maps, keys, sizeof keys / sizeof *keys, path[depth - 1],
                     (struct rc_piece){(const char *)o->file->data + at, n});
}

/* The length of the value of an item of types[kind], at which *b then stands; false when it does
 * not end before `end`. */
static bool
measure(struct rc_bytes *b, size_t end, size_t kind, size_t *n)
{
    struct rc_piece text;

    if (types[kind].how == FIXED) {
        *n = types[kind].n;
        return *n <= end - b->at;
    }
    if ((types[kind].how == TYPED || types[kind].how == MATRIX) && !take_text(b, end, &text))
        return false;
    if (types[kind].how == MATRIX) {
        rc_bytes_u32(b);
        if (b->at > end || !take_text(b, end, &text))
            return false;
    }
    return take_length(b, end, n);
}

static enum rc_status
walk(struct opdx *o, struct rc_bytes *b, size_t end, struct rc_piece *path, size_t depth,
     struct rc_err *err)
{
    while (b->at < end) {
        size_t start = b->at, kind = 0, n = 0, at;
        double number = NAN;
        int type;

        if (depth == DEEPEST || !take_text(b, end, &path[depth]) || b->at >= end)
            return rc_err_set(err, "an item at byte %zu does not end, or lies too deep", start);
        type = (int)rc_bytes_at(b, b->at, RC_RAW_U8);
        while (kind < sizeof types / sizeof *types && types[kind].type != type)
            kind++;
        if (kind == sizeof types / sizeof *types)
            return rc_err_set(err, "item '%s' at byte %zu is of type %d, which is not known",
                              rc_piece_shown(path[depth]), start, type);
        if (types[kind].how == END)
            break;
        if (!measure(b, end, kind, &n))
            return rc_err_set(err, "item '%s' at byte %zu does not end inside its container",
                              rc_piece_shown(path[depth]), start);
        at = b->at;
        if (types[kind].how == CONTAINER) {
            if (walk(o, b, at + n, path, depth + 1, err) != RC_OK)
                return RC_FAIL;
        } else {
            if (types[kind].how == FIXED && n <= 8)
                number = rc_bytes_at(b, at, types[kind].raw);
            take_item(o, path, depth + 1, number, at, n);
        }
        b->at = at + n;
    }
    return RC_OK;
}

/* ---- maps ---- */

/* The extent of n points as the step between them. */
static double
step(struct quantity extent, double n)
{
    return extent.value * rc_piece_metres(extent.unit) / (n > 1 ? n - 1 : 1);
}

static enum rc_status
add_channel(struct opdx *o, const struct channel *c, struct rc_err *err)
{
    struct rc_map *map = rc_maps_add(o->maps, c->name);
    double columns = c->is_map ? c->columns : c->points, rows = c->is_map ? c->rows : 1;

    if (rc_map_size(map, columns, NULL, rows, NULL, err) != RC_OK)
        return RC_FAIL;
    map->raw = c->is_map ? RC_RAW_F32 : RC_RAW_F64;
    if ((double)c->n < columns * rows * (double)rc_raw_width(map->raw))
        return rc_err_set(err, "channel '%s': %zu x %zu values are promised, %zu bytes are there",
                          map->name, map->nx, map->ny, c->n);
    map->at = c->at;
    map->scale = c->scale.value;
    map->dx = step(c->x, columns);
    map->dy = c->is_map ? step(c->y, rows) : map->dx;
    rc_map_unit(map, c->scale.unit);
    return RC_OK;
}

static enum rc_status
opdx_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_bytes b = rc_file_bytes(file, false);
    struct opdx o = {.file = file, .maps = maps};
    struct rc_piece path[DEEPEST + 1];

    b.at = START;
    if (walk(&o, &b, file->size, path, 0, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < o.channels; k++)
        if (o.channel[k].n > 0 && add_channel(&o, &o.channel[k], err) != RC_OK)
            return RC_FAIL;
    if (maps->n == 0)
        return rc_err_set(err, "the file has neither a profile nor a map");
    return RC_OK;
}

const struct rc_format rc_format_opdx = {
    .name = "opdx",
    .suffixes = ".opdx",
    .summary = "Dektak OPDx (Bruker Vision64), profiles and maps",
    .magic = {{"VCA DATA", 8}},
    .refusal = "no OPDx file: it does not begin with VCA DATA",
    .find = opdx_find,
};
