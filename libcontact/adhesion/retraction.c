/*
 * The lowest load of a retraction, in up to three stages.
 *
 * Coarse: from state to state until the attraction is less than minus the lowest load so far. Gaps only grow,
 * so that no later load is below minus the attraction. On a path without jumps the falling load is a convex
 * function of the approach, because contact and stiffness decrease. The first step follows from the stiffness
 * of a flat punch. If the load falls far more, the step may pass a jump unseen; a shorter one replaces it.
 *
 * Fine, if the load is not convex: repeats the path from the state before the first step that may hide a
 * lower load. Between jumps the load falls no faster than the stiffness of the contact allows. A step is
 * therefore as long as the load needs at least to fall below the lowest known one. A step with a jump is
 * halved until it cannot hide a relevant load.
 *
 * Vertex, if the path is smooth near the lowest load: the minimum of the parabola through it and its
 * neighbours. This is repeated until the load does not change. If the load jumps behind the lowest state, the
 * step with the jump is halved instead.
 */
#include "retraction.h"

#include <math.h>
#include <string.h>

#include "libcontact/common.h"

enum {
    STATES = 600, /* at most          */
    FINE = 3,     /* most fine stages */
    VERTICES = 5, /* at most          */
    HALVINGS = 8  /* most of the step with the last jump */
};
static const double load_step = 0.3;  /* part of the attraction by which a step lowers the load */
static const double growth = 1.5;     /* growth of a step over the last one while the load falls */
static const double growth_after = 2; /* the same while the load rises */
static const double fine_step = 0.05; /* fraction of the lowest load: a fine step may hide so
                                          much */
static const double settled = 1e-3;   /* fraction of the lowest load: smaller differences do not
                                          count */
static const double unsteady = 1.5;   /* change of the rate of attraction that counts as a jump */
static const double convex = 1.1;     /* a larger growth of the slope means a jump */
static const double stiffer = 2; /* a larger slope of the first step means that it was too long */
static const double noise =
    2e-4; /* error of the difference of two loads, relative to the lowest load */
static const double least_step = 1e-6; /* relative to the range */
/* If one neighbour of the lowest state is so many times as far as the other, the next state is in the longer
 * part, because parabolas with a far state approach their minimum from one side only. */
static const double lopsided = 4, golden = 0.382;

void
rc_retraction_begin(struct rc_retraction *r, double work, double range, double parted)
{
    *r = (struct rc_retraction){.work = work,
                                .range = range,
                                .parted = parted,
                                .known = INFINITY,
                                .hidden = INFINITY,
                                .beside = INFINITY,
                                .to = INFINITY,
                                .estimate = INFINITY};
}

/* ---- loads hidden between two states ---- */

/* True if the attraction has changed from m to r by far more than at this rate. */
static bool
has_jumped(double rate, const struct rc_retraction_state *m, const struct rc_retraction_state *r)
{
    return fabs(r->attraction - m->attraction) >
           unsteady * fabs(rate * (m->c - r->c)) + settled * m->attraction;
}

/* The minimum of the parabola through three states, and its place. If the minimum is not between them: the
 * load of m. */
static double
vertex(const struct rc_retraction_state *l, const struct rc_retraction_state *m,
       const struct rc_retraction_state *r, double *at, double *bend_of)
{
    double left = (l->load - m->load) / (l->c - m->c), right = (r->load - m->load) / (r->c - m->c);
    double bend = (left - right) / (l->c - r->c), slope, c;

    *at = m->c;
    *bend_of = bend;
    if (!(bend > 0))
        return m->load;
    slope = left - bend * (l->c - m->c);
    c = m->c - slope / (2 * bend);
    if (!(c <= l->c && c >= r->c))
        return m->load;
    *at = c;
    return m->load + slope * (c - m->c) + bend * (c - m->c) * (c - m->c);
}

/* An upper bound of the slope of the load on a path without jumps. The flat circular punch with this area has
 * the lowest stiffness; several spots have at most the largest stiffness seen so far. */
static double
stiffness(const struct rc_retraction *r, const struct rc_retraction_state *s)
{
    return fmax(2 * s->radius, r->stiffness);
}

