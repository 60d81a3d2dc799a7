/* SPDX-License-Identifier: GPL-3.0-or-later */
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
    /* At most, so that a retraction ends. Half and double change no bit (27 runs of
     * bench/constants.py). */
    STATES = 600,
    /* Most fine stages. Half and double change no bit (27 runs of bench/constants.py). */
    FINE = 3,
    /* Most vertices of parabolas. Half changes one of 27 runs, double none (bench/constants.py). */
    VERTICES = 5,
    /* Most halvings of the step with the last jump: 1/256 of it is left. Half and double change no bit
     * (27 runs of bench/constants.py). */
    HALVINGS = 8
};
/* Part of the attraction by which a step lowers the load. Half takes 1.6 times the convolutions, double
 * 0.7 times; the pull-off load changes by less than 4e-4 (9 pull-offs of bench/constants.py). Maps with
 * more spots need short steps: a longer step may pass over a whole valley of the load. */
static const double load_step = 0.3;
/* Growth of a step over the last one while the load falls. Double changes no bit; below 1 the steps
 * would end (9 pull-offs of bench/constants.py). */
static const double growth = 1.5;
/* The same while the load rises. Half takes 6 % more convolutions, double 2 % (9 pull-offs of
 * bench/constants.py). */
static const double growth_after = 2;
/* A fine step does not resolve events that are closer together than this fraction of the lowest load.
 * Half changes the convolutions by less than 1 %, double takes 3 % more (9 pull-offs of
 * bench/constants.py). */
static const double fine_step = 0.05;
/* Fraction of the lowest load: smaller differences do not count. Half takes 2 % more convolutions.
 * Double takes 4 % fewer, and the pull-off load is up to 6e-4 off (9 pull-offs of
 * bench/constants.py). */
static const double settled = 1e-3;
/* Change of the rate of attraction that counts as a jump. Half takes 1.8 times the convolutions; double
 * changes no bit (9 pull-offs of bench/constants.py). */
static const double unsteady = 1.5;
/* Without contact: in half a step the attraction changes by half if it does not jump, and by all if it jumps
 * there. With contact lines of nodes jump one by one. */
static const double in_part = 0.75;
/* A larger growth of the slope means a jump. Half takes 15 % more convolutions; double takes 1 % more,
 * and one pull-off load is 1.5e-3 off (9 pull-offs of bench/constants.py). */
static const double convex = 1.1;
/* A larger slope of the first step means that it was too long. Half takes 15 % more convolutions,
 * double 3 % fewer (9 pull-offs of bench/constants.py). */
static const double stiffer = 2;
/* Error of the difference of two loads, relative to the lowest load. Half and double change no bit (9
 * pull-offs of bench/constants.py). */
static const double noise = 2e-4;
/* Relative to the range: shorter steps change the gap by rounding of single precision. Half and double
 * change no bit (27 runs of bench/constants.py). */
static const double least_step = 1e-6;
/* If one neighbour of the lowest state is so many times as far as the other, the next state is in the
 * longer part, because parabolas with a far state approach their minimum from one side only. The golden
 * ratio gives 0.382 (Kiefer 1953). */
static const double lopsided = 4, golden = 0.382;

