/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "physics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the command line ---- */

#define AT(field) .at = offsetof(struct physics, field)
#define ABOVE_0 .min = 0, .max = INFINITY, .above = true
#define ANY .min = -INFINITY, .max = INFINITY
/* clang-format off */
const struct opt physics_options[] = {
    {.name = "load", .type = OPT_NUMBERS, .unit = UNIT_N, AT(load), ANY, .result = true, .points = true,
     .per_metre = true, .arg = "LIST",
     .help = "total normal force, or a list a,b,c, a:b:n or a:b:log:n, each a case"},
    {.name = "mean-pressure", .type = OPT_NUMBERS, .unit = UNIT_PA, AT(mean_pressure), ANY,
     .result = true, .points = true, .arg = "LIST", .help = "load over the area of the map, or a list"},
    {.name = "approach", .type = OPT_NUMBERS, .unit = UNIT_M, AT(approach), ANY,
     .result = true, .points = true, .arg = "LIST",
     .help = "instead of the load: approach of the bodies from first touch, or a list"},
    {.name = "estar", .type = OPT_NUMBER, .unit = UNIT_PA, AT(estar), ABOVE_0, .result = true,
     .arg = "MODULUS", .help = "composite modulus E*, 1/E* = (1-nu1^2)/E1 + (1-nu2^2)/E2"},
    {.name = "E1", .type = OPT_NUMBER, .unit = UNIT_PA, AT(e1), ABOVE_0, .result = true,
     .word = "rigid", .arg = "MODULUS",
     .help = "Young's modulus of body 1, the one that is analysed, or rigid below its layers"},
    {.name = "nu1", .type = OPT_NUMBER, AT(nu1), .min = -1, .max = 0.5, .above = true,
     .result = true, .arg = "RATIO", .help = "Poisson's ratio of body 1"},
    {.name = "E2", .type = OPT_NUMBER, .unit = UNIT_PA, AT(e2), ABOVE_0, .result = true,
     .word = "rigid", .arg = "MODULUS", .help = "Young's modulus of body 2, or rigid"},
    {.name = "nu2", .type = OPT_NUMBER, AT(nu2), .min = -1, .max = 0.5, .above = true,
     .result = true, .arg = "RATIO", .help = "Poisson's ratio of body 2"},
    {.name = "layer", .type = OPT_TEXTS, AT(layer), .result = true, .arg = "T,E,NU[,S]",
     .help = "a layer on body 1: thickness, E, nu, residual stress (for rc-stress); may be repeated, "
             "top first"},
    {.name = "hardness", .type = OPT_NUMBER, .unit = UNIT_HARD, AT(hardness), ABOVE_0,
     .result = true, .arg = "PRESSURE",
     .help = "upper bound of the pressure, where the surface yields; also a Vickers number, as 600HV"},
    {.name = "radius", .type = OPT_NUMBER, .unit = UNIT_M, AT(radius), ABOVE_0, .result = true,
     .arg = "LENGTH", .help = "add a sphere of this composite radius about the origin"},
    {.name = "cylinder", .type = OPT_NUMBER, .unit = UNIT_M, AT(cylinder), ABOVE_0, .result = true,
     .arg = "LENGTH", .against = RULES({.with = "radius"}),
     .help = "add a cylinder of this composite radius about the origin; its axis is along x with "
             "--periodic=x and on a map of one column, else along y"},
    OPT_PERIODIC(offsetof(struct physics, repeats),
                 "the map repeats without end, along both axes or the given one (default: a free "
                 "half-space, loaded on the map only)"),
    OPT_DATUM(offsetof(struct physics, repeats)),
    {.name = NULL},
};
const struct opt history_option[] = {
    {.name = "history", .type = OPT_FLAG, .result = true,
     .help = "apply the loads in sequence, keeping plastic shape; 0 separates the bodies"},
    {.name = NULL},
};
const struct opt tilt_options[] = {
    {.name = "tilt", .type = OPT_CHOICE, .at = offsetof(struct tilt_args, tilt), .result = true,
     .list = (const char *const[]){"fixed", "free", NULL},
     .against = RULES({.with = "periodic", .word = "free", .because = "a periodic map has no centre of tilt"},
                      {.with = "history", .word = "free", .because = "it is not implemented"}),
     .help = "free: the counter body tilts until the moment is zero (default fixed)"},
    {.name = "at", .type = OPT_NUMBERS, .unit = UNIT_M, .at = offsetof(struct tilt_args, at),
     .min = -INFINITY, .max = INFINITY, .result = true, .arg = "X,Y",
     .needs = RULES({.with = "tilt free"}),
     .help = "point where the load acts, with --tilt free (default: the middle)"},
    {.name = NULL},
};
/* clang-format on */

