/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A counter body that is free to tilt: the moment of the pressures about the point of the force is 0. With x
 * the position of a node from that point, a tilt with slopes a raises the counter surface by a x. The contact
 * is that of the heights h - a x. The two slopes are the multipliers of the two conditions p'x = 0, as the
 * shift is that of the load. So G(a) = min over p of 1/2 p'Kp - p'(h - a x) is concave. Its gradient is the
 * moment, and the solution is its maximum.
 *
 * Newton's method maximises G: the contact is solved, its moment is computed, and the body is turned by H^-1
 * times the moment. While no node joins or leaves, the derivative of the moment is minus
 *
 *     H = x'K^-1 x - x'K^-1 1 1'K^-1 x / 1'K^-1 1
 *
 * on the elastic nodes (stiffness.c). A coarser grid hands its slopes and its H to the finer one. Each turn
 * corrects H by the observed change of the moment, and after a turn that changed the moment too little H is
 * recomputed. If a full turn is too long or too short, a line search between bounds finds its length.
 * Contacts on the way are solved only as accurately as the next turn needs.
 *
 * From such a contact to the solution the pressure changes by at most sqrt(S m'H^-1 m), S = 1'K^-1 1, in the
 * L1 norm. This is exact for independent springs, by Schwarz's inequality.
 *
 * Without a coarser grid the start is the facet on which a rigid body would rest, which also defines zero
 * approach. It is the plane above all heights that is lowest at the point of the force. This is a linear
 * program of three unknowns. The dual simplex method solves it by moving from one triangle around that point
 * to the next.
 *
 * Arms are in units of the length of the map, so that slopes become rises in metres.
 */
#include "solver.h"

#include <math.h>

#include "libcontact/memory.h"

enum {
    /* Limit of the simplex method: more steps do not pay for a start, because only little is left above
     * the facet. Not sensitive: half and double change no bit of 123 contacts (bench/constants.py). */
    PIVOTS = 200,
    /* Most turns of a search. Not sensitive: half and double change no bit of 123 contacts
     * (bench/constants.py). */
    TURNS = 200,
    /* Trials of the line search, after which the interval is halved. Half takes 1 % more convolutions,
     * double 3 % (tilted contacts of bench/constants.py). */
    EVEN = 6,
    /* Number of trials, each four times as long as the last. After them the upper bounds cannot
     * carry such a load there: the moment about some axis keeps its sign at any tilt. With half one
     * of 17 tilted contacts is given up though it has a solution; double changes no bit
     * (bench/constants.py). */
    FAR = 12
};
/* Tolerance of the first contacts. Not sensitive: half and double change the convolutions of 17 tilted
 * contacts by at most 2 % together (bench/constants.py). */
static const double loose = 1e-2;
/* Fraction of the tolerance; needed if few nodes determine the moment. Not sensitive: half and double
 * change the convolutions of 17 tilted contacts by less than 1 % (bench/constants.py). */
static const double finest = 1e-3;
/* A new H that changes the error by more than this factor is recomputed. Not sensitive: half and double
 * change no bit of 17 tilted contacts (bench/constants.py). */
static const double far_softer = 3;
/* Share of S; a smaller H is only rounding in single precision (6e-8). Half changes no bit of 17 tilted
 * contacts, double takes 2 % fewer convolutions (bench/constants.py). */
static const double thin = 1e-7;

/* A turn: its base, direction, length, and the lengths between which the moment about its axis vanishes. */
struct search {
    bool on;
    double base[2], way[2], at_base[2], error_at_base, far;
    double low, high, moment_low, moment_high;
    size_t trials;
};

struct rc_tilt {
    double at[2]; /* m: the point of the force, from the middle of the map                        */
    double length;  /* m: unit of arms */
    bool turns[2];  /* a profile turns about one axis only */
    double rise[2]; /* m, over the length of the map: posed.h = heights - rise arm */
    /* m: height of a rigid body above the point of the force at first touch; NAN: unknown */
    double touch;
    bool placed; /* the rise comes from a contact */
    bool begun;  /* the search at this load */
    double goal; /* final tolerance of this search */
    size_t
        turned; /* times                                                                        */
    double moment[2]; /* moment of p, divided by its sum */
    double error;     /* error of the pressure from that moment */
    bool known;       /* H and S are known */
    double h[2][2], s;
    struct search search;
    float *room; /* for the computation of H */
};

/* The arm of a node of the whole map. */
static double
arm_of(const struct rc_solver *s, size_t axis, size_t node)
{
    const struct rc_tilt *t = s->tilt;
    const struct rc_shape *w = &s->posed.whole;
    size_t i = axis == 0 ? node % w->nx : node / w->nx;
    double n = (double)(axis == 0 ? w->nx : w->ny), step = axis == 0 ? w->dx : w->dy;

    return (((double)i - (n - 1) / 2) * step - t->at[axis]) / t->length;
}

double
rc_arm(const struct rc_solver *s, size_t axis, size_t k)
{
    return arm_of(s, axis, s->posed.rows.first * s->posed.whole.nx + k);
}

/* ---- new ---- */

static enum rc_status
check(const struct rc_shape *shape, const struct rc_problem *problem, struct rc_err *err)
{
    const double half[2] = {(double)(shape->nx - 1) / 2 * shape->dx,
                            (double)(shape->ny - 1) / 2 * shape->dy};

    if (rc_repeats(problem->boundary) > 0)
        return rc_err_set(err, "a periodic surface cannot tilt, because it has no centre");
    for (size_t a = 0; a < 2; a++)
        if (!(fabs(problem->force_at[a]) < half[a]) && problem->force_at[a] != 0)
            return rc_err_set(err,
                              "the force acts at %.9g m, %.9g m from the middle: it must act on "
                              "the map, which ends %.9g m, %.9g m from the middle",
                              problem->force_at[0], problem->force_at[1], half[0], half[1]);
    return RC_OK;
}

enum rc_status
rc_tilt_new(struct rc_solver *s, const struct rc_problem *problem, struct rc_err *err)
{
    const struct rc_shape *w = &s->posed.whole;
    struct rc_tilt *t;

    if (!problem->tilt_free)
        return RC_OK;
    if (check(w, problem, err) != RC_OK)
        return RC_FAIL;
    s->tilt = t = rc_store_zeros(&s->own, 1, sizeof *t);
    if (t != NULL)
        t->room = rc_store_take(&s->own, s->posed.n, 3 * sizeof *t->room);
    if (rc_ranks_need(s->posed.rows.ranks, !s->own.failed, err,
                      "out of memory for the tilt of %zu x %zu nodes", w->nx, w->ny) != RC_OK)
        return RC_FAIL;
    t->at[0] = problem->force_at[0];
    t->at[1] = problem->force_at[1];
    t->turns[0] = w->nx > 1;
    t->turns[1] = w->ny > 1;
    t->length = fmax((double)w->nx * w->dx, (double)w->ny * w->dy);
    t->touch = NAN;
    return RC_OK;
}

/* ---- turning ---- */

struct turn {
    struct rc_solver *s;
    const double *by;
};

static double
risen(const struct rc_solver *s, const double by[2], size_t k)
{
    return by[0] * rc_arm(s, 0, k) + by[1] * rc_arm(s, 1, k);
}

static void
turn_block(void *at, size_t first, size_t n, double *sums)
{
    const struct turn *c = at;

    (void)sums;
    for (size_t k = first; k < first + n; k++) {
        double up = risen(c->s, c->by, k);
        c->s->posed.h[k] -= up;
        c->s->it.v[k] += up;
    }
}

static void
turn_by(struct rc_solver *s, const double by[2])
{
    struct turn c = {s, by};
    double total[RC_SUMS];
    bool known = s->it.known;

    rc_reduce_blocks(s, turn_block, &c, total);
    s->tilt->rise[0] += by[0];
    s->tilt->rise[1] += by[1];
    rc_solver_restart(s);
    s->it.rested = false;
    if (!known)
        return;
    s->it.known = true;
    rc_iterate_shift(s);
    rc_working_set_find(s, true);
}

double
rc_tilt_rise(const struct rc_solver *s, size_t k)
{
    return s->tilt == NULL ? 0 : risen(s, s->tilt->rise, k);
}

void
rc_tilt_heights(struct rc_solver *s)
{
    struct rc_tilt *t = s->tilt;
    double rise[2];

    if (t == NULL)
        return;
    for (size_t a = 0; a < 2; a++) {
        rise[a] = t->rise[a];
        t->rise[a] = 0;
    }
    turn_by(s, rise);
    t->touch = NAN;
    t->begun = false;
}

void
rc_tilt_load(struct rc_solver *s)
{
    if (s->tilt != NULL)
        s->tilt->begun = false;
}

/* ---- the facet: start and zero of the approach ---- */

/* Nodes that support a plane, with their shares of the force. */
struct facet {
    size_t n; /* number of nodes, and of the unknowns: height at the point of the force, rises */
    size_t node[3];
    double h[3], share[3], plane[3];
};

/* Solves a x = b by elimination with pivots; b becomes x. False: no solution. */
static bool
solve_few(size_t n, double (*a)[3], double *b)
{
    for (size_t c = 0; c < n; c++) {
        size_t best = c;
        for (size_t r = c + 1; r < n; r++)
            best = fabs(a[r][c]) > fabs(a[best][c]) ? r : best;
        if (a[best][c] == 0)
            return false;
        for (size_t q = 0; q < n; q++) {
            double x = a[c][q];
            a[c][q] = a[best][q];
            a[best][q] = x;
        }
        double y = b[c];
        b[c] = b[best];
        b[best] = y;
        for (size_t r = 0; r < n; r++) {
            double f = r == c ? 0 : a[r][c] / a[c][c];
            for (size_t q = 0; q < n && r != c; q++)
                a[r][q] -= f * a[c][q];
            b[r] -= f * b[c];
        }
    }
    for (size_t c = 0; c < n; c++)
        b[c] /= a[c][c];
    return true;
}

/* 1 and the arms of the axes that turn, for a node of the whole map. */
static void
arms(const struct rc_solver *s, size_t node, double *row)
{
    size_t n = 0;

    row[n++] = 1;
    for (size_t a = 0; a < 2; a++)
        if (s->tilt->turns[a])
            row[n++] = arm_of(s, a, node);
}

static double
height_of(const struct rc_solver *s, size_t node)
{
    size_t first = s->posed.rows.first * s->posed.whole.nx;
    bool here = node >= first && node - first < s->posed.n;

    return rc_ranks_most(s->posed.rows.ranks, here ? s->posed.h[node - first] : -INFINITY);
}

/* Shares of a unit force at this place among the nodes of a facet, by equilibrium. */
static bool
shares(const struct rc_solver *s, const struct facet *f, const double *place, double *share)
{
    double a[3][3], row[3];

    for (size_t c = 0; c < f->n; c++) {
        arms(s, f->node[c], row);
        for (size_t r = 0; r < f->n; r++)
            a[r][c] = row[r];
    }
    for (size_t r = 0; r < f->n; r++)
        share[r] = place[r];
    return solve_few(f->n, a, share);
}

static bool
plane_of(const struct rc_solver *s, struct facet *f)
{
    double a[3][3];

    for (size_t r = 0; r < f->n; r++) {
        arms(s, f->node[r], a[r]);
        f->plane[r] = f->h[r];
    }
    return solve_few(f->n, a, f->plane);
}

/* Starts with corners of the map around the point of the force. */
static void
begin_facet(const struct rc_solver *s, struct facet *f)
{
    const struct rc_tilt *t = s->tilt;
    const struct rc_shape *w = &s->posed.whole;
    size_t x = w->nx - 1, y = (w->ny - 1) * w->nx;
    double along = t->turns[0] ? t->at[0] / ((double)x * w->dx) : 0;
    double across = t->turns[1] ? t->at[1] / ((double)(w->ny - 1) * w->dy) : 0;

    *f = (struct facet){.n = 1};
    if (t->turns[0] && t->turns[1]) {
        *f = (struct facet){.n = 3, .node = {along + across <= 0 ? 0 : x + y, x, y}};
    } else if (t->turns[0] || t->turns[1]) {
        *f = (struct facet){.n = 2, .node = {0, x + y}};
    }
    for (size_t r = 0; r < f->n; r++)
        f->h[r] = height_of(s, f->node[r]);
}

struct above {
    const struct rc_solver *s;
    double height, rise[2], most;
};

static double
above_plane(const struct above *c, size_t k)
{
    return c->s->posed.h[k] - c->height - risen(c->s, c->rise, k);
}

static void
above_block(void *at, size_t first, size_t n, double *sums)
{
    for (size_t k = first; k < first + n; k++)
        sums[RC_MOST] = fmax(sums[RC_MOST], above_plane(at, k));
}

/* The first node with this height, counted from the last one. */
static void
which_block(void *at, size_t first, size_t n, double *sums)
{
    const struct above *c = at;
    size_t before = c->s->posed.rows.first * c->s->posed.whole.nx;

    for (size_t k = first; k < first + n; k++)
        if (above_plane(c, k) >= c->most)
            sums[RC_MOST] = fmax(sums[RC_MOST], (double)(c->s->posed.nodes - before - k));
}

static struct above
above_facet(const struct rc_solver *s, const struct facet *f)
{
    struct above c = {.s = s, .height = f->plane[0]};
    size_t n = 1;

    for (size_t a = 0; a < 2; a++)
        c.rise[a] = s->tilt->turns[a] ? f->plane[n++] : 0;
    return c;
}

/* Replaces the node of the facet whose share would first become negative by this node. */
static bool
exchange(const struct rc_solver *s, struct facet *f, size_t node)
{
    double share[3], place[3], most = INFINITY;
    size_t leaves = f->n;

    arms(s, node, place);
    if (!shares(s, f, place, share))
        return false;
    for (size_t r = 0; r < f->n; r++)
        if (share[r] > 1e-12 && f->share[r] / share[r] < most) {
            most = f->share[r] / share[r];
            leaves = r;
        }
    if (leaves == f->n)
        return false;
    f->node[leaves] = node;
    f->h[leaves] = height_of(s, node);
    return true;
}

static struct above
stand(const struct rc_solver *s)
{
    static const double here[3] = {1, 0, 0};
    struct above c = {.s = s};
    struct facet f;
    double total[RC_SUMS];

    begin_facet(s, &f);
    for (size_t pivot = 0; pivot < PIVOTS; pivot++) {
        if (!shares(s, &f, here, f.share) || !plane_of(s, &f))
            break;
        c = above_facet(s, &f);
        rc_reduce_blocks(s, above_block, &c, total);
        if (total[RC_MOST] <= 1e-13 * (fabs(c.height) + fabs(c.rise[0]) + fabs(c.rise[1])))
            break;
        c.most = total[RC_MOST] * (1 - 1e-12);
        rc_reduce_blocks(s, which_block, &c, total);
        if (!exchange(s, &f, s->posed.nodes - (size_t)total[RC_MOST]))
            break;
    }
    return c;
}

double
rc_tilt_approach(const struct rc_solver *s)
{
    return s->it.shift + s->op->rise * s->load.sum +
           (s->tilt == NULL || isnan(s->tilt->touch) ? 0 : s->tilt->touch);
}

/* ---- the moment and its derivative ---- */

static void
moment_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_solver *s = at;

    for (size_t k = first; k < first + n; k++) {
        double p = s->it.p[k];
        if (p == 0)
            continue;
        sums[0] += p;
        sums[1] += p * rc_arm(s, 0, k);
        sums[2] += p * rc_arm(s, 1, k);
    }
}

