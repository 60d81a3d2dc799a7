/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Friction in increments, with history.
 *
 * While a node with a load sticks, T q + C p - delta keeps its value there. This value is `origin`, a map of
 * all nodes. A node that comes into contact later keeps the value at its first contact. An increment finds
 * the tractions of least energy for w = origin - C p. Let the force grow by dF/dP of the load. A node that
 * comes into contact from the gap g0 has then moved by dF/dP (1 + kap/2) g0 before its contact. This is exact
 * for kap = 0, where T equals K in both directions.
 *
 * The code uses the unit sqrt(dx dy)/E* for displacements and sqrt(dx dy) for lengths. So displacements are
 * in Pa, and lengths are numbers.
 */
#include "friction.h"

#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

struct law {
    struct rc_shear shear; /* Pa */
    double mu, tau_max;
};

/* The end of the increment before. */
struct past {
    double *origin[2], *old[2], *slip[2], *gap;
    unsigned char *touched;
    double load, force[2];
    bool has_gap;
};

/* What is given of the present increment. */
struct now {
    const double *gap; /* the caller's */
    double load, limit, force[2];
    bool enters;     /* nodes come into contact at a known gap, */
    double entry[2]; /* and have moved by this multiple of it   */
};

/* The tractions of the present increment. */
struct work {
    struct rc_discs *discs;
    double *pushed[2]; /* C p */
};

struct rc_friction_solver {
    struct rc_shape shape; /* the whole map */
    struct rc_rows rows;   /* held here     */
    size_t n;              /* their nodes   */
    int threads;
    struct law law;
    double cell;
    double unit, length;             /* m/Pa; m */
    struct rc_friction_solver *main; /* has the operator and the work; NULL: this solver */
    struct rc_tangential *t;
    struct rc_discs *discs; /* of `work` */
    double *pushed[2];
    struct work work[2]; /* of the main solver: its own, and that of the others */
    bool coupled, asked, begun, done, apart;
    bool tried; /* this increment was solved before under another pressure, and starts from these
                   tractions */
    enum rc_status last;
    struct past past;
    struct now now;
    struct rc_store own;
};

static double
reach(const struct law *law, double p)
{
    return fmin(law->mu * p, law->tau_max);
}

/* ---- the request ---- */

enum rc_status
rc_friction_solver_set_pressure(struct rc_friction_solver *s, const double *p, const double *gap,
                                struct rc_err *err)
{
    struct rc_total of[2] = {{0, 0}, {0, 0}}; /* load, limit */
    double sum[2], touches = 0;
    size_t bad = 0;

    while (p != NULL && bad < s->n && p[bad] >= 0 && !isinf(p[bad]))
        bad++;
    if (rc_ranks_need(s->rows.ranks, p == NULL || bad == s->n, err,
                      "pressure %g Pa at node %zu: it must be finite and not negative", p[bad],
                      s->rows.first * s->shape.nx + bad) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < s->n; k++) {
        s->discs->g[k] = p == NULL ? 0 : reach(&s->law, p[k]);
        rc_total_add(&of[0], p == NULL ? 0 : p[k]);
        rc_total_add(&of[1], s->discs->g[k]);
        touches = s->discs->g[k] == 0 ? touches : 1;
    }
    rc_ranks_totals(s->rows.ranks, 2, of, sum, 1, &touches);
    s->apart = touches == 0;
    s->now.load = sum[0] * s->cell;
    s->now.limit = sum[1] * s->cell;
    s->now.gap = gap;
    if (s->coupled && p != NULL)
        rc_tangential_pressure(s->t, p, s->pushed);
    else if (s->coupled)
        for (int c = 0; c < 2; c++)
            memset(s->pushed[c], 0, s->n * sizeof(double));
    s->asked = s->begun = s->done = false;
    return RC_OK;
}

static enum rc_status
finite(double x, double y, const char *what, struct rc_err *err)
{
    if (isfinite(x) && isfinite(y))
        return RC_OK;
    return rc_err_set(err, "%s %g, %g: it must be finite", what, x, y);
}

