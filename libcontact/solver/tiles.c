/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A step and the return to {0 <= p <= H, sum p = S}, tile by tile.
 *
 * A node that stops at its bound causes a surplus of load. One shift of all nodes removes the surplus but
 * spreads it over the whole map. A remainder with waves as long as the map is left, and K multiplies a wave
 * by 2/(E* q). The clipped step is then too long for the energy, the more so the larger the map. Here each
 * tile of 16 x 16 nodes preserves its own load by its own shift, so no remainder has waves longer than a
 * tile. All elastic nodes share only the load that a tile cannot carry because its nodes would have to pull
 * or to exceed their upper bounds.
 *
 * The step was computed as if the stopped nodes had moved freely, so their neighbours are corrected before
 * the shift. In the quadratic form of the inverse, A, the nearest admissible point is p + d + A mu with
 * multipliers mu on the stopped nodes. One Jacobi sweep with the coefficients of A between a node and its
 * eight neighbours gives most of it. Errors after 1, 2, 3, 4 steps at 2048 x 2048, 39 % contact, rough down
 * to 2 nodes. The errors without the sweep are 0.060, 4.2e-3, 3.1e-4, 7.3e-5. With it: 0.047, 2.0e-3, 1.7e-4,
 * 3.6e-5.
 *
 * All of this is one pass over the map, with tiles in the cache.
 */
#include "solver.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "libcontact/memory.h"

enum {
    TILE = RC_TILE_ROWS, /* nodes a side */
    NODES = TILE * TILE,
    EDGE = TILE + 2, /* a tile with one more node on each side */
    /* Limit of Newton's method in a tile; 3 or 4 are enough. Half and double change no bit of 123
     * contacts (bench/constants.py). */
    ROUNDS = 60
};
/* Damping of the Jacobi sweep: without it, two stopped neighbours would be corrected too much. Not
 * sensitive: half and double change the convolutions of 123 contacts by at most 4 % together
 * (bench/constants.py). */
static const float damping = 0.8F;
/* Values of y for a node at its lower or upper bound, which the shift does not move. */
static const float stays_low = -FLT_MAX, stays_high = FLT_MAX;
/* A remainder up to this fraction of the tolerance is put into a single tile. Not sensitive: half and
 * double change no count of 123 contacts (bench/constants.py). */
static const double little = 1e-2;

/* An error of a tile's load up to this fraction is rounding. Single precision has 6e-8 for each of 256
 * nodes. Half and double change no bit of 123 contacts (bench/constants.py). */
static const double kept = 1e-5;

/* ---- one tile ---- */

/* A tile in the map: w, p, d and delta of its first node, rows of the map `stride` apart. */
struct place {
    size_t nx, ny, stride;
    const unsigned char *w;
    const float *d;
    double *p;
    float *delta;
    struct rc_box box;
};

/* A copy of a tile. The pressures after the step, y, are in single precision, in the units of the rows and
 * above the lower bound. Only the shift is computed from them; the pressures themselves are computed in
 * double precision. */
struct copy {
    double p[NODES];
    float d[NODES], on[NODES]; /* 1 on the set, else 0                                         */
    float y[NODES];            /* pressures of the set after the step; off the set: stays_low  */
    float push[NODES];         /* the correction from stopped neighbours                       */
    double sum;                /* the load of the tile after the step, counted like y          */
    bool out;                  /* a node left its bounds                                       */
    bool held_in;              /* a node at its bound would leave its bounds, and is not moved */
    /* map of bounds only: the upper bounds, and the largest y */
    double high[NODES];
    float most[NODES];
};

/* Copies n <= TILE numbers of a row, most often TILE. */
RC_INLINE void
copy_row(void *restrict to, const void *restrict from, size_t n, size_t size)
{
    if (n == TILE)
        memcpy(to, from, TILE * size);
    else
        memcpy(to, from, n * size);
}

