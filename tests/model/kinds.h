/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A small model of each row of models.list, with three points of a history, for the tests of this folder. */
#ifndef RC_TEST_KINDS_H
#define RC_TEST_KINDS_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/model/row.h"
#ifdef RC_TOYS
#include "tests/toys/relaxing.h"
#endif

enum {
    NX = 24,
    NY = 20,
    N = NX * NY,
    POINTS = 3,
    AXES = 4 /* at most these axes, the load first; others are not the load */
};

static const struct rc_shape shape = {NX, NY, 1e-6, 1e-6};
static double heights[N];

/* ---- a maker for each row ---- */

static struct rc_model *
yielding(struct rc_err *err)
{
    static const double slabs[] = {.5e-6, .6e-6, .8e-6, 1e-6, 1.3e-6, 1.6e-6};
    static const struct rc_yield_problem o = {
        .contact = {.pair.one = {0.91e9, 0.3}, .tol = 0.1, .threads = 1},
        .law = {.stress = 2e7, .modulus = 1e8},
        .slabs = 6,
        .thickness = slabs,
        .increments = 8};

    return rc_yield_new(&shape, heights, &o, err);
}

static struct rc_problem problem = {
    .pair.estar = 1e9, .tol = 1e-9, .history_part = 0.05, .threads = 1};

static struct rc_model *
elastic(struct rc_err *err)
{
    static const struct rc_elastic_asks asks = {.stiffness = true, .conductivity = {45, 16}};

    problem.hardness = 4e7; /* the first load causes yielding */
    return rc_elastic_new(&shape, heights, &problem, &asks, err);
}

/* Bodies with the same nu are tested under forces, on a dented shape. */
static struct rc_model *
friction(struct rc_err *err)
{
    static const struct rc_friction_problem law = {
        .law = {.pair.estar = 1e9, .nu = 0.3, .mu = 0.3, .tol = 1e-9, .threads = 1},
        .increments = 2,
        .fewer = 1};

    return rc_friction_new(elastic(err), heights, &law, err);
}

/* Dissimilar bodies, moved along each other: pressure and tractions are found in turn, in all increments
 * and in half of them. */
static struct rc_model *
coupled(struct rc_err *err)
{
    static const struct rc_problem contact = {
        .pair.one = {1e9, 0.4}, .pair.two.e = INFINITY, .tol = 1e-10, .threads = 1};
    struct rc_friction_problem law = {.law = {.pair.one = {1e9, 0.4},
                                              .pair.two.e = INFINITY,
                                              .mu = 0.3,
                                              .tol = 1e-8,
                                              .threads = 1},
                                      .increments = 2,
                                      .fewer = 1};

    law.inner_of_fewer[0] = rc_elastic_new(&shape, heights, &contact, NULL, err);
    return rc_friction_new(rc_elastic_new(&shape, heights, &contact, NULL, err), heights, &law,
                           err);
}

/* A rough ball, which leaves the leading edge free, rolls with a creepage and spin, at a steady state
 * or along a path; the first load dents it. */
static struct rc_model *
roller(bool path, struct rc_err *err)
{
    static const struct rc_problem contact = {
        .pair.estar = 1e9, .hardness = 4e7, .tol = 1e-9, .history_part = 0.05, .threads = 1};
    const struct rc_rolling_problem law = {
        .law = {.pair.estar = 1e9, .nu = 0.3, .mu = 0.3, .tol = 1e-8, .threads = 1}, .path = path};
    static double ball[N];

    for (size_t k = 0; k < N; k++) {
        const double x = ((double)(k % NX) - 11.5) * shape.dx,
                     y = ((double)k / NX - 9.5) * shape.dy;
        ball[k] = 0.2 * heights[k] - (x * x + y * y) / (2 * 4e-5);
    }
    return rc_rolling_new(rc_elastic_new(&shape, ball, &contact, NULL, err), &law, err);
}

static struct rc_model *
rolling(struct rc_err *err)
{
    return roller(false, err);
}

static struct rc_model *
rolling_on(struct rc_err *err)
{
    return roller(true, err);
}

static struct rc_adhesion_problem attraction = {.contact = {.pair.estar = 1e9, .threads = 1}};

/* Bodies that attract each other; the first point dents them. */
static struct rc_model *
dented(struct rc_err *err)
{
    attraction.contact.hardness = 1e8;
    attraction.contact.tol = 1e-6;
    attraction.work = 0.02;
    return rc_adhesion_new(&shape, heights, &attraction, err);
}

