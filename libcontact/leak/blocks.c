/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Distinguishes flowing from still fluid. A node lies on a path from inlet to outlet that passes no node
 * twice if it is in one block with an additional face between inlet and outlet (Hopcroft and Tarjan, Commun.
 * ACM 16, 1973, 372). In all other fluid the velocity is exactly zero: dead ends, which are connected through
 * a single node, and enclosed fluid.
 *
 * The depth-first search starts at the inlet and first crosses that face to the outlet. low[k] is the
 * earliest node that k, and the nodes found below it, reach by one face. The face to its own parent does not
 * count. A node is in the block of its parent when low reaches beyond that parent.
 */
#include "leak.h"

#include <math.h>
#include <stdlib.h>

enum {
    INLET_FOUND = 1,
    OUTLET_FOUND
};

struct search {
    const struct rc_passage *a;
    int32_t *found, *low; /* 0: not found yet */
    int32_t *order;       /* nodes of the map in the order of the search        */
    uint8_t *way;         /* direction to its parent; the next direction to try */
    uint8_t *next;
    int32_t n;
};

static int32_t
when(const struct search *s, int32_t k)
{
    return k == s->a->inlet ? INLET_FOUND : k == s->a->outlet ? OUTLET_FOUND : s->found[k];
}

static void
find_node(struct search *s, int32_t k, enum rc_direction way)
{
    s->order[s->n++] = k;
    s->found[k] = s->low[k] = s->n + OUTLET_FOUND;
    s->way[k] = (uint8_t)way;
    s->next[k] = 0;
}

/* Searches all nodes connected to node k, which was found from the outlet. */
static void
search_from(struct search *s, int32_t k)
{
    find_node(s, k, RC_ON);
    while (k < s->a->nodes) {
        enum rc_direction d = (enum rc_direction)s->next[k]++;
        int32_t other;
        if (d == RC_DIRECTIONS) {
            int32_t parent = rc_passage_beside(s->a, k, (enum rc_direction)s->way[k]);
            if (parent < s->a->nodes && s->low[k] < s->low[parent])
                s->low[parent] = s->low[k];
            k = parent;
            continue;
        }
        if (d == (enum rc_direction)s->way[k])
            continue;
        other = rc_passage_beside(s->a, k, d);
        if (other < 0)
            continue;
        if (when(s, other) == 0) {
            find_node(s, other, rc_opposite(d));
            k = other;
        } else if (when(s, other) < s->low[k]) {
            s->low[k] = when(s, other);
        }
    }
}

enum rc_status
rc_blocks(struct rc_passage *a, struct rc_err *err)
{
    size_t n = (size_t)a->nodes;
    struct search s = {.a = a};

    s.found = calloc(n, 3 * sizeof *s.found + 2 * sizeof *s.way); /* all arrays of the search */
    if (s.found == NULL)
        return rc_err_set(err, "out of memory for the channels of %zu x %zu nodes", a->nx, a->ny);
    s.low = s.found + n;
    s.order = s.low + n;
    s.way = (uint8_t *)(s.order + n);
    s.next = s.way + n;
    for (size_t j = 0; j < a->ny; j++) {
        int32_t k = (int32_t)((j + 1) * a->nx - 1);
        if (a->g[k] > 0 && s.found[k] == 0)
            search_from(&s, k);
    }
    for (size_t k = 0; k < n; k++)
        a->state[k] = a->g[k] > 0 ? RC_DEAD : RC_DRY;
    for (int32_t m = 0; m < s.n; m++) {
        int32_t k = s.order[m], parent = rc_passage_beside(a, k, (enum rc_direction)s.way[k]);
        if (s.low[k] < when(&s, parent) && (parent == a->outlet || a->state[parent] == RC_FLOWS))
            a->state[k] = RC_FLOWS;
    }
    free(s.found);
    return RC_OK;
}

/* Lists the still nodes connected to node k, from list[0] on, and returns their common pressure. */
static int32_t
pool_of(const struct rc_passage *a, int32_t k, const struct rc_levels *levels, int32_t *list,
        bool *seen, double *shared)
{
    int32_t n = 1;

    list[0] = k;
    seen[k] = true;
    *shared = NAN;
    for (int32_t m = 0; m < n; m++)
        for (int d = 0; d < RC_DIRECTIONS; d++) {
            int32_t other = rc_passage_beside(a, list[m], (enum rc_direction)d);
            if (other < 0)
                continue;
            if (other >= a->nodes) {
                *shared = other == a->inlet ? 1 : 0;
            } else if (a->state[other] == RC_FLOWS) {
                *shared = levels->p[other];
            } else if (!seen[other]) {
                seen[other] = true;
                list[n++] = other;
            }
        }
    return n;
}

enum rc_status
rc_blocks_fill(const struct rc_passage *a, const struct rc_levels *levels, struct rc_err *err)
{
    size_t nodes = (size_t)a->nodes;
    RC_OWNED int32_t *list = malloc(nodes * sizeof *list);
    RC_OWNED bool *seen = calloc(nodes, sizeof *seen);

    if (list == NULL || seen == NULL)
        return rc_err_set(err, "out of memory for the channels of %zu x %zu nodes", a->nx, a->ny);
    for (int32_t k = 0; k < a->nodes; k++) {
        double shared;
        if (a->state[k] == RC_DRY)
            levels->p[k] = NAN;
        if (a->state[k] != RC_DEAD || seen[k])
            continue;
        for (int32_t n = pool_of(a, k, levels, list, seen, &shared); n > 0; n--)
            levels->p[list[n - 1]] = shared;
    }
    return RC_OK;
}