RC_INLINE void
take(const struct place *t, struct copy *c)
{
    if (t->nx < TILE || t->ny < TILE)
        memset(c, 0, sizeof *c);
    for (size_t j = 0; j < t->ny; j++) {
        const unsigned char *w = t->w + j * t->stride;

        copy_row(c->p + j * TILE, t->p + j * t->stride, t->nx, sizeof *c->p);
        copy_row(c->d + j * TILE, t->d + j * t->stride, t->nx, sizeof *c->d);
        for (size_t i = 0; i < t->nx; i++)
            c->on[j * TILE + i] = w[i] != 0 ? 1 : 0;
    }
}

/* The upper bounds of the tile's nodes, from the map. */
RC_INLINE struct rc_box
take_bounds(const struct place *t, struct rc_box box, double scale, struct copy *c)
{
    for (size_t j = 0; j < t->ny; j++)
        memcpy(c->high + j * TILE, box.highs + j * t->stride, t->nx * sizeof *c->high);
    for (size_t k = 0; k < NODES; k++)
        c->most[k] = (float)((c->high[k] - box.low) * scale);
    box.highs = c->high;
    return box;
}

/* The largest y of a node. */
RC_INLINE float
most_of(struct rc_box box, float most, const float *mosts, size_t k)
{
    return box.highs != NULL ? mosts[k] : most;
}

/* The pressure after the step before any shift; a node at its bound that would leave its bounds stays. */
RC_INLINE double
aimed(double low, double high, double p, double v)
{
    double from_low = v < low ? p : v, from_high = v > high ? p : v;

    return p <= low ? from_low : p >= high ? from_high : v;
}

RC_INLINE void
aim(struct rc_box box, double alpha, double mean, double scale, struct copy *c)
{
    const double low = box.low, number = box.high, *map = box.highs;
    double sum = 0, most = 0, held = 0;

#pragma omp simd reduction(+ : sum, held) reduction(max : most)
    for (size_t k = 0; k < NODES; k++) {
        double e = (double)c->d[k], step = e != 0 ? alpha * (e - mean) : 0, all = c->p[k] + step;
        double high = rc_bound(map, number, k);
        double on = (double)c->on[k], v = aimed(low, high, c->p[k], all);
        double below = low - v, above = v - high;
        double out = below > above ? below : above;
        c->y[k] = on > 0 ? (float)(-below * scale) : stays_low;
        sum += on * (all - low);
        held += on * fabs(v - all);
        out *= on;
        most = out > most ? out : most;
    }
    c->sum = sum * scale;
    c->out = most > 0;
    c->held_in = held > 0;
}

/* One sweep for the multipliers; stopped nodes are put at their bounds. `near`: the coefficients of A. */
RC_INLINE void
push_back(struct rc_box box, double (*near)[3], float most, struct copy *c)
{
    float mu[EDGE * EDGE] = {0};
    const float step = damping / (float)near[1][1], x = (float)near[1][0], y = (float)near[0][1],
                xy = (float)near[0][0];

    for (size_t j = 0; j < TILE; j++)
#pragma omp simd
        for (size_t i = 0; i < TILE; i++) {
            float v = c->y[j * TILE + i], end = most_of(box, most, c->most, j * TILE + i);
            float over = v < 0 ? v : v > end ? v - end : 0;
            mu[(j + 1) * EDGE + i + 1] = v > stays_low ? -step * over : 0;
        }
    for (size_t j = 0; j < TILE; j++)
#pragma omp simd
        for (size_t i = 0; i < TILE; i++) {
            const float *m = mu + j * EDGE + i, own = m[EDGE + 1];
            float side = m[EDGE] + m[EDGE + 2], along = m[1] + m[2 * EDGE + 1];
            float corner = m[0] + m[2] + m[2 * EDGE] + m[2 * EDGE + 2], v = c->y[j * TILE + i];
            float push = x * side + y * along + xy * corner;
            push = own > 0 ? stays_low : own < 0 ? stays_high : push;
            push = v > stays_low ? push : 0;
            c->push[j * TILE + i] = push;
            c->y[j * TILE + i] = own != 0 ? push : v + push;
        }
}

