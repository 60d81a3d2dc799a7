/* A case of rc-solve: solves its loads one after another, finds their figures and writes their frames. */
#include "solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

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

    problem.tol = run->args->tol * relax_part(run, true);
    problem.history_part = history_part(run);
    problem.engine = run->args->kernel;
    problem.method = run->args->method;
    problem.threads = run->d.t.threads;
    problem.ranks = ranks_of(&run->d.t);
    problem.hurry = tool_signal();
    problem.discretization = run->args->discretization;
    problem.tilt_free = run->tilt;
    for (size_t k = 0; k < run->args->at.n; k++)
        problem.force_at[k] = run->args->at.v[k];
    problem.height_error = run->height_error;
    problem.hardness_map = run->hardness != NULL ? run->hardness->v : NULL;
    return problem;
}

/* Marks of a checkpoint beside the options, maps and keys. */
static void
mark(struct drive *d)
{
    struct run *run = (struct run *)(void *)d;

    yield_mark(run);
    travel_mark(run);
    relax_mark(run);
}

/* ---- results ---- */

static void
set_keys(struct drive *d, const struct rc_model *m, struct rc_grid *g)
{
    struct run *run = (struct run *)(void *)d;
    const struct rc_contact *c = &run->solution.contact;
    const struct rc_yield_law *law = &run->yielding.law;
    const bool yields = run->yielding.on;

    (void)m;
    tool_set(&d->t, g, "boundary", run->args->physics.periodic ? "periodic" : "free");
    tool_set(&d->t, g, "converged", c->converged ? "yes" : "no");
    bodies_set(&d->t, g, &run->args->physics.pair, run->args->physics.residual);
    tool_sign(&d->t, g);
    if (d->points > 1)
        tool_set_number(&d->t, g, "case", (double)run->d.course.number);
    /* the requested and the reached load differ by rounding only */
    tool_set_number(&d->t, g, "load",
                    run->args->physics.load.n > 0 ? problem_of(run, g, run->step).load : c->load);
    tool_set_number(&d->t, g, "hardness", run->args->physics.hardness);
    if (run->hardness != NULL)
        tool_set(&d->t, g, "hardness_map", "yes");
    tool_set_number(&d->t, g, "approach", c->approach);
    /* slabs: a reader of the stream then expects the frames of plastic strain */
    tool_set_number(&d->t, g, "slabs", yields ? (double)run->yielding.found->slabs : NAN);
    tool_set_number(&d->t, g, "yield", yields ? rc_yield_law_stress(law, 0) : NAN);
    tool_set_number(&d->t, g, "hardening", yields ? yield_law_hardening(law) : NAN);
    adhesion_set_key(run, g, c);
    travel_set_keys(run, g);
    if (run->relaxing.wanted)
        tool_set_number(&d->t, g, "time", run->relaxing.found->time);
    if (run->sliding.wanted)
        tool_set_number(&d->t, g, "speed", slide_speed(run, d->at));
}

/* Values that are not those of a frame of the model. The frames from `plastic` on have the error of the
 * shape. */
static const double *
own_values(struct drive *d, struct rc_model *m, struct rc_grid *as, const char *word)
{
    struct run *run = (struct run *)(void *)d;
    const struct rc_contact *c = &run->solution.contact;

    if (strcmp(word, "plastic") == 0 && c->yielded_nodes > 0 && !run->adhering.wanted)
        tool_set_number(&d->t, as, HEIGHT_ERROR, c->shape_error);
    if (strcmp(word, "plastic") == 0 && run->apart && !run->yielding.wanted)
        return run->g->v; /* the shape has not changed */
    if (strcmp(word, "strain") == 0)
        yield_put_strain(run, m, as);
    return NULL;
}

/* ---- loads ---- */

/* In a history, gives the heights the shape after the load. */
static void
keep_shape(struct drive *d, struct rc_model *m)
{
    struct run *run = (struct run *)(void *)d;
    struct solution *s = &run->solution;
    struct rc_grid *g = run->g;

    if (!run->args->physics.history)
        return;
    if (s->contact.yielded_nodes > 0 && !run->travelling.wanted) {
        tool_must(&d->t, g, rc_model_frame(m, "plastic", g->v, &d->t.err));
        g->type = RC_F64;
        if (!run->adhering.wanted)
            tool_set_number(&d->t, g, HEIGHT_ERROR, s->contact.shape_error);
    }
    drive_keep(d, m);
    s->indentation = rc_model_number(m, "indentation");
    s->residual_indentation = rc_model_number(m, "residual_indentation");
}

