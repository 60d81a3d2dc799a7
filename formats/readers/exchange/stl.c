/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * STL: triangles whose corners lie above a raster: an open sheet, or the upper side of a closed block,
 * as rc-export writes it. Binary: 80 bytes, the number of triangles, and 50 bytes for each: its normal,
 * its corners, two unused bytes. Text: the words of a corner are `vertex x y z`. The normals are not
 * used. Lengths have no unit; by convention they are millimetres. Row 0 is at the largest y.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/format.h"

enum {
    HEAD = 84,
    TRIANGLE = 50,
    NORMAL = 12
};

struct mesh {
    double *x, *y, *z; /* corners of the triangles that are kept */
    size_t n;
    struct rc_raster_axis across, along;
};

static void
mesh_close(void *opened)
{
    struct mesh *m = opened;

    free(m->x);
    free(m->y);
    free(m->z);
}

static bool
is_binary(const struct rc_file *file)
{
    struct rc_bytes bytes = rc_file_bytes(file, false);
    double count = 0;

    if (file->size < HEAD + TRIANGLE)
        return false;
    bytes.at = HEAD - 4;
    rc_bytes_values(&bytes, RC_RAW_U32, &count, 1);
    return count > 0 && (double)(file->size - HEAD) == TRIANGLE * count;
}

static bool
is_stl(const struct rc_file *file)
{
    struct rc_piece text = rc_file_piece(file);

    if (is_binary(file))
        return true;
    text.n = text.n < 1000 ? text.n : 1000;
    return rc_file_is_text(file) && rc_piece_begins(rc_piece_trim(text), "solid") &&
           rc_piece_find(text, "facet") != NULL;
}

/* ---- corners ---- */

/* The three numbers of the next corner of a text; false after the last one. */
static bool
next_corner(struct rc_piece *rest, double at[3], bool *good)
{
    struct rc_piece word;

    while (rc_piece_word(rest, " \t\r\n", &word))
        if (rc_piece_is(word, "vertex")) {
            for (int k = 0; k < 3; k++)
                *good = *good && rc_piece_word(rest, " \t\r\n", &word) &&
                        rc_piece_number(word, &at[k], NULL);
            return true;
        }
    return false;
}

/* All corners of the file, three for a triangle. */
static enum rc_status
read_corners(const struct rc_file *file, struct mesh *m, struct rc_err *err)
{
    struct rc_bytes bytes = rc_file_bytes(file, false);
    struct rc_piece rest = rc_file_piece(file);
    /* a corner takes 12 bytes of a binary file, and more of a text */
    size_t most = file->size / (is_binary(file) ? 12 : sizeof "vertex 0 0 0") + 1;
    bool good = true;
    double at[3];

    m->x = malloc(most * sizeof *m->x);
    m->y = malloc(most * sizeof *m->y);
    m->z = malloc(most * sizeof *m->z);
    if (m->x == NULL || m->y == NULL || m->z == NULL)
        return rc_err_set(err, "out of memory for %zu corners", most);
    for (bytes.at = HEAD; is_binary(file) && bytes.at < file->size;) {
        if ((bytes.at - HEAD) % TRIANGLE == 0)
            bytes.at += NORMAL;
        rc_bytes_values(&bytes, RC_RAW_F32, at, 3);
        m->x[m->n] = at[0];
        m->y[m->n] = at[1];
        m->z[m->n++] = at[2];
        if (m->n % 3 == 0)
            bytes.at += 2;
    }
    while (!is_binary(file) && m->n < most && next_corner(&rest, at, &good)) {
        if (!good)
            return rc_err_set(err, "corner %zu of the triangles has no three numbers", m->n + 1);
        m->x[m->n] = at[0];
        m->y[m->n] = at[1];
        m->z[m->n++] = at[2];
    }
    for (size_t k = 0; k < m->n; k++)
        if (!isfinite(m->x[k]) || !isfinite(m->y[k]) || !isfinite(m->z[k]))
            return rc_err_set(err, "corner %zu of the triangles is not finite", k + 1);
    return m->n >= 3 && m->n % 3 == 0
               ? RC_OK
               : rc_err_set(err, "%zu corners are no triangles: the file is damaged", m->n);
}

