/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Bodies that attract each other, along a path. Each state starts from the gap of the last state and descends
 * to a stationary point (gap.c). Then the smallest eigenvalue shows whether this point is stable under the
 * present control (stability.c). The iteration leaves a saddle along its eigenvector. A small residual does
 * not suffice, because it is also small at a saddle. The error of the pressure is about e/sqrt(mu), where e
 * is the change by the next correction and mu the smallest eigenvalue. The preconditioner underestimates the
 * response of soft modes. Where nodes yield, the error stays in their dents, and later states add theirs.
 *
 * A retraction goes from state to state until the bodies have separated. Then it repeats the interval from
 * the state before the lowest load to the state after it in smaller steps.
 */
#include "adhesion.h"

#include <stdlib.h>
#include <string.h>

#include "libcontact/expected.h"
#include "libcontact/memory.h"

/* ---- laws ---- */

static const struct rc_adhesion_law *const laws[] = {
#define RC_ADHESION_LAW(name) &rc_adhesion_##name,
#include "laws.list"
#undef RC_ADHESION_LAW
};

enum {
    LAWS = sizeof laws / sizeof *laws
};

const struct rc_adhesion_law_info *
rc_adhesion_law_info(size_t k)
{
    return k < LAWS ? &laws[k]->info : NULL;
}

static const char *
law_name(const void *of, size_t k)
{
    (void)of;
    return k < LAWS ? laws[k]->info.name : NULL;
}

const struct rc_adhesion_law *
rc_adhesion_law_named(const char *name)
{
    for (size_t k = 0; k < LAWS; k++)
        if (name == NULL || strcmp(laws[k]->info.name, name) == 0)
            return laws[k];
    return NULL;
}

/* ---- a path ---- */

enum {
    /* Successive steps that lower the eigenvalue by less than 2 %. Not sensitive: half and double
     * change the convolutions by less than 1 % (27 runs of bench/constants.py). */
    SLOW = 2,
    /* Successive states with an error below tol. One state may be below it by chance: with half the
     * convolutions are 10 % fewer, and the error up to 24 times as large. Double takes 26 % more (27
     * runs of bench/constants.py). */
    BELOW = 2,
    /* Most saddles of a state. Not sensitive: half and double change no bit (27 runs of
     * bench/constants.py). */
    LEAVES = 20,
    /* Most parts of a way. Not sensitive: half and double change no bit (27 runs of
     * bench/constants.py). */
    PARTS = 40,
    /* Most turns with frozen attraction. Not sensitive: half and double change no bit (27 runs of
     * bench/constants.py). */
    TURNS = 16,
    /* Nodes along a map; a smaller coarse grid does not pay. Not sensitive: half and double take 1 %
     * fewer convolutions (27 runs of bench/constants.py). */
    COARSEST = 32,
    /* Most steps of an eigenvalue. Not sensitive: half and double change no bit (27 runs of
     * bench/constants.py). */
    EIGEN_STEPS = 40
};
/* Nodes in the cohesive length if the grid determines the range: with fewer the grid pins the contact,
 * see contact-theory(7). It is a choice of the problem, not of its solution. Twice as many where whole
 * lines of nodes may separate at once: there the pull-off load of a cylinder is 2 % too large with 2
 * nodes, 0.3 % with 4. */
static const double nodes_default = 2;
/* Accepted relative error of the eigenvalue, which decides about stability and the estimate only. Half
 * takes 1 % more convolutions, double 1 % fewer (27 runs of bench/constants.py). */
static const double eigen_exact = 0.2;
/* Largest tol: with a larger error the eigenvalue has no meaning. At 1e-2 a state was taken for a
 * saddle and left, with 148 convolutions in place of 57 at 1e-4. */
static const double loosest = 1e-3;
/* The error is at most 2 e/sqrt(mu). If soft modes have most of it, the bound is 1.25 e/mu. It is not
 * used below `soft`, because soft modes never have all of the error. Most errors are near e: a ratio is
 * measured by the change of the pressure while e halves. The softest mode may hide from it, and is
 * found apart. Half of `safe` takes 3 % fewer convolutions, with errors up to 4 times as large; double
 * takes 6 % more (27 runs of bench/constants.py). Half of the other two changes no convolution; double
 * takes up to 2 % more. On first states 1.5 told .91 of an error in one of 62. */
static const double safe = 2, safe_soft = 1.25, soft = 0.05;
/* The least ratio of error to e. Half changes no convolution, double takes 0.4 % more (27 runs of
 * bench/constants.py). */
static const double least_ratio = 1.25;
/* Fraction of tol, because the errors of dents stay and those of later states add up. Not sensitive:
 * half and double change the convolutions by less than 1 % (27 runs of bench/constants.py). */
static const double yielding_part = 0.05;
/* Correction of the state on a coarser grid, relative. Not sensitive: half and double change the
 * convolutions by less than 1 % (27 runs of bench/constants.py). */
static const double coarse_tol = 1e-3;
/* Relative error of an eigenvalue in single precision, some 30 roundings of 1.2e-7. Half and double
 * change no bit (27 runs of bench/constants.py). */
static const double single = 4e-6;
/* Relative rounding of an energy in single precision. Half and double change no bit (27 runs of
 * bench/constants.py). */
static const double energy_rounding = 1e-6;
/* Part of the loss that a way without jumps cannot exceed, above which the part is divided. Half
 * divides one of 27 runs more, double changes no bit (bench/constants.py). */
static const double unclear = 0.4;
/* Over the range: the longest part where the load reverses. Half takes 8 % more convolutions, with
 * errors down to 0.8 times. Double takes 0.5 % fewer (27 runs of bench/constants.py). */
static const double most_way = 0.4;
/* Relative variation of the load from node to node. Not sensitive: half and double change no bit (27
 * runs of bench/constants.py). */
static const double force_noise = 0.003;
/* Shortest part that is divided because of its loss, over the way. */
static const double finest = 0.1;
/* An error from which the iteration ends at the nearest state. Not sensitive: half changes one of 27
 * runs by 2 %, double none (bench/constants.py). */
static const double near = 0.1;
/* Part of the error at the begin of a turn. Not sensitive: half and double change the convolutions by
 * less than 1 % (27 runs of bench/constants.py). */
static const double turned = 0.1;

enum stage {
    STAGE_NEW,
    STAGE_COARSE,
    STAGE_DOWN,
    STAGE_EIGEN,
    STAGE_DONE
};

/* The way from the last state to the next one. Long ways are divided. */
struct way {
    bool steady;                /* the present gap and pressure are a state */
    bool known;                 /* the way begins at such a state */
    struct rc_gap_energy start; /* of that state, under the present control */
    double to;                  /* this part ends here, on the way to `given` */
    double whole;               /* length of the way */
    size_t parts;
    bool reverses; /* with a given mean gap: the load has fallen while the bodies approached */
    size_t turns;  /* with frozen attraction */
    double turn;   /* the error at the begin of a turn; 0: not yet known */
    size_t iterations, eigen_steps;
    double convolutions; /* those of the parts before */
};

struct retraction {
    bool on;
    struct rc_retraction search;
    double *kept[RC_RETRACTION_KEPT]; /* gaps on the whole grid */
    struct rc_adhesion_state found;   /* figures of the lowest state */
    size_t iterations, eigen_steps, jumps;
    double convolutions;
    double start; /* the shift of the first state */
    bool short_of;
};

/* Rows of the map are dealt to ranks as the caller holds them, rows of the grid as they are transformed. Each
 * array has the first row of the map on each rank, and the number of all rows. */
struct dealt {
    size_t *given; /* as rows of the map; NULL: no ranks */
    size_t *held;  /* as rows of the grid */
    size_t *finer; /* as every other row of the finer map, with the rows of its grid */
    bool moves;    /* given and held differ */
};

/* Coarser grids, for the start of the first state. */
struct grids {
    struct rc_adhesion_solver *coarse; /* the next one; NULL: none */
    size_t lent;                       /* bytes of all */
    bool rough;                        /* this path is on such a grid */
};

struct asked {
    double tol;
    size_t max_iterations;
    enum rc_gap_control control;
    double given;
    bool held; /* a gap is held, but no control is set yet */
};

/* The stability and the error of the present state. */
struct stability {
    bool first;      /* the state continues no path */
    size_t below;    /* successive steps with an error below tol */
    size_t leaves;   /* saddles left */
    double mu[3];    /* eigenvalue of the last state of each control; 0: none */
    double softness; /* the lowest stiffness along a descent, close to its end */
    double judged;   /* the error when the eigenvalue was found; 0: not found yet */
    double hidden;   /* then the error along the softest mode, times mu */
};

struct rc_adhesion_solver {
    struct rc_shape shape; /* the whole map */
    struct rc_rows rows;   /* of the caller's maps */
    struct dealt dealt;
    struct grids grids;
    struct rc_whole *whole;
    struct rc_gap gap;
    struct rc_adhesion_scales scales;
    double *h;     /* heights over the length, minus the largest one; with the rows of the grid */
    double mean_h; /* their mean                                                       */
    struct asked asked;
    enum stage stage;
    struct stability stability;
    struct way way;
    struct rc_adhesion_solver_past past;
    size_t jumps;
    bool converged;
    bool separated;
    bool stays; /* they separated earlier, and the present load does not press them together */
    bool fresh; /* the figures belong to the present state */
    struct rc_adhesion_state figures;
    struct retraction pull;
};