enum rc_status
rc_friction_solver_set_force(struct rc_friction_solver *s, double fx, double fy, struct rc_err *err)
{
    static const double nearest = 1 - 1e-9; /* larger forces cannot be distinguished from sliding */
    double f = hypot(fx, fy);

    if (finite(fx, fy, "tangential force", err) != RC_OK)
        return RC_FAIL;
    if (f > 0 && !(f <= nearest * s->now.limit))
        return rc_err_set(err,
                          "tangential force %.9g N: friction carries less than %.9g N, and under a "
                          "larger force the bodies slide; give a displacement instead",
                          f, s->now.limit);
    s->now.force[0] = s->discs->asked.sum[0] = fx / s->cell;
    s->now.force[1] = s->discs->asked.sum[1] = fy / s->cell;
    s->discs->asked.given = false;
    s->asked = true;
    s->begun = s->done = false;
    return RC_OK;
}

enum rc_status
rc_friction_solver_set_displacement(struct rc_friction_solver *s, double dx, double dy,
                                    struct rc_err *err)
{
    if (finite(dx, dy, "tangential displacement", err) != RC_OK ||
        rc_discs_check_datum(s->discs, s->length, err) != RC_OK)
        return RC_FAIL;
    s->discs->delta[0] = dx / s->unit;
    s->discs->delta[1] = dy / s->unit;
    s->discs->asked.given = true;
    s->asked = true;
    s->begun = s->done = false;
    return RC_OK;
}

/* ---- an increment ---- */

/* Relative to the load: smaller changes are rounding. A load that grew by rounding would move nodes
 * before they touch. */
static const double grows = 1e-6;

/* The displacement w that node k keeps while it sticks; loaded: it carries a load in this increment. */
static inline double
kept_at(const struct rc_friction_solver *s, int c, size_t k, bool loaded)
{
    const double w = s->past.origin[c][k] - (s->coupled ? s->pushed[c][k] : 0);

    return s->now.enters && loaded && !s->past.touched[k] ? w - s->now.entry[c] * s->past.gap[k]
                                                          : w;
}

/* Sets w and the start: the last tractions, and the change of the force in proportion to g. If the increment
 * was solved under another pressure, it starts from those tractions, with slipping nodes moved to their new
 * circles. Otherwise these nodes would stick at first and slip again one after another. */
static void
pose(struct rc_friction_solver *s)
{
    struct rc_discs *d = s->discs;
    double more[2] = {0, 0};

    s->now.enters = s->past.has_gap && !d->asked.given && s->now.load > s->past.load * (1 + grows);
    for (int c = 0; c < 2 && !d->asked.given; c++) {
        if (s->now.limit > 0)
            more[c] = (s->now.force[c] - s->past.force[c]) * s->cell / s->now.limit;
        if (s->now.enters)
            s->now.entry[c] = (1 + s->law.shear.kap / 2) * (s->now.force[c] - s->past.force[c]) *
                              s->cell / (s->now.load - s->past.load) / s->unit;
    }
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (size_t k = 0; k < s->n; k++) {
        const double size = hypot(d->q[0][k], d->q[1][k]);
        for (int c = 0; c < 2; c++) {
            d->w[c][k] = kept_at(s, c, k, d->g[k] > 0);
            if (!s->tried)
                d->q[c][k] = s->past.old[c][k] + more[c] * d->g[k];
            else if (d->face[k] == RC_FACE_SLIP && size > 0)
                d->q[c][k] *= d->g[k] / size;
        }
    }
}

enum rc_status
rc_friction_solver_step(struct rc_friction_solver *s, struct rc_err *err)
{
    if (!s->asked)
        return rc_err_set(err, "neither a force nor a displacement has been set");
    if (s->done)
        return s->last;
    if (s->apart) { /* no node is in contact: the tractions are 0, and the displacement restarts
                       from 0 */
        pose(s);
        for (int c = 0; c < 2; c++) {
            s->discs->delta[c] = 0;
            memset(s->discs->q[c], 0, s->n * sizeof(double));
            memset(s->discs->u[c], 0, s->n * sizeof(double));
        }
        s->discs->found.estimate = 0;
        s->discs->found.stick = s->discs->found.slipping = 0;
        s->discs->found.slip = s->discs->found.residual = 0;
        memset(s->discs->face, RC_FACE_OFF, s->n);
        s->last = RC_OK;
        s->done = true;
        return RC_OK;
    }
    if (!s->begun) {
        pose(s);
        rc_discs_begin(s->discs);
        s->begun = true;
        return RC_MORE;
    }
    s->last = rc_discs_step(s->discs);
    s->done = s->last != RC_MORE;
    s->tried = s->tried || s->done;
    return s->last;
}