/* Computes eigenvalues of the symmetric matrix a b, b d, the smaller first. Also computes the eigenvector of
 * the smaller, and the other one at a right angle to it. */
static void
eigenvalues(double a, double b, double d, double value[2], double vector[2][2])
{
    double mean = (a + d) / 2, half = hypot((a - d) / 2, b), size;

    value[1] = mean + half;
    value[0] = value[1] > 0 ? (a * d - b * b) / value[1] : 0;
    if (a >= d) { /* use the row with the larger entry */
        vector[1][0] = (a - d) / 2 + half;
        vector[1][1] = b;
    } else {
        vector[1][0] = b;
        vector[1][1] = (d - a) / 2 + half;
    }
    size = hypot(vector[1][0], vector[1][1]);
    vector[1][0] = size > 0 ? vector[1][0] / size : 1;
    vector[1][1] = size > 0 ? vector[1][1] / size : 0;
    vector[0][0] = -vector[1][1];
    vector[0][1] = vector[1][0];
}

/* Eigenvalues of H over S. If H is unknown: the eigenvalues for a contact as wide as the map. */
static void
stiffnesses(const struct rc_tilt *t, double value[2], double vector[2][2])
{
    bool both = t->known && t->turns[0] && t->turns[1];

    eigenvalues(t->known && t->turns[0] ? t->h[0][0] / t->s : 1, both ? t->h[0][1] / t->s : 0,
                t->known && t->turns[1] ? t->h[1][1] / t->s : 1, value, vector);
}

