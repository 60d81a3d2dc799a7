/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The response of a body to loads, for any type of body: the interface of this folder. Operators and stresses
 * use a body, or the pair of both, independently of its row of bodies.list. Internal: never installed.
 */
#ifndef RC_BODY_H
#define RC_BODY_H

#include "kernel.h"
#include "libcontact/ranks/ranks.h"

/* ---- inside a body ---- */

enum {
    RC_NORMAL, /* a unit pressure                                           */
    RC_SHEAR,  /* a unit traction along +x on the body                      */
    RC_TURNED, /* a unit traction along +y: RC_SHEAR with x and y exchanged */
    RC_LOADS,
    RC_STRESS_KERNELS = RC_LOADS * RC_COMPONENTS, /* load * RC_COMPONENTS + component */
    RC_WAVE_NUMBERS = 10                          /* largest count of numbers per wave */
};
extern const unsigned rc_stress_parity[RC_STRESS_KERNELS];
/* True if a kernel belongs to the traction along +y. rc_stress_unturned returns the equal kernel of the
 * traction along +x with x and y exchanged, or the kernel itself. */
static inline bool
rc_stress_turned(int kernel)
{
    return kernel >= (int)RC_TURNED * (int)RC_COMPONENTS;
}
int rc_stress_unturned(int kernel);
/* The components with x and y exchanged. */
extern const enum rc_component rc_stress_exchanged[RC_COMPONENTS];

struct rc_cell {
    double dx, dy; /* m */
};

/* Waves at a depth: their directions qx/q and qy/q, wave numbers q, rad/m, and the numbers that describe
 * each. Only the first may have q = 0. */
struct rc_waves {
    size_t n;
    const double *x, *y, *q, *numbers;
};
/* Directions and wave numbers of the waves (qx[k], qy[k]); of q = 0 the direction is 0, 0. */
void rc_wave_directions(size_t n, const double *qx, const double *qy, double *x, double *y,
                        double *q);

/* A depth of a body. Each type stores its own data after this struct. */
struct rc_inside {
    const struct rc_inside_type *type;
    double depth; /* m */
};
struct rc_solid;

/* How a body type computes stresses. Symbols and means are requested for the first two loads only:
 * rc_inside_symbol turns them for the third. */
struct rc_inside_type {
    bool shares; /* szz of the shear is sxz of the pressure                                */
    /* waves much shorter than the depth do not reach it, so a coarser grid is enough */
    bool coarsens;
    /* How many numbers describe a wave at a depth, with or without the shear. */
    size_t (*numbers)(bool shear);
    /* NULL when memory is short or the body is rigid there. */
    struct rc_inside *(*new)(const struct rc_solid *solid, double depth, bool shear,
                             struct rc_boundary boundary, struct rc_err *err);
    void (*free)(struct rc_inside *inside);
    /* The numbers of n waves of wave numbers q > 0, rad/m. */
    void (*waves)(const struct rc_inside *inside, size_t n, const double *q, double *numbers);
    /* The transform of a kernel at each wave, over (-i)^(number of odd directions); at q = 0 its
     * value does not matter. */
    void (*symbol)(const struct rc_inside *inside, int kernel, const struct rc_waves *waves,
                   double *out);
    /* Its mean on the periodic map, the same at any depth. */
    double (*mean)(const struct rc_inside *inside, int kernel, const struct rc_shape *shape);
    /* `coefficients` writes the stresses at (x[i], y[i]), i < n, to out[kernel][i], for every kernel whose
     * bit is set. The unit load is on the cell about the origin. `line` writes the same at (i step, y), and
     * is faster where step is dx. Free boundary. */
    void (*coefficients)(const struct rc_inside *inside, const struct rc_cell *cell,
                         unsigned kernels, size_t n, const double *x, const double *y,
                         double *const out[RC_STRESS_KERNELS]);
    void (*line)(const struct rc_inside *inside, const struct rc_cell *cell, unsigned kernels,
                 double step, size_t n, double y, double *const out[RC_STRESS_KERNELS]);
};
static inline void
rc_inside_free(struct rc_inside *inside) /* NULL is allowed */
{
    if (inside != NULL)
        inside->type->free(inside);
}
/* The symbol, with the mean where q = 0. */
void rc_inside_symbol(const struct rc_inside *inside, int kernel, const struct rc_waves *waves,
                      const struct rc_shape *shape, double *out);
