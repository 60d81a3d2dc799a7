/* Contact of a height map with an elastic half-space. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/contact.h"
#include "tools/cli/cli.h"
#include "tools/solve/solve.h"

static struct solve_args args = {
    .physics = PHYSICS_NONE,
    .kernel = "auto",
    .method = "auto",
    .interval = 60,
    .output = 1 << SOLVE_PRESSURE | 1 << SOLVE_GAP | 1 << SOLVE_DISPLACEMENT | 1 << SOLVE_HEIGHT,
};

#define AT(field) .at = offsetof(struct solve_args, field)
static const char *
tilt_word(size_t k)
{
    static const char *const words[] = {"fixed", "free", NULL};

    return words[k];
}

/* clang-format off */
static const struct opt opts[] = {
    {.group = physics_options, AT(physics)},
    {.name = "history", .type = OPT_FLAG, AT(physics.history), .result = true,
     .help = "the loads follow each other, each on the shape left by yield; 0 takes the bodies apart"},
    {.name = "kernel", .alias = "engine", .type = OPT_CHOICE, AT(kernel),
     .words = words_engine_or_auto, .help = "how displacements are summed (default auto)"},
    {.name = "method", .type = OPT_CHOICE, AT(method), .words = words_method_or_auto,
     .help = "how the contact is iterated (default auto)"},
    {.name = "tol", .type = OPT_NUMBER, AT(tol), .min = 0, .max = 1, .above = true,
     .result = true, .arg = "ERROR",
     .help = "relative L1 error of the pressure (default N^(-3/4), N nodes, at most 1e-3)"},
    {.name = "output", .type = OPT_WORDS, AT(output),
     .words = solve_frame_word, .arg = "LIST",
     .help = "frames to write, of %s (default: all but plastic)"},
    {.name = "tilt", .type = OPT_CHOICE, AT(tilt), .words = tilt_word, .result = true,
     .help = "whether the counter body turns until no moment acts (default fixed)"},
    {.name = "at", .type = OPT_NUMBERS, .unit = UNIT_M, AT(at), .min = -INFINITY, .max = INFINITY,
     .result = true, .arg = "X,Y",
     .help = "where the load acts on a body that is free to tilt (default: the middle)"},
    {.name = "stiffness", .type = OPT_FLAG, AT(stiffness),
     .help = "find how the load grows with the approach (default: with a list)"},
    {.name = "conductivity", .type = OPT_TEXT, AT(conductivity), .arg = "K1,K2",
     .help = "find how well the contact conducts, from both bodies: 45W/mK,16W/mK, 58MS/m,7MS/m"},
    {.name = "discretization", .type = OPT_FLAG, AT(discretization),
     .help = "estimate what the grid leaves out, from a coarser one solved as well"},
    {.name = "report", .type = OPT_REPORT, AT(report), .arg = "FILE",
     .help = "write one JSON object a case, or a row of FILE.tsv: figures, accuracy, cost"},
    {.name = "checkpoint", .type = OPT_TEXT, AT(checkpoint), .arg = "FILE",
     .help = "keep the pressures reached in FILE, to go on from if the run is cut off"},
    {.name = "resume", .type = OPT_FLAG, AT(resume),
     .help = "go on from the --checkpoint of an earlier run"},
    {.name = "interval", .type = OPT_NUMBER, .unit = UNIT_S, AT(interval), .min = 0, .max = 1e9,
     .arg = "TIME",
     .help = "first frame of a case in --checkpoint after this time, then after 2, 4 ... times it "
             "(60)"},
    {.name = "dry-run", .type = OPT_FLAG, AT(dry_run),
     .help = "say what would be done, and why, with its cost; do nothing else"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-solve",
    .summary = "Contact of a height map with an elastic half-space: pressure, gap, displacement",
    .operands = "[FILE...]",
    .examples = "  rc-synth sphere --nx 128 --dx 5um --radius 7.5mm |\n"
                "      rc-solve --load 240N --estar 114GPa --report hertz.json | rc-info\n",
    .opts = opts,
    .reads = READS_STREAM,
    .writes = WRITES_STREAM,
    .shares = true,
};

/* Key of a shape that yield has left: how far off it may be, m. */
#define HEIGHT_ERROR "height.error"

/* ---- the command line ---- */

static void
read_conductivity(struct run *run)
{
    struct rc_err err;

    if (args.conductivity == NULL)
        return;
    if (unit_conductivities(args.conductivity, run->k, &run->conductance_unit, &err) != RC_OK)
        tool_die(&run->t, EXIT_USAGE, "--conductivity %s: %s", args.conductivity, err.text);
    run->conductance = args.physics.pair.one.layers == 0;
    if (!run->conductance)
        tool_warn(&run->t,
                  "--conductivity: how a contact of coated bodies conducts does not follow "
                  "from how it yields: the conductance is left out");
}

/* A counter body that is free to tilt. */
static void
check_tilt(struct run *run)
{
    const struct physics *a = &args.physics;

    run->tilt = args.tilt != NULL && strcmp(args.tilt, "free") == 0;
    if (args.at.n > 0 && !run->tilt)
        tool_die(&run->t, EXIT_USAGE,
                 "--at needs --tilt free: else it is all the same where the load acts");
    if (args.at.n > 0 && args.at.n != 2)
        tool_die(&run->t, EXIT_USAGE,
                 "--at: it must be X,Y, from the middle of the map, as in 0.1mm,0");
    if (run->tilt && a->periodic)
        tool_die(&run->t, EXIT_USAGE,
                 "--tilt free: a periodic surface has no point that it could tilt about: leave out "
                 "--periodic");
    if (run->tilt && a->history)
        tool_die(&run->t, EXIT_USAGE,
                 "--tilt free: not with --history: the shapes that loads leave would tilt too");
}

static void
check_arguments(struct run *run)
{
    if ((args.resume || tool_given(&run->t, "interval")) && args.checkpoint == NULL)
        tool_die(&run->t, EXIT_USAGE, "--resume and --interval need --checkpoint FILE");
    physics_check(&run->t, &args.physics);
    run->args = &args;
    run->steps = physics_steps(&args.physics);
    run->stiffness = args.stiffness || run->steps->n > 1;
    read_conductivity(run);
    check_tilt(run);
}

/* ---- one case ---- */

static struct rc_problem
problem_of(struct run *run, const struct rc_grid *g, size_t step)
{
    struct rc_problem problem = physics_problem(&args.physics, g, step);

    problem.tol = args.tol;
    problem.engine = args.kernel;
    problem.method = args.method;
    problem.threads = run->t.threads;
    problem.ranks = ranks_of(&run->t);
    problem.discretization = args.discretization;
    problem.tilt_free = run->tilt;
    for (size_t k = 0; k < args.at.n; k++)
        problem.force_at[k] = args.at.v[k];
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

static void
set_keys(struct run *run, struct rc_grid *g, const struct rc_contact *c)
{
    struct rc_err err;

    if (rc_grid_set(g, "boundary", args.physics.periodic ? "periodic" : "free", &err) != RC_OK ||
        rc_grid_set(g, "converged", c->converged ? "yes" : "no", &err) != RC_OK ||
        bodies_set(g, &args.physics.pair, &err) != RC_OK ||
        rc_grid_history(g, tool_history(&run->t), &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    if (run->steps->n > 1)
        set_number(run, g, "case", (double)run->number);
    /* the load asked for and the one reached are the same but for rounding */
    set_number(run, g, "load",
               args.physics.load.n > 0 ? problem_of(run, g, run->step).load : c->load);
    set_number(run, g, "hardness", args.physics.hardness);
    set_number(run, g, "approach", c->approach);
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
    /* heights that nobody needs any more give their memory; pages of the new map that nobody touches
     * take none */
    r->buffer = solve_wanted(&args, SOLVE_HEIGHT) || args.physics.history ? r->as->v : g->v;
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
    bool gap = solve_wanted(&args, SOLVE_GAP);

    if (solve_wanted(&args, SOLVE_DISPLACEMENT) && !gap) {
        r->displacement = r->buffer;
    } else if (solve_wanted(&args, SOLVE_DISPLACEMENT) && tool_interrupted() != 0) {
        r->displacement = r->own = malloc((nodes + 1) * sizeof *r->own);
        if (r->own == NULL)
            tool_die_at(&run->t, r->as, EXIT_IMPOSSIBLE, "out of memory for the displacement");
    }
    rc_solver_result(solver, r->displacement, gap ? r->buffer : NULL, c);
}

static void
put(struct run *run, const struct results *r, enum solve_frame f, const double *v)
{
    struct rc_grid frame = *r->as; /* as the reader of the stream sees it */

    if (!solve_wanted(&args, (int)f))
        return;
    frame.channel = (char *)solve_frames[f].name; /* these and the values are only read */
    frame.unit = (char *)solve_frames[f].unit;
    frame.v = (double *)v;
    tool_write(&run->t, &frame);
}

/* What yields leaves its mark. */
static void
put_plastic(struct run *run, const struct results *r, const double *h, const struct rc_contact *c)
{
    if (c->yielded_nodes > 0)
        set_number(run, r->as, HEIGHT_ERROR, c->shape_error);
    put(run, r, SOLVE_PLASTIC, h);
}

static void
put_out(struct run *run, const struct rc_grid *g, struct results *r, struct rc_solver *solver,
        const struct rc_contact *c)
{
    struct rc_contact again;
    struct rc_err err;

    set_keys(run, r->as, c);
    put(run, r, SOLVE_PRESSURE, rc_solver_pressure(solver));
    put(run, r, SOLVE_GAP, r->buffer);
    if (r->displacement == NULL && solve_wanted(&args, SOLVE_DISPLACEMENT)) {
        r->displacement = r->buffer;
        rc_solver_result(solver, r->displacement, NULL, &again);
    }
    put(run, r, SOLVE_DISPLACEMENT, r->displacement);
    r->as->type = g->type;
    put(run, r, SOLVE_HEIGHT, g->v);
    r->as->type = RC_F64;
    if (solve_wanted(&args, SOLVE_PLASTIC) && rc_solver_plastic(solver, r->buffer, &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    put_plastic(run, r, r->buffer, c);
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

/* In a history the heights get the shape that the load has left. */
static void
keep_shape(struct run *run, struct rc_grid *g, struct rc_solver *solver, struct solution *s)
{
    struct rc_err err;

    if (!args.physics.history)
        return;
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

/* Of a tapered map (key `taper`), the contact inside; p is NULL for bodies that are apart. */
static void
look_inside(struct run *run, const struct rc_grid *g, const double *p, struct solution *s)
{
    const struct rc_shape shape = rc_grid_shape(g);
    size_t columns, rows, first = tool_first_row(&run->t, g);
    double width, touching = 0, inside;

    s->inside_area = s->inside_fraction = NAN;
    if (!rc_grid_number(g, "taper", &width))
        return;
    rc_taper_frame(&shape, width, &columns, &rows);
    for (size_t k = 0; p != NULL && k < rc_grid_nodes(g); k++) {
        size_t i = k % g->nx, j = first + k / g->nx;
        if (i >= columns && i + columns < g->nx && j >= rows && j + rows < g->ny && p[k] > 0)
            touching++;
    }
    touching = ranks_sum(&run->t, touching);
    inside = (double)(g->nx - 2 * columns) * (double)(g->ny - 2 * rows);
    s->inside_area = touching * g->dx * g->dy;
    s->inside_fraction = inside > 0 ? touching / inside : NAN;
}

static void
look_at_contact(struct run *run, const struct rc_grid *g, const double *p, struct solution *s)
{
    struct rc_shape shape = rc_grid_shape(g);
    struct rc_patch_options options = {.boundary = args.physics.periodic ? RC_PERIODIC : RC_FREE,
                                       .each = report_wanted(&run->report),
                                       .threads = run->t.threads,
                                       .ranks = ranks_of(&run->t)};
    struct rc_err err;

    if (rc_patches_find(&shape, p, &options, &s->patches, &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    s->slope = rc_measure_contact_slope(ranks_of(&run->t), &shape, g->v, p);
    look_inside(run, g, p, s);
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

static void
do_load(struct run *run, struct rc_grid *g, struct rc_solver *solver)
{
    struct solution solution = SOLUTION_NONE, *s = &solution;
    struct results r;
    double start;

    solve(run, g, solver);
    start = solve_now();
    if (tool_interrupted() == 0) /* else there may be nothing on this grid yet */
        look_at_contact(run, g, rc_solver_pressure(solver), s);
    results_new(run, g, &r);
    find_result(run, &r, solver, &s->contact);
    find_stiffness(run, g, solver, s);
    s->contact.convolutions = rc_solver_convolutions(solver);
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

    run->iterate = run->result = 0;
    rc_contact_apart(ranks_of(&run->t), &shape, g->v, NULL, &s.contact);
    if (run->conductance)
        s.conductance = (struct rc_conductance){NAN, 0, 0};
    run->done = solve_now();
    s.indentation = s.residual_indentation = run->first_top - run->top;
    look_inside(run, g, NULL, &s);
    solve_judge(run, g, &s);
    solve_report(run, g, NULL, &s);
    results_new(run, g, &r);
    set_keys(run, r.as, &s.contact);
    memset(r.buffer, 0, nodes * sizeof *r.buffer);
    put(run, &r, SOLVE_PRESSURE, r.buffer);
    rc_contact_apart(ranks_of(&run->t), &shape, g->v, r.buffer, &s.contact);
    put(run, &r, SOLVE_GAP, r.buffer);
    memset(r.buffer, 0, nodes * sizeof *r.buffer);
    put(run, &r, SOLVE_DISPLACEMENT, r.buffer);
    r.as->type = g->type;
    put(run, &r, SOLVE_HEIGHT, g->v);
    r.as->type = RC_F64;
    put_plastic(run, &r, g->v, &s.contact);
    results_free(&r);
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

    tool_demand_memory_or(
        &run->t, g, solve_memory(run, g, problem),
        tool_leaner_engine(&run->t, problem->boundary == RC_PERIODIC, memory_by, &d));
}

static struct rc_solver *
new_solver(struct run *run, const struct rc_grid *g)
{
    struct rc_shape shape = rc_grid_shape(g);
    struct rc_problem problem = problem_of(run, g, run->step);
    struct rc_solver *solver;
    struct rc_err err;

    demand_memory(run, g, &problem);
    solver = rc_solver_new(&shape, g->v, &problem, &err);
    if (solver == NULL)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    tool_code_there(&run->t, SOLVE_CODE);
    run->setup = solve_now() - run->began;
    return solver;
}

/* The loads of a list, each from the solution of the last; in a history, on the shape that it has
 * left. */
static void
do_loads(struct run *run, struct rc_grid *g)
{
    struct rc_solver *solver = NULL;
    struct rc_err err;

    if (args.physics.history)
        run->first_top = run->top = highest(run, g);
    run->number = run->steps->n == 1 ? rc_grid_case(g) - 1 : run->number;
    for (run->step = 0; run->step < run->steps->n; run->step++) {
        struct rc_problem problem = problem_of(run, g, run->step);

        if (run->step > 0 && tool_interrupted() != 0)
            break; /* of the first there is something to write */
        run->began = solve_now();
        run->setup = 0;
        run->number++;
        if (run->steps->v[run->step] == 0) {
            take_apart(run, g);
            continue;
        }
        if (solver == NULL)
            solver = new_solver(run, g);
        else if (rc_solver_set_load(solver, problem.load, problem.approach, &err) != RC_OK)
            tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
        do_load(run, g, solver);
    }
    rc_solver_free(solver);
}

/* The hardness of a case is a number or a map. */
static void
take_hardness(struct run *run, const struct rc_grid *hardness)
{
    const double *v = hardness != NULL ? hardness->v : &args.physics.hardness;
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
    if (args.physics.history && isinf(run->hardness_min))
        tool_warn(&run->t,
                  "--history without --hardness or a number in a map of it: nothing yields, so no "
                  "load leaves a trace");
}

static void
do_case(struct run *run, struct rc_grid *g, const struct rc_grid *hardness)
{
    take_hardness(run, hardness);
    physics_heights(&run->t, &args.physics, g);
    if (!rc_grid_number(g, HEIGHT_ERROR, &run->height_error))
        run->height_error = 0;
    run->nodes = g->nx * g->ny;
    checkpoint_surface(run->checkpoint, g, hardness);
    if (args.dry_run) {
        struct rc_problem problem = problem_of(run, g, 0);
        solve_plan(run, g, &problem);
    } else {
        do_loads(run, g);
    }
}

int
main(int argc, char **argv)
{
    static struct run run;
    struct rc_grid *g, *hardness;

    tool_start(&run.t, &info, argc, argv, &args);
    check_arguments(&run);
    report_open(&run.report, &run.t, args.report);
    if (!args.dry_run)
        run.checkpoint = checkpoint_open(&run, args.checkpoint, args.resume, args.interval);
    tool_catch_signals();
    while (tool_interrupted() == 0 &&
           (g = tool_channel_beside(&run.t, "height", "hardness", &hardness)) != NULL) {
        do_case(&run, g, hardness);
        rc_grid_free(g);
        rc_grid_free(hardness);
    }
    checkpoint_close(run.checkpoint);
    report_close(&run.report);
    return tool_finish(&run.t);
}
