/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Createc DAT (STMAFM) has 16384 bytes of `key=value` lines, some keys twice ("Num.X / Num.X"). Then come the
 * planes in sequence, the top row first:
 *
 *     [Parameter]   int16, behind 2 bytes of nothing
 *     [Paramet32]   float, behind 4
 *     [Paramco32]   the same in a zlib stream, behind the word DATA, which may end a shorter header
 *
 * The spacing is Length x[A] over Num.X. A count of z is GainZ * ZPiezoconst * 20 V over the counts of the
 * converter, in Angstrom. Headers of real files agree, whose Z-Res. [A] is 128 * Imagegrayfactor counts. The
 * file gives a factor to five decimals, and the count is taken where it fits. The factor is Dacto[A]z, which
 * is that of gain 1 (0.00038 at 20 Angstrom per volt, whatever GainZ). It may also be the count itself, or
 * Dactonmz, the count in nanometres. If it does not fit, x decides. If Delta X times Dacto[A]xy times GainX
 * is the spacing, Dacto[A]z is to be multiplied by GainZ. If Delta X times Dacto[A]xy is, Dacto[A]z is the
 * count. If neither is, the unit of the heights is not known.
 *
 * The layout is the one that Gwyddion, createc 0.0.3 and other programs read.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/format.h"

enum {
    HEADER = 16384,
    PLANES_MOST = 64
};

static const struct kind {
    const char *magic;
    enum rc_raw raw;
    bool packed;
} kinds[] = {{"[Parameter]", RC_RAW_I16, false},
             {"[Paramet32]", RC_RAW_F32, false},
             {"[Paramco32]", RC_RAW_F32, true}};

struct createc {
    double nx, ny, planes, done; /* done: the row after the last one that was scanned, from 1 */
    double width, height;        /* Angstrom */
    double step, xy, z;          /* counts from node to node; a count in x, in z */
    double z_nm;                 /* the same, in nm for certain */
    double gain_x, gain, piezo;  /* gain: of z; Angstrom per volt */
    double bits;                 /* bits of the converter, whose range is 20 V */
};

#define TO(member) offsetof(struct createc, member)
static const struct rc_field fields[] = {
    {"Num.X", RC_FIELD_NUMBER, TO(nx)},          {"Num.Y", RC_FIELD_NUMBER, TO(ny)},
    {"Channels", RC_FIELD_NUMBER, TO(planes)},   {"ImageYPosMax", RC_FIELD_NUMBER, TO(done)},
    {"Length x[A]", RC_FIELD_NUMBER, TO(width)}, {"Length y[A]", RC_FIELD_NUMBER, TO(height)},
    {"Delta X", RC_FIELD_NUMBER, TO(step)},      {"Delta X [Dac]", RC_FIELD_NUMBER, TO(step)},
    {"Dacto[A]xy", RC_FIELD_NUMBER, TO(xy)},     {"Dacto[A]z", RC_FIELD_NUMBER, TO(z)},
    {"Dactonmz", RC_FIELD_NUMBER, TO(z_nm)},     {"GainX", RC_FIELD_NUMBER, TO(gain_x)},
    {"GainZ", RC_FIELD_NUMBER, TO(gain)},        {"ZPiezoconst", RC_FIELD_NUMBER, TO(piezo)},
};
#undef TO

static const struct rc_keep texts[] = {
    {"Titel", "file.title"},
    {"memo:0", "file.comment"},
};

static const struct kind *
kind_of(const struct rc_file *file)
{
    size_t k = 0;

    while (k + 1 < sizeof kinds / sizeof *kinds &&
           !rc_file_holds(file, 0, kinds[k].magic, strlen(kinds[k].magic)))
        k++;
    return &kinds[k];
}

/* Where the zlib stream begins: at the end of the header, or behind the first DATA that one follows. */
static size_t
stream_at(const struct rc_file *file)
{
    static const char mark[] = "DATA";
    const size_t n = sizeof mark - 1, most = file->size < HEADER ? file->size : HEADER;
    struct rc_piece rest = {(const char *)file->data, most};
    const char *found;

    while ((found = rc_piece_find(rest, mark)) != NULL) {
        size_t at = (size_t)(found - (const char *)file->data) + n;

        if (at + 2 <= file->size && file->data[at] == 0x78 &&
            (file->data[at] * 256U + file->data[at + 1]) % 31 == 0)
            return at;
        rest = (struct rc_piece){found + n, most - at};
    }
    return HEADER;
}

/* Takes a line by either of its keys; values that are not numbers, of keys that should have one, count as
 * not given. */
static void
take_line(struct rc_piece line, struct createc *c, struct rc_maps *maps)
{
    struct rc_piece key, value, first, second;

    if (!rc_piece_part(line, "=", &key, &value))
        return;
    if (!rc_piece_part(key, "/", &first, &second))
        first = second = key;
    if (rc_piece_is(key, "DAC-Type")) /* "20bit" */
        rc_piece_number(value, &c->bits, &value);
    rc_field_take(fields, sizeof fields / sizeof *fields, first, value, c, NULL);
    rc_field_take(fields, sizeof fields / sizeof *fields, second, value, c, NULL);
    rc_maps_keep(maps, texts, sizeof texts / sizeof *texts, first, value);
}

