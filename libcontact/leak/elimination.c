/* SPDX-License-Identifier: GPL-3.0-or-later */
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
 * The multifrontal method (Duff and Reid, ACM Trans. Math. Softw. 9, 1983, 302): the nodes of a separator, or
 * of a small region, and the later nodes that they reach form a front, a dense matrix of conductances. Its
 * first nodes are eliminated, the conductances between the others are passed on. The levels need the rows of
 * all eliminated nodes. On large maps only the large fronts keep them; the rows of the small ones are
 * computed again, region after region.
 */
#include "leak.h"

#include <stdlib.h>
#include <string.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#include "libcontact/common.h"
#include "libcontact/memory.h"

enum {
    TILE = 8,    /* rows and columns of a block that registers hold */
    PANEL = 32,  /* rows eliminated together                        */
    TASK = 4096, /* nodes of a region that a thread takes           */
    WIDE = 512   /* a front from here on is shared by threads       */
};

/* Conductances between n nodes: the rows of the first ones, or of all, without the part up to the diagonal.
 * at: places in the order, increasing; inlet and outlet are the last ones. */
struct front {
    struct front *next;
    int32_t n;
    int32_t *at;
    double c[];
};

struct rc_elimination {
    const struct rc_passage *a;
    enum rc_face_rule rule;
    int threads;
    struct rc_order order;
    int32_t
        *place; /* place of each node of the map in the order, then inlet and outlet; -1: no flow */
    struct front **kept; /* rows of the eliminated nodes of each part */
    double **work;       /* of each thread, for fronts below WIDE     */
    bool short_of_memory;
    struct rc_store own;
};

static int
this_thread(void)
{
#ifdef _OPENMP
    return omp_get_thread_num();
#else
    return 0;
#endif
}

/* Numbers in a front of n nodes, with space for tiles beyond its end, and with PANEL more rows. */
static size_t
work_size(size_t n)
{
    size_t stride = n + 2 * TILE;

    return stride * (stride + PANEL);
}

struct rc_elimination *
rc_elimination_new(const struct rc_passage *a, int threads, struct rc_err *err)
{
    RC_OWN(rc_elimination, e) = calloc(1, sizeof *e);
    size_t nodes = (size_t)a->nodes;

    if (e == NULL)
        return rc_err_null(err, "out of memory for a plan");
    *e = (struct rc_elimination){.a = a, .threads = threads};
    if (rc_order_set(&e->order, a, err) != RC_OK)
        return NULL;
    e->place = rc_store_take(&e->own, nodes + 2, sizeof *e->place);
    e->kept = rc_store_zeros(&e->own, (size_t)e->order.parts + 1, sizeof *e->kept);
    e->work = rc_store_zeros(&e->own, (size_t)threads, sizeof *e->work);
    for (int t = 0; t < threads && e->work != NULL; t++)
        e->work[t] = rc_store_take(&e->own, work_size(WIDE), sizeof **e->work);
    if (e->own.failed)
        return rc_err_null(err, "out of memory for the flow through %zu x %zu nodes", a->nx, a->ny);
    for (size_t k = 0; k < nodes; k++)
        e->place[k] = -1;
    for (int32_t j = 0; j < e->order.n; j++)
        e->place[e->order.node[j]] = j;
    e->place[a->inlet] = e->order.n;
    e->place[a->outlet] = e->order.n + 1;
    return rc_give(&e);
}

/* ---- one front ---- */

/* Where row k of a front begins, with the column after the diagonal. */
static size_t
row_at(int32_t n, int32_t k)
{
    return (size_t)k * (size_t)(2 * n - k - 1) / 2;
}

static struct front *
new_front(int32_t n, int32_t rows, const int32_t *at)
{
    struct front *f =
        malloc(sizeof *f + row_at(n, rows) * sizeof *f->c + (size_t)n * sizeof *f->at);

    if (f != NULL) {
        f->next = NULL;
        f->n = n;
        f->at = (int32_t *)(void *)(f->c + row_at(n, rows));
        memcpy(f->at, at, (size_t)n * sizeof *at);
    }
    return f;
}

static void
free_fronts(struct front *f)
{
    for (struct front *next; f != NULL; f = next) {
        next = f->next;
        free(f);
    }
}

