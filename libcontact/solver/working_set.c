/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The working set, its residual, and the correction from it.
 *
 * The elastic nodes are in the set, and so are nodes at a bound that would leave it. Not every node that
 * penetrates the other body (p = 0 and g < 0, or the reverse at the upper bound) would join the contact. A
 * node beside an edge of contact penetrates a little where the pressure of the edge is about to decrease.
 * Once its neighbours fit, its pressure would be negative. With such nodes in the set the preconditioner uses
 * these negative pressures, the bound removes them, and the step is too long. At 2048 x 2048 and 50 % contact
 * this doubled the number of steps.
 *
 * The pressure that a node would get is z = A r, with A the inverse of the operator. r is the residual,
 * extended smoothly: (A r)_i ~ sum_j a_ij (r_i - r_j). On uniform bodies a_ij = |x_i - x_j|^(-3) decreases so
 * fast that the eight neighbours in the set give the sign of the sum. A node joins unless that sign is wrong.
 * So a node without neighbours in the set always joins, and so do all nodes once the residual of their
 * neighbours is near 0.
 *
 * Under a stiff coating a_ij alternates in sign, and nodes far beyond the neighbours count. Under such a
 * coating a node joins if its residual would keep its sign after the correction of the elastic nodes. K z
 * equals r on the set, and is about the extension E r outside it (preconditioner.h), so r_i must exceed E r.
 * The sets of a primal-dual active set method, whose systems are solved exactly, are the same except for the
 * error of E. On a map of 128 x 128 under a coating of two nodes with E_1/E_s = 400 that method took four
 * steps. Coatings of one to four nodes, E_1/E_s 100 and 400, 1 to 40 % contact at 512 x 512, took 9 to 23
 * equivalents. They took 10 to 25 when neighbours with a smaller residual had a smaller weight. Taking only
 * nodes with a positive z, from an additional correction, was far worse.
 *
 * The estimate that ends the iteration uses all nodes that want to leave their bounds.
 */
#include "solver.h"

#include <math.h>
#include <string.h>

#include "libcontact/memory.h"

enum {        /* bits of w during the removal of nodes */
    WAS = 1,  /* in the set before */
    WANTS = 2 /* at a bound, with a gap of the wrong sign */
};

enum {
    /* Elastic nodes; with so few, one of them may be wrong: see caution(). Half and double change the
     * estimates of 9 of 123 contacts (bench/constants.py), all of them with a hardness and few elastic
     * nodes. */
    FEW = 5
};

void
rc_working_set_forget(struct rc_solver *s)
{
    s->set.changed = INFINITY; /* the preconditioner has not been set */
}

enum rc_status
rc_working_set_new(struct rc_solver *s)
{
    s->set.w = rc_store_take(&s->own, s->posed.n, sizeof *s->set.w);
    s->set.r = rc_store_take(&s->own, s->posed.n, sizeof *s->set.r);
    if (s->posed.rows.ranks != NULL) {
        s->set.beside_w = rc_store_take(&s->own, 2 * s->posed.shape.nx, sizeof *s->set.beside_w);
        s->set.beside_r = rc_store_take(&s->own, 2 * s->posed.shape.nx, sizeof *s->set.beside_r);
    }
    if (s->own.failed)
        return RC_FAIL;
#pragma omp parallel for num_threads(s->posed.threads) schedule(static)
    for (size_t k = 0; k < s->posed.n; k++)
        s->set.w[k] = 0;
    rc_working_set_forget(s);
    return RC_OK;
}

/* ---- nodes that the next step would return to their bound ---- */

struct sift {
    struct rc_solver *s;
    float weight[3][3]; /* a_ij                                                    */
    bool ahead;         /* z holds the extension from the elastic nodes            */
    bool beside[2];     /* other ranks hold a row before and after those held here */
};

/* A row and the two next to it; NULL: outside the map. */
struct three {
    const unsigned char *w[3];
    const float *r[3];
};

static struct three
rows_about(const struct sift *c, size_t j)
{
    const struct rc_solver *s = c->s;
    size_t nx = s->posed.shape.nx, ny = s->posed.shape.ny;
    bool shared = s->posed.rows.ranks != NULL, round = s->posed.boundary.y;
    struct three t = {{NULL}, {NULL}};

    for (size_t b = 0; b < 3; b++) {
        size_t y = j + b; /* one more than the row */
        bool out = y == 0 || y > ny;
        if (out && shared) {
            t.w[b] = c->beside[b / 2] ? s->set.beside_w + b / 2 * nx : NULL;
            t.r[b] = c->beside[b / 2] ? s->set.beside_r + b / 2 * nx : NULL;
        } else if (!out || round) {
            y = y == 0 ? ny - 1 : y > ny ? 0 : y - 1;
            t.w[b] = s->set.w + y * nx;
            t.r[b] = s->set.r + y * nx;
        }
    }
    return t;
}

