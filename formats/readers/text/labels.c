/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "labels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    SURE = 8 /* with so many numbers, consecutive integers are labels beside any heights */
};

/* The first row and column of a table, and their properties. */
struct edges {
    const struct rc_number_table *table;
    double *top, *left;         /* with the corner; if the titles are numbers, top has the titles */
    size_t columns, rows;       /* lengths of top and left: `rows` includes the titles if they are
                                   numbers */
    bool numeric_titles, words; /* titles that are numbers, or that are not                   */
    bool open;                  /* the corner is not a number */
    struct rc_piece corner;
    double *v; /* all values of the table, read when needed */
};

/* ---- rows of numbers ---- */

static bool
counts(const double *v, size_t n)
{
    for (size_t k = 0; k < n; k++)
        if (v[k] != v[0] + (double)k)
            return false;
    return n > 1 && v[0] == rint(v[0]);
}

/* True if the numbers rise or fall evenly; also gives the step. */
static bool
is_even(const double *v, size_t n, double *step)
{
    RC_OWNED double *x = n > 1 ? malloc(n * sizeof *x) : NULL;
    bool even = false;

    if (x != NULL) {
        memcpy(x, v, n * sizeof *x);
        even = rc_axis_step("", x, n, step, NULL) == RC_OK;
    }
    return even;
}

/* ---- the inside of the table ---- */

static enum rc_status
read_all(struct edges *e, struct rc_err *err)
{
    struct rc_number_table table = *e->table;
    size_t n;

    if (e->v != NULL)
        return RC_OK;
    if (rc_number_table_size(&table, &n, err) != RC_OK)
        return RC_FAIL;
    if ((e->v = malloc(n * sizeof *e->v)) == NULL)
        return rc_err_set(err, "out of memory for %zu values", n);
    return rc_number_table_read(&table, e->v, err);
}

/* True if a value outside the first row and column is not an integer. */
static bool
has_fractions(const struct edges *e)
{
    size_t columns = e->table->columns;

    for (size_t j = 1; j < e->table->rows; j++)
        for (size_t i = 1; i < columns; i++)
            if (e->v[j * columns + i] != rint(e->v[j * columns + i]) &&
                isfinite(e->v[j * columns + i]))
                return true;
    return false;
}

/* True if the second row or column rises evenly too: then the first one has heights. */
static bool
goes_on(const struct edges *e, bool row)
{
    size_t columns = e->table->columns, rows = e->table->rows, n = row ? columns : rows;
    RC_OWNED double *line = malloc(n * sizeof *line);
    double step;

    if (line == NULL)
        return true;
    for (size_t k = 0; k < n; k++)
        line[k] = row ? e->v[(rows > 1) * columns + k] : e->v[k * columns + 1];
    return is_even(line, n, &step);
}

/* ---- the edges ---- */

static void
edges_free(struct edges *e)
{
    free(e->top);
    free(e->left);
    free(e->v);
}

/* Puts the titles, where all but the first are numbers, in place of the first row. */
static void
take_titles(struct edges *e, const struct rc_titled_table *titled)
{
    struct rc_piece line = titled->title_line, title, rest;
    bool cornered = titled->titles == e->columns;
    size_t n = !cornered;
    double value;

    if (!cornered && titled->titles + 1 != e->columns)
        return;
    e->words = true;
    e->corner = (struct rc_piece){"", 0};
    for (size_t k = 0; rc_title_next(&line, titled->title_separator, &title) && n < e->columns;
         k++) {
        title = rc_piece_bare(title);
        if (k == 0 && cornered)
            e->corner = title;
        else if (!rc_piece_number(title, &value, &rest) || rest.n > 0)
            return;
        else
            e->top[n] = value;
        n++;
    }
    e->top[0] = NAN;
    e->numeric_titles = n == e->columns;
    e->words = !e->numeric_titles;
}

static enum rc_status
edges_find(struct edges *e, const struct rc_number_table *t, const struct rc_titled_table *titled,
           struct rc_err *err)
{
    *e = (struct edges){.table = t, .columns = t->columns, .rows = t->rows};
    e->top = malloc((t->columns + 1) * sizeof *e->top);
    e->left = malloc((t->rows + 1) * sizeof *e->left);
    if (e->top == NULL || e->left == NULL)
        return rc_err_set(err, "out of memory for a row and a column");
    if (rc_number_table_edges(t, e->top, e->left + 1, err) != RC_OK)
        return RC_FAIL;
    if (titled != NULL)
        take_titles(e, titled);
    if (e->numeric_titles) {
        e->left[0] = NAN;
        e->rows++;
    } else
        memmove(e->left, e->left + 1, t->rows * sizeof *e->left);
    e->open = isnan(e->top[0]);
    return RC_OK;
}

