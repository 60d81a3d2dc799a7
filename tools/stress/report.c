/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- gathering ---- */

static const char *const ends[] = {[STRESS_LARGEST] = "max", [STRESS_LEAST] = "min"};

static bool
begin_extreme(struct stress_extreme *x, size_t depths, size_t materials)
{
    const struct stress_place none = {NAN, NAN, NAN, NAN};

    x->all = none;
    x->by_depth = malloc(depths * sizeof *x->by_depth);
    x->by_material = malloc(materials * sizeof *x->by_material);
    for (size_t m = 0; m < materials && x->by_material != NULL; m++)
        x->by_material[m] = none;
    return x->by_depth != NULL && x->by_material != NULL;
}

enum rc_status
stress_report_begin(struct stress_report *r, const struct rc_grid *p,
                    const struct rc_stress_options *options, const struct numbers *depths,
                    bool extremes, struct rc_err *err)
{
    *r = (struct stress_report){.p = p, .options = options, .depths = depths, .began = tool_now()};
    for (int c = 0; c < RC_STRESSES && extremes; c++)
        for (int e = 0; e < STRESS_ENDS && options->wanted >> c & 1; e++)
            if (!begin_extreme(&r->extreme[e][c], depths->n, options->body.layers + 1))
                return rc_err_set(err, "out of memory for a report of %zu depths", depths->n);
    return RC_OK;
}

/* Value k of a slice or of a line, and its position. */
static struct stress_place
place(const struct stress_report *r, size_t k, double depth, double value)
{
    const struct rc_grid *p = r->p;
    char section = r->options->section;
    size_t i = section == 'x' ? 0 : section == 'y' ? k : k % p->nx;
    size_t j = section == 'x' ? k : section == 'y' ? 0 : k / p->nx;
    double x = ((double)i - (double)(p->nx - 1) / 2) * p->dx;
    double y = ((double)j - (double)(p->ny - 1) / 2) * p->dy;

    return (struct stress_place){value, section == 'x' ? r->options->at : x,
                                 section == 'y' ? r->options->at : y, depth};
}

static void
keep(struct stress_place *kept, const struct stress_place *here, double sign)
{
    if (!(sign * here->value <= sign * kept->value))
        *kept = *here;
}

void
stress_report_depth(struct stress_report *r, const struct tool *t, size_t k, size_t n,
                    double *const *s)
{
    const double depth = r->depths->v[k];
    size_t material = rc_body_material(&r->options->body, depth);

    r->slices += tool_now() - r->depth_began;
    for (int c = 0; c < RC_STRESSES; c++) {
        size_t at[STRESS_ENDS], first;
        if (r->extreme[0][c].by_depth == NULL)
            continue;
        first = tool_first_row(t, r->p) * r->p->nx;
        if (n > 0)
            rc_extremes(n, s[c], &at[STRESS_LEAST], &at[STRESS_LARGEST]);
        for (int e = 0; e < STRESS_ENDS; e++) {
            const double sign = e == STRESS_LARGEST ? 1 : -1;
            struct stress_extreme *x = &r->extreme[e][c];
            struct stress_place here = {.value = -sign * INFINITY}; /* for a process without rows */
            if (n > 0)
                here = place(r, first + at[e], depth, s[c][at[e]]);
            ranks_share(t, ranks_where_most(t, sign * here.value), &here, sizeof here);
            x->by_depth[k] = here.value;
            keep(&x->by_material[material], &here, sign);
            keep(&x->all, &here, sign);
        }
    }
}

void
stress_report_free(struct stress_report *r)
{
    for (int e = 0; e < STRESS_ENDS; e++)
        for (int c = 0; c < RC_STRESSES; c++) {
            free(r->extreme[e][c].by_depth);
            free(r->extreme[e][c].by_material);
        }
}

/* ---- effects ---- */

/* Each effect: computed, or the reason why not. */
static const char *
component_effect(const struct rc_stress_options *o, int c)
{
    if (o->wanted >> c & 1)
        return "on";
    if (c < RC_COMPONENTS && o->wanted >> RC_COMPONENTS != 0)
        return "computed for what is derived from it, not written";
    return "left out: not in --components";
}

/* True if the case has maps of traction. */
static bool
traction(const struct rc_stress_options *o)
{
    return o->traction[0] != NULL || o->traction[1] != NULL;
}

static const char *
friction_effect(const struct rc_stress_options *o)
{
    return o->mu != 0 || traction(o) ? "on" : "left out: mu = 0";
}

static const char *
coating_effect(const struct rc_stress_options *o)
{
    return o->residual != NULL  ? "on, with residual stress in the layers"
           : o->body.layers > 0 ? "on"
                                : "left out: the stream has no layers, one material";
}

static const char *
padding_effect(const struct rc_stress_options *o)
{
    return boundary_padding(o->boundary);
}

static const char *
section_effect(const struct rc_stress_options *o)
{
    return o->section != 0 ? "on" : "left out: no --section";
}

/* "auto" selects the first engine of the table; only this engine has coarser grids for deep slices. */
static const char *
engine_of(const struct rc_stress_options *o)
{
    return strcmp(o->engine, "auto") == 0 ? words_engine(0) : o->engine;
}

