/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Chooses the number of increments from point to point, and estimates their error from solutions with half
 * and with a quarter of the increments. All factors were fitted on random paths.
 */
#include "friction.h"

#include <math.h>

/* Relative: smaller changes and angles are rounding of the numbers that a user writes. Half and double
 * change no bit (10 paths of bench/constants.py). */
static const double straight = 1e-9;

enum {
    /* Of a straight leg, whose estimate is made for two increments: with half and double 8 and 12
     * estimates are below the error (10 paths of bench/constants.py). */
    LATE = 2,
    /* So many, and half of them, suffice to estimate the error. Half changes no bit, double takes 7 %
     * more convolutions (10 paths of bench/constants.py). */
    HALVED = 4,
    /* Of a force that turns by a right angle. Half takes 2 % fewer convolutions with estimates up to
     * twice as large, and double takes 11 % more (10 paths of bench/constants.py). */
    TURNS = 8,
    /* Of a contact that grows or shrinks. Half takes 0.6 times the convolutions, with errors up to 3
     * times as large. Double takes 1.8 times as many, with errors down to 0.3 times (10 paths of
     * bench/constants.py). */
    PRESSES = 16
};

/* ---- points ---- */

static double
pressing(const struct rc_point *p)
{
    return p->at[rc_point_has(p, RC_APPROACH) ? RC_APPROACH : RC_LOAD];
}

static bool
moved(const struct rc_point *p)
{
    return rc_point_has(p, RC_DISPLACEMENT_X);
}

/* The force or the displacement along x and y. */
static const double *
tangent(const struct rc_point *p)
{
    return &p->at[moved(p) ? RC_DISPLACEMENT_X : RC_TANGENTIAL_X];
}

static double
length(const double v[2])
{
    return hypot(v[0], v[1]);
}

/* The sine of the angle between two legs; 0: there is no angle. */
static double
turn(const struct rc_point *from, const struct rc_point *to)
{
    const double *a = tangent(from), *b = tangent(to), d[2] = {b[0] - a[0], b[1] - a[1]};

    if (!(length(a) > 0) || !(length(d) > 0) || moved(from) != moved(to))
        return 0;
    return fabs(a[0] * d[1] - a[1] * d[0]) / (length(a) * length(d));
}

static bool
tangent_changes(const struct rc_point *from, const struct rc_point *to)
{
    const double *a = tangent(from), *b = tangent(to), d[2] = {b[0] - a[0], b[1] - a[1]};

    return moved(to) != moved(from) || length(d) > straight * fmax(length(a), length(b));
}

/* ---- the choice ---- */

/* One increment is exact between bodies of equal elasticity with nu = 0. All nodes slip along one line,
 * provided that all earlier forces were parallel to this line. */
static bool
exact(const struct rc_friction_law *o, const struct rc_shear *shear, bool coupled,
      const struct rc_leg *before, const struct rc_point *from, const struct rc_point *to)
{
    const double *a = tangent(from), *b = tangent(to);
    const bool grows = pressing(to) > pressing(from) * (1 + straight);
    const bool capped = o->tau_max > 0 && !isinf(o->tau_max);
    const bool aside = fabs(a[0] * b[1] - a[1] * b[0]) > straight * length(a) * length(b);

    return !coupled && shear->kap == 0 && !aside &&
           (moved(from) == moved(to) || !(length(a) > 0)) && (!grows || !(moved(to) || capped)) &&
           (before->told == RC_TOLD_EXACT || pressing(from) == 0);
}

/* How the error of n increments is known. */
static enum rc_told
told(size_t n, bool grows, bool falls, bool late, bool coupled)
{
    if (late)
        return RC_TOLD_SOME;
    if (n < HALVED)
        return RC_TOLD_UNKNOWN;
    if (n < TURNS) /* factors of their own */
        return coupled ? RC_TOLD_MANY : grows || falls ? RC_TOLD_SOME : RC_TOLD_FEW;
    if (grows && !coupled)
        return n >= PRESSES ? RC_TOLD_SOME : RC_TOLD_FEW;
    if (grows || falls)
        return n >= PRESSES && coupled ? RC_TOLD_MANY : RC_TOLD_SOME;
    return coupled ? RC_TOLD_MANY : RC_TOLD_SOME;
}

