/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frames that are the depths of one stack: one channel and case, on one grid. */
#ifndef RC_STACK_H
#define RC_STACK_H

#include "libcontact/owned.h"

struct rc_stack {
    /* n of them, from the shallowest down; a frame without a depth is a stack of its own */
    struct rc_grid **layer;
    size_t n;
};

/* All stacks of the frames, in the order of their first frames. RC_FAIL for two frames of a stack at one
 * depth, and when memory is short. Free them also on failure. */
enum rc_status rc_stacks_make(struct rc_stack **stack, size_t *stacks, struct rc_grid *const *frame,
                              size_t frames, struct rc_err *err);
void rc_stacks_free(struct rc_stack *stack, size_t stacks);

/* The depth of layer k; 0 without a depth. */
double rc_stack_depth(const struct rc_stack *stack, size_t k);

#endif
