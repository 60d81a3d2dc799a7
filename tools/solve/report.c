/* What rc-solve tells about a solution, or about one that it is to make. */
#include "solve.h"

#include <errno.h>
#include <math.h>
#include <string.h>

/* clang-format off */
const struct solve_frame_kind solve_frames[SOLVE_FRAMES] = {
    [SOLVE_PRESSURE] = {"pressure", "Pa"},
    [SOLVE_GAP] = {"gap", "m"},
    [SOLVE_DISPLACEMENT] = {"displacement", "m"},
    [SOLVE_HEIGHT] = {"height", "m"},
    [SOLVE_PLASTIC] = {"plastic", "m"},
};
/* clang-format on */

const char *
solve_frame_word(size_t k)
{
    return k < SOLVE_FRAMES ? solve_frames[k].name : NULL;
}

/* ---- effects ---- */

/* What a state depends on: the run, why the engine was taken, and whether the hardness was reached
 * (NULL: not known before the solution). */
struct scene {
    const struct run *run;
    const char *engine;
    const bool *hardness_active;
};

static const char *
kernel_state(const struct scene *s)
{
    return s->engine;
}

static const char *
hardness_state(const struct scene *s)
{
    if (isinf(s->run->args->physics.hardness))
        return "left out: no --hardness";
    if (s->hardness_active == NULL)
        return "on where the elastic pressure would exceed it; costs nothing elsewhere";
    return *s->hardness_active ? "on" : "left out: the largest elastic pressure is below it";
}

static const char *
sphere_state(const struct scene *s)
{
    return isnan(s->run->args->physics.radius) ? "left out: no --radius" : "on";
}

static const char *
padding_state(const struct scene *s)
{
    return s->run->args->physics.periodic ? "left out: the map is periodic" : "on";
}

static const char *
approach_state(const struct scene *s)
{
    return s->run->args->physics.approach.n > 0 ? "on" : "left out: the load is given";
}

static const char *
history_state(const struct scene *s)
{
    if (!s->run->args->physics.history)
        return "left out: no --history";
    return "on: each load acts on the shape that those before have left";
}

static const char *
stiffness_state(const struct scene *s)
{
    return s->run->stiffness ? "on" : "left out: one load and no --stiffness";
}

static const char *
discretization_state(const struct scene *s)
{
    if (!s->run->args->discretization)
        return "left out: no --discretization";
    return s->run->resumed ? "left out: resumed, no coarser grid was solved" : "on";
}

static const struct effect {
    const char *name;
    const char *(*state)(const struct scene *scene);
} effects[] = {
    {"kernel", kernel_state},       {"hardness", hardness_state},
    {"sphere", sphere_state},       {"padding", padding_state},
    {"approach", approach_state},   {"history", history_state},
    {"stiffness", stiffness_state}, {"discretization", discretization_state},
};

enum {
    EFFECTS = sizeof effects / sizeof *effects
};

/* Effect k, and after these the frames of --output: `on`, or why it is left out. False past the
 * last. */
static bool
effect_at(const struct scene *scene, size_t k, const char **name, const char **state)
{
    if (k >= EFFECTS + SOLVE_FRAMES)
        return false;
    if (k < EFFECTS) {
        *name = effects[k].name;
        *state = effects[k].state(scene);
    } else {
        *name = solve_frames[k - EFFECTS].name;
        *state =
            solve_wanted(scene->run->args, (int)(k - EFFECTS)) ? "on" : "left out: not in --output";
    }
    return true;
}

/* ---- report ---- */

static void
report_discretization(struct json *j, const struct rc_contact *c)
{
    if (isnan(c->discretization.max_pressure)) {
        json_null(j, "discretization_error_estimate");
        return;
    }
    json_object(j, "discretization_error_estimate");
    json_number(j, "contact_area", c->discretization.contact_area);
    json_number(j, "max_pressure", c->discretization.max_pressure);
    json_number(j, "approach", c->discretization.approach);
    json_end(j, '}');
}

