/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The arithmetic of the sweeps, column by column of the waves: between volume.c and sweep_body.h,
 * which is compiled once for each precision. Internal: never installed.
 */
#ifndef RC_SWEEP_H
#define RC_SWEEP_H

#include <stdbool.h>
#include <stddef.h>

enum {
    RC_SWEEP_SLABS = 4,  /* slabs between two depths at which waves are stored */
    RC_SWEEP_WAVES = 3,  /* upward or downward waves                           */
    RC_SWEEP_STRAINS = 5 /* xx, yy, xy, xz, yz                                 */
};

/* `length` waves of equal qx. Waves with alive = 0 are 0. */
struct rc_sweep_column {
    size_t length;
    double qx;
    const double *qy, *alive; /* 0 or 1; all 0 where the column is `dead` */
    bool dead;
    double nu;
};

/* One slab in this column: numbers in the order of rc_fft_forward, each array of twice `length`. */
struct rc_sweep_slab {
    double thickness;
    bool strained, wanted;
    void *strain[RC_SWEEP_STRAINS]; /* stress replaces it; read only if strained */
    void *zz;                       /* scratch for szz; NULL: only deviators */
    double szz, sxx, syy;           /* mean stresses, added to the first wave of the column */
};

/* A depth: the slab that contains it, or the number of slabs if it is below all of them. The parts of that
 * slab above it (or the distance from the last slab) and below it, m, follow. */
struct rc_sweep_place {
    size_t slab;
    double above, below;
};

/* Waves at a depth are three arrays of twice `length`, one after the other, in units of strain: q
 * times the amplitude. */
struct rc_sweep_ops {
    size_t real_size;
    /* Moves waves through n slabs: upwards from below, or downwards from above if `down`. `from` NULL: no
     * waves enter. */
    void (*through)(const struct rc_sweep_column *column, size_t n,
                    const struct rc_sweep_slab *slab, bool down, const void *from, void *to);
    /* Turns upward waves at the surface into downward waves, and adds the contribution of p over 2 mu (NULL:
     * none). `any`: whether there are upward waves; otherwise they are 0. */
    void (*reflect)(const struct rc_sweep_column *column, bool any, const void *p, double over_2mu,
                    void *waves);
    /* Displacement of the surface due to upward waves, in units of a length: m. */
    void (*surface)(const struct rc_sweep_column *column, const void *waves, void *u);
    /* Stresses over `modulus` = 2 mu of n slabs, which replace their strains. `above`: downward waves at
     * their top. `below`: upward waves at their bottom (if `any`), replaced by the downward waves there;
     * NULL: there are none, and none are needed. */
    void (*down)(const struct rc_sweep_column *column, size_t n, const struct rc_sweep_slab *slab,
                 double modulus, const void *above, bool any, void *below);
    /* Computes all six stresses at a depth within n slabs, the five and szz, to `to`. Strains and waves are
     * kept: `above` downward at the top of the slabs, `below` upward at their bottom (NULL: none). */
    void (*slice)(const struct rc_sweep_column *column, size_t n, const struct rc_sweep_slab *slab,
                  double modulus, const struct rc_sweep_place *place, const void *above,
                  const void *below, void *const to[RC_SWEEP_STRAINS + 1]);
};
extern const struct rc_sweep_ops rc_sweep_double, rc_sweep_single;

#endif
