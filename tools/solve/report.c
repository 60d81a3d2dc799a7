/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Report of a solution, and plan of --dry-run. */
#include "solve.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- effects ---- */

static bool
is_active(const struct run *run, const struct effect *row)
{
    const struct effect *const *e = run->active;

    while (*e != NULL && *e != row)
        e++;
    return *e != NULL;
}

static bool
is_effect(const char *name)
{
    size_t k = 0;

    while (solve_effects[k] != NULL &&
           (solve_effects[k]->name == NULL || strcmp(solve_effects[k]->name, name) != 0))
        k++;
    return solve_effects[k] != NULL;
}

/* Each effect and each frame of --output with its state. engine: the reason for the engine. */
static const struct effect_state *
effects_of(struct run *run, const char *engine)
{
    static struct effect_state list[64];
    size_t n = 0;

    list[n++] = (struct effect_state){"kernel", engine};
    for (size_t k = 0; solve_effects[k] != NULL; k++) {
        const struct effect *e = solve_effects[k];
        if (e->name != NULL)
            list[n++] = (struct effect_state){e->name, !is_active(run, e) && e->off != NULL ? e->off
                                                       : e->state != NULL ? e->state(run)
                                                                          : "on"};
    }
    for (size_t f = 0; solve_frames[f] != NULL; f++)
        if (!is_effect(solve_frames[f])) /* otherwise its state is there already */
            list[n++] = (struct effect_state){
                solve_frames[f], solve_wanted(run->args, f) ? "on" : "left out: not in --output"};
    assert(n < sizeof list / sizeof *list);
    list[n] = (struct effect_state){NULL, NULL};
    return list;
}

/* ---- report ---- */

#define FIGURE(column, member) RC_FIGURE_AS(column, struct solution, member)
const struct rc_figure solve_figures[] = {
    {FIGURE("nodes_per_patch", nodes_per_patch), NULL, "Nodes per patch", .role = RC_FIGURE_CHECK},
    {FIGURE("contact_area_corrected", patches.contact_area_corrected), "m2",
     "Contact area, corrected"},
    {FIGURE("contact_radius", contact_radius), "m", "Contact radius"},
    {FIGURE("stiffness", stiffness), "N/m", "Stiffness"},
    {FIGURE("indentation", indentation), "m", "Indentation"},
    {FIGURE("residual_indentation", residual_indentation), "m", "Residual indentation"},
    {FIGURE("contact_area_inside", inside_area), "m2", "Contact area inside the taper"},
    {FIGURE("contact_fraction_inside", inside_fraction), NULL, "Contact fraction inside the taper"},
    {0},
};

/* Reports the largest patches; `rc-info --patches` lists all. */
static void
report_patches(struct report *r, const struct rc_patches *patches)
{
    report_object(r, "patches");
    report_count(r, "count", patches->count, NULL);
    report_number(r, "perimeter", patches->perimeter, "m");
    report_array(r, "largest_areas");
    for (size_t k = 0; k < patches->listed; k++)
        report_number(r, NULL, patches->patch[k].area, "m2");
    report_end(r);
    report_end(r);
}

void
solve_report_named(struct report *r, const struct run *run, const char *names)
{
    struct solution row = run->solution;
    const struct figures from[] = {
        {rc_figures("contact"), &row.contact}, {solve_figures, &row}, {NULL, NULL}};

    row.nodes_per_patch = (double)row.contact.contact_nodes / (double)row.patches.count;
    report_named(r, from, names);
}

static const char of_contact[] =
    "load mean_pressure max_pressure contact_nodes nodes_per_patch contact_area "
    "contact_area_corrected "
    "contact_fraction plastic_area yielded_area edge_load_fraction approach mean_gap stiffness "
    "iterations "
    "convolutions kkt_residual pressure_error_estimate contact_area_error_estimate "
    "max_pressure_error_estimate approach_error_estimate converged";

/* "1e-06,1e+11,0.3; ...": the layers in SI, top first. NULL: no layers. */
static char *
layers_text(const struct physics *a)
{
    size_t size = 1;
    char *text;

    for (size_t k = 0; k < a->layer.n; k++)
        size += strlen(a->layer.step[k].text) + 2;
    if (a->layer.n == 0 || (text = malloc(size)) == NULL)
        return NULL;
    *text = '\0';
    for (size_t k = 0; k < a->layer.n; k++) {
        strcat(text, k > 0 ? "; " : "");
        strcat(text, a->layer.step[k].text);
    }
    return text;
}

