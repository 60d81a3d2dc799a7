/* SPDX-License-Identifier: GPL-3.0-or-later */
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
 * A second run has half as many steps, a third one a quarter. The estimated error follows from the
 * differences of the three pressures; with second order it is three times the error. Nodes that enter the
 * contact lower the order. One that joins in the last step has a pressure that is too low, alike in all runs
 * where the body creeps within a step; this error follows from its gap before the step. A node that no run
 * knows to touch shows in the differences of the gaps. A history in single precision would add errors of up
 * to 2e-5 that all runs share.
 *
 * A step is long where the weights of the old displacement exceed 1: that under a held contact would change
 * its sign, and the steps of a fluid, or of a solid whose modulus falls by orders, would ring without decay.
 * There w is linear from the middle of the last step to the end of this one, which is the backward
 * differentiation of second order, and rings decay. The first long step after a corner is backward Euler's
 * as far as the sum of old weights is 1. For the next step, the mean of w over a step from a corner is its w
 * at the end, because at its start a jump can have relaxed.
 *
 * The contacts have errors, too, which stay in the bodies: an error of the pressure under a large load is
 * larger beside a later small one. It relaxes as a pressure does under a held contact, which one number per
 * term follows. So do the errors of a contact that ends or begins within a step at a given approach, and of
 * rounding, beside which a pressure may be small after a fall by many orders.
 *
 * If the caller gives no number of increments, a leg whose estimate is too large is repeated with more.
 */
#include <float.h>
#include <math.h>
#include <string.h>

#include "libcontact/expected.h"
#include "libcontact/model/row.h"
#include "libcontact/solver/elastic.h"

enum {
    QUARTER, /* the run with a quarter of the steps */
    HALF,
    FINE,
    RUNS,
    MAPS = 3 * RUNS + 3
};
/* Relaxation moduli are rarely known to 1 %. */
static const double usual_tol = 0.01;
enum {
    /* Fewest increments of a leg. Half takes 0.8 times the convolutions, with errors up to 4 times
     * as large. Double takes 1.7 times as many, with errors down to half (12 runs of
     * bench/constants.py). */
    USUAL = 20,
    /* Most increments while the model chooses their number: 16 times USUAL, which lowers an error of
     * second order 256 times. */
    MOST_AUTO = 320
};
/* A further try aims at this part of the tolerance, with at least and at most so many times the
 * increments. There is none after a try that left more than `helps` of the estimate: the rest is from
 * earlier legs. Half and double of `aim` take 12 and 5 % more convolutions, double of `least_more` 16 %
 * (12 runs of bench/constants.py). Half and double of `helps` change no bit. */
static const double aim = 0.6, least_more = 1.5, most_more = 4, helps = 0.7;
/* Steps a decade of the time since a corner, over increments. Half takes 14 % fewer convolutions with
 * errors at most 10 % larger, double 24 % more (24 runs of bench/constants.py). */
static const double per_decade = 1.2;
/* Terms that are faster than this part of the shortest leg are one term. Terms that are slower than this many
 * times the whole history flow. The estimate contains the error of both, which is about the square of this
 * part. Half of `fast` takes 11 % more convolutions; double takes 11 % fewer, with errors up to 1.8
 * times as large (12 runs of bench/constants.py). */
static const double fast = 1e-3, slow = 1e3;
/* A step that is longer than the last one times this starts anew: methods of two steps are unstable where the
 * steps grow faster than 2.4 times. */
static const double most_longer = 2;
/* Fast terms settle at once after a jump. A first step which is much longer takes w as linear there, with an
 * error of first order; if it is longer than `low`, below which terms are fast, times this, a step of `low`
 * comes before it. */
static const double much_longer = 4;
/* Least fall of the errors where the steps are halved that the estimate takes from two differences, and the
 * part of the former difference that it has at least: its own with errors of second order. */
static const double least_fall = 1.5, of_former = 0.25;
/* The largest relative L1 error. */
static const double largest = 2;
/* Relative: rounding of the times that a user gives. Half and double of `same_slope` change no bit (12
 * runs of bench/constants.py). */
static const double same_slope = 1e-9, whole = 1 - 1e-9;

struct term {
    double time, j;        /* s, -; time INFINITY: flows, with j in 1/s */
    double keep, old, new; /* in the present step */
};

struct run {
    double t;          /* s: end of the present step */
    size_t steps;      /* of this leg, with the present one */
    double *w;         /* m, at the start of the step */
    double *r;         /* m, one map for each term    */
    double *before;    /* m: the w or mean of w that the last step had before its end, or the mean
                          of w over the last step if the present step takes it */
    double last, part; /* s: the last step, 0 after a corner; part of w in its mean */
};

/* How a step weighs the w from which it starts. */
struct weights {
    double dt, last; /* s: the step, and the one before it; 0: it starts from a corner */
    double jump;     /* part of the change of w that comes at the start of the step, at least */
    double c;        /* C of the step */
    double part;     /* of w' in the mean of w over the step */
    bool mean;       /* `old` belongs to the mean of w over the last step */
};

/* A number that goes through the same steps as the w of a node. */
struct follower {
    double now, before, *r;
};

struct material {
    size_t terms, slowest;
    struct term *term;
    double quickest; /* s: shortest time in which a pressure relaxes or grows */
    double settle;   /* s: by then the fast terms have settled; 0: there are none */
    /* s: mean delay of the fast terms under a held load, and at a held approach */
    double delay[2];
    /* errors of fast and slow terms, relative to the largest load of the leg and of the history */
    double left_out[2];
};