/* The lowest load that may occur between the last state and this one. */
static double
hidden(const struct rc_retraction *r, const struct rc_retraction_state *here, bool jumped)
{
    const struct rc_retraction_state *last = &r->last;
    double way = last->c - here->c, least = fmin(last->load, here->load), at, bend;

    if (jumped || (r->stage == RC_RETRACTION_COARSE && r->has_prior))
        return fmin(least, fmax(last->load - stiffness(r, last) * way, -last->attraction));
    if (r->has_prior && here->load > last->load && last->slope > 0)
        return fmin(least, vertex(&r->prior, last, here, &at, &bend));
    return least;
}

static double
lowest_known(const struct rc_retraction *r)
{
    return fmin(r->known, r->lowest.load);
}

static bool
counts(const struct rc_retraction *r, double load)
{
    double lowest = lowest_known(r);

    return load < lowest - settled * fabs(lowest);
}

/* ---- the states ---- */

/* A free place among the kept states. */
static int
free_one(const struct rc_retraction *r)
{
    for (int k = 0; k < RC_RETRACTION_KEPT; k++)
        if ((!r->has_base || r->base.kept != k) && (!r->has_before || r->before.kept != k) &&
            r->lowest.kept != k)
            return k;
    return RC_RETRACTION_HERE;
}

/* Notes a state in the order of the retraction, and the load that may be hidden before it. */
static void
note(struct rc_retraction *r, struct rc_retraction_state here, double hides)
{
    r->is_lowest = here.load < r->lowest.load;
    if (r->is_lowest) {
        r->hidden = fmin(r->hidden, r->beside);
        r->beside = INFINITY;
        if (!r->has_base || !(r->hidden < here.load - settled * fabs(here.load))) {
            r->base = r->last;
            r->has_base = true;
            r->hidden = INFINITY;
        }
        r->before = r->last;
        r->lowest = here;
        r->lowest.kept = RC_RETRACTION_HERE;
        r->has_before = true;
        r->has_after = false;
        r->hidden = fmin(r->hidden, hides);
    } else if (!r->has_after) {
        r->has_after = true;
        r->after = here;
        r->beside = hides;
    } else {
        r->hidden = fmin(r->hidden, hides);
    }
    if (!r->has_after || counts(r, hides))
        r->to = fmin(r->to, here.c);
    r->keep = here.kept = free_one(r);
    if (r->is_lowest)
        r->lowest.kept = r->keep;
    r->prior = r->last;
    r->has_prior = true;
    r->last = here;
}

/* Notes a state at the minimum of the parabola, between the neighbours of the lowest state. */
static void
note_vertex(struct rc_retraction *r, struct rc_retraction_state here)
{
    bool early = here.c > r->lowest.c;

    r->missed = isnan(r->estimate) ? 0 : fabs(here.load - r->estimate);
    r->keep = RC_RETRACTION_HERE;
    r->is_lowest = here.load < r->lowest.load;
    if (r->is_lowest) {
        if (early)
            r->after = r->lowest;
        else
            r->before = r->lowest;
        r->lowest.kept = RC_RETRACTION_HERE;
        r->keep = here.kept = free_one(r);
        r->lowest = here;
    } else if (early) {
        r->has_before = false;
        r->keep = here.kept = free_one(r);
        r->has_before = true;
        r->before = here;
    } else {
        r->after = here;
    }
}

/* ---- steps ---- */

/* The coarse step from a state. By the present slope, the load falls by a part of the holding force. This
 * force is at most the attraction, and at most the force that opens a circular crack around the contact. In
 * the limit of short ranges, the lowest load of a sphere is a quarter of sqrt(8 pi E* w a^3) at load 0. */
static double
coarse_way(const struct rc_retraction *r, const struct rc_retraction_state *here)
{
    double holds = here->attraction, a = here->radius, way;

    if (a > 0)
        holds = fmin(holds, sqrt(8 * RC_PI * r->work * a * a * a) / 4);
    way = load_step * holds / (here->slope > 0 ? here->slope : r->stiffness);
    if (r->states <= 1)
        return fmax(way, 0.02 * r->range);
    if (here->slope <= 0)
        return growth_after * r->step;
    if (here->slope < r->stiffest / 4)
        return r->step; /* near a minimum */
    return fmin(way, growth * r->step);
}

/* The fine step: as far as the load needs at least to fall below the lowest known one. */
static double
fine_way(const struct rc_retraction *r, const struct rc_retraction_state *here)
{
    double lowest = lowest_known(r),
           falls = fmax(here->load - lowest, fine_step * fabs(lowest)) / stiffness(r, here);

    return fmin(falls, growth_after * r->step);
}

