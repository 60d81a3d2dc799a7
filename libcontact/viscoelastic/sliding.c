/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The model of steady sliding over a viscoelastic half-space. Body 2, rigid or elastic, carries the roughness
 * and slides with the speed v along x over the smooth half-space. In its frame all fields are steady: a wave
 * of wave number qx along x excites the material with the frequency qx v. The displacement of the half-space
 * is the elastic one with the complex compliance of that frequency,
 *
 *     K(q) = 2/|q| J(qx),    J(qx) = 1/E*(-i qx v) + 1/E2* = |J| exp(i d(qx)).
 *
 * J depends on qx only. K is therefore the symmetric operator V = 2/|q| |J(qx)| followed by a filter of the
 * rows, exp(i d): a change of phase. The pressure is that of a contact: p >= 0, g = K p - h - c >= 0,
 * p g = 0. It minimises no energy. It is the fixed point of the reflections of Peaceman and Rachford (Lions
 * and Mercier 1979, SIAM J. Numer. Anal. 16, 964) in the norm of V. Each step is an elastic contact:
 *
 *     p(k) is the pressure of the contact with the operator V and the heights H(k) = h - G(k),
 *     G(k+1) = i tan(d/2) (2 V p(k) + G(k)),    G(0) = 0.
 *
 * At the fixed point G = (K - V) p. The reflection at an elastic contact increases no distance in the norm of
 * V, and the filter multiplies each wave by i tan(d/2). So the error decreases at least by the factor
 * tan(d/2) of the largest phase: 0.4 at tan d = 1, and 0.6 at tan d = 1.7. The simple iteration G(k+1) =
 * (K - V) p(k) has the factor 2 sin(d/2), and sin d with |K|/cos d, the best symmetric operator. No step sums
 * with K itself, and an elastic contact takes few iterations.
 *
 * The error of p follows from the elastic contact with the operator V and the heights h - (K - V) p: there p
 * has the gap of the sliding contact. Its estimate is one for V. K is monotone with the constant cos d in the
 * norm of V, and the estimate over cos d bounds the error in this norm.
 *
 * Waves along y, qx = 0, are the grooves that body 2 leaves. On a periodic map it would meet its own grooves
 * again, and J(0) would be the relaxed compliance at any speed. For a fresh track J(0) is the mean of J over
 * the width of this row of waves, |qx| < pi/Lx.
 *
 * On a free map K, V and d are those of a padded map (wake.c). The pressure is 0 outside the map, and all of
 * this holds with them.
 */
#include <complex.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/expected.h"
#include "libcontact/model/row.h"
#include "libcontact/operator/waves.h"
#include "libcontact/solver/elastic.h"
#include "libcontact/transform/fourier.h"
#include "wake.h"

/* The contacts of the iteration are solved to this part of the last error, and at most to this
 * tolerance. Not sensitive: half and double change the convolutions of 18 runs by less than 1 %
 * together (bench/constants.py). */
static const double of_error = 0.25, loosest = 0.1;
/* Above this tolerance single precision is enough: its error is some 1e-6 of the largest
 * displacement. */
static const double single_floor = 2e-5;
/* Work of a filter, in convolutions: it transforms rows only. It counts in reports. */
static const double of_filter = 0.5;
/* The same on a free map. */
static const double of_wake = 1.2;
static const double usual_tol = 1e-3;
static const double most_tan = 3, most_repeated = 10;
enum {
    /* So that a speed ends: at tan d = 3, error factor tan(d/2) = 0.72, a tolerance of 1e-6 takes 42
     * contacts. Half and double change no bit (18 runs of bench/constants.py). */
    MOST_CONTACTS = 200
};

/* A wave number along x. */
struct wave {
    double factor;        /* |J| E of the inner model                      */
    double complex phase; /* exp(i d) - 1                                  */
    double complex half;  /* i tan(d/2)                                    */
};

struct course {
    double tol;      /* of the present elastic contact                        */
    double estimate; /* relative error of p in the norm of V, times cos d     */
    size_t contacts, iterations;
    double convolutions;
    bool ended; /* the state that was read is that of a last contact     */
    bool done;
};

