/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Lists of points: columns x, y, z in any order of the points, which must lie on a raster, or in one line.
 * The least x and y come first; a point of the raster that the list leaves out is missing. A line of any
 * direction is a profile, from its end that is nearer to the first point. titled_table.h describes how
 * units, and the roles of columns, are found. Three columns without titles are x, y, z in this order.
 * Titled ones may be more; further heights are channels.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "titled_table.h"
#include "formats/format.h"

struct cloud {
    struct rc_titled_table own; /* the table, with titles only where there is one for each column */
    const struct rc_titled_table *table; /* the same */
    size_t column[2 + RC_MAPS_MOST];     /* columns of x, y and the heights */
    size_t heights;                      /* number of height columns */
    struct rc_raster_axis x, y;
    struct place *place; /* points of a line, sorted; NULL: a raster */
    double *along;       /* their positions */
    struct rc_even even; /* nodes along it */
};

/* A point of a line. */
struct place {
    double along;
    size_t point;
};

/* x (0), y (1) or a height (2 and more) of a point. */
static double
value_of(const struct cloud *c, size_t point, size_t which)
{
    return c->table->v[point * c->table->numbers.columns + c->column[which]];
}

static int
by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* All x (0) or y (1) of the points; NULL with the reason. */
static double *
positions_of(const struct cloud *c, size_t which, struct rc_err *err)
{
    size_t points = c->table->numbers.rows;
    RC_OWNED double *at = malloc(points * sizeof *at);

    if (at == NULL)
        return rc_err_null(err, "out of memory for %zu points", points);
    for (size_t k = 0; k < points; k++) {
        at[k] = value_of(c, k, which);
        if (!isfinite(at[k]))
            return rc_err_null(err, "point %zu has no %c", k + 1, "xy"[which]);
    }
    return rc_give(&at);
}

static enum rc_status
find_axis(const struct cloud *c, size_t which, struct rc_raster_axis *axis, struct rc_err *err)
{
    size_t points = c->table->numbers.rows;
    RC_OWNED double *sorted = positions_of(c, which, err);

    if (sorted == NULL)
        return RC_FAIL;
    qsort(sorted, points, sizeof *sorted, by_value);
    return rc_raster_axis("xy"[which], sorted, points, axis, err);
}

/* Replaces the reason why there is no raster by that of a raster nearby. Always RC_FAIL. */
static enum rc_status
explain(const struct cloud *c, struct rc_err *err)
{
    RC_OWNED double *x = positions_of(c, 0, NULL);
    RC_OWNED double *y = positions_of(c, 1, NULL);

    return x == NULL || y == NULL ? RC_FAIL : rc_raster_explain(x, y, c->table->numbers.rows, err);
}

/* ---- points in a line ---- */

/* The point that is furthest from point k. */
static size_t
furthest_from(const struct cloud *c, size_t k)
{
    double x = value_of(c, k, 0), y = value_of(c, k, 1), most = 0;
    size_t far = k;

    for (size_t l = 0; l < c->table->numbers.rows; l++) {
        double away = hypot(value_of(c, l, 0) - x, value_of(c, l, 1) - y);

        if (away > most) {
            most = away;
            far = l;
        }
    }
    return far;
}

/* Sorts the points by their positions along the line between the two most distant ones. False when they are
 * not in a line, to a thousandth of its length, or two are at one place. */
static bool
find_line(struct cloud *c)
{
    size_t points = c->table->numbers.rows, first, last;
    RC_OWNED struct place *place = malloc(points * sizeof *place);
    RC_OWNED double *along = malloc(points * sizeof *along);
    bool line = place != NULL && along != NULL && points > 2;
    double dx, dy, length;

    if (!line)
        return false;
    last = furthest_from(c, 0);
    first = furthest_from(c, last);
    dx = value_of(c, last, 0) - value_of(c, first, 0);
    dy = value_of(c, last, 1) - value_of(c, first, 1);
    length = hypot(dx, dy);
    line = length > 0 && isfinite(length);
    for (size_t k = 0; k < points && line; k++) {
        double x = value_of(c, k, 0) - value_of(c, first, 0);
        double y = value_of(c, k, 1) - value_of(c, first, 1);

        place[k] = (struct place){(x * dx + y * dy) / length, k};
        line = fabs(x * dy - y * dx) <= 1e-3 * length * length;
    }
    if (line)
        qsort(place, points, sizeof *place, by_value);
    for (size_t k = 0; k < points && line; k++) {
        along[k] = place[k].along;
        line = k == 0 || along[k] > along[k - 1];
    }
    if (line) {
        c->place = rc_give(&place);
        c->along = rc_give(&along);
    }
    return line;
}