static bool
go(struct rc_retraction *r, const struct rc_retraction_state *from, double c)
{
    r->from = from->kept;
    r->from_c = from->c;
    r->c = c;
    return true;
}

static bool
go_on(struct rc_retraction *r)
{
    r->step = r->stage == RC_RETRACTION_FINE ? fine_way(r, &r->last) : coarse_way(r, &r->last);
    r->from = RC_RETRACTION_HERE;
    r->c = r->last.c - r->step;
    return true;
}

/* True if no later load is lower. */
static bool
is_over(struct rc_retraction *r, const struct rc_retraction_state *here)
{
    if (r->states >= STATES) {
        r->short_of = true;
        return true;
    }
    if (r->stage == RC_RETRACTION_FINE && r->has_after && here->c <= r->to)
        return true;
    return here->attraction <= -lowest_known(r) || here->mean_gap > r->parted;
}

/* ---- stages ---- */

/* Repeats the path from this state, at most to the end of the last step that may hide a lower load. */
static bool
begin_fine(struct rc_retraction *r, struct rc_retraction_state from, double step)
{
    r->stage = RC_RETRACTION_FINE;
    r->fine++;
    if (r->lowest.load < r->known) {
        r->known = r->lowest.load;
        r->known_at = r->lowest.c;
    }
    r->hidden = r->beside = r->estimate = INFINITY;
    r->missed = 0;
    r->steps_n = r->checks = 0;
    r->last = r->base = from;
    r->has_base = true;
    r->has_prior = r->has_after = r->has_before = false;
    if (from.c != r->lowest.c)
        r->lowest = (struct rc_retraction_state){.load = INFINITY, .kept = RC_RETRACTION_HERE};
    r->step = step;
    return go(r, &from, from.c - step);
}

static bool
end(struct rc_retraction *r, double load, double at, double spread)
{
    r->load = load;
    r->at = at;
    /* The fine stage does not search for smaller jumps than `settled`. Later loads are not below minus the
     * attraction. */
    spread = fmax(spread, r->fine > 0 ? settled * fabs(load) : 0);
    r->spread = fmax(spread, r->short_of ? load + r->last.attraction : 0);
    return false;
}

/* On a grid that barely resolves the law, the load over the approach is a saw. It falls with the stiffness of
 * the contact, and jumps up where a node separates. The lowest load found then belongs to one tooth. Two
 * states beside it show this: they lie where the parabola of the coarse stage is higher by `settled`. Their
 * distances have no simple ratio. If they are off the parabola, six more states measure the height of the
 * teeth. A state far above the parabola is beyond a jump, not on a tooth. Coarse steps may hide more such
 * jumps: the fine stage follows. */
static const double places[RC_RETRACTION_CHECKS] = {1,     -0.618, -1.5, 0.382,
                                                    0.854, -0.236, -1.1, 0.56};
static const double leap = 0.05; /* relative to the lowest load */
enum {
    FIRST = 2
};

/* The spread of the lowest load and the loads beside it about their best parabola. */
static double
teeth(const struct rc_retraction *r)
{
    double a[3][4] = {{0}}, least = INFINITY, most = -INFINITY;

    if (r->beside_n <= 3) /* beyond a jump */
        return 0;
    for (size_t k = 0; k < r->beside_n; k++) {
        double x = r->beside_way[k] / fabs(r->beside_way[1]), power[] = {1, x, x * x};
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++)
                a[i][j] += power[i] * power[j];
            a[i][3] += power[i] * r->beside_load[k];
        }
    }
    for (int i = 0; i < 3; i++) /* the matrix is positive definite */
        for (int k = 0; k < 3; k++) {
            double factor = a[k][i] / a[i][i];
            for (int j = i; k != i && j < 4; j++)
                a[k][j] -= factor * a[i][j];
        }
    for (size_t k = 0; k < r->beside_n; k++) {
        double x = r->beside_way[k] / fabs(r->beside_way[1]);
        double off = r->beside_load[k] -
                     (a[0][3] / a[0][0] + x * (a[1][3] / a[1][1] + x * a[2][3] / a[2][2]));
        least = fmin(least, off);
        most = fmax(most, off);
    }
    return most - least;
}

