/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Patches of the contact: nodes in contact, joined through their four neighbours. Each row is cut into runs
 * of contact; overlapping runs of neighbouring rows belong to one patch, found by union-find. Bands of rows
 * are processed in parallel, then joined.
 *
 * Where ranks share the map, each rank processes its own rows and the rows just before and after them, which
 * it only uses for joins. Each run of the row before is also a run of the last row of another rank: all ranks
 * get these pairs, and add up the parts of the patches that cross edges between ranks. A patch belongs to the
 * rank that holds its first run; no other rank stores it.
 */
#include "libcontact/contact.h"

#include <math.h>
#include <stdlib.h>

#include "libcontact/common.h"
#include "libcontact/memory.h"
#include "libcontact/ranks/ranks.h"

/* Columns from .. to-1 of a row. Its parent is a run of the same patch with a smaller index, or itself if it
 * is the first run of the patch. In the end, nodes and edges of a first run are those of its patch. */
struct run {
    size_t from, to; /* to - from: nodes */
    size_t parent;
    size_t ends;  /* edges of contact at its ends: of length dy */
    size_t sides; /* edges of contact along it: of length dx */
};

/* The rows to be processed: those held here, the row after them and the row before them. In this order a
 * patch has its first run here, unless it has no node here. */
struct field {
    size_t nx, own, rows;             /* rows: with the neighbouring rows of other ranks */
    const double *p, *after, *before; /* after, before: NULL if there is none */
};

static const double *
row_of(const struct field *f, size_t j)
{
    return j < f->own                              ? f->p + j * f->nx
           : j + 1 == f->rows && f->before != NULL ? f->before
                                                   : f->after;
}

struct runs {
    size_t *first; /* row j holds runs first[j] .. first[j+1]-1 */
    struct run *run;
    struct rc_store own;
};

/* ---- rows into runs ---- */

static size_t
count_row(const double *p, size_t nx)
{
    size_t n = nx > 0 && rc_in_contact(p[0]) ? 1 : 0;

    for (size_t i = 1; i < nx; i++)
        n += rc_in_contact(p[i]) & !rc_in_contact(p[i - 1]);
    return n;
}

static void
find_row(const double *p, size_t nx, bool wraps, struct run *run, size_t index)
{
    size_t n = 0;

    for (size_t i = 0; i < nx; i++) {
        struct run *r = &run[n];
        if (!rc_in_contact(p[i]))
            continue;
        *r = (struct run){.from = i, .parent = index + n};
        while (i < nx && rc_in_contact(p[i]))
            i++;
        r->to = i;
        r->ends = r->from > 0 || (wraps && !rc_in_contact(p[nx - 1])) ? 1 : 0;
        r->ends += r->to < nx || (wraps && !rc_in_contact(p[0])) ? 1 : 0;
        n++;
    }
}

/* ---- runs into patches ---- */

static size_t
find(struct run *run, size_t k)
{
    while (run[k].parent != k) {
        run[k].parent = run[run[k].parent].parent;
        k = run[k].parent;
    }
    return k;
}

static void
join(struct run *run, size_t a, size_t b)
{
    size_t ra = find(run, a), rb = find(run, b);

    if (ra < rb)
        run[rb].parent = ra;
    else
        run[ra].parent = rb;
}

/* Row `below` lies under row `above`: joins their overlapping runs; nodes without contact on the other side
 * count as edges. */
static void
join_rows(struct runs *r, size_t above, size_t below)
{
    struct run *run = r->run;
    size_t a = r->first[above], b = r->first[below];
    const size_t a_end = r->first[above + 1], b_end = r->first[below + 1];

    for (size_t k = a; k < a_end; k++)
        run[k].sides += run[k].to - run[k].from;
    for (size_t k = b; k < b_end; k++)
        run[k].sides += run[k].to - run[k].from;
    while (a < a_end && b < b_end) {
        size_t from = run[a].from > run[b].from ? run[a].from : run[b].from;
        size_t to = run[a].to < run[b].to ? run[a].to : run[b].to;

        if (from < to) {
            run[a].sides -= to - from;
            run[b].sides -= to - from;
            join(run, a, b);
        }
        if (run[a].to < run[b].to)
            a++;
        else
            b++;
    }
}

