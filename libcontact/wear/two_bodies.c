/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The model of two rough bodies that slide over each other along x, on a map that repeats, and wear. Body 2
 * passes all its alignments X over body 1 before the heights change much. Each body loses the mean over X:
 *
 *     dh1(x)/ds = -k1 mean p(x; X),   dh2(x)/ds = -k2 mean p(x + X; X)
 *
 * with the pressure p(x; X) of the heights h1(x) + h2(x - X). A step of backward Euler takes one alignment,
 * by whole nodes: the contact has the compliance (k1 + k2) ds. This is a proximal step of one of the convex
 * functions whose mean is minimized, so it is stable at any length. The alignments follow the golden ratio,
 * which spreads any number of them evenly. A step is a fraction of the distance slid so far, and the mean is
 * that over the last 1/fraction steps. The method is of first order in the fraction.
 *
 * Two runs go side by side with different alignments, one with half the steps of the other. The result is
 * that of the finer one, and their largest difference lately is the estimate of its error: at a single
 * distance both may come close to each other by chance. The runs have different alignments, to which the
 * errors e1 and e2 of their heights are due. In one alignment their pressures differ by S (e1 - e2), where S
 * is the response of this contact. The difference is far below S e1 where S e1 and S e2 are alike by chance.
 * The estimate of the pressure is therefore the largest difference in several alignments. A leg whose worn
 * depth is not accurate enough is taken again with shorter steps.
 */
#include "wear.h"

#include <math.h>
#include <string.h>

#include "libcontact/expected.h"

static const double golden = 0.61803398874989485;
/* A step over the distance slid, and over the tolerance. Half takes 1.8 times the convolutions, with
 * half the error. Double takes 0.6 times as many, with twice the error, and two of ten results miss the
 * tolerance (5 runs of bench/constants.py). */
static const double fraction = 0.4;
static const double usual_tol = 0.1;
/* The first step over the first step of the other model: the mean over the alignments needs many of
 * them at once. Half takes 9 % more convolutions, double 10 % fewer. The errors change by at most 30 %
 * (5 runs of bench/constants.py). */
static const double early = 0.3;
/* Times the difference of the two runs: where the error is in proportion to the steps, the finer run has half
 * the error of the other, and the difference is the error. With 0.65 the least of 76 estimates was 1.15 times
 * the error (law_wear_estimates). */
static const double caution = 1.1;
/* Aim of a leg that is taken again, over the tolerance. Half takes 1.6 times the contacts, with half the
 * error (19 runs of law_wear_estimates). */
static const double aim = 0.7;
/* At one node: times the relative L1 error of the contacts, as in wear.c. Without this part the estimate of
 * the largest pressure was 0.71 of the error in one of 342 outputs. */
static const double at_node = 1.5;
/* The least part of its steps that a leg has in the next try. */
static const double least_part = 1.0 / 16;
/* A leg is taken again unless this part of its error was there at its start. With half, one of 180 outputs
 * stayed above its tolerance. */
static const double inherited = 0.9;

enum {
    MOST_TRIES = 4, /* more of a leg that is not accurate enough */
    /* Alignments in which the pressures of both runs are compared. The least estimates of the pressure and of
     * the largest pressure, over the errors: 0.61 and 0.92 with three alignments, 0.78 and 1.41 with four,
     * 1.07 and 1.64 with six; 8 or 16 raise neither (358 outputs of law_wear_estimates). Each takes two
     * contacts at each point of the history. */
    PAIRS = 6
};
enum run {
    COARSE,
    FINE,
    RUNS
};
enum stage {
    WHOLE, /* the step of the coarse run */
    FIRST, /* two halves of the fine one */
    SECOND,
    PRESS,       /* at a point, the contact of the coarse run */
    PRESS_AGAIN, /* and that of the fine one */
    REST
};

