/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Stress histories of the points below a map, and the criteria of fatigue for them, depth by depth.
 *
 * A pass: the pressure travels with the contact, so each point of a row sees the stresses of the whole row,
 * and a map of stresses holds one history for each row. Cases: the contact is at other positions over the
 * same body, and the history of a node has one state for each case. At a depth the stresses of all cases are
 * stored in single precision, for a band of rows if memory is short; the next band computes them again.
 */
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "fatigue.h"

enum {
    WORST = 8,   /* hills of a depth: near them the sampling error is measured   */
    STENCIL = 6, /* samples of an interpolation                                */
    PARTS = 4,   /* of a distance between samples                              */
    TOGETHER = 16
};

/* The sampling error of a value is the change by samples that are interpolated between the samples, times
 * `caution`, and parts of the spread of the values on the way: an extremum may be an eighth of a distance
 * from them, in time and across the travel. */
static const double caution = 1.4, of_time = 0.35, of_space = 0.06;
/* An interpolation does not know waves shorter than two or three distances of nodes. Their stress at the
 * depth z is in proportion to the steps of the pressure between nodes and to exp(-decay z/distance). On an
 * edge of the map that carries pressure, nothing is known of the stress beyond it. */
static const double of_steps = 0.5, decay = 2.2, of_border = 0.06;
/* A hill whose value is so much lower than the largest one is not examined, relative. */
static const double far = 0.1;
/* Without equal steps between the states, the change is that by half of the states. */
static const double caution_halves = 1.5, caution_near = 4;

static const unsigned six = (1U << RC_COMPONENTS) - 1;

/* A point with one of the largest values of a depth, and the largest value that may be near it. */
struct worst {
    double value, near;
    size_t at;
};

/* The present depth. */
struct here {
    double at;
    const double *const *residual;
    double unloaded; /* sxx and syy of a layer without load */
    size_t first, rows;
    struct worst worst[RC_CRITERIA + 1][WORST];
    size_t worsts[RC_CRITERIA + 1];
};

struct rc_fatigue {
    struct rc_store own; /* the arrays below */
    struct rc_fatigue_problem problem;
    struct rc_shape shape, result; /* of the map; of the results  */
    struct rc_stress *stress;
    size_t unloaded; /* 1 if a history has the unloaded state, 0  */
    size_t states;   /* of one history, with the unloaded one     */
    size_t band;     /* rows of the map for which `store` has room */
    double *map[RC_COMPONENTS];
    float *store;               /* of cases: [case][component][row of the band][column] */
    double *value[RC_FATIGUES]; /* values that are needed but not wanted by the caller */
    struct rc_history **work;   /* of each thread */
    struct rc_history *beside, *between, *fine; /* of interpolations */
    int threads;
    double *layer; /* Pa: residual stress of each layer, and 0 of the body below; NULL: none */
    struct here here;
    double integral, before, depth_before; /* of the stressed volume */
    struct rc_fatigue_figures depth, all;
};

/* ---- shapes ---- */

/* Before and after it passes along a free axis, a contact does not load the body; neither before and
 * after the loads of a contact that stays, unless the map repeats along both axes. */
static size_t
unloaded_states(const struct rc_fatigue_problem *p)
{
    if (p->pass == 0 && p->column == NULL)
        return rc_has_mean(p->stress.boundary);
    return !rc_wraps(p->stress.boundary, p->pass == 'y' ? RC_Y : RC_X);
}

static size_t
most_column(const struct rc_fatigue_problem *p)
{
    size_t most = 0;

    for (size_t t = 0; p->column != NULL && t < p->cases; t++)
        most = p->column[t] > most ? p->column[t] : most;
    return most;
}

struct rc_shape
rc_fatigue_shape(const struct rc_shape *s, const struct rc_fatigue_problem *p)
{
    struct rc_shape result = *s;

    if (p->pass == 'x')
        return (struct rc_shape){s->ny, 1, s->dy, s->dy};
    if (p->pass == 'y')
        return (struct rc_shape){s->nx, 1, s->dx, s->dx};
    if (!p->stress.boundary.x)
        result.nx += most_column(p);
    return result;
}

static size_t
bytes_of_row(const struct rc_shape *s, const struct rc_fatigue_problem *p)
{
    return p->pass != 0 ? 0 : p->cases * RC_COMPONENTS * s->nx * sizeof(float);
}

static size_t
rows_of_band(const struct rc_shape *s, const struct rc_fatigue_problem *p)
{
    const size_t room = p->room == 0 ? SIZE_MAX : p->room, row = bytes_of_row(s, p);

    return row == 0 || room / row >= s->ny ? s->ny : room / row == 0 ? 1 : room / row;
}

/* The values that are computed: the amplitude always is. */
static unsigned
computed(const struct rc_fatigue_problem *p)
{
    return p->wanted | 1U << RC_AMPLITUDE;
}

