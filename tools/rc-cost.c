/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cost of accuracy in time: one contact solved in many ways, compared with an accurate solution. */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "tools/cost/cost.h"
#include "tools/problem/problem.h"

static struct args {
    struct physics physics;
    const char *yield, *adhesion; /* words of the command line, or NULL */
    struct tilt_args tilt;
    size_t kernels, methods; /* bits */
    double limit, budget, error;
    const char *depths; /* for rc-stress */
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
    {.group = yield_option, AT(yield)},
    {.group = adhesion_option, AT(adhesion)},
    {.group = history_option, AT(physics.history)},
    {.group = tilt_options, AT(tilt)},
    {.name = "kernel", .alias = "engine", .type = OPT_WORDS, AT(kernels), .words = words_engine,
     .arg = "LIST",
     .against = RULES({.with = "yield", .because = "the trials vary increments and slabs, with pcg and fft"},
                      {.with = "adhesion", .because = "there is only one method"}),
     .help = "try only these, of %s (default: all)"},
    {.name = "method", .type = OPT_WORDS, AT(methods), .words = words_method, .arg = "LIST",
     .against = RULES({.with = "yield", .because = "the trials vary increments and slabs, with pcg and fft"},
                      {.with = "adhesion", .because = "there is only one method"}),
     .help = "try only these, of %s (default: all)"},
    {.name = "depths", .type = OPT_TEXT, AT(depths), .arg = "LIST",
     .needs = RULES({.with = "nu|nu1", .because = "stresses depend on Poisson's ratio"}),
     .against = RULES({.with = "yield", .remedy = "compute these stresses with rc-stress from the frames of "
                                                  "rc-solve"}),
     .help = "stresses too, at these depths: a,b,c, a:b:n, a:b:log:n or auto"},
    {.name = "nu", .type = OPT_NUMBER, AT(nu), .min = -1, .max = 0.5, .above = true, .arg = "RATIO",
     .needs = RULES({.with = "depths"}),
     .against = RULES({.with = "layer", .because = "each layer has its own Poisson's ratio"}),
     .help = "Poisson's ratio for the stresses (default: --nu1)"},
    {.name = "mu", .type = OPT_NUMBER, AT(mu), .min = -10, .max = 10, .arg = "COEFFICIENT",
     .needs = RULES({.with = "depths"}),
     .help = "for the stresses: the surface also carries mu times the pressure along +x"},
    {.name = "leak", .type = OPT_CHOICE, AT(leak), .arg = "x|y",
     .help = "leakage through the gap too, in this direction, with its discretization error"},
    {.name = "budget", .type = OPT_NUMBER, .unit = UNIT_S, AT(budget), ABOVE_0, .arg = "TIME",
     .help = "print the most accurate rc-solve command within this time instead of the table"},
    {.name = "error", .type = OPT_NUMBER, AT(error), .min = 0, .max = 1, .above = true,
     .arg = "ERROR",
     .against = RULES({.with = "budget", .because = "one selects the fastest trial, the other the most "
                                                 "accurate one"}),
     .help = "print the fastest rc-solve command with at most this error instead of the table"},
    {.name = "limit", .type = OPT_NUMBER, .unit = UNIT_S, AT(limit), ABOVE_0, .arg = "TIME",
     .help = "time limit after the reference; trials that do not fit are left out (default 60s)"},
    {.name = "plot", .type = OPT_TEXT, AT(plot), .arg = "FILE",
     .help = "draw error against time: a .png, .svg or .pdf"},
    {.name = "report", .type = OPT_REPORT, AT(report), .arg = "FILE",
     .help = "write one JSON object per trial, or a row of FILE.tsv or .csv"},
    {.name = "dry-run", .type = OPT_FLAG, AT(dry_run),
     .help = "print the trials and their expected times, and stop"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-cost",
    .summary = "Time against accuracy, for a surface and a load",
    .operands = "[FILE...]",
    .examples =
        "  rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-slope 0.1 --seed 1 -o rough.rcg\n"
        "  rc-cost --periodic --mean-pressure 500MPa --estar 114GPa --plot cost.png rough.rcg\n"
        "  rc-cost --periodic --mean-pressure 500MPa --estar 114GPa --error 1e-3 rough.rcg\n",
    .opts = opts,
    .reads = READS_STREAM,
    .writes = WRITES_TEXT,
};

struct costs {
    struct tool t;
    size_t cases;
    struct report report;
};

/* ---- the command line ---- */

static bool
choosing(void)
{
    return !isnan(args.budget) || !isnan(args.error);
}

static void
check_arguments(struct costs *run)
{
    struct tool *t = &run->t;
    struct physics *physics = &args.physics;

    physics->pulls = args.adhesion != NULL;
    physics_check(t, physics);
    if (physics_steps(physics)->n > 1 && !physics->history)
        tool_usage(t, "one load at a time: %zu were given", physics_steps(physics)->n);
    ending_demand_picture(t, "--plot", args.plot);
    tool_demand_writable(t, "--plot", args.plot);
    report_open(&run->report, t, args.report);
}

/* Prints on a terminal, or with --progress. */
static void
tell(struct costs *run, const char *text)
{
    if (!run->t.quiet && (run->t.progress != NULL || run->t.verbose || isatty(STDERR_FILENO)))
        fprintf(stderr, "%s: %s\n", info.name, text);
}

/* ---- expected times ---- */

static void
plan(struct costs *run, struct cost_case *c)
{
    char text[160], name[128];
    double all = 0;
    size_t n = 0, out = 0;

    cost_plan(c, &c->reference);
    for (size_t k = 0; k < c->pressures; k++) {
        struct cost_trial *m = &c->trial[k];

        cost_plan(c, m);
        m->expected = m->planned;
        if (m->state != COST_OPEN)
            continue;
        n++;
        if (all + m->expected > c->limit) {
            out++;
            continue;
        }
        for (size_t runs = 0; runs == 0 || cost_again((double)runs, m->expected); runs++)
            all += m->expected;
    }
    c->reference.expected = c->reference.planned;
    snprintf(text, sizeof text,
             "%zu ways to solve %zu x %zu nodes, about %.2g s after %.2g s for the reference; "
             "%zu of them are expected beyond --limit",
             n, c->shape.nx, c->shape.ny, all, c->reference.expected, out);
    if (!args.dry_run) {
        tell(run, text);
        return;
    }
    fprintf(run->t.output.file, "%s\n", text);
    for (size_t k = 0; k < c->pressures; k++) {
        struct cost_trial *m = &c->trial[k];

        if (m->state == COST_OPEN)
            fprintf(run->t.output.file, "  %-40s about %8.2g s, %.0f MiB\n", cost_name(name, m),
                    m->expected, m->mebibytes);
        else
            fprintf(run->t.output.file, "  %-40s %s\n", cost_name(name, m), m->why);
    }
}

/* ---- results ---- */

static void
write_plot(struct costs *run, const struct cost_case *c)
{
    size_t bytes;
    struct whole_file whole;
    unsigned char *picture;
    FILE *file;

    if (args.plot == NULL)
        return;
    if ((picture = cost_plot(c, ending_of(args.plot), &bytes, &run->t.err)) == NULL)
        tool_die(&run->t, "--plot %s: %s", args.plot, run->t.err.text);
    if ((file = whole_file_open(&whole, args.plot)) == NULL ||
        fwrite(picture, 1, bytes, file) != bytes || !whole_file_put(&whole, file))
        tool_die(&run->t, "--plot %s: %s", args.plot, strerror(errno));
    free(picture);
}

static void
tell_results(struct costs *run, struct cost_case *c)
{
    cost_mark(c);
    cost_report(c, &run->report);
    write_plot(run, c);
    for (size_t k = 0; k < c->pressures; k++)
        if (c->trial[k].optimistic) {
            char name[128];
            tool_warn(&run->t, "%s: the estimate %.1e is below the true error %.1e",
                      cost_name(name, &c->trial[k]), c->trial[k].is.estimate, c->trial[k].is.error);
        }
    if (run->t.output.report_alone)
        return;
    if (choosing())
        cost_command(c, run->t.output.file);
    else
        cost_table(c, run->t.output.file);
}

/* ---- the run ---- */

/* Writes the case to a file for the programs. */
static int
write_map(struct costs *run, const struct rc_grid *g, const struct rc_grid *hardness)
{
    int fd = cost_file(&run->t), again = dup(fd);
    FILE *file = again < 0 ? NULL : fdopen(again, "wb");
    struct rc_writer *writer;

    rc_err_set(&run->t.err, "a temporary file cannot be written");
    if (file == NULL || (writer = rc_writer_new(file, &run->t.err)) == NULL ||
        rc_writer_put(writer, g, &run->t.err) != RC_OK ||
        (hardness != NULL && rc_writer_put(writer, hardness, &run->t.err) != RC_OK) ||
        rc_writer_end(writer, &run->t.err) != RC_OK || fclose(file) != 0)
        tool_refuse(&run->t, g, "%s", run->t.err.text);
    rc_writer_free(writer);
    return fd;
}

static const char *
number(double value, char text[RC_NUMBER_SIZE])
{
    return isnan(value) ? NULL : rc_number_text(text, value);
}

static void
do_case(struct costs *run, struct rc_grid *g, const struct rc_grid *hardness)
{
    const bool stresses = tool_given(&run->t, "depths");
    char nu[RC_NUMBER_SIZE], mu[RC_NUMBER_SIZE];
    struct cost_case c = {.tool = &run->t,
                          .heights = g,
                          .shape = rc_grid_shape(g),
                          .about = COST_PRESSURE,
                          .line.boundary = args.physics.boundary,
                          .line.leak = args.leak,
                          .line.depths = stresses ? args.depths : NULL,
                          .line.nu = number(args.nu, nu),
                          .line.mu = args.mu == 0 ? NULL : number(args.mu, mu),
                          .limit = args.limit,
                          .budget = args.budget,
                          .error = args.error,
                          .choosing = choosing(),
                          .shown = args.plot != NULL || args.report != NULL,
                          .files.grid = {-1, -1, -1, -1}};

    if (++run->cases > 1 && (choosing() || args.plot != NULL))
        tool_refuse(&run->t, g, "%s is for one case: give one height map",
                    args.plot != NULL ? "a picture" : "a command");
    c.about |= (args.yield != NULL ? COST_YIELD : 0) | (args.adhesion != NULL ? COST_ADHESION : 0) |
               (args.leak != NULL ? COST_LEAK : 0) | (stresses ? COST_STRESS : 0);
    c.line.words = tool_result_words(&run->t, c.line.word, COST_WORDS / 2);
    cost_trials(&c, args.kernels, args.methods);
    c.files.grid[0] = write_map(run, g, hardness);
    c.files.solution = cost_file(&run->t);
    c.files.output = cost_file(&run->t);
    if ((c.files.nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC)) < 0)
        tool_die(&run->t, "/dev/null: %s", strerror(errno));
    plan(run, &c);
    if (!args.dry_run && tool_interrupted() == 0) {
        cost_solve_reference(&c);
        cost_run_trials(&c);
        tell_results(run, &c);
    }
    for (size_t k = 0; k < sizeof c.files.grid / sizeof *c.files.grid; k++)
        if (c.files.grid[k] >= 0)
            close(c.files.grid[k]);
    close(c.files.solution);
    close(c.files.output);
    close(c.files.nowhere);
    free(c.pressure);
    free(c.solved);
    free(c.stressed);
    free(c.said);
    free(c.trial);
}

int
main(int argc, char **argv)
{
    static struct costs run;
    struct rc_grid *g, *hardness;

    tool_start(&run.t, &info, argc, argv, &args);
    check_arguments(&run);
    tool_catch_signals();
    while (tool_interrupted() == 0 &&
           (g = tool_channel_beside(&run.t, "height", "hardness", &hardness)) != NULL) {
        do_case(&run, g, hardness);
        rc_grid_free(g);
        rc_grid_free(hardness);
    }
    report_close(&run.report);
    return tool_finish(&run.t);
}
