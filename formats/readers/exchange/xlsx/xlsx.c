/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Workbooks (XLSX) are ZIP archives of XML. The reader looks in each sheet for blocks of numbers:
 * neighbouring columns that are filled over the same rows. A block, with the titles above it, is read like a
 * text file of the same content. Two columns are a profile, three are points or a matrix, more are a matrix,
 * whose first row and column may be positions. The largest block is the first channel.
 *
 * SurfTest of Mitutoyo gives a profile without titles. Its positions are then in the unit of the cut-off,
 * its heights in the unit of the first roughness in column A.
 *
 * Written from ECMA-376, and for SurfTest from how SurfaceTopography reads it.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "xlsx_internal.h"
#include "formats/format.h"

enum {
    BLOCKS_MOST = 64,
    TITLE = 128,
    ROWS_LEAST = 2
};

struct block {
    const struct rc_sheet *sheet;
    uint32_t first, last, left, right; /* rows and columns, both ends */
    size_t numbers;
};

struct blocks {
    struct block block[BLOCKS_MOST];
    size_t n;
};

/* ---- blocks ---- */

/* The rows of a column with numbers: the longest run without a text, and without a row that has no number. */
struct run {
    uint32_t first, last;
    uint32_t after, before; /* rows without a text between them; 0: there are no more */
    uint32_t part;          /* rows of the sheet, between rows without numbers */
    size_t n;
};

struct columns {
    struct run best[RC_COLUMNS_MOST + 2], now[RC_COLUMNS_MOST + 2];
};

/* The run of a column is at its end, by a text in that row or by none (0). */
static void
end_run(struct columns *c, size_t column, uint32_t text)
{
    struct run *now = &c->now[column], *best = &c->best[column];

    if (text != 0 && best->n > 0 && best->before == 0)
        best->before = text;
    if (now->n > best->n) {
        *best = *now;
        best->before = text;
    }
    *now = (struct run){.after = text != 0 ? text + 1 : now->after};
}

static void
find_runs(const struct rc_sheet *s, struct columns *c)
{
    uint32_t row = 0, part = 1; /* the last row with a number */

    memset(c, 0, sizeof *c);
    for (size_t k = 0; k < s->n; k++) {
        const struct rc_cell *cell = &s->cell[k];
        struct run *now = &c->now[cell->column];

        if (cell->text != 0) {
            end_run(c, cell->column, cell->row);
            continue;
        }
        part += cell->row > row + 1;
        row = cell->row;
        if (now->part != part)
            end_run(c, cell->column, 0);
        if (now->n++ == 0)
            now->first = cell->row;
        now->last = cell->row;
        now->part = part;
    }
    for (size_t column = 1; column <= RC_COLUMNS_MOST; column++)
        end_run(c, column, 0);
}

/* True if two columns belong together: they share half of the rows of the longer one. */
static bool
belong(const struct run *a, const struct run *b)
{
    uint32_t first = a->first > b->first ? a->first : b->first;
    uint32_t last = a->last < b->last ? a->last : b->last;
    uint32_t longer =
        a->last - a->first > b->last - b->first ? a->last - a->first + 1 : b->last - b->first + 1;

    return last >= first && last - first + 1 >= (longer + 1) / 2;
}

/* They are in the order of their sizes, the largest first. */
static void
insert(struct blocks *blocks, const struct block *b)
{
    size_t k = blocks->n < BLOCKS_MOST ? blocks->n++ : BLOCKS_MOST - 1;

    if (k == BLOCKS_MOST - 1 && blocks->block[k].numbers >= b->numbers)
        return;
    for (; k > 0 && blocks->block[k - 1].numbers < b->numbers; k--)
        blocks->block[k] = blocks->block[k - 1];
    blocks->block[k] = *b;
}

/* Adds a column to a block, which ends at a text in any column. */
static void
widen(struct block *b, const struct run *run, uint32_t *after, uint32_t *before)
{
    b->first = run->first < b->first ? run->first : b->first;
    b->last = run->last > b->last ? run->last : b->last;
    b->numbers += run->n;
    *after = run->after > *after ? run->after : *after;
    *before = run->before != 0 && run->before < *before ? run->before : *before;
}

