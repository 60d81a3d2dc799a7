/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A contact with a body that yields in its volume: plastic strain e below the surface, coupled to the
 * pressure.
 *
 * A load is reached in increments. In each of them the increment x of e is a fixed point,
 *
 *     x = F(x):  p is the contact of the heights h - u_r(e + x), s is the stress deviator under p and e + x,
 *                F returns the trial stress s + 2 mu x to the yield surface at fixed total strain.
 *
 * F lowers the energy of body and contact together for any load and hardening, and therefore converges
 * without relaxation. It is a proximal gradient step of a convex problem, whose smooth part has no curvature
 * above 2 mu. An application of F costs one sweep up, one contact, and one sweep down.
 *
 * A load begins with elastic trials, which change no strain: the contact at its end, and one sweep down. If
 * no stress exceeds the yield stress, the load is done, as in most unloading. If little flow would follow, as
 * in reloading to the same peak, one increment follows. All of its flow counts as an error of the increments.
 * If this error is small beside the error of earlier loads, the increment stays; otherwise it is undone. Then
 * bisection finds the last load without flow, and the increments start there. If the caller asks for one
 * increment, nothing is bisected, and a trial that flows is the first application of this increment.
 *
 * The increments are not converged one by one. Each starts from the last increment, is applied twice, and
 * takes the mixture of both that Anderson's method with one kept step would take. The next increment sees the
 * true stress and so corrects the lag of this one. If the lag is above 0.04 of the yield stress, the
 * increment is applied again, because a lag changes the path. No estimate contains this change. The last
 * increment is applied until it lags no more. A load is accepted if |F(x) - x| as a stress is small against
 * the yield stress, not if it is small against x. In time the return is of second order (two steps back,
 * BDF2), with the base
 *
 *     e_b = e + beta last,  beta = w^2/(1 + 2 w) = 1/3 for equal steps,
 *
 * where `last` is the previous increment. beta is 0 if the voxel does not flow from e. If it flows from e but
 * not from e_b, beta is the largest value with flow; otherwise an unloading voxel would continue to flow. The
 * first increment of a load has beta 0 everywhere (backward Euler), because the load has turned.
 *
 * On a contact that travels, each position is one more increment of the same load, on other heights. There
 * the estimated error of the increments is the largest of all positions so far: behind the contact the
 * errors of the strain become even along the way, and an even strain changes no pressure, but the errors
 * remain.
 *
 * On a free map the contact is exactly that of the half-space. The stresses, and the displacement of the
 * surface by plastic strain, belong to a map that repeats after twice its sides. They differ from those of
 * the half-space by some thousandths of the yield stress. So do those on a map that repeats along one axis.
 *
 * The estimated error of a load has five parts. Increments: the terms that BDF2 adds to Euler's return are
 * summed over all loads, because the error of a strain stays in later loads. The contact is found once more
 * with this sum added to e, and with the part of earlier loads alone. Of the change of the pressure a part
 * counts, see of_terms. Slabs: compare_slabs. These two are independent: their squares are added.
 * Iteration: the change of the pressure by the last step, divided by the least resistance of all steps.
 * Contacts: plastic flow keeps about 0.03 of the tolerance of each contact (measured: 0.004 to 0.034), so
 * that many increments need a smaller tolerance. Images: image_error.
 */
#include "yield.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

enum {
    /* Of a load, if the caller chooses none. The model always does. */
    INCREMENTS = 16,
    /* With fewer increments their error is unknown: the terms of second order do not tell it. Half
     * changes no bit, double takes 1.8 times the applications (23 lists of loads of
     * bench/constants.py). */
    FEW = 8,
    /* Fewest applications of an increment. With 1 the mixture of two is lost: 0.8 times the
     * applications, errors up to 5 times as large, and two estimates below the error. With 4 the
     * applications are 1.4 times as many (23 lists of loads of bench/constants.py). */
    EACH = 2,
    /* Most applications of an increment. Half and double change no bit (23 lists of loads of
     * bench/constants.py). */
    MOST_EACH = 24,
    /* Fewest applications of the last increment. Half takes 6 % fewer applications, with errors up to 3
     * times as large; double takes 16 % more (23 lists of loads of bench/constants.py). */
    LAST = 4,
    /* Most applications of the last increment. Half and double change no bit (23 lists of loads of
     * bench/constants.py). */
    MOST = 200,
    /* Bisections for the last elastic load. Half takes 2 % fewer applications, with errors up to 1.7
     * times as large; double takes 3 % more (23 lists of loads of bench/constants.py). */
    BISECTIONS = 4,
    /* After so many, a load that is still 0 is accepted as 0. Half takes 3 % fewer applications,
     * with errors up to 2.5 times as large; double takes 4 % more (23 lists of loads of
     * bench/constants.py). */
    BISECT_FIRST = 2,
    /* Of the interval of beta, to 1e-12. Half and double change no number of applications (23 lists of
     * loads of bench/constants.py). */
    HALVINGS = 40,
    /* Fewest slabs that yield for which their error is known, see of_pairs. */
    RESOLVED = 6
};
/* Largest lag of an accepted load, over the yield stress, where the caller gives none. */
static const double settled = 0.02;
/* And its largest error of the pressure from the iteration. Half takes 3 % more applications; double
 * 4 % more (23 lists of loads of bench/constants.py). */
static const double moves = 1.5e-3;
/* Largest lag of an increment within a load. Half takes 9 % more applications. Double takes 2 % fewer,
 * with errors up to twice as large (23 lists of loads of bench/constants.py). */
static const double lags = 0.04;
/* Flow in the first trial that needs only one increment. Half and double change no bit (23 lists of
 * loads of bench/constants.py). */
static const double trace = 0.01;
/* Flow for which one increment is tried in a body that has already yielded. Half takes 5 % fewer
 * applications with the same errors, double changes no bit (23 lists of loads of
 * bench/constants.py). */
static const double little = 0.2;
/* This increment stays if its error is at most this part of the inherited error, or `once_least`. */
static const double once_part = 0.5;
/* Such an error is small in any load. Half and double change no bit (23 lists of loads of
 * bench/constants.py). */
static const double once_least = 5e-4;
/* Error of the positions of a contact that travels over that of their terms of second order: 1.48 was
 * the most for steps of an eighth to a half of the half width of the contact. Nothing else depends on
 * it. */
static const double of_steps = 1.5;
/* Part of a contact's tolerance that flow keeps: 0.004 to 0.034 were measured. Half and double change
 * the estimate by at most 1 and 11 % (23 lists of loads of bench/constants.py). */
static const double keeps = 0.03;
/* Tolerance of the contacts times all increments, at most, so that flow keeps at most 1e-4. Half and
 * double change no number of applications (23 lists of loads of bench/constants.py). */
static const double kept_goal = 3e-3;

/* Error of the increments over the change of the pressure by the terms of second order: of_terms for FEW
 * increments, less for more, up to RC_YIELD_SEVERE. Of more than that all of the change counts, unless the
 * load is mild. With 16 increments the error was at most 0.98 of this part on 85 maps with an elastic Mises
 * stress of up to 14 times the yield stress, and up to 1.9 times this part on 22 maps with more. */
static const double of_terms = 0.75, less = -0.8;
/* The part is larger by 1 + few_nodes over the nodes in contact: if few touch, one of them carries much of
 * the load. With 3 and 5 nodes the error was 1.8 and 1.3 times the estimate without it. */
static const double few_nodes = 6;
/* Error of the slabs over the change of the pressure by pairs of them: 1 + (few_slabs/n)^2 for n yielded
 * slabs. */
static const double few_slabs = 8;

/* ---- rows ---- */

