/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * An approximate inverse of T + D on the free directions of the nodes that carry friction. Internal: never
 * installed.
 *
 * A sticking node has two free directions, a slipping node one, its tangent t. P_i is the projection on the
 * free directions of node i, 0 for a node without load. With A = T^-1 on the whole map the exact inverse is,
 * as a quadratic form,
 *
 *     r'(T + D)^-1 r is the least value of v'Av + sum over slipping nodes of (t'(r - v))^2/D. v is any field
 *     with v = r where nodes stick:
 *
 * The displacement v is unknown outside the contact and along the normals of the circles. Along the tangents,
 * the larger D is, the less v is known. Here v = E r is an explicit approximation,
 *
 *     v = e + c P (r - e),   e from the pyramid of pairs with W_0 = c P,   c = T0/(T0 + D):
 *
 * c is the known part of v at a node, T0 the factor of T for a wave of about 4 nodes. Then
 *
 *     z = E' A E r + (1 - c)^2/D P (r - e) and its transpose:
 *
 * this is symmetric, and r'z >= r'(T + D)^-1 r for any approximation: z bounds the error in the energy norm
 * from above.
 *
 * A periodic T has no mean, T(0) = 0, and its inverse allows none: the fields v have no mean. If a force is
 * given, the residual has none either. If a displacement is given, a change of rank 2 moves the mean of v to
 * nodes where v is unknown:
 *
 *     e -> e - Phi m,   m = B^-1 mean(e + c P (r - e)),   B = mean((1 - c P) Phi),
 *
 * Phi m is the result of the pyramid for m beyond its coarsest level.
 */
#ifndef RC_EXTENSION_H
#define RC_EXTENSION_H

#include "libcontact/memory.h"
#include "libcontact/pyramid/pyramid.h"
#include "tangential.h"

enum rc_face {
    RC_FACE_OFF, /* without load */
    RC_FACE_STICK,
    RC_FACE_SLIP
};

struct rc_extension {
    struct rc_tangential *t;
    struct rc_pyramid *pyramid;
    size_t first, nx, ny; /* grid of the fields, the map with its frame: the first row held here,
                                  columns, rows held here */
    const unsigned char *face; /* the caller's array, like q */
    double *const *q;
    float
        *known;  /* c                                                                             */
    float *tie;  /* (1 - c)^2/D                                                                   */
    float *n[3]; /* xx yy xy: the tractions M P due to a shift of all nodes by 1, up to a factor */
    float *v[2]; /* on the grid                           */
    float *row;  /* for each thread                       */
    double self; /* T0                                    */
    bool level;  /* v has no mean */
    double b[4]; /* B^-1, by rows                         */
    struct rc_store own;
};

/* NULL when memory is short. */
struct rc_extension *rc_extension_new(struct rc_tangential *t, struct rc_err *err);
void rc_extension_free(struct rc_extension *e); /* NULL is allowed */
RC_OWNER(rc_extension)
/* Takes the faces, the tractions (their directions are the normals of the circles), D of slipping nodes,
 * and whether the displacement is given. False: B is singular, for example if all nodes of a periodic map
 * stick; the result is then the inverse for residuals without a mean. */
bool rc_extension_set(struct rc_extension *e, const unsigned char *face, double *const q[2],
                      const float *curve, bool given);
/* The pyramid's field e from r along free directions; then its values on row j of the map, for several
 * threads. */
void rc_extension_extend(struct rc_extension *e, float *const r[2]);
void rc_extension_row(const struct rc_extension *e, size_t j, const float *row[2]);
/* z = M r; both are 0 along directions that are not free. */
void rc_extension_apply(struct rc_extension *e, float *const r[2], float *const z[2]);

/* Removes from (x, y) the components that are not free at a node with tractions q. The part along the
 * tangent is a number times the tangent, which is exactly 0 where (x, y) and q have one direction. */
static inline void
rc_free_part(unsigned char face, double qx, double qy, double *x, double *y)
{
    double s;

    if (face == RC_FACE_OFF) {
        *x = *y = 0;
    } else if (face == RC_FACE_SLIP) {
        s = (*y * qx - *x * qy) / (qx * qx + qy * qy);
        *x = -s * qy;
        *y = s * qx;
    }
}

#endif