static const char *
name_of_steps(const struct physics *a)
{
    return a->load.n > 0 ? "load" : a->mean_pressure.n > 0 ? "mean-pressure" : "approach";
}

/* A load of 0 separates the bodies, which makes sense only after another load. */
static void
check_steps(struct tool *t, const struct physics *a)
{
    const struct numbers *steps = physics_steps(a);
    const char *name = name_of_steps(a);
    bool rises = true;

    for (size_t k = 0; k < steps->n && !a->pulls; k++) {
        if (steps->v[k] < 0)
            tool_usage(t, "--%s %s %s: it must be at least 0: a negative %s needs --adhesion", name,
                       rc_number(steps->v[k]),
                       steps->per_metre    ? "N/m"
                       : a->load.n > 0     ? "N"
                       : a->approach.n > 0 ? "m"
                                           : "Pa",
                       a->load.n > 0       ? "load"
                       : a->approach.n > 0 ? "approach"
                                           : "mean pressure");
        if (steps->v[k] == 0 && !a->history)
            tool_usage(t, "--%s 0: it must be above 0%s", name,
                       steps->n > 1 ? " (0 separates the bodies only in a --history)" : "");
        rises = rises && (k == 0 || steps->v[k] > steps->v[k - 1]);
    }
    if (!rises && !a->history)
        tool_warn(t,
                  "--%s: the list does not rise, but each value starts from unloaded bodies: for "
                  "loads in sequence add --history",
                  name);
}

static void
check_elasticity(struct tool *t, struct physics *a)
{
    bool rigid = isinf(a->e2), base = isinf(a->e1);
    int bodies = (tool_given(t, "E1") || a->relaxes > 0) + (base || tool_given(t, "nu1")) +
                 tool_given(t, "E2") + tool_given(t, "nu2");

    if (base && a->layer.n == 0)
        tool_usage(t, "--E1 rigid: body 1 must have a --layer");
    if (a->relaxes > 0 && bodies < (rigid ? 3 : 4))
        tool_usage(
            t, "--relaxation has the moduli of body 1: give --nu1, and --E2 --nu2 or --E2 rigid");
    if (tool_given(t, "estar") ? bodies > 0 : bodies < (rigid ? 3 : 4))
        tool_usage(t,
                   "give the elasticity: --estar, or --E1 --nu1 --E2 --nu2, all four (--E2 rigid "
                   "needs no --nu2), or materials by name: --body1 steel --body2 copper");
    if (rigid && tool_given(t, "nu2"))
        tool_warn(t, "--nu2 has no effect beside --E2 rigid: leave it out");
    if (base && tool_given(t, "nu1"))
        tool_warn(t, "--nu1 has no effect beside --E1 rigid: leave it out");
    if (bodies == 0) {
        a->pair.estar = a->surface_estar = a->estar;
        return;
    }
    if (a->relaxes > 0 && !base)
        a->e1 = a->relaxes;
    a->pair.one = (struct rc_body){.e = a->e1, .nu = base ? 0 : a->nu1};
    if (!rigid)
        a->pair.two = (struct rc_body){.e = a->e2, .nu = a->nu2};
    a->surface_estar = 1 / (bodies_compliance(a->e1, a->nu1) + bodies_compliance(a->e2, a->nu2));
}

