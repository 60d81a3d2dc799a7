/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Limits that the contact exceeds or not: fatigue, and a way through the gap. */
#include <stdio.h>

#include "parts.h"

/* The contact passes along x. The index at the depth of the largest Mises stress, at least the distance
 * of the states, is a lower bound. The deviators of a history lie in a ball about 0 with the radius of
 * the largest sqrt(J2), mises/sqrt(3), so that neither the amplitude of Crossland nor the shear stress
 * of Dang Van exceeds it; without friction there is no hydrostatic tension. */
enum rc_status
scene_fatigue(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    const struct rc_fatigue_limits limits = {.bending = s->data.bending,
                                             .torsion = s->data.torsion};
    const double *none[RC_COMPONENTS] = {NULL}, *p = s->now.p, more = 1.3;
    struct rc_fatigue_problem problem = {.stress = {.boundary = s->problem.boundary,
                                                    .body = s->plain.pair.one,
                                                    .threads = s->problem.threads},
                                         .wanted = 1U << RC_CROSSLAND | 1U << RC_DANG_VAN,
                                         .pass = 'x',
                                         .cases = 1};
    double *out[RC_FATIGUES] = {NULL};
    const struct rc_fatigue_figures *found;
    struct rc_err why;
    double mises, depth, index;

    problem.p = &p;
    e->basis = RC_SCENE_CALIBRATED;
    if (s->problem.pair.one.layers > 0) {
        snprintf(e->unfit, sizeof e->unfit,
                 "layers have their own limits: give them to rc-fatigue");
        return RC_OK;
    }
    if (rc_fatigue_check_limits(problem.wanted, &limits, &why) != RC_OK) {
        snprintf(e->unfit, sizeof e->unfit, "%.150s", why.text);
        return RC_OK;
    }
    if (scene_mises(s, p, &mises, &depth, err) != RC_OK)
        return RC_FAIL;
    depth = fmax(depth, s->shape.dx); /* above, the states of a history are too far apart */
    RC_OWN(rc_fatigue, fatigue) = rc_fatigue_new(&s->shape, &problem, err);
    if (fatigue == NULL || rc_fatigue_depth(fatigue, depth, &limits, none, out, err) != RC_OK)
        return RC_FAIL;
    found = rc_fatigue_result(fatigue);
    index = fmax(found->largest[RC_CROSSLAND].value, found->largest[RC_DANG_VAN].value);
    scene_number(e, "mises", mises);
    scene_number(e, "depth", depth);
    scene_set(e, RC_SCENE_FATIGUE, 0.98 * index,
              fmin(more * index, 1.05 * mises / (sqrt(3) * limits.torsion)));
    return RC_OK;
}

/* An elastic contact of an isotropic surface closes near 42 % of the area (Dapp, Luecke, Persson and Mueser
 * 2012, Phys. Rev. Lett. 108, 244301). In 200 contacts a grid four times as fine closed or opened two, at
 * 45 to 50 %. A way through corners of cells alone decides nothing. A viscoelastic body closes the gap as it
 * creeps: its contact is that of the time asked for. Beside a coat or a hardness that is not computed, and
 * the contact is the one at once. */
enum rc_status
scene_leak(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    const struct rc_boundary *b = &s->problem.boundary;
    const struct rc_leak_options options = {
        .direction = 'x', .around = b->y, .threads = s->problem.threads};
    const bool creeps = s->data.material != NULL && s->data.time > 0 && !s->accepted;
    const struct solved *contact = creeps ? &s->relaxed : &s->now;
    const double least = 0.42, most = 0.53;
    const struct rc_leak_figures *found;
    double fraction;
    bool near;

    e->basis = RC_SCENE_CALIBRATED;
    if (creeps) {
        const enum rc_status status = scene_relaxed(s, e, err);
        if (status != RC_OK)
            return status;
    }
    fraction = contact->contact.contact_fraction;
    e->nodes = contact->contact.contact_nodes;
    if (s->data.material != NULL)
        scene_number(e, "time", creeps ? s->data.time : 0);
    RC_OWN(rc_leak, leak) = rc_leak_new(&s->shape, contact->p, contact->gap, &options, err);
    if (leak == NULL)
        return RC_FAIL;
    found = rc_leak_result(leak);
    scene_number(e, "contact_fraction", fraction);
    scene_number(e, "critical_gap", found->critical_gap);
    near =
        (fraction > least && fraction < most) || (found->percolates_diagonal && !found->percolates);
    scene_set(e, RC_SCENE_LEAK, found->percolates && !near, found->percolates || near);
    return RC_OK;
}
