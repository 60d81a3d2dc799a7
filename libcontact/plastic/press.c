/*
 * A body that may yield, from its elastic contact on. A load is solved as an elastic one first. Where its
 * stresses nowhere reach the yield stress, that is the solution, and nothing of the volume has been touched.
 * Else the body is pressed from 0 in increments, in slabs as deep as the largest load of the plan needs, and
 * from then on each load follows the last.
 *
 * Where the number of increments is left open a load begins with a few. While their part of the estimated
 * error is too large the load is forgotten and begins again with more.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"
#include "plastic.h"

enum {
    FIRST = 8,       /* increments of the first try of a load, */
    MOST_AUTO = 128, /* of the last, */
    TRIES = 3
};
static const double deserved = 1e-2;      /* error that the increments are chosen for        */
static const double contact_most = 1e-4;  /* tolerance of each contact, at most,             */
static const double contact_least = 1e-6; /* and, for the sake of a smaller goal, at least   */
static const double contact_share = 0.1;  /* of the goal                                     */
static const double lag_least = 1e-3;     /* what single precision allows                    */
static const double for_later = 0.7;      /* share of the goal where loads follow            */
static const double expected_part = 0.3;  /* of the voxels that yield, for the memory        */
static const double order = 1.1;          /* power of the error that the increments go by    */

enum stage {
    APART,   /* no load, and nothing has yielded */
    ELASTIC, /* the elastic contact */
    DEPTHS,  /* its stresses */
    LARGEST, /* the elastic contact under the largest load of the plan */
    MAKE,    /* the volume comes next */
    VOLUME
};

struct rc_press {
    struct rc_shape shape;
    struct rc_plastic_problem problem; /* as asked for; its thicknesses are a copy, or NULL */
    double *h, *asked;                 /* heights; those thicknesses                        */
    struct rc_solver *elastic;
    struct rc_plastic *plastic; /* NULL: nothing has yielded                   */
    double *thickness;          /* in use                                      */
    double load, largest;       /* that is set, and of the plan                */
    size_t left, planned;       /* loads of the plan                           */
    size_t increments, try;     /* in use; which try of the load, from 0       */
    double *before;             /* the state before the load; NULL: it is not tried again */
    size_t before_size;
    enum stage stage;
    enum rc_status status, reached; /* of the load, of its elastic contact */
    struct rc_press_figures figures;
};

/* ---- slabs ---- */

/* From the elastic pressure; figures.slabs is 0 where nothing yields under it. */
static enum rc_status
find_slabs(struct rc_press *p, struct rc_err *err)
{
    const struct rc_plastic_problem *asked = &p->problem;
    struct rc_press_figures *f = &p->figures;
    const double yield = rc_yield_stress(&asked->yield, 0);
    struct rc_plastic_depths d;

    if (rc_plastic_depths(&p->shape, asked->contact.boundary, rc_solver_pressure(p->elastic),
                          &asked->contact.pair.one, yield, asked->contact.threads, &d,
                          err) != RC_OK)
        return RC_FAIL;
    f->most = d.most / yield;
    f->deepest = d.deepest;
    f->slabs = d.slabs == 0 || asked->slabs == 0 ? d.slabs : asked->slabs;
    free(p->thickness);
    p->thickness = NULL;
    if (f->slabs > 0 && (p->thickness = malloc(f->slabs * sizeof *p->thickness)) == NULL)
        rc_err_set(err, "out of memory for the slabs");
    else if (f->slabs > 0 && asked->thickness != NULL)
        memcpy(p->thickness, asked->thickness, f->slabs * sizeof *p->thickness);
    else if (f->slabs > 0)
        rc_plastic_stack(&d, f->slabs, p->thickness);
    free(d.thickness);
    f->thickness = p->thickness;
    return f->slabs > 0 && p->thickness == NULL ? RC_FAIL : RC_OK;
}

/* ---- the volume ---- */

static struct rc_plastic_problem
problem_of(const struct rc_press *p, size_t slabs)
{
    struct rc_plastic_problem problem = p->problem;
    const double asked = problem.contact.tol > 0 ? problem.contact.tol : 1;

    problem.contact.tol =
        fmin(fmin(asked, fmax(contact_share * asked, contact_least)), contact_most);
    problem.slabs = slabs;
    problem.thickness = p->thickness;
    if (problem.lag == 0)
        problem.lag = fmax(2 * fmin(p->figures.goal, deserved), lag_least);
    return problem;
}

