/* SPDX-License-Identifier: GPL-3.0-or-later */
/* XLSX: the contents of the archive, ECMA-376. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "xlsx_internal.h"
#include "formats/containers/containers.h"

enum {
    NAME = 128,
    ROWS_MOST = 1 << 20,
    CELL_BYTES = 96 /* bytes of memory for a cell: here, as text, and read from the text */
};

static const char workbook_name[] = "xl/workbook.xml", strings_name[] = "xl/sharedStrings.xml";

struct link {
    char id[NAME], member[NAME];
};

/* The state of the parser. */
struct reading {
    struct rc_workbook *book;
    const struct rc_file *file;
    struct rc_zip_read *archive;
    struct link link[RC_SHEETS_MOST]; /* id of the sheets in the workbook, then their members */
    char id[NAME], target[NAME];      /* id and target of a relation */
    uint32_t *shared;                 /* start of each shared text */
    size_t shareds, shared_capacity, cells;
    struct rc_sheet *sheet;
    struct rc_cell cell; /* the current one */
    uint32_t row;
    char type[16], value[NAME];
    bool formula, valued;
    uint32_t inline_text;
};

/* ---- texts ---- */

/* Adds text to the last one, or as a new one behind it; *at is where it begins, from 1. */
static enum rc_status
add_text(struct rc_workbook *b, const char *text, bool is_new, uint32_t *at, struct rc_err *err)
{
    size_t n = strlen(text) + 1, start = is_new || b->text_n == 0 ? b->text_n : b->text_n - 1;

    if (b->text_capacity - b->text_n < n) {
        size_t capacity = 2 * b->text_capacity + n + 4096;
        char *more = capacity < UINT32_MAX ? realloc(b->text, capacity) : NULL;

        if (more == NULL)
            return rc_err_set(err, "out of memory for the texts of the workbook");
        b->text = more;
        b->text_capacity = capacity;
    }
    memcpy(b->text + start, text, n);
    b->text_n = start + n;
    if (is_new)
        *at = (uint32_t)start + 1;
    return RC_OK;
}

/* Adds to a shared text, whose characters may come in several pieces. */
static enum rc_status
take_shared(void *arg, const char *path, const char *text, struct rc_err *err)
{
    struct reading *r = arg;

    if (strcmp(path, "sst/si/t") == 0 || strcmp(path, "sst/si/r/t") == 0)
        return add_text(r->book, text, !r->valued, &r->cell.text, err) == RC_OK
                   ? (r->valued = true, RC_OK)
                   : RC_FAIL;
    if (strcmp(path, "sst/si") != 0)
        return RC_OK;
    if (!r->valued && add_text(r->book, "", true, &r->cell.text, err) != RC_OK)
        return RC_FAIL;
    r->valued = false;
    if (r->shareds == r->shared_capacity) {
        size_t capacity = 2 * r->shared_capacity + 256;
        uint32_t *more = realloc(r->shared, capacity * sizeof *more);

        if (more == NULL)
            return rc_err_set(err, "out of memory for the texts of the workbook");
        r->shared = more;
        r->shared_capacity = capacity;
    }
    r->shared[r->shareds++] = r->cell.text;
    return RC_OK;
}

/* ---- the list of sheets ---- */

static enum rc_status
take_workbook(void *arg, const char *path, const char *text, struct rc_err *err)
{
    static const char sheet[] = "workbook/sheets/sheet";
    struct reading *r = arg;
    struct rc_workbook *b = r->book;

    (void)err;
    if (strncmp(path, sheet, strlen(sheet)) != 0 || b->sheets == RC_SHEETS_MOST)
        return RC_OK;
    path += strlen(sheet);
    if (strcmp(path, "/@name") == 0)
        rc_text_clean(b->sheet[b->sheets].name, sizeof b->sheet->name, text, strlen(text));
    else if (strcmp(path, "/@id") == 0 && strlen(text) < NAME)
        strcpy(r->link[b->sheets].id, text);
    else if (*path == '\0')
        b->sheets++;
    return RC_OK;
}

static enum rc_status
take_relation(void *arg, const char *path, const char *text, struct rc_err *err)
{
    static const char relation[] = "Relationships/Relationship";
    struct reading *r = arg;

    (void)err;
    if (strncmp(path, relation, strlen(relation)) != 0)
        return RC_OK;
    path += strlen(relation);
    if (strcmp(path, "/@Id") == 0 && strlen(text) < NAME)
        strcpy(r->id, text);
    else if (strcmp(path, "/@Target") == 0 && strlen(text) + 4 < NAME)
        snprintf(r->target, NAME, "%s%s", *text == '/' ? "" : "xl/", text + (*text == '/'));
    else if (*path == '\0')
        for (size_t k = 0; k < r->book->sheets; k++)
            if (strcmp(r->link[k].id, r->id) == 0)
                strcpy(r->link[k].member, r->target);
    return RC_OK;
}

