/* A case of rc-solve: solves its loads one after another, finds their figures and writes their frames. */
#include "solve.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

/* Key of a shape after yield: its possible error, m. */
#define HEIGHT_ERROR "height.error"

/* ---- one case ---- */

/* Returns the fraction of the tolerance for a load at which nodes yield. The error of its shape stays for
 * later loads, and relative to a smaller load it is larger: the sum stays within the tolerance. 0: no load
 * changes the shape. */
static double
history_part(const struct run *run)
{
    const struct numbers *steps = run->steps;
    /* the load grows at most with this power of the approach */
    const double power = run->args->physics.approach.n > 0 ? 2 : 1;
    double most = 0, smallest = 1;

    if (!run->args->physics.history || run->yielding.wanted || isinf(run->hardness_min) ||
        steps->n < 2)
        return 0;
    for (size_t k = 0; k < steps->n; k++) {
        most = fmax(most, steps->v[k]);
        if (steps->v[k] > 0)
            smallest = fmin(smallest, steps->v[k] / most);
    }
    return pow(smallest, power) / fmax(10, (double)steps->n);
}

static struct rc_problem
problem_of(struct run *run, const struct rc_grid *g, size_t step)
{
    struct rc_problem problem = physics_problem(&run->args->physics, g, step);

    problem.tol = run->args->tol;
    problem.history_part = history_part(run);
    problem.engine = run->args->kernel;
    problem.method = run->args->method;
    problem.threads = run->t.threads;
    problem.ranks = ranks_of(&run->t);
    problem.hurry = tool_signal();
    problem.discretization = run->args->discretization;
    problem.tilt_free = run->tilt;
    for (size_t k = 0; k < run->args->at.n; k++)
        problem.force_at[k] = run->args->at.v[k];
    problem.height_error = run->height_error;
    problem.hardness_map = run->hardness != NULL ? run->hardness->v : NULL;
    return problem;
}

/* ---- marks of a checkpoint ---- */

static void
number_mark(struct mark *m, const char *name, double value)
{
    m->name = name;
    rc_number_text(m->value, value);
}

static void
set_marks(struct run *run)
{
    const struct physics *args = &run->args->physics;
    struct mark *mark = run->course.mark;
    size_t n = 6;

    if (run->checkpoint == NULL)
        return;
    mark[0].name = "checkpoint.surface";
    snprintf(mark[0].value, sizeof mark[0].value, "%s", run->crc);
    mark[1].name = "boundary";
    snprintf(mark[1].value, sizeof mark[1].value, "%s", args->periodic ? "periodic" : "free");
    number_mark(&mark[2], "estar", args->estar);
    number_mark(&mark[3], "checkpoint.hardness", args->hardness);
    if (run->hardness != NULL)
        snprintf(mark[3].value, sizeof mark[3].value, "map %s", run->hardness_crc);
    number_mark(&mark[4],
                args->load.per_metre        ? "checkpoint.load-per-metre"
                : args->load.n > 0          ? "checkpoint.load"
                : args->mean_pressure.n > 0 ? "checkpoint.mean-pressure"
                                            : "checkpoint.approach",
                run->steps->v[run->step]);
    mark[5].name = "checkpoint.history"; /* earlier loads, which have changed the shape */
    snprintf(mark[5].value, sizeof mark[5].value, "%08" PRIx32,
             !args->history ? 0
                            : rc_crc32_add(0, run->steps->v, run->step * sizeof *run->steps->v));
    for (int k = 0; k < YIELD_MARKS; k++, n++)
        mark[n].name = yield_mark(run, k, mark[n].value, sizeof mark[n].value);
    mark[n].name = "checkpoint.adhesion";
    adhesion_mark(run, mark[n].value, sizeof mark[n].value);
    run->course.marks = n + 1;
}

/* ---- results ---- */