void
rc_retraction_begin(struct rc_retraction *r, const struct rc_retraction_law *law)
{
    *r = (struct rc_retraction){
        .law = *law,
        .low = {.known = INFINITY, .hidden = INFINITY, .beside = INFINITY, .to = INFINITY},
        .parabola.load = INFINITY};
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

/* An upper bound of the slope of the load on a path without jumps. The flat punch with this area has the
 * lowest stiffness; several spots have at most the largest stiffness seen so far. */
static double
stiffness(const struct rc_retraction_pace *pace, const struct rc_retraction_state *s)
{
    return fmax(s->punch, pace->stiffness);
}

/* The lowest load that may occur between the last state and this one. */
static double
hidden(enum rc_retraction_stage stage, const struct rc_retraction_path *path,
       const struct rc_retraction_pace *pace, const struct rc_retraction_state *here, bool jumped)
{
    const struct rc_retraction_state *last = &path->last;
    double way = last->c - here->c, least = fmin(last->load, here->load), at, bend;

    if (jumped || (stage == RC_RETRACTION_COARSE && path->has_prior))
        return fmin(least, fmax(last->load - stiffness(pace, last) * way, -last->attraction));
    if (path->has_prior && here->load > last->load && last->slope > 0)
        return fmin(least, vertex(&path->prior, last, here, &at, &bend));
    return least;
}

static double
lowest_known(const struct rc_retraction_low *low, const struct rc_retraction_path *path)
{
    return fmin(low->known, path->lowest.load);
}

static bool
counts(double lowest, double load)
{
    return load < lowest - settled * fabs(lowest);
}

/* ---- the states ---- */

/* A free place among the kept states. */
static int
free_one(const struct rc_retraction_path *path)
{
    for (int k = 0; k < RC_RETRACTION_KEPT; k++)
        if ((!path->has_base || path->base.kept != k) &&
            (!path->has_before || path->before.kept != k) && path->lowest.kept != k)
            return k;
    return RC_RETRACTION_HERE;
}

/* Notes a state in the order of the retraction, and the load that may be hidden before it. */
static void
note(struct rc_retraction_path *path, struct rc_retraction_low *low,
     struct rc_retraction_next *next, struct rc_retraction_state here, double hides)
{
    next->is_lowest = here.load < path->lowest.load;
    if (next->is_lowest) {
        low->hidden = fmin(low->hidden, low->beside);
        low->beside = INFINITY;
        if (!path->has_base || !(low->hidden < here.load - settled * fabs(here.load))) {
            path->base = path->last;
            path->has_base = true;
            low->hidden = INFINITY;
        }
        path->before = path->last;
        path->lowest = here;
        path->lowest.kept = RC_RETRACTION_HERE;
        path->has_before = true;
        path->has_after = false;
        low->hidden = fmin(low->hidden, hides);
    } else if (!path->has_after) {
        path->has_after = true;
        path->after = here;
        low->beside = hides;
    } else {
        low->hidden = fmin(low->hidden, hides);
    }
    if (!path->has_after || counts(lowest_known(low, path), hides))
        low->to = fmin(low->to, here.c);
    next->keep = here.kept = free_one(path);
    if (next->is_lowest)
        path->lowest.kept = next->keep;
    path->prior = path->last;
    path->has_prior = true;
    path->last = here;
}

/* Notes a state at the minimum of the parabola, between the neighbours of the lowest state. */
static void
note_vertex(struct rc_retraction_path *path, struct rc_retraction_parabola *parabola,
            struct rc_retraction_next *next, struct rc_retraction_state here)
{
    bool early = here.c > path->lowest.c;

    parabola->missed = isnan(parabola->load) ? 0 : fabs(here.load - parabola->load);
    path->shrunk = false;
    next->keep = RC_RETRACTION_HERE;
    next->is_lowest = here.load < path->lowest.load;
    if (next->is_lowest) {
        if (early)
            path->after = path->lowest;
        else
            path->before = path->lowest;
        path->lowest.kept = RC_RETRACTION_HERE;
        next->keep = here.kept = free_one(path);
        path->lowest = here;
    } else if (early) {
        path->has_before = false;
        next->keep = here.kept = free_one(path);
        path->has_before = true;
        path->before = here;
    } else {
        path->shrunk = path->lowest.punch == 0 &&
                       fabs(here.attraction - path->lowest.attraction) <=
                           in_part * fabs(path->after.attraction - path->lowest.attraction);
        path->after = here;
    }
}

/* ---- steps ---- */

/* The coarse step from a state. By the present slope, the load falls by a part of the holding force. This
 * force is at most the attraction, and at most a part of the force that opens a crack around the contact. */
static double
coarse_way(const struct rc_retraction_law *law, const struct rc_retraction_pace *pace,
           size_t states, const struct rc_retraction_state *here)
{
    double holds = here->attraction, way;

    if (here->crack > 0)
        holds = fmin(holds, here->crack);
    way = load_step * holds / (here->slope > 0 ? here->slope : pace->stiffness);
    if (states <= 1)
        return fmax(way, 0.02 * law->range);
    if (here->slope <= 0)
        return growth_after * pace->step;
    if (here->slope < pace->stiffest / 4)
        return pace->step; /* near a minimum */
    return fmin(way, growth * pace->step);
}

/* The fine step: as far as the load needs at least to fall below the lowest known one. */
static double
fine_way(const struct rc_retraction_pace *pace, double lowest,
         const struct rc_retraction_state *here)
{
    double falls = fmax(here->load - lowest, fine_step * fabs(lowest)) / stiffness(pace, here);

    return fmin(falls, growth_after * pace->step);
}

static bool
go(struct rc_retraction_next *next, const struct rc_retraction_state *from, double c)
{
    next->from = from->kept;
    next->from_c = from->c;
    next->c = c;
    return true;
}

static bool
go_on(struct rc_retraction *r)
{
    r->pace.step = r->stage == RC_RETRACTION_FINE
                       ? fine_way(&r->pace, lowest_known(&r->low, &r->path), &r->path.last)
                       : coarse_way(&r->law, &r->pace, r->count.states, &r->path.last);
    r->next.from = RC_RETRACTION_HERE;
    r->next.c = r->path.last.c - r->pace.step;
    return true;
}

/* True if no later load is lower. Where the contact opens at the lowest load, the attraction is minus
 * the load at once; the minimum then lies before this state, and one more state shows it. */
static bool
is_over(struct rc_retraction *r, const struct rc_retraction_state *here)
{
    if (r->count.states >= STATES) {
        r->found.short_of = true;
        return true;
    }
    if (r->stage == RC_RETRACTION_FINE && r->path.has_after && here->c <= r->low.to)
        return true;
    return (here->attraction <= -lowest_known(&r->low, &r->path) && !r->next.is_lowest) ||
           here->mean_gap > r->law.parted;
}

/* ---- stages ---- */

/* Repeats the path from this state, at most to the end of the last step that may hide a lower load. */
static bool
begin_fine(struct rc_retraction *r, struct rc_retraction_state from, double step)
{
    r->stage = RC_RETRACTION_FINE;
    r->count.fines++;
    if (r->path.lowest.load < r->low.known) {
        r->low.known = r->path.lowest.load;
        r->low.known_at = r->path.lowest.c;
    }
    r->low.hidden = r->low.beside = r->parabola.load = INFINITY;
    r->parabola.missed = 0;
    r->fine.n = r->count.checks = 0;
    r->path.last = r->path.base = from;
    r->path.has_base = true;
    r->path.has_prior = r->path.has_after = r->path.has_before = r->path.shrunk = false;
    if (from.c != r->path.lowest.c)
        r->path.lowest = (struct rc_retraction_state){.load = INFINITY, .kept = RC_RETRACTION_HERE};
    r->pace.step = step;
    return go(&r->next, &from, from.c - step);
}

static bool
end(struct rc_retraction *r, double load, double at, double spread)
{
    r->found.load = load;
    r->found.at = at;
    /* The fine stage does not search for smaller jumps than `settled`. Later loads are not below minus the
     * attraction. */
    spread = fmax(spread, r->count.fines > 0 ? settled * fabs(load) : 0);
    r->found.spread = fmax(spread, r->found.short_of ? load + r->path.last.attraction : 0);
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
/* Relative to the lowest load. Half and double change no bit (27 runs of bench/constants.py). */
static const double leap = 0.05;
enum {
    FIRST = 2,
    FIRST_OF_LINES = 4 /* with 2 the spread is below the error on 2 of 256 cylinders */
};

/* The spread of the lowest load and the loads beside it about their best parabola. */
static double
teeth(const struct rc_retraction_beside *beside)
{
    double a[3][4] = {{0}}, least = INFINITY, most = -INFINITY;

    if (beside->n <= 3) /* beyond a jump */
        return 0;
    for (size_t k = 0; k < beside->n; k++) {
        double x = beside->way[k] / fabs(beside->way[1]), power[] = {1, x, x * x};
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++)
                a[i][j] += power[i] * power[j];
            a[i][3] += power[i] * beside->load[k];
        }
    }
    for (int i = 0; i < 3; i++) /* the matrix is positive definite */
        for (int k = 0; k < 3; k++) {
            double factor = a[k][i] / a[i][i];
            for (int j = i; k != i && j < 4; j++)
                a[k][j] -= factor * a[i][j];
        }
    for (size_t k = 0; k < beside->n; k++) {
        double x = beside->way[k] / fabs(beside->way[1]);
        double off =
            beside->load[k] - (a[0][3] / a[0][0] + x * (a[1][3] / a[1][1] + x * a[2][3] / a[2][2]));
        least = fmin(least, off);
        most = fmax(most, off);
    }
    return most - least;
}

