/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The first row and column of a matrix as text: heights, labels that count rows and columns, or positions.
 *
 *     ,0,1,2            y [um]\x,0.0,0.5,1.0            "","V1","V2"
 *     0,1.02,-1.28,...       0.0,1.02,-1.28,...         "1",1.02,-1.28
 *
 * Labels count in steps of 1. Positions rise or fall evenly in both, where the corner is empty, text, 0 or
 * the number of columns. Where only one of the two counts, it has at least eight numbers or is beside
 * heights that are not whole numbers. Both count where neither begins with 0 or 1. A plane is neither.
 */
#ifndef RC_LABELS_H
#define RC_LABELS_H

#include "titled_table.h"

struct rc_labels {
    size_t rows, columns; /* rows and columns without heights at the start of the table: 0 or 1
                             each */
    bool counted_titles;  /* numbers in the row of titles are labels                     */
    bool positions;       /* then these: */
    double step[2];   /* steps in x and y, positive, in the file's unit of positions; NAN: a single
                         row or column */
    bool falls[2];    /* the positions fall, so that the map is to be turned   */
    double metres[2]; /* metres per unit; NAN: not in the file */
    struct rc_piece height_unit; /* unit from the corner */
    const char *doubtful; /* "row" or "column" that rises evenly and is read as heights; or NULL */
};

/* Looks for them in a table; `titled` is NULL for one without a row of titles. RC_FAIL where the first row
 * are labels and the first column cannot be, and where memory is out. */
enum rc_status rc_labels_find(const struct rc_number_table *table,
                              const struct rc_titled_table *titled, const struct rc_wish *wish,
                              struct rc_labels *labels, struct rc_err *err);
/* The spacings in metres from positions; NAN: there are none. RC_FAIL where they have no unit and do not
 * agree with --dx and --dy in any. */
enum rc_status rc_labels_spacing(const struct rc_labels *labels, const struct rc_wish *wish,
                                 double *dx, double *dy, struct rc_err *err);
/* Prints the decision, and the option for another one. */
void rc_labels_note(const struct rc_labels *labels, struct rc_notes *notes);

#endif
