/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Tables of numbers in columns, from text files in UTF-8 or Latin-1. Tabs, else semicolons (with both of
 * which numbers may have a decimal comma), else commas, else blanks separate the cells of a line. A comma
 * between tabs that may separate thousands is refused, unless another number of the file can only have a
 * decimal comma. '#' begins a comment. A first line without numbers is the heading: the names of the columns
 * in any order, each with its unit as in E/MPa, E (MPa) or E [MPa], or the units in the next line. The
 * heading may be a comment. Without a heading the columns have the order in which they are wanted, and
 * numbers without a unit are in SI units. contact(7) has these rules.
 */
#ifndef RC_COLUMNS_H
#define RC_COLUMNS_H

#include <stdbool.h>
#include <stddef.h>

#include "units.h"

enum {
    COLUMNS_MOST = 12
};

/* A column that a table may have. */
struct wanted_column {
    /* Separated by blanks; messages show the first. Capitals, blanks, '_', '-' and '.' do not count. A name
     * and a symbol, "storage" and "E'", may follow each other. */
    const char *names;
    enum unit unit;
    bool optional;
    bool needs_unit; /* for each number but 0, its own or that of the heading */
    bool infinite;   /* "inf" is a number                                     */
    /* Bits of the columns beside which this one is not read, nor its units checked; not 0: it is optional,
     * and no column without a heading. */
    unsigned spare;
    /* why a table must not have it, and what to do; such a column is in no list of columns */
    const char *refused;
};

struct columns {
    size_t n;                /* rows                                     */
    size_t *line;            /* of the file, for each row                */
    double *v[COLUMNS_MOST]; /* SI, as wanted; NULL: it is absent */
};

/* True if the text of an option names a table rather than numbers. */
bool columns_file(const char *text);
/* Reads the table; `headed`: it needs a heading. On RC_FAIL *err says what is wrong, with the line: unknown,
 * doubled or missing columns, unknown units, rows of another length, no finite numbers, no rows. */
enum rc_status columns_read(struct columns *columns, const char *file,
                            const struct wanted_column *wanted, size_t n, bool headed,
                            struct rc_err *err);
void columns_free(struct columns *columns);

#endif