struct slide {
    struct rc_model base;
    struct rc_problem problem;
    struct rc_sliding_problem law;
    struct rc_shape turned;       /* shape of the inner model: x is along the motion */
    size_t n, all, rows, columns; /* nodes and rows held here; nodes of the map; waves along x */
    double *h, *g, *room;         /* heights, G, and heights of the inner model */
    double top;
    struct wave *wave;
    struct rc_along along;            /* of a periodic map */
    const struct rc_along *compliant; /* of the present speed; NULL: a free map at rest */
    struct rc_line *line;
    struct rc_wake *wake; /* on a free map, at a speed above 0 */
    bool loaded;          /* the wake has the pressure       */
    double complex *row;  /* of each thread */
    int threads;
    double steepest; /* largest tan d                                         */
    double lossy;    /* largest tan delta of the material                     */
    struct course course;
    struct rc_sliding_figures f;
};

const struct rc_figure rc_figures_sliding[] = {
#define FIGURE(member) RC_FIGURE(struct rc_sliding_figures, member)
#define AS(column, member) RC_FIGURE_AS(column, struct rc_sliding_figures, member)
    {FIGURE(speed), "m/s", "Sliding speed", .says = "of body 2 over body 1"},
    {FIGURE(friction), NULL, "Coefficient of friction", .says = "by the losses in the material"},
    {FIGURE(friction_force), "N", "Friction", .says = "opposite to the motion"},
    {FIGURE(friction_by_heights), NULL, "Coefficient of friction by the slopes of body 2",
     .says = "equal on a fine grid", .role = RC_FIGURE_CHECK},
    {AS("friction_error_estimate", friction_error), NULL, "Error of the coefficient of friction",
     .says = "bound of the relative error on this grid, by that of the pressure",
     .role = RC_FIGURE_ERROR, .by = "tol", .of = "friction"},
    {FIGURE(dissipated_power), "W", "Dissipated power",
     .says = "sum of the losses of all waves, which is the friction times the speed"},
    {FIGURE(tan_delta_max), NULL, "Largest tan delta", .says = "of the waves of the map"},
    {FIGURE(track), NULL, "Track"},
    {FIGURE(contacts), NULL, "Contacts", .role = RC_FIGURE_COST,
     .says = "elastic contacts of the iteration"},
    {FIGURE(approach), "m", "Approach", .says = "of the bodies, from first touch"},
    {FIGURE(iterations), NULL, "Iterations", .role = RC_FIGURE_COST},
    {FIGURE(convolutions), NULL, "Convolutions", .role = RC_FIGURE_COST,
     .says = "in equivalents of one in double precision on this grid"},
    {AS("pressure_error_estimate", pressure_error), NULL, "Error of the pressure",
     .says = "estimated relative L1 error", .role = RC_FIGURE_ERROR, .by = "tol", .of = "pressure"},
    {FIGURE(converged), NULL, "Converged", .says = "the error estimate is within the tolerance"},
    {AS("elastic_energy", elastic_energy), "J", "Elastic energy", .says = "unknown here"},
    {0},
};
static const struct rc_figure_set sets[] = {{rc_figures_sliding, offsetof(struct slide, f)},
                                            {NULL, 0}};
static const struct rc_frame_kind frames[] = {RC_CONTACT_FRAME_KINDS, {NULL, NULL, NULL}};

/* ---- the material ---- */

/* J of column k, with the sign of the imaginary part for a positive speed. */
static double complex
compliance(const struct rc_sliding_problem *law, const struct rc_shape *turned, size_t k,
           double speed)
{
    const struct rc_relaxation *r = law->material;
    const double first = 2 * RC_PI / ((double)turned->nx * turned->dx);
    const double omega = first * (double)k * fabs(speed);
    double modulus[2], j[2];

    if (k == 0 && !law->repeats)
        return rc_relaxation_mean_compliance(r, first * fabs(speed) / 2) + law->compliance;
    if (!(omega > 0))
        return 1 / r->relaxed + law->compliance;
    rc_relaxation_dynamic(r, omega, modulus, j);
    return j[0] + law->compliance - I * (2 * k == turned->nx ? 0 : j[1]);
}

