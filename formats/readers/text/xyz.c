/*
 * Lists of points: columns x, y, z in any order of the points, which must lie on a raster, or in one line.
 * The least x and y come first; a point of the raster that the list leaves out is missing. A line of any
 * direction is a profile, from its end that is nearer to the first point. titled_table.h describes how units,
 * and the roles of columns, are found. Three columns without titles are x, y, z in this order. Titled ones
 * may be more; further heights are channels.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "titled_table.h"
#include "formats/format.h"

struct axis {
    double first, step;
    size_t n;
};

struct cloud {
    struct rc_titled_table table; /* after the choice its values are x, y and z */
    size_t column[2 + RC_MAPS_MOST],
        heights;   /* columns of x, y and the heights, and the number of height columns */
    size_t height; /* the height column that is z */
    struct axis x, y;
    struct rc_piece unit[3]; /* unit of the columns */
    double *along, *z;       /* points of a line, sorted by position; NULL: a raster */
};

static int
by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* The raster of one coordinate: its values, which may be rounded, lie near places that are evenly
 * apart. */
static enum rc_status
find_axis(const double *v, size_t points, char name, struct axis *axis, struct rc_err *err)
{
    RC_OWNED double *sorted = malloc(points * sizeof *sorted);
    double widest = 0, start;

    if (sorted == NULL)
        return rc_err_set(err, "out of memory for %zu points", points);
    for (size_t k = 0; k < points; k++) {
        sorted[k] = v[3 * k];
        if (!isfinite(sorted[k]))
            return rc_err_set(err, "point %zu has no %c", k + 1, name);
    }
    qsort(sorted, points, sizeof *sorted, by_value);
    for (size_t k = 1; k < points; k++)
        widest = fmax(widest, sorted[k] - sorted[k - 1]);
    *axis = (struct axis){.first = sorted[0], .n = 1, .step = 1};
    for (size_t k = 1; k < points; k++)
        axis->n += sorted[k] - sorted[k - 1] > 0.01 * widest;
    if (axis->n > 1)
        axis->step = (sorted[points - 1] - sorted[0]) / (double)(axis->n - 1);
    for (size_t k = 0; k < points; k++) {
        start = (sorted[k] - axis->first) / axis->step;
        if (!(fabs(start - round(start)) < 0.1))
            return rc_err_set(
                err, "the points are on no raster: %zu different %c from %s on, not evenly spaced",
                axis->n, name, rc_number(axis->first));
    }
    return RC_OK;
}

/* ---- points in a line ---- */

/* The point that is furthest from point k. */
static size_t
furthest_from(const double *p, size_t points, size_t k)
{
    size_t far = k;

    for (size_t l = 0; l < points; l++)
        if (hypot(p[3 * l] - p[3 * k], p[3 * l + 1] - p[3 * k + 1]) >
            hypot(p[3 * far] - p[3 * k], p[3 * far + 1] - p[3 * k + 1]))
            far = l;
    return far;
}

/* Sorts the points by their positions along the line between the two most distant ones. False when they are
 * not in a line, to a thousandth of its length, or two are at one place. */
static bool
find_line(struct cloud *c)
{
    size_t points = c->table.numbers.rows, first, last;
    const double *p = c->table.v;
    RC_OWNED double *pair = malloc(4 * points * sizeof *pair);
    double *sorted, dx, dy, length;
    bool line = pair != NULL && points > 2;

    last = line ? furthest_from(p, points, 0) : 0;
    first = line ? furthest_from(p, points, last) : 0;
    dx = p[3 * last] - p[3 * first];
    dy = p[3 * last + 1] - p[3 * first + 1];
    length = hypot(dx, dy);
    line = line && length > 0 && isfinite(length);
    for (size_t k = 0; k < points && line; k++) {
        double x = p[3 * k] - p[3 * first], y = p[3 * k + 1] - p[3 * first + 1];

        pair[2 * k] = (x * dx + y * dy) / length;
        pair[2 * k + 1] = p[3 * k + 2];
        line = fabs(x * dy - y * dx) <= 1e-3 * length * length;
    }
    if (line)
        qsort(pair, points, 2 * sizeof *pair, by_value);
    sorted = line ? pair + 2 * points : NULL;
    for (size_t k = 0; k < points && line; k++) {
        sorted[k] = pair[2 * k];
        sorted[points + k] = pair[2 * k + 1];
        line = k == 0 || sorted[k] > sorted[k - 1];
    }
    if (!line)
        return false;
    memmove(pair, sorted, 2 * points * sizeof *pair);
    c->z = pair + points;
    c->along = rc_give(&pair);
    return true;
}

