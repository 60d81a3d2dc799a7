/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * NumPy array: 93 4e 55 4d 50 59, a version, the length of the header, and the header. The header is a
 * dictionary as text: {'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }. The array is [row,
 * column]; it has neither spacing nor unit. One dimension is a profile. NPZ is a ZIP archive of such files.
 */
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/format.h"

enum {
    MAGIC = 6
};

/* clang-format off */
static const struct {
    const char *name; /* the type after the mark of the byte order */
    enum rc_raw raw;
} types[] = {
    {"f8", RC_RAW_F64}, {"f4", RC_RAW_F32}, {"i1", RC_RAW_I8},  {"i2", RC_RAW_I16},
    {"i4", RC_RAW_I32}, {"i8", RC_RAW_I64}, {"u1", RC_RAW_U8},  {"u2", RC_RAW_U16},
    {"u4", RC_RAW_U32}, {"u8", RC_RAW_U64},
};
/* clang-format on */

static bool
has_magic(const struct rc_file *file)
{
    return rc_file_holds(file, 0, "\x93NUMPY", MAGIC);
}

/* The text after 'key': in the dictionary; empty if the key is missing. */
static struct rc_piece
value_of(struct rc_piece header, const char *key)
{
    const char *at = rc_piece_find(header, key), *end = header.text + header.n;

    if (at == NULL || (at = memchr(at, ':', (size_t)(end - at))) == NULL)
        return (struct rc_piece){header.text, 0};
    return rc_piece_trim((struct rc_piece){at + 1, (size_t)(end - at - 1)});
}

static enum rc_status
read_type(struct rc_piece value, struct rc_map *map, struct rc_err *err)
{
    const char *end = value.n > 1 ? memchr(value.text + 1, *value.text, value.n - 1) : NULL;
    size_t shown = end != NULL ? (size_t)(end + 1 - value.text) : value.n < 12 ? value.n : 12;

    for (size_t k = 0; k < sizeof types / sizeof *types && value.n >= 5; k++)
        if ((*value.text == '\'' || *value.text == '"') && value.text[4] == *value.text &&
            strchr("<>|=", value.text[1]) != NULL &&
            memcmp(value.text + 2, types[k].name, 2) == 0) {
            map->raw = types[k].raw;
            map->big = value.text[1] == '>';
            return RC_OK;
        }
    return rc_err_set(err, "the array is of type %s: real numbers of 1 to 8 bytes are read",
                      rc_text_shown(value.text, shown));
}

/* "(2, 3)" or "(7,)" */
static enum rc_status
read_shape(struct rc_piece value, struct rc_map *map, struct rc_err *err)
{
    double size[3] = {0};
    size_t n = 0;
    const char *end = value.n == 0 ? NULL : memchr(value.text, ')', value.n);
    struct rc_piece first, rest;

    if (end == NULL || *value.text != '(')
        return rc_err_set(err, "the header gives no shape");
    rest = (struct rc_piece){value.text + 1, (size_t)(end - value.text - 1)};
    while (n < 3 && rest.n > 0) {
        if (!rc_piece_part(rest, ",", &first, &rest)) {
            first = rc_piece_trim(rest);
            rest.n = 0;
        }
        if (!rc_piece_number(first, &size[n++], &first) || first.n > 0)
            n = 3;
    }
    if (n == 0 || n > 2)
        return rc_err_set(err, "the shape is %s: a map has two dimensions, a profile one",
                          rc_text_shown(value.text, (size_t)(end - value.text + 1)));
    if (n == 1) {
        size[1] = size[0];
        size[0] = 1;
    }
    if (rc_map_count("rows", size[0], &map->ny, err) != RC_OK)
        return RC_FAIL;
    return rc_map_count("columns", size[1], &map->nx, err);
}

