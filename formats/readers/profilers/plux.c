/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Sensofar PLUX: a ZIP archive with index.xml. It gives the size of the image, the step of a pixel in
 * micrometres (called FOV), and the member of each layer. A member holds heights: float, little-endian,
 * micrometres, row 0 first, NaN where nothing was measured.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/core/core.h"
#include "formats/format.h"

#define INDEX_MOST ((uint64_t)1 << 24) /* bytes of index.xml */

enum {
    LAYERS_MOST = 64,
    ITEMS_MOST = 64,
    WORD = 256,
};

struct item {
    char name[32], value[128];
};

struct plux {
    struct rc_zip_read *archive;
    size_t nx, ny;
    double dx, dy; /* m, NAN when not given; um in index.xml */
    bool sized;
    char date[64];
    char file[LAYERS_MOST][WORD]; /* names of members, "" for none */
    struct item item[ITEMS_MOST]; /* the data about instrument and settings */
};

/* ---- index.xml ---- */

/* The number after a prefix, and the rest: "LAYER_12/FILENAME_Z". */
static bool
numbered(const char *path, const char *prefix, size_t most, size_t *number, const char **rest)
{
    size_t n = strlen(prefix);
    char *end;

    if (strncmp(path, prefix, n) != 0 || path[n] < '0' || path[n] > '9')
        return false;
    *number = strtoul(path + n, &end, 10);
    *rest = end;
    return *number < most && *end == '/';
}

static enum rc_status
take_element(void *arg, const char *path, const char *text, struct rc_err *err)
{
    struct plux *p = arg;
    const char *rest;
    size_t number;

    path += strcspn(path, "/"); /* the name of the root does not matter */
    path += *path == '/';
    if (strcmp(path, "GENERAL/IMAGE_SIZE_X") == 0) {
        p->sized = true;
        return rc_xml_whole("index.xml", path, text, &p->nx, err);
    }
    if (strcmp(path, "GENERAL/IMAGE_SIZE_Y") == 0)
        return rc_xml_whole("index.xml", path, text, &p->ny, err);
    if (strcmp(path, "GENERAL/FOV_X") == 0)
        return rc_xml_number("index.xml", path, text, &p->dx, err);
    if (strcmp(path, "GENERAL/FOV_Y") == 0)
        return rc_xml_number("index.xml", path, text, &p->dy, err);
    if (strcmp(path, "GENERAL/DATE") == 0)
        rc_text_clean(p->date, sizeof p->date, text, strlen(text));
    else if (numbered(path, "LAYER_", LAYERS_MOST, &number, &rest) &&
             strcmp(rest, "/FILENAME_Z") == 0 && strlen(text) < WORD)
        strcpy(p->file[number], text);
    else if (numbered(path, "INFO/ITEM_", ITEMS_MOST, &number, &rest) && strcmp(rest, "/NAME") == 0)
        rc_text_clean(p->item[number].name, sizeof p->item->name, text, strlen(text));
    else if (numbered(path, "INFO/ITEM_", ITEMS_MOST, &number, &rest) &&
             strcmp(rest, "/VALUE") == 0)
        rc_text_clean(p->item[number].value, sizeof p->item->value, text, strlen(text));
    return RC_OK;
}

/* ---- the archive ---- */

/* The member with this name in index.xml, which may begin with "./". */
static enum rc_status
find(const struct rc_zip_read *a, const char *name, size_t *member, struct rc_err *err)
{
    char dotted[WORD + 2];

    if (strncmp(name, "./", 2) == 0)
        name += 2;
    snprintf(dotted, sizeof dotted, "./%s", name);
    if (rc_zip_read_find(a, dotted, member, NULL) == RC_OK)
        return RC_OK;
    return rc_zip_read_find(a, name, member, err);
}