size_t
rc_fatigue_memory(const struct rc_shape *s, const struct rc_fatigue_problem *p)
{
    const struct rc_shape r = rc_fatigue_shape(s, p);
    size_t maps = 0;

    for (int c = 0; c < RC_FATIGUES; c++)
        maps += computed(p) >> c & 1;
    return RC_COMPONENTS * s->nx * s->ny * sizeof(double) + maps * r.nx * r.ny * sizeof(double) +
           rows_of_band(s, p) * bytes_of_row(s, p);
}

enum rc_status
rc_fatigue_check(const struct rc_shape *shape, const struct rc_fatigue_problem *p,
                 struct rc_err *err)
{
    struct rc_stress_options o = p->stress;

    o.wanted = six;
    o.section = 0;
    o.traction[0] = o.traction[1] = NULL;
    if (rc_stress_check(shape, &o, err) != RC_OK)
        return RC_FAIL;
    if (p->pass != 0 && p->pass != 'x' && p->pass != 'y')
        return rc_err_set(err, "a pass along '%c': it must be along x or y", p->pass);
    if (p->cases == 0 || (p->pass != 0 && p->cases != 1))
        return rc_err_set(err, "%zu cases: a pass has one, positions have at least one", p->cases);
    if (p->pass == 0 && p->wanted >> RC_SHAKEDOWN & 1)
        return rc_err_set(err, "shakedown of cases is not implemented: it needs a pass, whose "
                               "residual stresses do not vary along the travel");
    if (p->wanted == 0 || p->wanted >> RC_FATIGUES != 0)
        return rc_err_set(err, "the requested criteria are empty or unknown");
    if (p->stress.ranks != NULL || p->stress.strain != NULL)
        return rc_err_set(err, "fatigue with %s is not implemented",
                          p->stress.ranks != NULL ? "several processes" : "plastic strain");
    if (!(p->power >= 0) || !isfinite(p->power) || !isfinite(p->depth_power) ||
        !(p->threshold >= 0))
        return rc_err_set(err,
                          "stressed volume with the power %g, the power %g of the depth and the "
                          "threshold %g Pa: they must be finite and not negative",
                          p->power, p->depth_power, p->threshold);
    return RC_OK;
}

/* ---- maker ---- */

static const struct rc_fatigue_figures none = {
#define NONE                                                                                       \
    {                                                                                              \
        NAN, NAN, NAN, NAN, NAN                                                                    \
    }
    .largest = {NONE, NONE, NONE, NONE, NONE, NONE},
#undef NONE
    .safety = NAN,
    .sampling_error = NAN,
    .plane_tilt = NAN,
    .plane_turn = NAN,
    .dangvan_hydrostatic = NAN,
    .least_hydrostatic = NAN,
    .largest_hydrostatic = NAN,
    .stressed_volume = NAN};

static enum rc_status
allocate(struct rc_fatigue *f, struct rc_err *err)
{
    const struct rc_fatigue_problem *p = &f->problem;
    const size_t n = f->shape.nx * f->shape.ny, points = f->result.nx * f->result.ny;
    const size_t layers = p->stress.body.layers;

    for (int c = 0; c < RC_COMPONENTS; c++)
        f->map[c] = rc_store_take(&f->own, n, sizeof(double));
    for (int c = 0; c < RC_FATIGUES; c++)
        if (computed(p) >> c & 1)
            f->value[c] = rc_store_take(&f->own, points, sizeof(double));
    if (p->pass == 0)
        f->store = rc_store_take(&f->own, f->band * bytes_of_row(&f->shape, p), 1);
    if (p->stress.residual != NULL)
        f->layer = rc_store_take(&f->own, layers + 1, sizeof *f->layer);
    for (size_t k = 0; f->layer != NULL && k <= layers; k++)
        f->layer[k] = k < layers ? p->stress.residual[k] : 0;
    f->work = rc_store_take(&f->own, (size_t)f->threads, sizeof *f->work);
    for (int k = 0; f->work != NULL && k < f->threads; k++)
        f->work[k] = rc_history_new(&f->own, f->states);
    f->beside = rc_history_new(&f->own, f->states);
    f->between = rc_history_new(&f->own, f->states);
    f->fine = rc_history_new(&f->own, PARTS * f->states);
    return !f->own.failed
               ? RC_OK
               : rc_err_set(err, "out of memory for histories of %zu states at %zu points",
                            f->states, points);
}

struct rc_fatigue *
rc_fatigue_new(const struct rc_shape *shape, const struct rc_fatigue_problem *problem,
               struct rc_err *err)
{
    struct rc_stress_options o = problem->stress;
    RC_OWN(rc_fatigue, f) = NULL;

