#include "bytes.h"

#include <inttypes.h>
#include <string.h>

static uint64_t
take(struct rc_bytes *b, size_t n)
{
    uint64_t value = 0;

    if (b->size - b->at < n) {
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
        [RC_RAW_I16] = 2, [RC_RAW_I32] = 4, [RC_RAW_F32] = 4, [RC_RAW_F64] = 8};

    return width[raw];
}

static double
value_of(struct rc_bytes *b, enum rc_raw raw)
{
    uint32_t word;
    uint64_t wide;
    int16_t i16;
    int32_t i32;
    float f32;
    double f64;

    /* memcpy, because a conversion of an unsigned number too large for the signed type is the
     * compiler's choice */
    switch (raw) {
    case RC_RAW_I16: {
        uint16_t half = rc_bytes_u16(b);
        memcpy(&i16, &half, sizeof i16);
        return i16;
    }
    case RC_RAW_I32:
        word = rc_bytes_u32(b);
        memcpy(&i32, &word, sizeof i32);
        return i32;
    case RC_RAW_F32:
        word = rc_bytes_u32(b);
        memcpy(&f32, &word, sizeof f32);
        return (double)f32;
    default:
        wide = rc_bytes_u64(b);
        memcpy(&f64, &wide, sizeof f64);
        return f64;
    }
}

void
rc_bytes_values(struct rc_bytes *b, enum rc_raw raw, double *v, size_t n)
{
    for (size_t k = 0; k < n; k++)
        v[k] = value_of(b, raw);
}

enum rc_status
rc_bytes_agree(const char *what, uint64_t promised, uint64_t present, struct rc_err *err)
{
    if (promised == present)
        return RC_OK;
    return rc_err_set(err, "the header promises %" PRIu64 " bytes of %s, the file has %" PRIu64,
                      promised, what, present);
}
