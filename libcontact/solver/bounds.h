/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The bounds of the pressure. No other file of this folder knows their values. The lower bound is 0, because
 * the bodies do not attract each other. The upper bound is the hardness: a number, a map, or none.
 *
 * Loops over nodes use a box: the bounds of the nodes that follow a given node. The body of a hot loop is an
 * RC_INLINE function that an RC_CLONES function calls twice. It passes rc_box_of_numbers, where the compiler
 * sees two numbers and no map, and then the box itself. A map of lower bounds would need code like that for
 * `highs`, here and in tiles.c, which copies a tile of it.
 */
#ifndef RC_BOUNDS_H
#define RC_BOUNDS_H

#include <float.h>
#include <math.h>

#include "libcontact/common.h"

#define RC_INLINE static inline __attribute__((always_inline))

struct rc_box {
    double low, high;    /* Pa                                                                 */
    const double *highs; /* Pa, node by node, in place of high; NULL: high holds for all nodes */
    double rest;         /* Pa: a pressure this near to a bound is at the bound within rounding */
    double per_unit;     /* 1/Pa: 1 / rc_bounds.unit, for rc_room                              */
};

struct rc_bounds {
    struct rc_box box; /* bounds of the nodes held here; INFINITY: no upper bound */
    double unit;       /* Pa: unit of the distance between the bounds                 */
    double highest;    /* Pa: the largest finite upper bound, or the lower one        */
    bool open;         /* some node has no upper bound                                */
    double floor;      /* Pa: the sum of the lower bounds of all nodes of the map     */
    double full;       /* Pa: the sum of the upper bounds                             */
    double *own;       /* copy of the map of upper bounds; NULL before rc_bounds_keep */
};

/* ---- of a node ---- */

static inline struct rc_box
rc_box_at(const struct rc_bounds *b, size_t first)
{
    struct rc_box box = b->box;

    if (box.highs != NULL)
        box.highs += first;
    return box;
}

static inline struct rc_box
rc_box_of_numbers(struct rc_box box)
{
    return (struct rc_box){.low = box.low, .high = box.high, .rest = box.rest};
}

static inline double
rc_low(struct rc_box box, size_t k)
{
    (void)k;
    return box.low;
}

static inline double
rc_bound(const double *map, double number, size_t k)
{
    return map != NULL ? map[k] : number;
}

static inline double
rc_high(struct rc_box box, size_t k)
{
    return rc_bound(box.highs, box.high, k);
}

/* The distance between the bounds of a node, in units. Without a map of bounds the distance is 1, so
 * that a sum of distances counts nodes. */
static inline double
rc_room(struct rc_box box, size_t k)
{
    return box.highs != NULL ? (box.highs[k] - box.low) * box.per_unit : 1;
}

static inline bool
rc_at_low(struct rc_box box, size_t k, double p)
{
    return p <= rc_low(box, k);
}

static inline bool
rc_at_high(struct rc_box box, size_t k, double p)
{
    return p >= rc_high(box, k);
}

static inline bool
rc_between(struct rc_box box, size_t k, double p)
{
    return p > rc_low(box, k) && p < rc_high(box, k);
}

static inline double
rc_clip(struct rc_box box, size_t k, double p)
{
    double low = rc_low(box, k), high = rc_high(box, k);

    p = p > low ? p : low;
    return p < high ? p : high;
}

/* rc_clip for a pressure that is kept: a pressure within rounding of a bound is set to it. Without this,
 * nodes could end a few units in the last place below the hardness and count as elastic. This happens when
 * the load is a whole number of nodes times the hardness. */
static inline double
rc_settled(struct rc_box box, size_t k, double p)
{
    double low = rc_low(box, k), high = rc_high(box, k);

    p = p > low + box.rest ? p : low;
    return p < high - box.rest ? p : high;
}

/* The box for numbers as large as `most`, where rounding can exceed `rest`. */
static inline struct rc_box
rc_box_rounded(struct rc_box box, double most)
{
    if (box.rest > 0)
        box.rest = fmax(box.rest, 4 * DBL_EPSILON * most);
    return box;
}

/* ---- of the map ---- */

/* A sum of rc_room, converted to Pa. */
static inline double
rc_rooms(const struct rc_bounds *b, double sum)
{
    return sum > 0 ? sum * b->unit : 0; /* 0 times an unlimited unit is 0 */
}

/* The part of a sum over the map that is above the lower bounds. */
static inline double
rc_above(const struct rc_bounds *b, double sum)
{
    return sum - b->floor;
}

/* A shift that brings every node of the box to its upper bound; at least `amount` if a node has no upper
 * bound. */
static inline double
rc_reach(const struct rc_bounds *b, double amount)
{
    return fmax(b->highest - b->box.low, b->open ? amount : 0);
}

/* Some node has an upper bound. */
static inline bool
rc_bounded(const struct rc_bounds *b)
{
    return b->highest > b->box.low;
}

/* Nodes off the working set carry no pressure: there is no upper bound, and the lower bound is 0. */
static inline bool
rc_bare(const struct rc_bounds *b)
{
    return !rc_bounded(b) && b->box.low == 0;
}

/* Finds the bounds of this problem and their sums. rc_bounds_keep then copies the map; only after it may the
 * functions for single nodes be called. All ranks call it, and all get the same sums. RC_FAIL for a map with
 * invalid bounds, and for a map and a number together. A map of one value counts as that number. */
enum rc_status rc_bounds_of(struct rc_bounds *b, const struct rc_problem *problem,
                            const struct rc_shape *whole, struct rc_err *err);
/* Copies the bounds of the n nodes held here. RC_FAIL when memory is short, on this rank only. */
enum rc_status rc_bounds_keep(struct rc_bounds *b, size_t n);
void rc_bounds_free(struct rc_bounds *b);
/* Poses a problem with these bounds; `highs`: the map on that problem's grid, NULL without a map. */
void rc_bounds_pose(const struct rc_bounds *b, const double *highs, struct rc_problem *problem);
/* Sets `rest` for nodal pressures of this sum: 1e-14 of the sum. Without an upper bound nodes reach the lower
 * bound exactly. */
void rc_bounds_keep_load(struct rc_bounds *b, double sum);
/* RC_FAIL if nodes with these bounds cannot carry this load (N). */
enum rc_status rc_bounds_carry(const struct rc_bounds *b, double load, double cell, size_t nodes,
                               struct rc_err *err);

#endif