    if (rc_fatigue_check(shape, problem, err) != RC_OK)
        return NULL;
    if ((f = calloc(1, sizeof *f)) == NULL)
        return rc_err_null(err, "out of memory for a plan");
    f->problem = *problem;
    f->shape = *shape;
    f->result = rc_fatigue_shape(shape, problem);
    f->threads = rc_useful_threads(shape, o.threads);
    f->band = rows_of_band(shape, problem);
    f->unloaded = unloaded_states(problem);
    f->states = (problem->pass == 'x'   ? shape->nx
                 : problem->pass == 'y' ? shape->ny
                                        : problem->cases) +
                f->unloaded;
    f->all = none;
    f->all.stressed_volume = problem->power > 0 ? 0 : NAN;
    o.wanted = six;
    o.section = 0;
    for (int k = 0; k < 2; k++)
        o.traction[k] = problem->traction[k] != NULL ? problem->traction[k][0] : NULL;
    if (allocate(f, err) != RC_OK ||
        (f->stress = rc_stress_new(shape, problem->p[0], &o, err)) == NULL)
        return NULL;
    return rc_give(&f);
}

void
rc_fatigue_free(struct rc_fatigue *f)
{
    if (f == NULL)
        return;
    rc_stress_free(f->stress);
    rc_store_free(&f->own);
    free(f);
}

/* ---- stresses ---- */

static enum rc_status
slice_of(struct rc_fatigue *f, size_t t, struct rc_err *err)
{
    const struct rc_fatigue_problem *p = &f->problem;
    const double *traction[2] = {NULL, NULL};
    double *s[RC_STRESSES] = {NULL};

    for (int k = 0; k < 2; k++)
        if (p->traction[k] != NULL)
            traction[k] = p->traction[k][t];
    for (int c = 0; c < RC_COMPONENTS; c++)
        s[c] = f->map[c];
    if (p->cases > 1 && rc_stress_set_loads(f->stress, p->p[t], traction, err) != RC_OK)
        return RC_FAIL;
    return rc_stress_slice(f->stress, f->here.at, s, err);
}

/* The stresses of all cases in the rows of the band. */
static enum rc_status
fill_band(struct rc_fatigue *f, struct rc_err *err)
{
    const size_t nx = f->shape.nx, n = f->here.rows * nx;

    for (size_t t = 0; t < f->problem.cases; t++) {
        if (slice_of(f, t, err) != RC_OK)
            return RC_FAIL;
#pragma omp parallel for num_threads(f->threads) schedule(static)
        for (int c = 0; c < RC_COMPONENTS; c++) {
            float *to = f->store + (t * RC_COMPONENTS + (size_t)c) * f->band * nx;
            for (size_t k = 0; k < n; k++)
                to[k] = (float)f->map[c][f->here.first * nx + k];
        }
    }
    return RC_OK;
}

/* ---- histories ---- */

/* Appends the unloaded state, and adds the residual stress, which depends on the line only. */
static void
finish_history(const struct rc_fatigue *f, struct rc_history *w, size_t n, size_t line)
{
    const struct here *here = &f->here;

    w->n = n + f->unloaded;
    for (int c = 0; c < RC_COMPONENTS; c++) {
        const double *r = here->residual == NULL ? NULL : here->residual[c];
        if (w->n > n)
            w->s[c][n] = c == RC_SXX || c == RC_SYY ? here->unloaded : 0;
        for (size_t t = 0; r != NULL && t < w->n; t++)
            w->s[c][t] += r[line];
    }
}

/* The states first, first + step, ... of a line of the map. */
static void
take_line(const struct rc_fatigue *f, struct rc_history *w, size_t line, size_t first, size_t step)
{
    const bool along_x = f->problem.pass == 'x';
    const size_t length = along_x ? f->shape.nx : f->shape.ny;
    const size_t start = along_x ? line * f->shape.nx : line;
    const size_t stride = along_x ? 1 : f->shape.nx;
    size_t n = 0;

    for (size_t t = first; t < length; t += step, n++)
        for (int c = 0; c < RC_COMPONENTS; c++)
            w->s[c][n] = f->map[c][start + t * stride];
    finish_history(f, w, n, line);
}

/* The same for the cases at a node of the body. */
static void
take_node(const struct rc_fatigue *f, struct rc_history *w, size_t row, size_t column, size_t first,
          size_t step)
{
    const struct rc_fatigue_problem *p = &f->problem;
    const size_t nx = f->shape.nx;
    size_t n = 0;

    for (size_t t = first; t < p->cases; t += step, n++) {
        const size_t shift = p->column == NULL ? 0 : p->column[t];
        const size_t i = p->stress.boundary.x ? (column + nx - shift % nx) % nx
                         : column >= shift    ? column - shift
                                              : nx;
        const float *from =
            f->store + (t * RC_COMPONENTS * f->band + row - f->here.first) * nx + (i < nx ? i : 0);
        for (size_t c = 0; c < RC_COMPONENTS; c++)
            w->s[c][n] = i < nx                       ? (double)from[c * f->band * nx]
                         : c == RC_SXX || c == RC_SYY ? f->here.unloaded
                                                      : 0;
    }
    finish_history(f, w, n, row);
}

