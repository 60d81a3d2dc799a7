/* What accuracy costs in time: one contact solved in many ways, beside one that is right. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "coarse.h"
#include "cost.h"
#include "physics.h"

static struct args {
    struct physics physics;
    size_t kernels, methods; /* bits */
    double limit, budget, error;
    struct numbers depths; /* none: auto, where it was given */
    double nu, mu;
    const char *plot, *report;
    bool dry_run;
} args = {.physics = PHYSICS_NONE, .kernels = SIZE_MAX, .methods = SIZE_MAX, .limit = 60,
          .budget = NAN, .error = NAN, .nu = NAN};

#define ABOVE_0 .min = 0, .max = INFINITY, .above = true
static const struct opt opts[] = {
#define AT(field) .at = offsetof(struct args, physics.field)
#include "physics.list"
#undef AT
#define AT(field) .at = offsetof(struct args, field)
    {.name = "kernel", .type = OPT_WORDS, AT(kernels), .words = COST_KERNELS, .arg = "LIST",
     .help = "try only these, of fft,fft64,mlms,direct (default: all)"},
    {.name = "method", .type = OPT_WORDS, AT(methods), .words = COST_METHODS, .arg = "LIST",
     .help = "try only these, of pcg,pk99 (default: both)"},
    {.name = "depths", .type = OPT_NUMBERS, .unit = UNIT_M, AT(depths), .min = 0, .max = INFINITY,
     .words = "auto", .arg = "LIST",
     .help = "stresses too, at these depths: a,b,c, a:b:n or auto"},
    {.name = "nu", .type = OPT_NUMBER, AT(nu), .min = -1, .max = 0.5, .above = true, .arg = "RATIO",
     .help = "Poisson's ratio for the stresses (default: --nu1)"},
    {.name = "mu", .type = OPT_NUMBER, AT(mu), .min = -10, .max = 10, .arg = "COEFFICIENT",
     .help = "for the stresses: the surface also carries mu times the pressure along +x"},
    {.name = "budget", .type = OPT_NUMBER, .unit = UNIT_S, AT(budget), ABOVE_0, .arg = "TIME",
     .help = "print the rc-solve command that is nearest within this time, and no table"},
    {.name = "error", .type = OPT_NUMBER, AT(error), .min = 0, .max = 1, .above = true,
     .arg = "ERROR",
     .help = "print the quickest rc-solve command whose true error is at most this, no table"},
    {.name = "limit", .type = OPT_NUMBER, .unit = UNIT_S, AT(limit), ABOVE_0, .arg = "TIME",
     .help = "for all of it, after the reference: what would not fit is left out (default 60s)"},
    {.name = "plot", .type = OPT_TEXT, AT(plot), .arg = "FILE",
     .help = "draw error against time as a PNG"},
    {.name = "report", .type = OPT_TEXT, AT(report), .arg = "FILE",
     .help = "write one JSON object a way of solving"},
    {.name = "dry-run", .type = OPT_FLAG, AT(dry_run),
     .help = "say what would be run, and about how long it would take; do no more"},
    {.name = NULL},
};

static const struct tool_info info = {
    .name = "rc-cost",
    .summary = "What accuracy costs in time, for a surface and a load",
    .operands = "[FILE...]",
    .examples = "  rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-slope 0.1 --seed 1 -o rough.rcg\n"
                "  rc-cost --periodic --mean-pressure 500MPa --estar 114GPa --plot cost.png rough.rcg\n"
                "  rc-cost --periodic --mean-pressure 500MPa --estar 114GPa --error 1e-3 rough.rcg\n",
    .opts = opts,
    .reads = READS_STREAM,
    .writes = WRITES_TEXT,
};

enum {
    SMALLEST = 8 /* nodes along a side from which a coarser grid is worth a look */
};

struct run {
    struct tool t;
    size_t cases;
    FILE *report;
};

/* ---- the command line ---- */

static bool
choosing(void)
{
    return !isnan(args.budget) || !isnan(args.error);
}

static void
check_arguments(struct run *run)
{
    struct tool *t = &run->t;

    physics_check(t, &args.physics);
    if (physics_steps(&args.physics)->n > 1)
        tool_die(t, EXIT_USAGE, "one load at a time: %zu were given", physics_steps(&args.physics)->n);
    if (tool_given(t, "budget") && tool_given(t, "error"))
        tool_die(t, EXIT_USAGE, "--budget asks for the best in a time, --error for the quickest of an accuracy: "
                                "give one");
    if (isnan(args.nu))
        args.nu = args.physics.nu1;
    if (tool_given(t, "depths") && isnan(args.nu))
        tool_die(t, EXIT_USAGE, "--depths: stresses need Poisson's ratio: give --nu");
    if (!tool_given(t, "depths") && (tool_given(t, "nu") || tool_given(t, "mu")))
        tool_die(t, EXIT_USAGE, "--nu and --mu are for stresses: give --depths as well");
    tool_demand_writable(t, "--plot", args.plot);
    tool_demand_writable(t, "--report", args.report);
}