static const char *
coarse_effect(const struct rc_stress_options *o)
{
    if (o->tol == 0)
        return "left out: no --tol";
    if (o->section != 0)
        return "left out: a section is a line already";
    if (!rc_has_mean(o->boundary))
        return "left out: the map is periodic";
    if (o->body.layers > 0)
        return "left out: the body is coated";
    if (o->ranks != NULL)
        return "left out: several processes share the map";
    return strcmp(engine_of(o), words_engine(0)) == 0
               ? "on where depth allows"
               : "left out: the engine has its own tolerance";
}

/* The effects, and the components with the reasons. */
static const struct effect_state *
effects_of(const struct rc_stress_options *o)
{
    static struct effect_state list[RC_STRESSES + 6];

    list[0] = (struct effect_state){"friction", friction_effect(o)};
    list[1] = (struct effect_state){"coating", coating_effect(o)};
    list[2] = (struct effect_state){"padding", padding_effect(o)};
    list[3] = (struct effect_state){"section", section_effect(o)};
    list[4] = (struct effect_state){"coarse_grids", coarse_effect(o)};
    for (int c = 0; c < RC_STRESSES; c++)
        list[5 + c] = (struct effect_state){rc_component_names[c], component_effect(o, c)};
    return list;
}

/* ---- the report ---- */

#define FIGURE(member) RC_FIGURE(struct stress_place, member)
static const struct rc_figure places[] = {
    {FIGURE(value), "Pa"}, {FIGURE(x), "m"}, {FIGURE(y), "m"}, {FIGURE(depth), "m"}, {0}};

static void
write_place(struct report *out, const struct stress_place *at)
{
    if (isnan(at->value)) {
        report_no_object(out, NULL);
        return;
    }
    report_array(out, NULL);
    for (const struct rc_figure *f = places + 1; f->name != NULL; f++)
        report_number(out, NULL, rc_figure_number(f, at), f->unit);
    report_end(out);
}

static void
write_extremes(const struct stress_report *r, struct report *out, enum stress_end end)
{
    const size_t materials = r->options->body.layers + 1;

    report_object(out, ends[end]);
    for (int c = 0; c < RC_STRESSES; c++) {
        const struct stress_extreme *x = &r->extreme[end][c];
        if (x->by_depth == NULL)
            continue;
        report_object(out, rc_component_names[c]);
        report_table(out, places, &x->all);
        report_numbers(out, "by_depth", x->by_depth, sizeof *x->by_depth, r->depths->n);
        report_numbers(out, "by_material", &x->by_material->value, sizeof *x->by_material,
                       materials);
        report_array(out, "place_by_material");
        for (size_t m = 0; m < materials; m++)
            write_place(out, &x->by_material[m]);
        report_end(out);
        report_end(out);
    }
    report_end(out);
}

/* The figures of a role: new columns of a table are its last ones. */
static void
write_figures(struct report *out, const struct rc_stress *stress, enum rc_figure_role role)
{
    struct rc_figure some[RC_STRESSES + 16] = {{0}};
    size_t n = 0;

    for (const struct rc_figure *f = rc_figures("stress"); f->name != NULL; f++)
        if (f->role == role)
            some[n++] = *f;
    report_table(out, some, rc_stress_counted(stress));
}

/* True for components that are positive everywhere. */
static bool
positive(int c)
{
    return c == RC_MISES || c == RC_TRESCA;
}

/* The columns of a table, which has no objects: extreme values with their depths. */
static void
write_columns(const struct stress_report *r, struct report *out)
{
    static char names[RC_STRESSES][STRESS_ENDS][2][32]; /* the report keeps them */

    for (int c = 0; c < RC_STRESSES; c++)
        for (int e = 0; e < STRESS_ENDS; e++) {
            char(*name)[32] = names[c][e];
            const struct stress_extreme *x = &r->extreme[e][c];
            if (x->by_depth == NULL || (e == STRESS_LEAST && positive(c)))
                continue;
            snprintf(name[0], sizeof *name, "%s_%s", ends[e], rc_component_names[c]);
            report_number(out, name[0], x->all.value, "Pa");
            snprintf(name[1], sizeof *name, "%s_%s_depth", ends[e], rc_component_names[c]);
            report_number(out, name[1], x->all.depth, "m");
        }
}

