/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stack.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* True if the frame is another depth of the stack. */
static bool
is_layer(const struct rc_stack *s, const struct rc_grid *g)
{
    const struct rc_grid *a = s->layer[0];
    double depth;

    return rc_grid_number(g, "depth", &depth) && rc_grid_number(a, "depth", &depth) &&
           strcmp(a->channel, g->channel) == 0 && rc_grid_case(a) == rc_grid_case(g) &&
           a->nx == g->nx && a->ny == g->ny && a->dx == g->dx && a->dy == g->dy;
}

static int
by_depth(const void *a, const void *b)
{
    double x = 0, y = 0;

    rc_grid_number(*(struct rc_grid *const *)a, "depth", &x);
    rc_grid_number(*(struct rc_grid *const *)b, "depth", &y);
    return (x > y) - (x < y);
}

/* Adds the frame to its stack, or to a new one. */
static enum rc_status
put(struct rc_stack *stack, size_t *stacks, struct rc_grid *g, size_t frames, struct rc_err *err)
{
    size_t k = 0;

    while (k < *stacks && !is_layer(&stack[k], g))
        k++;
    if (k == *stacks) {
        if ((stack[k].layer = calloc(frames, sizeof(struct rc_grid *))) == NULL)
            return rc_err_set(err, "out of memory for %zu frames", frames);
        ++*stacks;
    }
    stack[k].layer[stack[k].n++] = g;
    return RC_OK;
}

enum rc_status
rc_stacks_make(struct rc_stack **stack, size_t *stacks, struct rc_grid *const *frame, size_t frames,
               struct rc_err *err)
{
    *stacks = 0;
    if ((*stack = calloc(frames, sizeof **stack)) == NULL)
        return rc_err_set(err, "out of memory for %zu frames", frames);
    for (size_t k = 0; k < frames; k++)
        if (put(*stack, stacks, frame[k], frames - k, err) != RC_OK)
            return RC_FAIL;
    for (size_t a = 0; a < *stacks; a++) {
        struct rc_stack *s = &(*stack)[a];

        qsort(s->layer, s->n, sizeof(struct rc_grid *), by_depth);
        for (size_t k = 1; k < s->n; k++)
            if (by_depth(&s->layer[k - 1], &s->layer[k]) == 0)
                return rc_err_set(err, "two frames of channel %s at one depth (%s m)",
                                  s->layer[0]->channel, rc_number(rc_stack_depth(s, k)));
    }
    return RC_OK;
}

void
rc_stacks_free(struct rc_stack *stack, size_t stacks)
{
    for (size_t k = 0; stack != NULL && k < stacks; k++)
        free(stack[k].layer);
    free(stack);
}

double
rc_stack_depth(const struct rc_stack *s, size_t k)
{
    double depth = 0;

    rc_grid_number(s->layer[k], "depth", &depth);
    return depth;
}