/* sum_j a_kj (r_k - r_j) over the neighbours of node i of a row that are in the set. `sign` -1 is for a node
 * at its upper bound: the sign is reversed. */
static float
pull(const struct sift *c, const struct three *t, size_t i, float sign)
{
    size_t nx = c->s->posed.shape.nx;
    bool round = c->s->posed.boundary.x;
    float own = t->r[1][i], sum = 0;

    for (size_t b = 0; b < 3; b++) {
        if (t->w[b] == NULL)
            continue;
        for (size_t a = 0; a < 3; a++) {
            size_t x = i + a;
            if ((x == 0 || x > nx) && !round)
                continue;
            x = x == 0 ? nx - 1 : x > nx ? 0 : x - 1;
            sum += t->w[b][x] != 0 ? c->weight[b][a] * sign * (own - t->r[b][x]) : 0;
        }
    }
    return sum;
}

/* Fetches the rows beside those held here. */
static void
look_beside(struct sift *c)
{
    struct rc_solver *s = c->s;
    size_t nx = s->posed.shape.nx, last = s->posed.n > 0 ? s->posed.n - nx : 0;
    bool round = s->posed.boundary.y;

    if (s->posed.rows.ranks == NULL)
        return;
    rc_ranks_beside(&s->posed.rows, round, nx * sizeof *s->set.w, s->set.w, s->set.w + last,
                    s->set.beside_w, s->set.beside_w + nx, c->beside);
    rc_ranks_beside(&s->posed.rows, round, nx * sizeof *s->set.r, s->set.r, s->set.r + last,
                    s->set.beside_r, s->set.beside_r + nx, c->beside);
}

/* The first node from k on that wants to join, or `end`. */
static size_t
next(const unsigned char *w, size_t k, size_t end)
{
    static const uint64_t wants = UINT64_C(0x0101010101010101) * WANTS;
    uint64_t eight;

    for (; k + 8 <= end; k += 8) {
        memcpy(&eight, w + k, sizeof eight);
        if ((eight & wants) != 0)
            break;
    }
    while (k < end && (w[k] & WANTS) == 0)
        k++;
    return k;
}

/* Sets z to 1 at the nodes marked WANTS that shall join, else to 0. Such a node is at its lower bound with r
 * > 0, or at its upper bound with r < 0. */
static void
decide(const struct sift *c)
{
    struct rc_solver *s = c->s;
    const struct rc_box box = rc_box(s, 0);
    size_t nx = s->posed.shape.nx;

#pragma omp parallel for num_threads(s->posed.threads) schedule(static)
    for (size_t j = 0; j < s->posed.shape.ny; j++) {
        struct three t = rows_about(c, j);
        for (size_t k = next(s->set.w, j * nx, (j + 1) * nx); k < (j + 1) * nx;
             k = next(s->set.w, k + 1, (j + 1) * nx)) {
            float sign = rc_at_low(box, k, s->it.p[k]) ? 1.0F : -1.0F;
            float more = c->ahead ? sign * (s->set.r[k] - s->z[k]) : pull(c, &t, k - j * nx, sign);
            s->z[k] = more < 0 ? 0.0F : 1.0F;
        }
    }
}

enum { /* sums */
    RESIDUAL,
    OUT,
    CHANGED,
    SIZE,
    SATURATED
};

static void
settle_block(void *at, size_t first, size_t n, double *sums)
{
    struct rc_solver *s = at;
    const struct rc_box box = rc_box(s, 0);

    for (size_t k = next(s->set.w, first, first + n); k < first + n;
         k = next(s->set.w, k + 1, first + n)) {
        bool was = (s->set.w[k] & WAS) != 0, in = s->z[k] > 0;
        s->set.w[k] = in;
        if (in)
            continue;
        sums[RESIDUAL] += (double)s->set.r[k];
        sums[OUT]++;
        sums[SATURATED] += rc_at_low(box, k, s->it.p[k]) ? 0 : rc_room(box, k);
        sums[SIZE] += fabs((double)s->set.r[k]);
        sums[CHANGED] += was ? 1 : -1; /* the previous pass counted it as a joining node */
        s->set.r[k] = 0;
    }
}

/* Removes nodes from the set that the next step would return to their bound. Corrects the sum of the
 * residual, the number of nodes and the number of changes. Uses z. */
