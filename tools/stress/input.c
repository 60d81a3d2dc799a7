/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pressure, tractions and body of a case, from the stream and the options that rc-stress and rc-fatigue
 * share. */
#include "stress.h"

#include <math.h>
#include <string.h>

#define AT(field) .at = offsetof(struct stress_asked, field)
/* clang-format off */
const struct opt stress_body_options[] = {
    {.name = "nu", .type = OPT_NUMBER, AT(nu), .min = -1, .max = 0.5, .above = true,
     .result = true, .arg = "RATIO", .help = "Poisson's ratio (default: the stream's own)"},
    {.name = "mu", .type = OPT_NUMBER, AT(mu), .min = -10, .max = 10, .result = true,
     .arg = "COEFFICIENT", .help = "the surface also carries mu times the pressure along +x"},
    {.name = NULL},
};
const struct opt stress_sum_options[] = {
    OPT_PERIODIC(offsetof(struct stress_asked, repeats),
                 "the map repeats without end, along both axes or the given one (default: the "
                 "stream's boundary, else free)"),
    {.name = "kernel", .alias = "engine", .type = OPT_CHOICE, AT(kernel),
     .words = words_stress_engine_or_auto, .help = "engine that sums stresses (default auto)"},
    {.name = "tol", .type = OPT_NUMBER, AT(tol), .min = 0, .max = 1, .above = true,
     .result = true, .arg = "ERROR",
     .help = "permitted error of a component, over the largest pressure (default: rounding; "
             "rc-fatigue 1e-5)"},
    {.name = NULL},
};
/* clang-format on */

bool
stress_on_free_maps_only(const char *kernel)
{
    const struct rc_engine_info *engine = words_engine_named(kernel);

    return engine != NULL && !engine->periodic;
}

/* ---- a case ---- */

static double
poisson(struct tool *t, const struct stress_asked *asked, const struct rc_grid *p)
{
    double nu;

    if (!isnan(asked->nu))
        return asked->nu;
    if (!rc_grid_number(p, "nu", &nu))
        tool_die_at(t, p, EXIT_USAGE, "Poisson's ratio is not in the stream: give it with --nu");
    return nu;
}

/* Refuses --nu for a coated body, whose materials have their own Poisson's ratios. */
static void
set_material(struct tool *t, const struct stress_asked *asked, const struct rc_grid *p,
             struct stress_input *in, struct rc_stress_options *o)
{
    tool_must(t, p, layers_read(p, &in->layers, &t->err));
    if (in->layers.text != NULL && !isnan(asked->nu))
        tool_refuse(t, p,
                    "its body is coated and each material has its own Poisson's ratio: --nu "
                    "contradicts its layers, leave it out");
    if (in->layers.text != NULL)
        bodies_demand_elastic(t, p, "stresses in a coat that relaxes are not implemented");
    o->body = in->layers.body;
    o->residual = in->layers.residual;
    if (in->layers.text == NULL)
        o->body.nu = poisson(t, asked, p);
}

/* Refuses --mu for a pressure with tension, because mu times a tension would be friction in the wrong
 * direction. */
static void
refuse_adhesion(struct tool *t, const struct rc_grid *p, double mu)
{
    size_t pulled = 0;

    for (size_t k = 0; k < rc_grid_nodes(p); k++)
        pulled += p->v[k] < 0;
    pulled = (size_t)ranks_sum(t, (double)pulled);
    if (pulled > 0 && rc_grid_get(p, "adhesion") != NULL)
        tool_refuse(
            t, p,
            "it is the net pressure of bodies that attract each other, negative at %zu of %zu "
            "nodes, where --mu %g would turn friction round: leave out --mu",
            pulled, p->nx * p->ny, mu);
}

/* The solution with plastic strain did not include tractions: with their stress added, Mises stresses may
 * exceed the yield stress. */
