/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Output of values: numbers as little-endian bytes, and a growing buffer. */
#ifndef RC_ENCODE_H
#define RC_ENCODE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "formats/core/core.h"
#include "libcontact/owned.h"

/* ---- a growing buffer ---- */

/* Initialise with {0}. If memory is short it stays empty, and rc_buffer_write fails. */
struct rc_buffer {
    char *bytes; /* n bytes, and a NUL */
    size_t n, capacity;
    bool failed;
};
void rc_buffer_add(struct rc_buffer *buffer, const void *bytes, size_t n);
void rc_buffer_print(struct rc_buffer *buffer, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Adds text with escaped special characters of XML. */
void rc_buffer_escaped(struct rc_buffer *buffer, const char *text);
void rc_buffer_u16(struct rc_buffer *buffer, uint16_t value);
void rc_buffer_u32(struct rc_buffer *buffer, uint32_t value);
void rc_buffer_u64(struct rc_buffer *buffer, uint64_t value);
void rc_buffer_f32(struct rc_buffer *buffer, float value);
void rc_buffer_f64(struct rc_buffer *buffer, double value);
void rc_buffer_free(struct rc_buffer *buffer);
/* RC_FAIL if memory is short or writing fails. */
enum rc_status rc_buffer_write(const struct rc_buffer *buffer, FILE *out, struct rc_err *err);

/* ---- values ---- */

struct rc_range {
    double min, max; /* range of the measured values; 0 and 0 without any */
    size_t missing;
};
/* RC_FAIL for a value that is infinite. */
enum rc_status rc_range_of(const struct rc_grid *grid, struct rc_range *range, struct rc_err *err);

/* The code of values as numbers of a file: value = number * increment + offset. */
struct rc_code {
    enum rc_raw raw;
    double increment, offset;
    int32_t missing; /* number of a missing point for integer types; other types have NaN */
};
/* The code with the finest step for the range, with whole numbers from `low` to `high`; floating types store
 * the values unchanged. */
struct rc_code rc_code_for(enum rc_raw raw, const struct rc_range *range, int32_t low, int32_t high,
                           int32_t missing);
/* Encodes n values in n * rc_raw_width bytes, little-endian. RC_FAIL for a finite value that is too large for
 * the type. */
enum rc_status rc_encode(const struct rc_code *code, const double *v, size_t n, unsigned char *to,
                         struct rc_err *err);
/* The same, written to a file. */
enum rc_status rc_encode_file(const struct rc_code *code, const double *v, size_t n, FILE *out,
                              struct rc_err *err);

#endif
