/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The error of the stresses by an error of the loads. A load that moves by dp changes the stress of each
 * component by K * dp, and the sum of the changes over the nodes is at most the sum of |dp| times the sum of
 * |K| over the nodes (Young's inequality). K is the stress of a unit load on one cell. Mises' and Tresca's
 * stress of a sum are at most the sums of those of its parts, and no principal stress changes by more than
 * the largest one of the change (Weyl). So the sum of the same measure of K bounds the change of each.
 *
 * K is evaluated where it varies: at all nodes within 13 of the cell, and beyond at the middles of blocks of
 * 3, 9, 27 ... nodes a side, each as often as it has nodes. Blocks at least five of their sides away vary
 * little: the sum is that over all nodes to some per cent.
 */
#include "stress.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum {
    HALF = 13, /* blocks on each side of the cell */
    INNER = 4, /* of them, those that the finer level covers: 3 * 4 + 1 = 13 */
    RATIO = 3, /* sides of blocks of two levels */
    LINE = HALF + 1,
    PLACES = 5, /* of the cell along an axis, from one end of the map to the other */
    SIDES = 2,  /* of the cell: K at x and -x differ if pressure and its friction act */
    NEAR = 81   /* 3 * 27: what the levels of sides 1 and 3 cover */
};

/* Of the sums over blocks, and for places of the cell between the PLACES: of 360 random maps and bodies none
 * had a larger sum by more than 1.7 %. */
static const double margin = 1.02;

/* Along one axis: how many nodes of the map block i, on each side of the cell, has for each place. */
struct axis {
    double nodes[PLACES][SIDES][LINE];
};

/* Nodes before and after the cell. On an axis that repeats K is also that of the repetitions. If both repeat,
 * waves longer than the map do not exist, except for the mean, and half a period more is enough. */
static double
reach(const struct rc_stress_task *t, bool along_x, double depth, int place, int side)
{
    const struct rc_shape *s = &t->shape;
    const double n = (double)(along_x ? s->nx : s->ny), d = along_x ? s->dx : s->dy,
                 other = along_x ? (double)s->ny * s->dy : (double)s->nx * s->dx;
    const bool repeats = along_x ? t->options.boundary.x : t->options.boundary.y,
               both = rc_repeats(t->options.boundary) == 2;
    const double first = (n - 1) * place / (PLACES - 1);

    if (!repeats)
        return (side == 0 ? n - 1 - first : first) + 0.5;
    return both ? 0.75 * fmax(n, other / d) : fmax(1.5 * n, 2 * (other + depth) / d);
}

/* Returns the farthest reach. */
static double
count_nodes(const struct rc_stress_task *t, bool along_x, double depth, double side,
            struct axis *axis)
{
    double farthest = 0;

    for (int p = 0; p < PLACES; p++)
        for (int k = 0; k < SIDES; k++) {
            const double most = reach(t, along_x, depth, p, k);

            farthest = fmax(farthest, most);
            for (int i = 0; i < LINE; i++) {
                const double from = fmax(i - 0.5, 0) * side, to = (i + 0.5) * side;

                axis->nodes[p][k][i] = fmax(0, fmin(to, most) - from);
            }
        }
    return farthest;
}

/* The measure of each stress that is added up. */
static void
measure(unsigned wanted, const double *const six_of[RC_COMPONENTS], size_t n,
        double *const size[RC_STRESSES])
{
    const bool principal = wanted >> RC_S1 & 7;

    for (int c = 0; c < RC_COMPONENTS; c++)
        for (size_t i = 0; wanted >> c & 1 && i < n; i++)
            size[c][i] = fabs(six_of[c][i]);
    if (wanted >> RC_COMPONENTS != 0)
        rc_stress_derive(wanted | (principal ? 1u << RC_S1 | 1u << RC_S3 : 0), n, six_of, size);
    for (size_t i = 0; principal && i < n; i++)
        size[RC_S1][i] = size[RC_S2][i] = size[RC_S3][i] =
            fmax(fabs(size[RC_S1][i]), fabs(size[RC_S3][i]));
}