struct sliding {
    struct rc_model base;
    struct rc_wear_problem law;
    size_t n;
    double *h;             /* heights of body 1 at the start */
    double *worn[RUNS][2]; /* depth that each body has lost, m */
    double *p, *other;     /* pressures of the last contact, and of the coarse run at the point */
    size_t pair;  /* at the point: contacts of both runs that follow, each pair in an alignment */
    double apart; /* relative: largest difference of the pressures of a pair, as a sum */
    double peaks_apart;        /* and that of a node, over the largest pressure */
    size_t stage, taken[RUNS]; /* contacts of each run so far */
    double s, end, t;          /* m: distance slid, end of the leg, present step */
    double part;               /* a step over the distance slid */
    size_t tries;              /* repetitions of the leg */
    double differ, above;      /* m: sum of the differences of both runs: now, largest lately */
    double spent;              /* m: sum of the errors of the worn depths at the start of the leg */
    double of_contacts;        /* m: errors of the contacts times their distances */
    double of_p;               /* relative: largest error of the two contacts at the point */
    bool good, again;          /* as in wear.c */
    struct rc_wear_figures f;
};
static const struct rc_figure_set sets[] = {{rc_figures_wear, offsetof(struct sliding, f)},
                                            {NULL, 0}};

/* ---- a contact ---- */

static enum run
run_of(size_t stage)
{
    return stage == WHOLE || stage == PRESS ? COARSE : FINE;
}

/* m: the part of the step that a contact wears. */
static double
length_of(const struct sliding *v)
{
    return v->stage == WHOLE ? v->t : v->stage < PRESS ? v->t / 2 : 0;
}

/* The node of body 2 that lies on node k of body 1, in an alignment of `by` nodes. */
static size_t
facing(const struct sliding *v, size_t k, size_t by)
{
    const size_t nx = v->base.shape.nx;

    return k - k % nx + (k % nx + nx - by) % nx;
}

/* The alignment of the present contact; a result has the alignment of the start, pair 0. */
static size_t
alignment(const struct sliding *v)
{
    const enum run run = run_of(v->stage);
    const double at = golden * (double)v->taken[run] + (run == COARSE ? 0.5 : 0.25);

    return v->stage >= PRESS ? v->pair * v->base.shape.nx / PAIRS
                             : (size_t)((at - floor(at)) * (double)v->base.shape.nx);
}

static double
height(const struct sliding *v, enum run run, size_t k, size_t by)
{
    const size_t other = facing(v, k, by);

    return v->h[k] - v->worn[run][0][k] + (v->law.h2 != NULL ? v->law.h2[other] : 0) -
           v->worn[run][1][other];
}

static enum rc_status
pose(struct sliding *v, struct rc_err *err)
{
    const size_t by = alignment(v);

    for (size_t k = 0; k < v->n; k++)
        v->p[k] = height(v, run_of(v->stage), k, by);
    if (rc_model_set_compliance(v->base.inner, (v->law.k[0] + v->law.k[1]) * length_of(v), NULL, 0,
                                err) != RC_OK)
        return RC_FAIL;
    return rc_model_set_heights(v->base.inner, v->p, err);
}

static enum rc_status
keep(struct rc_model *m, struct rc_err *err)
{
    return rc_model_keep(m->inner, err);
}

/* Starts a contact. The last one had another alignment, so its pressure is not used. The second one of a pair
 * would keep the pressure of the first one within the tolerance, and the runs would not differ. */
static enum rc_status
contact(struct sliding *v, size_t stage, struct rc_err *err)
{
    struct rc_model *inner = v->base.inner;
    const struct rc_point to = rc_wear_load(&v->base, v->s + (stage < PRESS ? v->t : 0));

    if (keep(&v->base, err) != RC_OK)
        return RC_FAIL;
    v->stage = stage;
    if (pose(v, err) != RC_OK || rc_model_go(inner, &to, err) == RC_FAIL)
        return RC_FAIL;
    return rc_model_start(inner, 0, NULL, err) == RC_OK ? RC_MORE : RC_FAIL;
}

/* ---- steps ---- */

/* m: the sum of the worn depths of both bodies. */
static double
lost(const struct sliding *v)
{
    const struct rc_ranks *ranks = v->base.rows.ranks;

    return rc_ranks_sum_of(ranks, v->worn[FINE][0], v->n) +
           rc_ranks_sum_of(ranks, v->worn[FINE][1], v->n);
}