void
stress_report_write(struct stress_report *r, struct report *out, const struct rc_stress *stress)
{
    const struct rc_stress_options *o = r->options;
    const char section[2] = {o->section, '\0'};

    report_begin(out);
    report_map(out, r->p, rc_grid_case(r->p));
    report_text(out, "boundary", rc_boundary_word(o->boundary));
    report_text(out, "kernel", rc_stress_engine(stress));
    report_count(out, "threads", o->threads, NULL);
    report_number(out, "nu", o->body.layers == 0 ? o->body.nu : NAN, NULL);
    report_text(out, "layers", rc_grid_get(r->p, "layers"));
    report_number(out, "mu", traction(o) ? NAN : o->mu, NULL);
    report_text(out, "section", o->section == 0 ? NULL : section);
    report_number(out, "at", o->section == 0 ? NAN : o->at, "m");
    report_number(out, "tol", o->tol, NULL);
    report_numbers(out, "depths", r->depths->v, sizeof *r->depths->v, r->depths->n);
    report_array(out, "materials");
    for (size_t k = 0; k < r->depths->n; k++)
        report_count(out, NULL, rc_body_material(&o->body, r->depths->v[k]) + 1, NULL);
    report_end(out);
    for (int e = 0; e < STRESS_ENDS; e++)
        write_extremes(r, out, (enum stress_end)e);
    report_carried(out, rc_grid_get(r->p, "converged"));
    report_effects(out, effects_of(o));
    write_figures(out, stress, RC_FIGURE_COST);
    report_seconds(
        out,
        (const struct report_phase[]){{"setup", r->setup},
                                      {"slices", r->slices},
                                      {"write", tool_now() - r->began - r->setup - r->slices},
                                      {NULL, 0}},
        r->setup + r->slices);
    report_memory(out);
    report_ranks(out, out->tool);
    write_figures(out, stress, RC_FIGURE_ERROR);
    report_number(out, "pressure_error_estimate", o->pressure_error, NULL);
    report_number(out, "traction_error_estimate", o->traction_error, NULL);
    if (out->separator)
        write_columns(r, out);
    report_finish_row(out);
}

/* ---- the plan ---- */

/* Expected seconds of all depths, from a trial of the first one, which touches all memory, and of those at a
 * quarter and three quarters of the list. They are processor seconds of a thread. NAN: the memory does not
 * suffice. */
static enum rc_status
expect(const struct tool *t, const struct rc_grid *p, const struct rc_stress_options *o,
       const struct numbers *depths, size_t memory, double *expected, struct rc_err *err)
{
    const double value = 6e-9; /* s to derive, count and write one */
    const size_t n = rc_grid_nodes(p);
    RC_OWNED double *v = NULL;
    double *s[RC_STRESSES], start = tool_worked(), first, worked;
    struct rc_stress *stress;
    enum rc_status status = RC_OK;

    *expected = NAN;
    if (ranks_most(t, memory > tool_memory_left(t)) > 0)
        return RC_OK;
    if ((v = malloc(RC_STRESSES * n * sizeof *v)) == NULL)
        status = rc_err_set(err, "out of memory for the trial of a plan");
    if (ranks_agree(t, status, err) != RC_OK || v == NULL)
        return status;
    for (int c = 0; c < RC_STRESSES; c++)
        s[c] = v + (size_t)c * n;
    if ((stress = rc_stress_new(rc_shape_of(p), p->v, o, err)) == NULL)
        status = RC_FAIL;
    if (status == RC_OK)
        status = rc_stress_slice(stress, depths->v[0], s, err);
    first = tool_worked();
    for (size_t k = 1; status == RC_OK && k < 4; k += 2)
        status = rc_stress_slice(stress, depths->v[k * (depths->n - 1) / 4], s, err);
    worked = first - start + (double)(depths->n - 1) * (tool_worked() - first) / 2;
    *expected = worked / (double)t->threads;
    for (int c = 0; status == RC_OK && c < RC_STRESSES; c++)
        *expected +=
            o->wanted >> c & 1 ? value * (double)depths->n * (double)rc_stress_values(stress) : 0;
    rc_stress_free(stress);
    return status;
}

/* The materials of a coated body, and the number of depths in each. */
static void
say_materials(const struct plan *plan, const struct rc_stress_options *o,
              const struct numbers *depths)
{
    const struct rc_body *c = &o->body;
    double top = 0;
    char name[32];

    for (size_t m = 0; c->layers > 0 && m <= c->layers; m++) {
        double e = m < c->layers ? c->layer[m].e : c->e;
        double nu = m < c->layers ? c->layer[m].nu : c->nu;
        size_t in = 0;
        for (size_t k = 0; k < depths->n; k++)
            in += rc_body_material(c, depths->v[k]) == m;
        snprintf(name, sizeof name, "material %zu", m + 1);
        plan_say(plan, name, "from %g m, E %g Pa, nu %g: %zu of the depths", top, e, nu, in);
        top += m < c->layers ? c->layer[m].thickness : 0;
    }
}

enum rc_status
stress_report_plan(struct tool *t, struct report *r, const struct rc_grid *p,
                   const struct rc_stress_options *o, const struct numbers *depths, size_t memory,
                   struct rc_err *err)
{
    struct plan plan;
    double seconds;

    if (expect(t, p, o, depths, memory, &seconds, err) != RC_OK)
        return RC_FAIL;
    plan = plan_begin(t, r, p, rc_grid_case(p), rc_boundary_word(o->boundary), "");
    plan_say(&plan, "depths", "%zu, %g to %g m", depths->n, depths->v[0], depths->v[depths->n - 1]);
    say_materials(&plan, o, depths);
    plan_say(&plan, "kernel", "%s", engine_of(o));
    plan_effects(&plan, effects_of(o));
    plan_end(&plan, NAN, seconds, memory);
    return RC_OK;
}