static void
sift_out(struct rc_solver *s, double *residual, double *count, double *changed)
{
    double total[RC_SUMS];
    struct sift c = {.s = s, .ahead = s->op->bends};

    for (int b = 0; b < 3; b++)
        for (int a = 0; a < 3; a++)
            c.weight[b][a] = (float)s->op->near.neighbour[b][a];
    if (c.ahead) {
        rc_preconditioner_extend(s->preconditioner, s->set.w, s->set.r, s->z);
        rc_working_set_forget(s);
    } else {
        look_beside(&c);
    }
    decide(&c);
    rc_reduce_blocks(s, settle_block, s, total);
    *residual -= total[RESIDUAL];
    *count -= total[OUT];
    *changed += total[CHANGED];
    s->set.saturated += total[SATURATED];
    s->set.left_out = s->op->near.inverse[1][1] * total[SIZE];
}

/* ---- the set and its residual ---- */

/* Context of the pass over all nodes; its sums are the first of those above. */
struct residual {
    struct rc_solver *s;
    unsigned char wants; /* the mark of a node at a bound with a gap of the wrong sign */
    const float *q;      /* v += factor q; NULL: v stays                               */
    double factor;
};

enum {
    STRETCH = 64 /* nodes that are processed together */
};

RC_CLONES static bool
any_of(size_t n, const unsigned char *w)
{
    unsigned any = 0;

#pragma omp simd reduction(| : any)
    for (size_t k = 0; k < n; k++)
        any |= w[k];
    return any != 0;
}

size_t
rc_working_set_stretch(const struct rc_solver *s, size_t first, size_t n, bool *in)
{
    size_t k = n < STRETCH ? n : STRETCH;

    if (!rc_bare(&s->posed.bounds)) {
        *in = true;
        return n;
    }
    *in = any_of(k, s->set.w + first);
    while (k < n) {
        size_t some = n - k < STRETCH ? n - k : STRETCH;
        if (any_of(some, s->set.w + first + k) != *in)
            break;
        k += some;
    }
    return k;
}

/* Products in place of conditionals: gcc makes branches of chains of them. */
RC_INLINE void
residual_in(struct rc_box box, size_t n, const double *restrict p, const double *restrict v,
            double shift, double scale, unsigned char wants, unsigned char *restrict w,
            float *restrict r, double *restrict sums)
{
    const unsigned char kept = wants >> 1;
    double sum = 0, count = 0, saturated = 0;
    unsigned char side[RC_BLOCK_NODES]; /* 0: stays at its bound, 1: elastic, 2: leaves its bound */
    float is[RC_BLOCK_NODES];
    size_t changed = 0;

#pragma omp simd reduction(+ : sum, count, saturated)
    for (size_t k = 0; k < n; k++) {
        double g = v[k] - shift, most = rc_high(box, k), under = g < 0 ? 1 : 0;
        double low = p[k] <= rc_low(box, k) ? 1 : 0, high = p[k] >= most ? 1 : 0;
        double stays = g > 0 ? 0 : 1, leaves = low * under + (1 - low) * high * (1 - stays);
        double in = (1 - low) * (1 - high) + leaves, to = in > 0 ? -g * scale : 0;
        r[k] = (float)to;
        is[k] = (float)(in + leaves);
        sum += to;
        count += in;
        saturated += high > 0 ? stays * rc_room(box, k) : 0;
    }
#pragma omp simd
    for (size_t k = 0; k < n; k++)
        side[k] = (unsigned char)(int)is[k];
#pragma omp simd reduction(+ : changed)
    for (size_t k = 0; k < n; k++) {
        unsigned char was = w[k], mark = (unsigned char)(wants | (was & kept));
        w[k] = side[k] == 2 ? mark : side[k];
        changed += (w[k] > 0) ^ (was > 0);
    }
    sums[RESIDUAL] += sum;
    sums[OUT] += count;
    sums[CHANGED] += (double)changed;
    sums[SATURATED] += saturated;
}

RC_CLONES static void
residual_of(struct rc_box box, size_t n, const double *p, const double *v, double shift,
            double scale, unsigned char wants, unsigned char *w, float *r, double *sums)
{
    if (box.highs == NULL)
        residual_in(rc_box_of_numbers(box), n, p, v, shift, scale, wants, w, r, sums);
    else
        residual_in(box, n, p, v, shift, scale, wants, w, r, sums);
}

/* True if one of the nodes wants to join. */
RC_CLONES static bool
some_want(size_t n, const double *v, double shift)
{
    int any = 0;

#pragma omp simd reduction(| : any)
    for (size_t k = 0; k < n; k++)
        any |= v[k] < shift;
    return any != 0;
}