/* The shift with which the nodes carry `sum`. Their load is piecewise linear in the shift, which suits
 * Newton's method. With two bounds it is neither convex nor concave, so a bracket is needed. */
RC_INLINE float
shift_of(struct rc_box box, const float *y, float most, const float *mosts, float sum)
{
    float shift = 0, low = -INFINITY, high = INFINITY;

    for (int round = 0; round < ROUNDS; round++) {
        float load = 0, slope = 0, next;

#pragma omp simd reduction(+ : load, slope)
        for (size_t k = 0; k < NODES; k++) {
            float v = y[k] + shift, end = most_of(box, most, mosts, k);
            slope += ((v > 0) & (v < end)) ? 1.0F : 0.0F;
            v = v > 0 ? v : 0;
            load += v < end ? v : end;
        }
        load -= sum;
        if (fabsf(load) <= FLT_EPSILON * sum || slope == 0)
            break;
        if (load > 0)
            high = shift;
        else
            low = shift;
        next = shift - load / slope;
        if (!(next > low && next < high))
            next = (low + high) / 2;
        if (next == shift || !isfinite(next))
            break;
        shift = next;
    }
    return shift;
}

enum { /* sums of the pass */
    SIZE,
    CARRIED,
    OUT
};

/* Sets p to y + push + shift within the bounds, in double precision, and y to the change of p. */
RC_INLINE void
settle(struct rc_box box, double alpha, double mean, double shift, double scale, struct copy *c,
       struct rc_tile *tile, double *sums)
{
    const double back = 1 / scale, low = box.low, number = box.high, *map = box.highs;
    const double rest = box.rest;
    double size = 0, carried = 0, room = INFINITY, count = 0, lost;

#pragma omp simd reduction(+ : size, carried, count) reduction(min : room)
    for (size_t k = 0; k < NODES; k++) {
        double e = (double)c->d[k], step = e != 0 ? alpha * (e - mean) : 0, p = c->p[k];
        double high = rc_bound(map, number, k);
        double v = aimed(low, high, p, p + step) + ((double)c->push[k] + shift) * back;
        double on = (double)c->on[k], below, above, left, change;
        v = v > low + rest ? v : low;
        v = v < high - rest ? v : high;
        v = on > 0 ? v : p;
        change = v - p;
        below = v - low;
        above = high - v;
        carried += on * below;
        /* a product, not a conditional: gcc 12 loses sums of vector lanes if a chain of conditionals becomes
         * branches */
        left = above < below ? above : below;
        left *= on;
        count += left > 0 ? 1 : 0;
        left = left > 0 ? left : INFINITY;
        room = left < room ? left : room;
        c->p[k] = v;
        c->y[k] = (float)(change * scale);
        size += fabs(change);
    }
    lost = c->sum * back - carried;
    *tile = (struct rc_tile){.room = room,
                             .count = (size_t)count,
                             .left = fabs(lost) > kept * fabs(c->sum) * back ? lost : 0};
    sums[SIZE] += size;
    sums[CARRIED] += carried;
}

RC_INLINE void
put(const struct place *t, const struct copy *c)
{
    for (size_t j = 0; j < t->ny; j++) {
        copy_row(t->p + j * t->stride, c->p + j * TILE, t->nx, sizeof *c->p);
        copy_row(t->delta + j * t->stride, c->y + j * TILE, t->nx, sizeof *c->y);
    }
}

RC_INLINE void
move_copy(struct rc_box box, struct copy *c, const struct place *t, const struct rc_move *m,
          double scale, struct rc_tile *tile, double *sums)
{
    const float most = (float)((box.high - box.low) * scale);
    float shift = 0;

    aim(box, m->alpha, m->mean, scale, c);
    if (c->out && c->sum > 0)
        push_back(box, m->solver->op->near.inverse, most, c);
    else
        memset(c->push, 0, sizeof c->push);
    if (c->sum <= 0) /* the tile cannot carry its load, which is negative */
        for (size_t k = 0; k < NODES; k++)
            c->push[k] = stays_low;
    else if (c->out || c->held_in)
        shift = shift_of(box, c->y, most, c->most, (float)c->sum);
    settle(box, m->alpha, m->mean, (double)shift, scale, c, tile, sums);
    put(t, c);
    sums[OUT] += c->out || c->sum <= 0;
}

