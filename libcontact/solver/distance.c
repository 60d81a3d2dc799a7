/*
 * Distances to a set, in two passes: along columns by counting, along rows by looking around (as in
 * Felzenszwalb and Huttenlocher, Theory of Computing 8, 2012, d^2 is the least of f_k + (x -
 * x_k)^2, f the squares along the columns). The first NEAR nodes on either side are looked at one
 * by one; farther away blocks of 2, 4, 8, ... stand for their least f at their middle, at most a
 * quarter as wide as they are away: d is then right to a sixth, which is more than a weight needs.
 */
#include "preconditioner.h"

#include <math.h>
#include <omp.h>

enum {
    STRIP = 512, /* columns counted together                                      */
    LANES = 16,  /* nodes of a row that look around together                        */
    NEAR = 24,   /* so far, in nodes, one by one: to 9 beyond all LANES from each of them */
    LEVELS = 10  /* of blocks: 2, 4, 8, ... nodes                                   */
};
static const float far_away = 1e9f; /* steps: no node of the set in this column */

/* Steps down the columns [first, last) from the last node of the set above each row, and, on a
 * periodic map, from the other end. */
static void
count_down(const struct rc_shape *s, bool wrap, const unsigned char *w, size_t first, size_t last,
           float *run, float *steps)
{
    for (size_t i = first; i < last; i++)
        run[i - first] = far_away;
    for (size_t j = 0; wrap && j < s->ny; j++)
        for (size_t i = first; i < last; i++)
            run[i - first] = w[j * s->nx + i] ? 0 : run[i - first] + 1;
    for (size_t j = 0; j < s->ny; j++)
        for (size_t i = first; i < last; i++) {
            run[i - first] = w[j * s->nx + i] ? 0 : run[i - first] + 1;
            steps[j * s->nx + i] = run[i - first];
        }
}

static void
count_up(const struct rc_shape *s, bool wrap, const unsigned char *w, size_t first, size_t last,
         float *run, float *steps)
{
    for (size_t i = first; i < last; i++)
        run[i - first] = far_away;
    for (size_t j = s->ny; wrap && j-- > 0;)
        for (size_t i = first; i < last; i++)
            run[i - first] = w[j * s->nx + i] ? 0 : run[i - first] + 1;
    for (size_t j = s->ny; j-- > 0;)
        for (size_t i = first; i < last; i++) {
            float *at = &steps[j * s->nx + i], up = run[i - first] + 1;
            *at = up < *at ? up : *at;
            run[i - first] = *at;
        }
}

void
rc_distance_columns(const struct rc_shape *s, enum rc_boundary boundary, const unsigned char *w,
                    int threads, float *steps)
{
    bool wrap = boundary == RC_PERIODIC;

#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t first = 0; first < s->nx; first += STRIP) {
        size_t last = s->nx - first < STRIP ? s->nx : first + STRIP;
        float run[STRIP];

        count_down(s, wrap, w, first, last, run, steps);
        count_up(s, wrap, w, first, last, run, steps);
    }
}

static inline float
largest(const float *v)
{
    float most = v[0];

    for (int i = 1; i < LANES; i++)
        most = v[i] > most ? v[i] : most;
    return most;
}

/* d^2 of LANES nodes from the squares f of their columns and of NEAR on either side; false when
 * there may be less farther away. */
RC_CLONES static bool
look_around(const float *f, float step, float *restrict d2)
{
    for (int i = 0; i < LANES; i++)
        d2[i] = f[i];
    for (int k = 1; k <= NEAR; k++) {
        float s2 = step * (float)k * (step * (float)k);
        if (k % 2 == 1 && largest(d2) <= s2)
            return true;
        for (int i = 0; i < LANES; i++) {
            float a = f[i - k] + s2, b = f[i + k] + s2;
            a = a < b ? a : b;
            d2[i] = a < d2[i] ? a : d2[i];
        }
    }
    return largest(d2) <= step * (NEAR + 1) * (step * (NEAR + 1));
}

/* A row with what is beyond its ends: nothing, or half a period. */
struct line {
    size_t n, margin, length; /* length = n + 2 margin                        */
    float *f;                 /* length squares, LANES more                   */
    float *least[LEVELS];     /* of the blocks of each size                   */
};

