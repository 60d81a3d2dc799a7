/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A table of numbers in text, with as many columns in every row. It is read in one pass, with a point or a
 * comma as the decimal mark in any locale.
 *
 * One separator separates columns. Runs of white space count once; with other separators an empty field is a
 * missing value. A separator at the end of a row is ignored. A value may be quoted, and its exponent may
 * begin with D. Empty lines and lines that begin with '#' or '%' are skipped. Missing values are NaN, NA,
 * N/A, BAD, -- or --- in either case, and the user's word.
 */
#ifndef RC_NUMBER_TABLE_H
#define RC_NUMBER_TABLE_H

#include "text.h"
#include "wish.h"

struct rc_number_table {
    const char *start, *end;
    size_t first_line;     /* number of the line at start, from 1                           */
    char separator;        /* ' ' for white space                                           */
    char decimal;          /* '.' or ','; 0: by the first number that has a mark            */
    const char *missing;   /* a further word, or NULL                                       */
    double missing_number; /* the same as a number, or NAN                                */
    size_t columns, rows;
};

/* Determines separator and decimal mark unless the wish gives them, and counts columns and rows. RC_FAIL when
 * there is no row, when the first one holds anything but numbers, or where separator and decimal mark are
 * ambiguous. */
enum rc_status rc_number_table_open(struct rc_number_table *table, const struct rc_lines *lines,
                                    const struct rc_wish *wish, struct rc_err *err);
/* columns * rows; RC_FAIL when the text is too short for this number of values. */
enum rc_status rc_number_table_size(const struct rc_number_table *table, size_t *n,
                                    struct rc_err *err);
/* All values, row by row, NaN where missing. RC_FAIL names the line that does not fit. */
enum rc_status rc_number_table_read(struct rc_number_table *table, double *v, struct rc_err *err);
/* The first row (columns values) and the first value of each row, without the rest. RC_FAIL where one
 * of them is not a number. */
enum rc_status rc_number_table_edges(const struct rc_number_table *table, double *row,
                                     double *column, struct rc_err *err);

#endif