static void
warn_of_yield(struct tool *t, const struct rc_grid *p, double mu)
{
    double yield;

    if (!rc_grid_number(p, "yield", &yield))
        return;
    tool_warn(t,
              "%s: the body has yielded under the pressure alone, and friction was not part of "
              "that solution: it is added elastically, and Mises stresses may exceed the yield "
              "stress, %s: leave out %s, or take the stresses as those of a body that yields no "
              "further",
              tool_where(t, p), shown_in_unit(yield, "Pa"),
              mu != 0 ? "--mu" : "the frames of traction");
}

/* A map without a solver is taken as exact. A solver that leaves out the key does not know its error, and the
 * part of a map may hold most of it. */
static double
error_of(const struct rc_grid *g, const char *key)
{
    double error;

    if (rc_grid_number(g, key, &error))
        return error;
    return rc_grid_get(g, "converged") == NULL ? 0 : NAN;
}

/* Frames of traction replace --mu. */
static void
set_traction(struct tool *t, const struct stress_asked *asked, const struct rc_grid *p,
             struct stress_input *in, struct rc_stress_options *o)
{
    if (asked->mu != 0)
        refuse_adhesion(t, p, asked->mu);
    for (size_t k = 0; k < 2; k++) {
        const struct rc_grid *g = in->traction[k];
        o->traction[k] = NULL;
        if (g == NULL || asked->residual)
            continue;
        if (tool_given(t, "mu"))
            tool_refuse(t, g,
                        "the case has its own traction, and --mu %g contradicts it: leave it out, "
                        "or take the pressure alone, rc-pick --channel pressure",
                        asked->mu);
        tool_demand_grid_of(t, g, p);
        tool_demand_finite(t, g, "recompute the map");
        o->traction[k] = g->v;
        o->traction_error = error_of(g, "traction.error");
    }
    if (!asked->residual && (asked->mu != 0 || o->traction[0] != NULL || o->traction[1] != NULL))
        warn_of_yield(t, p, asked->mu);
}

void
stress_input_read(struct tool *t, const struct rc_grid *p, const struct stress_asked *asked,
                  struct stress_input *in, struct rc_stress_options *o)
{
    char list[128];

    o->boundary = contact_boundary(t, p, &asked->repeats);
    set_material(t, asked, p, in, o);
    o->mu = asked->mu;
    o->engine = asked->kernel;
    o->tol = isnan(asked->tol) ? 0 : asked->tol;
    o->threads = t->threads;
    o->ranks = ranks_of(t);
    o->pressure_error = error_of(p, "pressure.error");
    o->traction_error = 0;
    o->strain = NULL;
    set_traction(t, asked, p, in, o);
    if (rc_repeats(o->boundary) > 0 && stress_on_free_maps_only(asked->kernel))
        tool_refuse(t, p, "its boundary is %s, where only %s sums: leave out --kernel %s",
                    rc_boundary_word(o->boundary), words_periodic_engines(list, sizeof list),
                    asked->kernel);
}

bool
stress_input_take(struct tool *t, const struct rc_grid *p, struct rc_grid *g,
                  struct stress_input *in)
{
    struct tool_frame tractions[] = {
        {"traction-x", &in->traction[0]}, {"traction-y", &in->traction[1]}, {NULL, NULL}};

    return tool_take_frames(tractions, t, p, g);
}

void
stress_input_free(struct stress_input *in)
{
    layers_free(&in->layers);
    for (size_t k = 0; k < 2; k++) {
        rc_grid_free(in->traction[k]);
        in->traction[k] = NULL;
    }
}

/* ---- depths ---- */

/* Refuses depths inside a rigid substrate, where stresses are undefined. */
static void
refuse_rigid(struct tool *t, const struct rc_grid *p, const struct rc_body *body,
             const struct numbers *depths)
{
    for (size_t k = 0; isinf(body->e) && k < depths->n; k++)
        if (rc_body_material(body, depths->v[k]) == body->layers)
            tool_refuse(t, p,
                        "depth %g m is inside its rigid substrate, where stresses are unknown: "
                        "give depths down to its face",
                        depths->v[k]);
}