/* ---- units ---- */

/* Along an axis, A means Angstroms (WSxM). */
static double
metres_of(struct rc_piece unit)
{
    return rc_piece_is(unit, "A") ? 1e-10 : rc_piece_metres(unit);
}

/* Metres in one unit of x and of y; along a line of any direction NAN where they differ. */
static void
find_metres(const struct cloud *c, double metres[2])
{
    struct rc_piece x = rc_titled_table_unit(c->table, c->column[0], 'x');
    struct rc_piece y = rc_titled_table_unit(c->table, c->column[1], 'y');

    metres[0] = metres_of(x);
    metres[1] = y.n == 0 ? metres[0] : metres_of(y);
    if (c->along != NULL && metres[0] != metres[1])
        metres[0] = metres[1] = NAN;
}

static void
take_units(const struct cloud *c, size_t height, double dx, double dy, struct rc_map *map)
{
    double metres[2];

    find_metres(c, metres);
    map->dx = dx * metres[0];
    map->dy = dy * metres[1];
    if (isnan(map->dx) || isnan(map->dy)) {
        map->dx = map->dy = NAN;
        rc_map_hint(map, dx, dy);
    }
    rc_map_unit(map, rc_titled_table_unit(c->table, c->column[2 + height], 'z'));
}

/* ---- the list ---- */

/* Finds the columns of x, y and heights: by their titles, otherwise in this order. */
static enum rc_status
pick_columns(struct cloud *c, struct rc_err *err)
{
    const struct rc_titled_table *t = c->table;
    size_t columns = t->numbers.columns, of[3], next = 0;

    for (size_t k = 0; k < 3; k++)
        of[k] = rc_titled_table_column(t, (enum rc_role)(RC_ROLE_X + k));
    if (columns != 3 && (columns < 3 || of[0] == columns || of[1] == columns))
        return rc_err_set(
            err,
            "a list of points has 3 columns, this table has %zu and no titles that name x and y",
            columns);
    for (size_t k = 0; columns == 3 && k < 3; k++) { /* columns without a title are in the usual
                                                        order */
        while (next == of[0] || next == of[1] || next == of[2])
            next++;
        if (of[k] == columns)
            of[k] = next;
    }
    c->column[0] = of[0];
    c->column[1] = of[1];
    for (size_t k = 0; k < columns; k++) {
        enum rc_role role = rc_titled_table_role(t, k);

        if (k != of[0] && k != of[1] && c->heights < RC_MAPS_MOST &&
            (columns == 3 ? role != RC_ROLE_INDEX && role != RC_ROLE_VALID
                          : role == RC_ROLE_Z || role == RC_ROLE_NONE))
            c->column[2 + c->heights++] = k;
    }
    return c->heights > 0 ? RC_OK : rc_err_set(err, "there is no column of heights beside x and y");
}

static enum rc_status
cloud_open(void *found, struct rc_titled_table *table, struct rc_err *err)
{
    struct cloud *c = found;
    size_t points;

    c->own = *table;
    c->table = &c->own;
    if (table->titles != table->numbers.columns)
        c->own.titles = 0;
    if (rc_titled_table_check(table, err) != RC_OK || pick_columns(c, err) != RC_OK ||
        rc_titled_table_read(table, err) != RC_OK)
        return RC_FAIL;
    c->own.v = table->v;
    if (find_axis(c, 0, &c->x, err) != RC_OK || find_axis(c, 1, &c->y, err) != RC_OK)
        return find_line(c) ? RC_OK : explain(c, err);
    points = table->numbers.rows;
    if ((c->x.n < 2 || c->y.n > 4 * points / c->x.n) && !find_line(c))
        return c->x.n < 2 ? rc_err_set(err, "all points have the same x")
                          : rc_err_set(err,
                                       "the points lie on no raster: %zu of them have %zu "
                                       "different x and %zu different y",
                                       points, c->x.n, c->y.n);
    return RC_OK;
}

static void
cloud_close(void *found)
{
    free(((struct cloud *)found)->place);
    free(((struct cloud *)found)->along);
}

static const struct rc_table_kind kind = {RC_TABLE_POINTS, sizeof(struct cloud), cloud_open,
                                          cloud_close};