static enum rc_status
plux_open(struct plux *p, const struct rc_file *file, struct rc_err *err)
{
    size_t member, n;

    p->dx = p->dy = NAN;
    if ((p->archive = rc_zip_read_new(file, err)) == NULL)
        return RC_FAIL;
    if (find(p->archive, "index.xml", &member, NULL) != RC_OK)
        return rc_err_set(err, "a ZIP archive, but no PLUX: it has no index.xml");
    if (rc_zip_read_xml(p->archive, member, INDEX_MOST, "index.xml", false, take_element, p, NULL,
                        err) != RC_OK)
        return RC_FAIL;
    p->dx /= 1e6;
    p->dy /= 1e6;
    if (!p->sized)
        return rc_err_set(err,
                          "a ZIP archive, but no PLUX: its index.xml gives no size of an image");
    if (p->nx == 0 || p->ny == 0)
        return rc_err_set(err, "an image of %zu x %zu points is empty", p->nx, p->ny);
    return rc_size_mul(p->nx, p->ny, &n, err) == RC_OK ? rc_size_mul(n, 4, &n, err) : RC_FAIL;
}

static void
plux_close(void *opened)
{
    rc_zip_read_free(((struct plux *)opened)->archive);
}

/* ---- heights ---- */

static enum rc_status
take_values(void *arg, const unsigned char *bytes, size_t n, struct rc_err *err)
{
    struct rc_bytes cursor = {.data = bytes, .size = n};
    double **v = arg;

    (void)err;
    rc_bytes_values(&cursor, RC_RAW_F32, *v, n / 4); /* a chunk ends between two numbers */
    *v += n / 4;
    return RC_OK;
}

static enum rc_status
fill_layer(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    const struct plux *p = map->opened;
    uint64_t size, wanted = (uint64_t)map->nx * map->ny * 4;
    size_t member;

    (void)file;
    if (find(p->archive, p->file[map->more], &member, err) != RC_OK ||
        rc_zip_read_size(p->archive, member, &size, err) != RC_OK ||
        rc_bytes_agree("heights", wanted, size, err) != RC_OK)
        return RC_FAIL;
    return rc_zip_read_member(p->archive, member, wanted, take_values, &v, NULL, err);
}

static void
add_layer(const struct plux *p, size_t layer, struct rc_maps *maps)
{
    struct rc_map *map;
    char name[32];

    snprintf(name, sizeof name, "Layer %zu", layer);
    map = rc_maps_add(maps, rc_piece_of(name));
    map->nx = p->nx;
    map->ny = p->ny;
    map->dx = p->dx;
    map->dy = p->dy;
    map->fill = fill_layer;
    map->more = layer;
    rc_map_unit(map, rc_piece_of("um"));
}

static enum rc_status
plux_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    static const struct rc_keep keys[] = {
        {"Device", "file.model"}, {"Objective", "file.probe"}, {"Technique", "file.mode"}};
    struct plux *p = rc_maps_open(maps, sizeof *p, plux_close, err);

    if (p == NULL || plux_open(p, file, err) != RC_OK)
        return RC_FAIL;
    rc_maps_key(maps, "file.date", rc_piece_of(p->date));
    for (size_t k = 0; k < ITEMS_MOST; k++) {
        const struct item *i = &p->item[k];

        rc_maps_keep(maps, keys, sizeof keys / sizeof *keys,
                     (struct rc_piece){i->name, strlen(i->name)},
                     (struct rc_piece){i->value, strlen(i->value)});
    }
    rc_maps_key(maps, "file.manufacturer", rc_piece_of("Sensofar"));
    for (size_t k = 0; k < LAYERS_MOST; k++)
        if (p->file[k][0] != '\0')
            add_layer(p, k, maps);
    return maps->n > 0 ? RC_OK : rc_err_set(err, "the file has no layer of heights");
}

/* ---- the entry in formats.list ---- */

static int
plux_score(const struct rc_file *file)
{
    bool named = rc_file_named(file, ".plux"), found;
    RC_OWN(rc_zip_read, archive) = NULL;
    size_t member;

    if (!rc_file_holds(file, 0, "PK", 2))
        return 0;
    if ((archive = rc_zip_read_new(file, NULL)) == NULL)
        return named ? 50 : 0;
    found = find(archive, "index.xml", &member, NULL) == RC_OK;
    for (size_t k = 0; found && !named && k < rc_zip_read_members(archive); k++)
        named = strstr(rc_zip_read_name(archive, k), "LAYER_") != NULL;
    return found ? (named ? 90 : 40) : named ? 10 : 0;
}

const struct rc_format rc_format_plux = {
    .name = "plux",
    .suffixes = ".plux",
    .summary = "Sensofar PLUX: layers of heights in a ZIP archive",
    .score = plux_score,
    .find = plux_find,
};