/* The six components at a row of blocks, on one side of the cell, under the loads of the source. */
static void
combine(const struct rc_stress_task *t, size_t source, int side, size_t n,
        double kernel[RC_STRESS_KERNELS][LINE], double six[RC_COMPONENTS][LINE])
{
    memset(six, 0, RC_COMPONENTS * sizeof *six);
    for (int c = 0; c < RC_COMPONENTS; c++)
        for (int load = 0; load < RC_LOADS; load++) {
            const int k = rc_stress_kernel(t->type, load, c);
            const double sign = side == 1 && (rc_stress_parity[k] & RC_ODD_X) ? -1 : 1;

            if (!(t->components >> c & 1) || !rc_stress_has(t, load) ||
                t->load[load].source != source)
                continue;
            for (size_t i = 0; i < n; i++)
                six[c][i] += sign * t->load[load].weight * kernel[k][i];
        }
}

struct sums {
    double of[PLACES][PLACES][RC_STRESSES];
};

static void
add_row(const struct rc_stress_task *t, const struct rc_inside *inside, size_t source, double side,
        int j, int first, const struct axis axis[2], struct sums *sums)
{
    const struct rc_cell cell = {t->shape.dx, t->shape.dy};
    const size_t n = (size_t)(LINE - first);
    double x[LINE], y[LINE], kernel[RC_STRESS_KERNELS][LINE], six[RC_COMPONENTS][LINE],
        size[RC_STRESSES][LINE];
    double *out[RC_STRESS_KERNELS], *size_of[RC_STRESSES];
    const double *six_of[RC_COMPONENTS];

    for (size_t i = 0; i < n; i++) {
        x[i] = (double)(first + (int)i) * side * cell.dx;
        y[i] = (double)j * side * cell.dy;
    }
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        out[k] = kernel[k];
    for (int c = 0; c < RC_COMPONENTS; c++)
        six_of[c] = six[c];
    for (int c = 0; c < RC_STRESSES; c++)
        size_of[c] = size[c];
    t->type->coefficients(inside, &cell, t->kernels, n, x, y, out);
    for (int k = 0; k < SIDES; k++) {
        combine(t, source, k, n, kernel, six);
        measure(t->options.wanted, six_of, n, size_of);
        for (int p = 0; p < PLACES; p++)
            for (int q = 0; q < PLACES; q++) {
                const double rows = axis[1].nodes[q][0][j] + axis[1].nodes[q][1][j];

                for (int c = 0; c < RC_STRESSES; c++)
                    for (size_t i = 0; t->options.wanted >> c & 1 && rows > 0 && i < n; i++)
                        sums->of[p][q][c] +=
                            rows * axis[0].nodes[p][k][first + (int)i] * size[c][i];
            }
    }
}

/* ---- maps that repeat ---- */

/* Nodes along an axis of the map of a unit load on its middle cell: up to the farthest distance of two nodes,
 * but not beyond the blocks that are left out of the first level of coarse blocks. */
static size_t
near_nodes(size_t n, bool repeats)
{
    const size_t all = repeats ? n : 2 * n - 1;

    return all < NEAR ? all : NEAR;
}

/* True if the map has a node at this distance from the cell. */
static bool
has(size_t n, bool repeats, int place, ptrdiff_t distance)
{
    const ptrdiff_t first = (ptrdiff_t)(n - 1) * place / (PLACES - 1);

    return repeats || (distance >= -first && distance < (ptrdiff_t)n - first);
}

/* The waves of two nodes end at once in the spectrum of a load on one node. Near the surface an odd kernel
 * therefore falls as 1/distance along its axis, and its sum grows as the logarithm of the nodes. */
static double
beyond(size_t n, size_t near, bool repeats, double depth, double d)
{
    const double deep = 2; /* nodes: there these waves are down to exp(-2 pi) */

    return repeats && near < n && depth < deep * d ? log((double)n) / log((double)near) : 1;
}