static void
report_figures(struct json *j, const struct solution *s)
{
    const struct rc_contact *c = &s->contact;

    json_number(j, "load", c->load);
    json_number(j, "mean_pressure", c->mean_pressure);
    json_number(j, "max_pressure", c->max_pressure);
    json_count(j, "contact_nodes", c->contact_nodes);
    json_number(j, "nodes_per_patch", (double)c->contact_nodes / (double)s->patches);
    json_number(j, "contact_area", c->contact_area);
    json_number(j, "contact_fraction", c->contact_fraction);
    json_number(j, "plastic_area", c->plastic_area);
    json_number(j, "yielded_area", c->yielded_area);
    json_number(j, "edge_load_fraction", c->edge_load_fraction);
    json_number(j, "approach", c->approach);
    json_number(j, "mean_gap", c->mean_gap);
    json_number(j, "stiffness", s->stiffness);
    json_count(j, "iterations", c->iterations);
    json_number(j, "convolutions", c->convolutions);
    json_number(j, "kkt_residual", c->kkt_residual);
    json_number(j, "pressure_error_estimate", c->pressure_error);
    report_discretization(j, c);
    json_bool(j, "converged", c->converged);
}

void
solve_report(struct run *run, const struct rc_grid *g, const struct rc_solver *solver,
             const struct solution *s)
{
    struct scene scene = {run,
                          solver == NULL ? "left out: no load" : rc_solver_engine_reason(solver),
                          &s->contact.hardness_active};
    const char *name, *state;
    struct json j;

    if (run->args->report == NULL)
        return;
    if (run->report == NULL && (run->report = fopen(run->args->report, "w")) == NULL)
        tool_die(&run->t, EXIT_IMPOSSIBLE, "--report %s: %s", run->args->report, strerror(errno));
    json_open(&j, run->report);
    json_count(&j, "case", run->number);
    json_text(&j, "source", rc_grid_get(g, "source"));
    json_count(&j, "nx", g->nx);
    json_count(&j, "ny", g->ny);
    json_number(&j, "dx", g->dx);
    json_number(&j, "dy", g->dy);
    json_text(&j, "boundary", run->args->physics.periodic ? "periodic" : "free");
    json_text(&j, "kernel", solver == NULL ? NULL : rc_solver_engine(solver));
    json_text(&j, "method", solver == NULL ? NULL : rc_solver_method(solver));
    json_count(&j, "threads", run->t.threads);
    report_figures(&j, s);
    json_object(&j, "effects");
    for (size_t k = 0; effect_at(&scene, k, &name, &state); k++)
        json_text(&j, name, state);
    json_end(&j, '}');
    json_object(&j, "seconds");
    json_number(&j, "setup", run->setup);
    json_number(&j, "iterate", run->iterate);
    json_number(&j, "result", run->result);
    json_number(&j, "total", solve_now() - run->began);
    json_end(&j, '}');
    json_count(&j, "peak_memory", tool_peak_memory());
    json_close(&j);
    if (ferror(run->report))
        tool_die(&run->t, EXIT_IMPOSSIBLE, "--report %s: writing failed", run->args->report);
}

/* ---- plan ---- */

void
solve_plan(struct run *run, const struct rc_grid *g, const struct rc_problem *problem)
{
    enum {
        STIFFNESS = 12 /* convolutions that it takes */
    };
    struct rc_shape shape = rc_grid_shape(g);
    struct scene scene = {.run = run};
    const char *engine = rc_solver_choice(&shape, problem, &scene.engine), *name, *state;
    struct rc_expected e;
    struct rc_err err;
    double each;
    char where[256];

    if (rc_solver_expect(&shape, problem, &e, &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    each = e.convolutions + (run->stiffness ? STIFFNESS : 0);
    tool_where(&run->t, g, where, sizeof where);
    fprintf(run->t.out, "%s: %zu x %zu nodes, %zu %s, engine %s\n", where, g->nx, g->ny,
            run->steps->n, run->steps->n == 1 ? "load" : "loads", engine);
    for (size_t k = 0; effect_at(&scene, k, &name, &state); k++)
        fprintf(run->t.out, "  %-15s %s\n", name, state);
    fprintf(run->t.out, "  about %.0f convolutions%s, %zu MiB, %.2g s with %zu threads\n", each,
            run->steps->n > 1 ? " for the first load, fewer for the next" : "",
            (e.memory >> 20) + 1, e.seconds * each / e.convolutions * (double)run->steps->n,
            run->t.threads);
}
