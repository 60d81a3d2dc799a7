/*
 * The lowest load of a retraction, in up to three stages.
 *
 * Coarse: from state to state until what attracts is less than the lowest load so far. Gaps only grow, so
 * that no later load is lower than minus the attraction. On a path without jumps the load is convex over
 * the approach as long as it falls, for contact goes and stiffness with it.
 *
 * Fine, where it is not: once more, from the state before the first way that may hide a lower load.
 * Between jumps the load falls no faster than the stiffness of the contact, so that a way is as long as
 * it takes at least to the lowest load that is known; and one that has jumped is halved until it hides
 * nothing that counts.
 *
 * Vertex, where the path is smooth about the lowest: by the parabola through it and its neighbours, until
 * the load there stays.
 */
#include "retraction.h"

#include <math.h>

#include "libcontact/common.h"

enum {
    STATES = 600, /* at most          */
    FINE = 3,     /* fine stages, at most */
    VERTICES = 5  /* at most          */
};
static const double load_step =
    0.3; /* of the attraction: by how much a step lowers the load             */
static const double growth = 1.5;     /* of a step from the last, as the load falls               */
static const double growth_after = 2; /* as it rises                                              */
static const double fine_step = 0.05; /* of the lowest load: a fine step hides as much            */
static const double settled = 1e-3;   /* of the lowest load: what does not count                  */
static const double unsteady = 1.5; /* change of the rate of attraction that is taken for a jump */
static const double convex = 1.1;   /* growth of the slope that a path without jumps cannot have */
static const double least_step =
    1e-6; /* of the range                                             */

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

/* ---- what a way may hide ---- */

/* Whether what attracts has changed on the way from m to r by far more than at this rate. */
static bool
has_jumped(double rate, const struct rc_retraction_state *m, const struct rc_retraction_state *r)
{
    return fabs(r->attraction - m->attraction) >
           unsteady * fabs(rate * (m->c - r->c)) + settled * m->attraction;
}

/* The lowest of the parabola through three states, and where; that of m where it has none between them. */
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

/* At most, of the load as far as the path does not jump: the flat circular punch of this area has the least
 * stiffness, and several spots what they were seen to have. */
static double
stiffness(const struct rc_retraction *r, const struct rc_retraction_state *s)
{
    return fmax(2 * s->radius, r->stiffness);
}