static enum rc_status
find_runs(const struct field *f, bool wraps, int threads, struct runs *r)
{
    size_t nx = f->nx, ny = f->rows;

    if ((r->first = rc_store_take(&r->own, ny + 1, sizeof *r->first)) == NULL)
        return RC_FAIL;
    r->first[0] = 0;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t j = 0; j < ny; j++)
        r->first[j + 1] = count_row(row_of(f, j), nx);
    for (size_t j = 0; j < ny; j++)
        r->first[j + 1] += r->first[j];
    if ((r->run = rc_store_take(&r->own, r->first[ny] + 1, sizeof *r->run)) == NULL)
        return RC_FAIL;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t j = 0; j < ny; j++)
        find_row(row_of(f, j), nx, wraps, r->run + r->first[j], r->first[j]);
    return RC_OK;
}

static void
join_all(const struct field *f, struct rc_boundary wraps, bool whole, int threads, struct runs *r)
{
    size_t nx = f->nx, ny = f->own, bands = (size_t)threads < ny ? (size_t)threads : ny;

    /* within a band, patches only contain runs of the band */
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t band = 0; band < bands; band++)
        for (size_t j = ny * band / bands + 1; j < ny * (band + 1) / bands; j++)
            join_rows(r, j - 1, j);
    for (size_t band = 1; band < bands; band++)
        join_rows(r, ny * band / bands - 1, ny * band / bands);
    if (wraps.y && whole)
        join_rows(r, ny - 1, 0); /* a map of one row: the row with itself */
    if (f->after != NULL)
        join_rows(r, ny - 1, ny);
    if (f->before != NULL)
        join_rows(r, f->rows - 1, 0);
    for (size_t j = 0; j < f->rows && wraps.x; j++)
        if (r->first[j] < r->first[j + 1]) {
            size_t left = r->first[j], right = r->first[j + 1] - 1;
            if (r->run[left].from == 0 && r->run[right].to == nx)
                join(r->run, left, right);
        }
}

/* ---- patches ---- */

/* A patch, or the part of one that a rank holds. */
struct part {
    size_t at; /* its first run, counted over all ranks */
    size_t nodes, ends, sides;
};

struct parts {
    struct part *part;
    size_t n;
};

/* Adds nodes and edges of the runs held here to the first run of their patch. Makes a part for each patch
 * with nodes here, in the order of the first runs. */
static enum rc_status
make_parts(const struct field *f, struct runs *r, size_t before, struct parts *parts)
{
    size_t runs = r->first[f->own], n = 0;

    for (size_t k = 0; k < runs; k++) {
        const struct run *run = &r->run[k];
        struct run *first = &r->run[find(r->run, k)];
        if (first == run) {
            n++;
            continue;
        }
        first->to += run->to - run->from;
        first->ends += run->ends;
        first->sides += run->sides;
    }
    if ((parts->part = malloc((n + 1) * sizeof *parts->part)) == NULL)
        return RC_FAIL;
    for (size_t k = 0; k < runs; k++) {
        const struct run *run = &r->run[k];
        if (run->parent == k)
            parts->part[parts->n++] =
                (struct part){before + k, run->to - run->from, run->ends, run->sides};
    }
    return RC_OK;
}

/* ---- joining across ranks ---- */

/* One run seen by two ranks: the places of its patch on both. */
struct pair {
    size_t a, b;
};

/* Concatenates the lists of all ranks, of *n entries of `bytes` each here, in memory that the caller frees.
 * *n becomes the total number of entries. NULL when memory is short. */
static void *
gather_lists(const struct rc_ranks *ranks, size_t bytes, const void *own, size_t *n)
{
    size_t count = rc_ranks_count(ranks);
    RC_OWNED size_t *from = calloc(count + 1, sizeof *from);
    RC_OWNED void *all = NULL;

    if (rc_ranks_agree(ranks, from == NULL ? RC_FAIL : RC_OK, NULL) != RC_OK)
        return NULL;
    rc_ranks_gather(ranks, sizeof *n, n, from + 1);
    for (size_t q = 0; q < count; q++)
        from[q + 1] += from[q];
    *n = from[count];
    all = malloc((*n + 1) * bytes);
    if (rc_ranks_agree(ranks, all == NULL ? RC_FAIL : RC_OK, NULL) != RC_OK)
        return NULL;
    rc_ranks_move(ranks, bytes, from, NULL, 0, own, all);
    return rc_give(&all);
}

