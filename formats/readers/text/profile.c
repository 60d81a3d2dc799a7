/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Profiles as text: a column of positions, evenly apart, and one of heights, after a header of any kind.
 * titled_table.h describes how units and roles are found. A column that counts the points is ignored, one
 * titled "valid" marks missing points by 0, and further ones are channels. A further column of
 * positions, with its own steps, holds for the columns behind it: x1 z1 x2 z2. A single column is of
 * heights; where its second number is the count of those behind it, the first is their length (Surftest,
 * *.tx1: mm, and heights in um).
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "titled_table.h"
#include "formats/format.h"

/* A column of positions, and the points of its rows in their order. */
struct track {
    size_t x, points;
    size_t *row; /* the row of each point   */
    double *at;  /* positions, not falling; NULL: a single column */
    struct rc_even even;
};

struct profile {
    struct rc_titled_table *table;
    struct track track[RC_TITLES_MOST];
    size_t tracks;
    size_t valid;                         /* a column; the number of columns: none */
    size_t height[RC_MAPS_MOST], heights; /* columns of heights */
    size_t of[RC_MAPS_MOST];              /* their tracks */
    size_t first;                         /* the first row of heights */
    bool known;                           /* the columns are known */
    bool turns;                           /* the positions turn back a little */
};

static const double *
column(const struct profile *p, size_t c)
{
    return p->table->v + c;
}

/* ---- columns ---- */

static bool
counts(const struct profile *p, size_t c)
{
    const double *v = column(p, c);
    size_t rows = p->table->numbers.rows, columns = p->table->numbers.columns;

    if (rc_titled_table_role(p->table, c) == RC_ROLE_INDEX)
        return true;
    for (size_t k = 0; k < rows; k++)
        if (v[k * columns] != v[0] + (double)k)
            return false;
    return rows > 1 && (v[0] == 0 || v[0] == 1) && rc_titled_table_unit(p->table, c, 'x').n == 0;
}

/* The column of positions: by its title, otherwise the first that does not number the points. */
static size_t
positions_of(const struct profile *p)
{
    const struct rc_titled_table *t = p->table;
    size_t columns = t->numbers.columns, x = rc_titled_table_column(t, RC_ROLE_X);

    if (x == columns && rc_titled_table_column(t, RC_ROLE_Z) < columns)
        x = rc_titled_table_column(t, RC_ROLE_Y);
    if (x < columns)
        return x;
    return columns > 2 && t->titles > 2 && counts(p, 0);
}

/* True if column c holds further positions: it has their title, and a column of heights follows. */
static bool
begins_track(const struct profile *p, size_t c)
{
    const struct rc_titled_table *t = p->table;

    return c > p->track[0].x && rc_titled_table_role(t, c) == RC_ROLE_X &&
           rc_titled_table_role(t, p->track[0].x) == RC_ROLE_X && c + 1 < t->numbers.columns &&
           rc_titled_table_role(t, c + 1) == RC_ROLE_Z && p->tracks < RC_TITLES_MOST;
}

/* Finds the columns of heights: the others, except columns that are known not to be heights. */
static void
find_heights(struct profile *p)
{
    const struct rc_titled_table *t = p->table;
    size_t columns = t->numbers.columns;

    for (size_t c = 0; c < columns; c++)
        if (begins_track(p, c))
            p->track[p->tracks++].x = c;
        else if (c != p->track[0].x && c != p->valid &&
                 (c > 0 || columns < 3 || t->titles < 3 || !counts(p, c)) &&
                 rc_titled_table_role(t, c) != RC_ROLE_INDEX && p->heights < RC_MAPS_MOST) {
            p->of[p->heights] = p->tracks - 1;
            p->height[p->heights++] = c;
        }
}

/* A single column of heights, perhaps below their length and count. */
static enum rc_status
take_column(struct profile *p, struct rc_err *err)
{
    const double *v;
    size_t rows = p->table->numbers.rows;

    if (rc_titled_table_read(p->table, err) != RC_OK)
        return RC_FAIL;
    p->valid = p->heights = p->tracks = 1;
    v = p->table->v;
    if (rows > 4 && v[0] > 0 && v[1] == (double)(rows - 2)) {
        p->known = true;
        p->first = 2;
    }
    return RC_OK;
}

/* RC_FAIL for a table of forces without positions: a force curve. */
static enum rc_status
refuse_forces(const struct rc_titled_table *t, struct rc_err *err)
{
    for (size_t c = 0; c < t->numbers.columns && c < t->titles && c < RC_TITLES_MOST; c++) {
        struct rc_map map = {.si = 1};

        rc_map_unit(&map, rc_titled_table_unit(t, c, 'z'));
        if (strcmp(map.unit, "N") == 0 &&
            rc_titled_table_column(t, RC_ROLE_X) == t->numbers.columns)
            return rc_err_set(err,
                              "'%s' is a force and no title names x: that is a force curve, which "
                              "has no surface",
                              rc_piece_shown(rc_titled_table_name(t, c)));
    }
    return RC_OK;
}

