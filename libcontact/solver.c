#include "solver.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fft.h"

static const struct rc_method *const methods[] = {
#define RC_METHOD(name) &rc_method_##name,
#include "methods.list"
#undef RC_METHOD
};

enum {
    METHODS = sizeof methods / sizeof *methods
};

/* ---- new ---- */

static const struct rc_method *
choose(const char *name, struct rc_err *err)
{
    if (name == NULL || strcmp(name, "auto") == 0)
        return methods[0];
    for (size_t k = 0; k < METHODS; k++)
        if (strcmp(methods[k]->name, name) == 0)
            return methods[k];
    rc_err_set(err, "there is no method '%s'", name);
    return NULL;
}

static enum rc_status
check(const struct rc_shape *s, const double *h, const struct rc_problem *problem,
      struct rc_err *err)
{
    double carried;

    if (rc_shape_check(s, err) != RC_OK)
        return RC_FAIL;
    if (!(problem->estar > 0) || isinf(problem->estar))
        return rc_err_set(err, "E* = %g Pa: it must be positive and finite", problem->estar);
    if (!(problem->load > 0) || isinf(problem->load))
        return rc_err_set(err, "load %g N: it must be positive and finite", problem->load);
    if (!(problem->hardness > 0))
        return rc_err_set(err, "hardness %g Pa: it must be positive", problem->hardness);
    if (problem->tol <= 0)
        return rc_err_set(err, "tolerance %g: it must be positive", problem->tol);
    for (size_t k = 0; k < s->nx * s->ny; k++)
        if (!isfinite(h[k]))
            return rc_err_set(err, "height %zu is not a finite number", k);
    carried = problem->hardness * (s->dx * s->dy) * (double)(s->nx * s->ny);
    if (problem->load > carried * (1 + 4 * DBL_EPSILON))
        return rc_err_set(err, "load %.9g N is above hardness times area, %.9g Pa x %.9g m2 = "
                               "%.9g N, where every node yields: no solution exists; lower the "
                               "load or raise the hardness",
                          problem->load, problem->hardness,
                          s->dx * s->dy * (double)(s->nx * s->ny), carried);
    return RC_OK;
}

/* The paper's M^(-3/2) on a square grid. */
static double
tolerance(const struct rc_shape *shape, const struct rc_problem *problem)
{
    return isnan(problem->tol) ? pow((double)(shape->nx * shape->ny), -0.75) : problem->tol;
}

/* The engine's accuracy follows from that of the pressure, which it must not spoil. */
static struct rc_conv_options
conv_options(const struct rc_shape *shape, const struct rc_problem *problem)
{
    bool mlms = problem->engine != NULL && strcmp(problem->engine, "mlms") == 0;

    return (struct rc_conv_options){.boundary = problem->boundary,
                                    .engine = problem->engine,
                                    .tol = mlms ? 0.1 * tolerance(shape, problem) : 0,
                                    .threads = problem->threads};
}

static bool
allocate(struct rc_solver *s, const double *h)
{
    double top = h[0];

    s->h = malloc(s->n * sizeof *s->h);
    s->p = malloc(s->n * sizeof *s->p);
    s->g = malloc(s->n * sizeof *s->g);
    s->z = malloc(s->n * sizeof *s->z);
    s->working = malloc(s->n);
    if (s->h == NULL || s->p == NULL || s->g == NULL || s->z == NULL || s->working == NULL)
        return false;
    for (size_t k = 0; k < s->n; k++)
        top = fmax(top, h[k]);
    for (size_t k = 0; k < s->n; k++) {
        s->h[k] = h[k] - top;
        s->p[k] = fmin(s->sum / (double)s->n, s->hardness);
    }
    return true;
}

struct rc_solver *
rc_solver_new(const struct rc_shape *shape, const double *h, const struct rc_problem *problem,
              struct rc_err *err)
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
    s->load = problem->load;
    s->sum = problem->load / s->cell;
    if (s->sum >= s->hardness * (double)s->n * (1 - 8 * DBL_EPSILON))
        s->sum = s->hardness * (double)s->n; /* every node yields, whatever the rounding */
    s->tol = tolerance(shape, problem);
    s->max_iterations = problem->max_iterations > 0
                            ? problem->max_iterations
                            : 100 + (size_t)(10 * sqrt((double)s->n));
    s->threads = problem->threads;
    s->change = s->error = s->estimate = NAN;
    s->next_check = 1;
    if (!allocate(s, h))
        goto short_of_memory;
    if ((s->method = choose(problem->method, err)) == NULL ||
        (s->conv = rc_conv_new(shape, s->estar, &options, err)) == NULL ||
        (s->extension = rc_extension_new(shape, s->boundary, s->estar, problem->threads, err)) == NULL ||
        (s->state = s->method->new(s, err)) == NULL) {
        rc_solver_free(s);
        return NULL;
    }
    return s;
