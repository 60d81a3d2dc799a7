/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A relief is a closed block. Every edge occurs once in each direction, its volume is the volume under the
 * map, and its upper face is the map to scale. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "decoders.h"

struct edge {
    float from[3], to[3];
};

static int
order(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(struct edge));
}

static struct edge
edge_of(const float *a, const float *b)
{
    struct edge e;

    memcpy(e.from, a, sizeof e.from);
    memcpy(e.to, b, sizeof e.to);
    return e;
}

/* Edges of n triangles; each must occur once, and so must its reverse. */
static void
check_closed(const float (*corner)[3][3], size_t n)
{
    struct edge *edge = calloc(3 * n, sizeof *edge);

    assert_non_null(edge);
    for (size_t t = 0; t < n; t++)
        for (int k = 0; k < 3; k++)
            edge[3 * t + (size_t)k] = edge_of(corner[t][k], corner[t][(k + 1) % 3]);
    qsort(edge, 3 * n, sizeof *edge, order);
    for (size_t e = 0; e < 3 * n; e++) {
        struct edge back = edge_of(edge[e].to, edge[e].from);

        assert_true(e == 0 || order(&edge[e - 1], &edge[e]) != 0);
        assert_non_null(bsearch(&back, edge, 3 * n, sizeof *edge, order));
    }
    free(edge);
}

/* The volume by the divergence theorem: a sixth of the sum of a . (b x c). */
static double
volume(const float (*corner)[3][3], size_t n)
{
    double sum = 0;

    for (size_t t = 0; t < n; t++)
        for (int k = 0; k < 3; k++) {
            double b1 = (double)corner[t][1][(k + 1) % 3], b2 = (double)corner[t][1][(k + 2) % 3];
            double c1 = (double)corner[t][2][(k + 1) % 3], c2 = (double)corner[t][2][(k + 2) % 3];

            sum += (double)corner[t][0][k] * (b1 * c2 - b2 * c1) / 6;
        }
    return sum;
}

/* The volume under the triangles of the cells: the height of a prism is the mean of its three corners. The
 * diagonal runs from the upper left to the lower right. */
static double
volume_wanted(const struct rc_grid *g, double across, double up, double lowest)
{
    double sum = 0;

    for (size_t j = 0; j + 1 < g->ny; j++)
        for (size_t i = 0; i + 1 < g->nx; i++) {
            const double *v = g->v + j * g->nx + i;

            sum += (2 * v[0] + 2 * v[g->nx + 1] + v[1] + v[g->nx] - 6 * lowest) / 6 * up + 2;
        }
    return sum * g->dx * across * g->dy * across;
}

static void
check_relief(size_t nx, size_t ny, double relief)
{
    struct rc_grid *g = random_grid(nx, ny, 0);
    double longer = fmax((double)(nx - 1) * g->dx, (double)(ny - 1) * g->dy), low = g->v[0];
    double high = low, across = 100 / longer, up, found = 0;
    struct rc_export_wish wish = plain_export;
    struct written made;
    float(*corner)[3][3];
    size_t n;

    for (size_t k = 0; k < nx * ny; k++) {
        low = fmin(low, g->v[k]);
        high = fmax(high, g->v[k]);
    }
    wish.relief = relief;
    up = relief > 0 ? 1e3 * relief / (high - low) : across;
    made = export("stl", &g, 1, &wish);
    n = count(made.bytes + 80, 4);
    assert_int_equal(n, 2 * (nx - 1) * (ny - 1) + 6 * (nx + ny - 2));
    assert_int_equal(made.n, 84 + 50 * n);
    assert_memory_not_equal(made.bytes, "solid", 5); /* a text file begins like this */
    corner = calloc(n, sizeof *corner);
    assert_non_null(corner);
    for (size_t t = 0; t < n; t++) {
        const char *at = made.bytes + 84 + 50 * t;
        double u[3], v[3], along = 0;

        for (int k = 0; k < 9; k++)
            corner[t][k / 3][k % 3] = (float)f32(at + 12 + 4 * k);
        for (int k = 0; k < 3; k++) {
            u[k] = (double)corner[t][1][k] - (double)corner[t][0][k];
            v[k] = (double)corner[t][2][k] - (double)corner[t][0][k];
        }
        for (int k = 0; k < 3; k++)
            along += f32(at + 4 * k) *
                     (u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
        assert_true(along > 0); /* the normal agrees with the order of the corners */
        assert_int_equal(bits(at + 48, 2), 0);
    }
    check_closed((const float(*)[3][3])corner, n);
    if (!(fabs(volume((const float(*)[3][3])corner, n) / volume_wanted(g, across, up, low) - 1) <
          1e-5))
        fail_msg("%zu x %zu: the volume is %g mm3, not %g", nx, ny,
                 volume((const float(*)[3][3])corner, n), volume_wanted(g, across, up, low));
    for (size_t k = 0; k < nx * ny; k++) { /* each node is a corner at its position and height */
        double x = (double)(k % nx) * g->dx * across,
               y = (double)(ny - 1 - k / nx) * g->dy * across;
        double z = 2 + (g->v[k] - low) * up;
        bool there = false;

        for (size_t c = 0; c < 3 * n && !there; c++) {
            const float *p = corner[c / 3][c % 3];

            there = fabs((double)p[0] - x) < 1e-4 && fabs((double)p[1] - y) < 1e-4 &&
                    fabs((double)p[2] - z) < 1e-5 * (1 + z);
        }
        found += there;
    }
    assert_true(found == (double)(nx * ny));
    free(corner);
    free(made.bytes);
    rc_grid_free(g);
}

static void
closed_and_to_scale(void **state)
{
    (void)state;
    check_relief(2, 2, 0);
    check_relief(2, 9, 0);
    check_relief(17, 11, 0);
    check_relief(17, 11, 5e-3);
}

static void
refusals(void **state)
{
    struct rc_grid *g = random_grid(1, 5, 0), *holes = random_grid(9, 9, 0.5);

    (void)state;
    refuse_export("stl", &g, 1, &plain_export, "needs two columns and rows, this map has 1 and 5");
    refuse_export("stl", &holes, 1, &plain_export, "rc-detrend --fill");
    rc_grid_free(g);
    rc_grid_free(holes);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_and_to_scale),
        cmocka_unit_test(refusals),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