/* Warns of a residual stress outside the range from a millionth of the modulus to the modulus. */
static void
warn_of_residual(struct tool *t, const char *layer, double stress, double e)
{
    const double least = 1e-6;

    if (stress != 0 && (fabs(stress) < least * e || fabs(stress) > e))
        tool_warn(t,
                  "--layer %s: the residual stress, %s, is %s of the layer: is its unit right, as "
                  "in -3GPa?",
                  layer, shown_in_unit(stress, "Pa"),
                  fabs(stress) > e ? "above the modulus" : "below a millionth of the modulus");
}

/* Checks the layers of body 1, which the history lists in SI. */
static void
check_layers(struct tool *t, struct physics *a)
{
    size_t n = a->layer.n;
    char *si;
    bool stressed = false, relaxes;

    if (n == 0)
        return;
    if (tool_given(t, "estar"))
        tool_usage(
            t, "--layer needs a substrate and a body 2: give --E1 --nu1 and --E2 --nu2 (or --E2 "
               "rigid), not --estar");
    a->layers = tool_room(t, n, sizeof *a->layers, "the layers of a body");
    a->residual = tool_room(t, n, sizeof *a->residual, "the layers of a body");
    for (size_t k = 0; k < n; k++) {
        struct rc_layer *m = &a->layers[k];
        if (layer_read(a->layer.step[k].text, m, &a->residual[k], a->relaxes, &relaxes, &t->err) !=
            RC_OK)
            tool_usage(t, "--layer %s: %s", a->layer.step[k].text, t->err.text);
        warn_of_residual(t, a->layer.step[k].text, a->residual[k], m->e);
        si = tool_room(t, 4, RC_NUMBER_SIZE, "the layers of a body");
        snprintf(si, 4 * RC_NUMBER_SIZE, "%s,%s,%s%s%s", rc_number(m->thickness),
                 relaxes ? LAYER_RELAXES : rc_number(m->e), rc_number(m->nu),
                 a->residual[k] == 0 ? "" : ",",
                 a->residual[k] == 0 ? "" : rc_number(a->residual[k]));
        a->layer.step[k].text = si;
        a->relaxing_layers += relaxes;
        stressed = stressed || a->residual[k] != 0;
    }
    if (!stressed) {
        free(a->residual);
        a->residual = NULL;
    }
    a->pair.one.layers = n;
    a->pair.one.layer = a->layers;
    a->surface_estar =
        1 / (bodies_compliance(a->layers[0].e, a->layers[0].nu) + bodies_compliance(a->e2, a->nu2));
}

static void
say_vickers(struct tool *t, const struct physics *a)
{
    if (t->vickers != NULL)
        tool_warn(t,
                  "--hardness %s is %s: the mean pressure on the plane of the dent, HV times "
                  "9.80665 MPa over sin 68 deg",
                  t->vickers, shown_in_unit(a->hardness, "Pa"));
}

void
physics_check(struct tool *t, struct physics *a)
{
    if (tool_given(t, "load") + tool_given(t, "mean-pressure") + tool_given(t, "approach") != 1)
        tool_usage(t, "give one of --load, --mean-pressure and --approach");
    check_steps(t, a);
    check_elasticity(t, a);
    check_layers(t, a);
    say_vickers(t, a);
    a->boundary = boundary_asked(&a->repeats);
}

const struct numbers *
physics_steps(const struct physics *a)
{
    return a->load.n > 0 ? &a->load : a->mean_pressure.n > 0 ? &a->mean_pressure : &a->approach;
}

/* ---- a height map ---- */

/* True if a sphere or a cylinder is added. */
static bool
adds_form(const struct physics *a)
{
    return !isnan(a->radius) || !isnan(a->cylinder);
}