static const int place_of[RC_COMPONENTS] = {
    [RC_SXX] = 0, [RC_SYY] = 1, [RC_SZZ] = -1, [RC_SXY] = 2, [RC_SXZ] = 3, [RC_SYZ] = 4};

/* The nodes of a row of a slab. */
static size_t
nodes_of(const struct rc_yield_solver *p, size_t slab)
{
    return p->shape.nx >> rc_slabs_level(p->slabs, slab);
}

/* The depth that a voxel stands for in sums over voxels: a voxel of a coarse slab has the area of several
 * nodes. */
static double
weight_of(const struct rc_yield_solver *p, size_t slab)
{
    return ldexp(p->maps.thickness[slab], 2 * (int)rc_slabs_level(p->slabs, slab));
}

/* The other slab of a pair; the slab itself if it has none on the same nodes. */
static size_t
pair_of(const struct rc_yield_solver *p, size_t slab)
{
    const size_t level = rc_slabs_level(p->slabs, slab);
    size_t first = slab, other;

    while (first > 0 && rc_slabs_level(p->slabs, first - 1) == level)
        first--;
    other = first + ((slab - first) ^ 1);
    return other < p->voxels.slabs && rc_slabs_level(p->slabs, other) == level ? other : slab;
}

/* e + x; on paired slabs its mean over the pair. */
static bool
strain_row(void *ctx, size_t slab, enum rc_component c, size_t j, double *to)
{
    const struct rc_yield_solver *p = ctx;
    const size_t slabs[] = {slab, p->is.paired ? pair_of(p, slab) : slab}, a = (size_t)place_of[c];
    const double *thick = p->maps.thickness,
                 all = slabs[0] == slabs[1] ? thick[slab] : thick[slabs[0]] + thick[slabs[1]];
    bool any = false;

    for (size_t q = 0; q < (slabs[0] == slabs[1] ? 1 : 2); q++) {
        const struct rc_voxel_row *row = rc_voxels_row(&p->voxels, slabs[q], j);
        if (row->n > 0 && !any)
            memset(to, 0, nodes_of(p, slab) * sizeof *to);
        any |= row->n > 0;
        for (size_t k = 0; k < row->n; k++)
            to[row->v[k].i] += thick[slabs[q]] / all * (row->v[k].e[a] + row->v[k].x[a]);
    }
    return any;
}

/* The return from e + beta last: finds the growth of the equivalent strain, the trial stress and its size. */
static double
return_from(const struct rc_yield_body *body, const struct rc_voxel *v, const double *s,
            double beta, double *trial, double *size)
{
    for (size_t a = 0; a < RC_DEVIATOR; a++)
        trial[a] = s[a] + 2 * body->shear * (v->x[a] - beta * v->last[a]);
    *size = rc_mises_of(trial);
    return rc_yield_law_return(&body->law, 3 * body->shear, v->strain + beta * v->grown, *size);
}

static void
flow_by(double growth, const double *trial, double size, double *flow)
{
    for (size_t a = 0; a < RC_DEVIATOR; a++)
        flow[a] = growth > 0 ? 1.5 * growth * trial[a] / size : 0;
}

/* Applies F to a voxel under the stress s. `adds`: note the terms of second order in time. */
static void
flow(const struct rc_yield_body *body, double order, bool follows, struct rc_voxel *v,
     const double *s, bool adds)
{
    double trial[RC_DEVIATOR], first[RC_DEVIATOR], size;
    double low = 0, high = order, growth = return_from(body, v, s, 0, trial, &size);

    flow_by(growth, trial, size, first);
    memcpy(v->f, first, sizeof v->f);
    v->beta = 0;
    /* the voxel begins to flow within the step: as if BDF2 followed a step without flow */
    for (size_t a = 0; a < RC_DEVIATOR && follows && adds && v->grown == 0; a++)
        v->missed[a] -= (float)(RC_YIELD_BETA * first[a]);
    if (growth == 0 || order == 0)
        return;
    growth = return_from(body, v, s, high, trial, &size);
    if (growth > 0)
        low = high;
    for (int halving = 0; halving < HALVINGS && low < high; halving++) {
        double middle = (low + high) / 2;
        growth = return_from(body, v, s, middle, trial, &size);
        if (growth > 0)
            low = middle;
        else
            high = middle;
    }
    v->beta = (float)low;
    low = (double)v->beta;
    growth = return_from(body, v, s, low, trial, &size);
    flow_by(growth, trial, size, v->f);
    for (size_t a = 0; a < RC_DEVIATOR; a++) {
        v->f[a] += low * v->last[a];
        v->missed[a] += adds ? (float)(v->f[a] - first[a]) : 0;
    }
}

static void
sum_up(const struct rc_yield_body *body, const struct rc_voxel *v, double weight, double nodes,
       double *sums)
{
    double r[RC_DEVIATOR], turned[RC_DEVIATOR], moved[RC_DEVIATOR], lag;

    for (size_t a = 0; a < RC_DEVIATOR; a++) {
        r[a] = v->f[a] - v->x[a];
        turned[a] = r[a] - (double)v->left[a];
        moved[a] = (double)v->moved[a];
    }
    lag = 2 * body->shear * rc_mises_of(r) / body->yield;
    if (rc_deviator_product(v->f, v->f) > 0 || rc_deviator_product(v->x, v->x) > 0) {
        sums[RC_LAG] += nodes * lag * lag;
        sums[RC_FLOWING] += nodes;
    }
    sums[RC_NEW_OLD] += weight * rc_deviator_product(r, turned);
    sums[RC_CHANGE] += weight * rc_deviator_product(turned, turned);
    sums[RC_ADVANCE] += weight * rc_deviator_product(moved, moved);
    sums[RC_RESISTED] -= weight * rc_deviator_product(moved, turned);
}

static inline void
stress_at(double *const s[RC_COMPONENTS], size_t i, double *to)
{
    to[0] = s[RC_SXX][i];
    to[1] = s[RC_SYY][i];
    to[2] = s[RC_SXY][i];
    to[3] = s[RC_SXZ][i];
    to[4] = s[RC_SYZ][i];
}

/* Counts the nodes of a row that yield for the first time; `place`: array for their indices, or NULL. */
static size_t
yields_first(double yield, size_t nx, const struct rc_voxel_row *row, double *const s[],
             uint32_t *place)
{
    double square = yield * yield / 1.5;
    size_t count = 0, known = 0;

    for (size_t i = 0; i < nx; i++) {
        double at[RC_DEVIATOR];
        stress_at(s, i, at);
        while (known < row->n && row->v[known].i < i)
            known++;
        if ((known < row->n && row->v[known].i == i) || !(rc_deviator_product(at, at) > square))
            continue;
        if (place != NULL)
            place[count] = (uint32_t)i;
        count++;
    }
    return count;
}

static enum rc_status
take_in(double yield, size_t nx, struct rc_voxel_row *row, double *const s[])
{
    size_t count = yields_first(yield, nx, row, s, NULL);
    enum rc_status status = RC_OK;
    uint32_t *place;

    if (count == 0)
        return RC_OK;
    place = malloc(count * sizeof *place);
    if (place == NULL)
        return RC_FAIL;
    (void)yields_first(yield, nx, row, s, place);
    status = rc_voxels_add(row, count, place);
    free(place);
    return status;
}

