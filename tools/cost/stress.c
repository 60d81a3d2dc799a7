/*
 * Trials of the stresses: slices by each engine and accuracy, under the pressure of the reference.
 * Beside each slice the exact one is computed, so that no more than two are held.
 */
#include "cost.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    DEPTHS = 4096,
    WANTED = (2u << RC_MISES) - 1 /* the six and Mises */
};

/* ---- which trials there are ---- */

/* The first engine, which "auto" takes, is exact, and is quicker with a tolerance, by coarser
 * grids for deep slices. Of the others those whose time grows with the square of the nodes take no
 * tolerance. */
static const double first_tols[] = {0, 1e-2, 1e-3, 1e-4, 1e-6}, other_tols[] = {1e-2, 1e-4, 1e-6},
                    rounding[] = {0};

enum {
    FIRST_TOLS = sizeof first_tols / sizeof *first_tols,
    OTHER_TOLS = sizeof other_tols / sizeof *other_tols
};

static size_t
tolerances(size_t engine, const double **tol)
{
    const struct rc_engine_info *info = rc_engine_info(engine);

    if (info->precise)
        return 0; /* stresses are in double precision anyway */
    *tol = engine == 0 ? first_tols : info->order == 1 ? other_tols : rounding;
    return engine == 0 ? FIRST_TOLS : info->order == 1 ? OTHER_TOLS : 1;
}

struct cost_stress *
cost_stress_trials(const struct cost_case *c, size_t *n)
{
    const struct rc_engine_info *info;
    struct cost_stress *s;
    const double *tol;
    size_t most = 0;

    for (size_t e = 0; rc_engine_info(e) != NULL; e++)
        most += tolerances(e, &tol);
    assert(most > 0);
    s = calloc(most, sizeof *s);
    *n = 0;
    for (size_t e = 0; s != NULL && (info = rc_engine_info(e)) != NULL; e++) {
        size_t count = tolerances(e, &tol);
        for (size_t k = 0; k < count && (info->periodic || c->problem.boundary == RC_FREE); k++)
            s[(*n)++] = (struct cost_stress){
                .kernel = info->name, .tol = tol[k], .reference = e == 0 && tol[k] == 0};
    }
    return s;
}

/* In memory shared with the process that computes. */
struct job {
    const struct cost_case *c;
    const struct cost_stress *trial;
    size_t depth; /* for progress */
    bool done;
    double seconds, error, rms, mises;
    size_t memory; /* bytes of its own */
    size_t coarse;
    struct rc_err err;
    size_t depths;
    double z[DEPTHS];
};

static void
watch(void *ctx)
{
    const struct job *j = ctx;

    if (j->trial != NULL)
        tool_progress(j->c->tool, "stresses by %s, tol %.0e, depth %zu of %zu", j->trial->kernel,
                      j->trial->tol, j->depth, j->c->depths.n);
}

/* ---- depths ---- */

static void
work_depths(void *ctx)
{
    struct job *j = ctx;
    double *z = NULL;

    if (rc_stress_depths(NULL, &j->c->shape, j->c->pressure, j->c->problem.boundary,
                         &j->c->problem.pair.one, &z, &j->depths, &j->err) != RC_OK)
        return;
    j->depths = j->depths < DEPTHS ? j->depths : DEPTHS;
    memcpy(j->z, z, j->depths * sizeof *z);
    j->done = true;
}

void
cost_stress_depths(struct cost_case *c)
{
    struct job *j = cost_share(sizeof *j);

    if (j != NULL) {
        j->c = c;
        cost_run(work_depths, j, INFINITY, watch);
        if (j->done && (c->depths.v = malloc(j->depths * sizeof *c->depths.v)) != NULL) {
            memcpy(c->depths.v, j->z, j->depths * sizeof *j->z);
            c->depths.n = j->depths;
        }
    }
    if (c->depths.n == 0 && tool_interrupted() == 0)
        tool_die_at(c->tool, c->heights, EXIT_IMPOSSIBLE, "no depths: %s",
                    j == NULL || j->err.text[0] == '\0' ? "out of memory" : j->err.text);
    cost_unshare(j, sizeof *j);
}

/* ---- slices ---- */

static struct rc_stress_options
options_of(const struct cost_case *c, const char *kernel, double tol)
{
    struct rc_body body = c->problem.pair.one;

    if (body.layers == 0)
        body.nu = c->nu; /* E* does not say it */
    return (struct rc_stress_options){.boundary = c->problem.boundary,
                                      .body = body,
                                      .mu = c->mu,
                                      .wanted = WANTED,
                                      .engine = kernel,
                                      .tol = tol,
                                      .threads = c->tool->threads};
}

/* Over all depths and components: the largest error, the sum of squares; the largest Mises' stress,
 * and the exact one's. */
struct errors {
    double worst, squares, mises, mises_true;
};