/* The union of two increasing lists, without places before `first`. */
static int32_t
unite(int32_t *to, const int32_t *a, int32_t na, const int32_t *b, int32_t nb, int32_t first)
{
    int32_t n = 0, i = 0, j = 0;

    while (i < na && a[i] < first)
        i++;
    while (j < nb && b[j] < first)
        j++;
    while (i < na || j < nb) {
        int32_t p = j == nb || (i < na && a[i] <= b[j]) ? a[i] : b[j];
        i += i < na && a[i] == p;
        j += j < nb && b[j] == p;
        to[n++] = p;
    }
    return n;
}

/* Places after the part that its own nodes face. */
static int32_t
own_neighbours(const struct rc_elimination *e, const struct rc_part *p, int32_t *list)
{
    int32_t n = 0;

    for (int32_t j = p->cut; j < p->hi; j++)
        for (int d = 0; d < RC_DIRECTIONS; d++) {
            int32_t other = rc_passage_beside(e->a, e->order.node[j], (enum rc_direction)d), m;
            if (other < 0 || e->place[other] < p->hi)
                continue;
            for (m = n; m > 0 && list[m - 1] > e->place[other]; m--)
                continue;
            if (m > 0 && list[m - 1] == e->place[other])
                continue;
            memmove(list + m + 1, list + m, (size_t)(n - m) * sizeof *list);
            list[m] = e->place[other];
            n++;
        }
    return n;
}

/* The nodes of a front: those of the part, then the later ones that they and the sides reach. The list has
 * room for as many more. */
static int32_t *
list_nodes(const struct rc_elimination *e, const struct rc_part *p, const struct front *sides,
           int32_t *n)
{
    int32_t own = p->hi - p->cut, later;
    size_t most = (size_t)(RC_DIRECTIONS * own);
    int32_t *list, *other;

    for (const struct front *f = sides; f != NULL; f = f->next)
        most += (size_t)f->n;
    list = malloc(2 * ((size_t)own + most) * sizeof *list);
    if (list == NULL)
        return NULL;
    other = list + own + most;
    for (int32_t j = 0; j < own; j++)
        list[j] = p->cut + j;
    later = own_neighbours(e, p, list + own);
    for (const struct front *f = sides; f != NULL; f = f->next) {
        memcpy(other, list + own, (size_t)later * sizeof *list);
        later = unite(list + own, other, later, f->at, f->n, p->hi);
    }
    *n = own + later;
    return list;
}

/* Adds the faces of the map from the nodes of the part to later ones. */
static void
add_faces(const struct rc_elimination *e, const struct rc_part *p, const int32_t *at, int32_t n,
          double *c, size_t stride)
{
    for (int32_t j = p->cut; j < p->hi; j++)
        for (int d = 0; d < RC_DIRECTIONS; d++) {
            int32_t k = e->order.node[j], other = rc_passage_beside(e->a, k, (enum rc_direction)d);
            int32_t place = other < 0 ? -1 : e->place[other], low = p->hi - p->cut, high = n;
            if (place < j)
                continue;
            while (place >= p->hi && high - low > 1) {
                int32_t middle = (low + high) / 2;
                *(at[middle] <= place ? &low : &high) = middle;
            }
            c[(size_t)(j - p->cut) * stride + (size_t)(place < p->hi ? place - p->cut : low)] +=
                rc_face(e->a, e->rule, k, other, (enum rc_direction)d);
        }
}

/* Adds the conductances that a side passes on; column: room for its columns in the front. */
static void
add_side(const struct front *f, const int32_t *at, int32_t *column, double *c, size_t stride)
{
    const double *from = f->c;

    for (int32_t i = 0, k = 0; i < f->n; i++) {
        while (at[k] < f->at[i])
            k++;
        column[i] = k;
    }
    for (int32_t i = 0; i < f->n; i++) {
        double *row = c + (size_t)column[i] * stride;
        for (int32_t j = i + 1; j < f->n; j++)
            row[column[j]] += *from++;
    }
}

/* Eliminates rows first .. last - 1 from each other; part[i * PANEL + k - first] is c_i/d of row k for
 * the nodes i after them. */
RC_WIDE_CLONES static void
eliminate_panel(double *c, size_t stride, size_t n, size_t first, size_t last, double *part)
{
    double share[PANEL];

    for (size_t k = first; k < last; k++) {
        const double *restrict row = c + k * stride;
        double d = 0;
#pragma omp simd reduction(+ : d)
        for (size_t i = k + 1; i < n; i++)
            d += row[i];
        for (size_t i = k + 1; i < last; i++)
            share[i - first] = row[i] / d;
        for (size_t i = last; i < n; i++)
            part[(i - last) / TILE * TILE * PANEL + (k - first) * TILE + (i - last) % TILE] =
                row[i] / d;
        for (size_t i = k + 1; i < last; i++) {
            double *restrict to = c + i * stride, s = share[i - first];
            for (size_t j = i + 1; j < n; j++)
                to[j] += s * row[j];
        }
    }
}

