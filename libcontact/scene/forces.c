/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Forces that the elastic contact does not have: the tangential force of rolling, and the pull-off force. */
#include <stdio.h>

#include "libcontact/adhesion/adhesion.h"
#include "parts.h"

/* ---- rolling ---- */

/* New surface comes in at the last column. */
static bool
reaches_last_column(const struct rc_scene *s)
{
    const size_t nx = s->shape.nx;

    for (size_t j = 0; j < s->shape.ny; j++)
        if (s->now.p[j * nx + nx - 1] > 0)
            return true;
    return false;
}

/* N: the sum of the lengths of the tractions. */
static enum rc_status
sum_tractions(const struct rc_scene *s, struct rc_model *m, double *sum, struct rc_err *err)
{
    RC_OWNED double *x = rc_alloc(s->n, sizeof *x);
    RC_OWNED double *y = rc_alloc(s->n, sizeof *y);

    if (x == NULL || y == NULL)
        return rc_err_set(err, "out of memory for tractions");
    if (rc_model_frame(m, "traction-x", x, err) != RC_OK ||
        rc_model_frame(m, "traction-y", y, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < s->n; k++)
        x[k] = hypot(x[k], y[k]);
    *sum = rc_sum(x, s->n) * s->shape.dx * s->shape.dy;
    return RC_OK;
}

/* Bodies that roll freely have no tangential force. Steady rolling is computed under the pressure of the
 * contact, to a lower accuracy: its estimated L1 error of the tractions bounds the error of the force. */
enum rc_status
scene_rolling(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    const struct rc_scene_data *d = &s->data;
    const double load = s->now.contact.load;
    const struct rc_rolling_contact known = {.p = s->now.p};
    const struct rc_rolling_problem law = {.law = {.boundary = s->problem.boundary,
                                                   .pair = s->plain.pair,
                                                   .mu = d->mu,
                                                   .tol = 0.01,
                                                   .threads = s->problem.threads},
                                           .known = &known};
    const struct rc_rolling_figures *f;
    struct rc_point to = {0};
    enum rc_status status;
    double force, error, tractions = 0;

    e->basis = RC_SCENE_COMPUTED;
    if (s->problem.pair.one.layers > 0)
        snprintf(e->unfit, sizeof e->unfit, "rolling is computed for uniform bodies only");
    else if (s->problem.boundary.x || (s->problem.boundary.y && d->spin != 0))
        snprintf(e->unfit, sizeof e->unfit, "steady rolling needs a map that is free along x%s",
                 s->problem.boundary.x ? "" : ", and with a spin along y");
    else if (reaches_last_column(s))
        snprintf(e->unfit, sizeof e->unfit,
                 "the contact reaches the right edge of the map, where new surface comes in");
    if (e->unfit[0] != '\0')
        return RC_OK;
    RC_OWN(rc_model, m) =
        rc_rolling_new(rc_elastic_new(&s->shape, s->h, &s->plain, NULL, err), &law, err);
    rc_point_set(&to, RC_LOAD, load);
    rc_point_set(&to, RC_CREEP_X, d->creep[0]);
    rc_point_set(&to, RC_CREEP_Y, d->creep[1]);
    rc_point_set(&to, RC_SPIN, d->spin);
    status = m == NULL ? RC_FAIL : rc_model_run(m, &to, err);
    if (status == RC_FAIL || rc_model_look(m, NULL, err) == RC_FAIL ||
        sum_tractions(s, m, &tractions, err) != RC_OK)
        return RC_FAIL;
    f = rc_rolling_result(m);
    s->convolutions += f->convolutions;
    if (status == RC_SHORT) {
        snprintf(e->unfit, sizeof e->unfit, "its rolling contact does not converge");
        return RC_OK;
    }
    force = hypot(f->force[0], f->force[1]);
    error = f->traction_error * tractions;
    scene_number(e, "stick_fraction", f->stick_fraction);
    scene_number(e, "force_over_limit", force / f->limit);
    scene_set(e, RC_SCENE_FRICTION, (force - error) / load, fmin(force + error, f->limit) / load);
    return RC_OK;
}

/* ---- pull-off ---- */

/* N: the attraction of the undeformed bodies where they first touch. */
static enum rc_status
rigid_attraction(const struct rc_scene *s, const struct rc_adhesion_problem *problem, double *force,
                 struct rc_err *err)
{
    RC_OWNED double *gap = rc_alloc(s->n, sizeof *gap);
    RC_OWNED double *sigma = rc_alloc(s->n, sizeof *sigma);
    size_t least, most;

    if (gap == NULL || sigma == NULL)
        return rc_err_set(err, "out of memory for an attraction");
    rc_extremes(s->n, s->h, &least, &most);
    for (size_t k = 0; k < s->n; k++)
        gap[k] = s->h[most] - s->h[k];
    if (rc_adhesion_attraction(&s->shape, problem, gap, sigma, err) != RC_OK)
        return RC_FAIL;
    *force = rc_sum(sigma, s->n) * s->shape.dx * s->shape.dy;
    return RC_OK;
}

/* While the bodies are pulled apart all gaps grow, so that the attraction where nothing presses them is at
 * least the pull-off force. From the contact under the load, contacts under the attraction at the gap of the
 * contact before come down to it. The attraction of rigid bodies at first touch is the pull-off force of
 * stiff balls (Bradley 1932, Phil. Mag. 13, 853), and 4/3 of that of soft ones (Johnson, Kendall and Roberts
 * 1971, Proc. R. Soc. A 324, 301). A plane end of the radius a breaks as a crack does, at sqrt(8 l/(pi a))
 * times its attraction, with the cohesive length l. On 137 scenes the pull-off force
 * was 0.80 to 5.5 times the rigid attraction, and 0.13 to 0.99 times the last one. */
enum rc_status
scene_pull_off(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    enum {
        UNDER_LOAD = 2,
        STEPS = 10
    };
    const struct rc_adhesion_problem problem = {
        .contact = s->problem, .work = s->data.work, .law = s->data.law, .range = s->data.range};
    const double load = s->now.contact.load, settled = 0.02;
    struct rc_adhesion_scales scales;
    double rigid = 0, last = INFINITY, attraction = 0, crack;
    enum rc_status status = RC_OK;

    e->basis = RC_SCENE_CALIBRATED;
    if (!scene_adheres(s, &problem, &scales, e))
        return RC_OK;
    if (s->problem.hardness > 0)
        snprintf(e->unfit, sizeof e->unfit,
                 "the dents of a hardness are not those of the undeformed bodies");
    else if (s->shape.nx == 1 || s->shape.ny == 1)
        snprintf(e->unfit, sizeof e->unfit, "the pull-off of a line contact is not estimated");
    if (e->unfit[0] != '\0')
        return RC_OK;
    if (rigid_attraction(s, &problem, &rigid, err) != RC_OK)
        return RC_FAIL;
    for (int k = 0; k < STEPS && status == RC_OK; k++) {
        const double external = k < UNDER_LOAD ? load : 0;
        status = scene_attracted(s, &problem, &scales, k == 0 ? &s->now : &s->other, external,
                                 &attraction, err);
        if (k > UNDER_LOAD && fabs(attraction - last) < settled * attraction)
            break;
        last = attraction;
    }
    if (status == RC_SHORT)
        snprintf(e->unfit, sizeof e->unfit, "its contact does not converge");
    if (status != RC_OK)
        return status;
    crack = sqrt(2 * scales.cohesive_length / sqrt(rigid / scales.strength / RC_PI));
    scene_number(e, "rigid_pull_off_over_load", rigid / load);
    scene_set(e, RC_SCENE_PULL_OFF, 0.7 * fmin(crack, 1) * rigid / load, 1.1 * attraction / load);
    return RC_OK;
}
