#include "maps.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- description ---- */

struct rc_map *
rc_maps_add(struct rc_maps *maps, const char *name, size_t n)
{
    struct rc_map *map = maps->n < RC_MAPS_MOST ? &maps->map[maps->n] : &maps->spare;

    maps->n++;
    *map = (struct rc_map){.si = 1, .scale = 1, .dx = NAN, .dy = NAN, .lost_from = NAN,
                           .lost_to = NAN};
    rc_text_clean(map->name, sizeof map->name, name, n);
    return map;
}

void
rc_maps_key(struct rc_maps *maps, const char *key, const char *text, size_t n)
{
    for (size_t k = 0; k < maps->keys; k++)
        if (strcmp(maps->key[k].name, key) == 0)
            return;
    if (maps->keys == RC_KEYS_MOST)
        return;
    rc_text_clean(maps->key[maps->keys].value, sizeof maps->key->value, text, n);
    if (maps->key[maps->keys].value[0] != '\0')
        strcpy(maps->key[maps->keys++].name, key);
}

void
rc_maps_keep(struct rc_maps *maps, const struct rc_keep *rows, size_t n, struct rc_piece name,
             struct rc_piece value)
{
    for (size_t k = 0; k < n; k++)
        if (rc_piece_is(name, rows[k].name))
            rc_maps_key(maps, rows[k].key, value.text, value.n);
}

void
rc_map_unit(struct rc_map *map, const char *text, size_t n)
{
    static const char *const bases[] = {"V", "A", "N", "Pa", "Hz", "s", "rad", "W", "J", "F"};
    static const struct {
        const char *name;
        double factor;
    } prefixes[] = {{"", 1},     {"k", 1e3},  {"M", 1e6},         {"G", 1e9},        {"m", 1e-3},
                    {"u", 1e-6}, {"n", 1e-9}, {"\xc2\xb5", 1e-6}, {"\xb5", 1e-6},    {"p", 1e-12},
                    {"f", 1e-15}};

    rc_trim(&text, &n);
    map->si = 1;
    map->unit[0] = '\0';
    if (n == 0)
        return;
    if (rc_length_unit(text, n, &map->si)) {
        strcpy(map->unit, "m");
        return;
    }
    for (size_t p = 0; p < sizeof prefixes / sizeof *prefixes; p++)
        for (size_t b = 0; b < sizeof bases / sizeof *bases; b++) {
            size_t front = strlen(prefixes[p].name);
            if (n != front + strlen(bases[b]) || memcmp(text, prefixes[p].name, front) != 0 ||
                memcmp(text + front, bases[b], n - front) != 0)
                continue;
            map->si = prefixes[p].factor;
            strcpy(map->unit, bases[b]);
            return;
        }
    rc_text_clean(map->unit, sizeof map->unit, text, n);
    /* the degree sign, or the ordinal one that stands in for it */
    if (strcmp(map->unit, "\xc2\xb0") == 0 || strcmp(map->unit, "\xc2\xba") == 0)
        strcpy(map->unit, "deg");
}

void
rc_map_hint(struct rc_map *map, const char *dx, const char *dy)
{
    snprintf(map->hint, sizeof map->hint, " (its steps are %s and %s of a unit not given)", dx, dy);
}

enum rc_status
rc_map_count(const char *what, double number, size_t *count, struct rc_err *err)
{
    char text[RC_NUMBER_SIZE];

    if (!(number >= 1 && number <= 2147483647) || number != floor(number))
        return rc_err_set(err, "the number of %s is %s: it must be a whole number above 0", what,
                          rc_number_text(text, number));
    *count = (size_t)number;
    return RC_OK;
}

enum rc_status
rc_map_bound(const struct rc_map *map, const struct rc_file *file, struct rc_err *err)
{
    double most = 16 * (double)file->size + 67108864;

    if (8 * (double)map->nx * (double)map->ny <= most)
        return RC_OK;
    return rc_err_set(err, "the header promises %zu x %zu heights in %zu bytes: that cannot be",
                      map->nx, map->ny, file->size);
}

enum rc_status
rc_map_fill_text(const struct rc_file *file, const struct rc_wish *wish, const struct rc_map *map,
                 double *v, struct rc_err *err)
{
    struct rc_piece text = {(const char *)file->data + map->at, file->size - map->at};

    (void)wish;
    return rc_flow_read(&text, v, map->nx * map->ny, err);
}