/* Error of the pressure due to the moment. */
static double
error_of(const struct rc_tilt *t, const double value[2], double vector[2][2])
{
    double square = 0;

    for (size_t e = 0; e < 2; e++) {
        double m = t->moment[0] * vector[e][0] + t->moment[1] * vector[e][1];
        square += m * m / fmax(value[e], thin);
    }
    return sqrt(square);
}

static void
measure(struct rc_solver *s)
{
    struct rc_tilt *t = s->tilt;
    double total[RC_SUMS], value[2], vector[2][2];

    rc_reduce_blocks(s, moment_block, s, total);
    for (size_t a = 0; a < 2; a++)
        t->moment[a] = t->turns[a] ? total[1 + a] / total[0] : 0;
    stiffnesses(t, value, vector);
    t->error = error_of(t, value, vector);
}

double
rc_tilt_error(struct rc_solver *s, double contact)
{
    if (s->tilt == NULL)
        return contact;
    measure(s);
    return 2 * (contact + s->tilt->error);
}

double
rc_tilt_slope(const struct rc_solver *s, size_t axis)
{
    return s->tilt == NULL ? 0 : s->tilt->rise[axis] / s->tilt->length;
}

double
rc_tilt_goal(const struct rc_solver *s)
{
    return s->tilt != NULL && s->tilt->begun ? s->tilt->goal : s->load.tol;
}