static double
factor_of(const void *of, double qx)
{
    const struct slide *s = of;
    const double k = fabs(qx) * (double)s->turned.nx * s->turned.dx / (2 * RC_PI);

    return s->wave[(size_t)fmin(k + 0.5, (double)s->columns - 1)].factor;
}

static void
set_waves(struct slide *s, double speed)
{
    /* about the waves of the roughness that the inner model takes for typical */
    const double typical = cabs(compliance(&s->law, &s->turned, (s->turned.nx + 3) / 4, speed));

    s->steepest = s->lossy = s->along.most = 0;
    for (size_t k = 0; k < s->columns; k++) {
        const double complex j = compliance(&s->law, &s->turned, k, speed);
        const double d = copysign(carg(j), speed);
        s->wave[k] = (struct wave){cabs(j) / typical, cexp(I * d) - 1, I * tan(d / 2)};
        s->steepest = s->lossy = fmax(s->steepest, fabs(tan(d)));
        s->along.most = fmax(s->along.most, s->wave[k].factor);
    }
    s->problem.pair = (struct rc_pair){.estar = 1 / typical};
    s->compliant = !rc_has_mean(s->problem.boundary) ? &s->along : NULL;
}

/* On a free map: the waves of the padded map. A body at rest has none. */
static enum rc_status
set_wake(struct slide *s, double speed, struct rc_err *err)
{
    const struct rc_sliding_medium medium = {s->law.material, s->law.compliance, speed,
                                             1 / s->problem.pair.estar};

    rc_wake_free(s->wake);
    s->wake = NULL;
    s->loaded = false;
    if (!rc_has_mean(s->problem.boundary) || speed == 0)
        return RC_OK;
    if ((s->wake = rc_wake_new(&s->turned, &medium, s->problem.threads, err)) == NULL)
        return RC_FAIL;
    s->compliant = &s->wake->along;
    s->steepest = s->wake->steepest;
    return RC_OK;
}

/* ---- filters of rows ---- */

enum filter {
    PHASE, /* K - V */
    HALF,
    SLOPE, /* the derivative along x            */
    LOSS   /* that of K p, from V p: the part on which p does work */
};

static void
filter_row(const struct slide *s, enum filter which, double *row)
{
    double complex *z = s->row + (size_t)omp_get_thread_num() * s->columns;
    const size_t nx = s->turned.nx;

    rc_line_forward(s->line, row, z);
    for (size_t k = 0; k < s->columns; k++) {
        const double q = 2 * k == nx ? 0 : rc_fourier_q(k, nx, s->turned.dx);
        z[k] *= (which == PHASE  ? s->wave[k].phase
                 : which == HALF ? s->wave[k].half
                                 : I * q * (which == LOSS ? I * cimag(s->wave[k].phase) : 1)) /
                (double)nx;
    }
    rc_line_backward(s->line, z, row);
}

/* The derivative of a map that does not repeat, by central differences. */
static void
differentiate(const struct rc_shape *shape, double *map)
{
    const long n = (long)shape->nx;

    for (size_t j = 0; j < shape->ny; j++) {
        double *row = map + j * shape->nx, last[3] = {row[0], row[0], row[0]};
        for (long i = 0; i < n; i++) {
            const double here = row[i];
            double sum = 0;
            for (long k = 1; k <= 3; k++)
                sum += (double[]){45, -9, 1}[k - 1] / 60 *
                       (row[i + k < n ? i + k : n - 1] - last[k - 1]);
            row[i] = sum / shape->dx;
            last[2] = last[1];
            last[1] = last[0];
            last[0] = here;
        }
    }
}

