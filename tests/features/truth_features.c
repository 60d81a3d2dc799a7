/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Feature parameters of ISO 25178-2 equal closed forms for waves and posts. On rough maps they equal a
 * literal implementation of Wolf's rule. By this rule the hill of least height joins the hill across its
 * highest saddle, again and again. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/exact.h"
#include "libcontact/contact.h"

static void
near_at(const char *name, double got, double expected, double tolerance)
{
    if (!(fabs(got - expected) <= tolerance * fabs(expected)) && !(isnan(got) && isnan(expected)))
        fail_msg("%s: %.17g instead of %.17g", name, got, expected);
}
#define assert_near(a, name, expected, tolerance) near_at(#name, (a).name, expected, tolerance)

static struct rc_features
measured(const struct rc_shape *shape, const double *h, struct rc_boundary boundary)
{
    const struct rc_surface_options options = {.boundary = boundary, .threads = 2};
    struct rc_features a;
    struct rc_err err;

    if (rc_features(shape, h, &options, &a, &err) != RC_OK)
        fail_msg("%s", err.text);
    return a;
}

/* ---- closed forms ---- */

/* A cos(qx x) cos(qy y) has two equal crests and two equal troughs in each of its cells. The curvature by
 * differences is 2 A (1 - cos(q dx))/dx^2 along each side. */
static void
test_wave(void **state)
{
    enum {
        NX = 120,
        NY = 88
    };
    const struct rc_shape s = {NX, NY, 1.1e-6, 1e-6};
    const double A = 0.7e-6, Lx = 24 * s.dx, Ly = 22 * s.dy;
    static double h[NX * NY];
    struct rc_features a;
    double bend = A * (1 - cos(2 * exact_pi / 24)) / (s.dx * s.dx) +
                  A * (1 - cos(2 * exact_pi / 22)) / (s.dy * s.dy);

    (void)state;
    for (size_t k = 0; k < NX * NY; k++)
        h[k] = 3e-6 + A * cos(2 * exact_pi * (double)(k % NX) / 24) *
                          cos(2 * exact_pi * (double)(k / NX) / 22);
    a = measured(&s, h, RC_PERIODIC);
    assert_near(a, spd, 2 / (Lx * Ly), rounding);
    assert_near(a, svd, 2 / (Lx * Ly), rounding);
    assert_near(a, spc, bend, summed);
    assert_near(a, s5p, A, summed);
    assert_near(a, s5v, A, summed);
    assert_near(a, s10z, 2 * A, summed);
    assert_near(a, sha, Lx * Ly / 2, rounding);
    assert_near(a, sda, Lx * Ly / 2, rounding);
}

/* Posts of 3 x 3 nodes with flat tops, 5 nodes apart: each has one peak although no node is above its
 * neighbours. All have the same curvature. The floor is one unbounded pit. */
static void
test_posts(void **state)
{
    enum {
        N = 40
    };
    const struct rc_shape s = {N, N, 2e-6, 2e-6};
    static double h[N * N];
    struct rc_features a;

    (void)state;
    for (size_t k = 0; k < N * N; k++)
        h[k] = k % N % 5 < 3 && k / N % 5 < 3 ? 1e-6 : 0;
    a = measured(&s, h, RC_PERIODIC);
    assert_near(a, spd, 64 / (N * N * s.dx * s.dy), rounding);
    assert_near(a, sha, 25 * s.dx * s.dy, rounding);
    assert_near(a, s5p, 1e-6 * (1 - 9.0 / 25), summed);
    assert_near(a, svd, 1 / (N * N * s.dx * s.dy), rounding);
    assert_true(isnan(a.s5v) && isnan(a.s10z));
}

/* A cap, and beside it a small one with its saddle at a given depth below its peak. At 4.9 % of Sz it belongs
 * to the other hill, at 5.1 % it is a separate hill. */
