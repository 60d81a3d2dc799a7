/*
 * The model of viscoelastic bodies in time: creep, relaxation, loads that come and go. Poisson's ratio is
 * constant in time. The operator at the time t is then J(t)/J(0) times the operator K of the inner, elastic
 * model, which has the instantaneous moduli (Lee and Radok 1960, J. Appl. Mech. 27, 438). With w = K p and
 * the terms j = J_k/J(0) of the creep compliance, the displacement is
 *
 *     u = w + sum of all r,   th dr/dt + r = j w.
 *
 * In a step w changes linearly in time, and the terms are exact for that: r becomes keep r + old w + new w',
 * with w before and w' after the step. With C = 1 + sum of new and g = sum of keep r + old w, the pressure
 * after the step is that of the inner model with the heights (h - g)/C. Each step is one elastic contact, and
 * the method is of second order. A jump of the load is a step without time: C = 1.
 *
 * A second run has half as many steps, each of two steps of the first one. The estimated error is the
 * difference of the two pressures. With second order the error is a third of it. Nodes that enter and leave
 * the contact one by one lower the order. On 120 random histories the error was at most 0.81 of the
 * difference with 7 or more nodes in contact, and 1.8 of it with 6; the estimate grows where nodes are few. A
 * history in single precision would add errors of up to 2e-5 that both runs share.
 *
 * If the caller gives no number of increments, a leg whose estimate is too large is repeated with more.
 */
#include <math.h>
#include <string.h>

#include "libcontact/expected.h"
#include "libcontact/model/row.h"

enum {
    COARSE, /* the run with half as many steps */
    FINE,
    RUNS,
    MAPS = RUNS + 3
};
static const double usual_tol = 0.01;
enum {
    USUAL = 20,     /* increments of a leg, at least */
    MOST_AUTO = 320 /* at most, while the model chooses their number */
};
/* A further try aims at this part of the tolerance, with at least and at most so many times the increments.
 * There is none after a try that left more than `helps` of the estimate: the rest is from earlier legs. */
static const double aim = 0.6, least_more = 1.5, most_more = 4, helps = 0.7;
static const double per_decade =
    1.2; /* steps a decade of the time since a corner, over increments */
/* Terms that are faster than this part of the shortest leg follow w at once. Terms that are slower than this
 * many times the whole history flow. */
static const double fast = 1e-3, slow = 1e3;
static const double few = 8; /* nodes in contact with which the estimate is twice the difference */
static const double same_slope = 1e-9, whole = 1 - 1e-9;

struct term {
    double time, j; /* s, -; time 0: follows w at once; time INFINITY: flows, with j in 1/s */
    double keep, old, new; /* in the present step */
};

struct run {
    double t;     /* s: end of the present step */
    size_t steps; /* of this leg, with the present one */
    double *w;    /* m, at the start of the step */
    double *r;    /* m, one map for each term    */
};

struct creep {
    struct rc_model base;
    struct rc_viscoelastic_problem problem;
    const double *h; /* the caller's */
    size_t n, terms;
    struct term *term;
    double load, *equivalent; /* N: load after the last step, and its r, one for each term */
    double quickest;          /* s: shortest time of a term that takes time */
    double left_out;          /* relative error of fast and slow terms */
    struct run run[RUNS];
    double *posed, *room,
        *coarse;                /* heights of the inner model; free; pressure of the coarse run */
    size_t on;                  /* the present run */
    double start, end, dt;      /* s: the leg, the present step */
    double least, most, shrink; /* s, s, -: first and longest step of the fine run, times shrink */
    size_t increments;          /* of this leg */
    double tried;               /* estimate of the last try of this leg; INFINITY: none */
    size_t steps;               /* of the fine run in this leg; even */
    double slope;               /* of load or approach in the last leg, per s */
    double c;                   /* C of the present step */
    double top, posed_top;      /* m: highest nodes of h and posed */
    double beyond;              /* m: gap at first touch, at a given approach without contact */
    double worst;               /* largest error of a contact so far */
    bool good;                  /* all contacts have converged */
    bool taken;                 /* the end of the leg is reached */
    struct rc_viscoelastic_figures f;
};