static enum rc_status
make(struct rc_press *p, struct rc_err *err)
{
    const struct rc_plastic_problem problem = problem_of(p, p->figures.slabs);

    if ((p->plastic = rc_plastic_new(&p->shape, p->h, &problem, err)) == NULL)
        return RC_FAIL;
    rc_solver_free(p->elastic);
    free(p->h);
    p->elastic = NULL;
    p->h = NULL;
    p->stage = VOLUME;
    return RC_OK;
}

/* Sets the load with as many increments as are to be tried next. */
static enum rc_status
try_load(struct rc_press *p, struct rc_err *err)
{
    p->plastic->thorough = p->try > 0;
    rc_plastic_set_increments(p->plastic, p->increments);
    return rc_plastic_set_load(p->plastic, p->load, err);
}

static void
forget_before(struct rc_press *p)
{
    free(p->before);
    p->before = NULL;
    p->before_size = 0;
}

/* The first try of a load. */
static enum rc_status
begin(struct rc_press *p, struct rc_err *err)
{
    p->increments = p->problem.increments > 0 ? p->problem.increments : FIRST;
    p->try = 0;
    forget_before(p);
    if (p->problem.increments == 0) {
        p->before_size = rc_plastic_state_size(p->plastic);
        if ((p->before = malloc(p->before_size * sizeof *p->before)) == NULL)
            return rc_err_set(err, "out of memory for the state before a load");
        rc_plastic_state(p->plastic, p->before);
    }
    return try_load(p, err);
}

/* Whether more increments lower the error of the load to what is asked for, and how many. Images and earlier
 * loads are not their matter. */
static bool
deserves_more(struct rc_press *p)
{
    const struct rc_plastic_figures *f = rc_plastic_result(p->plastic);
    const double goal = p->figures.goal, own = f->increment_error;
    const double aim = goal * (p->left > 0 ? for_later : 1), here = f->error - f->image_error;
    const size_t most = goal < deserved ? RC_PRESS_INCREMENTS : MOST_AUTO;
    const double more = ceil((double)p->increments * pow(2 * own / goal, order));

    if (p->before == NULL || p->try + 1 == TRIES || p->increments >= most ||
        own <= goal / (f->image_error > goal ? 2 : 4) ||
        (here <= aim && !(f->error > goal && own > goal / 2)))
        return false;
    p->increments = more < (double)p->increments + 1 ? p->increments + 1
                    : more < (double)most            ? (size_t)more
                                                     : most;
    p->try++;
    return true;
}

static enum rc_status
press_volume(struct rc_press *p, struct rc_err *err)
{
    const enum rc_status status = rc_plastic_step(p->plastic, err);

    if (status == RC_MORE || status == RC_FAIL)
        return status;
    if (!deserves_more(p)) {
        forget_before(p);
        return status;
    }
    if (rc_plastic_restore(p->plastic, p->before, p->before_size, err) != RC_OK)
        return RC_FAIL;
    return try_load(p, err) == RC_OK ? RC_MORE : RC_FAIL;
}

/* ---- loads ---- */

void
rc_press_plan(struct rc_press *p, size_t loads, double largest)
{
    p->left = p->planned = loads;
    p->largest = largest;
}

static enum rc_status
set_elastic(struct rc_press *p, double load, struct rc_err *err)
{
    struct rc_problem contact = p->problem.contact;

    if (p->elastic != NULL)
        return rc_solver_set_load(p->elastic, load, 0, err);
    contact.load = load;
    contact.approach = 0;
    p->elastic = rc_solver_new(&p->shape, p->h, &contact, err);
    return p->elastic != NULL ? RC_OK : RC_FAIL;
}

enum rc_status
rc_press_set_load(struct rc_press *p, double load, struct rc_err *err)
{
    p->load = load;
    p->left -= p->left > 0;
    p->status = RC_MORE;
    if (p->stage == VOLUME)
        return begin(p, err);
    if (!(load >= 0))
        return rc_err_set(err, "load %g N: it must be finite and not negative", load);
    p->stage = load > 0 ? ELASTIC : APART;
    if (load > 0)
        p->figures.most = p->figures.deepest = 0;
    return load > 0 ? set_elastic(p, load, err) : RC_OK;
}

/* The stresses of the elastic contact: RC_MORE where the body yields under it. */
static enum rc_status
look_inside(struct rc_press *p, struct rc_err *err)
{
    if (find_slabs(p, err) != RC_OK)
        return RC_FAIL;
    if (p->figures.slabs == 0)
        return p->reached;
    p->stage = p->largest > p->load ? LARGEST : MAKE;
    return p->stage == LARGEST && set_elastic(p, p->largest, err) != RC_OK ? RC_FAIL : RC_MORE;
}

