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
 *
 * Only peaks and nodes beside another hill have to be taken in that order, and only they are sorted: ascents
 * and hills are found row by row.
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
    int threads;
    unsigned char *mark; /* of each node: where its ascent leads, and the bits below */
    size_t *hill;        /* of each node; NONE where there is none */
};

enum {                 /* marks */
    PEAK = NEIGHBOURS, /* instead of the neighbour that the ascent leads to */
    ABSENT,            /* not measured                                      */
    ASCENT = 15,       /* the bits of these                                 */
    BESIDE = 16,       /* a higher neighbour is of another hill             */
    EDGE = 32,         /* a neighbour is missing                            */
    BORDER = 64        /* in the first or the last row or column            */
};

static const size_t NONE = SIZE_MAX;

struct hill {
    size_t peak;   /* node                                                      */
    size_t joined; /* a hill that it has been joined with, with a higher peak   */
    size_t goes;   /* pruned: the hill that its nodes go to; itself: it is kept */
    size_t nodes;
    bool open; /* reaches the edge or what was not measured */
};

struct hills {
    struct hill *hill;
    size_t n;
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

/* ---- ascents ---- */

static void
set_lengths(const struct field *f, double length[NEIGHBOURS])
{
    double dx = f->shape.dx, dy = f->shape.dy;

    for (int d = 0; d < NEIGHBOURS; d++)
        length[d] = sqrt(dx * dx * across[d] * across[d] + dy * dy * down[d] * down[d]);
}

/* Where the steepest ascent from node k leads. */
static unsigned char
ascent(const struct field *f, const double length[NEIGHBOURS], size_t k)
{
    double most = -1;
    unsigned char best = PEAK;

    for (int d = 0; d < NEIGHBOURS && is_there(f->h[k]); d++) {
        size_t m = neighbour(f, k, d);
        double slope;

        if (m == SIZE_MAX || !comes_before(f, m, k))
            continue;
        slope = (height(f, m) - height(f, k)) / length[d];
        if (slope > most) {
            most = slope;
            best = (unsigned char)d;
        }
    }
    return is_there(f->h[k]) ? best : ABSENT;
}

enum {
    PIECE = 256 /* nodes of a row taken together */
};

/* The same for n nodes of a row from h on that have all neighbours; rows are nx apart. */
RC_CLONES static void
ascents(const double *h, ptrdiff_t nx, double sign, const double length[NEIGHBOURS], size_t n,
        unsigned char *restrict mark)
{
    double most[PIECE], best[PIECE];

    for (size_t i = 0; i < n; i++) {
        most[i] = -1;
        best[i] = is_there(h[i]) ? PEAK : ABSENT;
    }
    for (int d = 0; d < NEIGHBOURS; d++) {
        const double *other = h + down[d] * nx + across[d], far = length[d];
        const bool first = d < NEIGHBOURS / 2; /* of equals */

        for (size_t i = 0; i < n; i++) {
            double z = sign * h[i], up = sign * other[i], slope = (up - z) / far;
            bool above = (up > z) | ((up == z) & first);
            bool better = is_there(h[i]) & is_there(other[i]) & above & (slope > most[i]);
            most[i] = better ? slope : most[i];
            best[i] = better ? d : best[i];
        }
    }
    for (size_t i = 0; i < n; i++)
        mark[i] = (unsigned char)best[i];
}

static void
find_ascents(struct field *f)
{
    size_t nx = f->shape.nx, ny = f->shape.ny;
    double length[NEIGHBOURS];

    set_lengths(f, length);
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t j = 0; j < ny; j++) {
        size_t row = j * nx;
        bool inside = j > 0 && j + 1 < ny;
        for (size_t i = 0; i < nx; i += inside ? nx - 1 : 1)
            f->mark[row + i] = ascent(f, length, row + i) | BORDER;
        for (size_t i = 1; i + 1 < nx && inside; i += PIECE)
            ascents(f->h + row + i, (ptrdiff_t)nx, f->sign, length,
                    nx - 1 - i < PIECE ? nx - 1 - i : PIECE, f->mark + row + i);
    }
}

