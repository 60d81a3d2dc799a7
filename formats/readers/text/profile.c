/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Profiles as text: a column of positions, evenly apart, and one of heights, after a header of any kind.
 * titled_table.h describes how units and roles are found. A column that counts the points is ignored, one
 * titled "valid" marks missing points by 0, and further ones are channels. A single column is of heights.
 */
#include <math.h>
#include <stdlib.h>

#include "titled_table.h"
#include "formats/format.h"

struct profile {
    struct rc_titled_table *table;
    size_t x, valid;                      /* columns; valid = columns: none */
    size_t height[RC_MAPS_MOST], heights; /* columns of heights */
    bool falls;                           /* the positions do */
    bool known;                           /* the columns are */
    double *at;                           /* positions, rising; NULL: a single column */
    struct rc_even even;
};

static const double *
column(const struct profile *p, size_t c)
{
    return p->table->v + c;
}

/* ---- columns ---- */

static bool
counts(const struct profile *p, size_t c)
{
    const double *v = column(p, c);
    size_t rows = p->table->numbers.rows, columns = p->table->numbers.columns;

    if (rc_titled_table_role(p->table, c) == RC_ROLE_INDEX)
        return true;
    for (size_t k = 0; k < rows; k++)
        if (v[k * columns] != v[0] + (double)k)
            return false;
    return rows > 1 && (v[0] == 0 || v[0] == 1) && rc_titled_table_unit(p->table, c, 'x').n == 0;
}

/* The column of positions: by its title, otherwise the first that does not number the points. */
static size_t
positions_of(const struct profile *p)
{
    const struct rc_titled_table *t = p->table;
    size_t columns = t->numbers.columns, x = rc_titled_table_column(t, RC_ROLE_X);

    if (x == columns && rc_titled_table_column(t, RC_ROLE_Z) < columns)
        x = rc_titled_table_column(t, RC_ROLE_Y);
    if (x < columns)
        return x;
    return columns > 2 && t->titles > 2 && counts(p, 0);
}

/* Finds the columns of heights: the others, except columns that are known not to be heights. */
static void
find_heights(struct profile *p)
{
    const struct rc_titled_table *t = p->table;
    size_t columns = t->numbers.columns;

    for (size_t c = 0; c < columns; c++)
        if (c != p->x && c != p->valid &&
            (c > 0 || columns < 3 || t->titles < 3 || !counts(p, c)) &&
            rc_titled_table_role(t, c) != RC_ROLE_INDEX && p->heights < RC_MAPS_MOST)
            p->height[p->heights++] = c;
}

static enum rc_status
pick_columns(struct profile *p, struct rc_err *err)
{
    struct rc_titled_table *t = p->table;
    size_t columns = t->numbers.columns;

    if (columns == 1) {
        p->valid = p->heights = 1;
        return rc_titled_table_read(t, err);
    }
    if (columns > 2 && t->titles < 2)
        return rc_err_set(err,
                          "a table of %zu columns without titles: which are positions and heights?",
                          columns);
    if (rc_titled_table_is_matrix(t))
        return rc_err_set(err,
                          "the titles of %zu columns name no axis: that is a matrix, no profile; "
                          "--format ascii reads it",
                          columns);
    if (columns > 2 && rc_titled_table_column(t, RC_ROLE_X) < columns &&
        rc_titled_table_column(t, RC_ROLE_Y) < columns &&
        rc_titled_table_column(t, RC_ROLE_Z) < columns)
        return rc_err_set(err, "the titles name x, y and z: that is a list of points, no profile; "
                               "--format xyz reads it");
    p->known = true;
    if (rc_titled_table_read(t, err) != RC_OK)
        return RC_FAIL;
    p->valid = rc_titled_table_column(t, RC_ROLE_VALID);
    p->x = positions_of(p);
    find_heights(p);
    if (p->x == p->valid || p->heights == 0)
        return rc_err_set(err, "there are no columns of positions and heights in the table");
    return RC_OK;
}

/* ---- positions ---- */

/* Takes the positions; those that fall are turned round: the last point becomes the first node, at the same
 * place as before. */
