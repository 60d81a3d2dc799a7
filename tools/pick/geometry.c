/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cuts, resamples, mirrors and rotates maps. */
#include "pick.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* An argument: nodes, or lengths in metres. */
struct request {
    bool lengths;
    double v[4];
    size_t n;          /* n of v */
    struct part *part; /* of the map whose values are read later */
};

struct geometry {
    const char *option;
    bool turns;
    bool by_rows; /* does not need the values of a frame */
    /* RC_FAIL for an invalid argument. */
    enum rc_status (*read)(const char *text, struct request *r, struct rc_err *err);
    enum rc_status (*apply)(struct tool *t, struct rc_grid *g, const struct request *r,
                            struct rc_err *err);
};

/* ---- arguments ---- */

/* Reads the numbers between commas, at most four, and which of them have a unit. */
static enum rc_status
read_numbers(const char *text, struct request *r, bool with_unit[4], struct rc_err *err)
{
    for (r->n = 0;; text++) {
        size_t n = strcspn(text, ",");
        const char *end;
        char one[64];

        if (r->n == 4 || n >= sizeof one)
            return rc_err_set(err, "'%s': more than four numbers", text);
        memcpy(one, text, n);
        one[n] = '\0';
        if (unit_number(one, UNIT_M, &r->v[r->n], err) != RC_OK)
            return RC_FAIL;
        end = rc_number_read(one, false, &(double){0});
        with_unit[r->n++] = end != NULL && end[strspn(end, " ")] != '\0';
        text += n;
        if (*text == '\0')
            return RC_OK;
    }
}

static enum rc_status
read_crop(const char *text, struct request *r, struct rc_err *err)
{
    bool with_unit[4] = {false};

    if (read_numbers(text, r, with_unit, err) != RC_OK)
        return RC_FAIL;
    if (r->n != 4)
        return rc_err_set(err, "four numbers X,Y,W,H are expected: where the part begins from the "
                               "left and upper edge, its width and height");
    for (size_t k = 0; k < 4; k++)
        r->lengths = r->lengths || with_unit[k];
    for (size_t k = 0; k < 4; k++) {
        if (r->v[k] < 0 || (k >= 2 && r->v[k] == 0))
            return rc_err_set(err, "the part has to begin in the map and to have a width and a "
                                   "height");
        if (r->lengths ? !with_unit[k] && r->v[k] != 0
                       : r->v[k] != floor(r->v[k]) || r->v[k] > 9e15)
            return rc_err_set(err, "give four whole numbers (nodes), or four lengths with a unit");
    }
    return RC_OK;
}

/* Reads the digits up to `end` as a number of nodes. */
static bool
read_count(const char *text, const char *end, double *count)
{
    size_t n = (size_t)(end - text);

    return n > 0 && n <= 15 && strspn(text, "0123456789") >= n &&
           rc_number_read(text, false, count) != NULL && *count > 0;
}

static enum rc_status
read_resample(const char *text, struct request *r, struct rc_err *err)
{
    const char *by = strchr(text, 'x');
    bool with_unit[4];

    r->n = 2;
    r->lengths = by == NULL;
    if (by != NULL && read_count(text, by, &r->v[0]) &&
        read_count(by + 1, by + strlen(by), &r->v[1]))
        return RC_OK;
    if (by != NULL || read_numbers(text, r, with_unit, err) != RC_OK || r->n > 2)
        return rc_err_set(err, "spacings DX or DX,DY are expected, or numbers of nodes, NXxNY");
    if (r->n == 1)
        r->v[r->n++] = r->v[0];
    if (!(r->v[0] > 0 && r->v[1] > 0))
        return rc_err_set(err, "spacings must be above 0");
    return RC_OK;
}

static enum rc_status
read_mirror(const char *text, struct request *r, struct rc_err *err)
{
    if (strcmp(text, "x") != 0 && strcmp(text, "y") != 0)
        return rc_err_set(err, "it must be x, left to right, or y, top to bottom");
    r->v[0] = text[0];
    r->n = 1;
    return RC_OK;
}

