/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A kernel of some bodies, together with these bodies. */
#ifndef BODY_CASE_H
#define BODY_CASE_H

#include "libcontact/body/body.h"

struct body_case {
    struct rc_solids bodies;
    struct rc_surface surface;
    struct rc_solid *solid;
    struct rc_inside *inside;
    struct rc_stress_field field;
    struct rc_kernel kernel;
};

/* The displacement of a pair, m/Pa. */
static inline void
surface_case(struct body_case *c, struct rc_pair pair)
{
    struct rc_err err;

    *c = (struct body_case){.inside = NULL};
    assert_int_equal(rc_pair_check(&pair, &err), RC_OK);
    assert_int_equal(rc_solids_new(&c->bodies, &pair, NULL, NULL, &err), RC_OK);
    c->surface = (struct rc_surface){&c->bodies, 1, 1};
    c->kernel = rc_surface_kernel(&c->surface);
}

/* A stress at a depth of a body. */
static inline void
stress_case(struct body_case *c, struct rc_body body, double depth, struct rc_boundary boundary,
            int kernel)
{
    const struct rc_body_type *type = rc_body_type(&body);
    struct rc_err err;

    *c = (struct body_case){.solid = type->new (&body, &err)};
    assert_non_null(c->solid);
    c->inside = type->inside->new (c->solid, depth, true, boundary, &err);
    assert_non_null(c->inside);
    c->field = (struct rc_stress_field){c->inside, kernel};
    c->kernel = rc_stress_field_kernel(&c->field);
}

static inline void
body_case_free(struct body_case *c)
{
    rc_inside_free(c->inside);
    rc_solid_free(c->solid);
    rc_solids_free(&c->bodies);
}

#endif