/* ---- cells ---- */

/* Splits "AB12" into column and row; false where the text has another form. */
static bool
read_place(const char *text, struct rc_cell *c)
{
    uint32_t column = 0, row = 0;

    for (; *text >= 'A' && *text <= 'Z' && column < RC_COLUMNS_MOST; text++)
        column = 26 * column + (uint32_t)(*text - 'A' + 1);
    for (; *text >= '0' && *text <= '9' && row <= ROWS_MOST; text++)
        row = 10 * row + (uint32_t)(*text - '0');
    if (*text != '\0' || column == 0 || column > RC_COLUMNS_MOST || row == 0 || row > ROWS_MOST)
        return false;
    c->column = column;
    c->row = row;
    return true;
}

static enum rc_status
keep_cell(struct reading *r, struct rc_err *err)
{
    struct rc_sheet *s = r->sheet;
    const struct rc_cell *last = s->n == 0 ? NULL : &s->cell[s->n - 1];

    if (r->cell.row == 0 || r->cell.row > ROWS_MOST || r->cell.column > RC_COLUMNS_MOST)
        return rc_err_set(err, "sheet '%s' has a cell in row %u, column %u: there are %d and %d",
                          s->name, r->cell.row, r->cell.column, ROWS_MOST, RC_COLUMNS_MOST);
    if (last != NULL &&
        (r->cell.row < last->row || (r->cell.row == last->row && r->cell.column <= last->column)))
        return rc_err_set(err, "the cells of sheet '%s' are out of order", s->name);
    if (++r->cells > rc_memory_limit(r->file->size) / CELL_BYTES)
        return rc_err_set(err, "more than %zu cells in a file of %zu bytes: it is damaged",
                          r->cells - 1, r->file->size);
    if (s->n == s->capacity) {
        size_t capacity = s->capacity + s->capacity / 2 + 1024;
        struct rc_cell *more = realloc(s->cell, capacity * sizeof *more);

        if (more == NULL)
            return rc_err_set(err, "out of memory for %zu cells", capacity);
        s->cell = more;
        s->capacity = capacity;
    }
    s->cell[s->n++] = r->cell;
    return RC_OK;
}

/* Called at the end of a cell: interprets its value by its type. */
static enum rc_status
end_cell(struct reading *r, struct rc_err *err)
{
    size_t index;

    if (r->formula && !r->valued)
        return rc_err_set(err,
                          "a formula in sheet '%s', row %u, column %u, has no value: open and save "
                          "the file in a program that calculates it",
                          r->sheet->name, r->cell.row, r->cell.column);
    r->cell.number = NAN;
    r->cell.text = r->inline_text;
    if (strcmp(r->type, "inlineStr") == 0 ? r->inline_text == 0 : !r->valued)
        return RC_OK;
    if (strcmp(r->type, "s") == 0) {
        if (rc_xml_whole("the sheet", "a shared text", r->value, &index, err) != RC_OK)
            return RC_FAIL;
        if (index >= r->shareds)
            return rc_err_set(err, "a cell refers to shared text %zu, but there are only %zu",
                              index, r->shareds);
        r->cell.text = r->shared[index];
    } else if (strcmp(r->type, "str") == 0 || strcmp(r->type, "b") == 0) {
        if (add_text(r->book, r->value, true, &r->cell.text, err) != RC_OK)
            return RC_FAIL;
    } else if (strcmp(r->type, "") == 0 || strcmp(r->type, "n") == 0) {
        const char *end = rc_number_read(r->value, false, &r->cell.number);

        if (end == NULL || *end != '\0')
            return rc_err_set(err, "'%s' in sheet '%s', row %u, column %u, is not a number",
                              rc_word_shown(r->value), r->sheet->name, r->cell.row, r->cell.column);
    } else if (strcmp(r->type, "e") != 0 && r->inline_text == 0)
        return RC_OK; /* a date or another type */
    return keep_cell(r, err);
}

