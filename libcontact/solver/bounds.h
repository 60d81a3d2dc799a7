/*
 * The bounds of the pressure: nothing else in this folder knows what they are. The lower one is 0,
 * for bodies do not pull; the upper one is the hardness, a number or a map, or none.
 *
 * Loops over nodes ask a box, the bounds of the nodes from some node on. Where a loop is hot, its
 * body is an RC_INLINE function, which an RC_CLONES function calls twice: with rc_box_of_numbers,
 * so that the compiler knows that there is no map and the loop is that of two numbers, and with the
 * box as it is. A lower bound that is a map goes the way of `highs`: here, and in the tile that
 * tiles.c takes out of the map.
 */
#ifndef RC_BOUNDS_H
#define RC_BOUNDS_H

#include "libcontact/common.h"

#define RC_INLINE static inline __attribute__((always_inline))

struct rc_box {
    double low, high;    /* Pa                                                                 */
    const double *highs; /* Pa, node by node, instead of high; NULL: high is that of all nodes */
    double per_unit;     /* rooms times this are those of rc_room                              */
};

struct rc_bounds {
    struct rc_box box; /* of the nodes held here; an upper bound of INFINITY is none         */
    double unit;       /* Pa: rooms between the bounds are counted in it                     */
    double highest;    /* Pa: the largest upper bound that is a number, or the lower one     */
    bool open;         /* some node has no upper bound                                       */
    double floor;      /* what all nodes of the map at their lower bounds add up to, Pa      */
    double full;       /* and at their upper ones                                            */
    double *own;       /* the map that is asked, once it is kept                             */
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
    return (struct rc_box){.low = box.low, .high = box.high};
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

/* How far its bounds are apart, in units: 1 where all nodes have the same, so that sums are counts. */
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

/* ---- of the map ---- */

/* A sum of rc_room, in Pa. */
static inline double
rc_rooms(const struct rc_bounds *b, double sum)
{
    return sum > 0 ? sum * b->unit : 0; /* none of no bound is none */
}

/* Of a sum over the map what is above the lower bounds. */
static inline double
rc_above(const struct rc_bounds *b, double sum)
{
    return sum - b->floor;
}

/* A shift that brings every node from anywhere in the box to its upper bound, or by `amount`, where there
 * is a node without one. */
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

/* A node that is not on the working set, nor wants to be, carries nothing. */
static inline bool
rc_bare(const struct rc_bounds *b)
{
    return !rc_bounded(b) && b->box.low == 0;
}

/* Those of the problem on this map: sums and figures at first; nodes can be asked once they are
 * kept. All ranks call it, and get the same. RC_FAIL for a map that holds what is no bound, and for
 * a number beside it. A map of one number is that number. */
enum rc_status rc_bounds_of(struct rc_bounds *b, const struct rc_problem *problem,
                            const struct rc_shape *whole, struct rc_err *err);
/* Copies what belongs to the n nodes held here. RC_FAIL when memory is short, here alone. */
enum rc_status rc_bounds_keep(struct rc_bounds *b, size_t n);
void rc_bounds_free(struct rc_bounds *b);
/* The problem that has these; `highs`: the map of another grid, where there is one. */
void rc_bounds_pose(const struct rc_bounds *b, const double *highs, struct rc_problem *problem);
/* RC_FAIL when they cannot carry this load (N) on so many cells (m2). */
enum rc_status rc_bounds_carry(const struct rc_bounds *b, double load, double cell, size_t nodes,
                               struct rc_err *err);

#endif