/* A tile with nodes of the working set. */
RC_CLONES static void
move_tile(struct rc_box box, const struct place *t, const struct rc_move *m, double scale,
          struct rc_tile *tile, double *sums)
{
    struct copy c;

    take(t, &c);
    if (box.highs == NULL)
        move_copy(rc_box_of_numbers(box), &c, t, m, scale, tile, sums);
    else
        move_copy(take_bounds(t, box, scale, &c), &c, t, m, scale, tile, sums);
}

/* ---- all tiles ---- */

struct tiles {
    struct rc_move *m;
    size_t nx, ny; /* columns and rows of tiles */
    struct rc_tile *tiles;
    double shift; /* sum of the loads that tiles could not carry */
};

static bool
any_of(const struct place *t)
{
    unsigned any = 0;

    for (size_t j = 0; j < t->ny; j++)
        for (size_t i = 0; i < t->nx; i++)
            any |= t->w[j * t->stride + i];
    return any != 0;
}

static struct place
place_of(const struct tiles *a, size_t bx, size_t by)
{
    const struct rc_solver *s = a->m->solver;
    size_t nx = s->posed.shape.nx, ny = s->posed.shape.ny, i = bx * TILE, j = by * TILE;
    size_t k = j * nx + i;

    return (struct place){.nx = nx - i < TILE ? nx - i : TILE,
                          .ny = ny - j < TILE ? ny - j : TILE,
                          .stride = nx,
                          .w = s->set.w + k,
                          .d = a->m->d + k,
                          .p = s->it.p + k,
                          .delta = a->m->delta + k,
                          .box = rc_box(s, k)};
}

static void
move_band(struct tiles *a, size_t by)
{
    const struct rc_solver *s = a->m->solver;
    double *sums = rc_reduce_row(s, by);

    for (size_t bx = 0; bx < a->nx; bx++) {
        struct place t = place_of(a, bx, by);
        struct rc_tile *tile = a->tiles + by * a->nx + bx;

        if (any_of(&t)) {
            move_tile(t.box, &t, a->m, s->load.per_pressure, tile, sums);
            continue;
        }
        *tile = (struct rc_tile){.room = INFINITY};
        for (size_t j = 0; j < t.ny; j++)
            memset(t.delta + j * t.stride, 0, t.nx * sizeof *t.delta);
    }
}

/* ---- the load that tiles could not carry ---- */

static inline bool
elastic(const struct place *t, size_t k)
{
    return t->w[k] != 0 && rc_between(t->box, k, t->p[k]);
}

static void
shift_tile(const struct tiles *a, size_t q, double shift)
{
    const struct rc_solver *s = a->m->solver;
    struct place t = place_of(a, q % a->nx, q / a->nx);

    for (size_t j = 0; j < t.ny; j++)
        for (size_t k = j * t.stride; k < j * t.stride + t.nx; k++)
            if (elastic(&t, k)) {
                double v = rc_settled(t.box, k, t.p[k] + shift), change = v - t.p[k];
                t.p[k] = v;
                t.delta[k] += (float)(change * s->load.per_pressure);
            }
}