/* In a stretch off the set without pressure where no node wants to join, pressures are not read. */
static void
residual_block(void *at, size_t first, size_t n, double *sums)
{
    const struct residual *c = at;
    struct rc_solver *s = c->s;
    double shift = s->it.shift;

    for (size_t k = first, some; k < first + n; k += some) {
        bool in = true;
        some = first + n - k;
        if (c->q != NULL) {
            some = rc_working_set_stretch(s, k, some, &in);
            rc_iterate_follow(some, c->q + k, c->factor, s->it.v + k);
        }
        if (in || some_want(some, s->it.v + k, shift))
            residual_of(rc_box(s, k), some, s->it.p + k, s->it.v + k, shift, 1 / s->load.length,
                        c->wants, s->set.w + k, s->set.r + k, sums);
    }
}

static void
find(struct residual *c)
{
    struct rc_solver *s = c->s;
    double total[RC_SUMS];

    rc_reduce_blocks(s, residual_block, c, total);
    s->set.left_out = 0;
    s->set.whole = c->wants != WANTS;
    s->set.saturated = total[SATURATED];
    if (c->wants == WANTS)
        sift_out(s, &total[RESIDUAL], &total[OUT], &total[CHANGED]);
    s->set.size = (size_t)total[OUT];
    s->set.offset = s->set.size > 0 ? (float)(total[RESIDUAL] / total[OUT]) : 0;
    s->set.changed += total[CHANGED];
    s->set.turnover = total[CHANGED] / fmax(total[OUT], 1);
}

void
rc_working_set_find(struct rc_solver *s, bool sift)
{
    struct residual c = {.s = s, .wants = sift ? WANTS : 1};

    find(&c);
}

void
rc_working_set_follow(struct rc_solver *s, const float *q, double factor)
{
    struct residual c = {.s = s, .wants = WANTS, .q = q, .factor = factor};

    find(&c);
}

void
rc_working_set_all(struct rc_solver *s)
{
    memset(s->set.w, 1, s->posed.n);
    rc_working_set_forget(s);
}

struct fixed {
    struct rc_solver *s;
    bool touching;
};

static void
fix_block(void *at, size_t first, size_t n, double *sums)
{
    const struct fixed *c = at;
    struct rc_solver *s = c->s;
    const struct rc_box box = rc_box(s, 0);

    for (size_t k = first; k < first + n; k++) {
        s->set.w[k] = c->touching ? !rc_at_low(box, k, s->it.p[k]) : rc_elastic(s, k);
        s->set.r[k] = s->set.w[k];
        sums[0] += s->set.w[k];
    }
}

size_t
rc_working_set_fix(struct rc_solver *s, bool touching)
{
    struct fixed c = {s, touching};
    double total[RC_SUMS];

    rc_reduce_blocks(s, fix_block, &c, total);
    rc_working_set_forget(s);
    s->set.size = (size_t)total[0];
    s->set.offset = 0;
    return s->set.size;
}

/* ---- the correction and the estimated error ---- */

/* The fraction of the working set that may change before the preconditioner is set anew. Not sensitive:
 * half and double change no count of 123 contacts (bench/constants.py). */
static const double little = 1e-3;

void
rc_working_set_tell(struct rc_solver *s)
{
    struct rc_working_set *set = &s->set;

    if (set->changed <= little * (double)set->size)
        return;
    rc_preconditioner_set(s->preconditioner, set->w);
    set->changed = 0;
}

void
rc_working_set_spread(struct rc_solver *s)
{
    if (!s->op->edges || s->set.size < 2)
        return;
    rc_working_set_tell(s);
    rc_preconditioner_spread(s->preconditioner, s->z);
    rc_iterate_count(s, rc_preconditioner_factors(s->preconditioner) * s->op->factor_cost);
}

void
rc_working_set_correct(struct rc_solver *s, rc_row *done, void *ctx)
{
    struct rc_working_set *set = &s->set;

    rc_working_set_tell(s);
    rc_preconditioner_apply(s->preconditioner, set->r, set->offset, s->z, done, ctx);
    rc_iterate_count(s, rc_preconditioner_factors(s->preconditioner) * s->op->factor_cost);
}

struct size {
    struct rc_solver *s;
    double share; /* share of M 1 in z */
};

