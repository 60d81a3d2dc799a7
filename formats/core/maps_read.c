/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "maps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- checking ---- */

/* The numbers of the map must lie in the file. */
static enum rc_status
check_bytes(const struct rc_map *map, const struct rc_file *file, struct rc_err *err)
{
    size_t outer = map->by_columns ? map->nx : map->ny;
    size_t inner = map->by_columns ? map->ny : map->nx, line, bytes;

    if (rc_size_mul(inner, rc_raw_width(map->raw), &line, err) != RC_OK ||
        map->padding > SIZE_MAX - line ||
        rc_size_mul(line + map->padding, outer, &bytes, err) != RC_OK)
        return RC_FAIL;
    bytes -= map->padding; /* the last line may lack it */
    if (map->at > file->size || bytes > file->size - map->at)
        return rc_err_set(err,
                          "channel '%s': the header promises %zu x %zu values, %zu bytes from byte "
                          "%zu on, the file has %zu bytes in all",
                          map->name, map->nx, map->ny, bytes, map->at, file->size);
    return RC_OK;
}

static enum rc_status
check_map(const struct rc_map *map, const struct rc_file *file, struct rc_err *err)
{
    if (map->nx == 0 || map->ny == 0)
        return rc_err_set(err, "channel '%s' has no values: %zu columns, %zu rows", map->name,
                          map->nx, map->ny);
    if (!isfinite(map->scale) || !isfinite(map->zero) || !isfinite(map->si) || map->scale == 0)
        return rc_err_set(err,
                          "channel '%s': heights are number * %g + %g in the file: both must be "
                          "finite and the first not 0",
                          map->name, map->scale * map->si, map->zero * map->si);
    return map->fill != NULL || map->unpack != NULL ? RC_OK : check_bytes(map, file, err);
}

enum rc_status
rc_maps_describe(struct rc_maps *maps, rc_maps_find *find, struct rc_err *err)
{
    const struct rc_wish *wish = maps->wish;

    if (find(maps->file, maps, err) != RC_OK)
        return RC_FAIL;
    if (maps->n == 0)
        return rc_err_set(err, "there is no map in the file");
    for (size_t k = 0; k < maps->n && k < RC_MAPS_MOST; k++) {
        struct rc_map *map = &maps->map[k];

        if (map->name[0] == '\0')
            strcpy(map->name,
                   map->unit[0] == '\0' || strcmp(map->unit, "m") == 0 ? "height" : "values");
        if (isnan(map->dx) && map->step[0] != 0 && wish->xy_unit > 0) {
            map->dx = map->step[0] * wish->xy_unit;
            map->dy = map->step[1] * wish->xy_unit;
        }
        if (map->ny == 1)
            map->dy = map->dx; /* a profile: the file's y is meaningless */
        if (check_map(map, map->within.data == NULL ? maps->file : &map->within, err) != RC_OK)
            return RC_FAIL;
    }
    return RC_OK;
}

/* True if values need a buffer before they are stored at their positions. */
static bool
is_turned(const struct rc_map *map)
{
    return map->by_columns || map->bottom_first || map->right_first;
}

size_t
rc_maps_list(const struct rc_maps *maps, struct rc_channel *channel, size_t most)
{
    for (size_t k = 0; k < maps->n && k < most && k < RC_MAPS_MOST; k++) {
        const struct rc_map *map = &maps->map[k];
        channel[k] =
            (struct rc_channel){.nx = map->nx, .ny = map->ny, .dx = map->dx, .dy = map->dy};
        strcpy(channel[k].name, map->name);
        strcpy(channel[k].unit, map->unit);
        channel[k].beside = map->beside;
        if (map->fill != NULL && map->by_columns) /* the map itself is not used during filling */
            channel[k].beside = fmax(map->beside, 8 * (double)map->nx * (double)map->ny);
    }
    return maps->n;
}

/* ---- values ---- */

