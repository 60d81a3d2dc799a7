/* Contact of a height map with an elastic half-space. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solve.h"

static struct solve_args args = {
    .estar = NAN, .e1 = NAN, .nu1 = NAN, .e2 = NAN, .nu2 = NAN,
    .hardness = INFINITY, .radius = NAN, .tol = NAN, .kernel = "auto", .method = "auto",
    .interval = 60,
    .output = 1 << SOLVE_PRESSURE | 1 << SOLVE_GAP | 1 << SOLVE_DISPLACEMENT | 1 << SOLVE_HEIGHT,
};

#define AT(field) .at = offsetof(struct solve_args, field)
#define ABOVE_0 .min = 0, .max = INFINITY, .above = true
static const struct opt opts[] = {
    {.name = "load", .type = OPT_NUMBERS, .unit = UNIT_N, AT(load), ABOVE_0, .result = true,
     .arg = "LIST", .help = "total normal force: one, a,b,c or a:b:n, each a case"},
    {.name = "mean-pressure", .type = OPT_NUMBERS, .unit = UNIT_PA, AT(mean_pressure), ABOVE_0,
     .result = true, .arg = "LIST", .help = "the load as a mean over the whole map"},
    {.name = "approach", .type = OPT_NUMBERS, .unit = UNIT_M, AT(approach), ABOVE_0,
     .result = true, .arg = "LIST",
     .help = "instead of the load: how far to come together after first touch"},
    {.name = "estar", .type = OPT_NUMBER, .unit = UNIT_PA, AT(estar), ABOVE_0, .result = true,
     .arg = "MODULUS", .help = "composite modulus E*, 1/E* = (1-nu1^2)/E1 + (1-nu2^2)/E2"},
    {.name = "E1", .type = OPT_NUMBER, .unit = UNIT_PA, AT(e1), ABOVE_0, .result = true,
     .arg = "MODULUS", .help = "Young's modulus of body 1, the one that is analysed"},
    {.name = "nu1", .type = OPT_NUMBER, AT(nu1), .min = -1, .max = 0.5, .above = true,
     .result = true, .arg = "RATIO", .help = "Poisson's ratio of body 1"},
    {.name = "E2", .type = OPT_NUMBER, .unit = UNIT_PA, AT(e2), ABOVE_0, .result = true,
     .arg = "MODULUS", .help = "Young's modulus of body 2"},
    {.name = "nu2", .type = OPT_NUMBER, AT(nu2), .min = -1, .max = 0.5, .above = true,
     .result = true, .arg = "RATIO", .help = "Poisson's ratio of body 2"},
    {.name = "hardness", .type = OPT_NUMBER, .unit = UNIT_PA, AT(hardness), ABOVE_0,
     .result = true, .arg = "PRESSURE", .help = "upper bound of the pressure: above it, yield"},
    {.name = "radius", .type = OPT_NUMBER, .unit = UNIT_M, AT(radius), ABOVE_0, .result = true,
     .arg = "LENGTH", .help = "add a sphere of this composite radius about the origin"},
    {.name = "periodic", .type = OPT_FLAG, AT(periodic), .result = true,
     .help = "the map repeats for ever (default: a free half-space, loaded on the map only)"},
    {.name = "kernel", .type = OPT_CHOICE, AT(kernel), .arg = "auto|fft|mlms|direct",
     .help = "how displacements are summed (default auto)"},
    {.name = "method", .type = OPT_CHOICE, AT(method), .arg = "auto|pcg|pk99",
     .help = "how the contact is iterated (default auto)"},
    {.name = "tol", .type = OPT_NUMBER, AT(tol), .min = 0, .max = 1, .above = true,
     .result = true, .arg = "ERROR",
     .help = "relative L1 error of the pressure (default N^(-3/4), N nodes)"},
    {.name = "output", .type = OPT_WORDS, AT(output),
     .words = "pressure|gap|displacement|height|plastic", .arg = "LIST",
     .help = "frames to write, of pressure,gap,displacement,height,plastic (default: all but "
             "plastic)"},
    {.name = "stiffness", .type = OPT_FLAG, AT(stiffness),
     .help = "find how the load grows with the approach (default: with a list)"},
    {.name = "discretization", .type = OPT_FLAG, AT(discretization),
     .help = "estimate what the grid leaves out, from a coarser one solved as well"},
    {.name = "report", .type = OPT_TEXT, AT(report), .arg = "FILE",
     .help = "write one JSON object a case: figures, accuracy, cost"},
    {.name = "checkpoint", .type = OPT_TEXT, AT(checkpoint), .arg = "FILE",
     .help = "keep the pressures reached in FILE, to go on from if the run is cut off"},
    {.name = "resume", .type = OPT_FLAG, AT(resume), .help = "go on from the --checkpoint of an earlier run"},
    {.name = "interval", .type = OPT_NUMBER, AT(interval), .min = 0, .max = 1e9, .arg = "SECONDS",
     .help = "first frame of a case in --checkpoint after this time, then after 2, 4 ... times it (60)"},
    {.name = "dry-run", .type = OPT_FLAG, AT(dry_run),
     .help = "say what would be done, and why, with its cost; do nothing else"},
    {.name = NULL},
};

static const struct tool_info info = {
    .name = "rc-solve",
    .summary = "Contact of a height map with an elastic half-space: pressure, gap, displacement",
    .operands = "[FILE...]",
    .examples =
        "  rc-synth sphere --nx 128 --dx 5um --radius 7.5mm |\n"
        "      rc-solve --load 240N --estar 114GPa --report hertz.json | rc-info\n",
    .opts = opts,
    .reads = READS_STREAM,
    .writes = WRITES_STREAM,
};

/* ---- the command line ---- */

