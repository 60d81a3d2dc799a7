/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * NetCDF classic (versions 1, 2 and 5) is big-endian throughout. It has a header with dimensions, attributes
 * and variables. The values of each variable follow from its offset on. A variable along the record
 * dimension is spread over the records, which hold a row of each such variable.
 *
 * NetCDF's library would also fetch files from the network and read HDF5; only the header is needed here. A
 * map is a variable of two dimensions, others of length 1 before them. Rows run along the second to last
 * dimension; a map (x, y) is transposed. The variables with the names of the dimensions give the spacings.
 * If some maps have them, a variable without them is not a map.
 *
 * GXSM keeps the field of a scan as (time, value, dimy, dimx), to be multiplied by the scalar dz. All its
 * lengths are in Angstroms, whatever unit it displays them in.
 */
#include <math.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/format.h"

static uint64_t
length(const struct rc_cdf *f, size_t dimension)
{
    uint64_t n = f->dimension[dimension].length;

    return n == 0 ? f->records : n;
}

static const struct rc_cdf_variable *
named(const struct rc_cdf *f, struct rc_piece name)
{
    for (size_t k = 0; k < f->variables; k++)
        if (f->variable[k].name.n == name.n &&
            memcmp(f->variable[k].name.text, name.text, name.n) == 0)
            return &f->variable[k];
    return NULL;
}

/* True if a variable with the name of the dimension gives the positions of its points. */
static bool
has_axis(const struct rc_cdf *f, size_t dimension)
{
    const struct rc_cdf_variable *v = named(f, f->dimension[dimension].name);

    return v != NULL && v->rank == 1 && v->dimension[0] == dimension && v->type != RC_CDF_CHAR;
}

static bool
could_be_map(const struct rc_cdf *f, const struct rc_cdf_variable *v)
{
    size_t least = v->rank == 2 ? 1 : 2; /* a row among more dimensions is not a map */

    return v->rank >= 2 && v->lead == 1 && v->type != RC_CDF_CHAR &&
           length(f, v->dimension[0]) >= least && length(f, v->dimension[1]) >= least;
}

static bool
has_axes(const struct rc_cdf *f, const struct rc_cdf_variable *v)
{
    return has_axis(f, v->dimension[0]) && has_axis(f, v->dimension[1]);
}

/* True if some variable of the file has axes, one map or several layers. Variables without axes are then no
 * maps. */
static bool
some_have_axes(const struct rc_cdf *f)
{
    for (size_t k = 0; k < f->variables; k++)
        if (f->variable[k].rank >= 2 && has_axes(f, &f->variable[k]))
            return true;
    return false;
}

static bool
is_map(const struct rc_cdf *f, const struct rc_cdf_variable *v, bool with_axes)
{
    return could_be_map(f, v) && (!with_axes || has_axes(f, v));
}

/* True if each row, or each value, is in a separate record. */
static bool
in_records(const struct rc_cdf *f, const struct rc_cdf_variable *v)
{
    return rc_cdf_has_records(f, v) && v->rank <= 2;
}

/* Where value (i, j) of a map lies; its bytes were checked. */
static const unsigned char *
place(const struct rc_cdf *f, const struct rc_cdf_variable *v, uint64_t i, uint64_t j)
{
    uint64_t columns = v->rank >= 2 ? length(f, v->dimension[1]) : 1;
    uint64_t row = in_records(f, v) ? f->record : columns * rc_cdf_width(v->type);

    return f->b.data + v->at + i * row + j * rc_cdf_width(v->type);
}

static enum rc_status
check_bytes(const struct rc_cdf *f, const struct rc_cdf_variable *v, struct rc_err *err)
{
    char quote[RC_SHOWN];
    uint64_t rows = length(f, v->dimension[0]);
    uint64_t columns = v->rank >= 2 ? length(f, v->dimension[1]) : 1;
    uint64_t row, there = v->at > f->b.size ? 0 : f->b.size - v->at;

    rc_piece_shown_to(quote, v->name);
    if (columns > there / rc_cdf_width(v->type))
        return rc_err_set(err, "variable '%s' promises %llu values a row, the file is too short",
                          quote, (unsigned long long)columns);
    row = columns * rc_cdf_width(v->type);
    if (in_records(f, v) && f->record < row)
        return rc_err_set(err, "variable '%s' does not fit its records", quote);
    row = in_records(f, v) ? f->record : row;
    if (rows - 1 > (there - columns * rc_cdf_width(v->type)) / row)
        return rc_err_set(err, "variable '%s' promises %llu x %llu values, the file is too short",
                          quote, (unsigned long long)rows, (unsigned long long)columns);
    return RC_OK;
}

/* The value of a variable without dimensions; false where it is not there. */
static bool
scalar(const struct rc_cdf *f, const char *name, double *value)
{
    const struct rc_cdf_variable *v = named(f, (struct rc_piece){name, strlen(name)});

    if (v == NULL || v->rank != 0 || v->type == RC_CDF_CHAR || v->at > f->b.size ||
        f->b.size - v->at < rc_cdf_width(v->type))
        return false;
    *value = rc_cdf_value(f->b.data + v->at, v->type);
    return true;
}

/* True if the variable is the field of a GXSM scan; also gives the length of one count. */
static bool
is_gxsm(const struct rc_cdf *f, const struct rc_cdf_variable *v, double *dz)
{
    return rc_cdf_is(f->dimension[v->dimension[0]].name, "dimy") &&
           rc_cdf_is(f->dimension[v->dimension[1]].name, "dimx") && scalar(f, "dz", dz);
}