void
rc_friction_solver_start(struct rc_friction_solver *s, const double *const q[2])
{
    for (int c = 0; c < 2; c++)
        memmove(s->discs->q[c], q[c], s->n * sizeof(double));
    memset(s->discs->face, RC_FACE_OFF, s->n);
    s->tried = true;
}

/* Touched nodes are 1 in a map of zeros. A map that was read has them where a number is above 0. */
static void
exchange_touched(struct rc_friction_solver *s, struct rc_state *state)
{
    const double *from = NULL;
    double *to = NULL;

    if (rc_state_reads(state))
        from = rc_state_read_map(state, s->n);
    else
        to = rc_state_map(state, s->n, NULL);
    for (size_t k = 0; k < s->n && to != NULL; k++)
        to[k] = s->past.touched[k];
    for (size_t k = 0; k < s->n && from != NULL; k++)
        s->past.touched[k] = from[k] > 0;
}

void
rc_friction_solver_history(struct rc_friction_solver *s, struct rc_state *state)
{
    double *maps[] = {s->past.origin[0], s->past.origin[1], s->past.old[0], s->past.old[1],
                      s->past.slip[0],   s->past.slip[1],   s->past.gap};

    RC_STATE_FLAGS(state, &s->past.has_gap, &s->apart);
    for (size_t k = 0; k < sizeof maps / sizeof *maps; k++)
        rc_state_map(state, s->n, maps[k]);
    exchange_touched(s, state);
    rc_state_finite(state, 1, &s->past.load);
    rc_state_finite(state, 2, s->past.force);
    if (!rc_state_reads(state))
        return;
    s->asked = s->begun = s->done = s->tried = false;
    for (int c = 0; c < 2; c++)
        memcpy(s->discs->q[c], s->past.old[c], s->n * sizeof(double));
    memset(s->discs->face, RC_FACE_OFF, s->n);
}

void
rc_friction_solver_increment(struct rc_friction_solver *s, struct rc_state *state)
{
    for (int c = 0; c < 2; c++)
        rc_state_map(state, s->n, s->discs->q[c]);
    if (rc_state_reads(state))
        s->tried = true;
}

/* The slip of a node in this increment, in units of `unit`. The slip of a sticking node is 0; its residual is
 * an error. */
static inline double
slipped(const struct rc_friction_solver *s, int c, size_t k)
{
    const struct rc_discs *d = s->discs;

    return d->face[k] == RC_FACE_SLIP ? d->u[c][k] - kept_at(s, c, k, true) - d->delta[c] : 0;
}

void
rc_friction_solver_keep(struct rc_friction_solver *s)
{
    struct rc_discs *d = s->discs;

    if (!s->done)
        return;
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (size_t k = 0; k < s->n; k++) {
        for (int c = 0; c < 2; c++) {
            s->past.slip[c][k] = s->apart ? 0 : s->past.slip[c][k] + slipped(s, c, k);
            s->past.origin[c][k] = d->u[c][k] + (s->coupled ? s->pushed[c][k] : 0) - d->delta[c];
            s->past.old[c][k] = d->q[c][k];
        }
        s->past.touched[k] = d->face[k] != RC_FACE_OFF;
    }
    s->past.has_gap = s->now.gap != NULL;
    if (s->past.has_gap)
        memcpy(s->past.gap, s->now.gap, s->n * sizeof *s->now.gap);
    s->past.load = s->now.load;
    for (int c = 0; c < 2; c++) {
        struct rc_total sum = {0};
        for (size_t k = 0; k < s->n; k++)
            rc_total_add(&sum, d->q[c][k]);
        s->past.force[c] = rc_ranks_total(s->rows.ranks, sum);
    }
    s->asked = s->begun = s->done = s->tried = false;
}

/* ---- results ---- */

/* Where the load falls, the traction of the increment is the mean of its start and its end. Otherwise the
 * traction at the end is used, which is exact under a constant load. */
static double
dissipated_at(const struct rc_friction_solver *s, int c, size_t k)
{
    const double mean = s->now.load < s->past.load ? 0.5 : 1;

    return -(mean * s->discs->q[c][k] + (1 - mean) * s->past.old[c][k]) * slipped(s, c, k);
}

