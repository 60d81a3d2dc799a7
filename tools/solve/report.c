/* What rc-solve tells about a solution, or about one that it is to make. */
#include "solve.h"

#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

/* clang-format off */
const struct solve_frame_kind solve_frames[SOLVE_FRAMES] = {
    [SOLVE_PRESSURE] = {"pressure", "Pa"},
    [SOLVE_GAP] = {"gap", "m"},
    [SOLVE_DISPLACEMENT] = {"displacement", "m"},
    [SOLVE_HEIGHT] = {"height", "m"},
    [SOLVE_PLASTIC] = {"plastic", "m"},
};
/* clang-format on */

double
solve_now(void)
{
    struct timespec ts;

    clock_gettime(CLOCK_MONOTONIC, &ts);
    return (double)ts.tv_sec + 1e-9 * (double)ts.tv_nsec;
}

/* ---- effects ---- */

/* Before the solution `active` is not known. */
static const char *
hardness_effect(const struct run *run, const bool *active)
{
    if (isinf(run->args->physics.hardness))
        return "left out: no --hardness";
    if (active == NULL)
        return "on where the elastic pressure would exceed it; costs nothing elsewhere";
    return *active ? "on" : "left out: the largest elastic pressure is below it";
}

struct effect {
    const char *name, *state;
};

enum {
    EFFECTS = 7 + SOLVE_FRAMES
};

/* Every effect, with `on` or why it is left out; returns how many. */
static size_t
effects(const struct run *run, const char *kernel, const bool *active, struct effect e[EFFECTS])
{
    const struct solve_args *a = run->args;
    size_t n = 0;

    e[n++] = (struct effect){"kernel", kernel};
    e[n++] = (struct effect){"hardness", hardness_effect(run, active)};
    e[n++] = (struct effect){"sphere", isnan(a->physics.radius) ? "left out: no --radius" : "on"};
    e[n++] =
        (struct effect){"padding", a->physics.periodic ? "left out: the map is periodic" : "on"};
    e[n++] = (struct effect){"approach",
                             a->physics.approach.n > 0 ? "on" : "left out: the load is given"};
    e[n++] = (struct effect){"stiffness",
                             run->stiffness ? "on" : "left out: one load and no --stiffness"};
    e[n++] = (struct effect){"discretization",
                             a->discretization ? "on" : "left out: no --discretization"};
    for (int f = 0; f < SOLVE_FRAMES; f++)
        e[n++] = (struct effect){solve_frames[f].name,
                                 solve_wanted(a, f) ? "on" : "left out: not in --output"};
    return n;
}

/* ---- report ---- */

static void
report_discretization(struct json *j, const struct rc_contact *c)
{
    if (isnan(c->discretization.max_pressure)) {
        json_null(j, "discretization_error_estimate");
        return;
    }
    json_object(j, "discretization_error_estimate");
    json_number(j, "contact_area", c->discretization.contact_area);
    json_number(j, "max_pressure", c->discretization.max_pressure);
    json_number(j, "approach", c->discretization.approach);
    json_end(j, '}');
}

static void
report_figures(struct json *j, const struct rc_contact *c, double stiffness)
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
    json_number(j, "stiffness", stiffness);
    json_count(j, "iterations", c->iterations);
    json_number(j, "convolutions", c->convolutions);
    json_number(j, "kkt_residual", c->kkt_residual);
    json_number(j, "pressure_error_estimate", c->pressure_error);
    report_discretization(j, c);
    json_bool(j, "converged", c->converged);
}