/* ---- problem ---- */

static enum rc_status
refuse(const struct rc_shape *shape, const struct rc_adhesion_problem *problem, struct rc_err *err)
{
    const struct rc_problem *c = &problem->contact;
    double side = fmax(shape->dx * (double)shape->nx, shape->dy * (double)shape->ny);
    const struct rc_adhesion_law *law = rc_adhesion_law_named(problem->law);

    if (!(problem->work > 0) || isinf(problem->work))
        return rc_err_set(err, "work of adhesion %g J/m2: it must be positive and finite",
                          problem->work);
    if (law == NULL) {
        rc_err_set(err, "there is no law of adhesion '%s'", problem->law);
        return rc_err_choices(err, law_name, NULL);
    }
    if (!(problem->range >= 0) || isinf(problem->range))
        return rc_err_set(err, "range of adhesion %g m: it must be positive and finite",
                          problem->range);
    if (problem->range > 0 && !law->info.ranged)
        return rc_err_set(
            err, "the law '%s' takes its range from the grid: give no range, or another law",
            law->info.name);
    if (problem->range > side)
        return rc_err_set(
            err, "range of adhesion %g m: it must be below the longer side of the map, %g m",
            problem->range, side);
    if (c->tilt_free)
        return rc_err_set(err, "with adhesion the counter body cannot tilt");
    if (!(c->hardness >= 0))
        return rc_err_set(err, "hardness %g Pa: it must be positive", c->hardness);
    if (!(c->tol >= 0))
        return rc_err_set(err, "tolerance %g: it must be positive", c->tol);
    return RC_OK;
}

static enum rc_status
refuse_ways(const struct rc_problem *c, struct rc_err *err)
{
    if (c->engine != NULL && strcmp(c->engine, "auto") != 0) {
        const struct rc_engine *engine = rc_engine_named(c->engine, NULL);
        if (engine == NULL)
            return rc_engine_absent(c->engine, err);
        if (!engine->transforms)
            return rc_err_set(err,
                              "contact with adhesion needs the inverse of K, which engine '%s' "
                              "does not have: take engine 'fft'",
                              c->engine);
    }
    if (c->method != NULL && strcmp(c->method, "auto") != 0 && strcmp(c->method, "gap") != 0)
        return rc_err_set(err,
                          "method '%s' does not support adhesion: contact with adhesion uses 'gap'",
                          c->method);
    return RC_OK;
}

static enum rc_status
attraction_of(const struct rc_shape *shape, const struct rc_adhesion_problem *problem,
              struct rc_attraction *law, struct rc_adhesion_scales *scales, struct rc_err *err)
{
    double length = sqrt(shape->dx) * sqrt(shape->dy), modulus = 0, diagonal = 0,
           node = fmax(shape->dx, shape->dy) / length, nodes = nodes_default;

    if (rc_shape_check(shape, err) != RC_OK ||
        rc_pair_check(&problem->contact.pair, err) != RC_OK ||
        refuse(shape, problem, err) != RC_OK || refuse_ways(&problem->contact, err) != RC_OK ||
        rc_whole_scales(shape, &problem->contact.pair, &modulus, &diagonal, err) != RC_OK)
        return RC_FAIL;
    if (rc_repeats(problem->contact.boundary) == 1)
        nodes *= 2;
    *law = (struct rc_attraction){.law = rc_adhesion_law_named(problem->law),
                                  .work = problem->work / modulus / length};
    law->range = problem->range > 0 ? problem->range / length
                                    : law->law->range(law->work, nodes * node, diagonal);
    law->law->set(law, diagonal);
    if (!(law->strength > 0) || isinf(law->steepest) || !(law->steepest > 0))
        return rc_err_set(err,
                          "work of adhesion %g J/m2 over a range of %g m: too large or too small "
                          "for a computer, with E* %g Pa and a spacing of %g m",
                          problem->work, law->range * length, modulus, length);
    if (law->spread > 0 && law->steepest * diagonal >= 1)
        return rc_err_set(err,
                          "the law '%s' over %g m falls to 0 within a node of this grid: take a "
                          "spacing of at most %g m, or a range of at least %g m",
                          law->law->info.name, law->range * length,
                          0.5 * length / (law->steepest * diagonal),
                          law->law->range(law->work, nodes * node, diagonal) * length);
    *scales = (struct rc_adhesion_scales){
        .law = law->law->info.name,
        .range = law->range * length,
        .strength = law->strength * modulus,
        .steepest = law->steepest * modulus / length,
        .cohesive_length = length / law->steepest,
        .cohesive_nodes = 1 / (law->steepest * node),
    };
    return RC_OK;
}

enum rc_status
rc_adhesion_check(const struct rc_shape *shape, const struct rc_adhesion_problem *problem,
                  struct rc_adhesion_scales *scales, struct rc_err *err)
{
    struct rc_attraction law;

    return attraction_of(shape, problem, &law, scales, err);
}

