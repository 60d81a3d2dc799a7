/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * MATLAB and Octave, MAT version 5 (save -v6, and -v7, which packs each variable with zlib): 128 bytes of
 * header, then variables. Each is an element: 8 bytes of type and size, and the content. An array has four
 * elements: class and flags, dimensions, name and numbers. The numbers run down the columns.
 *
 * Real arrays of two dimensions are channels. If there is none, vectors are. Their spacing comes from scalars
 * dx and dy, or from x and y: vectors, or arrays of the map's size as meshgrid makes them. Texts dunit and
 * unit name the units of these and of the values, as rc-export writes them; without them the user has to.
 *
 * Written from the description of the format that The MathWorks publishes.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "matlab.h"
#include "formats/containers/containers.h"
#include "formats/format.h"

enum {
    HEADER = 128,
    AT_VERSION = 124,
    VERSION = 0x0100,
    START = 2048, /* bytes of a packed variable in which its numbers must begin */
    /* types of elements */
    MATRIX = 14,
    PACKED = 15,
    /* classes of arrays */
    CHAR = 4,
    DOUBLE = 6,
    UINT64 = 15,
    COMPLEX = 0x800, /* the flag of complex numbers, next to the class */
};

/* Classes that are not arrays of numbers. */
static const char *const other_classes[] = {
    [1] = "a cell array", [2] = "a struct",    [3] = "an object",
    [5] = "sparse",       [16] = "a function", [17] = "an object",
};

/* Types of elements that are numbers. */
static const struct {
    uint32_t type;
    enum rc_raw raw;
} numbers[] = {
    {1, RC_RAW_I8},   {2, RC_RAW_U8},   {3, RC_RAW_I16}, {4, RC_RAW_U16},
    {5, RC_RAW_I32},  {6, RC_RAW_U32},  {7, RC_RAW_F32}, {9, RC_RAW_F64},
    {12, RC_RAW_I64}, {13, RC_RAW_U64}, {16, RC_RAW_U8}, {17, RC_RAW_U16}, /* UTF-8, UTF-16 */
};

/* An element: its type, and where its n bytes are. */
struct element {
    uint32_t type;
    size_t at, n;
};

struct variable {
    struct element whole; /* place in the file; packed or not */
    size_t unpacked;      /* unpacked bytes of a packed variable */
    char name[64];
    unsigned class;
    bool complex;
    size_t dimensions, rows, columns;
    enum rc_raw raw;
    struct element numbers; /* place in the file or, for a packed variable, in its unpacked bytes */
    double first;           /* the single number; NAN: none */
    char text[16];          /* text of class CHAR */
};

/* ---- elements ---- */

/* Reads the element at the cursor, and moves the cursor behind it. Small ones have type and size in one word.
 * b->past where it does not fit. */
static struct element
next_element(struct rc_bytes *b)
{
    struct element e = {.type = rc_bytes_u32(b)};
    bool small = e.type >> 16 != 0;

    e.n = small ? e.type >> 16 : rc_bytes_u32(b);
    e.type &= 0xffff;
    e.at = b->at;
    if (b->past || e.n > b->size - b->at || (small && e.n > 4))
        b->past = true;
    else if (small)
        b->at += b->size - b->at < 4 ? b->size - b->at : 4;
    else {
        size_t padding = e.type == PACKED ? 0 : (8 - e.n % 8) % 8, left = b->size - b->at - e.n;

        b->at += e.n + (padding < left ? padding : left);
    }
    return e;
}

static bool
find_raw(uint32_t type, enum rc_raw *raw)
{
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        if (numbers[k].type == type) {
            *raw = numbers[k].raw;
            return true;
        }
    return false;
}

static void
take_text(struct rc_bytes *b, struct variable *v)
{
    size_t n = v->numbers.n / rc_raw_width(v->raw), length = 0;
    char text[3 * sizeof v->text];

    for (size_t k = 0; k < n && k < sizeof v->text; k++) {
        double code = rc_bytes_at(b, v->numbers.at + k * rc_raw_width(v->raw), v->raw);

        length += rc_utf8_put(text + length, code >= 1 && code < 65536 ? (unsigned)code : '?');
    }
    rc_text_clean(v->text, sizeof v->text, text, length);
}