/* On a free map the wake finds the field of the pressure, except of the slope of the heights. */
static void
filter(struct slide *s, enum filter which, double *map)
{
    if (rc_has_mean(s->problem.boundary) && which == SLOPE) {
        differentiate(&s->turned, map);
        return;
    }
    s->course.convolutions += s->wake != NULL ? of_wake : of_filter;
    if (s->wake != NULL) {
        if (!s->loaded)
            rc_wake_load(s->wake, rc_elastic_pressure(s->base.inner));
        s->loaded = true;
        rc_wake_field(s->wake,
                      which == PHASE  ? RC_WAKE_LAG
                      : which == HALF ? RC_WAKE_REFLECT
                                      : RC_WAKE_SLOPE,
                      map);
        return;
    }
    if (rc_has_mean(s->problem.boundary)) {
        memset(map, 0, s->n * sizeof *map);
        return;
    }
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (size_t j = 0; j < s->rows; j++)
        filter_row(s, which, map + j * s->turned.nx);
}

/* ---- elastic contacts ---- */

/* The heights in `room`, which have the shift of the sliding contact. Counts the work on those before. */
static struct rc_elastic_heights
next_heights(struct slide *s)
{
    const struct rc_point *to = &s->base.to;
    struct rc_elastic_heights heights = {s->room, 0};
    size_t iterations;

    s->course.convolutions += rc_elastic_work(s->base.inner, &iterations);
    s->course.iterations += iterations;
    if (rc_point_has(to, RC_APPROACH))
        heights.approach =
            fmax(to->at[RC_APPROACH] + rc_ranks_highest(s->base.rows.ranks, s->room, s->n) - s->top,
                 1e-12 * to->at[RC_APPROACH]);
    return heights;
}

static double
goal_of(double tol, double steepest)
{
    return tol / hypot(1, steepest);
}

/* Judges the pressure in the sliding contact, from V p. Afterwards the inner model has the heights
 * h - (K - V) p, and with them the gap of the sliding contact. */
static enum rc_status
judge(struct slide *s, const double *displacement, struct rc_err *err)
{
    struct rc_elastic_heights heights;

    memcpy(s->room, displacement, s->n * sizeof *s->room);
    filter(s, PHASE, s->room);
    for (size_t k = 0; k < s->n; k++)
        s->room[k] = s->h[k] - s->room[k];
    heights = next_heights(s);
    return rc_elastic_judge(s->base.inner, &heights, goal_of(s->problem.tol, s->steepest),
                            &s->course.estimate, err);
}

static enum rc_status
next_contact(struct slide *s, struct rc_err *err)
{
    struct rc_elastic_heights heights;

    s->course.tol = fmin(loosest, of_error * s->course.estimate);
    for (size_t k = 0; k < s->n; k++)
        s->room[k] = s->h[k] - s->g[k];
    heights = next_heights(s);
    return rc_elastic_resume(s->base.inner, &heights, s->course.tol, s->course.tol > single_floor,
                             err) == RC_OK
               ? RC_MORE
               : RC_FAIL;
}

/* Judges the pressure of the last contact by V p in double precision. The result then depends on nothing but
 * this pressure, and a state needs nothing else to give the same bits. */
static enum rc_status
conclude(struct slide *s, struct rc_err *err)
{
    struct rc_model *inner = s->base.inner;

    if (judge(s, rc_elastic_hold(inner, true), err) != RC_OK)
        return RC_FAIL;
    s->course.done =
        s->course.estimate <= goal_of(s->problem.tol, s->steepest) && rc_elastic_reached(inner);
    if (!s->course.done && s->course.contacts < MOST_CONTACTS)
        return next_contact(s, err);
    rc_elastic_conclude(inner, s->course.estimate);
    return s->course.done ? RC_OK : RC_SHORT;
}

/* After an elastic contact: RC_OK if its pressure solves the sliding contact; otherwise poses the next
 * one. */
static enum rc_status
advance(struct slide *s, struct rc_err *err)
{
    const double *displacement = rc_elastic_hold(s->base.inner, false);

    for (size_t k = 0; k < s->n; k++)
        s->g[k] += 2 * displacement[k];
    filter(s, HALF, s->g);
    if (judge(s, displacement, err) != RC_OK)
        return RC_FAIL;
    s->course.contacts++;
    return s->course.estimate <= goal_of(s->problem.tol, s->steepest) ||
                   s->course.contacts >= MOST_CONTACTS
               ? conclude(s, err)
               : next_contact(s, err);
}

/* ---- verbs ---- */

