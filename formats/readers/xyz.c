/*
 * Lists of points: three columns x, y, z in any order of the points, which must lie on a raster.
 * The least x and y come first; a point of the raster that the list leaves out is missing. The list
 * holds no unit.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "titled_table.h"
#include "formats/core/core.h"

struct axis {
    double first, step;
    size_t n;
};

struct cloud {
    struct rc_titled_table table;
    struct axis x, y;
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
    double *sorted = malloc(points * sizeof *sorted), widest = 0, start;
    enum rc_status status = RC_OK;
    char text[RC_NUMBER_SIZE];

    if (sorted == NULL)
        return rc_err_set(err, "out of memory for %zu points", points);
    for (size_t k = 0; k < points; k++) {
        sorted[k] = v[3 * k];
        if (!isfinite(sorted[k])) {
            free(sorted);
            return rc_err_set(err, "point %zu has no %c", k + 1, name);
        }
    }
    qsort(sorted, points, sizeof *sorted, by_value);
    for (size_t k = 1; k < points; k++)
        widest = fmax(widest, sorted[k] - sorted[k - 1]);
    *axis = (struct axis){.first = sorted[0], .n = 1, .step = 1};
    for (size_t k = 1; k < points; k++)
        axis->n += sorted[k] - sorted[k - 1] > 0.01 * widest;
    if (axis->n > 1)
        axis->step = (sorted[points - 1] - sorted[0]) / (double)(axis->n - 1);
    for (size_t k = 0; k < points && status == RC_OK; k++) {
        start = (sorted[k] - axis->first) / axis->step;
        if (!(fabs(start - round(start)) < 0.1))
            status = rc_err_set(err,
                                "the points lie on no raster: %zu different %c from %s on, "
                                "not evenly apart",
                                axis->n, name, rc_number_text(text, axis->first));
    }
    free(sorted);
    return status;
}

static enum rc_status
cloud_open(struct cloud *c, const struct rc_file *file, const struct rc_wish *wish,
           struct rc_err *err)
{
    if (rc_titled_table_open(&c->table, file, 2, wish, err) != RC_OK)
        return RC_FAIL;
    if (c->table.numbers.columns != 3)
        return rc_err_set(err, "a list of points has 3 columns, this table has %zu",
                          c->table.numbers.columns);
    if (rc_titled_table_read(&c->table, err) != RC_OK)
        return RC_FAIL;
    if (find_axis(c->table.v, c->table.numbers.rows, 'x', &c->x, err) != RC_OK ||
        find_axis(c->table.v + 1, c->table.numbers.rows, 'y', &c->y, err) != RC_OK)
        return RC_FAIL;
    if (c->x.n < 2)
        return rc_err_set(err, "all points have the same x");
    if (c->y.n > 4 * c->table.numbers.rows / c->x.n)
        return rc_err_set(err,
                          "the points lie on no raster: %zu of them have %zu different x and "
                          "%zu different y",
                          c->table.numbers.rows, c->x.n, c->y.n);
    return RC_OK;
}

static enum rc_status
fill_points(const struct rc_file *file, const struct rc_wish *wish, const struct rc_map *map,
            double *v, struct rc_err *err)
{
    enum rc_status status = RC_FAIL;
    unsigned char *taken = NULL;
    struct cloud c;

    if (cloud_open(&c, file, wish, err) != RC_OK)
        goto done;
    if ((taken = calloc(map->nx, map->ny)) == NULL) {
        rc_err_set(err, "out of memory for %zu points", map->nx * map->ny);
        goto done;
    }
    for (size_t k = 0; k < map->nx * map->ny; k++)
        v[k] = NAN;
    for (size_t k = 0; k < c.table.numbers.rows; k++) {
        const double *p = c.table.v + 3 * k;
        size_t at = (size_t)lround((p[1] - c.y.first) / c.y.step) * map->nx +
                    (size_t)lround((p[0] - c.x.first) / c.x.step);
        if (taken[at]++ != 0) {
            rc_err_set(err, "point %zu stands where another one does", k + 1);
            goto done;
        }
        v[at] = p[2];
    }
    status = RC_OK;
done:
    free(taken);
    rc_titled_table_close(&c.table);
    return status;
}

static enum rc_status
xyz_find(const struct rc_file *file, const struct rc_wish *wish, struct rc_maps *maps,
         struct rc_err *err)
{
    struct rc_map *map = rc_maps_add(maps, "", 0);
    enum rc_status status;
    struct cloud c;

    status = cloud_open(&c, file, wish, err);
    if (status == RC_OK) {
        map->nx = c.x.n;
        map->ny = c.y.n;
        map->fill = fill_points;
        rc_map_hint(map, c.x.step, c.y.n > 1 ? c.y.step : c.x.step);
    }
    rc_titled_table_close(&c.table);
    return status;
}

static int
xyz_score(const struct rc_file *file)
{
    bool named = rc_file_named(file, ".xyz");
    struct cloud c;
    int score = 0;

    if (!rc_file_is_text(file) && !rc_file_is_utf16(file))
        return 0;
    if (cloud_open(&c, file, &rc_no_wish, NULL) == RC_OK)
        score = named ? 80 : c.y.n > 1 && c.table.numbers.rows > 3 ? 60 : 0;
    else if (c.table.numbers.columns == 3 && named)
        score = 50;
    rc_titled_table_close(&c.table);
    return score;
}

RC_FORMAT_OF_MAPS(xyz)

const struct rc_format rc_format_xyz = {
    .name = "xyz",
    .suffixes = ".xyz .txt .csv",
    .summary = "points of a raster as text: x, y, z",
    .score = xyz_score,
    .list = xyz_list,
    .read = xyz_read,
};