/* Reports the values of the command line, so that rows of equal settings agree to the last digit. */
static void
report_asked(struct report *r, const struct run *run, const struct rc_model *m,
             const struct rc_solver *solver)
{
    const struct physics *a = run->physics;
    const double step = run->steps->v[run->step];
    const struct rc_body *one = &a->pair.one;
    RC_OWNED char *layers = layers_text(a);
    struct rc_progress at = {.tol = NAN};

    if (solver != NULL) {
        rc_solver_progress(solver, &at);
    } else {
        struct rc_loops loops;
        rc_model_progress(m, &loops);
        at.tol = loops.tol;
    }
    report_number(r, "estar", one->layers > 0 ? NAN : a->surface_estar, "Pa");
    report_number(r, "e1", isinf(a->e1) ? NAN : a->e1, "Pa");
    report_number(r, "nu1", a->nu1, NULL);
    report_number(r, "e2", isinf(a->e2) ? NAN : a->e2, "Pa");
    report_number(r, "nu2", isinf(a->e2) ? NAN : a->nu2, NULL);
    report_number(r, "hardness", isinf(a->hardness) ? NAN : a->hardness, "Pa");
    report_number(r, "radius", a->radius, "m");
    report_text(r, "layers", layers);
    report_number(r, "tol", at.tol, NULL);
    const bool listed = !solve_pulls_off(run);

    report_number(r, "asked_load",
                  listed && a->load.n > 0 ? physics_problem(a, run->g, run->step).load : NAN, "N");
    report_number(r, "asked_mean_pressure", listed && a->mean_pressure.n > 0 ? step : NAN, "Pa");
    report_number(r, "asked_approach", listed && a->approach.n > 0 ? step : NAN, "m");
}

/* The columns of effects at this place. */
static void
report_columns_at(struct report *r, const struct run *run, enum solve_place place)
{
    for (size_t k = 0; solve_effects[k] != NULL; k++) {
        const struct effect *e = solve_effects[k];
        if (e->report != NULL && e->place == place && (e->columns || is_active(run, e)))
            e->report(r, run);
    }
}

void
solve_report(struct drive *d, const struct rc_model *m)
{
    struct run *run = (struct run *)(void *)d;
    const struct rc_solver *solver = run->apart ? NULL : run->solver;
    const struct effect *by = SOLVE_FIRST(run, method);
    const struct solution *s = &run->solution;
    struct report *r = &d->report;

    report_map(r, run->g, run->d.course.number);
    boundary_report(r, run->g, run->physics->boundary);
    report_text(r, "kernel", solver == NULL ? NULL : rc_solver_engine(solver));
    report_text(r, "method",
                solver != NULL ? rc_solver_method(solver)
                : by != NULL   ? by->method
                               : NULL);
    report_count(r, "threads", run->d.t.threads, NULL);
    solve_report_named(r, run, of_contact);
    if (rc_repeats(run->physics->boundary) == 1)
        report_number(r, "load_per_metre", s->contact.load / physics_width(run->physics, run->g),
                      "N/m");
    report_patches(r, &s->patches);
    report_effects(r, effects_of(run, solver != NULL ? rc_solver_engine_reason(solver)
                                      : by != NULL   ? by->engine
                                                     : "left out: no load"));
    report_seconds(r,
                   (const struct report_phase[]){{"setup", run->d.is.setup},
                                                 {"iterate", run->d.course.iterate},
                                                 {"result", run->result},
                                                 {NULL, 0}},
                   run->done - run->d.is.began);
    report_memory(r);
    report_ranks(r, &run->d.t);
    /* the columns stay the same for all cases */
    report_columns_at(r, run, COLUMNS_OF_BOUNDS);
    report_asked(r, run, m, solver);
    report_columns_at(r, run, COLUMNS_OF_BODIES);
    report_columns_at(r, run, COLUMNS_OF_VOLUME);
    errors_report(r, &s->errors);
    report_columns_at(r, run, COLUMNS_OF_GAP);
    report_number(r, "rms_slope", run->rms_slope, NULL);
    report_number(r, "elastic_energy", s->contact.elastic_energy, "J");
    report_columns_at(r, run, COLUMNS_OF_POINTS);
    report_columns_at(r, run, COLUMNS_LAST);
    report_number(r, "cylinder", run->physics->cylinder, "m");
    for (size_t k = 0; solve_effects[k] != NULL; k++)
        if (solve_effects[k]->report_last != NULL && is_active(run, solve_effects[k]))
            solve_effects[k]->report_last(r, run);
    report_number(r, "contact_radius", s->contact_radius, "m");
    SOLVE_EACH (run, e, report_end)
        e->report_end(r, run);
}