/* Finds the flow under this stress without keeping it. */
static void
look_ahead(const struct rc_yield_solver *p, size_t slab, struct rc_voxel_row *row,
           double *const s[])
{
    const double square = p->body.yield * p->body.yield / 1.5, weight = weight_of(p, slab),
                 nodes = weight / p->maps.thickness[slab];

    for (size_t i = 0, known = 0; i < nodes_of(p, slab); i++) {
        struct rc_voxel fresh = {0};
        bool is_known;
        double at[RC_DEVIATOR];
        stress_at(s, i, at);
        while (known < row->n && row->v[known].i < i)
            known++;
        is_known = known < row->n && row->v[known].i == i;
        if (!is_known && !(rc_deviator_product(at, at) > square))
            continue;
        flow(&p->body, p->run.order, p->asked.follows, is_known ? &row->v[known] : &fresh, at,
             false);
        sum_up(&p->body, is_known ? &row->v[known] : &fresh, weight, nodes, row->sums);
    }
}

/* True if the load has one increment: its first application is also the elastic trial. */
static bool
in_one(const struct rc_yield_asked *asked)
{
    return asked->increments == 1 && !asked->follows;
}

static void
stress_row(void *ctx, size_t slab, size_t j, double *const s[RC_COMPONENTS])
{
    struct rc_yield_solver *p = ctx;
    struct rc_voxel_row *row = rc_voxels_row(&p->voxels, slab, j);
    const double weight = weight_of(p, slab), nodes = weight / p->maps.thickness[slab];
    bool adds = p->run.trial + 1 == (p->run.increment == p->run.count ? LAST : EACH);

    memset(row->sums, 0, sizeof row->sums);
    if (p->stage == RC_YIELD_PROBE && !in_one(&p->asked)) {
        look_ahead(p, slab, row, s);
        return;
    }
    if (take_in(p->body.yield, nodes_of(p, slab), row, s) != RC_OK) {
#pragma omp atomic write
        p->is.failed = true;
        return;
    }
    for (size_t k = 0; k < row->n; k++) {
        double at[RC_DEVIATOR];
        stress_at(s, row->v[k].i, at);
        flow(&p->body, p->run.order, p->asked.follows, &row->v[k], at, adds);
        sum_up(&p->body, &row->v[k], weight, nodes, row->sums);
    }
}

/* ---- all voxels ---- */

typedef void each_voxel(struct rc_yield_solver *p, struct rc_voxel *v);

static void
for_each(struct rc_yield_solver *p, each_voxel *do_it)
{
#pragma omp parallel for schedule(static) num_threads(p->threads)
    for (size_t r = 0; r < p->voxels.slabs * p->voxels.rows; r++)
        for (size_t k = 0; k < p->voxels.row[r].n; k++)
            do_it(p, &p->voxels.row[r].v[k]);
}

/* Sets x to the mixture of f and the f of the previous trial; to exactly 0 if neither flows. */
static void
mix(struct rc_yield_solver *p, struct rc_voxel *v)
{
    /* Rounding of single precision. Half and double change no bit (23 lists of loads of
     * bench/constants.py). */
    static const double rounding = 1e-6;
    double r[RC_DEVIATOR], moved[RC_DEVIATOR], left[RC_DEVIATOR], before[RC_DEVIATOR];
    bool still;

    for (size_t a = 0; a < RC_DEVIATOR; a++) {
        r[a] = v->f[a] - v->x[a];
        moved[a] = (double)v->moved[a];
        left[a] = (double)v->left[a];
        before[a] = v->x[a] - moved[a] + left[a];
    }
    still = !(rc_deviator_product(v->f, v->f) > 0) &&
            rc_deviator_product(before, before) <=
                rounding * rounding *
                    (rc_deviator_product(moved, moved) + rc_deviator_product(left, left));
    for (size_t a = 0; a < RC_DEVIATOR; a++) {
        double step = still ? -v->x[a] : r[a] - p->run.mix * (moved[a] + (r[a] - left[a]));
        v->left[a] = (float)r[a];
        v->moved[a] = (float)step;
        v->x[a] += step;
    }
}

static void
accept(struct rc_yield_solver *p, struct rc_voxel *v)
{
    double d[RC_DEVIATOR], grown;

    for (size_t a = 0; a < RC_DEVIATOR; a++)
        d[a] = v->x[a] - (double)v->beta * v->last[a];
    grown = (double)v->beta * v->grown + 2 * rc_mises_of(d) / 3;
    v->strain += grown;
    v->grown = grown;
    for (size_t a = 0; a < RC_DEVIATOR; a++) {
        v->e[a] += v->x[a];
        v->last[a] = v->x[a];
        v->moved[a] = v->left[a] = 0;
        v->missed[a] += p->asked.once ? (float)v->x[a] : 0;
    }
}

/* Undoes the only increment of the load. */
static void
undo(struct rc_yield_solver *p, struct rc_voxel *v)
{
    (void)p;
    v->strain -= v->grown;
    v->grown = 0;
    for (size_t a = 0; a < RC_DEVIATOR; a++) {
        v->e[a] -= v->last[a];
        v->last[a] = v->x[a] = v->missed[a] = 0;
    }
}

static void
begin_load(struct rc_yield_solver *p, struct rc_voxel *v)
{
    (void)p;
    memset(v->x, 0, sizeof v->x);
    memset(v->last, 0, sizeof v->last);
    for (size_t a = 0; a < RC_DEVIATOR; a++)
        v->before[a] += v->missed[a];
    memset(v->missed, 0, sizeof v->missed);
    memset(v->moved, 0, sizeof v->moved);
    memset(v->left, 0, sizeof v->left);
    v->grown = 0;
}

/* No voxel flows in an increment of a contact that travels. */
static void
rest(struct rc_yield_solver *p, struct rc_voxel *v)
{
    (void)p;
    memset(v->x, 0, sizeof v->x);
    memset(v->last, 0, sizeof v->last);
    v->grown = 0;
}

static void
try_missed(struct rc_yield_solver *p, struct rc_voxel *v)
{
    (void)p;
    for (size_t a = 0; a < RC_DEVIATOR; a++)
        v->x[a] = (double)v->before[a] + (double)v->missed[a];
}

static void
try_before(struct rc_yield_solver *p, struct rc_voxel *v)
{
    (void)p;
    for (size_t a = 0; a < RC_DEVIATOR; a++)
        v->x[a] = (double)v->before[a];
}

static void
try_none(struct rc_yield_solver *p, struct rc_voxel *v)
{
    (void)p;
    memset(v->x, 0, sizeof v->x);
}

static void
try_against(struct rc_yield_solver *p, struct rc_voxel *v)
{
    (void)p;
    for (size_t a = 0; a < RC_DEVIATOR; a++)
        v->x[a] = -v->e[a];
}

/* ---- an application ---- */

/* Finds the slabs with yielded voxels on any rank. Returns false if there are none. */
static bool
find_strained(struct rc_yield_solver *p)
{
    struct rc_voxels *voxels = &p->voxels;
    double *some = p->maps.some;
    bool any = false;

    for (size_t k = 0; k < voxels->slabs; k++) {
        some[k] = 0;
        for (size_t j = 0; j < voxels->rows && some[k] == 0; j++)
            some[k] = rc_voxels_row(voxels, k, j)->n > 0;
    }
    rc_ranks_each_most(p->rows.ranks, voxels->slabs, some);
    for (size_t k = 0; k < voxels->slabs; k++) {
        voxels->strained[k] = some[k] > 0;
        any |= voxels->strained[k];
    }
    return any;
}

/* Slabs with strain, where each pair has the mean of its strain. */
static void
pair_strained(struct rc_yield_solver *p)
{
    for (size_t k = 0; k + 1 < p->voxels.slabs; k++)
        if (pair_of(p, k) == k + 1)
            p->voxels.strained[k] = p->voxels.strained[k + 1] =
                p->voxels.strained[k] || p->voxels.strained[k + 1];
}

