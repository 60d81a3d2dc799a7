/*
 * Bodies pressed together and moved along each other: the pressure under the tractions, and the tractions
 * under the pressure, in turn.
 *
 * Dissimilar bodies feel both. With the tractions q held the contact is one of the heights less C'q; with
 * the pressure p held an increment of friction has w less C p. Passes of both contract by about 0.7 mu beta.
 * Where beta is 0, or nobody wants to know (Goodman 1962), the pressure is found once, and only where the
 * load has changed.
 */
#include "slip.h"

#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

enum state {
    IDLE,
    PRESSING, /* the contact is iterated                        */
    MEETING,  /* its pressure is there, for friction to be told */
    SLIDING,  /* friction is                                    */
    DONE
};

struct rc_joint {
    struct rc_shape shape;
    size_t n, most;
    double tol;
    bool alternates, good; /* good: the contact has converged */
    enum state state;
    enum rc_status last;
    struct rc_slip *slip;
    struct rc_solver *solver; /* NULL: no heights */
    double *own, *gap, *apart, *h, *less, *before[2];
    const double *p,
        *p_gap;     /* that friction was told; NULL: the bodies are apart, the gap is unknown */
    double pressed; /* N, of these */
    struct {
        double load; /* N; 0: none */
        const double *p, *gap;
    } known;
    /* what is asked */
    double load, to[2];
    bool moved; /* displacements */
    /* of this increment */
    bool fresh; /* friction has begun with it */
    bool warm;  /* its first contact starts from `own` */
    size_t passes;
    double pressure_change, traction_change, factor, approach;
    double pressure_error; /* relative, of the contact that was solved last; 0: none was */
    double inherited
        [2]; /* Pa, sums over the map: errors of the increments before, of iteration and contact */
    double lowered;      /* m: by which the highest node of `less` is below that of `h` */
    double convolutions; /* of all contacts */
};

static const double same = 1e-12; /* of the load: less is rounding */

/* ---- what is asked ---- */

void
rc_joint_know(struct rc_joint *j, double load, const double *p, const double *gap)
{
    j->known.load = load;
    j->known.p = p;
    j->known.gap = gap;
}

/* Starts to find the pressure under the tractions that there are. */
static enum rc_status
press(struct rc_joint *j, struct rc_err *err)
{
    if (j->solver == NULL)
        return rc_err_set(err, "load %g N: the contact under it is not known, nor are heights",
                          j->load);
    if (j->alternates) {
        double top = -INFINITY, less = -INFINITY;
        rc_slip_normal(j->slip, j->less);
        for (size_t k = 0; k < j->n; k++) {
            j->less[k] = j->h[k] - j->less[k];
            top = fmax(top, j->h[k]);
            less = fmax(less, j->less[k]);
        }
        j->lowered = top - less;
        if (rc_solver_set_heights(j->solver, j->less, err) != RC_OK)
            return RC_FAIL;
    }
    j->state = PRESSING;
    if (rc_solver_set_load(j->solver, j->load, 0, err) != RC_OK)
        return RC_FAIL;
    if (j->warm && rc_solver_warm_start(j->solver, j->load, j->own, err) != RC_OK)
        return RC_FAIL;
    j->warm = false;
    return RC_OK;
}

void
rc_joint_start(struct rc_joint *j, const double *const q[2], const double *p)
{
    rc_slip_start(j->slip, q);
    if (j->own != NULL && p != NULL) {
        memcpy(j->own, p, j->n * sizeof *p);
        j->warm = true;
    }
    for (int c = 0; c < 2 && j->alternates; c++)
        memcpy(j->before[c], q[c], j->n * sizeof **q);
}

