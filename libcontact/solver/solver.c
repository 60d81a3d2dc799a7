#include "solver.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/operator/operator.h"
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

/* ---- new ---- */

static const struct rc_method *
choose(const char *name, struct rc_err *err)
{
    if (name == NULL || strcmp(name, "auto") == 0)
        return methods[0];
    for (size_t k = 0; k < METHODS; k++)
        if (strcmp(methods[k]->info.name, name) == 0)
            return methods[k];
    rc_err_set(err, "there is no method '%s'", name);
    return NULL;
}

static enum rc_status
check(const struct rc_shape *s, const double *h, const struct rc_problem *problem,
      struct rc_err *err)
{
    if (rc_shape_check(s, err) != RC_OK)
        return RC_FAIL;
    if (!(problem->estar > 0) || isinf(problem->estar))
        return rc_err_set(err, "E* = %g Pa: it must be positive and finite", problem->estar);
    if (!(problem->hardness > 0))
        return rc_err_set(err, "hardness %g Pa: it must be positive", problem->hardness);
    if (problem->tol <= 0)
        return rc_err_set(err, "tolerance %g: it must be positive", problem->tol);
    for (size_t k = 0; k < s->nx * s->ny; k++)
        if (!isfinite(h[k]))
            return rc_err_set(err, "height %zu is not a finite number", k);
    return RC_OK;
}

/* The paper's M^(-3/2) on a square grid. */
static double
tolerance(const struct rc_shape *shape, const struct rc_problem *problem)
{
    return isnan(problem->tol) ? pow((double)(shape->nx * shape->ny), -0.75) : problem->tol;
}

/* The engine's accuracy follows from that of the pressure, which it must not spoil: at a tenth,
 * as in the paper, its own error, which no residual shows, was up to a third of what was left. */
static struct rc_conv_options
conv_options(const struct rc_shape *shape, const struct rc_problem *problem)
{
    bool mlms = problem->engine != NULL && strcmp(problem->engine, "mlms") == 0;

    return (struct rc_conv_options){.boundary = problem->boundary,
                                    .engine = problem->engine,
                                    .tol = mlms ? 0.02 * tolerance(shape, problem) : 0,
                                    .threads = problem->threads};
}

static bool
allocate(struct rc_solver *s, const double *h)
{
    size_t blocks = s->n / 4096 + 1 > s->shape.ny ? s->n / 4096 + 1 : s->shape.ny;
    double top = h[0];

    s->h = rc_alloc(s->n, sizeof *s->h);
    s->p = rc_alloc(s->n, sizeof *s->p);
    s->v = rc_alloc(s->n, sizeof *s->v);
    s->r = rc_alloc(s->n, sizeof *s->r);
    s->z = rc_alloc(s->n, sizeof *s->z);
    s->w = rc_alloc(s->n, sizeof *s->w);
    s->partial = rc_alloc(blocks, RC_SUMS * sizeof *s->partial);
    if (s->h == NULL || s->p == NULL || s->v == NULL || s->r == NULL || s->z == NULL ||
        s->w == NULL || s->partial == NULL)
        return false;
    for (size_t k = 0; k < s->n; k++)
        top = h[k] > top ? h[k] : top;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (size_t k = 0; k < s->n; k++) {
        s->h[k] = h[k] - top;
        s->w[k] = 0;
    }
    s->top = top;
    return true;
}

/* Single precision has 38 decades, gaps in metres and moduli in pascals can need more: there
 * pressures are of the order of 1, and a power of 2 keeps them exact. */
static void
set_units(struct rc_solver *s)
{
    int exponent;

    (void)frexp(s->sum / (double)s->n, &exponent);
    s->per_pressure = ldexp(1, -exponent);
    s->length = sqrt(s->shape.dx) * sqrt(s->shape.dy) / s->estar * ldexp(1, exponent);
}

enum rc_status
rc_solver_set_load(struct rc_solver *s, double load, struct rc_err *err)
{
    double area = s->cell * (double)s->n, carried = s->hardness * area;

    if (!(load > 0) || isinf(load))
        return rc_err_set(err, "load %g N: it must be positive and finite", load);
    if (load > carried * (1 + 4 * DBL_EPSILON))
        return rc_err_set(err,
                          "load %.9g N is above hardness times area, %.9g Pa x %.9g m2 = "
                          "%.9g N, where every node yields: no solution exists; lower the "
                          "load or raise the hardness",
                          load, s->hardness, area, carried);
    s->load = load;
    s->sum = load / s->cell;
    if (s->sum >= s->hardness * (double)s->n * (1 - 8 * DBL_EPSILON))
        s->sum = s->hardness * (double)s->n; /* every node yields, whatever the rounding */
    set_units(s);
    return RC_OK;
}

/* Where the load is sought, the one given is a guess; without one, that of a flat punch as large
 * as the part of the surface that the approach would cut off. */