static void
take(const struct rc_fatigue *f, struct rc_history *w, size_t point, size_t first, size_t step)
{
    if (f->problem.pass != 0)
        take_line(f, w, point, first, step);
    else
        take_node(f, w, point / f->result.nx, point % f->result.nx, first, step);
}

/* ---- the largest values ---- */

/* Largest distance of the contact between two states. */
static double
spacing(const struct rc_fatigue_problem *p, const struct rc_shape *shape)
{
    double most = 0;

    if (p->pass != 0)
        return p->pass == 'x' ? shape->dx : shape->dy;
    for (size_t t = 1; p->column != NULL && t < p->cases; t++)
        most = fmax(most, fabs((double)p->column[t] - (double)p->column[t - 1]));
    return most * shape->dx;
}

/* ---- between the samples ---- */

/* `n` samples along an axis. */
struct samples {
    size_t n;
    bool wraps;
};

/* Weights of the samples *first, *first + 1, ... in a polynomial through them at x; their number. */
static size_t
interpolate(const struct samples *s, double x, size_t *first, double weight[STENCIL])
{
    const size_t count = s->n < STENCIL ? s->n : STENCIL;
    const double middle = floor(x) - (double)((count - 1) / 2);
    const double low = s->wraps ? middle : fmax(0, fmin(middle, (double)(s->n - count)));

    *first = (size_t)(low < 0 ? low + (double)s->n : low);
    for (size_t k = 0; k < count; k++) {
        weight[k] = 1;
        for (size_t i = 0; i < count; i++)
            weight[k] *= i == k ? 1 : (x - low - (double)i) / ((double)k - (double)i);
    }
    return count;
}

/* Columns between two states of a history; 0: they differ, or the contact stays. */
static size_t
equal_steps(const struct rc_fatigue_problem *p)
{
    const size_t *c = p->column;

    if (p->pass != 0)
        return 1;
    for (size_t t = 2; c != NULL && t < p->cases; t++)
        if (c[t] + c[t - 2] != 2 * c[t - 1])
            return 0;
    return c == NULL || p->cases < 2 ? 0 : c[1] > c[0] ? c[1] - c[0] : c[0] - c[1];
}

/* The states that follow those of a history by `offset` < 1 of their distance. */
static void
take_between(const struct rc_fatigue *f, const struct rc_history *w, double offset,
             struct rc_history *to)
{
    const struct samples s = {w->n - f->unloaded, f->problem.pass != 0 && f->unloaded == 0};
    const double last = (double)s.n - 1 + (s.wraps ? offset : 0);

    to->n = 0;
    for (double x = offset; x <= last; x++, to->n++) {
        double weight[STENCIL];
        size_t first, count = interpolate(&s, x, &first, weight);
        for (int c = 0; c < RC_COMPONENTS; c++) {
            to->s[c][to->n] = 0;
            for (size_t k = 0; k < count; k++)
                to->s[c][to->n] += weight[k] * w->s[c][(first + k) % s.n];
        }
    }
    for (size_t t = s.n; t < w->n; t++, to->n++)
        for (int c = 0; c < RC_COMPONENTS; c++)
            to->s[c][to->n] = w->s[c][t];
}

static void
append(const struct rc_history *w, struct rc_history *to)
{
    for (int c = 0; c < RC_COMPONENTS; c++)
        memcpy(to->s[c] + to->n, w->s[c], w->n * sizeof *w->s[c]);
    to->n += w->n;
}

/* The value of a history that also has states between its own. *spread: that of the values of histories which
 * have one of these states in each distance; NULL: not needed. */
static double
value_between(struct rc_fatigue *f, const struct rc_fatigue_rule *rule, int c,
              const struct rc_history *w, double *spread)
{
    const bool has_between = equal_steps(&f->problem) > 0;
    struct rc_fatigue_values v;
    double least = INFINITY, most = -INFINITY;

    f->fine->n = 0;
    append(w, f->fine);
    for (int k = 1; k < PARTS && has_between; k++) {
        take_between(f, w, k / (double)PARTS, f->between);
        append(f->between, f->fine);
        if (spread == NULL)
            continue;
        rc_history_values(f->between, rule, &v);
        least = fmin(least, v.of[c]);
        most = fmax(most, v.of[c]);
    }
    rc_history_values(f->fine, rule, &v);
    if (spread != NULL)
        *spread = fmax(most, v.of[c]) - fmin(least, v.of[c]);
    return v.of[c];
}

/* The change by half of the states. */
static double
change_of_halves(struct rc_fatigue *f, const struct rc_fatigue_rule *rule, int c, size_t point)
{
    struct rc_fatigue_values v;
    double change = 0;

    for (size_t half = 0; half < 2 && f->states > 2; half++) {
        take(f, f->work[0], point, half, 2);
        rc_history_values(f->work[0], rule, &v);
        change = fmax(change, fabs(v.of[c] - f->value[c][point]));
    }
    return change * (spacing(&f->problem, &f->shape) > f->here.at / 2 * (1 + 1e-9)
                         ? caution_near
                         : caution_halves);
}