/* The heights of a line of points. */
static enum rc_status
fill_line(const struct cloud *c, const struct rc_map *map, double *v, struct rc_err *err)
{
    size_t points = c->table->numbers.rows;
    RC_OWNED double *z = malloc(points * sizeof *z);

    if (z == NULL)
        return rc_err_set(err, "out of memory for %zu points", points);
    for (size_t k = 0; k < points; k++)
        z[k] = value_of(c, c->place[k].point, 2 + map->more);
    rc_even_heights(&c->even, c->along, z, points, v, map->notes);
    return RC_OK;
}

static void
note_empty(const struct rc_raster_axis *axis, const char *lines, struct rc_notes *notes)
{
    if (axis->empty > 0)
        rc_note(notes, "%zu of %zu %s have no points and are missing", axis->empty, axis->n, lines);
}

static enum rc_status
fill_points(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    const struct cloud *c = ((struct rc_titled_table *)map->opened)->as[RC_TABLE_POINTS].found;
    RC_OWNED unsigned char *taken = NULL;

    (void)file;
    rc_titled_table_left_out(c->table, map->notes);
    if (c->along != NULL)
        return fill_line(c, map, v, err);
    note_empty(&c->x, "columns", map->notes);
    note_empty(&c->y, "rows", map->notes);
    if ((taken = calloc(map->nx, map->ny)) == NULL)
        return rc_err_set(err, "out of memory for %zu points", map->nx * map->ny);
    for (size_t k = 0; k < map->nx * map->ny; k++)
        v[k] = NAN;
    for (size_t k = 0; k < c->table->numbers.rows; k++) {
        size_t at = rc_raster_node(&c->y, value_of(c, k, 1)) * map->nx +
                    rc_raster_node(&c->x, value_of(c, k, 0));
        if (taken[at]++ != 0)
            return rc_err_set(err, "point %zu has the same position as another one", k + 1);
        v[at] = value_of(c, k, 2 + map->more);
    }
    return RC_OK;
}

static enum rc_status
xyz_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    enum rc_status status;
    struct cloud *c = rc_table_as(maps, &kind, &status, err);
    double metres[2];

    if (status != RC_OK)
        return RC_FAIL;
    find_metres(c, metres);
    if (c->along != NULL && rc_even_new(c->along, c->table->numbers.rows, metres[0], file,
                                        maps->wish, &c->even, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < c->heights; k++) {
        struct rc_map *map =
            rc_maps_add(maps, c->heights > 1 ? rc_titled_table_name(c->table, c->column[2 + k])
                                             : rc_piece_of(""));

        map->nx = c->along != NULL ? c->even.n : c->x.n;
        map->ny = c->along != NULL ? 1 : c->y.n;
        map->fill = fill_points;
        map->more = k;
        if (c->along != NULL)
            take_units(c, k, c->even.step, c->even.step, map);
        else
            take_units(c, k, c->x.step, c->y.n > 1 ? c->y.step : c->x.step, map);
    }
    return RC_OK;
}

/* True if it is a raster, of several rows or of one: another line may be columns of a matrix. */
static bool
runs_straight(const struct cloud *c)
{
    size_t last = c->table->numbers.rows - 1;

    return c->along == NULL || value_of(c, 0, 0) == value_of(c, last, 0) ||
           value_of(c, 0, 1) == value_of(c, last, 1);
}

/* 4: where the titles name x and y, the refusal names the error. */
static int
xyz_score(struct rc_maps *maps)
{
    bool named = rc_file_named(maps->file, ".xyz");
    enum rc_status status;
    const struct cloud *c = rc_table_as(maps, &kind, &status, NULL);

    if (status == RC_OK)
        return named ? 80 : c->table->numbers.rows > 3 && runs_straight(c) ? 60 : 0;
    if (c == NULL || c->table == NULL || c->table->numbers.columns < 3)
        return 0;
    if (named && c->table->numbers.columns == 3)
        return 50;
    return rc_titled_table_column(c->table, RC_ROLE_X) < c->table->numbers.columns &&
                   rc_titled_table_column(c->table, RC_ROLE_Y) < c->table->numbers.columns
               ? 4
               : 0;
}

const struct rc_format rc_format_xyz = {
    .name = "xyz",
    .suffixes = ".xyz .txt .csv",
    .summary = "points of a raster as text: x, y, z",
    .score_open = xyz_score,
    .find = xyz_find,
    .columns = true,
};
