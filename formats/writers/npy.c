/* SPDX-License-Identifier: GPL-3.0-or-later */
/* NumPy array, version 1.0: a magic, the header as a Python dictionary padded to a multiple of 64, and the
 * values row by row. A stack is written slice by slice from the shallowest down. It has no spacing and no
 * unit. */
#include <stdlib.h>

#include "encode.h"
#include "formats/export.h"
#include "stack.h"

enum {
    TYPES = RC_TYPE_F32 | RC_TYPE_F64,
    FIXED = 10, /* bytes before the dictionary */
    ALIGN = 64
};

/* Refuses uneven depths, because an array does not contain the depths. */
static enum rc_status
check_stack(const struct rc_stack *s, size_t stacks, struct rc_err *err)
{
    RC_OWNED double *at = NULL;
    double step;

    if (stacks > 1)
        return rc_err_set(err, "npy allows one map, or the depths of one channel and case on one "
                               "grid: choose with --channel, --case and --depth");
    if ((at = malloc(s->n * sizeof *at)) == NULL)
        return rc_err_set(err, "out of memory for %zu depths", s->n);
    for (size_t k = 0; k < s->n; k++)
        at[k] = rc_stack_depth(s, k);
    return !rc_export_even(at, s->n, &step)
               ? rc_err_set(err,
                            "the depths have uneven steps, which npy cannot say: write vtr or hdf5")
               : RC_OK;
}

static enum rc_status
put_head(FILE *out, const struct rc_stack *s, enum rc_raw raw, struct rc_err *err)
{
    RC_ENDS(rc_buffer_free) struct rc_buffer head = {0};
    RC_ENDS(rc_buffer_free) struct rc_buffer b = {0};

    rc_buffer_print(&b, "{'descr': '<f%zu', 'fortran_order': False, 'shape': (", rc_raw_width(raw));
    if (s->n > 1)
        rc_buffer_print(&b, "%zu, ", s->n);
    rc_buffer_print(&b, "%zu, %zu), }", s->layer[0]->ny, s->layer[0]->nx);
    while ((FIXED + b.n + 1) % ALIGN != 0 && !b.failed)
        rc_buffer_add(&b, " ", 1);
    rc_buffer_add(&b, "\n", 1);
    rc_buffer_add(&head, "\x93NUMPY\x01\x00", 8);
    rc_buffer_u16(&head, (uint16_t)b.n);
    return rc_buffer_write(&head, out, err) == RC_OK ? rc_buffer_write(&b, out, err) : RC_FAIL;
}

static enum rc_status
npy_write(FILE *out, struct rc_grid *const *frame, size_t frames, const struct rc_export_wish *wish,
          struct rc_err *err)
{
    const struct rc_code code = {.raw = rc_export_raw(frame[0], wish, TYPES)};
    size_t node = frame[0]->nx * frame[0]->ny, stacks;
    struct rc_stack *stack;
    enum rc_status status = rc_stacks_make(&stack, &stacks, frame, frames, err);

    if (status == RC_OK)
        status = check_stack(stack, stacks, err);
    if (status == RC_OK)
        status = put_head(out, stack, code.raw, err);
    for (size_t k = 0; status == RC_OK && k < stack->n; k++)
        status = rc_encode_file(&code, stack->layer[k]->v, node, out, err);
    rc_stacks_free(stack, stacks);
    return status;
}

const struct rc_export rc_export_npy = {
    .name = "npy",
    .suffixes = ".npy",
    .summary = "NumPy array: values only, no spacing, no unit",
    .stack = true,
    .types = TYPES,
    .write = npy_write,
};