enum rc_map_axis
physics_cylinder_axis(const struct physics *a, const struct rc_grid *g)
{
    return rc_repeats(a->boundary) == 1 ? (a->boundary.x ? RC_X : RC_Y) : g->nx == 1 ? RC_X : RC_Y;
}

/* Adds the sum of two parabolas, one along x and one along y; a radius of infinity adds nothing. */
static void
add_parabolas(struct tool *t, double radius_x, double radius_y, struct rc_grid *g)
{
    struct rc_shape along = {g->nx, 1, g->dx, g->dy}, across = {1, g->ny, g->dx, g->dy};
    double *row = tool_room(t, g->nx + g->ny, sizeof *row, "a sphere"), *column;
    size_t first = tool_first_row(t, g);

    column = row + g->nx;
    rc_synth_sphere(&along, radius_x, row);
    rc_synth_sphere(&across, radius_y, column);
    for (size_t j = 0; j < g->ny - g->elsewhere; j++)
        for (size_t i = 0; i < g->nx; i++)
            g->v[j * g->nx + i] += row[i] + column[first + j];
    free(row);
}

/* True if the sphere of the key is as good as flat beside a sphere or cylinder of this radius. */
static bool
is_flat(const char *form, double radius)
{
    const double flat = 1e3; /* times this radius: their sum has its curvature to 0.1 % */
    double is;
    struct rc_err err;

    return strncmp(form, "sphere ", 7) == 0 && unit_number(form + 7, UNIT_M, &is, &err) == RC_OK &&
           is >= flat * radius;
}

/* An added form is named in the header, so that it is not added twice. The form of a body that travels is not
 * in the heights of body 1, which may have their own. */
static void
add_form(struct tool *t, const struct physics *a, struct rc_grid *g)
{
    const char *form = rc_grid_get(g, "form");
    const bool sphere = !isnan(a->radius);
    const bool turned = !sphere && physics_cylinder_axis(a, g) == RC_X;
    const double radius = sphere ? a->radius : a->cylinder;
    const char *word = sphere ? "sphere" : "cylinder";
    char name[2 * RC_NUMBER_SIZE + 32];

    if (form != NULL && !a->travels && !is_flat(form, radius))
        tool_refuse(t, g, "a %.*s was already added to these heights (form=%s): remove --%s",
                    (int)strcspn(form, " "), form, form, sphere ? "radius" : "cylinder");
    if (!a->travels)
        add_parabolas(t, turned ? INFINITY : radius, sphere || turned ? radius : INFINITY, g);
    if (form != NULL && a->travels)
        snprintf(name, sizeof name, "%.*s + %s %s", RC_NUMBER_SIZE + 10, form, word,
                 rc_number(radius));
    else
        snprintf(name, sizeof name, "%s %s", word, rc_number(radius));
    tool_set(t, g, "form", name);
}

/* Least squares of h = c + a_x x + a_y y - x^2/(2 R_x) - y^2/(2 R_y) on the whole map: on a regular grid
 * about its middle the terms are orthogonal, when their means are subtracted. */
struct paraboloid {
    double mean, slope[2], curvature[2]; /* of rows along x, and of columns along y */
};

/* The position of node k of n, from the middle; and its square less the mean square. */
static double
from_middle(size_t k, size_t n, double d)
{
    return ((double)k - 0.5 * (double)(n - 1)) * d;
}

static double
bow(size_t k, size_t n, double d)
{
    const double x = from_middle(k, n, d);

    return x * x - ((double)n * (double)n - 1) / 12 * d * d;
}