typedef double tile_row __attribute__((vector_size(TILE * 8), aligned(8), may_alias));

/* Adds the faces that the elimination of rows first .. last - 1 creates to a strip of columns. */
RC_WIDE_CLONES static void
add_products(double *c, size_t stride, size_t first, size_t last, size_t column, const double *part)
{
    for (size_t i = last; i < column + TILE; i += TILE) {
        const double *s = part + (i - last) * PANEL, *row = c + first * stride + column;
        double *to = c + i * stride + column;
        tile_row sum[TILE];
#pragma GCC unroll 8
        for (int q = 0; q < TILE; q++)
            sum[q] = *(tile_row *)(to + (size_t)q * stride);
        for (size_t k = first; k < last; k++, row += stride, s += TILE) {
            tile_row v = *(const tile_row *)row;
#pragma GCC unroll 8
            for (int q = 0; q < TILE; q++)
                sum[q] += s[q] * v;
        }
#pragma GCC unroll 8
        for (int q = 0; q < TILE; q++)
            *(tile_row *)(to + (size_t)q * stride) = sum[q];
    }
}

/* Eliminates the first `own` nodes; part: room for n rounded up to TILE rows of PANEL. */
static void
eliminate_rows(double *c, size_t stride, size_t n, size_t own, double *part)
{
    for (size_t first = 0, last; first < own; first = last) {
        last = first + PANEL < own ? first + PANEL : own;
        eliminate_panel(c, stride, n, first, last, part);
#pragma omp taskloop grainsize(8) if (n >= WIDE)
        for (size_t column = last; column < n; column += TILE)
            add_products(c, stride, first, last, column, part);
    }
}

static void
copy_rows(struct front *f, int32_t first, int32_t last, const double *c, size_t stride)
{
    double *to = f->c;

    for (int32_t k = first; k < last; k++) {
        size_t length = (size_t)(f->n - 1 - (k - first)); /* f starts at the first row */
        memcpy(to, c + (size_t)k * stride + (size_t)k + 1, length * sizeof *to);
        to += length;
    }
}

/* Eliminates the nodes of a part; returns what it passes on, NULL when memory is short. */
static struct front *
run_front(struct rc_elimination *e, int32_t part, const struct front *sides, bool keep)
{
    const struct rc_part *p = &e->order.part[part];
    int32_t own = p->hi - p->cut, n, *at = list_nodes(e, p, sides, &n);
    size_t stride;
    struct front *rest = NULL;
    double *c = NULL;

    if (at == NULL)
        return NULL;
    c = n < WIDE ? e->work[this_thread()] : rc_alloc(work_size((size_t)n), sizeof *c);
    if (c == NULL || (rest = new_front(n - own, n - own, at + own)) == NULL)
        goto done;
    stride = ((size_t)n + 2 * TILE - 1) / TILE * TILE;
    for (size_t k = 0; k < (size_t)n; k++) { /* a tile begins up to TILE - 1 before the diagonal */
        size_t from = k < TILE ? 0 : k - TILE;
        memset(c + k * stride + from, 0, (stride - from) * sizeof *c);
    }
    add_faces(e, p, at, n, c, stride);
    for (const struct front *f = sides; f != NULL; f = f->next)
        add_side(f, at, at + n, c, stride);
    eliminate_rows(c, stride, (size_t)n, (size_t)own, c + stride * stride);
    copy_rows(rest, own, n, c, stride);
    if (keep) {
        e->kept[part] = new_front(n, own, at);
        if (e->kept[part] != NULL)
            copy_rows(e->kept[part], 0, own, c, stride);
        else
            free_fronts(rest), rest = NULL;
    }
done:
    if (n >= WIDE)
        free(c);
    free(at);
    return rest;
}

/* ---- all fronts ---- */

