/*
 * Patches of the contact: nodes that carry pressure, joined by their four neighbours. Each row is cut
 * into runs of contact; runs of neighbouring rows that overlap belong to one patch, which is found
 * by union-find. Bands of rows are joined side by side, then band to band.
 */
#include "libcontact/contact.h"

#include <math.h>
#include <stdlib.h>

#include "libcontact/common.h"
#include "libcontact/memory.h"

static const double pi = 3.14159265358979323846;

/* Columns from .. to-1 of a row. */
struct run {
    size_t from, to;
    size_t
        parent;  /* a run of the same patch, none with a greater index; itself: the patch's first */
    size_t ends; /* edges between contact and none at its ends: of length dy                      */
    size_t
        sides; /* and along it: of length dx                                                    */
};

struct runs {
    size_t *first; /* row j holds runs first[j] .. first[j+1]-1 */
    struct run *run;
};

/* ---- rows into runs ---- */

static size_t
count_row(const double *p, size_t nx)
{
    size_t n = nx > 0 && p[0] > 0 ? 1 : 0;

    for (size_t i = 1; i < nx; i++)
        n += (p[i] > 0) & !(p[i - 1] > 0);
    return n;
}

static void
find_row(const double *p, size_t nx, bool wraps, struct run *run, size_t index)
{
    size_t n = 0;

    for (size_t i = 0; i < nx; i++) {
        struct run *r = &run[n];
        if (!(p[i] > 0))
            continue;
        *r = (struct run){.from = i, .parent = index + n};
        while (i < nx && p[i] > 0)
            i++;
        r->to = i;
        r->ends = r->from > 0 || (wraps && !(p[nx - 1] > 0)) ? 1 : 0;
        r->ends += r->to < nx || (wraps && !(p[0] > 0)) ? 1 : 0;
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

/* Row `below` lies under row `above`: their runs are joined where they overlap, and what of each has
 * no contact across counts as its side. */
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
find_runs(const struct rc_shape *s, const double *p, bool wraps, int threads, struct runs *r)
{
    size_t nx = s->nx, ny = s->ny;

    if ((r->first = rc_alloc(ny + 1, sizeof *r->first)) == NULL)
        return RC_FAIL;
    r->first[0] = 0;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t j = 0; j < ny; j++)
        r->first[j + 1] = count_row(p + j * nx, nx);
    for (size_t j = 0; j < ny; j++)
        r->first[j + 1] += r->first[j];
    if ((r->run = rc_alloc(r->first[ny] + 1, sizeof *r->run)) == NULL)
        return RC_FAIL;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t j = 0; j < ny; j++)
        find_row(p + j * nx, nx, wraps, r->run + r->first[j], r->first[j]);
    return RC_OK;
}

static void
join_all(const struct rc_shape *s, bool wraps, int threads, struct runs *r)
{
    size_t nx = s->nx, ny = s->ny, bands = (size_t)threads < ny ? (size_t)threads : ny;

    /* A band's patches only hold runs of the band. */
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t band = 0; band < bands; band++)
        for (size_t j = ny * band / bands + 1; j < ny * (band + 1) / bands; j++)
            join_rows(r, j - 1, j);
    for (size_t band = 1; band < bands; band++)
        join_rows(r, ny * band / bands - 1, ny * band / bands);
    if (!wraps)
        return;
    join_rows(r, ny - 1, 0); /* of a map of one row: the row with itself */
    for (size_t j = 0; j < ny; j++)
        if (r->first[j] < r->first[j + 1]) {
            size_t left = r->first[j], right = r->first[j + 1] - 1;
            if (r->run[left].from == 0 && r->run[right].to == nx)
                join(r->run, left, right);
        }
}

/* ---- figures ---- */

static int
larger_first(const void *a, const void *b)
{
    const struct rc_patch *x = a, *y = b;

    return (x->nodes < y->nodes) - (x->nodes > y->nodes);
}

/* What each run has goes to the first of its patch, which comes before it. */
static enum rc_status
list_patches(const struct rc_shape *s, struct runs *r, struct rc_patches *patches)
{
    size_t runs = r->first[s->ny], n = 0;

    if ((patches->patch = rc_alloc(patches->count + 1, sizeof *patches->patch)) == NULL)
        return RC_FAIL;
    for (size_t k = 0; k < runs; k++) {
        struct run *run = &r->run[k], *first = &r->run[find(r->run, k)];
        if (run == first)
            continue;
        first->to += run->to - run->from;
        first->ends += run->ends;
        first->sides += run->sides;
    }
    for (size_t k = 0; k < runs; k++) {
        const struct run *run = &r->run[k];
        size_t nodes = run->to - run->from;
        if (run->parent == k)
            patches->patch[n++] = (struct rc_patch){.nodes = nodes,
                                                    .area = (double)nodes * s->dx * s->dy,
                                                    .perimeter = (double)run->ends * s->dy +
                                                                 (double)run->sides * s->dx};
    }
    qsort(patches->patch, n, sizeof *patches->patch, larger_first);
    return RC_OK;
}

static void
add_up(const struct rc_shape *s, const struct runs *r, struct rc_patches *patches)
{
    size_t ends = 0, sides = 0;
    double cell = s->dx * s->dy;

    for (size_t k = 0; k < r->first[s->ny]; k++) {
        const struct run *run = &r->run[k];
        patches->count += run->parent == k;
        patches->contact_nodes += run->to - run->from;
        ends += run->ends;
        sides += run->sides;
    }
    patches->contact_area = (double)patches->contact_nodes * cell;
    patches->perimeter = (double)ends * s->dy + (double)sides * s->dx;
    patches->contact_area_corrected =
        patches->contact_area - (pi - 1 + log(2)) / 24 * cell * (double)(ends + sides);
}

enum rc_status
rc_patches_find(const struct rc_shape *shape, const double *p,
                const struct rc_patch_options *options, struct rc_patches *patches,
                struct rc_err *err)
{
    bool wraps = options->boundary == RC_PERIODIC;
    int threads = rc_useful_threads(shape, options->threads);
    enum rc_status status = RC_FAIL;
    struct runs r = {0};

    *patches = (struct rc_patches){0};
    if (rc_shape_check(shape, err) != RC_OK)
        return RC_FAIL;
    if (find_runs(shape, p, wraps, threads, &r) != RC_OK)
        goto done;
    join_all(shape, wraps, threads, &r);
    add_up(shape, &r, patches);
    status = options->each ? list_patches(shape, &r, patches) : RC_OK;
done:
    if (status != RC_OK)
        rc_err_set(err, "out of memory for the contact patches of %zu x %zu nodes", shape->nx,
                   shape->ny);
    free(r.first);
    free(r.run);
    return status;
}

void
rc_patches_free(struct rc_patches *patches)
{
    free(patches->patch);
    *patches = (struct rc_patches){0};
}
