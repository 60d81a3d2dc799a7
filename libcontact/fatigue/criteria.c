/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Criteria of high-cycle fatigue for the stress history of one material point, a closed cycle of n states.
 *
 * s is the deviator, h a third of the trace, f and t the endurance limits in fully reversed bending and
 * torsion. The constants give each criterion the index 1 in both of these tests:
 *
 *     Crossland (1956)         (R + k max h) / t                            k = 3 t/f - sqrt 3
 *     Dang Van (1973)          max over time of (tau + k h) / t             k = 3 t/f - 3/2
 *     Papadopoulos (1994)      (sqrt(5 <T_a^2>) + k max h) / t              k = 3 t/f - sqrt 3
 *     Findley (1959)           max over planes of (tau_a + k max s_n) / l   k = (2 - r) / (2 sqrt(r - 1)),
 *                                                       r = f/t, l = f / (2 sqrt(r - 1))
 *     shakedown (Melan 1938)   min over rho of max sqrt J2(s + rho) / (Y / sqrt 3)
 *
 * R is the radius of the smallest ball about the path of s, where the square of a length is J2, and s* its
 * centre. tau is half of Tresca's stress of s - s*. T_a is half the range of the shear stress on a plane in a
 * direction, and <> its mean over all planes and directions. tau_a is the radius of the smallest circle about
 * the shear stress on a plane. rho is any stress sxx, syy: residual stresses that do not vary along the
 * travel leave these two free. Its ball has a centre that is free in two of five directions.
 */
#include "fatigue.h"

#include <stdlib.h>

const char *const rc_criterion_names[RC_FATIGUES] = {"crossland",  "dangvan",   "papadopoulos",
                                                     "findley",    "shakedown", "amplitude",
                                                     "plane-tilt", "plane-turn"};

/* Limits of t/f between which a criterion is defined. */
static const struct {
    const char *name;
    double low, high;
} ranges[] = {[RC_CROSSLAND] = {"Crossland", 0.57735026918962576, INFINITY},
              [RC_DANG_VAN] = {"Dang Van", 0.5, INFINITY},
              [RC_PAPADOPOULOS] = {"Papadopoulos", 0.57735026918962576, 0.8},
              [RC_FINDLEY] = {"Findley", 0.5, 1}};

enum {
    STEP = 10,       /* degrees between the planes of the first search */
    RINGS = 10,      /* of these planes, from the pole to the equator */
    PLANES = 240,    /* room for them                              */
    STARTS = 4,      /* planes from which the search is refined */
    REFINEMENTS = 10 /* each halves the step                       */
};
/* Planes whose value is below the largest by at most this part of what varies between planes may be
 * near another maximum that is larger; a hydrostatic stress varies between none. Those within 15
 * degrees of a better one belong to the same maximum. The cosine of 15 degrees is 0.9659. */
static const double near_best = 0.02, same_hill = 0.9659;

/* Papadopoulos's mean: Gauss's points in the cosine of the normal's angle to z, on the half that is
 * different, times equal steps of the other two angles. */
enum {
    TILTS = 5,
    TURNS = 20,
    DIRECTIONS = 10
};
static const double gauss[TILTS][2] = {{0.14887433898163121, 0.29552422471475287},
                                       {0.43339539412924719, 0.26926671930999636},
                                       {0.67940956829902441, 0.21908636251598204},
                                       {0.86506336668898451, 0.14945134915058059},
                                       {0.97390652851717172, 0.06667134430868814}};

static const double degree = RC_PI / 180;

/* ---- limits ---- */