/* ---- decisions ---- */

static bool
is_alone(const struct edges *e, bool row, struct rc_labels *l, struct rc_err *err,
         enum rc_status *status)
{
    const double *v = row ? e->top : e->left;
    size_t n = row ? e->columns : e->rows;
    double step;
    struct edges *all = (struct edges *)e;

    if (e->numeric_titles || (row && e->words) || !is_even(v, n, &step))
        return false;
    if ((*status = read_all(all, err)) != RC_OK)
        return false;
    if (counts(v, n) && n > 2 && !goes_on(e, row) &&
        (v[0] == 0 || v[0] == 1 ? n >= SURE || has_fractions(e) : n >= SURE && has_fractions(e)))
        return true;
    if (n > 3 && !goes_on(e, row))
        l->doubtful = row ? "row" : "column";
    return false;
}

/* "y [mm]\x [um]", "x/y (um)", "height [nm]". */
static void
corner_units(const struct edges *e, struct rc_labels *l)
{
    struct rc_piece before, after, unit = rc_title_unit(rc_piece_bare(e->corner));
    bool y_first = e->corner.n > 0 && (*e->corner.text | 0x20) == 'y';

    l->metres[0] = l->metres[1] = rc_piece_metres(unit);
    if (unit.n > 0 && rc_title_role(rc_piece_bare(e->corner)) == RC_ROLE_Z) {
        l->metres[0] = l->metres[1] = NAN;
        l->height_unit = unit;
        return;
    }
    if (!rc_piece_part(e->corner, "\\/|", &before, &after))
        return;
    if (isnan(rc_piece_metres(unit = rc_title_unit(rc_piece_bare(before)))))
        return;
    l->metres[y_first] = rc_piece_metres(unit);
    if (!isnan(rc_piece_metres(unit = rc_title_unit(rc_piece_bare(after)))))
        l->metres[!y_first] = rc_piece_metres(unit);
}

/* True if the corner allows labels or positions beside `n` and `m` numbers. */
static bool
corner_allows(const struct edges *e)
{
    double corner = e->top[0], n = (double)(e->columns - 1);

    if (e->open)
        return e->columns > 2 && e->rows > 2;
    return e->columns > 3 && e->rows > 3 && (corner == 0 || corner == n || corner == n + 1);
}

static enum rc_status
judge_both(struct edges *e, struct rc_labels *l, const struct rc_wish *wish, struct rc_err *err)
{
    bool counted = counts(e->top + 1, e->columns - 1) && counts(e->left + 1, e->rows - 1);
    bool even = is_even(e->top + 1, e->columns - 1, &l->step[0]) &&
                is_even(e->left + 1, e->rows - 1, &l->step[1]);

    if (!even)
        return RC_OK;
    if (!e->open) { /* the corner may be a height, and the table a plane */
        if (read_all(e, err) != RC_OK)
            return RC_FAIL;
        if (goes_on(e, true) && goes_on(e, false))
            return RC_OK;
    }
    corner_units(e, l);
    l->positions = !counted || !isnan(l->metres[0]) || wish->xy_unit > 0;
    l->falls[0] = e->top[2] < e->top[1];
    l->falls[1] = e->left[2] < e->left[1];
    l->rows = !e->numeric_titles;
    l->columns = 1;
    l->counted_titles = e->numeric_titles;
    return RC_OK;
}

/* A row of labels without a column of labels. */
static enum rc_status
judge_row_alone(const struct edges *e, struct rc_err *err)
{
    double step;

    if (!e->open || e->columns < 4 || e->rows < 4 || !is_even(e->top + 1, e->columns - 1, &step))
        return RC_OK;
    return rc_err_set(err,
                      "the first row, behind an empty corner, holds positions or labels, the first "
                      "column (%s, ...) neither rises evenly nor counts: --labels keep, row, "
                      "column or both says which are not heights",
                      rc_number(e->left[1]));
}

static bool
names_rows(const struct edges *e)
{
    return e->words &&
           (e->corner.n == 0 || rc_title_role(rc_piece_bare(e->corner)) == RC_ROLE_INDEX);
}

static enum rc_status
decide(struct edges *e, struct rc_labels *l, const struct rc_wish *wish, struct rc_err *err)
{
    enum rc_status status = RC_OK;

    if (!e->words && corner_allows(e)) {
        if (judge_both(e, l, wish, err) != RC_OK)
            return RC_FAIL;
        if (l->columns > 0)
            return RC_OK;
        if (judge_row_alone(e, err) != RC_OK)
            return RC_FAIL;
    }
    if (names_rows(e) && counts(e->left, e->rows))
        l->columns = 1;
    else if (is_alone(e, true, l, err, &status))
        l->rows = 1;
    else if (status == RC_OK && is_alone(e, false, l, err, &status))
        l->columns = 1;
    return status;
}