/* To whoever waits in front of a terminal. */
static void
tell(struct run *run, const char *text)
{
    if (!run->t.quiet && (run->t.progress || run->t.verbose || isatty(STDERR_FILENO)))
        fprintf(stderr, "%s: %s\n", info.name, text);
}

/* ---- a case ---- */

/* What can be said of a rung before it runs: it cannot be done, or need not. */
static const char *
obstacle(const struct run *run, const struct cost_case *c, const struct cost *m)
{
    bool summed = strncmp(m->rung.kernel, "fft", 3) != 0;
    struct rc_problem problem = c->problem;
    size_t least = m->shape.nx < m->shape.ny ? m->shape.nx : m->shape.ny;

    problem.engine = m->rung.kernel;
    problem.method = m->rung.method;
    problem.tol = m->rung.tol;
    if (summed && c->problem.boundary == RC_PERIODIC)
        return ""; /* not on this boundary: nobody expects it */
    if (m->rung.coarse > 1 && (least == 1 ? m->shape.nx * m->shape.ny : least) < SMALLEST)
        return "left out: the grid is too small to be coarsened so far";
    if (m->rung.coarse > 1 && choosing() && args.plot == NULL && args.report == NULL)
        return "";
    if (run->t.memory != 0 && rc_solver_memory(&m->shape, &problem) > run->t.memory)
        return "left out: it needs more than --memory";
    return NULL;
}

static void
leave_out(struct cost *m, const char *why)
{
    m->state = COST_LEFT_OUT;
    snprintf(m->why, sizeof m->why, "%s", why);
}

/* Time beyond which a rung need not be tried to make the choice: three times that of the quickest that is good enough,
 * or of the budget, once anything has been measured. Expectations may be that far off. */
static double
too_slow(const struct cost_case *c)
{
    double least = INFINITY;
    bool any = false;

    for (size_t k = 0; k < c->rungs; k++) {
        const struct cost *m = &c->rung[k];

        if (m->state != COST_DONE || m->rung.coarse > 1)
            continue;
        any = true;
        if (m->error <= args.error)
            least = fmin(least, m->seconds);
    }
    if (!choosing() || args.plot != NULL || args.report != NULL || !any)
        return INFINITY;
    return 3 * (isnan(args.budget) ? least : args.budget);
}

static bool
fits(const struct cost_case *c, struct cost *m, double left)
{
    m->expected = cost_expect(c, m);
    if (m->expected > left)
        snprintf(m->why, sizeof m->why, "left out: it would take about %.2g s, and %.2g s are left of --limit",
                 m->expected, fmax(left, 0));
    else if (m->expected > too_slow(c))
        snprintf(m->why, sizeof m->why, "left out: about %.2g s, it would not be chosen", m->expected);
    else
        return true;
    m->state = COST_LEFT_OUT;
    return false;
}

static double
left(const struct cost_case *c)
{
    return c->limit - (cost_now() - c->began);
}

/* In turns, so that a disturbance does not fall on one rung alone. */
static void
repeat(struct cost_case *c)
{
    bool more = true;

    while (more && tool_interrupted() == 0) {
        more = false;
        for (size_t k = 0; k < c->rungs && tool_interrupted() == 0; k++) {
            struct cost *m = &c->rung[k];

            if (m->state != COST_DONE || !cost_again(m->runs, m->seconds) || m->seconds > left(c))
                continue;
            more = true;
            cost_solve(c, m, left(c), NULL);
        }
    }
}

static void
climb(struct run *run, struct cost_case *c)
{
    for (size_t k = 0; k < c->rungs && tool_interrupted() == 0; k++) {
        struct cost *m = &c->rung[k];

        if (m->state == COST_OPEN && fits(c, m, left(c)))
            cost_solve(c, m, left(c), NULL);
    }
    repeat(c);
    if (!tool_given(&run->t, "depths") || tool_interrupted() != 0)
        return;
    if (c->depths.n == 0)
        cost_stress_depths(c);
    for (size_t k = 0; k < c->stresses && tool_interrupted() == 0; k++) {
        struct cost_stress *s = &c->stress[k];

        s->expected = cost_expect_stress(c, s);
        if (s->expected > left(c)) {
            s->state = COST_LEFT_OUT;
            snprintf(s->why, sizeof s->why, "left out: it would take about %.2g s, and %.2g s are left of --limit",
                     s->expected, fmax(left(c), 0));
        } else {
            cost_stress_run(c, s, left(c));
        }
    }
}

/* ---- what is to come ---- */

