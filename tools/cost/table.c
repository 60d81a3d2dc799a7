/*
 * What was measured, for people, for cut and awk, and as JSON.
 */
#include "cost.h"

#include <math.h>
#include <string.h>

/* ---- the front ---- */

/* Below what the reference can tell all errors are the same. */
static double
seen(const struct cost_case *c, double error)
{
    return fmax(error, c->reference.contact.pressure_error);
}

static bool
beaten(const struct cost_case *c, const struct cost *a, const struct cost *by)
{
    double e = seen(c, a->error), f = seen(c, by->error);

    return by->state == COST_DONE && by->seconds <= a->seconds && f <= e &&
           (by->seconds < a->seconds || f < e);
}

/* Of the reference no error is known: it is rounding. */
static double
stress_error(const struct cost_stress *s)
{
    return s->reference ? 0 : s->error;
}

static bool
stress_beaten(const struct cost_stress *a, const struct cost_stress *by)
{
    double e = stress_error(a), f = stress_error(by);

    return by->state == COST_DONE && by->seconds <= a->seconds && f <= e &&
           (by->seconds < a->seconds || f < e);
}

void
cost_judge(struct cost_case *c)
{
    for (size_t k = 0; k < c->rungs; k++) {
        struct cost *a = &c->rung[k];

        a->front = a->state == COST_DONE;
        for (size_t l = 0; l < c->rungs; l++)
            a->front = a->front && !beaten(c, a, &c->rung[l]);
        a->flatters =
            a->state == COST_DONE && a->rung.coarse == 1 &&
            a->error > 1.01 * a->contact.pressure_error + c->reference.contact.pressure_error;
    }
    for (size_t k = 0; k < c->stresses; k++) {
        struct cost_stress *a = &c->stress[k];

        a->front = a->state == COST_DONE;
        for (size_t l = 0; l < c->stresses; l++)
            a->front = a->front && !stress_beaten(a, &c->stress[l]);
    }
}

/* ---- the table ---- */

static void
put_load(const struct cost_case *c, FILE *out)
{
    char text[RC_NUMBER_SIZE];

    if (c->problem.approach > 0)
        fprintf(out, "approach %s m", rc_number_text(text, c->problem.approach));
    else
        fprintf(out, "load %s N", rc_number_text(text, c->problem.load));
}

static void
put_head(const struct cost_case *c, FILE *out)
{
    const struct cost *r = &c->reference;
    char where[256];

    fprintf(out, "# %s: %zu x %zu nodes, %s, ",
            tool_where(c->tool, c->heights, where, sizeof where), c->shape.nx, c->shape.ny,
            c->problem.boundary == RC_FREE ? "free" : "periodic");
    put_load(c, out);
    fprintf(out, ", %zu threads\n", c->tool->threads);
    fprintf(out,
            "# reference: %s, %s in %s precision, estimated error %.1e (asked %.0e), %zu steps, "
            "%.3g s: "
            "contact area %.9g m2 (%.4g %% of the map, %.3g %% at the hardness), largest pressure "
            "%.9g Pa, "
            "approach %.9g m\n",
            r->rung.method, r->rung.kernel, r->rung.arithmetic, r->contact.pressure_error,
            r->rung.tol, r->contact.iterations, r->seconds, r->contact.contact_area,
            100 * r->contact.contact_fraction,
            100 * r->contact.plastic_area / r->contact.contact_area, r->contact.max_pressure,
            r->contact.approach);
    fprintf(out, "# error: sum |p - reference| / sum reference, on the map's own grid; area, peak, "
                 "approach: relative "
                 "to the reference; estimate: what the solver says of its own grid\n");
}

static const char *
note(const struct cost *m)
{
    static char text[64];

    snprintf(text, sizeof text, "%s%s%s", m->front ? ",front" : "",
             m->contact.converged ? "" : ",short", m->flatters ? ",flatters" : "");
    return text[0] == '\0' ? "-" : text + 1;
}

