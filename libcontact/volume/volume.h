/*
 * What strain that does not go away does to a half-space, and what a pressure does inside it: a
 * stack of slabs under a periodic map. Internal: never installed.
 *
 * With e an eigenstrain (plastic strain, say: a deviator), uniform over the thickness of a slab at
 * each node, p a pressure on the surface, and stresses averaged over the thickness of a slab,
 *
 *     u_r = S' e              displacement of the surface that e makes, into the body, m
 *     sigma = S p - G e       stress, tension positive, Pa
 *
 * of a linear half-space with shear modulus mu and Poisson's ratio nu. S' is the transpose of S:
 * for a p without a mean the sum of p u_r over the nodes is that of e : S p times h over the
 * voxels. G is symmetric in the same sums, and on deviators 0 <= G + S K_cc^-1 S' <= 2 mu,
 * whichever nodes c are in contact.
 *
 * A sheet of strain sends three waves of each wave vector down and three up, which decay with
 * depth (nuclei of strain: Mindlin and Cheng, J. Appl. Phys. 21, 1950, 926; their waves: Frerot et
 * al., Comput. Methods Appl. Mech. Engrg. 351, 2019, 951); slabs are integrals of sheets. So one
 * sweep up collects what reaches the surface, the surface reflects it and adds its own pressure,
 * and one sweep down makes the stresses: sweep_body.h has the formulae.
 *
 *     rc_slabs_up(v, &strain, u_r);           needs e, gives u_r
 *     ...                                     the caller finds p, from u_r
 *     rc_slabs_down(v, p, &stress);           needs p, gives sigma slab by slab
 *
 * Mean: the waves of wave number 0 know no depth. A mean pressure makes szz = -p and, as in
 * rc_stress, sxx = syy = -(1 + 2 nu) p/2; on a profile -p in the direction of the profile and
 * -2 nu p in the other. The mean of e makes the stress of a slab held in its plane, and no
 * displacement. Waves of two nodes in a direction have no sign: strain has its local stress there
 * and acts on nothing else, and p does nothing.
 *
 * Where the map is not to repeat, the same sweeps on a map padded to twice its sides, or a little more, err by
 * some thousandths of the stresses in a contact: its images are that far away.
 *
 * Every function may be called by ranks that share the map: maps and rows are those held here.
 */
#ifndef RC_VOLUME_H
#define RC_VOLUME_H

#include "libcontact/operator/operator.h"

struct rc_slabs_options {
    size_t slabs;                 /* from the surface down, at least one                    */
    const double *thickness;      /* m, of each; needed by rc_slabs_new alone               */
    double shear, nu;             /* mu, Pa; Poisson's ratio, above -1 and at most 0.5      */
    bool padded;                  /* the map does not repeat                                */
    bool whole;                   /* all six stresses; otherwise deviators, without szz     */
    bool slices;                  /* rc_slabs_slice will be asked                           */
    enum rc_precision precision;  /* inside: rows and maps are double on both sides         */
    size_t threads;               /* 0: all                                                 */
    const struct rc_ranks *ranks; /* that share the map; NULL: none                         */
};

/* Strain, asked for by several threads at once, each row once: all rows of a component before those
 * of the next. It is not asked for again on the way down. */
struct rc_slab_strain {
    /* Of each slab: whether there is any; NULL: in all. Others are not asked for, and cost nothing
     * but the waves that pass. */
    const bool *strained;
    /* Writes row j of component c of a slab, nx numbers; or returns false where all are 0. c is
     * never RC_SZZ, which is -exx - eyy. Shears are those of the tensor, half the engineer's. */
    bool (*row)(void *ctx, size_t slab, enum rc_component c, size_t j, double *row);
    void *ctx;
};

/* Stress, handed out by several threads at once, each row once: all rows of a slab before those of
 * the next, from the surface down. */
struct rc_slab_stress {
    const bool *wanted; /* of each slab; NULL: all. Others cost nothing but the waves that pass */
    /* Row j of a slab: s[c] has nx numbers for each component, and may be overwritten; s[RC_SZZ] is
     * NULL where deviators were asked for. */
    void (*row)(void *ctx, size_t slab, size_t j, double *const s[RC_COMPONENTS]);
    void *ctx;
};

/* The stress of a slice, handed out by several threads at once: row j of each of `components` (bits), all
 * rows of one before those of the next. */
struct rc_slice_stress {
    unsigned components;
    void (*row)(void *ctx, enum rc_component c, size_t j, const double *row);
    void *ctx;
};

/* Transforms of maps, to waves and from them. */
struct rc_slabs_counts {
    size_t forward, back;
};

struct rc_slabs;

/* All choosing and allocating. NULL for a number that makes no sense, or when memory is short. */
struct rc_slabs *rc_slabs_new(const struct rc_shape *shape, const struct rc_slabs_options *options,
                              struct rc_err *err);
void rc_slabs_free(struct rc_slabs *slabs); /* NULL is allowed */
/* Bytes that it takes, on the rank that takes most. */
size_t rc_slabs_memory(const struct rc_shape *shape, const struct rc_slabs_options *options);

/* u = S' e, m; its mean is 0. u may be NULL. */
void rc_slabs_up(struct rc_slabs *slabs, const struct rc_slab_strain *strain, double *u);
/* S p - G e with the strain of the last rc_slabs_up, which is used up thereby: without another one
 * e is 0. p, Pa, may be NULL: none. */
void rc_slabs_down(struct rc_slabs *slabs, const double *p, const struct rc_slab_stress *stress);

/* Instead of rc_slabs_down: the last strain is kept for slices, as many as are asked for. */
void rc_slabs_through(struct rc_slabs *slabs);
/* - G e at a depth >= 0 (m), at no transforms but those of the components. A face between slabs belongs to
 * the one below it, that of the last to what is below all and has no strain. */
void rc_slabs_slice(struct rc_slabs *slabs, double depth, const struct rc_slice_stress *stress);

const struct rc_slabs_counts *rc_slabs_counted(const struct rc_slabs *slabs);

#endif
