/*
 * One trial: a solution in a process of its own, and how far its pressure is from the reference.
 */
#include "cost.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* In memory shared with the process that solves. */
struct job {
    struct tool *tool;
    const struct cost_trial *trial;
    const double *h; /* of the map */
    struct rc_shape map;
    struct rc_problem problem;
    struct rc_progress at;
    bool done;
    double seconds, convolutions;
    size_t memory;
    const struct rc_yield *yield;               /* NULL: elastic, or a hardness */
    const struct rc_adhesion_problem *adhesion; /* NULL: nothing attracts */
    bool by_approach;
    double cohesive_nodes;
    struct rc_plastic_figures figures;
    char leak;
    double flow, flow_seconds;
    double at_load;
    size_t slabs, increment, application;
    struct rc_contact contact;
    struct rc_err err;
    double p[]; /* on the map */
};

/* ---- the process that solves ---- */

static double *
new_map(const struct rc_shape *shape)
{
    return malloc(shape->nx * shape->ny * sizeof(double));
}

/* Heights and hardness of the trial's grid. Means lower the tips; single nodes would alias what the
 * grid cannot hold. A node has the mean hardness of those under it, and none where most of them have
 * none. */
static const double *
coarse_maps(struct job *j, const struct rc_shape *shape)
{
    double *h = new_map(shape), *hardness = j->problem.hardness_map != NULL ? new_map(shape) : NULL;

    if (h == NULL || (j->problem.hardness_map != NULL && hardness == NULL)) {
        rc_err_set(&j->err, "out of memory");
        return NULL;
    }
    rc_resample_means(&j->map, j->h, shape, h);
    if (hardness != NULL)
        rc_resample_means(&j->map, j->problem.hardness_map, shape, hardness);
    j->problem.hardness_map = hardness;
    return h;
}

/* Where body 1 yields inside, as rc-solve --yield does it: the elastic contact says how deep. The solver of
 * the contact of what has yielded, or NULL. */
static struct rc_solver *
yield_inside(struct job *j, const double *h, struct rc_solver *elastic)
{
    const struct rc_shape *shape = &j->trial->shape;
    struct rc_plastic_depths d = {0};
    struct rc_plastic_problem problem = {.contact = j->problem,
                                         .yield = *j->yield,
                                         .increments = j->trial->settings.increments,
                                         .precise = j->trial->settings.precise};
    double *thickness, stress = yield_law_first(j->yield);
    struct rc_plastic *plastic;
    enum rc_status status;
    struct rc_solver *of_it;

    if (rc_plastic_depths(shape, j->problem.boundary, rc_solver_pressure(elastic),
                          &j->problem.pair.one, stress, j->problem.threads, &d, &j->err) != RC_OK)
        return NULL;
    if (d.slabs == 0) {
        rc_err_set(&j->err,
                   "nothing yields: the largest Mises stress is %.3g of the yield stress: leave "
                   "out --yield",
                   d.most / stress);
        return NULL;
    }
    problem.slabs = j->slabs = (size_t)ceil((double)d.slabs * j->trial->settings.stack);
    problem.thickness = thickness = yield_stack(&d, problem.slabs);
    free(d.thickness);
    if (thickness == NULL) {
        rc_err_set(&j->err, "out of memory for the slabs");
        return NULL;
    }
    plastic = rc_plastic_new(shape, h, &problem, &j->err);
    free(thickness);
    if (plastic == NULL || rc_plastic_set_load(plastic, j->problem.load, &j->err) != RC_OK)
        return NULL;
    while ((status = rc_plastic_step(plastic, &j->err)) == RC_MORE)
        rc_plastic_progress(plastic, &j->at_load, &j->increment, &j->application);
    if (status == RC_FAIL)
        return NULL;
    j->figures = *rc_plastic_result(plastic);
    of_it = rc_plastic_solver(plastic);
    j->convolutions = NAN; /* nearly all of the work is in the volume */
    rc_solver_result(of_it, NULL, NULL, &j->contact);
    j->contact.pressure_error = j->figures.error;
    j->contact.converged = j->contact.converged && status == RC_OK;
    return of_it;
}

/* What flows through the gap of the solution, as rc-leak finds it. */
static bool
find_flow(struct job *j, struct rc_solver *solver)
{
    const struct rc_shape *shape = &j->trial->shape;
    const struct rc_leak_options options = {.direction = j->leak,
                                            .around = j->problem.boundary == RC_PERIODIC,
                                            .threads = j->problem.threads};
    double *gap = new_map(shape), start = tool_now();
    struct rc_contact contact;
    struct rc_leak *leak;
    enum rc_status status;

    if (gap == NULL) {
        rc_err_set(&j->err, "out of memory");
        return false;
    }
    rc_solver_result(solver, NULL, gap, &contact);
    leak = rc_leak_new(shape, rc_solver_pressure(solver), gap, &options, &j->err);
    free(gap);
    if (leak == NULL)
        return false;
    while ((status = rc_leak_step(leak, &j->err)) == RC_MORE)
        continue;
    j->flow = rc_leak_result(leak)->conductance;
    j->flow_seconds = tool_now() - start;
    rc_leak_free(leak);
    return status == RC_OK;
}

