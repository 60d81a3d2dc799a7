/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of effects, the contact from which they are estimated, and verdicts. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "parts.h"

static const struct scene_row rows[] = {
    {"grid", "finer grid", "", false, scene_grid},
    {"tilt", "free tilt", "", false, scene_tilt},
    {"thin", "thin body", "thickness E1", true, scene_thin},
    {"coat", "coat", "layer E1", true, scene_coat},
    {"hardness", "hardness", "hardness", true, scene_hardness},
    {"slip", "partial slip", "mu tangential", false, scene_slip},
    {"relaxation", "relaxation", "relaxation time", false, scene_relaxation},
    {"yield", "yield in the volume", "yield E1", false, scene_yield},
    {"adhesion", "adhesion", "adhesion", false, scene_adhesion},
    {"pull-off", "pull-off", "adhesion", false, scene_pull_off},
    {"wear", "wear", "coefficient distance", false, scene_wear},
    {"heat", "frictional heat", "mu speed conductivity diffusivity", false, scene_heat},
    {"dissimilar", "friction of dissimilar bodies", "mu E1", false, scene_dissimilar},
    {"rolling", "rolling with creepage", "mu creep E1", false, scene_rolling},
    {"sliding", "sliding on rubber", "relaxation speed", false, scene_sliding},
    {"fatigue", "fatigue", "bending-limit torsion-limit E1", false, scene_fatigue},
    {"leak", "leak through the gap", "pressure-drop", false, scene_leak},
};

enum {
    ROWS = sizeof rows / sizeof *rows,
    FEW_NODES = 20 /* one node of fewer is more than 5 % of the area */
};

const char *const rc_scene_figure_names[RC_SCENE_FIGURES] = {
    "contact_area", "max_pressure",  "approach", "displacement", "temperature",
    "friction",     "fatigue_index", "leak",     "pull_off"};
const char *const rc_scene_basis_names[] = {"exact", "computed", "bound", "calibrated"};
const char *const rc_scene_verdict_names[] = {"calls for it", "not decided", "negligible",
                                              "data missing"};

/* ---- the contact ---- */

void
scene_number(struct rc_scene_effect *e, const char *name, double value)
{
    for (size_t k = 0; k < RC_SCENE_NUMBERS; k++)
        if (e->number_name[k] == NULL) {
            e->number_name[k] = name;
            e->number[k] = value;
            return;
        }
}

enum rc_scene_basis
scene_elastic_basis(const struct rc_scene *s)
{
    return s->now.contact.contact_nodes < FEW_NODES ? RC_SCENE_BOUND : RC_SCENE_EXACT;
}

enum rc_status
scene_solve(struct rc_scene *s, const struct asked *a, struct solved *to, struct rc_err *err)
{
    const struct rc_elastic_asks asks = {.stiffness = a->stiffness};
    struct rc_point at = {0};
    enum rc_status status;
    RC_OWN(rc_model, m) =
        rc_elastic_new(&s->shape, a->h == NULL ? s->h : a->h, a->problem, &asks, err);

    if (m == NULL || !rc_store_need(&s->own, s->n, &to->p) ||
        !rc_store_need(&s->own, s->n, &to->gap) || !rc_store_need(&s->own, s->n, &to->u))
        return m == NULL ? RC_FAIL : rc_err_set(err, "out of memory for a contact");
    if (a->compliance > 0 && rc_model_set_compliance(m, a->compliance, NULL, 0, err) != RC_OK)
        return RC_FAIL;
    if (a->problem->approach > 0)
        rc_point_set(&at, RC_APPROACH, a->problem->approach);
    else
        rc_point_set(&at, RC_LOAD, a->problem->load);
    status = rc_model_run(m, &at, err);
    if (status == RC_FAIL || rc_model_look(m, &at, err) != RC_OK ||
        rc_model_frame(m, "pressure", to->p, err) != RC_OK ||
        rc_model_frame(m, "gap", to->gap, err) != RC_OK ||
        rc_model_frame(m, "displacement", to->u, err) != RC_OK)
        return RC_FAIL;
    if (a->problem->hardness > 0 && (!rc_store_need(&s->own, s->n, &to->shape) ||
                                     rc_model_frame(m, "plastic", to->shape, err) != RC_OK))
        return to->shape == NULL ? rc_err_set(err, "out of memory for a contact") : RC_FAIL;
    s->other_problem = *a->problem;
    to->contact = rc_elastic_result(m)->contact;
    to->stiffness = rc_elastic_result(m)->stiffness;
    s->convolutions += to->contact.convolutions;
    return status;
}