static void
find_blocks(const struct rc_sheet *s, const struct columns *c, struct blocks *blocks)
{
    for (uint32_t column = 1; column <= RC_COLUMNS_MOST; column++) {
        struct block b = {s, UINT32_MAX, 0, column, column, 0};
        uint32_t after = 0, before = UINT32_MAX;

        if (c->best[column].n < ROWS_LEAST)
            continue;
        widen(&b, &c->best[column], &after, &before);
        while (c->best[column + 1].n >= ROWS_LEAST &&
               belong(&c->best[column], &c->best[column + 1]))
            widen(&b, &c->best[++column], &after, &before);
        b.right = column;
        b.first = b.first < after ? after : b.first;
        b.last = b.last >= before ? before - 1 : b.last;
        if (b.last > b.first)
            insert(blocks, &b);
    }
}

/* ---- titles ---- */

/* The title of a column of a block, with the unit that may follow in the next row. */
static void
title_of(const struct rc_workbook *w, const struct block *b, uint32_t column, char title[TITLE])
{
    const char *low = b->first > 1 ? rc_workbook_text(w, b->sheet, b->first - 1, column) : NULL;
    const char *high = b->first > 2 ? rc_workbook_text(w, b->sheet, b->first - 2, column) : NULL;
    struct rc_piece unit = {low, low == NULL ? 0 : strlen(low)};
    char text[TITLE];

    text[0] = '\0';
    if (low != NULL && high != NULL && !isnan(rc_piece_metres(rc_piece_bare(unit))))
        snprintf(text, sizeof text, "%s [%.*s]", high, (int)rc_piece_bare(unit).n,
                 rc_piece_bare(unit).text);
    else if (low != NULL)
        snprintf(text, sizeof text, "%s", low);
    rc_text_clean(title, TITLE, text, strlen(text)); /* title of one line */
    for (char *s = title; *s != '\0'; s++)
        if (*s == '\t' || *s == '"')
            *s = ' ';
}

/* The unit behind the number in a text such as "0.08mm" or "Ra  0.018 um"; "" for none. */
static void
unit_in(const char *text, char unit[16])
{
    struct rc_piece rest = {text, text == NULL ? 0 : strlen(text)}, word;
    double number;

    unit[0] = '\0';
    while (rest.n > 0 && !rc_piece_number(rest, &number, &word)) {
        rest.text++;
        rest.n--;
    }
    if (rest.n > 0 && word.n > 0 && !isnan(rc_piece_metres(word)))
        rc_text_clean(unit, 16, word.text, word.n);
}

/* The titles of a profile of SurfTest; "" for another profile. */
static void
mitutoyo_titles(const struct rc_workbook *w, const struct block *b, char x[TITLE], char z[TITLE])
{
    char x_unit[16] = "", z_unit[16] = "";

    for (size_t k = 0; k < w->sheets; k++)
        for (size_t c = 0; c < w->sheet[k].n; c++) {
            const struct rc_cell *cell = &w->sheet[k].cell[c];

            if (cell->text != 0 && strcmp(w->text + cell->text - 1, "Cut-Off") == 0)
                unit_in(rc_workbook_text(w, &w->sheet[k], cell->row, cell->column + 1), x_unit);
        }
    unit_in(rc_workbook_text(w, b->sheet, 1, 1), z_unit);
    if (x_unit[0] == '\0' || z_unit[0] == '\0')
        return;
    snprintf(x, TITLE, "x [%s]", x_unit);
    snprintf(z, TITLE, "z [%s]", z_unit);
}

/* ---- a block as text ---- */

struct text {
    char *bytes;
    size_t n, capacity;
};

static bool
put(struct text *t, const char *word, char end)
{
    size_t n = strlen(word);

    if (t->capacity - t->n < n + 1) {
        size_t capacity = t->capacity + t->capacity / 2 + n + 4096;
        char *more = realloc(t->bytes, capacity);

        if (more == NULL)
            return false;
        t->bytes = more;
        t->capacity = capacity;
    }
    memcpy(t->bytes + t->n, word, n);
    t->bytes[t->n + n] = end;
    t->n += n + 1;
    return true;
}

