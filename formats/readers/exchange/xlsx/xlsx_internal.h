/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sheets of an XLSX workbook as cells; see xlsx.c. */
#ifndef RC_XLSX_INTERNAL_H
#define RC_XLSX_INTERNAL_H

#include <stdint.h>

#include "formats/core/core.h"

enum {
    RC_SHEETS_MOST = 32,
    RC_COLUMNS_MOST = 16384 /* most columns of a sheet */
};

struct rc_cell {
    uint32_t row, column; /* from 1 */
    uint32_t text;        /* position of its text in the texts, from 1; 0: it is a number */
    double number;        /* NAN: an error in the place of one */
};

struct rc_sheet {
    char name[64];
    struct rc_cell *cell; /* n of them, row by row; empty ones are left out */
    size_t n, capacity;
};

struct rc_workbook {
    struct rc_sheet sheet[RC_SHEETS_MOST];
    size_t sheets;
    char *text; /* all texts, each with its NUL */
    size_t text_n, text_capacity;
};

/* Reads the sheets of a file; RC_FAIL with the reason. The caller frees it in either case. */
enum rc_status rc_workbook_read(struct rc_workbook *book, const struct rc_file *file,
                                struct rc_err *err);
void rc_workbook_free(struct rc_workbook *book);
/* True if it is an archive with a workbook in it. */
bool rc_workbook_is(const struct rc_file *file);
/* A cell; NULL where it is empty. */
const struct rc_cell *rc_workbook_cell(const struct rc_sheet *sheet, uint32_t row, uint32_t column);
/* The text of a cell; NULL where it is empty or a number. */
const char *rc_workbook_text(const struct rc_workbook *book, const struct rc_sheet *sheet,
                             uint32_t row, uint32_t column);

#endif