/* ---- the search for the tilt ---- */

/* Moments of the arms of the elastic nodes. */
static void
arms_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_solver *s = at;

    for (size_t k = first; k < first + n; k++) {
        double x, y;
        if (!rc_elastic(s, k))
            continue;
        x = rc_arm(s, 0, k);
        y = rc_arm(s, 1, k);
        sums[0]++;
        sums[1] += x;
        sums[2] += y;
        sums[3] += x * x;
        sums[4] += x * y;
        sums[5] += y * y;
    }
}

/* Second moments of these arms about their means; returns the number of nodes. */
static double
spread(struct rc_solver *s, double *xx, double *xy, double *yy)
{
    const struct rc_tilt *t = s->tilt;
    double sum[RC_SUMS];

    rc_reduce_blocks(s, arms_block, s, sum);
    *xx = t->turns[0] ? sum[3] - sum[1] * sum[1] / sum[0] : 1;
    *yy = t->turns[1] ? sum[5] - sum[2] * sum[2] / sum[0] : 1;
    *xy = t->turns[0] && t->turns[1] ? sum[4] - sum[1] * sum[2] / sum[0] : 0;
    return sum[0];
}

/* Context of the search for the node that joins first when nothing resists the turn. */
struct first_touch {
    const struct rc_solver *s;
    const double *way;
    double centre; /* arm of the pressure along the direction */
};