static enum rc_status
set(struct rc_joint *j, double load, double x, double y, bool moved, struct rc_err *err)
{
    j->state = IDLE;
    if (!(load >= 0) || isinf(load))
        return rc_err_set(err, "load %g N: it must be finite and not negative", load);
    j->load = load;
    j->to[0] = x;
    j->to[1] = y;
    j->moved = moved;
    j->passes = 0;
    j->pressure_error = 0;
    j->pressure_change = j->traction_change = j->factor = 0;
    if (load > 0 && (j->alternates || !(fabs(load - j->pressed) <= same * load))) {
        if (j->alternates || !(fabs(load - j->known.load) <= same * load))
            return press(j, err);
        j->p = j->known.p;
        j->p_gap = j->known.gap;
        j->approach = NAN;
    } else if (load == 0) {
        j->p = NULL;
        j->p_gap = j->apart;
        j->approach = NAN;
    }
    j->pressed = load;
    j->good = true;
    j->state = MEETING;
    return RC_OK;
}

enum rc_status
rc_joint_set_force(struct rc_joint *j, double load, double fx, double fy, struct rc_err *err)
{
    return set(j, load, fx, fy, false, err);
}

enum rc_status
rc_joint_set_displacement(struct rc_joint *j, double load, double dx, double dy, struct rc_err *err)
{
    return set(j, load, dx, dy, true, err);
}

/* ---- steps ---- */

double
rc_slip_take(size_t n, int maps, const double *const v[], double *const to[])
{
    struct rc_total change = {0}, all = {0};

    for (int c = 0; c < maps; c++)
        for (size_t k = 0; k < n; k++) {
            rc_total_add(&change, fabs(v[c][k] - to[c][k]));
            rc_total_add(&all, fabs(v[c][k]));
            to[c][k] = v[c][k];
        }
    return rc_total_value(&all) > 0 ? rc_total_value(&change) / rc_total_value(&all) : 0;
}

double
rc_slip_left_over(size_t passes, double change, double before)
{
    static const double worst = 0.95;
    double c = passes > 2 && before > 0 ? fmin(change / before, worst) : 0.5;

    return fmax(1, c / (1 - c));
}

static enum rc_status
slide(struct rc_joint *j, struct rc_err *err)
{
    const double *q[2] = {rc_slip_traction(j->slip, 0), rc_slip_traction(j->slip, 1)};
    enum rc_status status = rc_slip_step(j->slip, err);
    double before = j->traction_change;

    j->fresh = true;
    if (status == RC_MORE || status == RC_FAIL)
        return status;
    j->passes++;
    j->state = DONE;
    j->last = status == RC_OK && j->good ? RC_OK : RC_SHORT;
    if (!j->alternates || j->load == 0)
        return j->last;
    j->traction_change = rc_slip_take(j->n, 2, q, j->before);
    j->factor = rc_slip_left_over(j->passes, j->traction_change, before);
    if (j->factor * fmax(j->traction_change, j->pressure_change) <= j->tol / 2)
        return j->last;
    if (j->passes >= j->most)
        return j->last = RC_SHORT;
    return press(j, err) == RC_OK ? RC_MORE : RC_FAIL;
}

/* Tells friction the pressure. Its first step puts the tractions on what that lets them be. */
static enum rc_status
meet(struct rc_joint *j, struct rc_err *err)
{
    j->state = IDLE;
    if (rc_slip_set_pressure(j->slip, j->p, j->p_gap, err) != RC_OK ||
        (j->moved ? rc_slip_set_displacement(j->slip, j->to[0], j->to[1], err)
                  : rc_slip_set_force(j->slip, j->to[0], j->to[1], err)) != RC_OK)
        return RC_FAIL;
    j->state = SLIDING;
    return slide(j, err);
}

static enum rc_status
step_contact(struct rc_joint *j, struct rc_err *err)
{
    enum rc_status status = rc_solver_step(j->solver);
    const double *p = rc_solver_pressure(j->solver);
    struct rc_contact contact;

    if (status == RC_MORE)
        return RC_MORE;
    j->good = status == RC_OK;
    rc_solver_result(j->solver, NULL, j->gap, &contact);
    j->convolutions += rc_solver_convolutions(j->solver);
    j->pressure_change = rc_slip_take(j->n, 1, &p, &j->own);
    j->pressure_error = contact.pressure_error;
    j->approach = contact.approach + j->lowered; /* from where the bodies touch unmoved */
    j->p = j->own;
    j->p_gap = j->gap;
    j->pressed = j->load;
    return meet(j, err);
}