/* Puts a row of numbers behind a text in its first column, the corner of positions. False where the row above
 * the block is different, or memory is short. */
static bool
put_positions(const struct rc_workbook *w, const struct block *b, struct text *t)
{
    uint32_t row = b->first - 1;
    const char *corner = row > 0 ? rc_workbook_text(w, b->sheet, row, b->left) : NULL;
    char title[TITLE];
    bool good;

    if (corner == NULL || b->right < b->left + 2)
        return false;
    for (uint32_t c = b->left + 1; c <= b->right; c++) {
        const struct rc_cell *cell = rc_workbook_cell(b->sheet, row, c);

        if (cell == NULL || cell->text != 0 || !isfinite(cell->number))
            return false;
    }
    title_of(w, b, b->left, title);
    good = put(t, title, '\t');
    for (uint32_t c = b->left + 1; good && c <= b->right; c++)
        good = put(t, rc_number(rc_workbook_cell(b->sheet, row, c)->number),
                   c == b->right ? '\n' : '\t');
    return good;
}

static bool
put_titles(const struct rc_workbook *w, const struct block *b, struct text *t)
{
    char title[TITLE], pair[2][TITLE] = {"", ""};
    uint32_t titled = 0, columns = b->right - b->left + 1;
    bool any, good = true;

    for (uint32_t c = b->left; c <= b->right; c++) {
        title_of(w, b, c, title);
        titled += title[0] != '\0';
    }
    any = titled > 0 &&
          titled + 1 >= columns; /* a text over one column or two is not a row of titles */
    if (titled == 0 && b->right == b->left + 1) {
        mitutoyo_titles(w, b, pair[0], pair[1]);
        any = pair[0][0] != '\0';
    }
    for (uint32_t c = b->left; good && any && c <= b->right; c++) {
        title_of(w, b, c, title);
        good = put(t,
                   title[0] != '\0'          ? title
                   : b->right == b->left + 1 ? pair[c - b->left]
                                             : "-",
                   c == b->right ? '\n' : '\t');
    }
    return good;
}

/* Returns the block with its titles, with tabs between columns. The caller frees it. */
static enum rc_status
make_text(const struct rc_workbook *w, const struct block *b, struct text *t, struct rc_err *err)
{
    const struct rc_sheet *s = b->sheet;
    char number[RC_NUMBER_SIZE];
    bool good = put_positions(w, b, t) || put_titles(w, b, t);
    size_t k = 0;

    if ((size_t)(b->last - b->first + 1) * (b->right - b->left + 1) > 2 * b->numbers + 64)
        return rc_err_set(err, "the block has more empty cells than numbers");
    while (k < s->n && s->cell[k].row < b->first)
        k++;
    for (uint32_t row = b->first; good && row <= b->last; row++)
        for (uint32_t c = b->left; good && c <= b->right; c++) {
            while (k < s->n &&
                   (s->cell[k].row < row || (s->cell[k].row == row && s->cell[k].column < c)))
                k++;
            if (k < s->n && s->cell[k].row == row && s->cell[k].column == c &&
                s->cell[k].text == 0 && isfinite(s->cell[k].number))
                rc_number_text(number, s->cell[k].number);
            else
                strcpy(number, "NaN");
            good = put(t, number, c == b->right ? '\n' : '\t');
        }
    return good ? RC_OK : rc_err_set(err, "out of memory for %zu bytes of text", t->n);
}

/* ---- channels ---- */

static void
column_name(uint32_t column, char name[4])
{
    char back[4];
    size_t n = 0;

    for (; column > 0 && n < 3; column = (column - 1) / 26)
        back[n++] = (char)('A' + (column - 1) % 26);
    for (size_t k = 0; k < n; k++)
        name[k] = back[n - 1 - k];
    name[n] = '\0';
}

