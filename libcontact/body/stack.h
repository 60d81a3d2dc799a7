/*
 * Bonded isotropic layers on a half-space: what a wave of pressure does to the surface, and what a load
 * about the origin does at a distance. Internal: never installed.
 */
#ifndef RC_STACK_H
#define RC_STACK_H

#include "body.h"

struct rc_material {
    double thickness; /* m; INFINITY: the substrate                                             */
    double modulus;   /* shear modulus G, Pa; INFINITY: rigid, as a substrate                    */
    double nu;
};

struct rc_stack {
    size_t layers;
    struct rc_material *material; /* layers + 1, the top first, the substrate last               */
    double top, bottom;    /* g(infinity), g(0): 1/E* of the top material, of the substrate */
    struct rc_radial *far; /* D(r), 1/(Pa m): what stands between it and the top material alone */
    struct rc_octaves *far_table, *response_table; /* D of r^2, m^2; g of q^2, 1/m^2           */
};

/* RC_FAIL, and err says which, when a number of a layered body makes no sense. */
enum rc_status rc_stack_check(const struct rc_body *body, struct rc_err *err);
/* NULL when memory is short. */
struct rc_stack *rc_stack_new(const struct rc_body *body, struct rc_err *err);
void rc_stack_free(struct rc_stack *stack); /* NULL is allowed */

/* g(q), 1/Pa: a wave of pressure of wave number q (rad/m) displaces the surface by 2 g/q of its height.
 * On a half-space g is 1/E*. */
double rc_stack_response(const struct rc_stack *stack, double q);
/* The same, and D(r), of n squares at once: from tables, to 1e-12. */
void rc_stack_responses(const struct rc_stack *stack, size_t n, const double *q2, double *g);
void rc_stack_far(const struct rc_stack *stack, size_t n, const double *r2, double *d);
/* g(q) - g(infinity). */
double rc_stack_excess(const struct rc_stack *stack, double q);

/* The medium at a depth, 0 on top: an interface belongs to the medium above it. And the depth of its
 * upper side. */
size_t rc_stack_medium(const struct rc_stack *stack, double depth);
double rc_stack_top(const struct rc_stack *stack, size_t medium);

/* Stresses that waves leave inside, each over the load at the surface. l is along the wave, which goes as
 * cos(q l) for a pressure of that form: szz = S cos, slz = T sin, sll = L cos, and across it snn = N cos.
 * Of a traction along the wave as sin(q l) the same; of one across it szn = -R, sln = V. */
enum {
    RC_P_S,
    RC_P_T,
    RC_P_L,
    RC_P_N,
    RC_UNDER_PRESSURE, /* so many of the pressure alone */
    RC_T_S = RC_UNDER_PRESSURE,
    RC_T_T,
    RC_T_L,
    RC_T_N,
    RC_T_R,
    RC_T_V,
    RC_UNDER_BOTH
};
/* The first n, RC_UNDER_PRESSURE or RC_UNDER_BOTH, at a depth (m) in a medium, to which its two sides
 * belong; it is not a rigid one. */
void rc_stack_inside(const struct rc_stack *stack, size_t medium, double depth, double q, size_t n,
                     double *out);

#endif
