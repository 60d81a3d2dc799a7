/*
 * Feature parameters of ISO 25178-2: hills by watershed, pruned by Wolf's rule, their peaks,
 * heights and areas; dales are the hills of the map upside down.
 *
 * A node belongs to the hill that steepest ascent over its eight neighbours leads to. Nodes are
 * taken from the highest down, of equals the first one first, so that a plateau has one peak. Where
 * a node joins two hills it is their saddle: the hill whose peak is lower is pruned when that peak
 * stands less than 5 % of Sz above the saddle, and its nodes go to the hill across. Taken from the
 * highest saddle down this is what Wolf's rule, the least height first, comes to: the hill with the
 * least height always joins one with a higher peak.
 */
#include <float.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/common.h"
#include "libcontact/memory.h"

static const double prune = 0.05; /* of Sz */

enum {
    NEIGHBOURS = 8,
    FIVE = 5, /* peaks of S5p, pits of S5v */
    DIGIT = 11,
    PASSES = 6, /* of DIGIT bits make 64 */
    BUCKETS = 1 << DIGIT
};

struct field {
    struct rc_shape shape;
    const double *h;
    double sign; /* -1: upside down */
    bool wraps;
    double least; /* m: what stands lower above its saddle is pruned */
    size_t n;     /* nodes that are there */
    size_t *order, *hill;
};

struct hill {
    size_t peak;   /* node                                                      */
    size_t joined; /* a hill that it has been joined with, with a higher peak   */
    size_t goes;   /* pruned: the hill that its nodes go to; itself: it is kept */
    size_t nodes;
    bool open; /* reaches the edge or what was not measured */
};

struct hills {
    struct hill *hill;
    size_t n, room;
};

static bool
is_there(double v)
{
    return fabs(v) <= DBL_MAX;
}

static double
height(const struct field *f, size_t k)
{
    return f->sign * f->h[k];
}

/* ---- neighbours ---- */

static const int across[NEIGHBOURS] = {-1, 0, 1, -1, 1, -1, 0, 1};
static const int down[NEIGHBOURS] = {-1, -1, -1, 0, 0, 1, 1, 1};

/* A coordinate one step on; n: beyond the edge. */
static size_t
step(size_t i, int by, size_t n, bool wraps)
{
    if (by < 0)
        return i > 0 ? i - 1 : wraps ? n - 1 : n;
    return by == 0 ? i : i + 1 < n ? i + 1 : wraps ? 0 : n;
}

/* Neighbour d of node k; SIZE_MAX: there is none, or it was not measured. */
static size_t
neighbour(const struct field *f, size_t k, int d)
{
    size_t nx = f->shape.nx, ny = f->shape.ny;
    size_t i = step(k % nx, across[d], nx, f->wraps), j = step(k / nx, down[d], ny, f->wraps);

    if (i == nx || j == ny || !is_there(f->h[j * nx + i]))
        return SIZE_MAX;
    return j * nx + i;
}

static bool
comes_before(const struct field *f, size_t a, size_t b)
{
    double za = height(f, a), zb = height(f, b);

    return za > zb || (za == zb && a < b);
}

/* The neighbour that the steepest ascent leads to; SIZE_MAX: k is a peak. */
static size_t
ascent(const struct field *f, size_t k)
{
    double dx = f->shape.dx, dy = f->shape.dy, most = -1;
    double length[NEIGHBOURS];
    size_t best = SIZE_MAX;

    for (int d = 0; d < NEIGHBOURS; d++) {
        size_t m = neighbour(f, k, d);
        double slope;

        if (m == SIZE_MAX || m == k || !comes_before(f, m, k))
            continue;
        length[d] = sqrt(dx * dx * across[d] * across[d] + dy * dy * down[d] * down[d]);
        slope = (height(f, m) - height(f, k)) / length[d];
        if (slope > most) {
            most = slope;
            best = m;
        }
    }
    return best;
}

/* ---- the nodes from the highest down ---- */

static uint64_t
key_of(const struct field *f, size_t k)
{
    double v = height(f, k) + 0.0; /* no -0 */
    uint64_t bits;

    memcpy(&bits, &v, sizeof bits);
    return bits >> 63 ? bits : ~bits ^ UINT64_C(1) << 63;
}

