/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cdf.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

enum {
    DIMENSIONS = 10, /* tags of lists */
    VARIABLES = 11,
    ATTRIBUTES = 12,
    DIMENSIONS_MOST = 1024,
    VARIABLES_MOST = 4096,
    RANK_MOST = 1024
};

/* The type of the numbers, by the code of the file; text counts as numbers of 8 bits. */
static const enum rc_raw raws[RC_CDF_TYPES] = {RC_RAW_I8,  RC_RAW_I8,  RC_RAW_U8,  RC_RAW_I16,
                                               RC_RAW_I32, RC_RAW_F32, RC_RAW_F64, RC_RAW_U8,
                                               RC_RAW_U16, RC_RAW_U32, RC_RAW_I64, RC_RAW_U64};

/* A count or a size. It has 64 bits in version 5. */
static uint64_t
count(struct rc_cdf *f)
{
    return f->version == 5 ? rc_bytes_u64(&f->b) : rc_bytes_u32(&f->b);
}

/* Skips the next n bytes and their padding to a multiple of four. */
static struct rc_piece
bytes(struct rc_cdf *f, uint64_t n)
{
    size_t there = f->b.size - f->b.at;
    struct rc_piece p = {(const char *)f->b.data + f->b.at, (size_t)n};

    if (n > there || (n + 3) / 4 * 4 > there) {
        f->b.past = true;
        return (struct rc_piece){"", 0};
    }
    f->b.at += (size_t)((n + 3) / 4 * 4);
    return p;
}

bool
rc_cdf_is(struct rc_piece p, const char *word)
{
    return p.n == strlen(word) && memcmp(p.text, word, p.n) == 0;
}

size_t
rc_cdf_width(unsigned type)
{
    return rc_raw_width(raws[type]);
}

double
rc_cdf_value(const unsigned char *at, unsigned type)
{
    struct rc_bytes b = {.data = at, .size = rc_cdf_width(type), .big = true};

    return rc_bytes_at(&b, 0, raws[type]);
}

static enum rc_status
list_of(struct rc_cdf *f, uint32_t tag, const char *what, uint64_t most, uint64_t *n,
        struct rc_err *err)
{
    uint32_t got = rc_bytes_u32(&f->b);

    *n = count(f);
    if (f->b.past)
        return rc_err_set(err, "the header is cut off before its %s", what);
    if (got == 0 && *n == 0)
        return RC_OK;
    if (got != tag)
        return rc_err_set(err, "the list of %s begins with %u, not %u", what, (unsigned)got,
                          (unsigned)tag);
    if (*n > most)
        return rc_err_set(err, "a list of %llu %s: more than the %llu that are read",
                          (unsigned long long)*n, what, (unsigned long long)most);
    return RC_OK;
}

static enum rc_status
read_dimensions(struct rc_cdf *f, struct rc_err *err)
{
    uint64_t n;

    if (list_of(f, DIMENSIONS, "dimensions", DIMENSIONS_MOST, &n, err) != RC_OK)
        return RC_FAIL;
    if ((f->dimension = calloc((size_t)n + 1, sizeof *f->dimension)) == NULL)
        return rc_err_set(err, "out of memory for %zu dimensions", (size_t)n);
    for (f->dimensions = 0; f->dimensions < n && !f->b.past; f->dimensions++) {
        struct rc_cdf_dimension *d = &f->dimension[f->dimensions];
        d->name = bytes(f, count(f));
        d->length = count(f);
    }
    return f->b.past ? rc_err_set(err, "the header is cut off in its dimensions") : RC_OK;
}

static void
take_attribute(struct rc_cdf_variable *v, struct rc_piece name, unsigned type, uint64_t n,
               struct rc_piece p)
{
    const unsigned char *at = (const unsigned char *)p.text;

    if (type == RC_CDF_CHAR && (rc_cdf_is(name, "unit") || rc_cdf_is(name, "units")))
        v->unit = p;
    else if (type == RC_CDF_CHAR && rc_cdf_is(name, "long_name"))
        v->title = p;
    if (type == RC_CDF_CHAR || n != 1)
        return;
    if (rc_cdf_is(name, "_FillValue") || (rc_cdf_is(name, "missing_value") && isnan(v->fill)))
        v->fill = rc_cdf_value(at, type);
    else if (rc_cdf_is(name, "scale_factor"))
        v->factor = rc_cdf_value(at, type);
    else if (rc_cdf_is(name, "add_offset"))
        v->offset = rc_cdf_value(at, type);
    else if (rc_cdf_is(name, "periodic"))
        v->period = rc_cdf_value(at, type);
}