/* And bodies that are drawn apart in the end. */
static struct rc_model *
retracted(struct rc_err *err)
{
    attraction.contact.hardness = 0;
    attraction.contact.tol = 1e-5;
    attraction.work = 0.3;
    attraction.pull_off = true;
    return rc_adhesion_new(&shape, heights, &attraction, err);
}

/* Both bodies wear, at first on a shape that is dented. */
static struct rc_model *
wearing(struct rc_err *err)
{
    static const struct rc_problem contact = {
        .pair.estar = 1e9, .hardness = 4e7, .tol = 1e-9, .history_part = 0.05, .threads = 1};
    static const struct rc_wear_problem law = {.k = {1e-12, 3e-12}, .estar = 1e9};

    return rc_wear_new(rc_elastic_new(&shape, heights, &contact, NULL, err), heights, &law, err);
}

/* A smooth body 2 slides over a rough one that wears. */
static struct rc_model *
two_bodies(struct rc_err *err)
{
    static const struct rc_problem contact = {
        .boundary = {.x = true, .y = true}, .pair.estar = 1e9, .tol = 1e-9, .threads = 1};
    static const struct rc_wear_problem law = {
        .k = {1e-15, 0}, .estar = 1e9, .tol = 0.3, .two_bodies = true};

    return rc_wear_new(rc_elastic_new(&shape, heights, &contact, NULL, err), heights, &law, err);
}

/* A ball travels over a rough map, which its first load dents. */
static struct rc_model *
travelling(struct rc_err *err)
{
    static const struct rc_travel_problem law = {
        .track = {NX, NY, 1e-6, 1e-6}, .h1 = heights, .repeats = true, .radius = 4e-5};

    return rc_travel_new(elastic(err), &law, err);
}

/* A ball travels over a body that yields, which keeps its strain. */
static struct rc_model *
rolling_out(struct rc_err *err)
{
    static const struct rc_travel_problem law = {
        .track = {NX, NY, 1e-6, 1e-6}, .h1 = heights, .repeats = true, .radius = 4e-5};

    return rc_travel_new(yielding(err), &law, err);
}

/* Body 2 slides along y, forth and back. */
static struct rc_model *
sliding(struct rc_err *err)
{
    static struct rc_relaxation *material;
    const struct rc_problem contact = {.boundary = RC_PERIODIC, .tol = 1e-9, .threads = 1};
    struct rc_sliding_problem law = {.along_y = true};

    if (material == NULL)
        material = rc_relaxation_new(1e8, 1, (double[]){9e8}, (double[]){1e-3}, err);
    law.material = material;
    return rc_sliding_new(&shape, heights, &contact, &law, err);
}

/* Terms of three kinds: one follows at once, one takes time, and one flows. */
static struct rc_model *
viscoelastic(struct rc_err *err)
{
    static const struct rc_problem contact = {.pair.estar = 1e9, .tol = 1e-9, .threads = 1};
    static double compliance[] = {3e-10, 1e-9, 4e-6}, retardation[] = {1e-5, 0.4, 3e4};
    static struct rc_relaxation material = {
        .instant = 1e-9, .creep_terms = 3, .compliance = compliance, .retardation = retardation};
    static const struct rc_viscoelastic_problem law = {.material = &material,
                                                       .share = 0.9,
                                                       .shortest = 0.1,
                                                       .longest = 0.6,
                                                       .increments = 6,
                                                       .tol = 0.9};

    return rc_viscoelastic_new(rc_elastic_new(&shape, heights, &contact, NULL, err), heights, &law,
                               err);
}

#ifdef RC_TOYS
static struct rc_model *
relaxing(struct rc_err *err)
{
    static const struct toy_relaxing law = {.compliance = 2e-15, .tau = 2, .tol = 1e-2};

    return toy_relaxing_new(elastic(err), heights, &law, err);
}
#endif