enum rc_status
rc_fatigue_check_limits(unsigned wanted, const struct rc_fatigue_limits *l, struct rc_err *err)
{
    const double ratio = l->torsion / l->bending;
    bool limits = false;

    if (wanted >> RC_PLANE_TILT != 0)
        wanted |= 1U << RC_FINDLEY;
    if (wanted == 0 || wanted >> RC_FATIGUES != 0)
        return rc_err_set(err, "the requested criteria are empty or unknown");
    for (int c = 0; c < RC_SHAKEDOWN; c++)
        limits = limits || wanted >> c & 1;
    if (limits &&
        (!(l->bending > 0) || !(l->torsion > 0) || isinf(l->bending) || isinf(l->torsion)))
        return rc_err_set(err,
                          "endurance limits of %g Pa in bending and %g Pa in torsion: both must be "
                          "above 0",
                          l->bending, l->torsion);
    /* the largest normal stress (Rankine) has the ratio 1, all other criteria a smaller one */
    if (limits && ratio > 1)
        return rc_err_set(err,
                          "endurance limits of %g Pa in bending and %g Pa in torsion: no material "
                          "has a larger one in torsion; the ratio is 0.5 to 1",
                          l->bending, l->torsion);
    for (int c = 0; c < RC_SHAKEDOWN; c++)
        if (wanted >> c & 1 && !(ratio > ranges[c].low && ratio < ranges[c].high))
            return rc_err_set(
                err,
                "the limit in torsion over that in bending is %.4g: the criterion of %s needs a "
                "ratio above %.3g%s",
                ratio, ranges[c].name, ranges[c].low,
                isinf(ranges[c].high)  ? ""
                : ranges[c].high < 0.9 ? " and below 0.8"
                                       : " and below 1");
    if (wanted >> RC_SHAKEDOWN & 1 && (!(l->yield > 0) || isinf(l->yield)))
        return rc_err_set(err, "yield stress %g Pa: shakedown needs one above 0", l->yield);
    return RC_OK;
}

struct rc_fatigue_rule
rc_fatigue_rule_of(unsigned wanted, bool full, const struct rc_fatigue_limits *l)
{
    const double three = 3 * l->torsion / l->bending, r = l->bending / l->torsion;
    struct rc_fatigue_rule rule = {.wanted = wanted, .full = full};

    if (wanted >> RC_PLANE_TILT != 0)
        rule.wanted |= 1U << RC_FINDLEY;
    rule.k[RC_CROSSLAND] = rule.k[RC_PAPADOPOULOS] = three - sqrt(3);
    rule.k[RC_DANG_VAN] = three - 1.5;
    rule.k[RC_FINDLEY] = (2 - r) / (2 * sqrt(r - 1));
    for (int c = 0; c < RC_FINDLEY; c++)
        rule.limit[c] = l->torsion;
    rule.limit[RC_FINDLEY] = l->bending / (2 * sqrt(r - 1));
    rule.limit[RC_SHAKEDOWN] = l->yield / sqrt(3);
    return rule;
}

/* ---- a history ---- */

enum {
    LINES = RC_COMPONENTS + RC_BALL_MOST + 4
};

struct rc_history *
rc_history_new(struct rc_store *own, size_t most)
{
    struct rc_history *w = rc_store_zeros(own, 1, sizeof *w);
    const size_t line = (most + 7) / 8 * 8;
    double *at = rc_store_take(own, LINES * line, sizeof *at);

    if (w == NULL || at == NULL)
        return NULL;
    for (size_t c = 0; c < RC_COMPONENTS; c++, at += line)
        w->s[c] = at;
    for (size_t c = 0; c < RC_BALL_MOST; c++, at += line)
        w->x[c] = at;
    w->h = at;
    w->u = at + line;
    w->v = at + 2 * line;
    w->room = at + 3 * line;
    return w;
}

RC_CLONES static void
set_path(struct rc_history *w, double *least, double *largest)
{
    const double *restrict xx = w->s[RC_SXX], *restrict yy = w->s[RC_SYY];
    const double *restrict zz = w->s[RC_SZZ];
    double *restrict x0 = w->x[0], *restrict x1 = w->x[1], *restrict h = w->h;
    double low = INFINITY, high = -INFINITY;

#pragma omp simd reduction(min : low) reduction(max : high)
    for (size_t t = 0; t < w->n; t++) {
        const double mean = (xx[t] + yy[t] + zz[t]) / 3;
        h[t] = mean;
        x0[t] = 0.86602540378443865 * (xx[t] - mean);
        x1[t] = (yy[t] - zz[t]) / 2;
        low = mean < low ? mean : low;
        high = mean > high ? mean : high;
    }
    for (size_t t = 0; t < w->n; t++) {
        w->x[2][t] = w->s[RC_SXY][t];
        w->x[3][t] = w->s[RC_SXZ][t];
        w->x[4][t] = w->s[RC_SYZ][t];
    }
    *least = low;
    *largest = high;
}

/* ---- Dang Van ---- */

/* Half of Tresca's stress of the deviator at an instant, less that at the centre; square: its J2. */
static double
half_tresca(const struct rc_history *w, size_t t, const double *centre, double square)
{
    double x[RC_BALL_MOST], a, b, c, j3, angle;

    if (!(square > 0))
        return 0;
    for (size_t k = 0; k < RC_BALL_MOST; k++)
        x[k] = w->x[k][t] - centre[k];
    a = x[0] * 1.1547005383792515;
    b = x[1] - a / 2;
    c = -x[1] - a / 2;
    j3 = a * (b * c - x[4] * x[4]) - x[2] * (x[2] * c - x[4] * x[3]) +
         x[3] * (x[2] * x[4] - b * x[3]);
    angle = 2.5980762113533160 * j3 / (square * sqrt(square));
    return sqrt(square) * sin(acos(fmax(-1, fmin(1, angle))) / 3 + RC_PI / 3);
}