#define NOWHERE SIZE_MAX /* a patch without nodes here */

/* The place of the patch of each run of a row, counted over all ranks, or NOWHERE. */
static void
patches_of_row(const struct field *f, struct runs *r, size_t j, size_t before, size_t *at)
{
    for (size_t k = r->first[j]; k < r->first[j + 1]; k++) {
        const size_t first = find(r->run, k);
        *at++ = first < r->first[f->own] ? before + first : NOWHERE;
    }
}

/* The pairs of all ranks. Those of this rank are runs of the row before its own, as it sees them and as the
 * rank that holds the row sees them. NULL when memory is short. */
static struct pair *
find_pairs(const struct rc_rows *rows, bool wraps, const struct field *f, struct runs *r,
           size_t before, size_t *n)
{
    size_t most = f->nx / 2 + 1, runs = 0;
    RC_OWNED size_t *line = calloc(4 * most, sizeof *line);
    RC_OWNED struct pair *pair = NULL;
    bool has[2];

    if (f->before != NULL)
        runs = r->first[f->rows] - r->first[f->rows - 1];
    pair = malloc((runs + 1) * sizeof *pair);
    if (rc_ranks_agree(rows->ranks, line == NULL || pair == NULL ? RC_FAIL : RC_OK, NULL) != RC_OK)
        return NULL;
    if (f->own > 0)
        patches_of_row(f, r, f->own - 1, before, line);
    if (runs > 0)
        patches_of_row(f, r, f->rows - 1, before, line + most);
    rc_ranks_beside(rows, wraps, most * sizeof *line, line, line, line + 2 * most, line + 3 * most,
                    has);
    *n = 0;
    for (size_t k = 0; k < runs; k++)
        if (line[most + k] != NOWHERE)
            pair[(*n)++] = (struct pair){line[most + k], line[2 * most + k]};
    return gather_lists(rows->ranks, sizeof *pair, pair, n);
}

/* Places are in increasing order. parent[k]: index in this list of the first place of the patch of place k,
 * or of one nearer to it. */
struct places {
    size_t n, *at, *parent;
    struct rc_store own;
};

static int
by_size(const void *a, const void *b)
{
    const size_t *x = a, *y = b;

    return (*x > *y) - (*x < *y);
}

static size_t
place(const struct places *q, size_t at)
{
    size_t *found = bsearch(&at, q->at, q->n, sizeof at, by_size), k;

    if (found == NULL)
        return q->n;
    for (k = (size_t)(found - q->at); q->parent[k] != k; k = q->parent[k])
        q->parent[k] = q->parent[q->parent[k]];
    return k;
}

static enum rc_status
join_places(const struct pair *pair, size_t pairs, struct places *q)
{
    q->at = rc_store_take(&q->own, 2 * pairs, sizeof *q->at);
    q->parent = rc_store_take(&q->own, 2 * pairs, sizeof *q->parent);
    if (q->own.failed)
        return RC_FAIL;
    for (size_t k = 0; k < pairs; k++) {
        q->at[2 * k] = pair[k].a;
        q->at[2 * k + 1] = pair[k].b;
    }
    qsort(q->at, 2 * pairs, sizeof *q->at, by_size);
    for (size_t k = 0; k < 2 * pairs; k++)
        if (q->n == 0 || q->at[q->n - 1] != q->at[k])
            q->at[q->n++] = q->at[k];
    for (size_t k = 0; k < q->n; k++)
        q->parent[k] = k;
    for (size_t k = 0; k < pairs; k++) {
        size_t a = place(q, pair[k].a), b = place(q, pair[k].b);
        q->parent[a < b ? b : a] = a < b ? a : b;
    }
    return RC_OK;
}

/* Adds up the parts of each patch that has a place, in `sum`, three numbers a place. Whole numbers, so that
 * the order of the ranks does not matter. Keeps the patches whose first run is here. */
