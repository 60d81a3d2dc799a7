/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of the solver: makes a solver, steps it, judges its result, and sets other loads, heights and
 * starts.
 */
#include "solver.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/expected.h"
#include "libcontact/memory.h"

static const struct rc_method *const methods[] = {
#define RC_METHOD(name) &rc_method_##name,
#include RC_METHODS_LIST
#undef RC_METHOD
};

enum {
    METHODS = sizeof methods / sizeof *methods
};

const struct rc_method_info *
rc_method_info(size_t k)
{
    return k < METHODS ? &methods[k]->info : NULL;
}

static const char *
method_name(const void *of, size_t k)
{
    (void)of;
    return k == 0 ? "auto" : k <= METHODS ? methods[k - 1]->info.name : NULL;
}

static const struct rc_method *
choose(const char *name, struct rc_err *err)
{
    if (name == NULL || strcmp(name, "auto") == 0)
        return methods[0];
    for (size_t k = 0; k < METHODS; k++)
        if (strcmp(methods[k]->info.name, name) == 0)
            return methods[k];
    rc_err_set(err, "there is no method '%s'", name);
    rc_err_choices(err, method_name, NULL);
    return NULL;
}

/* ---- new ---- */

static enum rc_status
check(const struct rc_shape *s, const struct rc_problem *problem, struct rc_err *err)
{
    if (rc_shape_check(s, err) != RC_OK || rc_boundary_check(problem->boundary, err) != RC_OK)
        return RC_FAIL;
    if (rc_pair_check(&problem->pair, err) != RC_OK)
        return RC_FAIL;
    if (!(problem->tol >= 0))
        return rc_err_set(err, "tolerance %g: it must be positive", problem->tol);
    if (problem->approach > 0 && isinf(problem->approach))
        return rc_err_set(err, "approach %g m: it must be finite", problem->approach);
    return RC_OK;
}

/* The paper's M^(-3/2) on a square grid, but at most 1e-3. Half of this takes 6 % more
 * convolutions (74 contacts of bench/constants.py). */
static double
tolerance(const struct rc_shape *shape, const struct rc_problem *problem)
{
    const double most = 1e-3;

    return problem->tol > 0 ? problem->tol
                            : fmin(most, pow((double)(shape->nx * shape->ny), -0.75));
}

/* The residual does not show the engine's own error, so this error must be small beside the tolerance of the
 * pressure. At a tenth of the tolerance, as in the paper, the engine made up to a third of the final
 * error. */
static struct rc_operator_options
operator_options(const struct rc_shape *shape, const struct rc_problem *problem,
                 const struct rc_along *along)
{
    return (struct rc_operator_options){.boundary = problem->boundary,
                                        .pair = &problem->pair,
                                        .along = along,
                                        .engine = problem->engine,
                                        .tol = 0.02 * tolerance(shape, problem),
                                        .threads = problem->threads,
                                        .ranks = problem->ranks};
}

/* The largest height; -INFINITY without nodes, NAN where a height is not a finite number. */
static double
top_of(const double *h, size_t n, int threads)
{
    double top = -INFINITY, zero = 0;

#pragma omp parallel for simd num_threads(threads) schedule(static) reduction(max : top)           \
    reduction(+ : zero)
    for (size_t k = 0; k < n; k++) {
        top = h[k] > top ? h[k] : top;
        zero += h[k] * 0;
    }
    return top + zero;
}

static size_t
first_not_finite(const double *h, size_t n)
{
    size_t k = 0;

    while (k < n && isfinite(h[k]))
        k++;
    return k;
}

/* Stores the heights minus the largest height of all ranks. `status`: RC_FAIL if this rank failed before; all
 * ranks then fail. */
static enum rc_status
take_heights(struct rc_posed *posed, const double *h, enum rc_status status, struct rc_err *err)
{
    double top = top_of(h, posed->n, posed->threads);

    if (status == RC_OK && isnan(top))
        status = rc_err_set(err, "height %zu is not a finite number",
                            posed->rows.first * posed->shape.nx + first_not_finite(h, posed->n));
    if (rc_ranks_agree(posed->rows.ranks, status, err) != RC_OK)
        return RC_FAIL;
    posed->top = rc_ranks_most(posed->rows.ranks, top);
#pragma omp parallel for num_threads(posed->threads) schedule(static)
    for (size_t k = 0; k < posed->n; k++)
        posed->h[k] = h[k] - posed->top;
    return RC_OK;
}