static bool
check(struct rc_retraction *r)
{
    double way, c;
    bool saw = r->parabola.missed > settled / 2 * fabs(r->parabola.load);

    if (r->count.checks == RC_RETRACTION_CHECKS ||
        (r->count.checks >= (r->law.lines ? FIRST_OF_LINES : FIRST) && !saw)) {
        double lowest = fmin(r->parabola.load, r->path.lowest.load),
               spread =
                   fmax(r->found.spread, saw ? 1.5 * teeth(&r->beside) : 2 * r->parabola.missed);
        if (r->parabola.leaps && r->count.fines == 0 && spread < leap * fabs(lowest))
            return begin_fine(r, r->path.base,
                              fine_way(&r->pace, lowest_known(&r->low, &r->path), &r->path.base));
        return end(r, lowest, lowest < r->path.lowest.load ? r->parabola.at : r->path.lowest.c,
                   spread);
    }
    way = sqrt(settled * fabs(r->parabola.load) / r->parabola.around);
    way = places[r->count.checks++] * fmin(way, r->parabola.at - r->parabola.late);
    c = r->parabola.at + way;
    if (c > r->path.base.c) /* there is no state to start from */
        c = r->parabola.at - way;
    return go(&r->next,
              c <= r->path.lowest.c   ? &r->path.lowest
              : c <= r->path.before.c ? &r->path.before
                                      : &r->path.base,
              c);
}