/* The results on an axis through one of them, which is the number `at`. Those of cases are of the band. */
struct line {
    struct samples samples;
    size_t first, stride, at;
};

static struct line
line_through(const struct rc_fatigue *f, size_t point, enum rc_map_axis axis)
{
    const struct rc_fatigue_problem *p = &f->problem;
    const size_t nx = f->result.nx, row = f->here.first;
    const enum rc_map_axis of_map = p->pass == 'x' ? RC_Y : axis;
    const bool wraps = rc_wraps(p->stress.boundary, of_map);

    if (axis == RC_X)
        return (struct line){{nx, wraps}, point - point % nx, 1, point % nx};
    if (p->pass != 0)
        return (struct line){{1, false}, point, 1, 0};
    return (struct line){{f->here.rows, wraps && f->here.rows == f->result.ny},
                         row * nx + point % nx,
                         nx,
                         point / nx - row};
}

static size_t
on_line(const struct line *line, size_t k)
{
    return line->first + k % line->samples.n * line->stride;
}

/* The history between the points of a line, `offset` distances beyond the present one. */
static void
take_beside(const struct rc_fatigue *f, const struct line *line, double offset,
            struct rc_history *to)
{
    struct rc_history *one = f->work[0];
    double weight[STENCIL];
    size_t first, count = interpolate(&line->samples, (double)line->at + offset, &first, weight);

    for (size_t k = 0; k < count; k++) {
        take(f, one, on_line(line, first + k), 0, 1);
        to->n = one->n;
        for (int c = 0; c < RC_COMPONENTS; c++)
            for (size_t t = 0; t < one->n; t++)
                to->s[c][t] = (k > 0 ? to->s[c][t] : 0) + weight[k] * one->s[c][t];
    }
}

/* The part of three values that waves longer than four distances do not have. */
static double
step_of(double a, double b, double c)
{
    return fmin(fabs(a - 2 * b + c), fmax(fabs(a - b), fabs(b - c)));
}

/* Pa: the stress below a load that no interpolation knows, at a point of the results. */
static double
unknown_stress(const struct rc_fatigue *f, const double *load, size_t point)
{
    const struct rc_boundary b = f->problem.stress.boundary;
    const bool columns = f->problem.pass == 'y';
    const size_t nx = f->shape.nx, ny = f->shape.ny, hop = equal_steps(&f->problem);
    const size_t at = f->problem.pass != 0 ? point : point / f->result.nx;
    const double z = f->here.at, coarse = fmax(f->shape.dx, f->shape.dy);
    double along_x = 0, along_y = 0, border = 0;

    for (size_t k = 0; k < nx * ny; k++) {
        const size_t i = k % nx, j = k / nx, line = columns ? i : j;
        const double *p = load + k;
        if (line + 1 < at || line > at + 1) /* beside the point at most */
            continue;
        if (hop > 0 && i >= hop && i + hop < nx)
            along_x = fmax(along_x, step_of(*(p - hop), *p, p[hop]));
        if (j > 0 && j + 1 < ny)
            along_y = fmax(along_y, step_of(*(p - nx), *p, p[nx]));
        if ((!b.x && nx > 1 && (i == 0 || i + 1 == nx)) ||
            (!b.y && ny > 1 && (j == 0 || j + 1 == ny)))
            border = fmax(border, fabs(*p));
    }
    along_x *= exp(-decay * z / (f->shape.dx * (double)(hop > 0 ? hop : 1)));
    along_y *= exp(-decay * z / f->shape.dy);
    return of_steps * fmax(along_x, along_y) + of_border * border * coarse / z;
}

/* The same of all loads of a history. */
static double
unknown_of_loads(const struct rc_fatigue *f, size_t point)
{
    const struct rc_fatigue_problem *p = &f->problem;
    double most = 0;

    for (size_t t = 0; t < p->cases; t++) {
        double sum = (1 + fabs(p->stress.mu)) * unknown_stress(f, p->p[t], point);
        for (int k = 0; k < 2; k++)
            if (p->traction[k] != NULL)
                sum += unknown_stress(f, p->traction[k][t], point);
        most = fmax(most, sum);
    }
    return most;
}