/* Makes the inner model of this speed. */
static enum rc_status
make_inner(struct slide *s, double speed, struct rc_err *err)
{
    set_waves(s, speed);
    if (set_wake(s, speed, err) != RC_OK)
        return RC_FAIL;
    rc_model_free(s->base.inner);
    s->base.inner = rc_elastic_new_along(&s->turned, s->h, &s->problem, s->compliant, err);
    return s->base.inner != NULL ? RC_OK : RC_FAIL;
}

static enum rc_status
go(struct rc_model *m, struct rc_err *err)
{
    struct slide *s = (struct slide *)m;
    const double speed = m->to.at[RC_SPEED];
    struct rc_point inner;

    if (!(m->to.at[rc_point_has(&m->to, RC_APPROACH) ? RC_APPROACH : RC_LOAD] > 0))
        return rc_err_set(err, "bodies that slide need a load or an approach above 0");
    if (make_inner(s, speed, err) != RC_OK)
        return RC_FAIL;
    if (s->steepest > most_tan)
        return rc_err_set(err,
                          "speed %g m/s: tan delta of the %s reaches %.3g among the waves of the "
                          "%smap, and above %g the iteration is not reliable",
                          speed, s->wake != NULL ? "wake" : "material", s->steepest,
                          s->wake != NULL ? "padded " : "", most_tan);
    memset(s->g, 0, s->n * sizeof *s->g);
    s->course.contacts = s->course.iterations = 0;
    s->course.convolutions = 0;
    s->course.tol = loosest;
    s->course.estimate = NAN;
    s->course.done = s->course.ended = false;
    inner = rc_point_for(m->inner, &m->to);
    rc_model_set_accuracy(m->inner, s->course.tol / s->problem.tol);
    if (rc_model_go(m->inner, &inner, err) != RC_MORE)
        return RC_FAIL;
    rc_elastic_set_rough(m->inner, true);
    return RC_OK;
}

static enum rc_status
step(struct rc_model *m, struct rc_err *err)
{
    struct slide *s = (struct slide *)m;
    enum rc_status status;

    s->loaded = false;
    if (s->course.ended) {
        s->course.ended = false;
        return conclude(s, err);
    }
    status = rc_model_step(m->inner, err);
    return status == RC_MORE || status == RC_FAIL ? status : advance(s, err);
}

/* The coefficients of friction by the slopes of u = K p, and by the slopes of h. The first one is a
 * quadratic form of p. *steep is half the range of its derivative in contact: the load is exact, so that a
 * constant of the derivative counts for nothing, and *steep times the relative L1 error of p bounds the error
 * of the coefficient to first order. */
static void
find_friction(struct slide *s, double load, double friction[2], double *steep)
{
    const double *p = rc_elastic_pressure(s->base.inner);
    const bool open = rc_has_mean(s->problem.boundary);
    struct rc_total sum[2] = {{0}};
    double low = INFINITY, high = -INFINITY, total[2], most[2];

    for (int q = 1; q >= 0; q--) {
        if (q == 0)
            rc_elastic_displacement(s->base.inner, false, s->room);
        else
            memcpy(s->room, s->h, s->n * sizeof *s->room);
        filter(s, q == 0 ? LOSS : SLOPE, s->room);
        for (size_t k = 0; k < s->n; k++)
            rc_total_add(&sum[q], -p[k] * s->room[k]);
        for (size_t k = 0; q == 0 && k < s->n; k++)
            if (p[k] > 0) {
                low = fmin(low, s->room[k]);
                high = fmax(high, s->room[k]);
            }
    }
    most[0] = high;
    most[1] = -low;
    rc_ranks_totals(s->base.rows.ranks, 2, sum, total, 2, most);
    *steep = most[0] > -most[1] ? most[0] + most[1] : 0;
    for (int q = 0; q < 2; q++)
        friction[q] = (q == 0 && open ? 1 : copysign(1, s->base.to.at[RC_SPEED])) * total[q] *
                      s->turned.dx * s->turned.dy / load;
}

struct power {
    const struct slide *s;
    struct rc_total sum;
};