static struct paraboloid
fit_paraboloid(struct tool *t, const struct rc_grid *g)
{
    const size_t first = tool_first_row(t, g), rows = g->ny - g->elsewhere;
    struct paraboloid fit = {0};
    double squares[2][2] = {{0}}, sum[5] = {0};

    for (size_t i = 0; i < g->nx; i++) {
        squares[0][0] += (double)g->ny * pow(from_middle(i, g->nx, g->dx), 2);
        squares[0][1] += (double)g->ny * pow(bow(i, g->nx, g->dx), 2);
    }
    for (size_t j = 0; j < g->ny; j++) {
        squares[1][0] += (double)g->nx * pow(from_middle(j, g->ny, g->dy), 2);
        squares[1][1] += (double)g->nx * pow(bow(j, g->ny, g->dy), 2);
    }
    for (size_t j = 0; j < rows; j++)
        for (size_t i = 0; i < g->nx; i++) {
            const double h = g->v[j * g->nx + i];
            sum[0] += h;
            sum[1] += h * from_middle(i, g->nx, g->dx);
            sum[2] += h * from_middle(first + j, g->ny, g->dy);
            sum[3] += h * bow(i, g->nx, g->dx);
            sum[4] += h * bow(first + j, g->ny, g->dy);
        }
    for (size_t k = 0; k < 5; k++)
        sum[k] = ranks_sum(t, sum[k]);
    fit.mean = sum[0] / ((double)g->nx * (double)g->ny);
    for (size_t side = 0; side < 2; side++) {
        fit.slope[side] = sum[1 + side] / squares[side][0];
        fit.curvature[side] = -2 * sum[3 + side] / squares[side][1];
    }
    return fit;
}

struct ball
physics_ball(struct tool *t, const struct physics *a, const struct rc_grid *g)
{
    const double near = 0.1; /* of the curvature; the theories' pull-off is as uncertain */
    const char *form = rc_grid_get(g, "form");
    const size_t first = tool_first_row(t, g);
    struct ball b = {.radius = a->radius, .along = {NAN, NAN}};
    struct paraboloid is;
    struct rc_err err;
    double radius;

    if (!isnan(a->radius) || form == NULL || strncmp(form, "sphere ", 7) != 0 || g->nx < 3 ||
        g->ny < 3 || unit_number(form + 7, UNIT_M, &radius, &err) != RC_OK)
        return b;
    is = fit_paraboloid(t, g);
    for (size_t side = 0; side < 2; side++)
        b.along[side] = 1 / is.curvature[side];
    if (!(fabs(is.curvature[0] * radius - 1) <= near && fabs(is.curvature[1] * radius - 1) <= near))
        return b;
    for (size_t j = 0; j < g->ny - g->elsewhere; j++)
        for (size_t i = 0; i < g->nx; i++) {
            const double x = from_middle(i, g->nx, g->dx);
            const double y = from_middle(first + j, g->ny, g->dy);
            const double bows = bow(i, g->nx, g->dx) + bow(first + j, g->ny, g->dy);
            const double ball = is.mean + is.slope[0] * x + is.slope[1] * y - bows / (2 * radius);
            b.off = fmax(b.off, fabs(g->v[j * g->nx + i] - ball));
        }
    b.off = ranks_most(t, b.off);
    b.radius = radius;
    return b;
}

/* Warns of a periodic map whose opposite edges do not meet: the step there would carry much of the load. */
static void
warn_of_seam(struct tool *t, const struct physics *a, const struct rc_grid *g)
{
    static const char *const line[] = {"column", "row"};
    const bool one = rc_repeats(a->boundary) == 1;
    struct rc_seam seam;

    rc_measure_seam(ranks_of(t), rc_shape_of(g), g->v, &seam);
    for (int side = 0; side < 2; side++)
        if (rc_wraps(a->boundary, side == 0 ? RC_X : RC_Y) &&
            seam.across[side] > 3 * seam.inside[side])
            tool_warn(t,
                      "%s: the edges do not meet: from the last %s to the first the heights jump "
                      "by %s (RMS), %.3g times the steps inside: rc-detrend --plane removes a "
                      "tilt, --mirror%s makes a periodic map of %s the area from mirror images; or "
                      "solve it without --periodic",
                      tool_where(t, g), line[side], shown_in_unit(seam.across[side], "m"),
                      seam.across[side] / seam.inside[side],
                      !one        ? ""
                      : side == 0 ? "=x"
                                  : "=y",
                      !one && g->nx > 1 && g->ny > 1 ? "4 times" : "twice");
}

