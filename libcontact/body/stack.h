/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Bonded isotropic layers on a half-space: displacement of the surface under a pressure wave, and under a
 * load about the origin at a distance. Internal: never installed.
 */
#ifndef RC_STACK_H
#define RC_STACK_H

#include "body.h"

struct rc_material {
    double thickness; /* m; INFINITY: the substrate                            */
    double modulus;   /* shear modulus G, Pa; INFINITY: rigid, for a substrate */
    double nu;
};

struct rc_stack {
    size_t layers;
    struct rc_material *material; /* layers + 1, the top first, the substrate last               */
    double top, bottom; /* g(infinity), g(0): 1/E* of the top material, of the substrate */
    /* D(r), 1/(Pa m): the difference between the stack and the top material alone */
    struct rc_radial *far;
    struct rc_octaves *far_table, *response_table; /* D of r^2, m^2; g of q^2, 1/m^2           */
};

/* RC_FAIL, and err says which, when a number of a layered body is invalid. */
enum rc_status rc_stack_check(const struct rc_body *body, struct rc_err *err);
/* NULL when memory is short. */
struct rc_stack *rc_stack_new(const struct rc_body *body, struct rc_err *err);
void rc_stack_free(struct rc_stack *stack); /* NULL is allowed */
RC_OWNER(rc_stack)

/* g(q), 1/Pa: a pressure wave of wave number q (rad/m) displaces the surface by 2 g/q times its amplitude. On
 * a half-space g is 1/E*. */
double rc_stack_response(const struct rc_stack *stack, double q);
/* The same, and D(r), for n squares of q or r. The values come from tables and are accurate to 1e-12. */
void rc_stack_responses(const struct rc_stack *stack, size_t n, const double *q2, double *g);
void rc_stack_far(const struct rc_stack *stack, size_t n, const double *r2, double *d);
/* g(q) - g(infinity). */
double rc_stack_excess(const struct rc_stack *stack, double q);

/* The medium at a depth, 0 on top: an interface belongs to the medium above it. Also returns the depth of a
 * medium's upper side. */
size_t rc_stack_medium(const struct rc_stack *stack, double depth);
double rc_stack_top(const struct rc_stack *stack, size_t medium);

/* Stresses inside under waves, over the amplitude of the load at the surface, with l along the wave. Under a
 * pressure cos(q l) the stresses are szz = S cos, slz = T sin, sll = L cos, and across it snn = N cos. Under
 * a traction sin(q l) along the wave the same letters hold. Under a traction across it szn = -R, sln = V. */
enum {
    RC_P_S,
    RC_P_T,
    RC_P_L,
    RC_P_N,
    RC_UNDER_PRESSURE, /* number of those under pressure */
    RC_T_S = RC_UNDER_PRESSURE,
    RC_T_T,
    RC_T_L,
    RC_T_N,
    RC_T_R,
    RC_T_V,
    RC_UNDER_BOTH
};
/* The first n, RC_UNDER_PRESSURE or RC_UNDER_BOTH, at a depth (m) in a medium; both of its sides belong to
 * it. The medium must not be rigid. */
void rc_stack_inside(const struct rc_stack *stack, size_t medium, double depth, double q, size_t n,
                     double *out);

#endif