static void
add_power(void *ctx, size_t k, size_t j, double amplitude)
{
    struct power *of = ctx;
    const struct slide *s = of->s;
    const double qx = rc_fourier_q(k, s->turned.nx, s->turned.dx);
    const double qy = rc_fourier_q(j, s->turned.ny, s->turned.dy);

    if (k > 0)
        rc_total_add(&of->sum,
                     2 * s->base.to.at[RC_SPEED] * qx * 2 / hypot(qx, qy) *
                         (s->wave[k].factor * cimag(s->wave[k].phase) / s->problem.pair.estar) *
                         (amplitude * amplitude));
}

/* The power of all waves of the pressure: v qx 2/|q| Im J |p|^2. */
static enum rc_status
find_power(struct slide *s, double *power, struct rc_err *err)
{
    const struct rc_shape *t = &s->turned;
    const struct rc_ranks *ranks = s->base.rows.ranks;
    const double per = (double)s->all * (double)s->all;
    struct power of = {.s = s};

    if (rc_waves_visit(ranks, t, rc_elastic_pressure(s->base.inner), add_power, &of, err) != RC_OK)
        return RC_FAIL;
    *power = rc_ranks_total(ranks, of.sum) / per * t->dx * (double)t->nx * t->dy * (double)t->ny;
    return RC_OK;
}

static enum rc_status
look(struct rc_model *m, struct rc_point *at, struct rc_err *err)
{
    struct slide *s = (struct slide *)m;
    struct rc_sliding_figures *f = &s->f;
    const struct rc_contact *c = &rc_elastic_result(m->inner)->contact;
    const double spent = s->course.convolutions;
    double friction[2], steep;
    size_t iterations;

    if (m->looked)
        goto done;
    find_friction(s, c->load, friction, &steep);
    s->course.convolutions = spent;
    f->friction = friction[0];
    f->friction_by_heights = friction[1];
    f->friction_force = friction[0] * c->load;
    f->dissipated_power = f->friction_force * fabs(s->base.to.at[RC_SPEED]);
    if (!rc_has_mean(s->problem.boundary) && find_power(s, &f->dissipated_power, err) != RC_OK)
        return RC_FAIL;
    f->speed = m->to.at[RC_SPEED];
    f->pressure_error = s->course.estimate * hypot(1, s->steepest);
    f->friction_error = f->friction != 0 ? f->pressure_error * steep / fabs(f->friction) : INFINITY;
    f->tan_delta_max = s->lossy;
    f->track = s->law.repeats ? "repeated" : "fresh";
    f->approach = c->approach - rc_elastic_top(m->inner) + s->top;
    f->contacts = s->course.contacts;
    f->iterations = s->course.iterations;
    f->convolutions = s->course.convolutions + rc_elastic_work(m->inner, &iterations);
    f->converged = s->course.done && c->converged;
    f->elastic_energy = NAN;
done:
    at->at[RC_LOAD] = c->load;
    at->at[RC_APPROACH] = f->approach;
    return RC_OK;
}

/* Copies ny rows of nx nodes; `over`: with x and y exchanged. */
static void
turn(size_t nx, size_t ny, bool over, const double *from, double *to)
{
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++)
            to[over ? i * ny + j : j * nx + i] = from[j * nx + i];
}

static enum rc_status
fill(struct rc_model *m, size_t frame, double *to, struct rc_err *err)
{
    struct slide *s = (struct slide *)m;

    if (rc_model_frame(m->inner, frames[frame].name, s->room, err) != RC_OK)
        return RC_FAIL;
    if (frame == RC_FRAME_DISPLACEMENT) {
        rc_elastic_displacement(m->inner, false, s->room);
        filter(s, PHASE, s->room);
        rc_elastic_displacement(m->inner, true, s->room);
    }
    turn(s->turned.nx, s->rows, s->law.along_y, s->room, to);
    return RC_OK;
}

static enum rc_status
keep(struct rc_model *m, struct rc_err *err)
{
    return rc_model_keep(m->inner, err);
}