static void
touch_block(void *at, size_t first, size_t n, double *sums)
{
    const struct first_touch *c = at;
    const struct rc_solver *s = c->s;
    const struct rc_box box = rc_box(s, 0);

    for (size_t k = first; k < first + n; k++) {
        double p = s->it.p[k], g = s->it.v[k] - s->it.shift;
        double up = risen(s, c->way, k) - c->centre; /* rate of the gap */
        bool closes = rc_at_low(box, k, p) && up < 0 && g > 0;
        bool opens = rc_at_high(box, k, p) && up > 0 && g < 0;
        if (closes || opens)
            sums[RC_MOST] = fmax(sums[RC_MOST], -up / g);
    }
}

/* The turn in this direction until a further node joins the contact, and a little more. */
static double
until_touch(struct rc_solver *s, const double way[2], double centre)
{
    struct first_touch c = {s, way, centre};
    double total[RC_SUMS], more = s->op->diagonal * s->load.sum / 4;

    rc_iterate_shift(s);
    rc_reduce_blocks(s, touch_block, &c, total);
    return total[RC_MOST] > 0 ? 1 / total[RC_MOST] + more : more;
}

/* Chooses Newton's step; if no node resists the turn, the turn to the first touch. */
static void
choose_way(struct rc_solver *s)
{
    struct rc_tilt *t = s->tilt;
    double value[2], vector[2][2];

    t->search.way[0] = t->search.way[1] = 0;
    stiffnesses(t, value, vector);
    for (size_t e = 0; e < 2; e++) {
        double m = t->moment[0] * vector[e][0] + t->moment[1] * vector[e][1], by;
        if (t->known && value[e] > thin) {
            by = m * s->load.sum / (value[e] * t->s);
        } else {
            double way[2] = {copysign(vector[e][0], m * vector[e][0]),
                             copysign(vector[e][1], m * vector[e][1])};
            if (fabs(m) < 1e-13)
                continue;
            by = copysign(until_touch(s, way, fabs(m)), m);
        }
        for (size_t a = 0; a < 2; a++)
            t->search.way[a] += t->turns[a] ? by * vector[e][a] : 0;
    }
}