/* ---- cost ---- */

/* The expected cost of a point. */
static enum rc_status
expect(struct run *run, const struct rc_problem *problem, struct rc_expected *expected,
       struct rc_err *err)
{
    const struct effect *by = SOLVE_FIRST(run, expect);

    return by != NULL ? by->expect(run, problem, expected, err)
                      : rc_solver_expect(rc_shape_of(run->g), problem, expected, err);
}

/* The bytes that a solution needs in addition to this map. */
static size_t
memory_of(struct run *run, const struct rc_problem *problem)
{
    const size_t small = 2 << 20; /* blocks whose size does not grow with the map; measured */
    const struct effect *by = SOLVE_FIRST(run, memory);
    size_t maps = 0, later = sizeof *run->g->v;
    struct rc_expected expected = {0};
    struct rc_err err;

    if (by != NULL)
        return by->memory(run, problem);
    (void)expect(run, problem, &expected, &err);
    SOLVE_EACH (run, e, bytes)
        maps += e->bytes(run);
    SOLVE_EACH (run, e, later)
        later = e->later > later ? e->later : later;
    return expected.memory + small + (maps + later) * rc_grid_nodes(run->g);
}

struct demand {
    struct run *run;
    const struct rc_problem *problem;
};

static size_t
memory_by(const void *ctx, const char *engine)
{
    const struct demand *d = ctx;
    struct rc_problem problem = *d->problem;

    problem.engine = engine;
    return memory_of(d->run, &problem);
}

void
solve_demand_memory(struct run *run, const struct rc_problem *problem)
{
    const struct demand d = {run, problem};

    if (SOLVE_FIRST(run, memory) ==
        NULL) /* the message names another engine if the map would fit */
        run->d.t.remedy =
            tool_leaner_engine(&run->d.t, rc_repeats(problem->boundary) > 0, memory_by, &d);
    tool_demand_memory(&run->d.t, run->g, memory_of(run, problem));
    run->d.t.remedy = NULL;
}

void
solve_plan(struct run *run, const struct rc_problem *problem)
{
    const struct rc_grid *g = run->g;
    struct rc_shape shape = rc_grid_shape(g);
    const char *why = NULL, *engine = rc_solver_choice(&shape, problem, &why);
    const struct effect *points = SOLVE_FIRST(run, noun), *loads_by = SOLVE_FIRST(run, loads),
                        *plan_by = SOLVE_FIRST(run, plan);
    struct rc_expected e;
    struct plan plan;
    char what[128];
    const size_t before = course_peak(0); /* the forecast takes memory of its own */
    double each, memory, loads;

    if (plan_by != NULL)
        plan_by->plan(run, problem, &e);
    else
        tool_must(&run->d.t, g, expect(run, problem, &e, &run->d.t.err));
    loads = loads_by != NULL ? loads_by->loads(run) : (double)run->cases;
    each = e.convolutions;
    SOLVE_EACH (run, more, work)
        each += more->work(run);
    memory = ranks_most(&run->d.t, (double)before + (double)memory_of(run, problem));
    snprintf(what, sizeof what, ", %zu %s%s, engine %s", run->cases,
             points != NULL ? points->noun : "load", run->cases == 1 ? "" : "s", engine);
    plan = plan_begin(&run->d.t, &run->d.report, g, rc_grid_case(g),
                      rc_boundary_word(run->physics->boundary), what);
    plan_effects(&plan, effects_of(run, why));
    plan_end(&plan, each * loads,
             course_seconds(g, e.seconds * each / e.convolutions * loads, run->cases),
             (size_t)memory);
}
