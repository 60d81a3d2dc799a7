/*
 * The model of friction: rc_slip under the pressure of an inner model. Friction depends on the path, so
 * load, force and displacement change in proportion from point to point, in increments. Tractions between
 * dissimilar bodies move the surface along its normal: then the inner model gets heights without this
 * displacement, and pressure and tractions are found in turn, as in joint.c.
 */
#include "slip.h"

#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

enum stage {
    REST,     /* an increment is kept                       */
    PRESSING, /* the inner model steps                      */
    SLIDING,  /* rc_slip steps, under the pressure p        */
    THERE     /* the increment is solved                    */
};

struct friction {
    struct rc_model base;
    struct rc_friction_problem problem;
    size_t n;
    double tol;
    bool alternates;
    struct rc_slip *slip;
    double *h, *less, *p, *gap;        /* less: heights of the inner model                      */
    double *before[2], *slip_start[2]; /* tractions of the previous pass; those of a state */
    struct rc_point reached;           /* the last kept point, with the found axes too          */
    /* of the way to the point */
    size_t increment, increments;
    double dissipated, inherited[2]; /* J, since the last point kept; Pa, as in joint.c   */
    bool good;                       /* all contacts and increments have converged        */
    bool again;                      /* a state was read: its contact must be solved again */
    /* of the increment */
    size_t stage, passes;
    double pressure_change, traction_change, factor, lowered, pressure_error;
    double convolutions; /* of all contacts */
    struct rc_joint_figures figures;
};

static const struct rc_figure own_figures[] = {
    {RC_FIGURE(struct friction, increments), NULL, "Increments", .role = RC_FIGURE_COST}, {0}};
static const struct rc_figure_set sets[] = {
    {rc_figures_slip, offsetof(struct friction, figures)}, {own_figures, 0}, {NULL, 0}};

enum {
    TRACTION_X,
    TRACTION_Y,
    SLIP_X,
    SLIP_Y,
    STATE
};
static const struct rc_frame_kind frames[] = {
    [TRACTION_X] = {"traction-x", "Pa", "Traction along x"},
    [TRACTION_Y] = {"traction-y", "Pa", "Traction along y"},
    [SLIP_X] = {"slip-x", "m", "Slip along x"},
    [SLIP_Y] = {"slip-y", "m", "Slip along y"},
    [STATE] = {"state", "1", "State"},
    {NULL, NULL, NULL},
};

/* ---- an increment ---- */

static bool
moves(const struct friction *f)
{
    return rc_point_has(&f->base.to, RC_SHIFT_X);
}

static struct rc_point
end_of_increment(const struct friction *f)
{
    return rc_point_between(&f->reached, &f->base.to, (double)f->increment / (double)f->increments);
}

/* Gives the inner model the heights less the normal displacement due to the present tractions. */
static enum rc_status
lower_heights(struct friction *f, struct rc_err *err)
{
    double top = -INFINITY, less = -INFINITY;

    rc_slip_normal(f->slip, f->less);
    for (size_t k = 0; k < f->n; k++) {
        f->less[k] = f->h[k] - f->less[k];
        top = fmax(top, f->h[k]);
        less = fmax(less, f->less[k]);
    }
    f->lowered = top - less;
    return rc_model_set_heights(f->base.inner, f->less, err);
}

/* Sends the inner model to the end of the increment. */
static enum rc_status
press(struct friction *f, struct rc_err *err)
{
    const struct rc_point at = end_of_increment(f);
    struct rc_point to = rc_point_for(f->base.inner, &at);

    if (f->alternates && lower_heights(f, err) != RC_OK)
        return RC_FAIL;
    to.at[RC_APPROACH] -= f->lowered; /* counted from first touch of the heights h */
    f->stage = PRESSING;
    f->again = false;
    return rc_model_go(f->base.inner, &to, err) == RC_MORE ? RC_MORE : RC_FAIL;
}

static enum rc_status
begin_increment(struct friction *f, struct rc_err *err)
{
    f->increment++;
    f->passes = 0;
    f->pressure_change = f->traction_change = f->factor = f->pressure_error = 0;
    return press(f, err);
}

static enum rc_status
go(struct rc_model *m, struct rc_err *err)
{
    enum {
        USUAL = 16
    };
    struct friction *f = (struct friction *)m;

    if (rc_point_has(&m->to, RC_FORCE_X) != rc_point_has(&m->to, RC_FORCE_Y))
        return rc_err_set(err, "a force along one direction and a displacement along the other: "
                               "give two forces or two displacements");
    f->increments = f->problem.increments > 0 ? f->problem.increments : USUAL;
    f->increment = 0;
    f->dissipated = 0;
    f->good = true;
    return begin_increment(f, err) == RC_MORE ? RC_OK : RC_FAIL;
}