/* The load that this shift adds less the wanted load, and its slope. */
static struct rc_excess
excess_of(void *ctx, double shift)
{
    struct tiles *a = ctx;
    const struct rc_solver *s = a->m->solver;
    double total[RC_SUMS];

    rc_reduce_rows_begin(s);
#pragma omp parallel for num_threads(s->posed.threads) schedule(dynamic)
    for (size_t by = 0; by < a->ny; by++) {
        double *sums = rc_reduce_row(s, by);
        for (size_t q = by * a->nx; q < (by + 1) * a->nx; q++) {
            struct place t;
            if (fabs(shift) < a->tiles[q].room) {
                sums[0] += (double)a->tiles[q].count * shift;
                sums[1] += (double)a->tiles[q].count;
                continue;
            }
            t = place_of(a, q % a->nx, by);
            for (size_t j = 0; j < t.ny; j++)
                for (size_t k = j * t.stride; k < j * t.stride + t.nx; k++)
                    if (elastic(&t, k)) {
                        double v = t.p[k] + shift;
                        sums[0] += rc_clip(t.box, k, v) - t.p[k];
                        sums[1] += rc_between(t.box, k, v);
                    }
        }
    }
    rc_reduce_rows_end(s, total);
    return (struct rc_excess){.load = total[0] - a->shift, .slope = total[1]};
}

/* The tile of all ranks with the most room for load, and its room in *room. Returns the number of tiles when
 * there is none, or when another rank holds it. */
static size_t
roomiest(const struct tiles *a, double *room)
{
    const struct rc_ranks *ranks = a->m->solver->posed.rows.ranks;
    size_t best = a->nx * a->ny, none = best;
    double own, before;

    *room = 0;
    for (size_t q = 0; q < a->nx * a->ny; q++) {
        double here = a->tiles[q].count > 0 ? (double)a->tiles[q].count * a->tiles[q].room : 0;
        if (here > *room) {
            *room = here;
            best = q;
        }
    }
    own = *room;
    *room = rc_ranks_most(ranks, own);
    before = rc_ranks_sum_before(ranks, own == *room);
    if (own < *room || before > 0)
        best = none;
    return best;
}

/* Spreads the rest over all elastic nodes; false when they cannot carry it. */
static bool
share(struct tiles *a, double rest)
{
    const struct rc_solver *s = a->m->solver;
    const struct rc_bounds *bounds = &s->posed.bounds;
    double sum = s->load.sum, count = 0, end, shift;

    for (size_t q = 0; q < a->nx * a->ny; q++)
        count += (double)a->tiles[q].count;
    count = (double)rc_ranks_sum(s->posed.rows.ranks, (size_t)count);
    end = rest < 0 ? -rc_above(bounds, sum) : rc_reach(bounds, rest);
    a->shift = rest;
    if (count == 0 || (excess_of(a, end).load > 0) != (rest > 0))
        return false;
    shift =
        rc_newton(excess_of, a, fmin(end, 0), fmax(end, 0), rest / count, 4 * DBL_EPSILON * sum);
#pragma omp parallel for num_threads(s->posed.threads) schedule(static)
    for (size_t q = 0; q < a->nx * a->ny; q++)
        if (a->tiles[q].count > 0)
            shift_tile(a, q, shift);
    a->m->size += count * fabs(shift);
    return true;
}

/* ---- on a line ---- */

/* The tiles of a row or a column form one sequence across all ranks; every rank processes all of them. */
void
rc_tile_line_new(struct rc_tile_line *line, const struct rc_posed *posed, struct rc_store *own)
{
    const struct rc_shape *whole = &posed->whole;
    size_t count = rc_ranks_count(posed->rows.ranks), unit = rc_rows_unit(whole->nx);

    *line = (struct rc_tile_line){0};
    if (count == 1 || (whole->nx > 1 && whole->ny > 1))
        return;
    line->tiles = rc_store_take(own, rc_tiles(whole), sizeof *line->tiles);
    line->from = rc_store_take(own, count + 1, sizeof *line->from);
    for (size_t r = 0; r <= count && line->from != NULL; r++) {
        struct rc_shape before = *whole;
        before.ny = rc_rows_dealt(whole->ny, unit, count, r);
        line->from[r] = rc_tiles(&before);
    }
}

/* A line of tiles, and which of them are held here. */
struct along {
    const struct tiles *own;
    struct rc_tile *tiles;
    size_t first, end;
};

struct group {
    double left, room, count; /* the same as for a tile */
};

