/*
 * What was measured, in columns for people, cut and awk.
 */
#include "cost.h"

static void
put_load(const struct cost_case *c, FILE *out)
{
    char text[RC_NUMBER_SIZE];

    if (c->by_approach)
        fprintf(out, "approach %s m", rc_number_text(text, c->problem.approach));
    else
        fprintf(out, "load %s N", rc_number_text(text, c->problem.load));
}

const char *
cost_body(const struct cost_case *c, const char *between, char text[COST_BODY])
{
    size_t n = c->problem.pair.one.layers;
    char stress[SHOWN_NUMBER];

    text[0] = '\0';
    if (c->yield != NULL)
        snprintf(text, COST_BODY, "%syields at %s", between,
                 shown_in_unit(stress, yield_law_first(c->yield), "Pa"));
    if (c->adhesion != NULL)
        snprintf(text, COST_BODY, "%sattracted by %s", between,
                 shown_in_unit(stress, c->adhesion->work, "J/m2"));
    if (n > 0)
        snprintf(text, COST_BODY, "%s%zu layer%s", between, n, n == 1 ? "" : "s");
    return text;
}

static void
put_head(const struct cost_case *c, FILE *out)
{
    const struct cost_trial *r = &c->reference;
    char where[256], body[COST_BODY];

    fprintf(out, "# %s: %zu x %zu nodes, %s, ",
            tool_where(c->tool, c->heights, where, sizeof where), c->shape.nx, c->shape.ny,
            c->problem.boundary == RC_FREE ? "free" : "periodic");
    put_load(c, out);
    fprintf(out, "%s, %zu threads\n", cost_body(c, ", ", body), c->tool->threads);
    fprintf(out,
            "# reference: %s, %s in %s precision, estimated error %.1e (asked %.0e), %zu steps, "
            "%.3g s: "
            "contact area %.9g m2 (%.4g %% of the map, %.3g %% at the hardness), largest pressure "
            "%.9g Pa, "
            "approach %.9g m\n",
            r->settings.method, r->settings.kernel, r->settings.arithmetic,
            r->contact.pressure_error, r->settings.tol, r->contact.iterations, r->seconds,
            r->contact.contact_area, 100 * r->contact.contact_fraction,
            r->contact.contact_area > 0 ? 100 * r->contact.plastic_area / r->contact.contact_area
                                        : 0,
            r->contact.max_pressure, r->contact.approach);
    if (c->yield != NULL)
        fprintf(out, "# it yields: the reference has %zu increments and %zu slabs\n",
                r->settings.increments, r->slabs);
    if (c->adhesion != NULL)
        fprintf(out,
                "# pressures are net, tension negative; the cohesive length is %.3g nodes of the "
                "map, each trial's own is in its column: below 1.5 the grid pins the edge of the "
                "contact\n",
                r->cohesive_nodes);
    if (c->leak != 0)
        fprintf(out,
                "# flow along %c: the reference has a conductance of %.9g m3; flow_error: relative "
                "to it, "
                "each on its own grid\n",
                c->leak, r->flow);
    fprintf(out, "# error: sum |p - reference| / sum reference, on the map's own grid; area, peak, "
                 "approach: relative "
                 "to the reference; estimate: what the solver says of its own grid\n");
}

static const char *
note(const struct cost_trial *m)
{
    static char text[64];

    snprintf(text, sizeof text, "%s%s%s", m->front ? ",front" : "",
             m->contact.converged ? "" : ",short", m->optimistic ? ",optimistic" : "");
    return text[0] == '\0' ? "-" : text + 1;
}

static void
put_trial(const struct cost_case *c, const struct cost_trial *m, FILE *out)
{
    char grid[64], yields[64] = "", flow[64] = "", cohesive[32] = "";

    if (m->settings.increments > 0)
        snprintf(yields, sizeof yields, "%10zu %5zu %12zu ", m->settings.increments, m->slabs,
                 m->applications);

    if (c->adhesion != NULL)
        snprintf(cohesive, sizeof cohesive, "%14.3g ", m->cohesive_nodes);
    if (c->leak != 0)
        snprintf(flow, sizeof flow, "%10.2e %12.4f ", m->flow_error, m->flow_seconds);
    snprintf(grid, sizeof grid, "%zux%zu", m->shape.nx, m->shape.ny);
    fprintf(out,
            "%-6s %-6s %-10s %6.0e %11s %9.4f %4zu %12.1f %11.1f %9.2e %9.2e %10.2e %10.2e %14.2e "
            "%s%s%s%s\n",
            m->settings.method, m->settings.kernel, m->settings.arithmetic, m->settings.tol, grid,
            m->seconds, m->runs, m->convolutions, (double)m->memory / 1048576,
            m->contact.pressure_error, m->error, m->area_error, m->peak_error, m->approach_error,
            yields, cohesive, flow, note(m));
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
    fprintf(out, "%-6s %-6s %-10s %6s %11s %9s %4s %12s %11s %9s %9s %10s %10s %14s %s%s%s%s\n",
            "method", "kernel", "arithmetic", "tol", "grid", "time[s]", "runs", "convolutions",
            "memory[MiB]", "estimate", "error", "area_error", "peak_error", "approach_error",
            c->yield != NULL ? "increments slabs applications " : "",
            c->adhesion != NULL ? "cohesive_nodes " : "",
            c->leak != 0 ? "flow_error flow_time[s] " : "", "note");
    for (size_t k = 0; k < c->trials; k++)
        if (c->trial[k].state == COST_DONE)
            put_trial(c, &c->trial[k], out);
    for (size_t k = 0; k < c->trials; k++)
        if (c->trial[k].state != COST_DONE)
            fprintf(out, "# %s: %s\n", cost_name(name, &c->trial[k]), c->trial[k].why);
    if (c->depths.n > 0 && c->stresses > 0)
        put_stresses(c, out);
}