/* The lowest load that the way from the last state to this one may hide. */
static double
hidden(const struct rc_retraction *r, const struct rc_retraction_state *here, bool jumped)
{
    const struct rc_retraction_state *last = &r->last;
    double way = last->c - here->c, least = fmin(last->load, here->load), at, bend;

    if (jumped || (r->stage == RC_RETRACTION_COARSE && r->states > 2))
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

/* One that is free, of those that are kept. */
static int
free_one(const struct rc_retraction *r)
{
    for (int k = 0; k < RC_RETRACTION_KEPT; k++)
        if ((!r->has_base || r->base.kept != k) && (!r->has_before || r->before.kept != k) &&
            r->lowest.kept != k)
            return k;
    return RC_RETRACTION_HERE;
}

/* A state in the order of the retraction, and what the way to it may hide. */
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

/* A state where the parabola is lowest, between the one before the lowest and that after it. */
static void
note_vertex(struct rc_retraction *r, struct rc_retraction_state here)
{
    bool early = here.c > r->lowest.c;

    r->missed = fabs(here.load - r->estimate);
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

/* ---- ways ---- */

/* The way on from a state: to a load that is lower by part of what holds, as far as the slope tells. What
 * holds is at most the attraction, and no more than it takes to open a round crack about the contact: of a
 * sphere in the limit of short ranges the lowest load is a quarter of sqrt(8 pi E* w a^3) at no load. */
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
        return r->step; /* near a lowest */
    return fmin(way, growth * r->step);
}

/* As far as it takes, at least, to where the load is lower than any that is known. */
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

/* Nothing later is lower. */
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

/* Again from this state on, at most to the end of what may hide a lower load. */
static bool
begin_fine(struct rc_retraction *r, struct rc_retraction_state from, double step)
{
    r->stage = RC_RETRACTION_FINE;
    r->fine++;
    r->known = lowest_known(r);
    r->hidden = r->beside = INFINITY;
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
    r->spread = fmax(spread, 0);
    return false;
}

/* On a grid that hardly holds the law the load over the approach is a saw: it falls with the stiffness of
 * the contact, and leaps up where a node lets go, so that the lowest that was found is that of one tooth.
 * Two states beside it tell, where the parabola of the coarse stage is higher by what settles it, at
 * distances of no simple ratio. Where they are off the parabola six more look for the height of the teeth.
 * Far above them the bodies have jumped: that is no tooth. */
static const double places[RC_RETRACTION_CHECKS] = {1,     -0.618, -1.5, 0.382,
                                                    0.854, -0.236, -1.1, 0.56};
static const double leap = 0.05; /* of the lowest load */
enum {
    FIRST = 2
};

/* How far the loads beside the lowest, and the lowest, lie apart about a parabola that fits them best. */
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
    for (int i = 0; i < 3; i++) /* the matrix is positive */
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
        double lowest = fmin(r->estimate, r->lowest.load);
        return end(r, lowest, lowest < r->lowest.load ? r->at_estimate : r->lowest.c,
                   fmax(r->spread, saw ? 1.5 * teeth(r) : 2 * r->missed));
    }
    way = sqrt(settled * fabs(r->estimate) / r->around);
    way = places[r->checks++] * fmin(way, r->at_estimate - r->late);
    c = r->at_estimate + way;
    if (c > r->base.c) /* no state to come from */
        c = r->at_estimate - way;
    return go(r, c <= r->lowest.c ? &r->lowest : c <= r->before.c ? &r->before : &r->base, c);
}

/* About this load, that of a parabola with this bend; the spread is at least this. */
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

/* The end of a search that has found this state the lowest, by as much as is given. */
static bool
end_or_check(struct rc_retraction *r, double spread)
{
    const struct rc_retraction_state *m = &r->lowest;

    return r->around > 0 ? begin_check(r, m->load, m->c, r->around, spread)
                         : end(r, m->load, m->c, spread);
}

/* The next stage, the parabola's next, or the end. */
static bool
settle(struct rc_retraction *r)
{
    const struct rc_retraction_state *l = &r->before, *m = &r->lowest, *right = &r->after;
    double least = fmin(fmin(r->hidden, r->beside), m->load), last = r->estimate, estimate, at, off,
           bend;
    bool again = r->fine < FINE && !r->short_of, jumped;

    if (!r->has_after) /* short of states */
        return end(r, m->load, m->c, m->load - least);
    if (!r->has_before) { /* the first is the lowest, unless the first step was too long */
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
    if (jumped) /* where a leap below settled was not looked for */
        return end_or_check(r, fmax(m->load - least, settled * fabs(m->load)));
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
        return begin_check(r, estimate, at, bend, 0);
    }
    r->stage = RC_RETRACTION_VERTEX;
    r->vertices++;
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
    bool jumped;

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
    jumped = has_jumped(r->last.rate, &r->last, &here);
    if (!r->has_after && r->states > 2 && here.slope > convex * fmax(r->last.slope, 0))
        r->rough = true;
    hides = hidden(r, &here, jumped);
    if (r->stage == RC_RETRACTION_FINE && jumped && counts(r, hides) && hides < here.load &&
        way > least_step * r->range && r->states < STATES) {
        r->keep = RC_RETRACTION_HERE;
        r->step = way / 2;
        return go(r, &r->last, r->last.c - r->step);
    }
    if (jumped)
        here.rate = r->last.rate;
    else if (here.slope > 0)
        r->stiffness = here.slope;
    r->stiffest = fmax(r->stiffest, here.slope);
    note(r, here, hides);
    return is_over(r, &here) ? settle(r) : go_on(r);
}