const struct rc_figure rc_figures_viscoelastic[] = {
#define FIGURE(member) RC_FIGURE(struct rc_viscoelastic_figures, member)
    {FIGURE(time), "s", "Time"},
    {FIGURE(increments), NULL, "Increments", .role = RC_FIGURE_COST,
     .says = "steps from the previous point"},
    {RC_FIGURE_AS("increment_error_estimate", struct rc_viscoelastic_figures, increment_error),
     NULL, "Error of the increments", .says = "estimated relative L1 error of the pressure",
     .role = RC_FIGURE_ERROR, .by = "increments"},
    {FIGURE(equivalent_load), "N", "Equivalent load",
     .says =
         "load with the same contact on bodies that keep their instantaneous moduli, if the load "
         "has only risen"},
    {FIGURE(indentation), "m", "Indentation", .says = "approach from first touch at the start"},
    {FIGURE(residual_indentation), "m", "Residual indentation",
     .says = "first touch right after the load is removed"},
    {0},
};
static const struct rc_figure_set sets[] = {
    {rc_figures_contact, offsetof(struct creep, f.contact)},
    {rc_figures_viscoelastic, offsetof(struct creep, f)},
    {NULL, 0},
};

enum {
    GAP,
    DISPLACEMENT
};
static const struct rc_frame_kind frames[] = {
    [GAP] = {"gap", "m", "Gap"},
    [DISPLACEMENT] = {"displacement", "m", "Displacement"},
    {NULL, NULL, NULL},
};

/* ---- terms ---- */

/* Chooses the terms of the history. All fast ones are one term, and all slow ones are another. */
static void
choose_terms(struct creep *v)
{
    const struct rc_viscoelastic_problem *a = &v->problem;
    const struct rc_relaxation *m = a->material;
    const double unit = a->share / m->instant, low = fast * a->shortest,
                 high = a->longest > 0 ? slow * a->longest : INFINITY;
    double at_once = 0, flow = unit * m->fluidity, of_fast = 0, of_slow = 0;

    v->quickest = INFINITY;
    for (size_t k = 0; k < m->creep_terms; k++) {
        const double th = m->retardation[k], j = unit * m->compliance[k];
        if (th < low) {
            at_once += j;
            of_fast += j * th / a->shortest;
        } else if (th > high) {
            flow += j / th;
            of_slow += j * pow(a->longest / th, 2) / 2;
        } else {
            v->quickest = fmin(v->quickest, th);
            v->term[v->terms++] = (struct term){.time = th, .j = j};
        }
    }
    v->left_out = of_fast / (1 + at_once) + of_slow / (1 + flow * a->longest);
    if (at_once > 0)
        v->term[v->terms++] = (struct term){.time = 0, .j = at_once};
    if (flow > 0)
        v->term[v->terms++] = (struct term){.time = INFINITY, .j = flow};
}

/* Finds the weights of a step. */
static void
weigh(struct creep *v, double dt)
{
    const double series = 0.01; /* the difference loses digits below it */

    v->dt = dt;
    v->c = 1;
    for (size_t k = 0; k < v->terms; k++) {
        struct term *m = &v->term[k];
        const double x = dt / m->time, gone = -expm1(-x);
        if (dt == 0) {
            m->keep = 1;
            m->old = m->new = 0;
        } else if (isinf(m->time)) {
            m->keep = 1;
            m->old = m->new = m->j *dt / 2;
        } else {
            const double part = x < series
                                    ? x * (1.0 / 2 - x * (1.0 / 6 - x * (1.0 / 24 - x / 120)))
                                    : 1 - gone / x;
            m->keep = exp(-x);
            m->new = m->j *part;
            m->old = m->j * (gone - part);
        }
        v->c += m->new;
    }
}