static void
put_rung(const struct cost *m, FILE *out)
{
    char grid[64];

    snprintf(grid, sizeof grid, "%zux%zu", m->shape.nx, m->shape.ny);
    fprintf(
        out,
        "%-6s %-6s %-10s %6.0e %11s %9.4f %4zu %12.1f %11.1f %9.2e %9.2e %10.2e %10.2e %14.2e %s\n",
        m->rung.method, m->rung.kernel, m->rung.arithmetic, m->rung.tol, grid, m->seconds, m->runs,
        m->convolutions, (double)m->memory / 1048576, m->contact.pressure_error, m->error,
        m->area_error, m->peak_error, m->approach_error, note(m));
}

static void
put_stresses(const struct cost_case *c, FILE *out)
{
    const struct numbers *d = &c->depths;

    fprintf(out,
            "\n# stresses under the reference: six components and Mises at %zu depths, %.3g to "
            "%.3g m, nu %.3g, mu "
            "%.3g; error: of a component, over the largest pressure; mises: of its largest value\n",
            d->n, d->v[0], d->v[d->n - 1], c->nu, c->mu);
    fprintf(out, "%-6s %6s %9s %4s %13s %11s %9s %9s %10s %s\n", "kernel", "tol", "time[s]", "runs",
            "coarse_depths", "memory[MiB]", "error", "rms_error", "mises", "note");
    for (size_t k = 0; k < c->stresses; k++) {
        const struct cost_stress *s = &c->stress[k];

        if (s->state == COST_DONE)
            fprintf(out, "%-6s %6.0e %9.4f %4zu %13zu %11.1f %9.2e %9.2e %10.2e %s%s\n", s->kernel,
                    s->tol, s->seconds, s->runs, s->coarse, (double)s->memory / 1048576, s->error,
                    s->rms, s->mises, s->reference ? "reference" : "",
                    s->front       ? s->reference ? ",front" : "front"
                    : s->reference ? ""
                                   : "-");
        else
            fprintf(out, "# stresses by %s, tol %.0e: %s\n", s->kernel, s->tol, s->why);
    }
}

void
cost_table(const struct cost_case *c, FILE *out)
{
    char name[128];

    put_head(c, out);
    fprintf(out, "%-6s %-6s %-10s %6s %11s %9s %4s %12s %11s %9s %9s %10s %10s %14s %s\n", "method",
            "kernel", "arithmetic", "tol", "grid", "time[s]", "runs", "convolutions", "memory[MiB]",
            "estimate", "error", "area_error", "peak_error", "approach_error", "note");
    for (size_t k = 0; k < c->rungs; k++)
        if (c->rung[k].state == COST_DONE)
            put_rung(&c->rung[k], out);
    for (size_t k = 0; k < c->rungs; k++)
        if (c->rung[k].state != COST_DONE)
            fprintf(out, "# %s: %s\n", cost_name(name, &c->rung[k]), c->rung[k].why);
    if (c->depths.n > 0 && c->stresses > 0)
        put_stresses(c, out);
}

/* ---- JSON ---- */

static const char *
state_name(enum cost_state state)
{
    return state == COST_DONE ? "done" : state == COST_STOPPED ? "stopped" : "left out";
}

static void
report_measured(struct json *j, const struct cost *m)
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
    json_bool(j, "flatters", m->flatters);
}

static void
report_rung(const struct cost_case *c, const struct cost *m, const char *what, FILE *out)
{
    struct json j;

    json_open(&j, out);
    json_count(&j, "case", rc_grid_case(c->heights));
    json_text(&j, "source", rc_grid_get(c->heights, "source"));
    json_text(&j, "what", what);
    json_text(&j, "method", m->rung.method);
    json_text(&j, "kernel", m->rung.kernel);
    json_text(&j, "arithmetic", m->rung.arithmetic);
    json_number(&j, "tol", m->rung.tol);
    json_count(&j, "coarse", m->rung.coarse);
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
    report_rung(c, &c->reference, "reference", out);
    for (size_t k = 0; k < c->rungs; k++)
        report_rung(c, &c->rung[k], "pressure", out);
    for (size_t k = 0; k < c->stresses && c->depths.n > 0; k++)
        report_stress(c, &c->stress[k], out);
}