static void
test_threshold(void **state)
{
    enum {
        N = 41
    };
    const struct rc_shape s = {N, N, 1e-6, 1e-6};
    static double h[N * N];

    (void)state;
    for (int turn = 0; turn < 2; turn++) {
        struct rc_features a;

        for (size_t k = 0; k < N * N; k++) { /* a cone, 1 high on a base of 0 */
            double r = hypot((double)(k % N) - 20, (double)(k / N) - 20);

            h[k] = 1e-6 * fmax(0, 1 - r / 18);
        }
        /* the saddle of a needle on the cone's flank is its highest neighbour from which the surface rises */
        h[20 * N + 30] = h[20 * N + 29] + (turn == 0 ? 0.049e-6 : 0.051e-6);
        a = measured(&s, h, RC_FREE);
        assert_near(a, spd, (turn == 0 ? 1 : 2) / (N * N * s.dx * s.dy), rounding);
    }
}

static void
test_undefined(void **state)
{
    static const double flat[25], line[9] = {1, 2, 1, 2, 1, 2, 1, 2, 1},
                                  lost[9] = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    const struct rc_shape s = {5, 5, 1e-6, 1e-6}, row = {9, 1, 1e-6, 1e-6},
                          none = {3, 3, 1e-6, 1e-6};

    (void)state;
    assert_true(isnan(measured(&s, flat, RC_FREE).spd));
    assert_true(isnan(measured(&row, line, RC_FREE).spd));
    assert_true(isnan(measured(&none, lost, RC_FREE).sha));
}

/* ---- Wolf's rule, step by step ---- */

enum {
    NX = 23,
    NY = 19,
    N = NX * NY
};

struct plain {
    double h[N];
    struct rc_boundary boundary;
    int hill[N]; /* the peak of the hill of this node; -1: not measured */
};

/* Neighbour of k by (di, dj), or -1. */
static int
beside(const struct plain *p, int k, int di, int dj)
{
    int i = k % NX + di, j = k / NX + dj;

    if (p->boundary.x)
        i = (i + NX) % NX;
    if (p->boundary.y)
        j = (j + NY) % NY;
    if (i < 0 || i >= NX || j < 0 || j >= NY || isnan(p->h[j * NX + i]))
        return -1;
    return j * NX + i;
}

static int
uphill(const struct plain *p, int k, const struct rc_shape *s)
{
    double most = 0;
    int best = k;

    for (int dj = -1; dj <= 1; dj++)
        for (int di = -1; di <= 1; di++) {
            int m = beside(p, k, di, dj);

            if (m >= 0 && m != k && (p->h[m] - p->h[k]) / hypot(di * s->dx, dj * s->dy) > most) {
                most = (p->h[m] - p->h[k]) / hypot(di * s->dx, dj * s->dy);
                best = m;
            }
        }
    return best;
}

/* The highest saddle of a hill, and the hill across it. */
static double
saddle_of(const struct plain *p, int hill, int *across)
{
    double highest = -INFINITY;

    for (int k = 0; k < N; k++)
        for (int d = 0; d < 9 && p->hill[k] == hill; d++) {
            int m = beside(p, k, d % 3 - 1, d / 3 - 1);

            if (m >= 0 && p->hill[m] != hill && fmin(p->h[k], p->h[m]) > highest) {
                highest = fmin(p->h[k], p->h[m]);
                *across = p->hill[m];
            }
        }
    return highest;
}

static void
prune(struct plain *p, double least)
{
    for (;;) {
        double smallest = least;
        int gone = -1, to = -1;

        for (int k = 0; k < N; k++) {
            int across = -1;
            double height;

            if (p->hill[k] != k)
                continue;
            height = p->h[k] - saddle_of(p, k, &across);
            if (across >= 0 && height < smallest) {
                smallest = height;
                gone = k;
                to = across;
            }
        }
        if (gone < 0)
            return;
        assert_true(p->h[to] > p->h[gone]);
        for (int k = 0; k < N; k++)
            if (p->hill[k] == gone)
                p->hill[k] = to;
    }
}

static bool
is_edge(const struct plain *p, int k)
{
    for (int d = 0; d < 9; d++)
        if (beside(p, k, d % 3 - 1, d / 3 - 1) < 0)
            return true;
    return false;
}