/* The displacement after the step, less C w'. */
static void
find_history(const struct creep *v, double *to)
{
    const struct run *run = &v->run[v->on];
    double of_w = 0;

    for (size_t k = 0; k < v->terms; k++)
        of_w += v->term[k].old;
    for (size_t i = 0; i < v->n; i++)
        to[i] = of_w * run->w[i];
    for (size_t k = 0; k < v->terms; k++) {
        const double *r = run->r + k * v->n;
        for (size_t i = 0; i < v->n; i++)
            to[i] += v->term[k].keep * r[i];
    }
}

/* ---- a step ---- */

static bool
by_approach(const struct creep *v)
{
    return rc_point_has(&v->base.to, RC_APPROACH);
}

/* Load or approach of the inner model at the end of the step. Its approach counts from the first touch of its
 * own heights. */
static struct rc_point
target(struct creep *v)
{
    const struct rc_point *from = &v->base.from, *to = &v->base.to;
    const double way = v->end - v->start;
    struct rc_point at =
        rc_point_between(from, to, way > 0 ? (v->run[v->on].t - v->start) / way : 1);
    double approach;

    at = rc_point_for(v->base.inner, &at);
    v->beyond = 0;
    if (by_approach(v)) {
        approach = (at.at[RC_APPROACH] - v->top) / v->c + v->posed_top;
        v->beyond = fmax(0, -v->c * approach);
        rc_point_set(&at, RC_APPROACH, fmax(0, approach));
    }
    return at;
}

/* Step i of the fine run. Steps grow in proportion to the time since a corner of the load. */
static double
fine_step(const struct creep *v, size_t i)
{
    const double growth = pow(10, (double)i / (per_decade * (double)v->increments));

    return v->shrink * fmin(v->most, v->least * growth);
}

/* Divides the leg into steps. A step of the coarse run is two of the fine one. */
static void
divide(struct creep *v, bool corner, size_t increments)
{
    const double leg = v->end - v->start, n = (double)increments;
    double sum = 0;

    v->least = corner ? v->quickest / n : fine_step(v, v->steps) * (double)v->increments / n;
    v->increments = increments;
    v->most = leg / n;
    v->shrink = 1;
    v->steps = 0;
    while (leg > 0 && (sum < whole * leg || v->steps % 2 == 1))
        sum += fine_step(v, v->steps++);
    v->shrink = leg > 0 ? leg / sum : 1;
    v->run[COARSE].steps = v->run[FINE].steps = 0;
}

/* The length of the next step. */
static double
next_step(struct creep *v)
{
    struct run *run = &v->run[v->on];
    const size_t i = run->steps++;
    const bool last = run->steps >= (v->on == FINE ? v->steps : v->steps / 2);
    const double dt =
        v->on == FINE ? fine_step(v, i) : fine_step(v, 2 * i) + fine_step(v, 2 * i + 1);

    return v->end == v->start ? 0 : last ? v->end - run->t : dt;
}

static enum rc_status
start_step(struct creep *v, struct rc_err *err)
{
    struct run *run = &v->run[v->on];
    const double dt = next_step(v);
    struct rc_point at;

    weigh(v, dt);
    run->t = dt == v->end - run->t ? v->end : run->t + dt;
    find_history(v, v->posed);
    for (size_t i = 0; i < v->n; i++)
        v->posed[i] = (v->h[i] - v->posed[i]) / v->c;
    v->posed_top = rc_highest(v->posed, v->n);
    at = target(v);
    if (rc_model_set_heights(v->base.inner, v->posed, err) != RC_OK)
        return RC_FAIL;
    return rc_model_go(v->base.inner, &at, err);
}