/* An iteration of the elastic contact. */
static enum rc_status
press_elastic(struct rc_press *p, struct rc_err *err)
{
    const enum rc_status status = rc_solver_step(p->elastic);

    if (status == RC_MORE)
        return RC_MORE;
    if (p->stage == LARGEST && find_slabs(p, err) != RC_OK)
        return RC_FAIL;
    p->reached = status;
    p->stage = p->stage == LARGEST ? MAKE : DEPTHS;
    return RC_MORE;
}

enum rc_status
rc_press_step(struct rc_press *p, struct rc_err *err)
{
    if (p->status != RC_MORE)
        return p->status;
    if (p->stage == APART)
        p->status = RC_OK;
    else if (p->stage == VOLUME)
        p->status = press_volume(p, err);
    else if (p->stage == MAKE)
        p->status = make(p, err) == RC_OK && begin(p, err) == RC_OK ? RC_MORE : RC_FAIL;
    else if (p->stage == DEPTHS)
        p->status = look_inside(p, err);
    else
        p->status = press_elastic(p, err);
    return p->status;
}

/* ---- what is found ---- */

const struct rc_press_figures *
rc_press_result(struct rc_press *p)
{
    struct rc_err err;

    if (p->stage == LARGEST &&
        set_elastic(p, p->load, &err) == RC_OK) /* left there by its caller */
        p->stage = ELASTIC;
    p->figures.increments = p->increments;
    return &p->figures;
}

struct rc_solver *
rc_press_solver(struct rc_press *p)
{
    return p->plastic != NULL ? rc_plastic_solver(p->plastic) : p->elastic;
}

struct rc_plastic *
rc_press_plastic(struct rc_press *p)
{
    return p->plastic;
}

/* ---- states: a head, then of an elastic contact its pressure; else the thicknesses of the slabs, the state
 * before the load, and that of the volume ---- */

enum {
    INCREMENTS,
    TRY,
    SLABS,
    LEFT,
    BEFORE, /* numbers */
    LOAD,
    SOLVED, /* load of the elastic pressure, which begins; 0: there is none */
    HEAD
};

size_t
rc_press_state(const struct rc_press *p, double *state)
{
    const bool pressed = p->plastic == NULL && p->elastic != NULL && p->stage != APART;
    const size_t slabs = p->plastic != NULL ? p->figures.slabs : 0;
    const size_t n = p->plastic != NULL ? rc_plastic_state_size(p->plastic)
                     : pressed          ? p->shape.nx * p->shape.ny
                                        : 0;
    const double head[HEAD] = {[INCREMENTS] = (double)p->increments,
                               [TRY] = (double)p->try,
                               [SLABS] = (double)slabs,
                               [LEFT] = (double)p->left,
                               [BEFORE] = (double)p->before_size,
                               [LOAD] = p->load,
                               [SOLVED] = pressed ? rc_solver_load(p->elastic) : 0};

    if (state == NULL)
        return HEAD + slabs + p->before_size + n;
    memcpy(state, head, sizeof head);
    state += HEAD;
    if (pressed)
        memcpy(state, rc_solver_pressure(p->elastic), n * sizeof *state);
    if (p->plastic != NULL) {
        memcpy(state, p->thickness, slabs * sizeof *state);
        if (p->before != NULL)
            memcpy(state + slabs, p->before, p->before_size * sizeof *state);
        rc_plastic_state(p->plastic, state + slabs + p->before_size);
    }
    return HEAD + slabs + p->before_size + n;
}

static bool
whole(double v, double least, double most)
{
    return v >= least && v <= most && v == floor(v);
}

static enum rc_status
restore_elastic(struct rc_press *p, const double *state, size_t n, struct rc_err *err)
{
    const size_t nodes = p->shape.nx * p->shape.ny;

    if (p->plastic != NULL || n != (state[SOLVED] > 0 ? HEAD + nodes : HEAD) || state[BEFORE] != 0)
        return rc_err_set(err, "the state is that of a body that has not yielded");
    p->left++; /* which setting the load takes away */
    if (rc_press_set_load(p, state[LOAD], err) != RC_OK)
        return RC_FAIL;
    return state[SOLVED] > 0 ? rc_solver_warm_start(p->elastic, state[SOLVED], state + HEAD, err)
                             : RC_OK;
}