static double
dissipated(const struct rc_friction_solver *s)
{
    struct rc_total sum = {0};

    for (size_t k = 0; k < s->n; k++)
        for (int c = 0; c < 2; c++)
            rc_total_add(&sum, dissipated_at(s, c, k));
    return rc_ranks_total(s->rows.ranks, sum) * s->cell * s->unit;
}

void
rc_friction_solver_add_dissipation(const struct rc_friction_solver *s, double *to)
{
    for (size_t k = 0; k < s->n; k++)
        to[k] += (dissipated_at(s, 0, k) + dissipated_at(s, 1, k)) * s->unit;
}

void
rc_friction_solver_result(struct rc_friction_solver *s, struct rc_friction_increment *f)
{
    const struct rc_discs *d = s->discs;

    *f = (struct rc_friction_increment){.load = s->now.load,
                                        .limit = s->now.limit,
                                        .stick_nodes = d->found.stick,
                                        .slip_nodes = d->found.slipping,
                                        .stick_area = (double)d->found.stick * s->cell,
                                        .slip_area = (double)d->found.slipping * s->cell,
                                        .stick_fraction = NAN,
                                        .dissipated = dissipated(s),
                                        .largest_slip = d->found.slip * s->unit,
                                        .slip_error = d->found.residual * s->unit,
                                        .traction_error = d->found.estimate,
                                        .steps = d->found.steps,
                                        .convolutions = s->t->convolutions,
                                        .converged = s->done && s->last == RC_OK};
    for (int c = 0; c < 2; c++) {
        struct rc_total sum = {0};
        for (size_t k = 0; k < s->n; k++)
            rc_total_add(&sum, d->q[c][k]);
        f->force[c] = rc_ranks_total(s->rows.ranks, sum) * s->cell;
        f->displacement[c] = d->delta[c] * s->unit;
    }
    if (d->found.stick + d->found.slipping > 0)
        f->stick_fraction = f->stick_area / (f->stick_area + f->slip_area);
    f->stiffness = hypot(f->force[0], f->force[1]) / hypot(f->displacement[0], f->displacement[1]);
    /* a force of the order of rounding gives no stiffness */
    if (!isfinite(f->stiffness) || hypot(f->force[0], f->force[1]) <= 1e-12 * f->limit)
        f->stiffness = NAN;
}

const double *
rc_friction_solver_traction(const struct rc_friction_solver *s, int direction)
{
    return s->discs->q[direction];
}

const double *
rc_friction_solver_kept(const struct rc_friction_solver *s, int direction)
{
    return s->past.old[direction];
}

double
rc_friction_solver_convolutions(const struct rc_friction_solver *s)
{
    return s->t->convolutions;
}

/* The slip of a node since the bodies touched. */
static inline double
slipped_in_all(const struct rc_friction_solver *s, int c, size_t k)
{
    return s->apart ? 0 : (s->past.slip[c][k] + (s->done ? slipped(s, c, k) : 0)) * s->unit;
}

void
rc_friction_solver_slip(const struct rc_friction_solver *s, int direction, double *to)
{
    for (size_t k = 0; k < s->n; k++)
        to[k] = slipped_in_all(s, direction, k);
}

double
rc_friction_solver_largest_slip(const struct rc_friction_solver *s)
{
    double most = 0;

    for (size_t k = 0; k < s->n; k++)
        most = fmax(most, hypot(slipped_in_all(s, 0, k), slipped_in_all(s, 1, k)));
    return rc_ranks_most(s->rows.ranks, most);
}

void
rc_friction_solver_state(const struct rc_friction_solver *s, double *to)
{
    for (size_t k = 0; k < s->n; k++)
        to[k] = s->discs->face[k] == RC_FACE_STICK ? 1 : s->discs->face[k] == RC_FACE_SLIP ? 2 : 0;
}

void
rc_friction_solver_normal(struct rc_friction_solver *s, double *uz)
{
    memset(uz, 0, s->n * sizeof *uz);
    if (!s->coupled)
        return;
    rc_tangential_normal(s->t, s->discs->q, uz);
    for (size_t k = 0; k < s->n; k++)
        uz[k] *= s->unit;
}