enum rc_status
rc_map_is_text(struct rc_map *map, const struct rc_file *file, size_t at, struct rc_err *err)
{
    map->at = at;
    map->fill = rc_map_fill_text;
    if (map->ny <= (file->size - at + 1) / 2 / map->nx) /* a digit and what parts it */
        return RC_OK;
    return rc_err_set(err, "the header promises %zu x %zu numbers, the file has %zu bytes for them",
                      map->nx, map->ny, file->size - at);
}

bool
rc_file_named(const struct rc_file *file, const char *suffixes)
{
    struct rc_piece name = {file->name, strlen(file->name)};
    char suffix[16];

    while (*suffixes != '\0') {
        size_t n = strcspn(suffixes, " ");
        if (n < sizeof suffix && n <= name.n) {
            memcpy(suffix, suffixes, n);
            suffix[n] = '\0';
            if (rc_piece_is((struct rc_piece){name.text + name.n - n, n}, suffix))
                return true;
        }
        suffixes += n;
        suffixes += strspn(suffixes, " ");
    }
    return false;
}

bool
rc_file_holds(const struct rc_file *file, size_t at, const void *bytes, size_t n)
{
    return at <= file->size && file->size - at >= n && memcmp(file->data + at, bytes, n) == 0;
}

struct rc_piece
rc_file_text(const struct rc_file *file, size_t at, size_t n)
{
    const char *text = (const char *)file->data + at;

    return rc_piece_trim((struct rc_piece){text, strnlen(text, n)});
}

struct rc_bytes
rc_file_bytes(const struct rc_file *file, bool big)
{
    return (struct rc_bytes){.data = file->data, .size = file->size, .big = big};
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
        if (some[at] >= map->lost_from && some[at] <= map->lost_to)
            continue;
        *low = some[at] < *low ? some[at] : *low;
        *high = some[at] > *high ? some[at] : *high;
    }
    return *low <= *high;
}

/* ---- checking ---- */

static enum rc_status
check_map(const struct rc_map *map, const struct rc_file *file, struct rc_err *err)
{
    size_t outer = map->by_columns ? map->nx : map->ny;
    size_t inner = map->by_columns ? map->ny : map->nx, line, bytes;

    if (map->nx == 0 || map->ny == 0)
        return rc_err_set(err, "channel '%s' has no values: %zu columns, %zu rows", map->name,
                          map->nx, map->ny);
    if (!isfinite(map->scale) || !isfinite(map->zero) || !isfinite(map->si) || map->scale == 0)
        return rc_err_set(err, "channel '%s': heights are number * %g + %g in the file: both must "
                               "be finite and the first not 0", map->name, map->scale * map->si,
                          map->zero * map->si);
    if (map->fill != NULL)
        return RC_OK;
    if (rc_size_mul(inner, rc_raw_width(map->raw), &line, err) != RC_OK ||
        map->padding > SIZE_MAX - line ||
        rc_size_mul(line + map->padding, outer, &bytes, err) != RC_OK)
        return RC_FAIL;
    bytes -= map->padding; /* the last line may lack it */
    if (map->at > file->size || bytes > file->size - map->at)
        return rc_err_set(err, "channel '%s': the header promises %zu x %zu values, %zu bytes from "
                               "byte %zu on, the file has %zu bytes in all", map->name, map->nx,
                          map->ny, bytes, map->at, file->size);
    return RC_OK;
}

static enum rc_status
describe(rc_maps_find *find, const struct rc_file *file, const struct rc_wish *wish,
         struct rc_maps *maps, struct rc_err *err)
{
    maps->n = maps->keys = 0;
    if (find(file, wish, maps, err) != RC_OK)
        return RC_FAIL;
    if (maps->n == 0)
        return rc_err_set(err, "there is no map in the file");
    for (size_t k = 0; k < maps->n && k < RC_MAPS_MOST; k++) {
        struct rc_map *map = &maps->map[k];

        if (map->name[0] == '\0')
            strcpy(map->name, map->unit[0] == '\0' || strcmp(map->unit, "m") == 0 ? "height"
                                                                                  : "values");
        if (check_map(map, file, err) != RC_OK)
            return RC_FAIL;
    }
    return RC_OK;
}

size_t
rc_maps_list(rc_maps_find *find, const struct rc_file *file, const struct rc_wish *wish,
             struct rc_channel *channel, size_t most, struct rc_err *err)
{
    struct rc_maps maps;