static enum rc_status
take_cell(void *arg, const char *path, const char *text, struct rc_err *err)
{
    static const char row[] = "worksheet/sheetData/row";
    struct reading *r = arg;
    size_t number;

    if (strncmp(path, row, strlen(row)) != 0)
        return RC_OK;
    path += strlen(row);
    if (strcmp(path, "/@r") == 0) {
        if (rc_xml_whole("the sheet", "a row", text, &number, err) != RC_OK)
            return RC_FAIL;
        r->row = number <= ROWS_MOST ? (uint32_t)number - 1 : ROWS_MOST;
    } else if (*path == '\0') {
        r->row++;
        r->cell.column = 0;
    } else if (strcmp(path, "/c/@r") == 0) {
        if (!read_place(text, &r->cell))
            return rc_err_set(err, "'%s' is not a cell of a sheet", rc_word_shown(text));
        r->row = r->cell.row - 1;
    } else if (strcmp(path, "/c/@t") == 0 && strlen(text) < sizeof r->type)
        strcpy(r->type, text);
    else if (strcmp(path, "/c/f") == 0)
        r->formula = true;
    else if (strcmp(path, "/c/v") == 0) {
        r->valued = *text != '\0';
        snprintf(r->value, sizeof r->value, "%.*s", (int)sizeof r->value - 1, text);
    } else if (strcmp(path, "/c/is/t") == 0 || strcmp(path, "/c/is/r/t") == 0)
        return add_text(r->book, text, r->inline_text == 0, &r->inline_text, err);
    else if (strcmp(path, "/c") == 0) {
        enum rc_status status;

        if (r->cell.row != r->row + 1) { /* it names no place */
            r->cell.row = r->row + 1;
            r->cell.column++;
        }
        status = end_cell(r, err);
        r->type[0] = '\0';
        r->formula = r->valued = false;
        r->inline_text = 0;
        r->cell.row = 0;
        return status;
    }
    return RC_OK;
}

/* ---- the archive ---- */

static enum rc_status
read_member(struct reading *r, const char *name, rc_element *element, struct rc_err *err)
{
    size_t member;
    uint64_t size;

    if (rc_zip_read_find(r->archive, name, &member, err) != RC_OK ||
        rc_zip_read_size(r->archive, member, &size, err) != RC_OK)
        return RC_FAIL;
    if (size > rc_memory_limit(r->file->size))
        return rc_err_set(err, "%s promises %g MB, the file has %g MB: it is damaged", name,
                          (double)size / 1e6, (double)r->file->size / 1e6);
    return rc_zip_read_xml(r->archive, member, size, name, true, element, r, NULL, err);
}

static enum rc_status
read_all(struct reading *r, struct rc_err *err)
{
    size_t member;

    if (read_member(r, workbook_name, take_workbook, err) != RC_OK ||
        read_member(r, "xl/_rels/workbook.xml.rels", take_relation, err) != RC_OK)
        return RC_FAIL;
    if (rc_zip_read_find(r->archive, strings_name, &member, NULL) == RC_OK &&
        read_member(r, strings_name, take_shared, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < r->book->sheets; k++) {
        r->sheet = &r->book->sheet[k];
        r->row = 0;
        r->cell = (struct rc_cell){0};
        if (strstr(r->link[k].member, "sheets/") == NULL ||
            strstr(r->link[k].member, "chartsheets/") != NULL)
            continue; /* a sheet of another kind */
        if (read_member(r, r->link[k].member, take_cell, err) != RC_OK)
            return RC_FAIL;
    }
    return RC_OK;
}

enum rc_status
rc_workbook_read(struct rc_workbook *book, const struct rc_file *file, struct rc_err *err)
{
    RC_OWNED struct reading *r = calloc(1, sizeof *r);
    enum rc_status status = RC_FAIL;

    memset(book, 0, sizeof *book);
    if (r == NULL)
        return rc_err_set(err, "out of memory for reading a workbook");
    r->book = book;
    r->file = file;
    if ((r->archive = rc_zip_read_new(file, err)) != NULL)
        status = read_all(r, err);
    rc_zip_read_free(r->archive);
    free(r->shared);
    return status;
}

void
rc_workbook_free(struct rc_workbook *book)
{
    for (size_t k = 0; k < RC_SHEETS_MOST; k++)
        free(book->sheet[k].cell);
    free(book->text);
}

bool
rc_workbook_is(const struct rc_file *file)
{
    RC_OWN(rc_zip_read, archive) = NULL;
    size_t member;

    if (!rc_file_holds(file, 0, "PK", 2) || (archive = rc_zip_read_new(file, NULL)) == NULL)
        return false;
    return rc_zip_read_find(archive, workbook_name, &member, NULL) == RC_OK;
}

const struct rc_cell *
rc_workbook_cell(const struct rc_sheet *sheet, uint32_t row, uint32_t column)
{
    size_t low = 0, high = sheet->n;

    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const struct rc_cell *c = &sheet->cell[middle];

        if (c->row < row || (c->row == row && c->column < column))
            low = middle + 1;
        else
            high = middle;
    }
    return low < sheet->n && sheet->cell[low].row == row && sheet->cell[low].column == column
               ? &sheet->cell[low]
               : NULL;
}

const char *
rc_workbook_text(const struct rc_workbook *book, const struct rc_sheet *sheet, uint32_t row,
                 uint32_t column)
{
    const struct rc_cell *c = rc_workbook_cell(sheet, row, column);

    return c == NULL || c->text == 0 ? NULL : book->text + c->text - 1;
}
