/*
 * What was measured, as JSON: an object a trial.
 */
#include "cost.h"

#include <math.h>

static const char *
state_name(enum cost_state state)
{
    return state == COST_DONE ? "done" : state == COST_STOPPED ? "stopped" : "left out";
}

static void
report_measured(struct json *j, const struct cost_trial *m)
{
    bool done = m->state == COST_DONE;

    json_number(j, "seconds", done ? m->seconds : NAN);
    json_count(j, "runs", m->runs);
    json_number(j, "convolutions", done ? m->convolutions : NAN);
    json_number(j, "memory", done ? (double)m->memory : NAN);
    json_number(j, "iterations", done ? (double)m->contact.iterations : NAN);
    json_number(j, "pressure_error_estimate", done ? m->contact.pressure_error : NAN);
    json_number(j, "error", done ? m->error : NAN);
    json_number(j, "contact_area_error", done ? m->area_error : NAN);
    json_number(j, "max_pressure_error", done ? m->peak_error : NAN);
    json_number(j, "approach_error", done ? m->approach_error : NAN);
    json_bool(j, "converged", done && m->contact.converged);
    json_bool(j, "front", m->front);
    json_bool(j, "optimistic", m->optimistic);
}

static void
report_trial(const struct cost_case *c, const struct cost_trial *m, const char *what, FILE *out)
{
    struct json j;

    json_open(&j, out);
    json_count(&j, "case", rc_grid_case(c->heights));
    json_text(&j, "source", rc_grid_get(c->heights, "source"));
    json_text(&j, "what", what);
    json_text(&j, "method", m->settings.method);
    json_text(&j, "kernel", m->settings.kernel);
    json_text(&j, "arithmetic", m->settings.arithmetic);
    json_number(&j, "tol", m->settings.tol);
    json_count(&j, "coarse", m->settings.coarse);
    json_count(&j, "nx", m->shape.nx);
    json_count(&j, "ny", m->shape.ny);
    json_count(&j, "threads", c->tool->threads);
    json_text(&j, "state", state_name(m->state));
    json_text(&j, "why", m->why[0] == '\0' ? NULL : m->why);
    json_number(&j, "expected_seconds", m->expected);
    report_measured(&j, m);
    json_close(&j);
}

static void
report_stress(const struct cost_case *c, const struct cost_stress *s, FILE *out)
{
    bool done = s->state == COST_DONE;
    struct json j;

    json_open(&j, out);
    json_count(&j, "case", rc_grid_case(c->heights));
    json_text(&j, "source", rc_grid_get(c->heights, "source"));
    json_text(&j, "what", s->reference ? "stress reference" : "stress");
    json_text(&j, "kernel", s->kernel);
    json_number(&j, "tol", s->tol);
    json_count(&j, "depths", c->depths.n);
    json_text(&j, "state", state_name(s->state));
    json_text(&j, "why", s->why[0] == '\0' ? NULL : s->why);
    json_number(&j, "expected_seconds", s->expected);
    json_number(&j, "seconds", done ? s->seconds : NAN);
    json_count(&j, "runs", s->runs);
    json_number(&j, "coarse_depths", done ? (double)s->coarse : NAN);
    json_number(&j, "memory", done ? (double)s->memory : NAN);
    json_number(&j, "error", done ? s->error : NAN);
    json_number(&j, "rms_error", done ? s->rms : NAN);
    json_number(&j, "mises_error", done ? s->mises : NAN);
    json_bool(&j, "front", s->front);
    json_close(&j);
}

void
cost_report(const struct cost_case *c, FILE *out)
{
    report_trial(c, &c->reference, "reference", out);
    for (size_t k = 0; k < c->trials; k++)
        report_trial(c, &c->trial[k], "pressure", out);
    for (size_t k = 0; k < c->stresses && c->depths.n > 0; k++)
        report_stress(c, &c->stress[k], out);
}