/* Heights of the inner model; two that are free; what find_touch finds at the end of the coarse runs, and
 * before the last step of the fine one. */
struct maps {
    double *posed, *room, *gap, *coarse[FINE], *before;
};

/* The way from one point to the next. */
struct leg {
    double start, end;          /* s */
    double settle;              /* s: a step before all others, or 0 */
    double least, most, shrink; /* s, s, -: first and longest step of the fine run, times shrink */
    size_t increments;
    size_t steps; /* of the fine run; a multiple of 4 */
    double tried; /* estimate of the last try; INFINITY: none */
    double slope; /* of load or approach in the last leg, per s */
    bool taken;   /* the end is reached */
};

struct viscoelastic {
    struct rc_model base;
    struct rc_viscoelastic_problem problem;
    const double *h; /* the caller's */
    size_t n;
    struct material material;
    struct follower load, error; /* N: load after the last step, and error of its pressure */
    double most, rate;           /* N, N/s: largest load so far; its change in the last step */
    struct run run[RUNS];
    size_t on; /* the present run */
    struct maps maps;
    struct leg leg;
    struct weights weights;
    double top, posed_top; /* m: highest nodes of h and posed */
    double beyond;         /* m: gap at first touch, at a given approach without contact */
    double between;        /* relative difference of the pressures of the two runs */
    double inherited;      /* relative error of the pressure from the errors of earlier contacts */
    bool good;             /* all contacts have converged */
    struct rc_viscoelastic_figures f;
};