/* The contact of the step is found: its displacement goes into the history. */
static enum rc_status
take_step(struct creep *v, enum rc_status status, struct rc_err *err)
{
    struct run *run = &v->run[v->on];
    double *w = v->room;
    struct rc_point at;

    if (rc_model_look(v->base.inner, &at, err) != RC_OK ||
        rc_model_frame(v->base.inner, "displacement", w, err) != RC_OK)
        return RC_FAIL;
    if (rc_model_number(v->base.inner, "plastic_area") > 0)
        return rc_err_set(err, "a hardness of viscoelastic bodies is not implemented");
    for (size_t k = 0; k < v->terms; k++) {
        const struct term m = v->term[k];
        double *r = run->r + k * v->n;
        for (size_t i = 0; i < v->n; i++)
            r[i] = m.keep * r[i] + m.old * run->w[i] + m.new *w[i];
        if (v->on == FINE)
            v->equivalent[k] = m.keep * v->equivalent[k] + m.old * v->load + m.new *at.at[RC_LOAD];
    }
    v->room = run->w;
    run->w = w;
    if (v->on == FINE) {
        v->load = at.at[RC_LOAD];
        v->f.increments++;
    }
    v->f.contact.convolutions += rc_model_number(v->base.inner, "convolutions");
    if (!(at.at[RC_LOAD] == 0)) {
        v->good = v->good && status == RC_OK;
        v->worst = fmax(v->worst, rc_model_number(v->base.inner, "pressure_error_estimate"));
    }
    return RC_OK;
}

/* ---- legs ---- */

static enum rc_status
start_run(struct creep *v, size_t on, struct rc_err *err)
{
    struct rc_model *inner = v->base.inner;
    const enum rc_status status = (v->on = on, start_step(v, err));

    /* the last pressure belongs to the other end of the leg */
    if (on == FINE && v->end > v->start && status == RC_MORE &&
        rc_model_start(inner, 0, NULL, err) != RC_OK)
        return RC_FAIL;
    return status;
}

/* The error of the increments, from the relative difference of the pressures of the two runs. */
static enum rc_status
compare(struct creep *v, struct rc_err *err)
{
    struct rc_total apart = {0}, coarse = {0}, fine = {0};
    double size, nodes = 0;

    if (rc_model_frame(v->base.inner, "pressure", v->room, err) != RC_OK)
        return RC_FAIL;
    for (size_t i = 0; i < v->n; i++) {
        rc_total_add(&apart, fabs(v->room[i] - v->coarse[i]));
        rc_total_add(&coarse, v->coarse[i]);
        rc_total_add(&fine, v->room[i]);
        nodes += rc_in_contact(v->room[i]);
    }
    size = rc_total_value(&coarse) > rc_total_value(&fine) ? rc_total_value(&coarse)
                                                           : rc_total_value(&fine);
    v->f.increment_error =
        v->left_out + (size != 0 ? (1 + few / fmax(nodes, 1)) * rc_total_value(&apart) / size : 0);
    return RC_OK;
}

/* True if the model chooses the increments, and more of them can lower the error of this leg. */
static bool
deserves_more(const struct creep *v)
{
    return v->problem.increments == 0 && v->end > v->start && v->increments < MOST_AUTO &&
           v->f.increment_error > v->problem.tol && v->f.increment_error < helps * v->tried;
}

/* Increments for the aim, of an error of second order. */
static size_t
increments_for(const struct creep *v, double least, double most)
{
    const double times = sqrt(v->f.increment_error / (aim * v->problem.tol));

    return (size_t)fmin(MOST_AUTO, ceil((double)v->increments * fmin(fmax(times, least), most)));
}

static enum rc_status start_leg(struct creep *v, size_t increments, struct rc_err *err);

/* Returns to the start of the leg and takes more increments. */
static enum rc_status
try_again(struct creep *v, struct rc_err *err)
{
    const size_t increments = increments_for(v, least_more, most_more);
    const double work = v->f.contact.convolutions, tried = v->f.increment_error;

    if (rc_model_recall(&v->base, err) != RC_OK)
        return RC_FAIL;
    v->tried = tried;
    v->f.contact.convolutions = work;
    return start_leg(v, increments, err);
}

static enum rc_status
judge(const struct creep *v)
{
    return v->good && v->f.increment_error <= v->problem.tol ? RC_OK : RC_SHORT;
}

