/* Report of a solution, and plan of --dry-run. */
#include "solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const solve_frames[] = {
    [SOLVE_CONTACT] = CONTACT_CHANNEL,
    [SOLVE_PRESSURE] = "pressure",
    [SOLVE_GAP] = "gap",
    [SOLVE_DISPLACEMENT] = "displacement",
    [SOLVE_HEIGHT] = "height",
    [SOLVE_PLASTIC] = "plastic",
    [SOLVE_RESIDUAL] = "residual",
    [SOLVE_STRAIN] = "strain",
    [SOLVE_ADHESION] = "adhesion",
    [SOLVE_FRAMES] = NULL,
};

/* ---- effects ---- */

static const char *
layers_state(const struct run *run)
{
    static char text[64];
    size_t n = run->args->physics.pair.one.layers;

    if (n == 0)
        return "left out: one material";
    snprintf(text, sizeof text, "on: %zu on a substrate", n);
    return text;
}

static const char *
hardness_state(const struct run *run, const bool *active)
{
    if (isinf(run->hardness_min))
        return run->hardness != NULL
                   ? "left out: the map of hardness holds no number"
                   : "left out: no --hardness, and no map of hardness in the case";
    if (active == NULL)
        return "on where the elastic pressure would exceed it; costs nothing elsewhere";
    return *active ? "on" : "left out: the largest elastic pressure is below it";
}

/* Shows each effect and each frame of --output with its state: `on`, or why it is left out. engine: the
 * reason for the engine. active: whether the hardness was reached (NULL: unknown before the solution). */
static void
show_effects(struct run *run, const char *engine, const bool *active,
             void (*show)(struct run *run, const char *name, const char *state))
{
    const struct solve_args *args = run->args;
    const struct physics *a = &args->physics;
    const char *const effects[][2] = {
        {"kernel", engine},
        {"layers", layers_state(run)},
        {"hardness", hardness_state(run, active)},
        {"sphere", isnan(a->radius) ? "left out: no --radius" : "on"},
        {"padding", a->periodic ? "left out: the map is periodic" : "on"},
        {"approach", a->approach.n > 0 ? "on" : "left out: the load is given"},
        {"history", a->history ? "on: each load acts on the shape after the previous load"
                               : "left out: no --history"},
        {"yield", yield_state(run)},
        {"adhesion", adhesion_state(run)}, /* also the state of its frame */
        {"travel", travel_state(run)},
        {"relaxation", relax_state(run)},
        {"sliding", slide_state(run)},
        {"tilt", run->tilt ? "on" : "left out: no --tilt free"},
        {"stiffness", run->stiffness         ? "on"
                      : run->adhering.wanted ? "left out: the bodies attract each other"
                                             : "left out: one load and no --stiffness"},
        {"conductivity", args->conductivity == NULL ? "left out: no --conductivity"
                         : run->conductance         ? "on"
                                            : "left out: layers, for which no analogy holds"},
        {"discretization", !args->discretization   ? "left out: no --discretization"
                           : run->d.course.resumed ? "left out: resumed, no coarser grid was solved"
                                                   : "on"},
    };

    for (size_t k = 0; k < sizeof effects / sizeof *effects; k++)
        show(run, effects[k][0], effects[k][1]);
    for (int f = 0; f < SOLVE_ADHESION; f++)
        show(run, solve_frames[f], solve_wanted(args, f) ? "on" : "left out: not in --output");
}

static void
report_effect(struct run *run, const char *name, const char *state)
{
    report_text(&run->d.report, name, state);
}

static void
print_effect(struct run *run, const char *name, const char *state)
{
    fprintf(run->d.t.out, "  %-15s %s\n", name, state);
}

/* ---- report ---- */

#define FIGURE(column, member) RC_FIGURE_AS(column, struct solution, member)
static const struct rc_figure solution_figures[] = {
    {FIGURE("nodes_per_patch", nodes_per_patch), NULL, "Nodes per patch"},
    {FIGURE("contact_area_corrected", patches.contact_area_corrected), "m2",
     "Contact area, corrected"},
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
    enum {
        LARGEST = 10
    };

    report_object(r, "patches");
    report_count(r, "count", patches->count, NULL);
    report_number(r, "perimeter", patches->perimeter, "m");
    report_array(r, "largest_areas");
    for (size_t k = 0; k < patches->count && k < LARGEST && patches->patch != NULL; k++)
        report_number(r, NULL, patches->patch[k].area, "m2");
    report_end(r);
    report_end(r);
}

