/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A model that is not part of the library, in one file and one row of a list. Under the contact is a layer of
 * springs, which settles at each node by s towards the compliance c times the pressure, ds/dt = (c p - s) /
 * tau. The inner model finds the pressure p for the heights h - s. A step uses the mean of the pressures at
 * both its ends; if they differ too much it is repeated with half the time.
 */
#include "relaxing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/model/row.h"

struct relaxing {
    struct rc_model base;
    struct toy_relaxing law;
    size_t n;
    double *h, *s, *settled,
        *p[2];       /* heights, settlement, settlement of the tried step, pressures at its ends */
    double *heights; /* pressure of the inner model */
    double t, dt;
    bool
        trying; /* true: the inner contact is at the end of a step, else at the current settlement */
    struct toy_figures f;
};

#define FIGURE(member) RC_FIGURE(struct toy_figures, member)
static const struct rc_figure figures[] = {
    {FIGURE(time), "s", "Time"},
    {FIGURE(mean_settlement), "m", "Mean settlement"},
    {RC_FIGURE_AS("step_error_estimate", struct toy_figures, step_error), NULL,
     "Error of the steps", .role = RC_FIGURE_ERROR, .by = "tol", .of = "settlement"},
    {FIGURE(steps), NULL, "Steps", .role = RC_FIGURE_COST},
    {FIGURE(rejected), NULL, "Rejected steps", .role = RC_FIGURE_COST},
    {0},
};
static const struct rc_figure_set sets[] = {{figures, offsetof(struct relaxing, f)}, {NULL, 0}};
static const struct rc_frame_kind frames[] = {{"settlement", "m", "Settlement"},
                                              {NULL, NULL, NULL}};

static enum rc_status
give_heights(struct relaxing *r, const double *s, struct rc_err *err)
{
    for (size_t k = 0; k < r->n; k++)
        r->heights[k] = r->h[k] - s[k];
    return rc_model_set_heights(r->base.inner, r->heights, err);
}

/* The last kept point; before the first one the bodies are unloaded, and the first load acts at once. */
static struct rc_point
begin(const struct rc_model *m)
{
    struct rc_point p = m->from.given != 0 ? m->from : m->to;

    p.at[RC_TIME] = m->from.given != 0 ? p.at[RC_TIME] : 0;
    return p;
}

/* Starts the inner contact for this settlement at this time. */
static enum rc_status
contact(struct relaxing *r, const double *s, double t, struct rc_err *err)
{
    const struct rc_model *m = &r->base;
    const struct rc_point from = begin(m);
    const double length = m->to.at[RC_TIME] - from.at[RC_TIME];
    const struct rc_point at =
        rc_point_between(&from, &m->to, length > 0 ? (t - from.at[RC_TIME]) / length : 1);
    const struct rc_point inner = rc_point_for(m->inner, &at);

    return give_heights(r, s, err) == RC_OK && rc_model_go(m->inner, &inner, err) == RC_MORE
               ? RC_OK
               : RC_FAIL;
}

static enum rc_status
go(struct rc_model *m, struct rc_err *err)
{
    struct relaxing *r = (struct relaxing *)m;

    r->t = begin(m).at[RC_TIME];
    r->dt = fmin(r->law.tau / 8, m->to.at[RC_TIME] - r->t);
    r->trying = false;
    return contact(r, r->s, r->t, err);
}

/* Settles by the mean of both pressures if `both`, else by the first one. Returns the sum of their
 * differences. */
static double
settle(struct relaxing *r, bool both, double *sum)
{
    const double kept = exp(-r->dt / r->law.tau), gain = r->law.compliance * (1 - kept);
    double differ = 0;

    *sum = 0;
    for (size_t k = 0; k < r->n; k++) {
        const double more = both ? (r->p[1][k] - r->p[0][k]) / 2 : 0;
        r->settled[k] = r->s[k] * kept + gain * (r->p[0][k] + more);
        differ += gain * fabs(more);
        *sum += fabs(r->settled[k]);
    }
    return differ;
}

/* Accepts the step, or halves it. */
static void
judge(struct relaxing *r)
{
    double sum, differ = settle(r, true, &sum), error = sum > 0 ? differ / sum : 0;
    const double left = r->base.to.at[RC_TIME] - r->t - r->dt;
    double *was = r->s;

    if (error > r->law.tol && r->dt > 1e-6 * r->law.tau) {
        r->f.rejected++;
        r->dt /= 2;
        return;
    }
    r->s = r->settled;
    r->settled = was;
    r->t = left > 1e-9 * r->dt ? r->t + r->dt : r->base.to.at[RC_TIME];
    r->f.steps++;
    r->f.step_error = fmax(r->f.step_error, error);
    r->dt = fmin(error < r->law.tol / 4 ? 2 * r->dt : r->dt, r->base.to.at[RC_TIME] - r->t);
    r->trying = false;
}