/* Gives rc_slip the pressure, and the force or displacement at the end of the increment. */
static enum rc_status
pose(struct friction *f, struct rc_err *err)
{
    const struct rc_point at = end_of_increment(f);

    f->stage = SLIDING;
    if (rc_slip_set_pressure(f->slip, f->p, f->gap, err) != RC_OK)
        return RC_FAIL;
    return moves(f) ? rc_slip_set_displacement(f->slip, at.at[RC_SHIFT_X], at.at[RC_SHIFT_Y], err)
                    : rc_slip_set_force(f->slip, at.at[RC_FORCE_X], at.at[RC_FORCE_Y], err);
}

static enum rc_status
step_contact(struct friction *f, struct rc_err *err)
{
    struct rc_model *inner = f->base.inner;
    enum rc_status status = rc_model_step(inner, err);
    const double *p = f->less; /* a buffer here: lower_heights() fills it again */
    double error;

    if (status == RC_MORE || status == RC_FAIL)
        return status;
    f->good = f->good && status == RC_OK;
    if (rc_model_look(inner, NULL, err) != RC_OK ||
        rc_model_frame(inner, "pressure", f->less, err) != RC_OK ||
        rc_model_frame(inner, "gap", f->gap, err) != RC_OK)
        return RC_FAIL;
    f->pressure_change = rc_slip_take(f->n, 1, &p, &f->p);
    f->convolutions += rc_model_number(inner, "convolutions");
    error = rc_model_number(inner, "pressure_error_estimate");
    f->pressure_error = isnan(error) ? 0 : error; /* of bodies that are apart */
    return pose(f, err) == RC_OK ? RC_MORE : RC_FAIL;
}

/* Returns the sum of |q| over the map, Pa. add: the errors of that sum that this increment adds: error of its
 * iteration, and error due to the pressure, which limits |q|. */
static double
added(const struct friction *f, double error, double limit, double add[2])
{
    const double *q[2] = {rc_slip_traction(f->slip, 0), rc_slip_traction(f->slip, 1)};
    struct rc_total sum = {0};
    double size;

    for (size_t k = 0; k < f->n; k++)
        rc_total_add(&sum, hypot(q[0][k], q[1][k]));
    size = rc_total_value(&sum);
    add[0] = size > 0 ? error * size : 0;
    add[1] = f->pressure_error * limit / (f->base.shape.dx * f->base.shape.dy);
    return size;
}

static void
find_figures(struct friction *f)
{
    struct rc_joint_figures *to = &f->figures;
    double size, add[2];

    *to = (struct rc_joint_figures){.passes = f->passes,
                                    .pressure_change = f->pressure_change,
                                    .traction_change = f->traction_change};
    rc_slip_result(f->slip, &to->slip);
    to->traction_error = to->slip.traction_error + f->factor * f->traction_change;
    size = added(f, to->traction_error, to->slip.limit, add);
    to->inherited_error = size > 0 ? f->inherited[0] / size : 0;
    to->contact_error = size > 0 ? (f->inherited[1] + add[1]) / size : 0;
    to->convolutions = to->slip.convolutions + f->convolutions;
    to->converged = f->stage == THERE && f->good;
}

/* The increment becomes history, also of the inner model. Bodies that are apart inherit no error. */
static enum rc_status
keep_increment(struct friction *f, struct rc_err *err)
{
    double add[2];

    find_figures(f);
    added(f, f->figures.traction_error, f->figures.slip.limit, add);
    for (int k = 0; k < 2; k++)
        f->inherited[k] = f->figures.slip.load > 0 ? f->inherited[k] + add[k] : 0;
    f->dissipated += f->figures.slip.dissipated;
    rc_slip_keep(f->slip);
    f->stage = REST;
    return rc_model_keep(f->base.inner, err);
}

static enum rc_status
slide(struct friction *f, struct rc_err *err)
{
    enum {
        PASSES = 50
    };
    const double *q[2] = {rc_slip_traction(f->slip, 0), rc_slip_traction(f->slip, 1)};
    const size_t most = f->problem.max_passes > 0 ? f->problem.max_passes : PASSES;
    const double before = f->traction_change;
    enum rc_status status = rc_slip_step(f->slip, err);

    if (status == RC_MORE || status == RC_FAIL)
        return status;
    f->passes++;
    if (f->alternates) {
        f->traction_change = rc_slip_take(f->n, 2, q, f->before);
        f->factor = rc_slip_left_over(f->passes, f->traction_change, before);
        if (f->factor * fmax(f->traction_change, f->pressure_change) > f->tol / 2) {
            if (f->passes < most)
                return press(f, err);
            status = RC_SHORT;
        }
    }
    f->good = f->good && status == RC_OK;
    f->stage = THERE;
    if (f->increment == f->increments)
        return f->good ? RC_OK : RC_SHORT;
    return keep_increment(f, err) == RC_OK ? begin_increment(f, err) : RC_FAIL;
}

