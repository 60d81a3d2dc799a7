/*
 * The conductance of a network between inlet and outlet, by eliminating node after node (star-mesh
 * transformation). A node with conductances c_1 .. c_m to its neighbours is replaced by faces c_i c_j / d
 * between each pair of them, with d the sum of all c. Inlet and outlet are neighbours too; the face that
 * joins them at the end is the conductance.
 *
 * This is Gaussian elimination with factors L D L'. But d is a sum of the present conductances, not a
 * difference of the original and the eliminated ones (Grassmann, Taksar and Heyman, Oper. Res. 33, 1985,
 * 1107). All numbers are positive, and only sums, products and quotients are formed, so each number is
 * accurate to rounding however much conductances differ. Cholesky's method loses pools connected by faces of
 * 1e-16 of those inside.
 *
 * Column by column from the left: column j holds the conductances from node j to nodes that are eliminated
 * later. It collects contributions from the earlier columns that contain node j. Each of these waits in a
 * list of the next node that it will reach.
 */
#include "leak.h"

#include <math.h>
#include <stdlib.h>

#include "libcontact/memory.h"

struct rc_elimination {
    int32_t n;
    int32_t *place;         /* place of each node of the map in the order; -1: no flow */
    int32_t *node;          /* the inverse of place                                    */
    size_t *start;          /* column j: start[j] .. start[j + 1] - 1                  */
    int32_t *row;           /* increasing; NULL: not yet known                         */
    double *c;              /* conductances                                            */
    double *in, *out, *sum; /* conductances of column j: to inlet, to outlet, sum of all */
    double *work;           /* the present column, by place; later the levels */
    double *rest;
    size_t *at; /* place in the column of the next node that it contributes to */
    /* the first column that waits for node j; the next one after column k */
    int32_t *waits, *after;
};

/* Neighbours of the node in place j that were eliminated before it, by their places. */
static int
earlier(const struct rc_elimination *e, const struct rc_passage *a, int32_t j, int32_t *list)
{
    int n = 0;

    for (int d = 0; d < RC_DIRECTIONS; d++) {
        int32_t other = rc_passage_beside(a, e->node[j], (enum rc_direction)d);
        if (other >= 0 && other < a->nodes && e->place[other] >= 0 && e->place[other] < j)
            list[n++] = e->place[other];
    }
    return n;
}

/* ---- the order ---- */

static enum rc_status
set_order(struct rc_elimination *e, const struct rc_passage *a, struct rc_err *err)
{
    size_t n = (size_t)e->n, nz = 0;
    int32_t *start = malloc((n + 1) * sizeof *start);
    int32_t *row = malloc((RC_DIRECTIONS * n + 1) * sizeof *row);
    int32_t *order = malloc((n + 1) * sizeof *order);
    enum rc_status status = RC_FAIL;

    if (start == NULL || row == NULL || order == NULL) {
        rc_err_set(err, "out of memory for the order of %zu nodes with fluid", n);
        goto done;
    }
    for (int32_t j = 0; j < e->n; j++) {
        start[j] = (int32_t)nz;
        for (int d = 0; d < RC_DIRECTIONS; d++) {
            int32_t other = rc_passage_beside(a, e->node[j], (enum rc_direction)d);
            if (other >= 0 && other < a->nodes && e->place[other] >= 0)
                row[nz++] = e->place[other];
        }
    }
    start[n] = (int32_t)nz;
    if (n > 0 && rc_ordering(e->n, start, row, order, err) != RC_OK)
        goto done;
    for (size_t j = 0; j < n; j++)
        order[j] = e->node[order[j]];
    for (int32_t j = 0; j < e->n; j++) {
        e->node[j] = order[j];
        e->place[order[j]] = j;
    }
    status = RC_OK;
done:
    free(start);
    free(row);
    free(order);
    return status;
}

/* Lengths of the columns. Row i of L contains the places between the neighbours of node i and i in a tree. In
 * this tree the parent of a column is its first row (Liu, SIAM J. Matrix Anal. Appl. 11, 1990, 134). */