/* rc_stress_kernel: the kernel of a load and component, or the equal kernel that replaces it.
 * rc_stress_distinct: the kernels (bits) needed for these components (bits) under these loads (bits). */
int rc_stress_kernel(const struct rc_inside_type *type, int load, int component);
unsigned rc_stress_distinct(const struct rc_inside_type *type, unsigned components, unsigned loads);

/* One kernel at one depth, for the engines. `field` outlives every plan that uses the kernel. */
struct rc_stress_field {
    const struct rc_inside *inside;
    int kernel;
};
struct rc_kernel rc_stress_field_kernel(const struct rc_stress_field *field);

/* ---- a prepared body ---- */

/* The requested results: displacement of the surface, or stresses inside. */
enum rc_use {
    RC_SURFACE,
    RC_INSIDE
};

/* A prepared body. Each type stores its own data after this struct. */
struct rc_solid {
    const struct rc_body_type *type;
};

/* A row of bodies.list. Displacements are those of this body on a rigid one: of a half-space whose composite
 * modulus E*(q) depends on the wave. A pressure wave of wave number q displaces the surface by 2/(E* q) times
 * its amplitude. */
struct rc_body_type {
    const char *name, *summary;
    /* Whether a body without a type name is of this type. */
    bool (*takes)(const struct rc_body *body);
    /* RC_FAIL, and *err says which, when a number is invalid for this use. */
    enum rc_status (*check)(const struct rc_body *body, enum rc_use use, struct rc_err *err);
    /* NULL when memory is short. Layers are copied. */
    struct rc_solid *(*new)(const struct rc_body *body, struct rc_err *err);
    void (*free)(struct rc_solid *solid);

    /* ---- its surface ---- */

    /* (1 - nu^2)/E, 1/Pa, if E* is the same for all waves: two such bodies can be combined. NULL: E*
     * varies. */
    double (*compliance)(const struct rc_body *body);
    /* The spectrum of its padded kernel is positive on any map; if not, the inverse is kept within bounds of
     * that of a uniform body. */
    bool positive;
    /* E*(q), Pa, q in rad/m; may come from a table in the square of q, accurate to 1e-12. */
    double (*modulus)(const struct rc_solid *solid, double q);
    double (*modulus_of)(const struct rc_solid *solid, double q2);
    /* The least E*(q) of all waves, approximately. */
    double (*softest)(const struct rc_solid *solid);
    /* The length (m) over which layers that are thin compared with `side` bend; 0: not more than their
     * thickness. NULL: no layers. */
    double (*bends)(const struct rc_body *body, double side);
    /* Adds the displacement under a cell, as rc_kernel's rows, in units of 1/modulus (Pa) and of `length`
     * (m); the lattice is in the same length. */
    void (*add_rows)(const struct rc_solid *solid, double length, double modulus,
                     const struct rc_lattice *at, size_t n, size_t first, size_t last, double *out);

    /* ---- its inside; NULL: stresses not implemented ---- */

    const struct rc_inside_type *inside;
};

/* Another list may include this one and add bodies. */
#ifndef RC_BODIES_LIST
#define RC_BODIES_LIST "libcontact/body/bodies.list"
#endif
#define RC_BODY(name) extern const struct rc_body_type rc_body_##name;
#include RC_BODIES_LIST
#undef RC_BODY

/* True if a depth is above or at an interface. Sums of thicknesses have rounding errors, and a depth meant to
 * be at the interface must not be below it. */
static inline bool
rc_within(double depth, double bottom)
{
    return depth <= bottom * (1 + 1e-13);
}

/* The type of a body. */
const struct rc_body_type *rc_body_type(const struct rc_body *body);