/* H and S of the elastic nodes; unknown where no node is elastic. */
static void
find_stiffness(struct rc_solver *s)
{
    struct rc_tilt *t = s->tilt;
    double k[3][3];

    t->known = rc_stiffness_turning(s, t->room, k) && k[0][0] > 0;
    if (!t->known)
        return;
    t->s = k[0][0];
    for (size_t a = 0; a < 2; a++)
        for (size_t b = 0; b < 2; b++)
            t->h[a][b] = k[1 + a][1 + b] - k[0][1 + a] * k[0][1 + b] / k[0][0];
}

/* Corrects H by the observed change of the moment from its base (Broyden, Fletcher, Goldfarb, Shanno). */
static void
learn(struct rc_solver *s)
{
    struct rc_tilt *t = s->tilt;
    double d[2], y[2], hd[2], dy = 0, dhd = 0;

    for (size_t a = 0; a < 2; a++) {
        d[a] = t->rise[a] - t->search.base[a];
        y[a] = (t->search.at_base[a] - t->moment[a]) * s->load.sum;
    }
    for (size_t a = 0; a < 2; a++) {
        hd[a] = t->h[a][0] * d[0] + t->h[a][1] * d[1];
        dy += d[a] * y[a];
        dhd += d[a] * hd[a];
    }
    if (!t->known || !(dy > 1e-2 * dhd) || !(dhd > 0))
        return;
    for (size_t a = 0; a < 2; a++)
        for (size_t b = 0; b < 2; b++)
            t->h[a][b] += y[a] * y[b] / dy - hd[a] * hd[b] / dhd;
}

static double
about_way(const struct search *search, const double moment[2])
{
    return moment[0] * search->way[0] + moment[1] * search->way[1];
}