/* Whether a voxel of the whole map has yielded. */
static bool
has_voxels(const struct rc_yield_solver *p)
{
    return rc_ranks_most(p->rows.ranks, (double)rc_voxels_count(&p->voxels)) > 0;
}

/* Finds p, the contact of e + x under the present load. */
static enum rc_status
press(struct rc_yield_solver *p, struct rc_err *err)
{
    const struct rc_slab_strain strain = {p->voxels.strained, strain_row, p};
    enum rc_status status;

    if (find_strained(p) || p->is.moved) {
        if (p->is.paired)
            pair_strained(p);
        rc_slabs_up(p->slabs, &strain, p->maps.u);
        for (size_t k = 0; k < p->n; k++)
            p->maps.form[k] = p->maps.h[k] - p->maps.u[k];
        if (rc_solver_set_heights(p->solver, p->maps.form, err) != RC_OK)
            return RC_FAIL;
        p->is.moved = false;
    }
    if (p->is.alone)
        return RC_OK;
    p->is.pressed = true;
    do
        status = rc_solver_step(p->solver);
    while (status == RC_MORE);
    p->is.stopped |= status != RC_OK;
    return RC_OK;
}

static const double *
pressure(const struct rc_yield_solver *p)
{
    return p->is.alone ? NULL : rc_solver_pressure(p->solver);
}

/* The relative L1 distance of the pressure from maps.other. */
static double
moved(const struct rc_yield_solver *p)
{
    const double *is = pressure(p), *other = p->maps.other;
    struct rc_total part[2] = {{0}};
    double sum[2];

    for (size_t k = 0; k < p->n && is != NULL; k++) {
        rc_total_add(&part[0], fabs(is[k] - other[k]));
        rc_total_add(&part[1], is[k]);
    }
    rc_ranks_totals(p->rows.ranks, 2, part, sum, 0, NULL);
    return sum[1] > 0 ? sum[0] / sum[1] : 0;
}

void
rc_yield_solver_keep_pressure(struct rc_yield_solver *p)
{
    const double *is = pressure(p);

    if (is != NULL)
        memcpy(p->maps.other, is, p->n * sizeof *is);
    else
        memset(p->maps.other, 0, p->n * sizeof *p->maps.other);
}

static void
total(const struct rc_yield_solver *p, double sums[RC_VOXEL_SUMS])
{
    struct rc_total part[RC_VOXEL_SUMS] = {{0}};

    for (size_t r = 0; r < p->voxels.slabs * p->voxels.rows; r++)
        for (size_t q = 0; q < RC_VOXEL_SUMS; q++)
            rc_total_add(&part[q], p->voxels.row[r].sums[q]);
    rc_ranks_totals(p->rows.ranks, RC_VOXEL_SUMS, part, sums, 0, NULL);
}

/* Applies F to e + x, and finds the lag of x. */
static enum rc_status
apply(struct rc_yield_solver *p, struct rc_err *err)
{
    const struct rc_slab_stress stress = {NULL, stress_row, p};
    double sums[RC_VOXEL_SUMS], last;

    if (press(p, err) != RC_OK)
        return RC_FAIL;
    rc_slabs_down(p->slabs, pressure(p), &stress);
    p->figures.applications++;
    if (rc_ranks_need(p->rows.ranks, !p->is.failed, err,
                      "out of memory for the strain of %zu voxels",
                      rc_voxels_count(&p->voxels)) != RC_OK)
        return RC_FAIL;
    total(p, sums);
    last = p->run.trial > 0 ? p->figures.lag : INFINITY;
    p->is.flows = sums[RC_FLOWING] > 0;
    p->figures.lag = p->is.flows ? sqrt(sums[RC_LAG] / sums[RC_FLOWING]) : 0;
    p->run.mix = 0;
    /* F itself never raises the energy, but a mixture may. A mixture is not taken if the last one did not
     * lower the lag. Comparing energies instead needs one more displacement by the pressure, and is no
     * better. One increment of 300 random maps of 24 x 24 nodes, Hm from 0 to 100 Y, took 6404 applications
     * by the energy, and 6413 by the lag. It took 6547 by neither, and 13403 without mixtures, where 7 maps
     * took more than 200. */
    if (p->run.trial > 0 && sums[RC_CHANGE] > 0 && p->figures.lag < last)
        p->run.mix = sums[RC_NEW_OLD] / sums[RC_CHANGE];
    if (p->run.trial > 0 && sums[RC_ADVANCE] > 0 && sums[RC_RESISTED] > 0)
        p->run.resistance = fmin(p->run.resistance, sums[RC_RESISTED] / sums[RC_ADVANCE]);
    return RC_OK;
}

/* ---- a load ---- */

static enum rc_status
set_load(struct rc_yield_solver *p, double load, struct rc_err *err)
{
    p->way.set = load;
    p->is.alone = !(load > 0);
    return p->is.alone ? RC_OK : rc_solver_set_load(p->solver, load, 0, err);
}

static double
share_of_way(const struct rc_yield_way *way, double share)
{
    return share == 1 ? way->to : way->from + (way->to - way->from) * share;
}

/* Starts the increments of the load at the load `start`. */
static void
begin_increments(struct rc_yield_solver *p, size_t count, double start)
{
    p->run.count = p->figures.increments = count;
    p->way.start = start;
    p->run.increment = 1;
    p->run.trial = 0;
    p->run.resistance = INFINITY;
    p->stage = RC_YIELD_TRIAL;
}

/* True if little flow makes one increment worth a try; its error is found afterwards. */
static bool
follows_little(const struct rc_yield_solver *p)
{
    return !p->errors.few && !p->asked.thorough && has_voxels(p);
}

/* Tries an elastic step: first to the end of the load, then to shorter shares of it, by bisection. */
static enum rc_status
probe(struct rc_yield_solver *p, struct rc_err *err)
{
    double share = p->run.trial == 0 ? 1 : (p->way.low + p->way.high) / 2;

    if (set_load(p, share_of_way(&p->way, share), err) != RC_OK || apply(p, err) != RC_OK)
        return RC_FAIL;
    p->run.trial++;
    if (p->is.flows)
        p->way.high = share;
    else
        p->way.low = share;
    if (p->way.low == 1) {
        p->is.elastic = true;
        if (p->asked.follows)
            for_each(p, rest);
        begin_increments(p, 1, p->way.to);
        p->stage = RC_YIELD_STATE;
    } else if (p->asked.follows) {
        begin_increments(p, 1, p->way.to);
    } else if (p->run.trial == 1 && p->figures.lag < (follows_little(p) ? little : trace)) {
        p->asked.once = !p->errors.few;
        begin_increments(p, 1, p->way.from);
    } else if (in_one(&p->asked)) {
        p->errors.few = true;
        begin_increments(p, 1, p->way.from);
    } else if (p->run.trial > BISECTIONS || (p->run.trial > BISECT_FIRST && p->way.low == 0)) {
        begin_increments(p, p->asked.increments, share_of_way(&p->way, p->way.low));
        p->errors.few |= p->asked.increments < FEW;
    }
    if (in_one(&p->asked) && p->is.flows) {
        p->run.trial = 1;
        for_each(p, mix);
        rc_yield_solver_keep_pressure(p);
    }
    return RC_OK;
}

static enum rc_status
begin_increment(struct rc_yield_solver *p, struct rc_err *err)
{
    double share = (double)p->run.increment / (double)p->run.count;

    p->run.order = p->run.increment > 1 || p->asked.follows ? RC_YIELD_BETA : 0;
    return set_load(p,
                    p->run.increment == p->run.count
                        ? p->way.to
                        : p->way.start + (p->way.to - p->way.start) * share,
                    err);
}

