/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Bodies that attract each other: the option --adhesion for the tools that solve them.
 */
#ifndef RC_TOOL_ADHESION_H
#define RC_TOOL_ADHESION_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

struct adhesion_law {
    struct rc_adhesion_problem problem; /* the contact in it is not set; its law points to `name` */
    char name[64];
};

extern const struct opt adhesion_option[]; /* its text */
/* "WORK", "WORK,LAW" or "WORK,LAW,RANGE". */
enum rc_status adhesion_law_read(struct adhesion_law *a, const char *text, struct rc_err *err);

/* A grid that resolves a law: a spacing, m, or at the same work and on the same grid a range, m. */
struct adhesion_grid {
    double spacing, range;
};
/* True if this grid resolves the law: with fewer nodes in the cohesive length it pins the edge of the
 * contact. Else *need is what would, with some to spare. `spacing`: the larger one of the grid, m. */
bool adhesion_resolved(const struct rc_adhesion_scales *scales, struct rc_boundary boundary,
                       double spacing, struct adhesion_grid *need);

#endif