RC_CLONES static double
bounds(size_t n, const double *restrict square, const double *restrict h, double k,
       double compressed, double *restrict bound)
{
    double most = -INFINITY;

#pragma omp simd reduction(max : most)
    for (size_t t = 0; t < n; t++) {
        const double v = sqrt(square[t]) + (h[t] > 0 ? k : compressed) * h[t];
        bound[t] = v;
        most = v > most ? v : most;
    }
    return most;
}

/* Half of Tresca's stress is at most sqrt J2: only instants whose bound exceeds the largest value so far are
 * computed, that of the largest bound first. */
static double
dang_van(struct rc_history *w, const struct rc_fatigue_rule *rule, const double *centre,
         double *decides)
{
    const double k = rule->k[RC_DANG_VAN], compressed = rule->full ? k : 0;
    const double most = bounds(w->n, w->room, w->h, k, compressed, w->u);
    double largest = -INFINITY;

    for (int first = 1; first >= 0; first--)
        for (size_t t = 0; t < w->n; t++) {
            double v;
            if (first ? w->u[t] < most : w->u[t] <= largest)
                continue;
            v = half_tresca(w, t, centre, w->room[t]) + (w->h[t] > 0 ? k : compressed) * w->h[t];
            if (v > largest) {
                largest = v;
                *decides = w->h[t];
            }
        }
    return largest / rule->limit[RC_DANG_VAN];
}

/* ---- planes ---- */

struct plane {
    double n[3], a[3], b[3]; /* normal, and two directions in the plane */
};

static struct plane
plane_of(double x, double y, double z)
{
    const double r = hypot(x, y), length = hypot(r, z);
    struct plane p = {{x / length, y / length, z / length}, {1, 0, 0}, {0, 1, 0}};

    if (r > 0) {
        const double c = x / r, s = y / r;
        p.a[0] = c * p.n[2];
        p.a[1] = s * p.n[2];
        p.a[2] = -r / length;
        p.b[0] = -s;
        p.b[1] = c;
    }
    return p;
}

/* The stress of directions a and b as weights of the six components. */
static void
weights(const double a[3], const double b[3], double out[RC_COMPONENTS])
{
    out[RC_SXX] = a[0] * b[0];
    out[RC_SYY] = a[1] * b[1];
    out[RC_SZZ] = a[2] * b[2];
    out[RC_SXY] = a[0] * b[1] + a[1] * b[0];
    out[RC_SXZ] = a[0] * b[2] + a[2] * b[0];
    out[RC_SYZ] = a[1] * b[2] + a[2] * b[1];
}

/* The shear stress on a plane, in u and v, and half its ranges; returns the largest normal stress. */
RC_CLONES static double
resolve(struct rc_history *w, const struct plane *p, double half[2])
{
    const double *restrict xx = w->s[0], *restrict yy = w->s[1], *restrict zz = w->s[2];
    const double *restrict xy = w->s[3], *restrict xz = w->s[4], *restrict yz = w->s[5];
    double *restrict u = w->u, *restrict v = w->v, n[6], a[6], b[6], normal = -INFINITY;
    double a0 = INFINITY, a1 = -INFINITY, b0 = INFINITY, b1 = -INFINITY;

    weights(p->n, p->n, n);
    weights(p->n, p->a, a);
    weights(p->n, p->b, b);
#pragma omp simd reduction(max : normal, a1, b1) reduction(min : a0, b0)
    for (size_t t = 0; t < w->n; t++) {
        const double s =
            n[0] * xx[t] + n[1] * yy[t] + n[2] * zz[t] + n[3] * xy[t] + n[4] * xz[t] + n[5] * yz[t];
        const double x =
            a[0] * xx[t] + a[1] * yy[t] + a[2] * zz[t] + a[3] * xy[t] + a[4] * xz[t] + a[5] * yz[t];
        const double y =
            b[0] * xx[t] + b[1] * yy[t] + b[2] * zz[t] + b[3] * xy[t] + b[4] * xz[t] + b[5] * yz[t];
        u[t] = x;
        v[t] = y;
        normal = s > normal ? s : normal;
        a0 = x < a0 ? x : a0;
        a1 = x > a1 ? x : a1;
        b0 = y < b0 ? y : b0;
        b1 = y > b1 ? y : b1;
    }
    half[0] = (a1 - a0) / 2;
    half[1] = (b1 - b0) / 2;
    return normal;
}

