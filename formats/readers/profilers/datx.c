/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Zygo DATX: an HDF5 file with a table /MetaData of (group, key, value); a value in braces is the name of
 * another group. Root > Measurement > Surface > Path names the dataset of heights, rows by columns. Where the
 * table does not lead there, the heights are the first dataset of /Data/Surface, or /Measurement/Surface.
 *
 * Its attributes are Unit of the heights and No Data (a value not below it is missing). X and Y Converter
 * have the metres of a pixel as the second of their numbers, 0 where none was calibrated. Heights in fringes
 * are turned into metres by Wavelength, Interferometric Scale Factor and Obliquity Factor.
 */
#include <math.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/format.h"

enum {
    WORD = 128
};

/* ---- where the heights are ---- */

struct lookup {
    char group[WORD], key[WORD], value[WORD];
};

static void
look(void *arg, const struct rc_hdf_record *record)
{
    struct lookup *l = arg;

    if (strcmp(record->text[0], l->group) == 0 && strcmp(record->text[1], l->key) == 0)
        strcpy(l->value, record->text[2]);
}

static bool
follow(struct rc_hdf *h, struct rc_hdf_set *set)
{
    static const char *const way[] = {"Measurement", "Surface", "Path"};
    struct lookup l = {.group = "Root"};

    for (size_t k = 0; k < sizeof way / sizeof *way; k++) {
        strcpy(l.key, way[k]);
        l.value[0] = '\0';
        if (!rc_hdf_table(h, "/MetaData", NULL, look, &l) || l.value[0] == '\0')
            return false;
        strcpy(l.group, l.value);
    }
    return rc_hdf_set_at(h, l.value, set);
}

static enum rc_status
find_surface(struct rc_hdf *h, struct rc_hdf_set *set, struct rc_err *err)
{
    static const char *const places[] = {"Data/Surface/", "Measurement/Surface"};
    static struct rc_hdf_set all[64];
    size_t n;

    if (follow(h, set))
        return RC_OK;
    n = rc_hdf_sets(h, all, sizeof all / sizeof *all);
    for (size_t p = 0; p < sizeof places / sizeof *places; p++)
        for (size_t k = 0; k < n && k < sizeof all / sizeof *all; k++)
            if (strncmp(all[k].path, places[p], strlen(places[p])) == 0) {
                *set = all[k];
                return RC_OK;
            }
    return rc_err_set(err, "an HDF5 file, but no DATX: it has no heights in its table MetaData, in "
                           "/Data/Surface or in /Measurement/Surface");
}

/* ---- what it says of them ---- */

struct surface {
    struct rc_hdf *hdf;
    struct rc_hdf_set set;
    double dx, dy, metres; /* NAN when not told */
    double none;           /* values from here on are missing; NAN: not given */
    char unit[32];
};

static void
take_converter(void *arg, const struct rc_hdf_record *record)
{
    if (strcmp(record->text[0], "LateralCat") == 0 && record->numbers > 1 && record->number[1] != 0)
        *(double *)arg = record->number[1];
}

/* Metres of one unit; NAN: unknown unit. */
static double
unit_of(const struct surface *s)
{
    static const struct {
        const char *name;
        double metres;
    } names[] = {{"Meters", 1},
                 {"MilliMeters", 1e-3},
                 {"MicroMeters", 1e-6},
                 {"NanoMeters", 1e-9},
                 {"Angstroms", 1e-10}};
    double metres, wave, scale = 1, obliquity = 1;

    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (strcmp(s->unit, names[k].name) == 0)
            return names[k].metres;
    if (rc_length_unit(s->unit, strlen(s->unit), &metres))
        return metres;
    if (strcmp(s->unit, "Fringes") != 0 ||
        !rc_hdf_number(s->hdf, s->set.path, "Wavelength", &wave) ||
        !rc_hdf_number(s->hdf, s->set.path, "Interferometric Scale Factor", &scale))
        return NAN;
    rc_hdf_number(s->hdf, s->set.path, "Obliquity Factor", &obliquity);
    return wave * scale * obliquity;
}

static void
surface_close(void *opened)
{
    rc_hdf_free(((struct surface *)opened)->hdf);
}

static enum rc_status
surface_open(struct surface *s, const struct rc_file *file, struct rc_err *err)
{
    s->dx = s->dy = s->none = NAN;
    if ((s->hdf = rc_hdf_new(file, err)) == NULL || find_surface(s->hdf, &s->set, err) != RC_OK)
        return RC_FAIL;
    rc_hdf_text(s->hdf, s->set.path, "Unit", s->unit, sizeof s->unit);
    rc_hdf_number(s->hdf, s->set.path, "No Data", &s->none);
    rc_hdf_table(s->hdf, s->set.path, "X Converter", take_converter, &s->dx);
    rc_hdf_table(s->hdf, s->set.path, "Y Converter", take_converter, &s->dy);
    s->metres = unit_of(s);
    return RC_OK;
}

static enum rc_status
fill_heights(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    struct surface *s = map->opened;

    (void)file;
    return rc_hdf_values(s->hdf, &s->set, v, err);
}

static enum rc_status
datx_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_map *map = rc_maps_add(maps, rc_piece_of("height"));
    struct surface *s = rc_maps_open(maps, sizeof *s, surface_close, err);

    if (s == NULL || surface_open(s, file, err) != RC_OK)
        return RC_FAIL;
    map->nx = s->set.columns;
    map->ny = s->set.rows;
    map->dx = s->dx;
    map->dy = s->dy;
    rc_map_unit(map, rc_piece_of(s->unit));
    if (!isnan(s->metres)) {
        strcpy(map->unit, "m");
        map->si = s->metres;
    }
    map->heights = true;
    map->missing_from = s->none;
    map->missing_to = INFINITY;
    map->fill = fill_heights;
    rc_maps_key(maps, "file.manufacturer", rc_piece_of("Zygo"));
    return RC_OK;
}

/* ---- the entry in formats.list ---- */

static int
datx_score(const struct rc_file *file)
{
    struct rc_piece all = rc_file_piece(file);

    if (!rc_hdf_is(file))
        return 0;
    if (rc_piece_find(all, "MetaData") != NULL && rc_piece_find(all, "Z Converter") != NULL)
        return 90;
    return rc_file_named(file, ".datx") ? 70 : 0;
}

const struct rc_format rc_format_datx = {
    .name = "datx",
    .suffixes = ".datx",
    .summary = "Zygo DATX (Mx)",
    .score = datx_score,
    .find = datx_find,
    .sandboxed = true,
};