/* Stores line `outer` of the file at its position. */
static void
place(const struct rc_map *map, const double *line, size_t outer, double *v)
{
    size_t row = outer, column = 0, inner = map->nx;
    ptrdiff_t step = 1;

    if (map->by_columns) {
        row = 0;
        column = outer;
        inner = map->ny;
        step = (ptrdiff_t)map->nx;
    }
    if (map->right_first)
        column = map->nx - 1 - column;
    if (map->bottom_first)
        row = map->ny - 1 - row;
    if (map->by_columns ? map->bottom_first : map->right_first)
        step = -step;
    v += row * map->nx + column;
    for (size_t k = 0; k < inner; k++)
        v[(ptrdiff_t)k * step] = line[k];
}

static enum rc_status
decode(const struct rc_map *map, const struct rc_file *file, double *v, struct rc_err *err)
{
    size_t outer = map->by_columns ? map->nx : map->ny;
    size_t inner = map->by_columns ? map->ny : map->nx;
    RC_OWNED unsigned char *unpacked = NULL;
    struct rc_file plain = map->within.data == NULL ? *file : map->within;
    struct rc_bytes bytes;
    RC_OWNED double *line = NULL;

    if (map->unpack != NULL) {
        plain.data = unpacked = map->unpack(file, map, &plain.size, err);
        if (unpacked == NULL || check_bytes(map, &plain, err) != RC_OK)
            return RC_FAIL;
    }
    bytes = rc_file_bytes(&plain, map->big);
    bytes.at = map->at;
    if (!is_turned(map) && map->padding == 0) {
        rc_bytes_values(&bytes, map->raw, v, map->nx * map->ny);
        return RC_OK;
    }
    if ((line = malloc(inner * sizeof *line)) == NULL)
        return rc_err_set(err, "out of memory for a line of %zu values", inner);
    for (size_t k = 0; k < outer; k++) {
        rc_bytes_values(&bytes, map->raw, line, inner);
        if (k + 1 < outer)
            bytes.at += map->padding;
        place(map, line, k, v);
    }
    return RC_OK;
}

/* Turns a map of rows round in place. */
static void
turn(const struct rc_map *map, double *v)
{
    for (size_t k = 0; k < map->nx * map->ny && is_turned(map); k++) {
        size_t j = k / map->nx, i = k % map->nx;
        size_t to = (map->bottom_first ? map->ny - 1 - j : j) * map->nx +
                    (map->right_first ? map->nx - 1 - i : i);
        double kept = v[k];

        if (to <= k)
            continue; /* these two were exchanged before */
        v[k] = v[to];
        v[to] = kept;
    }
}

/* Calls map->fill, and reorders its values for a grid. */
static enum rc_status
fill(const struct rc_map *map, const struct rc_file *file, double *v, struct rc_err *err)
{
    enum rc_status status;
    RC_OWNED double *raw = NULL;

    if (!map->by_columns) {
        status = map->fill(file, map, v, err);
        if (status == RC_OK)
            turn(map, v);
        return status;
    }
    if ((raw = malloc(map->nx * map->ny * sizeof *raw)) == NULL)
        return rc_err_set(err, "out of memory for %zu values", map->nx * map->ny);
    status = map->fill(file, map, raw, err);
    for (size_t k = 0; k < map->nx && status == RC_OK; k++)
        place(map, raw + k * map->ny, k, v);
    return status;
}

static void
scale(const struct rc_map *map, double si, double *v)
{
    for (size_t k = 0; k < map->nx * map->ny; k++) {
        if (isnan(v[k]))
            continue;
        if ((v[k] >= map->missing_from && v[k] <= map->missing_to) ||
            (map->rows > 0 && k / map->nx >= map->rows)) {
            v[k] = NAN;
            continue;
        }
        v[k] = (v[k] * map->scale + map->zero) * si;
    }
}

/* Sets infinite values, which some programs write for missing points, to missing and notes their number.
 * RC_FAIL when no finite value is left. */