static enum rc_status
read_header(const struct rc_file *file, struct createc *c, struct rc_maps *maps, struct rc_err *err)
{
    size_t size = kind_of(file)->packed ? stream_at(file) : HEADER;
    struct rc_lines lines = {.at = (const char *)file->data};
    struct rc_piece line;

    *c = (struct createc){NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    if (file->size < size)
        return rc_err_set(err, "the header takes %zu bytes, the file has %zu", size, file->size);
    lines.end = lines.at + size;
    while (rc_lines_next(&lines, &line.text, &line.n))
        take_line(line, c, maps);
    return RC_OK;
}

/* ---- planes ---- */

static size_t
first_byte(const struct kind *kind)
{
    return (kind->packed ? 0 : HEADER) + rc_raw_width(kind->raw);
}

static unsigned char *
unpack(const struct rc_file *file, const struct rc_map *map, size_t *n, struct rc_err *err)
{
    size_t at = stream_at(file);
    RC_OWNED unsigned char *all = NULL;

    *n = map->at + map->nx * map->ny * rc_raw_width(map->raw);
    if ((all = malloc(*n)) == NULL)
        return rc_err_null(err, "out of memory for %zu bytes of planes", *n);
    return rc_inflate_start(file->data + at, file->size - at, all, *n) == *n
               ? rc_give(&all)
               : rc_err_null(err,
                             "the compressed planes are damaged or fewer than the header promises");
}

/* True if the factor agrees with the factor in the file, which has five decimals. */
static bool
is_given(double exact, double given)
{
    return exact > 0 && fabs(exact - given) <= 5.001e-6;
}

/* True if Delta X times Dacto[A]xy times this gain is the spacing. */
static bool
fits_x(const struct createc *c, double gain)
{
    double ratio = c->width / c->nx / (c->step * c->xy);

    return fabs(ratio / gain - 1) <= 0.01 + 5e-6 / fabs(c->xy);
}

static void
set_scale(struct rc_map *map, double scale, double metres)
{
    map->scale = scale;
    map->si = metres;
    strcpy(map->unit, "m");
}

static void
set_unit(const struct createc *c, struct rc_map *map)
{
    double count = c->gain * c->piezo * 20 / exp2(c->bits), bare = count / c->gain; /* Angstrom */
    double gain_x = isnan(c->gain_x) ? 10 : c->gain_x, gain_z = c->gain > 0 ? c->gain : gain_x;
    bool is_nm = !isnan(c->z_nm), fits;

    fits = is_nm         ? is_given(count / 10, c->z_nm)
           : isnan(c->z) ? count > 0
                         : is_given(count / 10, c->z) || is_given(bare, c->z);
    if (fits)
        set_scale(map, count * (1e-10 / 1e-9), 1e-9);
    else if (is_nm)
        set_scale(map, c->z_nm, 1e-9);
    else if (is_given(count, c->z))
        set_scale(map, count, 1e-10);
    else if (!isnan(c->z) && fits_x(c, gain_x))
        set_scale(map, c->z * (gain_z / 10), 1e-9);
    else if (!isnan(c->z) && fits_x(c, 1))
        set_scale(map, c->z, 1e-10);
    else
        map->scale = isnan(c->z) ? 1 : c->z; /* the user must give the unit */
}

static enum rc_status
createc_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    const struct kind *kind = kind_of(file);
    size_t nx, ny, plane, planes = 1;
    struct createc c;
    char name[32];

    if (read_header(file, &c, maps, err) != RC_OK ||
        rc_map_count("columns (Num.X)", c.nx, &nx, err) != RC_OK ||
        rc_map_count("rows (Num.Y)", c.ny, &ny, err) != RC_OK ||
        (!isnan(c.planes) && rc_map_count("planes (Channels)", c.planes, &planes, err) != RC_OK) ||
        rc_size_mul(nx, ny, &plane, err) != RC_OK ||
        rc_size_mul(plane, rc_raw_width(kind->raw), &plane, err) != RC_OK)
        return RC_FAIL;
    if (planes > PLANES_MOST)
        return rc_err_set(err, "the header promises %zu planes: up to %d are read", planes,
                          PLANES_MOST);
    if (!kind->packed &&
        (file->size < first_byte(kind) || planes > (file->size - first_byte(kind)) / plane))
        return rc_err_set(
            err,
            "the header promises %zu planes of %zu x %zu numbers, the file has %zu bytes in all",
            planes, nx, ny, file->size);
    for (size_t k = 0; k < planes; k++) {
        struct rc_map *map;

        snprintf(name, sizeof name, "Plane %zu", k + 1);
        if (k == 0)
            strcpy(name, "Topography");
        map = rc_maps_add(maps, rc_piece_of(name));
        map->nx = nx;
        map->ny = ny;
        map->dx = c.width * 1e-10 / c.nx;
        map->dy = c.height * 1e-10 / c.ny;
        map->at = first_byte(kind) + k * plane;
        map->raw = kind->raw;
        map->unpack = kind->packed ? unpack : NULL;
        map->rows = c.done >= 2 && c.done <= c.ny ? (size_t)ceil(c.done) - 1 : 0;
        if (k == 0)
            set_unit(&c, map);
        else
            strcpy(map->unit, "count");
        if (kind->packed && rc_map_bound(map, file, (double)(k + 1) * (double)plane, err) != RC_OK)
            return RC_FAIL;
    }
    return RC_OK;
}

const struct rc_format rc_format_createc = {
    .name = "createc",
    .suffixes = ".dat",
    .summary = "Createc scans (STMAFM), packed or not",
    .magic = {{"[Parameter]", 11}, {"[Paramet32]", 11}, {"[Paramco32]", 11}},
    .refusal =
        "no DAT file of Createc: it begins with none of [Parameter], [Paramet32], [Paramco32]",
    .find = createc_find,
};
