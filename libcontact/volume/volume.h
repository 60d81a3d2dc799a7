/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The effect of eigenstrain on a half-space, and of a pressure inside it: a stack of slabs under a periodic
 * map. Internal: never installed.
 *
 * e is an eigenstrain (for example plastic strain, a deviator), uniform over the thickness of a slab at each
 * node. p is a pressure on the surface. With stresses averaged over the thickness of a slab,
 *
 * u_r = S' e displacement of the surface due to e, into the body, m
 *     sigma = S p - G e       stress, tension positive, Pa
 *
 * of a linear half-space with shear modulus mu and Poisson's ratio nu. S' is the transpose of S: for a p with
 * mean 0 the sum of p u_r over the nodes has a counterpart. It equals that of e : S p times h over the
 * voxels. G is symmetric in the same sums. On deviators 0 <= G + S K_cc^-1 S' <= 2 mu for any set c of nodes
 * in contact.
 *
 * A sheet of strain emits three waves of each wave vector down and three up, which decay with distance
 * (nuclei of strain: Mindlin and Cheng, J. Appl. Phys. 21, 1950, 926; their waves: Frerot et al., Comput.
 * Methods Appl. Mech. Engrg. 351, 2019, 951); slabs are integrals of sheets. So one sweep up collects the
 * waves that reach the surface. The surface reflects them and adds the pressure, and one sweep down gives the
 * stresses: sweep_body.h has the formulae.
 *
 *     rc_slabs_up(v, &strain, u_r);           needs e, gives u_r
 *     ...                                     the caller finds p, from u_r
 *     rc_slabs_down(v, p, &stress);           needs p, gives sigma slab by slab
 *
 * Mean: waves of wave number 0 do not decay with depth. A mean pressure causes szz = -p and, as in rc_stress,
 * sxx = syy = -(1 + 2 nu) p/2. On a profile, or across the axis if only one repeats, it causes -p in the
 * direction of the profile and -2 nu p in the other. The mean of e causes the stress of a slab fixed in its
 * plane, and no displacement. Waves of two nodes in a direction have no sign: there strain causes only its
 * local stress, and p has no effect.
 *
 * For a free map the same sweeps run on a map padded to twice its sides or a little more. The periodic images
 * of the contact then cause errors of some thousandths of the stresses. For a map that repeats along one axis
 * the free axis is padded so. Images of lines would cause errors of some hundredths. Means along the axis
 * that repeats are therefore computed with RC_SLABS_FAR times this length, at little cost (lines.h). The
 * displacement is then 0 far from the map, and its mean is not.
 *
 * Every function may be called by ranks that share the map: maps and rows are those held here.
 */
#ifndef RC_VOLUME_H
#define RC_VOLUME_H

#include "libcontact/operator/operator.h"

enum {
    RC_SLABS_FAR = 16
};

struct rc_slabs_options {
    size_t slabs;                /* number of slabs from the surface down, at least one */
    const double *thickness;     /* m, thickness of each slab; only rc_slabs_new needs it */
    double shear, nu;            /* mu, Pa; Poisson's ratio, above -1 and at most 0.5  */
    struct rc_boundary boundary; /* the map is padded along its free axes              */
    bool whole;                  /* all six stresses; otherwise deviators, without szz */
    bool slices;                 /* rc_slabs_slice will be called                      */
    /* The nodes of a slab lie 2^level nodes of the map apart, at most this part of its depth. 0: all slabs
     * have the nodes of the map, and so have those for slices and maps that repeat along one axis. */
    double coarser;
    enum rc_precision precision;  /* precision of the computation; rows and maps are double */
    size_t threads;               /* 0: all                                             */
    const struct rc_ranks *ranks; /* ranks that share the map; NULL: none               */
};

/* Strain, read by several threads, once per row: all rows of a component before those of the next. It is not
 * read again on the way down. */
struct rc_slab_strain {
    /* Whether each slab has strain; NULL: all have. Slabs without strain are not read and cost only the
     * passing waves. */
    const bool *strained;
    /* Writes row j of component c of a slab, nx numbers (nx >> rc_slabs_level: the nodes of the slab), or
     * returns false if all are 0. c is never RC_SZZ,
     * which is -exx - eyy. Shears are those of the tensor, half the engineering shears. */
    bool (*row)(void *ctx, size_t slab, enum rc_component c, size_t j, double *row);
    void *ctx;
};

/* Stress, passed by several threads, once per row: all rows of a slab before those of the next, from the
 * surface down. */
struct rc_slab_stress {
    const bool *wanted; /* for each slab; NULL: all. Other slabs cost only the passing waves */
    /* Row j of a slab: s[c] has nx numbers for each component, and may be overwritten; s[RC_SZZ] is NULL for
     * deviators. */
    void (*row)(void *ctx, size_t slab, size_t j, double *const s[RC_COMPONENTS]);
    void *ctx;
};

/* The stress of a slice, passed by several threads: row j of each of `components` (bits), all rows of one
 * before those of the next. */
struct rc_slice_stress {
    unsigned components;
    void (*row)(void *ctx, enum rc_component c, size_t j, const double *row);
    void *ctx;
};

/* Numbers of transforms of maps, to waves and back. */
struct rc_slabs_counts {
    size_t forward, back;
};

struct rc_slabs;

/* Chooses and allocates. NULL for an invalid number, or when memory is short. */
struct rc_slabs *rc_slabs_new(const struct rc_shape *shape, const struct rc_slabs_options *options,
                              struct rc_err *err);
void rc_slabs_free(struct rc_slabs *slabs); /* NULL is allowed */
/* The slab has the nodes (2^level i, 2^level j) of the map. */
size_t rc_slabs_level(const struct rc_slabs *slabs, size_t slab);
/* Turns numbers at the nodes of a slab, row after row, into numbers at the nx ny nodes of the map, by
 * the waves of its level. */
void rc_slabs_refine(struct rc_slabs *slabs, size_t slab, double *map);
/* The number of slabs, each counted as the part of the nodes of the map that it has. */
double rc_slabs_by_nodes(const struct rc_shape *shape, const struct rc_slabs_options *options);
RC_OWNER(rc_slabs)

/* u = S' e, m; its mean is 0 unless exactly one axis repeats. u may be NULL. */
void rc_slabs_up(struct rc_slabs *slabs, const struct rc_slab_strain *strain, double *u);
/* S p - G e with the strain of the last rc_slabs_up. The call consumes this strain: e is then 0 until the
 * next rc_slabs_up. p, Pa, may be NULL: no pressure. */
void rc_slabs_down(struct rc_slabs *slabs, const double *p, const struct rc_slab_stress *stress);

/* Instead of rc_slabs_down: keeps the last strain for any number of slices. */
void rc_slabs_through(struct rc_slabs *slabs);
/* - G e at a depth >= 0 (m); costs only the transforms of the components. An interface between slabs belongs
 * to the lower slab; the bottom of the last slab belongs to the body below, which has no strain. */
void rc_slabs_slice(struct rc_slabs *slabs, double depth, const struct rc_slice_stress *stress);

const struct rc_slabs_counts *rc_slabs_counted(const struct rc_slabs *slabs);
/* Bytes of the longer profiles, in single precision, if exactly one axis repeats; else 0. */
size_t rc_slabs_line_bytes(const struct rc_shape *shape, struct rc_boundary boundary, size_t slabs);

#endif
