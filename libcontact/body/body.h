/*
 * What a body does under load, however it is made: the face of this folder. Operators and stresses
 * ask a body, or the pair of both, and never learn which row of bodies.list answers. Internal:
 * never installed.
 */
#ifndef RC_BODY_H
#define RC_BODY_H

#include "kernel.h"
#include "libcontact/ranks/ranks.h"

/* ---- inside a body ---- */

enum {
    RC_NORMAL, /* a unit pressure                              */
    RC_SHEAR,  /* a unit traction along +x on the body         */
    RC_TURNED, /* and along +y: that with x and y exchanged    */
    RC_LOADS,
    RC_STRESS_KERNELS = RC_LOADS * RC_COMPONENTS, /* load * RC_COMPONENTS + component */
    RC_WAVE_NUMBERS = 10                          /* kept of a wave at most           */
};
extern const unsigned rc_stress_parity[RC_STRESS_KERNELS];
/* Whether a kernel is one of the traction along +y; and the one along +x that it is with x and y exchanged,
 * or itself. */
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

/* Waves at a depth: their directions qx/q and qy/q, their wave numbers q, rad/m, and what is known of each.
 * Only the first may have q = 0. */
struct rc_waves {
    size_t n;
    const double *x, *y, *q, *numbers;
};
/* Directions and wave numbers of the waves (qx[k], qy[k]); of q = 0 the direction is 0, 0. */
void rc_wave_directions(size_t n, const double *qx, const double *qy, double *x, double *y,
                        double *q);

/* A depth of a body. The row that made it keeps its own data behind this. */
struct rc_inside {
    const struct rc_inside_type *type;
    double depth; /* m */
};
struct rc_solid;

/* How a row of bodies.list finds stresses. Symbols and means are asked for of the first two loads:
 * rc_inside_symbol turns them. */
struct rc_inside_type {
    bool shares;   /* szz of the shear is sxz of the pressure                                */
    bool coarsens; /* at a depth no wave is felt that is much shorter: a coarser grid does   */
    /* How many numbers describe a wave at a depth, and the bytes of a depth; with the shear or
     * without. */
    size_t (*numbers)(bool shear);
    size_t (*memory)(bool shear, enum rc_boundary boundary);
    /* NULL when memory is short or the body is rigid there. */
    struct rc_inside *(*new)(const struct rc_solid *solid, double depth, bool shear,
                             enum rc_boundary boundary, struct rc_err *err);
    void (*free)(struct rc_inside *inside);
    /* The numbers of n waves of wave numbers q > 0, rad/m. */
    void (*waves)(const struct rc_inside *inside, size_t n, const double *q, double *numbers);
    /* The transform of a kernel at each wave, over (-i)^(number of odd directions); at q = 0 its
     * value does not matter. */
    void (*symbol)(const struct rc_inside *inside, int kernel, const struct rc_waves *waves,
                   double *out);
    /* Its mean on the periodic map, the same at any depth. */
    double (*mean)(const struct rc_inside *inside, int kernel, const struct rc_shape *shape);
    /* Stresses at (x[i], y[i]), i < n, of unit load on the cell about the origin, of every kernel
     * whose bit is set, to out[kernel][i]; and the same at (i step, y), faster where the step is
     * that from cell to cell, dx. On the free boundary. */
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
/* The kernel of a load and component, or an equal one that stands for it; and the kernels (bits)
 * that these components (bits) need, of these loads (bits). */
int rc_stress_kernel(const struct rc_inside_type *type, int load, int component);
unsigned rc_stress_distinct(const struct rc_inside_type *type, unsigned components, unsigned loads);

/* One kernel at one depth, as engines ask for it. `field` outlives every plan that uses the kernel. */
struct rc_stress_field {
    const struct rc_inside *inside;
    int kernel;
};
struct rc_kernel rc_stress_field_kernel(const struct rc_stress_field *field);

/* ---- a body that can be asked ---- */

/* What is asked of it: how its surface is displaced, or the stresses inside. */
enum rc_use {
    RC_SURFACE,
    RC_INSIDE
};

/* A body made ready. The row that made it keeps its own data behind this. */
struct rc_solid {
    const struct rc_body_type *type;
};

/* A row of bodies.list. Displacements are those of a half-space of a composite modulus E*(q) for
 * each wave, of this body on a rigid one: a pressure of wave number q displaces the surface by
 * 2/(E* q) of its height. */
struct rc_body_type {
    const char *name, *summary;
    /* Whether a body that names no type is of this one. */
    bool (*takes)(const struct rc_body *body);
    /* RC_FAIL, and *err says which, when a number makes no sense for this use. */
    enum rc_status (*check)(const struct rc_body *body, enum rc_use use, struct rc_err *err);
    /* NULL when memory is short. Layers are copied. */
    struct rc_solid *(*new)(const struct rc_body *body, struct rc_err *err);
    void (*free)(struct rc_solid *solid);

