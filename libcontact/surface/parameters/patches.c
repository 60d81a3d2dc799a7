/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Patches of the contact: nodes in contact, joined through their four neighbours. Each row is cut into runs
 * of contact; overlapping runs of neighbouring rows belong to one patch, found by union-find. Bands of rows
 * are processed in parallel, then joined.
 *
 * Where ranks share the map, each rank processes its own rows and the rows just before and after them, which
 * it only uses for joins. Each run of the row before is also a run of the last row of another rank: these
 * pairs join the patches of all ranks.
 */
#include "libcontact/contact.h"

#include <math.h>
#include <stdlib.h>

#include "libcontact/common.h"
#include "libcontact/memory.h"
#include "libcontact/ranks/ranks.h"

/* Columns from .. to-1 of a row. Its parent is a run of the same patch with a smaller index, or itself if it
 * is the first run of the patch. */
struct run {
    size_t from, to;
    size_t parent;
    size_t ends;  /* edges of contact at its ends: of length dy */
    size_t sides; /* edges of contact along it: of length dx */
};

/* The rows to be processed. */
struct field {
    size_t nx, rows;  /* rows: with the neighbouring rows of other ranks */
    size_t own, last; /* the rows held here: own .. last-1 */
    const double *p, *before, *after;
};

static const double *
row_of(const struct field *f, size_t j)
{
    return j < f->own ? f->before : j < f->last ? f->p + (j - f->own) * f->nx : f->after;
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
    size_t nx = f->nx, ny = f->rows, bands = (size_t)threads < ny ? (size_t)threads : ny;

    /* within a band, patches only contain runs of the band */
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t band = 0; band < bands; band++)
        for (size_t j = ny * band / bands + 1; j < ny * (band + 1) / bands; j++)
            join_rows(r, j - 1, j);
    for (size_t band = 1; band < bands; band++)
        join_rows(r, ny * band / bands - 1, ny * band / bands);
    if (wraps.y && whole)
        join_rows(r, ny - 1, 0); /* a map of one row: the row with itself */
    for (size_t j = 0; j < ny && wraps.x; j++)
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

/* Adds nodes and edges of the runs held here to the first run of their patch. Makes a part for each patch
 * with nodes, in the order of the first runs. */
static size_t
make_parts(const struct field *f, struct runs *r, size_t before, struct part *part)
{
    size_t runs = r->first[f->rows], n = 0;

    for (size_t k = 0; k < runs; k++)
        part[k] = (struct part){.at = before + k};
    for (size_t k = r->first[f->own]; k < r->first[f->last]; k++) {
        const struct run *run = &r->run[k];
        struct part *first = &part[find(r->run, k)];
        first->nodes += run->to - run->from;
        first->ends += run->ends;
        first->sides += run->sides;
    }
    for (size_t k = 0; k < runs; k++)
        if (part[k].nodes > 0)
            part[n++] = part[k];
    return n;
}

/* One run seen by two ranks: the places of its patch on both. */
struct pair {
    size_t a, b;
};

/* The data of all ranks: parts, where the parts of each rank begin, and pairs that join them. */
struct all {
    struct part *part;
    struct pair *pair;
    size_t parts, pairs;
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

/* The place of the patch of each run of a row, counted over all ranks. */
static void
patches_of_row(struct runs *r, size_t j, size_t before, size_t *at)
{
    for (size_t k = r->first[j]; k < r->first[j + 1]; k++)
        *at++ = before + find(r->run, k);
}

/* The pairs of this rank are runs of the row before its own. They are listed as it sees them and as the rank
 * that holds the row sees them. */
static enum rc_status
make_pairs(const struct rc_rows *rows, bool wraps, const struct field *f, struct runs *r,
           size_t before, struct pair **pairs, size_t *n)
{
    size_t most = f->nx / 2 + 1;
    RC_OWNED size_t *line = calloc(4 * most, sizeof *line);
    bool has[2];

    *n = f->own > 0 ? r->first[1] : 0;
    *pairs = malloc((*n + 1) * sizeof **pairs);
    if (rc_ranks_agree(rows->ranks, line == NULL || *pairs == NULL ? RC_FAIL : RC_OK, NULL) !=
        RC_OK)
        return RC_FAIL;
    if (f->last > f->own)
        patches_of_row(r, f->last - 1, before, line);
    if (*n > 0)
        patches_of_row(r, 0, before, line + most);
    rc_ranks_beside(rows, wraps, most * sizeof *line, line, line, line + 2 * most, line + 3 * most,
                    has);
    for (size_t k = 0; k < *n; k++)
        (*pairs)[k] = (struct pair){line[most + k], line[2 * most + k]};
    return RC_OK;
}

/* Parts and pairs of all ranks. */
static enum rc_status
gather_all(const struct rc_rows *rows, bool wraps, const struct field *f, struct runs *r,
           struct part *own, size_t parts, size_t before, struct all *all)
{
    RC_OWNED struct pair *pair = NULL;
    enum rc_status status;

