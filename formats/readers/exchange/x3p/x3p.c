/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * X3P, ISO 25178-72 (earlier ISO 5436-2): a ZIP archive that holds
 *
 *     main.xml           what was measured and how, and the heights themselves when they are few
 *     bindata/data.bin   else the heights: little-endian, row 0 first, x fastest
 *     bindata/valid.bin  one bit a point, lowest bit first, 1 where the height is valid
 *     md5checksum.hex    MD5 checksum of main.xml
 *
 * A height is number * increment + offset of the axis CZ, in metres. Damage that reaches a height (a wrong
 * checksum of data.bin or valid.bin) refuses the file. A wrong one of main.xml is noted only, because
 * programs that edit the header are known to leave the old checksum behind.
 */
#include <stdlib.h>
#include <string.h>

#include "x3p_internal.h"
#include "formats/format.h"

/* ---- the archive ---- */

/* main.xml at the top, or under one folder there; macOS adds a folder of its own to archives. */
static bool
find_main(const struct rc_zip_read *a, size_t *member, char prefix[RC_X3P_NAME])
{
    static const char name[] = "main.xml";
    size_t n = rc_zip_read_members(a);

    if (rc_zip_read_find(a, name, member, NULL) == RC_OK) {
        prefix[0] = '\0';
        return true;
    }
    for (size_t k = 0; k < n; k++) {
        const char *path = rc_zip_read_name(a, k), *slash = strchr(path, '/');
        size_t folder = slash == NULL ? 0 : (size_t)(slash - path) + 1;

        if (folder == 0 || folder >= RC_X3P_NAME || strcmp(slash + 1, name) != 0 ||
            strncmp(path, "__MACOSX/", 9) == 0)
            continue;
        memcpy(prefix, path, folder);
        prefix[folder] = '\0';
        *member = k;
        return true;
    }
    return false;
}

static void
x3p_close(void *opened)
{
    struct rc_x3p *x = opened;

    rc_zip_read_free(x->archive);
    free(x->list.value);
    for (size_t f = 0; f < RC_X3P_FIELDS; f++)
        free(x->text[f]);
}

static enum rc_status
x3p_open(struct rc_x3p *x, const struct rc_file *file, struct rc_err *err)
{
    if ((x->archive = rc_zip_read_new(file, err)) == NULL)
        return RC_FAIL;
    if (!find_main(x->archive, &x->main, x->prefix))
        return rc_err_set(
            err,
            "a ZIP archive, but no X3P: it has no main.xml (the first of its %zu members is '%s')",
            rc_zip_read_members(x->archive), rc_word_shown(rc_zip_read_name(x->archive, 0)));
    return rc_x3p_head(x, err);
}

/* ---- what it is ---- */

static int
x3p_score(const struct rc_file *file)
{
    RC_OWN(rc_zip_read, archive) = NULL;
    char prefix[RC_X3P_NAME];
    bool named = rc_file_named(file, ".x3p"), has_main;
    size_t member;

    if (!rc_file_holds(file, 0, "PK", 2))
        return 0;
    /* Another kind of archive gets a low score, so that its refusal names the missing member. */
    if ((archive = rc_zip_read_new(file, NULL)) == NULL)
        return named ? 50 : 5;
    has_main = find_main(archive, &member, prefix);
    return has_main ? (named ? 95 : 80) : 5;
}

/* ---- profiles with positions ---- */

/* Lays even nodes along a profile whose points have positions of their own. Sets x->nx and the spacings.
 * Unless v is NULL, puts the heights at the nodes into v. */
static enum rc_status
lay_nodes(struct rc_x3p *x, const struct rc_file *file, const struct rc_wish *wish, double *v,
          struct rc_notes *notes, struct rc_err *err)
{
    enum rc_status status = RC_FAIL;
    RC_OWNED double *points = NULL;
    struct rc_even even;

    if (x->n < 2)
        return rc_err_set(err, "a profile of one point with a position has no spacing");
    if (rc_map_fits(file, x->n, 16, err) == RC_OK &&
        (points = rc_x3p_profile(x, notes, err)) != NULL)
        status = rc_even_new(points, x->n, 1, file, wish, &even, err);
    if (status == RC_OK) {
        x->nx = even.n;
        x->dx = x->dy = even.step;
        if (v != NULL)
            rc_even_heights(&even, points, points + x->n, x->n, v, notes);
    }
    return status;
}

/* ---- the entry in formats.list ---- */

static enum rc_status
fill_heights(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    struct rc_x3p *x = map->opened;

    rc_x3p_check_main(x, map->notes);
    if (x->old_root)
        rc_note(map->notes,
                "the root of its main.xml is ISO5436, where the standard has ISO5436_2: it "
                "is read as if it were that");
    if (x->turned)
        rc_note(map->notes, "the file turns its axes by a rotation matrix: it is not applied");
    return x->at.absolute ? lay_nodes(x, file, map->wish, v, map->notes, err)
                          : rc_x3p_values(x, file, x->points, v, map->notes, err);
}

static void
add_map(const struct rc_x3p *x, struct rc_maps *maps)
{
    struct rc_map *map = rc_maps_add(maps, rc_piece_of("height"));

    map->nx = x->nx;
    map->ny = x->ny;
    map->dx = x->dx;
    map->dy = x->dy;
    map->fill = fill_heights;
    strcpy(map->unit, "m");
    for (size_t f = RC_X3P_FIRST_KEY; f < RC_X3P_FIELDS; f++)
        if (x->text[f] != NULL)
            rc_maps_key(maps, rc_x3p_key(f), rc_piece_of(x->text[f]));
}

static enum rc_status
x3p_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_x3p *x = rc_maps_open(maps, sizeof *x, x3p_close, err);

    if (x == NULL || x3p_open(x, file, err) != RC_OK ||
        (x->at.absolute && lay_nodes(x, file, maps->wish, NULL, NULL, err) != RC_OK) ||
        (!x->at.absolute && x->binary && rc_x3p_find_points(x, &x->points, err) != RC_OK) ||
        ((x->at.absolute_x || x->at.absolute_y) && rc_x3p_axes(x, file, NULL, NULL, err) != RC_OK))
        return RC_FAIL;
    add_map(x, maps);
    return RC_OK;
}

const struct rc_format rc_format_x3p = {
    .name = "x3p",
    .suffixes = ".x3p",
    .summary = "ISO 25178-72 (ISO 5436-2): maps and profiles",
    .score = x3p_score,
    .find = x3p_find,
};
