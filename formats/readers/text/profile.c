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
    struct rc_titled_table table;
    size_t x, z, valid;                   /* columns; valid = columns: none */
    bool falls;                           /* the positions do */
    size_t height[RC_MAPS_MOST], heights; /* columns of heights; z is the first */
};

static const double *
column(const struct profile *p, size_t c)
{
    return p->table.v + c;
}

/* ---- columns ---- */

static bool
counts(const struct profile *p, size_t c)
{
    const double *v = column(p, c);
    size_t rows = p->table.numbers.rows, columns = p->table.numbers.columns;

    if (rc_titled_table_role(&p->table, c) == RC_ROLE_INDEX)
        return true;
    for (size_t k = 0; k < rows; k++)
        if (v[k * columns] != v[0] + (double)k)
            return false;
    return rows > 1 && (v[0] == 0 || v[0] == 1) && rc_titled_table_unit(&p->table, c, 'x').n == 0;
}

/* The column of positions: by its title, otherwise the first that does not number the points. */
static size_t
positions_of(const struct profile *p)
{
    const struct rc_titled_table *t = &p->table;
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
    const struct rc_titled_table *t = &p->table;
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
    const struct rc_titled_table *t = &p->table;
    size_t columns = t->numbers.columns;

    p->heights = 0;
    if (columns == 1) {
        p->z = 0;
        p->valid = 1;
        p->height[0] = 0;
        p->heights = 1;
        return rc_titled_table_read(&p->table, err);
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
    if (rc_titled_table_read(&p->table, err) != RC_OK)
        return RC_FAIL;
    p->valid = rc_titled_table_column(t, RC_ROLE_VALID);
    p->x = positions_of(p);
    find_heights(p);
    p->z = p->height[0];
    if (p->x == p->valid || p->heights == 0)
        return rc_err_set(err, "there are no columns of positions and heights in the table");
    return RC_OK;
}

/* ---- positions ---- */

static enum rc_status
judge_direction(struct profile *p, struct rc_err *err)
{
    size_t rows = p->table.numbers.rows, columns = p->table.numbers.columns;
    const double *x = column(p, p->x);

    if (rows < 3)
        return rc_err_set(err, "a profile has 3 points at least, this table has %zu rows", rows);
    p->falls = x[columns] < x[0];
    for (size_t k = 0; k < rows; k++) {
        double d = k == 0 ? 1 : (x[k * columns] - x[(k - 1) * columns]) * (p->falls ? -1 : 1);
        if (!isfinite(x[k * columns]) || !(d > 0))
            return rc_err_set(err,
                              "the positions change direction at row %zu of the table, which is "
                              "read as a profile; for a matrix give --format ascii",
                              k + 1);
    }
    return RC_OK;
}

static enum rc_status
profile_open(struct profile *p, const struct rc_file *file, const struct rc_wish *wish,
             struct rc_err *err)
{
    struct rc_piece unit;

    if (rc_titled_table_open(&p->table, file, 2, wish, NULL) != RC_OK) {
        rc_titled_table_close(&p->table);
        if (rc_titled_table_open(&p->table, file, 1, wish, err) != RC_OK)
            return RC_FAIL;
    }
    if (pick_columns(p, err) != RC_OK)
        return RC_FAIL;
    p->falls = false;
    if (p->table.numbers.columns == 1)
        return RC_OK;
    unit = rc_titled_table_unit(&p->table, p->x, 'x');
    if (unit.n > 0 && isnan(rc_piece_metres(unit)))
        return rc_err_set(err, "the positions are in '%s', which is not a length",
                          rc_piece_shown(unit));
    return judge_direction(p, err);
}

/* ---- the map ---- */

static double
height_of(const struct profile *p, size_t row)
{
    const double *v = p->table.v + row * p->table.numbers.columns;

    return p->valid < p->table.numbers.columns && v[p->valid] == 0 ? NAN : v[p->z];
}

/* Places even nodes along the profile and, unless v is NULL, stores their heights in v. A profile whose
 * positions fall is turned round: its last point becomes the first node, at the same place as before. */
static enum rc_status
lay_nodes(const struct profile *p, const struct rc_file *file, const struct rc_wish *wish,
          struct rc_even *even, double *v, struct rc_notes *notes, struct rc_err *err)
{
    size_t rows = p->table.numbers.rows, columns = p->table.numbers.columns;
    RC_OWNED double *x = calloc(rows, 2 * sizeof *x);
    double *z;
    double metres = rc_piece_metres(rc_titled_table_unit(&p->table, p->x, 'x'));
    enum rc_status status;

    if (isnan(metres) && wish->xy_unit > 0)
        metres = wish->xy_unit;

    if (x == NULL)
        return rc_err_set(err, "out of memory for %zu points", rows);
    z = x + rows;
    for (size_t k = 0; k < rows; k++) {
        size_t row = p->falls ? rows - 1 - k : k;
        x[k] = column(p, p->x)[row * columns];
        z[k] = height_of(p, row);
    }
    status = rc_even_new(x, rows, metres, file, wish, even, err);
    if (status == RC_OK && v != NULL)
        rc_even_heights(even, x, z, rows, v, notes);
    return status;
}

static enum rc_status
fill_heights(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    enum rc_status status;
    struct rc_even even;
    struct profile p;

    status = profile_open(&p, file, map->wish, err);
    p.z = map->more;
    if (status == RC_OK && p.table.numbers.columns > 1)
        status = lay_nodes(&p, file, map->wish, &even, v, map->notes, err);
    else
        for (size_t k = 0; k < map->nx && status == RC_OK; k++)
            v[k] = height_of(&p, k);
    if (status == RC_OK)
        rc_titled_table_left_out(&p.table, map->notes);
    rc_titled_table_close(&p.table);
    return status;
}

static void
add_heights(const struct profile *p, size_t c, const struct rc_even *even, struct rc_maps *maps)
{
    struct rc_map *map =
        rc_maps_add(maps, p->heights > 1 ? rc_titled_table_name(&p->table, c) : rc_piece_of(""));

    map->nx = even->n;
    map->ny = 1;
    map->more = c;
    if (p->table.numbers.columns > 1)
        rc_map_steps(map, even->step, even->step, rc_titled_table_unit(&p->table, p->x, 'x'));
    map->fill = fill_heights;
    rc_map_unit(map, rc_titled_table_unit(&p->table, c, 'z'));
}

static enum rc_status
profile_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    enum rc_status status;
    struct rc_even even = {0};
    struct profile p;

    status = profile_open(&p, file, maps->wish, err);
    even.n = p.table.numbers.rows;
    if (status == RC_OK && p.table.numbers.columns > 1)
        status = lay_nodes(&p, file, maps->wish, &even, NULL, NULL, err);
    for (size_t k = 0; status == RC_OK && k < p.heights; k++)
        add_heights(&p, p.height[k], &even, maps);
    rc_titled_table_close(&p.table);
    return status;
}

static int
profile_score(const struct rc_file *file)
{
    struct profile p;
    int score;

    if (!rc_file_is_text(file) && !rc_file_is_utf16(file))
        return 0;
    score = profile_open(&p, file, &rc_no_wish, NULL) == RC_OK ? 60 : 3;
    /* 3: the refusal of a table names its error; one column could have any meaning */
    if (p.table.v == NULL || p.table.numbers.columns < 2)
        score = 0;
    rc_titled_table_close(&p.table);
    return score;
}

const struct rc_format rc_format_profile = {
    .name = "profile",
    .suffixes = ".txt .csv .asc .hfm",
    .summary = "profiles as text: positions and heights",
    .score = profile_score,
    .find = profile_find,
    .columns = true,
};