void
solve_report(struct run *run, const struct rc_grid *g, const struct rc_solver *solver,
             const struct rc_contact *c, double stiffness)
{
    struct effect e[EFFECTS];
    struct rusage usage;
    struct json j;
    size_t n = effects(run, rc_solver_engine_reason(solver), &c->hardness_active, e);

    if (run->args->report == NULL)
        return;
    if (run->report == NULL && (run->report = fopen(run->args->report, "w")) == NULL)
        tool_die(&run->t, EXIT_IMPOSSIBLE, "--report %s: %s", run->args->report, strerror(errno));
    getrusage(RUSAGE_SELF, &usage);
    json_open(&j, run->report);
    json_count(&j, "case", run->number);
    json_text(&j, "source", rc_grid_get(g, "source"));
    json_count(&j, "nx", g->nx);
    json_count(&j, "ny", g->ny);
    json_number(&j, "dx", g->dx);
    json_number(&j, "dy", g->dy);
    json_text(&j, "boundary", run->args->physics.periodic ? "periodic" : "free");
    json_text(&j, "kernel", rc_solver_engine(solver));
    json_text(&j, "method", rc_solver_method(solver));
    json_count(&j, "threads", run->t.threads);
    report_figures(&j, c, stiffness);
    json_object(&j, "effects");
    for (size_t k = 0; k < n; k++)
        json_text(&j, e[k].name, e[k].state);
    json_end(&j, '}');
    json_object(&j, "seconds");
    json_number(&j, "setup", run->setup);
    json_number(&j, "iterate", run->iterate);
    json_number(&j, "result", run->result);
    json_number(&j, "total", solve_now() - run->began);
    json_end(&j, '}');
    json_count(&j, "peak_memory", (size_t)usage.ru_maxrss * 1024);
    json_close(&j);
    if (ferror(run->report))
        tool_die(&run->t, EXIT_IMPOSSIBLE, "--report %s: writing failed", run->args->report);
}

/* ---- plan ---- */

/* Equivalents and seconds as bench-solve found them at 512^2 to 2048^2, 1 to 99 % contact, 1e-4;
 * each further decade of the tolerance takes about one step more. pk99 goes with the square root
 * of the number of nodes. */
static double
expected(const struct run *run, const struct rc_problem *problem, size_t n)
{
    double tol = problem->tol == 0 ? pow((double)n, -0.75) : problem->tol;
    double steps = 16 + 2.3 * fmax(log10(1e-4 / tol), -2);

    if (strcmp(run->args->method, "pk99") == 0)
        steps = 0.6 * sqrt((double)n) * fmax(1, log10(1 / tol) / 3);
    if (problem->approach > 0)
        steps *= 3;
    return steps + (run->stiffness ? 12 : 0) + (problem->discretization ? 5 : 0);
}

void
solve_plan(struct run *run, const struct rc_grid *g, const struct rc_problem *problem)
{
    struct rc_shape shape = rc_grid_shape(g);
    struct effect e[EFFECTS];
    const char *reason, *engine = rc_solver_choice(&shape, problem, &reason);
    size_t count = effects(run, reason, NULL, e), n = g->nx * g->ny;
    double each = expected(run, problem, n);
    double node = strcmp(engine, "direct") == 0  ? 2.6 * (double)n
                  : strcmp(engine, "mlms") == 0  ? 30
                  : problem->boundary == RC_FREE ? 18
                                                 : 8;
    char where[256];

    tool_where(&run->t, g, where, sizeof where);
    fprintf(run->t.out, "%s: %zu x %zu nodes, %zu %s, engine %s\n", where, g->nx, g->ny,
            run->steps->n, run->steps->n == 1 ? "load" : "loads", engine);
    for (size_t k = 0; k < count; k++)
        fprintf(run->t.out, "  %-15s %s\n", e[k].name, e[k].state);
    fprintf(run->t.out, "  about %.0f convolutions%s, %zu MiB, %.2g s with %zu threads\n", each,
            run->steps->n > 1 ? " for the first load, fewer for the next" : "",
            (rc_solver_memory(&shape, problem) >> 20) + 1,
            1e-9 * node * each * (double)n * (double)run->steps->n * 2 / (double)run->t.threads,
            run->t.threads);
}