static void
find_figures(struct sliding *v)
{
    const double cell = v->base.shape.dx * v->base.shape.dy;
    double *const *worn = v->worn[FINE];
    const struct rc_ranks *ranks = v->base.rows.ranks;
    const double all = (double)v->base.shape.nx * (double)v->base.shape.ny;
    struct rc_wear_figures *f = &v->f;
    double most = 0;

    v->differ = 0;
    for (int b = 0; b < 2; b++)
        v->differ += rc_ranks_distance(ranks, v->worn[COARSE][b], worn[b], v->n);
    v->above = fmax(v->above, v->differ);
    f->distance = v->s;
    f->wear_volume_1 = rc_ranks_sum_of(ranks, worn[0], v->n) * cell;
    f->wear_volume_2 = rc_ranks_sum_of(ranks, worn[1], v->n) * cell;
    f->wear_volume = f->wear_volume_1 + f->wear_volume_2;
    f->mean_wear_depth = lost(v) / all;
    for (size_t k = 0; k < v->n; k++)
        most = fmax(most, worn[0][k] + worn[1][k]);
    f->max_wear_depth = rc_ranks_most(ranks, most);
    f->wear_error = v->s > 0 ? caution * v->above / lost(v) + v->of_contacts / v->s : 0;
}

/* The figures of a point of the history: both runs are there and have solved its contact. */
static enum rc_status
arrive(struct sliding *v)
{
    struct rc_wear_figures *f = &v->f;

    find_figures(v);
    v->again = false;
    f->pressure_spread = rc_wear_spread(v->base.rows.ranks, v->p, v->n);
    f->pressure_error = v->apart * (v->differ > 0 ? v->above / v->differ : 1) + v->of_p;
    f->max_pressure_error =
        v->peaks_apart * (v->differ > 0 ? v->above / v->differ : 1) + at_node * v->of_p;
    f->converged = v->good && f->wear_error <= v->law.tol;
    return f->converged ? RC_OK : RC_SHORT;
}

static enum rc_status start(struct sliding *v, struct rc_err *err);

/* Returns to the start of the leg, and takes shorter steps: the error is in proportion to them. */
static enum rc_status
try_again(struct sliding *v, struct rc_err *err)
{
    const double part = v->part * fmax(aim * v->law.tol / v->f.wear_error, least_part);
    const size_t tries = v->tries + 1;
    const struct rc_wear_figures done = v->f;

    if (rc_model_recall(&v->base, err) != RC_OK)
        return RC_FAIL;
    v->f.rejected = done.rejected + done.steps - v->f.steps;
    v->f.contacts = done.contacts;
    v->f.convolutions = done.convolutions;
    v->part = part;
    v->tries = tries;
    return start(v, err);
}

/* Starts the next step, or the contacts at the point. A short distance takes as many steps as a longer
 * one. */
static enum rc_status
set_out(struct sliding *v, struct rc_err *err)
{
    const double first = early * rc_wear_first_step(&v->law, &v->base.shape) / usual_tol;
    const double left = v->end - v->s, most = v->part * fmax(v->s, fmin(first, v->end));

    v->of_p = v->apart = v->peaks_apart = 0;
    v->f.max_pressure_error = NAN; /* until the contacts at the point */
    if (!(left > 1e-12 * v->end)) {
        if (v->good && v->tries < MOST_TRIES && v->f.wear_error > v->law.tol &&
            v->spent < inherited * v->f.wear_error * lost(v))
            return try_again(v, err);
        v->pair = PAIRS - 1;
        return contact(v, PRESS, err);
    }
    v->t = left / ceil(left / most * (1 - 1e-9));
    return contact(v, WHOLE, err);
}

/* Wears both bodies in the alignment of the contact just solved. */
static void
lose(struct sliding *v, double of_p)
{
    const size_t by = alignment(v);
    const double t = length_of(v);
    double *const *worn = v->worn[run_of(v->stage)];

    for (size_t k = 0; k < v->n; k++) {
        worn[0][k] += v->law.k[0] * t * v->p[k];
        worn[1][facing(v, k, by)] += v->law.k[1] * t * v->p[k];
    }
    v->taken[run_of(v->stage)]++;
    if (v->stage != WHOLE)
        v->of_contacts += t * of_p;
}

/* Compares the pressures of both runs in one alignment. */
static void
compare(struct sliding *v)
{
    const struct rc_ranks *ranks = v->base.rows.ranks;
    double most = 0, apart = 0;

    for (size_t k = 0; k < v->n; k++) {
        most = fmax(most, v->p[k]);
        apart = fmax(apart, fabs(v->p[k] - v->other[k]));
    }
    v->apart = fmax(v->apart, rc_ranks_distance(ranks, v->p, v->other, v->n) /
                                  rc_ranks_sum_of(ranks, v->p, v->n));
    apart = rc_ranks_most(ranks, apart);
    v->peaks_apart = fmax(v->peaks_apart, apart / rc_ranks_most(ranks, most));
}