/* The waves of G fill whole maps, the last one with zeros. */
static void
exchange_waves(struct slide *s, struct rc_state *x)
{
    const double *from;
    size_t waves;
    double *g = rc_wake_waves(s->wake, &waves), *to;

    for (size_t at = 0; at < waves; at += s->n) {
        const size_t some = waves - at < s->n ? waves - at : s->n;
        if (rc_state_reads(x)) {
            if ((from = rc_state_read_map(x, s->n)) != NULL)
                memcpy(g + at, from, some * sizeof *g);
        } else if ((to = rc_state_map(x, s->n, NULL)) != NULL) {
            memcpy(to, g + at, some * sizeof *g);
            memset(to + some, 0, (s->n - some) * sizeof *g);
        }
    }
}

/* Until the point is kept a state holds G; the pressure is in the state of the inner model. */
static void
state(struct rc_model *m, struct rc_state *x)
{
    struct slide *s = (struct slide *)m;
    struct rc_err err;

    if (!m->moved)
        return;
    rc_state_count(x, &s->course.contacts, MOST_CONTACTS);
    rc_state_count(x, &s->course.iterations, (size_t)1 << 40);
    RC_STATE_SIZES(x, &s->course.convolutions, &s->course.tol);
    rc_state_map(x, s->n, s->g);
    if (rc_state_reads(x) && make_inner(s, m->to.at[RC_SPEED], &err) != RC_OK) {
        rc_state_refuse(x, err.text);
        return;
    }
    if (s->wake != NULL)
        exchange_waves(s, x);
    if (!rc_state_reads(x))
        return;
    s->course.done = false;
    s->course.ended = m->status == RC_OK || m->status == RC_SHORT;
    for (size_t k = 0; k < s->n; k++)
        s->room[k] = s->h[k] - s->g[k];
    if (rc_model_set_heights(m->inner, s->room, &err) != RC_OK)
        rc_state_refuse(x, err.text);
    else
        rc_model_set_accuracy(m->inner, s->course.tol / s->problem.tol);
}

static void
progress(const struct rc_model *m, struct rc_loops *l)
{
    rc_loops_add(l, "contact", NULL, (double)((const struct slide *)m)->course.contacts + 1, NAN);
}

/* The error decreases in each contact by the factor tan(d/2). */
static enum rc_status
plan(const struct rc_model *m, const struct rc_point *most, struct rc_expected *expected,
     struct rc_err *err)
{
    const struct slide *s = (const struct slide *)m;
    const struct rc_point inner = rc_point_for(m->inner, most);
    const double start = 0.7; /* error of the pressure of the first contact, times tan d */
    double steepest = 0, contacts, more;

