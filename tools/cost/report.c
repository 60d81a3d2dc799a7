/*
 * What was measured: a row a trial.
 */
#include "cost.h"

#include <math.h>

static const char *
state_name(enum cost_state state)
{
    return state == COST_DONE ? "done" : state == COST_STOPPED ? "stopped" : "left out";
}

static void
report_measured(const struct cost_case *c, struct report *out, const struct cost_trial *m)
{
    bool done = m->state == COST_DONE;

    report_number(out, "seconds", done ? m->seconds : NAN, "s");
    report_count(out, "runs", m->runs, NULL);
    report_number(out, "convolutions", done ? m->convolutions : NAN, NULL);
    report_number(out, "memory", done ? (double)m->memory : NAN, "B");
    report_number(out, "iterations", done ? (double)m->contact.iterations : NAN, NULL);
    report_number(out, "pressure_error_estimate", done ? m->contact.pressure_error : NAN, NULL);
    report_number(out, "error", done ? m->error : NAN, NULL);
    report_number(out, "contact_area_error", done ? m->area_error : NAN, NULL);
    report_number(out, "max_pressure_error", done ? m->peak_error : NAN, NULL);
    report_number(out, "approach_error", done ? m->approach_error : NAN, NULL);
    if (c->leak != 0) {
        report_number(out, "flow_conductance", done ? m->flow : NAN, "m3");
        report_number(out, "flow_error", done ? m->flow_error : NAN, NULL);
        report_number(out, "flow_seconds", done ? m->flow_seconds : NAN, "s");
    }
    report_bool(out, "converged", done && m->contact.converged);
    report_bool(out, "front", m->front);
    report_bool(out, "optimistic", m->optimistic);
}

static void
report_trial(const struct cost_case *c, const struct cost_trial *m, const char *what,
             struct report *out)
{
    report_begin(out);
    report_count(out, "case", rc_grid_case(c->heights), NULL);
    report_text(out, "source", rc_grid_get(c->heights, "source"));
    report_text(out, "what", what);
    report_text(out, "method", m->settings.method);
    report_text(out, "kernel", m->settings.kernel);
    report_text(out, "arithmetic", m->settings.arithmetic);
    report_number(out, "tol", m->settings.tol, NULL);
    report_count(out, "coarse", m->settings.coarse, NULL);
    if (c->yield != NULL) {
        report_count(out, "increments", m->settings.increments, NULL);
        report_number(out, "slabs", m->slabs > 0 ? (double)m->slabs : NAN, NULL);
        report_number(out, "applications", m->applications > 0 ? (double)m->applications : NAN,
                      NULL);
    }
    if (c->adhesion != NULL)
        report_number(out, "cohesive_nodes", m->state == COST_DONE ? m->cohesive_nodes : NAN, NULL);
    report_count(out, "nx", m->shape.nx, NULL);
    report_count(out, "ny", m->shape.ny, NULL);
    report_count(out, "threads", c->tool->threads, NULL);
    report_text(out, "state", state_name(m->state));
    report_text(out, "why", m->why[0] == '\0' ? NULL : m->why);
    report_number(out, "expected_seconds", m->expected, "s");
    report_measured(c, out, m);
    if (c->stress != NULL) {
        report_column(out, "depths", NULL);
        report_column(out, "coarse_depths", NULL);
        report_column(out, "rms_error", NULL);
        report_column(out, "mises_error", NULL);
    }
    report_finish_row(out);
}

static void
report_stress(const struct cost_case *c, const struct cost_stress *s, struct report *out)
{
    bool done = s->state == COST_DONE;

    report_begin(out);
    report_count(out, "case", rc_grid_case(c->heights), NULL);
    report_text(out, "source", rc_grid_get(c->heights, "source"));
    report_text(out, "what", s->reference ? "stress reference" : "stress");
    report_text(out, "kernel", s->kernel);
    report_number(out, "tol", s->tol, NULL);
    report_count(out, "depths", c->depths.n, NULL);
    report_text(out, "state", state_name(s->state));
    report_text(out, "why", s->why[0] == '\0' ? NULL : s->why);
    report_number(out, "expected_seconds", s->expected, "s");
    report_number(out, "seconds", done ? s->seconds : NAN, "s");
    report_count(out, "runs", s->runs, NULL);
    report_number(out, "coarse_depths", done ? (double)s->coarse : NAN, NULL);
    report_number(out, "memory", done ? (double)s->memory : NAN, "B");
    report_number(out, "error", done ? s->error : NAN, NULL);
    report_number(out, "rms_error", done ? s->rms : NAN, NULL);
    report_number(out, "mises_error", done ? s->mises : NAN, NULL);
    report_bool(out, "front", s->front);
    report_finish_row(out);
}

void
cost_report(const struct cost_case *c, struct report *out)
{
    report_trial(c, &c->reference, "reference", out);
    for (size_t k = 0; k < c->trials; k++)
        report_trial(c, &c->trial[k], "pressure", out);
    for (size_t k = 0; k < c->stresses && c->depths.n > 0; k++)
        report_stress(c, &c->stress[k], out);
}