/* Warns of depths far below the contact: a plain number is in metres, and may have been meant in
 * micrometres. */
static void
warn_of_depths(struct tool *t, const struct rc_grid *p, const struct numbers *depths)
{
    enum {
        FAR = 10 /* depth in widths of the map, at which at most 0.5 % of the mean pressure is
                    left, or 7 % of that of a line */
    };
    double width = fmax((double)p->nx * p->dx, (double)p->ny * p->dy), deepest = 0;
    char depth[RC_NUMBER_SIZE];

    for (size_t k = 0; k < depths->n; k++)
        deepest = fmax(deepest, depths->v[k]);
    if (deepest > FAR * width)
        tool_warn(t,
                  "%s: --depths: %s m is %.2g times the width of the map, %g m, and stresses there "
                  "depend on the load alone: a number without a unit is in metres, write %sum for "
                  "micrometres",
                  tool_where(t, p), rc_number_text(depth, deepest), deepest / width, width, depth);
}

void
stress_depths_read(struct tool *t, const struct rc_grid *p, struct rc_stress_options *o,
                   struct numbers *depths)
{
    const bool automatic = depths->n == 0;

    warn_of_depths(t, p, depths);
    if (automatic && rc_stress_depths(o->ranks, rc_shape_of(p), p->v, o->boundary, &o->body,
                                      &depths->v, &depths->n, &t->err) != RC_OK)
        tool_refuse(t, p, "%s", t->err.text);
    refuse_rigid(t, p, &o->body, depths);
    if (automatic)
        tool_note(t, "%zu depths, down to %g m", depths->n, depths->v[depths->n - 1]);
    o->depth = depths->v;
    o->depths = depths->n;
}

/* ---- memory ---- */

/* True if the engine transforms: it has a form in single precision. "auto" is such a one. */
static bool
transforms(const char *engine)
{
    const struct rc_engine_info *e = engine == NULL ? NULL : words_engine_named(engine);

    return e == NULL || e->mixed || e->precise;
}

/* Bytes of a node: of a free map, of one that repeats along x, along y, along both. */
static double
by(const struct rc_stress_options *o, const double bytes[4])
{
    return bytes[(o->boundary.x ? 1 : 0) + (o->boundary.y ? 2 : 0)];
}

size_t
stress_plan_bytes(const struct rc_grid *p, const struct rc_stress_options *o, size_t components)
{
    /* double and single precision */
    static const double fft[2][4] = {{50, 29, 37, 20.3}, {27, 20.5, 23.5, 12.4}};
    static const double second[] = {17, 10, 16.5, 8.3}; /* two components together, double */
    static const double kernel[] = {8, 4, 4, 0};        /* work of each component and load */
    static const double traction[] = {29, 16, 16, 8}, slab[] = {279, 0, 0, 71};
    static const double section = 26, direct = 16; /* work on any boundary */
    const int single = o->tol >= RC_SINGLE_FLOOR;
    const int tractions = (o->traction[0] != NULL) + (o->traction[1] != NULL);
    const int loads = 1 + (o->mu != 0) + tractions;
    const struct rc_shape shape = rc_grid_shape(p);
    const double coarser = rc_stress_coarser(&shape, o); /* with fields and rows of the transfer */
    double bytes = o->strain != NULL ? by(o, slab) * (double)o->strain->slabs : 0;

    if (o->section != 0)
        bytes += section;
    else if (!transforms(o->engine))
        bytes += direct;
    else
        bytes +=
            8 * sqrt(coarser) + 16 * coarser +
            (1 + coarser) * (by(o, fft[single]) + by(o, kernel) * (double)components * loads +
                             ((components > 1 ? by(o, second) : 0) + by(o, traction) * tractions) /
                                 (single ? 2 : 1));
    return (size_t)(bytes * (double)rc_grid_nodes(p));
}