static size_t
width(size_t level)
{
    return (size_t)2 << level;
}

static struct line
line_in(const struct rc_shape *s, bool wrap, float *room)
{
    struct line l = {.n = s->nx, .margin = wrap && s->nx / 2 > NEAR ? s->nx / 2 : NEAR, .f = room};

    l.length = l.n + 2 * l.margin;
    room += l.length + LANES;
    for (size_t q = 0; q < LEVELS; q++) {
        l.least[q] = room;
        room += l.length / width(q) + 2;
    }
    return l;
}

size_t
rc_distance_scratch(const struct rc_shape *s)
{
    struct line l = line_in(s, true, NULL);
    size_t n = l.length + LANES;

    for (size_t q = 0; q < LEVELS; q++)
        n += l.length / width(q) + 2;
    return n;
}

static void
fill(const struct line *l, bool wrap, const float *steps, float dy)
{
    float *f = l->f + l->margin;

    for (size_t k = 0; k < l->n; k++)
        f[k] = steps[k] >= far_away ? INFINITY : dy * steps[k] * (dy * steps[k]);
    for (size_t k = 0; k < l->margin + LANES; k++)
        f[l->n + k] = wrap && k < l->margin ? f[k % l->n] : INFINITY;
    for (size_t k = 1; k <= l->margin; k++)
        f[-(ptrdiff_t)k] = wrap ? f[(l->n - k % l->n) % l->n] : INFINITY;
}

/* Least f of every block, of all sizes. */
static void
gather_blocks(const struct line *l)
{
    const float *from = l->f;
    size_t n = l->length;

    for (size_t q = 0; q < LEVELS; q++) {
        float *to = l->least[q];
        for (size_t b = 0; b < n / 2; b++)
            to[b] = from[2 * b] < from[2 * b + 1] ? from[2 * b] : from[2 * b + 1];
        if (n % 2 == 1)
            to[n / 2] = from[n - 1];
        from = to;
        n = (n + 1) / 2;
    }
}

/* What a block with its middle `offset` nodes after the first of the LANES nodes gives them. */
static inline void
look_at(float least, float offset, float step, float *restrict d2)
{
    for (int i = 0; i < LANES; i++) {
        float x = step * (offset - (float)i), y = least + x * x;
        d2[i] = y < d2[i] ? y : d2[i];
    }
}

/* Level by level: blocks of one size from where the last ended to eight times their width away. */
RC_CLONES static void
look_far(const struct line *l, size_t at, float step, float *restrict d2)
{
    size_t low = at + LANES - 1 - NEAR, high = at + NEAR + 1; /* between: looked at from all */

    for (size_t q = 0; low > 0 || high < l->length; q += q + 1 < LEVELS) {
        size_t b = width(q), far = 8 * b;
        size_t away = at - low < high - at - LANES ? at - low : high - at - LANES;
        float middle = 0.5f * (float)(b - 1) - (float)at, reach;

        if (low == 0 || high >= l->length)
            away = low == 0 ? high - at - LANES : at - low;
        reach = step * (float)away;
        if (reach * reach >= largest(d2))
            return;
        if (q + 1 == LEVELS)
            far = away + 8 * b;
        for (; low > 0 && at - low < far; low = (low - 1) / b * b)
            look_at(l->least[q][(low - 1) / b], (float)((low - 1) / b * b) + middle, step, d2);
        for (; high < l->length && high - at - LANES < far; high = (high / b + 1) * b)
            look_at(l->least[q][high / b], (float)(high / b * b) + middle, step, d2);
    }
}

void
rc_distance_row(const struct rc_shape *s, enum rc_boundary boundary, float *scratch,
                const float *steps, float *d2)
{
    bool wrap = boundary == RC_PERIODIC, gathered = false;
    struct line l = line_in(s, wrap, scratch);

    fill(&l, wrap, steps, (float)s->dy);
    for (size_t i = 0; i < l.n; i += LANES) {
        float block[LANES];
        if (!look_around(l.f + l.margin + i, (float)s->dx, block)) {
            if (!gathered)
                gather_blocks(&l);
            gathered = true;
            look_far(&l, l.margin + i, (float)s->dx, block);
        }
        for (size_t k = 0; k < LANES && i + k < l.n; k++)
            d2[i + k] = block[k];
    }
}