/* The error of the pressure from the iteration, estimated from its last change, from p->other. */
static double
iteration_error(const struct rc_yield_solver *p)
{
    return 1.5 * moved(p) / fmin(p->run.resistance, 1); /* a resistance is at most 1 */
}

static bool
enough(const struct rc_yield_solver *p)
{
    if (!has_voxels(p) || (p->run.trial == 1 && !p->is.flows))
        return true;
    if (p->run.increment < p->run.count)
        return p->run.trial >= MOST_EACH || (p->run.trial >= EACH && p->figures.lag <= lags);
    return p->run.trial >= MOST ||
           (p->run.trial >= LAST && p->figures.lag <= p->asked.lag && iteration_error(p) <= moves);
}

static enum rc_status
advance(struct rc_yield_solver *p, struct rc_err *err)
{
    bool done;

    if (p->run.trial == 0 && begin_increment(p, err) != RC_OK)
        return RC_FAIL;
    if (apply(p, err) != RC_OK)
        return RC_FAIL;
    p->run.trial++;
    for_each(p, mix);
    done = enough(p);
    if (p->run.increment == p->run.count)
        rc_yield_solver_keep_pressure(p);
    if (!done)
        return RC_OK;
    p->is.stopped |= p->run.trial >= MOST;
    for_each(p, accept);
    p->run.trial = 0;
    if (p->run.increment++ < p->run.count)
        return RC_OK;
    p->stage = RC_YIELD_STATE;
    return RC_OK;
}

/* The largest mean of four neighbouring pressures. */
static double
largest_mean(const struct rc_yield_solver *p)
{
    const size_t nx = p->shape.nx, rows = p->rows.n;
    const double *v = pressure(p), *after = p->boundary.y ? v : NULL;
    double most = 0;

    if (v == NULL)
        return 0;
    if (p->rows.ranks != NULL) {
        double *beside = p->maps.beside;
        bool has[2];
        rc_ranks_beside(&p->rows, p->boundary.y, nx * sizeof *v, v,
                        v + (rows > 0 ? rows - 1 : 0) * nx, beside, beside + nx, has);
        after = has[1] ? beside + nx : NULL;
    }
    for (size_t j = 0; j < rows; j++) {
        const double *row = v + j * nx, *below = j + 1 < rows    ? row + nx
                                                 : after != NULL ? after
                                                                 : row;
        for (size_t i = 0; i < nx; i++) {
            size_t right = i + 1 < nx ? i + 1 : p->boundary.x ? 0 : i;
            most = fmax(most, (row[i] + row[right] + below[i] + below[right]) / 4);
        }
    }
    return rc_ranks_most(p->rows.ranks, most);
}

static void
find_figures(struct rc_yield_solver *p)
{
    enum {
        VOXELS,
        VOLUME,
        STRAINED,
        WORK,
        SUMS
    };
    struct rc_yield_load *f = &p->figures;
    double cell = p->shape.dx * p->shape.dy, bottom = 0, sum[SUMS], most[3] = {0, 0, 0};
    struct rc_total total[SUMS] = {{0}};

    for (size_t k = 0; k < p->voxels.slabs; k++) {
        bottom += p->maps.thickness[k];
        for (size_t j = 0; j < p->voxels.rows; j++) {
            const struct rc_voxel_row *row = rc_voxels_row(&p->voxels, k, j);
            size_t flowing = 0;
            for (size_t i = 0; i < row->n; i++) {
                double strain = row->v[i].strain, part = cell * weight_of(p, k);
                if (!(strain > 0))
                    continue;
                rc_total_add(&total[VOXELS], 1);
                rc_total_add(&total[VOLUME], part);
                rc_total_add(&total[STRAINED], part * strain);
                rc_total_add(&total[WORK], part * rc_yield_law_work(&p->body.law, strain));
                most[0] = bottom;
                most[1] = fmax(most[1], strain);
                flowing += row->v[i].grown > 0;
            }
            most[2] = fmax(most[2], (double)(flowing << rc_slabs_level(p->slabs, k)));
        }
    }
    rc_ranks_totals(p->rows.ranks, SUMS, total, sum, 3, most);
    f->voxels = (size_t)sum[VOXELS];
    f->volume = sum[VOLUME];
    f->strained = sum[STRAINED];
    f->work = sum[WORK];
    f->depth = most[0];
    f->max_strain = most[1];
    f->flow_length = most[2] * p->shape.dx;
    f->max_pressure_mean4 = largest_mean(p);
}

/* Accepts the state, and compares its pressure with the pressure of the last application. */
static enum rc_status
settle(struct rc_yield_solver *p, struct rc_err *err)
{
    p->run.trial = 0;
    p->run.taken += p->run.count;
    if (p->is.elastic) { /* its contact is solved, except in a state that was just read */
        if (p->is.moved && press(p, err) != RC_OK)
            return RC_FAIL;
        p->figures.iteration_error = 0;
    } else {
        for_each(p, try_none);
        if (press(p, err) != RC_OK)
            return RC_FAIL;
        p->figures.iteration_error = iteration_error(p);
        p->errors.kept += keeps * (double)p->run.count * p->run.tol;
    }
    rc_yield_solver_keep_pressure(p);
    p->figures.increment_error = p->errors.few && !p->is.elastic ? NAN : 0;
    p->figures.inherited_error = p->errors.few ? NAN : 0;
    p->figures.slab_error = p->errors.few ? NAN : 0;
    p->stage = p->errors.few || !has_voxels(p) ? RC_YIELD_DONE : RC_YIELD_ORDER;
    return RC_OK;
}

/* The number of slabs down to the deepest one that has yielded, on any rank. */
static size_t
yielded_slabs(const struct rc_yield_solver *p)
{
    double deepest = 0;

    for (size_t k = 0; k < p->voxels.slabs; k++)
        for (size_t j = 0; j < p->voxels.rows; j++) {
            const struct rc_voxel_row *row = rc_voxels_row(&p->voxels, k, j);
            for (size_t i = 0; i < row->n; i++)
                if (row->v[i].strain > 0)
                    deepest = (double)(k + 1);
        }
    return (size_t)rc_ranks_most(p->rows.ranks, deepest);
}

/* Finds how much the contact changes if each pair of slabs has the mean of its strain: the strain in one slab
 * of twice the thickness. If fewer than RESOLVED slabs yield, the change by all of the strain counts; if the
 * caller gave such slabs, their error is unknown. */
static enum rc_status
compare_slabs(struct rc_yield_solver *p, struct rc_err *err)
{
    const size_t n = yielded_slabs(p);
    enum rc_status status;

    p->is.paired = n >= RESOLVED;
    if (!p->is.paired)
        for_each(p, try_against);
    status = press(p, err);
    p->is.paired = false;
    p->figures.slab_error = moved(p);
    if (n >= RESOLVED)
        p->figures.slab_error *= 1 + few_slabs * few_slabs / (double)(n * n);
    else if (n > 0 && !p->asked.chosen)
        p->figures.slab_error = NAN;
    return status;
}

static void
judge(struct rc_yield_solver *p, struct rc_voxel *v)
{
    for (size_t a = 0; a < RC_DEVIATOR; a++)
        v->missed[a] *= (float)p->errors.judged;
}

