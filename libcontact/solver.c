#include "solver.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fft.h"
#include "room.h"

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
    size_t blocks = s->n / 4096 + 1 > s->shape.ny ? s->n / 4096 + 1 : s->shape.ny;
    double top = h[0], start = fmin(s->sum / (double)s->n, s->hardness);

    s->h = rc_room(s->n, sizeof *s->h);
    s->p = rc_room(s->n, sizeof *s->p);
    s->v = rc_room(s->n, sizeof *s->v);
    s->r = rc_room(s->n, sizeof *s->r);
    s->z = rc_room(s->n, sizeof *s->z);
    s->w = rc_room(s->n, sizeof *s->w);
    s->partial = rc_room(blocks, RC_SUMS * sizeof *s->partial);
    if (s->h == NULL || s->p == NULL || s->v == NULL || s->r == NULL || s->z == NULL ||
        s->w == NULL || s->partial == NULL)
        return false;
    for (size_t k = 0; k < s->n; k++)
        top = h[k] > top ? h[k] : top;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (size_t k = 0; k < s->n; k++) {
        s->h[k] = h[k] - top;
        s->p[k] = start;
        s->w[k] = 0;
    }
    return true;
}

/* Single precision has 38 decades, gaps in metres and moduli in pascals can need more: there pressures
 * are of the order of 1, and a power of 2 keeps them exact. */