/* Takes the pressure of the common shift out of z. */
RC_CLONES static void
centre(size_t n, const unsigned char *restrict w, const float *restrict node, float share,
       float *restrict z, double *sums)
{
    double size = 0;

#pragma omp simd reduction(+ : size)
    for (size_t k = 0; k < n; k++) {
        float e = z[k] - share * rc_load_share(node[k]);
        e = w[k] ? e : 0;
        z[k] = e;
        size += (double)fabsf(e);
    }
    sums[0] = size;
}

static void
size_block(void *at, size_t first, size_t n, double *sums)
{
    const struct size *c = at;
    const struct rc_solver *s = c->s;

    centre(n, s->set.w + first, rc_preconditioner_nodes(s->preconditioner) + first, (float)c->share,
           s->z + first, sums);
}

/* The energy of z is at least that of the error, but its L1 norm can be smaller. Where few waves carry
 * the error some of them can cancel. Maps have many waves, profiles have few. For 2212 periodic
 * profiles the norm of z was 0.982 to 2.2 of the error. It was 0.96 to 1.11 for 512 free ones, and 0.74
 * under coatings with five elastic nodes. Where nearly all loaded nodes yield, there are as few waves
 * as elastic nodes, and one of those may be wrong. For 955 such contacts with 1 to 13 elastic nodes the
 * norm of z was up to 33 of the error. The smallest was 0.63 (one elastic node) and 0.89 (three). With
 * a diagonal term E' A E is nearly exact. For 1200 small maps the norm was 0.9998 to 1.8 of the error,
 * half of them below 1.02. Where D differs by node, by a factor of 2 to 100 or from 0 on, it was 0.51
 * to 2 of the error of 400 small maps. It was below 1 for a tenth of them. Where rows move, it was at
 * least 0.82 of the error of 667 small maps. Maps that repeat along one axis may hold few waves, too.
 * For 17000 such maps, rough or of nearly equal rows, bare or coated, the norm was 0.957 of the error
 * or more, and 0.92 with five elastic nodes. */
static double
caution(const struct rc_solver *s)
{
    bool line = s->posed.whole.nx == 1 || s->posed.whole.ny == 1;

    if (rc_bounded(&s->posed.bounds) && s->it.elastic < FEW)
        return 1 + 1 / fmax((double)s->it.elastic, 1);
    if (line)
        return 1.05 + 2 / fmax((double)s->it.elastic, 1);
    if (s->op->soft.row > 0)
        return 1.5;
    if (s->op->soft.part != NULL)
        return 3;
    if (rc_repeats(s->posed.boundary) == 1)
        return 1.05 + 0.5 / fmax((double)s->it.elastic, 1);
    return s->op->soft.plus > 0 ? 1.01 : 1;
}

double
rc_working_set_error(struct rc_solver *s, double share)
{
    struct size c = {.s = s, .share = share};
    double total[RC_SUMS], unit = s->load.per_pressure * s->load.sum;

    rc_reduce_blocks(s, size_block, &c, total);
    if (s->it.elastic == 0 && s->set.size > 0)
        return INFINITY; /* nodes want to move, but no gap gives the distance */
    return caution(s) * (total[0] + s->set.left_out) / unit + rc_iterate_operator_error(s);
}

enum { /* sums of the shift; GAP: by the shares */
    Z,
    LOAD,
    GAP = Z
};

static void
share_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_solver *s = at;
    const float *node = rc_preconditioner_nodes(s->preconditioner);

    for (size_t k = first; k < first + n; k++) {
        sums[Z] += (double)s->z[k];
        sums[LOAD] += s->set.w[k] ? (double)rc_load_share(node[k]) : 0;
    }
}

double
rc_working_set_estimate(struct rc_solver *s)
{
    double total[RC_SUMS];

    if (s->set.size < 2 && s->set.size == s->it.elastic)
        return 0; /* no load to exchange, and no node wants to move */
    if (s->it.elastic == 0)
        return INFINITY; /* nodes want to move, but no gap gives the distance */
    rc_working_set_spread(s);
    rc_working_set_correct(s, NULL, NULL);
    rc_reduce_blocks(s, share_block, s, total);
    return rc_working_set_error(s, total[Z] / total[LOAD]);
}

static void
gap_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_solver *s = at;
    const float *node = rc_preconditioner_nodes(s->preconditioner);

    for (size_t k = first; k < first + n; k++) {
        const double share = s->set.w[k] ? (double)rc_load_share(node[k]) : 0;
        sums[GAP] += share * s->it.v[k];
        sums[LOAD] += share;
    }
}

double
rc_working_set_shift(struct rc_solver *s)
{
    double total[RC_SUMS];

    if (s->set.size < 2)
        return s->it.shift;
    rc_reduce_blocks(s, gap_block, s, total);
    return total[GAP] / total[LOAD];
}