enum rc_status
rc_labels_find(const struct rc_number_table *t, const struct rc_titled_table *titled,
               const struct rc_wish *wish, struct rc_labels *l, struct rc_err *err)
{
    enum rc_status status = RC_FAIL;
    struct edges e;

    *l = (struct rc_labels){.step = {NAN, NAN}, .metres = {NAN, NAN}, .height_unit = {"", 0}};
    if (wish->labels == RC_LABELS_ROW || wish->labels == RC_LABELS_BOTH)
        l->rows = 1;
    if (wish->labels == RC_LABELS_COLUMN || wish->labels == RC_LABELS_BOTH)
        l->columns = 1;
    if (t->columns < 3 || t->rows < 2)
        l->rows = l->columns = 0;
    if (wish->labels == RC_LABELS_KEEP || t->columns < 3 || t->rows < 2)
        return RC_OK;
    if ((status = edges_find(&e, t, titled, err)) == RC_OK) {
        if (wish->labels == RC_LABELS_FOUND)
            status = decide(&e, l, wish, err);
        else if (e.numeric_titles)
            l->rows = 0; /* the titles are passed over anyway */
    }
    edges_free(&e);
    return status;
}

/* ---- spacings ---- */

/* A unit of length that makes the step this long; NAN: none does. */
static double
unit_between(double step, double metres)
{
    static const double units[] = {1, 1e-2, 1e-3, 1e-6, 1e-9, 1e-10, 25.4e-3, 25.4e-6, 25.4e-9};

    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (fabs(step * units[k] / metres - 1) < 1e-3)
            return units[k];
    return NAN;
}

enum rc_status
rc_labels_spacing(const struct rc_labels *l, const struct rc_wish *wish, double *dx, double *dy,
                  struct rc_err *err)
{
    double unit = wish->xy_unit > 0 ? wish->xy_unit : NAN;
    char x[RC_NUMBER_SIZE], y[RC_NUMBER_SIZE];

    *dx = *dy = NAN;
    if (!l->positions)
        return RC_OK;
    if (isnan(unit) && !isnan(l->metres[0]) && !isnan(l->metres[1])) {
        *dx = l->step[0] * l->metres[0];
        *dy = l->step[1] * l->metres[1];
        return RC_OK;
    }
    rc_number_text(x, l->step[0]);
    rc_number_text(y, l->step[1]);
    if (isnan(unit) && isnan(wish->dx))
        return rc_err_set(err,
                          "the first row and column are positions, %s and %s apart, without a "
                          "unit: give --xy-unit UNIT, or --labels keep if they are heights",
                          x, y);
    if (isnan(unit)) {
        unit = unit_between(l->step[0], wish->dx);
        *dx = wish->dx;
        *dy = isnan(wish->dy) ? l->step[1] * unit : wish->dy;
        if (!isnan(wish->dy) && !(fabs(l->step[1] * unit / wish->dy - 1) < 1e-3))
            unit = NAN;
        if (!isnan(unit))
            return RC_OK;
    }
    if (isnan(unit))
        return rc_err_set(err,
                          "the first row and column are positions, %s and %s apart, with which "
                          "--dx %s m%s do not agree in any unit: --xy-unit UNIT says theirs, "
                          "--labels both drops them, --labels keep takes them for heights",
                          x, y, rc_number(wish->dx), isnan(wish->dy) ? "" : " and --dy");
    *dx = l->step[0] * unit;
    *dy = l->step[1] * unit;
    return RC_OK;
}

void
rc_labels_note(const struct rc_labels *l, struct rc_notes *notes)
{
    bool both = (l->rows > 0 || l->counted_titles) && l->columns > 0;
    const char *what = both          ? "the first row and column"
                       : l->rows > 0 ? "the first row"
                                     : "the first column";

    if (l->positions)
        rc_note(notes,
                "%s are positions and give the spacing%s: --labels keep takes them for heights",
                what, l->falls[0] || l->falls[1] ? "; the map is turned where they fall" : "");
    else if (l->rows > 0 || l->columns > 0)
        rc_note(notes, "%s %s and %s left out: --labels keep takes %s for heights", what,
                both ? "are labels" : "holds labels", both ? "are" : "is", both ? "them" : "it");
    if (l->doubtful != NULL)
        rc_note(notes,
                "the first %s rises evenly and is read as heights: --labels %s takes it for labels",
                l->doubtful, l->doubtful);
}