/* Starts the leg. */
static enum rc_status
start(struct sliding *v, struct rc_err *err)
{
    v->end = v->base.to.at[RC_DISTANCE];
    v->again = false;
    v->spent = v->f.wear_error * lost(v);
    if (v->base.from.given == 0)
        v->good = true;
    return set_out(v, err);
}

static enum rc_status
go(struct rc_model *m, struct rc_err *err)
{
    struct sliding *v = (struct sliding *)m;

    if (rc_wear_check_point(m, err) != RC_OK)
        return RC_FAIL;
    v->tries = 0;
    v->part = fmin(fraction,
                   v->part / v->law.tol * fmax(1, fmin(2, aim * v->law.tol / v->f.wear_error))) *
              v->law.tol;
    return start(v, err) == RC_MORE ? RC_OK : RC_FAIL;
}

static enum rc_status
step(struct rc_model *m, struct rc_err *err)
{
    struct sliding *v = (struct sliding *)m;
    const enum rc_status status =
        v->stage == REST && !v->again ? RC_OK : rc_model_step(m->inner, err);
    double of_p;

    if (status == RC_MORE || status == RC_FAIL)
        return status;
    if (rc_model_look(m->inner, NULL, err) != RC_OK ||
        rc_model_frame(m->inner, "pressure", v->p, err) != RC_OK)
        return RC_FAIL;
    if (v->stage == REST)
        return arrive(v);
    v->good = v->good && status == RC_OK;
    v->f.contacts++;
    v->f.convolutions += rc_model_number(m->inner, "convolutions");
    of_p = rc_model_number(m->inner, "pressure_error_estimate");
    v->of_p = fmax(v->of_p, of_p);
    if (v->stage < PRESS)
        lose(v, of_p);
    switch (v->stage) {
    case SECOND:
        v->above *= v->s / (v->s + v->t);
        v->s += v->t;
        v->f.steps++;
        find_figures(v);
        m->looked = true; /* also without a look, which may change the contact */
        return set_out(v, err);
    case PRESS:
        memcpy(v->other, v->p, v->n * sizeof *v->p);
        return contact(v, PRESS_AGAIN, err);
    case PRESS_AGAIN:
        compare(v);
        if (v->pair > 0) {
            v->pair--;
            return contact(v, PRESS, err);
        }
        v->stage = REST;
        v->s = v->end;
        return arrive(v);
    default:
        return contact(v, v->stage + 1, err);
    }
}

/* ---- results ---- */

static enum rc_status
fill(struct rc_model *m, size_t frame, double *to, struct rc_err *err)
{
    const struct sliding *v = (const struct sliding *)m;

    if (frame == RC_WEAR_GAP)
        return rc_model_frame(m->inner, "gap", to, err);
    for (size_t k = 0; k < v->n; k++)
        to[k] = frame == RC_WEAR_HEIGHT ? height(v, FINE, k, 0)
                                        : (frame != RC_WEAR_2 ? v->worn[FINE][0][k] : 0) +
                                              (frame != RC_WEAR_1 ? v->worn[FINE][1][k] : 0);
    return RC_OK;
}

static enum rc_status
look(struct rc_model *m, struct rc_point *at, struct rc_err *err)
{
    struct sliding *v = (struct sliding *)m;

    (void)err;
    find_figures(v);
    v->f.converged = v->f.converged && m->status != RC_MORE;
    at->at[RC_DISTANCE] = v->s;
    return RC_OK;
}

