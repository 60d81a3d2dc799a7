/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A body that is not part of the library, in one file and one row of a list. It has springs on a rigid base,
 * coupled to their neighbours within a range L. The displacement by a unit pressure on a cell is K(x, y) =
 * 1/(pi E* L) times the integral of exp(-r / L) over the cell. The value at the centre approximates the
 * integral. One layer on a rigid half-space selects this body; L is its thickness, E* its modulus.
 */
#include "libcontact/body/body.h"

#include <math.h>
#include <stdlib.h>

struct toy {
    struct rc_solid solid;
    double estar, range;
};

static bool
takes(const struct rc_body *b)
{
    return b->layers == 1 && isinf(b->e);
}

static enum rc_status
check(const struct rc_body *b, enum rc_use use, struct rc_err *err)
{
    (void)use;
    if (!(b->layer[0].thickness > 0) || !(b->layer[0].e > 0))
        return rc_err_set(err, "springs of the range %g m and the modulus %g Pa",
                          b->layer[0].thickness, b->layer[0].e);
    return RC_OK;
}

static struct rc_solid *
toy_new(const struct rc_body *b, struct rc_err *err)
{
    const struct rc_layer *l = &b->layer[0];
    struct toy *toy = malloc(sizeof *toy);

    if (toy == NULL) {
        rc_err_set(err, "out of memory for springs");
        return NULL;
    }
    *toy = (struct toy){{&rc_body_toy}, l->e / (1 - l->nu * l->nu), l->thickness};
    return &toy->solid;
}

static void
toy_free(struct rc_solid *solid)
{
    free(solid);
}

/* The transform of exp(-r / L) over the plane is 2 pi L^2 / (1 + q^2 L^2)^(3/2). Is 2/(E*(q) q) here. */
static double
modulus_of(const struct rc_solid *solid, double q2)
{
    const struct toy *t = (const struct toy *)solid;
    double x2 = q2 * t->range * t->range;

    return t->estar * pow(1 + x2, 1.5) / sqrt(x2);
}

static double
modulus(const struct rc_solid *solid, double q)
{
    return modulus_of(solid, q * q);
}

/* The largest value is at q L = sqrt(1/2). */
static double
softest(const struct rc_solid *solid)
{
    return ((const struct toy *)solid)->estar * pow(1.5, 1.5) * sqrt(2);
}

static void
add_rows(const struct rc_solid *solid, double length, double modulus, const struct rc_lattice *at,
         size_t n, size_t first, size_t last, double *out)
{
    const struct toy *t = (const struct toy *)solid;
    double range = t->range / length;
    double scale = at->dx * at->dy * modulus / (RC_PI * t->estar * range);

    for (size_t j = first; j < last; j++)
        for (size_t i = 0; i < n; i++) {
            double x = (double)(i * at->sx) * at->dx, y = (double)(j * at->sy) * at->dy;
            *out++ += scale * exp(-hypot(x, y) / range);
        }
}

const struct rc_body_type rc_body_toy = {
    .name = "springs",
    .summary = "springs with a range, on a rigid base",
    .takes = takes,
    .check = check,
    .new = toy_new,
    .free = toy_free,
    .modulus = modulus,
    .modulus_of = modulus_of,
    .softest = softest,
    .add_rows = add_rows,
};
