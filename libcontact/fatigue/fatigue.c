/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Stress histories of the points below a map, and the criteria of fatigue for them, depth by depth.
 *
 * A pass: the pressure travels with the contact, so each point of a row sees the stresses of the whole row,
 * and a map of stresses holds one history for each row. Cases: the contact is at other positions over the
 * same body, and the history of a node has one state for each case. At a depth the stresses of all cases are
 * stored in single precision, for a band of rows if memory is short; the next band computes them again.
 *
 * Lines are the rows of the map; of a pass along y they are its columns. Ranks share the lines. A band is
 * stored together with the three lines on each side that an interpolation beside its points needs, also those
 * of other ranks, so that results depend neither on bands nor on ranks.
 */
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "fatigue.h"
#include "libcontact/ranks/ranks.h"

enum {
    WORST = 8,           /* hills of a depth: near them the sampling error is measured */
    STENCIL = 6,         /* samples of an interpolation                                */
    REACH = STENCIL / 2, /* lines on each side that it needs */
    PARTS = 4,           /* of a distance between samples                              */
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
    double decides, tilt, turn; /* of the largest one: see struct rc_fatigue_values */
    size_t at;
};

/* Those of each criterion, from the largest one on. */
struct found {
    struct worst worst[RC_CRITERIA + 1][WORST];
    size_t n[RC_CRITERIA + 1];
};

/* Lines of the map; a line has `wide` results. */
struct lines {
    size_t all, unit, wide;
    size_t first, n; /* held here */
    bool wraps;
};

/* n lines from `first` on; the first line of the map follows the last one. */
struct window {
    size_t first, n;
};

/* The largest steps of a load between the nodes of a line, and the largest load on an edge of the map. */
struct step {
    double x, y, border;
};

/* The present depth. */
struct here {
    double at;
    const double *const *residual;
    double unloaded;      /* sxx and syy of a layer without load */
    struct window window; /* the lines that are stored */
    struct found found;
};