static bool
check(struct rc_retraction *r)
{
    double way, c;
    bool saw = r->missed > settled / 2 * fabs(r->estimate);

    if (r->checks == RC_RETRACTION_CHECKS || (r->checks >= FIRST && !saw)) {
        double lowest = fmin(r->estimate, r->lowest.load),
               spread = fmax(r->spread, saw ? 1.5 * teeth(r) : 2 * r->missed);
        if (r->leaps && r->fine == 0 && spread < leap * fabs(lowest))
            return begin_fine(r, r->base, fine_way(r, &r->base));
        return end(r, lowest, lowest < r->lowest.load ? r->at_estimate : r->lowest.c, spread);
    }
    way = sqrt(settled * fabs(r->estimate) / r->around);
    way = places[r->checks++] * fmin(way, r->at_estimate - r->late);
    c = r->at_estimate + way;
    if (c > r->base.c) /* there is no state to start from */
        c = r->at_estimate - way;
    return go(r, c <= r->lowest.c ? &r->lowest : c <= r->before.c ? &r->before : &r->base, c);
}

/* Checks this lowest load of a parabola with this bend; the spread is at least `spread`. */
static bool
begin_check(struct rc_retraction *r, double load, double at, double bend, double spread)
{
    r->stage = RC_RETRACTION_CHECK;
    r->estimate = r->beside_load[0] = load;
    r->at_estimate = at;
    r->beside_n = 1;
    r->bend = bend;
    r->spread = spread;
    return check(r);
}

static void
note_check(struct rc_retraction *r, struct rc_retraction_state here)
{
    double way = here.c - r->at_estimate;

    r->keep = RC_RETRACTION_HERE;
    r->is_lowest = here.load < r->lowest.load;
    r->leaps |= here.load > r->estimate + leap * fabs(r->estimate);
    if (here.load > r->estimate + leap * fabs(r->estimate))
        return;
    r->missed = fmax(r->missed, fabs(here.load - r->estimate - r->bend * way * way));
    r->beside_way[r->beside_n] = way;
    r->beside_load[r->beside_n++] = here.load;
    if (!r->is_lowest)
        return;
    r->lowest.kept = RC_RETRACTION_HERE;
    r->keep = here.kept = free_one(r);
    r->lowest = here;
}

/* The lowest load that steps before the lowest state may hide. Between jumps the slope of the load over the
 * approach only falls. If a later step is steeper, the load has jumped up within the earlier one. Before that
 * jump it has fallen at most with the later slope. */
static double
hidden_before(const struct rc_retraction *r)
{
    double steepest = 0, least = INFINITY;

    for (size_t k = r->steps_n; k-- > 0;) {
        const struct rc_retraction_step *s = &r->steps[k];
        if (s->end < r->lowest.c)
            continue;
        if (steepest > convex * fmax(s->slope, 0))
            least = fmin(least, s->load - steepest * s->way);
        steepest = fmax(steepest, s->slope - noise * fabs(r->lowest.load) / s->way);
    }
    return fmax(least, -r->base.attraction);
}

/* Ends the search with the lowest state and this spread, or checks it first. */
static bool
end_or_check(struct rc_retraction *r, double spread)
{
    const struct rc_retraction_state *m = &r->lowest;

    spread = fmax(spread, m->load - hidden_before(r));
    return r->around > 0 ? begin_check(r, m->load, m->c, r->around, spread)
                         : end(r, m->load, m->c, spread);
}