/* tau_a + k max s_n on a plane; -INFINITY if it is surely not above `worth`. tau_a is at most R, and at most
 * half the diagonal of the rectangle about the path. */
static double
on_plane(struct rc_history *w, const struct plane *p, double k, double radius, double worth)
{
    double half[2];
    const double normal = resolve(w, p, half);
    const double *const x[] = {w->u, w->v};

    if (fmin(radius, hypot(half[0], half[1])) + k * normal <= worth)
        return -INFINITY;
    return rc_ball_about(2, 2, w->n, x, w->room).radius + k * normal;
}

struct start {
    struct plane plane;
    double value;
};

/* Keeps the plane among the best of different maxima, the best first. */
static void
keep_start(struct start *start, size_t *n, const struct plane *p, double value)
{
    size_t k = 0, to;

    while (k < *n && start[k].value >= value &&
           fabs(p->n[0] * start[k].plane.n[0] + p->n[1] * start[k].plane.n[1] +
                p->n[2] * start[k].plane.n[2]) < same_hill)
        k++;
    if (k == STARTS || (k < *n && start[k].value >= value))
        return;
    to = k;
    for (size_t i = k; i < *n; i++) /* those that the new one replaces */
        if (fabs(p->n[0] * start[i].plane.n[0] + p->n[1] * start[i].plane.n[1] +
                 p->n[2] * start[i].plane.n[2]) < same_hill)
            start[to++] = start[i];
    for (size_t i = to < STARTS ? to : STARTS - 1; i > k; i--)
        start[i] = start[i - 1];
    *n = to < STARTS ? to + 1 : STARTS;
    start[k] = (struct start){*p, value};
}

/* Climbs from a plane, with steps from 5 degrees down. */
static void
refine(struct rc_history *w, double k, double radius, struct start *best)
{
    double step = STEP / 2.0 * degree;

    for (int n = 0; n < REFINEMENTS; n++, step /= 2) {
        const struct plane p = best->plane;
        for (int i = -1; i <= 1; i++)
            for (int j = -1; j <= 1; j++) {
                struct plane q;
                double v;
                if (i == 0 && j == 0)
                    continue;
                q = plane_of(p.n[0] + step * (i * p.a[0] + j * p.b[0]),
                             p.n[1] + step * (i * p.a[1] + j * p.b[1]),
                             p.n[2] + step * (i * p.a[2] + j * p.b[2]));
                v = on_plane(w, &q, k, radius, best->value);
                if (v > best->value)
                    *best = (struct start){q, v};
            }
    }
}

/* The largest sqrt J2. */
static double
largest_shear(const struct rc_history *w)
{
    double most = 0;

    for (size_t t = 0; t < w->n; t++) {
        double square = 0;
        for (size_t k = 0; k < RC_BALL_MOST; k++)
            square += w->x[k][t] * w->x[k][t];
        most = fmax(most, square);
    }
    return sqrt(most);
}

static void
findley(struct rc_history *w, const struct rc_fatigue_rule *rule, double radius, double *values)
{
    const double k = rule->k[RC_FINDLEY], within = near_best * (radius + k * largest_shear(w));
    struct start start[STARTS], best = {.value = -INFINITY};
    const double *n = best.plane.n;
    size_t starts = 0;

    for (int ring = 0; ring < RINGS; ring++) {
        const double tilt = ring * STEP * degree;
        const bool equator = ring == RINGS - 1; /* half of it is different */
        const int around =
            equator ? 180 / STEP : 1 + (int)floor(360.0 / STEP * sin(tilt) + (ring > 0 ? 0.5 : 0));
        for (int i = 0; i < around; i++) {
            const double turn = (equator ? 1 : 2) * RC_PI * i / around;
            const struct plane p =
                plane_of(sin(tilt) * cos(turn), sin(tilt) * sin(turn), cos(tilt));
            const double worth = best.value - within;
            const double v = on_plane(w, &p, k, radius, worth);
            if (v > worth)
                keep_start(start, &starts, &p, v);
            if (v > best.value)
                best = (struct start){p, v};
        }
    }
    for (size_t s = 0; s < starts; s++) {
        if (start[s].value < start[0].value - within)
            continue;
        refine(w, k, radius, &start[s]);
        if (start[s].value > best.value)
            best = start[s];
    }
    values[RC_FINDLEY] = best.value / rule->limit[RC_FINDLEY];
    values[RC_PLANE_TILT] = acos(fmin(1, fabs(n[2]))) / degree;
    values[RC_PLANE_TURN] = (n[2] < 0 ? atan2(-n[1], -n[0]) : atan2(n[1], n[0])) / degree;
}

