/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The material ratio curve (Abbott and Firestone 1933): all heights, the highest first. Node k of n stands
 * for the ratios k/n to (k+1)/n, so that areas under the curve are sums. Heights between nodes are
 * interpolated from (k + 1/2)/n.
 *
 * The core's line is a least-squares fit over the 40 % with the smallest secant slope (ISO 25178-2, ISO
 * 13565-2). It meets the ratios 0 and 1 at the top and the bottom of the core. The material above the top
 * and the void below the bottom are each replaced by a triangle. It has the same area and the same range of
 * ratios.
 */
#include "areal.h"

#include <stdint.h>
#include <string.h>

#include "libcontact/memory.h"

/* ---- sorting: 16.7 million heights twice as fast as by comparing them ---- */

enum {
    DIGIT = 11,
    PASSES = 6, /* number of passes: so many of DIGIT bits make 64 */
    BUCKETS = 1 << DIGIT
};

/* Integers in the reverse order of the doubles: the highest double is the smallest integer. */
static uint64_t
key_of(double v)
{
    uint64_t bits;

    memcpy(&bits, &v, sizeof bits);
    return bits >> 63 ? bits : ~bits ^ UINT64_C(1) << 63;
}

static double
height_of(uint64_t key)
{
    uint64_t bits = key >> 63 ? key : ~(key ^ UINT64_C(1) << 63);
    double v;

    memcpy(&v, &bits, sizeof v);
    return v;
}

/* Sorts n keys digit by digit, the lowest first; returns the array that holds the result. A digit that all
 * keys share, as the lowest digits of values read from single precision, takes no pass. */
static uint64_t *
sort(uint64_t *key, uint64_t *other, size_t n, size_t (*count)[BUCKETS])
{
    memset(count, 0, PASSES * sizeof *count);
    for (size_t k = 0; k < n; k++)
        for (unsigned p = 0; p < PASSES; p++)
            count[p][key[k] >> p * DIGIT & (BUCKETS - 1)]++;
    for (unsigned p = 0; p < PASSES; p++) {
        size_t *place = count[p], sum = 0;
        uint64_t *to = other;
        if (place[key[0] >> p * DIGIT & (BUCKETS - 1)] == n)
            continue;
        for (size_t b = 0; b < BUCKETS; b++) {
            size_t here = place[b];
            place[b] = sum;
            sum += here;
        }
        for (size_t k = 0; k < n; k++)
            to[place[key[k] >> p * DIGIT & (BUCKETS - 1)]++] = key[k];
        other = key;
        key = to;
    }
    return key;
}

/* The measured heights about the mean, the highest first, in room[0] or room[1]. */
static double *
sorted_heights(const struct rc_relief *r, uint64_t *room[2], size_t (*count)[BUCKETS])
{
    size_t n = 0;
    uint64_t *key;

    for (size_t k = 0; k < r->shape.nx * r->shape.ny; k++)
        if (rc_there(r->h[k]))
            room[0][n++] = key_of(r->h[k]);
    key = sort(room[0], room[1], n, count);
    for (size_t k = 0; k < n; k++) {
        double v = height_of(key[k]) - r->mean;
        memcpy(&key[k], &v, sizeof v);
    }
    return (double *)(void *)key;
}

/* ---- the curve ---- */

/* The height with this material ratio. */
static double
height_at(const double *z, size_t n, double ratio)
{
    double place = ratio * (double)n - 0.5, below = floor(place);
    size_t k = below < 0 ? 0 : (size_t)below;

    if (below < 0 || k + 1 >= n)
        return z[k < n ? k : n - 1];
    return z[k] + (place - below) * (z[k + 1] - z[k]);
}

/* Material above a height, per area of the surface; *ratio: the material ratio there. */
static double
material_above(const double *z, size_t n, double height, double *ratio)
{
    struct rc_total sum = {0};
    size_t k = 0;

    for (; k < n && z[k] > height; k++)
        rc_total_add(&sum, z[k] - height);
    *ratio = (double)k / (double)n;
    return rc_total_value(&sum) / (double)n;
}

/* Void below a height, likewise. */
static double
void_below(const double *z, size_t n, double height, double *ratio)
{
    struct rc_total sum = {0};
    size_t k = n;

    for (; k > 0 && z[k - 1] < height; k--)
        rc_total_add(&sum, height - z[k - 1]);
    *ratio = (double)(n - k) / (double)n;
    return rc_total_value(&sum) / (double)n;
}

/* The least-squares line top + slope ratio over m nodes from `first` on. */
static void
core_line(const double *z, size_t n, size_t first, size_t m, double *top, double *slope)
{
    struct rc_total sum = {0}, product = {0};
    double base = z[first + m / 2], middle = 0.5 * (double)(m - 1), squares, mean;

    for (size_t k = 0; k < m; k++) {
        double d = z[first + k] - base; /* exactly 0 on a plateau */
        rc_total_add(&sum, d);
        rc_total_add(&product, d * ((double)k - middle));
    }
    squares = (double)m * ((double)m * (double)m - 1) / 12;
    mean = rc_total_value(&sum) / (double)m;
    *slope = m > 1 ? rc_total_value(&product) / squares * (double)n : 0;
    *top = base + mean - *slope * ((double)first + middle + 0.5) / (double)n;
}

static void
measure_core(const double *z, size_t n, struct rc_areal *a)
{
    size_t m = (size_t)floor(0.4 * (double)n + 0.5), first = 0;
    double least = INFINITY, top, slope, material, air, below;

    m = m < 1 ? 1 : m;
    for (size_t k = 0; k + m <= n; k++) {
        /* the secant spans m - 1 steps from node to node, so the last m nodes have one too */
        double drop = z[k] - z[k + m - 1];
        first = drop < least ? k : first;
        least = drop < least ? drop : least;
    }
    core_line(z, n, first, m, &top, &slope);
    a->sk = 0 - slope; /* never -0 */
    material = material_above(z, n, top, &a->smr1);
    air = void_below(z, n, top + slope, &below);
    a->smr2 = 1 - below;
    a->spk = a->smr1 > 0 ? 2 * material / a->smr1 : 0;
    a->svk = below > 0 ? 2 * air / below : 0;
}

static void
measure_volumes(const double *z, size_t n, struct rc_areal *a)
{
    double peaks = height_at(z, n, 0.1), pits = height_at(z, n, 0.8), ratio;

    a->vmp = material_above(z, n, peaks, &ratio);
    a->vmc = material_above(z, n, pits, &ratio) - a->vmp;
    a->vvv = void_below(z, n, pits, &ratio);
    a->vvc = void_below(z, n, peaks, &ratio) - a->vvv;
    a->sxp = height_at(z, n, 0.025) - height_at(z, n, 0.5);
}

enum rc_status
rc_material_ratio(const struct rc_relief *r, struct rc_areal *a, struct rc_err *err)
{
    RC_ENDS(rc_store_free) struct rc_store own = {0};
    size_t(*count)[BUCKETS] = rc_store_take(&own, PASSES, sizeof *count);
    uint64_t *room[2] = {rc_store_take(&own, r->there, sizeof **room),
                         rc_store_take(&own, r->there, sizeof **room)};
    const double *z;

    if (own.failed)
        return rc_err_set(err, "out of memory for sorting %zu heights", r->there);
    z = sorted_heights(r, room, count);
    measure_core(z, r->there, a);
    measure_volumes(z, r->there, a);
    return RC_OK;
}