/* Chooses the next stage, the next vertex, or the end. */
static bool
settle(struct rc_retraction *r)
{
    const struct rc_retraction_state *l = &r->before, *m = &r->lowest, *right = &r->after;
    double least = fmin(fmin(r->hidden, r->beside), m->load), last = r->estimate, estimate, at, off,
           bend;
    bool again = r->fine < FINE && !r->short_of, jumped;

    if (!r->has_after) /* too few states */
        return again && r->has_base && counts(r, least)
                   ? begin_fine(r, r->base, fine_way(r, &r->base))
                   : end(r, m->load, m->c, m->load - least);
    if (!r->has_before) { /* the first state has the lowest load, unless the first step was too
                             long */
        r->to = right->c;
        return again ? begin_fine(r, *m, (m->c - right->c) / 4)
                     : end(r, m->load, m->c, right->load - m->load);
    }
    estimate = vertex(l, m, right, &at, &bend);
    jumped = has_jumped((l->attraction - m->attraction) / (l->c - m->c), m, right);
    if (r->stage == RC_RETRACTION_COARSE && !r->rough && !jumped) {
        r->around = bend;
        r->late = right->c;
    }
    if (r->rough && r->fine == 0 && again)
        return begin_fine(r, r->base, fine_way(r, &r->base));
    if (jumped && r->fine == 0 && again && counts(r, r->beside)) {
        r->to = right->c;
        return begin_fine(r, *l, fine_way(r, l));
    }
    if (jumped) {
        double hides = m->load - stiffness(r, m) * (m->c - right->c);
        if (r->around > 0) /* the check measures the teeth */
            hides = m->load;
        if (!counts(r, hides) || r->halvings == HALVINGS)
            return end_or_check(r, fmax(m->load - fmin(least, hides), settled * fabs(m->load)));
        r->stage = RC_RETRACTION_VERTEX;
        r->halvings++;
        r->estimate = NAN;
        return go(r, m, (m->c + right->c) / 2);
    }
    r->estimate = estimate;
    r->at_estimate = at;
    off = fmax(fabs(estimate - last), r->vertices > 0 ? r->missed : INFINITY);
    if (at == m->c)
        return end_or_check(r, fmin(off, m->load - least));
    if (r->vertices >= VERTICES || off <= settled * fabs(estimate)) {
        r->missed = off;
        if (!(r->around > 0)) {
            r->around = bend;
            r->late = right->c;
        }
        return begin_check(r, estimate, at, bend, m->load - hidden_before(r));
    }
    r->stage = RC_RETRACTION_VERTEX;
    r->vertices++;
    if (l->c - m->c > lopsided * (m->c - right->c))
        at = m->c + golden * (l->c - m->c);
    else if (m->c - right->c > lopsided * (l->c - m->c))
        at = m->c - golden * (m->c - right->c);
    r->estimate += bend * (at - r->at_estimate) * (at - r->at_estimate);
    r->at_estimate = at;
    return go(r, at > m->c ? l : m, at);
}

static bool
begin(struct rc_retraction *r, struct rc_retraction_state here)
{
    r->stiffness = here.slope = 2 * fmax(here.radius, 1);
    here.rate = NAN;
    here.kept = r->keep = 0;
    r->is_lowest = true;
    r->last = r->lowest = here;
    return go_on(r);
}

bool
rc_retraction_next(struct rc_retraction *r, struct rc_retraction_state here)
{
    double hides, way;
    bool jumped, lost;

    if (r->states++ == 0)
        return begin(r, here);
    r->is_lowest = false;
    if (r->stage == RC_RETRACTION_VERTEX) {
        note_vertex(r, here);
        return settle(r);
    }
    if (r->stage == RC_RETRACTION_CHECK) {
        note_check(r, here);
        return check(r);
    }
    way = r->last.c - here.c;
    here.slope = (r->last.load - here.load) / way;
    here.rate = (r->last.attraction - here.attraction) / way;
    if (r->stage == RC_RETRACTION_COARSE && !r->has_prior && here.slope > stiffer * r->last.slope) {
        r->keep = RC_RETRACTION_HERE;
        r->step *= r->last.slope / here.slope;
        r->last.slope = here.slope;
        return go(r, &r->last, r->last.c - r->step);
    }
    jumped = has_jumped(r->last.rate, &r->last, &here);
    if (!r->has_after && r->has_prior && here.slope > convex * fmax(r->last.slope, 0))
        r->rough = true;
    hides = hidden(r, &here, jumped);
    lost = r->last.c > r->known_at && here.c <= r->known_at &&
           fmin(r->lowest.load, here.load) > r->known + settled * fabs(r->known);
    if (lost)
        hides = fmin(hides, r->known);
    if (r->stage == RC_RETRACTION_FINE && (lost || (jumped && counts(r, hides))) &&
        hides < here.load && way > least_step * r->range && r->states < STATES) {
        r->keep = RC_RETRACTION_HERE;
        r->step = way / 2;
        return go(r, &r->last, r->last.c - r->step);
    }
    if (jumped)
        here.rate = r->last.rate;
    else if (here.slope > 0)
        r->stiffness = here.slope;
    r->stiffest = fmax(r->stiffest, here.slope);
    if (r->stage == RC_RETRACTION_FINE && !jumped) {
        if (r->steps_n == RC_RETRACTION_STEPS)
            memmove(r->steps, r->steps + 1, --r->steps_n * sizeof *r->steps);
        r->steps[r->steps_n++] = (struct rc_retraction_step){r->last.load, here.c, way, here.slope};
    }
    note(r, here, hides);
    return is_over(r, &here) ? settle(r) : go_on(r);
}