/* Finds the contact inside the taper of a tapered map (key `taper`); touch is NULL for separated bodies. */
static void
look_inside(struct run *run, const struct rc_grid *g, const double *touch, struct solution *s)
{
    size_t columns, rows, first = tool_first_row(&run->d.t, g);
    double width, touching = 0, inside;

    s->inside_area = s->inside_fraction = NAN;
    if (!rc_grid_number(g, "taper", &width))
        return;
    rc_taper_frame(rc_shape_of(g), width, &columns, &rows);
    for (size_t k = 0; touch != NULL && k < rc_grid_nodes(g); k++) {
        size_t i = k % g->nx, j = first + k / g->nx;
        if (i >= columns && i + columns < g->nx && j >= rows && j + rows < g->ny &&
            rc_in_contact(touch[k]))
            touching++;
    }
    touching = ranks_sum(&run->d.t, touching);
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
                                       .each = report_wanted(&run->d.report),
                                       .threads = run->d.t.threads,
                                       .ranks = ranks_of(&run->d.t)};

    tool_must(&run->d.t, g, rc_patches_find(&shape, touch, &options, &s->patches, &run->d.t.err));
    s->slope = rc_measure_contact_slope(ranks_of(&run->d.t), &shape, g->v, touch);
    look_inside(run, g, touch, s);
}

/* Finds the touching nodes from the gap, because the net pressure of an adhesive contact does not determine
 * them. */
static void
look_at_closed_gap(struct run *run, const struct rc_grid *g, struct rc_model *m, struct solution *s)
{
    RC_OWNED double *touch = tool_room(&run->d.t, rc_grid_nodes(g), sizeof *touch, "a map");

    tool_must(&run->d.t, g, rc_model_frame(m, CONTACT_CHANNEL, touch, &run->d.t.err));
    look_at_contact(run, g, touch, s);
}

/* Takes the figures of all models, and the figures of this model. */
static void
look_at_model(struct run *run, const struct rc_grid *g, struct rc_model *m, struct solution *s)
{
    const struct rc_elastic_figures *elastic = rc_elastic_result(m);
    const struct rc_adhesion_figures *adhesive = rc_adhesion_result(m);

    yield_found(run, m);
    run->adhering.figures = adhesive != NULL ? &adhesive->state : NULL;
    s->contact = run->relaxing.wanted ? run->relaxing.found->contact
                 : elastic != NULL    ? elastic->contact
                 : adhesive != NULL   ? adhesive->contact
                                      : rc_yield_result(m)->contact;
    slide_look(run, m, &s->contact);
    if (adhesive != NULL || (run->sliding.wanted && !run->apart))
        look_at_closed_gap(run, g, m, s);
}

/* If no node is at the hardness, the computation of the conductance has found the stiffness too. */
static void
find_stiffness(struct run *run, const struct rc_grid *g, struct rc_solver *solver,
               struct solution *s)
{
    struct tool *t = &run->d.t;

    if (run->conductance)
        tool_must(t, g,
                  rc_solver_conductance(solver, run->k[0], run->k[1], &s->conductance, &t->err));
    if (!run->stiffness)
        return;
    if (run->conductance && s->contact.plastic_nodes == 0)
        s->stiffness = s->conductance.stiffness;
    else
        tool_must(t, g, rc_solver_stiffness(solver, &s->stiffness, &t->err));
}

