/*
 * Bytes of files that are made by hand. The numbers of every map are
 *
 *      10  20  30      and -20, -60 instead where the type has a sign;
 *      40  50  60      50 is missing where the format can say so
 */
#ifndef MADE_BYTES_H
#define MADE_BYTES_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/bytes.h"

enum {
    NX = 3,
    NY = 2,
    MISSING_AT = 4
};

struct made {
    unsigned char *b;
    size_t n, capacity;
    bool big;
};

static inline void
put(struct made *m, const void *bytes, size_t n)
{
    while (m->b == NULL || m->n + n > m->capacity) {
        m->capacity = m->capacity == 0 ? 4096 : 2 * m->capacity;
        if ((m->b = realloc(m->b, m->capacity)) == NULL)
            abort();
    }
    memcpy(m->b + m->n, bytes, n);
    m->n += n;
}

static inline void
text(struct made *m, const char *s)
{
    put(m, s, strlen(s));
}

static inline void
zeros(struct made *m, size_t n)
{
    for (; n > 0; n--)
        put(m, "", 1);
}

/* The number in that type and the byte order of m. */
static inline void
number(struct made *m, enum rc_raw raw, double value)
{
    size_t n = rc_raw_width(raw);
    unsigned char bytes[8];
    uint64_t bits;
    float f = (float)value;
    uint32_t f_bits;

    bits = value < 0 ? (uint64_t)(int64_t)value : (uint64_t)(value < 1e19 ? value : 0);
    if (raw == RC_RAW_F64)
        memcpy(&bits, &value, 8);
    if (raw == RC_RAW_F32) {
        memcpy(&f_bits, &f, 4);
        bits = f_bits;
    }
    for (size_t k = 0; k < n; k++)
        bytes[m->big ? n - 1 - k : k] = (unsigned char)(bits >> 8 * k);
    put(m, bytes, n);
}

static inline void
number_at(struct made *m, size_t at, enum rc_raw raw, double value)
{
    struct made part = {.big = m->big};

    number(&part, raw, value);
    memcpy(m->b + at, part.b, part.n);
    free(part.b);
}

static inline void
text_at(struct made *m, size_t at, const char *s)
{
    memcpy(m->b + at, s, strlen(s));
}

static inline double
value_of(size_t k, bool has_sign)
{
    static const double plain[] = {10, 20, 30, 40, 50, 60};

    return has_sign && k % 4 == 1 ? -plain[k] : plain[k];
}

static inline bool
has_sign(enum rc_raw raw)
{
    return raw != RC_RAW_U8 && raw != RC_RAW_U16 && raw != RC_RAW_U32 && raw != RC_RAW_U64;
}

enum order {
    ROWS = 0,
    COLUMNS = 1,
    BOTTOM = 2,
    RIGHT = 4
};

/* The six numbers; `missing` stands for the missing one (pass 50 for none). */
static inline void
numbers(struct made *m, enum rc_raw raw, int order, double missing, size_t padding)
{
    size_t outer = (order & COLUMNS) != 0 ? NX : NY, inner = NX * NY / outer;

    for (size_t o = 0; o < outer; o++) {
        for (size_t k = 0; k < inner; k++) {
            size_t row = (order & COLUMNS) != 0 ? k : o, col = (order & COLUMNS) != 0 ? o : k;
            size_t at;
            row = (order & BOTTOM) != 0 ? NY - 1 - row : row;
            col = (order & RIGHT) != 0 ? NX - 1 - col : col;
            at = row * NX + col;
            number(m, raw, at == MISSING_AT ? missing : value_of(at, has_sign(raw)));
        }
        zeros(m, padding);
    }
}

/* Puts the length of what follows `at` there, the length of four bytes. */
static void
close_object(struct made *m, size_t at)
{
    number_at(m, at, RC_RAW_U32, (double)(m->n - at - 4));
}

#endif