static enum rc_status
read_rotate(const char *text, struct request *r, struct rc_err *err)
{
    static const char *const turn[] = {"90", "180", "270"};

    for (size_t k = 0; k < 3; k++)
        if (strcmp(text, turn[k]) == 0) {
            r->v[0] = (double)(k + 1);
            r->n = 1;
            return RC_OK;
        }
    return rc_err_set(err, "it must be 90, 180 or 270 degrees");
}

/* ---- maps ---- */

/* Moves the grid and values of `to` into g, and frees `to`. */
static void
replace(struct rc_grid *g, struct rc_grid *to)
{
    double *v = g->v;

    g->v = to->v;
    to->v = v;
    g->nx = to->nx;
    g->ny = to->ny;
    g->dx = to->dx;
    g->dy = to->dy;
    rc_grid_free(to);
}

/* ---- keys ---- */

/* Removes keys that no longer hold: counts of the points, because the points are new, and the load. */
static enum rc_status
remove_keys(struct rc_grid *g, const char *const *name, struct rc_err *err)
{
    enum rc_status status = RC_OK;

    for (; *name != NULL && status == RC_OK; name++)
        status = rc_grid_set(g, *name, NULL, err);
    return status;
}

/* The boundary of a result, without that of its surface. */
static struct rc_boundary
own_boundary(const struct rc_grid *g)
{
    return rc_grid_get(g, "boundary") == NULL ? RC_FREE : map_boundary(g);
}

/* The map is no longer a whole period along these axes. */
static void
forget_period(struct tool *t, struct rc_grid *g, struct rc_boundary cut)
{
    const struct rc_boundary own = own_boundary(g);
    const char *along = map_end_period(t, g, cut);

    if (cut.x || cut.y) { /* the part may hold most of the error */
        tool_set(t, g, "pressure.error", NULL);
        tool_set(t, g, "traction.error", NULL);
    }
    if ((own.x && cut.x) || (own.y && cut.y)) {
        tool_set(t, g, "boundary", NULL);
        tool_set(t, g, "datum", NULL);
    }
    if (along != NULL)
        tool_warn(t, "%s: a part of a periodic map is not periodic%s: it gets periodic=%s",
                  tool_where(t, g), along, rc_grid_get(g, "periodic"));
}

/* ---- steps ---- */

/* Nodes whose middles lie between two positions, lengths from the edge of a side. */
static enum rc_status
nodes_between(double from, double length, size_t n, double d, size_t *first, size_t *count,
              struct rc_err *err)
{
    double side = (double)n * d, last = from + length;

    if (last > side * (1 + 1e-9))
        return rc_err_set(
            err,
            "a part that begins at %g m and is %g m long is beyond the map, which is %g m there",
            from, length, side);
    *first = (size_t)floor(from / d + 0.5);
    *count = (size_t)fmin(floor(last / d + 0.5), (double)n);
    if (*count <= *first)
        return rc_err_set(err,
                          "the %g m from %g m on contain no node, because nodes are %g m apart",
                          length, from, d);
    *count -= *first;
    return RC_OK;
}

static enum rc_status
crop(struct tool *t, struct rc_grid *g, const struct request *r, struct rc_err *err)
{
    struct rc_shape from = rc_grid_shape(g), to = from;
    size_t left = unit_size(r->v[0]), top = unit_size(r->v[1]);

    to.nx = unit_size(r->v[2]);
    to.ny = unit_size(r->v[3]);
    if (r->lengths &&
        (nodes_between(r->v[0], r->v[2], from.nx, from.dx, &left, &to.nx, err) != RC_OK ||
         nodes_between(r->v[1], r->v[3], from.ny, from.dy, &top, &to.ny, err) != RC_OK))
        return RC_FAIL;
    if (rc_crop(&from, tool_has_values(g) ? g->v : NULL, left, top, &to, g->v, err) != RC_OK)
        return RC_FAIL;
    r->part->left += left;
    r->part->top += top;
    if (to.nx == from.nx && to.ny == from.ny)
        return RC_OK;
    if (!tool_has_values(g))
        g->elsewhere = to.ny;
    g->nx = to.nx;
    g->ny = to.ny;
    forget_period(t, g, rc_boundary_of(to.nx < from.nx, to.ny < from.ny));
    return remove_keys(
        g, (const char *const[]){"filled", "outliers", "spikes", "load", "taper", NULL}, err);
}