static void
check_arguments(struct run *run)
{
    struct tool *t = &run->t;
    int bodies = tool_given(t, "E1") + tool_given(t, "nu1") + tool_given(t, "E2") +
                 tool_given(t, "nu2");

    if (tool_given(t, "load") + tool_given(t, "mean-pressure") + tool_given(t, "approach") != 1)
        tool_die(t, EXIT_USAGE, "give one of --load, --mean-pressure and --approach");
    if (tool_given(t, "estar") ? bodies > 0 : bodies != 4)
        tool_die(t, EXIT_USAGE, "give the elasticity, either as --estar or as --E1 --nu1 --E2 "
                                "--nu2, all four");
    if ((args.resume || tool_given(t, "interval")) && args.checkpoint == NULL)
        tool_die(t, EXIT_USAGE, "--resume and --interval need --checkpoint FILE");
    run->args = &args;
    run->steps = args.load.n > 0            ? &args.load
                 : args.mean_pressure.n > 0 ? &args.mean_pressure
                                            : &args.approach;
    run->stiffness = args.stiffness || run->steps->n > 1;
    run->nu = args.nu1;
    run->estar = bodies == 0 ? args.estar
                             : 1 / ((1 - args.nu1 * args.nu1) / args.e1 +
                                    (1 - args.nu2 * args.nu2) / args.e2);
}

/* ---- one case ---- */

static void
add_sphere(struct run *run, struct rc_grid *g)
{
    struct rc_shape shape = rc_grid_shape(g);
    double *sphere = malloc(g->nx * g->ny * sizeof *sphere);

    if (sphere == NULL)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "out of memory");
    rc_synth_sphere(&shape, args.radius, sphere);
    for (size_t k = 0; k < g->nx * g->ny; k++)
        g->v[k] += sphere[k];
    free(sphere);
}