    *all = (struct all){.parts = parts};
    if (rows->ranks == NULL) {
        all->part = own;
        return RC_OK;
    }
    status = make_pairs(rows, wraps, f, r, before, &pair, &all->pairs);
    if (status == RC_OK) {
        all->part = gather_lists(rows->ranks, sizeof *own, own, &all->parts);
        all->pair = gather_lists(rows->ranks, sizeof *pair, pair, &all->pairs);
        status = all->part == NULL || all->pair == NULL ? RC_FAIL : RC_OK;
    }
    free(own);
    return status;
}

/* ---- joining across ranks ---- */

/* Places are in increasing order. parent[k]: index in this list of the first place of the patch of place k,
 * or of one nearer to it. */
struct places {
    size_t n, *at, *parent;
};

static int
by_size(const void *a, const void *b)
{
    const size_t *x = a, *y = b;

    return (*x > *y) - (*x < *y);
}

static size_t
place(struct places *q, size_t at)
{
    size_t *found = bsearch(&at, q->at, q->n, sizeof at, by_size), k;

    if (found == NULL)
        return q->n;
    for (k = (size_t)(found - q->at); q->parent[k] != k; k = q->parent[k])
        q->parent[k] = q->parent[q->parent[k]];
    return k;
}

/* Gives each part the place of the first part of its patch. */
static enum rc_status
join_parts(struct all *all)
{
    RC_ENDS(rc_store_free) struct rc_store own = {0};
    struct places q = {.at = rc_store_take(&own, 2 * all->pairs, sizeof *q.at),
                       .parent = rc_store_take(&own, 2 * all->pairs, sizeof *q.parent)};

    if (own.failed)
        return RC_FAIL;
    for (size_t k = 0; k < all->pairs; k++) {
        q.at[2 * k] = all->pair[k].a;
        q.at[2 * k + 1] = all->pair[k].b;
    }
    qsort(q.at, 2 * all->pairs, sizeof *q.at, by_size);
    for (size_t k = 0; k < 2 * all->pairs; k++)
        if (q.n == 0 || q.at[q.n - 1] != q.at[k])
            q.at[q.n++] = q.at[k];
    for (size_t k = 0; k < q.n; k++)
        q.parent[k] = k;
    for (size_t k = 0; k < all->pairs; k++) {
        size_t a = place(&q, all->pair[k].a), b = place(&q, all->pair[k].b);
        q.parent[a < b ? b : a] = a < b ? a : b;
    }
    for (size_t k = 0; k < all->parts; k++) {
        size_t first = place(&q, all->part[k].at);
        if (first < q.n)
            all->part[k].at = q.at[first];
    }
    return RC_OK;
}

static int
by_place(const void *a, const void *b)
{
    const struct part *x = a, *y = b;

    return (x->at > y->at) - (x->at < y->at);
}

/* Merges the parts of one patch. */
static void
merge_parts(struct all *all)
{
    size_t n = 0;

    qsort(all->part, all->parts, sizeof *all->part, by_place);
    for (size_t k = 0; k < all->parts; k++) {
        if (n > 0 && all->part[n - 1].at == all->part[k].at) {
            all->part[n - 1].nodes += all->part[k].nodes;
            all->part[n - 1].ends += all->part[k].ends;
            all->part[n - 1].sides += all->part[k].sides;
        } else {
            all->part[n++] = all->part[k];
        }
    }
    all->parts = n;
}

/* ---- figures ---- */

/* The larger patch first; of equal patches the one whose first run comes first. */
static int
larger_first(const void *a, const void *b)
{
    const struct part *x = a, *y = b;

    return x->nodes != y->nodes ? (x->nodes < y->nodes) - (x->nodes > y->nodes) : by_place(a, b);
}

/* Sorts before the list is allocated: qsort may need as much memory again as the parts that it sorts. */
static enum rc_status
list_patches(const struct rc_shape *s, struct all *all, struct rc_patches *patches)
{
    qsort(all->part, all->parts, sizeof *all->part, larger_first);
    if ((patches->patch = rc_alloc(all->parts + 1, sizeof *patches->patch)) == NULL)
        return RC_FAIL;
    for (size_t k = 0; k < all->parts; k++) {
        const struct part *part = &all->part[k];
        patches->patch[k] = (struct rc_patch){.nodes = part->nodes,
                                              .area = (double)part->nodes * s->dx * s->dy,
                                              .perimeter = (double)part->ends * s->dy +
                                                           (double)part->sides * s->dx};
    }
    return RC_OK;
}

static void
add_up(const struct rc_shape *s, const struct all *all, struct rc_patches *patches)
{
    size_t ends = 0, sides = 0;
    double cell = s->dx * s->dy;

    patches->count = all->parts;
    for (size_t k = 0; k < all->parts; k++) {
        patches->contact_nodes += all->part[k].nodes;
        ends += all->part[k].ends;
        sides += all->part[k].sides;
    }
    patches->contact_area = (double)patches->contact_nodes * cell;
    patches->perimeter = (double)ends * s->dy + (double)sides * s->dx;
    patches->contact_area_corrected =
        patches->contact_area - (RC_PI - 1 + log(2)) / 24 * cell * (double)(ends + sides);
}

/* The rows held here and the two next to them, which are copied into `room`. */
static struct field
field_of(const struct rc_rows *rows, size_t nx, bool wraps, const double *p, double *room)
{
    struct field f = {.nx = nx, .rows = rows->n, .last = rows->n, .p = p};
    bool has[2] = {false, false};

    if (rows->ranks == NULL)
        return f;
    rc_ranks_beside(rows, wraps, nx * sizeof *p, p, p + (rows->n > 0 ? rows->n - 1 : 0) * nx, room,
                    room + nx, has);
    f.before = room;
    f.after = room + nx;
    f.own = has[0];
    f.last = has[0] + rows->n;
    f.rows = f.last + has[1];
    return f;
}

/* The parts of all ranks, merged: each is a whole patch. */
static enum rc_status
find_parts(const struct rc_rows *rows, const struct field *f, struct rc_boundary wraps, int threads,
           struct runs *r, struct all *all)
{
    enum rc_status status = find_runs(f, wraps.x, threads, r);
    RC_OWNED struct part *part = NULL;
    size_t before, n;