static enum rc_status
pose(struct rc_posed *posed, const struct rc_shape *shape, const double *h,
     const struct rc_problem *problem, struct rc_err *err)
{
    const struct rc_rows rows = rc_rows_of(problem->ranks, shape);
    const struct rc_shape own = rc_rows_shape(&rows, shape);
    size_t n = own.nx * own.ny, nodes = shape->nx * shape->ny;
    enum rc_status status = RC_OK;

    *posed = (struct rc_posed){.whole = *shape,
                               .shape = own,
                               .rows = rows,
                               .boundary = problem->boundary,
                               .n = n,
                               .nodes = nodes,
                               .cell = shape->dx * shape->dy,
                               .h = rc_alloc(n, sizeof *posed->h),
                               .tol = tolerance(shape, problem),
                               .history_part = problem->history_part,
                               .max_iterations = problem->max_iterations > 0
                                                     ? problem->max_iterations
                                                     : 100 + (size_t)(10 * sqrt((double)nodes)),
                               .threads = rc_useful_threads(&own, problem->threads),
                               .height_error = problem->height_error,
                               .discretization = problem->discretization,
                               .hurry = problem->ranks == NULL ? problem->hurry : NULL};
    if (rc_bounds_of(&posed->bounds, problem, shape, err) != RC_OK)
        return RC_FAIL;
    if (posed->h == NULL || rc_bounds_keep(&posed->bounds, n) != RC_OK)
        status =
            rc_err_set(err, "out of memory for a contact of %zu x %zu nodes", shape->nx, shape->ny);
    return take_heights(posed, h, status, err);
}

/* Allocates the solver's maps and the method's state, on all ranks or on none. */
static enum rc_status
make_room(struct rc_solver *s, struct rc_err *err)
{
    const struct rc_shape *whole = &s->posed.whole;

    s->z = rc_store_take(&s->own, s->posed.n, sizeof *s->z);
    s->partial =
        rc_store_take(&s->own, rc_reduce_partials(&s->posed.shape), RC_SUMS * sizeof *s->partial);
    rc_iterate_new(s);
    return rc_ranks_need(s->posed.rows.ranks,
                         rc_working_set_new(s) == RC_OK && (s->state = s->method->new (s)) != NULL,
                         err, "out of memory for a contact of %zu x %zu nodes", whole->nx,
                         whole->ny);
}

/* Makes a solver that owns the operator. The operator is NULL if making it failed (*err then has the reason).
 * `all`: the ranks that make this call. */
static struct rc_solver *
solver_new(const struct rc_ranks *all, const struct rc_shape *shape, const double *h,
           const struct rc_problem *problem, const struct rc_method *method, struct rc_operator *op,
           struct rc_err *err)
{
    RC_OWN(rc_solver, s) = calloc(1, sizeof *s);

    if (s == NULL)
        rc_err_set(err, "out of memory for a contact of %zu x %zu nodes", shape->nx, shape->ny);
    if (rc_ranks_agree(problem->ranks, s == NULL || op == NULL ? RC_FAIL : RC_OK, err) != RC_OK) {
        rc_operator_free(op);
        return NULL;
    }
    s->op = op;
    s->method = method;
    s->coarse = (struct rc_discretization){NAN, NAN, NAN};
    if (pose(&s->posed, shape, h, problem, err) != RC_OK || make_room(s, err) != RC_OK)
        return NULL;
    s->posed.rough = !op->exact;
    s->posed.all = all;
    if (rc_load_first(s, problem, err) != RC_OK || rc_tilt_new(s, problem, err) != RC_OK ||
        (s->preconditioner = rc_preconditioner_new(op, err)) == NULL)
        return NULL;
    rc_iterate_level(s);
    rc_nested_new(s);
    return rc_give(&s);
}

struct rc_solver *
rc_solver_new_along(const struct rc_shape *shape, const double *h, const struct rc_problem *problem,
                    const struct rc_along *along, struct rc_err *err)
{
    struct rc_operator_options options = operator_options(shape, problem, along);
    const struct rc_method *method = choose(problem->method, err);

    if (method == NULL || check(shape, problem, err) != RC_OK)
        return NULL;
    return solver_new(problem->ranks, shape, h, problem, method,
                      rc_operator_new(shape, &options, err), err);
}

struct rc_solver *
rc_solver_new(const struct rc_shape *shape, const double *h, const struct rc_problem *problem,
              struct rc_err *err)
{
    return rc_solver_new_along(shape, h, problem, NULL, err);
}