static void
warn_before(struct run *run, const struct rc_grid *g)
{
    struct rc_shape shape = rc_grid_shape(g);
    const char *periodic = rc_grid_get(g, "periodic");
    struct rc_statistics st;
    char where[256];

    tool_where(&run->t, g, where, sizeof where);
    if (!args.periodic && periodic != NULL && strcmp(periodic, "yes") == 0 && isnan(args.radius))
        tool_warn(&run->t, "%s: the surface is periodic, the solution is not: beyond the map there "
                           "is no material", where);
    if (!args.periodic && g->ny == 1 && g->nx > 1)
        tool_warn(&run->t, "%s: a profile is solved as a strip %g m wide, not as a ridge without "
                           "end", where, g->dy);
    rc_measure(&shape, g->v, &st);
    if (st.rms_slope > 0.3)
        tool_warn(&run->t, "%s: RMS slope %.2f is beyond the theory of small slopes (0.3): expect "
                           "pressures that are too high", where, st.rms_slope);
}

static void
warn_after(struct run *run, const struct rc_grid *g, const struct rc_contact *c)
{
    char where[256];

    tool_where(&run->t, g, where, sizeof where);
    if (!args.periodic && c->edge_load_fraction > 0.01)
        tool_warn(&run->t, "%s: %.1f %% of the load is on the outer 2 %% of the map: the contact "
                           "reaches its edge", where, 100 * c->edge_load_fraction);
    if (!c->converged && tool_interrupted() == 0)
        tool_warn(&run->t, "%s: stopped at an estimated error of %.2g after %zu iterations: raise "
                           "--tol", where, c->pressure_error, c->iterations);
}

static struct rc_problem
problem_of(struct run *run, const struct rc_grid *g, size_t step)
{
    double number = run->steps->v[step];
    double area = g->dx * g->dy * (double)(g->nx * g->ny);

    return (struct rc_problem){
        .boundary = args.periodic ? RC_PERIODIC : RC_FREE,
        .estar = run->estar,
        .load = args.load.n > 0 ? number : args.mean_pressure.n > 0 ? number * area : 0,
        .approach = args.approach.n > 0 ? number : 0,
        .hardness = args.hardness,
        .tol = args.tol,
        .engine = args.kernel,
        .method = args.method,
        .threads = run->t.threads,
        .discretization = args.discretization,
        .watch = solve_watch,
        .watcher = run,
    };
}

