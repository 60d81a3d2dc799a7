/*
 * The arithmetic of the sweeps, column by column of the waves: between volume.c and sweep_body.h,
 * which is compiled once for each precision. Internal: never installed.
 */
#ifndef RC_SWEEP_H
#define RC_SWEEP_H

#include <stdbool.h>
#include <stddef.h>

enum {
    RC_SWEEP_SLABS = 4,  /* slabs between two depths whose waves are kept   */
    RC_SWEEP_WAVES = 3,  /* that go up, or down                             */
    RC_SWEEP_STRAINS = 5 /* xx, yy, xy, xz, yz                              */
};

/* Waves of equal qx, `length` of them; where they are not alive they are taken to be 0. */
struct rc_sweep_column {
    size_t length;
    double qx;
    const double *qy, *alive; /* 0 or 1; and all are 0 where the column is `dead` */
    bool dead;
    double nu;
};

/* One slab in this column: numbers in the order of rc_fft_forward, each array of twice `length`. */
struct rc_sweep_slab {
    double thickness;
    bool strained, wanted;
    void *strain[RC_SWEEP_STRAINS]; /* stress takes its place; read only if strained */
    void *zz;                       /* room for szz; NULL: deviators are made        */
    double szz, sxx, syy;           /* added to the first wave of the column: a mean */
};

/* A depth: the slab that it lies in, or their number where it lies below all of them, and what is above it
 * (since the last slab) and below it of that slab, m. */
struct rc_sweep_place {
    size_t slab;
    double above, below;
};

/* Waves at a depth are three arrays of twice `length`, one after the other, in units of strain: q
 * times the amplitude. */
struct rc_sweep_ops {
    size_t real_size;
    /* Waves through n slabs, those that go up (from below to above them) or down, where `down`. From NULL:
     * there are none. */
    void (*through)(const struct rc_sweep_column *column, size_t n,
                    const struct rc_sweep_slab *slab, bool down, const void *from, void *to);
    /* At the surface: from waves up to waves down, and what p over 2 mu adds (NULL: nothing).
     * `any`: whether there are waves up; otherwise they count as 0. */
    void (*reflect)(const struct rc_sweep_column *column, bool any, const void *p, double over_2mu,
                    void *waves);
    /* Displacement of the surface that waves up make, in units of a length: m. */
    void (*surface)(const struct rc_sweep_column *column, const void *waves, void *u);
    /* Stresses over `modulus` = 2 mu of n slabs, in the place of their strains. `above`: waves down
     * on top of them. `below`: waves up below them (if `any`), in whose place come the waves down
     * below them; NULL: there are none, and none are asked for. */
    void (*down)(const struct rc_sweep_column *column, size_t n, const struct rc_sweep_slab *slab,
                 double modulus, const void *above, bool any, void *below);
    /* All six stresses at a depth of n slabs to `to`, the five and szz; strains stay, and so do the waves:
     * `above` down on top of the slabs, `below` up below them (NULL: none). */
    void (*slice)(const struct rc_sweep_column *column, size_t n, const struct rc_sweep_slab *slab,
                  double modulus, const struct rc_sweep_place *place, const void *above,
                  const void *below, void *const to[RC_SWEEP_STRAINS + 1]);
};
extern const struct rc_sweep_ops rc_sweep_double, rc_sweep_single;

#endif
