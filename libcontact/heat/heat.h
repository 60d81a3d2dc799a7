/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Conduction of heat from a contact into a body whose material moves past it. Internal: never installed.
 *
 * The heat flux q(x, y) stands still, and the body moves with the velocity V = 2 kap P. With the
 * conductivity k and the diffusivity kap, its temperature T = C q obeys
 *
 *     dT/dt + V . grad T = kap lap T,   -k dT/dz = q at z = 0.
 *
 * At P = 0 the steady C is the operator of an elastic half-space with E* = 2 k.
 */
#ifndef RC_HEAT_H
#define RC_HEAT_H

#include <complex.h>

#include "libcontact/operator/operator.h"

enum {
    RC_HEAT_PARTS = 4 /* even and odd in x, and in y: the index is the parity */
};
/* A body, and where its temperature is wanted. */
struct rc_heated {
    double k;         /* W/(m K)                                                     */
    double px, py;    /* 1/m: P along x and y                                        */
    double diffusion; /* m: 2 sqrt(kap t), t since heating began; INFINITY: steady   */
    double ended;     /* m: the same for the time since heating ended; 0: it goes on */
    double depth;     /* m                                                           */
    /* m2, 1/m2: where slope is above 0, the flux tau ago, as a diffusion, is slope (top - tau^2) */
    double top, slope;
};

/* ---- coefficients.c: temperatures of cells ---- */

struct rc_heat_cells;
/* Coefficients of cells of this shape, for offsets up to nx - 1 and ny - 1 nodes along axes that are free.
 * Along an axis that repeats they are those of the waves of a map with nx or ny nodes. At least one axis is
 * free. NULL when memory is short. */
struct rc_heat_cells *rc_heat_cells_new(const struct rc_shape *offsets, struct rc_boundary boundary,
                                        const struct rc_heated *body, struct rc_err *err);
void rc_heat_cells_free(struct rc_heat_cells *cells); /* NULL is allowed */
RC_OWNER(rc_heat_cells)
/* The part of this parity; the sum of the four parts is the coefficient. */
struct rc_heat_part {
    const struct rc_heat_cells *cells;
    unsigned parity;
};
struct rc_kernel rc_heat_kernel(const struct rc_heat_part *part);

/* ---- symbol.c: temperatures of waves ---- */

enum {
    RC_ERFC_TERMS = 40
};
struct rc_heat_waves {
    struct rc_heated body;
    double length, series[RC_ERFC_TERMS]; /* of erfc */
};
struct rc_heat_waves rc_heat_waves_of(const struct rc_heated *body);
/* The transform of C at a wave number, rad/m. */
double complex rc_heat_symbol(const struct rc_heat_waves *waves, double qx, double qy);
/* The transforms of its parts, over (-i)^(number of odd directions). */
void rc_heat_symbol_parts(const struct rc_heat_waves *waves, double qx, double qy,
                          double part[RC_HEAT_PARTS]);
/* exp(z^2) erfc(z), Re z >= 0 */
double complex rc_scaled_erfc(const struct rc_heat_waves *waves, double complex z);

/* ---- conduction.c: convolutions ---- */

/* The spectrum of C: its parts over (-i)^(number of odd directions); NULL: 0. */
struct rc_warming {
    double *part[RC_HEAT_PARTS];
};

struct rc_conduction {
    struct rc_shape shape; /* of the whole map */
    struct rc_rows rows;   /* held here        */
    struct rc_boundary boundary;
    int threads;
    struct rc_frame frame;       /* of padding along the free axes */
    size_t above, below;         /* rows of the frame that are held here */
    struct rc_fft *fft, *framed; /* framed: of the map with its frame; the same if both repeat */
    size_t first, columns;       /* columns of waves that are held here */
    size_t length, cy;           /* numbers in a column; rows of a quarter of it */
    double *waves;               /* transform of the loaded map                  */
    size_t *wave;        /* for place t of a column: its row in the quarter                */
    signed char *mirror; /* -1 where this row is the mirror image, else 1                  */
    struct rc_store own;
    double count; /* of convolutions */
};
/* `ranks` share the map of this shape (NULL: none). Maps are then the rows held here, transforms and spectra
 * the columns held here, and all ranks make every call of this file but rc_warming_add and
 * rc_conduction_keep. */
struct rc_conduction *rc_conduction_new(const struct rc_shape *shape, struct rc_boundary boundary,
                                        const struct rc_ranks *ranks, size_t threads,
                                        struct rc_err *err);
void rc_conduction_free(struct rc_conduction *c); /* NULL is allowed */
RC_OWNER(rc_conduction)
/* A spectrum of 0 of a body, in memory of `own`. */
enum rc_status rc_warming_new(struct rc_warming *w, struct rc_store *own,
                              const struct rc_conduction *c, const struct rc_heated *body,
                              struct rc_err *err);
/* Sets the spectrum of a body, in memory of `own`. RC_FAIL when that is short on any rank. */
enum rc_status rc_warming_set(struct rc_warming *w, struct rc_store *own, struct rc_conduction *c,
                              const struct rc_heated *body, struct rc_err *err);
/* Keeps the transform of a map of nx ny values. */
void rc_conduction_load(struct rc_conduction *c, const double *q);
/* The sum of the fields of the loaded map. */
void rc_conduction_field(struct rc_conduction *c, size_t n, const struct rc_warming *const *w,
                         double *out);
/* A map, by its transform, as heat of a body. */
struct rc_heating {
    const struct rc_warming *body;
    const double *waves; /* of rc_conduction_keep */
    double times;
};
/* Numbers in the transform of a map, and a copy of that of the loaded one. */
size_t rc_conduction_size(const struct rc_conduction *c);
void rc_conduction_keep(const struct rc_conduction *c, double *waves);
/* The sum of the fields of n maps. */
void rc_conduction_sum(struct rc_conduction *c, size_t n, const struct rc_heating *heating,
                       double *out);
/* to = to + times w */
void rc_warming_add(const struct rc_conduction *c, struct rc_warming *to, double times,
                    const struct rc_warming *w);
/* v = (C1 + C2)^-1 v on the map with its frame. */
void rc_conduction_inverse(struct rc_conduction *c, const struct rc_warming *const w[2], float *v);

/* ---- inverse.c: the preconditioner ---- */

struct rc_heat_inverse;
/* For n nodes in contact, of those held here; c outlives it. NULL when memory is short on any rank. */
struct rc_heat_inverse *rc_heat_inverse_new(struct rc_conduction *c,
                                            const struct rc_heated bodies[2], size_t n,
                                            const size_t *node, struct rc_err *err);
void rc_heat_inverse_free(struct rc_heat_inverse *inverse); /* NULL is allowed */
RC_OWNER(rc_heat_inverse)
/* z = E' A E r: a number for each node in contact. */
void rc_heat_inverse_apply(struct rc_heat_inverse *inverse,
                           const struct rc_warming *const bodies[2], const double *r, double *z);

#endif
