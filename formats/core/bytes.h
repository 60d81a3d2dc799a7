/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A cursor over bytes that cannot run past their end.
 *
 * Reading past the end gives zeros and sets `past`, so a header can be read without checks and `past` tested
 * once. Check long runs first, with rc_bytes_need.
 */
#ifndef RC_BYTES_H
#define RC_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "libcontact/owned.h"

struct rc_bytes {
    const unsigned char *data;
    size_t size, at;
    bool big;  /* most significant byte first */
    bool past; /* a read went past the end */
};

uint16_t rc_bytes_u16(struct rc_bytes *bytes);
uint32_t rc_bytes_u32(struct rc_bytes *bytes);
uint64_t rc_bytes_u64(struct rc_bytes *bytes);

/* Types of numbers in a file. */
enum rc_raw {
    RC_RAW_U8,
    RC_RAW_U16,
    RC_RAW_U32,
    RC_RAW_U64,
    RC_RAW_I8,
    RC_RAW_I16,
    RC_RAW_I32,
    RC_RAW_I64,
    RC_RAW_F32,
    RC_RAW_F64
};
size_t rc_raw_width(enum rc_raw raw);
/* The next n numbers, unscaled; zeros past the end. */
void rc_bytes_values(struct rc_bytes *bytes, enum rc_raw raw, double *v, size_t n);

/* The number at a position; the cursor is then after it. */
double rc_bytes_at(struct rc_bytes *bytes, size_t at, enum rc_raw raw);

/* The check of sizes of every binary format: `what` needs `promised` bytes and has `present` ones. RC_OK when
 * they agree. */
enum rc_status rc_bytes_agree(const char *what, uint64_t promised, uint64_t present,
                              struct rc_err *err);

#endif