    if (status == RC_OK && (part = malloc((r->first[f->rows] + 1) * sizeof *part)) == NULL)
        status = RC_FAIL;
    if (rc_ranks_agree(rows->ranks, status, NULL) != RC_OK)
        return RC_FAIL;
    join_all(f, wraps, rows->ranks == NULL, threads, r);
    before = rows->ranks == NULL
                 ? 0
                 : (size_t)rc_ranks_sum_before(rows->ranks, (double)r->first[f->rows]);
    n = make_parts(f, r, before, part);
    status = gather_all(rows, wraps.y, f, r, rc_give(&part), n, before, all);
    if (status == RC_OK && rows->ranks != NULL) {
        status = join_parts(all);
        merge_parts(all);
    }
    return status;
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
    struct all all = {0};
    struct field f;

    *patches = (struct rc_patches){0};
    if (rc_shape_check(shape, err) != RC_OK)
        return RC_FAIL;
    room = rc_alloc(2 * shape->nx, sizeof *room);
    status = rc_ranks_agree(rows.ranks, room == NULL ? RC_FAIL : RC_OK, NULL);
    if (status == RC_OK) {
        f = field_of(&rows, shape->nx, wraps.y, p, room);
        status = find_parts(&rows, &f, wraps, rc_useful_threads(&own, options->threads), &r, &all);
    }
    rc_store_free(&r.own);
    if (status == RC_OK)
        add_up(shape, &all, patches);
    if (status == RC_OK && options->each)
        status = list_patches(shape, &all, patches);
    if (rc_ranks_agree(rows.ranks, status, NULL) != RC_OK)
        status = rc_err_set(err, "out of memory for the contact patches of %zu x %zu nodes",
                            shape->nx, shape->ny);
    free(all.part);
    free(all.pair);
    return status;
}

void
rc_patches_free(struct rc_patches *patches)
{
    free(patches->patch);
    *patches = (struct rc_patches){0};
}
