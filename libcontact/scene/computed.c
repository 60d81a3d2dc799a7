/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Effects that cost one more contact. */
#include <stdio.h>

#include "parts.h"

/* The change from one contact to another, in area, largest pressure and approach. A node more or less may be
 * due to the tolerance. */
static void
changes(const struct solved *from, const struct solved *to, struct rc_scene_effect *e)
{
    const double node = 1 / (double)from->contact.contact_nodes;
    double change[RC_SCENE_FIGURES];

    scene_changes(from, to, change);
    e->basis = RC_SCENE_COMPUTED;
    scene_set(e, RC_SCENE_AREA, change[RC_SCENE_AREA] - node, change[RC_SCENE_AREA] + node);
    for (int f = RC_SCENE_PRESSURE; f <= RC_SCENE_APPROACH; f++)
        if (rc_there(change[f]))
            scene_set(e, f, change[f], change[f]);
}

static enum rc_status
compute(struct rc_scene *s, const struct rc_problem *problem, struct rc_scene_effect *e,
        struct rc_err *err)
{
    const enum rc_status status =
        scene_solve(s, &(struct asked){.problem = problem}, &s->other, err);

    if (status == RC_SHORT)
        snprintf(e->unfit, sizeof e->unfit, "its contact does not converge");
    if (status == RC_OK)
        changes(&s->now, &s->other, e);
    return status;
}

enum rc_status
scene_patches(struct rc_scene *s, double *largest, double *corrected, struct rc_err *err)
{
    struct rc_patches found = {0};
    const enum rc_status status = rc_patches_find(
        &s->shape, s->now.p,
        &(struct rc_patch_options){
            .boundary = s->problem.boundary, .largest = 1, .threads = s->problem.threads},
        &found, err);

    if (status == RC_OK) {
        *largest = found.count > 0 ? found.patch[0].area : 0;
        if (corrected != NULL)
            *corrected = found.contact_area_corrected;
    }
    rc_patches_free(&found);
    return status;
}

/* The largest pressure on the outermost nodes of a map that ends there. */
static bool
peak_at_edge(const struct rc_scene *s)
{
    const size_t nx = s->shape.nx, ny = s->shape.ny;
    size_t least, most;

    rc_extremes(s->n, s->now.p, &least, &most);
    return (!s->problem.boundary.x && nx > 1 && (most % nx == 0 || most % nx == nx - 1)) ||
           (!s->problem.boundary.y && ny > 1 && (most / nx == 0 || most / nx == ny - 1));
}

/* A finer grid has nearly the area without the steps of this one. Where the same waves had a grid four
 * times as fine, 200 contacts changed by 0.3 to 1 times this correction, to three nodes, and by at most
 * 0.35 times the estimate of the area, 0.09 times that of the pressure, and 0.56 times that of the
 * approach; with other spectra the pressure exceeded its estimate by up to 6 times. At the edge of a
 * map the pressure of a finer grid grows without end. */
enum rc_status
scene_grid(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    const struct rc_discretization *d = &s->now.contact.discretization;
    const double far = 0.01; /* of the load, on the outer 2 % of the map */
    const double nodes = 3 / (double)s->now.contact.contact_nodes;
    double largest, corrected, correction;

    if (scene_patches(s, &largest, &corrected, err) != RC_OK)
        return RC_FAIL;
    correction = 1 - corrected / s->now.contact.contact_area;
    scene_number(e, "area_correction", correction);
    e->basis = RC_SCENE_CALIBRATED;
    if (isnan(d->contact_area))
        snprintf(e->unfit, sizeof e->unfit, "the map is too small for a coarser grid");
    else
        scene_set(e, RC_SCENE_AREA, 0.3 * correction - nodes,
                  fmin(0.6 * d->contact_area, 1.1 * correction + nodes));
    if (peak_at_edge(s) ||
        (rc_repeats(s->problem.boundary) < 2 && s->now.contact.edge_load_fraction > far))
        scene_set(e, RC_SCENE_PRESSURE, 0, INFINITY);
    else if (!isnan(d->max_pressure))
        scene_set(e, RC_SCENE_PRESSURE, 0, fmax(6 * d->max_pressure, 0.02));
    if (!isnan(d->approach))
        scene_set(e, RC_SCENE_APPROACH, 0, d->approach);
    return RC_OK;
}

enum rc_status
scene_tilt(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    struct rc_problem p = s->problem;

    e->basis = RC_SCENE_EXACT;
    if (rc_repeats(p.boundary) > 0 || s->shape.nx == 1 || s->shape.ny == 1)
        return RC_OK; /* it cannot tilt */
    p.tilt_free = true;
    if (compute(s, &p, e, err) == RC_FAIL)
        return RC_FAIL;
    e->change[RC_SCENE_APPROACH] =
        (struct rc_interval){NAN, NAN}; /* it counts from another plane */
    return RC_OK;
}

/* The approach of a thin body is that of its surface; that of a half-space counts from far away. */
enum rc_status
scene_thin(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    struct rc_problem p = s->problem;

    s->thin = (struct rc_layer){s->data.thickness, p.pair.one.e, p.pair.one.nu};
    p.pair.one = (struct rc_body){.e = INFINITY, .layers = 1, .layer = &s->thin};
    return compute(s, &p, e, err);
}

enum rc_status
scene_coat(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    struct rc_problem p = s->problem;

    if (p.pair.one.layers > 0) {
        snprintf(e->unfit, sizeof e->unfit, "body 1 is thin: give its layers to rc-solve");
        return RC_OK;
    }
    p.pair.one.layers = s->data.layers;
    p.pair.one.layer = s->data.layer;
    return compute(s, &p, e, err);
}

