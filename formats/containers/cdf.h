/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The header of a NetCDF classic file: its variables and their positions; see readers/exchange/netcdf.c. */
#ifndef RC_CDF_H
#define RC_CDF_H

#include "formats/core/core.h"

enum {
    RC_CDF_CHAR = 2,  /* type of text */
    RC_CDF_FLOAT = 5, /* float of 32 bits */
    RC_CDF_TYPES = 12
};

/* Bytes of a value by type, which is from 1 on. */
size_t rc_cdf_width(unsigned type);

struct rc_cdf_dimension {
    struct rc_piece name;
    uint64_t length; /* 0: of records */
};

struct rc_cdf_variable {
    struct rc_piece name, unit, title;
    size_t rank, first,
        dimension[2]; /* the first dimension, and the last two (for rank 1 the only one) */
    uint64_t lead;    /* product of the dimensions before the last two, 1 without any */
    unsigned type;
    uint64_t size, at;           /* size: bytes, of one record if it has records */
    double fill, factor, offset; /* NAN, 1 and 0 when not given */
    double period;               /* not 0: the axis is periodic */
};

struct rc_cdf {
    struct rc_bytes b;
    unsigned version;
    uint64_t records, record; /* number of records; bytes of one */
    struct rc_cdf_dimension *dimension;
    size_t dimensions;
    struct rc_cdf_variable *variable;
    size_t variables;
};

/* Reads the header; close it also on failure. The bytes of the file must outlive it. */
enum rc_status rc_cdf_open(struct rc_cdf *cdf, const struct rc_file *file, struct rc_err *err);
void rc_cdf_close(struct rc_cdf *cdf);
bool rc_cdf_is(struct rc_piece piece, const char *word);
/* True if the variable is stored in records. */
bool rc_cdf_has_records(const struct rc_cdf *cdf, const struct rc_cdf_variable *variable);
/* The value of this type at a position. */
double rc_cdf_value(const unsigned char *at, unsigned type);

#endif