static enum rc_status
pick_columns(struct profile *p, struct rc_err *err)
{
    struct rc_titled_table *t = p->table;
    size_t columns = t->numbers.columns;

    if (columns == 1)
        return take_column(p, err);
    if (columns > 2 && t->titles < 2)
        return rc_err_set(err,
                          "a table of %zu columns without titles: which are positions and heights?",
                          columns);
    if (rc_titled_table_is_matrix(t))
        return rc_err_set(err,
                          "the titles of %zu columns name no axis: that is a matrix, no profile; "
                          "--format ascii reads it",
                          columns);
    if (columns > 2 && rc_titled_table_column(t, RC_ROLE_X) < columns &&
        rc_titled_table_column(t, RC_ROLE_Y) < columns &&
        rc_titled_table_column(t, RC_ROLE_Z) < columns)
        return rc_err_set(err, "the titles name x, y and z: that is a list of points, no profile; "
                               "--format xyz reads it");
    p->known = true;
    if (refuse_forces(t, err) != RC_OK || rc_titled_table_read(t, err) != RC_OK)
        return RC_FAIL;
    p->valid = rc_titled_table_column(t, RC_ROLE_VALID);
    p->tracks = 1;
    p->track[0].x = positions_of(p);
    find_heights(p);
    if (p->track[0].x == p->valid || p->heights == 0)
        return rc_err_set(err, "there are no columns of positions and heights in the table");
    return RC_OK;
}

/* ---- positions ---- */

struct place {
    double at;
    size_t row;
};

static int
by_place(const void *a, const void *b)
{
    const struct place *x = a, *y = b;

    return x->at != y->at ? (x->at > y->at) - (x->at < y->at)
                          : (x->row > y->row) - (x->row < y->row);
}

/* Sorts the points by their positions. */
static enum rc_status
sort_points(struct track *t, struct rc_err *err)
{
    RC_OWNED struct place *place = malloc(t->points * sizeof *place);

    if (place == NULL)
        return rc_err_set(err, "out of memory for %zu points", t->points);
    for (size_t k = 0; k < t->points; k++)
        place[k] = (struct place){t->at[k], t->row[k]};
    qsort(place, t->points, sizeof *place, by_place);
    for (size_t k = 0; k < t->points; k++) {
        t->at[k] = place[k].at;
        t->row[k] = place[k].row;
    }
    return RC_OK;
}

/* Positions that change direction: --even sorts those that turn back a little. */
static enum rc_status
turn_back(struct profile *p, struct track *t, size_t k, struct rc_err *err)
{
    size_t columns = p->table->numbers.columns, before = t->row[k - 1], here = t->row[k];
    const double *x = column(p, t->x);
    size_t later = here > before ? here : before, other = here > before ? before : here;

    p->turns = t->points > 5 && rc_even_one_way(t->at, t->points, 1);
    if (p->turns && p->table->wish->even)
        return sort_points(t, err);
    if (!p->turns)
        return rc_err_set(err,
                          "the positions change direction at row %zu of the table, which is "
                          "read as a profile; for a matrix give --format ascii",
                          later + 1);
    return rc_err_set(err,
                      "the positions of the profile turn back at row %zu of the table (%s after "
                      "%s): --even sorts the points and resamples them to even steps",
                      later + 1, rc_number(x[later * columns]), rc_number(x[other * columns]));
}

/* Takes the positions; those that fall are turned round: the last point becomes the first node, at the same
 * place as before. Of several columns of positions one may end before the others. */
static enum rc_status
take_positions(struct profile *p, struct track *t, struct rc_err *err)
{
    size_t rows = p->table->numbers.rows, columns = p->table->numbers.columns;
    const double *x = column(p, t->x);
    bool falls;

    t->points = rows;
    while (p->tracks > 1 && t->points > 3 && isnan(x[(t->points - 1) * columns]))
        t->points--;
    if (rows < 3)
        return rc_err_set(err, "a profile has 3 points at least, this table has %zu rows", rows);
    if ((t->at = calloc(rows, sizeof *t->at)) == NULL ||
        (t->row = calloc(rows, sizeof *t->row)) == NULL)
        return rc_err_set(err, "out of memory for %zu points", rows);
    falls = x[(t->points - 1) * columns] < x[0];
    for (size_t k = 0; k < t->points; k++) {
        t->row[k] = falls ? t->points - 1 - k : k;
        t->at[k] = x[t->row[k] * columns];
        if (!isfinite(t->at[k]))
            return rc_err_set(err, "row %zu of the table has no position", t->row[k] + 1);
    }
    for (size_t k = 1; k < t->points; k++)
        if (!(t->at[k] > t->at[k - 1]))
            return turn_back(p, t, k, err);
    return RC_OK;
}