/* The largest value that may be near a point: between the states of its history, and between the points. */
static double
largest_near(struct rc_fatigue *f, const struct rc_fatigue_rule *rule, int c, size_t point)
{
    const double value = f->value[c][point], apart = spacing(&f->problem, &f->shape);
    const double scale = c < RC_CRITERIA ? (1 + fabs(rule->k[c])) / rule->limit[c] : 1;
    double spread = 0, most, low, high, more;

    take(f, f->work[0], point, 0, 1);
    low = high = value_between(f, rule, c, f->work[0], &spread);
    most = fabs(high - value);
    for (int axis = 0; axis < 2; axis++) {
        const struct line line = line_through(f, point, axis == 0 ? RC_X : RC_Y);
        for (int k = -PARTS / 2; k <= PARTS / 2 && line.samples.n > 1; k++) {
            double v;
            if (k == 0 ||
                (!line.samples.wraps && (k < 0 ? line.at == 0 : line.at + 1 == line.samples.n)))
                continue;
            take_beside(f, &line, k / (double)PARTS, f->beside);
            v = value_between(f, rule, c, f->beside, NULL);
            low = fmin(low, v);
            high = fmax(high, v);
        }
    }
    more = caution * (fmax(most, high - value) + of_time * spread + of_space * (high - low)) +
           scale * unknown_of_loads(f, point);
    if (equal_steps(&f->problem) == 0)
        more += change_of_halves(f, rule, c, point);
    /* nothing is known between states that are so far apart, or so few */
    if (apart > f->here.at * (1 + 1e-9) ||
        (f->problem.pass != 0 && f->unloaded > 0 && f->states < 4))
        more = fmax(more, fabs(value));
    return value + more;
}

/* True if no neighbour has a larger value; of equal ones it is the first. */
static bool
is_hill(const struct rc_fatigue *f, int c, size_t point)
{
    const double *v = f->value[c];

    for (int axis = 0; axis < 2; axis++) {
        const struct line line = line_through(f, point, axis == 0 ? RC_X : RC_Y);
        const size_t n = line.samples.n, at = line.at;
        if ((at > 0 || line.samples.wraps) && v[on_line(&line, at + n - 1)] > v[point])
            return false;
        if ((at + 1 < n || line.samples.wraps) && v[on_line(&line, at + 1)] > v[point])
            return false;
        if (at > 0 && v[on_line(&line, at - 1)] >= v[point])
            return false;
    }
    return !isnan(v[point]);
}

/* Keeps the points with the largest values of a depth. */
static void
keep_worst(struct rc_fatigue *f, const struct rc_fatigue_rule *rule, int c, size_t point)
{
    struct worst *worst = f->here.worst[c];
    const double value = f->value[c][point];
    struct rc_fatigue_rule only = *rule;
    size_t k = f->here.worsts[c], bound = k < WORST ? k : WORST - 1;
    double near;

    if (isnan(value) || (k == WORST && !(value > worst[WORST - 1].value)))
        return;
    only.wanted = c < RC_CRITERIA ? 1U << c : 0;
    near = largest_near(f, &only, c, point);
    for (k = bound; k > 0 && value > worst[k - 1].value; k--)
        worst[k] = worst[k - 1];
    worst[k] = (struct worst){value, near, point};
    f->here.worsts[c] = bound + 1;
}

/* The points of a band that may be among the largest, in their order: hills, because the values on their
 * slopes are not larger. */
static void
find_worst(struct rc_fatigue *f, const struct rc_fatigue_rule *rule, size_t from, size_t to)
{
    for (int c = 0; c <= RC_CRITERIA; c++) {
        const double *v = f->value[c];
        double least[WORST]; /* the largest values of the band, falling */
        size_t n = 0;
        if (!(f->problem.wanted >> c & 1))
            continue;
        for (size_t k = from; k < to; k++) {
            size_t i = n < WORST ? n : WORST - 1;
            if ((n == WORST && !(v[k] > least[WORST - 1])) || !is_hill(f, c, k))
                continue;
            for (; i > 0 && v[k] > least[i - 1]; i--)
                least[i] = least[i - 1];
            least[i] = v[k];
            n += n < WORST;
        }
        for (size_t k = from; k < to; k++)
            if (n > 0 && v[k] >= fmax(least[n - 1], least[0] - far * fabs(least[0])) &&
                is_hill(f, c, k))
                keep_worst(f, rule, c, k);
        /* what decides is asked again here, while the band is stored */
        if (f->here.worsts[c] > 0 && f->here.worst[c][0].at >= from &&
            f->here.worst[c][0].at < to && (c == RC_DANG_VAN || c == RC_FINDLEY)) {
            struct rc_fatigue_values decisive;
            take(f, f->work[0], f->here.worst[c][0].at, 0, 1);
            rc_history_values(f->work[0], rule, &decisive);
            if (c == RC_DANG_VAN) {
                f->depth.dangvan_hydrostatic = decisive.decides;
            } else {
                f->depth.plane_tilt = decisive.of[RC_PLANE_TILT];
                f->depth.plane_turn = decisive.of[RC_PLANE_TURN];
            }
        }
    }
}