const struct rc_figure rc_figures_viscoelastic[] = {
#define FIGURE(member) RC_FIGURE(struct rc_viscoelastic_figures, member)
    {FIGURE(time), "s", "Time"},
    {FIGURE(increments), NULL, "Increments", .role = RC_FIGURE_COST,
     .says = "steps from the previous point"},
    {RC_FIGURE_AS("increment_error_estimate", struct rc_viscoelastic_figures, increment_error),
     NULL, "Error of the increments", .says = "estimated relative L1 error of the pressure",
     .role = RC_FIGURE_ERROR, .by = "increments", .of = "pressure"},
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
    {rc_figures_contact, offsetof(struct viscoelastic, f.contact)},
    {rc_figures_viscoelastic, offsetof(struct viscoelastic, f)},
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

/* Chooses the terms of the history. All fast ones are one term with their mean lag, and all slow ones are
 * another. */
static void
choose_terms(struct material *material, const struct rc_viscoelastic_problem *a)
{
    const struct rc_relaxation *m = a->material;
    const double unit = a->share / m->instant, low = fast * a->shortest,
                 high = a->longest > 0 ? slow * a->longest : INFINITY;
    double at_once = 0, lag = 0, flow = unit * m->fluidity, of_fast = 0, of_slow = 0;

    material->quickest = INFINITY;
    for (size_t k = 0; k < m->creep_terms; k++) {
        const double th = m->retardation[k], j = unit * m->compliance[k];
        if (th < low) {
            at_once += j;
            lag += j * th;
            of_fast += 2 * j * pow(th / a->shortest, 2);
        } else if (th > high) {
            flow += j / th;
            of_slow += j * pow(a->longest / th, 2) / 2;
        } else {
            material->term[material->terms++] = (struct term){.time = th, .j = j};
        }
    }
    /* each relaxation time is shorter than the retardation time of its place; the last one of a fluid has
     * none */
    for (size_t k = 0; k < m->terms; k++)
        if (k >= m->creep_terms || (m->retardation[k] >= low && m->time[k] <= high))
            material->quickest = fmin(material->quickest, fmax(low, m->time[k]));
    material->left_out[0] = of_fast / (1 + at_once);
    material->left_out[1] = of_slow / (1 + flow * a->longest);
    material->settle = at_once > 0 ? low : 0;
    material->delay[0] = at_once > 0 ? lag / at_once : 0;
    material->delay[1] = material->delay[0] / (1 + at_once);
    if (at_once > 0)
        material->term[material->terms++] = (struct term){.time = lag / at_once, .j = at_once};
    if (flow > 0)
        material->term[material->terms++] = (struct term){.time = INFINITY, .j = flow};
    for (size_t k = 0; k < material->terms; k++)
        if (material->term[k].time > material->term[material->slowest].time)
            material->slowest = k;
}

/* The mean of 1 - exp(-s) for s from 0 to x > 0. */
static double
mean_of_creep(double x)
{
    const double series = 0.01; /* the difference loses digits below it */

    return x < series ? x * (1.0 / 2 - x * (1.0 / 6 - x * (1.0 / 24 - x / 120)))
                      : 1 + expm1(-x) / x;
}

/* The weight of the w before a step in which it changes linearly. */
static double
old_of(const struct term *m, double dt)
{
    const double x = dt / m->time;

    return isinf(m->time) ? m->j * dt / 2 : dt > 0 ? m->j * (-expm1(-x) - mean_of_creep(x)) : 0;
}

/* Finds the weights of the terms for w that changes linearly in the step, and returns the sum of old. */
static double
weigh_linear(struct material *material, double dt)
{
    double old = 0;

    for (size_t k = 0; k < material->terms; k++) {
        struct term *m = &material->term[k];
        const double x = dt / m->time, gone = -expm1(-x);
        if (dt == 0) {
            m->keep = 1;
            m->old = m->new = 0;
        } else if (isinf(m->time)) {
            m->keep = 1;
            m->old = m->new = m->j *dt / 2;
        } else {
            const double part = mean_of_creep(x);
            m->keep = exp(-x);
            m->new = m->j *part;
            m->old = m->j * (gone - part);
        }
        old += m->old;
    }
    return old;
}

/* Finds the weights of a step. In a long one w is linear from the middle of the last step on, where it had
 * its mean, or, after a corner, jumps at once by a part q of its change. */
static void
weigh(struct material *material, struct weights *to)
{
    const double old = weigh_linear(material, to->dt), longer = to->dt / to->last;
    const bool stiff = old > 1, corner = to->last == 0;
    double q = to->jump;

    to->mean = stiff && longer <= most_longer;
    if (stiff)
        q = to->mean ? 1 / (1 + 2 * longer) : fmax(q, 1 - 1 / old);
    to->part = corner ? 1 : (1 + q) / 2;
    to->c = 1;
    for (size_t k = 0; k < material->terms; k++) {
        struct term *m = &material->term[k];
        m->new += q * m->old;
        m->old -= q * m->old;
        to->c += m->new;
    }
}

/* The mean of w over the last step. */
static double
mean_of(const struct run *run, double now, double before)
{
    return run->part * now + (1 - run->part) * before;
}

/* The displacement after the step, less C w'. */
static void
find_history(const struct material *m, const struct run *run, const double *w, size_t n, double *to)
{
    double of_w = 0;

    for (size_t k = 0; k < m->terms; k++)
        of_w += m->term[k].old;
    for (size_t i = 0; i < n; i++)
        to[i] = of_w * w[i];
    for (size_t k = 0; k < m->terms; k++) {
        const double *r = run->r + k * n;
        for (size_t i = 0; i < n; i++)
            to[i] += m->term[k].keep * r[i];
    }
}

/* Takes a number through the step. */
static void
follow(const struct viscoelastic *v, struct follower *f, double next)
{
    const double from = v->weights.mean ? f->before : f->now;

    for (size_t k = 0; k < v->material.terms; k++) {
        const struct term m = v->material.term[k];
        f->r[k] = m.keep * f->r[k] + m.old * from + m.new *next;
    }
    f->before = from;
    f->now = next;
}

/* The number that the history alone would give after the step. */
static double
history_of(const struct viscoelastic *v, const struct follower *f)
{
    const double from = v->weights.mean ? f->before : f->now;
    double sum = 0;

    for (size_t k = 0; k < v->material.terms; k++)
        sum += v->material.term[k].keep * f->r[k] + v->material.term[k].old * from;
    return -sum / v->weights.c;
}

/* ---- a step ---- */

static bool
by_approach(const struct viscoelastic *v)
{
    return rc_point_has(&v->base.to, RC_APPROACH);
}

/* Load or approach of the inner model at the end of the step. Its approach counts from the first touch of its
 * own heights. */
static struct rc_point
target(struct viscoelastic *v)
{
    const struct rc_point *from = &v->base.from, *to = &v->base.to;
    const double way = v->leg.end - v->leg.start;
    struct rc_point at =
        rc_point_between(from, to, way > 0 ? (v->run[v->on].t - v->leg.start) / way : 1);
    double approach;

    at = rc_point_for(v->base.inner, &at);
    v->beyond = 0;
    if (by_approach(v)) {
        approach = (at.at[RC_APPROACH] - v->top) / v->weights.c + v->posed_top;
        v->beyond = fmax(0, -v->weights.c * approach);
        rc_point_set(&at, RC_APPROACH, fmax(0, approach));
    }
    return at;
}

/* Steps of the fine run in one of each run. */
static const size_t merged[RUNS] = {4, 2, 1};

/* Step i of the fine run. Steps grow in proportion to the time since a corner of the load. */
static double
fine_step(const struct leg *leg, size_t i)
{
    const double growth = pow(10, (double)i / (per_decade * (double)leg->increments));

    return leg->shrink * fmin(leg->most, leg->least * growth);
}

/* Divides the leg into steps. A step of a coarse run is two or four of the fine one. */
static void
divide(struct leg *leg, const struct material *material, bool corner, bool jumped,
       size_t increments)
{
    const double whole_way = leg->end - leg->start, n = (double)increments;
    double sum = 0, way;

    leg->least =
        corner ? material->quickest / n : fine_step(leg, leg->steps) * (double)leg->increments / n;
    leg->increments = increments;
    leg->most = whole_way / n;
    leg->shrink = 1;
    leg->steps = 0;
    leg->settle =
        jumped && fine_step(leg, 0) > much_longer * material->settle ? material->settle : 0;
    way = whole_way - leg->settle;
    while (way > 0 && (sum < whole * way || leg->steps % merged[QUARTER] > 0))
        sum += fine_step(leg, leg->steps++);
    leg->shrink = way > 0 ? way / sum : 1;
}

/* The length of the next step. */
static double
next_step(const struct leg *leg, struct run *run, size_t times)
{
    size_t i;
    bool last;
    double dt = 0;

    if (leg->settle > 0 && run->steps == 0 && run->last == 0)
        return leg->settle;
    i = run->steps++;
    last = run->steps >= leg->steps / times;
    for (size_t k = 0; k < times; k++)
        dt += fine_step(leg, times * i + k);
    return leg->end == leg->start ? 0 : last ? leg->end - run->t : dt;
}

static void
take_means(struct viscoelastic *v, struct run *run)
{
    struct follower *const all[] = {&v->load, &v->error};

    for (size_t i = 0; i < v->n; i++)
        run->before[i] = mean_of(run, run->w[i], run->before[i]);
    for (size_t k = 0; k < 2 && v->on == FINE; k++)
        all[k]->before = mean_of(run, all[k]->now, all[k]->before);
}

/* A pressure in contact, and elsewhere, below 0, the gap over the displacement of a cell under unit pressure:
 * a node which a displacement closes has no more pressure than the displacement beyond its gap gives. */
static enum rc_status
find_touch(struct viscoelastic *v, double *to, struct rc_err *err)
{
    const double own = rc_elastic_own(v->base.inner);

    if (rc_model_frame(v->base.inner, "pressure", to, err) != RC_OK ||
        rc_model_frame(v->base.inner, "gap", v->maps.gap, err) != RC_OK)
        return RC_FAIL;
    for (size_t i = 0; i < v->n && own > 0; i++)
        if (!rc_in_contact(to[i]))
            to[i] = -fmax(0, v->weights.c * v->maps.gap[i] + v->beyond) / own;
    return RC_OK;
}

/* All runs take the same step for the fast terms to settle, so their differences do not show its error. With
 * w' after the step, the integral of w - w' over it is (w - w') d, where d is the delay of the fast terms. If
 * w jumps by a part q of its change and is then linear, the integral is (1 - q)/2 (w - w') dt: q = 1 - 2d/dt.
 * With the sums a of J and b of th J over the fast terms, d = b/a under a held load. At a held approach the
 * pressure has the Laplace transform 1/(s (1 + a - s b + ...)), so that d = b/(a (1 + a)). */
static double
jump_of(const struct viscoelastic *v)
{
    const double dt = v->weights.dt;
    const bool settles = v->weights.last == 0 && dt > 0 && dt == v->leg.settle;

    return settles ? fmax(0, 1 - 2 * v->material.delay[by_approach(v)] / dt) : 0;
}

static enum rc_status
start_step(struct viscoelastic *v, struct rc_err *err)
{
    struct run *run = &v->run[v->on];
    const double dt = next_step(&v->leg, run, merged[v->on]);
    struct rc_point at;

    if (v->on == FINE && run->steps == v->leg.steps && find_touch(v, v->maps.before, err) != RC_OK)
        return RC_FAIL;

    v->weights.dt = dt;
    v->weights.last = run->last;
    v->weights.jump = jump_of(v);
    weigh(&v->material, &v->weights);
    run->t = dt == v->leg.end - run->t ? v->leg.end : run->t + dt;
    if (v->weights.mean)
        take_means(v, run);
    find_history(&v->material, run, v->weights.mean ? run->before : run->w, v->n, v->maps.posed);
    for (size_t i = 0; i < v->n; i++)
        v->maps.posed[i] = (v->h[i] - v->maps.posed[i]) / v->weights.c;
    v->posed_top = rc_ranks_highest(v->base.rows.ranks, v->maps.posed, v->n);
    at = target(v);
    if (rc_model_set_heights(v->base.inner, v->maps.posed, err) != RC_OK)
        return RC_FAIL;
    return rc_model_go(v->base.inner, &at, err);
}

/* The error of the load due to the rounding of displacements, whose difference is small after the pressure
 * has relaxed by many orders. */
static double
of_rounding(const struct viscoelastic *v, const struct rc_point *at)
{
    const double own = rc_elastic_own(v->base.inner),
                 approach = v->weights.c * (at->at[RC_APPROACH] - v->posed_top) + v->top,
                 area = v->base.shape.dx * v->base.shape.dy *
                        rc_model_number(v->base.inner, "contact_nodes");

    return own > 0 ? DBL_EPSILON * (fabs(v->top) + fabs(approach)) / own * area : 0;
}

/* At a given approach a contact can end within a step. From then on w is 0, and each term has taken too much
 * of the w before the step. The time follows from the gap at the end, as w falls evenly. A contact can also
 * begin; there the terms have at most their whole part of the new w too much. */
static void
add_kink(struct viscoelastic *v, double load)
{
    const double from = v->weights.mean ? v->load.before : v->load.now, dt = v->weights.dt;
    double top, part;

    if (!by_approach(v) || (load > 0) == (v->load.now > 0))
        return;
    top = rc_ranks_highest(v->base.rows.ranks, v->weights.mean ? v->maps.room : v->run[FINE].before,
                           v->n);
    part = top > 0 ? top / (top + v->beyond / v->weights.c) : 0;
    for (size_t k = 0; k < v->material.terms; k++) {
        const struct term *m = &v->material.term[k];
        const double all = old_of(m, dt),
                     gone = part > 0 ? exp(-(1 - part) * dt / m->time) * old_of(m, part * dt) : 0;
        v->error.r[k] += m->new *load;
        if (all > gone)
            v->error.r[k] += m->old * from * (1 - gone / all);
    }
}

/* The error of a contact changes the heights of all later ones. As long as the same nodes touch, it decays
 * like a pressure that relaxes; where others touch, no pressure changes by more, in the norm of the elastic
 * energy. The rounding of the history, half a unit in each step, remains in the slowest term. */
static void
follow_load(struct viscoelastic *v, const struct rc_point *at)
{
    const double load = at->at[RC_LOAD],
                 own = load > 0 ? fmin(largest,
                                       rc_model_number(v->base.inner, "pressure_error_estimate"))
                                : 0,
                 rounding = load > 0 ? of_rounding(v, at) : 0,
                 old = load > 0 ? history_of(v, &v->error) : 0;

    v->inherited = load > 0 ? fabs(old) / load : 0;
    v->rate = v->weights.dt > 0 ? fabs(load - v->load.now) / v->weights.dt : 0;
    follow(v, &v->error, own * load + rounding / v->weights.c + old);
    if (v->material.terms > 0)
        v->error.r[v->material.slowest] += rounding / 2;
    add_kink(v, load);
    follow(v, &v->load, load);
    v->most = fmax(v->most, load);
}

/* The contact of the step is found: its displacement goes into the history. */
static enum rc_status
take_step(struct viscoelastic *v, enum rc_status status, struct rc_err *err)
{
    struct run *run = &v->run[v->on];
    const double *from = v->weights.mean ? run->before : run->w;
    double *w = v->maps.room;
    struct rc_point at;

    if (rc_model_look(v->base.inner, &at, err) != RC_OK ||
        rc_model_frame(v->base.inner, "displacement", w, err) != RC_OK)
        return RC_FAIL;
    if (rc_model_number(v->base.inner, "plastic_area") > 0)
        return rc_err_set(err, "a hardness of viscoelastic bodies is not implemented");
    for (size_t k = 0; k < v->material.terms; k++) {
        const struct term m = v->material.term[k];
        double *r = run->r + k * v->n;
        for (size_t i = 0; i < v->n; i++)
            r[i] = m.keep * r[i] + m.old * from[i] + m.new *w[i];
    }
    v->maps.room = v->weights.mean ? run->w : run->before;
    run->before = v->weights.mean ? run->before : run->w;
    run->w = w;
    run->last = v->weights.dt;
    run->part = v->weights.part;
    if (v->on == FINE) {
        follow_load(v, &at);
        v->f.increments++;
    }
    v->f.contact.convolutions += rc_model_number(v->base.inner, "convolutions");
    v->good = v->good && (status == RC_OK || at.at[RC_LOAD] == 0);
    return RC_OK;
}

/* ---- legs ---- */

static enum rc_status
start_run(struct viscoelastic *v, size_t on, struct rc_err *err)
{
    struct rc_model *inner = v->base.inner;
    const enum rc_status status = (v->on = on, start_step(v, err));

    /* the last pressure belongs to the other end of the leg */
    if (on == FINE && v->leg.end > v->leg.start && status == RC_MORE &&
        rc_model_start(inner, 0, NULL, err) != RC_OK)
        return RC_FAIL;
    return status;
}

/* C of a step of this length in which w is linear. */
static double
linear_c(const struct material *material, double dt)
{
    double c = 1;

    for (size_t k = 0; k < material->terms; k++) {
        const struct term *m = &material->term[k];
        c += m->j * (isinf(m->time) ? dt / 2 : mean_of_creep(dt / m->time));
    }
    return c;
}

/* The error of the pressure of a node that has joined the contact in the last step, from the gap before it.
 * The step takes the displacement of this node as linear since its beginning; it is linear since the gap
 * closed, and the body then had less time to creep. */
static double
of_joining(const struct viscoelastic *v, double pressure, double before)
{
    const double c = v->weights.c, way = pressure * c, since = v->weights.dt * way / (way - before);

    return before < 0 ? pressure * fabs(c / linear_c(&v->material, since) - 1) : 0;
}

/* The relative error of the pressure due to the steps. With errors that fall r times where the steps are
 * halved, it is the difference of the fine and the half run over r - 1; r is that of the two differences. A
 * part of the other difference guards against one that is small by chance. A node that touches in no run may
 * do so where the difference of its gaps exceeds its gap. What a node has too much, the others have too
 * little. Bodies that are apart at a given approach, and may touch, have the largest error; their gaps err by
 * as many differences as a pressure whose errors fall least. */
static double
error_of_steps(const struct viscoelastic *v, const double *fine)
{
    enum {
        FINE_SUM,
        HALF_SUM,
        LAST,
        FORMER,
        JOINS,
        TOUCHES,
        SUMS
    };
    struct rc_total total[SUMS] = {{0}};
    double sum[SUMS], size, fell;

    for (size_t i = 0; i < v->n; i++) {
        const double f = fine[i], h = v->maps.coarse[HALF][i], q = v->maps.coarse[QUARTER][i],
                     p = fmax(0, f), of_h = fmax(0, h);
        rc_total_add(&total[FINE_SUM], p);
        rc_total_add(&total[HALF_SUM], of_h);
        rc_total_add(&total[LAST], fabs(p - of_h));
        rc_total_add(&total[FORMER], fabs(of_h - fmax(0, q)));
        rc_total_add(&total[TOUCHES], fmax(0, f + fabs(f - h) / (least_fall - 1)));
        if (p == 0 && of_h == 0)
            rc_total_add(&total[JOINS], fmax(0, f + fabs(f - h)));
        else if (p > 0 && v->leg.end > v->leg.start)
            rc_total_add(&total[JOINS], of_joining(v, p, v->maps.before[i]));
    }
    rc_ranks_totals(v->base.rows.ranks, SUMS, total, sum, 0, NULL);
    size = fmax(sum[FINE_SUM], sum[HALF_SUM]);
    if (size == 0)
        return by_approach(v) && sum[TOUCHES] > 0 ? largest : 0;
    fell = sum[LAST] > 0 ? fmax(least_fall, sum[FORMER] / sum[LAST]) : INFINITY;
    return (fmax(sum[LAST] * fmax(1, 1 / (fell - 1)), of_former * sum[FORMER]) + 2 * sum[JOINS]) /
           size;
}

/* The relative error due to terms that are left out. */
static double
left_out(const struct viscoelastic *v)
{
    const double now = v->load.now, *part = v->material.left_out;
    double change = fmax(now, v->rate * v->problem.shortest);

    if (v->base.from.given != 0)
        change = fmax(change, v->base.from.at[RC_LOAD]);
    return now > 0 ? part[0] * change / now + part[1] * v->most / now : part[0] + part[1];
}

/* The part of the tolerance that earlier contacts have left to the steps. */
static double
goal(const struct viscoelastic *v)
{
    return fmax(v->problem.tol - v->inherited - left_out(v), v->problem.tol / 2);
}

/* True if the model chooses the increments, and more of them can lower the error of this leg. */
static bool
deserves_more(const struct viscoelastic *v)
{
    const struct leg *leg = &v->leg;

    return v->problem.increments == 0 && leg->end > leg->start && leg->increments < MOST_AUTO &&
           v->between > goal(v) && v->between < helps * leg->tried;
}

/* Increments for the aim, of an error of second order. */
static size_t
increments_for(size_t increments, double error, double tol, double least, double most)
{
    const double times = sqrt(error / (aim * tol));

    return (size_t)fmin(MOST_AUTO, ceil((double)increments * fmin(fmax(times, least), most)));
}

static enum rc_status start_leg(struct viscoelastic *v, size_t increments, struct rc_err *err);

/* Returns to the start of the leg and takes more increments. */
static enum rc_status
try_again(struct viscoelastic *v, struct rc_err *err)
{
    const size_t increments =
        increments_for(v->leg.increments, v->between, goal(v), least_more, most_more);
    const double work = v->f.contact.convolutions, tried = v->between;

    if (rc_model_recall(&v->base, err) != RC_OK)
        return RC_FAIL;
    v->leg.tried = tried;
    v->f.contact.convolutions = work;
    return start_leg(v, increments, err);
}

static enum rc_status
judge(const struct viscoelastic *v)
{
    return v->good && v->f.increment_error + v->inherited <= v->problem.tol ? RC_OK : RC_SHORT;
}

/* Starts the next step, or the fine run; or ends the leg. */
static enum rc_status
go_on(struct viscoelastic *v, struct rc_err *err)
{
    const bool begins = v->base.from.given == 0;

    if (v->run[v->on].t < v->leg.end)
        return start_step(v, err);
    if (v->on != FINE)
        return find_touch(v, v->maps.coarse[v->on], err) == RC_OK ? start_run(v, v->on + 1, err)
                                                                  : RC_FAIL;
    if (begins) { /* all runs start from the same contact */
        for (size_t k = 0; k < FINE; k++) {
            memcpy(v->run[k].w, v->run[FINE].w, v->n * sizeof *v->maps.room);
            v->run[k].t = v->leg.end;
        }
        v->f.increment_error = left_out(v);
    } else {
        if (find_touch(v, v->maps.room, err) != RC_OK)
            return RC_FAIL;
        v->between = error_of_steps(v, v->maps.room);
        v->f.increment_error = left_out(v) + v->between;
        if (deserves_more(v))
            return try_again(v, err);
    }
    v->leg.taken = true;
    return judge(v);
}

static enum rc_status
step(struct rc_model *m, struct rc_err *err)
{
    struct viscoelastic *v = (struct viscoelastic *)m;
    const enum rc_status status = rc_model_step(m->inner, err);

    if (status == RC_MORE || status == RC_FAIL)
        return status;
    if (v->leg.taken) /* after a state was read */
        return judge(v);
    return take_step(v, status, err) == RC_OK ? go_on(v, err) : RC_FAIL;
}

static enum rc_status
allocate(struct viscoelastic *v, struct rc_err *err)
{
    double **maps[] = {&v->maps.posed,           &v->maps.room,         &v->maps.gap,
                       &v->maps.coarse[QUARTER], &v->maps.coarse[HALF], &v->maps.before,
                       &v->run[QUARTER].w,       &v->run[HALF].w,       &v->run[FINE].w,
                       &v->run[QUARTER].before,  &v->run[HALF].before,  &v->run[FINE].before};

    if (v->maps.posed != NULL)
        return RC_OK;
    for (size_t k = 0; k < RUNS; k++)
        v->run[k].r = rc_store_zeros(&v->base.own, v->material.terms * v->n, sizeof(double));
    for (size_t k = 0; k < MAPS && !v->base.own.failed; k++)
        *maps[k] = rc_store_zeros(&v->base.own, v->n, sizeof(double));
    return rc_model_room(&v->base, err);
}

/* True if the load or the approach changes at another rate than in the last leg. */
static bool
turns(struct leg *leg, enum rc_axis axis, const struct rc_point *from, const struct rc_point *to)
{
    const double last = leg->slope,
                 slope = (to->at[axis] - from->at[axis]) / (leg->end - leg->start);

    leg->slope = isfinite(slope) ? slope : INFINITY; /* a state holds no NaN */
    return !(fabs(slope - last) <= same_slope * fabs(slope));
}

static enum rc_status
start_leg(struct viscoelastic *v, size_t increments, struct rc_err *err)
{
    const bool begins = v->base.from.given == 0;
    bool corner;

    v->leg.end = v->base.to.at[RC_TIME];
    v->leg.start = begins ? v->leg.end : v->base.from.at[RC_TIME];
    v->f.increments = 0;
    v->leg.taken = false;
    if (begins)
        v->run[FINE].t = v->leg.end;
    corner = turns(&v->leg, by_approach(v) ? RC_APPROACH : RC_LOAD, &v->base.from, &v->base.to);
    divide(&v->leg, &v->material, corner, v->weights.dt == 0 && v->load.now > 0, increments);
    for (size_t k = 0; k < RUNS; k++) {
        v->run[k].steps = 0;
        v->run[k].last = corner ? 0 : v->run[k].last;
    }
    return start_run(v, begins ? FINE : QUARTER, err);
}

static enum rc_status
go(struct rc_model *m, struct rc_err *err)
{
    struct viscoelastic *v = (struct viscoelastic *)m;
    const size_t given = v->problem.increments;

    if (m->to.at[RC_APPROACH] < 0 && by_approach(v))
        return rc_err_set(err, "approach %g m: it must be at least 0", m->to.at[RC_APPROACH]);
    if (by_approach(v) && rc_elastic_reach(m->inner, v->h, m->to.at[RC_APPROACH], err) != RC_OK)
        return RC_FAIL;
    if (allocate(v, err) != RC_OK)
        return RC_FAIL;
    v->leg.tried = INFINITY;
    v->f.contact.convolutions = 0;
    /* the next leg often needs as many as the last one */
    return start_leg(v,
                     given > 0 ? given
                     : v->leg.increments == 0
                         ? USUAL
                         : (size_t)fmax(USUAL, (double)increments_for(v->leg.increments, v->between,
                                                                      v->problem.tol, 0, 1)),
                     err) == RC_FAIL
               ? RC_FAIL
               : RC_OK;
}

/* ---- results ---- */

static enum rc_status
fill(struct rc_model *m, size_t frame, double *to, struct rc_err *err)
{
    const struct viscoelastic *v = (const struct viscoelastic *)m;

    if (rc_model_frame(m->inner, frames[frame].name, to, err) != RC_OK)
        return RC_FAIL;
    for (size_t i = 0; i < v->n; i++)
        to[i] = v->weights.c * to[i] +
                (frame == GAP ? v->beyond : v->h[i] - v->weights.c * v->maps.posed[i]);
    return RC_OK;
}

/* The first touch of the heights less the history. */
static double
residual(const struct viscoelastic *v)
{
    const double *r = v->run[FINE].r;
    double top = -INFINITY;

    for (size_t i = 0; i < v->n; i++) {
        double left = v->h[i];
        for (size_t k = 0; k < v->material.terms; k++)
            left -= r[k * v->n + i];
        top = fmax(top, left);
    }
    return v->top - rc_ranks_most(v->base.rows.ranks, top);
}

static enum rc_status
look(struct rc_model *m, struct rc_point *at, struct rc_err *err)
{
    struct viscoelastic *v = (struct viscoelastic *)m;
    const double work = v->f.contact.convolutions, c = v->weights.c;
    struct rc_viscoelastic_figures *f = &v->f;

    (void)err;
    f->contact = rc_elastic_result(m->inner)->contact;
    f->contact.convolutions = work;
    f->contact.approach =
        by_approach(v) ? m->to.at[RC_APPROACH] : c * (f->contact.approach - v->posed_top) + v->top;
    f->contact.mean_gap = c * f->contact.mean_gap + v->beyond;
    f->contact.gap_error *= c;
    f->contact.elastic_energy = NAN; /* the bodies dissipate a part of the work */
    f->contact.inherited_error = v->inherited;
    f->contact.pressure_error +=
        f->contact.load != 0 ? v->inherited + f->increment_error : v->between;
    f->contact.converged = v->leg.taken && judge(v) == RC_OK;
    f->time = v->leg.taken ? v->leg.end : v->run[v->on].t;
    f->equivalent_load = v->load.now;
    for (size_t k = 0; k < v->material.terms; k++)
        f->equivalent_load += v->load.r[k];
    f->indentation = f->contact.approach;
    f->residual_indentation = v->leg.taken ? residual(v) : NAN;
    at->at[RC_TIME] = f->time;
    at->at[RC_LOAD] = f->contact.load;
    at->at[RC_APPROACH] = f->contact.approach;
    return RC_OK;
}

/* ---- states ---- */

static void
state(struct rc_model *m, struct rc_state *s)
{
    struct viscoelastic *v = (struct viscoelastic *)m;
    bool begun = v->maps.posed != NULL;
    struct rc_err err;

    rc_state_count(s, &v->on, FINE);
    RC_STATE_FLAGS(s, &begun, &v->good, &v->leg.taken);
    RC_STATE_COUNTS(s, &v->f.increments, &v->leg.increments, &v->leg.steps);
    RC_STATE_NUMBERS(s, &v->leg.start, &v->leg.end, &v->leg.settle, &v->weights.dt,
                     &v->weights.last, &v->beyond, &v->leg.shrink, &v->most, &v->rate, &v->between,
                     &v->inherited, &v->posed_top, &v->f.increment_error,
                     &v->f.contact.convolutions, &v->load.now, &v->load.before, &v->error.now,
                     &v->error.before);
    for (size_t k = 0; k < RUNS; k++) {
        RC_STATE_COUNTS(s, &v->run[k].steps);
        RC_STATE_NUMBERS(s, &v->run[k].t, &v->run[k].last, &v->run[k].part);
    }
    RC_STATE_OPEN(s, &v->leg.slope, &v->leg.least, &v->leg.most, &v->leg.tried);
    rc_state_finite(s, v->material.terms, v->load.r);
    rc_state_finite(s, v->material.terms, v->error.r);
    if (rc_state_reads(s) && begun && allocate(v, &err) != RC_OK)
        rc_state_refuse(s, "memory is short");
    if (!begun)
        return;
    for (size_t k = 0; k < RUNS; k++) {
        rc_state_map(s, v->n, v->run[k].w);
        rc_state_map(s, v->n, v->run[k].before);
        for (size_t q = 0; q < v->material.terms; q++)
            rc_state_map(s, v->n, v->run[k].r + q * v->n);
    }
    rc_state_map(s, v->n, v->maps.posed);
    rc_state_map(s, v->n, v->maps.before);
    for (size_t k = 0; k < FINE; k++)
        rc_state_map(s, v->n, v->maps.coarse[k]);
    if (!rc_state_reads(s))
        return;
    v->weights.jump = jump_of(v);
    weigh(&v->material, &v->weights);
    if (rc_model_set_heights(m->inner, v->maps.posed, &err) != RC_OK)
        rc_state_refuse(s, "its heights are not finite");
}

static void
progress(const struct rc_model *m, struct rc_loops *l)
{
    const struct viscoelastic *v = (const struct viscoelastic *)m;

    rc_loops_add(l, "time", "s", v->run[v->on].t, v->leg.end);
    rc_loops_add(l, "step", NULL, (double)v->f.increments, NAN);
}

/* Steps of a point in both runs, of a part of the whole history. The error of the usual number is `usual`; it
 * decreases as the square of their number. */
static double
steps_of(const struct rc_viscoelastic_problem *a, double quickest, double part)
{
    const double usual = 6e-4;
    const double n =
        a->increments > 0 ? (double)a->increments : (double)USUAL * fmax(sqrt(usual / a->tol), 1);
    double decades = 0, runs = 0;

    if (!(a->longest > 0))
        return 0;
    if (isfinite(quickest))
        decades = fmax(0, log10(a->longest / fmin(quickest, a->longest)));
    for (size_t k = 0; k < RUNS; k++)
        runs += 1 / (double)merged[k];
    return (n + per_decade * n * decades * part) * runs;
}

static enum rc_status
plan(const struct rc_model *m, const struct rc_point *most, struct rc_expected *expected,
     struct rc_err *err)
{
    const struct viscoelastic *v = (const struct viscoelastic *)m;
    const struct rc_point inner = rc_point_for(m->inner, most);
    const size_t maps = RUNS * v->material.terms;
    const double part = 1 / (double)v->problem.points;
    double one;

    if (rc_model_plan(m->inner, &inner, expected, err) != RC_OK)
        return RC_FAIL;
    one = expected->seconds / expected->convolutions;
    expected->convolutions = part * expected->convolutions +
                             (rc_point_has(most, RC_APPROACH) ? RC_CREEP_APPROACH : RC_CREEP_STEP) *
                                 steps_of(&v->problem, v->material.quickest, part);
    expected->seconds = expected->convolutions * one;
    /* with the copy of the state at the last kept point */
    expected->memory += v->n * (2 * maps + MAPS + 2 * RUNS + 4) * sizeof(double);
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
make(struct viscoelastic *v, const double *h, const struct rc_viscoelastic_problem *a,
     struct rc_err *err)
{
    const struct rc_ranks *ranks = v->base.rows.ranks;
    const size_t most = a->material->creep_terms + 2;
    enum rc_status status = RC_OK;

    if (check(v->base.inner, a, err) != RC_OK)
        return RC_FAIL;
    v->problem = *a;
    v->problem.points = a->points > 0 ? a->points : 1;
    v->problem.tol = a->tol > 0 ? a->tol : usual_tol;
    v->n = rc_model_nodes(&v->base);
    for (size_t k = 0; k < v->n && status == RC_OK; k++)
        if (!isfinite(h[k]))
            status = rc_err_set(err, "height %zu is not a finite number",
                                v->base.rows.first * v->base.shape.nx + k);
    if (rc_ranks_agree(ranks, status, err) != RC_OK)
        return RC_FAIL;
    v->h = rc_store_copy(&v->base.own, v->n, sizeof *h, h);
    v->top = rc_ranks_highest(ranks, h, v->n);
    v->good = true;
    v->leg.slope = INFINITY;
    v->weights.c = v->leg.shrink = 1;
    v->material.term = rc_store_take(&v->base.own, most, sizeof *v->material.term);
    v->load.r = rc_store_zeros(&v->base.own, most, sizeof *v->load.r);
    v->error.r = rc_store_zeros(&v->base.own, most, sizeof *v->error.r);
    if (rc_model_room(&v->base, err) != RC_OK)
        return RC_FAIL;
    choose_terms(&v->material, &v->problem);
    return RC_OK;
}

struct rc_model *
rc_viscoelastic_new(struct rc_model *inner, const double *h,
                    const struct rc_viscoelastic_problem *problem, struct rc_err *err)
{
    RC_OWN(rc_model, m) =
        rc_model_make_outer(&rc_model_viscoelastic, sizeof(struct viscoelastic), inner, err);

    return m != NULL && make((struct viscoelastic *)m, h, problem, err) == RC_OK ? rc_give(&m)
                                                                                 : NULL;
}
