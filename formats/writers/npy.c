/* NumPy array, version 1.0: a magic, the header as a Python dictionary padded to a multiple of 64,
 * and the values row by row. It says nothing of spacing and unit. */
#include "encode.h"
#include "formats/export.h"

enum {
    TYPES = RC_TYPE_F32 | RC_TYPE_F64,
    FIXED = 10, /* bytes before the dictionary */
    ALIGN = 64
};

static enum rc_status
npy_write(FILE *out, struct rc_grid *const *frame, size_t frames, const struct rc_export_wish *wish,
          struct rc_err *err)
{
    const struct rc_grid *g = frame[0];
    const struct rc_code code = {.raw = rc_export_raw(g, wish, TYPES)};
    enum rc_status status = RC_FAIL;
    struct rc_buffer head = {0}, b = {0};

    (void)frames;
    rc_buffer_print(&b, "{'descr': '<f%zu', 'fortran_order': False, 'shape': (%zu, %zu), }",
                    rc_raw_width(code.raw), g->ny, g->nx);
    while ((FIXED + b.n + 1) % ALIGN != 0 && !b.failed)
        rc_buffer_add(&b, " ", 1);
    rc_buffer_add(&b, "\n", 1);
    rc_buffer_add(&head, "\x93NUMPY\x01\x00", 8);
    rc_buffer_u16(&head, (uint16_t)b.n);
    if (rc_buffer_write(&head, out, err) == RC_OK && rc_buffer_write(&b, out, err) == RC_OK)
        status = rc_encode_file(&code, g->v, g->nx * g->ny, out, err);
    rc_buffer_free(&head);
    rc_buffer_free(&b);
    return status;
}

const struct rc_export rc_export_npy = {
    .name = "npy",
    .suffixes = ".npy",
    .summary = "NumPy array: values only, no spacing, no unit",
    .types = TYPES,
    .write = npy_write,
};