static enum rc_status
step(struct rc_model *m, struct rc_err *err)
{
    struct friction *f = (struct friction *)m;

    if (f->again)
        return press(f, err);
    return f->stage == PRESSING ? step_contact(f, err) : slide(f, err);
}

/* ---- results ---- */

/* Solves the point of a state again, starting from the tractions of the state. */
static enum rc_status
find_again(struct friction *f, struct rc_err *err)
{
    enum rc_status status = RC_MORE;

    while (status == RC_MORE)
        status = step(&f->base, err);
    return status;
}

static enum rc_status
look(struct rc_model *m, struct rc_point *at, struct rc_err *err)
{
    static const enum rc_axis axis[2][2] = {{RC_FORCE_X, RC_FORCE_Y}, {RC_SHIFT_X, RC_SHIFT_Y}};
    struct friction *f = (struct friction *)m;
    struct rc_joint_figures *to = &f->figures;
    const bool moved = moves(f);

    if (f->again && m->status != RC_MORE &&
        (find_again(f, err) == RC_FAIL || rc_model_look(m->inner, at, err) != RC_OK))
        return RC_FAIL;
    if (!rc_point_has(&m->to, RC_APPROACH))
        at->at[RC_APPROACH] += f->lowered;
    if (f->stage != REST) { /* at rest the figures are those of the kept point */
        find_figures(f);
        to->slip.dissipated += f->dissipated;
        to->approach = at->at[RC_APPROACH];
    }
    for (int c = 0; c < 2; c++)
        at->at[axis[moved ? 0 : 1][c]] = moved ? to->slip.force[c] : to->slip.displacement[c];
    return RC_OK;
}

static enum rc_status
keep(struct rc_model *m, struct rc_err *err)
{
    struct friction *f = (struct friction *)m;
    struct rc_joint_figures figures;
    struct rc_point at;

    if (rc_model_look(m, &at, err) != RC_OK)
        return RC_FAIL;
    for (int k = 0; k < RC_AXES; k++)
        if (isfinite(at.at[k]))
            f->reached.at[k] = at.at[k];
    figures = f->figures;
    if (keep_increment(f, err) != RC_OK)
        return RC_FAIL;
    f->figures = figures;
    return RC_OK;
}

static enum rc_status
fill(struct rc_model *m, size_t frame, double *to, struct rc_err *err)
{
    struct friction *f = (struct friction *)m;

    (void)err;
    if (frame == STATE)
        rc_slip_state(f->slip, to);
    else if (frame == SLIP_X || frame == SLIP_Y)
        rc_slip_slip(f->slip, (int)frame - SLIP_X, to);
    else
        memcpy(to, rc_slip_traction(f->slip, (int)frame - TRACTION_X), f->n * sizeof *to);
    return RC_OK;
}

/* The new heights apply from the next increment on. */
static enum rc_status
set_heights(struct rc_model *m, const double *h, struct rc_err *err)
{
    struct friction *f = (struct friction *)m;

    memcpy(f->h, h, f->n * sizeof *h);
    return rc_model_set_heights(m->inner, h, err);
}

/* ---- states ---- */

/* The tractions on the way to a point. The state of the inner model holds the pressure only while that
 * model steps; afterwards the contact is solved again when the state was read. */
static void
exchange_increment(struct friction *f, struct rc_state *s)
{
    double *q[2] = {f->slip_start[0], f->slip_start[1]};
    struct rc_err err;

    for (int c = 0; c < 2; c++) {
        if (!rc_state_reads(s))
            memcpy(q[c], rc_slip_traction(f->slip, c), f->n * sizeof **q);
        rc_state_numbers(s, f->n, q[c]);
    }
    if (!rc_state_reads(s))
        return;
    rc_slip_start(f->slip, (const double *const *)q);
    f->again = f->stage != PRESSING;
    if (f->alternates && lower_heights(f, &err) != RC_OK)
        rc_state_refuse(s, "its heights are impossible");
}