double
physics_width(const struct physics *a, const struct rc_grid *g)
{
    if (rc_repeats(a->boundary) == 1)
        return a->boundary.x ? (double)g->nx * g->dx : (double)g->ny * g->dy;
    return g->ny == 1 ? g->dy : g->dx;
}

static void
check_profile(struct tool *t, const struct physics *a, const struct rc_grid *g)
{
    const char *where = tool_where(t, g), *width = shown_in_unit(physics_width(a, g), "m");

    if (a->load.per_metre && g->nx > 1 && g->ny > 1 && rc_repeats(a->boundary) != 1)
        tool_refuse(
            t, g,
            "--load in N/m is for profiles and for maps that repeat along one axis, and this map "
            "has %zu rows: give the whole force, in N",
            g->ny);
    if ((g->nx > 1) == (g->ny > 1))
        return;
    if (!rc_wraps(a->boundary, g->ny == 1 ? RC_Y : RC_X))
        tool_warn(t, "%s: a profile is solved as a strip %s wide%s, not as an infinite ridge",
                  where, width, a->load.n > 0 ? ", which carries the force" : "");
    else if (a->load.n > 0 && !a->load.per_metre)
        tool_warn(t,
                  "%s: the force on this profile acts on a width of %s: give --load in N/m to be "
                  "independent of the width",
                  where, width);
}

/* Warns of plain numbers, which are in metres, if micrometres or millimetres were probably meant. */
static void
warn_of_metres(struct tool *t, const struct physics *a, const struct rc_grid *g, const char *where)
{
    const double width = fmax((double)g->nx * g->dx, (double)g->ny * g->dy);
    const double thick = 0.1, wide = 0.5; /* m: limits for a layer and for a radius */
    const double radius = isnan(a->radius) ? a->cylinder : a->radius;
    char map[SHOWN_NUMBER];

    shown_in_unit_to(map, width, "m");
    for (size_t k = 0; k < a->layer.n; k++)
        if (a->layers[k].thickness >= thick && a->layers[k].thickness > 100 * width)
            tool_warn(t,
                      "%s: --layer: a thickness of %s on a map %s wide: a number without a unit is "
                      "in metres, write %sum for micrometres",
                      where, shown_in_unit(a->layers[k].thickness, "m"), map,
                      rc_number(a->layers[k].thickness));
    if (radius >= wide && radius > 1000 * width)
        tool_warn(t,
                  "%s: --%s: a radius of %s on a map %s wide: a number without a unit is in "
                  "metres, write %smm for millimetres",
                  where, isnan(a->radius) ? "cylinder" : "radius", shown_in_unit(radius, "m"), map,
                  rc_number(radius));
}

/* Warns of a tip that lies between the nodes. */
static void
warn_of_tip(struct tool *t, const struct physics *a, const struct rc_grid *g, const char *where)
{
    const double spacing = fmax(g->nx > 1 ? g->dx : 0, g->ny > 1 ? g->dy : 0);

    if (a->radius < spacing)
        tool_warn(t,
                  "%s: --radius: a radius of %s is smaller than the spacing of the nodes, %s: the "
                  "grid does not resolve this tip: take a finer grid",
                  where, shown_in_unit(a->radius, "m"), shown_in_unit(spacing, "m"));
}