/* Starts the next step, or the fine run; or ends the leg. */
static enum rc_status
go_on(struct creep *v, struct rc_err *err)
{
    const bool begins = v->base.from.given == 0;

    if (v->run[v->on].t < v->end)
        return start_step(v, err);
    if (v->on == COARSE)
        return rc_model_frame(v->base.inner, "pressure", v->coarse, err) == RC_OK
                   ? start_run(v, FINE, err)
                   : RC_FAIL;
    if (begins) { /* both runs start from the same contact */
        memcpy(v->run[COARSE].w, v->run[FINE].w, v->n * sizeof *v->room);
        v->run[COARSE].t = v->end;
        v->f.increment_error = v->left_out;
    } else if (compare(v, err) != RC_OK) {
        return RC_FAIL;
    } else if (deserves_more(v)) {
        return try_again(v, err);
    }
    v->taken = true;
    return judge(v);
}

static enum rc_status
step(struct rc_model *m, struct rc_err *err)
{
    struct creep *v = (struct creep *)m;
    const enum rc_status status = rc_model_step(m->inner, err);

    if (status == RC_MORE || status == RC_FAIL)
        return status;
    if (v->taken) /* after a state was read */
        return judge(v);
    return take_step(v, status, err) == RC_OK ? go_on(v, err) : RC_FAIL;
}

static enum rc_status
allocate(struct creep *v, struct rc_err *err)
{
    double **maps[] = {&v->room, &v->coarse, &v->run[COARSE].w, &v->run[FINE].w, &v->posed};

    if (v->posed != NULL)
        return RC_OK;
    for (size_t k = 0; k < RUNS; k++)
        v->run[k].r = rc_store_zeros(&v->base.own, v->terms * v->n, sizeof(double));
    for (size_t k = 0; k < MAPS && !v->base.own.failed; k++)
        *maps[k] = rc_store_zeros(&v->base.own, v->n, sizeof(double));
    return rc_model_room(&v->base, err);
}

/* True if the load or the approach changes at another rate than in the last leg. */
static bool
turns(struct creep *v)
{
    const enum rc_axis axis = by_approach(v) ? RC_APPROACH : RC_LOAD;
    const struct rc_point *from = &v->base.from, *to = &v->base.to;
    const double slope = (to->at[axis] - from->at[axis]) / (v->end - v->start), last = v->slope;

    v->slope = isfinite(slope) ? slope : INFINITY; /* a state holds no NaN */
    return !(fabs(slope - last) <= same_slope * fabs(slope));
}

static enum rc_status
start_leg(struct creep *v, size_t increments, struct rc_err *err)
{
    const bool begins = v->base.from.given == 0;

    v->end = v->base.to.at[RC_TIME];
    v->start = begins ? v->end : v->base.from.at[RC_TIME];
    v->f.increments = 0;
    v->taken = false;
    if (begins)
        v->run[FINE].t = v->end;
    divide(v, turns(v), increments);
    return start_run(v, begins ? FINE : COARSE, err);
}

static enum rc_status
go(struct rc_model *m, struct rc_err *err)
{
    struct creep *v = (struct creep *)m;
    const size_t given = v->problem.increments;

    if (m->to.at[RC_APPROACH] < 0 && by_approach(v))
        return rc_err_set(err, "approach %g m: it must be at least 0", m->to.at[RC_APPROACH]);
    if (allocate(v, err) != RC_OK)
        return RC_FAIL;
    v->tried = INFINITY;
    v->f.contact.convolutions = 0;
    /* the next leg often needs as many as the last one */
    return start_leg(v,
                     given > 0            ? given
                     : v->increments == 0 ? USUAL
                                          : (size_t)fmax(USUAL, (double)increments_for(v, 0, 1)),
                     err) == RC_FAIL
               ? RC_FAIL
               : RC_OK;
}

/* ---- results ---- */

static enum rc_status
fill(struct rc_model *m, size_t frame, double *to, struct rc_err *err)
{
    const struct creep *v = (const struct creep *)m;

    if (rc_model_frame(m->inner, frames[frame].name, to, err) != RC_OK)
        return RC_FAIL;
    for (size_t i = 0; i < v->n; i++)
        to[i] = v->c * to[i] + (frame == GAP ? v->beyond : v->h[i] - v->c * v->posed[i]);
    return RC_OK;
}