/* Eliminates a region; returns what its parts pass on. */
static struct front *
run_region(struct rc_elimination *e, int32_t part, int32_t keep)
{
    const struct rc_part *p = &e->order.part[part];
    struct front *left = NULL, *right = NULL, *rest;

    if (p->left >= 0) {
#pragma omp task shared(left) if (p->hi - p->lo >= TASK)
        left = run_region(e, p->left, keep);
    }
    if (p->right >= 0)
        right = run_region(e, p->right, keep);
#pragma omp taskwait
    if (left == NULL) {
        left = right;
    } else {
        for (rest = left; rest->next != NULL; rest = rest->next)
            continue;
        rest->next = right;
    }
    if (p->cut == p->hi || e->short_of_memory)
        return left;
    rest = run_front(e, part, left, p->hi - p->lo >= keep);
    free_fronts(left);
    if (rest == NULL)
        e->short_of_memory = true;
    return rest;
}

/* The level of row k of the front, a weighted mean of its neighbours' levels. It is computed as a difference
 * from the neighbour with the largest conductance. So rounding of the weights only affects the differences
 * between neighbours. */
static void
set_level(const struct front *f, int32_t k, const int32_t *node, const struct rc_levels *levels)
{
    const double *c = f->c + row_at(f->n, k);
    const int32_t *other = node + k + 1, n = f->n - k - 1;
    double p, rest, best = 0, step = 0, d = 0, sum;
    int32_t at = 0;

    for (int32_t q = 0; q < n; q++) {
        d += c[q];
        if (c[q] > best) {
            best = c[q];
            at = q;
        }
    }
    p = levels->p[other[at]];
    rest = levels->rest[other[at]];
    for (int32_t q = 0; q < n; q++)
        step += c[q] * rc_level_difference(levels->p[other[q]], levels->rest[other[q]], p, rest);
    step /= d;
    sum = p + step;
    rest += (p - (sum - (sum - p))) + (step - (sum - p));
    levels->p[node[k]] = sum + rest;
    levels->rest[node[k]] = rest - (levels->p[node[k]] - sum);
}

/* Levels of a region, from those of the later nodes. */
static void
set_levels(struct rc_elimination *e, int32_t part, const struct rc_levels *levels)
{
    const struct rc_part *p;
    struct front *f;

    if (part < 0 || e->short_of_memory)
        return;
    p = &e->order.part[part];
    if (p->cut < p->hi) {
        if (e->kept[part] == NULL)
            free_fronts(run_region(e, part, 0));
        if (e->short_of_memory)
            return;
        f = e->kept[part];
        for (int32_t q = 0; q < f->n; q++) /* places become nodes of the map */
            f->at[q] = f->at[q] < e->order.n ? e->order.node[f->at[q]]
                                             : e->a->inlet + f->at[q] - e->order.n;
        for (int32_t k = p->hi - p->cut; k > 0; k--)
            set_level(f, k - 1, f->at, levels);
        free_fronts(f);
        e->kept[part] = NULL;
    }
#pragma omp task if (p->hi - p->lo >= TASK)
    set_levels(e, p->left, levels);
    set_levels(e, p->right, levels);
#pragma omp taskwait
}

enum rc_status
rc_elimination_run(struct rc_elimination *e, enum rc_face_rule rule, const struct rc_levels *levels,
                   int32_t keep, double *conductance, struct rc_err *err)
{
    struct front *rest = NULL;

    e->rule = rule;
    *conductance = 0;
    if (e->order.n == 0)
        return RC_OK;
#pragma omp parallel num_threads(e->threads)
#pragma omp single
    {
        rest = run_region(e, e->order.root, levels == NULL ? INT32_MAX : keep);
        for (const struct front *f = rest; f != NULL; f = f->next)
            *conductance += f->n == 2 ? f->c[0] : 0;
        free_fronts(rest);
        if (levels != NULL) {
            levels->p[e->a->inlet] = 1;
            levels->p[e->a->outlet] = 0;
            levels->rest[e->a->inlet] = levels->rest[e->a->outlet] = 0;
            set_levels(e, e->order.root, levels);
        }
    }
    if (e->short_of_memory) {
        e->short_of_memory = false;
        return rc_err_set(err, "out of memory for the flow through %d nodes", e->order.n);
    }
    return RC_OK;
}

void
rc_elimination_free(struct rc_elimination *e)
{
    if (e == NULL)
        return;
    for (int32_t part = 0; e->kept != NULL && part < e->order.parts; part++)
        free(e->kept[part]);
    rc_store_free(&e->own);
    free(e->order.node);
    free(e->order.part);
    free(e);
}
