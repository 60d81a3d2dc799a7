/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Declarations for the files of the layered body. Internal: never installed.
 */
#ifndef RC_LAYERED_H
#define RC_LAYERED_H

#include "body.h"
#include "stack.h"

const struct rc_stack *rc_layered_stack(const struct rc_solid *solid);
extern const struct rc_inside_type rc_layered_inside; /* layered_stress.c */

#endif