/* Digit by digit, the lowest first, which leaves equals in the order of the map. */
static void
sort(struct field *f, size_t (*count)[BUCKETS])
{
    size_t *to = f->hill, *from = f->order;

    memset(count, 0, PASSES * sizeof *count);
    for (size_t k = 0; k < f->n; k++)
        for (unsigned p = 0; p < PASSES; p++)
            count[p][key_of(f, from[k]) >> p * DIGIT & (BUCKETS - 1)]++;
    for (unsigned p = 0; p < PASSES; p++) {
        size_t *place = count[p], sum = 0, *other = from;

        if (place[key_of(f, from[0]) >> p * DIGIT & (BUCKETS - 1)] == f->n)
            continue;
        for (size_t b = 0; b < BUCKETS; b++) {
            size_t here = place[b];

            place[b] = sum;
            sum += here;
        }
        for (size_t k = 0; k < f->n; k++)
            to[place[key_of(f, from[k]) >> p * DIGIT & (BUCKETS - 1)]++] = from[k];
        from = to;
        to = other;
    }
    f->order = from;
    f->hill = to;
}

/* ---- hills ---- */

static size_t
root(struct hills *s, size_t a)
{
    while (s->hill[a].joined != a) {
        s->hill[a].joined = s->hill[s->hill[a].joined].joined;
        a = s->hill[a].joined;
    }
    return a;
}

static enum rc_status
new_hill(struct hills *s, size_t peak)
{
    if (s->n == s->room) {
        size_t room = s->room == 0 ? 256 : s->room + s->room / 2;
        struct hill *more = realloc(s->hill, room * sizeof *more);

        if (more == NULL)
            return RC_FAIL;
        s->hill = more;
        s->room = room;
    }
    s->hill[s->n] = (struct hill){.peak = peak, .joined = s->n, .goes = s->n};
    s->n++;
    return RC_OK;
}

/* Node k, of one hill, touches node m, of another: hills are numbered from the highest peak down. */
static void
join(const struct field *f, struct hills *s, size_t k, size_t m)
{
    size_t a = root(s, f->hill[k]), b = root(s, f->hill[m]);
    size_t lower = a > b ? a : b, higher = a > b ? b : a;

    if (a == b)
        return;
    s->hill[lower].joined = higher;
    if (height(f, s->hill[lower].peak) - height(f, k) < f->least)
        s->hill[lower].goes = lower == a ? f->hill[m] : f->hill[k];
}

static enum rc_status
find_hills(struct field *f, struct hills *s)
{
    for (size_t k = 0; k < f->n; k++) {
        size_t node = f->order[k], up = ascent(f, node);

        if (up == SIZE_MAX && new_hill(s, node) != RC_OK)
            return RC_FAIL;
        f->hill[node] = up == SIZE_MAX ? s->n - 1 : f->hill[up];
        for (int d = 0; d < NEIGHBOURS && up != SIZE_MAX; d++) {
            size_t m = neighbour(f, node, d);

            if (m != SIZE_MAX && m != node && comes_before(f, m, node))
                join(f, s, node, m);
        }
    }
    return RC_OK;
}

/* The hill that is kept where this one is. */
static size_t
kept(struct hills *s, size_t a)
{
    while (s->hill[a].goes != a) {
        s->hill[a].goes = s->hill[s->hill[a].goes].goes;
        a = s->hill[a].goes;
    }
    return a;
}

static bool
at_edge(const struct field *f, size_t k)
{
    for (int d = 0; d < NEIGHBOURS; d++)
        if (neighbour(f, k, d) == SIZE_MAX)
            return true;
    return false;
}

static void
measure_hills(const struct field *f, struct hills *s)
{
    for (size_t k = 0; k < f->n; k++) {
        struct hill *h = &s->hill[kept(s, f->hill[f->order[k]])];

        h->nodes++;
        h->open = h->open || at_edge(f, f->order[k]);
    }
}

/* ---- parameters ---- */

/* Of hills, or of dales. */
struct figures {
    double density, curvature, five, area;
};

/* Half the sum of both second differences, positive on a peak. */
static double
curvature(const struct field *f, size_t k)
{
    const struct rc_shape *s = &f->shape;
    double z = height(f, k);
    double xx =
        (height(f, neighbour(f, k, 3)) - 2 * z + height(f, neighbour(f, k, 4))) / (s->dx * s->dx);
    double yy =
        (height(f, neighbour(f, k, 1)) - 2 * z + height(f, neighbour(f, k, 6))) / (s->dy * s->dy);

    return -0.5 * (xx + yy);
}