static void
plan(struct run *run, struct cost_case *c)
{
    char text[160], name[128];
    double all = 0;
    size_t n = 0, out = 0;

    c->reference.expected = cost_expect(c, &c->reference);
    for (size_t k = 0; k < c->rungs; k++) {
        struct cost *m = &c->rung[k];

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
    snprintf(text, sizeof text, "%zu ways to solve %zu x %zu nodes, about %.2g s after %.2g s for the reference; "
                                "%zu of them are expected beyond --limit", n, c->shape.nx, c->shape.ny, all,
             c->reference.expected, out);
    if (!args.dry_run) {
        tell(run, text);
        return;
    }
    fprintf(run->t.out, "%s\n", text);
    for (size_t k = 0; k < c->rungs; k++) {
        struct cost *m = &c->rung[k];
        struct rc_problem problem = c->problem;

        problem.engine = m->rung.kernel;
        if (m->state == COST_OPEN)
            fprintf(run->t.out, "  %-40s about %8.2g s, %zu MiB\n", cost_name(name, m), m->expected,
                    (rc_solver_memory(&m->shape, &problem) >> 20) + 1);
        else if (m->why[0] != '\0')
            fprintf(run->t.out, "  %-40s %s\n", cost_name(name, m), m->why);
    }
}

/* ---- the choice ---- */

static bool
better(const struct cost *a, const struct cost *b)
{
    return b == NULL || (isnan(args.budget) ? a->seconds < b->seconds
                                            : a->error < b->error || (a->error == b->error && a->seconds < b->seconds));
}

/* A word as a shell reads it. */
static void
put_word(FILE *out, const char *word)
{
    const char *plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:+@%=";

    if (word[0] != '\0' && strspn(word, plain) == strlen(word)) {
        fprintf(out, " %s", word);
        return;
    }
    fputs(" '", out);
    for (; *word != '\0'; word++)
        if (*word == '\'')
            fputs("'\\''", out);
        else
            fputc(*word, out);
    fputc('\'', out);
}

static void
put_command(struct run *run, const struct cost *m)
{
    const char *physics = strstr(tool_history(&run->t), " --"); /* name and version stand before */
    char tol[RC_NUMBER_SIZE];

    fprintf(run->t.out, "rc-solve%s --method %s --kernel %s --tol %s", physics, m->rung.method, m->rung.kernel,
            rc_number_text(tol, m->rung.tol));
    if (run->t.threads != rc_threads_available())
        fprintf(run->t.out, " --threads %zu", run->t.threads);
    for (size_t k = 0; k < run->t.operands; k++)
        put_word(run->t.out, run->t.operand[k]);
    fputc('\n', run->t.out);
}

/* Full grids only: no tool takes a map to a coarser one. By the triangle inequality the error is at most that from the
 * reference and the reference's own. */
static void
choose(struct run *run, const struct cost_case *c)
{
    const struct cost *best = NULL, *nearest = NULL;
    char name[128];

    for (size_t k = 0; k < c->rungs; k++) {
        const struct cost *m = &c->rung[k];

        if (m->state != COST_DONE || m->rung.coarse > 1 || !m->contact.converged)
            continue;
        if ((isnan(args.budget) ? m->error + c->reference.contact.pressure_error <= args.error
                                : m->seconds <= args.budget) && better(m, best))
            best = m;
        if (nearest == NULL || (isnan(args.budget) ? m->error < nearest->error : m->seconds < nearest->seconds))
            nearest = m;
    }
    if (best != NULL) {
        tool_note(&run->t, "%s: %.3g s, true error %.1e, estimate %.1e", cost_name(name, best), best->seconds,
                  best->error, best->contact.pressure_error);
        put_command(run, best);
    } else if (nearest != NULL) {
        tool_die(&run->t, EXIT_IMPOSSIBLE, "nothing measured %s: the best was %s, %.3g s, error %.1e; raise %s",
                 isnan(args.budget) ? "is so near" : "is so quick", cost_name(name, nearest), nearest->seconds,
                 nearest->error, isnan(args.budget) ? "--error or --limit" : "--budget");
    } else {
        tool_die(&run->t, EXIT_IMPOSSIBLE, "nothing was measured: raise --limit");
    }
}

/* ---- results ---- */

static void
write_plot(struct run *run, const struct cost_case *c)
{
    size_t bytes;
    struct rc_err err;
    unsigned char *png;
    FILE *file;

    if (args.plot == NULL)
        return;
    if ((png = cost_plot(c, &bytes, &err)) == NULL)
        tool_die(&run->t, EXIT_IMPOSSIBLE, "--plot %s: %s", args.plot, err.text);
    if ((file = fopen(args.plot, "wb")) == NULL)
        tool_die(&run->t, EXIT_IMPOSSIBLE, "--plot %s: %s", args.plot, strerror(errno));
    if ((fwrite(png, 1, bytes, file) != bytes) | (fclose(file) != 0)) {
        int why = errno;
        remove(args.plot);
        tool_die(&run->t, EXIT_IMPOSSIBLE, "--plot %s: %s", args.plot, strerror(why));
    }
    free(png);
}

static void
write_report(struct run *run, const struct cost_case *c)
{
    if (args.report == NULL)
        return;
    if (run->report == NULL && (run->report = fopen(args.report, "w")) == NULL)
        tool_die(&run->t, EXIT_IMPOSSIBLE, "--report %s: %s", args.report, strerror(errno));
    cost_report(c, run->report);
    if (ferror(run->report))
        tool_die(&run->t, EXIT_IMPOSSIBLE, "--report %s: writing failed", args.report);
}

static void
tell_results(struct run *run, struct cost_case *c)
{
    cost_judge(c);
    write_report(run, c);
    write_plot(run, c);
    for (size_t k = 0; k < c->rungs; k++)
        if (c->rung[k].flatters) {
            char name[128];
            tool_warn(&run->t, "%s: the estimate %.1e is below the true error %.1e", cost_name(name, &c->rung[k]),
                      c->rung[k].contact.pressure_error, c->rung[k].error);
        }
    if (choosing())
        choose(run, c);
    else
        cost_table(c, run->t.out);
}

/* ---- the run ---- */

static void
open_case(struct run *run, struct rc_grid *g, struct cost_case *c)
{
    *c = (struct cost_case){.tool = &run->t, .heights = g, .shape = rc_grid_shape(g),
                            .problem = physics_problem(&args.physics, g, 0), .limit = args.limit,
                            .depths = args.depths, .nu = args.nu, .mu = args.mu};
    c->reference.rung = cost_reference;
    c->reference.shape = c->shape;
    c->rung = cost_ladder(args.kernels, args.methods, &c->rungs);
    c->stress = tool_given(&run->t, "depths") ? cost_stress_ladder(c, &c->stresses) : NULL;
    if (c->rung == NULL || (tool_given(&run->t, "depths") && c->stress == NULL))
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "out of memory");
    for (size_t k = 0; k < c->rungs; k++) {
        const char *why;
        c->rung[k].shape = coarse_shape(&c->shape, c->rung[k].rung.coarse);
        if ((why = obstacle(run, c, &c->rung[k])) != NULL)
            leave_out(&c->rung[k], why);
    }
}