static enum rc_status
first_load(struct rc_solver *s, const struct rc_problem *problem, struct rc_err *err)
{
    double guess = problem->load, most = s->hardness * s->cell * (double)s->n / 2;
    size_t cut = 0;

    if (!(problem->approach > 0))
        return rc_solver_set_load(s, problem->load, err);
    if (isinf(problem->approach))
        return rc_err_set(err, "approach %g m: it must be finite", problem->approach);
    for (size_t k = 0; k < s->n; k++)
        cut += s->h[k] >= -problem->approach;
    if (!(guess > 0))
        guess = s->estar * problem->approach * sqrt((double)cut * s->cell);
    rc_load_search_begin(s, problem->approach);
    if (s->boundary == RC_PERIODIC && isinf(s->hardness)) {
        double full = -rc_sum(s->h, s->n) / (double)s->n;
        if (problem->approach >= full)
            return rc_err_set(err,
                              "approach %.9g m: contact is complete at %.9g m, and from there "
                              "the load of a periodic surface grows at the same approach; "
                              "give the load",
                              problem->approach, full);
    }
    return rc_solver_set_load(s, guess < most ? guess : most, err);
}

void
rc_solver_level(struct rc_solver *s)
{
    double start = fmin(s->sum / (double)s->n, s->hardness);

#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (size_t k = 0; k < s->n; k++)
        s->p[k] = start;
}

static struct rc_solver *
solver_new(const struct rc_shape *shape, const double *h, const struct rc_problem *problem,
           bool rough, struct rc_err *err)
{
    struct rc_conv_options options = conv_options(shape, problem);
    struct rc_solver *s = NULL;

    if (check(shape, h, problem, err) != RC_OK)
        return NULL;
    s = calloc(1, sizeof *s);
    if (s == NULL)
        goto short_of_memory;
    s->shape = *shape;
    s->boundary = problem->boundary;
    s->n = shape->nx * shape->ny;
    s->cell = shape->dx * shape->dy;
    s->estar = problem->estar;
    s->hardness = problem->hardness;
    s->tol = s->goal = tolerance(shape, problem);
    s->stages = problem->discretization;
    s->watch = problem->watch;
    s->watcher = problem->watcher;
    s->max_iterations = problem->max_iterations > 0 ? problem->max_iterations
                                                    : 100 + (size_t)(10 * sqrt((double)s->n));
    s->threads = rc_useful_threads(shape, problem->threads);
    s->rough = rough;
    rc_solver_forget(s);
    s->coarse = (struct rc_discretization){NAN, NAN, NAN};
    s->change = s->error = s->estimate = NAN;
    s->next_check = 1;
    if (!allocate(s, h))
        goto short_of_memory;
    if (first_load(s, problem, err) != RC_OK ||
        (s->method = choose(problem->method, err)) == NULL ||
        (!rough && (s->conv = rc_conv_new(shape, s->estar, &options, err)) == NULL) ||
        (s->extension = rc_preconditioner_new(shape, s->boundary, problem->threads, err)) == NULL ||
        (rc_solver_level(s), s->state = s->method->new (s, err)) == NULL) {
        rc_solver_free(s);
        return NULL;
    }
    return s;
short_of_memory:
    rc_err_set(err, "out of memory for a contact of %zu x %zu nodes", shape->nx, shape->ny);
    rc_solver_free(s);
    return NULL;
}

struct rc_solver *
rc_solver_new(const struct rc_shape *shape, const double *h, const struct rc_problem *problem,
              struct rc_err *err)
{
    return solver_new(shape, h, problem, false, err);
}

struct rc_solver *
rc_solver_rough(const struct rc_shape *shape, const double *h, const struct rc_problem *problem,
                struct rc_err *err)
{
    return solver_new(shape, h, problem, true, err);
}

void
rc_solver_free(struct rc_solver *s)
{
    if (s == NULL)
        return;
    if (s->state != NULL)
        s->method->free(s->state);
    rc_conv_free(s->conv);
    rc_preconditioner_free(s->extension);
    free(s->h);
    free(s->p);
    free(s->v);
    free(s->r);
    free(s->z);
    free(s->w);
    free(s->partial);
    free(s);
}

const char *
rc_solver_choice(const struct rc_shape *shape, const struct rc_problem *problem,
                 const char **reason)
{
    struct rc_conv_options options = conv_options(shape, problem);

    return rc_conv_choice(shape, &options, reason);
}

size_t
rc_solver_memory(const struct rc_shape *shape, const struct rc_problem *problem)
{
    struct rc_conv_options options = conv_options(shape, problem);
    size_t n = shape->nx * shape->ny;

    /* three maps, two of half the width and a mask here; the methods' own; the estimate's */
    return n * (3 * sizeof(double) + 2 * sizeof(float) + 1) + n * 3 * sizeof(double) +
           rc_conv_memory(shape, &options) + rc_preconditioner_memory(shape, problem->boundary);
}

enum rc_status
rc_solver_expect(const struct rc_shape *shape, const struct rc_problem *problem,
                 struct rc_expected *expected, struct rc_err *err)
{
    struct rc_conv_options options = conv_options(shape, problem);
    const struct rc_method *method = choose(problem->method, err);
    double nodes = (double)(shape->nx * shape->ny), some;

    if (method == NULL)
        return RC_FAIL;
    if (rc_conv_memory(shape, &options) == 0)
        return rc_err_set(err, "there is no engine '%s'", problem->engine);
    some = method->convolutions(nodes, -log10(tolerance(shape, problem)));
    if (problem->approach > 0)
        some *= 3;
    if (problem->discretization)
        some += 5;
    *expected = (struct rc_expected){.convolutions = some,
                                     .seconds = some * rc_conv_seconds(shape, &options),
                                     .memory = rc_solver_memory(shape, problem)};
    return RC_OK;
}
