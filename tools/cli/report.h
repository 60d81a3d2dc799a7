/*
 * What --report writes: a row for each case, as it is done, with figures in SI units. A row is a
 * JSON object on a line of its own; in a file that is called .tsv or .csv it is a line of a table, with
 * tabs or commas between the cells and the names of the columns in the first line. A table holds scalars
 * only: objects and arrays are left out of it. Unknown values are null, in a table NaN, so that
 * readers which split lines at blanks find all columns.
 */
#ifndef RC_REPORT_H
#define RC_REPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "libcontact/model.h"
#include "tools/text/text.h"
#include "tool.h"

enum {
    REPORT_COLUMNS = 96, /* of a table                               */
    REPORT_NAME = 96,    /* bytes of a column's name, slash and unit */
    REPORT_DEPTH = 4     /* of objects and arrays inside one another */
};

struct report {
    struct tool *tool;
    const char *name; /* NULL: none is wanted, and nothing is written */
    FILE *file;       /* NULL: no row was written yet                 */
    struct json json;
    char bracket[REPORT_DEPTH]; /* that end the objects and arrays begun */
    size_t depth;
    char separator; /* of the cells of a table; 0: rows are JSON */
    struct {
        const char *name, *unit;
    } column[REPORT_COLUMNS]; /* set by the first row */
    size_t columns;
    char *cell[REPORT_COLUMNS]; /* of this row; NULL: it has none */
    bool headed;                /* the names of the columns are written */
};

/* `name` is what --report was given: a file, `-` for standard output, or NULL. Ends the tool when
 * the file cannot be written; makes it with the first row. */
void report_open(struct report *report, struct tool *tool, const char *name);
bool report_wanted(const struct report *report);

/* A row. In a table all rows have the columns of the first one, whatever their order. Names and
 * units have to last; a unit NULL stands for a plain number. */
void report_begin(struct report *report);
void report_number(struct report *report, const char *name, double value, const char *unit);
void report_count(struct report *report, const char *name, size_t value, const char *unit);
/* A number whose unit report_figure knows. */
void report_value(struct report *report, const char *name, double value);
void report_text(struct report *report, const char *name, const char *value); /* NULL: unknown */
void report_bool(struct report *report, const char *name, bool value);
/* A column of the table that this row has nothing for; not in JSON. */
void report_column(struct report *report, const char *name, const char *unit);
/* Fields up to report_end are inside; numbers of an array have the name NULL. */
void report_object(struct report *report, const char *name);
void report_array(struct report *report, const char *name);
void report_end(struct report *report);
/* Instead of an object that is unknown. */
void report_no_object(struct report *report, const char *name);
/* A column for each figure of the table, in its order; `data`: the struct that holds them, or NULL where
 * they are unknown. Figures "object.name" that follow each other stand in one object, which is unknown when
 * all are. */
void report_table(struct report *report, const struct rc_figure *table, const void *data);
/* The figures of these names, with a blank between two, in their order, from several tables, the last of
 * which is NULL. Every name must be in one of them. */
struct figures {
    const struct rc_figure *table;
    const void *data;
};
void report_named(struct report *report, const struct figures *from, const char *names);
/* The row of a column, in the library's tables or, of numbers that only tools know, in one of this file: its
 * title and unit. NULL: there is none. */
const struct rc_figure *report_figure(const char *name);
/* Columns that many reports have: a map of this case number, and the memory. */
void report_map(struct report *report, const struct rc_grid *g, size_t number);
void report_memory(struct report *report);
/* What several processes that share the maps have sent to each other so far; nothing where there is one. */
void report_ranks(struct report *report, const struct tool *tool);
/* Writes the row; ends the tool when that fails. */
void report_finish_row(struct report *report);

void report_close(struct report *report);

#endif