/* The first touch of the heights less the history. */
static double
residual(struct creep *v)
{
    double top = -INFINITY;

    for (size_t i = 0; i < v->n; i++) {
        double left = v->h[i];
        for (size_t k = 0; k < v->terms; k++)
            left -= v->run[FINE].r[k * v->n + i];
        top = fmax(top, left);
    }
    return v->top - top;
}

static enum rc_status
look(struct rc_model *m, struct rc_point *at, struct rc_err *err)
{
    struct creep *v = (struct creep *)m;
    const double work = v->f.contact.convolutions;
    struct rc_viscoelastic_figures *f = &v->f;

    (void)err;
    f->contact = rc_elastic_result(m->inner)->contact;
    f->contact.convolutions = work;
    f->contact.approach = by_approach(v) ? m->to.at[RC_APPROACH]
                                         : v->c * (f->contact.approach - v->posed_top) + v->top;
    f->contact.mean_gap = v->c * f->contact.mean_gap + v->beyond;
    f->contact.gap_error *= v->c;
    f->contact.elastic_energy = NAN; /* the bodies dissipate a part of the work */
    if (f->contact.load != 0)
        f->contact.pressure_error += v->worst + f->increment_error;
    f->contact.converged = v->taken && judge(v) == RC_OK;
    f->time = v->taken ? v->end : v->run[v->on].t;
    f->equivalent_load = v->load;
    for (size_t k = 0; k < v->terms; k++)
        f->equivalent_load += v->equivalent[k];
    f->indentation = f->contact.approach;
    f->residual_indentation = v->taken ? residual(v) : NAN;
    at->at[RC_TIME] = f->time;
    at->at[RC_LOAD] = f->contact.load;
    at->at[RC_APPROACH] = f->contact.approach;
    return RC_OK;
}

/* ---- states ---- */

static void
state(struct rc_model *m, struct rc_state *s)
{
    struct creep *v = (struct creep *)m;
    bool begun = v->posed != NULL;
    struct rc_err err;

    rc_state_count(s, &v->on, FINE);
    RC_STATE_FLAGS(s, &begun, &v->good, &v->taken);
    RC_STATE_COUNTS(s, &v->f.increments, &v->increments, &v->steps, &v->run[COARSE].steps,
                    &v->run[FINE].steps);
    RC_STATE_NUMBERS(s, &v->start, &v->end, &v->dt, &v->beyond, &v->shrink, &v->load, &v->worst,
                     &v->posed_top, &v->f.increment_error, &v->f.contact.convolutions,
                     &v->run[COARSE].t, &v->run[FINE].t);
    RC_STATE_OPEN(s, &v->slope, &v->least, &v->most, &v->tried);
    rc_state_finite(s, v->terms, v->equivalent);
    if (rc_state_reads(s) && begun && allocate(v, &err) != RC_OK)
        rc_state_refuse(s, "memory is short");
    if (!begun)
        return;
    for (size_t k = 0; k < RUNS; k++) {
        rc_state_map(s, v->n, v->run[k].w);
        for (size_t q = 0; q < v->terms; q++)
            rc_state_map(s, v->n, v->run[k].r + q * v->n);
    }
    rc_state_map(s, v->n, v->posed);
    rc_state_map(s, v->n, v->coarse);
    if (!rc_state_reads(s))
        return;
    weigh(v, v->dt);
    if (rc_model_set_heights(m->inner, v->posed, &err) != RC_OK)
        rc_state_refuse(s, "its heights are not finite");
}

static void
progress(const struct rc_model *m, struct rc_loops *l)
{
    const struct creep *v = (const struct creep *)m;

    rc_loops_add(l, "time", "s", v->run[v->on].t, v->end);
    rc_loops_add(l, "step", NULL, (double)v->f.increments, NAN);
}

/* Steps of a point in both runs, of a part of the whole history. */
static double
steps_of(const struct creep *v, double part)
{
    const struct rc_viscoelastic_problem *a = &v->problem;
    const double n = (double)(a->increments > 0 ? a->increments : USUAL);
    double decades = 0;

    if (!(a->longest > 0))
        return 0;
    if (isfinite(v->quickest))
        decades = fmax(0, log10(a->longest / fmin(v->quickest, a->longest)));
    return (n + per_decade * n * decades * part) * (1 + 1.0 / 2);
}

