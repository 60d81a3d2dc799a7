/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of numbers in text that come behind a header of whatever kind, with or without titles; in
 * UTF-8, Latin-1 or UTF-16 with its mark. A file is opened once for its three readers: matrices (ascii.c),
 * profiles (profile.c) and lists of points (xyz.c). */
#ifndef RC_TITLED_TABLE_H
#define RC_TITLED_TABLE_H

#include "formats/core/core.h"

enum {
    RC_TITLES_MOST = 64
};

struct rc_titled_table;

/* What one reader finds in the table. */
struct rc_table_kind {
    enum {
        RC_TABLE_MATRIX,
        RC_TABLE_PROFILE,
        RC_TABLE_POINTS,
        RC_TABLE_KINDS
    } index;
    size_t size; /* of the struct that it fills, which is zero before */
    enum rc_status (*open)(void *found, struct rc_titled_table *table, struct rc_err *err);
    void (*close)(void *found); /* also after a failure */
};

struct rc_titled_table {
    const struct rc_file *file;
    const struct rc_wish *wish;
    char *own;            /* the text, where it was converted */
    char *numeric;        /* the text without its columns of words, where it has some */
    char words[RC_SHOWN]; /* the title of the first of them */
    struct rc_number_table numbers;
    struct rc_piece title[RC_TITLES_MOST]; /* titles of the columns, from the line before the
                                              first row */
    size_t titles;                         /* number of titles, also of those that are not kept */
    struct rc_piece over[RC_TITLES_MOST];  /* names above titles that are units alone */
    bool has_over;
    struct rc_piece title_line;
    char title_separator;
    size_t skipped; /* lines above that are not empty, not titles and unknown */
    struct rc_piece first_skipped;
    struct rc_piece axis_unit[3]; /* units from lines `x-unit = um` and so on above it */
    enum rc_status status;        /* RC_FAIL: there is no table in the file, for this reason */
    struct rc_err why;
    double *v; /* numbers.rows * numbers.columns values; NULL: not yet read */
    struct rc_table_found {
        const struct rc_table_kind *kind; /* NULL: not yet looked for */
        void *found;
        enum rc_status status;
        struct rc_err why;
    } as[RC_TABLE_KINDS];
};

/* The kind of a column by its title. */
enum rc_role {
    RC_ROLE_NONE, /* the title does not say */
    RC_ROLE_X,
    RC_ROLE_Y,
    RC_ROLE_Z,
    RC_ROLE_INDEX, /* numbers of the points or rows */
    RC_ROLE_VALID  /* 0 where the point is missing  */
};

/* What the kind finds in the file, which is opened and looked at the first time only; its status is RC_FAIL
 * where the kind refuses the file. NULL when memory is out. */
void *rc_table_as(struct rc_maps *maps, const struct rc_table_kind *kind, enum rc_status *status,
                  struct rc_err *err);
/* For the kinds. RC_FAIL when the file has no table of numbers: rows of at least two columns, otherwise of
 * one. */
enum rc_status rc_titled_table_check(const struct rc_titled_table *table, struct rc_err *err);
/* Reads its values, unless they are read. RC_FAIL names the first row that differs from the first one in
 * its columns. */
enum rc_status rc_titled_table_read(struct rc_titled_table *table, struct rc_err *err);
/* Of a title without quotes: the unit is the text in brackets, otherwise a word that is a length; empty if
 * there is none. */
struct rc_piece rc_title_unit(struct rc_piece title);
enum rc_role rc_title_role(struct rc_piece title);
/* The unit of a column is that of its title, otherwise that of the axis 'x', 'y' or 'z' from a separate
 * line. */
struct rc_piece rc_titled_table_unit(const struct rc_titled_table *table, size_t column, char axis);
enum rc_role rc_titled_table_role(const struct rc_titled_table *table, size_t column);
/* The first column of this kind; without one, the number of columns. */
size_t rc_titled_table_column(const struct rc_titled_table *table, enum rc_role role);
/* The title without its unit; empty if there is none. */
struct rc_piece rc_titled_table_name(const struct rc_titled_table *table, size_t column);
/* True if the titles, except that of a first column of row names, are all numbers, or all one word with a
 * number. */
bool rc_titled_table_numbered(const struct rc_titled_table *table);
/* True if it is a matrix and no profile or list of points. It has at least three columns, whose titles are
 * numbers, one word with a number each (z1, z2, ...), or name no axis. Without titles it has at least four
 * columns. */
bool rc_titled_table_is_matrix(const struct rc_titled_table *table);
/* Reads the next title of a row of them, at its separators. false at its end. */
bool rc_title_next(struct rc_piece *line, char separator, struct rc_piece *title);
/* Notes the unused columns: counters and marks. */
void rc_titled_table_left_out(const struct rc_titled_table *table, struct rc_notes *notes);

#endif
