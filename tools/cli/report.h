/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The report of --report: a row for each case as soon as it is done, with figures in SI units. A row is a
 * JSON object in one line. In a file with the suffix .tsv or .csv it is a line of a table, with tabs or
 * commas between the cells. The names of the columns are in the first line. A table holds only scalars,
 * without objects and arrays. Unknown values are null, in a table NaN, so that programs that split lines at
 * blanks find all columns.
 */
#ifndef RC_REPORT_H
#define RC_REPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

#include "libcontact/model.h"
#include "tools/text/text.h"
#include "tool.h"

enum {
    REPORT_COLUMNS = 128, /* most columns of a table */
    REPORT_NAME = 96,     /* most bytes of a column's name, slash and unit */
    REPORT_DEPTH = 4      /* depth of nested objects and arrays */
};

struct report {
    struct tool *tool;
    const char *name; /* NULL: no report was requested, and nothing is written */
    FILE *file;       /* NULL: no row was written yet                 */
    off_t whole;      /* end of the last row that was written whole   */
    struct json json;
    char bracket[REPORT_DEPTH]; /* the brackets that end the open objects and arrays */
    size_t depth;
    char separator; /* separator of the cells of a table; 0: rows are JSON */
    struct {
        const char *name, *unit;
    } column[REPORT_COLUMNS]; /* set by the first row */
    size_t columns;
    const char *source;         /* of this row, or NULL */
    bool of_all;                /* a row is about all inputs: it has no column `file` */
    char *cell[REPORT_COLUMNS]; /* cells of this row; NULL: none */
    bool headed;                /* the names of the columns are written */
};

/* `name` is the argument of --report: a file, `-` for standard output, or NULL. Ends the tool if the file
 * cannot be written; the first row makes the file. */
void report_open(struct report *report, struct tool *tool, const char *name);
bool report_wanted(const struct report *report);

/* A row. In a table all rows have the columns of the first one, in any order. Names and units must last as
 * long as the report; a unit of NULL means a plain number. */
void report_begin(struct report *report);
void report_number(struct report *report, const char *name, double value, const char *unit);
void report_count(struct report *report, const char *name, size_t value, const char *unit);
/* A number whose unit report_figure knows. */
void report_value(struct report *report, const char *name, double value);
void report_text(struct report *report, const char *name, const char *value); /* NULL: unknown */
void report_bool(struct report *report, const char *name, bool value);
/* A column of the table for which this row has no value; not in JSON. */
void report_column(struct report *report, const char *name, const char *unit);
/* Begin an object or an array, which contains the fields up to report_end; numbers of an array have the name
 * NULL. */
void report_object(struct report *report, const char *name);
void report_array(struct report *report, const char *name);
void report_end(struct report *report);
/* An array of n numbers, `step` bytes apart. */
void report_numbers(struct report *report, const char *name, const double *v, size_t step,
                    size_t n);
/* The text in place of an unknown object. */
void report_no_object(struct report *report, const char *name);
/* A column for each figure of the table, in its order; `data`: the struct with the values, or NULL if they
 * are unknown. Adjacent figures "object.name" are in one object, which is null if all are unknown. */
void report_table(struct report *report, const struct rc_figure *table, const void *data);
/* The axes of `at` that `given` has, and their partners. Then the figures of a model and its inner ones,
 * except `converged`: an inner model may converge where the outer one does not. */
void report_model(struct report *report, const struct rc_model *m, const struct rc_point *at,
                  unsigned given);
/* Figures by their names, which are separated by blanks, in this order. They come from several tables; NULL
 * ends the list of tables. Every name must be in one of them. */
struct figures {
    const struct rc_figure *table;
    const void *data;
};
void report_named(struct report *report, const struct figures *from, const char *names);
/* Title and unit of a column, from the library's tables or, for numbers of the tools only, from a table of
 * this file. NULL for an unknown column. */
const struct rc_figure *report_figure(const char *name);
/* The effects that a tool knows, each with "on" or "left out: REASON"; the last has no name. */
struct effect_state {
    const char *name, *state;
};
void report_effects(struct report *report, const struct effect_state *effects);
/* Wall time, s: `seconds`, an object with the phases and `total`, in a table the total alone. The total is
 * that from the input to the figures, without reading and writing of frames; the last phase has no name. */
struct report_phase {
    const char *name;
    double seconds;
};
void report_seconds(struct report *report, const struct report_phase *phases, double total);
/* `converged` of a result that has no iteration of its own: that of its input, a value of the key; NULL:
 * unknown. */
void report_carried(struct report *report, const char *converged);
/* What --dry-run forecasts: equivalents of a convolution (NAN: unknown), s (NAN: unknown), bytes. */
void report_forecast(struct report *report, double convolutions, double seconds, size_t memory);
/* Columns of many reports: a map with this case number, and the memory. */
void report_map(struct report *report, const struct rc_grid *g, size_t number);
void report_memory(struct report *report);
/* The communication so far of the processes that share the maps; nothing for a single process. */
void report_ranks(struct report *report, const struct tool *tool);
/* Writes the row; ends the tool on failure. */
void report_finish_row(struct report *report);

void report_close(struct report *report);

#endif