/* Checks this lowest load of a parabola with this bend; the spread is at least `spread`. */
static bool
begin_check(struct rc_retraction *r, double load, double at, double bend, double spread)
{
    r->stage = RC_RETRACTION_CHECK;
    r->parabola.load = r->beside.load[0] = load;
    r->parabola.at = at;
    r->beside.n = 1;
    r->parabola.bend = bend;
    r->found.spread = spread;
    return check(r);
}

static void
note_check(struct rc_retraction_path *path, struct rc_retraction_parabola *parabola,
           struct rc_retraction_beside *beside, struct rc_retraction_next *next,
           struct rc_retraction_state here)
{
    double way = here.c - parabola->at;

    next->keep = RC_RETRACTION_HERE;
    next->is_lowest = here.load < path->lowest.load;
    parabola->leaps |= here.load > parabola->load + leap * fabs(parabola->load);
    if (here.load > parabola->load + leap * fabs(parabola->load))
        return;
    parabola->missed =
        fmax(parabola->missed, fabs(here.load - parabola->load - parabola->bend * way * way));
    beside->way[beside->n] = way;
    beside->load[beside->n++] = here.load;
    if (!next->is_lowest)
        return;
    path->lowest.kept = RC_RETRACTION_HERE;
    next->keep = here.kept = free_one(path);
    path->lowest = here;
}

/* The lowest load that steps before the lowest state may hide. Between jumps the slope of the load over the
 * approach only falls. If a later step is steeper, the load has jumped up within the earlier one. Before that
 * jump it has fallen at most with the later slope. */
static double
hidden_before(const struct rc_retraction_fine *fine, const struct rc_retraction_path *path)
{
    double steepest = 0, least = INFINITY;

    for (size_t k = fine->n; k-- > 0;) {
        const struct rc_retraction_step *s = &fine->step[k];
        if (s->end < path->lowest.c)
            continue;
        if (steepest > convex * fmax(s->slope, 0))
            least = fmin(least, s->load - steepest * s->way);
        steepest = fmax(steepest, s->slope - noise * fabs(path->lowest.load) / s->way);
    }
    return fmax(least, -path->base.attraction);
}