struct rc_solver *
rc_solver_coarse(const struct rc_solver *fine, const struct rc_shape *shape, const double *h,
                 const struct rc_problem *problem, struct rc_err *err)
{
    return solver_new(fine->posed.all, shape, h, problem, fine->method,
                      rc_operator_coarse(fine->op, problem->ranks, shape, err), err);
}

void
rc_solver_free(struct rc_solver *s)
{
    if (s == NULL)
        return;
    rc_nested_free(s);
    rc_preconditioner_free(s->preconditioner);
    rc_operator_free(s->op);
    free(s->posed.h);
    rc_bounds_free(&s->posed.bounds);
    rc_store_free(&s->own);
    free(s);
}

/* ---- memory and cost of a solver ---- */

const char *
rc_solver_choice(const struct rc_shape *shape, const struct rc_problem *problem,
                 const char **reason)
{
    struct rc_operator_options options = operator_options(shape, problem, NULL);

    return rc_operator_engine(shape, &options, reason);
}

/* Bytes of a solver with its copies of heights and pressure, on a rank: measured, as rc_engine_info tells. */
static size_t
memory(const struct rc_shape *shape, const struct rc_problem *problem, const char *engine,
       const struct rc_method *method)
{
    const struct rc_engine_info *info;
    double each = problem->tilt_free ? RC_STIFFNESS_BYTES : 0;

    for (size_t k = 0; (info = rc_engine_info(k)) != NULL; k++)
        if (strcmp(info->name, engine) == 0)
            each +=
                rc_by_padding(problem->boundary, info->contact_bytes[0], info->contact_bytes[1]);
    if (problem->pair.one.layers + problem->pair.two.layers > 0 && rc_has_mean(problem->boundary))
        each += 4; /* for the upper bound of layers that bend */
    if (problem->hardness_map != NULL)
        each += sizeof(double);
    return (size_t)((each + method->info.bytes) * (double)shape->nx * (double)shape->ny /
                    (double)rc_ranks_count(problem->ranks));
}

/* Checks all but the load; gives the method and the bounds. */
static enum rc_status
check_all(const struct rc_shape *shape, const struct rc_problem *problem,
          const struct rc_method **method, struct rc_bounds *bounds, struct rc_err *err)
{
    const struct rc_operator_options options = operator_options(shape, problem, NULL);

    *method = choose(problem->method, err);
    return *method != NULL && check(shape, problem, err) == RC_OK &&
                   rc_operator_check(shape, &options, err) == RC_OK &&
                   rc_bounds_of(bounds, problem, shape, err) == RC_OK
               ? RC_OK
               : RC_FAIL;
}

enum rc_status
rc_solver_check(const struct rc_shape *shape, const struct rc_problem *problem, struct rc_err *err)
{
    const struct rc_method *method;
    struct rc_bounds bounds;

    return check_all(shape, problem, &method, &bounds, err);
}

enum rc_status
rc_solver_expect(const struct rc_shape *shape, const struct rc_problem *problem,
                 struct rc_expected *expected, struct rc_err *err)
{
    const struct rc_operator_options options = operator_options(shape, problem, NULL);
    const struct rc_method *method;
    struct rc_bounds bounds;
    const bool layered = problem->pair.one.layers + problem->pair.two.layers > 0;
    double nodes = (double)(shape->nx * shape->ny), some;
    const char *reason, *engine = rc_operator_engine(shape, &options, &reason);

    if (check_all(shape, problem, &method, &bounds, err) != RC_OK)
        return RC_FAIL;
    if (!(problem->approach > 0) && rc_load_check(problem->load, &bounds, shape->dx * shape->dy,
                                                  shape->nx * shape->ny, err) != RC_OK)
        return RC_FAIL;
    some = method->convolutions == NULL
               ? NAN
               : method->convolutions(nodes, -log10(tolerance(shape, problem)));
    if (problem->approach > 0 || problem->tilt_free)
        some *= 3;
    if (layered)
        some *= 1.4;
    if (problem->discretization)
        some += 5;
    *expected = (struct rc_expected){
        .convolutions = some,
        .seconds = (some + (layered ? RC_LAYER_TABLES : 0) +
                    (rc_repeats(problem->boundary) == 1 ? RC_LINE_TABLES : 0)) *
                   rc_operator_seconds(shape, &options),
        .memory = memory(shape, problem, engine, method)};
    return RC_OK;
}

/* ---- step ---- */

bool
rc_solver_hurried(const struct rc_solver *s)
{
    return s->posed.hurry != NULL && *s->posed.hurry != 0;
}