/* Reads the parts before the numbers from a window on the variable. Returns true if they are complete. */
static bool
read_head(struct rc_bytes *b, struct variable *v)
{
    struct element flags = next_element(b), sizes = next_element(b), name = next_element(b);
    struct rc_bytes at = *b;
    uint32_t word;

    if (b->past || flags.n < 4 || sizes.n < 8)
        return false;
    at.at = flags.at;
    word = rc_bytes_u32(&at);
    v->class = word & 0xff;
    v->complex = (word & COMPLEX) != 0;
    rc_text_clean(v->name, sizeof v->name, (const char *)b->data + name.at, name.n);
    at.at = sizes.at;
    v->rows = rc_bytes_u32(&at);
    v->columns = rc_bytes_u32(&at);
    v->dimensions = 2;
    for (size_t k = 2; k < sizes.n / 4; k++)
        if (rc_bytes_u32(&at) != 1)
            v->dimensions = k + 1;
    return true;
}

/* Reads the variable at the cursor, and moves the cursor behind it. RC_FAIL if it is damaged. */
static enum rc_status
next_variable(struct rc_bytes *b, struct variable *v, struct rc_err *err)
{
    unsigned char start[START];
    size_t at = b->at, values;
    struct rc_bytes window = *b;

    *v = (struct variable){.first = NAN};
    v->whole = next_element(b);
    if (b->past)
        return rc_err_set(err, "the variable at byte %zu promises more bytes than the file has",
                          at);
    window.size = v->whole.at + v->whole.n;
    window.at = v->whole.at;
    if (v->whole.type == PACKED) {
        window.data = start;
        window.size = rc_inflate_start(b->data + v->whole.at, v->whole.n, start, START);
        window.at = 0;
        if (rc_bytes_u32(&window) != MATRIX)
            return rc_err_set(err, "the packed variable at byte %zu is damaged or no array", at);
        v->unpacked = (size_t)rc_bytes_u32(&window) + 8;
    } else if (v->whole.type != MATRIX)
        return RC_OK; /* class 0: not a variable with values */
    if (!read_head(&window, v))
        return rc_err_set(err, "the array at byte %zu has no class, dimensions and name", at);
    if ((v->class < DOUBLE || v->class > UINT64) && v->class != CHAR)
        return RC_OK;
    v->numbers = next_element(&window); /* longer than the window, mostly */
    if (!find_raw(v->numbers.type, &v->raw) ||
        rc_size_mul(v->rows, v->columns, &values, NULL) != RC_OK)
        return rc_err_set(err, "the numbers of '%s' are damaged", v->name);
    if (v->dimensions == 2 && rc_bytes_agree(v->name, (uint64_t)values * rc_raw_width(v->raw),
                                             v->numbers.n, err) != RC_OK)
        return RC_FAIL;
    if (v->whole.type == MATRIX && window.past)
        return rc_err_set(err, "the numbers of '%s' go beyond it", v->name);
    window.past = false;
    if (v->class == CHAR)
        take_text(&window, v);
    else if (values > 0)
        v->first = rc_bytes_at(&window, v->numbers.at, v->raw);
    if (window.past)
        return rc_err_set(err, "'%s' is damaged", v->name);
    return RC_OK;
}

/* Puts the numbers, in the order of the file, into values[0..rows*columns). */
static enum rc_status
read_numbers(const struct rc_file *file, bool big, const struct variable *v, double *values,
             struct rc_err *err)
{
    struct rc_bytes b = rc_file_bytes(file, big);
    RC_OWNED unsigned char *all = NULL;

    if (v->whole.type == PACKED) {
        if (v->unpacked > rc_memory_limit(file->size) || v->unpacked < v->numbers.at ||
            v->numbers.n > v->unpacked - v->numbers.at)
            return rc_err_set(
                err, "'%s' promises %zu bytes of numbers in %zu unpacked bytes, the file has %zu",
                v->name, v->numbers.n, v->unpacked, file->size);
        if ((all = malloc(v->unpacked)) == NULL)
            return rc_err_set(err, "out of memory for the %zu bytes of '%s'", v->unpacked, v->name);
        if (rc_inflate("numbers", file->data + v->whole.at, v->whole.n, all, v->unpacked, err) !=
            RC_OK)
            return RC_FAIL;
        b = (struct rc_bytes){.data = all, .size = v->unpacked, .big = big};
    }
    b.at = v->numbers.at;
    rc_bytes_values(&b, v->raw, values, v->rows * v->columns);
    return RC_OK;
}

