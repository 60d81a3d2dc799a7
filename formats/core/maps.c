/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "maps.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "units.h"

struct rc_maps *
rc_maps_new(const struct rc_file *file, const struct rc_wish *wish, struct rc_err *err)
{
    struct rc_maps *maps = malloc(sizeof *maps);

    if (maps == NULL)
        return rc_err_null(err, "out of memory for the maps of a file");
    maps->file = file;
    maps->wish = wish;
    maps->format = NULL;
    maps->opened = NULL;
    maps->n = maps->keys = 0;
    return maps;
}

void *
rc_maps_open(struct rc_maps *maps, size_t size, void (*close)(void *opened), struct rc_err *err)
{
    maps->close = close;
    if ((maps->opened = calloc(1, size)) == NULL)
        rc_err_set(err, "out of memory for opening a file");
    return maps->opened;
}

void
rc_maps_shut(struct rc_maps *maps)
{
    if (maps->opened != NULL && maps->close != NULL)
        maps->close(maps->opened);
    free(maps->opened);
    maps->opened = NULL;
}

void
rc_maps_free(struct rc_maps *maps)
{
    if (maps != NULL)
        rc_maps_shut(maps);
    free(maps);
}

struct rc_map *
rc_maps_add(struct rc_maps *maps, struct rc_piece name)
{
    struct rc_map *map = maps->n < RC_MAPS_MOST ? &maps->map[maps->n] : &maps->spare;

    maps->n++;
    *map = (struct rc_map){
        .si = 1, .scale = 1, .dx = NAN, .dy = NAN, .missing_from = NAN, .missing_to = NAN};
    rc_text_clean(map->name, sizeof map->name, name.text, name.n);
    return map;
}

void
rc_maps_key(struct rc_maps *maps, const char *key, struct rc_piece text)
{
    for (size_t k = 0; k < maps->keys; k++)
        if (strcmp(maps->key[k].name, key) == 0)
            return;
    if (maps->keys == RC_KEYS_MOST)
        return;
    rc_text_clean(maps->key[maps->keys].value, sizeof maps->key->value, text.text, text.n);
    if (maps->key[maps->keys].value[0] != '\0')
        strcpy(maps->key[maps->keys++].name, key);
}

void
rc_maps_date(struct rc_maps *maps, struct rc_bytes b, size_t at, enum rc_raw raw)
{
    double part[6];
    char text[80];

    b.at = at;
    rc_bytes_values(&b, raw, part, 6);
    snprintf(text, sizeof text, "%04.0f-%02.0f-%02.0fT%02.0f:%02.0f:%02.0f", part[0], part[1],
             part[2], part[3], part[4], part[5]);
    if (part[0] >= 1980 && part[1] <= 12 && part[2] <= 31)
        rc_maps_key(maps, "file.date", rc_piece_of(text));
}

void
rc_maps_keep(struct rc_maps *maps, const struct rc_keep *keep, size_t n, struct rc_piece name,
             struct rc_piece value)
{
    for (size_t k = 0; k < n; k++)
        if (rc_piece_is(name, keep[k].name))
            rc_maps_key(maps, keep[k].key, value);
}

void
rc_map_unit(struct rc_map *map, struct rc_piece unit)
{
    static const char *const bases[] = {"V", "A", "N", "Pa", "Hz", "s", "rad", "W", "J", "F"};
    size_t length;
    int power;

    unit = rc_piece_trim(unit);
    map->si = 1;
    if (rc_length_unit(unit.text, unit.n, &map->si)) {
        strcpy(map->unit, "m");
        return;
    }
    rc_text_clean(map->unit, sizeof map->unit, unit.text,
                  unit.n); /* in Latin-1 the micro sign is one byte */
    length = strlen(map->unit);
    for (size_t k = 0; k < sizeof bases / sizeof *bases; k++) {
        size_t tail = strlen(bases[k]);

        if (length >= tail && strcmp(map->unit + length - tail, bases[k]) == 0 &&
            rc_prefix_power(map->unit, length - tail, &power)) {
            map->si = rc_prefix_factor(power);
            strcpy(map->unit, bases[k]);
            return;
        }
    }
    /* the degree sign, or the ordinal indicator used in its place */
    if (strcmp(map->unit, "\xc2\xb0") == 0 || strcmp(map->unit, "\xc2\xba") == 0)
        strcpy(map->unit, "deg");
}