static void
block_name(const struct block *b, char name[64])
{
    char left[4], right[4], text[128];

    column_name(b->left, left);
    column_name(b->right, right);
    snprintf(text, sizeof text, "%.40s %s%u:%s%u", b->sheet->name, left, b->first, right, b->last);
    rc_text_clean(name, 64, text, strlen(text));
}

/* Puts the place of the block before the reason. */
static void
say_where(const struct block *b, struct rc_err *err)
{
    char name[64], why[sizeof err->text];

    if (err == NULL)
        return;
    block_name(b, name);
    memcpy(why, err->text, sizeof why);
    rc_err_set(err, "%s: %.400s", name, why);
}

/* A workbook and its blocks, each as a file of text and the maps in it. */
struct book {
    struct rc_workbook workbook;
    struct columns columns;
    struct blocks blocks;
    struct rc_wish wish;
    struct opened {
        struct text text;
        struct rc_file file;
        struct rc_maps *maps;
    } opened[BLOCKS_MOST];
};

static void
book_close(void *opened)
{
    struct book *k = opened;

    for (size_t n = 0; n < BLOCKS_MOST; n++) {
        rc_maps_free(k->opened[n].maps);
        free(k->opened[n].text.bytes);
    }
    rc_workbook_free(&k->workbook);
}

/* Opens block n as text. */
static enum rc_status
open_block(struct book *k, size_t n, struct rc_err *err)
{
    const struct block *b = &k->blocks.block[n];
    struct opened *o = &k->opened[n];

    if (make_text(&k->workbook, b, &o->text, err) == RC_OK) {
        o->file = (struct rc_file){"sheet.txt", (const unsigned char *)o->text.bytes, o->text.n};
        o->maps = rc_format_open(b->right - b->left < 2 ? rc_format_named("profile") : NULL,
                                 &o->file, &k->wish, err);
    }
    if (o->maps != NULL)
        return RC_OK;
    free(o->text.bytes);
    o->text.bytes = NULL;
    say_where(b, err);
    return RC_FAIL;
}

static enum rc_status
fill_block(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    struct book *k = map->opened;
    struct opened *o = &k->opened[map->more];
    struct rc_map *inner = &o->maps->map[0];
    enum rc_status status;

    (void)file;
    inner->opened = o->maps->opened;
    inner->wish = &k->wish;
    inner->notes = map->notes;
    if ((status = inner->fill(&o->file, inner, v, err)) != RC_OK)
        say_where(&k->blocks.block[map->more], err);
    return status;
}

/* Each block that can be read as text is a channel. */
static enum rc_status
xlsx_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_err why = {""}, first = {"the workbook has no column of numbers"};
    struct book *k = rc_maps_open(maps, sizeof *k, book_close, err);

    if (k == NULL || rc_workbook_read(&k->workbook, file, err) != RC_OK)
        return RC_FAIL;
    for (size_t s = 0; s < k->workbook.sheets; s++) {
        find_runs(&k->workbook.sheet[s], &k->columns);
        find_blocks(&k->workbook.sheet[s], &k->columns, &k->blocks);
    }
    k->wish = *maps->wish;
    k->wish.separator = "\t";
    k->wish.decimal = '.';
    k->wish.missing = NULL;
    for (size_t n = 0; n < k->blocks.n; n++) {
        bool opened = open_block(k, n, &why) == RC_OK;
        struct rc_map *map = opened ? rc_maps_add(maps, rc_piece_of("")) : NULL;

        if (n == 0)
            first = why;
        if (map == NULL)
            continue;
        *map = k->opened[n].maps->map[0];
        block_name(&k->blocks.block[n], map->name);
        map->fill = fill_block;
        map->more = n;
    }
    return maps->n > 0 ? RC_OK : rc_err_set(err, "%s", first.text);
}

const struct rc_format rc_format_xlsx = {
    .name = "xlsx",
    .suffixes = ".xlsx .xlsm",
    .summary = "workbooks (XLSX): blocks of numbers as profiles and maps",
    .is = rc_workbook_is,
    .sure = 90,
    .find = xlsx_find,
};