/* When a yielded shape is loaded again, nodes are at their upper bounds with a gap of 0. But the iteration
 * leaves their pressures lower by up to the tolerance. This sets them to their bounds and judges the pressure
 * again. */
static enum rc_status
finished(struct rc_solver *s)
{
    double goal = rc_history_goal(s);

    if (s->it.error > goal) {
        s->load.tol = goal;
        s->it.rested = false;
        return RC_MORE;
    }
    if (s->posed.height_error == 0 || s->it.rested || s->load.tol > s->posed.tol ||
        !rc_iterate_rest(s))
        return RC_OK;
    s->it.rested = true;
    rc_solver_restart(s);
    rc_iterate_checked(s, rc_iterate_judge(s), 1);
    return s->it.error <= s->load.tol ? RC_OK : RC_MORE;
}

/* One iteration at the present load. */
static enum rc_status
step(struct rc_solver *s)
{
    struct rc_iterate *it = &s->it;
    struct rc_found found = s->method->step(s, s->state);
    bool last;

    it->iterations++;
    last = it->iterations >= s->posed.max_iterations;
    if (!isnan(found.estimate)) {
        rc_iterate_checked(s, found.estimate, 1);
        if (it->error <= s->load.tol && (s->posed.rough || rc_iterate_keeps_load(s)))
            return finished(s);
        return last || found.change == 0 ? RC_SHORT : RC_MORE;
    }
    last |= found.change <= DBL_EPSILON;
    /* Judging costs four convolutions and a step two, so a solution is judged only when its steps are
     * small. */
    if (!last && (it->iterations < it->next_check || found.change > s->load.tol))
        return RC_MORE;
    rc_iterate_checked(s, rc_iterate_judge(s), 5 + it->iterations / 10);
    if (it->error <= s->load.tol && rc_iterate_keeps_load(s))
        return finished(s);
    return last ? RC_SHORT : RC_MORE;
}

enum rc_status
rc_solver_step(struct rc_solver *s)
{
    enum rc_status status;

    s->stage = RC_STAGE_STEPPED;
    s->load.error = NAN;
    if (s->nested.ahead) {
        rc_nested_step(s);
        return RC_MORE;
    }
    rc_tilt_begin(s);
    status = step(s);
    if (status == RC_OK && s->tilt != NULL)
        status = rc_tilt_search(s);
    status = rc_tilt_end(s, status);
    return status == RC_OK && s->load.target > 0 ? rc_load_search(s) : status;
}

void
rc_solver_restart(struct rc_solver *s)
{
    rc_iterate_forget(s);
    if (s->method->forget != NULL)
        s->method->forget(s->state);
    rc_working_set_forget(s);
}

/* ---- other loads, heights and starts ---- */

/* Resets the counts and the comparison with a coarser grid, which belong to the last load and heights. */
static void
begin_anew(struct rc_solver *s)
{
    rc_iterate_reset(s);
    rc_solver_restart(s);
    s->coarse = (struct rc_discretization){NAN, NAN, NAN};
    if (s->posed.discretization)
        rc_nested_new(s);
    s->stage = RC_STAGE_NEW;
}

enum rc_status
rc_solver_set_load(struct rc_solver *s, double load, double approach, struct rc_err *err)
{
    bool untouched = rc_nested_untouched(s);

    if (!untouched)
        rc_nested_end(s);
    if (rc_load_next(s, load, approach, err) != RC_OK)
        return RC_FAIL;
    if (untouched)
        rc_iterate_level(s);
    else
        rc_projection_balance(s, s->it.v);
    rc_tilt_load(s);
    begin_anew(s);
    return RC_OK;
}

enum rc_status
rc_solver_set_diagonal(struct rc_solver *s, double plus, const double *part, double row,
                       struct rc_err *err)
{
    if (plus == s->op->soft.own && part == NULL && s->op->soft.part == NULL &&
        row == s->op->soft.row)
        return RC_OK;
    if (rc_operator_set_diagonal(s->op, plus, part, row, err) != RC_OK ||
        rc_preconditioner_tune(s->preconditioner, err) != RC_OK)
        return RC_FAIL;
    rc_solver_restart(s);
    return RC_OK;
}