static enum rc_status
step(struct rc_model *m, struct rc_err *err)
{
    struct relaxing *r = (struct relaxing *)m;
    enum rc_status status = rc_model_step(m->inner, err);
    double sum;

    if (status == RC_MORE || status == RC_FAIL)
        return status;
    if (rc_model_look(m->inner, NULL, err) != RC_OK ||
        rc_model_frame(m->inner, "pressure", r->p[r->trying], err) != RC_OK)
        return RC_FAIL;
    if (r->trying)
        judge(r);
    else if (r->t >= m->to.at[RC_TIME])
        return status;
    else {
        if (rc_model_keep(m->inner, err) != RC_OK)
            return RC_FAIL;
        r->trying = true;
    }
    if (r->trying)
        (void)settle(r, false, &sum);
    return contact(r, r->trying ? r->settled : r->s, r->trying ? r->t + r->dt : r->t, err) == RC_OK
               ? RC_MORE
               : RC_FAIL;
}

static enum rc_status
look(struct rc_model *m, struct rc_point *at, struct rc_err *err)
{
    struct relaxing *r = (struct relaxing *)m;

    (void)at, (void)err;
    r->f.time = r->t;
    r->f.mean_settlement = rc_sum(r->s, r->n) / (double)r->n;
    return RC_OK;
}

static enum rc_status
fill(struct rc_model *m, size_t frame, double *to, struct rc_err *err)
{
    const struct relaxing *r = (struct relaxing *)m;

    (void)frame, (void)err;
    memcpy(to, r->s, r->n * sizeof *to);
    return RC_OK;
}

static void
state(struct rc_model *m, struct rc_state *s)
{
    struct relaxing *r = (struct relaxing *)m;
    size_t trying = r->trying;
    struct rc_err err;
    double sum;

    rc_state_finite(s, r->n, r->s);
    RC_STATE_NUMBERS(s, &r->t, &r->dt, &r->f.step_error);
    rc_state_count(s, &r->f.steps, (size_t)1 << 40);
    rc_state_count(s, &r->f.rejected, (size_t)1 << 40);
    rc_state_count(s, &trying, 1);
    if (trying)
        rc_state_finite(s, r->n, r->p[0]);
    if (!rc_state_reads(s))
        return;
    r->trying = trying;
    if (trying)
        (void)settle(r, false, &sum);
    if (give_heights(r, trying ? r->settled : r->s, &err) != RC_OK)
        rc_state_refuse(s, "its settlement is impossible");
}

static enum rc_status
keep(struct rc_model *m, struct rc_err *err)
{
    return rc_model_keep(m->inner, err);
}

static void
progress(const struct rc_model *m, struct rc_loops *s)
{
    rc_loops_add(s, "time", "s", ((const struct relaxing *)m)->t, m->to.at[RC_TIME]);
}

static void
release(struct rc_model *m)
{
    free(((struct relaxing *)m)->h); /* the other maps follow it */
}

const struct rc_model_row rc_model_relaxing = {
    .name = "relaxing",
    .summary = "a bed of springs that relaxes",
    .needs = 1u << RC_LOAD | 1u << RC_TIME,
    .takes = 1u << RC_TIME,
    .figures = sets,
    .frame = frames,
    .go = go,
    .step = step,
    .look = look,
    .fill = fill,
    .state = state,
    .free = release,
    .keep = keep,
    .progress = progress,
};

struct rc_model *
toy_relaxing_new(struct rc_model *inner, const double *h, const struct toy_relaxing *law,
                 struct rc_err *err)
{
    struct relaxing *r;
    struct rc_model *m = rc_model_make_outer(&rc_model_relaxing, sizeof *r, inner, err);

    if (m == NULL)
        return NULL;
    r = (struct relaxing *)m;
    r->law = *law;
    r->n = m->shape.nx * m->shape.ny;
    if ((r->h = calloc(6 * r->n, sizeof *r->h)) == NULL) {
        rc_err_set(err, "out of memory for the springs");
        rc_model_free(m);
        return NULL;
    }
    memcpy(r->h, h, r->n * sizeof *h);
    r->s = r->h + r->n;
    r->settled = r->s + r->n;
    r->p[0] = r->settled + r->n;
    r->p[1] = r->p[0] + r->n;
    r->heights = r->p[1] + r->n;
    return m;
}