/* ---- Papadopoulos ---- */

RC_CLONES static double
range_along(size_t n, const double *restrict u, const double *restrict v, double c, double s)
{
    double low = INFINITY, high = -INFINITY;

#pragma omp simd reduction(min : low) reduction(max : high)
    for (size_t t = 0; t < n; t++) {
        const double x = c * u[t] + s * v[t];
        low = x < low ? x : low;
        high = x > high ? x : high;
    }
    return high - low;
}

/* sqrt(5 <T_a^2>) */
static double
mean_amplitude(struct rc_history *w)
{
    double sum = 0;

    for (int i = 0; i < TILTS; i++)
        for (int j = 0; j < TURNS; j++) {
            const double z = gauss[i][0], r = sqrt(1 - z * z), turn = 2 * RC_PI * j / TURNS;
            const struct plane p = plane_of(r * cos(turn), r * sin(turn), z);
            double half[2], ring = 0;
            resolve(w, &p, half);
            for (int d = 0; d < DIRECTIONS; d++) {
                const double along = RC_PI * d / DIRECTIONS;
                const double t = range_along(w->n, w->u, w->v, cos(along), sin(along)) / 2;
                ring += t * t;
            }
            sum += gauss[i][1] * ring / (TURNS * DIRECTIONS);
        }
    return sqrt(5 * sum);
}

/* ---- all criteria ---- */

void
rc_history_values(struct rc_history *w, const struct rc_fatigue_rule *rule,
                  struct rc_fatigue_values *values)
{
    const double *const *x = (const double *const *)w->x;
    double *of = values->of;
    struct rc_ball ball;

    for (int c = 0; c < RC_FATIGUES; c++)
        of[c] = NAN;
    values->decides = NAN;
    set_path(w, &values->least, &values->largest);
    ball = rc_ball_about(RC_BALL_MOST, RC_BALL_MOST, w->n, x, w->room);
    of[RC_AMPLITUDE] = ball.radius;
    of[RC_CROSSLAND] =
        (ball.radius + rule->k[RC_CROSSLAND] * values->largest) / rule->limit[RC_CROSSLAND];
    if (rule->wanted >> RC_DANG_VAN & 1)
        of[RC_DANG_VAN] = dang_van(w, rule, ball.centre, &values->decides);
    if (rule->wanted >> RC_PAPADOPOULOS & 1)
        of[RC_PAPADOPOULOS] = (mean_amplitude(w) + rule->k[RC_PAPADOPOULOS] * values->largest) /
                              rule->limit[RC_PAPADOPOULOS];
    if (rule->wanted >> RC_FINDLEY & 1)
        findley(w, rule, ball.radius, of);
    if (rule->wanted >> RC_SHAKEDOWN & 1)
        of[RC_SHAKEDOWN] =
            rc_ball_about(RC_BALL_MOST, 2, w->n, x, w->room).radius / rule->limit[RC_SHAKEDOWN];
}

enum rc_status
rc_fatigue_history(unsigned wanted, const struct rc_fatigue_limits *limits, bool full, size_t n,
                   const double *const s[RC_COMPONENTS], double values[RC_FATIGUES],
                   struct rc_err *err)
{
    struct rc_fatigue_rule rule;
    struct rc_fatigue_values all;
    RC_ENDS(rc_store_free) struct rc_store own = {0};
    struct rc_history *w;

    if (rc_fatigue_check_limits(wanted, limits, err) != RC_OK)
        return RC_FAIL;
    if (n == 0)
        return rc_err_set(err, "a history of 0 states");
    if ((w = rc_history_new(&own, n)) == NULL)
        return rc_err_set(err, "out of memory for a history of %zu states", n);
    rule = rc_fatigue_rule_of(wanted, full, limits);
    w->n = n;
    for (int c = 0; c < RC_COMPONENTS; c++)
        for (size_t t = 0; t < n; t++)
            w->s[c][t] = s[c][t];
    rc_history_values(w, &rule, &all);
    for (int c = 0; c < RC_FATIGUES; c++)
        values[c] = wanted >> c & 1 ? all.of[c] : NAN;
    return RC_OK;
}