struct rc_leg
rc_friction_leg(const struct rc_friction_problem *o, const struct rc_leg *before,
                const struct rc_point *from, const struct rc_point *to)
{
    const bool grows = pressing(to) > pressing(from) * (1 + straight);
    const bool falls = pressing(to) < pressing(from) * (1 - straight);
    const bool changes = tangent_changes(from, to), loaded = pressing(from) > 0;
    const double angle = turn(from, to);
    struct rc_shear shear = {0};
    struct rc_leg leg = {.increments = o->increments > 0 ? o->increments : 1, .falls = falls};
    bool coupled;

    (void)rc_pair_shear(&o->law.pair, o->law.nu, &shear, NULL);
    coupled = shear.beta != 0 && o->coupling != RC_COUPLING_NONE;
    leg.carries = coupled || length(tangent(to)) > 0 || (loaded && before->carries);
    leg.told = loaded ? before->told : RC_TOLD_EXACT;
    if (!leg.carries || pressing(to) == 0 || (!grows && !falls && !changes)) {
        if (!coupled)
            leg.increments = 1;
        leg.late = leg.increments == 1;
        return leg;
    }
    if (exact(&o->law, &shear, coupled, before, from, to))
        return leg;
    if (o->increments > 0)
        ;
    else if (grows || falls)
        leg.increments = PRESSES;
    else if (angle > straight)
        while (leg.increments < TURNS &&
               ((double)leg.increments < TURNS * angle * (1 - straight) || leg.increments < HALVED))
            leg.increments *= 2;
    else
        leg.increments = LATE;
    leg.late = leg.increments == LATE && o->increments == 0;
    if (leg.told < told(leg.increments, grows, falls, leg.late, coupled))
        leg.told = told(leg.increments, grows, falls, leg.late, coupled);
    return leg;
}

size_t
rc_leg_fewer(const struct rc_leg *leg, size_t halvings)
{
    const size_t n = leg->increments >> halvings;

    return n > 0 ? n : 1;
}

/* On a straight leg the traction of a node opposes its slip in the whole increment, not its slip at the end.
 * Most nodes slip after 0.9 of the leg, and the rest of the leg turns their tractions. If the load falls, the
 * increments become shorter towards the end, because many nodes begin to slip late. */
double
rc_leg_part(const struct rc_leg *leg, size_t k, size_t n)
{
    /* Half gives errors up to 1.8 times as large, within the estimates (10 paths of
     * bench/constants.py). */
    static const double late = 0.9;
    const double part = leg->late ? late : (double)k / (double)n;

    if (k == n)
        return 1;
    return leg->falls ? 1 - (1 - part) * (1 - part) : part;
}

/* ---- the error ---- */

/* With four to seven increments. An error that falls as 1/n is d over `part`, where half of the increments
 * are 2 or 3. In 1,118 states of random paths this estimate was 1.05 times the error and more, 3 to 5 times
 * in the median. With two or three increments no factor below 40 covers all errors, and the median is then 10
 * and more. */
static double
error_of_few(const struct rc_leg *leg, double before, double d, double d2)
{
    static const double factor[][2] = {/* half is 2, 3 */
                                       [RC_TOLD_MANY] = {2, 1.7},
                                       [RC_TOLD_SOME] = {5.5, 4},
                                       [RC_TOLD_FEW] = {6, 4}};
    static const double earlier[] = {1, 0.7};
    const size_t n = leg->increments, half = rc_leg_fewer(leg, 1), row = half - 2;
    const double part = (double)(n - half) / (double)half;

    return fmax(fmax(factor[leg->told][row] * d / part, earlier[row] * d2), before);
}

/* With half of the increments the error is larger by d, and with a quarter by another d2. Their ratio shows
 * how fast the error falls. On a leg of one or two increments, the leg adds `lagged` to d. The error of the
 * previous point stays, also where d and d2 fall because they cancel. */
double
rc_leg_error(const struct rc_leg *leg, double before, double d, double d2, double lagged)
{
    /* Of the difference of runs with whole and half increments: with more of them it falls faster.
     * Nothing else depends on these factors. */
    static const double factor[] = {[RC_TOLD_MANY] = 2, [RC_TOLD_SOME] = 3, [RC_TOLD_FEW] = 6};
    /* A ratio near 1 would make the sum infinite. Half and double change no bit (10 paths of
     * bench/constants.py). */
    static const double slowest = 0.85;
    double rho;

    if (leg->told == RC_TOLD_EXACT)
        return 0;
    if (leg->told == RC_TOLD_UNKNOWN)
        return NAN;
    if (leg->late)
        return fmin(fmax(factor[leg->told] * d, before), before + factor[RC_TOLD_SOME] * lagged);
    if (leg->increments >= HALVED && leg->increments < TURNS)
        return error_of_few(leg, before, d, d2);
    rho = d < slowest * d2 ? d / d2 : slowest;
    return fmax(fmax(factor[leg->told] * d, d * rho / (1 - rho)), before);
}