    if (rc_model_plan(m->inner, &inner, expected, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 1; k < s->columns; k++) {
        const double complex j = compliance(&s->law, &s->turned, k, most->at[RC_SPEED]);
        steepest = fmax(steepest, cimag(j) / creal(j));
    }
    contacts = fmax(log(s->problem.tol / (start * steepest)) / log(tan(atan(steepest) / 2)), 0);
    more = contacts * RC_SLIDE_CONTACT +
           rc_by_padding(s->problem.boundary, RC_SLIDE_FREE, RC_SLIDE_PERIODIC);
    expected->seconds *= RC_SLIDE_PASSES * (1 + more / expected->convolutions);
    expected->convolutions += more;
    /* measured; the plan of the inner model has some of the maps */
    expected->memory += (rc_has_mean(s->problem.boundary) ? 23 : 1) * s->n * sizeof(double);
    return RC_OK;
}

static void
release(struct rc_model *m)
{
    struct slide *s = (struct slide *)m;

    rc_line_free(s->line);
    rc_wake_free(s->wake);
}

const struct rc_model_row rc_model_sliding = {
    .name = "sliding",
    .summary = "a rough body that slides over a viscoelastic half-space",
    .needs = 1u << RC_LOAD | 1u << RC_SPEED,
    .takes = 1u << RC_LOAD | 1u << RC_APPROACH | 1u << RC_SPEED,
    .forgets = true,
    RC_MODEL_VERBS,
    .frame = frames,
    .free = release,
    .keep = keep,
    .plan = plan,
};

/* ---- the maker ---- */

static enum rc_status
check(const struct rc_shape *shape, const struct rc_problem *problem,
      const struct rc_sliding_problem *law, struct rc_err *err)
{
    const struct rc_relaxation *r = law->material;
    const double ratio = (1 / r->relaxed + law->compliance) / (r->instant + law->compliance);

    if (rc_shape_check(shape, err) != RC_OK)
        return RC_FAIL;
    if (rc_repeats(problem->boundary) == 1)
        return rc_err_set(err, "sliding over a viscoelastic body is not implemented for maps that "
                               "repeat along one axis only: take a free or a periodic map");
    if (rc_has_mean(problem->boundary) && law->repeats)
        return rc_err_set(err, "only a periodic map has a repeated track");
    if (problem->ranks != NULL && (law->along_y || rc_has_mean(problem->boundary)))
        return rc_err_set(err, "sliding over a viscoelastic body on several processes needs %s",
                          law->along_y ? "motion along x: rotate the map with rc-pick --rotate 90"
                                       : "a periodic map");
    if (problem->tilt_free || (problem->hardness > 0 && !isinf(problem->hardness)) ||
        problem->hardness_map != NULL)
        return rc_err_set(err, "sliding over a viscoelastic body with a hardness or a free tilt is "
                               "not implemented");
    if (!(law->compliance >= 0) || isinf(law->compliance))
        return rc_err_set(err, "compliance %g 1/Pa of body 2: it must be at least 0 and finite",
                          law->compliance);
    if (!(r->relaxed > 0))
        return rc_err_set(err,
                          "the relaxed modulus is 0: such a body sinks without end, and has no "
                          "steady state of sliding");
    if (law->repeats && ratio > most_repeated)
        return rc_err_set(
            err,
            "the compliance of the bodies changes by a factor of %.3g: for a repeated "
            "track it must be at most %g",
            ratio, most_repeated);
    return RC_OK;
}

static enum rc_status
make_room(struct slide *s, struct rc_err *err)
{
    struct rc_store *own = &s->base.own;

    s->h = rc_store_take(own, s->n, sizeof *s->h);
    s->g = rc_store_take(own, s->n, sizeof *s->g);
    s->room = rc_store_take(own, s->n, sizeof *s->room);
    s->wave = rc_store_take(own, s->columns, sizeof *s->wave);
    s->row = rc_store_take(own, (size_t)s->threads * s->columns, sizeof *s->row);
    if (rc_model_room(&s->base, err) != RC_OK)
        return RC_FAIL;
    s->line = rc_line_new(s->turned.nx, (size_t)s->threads, err);
    return rc_ranks_agree(s->base.rows.ranks, s->line != NULL ? RC_OK : RC_FAIL, err);
}

struct rc_model *
rc_sliding_new(const struct rc_shape *shape, const double *h, const struct rc_problem *problem,
               const struct rc_sliding_problem *law, struct rc_err *err)
{
    const struct rc_shape other = {shape->ny, shape->nx, shape->dy, shape->dx};
    RC_OWN(rc_model, m) = NULL;
    struct slide *s;

    if (check(shape, problem, law, err) != RC_OK ||
        (m = rc_model_make(&rc_model_sliding, sizeof *s, shape, problem->ranks, err)) == NULL)
        return NULL;
    s = (struct slide *)m;
    m->boundary = problem->boundary;
    s->problem = *problem;
    s->problem.hurry = NULL;
    s->law = *law;
    s->turned = law->along_y ? other : *shape;
    s->n = rc_model_nodes(m);
    s->all = shape->nx * shape->ny;
    s->rows = law->along_y ? shape->nx : m->rows.n;
    if (!(problem->tol > 0))
        s->problem.tol = fmin(usual_tol, pow((double)s->all, -0.75));
    s->columns = s->turned.nx / 2 + 1;
    s->along = (struct rc_along){.factor = factor_of, .of = s};
    s->threads = rc_useful_threads(shape, problem->threads);
    if (make_room(s, err) != RC_OK)
        return NULL;
    turn(shape->nx, m->rows.n, law->along_y, h, s->h);
    s->top = rc_ranks_highest(m->rows.ranks, s->h, s->n);
    return make_inner(s, 0, err) == RC_OK ? rc_give(&m) : NULL;
}