static enum rc_status
count_columns(struct rc_elimination *e, const struct rc_passage *a, struct rc_err *err)
{
    size_t n = (size_t)e->n;
    int32_t *parent = malloc((n + 1) * sizeof *parent), *seen = malloc((n + 1) * sizeof *seen);
    enum rc_status status = RC_FAIL;

    if (parent == NULL || seen == NULL) {
        rc_err_set(err, "out of memory for the order of %zu nodes with fluid", n);
        goto done;
    }
    for (int32_t i = 0; i < e->n; i++) {
        int32_t list[RC_DIRECTIONS];
        parent[i] = -1;
        seen[i] = i;
        e->start[i + 1] = 0;
        for (int m = earlier(e, a, i, list); m > 0; m--)
            for (int32_t k = list[m - 1]; seen[k] != i; k = parent[k]) {
                if (parent[k] < 0)
                    parent[k] = i;
                seen[k] = i;
                e->start[k + 1]++;
            }
    }
    e->start[0] = 0;
    for (size_t j = 0; j < n; j++)
        e->start[j + 1] += e->start[j];
    status = RC_OK;
done:
    free(parent);
    free(seen);
    return status;
}

struct rc_elimination *
rc_elimination_new(const struct rc_passage *a, struct rc_err *err)
{
    struct rc_elimination *e = calloc(1, sizeof *e);
    size_t n = 0;

    for (int32_t k = 0; k < a->nodes; k++)
        n += a->state[k] == RC_FLOWS;
    if (e == NULL || (e->place = malloc((size_t)a->nodes * sizeof *e->place)) == NULL ||
        (e->node = malloc((n + 1) * sizeof *e->node)) == NULL ||
        (e->start = malloc((n + 1) * sizeof *e->start)) == NULL) {
        rc_err_set(err, "out of memory for the flow through %zu x %zu nodes", a->nx, a->ny);
        goto failed;
    }
    if (n > INT32_MAX / RC_DIRECTIONS) {
        rc_err_set(err, "%zu nodes with fluid are more than can be ordered: cut the map", n);
        goto failed;
    }
    for (int32_t k = 0; k < a->nodes; k++) {
        e->place[k] = -1;
        if (a->state[k] == RC_FLOWS) {
            e->place[k] = e->n;
            e->node[e->n++] = k;
        }
    }
    if (set_order(e, a, err) == RC_OK && count_columns(e, a, err) == RC_OK)
        return e;
failed:
    rc_elimination_free(e);
    return NULL;
}

/* ---- elimination ---- */

static void
drop_room(struct rc_elimination *e)
{
    free(e->row);
    free(e->c);
    free(e->in); /* with the other arrays of a number for each column */
    e->row = NULL;
    e->c = e->in = NULL;
}

static enum rc_status
make_room(struct rc_elimination *e, struct rc_err *err)
{
    size_t n = (size_t)e->n + 1, entries = e->start[e->n];

    e->row = rc_alloc(entries, sizeof *e->row);
    e->c = rc_alloc(entries, sizeof *e->c);
    e->in = rc_alloc(n, 5 * sizeof *e->in + sizeof *e->at + 2 * sizeof *e->waits);
    if (e->row == NULL || e->c == NULL || e->in == NULL) {
        drop_room(e);
        return rc_err_set(err,
                          "out of memory for the flow through %d nodes, %zu faces between them",
                          e->n, entries);
    }
    e->out = e->in + n;
    e->sum = e->out + n;
    e->work = e->sum + n;
    e->rest = e->work + n;
    e->at = (size_t *)(void *)(e->rest + n);
    e->waits = (int32_t *)(void *)(e->at + n);
    e->after = e->waits + n;
    return RC_OK;
}

/* The nodes in each column: as count_columns; the parent of k is the first row of column k. */
static void
list_rows(struct rc_elimination *e, const struct rc_passage *a)
{
    for (int32_t i = 0; i < e->n; i++) {
        int32_t list[RC_DIRECTIONS];
        e->at[i] = e->start[i];
        e->waits[i] = i; /* the last row that contained i */
        for (int m = earlier(e, a, i, list); m > 0; m--)
            for (int32_t k = list[m - 1]; e->waits[k] != i; k = e->row[e->start[k]]) {
                e->row[e->at[k]++] = i;
                e->waits[k] = i;
            }
    }
}