static enum rc_status
profile_open(void *found, struct rc_titled_table *table, struct rc_err *err)
{
    struct profile *p = found;

    p->table = table;
    if (rc_titled_table_check(table, err) != RC_OK || pick_columns(p, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < p->tracks; k++) {
        struct track *t = &p->track[k];
        struct rc_piece unit;

        t->even.n = table->numbers.rows - p->first;
        if (table->numbers.columns == 1)
            continue;
        unit = rc_titled_table_unit(table, t->x, 'x');
        if (unit.n > 0 && isnan(rc_piece_metres(unit)))
            return rc_err_set(err, "the positions are in '%s', which is not a length",
                              rc_piece_shown(unit));
        if (take_positions(p, t, err) != RC_OK)
            return RC_FAIL;
    }
    return RC_OK;
}

static void
profile_close(void *found)
{
    struct profile *p = found;

    for (size_t k = 0; k < p->tracks; k++) {
        free(p->track[k].at);
        free(p->track[k].row);
    }
}

static const struct rc_table_kind kind = {RC_TABLE_PROFILE, sizeof(struct profile), profile_open,
                                          profile_close};

/* ---- the map ---- */

static enum rc_status
fill_heights(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    const struct rc_titled_table *t = map->opened;
    const struct profile *p = t->as[RC_TABLE_PROFILE].found;
    const struct track *track = &p->track[p->of[map->more]];
    size_t points = track->at == NULL ? map->nx : track->points, columns = t->numbers.columns;
    RC_OWNED double *z = malloc(points * sizeof *z);

    (void)file;
    if (z == NULL)
        return rc_err_set(err, "out of memory for %zu points", points);
    for (size_t k = 0; k < points; k++) {
        const double *row = t->v + (track->at == NULL ? k + p->first : track->row[k]) * columns;

        z[k] = p->valid < columns && row[p->valid] == 0 ? NAN : row[p->height[map->more]];
    }
    rc_even_heights(&track->even, track->at, z, points, v, map->notes);
    rc_titled_table_left_out(t, map->notes);
    if (p->first > 0)
        rc_note(map->notes,
                "the first numbers, %s and %s, are the length and the count of the heights below "
                "them%s",
                rc_number(t->v[0]), rc_number(t->v[1]),
                rc_file_named(t->file, ".tx1") ? "; taken as mm, and the heights as um" : "");
    return RC_OK;
}

static void
add_heights(const struct profile *p, size_t k, struct rc_maps *maps)
{
    const struct track *t = &p->track[p->of[k]];
    size_t c = p->height[k];
    bool surftest = p->first > 0 && rc_file_named(maps->file, ".tx1");
    struct rc_map *map =
        rc_maps_add(maps, p->heights > 1 ? rc_titled_table_name(p->table, c) : rc_piece_of(""));
    double step = p->first > 0 ? p->table->v[0] / p->table->v[1] : t->even.step;

    map->nx = t->even.n;
    map->ny = 1;
    map->more = k;
    if (t->at != NULL || p->first > 0)
        rc_map_steps(map, step, step,
                     surftest ? rc_piece_of("mm") : rc_titled_table_unit(p->table, t->x, 'x'));
    map->fill = fill_heights;
    rc_map_unit(map, surftest ? rc_piece_of("um") : rc_titled_table_unit(p->table, c, 'z'));
}

/* Places even nodes along the profile. */
static enum rc_status
profile_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    enum rc_status status;
    struct profile *p = rc_table_as(maps, &kind, &status, err);

    if (status != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < p->tracks; k++) {
        struct track *t = &p->track[k];
        double metres = rc_piece_metres(rc_titled_table_unit(p->table, t->x, 'x'));

        if (isnan(metres) && maps->wish->xy_unit > 0)
            metres = maps->wish->xy_unit;
        if (t->at != NULL &&
            rc_even_new(t->at, t->points, metres, file, maps->wish, &t->even, err) != RC_OK)
            return RC_FAIL;
    }
    for (size_t k = 0; k < p->heights; k++)
        add_heights(p, k, maps);
    return RC_OK;
}

/* 3: the refusal of a table names its error; one column could have any meaning. 45: two columns of which
 * the first turns back a little are no matrix. */
static int
profile_score(struct rc_maps *maps)
{
    enum rc_status status;
    const struct profile *p = rc_table_as(maps, &kind, &status, NULL);

    return p == NULL || !p->known                       ? 0
           : status == RC_OK                            ? 60
           : p->turns && p->table->numbers.columns == 2 ? 45
                                                        : 3;
}

const struct rc_format rc_format_profile = {
    .name = "profile",
    .suffixes = ".txt .csv .asc .hfm",
    .summary = "profiles as text: positions and heights",
    .score_open = profile_score,
    .find = profile_find,
    .columns = true,
};