#define FIGURE(member) RC_FIGURE(struct rc_friction_figures, member)
#define AS(column, member) RC_FIGURE_AS(column, struct rc_friction_figures, member)
const struct rc_figure rc_figures_friction[] = {
    {AS("load", last.load), "N", "Load", .says = "sum of the pressure"},
    {AS("limit", last.limit), "N", "Largest tangential force", .says = "that friction can carry"},
    {AS("tangential_x", last.force[0]), "N", "Force along x"},
    {AS("tangential_y", last.force[1]), "N", "Force along y"},
    {AS("displacement_x", last.displacement[0]), "m", "Displacement along x"},
    {AS("displacement_y", last.displacement[1]), "m", "Displacement along y"},
    {FIGURE(approach), "m", "Approach", .says = "of the bodies, from first touch"},
    {AS("stick_nodes", last.stick_nodes), NULL, "Nodes that stick"},
    {AS("slip_nodes", last.slip_nodes), NULL, "Nodes that slip"},
    {AS("stick_area", last.stick_area), "m2", "Area that sticks"},
    {AS("slip_area", last.slip_area), "m2", "Area that slips"},
    {AS("stick_fraction", last.stick_fraction), NULL, "Part of the contact that sticks"},
    {AS("largest_slip", last.largest_slip), "m", "Largest slip of the last increment",
     .says = "alone: it falls as the number of increments rises", .role = RC_FIGURE_CHECK},
    {FIGURE(largest_slip_total), "m", "Largest slip", .says = "since the bodies touched"},
    {AS("tangential_stiffness", last.stiffness), "N/m", "Tangential stiffness"},
    {AS("dissipated_energy", last.dissipated), "J", "Dissipated energy"},
    {FIGURE(passes), NULL, "Passes", .role = RC_FIGURE_COST},
    {FIGURE(convolutions), NULL, "Convolutions", .role = RC_FIGURE_COST},
    {AS("iteration_error_estimate", traction_error), NULL, "Error of the iteration",
     .role = RC_FIGURE_ERROR, .by = "tol", .of = "traction-x"},
    {AS("inherited_error_estimate", inherited_error), NULL, "Error of earlier loads",
     .says = "of the increments before", .role = RC_FIGURE_ERROR, .by = "tol", .of = "traction-x"},
    {AS("contact_error_estimate", contact_error), NULL, "Error of the contacts",
     .role = RC_FIGURE_ERROR, .by = "tol", .of = "traction-x"},
    {AS("increment_error_estimate", increment_error), NULL, "Error of the increments",
     .says = "of too few increments", .role = RC_FIGURE_ERROR, .by = "increments",
     .of = "traction-x"},
    {0},
};

/* ---- plan ---- */

enum rc_status
rc_friction_solver_check(const struct rc_shape *shape, const struct rc_friction_law *p,
                         struct rc_shear *shear, struct rc_err *err)
{
    if (rc_shape_check(shape, err) != RC_OK)
        return RC_FAIL;
    if (!(p->mu > 0) || isinf(p->mu))
        return rc_err_set(err, "coefficient of friction %g: it must be positive and finite", p->mu);
    if (!(p->tau_max >= 0))
        return rc_err_set(err, "largest traction %g Pa: it must not be negative", p->tau_max);
    if (!(p->tol >= 0 && p->tol < 1))
        return rc_err_set(err, "tolerance %g: it must be below 1 and not negative", p->tol);
    return rc_pair_shear(&p->pair, p->nu, shear, err);
}

static bool
allocate(struct rc_friction_solver *s)
{
    double **maps[] = {&s->past.origin[0], &s->past.origin[1], &s->past.old[0], &s->past.old[1],
                       &s->past.slip[0],   &s->past.slip[1],   &s->past.gap};

    for (size_t k = 0; k < sizeof maps / sizeof *maps; k++)
        *maps[k] = rc_store_zeros(&s->own, s->n, sizeof **maps[k]);
    s->past.touched = rc_store_zeros(&s->own, s->n, 1);
    return !s->own.failed;
}

static enum rc_status
has_memory(const struct rc_friction_solver *s, bool has, struct rc_err *err)
{
    return rc_ranks_need(s->rows.ranks, has, err,
                         "out of memory for the friction of %zu x %zu nodes", s->shape.nx,
                         s->shape.ny);
}