static enum rc_status
restore_volume(struct rc_press *p, const double *state, size_t n, struct rc_err *err)
{
    const size_t slabs = (size_t)state[SLABS], before = (size_t)state[BEFORE];
    const double *thickness = state + HEAD, *from = thickness + slabs;

    if (p->plastic == NULL) {
        free(p->thickness);
        p->figures.thickness = p->thickness = malloc(slabs * sizeof *p->thickness);
        if (p->thickness == NULL)
            return rc_err_set(err, "out of memory for the slabs");
        memcpy(p->thickness, thickness, slabs * sizeof *p->thickness);
        p->figures.slabs = slabs;
        if (make(p, err) != RC_OK)
            return RC_FAIL;
    } else if (slabs != p->figures.slabs ||
               memcmp(thickness, p->thickness, slabs * sizeof *thickness) != 0) {
        return rc_err_set(err, "it has other slabs than the load before it");
    }
    p->increments = (size_t)state[INCREMENTS];
    p->try = (size_t)state[TRY];
    p->load = state[LOAD];
    p->status = RC_MORE;
    forget_before(p);
    if (before > 0) {
        if ((p->before = malloc(before * sizeof *p->before)) == NULL)
            return rc_err_set(err, "out of memory for the state before a load");
        memcpy(p->before, from, before * sizeof *from);
        p->before_size = before;
    }
    return rc_plastic_restore(p->plastic, from + before, n - HEAD - slabs - before, err);
}

/* Whether a press that has yielded can go on from this state: one of a body that has. */
bool
rc_press_returns(const struct rc_press *p, const double *state, size_t n)
{
    return p->plastic == NULL || (n >= HEAD && state[SLABS] > 0);
}

enum rc_status
rc_press_restore(struct rc_press *p, const double *state, size_t n, struct rc_err *err)
{
    const double most = (double)n - HEAD;

    if (n < HEAD || !whole(state[INCREMENTS], 0, RC_PRESS_INCREMENTS) ||
        !whole(state[TRY], 0, TRIES - 1) || !whole(state[LEFT], 0, 1e15) ||
        !whole(state[SLABS], 0, most) || !whole(state[BEFORE], 0, most - state[SLABS]) ||
        !(state[LOAD] >= 0) || !(state[SOLVED] >= 0) ||
        (state[SLABS] > 0 && state[INCREMENTS] == 0))
        return rc_err_set(err, "its first numbers are none of a state");
    p->left = (size_t)state[LEFT];
    return state[SLABS] > 0 ? restore_volume(p, state, n, err) : restore_elastic(p, state, n, err);
}

/* ---- makers ---- */

size_t
rc_press_memory(const struct rc_press *p, const double *state, size_t n, bool kept)
{
    const size_t slabs = state == NULL && p->stage == MAKE ? p->figures.slabs
                         : state != NULL && n > HEAD       ? (size_t)state[SLABS]
                                                           : 0;
    const struct rc_plastic_problem problem = problem_of(p, slabs);
    size_t bytes;

    if (slabs == 0 || p->plastic != NULL)
        return 0;
    bytes = rc_plastic_memory(&p->shape, &problem, expected_part);
    /* a state takes no more than the voxels, and a pressure */
    if (kept || (p->problem.increments == 0 && p->planned > 1))
        bytes += bytes - rc_plastic_memory(&p->shape, &problem, 0) +
                 p->shape.nx * p->shape.ny * sizeof(double);
    return bytes;
}

struct rc_press *
rc_press_new(const struct rc_shape *shape, const double *h,
             const struct rc_plastic_problem *problem, struct rc_err *err)
{
    const size_t n = shape->nx * shape->ny, slabs = problem->thickness != NULL ? problem->slabs : 0;
    const double tol = problem->contact.tol;
    struct rc_press *p;

    if (rc_plastic_check(problem, err) != RC_OK)
        return NULL;
    p = calloc(1, sizeof *p);
    if (p == NULL || (p->h = rc_alloc(n, sizeof *p->h)) == NULL ||
        (slabs > 0 && (p->asked = malloc(slabs * sizeof *p->asked)) == NULL)) {
        rc_err_set(err, "out of memory for the plasticity of %zu x %zu nodes", shape->nx,
                   shape->ny);
        rc_press_free(p);
        return NULL;
    }
    memcpy(p->h, h, n * sizeof *h);
    if (slabs > 0)
        memcpy(p->asked, problem->thickness, slabs * sizeof *p->asked);
    p->shape = *shape;
    p->problem = *problem;
    p->problem.thickness = p->asked;
    p->figures.goal = tol > 0 ? tol : deserved;
    return p;
}

void
rc_press_free(struct rc_press *p)
{
    if (p == NULL)
        return;
    rc_solver_free(p->elastic);
    rc_plastic_free(p->plastic);
    free(p->h);
    free(p->asked);
    free(p->thickness);
    free(p->before);
    free(p);
}
