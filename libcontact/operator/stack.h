/*
 * Bonded isotropic layers on a half-space: what a wave of pressure does to the surface, and what a load
 * about the origin does at a distance. Internal: never installed.
 */
#ifndef RC_STACK_H
#define RC_STACK_H

#include "libcontact/common.h"

struct rc_material {
    double thickness; /* m; INFINITY: the substrate                                             */
    double modulus;   /* shear modulus G, Pa; INFINITY: rigid, as a substrate                    */
    double nu;
};

struct rc_stack {
    size_t layers;
    struct rc_material *material; /* layers + 1, the top first, the substrate last               */
    double compliance;            /* of the other body, (1 - nu2^2)/E2, 1/Pa; 0: rigid           */
    double top, bottom;    /* g(infinity), g(0): 1/E* of the top material, of the substrate */
    struct rc_radial *far; /* D(r), 1/(Pa m): what stands between it and the top material alone */
};

/* NULL when a number makes no sense or memory is short; err says why. */
struct rc_stack *rc_stack_new(const struct rc_coating *coating, struct rc_err *err);
void rc_stack_free(struct rc_stack *stack); /* NULL is allowed */

/* g(q), 1/Pa: a wave of pressure of wave number q (rad/m) displaces the surface by 2 g/q of its height.
 * On a half-space g is 1/E*. */
double rc_stack_response(const struct rc_stack *stack, double q);
/* g(q) - g(infinity). */
double rc_stack_excess(const struct rc_stack *stack, double q);

#endif