/* Takes work k of the main solver, and makes it where it is missing. */
static enum rc_status
take_work(struct rc_friction_solver *s, size_t k, double tol, size_t most, struct rc_err *err)
{
    /* Increments have errors of about 1e-2: the iteration adds little to them. */
    static const double usual = 1e-4;
    struct rc_friction_solver *main = s->main == NULL ? s : s->main;
    struct work *w = &main->work[k];

    if (w->discs == NULL) {
        w->discs = k == 0 ? rc_discs_new(main->t, err) : rc_discs_beside(main->work->discs, err);
        if (w->discs == NULL)
            return RC_FAIL;
        for (int c = 0; c < 2 && main->coupled; c++)
            w->pushed[c] = rc_store_zeros(&main->own, main->n, sizeof *w->pushed[c]);
        if (has_memory(main, !main->own.failed, err) != RC_OK)
            return RC_FAIL;
        w->discs->asked.tol = tol > 0 ? tol : usual;
        if (most > 0)
            w->discs->asked.most = most;
    }
    s->discs = w->discs;
    memcpy(s->pushed, w->pushed, sizeof s->pushed);
    return RC_OK;
}

struct rc_friction_solver *
rc_friction_solver_new(const struct rc_shape *shape, const struct rc_friction_law *p,
                       struct rc_err *err)
{
    struct rc_shear shear, inside;
    struct rc_shape unit;
    struct rc_boundary boundary = p->boundary;
    RC_OWN(rc_friction_solver, s) = NULL;

    if (rc_friction_solver_check(shape, p, &shear, err) != RC_OK)
        return NULL;
    s = calloc(1, sizeof *s);
    if (rc_ranks_need(p->ranks, s != NULL, err, "out of memory for friction") != RC_OK)
        return NULL;
    *s = (struct rc_friction_solver){.shape = *shape,
                                     .rows = rc_rows_of(p->ranks, shape),
                                     .threads = rc_useful_threads(shape, p->threads),
                                     .law = {shear, p->mu, p->tau_max > 0 ? p->tau_max : INFINITY},
                                     .cell = shape->dx * shape->dy,
                                     .length = sqrt(shape->dx) * sqrt(shape->dy),
                                     .coupled = shear.beta != 0 && !p->uncoupled,
                                     .apart = true};
    s->n = s->rows.n * shape->nx;
    s->unit = s->length / shear.estar;
    unit = (struct rc_shape){shape->nx, shape->ny, shape->dx / s->length, shape->dy / s->length};
    boundary.datum /= s->length;
    inside = (struct rc_shear){1, shear.kap, s->coupled ? shear.beta : 0};
    if (has_memory(s, allocate(s), err) != RC_OK)
        return NULL;
    s->t = rc_tangential_new(s->rows.ranks, &unit, boundary, &inside, p->threads, err);
    if (s->t == NULL || take_work(s, 0, p->tol, p->max_steps, err) != RC_OK)
        return NULL;
    return rc_give(&s);
}

struct rc_friction_solver *
rc_friction_solver_beside(struct rc_friction_solver *main, double tol, struct rc_err *err)
{
    RC_OWN(rc_friction_solver, s) = calloc(1, sizeof *s);

    if (rc_ranks_need(main->rows.ranks, s != NULL, err, "out of memory for friction") != RC_OK)
        return NULL;
    *s = (struct rc_friction_solver){.shape = main->shape,
                                     .rows = main->rows,
                                     .n = main->n,
                                     .threads = main->threads,
                                     .law = main->law,
                                     .cell = main->cell,
                                     .unit = main->unit,
                                     .length = main->length,
                                     .main = main,
                                     .t = main->t,
                                     .coupled = main->coupled,
                                     .apart = true};
    if (has_memory(s, allocate(s), err) != RC_OK)
        return NULL;
    return take_work(s, 1, tol, main->discs->asked.most, err) == RC_OK ? rc_give(&s) : NULL;
}

void
rc_friction_solver_free(struct rc_friction_solver *s)
{
    if (s == NULL)
        return;
    for (size_t k = 2; k-- > 0;)
        rc_discs_free(s->work[k].discs);
    if (s->main == NULL)
        rc_tangential_free(s->t);
    rc_store_free(&s->own);
    free(s);
}