struct rc_fatigue {
    struct rc_store own; /* the arrays below */
    struct rc_fatigue_problem problem;
    struct rc_shape shape, result; /* of the map; of the results  */
    struct rc_rows rows;           /* of the map */
    struct lines lines;
    struct rc_stress *stress;
    size_t unloaded;            /* 1 if a history has the unloaded state, 0  */
    size_t states;              /* of one history, with the unloaded one     */
    size_t band, bands;         /* lines of a band; bands of each rank */
    size_t room;                /* lines for which `store` has room */
    double *map[RC_COMPONENTS]; /* of a pass on ranks: the window, line by line */
    float *store;               /* of cases: [case][component][row of the window][column] */
    double *spare;              /* on ranks: one component */
    double
        *value[RC_FATIGUES]; /* of the lines held here, of the line after them and of that before */
    size_t loads;            /* pressures and tractions of all cases */
    struct step *step;       /* [line][load]; of cases the lines are those of `value` */
    struct rc_history **work;                   /* of each thread */
    struct rc_history *beside, *between, *fine; /* of interpolations */
    int threads;
    double *layer; /* Pa: residual stress of each layer, and 0 of the body below; NULL: none */
    /* of each rank: its first line, its first row of the results, its window */
    size_t *from, *to, *low, *size;
    struct found *gathered; /* of each rank */
    struct rc_turn turn;    /* of a pass along y on ranks */
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

static struct lines
lines_of(const struct rc_shape *s, const struct rc_fatigue_problem *p)
{
    const bool columns = p->pass == 'y';
    const size_t count = rc_ranks_count(p->stress.ranks), own = rc_ranks_own(p->stress.ranks);
    struct lines l = {.all = columns ? s->nx : s->ny,
                      .unit = columns ? 1 : rc_rows_unit(s->nx),
                      .wide = p->pass != 0 ? 1 : rc_fatigue_shape(s, p).nx,
                      .wraps = rc_wraps(p->stress.boundary, columns ? RC_X : RC_Y)};

    l.first = rc_rows_dealt(l.all, l.unit, count, own);
    l.n = rc_rows_dealt(l.all, l.unit, count, own + 1) - l.first;
    return l;
}

static size_t
least_of(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Lines that a band of n lines needs, at most. */
static size_t
most_window(const struct lines *l, size_t n)
{
    return least_of(l->all, n + 2 * REACH);
}

static size_t
bytes_of_row(const struct rc_shape *s, const struct rc_fatigue_problem *p)
{
    return p->pass != 0 ? 0 : p->cases * RC_COMPONENTS * s->nx * sizeof(float);
}

/* The lines of a band that fit into the room here; all lines if those held here fit. */
static size_t
lines_of_band(const struct rc_shape *s, const struct rc_fatigue_problem *p)
{
    const struct lines l = lines_of(s, p);
    const size_t room = p->room == 0 ? SIZE_MAX : p->room, row = bytes_of_row(s, p);

    if (row == 0 || room / row >= most_window(&l, l.n))
        return l.all;
    return room / row > 2 * REACH ? room / row - 2 * REACH : 1;
}

/* Values of a component: its rows, and on ranks the window of a pass. */
static size_t
values_of_map(const struct rc_shape *s, const struct rc_fatigue_problem *p)
{
    const struct lines l = lines_of(s, p);
    const size_t held = s->nx * rc_rows_of(p->stress.ranks, s).n;
    const size_t line = p->pass == 'y' ? s->ny : s->nx, window = line * most_window(&l, l.n);

    return p->pass != 0 && rc_ranks_count(p->stress.ranks) > 1 && window > held ? window : held;
}

static size_t
loads_of(const struct rc_fatigue_problem *p)
{
    return p->cases * (1 + (size_t)(p->traction[0] != NULL) + (size_t)(p->traction[1] != NULL));
}

/* Lines of which the steps of the loads are kept: of a pass all of them, of cases those of the values. */
static size_t
lines_of_steps(const struct lines *l, const struct rc_fatigue_problem *p)
{
    return p->pass != 0 ? l->all : l->n + 2;
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

/* The values that are computed: the amplitude always is. */
static unsigned
computed(const struct rc_fatigue_problem *p)
{
    return p->wanted | 1U << RC_AMPLITUDE;
}

size_t
rc_fatigue_memory(const struct rc_shape *s, const struct rc_fatigue_problem *p)
{
    const struct lines l = lines_of(s, p);
    const size_t map = values_of_map(s, p);
    size_t maps = 0;

    for (int c = 0; c < RC_FATIGUES; c++)
        maps += computed(p) >> c & 1;
    return (RC_COMPONENTS + (rc_ranks_count(p->stress.ranks) > 1 ? 1U : 0)) * map * sizeof(double) +
           maps * (l.n + 2) * l.wide * sizeof(double) +
           lines_of_steps(&l, p) * loads_of(p) * sizeof(struct step) +
           most_window(&l, least_of(lines_of_band(s, p), l.n)) * bytes_of_row(s, p);
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
    if (p->stress.strain != NULL)
        return rc_err_set(err, "fatigue with plastic strain is not implemented");
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
    const size_t n = values_of_map(&f->shape, p), points = (f->lines.n + 2) * f->lines.wide;
    const size_t layers = p->stress.body.layers, ranks = rc_ranks_count(f->rows.ranks);

    for (int c = 0; c < RC_COMPONENTS; c++)
        f->map[c] = rc_store_take(&f->own, n, sizeof(double));
    for (int c = 0; c < RC_FATIGUES; c++)
        if (computed(p) >> c & 1)
            f->value[c] = rc_store_take(&f->own, points, sizeof(double));
    if (p->pass == 0)
        f->store = rc_store_take(&f->own, f->room * bytes_of_row(&f->shape, p), 1);
    if (f->rows.ranks != NULL)
        f->spare = rc_store_take(&f->own, n, sizeof(double));
    f->step = rc_store_zeros(&f->own, lines_of_steps(&f->lines, p) * f->loads, sizeof *f->step);
    f->from = rc_store_take(&f->own, 4 * (ranks + 1), sizeof *f->from);
    f->gathered = rc_store_take(&f->own, ranks, sizeof *f->gathered);
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
    return rc_ranks_need(f->rows.ranks, !f->own.failed, err,
                         "out of memory for histories of %zu states at %zu points", f->states,
                         f->result.nx * f->result.ny);
}

/* Where the ranks have their lines and rows. */
static void
deal(struct rc_fatigue *f)
{
    const size_t count = rc_ranks_count(f->rows.ranks);
    const size_t unit = f->problem.pass != 0 ? 1 : rc_rows_unit(f->result.nx);

    f->to = f->from + count + 1;
    f->low = f->to + count + 1;
    f->size = f->low + count + 1;
    for (size_t r = 0; r <= count; r++) {
        f->from[r] = rc_rows_dealt(f->lines.all, f->lines.unit, count, r);
        f->to[r] = rc_rows_dealt(f->result.ny, unit, count, r);
    }
}

/* The part of three values that waves longer than four distances do not have. */
static double
step_of(double a, double b, double c)
{
    return fmin(fabs(a - 2 * b + c), fmax(fabs(a - b), fabs(b - c)));
}

/* The steps of a load; before, after: its rows beside those held here. */
static void
find_steps(struct rc_fatigue *f, size_t number, const double *load, const double *before,
           const double *after)
{
    const struct rc_boundary b = f->problem.stress.boundary;
    const size_t nx = f->shape.nx, ny = f->shape.ny, hop = equal_steps(&f->problem);

    for (size_t k = 0; k < nx * f->rows.n; k++) {
        const size_t i = k % nx, row = k / nx, j = f->rows.first + row;
        const size_t line = f->problem.pass == 'y' ? i : f->problem.pass == 'x' ? j : row;
        const double *p = load + k;
        struct step *s = &f->step[line * f->loads + number];
        if (hop > 0 && i >= hop && i + hop < nx)
            s->x = fmax(s->x, step_of(*(p - hop), *p, p[hop]));
        if (j > 0 && j + 1 < ny)
            s->y = fmax(s->y, step_of(row > 0 ? *(p - nx) : before[i], *p,
                                      row + 1 < f->rows.n ? p[nx] : after[i]));
        if ((!b.x && nx > 1 && (i == 0 || i + 1 == nx)) ||
            (!b.y && ny > 1 && (j == 0 || j + 1 == ny)))
            s->border = fmax(s->border, fabs(*p));
    }
}

/* The same of all loads, also of the lines beside those held here. */
static enum rc_status
find_all_steps(struct rc_fatigue *f, struct rc_err *err)
{
    const struct rc_fatigue_problem *p = &f->problem;
    const struct rc_rows *rows = &f->rows;
    const size_t nx = f->shape.nx, line = f->loads * sizeof *f->step, n = f->lines.n;
    const double *const *all[] = {p->p, p->traction[0], p->traction[1]};
    double *beside = rows->ranks == NULL ? NULL : malloc(2 * nx * sizeof *beside);
    size_t number = 0;
    bool has[2];

    if (rc_ranks_need(rows->ranks, rows->ranks == NULL || beside != NULL, err,
                      "out of memory for rows of %zu nodes", nx) != RC_OK) {
        free(beside);
        return RC_FAIL;
    }
    for (size_t m = 0; m < 3; m++)
        for (size_t t = 0; t < p->cases && all[m] != NULL; t++, number++) {
            const double *v = all[m][t];
            if (beside != NULL)
                rc_ranks_beside(rows, false, nx * sizeof *v, v,
                                rows->n > 0 ? v + (rows->n - 1) * nx : v, beside, beside + nx, has);
            find_steps(f, number, v, beside, beside == NULL ? NULL : beside + nx);
        }
    free(beside);
    if (p->pass != 0)
        rc_ranks_each_most(rows->ranks, 3 * f->lines.all * f->loads, &f->step->x);
    else if (rows->ranks != NULL)
        rc_ranks_beside(rows, false, line, f->step, f->step + (n > 0 ? n - 1 : 0) * f->loads,
                        f->step + (n + 1) * f->loads, f->step + n * f->loads, has);
    return RC_OK;
}

struct rc_fatigue *
rc_fatigue_new(const struct rc_shape *shape, const struct rc_fatigue_problem *problem,
               struct rc_err *err)
{
    struct rc_stress_options o = problem->stress;
    RC_OWN(rc_fatigue, f) = NULL;

    if (rc_fatigue_check(shape, problem, err) != RC_OK)
        return NULL;
    f = calloc(1, sizeof *f);
    if (rc_ranks_need(o.ranks, f != NULL, err, "out of memory for a plan") != RC_OK)
        return NULL;
    f->problem = *problem;
    f->shape = *shape;
    f->result = rc_fatigue_shape(shape, problem);
    f->rows = rc_rows_of(o.ranks, shape);
    f->lines = lines_of(shape, problem);
    f->threads = rc_useful_threads(shape, o.threads);
    f->band = (size_t)-rc_ranks_most(f->rows.ranks, -(double)lines_of_band(shape, problem));
    f->bands = (size_t)rc_ranks_most(f->rows.ranks, (double)((f->lines.n + f->band - 1) / f->band));
    f->room = most_window(&f->lines, least_of(f->band, f->lines.n));
    f->loads = loads_of(problem);
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
    if (allocate(f, err) != RC_OK)
        return NULL;
    deal(f);
    if (problem->pass == 'y' && f->rows.ranks != NULL &&
        rc_ranks_agree(f->rows.ranks,
                       rc_turn_new(&f->turn, f->rows.ranks, shape->ny, rc_rows_unit(shape->nx), 0,
                                   shape->nx, sizeof(double), err),
                       err) != RC_OK)
        return NULL;
    if (find_all_steps(f, err) != RC_OK ||
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
    rc_turn_free(&f->turn);
    rc_store_free(&f->own);
    free(f);
}

/* ---- stresses ---- */

/* The stresses of a case in the rows held here. */
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

/* The lines that n of them from `first` on need. */
static struct window
window_of(const struct lines *l, size_t first, size_t n)
{
    size_t low, end;

    if (n == 0 || n + 2 * REACH >= l->all)
        return (struct window){0, n == 0 ? 0 : l->all};
    if (l->wraps)
        return (struct window){(first + l->all - REACH) % l->all, n + 2 * REACH};
    /* an interpolation near the edge of the map takes more lines of the other side */
    low = first < REACH ? 0 : least_of(first - REACH, l->all - STENCIL);
    end = least_of(l->all, first + n + REACH);
    return (struct window){low, (end < STENCIL ? STENCIL : end) - low};
}

/* The windows of a band: that of this rank, and those of all ranks. */
static void
set_window(struct rc_fatigue *f, size_t band)
{
    const size_t own = rc_ranks_own(f->rows.ranks);

    for (size_t r = 0; r < rc_ranks_count(f->rows.ranks); r++) {
        const size_t held = f->from[r + 1] - f->from[r], first = least_of(held, band * f->band);
        const struct window w =
            window_of(&f->lines, f->from[r] + first, least_of(f->band, held - first));
        f->low[r] = w.first;
        f->size[r] = w.n;
    }
    f->here.window = (struct window){f->low[own], f->size[own]};
}

/* The lines of the window, of `bytes` each, from those that each rank holds. */
static void
fetch(const struct rc_fatigue *f, size_t bytes, const void *held, void *window)
{
    const struct window *w = &f->here.window;

    if (f->rows.ranks != NULL) {
        rc_ranks_fetch(f->rows.ranks, bytes, f->from, f->low, f->size, held, window);
        return;
    }
    for (size_t k = 0; k < w->n; k++)
        memcpy((char *)window + k * bytes,
               (const char *)held + (w->first + k) % f->lines.all * bytes, bytes);
}

/* A component from rows to the columns held here, one after another in f->spare. */
static void
turn_to_columns(struct rc_fatigue *f, double *map)
{
    const size_t nx = f->shape.nx, ny = f->shape.ny, n = f->lines.n;

    for (size_t j = 0; j < f->rows.n; j++)
        rc_turn_put(&f->turn, j, map + j * nx, f->spare);
    rc_ranks_turn(&f->turn, false, f->spare, map);
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < n; i++)
            f->spare[i * ny + j] = map[j * n + i];
}

/* The stresses of a pass in the lines of the window. */
static enum rc_status
fill_lines(struct rc_fatigue *f, struct rc_err *err)
{
    if (slice_of(f, 0, err) != RC_OK)
        return RC_FAIL;
    for (int c = 0; c < RC_COMPONENTS && f->rows.ranks != NULL; c++) {
        double *map = f->map[c];
        if (f->problem.pass == 'y') {
            turn_to_columns(f, map);
            fetch(f, f->shape.ny * sizeof *map, f->spare, map);
        } else {
            fetch(f, f->shape.nx * sizeof *map, map, f->spare);
            f->map[c] = f->spare;
            f->spare = map;
        }
    }
    return RC_OK;
}

static void
to_single(const double *from, size_t n, float *to)
{
    for (size_t k = 0; k < n; k++)
        to[k] = (float)from[k];
}

/* The stresses of a case in the rows of the window. */
static void
store_case(struct rc_fatigue *f, size_t t)
{
    const size_t nx = f->shape.nx, n = f->room * nx;
    const struct window *w = &f->here.window;
    float *to = f->store + t * RC_COMPONENTS * n;

    if (f->rows.ranks != NULL) {
        for (int c = 0; c < RC_COMPONENTS; c++, to += n) {
            float *held = (float *)f->spare;
            to_single(f->map[c], f->rows.n * nx, held);
            fetch(f, nx * sizeof *held, held, to);
        }
        return;
    }
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (int c = 0; c < RC_COMPONENTS; c++)
        for (size_t k = 0; k < w->n; k++)
            to_single(f->map[c] + (w->first + k) % f->lines.all * nx, nx,
                      to + (size_t)c * n + k * nx);
}

static enum rc_status
fill_band(struct rc_fatigue *f, struct rc_err *err)
{
    if (f->problem.pass != 0)
        return fill_lines(f, err);
    for (size_t t = 0; t < f->problem.cases; t++) {
        if (slice_of(f, t, err) != RC_OK)
            return RC_FAIL;
        store_case(f, t);
    }
    return RC_OK;
}

/* ---- histories ---- */

/* Where a line is in the window. */
static size_t
in_window(const struct rc_fatigue *f, size_t line)
{
    return (line + f->lines.all - f->here.window.first) % f->lines.all;
}

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
    const bool along_x = f->problem.pass == 'x', whole = along_x || f->rows.ranks != NULL;
    const size_t length = along_x ? f->shape.nx : f->shape.ny;
    const size_t start = in_window(f, line) * (whole ? length : 1);
    const size_t stride = whole ? 1 : f->shape.nx;
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
            f->store + (t * RC_COMPONENTS * f->room + in_window(f, row)) * nx + (i < nx ? i : 0);
        for (size_t c = 0; c < RC_COMPONENTS; c++)
            w->s[c][n] = i < nx                       ? (double)from[c * f->room * nx]
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
        take_node(f, w, point / f->lines.wide, point % f->lines.wide, first, step);
}

/* The value of a point of the lines held here, or of those beside them. */
static double *
value_at(const struct rc_fatigue *f, int c, size_t point)
{
    const struct lines *l = &f->lines;
    const size_t line = (point / l->wide + l->all - l->first) % l->all;

    return f->value[c] + (line <= l->n ? line : l->n + 1) * l->wide + point % l->wide;
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
        change = fmax(change, fabs(v.of[c] - *value_at(f, c, point)));
    }
    return change * (spacing(&f->problem, &f->shape) > f->here.at / 2 * (1 + 1e-9)
                         ? caution_near
                         : caution_halves);
}

/* The results on an axis through one of them, which is the number `at`. */
struct line {
    struct samples samples;
    size_t first, stride, at;
};

static struct line
line_through(const struct rc_fatigue *f, size_t point, enum rc_map_axis axis)
{
    const struct rc_fatigue_problem *p = &f->problem;
    const struct lines *l = &f->lines;
    const size_t nx = l->wide;

    if (p->pass != 0)
        return axis == RC_X ? (struct line){{l->all, l->wraps}, 0, 1, point}
                            : (struct line){{1, false}, point, 1, 0};
    if (axis == RC_X)
        return (struct line){
            {nx, rc_wraps(p->stress.boundary, RC_X)}, point - point % nx, 1, point % nx};
    return (struct line){{l->all, l->wraps}, point % nx, nx, point / nx};
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

/* Pa: the stress below a load that no interpolation knows, at a point of the results. */
static double
unknown_stress(const struct rc_fatigue *f, size_t load, size_t point)
{
    const struct lines *l = &f->lines;
    const size_t hop = equal_steps(&f->problem), at = point / l->wide;
    const double z = f->here.at, coarse = fmax(f->shape.dx, f->shape.dy);
    struct step most = {0, 0, 0};

    for (size_t line = at > 0 ? at - 1 : 0; line <= at + 1 && line < l->all; line++) {
        const size_t near = (line + l->all - l->first) % l->all;
        const size_t held = f->problem.pass != 0 ? line : near <= l->n ? near : l->n + 1;
        const struct step *s = &f->step[held * f->loads + load];
        most.x = fmax(most.x, s->x);
        most.y = fmax(most.y, s->y);
        most.border = fmax(most.border, s->border);
    }
    most.x *= exp(-decay * z / (f->shape.dx * (double)(hop > 0 ? hop : 1)));
    most.y *= exp(-decay * z / f->shape.dy);
    return of_steps * fmax(most.x, most.y) + of_border * most.border * coarse / z;
}

/* The same of all loads of a history. */
static double
unknown_of_loads(const struct rc_fatigue *f, size_t point)
{
    const struct rc_fatigue_problem *p = &f->problem;
    double most = 0;

    for (size_t t = 0; t < p->cases; t++) {
        double sum = (1 + fabs(p->stress.mu)) * unknown_stress(f, t, point);
        for (size_t load = p->cases + t; load < f->loads; load += p->cases)
            sum += unknown_stress(f, load, point);
        most = fmax(most, sum);
    }
    return most;
}

/* The largest value that may be near a point: between the states of its history, and between the point and
 * the next ones. At a kink of the values the largest one may lie nearer to a next point with a lower value.
 * How much the values vary is taken from the nearer half of the way. */
static double
largest_near(struct rc_fatigue *f, const struct rc_fatigue_rule *rule, int c, size_t point)
{
    const double value = *value_at(f, c, point), apart = spacing(&f->problem, &f->shape);
    const double scale = c < RC_CRITERIA ? (1 + fabs(rule->k[c])) / rule->limit[c] : 1;
    double spread = 0, most, low, high, more;

    take(f, f->work[0], point, 0, 1);
    low = high = value_between(f, rule, c, f->work[0], &spread);
    most = fabs(high - value);
    for (int axis = 0; axis < 2; axis++) {
        const struct line line = line_through(f, point, axis == 0 ? RC_X : RC_Y);
        for (int k = 1 - PARTS; k < PARTS && line.samples.n > 1; k++) {
            double v;
            if (k == 0 ||
                (!line.samples.wraps && (k < 0 ? line.at == 0 : line.at + 1 == line.samples.n)))
                continue;
            take_beside(f, &line, k / (double)PARTS, f->beside);
            v = value_between(f, rule, c, f->beside, NULL);
            if (2 * abs(k) <= PARTS)
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
    const double value = *value_at(f, c, point);

    for (int axis = 0; axis < 2; axis++) {
        const struct line line = line_through(f, point, axis == 0 ? RC_X : RC_Y);
        const size_t n = line.samples.n, at = line.at;
        if ((at > 0 || line.samples.wraps) && *value_at(f, c, on_line(&line, at + n - 1)) > value)
            return false;
        if ((at + 1 < n || line.samples.wraps) && *value_at(f, c, on_line(&line, at + 1)) > value)
            return false;
        if (at > 0 && *value_at(f, c, on_line(&line, at - 1)) >= value)
            return false;
    }
    return !isnan(value);
}

static bool
is_among(const struct found *found, int c, double value)
{
    return found->n[c] < WORST || value > found->worst[c][WORST - 1].value;
}

static void
keep(struct found *found, int c, const struct worst *new)
{
    struct worst *worst = found->worst[c];
    size_t k = least_of(found->n[c], WORST - 1);

    if (!is_among(found, c, new->value))
        return;
    found->n[c] = k + 1;
    for (; k > 0 && new->value > worst[k - 1].value; k--)
        worst[k] = worst[k - 1];
    worst[k] = *new;
}

/* Keeps the points with the largest values of a depth. */
static void
keep_worst(struct rc_fatigue *f, const struct rc_fatigue_rule *rule, int c, size_t point)
{
    struct found *found = &f->here.found;
    struct worst new = {.value = *value_at(f, c, point), .at = point};
    struct rc_fatigue_rule only = *rule;
    struct rc_fatigue_values decisive;

    if (isnan(new.value) || !is_among(found, c, new.value))
        return;
    only.wanted = c < RC_CRITERIA ? 1U << c : 0;
    new.near = largest_near(f, &only, c, point);
    /* what decides is found here, while the band is stored */
    if ((c == RC_DANG_VAN || c == RC_FINDLEY) &&
        (found->n[c] == 0 || new.value > found->worst[c][0].value)) {
        take(f, f->work[0], point, 0, 1);
        rc_history_values(f->work[0], rule, &decisive);
        new.decides = decisive.decides;
        new.tilt = decisive.of[RC_PLANE_TILT];
        new.turn = decisive.of[RC_PLANE_TURN];
    }
    keep(found, c, &new);
}

/* The points of n lines held here that may be among the largest, in their order: hills, because the values
 * on their slopes are not larger. */
static void
find_worst(struct rc_fatigue *f, const struct rc_fatigue_rule *rule, size_t line, size_t n)
{
    const size_t from = line * f->lines.wide, to = from + n * f->lines.wide;

    for (int c = 0; c <= RC_CRITERIA; c++) {
        double least[WORST]; /* the largest values of the band, falling */
        size_t kept = 0;
        if (!(f->problem.wanted >> c & 1))
            continue;
        for (size_t k = from; k < to; k++) {
            const double v = *value_at(f, c, k);
            size_t i = kept < WORST ? kept : WORST - 1;
            if ((kept == WORST && !(v > least[WORST - 1])) || !is_hill(f, c, k))
                continue;
            for (; i > 0 && v > least[i - 1]; i--)
                least[i] = least[i - 1];
            least[i] = v;
            kept += kept < WORST;
        }
        for (size_t k = from; k < to; k++)
            if (kept > 0 &&
                *value_at(f, c, k) >= fmax(least[kept - 1], least[0] - far * fabs(least[0])) &&
                is_hill(f, c, k))
                keep_worst(f, rule, c, k);
    }
}

/* The largest values of all ranks and bands, without those much lower than the largest one. */
static void
gather_worst(struct rc_fatigue *f)
{
    struct found *found = &f->here.found;

    rc_ranks_gather(f->rows.ranks, sizeof *found, found, f->gathered);
    memset(found->n, 0, sizeof found->n);
    for (size_t r = 0; r < rc_ranks_count(f->rows.ranks); r++)
        for (int c = 0; c <= RC_CRITERIA; c++)
            for (size_t k = 0; k < f->gathered[r].n[c]; k++)
                keep(found, c, &f->gathered[r].worst[c][k]);
    for (int c = 0; c <= RC_CRITERIA; c++) {
        const struct worst *worst = found->worst[c];
        while (found->n[c] > 1 &&
               worst[found->n[c] - 1].value < worst[0].value - far * fabs(worst[0].value))
            found->n[c]--;
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

    gather_worst(f);
    for (int c = 0; c <= RC_CRITERIA; c++) {
        const struct worst *worst = f->here.found.worst[c];
        if (f->here.found.n[c] == 0)
            continue;
        d->largest[c] = place_of(f, worst, f->here.found.n[c]);
        if (c == RC_DANG_VAN)
            d->dangvan_hydrostatic = worst->decides;
        if (c == RC_FINDLEY) {
            d->plane_tilt = worst->tilt;
            d->plane_turn = worst->turn;
        }
        if (!(d->largest[c].value <= all->largest[c].value)) {
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
    d->least_hydrostatic = -rc_ranks_most(
        f->rows.ranks, isnan(d->least_hydrostatic) ? -INFINITY : -d->least_hydrostatic);
    d->largest_hydrostatic = rc_ranks_most(
        f->rows.ranks, isnan(d->largest_hydrostatic) ? -INFINITY : d->largest_hydrostatic);
    all->least_hydrostatic = fmin(d->least_hydrostatic, all->least_hydrostatic);
    all->largest_hydrostatic = fmax(d->largest_hydrostatic, all->largest_hydrostatic);
    d->depths = 1;
    d->histories = f->result.nx * f->result.ny;
    d->bands = all->bands = f->bands;
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
    struct rc_total sum = {0, 0};

    if (!(p->power > 0))
        return;
    for (size_t k = 0; k < f->lines.n * f->lines.wide; k++)
        if (r[k] > p->threshold)
            rc_total_add(&sum, pow((r[k] - p->threshold) / 1e9, p->power));
    f->integral = rc_ranks_total(f->rows.ranks, sum) * cell *
                  (p->depth_power == 0 ? 1 : pow(f->here.at, -p->depth_power));
    if (f->all.depths > 0)
        f->all.stressed_volume +=
            (f->integral + f->before) / 2 * fabs(f->here.at - f->depth_before);
    f->before = f->integral;
    f->depth_before = f->here.at;
}

/* ---- a depth ---- */

/* The values of the points of n lines. */
static void
compute(struct rc_fatigue *f, const struct rc_fatigue_rule *rule, size_t line, size_t n)
{
    const size_t wide = f->lines.wide, all = n * wide;
    double low = INFINITY, high = -INFINITY;

#pragma omp parallel for num_threads(f->threads) schedule(dynamic) reduction(min                   \
                                                                             : low)                \
    reduction(max                                                                                  \
              : high)
    for (size_t first = 0; first < all; first += TOGETHER) {
        struct rc_history *w = f->work[omp_get_thread_num()];
        for (size_t k = first; k < all && k < first + TOGETHER; k++) {
            const size_t point = line * wide + k;
            struct rc_fatigue_values v;
            take(f, w, point, 0, 1);
            rc_history_values(w, rule, &v);
            for (int c = 0; c < RC_FATIGUES; c++)
                if (f->value[c] != NULL)
                    *value_at(f, c, point) = v.of[c];
            low = v.least < low ? v.least : low;
            high = v.largest > high ? v.largest : high;
        }
    }
    if (n > 0) {
        f->depth.least_hydrostatic = fmin(low, f->depth.least_hydrostatic);
        f->depth.largest_hydrostatic = fmax(high, f->depth.largest_hydrostatic);
    }
}

/* The same, and those of the lines beside them: whether a point is a hill depends on them. */
static void
compute_band(struct rc_fatigue *f, const struct rc_fatigue_rule *rule, size_t line, size_t n)
{
    const struct lines *l = &f->lines;

    compute(f, rule, line, n);
    if (n == 0 || n == l->all)
        return;
    if (line == l->first && (line > 0 || l->wraps))
        compute(f, rule, (line + l->all - 1) % l->all, 1);
    if (line + n < l->all || l->wraps)
        compute(f, rule, (line + n) % l->all, 1);
}

static enum rc_status
do_bands(struct rc_fatigue *f, const struct rc_fatigue_rule *rule, struct rc_err *err)
{
    for (size_t band = 0; band < f->bands; band++) {
        const size_t first = least_of(f->lines.n, band * f->band), line = f->lines.first + first;
        const size_t n = least_of(f->band, f->lines.n - first);
        set_window(f, band);
        if (fill_band(f, err) != RC_OK)
            return RC_FAIL;
        compute_band(f, rule, line, n);
        find_worst(f, rule, line, n);
    }
    return RC_OK;
}

/* The results of a depth: of cases the rows of the result held here, of a pass all points. */
static void
give(const struct rc_fatigue *f, int c, double *out)
{
    const struct lines *l = &f->lines;

    if (f->rows.ranks == NULL) {
        memcpy(out, f->value[c], l->n * l->wide * sizeof *out);
    } else if (f->problem.pass == 0) {
        rc_ranks_move(f->rows.ranks, l->wide * sizeof *out, f->from, f->to, 0, f->value[c], out);
    } else {
        for (size_t r = 0; r < rc_ranks_count(f->rows.ranks); r++) {
            f->low[r] = 0;
            f->size[r] = l->all;
        }
        rc_ranks_fetch(f->rows.ranks, sizeof *out, f->from, f->low, f->size, f->value[c], out);
    }
}

enum rc_status
rc_fatigue_depth(struct rc_fatigue *f, double depth, const struct rc_fatigue_limits *limits,
                 const double *const residual[RC_COMPONENTS], double *const out[RC_FATIGUES],
                 struct rc_err *err)
{
    const struct rc_fatigue_problem *p = &f->problem;
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
    memset(&f->here.found, 0, sizeof f->here.found);
    if (do_bands(f, &rule, err) != RC_OK)
        return RC_FAIL;
    add_volume(f);
    gather_figures(f);
    for (int c = 0; c < RC_FATIGUES; c++)
        if (p->wanted >> c & 1 && out[c] != NULL)
            give(f, c, out[c]);
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