/* Bodies that attract each other, as rc-solve --adhesion finds their first state: from afar. On the trial's
 * grid, to `p`. */
static bool
attract(struct job *j, const double *h, double *p)
{
    struct rc_adhesion_problem problem = *j->adhesion;
    const struct rc_adhesion_figures *f;
    struct rc_adhesion *a;
    enum rc_status status;

    problem.contact = j->problem;
    if ((a = rc_adhesion_new(&j->trial->shape, h, &problem, &j->err)) == NULL)
        return false;
    status = j->by_approach ? rc_adhesion_set_approach(a, j->problem.approach, &j->err)
                            : rc_adhesion_set_load(a, j->problem.load, &j->err);
    if (status != RC_OK)
        return false;
    while ((status = rc_adhesion_step(a, &j->err)) == RC_MORE) {
        struct rc_adhesion_progress at;
        rc_adhesion_progress(a, &at);
        j->at = (struct rc_progress){.iterations = at.iterations, .error = at.error};
    }
    if (status == RC_FAIL)
        return false;
    f = rc_adhesion_result(a);
    if (f->separated) {
        rc_err_set(&j->err, "under this load the bodies part");
        return false;
    }
    j->cohesive_nodes = rc_adhesion_scales(a)->cohesive_nodes;
    j->convolutions = f->convolutions;
    j->contact = (struct rc_contact){.contact_area = f->contact_area,
                                     .contact_fraction = f->contact_fraction,
                                     .plastic_area = f->plastic_area,
                                     .max_pressure = f->max_pressure,
                                     .approach = f->approach,
                                     .pressure_error = f->pressure_error,
                                     .iterations = f->iterations,
                                     .converged = f->converged};
    rc_adhesion_pressure(a, p);
    return true;
}

/* By pressing alone; the pressure on the trial's grid, or NULL. */
static const double *
press(struct job *j, const double *h, double start, size_t before)
{
    struct rc_solver *solver = rc_solver_new(&j->trial->shape, h, &j->problem, &j->err);

    if (solver == NULL)
        return NULL;
    while (rc_solver_step(solver) == RC_MORE)
        rc_solver_progress(solver, &j->at);
    if (j->yield != NULL && (solver = yield_inside(j, h, solver)) == NULL)
        return NULL;
    j->seconds = tool_now() - start;
    j->memory = tool_peak_memory() - before;
    if (j->yield == NULL) {
        j->convolutions = rc_solver_convolutions(solver);
        rc_solver_result(solver, NULL, NULL, &j->contact);
    }
    return j->leak != 0 && !find_flow(j, solver) ? NULL : rc_solver_pressure(solver);
}

static void
work(void *ctx)
{
    struct job *j = ctx;
    const struct rc_shape *shape = &j->trial->shape;
    bool coarse = j->trial->settings.coarse > 1;
    double start = tool_now();
    const double *h = coarse ? coarse_maps(j, shape) : j->h, *p = NULL;
    size_t before = tool_peak_memory();

    if (h == NULL)
        return;
    if (j->adhesion != NULL) {
        double *net = new_map(shape);
        if (net != NULL && attract(j, h, net))
            p = net;
        j->seconds = tool_now() - start;
        j->memory = tool_peak_memory() - before;
    } else {
        p = press(j, h, start, before);
    }
    if (p == NULL)
        return;
    start = tool_now();
    if (coarse) {
        rc_resample_means(shape, p, &j->map, j->p);
        j->seconds += tool_now() - start;
    } else {
        memcpy(j->p, p, shape->nx * shape->ny * sizeof *j->p);
    }
    j->done = true;
}

/* ---- the process that waits ---- */

static void
watch(void *ctx)
{
    const struct job *j = ctx;
    char name[128];

    if (j->increment > 0)
        tool_progress(j->tool, "%s, increment %zu", cost_name(name, j->trial), j->increment);
    else if (isnan(j->at.error) || j->at.coarser)
        tool_progress(j->tool, "%s, iteration %zu", cost_name(name, j->trial),
                      j->at.coarser ? 0 : j->at.iterations);
    else
        tool_progress(j->tool, "%s, iteration %zu, error %.1e", cost_name(name, j->trial),
                      j->at.iterations, j->at.error);
}

static double
distance(size_t n, const double *p, const double *truth)
{
    double sum = 0, all = 0;

    for (size_t k = 0; k < n; k++) {
        sum += fabs(p[k] - truth[k]);
        all += fabs(truth[k]); /* bodies that attract each other: net pressures */
    }
    return sum / all;
}

