/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A law of attraction: the row type of laws.list. Internal: never installed.
 *
 * Numbers have the units of the operator on the whole grid: its length for gaps and ranges, its modulus for
 * tractions. So E* is 1, and work is in modulus times length.
 */
#ifndef RC_ADHESION_LAW_H
#define RC_ADHESION_LAW_H

#include "libcontact/common.h"

/* A law with its parameters. V' = sigma, V(0) = -work, V(inf) = 0; D = -sigma' >= 0. */
struct rc_attraction {
    const struct rc_adhesion_law *law;
    double work, range;
    double strength; /* sigma(0)                                    */
    double steepest; /* the largest D                               */
    double reach;    /* beyond it sigma is 0 within rounding */
    double spread;   /* length over which a jump of sigma is spread */
};

struct rc_adhesion_law {
    struct rc_adhesion_law_info info;
    /* Computes strength, steepest, reach and spread from work and range; `diagonal`: the displacement of a
     * node under unit pressure on its own cell. */
    void (*set)(struct rc_attraction *a, double diagonal);
    /* The range for which the cohesive length, 1/steepest, has this value. */
    double (*range)(double work, double cohesive, double diagonal);
    /* V, sigma and D at n gaps. For gaps below 0, sigma is sigma(0) and D is 0. */
    void (*at)(const struct rc_attraction *a, size_t n, const double *restrict g,
               double *restrict v, double *restrict s, double *restrict d);
};

#define RC_ADHESION_LAW(name) extern const struct rc_adhesion_law rc_adhesion_##name;
#include "laws.list"
#undef RC_ADHESION_LAW

/* The law of this name (NULL: the first law); NULL if there is none. */
const struct rc_adhesion_law *rc_adhesion_law_named(const char *name);

#endif