static void
add_up(const struct field *f, const struct hills *s, double mean, struct figures *to)
{
    struct rc_total bend = {0}, top = {0}, area = {0};
    size_t peaks = 0, closed = 0;
    double cell = f->shape.dx * f->shape.dy;

    for (size_t a = 0; a < s->n; a++) {
        const struct hill *h = &s->hill[a];

        if (h->goes != a)
            continue;
        if (!h->open) {
            rc_total_add(&area, (double)h->nodes);
            closed++;
        }
        if (at_edge(f, h->peak))
            continue;
        rc_total_add(&bend, curvature(f, h->peak));
        if (peaks < FIVE)
            rc_total_add(&top, height(f, h->peak) - f->sign * mean);
        peaks++;
    }
    to->density = (double)peaks / ((double)f->n * cell);
    to->curvature = peaks > 0 ? rc_total_value(&bend) / (double)peaks : NAN;
    to->five = peaks >= FIVE ? rc_total_value(&top) / FIVE : NAN;
    to->area = closed > 0 ? rc_total_value(&area) / (double)closed * cell : NAN;
}

/* Sets f->n, the mean and the range of what is there. */
static void
survey(struct field *f, double *mean, double *range)
{
    struct rc_total sum = {0};
    double least = INFINITY, most = -INFINITY;

    f->n = 0;
    for (size_t k = 0; k < f->shape.nx * f->shape.ny; k++) {
        if (!is_there(f->h[k]))
            continue;
        f->n++;
        rc_total_add(&sum, f->h[k]);
        least = fmin(least, f->h[k]);
        most = fmax(most, f->h[k]);
    }
    *mean = rc_total_value(&sum) / (double)f->n;
    *range = f->n > 0 ? most - least : 0;
}

static enum rc_status
measure(struct field *f, double mean, size_t (*count)[BUCKETS], struct figures *to)
{
    struct hills hills = {0};
    enum rc_status status;
    size_t n = 0;

    for (size_t k = 0; k < f->shape.nx * f->shape.ny; k++)
        if (is_there(f->h[k]))
            f->order[n++] = k;
    sort(f, count);
    if ((status = find_hills(f, &hills)) == RC_OK) {
        measure_hills(f, &hills);
        add_up(f, &hills, mean, to);
    }
    free(hills.hill);
    return status;
}

enum rc_status
rc_features(const struct rc_shape *shape, const double *h, const struct rc_surface_options *options,
            struct rc_features *a, struct rc_err *err)
{
    struct field f = {.h = h, .wraps = options->boundary == RC_PERIODIC};
    struct figures hills = {0, NAN, NAN, NAN}, dales = {0, NAN, NAN, NAN};
    size_t(*count)[BUCKETS] = NULL, *room[2] = {NULL, NULL};
    enum rc_status status = RC_OK;
    double mean, range;

    *a = (struct rc_features){NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    if (rc_shape_check(shape, err) != RC_OK)
        return RC_FAIL;
    f.shape = *shape;
    survey(&f, &mean, &range);
    if (shape->nx < 3 || shape->ny < 3 || !(range > 0))
        return RC_OK;
    f.least = prune * range;
    room[0] = f.order = rc_alloc(shape->nx * shape->ny, sizeof *f.order);
    room[1] = f.hill = rc_alloc(shape->nx * shape->ny, sizeof *f.hill);
    count = malloc(PASSES * sizeof *count);
    if (room[0] == NULL || room[1] == NULL || count == NULL)
        status = RC_FAIL;
    f.sign = 1;
    status = status == RC_OK ? measure(&f, mean, count, &hills) : status;
    f.sign = -1;
    status = status == RC_OK ? measure(&f, mean, count, &dales) : status;
    if (status == RC_OK)
        *a = (struct rc_features){.spd = hills.density,
                                  .svd = dales.density,
                                  .spc = hills.curvature,
                                  .s5p = hills.five,
                                  .s5v = dales.five,
                                  .s10z = hills.five + dales.five,
                                  .sha = hills.area,
                                  .sda = dales.area};
    else
        rc_err_set(err, "out of memory for the hills of %zu x %zu nodes", shape->nx, shape->ny);
    free(room[0]);
    free(room[1]);
    free(count);
    return status;
}

/* Room grows by halves; of a rough surface one node in twenty is a peak. */
size_t
rc_features_memory(const struct rc_shape *shape)
{
    size_t nodes = shape->nx * shape->ny;

    return 2 * nodes * sizeof(size_t) + nodes / 20 * sizeof(struct hill) +
           PASSES * BUCKETS * sizeof(size_t);
}
