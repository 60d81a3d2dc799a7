/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Finds the opening of the gap: nodes join in the order of decreasing gap, in sets (union-find), until the
 * sets of inlet and outlet meet. The node that joins them is the critical constriction: no path from inlet to
 * outlet has a larger smallest gap.
 *
 * The faces that join sets are the two trees of greatest gaps (Kruskal), except the face at which inlet and
 * outlet meet.
 */
#include "leak.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

enum {
    BITS = 11, /* six digits have all bits of a gap */
    DIGITS = 1 << BITS
};

/* `bits`: those of the gap. They do not form one number, because padding after it would take a quarter of the
 * memory. */
struct opening {
    uint32_t bits[2];
    int32_t node;
};

/* Positive numbers have the order of their bits. */
static size_t
digit(const struct opening *open, int shift)
{
    uint64_t bits;

    memcpy(&bits, open->bits, sizeof bits);
    return ~(bits >> shift) & (DIGITS - 1);
}

/* Sorts by one digit after the other, from the lowest, into `spare` and back. Equal gaps keep the order of
 * their nodes. */
static void
sort_by_falling_gap(struct opening *open, struct opening *spare, size_t n)
{
    for (int shift = 0; shift < 6 * BITS; shift += BITS) {
        size_t first[DIGITS] = {0}, sum = 0;
        struct opening *sorted = spare;
        for (size_t m = 0; m < n; m++)
            first[digit(open + m, shift)]++;
        for (size_t k = 0; k < DIGITS; k++) {
            sum += first[k];
            first[k] = sum - first[k];
        }
        for (size_t m = 0; m < n; m++)
            sorted[first[digit(open + m, shift)]++] = open[m];
        spare = open;
        open = sorted;
    }
}

static int32_t
find(int32_t *parent, int32_t k)
{
    while (parent[k] != k) {
        parent[k] = parent[parent[k]];
        k = parent[k];
    }
    return k;
}

/* Joins the sets of a and b; returns whether they were different. */
static bool
join(int32_t *parent, int32_t a, int32_t b)
{
    a = find(parent, a);
    b = find(parent, b);
    /* inlet and outlet are the last nodes, and so stay roots */
    parent[a > b ? b : a] = a > b ? a : b;
    return a != b;
}

static bool
met(const struct rc_passage *a, int32_t *parent)
{
    return find(parent, a->inlet) == find(parent, a->outlet);
}

static void
take_in(const struct rc_passage *a, const struct opening *open, size_t n, int32_t *parent,
        uint8_t *tree, struct rc_critical *critical)
{
    for (size_t m = 0; m < n; m++) {
        int32_t k = open[m].node;
        parent[k] = k;
        for (int d = 0; d < RC_DIRECTIONS; d++) {
            int32_t other = rc_passage_beside(a, k, (enum rc_direction)d);
            if (other < 0 || parent[other] < 0 || !join(parent, k, other))
                continue;
            if (!critical->percolates && met(a, parent)) {
                critical->percolates = true;
                critical->node = k;
                continue;
            }
            tree[k] |= (uint8_t)(1 << d);
            if (other < a->nodes)
                tree[other] |= (uint8_t)(1 << rc_opposite((enum rc_direction)d));
        }
    }
}

/* True if corners would join inlet and outlet although edges do not. */
static bool
joins_by_corners(const struct rc_passage *a, const struct opening *open, size_t n, int32_t *parent)
{
    for (size_t m = 0; m < n; m++) {
        int32_t k = open[m].node, nx = (int32_t)a->nx, below;
        bool down = k < a->nodes - nx;
        if (!down && (!a->around || a->ny == 1))
            continue;
        below = down ? k + nx : k - (a->nodes - nx);
        if (k % nx != 0 && a->g[below - 1] > 0)
            join(parent, k, below - 1);
        if (k % nx != nx - 1 && a->g[below + 1] > 0)
            join(parent, k, below + 1);
    }
    return met(a, parent);
}

/* Number of fluid nodes in a line through node k, in steps of (i, j), at most once around the map. SIZE_MAX
 * if the line ends at inlet or outlet rather than at walls. */
static size_t
run_through(const struct rc_passage *a, int32_t k, int i, int j)
{
    const long nx = (long)a->nx, ny = (long)a->ny;
    size_t n = 1;

    for (int sign = -1; sign <= 1; sign += 2) {
        long x = k % nx, y = k / nx;
        for (;;) {
            x += sign * i;
            y += sign * j;
            if (a->around)
                y = (y + ny) % ny;
            if (x < 0 || x >= nx)
                return SIZE_MAX;
            if (y < 0 || y >= ny || !(a->g[y * nx + x] > 0) || (j != 0 && n >= a->ny))
                break;
            n++;
        }
    }
    return n;
}

/* Along a diagonal nodes are sqrt(2) apart. */
static size_t
width_at(const struct rc_passage *a, int32_t k)
{
    size_t width = run_through(a, k, 0, 1), other = run_through(a, k, 1, 0);

    width = other < width ? other : width;
    for (int j = -1; j <= 1; j += 2) {
        other = run_through(a, k, 1, j);
        if (other != SIZE_MAX && sqrt(2) * (double)other < (double)width)
            width = (size_t)(sqrt(2) * (double)other);
    }
    return width;
}

enum rc_status
rc_percolation(const struct rc_passage *a, struct rc_critical *critical, uint8_t *tree,
               struct rc_err *err)
{
    int32_t *parent;
    struct opening *open;
    size_t n = 0;

    *critical = (struct rc_critical){.node = -1};
    for (int32_t k = 0; k < a->nodes; k++)
        n += a->g[k] > 0;
    /* the second half is spare, and the sets follow */
    open = rc_alloc(2 * n * sizeof *open + ((size_t)a->nodes + 2) * sizeof *parent, 1);
    if (open == NULL)
        return rc_err_set(err, "out of memory for the paths through %zu x %zu nodes", a->nx, a->ny);
    parent = (int32_t *)(open + 2 * n);
    n = 0;
    for (int32_t k = 0; k < a->nodes; k++) {
        parent[k] = -1;
        tree[k] = 0;
        if (a->g[k] > 0) {
            open[n].node = k;
            memcpy(open[n++].bits, &a->g[k], sizeof open->bits);
        }
    }
    parent[a->inlet] = a->inlet;
    parent[a->outlet] = a->outlet;
    sort_by_falling_gap(open, open + n, n);
    take_in(a, open, n, parent, tree, critical);
    if (critical->percolates)
        critical->width = width_at(a, critical->node);
    critical->percolates_diagonal = critical->percolates || joins_by_corners(a, open, n, parent);
    free(open);
    return RC_OK;
}
