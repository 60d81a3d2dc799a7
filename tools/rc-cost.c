/* What accuracy costs in time: one contact solved in many ways, beside one that is right. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "tools/cli/cli.h"
#include "tools/cost/cost.h"

static struct args {
    struct physics physics;
    const char *yield, *adhesion; /* as on the line, or NULL */
    size_t kernels, methods;      /* bits */
    double limit, budget, error;
    struct numbers depths; /* none: auto, where it was given */
    double nu, mu;
    const char *plot, *report, *leak;
    bool dry_run;
} args = {.physics = PHYSICS_NONE,
          .kernels = SIZE_MAX,
          .methods = SIZE_MAX,
          .limit = 60,
          .budget = NAN,
          .error = NAN,
          .nu = NAN};

#define AT(field) .at = offsetof(struct args, field)
#define ABOVE_0 .min = 0, .max = INFINITY, .above = true
/* clang-format off */
static const struct opt opts[] = {
    {.group = physics_options, AT(physics)},
    {.name = "yield", .type = OPT_TEXT, AT(yield), .result = true, .arg = "Y[,HM]|FILE.tsv",
     .help = "body 1 yields inside, as for rc-solve: increments and slabs are what is tried"},
    {.name = "adhesion", .type = OPT_TEXT, AT(adhesion), .result = true, .arg = "WORK[,LAW[,RANGE]]",
     .help = "the bodies attract each other, as for rc-solve: tolerances and grids are what is tried"},
    {.name = "kernel", .alias = "engine", .type = OPT_WORDS, AT(kernels), .words = words_engine,
     .arg = "LIST", .help = "try only these, of %s (default: all)"},
    {.name = "method", .type = OPT_WORDS, AT(methods), .words = words_method, .arg = "LIST",
     .help = "try only these, of %s (default: all)"},
    {.name = "depths", .type = OPT_NUMBERS, .unit = UNIT_M, AT(depths), .min = 0, .max = INFINITY,
     .word = "auto", .arg = "LIST",
     .help = "stresses too, at these depths: a,b,c, a:b:n, a:b:log:n or auto"},
    {.name = "nu", .type = OPT_NUMBER, AT(nu), .min = -1, .max = 0.5, .above = true, .arg = "RATIO",
     .help = "Poisson's ratio for the stresses (default: --nu1)"},
    {.name = "mu", .type = OPT_NUMBER, AT(mu), .min = -10, .max = 10, .arg = "COEFFICIENT",
     .help = "for the stresses: the surface also carries mu times the pressure along +x"},
    {.name = "leak", .type = OPT_CHOICE, AT(leak), .arg = "x|y",
     .help = "the flow through the gap too, in this direction: its error against the grid"},
    {.name = "budget", .type = OPT_NUMBER, .unit = UNIT_S, AT(budget), ABOVE_0, .arg = "TIME",
     .help = "print the rc-solve command that is nearest within this time, and no table"},
    {.name = "error", .type = OPT_NUMBER, AT(error), .min = 0, .max = 1, .above = true,
     .arg = "ERROR",
     .help = "print the quickest rc-solve command whose true error is at most this, no table"},
    {.name = "limit", .type = OPT_NUMBER, .unit = UNIT_S, AT(limit), ABOVE_0, .arg = "TIME",
     .help = "for all of it, after the reference: what would not fit is left out (default 60s)"},
    {.name = "plot", .type = OPT_TEXT, AT(plot), .arg = "FILE",
     .help = "draw error against time: a .png, .svg or .pdf"},
    {.name = "report", .type = OPT_REPORT, AT(report), .arg = "FILE",
     .help = "write one JSON object a way of solving, or a row of FILE.tsv or .csv"},
    {.name = "dry-run", .type = OPT_FLAG, AT(dry_run),
     .help = "say what would be run, and about how long it would take; do no more"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-cost",
    .summary = "What accuracy costs in time, for a surface and a load",
    .operands = "[FILE...]",
    .examples =
        "  rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-slope 0.1 --seed 1 -o rough.rcg\n"
        "  rc-cost --periodic --mean-pressure 500MPa --estar 114GPa --plot cost.png rough.rcg\n"
        "  rc-cost --periodic --mean-pressure 500MPa --estar 114GPa --error 1e-3 rough.rcg\n",
    .opts = opts,
    .reads = READS_STREAM,
    .writes = WRITES_TEXT,
};

struct run {
    struct tool t;
    size_t cases;
    struct report report;
    struct yield_law yield;
    struct attraction attraction;
};

/* ---- the command line ---- */

static bool
choosing(void)
{
    return !isnan(args.budget) || !isnan(args.error);
}

static void
read_yield(struct run *run)
{
    struct tool *t = &run->t;
    struct rc_err err;

    if (args.yield == NULL)
        return;
    if (yield_law_read(&run->yield, args.yield, &err) != RC_OK)
        tool_die(t, EXIT_USAGE, "--yield %s: %s", args.yield, err.text);
    yield_law_check(t, &run->yield, &args.physics);
    yield_law_refuse(t, tool_given(t, "kernel") || tool_given(t, "method"), "--kernel and --method",
                     "increments and slabs are what is tried, by the first of them");
    yield_law_refuse(t, tool_given(t, "depths"), "--depths",
                     "the stresses of what has yielded are rc-stress's to find, from its strain");
}

static void
refuse_beside_adhesion(struct tool *t, bool given, const char *what, const char *why)
{
    if (given)
        tool_die(t, EXIT_USAGE, "--adhesion: not with %s: %s", what, why);
}

static void
read_adhesion(struct run *run)
{
    struct tool *t = &run->t;
    struct rc_err err;

    if (args.adhesion == NULL)
        return;
    if (attraction_read(&run->attraction, args.adhesion, &err) != RC_OK)
        tool_die(t, EXIT_USAGE, "--adhesion %s: %s", args.adhesion, err.text);
    refuse_beside_adhesion(t, args.yield != NULL, "--yield",
                           "what yields inside is pressed by pressures alone");
    refuse_beside_adhesion(t, tool_given(t, "kernel") || tool_given(t, "method"),
                           "--kernel and --method", "there is one way to iterate it");
    refuse_beside_adhesion(t, tool_given(t, "depths"), "--depths",
                           "rc-stress takes the net pressures that rc-solve finds");
    refuse_beside_adhesion(t, args.leak != NULL, "--leak",
                           "rc-leak takes the gap that rc-solve finds");
}

static void
check_arguments(struct run *run)
{
    struct tool *t = &run->t;

    args.physics.attracts = args.adhesion != NULL;
    physics_check(t, &args.physics);
    if (physics_steps(&args.physics)->n > 1)
        tool_die(t, EXIT_USAGE, "one load at a time: %zu were given",
                 physics_steps(&args.physics)->n);
    if (tool_given(t, "budget") && tool_given(t, "error"))
        tool_die(t, EXIT_USAGE,
                 "--budget asks for the best in a time, --error for the quickest of an accuracy: "
                 "give one");
    if (args.physics.pair.one.layers > 0 && tool_given(t, "nu"))
        tool_die(t, EXIT_USAGE, "--nu: each layer has its own Poisson's ratio: leave it out");
    if (isnan(args.nu))
        args.nu = args.physics.nu1;
    if (tool_given(t, "depths") && isnan(args.nu))
        tool_die(t, EXIT_USAGE, "--depths: stresses need Poisson's ratio: give --nu");
    if (!tool_given(t, "depths") && (tool_given(t, "nu") || tool_given(t, "mu")))
        tool_die(t, EXIT_USAGE, "--nu and --mu are for stresses: give --depths as well");
    read_yield(run);
    read_adhesion(run);
    ending_demand_picture(t, "--plot", args.plot);
    tool_demand_writable(t, "--plot", args.plot);
    report_open(&run->report, t, args.report);
}

/* Said where somebody watches: on a terminal, or where progress is asked for. */
static void
tell(struct run *run, const char *text)
{
    if (!run->t.quiet && (run->t.progress || run->t.verbose || isatty(STDERR_FILENO)))
        fprintf(stderr, "%s: %s\n", info.name, text);
}

/* ---- what is to come ---- */

static void
plan(struct run *run, struct cost_case *c)
{
    char text[160], name[128];
    double all = 0;
    size_t n = 0, out = 0;

    c->reference.expected = cost_expect(c, &c->reference);
    for (size_t k = 0; k < c->trials; k++) {
        struct cost_trial *m = &c->trial[k];

        m->expected = cost_expect(c, m);
        if (m->state != COST_OPEN)
            continue;
        n++;
        if (all + m->expected > c->limit) {
            out++;
            continue;
        }
        for (size_t runs = 0; runs == 0 || cost_again(runs, m->expected); runs++)
            all += m->expected;
    }
    snprintf(text, sizeof text,
             "%zu ways to solve %zu x %zu nodes, about %.2g s after %.2g s for the reference; "
             "%zu of them are expected beyond --limit",
             n, c->shape.nx, c->shape.ny, all, c->reference.expected, out);
    if (!args.dry_run) {
        tell(run, text);
        return;
    }
    fprintf(run->t.out, "%s\n", text);
    for (size_t k = 0; k < c->trials; k++) {
        struct cost_trial *m = &c->trial[k];

        if (m->state == COST_OPEN)
            fprintf(run->t.out, "  %-40s about %8.2g s, %zu MiB\n", cost_name(name, m), m->expected,
                    (cost_memory(c, m) >> 20) + 1);
        else
            fprintf(run->t.out, "  %-40s %s\n", cost_name(name, m), m->why);
    }
}

/* ---- results ---- */

static void
write_plot(struct run *run, const struct cost_case *c)
{
    size_t bytes;
    struct rc_err err;
    struct whole_file whole;
    unsigned char *picture;
    FILE *file;

    if (args.plot == NULL)
        return;
    if ((picture = cost_plot(c, ending_of(args.plot), &bytes, &err)) == NULL)
        tool_die(&run->t, EXIT_IMPOSSIBLE, "--plot %s: %s", args.plot, err.text);
    if ((file = whole_file_open(&whole, args.plot)) == NULL ||
        fwrite(picture, 1, bytes, file) != bytes || !whole_file_put(&whole, file))
        tool_die(&run->t, EXIT_IMPOSSIBLE, "--plot %s: %s", args.plot, strerror(errno));
    free(picture);
}

static void
tell_results(struct run *run, struct cost_case *c)
{
    cost_mark(c);
    cost_report(c, &run->report);
    write_plot(run, c);
    for (size_t k = 0; k < c->trials; k++)
        if (c->trial[k].optimistic) {
            char name[128];
            tool_warn(&run->t, "%s: the estimate %.1e is below the true error %.1e",
                      cost_name(name, &c->trial[k]), c->trial[k].contact.pressure_error,
                      c->trial[k].error);
        }
    if (run->t.report_alone)
        return;
    if (choosing())
        cost_command(c, run->t.out);
    else
        cost_table(c, run->t.out);
}

/* ---- the run ---- */

static void
open_case(struct run *run, struct rc_grid *g, const struct rc_grid *hardness, struct cost_case *c)
{
    *c = (struct cost_case){.tool = &run->t,
                            .heights = g,
                            .shape = rc_grid_shape(g),
                            .problem = physics_problem(&args.physics, g, 0),
                            .limit = args.limit,
                            .budget = args.budget,
                            .error = args.error,
                            .choosing = choosing(),
                            .shown = args.plot != NULL || args.report != NULL,
                            .depths = args.depths,
                            .nu = args.nu,
                            .mu = args.mu,
                            .by_approach = args.physics.approach.n > 0,
                            .leak = args.leak == NULL ? '\0' : args.leak[0]};
    if (hardness != NULL)
        c->problem.hardness_map = hardness->v;
    c->yield = args.yield != NULL ? &run->yield.law : NULL;
    c->adhesion = args.adhesion != NULL ? &run->attraction.problem : NULL;
    c->reference.settings =
        c->adhesion != NULL ? cost_attracting_reference() : cost_reference(c->yield != NULL);
    c->reference.shape = c->shape;
    c->trial = c->adhesion != NULL ? cost_attracting_trials(&c->trials)
               : c->yield != NULL  ? cost_yielding_trials(&c->trials)
                                   : cost_trials(args.kernels, args.methods, &c->trials);
    c->stress = tool_given(&run->t, "depths") ? cost_stress_trials(c, &c->stresses) : NULL;
    if (c->trial == NULL || (tool_given(&run->t, "depths") && c->stress == NULL))
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "out of memory");
    for (size_t k = 0; k < c->trials; k++)
        c->trial[k].shape = cost_coarse_shape(&c->shape, c->trial[k].settings.coarse);
    cost_exclude(c);
}

