/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The model of wear: while the bodies slide by ds, the heights lose k p ds, with the pressure p of an inner
 * model and k = k1 + k2 (Archard 1953). Or body 1 stays in contact, and body 2 passes it along x on a track
 * of length L: then k is k1, and each row also loses k2/L times the integral of p along it. W p is all that
 * the heights lose per distance.
 *
 * Phi(h) is the largest h'p - 1/2 p'Kp of all pressures that carry the load, and dh/ds = -W grad Phi(h). Phi
 * is convex. The distance between two histories therefore never grows, errors of steps at most add, and the
 * pressure becomes even. The equation is stiff, because short waves decay by exp(-k E* q s/2). The steps are
 * implicit: the contact of the heights h under a compliance D = ds W has the pressure of the heights h - D p.
 *
 * A step of length t is TR-BDF2 (Bank et al. 1985, IEEE Trans. CAD 4, 436; Hosea and Shampine 1996, Appl.
 * Numer. Math. 20, 21), with g = 2 - sqrt 2, d = g/2, w = sqrt(2)/4. The pressure p_a is that of the heights
 * h - d t W p0, and p1 that of h - w t W (p0 + p_a), both with D = d t W. The heights lose t W (w p0 + w p_a
 * + d p1). The step leaves ripples in the pressure where nodes have just come into contact. The last part of
 * the distance takes three steps of backward Euler, which damp them, and then steps of BDF2, which do not use
 * the pressures before them. With the last step r times the one before, the heights lose t W q in a step, and
 *
 *     q = (r q' + (1 + r) p1)/(1 + 2 r),  q' that of the step before;  r = 0: backward Euler.
 *
 * The error of p1 is (t/3) times the change of slope of p between both steps (Hairer and Wanner 1996, VII.3).
 *
 * A given friction energy wears the heights by k times this energy instead, without a step: only the contact
 * of the worn heights is solved.
 */
#include "wear.h"

#include <math.h>
#include <string.h>

#include "libcontact/expected.h"

enum {
    /* Most from one step to the next. Half takes 4 % more convolutions. Double takes 1 % fewer, with
     * errors up to twice as large (26 runs of bench/constants.py). */
    GROWTH = 4,
    MOST_TRIES = 3, /* more of a leg that is not accurate enough */
    /* Smoothing steps of backward Euler, after which the pressure has no ripples. With one the largest
     * pressure has up to 20 times the error; with 6 it takes 5 % more convolutions. */
    EULER = 3,
    STATE = 7 /* maps beside the heights */
};
static const double g = 0.58578643762690495, d = 0.29289321881345248, w = 0.35355339059327376;
/* Factor of the local error, t^3 k p'': |3 g^2 - 4 g + 2|/(12 (2 - g)) of Bank et al. 1985. */
static const double third_order = 0.0404;
/* Wear coefficients are rarely known to 10 %. */
static const double usual_tol = 0.1;
/* The smoothing steps before a point take this part of the distance, and at least `fewest` steps. Half of the
 * part takes 1.4 times the convolutions, because legs are tried again, double 5 % more, with up to 5 and 6
 * times the errors. Half of the steps takes 4 % fewer, with 1.2 times the errors, double 24 % more, with 0.8
 * times. */
static const double last_part = 0.1, fewest = 4;
/* In dx/(k E*): a last short step before a point, over which the shortest wave decays by exp(-5), where
 * the smoothing steps are `unsettled` times as long. A node that comes into contact in a step of BDF2
 * takes up to 1.5 times its pressure, because it had none in the step before: the largest pressure was
 * up to 34 % too high. With the short step, which is nearly backward Euler, it is up to 5 % off, with a
 * third of it 14 %. Half and double of either change the convolutions by 0.1 %, and the error of the largest
 * pressure up to 3 times. */
static const double settle = 3, unsettled = 4;
/* Part of the tolerance for the errors of these steps: of the heights, and of the pressure after the
 * last one. After the steps before it the pressure may be `loose` times less accurate, because BDF2
 * divides the error of a pressure by 3 in each step. Half of the three takes 2, 0.5 and 0.2 % more
 * convolutions, double 1 % fewer, 7 % more and as many; double of the first has up to 1.4 times the
 * errors. */
static const double of_last = 0.1, of_smooth = 0.3, loose = 10;
/* The tolerance of their contacts, over the tolerance of the others. Where the last valleys close, a few
 * nodes can carry several times the mean pressure within the usual tolerance. The next contact starts there
 * and keeps it. The largest pressure was wrong by 165 %, and with a tenth of the tolerance by 1.0 %. The
 * tolerance bounds a sum over the map, so that one node of a larger map may be wrong by more: by 85 % of 1024
 * x 1024. The part therefore decreases with the number of nodes. Half of the
 * tolerance takes 1 % more convolutions, double 1 % fewer, with up to 8 times the error of a pressure. */
static const double accurate = 0.1, nodes_in_part = 750;
/* The least part of the tolerance of a contact where most of the load is on nodes that do not wear. Half and
 * double change no bit. */
static const double least_share = 1e-3;
/* Part of the tolerance for the steps; the rest is for the contacts. Double takes 5 % fewer convolutions at a
 * tolerance of 0.1, and 16 to 20 % more at 0.01 and 0.001, where more steps are rejected (50 runs of
 * law_wear_estimates). */
static const double of_tol = 0.8;
/* Part of the tolerance that the wear of a coefficient map may use until it ends. Half takes 2 % more
 * convolutions, double 2 % fewer, with up to 2.2 times the errors. */
static const double in_volume = 0.9;
/* Over the distance: the longest step to an early end by area or spread, which rise and fall as nodes come
 * into contact, and the last step. */
static const double seen = 0.1, step_to_end = 0.02;
/* Tolerance below which the steps of a leg begin with less than their part. Without it most legs are tried
 * again at 1e-4, with 1.3 times the convolutions (19 maps of 10 x 10 nodes). */
static const double kinks = 1e-3;
/* Aim of a leg that is tried again, over the tolerance. Half takes 2 % more convolutions, double 7 % more. */
static const double aim = 0.6;
/* Times the errors of the steps. With half, 15 of 219 estimates of the wear were below the error
 * (law_wear_estimates). Double takes 8 % more convolutions. */
static const double caution = 2;
/* Times these errors in the estimate: a node that comes into contact or leaves it bends the pressure at a
 * part x of a step. With a unit change of the slope the step errs by (1 - w - d) x - x^2/2 for x < g, and its
 * estimate is 2 third_order x/g: the error is up to (1 - w - d) g/(2 third_order) = 2.56 times the estimate.
 * For x > g it is up to 1.5 times. The steps do not depend on this factor. With 0.75 for the response of the
 * pressure one of 95 estimates of the pressure was 0.985 of the error. */
static const double bends = 1.28; /* 2.56 over caution */
/* In dx/(k E*): within it the shortest wave, q = pi/dx, decays by a seventh. Half takes 9 % more
 * convolutions, double 11 % fewer, with errors up to 2.3 times as large in both (21 runs of
 * bench/constants.py). */
static const double first_step = 0.1;
/* Times the errors of the pressure by BDF2. Half takes 1 % fewer convolutions, double 1 % more. */
static const double of_change = 2;
/* At one node: times the pressure that closes the gap which the contact has left open, and times the relative
 * L1 error of the contacts before. With 1 one of 103 estimates of the largest pressure was 0.94 of its error
 * (law_wear_estimates). */
static const double at_node = 1.5;
/* Times the side of the map over E*: above this compliance the error of the contact changes the heights
 * more than elasticity does. Not sensitive: half and double change convolutions and errors by at most
 * 2 % (26 runs of bench/constants.py). */
static const double long_step = 1.0 / 3;

enum stage {
    REST,  /* at a point                                  */
    PRESS, /* the contact of the present heights          */
    FIRST, /* the two contacts of a step of TR-BDF2       */
    SECOND,
    LAST /* a smoothing step                            */
};

enum {           /* of error[] */
    OF_HEIGHTS,  /* m: sum of the errors of the heights due to all steps, with decay and signs */
    OF_CONTACTS, /* m: sum of those due to the contacts, which only add */
    OF_P0,
    OF_STEPS,
    OF_ALL, /* relative, of p0: due to all steps of TR-BDF2                                */
    LEFT, /* relative, of the contacts of the last step of TR-BDF2: the heights keep a part of it */
    WEAR_P0, /* relative, of the wear under p0, pa and p1: that of the pressures, or less */
    WEAR_PA,
    WEAR_P1,
    OF_PEAK, /* relative, of the largest p0 at a point */
    ERRORS
};

/* The coefficients of the law. */
struct rates {
    double k;           /* 1/Pa: sum of the bodies that stay, at the node that wears most */
    double row;         /* 1/Pa: k2/L of the body that passes; 0: none         */
    double share[2];    /* of the bodies in `worn`                             */
    const double *part; /* coefficient of a node over the largest one; NULL: 1 */
    double least;       /* the smallest one */
};

struct maps {
    double *h, *worn;     /* heights at the start, and worn depth of the bodies that stay */
    double *deep;         /* worn depth of each row of the body that passes               */
    double *p0, *pa, *p1; /* pressures of a step                                        */
    double *q, *change;   /* of the last smoothing step: q, and the change of the pressure;
                             in steps of TR-BDF2 `change` has the error of all steps */
    double *e, *room; /* error of a step, in smoothing steps of all; heights of the inner model */
};

struct way {
    size_t stage, last;      /* last: smoothing steps since the last point                */
    double s, end, t, tried; /* m: distance slid, end of the leg, next step, present step */
    double next, before;     /* m: next smoothing step, and the last one                  */
    size_t tries;            /* repetitions of the leg                                    */
    double strict;           /* the steps of the leg have this part of their tolerance    */
    double spent;            /* m: error of the worn depths at the start of the leg       */
    double x, rise;          /* how far conditions of an early end are met; 1/m: its rate */
};

struct wear {
    struct rc_model base;
    struct rc_wear_problem law;
    struct rates rates;
    size_t n;   /* nodes of this rank */
    double all; /* nodes of the map */
    struct maps maps;
    struct way way;
    double error[ERRORS]; /* m: errors of the worn depths; relative: errors of p0, of steps ... */
    double over;          /* m: the compliance of the last contact is W times this      */
    bool kept;            /* the inner model has kept its contact                     */
    bool fitted;          /* the heights in contact were replaced by K p minus the shift */
    bool good;            /* all contacts have converged                              */
    bool met;             /* one of the conditions law.until_... is met               */
    bool again;           /* a state was read: its contact must be solved again       */
    double in_contact;    /* part of the nodes in contact */
    struct rc_wear_figures f;
};
const struct rc_figure rc_figures_wear[] = {
#define FIGURE(member) RC_FIGURE(struct rc_wear_figures, member)
#define AS(column, member) RC_FIGURE_AS(column, struct rc_wear_figures, member)
    {FIGURE(distance), "m", "Sliding distance"},
    {FIGURE(wear_volume), "m3", "Worn volume", .says = "of both bodies"},
    {FIGURE(wear_volume_1), "m3", "Worn volume of body 1"},
    {FIGURE(wear_volume_2), "m3", "Worn volume of body 2"},
    {FIGURE(max_wear_depth), "m", "Largest worn depth", .says = "of both bodies together"},
    {FIGURE(mean_wear_depth), "m", "Mean worn depth", .says = "over the whole map"},
    {FIGURE(pressure_spread), NULL, "Spread of the pressure",
     .says = "standard deviation of the pressure in contact over its mean"},
    {FIGURE(steps), NULL, "Steps", .role = RC_FIGURE_COST},
    {FIGURE(rejected), NULL, "Rejected steps", .role = RC_FIGURE_COST},
    {FIGURE(contacts), NULL, "Contacts", .role = RC_FIGURE_COST, .says = "solved so far"},
    {FIGURE(convolutions), NULL, "Convolutions", .role = RC_FIGURE_COST,
     .says = "of all contacts so far, in equivalents of one in double precision on this grid"},
    {AS("wear_error_estimate", wear_error), NULL, "Error of the wear",
     .says = "estimated error of the worn depth: its L1 norm over the worn volume",
     .role = RC_FIGURE_ERROR, .by = "tol", .of = "wear"},
    {AS("pressure_error_estimate", pressure_error), NULL, "Error of the pressure",
     .says = "estimated relative L1 error", .role = RC_FIGURE_ERROR, .by = "tol", .of = "pressure"},
    {AS("max_pressure_error_estimate", max_pressure_error), NULL, "Error of the largest pressure",
     .says = "relative, by steps and contacts", .role = RC_FIGURE_ERROR, .by = "tol",
     .of = "max_pressure"},
    {FIGURE(converged), NULL, "Converged", .says = "the error estimates are within the tolerance"},
    {0},
};
static const struct rc_figure_set sets[] = {{rc_figures_wear, offsetof(struct wear, f)}, {NULL, 0}};

const struct rc_frame_kind rc_wear_frames[] = {
    [RC_WEAR_GAP] = {"gap", "m", "Gap"},
    [RC_WEAR_HEIGHT] = {"height", "m", "Worn height"},
    [RC_WEAR_BOTH] = {"wear", "m", "Worn depth"},
    [RC_WEAR_1] = {"wear-1", "m", "Worn depth of body 1"},
    [RC_WEAR_2] = {"wear-2", "m", "Worn depth of body 2"},
    {NULL, NULL, NULL},
};

/* ---- a contact ---- */

struct rc_point
rc_wear_load(const struct rc_model *m, double s)
{
    const struct rc_point *from = &m->from, *to = &m->to;
    const double start = from->at[RC_DISTANCE], way = to->at[RC_DISTANCE] - start;
    const bool all = from->given == 0 || !(way > 0);
    const struct rc_point at = rc_point_between(from, to, all ? 1 : (s - start) / way);

    return rc_point_for(m->inner, &at);
}

/* The coefficient of a node over the largest one. */
static double
part(const struct rates *rates, size_t k)
{
    return rates->part == NULL ? 1 : rates->part[k];
}

/* The depth that all bodies have lost at a node. */
static double
depth(const struct maps *maps, double row, size_t nx, size_t k)
{
    return maps->worn[k] + (row > 0 ? maps->deep[k / nx] : 0);
}

/* Adds t W p to `to`. With `deep`, m of each row, adds the part of the rows there instead. */
static void
lose(const struct wear *v, double t, const double *p, double *to, double *deep)
{
    const struct rates *rates = &v->rates;
    const struct rc_shape *s = &v->base.shape;

    for (size_t k = 0; k < v->n; k++)
        to[k] += t * rates->k * part(rates, k) * p[k];
    for (size_t j = 0; j < v->base.rows.n && rates->row > 0; j++) {
        const double sunk = t * rates->row * s->dx * rc_sum(p + j * s->nx, s->nx);
        for (size_t i = 0; i < s->nx && deep == NULL; i++)
            to[j * s->nx + i] += sunk;
        if (deep != NULL)
            deep[j] += sunk;
    }
}

/* The largest sum of W p over the map, over the sum of p. */
static double
most_lost(const struct rates *rates, const struct rc_shape *s)
{
    return rates->k + rates->row * s->dx * (double)s->nx;
}

/* The sum of W p. */
static double
rate(const struct wear *v, const double *p)
{
    const struct rates *rates = &v->rates;
    const double most = most_lost(rates, &v->base.shape);
    struct rc_total sum = {0};

    for (size_t k = 0; k < v->n; k++)
        rc_total_add(&sum, (most - rates->k + rates->k * part(rates, k)) * p[k]);
    return rc_ranks_total(v->base.rows.ranks, sum);
}

/* The sum of the depths of all rows of the body that passes. */
static double
deep(const struct wear *v)
{
    return rc_ranks_sum_of(v->base.rows.ranks, v->maps.deep, v->base.rows.n);
}

/* The sum of the worn depths. */
static double
lost(const struct wear *v)
{
    return rc_ranks_sum_of(v->base.rows.ranks, v->maps.worn, v->n) +
           (v->rates.row > 0 ? (double)v->base.shape.nx * deep(v) : 0);
}

/* The sum of |a| over the map. */
static double
size(const struct wear *v, const double *a)
{
    return rc_ranks_distance(v->base.rows.ranks, a, NULL, v->n);
}

/* The wear per distance of the nodes that wear over that of all nodes at the largest coefficient: now,
 * or on the average so far. Below 1 where nodes that wear less carry the load. */
static double
share(const struct wear *v)
{
    const struct rc_shape *s = &v->base.shape;
    const double all = most_lost(&v->rates, s) * size(v, v->maps.p0);
    const double now = rate(v, v->maps.p0), worn = lost(v);

    return v->rates.part == NULL || !(now > 0 || worn > 0)
               ? 1
               : fmax(least_share, fmax(now, v->way.s > 0 ? worn / v->way.s : 0) / all);
}

/* The tolerance of the contact of this stage, over the usual one. */
static double
accuracy(const struct wear *v)
{
    return v->way.stage == LAST ? fmin(accurate * share(v), nodes_in_part / v->all) : share(v);
}

/* Gives the inner model these heights, and the compliance of this stage. */
static enum rc_status
pose_at(struct wear *v, const double *heights, struct rc_err *err)
{
    if (rc_model_set_compliance(v->base.inner, v->rates.k * v->over, v->rates.part,
                                v->rates.row * v->over, err) != RC_OK)
        return RC_FAIL;
    rc_model_set_accuracy(v->base.inner, accuracy(v));
    return rc_model_set_heights(v->base.inner, heights, err);
}

/* The present smoothing step over the last one; 0: it is one of backward Euler. */
static double
ratio(const struct way *way)
{
    return way->last >= EULER ? way->tried / way->before : 0;
}

/* The weight of the new pressure in q; the rest is that of the q before. */
static double
newest(const struct wear *v)
{
    const double r = ratio(&v->way);

    return (1 + r) / (1 + 2 * r);
}

/* The heights and the compliance of this stage. The heights of the last contact of a leg stay in pa,
 * for a state. */
static enum rc_status
pose(struct wear *v, struct rc_err *err)
{
    const bool halves = v->way.stage == FIRST || v->way.stage == SECOND;

    v->over = halves ? d * v->way.tried : v->way.stage == LAST ? newest(v) * v->way.tried : 0;
    for (size_t k = 0; k < v->n; k++)
        v->maps.room[k] = v->maps.h[k] - depth(&v->maps, v->rates.row, v->base.shape.nx, k);
    if (halves)
        lose(v, -(v->way.stage == FIRST ? d : w) * v->way.tried, v->maps.p0, v->maps.room, NULL);
    if (v->way.stage == SECOND)
        lose(v, -w * v->way.tried, v->maps.pa, v->maps.room, NULL);
    if (v->way.stage == LAST)
        lose(v, (newest(v) - 1) * v->way.tried, v->maps.q, v->maps.room, NULL);
    if (!halves)
        memcpy(v->maps.pa, v->maps.room, v->n * sizeof *v->maps.pa);
    return pose_at(v, v->maps.room, err);
}

/* Starts the contact of a stage. Plastic dents of the last step stay. */
static enum rc_status
contact(struct wear *v, enum stage stage, struct rc_err *err)
{
    const double along = stage == PRESS ? 0 : stage == FIRST ? g : 1;
    const struct rc_point to = rc_wear_load(&v->base, v->way.s + along * v->way.tried);

    if (!v->kept && rc_model_keep(v->base.inner, err) != RC_OK)
        return RC_FAIL;
    v->kept = true;
    v->way.stage = stage;
    return pose(v, err) == RC_OK ? rc_model_go(v->base.inner, &to, err) : RC_FAIL;
}

/* The largest sum of |e| that an error e of the heights has now or gets while the bodies slide on. The flow
 * never increases the sum of |e| over the coefficients; in the end e is even over the contact. */
static double
lasting(const struct wear *v, const double *p, const double *e)
{
    const struct rates *rates = &v->rates;
    struct rc_total weighted = {0}, weights = {0}, count = {0};
    double sum[3];

    if (rates->part == NULL)
        return size(v, e);
    for (size_t k = 0; k < v->n; k++)
        if (part(rates, k) > 0) {
            rc_total_add(&weighted, fabs(e[k]) / part(rates, k));
            rc_total_add(&weights, rc_in_contact(p[k]) / part(rates, k));
            rc_total_add(&count, rc_in_contact(p[k]));
        }
    rc_ranks_totals(v->base.rows.ranks, 3, (struct rc_total[]){weighted, weights, count}, sum, 0,
                    NULL);
    return fmax(size(v, e), sum[1] > 0 ? sum[2] / sum[1] * sum[0] : 0);
}

/* ---- steps ---- */

double
rc_wear_spread(const struct rc_ranks *ranks, const double *p, size_t n)
{
    struct rc_total total[3] = {{0}};
    double sum[3];

    for (size_t k = 0; k < n; k++) {
        rc_total_add(&total[0], p[k]);
        rc_total_add(&total[1], p[k] * p[k]);
        rc_total_add(&total[2], rc_in_contact(p[k]));
    }
    rc_ranks_totals(ranks, 3, total, sum, 0, NULL);
    return sqrt(fmax(sum[2] * sum[1] / (sum[0] * sum[0]) - 1, 0));
}

/* The estimated error of the worn depths, m: their sum over the nodes. */
static double
off(const struct wear *v)
{
    return caution * v->error[OF_HEIGHTS] + v->error[OF_CONTACTS];
}

static void
find_figures(struct wear *v)
{
    const double cell = v->base.shape.dx * v->base.shape.dy;
    const struct rc_ranks *ranks = v->base.rows.ranks;
    struct rc_wear_figures *f = &v->f;
    struct rc_total in = {0};
    double count;

    f->distance = v->law.energy == NULL ? v->way.s : NAN;
    f->wear_volume = rc_ranks_sum_of(ranks, v->maps.worn, v->n) * cell;
    f->max_wear_depth = 0;
    for (size_t k = 0; k < v->n; k++) {
        f->max_wear_depth =
            fmax(f->max_wear_depth, depth(&v->maps, v->rates.row, v->base.shape.nx, k));
        in.sum += rc_in_contact(v->maps.p0[k]);
    }
    rc_ranks_totals(ranks, 1, &in, &count, 1, &f->max_wear_depth);
    f->wear_volume_1 = v->rates.share[0] * f->wear_volume;
    f->wear_volume_2 = v->rates.share[1] * f->wear_volume;
    if (v->rates.row > 0)
        f->wear_volume += f->wear_volume_2 = deep(v) * v->base.shape.dy * v->law.track;
    f->mean_wear_depth = lost(v) / v->all;
    f->pressure_spread = rc_wear_spread(ranks, v->maps.p0, v->n);
    f->wear_error = f->wear_volume > 0
                        ? (bends * caution * v->error[OF_HEIGHTS] + v->error[OF_CONTACTS]) / lost(v)
                        : 0;
    f->pressure_error = v->error[OF_STEPS] + v->error[OF_P0];
    f->max_pressure_error = v->way.stage == REST ? v->error[OF_PEAK] : NAN;
    f->converged = v->good && f->wear_error <= v->law.tol && f->pressure_error <= v->law.tol;
    v->in_contact = count / v->all;
}

/* The distance before the point that backward Euler takes, m. */
static double
last_way(double start, double end)
{
    return fmin(last_part * end, end - start);
}

static bool
may_end_early(const struct rc_wear_problem *law)
{
    return law->until_area > 0 || law->until_depth > 0 || law->until_spread > 0;
}

/* How far the conditions of an early end are met after a smoothing step of length t with the pressure p. The
 * first one is met where this is 1; it is at most 2. */
static double
find_progress(struct wear *v, const double *p, double t)
{
    const struct rc_wear_problem *law = &v->law;
    struct rc_total in = {0};
    double deepest = 0, x = 0, count;

    for (size_t k = 0; k < v->n; k++)
        v->maps.room[k] = depth(&v->maps, v->rates.row, v->base.shape.nx, k);
    lose(v, newest(v) * t, p, v->maps.room, NULL);
    lose(v, (1 - newest(v)) * t, v->maps.q, v->maps.room, NULL);
    for (size_t k = 0; k < v->n; k++) {
        in.sum += rc_in_contact(p[k]);
        deepest = fmax(deepest, v->maps.room[k]);
    }
    rc_ranks_totals(v->base.rows.ranks, 1, &in, &count, 1, &deepest);
    if (law->until_area > 0)
        x = count / v->all / law->until_area;
    if (law->until_depth > 0)
        x = fmax(x, deepest / law->until_depth);
    if (law->until_spread > 0)
        x = fmax(x, law->until_spread / rc_wear_spread(v->base.rows.ranks, p, v->n));
    return fmin(x, 2);
}

/* The longest next step of a run that may end early: half the way that is left at the present rate. */
static double
longest(const struct wear *v)
{
    const double rise = v->way.last > EULER ? v->way.rise : 0;

    return rise > 0 ? fmax((1 - v->way.x) / rise / 2, step_to_end / 2 * v->way.s) : INFINITY;
}

/* The largest sum of the depths that wear, so far or in the whole distance at the present rate. */
static double
most_worn(const struct wear *v)
{
    return fmax(lost(v), v->way.end * rate(v, v->maps.p1));
}

static enum rc_status start(struct wear *v, struct rc_err *err);

/* Returns to the start of the leg, and takes shorter steps of both kinds: most of the error of the pressure
 * may be due to the smoothing steps. */
static enum rc_status
try_again(struct wear *v, struct rc_err *err)
{
    const double part = fmax(aim * v->law.tol / fmax(v->f.pressure_error, v->f.wear_error), 0.125),
                 strict = v->way.strict * part;
    const size_t tries = v->way.tries + 1;
    const struct rc_wear_figures done = v->f;

    if (rc_model_recall(&v->base, err) != RC_OK)
        return RC_FAIL;
    v->f.rejected = done.rejected + done.steps - v->f.steps;
    v->f.contacts = done.contacts;
    v->f.convolutions = done.convolutions;
    v->way.strict = strict;
    v->way.tries = tries;
    return start(v, err);
}

/* Starts the next step, if there is one. A run that may end early has smoothing steps only, because its
 * pressures must have no ripples. */
static enum rc_status
set_out(struct wear *v, struct rc_err *err)
{
    const double left = v->way.end - last_way(v->base.from.at[RC_DISTANCE], v->way.end) - v->way.s;
    double rest = v->way.end - v->way.s, close;

    if (!(rest > 1e-12 * v->way.end)) {
        v->way.s = v->way.end;
        v->way.stage = REST;
        find_figures(v);
        if (v->good && v->way.tries < MOST_TRIES &&
            (v->f.pressure_error > v->law.tol ||
             (v->f.wear_error > v->law.tol && v->way.spent < off(v) / 2)))
            return try_again(v, err);
        return v->f.converged ? RC_OK : RC_SHORT;
    }
    if (v->law.energy != NULL) {
        for (size_t k = 0; k < v->n; k++)
            v->maps.worn[k] += v->rates.k * v->law.energy[k] * (v->way.end - v->way.s);
        v->way.s = v->way.end;
        v->way.tried = 0;
        return contact(v, PRESS, err);
    }
    if (v->way.last == 0 && left > 1e-9 * v->way.end && !may_end_early(&v->law)) {
        v->way.tried = v->way.t >= left ? left : v->way.t > left / 2 ? left / 2 : v->way.t;
        return contact(v, FIRST, err);
    }
    if (!(v->way.next > 0))
        v->way.next =
            fmin(1, v->law.tol / usual_tol) *
            (may_end_early(&v->law)
                 ? step_to_end / 2 * fmax(v->way.s, rc_wear_first_step(&v->law, &v->base.shape))
                 : rest / fewest);
    v->way.next = fmin(v->way.next, longest(v));
    close = settle / first_step * rc_wear_first_step(&v->law, &v->base.shape);
    if (!may_end_early(&v->law) && v->way.next > unsettled * close && rest > 1.001 * close)
        rest -= close;
    v->way.tried = rest / ceil(rest / v->way.next * (1 - 1e-9));
    return contact(v, LAST, err);
}

/* Under a large compliance the tolerance of the contact changes the heights more than elasticity does. This
 * replaces the heights in contact by K p minus the shift. Their volume stays, because the mean gap is 0
 * there. */
static enum rc_status
fit(struct wear *v, struct rc_err *err)
{
    const struct rc_shape *s = &v->base.shape;
    const double side = fmax(s->dx * (double)s->nx, s->dy * (double)s->ny);

    v->fitted = v->over * v->rates.k * v->rates.least * v->law.estar > long_step * side &&
                !(rc_model_number(v->base.inner, "plastic_area") > 0);
    if (!v->fitted)
        return RC_OK;
    if (rc_model_frame(v->base.inner, "gap", v->maps.room, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < v->n; k++)
        v->maps.worn[k] -= rc_in_contact(v->maps.p1[k]) ? v->maps.room[k] : 0;
    return RC_OK;
}

/* A step has lowered the heights by that distance times W (first (p0 + pa) + last p1); p1 is their pressure.
 * `error`, m: sum of the errors of the contacts at the nodes; `e`: of all steps. */
static enum rc_status
take(struct wear *v, double first, double last, double error, const double *e, double of_p1,
     double of_steps, struct rc_err *err)
{
    double *p = v->maps.p0;

    if (first > 0) {
        lose(v, first * v->way.tried, v->maps.p0, v->maps.worn, v->maps.deep);
        lose(v, first * v->way.tried, v->maps.pa, v->maps.worn, v->maps.deep);
    }
    lose(v, last * v->way.tried, v->way.stage == LAST ? v->maps.q : v->maps.p1, v->maps.worn,
         v->maps.deep);
    if (fit(v, err) != RC_OK)
        return RC_FAIL;
    v->maps.p0 = v->maps.p1;
    v->maps.p1 = p;
    v->way.s += v->way.tried;
    v->error[OF_CONTACTS] += error;
    v->error[OF_HEIGHTS] = size(v, e);
    v->error[OF_P0] = of_p1;
    v->error[WEAR_P0] = v->error[WEAR_P1];
    v->error[OF_STEPS] = of_steps;
    v->kept = false;
    v->f.steps += v->way.stage != PRESS;
    find_figures(v);
    v->base.looked = true; /* also without a look, which may change the contact */
    return RC_OK;
}

/* The contact corrects a part of the error e of a step: D z, with the change z of the pressure with the
 * heights. This damps the stiff part. The sum of |z|, Pa, estimates the error of the pressure. */
static enum rc_status
respond(struct wear *v, double *sum, struct rc_err *err)
{
    if (rc_model_respond(v->base.inner, v->maps.e, v->maps.room, err) != RC_OK)
        return RC_FAIL;
    v->f.convolutions += 1;
    lose(v, -v->over, v->maps.room, v->maps.e, NULL);
    *sum = size(v, v->maps.room);
    return RC_OK;
}

/* The errors of the nodes by the contact, Pa, from the gap that it has left open. The call overwrites
 * `room`. */
static enum rc_status
find_contact_errors(struct wear *v, double *to, struct rc_err *err)
{
    if (rc_model_frame(v->base.inner, "gap", to, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < v->n; k++)
        to[k] = rc_in_contact(v->maps.p1[k]) ? to[k] : 0;
    if (rc_model_respond(v->base.inner, to, v->maps.room, err) != RC_OK)
        return RC_FAIL;
    v->f.convolutions += 1;
    for (size_t k = 0; k < v->n; k++)
        to[k] = at_node * fabs(v->maps.room[k]);
    return RC_OK;
}

/* How far the error z of the largest pressure can be from its estimate, Pa. z is the sum of m_j e_j over
 * the nodes, with their errors e_j and the response m to a unit height at the node of the largest pressure.
 * A step with a bend errs by 0.44 to `bends` caution times its estimate. Each node has another such factor,
 * and the parts m_j e_j of neighbours nearly cancel, so that z alone was down to 0.06 of the error. The
 * deviations of the nodes are independent and add as squares. The call overwrites `unit` and `room`. */
static enum rc_status
find_spread(struct wear *v, double *unit, double *spread, struct rc_err *err)
{
    const struct rc_ranks *ranks = v->base.rows.ranks;
    const double before = (double)v->base.rows.first * (double)v->base.shape.nx;
    const double most = rc_ranks_highest(ranks, v->maps.p1, v->n);
    struct rc_total squares = {0};
    double first = -INFINITY;

    for (size_t k = v->n; k-- > 0;)
        if (v->maps.p1[k] >= most)
            first = -before - (double)k;
    first = -rc_ranks_most(ranks, first);
    for (size_t k = 0; k < v->n; k++)
        unit[k] = before + (double)k == first ? 1 : 0;
    if (rc_model_respond(v->base.inner, unit, v->maps.room, err) != RC_OK)
        return RC_FAIL;
    v->f.convolutions += 1;
    for (size_t k = 0; k < v->n; k++)
        rc_total_add(&squares, pow(v->maps.room[k] * v->maps.e[k], 2));
    *spread = (bends * caution - 1) * sqrt(rc_ranks_total(ranks, squares));
    return RC_OK;
}

/* The error of the largest pressure: how far it can move while each node moves by its error. The pressure
 * is that of the worn heights, and its error the response z to their error, in `room`, to which the last
 * step adds. Steps with bends have the sign of their estimate, so that a node can move by the factor of
 * these along z. The parts of z due to the neighbours may cancel, so that it can also move by z the other
 * way. The error of the last step, in p0, replaces z where it is larger. `contacts`: errors by the contact;
 * `spread`: see find_spread. All are in Pa. */
static void
find_peak_error(struct wear *v, const double *contacts, double spread)
{
    const struct rc_ranks *ranks = v->base.rows.ranks;
    double most = 0, above = 0, below = 0, at = 0;

    for (size_t k = 0; k < v->n; k++) {
        const double p = v->maps.p1[k], z = v->maps.room[k], last = v->maps.p0[k];
        const double up = fmax(z > 0 ? bends * caution * z : -z, last);
        const double down = fmax(z < 0 ? -bends * caution * z : z, last);
        at = p > most ? fabs(z) : at;
        most = fmax(most, p);
        above = fmax(above, p + up + contacts[k]);
        below = fmax(below, p - down - contacts[k]);
    }
    at = most < rc_ranks_most(ranks, most) ? 0 : at;
    at = rc_ranks_most(ranks, at);
    most = rc_ranks_most(ranks, most);
    above = rc_ranks_most(ranks, above);
    below = rc_ranks_most(ranks, below);
    v->error[OF_PEAK] = at_node * fmax(v->error[OF_P0], v->error[LEFT]) +
                        (most > 0 ? fmax(fmax(above - most, most - below), at + spread) / most : 0);
}

/* The largest error of the present step, m, as a sum over the nodes: a part of the depth that it wears,
 * down to half of it where earlier steps have used the tolerance. Where the load moves to nodes that do
 * not wear, the wear ends; a part of the tolerance that is left is then used in each e-fold of the
 * distance. */
static double
allowed(const struct wear *v)
{
    const double t = v->way.tried, now = t * rate(v, v->maps.p1), worn = lost(v), used = off(v),
                 most = of_tol * fmax(0.5, 1 - (used > 0 ? used / (v->law.tol * worn) : 0)) *
                        v->law.tol * now,
                 left = (in_volume * v->law.tol * worn - used) / (2 * caution) * t / (v->way.s + t);

    return v->way.strict * (v->rates.part == NULL ? most : fmax(most, left));
}

/* Accepts the smoothing step, or tries a shorter one. The error of the pressure is the response to the
 * error of the heights, which holds that of the last step; where the estimate of the last step alone is
 * larger, it is that. */
static enum rc_status
even(struct wear *v, double of_p1, struct rc_err *err)
{
    const double step = most_lost(&v->rates, &v->base.shape) * v->way.tried,
                 sum = size(v, v->maps.p1), *error = v->error;
    const bool early = may_end_early(&v->law);
    const double r = ratio(&v->way), weight = newest(v), s = v->way.s + v->way.tried,
                 way = early ? s + rc_wear_first_step(&v->law, &v->base.shape)
                             : last_way(v->base.from.at[RC_DISTANCE], v->way.end);
    const double x = early ? find_progress(v, v->maps.p1, v->way.tried) : 0;
    const bool met = x >= 1 && v->way.last >= EULER,
               final = met || !(v->way.end - s > 1e-12 * v->way.end);
    struct rc_total apart = {0};
    double change, worst, z, spread = 0;
    bool far;

    for (size_t k = 0; k < v->n; k++) {
        v->maps.room[k] = (v->maps.p1[k] - v->maps.p0[k] - r * v->maps.change[k]) / (r > 0 ? 3 : 2);
        rc_total_add(&apart, fabs(v->maps.room[k]) / sum);
    }
    change = rc_ranks_total(v->base.rows.ranks, apart);
    worst = step * sum * change /
            (early ? caution * allowed(v)
                   : v->way.strict * of_last * v->law.tol * v->way.tried / way * most_worn(v));
    if (v->way.last >= EULER) /* before, the pressures have ripples */
        worst = fmax(worst, of_change * change / (of_smooth * v->law.tol) / (final ? 1 : loose));
    v->way.next =
        fmin(early && v->law.until_area + v->law.until_spread > 0 ? seen * way : way / fewest,
             v->way.tried * fmax(fmin(2, 0.9 / sqrt(worst)), 1.0 / GROWTH));
    far = met && v->way.tried > step_to_end * s;
    if (far)
        v->way.next = v->way.tried / 2;
    if ((worst > 1 || far) && v->way.tried > 1e-12 * v->way.end) {
        v->f.rejected++;
        return set_out(v, err);
    }
    for (size_t k = 0; k < v->n; k++) {
        if (v->way.last == 0)
            v->maps.e[k] = v->maps.change[k];
        v->maps.change[k] = v->maps.p1[k] - v->maps.p0[k];
        v->maps.q[k] = weight * v->maps.p1[k] + (r > 0 ? (1 - weight) * v->maps.q[k] : 0);
    }
    lose(v, v->way.tried, v->maps.room, v->maps.e, NULL);
    v->way.last++;
    v->way.before = v->way.tried;
    v->way.rise = (x - v->way.x) / v->way.tried;
    v->way.x = x;
    v->met = met;
    v->way.end = met ? s : v->way.end;
    for (size_t k = 0; k < v->n && final; k++)
        v->maps.p0[k] = of_change * fabs(v->maps.room[k]);
    if ((final && (find_spread(v, v->maps.change, &spread, err) != RC_OK ||
                   find_contact_errors(v, v->maps.change, err) != RC_OK)) ||
        respond(v, &z, err) != RC_OK)
        return RC_FAIL;
    if (final)
        find_peak_error(v, v->maps.change, spread);
    if (take(v, 0, 1, step * sum * error[WEAR_P1], v->maps.e, of_p1,
             fmax(error[OF_P0], error[LEFT]) + fmax(of_change * change, bends * caution * z / sum),
             err) != RC_OK)
        return RC_FAIL;
    v->error[OF_ALL] = z / sum;
    return set_out(v, err);
}

/* Adds the error of the step to the error of all steps. That error goes through the step as a difference of
 * two histories does: a part of it that decays by exp(-y) gets the factor (1 - (1 - 2 d) y)/(1 + d y)^2.
 * The response of the contact gives S = 1/(1 + d y), and with d = 1 - sqrt(1/2) the factor is S (S - sqrt 2
 * (1 - S)). Outside the contact S is 1. Where the error was taken to decay as 1/s, it was up to 3 times too
 * large, and its response at the node of the largest pressure down to a quarter of the error. */
static enum rc_status
age(struct wear *v, struct rc_err *err)
{
    double *local = v->maps.e, sum;

    v->maps.e = v->maps.change;
    v->maps.change = local;
    if (respond(v, &sum, err) != RC_OK)
        return RC_FAIL;
    lose(v, -sqrt(2) * v->over, v->maps.room, v->maps.e, NULL);
    if (respond(v, &sum, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < v->n; k++)
        v->maps.change[k] += v->maps.e[k];
    return RC_OK;
}

/* Accepts the step of TR-BDF2, or tries a shorter one. Its local error e is third_order t^3 W p'', with p''
 * from the three pressures. */
static enum rc_status
judge(struct wear *v, double of_p1, struct rc_err *err)
{
    const double step = most_lost(&v->rates, &v->base.shape) * v->way.tried,
                 sum = size(v, v->maps.p1), *error = v->error;
    const double most = allowed(v);
    double e, z = 0, contacts, factor;

    memset(v->maps.e, 0, v->n * sizeof *v->maps.e);
    for (size_t k = 0; k < v->n; k++)
        v->maps.room[k] =
            (v->maps.p1[k] - v->maps.pa[k]) / (1 - g) - (v->maps.pa[k] - v->maps.p0[k]) / g;
    lose(v, 2 * third_order * v->way.tried, v->maps.room, v->maps.e, NULL);
    if (respond(v, &z, err) != RC_OK)
        return RC_FAIL;
    e = lasting(v, v->maps.p1, v->maps.e);
    /* The next step aims below the largest error. Half takes 4 % more convolutions. Double takes 1 % fewer,
     * with errors up to 3.4 times as large (26 runs of bench/constants.py). */
    factor = fmin(GROWTH, 0.9 * sqrt(most / e));
    if (e > most && v->way.tried > 1e-12 * v->way.end) {
        v->way.t = fmax(factor, 1.0 / GROWTH) * v->way.tried;
        v->f.rejected++;
        return set_out(v, err);
    }
    /* an error of p0 also acts through p_a, twice: no contact increases a difference of its heights */
    contacts = step * sum * (3 * w * error[WEAR_P0] + w * error[WEAR_PA] + d * error[WEAR_P1]);
    if (v->way.tried >= v->way.t ||
        factor < 1) /* a step shortened to end at the point does not limit the next one */
        v->way.t = fmax(factor, 1.0 / GROWTH) * v->way.tried;
    v->error[OF_ALL] = v->error[OF_ALL] * v->way.s / (v->way.s + v->way.tried) + z / sum;
    if (age(v, err) != RC_OK)
        return RC_FAIL;
    if (take(v, w, d, contacts, v->maps.change, of_p1, v->error[OF_ALL], err) != RC_OK)
        return RC_FAIL;
    return set_out(v, err);
}

enum rc_status
rc_wear_check_point(const struct rc_model *m, struct rc_err *err)
{
    if (rc_point_has(&m->to, RC_APPROACH))
        return rc_err_set(err, "wear at a given approach is not implemented: give the load");
    if (!(m->to.at[RC_LOAD] > 0))
        return rc_err_set(err, "load %g N: bodies wear under a load above 0", m->to.at[RC_LOAD]);
    return RC_OK;
}

/* Starts the leg. */
static enum rc_status
start(struct wear *v, struct rc_err *err)
{
    const struct rc_model *m = &v->base;

    v->way.end = v->met ? v->way.s : m->to.at[RC_DISTANCE];
    v->way.last = 0;
    v->way.next = 0;
    v->way.spent = off(v);
    memcpy(v->maps.change, v->maps.e, v->n * sizeof *v->maps.e);
    v->again = false;
    if (m->from.given == 0 || (!v->met && v->way.s >= v->way.end)) {
        v->way.tried = 0;
        v->good = true;
        return contact(v, PRESS, err);
    }
    return v->met ? RC_OK : set_out(v, err);
}

/* The part of their tolerance for the steps of a new leg. Below `kinks` the error of the pressure, which has
 * kinks where nodes come into contact, falls more slowly than the tolerance. */
static double
most_strict(const struct rc_wear_problem *law)
{
    return fmin(1, pow(law->tol / kinks, 0.25));
}

static enum rc_status
go(struct rc_model *m, struct rc_err *err)
{
    struct wear *v = (struct wear *)m;

    if (rc_wear_check_point(m, err) != RC_OK)
        return RC_FAIL;
    v->way.tries = 0;
    v->way.strict = fmin(most_strict(&v->law), GROWTH * v->way.strict);
    return start(v, err) == RC_FAIL ? RC_FAIL : RC_OK;
}

/* The error of the wear under a pressure p, relative to k times the load; of_p is the error of p. Where nodes
 * stick, most of the error of the pressure may be at these. An error z of the pressure moves the heights by
 * D z, and (K + D) z is the gap that the contact has left open, so that the sum of |D z| is about that of
 * |gap| at most. The largest D is `compliance`. */
static double
wear_error(const struct wear *v, double of_p, const double *p, const double *gap, double compliance)
{
    struct rc_total open = {0};

    for (size_t k = 0; k < v->n; k++)
        rc_total_add(&open, rc_in_contact(p[k]) ? fabs(gap[k]) : 0);
    return fmin(of_p,
                caution * rc_ranks_total(v->base.rows.ranks, open) / (compliance * size(v, p)));
}

static enum rc_status
step(struct rc_model *m, struct rc_err *err)
{
    struct wear *v = (struct wear *)m;
    const bool there = v->way.stage == REST && !v->again;
    const enum rc_status status = there ? RC_OK : rc_model_step(m->inner, err);
    double of_p1;

    if (status == RC_MORE || status == RC_FAIL)
        return status;
    v->again = false;
    if (v->way.stage == REST)
        return set_out(v, err);
    if (rc_model_look(m->inner, NULL, err) != RC_OK ||
        rc_model_frame(m->inner, "pressure", v->maps.p1, err) != RC_OK)
        return RC_FAIL;
    v->good = v->good && status == RC_OK;
    v->f.contacts++;
    v->f.convolutions += rc_model_number(m->inner, "convolutions");
    of_p1 = rc_model_number(m->inner, "pressure_error_estimate");
    v->error[WEAR_P1] = of_p1;
    if (v->rates.part != NULL && v->over > 0) {
        if (rc_model_frame(m->inner, "gap", v->maps.room, err) != RC_OK)
            return RC_FAIL;
        v->error[WEAR_P1] = wear_error(v, of_p1, v->maps.p1, v->maps.room, v->rates.k * v->over);
    }
    if (v->way.stage != LAST)
        v->error[LEFT] = fmax(v->way.stage == SECOND ? v->error[LEFT] : 0, of_p1);
    switch (v->way.stage) {
    case FIRST: {
        double *pa = v->maps.pa;
        v->maps.pa = v->maps.p1;
        v->maps.p1 = pa;
        v->error[WEAR_PA] = v->error[WEAR_P1];
        return contact(v, SECOND, err);
    }
    case SECOND:
        return judge(v, of_p1, err);
    case LAST:
        return even(v, of_p1, err);
    default: /* PRESS */
        if (may_end_early(&v->law) && find_progress(v, v->maps.p1, 0) >= 1) {
            v->met = true;
            v->way.end = v->way.s;
        }
        if (!(v->way.s < v->way.end)) {
            if (find_contact_errors(v, v->maps.q, err) != RC_OK)
                return RC_FAIL;
            memset(v->maps.p0, 0, v->n * sizeof *v->maps.p0);
            memset(v->maps.room, 0, v->n * sizeof *v->maps.room);
            find_peak_error(v, v->maps.q, 0);
        }
        if (take(v, 0, 0, 0, v->maps.e, of_p1, 0, err) != RC_OK)
            return RC_FAIL;
        return set_out(v, err);
    }
}

/* ---- results ---- */

static enum rc_status
height_in(struct wear *v, double *to, struct rc_err *err)
{
    struct rc_model *inner = v->base.inner;

    if (v->way.stage != REST) {
        for (size_t k = 0; k < v->n; k++)
            to[k] = v->maps.h[k] - depth(&v->maps, v->rates.row, v->base.shape.nx, k);
        return RC_OK;
    }
    if (rc_model_frame(inner, "plastic", to, err) != RC_OK ||
        (v->fitted && rc_model_frame(inner, "gap", v->maps.room, err) != RC_OK))
        return RC_FAIL;
    for (size_t k = 0; k < v->n; k++)
        to[k] += v->fitted && rc_in_contact(v->maps.p0[k]) ? v->maps.room[k] : 0;
    lose(v, -v->over, v->maps.p0, to, NULL);
    return RC_OK;
}

static enum rc_status
fill(struct rc_model *m, size_t frame, double *to, struct rc_err *err)
{
    struct wear *v = (struct wear *)m;
    const double of_worn = frame == RC_WEAR_BOTH ? 1 : v->rates.share[frame == RC_WEAR_2];
    const bool track = v->rates.row > 0 && frame != RC_WEAR_1;

    if (frame == RC_WEAR_HEIGHT)
        return height_in(v, to, err);
    if (frame == RC_WEAR_GAP && rc_model_frame(m->inner, "gap", to, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < v->n; k++)
        if (frame != RC_WEAR_GAP)
            to[k] = of_worn * v->maps.worn[k] + (track ? v->maps.deep[k / m->shape.nx] : 0);
        else if (v->fitted && rc_in_contact(v->maps.p0[k]))
            to[k] = 0;
    return RC_OK;
}

/* The approach is counted from the highest node of the worn heights; the shift is K p - h - g at any node. */
static enum rc_status
find_approach(struct wear *v, double *approach, struct rc_err *err)
{
    const struct rc_rows *rows = &v->base.rows;
    const bool first = rows->first == 0 && rows->n > 0; /* this rank has node 0 */
    double shift = -INFINITY;

    if (rc_model_frame(v->base.inner, "displacement", v->maps.room, err) != RC_OK)
        return RC_FAIL;
    if (first)
        shift = v->maps.room[0];
    if (height_in(v, v->maps.p1, err) != RC_OK ||
        fill(&v->base, RC_WEAR_GAP, v->maps.room, err) != RC_OK)
        return RC_FAIL;
    if (first)
        shift -= v->maps.p1[0] + v->maps.room[0];
    shift = rc_ranks_most(rows->ranks, shift);
    if (!isnan(*approach))
        *approach = shift + rc_ranks_highest(rows->ranks, v->maps.p1, v->n);
    return RC_OK;
}

static enum rc_status
look(struct rc_model *m, struct rc_point *at, struct rc_err *err)
{
    struct wear *v = (struct wear *)m;

    find_figures(v);
    v->f.converged = v->f.converged && m->status != RC_MORE;
    at->at[RC_DISTANCE] = v->way.s;
    return find_approach(v, &at->at[RC_APPROACH], err);
}

static enum rc_status
keep(struct rc_model *m, struct rc_err *err)
{
    struct wear *v = (struct wear *)m;

    if (!v->kept && rc_model_keep(m->inner, err) != RC_OK)
        return RC_FAIL;
    v->kept = true;
    return RC_OK;
}

/* ---- states ---- */

static void
state(struct rc_model *m, struct rc_state *s)
{
    struct wear *v = (struct wear *)m;
    struct rc_err err;
    bool there, halves;

    rc_state_count(s, &v->way.stage, LAST);
    halves = v->way.stage == FIRST || v->way.stage == SECOND;
    there = v->way.stage == REST && m->moved && !rc_state_is_copy(s);
    RC_STATE_FLAGS(s, &v->kept, &v->good, &v->met, &v->fitted);
    RC_STATE_COUNTS(s, &v->way.last, &v->way.tries, &v->f.steps, &v->f.rejected, &v->f.contacts);
    RC_STATE_NUMBERS(s, &v->way.s, &v->way.end, &v->way.t, &v->way.tried, &v->f.convolutions);
    RC_STATE_SIZES(s, &v->over, &v->way.next, &v->way.before, &v->way.strict, &v->way.spent,
                   &v->way.x);
    RC_STATE_NUMBERS(s, &v->way.rise);
    rc_state_finite(s, ERRORS, v->error);
    rc_state_map(s, v->n, v->maps.worn);
    if (v->rates.row > 0)
        rc_state_rows(s, &m->rows, m->shape.nx, v->maps.deep);
    rc_state_map(s, v->n, v->maps.p0);
    if (!halves)
        rc_state_map(s, v->n, v->maps.e);
    if (v->way.stage == SECOND || there)
        rc_state_map(s, v->n, v->maps.pa);
    if (v->way.stage == LAST && v->way.last > 0)
        rc_state_map(s, v->n, v->maps.q);
    if (halves || v->way.stage == LAST)
        rc_state_map(s, v->n, v->maps.change);
    if (!rc_state_reads(s))
        return;
    v->again = there;
    if ((there ? pose_at(v, v->maps.pa, &err) : pose(v, &err)) != RC_OK)
        rc_state_refuse(s, "its heights are not finite");
}

static void
progress(const struct rc_model *m, struct rc_loops *l)
{
    const struct wear *v = (const struct wear *)m;

    if (v->law.energy != NULL)
        rc_loops_add(l, "cycles", NULL, v->way.s, v->way.end);
    else
        rc_loops_add(l, "distance", "m", v->way.s, v->way.end);
    rc_loops_add(l, "step", NULL, (double)v->f.steps, NAN);
}

/* Measured on rough maps and balls: 4 steps a decade from the first one on, contacts of these, and the last
 * steps; more of all for a smaller error, where nodes that come into contact limit the steps (to 1e-4). */
static enum rc_status
plan(const struct rc_model *m, const struct rc_point *most, struct rc_expected *expected,
     struct rc_err *err)
{
    const struct wear *v = (const struct wear *)m;
    const struct rc_point inner = rc_point_for(m->inner, most);
    const double nodes = most->at[RC_DISTANCE] * (v->rates.k + v->rates.row * m->shape.dx) *
                         v->law.estar / m->shape.dx;
    const double steps = 4 * fmax(log10(nodes / first_step), 0) + 2,
                 decades = fmax(log10(usual_tol / v->law.tol), 0);
    const double contacts = !(most->at[RC_DISTANCE] > 0) ? 1
                            : v->law.energy != NULL
                                ? 2
                                : RC_WEAR_CONTACT * (1 + 2 * steps + fewest) *
                                      pow(10, decades * (0.25 + 0.11 * decades));
    const double work = contacts * (v->rates.part != NULL ? RC_WEAR_BY_NODE : 1);

    if (rc_model_plan(m->inner, &inner, expected, err) != RC_OK)
        return RC_FAIL;
    expected->convolutions *= work;
    expected->seconds *= work;
    if (v->rates.part != NULL) /* of the preconditioner, see rc_preconditioner_tune */
        expected->memory += 2 * v->n * sizeof(float);
    expected->memory += STATE * v->n * sizeof(double);
    return RC_OK;
}

const struct rc_model_row rc_model_wear = {
    .name = "wear",
    .summary = "bodies that wear as they slide, over an inner model",
    .needs = 1u << RC_LOAD | 1u << RC_DISTANCE,
    .takes = 1u << RC_DISTANCE,
    RC_MODEL_VERBS,
    .frame = rc_wear_frames,
    .keep = keep,
    .plan = plan,
};

/* ---- the maker ---- */

enum rc_status
rc_wear_check(const struct rc_model *m, struct rc_wear_problem *law, struct rc_err *err)
{
    const size_t n = rc_model_nodes(m), first = m->rows.first * m->shape.nx;
    enum rc_status status = RC_OK;
    double largest = 0;

    for (int b = 0; b < 2; b++)
        if (!(law->k[b] >= 0) || isinf(law->k[b]))
            return rc_err_set(
                err, "wear coefficient %g 1/Pa of body %d: it must be at least 0 and finite",
                law->k[b], b + 1);
    if (law->k[0] + law->k[1] == 0)
        return rc_err_set(err, "no body wears: one of the two wear coefficients must be above 0");
    for (size_t k = 0; k < n && law->part != NULL && status == RC_OK; k++) {
        if (!(law->part[k] >= 0 && law->part[k] <= 1))
            status =
                rc_err_set(err,
                           "node %zu has %g of the largest wear coefficient: the ratio must be "
                           "from 0 to 1",
                           first + k, law->part[k]);
        largest = fmax(largest, law->part[k]);
    }
    for (size_t k = 0; k < n && law->energy != NULL && status == RC_OK; k++)
        if (!(law->energy[k] >= 0) || isinf(law->energy[k]))
            status = rc_err_set(err, "energy %g J/m2 of node %zu: it must be at least 0 and finite",
                                law->energy[k], first + k);
    if (rc_ranks_agree(m->rows.ranks, status, err) != RC_OK)
        return RC_FAIL;
    largest = rc_ranks_most(m->rows.ranks, largest);
    if (law->part != NULL && largest != 1)
        return rc_err_set(err, "the largest coefficient is %g of itself: it must be 1", largest);
    if (law->energy != NULL &&
        (law->part != NULL || law->track > 0 || law->two_bodies || law->until_area > 0 ||
         law->until_depth > 0 || law->until_spread > 0))
        return rc_err_set(err, "wear by a given energy excludes coefficients of nodes, a track, "
                               "sliding and conditions: leave them out");
    if (!(law->track >= 0) || isinf(law->track))
        return rc_err_set(err, "track of %g m: it must be at least 0 and finite", law->track);
    if (law->track > 0 && law->k[1] > 0 && law->part != NULL)
        return rc_err_set(err, "a track that wears beside a coefficient of each node is not "
                               "implemented");
    if (!(law->estar > 0) || isinf(law->estar))
        return rc_err_set(err, "E* %g Pa: it must be above 0 and finite", law->estar);
    if (!(law->tol >= 0 && law->tol < 1))
        return rc_err_set(err, "tolerance %g: it must be above 0 and below 1", law->tol);
    law->tol = law->tol > 0 ? law->tol : usual_tol;
    return RC_OK;
}

double
rc_wear_first_step(const struct rc_wear_problem *law, const struct rc_shape *s)
{
    const double k = law->k[0] + law->k[1] * (law->track > 0 ? s->dx / law->track : 1);

    return first_step * s->dx / (k * law->estar);
}

static enum rc_status
make(struct wear *v, const double *h, const struct rc_wear_problem *law, struct rc_err *err)
{
    struct rc_model *inner = v->base.inner;
    const struct rc_shape *s = &v->base.shape;
    double **maps[] = {&v->maps.worn, &v->maps.p0,     &v->maps.pa, &v->maps.p1,
                       &v->maps.q,    &v->maps.change, &v->maps.e,  &v->maps.room};

    v->n = rc_model_nodes(&v->base);
    v->all = (double)s->nx * (double)s->ny;
    v->law = *law;
    if (rc_wear_check(&v->base, &v->law, err) != RC_OK)
        return RC_FAIL;
    v->rates.part = law->part;
    v->rates.least = law->part != NULL ? INFINITY : 1;
    for (size_t k = 0; k < v->n && law->part != NULL; k++)
        v->rates.least = fmin(v->rates.least, law->part[k]);
    v->rates.least = -rc_ranks_most(v->base.rows.ranks, -v->rates.least);
    v->rates.row = law->track > 0 ? law->k[1] / law->track : 0;
    v->rates.k = law->k[0] + (law->track > 0 ? 0 : law->k[1]);
    v->rates.share[0] = law->track > 0 ? 1 : law->k[0] / v->rates.k;
    v->rates.share[1] = law->track > 0 ? 0 : law->k[1] / v->rates.k;
    v->way.t = rc_wear_first_step(&v->law, s);
    v->way.strict = 1;
    v->kept = true;
    if ((law->energy == NULL && rc_model_set_compliance(inner, v->rates.k * v->way.t, law->part,
                                                        v->rates.row * v->way.t, err) != RC_OK) ||
        rc_model_set_compliance(inner, 0, NULL, 0, err) != RC_OK)
        return RC_FAIL;
    v->maps.h = rc_store_copy(&v->base.own, v->n, sizeof *h, h);
    for (size_t k = 0; k < sizeof maps / sizeof *maps; k++)
        *maps[k] = rc_store_zeros(&v->base.own, v->n, sizeof **maps[k]);
    v->maps.deep = rc_store_zeros(&v->base.own, v->base.rows.n, sizeof *v->maps.deep);
    return rc_model_room(&v->base, err);
}

struct rc_model *
rc_wear_new(struct rc_model *inner, const double *h, const struct rc_wear_problem *law,
            struct rc_err *err)
{
    RC_OWN(rc_model, m) = NULL;

    if (law->two_bodies)
        return rc_wear_two_bodies_new(inner, h, law, err);
    m = rc_model_make_outer(&rc_model_wear, sizeof(struct wear), inner, err);
    return m != NULL && make((struct wear *)m, h, law, err) == RC_OK ? rc_give(&m) : NULL;
}
