/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shapes: checks of their options, their functions, and the table of them. */
#include "synth.h"

#include <math.h>

/* ---- waves ---- */

/* True if a whole number of waves fits the side; the tolerance allows for decimal numbers in nx * dx /
 * wavelength. */
static bool
fits(size_t n, double d, double wavelength)
{
    double waves = (double)n * d / wavelength;

    return n == 1 || isinf(wavelength) ||
           (waves > 0.5 && fabs(waves - round(waves)) <= 1e-9 * waves);
}

/* Along a wave the grid has at least two nodes per period. */
static void
check_wave(struct tool *t, const struct synth_args *a, const struct rc_shape *shape)
{
    const struct numbers *w = &a->wavelength;
    const double d[] = {shape->dx, shape->dy};
    const size_t n[] = {shape->nx, shape->ny};

    if (w->n > 2 || w->v[0] + (w->n == 2 ? w->v[1] : 0) == 0)
        tool_usage(t, "--wavelength takes LX, or LX,LY where one of them may be 0");
    for (size_t k = 0; k < w->n; k++)
        if (n[k] > 1 && w->v[k] != 0 && w->v[k] < 2 * d[k] * (1 - 1e-9))
            tool_usage(t,
                       "--wavelength %g m: shorter than two nodes %g m apart: take a "
                       "finer grid",
                       w->v[k], d[k]);
}

/* The y of row j of the map, from the middle. */
static double
row_place(const struct rc_shape *shape, size_t j)
{
    return ((double)j - 0.5 * (double)(shape->ny - 1)) * shape->dy;
}

/* Shapes are made row by row, as profiles: a process may hold some rows only. The profile of an indenter has
 * its apex at minus the y of the row. */
static struct rc_shape
row_shape(const struct synth_map *m)
{
    return (struct rc_shape){m->shape->nx, 1, m->shape->dx, m->shape->dy};
}

static enum rc_status
make_wave(const struct synth_args *a, struct synth_map *m, struct rc_err *err)
{
    const struct rc_shape *shape = m->shape, row = row_shape(m);
    const struct numbers *w = &a->wavelength;
    double x = w->v[0] == 0 ? INFINITY : w->v[0];
    double y = w->n < 2 || w->v[1] == 0 ? INFINITY : w->v[1];

    (void)err;
    for (size_t j = 0; j < m->rows; j++)
        rc_synth_wave(&row, a->amplitude * cos(2 * M_PI * row_place(shape, m->first + j) / y), x,
                      INFINITY, m->h + j * shape->nx);
    m->periodic = fits(shape->nx, shape->dx, x) && fits(shape->ny, shape->dy, y);
    return RC_OK;
}

/* ---- indenters ---- */

/* In the library 0 means not given. */
static double
or_default(double value)
{
    return isnan(value) ? 0 : value;
}

/* The apex from the middle of row j of those held here. */
static struct rc_place
apex(const struct synth_args *a, const struct synth_map *m, size_t j)
{
    const struct rc_place whole = {a->place.n == 0 ? 0 : a->place.v[0],
                                   a->place.n == 0 ? 0 : a->place.v[1]};

    return (struct rc_place){whole.x, whole.y - row_place(m->shape, m->first + j)};
}

static void
paraboloids(const struct synth_args *a, struct synth_map *m, double radius_1, double radius_2,
            double direction)
{
    const struct rc_shape row = row_shape(m);

    for (size_t j = 0; j < m->rows; j++)
        rc_synth_paraboloid(&row, apex(a, m, j), radius_1, radius_2, direction, m->h + j * row.nx);
}

/* A parabola across its axis, which is along y by default. */
static enum rc_status
make_cylinder(const struct synth_args *a, struct synth_map *m, struct rc_err *err)
{
    (void)err;
    paraboloids(a, m, INFINITY, a->radius.v[0], isnan(a->direction) ? 90 : a->direction);
    return RC_OK;
}