/* The step of a coordinate in metres, NAN where the file does not give it. `metres` is the length of 1 of its
 * numbers, NAN where the file has no unit for them. */
static enum rc_status
step_of(const struct rc_cdf *f, size_t dimension, double metres, double *step, bool *periodic,
        struct rc_err *err)
{
    const struct rc_cdf_variable *v = named(f, f->dimension[dimension].name);
    char quote[RC_SHOWN];
    uint64_t n = length(f, dimension);
    double first, last, off;

    *step = NAN;
    *periodic = false;
    if (v == NULL || v->rank != 1 || v->dimension[0] != dimension || v->type == RC_CDF_CHAR ||
        n < 2)
        return RC_OK;
    if (check_bytes(f, v, err) != RC_OK)
        return RC_FAIL;
    rc_piece_shown_to(quote, v->name);
    if (isnan(metres))
        metres = rc_piece_metres(v->unit);
    if (isnan(metres))
        return RC_OK;
    first = rc_cdf_value(place(f, v, 0, 0), v->type);
    last = rc_cdf_value(place(f, v, n - 1, 0), v->type);
    *step = (last - first) / (double)(n - 1);
    off = 1e-6 * fabs(*step);
    if (v->type == RC_CDF_FLOAT) /* rounded to it */
        off += 0x1p-23 * fmax(fabs(first), fabs(last));
    for (uint64_t k = 0; k < n; k++)
        if (!(fabs(rc_cdf_value(place(f, v, k, 0), v->type) - first - (double)k * *step) <= off))
            return rc_err_set(
                err, "the coordinate '%s' has uneven steps: only regular grids are read", quote);
    *step = *step * v->factor * metres;
    *periodic = v->period != 0;
    return RC_OK;
}

static void
close_cdf(void *opened)
{
    rc_cdf_close(opened);
}

static enum rc_status
fill_values(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    const struct rc_cdf *f = map->opened;
    const struct rc_cdf_variable *of = &f->variable[map->more];
    size_t columns = map->by_columns ? map->ny : map->nx;
    double dz = 1;

    (void)file;
    is_gxsm(f, of, &dz);
    if (check_bytes(f, of, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < map->nx * map->ny; k++) {
        double raw = rc_cdf_value(place(f, of, k / columns, k % columns), of->type);

        v[k] = raw == of->fill ? NAN : raw * (of->factor * dz) + of->offset * dz;
    }
    if (map->right_first || map->bottom_first)
        rc_note(map->notes, "the positions in %s fall: the map is turned so that they rise",
                map->right_first && map->bottom_first ? "x and y"
                : map->right_first                    ? "x"
                                                      : "y");
    return RC_OK;
}

static enum rc_status
add_map(const struct rc_cdf *f, const struct rc_cdf_variable *v, struct rc_maps *maps,
        struct rc_err *err)
{
    struct rc_map *map = rc_maps_add(maps, v->name);
    double angstrom = 1e-10, dz = 1;
    bool gxsm = is_gxsm(f, v, &dz);
    size_t x, y;

    map->by_columns = rc_cdf_is(f->dimension[v->dimension[0]].name, "x") &&
                      rc_cdf_is(f->dimension[v->dimension[1]].name, "y");
    x = v->dimension[map->by_columns ? 0 : 1];
    y = v->dimension[map->by_columns ? 1 : 0];
    map->nx = (size_t)length(f, x);
    map->ny = (size_t)length(f, y);
    if (step_of(f, x, gxsm ? angstrom : NAN, &map->dx, &map->repeats.x, err) != RC_OK ||
        step_of(f, y, gxsm ? angstrom : NAN, &map->dy, &map->repeats.y, err) != RC_OK)
        return RC_FAIL;
    map->right_first = map->dx < 0;
    map->bottom_first = map->dy < 0 && !gxsm; /* there y falls from the top row on */
    map->dx = fabs(map->dx);
    map->dy = fabs(map->dy);
    map->fill = fill_values;
    map->more = (size_t)(v - f->variable);
    map->title = v->title;
    rc_map_unit(map, v->unit);
    if (gxsm && strcmp(map->unit, "m") == 0)
        map->si = angstrom;
    else if (gxsm && map->si != 1) { /* the prefix belongs to the display */
        map->unit[0] = '\0';
        map->si = 1;
    }
    return RC_OK;
}

static enum rc_status
netcdf_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_cdf *f = rc_maps_open(maps, sizeof *f, close_cdf, err);
    bool with_axes;

    if (f == NULL || rc_cdf_open(f, file, err) != RC_OK)
        return RC_FAIL;
    with_axes = some_have_axes(f);
    for (size_t k = 0; k < f->variables; k++)
        if (is_map(f, &f->variable[k], with_axes) &&
            add_map(f, &f->variable[k], maps, err) != RC_OK)
            return RC_FAIL;
    return maps->n > 0 ? RC_OK
                       : rc_err_set(err,
                                    "none of the file's %zu variables has two dimensions: further "
                                    "ones before them must be of length 1",
                                    f->variables);
}

static int
netcdf_score(const struct rc_file *file)
{
    return file->size >= 8 && rc_file_holds(file, 0, "CDF", 3) &&
                   (file->data[3] == 1 || file->data[3] == 2 || file->data[3] == 5)
               ? 90
               : 0;
}

const struct rc_format rc_format_netcdf = {
    .name = "netcdf",
    .suffixes = ".nc .cdf",
    .summary = "NetCDF classic: variables of two dimensions",
    .score = netcdf_score,
    .find = netcdf_find,
};