static void
add_near(const struct rc_stress_task *t, const struct rc_shape *map, double depth,
         double *const v[RC_STRESSES], struct sums *sums)
{
    const struct rc_boundary b = t->options.boundary;
    const double more = fmax(beyond(t->shape.nx, map->nx, b.x, depth, map->dx),
                             beyond(t->shape.ny, map->ny, b.y, depth, map->dy));

    for (size_t k = 0; k < map->nx * map->ny; k++) {
        const ptrdiff_t x = (ptrdiff_t)(k % map->nx) - (ptrdiff_t)(map->nx / 2),
                        y = (ptrdiff_t)(k / map->nx) - (ptrdiff_t)(map->ny / 2);

        for (int p = 0; p < PLACES; p++)
            for (int q = 0; q < PLACES; q++)
                for (int c = 0;
                     c < RC_STRESSES && has(t->shape.nx, b.x, p, x) && has(t->shape.ny, b.y, q, y);
                     c++)
                    if (t->options.wanted >> c & 1)
                        sums->of[p][q][c] += more * v[c][k];
    }
}

/* The stress of waves of a unit load differs from that of a cell near it: the waves themselves are summed,
 * of a map that repeats after at most NEAR nodes. */
static enum rc_status
sum_near(const struct rc_stress_task *t, size_t source, double depth, struct sums *sums,
         struct rc_err *err)
{
    struct rc_stress_counts counts;
    struct rc_stress_task task = *t;
    size_t n;
    RC_OWNED double *v = NULL;
    double *six_of[RC_COMPONENTS], *size[RC_STRESSES];
    void *plan = NULL;
    enum rc_status status;

    task.shape.nx = near_nodes(t->shape.nx, t->options.boundary.x);
    task.shape.ny = near_nodes(t->shape.ny, t->options.boundary.y);
    task.options.ranks = NULL;
    task.options.tol = 0;
    task.options.depths = 0;
    task.counts = &counts;
    task.error = NULL;
    n = task.shape.nx * task.shape.ny;
    if ((v = calloc((2 + RC_COMPONENTS + RC_STRESSES) * n, sizeof *v)) == NULL)
        return rc_err_set(err, "out of memory for the estimated error of stresses");
    v[n / 2 + (task.shape.ny % 2 == 0 ? task.shape.nx / 2 : 0)] = 1;
    for (size_t k = 0; k < t->sources; k++)
        task.source[k] = k == source ? v : v + n;
    task.p = task.source[0];
    for (size_t c = 0; c < RC_COMPONENTS; c++)
        six_of[c] = v + (2 + c) * n;
    for (size_t c = 0; c < RC_STRESSES; c++)
        size[c] = v + (2 + RC_COMPONENTS + c) * n;
    if ((plan = rc_stress_slices_fft.new(&task, err)) == NULL)
        return RC_FAIL;
    status = rc_stress_slices_fft.slice(plan, depth, six_of, err);
    rc_stress_slices_fft.free(plan);
    if (status != RC_OK)
        return RC_FAIL;
    measure(t->options.wanted, (const double *const *)six_of, n, size);
    add_near(t, &task.shape, depth, size, sums);
    return RC_OK;
}

/* ---- all ---- */

enum rc_status
rc_stress_gain(const struct rc_stress_task *t, size_t source, double depth,
               double gain[RC_STRESSES], struct rc_err *err)
{
    const bool repeats = rc_repeats(t->options.boundary) > 0;
    struct rc_inside *inside;
    struct sums sums = {0};
    struct axis axis[2];
    double farthest = INFINITY;

    memset(gain, 0, RC_STRESSES * sizeof *gain);
    if (repeats && sum_near(t, source, depth, &sums, err) != RC_OK)
        return RC_FAIL;
    inside = t->type->new (t->solid, depth, rc_stress_shear(t) > 0,
                           (struct rc_boundary){.x = false}, err);
    if (inside == NULL)
        return RC_FAIL;
    for (double side = 1; (HALF + 0.5) * side / RATIO < farthest; side *= RATIO) {
        farthest = fmax(count_nodes(t, true, depth, side, &axis[0]),
                        count_nodes(t, false, depth, side, &axis[1]));
        for (int j = 0; j < LINE && (!repeats || side > NEAR / (2 * HALF)); j++)
            add_row(t, inside, source, side, j, side > 1 && j <= INNER ? INNER + 1 : 0, axis,
                    &sums);
    }
    for (int p = 0; p < PLACES; p++)
        for (int q = 0; q < PLACES; q++)
            for (int c = 0; c < RC_STRESSES; c++)
                gain[c] = fmax(gain[c], margin * sums.of[p][q][c]);
    rc_inside_free(inside);
    return RC_OK;
}
