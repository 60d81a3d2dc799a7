/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A growing buffer of bytes, and the numbers in the maps of files made by hand. */
#include "made.h"

#include <stdlib.h>
#include <string.h>
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/asan_interface.h>
#else
#define ASAN_POISON_MEMORY_REGION(at, n)
#define ASAN_UNPOISON_MEMORY_REGION(at, n)
#endif

void
add(struct bytes *b, const void *from, size_t n)
{
    if (b->n + n + 1 > b->room) {
        b->room = 2 * (b->n + n + 1);
        b->data = realloc(b->data, b->room);
        if (b->data == NULL)
            abort();
        ASAN_POISON_MEMORY_REGION(b->data + b->n, b->room - b->n);
    }
    ASAN_UNPOISON_MEMORY_REGION(b->data + b->n, n + 1);
    if (n > 0)
        memcpy(b->data + b->n, from, n);
    b->n += n;
}

void
add_number(struct bytes *b, uint64_t value, size_t n)
{
    unsigned char to[8];

    for (size_t k = 0; k < n; k++)
        to[b->big ? n - 1 - k : k] = (unsigned char)(value >> 8 * k);
    add(b, to, n);
}

void
add_f64(struct bytes *b, double value)
{
    uint64_t word;

    memcpy(&word, &value, 8);
    add_number(b, word, 8);
}

void
add_f32(struct bytes *b, double value)
{
    float narrow = (float)value;
    uint32_t word;

    memcpy(&word, &narrow, 4);
    add_number(b, word, 4);
}

void
drop(struct bytes *b)
{
    free(b->data);
    *b = (struct bytes){0};
}

struct rc_file
file_of(const struct bytes *b, const char *name)
{
    return (struct rc_file){.name = name, .data = b->data, .size = b->n};
}

void
add_text(struct bytes *m, const char *s)
{
    add(m, s, strlen(s));
}

void
add_zeros(struct bytes *m, size_t n)
{
    unsigned char *none = calloc(n + 1, 1);

    if (none == NULL)
        abort();
    add(m, none, n);
    free(none);
}

void
add_raw(struct bytes *m, enum rc_raw raw, double value)
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
    add(m, bytes, n);
}

void
set_raw(struct bytes *m, size_t at, enum rc_raw raw, double value)
{
    struct bytes part = {.big = m->big};

    add_raw(&part, raw, value);
    memcpy(m->data + at, part.data, part.n);
    drop(&part);
}

void
set_text(struct bytes *m, size_t at, const char *s)
{
    memcpy(m->data + at, s, strlen(s));
}

double
value_of(size_t k, bool has_sign)
{
    static const double plain[] = {10, 20, 30, 40, 50, 60};

    return has_sign && k % 4 == 1 ? -plain[k] : plain[k];
}

static bool
has_sign(enum rc_raw raw)
{
    return raw != RC_RAW_U8 && raw != RC_RAW_U16 && raw != RC_RAW_U32 && raw != RC_RAW_U64;
}

void
add_map(struct bytes *m, enum rc_raw raw, int order, double missing, size_t padding)
{
    size_t outer = (order & COLUMNS) != 0 ? NX : NY, inner = NX * NY / outer;

    for (size_t o = 0; o < outer; o++) {
        for (size_t k = 0; k < inner; k++) {
            size_t row = (order & COLUMNS) != 0 ? k : o, col = (order & COLUMNS) != 0 ? o : k;
            size_t at;
            row = (order & BOTTOM) != 0 ? NY - 1 - row : row;
            col = (order & RIGHT) != 0 ? NX - 1 - col : col;
            at = row * NX + col;
            add_raw(m, raw, at == MISSING_AT ? missing : value_of(at, has_sign(raw)));
        }
        add_zeros(m, padding);
    }
}

void
close_object(struct bytes *m, size_t at)
{
    set_raw(m, at, RC_RAW_U32, (double)(m->n - at - 4));
}
