/*
 * An approximate inverse of T + D on the free directions of the nodes that carry friction. Internal: never
 * installed.
 *
 * Free are both components where a node sticks, the tangent t alone where it slips; P_i is the projection
 * on to what is free at node i, 0 where nothing is carried. With A = T^-1 on the whole map the exact
 * inverse is, as a quadratic form,
 *
 *     r'(T + D)^-1 r = least of  v'Av + sum over slipping nodes of (t'(r - v))^2/D     over all fields v with
 *                      v = r where nodes stick:
 *
 * a displacement v of everything, most of which nobody asks for: off the contact, along the normals of the
 * circles, and, the less the larger D is, along their tangents. Here v = E r is an explicit guess of that
 * field,
 *
 *     v_i = e_i + c_i P_i (r_i - e_i),   e_i = N_i^-1 sum_j G_ij c_j P_j r_j,   N_i = sum_j G_ij c_j P_j + f_i,
 *     G_ij = |x_i - x_j|^(-5/2),         c = T0/(T0 + D): what is known of v from the residual of a node
 *
 * with the fade f of the preconditioner of the normal problem, and 2 x 2 matrices N: missing components
 * are told by neighbours that have them. Then
 *
 *     z = E' A E r + (1 - c)^2/D P (r - e) and its transpose:
 *
 * symmetric, and r'z >= r'(T + D)^-1 r whatever the guess: z bounds the error in the energy norm from
 * above.
 *
 * A periodic T has no mean, T(0) = 0, and its inverse allows none: the least of v'Av is over fields v without
 * a mean. A force given, the residual has none either. A displacement given, what the guess has of it goes to
 * where nothing is known, by a change of rank 2:
 *
 *     e -> e - Phi m,   Phi = N^-1 f,   m = B^-1 mean(e + c P (r - e)),   B = mean((1 - c P) Phi).
 */
#ifndef RC_EXTENSION_H
#define RC_EXTENSION_H

#include "tangential.h"

enum rc_face {
    RC_FACE_OFF, /* carries nothing                   */
    RC_FACE_STICK,
    RC_FACE_SLIP
};

struct rc_extension {
    struct rc_tangential *t;
    struct rc_spectrum *spread; /* G */
    const unsigned char *face;  /* the caller's, as q is */
    double *const *q;
    float self[2];
    float *close; /* d^(-1/2), d the distance from the contact */
    float *known; /* c                                         */
    float *tie;   /* (1 - c)^2/D                               */
    float *n[3];  /* of N^-1, xx yy xy                         */
    float *v[2];
    float *far;      /* f; NULL: T has a mean                             */
    double *partial; /* sums of rows; NULL as f                           */
    bool level;      /* v is to have no mean                              */
    double b[4];     /* B^-1, by rows                                     */
};

/* NULL when memory is short. */
struct rc_extension *rc_extension_new(struct rc_tangential *t, struct rc_err *err);
void rc_extension_free(struct rc_extension *e); /* NULL is allowed */
size_t rc_extension_memory(const struct rc_shape *shape, enum rc_boundary boundary);
/* The nodes that may carry something: they stay until the next call. RC_FAIL when memory is short. */
enum rc_status rc_extension_measure(struct rc_extension *e, const unsigned char *face,
                                    struct rc_err *err);
/* Faces, tractions, whose directions are the normals of the circles, and D where nodes slip; whether the
 * displacement is given. False: B is singular, as where all nodes of a periodic map stick, and what is
 * applied is the inverse for residuals without a mean. */
bool rc_extension_set(struct rc_extension *e, const unsigned char *face, double *const q[2],
                      const float *curve, bool given);
/* z = M r; r is 0 along what is not free, and z too. */
void rc_extension_apply(struct rc_extension *e, float *const r[2], float *const z[2]);

/* Takes from (x, y) what is not free at a node with tractions q. */
static inline void
rc_free_part(unsigned char face, double qx, double qy, double *x, double *y)
{
    double s;

    if (face == RC_FACE_OFF) {
        *x = *y = 0;
    } else if (face == RC_FACE_SLIP) {
        s = (*x * qx + *y * qy) / (qx * qx + qy * qy);
        *x -= s * qx;
        *y -= s * qy;
    }
}

#endif
