/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the tests of the volume. It has strains and stresses of all voxels, and a stack of slabs. */
#ifndef VOLUME_CASE_H
#define VOLUME_CASE_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/contact_case.h"
#include "libcontact/volume/volume.h"

enum {
    STRAINS = 5
};
static const enum rc_component strains[STRAINS] = {RC_SXX, RC_SYY, RC_SXY, RC_SXZ, RC_SYZ};

/* Numbers of all voxels: RC_COMPONENTS maps for each slab. */
struct voxels {
    size_t nx, n, slabs;
    double *v;
};

static inline struct voxels
voxels_new(struct rc_shape shape, size_t slabs)
{
    struct voxels x = {shape.nx, shape.nx * shape.ny, slabs, NULL};

    x.v = calloc(x.n * slabs * RC_COMPONENTS, sizeof *x.v);
    assert_non_null(x.v);
    return x;
}

static inline double *
voxels_map(const struct voxels *x, size_t slab, enum rc_component c)
{
    return x->v + (slab * RC_COMPONENTS + c) * x->n;
}

static inline bool
voxels_strain(void *ctx, size_t slab, enum rc_component c, size_t j, double *row)
{
    const struct voxels *x = ctx;
    const double *from = voxels_map(x, slab, c) + j * x->nx;

    if (!rc_any(from, x->nx))
        return false;
    memcpy(row, from, x->nx * sizeof *row);
    return true;
}

static inline void
voxels_stress(void *ctx, size_t slab, size_t j, double *const s[RC_COMPONENTS])
{
    const struct voxels *x = ctx;

    for (int c = 0; c < RC_COMPONENTS; c++) {
        if (s[c] == NULL)
            continue;
        memcpy(voxels_map(x, slab, (enum rc_component)c) + j * x->nx, s[c], x->nx * sizeof(double));
        for (size_t i = 0; i < x->nx; i++) /* it belongs to this stack now */
            s[c][i] = NAN;
    }
    if (s[RC_SZZ] == NULL) /* a deviator has no szz */
        for (size_t i = j * x->nx; i < (j + 1) * x->nx; i++)
            voxels_map(x, slab, RC_SZZ)[i] =
                -voxels_map(x, slab, RC_SXX)[i] - voxels_map(x, slab, RC_SYY)[i];
}

/* The sum of a : b over all voxels, shears counted twice, times the thicknesses. */
static inline double
voxels_product(const struct voxels *a, const struct voxels *b, const double *thickness)
{
    double sum = 0;

    for (size_t k = 0; k < a->slabs; k++)
        for (int c = 0; c < RC_COMPONENTS; c++) {
            const double *x = voxels_map(a, k, (enum rc_component)c);
            const double *y = voxels_map(b, k, (enum rc_component)c);
            for (size_t i = 0; i < a->n; i++)
                sum += (c < RC_SXY ? 1 : 2) * thickness[k] * x[i] * y[i];
        }
    return sum;
}

/* Random strains in the slabs whose bit is set. */
static inline void
voxels_random(struct voxels *x, unsigned slabs, uint64_t *seed)
{
    for (size_t k = 0; k < x->slabs; k++)
        for (int c = 0; c < STRAINS && slabs >> k & 1; c++) {
            double *m = voxels_map(x, k, strains[c]);
            for (size_t i = 0; i < x->n; i++)
                m[i] = 1e-3 * random_number(seed);
        }
    for (size_t k = 0; k < x->slabs; k++)
        for (size_t i = 0; i < x->n; i++)
            voxels_map(x, k, RC_SZZ)[i] =
                -voxels_map(x, k, RC_SXX)[i] - voxels_map(x, k, RC_SYY)[i];
}

static inline double
voxels_largest(const struct voxels *x)
{
    double most = 0;

    for (size_t i = 0; i < x->n * x->slabs * RC_COMPONENTS; i++)
        most = fmax(most, fabs(x->v[i]));
    return most;
}

/* The largest difference over the largest number of b. */
static inline double
voxels_apart(const struct voxels *a, const struct voxels *b)
{
    double most = 0;

    for (size_t i = 0; i < a->n * a->slabs * RC_COMPONENTS; i++) {
        assert_true(isfinite(a->v[i]) && isfinite(b->v[i]));
        most = fmax(most, fabs(a->v[i] - b->v[i]));
    }
    return most / voxels_largest(b);
}

/* One application: u_r and stresses of a strain (NULL: none) and a pressure (NULL: none). */
static inline void
volume_apply(struct rc_slabs *v, struct voxels *e, const bool *strained, const double *p, double *u,
             struct voxels *s)
{
    struct rc_slab_strain strain = {strained, voxels_strain, e};
    struct rc_slab_stress stress = {NULL, voxels_stress, s};

    if (e != NULL)
        rc_slabs_up(v, &strain, u);
    if (s != NULL)
        rc_slabs_down(v, p, &stress);
}

static inline struct rc_slabs *
volume_new(struct rc_shape shape, struct rc_slabs_options options)
{
    struct rc_err err = {""};
    struct rc_slabs *v = rc_slabs_new(&shape, &options, &err);

    if (v == NULL)
        print_error("%s\n", err.text);
    assert_non_null(v);
    return v;
}

#endif