/* Finds the figures of this load, and warns. */
static void
judge_load(struct drive *d, struct rc_model *m)
{
    struct run *run = (struct run *)(void *)d;
    struct solution *s = &run->solution;
    struct rc_grid *g = run->g;
    const double start = tool_now();

    rc_patches_free(&s->patches);
    *s = (struct solution)SOLUTION_NONE;
    run->solver = rc_model_solver(m);
    travel_look(run, m);
    if (!relax_look(run, m))
        return;
    if (run->apart)
        look_inside(run, g, NULL, s);
    else if (run->solver != NULL && !run->sliding.wanted &&
             tool_interrupted() == 0) /* otherwise this grid may have no pressure yet */
        look_at_contact(run, g, rc_solver_pressure(run->solver), s);
    look_at_model(run, g, m, s);
    if (run->apart && run->conductance)
        s->conductance = (struct rc_conductance){NAN, 0, 0};
    if (run->solver != NULL && !run->apart) {
        if (tool_interrupted() == 0)
            find_stiffness(run, g, run->solver, s);
        if (!run->relaxing.wanted && !run->sliding.wanted)
            s->contact.convolutions = rc_solver_convolutions(run->solver);
    }
    if (s->contact.inherited_error > 0)
        s->errors =
            (struct error_parts){.told = true,
                                 .inherited = s->contact.inherited_error,
                                 .contact = s->contact.pressure_error - s->contact.inherited_error};
    yield_look(run, s);
    relax_parts(run, s);
    travel_end_pass(run, m);
    run->done = tool_now();
    run->result = run->apart ? 0 : run->done - start;
    if (run->adhering.wanted)
        adhesion_judge(run, g, s);
    else
        solve_judge(run, g, s);
    if (!s->contact.converged && !run->apart)
        tool_fails_with(&d->t, EXIT_SHORT);
    /* the frames are found in the input map if it is no longer needed */
    d->spare = !solve_wanted(run->args, SOLVE_HEIGHT) && !run->args->physics.history &&
               run->step + 1 == run->steps->n;
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

    run->d.t.remedy =
        tool_leaner_engine(&run->d.t, problem->boundary == RC_PERIODIC, memory_by, &d);
    tool_demand_memory(&run->d.t, g, solve_memory(run, g, problem));
    run->d.t.remedy = NULL;
}

static void
before_plan(struct run *run, const struct rc_grid *g, const struct rc_problem *problem)
{
    if (run->adhering.wanted)
        tool_demand_memory(&run->d.t, g, adhesion_memory(run, g, problem));
    else
        demand_memory(run, g, problem);
    if (run->done == 0)         /* no load has been solved */
        tool_release_signals(); /* making the plan takes long, and before its end there is no
                                   pressure to write */
}

/* Before a load. The first one plans the solver. */
static void
begin_load(struct drive *d, struct rc_model *m)
{
    struct run *run = (struct run *)(void *)d;
    struct adhering *a = &run->adhering;
    struct rc_problem problem;
    bool plans;

    a->pulling = a->wanted && d->at == run->steps->n;
    run->step = run->travelling.wanted ? 0
                : run->relaxing.wanted ? relax_step(run, d->at)
                : run->sliding.wanted  ? slide_step(run, d->at)
                : a->pulling           ? d->at - 1
                                       : d->at;
    run->apart = run->steps->v[run->step] == 0 && !a->wanted;
    problem = problem_of(run, run->g, run->relaxing.wanted ? relax_largest(run) : run->step);
    if (run->yielding.wanted)
        yield_plan(run, m, problem.load);
    plans = a->wanted || run->relaxing.wanted || run->sliding.wanted
                ? d->at == 0
                : !run->apart && rc_model_solver(m) == NULL;
    if ((run->apart && !run->yielding.on && !run->relaxing.wanted) || a->pulling ||
        (run->relaxing.before && d->at == 0))
        d->course.checkpoint = NULL;
    if (plans)
        before_plan(run, run->g, &problem);
}

/* The loads of a list, each from the solution of the last one; in a history, on the shape after the last one.
 * --pull-off adds a case in which the bodies are separated. */
static void
make_points(struct run *run)
{
    const bool approach = run->args->physics.approach.n > 0;
    struct drive *d = &run->d;

    d->points = run->travelling.wanted ? travel_points(run)
                : run->relaxing.wanted ? relax_points(run)
                : run->sliding.wanted  ? slide_points(run)
                                       : run->steps->n + run->args->pull_off;
    d->point = tool_room(&d->t, d->points, sizeof *d->point, "the loads");
    for (size_t k = 0; k < d->points; k++) {
        const size_t step = run->relaxing.wanted  ? relax_step(run, k)
                            : run->sliding.wanted ? slide_step(run, k)
                                                  : k;
        const struct rc_problem problem = problem_of(run, run->g, step < run->steps->n ? step : 0);
        rc_point_set(&d->point[k], approach ? RC_APPROACH : RC_LOAD,
                     approach ? problem.approach : problem.load);
        if (run->travelling.wanted)
            rc_point_set(&d->point[k], RC_POSITION, travel_position(run, k));
        if (run->relaxing.wanted)
            rc_point_set(&d->point[k], RC_TIME, relax_time(run, k));
        if (run->sliding.wanted)
            rc_point_set(&d->point[k], RC_SPEED, slide_speed(run, k));
    }
    if (run->args->pull_off)
        rc_point_set(&d->point[run->steps->n], RC_APPROACH, -INFINITY);
}