enum rc_status
rc_joint_step(struct rc_joint *j, struct rc_err *err)
{
    switch (j->state) {
    case IDLE:
        return rc_err_set(err, "neither a force nor a displacement has been set");
    case PRESSING:
        return step_contact(j, err);
    case MEETING:
        return meet(j, err);
    case SLIDING:
        return slide(j, err);
    default:
        return j->last;
    }
}

/* Sums over the map, Pa: of |q|, and of the errors that this increment adds to them, of its iteration and of
 * the discs' radii. */
static double
added(const struct rc_joint *j, double error, double limit, double add[2])
{
    const double *q[2] = {rc_slip_traction(j->slip, 0), rc_slip_traction(j->slip, 1)};
    struct rc_total sum = {0};
    double size;

    for (size_t k = 0; k < j->n; k++)
        rc_total_add(&sum, hypot(q[0][k], q[1][k]));
    size = rc_total_value(&sum);
    add[0] = size > 0 ? error * size : 0;
    add[1] = j->pressure_error * limit / (j->shape.dx * j->shape.dy);
    return size;
}

/* An increment is the nearest tractions to the last, in energy: what was off stays off, and is no more. Where
 * nothing touches nothing is kept. */
void
rc_joint_keep(struct rc_joint *j)
{
    struct rc_joint_figures f;
    double add[2];

    if (j->state != DONE)
        return;
    rc_joint_result(j, &f);
    added(j, f.traction_error, f.slip.limit, add);
    for (int k = 0; k < 2; k++)
        j->inherited[k] = j->load > 0 ? j->inherited[k] + add[k] : 0;
    j->pressure_error = 0;
    rc_slip_keep(j->slip);
    j->fresh = j->warm = false;
    j->state = IDLE;
}

/* ---- what has been found ---- */

void
rc_joint_result(struct rc_joint *j, struct rc_joint_figures *f)
{
    double size, add[2];

    *f = (struct rc_joint_figures){.passes = j->passes,
                                   .pressure_change = j->pressure_change,
                                   .traction_change = j->traction_change,
                                   .approach = j->approach};
    rc_slip_result(j->slip, &f->slip);
    if (!j->fresh) /* these are of the increment before */
        f->slip.dissipated = f->slip.largest_slip = 0;
    f->traction_error = f->slip.traction_error + j->factor * j->traction_change;
    size = added(j, f->traction_error, f->slip.limit, add);
    f->inherited_error = size > 0 && j->load > 0 ? j->inherited[0] / size : 0;
    f->contact_error = size > 0 && j->load > 0 ? (j->inherited[1] + add[1]) / size : 0;
    f->convolutions = f->slip.convolutions + j->convolutions;
    f->converged = j->state == DONE && j->last == RC_OK;
}

struct rc_slip *
rc_joint_slip(struct rc_joint *j)
{
    return j->slip;
}

const double *
rc_joint_pressure(const struct rc_joint *j)
{
    return j->p;
}

/* ---- plan ---- */

/* Both problems, each with what it shares with the other. Whether pressure and tractions are found in
 * turn. */
static bool
problems(const struct rc_joint_problem *p, struct rc_problem *contact, struct rc_slip_problem *slip,
         bool *alternates, struct rc_err *err)
{
    static const double usual = 1e-4;
    struct rc_shear shear;

    *contact = p->contact;
    contact->hurry = NULL; /* tractions would be found under a pressure that stands still */
    *slip = p->slip;
    slip->boundary = contact->boundary;
    slip->pair = contact->pair;
    slip->threads = contact->threads;
    slip->ranks = contact->ranks;
    slip->uncoupled = p->coupling == RC_COUPLING_NONE;
    if (slip->tol == 0)
        slip->tol = usual;
    if (contact->tol == 0)
        contact->tol = slip->tol;
    if (rc_pair_shear(&slip->pair, slip->nu, &shear, err) != RC_OK)
        return false;
    *alternates = p->coupling == RC_COUPLING_FULL && shear.beta != 0;
    if (*alternates) { /* half of what is allowed is for the passes */
        contact->tol = fmin(contact->tol, slip->tol / 4);
        slip->tol /= 2;
    }
    return true;
}