static void
solve(struct run *run, const struct rc_grid *g, struct rc_solver *solver)
{
    bool kept = checkpoint_case(run->checkpoint, g, solver);
    double start = solve_now();

    while (tool_interrupted() == 0 && rc_solver_step(solver) == RC_MORE)
        checkpoint_pass(run->checkpoint, g, solver);
    tool_progress_end(&run->t);
    run->iterate = solve_now() - start;
    if (!kept || rc_solver_iterations(solver) > 1) /* else it is there already */
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

    if (rc_grid_set(g, "boundary", args.periodic ? "periodic" : "free", &err) != RC_OK ||
        rc_grid_set(g, "converged", c->converged ? "yes" : "no", &err) != RC_OK ||
        rc_grid_history(g, tool_history(&run->t), &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    if (run->steps->n > 1)
        set_number(run, g, "case", (double)run->number);
    set_number(run, g, "estar", run->estar);
    set_number(run, g, "nu", run->nu);
    /* the load asked for and the one reached are the same but for rounding */
    set_number(run, g, "load", args.load.n > 0 ? run->steps->v[run->step] : c->load);
    set_number(run, g, "hardness", args.hardness);
    set_number(run, g, "approach", c->approach);
}

static struct rc_grid *
result_grid(struct run *run, const struct rc_grid *g, enum solve_frame f)
{
    struct rc_err err;
    struct rc_grid *out = rc_grid_like(g, solve_frames[f].name, solve_frames[f].unit, &err);

    if (out == NULL)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    return out;
}

static double *
values(struct rc_grid *g)
{
    return g == NULL ? NULL : g->v;
}

static void
put_out(struct run *run, struct rc_grid *g, struct rc_grid *out[SOLVE_FRAMES],
        const struct rc_contact *c)
{
    if (solve_wanted(&args, SOLVE_HEIGHT))
        out[SOLVE_HEIGHT] = g;
    for (int f = 0; f < SOLVE_FRAMES; f++) {
        if (out[f] == NULL)
            continue;
        set_keys(run, out[f], c);
        tool_write(&run->t, out[f]);
        if (out[f] != g)
            rc_grid_free(out[f]);
    }
}

static void
do_load(struct run *run, struct rc_grid *g, struct rc_solver *solver)
{
    struct rc_grid *out[SOLVE_FRAMES] = {NULL};
    struct rc_contact c;
    struct rc_err err;
    double start, stiffness = NAN;

    solve(run, g, solver);
    start = solve_now();
    for (int f = 0; f < SOLVE_FRAMES; f++)
        if (f != SOLVE_HEIGHT && solve_wanted(&args, f))
            out[f] = result_grid(run, g, (enum solve_frame)f);
    rc_solver_result(solver, values(out[SOLVE_DISPLACEMENT]), values(out[SOLVE_GAP]), &c);
    if (out[SOLVE_PRESSURE] != NULL)
        memcpy(out[SOLVE_PRESSURE]->v, rc_solver_pressure(solver), g->nx * g->ny * sizeof *g->v);
    if (out[SOLVE_PLASTIC] != NULL)
        rc_solver_plastic(solver, out[SOLVE_PLASTIC]->v);
    if (run->stiffness && rc_solver_stiffness(solver, &stiffness, &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    c.convolutions = rc_solver_convolutions(solver);
    run->result = solve_now() - start;
    warn_after(run, g, &c);
    if (!c.converged)
        tool_fails_with(&run->t, EXIT_SHORT);
    solve_report(run, g, solver, &c, stiffness);
    put_out(run, g, out, &c);
}

/* The loads of a list, each from the solution of the last. */
static void
do_loads(struct run *run, struct rc_grid *g)
{
    struct rc_shape shape = rc_grid_shape(g);
    struct rc_problem problem = problem_of(run, g, 0);
    struct rc_solver *solver;
    struct rc_err err;

    run->began = solve_now();
    run->number = run->steps->n == 1 ? rc_grid_case(g) : run->number + 1;
    tool_demand_memory(&run->t, g, rc_solver_memory(&shape, &problem));
    solver = rc_solver_new(&shape, g->v, &problem, &err);
    if (solver == NULL)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    run->setup = solve_now() - run->began;
    for (run->step = 0; run->step < run->steps->n; run->step++) {
        if (run->step > 0 && tool_interrupted() != 0)
            break; /* the first has begun with the solver */
        if (run->step > 0) {
            problem = problem_of(run, g, run->step);
            run->began = solve_now();
            run->setup = 0;
            run->number++;
            if (rc_solver_again(solver, problem.load, problem.approach, &err) != RC_OK)
                tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
        }
        do_load(run, g, solver);
    }
    rc_solver_free(solver);
}

static void
do_case(struct run *run, struct rc_grid *g)
{
    if (strcmp(g->unit, "m") != 0)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE,
                    "its unit is '%s': heights are in metres; import the file again with --z-unit",
                    g->unit);
    tool_demand_finite(&run->t, g, "fill them with rc-detrend --fill");
    if (!isnan(args.radius))
        add_sphere(run, g);
    warn_before(run, g);
    run->nodes = g->nx * g->ny;
    checkpoint_surface(run->checkpoint, g);
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
    struct rc_grid *g;

    tool_start(&run.t, &info, argc, argv, &args);
    check_arguments(&run);
    tool_demand_writable(&run.t, "--report", args.report);
    if (!args.dry_run)
        run.checkpoint = checkpoint_open(&run, args.checkpoint, args.resume, args.interval);
    tool_catch_signals();
    while (tool_interrupted() == 0 && (g = tool_channel(&run.t, "height", false)) != NULL) {
        do_case(&run, g);
        rc_grid_free(g);
    }
    checkpoint_close(run.checkpoint);
    if (run.report != NULL && fclose(run.report) != 0)
        tool_die(&run.t, EXIT_IMPOSSIBLE, "--report %s: %s", args.report, strerror(errno));
    return tool_finish(&run.t);
}