/* The parabola through the lowest state and states well before and after it. */
static void
note_around(struct rc_retraction_parabola *parabola, const struct rc_retraction_path *path)
{
    const struct rc_retraction_state *late =
        path->prior.c < path->after.c ? &path->prior : &path->after;
    double at, bend;

    (void)vertex(&path->base, &path->lowest, late, &at, &bend);
    if (!(bend > 0))
        return;
    parabola->around = bend;
    parabola->late = late->c;
}

/* Ends the search with the lowest state and this spread, or checks it first. */
static bool
end_or_check(struct rc_retraction *r, double spread)
{
    const struct rc_retraction_state *m = &r->path.lowest;

    spread = fmax(spread, m->load - hidden_before(&r->fine, &r->path));
    if (r->law.lines && !(r->parabola.around > 0))
        note_around(&r->parabola, &r->path);
    return r->parabola.around > 0 ? begin_check(r, m->load, m->c, r->parabola.around, spread)
                                  : end(r, m->load, m->c, spread);
}

/* Chooses the next stage, the next vertex, or the end. */
static bool
settle(struct rc_retraction *r)
{
    const struct rc_retraction_state *l = &r->path.before, *m = &r->path.lowest,
                                     *right = &r->path.after;
    double least = fmin(fmin(r->low.hidden, r->low.beside), m->load), last = r->parabola.load,
           estimate, at, off, bend;
    bool again = r->count.fines < FINE && !r->found.short_of, jumped;

    if (!r->path.has_after) /* too few states */
        return again && r->path.has_base && counts(lowest_known(&r->low, &r->path), least)
                   ? begin_fine(r, r->path.base,
                                fine_way(&r->pace, lowest_known(&r->low, &r->path), &r->path.base))
                   : end(r, m->load, m->c, m->load - least);
    if (!r->path.has_before) { /* the first state has the lowest load, unless the first step was too
                             long */
        r->low.to = right->c;
        return again ? begin_fine(r, *m, (m->c - right->c) / 4)
                     : end(r, m->load, m->c, right->load - m->load);
    }
    estimate = vertex(l, m, right, &at, &bend);
    jumped =
        has_jumped((l->attraction - m->attraction) / (l->c - m->c), m, right) && !r->path.shrunk;
    if (r->stage == RC_RETRACTION_COARSE && !r->pace.rough && !jumped) {
        r->parabola.around = bend;
        r->parabola.late = right->c;
    }
    if ((r->pace.rough || r->law.lines) && r->count.fines == 0 && again)
        return begin_fine(r, r->path.base,
                          fine_way(&r->pace, lowest_known(&r->low, &r->path), &r->path.base));
    if (jumped && r->count.fines == 0 && again &&
        counts(lowest_known(&r->low, &r->path), r->low.beside)) {
        r->low.to = right->c;
        return begin_fine(r, *l, fine_way(&r->pace, lowest_known(&r->low, &r->path), l));
    }
    if (jumped) {
        double hides = m->load - stiffness(&r->pace, m) * (m->c - right->c);
        if (r->parabola.around > 0) /* the check measures the teeth */
            hides = m->load;
        if (!counts(lowest_known(&r->low, &r->path), hides) || r->count.halvings == HALVINGS)
            return end_or_check(r, fmax(m->load - fmin(least, hides), settled * fabs(m->load)));
        r->stage = RC_RETRACTION_VERTEX;
        r->count.halvings++;
        r->parabola.load = NAN;
        return go(&r->next, m, (m->c + right->c) / 2);
    }
    r->parabola.load = estimate;
    r->parabola.at = at;
    off = fmax(fabs(estimate - last), r->count.vertices > 0 ? r->parabola.missed : INFINITY);
    if (at == m->c)
        return end_or_check(r, fmin(off, m->load - least));
    if (r->count.vertices >= VERTICES || off <= settled * fabs(estimate)) {
        r->parabola.missed = off;
        if (r->law.lines && !(r->parabola.around > 0))
            note_around(&r->parabola, &r->path);
        if (!(r->parabola.around > 0)) {
            r->parabola.around = bend;
            r->parabola.late = right->c;
        }
        return begin_check(r, estimate, at, bend, m->load - hidden_before(&r->fine, &r->path));
    }
    r->stage = RC_RETRACTION_VERTEX;
    r->count.vertices++;
    if (l->c - m->c > lopsided * (m->c - right->c))
        at = m->c + golden * (l->c - m->c);
    else if (m->c - right->c > lopsided * (l->c - m->c))
        at = m->c - golden * (m->c - right->c);
    r->parabola.load += bend * (at - r->parabola.at) * (at - r->parabola.at);
    r->parabola.at = at;
    return go(&r->next, at > m->c ? l : m, at);
}