static bool
allocate(struct rc_joint *j, const double *h)
{
    double **maps[] = {&j->own, &j->gap, &j->apart, &j->h, &j->less, &j->before[0], &j->before[1]};
    size_t wanted = h == NULL ? 0 : j->alternates ? 7 : 3;

    for (size_t k = 0; k < wanted; k++) {
        if ((*maps[k] = rc_alloc(j->n, sizeof(double))) == NULL)
            return false;
        memset(*maps[k], 0, j->n * sizeof(double));
    }
    return true;
}

/* From bodies that are apart: with the gap before, nodes that touch have moved with their bodies. */
static enum rc_status
begin(struct rc_joint *j, const double *h, struct rc_err *err)
{
    struct rc_contact apart;
    enum rc_status status;

    if (h == NULL)
        return RC_OK;
    if (j->alternates)
        memcpy(j->h, h, j->n * sizeof *h);
    rc_contact_apart(NULL, &j->shape, h, j->apart, &apart);
    status = set(j, 0, 0, 0, false, err);
    while (status == RC_OK && (status = rc_joint_step(j, err)) == RC_MORE)
        status = RC_OK;
    rc_joint_keep(j);
    j->fresh = false;
    return status;
}

struct rc_joint *
rc_joint_new(const struct rc_shape *shape, const double *h, const struct rc_joint_problem *p,
             struct rc_err *err)
{
    enum {
        PASSES = 50
    };
    struct rc_joint *j = calloc(1, sizeof *j);
    struct rc_slip_problem slip;
    struct rc_problem contact;

    if (j == NULL) {
        rc_err_set(err, "out of memory for the friction of %zu x %zu nodes", shape->nx, shape->ny);
        return NULL;
    }
    *j = (struct rc_joint){
        .shape = *shape, .most = p->max_passes > 0 ? p->max_passes : PASSES, .approach = NAN};
    if (!problems(p, &contact, &slip, &j->alternates, err))
        goto fail;
    if (j->alternates && h == NULL) {
        rc_err_set(err, "the pressure of dissimilar bodies feels their tractions: heights are "
                        "needed, or another coupling");
        goto fail;
    }
    if ((j->slip = rc_slip_new(shape, &slip, err)) == NULL)
        goto fail;
    j->n = shape->nx * shape->ny;
    j->tol = j->alternates ? 2 * slip.tol : slip.tol;
    if (h != NULL && (j->solver = rc_solver_new(shape, h, &contact, err)) == NULL)
        goto fail;
    if (!allocate(j, h)) {
        rc_err_set(err, "out of memory for the friction of %zu x %zu nodes", shape->nx, shape->ny);
        goto fail;
    }
    if (begin(j, h, err) != RC_OK)
        goto fail;
    return j;
fail:
    rc_joint_free(j);
    return NULL;
}

void
rc_joint_free(struct rc_joint *j)
{
    if (j == NULL)
        return;
    rc_slip_free(j->slip);
    rc_solver_free(j->solver);
    free(j->own);
    free(j->gap);
    free(j->apart);
    free(j->h);
    free(j->less);
    free(j->before[0]);
    free(j->before[1]);
    free(j);
}

size_t
rc_joint_memory(const struct rc_shape *shape, const struct rc_joint_problem *p, bool heights)
{
    struct rc_slip_problem slip;
    struct rc_problem contact;
    bool alternates;
    size_t bytes;

    if (!problems(p, &contact, &slip, &alternates, NULL) ||
        (bytes = rc_slip_memory(shape, &slip)) == 0)
        return 0;
    bytes += sizeof(struct rc_joint);
    if (heights)
        bytes += rc_solver_memory(shape, &contact) +
                 (alternates ? 7 : 3) * shape->nx * shape->ny * sizeof(double);
    return bytes;
}