/* The part of the terms of second order that is the error of so many increments. */
static double
part_of_terms(const struct rc_yield_solver *p)
{
    const double n = fmin((double)p->run.count, RC_YIELD_SEVERE);
    const double *is = pressure(p);
    size_t touching = 0;

    for (size_t k = 0; k < p->n && is != NULL; k++)
        touching += rc_in_contact(is[k]);
    touching = rc_ranks_sum(p->rows.ranks, touching);
    return (p->run.count > RC_YIELD_SEVERE && !p->asked.mild ? 1 : of_terms * pow(n / FEW, less)) *
           (touching > 0 ? 1 + few_nodes / (double)touching : 1);
}

/* Finds how much the contact changes by all terms of second order. Divides this change in proportion to the
 * changes by this load alone and by earlier loads alone. */
static enum rc_status
compare_order(struct rc_yield_solver *p, struct rc_err *err)
{
    double all, own, inherited;

    if (compare_slabs(p, err) != RC_OK)
        return RC_FAIL;
    for_each(p, try_missed);
    if (press(p, err) != RC_OK)
        return RC_FAIL;
    all = moved(p);
    rc_yield_solver_keep_pressure(p);
    for_each(p, try_before);
    if (!p->is.elastic && press(p, err) != RC_OK)
        return RC_FAIL;
    own = moved(p);
    rc_yield_solver_keep_pressure(p);
    for_each(p, try_none);
    if (press(p, err) != RC_OK)
        return RC_FAIL;
    inherited = moved(p);
    p->figures.increment_error = own > 0 ? all * own / (own + inherited) : 0;
    p->figures.inherited_error = all - p->figures.increment_error;
    if (!p->asked.follows && !p->asked.once && p->run.count >= FEW) {
        p->errors.judged = part_of_terms(p);
        p->figures.increment_error *= p->errors.judged;
        for_each(p, judge);
    }
    if (p->asked.follows)
        p->figures.increment_error = fmax(of_steps * p->figures.increment_error, p->errors.worst);
    p->errors.worst = p->figures.increment_error;
    p->stage = RC_YIELD_DONE;
    if (p->asked.once && !in_one(&p->asked) &&
        p->figures.increment_error > fmax(once_part * p->figures.inherited_error, once_least)) {
        p->asked.once = p->is.stopped = false;
        for_each(p, undo);
        p->run.trial = 1; /* the first trial is known */
        p->stage = RC_YIELD_PROBE;
    }
    return RC_OK;
}

/* Parts of the two ratios below: of the yielded volume, and of the load. If few nodes touch, one of them
 * carries most of the load, and a change of its limit moves load to the others: the part of the load is
 * larger by 20, 5 and 3 at 3, 6 and 8 nodes, which the factor 1 + (13 / nodes)^2 covers. */
static const double of_volume = 0.6, of_load = 0.5;

static double
of_nodes(double touching)
{
    const double few = 13, least = 3, each = few / fmax(touching, least);

    return of_load * (1 + each * each);
}

/* The error of the pressure from the images of a free map, at a distance of twice its sides. Images of the
 * yielded volume: their stress over the mean contact pressure. The stress is the modulus times the plastic
 * strain, spread over a cube on the map. On balls with a contact of 5 to 28 % of the map the error was 0.4 to
 * 0.47 of this ratio. Images of the load: the mean pressure of the padded map over the yield stress. Half of
 * this ratio was enough on 212 balls, pairs of balls and rough balls, and 0.4 on all but one of them. */
static double
error_of_points(const struct rc_yield_solver *p, double sum, double touching)
{
    const double all = (double)p->shape.nx * (double)p->shape.ny;
    const double area = all * p->shape.dx * p->shape.dy, side = sqrt(area);

    return of_volume * 2 * (1 + p->body.nu) * p->body.shear * p->figures.strained /
               (side * side * side * sum / touching) +
           of_nodes(touching) * sum / all / (4 * p->body.yield);
}

enum {
    OF_LOAD, /* sums over the lines across the axis that repeats: pressure, plastic strain, */
    OF_STRAIN,
    OF_WAVE, /* and the pressure times 1, -1, 1, ... */
    LINE_SUMS
};

/* Returns how many nodes across that axis lie between the outermost ones with a pressure or strain. */
static size_t
sum_lines(const struct rc_yield_solver *p, double *sums)
{
    const size_t nx = p->shape.nx, ny = p->shape.ny;
    const bool along_x = p->boundary.x;
    const double *v = pressure(p);
    size_t first = nx + ny, last = 0;

    memset(sums, 0, LINE_SUMS * p->lines * sizeof *sums);
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            const size_t line = along_x ? i : j, node = along_x ? j : i;
            sums[OF_LOAD * p->lines + line] += v[j * nx + i];
            sums[OF_WAVE * p->lines + line] += node % 2 == 0 ? v[j * nx + i] : -v[j * nx + i];
            first = v[j * nx + i] > 0 && node < first ? node : first;
            last = v[j * nx + i] > 0 && node > last ? node : last;
        }
    for (size_t k = 0; k < p->voxels.slabs; k++)
        for (size_t j = 0; j < p->voxels.rows; j++) {
            const struct rc_voxel_row *row = rc_voxels_row(&p->voxels, k, j);
            for (size_t i = 0; i < row->n; i++) {
                const size_t line = along_x ? row->v[i].i : j, node = along_x ? j : row->v[i].i;
                sums[OF_STRAIN * p->lines + line] += p->maps.thickness[k] * row->v[i].strain;
                first = row->v[i].strain > 0 && node < first ? node : first;
                last = row->v[i].strain > 0 && node > last ? node : last;
            }
        }
    return last + 1 - first;
}

/* The mean of the wave of two nodes on a map padded to twice its free axis, over the loads of the lines. The
 * volume leaves this wave out (volume/volume.h), but the far stack has most of its mean along the axis. The
 * error of the pressure was at most 0.15 of this mean, over the yield stress. */
static const double of_wave = 0.3;

static double
lost_wave(const double *load, const double *wave, size_t n, double padded)
{
    double mean = rc_sum(wave, n) / (double)n, sum = 0;

    for (size_t k = 0; k < n; k++)
        sum += load[k] * (fabs(wave[k] - mean) + fabs(mean) / RC_SLABS_FAR);
    return sum / (rc_sum(load, n) * padded);
}

/* The part of a line that varies along it, at a distance: its waves, which decay. `periods`: the distance
 * over the length of the line. */
static double
part_at(const double *line, size_t n, double periods)
{
    double part = 0, all = rc_sum(line, n);

    for (size_t m = 1; m <= n / 2 && all > 0; m++) {
        double re = 0, im = 0, decay = exp(-2 * RC_PI * (double)m * periods);
        if (decay < 1e-4)
            break;
        for (size_t j = 0; j < n; j++) {
            re += line[j] * cos(2 * RC_PI * (double)(m * j % n) / (double)n);
            im += line[j] * sin(2 * RC_PI * (double)(m * j % n) / (double)n);
        }
        part += 2 * hypot(re, im) / all * decay;
    }
    return part;
}

/* The same on a map that repeats along one axis, which ranks do not share, whose images lie across it,
 * twice the free side away. Their mean along the axis repeats only after many sides (volume/lines.h), and
 * a line load changes the stress at a depth z by its own 2 pi z/3 over the square of that distance. What
 * varies along the axis decays. The lost wave of two nodes is that of a padded map too. */
