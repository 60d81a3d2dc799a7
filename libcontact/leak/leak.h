/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Flow through a gap as a network: declarations for the files of this folder. Internal: never installed.
 *
 * The map is rotated so that the fluid flows along rows, from the inlet before column 0 to the outlet after
 * the last column. Inlet and outlet are two more nodes after those of the map.
 */
#ifndef RC_LEAK_H
#define RC_LEAK_H

#include <stdint.h>

#include "libcontact/contact.h"
#include "libcontact/memory.h"

struct rc_passage {
    size_t nx, ny; /* along the flow, across it                                            */
    int32_t nodes, inlet, outlet;
    double aspect; /* length of a cell across over its length along */
    bool around;   /* the two sides join                */
    double *g;     /* gap over the largest; 0: no fluid */
    uint8_t *state;
};

enum rc_passage_state {
    RC_DRY,  /* in contact                           */
    RC_DEAD, /* fluid at rest                        */
    RC_FLOWS /* fluid on a path from inlet to outlet */
};

/* Pressures of nodes, inlet (1) and outlet (0), each as a sum of two numbers. Behind a narrow
 * constriction they differ by less than the precision of a number near 1. */
struct rc_levels {
    double *p, *rest;
};

static inline double
rc_level_difference(double p, double rest, double p_other, double rest_other)
{
    return (p - p_other) + (rest - rest_other);
}

enum rc_direction {
    RC_ON,
    RC_BACK,
    RC_DOWN,
    RC_UP,
    RC_DIRECTIONS
};

static inline enum rc_direction
rc_opposite(enum rc_direction d)
{
    return (enum rc_direction)(d ^ 1);
}

/* The neighbour of node k of the map, which may be inlet or outlet; -1: there is none, or it has no fluid. */
static inline int32_t
rc_passage_beside(const struct rc_passage *a, int32_t k, enum rc_direction d)
{
    int32_t nx = (int32_t)a->nx, other;

    switch (d) {
    case RC_ON:
        if (k % nx == nx - 1)
            return a->outlet;
        other = k + 1;
        break;
    case RC_BACK:
        if (k % nx == 0)
            return a->inlet;
        other = k - 1;
        break;
    case RC_DOWN:
        if (k < a->nodes - nx)
            other = k + nx;
        else if (a->around && a->ny > 1)
            other = k - (a->nodes - nx);
        else
            return -1;
        break;
    default:
        if (k >= nx)
            other = k - nx;
        else if (a->around && a->ny > 1)
            other = k + (a->nodes - nx);
        else
            return -1;
        break;
    }
    return a->g[other] > 0 ? other : -1;
}

/* ---- faces.c ---- */

/* The gap between two nodes of gaps a and b: g^3 of the gap in series. */
enum rc_face_rule {
    RC_HARMONIC, /* half of the distance with gap a, half with gap b */
    RC_LINEAR    /* a gap that varies linearly from a to b */
};

/* Conductance from node k in this direction, where rc_passage_beside has a node; to inlet and outlet over
 * half a cell. The unit is the cube of the largest gap. */
double rc_face(const struct rc_passage *a, enum rc_face_rule rule, int32_t k, int32_t other,
               enum rc_direction d);

/* The flow per width from node k to the next one that a moving face drags along, where both nodes have the
 * same fluid pressure: <g^-2>/<g^-3> along the path between them. Its unit is half the speed of the face
 * times the largest gap. */
double rc_face_drag(const struct rc_passage *a, int32_t k, int32_t other);

/* ---- percolation.c ---- */

/* Nodes are added in the order of decreasing gap until inlet and outlet are joined. */
struct rc_critical {
    bool percolates, percolates_diagonal;
    int32_t node; /* the node that joined them, through four neighbours */
    size_t width; /* width of the fluid around it, in nodes, in its narrowest direction */
};

/* `tree` gets for each node, as bits, the directions of its edges in the two trees of greatest gaps rooted at
 * inlet and outlet. Every node that they reach is in one of them. `state` is not used. */
enum rc_status rc_percolation(const struct rc_passage *a, struct rc_critical *critical,
                              uint8_t *tree, struct rc_err *err);

/* ---- blocks.c ---- */

/* Distinguishes still and flowing nodes in `state`. */
enum rc_status rc_blocks(struct rc_passage *a, struct rc_err *err);
/* Sets still nodes to the fluid pressure of the inlet or outlet through which they are connected, and to NAN
 * if enclosed. Sets nodes in contact to NAN. */
enum rc_status rc_blocks_fill(const struct rc_passage *a, const struct rc_levels *levels,
                              struct rc_err *err);

/* ---- ordering.c ---- */

/* A region: nodes lo .. hi - 1 of the order. Its two sides come first, then the nodes between them, from
 * `cut` on. */
struct rc_part {
    int32_t lo, cut, hi;
    int32_t left, right; /* parts of the sides; -1: none */
};

/* The flowing nodes in the order of elimination, and its parts, sides first. */
struct rc_order {
    int32_t n, parts, root; /* root: the part of all nodes; -1: there are none */
    int32_t *node;
    struct rc_part *part;
};

/* An order in which few new faces appear, found by tasks of the team that calls. The caller frees both
 * arrays. RC_FAIL when memory is short. */
enum rc_status rc_order_set(struct rc_order *o, const struct rc_passage *a, struct rc_err *err);

/* ---- elimination.c ---- */

struct rc_elimination;

/* NULL if memory is short. The passage must outlive it. Threads of the team that calls share the work. */
struct rc_elimination *rc_elimination_new(const struct rc_passage *a, int threads,
                                          struct rc_err *err);
/* The conductance from inlet to outlet, and the levels of flowing nodes, inlet and outlet unless `levels` is
 * NULL. Regions of fewer than `keep` nodes are then eliminated twice, which takes time and saves memory.
 * RC_FAIL when memory is short. */
enum rc_status rc_elimination_run(struct rc_elimination *e, enum rc_face_rule rule,
                                  const struct rc_levels *levels, int32_t keep, double *conductance,
                                  struct rc_err *err);
void rc_elimination_free(struct rc_elimination *e); /* NULL is allowed */
RC_OWNER(rc_elimination)

/* ---- bounds.c ---- */

/* Bounds of the conductance with harmonic faces, from any pressures and the trees of rc_percolation. */
enum rc_status rc_leak_bounds(const struct rc_passage *a, const uint8_t *tree,
                              const struct rc_levels *levels, int threads, double *lower,
                              double *upper, struct rc_err *err);
/* c dP: the flow from node k through a face of conductance c. */
double rc_leak_driven(const struct rc_passage *a, const struct rc_levels *levels, int32_t k,
                      int32_t other, enum rc_direction d, double *c);

#endif