static void
state(struct rc_model *m, struct rc_state *s)
{
    struct friction *f = (struct friction *)m;
    double *numbers[] = {&f->dissipated,     &f->pressure_change, &f->traction_change, &f->factor,
                         &f->pressure_error, &f->inherited[0],    &f->inherited[1]};
    size_t good = f->good;

    rc_state_count(s, &f->stage, THERE);
    rc_state_count(s, &f->increment, SIZE_MAX / 2);
    rc_state_count(s, &f->increments, SIZE_MAX / 2);
    rc_state_count(s, &f->passes, SIZE_MAX / 2);
    rc_state_count(s, &good, 1);
    rc_state_numbers(s, RC_AXES, f->reached.at);
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        rc_state_numbers(s, 1, numbers[k]);
    rc_slip_history(f->slip, s);
    for (int c = 0; c < 3 && f->alternates; c++) /* of the previous pass */
        rc_state_numbers(s, f->n, c < 2 ? f->before[c] : f->p);
    f->good = good;
    f->again = false;
    if (f->stage != REST)
        exchange_increment(f, s);
}

static void
progress(const struct rc_model *m, struct rc_loops *l)
{
    const struct friction *f = (const struct friction *)m;

    rc_loops_add(l, "increment", NULL, (double)f->increment, (double)f->increments);
}

static void
release(struct rc_model *m)
{
    struct friction *f = (struct friction *)m;

    rc_slip_free(f->slip);
    free(f->h); /* and the maps behind it */
}

const struct rc_model_row rc_model_friction = {
    .name = "friction",
    .summary = "friction over an inner model",
    .needs = 1u << RC_FORCE_X | 1u << RC_FORCE_Y,
    .takes = 1u << RC_FORCE_X | 1u << RC_FORCE_Y | 1u << RC_SHIFT_X | 1u << RC_SHIFT_Y,
    .figures = sets,
    .frame = frames,
    .go = go,
    .step = step,
    .look = look,
    .fill = fill,
    .state = state,
    .free = release,
    .keep = keep,
    .heights = set_heights,
    .progress = progress,
};

/* ---- the maker ---- */

/* Begins with separated bodies: the gap before contact shows which nodes came into contact later. */
static enum rc_status
begin(struct friction *f, struct rc_err *err)
{
    enum rc_status status;
    struct rc_contact apart;

    rc_contact_apart(NULL, &f->base.shape, f->h, f->gap, &apart);
    if (rc_slip_set_pressure(f->slip, NULL, f->gap, err) != RC_OK ||
        rc_slip_set_force(f->slip, 0, 0, err) != RC_OK)
        return RC_FAIL;
    while ((status = rc_slip_step(f->slip, err)) == RC_MORE)
        ;
    rc_slip_keep(f->slip);
    return status;
}

static enum rc_status
make(struct friction *f, const double *h, const struct rc_friction_problem *problem,
     struct rc_err *err)
{
    enum {
        MAPS = 8
    };
    static const double usual = 1e-4;
    const struct rc_shape *shape = &f->base.shape;
    struct rc_slip_problem slip = problem->slip;

    f->problem = *problem;
    f->n = shape->nx * shape->ny;
    f->tol = slip.tol > 0 ? slip.tol : usual;
    slip.uncoupled = problem->coupling == RC_COUPLING_NONE;
    if ((f->slip = rc_slip_new(shape, &slip, err)) == NULL)
        return RC_FAIL;
    f->alternates = problem->coupling == RC_COUPLING_FULL && rc_slip_beta(f->slip) != 0;
    if (f->alternates && f->base.inner->row->heights == NULL)
        return rc_err_set(err,
                          "the bodies are dissimilar, so that tractions move the surface, and the "
                          "heights of the %s model cannot change: take another coupling",
                          rc_model_name(f->base.inner));
    if ((f->h = rc_alloc(MAPS * f->n, sizeof *f->h)) == NULL)
        return rc_err_set(err, "out of memory for the friction of %zu x %zu nodes", shape->nx,
                          shape->ny);
    memset(f->h, 0, MAPS * f->n * sizeof *f->h);
    memcpy(f->h, h, f->n * sizeof *h);
    f->less = f->h + f->n;
    f->p = f->h + 2 * f->n;
    f->gap = f->h + 3 * f->n;
    for (int c = 0; c < 2; c++) {
        f->before[c] = f->h + (size_t)(4 + c) * f->n;
        f->slip_start[c] = f->h + (size_t)(6 + c) * f->n;
    }
    return begin(f, err);
}

struct rc_model *
rc_friction_new(struct rc_model *inner, const double *h, const struct rc_friction_problem *problem,
                struct rc_err *err)
{
    struct rc_model *m =
        rc_model_make_outer(&rc_model_friction, sizeof(struct friction), inner, err);

    if (m != NULL && make((struct friction *)m, h, problem, err) == RC_FAIL) {
        rc_model_free(m);
        return NULL;
    }
    return m;
}

const struct rc_joint_figures *
rc_friction_result(const struct rc_model *m)
{
    while (m != NULL && m->row != &rc_model_friction)
        m = m->inner;
    return m != NULL ? &((const struct friction *)m)->figures : NULL;
}