static double
error_of_lines(const struct rc_yield_solver *p, double sum, double touching)
{
    const bool along_x = p->boundary.x;
    const size_t n = p->lines, across = p->n / n;
    const double width = (double)across * (along_x ? p->shape.dy : p->shape.dx),
                 period = (double)n * (along_x ? p->shape.dx : p->shape.dy),
                 far = 2 * RC_SLABS_FAR * width;
    const double modulus = 2 * (1 + p->body.nu) * p->body.shear;
    const double *load = p->maps.line + OF_LOAD * n, *strain = p->maps.line + OF_STRAIN * n,
                 *wave = p->maps.line + OF_WAVE * n;
    double touched = 0, apart; /* of the contact and its next image, in periods */

    apart = (2 * width - width / (double)across * (double)sum_lines(p, p->maps.line)) / period;
    for (size_t k = 0; k < n; k++)
        touched += load[k] > 0;
    return of_volume * modulus * p->figures.strained * touching / (period * sum) *
               (RC_PI * part_at(strain, n, apart) / (width * width) +
                RC_PI * RC_PI / (3 * far * far)) +
           of_nodes(touching / touched) * sum * p->shape.dx * p->shape.dy /
               (period * p->body.yield) *
               (part_at(load, n, apart) / (2 * width) +
                2 * RC_PI / 3 * p->figures.depth / (far * far)) +
           of_wave * lost_wave(load, wave, n, 2 * (double)across) / p->body.yield;
}

static double
image_error(const struct rc_yield_solver *p)
{
    const double *v = pressure(p);
    struct rc_total part[2] = {{0}};
    double sum[2];

    if (!rc_has_mean(p->boundary) || v == NULL || !has_voxels(p))
        return 0;
    for (size_t k = 0; k < p->n; k++) {
        rc_total_add(&part[0], v[k]);
        part[1].sum += v[k] > 0;
    }
    rc_ranks_totals(p->rows.ranks, 2, part, sum, 0, NULL);
    return rc_repeats(p->boundary) == 1 ? error_of_lines(p, sum[0], sum[1])
                                        : error_of_points(p, sum[0], sum[1]);
}

/* The error of the pressure from the tolerance of this contact, and from earlier ones that flow has kept. */
static double
contact_error(const struct rc_yield_solver *p)
{
    struct rc_progress at;

    if (p->is.alone)
        return 0;
    rc_solver_progress(p->solver, &at);
    return fmax(p->run.tol, at.error) + p->errors.kept;
}

static void
sum_errors(struct rc_yield_solver *p)
{
    struct rc_yield_load *f = &p->figures;

    f->image_error = image_error(p);
    f->contact_error = contact_error(p);
    if (p->is.alone) /* the pressure is 0 and has no error */
        f->increment_error = f->inherited_error = f->iteration_error = f->slab_error = 0;
    f->error = hypot(f->increment_error + f->inherited_error, f->slab_error) + f->iteration_error +
               f->contact_error + f->image_error;
}

/* ---- the interface ---- */

void
rc_yield_solver_judge(struct rc_yield_solver *p, double increment, double inherited)
{
    struct rc_yield_load *f = &p->figures;

    if (f->increment_error > 0) {
        p->errors.judged = increment / f->increment_error;
        for_each(p, judge);
    }
    f->increment_error = p->errors.worst = increment;
    f->inherited_error = inherited;
    sum_errors(p);
}

enum rc_status
rc_yield_solver_set_load(struct rc_yield_solver *p, double load, struct rc_err *err)
{
    if (!(load >= 0) || isinf(load))
        return rc_err_set(err, "load %g N: it must be finite and not negative", load);
    if (load > p->bearable)
        return rc_err_set(err,
                          "load %.9g N: it must be below %.9g N, 0.9 of the load at which the mean "
                          "pressure alone makes all depths of a periodic body yield",
                          load, p->bearable);
    p->way.to = load;
    p->run.trial = 0;
    p->way.low = p->run.order = 0;
    p->way.high = 1;
    p->is.stopped = p->is.elastic = p->asked.once = false;
    p->figures = (struct rc_yield_load){0};
    p->stage = RC_YIELD_PROBE;
    if (p->asked.yields && p->way.from == 0 && !has_voxels(p) && !in_one(&p->asked)) {
        begin_increments(p, p->asked.increments, 0);
        p->errors.few |= p->asked.increments < FEW;
    }
    rc_yield_solver_solve_to(
        p, fmin(p->asked.tol, kept_goal / (double)(p->run.taken + p->asked.increments)));
    if (!p->asked.follows)
        for_each(p, begin_load);
    return RC_OK;
}

void
rc_yield_solver_follow(struct rc_yield_solver *p)
{
    if (!p->asked.follows)
        for_each(p, rest); /* the increments before were steps of another length */
    rc_yield_solver_set_increments(p, 1);
    p->asked.follows = true;
}

void
rc_yield_solver_set_increments(struct rc_yield_solver *p, size_t increments)
{
    p->asked.follows = false;
    p->asked.increments = increments > 0 ? increments : INCREMENTS;
}

void
rc_yield_solver_solve_to(struct rc_yield_solver *p, double tol)
{
    p->run.tol = tol;
    rc_solver_set_tol(p->solver, tol);
}

void
rc_yield_solver_set_heights(struct rc_yield_solver *p, const double *h)
{
    memcpy(p->maps.h, h, p->n * sizeof *h);
    p->is.moved = true;
}

enum rc_status
rc_yield_solver_step(struct rc_yield_solver *p, struct rc_err *err)
{
    enum rc_status status = RC_OK;

    if (p->stage == RC_YIELD_NEW)
        return rc_err_set(err, "no load has been set");
    if (p->stage == RC_YIELD_PROBE)
        status = probe(p, err);
    else if (p->stage == RC_YIELD_TRIAL)
        status = advance(p, err);
    else if (p->stage == RC_YIELD_STATE)
        status = settle(p, err);
    else if (p->stage == RC_YIELD_ORDER)
        status = compare_order(p, err);
    else if (p->stage == RC_YIELD_AGAIN && (status = press(p, err)) == RC_OK)
        p->stage = RC_YIELD_DONE;
    if (status != RC_OK || p->stage != RC_YIELD_DONE)
        return status == RC_OK ? RC_MORE : status;
    p->way.from = p->way.to;
    find_figures(p);
    sum_errors(p);
    return p->is.stopped ? RC_SHORT : RC_OK;
}

/* Adds the equivalent strain of a voxel of a coarse slab to the nodes of the map around it, in the rows
 * held here. It falls linearly to 0 at the next voxels: waves would make it negative, and spread it over
 * the map. */
static void
spread(const struct rc_yield_solver *p, size_t level, size_t i, size_t j, double strain,
       double *map)
{
    const long wide = 1L << level, nx = (long)p->shape.nx, rows = (long)p->rows.n;

    for (long y = 1 - wide; y < wide; y++)
        for (long x = 1 - wide; x < wide; x++) {
            const long at = (long)(i << level) + x, line = (long)(j << level) + y;
            if ((at < 0 && !p->boundary.x) || line < 0 || at >= nx || line >= rows)
                continue;
            map[line * nx + (at + nx) % nx] += strain * (1 - ldexp((double)labs(x), -(int)level)) *
                                               (1 - ldexp((double)labs(y), -(int)level));
        }
}

/* The equivalent strain of the row of voxels after the last one held here; NULL: there is none. */
static const double *
strain_after(const struct rc_yield_solver *p, size_t slab)
{
    const size_t level = rc_slabs_level(p->slabs, slab), nx = nodes_of(p, slab);
    const struct rc_voxel_row *row = p->rows.n > 0 ? rc_voxels_row(&p->voxels, slab, 0) : NULL;
    const struct rc_rows rows = {p->rows.ranks, p->rows.ny >> level, p->rows.first >> level,
                                 p->rows.n >> level};
    double *first = p->maps.beside, *before = first + nx, *after = before + nx;
    bool has[2] = {false, p->boundary.y};

    memset(first, 0, nx * sizeof *first);
    for (size_t k = 0; row != NULL && k < row->n; k++)
        first[row->v[k].i] = row->v[k].strain;
    if (rows.ranks == NULL)
        return has[1] ? first : NULL;
    rc_ranks_beside(&rows, p->boundary.y, nx * sizeof *first, first, first, before, after, has);
    return has[1] ? after : NULL;
}