/* ---- units ---- */

static void
find_units(struct cloud *c)
{
    c->unit[0] = rc_titled_table_unit(&c->table, c->column[0], 'x');
    c->unit[1] = rc_titled_table_unit(&c->table, c->column[1], 'y');
    c->unit[2] = rc_titled_table_unit(&c->table, c->column[2 + c->height], 'z');
    if (c->unit[1].n == 0)
        c->unit[1] = c->unit[0];
}

/* Along an axis, A means Angstroms (WSxM). */
static double
metres_of(struct rc_piece unit)
{
    return rc_piece_is(unit, "A") ? 1e-10 : rc_piece_metres(unit);
}

/* Metres in one unit along a line of any direction; NAN where it is not one unit. */
static double
metres_along(const struct cloud *c)
{
    double x = metres_of(c->unit[0]);

    return x == metres_of(c->unit[1]) ? x : NAN;
}

static void
take_units(const struct cloud *c, double dx, double dy, struct rc_map *map)
{
    map->dx = dx * (c->along != NULL ? metres_along(c) : metres_of(c->unit[0]));
    map->dy = dy * (c->along != NULL ? metres_along(c) : metres_of(c->unit[1]));
    if (isnan(map->dx) || isnan(map->dy)) {
        map->dx = map->dy = NAN;
        rc_map_hint(map, dx, dy);
    }
    rc_map_unit(map, c->unit[2]);
}

/* ---- the list ---- */

static void
cloud_close(struct cloud *c)
{
    free(c->along);
    rc_titled_table_close(&c->table);
}

/* Finds the columns of x, y and heights: by their titles, otherwise in this order. Words above them are
 * titles when there is one for each. */
static enum rc_status
pick_columns(struct cloud *c, struct rc_err *err)
{
    struct rc_titled_table *t = &c->table;
    size_t columns = t->numbers.columns, of[3], next = 0;

    if (t->titles != columns)
        t->titles = 0;
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
    c->heights = 0;
    for (size_t k = 0; k < columns; k++) {
        enum rc_role role = rc_titled_table_role(t, k);

        if (k != of[0] && k != of[1] && c->heights < RC_MAPS_MOST &&
            (columns == 3 ? role != RC_ROLE_INDEX && role != RC_ROLE_VALID
                          : role == RC_ROLE_Z || role == RC_ROLE_NONE))
            c->column[2 + c->heights++] = k;
    }
    return c->heights > 0 ? RC_OK : rc_err_set(err, "there is no column of heights beside x and y");
}

/* Puts x, y and z of every point together, in place. */
static void
pack_columns(struct cloud *c)
{
    const size_t from[3] = {c->column[0], c->column[1], c->column[2 + c->height]};
    double *v = c->table.v;

    for (size_t k = 0; k < c->table.numbers.rows; k++) {
        const double *row = c->table.v + k * c->table.numbers.columns;
        const double point[3] = {row[from[0]], row[from[1]], row[from[2]]};

        memcpy(v + 3 * k, point, sizeof point);
    }
}

/* Opens the list with one of its heights as z. */
static enum rc_status
cloud_open(struct cloud *c, const struct rc_file *file, const struct rc_wish *wish, size_t height,
           struct rc_err *err)
{
    c->along = NULL;
    c->height = height;
    if (rc_titled_table_open(&c->table, file, 2, wish, err) != RC_OK ||
        pick_columns(c, err) != RC_OK)
        return RC_FAIL;
    find_units(c);
    if (rc_titled_table_read(&c->table, err) != RC_OK)
        return RC_FAIL;
    pack_columns(c);
    if (find_axis(c->table.v, c->table.numbers.rows, 'x', &c->x, err) != RC_OK ||
        find_axis(c->table.v + 1, c->table.numbers.rows, 'y', &c->y, err) != RC_OK)
        return find_line(c) ? RC_OK : RC_FAIL;
    if (c->x.n < 2)
        return find_line(c) ? RC_OK : rc_err_set(err, "all points have the same x");
    if (c->y.n > 4 * c->table.numbers.rows / c->x.n && find_line(c))
        return RC_OK;
    if (c->y.n > 4 * c->table.numbers.rows / c->x.n)
        return rc_err_set(
            err,
            "the points lie on no raster: %zu of them have %zu different x and %zu different y",
            c->table.numbers.rows, c->x.n, c->y.n);
    return RC_OK;
}