static void
set_units(struct rc_solver *s)
{
    int exponent;

    (void)frexp(s->sum / (double)s->n, &exponent);
    s->per_pressure = ldexp(1, -exponent);
    s->length = sqrt(s->shape.dx) * sqrt(s->shape.dy) / s->estar * ldexp(1, exponent);
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
    s->load = problem->load;
    s->sum = problem->load / s->cell;
    if (s->sum >= s->hardness * (double)s->n * (1 - 8 * DBL_EPSILON))
        s->sum = s->hardness * (double)s->n; /* every node yields, whatever the rounding */
    s->tol = tolerance(shape, problem);
    s->max_iterations = problem->max_iterations > 0
                            ? problem->max_iterations
                            : 100 + (size_t)(10 * sqrt((double)s->n));
    s->threads = rc_useful_threads(shape, problem->threads);
    s->rough = rough;
    set_units(s);
    rc_solver_forget(s);
    s->change = s->error = s->estimate = NAN;
    s->next_check = 1;
    if (!allocate(s, h))
        goto short_of_memory;
    if ((s->method = choose(problem->method, err)) == NULL ||
        (s->conv = rc_conv_new(shape, s->estar, &options, err)) == NULL ||
        (s->extension = rc_extension_new(shape, s->boundary, problem->threads, err)) == NULL ||
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
    rc_extension_free(s->extension);
    free(s->h);
    free(s->p);
    free(s->v);
    free(s->r);
    free(s->z);
    free(s->w);
    free(s->partial);
    free(s);
}

size_t
rc_solver_memory(const struct rc_shape *shape, const struct rc_problem *problem)
{
    struct rc_conv_options options = conv_options(shape, problem);
    size_t n = shape->nx * shape->ny;

    /* three maps, two of half the width and a mask here; the methods' own; the estimate's */
    return n * (3 * sizeof(double) + 2 * sizeof(float) + 1) + n * 3 * sizeof(double) +
           rc_conv_memory(shape, &options) + rc_extension_memory(shape, problem->boundary);
}

/* ---- judging ---- */

/* The load is a constraint that every method keeps; should one lose it, the result is none. */
static bool
load_kept(const struct rc_solver *s)
{
    return fabs(rc_solver_carried(s) - s->sum) <= 1e-10 * s->sum;
}

static double
judge(struct rc_solver *s)
{
    if (!s->fresh)
        rc_solver_displace(s);
    rc_solver_shift(s);
    rc_solver_residual(s);
    return rc_solver_estimate(s);
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
        if (s->error <= s->tol && (s->rough || load_kept(s)))
            return RC_OK;
        return s->iterations >= s->max_iterations || s->change == 0 ? RC_SHORT : RC_MORE;
    }
    last = s->iterations >= s->max_iterations || s->change <= DBL_EPSILON;
    /* Four convolutions to judge, two to go on: not before the steps are small, nor every time. */
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

double
rc_solver_convolutions(const struct rc_solver *s)
{
    return s->convolutions;
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

struct figures {
    const struct rc_solver *s;
    double *displacement, *gap;
    double mean_h, mean_u;
};

enum { /* sums of the first pass, */
    CONTACT,
    PLASTIC,
    PRESSURE,
    HEIGHT,
    V,
    /* and of the second */
    SPREAD_H = 0,
    SPREAD_U
};

static void
count_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_solver *s = ((struct figures *)at)->s;

    for (size_t k = first; k < first + n; k++) {
        double p = s->p[k];
        sums[CONTACT] += p > 0;
        sums[PLASTIC] += p >= s->hardness;
        sums[PRESSURE] += p;
        sums[HEIGHT] += s->h[k];
        sums[V] += s->v[k];
        sums[RC_MOST] = p > sums[RC_MOST] ? p : sums[RC_MOST];
    }
}

/* Spread of heights and displacements, the worst violation, and the frames. */
static void
spread_block(void *at, size_t first, size_t n, double *sums)
{
    const struct figures *f = at;
    const struct rc_solver *s = f->s;

    for (size_t k = first; k < first + n; k++) {
        double g = s->v[k] - s->shift, u = s->v[k] + s->h[k], p = s->p[k], worst;
        double h = s->h[k] - f->mean_h, around = u - f->mean_u;

        sums[SPREAD_H] += h * h;
        sums[SPREAD_U] += around * around;
        worst = p <= 0 ? fmax(-g, 0) : p >= s->hardness ? fmax(g, 0) : fabs(g);
        sums[RC_MOST] = worst > sums[RC_MOST] ? worst : sums[RC_MOST];
        if (f->displacement != NULL)
            f->displacement[k] = u;
        if (f->gap != NULL)
            f->gap[k] = g;
    }
}

void
rc_solver_result(struct rc_solver *s, double *displacement, double *gap, struct rc_contact *c)
{
    struct figures f = {.s = s, .displacement = displacement, .gap = gap};
    double total[RC_SUMS], n = (double)s->n, scale;

    *c = (struct rc_contact){.iterations = s->iterations};
    if (!s->known || !s->fresh)
        rc_solver_displace(s);
    rc_solver_shift(s);
    rc_solver_blocks(s, count_block, &f, total);
    c->contact_nodes = (size_t)total[CONTACT];
    c->plastic_nodes = (size_t)total[PLASTIC];
    c->max_pressure = total[RC_MOST];
    c->load = total[PRESSURE] * s->cell;
    c->mean_pressure = total[PRESSURE] / n;
    c->contact_area = s->cell * (double)c->contact_nodes;
    c->contact_fraction = (double)c->contact_nodes / n;
    c->plastic_area = s->cell * (double)c->plastic_nodes;
    c->hardness_active = c->plastic_nodes > 0;
    c->edge_load_fraction = edge_load(s);
    c->approach = s->elastic > 0 ? s->shift : NAN; /* the highest of s->h is 0 */
    c->mean_gap = total[V] / n - s->shift;
    f.mean_h = total[HEIGHT] / n;
    f.mean_u = (total[V] + total[HEIGHT]) / n;
    rc_solver_blocks(s, spread_block, &f, total);
    scale = sqrt(fmax(total[SPREAD_H], total[SPREAD_U]) / n);
    if (total[SPREAD_H] == 0) /* one height everywhere: both vanish with the error */
        scale = rc_guard_norm(s) * c->mean_pressure;
    c->kkt_residual = total[RC_MOST] == 0 ? 0 : total[RC_MOST] / scale;
    if (s->judged != s->iterations || isnan(s->error)) { /* stopped from outside */
        rc_solver_residual(s);
        s->error = rc_solver_estimate(s);
    }
    c->pressure_error = s->error;
    c->converged = s->error <= s->tol && load_kept(s);
    c->convolutions = s->convolutions;
}