void
scene_changes(const struct solved *from, const struct solved *to, double change[RC_SCENE_FIGURES])
{
    const struct rc_contact *a = &from->contact, *b = &to->contact;

    change[RC_SCENE_AREA] = fabs(b->contact_area / a->contact_area - 1);
    change[RC_SCENE_PRESSURE] = fabs(b->max_pressure / a->max_pressure - 1);
    change[RC_SCENE_APPROACH] = fabs(b->approach / a->approach - 1);
}

struct rc_scene *
rc_scene_new(const struct rc_shape *shape, const double *h, const struct rc_problem *problem,
             const struct rc_scene_data *data, struct rc_err *err)
{
    RC_OWN(rc_scene, s) = calloc(1, sizeof *s);

    if (s == NULL)
        return rc_err_null(err, "out of memory for a scene");
    s->shape = *shape;
    s->n = shape->nx * shape->ny;
    s->h = h;
    s->data = *data;
    s->computed = SIZE_MAX;
    s->problem = *problem;
    s->problem.hardness = 0;
    s->problem.hardness_map = NULL;
    s->problem.pair.one.layers = 0;
    s->problem.tilt_free = false;
    s->problem.discretization = true;
    switch (
        scene_solve(s, &(struct asked){.problem = &s->problem, .stiffness = true}, &s->now, err)) {
    case RC_OK:
        break;
    case RC_FAIL:
        return NULL;
    default:
        return rc_err_null(err,
                           "the elastic contact does not converge: its estimated error is %.2g",
                           s->now.contact.pressure_error);
    }
    s->problem.discretization = false;
    s->problem.load = s->now.contact.load;
    s->problem.approach = 0;
    s->plain = s->problem;
    s->elastic = s->now;
    return rc_give(&s);
}

void
rc_scene_free(struct rc_scene *s)
{
    if (s == NULL)
        return;
    rc_store_free(&s->own);
    free(s);
}

const struct rc_contact *
rc_scene_contact(const struct rc_scene *s)
{
    return &s->now.contact;
}

const double *
rc_scene_pressure(const struct rc_scene *s)
{
    return s->now.p;
}

double
rc_scene_convolutions(const struct rc_scene *s)
{
    return s->convolutions;
}

/* ---- effects ---- */

const char *
rc_scene_name(size_t k)
{
    return k < ROWS ? rows[k].name : NULL;
}

/* The data of one name, which is that of an option of the tools. */
static bool
has(const struct rc_scene *s, const char *name, size_t length)
{
    const struct rc_scene_data *d = &s->data;
    const struct {
        const char *name;
        bool given;
    } known[] = {
        {"E1", s->plain.pair.estar == 0},
        {"thickness", d->thickness > 0},
        {"layer", d->layers > 0},
        {"hardness", d->hardness > 0 && !isinf(d->hardness)},
        {"yield", d->yield > 0},
        {"adhesion", d->work > 0},
        {"mu", d->mu > 0},
        {"tangential", d->tangential > 0},
        {"coefficient", d->wear > 0},
        {"distance", d->distance > 0},
        {"speed", d->speed != 0},
        {"creep", d->creep[0] != 0 || d->creep[1] != 0 || d->spin != 0},
        {"conductivity", d->conductivity[0] > 0 && d->conductivity[1] > 0},
        {"diffusivity", d->diffusivity[0] > 0 && d->diffusivity[1] > 0},
        {"time", d->time > 0},
        {"relaxation", d->material != NULL},
        {"bending-limit", d->bending > 0},
        {"torsion-limit", d->torsion > 0},
        {"pressure-drop", d->drop > 0},
    };

    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (strlen(known[k].name) == length && strncmp(known[k].name, name, length) == 0)
            return known[k].given;
    return false;
}