/* Updates the bracket and chooses another length in it, or a larger one where it has no upper end yet. */
static double
next_length(struct search *s, const double moment[2])
{
    double m = about_way(s, moment), share;

    if (m > 0) {
        s->low = s->far;
        s->moment_low = m;
    } else {
        s->high = s->far;
        s->moment_high = m;
    }
    s->trials++;
    if (isinf(s->high))
        return 4 * s->far;
    share = s->trials > EVEN ? 0.5 : s->moment_low / (s->moment_low - s->moment_high);
    /* Not sensitive: half and double of 0.1 change the convolutions by at most 2 % (bench/constants.py). */
    return s->low + fmin(fmax(share, 0.1), 0.9) * (s->high - s->low);
}

static void
turn_to(struct rc_solver *s, double far)
{
    struct rc_tilt *t = s->tilt;
    double by[2];

    t->search.far = far;
    for (size_t a = 0; a < 2; a++)
        by[a] = t->search.base[a] + far * t->search.way[a] - t->rise[a];
    turn_by(s, by);
    t->turned++;
}

static void
begin_turn(struct rc_solver *s)
{
    struct rc_tilt *t = s->tilt;

    if (!t->known)
        find_stiffness(s);
    choose_way(s);
    for (size_t a = 0; a < 2; a++) {
        t->search.base[a] = t->rise[a];
        t->search.at_base[a] = t->moment[a];
    }
    t->search.error_at_base = t->error;
    t->search.low = 0;
    t->search.moment_low = about_way(&t->search, t->moment);
    t->search.high = INFINITY;
    t->search.trials = 0;
    t->search.on = true;
}

void
rc_tilt_begin(struct rc_solver *s)
{
    struct rc_tilt *t = s->tilt;

    if (t == NULL || t->begun)
        return;
    if (isnan(t->touch)) {
        struct above c = stand(s);
        t->touch = c.height;
        if (!t->placed)
            turn_by(s, c.rise);
    }
    t->placed = t->begun = true;
    t->search.on = false;
    t->turned = 0;
    t->goal = s->load.tol;
    s->load.tol = fmax(loose, t->goal / 4);
}

enum rc_status
rc_tilt_end(struct rc_solver *s, enum rc_status status)
{
    if (s->tilt != NULL && s->tilt->begun && status != RC_MORE) {
        s->load.tol = s->tilt->goal;
        s->tilt->begun = false;
    }
    return status;
}

/* True if H must be recomputed before the search ends. Either it is unknown, or it belongs to another contact
 * and is much stiffer than springs under the elastic nodes. The error would then be underestimated. Nodes at
 * edges are stiffer than others, so a true H exceeds that of springs, but not by much. */
static bool
doubtful(struct rc_solver *s, double least)
{
    struct rc_tilt *t = s->tilt;
    double xx, xy, yy, value[2], vector[2][2], n = spread(s, &xx, &xy, &yy), error;

    if (!(n > 0))
        return false;
    eigenvalues(t->turns[0] ? xx / n : 1, xy / n, t->turns[1] ? yy / n : 1, value, vector);
    error = error_of(t, value, vector);
    return error > least && (!t->known || error > far_softer * t->error);
}