static enum rc_status
fill_points(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    RC_OWNED unsigned char *taken = NULL;
    RC_ENDS(cloud_close) struct cloud c;

    if (cloud_open(&c, file, map->wish, map->more, err) != RC_OK)
        return RC_FAIL;
    rc_titled_table_left_out(&c.table, map->notes);
    if (c.along != NULL) {
        struct rc_even even;

        if (rc_even_new(c.along, c.table.numbers.rows, metres_along(&c), file, map->wish, &even,
                        err) != RC_OK)
            return RC_FAIL;
        rc_even_heights(&even, c.along, c.z, c.table.numbers.rows, v, map->notes);
        return RC_OK;
    }
    if ((taken = calloc(map->nx, map->ny)) == NULL)
        return rc_err_set(err, "out of memory for %zu points", map->nx * map->ny);
    for (size_t k = 0; k < map->nx * map->ny; k++)
        v[k] = NAN;
    for (size_t k = 0; k < c.table.numbers.rows; k++) {
        const double *p = c.table.v + 3 * k;
        size_t at = (size_t)lround((p[1] - c.y.first) / c.y.step) * map->nx +
                    (size_t)lround((p[0] - c.x.first) / c.x.step);
        if (taken[at]++ != 0)
            return rc_err_set(err, "point %zu has the same position as another one", k + 1);
        v[at] = p[2];
    }
    return RC_OK;
}

static enum rc_status
xyz_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_even even = {0};
    enum rc_status status;
    struct cloud c;

    status = cloud_open(&c, file, maps->wish, 0, err);
    if (status == RC_OK && c.along != NULL)
        status = rc_even_new(c.along, c.table.numbers.rows, metres_along(&c), file, maps->wish,
                             &even, err);
    for (c.height = 0; status == RC_OK && c.height < c.heights; c.height++) {
        struct rc_map *map =
            rc_maps_add(maps, c.heights > 1 ? rc_titled_table_name(&c.table, c.column[2 + c.height])
                                            : rc_piece_of(""));

        map->nx = c.along != NULL ? even.n : c.x.n;
        map->ny = c.along != NULL ? 1 : c.y.n;
        map->fill = fill_points;
        map->more = c.height;
        find_units(&c);
        if (c.along != NULL)
            take_units(&c, even.step, even.step, map);
        else
            take_units(&c, c.x.step, c.y.n > 1 ? c.y.step : c.x.step, map);
    }
    cloud_close(&c);
    return status;
}

/* True if it is a raster, of several rows or of one: another line may be columns of a matrix. */
static bool
runs_straight(const struct cloud *c)
{
    const double *p = c->table.v, *last = p + 3 * (c->table.numbers.rows - 1);

    return c->along == NULL || p[0] == last[0] || p[1] == last[1];
}

static int
xyz_score(const struct rc_file *file)
{
    bool named = rc_file_named(file, ".xyz");
    struct cloud c;
    int score = 0;

    if (!rc_file_is_text(file) && !rc_file_is_utf16(file))
        return 0;
    if (cloud_open(&c, file, &rc_no_wish, 0, NULL) == RC_OK)
        score = named ? 80 : c.table.numbers.rows > 3 && runs_straight(&c) ? 60 : 0;
    else if (c.table.numbers.columns == 3 && named)
        score = 50;
    cloud_close(&c);
    return score;
}

const struct rc_format rc_format_xyz = {
    .name = "xyz",
    .suffixes = ".xyz .txt .csv",
    .summary = "points of a raster as text: x, y, z",
    .score = xyz_score,
    .find = xyz_find,
    .columns = true,
};