    /* ---- its surface ---- */

    /* (1 - nu^2)/E, 1/Pa, where E* is the same for all waves: two such bodies are as one. NULL: it
     * is not. */
    double (*compliance)(const struct rc_body *body);
    /* The spectrum of its padded kernel is positive, whatever the map; else it may not be, and its
     * inverse is kept within bounds of that of a uniform body. */
    bool positive;
    /* E*(q), Pa, q in rad/m; of the square of q it may come from a table, to 1e-12. */
    double (*modulus)(const struct rc_solid *solid, double q);
    double (*modulus_of)(const struct rc_solid *solid, double q2);
    /* The least E*(q) of all waves, near enough. */
    double (*softest)(const struct rc_solid *solid);
    /* The length (m) over which layers that are thin beside `side` bend; 0: over no more than they are thick.
     * NULL: there are none. */
    double (*bends)(const struct rc_body *body, double side);
    /* Adds the displacement under a cell, as rc_kernel's rows have it, in units of 1/modulus (Pa) and of
     * length (m), in which the lattice is. */
    void (*add_rows)(const struct rc_solid *solid, double length, double modulus,
                     const struct rc_lattice *at, size_t n, size_t first, size_t last, double *out);

    /* ---- its inside; NULL: stresses are not known ---- */

    const struct rc_inside_type *inside;
};

/* The list may be a longer one that includes this one: so others add bodies of their own. */
#ifndef RC_BODIES_LIST
#define RC_BODIES_LIST "libcontact/body/bodies.list"
#endif
#define RC_BODY(name) extern const struct rc_body_type rc_body_##name;
#include RC_BODIES_LIST
#undef RC_BODY

/* Whether a depth is above an interface or at it: sums of thicknesses are rounded, and a depth that
 * is meant to be one must not be below it. */
static inline bool
rc_within(double depth, double bottom)
{
    return depth <= bottom * (1 + 1e-13);
}

/* The row of a body. */
const struct rc_body_type *rc_body_type(const struct rc_body *body);

static inline void
rc_solid_free(struct rc_solid *solid) /* NULL is allowed */
{
    if (solid != NULL)
        solid->type->free(solid);
}

/* ---- both bodies ---- */

/* RC_FAIL, and *err says which, when a number of the bodies makes no sense. */
enum rc_status rc_pair_check(const struct rc_pair *pair, struct rc_err *err);
/* Whether the spectrum of their padded kernel is positive, whatever the map. */
bool rc_pair_positive(const struct rc_pair *pair);
/* E* of both, Pa, where it is the same for all waves; NAN: it is not. Of a pair that has been
 * checked. */
double rc_pair_modulus(const struct rc_pair *pair);
/* The larger of the lengths (m) over which the layers of either bend, of those that are thin beside `side`; 0:
 * none does. */
double rc_pair_bends(const struct rc_pair *pair, double side);

/* Both bodies made ready: a single solid where both are uniform, else one for each body that is not
 * rigid. */
struct rc_solids {
    size_t n;
    struct rc_solid *solid[2];
};
/* Makes those of a pair that has been checked; RC_FAIL on all ranks when memory is short on one.
 * Free them in either case. */
enum rc_status rc_solids_new(struct rc_solids *solids, const struct rc_pair *pair,
                             const struct rc_ranks *ranks, struct rc_err *err);
void rc_solids_free(struct rc_solids *solids);

/* E*(q) of both, Pa; of the square of q it may come from tables, to 1e-12; and its least. */
double rc_solids_modulus(const struct rc_solids *solids, double q);
double rc_solids_modulus_of(const struct rc_solids *solids, double q2);
double rc_solids_softest(const struct rc_solids *solids);

/* The displacement of both surfaces together under unit pressure on a cell, in units of 1/modulus
 * (Pa) and of length (m): 1 and 1 are m/Pa. */
struct rc_surface {
    const struct rc_solids *solids;
    double length, modulus;
};
/* `surface` outlives what is made of the kernel. */
struct rc_kernel rc_surface_kernel(const struct rc_surface *surface);
/* The same of a uniform half-space of E* = 1, for its spectrum. */
extern const struct rc_kernel rc_kernel_of_one;

/* ---- tractions along the surfaces of two bare bodies: shear.c ---- */

struct rc_shear {
    double estar, kap, beta; /* Pa; what shear feels beside it; Dundurs' constant, of body 1 */
};
/* nu: of both bodies, where only E* of the pair is known; else of no use. RC_FAIL when a number makes
 * no sense, or there are layers. */
enum rc_status rc_pair_shear(const struct rc_pair *pair, double nu, struct rc_shear *shear,
                             struct rc_err *err);

/* Displacement along x and y under a unit traction on a cell, m/Pa; XY of both; XZ and YZ that along z
 * under a traction along x and y, which is minus that along x and y under a pressure. */
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