/* Reports the figures with these names. */
static void
report_of(struct report *r, const struct solution *s, const char *names)
{
    struct solution row = *s;
    const struct figures from[] = {
        {rc_figures("contact"), &row.contact}, {solution_figures, &row}, {NULL, NULL}};

    row.nodes_per_patch = (double)s->contact.contact_nodes / (double)s->patches.count;
    report_named(r, from, names);
}

static const char of_contact[] =
    "load mean_pressure max_pressure contact_nodes nodes_per_patch contact_area "
    "contact_area_corrected "
    "contact_fraction plastic_area yielded_area edge_load_fraction approach mean_gap stiffness "
    "iterations "
    "convolutions kkt_residual pressure_error_estimate discretization_error_estimate.contact_area "
    "discretization_error_estimate.max_pressure discretization_error_estimate.approach converged";
static const char of_history[] =
    "indentation residual_indentation contact_area_inside contact_fraction_inside";

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
report_asked(struct report *r, const struct run *run, const struct rc_solver *solver)
{
    const struct physics *a = &run->args->physics;
    const double step = run->steps->v[run->step];
    const struct rc_body *one = &a->pair.one;
    RC_OWNED char *layers = layers_text(a);
    struct rc_progress at = {.tol = NAN};

    if (solver != NULL)
        rc_solver_progress(solver, &at);
    report_number(r, "estar", one->layers > 0 ? NAN : a->surface_estar, "Pa");
    report_number(r, "e1", isinf(a->e1) ? NAN : a->e1, "Pa");
    report_number(r, "nu1", a->nu1, NULL);
    report_number(r, "e2", isinf(a->e2) ? NAN : a->e2, "Pa");
    report_number(r, "nu2", isinf(a->e2) ? NAN : a->nu2, NULL);
    report_number(r, "hardness", isinf(a->hardness) ? NAN : a->hardness, "Pa");
    report_number(r, "radius", a->radius, "m");
    report_text(r, "layers", layers);
    report_number(r, "tol", at.tol, NULL);
    report_number(r, "asked_load", a->load.n > 0 ? step : NAN, "N");
    report_number(r, "asked_mean_pressure", a->mean_pressure.n > 0 ? step : NAN, "Pa");
    report_number(r, "asked_approach", a->approach.n > 0 ? step : NAN, "m");
}

void
solve_report(struct drive *d, const struct rc_model *m)
{
    struct run *run = (struct run *)(void *)d;
    const struct rc_solver *solver = run->apart ? NULL : run->solver;
    const struct solution *s = &run->solution;
    const char *engine = solver != NULL         ? rc_solver_engine_reason(solver)
                         : run->adhering.wanted ? "the gap is found by transforms"
                                                : "left out: no load";
    struct report *r = &d->report;

    (void)m;
    report_map(r, run->g, run->d.course.number);
    report_text(r, "boundary", run->args->physics.periodic ? "periodic" : "free");
    report_text(r, "kernel", solver == NULL ? NULL : rc_solver_engine(solver));
    report_text(r, "method",
                solver != NULL         ? rc_solver_method(solver)
                : run->adhering.wanted ? "gap"
                                       : NULL);
    report_count(r, "threads", run->d.t.threads, NULL);
    report_of(r, s, of_contact);
    report_patches(r, &s->patches);
    report_object(r, "effects");
    show_effects(run, engine, &s->contact.hardness_active, report_effect);
    report_end(r);
    report_object(r, "seconds");
    report_number(r, "setup", run->d.setup, "s");
    report_number(r, "iterate", run->d.course.iterate, "s");
    report_number(r, "result", run->result, "s");
    report_number(r, "total", run->done - run->d.began, "s");
    report_end(r);
    report_memory(r);
    report_ranks(r, &run->d.t);
    /* the columns stay the same for all cases */
    report_number(r, "hardness_min", run->hardness_min, "Pa");
    report_number(r, "hardness_max", run->hardness_max, "Pa");
    report_number(r, "conductance", s->conductance.value, run->conductance_unit);
    report_number(r, "conductance_lower", s->conductance.lower, run->conductance_unit);
    report_asked(r, run, solver);
    report_of(r, s, of_history);
    report_number(r, "tilt_x", run->tilt ? atan(s->contact.tilt[0]) : NAN, "rad");
    report_number(r, "tilt_y", run->tilt ? atan(s->contact.tilt[1]) : NAN, "rad");
    yield_report(r, run);
    errors_report(r, &s->errors);
    adhesion_report(r, run);
    report_number(r, "rms_slope", run->rms_slope, NULL);
    report_number(r, "elastic_energy", s->contact.elastic_energy, "J");
    travel_report(r, run);
    relax_report(r, run);
}