static struct rc_fatigue_place
place_of(const struct rc_fatigue *f, const struct worst *worst, size_t n)
{
    const size_t nx = f->result.nx, point = worst[0].at;
    const double along = ((double)(point % nx) - (double)(nx - 1) / 2) * f->result.dx;
    struct rc_fatigue_place at = {worst[0].value, NAN, NAN, f->here.at, 0};
    double near = worst[0].near;

    for (size_t k = 1; k < n; k++)
        near = fmax(near, worst[k].near);
    at.sampling_error = (near - at.value) / fabs(at.value);
    if (f->problem.pass != 'x')
        at.x = along;
    if (f->problem.pass == 'x')
        at.y = along;
    else if (f->problem.pass == 0)
        at.y = ((double)(point / nx) - (double)(f->result.ny - 1) / 2) * f->result.dy;
    return at;
}

/* The figures of this depth join those of all depths. */
static void
gather_figures(struct rc_fatigue *f)
{
    struct rc_fatigue_figures *d = &f->depth, *all = &f->all;

    for (int c = 0; c <= RC_CRITERIA; c++) {
        if (f->here.worsts[c] > 0)
            d->largest[c] = place_of(f, f->here.worst[c], f->here.worsts[c]);
        if (f->here.worsts[c] > 0 && !(d->largest[c].value <= all->largest[c].value)) {
            all->largest[c] = d->largest[c];
            if (c == RC_DANG_VAN)
                all->dangvan_hydrostatic = d->dangvan_hydrostatic;
            if (c == RC_FINDLEY) {
                all->plane_tilt = d->plane_tilt;
                all->plane_turn = d->plane_turn;
            }
        }
    }
    for (int k = 0; k < 2; k++) {
        struct rc_fatigue_figures *to = k == 0 ? d : all;
        double index = NAN;
        to->sampling_error = NAN;
        for (int c = 0; c <= RC_CRITERIA; c++) {
            to->sampling_error = fmax(to->largest[c].sampling_error, to->sampling_error);
            if (c < RC_CRITERIA)
                index = fmax(to->largest[c].value, index);
        }
        to->safety = 1 / index;
    }
    all->least_hydrostatic = fmin(d->least_hydrostatic, all->least_hydrostatic);
    all->largest_hydrostatic = fmax(d->largest_hydrostatic, all->largest_hydrostatic);
    d->depths = 1;
    d->histories = f->result.nx * f->result.ny;
    d->bands = all->bands = (f->shape.ny + f->band - 1) / f->band;
    d->states = all->states = f->states;
    all->histories += d->histories;
    all->depths++;
}

/* Adds the last interval of depth to the stressed volume. */
static void
add_volume(struct rc_fatigue *f)
{
    const struct rc_fatigue_problem *p = &f->problem;
    const double *r = f->value[RC_AMPLITUDE];
    const double cell = p->pass != 0 ? f->result.dx : f->result.dx * f->result.dy;
    double sum = 0;

    if (!(p->power > 0))
        return;
    for (size_t k = 0; k < f->result.nx * f->result.ny; k++)
        if (r[k] > p->threshold)
            sum += pow((r[k] - p->threshold) / 1e9, p->power);
    f->integral = sum * cell * (p->depth_power == 0 ? 1 : pow(f->here.at, -p->depth_power));
    if (f->all.depths > 0)
        f->all.stressed_volume +=
            (f->integral + f->before) / 2 * fabs(f->here.at - f->depth_before);
    f->before = f->integral;
    f->depth_before = f->here.at;
}

/* ---- a depth ---- */

/* The values of the points of a band; *least and *largest: hydrostatic stress. */
static void
compute(struct rc_fatigue *f, const struct rc_fatigue_rule *rule, size_t from, size_t to)
{
    double low = INFINITY, high = -INFINITY;

#pragma omp parallel for num_threads(f->threads) schedule(dynamic) reduction(min                   \
                                                                             : low)                \
    reduction(max                                                                                  \
              : high)
    for (size_t first = from; first < to; first += TOGETHER) {
        struct rc_history *w = f->work[omp_get_thread_num()];
        for (size_t k = first; k < to && k < first + TOGETHER; k++) {
            struct rc_fatigue_values v;
            take(f, w, k, 0, 1);
            rc_history_values(w, rule, &v);
            for (int c = 0; c < RC_FATIGUES; c++)
                if (f->value[c] != NULL)
                    f->value[c][k] = v.of[c];
            low = v.least < low ? v.least : low;
            high = v.largest > high ? v.largest : high;
        }
    }
    f->depth.least_hydrostatic = fmin(low, f->depth.least_hydrostatic);
    f->depth.largest_hydrostatic = fmax(high, f->depth.largest_hydrostatic);
}

static enum rc_status
do_bands(struct rc_fatigue *f, const struct rc_fatigue_rule *rule, struct rc_err *err)
{
    for (f->here.first = 0; f->here.first < f->shape.ny; f->here.first += f->band) {
        size_t from = f->here.first * f->result.nx, to;
        f->here.rows =
            f->shape.ny - f->here.first < f->band ? f->shape.ny - f->here.first : f->band;
        to = from + f->here.rows * f->result.nx;
        if (f->problem.pass != 0) {
            if (slice_of(f, 0, err) != RC_OK)
                return RC_FAIL;
            to = f->result.nx;
        } else if (fill_band(f, err) != RC_OK) {
            return RC_FAIL;
        }
        compute(f, rule, from, to);
        find_worst(f, rule, from, to);
    }
    return RC_OK;
}