static enum rc_status
plan(const struct rc_model *m, const struct rc_point *most, struct rc_expected *expected,
     struct rc_err *err)
{
    const struct creep *v = (const struct creep *)m;
    const struct rc_point inner = rc_point_for(m->inner, most);
    const size_t maps = RUNS * v->terms;
    const double part = 1 / (double)v->problem.points;
    double one;

    if (rc_model_plan(m->inner, &inner, expected, err) != RC_OK)
        return RC_FAIL;
    one = expected->seconds / expected->convolutions;
    expected->convolutions = part * expected->convolutions + RC_CREEP_STEP * steps_of(v, part);
    expected->seconds = expected->convolutions * one;
    /* with the copy of the state at the last kept point */
    expected->memory += v->n * (2 * maps + MAPS + RUNS + 3) * sizeof(double);
    return RC_OK;
}

const struct rc_model_row rc_model_viscoelastic = {
    .name = "viscoelastic",
    .summary = "viscoelastic bodies in time, over an elastic inner model",
    .needs = 1u << RC_LOAD | 1u << RC_TIME,
    .takes = 1u << RC_TIME,
    RC_MODEL_VERBS,
    .frame = frames,
    .plan = plan,
};

/* ---- the maker ---- */

static enum rc_status
check(const struct rc_model *inner, const struct rc_viscoelastic_problem *a, struct rc_err *err)
{
    if (inner->inner != NULL || rc_elastic_result(inner) == NULL)
        return rc_err_set(err, "viscoelastic bodies need an elastic inner model, not the %s model",
                          rc_model_name(inner));
    if (!(a->share > 0 && a->share <= 1))
        return rc_err_set(err,
                          "share %g of the viscoelastic body in the compliance: it must be above 0 "
                          "and at most 1",
                          a->share);
    if (!(a->shortest >= 0) || !(a->longest >= 0) || isinf(a->longest) || a->shortest > a->longest)
        return rc_err_set(err,
                          "shortest leg %g s and last time %g s: they must be at least 0 and "
                          "must rise",
                          a->shortest, a->longest);
    if (!(a->tol >= 0 && a->tol < 1))
        return rc_err_set(err, "tolerance %g: it must be at least 0 and below 1", a->tol);
    if (a->increments == 1)
        return rc_err_set(err, "1 increment of a leg: the estimate of the error needs at least 2");
    return RC_OK;
}

static enum rc_status
make(struct creep *v, const double *h, const struct rc_viscoelastic_problem *a, struct rc_err *err)
{
    const struct rc_shape *s = &v->base.shape;
    const size_t most = a->material->creep_terms + 2;

    if (check(v->base.inner, a, err) != RC_OK)
        return RC_FAIL;
    v->problem = *a;
    v->problem.points = a->points > 0 ? a->points : 1;
    v->problem.tol = a->tol > 0 ? a->tol : usual_tol;
    v->n = s->nx * s->ny;
    for (size_t k = 0; k < v->n; k++)
        if (!isfinite(h[k]))
            return rc_err_set(err, "height %zu is not a finite number", k);
    v->h = h;
    v->top = rc_highest(h, v->n);
    v->good = true;
    v->slope = INFINITY;
    v->c = v->shrink = 1;
    v->term = rc_store_take(&v->base.own, most, sizeof *v->term);
    v->equivalent = rc_store_zeros(&v->base.own, most, sizeof *v->equivalent);
    if (rc_model_room(&v->base, err) != RC_OK)
        return RC_FAIL;
    choose_terms(v);
    return RC_OK;
}

struct rc_model *
rc_viscoelastic_new(struct rc_model *inner, const double *h,
                    const struct rc_viscoelastic_problem *problem, struct rc_err *err)
{
    RC_OWN(rc_model, m) =
        rc_model_make_outer(&rc_model_viscoelastic, sizeof(struct creep), inner, err);

    return m != NULL && make((struct creep *)m, h, problem, err) == RC_OK ? rc_give(&m) : NULL;
}
