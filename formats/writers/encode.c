/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "encode.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* ---- a growing buffer ---- */

static bool
reserve(struct rc_buffer *b, size_t n)
{
    size_t capacity = b->capacity == 0 ? 256 : b->capacity;
    char *more;

    if (b->failed)
        return false;
    while (capacity - b->n <= n && capacity < SIZE_MAX / 2)
        capacity *= 2;
    if (capacity == b->capacity)
        return true;
    if (capacity - b->n <= n || (more = realloc(b->bytes, capacity)) == NULL) {
        rc_buffer_free(b);
        b->failed = true;
        return false;
    }
    b->bytes = more;
    b->capacity = capacity;
    return true;
}

void
rc_buffer_add(struct rc_buffer *b, const void *bytes, size_t n)
{
    if (!reserve(b, n))
        return;
    memcpy(b->bytes + b->n, bytes, n);
    b->n += n;
    b->bytes[b->n] = '\0';
}

void
rc_buffer_print(struct rc_buffer *b, const char *format, ...)
{
    va_list ap;
    int n;

    va_start(ap, format);
    n = vsnprintf(NULL, 0, format, ap);
    va_end(ap);
    if (n < 0 || !reserve(b, (size_t)n))
        return;
    va_start(ap, format);
    vsnprintf(b->bytes + b->n, b->capacity - b->n, format, ap);
    va_end(ap);
    b->n += (size_t)n;
}

void
rc_buffer_escaped(struct rc_buffer *b, const char *text)
{
    char c[RC_ENTITY];

    for (; *text != '\0'; text++)
        rc_buffer_print(b, "%s", rc_xml_character(c, *text));
}

static void
store(unsigned char *to, uint64_t value, size_t n)
{
    for (size_t k = 0; k < n; k++)
        to[k] = (unsigned char)(value >> 8 * k);
}

static void
add_number(struct rc_buffer *b, uint64_t value, size_t n)
{
    unsigned char bytes[8];

    store(bytes, value, n);
    rc_buffer_add(b, bytes, n);
}

void
rc_buffer_u16(struct rc_buffer *b, uint16_t value)
{
    add_number(b, value, 2);
}

void
rc_buffer_u32(struct rc_buffer *b, uint32_t value)
{
    add_number(b, value, 4);
}

void
rc_buffer_u64(struct rc_buffer *b, uint64_t value)
{
    add_number(b, value, 8);
}

void
rc_buffer_f32(struct rc_buffer *b, float value)
{
    uint32_t word;

    memcpy(&word, &value, sizeof word);
    rc_buffer_u32(b, word);
}

void
rc_buffer_f64(struct rc_buffer *b, double value)
{
    uint64_t word;

    memcpy(&word, &value, sizeof word);
    rc_buffer_u64(b, word);
}

void
rc_buffer_free(struct rc_buffer *b)
{
    free(b->bytes);
    *b = (struct rc_buffer){0};
}

enum rc_status
rc_buffer_write(const struct rc_buffer *b, FILE *out, struct rc_err *err)
{
    if (b->failed)
        return rc_err_set(err, "out of memory");
    return rc_put(out, b->bytes, b->n, err);
}

/* ---- values ---- */

enum rc_status
rc_range_of(const struct rc_grid *g, struct rc_range *range, struct rc_err *err)
{
    size_t n = g->nx * g->ny;

    *range = (struct rc_range){.min = INFINITY, .max = -INFINITY};
    for (size_t k = 0; k < n; k++) {
        if (isnan(g->v[k])) {
            range->missing++;
            continue;
        }
        if (isinf(g->v[k]))
            return rc_err_set(err,
                              "the value at column %zu, row %zu (from 0) is infinite: this format "
                              "cannot say that",
                              k % g->nx, k / g->nx);
        range->min = fmin(range->min, g->v[k]);
        range->max = fmax(range->max, g->v[k]);
    }
    if (range->missing == n)
        range->min = range->max = 0;
    return RC_OK;
}

struct rc_code
rc_code_for(enum rc_raw raw, const struct rc_range *range, int32_t low, int32_t high,
            int32_t missing)
{
    struct rc_code code = {.raw = raw, .increment = 1, .missing = missing};
    double step = (range->max - range->min) / ((double)high - low);

    if (raw == RC_RAW_F32 || raw == RC_RAW_F64)
        return code;
    if (step > 0) {
        code.increment = step;
        code.offset = range->min - low * step;
    } else { /* a single height, or heights that differ by less than doubles can resolve: all are
                number 0 */
        code.offset = range->min;
    }
    return code;
}

static enum rc_status
encode_one(const struct rc_code *c, double value, unsigned char *to, struct rc_err *err)
{
    float f32 = (float)value;
    uint64_t f64;
    uint32_t word;
    double number, most;

    switch (c->raw) {
    case RC_RAW_F64:
        memcpy(&f64, &value, sizeof f64);
        store(to, f64, 8);
        return RC_OK;
    case RC_RAW_F32:
        if (isinf(f32) && isfinite(value))
            return rc_err_set(err, "%g is too large for the type f32: write f64", value);
        memcpy(&word, &f32, sizeof word);
        store(to, word, 4);
        return RC_OK;
    default:
        number = isnan(value) ? c->missing : rint((value - c->offset) / c->increment);
        most = c->raw == RC_RAW_I16 ? INT16_MAX : INT32_MAX;
        if (number > most || number < -most - 1)
            return rc_err_set(err, "%g is out of the range of the integers in the file", value);
        store(to, (uint64_t)(int64_t)number, rc_raw_width(c->raw));
        return RC_OK;
    }
}

enum rc_status
rc_encode(const struct rc_code *c, const double *v, size_t n, unsigned char *to, struct rc_err *err)
{
    size_t width = rc_raw_width(c->raw);

    for (size_t k = 0; k < n; k++)
        if (encode_one(c, v[k], to + k * width, err) != RC_OK)
            return RC_FAIL;
    return RC_OK;
}

enum rc_status
rc_encode_file(const struct rc_code *c, const double *v, size_t n, FILE *out, struct rc_err *err)
{
    enum {
        VALUES = 4096
    };
    unsigned char bytes[VALUES * 8];

    for (size_t k = 0; k < n; k += VALUES) {
        size_t now = n - k < VALUES ? n - k : VALUES;
        if (rc_encode(c, v + k, now, bytes, err) != RC_OK ||
            rc_put(out, bytes, now * rc_raw_width(c->raw), err) != RC_OK)
            return RC_FAIL;
    }
    return RC_OK;
}
