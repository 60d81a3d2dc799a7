/* A case of rc-solve: its loads one after another, what is found of each, and the frames that are written. */
#include "solve.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Key of a shape that yield has left: how far off it may be, m. */
#define HEIGHT_ERROR "height.error"

/* ---- one case ---- */

/* Of the tolerance: what a load in which nodes yield may be off, so that with those after it, which may be smaller,
 * it is not more than the tolerance. 0: no load leaves a trace. */
static double
history_part(const struct run *run)
{
    const struct numbers *steps = run->steps;
    const double power = run->args->physics.approach.n > 0 ? 2 : 1; /* a load grows no faster */
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

static void
solve(struct run *run, const struct rc_grid *g, struct rc_solver *solver)
{
    struct rc_progress at;
    double start;

    run->resumed = checkpoint_case(run->checkpoint, g, solver);
    start = solve_now();
    while (tool_interrupted() == 0 && rc_solver_step(solver) == RC_MORE) {
        solve_progress(run, solver);
        checkpoint_pass(run->checkpoint, g, solver);
    }
    tool_progress_end(&run->t);
    run->iterate = solve_now() - start;
    rc_solver_progress(solver, &at);
    if (!run->resumed || at.iterations > 1) /* else it is there already */
        checkpoint_save(run->checkpoint, g, solver);
}

/* ---- results ---- */

/* Sets a key, or, where the number is not known, takes away one that an earlier solution left. */
static void
set_number(struct run *run, struct rc_grid *g, const char *name, double value)
{
    struct rc_err err;

    if ((isfinite(value) ? rc_grid_set_number(g, name, value, &err)
                         : rc_grid_set(g, name, NULL, &err)) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
}

void
solve_set_keys(struct run *run, struct rc_grid *g, const struct rc_contact *c)
{
    const struct rc_yield *law = &run->yielding.law;
    const bool yields = run->yielding.plastic != NULL;
    struct rc_err err;

    if (rc_grid_set(g, "boundary", run->args->physics.periodic ? "periodic" : "free", &err) !=
            RC_OK ||
        rc_grid_set(g, "converged", c->converged ? "yes" : "no", &err) != RC_OK ||
        bodies_set(g, &run->args->physics.pair, run->args->physics.residual, &err) != RC_OK ||
        rc_grid_history(g, tool_history(&run->t), &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    if (run->steps->n > 1 || run->args->pull_off)
        set_number(run, g, "case", (double)run->number);
    /* the load asked for and the one reached are the same but for rounding */
    set_number(run, g, "load",
               run->args->physics.load.n > 0 ? problem_of(run, g, run->step).load : c->load);
    set_number(run, g, "hardness", run->args->physics.hardness);
    set_number(run, g, "approach", c->approach);
    /* who reads the stream finds the strain behind the pressure, or misses it */
    set_number(run, g, "slabs", yields ? (double)run->yielding.found->slabs : NAN);
    set_number(run, g, "yield", yields ? rc_yield_stress(law, 0) : NAN);
    set_number(run, g, "hardening", yields ? yield_law_hardening(law) : NAN);
}

/* Maps of results are made one after another, as they are written, in one buffer. */
struct results {
    struct rc_grid *as; /* shape and keys of the frames */
    double *buffer;
    double *displacement; /* where it is; NULL: not yet made     */
    double *own;          /* memory for it beside the buffer, or NULL */
};

static void
results_new(struct run *run, const struct rc_grid *g, struct results *r)
{
    struct rc_err err;

    *r = (struct results){.as = rc_grid_like(g, g->channel, g->unit, &err)};
    if (r->as == NULL)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    /* reuse the input map when it is not written; untouched pages of the new map take no memory */
    r->buffer =
        solve_wanted(run->args, SOLVE_HEIGHT) || run->args->physics.history ? r->as->v : g->v;
}

static void
results_free(struct results *r)
{
    rc_grid_free(r->as);
    free(r->own);
}

/* Figures, and the first map. To look at a solution twice costs next to nothing, but for one that
 * was broken off, of which gap and displacement are made at once. */
static void
find_result(struct run *run, struct results *r, struct rc_solver *solver, struct rc_contact *c)
{
    size_t nodes = rc_grid_nodes(r->as);
    bool gap = solve_wanted(run->args, SOLVE_GAP);

    if (solve_wanted(run->args, SOLVE_DISPLACEMENT) && !gap) {
        r->displacement = r->buffer;
    } else if (solve_wanted(run->args, SOLVE_DISPLACEMENT) && tool_interrupted() != 0) {
        r->displacement = r->own = malloc((nodes + 1) * sizeof *r->own);
        if (r->own == NULL)
            tool_die_at(&run->t, r->as, EXIT_IMPOSSIBLE, "out of memory for the displacement");
    }
    rc_solver_result(solver, r->displacement, gap ? r->buffer : NULL, c);
}

void
solve_put(struct run *run, const struct rc_grid *as, enum solve_frame f, const double *v)
{
    struct rc_grid frame = *as; /* as the reader of the stream sees it */

    if (!solve_wanted(run->args, (int)f))
        return;
    frame.channel = (char *)solve_frames[f].name; /* these and the values are only read */
    frame.unit = (char *)solve_frames[f].unit;
    frame.type = f == SOLVE_CONTACT ? RC_F32 : as->type; /* of 0 and 1 */
    frame.v = (double *)v;
    tool_write(&run->t, &frame);
}

/* What yields leaves its mark. */
static void
put_plastic(struct run *run, const struct results *r, const double *h, const struct rc_contact *c)
{
    if (c->yielded_nodes > 0)
        set_number(run, r->as, HEIGHT_ERROR, c->shape_error);
    solve_put(run, r->as, SOLVE_PLASTIC, h);
}

/* Frames that are no results of the contact itself: the heights, and what is left of them, and inside. solver
 * NULL: bodies that are apart. */
static void
put_rest(struct run *run, const struct rc_grid *g, struct results *r, struct rc_solver *solver,
         const struct rc_contact *c)
{
    size_t nodes = rc_grid_nodes(r->as);
    struct rc_err err;

    r->as->type = g->type;
    solve_put(run, r->as, SOLVE_HEIGHT, g->v);
    r->as->type = RC_F64;
    if (run->yielding.plastic != NULL || solver == NULL) {
        memcpy(r->buffer, g->v, nodes * sizeof *g->v);
        yield_displace(run, nodes, -1, r->buffer);
    } else if (solve_wanted(run->args, SOLVE_PLASTIC) &&
               rc_solver_plastic(solver, r->buffer, &err) != RC_OK) {
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    }
    put_plastic(run, r, r->buffer, c);
    memset(r->buffer, 0, nodes * sizeof *r->buffer);
    yield_displace(run, nodes, 1, r->buffer);
    if (run->yielding.wanted)
        solve_put(run, r->as, SOLVE_RESIDUAL, r->buffer);
    if (run->yielding.wanted && solve_wanted(run->args, SOLVE_STRAIN))
        yield_put_strain(run, r->as, r->buffer);
}

/* The buffer may hold the gap by now. */
static void
put_contact(struct run *run, const struct results *r, const double *p)
{
    size_t nodes = rc_grid_nodes(r->as);
    double *touch;

    if (!solve_wanted(run->args, SOLVE_CONTACT))
        return;
    if ((touch = malloc((nodes + 1) * sizeof *touch)) == NULL)
        tool_die_at(&run->t, r->as, EXIT_IMPOSSIBLE, "out of memory for a map of the contact");
    for (size_t k = 0; k < nodes; k++)
        touch[k] = rc_in_contact(p[k]) ? 1 : 0;
    solve_put(run, r->as, SOLVE_CONTACT, touch);
    free(touch);
}

static void
put_out(struct run *run, const struct rc_grid *g, struct results *r, struct rc_solver *solver,
        const struct rc_contact *c)
{
    struct rc_contact again;

    solve_set_keys(run, r->as, c);
    put_contact(run, r, rc_solver_pressure(solver));
    solve_put(run, r->as, SOLVE_PRESSURE, rc_solver_pressure(solver));
    solve_put(run, r->as, SOLVE_GAP, r->buffer);
    if (r->displacement == NULL && solve_wanted(run->args, SOLVE_DISPLACEMENT)) {
        r->displacement = r->buffer;
        rc_solver_result(solver, r->displacement, NULL, &again);
    }
    if (r->displacement != NULL)
        yield_displace(run, rc_grid_nodes(r->as), 1, r->displacement);
    solve_put(run, r->as, SOLVE_DISPLACEMENT, r->displacement);
    put_rest(run, g, r, solver, c);
}

/* ---- loads ---- */

static double
highest(const struct run *run, const struct rc_grid *g)
{
    double top = -INFINITY;

    for (size_t k = 0; k < rc_grid_nodes(g); k++)
        top = fmax(top, g->v[k]);
    return ranks_most(&run->t, top);
}

/* The highest node when the bodies are taken apart from where body 1 has yielded inside. */
static double
highest_left(const struct run *run, const struct rc_grid *g)
{
    const double *u = rc_plastic_residual(run->yielding.plastic);
    double top = -INFINITY;

    for (size_t k = 0; k < rc_grid_nodes(g); k++)
        top = fmax(top, g->v[k] - u[k]);
    return top;
}

/* In a history the heights get the shape that the load has left. */
static void
keep_shape(struct run *run, struct rc_grid *g, struct rc_solver *solver, struct solution *s)
{
    struct rc_err err;

    if (!run->args->physics.history)
        return;
    if (run->yielding.plastic != NULL) /* that approach is counted from the shape that is left */
        run->top = highest_left(run, g);
    s->indentation = s->contact.approach + run->first_top - run->top;
    if (s->contact.yielded_nodes > 0) {
        if (rc_solver_keep_shape(solver, &s->contact, g->v, &err) != RC_OK)
            tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
        g->type = RC_F64;
        set_number(run, g, HEIGHT_ERROR, s->contact.shape_error);
        run->top = highest(run, g);
    }
    s->residual_indentation = run->first_top - run->top;
}

/* Of a tapered map (key `taper`), the contact inside; touch is NULL for bodies that are apart. */
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

void
solve_look_at_contact(struct run *run, const struct rc_grid *g, const double *touch,
                      struct solution *s)
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

/* Where no node is at the hardness the conductance has found the stiffness too. */
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

/* What the solver has found of this load. */
static void
end_load(struct run *run, struct rc_grid *g, struct rc_solver *solver)
{
    struct solution solution = SOLUTION_NONE, *s = &solution;
    struct results r;
    double start = solve_now();

    if (tool_interrupted() == 0) /* else there may be nothing on this grid yet */
        solve_look_at_contact(run, g, rc_solver_pressure(solver), s);
    results_new(run, g, &r);
    find_result(run, &r, solver, &s->contact);
    find_stiffness(run, g, solver, s);
    s->contact.convolutions = rc_solver_convolutions(solver);
    if (s->contact.inherited_error > 0)
        s->errors =
            (struct error_parts){.told = true,
                                 .inherited = s->contact.inherited_error,
                                 .contact = s->contact.pressure_error - s->contact.inherited_error};
    yield_look(run, s);
    run->done = solve_now();
    run->result = run->done - start;
    solve_judge(run, g, s);
    if (!s->contact.converged)
        tool_fails_with(&run->t, EXIT_SHORT);
    put_out(run, g, &r, solver, &s->contact);
    results_free(&r);
    keep_shape(run, g, solver, s);
    solve_report(run, g, solver, s);
    rc_patches_free(&s->patches);
}

/* No load: the bodies are apart. */
static void
take_apart(struct run *run, const struct rc_grid *g)
{
    size_t nodes = rc_grid_nodes(g);
    const struct rc_shape shape = rc_grid_shape(g);
    struct solution s = SOLUTION_NONE;
    struct results r;

    double *form = g->v, *own = NULL;

    run->result = 0;
    if (run->yielding.plastic != NULL) {
        form = own = malloc(nodes * sizeof *own);
        if (own == NULL)
            tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "out of memory for the shape that is left");
        memcpy(own, g->v, nodes * sizeof *own);
        yield_displace(run, nodes, -1, own);
        run->top = highest_left(run, g);
    }
    rc_contact_apart(ranks_of(&run->t), &shape, form, NULL, &s.contact);
    yield_look(run, &s);
    if (run->conductance)
        s.conductance = (struct rc_conductance){NAN, 0, 0};
    run->done = solve_now();
    s.indentation = s.residual_indentation = run->first_top - run->top;
    look_inside(run, g, NULL, &s);
    solve_judge(run, g, &s);
    solve_report(run, g, NULL, &s);
    results_new(run, g, &r);
    solve_set_keys(run, r.as, &s.contact);
    memset(r.buffer, 0, nodes * sizeof *r.buffer);
    solve_put(run, r.as, SOLVE_CONTACT, r.buffer);
    solve_put(run, r.as, SOLVE_PRESSURE, r.buffer);
    rc_contact_apart(ranks_of(&run->t), &shape, form, r.buffer, &s.contact);
    solve_put(run, r.as, SOLVE_GAP, r.buffer);
    memset(r.buffer, 0, nodes * sizeof *r.buffer);
    yield_displace(run, nodes, 1, r.buffer);
    solve_put(run, r.as, SOLVE_DISPLACEMENT, r.buffer);
    put_rest(run, g, &r, NULL, &s.contact);
    results_free(&r);
    free(own);
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

/* Where the map would fit with another engine, that is said. */
static void
demand_memory(struct run *run, const struct rc_grid *g, const struct rc_problem *problem)
{
    const struct demand d = {run, g, problem};

    run->t.remedy = tool_leaner_engine(&run->t, problem->boundary == RC_PERIODIC, memory_by, &d);
    tool_demand_memory(&run->t, g, solve_memory(run, g, problem));
    run->t.remedy = NULL;
}

void
solve_before_plan(struct run *run, const struct rc_grid *g, const struct rc_problem *problem)
{
    demand_memory(run, g, problem);
    if (run->done == 0)         /* no load has been solved */
        tool_release_signals(); /* planning takes long, and no pressure is worth writing before it ends */
}

void
solve_after_plan(struct run *run)
{
    tool_catch_signals();
    run->setup = solve_now() - run->began;
}

/* Solves this load of elastic bodies with a solver that there is, or NULL. The solver that has the solution. */
static struct rc_solver *
press(struct run *run, const struct rc_grid *g, struct rc_solver *solver,
      const struct rc_problem *problem)
{
    const struct rc_shape shape = rc_grid_shape(g);
    struct rc_err err;

    if (solver == NULL) {
        solve_before_plan(run, g, problem);
        if ((solver = rc_solver_new(&shape, g->v, problem, &err)) == NULL)
            tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
        solve_after_plan(run);
    } else if (rc_solver_set_load(solver, problem->load, problem->approach, &err) != RC_OK) {
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    }
    solve(run, g, solver);
    return solver;
}

/* The loads of a list, each from the solution of the last; in a history, on the shape that it has
 * left. */
static void
do_loads(struct run *run, struct rc_grid *g)
{
    struct rc_solver *solver = NULL;

    if (run->args->physics.history)
        run->first_top = run->top = highest(run, g);
    run->number = run->steps->n == 1 ? rc_grid_case(g) - 1 : run->number;
    for (run->step = 0; run->step < run->steps->n; run->step++) {
        struct rc_problem problem = problem_of(run, g, run->step);

        if (run->step > 0 && tool_interrupted() != 0)
            break; /* of the first there is something to write */
        run->began = solve_now();
        run->setup = run->iterate = 0;
        run->number++;
        const bool apart = run->steps->v[run->step] == 0;
        if (run->yielding.wanted)
            solver = yield_press(run, g, &problem, apart ? 0 : problem.load);
        else if (!apart)
            solver = press(run, g, solver, &problem);
        if (apart)
            take_apart(run, g);
        else
            end_load(run, g, solver);
    }
    if (!run->yielding.wanted)
        rc_solver_free(solver);
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
        tool_warn(&run->t,
                  "--history without --hardness or a number in a map of it: nothing yields, so no "
                  "load leaves a trace");
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
    run->nodes = g->nx * g->ny;
    checkpoint_surface(run->checkpoint, g, hardness);
    if (run->args->dry_run) {
        struct rc_problem problem = problem_of(run, g, 0);
        solve_plan(run, g, &problem);
    } else if (run->adhering.wanted) {
        adhesion_case(run, g, problem_of(run, g, 0));
    } else {
        do_loads(run, g);
    }
}