static void
merge_parts(const struct rc_ranks *ranks, const struct places *q, double *sum, struct parts *parts)
{
    size_t n = 0;

    for (size_t k = 0; k < parts->n; k++) {
        const struct part *part = &parts->part[k];
        const size_t first = place(q, part->at);
        if (first == q->n)
            continue;
        sum[3 * first] += (double)part->nodes;
        sum[3 * first + 1] += (double)part->ends;
        sum[3 * first + 2] += (double)part->sides;
    }
    rc_ranks_each_sum(ranks, 3 * q->n, sum);
    for (size_t k = 0; k < parts->n; k++) {
        struct part part = parts->part[k];
        const size_t first = place(q, part.at);
        if (first < q->n && q->at[first] != part.at)
            continue;
        if (first < q->n) {
            part.nodes = (size_t)sum[3 * first];
            part.ends = (size_t)sum[3 * first + 1];
            part.sides = (size_t)sum[3 * first + 2];
        }
        parts->part[n++] = part;
    }
    parts->n = n;
}

/* Joins the parts of all ranks. */
static enum rc_status
join_parts(const struct rc_rows *rows, bool wraps, const struct field *f, struct runs *r,
           size_t before, struct parts *parts)
{
    size_t pairs;
    RC_OWNED struct pair *pair = find_pairs(rows, wraps, f, r, before, &pairs);
    RC_OWNED double *sum = NULL;
    struct places q = {0};
    enum rc_status status = RC_FAIL;

    if (pair == NULL)
        return RC_FAIL;
    if (join_places(pair, pairs, &q) == RC_OK && (sum = calloc(3 * q.n + 1, sizeof *sum)) != NULL)
        status = RC_OK;
    status = rc_ranks_agree(rows->ranks, status, NULL);
    if (status == RC_OK)
        merge_parts(rows->ranks, &q, sum, parts);
    rc_store_free(&q.own);
    return status;
}

/* ---- figures ---- */

static int
by_place(const struct part *x, const struct part *y)
{
    return (x->at > y->at) - (x->at < y->at);
}

/* The larger patch first; of equal patches the one whose first run comes first. */
static int
larger_first(const void *a, const void *b)
{
    const struct part *x = a, *y = b;

    return x->nodes != y->nodes ? (x->nodes < y->nodes) - (x->nodes > y->nodes) : by_place(x, y);
}

/* Each rank sends its largest patches to all. Sorts before the list is allocated: qsort may need as much
 * memory again as the parts that it sorts. */
static enum rc_status
list_patches(const struct rc_ranks *ranks, const struct rc_shape *s, size_t largest,
             struct parts *parts, struct rc_patches *patches)
{
    qsort(parts->part, parts->n, sizeof *parts->part, larger_first);
    parts->n = parts->n < largest ? parts->n : largest;
    if (ranks != NULL) {
        RC_OWNED struct part *own = parts->part;
        if ((parts->part = gather_lists(ranks, sizeof *own, own, &parts->n)) == NULL)
            return RC_FAIL;
        qsort(parts->part, parts->n, sizeof *parts->part, larger_first);
        parts->n = parts->n < largest ? parts->n : largest;
    }
    if ((patches->patch = rc_alloc(parts->n + 1, sizeof *patches->patch)) == NULL)
        return RC_FAIL;
    for (size_t k = 0; k < parts->n; k++) {
        const struct part *part = &parts->part[k];
        patches->patch[k] = (struct rc_patch){.nodes = part->nodes,
                                              .area = (double)part->nodes * s->dx * s->dy,
                                              .perimeter = (double)part->ends * s->dy +
                                                           (double)part->sides * s->dx};
    }
    patches->listed = parts->n;
    return RC_OK;
}

static void
add_up(const struct rc_ranks *ranks, const struct rc_shape *s, const struct parts *parts,
       struct rc_patches *patches)
{
    double cell = s->dx * s->dy, sum[] = {(double)parts->n, 0, 0, 0};