static void
close_case(struct cost_case *c)
{
    free(c->pressure);
    free(c->trial);
    free(c->stress);
    if (c->depths.v != args.depths.v)
        free(c->depths.v);
}

/* Memory of the largest trial, which runs in a process of its own, and of the maps of this one: the
 * reference, the pressure that comes back, and that of a trial. */
static size_t
memory_for(const struct cost_case *c)
{
    size_t most = 0, map = c->shape.nx * c->shape.ny * sizeof(double);

    for (size_t k = 0; k <= c->trials; k++) {
        const struct cost_trial *trial = k < c->trials ? &c->trial[k] : &c->reference;
        size_t bytes;

        if (trial->state != COST_OPEN)
            continue;
        bytes = cost_memory(c, trial) + 2 * (size_t)TOOL_TRANSFORMS;
        most = bytes > most ? bytes : most;
    }
    return most + 3 * map;
}

static void
solve_reference(struct run *run, struct cost_case *c)
{
    size_t n = c->shape.nx * c->shape.ny;
    double *p;

    tool_demand_memory(&run->t, c->heights, memory_for(c));
    if ((p = malloc(n * sizeof *p)) == NULL)
        tool_die_at(&run->t, c->heights, EXIT_IMPOSSIBLE, "out of memory");
    if (!cost_trial_run(c, &c->reference, args.limit, p))
        tool_die_at(&run->t, c->heights, EXIT_IMPOSSIBLE,
                    "interrupted before anything was measured");
    if (c->reference.state != COST_DONE)
        tool_die_at(&run->t, c->heights, EXIT_IMPOSSIBLE, "no reference: %s", c->reference.why);
    c->pressure = p;
}

static void
do_case(struct run *run, struct rc_grid *g, const struct rc_grid *hardness)
{
    struct cost_case c;

    if (++run->cases > 1 && (choosing() || args.plot != NULL))
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s is for one case: give one height map",
                    args.plot != NULL ? "a picture" : "a command");
    physics_heights(&run->t, &args.physics, g);
    open_case(run, g, hardness, &c);
    plan(run, &c);
    if (!args.dry_run) {
        solve_reference(run, &c);
        cost_run_trials(&c);
        tell_results(run, &c);
    }
    close_case(&c);
}

int
main(int argc, char **argv)
{
    static struct run run;
    struct rc_grid *g, *hardness;

    tool_start(&run.t, &info, argc, argv, &args);
    check_arguments(&run);
    tool_catch_signals();
    while (tool_interrupted() == 0 &&
           (g = tool_channel_beside(&run.t, "height", "hardness", &hardness)) != NULL) {
        physics_hardness(&run.t, hardness);
        do_case(&run, g, hardness);
        rc_grid_free(g);
        rc_grid_free(hardness);
    }
    report_close(&run.report);
    free(args.depths.v);
    return tool_finish(&run.t);
}