/* ---- plan ---- */

/* The expected cost of a load, a time or a speed, of bodies that neither yield nor attract each other. */
static enum rc_status
expect(const struct run *run, const struct rc_grid *g, const struct rc_problem *problem,
       struct rc_expected *expected, struct rc_err *err)
{
    const bool approach = problem->approach > 0;
    struct rc_point to = {0};

    if (!run->relaxing.wanted && !run->sliding.wanted)
        return rc_solver_expect(rc_shape_of(g), problem, expected, err);
    rc_point_set(&to, approach ? RC_APPROACH : RC_LOAD,
                 approach ? problem->approach : problem->load);
    rc_point_set(&to, run->sliding.wanted ? RC_SPEED : RC_TIME,
                 run->sliding.wanted ? slide_speed(run, 0) : 0);
    return rc_model_plan(run->model, &to, expected, err);
}

size_t
solve_memory(const struct run *run, const struct rc_grid *g, const struct rc_problem *problem)
{
    const size_t dents = run->args->physics.history && !isinf(run->hardness_min) ? sizeof *g->v : 0;
    const size_t small = 2 << 20; /* blocks whose size does not grow with the map; measured */
    const size_t later = run->conductance
                             ? RC_CONDUCTANCE_BYTES /* the map of patches is freed before */
                         : run->stiffness ? RC_STIFFNESS_BYTES
                                          : sizeof *g->v;
    struct rc_expected expected = {0};
    struct rc_point to = {0};
    struct rc_err err;

    rc_point_set(&to, RC_LOAD, problem->load);
    if (run->yielding.wanted)
        (void)rc_model_plan(run->model, &to, &expected, &err);
    else
        (void)expect(run, g, problem, &expected, &err);
    return expected.memory + small + (dents + later + travel_bytes(run)) * rc_grid_nodes(g);
}

void
solve_plan(struct run *run, const struct rc_grid *g, const struct rc_problem *problem)
{
    enum {
        STIFFNESS = 6 /* convolutions for the stiffness */
    };
    struct rc_shape shape = rc_grid_shape(g);
    const char *why = NULL, *engine = rc_solver_choice(&shape, problem, &why);
    struct rc_expected e;
    const bool travels = run->travelling.wanted;
    const bool relaxes = run->relaxing.wanted;
    const bool slides = run->sliding.wanted;
    const size_t points = travels   ? travel_points(run)
                          : relaxes ? run->args->time.n
                          : slides  ? slide_points(run)
                                    : run->steps->n;
    /* work over that of the first point: of a position, of a later load with adhesion, of a retraction */
    const double step = 0.8, next = 1.5, retraction = 60;
    const size_t before = course_peak(0); /* the forecast takes memory of its own */
    double each, memory, loads = (double)points;

    if (travels)
        loads = 1 + step * (loads - 1);
    if (run->adhering.wanted) {
        adhesion_expect(run, g, problem, &e);
        loads = 1 + next * (loads - 1) + (run->args->pull_off ? retraction : 0);
    } else if (run->yielding.wanted)
        loads = yield_expect(run, problem->load, &e);
    else
        tool_must(&run->d.t, g, expect(run, g, problem, &e, &run->d.t.err));
    each = e.convolutions + (run->conductance ? STIFFNESS + 1 : 0) +
           (run->stiffness && !(run->conductance && isinf(run->hardness_min)) ? STIFFNESS : 0);
    memory = ranks_most(&run->d.t, (double)before + (double)(run->adhering.wanted
                                                                 ? adhesion_memory(run, g, problem)
                                                                 : solve_memory(run, g, problem)));
    fprintf(run->d.t.out, "%s: %zu x %zu nodes, %zu %s%s, engine %s\n", tool_where(&run->d.t, g),
            g->nx, g->ny, points,
            travels   ? "position"
            : relaxes ? "time"
            : slides  ? "speed"
                      : "load",
            points == 1 ? "" : "s", engine);
    show_effects(run, why, NULL, print_effect);
    fprintf(run->d.t.out, "  about %.0f convolutions%s, %zu MiB, %.2g s with %zu threads\n", each,
            points == 1 ? ""
            : relaxes   ? " for each time"
            : slides    ? " for the first speed"
            : travels   ? " for the first position, 5 for the next after a short step"
                        : " for the first load, fewer for the next",
            ((size_t)memory >> 20) + 1,
            course_seconds(&run->d.t, g, e.seconds * each / e.convolutions * loads, points),
            run->d.t.threads);
}