/* The faces of the map from the node in place j to later nodes, to inlet and to outlet. */
static void
own_faces(struct rc_elimination *e, const struct rc_passage *a, enum rc_face_rule rule, int32_t j)
{
    e->in[j] = e->out[j] = 0;
    for (size_t p = e->start[j]; p < e->start[j + 1]; p++)
        e->work[e->row[p]] = 0;
    for (int d = 0; d < RC_DIRECTIONS; d++) {
        int32_t k = e->node[j], other = rc_passage_beside(a, k, (enum rc_direction)d);
        double c;
        if (other < 0 || (other < a->nodes && e->place[other] < j))
            continue;
        c = rc_face(a, rule, k, other, (enum rc_direction)d);
        if (other == a->inlet)
            e->in[j] += c;
        else if (other == a->outlet)
            e->out[j] += c;
        else
            e->work[e->place[other]] += c;
    }
}

/* Adds column k to the list of the next node that it reaches. */
static void
let_wait(struct rc_elimination *e, int32_t k)
{
    int32_t next;

    if (e->at[k] == e->start[k + 1])
        return;
    next = e->row[e->at[k]];
    e->after[k] = e->waits[next];
    e->waits[next] = k;
}

/* Adds the faces that the elimination of node k creates between node j, its neighbour at e->at[k], and later
 * nodes. */
static void
collect(struct rc_elimination *e, int32_t j, int32_t k)
{
    const size_t from = e->at[k], to = e->start[k + 1];
    const double part = e->c[from] / e->sum[k];
    const int32_t *restrict row = e->row;
    const double *restrict c = e->c;
    double *restrict work = e->work;

    for (size_t p = from + 1; p < to; p++)
        work[row[p]] += part * c[p];
    e->in[j] += part * e->in[k];
    e->out[j] += part * e->out[k];
}

enum rc_status
rc_elimination_run(struct rc_elimination *e, const struct rc_passage *a, enum rc_face_rule rule,
                   double *conductance, struct rc_err *err)
{
    if (e->row == NULL) {
        if (make_room(e, err) != RC_OK)
            return RC_FAIL;
        list_rows(e, a);
    }
    for (int32_t j = 0; j < e->n; j++)
        e->waits[j] = -1;
    *conductance = 0;
    for (int32_t j = 0; j < e->n; j++) {
        double sum = 0;
        own_faces(e, a, rule, j);
        for (int32_t k = e->waits[j], next; k >= 0; k = next) {
            next = e->after[k];
            collect(e, j, k);
            e->at[k]++;
            let_wait(e, k);
        }
        for (size_t p = e->start[j]; p < e->start[j + 1]; p++)
            sum += e->c[p] = e->work[e->row[p]];
        e->sum[j] = sum + e->in[j] + e->out[j];
        *conductance += e->in[j] / e->sum[j] * e->out[j];
        e->at[j] = e->start[j];
        let_wait(e, j);
    }
    return RC_OK;
}

/* The level of the node in place j is a weighted mean of its neighbours' levels. It is computed as a
 * difference from the neighbour with the largest conductance. So rounding of the weights only affects the
 * differences between neighbours. */
static void
set_level(struct rc_elimination *e, int32_t j)
{
    const size_t from = e->start[j], to = e->start[j + 1];
    double p = e->in[j] > e->out[j] ? 1 : 0, rest = 0, best = fmax(e->in[j], e->out[j]), step, sum;

    for (size_t q = from; q < to; q++)
        if (e->c[q] > best) {
            best = e->c[q];
            p = e->work[e->row[q]];
            rest = e->rest[e->row[q]];
        }
    step = e->in[j] * rc_level_difference(1, 0, p, rest) +
           e->out[j] * rc_level_difference(0, 0, p, rest);
    for (size_t q = from; q < to; q++)
        step += e->c[q] * rc_level_difference(e->work[e->row[q]], e->rest[e->row[q]], p, rest);
    step /= e->sum[j];
    sum = p + step;
    rest += (p - (sum - (sum - p))) + (step - (sum - p));
    e->work[j] = sum + rest;
    e->rest[j] = rest - (e->work[j] - sum);
}

void
rc_elimination_levels(struct rc_elimination *e, const struct rc_levels *levels)
{
    for (int32_t j = e->n - 1; j >= 0; j--) {
        set_level(e, j);
        levels->p[e->node[j]] = e->work[j];
        levels->rest[e->node[j]] = e->rest[j];
    }
}

void
rc_elimination_free(struct rc_elimination *e)
{
    if (e == NULL)
        return;
    drop_room(e);
    free(e->place);
    free(e->node);
    free(e->start);
    free(e);
}
