/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "matlab.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    ARRAYS_MOST = 4096
};

struct facts {
    double dx, dy;
    char unit[16], dunit[16];
    struct rc_matlab_array x, y; /* name "": there is none */
    size_t maps, vectors;
    bool no_axes; /* x and y are channels, because there are no others */
    char others[160];
};

static bool
is_map(const struct rc_matlab_array *a)
{
    return a->other == NULL && !a->is_text && a->more == 0 && a->rows > 1 && a->columns > 1;
}

static bool
is_vector(const struct rc_matlab_array *a)
{
    return a->other == NULL && !a->is_text && a->more == 0 && a->rows > 0 && a->columns > 0 &&
           (a->rows > 1) != (a->columns > 1);
}

static bool
is_axis(const struct facts *f, const struct rc_matlab_array *a)
{
    return !f->no_axes && strlen(a->name) == 1 && strchr("xyXY", a->name[0]) != NULL;
}

static bool
is_channel(const struct facts *f, const struct rc_matlab_array *a)
{
    return !is_axis(f, a) && (f->maps > 0 ? is_map(a) : is_vector(a));
}

/* Keeps the kind of an array that is not a channel, for the refusal of a file without channels. */
static void
remember_other(struct facts *f, const struct rc_matlab_array *a)
{
    const char *what = a->other != NULL ? a->other
                       : a->is_text     ? "text"
                       : a->more > 0    ? "of more than two dimensions"
                                        : "one number, or empty";
    char text[sizeof f->others];

    snprintf(text, sizeof text, "%s'%s' is %s", f->others[0] == '\0' ? ": " : ", ",
             rc_word_shown(a->name), what);
    if (strlen(f->others) + strlen(text) < sizeof f->others)
        strcat(f->others, text);
}

static void
take(struct facts *f, const struct rc_matlab_array *a)
{
    bool one = a->other == NULL && !a->is_text && a->more == 0 && a->rows == 1 && a->columns == 1;

    if (one && strcmp(a->name, "dx") == 0)
        f->dx = a->first;
    else if (one && strcmp(a->name, "dy") == 0)
        f->dy = a->first;
    else if (a->is_text && strcmp(a->name, "unit") == 0)
        strcpy(f->unit, a->text);
    else if (a->is_text && strcmp(a->name, "dunit") == 0)
        strcpy(f->dunit, a->text);
    else if (!is_map(a) && !is_vector(a))
        remember_other(f, a);
    else if (is_axis(f, a))
        *(tolower((unsigned char)a->name[0]) == 'x' ? &f->x : &f->y) = *a;
    else
        ++*(is_map(a) ? &f->maps : &f->vectors);
}

static enum rc_status
survey(struct rc_matlab_source *s, bool no_axes, struct facts *f, struct rc_err *err)
{
    struct rc_matlab_array a;
    enum rc_status status;
    size_t n = 0;

    *f = (struct facts){.dx = NAN, .dy = NAN, .no_axes = no_axes};
    s->start(s);
    while ((status = s->next(s, &a, err)) == RC_MORE) {
        if (n++ == ARRAYS_MOST)
            return rc_err_set(err, "the file has more than %d variables", ARRAYS_MOST);
        take(f, &a);
    }
    return status;
}

/* The step of an axis of n points. The axis is a vector of n numbers, or a row (of x) or column of an array
 * of the map's size. NAN if no array has that size. */
static enum rc_status
axis_step(struct rc_matlab_source *s, const struct rc_matlab_array *a, const struct rc_map *map,
          bool is_x, double *step, struct rc_err *err)
{
    size_t n = is_x ? map->nx : map->ny, values;
    RC_OWNED double *x = NULL;

    *step = NAN;
    if (a->name[0] == '\0' || n < 2 || rc_size_mul(a->rows, a->columns, &values, NULL) != RC_OK ||
        (!(is_vector(a) && values == n) && (a->rows != map->ny || a->columns != map->nx)))
        return RC_OK;
    if (rc_map_fits(s->file, a->columns, a->rows, err) != RC_OK)
        return RC_FAIL;
    if ((x = malloc(values * sizeof *x)) == NULL)
        return rc_err_set(err, "out of memory for the %zu positions of '%s'", values, a->name);
    if (s->numbers(s, a, x, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < n && values > n && is_x; k++)
        x[k] = x[k * a->rows];
    return rc_axis_step(a->name, x, n, step, err);
}

static enum rc_status
add_map(struct rc_matlab_source *s, const struct facts *f, const struct rc_matlab_array *a,
        struct rc_maps *maps, struct rc_err *err)
{
    struct rc_map *map = rc_maps_add(maps, rc_piece_of(a->name));
    double dx = f->dx, dy = isnan(f->dy) ? f->dx : f->dy;

    map->nx = f->maps > 0 ? a->columns : a->rows * a->columns;
    map->ny = f->maps > 0 ? a->rows : 1;
    map->by_columns = f->maps > 0;
    if (s->place(s, a, map, err) != RC_OK)
        return RC_FAIL;
    if (isnan(dx) && (axis_step(s, &f->x, map, true, &dx, err) != RC_OK ||
                      axis_step(s, &f->y, map, false, &dy, err) != RC_OK))
        return RC_FAIL;
    if (map->ny == 1)
        dy = dx;
    if (!isnan(dx) && !isnan(dy))
        rc_map_steps(map, dx, dy, (struct rc_piece){f->dunit, strlen(f->dunit)});
    if (f->unit[0] != '\0' && (f->maps > 0 ? f->maps : f->vectors) == 1)
        rc_map_unit(map, rc_piece_of(f->unit));
    return RC_OK;
}

enum rc_status
rc_matlab_maps(struct rc_matlab_source *s, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_matlab_array a;
    enum rc_status status;
    struct facts f;

    if (survey(s, false, &f, err) != RC_OK)
        return RC_FAIL;
    if (f.maps + f.vectors == 0 && (f.x.name[0] != '\0' || f.y.name[0] != '\0') &&
        survey(s, true, &f, err) != RC_OK)
        return RC_FAIL;
    if (f.maps + f.vectors == 0)
        return rc_err_set(
            err, "the file has no real array of numbers with two dimensions%s: save the map as one",
            f.others);
    s->start(s);
    while ((status = s->next(s, &a, err)) == RC_MORE)
        if (is_channel(&f, &a) && add_map(s, &f, &a, maps, err) != RC_OK)
            return RC_FAIL;
    return status;
}