static inline void
rc_solid_free(struct rc_solid *solid) /* NULL is allowed */
{
    if (solid != NULL)
        solid->type->free(solid);
}

/* ---- both bodies ---- */

/* RC_FAIL, and *err says which, when a number of the bodies is invalid. */
enum rc_status rc_pair_check(const struct rc_pair *pair, struct rc_err *err);
/* True if the spectrum of their padded kernel is positive on any map. */
bool rc_pair_positive(const struct rc_pair *pair);
/* E* of both, Pa, if it is the same for all waves; NAN: it varies. The pair must be checked before. */
double rc_pair_modulus(const struct rc_pair *pair);
/* The larger of the lengths (m) over which layers of either body bend that are thin compared with `side`; 0:
 * none. */
double rc_pair_bends(const struct rc_pair *pair, double side);

/* A factor that makes the compliance of both bodies differ along x, and its largest value. */
struct rc_along {
    /* periodic maps: of waves of qx (rad/m), even in qx */
    double (*factor)(const void *of, double qx);
    /* free maps: of the displacement at x, y >= 0 (m) from a square cell of the side dx (m) */
    double (*at)(const void *of, double dx, double x, double y);
    const void *of; /* first argument of the functions */
    double most;
};

/* Both bodies with precomputed coefficients: a single solid if both are uniform, otherwise one for each body
 * that is not rigid. */
struct rc_solids {
    size_t n;
    struct rc_solid *solid[2];
    const struct rc_along *along; /* the caller's; NULL: the factor is 1 */
};
/* Prepares the bodies of a checked pair; RC_FAIL on all ranks when memory is short on one. Free them in
 * either case. */
enum rc_status rc_solids_new(struct rc_solids *solids, const struct rc_pair *pair,
                             const struct rc_along *along, const struct rc_ranks *ranks,
                             struct rc_err *err);
void rc_solids_free(struct rc_solids *solids);

/* E*(q) of both bodies, Pa, possibly from tables in the square of q, accurate to 1e-12. The last function
 * returns the smallest value. */
double rc_solids_modulus(const struct rc_solids *solids, double q);
double rc_solids_modulus_of(const struct rc_solids *solids, double q2);
double rc_solids_softest(const struct rc_solids *solids);

/* The sum of the displacements of both surfaces under unit pressure on a cell. Its unit is `length` (m) over
 * `modulus` (Pa): with 1 and 1 it is in m/Pa. */
struct rc_surface {
    const struct rc_solids *solids;
    double length, modulus;
};
/* `surface` outlives everything made of the kernel. */
struct rc_kernel rc_surface_kernel(const struct rc_surface *surface);
/* The same for a uniform half-space of E* = 1, for its spectrum. */
extern const struct rc_kernel rc_kernel_of_one;
/* pi times this at any point near a cell with the half sides a and b. */
double rc_love(double x, double y, double a, double b);

/* ---- tractions along the surfaces of two uniform bodies: shear.c ---- */

struct rc_shear {
    double estar, kap, beta; /* Pa; kap and Dundurs' constant beta of body 1, defined in shear.c */
};
/* nu: of both bodies, used only where just E* of the pair is known. RC_FAIL when a number is invalid, or
 * there are layers. */
enum rc_status rc_pair_shear(const struct rc_pair *pair, double nu, struct rc_shear *shear,
                             struct rc_err *err);

/* Displacement along x and y under a unit traction on a cell, m/Pa. XY serves both orders. XZ and YZ are the
 * displacement along z under a traction along x and y, which is minus that along x and y under a pressure. */
enum rc_shear_which {
    RC_SHEAR_XX,
    RC_SHEAR_YY,
    RC_SHEAR_XY,
    RC_SHEAR_XZ,
    RC_SHEAR_YZ,
    RC_SHEAR_KERNELS
};
extern const unsigned rc_shear_parity[RC_SHEAR_KERNELS];
struct rc_shear_field {
    const struct rc_shear *shear;
    enum rc_shear_which kernel;
};
/* `field` outlives every plan that uses the kernel. */
struct rc_kernel rc_shear_kernel(const struct rc_shear_field *field);

#endif