/* Reads the attributes of a variable; with NULL, skips the attributes of the file. */
static enum rc_status
read_attributes(struct rc_cdf *f, struct rc_cdf_variable *v, struct rc_err *err)
{
    uint64_t n, k;

    if (list_of(f, ATTRIBUTES, "attributes", f->b.size, &n, err) != RC_OK)
        return RC_FAIL;
    for (k = 0; k < n && !f->b.past; k++) {
        struct rc_piece name = bytes(f, count(f)), p;
        uint32_t type = rc_bytes_u32(&f->b);
        uint64_t values = count(f);

        if (f->b.past || type == 0 || type >= RC_CDF_TYPES || values > f->b.size)
            return rc_err_set(err, "attribute %llu is damaged or cut off",
                              (unsigned long long)k + 1);
        p = bytes(f, values * rc_cdf_width(type));
        if (v != NULL && !f->b.past)
            take_attribute(v, name, type, values, p);
    }
    return f->b.past ? rc_err_set(err, "the header is cut off in its attributes") : RC_OK;
}

static enum rc_status
read_variable(struct rc_cdf *f, struct rc_cdf_variable *v, struct rc_err *err)
{
    uint64_t rank;

    *v = (struct rc_cdf_variable){
        .unit = {"", 0}, .title = {"", 0}, .fill = NAN, .factor = 1, .lead = 1};
    v->name = bytes(f, count(f));
    rank = count(f);
    if (f->b.past || rank > RANK_MOST)
        return rc_err_set(err, "variable %zu is damaged or cut off", f->variables + 1);
    v->rank = (size_t)rank;
    for (size_t k = 0; k < v->rank; k++) {
        uint64_t id = count(f);
        if (id >= f->dimensions)
            return rc_err_set(err, "variable '%s' has dimension %llu of %zu",
                              rc_piece_shown(v->name), (unsigned long long)id, f->dimensions);
        if (k == 0)
            v->first = (size_t)id;
        if (k + 2 >= v->rank)
            v->dimension[v->rank < 2 ? 0 : k + 2 - v->rank] = (size_t)id;
        else if ((f->dimension[id].length == 0 ? f->records : f->dimension[id].length) != 1)
            v->lead = 2; /* or more */
    }
    if (read_attributes(f, v, err) != RC_OK)
        return RC_FAIL;
    v->type = rc_bytes_u32(&f->b);
    v->size = count(f);
    v->at = f->version == 1 ? rc_bytes_u32(&f->b) : rc_bytes_u64(&f->b);
    if (f->b.past || v->type == 0 || v->type >= RC_CDF_TYPES)
        return rc_err_set(err, "variable '%s' is cut off, or of the unknown type %u",
                          rc_piece_shown(v->name), v->type);
    return RC_OK;
}

bool
rc_cdf_has_records(const struct rc_cdf *f, const struct rc_cdf_variable *v)
{
    return v->rank > 0 && f->dimension[v->first].length == 0;
}

static enum rc_status
read_variables(struct rc_cdf *f, struct rc_err *err)
{
    size_t with_records = 0;
    uint64_t n;

    if (list_of(f, VARIABLES, "variables", VARIABLES_MOST, &n, err) != RC_OK)
        return RC_FAIL;
    if (n > f->b.size / 16) /* each variable takes at least this much of the header */
        return rc_err_set(err, "a list of %llu variables in %zu bytes", (unsigned long long)n,
                          f->b.size);
    if ((f->variable = calloc((size_t)n + 1, sizeof *f->variable)) == NULL)
        return rc_err_set(err, "out of memory for %zu variables", (size_t)n);
    for (; f->variables < n; f->variables++)
        if (read_variable(f, &f->variable[f->variables], err) != RC_OK)
            return RC_FAIL;
    for (size_t k = 0; k < f->variables; k++)
        if (rc_cdf_has_records(f, &f->variable[k])) {
            if (f->variable[k].size > f->b.size)
                return rc_err_set(err, "a record promises %llu bytes, the file has %zu",
                                  (unsigned long long)f->variable[k].size, f->b.size);
            f->record += f->variable[k].size;
            with_records++;
        }
    /* a single variable with records is not padded */
    for (size_t k = 0; k < f->variables && with_records == 1; k++)
        if (rc_cdf_has_records(f, &f->variable[k]) && f->variable[k].rank == 2) {
            const struct rc_cdf_variable *v = &f->variable[k];
            f->record = f->dimension[v->dimension[1]].length * rc_cdf_width(v->type);
        }
    return RC_OK;
}

void
rc_cdf_close(struct rc_cdf *f)
{
    free(f->dimension);
    free(f->variable);
}

enum rc_status
rc_cdf_open(struct rc_cdf *f, const struct rc_file *file, struct rc_err *err)
{
    *f = (struct rc_cdf){.b = {.data = file->data, .size = file->size, .big = true}};
    if (file->size < 8 || !rc_file_holds(file, 0, "CDF", 3))
        return rc_err_set(err, "no NetCDF file: it does not begin with 'CDF'");
    f->version = file->data[3];
    if (f->version != 1 && f->version != 2 && f->version != 5)
        return rc_err_set(err, "version %u of NetCDF: only 1, 2 and 5 are read here", f->version);
    f->b.at = 4;
    f->records = count(f);
    if (read_dimensions(f, err) != RC_OK || read_attributes(f, NULL, err) != RC_OK)
        return RC_FAIL;
    return read_variables(f, err);
}