static enum rc_status
take_positions(struct profile *p, struct rc_err *err)
{
    size_t rows = p->table->numbers.rows, columns = p->table->numbers.columns;
    const double *x = column(p, p->x);

    if (rows < 3)
        return rc_err_set(err, "a profile has 3 points at least, this table has %zu rows", rows);
    if ((p->at = calloc(rows, sizeof *p->at)) == NULL)
        return rc_err_set(err, "out of memory for %zu points", rows);
    p->falls = x[columns] < x[0];
    for (size_t k = 0; k < rows; k++) {
        double d = k == 0 ? 1 : (x[k * columns] - x[(k - 1) * columns]) * (p->falls ? -1 : 1);
        if (!isfinite(x[k * columns]) || !(d > 0))
            return rc_err_set(err,
                              "the positions change direction at row %zu of the table, which is "
                              "read as a profile; for a matrix give --format ascii",
                              k + 1);
        p->at[p->falls ? rows - 1 - k : k] = x[k * columns];
    }
    return RC_OK;
}

static enum rc_status
profile_open(void *found, struct rc_titled_table *table, struct rc_err *err)
{
    struct profile *p = found;
    struct rc_piece unit;

    p->table = table;
    if (rc_titled_table_check(table, err) != RC_OK || pick_columns(p, err) != RC_OK)
        return RC_FAIL;
    p->even.n = table->numbers.rows;
    if (table->numbers.columns == 1)
        return RC_OK;
    unit = rc_titled_table_unit(table, p->x, 'x');
    if (unit.n > 0 && isnan(rc_piece_metres(unit)))
        return rc_err_set(err, "the positions are in '%s', which is not a length",
                          rc_piece_shown(unit));
    return take_positions(p, err);
}

static void
profile_close(void *found)
{
    free(((struct profile *)found)->at);
}

static const struct rc_table_kind kind = {RC_TABLE_PROFILE, sizeof(struct profile), profile_open,
                                          profile_close};

/* ---- the map ---- */

static enum rc_status
fill_heights(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    const struct rc_titled_table *t = map->opened;
    const struct profile *p = t->as[RC_TABLE_PROFILE].found;
    size_t rows = t->numbers.rows, columns = t->numbers.columns;
    RC_OWNED double *z = malloc(rows * sizeof *z);

    (void)file;
    if (z == NULL)
        return rc_err_set(err, "out of memory for %zu points", rows);
    for (size_t k = 0; k < rows; k++) {
        const double *row = t->v + (p->falls ? rows - 1 - k : k) * columns;

        z[k] = p->valid < columns && row[p->valid] == 0 ? NAN : row[map->more];
    }
    rc_even_heights(&p->even, p->at, z, rows, v, map->notes);
    rc_titled_table_left_out(t, map->notes);
    return RC_OK;
}

static void
add_heights(const struct profile *p, size_t c, struct rc_maps *maps)
{
    struct rc_map *map =
        rc_maps_add(maps, p->heights > 1 ? rc_titled_table_name(p->table, c) : rc_piece_of(""));

    map->nx = p->even.n;
    map->ny = 1;
    map->more = c;
    if (p->at != NULL)
        rc_map_steps(map, p->even.step, p->even.step, rc_titled_table_unit(p->table, p->x, 'x'));
    map->fill = fill_heights;
    rc_map_unit(map, rc_titled_table_unit(p->table, c, 'z'));
}

/* Places even nodes along the profile. */
static enum rc_status
profile_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    enum rc_status status;
    struct profile *p = rc_table_as(maps, &kind, &status, err);
    double metres;

    if (status != RC_OK)
        return RC_FAIL;
    metres = rc_piece_metres(rc_titled_table_unit(p->table, p->x, 'x'));
    if (isnan(metres) && maps->wish->xy_unit > 0)
        metres = maps->wish->xy_unit;
    if (p->at != NULL &&
        rc_even_new(p->at, p->even.n, metres, file, maps->wish, &p->even, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < p->heights; k++)
        add_heights(p, p->height[k], maps);
    return RC_OK;
}

/* 3: the refusal of a table names its error; one column could have any meaning. */
static int
profile_score(struct rc_maps *maps)
{
    enum rc_status status;
    const struct profile *p = rc_table_as(maps, &kind, &status, NULL);

    return p == NULL || !p->known ? 0 : status == RC_OK ? 60 : 3;
}

const struct rc_format rc_format_profile = {
    .name = "profile",
    .suffixes = ".txt .csv .asc .hfm",
    .summary = "profiles as text: positions and heights",
    .score_open = profile_score,
    .find = profile_find,
    .columns = true,
};