/* Describes the array in a file as a map. */
static enum rc_status
read_header(const struct rc_file *file, struct rc_map *map, struct rc_err *err)
{
    struct rc_bytes b = rc_file_bytes(file, false);
    struct rc_piece header;
    size_t n;
    int version;

    if (!has_magic(file))
        return rc_err_set(err, "no NumPy array: it does not begin with 93 'NUMPY'");
    version = (int)rc_bytes_at(&b, MAGIC, RC_RAW_U8);
    if (version < 1 || version > 3)
        return rc_err_set(err, "the file is of version %d: 1 to 3 are read", version);
    n = (size_t)rc_bytes_at(&b, MAGIC + 2, version == 1 ? RC_RAW_U16 : RC_RAW_U32);
    if (b.past || n > file->size - b.at)
        return rc_err_set(err, "the header has %zu bytes, the file %zu", n, file->size);
    header = (struct rc_piece){(const char *)file->data + b.at, n};
    map->at = b.at + n;
    map->by_columns = rc_piece_begins(value_of(header, "'fortran_order'"), "True");
    if (read_type(value_of(header, "'descr'"), map, err) != RC_OK)
        return RC_FAIL;
    return read_shape(value_of(header, "'shape'"), map, err);
}

/* ---- archives of arrays ---- */

/* The array of a member, unpacked, which the caller frees; NULL with the reason. */
static unsigned char *
unpack_array(struct rc_zip_read *archive, const struct rc_file *file, size_t member,
             struct rc_file *array, struct rc_err *err)
{
    unsigned char *data =
        rc_zip_read_bytes(archive, member, rc_memory_limit(file->size), &array->size, NULL, err);

    array->name = "array.npy";
    array->data = data;
    return data;
}

static unsigned char *
unpack(const struct rc_file *file, const struct rc_map *map, size_t *n, struct rc_err *err)
{
    RC_OWN(rc_zip_read, archive) = rc_zip_read_new(file, err);

    return archive == NULL
               ? NULL
               : rc_zip_read_bytes(archive, map->more, rc_memory_limit(file->size), n, NULL, err);
}

static bool
is_array(const char *name)
{
    size_t n = strlen(name);

    return n > 4 && strcmp(name + n - 4, ".npy") == 0;
}

/* Arrays of one or two dimensions; others are passed over. */
static enum rc_status
npz_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    RC_OWN(rc_zip_read, archive) = rc_zip_read_new(file, err);
    size_t members = archive == NULL ? 0 : rc_zip_read_members(archive);
    struct rc_err why = {"the archive has no array (NAME.npy)"};

    for (size_t k = 0; k < members; k++) {
        const char *name = rc_zip_read_name(archive, k);
        struct rc_map *map, one = {.si = 1, .scale = 1};
        struct rc_file array;
        RC_OWNED unsigned char *data = NULL;

        if (!is_array(name) || (data = unpack_array(archive, file, k, &array, &why)) == NULL)
            continue;
        if (read_header(&array, &one, &why) == RC_OK &&
            rc_map_bound(&one, file, (double)array.size, &why) == RC_OK) {
            map = rc_maps_add(maps, (struct rc_piece){name, strlen(name) - 4});
            map->nx = one.nx;
            map->ny = one.ny;
            map->by_columns = one.by_columns;
            map->beside = one.beside;
            map->raw = one.raw;
            map->big = one.big;
            map->at = one.at;
            map->unpack = unpack;
            map->more = k;
        }
    }
    if (archive == NULL)
        return RC_FAIL;
    return maps->n > 0 ? RC_OK : rc_err_set(err, "%s", why.text);
}

/* ---- the entry in formats.list ---- */

static enum rc_status
npy_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    return rc_file_holds(file, 0, "PK", 2)
               ? npz_find(file, maps, err)
               : read_header(file, rc_maps_add(maps, rc_piece_of("")), err);
}

static int
npy_score(const struct rc_file *file)
{
    RC_OWN(rc_zip_read, archive) = NULL;
    size_t first;
    bool array;

    if (has_magic(file))
        return 95;
    if (!rc_file_holds(file, 0, "PK", 2) || (archive = rc_zip_read_new(file, NULL)) == NULL)
        return 0;
    array = rc_zip_read_files(archive, &first) > 0 && is_array(rc_zip_read_name(archive, first));
    return array ? 85 : 0;
}

const struct rc_format rc_format_npy = {
    .name = "npy",
    .suffixes = ".npy .npz",
    .summary = "NumPy arrays of one or two dimensions, in archives too",
    .score = npy_score,
    .find = npy_find,
};