static enum rc_status
new_shape(const struct rc_shape *from, const struct request *r, struct rc_shape *to,
          struct rc_err *err)
{
    if (r->lengths)
        return rc_resample_shape(from, r->v[0], r->v[1], to, err);
    *to = (struct rc_shape){.nx = unit_size(r->v[0]),
                            .ny = unit_size(r->v[1]),
                            .dx = from->dx * ((double)from->nx / r->v[0]),
                            .dy = from->dy * ((double)from->ny / r->v[1])};
    if (from->ny == 1 && to->ny == 1 && from->dy == from->dx)
        to->dy = to->dx; /* the width of a profile equals its spacing */
    return rc_shape_check(to, err);
}

/* If means over cells cover the whole map, the load is preserved. */
static enum rc_status
resample(struct tool *t, struct rc_grid *g, const struct request *r, struct rc_err *err)
{
    struct rc_shape from = rc_grid_shape(g), to;
    const struct rc_boundary surface = map_repeats(g), own = own_boundary(g);
    const struct rc_boundary round = rc_boundary_of(surface.x || own.x, surface.y || own.y);
    struct rc_boundary cut;
    bool covers, same;
    struct rc_grid *map;

    if (new_shape(&from, r, &to, err) != RC_OK)
        return RC_FAIL;
    cut = rc_boundary_of(!rc_resample_covers(&from, &to, RC_X),
                         !rc_resample_covers(&from, &to, RC_Y));
    covers = rc_repeats(cut) == 0;
    same = covers && from.nx == to.nx && from.ny == to.ny;
    if (same && from.dx == to.dx && from.dy == to.dy)
        return RC_OK;
    if ((map = rc_grid_new(&to, g->channel, g->unit, err)) == NULL)
        return RC_FAIL;
    if (rc_resample(&from, g->v, round, &to, map->v, err) != RC_OK) {
        rc_grid_free(map);
        return RC_FAIL;
    }
    for (size_t k = 0; strcmp(g->channel, CONTACT_CHANNEL) == 0 && k < to.nx * to.ny; k++)
        map->v[k] = map->v[k] < 0.5 ? 0 : 1; /* 1 if most of the cell is in contact */
    replace(g, map);
    forget_period(t, g, cut);
    if (!same && remove_keys(g,
                             (const char *const[]){"filled", "outliers", "spikes", "pressure.error",
                                                   "traction.error", NULL},
                             err) != RC_OK)
        return RC_FAIL;
    if (covers && to.nx <= from.nx && to.ny <= from.ny)
        return RC_OK;
    return remove_keys(g, (const char *const[]){"load", NULL}, err);
}

static enum rc_status
mirror(struct tool *t, struct rc_grid *g, const struct request *r, struct rc_err *err)
{
    (void)t;
    (void)err;
    rc_mirror(rc_shape_of(g), (char)r->v[0], g->v);
    return RC_OK;
}

static enum rc_status
rotate(struct tool *t, struct rc_grid *g, const struct request *r, struct rc_err *err)
{
    const struct rc_boundary surface = map_repeats(g), own = own_boundary(g);
    struct rc_shape from = rc_grid_shape(g), to = rc_rotate_shape(&from, (size_t)r->v[0]);
    struct rc_grid *map;

    if ((map = rc_grid_new(&to, g->channel, g->unit, err)) == NULL)
        return RC_FAIL;
    rc_rotate(&from, g->v, (size_t)r->v[0], map->v);
    replace(g, map);
    if (r->v[0] == 2) /* half a turn */
        return RC_OK;
    if (rc_repeats(surface) == 1)
        map_set_repeats(t, g, rc_boundary_of(surface.y, surface.x));
    if (rc_repeats(own) == 1)
        tool_set(t, g, "boundary", rc_boundary_word(rc_boundary_of(own.y, own.x)));
    return RC_OK;
}

static enum rc_status
read_extrude(const char *text, struct request *r, struct rc_err *err)
{
    r->n = 1;
    return read_count(text, text + strlen(text), &r->v[0])
               ? RC_OK
               : rc_err_set(err, "a number of rows is expected, at least 1");
}

/* Repeats a profile along the other axis. Counts of points and results that belong to the profile are not
 * those of the map. */