static void
close_case(struct cost_case *c)
{
    free(c->pressure);
    free(c->rung);
    free(c->stress);
    if (c->depths.v != args.depths.v)
        free(c->depths.v);
}

static void
solve_reference(struct run *run, struct cost_case *c)
{
    size_t n = c->shape.nx * c->shape.ny;
    double *p = malloc(n * sizeof *p);
    struct rc_problem problem = c->problem;

    problem.engine = c->reference.rung.kernel;
    tool_demand_memory(&run->t, c->heights, rc_solver_memory(&c->shape, &problem) + 2 * n * sizeof *p);
    if (p == NULL)
        tool_die_at(&run->t, c->heights, EXIT_IMPOSSIBLE, "out of memory");
    if (!cost_solve(c, &c->reference, args.limit, p))
        tool_die_at(&run->t, c->heights, EXIT_IMPOSSIBLE, "interrupted before anything was measured");
    if (c->reference.state != COST_DONE)
        tool_die_at(&run->t, c->heights, EXIT_IMPOSSIBLE, "no reference: %s", c->reference.why);
    c->pressure = p;
    c->began = cost_now();
}

static void
do_case(struct run *run, struct rc_grid *g)
{
    struct cost_case c;

    if (++run->cases > 1 && (choosing() || args.plot != NULL))
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s is for one case: give one height map",
                    args.plot != NULL ? "a picture" : "a command");
    physics_heights(&run->t, &args.physics, g);
    open_case(run, g, &c);
    plan(run, &c);
    if (!args.dry_run) {
        solve_reference(run, &c);
        climb(run, &c);
        tell_results(run, &c);
    }
    close_case(&c);
}

int
main(int argc, char **argv)
{
    static struct run run;
    struct rc_grid *g;

    tool_start(&run.t, &info, argc, argv, &args);
    check_arguments(&run);
    tool_catch_signals();
    while (tool_interrupted() == 0 && (g = tool_channel(&run.t, "height", false)) != NULL) {
        do_case(&run, g);
        rc_grid_free(g);
    }
    if (run.report != NULL && fclose(run.report) != 0)
        tool_die(&run.t, EXIT_IMPOSSIBLE, "--report %s: %s", args.report, strerror(errno));
    free(args.depths.v);
    return tool_finish(&run.t);
}
