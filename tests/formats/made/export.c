/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frames for the writers, and their files in memory. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "made.h"

static uint64_t seed = 0x2545f4914f6cdd1d;

static double
uniform(void)
{
    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    return (double)(seed >> 11) / 9007199254740992.0;
}

struct rc_grid *
random_grid(size_t nx, size_t ny, double missing)
{
    struct rc_shape shape = {.nx = nx, .ny = ny, .dx = 1.1e-6, .dy = 1.29e-6};
    struct rc_grid *g = rc_grid_new(&shape, "height", "m", NULL);

    assert_non_null(g);
    for (size_t k = 0; k < nx * ny; k++)
        g->v[k] = uniform() < missing ? NAN : 3.3e-6 + 1.7e-6 * (uniform() - 0.5);
    return g;
}

const struct rc_export_wish plain_export = {.time = 1700000000, .creator = "test"};

struct rc_export_wish
typed(enum rc_raw raw)
{
    struct rc_export_wish wish = plain_export;

    wish.typed = true;
    wish.raw = raw;
    return wish;
}

static enum rc_status
try_export(const char *name, struct rc_grid *const *frame, size_t frames,
           const struct rc_export_wish *wish, struct written *made, struct rc_err *err)
{
    const struct rc_export *format = rc_export_named(name);
    enum rc_status status;
    FILE *f;

    assert_non_null(format);
    f = open_memstream(&made->bytes, &made->n);
    assert_non_null(f);
    err->text[0] = '\0';
    status = rc_export_write(format, f, frame, frames, wish, err);
    fclose(f);
    return status;
}

struct written export(const char *name, struct rc_grid *const *frame, size_t frames,
                      const struct rc_export_wish *wish)
{
    struct written made;
    struct rc_err err;

    if (try_export(name, frame, frames, wish, &made, &err) != RC_OK)
        fail_msg("%s: %s", name, err.text);
    return made;
}

void
refuse_export(const char *name, struct rc_grid *const *frame, size_t frames,
              const struct rc_export_wish *wish, const char *why)
{
    struct written made;
    struct rc_err err;

    if (try_export(name, frame, frames, wish, &made, &err) == RC_OK)
        fail_msg("%s: written, and should be refused for: %s", name, why);
    if (strstr(err.text, why) == NULL)
        fail_msg("%s: refused for '%s', not for '%s'", name, err.text, why);
    free(made.bytes);
}