static int
falling(const void *a, const void *b)
{
    return (*(const double *)a < *(const double *)b) - (*(const double *)a > *(const double *)b);
}

/* Density, curvature, height of the five highest, and mean area, in that order. */
static void
plain_hills(const struct rc_shape *s, struct plain *p, double out[4])
{
    double sum = 0, there = 0, least = INFINITY, most = -INFINITY, top[N] = {0}, bend = 0,
           nodes = 0, closed = 0;
    int peaks = 0;

    for (int k = 0; k < N; k++) {
        if (isnan(p->h[k])) {
            p->hill[k] = -1;
            continue;
        }
        sum += p->h[k];
        there++;
        least = fmin(least, p->h[k]);
        most = fmax(most, p->h[k]);
        for (p->hill[k] = k; uphill(p, p->hill[k], s) != p->hill[k];)
            p->hill[k] = uphill(p, p->hill[k], s);
    }
    prune(p, 0.05 * (most - least));
    for (int k = 0; k < N; k++) {
        bool open = false;
        int here = 0;

        for (int m = 0; m < N && p->hill[k] == k; m++)
            if (p->hill[m] == k) {
                here++;
                open = open || is_edge(p, m);
            }
        if (here > 0 && !open) {
            nodes += here;
            closed++;
        }
        if (here == 0 || is_edge(p, k))
            continue;
        bend -= 0.5 * ((p->h[beside(p, k, 1, 0)] - 2 * p->h[k] + p->h[beside(p, k, -1, 0)]) /
                           (s->dx * s->dx) +
                       (p->h[beside(p, k, 0, 1)] - 2 * p->h[k] + p->h[beside(p, k, 0, -1)]) /
                           (s->dy * s->dy));
        top[peaks++] = p->h[k];
    }
    qsort(top, (size_t)peaks, sizeof *top, falling);
    out[0] = peaks / (there * s->dx * s->dy);
    out[1] = peaks > 0 ? bend / peaks : NAN;
    out[2] = peaks >= 5 ? (top[0] + top[1] + top[2] + top[3] + top[4]) / 5 - sum / there : NAN;
    out[3] = closed > 0 ? nodes / closed * s->dx * s->dy : NAN;
}

/* Rough maps of several roughnesses, free and periodic along both axes or one, whole and with holes. */
static void
test_rough(void **state)
{
    const struct rc_shape s = {NX, NY, 1.1e-6, 1e-6};
    int several = 0;

    (void)state;
    for (uint64_t turn = 0; turn < 36; turn++) {
        const struct rc_selfaffine what = {
            .hurst = 0.1 + 0.15 * (double)(turn % 6), .rms_height = 1e-7, .seed = turn + 1};
        static struct plain up, down;
        double hills[4], dales[4];
        struct rc_features a;

        assert_int_equal(rc_synth_selfaffine(&s, &what, up.h, NULL), RC_OK);
        for (size_t k = 0; k < N && turn % 4 >= 2; k++)
            if (k * 104729 % 29 == 0)
                up.h[k] = NAN;
        for (size_t k = 0; k < N; k++)
            down.h[k] = -up.h[k];
        up.boundary = down.boundary = rc_boundary_of(turn % 2 == 1, (turn + turn / 6) % 2 == 1);
        plain_hills(&s, &up, hills);
        plain_hills(&s, &down, dales);
        a = measured(&s, up.h, up.boundary);
        several += hills[0] * (NX * NY * s.dx * s.dy) > 5;
        assert_near(a, spd, hills[0], summed);
        assert_near(a, spc, hills[1], summed);
        assert_near(a, s5p, hills[2], summed);
        assert_near(a, sha, hills[3], summed);
        assert_near(a, svd, dales[0], summed);
        assert_near(a, s5v, dales[2], summed);
        assert_near(a, sda, dales[3], summed);
        assert_near(a, s10z, hills[2] + dales[2], summed);
    }
    assert_true(several > 18);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_wave),      cmocka_unit_test(test_posts),
        cmocka_unit_test(test_threshold), cmocka_unit_test(test_undefined),
        cmocka_unit_test(test_rough),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
