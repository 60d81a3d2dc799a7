/* Contact of a height map with an elastic half-space. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#include "../libcontact/contact.h"
#include "json.h"
#include "tool.h"

static struct args {
    double load, mean_pressure;
    double estar, e1, nu1, e2, nu2;
    double hardness, radius, tol;
    const char *kernel, *method, *report;
    bool periodic;
    size_t output; /* bits of enum frame */
} args = {
    .load = NAN, .mean_pressure = NAN, .estar = NAN, .e1 = NAN, .nu1 = NAN, .e2 = NAN, .nu2 = NAN,
    .hardness = INFINITY, .radius = NAN, .tol = NAN, .kernel = "auto", .method = "auto",
    .output = ~(size_t)0,
};

#define AT(field) .at = offsetof(struct args, field)
#define ABOVE_0 .min = 0, .max = INFINITY, .above = true
static const struct opt opts[] = {
    {.name = "load", .type = OPT_NUMBER, .unit = UNIT_N, AT(load), ABOVE_0, .result = true,
     .arg = "FORCE", .help = "total normal force"},
    {.name = "mean-pressure", .type = OPT_NUMBER, .unit = UNIT_PA, AT(mean_pressure), ABOVE_0,
     .result = true, .arg = "PRESSURE", .help = "the load as a mean over the whole map"},
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
    {.name = "output", .type = OPT_WORDS, AT(output), .words = "pressure|gap|displacement|height",
     .arg = "LIST", .help = "frames to write, of pressure,gap,displacement,height (default: all)"},
    {.name = "report", .type = OPT_TEXT, AT(report), .arg = "FILE",
     .help = "write one JSON object a case: figures, accuracy, cost"},
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

enum frame { /* in the order of --output's words */
    PRESSURE,
    GAP,
    DISPLACEMENT,
    HEIGHT,
    FRAMES
};
static const struct {
    const char *name, *unit;
} frames[FRAMES] = {
    [PRESSURE] = {"pressure", "Pa"},
    [GAP] = {"gap", "m"},
    [DISPLACEMENT] = {"displacement", "m"},
    [HEIGHT] = {"height", "m"},
};

struct run {
    struct tool t;
    double estar, nu; /* nu: NAN unless body 1 was described */
    FILE *report;
    double began, setup, iterate, result; /* seconds */
};

static double
now(void)
{
    struct timespec ts;

    clock_gettime(CLOCK_MONOTONIC, &ts);
    return (double)ts.tv_sec + 1e-9 * (double)ts.tv_nsec;
}

/* ---- the command line ---- */

static bool
wanted(int frame)
{
    return args.output >> frame & 1;
}

static void
check_arguments(struct run *run)
{
    struct tool *t = &run->t;
    int bodies = tool_given(t, "E1") + tool_given(t, "nu1") + tool_given(t, "E2") +
                 tool_given(t, "nu2");

    if (tool_given(t, "load") == tool_given(t, "mean-pressure"))
        tool_die(t, EXIT_USAGE, "give the load, either as --load or as --mean-pressure");
    if (tool_given(t, "estar") ? bodies > 0 : bodies != 4)
        tool_die(t, EXIT_USAGE, "give the elasticity, either as --estar or as --E1 --nu1 --E2 "
                                "--nu2, all four");
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

static struct rc_solver *
solve(struct run *run, const struct rc_grid *g)
{
    struct rc_shape shape = rc_grid_shape(g);
    double area = shape.dx * shape.dy * (double)(shape.nx * shape.ny);
    struct rc_problem problem = {
        .boundary = args.periodic ? RC_PERIODIC : RC_FREE,
        .estar = run->estar,
        .load = isnan(args.load) ? args.mean_pressure * area : args.load,
        .hardness = args.hardness,
        .tol = args.tol,
        .engine = args.kernel,
        .method = args.method,
        .threads = run->t.threads,
    };
    struct rc_solver *solver;
    struct rc_err err;

    run->began = now();
    tool_demand_memory(&run->t, g, rc_solver_memory(&shape, &problem));
    solver = rc_solver_new(&shape, g->v, &problem, &err);
    if (solver == NULL)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    run->setup = now() - run->began;
    while (tool_interrupted() == 0 && rc_solver_step(solver) == RC_MORE) {
        double error = rc_solver_error(solver);
        if (isnan(error))
            tool_progress(&run->t, "iteration %zu", rc_solver_iterations(solver));
        else
            tool_progress(&run->t, "iteration %zu, error %.1e", rc_solver_iterations(solver),
                          error);
    }
    tool_progress_end(&run->t);
    run->iterate = now() - run->began - run->setup;
    return solver;
}

/* ---- results ---- */

static const char *
boundary(void)
{
    return args.periodic ? "periodic" : "free";
}

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

    if (rc_grid_set(g, "boundary", boundary(), &err) != RC_OK ||
        rc_grid_set(g, "converged", c->converged ? "yes" : "no", &err) != RC_OK ||
        rc_grid_history(g, tool_history(&run->t), &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    set_number(run, g, "estar", run->estar);
    set_number(run, g, "nu", run->nu);
    /* the load asked for and the one reached are the same but for rounding */
    set_number(run, g, "load", isnan(args.load) ? c->load : args.load);
    set_number(run, g, "hardness", args.hardness);
    set_number(run, g, "approach", c->approach);
}

static const char *
hardness_effect(const struct rc_contact *c)
{
    if (isinf(args.hardness))
        return "left out: no --hardness";
    return c->hardness_active ? "on" : "left out: the largest elastic pressure is below it";
}

static void
report_effects(struct json *j, const struct rc_solver *solver, const struct rc_contact *c)
{
    json_object(j, "effects");
    json_text(j, "kernel", rc_solver_engine_reason(solver));
    json_text(j, "hardness", hardness_effect(c));
    json_text(j, "sphere", isnan(args.radius) ? "left out: no --radius" : "on");
    json_text(j, "padding", args.periodic ? "left out: the map is periodic" : "on");
    for (int f = 0; f < FRAMES; f++)
        json_text(j, frames[f].name, wanted(f) ? "on" : "left out: not in --output");
    json_end(j, '}');
}

static void
report_figures(struct json *j, const struct rc_contact *c)
{
    json_number(j, "load", c->load);
    json_number(j, "mean_pressure", c->mean_pressure);
    json_number(j, "max_pressure", c->max_pressure);
    json_count(j, "contact_nodes", c->contact_nodes);
    json_number(j, "contact_area", c->contact_area);
    json_number(j, "contact_fraction", c->contact_fraction);
    json_number(j, "plastic_area", c->plastic_area);
    json_number(j, "edge_load_fraction", c->edge_load_fraction);
    json_number(j, "approach", c->approach);
    json_number(j, "mean_gap", c->mean_gap);
    json_null(j, "stiffness");
    json_count(j, "iterations", c->iterations);
    json_number(j, "convolutions", c->convolutions);
    json_number(j, "kkt_residual", c->kkt_residual);
    json_number(j, "pressure_error_estimate", c->pressure_error);
    json_null(j, "discretization_error_estimate");
    json_bool(j, "converged", c->converged);
}

static void
report(struct run *run, const struct rc_grid *g, const struct rc_solver *solver,
       const struct rc_contact *c)
{
    struct rusage usage;
    struct json j;

    if (args.report == NULL)
        return;
    if (run->report == NULL && (run->report = fopen(args.report, "w")) == NULL)
        tool_die(&run->t, EXIT_IMPOSSIBLE, "--report %s: %s", args.report, strerror(errno));
    getrusage(RUSAGE_SELF, &usage);
    json_open(&j, run->report);
    json_count(&j, "case", rc_grid_case(g));
    json_text(&j, "source", rc_grid_get(g, "source"));
    json_count(&j, "nx", g->nx);
    json_count(&j, "ny", g->ny);
    json_number(&j, "dx", g->dx);
    json_number(&j, "dy", g->dy);
    json_text(&j, "boundary", boundary());
    json_text(&j, "kernel", rc_solver_engine(solver));
    json_text(&j, "method", rc_solver_method(solver));
    json_count(&j, "threads", run->t.threads);
    report_figures(&j, c);
    report_effects(&j, solver, c);
    json_object(&j, "seconds");
    json_number(&j, "setup", run->setup);
    json_number(&j, "iterate", run->iterate);
    json_number(&j, "result", run->result);
    json_number(&j, "total", now() - run->began);
    json_end(&j, '}');
    json_count(&j, "peak_memory", (size_t)usage.ru_maxrss * 1024);
    json_close(&j);
    if (ferror(run->report))
        tool_die(&run->t, EXIT_IMPOSSIBLE, "--report %s: writing failed", args.report);
}

static struct rc_grid *
result_grid(struct run *run, const struct rc_grid *g, enum frame f)
{
    struct rc_err err;
    struct rc_grid *out = rc_grid_like(g, frames[f].name, frames[f].unit, &err);

    if (out == NULL)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    return out;
}

static void
do_case(struct run *run, struct rc_grid *g)
{
    struct rc_grid *out[FRAMES] = {NULL};
    struct rc_solver *solver;
    struct rc_contact c;
    double start;

    if (strcmp(g->unit, "m") != 0)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE,
                    "its unit is '%s': heights are in metres; import the file again with --z-unit",
                    g->unit);
    tool_demand_finite(&run->t, g, "fill them with rc-detrend --fill");
    if (!isnan(args.radius))
        add_sphere(run, g);
    warn_before(run, g);
    solver = solve(run, g);
    start = now();
    for (int f = PRESSURE; f < HEIGHT; f++)
        if (wanted(f))
            out[f] = result_grid(run, g, (enum frame)f);
    rc_solver_result(solver, out[DISPLACEMENT] == NULL ? NULL : out[DISPLACEMENT]->v,
                     out[GAP] == NULL ? NULL : out[GAP]->v, &c);
    if (out[PRESSURE] != NULL)
        memcpy(out[PRESSURE]->v, rc_solver_pressure(solver), g->nx * g->ny * sizeof *g->v);
    run->result = now() - start;
    warn_after(run, g, &c);
    if (!c.converged)
        tool_fails_with(&run->t, EXIT_SHORT);
    report(run, g, solver, &c);
    rc_solver_free(solver);
    if (wanted(HEIGHT))
        out[HEIGHT] = g;
    for (int f = 0; f < FRAMES; f++) {
        if (out[f] == NULL)
            continue;
        set_keys(run, out[f], &c);
        tool_write(&run->t, out[f]);
        if (out[f] != g)
            rc_grid_free(out[f]);
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
    tool_catch_signals();
    while (tool_interrupted() == 0 && (g = tool_channel(&run.t, "height", false)) != NULL) {
        do_case(&run, g);
        rc_grid_free(g);
    }
    if (run.report != NULL && fclose(run.report) != 0)
        tool_die(&run.t, EXIT_IMPOSSIBLE, "--report %s: %s", args.report, strerror(errno));
    return tool_finish(&run.t);
}