/* A sphere has one radius. */
static enum rc_status
make_paraboloid(const struct synth_args *a, struct synth_map *m, struct rc_err *err)
{
    (void)err;
    paraboloids(a, m, a->radius.v[0], a->radius.v[a->radius.n - 1], or_default(a->direction));
    return RC_OK;
}

static enum rc_status
make_cone(const struct synth_args *a, struct synth_map *m, struct rc_err *err)
{
    const struct rc_shape row = row_shape(m);

    (void)err;
    for (size_t j = 0; j < m->rows; j++)
        rc_synth_cone(&row, apex(a, m, j), a->slope, m->h + j * row.nx);
    return RC_OK;
}

static enum rc_status
make_punch(const struct synth_args *a, struct synth_map *m, struct rc_err *err)
{
    const struct rc_shape row = row_shape(m);
    double below = 0; /* nodes of the punch */

    for (size_t j = 0; j < m->rows; j++)
        rc_synth_punch(&row, apex(a, m, j), a->radius.v[0], or_default(a->edge), a->height,
                       m->h + j * row.nx);
    for (size_t k = 0; k < m->rows * row.nx; k++)
        below += m->h[k] == 0;
    if (ranks_sum(m->tool, below) > 0)
        return RC_OK;
    return rc_err_set(err, "no node lies within the radius %g m of the punch: take a finer grid",
                      a->radius.v[0]);
}

/* ---- roughness ---- */

static void
check_selfaffine(struct tool *t, const struct synth_args *a, const struct rc_shape *shape)
{
    (void)shape;
    if (isnan(a->rms_slope) && isnan(a->rms_height))
        tool_usage(t, "selfaffine needs one of --rms-slope and --rms-height");
    if (!isnan(a->direction) && isnan(a->anisotropy))
        tool_usage(t, "--direction %g: give --anisotropy too: without it there is no lay",
                   a->direction);
}

static enum rc_status
make_selfaffine(const struct synth_args *a, struct synth_map *m, struct rc_err *err)
{
    const struct rc_selfaffine what = {
        .hurst = a->hurst,
        .rms_height = or_default(a->rms_height),
        .rms_slope = or_default(a->rms_slope),
        .long_cut = or_default(a->long_cut),
        .rolloff = or_default(a->rolloff),
        .short_cut = or_default(a->short_cut),
        .seed = a->seed,
        .anisotropy = or_default(a->anisotropy),
        .direction = isnan(a->direction) ? 90 : a->direction,
        .skewness = or_default(a->skewness),
        .weibull = or_default(a->weibull),
        .threads = m->tool->threads,
        .ranks = ranks_of(m->tool),
    };

    m->periodic = true;
    return rc_synth_selfaffine(m->shape, &what, m->h, err);
}

/* ---- the table ---- */

/* clang-format off */
const struct synth_shape synth_shapes[] = {
    {.name = "sphere", .needs = {"radius"}, .radii = 1, .takes = {"place"}, .make = make_paraboloid},
    {.name = "cylinder", .needs = {"radius"}, .radii = 1, .takes = {"direction", "place"},
     .make = make_cylinder},
    {.name = "paraboloid", .needs = {"radius"}, .radii = 2, .takes = {"direction", "place"},
     .make = make_paraboloid},
    {.name = "cone", .needs = {"slope"}, .takes = {"place"}, .make = make_cone},
    {.name = "punch", .needs = {"radius", "height"}, .radii = 1, .takes = {"edge", "place"},
     .make = make_punch},
    {.name = "wave", .needs = {"amplitude", "wavelength"}, .check = check_wave,
     .make = make_wave},
    {.name = "selfaffine", .needs = {"hurst"},
     .takes = {"rms-slope", "rms-height", "rolloff", "short-cut", "long-cut", "anisotropy",
               "direction", "skewness", "weibull", "seed"},
     .check = check_selfaffine, .make = make_selfaffine},
    {.name = NULL},
};
/* clang-format on */