/* Neighbour d of node k; SIZE_MAX: there is none. Inside the map it need not have been measured. */
static size_t
beside(const struct field *f, size_t k, int d)
{
    return f->mark[k] & BORDER ? neighbour(f, k, d)
                               : k + (size_t)((ptrdiff_t)f->shape.nx * down[d] + across[d]);
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

/* Nodes in two rooms, digit by digit, the lowest first, which leaves equals in the order of the map: the room
 * in which they are in order at last. */
static size_t *
sort(const struct field *f, size_t n, size_t *from, size_t *to, size_t (*count)[BUCKETS])
{
    memset(count, 0, PASSES * sizeof *count);
    for (size_t k = 0; k < n; k++)
        for (unsigned p = 0; p < PASSES; p++)
            count[p][key_of(f, from[k]) >> p * DIGIT & (BUCKETS - 1)]++;
    for (unsigned p = 0; p < PASSES; p++) {
        size_t *place = count[p], sum = 0, *other = from;

        if (place[key_of(f, from[0]) >> p * DIGIT & (BUCKETS - 1)] == n)
            continue;
        for (size_t b = 0; b < BUCKETS; b++) {
            size_t here = place[b];

            place[b] = sum;
            sum += here;
        }
        for (size_t k = 0; k < n; k++)
            to[place[key_of(f, from[k]) >> p * DIGIT & (BUCKETS - 1)]++] = from[k];
        from = to;
        to = other;
    }
    return from;
}

/* Nodes in the order in which they are taken; to be freed with `room`. */
struct nodes {
    size_t n, *room, *node;
};

/* Those whose mark has this value in these bits. */
static enum rc_status
nodes_marked(const struct field *f, int bits, int value, size_t (*count)[BUCKETS], struct nodes *to)
{
    size_t all = f->shape.nx * f->shape.ny, n = 0;

    *to = (struct nodes){0, NULL, NULL};
    for (size_t k = 0; k < all; k++)
        to->n += (f->mark[k] & bits) == value;
    if (to->n == 0)
        return RC_OK;
    if ((to->room = rc_alloc(2 * to->n, sizeof *to->room)) == NULL)
        return RC_FAIL;
    for (size_t k = 0; k < all; k++)
        if ((f->mark[k] & bits) == value)
            to->room[n++] = k;
    to->node = sort(f, n, to->room, to->room + n, count);
    return RC_OK;
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

/* A hill for each peak, numbered from the highest down. */
static enum rc_status
number_peaks(struct field *f, struct hills *s, size_t (*count)[BUCKETS])
{
    struct nodes peaks;

    if (nodes_marked(f, ASCENT, PEAK, count, &peaks) != RC_OK ||
        (s->hill = rc_alloc(peaks.n, sizeof *s->hill)) == NULL) {
        free(peaks.room);
        return RC_FAIL;
    }
    for (s->n = 0; s->n < peaks.n; s->n++) {
        s->hill[s->n] = (struct hill){.peak = peaks.node[s->n], .joined = s->n, .goes = s->n};
        f->hill[peaks.node[s->n]] = s->n;
    }
    free(peaks.room);
    return RC_OK;
}

/* Every node gets the hill of the peak that its ascent ends on. */
static void
climb(struct field *f)
{
    for (size_t k = 0; k < f->shape.nx * f->shape.ny; k++) {
        size_t m = k, hill;

        if (f->hill[k] != NONE || (f->mark[k] & ASCENT) == ABSENT)
            continue;
        while (f->hill[m] == NONE)
            m = beside(f, m, f->mark[m] & ASCENT);
        hill = f->hill[m];
        for (m = k; f->hill[m] == NONE;) {
            size_t next = beside(f, m, f->mark[m] & ASCENT);
            f->hill[m] = hill;
            m = next;
        }
    }
}

/* Marks what lies beside another hill or a gap of the map. */
static void
look_around(struct field *f)
{
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t k = 0; k < f->shape.nx * f->shape.ny; k++) {
        unsigned char found = 0;

        if (f->hill[k] == NONE)
            continue;
        for (int d = 0; d < NEIGHBOURS; d++) {
            size_t m = beside(f, k, d);
            if (m == SIZE_MAX || f->hill[m] == NONE)
                found |= EDGE;
            else if (f->hill[m] != f->hill[k] && comes_before(f, m, k))
                found |= BESIDE;
        }
        f->mark[k] |= found;
    }
}

static enum rc_status
join_hills(const struct field *f, struct hills *s, size_t (*count)[BUCKETS])
{
    struct nodes edge;

    if (nodes_marked(f, BESIDE, BESIDE, count, &edge) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < edge.n; k++)
        for (int d = 0; d < NEIGHBOURS; d++) {
            size_t node = edge.node[k], m = beside(f, node, d);

            if (m != SIZE_MAX && f->hill[m] != NONE && f->hill[m] != f->hill[node] &&
                comes_before(f, m, node))
                join(f, s, node, m);
        }
    free(edge.room);
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

static void
measure_hills(const struct field *f, struct hills *s)
{
    for (size_t k = 0; k < f->shape.nx * f->shape.ny; k++) {
        struct hill *h;

        if (f->hill[k] == NONE)
            continue;
        h = &s->hill[kept(s, f->hill[k])];
        h->nodes++;
        h->open = h->open || (f->mark[k] & EDGE) != 0;
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
        if ((f->mark[h->peak] & EDGE) != 0)
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
    struct hills hills = {NULL, 0};
    enum rc_status status;

    for (size_t k = 0; k < f->shape.nx * f->shape.ny; k++)
        f->hill[k] = NONE;
    find_ascents(f);
    if ((status = number_peaks(f, &hills, count)) == RC_OK) {
        climb(f);
        look_around(f);
        status = join_hills(f, &hills, count);
    }
    if (status == RC_OK) {
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
    size_t(*count)[BUCKETS] = NULL;
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
    f.threads = rc_useful_threads(shape, options->threads);
    f.mark = rc_alloc(shape->nx * shape->ny, sizeof *f.mark);
    f.hill = rc_alloc(shape->nx * shape->ny, sizeof *f.hill);
    count = malloc(PASSES * sizeof *count);
    if (f.mark == NULL || f.hill == NULL || count == NULL)
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
    free(f.mark);
    free(f.hill);
    free(count);
    return status;
}

/* Of a rough surface one node in twenty is a peak, and two in five lie beside a higher hill. */
size_t
rc_features_memory(const struct rc_shape *shape)
{
    size_t nodes = shape->nx * shape->ny;

    return nodes * (1 + sizeof(size_t)) + nodes / 5 * 2 * 2 * sizeof(size_t) +
           nodes / 20 * sizeof(struct hill) + PASSES * BUCKETS * sizeof(size_t);
}