/* Sets a key. If the number is unknown, removes the key, which may come from an earlier solution. */
static void
set_number(struct run *run, struct rc_grid *g, const char *name, double value)
{
    struct rc_err err;

    if ((isfinite(value) ? rc_grid_set_number(g, name, value, &err)
                         : rc_grid_set(g, name, NULL, &err)) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
}

static void
set_keys(struct run *run, struct rc_grid *g, const struct rc_contact *c)
{
    const struct rc_yield *law = &run->yielding.law;
    const bool yields = run->yielding.on;
    struct rc_err err;

    if (rc_grid_set(g, "boundary", run->args->physics.periodic ? "periodic" : "free", &err) !=
            RC_OK ||
        rc_grid_set(g, "converged", c->converged ? "yes" : "no", &err) != RC_OK ||
        bodies_set(g, &run->args->physics.pair, run->args->physics.residual, &err) != RC_OK ||
        rc_grid_history(g, tool_history(&run->t), &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    if (run->steps->n > 1 || run->args->pull_off)
        set_number(run, g, "case", (double)run->course.number);
    /* the requested and the reached load differ by rounding only */
    set_number(run, g, "load",
               run->args->physics.load.n > 0 ? problem_of(run, g, run->step).load : c->load);
    set_number(run, g, "hardness", run->args->physics.hardness);
    set_number(run, g, "approach", c->approach);
    /* slabs: a reader of the stream then expects the frames of plastic strain */
    set_number(run, g, "slabs", yields ? (double)run->yielding.found->slabs : NAN);
    set_number(run, g, "yield", yields ? rc_yield_stress(law, 0) : NAN);
    set_number(run, g, "hardening", yields ? yield_law_hardening(law) : NAN);
    adhesion_set_key(run, g, c);
}

static void
put_values(struct run *run, const struct rc_grid *as, enum solve_frame f, const double *v)
{
    struct rc_grid frame = *as; /* as the reader of the stream sees it */

    if (!solve_wanted(run->args, (int)f))
        return;
    frame.channel = (char *)solve_frames[f].name; /* tool_write only reads the strings and the
                                                     values */
    frame.unit = (char *)solve_frames[f].unit;
    frame.type = f == SOLVE_CONTACT ? RC_F32 : as->type; /* its values are 0 and 1 */
    frame.v = (double *)v;
    tool_write(&run->t, &frame);
}

/* Computes a frame of the model in the buffer and writes it. */
static void
put(struct run *run, struct rc_model *m, const struct rc_grid *as, enum solve_frame f,
    double *buffer)
{
    struct rc_err err;

    if (!solve_wanted(run->args, (int)f))
        return;
    if (rc_model_frame(m, solve_frames[f].name, buffer, &err) != RC_OK)
        tool_die_at(&run->t, as, EXIT_IMPOSSIBLE, "%s", err.text);
    put_values(run, as, f, buffer);
}

static void
put_out(struct run *run, const struct rc_grid *g, struct rc_model *m, const struct rc_contact *c)
{
    struct rc_err err;
    struct rc_grid *as = rc_grid_like(g, g->channel, g->unit, &err);
    /* the buffer is the input map if it is no longer needed; untouched pages of the new map take no memory */
    const bool last = run->step + 1 == run->steps->n && !run->args->physics.history;
    double *buffer = as == NULL                                       ? NULL
                     : solve_wanted(run->args, SOLVE_HEIGHT) || !last ? as->v
                                                                      : g->v;

    if (as == NULL)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    set_keys(run, as, c);
    for (int f = SOLVE_CONTACT; f <= SOLVE_DISPLACEMENT; f++)
        put(run, m, as, (enum solve_frame)f, buffer);
    as->type = g->type;
    put_values(run, as, SOLVE_HEIGHT, g->v);
    as->type = RC_F64;
    if (c->yielded_nodes > 0 && !run->adhering.wanted)
        set_number(run, as, HEIGHT_ERROR, c->shape_error);
    if (run->apart && !run->yielding.wanted) /* the shape has not changed */
        put_values(run, as, SOLVE_PLASTIC, g->v);
    else
        put(run, m, as, SOLVE_PLASTIC, buffer);
    if (run->yielding.wanted) {
        put(run, m, as, SOLVE_RESIDUAL, buffer);
        if (solve_wanted(run->args, SOLVE_STRAIN))
            yield_put_strain(run, m, as, buffer);
    }
    put(run, m, as, SOLVE_ADHESION, buffer);
    rc_grid_free(as);
}

/* ---- loads ---- */

/* In a history, gives the heights the shape after the load. */
static void
keep_shape(struct run *run, struct rc_grid *g, struct rc_model *m, struct solution *s)
{
    struct rc_err err;

    if (!run->args->physics.history)
        return;
    if (s->contact.yielded_nodes > 0) {
        if (rc_model_frame(m, "plastic", g->v, &err) != RC_OK)
            tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
        g->type = RC_F64;
        if (!run->adhering.wanted)
            set_number(run, g, HEIGHT_ERROR, s->contact.shape_error);
    }
    if (run->status != RC_MORE && rc_model_keep(m, &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    s->indentation = rc_model_number(m, "indentation");
    s->residual_indentation = rc_model_number(m, "residual_indentation");
}

/* Finds the contact inside the taper of a tapered map (key `taper`); touch is NULL for separated bodies. */
static void
look_inside(struct run *run, const struct rc_grid *g, const double *touch, struct solution *s)
{
    const struct rc_shape shape = rc_grid_shape(g);
    size_t columns, rows, first = tool_first_row(&run->t, g);
    double width, touching = 0, inside;

    s->inside_area = s->inside_fraction = NAN;
    if (!rc_grid_number(g, "taper", &width))
        return;
    rc_taper_frame(&shape, width, &columns, &rows);
    for (size_t k = 0; touch != NULL && k < rc_grid_nodes(g); k++) {
        size_t i = k % g->nx, j = first + k / g->nx;
        if (i >= columns && i + columns < g->nx && j >= rows && j + rows < g->ny &&
            rc_in_contact(touch[k]))
            touching++;
    }
    touching = ranks_sum(&run->t, touching);
    inside = (double)(g->nx - 2 * columns) * (double)(g->ny - 2 * rows);
    s->inside_area = touching * g->dx * g->dy;
    s->inside_fraction = inside > 0 ? touching / inside : NAN;
}

static void
look_at_contact(struct run *run, const struct rc_grid *g, const double *touch, struct solution *s)
{
    struct rc_shape shape = rc_grid_shape(g);
    struct rc_patch_options options = {.boundary =
                                           run->args->physics.periodic ? RC_PERIODIC : RC_FREE,
                                       .each = report_wanted(&run->report),
                                       .threads = run->t.threads,
                                       .ranks = ranks_of(&run->t)};
    struct rc_err err;

    if (rc_patches_find(&shape, touch, &options, &s->patches, &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    s->slope = rc_measure_contact_slope(ranks_of(&run->t), &shape, g->v, touch);
    look_inside(run, g, touch, s);
}

/* Finds the touching nodes from the gap, because the net pressure of an adhesive contact does not determine
 * them. */
static void
look_at_closed_gap(struct run *run, const struct rc_grid *g, struct rc_model *m, struct solution *s)
{
    double *touch = malloc(rc_grid_nodes(g) * sizeof *touch);
    struct rc_err err = {"out of memory for a map"};

    if (touch == NULL || rc_model_frame(m, CONTACT_CHANNEL, touch, &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    look_at_contact(run, g, touch, s);
    free(touch);
}

/* Takes the figures of all models, and the figures of this model. */
static void
look_at_model(struct run *run, const struct rc_grid *g, struct rc_model *m, struct solution *s)
{
    const struct rc_elastic_figures *elastic = rc_elastic_result(m);
    const struct rc_adhesive_figures *adhesive = rc_adhesive_result(m);
    struct rc_err err;

    if (rc_model_look(m, NULL, &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    yield_found(run, m);
    run->adhering.figures = adhesive != NULL ? &adhesive->adhesion : NULL;
    s->contact = elastic != NULL    ? elastic->contact
                 : adhesive != NULL ? adhesive->contact
                                    : rc_yielding_result(m)->contact;
    if (adhesive != NULL)
        look_at_closed_gap(run, g, m, s);
}

/* If no node is at the hardness, the computation of the conductance has found the stiffness too. */
static void
find_stiffness(struct run *run, const struct rc_grid *g, struct rc_solver *solver,
               struct solution *s)
{
    struct rc_err err;

    if (run->conductance &&
        rc_solver_conductance(solver, run->k[0], run->k[1], &s->conductance, &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    if (!run->stiffness)
        return;
    if (run->conductance && s->contact.plastic_nodes == 0)
        s->stiffness = s->conductance.stiffness;
    else if (rc_solver_stiffness(solver, &s->stiffness, &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
}

/* Finds the figures of this load, writes its frames and its row, and keeps its shape. */
static void
end_load(struct run *run, struct rc_grid *g, struct rc_model *m)
{
    struct solution solution = SOLUTION_NONE, *s = &solution;
    const double start = solve_now();

    if (run->apart)
        look_inside(run, g, NULL, s);
    else if (run->solver != NULL &&
             tool_interrupted() == 0) /* otherwise this grid may have no pressure yet */
        look_at_contact(run, g, rc_solver_pressure(run->solver), s);
    look_at_model(run, g, m, s);
    if (run->apart && run->conductance)
        s->conductance = (struct rc_conductance){NAN, 0, 0};
    if (run->solver != NULL && !run->apart) {
        find_stiffness(run, g, run->solver, s);
        s->contact.convolutions = rc_solver_convolutions(run->solver);
    }
    if (s->contact.inherited_error > 0)
        s->errors =
            (struct error_parts){.told = true,
                                 .inherited = s->contact.inherited_error,
                                 .contact = s->contact.pressure_error - s->contact.inherited_error};
    yield_look(run, s);
    run->done = solve_now();
    run->result = run->apart ? 0 : run->done - start;
    if (run->adhering.wanted)
        adhesion_judge(run, g, s);
    else
        solve_judge(run, g, s);
    if (!s->contact.converged && !run->apart)
        tool_fails_with(&run->t, EXIT_SHORT);
    put_out(run, g, m, &s->contact);
    keep_shape(run, g, m, s);
    solve_report(run, g, run->apart ? NULL : run->solver, s);
    rc_patches_free(&s->patches);
}

struct demand {
    const struct run *run;
    const struct rc_grid *g;
    const struct rc_problem *problem;
};

static size_t
memory_by(const void *ctx, const char *engine)
{
    const struct demand *d = ctx;
    struct rc_problem problem = *d->problem;

    problem.engine = engine;
    return solve_memory(d->run, d->g, &problem);
}

/* Demands the memory; the message names another engine if the map would fit with it. */
static void
demand_memory(struct run *run, const struct rc_grid *g, const struct rc_problem *problem)
{
    const struct demand d = {run, g, problem};

    run->t.remedy = tool_leaner_engine(&run->t, problem->boundary == RC_PERIODIC, memory_by, &d);
    tool_demand_memory(&run->t, g, solve_memory(run, g, problem));
    run->t.remedy = NULL;
}

static void
before_plan(struct run *run, const struct rc_grid *g, const struct rc_problem *problem)
{
    if (run->adhering.wanted)
        tool_demand_memory(&run->t, g, adhesion_memory(run, g, problem));
    else
        demand_memory(run, g, problem);
    if (run->done == 0)         /* no load has been solved */
        tool_release_signals(); /* making the plan takes long, and before its end there is no
                                   pressure to write */
}

static void
after_plan(struct run *run)
{
    tool_catch_signals();
    run->setup = solve_now() - run->began;
}

/* Leads the model to this load. The first load plans the solver. */
static void
press(struct run *run, const struct rc_grid *g, struct rc_model *m,
      const struct rc_problem *problem)
{
    const bool plans = run->adhering.wanted ? run->step == 0 && !run->adhering.pulling
                                            : !run->apart && rc_model_solver(m) == NULL;
    const bool approach = run->args->physics.approach.n > 0;
    struct course *c = &run->course;
    struct rc_point to = {0};

    rc_point_set(&to, approach ? RC_APPROACH : RC_LOAD,
                 run->apart ? 0
                 : approach ? problem->approach
                            : problem->load);
    if (run->adhering.pulling)
        rc_point_set(&to, RC_APPROACH, -INFINITY);
    c->g = g;
    c->checkpoint =
        (run->apart && !run->yielding.on) || run->adhering.pulling ? NULL : run->checkpoint;
    set_marks(run);
    if (plans)
        before_plan(run, g, problem);
    course_set(c, m, &to);
    if (plans)
        after_plan(run);
    run->status = course_run(c, m);
    run->iterate = c->iterate;
    run->solver = rc_model_solver(m);
}

/* Solves the loads of a list, each from the solution of the last one; in a history, on the shape after the
 * last one. --pull-off adds a case in which the bodies are separated. */
static void
do_loads(struct run *run, struct rc_grid *g)
{
    const struct rc_shape shape = rc_grid_shape(g);
    struct rc_problem problem = problem_of(run, g, 0);
    struct rc_err err;
    const size_t cases = run->steps->n + run->args->pull_off;
    struct rc_model *m = run->yielding.wanted ? yield_model(run, g, &problem)
                         : run->adhering.wanted
                             ? adhesion_model(run, g, &problem)
                             : rc_elastic_new(&shape, g->v, &problem, NULL, &err);

    if (m == NULL)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    run->model = m;
    run->course.number = cases == 1 ? rc_grid_case(g) - 1 : run->course.number;
    for (size_t k = 0; k < cases; k++) {
        if (k > 0 && tool_interrupted() != 0)
            break; /* the first case is always written */
        run->adhering.pulling = k == run->steps->n;
        run->step = run->adhering.pulling ? k - 1 : k;
        problem = problem_of(run, g, run->step);
        run->began = solve_now();
        run->setup = run->iterate = 0;
        run->course.number++;
        run->apart = run->steps->v[run->step] == 0 && !run->adhering.wanted;
        if (run->yielding.wanted)
            yield_plan(run, m, problem.load);
        press(run, g, m, &problem);
        end_load(run, g, m);
    }
    rc_model_free(m);
    run->adhering.figures = NULL;
    yield_free(run);
}

/* The hardness of a case is a number or a map. */
static void
take_hardness(struct run *run, const struct rc_grid *hardness)
{
    const double *v = hardness != NULL ? hardness->v : &run->args->physics.hardness;
    double low = INFINITY, high = -INFINITY;

    physics_hardness(&run->t, hardness);
    for (size_t k = 0; k < (hardness != NULL ? rc_grid_nodes(hardness) : 1); k++)
        if (isfinite(v[k])) {
            low = fmin(low, v[k]);
            high = fmax(high, v[k]);
        }
    run->hardness = hardness;
    run->hardness_min = -ranks_most(&run->t, -low);
    run->hardness_max = ranks_most(&run->t, high);
    if (run->args->physics.history && isinf(run->hardness_min) && !run->yielding.wanted &&
        !run->adhering.wanted)
        tool_warn(&run->t, "--history has no effect, because nothing yields without --hardness, a "
                           "map of it, or --yield: give one of them");
}

void
solve_case(struct run *run, struct rc_grid *g, const struct rc_grid *hardness)
{
    const struct rc_shape shape = rc_grid_shape(g);

    take_hardness(run, hardness);
    run->rms_slope = report_wanted(&run->report)
                         ? rc_measure_contact_slope(ranks_of(&run->t), &shape, g->v, NULL)
                         : NAN;
    physics_heights(&run->t, &run->args->physics, g);
    if (!rc_grid_number(g, HEIGHT_ERROR, &run->height_error))
        run->height_error = 0;
    if (run->checkpoint != NULL)
        checkpoint_crc(&run->t, g, run->crc);
    if (run->checkpoint != NULL && hardness != NULL)
        checkpoint_crc(&run->t, hardness, run->hardness_crc);
    if (run->args->drive.dry_run) {
        struct rc_problem problem = problem_of(run, g, 0);
        solve_plan(run, g, &problem);
    } else {
        do_loads(run, g);
    }
}