static enum rc_status
extrude(struct tool *t, struct rc_grid *g, const struct request *r, struct rc_err *err)
{
    static const char *const gone[] = {"filled",   "outliers", "load", "taper",
                                       "boundary", "datum",    NULL};
    const struct rc_boundary surface = map_repeats(g);
    const bool down = g->ny == 1;
    struct rc_shape to = rc_grid_shape(g);
    struct rc_grid *map;

    if (strcmp(g->channel, "height") != 0)
        return rc_err_set(err, "only heights become a map: choose them by --channel height");
    if (g->nx > 1 && g->ny > 1)
        return rc_err_set(err, "the map has %zu rows and %zu columns: choose one of them by --crop",
                          g->ny, g->nx);
    if (g->nx == 1 && g->ny == 1)
        return rc_err_set(err, "a single node is no profile");
    *(down ? &to.ny : &to.nx) = unit_size(r->v[0]);
    if (rc_shape_check(&to, err) != RC_OK ||
        (map = rc_grid_new(&to, g->channel, g->unit, err)) == NULL)
        return RC_FAIL;
    for (size_t k = 0; k < to.nx * to.ny; k++)
        map->v[k] = g->v[down ? k % to.nx : k / to.nx];
    replace(g, map);
    map_set_repeats(t, g, rc_boundary_of(surface.x || !down, surface.y || down));
    return remove_keys(g, gone, err);
}

/* ---- the table ---- */

static const struct geometry steps[] = {
    {"crop", false, true, read_crop, crop},
    {"resample", false, false, read_resample, resample},
    {"mirror", true, false, read_mirror, mirror},
    {"rotate", true, false, read_rotate, rotate},
    {"extrude", false, false, read_extrude, extrude},
};

static const struct geometry *
find(const struct step *step)
{
    for (size_t k = 0; k < sizeof steps / sizeof *steps; k++)
        if (strcmp(step->opt->name, steps[k].option) == 0)
            return &steps[k];
    return NULL;
}

bool
pick_geometry(const struct step *step)
{
    return find(step) != NULL;
}

bool
pick_by_rows(const struct step *step)
{
    return find(step) == NULL || find(step)->by_rows;
}

void
pick_geometry_settle(struct tool *t, struct step *step)
{
    const struct geometry *what = find(step);
    struct request r = {0};
    size_t size = sizeof r.v / sizeof *r.v * (RC_NUMBER_SIZE + 2), n = 0;
    char *text;

    if (what->read(step->text, &r, &t->err) != RC_OK)
        tool_usage(t, "--%s %s: %s", what->option, step->text, t->err.text);
    if (!r.lengths)
        return;
    text = tool_room(t, size, 1, "a text");
    for (size_t k = 0; k < r.n; k++)
        n += (size_t)snprintf(text + n, size - n, "%s%s%s", k == 0 ? "" : ",", rc_number(r.v[k]),
                              r.v[k] == 0 ? "" : "m");
    step->text = text;
}

static void
demand_map(struct tool *t, const struct rc_grid *g, const struct geometry *what)
{
    if (rc_grid_get(g, "section") != NULL)
        tool_refuse(
            t, g,
            "--%s: a section is not a map: its rows are depths: choose the frames that are maps "
            "by --channel",
            what->option);
    if (strcmp(g->channel, "psd") == 0 || strcmp(rc_grid_dunit(g), "rad/m") == 0)
        tool_refuse(
            t, g,
            "--%s: a spectrum has its zero in the middle: do it to the surface, and take the "
            "spectrum of that",
            what->option);
    tool_demand_lengths(t, g);
    for (size_t k = 0; what->turns && k < RC_STRESSES; k++)
        if (strcmp(g->channel, rc_component_names[k]) == 0)
            tool_refuse(
                t, g,
                "--%s: stresses would change sign or places: do it to the pressure, and run "
                "rc-stress on that",
                what->option);
}

void
pick_geometry_do(struct tool *t, struct rc_grid *g, const struct step *step, struct part *part)
{
    const struct geometry *what = find(step);
    struct request r = {.part = part};

    demand_map(t, g, what);
    if (what->read(step->text, &r, &t->err) != RC_OK || what->apply(t, g, &r, &t->err) != RC_OK)
        tool_refuse(t, g, "--%s %s: %s", what->option, step->text, t->err.text);
}
