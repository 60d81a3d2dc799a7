/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bytes.h"

#include <inttypes.h>
#include <string.h>

static uint64_t
take(struct rc_bytes *b, size_t n)
{
    uint64_t value = 0;

    if (b->at > b->size || b->size - b->at < n) {
        b->at = b->size;
        b->past = true;
        return 0;
    }
    for (size_t k = 0; k < n; k++)
        value = value << 8 | b->data[b->at + (b->big ? k : n - 1 - k)];
    b->at += n;
    return value;
}

uint16_t
rc_bytes_u16(struct rc_bytes *b)
{
    return (uint16_t)take(b, 2);
}

uint32_t
rc_bytes_u32(struct rc_bytes *b)
{
    return (uint32_t)take(b, 4);
}

uint64_t
rc_bytes_u64(struct rc_bytes *b)
{
    return take(b, 8);
}

size_t
rc_raw_width(enum rc_raw raw)
{
    static const size_t width[] = {
        [RC_RAW_U8] = 1,  [RC_RAW_U16] = 2, [RC_RAW_U32] = 4, [RC_RAW_U64] = 8, [RC_RAW_I8] = 1,
        [RC_RAW_I16] = 2, [RC_RAW_I32] = 4, [RC_RAW_I64] = 8, [RC_RAW_F32] = 4, [RC_RAW_F64] = 8};

    return width[raw];
}

/* Byte by byte: compilers turn this into a load, and a swap if the byte order differs. */
static inline uint16_t
half_at(const unsigned char *s, bool big)
{
    return (uint16_t)(big ? s[0] << 8 | s[1] : s[1] << 8 | s[0]);
}

static inline uint32_t
word_at(const unsigned char *s, bool big)
{
    return big ? (uint32_t)half_at(s, true) << 16 | half_at(s + 2, true)
               : (uint32_t)half_at(s + 2, false) << 16 | half_at(s, false);
}

static inline uint64_t
wide_at(const unsigned char *s, bool big)
{
    return big ? (uint64_t)word_at(s, true) << 32 | word_at(s + 4, true)
               : (uint64_t)word_at(s + 4, false) << 32 | word_at(s, false);
}

static inline double
value_at(const unsigned char *s, enum rc_raw raw, bool big)
{
    uint16_t half;
    uint32_t word;
    uint64_t wide;
    int16_t i16;
    int32_t i32;
    int64_t i64;
    float f32;
    double f64;

    /* memcpy, because converting an unsigned number that is too large for the signed type is
     * implementation-defined */
    switch (raw) {
    case RC_RAW_U8:
        return *s;
    case RC_RAW_U16:
        return half_at(s, big);
    case RC_RAW_U32:
        return word_at(s, big);
    case RC_RAW_U64:
        return (double)wide_at(s, big);
    case RC_RAW_I8:
        return *s < 128 ? *s : *s - 256;
    case RC_RAW_I16:
        half = half_at(s, big);
        memcpy(&i16, &half, sizeof i16);
        return i16;
    case RC_RAW_I32:
        word = word_at(s, big);
        memcpy(&i32, &word, sizeof i32);
        return i32;
    case RC_RAW_I64:
        wide = wide_at(s, big);
        memcpy(&i64, &wide, sizeof i64);
        return (double)i64;
    case RC_RAW_F32:
        word = word_at(s, big);
        memcpy(&f32, &word, sizeof f32);
        return (double)f32;
    default:
        wide = wide_at(s, big);
        memcpy(&f64, &wide, sizeof f64);
        return f64;
    }
}

/* A loop for each type and byte order, so that neither is tested for every number. */
#define VALUES(raw, big)                                                                           \
    for (size_t k = 0; k < n; k++)                                                                 \
    v[k] = value_at(s + k * rc_raw_width(raw), raw, big)

static void
values(const unsigned char *s, enum rc_raw raw, bool big, double *v, size_t n)
{
    switch (raw) {
#define ROW(name)                                                                                  \
    case name:                                                                                     \
        if (big)                                                                                   \
            VALUES(name, true);                                                                    \
        else                                                                                       \
            VALUES(name, false);                                                                   \
        break
        ROW(RC_RAW_U8);
        ROW(RC_RAW_U16);
        ROW(RC_RAW_U32);
        ROW(RC_RAW_U64);
        ROW(RC_RAW_I8);
        ROW(RC_RAW_I16);
        ROW(RC_RAW_I32);
        ROW(RC_RAW_I64);
        ROW(RC_RAW_F32);
        ROW(RC_RAW_F64);
#undef ROW
    }
}

void
rc_bytes_values(struct rc_bytes *b, enum rc_raw raw, double *v, size_t n)
{
    size_t width = rc_raw_width(raw), left = b->at < b->size ? (b->size - b->at) / width : 0;
    size_t there = n < left ? n : left;

    values(b->data + (there == 0 ? 0 : b->at), raw, b->big, v, there);
    b->at += there * width;
    if (there < n) {
        memset(v + there, 0, (n - there) * sizeof *v);
        b->at = b->size;
        b->past = true;
    }
}

double
rc_bytes_at(struct rc_bytes *b, size_t at, enum rc_raw raw)
{
    double value;

    b->at = at < b->size ? at : b->size;
    rc_bytes_values(b, raw, &value, 1);
    return value;
}

enum rc_status
rc_bytes_agree(const char *what, uint64_t promised, uint64_t present, struct rc_err *err)
{
    if (promised == present)
        return RC_OK;
    return rc_err_set(err, "the header promises %" PRIu64 " bytes of %s, the file has %" PRIu64,
                      promised, what, present);
}