/* Twice the area of the triangle from corner k on, as seen from above; below 0 if it faces downwards. */
static double
facing(const struct mesh *m, size_t k)
{
    double ux = m->x[k + 1] - m->x[k], uy = m->y[k + 1] - m->y[k];
    double vx = m->x[k + 2] - m->x[k], vy = m->y[k + 2] - m->y[k];
    double area = ux * vy - uy * vx;

    return fabs(area) > 1e-9 * (hypot(ux, uy) * hypot(vx, vy)) ? area : 0;
}

/* Keeps the triangles that face upwards. In a sheet whose triangles all face downwards these are kept.
 * Walls are left out. */
static void
keep_upper(struct mesh *m)
{
    size_t kept = 0, up = 0;

    for (size_t k = 0; k < m->n; k += 3)
        up += facing(m, k) > 0;
    for (size_t k = 0; k < m->n; k += 3) {
        double way = facing(m, k);

        if (up > 0 ? way <= 0 : way == 0)
            continue;
        memmove(m->x + kept, m->x + k, 3 * sizeof *m->x);
        memmove(m->y + kept, m->y + k, 3 * sizeof *m->y);
        memmove(m->z + kept, m->z + k, 3 * sizeof *m->z);
        kept += 3;
    }
    m->n = kept;
}

/* ---- the map ---- */

static int
by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static enum rc_status
find_axis(char name, const double *at, size_t n, struct rc_raster_axis *axis, struct rc_err *err)
{
    RC_OWNED double *sorted = malloc(n * sizeof *sorted);

    if (sorted == NULL)
        return rc_err_set(err, "out of memory for %zu corners", n);
    memcpy(sorted, at, n * sizeof *sorted);
    qsort(sorted, n, sizeof *sorted, by_value);
    return rc_raster_axis(name, sorted, n, axis, err);
}

static enum rc_status
fill_heights(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    const struct mesh *m = map->opened;

    (void)file;
    (void)err;
    for (size_t k = 0; k < map->nx * map->ny; k++)
        v[k] = NAN;
    for (size_t k = 0; k < m->n; k++) {
        double *to =
            &v[rc_raster_node(&m->along, m->y[k]) * map->nx + rc_raster_node(&m->across, m->x[k])];

        if (!(m->z[k] <= *to)) /* the highest of several */
            *to = m->z[k];
    }
    return RC_OK;
}

static enum rc_status
stl_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct mesh *m = rc_maps_open(maps, sizeof *m, mesh_close, err);
    struct rc_map *map = rc_maps_add(maps, rc_piece_of(""));
    double metres = maps->wish->xy_unit > 0 ? maps->wish->xy_unit : 1e-3;

    if (m == NULL || read_corners(file, m, err) != RC_OK)
        return RC_FAIL;
    keep_upper(m);
    if (m->n == 0)
        return rc_err_set(err, "all triangles are upright: there is no surface above x and y");
    if (find_axis('x', m->x, m->n, &m->across, err) != RC_OK ||
        find_axis('y', m->y, m->n, &m->along, err) != RC_OK)
        return rc_raster_explain(m->x, m->y, m->n, err);
    if (m->across.n < 2 || m->along.n < 2 ||
        (double)m->across.n * (double)m->along.n > 4 * (double)m->n)
        return rc_err_set(err,
                          "the corners of the triangles are on no raster: %zu of them have %zu "
                          "different x and %zu different y; only even rasters are read",
                          m->n, m->across.n, m->along.n);
    map->nx = m->across.n;
    map->ny = m->along.n;
    map->dx = m->across.step * metres;
    map->dy = m->along.step * metres;
    map->bottom_first = true;
    map->si = 1e-3;
    map->heights = true;
    strcpy(map->unit, isnan(maps->wish->z_unit) ? "m" : "");
    map->fill = fill_heights;
    map->doubt =
        "STL has no unit: its lengths are taken as millimetres; --dx and --z-unit give others";
    return RC_OK;
}

const struct rc_format rc_format_stl = {
    .name = "stl",
    .suffixes = ".stl",
    .summary = "triangles above a raster: sheets and blocks, STL",
    .is = is_stl,
    .sure = 90,
    .refusal = "no STL file: it neither begins with 'solid' nor has the size that its count of "
               "triangles says",
    .find = stl_find,
};