static struct rc_model *
elastic_model(struct run *run, const struct rc_problem *problem)
{
    return tool_made(&run->d.t, run->g,
                     rc_elastic_new(rc_shape_of(run->g), run->g->v, problem, NULL, &run->d.t.err));
}

static void
do_loads(struct run *run)
{
    const struct rc_problem problem = problem_of(run, run->g, 0);
    struct drive *d = &run->d;

    run->model = run->yielding.wanted   ? yield_model(run, run->g, &problem)
                 : run->adhering.wanted ? adhesion_model(run, run->g, &problem)
                 : run->sliding.wanted  ? slide_model(run, &problem)
                                        : elastic_model(run, &problem);
    if (run->travelling.wanted)
        run->model = travel_model(run, run->model);
    if (run->relaxing.wanted)
        run->model = relax_model(run, run->model);
    d->mark = mark;
    d->begin = begin_load;
    d->judge = judge_load;
    d->all_keys = set_keys;
    d->frame = own_values;
    d->keep = keep_shape;
    d->row = solve_report;
    d->independent =
        !run->args->physics.history && !run->travelling.wanted && !run->relaxing.wanted;
    make_points(run);
    if (d->points == 1)
        d->course.number = rc_grid_case(run->g) - 1;
    drive_points(d, run->g, run->model);
    free(d->point);
    d->point = NULL;
    rc_patches_free(&run->solution.patches);
    run->adhering.figures = NULL;
    yield_free(run);
}

/* The hardness of a case is a number or a map. */
static void
take_hardness(struct run *run)
{
    const struct rc_grid *hardness = run->hardness;
    const double *v = hardness != NULL ? hardness->v : &run->args->physics.hardness;
    double low = INFINITY, high = -INFINITY;

    physics_hardness(&run->d.t, hardness);
    for (size_t k = 0; k < (hardness != NULL ? rc_grid_nodes(hardness) : 1); k++)
        if (isfinite(v[k])) {
            low = fmin(low, v[k]);
            high = fmax(high, v[k]);
        }
    run->hardness_min = -ranks_most(&run->d.t, -low);
    run->hardness_max = ranks_most(&run->d.t, high);
    if ((run->relaxing.wanted || run->sliding.wanted) && run->hardness != NULL)
        tool_refuse(&run->d.t, run->g, "--relaxation with a map of hardness is not implemented");
    if (run->args->physics.history && isinf(run->hardness_min) && !run->yielding.wanted &&
        !run->adhering.wanted && !run->relaxing.wanted)
        tool_warn(&run->d.t,
                  "--history has no effect, because nothing yields without --hardness, a "
                  "map of it, or --yield: give one of them");
}

void
solve_case(struct run *run)
{
    struct rc_grid *g = run->g;

    take_hardness(run);
    run->rms_slope = report_wanted(&run->d.report)
                         ? rc_measure_contact_slope(ranks_of(&run->d.t), rc_shape_of(g), g->v, NULL)
                         : NAN;
    physics_heights(&run->d.t, &run->args->physics, g);
    if (!rc_grid_number(g, HEIGHT_ERROR, &run->height_error))
        run->height_error = 0;
    travel_begin(run);
    if (run->args->drive.dry_run) {
        size_t first = 0; /* a load of 0 costs nothing */
        struct rc_problem problem;
        while (!run->adhering.wanted && first + 1 < run->steps->n && run->steps->v[first] == 0)
            first++;
        run->step = first;
        problem = problem_of(run, run->g, first);
        if (run->relaxing.wanted)
            problem = problem_of(run, run->g, relax_largest(run));
        run->model = run->yielding.wanted   ? yield_model(run, run->g, &problem)
                     : run->relaxing.wanted ? relax_model(run, elastic_model(run, &problem))
                     : run->sliding.wanted  ? slide_model(run, &problem)
                                            : NULL;
        solve_plan(run, run->g, &problem);
        rc_model_free(run->model);
    } else {
        do_loads(run);
    }
    travel_end(run);
}