static bool
lacks(const struct rc_scene *s, const char *needs)
{
    for (const char *at = needs; *at != '\0'; at += strspn(at, " ")) {
        const size_t length = strcspn(at, " ");
        if (!has(s, at, length))
            return true;
        at += length;
    }
    return false;
}

enum rc_status
rc_scene_estimate(struct rc_scene *s, size_t k, struct rc_scene_effect *e, struct rc_err *err)
{
    *e = (struct rc_scene_effect){
        .name = rows[k].name, .title = rows[k].title, .nodes = s->now.contact.contact_nodes};
    for (int f = 0; f < RC_SCENE_FIGURES; f++)
        e->change[f] = (struct rc_interval){NAN, NAN};
    if (lacks(s, rows[k].needs)) {
        e->missing = rows[k].needs;
        return RC_OK;
    }
    s->computed = SIZE_MAX;
    if (rows[k].find(s, e, err) == RC_FAIL)
        return RC_FAIL;
    if (rows[k].accepts)
        s->computed = k;
    return RC_OK;
}

void
rc_scene_accept(struct rc_scene *s, size_t k)
{
    if (s->computed != k || s->other.p == NULL)
        return;
    s->now = s->other;
    s->problem = s->other_problem;
    s->other = (struct solved){0};
    s->computed = SIZE_MAX;
    s->accepted = true;
}

/* ---- verdicts ---- */

static double
bound_of(const struct rc_scene_bounds *b, int figure)
{
    const double relative = 0.01, temperature = 10, friction = 0.01;

    return figure == RC_SCENE_TEMPERATURE ? (b->temperature > 0 ? b->temperature : temperature)
           : figure == RC_SCENE_FATIGUE   ? 1
           : figure == RC_SCENE_LEAK      ? 0.5
           : figure == RC_SCENE_FRICTION  ? (b->friction > 0 ? b->friction : friction)
           : b->relative > 0              ? b->relative
                                          : relative;
}

enum rc_scene_verdict
rc_scene_judge(const struct rc_scene_effect *e, const struct rc_scene_bounds *b,
               enum rc_scene_figure *figure)
{
    double low = 0, high = 0;
    int lowest = RC_SCENE_AREA, highest = RC_SCENE_AREA;
    enum rc_scene_verdict verdict;

    for (int f = 0; f < RC_SCENE_FIGURES; f++) {
        const struct rc_interval *c = &e->change[f];
        if (isnan(c->high) || (b->figures != 0 && !(b->figures & 1U << f)))
            continue;
        if (c->low / bound_of(b, f) > low) {
            low = c->low / bound_of(b, f);
            lowest = f;
        }
        if (c->high / bound_of(b, f) > high) {
            high = c->high / bound_of(b, f);
            highest = f;
        }
    }
    if (e->missing != NULL)
        return RC_SCENE_MISSING;
    verdict = e->unfit[0] != '\0'          ? RC_SCENE_UNDECIDED
              : e->basis == RC_SCENE_EXACT ? (low >= 1    ? RC_SCENE_CALLS
                                              : high >= 1 ? RC_SCENE_UNDECIDED
                                                          : RC_SCENE_NEGLIGIBLE)
              : e->nodes < FEW_NODES       ? RC_SCENE_UNDECIDED
              : low >= 1                   ? RC_SCENE_CALLS
              : high < 1                   ? RC_SCENE_NEGLIGIBLE
                                           : RC_SCENE_UNDECIDED;
    if (figure != NULL)
        *figure = (enum rc_scene_figure)(verdict == RC_SCENE_CALLS ? lowest : highest);
    return verdict;
}