enum rc_status
rc_adhesion_attraction(const struct rc_shape *shape, const struct rc_adhesion_problem *problem,
                       const double *gap, double *sigma, struct rc_err *err)
{
    struct rc_adhesion_scales scales;
    struct rc_attraction law;
    double unused[2];

    if (attraction_of(shape, problem, &law, &scales, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < shape->nx * shape->ny; k++) {
        const double g = gap[k] * law.range / scales.range;
        law.law->at(&law, 1, &g, &unused[0], &sigma[k], &unused[1]);
        sigma[k] *= scales.strength / law.strength;
    }
    return RC_OK;
}

/* ---- rows of the map and of the grid ---- */

/* `of`: the map or the grid, by whose rows those of the map are dealt; `halved`: every other row. */
static void
set_starts(const struct rc_ranks *ranks, const struct rc_shape *of, size_t ny, bool halved,
           size_t *starts)
{
    const size_t count = rc_ranks_count(ranks), unit = rc_rows_unit(of->nx);

    for (size_t r = 0; r <= count; r++) {
        const size_t dealt = rc_rows_dealt(of->ny, unit, count, r), first = dealt < ny ? dealt : ny;
        starts[r] = halved ? (first + 1) / 2 : first;
    }
}

static enum rc_status
deal(struct rc_adhesion_solver *a, struct rc_err *err)
{
    const struct rc_ranks *ranks = a->rows.ranks;
    const size_t each = rc_ranks_count(ranks) + 1;
    struct dealt *d = &a->dealt;

    if (ranks == NULL)
        return RC_OK;
    d->given = malloc(3 * each * sizeof *d->given);
    if (rc_ranks_need(ranks, d->given != NULL, err, "out of memory for the rows of %zu processes",
                      each - 1) != RC_OK)
        return RC_FAIL;
    d->held = d->given + each;
    d->finer = d->held + each;
    set_starts(ranks, &a->shape, a->shape.ny, false, d->given);
    set_starts(ranks, &a->whole->grid, a->shape.ny, false, d->held);
    d->moves = memcmp(d->given, d->held, each * sizeof *d->given) != 0;
    return RC_OK;
}

/* Moves a map of the caller to the rows of the grid. */
static void
take_map(const struct rc_adhesion_solver *a, const double *map, double *to)
{
    const size_t bytes = a->shape.nx * sizeof *to;

    if (a->dealt.moves)
        rc_ranks_move(a->rows.ranks, bytes, a->dealt.given, a->dealt.held, 0, map, to);
    else
        memcpy(to, map, a->rows.n * bytes);
}

/* Memory for a map that give_map then moves to the rows of the caller. */
static double *
map_for(const struct rc_adhesion_solver *a, double *to)
{
    return a->dealt.moves ? a->gap.maps.step : to;
}

static void
give_map(const struct rc_adhesion_solver *a, double *to)
{
    if (a->dealt.moves)
        rc_ranks_move(a->rows.ranks, a->shape.nx * sizeof *to, a->dealt.held, a->dealt.given, 0,
                      a->gap.maps.step, to);
}

/* A node of the caller's rows as one of the whole map, for messages. */
static size_t
node_of(const struct rc_rows *rows, const struct rc_shape *shape, size_t k)
{
    return rows->first * shape->nx + k;
}

static enum rc_status
check_heights(const struct rc_adhesion_solver *a, const double *h, struct rc_err *err)
{
    enum rc_status status = RC_OK;

    for (size_t k = 0; k < a->rows.n * a->shape.nx && status == RC_OK; k++)
        if (!isfinite(h[k]))
            status = rc_err_set(err, "height %zu is not a finite number",
                                node_of(&a->rows, &a->shape, k));
    return rc_ranks_agree(a->rows.ranks, status, err);
}

static void
find_mean(struct rc_adhesion_solver *a)
{
    a->mean_h = rc_ranks_sum_of(a->rows.ranks, a->h, a->shape.nx * a->gap.problem.on_map) /
                (double)(a->shape.nx * a->shape.ny);
}

/* Takes the heights h, which include the dents (NULL: none); approaches count from first touch without
 * dents. */
static void
take_heights(struct rc_adhesion_solver *a, const double *h, const double *dent)
{
    double top = -INFINITY;

    for (size_t k = 0; k < a->rows.n * a->shape.nx; k++)
        top = fmax(top, dent != NULL ? h[k] - dent[k] : h[k]);
    top = rc_ranks_most(a->rows.ranks, top);
    take_map(a, h, a->h);
    for (size_t k = 0; k < a->gap.problem.on_map * a->shape.nx; k++)
        a->h[k] = (a->h[k] - top) / a->whole->length;
    find_mean(a);
}

/* n: nodes of the map in the rows of the grid held here. */
static enum rc_status
take_hardness(const struct rc_adhesion_solver *a, const struct rc_problem *c, size_t n,
              double *hard, double **hards, struct rc_err *err)
{
    enum rc_status status = RC_OK;

    *hard = c->hardness > 0 ? c->hardness / a->whole->modulus : INFINITY;
    *hards = NULL;
    if (c->hardness_map == NULL)
        return RC_OK;
    if ((*hards = rc_alloc(n, sizeof **hards)) == NULL)
        status = rc_err_set(err, "out of memory for the hardness of %zu nodes", n);
    for (size_t k = 0; k < a->rows.n * a->shape.nx && status == RC_OK; k++) {
        const double is = c->hardness_map[k];
        if (!(is > 0) && !isnan(is))
            status = rc_err_set(err, "hardness %g Pa of node %zu: it must be positive", is,
                                node_of(&a->rows, &a->shape, k));
    }
    if (rc_ranks_agree(a->rows.ranks, status, err) != RC_OK) {
        free(*hards);
        *hards = NULL;
        return RC_FAIL;
    }
    take_map(a, c->hardness_map, *hards);
    for (size_t k = 0; k < n; k++)
        (*hards)[k] = isnan((*hards)[k]) ? INFINITY : (*hards)[k] / a->whole->modulus;
    return RC_OK;
}

static void
free_coarse(struct grids *grids)
{
    rc_adhesion_solver_free(grids->coarse);
    rc_memory_return(grids->lent);
    grids->coarse = NULL;
    grids->lent = 0;
}

void
rc_adhesion_solver_free(struct rc_adhesion_solver *a)
{
    if (a == NULL)
        return;
    free_coarse(&a->grids);
    rc_gap_free(&a->gap);
    rc_whole_free(a->whole);
    for (size_t k = 0; k < RC_RETRACTION_KEPT; k++)
        free(a->pull.kept[k]);
    free(a->dealt.given);
    free(a->h);
    free(a);
}

/* Memory for heights, and the hardness. */
static enum rc_status
take_maps(struct rc_adhesion_solver *a, const struct rc_problem *c, struct rc_err *err)
{
    struct rc_gap_problem *p = &a->gap.problem;

    p->h = a->h = rc_alloc(a->shape.nx * p->on_map, sizeof *a->h);
    if (rc_ranks_need(a->rows.ranks, a->h != NULL, err,
                      "out of memory for the adhesion of %zu x %zu nodes", a->shape.nx,
                      a->shape.ny) != RC_OK ||
        take_hardness(a, c, a->shape.nx * p->on_map, &p->hard, &p->hards, err) != RC_OK)
        return RC_FAIL;
    p->yields = p->hards != NULL || !isinf(p->hard);
    return RC_OK;
}

/* A path without heights. */
static struct rc_adhesion_solver *
path_new(const struct rc_shape *shape, const struct rc_adhesion_problem *problem,
         struct rc_err *err)
{
    const struct rc_problem *c = &problem->contact;
    const struct rc_operator_options options = {
        .boundary = c->boundary, .pair = &c->pair, .threads = c->threads, .ranks = c->ranks};
    struct rc_adhesion_scales scales;
    struct rc_attraction law;
    struct rc_adhesion_solver *a;
    double nodes = (double)shape->nx * (double)shape->ny;

    if (attraction_of(shape, problem, &law, &scales, err) != RC_OK)
        return NULL;
    a = calloc(1, sizeof *a);
    if (rc_ranks_need(c->ranks, a != NULL, err, "out of memory for the adhesion of %zu x %zu nodes",
                      shape->nx, shape->ny) != RC_OK) {
        free(a);
        return NULL;
    }
    a->shape = *shape;
    a->rows = rc_rows_of(c->ranks, shape);
    a->scales = scales;
    a->asked.tol = fmin(loosest, c->tol > 0 ? c->tol : pow(nodes, -0.75));
    a->asked.max_iterations =
        c->max_iterations > 0 ? c->max_iterations : 100 + (size_t)(10 * sqrt(nodes));
    if ((a->whole = rc_whole_new(shape, &options, err)) == NULL ||
        rc_gap_new(&a->gap, a->whole, &law, err) != RC_OK || deal(a, err) != RC_OK ||
        take_maps(a, c, err) != RC_OK) {
        rc_adhesion_solver_free(a);
        return NULL;
    }
    return a;
}

/* ---- a start from coarser grids ---- */

/* Every other node of the first `rows` rows of a map nx wide, times a factor. */
static void
sample(size_t nx, size_t rows, const double *v, double factor, double *to)
{
    for (size_t j = 0; j < rows; j += 2)
        for (size_t i = 0; i < nx; i += 2)
            *to++ = factor * v[j * nx + i];
}

/* The hardness of the coarser map, for path_new. NULL if memory is short on a rank. */
static double *
coarse_hardness(const struct rc_adhesion_solver *fine, const struct rc_shape *shape,
                const double *map)
{
    const struct rc_ranks *ranks = fine->rows.ranks;
    const size_t each = rc_ranks_count(ranks) + 1, rows = rc_rows_of(ranks, shape).n;
    RC_OWNED size_t *starts = malloc(2 * each * sizeof *starts);
    RC_OWNED double *under = rc_alloc((fine->rows.n + 1) / 2 * shape->nx, sizeof *under);
    RC_OWNED double *own = rc_alloc(rows * shape->nx, sizeof *own);
    const bool has = starts != NULL && under != NULL && own != NULL;

    if (rc_ranks_agree(ranks, has ? RC_OK : RC_FAIL, NULL) != RC_OK)
        return NULL;
    sample(fine->shape.nx, fine->rows.n, map, 1, under);
    if (ranks == NULL)
        return rc_give(&under);
    set_starts(ranks, &fine->shape, fine->shape.ny, true, starts);
    set_starts(ranks, shape, shape->ny, false, starts + each);
    rc_ranks_move(ranks, shape->nx * sizeof *own, starts, starts + each, 0, under, own);
    return rc_give(&own);
}

/* The law on a coarser grid: the same work, and a range that the grid resolves. */
static double
coarse_range(const struct rc_attraction *fine_law, const struct rc_adhesion_scales *scales,
             const struct rc_adhesion_problem *p, const struct rc_shape *shape)
{
    const double length = sqrt(shape->dx) * sqrt(shape->dy);
    const struct rc_adhesion_law *law = fine_law->law;
    double modulus, diagonal, least;

    if (rc_whole_scales(shape, &p->contact.pair, &modulus, &diagonal, NULL) != RC_OK)
        return NAN;
    least = law->range(p->work / modulus / length, fmax(shape->dx, shape->dy) / length, diagonal);
    return fmax(scales->range, least * length);
}

/* The path on the coarser grid. NULL if this grid does not pay, or memory is short: the start is then from
 * undeformed bodies. */
static struct rc_adhesion_solver *
coarse_new(const struct rc_adhesion_solver *fine, const struct rc_adhesion_problem *problem)
{
    const struct rc_shape *f = &fine->shape, shape = rc_shape_coarser(f);
    struct rc_adhesion_problem p = *problem;
    struct rc_adhesion_solver *a;
    double *hards = NULL;

    if ((f->nx > 1 && shape.nx < COARSEST) || (f->ny > 1 && shape.ny < COARSEST) ||
        shape.nx * shape.ny < COARSEST)
        return NULL;
    p.range = coarse_range(&fine->gap.problem.law, &fine->scales, problem, &shape);
    if (!fine->gap.problem.law.law->info.ranged) /* the first law, with a range of its own */
        p.law = NULL;
    if (p.contact.hardness_map != NULL) {
        if ((hards = coarse_hardness(fine, &shape, p.contact.hardness_map)) == NULL)
            return NULL;
        p.contact.hardness_map = hards;
    }
    a = path_new(&shape, &p, NULL);
    if (a != NULL) {
        if (a->dealt.finer != NULL)
            set_starts(a->rows.ranks, &fine->whole->grid, fine->shape.ny, true, a->dealt.finer);
        a->grids.rough = true;
        a->grids.coarse = coarse_new(a, &p);
    }
    free(hards);
    return a;
}

struct rc_adhesion_solver *
rc_adhesion_solver_new(const struct rc_shape *shape, const double *h,
                       const struct rc_adhesion_problem *problem, struct rc_err *err)
{
    struct rc_adhesion_solver *a = path_new(shape, problem, err);

    if (a == NULL)
        return NULL;
    if (check_heights(a, h, err) != RC_OK) {
        rc_adhesion_solver_free(a);
        return NULL;
    }
    take_heights(a, h, NULL);
    rc_gap_apart(&a->gap, 0);
    rc_memory_lend();
    a->grids.coarse = coarse_new(a, problem);
    a->grids.lent = rc_memory_lent();
    return a;
}

/* ---- a state ---- */

static void
set(struct rc_adhesion_solver *a, enum rc_gap_control control, double given)
{
    a->asked.control = control;
    a->asked.given = given;
    a->jumps = 0;
    a->way = (struct way){.steady = a->way.steady};
    a->converged = a->separated = a->fresh = false;
    a->stays = a->past.separated && control == RC_GAP_LOAD && given <= 0;
    a->stage = STAGE_NEW;
    a->asked.held = true;
}

/* The largest load that has a state. A node at its hardness carries the hardness minus the traction at gap 0.
 * If this is negative, the traction pulls the node into contact, and while open it carries nothing. */
static double
most_load(const struct rc_adhesion_solver *a)
{
    const struct rc_gap_problem *p = &a->gap.problem;
    struct rc_total sum = {0};

    for (size_t k = 0; k < a->shape.nx * p->on_map; k++)
        rc_total_add(&sum, fmax((p->hards != NULL ? p->hards[k] : p->hard) - p->law.strength, 0));
    return rc_ranks_total(a->rows.ranks, sum) * a->whole->modulus * a->shape.dx * a->shape.dy;
}

enum rc_status
rc_adhesion_solver_set_load(struct rc_adhesion_solver *a, double load, struct rc_err *err)
{
    double cell = a->shape.dx * a->shape.dy, most = a->gap.problem.yields ? most_load(a) : INFINITY;

    if (!isfinite(load))
        return rc_err_set(err, "load %g N: it must be finite", load);
    if (load > 0 && load >= most)
        return rc_err_set(
            err,
            "load %.9g N: with every node at its hardness and with the traction at gap 0, %.9g Pa, "
            "the map carries only %.9g N: lower the load or raise the hardness",
            load, a->scales.strength, most);
    a->pull.on = false;
    set(a, RC_GAP_LOAD, load / cell / a->whole->modulus / (double)a->gap.problem.all);
    return RC_OK;
}

/* The shift for an approach, over the length. */
static void
set_shift(struct rc_adhesion_solver *a, double c)
{
    if (rc_has_mean(a->whole->boundary))
        set(a, RC_GAP_SHIFT, c);
    else
        set(a, RC_GAP_MEAN, -c - a->mean_h);
}

enum rc_status
rc_adhesion_solver_set_approach(struct rc_adhesion_solver *a, double approach, struct rc_err *err)
{
    double c = approach / a->whole->length;

    if (!isfinite(approach))
        return rc_err_set(err, "approach %g m: it must be finite", approach);
    if (!rc_has_mean(a->whole->boundary) && !(-c - a->mean_h > 0))
        return rc_err_set(err,
                          "approach %g m: on a periodic map it must be below %g m, where the mean "
                          "gap would be 0",
                          approach, -a->mean_h * a->whole->length);
    a->pull.on = false;
    set_shift(a, c);
    return RC_OK;
}

/* The smallest known eigenvalue. Its iteration may have found another mode than the softest one; the
 * stiffness along the descent then gives a lower value. */
static double
softest(const struct rc_gap_mode *mode, const struct stability *stability)
{
    return fmin(mode->mu, stability->softness);
}

static double
own_error(const struct rc_gap *g, const struct stability *stability, enum rc_gap_control control)
{
    const struct rc_gap_told *t = &g->told;
    double mu = stability->judged > 0 ? softest(&g->mode, stability) : stability->mu[control],
           worst, measured;
    const bool known = mu != 0 || !stability->first;

    if ((stability->judged > 0 && isinf(stability->hidden)) || !isfinite(t->error) ||
        !isfinite(t->size))
        return INFINITY;
    mu = mu == 0 ? 1 : fmin(fmax(mu, single), 1);
    worst = fmax(safe / sqrt(mu), safe_soft / fmax(mu, soft)) * t->error;
    measured = safe * (fmax(fmax(t->ratios[0], t->ratios[1]), least_ratio) * t->calm +
                       (stability->judged > 0 ? stability->hidden / mu : 0));
    return !known ? measured : fmin(stability->judged > 0 ? 2 * worst : worst, measured);
}

/* The possible error from dents of earlier states, relative to the pressures of this state. */
static double
inherited_error(const struct rc_gap_told *told, const struct rc_adhesion_solver_past *past)
{
    return told->size > 0 ? fmax(past->dents[0], past->dents[1] / told->size) : past->dents[0];
}

static double
estimate(const struct rc_adhesion_solver *a)
{
    return own_error(&a->gap, &a->stability, a->asked.control) +
           inherited_error(&a->gap.told, &a->past);
}

static bool
ends(const struct rc_adhesion_solver *a)
{
    return a->gap.told.vanishes || own_error(&a->gap, &a->stability, a->asked.control) <=
                                       (a->gap.problem.yields ? yielding_part : 1) * a->asked.tol;
}

/* Poses the first state on the coarser grid. */
static void
begin_coarse(struct rc_adhesion_solver *a)
{
    struct rc_adhesion_solver *c = a->grids.coarse;
    const double ratio = a->whole->length / c->whole->length;
    const double units =
        a->asked.control != RC_GAP_LOAD
            ? ratio
            : a->whole->modulus * (double)a->gap.problem.all * a->shape.dx * a->shape.dy /
                  (c->whole->modulus * (double)c->gap.problem.all * c->shape.dx * c->shape.dy);
    double *to = c->dealt.finer != NULL ? a->gap.maps.step : c->h;

    sample(a->shape.nx, a->gap.problem.on_map, a->h, ratio, to);
    if (c->dealt.finer != NULL)
        rc_ranks_move(c->rows.ranks, c->shape.nx * sizeof *to, c->dealt.finer, c->dealt.held, 0, to,
                      c->h);
    find_mean(c);
    rc_gap_apart(&c->gap, 0);
    set(c, a->asked.control, units * a->asked.given);
    a->stage = STAGE_COARSE;
}

/* Under a load the iteration moves the bodies as a whole, past barriers of the energy. With a frozen
 * attraction Phi has one minimum, and its gap lies between the start and the nearest state, if A has no
 * positive entries outside its diagonal. */
static bool
freezes(enum rc_gap_control control, const struct way *way, bool pulls)
{
    return way->known && !pulls && control == RC_GAP_LOAD && way->to != way->start.given;
}

/* Starts a part of the way, which ends at way.to. */
static void
begin_part(struct rc_adhesion_solver *a)
{
    a->stability.first = !a->past.begun;
    a->stability.below = a->stability.leaves = 0;
    a->stability.judged = 0;
    a->stability.softness = INFINITY;
    a->way.turns = 0;
    a->way.turn = 0;
    rc_gap_begin(&a->gap, a->asked.control, a->way.to, a->stability.first);
    if (freezes(a->asked.control, &a->way, a->pull.on))
        rc_gap_freeze(&a->gap, true);
    a->gap.run.convolutions += a->way.convolutions;
    a->stage = STAGE_DOWN;
}

/* Notes the state at which the next part begins. */
static void
begin_at(struct rc_adhesion_solver *a, double to)
{
    a->way.to = to;
    a->way.known = a->way.steady;
    if (a->way.known) {
        a->way.start = rc_gap_energy(&a->gap, a->asked.control);
        rc_gap_keep(&a->gap);
        if (a->way.parts == 0)
            a->way.whole = fabs(a->asked.given - a->way.start.given);
    }
    begin_part(a);
}

static void
begin(struct rc_adhesion_solver *a)
{
    begin_at(a, a->asked.given);
}

/* ---- a flat punch with the area of the contact ---- */

struct punch {
    double stiffness, least; /* `least`: of the smallest contact */
    double crack;            /* part of the force that opens a crack around the contact */
};

/* True if the contact is closed along the axis that repeats: it touches each line across that axis. */
static bool
is_strip(const struct rc_adhesion_solver *a)
{
    const struct rc_gap_problem *p = &a->gap.problem;
    const struct rc_boundary boundary = a->whole->boundary;
    const size_t lines = boundary.x ? p->nx : p->on_map, along = boundary.x ? p->on_map : p->nx;
    const struct rc_ranks *ranks = p->rows.ranks;
    double open = 0, *touched = boundary.x ? a->gap.maps.beside : NULL;

    if (rc_repeats(boundary) != 1)
        return false;
    for (size_t j = 0, i = 0; j < lines; j++, i = 0) {
        while (i < along && a->gap.maps.x[boundary.x ? i * p->px + j : j * p->px + i] > 0)
            i++;
        if (touched != NULL) /* a line has nodes on several ranks */
            touched[j] = i < along;
        else if (i == along)
            open = 1;
    }
    if (touched != NULL)
        rc_ranks_each_most(ranks, lines, touched);
    for (size_t j = 0; j < lines && touched != NULL; j++)
        open = touched[j] > 0 ? open : 1;
    return rc_ranks_most(ranks, open) == 0;
}

/* A circle of this radius, over the length, or a strip of the same area along the axis that repeats. In the
 * limit of short ranges the lowest load of a sphere is a quarter of sqrt(8 pi E* w a^3), a at load 0, and
 * that of a cylinder 0.47 of sqrt(2 pi E* w a), per length. */
static struct punch
punch_of(const struct rc_adhesion_solver *a, double radius)
{
    const double work = a->gap.problem.law.work, length = a->whole->length;
    const bool along_x = a->whole->boundary.x;
    const double period =
        (along_x ? a->shape.dx * (double)a->shape.nx : a->shape.dy * (double)a->shape.ny) / length;
    const double half = RC_PI * radius * radius / (2 * period);

    if (!is_strip(a))
        return (struct punch){2 * radius, 2, sqrt(8 * RC_PI * work * radius * radius * radius) / 4};
    return (struct punch){.stiffness = RC_PI / 2 * period /
                                       log(2 * a->whole->boundary.datum / length / half),
                          .crack = 0.47 * period * sqrt(2 * RC_PI * work * half)};
}

/* ---- a way ---- */

/* The energy that this part of the way has lost. On a path without jumps, Phi changes by the integral of its
 * `force`; the trapezoid rule gives it. *most: the loss that this rule cannot exclude there. Under a load the
 * force falls as the load rises, and the bound is strict. With a given approach the load may have a minimum
 * on the way, with the stiffness of a flat punch on one side, and varies from node to node. */
static double
loss(struct rc_adhesion_solver *a, double *most)
{
    const struct rc_gap_energy *from = &a->way.start, to = rc_gap_energy(&a->gap, a->asked.control);
    const double part = a->way.to - from->given, change = to.force - from->force;
    const double forces = fabs(part) * fmax(from->force_scale, to.force_scale);

    a->way.reverses = a->asked.control == RC_GAP_MEAN && change * part < 0;
    *most = fabs(part * change) / 2;
    if (a->asked.control != RC_GAP_LOAD)
        *most +=
            punch_of(a, sqrt(fmax(from->contact, to.contact) / RC_PI)).stiffness / 2 * part * part +
            force_noise * forces;
    return from->phi - to.phi + part * (from->force + to.force) / 2 - a->asked.tol * forces -
           (energy_rounding + a->asked.tol * a->asked.tol) * fmax(from->phi_scale, to.phi_scale);
}

static void
spend(const struct rc_gap *g, struct way *way)
{
    way->iterations += g->run.iterations;
    way->eigen_steps += g->mode.steps;
    way->convolutions = g->run.convolutions;
    way->parts++;
}

/* Repeats half of this part, from its start, or less if half is longer than `longest`. */
static enum rc_status
divide(struct rc_adhesion_solver *a, double longest)
{
    double part = (a->way.to - a->way.start.given) / 2;

    while (fabs(part) > longest)
        part /= 2;
    spend(&a->gap, &a->way);
    rc_gap_return(&a->gap, a->asked.control, a->way.start.given);
    a->way.to = a->way.start.given + part;
    begin_part(a);
    return RC_MORE;
}

/* The next part, twice as long as this one if the way is so long. */
static enum rc_status
go_further(struct rc_adhesion_solver *a)
{
    double part = a->way.to - a->way.start.given, left = a->asked.given - a->way.to;

    part *= a->way.reverses && a->way.parts < PARTS ? 1 : 2;
    spend(&a->gap, &a->way);
    begin_at(a, a->converged && fabs(part) < fabs(left) ? a->way.to + part : a->asked.given);
    return RC_MORE;
}

/* The state of separated bodies: undeformed, so far apart that the attraction is negligible. Its pressure is
 * 0, where the iteration ended with one that belongs to no state. */
static void
lay_apart(struct rc_adhesion_solver *a)
{
    struct rc_gap *g = &a->gap;
    const double clearance = RC_GAP_PARTED * g->problem.law.range,
                 convolutions = g->run.convolutions;
    const size_t iterations = g->run.iterations, eigen_steps = g->mode.steps;
    const bool mean = rc_has_mean(a->whole->boundary);

    rc_gap_apart(g, clearance);
    rc_gap_begin(g, g->set.control, mean ? -clearance : clearance - a->mean_h, false);
    g->run.convolutions = convolutions;
    g->run.iterations = iterations;
    g->mode.steps = eigen_steps;
    memset(g->maps.au, 0, g->problem.n * sizeof *g->maps.au); /* without rounding */
    a->stability.judged = 0;
    a->separated = a->past.separated = true;
    a->way.steady = false;
    a->stage = STAGE_DONE;
}

/* Separated bodies stay apart until a load presses them together. Under a tensile load they have no stable
 * state, because the attraction falls with the gap. */
static enum rc_status
stay_apart(struct rc_adhesion_solver *a)
{
    lay_apart(a);
    a->gap.run.iterations = a->gap.mode.steps = 0;
    a->gap.run.convolutions = 0;
    a->converged = a->asked.given == 0;
    return a->converged ? RC_OK : RC_SHORT;
}

/* Ends a part of the way. It has a jump if it has lost more energy than a path without jumps can lose; if it
 * has lost less, but not much less, halves of it decide. */
static enum rc_status
finish(struct rc_adhesion_solver *a, bool converged)
{
    const double part = fabs(a->way.to - a->way.start.given),
                 longest = most_way * a->gap.problem.law.range;

    a->stage = STAGE_DONE;
    a->gap.frozen.on = false;
    a->converged = a->way.steady = converged;
    a->past.separated = a->separated;
    if (a->separated) {
        a->jumps += a->past.begun;
        lay_apart(a);
    } else if (a->way.known && converged) {
        double most, lost = loss(a, &most);
        bool divides = a->way.parts < PARTS && !a->pull.on;
        if (divides && a->way.reverses && part > longest)
            return divide(a, longest);
        if (divides && part > finest * a->way.whole && lost > unclear * most && lost <= most)
            return divide(a, INFINITY);
        a->jumps += lost > most;
    }
    a->past.begun = true;
    a->stability.mu[a->asked.control] =
        a->stability.judged > 0 ? fmax(softest(&a->gap.mode, &a->stability), single) : 0;
    if (a->way.known && a->way.to != a->asked.given && !a->separated)
        return go_further(a);
    return converged ? RC_OK : RC_SHORT;
}

/* Convolutions for the state, in equivalents on this grid. */
static double
convolutions(const struct rc_adhesion_solver *a)
{
    return a->stage != STAGE_COARSE
               ? a->gap.run.convolutions
               : convolutions(a->grids.coarse) * (double)a->grids.coarse->gap.problem.all /
                     (double)a->gap.problem.all;
}

/* The state on the coarser grid is the start on this grid. Bodies that separate there start as without it. */
static void
end_coarse(struct rc_adhesion_solver *a)
{
    struct rc_adhesion_solver *c = a->grids.coarse;
    double sum;

    if (c->stage == STAGE_COARSE)
        end_coarse(c);
    sum = convolutions(a);
    if (!c->separated && rc_gap_refine(&a->gap, &c->gap)) {
        a->gap.set.control = a->asked.control;
        a->gap.set.given = a->asked.given;
    }
    free_coarse(&a->grids);
    begin(a);
    a->gap.run.convolutions += sum;
}

static void
move(struct rc_adhesion_solver *a)
{
    struct rc_gap *g = &a->gap;

    rc_gap_move(g);
    if (!g->frozen.on)
        a->stability.softness =
            g->told.error <= loosest ? fmin(a->stability.softness, g->way.stiffness) : INFINITY;
}

static enum rc_status
descend(struct rc_adhesion_solver *a)
{
    move(a);
    if (!a->gap.run.parting)
        return RC_MORE;
    a->separated = true;
    return finish(a, false);
}

/* After a look: the attraction is no longer frozen if this gap is near its state. */
static bool
thaws(struct rc_adhesion_solver *a)
{
    struct rc_gap *g = &a->gap;
    const struct way *w = &a->way;

    if (g->frozen.on && w->turns > 0 && w->turn == 0)
        g->frozen.on = !(g->told.error <= near || g->run.stuck || w->turns == TURNS);
    return !g->frozen.on;
}

/* A step with frozen attraction. When the error has fallen, the attraction becomes that of the present
 * gap. */
static enum rc_status
turn(struct rc_adhesion_solver *a)
{
    struct rc_gap *g = &a->gap;
    struct way *w = &a->way;

    if (w->turn == 0)
        w->turn = g->told.error;
    else if (g->run.stuck || g->told.error <= turned * w->turn) {
        rc_gap_freeze(g, false);
        w->turns++;
        w->turn = 0;
        return RC_MORE;
    }
    return g->run.iterations < a->asked.max_iterations ? descend(a) : finish(a, false);
}

static enum rc_status
down(struct rc_adhesion_solver *a)
{
    struct rc_gap *g = &a->gap;

    rc_gap_look(g);
    if (!thaws(a))
        return turn(a);
    a->stability.hidden = a->stability.judged > 0 ? rc_gap_soft_error(g) : 0;
    if (a->grids.rough && (g->told.error <= coarse_tol || g->run.stuck))
        return finish(a, true);
    if (ends(a)) {
        rc_gap_look_along(g);
        a->stability.softness = fmin(a->stability.softness, g->way.stiffness);
    }
    a->stability.below = ends(a) ? a->stability.below + 1 : 0;
    /* the iteration leaves this stationary point, or a node without a place in the mode is free */
    if (a->stability.judged > 0 && (g->told.error > 10 * a->stability.judged || g->mode.grown)) {
        a->stability.judged = 0;
        a->stability.softness = INFINITY;
    }
    if (a->stability.below >= BELOW || g->run.stuck) {
        if (a->stability.judged > 0)
            return finish(a, a->gap.told.vanishes || estimate(a) <= a->asked.tol);
        rc_gap_pin(g, false);
        rc_gap_eigen_begin(g);
        a->stage = STAGE_EIGEN;
        return RC_MORE;
    }
    if (g->run.iterations >= a->asked.max_iterations)
        return finish(a, false);
    return descend(a);
}

static enum rc_status
eigen(struct rc_adhesion_solver *a)
{
    struct rc_gap *g = &a->gap;
    bool negative;

    if (g->mode.error > 0)
        rc_gap_eigen_step(g);
    negative = g->mode.mu < -single;
    if (g->mode.steps < EIGEN_STEPS && g->mode.slow < SLOW && g->mode.error > 0 &&
        g->mode.error > (negative ? 0.5 : eigen_exact) * fmax(fabs(g->mode.mu), single))
        return RC_MORE;
    rc_gap_pin(g, true);
    a->stability.judged = fmax(g->told.error, 1e-300);
    a->stability.hidden = rc_gap_soft_error(g);
    if (negative && a->stability.leaves < LEAVES) {
        rc_gap_leave(g);
        a->stability.leaves++;
        a->stability.judged = 0;
        a->stability.softness = INFINITY;
        a->stability.below = 0;
        a->stage = STAGE_DOWN;
        return RC_MORE;
    }
    if (negative)
        return finish(a, false);
    if (ends(a) || g->run.stuck)
        return finish(a, a->gap.told.vanishes || estimate(a) <= a->asked.tol);
    if (a->stability.hidden > softest(&a->gap.mode, &a->stability) *
                                  g->told.error) /* most of the error is along the softest mode */
        rc_gap_turn(g);
    move(a);
    a->stability.below = 0;
    a->stage = STAGE_DOWN;
    return RC_MORE;
}

static enum rc_status
step_state(struct rc_adhesion_solver *a)
{
    a->fresh = false;
    if (a->stage == STAGE_NEW && a->grids.coarse != NULL && !a->past.begun)
        begin_coarse(a);
    if (a->stage == STAGE_COARSE) {
        if (step_state(a->grids.coarse) != RC_MORE)
            end_coarse(a);
        return RC_MORE;
    }
    if (a->stage == STAGE_NEW && a->stays)
        return stay_apart(a);
    if (a->stage == STAGE_NEW)
        begin(a);
    return a->stage == STAGE_DOWN    ? down(a)
           : a->stage == STAGE_EIGEN ? eigen(a)
           : a->converged            ? RC_OK
                                     : RC_SHORT;
}

/* ---- retraction ---- */

static struct rc_retraction_state
place_of(struct rc_adhesion_solver *a)
{
    const struct rc_adhesion_state *f = rc_adhesion_solver_result(a);
    double length = a->whole->length, unit = a->whole->modulus * length * length;
    struct punch punch = punch_of(a, sqrt(f->contact_area / RC_PI) / length);

    return (struct rc_retraction_state){.c = rc_gap_shift(&a->gap),
                                        .load = f->load / unit,
                                        .attraction = f->attractive_load / unit,
                                        .punch = punch.stiffness,
                                        .crack = punch.crack,
                                        .slope = fmax(punch.stiffness, punch.least),
                                        .mean_gap = f->mean_gap / length};
}

static void
copy_gap(size_t n, double *to, const double *from)
{
    memcpy(to, from, n * sizeof *to);
}

/* Makes the next state start from this gap, which belongs to c. */
static void
put_back(struct rc_adhesion_solver *a, const double *gap, double c)
{
    copy_gap(a->gap.problem.n, a->gap.maps.x, gap);
    a->gap.mode.known = false; /* its softest mode belongs to another gap */
    a->way.steady = false;
    set_shift(a, c);
    a->gap.set.control = a->asked.control;
    a->gap.set.given = a->asked.given;
}

enum rc_status
rc_adhesion_solver_pull_off(struct rc_adhesion_solver *a, struct rc_err *err)
{
    struct retraction *p = &a->pull;
    bool has = true;

    if (!a->past.begun)
        return rc_err_set(
            err, "a retraction needs a state to start from: set a load or an approach first");
    for (size_t k = 0; k < RC_RETRACTION_KEPT; k++) {
        if (p->kept[k] == NULL)
            p->kept[k] = rc_alloc(a->gap.problem.n, sizeof *p->kept[k]);
        has &= p->kept[k] != NULL;
    }
    if (rc_ranks_need(a->rows.ranks, has, err, "out of memory for a retraction of %zu nodes",
                      a->gap.problem.all) != RC_OK)
        return RC_FAIL;
    if (a->gap.problem.yields)
        rc_adhesion_solver_keep_shape(a, NULL);
    p->on = true;
    p->short_of = false;
    p->iterations = p->eigen_steps = p->jumps = 0;
    p->convolutions = 0;
    rc_retraction_begin(
        &p->search,
        &(struct rc_retraction_law){.range = a->gap.problem.law.range,
                                    .parted = RC_GAP_PARTED * a->gap.problem.law.range - a->mean_h,
                                    .lines = is_strip(a)});
    p->start = rc_gap_shift(&a->gap);
    set_shift(a, p->start);
    return RC_OK;
}

static void
count(struct rc_adhesion_solver *a)
{
    struct retraction *p = &a->pull;

    if (p->search.stage == RC_RETRACTION_COARSE && p->search.count.states > 0)
        p->jumps += a->figures.jumps; /* there is no way to the first state */
    p->iterations += a->figures.iterations;
    p->eigen_steps += a->figures.eigen_steps;
    p->convolutions += a->figures.convolutions;
    p->short_of |= !a->converged;
}

static enum rc_status
end_retraction(struct rc_adhesion_solver *a)
{
    struct retraction *p = &a->pull;
    const struct rc_retraction *r = &p->search;
    struct rc_adhesion_state *f = &a->figures;
    double length = a->whole->length, unit = a->whole->modulus * length * length;
    bool converged = !p->short_of && !r->found.short_of;

    put_back(a, p->kept[r->path.lowest.kept], r->path.lowest.c);
    rc_gap_begin(&a->gap, a->asked.control, a->asked.given, false);
    if (a->asked.control == RC_GAP_MEAN) /* the mean pressure is found with the residual */
        rc_gap_look(&a->gap);
    a->stage = STAGE_DONE;
    a->fresh = true;
    a->converged = a->way.steady = converged;
    p->on = false;
    *f = p->found;
    f->pull_off_at_start = r->path.lowest.c == p->start;
    if (!f->pull_off_at_start) {
        f->pull_off_load = r->found.load * unit;
        f->pull_off_approach = r->found.at * length;
        f->pull_off_spread = r->found.spread * unit;
    }
    f->states = r->count.states;
    f->jumps = p->jumps;
    f->iterations = p->iterations;
    f->eigen_steps = p->eigen_steps;
    f->convolutions = p->convolutions + a->gap.run.convolutions;
    f->converged = converged;
    return converged ? RC_OK : RC_SHORT;
}

/* Sets the next approach, or ends. */
static enum rc_status
go_on(struct rc_adhesion_solver *a)
{
    struct retraction *p = &a->pull;
    struct rc_retraction *r = &p->search;
    struct rc_retraction_state here = place_of(a);
    bool more;

    count(a);
    more = rc_retraction_next(r, here);
    if (r->next.keep >= 0)
        copy_gap(a->gap.problem.n, p->kept[r->next.keep], a->gap.maps.x);
    if (r->next.is_lowest)
        p->found = a->figures;
    if (!more)
        return end_retraction(a);
    if (r->next.from >= 0)
        put_back(a, p->kept[r->next.from], r->next.from_c);
    set_shift(a, r->next.c);
    return RC_MORE;
}

enum rc_status
rc_adhesion_solver_step(struct rc_adhesion_solver *a, struct rc_err *err)
{
    enum rc_status status;

    if (!a->asked.held)
        return rc_err_set(err, "neither a load nor an approach has been set");
    status = step_state(a);
    return status != RC_MORE && a->pull.on ? go_on(a) : status;
}

/* ---- results ---- */

/* The record is flat, as struct rc_contact. */
#define FIGURE(member) RC_FIGURE(struct rc_adhesion_state, member)
const struct rc_figure rc_figures_adhesion[] = {
    {FIGURE(attractive_load), "N", "Load of attraction", .says = "sum of the attraction, positive"},
    {FIGURE(repulsive_load), "N", "Load of repulsion", .says = "sum of the repulsion"},
    {FIGURE(attractive_area), "m2", "Area of attraction",
     .says = "where the attraction is above 1 % of its largest value"},
    {FIGURE(min_pressure), "Pa", "Lowest net pressure"},
    {FIGURE(stability), NULL, "Stability",
     .says = "smallest eigenvalue of the stiffness of the gap", .limit = 0.02, .least = true,
     .warning = "the state is about to jump"},
    {FIGURE(jumps), NULL, "Jumps", .says = "places on the path where stable states ended"},
    {FIGURE(pull_off_load), "N", "Pull-off load", .says = "lowest load of the retraction"},
    {FIGURE(pull_off_approach), "m", "Approach at pull-off"},
    {FIGURE(pull_off_spread), "N", "Uncertainty of the pull-off load"},
    {0},
};

static double
at_edge(const struct rc_gap *g)
{
    const struct rc_boundary boundary = g->problem.whole->boundary;
    double nearest = INFINITY, v, s, d;

    if (!rc_has_mean(boundary))
        return 0;
    for (size_t j = 0; j < g->problem.on_map; j++)
        for (size_t i = 0; i < g->problem.nx; i++) {
            const size_t at = g->problem.rows.first + j;
            if ((!boundary.y && g->problem.ny > 1 && (at == 0 || at + 1 == g->problem.ny)) ||
                (!boundary.x && g->problem.nx > 1 && (i == 0 || i + 1 == g->problem.nx)))
                nearest = fmin(nearest, g->maps.x[j * g->problem.px + i]);
        }
    nearest = -rc_ranks_most(g->problem.rows.ranks, -nearest);
    if (isinf(nearest))
        return 0;
    nearest = fmax(nearest, 0);
    g->problem.law.law->at(&g->problem.law, 1, &nearest, &v, &s, &d);
    return s / g->problem.law.strength;
}

/* Sums over the map, and largest values. */
enum {
    OF_PRESSURE,
    OF_TRACTION,
    OF_TRACTION_AREA, /* nodes with a traction above 1 % of the strength */
    OF_CONTACT,       /* nodes */
    OF_YIELD,         /* nodes with a gap below 0 */
    OF_GAP,
    MOST_PRESSURE = RC_GAP_MOST,
    MOST_TENSION,
    MOST_WRONG,     /* violation of the conditions of contact */
    MOST_GAP_CHANGE /* correction of the gap */
};

static void
figures_row(void *ctx, size_t j, double *sums)
{
    const struct rc_gap *g = ctx;
    size_t m = rc_gap_on_map(&g->problem, j);

    sums[MOST_PRESSURE] = sums[MOST_TENSION] = -INFINITY;
    for (size_t i = 0; i < m; i += RC_GAP_LINE) {
        size_t n = m - i < RC_GAP_LINE ? m - i : RC_GAP_LINE;
        const double *x = g->maps.x + j * g->problem.px + i;
        double v[RC_GAP_LINE], s[RC_GAP_LINE], d[RC_GAP_LINE];
        g->problem.law.law->at(&g->problem.law, n, x, v, s, d);
        for (size_t k = 0; k < n; k++) {
            double p = rc_gap_pressure_at(&g->set, g->maps.au, j * g->problem.px + i + k),
                   wrong = p + s[k];
            double hard = g->problem.hards != NULL ? g->problem.hards[j * g->problem.nx + i + k]
                                                   : g->problem.hard;
            sums[OF_PRESSURE] += p;
            sums[OF_TRACTION] += s[k];
            sums[OF_TRACTION_AREA] += s[k] > g->problem.law.strength / 100;
            sums[OF_CONTACT] += x[k] <= 0;
            sums[OF_YIELD] += x[k] < 0;
            sums[OF_GAP] += x[k];
            sums[MOST_PRESSURE] = fmax(sums[MOST_PRESSURE], p);
            sums[MOST_TENSION] = fmax(sums[MOST_TENSION], -p);
            if (x[k] < 0)
                wrong -= hard;
            else if (x[k] == 0)
                wrong = fmin(wrong, 0) + fmax(wrong - hard, 0);
            sums[MOST_WRONG] = fmax(sums[MOST_WRONG], fabs(wrong));
            sums[MOST_GAP_CHANGE] =
                fmax(sums[MOST_GAP_CHANGE], fabs(g->maps.z[j * g->problem.px + i + k]));
        }
    }
}

static void
find_figures(struct rc_adhesion_solver *a)
{
    struct rc_adhesion_state *f = &a->figures;
    struct rc_gap *g = &a->gap;
    double sums[RC_GAP_SUMS], cell = a->shape.dx * a->shape.dy, e = a->whole->modulus,
                              nodes = (double)a->shape.nx * (double)a->shape.ny;

    *f = (struct rc_adhesion_state){.pull_off_load = NAN,
                                    .pull_off_approach = NAN,
                                    .pull_off_spread = NAN,
                                    .pull_off_from = NAN,
                                    .states = 1,
                                    .edge_traction = at_edge(&a->gap)};
    rc_sums_rows(&g->sums, figures_row, g, sums);
    f->load = sums[OF_PRESSURE] * e * cell;
    f->mean_pressure = sums[OF_PRESSURE] * e / nodes;
    f->attractive_load = sums[OF_TRACTION] * e * cell;
    f->repulsive_load = (sums[OF_PRESSURE] + sums[OF_TRACTION]) * e * cell;
    f->attractive_area = sums[OF_TRACTION_AREA] * cell;
    f->contact_nodes = (size_t)sums[OF_CONTACT];
    f->contact_area = sums[OF_CONTACT] * cell;
    f->contact_fraction = sums[OF_CONTACT] / nodes;
    f->plastic_nodes = (size_t)sums[OF_YIELD];
    f->plastic_area = sums[OF_YIELD] * cell;
    f->mean_gap = sums[OF_GAP] * a->whole->length / nodes;
    f->max_pressure = sums[MOST_PRESSURE] * e;
    f->min_pressure = -sums[MOST_TENSION] * e;
    f->kkt_residual = sums[MOST_WRONG] / g->problem.law.strength;
    f->gap_error = sums[MOST_GAP_CHANGE] * a->whole->length;
    f->approach = rc_gap_shift(g) * a->whole->length;
    f->stability = a->stability.judged > 0 ? softest(&a->gap.mode, &a->stability) : NAN;
    f->stable = a->separated ? a->converged
                             : a->stability.judged > 0 && softest(&a->gap.mode, &a->stability) > 0;
    f->separated = a->separated;
    f->was_separated = a->stays;
    f->jumps = a->jumps;
    f->iterations = a->way.iterations + g->run.iterations;
    f->eigen_steps = a->way.eigen_steps + g->mode.steps;
    f->convolutions = g->run.convolutions;
    f->pressure_error = a->separated && a->converged ? 0 /* the pressure is 0 by definition */
                        : isinf(g->told.error)       ? NAN
                                                     : estimate(a);
    f->inherited_error = a->separated ? 0 : inherited_error(&a->gap.told, &a->past);
    f->converged = a->converged;
    a->fresh = true;
}

const struct rc_adhesion_state *
rc_adhesion_solver_result(struct rc_adhesion_solver *a)
{
    if (a->stage == STAGE_COARSE) { /* interrupted: the start on this grid is the best state */
        end_coarse(a);
        rc_gap_look(&a->gap);
    }
    if (!a->fresh && (a->gap.run.iterations > 0 || a->separated))
        find_figures(a);
    return &a->figures;
}

void
rc_adhesion_solver_pressure(const struct rc_adhesion_solver *a, double *pressure)
{
    double *to = map_for(a, pressure);

    for (size_t j = 0; j < a->gap.problem.on_map; j++)
        for (size_t i = 0; i < a->gap.problem.nx; i++)
            to[j * a->gap.problem.nx + i] =
                a->stage == STAGE_COARSE
                    ? 0
                    : rc_gap_pressure_at(&a->gap.set, a->gap.maps.au, j * a->gap.problem.px + i) *
                          a->whole->modulus;
    give_map(a, pressure);
}

void
rc_adhesion_solver_gap(const struct rc_adhesion_solver *a, double *gap)
{
    double *to = map_for(a, gap);

    for (size_t j = 0; j < a->gap.problem.on_map; j++)
        for (size_t i = 0; i < a->gap.problem.nx; i++)
            to[j * a->gap.problem.nx + i] =
                a->gap.maps.x[j * a->gap.problem.px + i] * a->whole->length;
    give_map(a, gap);
}

void
rc_adhesion_solver_displacement(const struct rc_adhesion_solver *a, double *displacement)
{
    const struct rc_gap *g = &a->gap;
    double c = rc_gap_shift(g), *to = map_for(a, displacement);

    for (size_t j = 0; j < g->problem.on_map; j++)
        for (size_t i = 0; i < g->problem.nx; i++)
            to[j * g->problem.nx + i] =
                (g->maps.x[j * g->problem.px + i] + g->problem.h[j * g->problem.nx + i] + c) *
                a->whole->length;
    give_map(a, displacement);
}

void
rc_adhesion_solver_traction(const struct rc_adhesion_solver *a, double *traction)
{
    const struct rc_gap *g = &a->gap;
    double *to = map_for(a, traction);

    for (size_t j = 0; j < g->problem.on_map; j++)
        for (size_t i = 0; i < g->problem.nx; i += RC_GAP_LINE) {
            size_t n = g->problem.nx - i < RC_GAP_LINE ? g->problem.nx - i : RC_GAP_LINE;
            double v[RC_GAP_LINE], d[RC_GAP_LINE];
            g->problem.law.law->at(&g->problem.law, n, g->maps.x + j * g->problem.px + i, v,
                                   to + j * g->problem.nx + i, d);
            for (size_t k = 0; k < n; k++)
                to[j * g->problem.nx + i + k] *= a->whole->modulus;
        }
    give_map(a, traction);
}

void
rc_adhesion_solver_progress(const struct rc_adhesion_solver *a,
                            struct rc_adhesion_solver_progress *progress)
{
    const struct rc_adhesion_solver *at = a;
    const struct rc_gap *g;

    while (at->stage == STAGE_COARSE)
        at = at->grids.coarse;
    g = &at->gap;
    *progress = (struct rc_adhesion_solver_progress){
        .state = a->pull.on ? a->pull.search.count.states + 1 : 1,
        .coarser = at != a,
        .convolutions = convolutions(a),
        .iterations = at->stage == STAGE_NEW ? 0 : at->way.iterations + g->run.iterations,
        .eigenvalue = a->stage == STAGE_EIGEN,
        .load = a->asked.control == RC_GAP_LOAD && a->asked.held
                    ? a->asked.given * (double)a->gap.problem.all * a->shape.dx * a->shape.dy *
                          a->whole->modulus
                    : NAN,
        .approach = a->asked.control == RC_GAP_LOAD || !a->asked.held ? NAN
                    : a->asked.control == RC_GAP_SHIFT
                        ? a->asked.given * a->whole->length
                        : (-a->asked.given - a->mean_h) * a->whole->length,
        .error = at->stage == STAGE_NEW || isinf(g->told.error) ? NAN : estimate(at),
        .tol = a->asked.tol};
}

/* ---- start from an earlier path ---- */

/* Holds a state with this shift and the pressure `au`; the caller must then set the next one. */
static void
hold(struct rc_adhesion_solver *a, double c)
{
    set_shift(a, c);
    a->gap.set.control = a->asked.control;
    a->gap.set.given = a->asked.given;
    a->gap.set.level = 0;
    a->asked.held = false;
}

double
rc_adhesion_solver_approach(const struct rc_adhesion_solver *a)
{
    return rc_gap_shift(&a->gap) * a->whole->length;
}

struct rc_adhesion_solver_past *
rc_adhesion_solver_past(struct rc_adhesion_solver *a)
{
    return &a->past;
}

/* Of E*: a state of a file beyond it cannot be one of these bodies, and its eigenvalue would be rounding. */
static const double most_pressure = 1e9;

enum rc_status
rc_adhesion_solver_start(struct rc_adhesion_solver *a, const double *pressure, double approach,
                         struct rc_err *err)
{
    struct rc_gap *g = &a->gap;
    double c = approach / a->whole->length;
    enum rc_status status = RC_OK;

    if (!isfinite(approach))
        return rc_err_set(err, "approach %g m: it must be finite", approach);
    for (size_t k = 0; k < a->rows.n * a->shape.nx && status == RC_OK; k++)
        if (!isfinite(pressure[k]))
            status = rc_err_set(err, "pressure %zu is not a finite number",
                                node_of(&a->rows, &a->shape, k));
        else if (fabs(pressure[k]) > most_pressure * a->whole->modulus)
            status = rc_err_set(err, "pressure %zu, %g Pa, is more than %g of E*",
                                node_of(&a->rows, &a->shape, k), pressure[k], most_pressure);
    if (rc_ranks_agree(a->rows.ranks, status, err) != RC_OK)
        return RC_FAIL;
    free_coarse(&a->grids);
    memset(g->maps.d, 0, g->problem.n * sizeof *g->maps.d);
    take_map(a, pressure, g->maps.step);
    for (size_t j = 0; j < g->problem.on_map; j++)
        for (size_t i = 0; i < g->problem.nx; i++)
            g->maps.d[j * g->problem.px + i] =
                g->maps.step[j * g->problem.nx + i] / a->whole->modulus;
    rc_whole_apply(a->whole, g->maps.d, g->maps.x);
    for (size_t j = 0; j < g->problem.rows.n; j++)
        for (size_t i = 0; i < g->problem.px; i++) {
            double *x = g->maps.x + j * g->problem.px + i, p = g->maps.d[j * g->problem.px + i];
            *x -= c;
            if (i >= rc_gap_on_map(&g->problem, j))
                continue;
            *x -= a->h[j * g->problem.nx + i];
            /* in contact within rounding; without a hardness no gap is negative */
            if ((*x < 0 && !g->problem.yields) ||
                (fabs(*x) < 1e-6 * g->problem.law.range && p > -g->problem.law.strength))
                *x = 0;
        }
    memcpy(g->maps.au, g->maps.d, g->problem.n * sizeof *g->maps.au);
    hold(a, c);
    a->past.begun = a->way.steady = true;
    return RC_OK;
}

/* The displacement and the pressure stay; the gap changes by the change of the heights. */
enum rc_status
rc_adhesion_solver_set_heights(struct rc_adhesion_solver *a, const double *h, const double *dent,
                               struct rc_err *err)
{
    struct rc_gap *g = &a->gap;
    const double c = a->past.begun ? rc_gap_shift(g) : 0;

    if (check_heights(a, h, err) != RC_OK)
        return RC_FAIL;
    for (size_t j = 0; j < g->problem.on_map; j++)
        for (size_t i = 0; i < g->problem.nx; i++)
            g->maps.x[j * g->problem.px + i] += a->h[j * g->problem.nx + i];
    take_heights(a, h, dent);
    a->past.dents[0] = a->past.dents[1] = 0;
    a->pull.on = false;
    for (size_t j = 0; j < g->problem.on_map; j++)
        for (size_t i = 0; i < g->problem.nx; i++) {
            double *x = g->maps.x + j * g->problem.px + i;
            *x = fmax(*x - a->h[j * g->problem.nx + i], 0);
        }
    if (!a->past.begun)
        rc_gap_apart(g, 0);
    for (size_t k = 0; k < g->problem.n; k++)
        g->maps.au[k] = rc_gap_pressure_at(&g->set, g->maps.au, k);
    hold(a, c);
    g->mode.known = a->way.steady = false;
    return RC_OK;
}

void
rc_adhesion_solver_keep_shape(struct rc_adhesion_solver *a, double *h)
{
    struct rc_gap *g = &a->gap;
    struct rc_total sum = {0};
    double dented = 0, shift;

    if (h != NULL && a->dealt.moves) /* the new shape is made with the rows of the grid */
        rc_ranks_move(a->rows.ranks, a->shape.nx * sizeof *h, a->dealt.given, a->dealt.held, 0, h,
                      g->maps.step);
    for (size_t j = 0; j < g->problem.on_map; j++)
        for (size_t i = 0; i < g->problem.nx; i++) {
            double *x = g->maps.x + j * g->problem.px + i;
            if (!(*x < 0))
                continue;
            dented = 1;
            a->h[j * g->problem.nx + i] += *x;
            rc_total_add(&sum, *x);
            if (h != NULL)
                map_for(a, h)[j * g->problem.nx + i] += *x * a->whole->length;
            *x = 0;
        }
    if (h != NULL)
        give_map(a, h);
    rc_ranks_totals(a->rows.ranks, 1, &sum, &shift, 1, &dented);
    a->mean_h += shift / (double)(g->problem.nx * g->problem.ny);
    if (dented > 0 && !isinf(g->told.error)) {
        a->past.dents[0] += own_error(&a->gap, &a->stability, a->asked.control);
        a->past.dents[1] += own_error(&a->gap, &a->stability, a->asked.control) * g->told.size;
    }
}

/* ---- cost ---- */

enum rc_status
rc_adhesion_expect(const struct rc_shape *shape, const struct rc_adhesion_problem *problem,
                   struct rc_expected *expected, struct rc_err *err)
{
    struct rc_adhesion_scales scales;
    const double bytes[] = {458, 129}; /* bytes a node, measured on 1024 x 1024 nodes: free,
                                          periodic */
    const double mapped = problem->contact.hardness_map != NULL ? sizeof(double) : 0;
    double nodes = (double)shape->nx * (double)shape->ny;

    if (rc_adhesion_check(shape, problem, &scales, err) != RC_OK)
        return RC_FAIL;
    *expected = (struct rc_expected){
        .convolutions = (scales.cohesive_nodes < RC_ADHESION_STIFF ? RC_ADHESION_STIFF_WORK
                                                                   : RC_ADHESION_WORK) *
                        rc_by_padding(problem->contact.boundary, RC_ADHESION_FREE, 1) *
                        pow(nodes / 16384, 0.25),
        .memory = (size_t)((rc_by_padding(problem->contact.boundary, bytes[0], bytes[1]) + mapped) *
                           nodes / (double)rc_ranks_count(problem->contact.ranks))};
    expected->seconds =
        RC_ADHESION_PASSES * expected->convolutions *
        rc_conv_seconds(shape, &(struct rc_conv_options){.boundary = problem->contact.boundary,
                                                         .threads = problem->contact.threads,
                                                         .ranks = problem->contact.ranks});
    return RC_OK;
}
