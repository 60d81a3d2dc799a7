/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Variables that own memory or a handle and release it at the end of their scope, so that a function can
 * return from its middle. All are initialised where they are declared. longjmp does not release them.
 */
#ifndef RC_OWNED_H
#define RC_OWNED_H

#include <stdlib.h>
#include <string.h>

#include "grid.h"

/* Before a declaration: f(&variable) is called at the end of its scope. */
#define RC_ENDS(f) __attribute__((cleanup(f), unused))
/* Memory of malloc or rc_alloc: RC_OWNED double *v = malloc(n * sizeof *v); */
#define RC_OWNED RC_ENDS(rc_release)
/* A handle: RC_OWN(rc_grid, g) = rc_grid_new(...); declares struct rc_grid *g. */
#define RC_OWN(type, name) RC_ENDS(type##_release) struct type *name
/* For the header of a handle: what RC_OWN needs. */
#define RC_OWNER(type)                                                                             \
    static inline void type##_release(struct type **at)                                            \
    {                                                                                              \
        type##_free(*at);                                                                          \
    }

static inline void
rc_release(void *at)
{
    void *p;

    memcpy(&p, at, sizeof p);
    free(p);
}

/* For a maker: return rc_err_null(err, "..."); sets the sentence. */
#define rc_err_null(...) ((void)rc_err_set(__VA_ARGS__), NULL)

/* The pointer of such a variable, which owns it no longer: return rc_give(&g); */
static inline void *
rc_give(void *at)
{
    void *p;

    memcpy(&p, at, sizeof p);
    memset(at, 0, sizeof p);
    return p;
}

/* The number as rc_number_text writes it; the text lives until the end of the block. */
#define rc_number(value) rc_number_text((char[RC_NUMBER_SIZE]){""}, value)

RC_OWNER(rc_grid)

#endif