/* ---- the variables, for matlab.c ---- */

struct mat {
    struct rc_bytes b; /* a cursor on the variables */
};

static void
start(struct rc_matlab_source *s)
{
    ((struct mat *)s->arg)->b.at = HEADER;
}

static enum rc_status
next(struct rc_matlab_source *s, struct rc_matlab_array *a, struct rc_err *err)
{
    struct mat *m = s->arg;
    struct variable v;

    do {
        if (m->b.at >= m->b.size)
            return RC_OK;
        *a = (struct rc_matlab_array){.at = m->b.at, .first = NAN};
        if (next_variable(&m->b, &v, err) != RC_OK)
            return RC_FAIL;
    } while (v.class == 0 || v.name[0] == '\0'); /* data of functions has no name */
    strcpy(a->name, v.name);
    a->is_text = v.class == CHAR;
    a->rows = v.rows;
    a->columns = v.columns;
    a->more = v.dimensions - 2;
    a->first = v.first;
    strcpy(a->text, v.text);
    if (v.complex)
        a->other = "complex";
    else if ((v.class < DOUBLE || v.class > UINT64) && v.class != CHAR)
        a->other =
            v.class < sizeof other_classes / sizeof *other_classes && other_classes[v.class] != NULL
                ? other_classes[v.class]
                : "of an unknown class";
    return RC_MORE;
}

static enum rc_status
numbers_of(struct rc_matlab_source *s, const struct rc_matlab_array *a, double *values,
           struct rc_err *err)
{
    struct rc_bytes b = ((struct mat *)s->arg)->b;
    struct variable v;

    b.at = a->at;
    return next_variable(&b, &v, err) == RC_OK ? read_numbers(s->file, b.big, &v, values, err)
                                               : RC_FAIL;
}

static enum rc_status
fill_packed(const struct rc_file *file, const struct rc_map *map, double *values,
            struct rc_err *err)
{
    struct rc_bytes b = rc_file_bytes(file, map->big);
    struct variable v;

    b.at = map->more;
    return next_variable(&b, &v, err) == RC_OK ? read_numbers(file, map->big, &v, values, err)
                                               : RC_FAIL;
}

static enum rc_status
place(struct rc_matlab_source *s, const struct rc_matlab_array *a, struct rc_map *map,
      struct rc_err *err)
{
    struct rc_bytes b = ((struct mat *)s->arg)->b;
    struct variable v;

    b.at = a->at;
    if (next_variable(&b, &v, err) != RC_OK)
        return RC_FAIL;
    map->raw = v.raw;
    map->big = b.big;
    map->at = v.numbers.at;
    map->more = a->at;
    if (v.whole.type != PACKED)
        return RC_OK;
    map->fill = fill_packed;
    return rc_map_bound(map, s->file, (double)v.unpacked, err);
}

/* ---- the file ---- */

static bool
has_magic(const struct rc_file *file, bool *big)
{
    struct rc_bytes b = rc_file_bytes(file, *big = rc_file_holds(file, AT_VERSION + 2, "MI", 2));

    return (*big || rc_file_holds(file, AT_VERSION + 2, "IM", 2)) &&
           rc_bytes_at(&b, AT_VERSION, RC_RAW_U16) == VERSION;
}

static enum rc_status
mat_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct mat m;
    struct rc_matlab_source source = {file, &m, start, next, numbers_of, place};
    bool big;

    if (!has_magic(file, &big))
        return rc_err_set(
            err, "no MAT file of version 5: MATLAB writes one by save -v7, Octave by save -7");
    m.b = rc_file_bytes(file, big);
    return rc_matlab_maps(&source, maps, err);
}

static int
mat_score(const struct rc_file *file)
{
    bool named = rc_file_named(file, ".mat"), big;

    if (has_magic(file, &big))
        return named || rc_file_holds(file, 0, "MATLAB 5.0", 10) ? 95 : 40;
    return named; /* to name what is missing */
}

const struct rc_format rc_format_mat = {
    .name = "mat",
    .suffixes = ".mat",
    .summary = "MATLAB arrays of two dimensions, MAT version 5 (save -v6, -v7)",
    .score = mat_score,
    .find = mat_find,
};