enum rc_status
rc_tilt_search(struct rc_solver *s)
{
    struct rc_tilt *t = s->tilt;
    double least = t->goal / 4, was = t->search.error_at_base, sure;

    measure(s);
    /* The error of a contact that still gives the sign of the next turn. Not sensitive: half and double
     * change the convolutions of 17 tilted contacts by at most 1 % together (bench/constants.py). */
    sure = 0.3 * (t->error < 1 ? t->error : hypot(t->moment[0], t->moment[1]));
    if (s->it.error > sure && s->load.tol > (t->error > least ? finest * least : least)) {
        s->load.tol = fmax(t->error > least ? finest * least : least, fmin(sure, s->load.tol) / 3);
        return RC_MORE;
    }
    if (t->error <= least && s->load.tol <= least) {
        if (!doubtful(s, least))
            return RC_OK;
        find_stiffness(s);
        measure(s);
        if (t->error <= least)
            return RC_OK;
        t->search.on = false;
    }
    if (t->turned >= TURNS)
        return RC_SHORT;
    if (t->search.on) {
        /* A turn is good enough if it takes away most of the moment or half of the error. Double of 0.5
         * takes 38 % more convolutions of 49 hard contacts; half of it, and half and double of 0.3, change
         * those of 123 contacts by at most 4 % (bench/constants.py). */
        if (fabs(about_way(&t->search, t->moment)) >
                0.3 * about_way(&t->search, t->search.at_base) &&
            t->error > 0.5 * was) {
            if (isinf(t->search.high) && t->search.trials >= FAR)
                return RC_SHORT;
            double far = next_length(&t->search, t->moment);
            if (far > t->search.low * (1 + 1e-12)) {
                /* short turns change the moment by less than the error of a loosely solved contact */
                s->load.tol = fmax(finest * least, s->load.tol / 2);
                turn_to(s, far);
                return RC_MORE;
            }
        }
        learn(s);
        t->known = t->known && t->search.trials == 0 && t->error <= 0.3 * was;
    }
    begin_turn(s);
    if (t->search.way[0] == 0 && t->search.way[1] == 0)
        return RC_SHORT;
    /* Not sensitive: half and double of 0.1 change the convolutions by less than 1 % (bench/constants.py). */
    s->load.tol = fmin(loose, fmax(least, 0.1 * t->error));
    turn_to(s, 1);
    return RC_MORE;
}

/* ---- other starts ---- */

void
rc_tilt_from_coarse(struct rc_solver *s, const struct rc_solver *coarse)
{
    struct rc_tilt *t = s->tilt, *c = coarse->tilt;
    double per = t == NULL ? 1 : t->length / c->length, by[2];

    if (t == NULL || !c->placed)
        return;
    for (size_t a = 0; a < 2; a++)
        by[a] = c->rise[a] * per;
    turn_by(s, by);
    t->placed = true;
    t->known = c->known;
    t->s = c->s * coarse->posed.cell / s->posed.cell;
    for (size_t a = 0; a < 2; a++)
        for (size_t b = 0; b < 2; b++)
            t->h[a][b] = c->h[a][b] * coarse->posed.cell / s->posed.cell / (per * per);
}

/* Gaps of the elastic nodes, 0 on average, times their arms. */
static void
gaps_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_solver *s = at;

    for (size_t k = first; k < first + n; k++) {
        double g = rc_elastic(s, k) ? s->it.v[k] - s->it.shift : 0;
        if (g == 0)
            continue;
        sums[0] += g * rc_arm(s, 0, k);
        sums[1] += g * rc_arm(s, 1, k);
    }
}

void
rc_tilt_from_pressure(struct rc_solver *s)
{
    struct rc_tilt *t = s->tilt;
    double gap[RC_SUMS], a[3][3], by[3] = {0, 0, 0};

    if (t == NULL)
        return;
    rc_iterate_displace(s);
    rc_iterate_shift(s);
    (void)spread(s, &a[0][0], &a[0][1], &a[1][1]);
    a[1][0] = a[0][1];
    rc_reduce_blocks(s, gaps_block, s, gap);
    by[0] = t->turns[0] ? -gap[0] : 0;
    by[1] = t->turns[1] ? -gap[1] : 0;
    if (!(s->it.elastic > 0) ||
        !(a[0][0] * a[1][1] - a[0][1] * a[0][1] > 1e-9 * a[0][0] * a[1][1]) || !solve_few(2, a, by))
        return;
    turn_by(s, by);
    t->placed = true;
}

void
rc_tilt_pose(const struct rc_solver *s, struct rc_problem *coarse)
{
    const struct rc_shape *w = &s->posed.whole;

    coarse->tilt_free = s->tilt != NULL;
    if (s->tilt == NULL)
        return;
    /* on an odd map the last coarse line covers one fine line and one beyond the map */
    coarse->force_at[0] = s->tilt->at[0] - (w->nx > 1 && w->nx % 2 == 1 ? w->dx / 2 : 0);
    coarse->force_at[1] = s->tilt->at[1] - (w->ny > 1 && w->ny % 2 == 1 ? w->dy / 2 : 0);
}
