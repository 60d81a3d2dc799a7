/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "leak.h"

double
rc_face(const struct rc_passage *p, enum rc_face_rule rule, int32_t k, int32_t other,
        enum rc_direction d)
{
    double a = p->g[k], b;

    if (other >= p->nodes)
        return 2 * a * a * a * p->aspect;
    b = p->g[other];
    /* 1 / mean of 1/g^3 along the path */
    if (rule == RC_HARMONIC)
        a = 2 / (1 / (a * a * a) + 1 / (b * b * b));
    else
        a = 2 * (a * a) * (b * b) / (a + b);
    return d == RC_ON || d == RC_BACK ? a * p->aspect : a / p->aspect;
}

double
rc_face_drag(const struct rc_passage *p, int32_t k, int32_t other)
{
    double a = p->g[k], b = other < p->nodes ? p->g[other] : a;

    return (1 / (a * a) + 1 / (b * b)) / (1 / (a * a * a) + 1 / (b * b * b));
}