void
rc_map_hint(struct rc_map *map, double dx, double dy)
{
    map->step[0] = dx;
    map->step[1] = dy;
    snprintf(map->hint, sizeof map->hint,
             " (its steps are %s and %s of a unit not given; or --xy-unit says it)", rc_number(dx),
             rc_number(dy));
}

void
rc_map_steps(struct rc_map *map, double dx, double dy, struct rc_piece unit)
{
    double metres = rc_piece_metres(unit);

    map->dx = dx * metres;
    map->dy = dy * metres;
    if (isnan(metres))
        rc_map_hint(map, dx, dy);
}

enum rc_status
rc_map_count(const char *what, double number, size_t *count, struct rc_err *err)
{
    if (!(number >= 1 && number <= 2147483647) || number != floor(number))
        return rc_err_set(err, "the number of %s is %s: it must be a whole number above 0", what,
                          rc_number(number));
    *count = (size_t)number;
    return RC_OK;
}

static enum rc_status
count_of(const char *what, const char *name, double number, size_t *count, struct rc_err *err)
{
    char named[64];

    snprintf(named, sizeof named, "%s (%s)", what, name == NULL ? "" : name);
    return rc_map_count(name == NULL ? what : named, number, count, err);
}

enum rc_status
rc_map_size(struct rc_map *map, double columns, const char *x, double rows, const char *y,
            struct rc_err *err)
{
    return count_of("columns", x, columns, &map->nx, err) == RC_OK
               ? count_of("rows", y, rows, &map->ny, err)
               : RC_FAIL;
}

enum rc_status
rc_map_bound(struct rc_map *map, const struct rc_file *file, double unpacked, struct rc_err *err)
{
    double bytes = 8 * (double)map->nx * (double)map->ny + unpacked;

    map->beside = unpacked;
    if (bytes <= (double)rc_memory_limit(file->size))
        return RC_OK;
    return rc_err_set(err,
                      "the header promises %zu x %zu heights in %zu bytes: the file is damaged",
                      map->nx, map->ny, file->size);
}

static enum rc_status
fill_text(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    struct rc_piece text = {(const char *)file->data + map->at, file->size - map->at};

    return rc_flow_read(&text, v, map->nx * map->ny, err);
}

enum rc_status
rc_map_is_text(struct rc_map *map, const struct rc_file *file, size_t at, struct rc_err *err)
{
    map->at = at;
    map->fill = fill_text;
    if (map->ny <= (file->size - at + 1) / 2 / map->nx) /* a digit and a separator */
        return RC_OK;
    return rc_err_set(err, "the header promises %zu x %zu numbers, the file has %zu bytes for them",
                      map->nx, map->ny, file->size - at);
}

bool
rc_map_range(const struct rc_map *map, const struct rc_file *file, double *low, double *high)
{
    struct rc_bytes bytes = rc_file_bytes(file, map->big);
    double some[256];
    size_t n;

    *low = INFINITY;
    *high = -INFINITY;
    if (rc_size_mul(map->nx, map->ny, &n, NULL) != RC_OK || map->at > file->size ||
        n > (file->size - map->at) / rc_raw_width(map->raw))
        return false;
    bytes.at = map->at;
    for (size_t k = 0; k < n; k++) {
        size_t left = n - k, at = k % (sizeof some / sizeof *some);

        if (at == 0)
            rc_bytes_values(&bytes, map->raw, some,
                            left < sizeof some / sizeof *some ? left : sizeof some / sizeof *some);
        if (some[at] >= map->missing_from && some[at] <= map->missing_to)
            continue;
        *low = some[at] < *low ? some[at] : *low;
        *high = some[at] > *high ? some[at] : *high;
    }
    return *low <= *high;
}