/* The equivalent strain of a coarse slab on the nodes of the map. */
static void
spread_all(const struct rc_yield_solver *p, size_t slab, double *map)
{
    const size_t level = rc_slabs_level(p->slabs, slab), rows = p->rows.n >> level;
    const double *after = level > 0 ? strain_after(p, slab) : NULL;
    /* the row after the last one of the map is the first one of the next period */
    const bool round = p->rows.first + p->rows.n == p->rows.ny;

    for (size_t i = 0; i < nodes_of(p, slab) && after != NULL && round; i++)
        spread(p, level, i, rows, after[i], map);
    for (size_t j = 0; j < rows; j++) {
        const struct rc_voxel_row *row = rc_voxels_row(&p->voxels, slab, j);
        for (size_t k = 0; k < row->n; k++)
            spread(p, level, row->v[k].i, j, row->v[k].strain, map);
    }
    for (size_t i = 0; i < nodes_of(p, slab) && after != NULL && !round; i++)
        spread(p, level, i, rows, after[i], map);
}

void
rc_yield_solver_strain(const struct rc_yield_solver *p, size_t slab,
                       double *const e[RC_YIELD_STRAINS])
{
    const size_t nx = nodes_of(p, slab);

    for (size_t c = 0; c < RC_YIELD_STRAINS; c++) {
        if (e[c] == NULL)
            continue;
        memset(e[c], 0, p->n * sizeof *e[c]);
        if (c == RC_PEEQ) {
            spread_all(p, slab, e[c]);
            continue;
        }
        for (size_t j = 0; j < p->voxels.rows; j++) {
            const struct rc_voxel_row *row = rc_voxels_row(&p->voxels, slab, j);
            for (size_t k = 0; k < row->n; k++)
                e[c][j * nx + row->v[k].i] = row->v[k].e[c];
        }
        rc_slabs_refine(p->slabs, slab, e[c]);
    }
}

void
rc_yield_solver_free(struct rc_yield_solver *p)
{
    if (p == NULL)
        return;
    rc_solver_free(p->solver);
    rc_slabs_free(p->slabs);
    rc_voxels_free(&p->voxels);
    rc_store_free(&p->own);
    free(p);
}

enum rc_status
rc_yield_solver_check(const struct rc_yield_problem *problem, struct rc_err *err)
{
    const struct rc_body *one = &problem->contact.pair.one;

    if (rc_yield_law_check(&problem->law, err) != RC_OK)
        return RC_FAIL;
    if (problem->companion && problem->increments < 2)
        return rc_err_set(err, "a companion run needs a number of increments, at least 2");
    if (problem->contact.pair.estar > 0 || !(one->e > 0) || isinf(one->e))
        return rc_err_set(err, "plasticity needs E and nu of the body that yields");
    if (one->layers > 0)
        return rc_err_set(err, "plasticity in the volume is not implemented for layered bodies");
    if ((problem->contact.hardness > 0 && !isinf(problem->contact.hardness)) ||
        problem->contact.hardness_map != NULL)
        return rc_err_set(err, "hardness and volume plasticity exclude each other");
    if (!(one->nu < 0.5))
        return rc_err_set(
            err,
            "Poisson's ratio %g: a body that yields in its volume must be compressible, below 0.5",
            one->nu);
    return RC_OK;
}

static enum rc_status
make_room(struct rc_yield_solver *p, const double *h, const struct rc_yield_problem *problem,
          struct rc_err *err)
{
    size_t slabs = problem->slabs;

    p->maps.h = rc_store_copy(&p->own, p->n, sizeof *h, h);
    p->maps.u = rc_store_zeros(&p->own, p->n, sizeof *p->maps.u);
    p->maps.form = rc_store_take(&p->own, p->n, sizeof *p->maps.form);
    p->maps.other = rc_store_take(&p->own, p->n, sizeof *p->maps.other);
    p->maps.line = rc_store_take(&p->own, LINE_SUMS * p->lines + 1, sizeof *p->maps.line);
    p->maps.beside = rc_store_take(&p->own, 2 * p->shape.nx, sizeof *p->maps.beside);
    p->maps.some = rc_store_take(&p->own, slabs, sizeof *p->maps.some);
    p->maps.thickness =
        rc_store_copy(&p->own, slabs, sizeof *p->maps.thickness, problem->thickness);
    return rc_ranks_need(
        p->rows.ranks, !p->own.failed && rc_voxels_new(&p->voxels, slabs, p->rows.n) == RC_OK, err,
        "out of memory for the plasticity of %zu x %zu nodes", p->shape.nx, p->shape.ny);
}

struct rc_yield_solver *
rc_yield_solver_new(const struct rc_shape *shape, const double *h,
                    const struct rc_yield_problem *problem, struct rc_err *err)
{
    const struct rc_body *one = &problem->contact.pair.one;
    struct rc_problem contact = problem->contact;
    const struct rc_rows rows = rc_rows_of(contact.ranks, shape);
    struct rc_progress at;
    RC_OWN(rc_yield_solver, p) = NULL;
    struct rc_slabs_options options = {.slabs = problem->slabs,
                                       .thickness = problem->thickness,
                                       .shear = one->e / (2 * (1 + one->nu)),
                                       .nu = one->nu,
                                       .boundary = contact.boundary,
                                       .coarser = problem->precise ? 0 : RC_YIELD_COARSER,
                                       .precision = problem->precise ? RC_DOUBLE : RC_SINGLE,
                                       .threads = contact.threads,
                                       .ranks = contact.ranks};

    contact.hurry = NULL; /* an unfinished contact would change the strain */
    if (rc_yield_solver_check(problem, err) != RC_OK)
        return NULL;
    p = calloc(1, sizeof *p);
    if (rc_ranks_need(contact.ranks, p != NULL, err, "out of memory for a plan") != RC_OK)
        return NULL;
    *p = (struct rc_yield_solver){.shape = *shape,
                                  .rows = rows,
                                  .n = shape->nx * rows.n,
                                  .threads = rc_useful_threads(shape, contact.threads),
                                  .body = {.law = problem->law,
                                           .shear = options.shear,
                                           .nu = one->nu,
                                           .yield = rc_yield_law_stress(&problem->law, 0)},
                                  .asked.lag = problem->lag > 0 ? problem->lag : settled};
    rc_yield_solver_set_increments(p, problem->increments);
    /* the mean pressure causes a Mises stress of (1 - 2 nu)/2 times itself at every depth; on a profile
     * more */
    p->bearable = rc_has_mean(contact.boundary)
                      ? INFINITY
                      : 0.9 * 2 * p->body.yield / (1 - 2 * one->nu) *
                            (double)(shape->nx * shape->ny) * shape->dx * shape->dy;
    p->boundary = contact.boundary;
    if (rc_repeats(contact.boundary) == 1)
        p->lines = contact.boundary.x ? shape->nx : shape->ny;
    contact.approach = 0;
    if (contact.load == 0)
        contact.load = 1; /* placeholder; rc_yield_solver_set_load replaces it */
    if (make_room(p, h, problem, err) != RC_OK ||
        (p->slabs = rc_slabs_new(shape, &options, err)) == NULL ||
        (p->solver = rc_solver_new(shape, h, &contact, err)) == NULL)
        return NULL;
    rc_solver_progress(p->solver, &at);
    p->run.tol = p->asked.tol = at.tol;
    return rc_give(&p);
}
