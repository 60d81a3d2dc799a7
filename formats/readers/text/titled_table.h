/* Tables of numbers in text that come behind a header of whatever kind, with or without titles; in
 * UTF-8, Latin-1 or UTF-16 with its mark. */
#ifndef RC_TITLED_TABLE_H
#define RC_TITLED_TABLE_H

#include "formats/core/core.h"

enum {
    RC_TITLES_MOST = 16
};

struct rc_titled_table {
    char *own; /* the text, where it was converted */
    struct rc_number_table numbers;
    struct rc_piece title[RC_TITLES_MOST]; /* of the columns, from the line before the first row */
    size_t titles;
    struct rc_piece axis_unit[3]; /* as lines `x-unit = um` and so on above it have them */
    double *v;                    /* numbers.rows * numbers.columns values; NULL: not yet read */
};

/* Finds the first table of at least so many columns: rows and titles. RC_FAIL when there is none.
 * The caller closes it in either case. */
enum rc_status rc_titled_table_open(struct rc_titled_table *table, const struct rc_file *file,
                                    size_t columns, const struct rc_wish *wish, struct rc_err *err);
/* Then reads its values. RC_FAIL names the first row that differs from the first one in its
 * columns. */
enum rc_status rc_titled_table_read(struct rc_titled_table *table, struct rc_err *err);
/* The unit of a column: what stands in brackets in its title, else a word there that is a length,
 * else that of the axis 'x', 'y' or 'z' by a line of its own. Of no length where there is none. */
struct rc_piece rc_titled_table_unit(const struct rc_titled_table *table, size_t column, char axis);
void rc_titled_table_close(struct rc_titled_table *table);

#endif