short_of_memory:
    rc_err_set(err, "out of memory for a contact of %zu x %zu nodes", shape->nx, shape->ny);
    rc_solver_free(s);
    return NULL;
}

void
rc_solver_free(struct rc_solver *s)
{
    if (s == NULL)
        return;
    if (s->state != NULL)
        s->method->free(s->state);
    rc_conv_free(s->conv);
    rc_extension_free(s->extension);
    free(s->h);
    free(s->p);
    free(s->g);
    free(s->z);
    free(s->working);
    free(s);
}

size_t
rc_solver_memory(const struct rc_shape *shape, const struct rc_problem *problem)
{
    struct rc_conv_options options = conv_options(shape, problem);
    size_t n = shape->nx * shape->ny;

    /* four arrays and a mask here, three in the method, three in the error estimate beside its
     * transforms and the spectrum of its second kernel */
    return n * (10 * sizeof(double) + 1) + rc_conv_memory(shape, &options) +
           rc_fft_memory(shape, problem->boundary, RC_SINGLE) +
           rc_spectrum_memory(shape, problem->boundary, RC_SINGLE);
}

/* ---- what the methods share ---- */

size_t
rc_solver_gap(struct rc_solver *s, const double *u, double *g, double *shift)
{
    double mean = 0, low = -INFINITY, high = INFINITY;
    size_t elastic = 0;

    for (size_t k = 0; k < s->n; k++) {
        g[k] = u[k] - s->h[k];
        if (rc_elastic(s, k)) {
            mean += g[k];
            elastic++;
        } else if (s->p[k] > 0) {
            low = fmax(low, g[k]);
        } else {
            high = fmin(high, g[k]);
        }
    }
    if (elastic > 0)
        mean /= (double)elastic;
    else
        mean = isinf(low) ? high : isinf(high) ? low : (low + high) / 2;
    for (size_t k = 0; k < s->n; k++)
        g[k] -= mean;
    *shift = mean;
    return elastic;
}

/* ---- judging ---- */

/* Relative L1 norm of the correction that the extension preconditioner would make, from s->g, the
 * gap of s->p with zero mean over `elastic` nodes. */
static double
estimate_error(struct rc_solver *s, size_t elastic)
{
    size_t count = 0;
    double mean = 0, sum = 0;

    for (size_t k = 0; k < s->n; k++) {
        s->working[k] = rc_elastic(s, k) || rc_wants_out(s, k);
        if (s->working[k]) {
            mean += s->g[k];
            count++;
        }
    }
    if (count == elastic && elastic < 2)
        return 0; /* nothing to exchange, nobody wants to move */
    if (elastic == 0)
        return INFINITY; /* some do, but no gap says how far */
    mean /= (double)count;
    for (size_t k = 0; k < s->n; k++)
        s->g[k] = s->working[k] ? mean - s->g[k] : 0;
    rc_extension_set(s->extension, s->working);
    rc_extension_apply(s->extension, s->g, s->z);
    s->convolutions += 2; /* four in single precision */
    mean = 0;
    for (size_t k = 0; k < s->n; k++)
        mean += s->z[k];
    mean /= (double)count;
    for (size_t k = 0; k < s->n; k++)
        if (s->working[k])
            sum += fabs(s->z[k] - mean);
    return sum / s->sum;
}

static double
judge(struct rc_solver *s)
{
    double shift;

    rc_conv_apply(s->conv, s->p, s->g);
    s->convolutions++;
    return estimate_error(s, rc_solver_gap(s, s->g, s->g, &shift));
}

/* The load is a constraint that every method keeps; should one lose it, the result is none. */
static bool
load_kept(const struct rc_solver *s)
{
    return fabs(rc_sum(s->p, s->n) - s->sum) <= 1e-10 * s->sum;
}