static enum rc_status
drop_infinite(struct rc_grid *g, struct rc_notes *notes, struct rc_err *err)
{
    size_t infinite = 0, finite = 0, first = 0;

    for (size_t k = 0; k < g->nx * g->ny; k++) {
        finite += isfinite(g->v[k]) != 0;
        if (!isinf(g->v[k]))
            continue;
        if (infinite++ == 0)
            first = k;
        g->v[k] = NAN;
    }
    if (infinite > 0 && finite == 0)
        return rc_err_set(err, "every value that is there is infinite (%zu of %zu x %zu)", infinite,
                          g->nx, g->ny);
    if (infinite > 0)
        rc_note(notes,
                "%zu of %zu values %s infinite and read as missing, the first at column %zu, row "
                "%zu (from 0)",
                infinite, g->nx * g->ny, infinite == 1 ? "is" : "are", first % g->nx,
                first / g->nx);
    return RC_OK;
}

struct rc_grid *
rc_maps_read(struct rc_maps *maps, const struct rc_wish *wish, size_t index, struct rc_notes *notes,
             struct rc_err *err)
{
    const struct rc_file *file = maps->file;
    struct rc_map *map = &maps->map[index < RC_MAPS_MOST ? index : 0];
    struct rc_wish said = *wish;
    struct rc_shape shape;
    RC_OWN(rc_grid, g) = NULL;
    bool is_length, is_height;
    double si;

    if (index >= maps->n || index >= RC_MAPS_MOST)
        return rc_err_null(err, "there is no channel %zu: the file has %zu", index + 1, maps->n);
    if ((map->fill != NULL || map->unpack != NULL || map->within.data != NULL) &&
        rc_map_fits(file, map->nx, map->ny, err) != RC_OK)
        return NULL;
    is_length = strcmp(map->unit, "m") == 0;
    is_height = is_length || map->heights || map->unit[0] == '\0' || !isnan(wish->z_unit);
    si = map->si;
    shape = (struct rc_shape){.nx = map->nx, .ny = map->ny};
    if (map->own_dy)
        said.dy = map->dy;
    if (rc_spacing(&said, map->dx, map->dy, &shape, notes, err) != RC_OK) {
        if (isnan(map->dx) && err != NULL &&
            strlen(err->text) + strlen(map->hint) < sizeof err->text)
            strcat(err->text, map->hint);
        if (isnan(map->dx) && map->unit[0] == '\0')
            rc_lacks_unit(wish, NAN, err);
        return NULL;
    }
    if ((is_height &&
         rc_height_unit(wish, is_length ? map->si : NAN, map->unit, &si, notes, err) != RC_OK) ||
        (g = rc_grid_new(&shape, is_height ? "height" : map->name, is_height ? "m" : map->unit,
                         err)) == NULL)
        return NULL;
    map->opened = maps->opened;
    map->wish = wish;
    map->notes = notes;
    if (map->doubt != NULL && isnan(wish->z_unit))
        rc_note(notes, "%s", map->doubt);
    if ((map->fill == NULL ? decode(map, file, g->v, err) : fill(map, file, g->v, err)) != RC_OK)
        return NULL;
    scale(map, si, g->v);
    if (drop_infinite(g, notes, err) != RC_OK ||
        (strcmp(map->name, "height") != 0 &&
         rc_word_keep(g, "file.channel", map->name, err) != RC_OK) ||
        rc_piece_keep(g, "file.title", map->title, err) != RC_OK ||
        (rc_repeats(map->repeats) > 0 &&
         rc_grid_set(g, "periodic", rc_repeats_word(map->repeats), err) != RC_OK))
        return NULL;
    for (size_t k = 0; k < maps->keys; k++)
        if (rc_grid_set(g, maps->key[k].name, maps->key[k].value, err) != RC_OK)
            return NULL;
    return rc_give(&g);
}