static const struct kind {
    const char *name;
    struct rc_model *(*make)(struct rc_err *err);
    enum rc_axis axis[AXES];
    double at[POINTS][AXES];
    double tol; /* relative difference that is allowed after a restore */
    bool exact; /* the bits are the same after it */
} kinds[] = {
    {"elastic", elastic, {RC_LOAD}, {{2e-3}, {0}, {3e-3}}, 1e-6, false},
    {"yield", yielding, {RC_LOAD}, {{2e-3}, {0}, {3e-3}}, 1e-3, false},
    {"friction",
     friction,
     {RC_LOAD, RC_TANGENTIAL_X, RC_TANGENTIAL_Y},
     {{2e-3, 4e-4, 1e-4}, {1e-3, -1e-4, 1e-4}, {3e-3, 1e-4, 5e-4}},
     1e-6,
     true},
    {"friction",
     coupled,
     {RC_LOAD, RC_DISPLACEMENT_X, RC_DISPLACEMENT_Y},
     {{2e-3, 1e-8, 2e-9}, {1e-3, -1e-8, 5e-9}, {3e-3, 1e-9, 2e-8}},
     1e-6,
     false},
    {"rolling",
     rolling,
     {RC_LOAD, RC_CREEP_X, RC_CREEP_Y, RC_SPIN},
     {{2e-3, 2e-3, 0, 0}, {1e-3, -4e-3, 5e-4, 0}, {3e-3, 1e-2, 5e-3, 400}},
     1e-6,
     true},
    {"rolling",
     rolling_on,
     {RC_LOAD, RC_CREEP_X, RC_CREEP_Y, RC_POSITION},
     {{2e-3, 2e-3, 0, 0}, {1e-3, -4e-3, 5e-4, 5e-7}, {3e-3, 1e-2, 5e-3, 1e-6}},
     1e-6,
     true},
    {"adhesion", dented, {RC_LOAD}, {{4e-3}, {1e-3}, {3e-3}}, 1e-5, false},
    {"adhesion", retracted, {RC_APPROACH}, {{2e-8}, {0}, {-INFINITY}}, 1e-4, false},
    {"wear", wearing, {RC_LOAD, RC_DISTANCE}, {{2e-3, 0}, {1e-3, 2e-3}, {2e-3, 9e-3}}, 1e-5, true},
    {"wear_two_bodies",
     two_bodies,
     {RC_LOAD, RC_DISTANCE},
     {{2e-3, 0}, {1e-3, 2e-3}, {2e-3, 9e-3}},
     1e-5,
     true},
    {"travel",
     travelling,
     {RC_LOAD, RC_POSITION},
     {{2e-3, 1e-6}, {1e-3, 2e-6}, {3e-3, 2.5e-6}},
     1e-6,
     true},
    {"travel",
     rolling_out,
     {RC_LOAD, RC_POSITION},
     {{2e-3, 0}, {2e-3, 1e-6}, {2e-3, 2e-6}},
     1e-3,
     false},
    {"sliding",
     sliding,
     {RC_LOAD, RC_SPEED},
     {{2e-3, 5e-3}, {1e-3, -2e-3}, {3e-3, 1e-2}},
     1e-6,
     false},
    {"viscoelastic",
     viscoelastic,
     {RC_LOAD, RC_TIME},
     {{2e-3, 0.3}, {0, 0.5}, {3e-3, 0.6}},
     1e-6,
     true},
    {"viscoelastic",
     viscoelastic,
     {RC_APPROACH, RC_TIME},
     {{5e-8, 0.3}, {1e-8, 0.5}, {4e-8, 0.6}},
     1e-6,
     true},
#ifdef RC_TOYS
    {"relaxing", relaxing, {RC_LOAD, RC_TIME}, {{2e-3, 0.3}, {1e-3, 0.5}, {2e-3, 0.6}}, 1e-6, true},
#endif
};

enum {
    KINDS = sizeof kinds / sizeof *kinds
};

static struct rc_point
point_of(const struct kind *kind, int k)
{
    struct rc_point p = {0};

    for (int a = 0; a < AXES && (a == 0 || kind->axis[a] != RC_LOAD); a++)
        rc_point_set(&p, kind->axis[a], kind->at[k][a]);
    return p;
}

static struct rc_model *
make(const struct kind *kind)
{
    struct rc_err err = {""};
    struct rc_model *m = kind->make(&err);

    if (m == NULL)
        fail_msg("%s: %s", kind->name, err.text);
    return m;
}

static int
make_heights(void **state)
{
    const struct rc_selfaffine what = {.hurst = 0.8, .rms_slope = 0.1, .seed = 5};

    (void)state;
    return rc_synth_selfaffine(&shape, &what, heights, NULL) == RC_OK ? 0 : -1;
}

#endif