    for (size_t k = 0; k < parts->n; k++) {
        sum[1] += (double)parts->part[k].nodes;
        sum[2] += (double)parts->part[k].ends;
        sum[3] += (double)parts->part[k].sides;
    }
    rc_ranks_each_sum(ranks, 4, sum); /* whole numbers */
    patches->count = (size_t)sum[0];
    patches->contact_nodes = (size_t)sum[1];
    patches->contact_area = sum[1] * cell;
    patches->perimeter = sum[2] * s->dy + sum[3] * s->dx;
    patches->contact_area_corrected =
        patches->contact_area - (RC_PI - 1 + log(2)) / 24 * cell * (sum[2] + sum[3]);
}

/* The rows held here and the two next to them, which are copied into `room`. */
static struct field
field_of(const struct rc_rows *rows, size_t nx, bool wraps, const double *p, double *room)
{
    struct field f = {.nx = nx, .own = rows->n, .rows = rows->n, .p = p};
    bool has[2] = {false, false};

    if (rows->ranks == NULL)
        return f;
    rc_ranks_beside(rows, wraps, nx * sizeof *p, p, p + (rows->n > 0 ? rows->n - 1 : 0) * nx, room,
                    room + nx, has);
    f.before = has[0] ? room : NULL;
    f.after = has[1] ? room + nx : NULL;
    f.rows += (size_t)has[0] + has[1];
    return f;
}

/* The patches whose first run is held here. */
static enum rc_status
find_parts(const struct rc_rows *rows, const struct field *f, struct rc_boundary wraps, int threads,
           struct runs *r, struct parts *parts)
{
    enum rc_status status = find_runs(f, wraps.x, threads, r);
    size_t before;

    if (rc_ranks_agree(rows->ranks, status, NULL) != RC_OK)
        return RC_FAIL;
    join_all(f, wraps, rows->ranks == NULL, threads, r);
    before = rows->ranks == NULL
                 ? 0
                 : (size_t)rc_ranks_sum_before(rows->ranks, (double)r->first[f->own]);
    status = rc_ranks_agree(rows->ranks, make_parts(f, r, before, parts), NULL);
    return status == RC_OK && rows->ranks != NULL ? join_parts(rows, wraps.y, f, r, before, parts)
                                                  : status;
}

#define FIGURE(member) RC_FIGURE(struct rc_patches, member)
const struct rc_figure rc_figures_patches[] = {
    {RC_FIGURE_AS("patches", struct rc_patches, count), NULL, "Patches"},
    {FIGURE(contact_nodes), NULL, "Nodes in contact"},
    {FIGURE(contact_area), "m2", "Contact area"},
    {FIGURE(contact_area_corrected), "m2", "Contact area, corrected"},
    {FIGURE(perimeter), "m", "Perimeter"},
    {0},
};

enum rc_status
rc_patches_find(const struct rc_shape *shape, const double *p,
                const struct rc_patch_options *options, struct rc_patches *patches,
                struct rc_err *err)
{
    const struct rc_rows rows = rc_rows_of(options->ranks, shape);
    const struct rc_shape own = rc_rows_shape(&rows, shape);
    const struct rc_boundary wraps = options->boundary;
    RC_OWNED double *room = NULL;
    enum rc_status status;
    struct runs r = {0};
    struct parts parts = {0};
    struct field f;

    *patches = (struct rc_patches){0};
    if (rc_shape_check(shape, err) != RC_OK)
        return RC_FAIL;
    room = rc_alloc(2 * shape->nx, sizeof *room);
    status = rc_ranks_agree(rows.ranks, room == NULL ? RC_FAIL : RC_OK, NULL);
    if (status == RC_OK) {
        f = field_of(&rows, shape->nx, wraps.y, p, room);
        status =
            find_parts(&rows, &f, wraps, rc_useful_threads(&own, options->threads), &r, &parts);
    }
    rc_store_free(&r.own);
    if (status == RC_OK)
        add_up(rows.ranks, shape, &parts, patches);
    if (status == RC_OK && options->largest > 0)
        status = list_patches(rows.ranks, shape, options->largest, &parts, patches);
    if (rc_ranks_agree(rows.ranks, status, NULL) != RC_OK)
        status = rc_err_set(err, "out of memory for the contact patches of %zu x %zu nodes",
                            shape->nx, shape->ny);
    free(parts.part);
    return status;
}

void
rc_patches_free(struct rc_patches *patches)
{
    free(patches->patch);
    *patches = (struct rc_patches){0};
}