    if (describe(find, file, wish, &maps, err) != RC_OK)
        return 0;
    for (size_t k = 0; k < maps.n && k < most && k < RC_MAPS_MOST; k++) {
        const struct rc_map *map = &maps.map[k];
        channel[k] = (struct rc_channel){.nx = map->nx, .ny = map->ny, .dx = map->dx,
                                         .dy = map->dy};
        strcpy(channel[k].name, map->name);
        strcpy(channel[k].unit, map->unit);
    }
    return maps.n < RC_MAPS_MOST ? maps.n : RC_MAPS_MOST;
}

/* ---- values ---- */

/* Puts line `outer` of the file where it belongs. */
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
    struct rc_bytes bytes = rc_file_bytes(file, map->big);
    double *line;

    bytes.at = map->at;
    if (!map->by_columns && !map->bottom_first && !map->right_first && map->padding == 0) {
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
    free(line);
    return RC_OK;
}

/* What fill has put in the file's order, in the order of a grid. */
static enum rc_status
fill(const struct rc_map *map, const struct rc_file *file, const struct rc_wish *wish, double *v,
     struct rc_err *err)
{
    size_t outer = map->by_columns ? map->nx : map->ny;
    size_t inner = map->by_columns ? map->ny : map->nx, n = map->nx * map->ny;
    double *raw;

    if (!map->by_columns && !map->bottom_first && !map->right_first)
        return map->fill(file, wish, map, v, err);
    if ((raw = malloc(n * sizeof *raw)) == NULL)
        return rc_err_set(err, "out of memory for %zu values", n);
    if (map->fill(file, wish, map, raw, err) != RC_OK) {
        free(raw);
        return RC_FAIL;
    }
    for (size_t k = 0; k < outer; k++)
        place(map, raw + k * inner, k, v);
    free(raw);
    return RC_OK;
}

static enum rc_status
scale(const struct rc_map *map, double si, double *v, struct rc_err *err)
{
    for (size_t k = 0; k < map->nx * map->ny; k++) {
        if (isnan(v[k]))
            continue;
        if (v[k] >= map->lost_from && v[k] <= map->lost_to) {
            v[k] = NAN;
            continue;
        }
        v[k] = (v[k] * map->scale + map->zero) * si;
        if (!isfinite(v[k]))
            return rc_err_set(err, "the value at column %zu, row %zu (from 0) is infinite",
                              k % map->nx, k / map->nx);
    }
    return RC_OK;
}

struct rc_grid *
rc_maps_read(rc_maps_find *find, const struct rc_file *file, const struct rc_wish *wish,
             size_t index, struct rc_notes *notes, struct rc_err *err)
{
    struct rc_maps maps;
    const struct rc_map *map = &maps.map[index < RC_MAPS_MOST ? index : 0];
    struct rc_shape shape;
    struct rc_grid *g = NULL;
    bool is_length, is_height;
    double si;

    if (describe(find, file, wish, &maps, err) != RC_OK)
        return NULL;
    if (index >= maps.n || index >= RC_MAPS_MOST) {
        rc_err_set(err, "there is no channel %zu: the file has %zu", index + 1, maps.n);
        return NULL;
    }
    is_length = strcmp(map->unit, "m") == 0;
    is_height = is_length || map->unit[0] == '\0' || !isnan(wish->z_unit);
    si = map->si;
    shape = (struct rc_shape){.nx = map->nx, .ny = map->ny};
    if (rc_spacing(wish, map->dx, map->dy, &shape, notes, err) != RC_OK) {
        if (isnan(map->dx) && err != NULL && strlen(err->text) + strlen(map->hint) < sizeof err->text)
            strcat(err->text, map->hint);
        return NULL;
    }
    if ((is_height && rc_height_unit(wish, is_length ? map->si : NAN, map->unit, &si, notes,
                                     err) != RC_OK) ||
        (g = rc_grid_new(&shape, is_height ? "height" : map->name, is_height ? "m" : map->unit,
                         err)) == NULL)
        return NULL;
    if ((map->fill == NULL ? decode(map, file, g->v, err) : fill(map, file, wish, g->v, err)) !=
            RC_OK ||
        scale(map, si, g->v, err) != RC_OK ||
        (strcmp(map->name, "height") != 0 &&
         rc_text_keep(g, "file.channel", map->name, strlen(map->name), err) != RC_OK))
        goto failed;
    for (size_t k = 0; k < maps.keys; k++)
        if (rc_grid_set(g, maps.key[k].name, maps.key[k].value, err) != RC_OK)
            goto failed;
    return g;
failed:
    rc_grid_free(g);
    return NULL;
}