/* The load that tiles cannot carry goes to the elastic nodes of the smallest group of 2, 4, 8, ... tiles that
 * can carry it. Loads spread over the whole line would be moved far. On a line this matters, because the
 * error of the displacement then grows as the square root of the length (on a map only as its logarithm). A
 * random walk of 262144 nodes with 30 % contact takes 8 steps, without groups 62. */
static struct group
keep_within(const struct along *a, size_t first, size_t n, double *sums)
{
    struct rc_tile *tile = a->tiles + first;
    struct group one, other, g = {tile->left, tile->room, (double)tile->count};
    double shift;

    if (n == 1)
        return g;
    one = keep_within(a, first, n / 2, sums);
    other = keep_within(a, first + n / 2, n - n / 2, sums);
    g = (struct group){one.left + other.left, fmin(one.room, other.room), one.count + other.count};
    shift = g.left / g.count;
    if (g.left == 0 || !(fabs(shift) < g.room / 2))
        return g;
    for (size_t q = first; q < first + n; q++) {
        a->tiles[q].room -= fabs(shift);
        if (q >= a->first && q < a->end && a->tiles[q].count > 0)
            shift_tile(a->own, q - a->first, shift);
    }
    sums[CARRIED] += g.left;
    sums[SIZE] += fabs(g.left);
    return (struct group){0, g.room - fabs(shift), g.count};
}

/* Only the rank with the first row adds the sums, so that they are counted once. */
static void
keep_on_line(const struct tiles *own, const struct rc_tile_line *line)
{
    const struct rc_solver *s = own->m->solver;
    const struct rc_rows *rows = &s->posed.rows;
    size_t n = own->nx * own->ny, all = rc_tiles(&s->posed.whole);
    struct along a = {own, own->tiles, 0, n};
    double nowhere[RC_SUMS] = {0};

    if (line->tiles != NULL) {
        size_t r = rc_ranks_own(rows->ranks);
        a = (struct along){own, line->tiles, line->from[r], line->from[r + 1]};
        rc_ranks_move(rows->ranks, sizeof *a.tiles, line->from, NULL, 0, own->tiles, a.tiles);
    }
    (void)keep_within(&a, 0, all, rows->first == 0 && n > 0 ? rc_reduce_row(s, 0) : nowhere);
    if (line->tiles != NULL)
        memcpy(own->tiles, a.tiles + a.first, n * sizeof *a.tiles);
}

size_t
rc_tiles(const struct rc_shape *shape)
{
    return ((shape->nx + TILE - 1) / TILE) * ((shape->ny + TILE - 1) / TILE);
}

bool
rc_move_tiles(struct rc_move *m)
{
    const struct rc_solver *s = m->solver;
    struct tiles a = {.m = m,
                      .nx = (s->posed.shape.nx + TILE - 1) / TILE,
                      .ny = (s->posed.shape.ny + TILE - 1) / TILE};
    double total[RC_SUMS], sum = s->load.sum, rest, room;
    size_t q;

    a.tiles = m->tiles;
    rc_reduce_rows_begin(s);
#pragma omp parallel for num_threads(s->posed.threads) schedule(dynamic)
    for (size_t by = 0; by < a.ny; by++)
        move_band(&a, by);
    if (s->posed.whole.nx == 1 || s->posed.whole.ny == 1)
        keep_on_line(&a, m->line);
    rc_reduce_rows_end(s, total);
    m->size = total[SIZE];
    m->clipped = total[OUT] > 0;
    rest = rc_above(&s->posed.bounds, sum) - total[CARRIED] -
           rc_rooms(&s->posed.bounds, s->set.saturated);
    if (fabs(rest) <= 4 * DBL_EPSILON * sum)
        return true;
    q = roomiest(&a, &room);
    if (fabs(rest) <= little * s->load.tol * sum && fabs(rest) < room / 2) {
        if (q < a.nx * a.ny)
            shift_tile(&a, q, rest / (double)a.tiles[q].count);
        return true;
    }
    return share(&a, rest);
}