enum rc_status
rc_solver_step(struct rc_solver *s)
{
    bool last;

    s->method->step(s, s->state);
    s->iterations++;
    if (!isnan(s->estimate)) {
        s->error = s->estimate;
        s->judged = s->iterations;
        if (s->error <= s->tol && load_kept(s))
            return RC_OK;
        return s->iterations >= s->max_iterations || s->change == 0 ? RC_SHORT : RC_MORE;
    }
    last = s->iterations >= s->max_iterations || s->change <= DBL_EPSILON;
    /* Five convolutions to judge, two to go on: not before the steps are small, nor every time. */
    if (!last && (s->iterations < s->next_check || s->change > s->tol))
        return RC_MORE;
    s->error = judge(s);
    s->judged = s->iterations;
    s->next_check = s->iterations + 5 + s->iterations / 10;
    if (s->error <= s->tol && load_kept(s))
        return RC_OK;
    return last ? RC_SHORT : RC_MORE;
}

/* ---- results ---- */

size_t
rc_solver_iterations(const struct rc_solver *s)
{
    return s->iterations;
}

double
rc_solver_error(const struct rc_solver *s)
{
    return s->error;
}

const double *
rc_solver_pressure(const struct rc_solver *s)
{
    return s->p;
}

const char *
rc_solver_engine(const struct rc_solver *s)
{
    return rc_conv_engine(s->conv);
}

const char *
rc_solver_engine_reason(const struct rc_solver *s)
{
    return rc_conv_reason(s->conv);
}

const char *
rc_solver_method(const struct rc_solver *s)
{
    return s->method->name;
}

static double
deviation(size_t n, const double *v)
{
    double mean = rc_sum(v, n) / (double)n, sum = 0;

    for (size_t k = 0; k < n; k++)
        sum += (v[k] - mean) * (v[k] - mean);
    return sqrt(sum / (double)n);
}

/* Load on the outer 2 % of the map, at least one line of nodes on each side. */
static double
edge_load(const struct rc_solver *s)
{
    size_t nx = s->shape.nx, ny = s->shape.ny;
    size_t mx = nx < 3 ? 0 : (nx + 49) / 50, my = ny < 3 ? 0 : (ny + 49) / 50;
    double sum = 0;

    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++)
            if (i < mx || i + mx >= nx || j < my || j + my >= ny)
                sum += s->p[j * nx + i];
    return sum / s->sum;
}

static double
violation(const struct rc_solver *s, size_t k)
{
    if (rc_elastic(s, k))
        return fabs(s->g[k]);
    return rc_wants_out(s, k) ? fabs(s->g[k]) : 0;
}

static void
count_nodes(const struct rc_solver *s, struct rc_contact *c)
{
    for (size_t k = 0; k < s->n; k++) {
        c->contact_nodes += s->p[k] > 0;
        c->plastic_nodes += s->p[k] >= s->hardness;
        c->max_pressure = fmax(c->max_pressure, s->p[k]);
    }
    c->load = rc_sum(s->p, s->n) * s->cell;
    c->mean_pressure = c->load / (s->cell * (double)s->n);
    c->contact_area = s->cell * (double)c->contact_nodes;
    c->contact_fraction = (double)c->contact_nodes / (double)s->n;
    c->plastic_area = s->cell * (double)c->plastic_nodes;
    c->hardness_active = c->plastic_nodes > 0;
    c->edge_load_fraction = edge_load(s);
}

void
rc_solver_result(struct rc_solver *s, double *displacement, double *gap, struct rc_contact *c)
{
    double shift, worst = 0, scale;
    size_t elastic;

    *c = (struct rc_contact){.iterations = s->iterations};
    count_nodes(s, c);
    rc_conv_apply(s->conv, s->p, s->z);
    s->convolutions++;
    elastic = rc_solver_gap(s, s->z, s->g, &shift);
    c->approach = elastic > 0 ? shift : NAN; /* the highest of s->h is 0 */
    c->mean_gap = rc_sum(s->g, s->n) / (double)s->n;
    for (size_t k = 0; k < s->n; k++)
        worst = fmax(worst, violation(s, k));
    scale = fmax(deviation(s->n, s->h), deviation(s->n, s->z));
    c->kkt_residual = worst == 0 ? 0 : worst / scale;
    if (displacement != NULL)
        memcpy(displacement, s->z, s->n * sizeof *displacement);
    if (gap != NULL)
        memcpy(gap, s->g, s->n * sizeof *gap);
    if (s->judged != s->iterations || isnan(s->error)) /* stopped from outside */
        s->error = estimate_error(s, elastic);
    c->pressure_error = s->error;
    c->converged = s->error <= s->tol && load_kept(s);
    c->convolutions = s->convolutions;
}