static bool
begin(struct rc_retraction *r, struct rc_retraction_state here)
{
    r->pace.stiffness = here.slope;
    here.rate = NAN;
    here.kept = r->next.keep = 0;
    r->next.is_lowest = true;
    r->path.last = r->path.lowest = here;
    return go_on(r);
}

bool
rc_retraction_next(struct rc_retraction *r, struct rc_retraction_state here)
{
    double hides, way;
    bool jumped, lost;

    if (r->count.states++ == 0)
        return begin(r, here);
    r->next.is_lowest = false;
    if (r->stage == RC_RETRACTION_VERTEX) {
        note_vertex(&r->path, &r->parabola, &r->next, here);
        return settle(r);
    }
    if (r->stage == RC_RETRACTION_CHECK) {
        note_check(&r->path, &r->parabola, &r->beside, &r->next, here);
        return check(r);
    }
    way = r->path.last.c - here.c;
    here.slope = (r->path.last.load - here.load) / way;
    here.rate = (r->path.last.attraction - here.attraction) / way;
    if (r->stage == RC_RETRACTION_COARSE && !r->path.has_prior &&
        here.slope > stiffer * r->path.last.slope) {
        r->next.keep = RC_RETRACTION_HERE;
        r->pace.step *= r->path.last.slope / here.slope;
        r->path.last.slope = here.slope;
        return go(&r->next, &r->path.last, r->path.last.c - r->pace.step);
    }
    jumped = has_jumped(r->path.last.rate, &r->path.last, &here);
    if (!r->path.has_after && r->path.has_prior &&
        here.slope > convex * fmax(r->path.last.slope, 0))
        r->pace.rough = true;
    hides = hidden(r->stage, &r->path, &r->pace, &here, jumped);
    lost = r->path.last.c > r->low.known_at && here.c <= r->low.known_at &&
           fmin(r->path.lowest.load, here.load) > r->low.known + settled * fabs(r->low.known);
    if (lost)
        hides = fmin(hides, r->low.known);
    if (r->stage == RC_RETRACTION_FINE &&
        (lost || (jumped && counts(lowest_known(&r->low, &r->path), hides))) && hides < here.load &&
        way > least_step * r->law.range && r->count.states < STATES) {
        r->next.keep = RC_RETRACTION_HERE;
        r->pace.step = way / 2;
        return go(&r->next, &r->path.last, r->path.last.c - r->pace.step);
    }
    if (jumped)
        here.rate = r->path.last.rate;
    else if (here.slope > 0)
        r->pace.stiffness = here.slope;
    r->pace.stiffest = fmax(r->pace.stiffest, here.slope);
    if (r->stage == RC_RETRACTION_FINE && !jumped) {
        if (r->fine.n == RC_RETRACTION_STEPS)
            memmove(r->fine.step, r->fine.step + 1, --r->fine.n * sizeof *r->fine.step);
        r->fine.step[r->fine.n++] =
            (struct rc_retraction_step){r->path.last.load, here.c, way, here.slope};
    }
    note(&r->path, &r->low, &r->next, here, hides);
    return is_over(r, &here) ? settle(r) : go_on(r);
}