static void
compare(const struct cost_case *c, struct cost_trial *trial, const double *p)
{
    const struct rc_contact *truth = &c->reference.contact, *got = &trial->contact;

    trial->error = distance(c->shape.nx * c->shape.ny, p, c->pressure);
    trial->area_error = got->contact_area / truth->contact_area - 1;
    trial->peak_error = got->max_pressure / truth->max_pressure - 1;
    trial->approach_error = got->approach / truth->approach - 1;
    trial->flow_error = trial->flow / c->reference.flow - 1; /* NAN where none flows */
}

static void
keep(struct cost_trial *trial, const struct job *j, const struct rc_shape *map)
{
    const struct rc_shape *own = &trial->shape;

    if (trial->runs == 0 || j->seconds < trial->seconds)
        trial->seconds = j->seconds;
    trial->convolutions =
        j->convolutions * (double)(own->nx * own->ny) / (double)(map->nx * map->ny);
    trial->memory = j->memory > trial->memory ? j->memory : trial->memory;
    tool_memory_beside(j->tool, j->memory);
    trial->contact = j->contact;
    if (trial->runs == 0 || j->flow_seconds < trial->flow_seconds)
        trial->flow_seconds = j->flow_seconds;
    trial->flow = j->flow;
    trial->slabs = j->slabs;
    trial->cohesive_nodes = j->cohesive_nodes;
    trial->applications = j->figures.applications;
    trial->runs++;
    trial->state = COST_DONE;
}

static void
stop(struct cost_trial *trial, enum cost_end end, double allowed, const struct job *j)
{
    trial->state = COST_STOPPED;
    if (end == COST_LATE)
        snprintf(trial->why, sizeof trial->why,
                 "stopped after %.2g s, all that was left of --limit", allowed);
    else if (end == COST_INTERRUPTED)
        snprintf(trial->why, sizeof trial->why, "interrupted");
    else if (end == COST_DIED)
        snprintf(trial->why, sizeof trial->why, "its process died: memory may be short");
    else
        snprintf(trial->why, sizeof trial->why, "%.250s", j->err.text);
}

static struct rc_problem
problem_of(const struct cost_case *c, const struct cost_trial *trial)
{
    struct rc_problem problem = c->problem;

    problem.method = trial->settings.method;
    problem.engine = trial->settings.kernel;
    problem.tol = trial->settings.tol;
    problem.threads = c->tool->threads;
    return problem;
}

/* Where slabs are not known yet, about as many as there are on most maps. */
static size_t
slabs_of(const struct cost_case *c, const struct cost_trial *trial)
{
    double each =
        c->reference.slabs > 0 ? (double)c->reference.slabs / c->reference.settings.stack : 14;

    return trial->slabs > 0 ? trial->slabs : (size_t)ceil(each * trial->settings.stack);
}

size_t
cost_memory(const struct cost_case *c, const struct cost_trial *trial)
{
    const double part = 0.3; /* of the voxels that yield */
    struct rc_problem problem = problem_of(c, trial);
    struct rc_plastic_problem yielding = {.contact = problem, .precise = trial->settings.precise};
    size_t bytes;
    const size_t eliminated = 200; /* bytes a node that a flow takes beside, on most maps */

    if (c->adhesion != NULL) {
        struct rc_adhesion_problem attracting = *c->adhesion;
        attracting.contact = problem;
        return rc_adhesion_memory(&trial->shape, &attracting) +
               trial->shape.nx * trial->shape.ny * sizeof(double);
    }
    bytes = rc_solver_memory(&trial->shape, &problem);
    if (c->leak != 0)
        bytes += rc_leak_memory(&trial->shape) + eliminated * trial->shape.nx * trial->shape.ny;
    if (c->yield == NULL)
        return bytes;
    yielding.slabs = slabs_of(c, trial);
    return bytes + rc_plastic_memory(&trial->shape, &yielding, part);
}

bool
cost_trial_run(struct cost_case *c, struct cost_trial *trial, double allowed, double *pressure)
{
    size_t n = c->shape.nx * c->shape.ny, bytes = sizeof(struct job) + n * sizeof(double);
    struct job *j = cost_share(bytes);
    enum cost_end end;

    if (j == NULL)
        tool_die_at(c->tool, c->heights, EXIT_IMPOSSIBLE, "out of memory");
    j->tool = c->tool;
    j->trial = trial;
    j->h = c->heights->v;
    j->map = c->shape;
    j->problem = problem_of(c, trial);
    j->yield = c->yield;
    j->adhesion = c->adhesion;
    j->by_approach = c->by_approach;
    j->cohesive_nodes = NAN;
    j->leak = c->leak;
    j->at.error = NAN;
    end = cost_run(work, j, allowed, watch);
    tool_progress_end(c->tool);
    if (end == COST_ENDED && j->done) {
        keep(trial, j, &c->shape);
        if (c->pressure != NULL)
            compare(c, trial, j->p);
        if (pressure != NULL)
            memcpy(pressure, j->p, n * sizeof *pressure);
    } else if (trial->runs == 0) {
        stop(trial, end, allowed, j);
    }
    cost_unshare(j, bytes);
    return end != COST_INTERRUPTED;
}