enum rc_status
rc_fatigue_depth(struct rc_fatigue *f, double depth, const struct rc_fatigue_limits *limits,
                 const double *const residual[RC_COMPONENTS], double *const out[RC_FATIGUES],
                 struct rc_err *err)
{
    const struct rc_fatigue_problem *p = &f->problem;
    const size_t points = f->result.nx * f->result.ny;
    struct rc_fatigue_rule rule;

    if (rc_fatigue_check_limits(p->wanted, limits, err) != RC_OK)
        return RC_FAIL;
    if (p->depth_power != 0 && p->power > 0 && !(depth > 0))
        return rc_err_set(err, "depth %g m: a power of the depth needs depths above 0", depth);
    rule = rc_fatigue_rule_of(p->wanted, p->full, limits);
    f->here.at = depth;
    f->here.residual = residual;
    f->here.unloaded = f->layer == NULL ? 0 : f->layer[rc_body_material(&p->stress.body, depth)];
    f->depth = none;
    memset(f->here.worsts, 0, sizeof f->here.worsts);
    if (do_bands(f, &rule, err) != RC_OK)
        return RC_FAIL;
    add_volume(f);
    gather_figures(f);
    for (int c = 0; c < RC_FATIGUES; c++)
        if (p->wanted >> c & 1 && out[c] != NULL)
            memcpy(out[c], f->value[c], points * sizeof *out[c]);
    return RC_OK;
}

#define PLACE(c, name, title, of_unit)                                                             \
    {RC_FIGURE_AS(name, struct rc_fatigue_figures, largest[c].value), of_unit, title},             \
        {RC_FIGURE_AS(name "_x", struct rc_fatigue_figures, largest[c].x), "m", "Its x"},          \
        {RC_FIGURE_AS(name "_y", struct rc_fatigue_figures, largest[c].y), "m", "Its y"},          \
        {RC_FIGURE_AS(name "_depth", struct rc_fatigue_figures, largest[c].depth), "m",            \
         "Its depth"},                                                                             \
    {                                                                                              \
        RC_FIGURE_AS(name "_error_estimate", struct rc_fatigue_figures,                            \
                     largest[c].sampling_error),                                                   \
            NULL, "Its error by the sampling", .role = RC_FIGURE_ERROR, .by = "grid", .of = name   \
    }
#define FIGURE(member) RC_FIGURE(struct rc_fatigue_figures, member)
const struct rc_figure rc_figures_fatigue[] = {
    PLACE(RC_CROSSLAND, "crossland", "Index of Crossland", NULL),
    PLACE(RC_DANG_VAN, "dangvan", "Index of Dang Van", NULL),
    PLACE(RC_PAPADOPOULOS, "papadopoulos", "Index of Papadopoulos", NULL),
    PLACE(RC_FINDLEY, "findley", "Index of Findley", NULL),
    PLACE(RC_SHAKEDOWN, "shakedown", "Index of shakedown", NULL),
    PLACE(RC_AMPLITUDE, "amplitude", "Amplitude sqrt(J2)", "Pa"),
    {FIGURE(safety), NULL, "Safety factor"},
    {RC_FIGURE_AS("sampling_error_estimate", struct rc_fatigue_figures, sampling_error), NULL,
     "Error by the sampling", .role = RC_FIGURE_ERROR, .by = "grid", .of = "safety"},
    {FIGURE(plane_tilt), "deg", "Angle of the plane's normal to z"},
    {FIGURE(plane_turn), "deg", "Angle of the plane's normal to x"},
    {FIGURE(dangvan_hydrostatic), "Pa", "Hydrostatic stress that decides for Dang Van"},
    {FIGURE(least_hydrostatic), "Pa", "Least hydrostatic stress"},
    {FIGURE(largest_hydrostatic), "Pa", "Largest hydrostatic stress"},
    {FIGURE(stressed_volume), NULL, "Stressed volume"},
    {FIGURE(depths), NULL, "Depths", .role = RC_FIGURE_COST},
    {FIGURE(histories), NULL, "Histories", .role = RC_FIGURE_COST},
    {FIGURE(states), NULL, "States of a history", .role = RC_FIGURE_COST},
    {FIGURE(bands), NULL, "Bands of rows", .role = RC_FIGURE_COST},
    {0},
};

const struct rc_fatigue_figures *
rc_fatigue_at_depth(const struct rc_fatigue *f)
{
    return &f->depth;
}

const struct rc_fatigue_figures *
rc_fatigue_result(const struct rc_fatigue *f)
{
    return &f->all;
}