void
rc_solver_respond(struct rc_solver *s, const double *e, double *z)
{
    const size_t size = rc_working_set_fix(s, false);
    struct rc_total sum = {0};

    memset(z, 0, s->posed.n * sizeof *z);
    if (size < 2)
        return;
    for (size_t k = 0; k < s->posed.n; k++)
        rc_total_add(&sum, s->set.w[k] ? e[k] : 0);
    s->set.offset =
        (float)(rc_ranks_total(s->posed.rows.ranks, sum) / (double)size / s->load.length);
    for (size_t k = 0; k < s->posed.n; k++)
        s->set.r[k] = (float)(e[k] / s->load.length);
    rc_working_set_estimate(s);
    for (size_t k = 0; k < s->posed.n; k++)
        z[k] = s->set.w[k] ? (double)s->z[k] / s->load.per_pressure : 0;
}

void
rc_solver_set_tol(struct rc_solver *s, double tol)
{
    s->posed.tol = tol;
}

enum rc_status
rc_solver_next_heights(struct rc_solver *s, const double *h, struct rc_err *err)
{
    bool untouched = rc_nested_untouched(s);

    if (take_heights(&s->posed, h, RC_OK, err) != RC_OK)
        return RC_FAIL;
    s->posed.dents = 0;
    rc_tilt_heights(s);
    if (!untouched)
        rc_nested_end(s);
    if (rc_load_again(s, err) != RC_OK)
        return RC_FAIL;
    begin_anew(s);
    return RC_OK;
}

enum rc_status
rc_solver_set_heights(struct rc_solver *s, const double *h, struct rc_err *err)
{
    if (rc_solver_next_heights(s, h, err) != RC_OK)
        return RC_FAIL;
    return rc_load_next(s, s->load.load, s->load.target, err);
}

enum rc_status
rc_solver_warm_start(struct rc_solver *s, double load, const double *p, struct rc_err *err)
{
    enum rc_status status = RC_OK;
    size_t bad;

    if (s->stage != RC_STAGE_NEW)
        return rc_err_set(err, "a pressure to start from comes before the first step of a load");
    if (p == NULL) {
        rc_iterate_level(s);
        rc_nested_new(s);
        return RC_OK;
    }
    if (s->load.target > 0 && rc_load_set(s, load, err) != RC_OK)
        return RC_FAIL;
    if ((bad = first_not_finite(p, s->posed.n)) < s->posed.n)
        status = rc_err_set(err, "pressure %zu is not a finite number",
                            s->posed.rows.first * s->posed.shape.nx + bad);
    if (rc_ranks_agree(s->posed.rows.ranks, status, err) != RC_OK)
        return RC_FAIL;
    rc_nested_free(s);
    for (size_t k = 0; k < s->posed.n; k++) {
        s->it.p[k] = rc_settled(rc_box(s, 0), k, p[k]);
        s->it.v[k] = -s->posed.h[k]; /* if nodes have to join, the highest joins first */
    }
    rc_projection_restore(s, rc_iterate_carried(s));
    rc_solver_restart(s);
    rc_tilt_from_pressure(s);
    return RC_OK;
}

double *
rc_solver_lasting(const struct rc_solver *s, double *none)
{
    return s->method->lasting != NULL ? s->method->lasting(s->state) : none;
}

void
rc_solver_found(struct rc_solver *s, double error, double load_error, size_t iterations,
                double convolutions)
{
    s->load.tol = s->posed.tol; /* that of the end of a search */
    rc_iterate_displace(s);
    rc_iterate_shift(s);
    rc_working_set_find(s, false);
    s->it.iterations = iterations;
    s->it.convolutions = convolutions;
    rc_iterate_checked(s, error, 1);
    s->load.error = load_error;
    s->stage = RC_STAGE_STEPPED;
}

/* ---- figures and fields ---- */

void
rc_solver_progress(const struct rc_solver *s, struct rc_progress *progress)
{
    const struct rc_solver *at = rc_nested_at_work(s);

    *progress = (struct rc_progress){.grid = at->posed.whole,
                                     .coarser = at != s,
                                     .iterations = at->it.iterations,
                                     .error = at->it.error,
                                     .tol = rc_tilt_goal(at)};
}

double
rc_solver_load(const struct rc_solver *s)
{
    return s->load.load;
}

double
rc_solver_convolutions(const struct rc_solver *s)
{
    return s->it.convolutions + rc_nested_convolutions(s);
}

const double *
rc_solver_pressure(const struct rc_solver *s)
{
    return s->it.p;
}

const char *
rc_solver_engine(const struct rc_solver *s)
{
    return s->op->engine;
}

const char *
rc_solver_engine_reason(const struct rc_solver *s)
{
    return s->op->reason;
}

const char *
rc_solver_method(const struct rc_solver *s)
{
    return s->method->info.name;
}