/* A pressure that nowhere exceeds the hardness solves the problem with it too, and the solution is unique. */
enum rc_status
scene_hardness(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    const struct rc_contact *c = &s->now.contact;
    const double area = (double)s->n * s->shape.dx * s->shape.dy;
    struct rc_problem p = s->problem;

    scene_number(e, "max_pressure_over_hardness", c->max_pressure / s->data.hardness);
    e->basis = RC_SCENE_EXACT;
    if (!(p.load < s->data.hardness * area)) { /* it does not carry the load */
        for (int f = RC_SCENE_AREA; f <= RC_SCENE_APPROACH; f++)
            scene_set(e, f, INFINITY, INFINITY);
        return RC_OK;
    }
    e->basis = scene_elastic_basis(s);
    if (c->max_pressure <= s->data.hardness)
        return RC_OK;
    p.hardness = s->data.hardness;
    return compute(s, &p, e, err);
}

/* Tractions of partial slip are mu (p(P) - p(P - Q/mu)) in bodies with Poisson's ratio 0 (Ciavarella
 * 1998, Int. J. Solids Struct. 35, 2349; Jaeger 1998, J. Appl. Mech. 65, 1): one more contact, at the
 * load P - Q/mu, has the stick zone and the displacement. Other ratios change the displacement over
 * that of linear theory by up to a fifth of its excess. */
enum rc_status
scene_slip(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    const double part = s->data.tangential / (s->data.mu * s->problem.load), most = 0.01;
    struct rc_problem p = s->problem;
    struct asked asked = {.problem = &p, .h = s->now.shape, .stiffness = s->accepted};
    double stiffness = s->now.stiffness, approach = s->now.contact.approach,
           area = s->now.contact.contact_area, excess, rest;
    enum rc_status status = RC_OK;

    if (s->problem.pair.one.layers > 0) {
        snprintf(e->unfit, sizeof e->unfit, "partial slip is computed for uniform bodies only");
        return RC_OK;
    }
    scene_number(e, "force_over_limit", part);
    e->basis = RC_SCENE_EXACT;
    if (part >= 1) { /* the bodies slide */
        scene_set(e, RC_SCENE_DISPLACEMENT, INFINITY, INFINITY);
        return RC_OK;
    }
    e->basis = RC_SCENE_CALIBRATED;
    if (s->accepted) { /* the dented shape carries its pressure without the hardness */
        p.hardness = 0;
        status = scene_solve(s, &asked, &s->other, err);
        stiffness = s->other.stiffness;
        approach = s->other.contact.approach;
        area = s->other.contact.contact_area;
    }
    p.load *= 1 - part;
    asked.stiffness = false;
    if (status == RC_OK)
        status = scene_solve(s, &asked, &s->other, err);
    if (status == RC_FAIL)
        return RC_FAIL;
    excess = stiffness * (approach - s->other.contact.approach) / (part * s->problem.load) - 1;
    if (status == RC_SHORT || !rc_there(excess)) {
        snprintf(e->unfit, sizeof e->unfit, "%s",
                 status == RC_SHORT ? "its contact does not converge"
                                    : "the stiffness of this contact is unknown");
        return RC_OK;
    }
    rest = fmin(most, 0.5 * excess + 0.0005);
    scene_set(e, RC_SCENE_DISPLACEMENT, s->accepted ? 0 : 0.8 * excess - rest, 1.2 * excess + rest);
    scene_number(e, "stick_fraction", s->other.contact.contact_area / area);
    return RC_OK;
}

/* A contact that only grows under a constant load is elastic with the creep compliance J(t) (Lee and Radok
 * 1960, J. Appl. Mech. 27, 438). Pressures depend on their history. */
enum rc_status
scene_relaxed(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    const struct rc_relaxation *r = s->data.material;
    const struct rc_pair *pair = &s->plain.pair;
    struct rc_problem p = s->plain;
    double one, two, share, softer;
    enum rc_status status = RC_OK;

    if (pair->estar > 0) {
        one = 1 / pair->estar;
        two = 0;
    } else {
        one = (1 - pair->one.nu * pair->one.nu) / pair->one.e;
        two = pair->two.e > 0 ? (1 - pair->two.nu * pair->two.nu) / pair->two.e : 0;
    }
    share = one / (one + two);
    softer = share * rc_relaxation_compliance(r, s->data.time) / r->instant + 1 - share;
    scene_number(e, "compliance_over_instant", softer);
    s->relaxed_modulus = 1 / (softer * (one + two));
    p.pair = (struct rc_pair){.estar = s->relaxed_modulus};
    if (s->relaxed.p == NULL || !s->relaxed.contact.converged)
        status = scene_solve(s, &(struct asked){.problem = &p}, &s->relaxed, err);
    if (status == RC_SHORT)
        snprintf(e->unfit, sizeof e->unfit, "its contact does not converge");
    return status;
}

enum rc_status
scene_relaxation(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    const enum rc_status status = scene_relaxed(s, e, err);

    if (status != RC_OK)
        return status;
    changes(&s->elastic, &s->relaxed, e);
    scene_number(e, "max_pressure", s->relaxed.contact.max_pressure);
    scene_number(e, "max_pressure_over_modulus",
                 s->relaxed.contact.max_pressure / s->relaxed_modulus);
    e->basis = RC_SCENE_CALIBRATED;
    scene_set(e, RC_SCENE_PRESSURE, 0.8 * e->change[RC_SCENE_PRESSURE].low,
              1.35 * e->change[RC_SCENE_PRESSURE].high);
    return RC_OK;
}