static void
state(struct rc_model *m, struct rc_state *s)
{
    struct sliding *v = (struct sliding *)m;
    struct rc_err err;

    rc_state_count(s, &v->stage, REST);
    rc_state_count(s, &v->pair, PAIRS - 1);
    RC_STATE_FLAGS(s, &v->good);
    RC_STATE_COUNTS(s, &v->tries, &v->taken[0], &v->taken[1], &v->f.steps, &v->f.rejected,
                    &v->f.contacts);
    RC_STATE_NUMBERS(s, &v->s, &v->end, &v->t, &v->of_contacts, &v->of_p, &v->apart,
                     &v->peaks_apart, &v->f.convolutions);
    RC_STATE_SIZES(s, &v->part, &v->above, &v->spent);
    for (int run = 0; run < RUNS; run++)
        for (int b = 0; b < 2; b++)
            rc_state_map(s, v->n, v->worn[run][b]);
    rc_state_map(s, v->n, v->other);
    if (!rc_state_reads(s))
        return;
    v->again = v->stage == REST && m->moved;
    if (pose(v, &err) != RC_OK)
        rc_state_refuse(s, "its heights are not finite");
}

static void
progress(const struct rc_model *m, struct rc_loops *l)
{
    const struct sliding *v = (const struct sliding *)m;

    rc_loops_add(l, "distance", "m", v->s, v->end);
    rc_loops_add(l, "step", NULL, (double)v->f.steps, NAN);
}

/* The steps of a length that grows in proportion to the distance, three contacts each. */
static enum rc_status
plan(const struct rc_model *m, const struct rc_point *most, struct rc_expected *expected,
     struct rc_err *err)
{
    const struct sliding *v = (const struct sliding *)m;
    const struct rc_point inner = rc_point_for(m->inner, most);
    const double part = fraction * v->law.tol,
                 start = early * rc_wear_first_step(&v->law, &m->shape) / usual_tol;
    const double grown = log(fmax(most->at[RC_DISTANCE] / start, 1)) / log1p(part);
    const double contacts = 2 * PAIRS + 3 * (1 / part + grown);

    if (rc_model_plan(m->inner, &inner, expected, err) != RC_OK)
        return RC_FAIL;
    expected->convolutions *= contacts;
    expected->seconds *= RC_RUBBING_PASSES * contacts;
    expected->memory += (2 * RUNS + 1) * v->n * sizeof(double);
    return RC_OK;
}

const struct rc_model_row rc_model_wear_two_bodies = {
    .name = "wear_two_bodies",
    .summary = "two rough bodies that wear as they slide over each other, over an inner model",
    .needs = 1u << RC_LOAD | 1u << RC_DISTANCE,
    .takes = 1u << RC_DISTANCE,
    RC_MODEL_VERBS,
    .frame = rc_wear_frames,
    .keep = keep,
    .plan = plan,
};

/* ---- the maker ---- */

static enum rc_status
make(struct sliding *v, const double *h, const struct rc_wear_problem *law, struct rc_err *err)
{
    v->n = rc_model_nodes(&v->base);
    v->law = *law;
    if (rc_wear_check(&v->base, &v->law, err) != RC_OK)
        return RC_FAIL;
    if (law->part != NULL || law->track > 0)
        return rc_err_set(err,
                          "bodies that slide over each other, with a track or with a coefficient "
                          "of each node, are not implemented");
    if (law->until_area > 0 || law->until_depth > 0 || law->until_spread > 0)
        return rc_err_set(err,
                          "an early end for bodies that slide over each other is not implemented");
    if (rc_model_set_compliance(v->base.inner, 1 / law->estar, NULL, 0, err) != RC_OK ||
        rc_model_set_compliance(v->base.inner, 0, NULL, 0, err) != RC_OK)
        return RC_FAIL;
    v->part = fraction * v->law.tol;
    v->h = rc_store_copy(&v->base.own, v->n, sizeof *h, h);
    for (int run = 0; run < RUNS; run++)
        for (int b = 0; b < 2; b++)
            v->worn[run][b] = rc_store_zeros(&v->base.own, v->n, sizeof *h);
    v->p = rc_store_zeros(&v->base.own, v->n, sizeof *h);
    v->other = rc_store_zeros(&v->base.own, v->n, sizeof *h);
    return rc_model_room(&v->base, err);
}

struct rc_model *
rc_wear_two_bodies_new(struct rc_model *inner, const double *h, const struct rc_wear_problem *law,
                       struct rc_err *err)
{
    RC_OWN(rc_model, m) =
        rc_model_make_outer(&rc_model_wear_two_bodies, sizeof(struct sliding), inner, err);

    return m != NULL && make((struct sliding *)m, h, law, err) == RC_OK ? rc_give(&m) : NULL;
}
