/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cost of accuracy in time: one command run with many values of its options, compared with an accurate
 * run. */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "tools/scan/scan.h"

static struct args {
    const char *tol, *grid, *of;
    struct steps lists; /* --vary and --reference */
    double limit, budget;
    const char *error;
    const char *plot, *report;
    bool dry_run;
    struct scan_options scan;
} args = {.limit = 60, .budget = NAN, .scan = {.repeats = 4, .seed = 1}};

#define AT(field) .at = offsetof(struct args, field)
#define ABOVE_0 .min = 0, .max = INFINITY, .above = true
#define ONE_THING                                                                                  \
    .against = RULES({.with = "tol|grid|vary|reference|of|budget|error",                           \
                      .because = "one varies the map, the other the command",                      \
                      .remedy = "run rc-cost twice"})
/* clang-format off */
static const struct opt opts[] = {
    {.name = "tol", .type = OPT_TEXT, AT(tol), .result = true, .arg = "LIST",
     .help = "values of --tol, in each program that has it (default 1e-1,1e-2,1e-3,1e-4,1e-6)"},
    {.name = "grid", .type = OPT_TEXT, AT(grid), .result = true, .whole = true, .arg = "LIST",
     .help = "grids with 1/k of the nodes a side: 4,2,1 (default 8,4,2,1 if no list is given)"},
    {.name = "vary", .type = OPT_TEXTS, AT(lists), .result = true, .arg = "[N.]OPTION=LIST",
     .help = "values of an option of the command, or of its program N; again for further options"},
    {.name = "reference", .type = OPT_TEXTS, AT(lists), .result = true, .arg = "[N.]OPTION=VALUE",
     .help = "the value of the reference (default: one step beyond the list)"},
    {.name = "of", .type = OPT_TEXT, AT(of), .result = true, .arg = "NAME",
     .help = "the frame or figure whose error is ranked (default: the first frame that differs)"},
    {.name = "noise", .type = OPT_NUMBERS, .unit = UNIT_M, AT(scan.noise), ABOVE_0, .result = true, ONE_THING,
     .arg = "SIGMA[,LENGTH]",
     .help = "bars: the standard deviation of the noise, and its correlation length"},
    {.name = "repeat", .type = OPT_TEXT, AT(scan.again), .result = true, .arg = "FILE",
     .against = RULES({.with = "noise", .because = "either gives the noise"},
                      {.with = "tol|grid|vary|reference|of|budget|error",
                       .because = "one varies the map, the other the command",
                       .remedy = "run rc-cost twice"}),
     .help = "the noise from a second scan of the same place"},
    {.name = "resolution", .type = OPT_FLAG, AT(scan.resolution), .result = true, ONE_THING,
     .help = "bars: means over 2 x 2 and 4 x 4 nodes"},
    {.name = "patch", .type = OPT_FLAG, AT(scan.patch), .result = true, ONE_THING,
     .help = "bars: the quarters of the map"},
    {.name = "holes", .type = OPT_FLAG, AT(scan.holes), .result = true, ONE_THING,
     .help = "bars: the pattern of missing nodes at other places"},
    {.name = "filter", .type = OPT_TEXT, AT(scan.filter), .result = true, ONE_THING, .arg = "'A;B'",
     .help = "choices of rc-detrend, as in '--lowpass 3um;--lowpass 5um': the largest change"},
    {.name = "filter-bar", .type = OPT_FLAG, AT(scan.filter_bar), .result = true,
     .needs = RULES({.with = "filter"}), .help = "the filters count in the bar"},
    {.name = "repeats", .type = OPT_COUNT, AT(scan.repeats), .result = true, .min = 2, .max = 64, .arg = "N",
     .needs = RULES({.with = "noise|repeat"}), .help = "maps with noise (default 4)"},
    {.name = "seed", .type = OPT_COUNT, AT(scan.seed), .result = true, .arg = "S",
     .help = "of the noise and of the places of the holes (default 1)"},
    {.name = "budget", .type = OPT_NUMBER, .unit = UNIT_S, AT(budget), ABOVE_0, .arg = "TIME",
     .help = "print the most accurate command within this time instead of the table"},
    {.name = "error", .type = OPT_TEXT, AT(error), .arg = "ERROR",
     .against = RULES({.with = "budget", .because = "one selects the fastest trial, the other the most "
                                                 "accurate one"}),
     .help = "print the fastest command with at most this error instead of the table"},
    {.name = "limit", .type = OPT_NUMBER, .unit = UNIT_S, AT(limit), ABOVE_0, .arg = "TIME",
     .help = "time limit after the reference; trials that do not fit are left out (default 60s)"},
    {.name = "plot", .type = OPT_TEXT, AT(plot), .arg = "FILE",
     .help = "draw error against time, or the bars: a .png, .svg or .pdf"},
    {.name = "report", .type = OPT_REPORT, AT(report), .arg = "FILE",
     .help = "write one JSON object per trial, or a row of FILE.tsv or .csv"},
    {.name = "dry-run", .type = OPT_FLAG, AT(dry_run),
     .help = "print the trials and their expected times, and stop"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-cost",
    .summary = "Time against accuracy, for a command of these tools",
    .operands = "[FILE...] -- COMMAND [\"|\" COMMAND]...",
    .examples =
        "  rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-slope 0.1 --seed 1 -o rough.rcg\n"
        "  rc-cost --plot cost.png rough.rcg -- \\\n"
        "      rc-solve --periodic --mean-pressure 500MPa --estar 114GPa\n"
        "  rc-cost --error 1e-3 rough.rcg -- rc-solve --periodic --mean-pressure 500MPa --estar "
        "114GPa\n"
        "  rc-cost --grid 4,2,1 --of flow_conductance rough.rcg -- \\\n"
        "      rc-solve --periodic --mean-pressure 500MPa --estar 114GPa '|' rc-leak\n",
    .opts = opts,
    .reads = READS_STREAM,
    .writes = WRITES_TEXT,
};

static struct costs {
    struct tool t;
    struct report report;
    struct cost_case c;
    struct scan scan;
} run;

/* ---- the command line ---- */

static void
read_lists(struct tool *t, struct cost_case *c)
{
    const bool none = args.tol == NULL && args.grid == NULL && args.lists.n == 0;
    bool tol = args.tol != NULL;

    for (size_t k = 0; k < c->command.programs; k++)
        tol = tol || (none && cost_option(&c->command.program[k], "tol") != NULL);
    if (args.grid != NULL || none)
        cost_list_add(c, "--grid", "grid", args.grid != NULL ? args.grid : "8,4,2,1");
    for (size_t k = 0; k < args.lists.n; k++)
        if (strcmp(args.lists.step[k].opt->name, "vary") == 0)
            cost_list_vary(c, args.lists.step[k].text);
    if (tol)
        cost_list_add(c, "--tol", "tol", args.tol != NULL ? args.tol : "1e-1,1e-2,1e-3,1e-4,1e-6");
    for (size_t k = 0; k < args.lists.n; k++)
        if (strcmp(args.lists.step[k].opt->name, "reference") == 0)
            cost_list_reference(c, args.lists.step[k].text);
    if (c->lists == 0)
        tool_usage(t, "--reference needs a list: give --tol, --grid or --vary");
}

/* The number of --error, 1e-3 or 5%; NAN: not given. */
static double
error_of(struct tool *t, const char *text)
{
    char *end = NULL;
    double error = text == NULL ? NAN : strtod(text, &end);

    if (text == NULL)
        return NAN;
    error = strcmp(end, "%") == 0 ? error / 100 : error;
    if (end == text || (*end != '\0' && strcmp(end, "%") != 0) || !(error > 0) || error > 1)
        tool_usage(t, "--error %s: a number above 0, up to 1 is expected, as in 1e-3 or 5%%", text);
    return error;
}

/* Prints on a terminal, or with --progress. */
static void
tell(const struct tool *t, const char *text)
{
    if (!t->quiet && (t->progress != NULL || t->verbose || isatty(STDERR_FILENO)))
        fprintf(stderr, "%s: %s\n", info.name, text);
}

/* ---- the input ---- */

/* Copies the input to a file for the programs. */
static void
copy_input(struct tool *t, struct cost_case *c)
{
    int again;
    FILE *file;
    struct rc_writer *writer;
    struct rc_grid *g;

    c->input = cost_file(t);
    again = dup(c->input);
    rc_err_set(&t->err, "a temporary file cannot be written");
    if (again < 0 || (file = fdopen(again, "wb")) == NULL ||
        (writer = rc_writer_new(file, &t->err)) == NULL)
        tool_die(t, "%s", t->err.text);
    while (tool_interrupted() == 0 && (g = tool_read(t)) != NULL) {
        if (rc_writer_put(writer, g, &t->err) != RC_OK)
            tool_refuse(t, g, "%s", t->err.text);
        if (c->first == NULL) {
            c->first = g;
            c->shape = rc_grid_shape(g);
            continue;
        }
        rc_grid_free(g);
    }
    if (rc_writer_end(writer, &t->err) != RC_OK || fclose(file) != 0)
        tool_die(t, "%s", t->err.text);
    rc_writer_free(writer);
    if (c->first == NULL && tool_interrupted() == 0)
        tool_die(t, "the input has no frame");
}

/* ---- expected times ---- */

static void
plan(struct tool *t, struct cost_case *c)
{
    double all = 0;
    size_t n = 0, out = 0;
    char text[200], name[160];

    for (size_t k = 0; k < c->trials; k++) {
        struct cost_trial *trial = &c->trial[k];

        cost_plan(c, trial);
        if (trial->state != COST_OPEN)
            continue;
        n++;
        if (all + trial->expected > c->limit) {
            out++;
            continue;
        }
        for (size_t runs = 0; runs == 0 || cost_again((double)runs, trial->expected); runs++)
            all += isnan(trial->expected) ? 0 : trial->expected;
    }
    snprintf(text, sizeof text,
             "%zu trials on %zu x %zu nodes, about %.2g s for %s after the reference; %zu of them "
             "are expected "
             "beyond --limit",
             n, c->shape.nx, c->shape.ny, all, c->command.program[0].name, out);
    if (!args.dry_run) {
        tell(t, text);
        return;
    }
    fprintf(t->output.file, "%s\n", text);
    for (size_t k = 0; k < c->trials; k++) {
        const struct cost_trial *trial = &c->trial[k];

        cost_name(c, trial, false, name);
        if (trial->state == COST_OPEN && !isnan(trial->expected))
            fprintf(t->output.file, "  %-40s about %8.2g s, %.0f MiB\n", name, trial->expected,
                    c->run[trial->run[0]].mebibytes);
        else
            fprintf(t->output.file, "  %-40s %s\n", name,
                    trial->state == COST_OPEN ? "time unknown" : trial->why);
    }
}

/* ---- the measurement ---- */

static bool
varies_map(void)
{
    return args.scan.noise.n > 0 || args.scan.again != NULL || args.scan.resolution ||
           args.scan.patch || args.scan.holes || args.scan.filter != NULL;
}

static void
write_plot(struct tool *t, const struct cost_case *c, const struct scan *s)
{
    size_t bytes;
    struct whole_file whole;
    unsigned char *picture;
    FILE *file;

    if (args.plot == NULL)
        return;
    picture = s != NULL ? scan_plot(s, ending_of(args.plot), &bytes, &t->err)
                        : cost_plot(c, ending_of(args.plot), &bytes, &t->err);
    if (picture == NULL)
        tool_die(t, "--plot %s: %s", args.plot, t->err.text);
    if ((file = whole_file_open(&whole, args.plot)) == NULL ||
        fwrite(picture, 1, bytes, file) != bytes || !whole_file_put(&whole, file))
        tool_die(t, "--plot %s: %s", args.plot, strerror(errno));
    free(picture);
}

static void
study_map(struct tool *t, struct cost_case *c)
{
    struct scan *s = &run.scan;

    *s = (struct scan){.c = c, .options = &args.scan};
    copy_input(t, c);
    if (tool_interrupted() != 0)
        return;
    scan_study(s, args.dry_run);
    if (args.dry_run) {
        scan_show_plan(s, t->output.file);
        return;
    }
    scan_report(s, &run.report);
    write_plot(t, c, s);
    if (!t->output.report_alone)
        scan_show_table(s, t->output.file);
}

/* ---- results ---- */

/* Ends the tool if --of is neither a frame nor a figure. */
static void
check_of(struct tool *t, const struct cost_case *c)
{
    char nearest[NAME_SIZE] = "", meant[NAME_MEANT];

    if (c->of == NULL || cost_object_named(c, c->of).known)
        return;
    for (size_t k = 0; k < c->channels; k++)
        name_nearer(c->of, c->channel[k].name, nearest);
    for (size_t k = 0; k < c->figures; k++)
        if (!isnan(c->trial[c->reference].figure[k])) /* the reports have it */
            name_nearer(c->of, c->figure[k].shown, nearest);
    tool_usage(t, "--of %s: the command gives no such frame or figure%s", c->of,
               name_meant(nearest, meant));
}

static void
study(struct tool *t, struct cost_case *c)
{
    cost_trials(c);
    copy_input(t, c);
    if (tool_interrupted() != 0)
        return;
    if (!args.dry_run)
        cost_find_directions(c);
    for (size_t l = 0; l < c->lists; l++)
        cost_list_close(c, &c->list[l]);
    plan(t, c);
    if (args.dry_run || tool_interrupted() != 0)
        return;
    cost_run_reference(c);
    check_of(t, c);
    cost_run_trials(c);
    cost_report(c, &run.report);
    write_plot(t, c, NULL);
    cost_warn(c);
    if (t->output.report_alone)
        return;
    if (c->choosing)
        cost_show_command(c, t->output.file);
    else
        cost_show_table(c, t->output.file);
}

/* The word of "--"; without it that of a program, whose options are not those of rc-cost; else argc. */
static int
end_of_options(int argc, char **argv)
{
    int end = 1, program = 1;

    while (end < argc && strcmp(argv[end], "--") != 0)
        end++;
    while (program < end &&
           (strncmp(argv[program], "rc-", 3) != 0 ||
            argv[program][strspn(argv[program], "abcdefghijklmnopqrstuvwxyz-")] != '\0'))
        program++;
    return end < argc ? end : program;
}

int
main(int argc, char **argv)
{
    struct tool *t = &run.t;
    struct cost_case *c = &run.c;
    const int end = end_of_options(argc, argv);

    tool_start(t, &info, end, argv, &args);
    if (end < argc && strcmp(argv[end], "--") != 0)
        tool_usage(t, "the command follows after --, as in rc-cost FILE -- %s ...", argv[end]);
    if (end + 1 >= argc)
        tool_usage(t, "a command is missing: rc-cost FILE -- rc-solve --load 1N --estar 1GPa");
    ending_demand_picture(t, "--plot", args.plot);
    tool_demand_writable(t, "--plot", args.plot);
    tool_catch_signals();
    *c = (struct cost_case){.tool = t,
                            .command.tool = t,
                            .limit = args.limit,
                            .budget = args.budget,
                            .error = error_of(t, args.error),
                            .choosing = !isnan(args.budget) || args.error != NULL,
                            .shown = args.plot != NULL || args.report != NULL,
                            .of = args.of};
    if ((c->nowhere = open("/dev/null", O_RDWR | O_CLOEXEC)) < 0)
        tool_die(t, "/dev/null: %s", strerror(errno));
    c->command.nowhere = c->nowhere;
    cost_command_read(&c->command, argv + end + 1, (size_t)(argc - end - 1));
    if (!varies_map())
        read_lists(t, c);
    report_open(&run.report, t, args.report);
    if (varies_map())
        study_map(t, c);
    else
        study(t, c);
    report_close(&run.report);
    return tool_finish(t);
}