static void
warn(struct tool *t, const struct physics *a, const struct rc_grid *g)
{
    const char *where = tool_where(t, g);
    struct rc_boundary surface = map_repeats(g);

    if (adds_form(a)) { /* a form repeats along the axis of a cylinder only */
        surface.x = surface.x && isnan(a->radius) && physics_cylinder_axis(a, g) == RC_X;
        surface.y = surface.y && isnan(a->radius) && physics_cylinder_axis(a, g) == RC_Y;
    }
    warn_of_metres(t, a, g, where);
    warn_of_tip(t, a, g, where);
    if (rc_repeats(a->boundary) == 0 && rc_repeats(surface) > 0)
        tool_warn(t,
                  "%s: the surface is periodic%s, but the solution has no material beyond the "
                  "map: for a periodic solution add --periodic%s",
                  where,
                  rc_repeats(surface) == 2 ? ""
                  : surface.x              ? " along x"
                                           : " along y",
                  rc_repeats(surface) == 2 ? ""
                  : surface.x              ? "=x"
                                           : "=y");
    if (rc_repeats(a->boundary) > 0)
        warn_of_seam(t, a, g);
}

void
physics_heights(struct tool *t, const struct physics *a, struct rc_grid *g)
{
    if (strcmp(g->unit, "m") != 0)
        tool_refuse(t, g,
                    "its unit is '%s': heights are in metres; import the file again with --z-unit",
                    g->unit);
    if (adds_form(a))
        add_form(t, a, g);
    if (t->input.missing || t->input.infinite ||
        adds_form(a)) /* a frame that was read, or the form */
        tool_demand_finite(t, g, "fill them with rc-detrend --fill");
    check_profile(t, a, g);
    warn(t, a, g);
}

void
physics_hardness(struct tool *t, const struct rc_grid *hardness)
{
    if (hardness == NULL)
        return;
    if (tool_given(t, "hardness"))
        tool_refuse(
            t, hardness,
            "the case holds a map of hardness, and --hardness gives a number: leave one out");
    if (strcmp(hardness->unit, "Pa") != 0)
        tool_refuse(t, hardness, "its unit is '%s': a hardness is in pascals", hardness->unit);
}

struct rc_problem
physics_problem(const struct physics *a, const struct rc_grid *g, size_t step)
{
    double number = physics_steps(a)->v[step] * (a->load.per_metre ? physics_width(a, g) : 1);
    double area = g->dx * g->dy * (double)(g->nx * g->ny);

    return (struct rc_problem){
        .boundary = a->boundary,
        .pair = a->pair,
        .load = a->load.n > 0            ? number
                : a->mean_pressure.n > 0 ? number * area
                                         : 0,
        .approach = a->approach.n > 0 ? number : 0,
        .hardness = a->hardness,
    };
}

/* ---- a rough body 2 ---- */

struct rc_grid *
physics_counter(struct tool *t, const char *name)
{
    struct rc_grid *g = tool_frame_of_file(t, "counter", name, "height");

    if (strcmp(g->unit, "m") != 0)
        tool_die(
            t,
            "--counter %s: its unit is '%s': heights are in metres; import the file again with "
            "--z-unit",
            name, g->unit);
    tool_demand_finite(t, g, "fill them with rc-detrend --fill");
    rc_mirror(&(struct rc_shape){g->nx, g->ny - g->elsewhere, g->dx, g->dy}, 'x', g->v);
    return g;
}

void
physics_counter_beside(struct tool *t, const char *name, const struct rc_grid *other,
                       const struct rc_grid *g, struct rc_boundary boundary)
{
    const double near = 1e-6;

    if (fabs(other->dx / g->dx - 1) > near || fabs(other->dy / g->dy - 1) > near)
        tool_refuse(
            t, g,
            "spacings of %g x %g m, and of %g x %g m in --counter %s: bring them together by "
            "rc-pick --resample",
            g->dx, g->dy, other->dx, other->dy, name);
    if ((boundary.x && other->nx != g->nx) || (boundary.y && other->ny != g->ny))
        tool_refuse(
            t, g,
            "both surfaces must have the same period: this one has %zu x %zu nodes, --counter %s "
            "has %zu x %zu",
            g->nx, g->ny, name, other->nx, other->ny);
}