static void
compare(size_t n, double *const s[RC_STRESSES], double *const truth[RC_STRESSES], struct errors *e)
{
    for (int c = 0; c <= RC_MISES; c++)
        for (size_t k = 0; k < n; k++) {
            double off = fabs(s[c][k] - truth[c][k]);

            e->worst = fmax(e->worst, off);
            e->squares += off * off;
            if (c == RC_MISES) {
                e->mises = fmax(e->mises, s[c][k]);
                e->mises_true = fmax(e->mises_true, truth[c][k]);
            }
        }
}

static bool
slices(struct job *j, struct rc_stress *stress, struct rc_stress *exact,
       double *const s[RC_STRESSES], double *const truth[RC_STRESSES])
{
    size_t n = j->c->shape.nx * j->c->shape.ny;
    struct errors e = {0};

    for (j->depth = 0; j->depth < j->c->depths.n; j->depth++) {
        double z = j->c->depths.v[j->depth], start = tool_now();

        if (rc_stress_slice(stress, z, s, &j->err) != RC_OK)
            return false;
        j->seconds += tool_now() - start;
        if (j->trial->reference)
            continue;
        if (rc_stress_slice(exact, z, truth, &j->err) != RC_OK)
            return false;
        compare(n, s, truth, &e);
    }
    j->error = e.worst / j->c->reference.contact.max_pressure;
    j->rms = sqrt(e.squares / ((double)(n * j->c->depths.n) * (RC_MISES + 1))) /
             j->c->reference.contact.max_pressure;
    j->mises = e.mises / e.mises_true - 1;
    j->coarse = rc_stress_counted(stress)->coarse_depths;
    return true;
}

static void
work(void *ctx)
{
    struct job *j = ctx;
    const struct cost_case *c = j->c;
    struct rc_stress_options o = options_of(c, j->trial->kernel, j->trial->tol),
                             e = options_of(c, words_engine(0), 0);
    size_t n = c->shape.nx * c->shape.ny, before = tool_peak_memory();
    double *maps = malloc(2 * n * (RC_MISES + 1) * sizeof *maps), start;
    double *s[RC_STRESSES] = {NULL}, *truth[RC_STRESSES] = {NULL};
    struct rc_stress *stress, *exact;

    if (maps == NULL) {
        rc_err_set(&j->err, "out of memory");
        return;
    }
    memset(maps, 0, 2 * n * (RC_MISES + 1) * sizeof *maps); /* page faults come before the times */
    for (size_t k = 0; k <= RC_MISES; k++) {
        s[k] = maps + k * n;
        truth[k] = maps + (RC_MISES + 1 + k) * n;
    }
    start = tool_now();
    if ((stress = rc_stress_new(&c->shape, c->pressure, &o, &j->err)) == NULL)
        return;
    j->seconds = tool_now() - start;
    if ((exact = rc_stress_new(&c->shape, c->pressure, &e, &j->err)) != NULL)
        j->done = slices(j, stress, exact, s, truth);
    j->memory = tool_peak_memory() - before;
}

static void
stop(struct cost_stress *s, enum cost_end end, const struct job *j)
{
    s->state = COST_STOPPED;
    snprintf(s->why, sizeof s->why, "%.250s",
             end == COST_LATE          ? "stopped: --limit has passed"
             : end == COST_INTERRUPTED ? "interrupted"
             : end == COST_DIED        ? "its process died: memory may be short"
                                       : j->err.text);
}

/* Of a trial, of the exact slices beside it, and of the maps of both. */
static size_t
memory_for(const struct cost_case *c, const struct cost_stress *s)
{
    struct rc_stress_options exact = options_of(c, words_engine(0), 0);
    size_t n = c->shape.nx * c->shape.ny;

    return s->memory + rc_stress_memory(&c->shape, &exact, c->depths.v, c->depths.n, 0) +
           2 * n * (RC_MISES + 1) * sizeof(double) + TOOL_TRANSFORMS;
}

bool
cost_stress_run(struct cost_case *c, struct cost_stress *s, double allowed)
{
    struct rc_stress_options o = options_of(c, s->kernel, s->tol);
    struct job *j = cost_share(sizeof *j);
    double start = tool_now();
    enum cost_end end;

    if (j == NULL)
        tool_die_at(c->tool, c->heights, EXIT_IMPOSSIBLE, "out of memory");
    s->memory = rc_stress_memory(&c->shape, &o, c->depths.v, c->depths.n, 0);
    tool_demand_memory(c->tool, c->heights, memory_for(c, s));
    do {
        memset(j, 0, sizeof *j);
        j->c = c;
        j->trial = s;
        end = cost_run(work, j, allowed - (tool_now() - start), watch);
        tool_memory_beside(c->tool, j->memory);
        if (end != COST_ENDED || !j->done)
            break;
        if (s->runs++ == 0 || j->seconds < s->seconds)
            s->seconds = j->seconds;
        s->error = s->reference ? NAN : j->error;
        s->rms = s->reference ? NAN : j->rms;
        s->mises = s->reference ? NAN : j->mises;
        s->coarse = j->coarse;
        s->state = COST_DONE;
    } while (cost_again(s->runs, s->seconds));
    tool_progress_end(c->tool);
    if (s->runs == 0)
        stop(s, end, j);
    cost_unshare(j, sizeof *j);
    return end != COST_INTERRUPTED;
}
