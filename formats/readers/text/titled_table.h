/* Tables of numbers in text that come behind a header of whatever kind, with or without titles; in
 * UTF-8, Latin-1 or UTF-16 with its mark. */
#ifndef RC_TITLED_TABLE_H
#define RC_TITLED_TABLE_H

#include "formats/core/core.h"

enum {
    RC_TITLES_MOST = 64
};

struct rc_titled_table {
    char *own; /* the text, where it was converted */
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
    double *v;                    /* numbers.rows * numbers.columns values; NULL: not yet read */
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

/* Finds the first table of at least so many columns: rows and titles. RC_FAIL when there is none.
 * The caller closes it in either case. */
enum rc_status rc_titled_table_open(struct rc_titled_table *table, const struct rc_file *file,
                                    size_t columns, const struct rc_wish *wish, struct rc_err *err);
/* Then reads its values. RC_FAIL names the first row that differs from the first one in its
 * columns. */
enum rc_status rc_titled_table_read(struct rc_titled_table *table, struct rc_err *err);
/* The unit of a column is the text in brackets in its title, otherwise a word in the title that is a length.
 * Otherwise it is the unit of the axis 'x', 'y' or 'z' from a separate line. Empty if there is none. */
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
void rc_titled_table_close(struct rc_titled_table *table);

#endif
